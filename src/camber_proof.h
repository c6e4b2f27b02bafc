/* camber: meshes and stages in host memory, the CPU twin, and overdraw, for proofs and exporters.
 *
 * The rules of camber.h hold here too. The CPU twin is C code that makes on the host what the kernels make on the
 * device. It needs no device, and gives the same bytes as a mesh that is read back. src/validate and `camber validate`
 * compare the two.
 */
#ifndef CAMBER_PROOF_H
#define CAMBER_PROOF_H

#include "camber_files.h"
#include "camber_network.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Meshes in host memory ------------------------------------------------------------------------- */

/* A point as the device keeps it: 16 bytes, which the vertex shader reads. A strip has two vertices a record, the
 * left one and the right one, and no indices; kernels/join.h says which records a point has. kite and fan have a record
 * a point and indices of 4 bytes. */
typedef struct camber_record {
    float x, y;    /* px */
    uint32_t join; /* CAMBER_JOIN_* in kernels/layout.h */
    uint32_t last; /* row << 8 | flags: CAMBER_POINT_* and CAMBER_RECORD_* there */
} camber_record;

/* How far along its polyline a record lies, in a mesh with arc lengths. The arc length goes over all points of the
 * polyline, in a network also over those that the camera leaves out or cuts away. */
typedef struct camber_arc_length {
    float along_px; /* from the polyline's first point to the record */
    float total_px; /* from its first point to its last */
} camber_arc_length;

/* A vertex as the vertex shader makes it from records. A segment runs from A to B, u is its direction, L its length.
 * The vertex lies at P + u * clamp(along * g, -limit_px, +limit_px) + (-u.y, u.x) * across * g with g = half the width
 * that is drawn + CAMBER_PAD_PX, and P = B where at_end, else A. All vertices but those that no triangle ends with (is
 * provoked by) carry the segment that the triangle draws. */
typedef struct camber_vertex {
    float x, y;     /* P, px */
    float dx, dy;   /* B - A, px; 0, 0 for a dot, whose u is 1, 0 */
    float along;    /* in units of g */
    float limit_px; /* bound on the offset along the segment; 3e38: none */
    int16_t across; /* in units of g / 16384 */
    /* Bits 0-2: camber_end at A; 3-5: camber_end at B; 6: at_end; 7: the segment before A is its line's first, 8: that
     * behind B is its line's last. */
    uint16_t flags;
    int16_t turn_a; /* tan(turn angle / 4) * 32767 at A, positive from x to y (clockwise as drawn); 0: a cap */
    int16_t turn_b; /* the same at B */
    uint32_t row;   /* of the polyline */
} camber_vertex;

/* How the fragment shader draws past an end of a segment. */
typedef enum camber_end {
    CAMBER_END_ROUND = 0, /* distance to the end point: the paper's arc */
    CAMBER_END_BUTT,      /* nothing past the end */
    CAMBER_END_SQUARE,    /* nothing past half a width beyond the end */
    CAMBER_END_MITER,     /* the edges run on; the geometry is cut at the bisector */
    CAMBER_END_BEVEL,     /* cut by the line through the two outer corners */
    /* The same, on this segment's side of the bisector only: where the geometry is not cut along it, at strip's tight
     * joins and turns past 127 degrees. */
    CAMBER_END_SPLIT_ROUND,
    CAMBER_END_SPLIT_BEVEL,
    CAMBER_END_SPLIT_MITER,
} camber_end;

#define CAMBER_RESTART_INDEX 0xffffffffu

/* A mesh in host memory, which camber_mesh_data_destroy frees. */
typedef struct camber_mesh_data camber_mesh_data;
struct camber_mesh_data {
    camber_context *context; /* which allocated the arrays. NULL: they are the caller's, and destroy leaves them */
    camber_mesh_info info;
    /* As on the device: info.record_count, and of kite and fan info.index_count, record << 7 | corner
     * (CAMBER_CORNER_* in kernels/layout.h); NULL of strips. */
    camber_record *records;
    camber_arc_length *arc_lengths; /* as many. NULL: the mesh has none */
    uint32_t *corners;
    /* As drawn: info.vertex_count, and info.index_count. With strips these are two indices a record, both
     * CAMBER_RESTART_INDEX where it lies between two strips. At a tight join two records follow each other that have
     * one index in common: of the two triangles between them one has no area, the other winds the other way and is
     * culled. */
    camber_vertex *vertices;
    uint32_t *indices;
};

