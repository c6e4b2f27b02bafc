/* Lines with an offset. kernels/offset.h has the geometry. */
#ifndef CAMBER_STROKE_OFFSET_H
#define CAMBER_STROKE_OFFSET_H

#include "residency/mesh.h"

#include "kernels/offset_emit.h"

/* Whether any stroke of the desc has an offset. */
bool camber_desc_has_offsets(const camber_tessellation_desc *desc);
/* Sets whether a mesh has offsets. If it has, uploads its rows' values for the offset kernels. If the answer changes,
 * its parts lose their buffers. */
camber_status camber_mesh_set_offsets(camber_mesh *mesh, const camber_tessellation_desc *desc);

/* Runs offset_clip, offset_count and offset_emit: makes the part's slots from the slots of its source lines. *fits is
 * as for camber_part_project. */
camber_status camber_part_offset(camber_mesh *mesh, camber_mesh_part *part, bool *fits);

/* The CPU twin: makes the offset lines of polylines. arc_lengths: one per slot of the polylines, or NULL if none are
 * wanted. */
camber_status camber_polylines_offset(const camber_polylines *polylines, const camber_tessellation_desc *desc,
                                      const camber_arc_length *arc_lengths, camber_polylines **beside);

#endif
