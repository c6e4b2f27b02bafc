/* The OpenCL rasterizer draws the points of meshes in the stages setup -> bin_count -> bin_scan -> bin_scatter -> wind
 * (if there are polygons to fill) -> rasterize. The CPU twin computes the same bytes.
 *
 * Input: a scene, which lists polylines of meshes with tables of rows and brushes. Output: the pixels of an area, which
 * in this file is a rectangle of the picture. The kernels are built in variants, so that a plain frame does not pay for
 * features that it lacks:
 *
 * - 0: only brushes.
 * - CAMBER_RASTER_RICH: scene.brush_ext has the features of each brush (kernels/features.h), and the side table has the
 *   float4s that these refer to. setup also writes arc lengths. A brush without features is drawn with the same bytes
 *   as by the plain variant.
 * - CAMBER_RASTER_RICH | CAMBER_RASTER_PITCHED: the plane of the lines is seen at an angle.
 *
 * In kernels #if CAMBER_RASTER_RICH and #if CAMBER_RASTER_PITCHED select a variant; the twin contains all of them, and
 * the scene selects one. */
#ifndef CAMBER_RASTER_RASTER_H
#define CAMBER_RASTER_RASTER_H

#include "residency/parts.h"
#include "stroke/stroke.h"

#include "camber_proof.h"
#include "kernels/edge.h"

/* Polylines [first, end) of a mesh, drawn with a table of rows. At each change, the number of the brush goes up by one,
 * counted from the row's brush. So polygons with many fills are drawn in their order. */
typedef struct camber_raster_input {
    camber_mesh *mesh;
    size_t first, end;
    size_t first_row; /* where its table begins among all rows */
    bool is_area;     /* the polylines are rings to fill: rows that are drawn have a half width of CAMBER_EDGE_PX */
    bool upright;     /* they are in the picture as it is seen, not in the plane */
    size_t first_change, change_count; /* among the scene's changes */
} camber_raster_input;

/* Everything that is drawn, in drawing order, with brushes in the same order; fills of the picture are only brushes.
 * The brushes of one layer are consecutive, and so are the brushes of one group. */
typedef struct camber_raster_scene {
    /* row_count times CAMBER_RASTER_ROW_WORDS; the brush's number is stored as the bits of a camber_u32 */
    const float *rows;
    size_t row_count;
    const camber_brush *brushes; /* at least one */
    size_t brush_count;
    const camber_raster_input *inputs;
    size_t input_count;
    float background[4]; /* premultiplied */
    bool linear;
    bool pitched; /* the picture has a pitch; the fields below are only valid then */
    camber_eye eye;
    uint32_t horizon;                  /* rows of pixels at the picture's top that show the sky */
    float sky[4];                      /* the sky's colour, premultiplied */
    const camber_brush_ext *brush_ext; /* brush_count of them. NULL: the frame is plain */
    const float *side_table;           /* side_table_count times 4 floats */
    size_t side_table_count;
    const size_t *changes; /* polylines at which the brush changes, ascending within an input */
} camber_raster_scene;

/* Returns the variant of the program that draws a scene. */
unsigned camber_raster_variant(const camber_raster_scene *scene);

/* A rectangle of the picture that is drawn at once, in px. x and y are multiples of CAMBER_TILE_PX, and no side is
 * longer than CAMBER_TILES_MAX tiles. */
typedef struct camber_raster_area {
    uint32_t x, y, width, height;
} camber_raster_area;

typedef struct camber_raster_pixels {
    const uint8_t *rgba; /* the area's first pixel */
    size_t row_bytes;
} camber_raster_pixels;

/* Milliseconds that the last area's kernels took on the device's queue. */
typedef struct camber_raster_times {
    double setup_ms, bin_count_ms, bin_scan_ms, bin_scatter_ms, wind_ms, rasterize_ms;
} camber_raster_times;

typedef struct camber_raster camber_raster;

camber_status camber_raster_create(camber_device *device, camber_raster **raster);
void camber_raster_destroy(camber_raster *raster);
/* Releases the buffers that are kept for the next area. */
void camber_raster_trim(camber_raster *raster);
/* Draws an area. The scene may be freed afterwards. */
camber_status camber_raster_draw(camber_raster *raster, const camber_raster_scene *scene,
                                 const camber_raster_area *area);
/* The same, into a buffer of the caller, which holds camber_raster_bytes and must live until pixels are unmapped or
 * something else is drawn. */
camber_status camber_raster_draw_into(camber_raster *raster, const camber_raster_scene *scene,
                                      const camber_raster_area *area, camber_buffer *pixels);
