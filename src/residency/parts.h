/* The parts of a mesh: how its source is divided, and what their buffers must hold. */
#ifndef CAMBER_RESIDENCY_PARTS_H
#define CAMBER_RESIDENCY_PARTS_H

#include "residency/mesh.h"

/* limits.c: how many bytes a part needs, input and, if it has been counted, output. */
uint64_t camber_part_needed_bytes(const camber_mesh *mesh, const camber_mesh_part *part);
/* The same of two neighbours that are one part. */
uint64_t camber_parts_needed_bytes(const camber_mesh *mesh, const camber_mesh_part parts[2]);
/* How many bytes a part's input of so many slots takes, with the arrays that the host keeps for it. */
uint64_t camber_part_slots_bytes(const camber_mesh *mesh, const camber_mesh_part *part, size_t slots);
/* How many bytes its output buffers are too small for its output. */
uint64_t camber_part_missing_output_bytes(const camber_mesh *mesh, const camber_mesh_part *part);
/* Sets *fits: whether the device makes a part's buffers for so many slots, and its share of memory takes them. A part
 * of a single polyline, which cannot be cut, fails with CAMBER_ERROR_LIMIT instead. */
camber_status camber_part_check_slots(const camber_mesh *mesh, const camber_mesh_part *part, uint64_t slots,
                                      bool *fits);
/* The same of source slots, for a mesh with offsets. */
camber_status camber_part_check_source_lines(const camber_mesh *mesh, const camber_mesh_part *part, uint64_t slots,
                                             bool *fits);
/* The same of the output of a part that has been counted. */
camber_status camber_part_check_output(const camber_mesh *mesh, const camber_mesh_part *part, bool *fits);
/* Fail with CAMBER_ERROR_LIMIT: a polyline alone is too large for its share of memory, or for the device's buffers. */
camber_status camber_fail_memory(const camber_mesh *mesh, size_t polyline, uint64_t size_bytes);
camber_status camber_fail_polyline(const camber_mesh *mesh, size_t polyline, uint64_t size_bytes);

/* reserve.c: make a part's buffers large enough, and evict others if need be. Input and host_bases, for so many slots;
 */
camber_status camber_part_reserve(camber_mesh *mesh, camber_mesh_part *part, size_t slots, bool lent);
/* for slots that a kernel makes, whose number it sets: for a network a quarter more if the device has plenty; */
camber_status camber_part_reserve_with_spare(camber_mesh *mesh, camber_mesh_part *part, size_t slots);
/* source lines; */
camber_status camber_part_reserve_source_lines(camber_mesh *mesh, camber_mesh_part *part, size_t slots);
/* and one of the output buffers. */
camber_status camber_part_reserve_output(camber_mesh *mesh, camber_mesh_part *part, size_t which, size_t size_bytes);

/* slots.c: the first slot of a polyline in its part. One just after the part's last gives the end of its slots. places:
 * those of the slots of offset lines, mapped; not read if the mesh has no offsets, nor for an end. */
size_t camber_part_slot(const camber_mesh *mesh, const camber_mesh_part *part, const uint32_t *places, size_t polyline);
/* The same among the given slots, before the offset stages. */
size_t camber_part_given_slot(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline);
/* The projection for a part's points, which are numbered from the start of their section; and how many chunks it walks,
 * of which the first and the last may be incomplete. */
camber_projection camber_part_projection(const camber_mesh *mesh, const camber_mesh_part *part);
size_t camber_projection_chunks(const camber_projection *projection);

/* slot_starts.c: where the slots of a part's polylines begin. Opened by naming mesh and part. */
typedef struct camber_slot_finder {
    const camber_mesh *mesh;
    const camber_mesh_part *part; /* which is made */
    const uint32_t *places;       /* mapped; NULL: nobody asked yet, or the mesh has no offsets */
} camber_slot_finder;

/* The first slot of a polyline. One just after the part's last gives the end. Offset lines make it wait for the device,
 * but for the part's first polyline and its end; then the part must not lose its buffers until the finder is closed. */
camber_status camber_slot_finder_find(camber_slot_finder *finder, size_t polyline, size_t *slot);
/* Maps what camber_part_slot needs of the part, unless it is mapped. */
camber_status camber_slot_finder_map(camber_slot_finder *finder);
/* Forgets the part. May be called of none. */
void camber_slot_finder_close(camber_slot_finder *finder);

/* parts.c: divides polylines, whose slots first_slots has, into parts whose input the device can hold.
 * CAMBER_ERROR_LIMIT names a polyline that fits into no part. */
camber_status camber_mesh_lay_out_parts(camber_mesh *mesh);
/* Adds a part without buffers at the end of the list. */
camber_status camber_mesh_add_part(camber_mesh *mesh, size_t first_polyline, size_t end_polyline);
/* Cuts a part in two at the middle of its polylines. The first takes its index, the other follows. */
camber_status camber_mesh_halve(camber_mesh *mesh, size_t which);
/* Called before another frame of the same network. If memory was full, releases buffers that were far too large for the
 * last frame. Merges pairs of parts that needed little of their share. */
void camber_mesh_compact_parts(camber_mesh *mesh);
/* Releases the buffers of parts past part_count, but keeps those of the very first part for the next polylines. */
void camber_mesh_trim_parts(camber_mesh *mesh);
void camber_mesh_release_parts(camber_mesh *mesh);

/* upload.c: uploads the part's slots, unless they have been; or lets kernels read the polylines' arrays. */
camber_status camber_part_upload(camber_mesh *mesh, camber_mesh_part *part);
/* Uploads the section that has a part's points, unless it is there. */
camber_status camber_part_upload_section(camber_mesh *mesh, const camber_mesh_part *part);
/* No kernel reads arrays of the polylines any more. */
void camber_mesh_return_points(camber_mesh *mesh);

/* source.c: plans the parts of polylines or of a network, which the mesh holds from then on. Parts, and what is
 * uploaded to them, stay if the source is that of last time. */
camber_status camber_mesh_plan(camber_mesh *mesh, const camber_polylines *polylines);
camber_status camber_mesh_plan_network(camber_mesh *mesh, camber_network *network);
/* Aims a camera at the network that the mesh holds, and gets the kernels for that. */
camber_status camber_mesh_aim(camber_mesh *mesh, const camber_camera *camera, const camber_tessellation_desc *desc);
/* The mesh has been tessellated: it holds the polylines no longer than it needs them. */
void camber_mesh_let_go(camber_mesh *mesh);
/* Releases the polylines or the network that the mesh holds, and the network's sections. */
void camber_mesh_release_source(camber_mesh *mesh);

#endif
