/* Lines that lie beside others. */
#ifndef CAMBER_OFFSET_H
#define CAMBER_OFFSET_H

#include "tess/mesh.h"

#include "kernels/offset_pieces.h"

/* Whether a stroke has an offset. */
bool camber_desc_has_offsets(const camber_tessellation_desc *desc);
/* Uploads what offsets need of the rows of a mesh that has some; else its parts let go what they had for them. */
camber_status camber_mesh_set_offsets(camber_mesh *mesh, const camber_tessellation_desc *desc);

/* Whether the device makes buffers for the course of so many slots; *fits is false where it does not, and there are
 * several polylines. */
camber_status camber_part_check_course(const camber_mesh *mesh, const camber_mesh_part *part, uint64_t slots,
                                       bool *fits);
camber_status camber_part_reserve_course(camber_mesh *mesh, camber_mesh_part *part, size_t slots);
void camber_course_release(const camber_device *device, camber_part_course *course);
/* span, tell and shift: the part's slots from those of its course. *fits as that of camber_part_project. */
camber_status camber_part_offset(camber_mesh *mesh, camber_mesh_part *part, bool *fits);

/* The twin: polylines beside others, whose measures are given where they are wanted; the polylines' own then. */
camber_status camber_polylines_offset(const camber_polylines *polylines, const camber_tessellation_desc *desc,
                                      const camber_measure *measures, camber_polylines **beside);

#endif