/* Maps the pixels of the last drawn area, until they are unmapped. */
camber_status camber_raster_map(camber_raster *raster, camber_raster_pixels *pixels);
void camber_raster_unmap(camber_raster *raster, camber_raster_pixels pixels);
camber_raster_times camber_raster_get_times(const camber_raster *raster);
/* Returns the widest area, in px, for which the memory limit leaves room for the spill of a row of tiles. */
uint32_t camber_raster_widest(const camber_raster *raster);
/* Returns how many slices the bands of the last drawn area took in total. */
uint32_t camber_raster_slice_count(const camber_raster *raster);

/* ---- Stages in host memory, for proofs. Free them with camber_raster_stages_free ---- */

typedef struct camber_raster_stages {
    /* segment_count times CAMBER_SEGMENT_WORDS. The edge of a ring has only its ends and its brush; its other words are
     * 0 */
    float *segments;
    float *edges;       /* segment_count / 16 times CAMBER_SIXTEEN_EDGES_WORDS. NULL: none, or shown as segments */
    uint32_t *boxes;    /* segment_count */
    float *arc_lengths; /* segment_count times CAMBER_SEGMENT_ARC_LENGTHS. NULL: a plain scene */
    float *planes;      /* segment_count times CAMBER_PLANE_WORDS. NULL: no pitch */
    size_t segment_count;
    uint32_t *starts; /* list_count + 1 */
    size_t tile_count;
    /* one list per tile; if there are polygons, then one per row of tiles, with the edges that cross its top */
    size_t list_count;
    uint32_t *lists; /* starts[list_count] */
    uint8_t *rgba;   /* pixels of the area */
} camber_raster_stages;

/* Reads the stages of the last drawn area: the last slice of its last band. */
camber_status camber_raster_read_stages(camber_raster *raster, camber_raster_stages *stages);
/* Runs the CPU twin on the meshes' points. */
camber_status camber_raster_on_host(camber_context *context, const camber_raster_scene *scene,
                                    const camber_raster_area *area, camber_raster_stages *stages);
void camber_raster_stages_free(camber_context *context, camber_raster_stages *stages);

/* ---- Shared by device and twin ---- */

/* Slots of one part that are drawn with one table of rows. */
typedef struct camber_slot_range {
    camber_mesh *mesh;
    size_t part;
    size_t first, end; /* the slots [first, end) of the part */
    size_t base;       /* where its segments begin, a multiple of 16 */
    size_t first_row;
    bool is_area, upright;
    bool among_edges;                  /* there are edges of rings before and after it: see segment.h */
    size_t first_change, change_count; /* the part's changes, in the list */
    size_t changes_before;             /* changes of the same input before this range */
} camber_slot_range;

/* The ranges of a scene, and how many segments they take. */
typedef struct camber_range_list {
    camber_context *context;
    camber_slot_range *ranges;
    uint32_t *changes; /* slots of a part at which the brush changes, ascending within a range */
    size_t count, capacity, segment_count, change_count, change_capacity;
    camber_slot_finder finder;   /* finder for the part of the last query */
    size_t first_edge, end_edge; /* all edges of rings are among these segments; 0 and 0: there are no polygons */
} camber_range_list;

/* Lists the ranges, sorted by part; the ranges of one part are in drawing order. */
camber_status camber_raster_list_ranges(camber_context *context, const camber_raster_scene *scene,
                                        camber_range_list *list);
void camber_raster_free_ranges(camber_range_list *list);
/* Copies the edges, which are among [first_edge, end_edge), into the segments, and frees the array of edges. */
void camber_raster_stages_show_edges(camber_context *context, camber_raster_stages *stages, size_t first_edge,
                                     size_t end_edge);
camber_setup_args camber_raster_setup_args(const camber_raster_scene *scene, const camber_slot_range *range,
                                           const camber_raster_area *area);
static inline uint32_t camber_raster_tiles(uint32_t side_px) {
    return (side_px + CAMBER_TILE_PX - 1) / CAMBER_TILE_PX;
}
/* These return the stride of an area's buffer, in px from one row to the next, and its bytes. The buffer holds whole
 * tiles. */
static inline size_t camber_raster_stride_px(const camber_raster_area *area) {
    return (size_t)camber_raster_tiles(area->width) * CAMBER_TILE_PX;
}
static inline size_t camber_raster_bytes(const camber_raster_area *area) {
    return 4 * camber_raster_stride_px(area) * camber_raster_tiles(area->height) * CAMBER_TILE_PX;
}

#endif
