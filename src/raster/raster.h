/* Drawing in OpenCL: shape -> count -> total -> fill -> cover, of the records of meshes, and the CPU twin.
 *
 * The kernels are built in variants, so that a plain frame pays for nothing that it has not; camber_cover_variant says
 * which one a scene takes:
 *
 * - 0: inks alone.
 * - CAMBER_COVER_RICH: scene.more says for each ink what kernels/cover_bands.h lists, and the tail has the float4s that
 *   it names. shape writes measures besides; an ink without features gets the same bytes as from the plain variant.
 * - CAMBER_COVER_RICH | CAMBER_COVER_PITCHED: the plane of the lines is seen at an angle.
 *
 * In kernels a variant is what #if CAMBER_COVER_RICH and #if CAMBER_COVER_PITCHED leave; the twin has all of them and
 * goes by the scene. */
#ifndef CAMBER_COVER_H
#define CAMBER_COVER_H

#include "tess/mesh.h"

#include "camber_proof.h"
#include "kernels/cover_pitch_bands.h"
#include "kernels/cover_pitch_images.h"

/* Polylines [first, end) of a mesh, drawn by a table of rows. */
typedef struct camber_cover_run {
    camber_mesh *mesh; /* NULL: the picture is filled with the ink of the first row, which is CAMBER_FILL_PX wide */
    size_t first, end;
    size_t first_row; /* of the table, in all rows */
} camber_cover_run;

/* What is drawn, in drawing order. Inks of one layer follow each other, and so do those of a group. */
typedef struct camber_cover_scene {
    const float *rows; /* row_count times CAMBER_COVER_ROW_WORDS; the ink's number is a word like the others */
    size_t row_count;
    const camber_ink *inks; /* at least one */
    size_t ink_count;
    const camber_cover_run *runs;
    size_t run_count;
    float background[4]; /* premultiplied */
    bool linear;
    bool pitched; /* the plane of the lines is seen at an angle: there is more */
    camber_eye eye;
    uint32_t horizon;            /* rows of the picture, from its top, in which nothing is drawn */
    float sky[4];                /* what they have, premultiplied */
    const camber_ink_more *more; /* ink_count. NULL: the frame is plain */
    const float *tail;           /* tail_count times 4 */
    size_t tail_count;
} camber_cover_scene;

/* Of the program that draws it. */
unsigned camber_cover_variant(const camber_cover_scene *scene);

/* A part of the picture that is drawn at once, px; a multiple of CAMBER_TILE_PX from its edges, and no side longer than
 * CAMBER_TILES_MAX tiles. */
typedef struct camber_cover_area {
    uint32_t x, y, width, height;
} camber_cover_area;

typedef struct camber_cover_pixels {
    const uint8_t *rgba; /* of the area's first pixel */
    size_t row_bytes;
} camber_cover_pixels;

/* Milliseconds of the last area's kernels on the device's queue. */
typedef struct camber_cover_times {
    double shape_ms, count_ms, total_ms, fill_ms, cover_ms;
} camber_cover_times;

typedef struct camber_cover camber_cover;

camber_status camber_cover_create(camber_device *device, camber_cover **cover);
void camber_cover_destroy(camber_cover *cover);
/* Draws an area. What it was drawn from may go afterwards. */
camber_status camber_cover_draw(camber_cover *cover, const camber_cover_scene *scene, const camber_cover_area *area);
/* The same into a buffer of the caller's, of camber_cover_bytes; there is nothing to map then. */
camber_status camber_cover_draw_into(camber_cover *cover, const camber_cover_scene *scene,
                                     const camber_cover_area *area, cl_mem pixels);
/* The pixels of the area that was drawn last, until they are unmapped. */
camber_status camber_cover_map(camber_cover *cover, camber_cover_pixels *pixels);
void camber_cover_unmap(camber_cover *cover, camber_cover_pixels pixels);
camber_cover_times camber_cover_get_times(const camber_cover *cover);
/* px; of an area, where memory is bounded: a row of its tiles can be kept between slices. */
uint32_t camber_cover_widest(const camber_cover *cover);
/* How many slices of shapes, in bands, the area that was drawn last took. */
uint32_t camber_cover_slices(const camber_cover *cover);

/* ---- Stages in host memory, for proofs: freed with camber_cover_stages_free ---- */

typedef struct camber_cover_stages {
    float *shapes;   /* shape_count times CAMBER_SHAPE_WORDS */
    uint32_t *boxes; /* shape_count */
    float *measures; /* shape_count times CAMBER_SHAPE_MEASURES. NULL: of a plain scene */
    float *planes;   /* shape_count times CAMBER_PLANE_WORDS. NULL: not pitched */
    size_t shape_count;
    uint32_t *starts; /* tile_count + 1 */
    size_t tile_count;
    uint32_t *lists; /* starts[tile_count] */
    uint8_t *rgba;   /* of the area */
} camber_cover_stages;

/* Of the area that was drawn last: the last slice of its last band. */
camber_status camber_cover_read_stages(camber_cover *cover, camber_cover_stages *stages);
/* The CPU twin, from what the meshes hold. */
camber_status camber_cover_on_host(camber_context *context, const camber_cover_scene *scene,
                                   const camber_cover_area *area, camber_cover_stages *stages);
void camber_cover_stages_free(camber_context *context, camber_cover_stages *stages);

/* ---- What both need ---- */

/* As the kernels of that name read them. */
typedef struct camber_shape_range {
    uint32_t first, end, record_count;
    uint32_t stride, strips, linear;
    uint32_t base, first_row;
    float left, top;
    uint32_t columns, rows;
    float horizon;
    camber_eye eye;
} camber_shape_range;

/* Runs of records that are drawn by one table. */
typedef struct camber_cover_piece {
    camber_mesh *mesh; /* NULL: the records of a fill */
    size_t part;
    size_t first, end; /* records of the part */
    size_t base;       /* the first shape: a multiple of 16 */
    size_t first_row;
} camber_cover_piece;

/* Lists the pieces of a scene; shape_count is what they take. *pieces is freed with camber_free. */
camber_status camber_cover_list_pieces(camber_context *context, const camber_cover_scene *scene,
                                       camber_cover_piece **pieces, size_t *piece_count, size_t *shape_count);
camber_shape_range camber_cover_range(const camber_cover_scene *scene, const camber_cover_piece *piece,
                                      const camber_cover_area *area);
enum { CAMBER_FILL_RECORDS = 2 };
extern const camber_record camber_fill_records[CAMBER_FILL_RECORDS];
static inline uint32_t camber_cover_tiles(uint32_t side_px) {
    return (side_px + CAMBER_TILE_PX - 1) / CAMBER_TILE_PX;
}
/* Pixels from row to row of an area, and what all of it takes: whole tiles. */
static inline size_t camber_cover_stride_px(const camber_cover_area *area) {
    return (size_t)camber_cover_tiles(area->width) * CAMBER_TILE_PX;
}
static inline size_t camber_cover_bytes(const camber_cover_area *area) {
    return 4 * camber_cover_stride_px(area) * camber_cover_tiles(area->height) * CAMBER_TILE_PX;
}

#endif
