/* Rings of a multipolygon, put together of the ways that a relation names. */
#ifndef CAMBER_OSM_ASSEMBLE_H
#define CAMBER_OSM_ASSEMBLE_H

#include "base/base.h"

typedef enum camber_osm_role {
    CAMBER_OSM_ROLE_UNKNOWN = 0, /* the other rings tell */
    CAMBER_OSM_ROLE_OUTER,
    CAMBER_OSM_ROLE_INNER,
} camber_osm_role;

/* A way as its nodes' places (camber_osm_place), two at least. */
typedef struct camber_osm_piece {
    const uint64_t *places;
    uint32_t count;
    camber_osm_role role;
} camber_osm_piece;

/* A ring has the places [first, first + count), and its first once more at its end. */
typedef struct camber_osm_ring {
    size_t first, count;
    camber_osm_role role; /* OUTER or INNER */
} camber_osm_ring;

typedef struct camber_osm_assembly {
    camber_context *context;
    uint64_t *places;
    size_t place_count, place_capacity;
    camber_osm_ring *rings; /* outer rings come first */
    size_t ring_count, ring_capacity;
    bool open;    /* pieces were left that form no ring */
    size_t steps; /* looked at so far to find out what lies in what; of all that were put together */
} camber_osm_assembly;

/* Replaces the rings; keeps the memory. whole: no piece is missing, so that geometry tells what is a hole; else the
 * roles do. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_osm_assemble(camber_osm_assembly *assembly, const camber_osm_piece *pieces, size_t count,
                                  bool whole);
void camber_osm_assembly_free(camber_osm_assembly *assembly);

#endif