/* Returns whether the three indices from first_index on are a triangle that is drawn. In a strip each index begins
 * three of them, and the triangles at odd indices have their first two corners in the other order. */
CAMBER_API bool camber_mesh_data_draws(const camber_mesh_data *data, size_t first_index);

/* Reads a mesh from the device. camber_mesh_data_destroy frees what it gives.
 * Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_DEVICE. */
CAMBER_API camber_status camber_mesh_read(camber_mesh *mesh, camber_mesh_data *data);
/* Tessellates on the host, by the CPU twin. It gives the same bytes as camber_mesh_tessellate and camber_mesh_read
 * where the device rounds correctly.
 * Returns what camber_mesh_tessellate does, but for CAMBER_ERROR_DEVICE. */
CAMBER_API camber_status camber_mesh_data_tessellate(camber_context *context, const camber_polylines *polylines,
                                                     const camber_tessellation_desc *desc, camber_mesh_data *data);
CAMBER_API void camber_mesh_data_destroy(camber_mesh_data *data);

/* ---- Networks: what a camera makes of them ---------------------------------------------------------- */

/* Projects a network on the host, by the CPU twin. It gives one polyline for each entry: those of which
 * camber_mesh_tessellate makes the mesh that camber_mesh_tessellate_network would make.
 * Only the strokes of desc matter.
 * Returns CAMBER_ERROR_ARGUMENT (a camera as camber_mesh_tessellate_network refuses it), CAMBER_ERROR_LIMIT,
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_network_project(const camber_network *network, const camber_camera *camera,
                                                const camber_tessellation_desc *desc, camber_polylines **polylines);
/* Projects a network on the host as camber_network_project does, with each stretch of a line that the camera sees
 * as a polyline of its own. Entries of which nothing is seen have none. A ring that is cut begins at a cut. */
CAMBER_API camber_status camber_network_project_lines(const camber_network *network, const camber_camera *camera,
                                                      const camber_tessellation_desc *desc, camber_lines *lines);

/* ---- Stages: what came before the mesh ----------------------------------------------------------- */

/* A point that is tessellated, as classify and scan found it. */
typedef struct camber_point_stages {
    uint32_t polyline;     /* as given */
    uint32_t point;        /* of the polyline's kept points */
    float x, y;            /* px */
    uint32_t join;         /* classify's word; its bits: CAMBER_JOIN_* in kernels/layout.h */
    uint32_t info;         /* flags, and the row above them: CAMBER_POINT_* in kernels/layout.h */
    uint64_t first_vertex; /* of the mesh: where emit puts this point's vertices */
    uint64_t first_index;  /* and its indices */
} camber_point_stages;

/* The points of a tessellation. camber_stages_destroy frees them. */
typedef struct camber_stages {
    camber_context *context;        /* which allocated the arrays. NULL: nothing is there */
    camber_point_stages *points;    /* point_count, in input order; rings have their first point again at the end */
    camber_arc_length *arc_lengths; /* as many. NULL: the tessellation has none */
    size_t point_count;
} camber_stages;

/* Reads the stages of the last tessellation from the device.
 * Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_DEVICE. */
CAMBER_API camber_status camber_mesh_read_stages(camber_mesh *mesh, camber_stages *stages);
/* Makes the stages on the host, by the CPU twin. Returns what camber_mesh_data_tessellate does. */
CAMBER_API camber_status camber_stages_tessellate(camber_context *context, const camber_polylines *polylines,
                                                  const camber_tessellation_desc *desc, camber_stages *stages);
CAMBER_API void camber_stages_destroy(camber_stages *stages);

/* ---- Stages of drawing: what CAMBER_RASTERIZER_OPENCL's kernels found for a frame ------------------------------ */

/* The stages of a frame's first area, which is all of it up to 16 M px and 8192 px a side. Tiles are 32 px square.
 * camber_drawing_stages_destroy frees it. */
