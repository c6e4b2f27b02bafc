/* The relations of a file that are areas (multipolygons and boundaries), and the ways that they name. */
#ifndef CAMBER_OSM_RELATIONS_H
#define CAMBER_OSM_RELATIONS_H

#include "osm/assemble.h"
#include "osm/node_set.h"

typedef struct camber_osm_member {
    int64_t way; /* its id */
    camber_osm_role role;
} camber_osm_member;

typedef struct camber_osm_relation {
    uint32_t set;   /* index into the sets of tags, + 1; 0: none */
    bool is_tagged; /* it has tags besides its type; otherwise it takes the tags of its first outer way that has any */
    uint32_t member_count;
    size_t first_member;
} camber_osm_relation;

/* A way that a relation names. Its fields are filled in when the way is met in the file. */
typedef struct camber_osm_member_way {
    size_t first_place;
    uint32_t place_count; /* 0: the file does not have it */
    uint32_t set;         /* index of its own set of tags, + 1; 0: it has none */
    uint32_t listed;      /* the last relation that listed it, + 1: a way named twice is a member once */
    bool is_outer;        /* a relation has its tags and is filled instead of it */
} camber_osm_member_way;

typedef struct camber_osm_relations {
    camber_context *context;
    camber_osm_relation *items;
    size_t count, capacity;
    camber_osm_member *members;
    size_t member_count, member_capacity;
    camber_osm_node_set ids;     /* ids of the ways */
    camber_osm_member_way *ways; /* by the index of their id; NULL: there are no relations */
    uint32_t *met;               /* indices of the ways that the file contains, in the order of the file */
    size_t met_count, met_capacity;
    uint64_t *places; /* the places of the ways' nodes */
    size_t place_count, place_capacity;
} camber_osm_relations;

void camber_osm_relations_init(camber_osm_relations *relations, camber_context *context);
void camber_osm_relations_free(camber_osm_relations *relations);
/* Call this after the last relation was added. */
camber_status camber_osm_relations_complete(camber_osm_relations *relations);
/* Gives relations without tags the tags of their ways. Call this after all ways have been met. */
void camber_osm_relations_settle(camber_osm_relations *relations);
/* Finds the index of a way. Returns false if no relation names it. */
bool camber_osm_relations_find(const camber_osm_relations *relations, int64_t way, camber_osm_search_hint *hint,
                               uint32_t *index);
/* Stores the places of the next way that was met. */
camber_status camber_osm_relations_add_places(camber_osm_relations *relations, size_t met, const uint64_t *places,
                                              uint32_t count);
/* Counts the ways that relations name but that the file does not have, or whose nodes it does not have. */
size_t camber_osm_relations_count_missing(const camber_osm_relations *relations);
/* Returns how many places the ways of a relation have. */
size_t camber_osm_relations_count_places(const camber_osm_relations *relations, size_t relation);
/* Assembles the rings of a relation, which may have none. assembly->open: the file lacks a part of the relation. */
camber_status camber_osm_relations_assemble(const camber_osm_relations *relations, size_t relation,
                                            camber_osm_assembly *assembly);

#endif
