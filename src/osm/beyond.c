/* Finds out whether GDAL would silently skip parts of a PBF.
 *
 * Input: a file that is to be left to GDAL. Output: the reasons why GDAL would misread it. GDAL 3.6 silently skips
 * blobs that are not compressed with zlib, ways whose nodes come after them, and places that are stored in ways. */
#include "osm/beyond.h"

enum { WAY_LATITUDES = 9 };

typedef struct block {
    camber_osm_unpacked unpacked;
    unsigned first, last; /* kinds of entities; in an ordered file they only increase */
    bool has_any;
    camber_osm_beyond beyond;
} block;

static void free_block(camber_context *context, void *slot) {
    camber_osm_unpacked_free(context, &((block *)slot)->unpacked);
}

static bool has_places(camber_wire way) {
    uint64_t key;
    while (camber_wire_next(&way, &key)) {
        if (key == CAMBER_WIRE_KEY(WAY_LATITUDES, CAMBER_WIRE_BYTES))
            return true;
        camber_wire_skip(&way, key);
    }
    return false;
}

static void look_at_group(block *to, camber_wire group) {
    uint64_t key;
    while (camber_wire_next(&group, &key)) {
        const unsigned kind = camber_osm_kind_of(key);
        if (!kind) {
            camber_wire_skip(&group, key);
            continue;
        }
        const camber_wire entity = camber_wire_bytes(&group);
        to->first = to->has_any ? to->first : kind;
        to->beyond.unordered = to->beyond.unordered || (to->has_any && kind < to->last);
        to->last = kind;
        to->has_any = true;
        if (kind == CAMBER_OSM_HAS_WAYS && !to->beyond.on_ways)
            to->beyond.on_ways = has_places(entity);
    }
}

typedef struct looking {
    const camber_osm_file *file;
    camber_osm_beyond *beyond;
    unsigned last; /* the kind of the last entity so far */
} looking;

static bool look_at_block(void *user, camber_osm_pass *pass, size_t part, void *slot, camber_osm_failure *failure) {
    block *to = slot;
    camber_osm_entities entities;
    camber_wire group;
    to->has_any = false;
    to->beyond = (camber_osm_beyond){.unordered = false};
    if (!camber_osm_file_unpack(((const looking *)user)->file, part, pass, &to->unpacked, &entities, failure))
        return false;
    if (to->unpacked.codec != CAMBER_OSM_CODEC_RAW && to->unpacked.codec != CAMBER_OSM_CODEC_ZLIB)
        to->beyond.codec = to->unpacked.codec;
    to->beyond.no_size = to->unpacked.codec != CAMBER_OSM_CODEC_RAW && !to->unpacked.tells_size;
    while (camber_osm_entities_next(&entities, &group))
        look_at_group(to, group);
    return true;
}

static camber_status add_block(void *user, size_t part, void *slot) {
    looking *all = user;
    const block *from = slot;
    camber_osm_beyond *beyond = all->beyond;
    (void)part;
    beyond->codec = beyond->codec ? beyond->codec : from->beyond.codec;
    beyond->no_size = beyond->no_size || from->beyond.no_size;
    beyond->on_ways = beyond->on_ways || from->beyond.on_ways;
    beyond->unordered = beyond->unordered || from->beyond.unordered || (from->has_any && from->first < all->last);
    all->last = from->has_any ? from->last : all->last;
    return CAMBER_OK;
}

camber_status camber_osm_find_beyond(const camber_osm_file *file, unsigned threads, camber_osm_beyond *beyond) {
    looking all = {.file = file, .beyond = beyond};
    const camber_osm_pass_desc pass = {.context = file->context,
                                       .name = file->path,
                                       .part_count = file->blob_count,
                                       .threads = threads,
                                       .slot_bytes = sizeof(block),
                                       .user = &all,
                                       .work = look_at_block,
                                       .commit = add_block,
                                       .free_slot = free_block};
    bool declined;
    *beyond = (camber_osm_beyond){.unordered = false};
    return camber_osm_pass_run(&pass, &declined);
}

bool camber_osm_is_beyond(const camber_osm_beyond *beyond) {
    return beyond->codec || beyond->no_size || beyond->on_ways || beyond->unordered;
}
