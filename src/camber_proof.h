/* Meshes and stages in host memory, the CPU twin, and overdraw, for validation and exporters.
 *
 * The rules of camber.h apply here too. The CPU twin is C code that computes on the host what the kernels compute on
 * the device. It needs no device, and gives the same bytes as a mesh that is read back. src/validate and `camber
 * validate` compare the two. */
#ifndef CAMBER_PROOF_H
#define CAMBER_PROOF_H

#include "camber_files.h"
#include "camber_network.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Meshes in host memory ------------------------------------------------------------------------- */

/* A record as the device stores it: 16 bytes, which the vertex shader reads. A strip has two vertices per record, left
 * and right, and no indices; kernels/join.h says which records a point has. Kite and fan have one record per point, and
 * indices of 4 bytes. */
typedef struct camber_record {
    float x, y;    /* px */
    uint32_t join; /* CAMBER_JOIN_* in kernels/layout.h */
    uint32_t last; /* row << 8 | flags: CAMBER_POINT_* and CAMBER_RECORD_* in kernels/layout.h */
} camber_record;

/* How far along its polyline a record is, in a mesh with arc lengths. The arc length is measured over all points of the
 * polyline, including points of a network that the camera leaves out or cuts away. */
typedef struct camber_arc_length {
    float along_px; /* from the polyline's first point to the record */
    float total_px; /* from its first point to its last */
} camber_arc_length;

/* A vertex as the vertex shader makes it from records. A segment runs from A to B, u is its direction, L its length.
 * The vertex is at P + u * clamp(along * g, -limit_px, +limit_px) + (-u.y, u.x) * across * g with g = half the drawn
 * width + CAMBER_PAD_PX, and P = B if at_end is set, else A. The last (provoking) vertex of each triangle carries the
 * segment that the triangle draws. */
typedef struct camber_vertex {
    float x, y;     /* P, px */
    float dx, dy;   /* B - A, px; 0, 0 for a dot, whose u is 1, 0 */
    float along;    /* in units of g */
    float limit_px; /* limit of the offset along the segment; 3e38: none */
    int16_t across; /* in units of g / 16384 */
    /* Bits 0-2: camber_end at A; 3-5: camber_end at B; 6: at_end; 7: the segment before A is its line's first; 8: the
     * segment after B is its line's last. */
    uint16_t flags;
    int16_t turn_a; /* tan(turn angle / 4) * 32767 at A, positive from x to y (clockwise as drawn); 0: a cap */
    int16_t turn_b; /* tan(turn angle / 4) * 32767 at B */
    uint32_t row;   /* row of the polyline */
} camber_vertex;

/* How the fragment shader draws beyond an end of a segment. */
typedef enum camber_end {
    CAMBER_END_ROUND = 0, /* an arc: coverage follows from the distance to the end point */
    CAMBER_END_BUTT,      /* nothing past the end */
    CAMBER_END_SQUARE,    /* nothing past half a width beyond the end */
    CAMBER_END_MITER,     /* the edges continue; the geometry is cut at the bisector */
    CAMBER_END_BEVEL,     /* cut by the line through the two outer corners */
    /* The same, but only on this segment's side of the bisector, because the geometry is not cut there: at the strip
     * method's tight joins, and at turns of more than 127 degrees. */
    CAMBER_END_SPLIT_ROUND,
    CAMBER_END_SPLIT_BEVEL,
    CAMBER_END_SPLIT_MITER,
} camber_end;

#define CAMBER_RESTART_INDEX 0xffffffffu

/* A mesh in host memory; camber_mesh_data_destroy frees it. */
typedef struct camber_mesh_data camber_mesh_data;
struct camber_mesh_data {
    camber_context *context; /* it allocated the arrays. NULL: they are the caller's, and destroy does not free them */
    camber_mesh_info info;
    /* As on the device: info.record_count records, and for kite and fan info.index_count corners, record << 7 | corner
     * (CAMBER_CORNER_* in kernels/layout.h). corners is NULL for strips. */
    camber_record *records;
    camber_arc_length *arc_lengths; /* one per record. NULL: the mesh has none */
    uint32_t *corners;
    /* As drawn: info.vertex_count vertices and info.index_count indices. Strips have two indices per record; both are
     * CAMBER_RESTART_INDEX if the record is between two strips. At a tight join, two consecutive records have one index
     * in common: one of the two triangles between them has no area, and the other winds the other way and is culled. */
    camber_vertex *vertices;
    uint32_t *indices;
};

