/* The shader programs of a surface. Each is built, or loaded from the cache folder, when it is first used. */
#ifndef CAMBER_GL_SHADERS_H
#define CAMBER_GL_SHADERS_H

#include "gl/surface.h"

/* Variants of the stroke shader, as bits. A frame pays only for what it uses. */
enum {
    CAMBER_VARIANT_LINEAR = 1, /* coverage is a ramp across the edge, not the exact area */
    CAMBER_VARIANT_SHARP_JOINS = 2,
    CAMBER_VARIANT_FLAT_ENDS = 4,
    CAMBER_VARIANT_COUNT = 8,       /* counts the fragments with coverage instead of drawing them */
    CAMBER_VARIANT_UNION = 16,      /* writes the sums that the union of a layer's strokes is made from */
    CAMBER_VARIANT_THIN = 32,       /* some strokes have both edges in a pixel */
    CAMBER_VARIANT_TIPS = 64,       /* some round caps are hardly wider than a pixel */
    CAMBER_VARIANT_FEATURES = 128,  /* times the CAMBER_FEATURE_* bits, which become the bits from here to PATTERN */
    CAMBER_VARIANT_GAP = 128,       /* some strokes are two rails with a gap between them */
    CAMBER_VARIANT_BLUR = 256,      /* some strokes fade at their edges */
    CAMBER_VARIANT_DASH = 512,      /* some strokes are dashed */
    CAMBER_VARIANT_TRIM = 1024,     /* some strokes are drawn only in part */
    CAMBER_VARIANT_RAMP = 2048,     /* some strokes change colour along their lines */
    CAMBER_VARIANT_PATTERN = 4096,  /* some strokes are drawn with images */
    CAMBER_VARIANT_MASK = 8192,     /* writes colours that may be translucent, and their alphas to a second target */
    CAMBER_VARIANT_PITCHED = 16384, /* the plane of the lines is seen at an angle */
    CAMBER_VARIANT_METHOD = 32768,  /* times camber_method */
    CAMBER_METHODS = 3,
    CAMBER_STROKE_SHADERS_MAX = 256 /* variants that are kept built */
};

enum {
    CAMBER_ROW_TEXELS = 7,              /* texels of a row in the row texture; stroke.vert says what is in each */
    CAMBER_ROW_TEXTURE_WIDTH_PX = 2048, /* the shaders have the same number */
};

/* Texture units of the shaders' samplers. All samplers that are not listed are at unit 0. */
enum { CAMBER_RECORDS_UNIT = 1, CAMBER_ALPHAS_UNIT = 2, CAMBER_ATLAS_UNIT = 3 };

/* The flatten shader composites one of these onto the picture. */
typedef enum camber_flatten_kind {
    CAMBER_FLATTEN_COLORS,
    CAMBER_FLATTEN_COVERAGE, /* a layer with one channel of accumulated coverage */
    CAMBER_FLATTEN_UNION,    /* a layer with four sums, from which the shader makes the union */
    CAMBER_FLATTEN_MASKED,   /* a layer of colours, and a second one of their alphas */
    CAMBER_FLATTEN_FILL,     /* no layer: one colour everywhere */
    CAMBER_FLATTEN_IMAGES,   /* no layer: copies of an image side by side */
    CAMBER_FLATTEN_FLIPPED,  /* a layer of colours, upside down */
    CAMBER_FLATTEN_KINDS
} camber_flatten_kind;

/* A program and its uniforms' locations. */
typedef struct camber_shader {
    GLuint program;   /* 0: not built yet */
    unsigned variant; /* variant of a stroke shader */
    GLint origin, corner, scale, layer_color, table, table_rows, stride, side_table, eye;
    GLint image_rect, mean, first, axis_x, axis_y; /* uniforms of a fill with images */
} camber_shader;

typedef struct camber_shaders {
    camber_surface *surface;
    camber_shader strokes[CAMBER_STROKE_SHADERS_MAX]; /* in the order they were built */
    size_t strokes_built;
    camber_shader flatten[CAMBER_FLATTEN_KINDS];
    camber_shader counts[CAMBER_METHODS]; /* they count every fragment */
} camber_shaders;

/* Each returns a program, which stays built until another of its kind is requested. The surface's context must be
 * current. They return CAMBER_ERROR_DEVICE (a shader does not build). */
camber_status camber_shaders_stroke(camber_shaders *shaders, unsigned variant, const camber_shader **shader);
camber_status camber_shaders_flatten(camber_shaders *shaders, camber_flatten_kind kind, const camber_shader **shader);
camber_status camber_shaders_count(camber_shaders *shaders, camber_method method, const camber_shader **shader);
/* Deletes all programs. */
void camber_shaders_release(camber_shaders *shaders);

#endif
