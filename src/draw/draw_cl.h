/* Draws a list in OpenCL: the list becomes a scene, which the rasterizer draws one area (a rectangle of the picture)
 * after another.
 *
 *     cl_frame.c   areas of a frame, and their pixels
 *     cl_scene.c   the list's commands as a scene: tables of rows, and brushes
 *     cl_images.c  images in the side table
 *     cl_stages.c  results of each kernel, for validation */
#ifndef CAMBER_DRAW_DRAW_CL_H
#define CAMBER_DRAW_DRAW_CL_H

#include "draw/draw_list.h"
#include "raster/raster.h"

/* ---- cl_frame.c ---- */

struct camber_pixel_target;
/* Draws a frame, whose list is in the renderer, and passes its rows to the caller. */
camber_status camber_cl_render(camber_renderer *renderer, const camber_frame *frame, camber_rows_fn *rows, void *user,
                               camber_frame_stats *stats);
camber_status camber_cl_render_into(camber_renderer *renderer, const camber_frame *frame,
                                    struct camber_pixel_target *place, camber_frame_stats *stats);
/* Calls draw for each area of a frame, from the top down, instead of drawing it. */
typedef camber_status camber_area_fn(camber_renderer *renderer, const camber_raster_scene *scene,
                                     const camber_raster_area *area, void *user);
camber_status camber_cl_each_area(camber_renderer *renderer, const camber_frame *frame, camber_area_fn *draw,
                                  void *user);

/* ---- cl_images.c ---- */

/* An image in the side table. */
typedef struct camber_cl_image {
    camber_image image; /* the caller's image */
    camber_image_size size;
    size_t first; /* texel of the side table, which holds four texels of the image */
    bool is_opaque;
} camber_cl_image;

typedef struct camber_cl_images {
    camber_side_table *table;
    camber_cl_image *held;
    size_t count, capacity;
    size_t last_words; /* texel of the side table with the last added words. 0: none yet */
    double nearest;    /* the most px of the picture that one px of the plane takes */
} camber_cl_images;

/* These add the image of a line, or of a fill, to the side table. *words is the texel of the side table that a brush
 * refers to. They return CAMBER_ERROR_LIMIT (the table is full), CAMBER_ERROR_MEMORY. */
camber_status camber_cl_images_add_line(camber_cl_images *images, const camber_image_use *use, uint32_t *words);
camber_status camber_cl_images_add_fill(camber_cl_images *images, const camber_draw_list *list,
                                        const camber_fill_paint *fill, uint32_t *words, bool *is_opaque);

/* ---- cl_scene.c ---- */

/* A scene, and the tables that it points into. */
typedef struct camber_cl_tables {
    camber_raster_scene scene;
    camber_context *context;
    float *rows;
    camber_brush *brushes;
    camber_brush_ext *brush_ext; /* one for each brush */
    camber_raster_input *inputs;
    size_t *changes; /* polylines at which the brush of polygons changes */
    size_t row_count, row_capacity, brush_count, brush_capacity, ext_capacity, input_count, input_capacity,
        change_count, change_capacity;
    uint32_t *fill_images; /* position of each fill's image in the side table. 0: not added yet. NULL: no fills */
    uint32_t fill;         /* brush of the last fill so far that is not part of the background. 0: none */
    bool is_rich;          /* a brush has features */
    bool is_sum;           /* all brushes are sums */
    camber_cl_images images;
    uint32_t layers;     /* layers that the scene has so far */
    float background[4]; /* premultiplied: the colour below the first input */
    float sky[4];        /* premultiplied: the colour above the horizon, where only colours are drawn */
} camber_cl_tables;

/* Makes the scene of a frame's list. The tables must be freed after a failure too. */
camber_status camber_cl_tables_make(camber_draw_list *list, const camber_frame *frame, camber_cl_tables *tables);
void camber_cl_tables_free(camber_cl_tables *tables);

#endif
