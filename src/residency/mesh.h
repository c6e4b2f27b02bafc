/* Meshes: what one is made of, and of what parts.
 *
 *     polylines ---- camber_part_upload ---+
 *                                          +-> slots --[offset]--> classify -> points
 *     network ------ camber_part_project --+                                    |  if GL draws, or somebody reads
 *                                                                               +-> scan -> emit -> output
 *
 * A mesh is a list of parts, tessellated one after the other. A part has input buffers (points, which are slots with
 * their join words, and what stages find out about them) and output buffers (records, and indices unless it is strips).
 * If memory is bounded, a part may lose its buffers at any time (memory.h), and is made again when somebody needs it.
 * Here are its data; parts.h has what is done with parts, src/stroke/ makes them, src/vertices/ their output. */
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

/* Buffers of a part whose lines have an offset: the slots of the source lines beside which they lie, and what the
 * offset stages find out about each. The part's own buffers then hold the offset lines. */
typedef struct camber_source_line_buffers {
    camber_buffer *x, *y, *info, *clips, *counts, *places;
    camber_buffer *lengths, *arc_lengths; /* only with arc lengths */
    size_t slot_capacity;
} camber_source_line_buffers;

/* Consecutive polylines that are tessellated by themselves, with vertices numbered from 0. Most meshes have one part.
 * Where buffers would be too large for the device or for its bound on memory, there are several, in the order of their
 * polylines. */
typedef struct camber_mesh_part {
    camber_shared_buffer buffers[2]; /* output: records; indices, which strips do not have */
    size_t first_polyline, polyline_count;
    size_t first_slot, given_count; /* slots before the offset stages; given_count is padded to whole blocks */
    size_t slot_count;              /* slots that classify reads: those given, or those of the offset lines */
    size_t used_slots;              /* of those, without the padding; kept while the part has no buffers */
    /* For a network: the part's section, its points, and how many slots come before each chunk of these. */
    size_t section, first_point, end_point;
    uint32_t *chunk_bases; /* one for each chunk, and one behind the last */
    size_t chunk_capacity;
    bool uploaded;
    bool lent; /* x, y and info are arrays of the polylines, which kernels read in place */
    camber_buffer *x, *y, *info, *joins, *offsets, *sums, *bases;
    camber_buffer *lengths, *arc_lengths; /* only with arc lengths: sums of chunks; a camber_arc_length a slot */
    size_t slot_capacity;
    camber_source_line_buffers source_line;
    uint64_t *host_bases; /* first vertex and first index of each block, then the totals */
    size_t base_capacity;
    bool made; /* its buffers hold the points of the last tessellation, and the output if the mesh is drawn from it */
    /* Which method's join words joins has, whether they were scanned, and whether the output was emitted. */
    camber_method classified;
    bool scanned, emitted;
    uint64_t held_bytes;
    size_t record_count, vertex_count, index_count;
    /* How many the parts before have: where this one begins in the mesh. */
    size_t first_record, first_vertex, first_index;
} camber_mesh_part;

/* How a mesh gets its output: src/vertices/ has it. */
typedef struct camber_mesh_output {
    /* Counts a part's output while the mesh is tessellated, and numbers it after that of the parts before. *fits is
     * false if it is too large; then nothing is numbered, and the part is to be cut. */
    camber_status (*count)(camber_mesh *mesh, camber_mesh_part *part, bool *fits);
    /* Emits a part that has been counted. */
    camber_status (*emit)(camber_mesh *mesh, camber_mesh_part *part);
    /* Counts and emits a part whose points were made again. Fails if there is more or less than before. */
    camber_status (*remake)(camber_mesh *mesh, camber_mesh_part *part);
} camber_mesh_output;

/* A network that a mesh holds, its sections on the device, and how the camera last saw it. */
struct camber_held_network {
    camber_network *network;
    camber_projection projection; /* of the last tessellation */
    camber_program *program;
    camber_section *sections;
    size_t section_count, section_capacity;
    camber_buffer *counts, *bases; /* one a chunk of the part in work: slots, and slots before; all parts take turns */
    size_t chunk_capacity;
    camber_event *projected; /* the launch of cull_emit, until its time has been added */
};

struct camber_mesh {
    camber_device *device;
    const void *owner; /* the renderer that may draw it, compared and never read here; NULL: nobody */
    const camber_shared_buffer_ops *ops;
    void *ops_user;
    unsigned buffer_copies;                  /* how often each output buffer lies in memory: 2 where GL gets a copy */
    camber_mesh *next;                       /* in the device's list */
    uint64_t held_bytes;                     /* without its parts and sections */
    size_t remade_parts;                     /* since the last tessellation */
    const struct camber_mesh_output *output; /* NULL: its renderer draws points; output is made if somebody asks */
    bool is_full; /* since the last tessellation a part was evicted, or could not be made for lack of memory */

    /* The source of the parts; NULL for a network. The mesh holds it where parts may have to be made again, or
     * where kernels read its arrays. */
    const camber_polylines *polylines;
    bool holds_polylines;
    /* About the source that was last tessellated. first_slots has polyline_count + 1 entries, where each polyline
     * begins; polyline_rows has polyline_count. */
    uint64_t serial;                  /* of polylines or network; 0: none */
    struct camber_held_network *held; /* NULL unless the source is a network, which has no first_slots */
    uint32_t *first_slots, *polyline_rows;
    size_t polyline_count, polyline_capacity, row_list_capacity;
    size_t row_count;        /* all polylines' rows are below it */
    camber_mesh_part *parts; /* part_capacity, of which the first part_count are in use */
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
    bool empty; /* nothing to draw: not tessellated yet, failed, or no point or vertex came out */
};

enum { CAMBER_BUFFER_RECORDS, CAMBER_BUFFER_INDICES };

/* Makes an empty mesh. ops: how its output buffers are made; NULL: on the device alone. */
camber_status camber_mesh_create_on(camber_device *device, const camber_shared_buffer_ops *ops, void *ops_user,
                                    const camber_mesh_output *output, camber_mesh **mesh);

/* How many output buffers each part has. */
static inline size_t camber_buffer_count(const camber_mesh *mesh) {
    return mesh->mesh_info.strips ? 1 : 2;
}
/* The size of a record on the device. One with an arc length is twice as large: its words, its camber_arc_length, and
 * padding to a whole texel. */
static inline size_t camber_record_bytes(const camber_mesh_info *info) {
    return (info->has_arc_length ? 2 : 1) * sizeof(camber_record);
}
/* The size of a point on the device, and of its arc length. */
static inline size_t camber_slot_bytes(const camber_mesh_info *info) {
    return 4 * sizeof(uint32_t) + (info->has_arc_length ? sizeof(camber_arc_length) : 0);
}

/* Whether joins are counted while the mesh is tessellated: parts that are evicted afterwards would be made for it. */
static inline bool camber_mesh_counts_early(const camber_mesh *mesh) {
    return mesh->output && mesh->part_count > 1 && mesh->device->memory_bytes;
}
/* Adds the time that a command took to the stage's time in the mesh's info, and releases its event. */
void camber_mesh_add_time(camber_mesh *mesh, camber_stage_id stage, camber_event *event);

#endif
