/* The renderer: shader variants, targets, and the frame. */
#ifndef CAMBER_RENDERER_H
#define CAMBER_RENDERER_H

#include "gl/share.h"
#include "tess/mesh.h"

/* Variants of the stroke shader, as bits. */
enum {
    CAMBER_VARIANT_LINEAR = 1,
    CAMBER_VARIANT_SHARP_JOINS = 2,
    CAMBER_VARIANT_FLAT_CAPS = 4,
    CAMBER_VARIANT_COUNT = 8,       /* counts the fragments with coverage instead of drawing them */
    CAMBER_VARIANT_UNION = 16,      /* leaves what the union of a layer's strokes is made from */
    CAMBER_VARIANT_THIN = 32,       /* strokes with both edges in a pixel */
    CAMBER_VARIANT_TIPS = 64,       /* round caps that are hardly wider than a pixel */
    CAMBER_VARIANT_GAP = 128,       /* strokes that may be two bands */
    CAMBER_VARIANT_BLUR = 256,      /* strokes that may fade */
    CAMBER_VARIANT_DASH = 512,      /* strokes that may be dashed */
    CAMBER_VARIANT_TRIM = 1024,     /* strokes that may be drawn in part */
    CAMBER_VARIANT_RAMP = 2048,     /* strokes whose colour may change along them */
    CAMBER_VARIANT_MASK = 4096,     /* leaves colours that may be translucent, and how much of the pixel they cover */
    CAMBER_VARIANT_PATTERN = 8192,  /* strokes that may be of images */
    CAMBER_VARIANT_PITCHED = 16384, /* the plane of the lines is seen at an angle */
    CAMBER_VARIANT_METHOD = 32768,  /* times camber_method */
    CAMBER_METHODS = 3,
    CAMBER_STROKES_MAX = 256 /* variants that are kept built */
};

/* Of the table of rows; stroke.vert says what is in each. */
enum { CAMBER_TEXELS_A_ROW = 7 };

/* What a flattened layer holds. */
typedef enum camber_flatten_kind {
    CAMBER_FLATTEN_COLORS,
    CAMBER_FLATTEN_COVERAGE, /* one channel, gathered one over the other */
    CAMBER_FLATTEN_UNION,    /* four, of which the union is made */
    CAMBER_FLATTEN_MASKED,   /* colours, and their alphas beside them */
    CAMBER_FLATTEN_FILL,     /* nothing: one colour, */
    CAMBER_FLATTEN_IMAGES,   /* or images side by side */
    CAMBER_FLATTEN_FLIPPED,  /* colours, upside down */
    CAMBER_FLATTEN_KINDS
} camber_flatten_kind;

typedef struct camber_shader {
    GLuint program;   /* 0: not built yet */
    unsigned variant; /* of a stroke shader */
    GLint origin, corner, scale, layer_color, table, table_rows, stride, tail, eye;
    GLint place, mean, first, axis_x, axis_y; /* of images side by side */
} camber_shader;

/* A texture to draw into, of the size of a piece. */
typedef struct camber_target {
    GLuint texture, framebuffer;
    GLuint stencil; /* of the counts only */
    GLuint alphas;  /* of the masked layer only: its own alpha is how much of a pixel is covered */
    GLsizei width, height;
} camber_target;

enum {
    CAMBER_TARGET_PICTURE,
    CAMBER_TARGET_NEXT_PICTURE, /* of the second frame in flight */
    CAMBER_TARGET_COVERAGE,
    CAMBER_TARGET_LAYER,
    CAMBER_TARGET_MASKED, /* a layer whose colours are translucent by themselves */
    CAMBER_TARGET_GROUP,  /* a pass with an opacity of its own */
    CAMBER_TARGET_COUNTS,
    CAMBER_TARGET_GIVEN, /* a texture of the caller's, while a call draws into it */
    CAMBER_TARGETS
};

/* Texture units, as the shaders have them; all else is at 0. */
enum { CAMBER_RECORDS_UNIT = 1, CAMBER_ALPHAS_UNIT = 2, CAMBER_PATTERNS_UNIT = 3 };

