/* Vertex buffers: the records and indices that GL draws, which scan and emit make from a mesh's points. */
#ifndef CAMBER_VERTICES_VERTICES_H
#define CAMBER_VERTICES_VERTICES_H

#include "residency/parts.h"

#include "camber_proof.h"

/* output.c: makes the output of meshes that GL draws or that a caller reads. */
extern const camber_mesh_output camber_vertices;

/* Makes sure that a part is made, that its join words are those of the mesh's method, and that they are scanned, so
 * that the part's counts are known. */
camber_status camber_part_ensure_counted(camber_mesh *mesh, camber_mesh_part *part);
/* Also makes sure that its output is in its buffers. */
camber_status camber_part_ensure_output(camber_mesh *mesh, camber_mesh_part *part);
/* Numbers the output of a counted part after the output of the previous parts, whose counts are given, and adds the
 * part's counts to them. */
camber_status camber_part_number(const camber_mesh *mesh, camber_mesh_part *part, camber_mesh_info *counts);
/* Calls finish of the shared buffers' table for a part's output. If status is a failure, which has been logged already,
 * returns it and logs nothing more. */
camber_status camber_part_finish(const camber_mesh *mesh, camber_mesh_part *part, bool written, camber_status status);

/* joins.c: adds the joins and triangles of a part to counts. The part's join words must be in its buffers. */
camber_status camber_part_count_joins(const camber_mesh *mesh, const camber_mesh_part *part, camber_mesh_info *counts);
/* Counts the join of a point, given its join word and its info word. */
void camber_mesh_info_add_join(camber_mesh_info *info, uint32_t join, uint32_t point);
/* Returns the most records that a mesh may have. Strips number two vertices per record with 32 bits; the other methods
 * number a record with the bits that CAMBER_CORNER_BITS leave. */
size_t camber_records_max(camber_method method);
camber_status camber_fail_records(camber_context *context, camber_method method);

/* read.c: finds the first index of a polyline among the indices of the whole mesh, as camber_mesh_read gives them.
 * Makes the polyline's part again if it was evicted. */
camber_status camber_mesh_first_index(camber_mesh *mesh, size_t polyline, uint64_t *first_index);

/* slot_starts.c: finds where the output of a part's polylines begins, from the results of classify and scan. */
typedef struct camber_slot_starts {
    camber_slot_finder finder;              /* its part must have been scanned */
    const uint32_t *joins, *info, *offsets; /* mapped; NULL: not needed yet */
    size_t at;                              /* the slot of the last query, and the sum for it */
    uint32_t sum;
} camber_slot_starts;

static inline camber_slot_starts camber_slot_starts_of(const camber_mesh *mesh, const camber_mesh_part *part) {
    return (camber_slot_starts){.finder = {.mesh = mesh, .part = part}};
}
/* Maps the whole part, unless it is mapped already. This waits for the device, so it is worthwhile only for many
 * queries. The part must not lose its buffers until it is unmapped. */
camber_status camber_slot_starts_map(camber_slot_starts *starts);
/* Unmaps and forgets the part, if there is one. */
void camber_slot_starts_unmap(camber_slot_starts *starts);
/* Returns how many vertices and indices the slot's block has before the slot, as vertices | indices << 16. Queries in
 * ascending order are cheap. This query, and one for the first slot of a polyline, need a mapped part. */
uint32_t camber_slot_starts_before(camber_slot_starts *starts, size_t slot);
size_t camber_slot_starts_slot(const camber_slot_starts *starts, size_t polyline);
/* Finds the first index of a polyline, and its first record. A strip has two indices for each record; kite and fan have
 * a record for each slot. The polyline just after the part's last one gives the end. The part is mapped only if
 * necessary: not for its first polyline, nor for its end. */
camber_status camber_slot_starts_index(camber_slot_starts *starts, size_t polyline, uint64_t *index);
camber_status camber_slot_starts_record(camber_slot_starts *starts, size_t polyline, size_t *record);

/* The host's part of the scan: adds up the blocks' sums (vertices | indices << 16) in 64 bits. bases has room for
 * 2 * (block_count + 1) numbers: each block's first vertex and first index, then the totals. */
void camber_scan_blocks(const uint32_t *sums, size_t block_count, uint64_t *bases);

/* expand.c: makes the vertices and indices of a mesh from its records and corners. */
camber_status camber_mesh_expand(camber_context *context, const camber_row *rows, camber_mesh_data *data);
/* For kite and fan: finds the number of each record's first vertex, record_count + 1 numbers. Free them with
 * camber_free. */
camber_status camber_mesh_data_find_first_vertices(camber_context *context, camber_mesh_data *data,
                                                   uint32_t **first_vertices);

#endif
