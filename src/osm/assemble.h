/* Assembles the rings of a multipolygon from the ways that its relation names. */
#ifndef CAMBER_OSM_ASSEMBLE_H
#define CAMBER_OSM_ASSEMBLE_H

#include "base/base.h"

typedef enum camber_osm_role {
    CAMBER_OSM_ROLE_UNKNOWN = 0, /* the other rings decide */
    CAMBER_OSM_ROLE_OUTER,
    CAMBER_OSM_ROLE_INNER,
} camber_osm_role;

/* A way, given by the places of its nodes (camber_osm_place), of which there are at least two. */
typedef struct camber_osm_piece {
    const uint64_t *places;
    uint32_t count;
    camber_osm_role role;
} camber_osm_piece;

/* A ring has the places [first, first + count); the first place is repeated at the end. */
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
    bool open;    /* some pieces do not form a ring */
    size_t steps; /* places examined so far to find out which ring is inside which, over all assemblies */
} camber_osm_assembly;

/* Replaces the assembly's rings and reuses their memory. whole: no piece is missing, so geometry decides which rings
 * are holes; otherwise roles do. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_osm_assemble(camber_osm_assembly *assembly, const camber_osm_piece *pieces, size_t count,
                                  bool whole);
void camber_osm_assembly_free(camber_osm_assembly *assembly);

#endif
