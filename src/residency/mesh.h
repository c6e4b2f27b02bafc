/* Meshes and their parts: the data structures.
 *
 *     polylines ---- camber_part_upload ---+
 *                                          +-> slots --[offset]--> classify -> points
 *     network ------ camber_part_project --+                                    |  if GL draws, or somebody reads
 *                                                                               +-> scan -> emit -> output
 *
 * A mesh is a list of parts, tessellated one after another. A part has input buffers (points, which are slots with
 * their join words, and the results of stages for them) and output buffers (records, and indices unless it is strips).
 * If memory is limited, a part may lose its buffers at any time (memory.h), and is made again when it is needed. This
 * header declares the data; parts.h declares the operations on parts, src/stroke/ makes parts, and src/vertices/ makes
 * their output. */
#ifndef CAMBER_RESIDENCY_MESH_H
#define CAMBER_RESIDENCY_MESH_H

#include "base/stages.h"
#include "gpu/launch.h"
#include "gpu/memory.h"
#include "gpu/program.h"
#include "gpu/shared_buffer.h"
#include "lines/lines.h"
#include "points/section.h"

#include "camber_proof.h"

/* Buffers of a part whose lines have an offset: the slots of the source lines, and the results of the offset stages for
 * each of them. The part's own buffers then hold the offset lines. */
typedef struct camber_source_line_buffers {
    camber_buffer *x, *y, *info, *clips, *counts, *places;
    camber_buffer *lengths, *arc_lengths; /* only with arc lengths */
    size_t slot_capacity;
} camber_source_line_buffers;

/* Consecutive polylines that are tessellated separately, with vertices numbered from 0. Most meshes have one part. If
 * buffers would be too large for the device or for its memory limit, there are several, in the order of their
 * polylines. */
typedef struct camber_mesh_part {
    camber_shared_buffer buffers[2]; /* output: records; indices, which strips do not have */
    size_t first_polyline, polyline_count;
    size_t first_slot, given_count; /* slots before the offset stages; given_count is padded to whole blocks */
    size_t slot_count;              /* slots that classify reads: the given ones, or those of the offset lines */
    size_t used_slots;              /* slot_count without the padding; kept while the part has no buffers */
    /* For a network: the part's section, its points, and how many slots are before each chunk of the points. */
    size_t section, first_point, end_point;
    uint32_t *chunk_bases; /* one for each chunk, and one after the last */
    size_t chunk_capacity;
    bool uploaded;
    bool borrowed; /* x, y and info are borrowed (zero copy): kernels read the polylines' arrays in place */
    camber_buffer *x, *y, *info, *joins, *offsets, *sums, *bases;
    /* only with arc lengths: sums of chunks, and one camber_arc_length per slot */
    camber_buffer *lengths, *arc_lengths;
    size_t slot_capacity;
    camber_source_line_buffers source_line;
    uint64_t *host_bases; /* first vertex and first index of each block, then the totals */
    size_t base_capacity;
    bool made; /* its buffers hold the points of the last tessellation, and the output if the mesh is drawn from it */
    /* Whether there are join words, the method that they are for, whether they were scanned, and whether the output was
     * emitted. */
    bool has_joins;
    camber_method classified;
    bool scanned, emitted;
    uint64_t held_bytes;
    size_t record_count, vertex_count, index_count;
    /* The counts of all previous parts, which say where this part begins in the mesh. */
    size_t first_record, first_vertex, first_index;
} camber_mesh_part;

/* The functions that make a mesh's output. src/vertices/ implements them. */
typedef struct camber_mesh_output {
    /* Counts a part's output while the mesh is tessellated, and numbers it after the output of the previous parts.
     * *fits is false if the output is too large; then nothing is numbered, and the caller cuts the part. */
    camber_status (*count)(camber_mesh *mesh, camber_mesh_part *part, bool *fits);
    /* Emits a part that has been counted. */
    camber_status (*emit)(camber_mesh *mesh, camber_mesh_part *part);
    /* Counts and emits a part whose points were made again. Fails if the counts differ from before. */
    camber_status (*remake)(camber_mesh *mesh, camber_mesh_part *part);
} camber_mesh_output;

/* A network that a mesh holds, its sections on the device, and its last projection. */
struct camber_held_network {
    camber_network *network;
    camber_projection projection; /* projection of the last tessellation */
    camber_program *program;
    camber_section *sections;
    size_t section_count, section_capacity;
    /* one per chunk of the current part: its slots, and the slots before it; all parts use these in turn */
    camber_buffer *counts, *bases;
    size_t chunk_capacity;
    camber_event *projected; /* the event of cull_emit, until its time has been added */
};

