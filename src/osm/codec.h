/* The codecs with which blobs of a PBF may be compressed, and their decompression. */
#ifndef CAMBER_OSM_CODEC_H
#define CAMBER_OSM_CODEC_H

#include "osm/pass.h"
#include "osm/wire.h"

/* The values are the numbers of the blob's fields that contain the bytes. */
typedef enum camber_osm_codec {
    CAMBER_OSM_CODEC_NONE = 0, /* the blob has no bytes */
    CAMBER_OSM_CODEC_RAW = 1,
    CAMBER_OSM_CODEC_ZLIB = 3,
    CAMBER_OSM_CODEC_LZMA = 4,
    CAMBER_OSM_CODEC_BZIP2 = 5, /* obsolete in the format */
    CAMBER_OSM_CODEC_LZ4 = 6,
    CAMBER_OSM_CODEC_ZSTD = 7,
} camber_osm_codec;

/* Returns a name such as "lz4", or "" if the value is not a blob codec. */
const char *camber_osm_codec_get_name(camber_osm_codec codec);

/* Decompresses at most most_bytes into the block. size_bytes: the size that the blob states; 0: it states none. *plain:
 * the result. Fails on damaged bytes, and on a codec that is not in this build. */
bool camber_osm_codec_unpack(camber_osm_codec codec, camber_osm_pass *pass, const camber_wire *packed,
                             uint64_t size_bytes, camber_osm_block *block, camber_wire *plain,
                             camber_osm_failure *failure);

#endif
