/* Reads the outer layers of a PBF file: blobs with their headers, compressed (codec.h) or not.
 *
 * Input: a path. Output: the list of blobs, and then the block in each blob, which any thread may read. The format is
 * defined at wiki.openstreetmap.org/wiki/PBF_Format. The limits on headers and blobs are the format's own, so a file
 * cannot ask for much memory. Blobs of unknown types are skipped, as the format requires. */
#include "osm/blobs.h"

#include "base/open_file.h"
#include "base/whole_file.h"

#include <stdio.h>

enum { MOST_HEADER_BYTES = 64 << 10, MOST_BLOB_BYTES = 32 << 20 };

/* The field numbers in a blob's header, in a blob, in the file's header and in a block. */
enum { HEADER_TYPE = 1, HEADER_SIZE = 3 };
enum { BLOB_RAW_SIZE = 2 }; /* its other fields are camber_osm_codec values */
enum { FILE_BOX = 1, FILE_REQUIRED_FEATURE = 4 };
enum { BLOCK_STRINGS = 1, BLOCK_GROUP = 2, BLOCK_GRANULARITY = 17, BLOCK_LATITUDE = 19, BLOCK_LONGITUDE = 20 };

/* ---- Bytes of the file ---- */

/* Reads size bytes, or fewer if the file ends before. Returns a negative value if reading fails. */
static ssize_t read_at(int file, uint8_t *bytes, size_t size, uint64_t offset) {
    size_t done;
    return camber_file_read(file, bytes, size, offset, &done) ? -1 : (ssize_t)done;
}