/* Polylines of equal alpha that follow each other in a pass. */
typedef struct camber_run {
    const camber_pass *pass;
    size_t first, end; /* polylines */
    float alpha;       /* of its rows; 1: straight onto the picture */
    float opacity;     /* of its layer, besides */
    bool one_color;    /* its layer holds coverage alone, and color is put over it */
    bool layered;
    bool one_alpha; /* lines of other alphas are not drawn; else those of a layer have their own */
    bool masked;    /* a ramp has translucent colours, or lines of many alphas do */
    camber_color color;
    unsigned bands; /* CAMBER_VARIANT_GAP and what follows it, where a paint has them */
} camber_run;

typedef struct camber_batch_range {
    size_t first, end; /* polylines */
    size_t table;      /* of the row texture */
} camber_batch_range;

/* What waits to be drawn. */
typedef struct camber_batch {
    const camber_mesh *mesh;
    const camber_pass *pass; /* of the last table */
    size_t table_count;
    unsigned bands; /* of its runs */
    camber_batch_range *ranges;
    size_t range_count, range_capacity;
    GLint *firsts; /* of the strips of a call */
    GLsizei *counts;
    size_t call_count, first_capacity, count_capacity;
} camber_batch;

/* Where a pass's ramp lies in the tail. */
typedef struct camber_ramp_place {
    const camber_ramp *ramp;
    size_t texel;
} camber_ramp_place;

/* An image in the texture of patterns. */
typedef struct camber_placed {
    uint64_t hash;          /* of the image */
    uint32_t width, height; /* texels that it takes */
    bool tiled;             /* with its other edge above and below */
    GLint x, y;             /* of its first texel */
} camber_placed;

typedef struct camber_patterns {
    GLuint texture; /* 0: none yet */
    GLsizei height;
    camber_placed *placed;
    size_t count, capacity;
    GLint shelf_x, shelf_y, shelf_height; /* where the next one goes */
    const camber_image *hashed;           /* a pass's images, whose hashes are known or 0 */
    uint64_t *hashes;
    size_t hashed_count, hash_capacity;
    double nearest; /* px of the picture a px of the plane, at most */
} camber_patterns;

/* One piece of the picture. */
typedef struct camber_piece {
    uint32_t x, y, width, height; /* in the picture, px */
    camber_coverage coverage;
    float thinnest_px; /* that is drawn in the frame */
    int target;        /* that runs are drawn into */
    bool pitched;
    float eye[4];     /* as stroke.vert has it, where it is pitched */
    uint32_t horizon; /* rows of the picture that lie past it; 0 where it is not pitched */
    size_t *draw_calls;
} camber_piece;

/* A frame that has begun. */
typedef struct camber_flight {
    camber_frame frame;
    camber_piece first;  /* which is drawn */
    GLsync drawn;        /* a fence behind it. NULL: it is finished */
    uint64_t number;     /* of the frames that have begun */
    camber_pass *passes; /* of several pieces: the frame's own */
    camber_paint *paints;
    camber_frame_stats stats;
    uint8_t *rgba; /* of a frame that kernels draw: the picture */
} camber_flight;

struct camber_renderer {
    camber_share share;
    /* Draws in OpenCL. Of what follows, only what brings its pixels into textures is used then, and without a surface
     * nothing. NULL: GL draws. */
    struct camber_cover *cover;
    camber_buffer pixels; /* that kernels draw and GL reads */
    const camber_share_path *path;
    camber_shader strokes[CAMBER_STROKES_MAX]; /* in the order they were built */
    size_t strokes_built;
    camber_shader flatten[CAMBER_FLATTEN_KINDS];
    camber_shader counts[CAMBER_METHODS]; /* every fragment */
    camber_target targets[CAMBER_TARGETS];
    GLuint vertex_array;
    GLuint record_texture; /* of the records of the part that is bound */
    GLuint row_texture;
    GLsizei row_height; /* texels */
    float *row_texels;  /* 4 floats a texel */
    size_t row_capacity;
    float *tail_texels; /* behind the rows' tables, 4 floats a texel: dashes, and the stops of ramps. Of kernels too */
    size_t tail_count, tail_capacity;
    camber_ramp_place *ramps; /* that are in the tail */
    size_t ramp_count, ramp_capacity;
    camber_patterns patterns;
    camber_batch batch;
    camber_flight flights[CAMBER_FRAMES_IN_FLIGHT];
    size_t first_flight, flight_count; /* a ring */
};

