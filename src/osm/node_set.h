/* The nodes that lines need, and their places: a bitmap of ids, and eight bytes per node. */
#ifndef CAMBER_OSM_NODE_SET_H
#define CAMBER_OSM_NODE_SET_H

#include "base/base.h"

/* Ids must be below 2^36. The ids in OpenStreetMap are below 2^34 (2026). */
#define CAMBER_OSM_MOST_ID ((int64_t)1 << 36)

enum { CAMBER_OSM_LEAF_WORDS = 8, CAMBER_OSM_LEAF_BITS = 9 };

/* 512 consecutive ids. */
typedef struct camber_osm_leaf {
    uint64_t bits[CAMBER_OSM_LEAF_WORDS];
    uint16_t before[CAMBER_OSM_LEAF_WORDS]; /* the number of ids in the words before this one, valid after completion */
} camber_osm_leaf;

typedef struct camber_osm_node_set {
    camber_context *context;
    /* Three levels: an id's upper bits, six bits, nine bits. Entries are indices + 1; 0: no ids there. */
    uint32_t *branches;
    size_t branch_count, branch_capacity;
    uint32_t (*twigs)[64];
    size_t twig_count, twig_capacity;
    camber_osm_leaf *leaves;
    size_t leaf_count, leaf_capacity;
    uint32_t *ranks; /* leaf_count: the number of ids in the leaves before this one, valid after completion */
    size_t node_count;
    _Atomic uint64_t *places; /* node_count: longitude and latitude in 10^-7 degrees; CAMBER_OSM_NOWHERE */
    size_t found_count;       /* how many of the nodes have a place */
    uint64_t last_leaf_id;    /* the leaf to which an id was added last; UINT64_MAX: none */
    size_t last_leaf;
} camber_osm_node_set;

/* Stands for a missing place; no real place has this longitude. */
#define CAMBER_OSM_NOWHERE UINT64_C(0x8000000080000000)

static inline uint64_t camber_osm_place(int32_t longitude, int32_t latitude) {
    return (uint64_t)(uint32_t)longitude << 32 | (uint32_t)latitude;
}

static inline int32_t camber_osm_longitude(uint64_t place) {
    return (int32_t)(uint32_t)(place >> 32);
}

static inline int32_t camber_osm_latitude(uint64_t place) {
    return (int32_t)(uint32_t)place;
}

/* A thread's hint for its next search: the leaf and the node that it found last, because ids are often consecutive. */
typedef struct camber_osm_search_hint {
    uint64_t leaf_id; /* UINT64_MAX: none yet */
    uint32_t leaf;    /* the leaf's index + 1; 0: the set does not have this leaf */
    int64_t id;
    uint32_t index;
} camber_osm_search_hint;

void camber_osm_node_set_init(camber_osm_node_set *set, camber_context *context);
void camber_osm_node_set_free(camber_osm_node_set *set);
/* Adds an id, with 0 <= id < CAMBER_OSM_MOST_ID. */
camber_status camber_osm_node_set_add(camber_osm_node_set *set, int64_t id);
/* Adds ids that share a leaf. A bitmap has their lower bits, and leaf_id is their upper bits. *leaf: the leaf's
 * index. */
camber_status camber_osm_node_set_add_leaf(camber_osm_node_set *set, uint64_t leaf_id,
                                           const uint64_t bits[CAMBER_OSM_LEAF_WORDS], uint32_t *leaf);
/* Completes the set. No ids may be added afterwards. */
camber_status camber_osm_node_set_complete(camber_osm_node_set *set);
/* Finds the index of the place that belongs to an id. Returns false if no line needs the id. */
bool camber_osm_node_set_find(const camber_osm_node_set *set, int64_t id, camber_osm_search_hint *hint,
                              uint32_t *index);

/* Counts the bits that are set: adds up neighbouring bits, then pairs, then bytes. The compiler's library function
 * takes longer. */
static inline uint32_t camber_osm_count_bits(uint64_t word) {
    word = word - (word >> 1 & 0x5555555555555555u);
    word = (word & 0x3333333333333333u) + (word >> 2 & 0x3333333333333333u);
    return (uint32_t)(((word + (word >> 4)) & 0x0f0f0f0f0f0f0f0fu) * 0x0101010101010101u >> 56);
}

/* Returns the index of an id in a leaf of the set. The code has no branches that depend on the id. */
static inline uint32_t camber_osm_node_set_index(const camber_osm_node_set *set, uint32_t leaf, uint32_t id) {
    const camber_osm_leaf *from = &set->leaves[leaf];
    const uint32_t word = id >> 6 & (CAMBER_OSM_LEAF_WORDS - 1);
    return set->ranks[leaf] + from->before[word] +
           camber_osm_count_bits(from->bits[word] & ((UINT64_C(1) << (id & 63)) - 1));
}

#endif