static uint32_t header_size(const uint8_t bytes[4]) {
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

static bool is_text(camber_wire name, const char *text) {
    const size_t length = strlen(text);
    return (size_t)(name.end - name.at) == length && memcmp(name.at, text, length) == 0;
}

typedef enum blob_type {
    BLOB_NONE = 0,
    BLOB_OTHER,
    BLOB_HEADER,
    BLOB_DATA,
} blob_type;

/* Reads a blob's header. Returns false if it is not valid. */
static bool read_header(camber_wire wire, blob_type *type, uint64_t *size) {
    uint64_t key;
    *type = BLOB_NONE;
    *size = UINT64_MAX;
    while (camber_wire_next(&wire, &key)) {
        if (key == CAMBER_WIRE_KEY(HEADER_TYPE, CAMBER_WIRE_BYTES)) {
            const camber_wire name = camber_wire_bytes(&wire);
            *type = is_text(name, "OSMData") ? BLOB_DATA : is_text(name, "OSMHeader") ? BLOB_HEADER : BLOB_OTHER;
        } else if (key == CAMBER_WIRE_KEY(HEADER_SIZE, CAMBER_WIRE_VARINT)) {
            *size = camber_wire_varint(&wire);
        } else {
            camber_wire_skip(&wire, key);
        }
    }
    return !wire.bad && *type != BLOB_NONE;
}

bool camber_osm_knows(const char *path) {
    uint8_t bytes[256];
    struct stat about;
    const int file = camber_open_file(path, &about);
    const ssize_t got = file >= 0 && S_ISREG(about.st_mode) ? read_at(file, bytes, sizeof bytes, 0) : -1;
    if (file >= 0)
        close(file);
    if (got < 16)
        return false;
    const uint32_t size = header_size(bytes);
    blob_type type;
    uint64_t blob_bytes;
    return size <= (size_t)got - 4 &&
           read_header((camber_wire){bytes + 4, bytes + 4 + size, false}, &type, &blob_bytes) && type == BLOB_HEADER;
}

/* ---- Decompression ---- */

/* Finds the block in a blob, and decompresses it if necessary. */
static bool unpack(camber_osm_pass *pass, camber_wire blob, camber_osm_unpacked *unpacked, camber_wire *block,
                   camber_osm_failure *failure) {
    camber_osm_codec codec = CAMBER_OSM_CODEC_NONE;
    camber_wire bytes = {0};
    uint64_t key, size = 0;
    while (camber_wire_next(&blob, &key)) {
        if (key == CAMBER_WIRE_KEY(BLOB_RAW_SIZE, CAMBER_WIRE_VARINT)) {
            size = camber_wire_varint(&blob);
        } else if ((key & 7) == CAMBER_WIRE_BYTES && key >> 3 <= CAMBER_OSM_CODEC_ZSTD) {
            codec = (camber_osm_codec)(key >> 3);
            bytes = camber_wire_bytes(&blob);
        } else {
            camber_wire_skip(&blob, key);
        }
    }
    if (blob.bad)
        return camber_osm_fail(failure, "a blob that does not parse");
    unpacked->codec = codec;
    unpacked->tells_size = size > 0;
    if (codec != CAMBER_OSM_CODEC_RAW)
        return camber_osm_codec_unpack(codec, pass, &bytes, size, &unpacked->plain, block, failure);
    *block = bytes;
    return true;
}

void camber_osm_unpacked_free(camber_context *context, camber_osm_unpacked *unpacked) {
    camber_free(context, unpacked->plain.bytes);
    camber_free(context, unpacked->packed.bytes);
    *unpacked = (camber_osm_unpacked){0};
}

static bool unpack_at(const camber_osm_file *file, const camber_osm_blob *at, camber_osm_pass *pass,
                      camber_osm_unpacked *unpacked, camber_wire *block, camber_osm_failure *failure) {
    if (!camber_osm_reserve(pass, &unpacked->packed, (size_t)at->size_bytes + 1, failure))
        return false;
    uint8_t *bytes = unpacked->packed.bytes;
    const ssize_t got = read_at(file->file, bytes, at->size_bytes, at->offset);
    if (got < 0) {
        failure->status = CAMBER_ERROR_IO;
        snprintf(failure->text, sizeof failure->text, "it cannot be read");
        return false;
    }
    if ((size_t)got < at->size_bytes)
        return camber_osm_fail(failure, "it ends within a blob");
    return unpack(pass, (camber_wire){bytes, bytes + at->size_bytes, false}, unpacked, block, failure);
}

/* ---- Blocks ---- */

bool camber_osm_file_unpack(const camber_osm_file *file, size_t blob, camber_osm_pass *pass,
                            camber_osm_unpacked *unpacked, camber_osm_entities *entities, camber_osm_failure *failure) {
    camber_wire wire = {NULL, NULL, false};
    uint64_t key;
    if (!unpack_at(file, &file->blobs[blob], pass, unpacked, &wire, failure))
        return false;
    *entities = (camber_osm_entities){.groups = wire, .granularity = 100};
    while (camber_wire_next(&wire, &key)) {
        if (key == CAMBER_WIRE_KEY(BLOCK_STRINGS, CAMBER_WIRE_BYTES))
            entities->strings = camber_wire_bytes(&wire);
        else if (key == CAMBER_WIRE_KEY(BLOCK_GRANULARITY, CAMBER_WIRE_VARINT))
            entities->granularity = (int32_t)camber_wire_varint(&wire);
        else if (key == CAMBER_WIRE_KEY(BLOCK_LATITUDE, CAMBER_WIRE_VARINT))
            entities->latitude_offset = (int64_t)camber_wire_varint(&wire);
        else if (key == CAMBER_WIRE_KEY(BLOCK_LONGITUDE, CAMBER_WIRE_VARINT))
            entities->longitude_offset = (int64_t)camber_wire_varint(&wire);
        else
            camber_wire_skip(&wire, key);
    }
    if (wire.bad || entities->granularity <= 0)
        return camber_osm_fail(failure, "a block that does not parse");
    return true;
}

unsigned camber_osm_kind_of(uint64_t key) {
    switch (key) {
    case CAMBER_WIRE_KEY(CAMBER_OSM_NODE, CAMBER_WIRE_BYTES):
    case CAMBER_WIRE_KEY(CAMBER_OSM_DENSE, CAMBER_WIRE_BYTES): return CAMBER_OSM_HAS_NODES;
    case CAMBER_WIRE_KEY(CAMBER_OSM_WAY, CAMBER_WIRE_BYTES): return CAMBER_OSM_HAS_WAYS;
    case CAMBER_WIRE_KEY(CAMBER_OSM_RELATION, CAMBER_WIRE_BYTES): return CAMBER_OSM_HAS_RELATIONS;
    default: return 0;
    }
}

bool camber_osm_entities_next(camber_osm_entities *entities, camber_wire *group) {
    uint64_t key;
    while (camber_wire_next(&entities->groups, &key)) {
        if (key == CAMBER_WIRE_KEY(BLOCK_GROUP, CAMBER_WIRE_BYTES)) {
            *group = camber_wire_bytes(&entities->groups);
            return !entities->groups.bad;
        }
        camber_wire_skip(&entities->groups, key);
    }
    return false;
}

/* ---- The list of blobs ---- */

/* Reads the bounding box in a file's header: west, east, north and south in nanodegrees, which are converted to 10^-7
 * degrees. */
static void read_box(camber_wire wire, camber_osm_box *box) {
    int64_t sides[4] = {0};
    uint64_t key;
    while (camber_wire_next(&wire, &key)) {
        if (key >= CAMBER_WIRE_KEY(1, CAMBER_WIRE_VARINT) && key <= CAMBER_WIRE_KEY(4, CAMBER_WIRE_VARINT) &&
            (key & 7) == CAMBER_WIRE_VARINT) {
            const int64_t side = camber_wire_signed(&wire) / 100, most = INT64_C(1800000000);
            sides[(key >> 3) - 1] = side < -most ? -most : side > most ? most : side;
        } else {
            camber_wire_skip(&wire, key);
        }
    }
    if (!wire.bad)
        *box = (camber_osm_box){(int32_t)sides[0], (int32_t)sides[1], (int32_t)sides[3], (int32_t)sides[2]};
}

/* Whether this reader supports all features that the file's header requires. */
static bool read_file_header(camber_wire wire, camber_osm_box *box, camber_osm_failure *failure) {
    uint64_t key;
    while (camber_wire_next(&wire, &key)) {
        if (key == CAMBER_WIRE_KEY(FILE_BOX, CAMBER_WIRE_BYTES)) {
            read_box(camber_wire_bytes(&wire), box);
            continue;
        }
        if (key != CAMBER_WIRE_KEY(FILE_REQUIRED_FEATURE, CAMBER_WIRE_BYTES)) {
            camber_wire_skip(&wire, key);
            continue;
        }
        const camber_wire name = camber_wire_bytes(&wire);
        if (is_text(name, "HistoricalInformation"))
            return camber_osm_refuse(failure, "a history file, which has every version of each node and way; make a "
                                              "map from it with osmium time-filter");
        if (!wire.bad && !is_text(name, "OsmSchema-V0.6") && !is_text(name, "DenseNodes"))
            return camber_osm_decline(failure);
    }
    return !wire.bad || camber_osm_fail(failure, "a header that does not parse");
}

typedef struct listing {
    camber_osm_file *file;
    camber_osm_unpacked unpacked;
    uint64_t at;
    size_t passed_over;
} listing;

/* Reads the blob header at the current position, and moves past the blob. Returns false at the end of the file, or if
 * it sets *failure. */
static bool list_blob(listing *list, camber_osm_pass *pass, camber_osm_failure *failure) {
    camber_osm_file *file = list->file;
    uint8_t bytes[MOST_HEADER_BYTES];
    enum { USUAL_HEADER_BYTES = 64 };
    ssize_t got = read_at(file->file, bytes, USUAL_HEADER_BYTES, list->at);
    const uint32_t size = got >= 4 ? header_size(bytes) : 0;
    if (got < 4 || size > MOST_HEADER_BYTES - 4)
        return camber_osm_fail(failure,
                               got < 4 ? "it ends within a blob's header" : "a blob's header that is not valid");
    if (size > USUAL_HEADER_BYTES - 4)
        got = read_at(file->file, bytes, size + 4, list->at);
    blob_type type;
    uint64_t blob_bytes;
    if (got < 0 || (size_t)got < size + 4)
        return camber_osm_fail(failure, "it ends within a blob's header");
    if (!read_header((camber_wire){bytes + 4, bytes + 4 + size, false}, &type, &blob_bytes))
        return camber_osm_fail(failure, "a blob's header that is not valid");
    if (blob_bytes > MOST_BLOB_BYTES)
        return camber_osm_fail(failure, "a blob of more than 32 MiB");
    const camber_osm_blob blob = {.offset = list->at + 4 + size, .size_bytes = (uint32_t)blob_bytes};
    if (blob.offset + blob_bytes > file->size_bytes)
        return camber_osm_fail(failure, "it ends within a blob");
    list->at = blob.offset + blob_bytes;
    if (type == BLOB_OTHER) {
        list->passed_over++;
        return true;
    }
    if (type == BLOB_HEADER) {
        camber_wire block;
        return unpack_at(file, &blob, pass, &list->unpacked, &block, failure) &&
               read_file_header(block, &file->box, failure);
    }
    camber_osm_block blobs = {(uint8_t *)file->blobs, file->blob_capacity};
    const bool fits = camber_osm_reserve(pass, &blobs, (file->blob_count + 1) * sizeof blob, failure);
    file->blobs = (camber_osm_blob *)(void *)blobs.bytes;
    file->blob_capacity = blobs.capacity;
    if (fits)
        file->blobs[file->blob_count++] = blob;
    return fits;
}

static bool list_blobs(void *user, camber_osm_pass *pass, size_t part, void *slot, camber_osm_failure *failure) {
    listing *list = user;
    (void)part;
    (void)slot;
    while (list->at < list->file->size_bytes)
        if (!list_blob(list, pass, failure))
            return false;
    return true;
}

static void free_nothing(camber_context *context, void *slot) {
    (void)context;
    (void)slot;
}

camber_status camber_osm_file_open(camber_context *context, const char *path, camber_osm_file *file, bool *declined) {
    camber_osm_file made = {.context = context, .path = path, .file = -1};
    listing list = {.file = &made};
    camber_status status = camber_file_open(context, path, CAMBER_NAMED_BY_CALLER, &made.file, &made.size_bytes);
    if (status != CAMBER_OK)
        return status;
    const camber_osm_pass_desc desc = {.context = context,
                                       .name = path,
                                       .part_count = 1,
                                       .threads = 1,
                                       .slot_bytes = 1,
                                       .user = &list,
                                       .work = list_blobs,
                                       .free_slot = free_nothing};
    status = camber_osm_pass_run(&desc, declined);
    camber_osm_unpacked_free(context, &list.unpacked);
    if (status == CAMBER_OK && list.passed_over)
        camber_log(context, CAMBER_LOG_INFO, "%s: skipped %zu blobs of types that the format does not have", path,
                   list.passed_over);
    if (status != CAMBER_OK || *declined)
        camber_osm_file_close(&made);
    else
        *file = made;
    return status;
}

void camber_osm_file_close(camber_osm_file *file) {
    if (file->file >= 0)
        close(file->file);
    camber_free(file->context, file->blobs);
    file->blobs = NULL;
    file->file = -1;
}
