/* The ways of a file, its relations and its nodes with tags: the tags that the style reads, and the ids of their nodes
 * or ways. */
#ifndef CAMBER_OSM_WAYS_H
#define CAMBER_OSM_WAYS_H

#include "features/features.h"
#include "osm/blobs.h"
#include "osm/node_set.h"
#include "osm/relations.h"
#include "osm/where.h"

/* How the reader uses the key of a tag. */
typedef struct camber_osm_key {
    const char *name;
    size_t length;
    uint32_t property;                 /* index into the style's properties; UINT32_MAX: none */
    uint32_t filter;                   /* index into the filter's keys; UINT32_MAX: none */
    bool area, is_area, highway, type; /* area: it marks areas; is_area: it is the key "area" itself */
} camber_osm_key;

/* Bits of a way. */
enum {
    CAMBER_OSM_WAY_AREA = 1,   /* it is an area if it is closed */
    CAMBER_OSM_WAY_MEMBER = 2, /* it belongs to a relation that is an area */
    CAMBER_OSM_WAY_BARE = 4,   /* it is only a member: it has no tags, or the filter rejects it */
    CAMBER_OSM_WAY_GAPS = 8,   /* the file lacks some nodes in its middle */
    CAMBER_OSM_WAY_BITS = 16
};

typedef struct camber_osm_way {
    uint32_t tags; /* index into the sets of tags, times CAMBER_OSM_WAY_BITS, plus the bits */
    uint32_t node_count;
} camber_osm_way;

/* A node with tags. */
typedef struct camber_osm_point {
    double longitude, latitude; /* degrees */
    uint32_t set;               /* index into the sets of tags */
} camber_osm_point;

/* Consecutive ways of one block, and the positions at which the ids of their nodes and the leaves of the block begin.
 * After packing, also the position of their places (packed.h). */
typedef struct camber_osm_run {
    size_t first_way, way_count, first_id, first_leaf, first_packed, node_count;
} camber_osm_run;

typedef struct camber_osm_ways {
    camber_context *context;
    camber_features *features;
    camber_osm_key *keys;
    size_t key_count;
    bool has_places;                /* ways contain the places of their nodes */
    const camber_osm_where *where;  /* NULL: all ways pass */
    camber_osm_relations relations; /* empty unless areas are read */

    camber_osm_way *ways;
    size_t way_count, way_capacity;
    uint32_t *ids; /* node_count: leaf of the block * 2^CAMBER_OSM_LEAF_BITS + the id's lower bits */
    size_t id_capacity;
    uint32_t *leaves; /* the leaves of the blocks, one block after the other, as indices of leaves of the node set */
    size_t leaf_count, leaf_capacity;
    camber_osm_run *runs;
    size_t run_count, run_capacity;
    size_t node_count; /* the number of nodes of all ways; a node counts each time it is named */
    camber_osm_node_set nodes;
    uint32_t *packed; /* places in packed form, after packing (packed.h); a run does not depend on the one before */
    size_t packed_count, packed_capacity;

    camber_osm_point *points; /* empty unless points are read */
    size_t point_count, point_capacity;

    /* Sets of tags. Two sets differ in at least one property that the style reads. */
    const char **values; /* set_count * schema->property_count, interned. NULL: the set does not have the key */
    size_t set_count, value_capacity;
    uint32_t *slots; /* a hash table: index + 1; 0: free */
    size_t slot_count;
    char *text; /* scratch: a string and its final 0 */
    size_t text_capacity;
    uint32_t *local; /* by set of a block: its index among the sets of the file */
    size_t local_capacity;
} camber_osm_ways;

/* where may be NULL; otherwise it must outlive the ways. *declined: the style reads a property that is not a tag, or
 * keys of the filter differ from others only in their case. */
camber_status camber_osm_ways_init(camber_osm_ways *ways, camber_features *features, const camber_osm_where *where,
                                   bool *declined);
void camber_osm_ways_free(camber_osm_ways *ways);

typedef struct camber_osm_ways_desc {
    const camber_osm_file *file;
    size_t first_blob; /* the first blob that may have a way (or a relation, when relations are read) */
    size_t end_blob;   /* for ways: the blob where relations begin, if the file is in order; for nodes: the blob where
                          nodes end */
    bool any_order;    /* nodes, ways and relations may come in any order */
    unsigned threads;
    double from, to; /* the progress before and after this pass */
} camber_osm_ways_desc;

/* Reads the relations of a file that are areas. Call this before the file's ways are read. *declined: ids are out of
 * range. */
camber_status camber_osm_relations_read(camber_osm_ways *ways, const camber_osm_ways_desc *desc, bool *declined);
/* Reads the ways of a file. *declined: nodes come after ways, ids are out of range, or relations that matter come
 * before ways. */
camber_status camber_osm_ways_read(camber_osm_ways *ways, const camber_osm_ways_desc *desc, bool *declined);
/* Reads the nodes with tags in the blobs before desc->end_blob. */
camber_status camber_osm_points_read(camber_osm_ways *ways, const camber_osm_ways_desc *desc, bool *declined);

#endif
