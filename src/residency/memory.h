/* Who is on the device: how much meshes hold, and which parts and sections go if memory is bounded. */
#ifndef CAMBER_RESIDENCY_MEMORY_H
#define CAMBER_RESIDENCY_MEMORY_H

#include "residency/mesh.h"

/* bytes.c: count again what a part, a section or a mesh holds, after buffers have been made or released. */
void camber_part_count_bytes(const camber_mesh *mesh, camber_mesh_part *part);
void camber_section_count_bytes(const camber_mesh *mesh, camber_section *section);
void camber_mesh_count_bytes(camber_mesh *mesh);
/* How many bytes a part's input takes for so many slots. */
uint64_t camber_input_bytes(const camber_device *device, bool has_arc_length, size_t slots);
/* The bytes of x, y and info alone. */
uint64_t camber_point_bytes(size_t slots);
/* The bytes of the input buffers that a part has: points that polylines lend it are none of its own. */
uint64_t camber_part_input_bytes(const camber_mesh *mesh, const camber_mesh_part *part);
/* How many bytes the source lines of a part take for so many slots. */
uint64_t camber_source_line_bytes(bool has_arc_length, size_t slots);

/* buffers.c: releases all buffers of a part, on device and host. It keeps its polylines. */
void camber_part_release_buffers(camber_mesh *mesh, camber_mesh_part *part);
/* Releases x, y and info, which may be lent by polylines. */
void camber_part_release_points(camber_mesh *mesh, camber_mesh_part *part);
/* Moves the buffers of one part to another that has none. */
void camber_part_move_buffers(camber_mesh_part *part, camber_mesh_part *from);
/* Whether the input buffers are large enough, and those of arc lengths are there if they are wanted. lent: points need
 * no buffers of the part's own. */
bool camber_part_has_input(const camber_mesh *mesh, const camber_mesh_part *part, size_t slots, bool lent);
camber_status camber_part_make_input(const camber_mesh *mesh, camber_mesh_part *part, size_t slots, bool lent);
/* Makes the buffers of source lines. */
camber_status camber_part_make_source_lines(const camber_mesh *mesh, camber_mesh_part *part, size_t slots);

/* memory.c: evicts parts and sections until more_bytes can be held in addition, and returns whether they now can. Never
 * evicts keep (NULL: none) and its section, and with spare_made no part of this mesh that is made. */
bool camber_mesh_evict_for(camber_mesh *mesh, const camber_mesh_part *keep, uint64_t more_bytes, bool spare_made);
/* Evicts, made parts of this mesh too. Fails with CAMBER_ERROR_LIMIT if that is not enough. */
camber_status camber_mesh_make_room(camber_mesh *mesh, const camber_mesh_part *keep, uint64_t more_bytes);
/* Gives a part without buffers those of the part that would be evicted for it, if so many bytes are not free. Cheaper
 * than to release them and make new ones. */
void camber_part_recycle_buffers(camber_mesh *mesh, camber_mesh_part *part, uint64_t wanted_bytes);

#endif
