/* The ways of a file, its relations and its nodes with tags: what the style reads of their tags, and the ids of their
 * nodes or ways. */
#ifndef CAMBER_OSM_WAYS_H
#define CAMBER_OSM_WAYS_H

#include "features/features.h"
#include "osm/blobs.h"
#include "osm/node_set.h"
#include "osm/relations.h"
#include "osm/where.h"

/* The use that the reader has for a key of a tag. */
typedef struct camber_osm_key {
    const char *name;
    size_t length;
    uint32_t property;                 /* index into the style's properties; UINT32_MAX: none */
    uint32_t filter;                   /* index into the filter's keys; UINT32_MAX: none */
    bool area, is_area, highway, type; /* area: of areas; is_area: the key "area" itself */
} camber_osm_key;

/* Bits of a way. */
enum {
    CAMBER_OSM_WAY_AREA = 1,   /* closed, it is an area */
    CAMBER_OSM_WAY_MEMBER = 2, /* of a relation that is an area */
    CAMBER_OSM_WAY_BARE = 4,   /* only a member: without tags, or kept out by the filter */
    CAMBER_OSM_WAY_GAPS = 8,   /* the file lacks nodes between others of it */
    CAMBER_OSM_WAY_BITS = 16
};

typedef struct camber_osm_way {
    uint32_t tags; /* index into the sets of tags, times CAMBER_OSM_WAY_BITS; and the bits */
    uint32_t node_count;
} camber_osm_way;

/* A node with tags. */
typedef struct camber_osm_point {
    double longitude, latitude; /* degrees */
    uint32_t set;               /* of tags */
} camber_osm_point;

/* Ways in a row, of one block, and where the ids of their nodes begin and the block's leaves; later, where their places
 * begin (packed.h). */
typedef struct camber_osm_run {
    size_t first_way, way_count, first_id, first_leaf, first_packed, node_count;
} camber_osm_run;

typedef struct camber_osm_ways {
    camber_context *context;
    camber_features *features;
    camber_osm_key *keys;
    size_t key_count;
    bool has_places;                /* ways have places of nodes */
    const camber_osm_where *where;  /* NULL: all ways pass */
    camber_osm_relations relations; /* none unless areas are read */

    camber_osm_way *ways;
    size_t way_count, way_capacity;
    uint32_t *ids; /* node_count: a leaf of the block, times 2^CAMBER_OSM_LEAF_BITS, and the id's lower bits */
    size_t id_capacity;
    uint32_t *leaves; /* those of a block, one block after the other, as leaves of the nodes */
    size_t leaf_count, leaf_capacity;
    camber_osm_run *runs;
    size_t run_count, run_capacity;
    size_t node_count; /* of all ways, each as often as it is named */
    camber_osm_node_set nodes;
    uint32_t *packed; /* places, once they are known (packed.h), beginning anew with each run */
    size_t packed_count, packed_capacity;

    camber_osm_point *points; /* none unless points are read */
    size_t point_count, point_capacity;

    /* Sets of tags that differ in what the style reads. */
    const char **values; /* set_count * schema->property_count, interned. NULL: it does not have the key */
    size_t set_count, value_capacity;
    uint32_t *slots; /* a hash table: index + 1; 0: free */
    size_t slot_count;
    char *text; /* a string with its 0 */
    size_t text_capacity;
    uint32_t *local; /* the sets of a block as sets of the file */
    size_t local_capacity;
} camber_osm_ways;

/* where may be NULL; else it must outlive the ways. *declined: the style reads what is no tag, or the filter's keys
 * differ from others in their case alone. */
camber_status camber_osm_ways_init(camber_osm_ways *ways, camber_features *features, const camber_osm_where *where,
                                   bool *declined);
void camber_osm_ways_free(camber_osm_ways *ways);

typedef struct camber_osm_ways_desc {
    const camber_osm_file *file;
    size_t first_blob; /* the first that may have a way, or a relation */
    size_t end_blob;   /* of ways: where relations begin, if the file is in order; of nodes: where they end */
    bool any_order;    /* nodes and relations may come wherever they do */
    unsigned threads;
    double from, to; /* of the progress */
} camber_osm_ways_desc;

/* Reads the relations of a file that are areas, before its ways. *declined: ids are beyond the bounds. */
camber_status camber_osm_relations_read(camber_osm_ways *ways, const camber_osm_ways_desc *desc, bool *declined);
/* Reads the ways of a file. *declined: nodes come behind ways, ids are beyond the bounds, or relations that matter come
 * before ways. */
camber_status camber_osm_ways_read(camber_osm_ways *ways, const camber_osm_ways_desc *desc, bool *declined);
/* Reads the nodes with tags among the first blobs, up to desc->end_blob. */
camber_status camber_osm_points_read(camber_osm_ways *ways, const camber_osm_ways_desc *desc, bool *declined);

#endif
