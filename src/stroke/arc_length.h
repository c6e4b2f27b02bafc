/* Computes arc lengths: how far along its polyline each point is. */
#ifndef CAMBER_STROKE_ARC_LENGTH_H
#define CAMBER_STROKE_ARC_LENGTH_H

#include "residency/mesh.h"

/* Makes the arc lengths of a part's slots on the device. Only for parts of polylines: a network has its own arc
 * lengths. */
camber_status camber_part_sum_arc_lengths(camber_mesh *mesh, camber_mesh_part *part);

/* The CPU twin. Makes one arc length per slot, 0 for sentinels. Free them with camber_free. */
camber_status camber_polylines_sum_arc_lengths(const camber_polylines *polylines, camber_arc_length **arc_lengths);

#endif
