/* The sea in an extract. OpenStreetMap maps the coast, with land on its left, but not the sea. */
#ifndef CAMBER_OSM_COAST_H
#define CAMBER_OSM_COAST_H

#include "osm/assemble.h"
#include "osm/blobs.h"

typedef struct camber_osm_coast {
    camber_context *context;
    camber_osm_box box; /* the box to be filled with sea */
    uint64_t *places;   /* the places of all ways, one way after the other */
    size_t place_count, place_capacity;
    size_t *ends; /* way_count: the end of each way's places */
    size_t way_count, way_capacity;
} camber_osm_coast;

/* Adds a way, given by the places of its nodes. has_gaps: some nodes in its middle are missing, perhaps because they
 * are outside the box. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_osm_coast_add(camber_osm_coast *coast, const uint64_t *places, size_t count, bool has_gaps);
void camber_osm_coast_free(camber_osm_coast *coast);

/* Replaces the rings in `sea` by the rings around the sea in the box. Islands on land and seas within the sea are
 * dropped. sea->open: there are no rings, because the box is empty, or the coast begins or ends inside it or
 * contradicts itself. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_osm_coast_fill(const camber_osm_coast *coast, camber_osm_assembly *sea);

#endif
