/* A PBF file of OpenStreetMap: the list of its blobs, and the content of each. */
#ifndef CAMBER_OSM_BLOBS_H
#define CAMBER_OSM_BLOBS_H

#include "osm/codec.h"

/* Bits for the kinds of entities in a blob that has been examined. */
enum {
    CAMBER_OSM_HAS_NODES = 1,
    CAMBER_OSM_HAS_WAYS = 2,
    CAMBER_OSM_HAS_RELATIONS = 4,
    CAMBER_OSM_LOOKED_AT = 8,
};

typedef struct camber_osm_blob {
    uint64_t offset;
    uint32_t size_bytes;
    uint8_t kinds; /* bits; 0: not examined yet */
    uint8_t first; /* the bit of the first entity; 0: there is none */
} camber_osm_blob;

/* In 10^-7 degrees. If left is not less than right, there is no box. */
typedef struct camber_osm_box {
    int32_t left, right, bottom, top;
} camber_osm_box;

typedef struct camber_osm_file {
    camber_context *context;
    const char *path;
    int file;
    uint64_t size_bytes;
    camber_osm_blob *blobs; /* the blobs with data, in the order of the file */
    size_t blob_count, blob_capacity;
    camber_osm_box box; /* the box that the file covers, according to its header */
} camber_osm_file;

/* Whether the file begins like a PBF of OpenStreetMap. Its name does not matter. */
bool camber_osm_knows(const char *path);

/* Opens a file and finds its blobs. *declined: the file requires features that this reader does not support; then
 * nothing is logged. */
camber_status camber_osm_file_open(camber_context *context, const char *path, camber_osm_file *file, bool *declined);
void camber_osm_file_close(camber_osm_file *file);

/* A blob as stored in the file, and decompressed. */
typedef struct camber_osm_unpacked {
    camber_osm_block packed, plain;
    camber_osm_codec codec;
    bool tells_size; /* the blob states its uncompressed size */
} camber_osm_unpacked;

void camber_osm_unpacked_free(camber_context *context, camber_osm_unpacked *unpacked);

/* A block of nodes, ways and relations. */
typedef struct camber_osm_entities {
    camber_wire strings; /* the table of strings */
    camber_wire groups;  /* the whole block, for iterating over its groups */
    int32_t granularity; /* the unit of coordinates, in 10^-9 degrees */
    int64_t longitude_offset, latitude_offset;
} camber_osm_entities;

/* Reads and decompresses a blob. The entities point into the decompressed bytes. */
bool camber_osm_file_unpack(const camber_osm_file *file, size_t blob, camber_osm_pass *pass,
                            camber_osm_unpacked *unpacked, camber_osm_entities *entities, camber_osm_failure *failure);
/* Returns the bit for the kind of entities in the field of a group that has this key, or 0 if it has none. */
unsigned camber_osm_kind_of(uint64_t key);
/* Gets the next group of entities. Returns false if there is none, or if the block is damaged (groups.bad). */
bool camber_osm_entities_next(camber_osm_entities *entities, camber_wire *group);

/* The fields of a group. Each contains entities of one kind. */
enum { CAMBER_OSM_NODE = 1, CAMBER_OSM_DENSE = 2, CAMBER_OSM_WAY = 3, CAMBER_OSM_RELATION = 4 };

#endif
