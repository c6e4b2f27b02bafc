/* The parts of a mesh: how its source is divided into them, and how large their buffers must be. */
#ifndef CAMBER_RESIDENCY_PARTS_H
#define CAMBER_RESIDENCY_PARTS_H

#include "residency/mesh.h"

/* limits.c: returns how many bytes a part needs for its input and, if it has been counted, its output. */
uint64_t camber_part_needed_bytes(const camber_mesh *mesh, const camber_mesh_part *part);
/* The same for two neighbouring parts, if they were one part. */
uint64_t camber_parts_needed_bytes(const camber_mesh *mesh, const camber_mesh_part parts[2]);
/* Returns how many bytes a part's input of `slots` slots takes, including the host's arrays for it. */
uint64_t camber_part_slots_bytes(const camber_mesh *mesh, const camber_mesh_part *part, size_t slots);
/* Returns by how many bytes a part's output buffers are too small for its output. */
uint64_t camber_part_missing_output_bytes(const camber_mesh *mesh, const camber_mesh_part *part);
/* Sets *fits: whether the device can make a part's buffers for `slots` slots, and they fit into the part's share of
 * memory. A part of a single polyline, which cannot be cut, fails with CAMBER_ERROR_LIMIT instead. */
camber_status camber_part_check_slots(const camber_mesh *mesh, const camber_mesh_part *part, uint64_t slots,
                                      bool *fits);
/* The same for the source slots of a mesh with offsets. */
camber_status camber_part_check_source_lines(const camber_mesh *mesh, const camber_mesh_part *part, uint64_t slots,
                                             bool *fits);
/* The same for the output of a part that has been counted. */
camber_status camber_part_check_output(const camber_mesh *mesh, const camber_mesh_part *part, bool *fits);
/* These fail with CAMBER_ERROR_LIMIT because a single polyline is too large for its share of memory, or for the
 * device's buffers. */
camber_status camber_fail_memory(const camber_mesh *mesh, size_t polyline, uint64_t size_bytes);
camber_status camber_fail_polyline(const camber_mesh *mesh, size_t polyline, uint64_t size_bytes);

/* reserve.c: these make a part's buffers large enough, and evict others if necessary. This one makes room for the input
 * of `slots` slots, and for host_bases. */
camber_status camber_part_reserve(camber_mesh *mesh, camber_mesh_part *part, size_t slots, bool borrowed);
/* The same for slots that a kernel makes. Sets the part's slot_count, and makes room for a quarter more slots of a
 * network if the device has plenty of memory. */
camber_status camber_part_reserve_with_spare(camber_mesh *mesh, camber_mesh_part *part, size_t slots);
/* Makes room in the buffers for source lines. */
camber_status camber_part_reserve_source_lines(camber_mesh *mesh, camber_mesh_part *part, size_t slots);
/* Makes room in one of the output buffers. */
camber_status camber_part_reserve_output(camber_mesh *mesh, camber_mesh_part *part, size_t which, size_t size_bytes);

/* slots.c: returns the first slot of a polyline in its part. The polyline just after the part's last one gives the end
 * of its slots. places are the mapped places of offset_emit; they are not read if the mesh has no offsets, or if the
 * slot is an end. */
size_t camber_part_slot(const camber_mesh *mesh, const camber_mesh_part *part, const uint32_t *places, size_t polyline);
/* The same among the source slots, before the offset stages. */
size_t camber_part_given_slot(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline);
/* These return the projection for a part's points, which are numbered from the start of their section, and how many
 * chunks it walks, of which the first and the last may be incomplete. */
camber_projection camber_part_projection(const camber_mesh *mesh, const camber_mesh_part *part);
size_t camber_projection_chunks(const camber_projection *projection);

/* slot_starts.c: finds where the slots of a part's polylines begin. To open it, set mesh and part. */
typedef struct camber_slot_finder {
    const camber_mesh *mesh;
    const camber_mesh_part *part; /* the part, which must be made */
    const uint32_t *places;       /* mapped; NULL: not needed yet, or the mesh has no offsets */
} camber_slot_finder;

/* Finds the first slot of a polyline. The polyline just after the part's last one gives the end. For offset lines it
 * waits for the device, except for the part's first polyline and its end; the part must then not lose its buffers until
 * the finder is closed. */
camber_status camber_slot_finder_find(camber_slot_finder *finder, size_t polyline, size_t *slot);
/* Maps the places that camber_part_slot needs, unless they are already mapped. */
camber_status camber_slot_finder_map(camber_slot_finder *finder);
/* Unmaps the places and forgets the part, if there is one. */
void camber_slot_finder_close(camber_slot_finder *finder);

/* parts.c: divides the polylines, whose slots are in first_slots, into parts whose input the device can hold.
 * CAMBER_ERROR_LIMIT names a polyline that fits into no part. */
camber_status camber_mesh_lay_out_parts(camber_mesh *mesh);
/* Adds a part without buffers at the end of the list. */
camber_status camber_mesh_add_part(camber_mesh *mesh, size_t first_polyline, size_t end_polyline);
/* Cuts a part in two at the middle of its polylines. The first half keeps its index; the other follows. */
camber_status camber_mesh_halve(camber_mesh *mesh, size_t which);
/* Called before another frame of the same network. If memory was full, releases buffers that were far too large for the
 * last frame. Merges pairs of neighbouring parts that needed little of their share. */
void camber_mesh_compact_parts(camber_mesh *mesh);
/* Releases the buffers of parts past part_count, but keeps those of the very first part for the next polylines. */
void camber_mesh_trim_parts(camber_mesh *mesh);
void camber_mesh_release_parts(camber_mesh *mesh);

/* upload.c: uploads the part's slots, unless this has been done, or lets kernels borrow the polylines' arrays. */
camber_status camber_part_upload(camber_mesh *mesh, camber_mesh_part *part);
/* Uploads the section that has a part's points, unless it is on the device already. */
camber_status camber_part_upload_section(camber_mesh *mesh, const camber_mesh_part *part);
/* Ends the borrowing of the polylines' arrays: no kernel reads them any more. */
void camber_mesh_return_points(camber_mesh *mesh);

/* source.c: plans the parts of polylines or of a network, which the mesh holds from then on. If the source is the same
 * as last time, the parts are kept, with the data that was uploaded to them. */
camber_status camber_mesh_plan(camber_mesh *mesh, const camber_polylines *polylines);
camber_status camber_mesh_plan_network(camber_mesh *mesh, camber_network *network);
/* Aims a camera at the network that the mesh holds, and gets the kernels for it. */
camber_status camber_mesh_aim(camber_mesh *mesh, const camber_camera *camera, const camber_tessellation_desc *desc);
/* Called when the mesh has been tessellated: releases the polylines unless they are still needed. */
void camber_mesh_let_go(camber_mesh *mesh);
/* Releases the polylines or the network that the mesh holds, and the network's sections. */
void camber_mesh_release_source(camber_mesh *mesh);

#endif
