/* The draw list of a frame: its passes, checked and resolved into commands that GL or OpenCL draws.
 *
 * A command fills the picture, or draws some polylines of a mesh in one way: straight onto the picture, or through a
 * layer that is put over it as a whole. All rules about alphas, layers, groups and features are in draw_list.c; what
 * draws a list only follows it. The list refers to the frame's meshes and images, not to its passes and paints. */
#ifndef CAMBER_DRAW_DRAW_LIST_H
#define CAMBER_DRAW_DRAW_LIST_H

#include "draw/images.h"
#include "draw/side_table.h"
#include "residency/mesh.h"

#include "kernels/features.h" /* CAMBER_FEATURE_* */

/* How the lines of a command come together and onto the picture. */
typedef enum camber_composite {
    CAMBER_COMPOSITE_STRAIGHT, /* no layer: each line goes over what lies below it */
    CAMBER_COMPOSITE_COLORS,   /* a layer of colours */
    CAMBER_COMPOSITE_COVERAGE, /* a layer of one colour: coverage is gathered, one line over the other */
    CAMBER_COMPOSITE_UNION,    /* the same, and where edges meet in a pixel it has the area of all lines together */
    CAMBER_COMPOSITE_MASKED,   /* a layer of translucent colours, in which the last line alone is seen */
    CAMBER_COMPOSITE_AREA,     /* no layer: what is inside of the polylines is filled, all of a fill at once */
} camber_composite;

/* A row's paint, with where the side table has what it names. */
typedef struct camber_row_paint {
    float half_width_px; /* with the gap. Below 0: the row is not drawn */
    float half_gap_px;   /* below 0: no gap */
    float blur_px;       /* below 0: as wide, by a smooth step */
    float translate_px[2];
    float trim[2]; /* shares of the line, between which it is not drawn; what is trimmed at an end takes the cap too */
    camber_color color; /* straight; with an image white, and the paint's alpha */
    unsigned features;  /* CAMBER_FEATURE_* */
    bool has_translucent_ramp;
    camber_side_dashes dashes;       /* with CAMBER_FEATURE_DASH */
    uint32_t first_stop, stop_count; /* with CAMBER_FEATURE_RAMP */
    size_t image_use;                /* of the list, with CAMBER_FEATURE_IMAGE */
    int32_t fill;                    /* of the list: the row's areas are filled. CAMBER_NO_FILL: its lines are drawn */
} camber_row_paint;

enum { CAMBER_NO_FILL = -1 };

/* A fill of the whole picture, or of areas. */
typedef struct camber_fill_paint {
    camber_color color; /* straight, the pass's opacity in its alpha; with an image white */
    bool has_image;
    size_t image_use, mean_use; /* of the list */
    float x_px, y_px;           /* in the picture: the top left corner of one image */
    double bearing_deg;
    camber_fill_rule rule;
} camber_fill_paint;

/* Areas that follow each other and have one fill. */
typedef struct camber_area_span {
    size_t first; /* polyline */
    int32_t fill; /* of the list */
} camber_area_span;

typedef struct camber_draw_command {
    camber_mesh *mesh;             /* NULL: a fill of the picture */
    camber_fill_paint fill;        /* of the picture */
    size_t first_span, span_count; /* of the list, where composite is AREA: its rows are those that have a fill */
    size_t first, end;             /* polylines of the mesh */
    size_t first_row;              /* of the list's rows, of which every row of the mesh has one */
    unsigned features;             /* CAMBER_FEATURE_* of its rows */
    camber_composite composite;
    bool one_alpha; /* only rows of this alpha are drawn, in a layer as opaque ones; else all, each with its own */
    float alpha;
    camber_color color;  /* of all its lines, where composite is COVERAGE or UNION */
    float layer_opacity; /* at which its layer is put over what lies below; of areas, beside their fills' own */
    uint32_t group;      /* 0: none. Commands of one group follow each other, and are put onto the picture as one */
    float group_opacity;
} camber_draw_command;

/* How the plane of the lines is seen. */
typedef struct camber_plane_view {
    bool pitched;
    float eye[4];     /* half the picture's size, px; cosine of the pitch; depth lost a px towards the viewer */
    uint32_t horizon; /* rows of the picture, from its top, in which no lines are drawn */
    double nearest;   /* px of the picture that a px of the plane takes at most */
} camber_plane_view;

typedef struct camber_draw_list {
    camber_context *context;
    camber_draw_command *commands;
    camber_row_paint *rows;
    camber_image_use *image_uses;
    camber_fill_paint *fills; /* of rows of areas */
    camber_area_span *spans;
    size_t command_count, command_capacity, row_count, row_capacity, use_count, use_capacity, fill_count, fill_capacity,
        span_count, span_capacity;
    camber_image_set images; /* of the frame, each once: numbers of image uses are theirs */
    uint32_t group_count;
    camber_side_table side_table;
    float thinnest_px; /* width of the thinnest paint. INFINITY: none */
    camber_plane_view view;
} camber_draw_list;

/* Checks a frame and makes the list of it, in place of what the list had. Returns CAMBER_ERROR_ARGUMENT where camber.h
 * does not allow the frame, CAMBER_ERROR_LIMIT, CAMBER_ERROR_MEMORY. */
camber_status camber_draw_list_build(camber_draw_list *list, const camber_frame *frame);
void camber_draw_list_free(camber_draw_list *list);

/* The alpha at which a command draws one of its mesh's rows into its layer or the picture. Below 0: it does not. */
static inline float camber_draw_command_alpha(const camber_draw_command *command, const camber_row_paint *row) {
    if (row->half_width_px < 0.0f || (row->fill == CAMBER_NO_FILL) == (command->composite == CAMBER_COMPOSITE_AREA) ||
        (command->one_alpha && row->color.a != command->alpha))
        return -1.0f;
    return command->one_alpha && command->composite != CAMBER_COMPOSITE_STRAIGHT ? 1.0f : row->color.a;
}

/* Half of the width that a paint takes. With a gap it has a rail on each side. */
static inline float camber_paint_half_width(const camber_paint *paint) {
    return paint->gap_px > 0.0f ? 0.5f * paint->gap_px + paint->width_px : 0.5f * paint->width_px;
}

#endif
