/* A renderer and its frames, whether it draws in GL or in OpenCL.
 *
 * A frame becomes a draw list (draw_list.h). GL draws it with shaders (draw_gl.h), OpenCL with the rasterizer
 * (draw_cl.h), one area (a rectangle of the picture) after another. */
#ifndef CAMBER_DRAW_RENDERER_H
#define CAMBER_DRAW_RENDERER_H

#include "draw/draw_gl.h"
#include "draw/draw_list.h"
#include "gl/share.h"
#include "residency/mesh.h"

/* The caller's memory that a picture is written to. */
typedef struct camber_place {
    uint8_t *rgba;
    size_t row_bytes, stride_bytes;
} camber_place;

/* A camber_rows_fn that copies rows to such memory. */
bool camber_place_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count);

/* A frame in flight: camber_renderer_begin has begun it, and it has not ended. */
typedef struct camber_flight {
    camber_frame frame;
    /* the whole picture is drawn, or will be when the fence is passed. Else camber_renderer_end draws the rest */
    bool is_drawn;
    uint32_t area_width, area_height; /* GL: size of the first area, which is drawn when the frame begins */
    int target;                       /* GL: the target that areas are drawn into */
    GLsync drawn;                     /* GL: a fence after the first area. NULL: it is finished */
    uint64_t number;                  /* counts the frames that have begun */
    camber_pass *passes;              /* copies of the caller's, if camber_renderer_end draws the rest */
    camber_paint *paints;
    uint8_t *rgba; /* OpenCL: the picture, if it is drawn already */
    camber_frame_stats stats;
} camber_flight;

struct camber_renderer {
    camber_share share;
    const camber_share_path *path; /* NULL: there is no surface */
    camber_draw_list list;         /* list of the current frame */
    /* Draws in OpenCL; GL then only brings its pixels into textures. NULL: GL draws. */
    struct camber_raster *raster;
    struct camber_raster *areas; /* fills polygons if GL draws the rest. NULL: not needed so far */
    camber_shared_buffer pixels; /* pixels that the rasterizer writes and GL reads */
    camber_gl_drawing gl;        /* what GL draws with. Empty without a surface */
    camber_flight flights[CAMBER_FRAMES_IN_FLIGHT];
    size_t first_flight, flight_count; /* a ring */
};

/* Checks a frame and resolves it into the renderer's list. */
camber_status camber_renderer_resolve(camber_renderer *renderer, const camber_frame *frame);

/* Drops all frames in flight. */
void camber_renderer_drop_flights(camber_renderer *renderer, bool is_current);

#endif
