/* How far along its polyline each point lies. */
#ifndef CAMBER_MEASURES_H
#define CAMBER_MEASURES_H

#include "tess/tess.h"

/* Makes the measures of a part's slots, which polylines have. */
camber_status camber_part_sum_arc_lengths(camber_mesh *mesh, camber_mesh_part *part);

/* The twin: of each slot, 0 of sentinels; freed with camber_free. */
camber_status camber_polylines_sum_arc_lengths(const camber_polylines *polylines, camber_arc_length **measures);

#endif