/* linked.c: programs in the cache folder. A key is of the driver and all the sources. */
uint64_t camber_linked_key(const camber_renderer *renderer, const char *const *sources, size_t count);
/* false: it is not there, or the driver takes it no more. */
bool camber_linked_load(camber_renderer *renderer, uint64_t key, GLuint program);
void camber_linked_save(camber_renderer *renderer, uint64_t key, GLuint program);

/* shaders.c */
camber_status camber_renderer_stroke_shader(camber_renderer *renderer, unsigned variant, const camber_shader **shader);
camber_status camber_renderer_flatten_shader(camber_renderer *renderer, camber_flatten_kind kind,
                                             const camber_shader **shader);
camber_status camber_renderer_count_shader(camber_renderer *renderer, camber_method method,
                                           const camber_shader **shader);

/* targets.c: binds a target of this size; what it holds is not defined. The viewport reaches past each of its sides by
 * camber_renderer_guard, the scissor does not: a software driver clips a batch of triangles one by one where a single
 * vertex lies outside the viewport. */
camber_status camber_renderer_bind_target(camber_renderer *renderer, int which, GLsizei width, GLsizei height);
GLsizei camber_renderer_guard(const camber_renderer *renderer, int axis, GLsizei side);
void camber_renderer_release_targets(camber_renderer *renderer);
/* Makes a caller's texture the given target, until it is let go. */
camber_status camber_renderer_give_target(camber_renderer *renderer, GLuint texture, GLsizei width, GLsizei height);
void camber_renderer_let_go(camber_renderer *renderer);

/* pass.c */
float camber_renderer_thinnest(const camber_frame *frame);
camber_status camber_renderer_draw_pass(camber_renderer *renderer, const camber_pass *pass, const camber_piece *piece);
static inline bool camber_pass_draws(const camber_pass *pass, uint32_t row) {
    return row < pass->paint_count && pass->paints[row].width_px > 0.0f && pass->paints[row].color.a > 0.0f;
}

/* Half of what a paint takes: a gap's bands lie on both sides of it. */
static inline float camber_paint_half_width(const camber_paint *paint) {
    return paint->gap_px > 0.0f ? 0.5f * paint->gap_px + paint->width_px : 0.5f * paint->width_px;
}

/* images.c: the texels of images, for a size in the picture. */
bool camber_image_is_valid(const camber_image *image);

typedef struct camber_image_use {
    uint32_t pattern; /* of the pass, from 1 */
    double width_px, height_px;
    bool tiled; /* downwards, too */
} camber_image_use;

camber_image_use camber_image_use_of_paint(const camber_pass *pass, const camber_paint *paint);
camber_image_use camber_image_use_of_fill(const camber_pass *pass);
/* One texel. */
camber_image_use camber_image_mean_of_fill(const camber_pass *pass);

enum { CAMBER_TEXELS_SIDE_MAX = 2046 };

typedef struct camber_texels {
    uint32_t width, height;
    bool tiled; /* with its other edge above and below */
} camber_texels;

/* nearest: px of the picture a px of the plane, at most. */
camber_texels camber_image_texels(const camber_image *image, const camber_image_use *use, double nearest);
/* RGBA8, a texel more on each side. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_image_shrink(camber_context *context, const camber_image *image, camber_texels size,
                                  uint8_t *texels);
const uint8_t *camber_image_row(const camber_image *image, uint32_t y);

/* patterns.c */
/* Puts all images that the pass draws into the texture; draws what waits before another of them has to go. Returns
 * CAMBER_ERROR_LIMIT where they do not fit at once. */
