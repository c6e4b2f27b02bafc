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
typedef struct camber_pixel_target {
    uint8_t *rgba;
    size_t row_bytes, stride_bytes;
} camber_pixel_target;

/* A camber_rows_fn that copies rows to a camber_pixel_target. */
bool camber_pixel_target_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count);

struct camber_renderer {
    camber_share share;
    const camber_share_path *path; /* NULL: there is no surface */
    camber_draw_list list;         /* list of the current frame */
    /* Draws in OpenCL; GL then only copies the pixels into textures. NULL: GL draws. */
    struct camber_raster *raster;
    struct camber_raster *areas; /* fills polygons if GL draws the rest. NULL: not needed so far */
    camber_shared_buffer pixels; /* pixels that the rasterizer writes and GL reads */
    camber_gl_drawing gl;        /* the objects that GL draws with. Empty without a surface */
};

/* Checks a frame and resolves it into the renderer's list. */
camber_status camber_renderer_resolve(camber_renderer *renderer, const camber_frame *frame);

#endif
