/* Meshes, and what the files of tessellation share. camber_mesh and its parts come first, then the functions of each
 * file.
 *
 *     polylines ------------- camber_part_upload ---+
 *                                                   +-> slots --[offset]--> classify -> points
 *     network -- sections -- camber_part_project ---+                                    |  for GL, and for readers
 *                                                                                        +-> scan -> emit -> output
 *
 * A mesh is a list of parts, tessellated one after the other (tessellate.c). A part has input buffers (points, which
 * are slots with their join words, and what stages find out about them) and output buffers (records, and indices unless
 * it is strips). If memory is bounded, a part may lose its buffers at any time (memory.c), and is made again when
 * somebody needs it. */
#ifndef CAMBER_TESS_MESH_H
#define CAMBER_TESS_MESH_H

#include "base/stages.h"
#include "gpu/memory.h"
#include "gpu/program.h"
#include "gpu/shared_buffer.h"
#include "lines/lines.h"

#include "camber_proof.h"

/* ---- Meshes ---- */

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
    camber_shared_buffer buffers[2]; /* records; indices, which strips do not have */
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

struct camber_mesh {
    camber_device *device;
    const void *owner; /* the renderer that may draw it, compared and never read here; NULL: nobody */
    const camber_shared_buffer_ops *ops;
    void *ops_user;
    unsigned buffer_copies; /* how often each output buffer lies in memory: 2 where GL gets a copy */
    camber_mesh *next;      /* in the device's list */
    uint64_t held_bytes;    /* without its parts and sections */
    size_t remade_parts;    /* since the last tessellation */
    bool draws_points;      /* its renderer reads points: output is made only if somebody asks for it */
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

camber_status camber_mesh_create_on(camber_device *device, const camber_shared_buffer_ops *ops, void *ops_user,
                                    camber_mesh **mesh);
/* Makes a part again unless its buffers hold what the mesh is drawn from. part points into mesh->parts. Other parts may
 * be evicted. */
camber_status camber_part_ensure_made(camber_mesh *mesh, camber_mesh_part *part);
/* Makes sure, too, that its join words are those of strips, which the rasterizer reads whatever the method. */
camber_status camber_part_ensure_points(camber_mesh *mesh, camber_mesh_part *part);
/* Makes sure, too, that they are those of the method, and that they are scanned: the part's counts are known. */
camber_status camber_part_ensure_counted(camber_mesh *mesh, camber_mesh_part *part);
/* Makes sure, too, that its output is in its buffers. */
camber_status camber_part_ensure_output(camber_mesh *mesh, camber_mesh_part *part);
/* Numbers the output of a part that was counted after that of the parts before it, which counts has, and adds it. */
camber_status camber_part_number(const camber_mesh *mesh, camber_mesh_part *part, camber_mesh_info *counts);
/* The first slot of a polyline in its part. One just behind the part's last gives the end of its slots. places: those
 * of the slots of offset lines, mapped; not read where the mesh has no offsets, nor for an end. */
size_t camber_part_slot(const camber_mesh *mesh, const camber_mesh_part *part, const uint32_t *places, size_t polyline);
/* The same among the given slots, before the offset stages. */
size_t camber_part_given_slot(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline);
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
/* Finds the first index of a polyline among those of the whole mesh, as camber_mesh_read gives them. Makes the
 * polyline's part if it is gone. */
camber_status camber_mesh_first_index(camber_mesh *mesh, size_t polyline, uint64_t *first_index);

/* slot_starts.c: where the slots of a part's polylines begin. Opened by naming mesh and part. */
typedef struct camber_slot_finder {
    const camber_mesh *mesh;
    const camber_mesh_part *part; /* which is made */
    const uint32_t *places;       /* mapped; NULL: nobody asked yet, or the mesh has no offsets */
} camber_slot_finder;

/* The first slot of a polyline. One just after the part's last gives the end. Offset lines make it wait for the device,
 * but for the part's first polyline and its end; then the part must not lose its buffers until the finder is closed. */
camber_status camber_slot_finder_find(camber_slot_finder *finder, size_t polyline, size_t *slot);
/* Forgets the part. May be called of none. */
void camber_slot_finder_close(camber_slot_finder *finder);

/* Where the output of a part's polylines begins, too, from what classify and scan left. */
typedef struct camber_slot_starts {
    camber_slot_finder finder;              /* its part has been scanned */
    const uint32_t *joins, *info, *offsets; /* mapped; NULL: nobody asked yet */
    size_t at;                              /* the slot that was asked for last, and sum for it */
    uint32_t sum;
} camber_slot_starts;

static inline camber_slot_starts camber_slot_starts_of(const camber_mesh *mesh, const camber_mesh_part *part) {
    return (camber_slot_starts){.finder = {.mesh = mesh, .part = part}};
}
/* Maps the whole part, unless it is mapped: that waits for the device, and is for many questions. Until it is unmapped
 * the part must not lose its buffers. */
camber_status camber_slot_starts_map(camber_slot_starts *starts);
/* Forgets the part. May be called of none. */
void camber_slot_starts_unmap(camber_slot_starts *starts);
/* Returns vertices | indices << 16: how many the slot's block has before it. Asking in ascending order is cheap. This
 * and the first slot of a polyline are for parts that are mapped. */
uint32_t camber_slot_starts_before(camber_slot_starts *starts, size_t slot);
size_t camber_slot_starts_slot(const camber_slot_starts *starts, size_t polyline);
/* The first index of a polyline, and its first record. A strip has two indices for each record; kite and fan have a
 * record for each slot. A polyline just behind the part's last gives the end. The part is mapped where it must be: not
 * for its first polyline, nor for its end. */
camber_status camber_slot_starts_index(camber_slot_starts *starts, size_t polyline, uint64_t *index);
camber_status camber_slot_starts_record(camber_slot_starts *starts, size_t polyline, size_t *record);

/* stages.c: a part's points in host memory: words of its slots, and of a sentinel before and after them. */
typedef struct camber_part_points {
    float *x, *y;
    uint32_t *info, *joins;
    camber_arc_length *arc_lengths; /* a slot. NULL: the mesh has none */
} camber_part_points;

/* Makes the part, and reads its points. camber_part_points_free frees them. */
camber_status camber_part_read_points(camber_mesh *mesh, camber_mesh_part *part, camber_part_points *points);
void camber_part_points_free(camber_context *context, camber_part_points *points);

/* Adds the time that a command took to the stage's time in the mesh's info, and releases its event. */
void camber_mesh_add_time(camber_mesh *mesh, camber_stage_id stage, camber_event *event);

/* parts.c: divides polylines into parts whose input the device can hold. Parts, and what is uploaded to them, stay
 * where the polylines are those of last time. CAMBER_ERROR_LIMIT names a polyline that fits into no part. */
camber_status camber_mesh_plan(camber_mesh *mesh, const camber_polylines *polylines);
/* Cuts a part, which has been scanned and whose output is too large, into parts whose output fits. The first of them
 * takes the part's index, the others follow. */
camber_status camber_mesh_split(camber_mesh *mesh, size_t which);
/* How many records a scanned part will have. */
size_t camber_part_count_records(const camber_mesh *mesh, const camber_mesh_part *part);
/* Whether a scanned part's output fits the device and the part's share of memory. */
bool camber_part_fits(const camber_mesh *mesh, const camber_mesh_part *part);
/* Uploads the part's slots, unless they have been; or lets kernels read the polylines' arrays. */
camber_status camber_part_upload(camber_mesh *mesh, camber_mesh_part *part);
/* No kernel reads arrays of the polylines any more. */
void camber_mesh_return_points(camber_mesh *mesh);
/* Forgets the polylines, and holds them no more. */
void camber_mesh_release_polylines(camber_mesh *mesh);
/* The mesh has been tessellated: it holds the polylines no longer than it needs them. */
void camber_mesh_let_go(camber_mesh *mesh);
void camber_mesh_release_parts(camber_mesh *mesh);
/* Releases all buffers of a part, on device and host. It keeps its polylines. */
void camber_part_release_buffers(camber_mesh *mesh, camber_mesh_part *part);
/* Moves the buffers of one part to another that has none. */
void camber_part_move_buffers(camber_mesh_part *part, camber_mesh_part *from);
/* Makes a part's input buffers and its host_bases large enough for so many slots. */
camber_status camber_part_reserve(camber_mesh *mesh, camber_mesh_part *part, size_t slots);
/* The same for a part whose slots a kernel makes, and sets its slot_count. Of a network it reserves a quarter more
 * where the device has plenty: the next frame may need it. */
camber_status camber_part_reserve_with_spare(camber_mesh *mesh, camber_mesh_part *part, size_t slots);
/* How many bytes a scanned part needs, input and output. */
uint64_t camber_part_needed_bytes(const camber_mesh *mesh, const camber_mesh_part *part);
/* How many bytes its output buffers are too small for its output. */
uint64_t camber_part_missing_output_bytes(const camber_mesh *mesh, const camber_mesh_part *part);
/* Whether so many slots are in the part's share of memory; always true for a single polyline, as it cannot be cut. */
bool camber_part_may_hold(const camber_mesh *mesh, const camber_mesh_part *part, uint64_t slots);
/* Sets *fits: whether the device makes a part's buffers for so many slots, and its share of memory takes them. A part
 * of a single polyline, which cannot be cut, fails with CAMBER_ERROR_LIMIT instead. */
camber_status camber_part_check_slots(const camber_mesh *mesh, const camber_mesh_part *part, uint64_t slots,
                                      bool *fits);
/* Makes one of the output buffers large enough, evicting others if need be, and counts it. */
camber_status camber_part_reserve_output(camber_mesh *mesh, camber_mesh_part *part, size_t which, size_t size_bytes);
/* Releases the buffers of parts past part_count, but keeps those of the very first part for the next polylines. */
void camber_mesh_trim_parts(camber_mesh *mesh);
/* Adds a part without buffers at the end of the list. */
camber_status camber_mesh_add_part(camber_mesh *mesh, size_t first_polyline, size_t end_polyline);
/* Called before another frame of the same network. Where memory was full, releases buffers that were far too large for
 * the last frame. Merges pairs of parts that needed little of their share. */
void camber_mesh_compact_parts(camber_mesh *mesh);
/* Cuts a part in two at the middle of its polylines. */
camber_status camber_mesh_halve(camber_mesh *mesh, size_t which);
/* Fail with CAMBER_ERROR_LIMIT: a polyline alone is too large for its share of memory, or for the device's buffers. */
camber_status camber_fail_memory(const camber_mesh *mesh, size_t polyline, uint64_t size_bytes);
camber_status camber_fail_polyline(const camber_mesh *mesh, size_t polyline, uint64_t size_bytes);

/* sections.c: plans the parts of a network, which the mesh holds from then on. */
camber_status camber_mesh_plan_network(camber_mesh *mesh, camber_network *network);
/* Aims a camera at the network that the mesh holds, and gets the kernels for that. */
camber_status camber_mesh_aim(camber_mesh *mesh, const camber_camera *camera, const camber_tessellation_desc *desc);
/* Releases the polylines or the network that the mesh holds, and the network's sections. */
void camber_mesh_release_source(camber_mesh *mesh);
/* Sets which section and which points of a network a part has, from its polylines. */
void camber_part_set_points(const camber_mesh *mesh, camber_mesh_part *part);
/* cull.c: makes a part's slots of a network (stages cull_count and cull_emit). Sets *fits to false, and makes
 * none, where they are too many for the device's buffers or the part's share of memory. */
camber_status camber_part_project(camber_mesh *mesh, camber_mesh_part *part, bool *fits);
/* camber_part_given_slot for a network. The host walks the polyline's chunk to count the slots before it. */
size_t camber_part_network_slot(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline);
/* memory.c: count anew what a part or a mesh holds, after buffers have been made or released. */
void camber_part_count_bytes(const camber_mesh *mesh, camber_mesh_part *part);
void camber_mesh_count_bytes(camber_mesh *mesh);
/* How many bytes a part's input takes for so many slots. */
uint64_t camber_input_bytes(const camber_device *device, bool has_arc_length, size_t slots);
/* The bytes of x, y and info alone. */
uint64_t camber_point_bytes(size_t slots);
/* The bytes of the input buffers that a part has: points that polylines lend it are none of its own. */
uint64_t camber_part_input_bytes(const camber_mesh *mesh, const camber_mesh_part *part);
/* How many bytes the source lines of a part take for so many slots. */
uint64_t camber_source_line_bytes(bool has_arc_length, size_t slots);
/* Evicts parts and sections until more_bytes can be held in addition, and returns whether they now can. Never evicts
 * keep (NULL: none) and its section, and with spare_made no part of this mesh that is made. memory.c has the order. */
bool camber_mesh_evict_for(camber_mesh *mesh, const camber_mesh_part *keep, uint64_t more_bytes, bool spare_made);
/* Evicts, made parts of this mesh too. Fails with CAMBER_ERROR_LIMIT where that is not enough. */
camber_status camber_mesh_make_room(camber_mesh *mesh, const camber_mesh_part *keep, uint64_t more_bytes);
/* Gives a part without buffers those of the part that would be evicted for it, where so many bytes are not free.
 * Cheaper than to release them and make new ones. */
void camber_part_recycle_buffers(camber_mesh *mesh, camber_mesh_part *part, uint64_t wanted_bytes);

/* Calls ops->finish after ops->begin on a part's output. Returns status where that is a failure, which has been logged;
 * then a failure of finish is not. */
camber_status camber_part_finish(const camber_mesh *mesh, camber_mesh_part *part, bool written, camber_status status);

/* ---- Rows ---- */

/* rows.c: checks a desc for polylines whose rows are below row_count, and makes the kernels' style table, which is
 * freed with camber_free. */
camber_status camber_rows_create(camber_context *context, uint32_t row_count, const camber_tessellation_desc *desc,
                                 camber_row **rows);

/* The host's part of the scan: adds up the blocks' sums (vertices | indices << 16) in 64 bits. bases has room for
 * 2 * (block_count + 1) numbers: each block's first vertex and first index, then the totals. */
void camber_scan_blocks(const uint32_t *sums, size_t block_count, uint64_t *bases);
/* The most records that a mesh may have. Strips number two vertices a record with 32 bits; the other methods number a
 * record with the bits that CAMBER_CORNER_BITS leave. */
size_t camber_records_max(camber_method method);
camber_status camber_fail_records(camber_context *context, camber_method method);

/* expand.c: makes the vertices and indices of a mesh from its records and corners. */
camber_status camber_mesh_expand(camber_context *context, const camber_row *rows, camber_mesh_data *data);
/* For kite and fan: gives each record's first vertex by number, record_count + 1 of them, freed with camber_free. */
camber_status camber_mesh_data_find_first_vertices(camber_context *context, camber_mesh_data *data,
                                                   uint32_t **first_vertices);

/* Adds the joins of a part, whose join words must be in its buffers, to counts, and its segments to *segments.
 * camber_mesh_set_counts stores the sums over all parts. */
camber_status camber_part_count_joins(const camber_mesh *mesh, const camber_mesh_part *part, camber_mesh_info *counts,
                                      size_t *segments);
void camber_mesh_set_counts(camber_mesh *mesh, camber_mesh_info counts, size_t segments);

/* Counts the join of a point, given its join word and its info word. */
void camber_mesh_info_add_join(camber_mesh_info *info, uint32_t join, uint32_t point);

#endif
