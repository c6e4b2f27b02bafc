/* Draws a list in GL: draw calls for polylines, layers and groups that are flattened, fills, and counts of overdraw.
 *
 *     gl_frame.c     draws areas (rectangles) of a frame, one after another, waits for them and reads them back
 *     gl_commands.c  the list's commands in one area
 *     gl_areas.c     polygons, which kernels fill
 *     gl_batch.c     polylines, in as few draw calls as the driver allows
 *     gl_rows.c      the row texture, from which the stroke shader reads rows
 *     gl_atlas.c     the texture of images
 *     gl_targets.c   textures to draw into
 *     gl_overdraw.c  how often pixels are covered */
#ifndef CAMBER_DRAW_DRAW_GL_H
#define CAMBER_DRAW_DRAW_GL_H

#include "draw/draw_list.h"
#include "gl/shaders.h"

/* ---- State ---- */

/* A texture to draw into, with the size of an area. */
typedef struct camber_target {
    GLuint texture, framebuffer;
    GLuint stencil; /* only for counting */
    GLuint alphas;  /* only for the masked layer, whose texture has the coverage of a pixel as its alpha */
    GLsizei width, height;
} camber_target;

enum {
    CAMBER_TARGET_PICTURE,
    CAMBER_TARGET_COVERAGE, /* layers of one colour */
    CAMBER_TARGET_LAYER,    /* layers of colours */
    CAMBER_TARGET_MASKED,   /* layers of translucent colours */
    CAMBER_TARGET_GROUP,
    CAMBER_TARGET_COUNTS,
    CAMBER_TARGET_GIVEN, /* the caller's texture, while a call draws into it */
    CAMBER_TARGETS
};

/* The row texture: one table for each waiting command, with the rows of its mesh, and then the side table. */
typedef struct camber_row_texture {
    GLuint texture; /* 0: none yet */
    GLsizei height; /* texels */
    float *texels;  /* 4 floats per texel */
    size_t capacity;
} camber_row_texture;

/* Polylines that wait to be drawn. */
typedef struct camber_batch_range {
    size_t first, end; /* polylines */
    size_t table;      /* table of the row texture */
} camber_batch_range;

typedef struct camber_batch {
    camber_mesh *mesh; /* mesh of all ranges */
    bool upright;      /* all ranges are */
    size_t table_count;
    unsigned features; /* CAMBER_FEATURE_* of its commands */
    camber_batch_range *ranges;
    size_t range_count, range_capacity;
    GLint *firsts; /* first vertices of the strips of a draw call */
    GLsizei *counts;
    size_t call_count, first_capacity, count_capacity;
} camber_batch;

/* An image in the atlas. */
typedef struct camber_atlas_image {
    uint64_t hash; /* hash of its pixels */
    camber_image_size size;
    GLint x, y; /* position of its first texel in the atlas */
} camber_atlas_image;

/* Images side by side in one texture, on shelves. */
typedef struct camber_atlas {
    GLuint texture; /* 0: none yet */
    GLsizei height;
    camber_atlas_image *images;
    size_t count, capacity;
    GLint shelf_x, shelf_y, shelf_height; /* where the next image is put */
    uint64_t *hashes;                     /* hashes of the frame's images, by their number. 0: not known yet */
    size_t hash_count, hash_capacity;
} camber_atlas;

typedef struct camber_gl_drawing {
    camber_shaders shaders;
    camber_target targets[CAMBER_TARGETS];
    GLuint vertex_array;
    GLuint record_texture; /* the records of the mesh's part that is bound */
    camber_row_texture rows;
    camber_atlas atlas;
    camber_batch batch;
} camber_gl_drawing;

/* An area of the picture that is drawn at once. */
typedef struct camber_gl_area {
    uint32_t x, y, width, height; /* position and size in the picture, px */
    int target;                   /* target that commands are drawn into */
    camber_coverage coverage;
    float thinnest_px; /* width of the thinnest line of the frame */
    camber_plane_view view;
    size_t *draw_calls;
} camber_gl_area;

/* ---- gl_frame.c ---- */

/* Frees everything that GL draws with. is_current: the GL context is current; else GL's objects are freed with the
 * context. */
void camber_gl_release(camber_renderer *renderer, bool is_current);
/* Logs the errors that GL reports; CAMBER_OK if there are none. */
camber_status camber_gl_check(camber_renderer *renderer, const char *what);
/* Draws a frame, whose list is in the renderer, and passes its rows to `rows`, which may be NULL. */
camber_status camber_gl_render(camber_renderer *renderer, const camber_frame *frame, camber_rows_fn *rows, void *user,
                               camber_frame_stats *stats);
/* Draws a whole frame, whose list is in the renderer, as one area into a target. */
camber_status camber_gl_draw_frame(camber_renderer *renderer, const camber_frame *frame, int target);

/* ---- gl_commands.c ---- */

camber_status camber_gl_draw_commands(camber_renderer *renderer, const camber_gl_area *area);

