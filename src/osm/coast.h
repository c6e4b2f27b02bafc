/* The sea of an extract. OpenStreetMap maps a coast, with land on its left, and no sea. */
#ifndef CAMBER_OSM_COAST_H
#define CAMBER_OSM_COAST_H

#include "osm/assemble.h"
#include "osm/blobs.h"

typedef struct camber_osm_coast {
    camber_context *context;
    camber_osm_box box; /* in which the sea is wanted */
    uint64_t *places;   /* of all ways, one after the other */
    size_t place_count, place_capacity;
    size_t *ends; /* way_count: where the places of each end */
    size_t way_count, way_capacity;
} camber_osm_coast;

/* Adds a way by its nodes' places. has_gaps: nodes in its middle were lost, maybe beyond the box. Returns
 * CAMBER_ERROR_MEMORY. */
camber_status camber_osm_coast_add(camber_osm_coast *coast, const uint64_t *places, size_t count, bool has_gaps);
void camber_osm_coast_free(camber_osm_coast *coast);

/* Replaces the rings by those of the sea within the box. Islands on land and seas in the sea are left out. sea->open:
 * there are no rings, as the box has no inside, the coast begins or ends in it, or contradicts itself. Returns
 * CAMBER_ERROR_MEMORY. */
camber_status camber_osm_coast_fill(const camber_osm_coast *coast, camber_osm_assembly *sea);

#endif
