/* The sea of an extract. OpenStreetMap maps a coast, with land on its left, and no sea. */
#ifndef CAMBER_OSM_COAST_H
#define CAMBER_OSM_COAST_H

#include "osm/assemble.h"
#include "osm/blobs.h"

typedef struct camber_osm_coast {
    camber_context *context;
    uint64_t *places; /* of all ways, one after the other */
    size_t place_count, place_capacity;
    size_t *ends; /* way_count: where the places of each end */
    size_t way_count, way_capacity;
} camber_osm_coast;

/* Adds a way by its nodes' places. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_osm_coast_add(camber_osm_coast *coast, const uint64_t *places, size_t count);
void camber_osm_coast_free(camber_osm_coast *coast);

/* Replaces the rings by those of the sea within a box. sea->open: there are none, since the coast begins or ends within
 * the box, or says of a part of the box's sides both that it is sea and that it is land. Returns CAMBER_ERROR_MEMORY.
 */
camber_status camber_osm_coast_fill(const camber_osm_coast *coast, camber_osm_box box, camber_osm_assembly *sea);

#endif