struct camber_mesh {
    camber_device *device;
    camber_mesh *companion; /* camber_mesh_get_companion. NULL: none yet */
    const void *owner;      /* the renderer that may draw it; the pointer is only compared. NULL: none */
    const camber_shared_buffer_ops *ops;
    void *ops_user;
    unsigned buffer_copies;                  /* copies of each output buffer in memory: 2 if GL gets a copy */
    camber_mesh *next;                       /* next mesh in the device's list */
    uint64_t held_bytes;                     /* without the bytes of its parts and sections */
    size_t remade_parts;                     /* since the last tessellation */
    const struct camber_mesh_output *output; /* NULL: its renderer draws points; output is made only on request */
    bool is_full; /* since the last tessellation a part was evicted, or could not be made for lack of memory */

    /* The source of the parts; NULL for a network. The mesh holds it if parts may have to be made again, or while
     * kernels borrow its arrays. */
    const camber_polylines *polylines;
    bool holds_polylines;
    /* Data about the source that was last tessellated. first_slots has polyline_count + 1 entries, which say where each
     * polyline begins; polyline_rows has polyline_count entries. */
    uint64_t serial;                  /* serial of the polylines or the network; 0: none */
    struct camber_held_network *held; /* NULL unless the source is a network, which has no first_slots */
    uint32_t *first_slots, *polyline_rows;
    size_t polyline_count, polyline_capacity, row_list_capacity;
    size_t row_count;        /* the highest row of the polylines + 1 */
    camber_mesh_part *parts; /* part_capacity of them, of which the first part_count are in use */
    size_t part_count, part_capacity;

    camber_buffer *rows;
    camber_row *host_rows; /* the host's copy of rows */
    size_t row_capacity, host_row_capacity;
    bool has_offsets;           /* a row has an offset: parts have buffers for source lines */
    camber_buffer *offset_rows; /* each row's values for the offset stages */
    size_t offset_row_capacity;
    camber_mesh_info mesh_info;
    bool joins_counted; /* mesh_info's counts of joins and triangles are valid */
    bool round_limits;  /* a row has round joins with a limit */
    bool sharp_joins;   /* a row has miter or bevel joins, or round ones with a limit */
    bool flat_caps;     /* a row has butt or square caps */
    bool wide;          /* a row is so wide that joins may be flat */
    bool round_caps;    /* a row has round caps */
    bool done;          /* the last tessellation succeeded */
    bool has_camera;    /* the last tessellation was of a network; pitch_deg is its camera's */
    double pitch_deg;
    bool empty; /* nothing to draw: not tessellated yet, failed, or without any point or vertex */
};

enum { CAMBER_BUFFER_RECORDS, CAMBER_BUFFER_INDICES };

/* Makes an empty mesh. ops says how its output buffers are made; NULL: only on the device. */
camber_status camber_mesh_create_on(camber_device *device, const camber_shared_buffer_ops *ops, void *ops_user,
                                    const camber_mesh_output *output, camber_mesh **mesh);

/* Returns how many output buffers each part has. */
static inline size_t camber_buffer_count(const camber_mesh *mesh) {
    return mesh->mesh_info.strips ? 1 : 2;
}
/* Returns the size of a record on the device. With an arc length it is twice as large: its words, its
 * camber_arc_length, and padding to a whole texel. */
static inline size_t camber_record_bytes(const camber_mesh_info *info) {
    return (info->has_arc_length ? 2 : 1) * sizeof(camber_record);
}
/* Returns the size of a point on the device, including its arc length. */
static inline size_t camber_slot_bytes(const camber_mesh_info *info) {
    return 4 * sizeof(uint32_t) + (info->has_arc_length ? sizeof(camber_arc_length) : 0);
}

/* Whether joins are counted while the mesh is tessellated, because parts that are evicted later would have to be made
 * again for counting. */
static inline bool camber_mesh_counts_early(const camber_mesh *mesh) {
    return mesh->output && mesh->part_count > 1 && mesh->device->memory_bytes;
}
/* Adds the time that a command took to the stage's time in the mesh's info, and releases its event. */
void camber_mesh_add_time(camber_mesh *mesh, camber_stage_id stage, camber_event *event);

#endif
