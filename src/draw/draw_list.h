/* The draw list of a frame: its passes, checked and resolved into commands that GL or OpenCL draws.
 *
 * A command fills the picture, or draws some polylines of a mesh in one way: directly onto the picture, or through a
 * layer that is composited onto it as a whole. All rules about alphas, layers, groups and features are in draw_list.c;
 * GL and OpenCL only follow the list. The list refers to the frame's meshes and images, not to its passes and paints.
 */
#ifndef CAMBER_DRAW_DRAW_LIST_H
#define CAMBER_DRAW_DRAW_LIST_H

#include "draw/images.h"
#include "draw/side_table.h"
#include "residency/mesh.h"

#include "kernels/features.h" /* CAMBER_FEATURE_* */

/* How the lines of a command are combined and composited onto the picture. */
typedef enum camber_composite {
    CAMBER_COMPOSITE_STRAIGHT, /* no layer: each line is drawn over what is below it */
    CAMBER_COMPOSITE_COLORS,   /* a layer of colours */
    CAMBER_COMPOSITE_COVERAGE, /* a layer of one colour, which accumulates coverage, one line over another */
    /* the same, but a pixel in which edges meet gets the exact area of the union of all lines */
    CAMBER_COMPOSITE_UNION,
    CAMBER_COMPOSITE_MASKED, /* a layer of translucent colours, in which only the last line is seen */
    CAMBER_COMPOSITE_AREA,   /* no layer: the inside of the polylines is filled, all polygons of a fill at once */
} camber_composite;

/* A row's paint, with the positions of its dashes and stops in the side table. */
typedef struct camber_row_paint {
    float half_width_px; /* including the gap. Below 0: the row is not drawn */
    float half_gap_px;   /* below 0: there is no gap */
    float blur_px;       /* below 0: -blur_px wide, by a smooth step */
    float translate_px[2];
    float trim[2];      /* fractions of the line between which it is not drawn; a trim at an end removes the cap too */
    camber_color color; /* straight; with an image it is white, with the paint's alpha */
    unsigned features;  /* CAMBER_FEATURE_* */
    bool has_translucent_ramp;
    camber_side_dashes dashes;       /* with CAMBER_FEATURE_DASH */
    uint32_t first_stop, stop_count; /* with CAMBER_FEATURE_RAMP */
    size_t image_use;                /* an image use of the list, with CAMBER_FEATURE_IMAGE */
    /* a fill of the list: the row's polygons are filled with it. CAMBER_NO_FILL: its lines are drawn */
    int32_t fill;
} camber_row_paint;

enum { CAMBER_NO_FILL = -1 };

/* A fill for the whole picture, or for polygons. */
typedef struct camber_fill_paint {
    camber_color color; /* straight, with the pass's opacity in its alpha; with an image it is white */
    bool has_image;
    size_t image_use, mean_use; /* image uses of the list */
    float x_px, y_px;           /* the top left corner of one image, in the picture */
    double bearing_deg;
    camber_fill_rule rule;
    bool upright; /* the image is in the picture as it is seen, not in the plane */
} camber_fill_paint;

/* Consecutive polygons with the same fill. */
typedef struct camber_area_span {
    size_t first; /* polyline */
    int32_t fill; /* a fill of the list */
} camber_area_span;

typedef struct camber_draw_command {
    camber_mesh *mesh;             /* NULL: a fill of the picture */
    camber_fill_paint fill;        /* fill of the picture */
    size_t first_span, span_count; /* in the list, if composite is AREA: only its rows with a fill are drawn */
    size_t first, end;             /* polylines of the mesh */
    bool upright;                  /* these are in the picture as it is seen, not in the plane */
    size_t first_row;              /* in the list's rows; every row of the mesh has one */
    unsigned features;             /* CAMBER_FEATURE_* of its rows */
    camber_composite composite;
    bool one_alpha; /* only rows of one alpha are drawn, opaque, into a layer; else all rows, each with its own alpha */
    float alpha;
    camber_color color; /* colour of all its lines, if composite is COVERAGE or UNION */
    /* opacity with which its layer is composited; polygons are multiplied by it in addition to their fills' opacity */
    float layer_opacity;
    /* 0: none. Commands of one group are consecutive, and are composited onto the picture as a whole */
    uint32_t group;
    float group_opacity;
} camber_draw_command;

/* The view of the plane of the lines. */
typedef struct camber_plane_view {
    bool pitched;
    float eye[4];     /* half the picture's size, px; cosine of the pitch; depth lost per px towards the viewer */
    uint32_t horizon; /* rows of the picture, from its top, in which no lines are drawn */
    double nearest;   /* the most px of the picture that one px of the plane takes */
} camber_plane_view;

typedef struct camber_draw_list {
    camber_context *context;
    camber_draw_command *commands;
    camber_row_paint *rows;
    camber_image_use *image_uses;
    camber_fill_paint *fills; /* fills of polygons' rows */
    camber_area_span *spans;
    size_t command_count, command_capacity, row_count, row_capacity, use_count, use_capacity, fill_count, fill_capacity,
        span_count, span_capacity;
    camber_image_set images; /* images of the frame, each once; image uses refer to them by number */
    uint32_t group_count;
    camber_side_table side_table;
    bool is_sum;       /* the frame counts lines instead of colouring pixels */
    float thinnest_px; /* width of the thinnest paint. INFINITY: none */
    camber_plane_view view;
} camber_draw_list;

/* Checks a frame and makes its list, which replaces the earlier content of *list. Returns CAMBER_ERROR_ARGUMENT
 * (camber.h does not allow the frame), CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
camber_status camber_draw_list_build(camber_draw_list *list, const camber_frame *frame);
void camber_draw_list_free(camber_draw_list *list);

/* Returns the alpha with which a command draws one of its mesh's rows into its layer or the picture; below 0 if it does
 * not draw the row. */
static inline float camber_draw_command_alpha(const camber_draw_command *command, const camber_row_paint *row) {
    if (row->half_width_px < 0.0f || (row->fill == CAMBER_NO_FILL) == (command->composite == CAMBER_COMPOSITE_AREA) ||
        (command->one_alpha && row->color.a != command->alpha))
        return -1.0f;
    return command->one_alpha && command->composite != CAMBER_COMPOSITE_STRAIGHT ? 1.0f : row->color.a;
}

/* Returns half of the width that a paint takes. With a gap there is a rail on each side. */
static inline float camber_paint_half_width(const camber_paint *paint) {
    return paint->gap_px > 0.0f ? 0.5f * paint->gap_px + paint->width_px : 0.5f * paint->width_px;
}

#endif