camber_status camber_patterns_hold(camber_renderer *renderer, const camber_pass *pass, const camber_piece *piece);
/* Of a row of a pass that is held: where in the texture, as coordinates there, and px along the line. */
camber_status camber_patterns_put(camber_renderer *renderer, const camber_pass *pass, const camber_paint *paint,
                                  float texels[8]);
/* Of a fill that is held: where in the texture, the place of its mean there, and px of the picture. */
typedef struct camber_fill_place {
    float place[4], mean[4], size_px[2];
} camber_fill_place;
camber_status camber_patterns_put_fill(camber_renderer *renderer, const camber_pass *pass, camber_fill_place *place);
void camber_patterns_bind(camber_renderer *renderer);
/* The caller's images may be others from here on. */
void camber_patterns_begin(camber_renderer *renderer, const camber_piece *piece);
void camber_patterns_release(camber_renderer *renderer, bool is_current);

/* The longest run from a polyline on. Rows that are not drawn belong to any run. */
camber_run camber_pass_next_run(const camber_pass *pass, size_t first, size_t end);

enum { CAMBER_ALPHAS_MAX = 16 };

typedef struct camber_alphas {
    float values[CAMBER_ALPHAS_MAX]; /* ascending */
    size_t count;
    bool more; /* than these */
} camber_alphas;

/* The runs of a pass. Where alphas change too often to keep the order of lines, one an alpha, the faintest first; where
 * there are too many alphas for that, one for all, in which a line hides those below it. */
typedef struct camber_runs {
    const camber_pass *pass;
    size_t next, end; /* polylines */
    camber_run first; /* in the order of lines: most passes are this one */
    bool by_alpha, masked;
    camber_alphas alphas;
    size_t alpha; /* the next one */
} camber_runs;

camber_runs camber_runs_begin(const camber_pass *pass, size_t end);
/* false: there is none any more. */
bool camber_runs_next(camber_runs *runs, camber_run *run);

/* covered.c: frames that kernels draw. */
camber_status camber_covered_render(camber_renderer *renderer, const camber_frame *frame, camber_rows_fn *rows,
                                    void *user, camber_frame_stats *stats);
/* What one area holds is drawn at once, and kept; else all of it when the frame ends. */
camber_status camber_covered_begin(camber_renderer *renderer, const camber_frame *frame, camber_flight *flight);
camber_status camber_covered_end(camber_renderer *renderer, camber_flight *flight, camber_rows_fn *rows, void *user);
/* Hands over the areas of a frame, from the top down, to be drawn and taken. */
struct camber_cover_scene;
struct camber_cover_area;
typedef camber_status camber_area_fn(camber_renderer *renderer, const struct camber_cover_scene *scene,
                                     const struct camber_cover_area *area, void *user);
camber_status camber_covered_each(camber_renderer *renderer, const camber_frame *frame, camber_area_fn *draw,
                                  void *user);

/* covered_images.c: images in the tail. */
typedef struct camber_covered_image {
    const uint8_t *rgba; /* of the caller */
    size_t stride_bytes;
    uint32_t px[2];
    camber_texels size;
    size_t first; /* texel of the tail, each of which holds four of the image */
    bool is_opaque;
} camber_covered_image;

typedef struct camber_covered_images {
    camber_covered_image *held;
    size_t count, capacity;
    size_t last_place; /* texel of the tail. 0: none yet */
    double nearest;    /* px of the picture a px of the plane, at most */
} camber_covered_images;

enum { CAMBER_COVERED_TAIL_MAX = 1 << 24 }; /* texels: floats number them */

/* The image of a row, of a fill: place is the texel that an ink names. Return CAMBER_ERROR_LIMIT where the tail is
 * full, CAMBER_ERROR_MEMORY. */
camber_status camber_covered_put_line(camber_renderer *renderer, camber_covered_images *images, const camber_pass *pass,
                                      const camber_paint *paint, uint32_t *place);
