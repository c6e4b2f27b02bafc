/* The ways in which a PBF's blobs may be packed, and what unpacks them in this build. */
#ifndef CAMBER_OSM_CODEC_H
#define CAMBER_OSM_CODEC_H

#include "osm/pass.h"
#include "osm/wire.h"

/* The values are the fields of a blob that have its bytes. */
typedef enum camber_osm_codec {
    CAMBER_OSM_CODEC_NONE = 0, /* the blob has no bytes */
    CAMBER_OSM_CODEC_RAW = 1,
    CAMBER_OSM_CODEC_ZLIB = 3,
    CAMBER_OSM_CODEC_LZMA = 4,
    CAMBER_OSM_CODEC_BZIP2 = 5, /* the format has given it up */
    CAMBER_OSM_CODEC_LZ4 = 6,
    CAMBER_OSM_CODEC_ZSTD = 7,
} camber_osm_codec;

/* "lz4"; "" for one that no blob is packed by. */
const char *camber_osm_codec_get_name(camber_osm_codec codec);

/* Unpacks at most most_bytes into the block. size_bytes: how many they are, as the blob says; 0: it does not.
 * *plain: the result. Fails on bytes that are damaged, and on a codec that the build lacks. */
bool camber_osm_codec_unpack(camber_osm_codec codec, camber_osm_pass *pass, const camber_wire *packed,
                             uint64_t size_bytes, camber_osm_block *block, camber_wire *plain,
                             camber_osm_failure *failure);

#endif
