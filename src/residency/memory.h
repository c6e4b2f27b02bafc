/* Residency: how much memory meshes hold on the device, and which parts and sections are evicted if memory is limited.
 */
#ifndef CAMBER_RESIDENCY_MEMORY_H
#define CAMBER_RESIDENCY_MEMORY_H

#include "residency/mesh.h"

typedef struct camber_mesh_memory {
    size_t parts;          /* groups of consecutive polylines with buffers of their own: 1 if there is room */
    size_t resident_parts; /* parts that need not be tessellated again to be read or drawn */
    size_t remade_parts;   /* parts that were tessellated again since the last tessellation */
    uint64_t held_bytes;   /* bytes of the mesh that count against the device's memory limit */
} camber_mesh_memory;

/* bytes.c: adds up the memory that a mesh and its parts hold. */
camber_mesh_memory camber_mesh_get_memory(const camber_mesh *mesh);

/* bytes.c: these recount the memory that a part, a section or a mesh holds, after buffers have been made or released.
 */
void camber_part_count_bytes(const camber_mesh *mesh, camber_mesh_part *part);
void camber_section_count_bytes(const camber_mesh *mesh, camber_section *section);
void camber_mesh_count_bytes(camber_mesh *mesh);
/* Returns how many bytes a part's input takes for `slots` slots. */
uint64_t camber_input_bytes(const camber_device *device, bool has_arc_length, size_t slots);
/* Returns the same for x, y and info only. */
uint64_t camber_point_bytes(size_t slots);
/* Returns the bytes of the input buffers that a part owns; points that it borrows from polylines do not count. */
uint64_t camber_part_input_bytes(const camber_mesh *mesh, const camber_mesh_part *part);
/* Returns how many bytes the source lines of a part take for `slots` slots. */
uint64_t camber_source_line_bytes(bool has_arc_length, size_t slots);

/* buffers.c: releases all buffers of a part, on device and host. It keeps its polylines. */
void camber_part_release_buffers(camber_mesh *mesh, camber_mesh_part *part);
/* Releases x, y and info, which may be borrowed from polylines. */
void camber_part_release_points(camber_mesh *mesh, camber_mesh_part *part);
/* Moves the buffers of one part to another that has none. */
void camber_part_move_buffers(camber_mesh_part *part, camber_mesh_part *from);
/* Whether the input buffers are large enough, including those for arc lengths if they are needed. borrowed: points are
 * borrowed, so the part needs no buffers for them. */
bool camber_part_has_input(const camber_mesh *mesh, const camber_mesh_part *part, size_t slots, bool borrowed);
camber_status camber_part_make_input(const camber_mesh *mesh, camber_mesh_part *part, size_t slots, bool borrowed);
/* Makes the buffers for source lines. */
camber_status camber_part_make_source_lines(const camber_mesh *mesh, camber_mesh_part *part, size_t slots);

/* memory.c: evicts parts and sections until more_bytes can be held in addition, and returns whether they now can. It
 * never evicts keep (NULL: none) or its section, nor, with spare_made, a part of this mesh that is made. */
bool camber_mesh_evict_for(camber_mesh *mesh, const camber_mesh_part *keep, uint64_t more_bytes, bool spare_made);
/* Evicts, including parts of this mesh that are made. Fails with CAMBER_ERROR_LIMIT if that is not enough. */
camber_status camber_mesh_make_room(camber_mesh *mesh, const camber_mesh_part *keep, uint64_t more_bytes);
/* If wanted_bytes are not free, moves the buffers of the part that would be evicted to a part without buffers. This is
 * cheaper than releasing them and making new ones. */
void camber_part_recycle_buffers(camber_mesh *mesh, camber_mesh_part *part, uint64_t wanted_bytes);

#endif
