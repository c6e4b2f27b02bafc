/* Meshes: their parts, how these are made, and what tessellation's files share. */
#ifndef CAMBER_TESS_MESH_H
#define CAMBER_TESS_MESH_H

#include "cl/buffer.h"
#include "cl/memory.h"
#include "cl/program.h"
#include "lines/lines.h"

#include "camber_proof.h"

/* ---- Meshes ---- */

/* Of lines with an offset: the slots of the lines that they lie beside, and what becomes of each. */
typedef struct camber_part_course {
    cl_mem x, y, info, spans, counts, places;
    cl_mem lengths, measures; /* of what is measured */
    size_t slot_capacity;
    size_t made_count; /* slots beside, without padding */
} camber_part_course;

/* A run of polylines that is tessellated by itself, its vertices numbered from 0. Most meshes are one part; where
 * the device makes no buffer that is large enough, several in the order of their polylines. */
typedef struct camber_mesh_part {
    camber_buffer buffers[2]; /* records, indices: of strips none */
    size_t first_polyline, polyline_count;
    size_t first_slot, given_count; /* slots of the polylines; given_count is padded to whole blocks */
    size_t slot_count;              /* that are classified: those given, or of lines beside them */
    /* Of a network: which of its sections, the points of it, and the slots before each of their chunks. */
    size_t section, first_point, end_point;
    uint32_t *chunk_bases; /* the chunks and one behind them */
    size_t chunk_capacity;
    bool uploaded;
    cl_mem x, y, info, joins, offsets, sums, bases;
    cl_mem lengths, measures; /* of what is measured: sums of chunks, and a camber_measure a slot */
    size_t slot_capacity;
    camber_part_course course;
    uint64_t *host_bases; /* first vertex and first index of each block, and the totals behind the last */
    size_t base_capacity;
    bool made; /* its buffers hold what the last tessellation made of it */
    uint64_t held_bytes;
    size_t record_count, vertex_count, index_count;
    size_t first_record, first_vertex, first_index; /* of the mesh: what the parts before have */
} camber_mesh_part;

struct camber_mesh {
    camber_device *device;
    camber_renderer *renderer; /* NULL: cannot be drawn */
    const camber_buffer_ops *ops;
    void *ops_user;
    unsigned buffer_copies; /* of each output buffer in memory */
    camber_mesh *next;      /* of the device */
    uint64_t held_bytes;    /* beside its parts and sections */
    size_t remade_parts;
    bool is_full; /* a part had to go since the last tessellation, or was never made */

    /* What parts are made of; NULL: of a network. Held where parts may have to be made again. */
    const camber_polylines *polylines;
    bool holds_polylines;
    /* Of the polylines last tessellated: polyline_count + 1 slots, where a polyline begins; polyline_count rows. */
    uint64_t serial;                  /* 0: of none */
    struct camber_held_network *held; /* NULL: not of a network, whose polylines have no first_slots */
    uint32_t *first_slots, *polyline_rows;
    size_t polyline_count, polyline_capacity, row_list_capacity;
    size_t row_count;        /* every polyline's row is below it */
    camber_mesh_part *parts; /* part_capacity, of which part_count are the mesh */
    size_t part_count, part_capacity;

    cl_mem rows;
    camber_row *host_rows; /* the same */
    size_t row_capacity, host_row_capacity;
    bool offsets;  /* a row has an offset: parts have a course */
    cl_mem shifts; /* what of each row offsets need */
    size_t shift_capacity;
    camber_mesh_info mesh_info;
    bool joins_counted; /* mesh_info's counts of joins and triangles are there */
    bool round_limits;  /* a row has round joins with a limit */
    bool sharp_joins;   /* a row has miter or bevel joins, or round ones with a limit */
    bool flat_caps;     /* a row has butt or square caps */
    bool round_caps;    /* a row has round caps */
    bool done;          /* the last tessellation succeeded */
    bool empty;         /* nothing to draw: nothing tessellated yet, it failed, or nothing came of it */
};

enum { CAMBER_BUFFER_RECORDS, CAMBER_BUFFER_INDICES };

camber_status camber_mesh_create_on(camber_device *device, const camber_buffer_ops *ops, void *ops_user,
                                    camber_mesh **mesh);
/* Makes a part, a pointer into mesh->parts, again unless its buffers hold it. Others may go. */
camber_status camber_part_use(camber_mesh *mesh, camber_mesh_part *part);
/* First slot of a polyline in its part, which lies in its buffers; the part's first polyline + polyline_count gives the
 * end. */