camber_status camber_covered_put_fill(camber_renderer *renderer, camber_covered_images *images, const camber_pass *pass,
                                      uint32_t *place, bool *is_opaque);

/* rows.c: the row texture. */
bool camber_renderer_holds_rows(const camber_renderer *renderer, size_t row_count, size_t tail_texels);
camber_status camber_renderer_reserve_rows(camber_renderer *renderer, size_t row_count);
/* A run's table: rows of other alphas are left out, and a layer's rows are drawn opaque. */
camber_status camber_renderer_fill_rows(camber_renderer *renderer, const camber_run *run, size_t table);
/* From where to where a paint is not drawn, shares of the line: what is trimmed at its end takes its cap as well. */
void camber_rows_put_trim(const camber_paint *paint, float texel[2]);
camber_status camber_renderer_upload_rows(camber_renderer *renderer, size_t row_count);
/* tail.c: what rows name, in the texels behind the tables, the first of which lies here. */
GLint camber_renderer_tail(size_t row_count);
void camber_tail_forget(camber_renderer *renderer);
/* So many texels more, all 0, until the next call. NULL: no memory. */
float *camber_tail_add(camber_renderer *renderer, size_t texels);
/* Puts a paint's dash or ramp into the tail, and into a texel of its row where that is. */
/* Texels that the pass's dashes and ramps may take. */
size_t camber_tail_need(const camber_pass *pass);
camber_status camber_tail_put_dash(camber_renderer *renderer, const camber_pass *pass, uint32_t row, float texel[4]);
camber_status camber_tail_put_ramp(camber_renderer *renderer, const camber_ramp *ramp, float texel[2]);
/* Whether a dash, a ramp is one that camber.h allows. */
bool camber_dash_is_valid(const camber_dash *dash);
bool camber_ramp_is_valid(const camber_ramp *ramp);
/* One table of a mesh with widths alone; a row past the paints is not drawn. */
camber_status camber_renderer_set_widths(camber_renderer *renderer, const camber_mesh *mesh, const camber_paint *paints,
                                         size_t paint_count);

/* batch.c: camber_batch_add puts a run behind those that wait, and draws them first where they cannot share a call;
 * camber_batch_draw draws all that wait. */
camber_status camber_batch_add(camber_renderer *renderer, const camber_run *run, const camber_piece *piece);
camber_status camber_batch_draw(camber_renderer *renderer, unsigned variant, const camber_piece *piece);
void camber_batch_forget(camber_renderer *renderer);
/* The stroke shader that a mesh needs for lines of this width at least, with CAMBER_VARIANT_LINEAR, COUNT or UNION
 * added. */
camber_status camber_renderer_mesh_shader(camber_renderer *renderer, const camber_mesh *mesh, float thinnest_px,
                                          unsigned variant, const camber_shader **shader);
/* Uses a shader, with its uniforms set for a piece of a mesh that has one table. */
void camber_renderer_use_shader(camber_renderer *renderer, const camber_shader *shader, const camber_mesh *mesh,
                                const camber_piece *piece);
/* Binds a part's records and indices, and the row texture. */
void camber_renderer_bind_part(camber_renderer *renderer, camber_mesh_part *part);
/* Past the far plane, which is a row of the picture, nothing is drawn from here on. */
void camber_renderer_hide_beyond(camber_renderer *renderer, const camber_piece *piece);
/* Draws indices of the part that is bound. */
void camber_renderer_draw_indices(camber_renderer *renderer, const camber_mesh *mesh, uint64_t first, uint64_t count);

/* frame.c: drops what is in flight. */
void camber_frames_forget(camber_renderer *renderer, bool is_current);
camber_status camber_frame_check(camber_renderer *renderer, const camber_frame *frame);
/* Draws all of a frame in GL, as one piece, into a target. */
camber_status camber_frame_draw(camber_renderer *renderer, const camber_frame *frame, int target);

/* Logs what GL reports; CAMBER_OK where it reports nothing. */
camber_status camber_renderer_check(camber_renderer *renderer, const char *what);

#endif