/* ---- gl_areas.c ---- */

/* Draws commands of polygons into the layer of colours, on a transparent background. The layer is bound, and as large
 * as the area. */
camber_status camber_gl_fill_layer(camber_renderer *renderer, const camber_draw_command *first,
                                   const camber_draw_command *end, const camber_gl_area *area);

/* ---- gl_batch.c ---- */

/* Queues the polylines of a command. If they cannot share a draw call with the polylines that are already queued, draws
 * those first. */
camber_status camber_batch_add(camber_renderer *renderer, const camber_draw_command *command,
                               const camber_gl_area *area);
/* Puts all images of a command into the atlas. If other images have to be evicted for that, first draws everything that
 * is queued. Returns CAMBER_ERROR_LIMIT if the images do not fit together. */
camber_status camber_batch_hold_images(camber_renderer *renderer, const camber_draw_command *command,
                                       const camber_gl_area *area);
/* Draws everything that is queued. The bits of variant are added to the shader's. */
camber_status camber_batch_draw(camber_renderer *renderer, unsigned variant, const camber_gl_area *area);
/* Drops everything that is queued. */
void camber_batch_clear(camber_renderer *renderer);
/* Returns the stroke shader of a mesh for lines of at least this width, with variant's bits added. */
camber_status camber_gl_stroke_shader(camber_renderer *renderer, const camber_mesh *mesh, float thinnest_px,
                                      unsigned variant, const camber_shader **shader);
/* Uses a shader, with its uniforms set for an area and a mesh that has one table. */
void camber_gl_use_shader(camber_renderer *renderer, const camber_shader *shader, const camber_mesh *mesh,
                          const camber_gl_area *area);
/* Binds a part's records and indices, and the row texture. */
void camber_gl_bind_part(camber_renderer *renderer, camber_mesh_part *part);
/* Draws indices of the bound part. */
void camber_gl_draw_indices(camber_renderer *renderer, const camber_mesh *mesh, uint64_t first, uint64_t count);
/* Restricts drawing, from now on, to the rows of the picture that are nearer than the far plane. */
void camber_gl_hide_horizon(camber_renderer *renderer, const camber_gl_area *area);

/* ---- gl_rows.c ---- */

/* Whether the row texture can hold row_count rows and side_texels texels of the side table. */
bool camber_rows_fit(const camber_renderer *renderer, size_t row_count, size_t side_texels);
/* Makes room for these rows and texels. Returns CAMBER_ERROR_LIMIT if that is not possible. */
camber_status camber_rows_reserve(camber_renderer *renderer, size_t row_count, size_t side_texels);
/* Writes a command's table, for which there must be room. */
camber_status camber_rows_write(camber_renderer *renderer, const camber_draw_command *command, size_t table);
/* Appends the side table to the rows, and uploads everything. */
camber_status camber_rows_upload(camber_renderer *renderer, size_t row_count, size_t side_texels);
/* Uploads one table for a mesh, with nothing but widths. Rows past the paints are not drawn. */
camber_status camber_rows_upload_widths(camber_renderer *renderer, const camber_mesh *mesh, const camber_paint *paints,
                                        size_t paint_count);

/* ---- gl_atlas.c ---- */

/* Forgets the images of the previous frame, which the caller may have changed. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_atlas_begin(camber_renderer *renderer);
/* Puts all images of a command into the atlas. *is_full: other images have to be evicted first, which
 * camber_atlas_renew does. */
camber_status camber_atlas_hold(camber_renderer *renderer, const camber_draw_command *command, bool *is_full);
/* Empties the atlas, and puts all images of a command into it. Returns CAMBER_ERROR_LIMIT if they do not fit together.
 */
camber_status camber_atlas_renew(camber_renderer *renderer, const camber_draw_command *command);
/* Returns the rectangle of an image that the atlas holds: its corner and its size, in texture coordinates. */
camber_status camber_atlas_find(camber_renderer *renderer, const camber_image_use *use, float rect[4]);
void camber_atlas_bind(camber_renderer *renderer);
void camber_atlas_release(camber_renderer *renderer, bool is_current);

/* ---- gl_targets.c ---- */

/* Binds a target of this size; its content is undefined. The viewport extends beyond each of its sides by
 * camber_target_guard, but the scissor does not: a software driver clips all triangles of a batch one by one if a
 * single vertex is outside the viewport. */
camber_status camber_target_bind(camber_renderer *renderer, int which, GLsizei width, GLsizei height);
/* Returns how far the viewport extends beyond a side, in px. axis: 0 for the width, 1 for the height. */
GLsizei camber_target_guard(const camber_renderer *renderer, int axis, GLsizei side);
/* Makes a caller's texture the target CAMBER_TARGET_GIVEN until camber_target_take_back. */
camber_status camber_target_give(camber_renderer *renderer, GLuint texture, GLsizei width, GLsizei height);
void camber_target_take_back(camber_renderer *renderer);
void camber_targets_release(camber_renderer *renderer);

#endif
