/* A PBF file of OpenStreetMap: where its blobs lie, and the content of one. */
#ifndef CAMBER_OSM_BLOBS_H
#define CAMBER_OSM_BLOBS_H

#include "osm/codec.h"

/* The kinds of entities that a blob has, once it was looked at. */
enum {
    CAMBER_OSM_HAS_NODES = 1,
    CAMBER_OSM_HAS_WAYS = 2,
    CAMBER_OSM_HAS_RELATIONS = 4,
    CAMBER_OSM_LOOKED_AT = 8,
};

typedef struct camber_osm_blob {
    uint64_t offset;
    uint32_t size_bytes;
    uint8_t kinds; /* bits; 0: nobody has looked */
    uint8_t first; /* the bit of the first entity; 0: there is none */
} camber_osm_blob;

/* 10^-7 degrees. left is not below right: there is none. */
typedef struct camber_osm_box {
    int32_t left, right, bottom, top;
} camber_osm_box;

typedef struct camber_osm_file {
    camber_context *context;
    const char *path;
    int file;
    uint64_t size_bytes;
    camber_osm_blob *blobs; /* those with data, in the file's order */
    size_t blob_count, blob_capacity;
    camber_osm_box box; /* that the file has the data of, as its header says */
} camber_osm_file;

/* Whether the file begins as a PBF of OpenStreetMap; what it is named does not matter. */
bool camber_osm_knows(const char *path);

/* Opens a file and finds its blobs. *declined: it wants what this reader does not have, and nothing is logged. */
camber_status camber_osm_file_open(camber_context *context, const char *path, camber_osm_file *file, bool *declined);
void camber_osm_file_close(camber_osm_file *file);

/* A blob as it is in the file, and unpacked. */
typedef struct camber_osm_unpacked {
    camber_osm_block packed, plain;
    camber_osm_codec codec;
    bool tells_size; /* how large it is unpacked */
} camber_osm_unpacked;

void camber_osm_unpacked_free(camber_context *context, camber_osm_unpacked *unpacked);

/* A block of nodes, ways and relations. */
typedef struct camber_osm_entities {
    camber_wire strings; /* the table of strings */
    camber_wire groups;  /* the whole block again, for its groups */
    int32_t granularity; /* coordinates are this many 10^-9 degrees */
    int64_t longitude_offset, latitude_offset;
} camber_osm_entities;

/* Reads and unpacks a blob. The entities lie in what is unpacked. */
bool camber_osm_file_unpack(const camber_osm_file *file, size_t blob, camber_osm_pass *pass,
                            camber_osm_unpacked *unpacked, camber_osm_entities *entities, camber_osm_failure *failure);
/* The bit of a kind of entities, by its key in a group; 0: it is none. */
unsigned camber_osm_kind_of(uint64_t key);
/* The next group of entities. false: there is none, or the block is bad (groups.bad). */
bool camber_osm_entities_next(camber_osm_entities *entities, camber_wire *group);

/* Fields of a group: the kinds of entities. */
enum { CAMBER_OSM_NODE = 1, CAMBER_OSM_DENSE = 2, CAMBER_OSM_WAY = 3, CAMBER_OSM_RELATION = 4 };

#endif