/* Returns whether the three indices from first_index on form a triangle that is drawn. In a strip, every index starts a
 * triangle, and triangles at odd indices have their first two corners swapped. */
CAMBER_API bool camber_mesh_data_draws(const camber_mesh_data *data, size_t first_index);

/* Reads a mesh from the device. Free data with camber_mesh_data_destroy.
 * Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_DEVICE. */
CAMBER_API camber_status camber_mesh_read(camber_mesh *mesh, camber_mesh_data *data);
/* Tessellates on the host, by the CPU twin. It gives the same bytes as camber_mesh_tessellate and camber_mesh_read if
 * the device rounds correctly.
 * Returns the errors of camber_mesh_tessellate, except CAMBER_ERROR_DEVICE. */
CAMBER_API camber_status camber_mesh_data_tessellate(camber_context *context, const camber_polylines *polylines,
                                                     const camber_tessellation_desc *desc, camber_mesh_data *data);
CAMBER_API void camber_mesh_data_destroy(camber_mesh_data *data);

/* ---- Networks as a camera sees them ----------------------------------------------------------------- */

/* Projects a network on the host, by the CPU twin. The result has one polyline per entry; camber_mesh_tessellate makes
 * the same mesh from them as camber_mesh_tessellate_network makes from the network.
 * Only the strokes of desc are read.
 * Returns CAMBER_ERROR_ARGUMENT (a camera that camber_mesh_tessellate_network rejects), CAMBER_ERROR_LIMIT,
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_network_project(const camber_network *network, const camber_camera *camera,
                                                const camber_tessellation_desc *desc, camber_polylines **polylines);
/* Projects a network on the host as camber_network_project does, but makes each visible stretch of a line a polyline of
 * its own. Entries that are not visible have no polylines. A ring that is cut starts at a cut. */
CAMBER_API camber_status camber_network_project_lines(const camber_network *network, const camber_camera *camera,
                                                      const camber_tessellation_desc *desc, camber_lines *lines);

/* ---- Stages: results that the mesh is made from -------------------------------------------------- */

/* A tessellated point, with the results of the stages classify and scan. */
typedef struct camber_point_stages {
    uint32_t polyline;     /* as given */
    uint32_t point;        /* index among the polyline's kept points */
    float x, y;            /* px */
    uint32_t join;         /* the join word from classify; CAMBER_JOIN_* in kernels/layout.h describe its bits */
    uint32_t info;         /* flags, and the row above them: CAMBER_POINT_* in kernels/layout.h */
    uint64_t first_vertex; /* index in the mesh at which emit writes this point's vertices */
    uint64_t first_index;  /* index at which emit writes this point's indices */
} camber_point_stages;

/* The points of a tessellation. Free them with camber_stages_destroy. */
typedef struct camber_stages {
    camber_context *context;        /* it allocated the arrays. NULL: there are none */
    camber_point_stages *points;    /* point_count of them, in input order; rings repeat their first point at the end */
    camber_arc_length *arc_lengths; /* one per point. NULL: the tessellation has none */
    size_t point_count;
} camber_stages;

/* Reads the stages of the last tessellation from the device.
 * Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_DEVICE. */
CAMBER_API camber_status camber_mesh_read_stages(camber_mesh *mesh, camber_stages *stages);
/* Computes the stages on the host, by the CPU twin. Returns the errors of camber_mesh_data_tessellate. */
CAMBER_API camber_status camber_stages_tessellate(camber_context *context, const camber_polylines *polylines,
                                                  const camber_tessellation_desc *desc, camber_stages *stages);
CAMBER_API void camber_stages_destroy(camber_stages *stages);

/* ---- Stages of drawing: the results of CAMBER_RASTERIZER_OPENCL's kernels for a frame -------------------------- */

/* The stages of the first rectangle (area) that a frame is drawn in. If the frame has at most 16 M px, and at most 8192
 * px on each side, this is the whole frame. Tiles are 32 px square. Free the stages with camber_drawing_stages_destroy.
 */