typedef struct camber_drawing_stages {
    camber_context *context; /* which allocated the arrays. NULL: nothing is there */
    /* Stage setup writes the segment that ends at each record of the passes, in drawing order. The number of segments
     * is rounded up to sixteens for each part of a mesh. A segment has segment_words floats and bits, which tiles and
     * pixels are drawn from. A segment that is not drawn has undefined words.
     * Its box is four bytes, in tiles: the column and the row of the first one, the column and the row of the last one.
     * Where the last column lies before the first, nothing is drawn.
     * Arc lengths are there where passes have gaps, blurs, dashes, trims, ramps or images. A frame that is pitched has
     * words of the plane for each segment too. */
    float *segments;    /* segment_words * segment_count */
    uint32_t *boxes;    /* segment_count */
    float *arc_lengths; /* arc_length_words * segment_count. NULL: no pass has any of these */
    float *planes;      /* plane_words * segment_count. NULL: not pitched */
    size_t segment_count, segment_words, arc_length_words, plane_words;
    /* Stages bin_count and bin_scan find where the list of each tile begins: columns * rows + 1 numbers, row by row. */
    uint32_t *starts;
    uint32_t columns, rows;
    uint32_t *lists; /* of stage bin_scatter: the segments of each tile in drawing order */
    uint8_t *rgba;   /* of stage rasterize: width * height pixels, premultiplied */
    uint32_t width, height;
} camber_drawing_stages;

/* Draws the first area of a frame and reads the stages from the device.
 * renderer is one that draws in OpenCL.
 * Returns what camber_renderer_render returns, and CAMBER_ERROR_LIMIT also where the frame takes several slices. */
CAMBER_API camber_status camber_renderer_read_stages(camber_renderer *renderer, const camber_frame *frame,
                                                     camber_drawing_stages *stages);
/* Makes the stages on the host, by the CPU twin, from the records that the device has. They are the same bytes as those
 * of camber_renderer_read_stages, but for segments that are not drawn. The parameters and what it returns are the same.
 */
CAMBER_API camber_status camber_drawing_stages_rasterize(camber_renderer *renderer, const camber_frame *frame,
                                                         camber_drawing_stages *stages);
CAMBER_API void camber_drawing_stages_destroy(camber_drawing_stages *stages);

/* ---- Overdraw: what the GPU does for a mesh, counted on it ----------------------------------------- */

/* Consecutive indices of a mesh, as camber_mesh_read numbers them. A range of triangles has whole ones. A range of
 * strips has a part of one strip, or several whole ones, and begins at an even index. */
typedef struct camber_index_range {
    uint64_t first_index, index_count;
} camber_index_range;

typedef struct camber_overdraw_desc {
    uint32_t width, height; /* of the picture, px */
    camber_mesh *mesh;
    const camber_paint *paints; /* paint_count; only widths matter. A row at or past it is not drawn */
    size_t paint_count;
    const camber_index_range *ranges; /* range_count, each counted by itself. NULL: the mesh's polylines */
    size_t range_count;
    /* Takes width * height numbers: in how many ranges a pixel is repeated, up to 255. NULL: they are not wanted. */
    uint8_t *map;
} camber_overdraw_desc;

typedef struct camber_overdraw {
    uint64_t fragments;       /* shaded: every pixel of every triangle of the ranges, those without coverage too */
    uint64_t drawn_pixels;    /* with coverage, 1e-5 or more, once a range */
    uint64_t repeated_pixels; /* with coverage from more than one fragment of a range, once a range */
} camber_overdraw;

/* Counts the pixels that the GPU draws for a mesh, and those that it draws again.
 * Returns what camber_renderer_render returns, and CAMBER_ERROR_ARGUMENT where the renderer does not draw in GL.
 * It counts with the stencil and additive blending, and takes two draw calls a range. */
CAMBER_API camber_status camber_renderer_count_overdraw(camber_renderer *renderer, const camber_overdraw_desc *desc,
                                                        camber_overdraw *overdraw);

#ifdef __cplusplus
}
#endif

#endif
