/* The nodes that lines need, and where they lie: a bitmap of their ids, and eight bytes a node. */
#ifndef CAMBER_OSM_NODE_SET_H
#define CAMBER_OSM_NODE_SET_H

#include "base/base.h"

/* Ids are below 2^36; OpenStreetMap's are below 2^34 (2026). */
#define CAMBER_OSM_MOST_ID ((int64_t)1 << 36)

enum { CAMBER_OSM_LEAF_WORDS = 8 };

/* The ids of 512 nodes in a row. */
typedef struct camber_osm_leaf {
    uint64_t bits[CAMBER_OSM_LEAF_WORDS];
    uint16_t before[CAMBER_OSM_LEAF_WORDS]; /* nodes of the words before, once the ids are complete */
} camber_osm_leaf;

typedef struct camber_osm_node_set {
    camber_context *context;
    /* Three levels: an id's upper bits, six bits, nine bits. Entries are indices + 1; 0: no node is there. */
    uint32_t *branches;
    size_t branch_count, branch_capacity;
    uint32_t (*twigs)[64];
    size_t twig_count, twig_capacity;
    camber_osm_leaf *leaves;
    size_t leaf_count, leaf_capacity;
    uint32_t *ranks; /* leaf_count: nodes of the leaves before, once the ids are complete */
    size_t node_count;
    _Atomic uint64_t *places; /* node_count: longitude and latitude in 10^-7 degrees; CAMBER_OSM_NOWHERE */
    uint64_t last_leaf_id;    /* of the leaf that was added to last; UINT64_MAX: none */
    size_t last_leaf;
} camber_osm_node_set;

/* No place has this longitude. */
#define CAMBER_OSM_NOWHERE UINT64_C(0x8000000080000000)

static inline uint64_t camber_osm_place(int32_t longitude, int32_t latitude) {
    return (uint64_t)(uint32_t)longitude << 32 | (uint32_t)latitude;
}

/* Where a thread found its last leaf, and its last node: ids often follow each other. */
typedef struct camber_osm_finger {
    uint64_t leaf_id; /* UINT64_MAX: none yet */
    uint32_t leaf;    /* index + 1; 0: there is none */
    int64_t id;
    uint32_t index;
} camber_osm_finger;

void camber_osm_node_set_init(camber_osm_node_set *set, camber_context *context);
void camber_osm_node_set_free(camber_osm_node_set *set);
/* 0 <= id < CAMBER_OSM_MOST_ID */
camber_status camber_osm_node_set_add(camber_osm_node_set *set, int64_t id);
/* No id is added from now on. */
camber_status camber_osm_node_set_complete(camber_osm_node_set *set);
/* Finds the index of an id's place. false: no line needs it. */
bool camber_osm_node_set_find(const camber_osm_node_set *set, int64_t id, camber_osm_finger *finger, uint32_t *index);

#endif