typedef struct camber_drawing_stages {
    camber_context *context; /* it allocated the arrays. NULL: there are none */
    /* Stage setup writes one segment for each record of the passes (the segment that ends there), in drawing order. For
     * each part of a mesh, the number of segments is rounded up to a multiple of 16. A segment has segment_words words,
     * floats and bits, from which tiles and pixels are drawn. The words of a segment that is not drawn are undefined.
     * Its box is four bytes, in tiles: the column and row of the first tile, then the column and row of the last tile.
     * If the last column is before the first, nothing is drawn.
     * There are arc lengths if passes have gaps, blurs, dashes, trims, ramps or images. A frame with a pitch also has
     * each segment's words in the plane. */
    float *segments;    /* segment_words * segment_count */
    uint32_t *boxes;    /* segment_count */
    float *arc_lengths; /* arc_length_words * segment_count. NULL: no pass has any of these */
    float *planes;      /* plane_words * segment_count. NULL: not pitched */
    size_t segment_count, segment_words, arc_length_words, plane_words;
    /* Stages bin_count and bin_scan compute where each tile's list begins: columns * rows + 1 numbers, row by row. */
    uint32_t *starts;
    uint32_t columns, rows;
    uint32_t *lists; /* from stage bin_scatter: the segments of each tile in drawing order */
    uint8_t *rgba;   /* from stage rasterize: width * height pixels, premultiplied */
    uint32_t width, height;
} camber_drawing_stages;

/* Draws the first rectangle of a frame and reads the stages from the device.
 * renderer must draw in OpenCL.
 * Returns the errors of camber_renderer_render, and CAMBER_ERROR_LIMIT also if the frame takes several slices. */
CAMBER_API camber_status camber_renderer_read_stages(camber_renderer *renderer, const camber_frame *frame,
                                                     camber_drawing_stages *stages);
/* Computes the stages on the host, by the CPU twin, from the records on the device. The bytes are the same as from
 * camber_renderer_read_stages, except for segments that are not drawn, and so are the parameters and return values. */
CAMBER_API camber_status camber_drawing_stages_rasterize(camber_renderer *renderer, const camber_frame *frame,
                                                         camber_drawing_stages *stages);
CAMBER_API void camber_drawing_stages_destroy(camber_drawing_stages *stages);

/* ---- Overdraw, counted on the GPU ------------------------------------------------------------------ */

/* Consecutive indices of a mesh, as camber_mesh_read numbers them. A range of triangles contains whole triangles. A
 * range of strips contains part of one strip, or several whole strips, and begins at an even index. */
typedef struct camber_index_range {
    uint64_t first_index, index_count;
} camber_index_range;

typedef struct camber_overdraw_desc {
    uint32_t width, height; /* size of the picture, px */
    camber_mesh *mesh;
    /* paint_count of them; only widths are read. Rows at or past paint_count are not drawn */
    const camber_paint *paints;
    size_t paint_count;
    /* range_count of them, each counted separately. NULL: one per polyline of the mesh */
    const camber_index_range *ranges;
    size_t range_count;
    /* Receives width * height numbers: for each pixel, the number of ranges that draw it more than once, up to 255.
     * NULL: not wanted. */
    uint8_t *map;
} camber_overdraw_desc;

typedef struct camber_overdraw {
    /* shaded fragments: every pixel of every triangle of the ranges, including those without coverage */
    uint64_t fragments;
    uint64_t drawn_pixels;    /* pixels with a coverage of 1e-5 or more, counted once per range */
    uint64_t repeated_pixels; /* pixels with coverage from more than one fragment of a range, counted once per range */
} camber_overdraw;

/* Counts the pixels that the GPU draws for a mesh, and the pixels that it draws more than once.
 * Returns the errors of camber_renderer_render, and CAMBER_ERROR_ARGUMENT (the renderer does not draw in GL).
 * It counts with the stencil and additive blending, in two draw calls per range. */
CAMBER_API camber_status camber_renderer_count_overdraw(camber_renderer *renderer, const camber_overdraw_desc *desc,
                                                        camber_overdraw *overdraw);

#ifdef __cplusplus
}
#endif

#endif