camber_status camber_part_slot(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline, size_t *slot);
/* The same of the slots that are given. */
size_t camber_part_given_slot(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline);
/* How many of a part's output buffers there are. */
static inline size_t camber_buffer_count(const camber_mesh *mesh) {
    return mesh->mesh_info.strips ? 1 : 2;
}
/* Of a record as the device has it: a measured one's words and its measure, rounded up to what a texel is. */
static inline size_t camber_record_bytes(const camber_mesh_info *info) {
    return (info->measured ? 2 : 1) * sizeof(camber_record);
}
/* First index of a polyline in its part, of strips its first vertex; the part's first polyline + polyline_count gives
 * the end. */
camber_status camber_part_first_index(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline,
                                      uint64_t *first_index);
/* The same in the indices of the mesh, as camber_mesh_read gives them. */
camber_status camber_mesh_first_index(camber_mesh *mesh, size_t polyline, uint64_t *first_index);

/* offsets.c: where slots begin within their blocks, as classify and scan left it. */
typedef struct camber_offsets {
    const camber_mesh *mesh;
    const camber_mesh_part *part;
    cl_uint *joins, *info, *offsets; /* mapped, from a run's first slot on */
    size_t first, first_run;
    size_t at; /* the slot that was asked for last, and what it has before it */
    uint32_t sum;
} camber_offsets;

/* Of the slots [first, end) of a part; end is above first. */
camber_status camber_offsets_map(const camber_mesh *mesh, const camber_mesh_part *part, size_t first, size_t end,
                                 camber_offsets *offsets);
void camber_offsets_unmap(camber_offsets *offsets);
/* Vertices | indices << 16 that the slot's block has before it. */
uint32_t camber_offset_before(camber_offsets *offsets, size_t slot);

/* parts.c: lays out the parts of a mesh, each small enough for the device to upload; keeps them, and what is uploaded,
 * where the polylines are those of last time. CAMBER_ERROR_LIMIT names a polyline that fits no part. */
camber_status camber_mesh_plan(camber_mesh *mesh, const camber_polylines *polylines);
/* Cuts a part that has been scanned, and whose output is too large, into parts whose output fits. The part's place is
 * taken by the first of them. */
camber_status camber_mesh_split(camber_mesh *mesh, size_t which);
camber_status camber_part_records(const camber_mesh *mesh, const camber_mesh_part *part, size_t *count);
bool camber_part_fits(const camber_mesh *mesh, const camber_mesh_part *part);
camber_status camber_part_upload(camber_mesh *mesh, camber_mesh_part *part);
void camber_mesh_release_parts(camber_mesh *mesh);
/* Lets go of a part's buffers. */
void camber_part_empty(camber_mesh *mesh, camber_mesh_part *part);
/* Gives an empty part the buffers of another. */
void camber_part_take(camber_mesh_part *part, camber_mesh_part *from);
/* Room for slots in the buffers of a part's input and its host_bases. */
camber_status camber_part_reserve(camber_mesh *mesh, camber_mesh_part *part, size_t slots);
/* The bytes that a part takes: input and output. */
uint64_t camber_part_need(const camber_mesh *mesh, const camber_mesh_part *part);
/* What its output buffers lack for its output. */
uint64_t camber_part_output_lacks(const camber_mesh *mesh, const camber_mesh_part *part);
/* Whether a part of several polylines may have so many slots in its share of memory. */
bool camber_part_may_hold(const camber_mesh *mesh, const camber_mesh_part *part, uint64_t slots);
/* Makes room in an output buffer and counts it. */
camber_status camber_part_reserve_output(camber_mesh *mesh, camber_mesh_part *part, size_t which, size_t size_bytes);
/* Frees what parts past the mesh's hold, but for the first. */
void camber_mesh_trim_parts(camber_mesh *mesh);
/* Adds an empty part, or cuts one in two at the middle of its polylines. */
camber_status camber_mesh_add_part(camber_mesh *mesh, size_t first_polyline, size_t end_polyline);
/* After another frame of the same network: where memory was full, lets go of buffers that were far too large for it,
 * and joins parts by twos that took little of their share. */
void camber_mesh_tidy(camber_mesh *mesh);
camber_status camber_mesh_halve(camber_mesh *mesh, size_t which);
camber_status camber_fail_memory(const camber_mesh *mesh, size_t polyline, uint64_t size_bytes);
camber_status camber_fail_polyline(const camber_mesh *mesh, size_t polyline, uint64_t size_bytes);

