/* How far along its polyline each point lies. */
#ifndef CAMBER_MEASURES_H
#define CAMBER_MEASURES_H

#include "tess/mesh.h"

/* Makes the measures of a part's slots, which polylines have. */
camber_status camber_part_measure(camber_mesh *mesh, camber_mesh_part *part);

/* The twin: of each slot, 0 of ghosts; freed with camber_free. */
camber_status camber_polylines_measure(const camber_polylines *polylines, camber_measure **measures);

#endif