/* network_parts.c: the same for a network, which is uploaded here. */
camber_status camber_mesh_plan_network(camber_mesh *mesh, camber_network *network);
/* Aims the network that a mesh holds. */
camber_status camber_mesh_aim(camber_mesh *mesh, const camber_camera *camera, const camber_tessellation_desc *desc);
void camber_mesh_let_go(camber_mesh *mesh);
/* Which of a network's points a part has. */
void camber_part_set_points(const camber_mesh *mesh, camber_mesh_part *part);
/* survey and project: makes the part's slots. *fits is false, and there are none, where the device makes no buffer that
 * is large enough. */
camber_status camber_part_project(camber_mesh *mesh, camber_mesh_part *part, bool *fits);
size_t camber_part_network_slot(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline);
/* A stage: a kernel, its arguments, how many points a work-item takes, and of how many. */
typedef struct camber_stage {
    const char *name;
    cl_kernel kernel;
    const cl_mem *mems;
    cl_uint mem_count;
    size_t points;
    size_t slots;
} camber_stage;

/* Runs a stage over slots, a work-group a block. */
camber_status camber_stage_run(const camber_device *device, camber_stage stage, cl_event *event);
/* Adds the time of a command to ms and releases the event, which may be NULL. */
void camber_add_ms(cl_event event, double *ms);
camber_status camber_fail_stage(const camber_device *device, const char *call, const char *name, cl_int code);

/* Counts what is held anew, after buffers have been made or let go. */
void camber_part_count(const camber_mesh *mesh, camber_mesh_part *part);
void camber_mesh_count(camber_mesh *mesh);
/* Of a part's input for so many slots. */
uint64_t camber_input_bytes(const camber_device *device, bool measured, size_t slots);
/* Of the course of a part for so many slots. */
uint64_t camber_course_bytes(bool measured, size_t slots);
/* Lets parts and sections go, those of other meshes before the mesh's own, until so many more bytes can be held. keep
 * and its section stay, and with spare_made all parts of the mesh that are made. */
bool camber_mesh_has_room(camber_mesh *mesh, const camber_mesh_part *keep, uint64_t more_bytes, bool spare_made);
/* The same, sparing none; CAMBER_ERROR_LIMIT where it does not help. */
camber_status camber_mesh_make_room(camber_mesh *mesh, const camber_mesh_part *keep, uint64_t more_bytes);
/* Where no room is left for so many bytes, gives a part without buffers those of the part that would have to go. */
void camber_part_adopt(camber_mesh *mesh, camber_mesh_part *part, uint64_t wanted_bytes);

/* Ends what ops->begin began on a part's output. Gives status where that is a failure, whose story is told. */
camber_status camber_part_finish(const camber_mesh *mesh, camber_mesh_part *part, bool written, camber_status status);

/* ---- Rows ---- */

/* Checks a desc against the polylines, whose rows are below row_count, and makes the kernels' style table; freed with
 * camber_free. */
camber_status camber_rows_create(camber_context *context, uint32_t row_count, const camber_tessellation_desc *desc,
                                 camber_row **rows);

/* The host's part of the scan: adds up the blocks' sums, vertices | indices << 16, in 64 bits. bases takes
 * 2 * (block_count + 1): each block's first vertex and first index, and the totals behind the last. */
void camber_scan_blocks(const uint32_t *sums, size_t block_count, uint64_t *bases);
/* Vertices of a strip are numbered by 32 bits; a corner's record by what its index leaves. */
size_t camber_records_max(camber_method method);
camber_status camber_fail_records(camber_context *context, camber_method method);

/* expand.c: makes vertices and indices of a mesh's records and corners. */
camber_status camber_mesh_expand(camber_context *context, const camber_row *rows, camber_mesh_data *data);
/* How many vertices the records before each have, of kite and fan: record_count + 1, freed with camber_free. */
camber_status camber_corners_count(camber_context *context, camber_mesh_data *data, uint32_t **first_vertices);

/* Adds the kinds of joins that a part has, which lies in its buffers, and its segments; then takes the sums over all
 * parts. */
camber_status camber_part_count_joins(const camber_mesh *mesh, const camber_mesh_part *part, camber_mesh_info *counts,
                                      size_t *segments);
void camber_mesh_set_counts(camber_mesh *mesh, camber_mesh_info counts, size_t segments);

/* Adds a point's join word to the counts of a mesh's info. */
void camber_mesh_info_count(camber_mesh_info *info, uint32_t join, uint32_t point);

#endif
