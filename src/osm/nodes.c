/* Reads the places of nodes.
 *
 * Input: blobs, and the set of nodes that lines need. Output: their places, as the same integers in 10^-7 degrees that
 * GDAL's reader uses. Places may instead be stored in ways (osmium add-locations-to-ways); then a node has a place in
 * each way that names it. Threads store places as they find them, so the choice among several places must not depend on
 * the order. */
#include "osm/nodes.h"

#include <math.h>

enum { NODE_ID = 1, NODE_LATITUDE = 8, NODE_LONGITUDE = 9 };
enum { DENSE_IDS = 1, DENSE_LATITUDES = 8, DENSE_LONGITUDES = 9 };
enum { WAY_NODES = 8, WAY_LATITUDES = 9, WAY_LONGITUDES = 10 };
enum { USUAL_GRANULARITY = 100 };

typedef struct block {
    camber_osm_unpacked unpacked;
    size_t found_count; /* nodes that were given a place */
} block;

static void free_block(camber_context *context, void *slot) {
    camber_osm_unpacked_free(context, &((block *)slot)->unpacked);
}

typedef struct decoder {
    camber_osm_node_set *nodes;
    camber_osm_entities entities;
    camber_osm_search_hint hint;
    camber_osm_failure *failure;
    size_t found_count;
    bool usual;   /* coordinates are already in 10^-7 degrees */
    bool several; /* a node may have several places */
} decoder;

/* Computes degrees as GDAL does, and then rounds them. Returns false if they are not on Earth. */
static bool to_place(int64_t coordinate, int64_t offset, int32_t granularity, double most, int32_t *place) {
    const double degrees = .000000001 * ((double)offset + (double)granularity * (double)coordinate);
    if (!(fabs(degrees) <= most))
        return false;
    *place = (int32_t)floor(degrees * 1.0e7 + 0.5);
    return true;
}

/* Converts coordinates of the block to a place. Returns false if they are not on Earth. */
static bool find_place(const decoder *self, int64_t longitude, int64_t latitude, uint64_t *place) {
    enum { DEGREE = 10000000 };
    const camber_osm_entities *from = &self->entities;
    int32_t x = (int32_t)longitude, y = (int32_t)latitude;
    /* Exactly at the limits, rounding decides. */
    const bool inside = longitude > -INT64_C(180) * DEGREE && longitude < INT64_C(180) * DEGREE &&
                        latitude > -INT64_C(90) * DEGREE && latitude < INT64_C(90) * DEGREE;
    if (!(self->usual && inside) && !(to_place(longitude, from->longitude_offset, from->granularity, 180.0, &x) &&
                                      to_place(latitude, from->latitude_offset, from->granularity, 90.0, &y)))
        return false;
    *place = camber_osm_place(x, y);
    return true;
}

/* Sets the place of a node, if a line needs it. */
static bool set_place(decoder *self, int64_t id, uint64_t place) {
    uint32_t index;
    uint64_t before = CAMBER_OSM_NOWHERE;
    if (id < 0 || id >= CAMBER_OSM_MOST_ID || !camber_osm_node_set_find(self->nodes, id, &self->hint, &index))
        return true;
    _Atomic uint64_t *to = &self->nodes->places[index];
    if (atomic_compare_exchange_strong_explicit(to, &before, place, memory_order_relaxed, memory_order_relaxed)) {
        self->found_count++;
        return true;
    }
    if (before != place && !self->several)
        return camber_osm_decline(self->failure);
    while ((int64_t)before < (int64_t)place &&
           !atomic_compare_exchange_weak_explicit(to, &before, place, memory_order_relaxed, memory_order_relaxed)) {
    }
    return true;
}

static bool add_node(decoder *self, int64_t id, int64_t longitude, int64_t latitude) {
    uint64_t place;
    if (!find_place(self, longitude, latitude, &place))
        return camber_osm_fail(self->failure, "a node that is not on Earth");
    return set_place(self, id, place);
}

static bool read_node(decoder *self, camber_wire wire) {
    uint64_t key;
    int64_t id = 0, longitude = 0, latitude = 0;
    while (camber_wire_next(&wire, &key)) {
        if (key == CAMBER_WIRE_KEY(NODE_ID, CAMBER_WIRE_VARINT))
            id = camber_wire_signed(&wire);
        else if (key == CAMBER_WIRE_KEY(NODE_LATITUDE, CAMBER_WIRE_VARINT))
            latitude = camber_wire_signed(&wire);
        else if (key == CAMBER_WIRE_KEY(NODE_LONGITUDE, CAMBER_WIRE_VARINT))
            longitude = camber_wire_signed(&wire);
        else
            camber_wire_skip(&wire, key);
    }
    if (wire.bad)
        return camber_osm_fail(self->failure, "a node that does not parse");
    return add_node(self, id, longitude, latitude);
}

static bool read_dense(decoder *self, camber_wire wire) {
    camber_wire ids = {0}, longitudes = {0}, latitudes = {0};
    uint64_t key, id = 0, longitude = 0, latitude = 0;
    while (camber_wire_next(&wire, &key)) {
        if (key == CAMBER_WIRE_KEY(DENSE_IDS, CAMBER_WIRE_BYTES))
            ids = camber_wire_bytes(&wire);
        else if (key == CAMBER_WIRE_KEY(DENSE_LATITUDES, CAMBER_WIRE_BYTES))
            latitudes = camber_wire_bytes(&wire);
        else if (key == CAMBER_WIRE_KEY(DENSE_LONGITUDES, CAMBER_WIRE_BYTES))
            longitudes = camber_wire_bytes(&wire);
        else
            camber_wire_skip(&wire, key);
    }
    /* Differences are added as unsigned numbers, which may wrap around. */
    while (ids.at < ids.end) {
        id += (uint64_t)camber_wire_signed(&ids);
        latitude += (uint64_t)camber_wire_signed(&latitudes);
        longitude += (uint64_t)camber_wire_signed(&longitudes);
        if (ids.bad || latitudes.bad || longitudes.bad)
            break;
        if (!add_node(self, (int64_t)id, (int64_t)longitude, (int64_t)latitude))
            return false;
    }
    return !(wire.bad || ids.bad || latitudes.bad || longitudes.bad) ||
           camber_osm_fail(self->failure, "nodes that do not parse");
}

/* Reads the places that are stored in a way. Places that are not on Earth count as missing, because osmium writes such
 * a place for a missing node. */
static bool read_way(decoder *self, camber_wire wire) {
    camber_wire ids = {0}, longitudes = {0}, latitudes = {0};
    uint64_t key, place, id = 0, longitude = 0, latitude = 0;
    while (camber_wire_next(&wire, &key)) {
        if (key == CAMBER_WIRE_KEY(WAY_NODES, CAMBER_WIRE_BYTES))
            ids = camber_wire_bytes(&wire);
        else if (key == CAMBER_WIRE_KEY(WAY_LATITUDES, CAMBER_WIRE_BYTES))
            latitudes = camber_wire_bytes(&wire);
        else if (key == CAMBER_WIRE_KEY(WAY_LONGITUDES, CAMBER_WIRE_BYTES))
            longitudes = camber_wire_bytes(&wire);
        else
            camber_wire_skip(&wire, key);
    }
    while (ids.at < ids.end && longitudes.at < longitudes.end && latitudes.at < latitudes.end) {
        id += (uint64_t)camber_wire_signed(&ids);
        latitude += (uint64_t)camber_wire_signed(&latitudes);
        longitude += (uint64_t)camber_wire_signed(&longitudes);
        if (ids.bad || latitudes.bad || longitudes.bad)
            break;
        if (find_place(self, (int64_t)longitude, (int64_t)latitude, &place) && !set_place(self, (int64_t)id, place))
            return false;
    }
    return !(wire.bad || ids.bad || latitudes.bad || longitudes.bad) ||
           camber_osm_fail(self->failure, "a way that does not parse");
}

/* Reads a group. nodes_alone: the blob should have only nodes, so a way (or a relation, if relations are wanted) means
 * that the file is not in order. */
static bool read_group(decoder *self, camber_wire group, const camber_osm_nodes_desc *desc, bool nodes_alone) {
    uint64_t key;
    bool read = true;
    while (read && camber_wire_next(&group, &key)) {
        if (key == CAMBER_WIRE_KEY(CAMBER_OSM_DENSE, CAMBER_WIRE_BYTES))
            read = read_dense(self, camber_wire_bytes(&group));
        else if (key == CAMBER_WIRE_KEY(CAMBER_OSM_NODE, CAMBER_WIRE_BYTES))
            read = read_node(self, camber_wire_bytes(&group));
        else if (nodes_alone && (key == CAMBER_WIRE_KEY(CAMBER_OSM_WAY, CAMBER_WIRE_BYTES) ||
                                 (key == CAMBER_WIRE_KEY(CAMBER_OSM_RELATION, CAMBER_WIRE_BYTES) && desc->relations)))
            return camber_osm_decline(self->failure);
        else if (key == CAMBER_WIRE_KEY(CAMBER_OSM_WAY, CAMBER_WIRE_BYTES) && desc->on_ways)
            read = read_way(self, camber_wire_bytes(&group));
        else
            camber_wire_skip(&group, key);
    }
    return read && (!group.bad || camber_osm_fail(self->failure, "a group that does not parse"));
}

typedef struct reading {
    camber_osm_node_set *nodes;
    const camber_osm_nodes_desc *desc;
} reading;

static bool read_block(void *user, camber_osm_pass *pass, size_t part, void *slot, camber_osm_failure *failure) {
    const reading *all = user;
    const camber_osm_nodes_desc *desc = all->desc;
    decoder self = {.nodes = all->nodes,
                    .hint = {.leaf_id = UINT64_MAX, .id = -2},
                    .failure = failure,
                    .several = desc->node_blobs == 0 || desc->on_ways};
    camber_osm_entities *entities = &self.entities;
    camber_wire group;
    if (!camber_osm_file_unpack(desc->file, part, pass, &((block *)slot)->unpacked, entities, failure))
        return false;
    self.usual =
        entities->granularity == USUAL_GRANULARITY && entities->longitude_offset == 0 && entities->latitude_offset == 0;
    while (camber_osm_entities_next(entities, &group))
        if (!read_group(&self, group, desc, part + 1 < desc->node_blobs))
            return false;
    ((block *)slot)->found_count = self.found_count;
    return !entities->groups.bad || camber_osm_fail(failure, "a block that does not parse");
}

static camber_status add_block(void *user, size_t part, void *slot) {
    (void)part;
    ((const reading *)user)->nodes->found_count += ((const block *)slot)->found_count;
    return CAMBER_OK;
}

camber_status camber_osm_nodes_read(camber_osm_node_set *nodes, const camber_osm_nodes_desc *desc, bool *declined) {
    reading all = {nodes, desc};
    const camber_osm_pass_desc pass = {.context = nodes->context,
                                       .name = desc->file->path,
                                       .part_count = desc->blob_count,
                                       .threads = desc->threads,
                                       .slot_bytes = sizeof(block),
                                       .user = &all,
                                       .work = read_block,
                                       .commit = add_block,
                                       .free_slot = free_block,
                                       .from = desc->from,
                                       .to = desc->to};
    return camber_osm_pass_run(&pass, declined);
}

/* ---- Where nodes and ways end ---- */

typedef struct search {
    camber_osm_file *file;
    camber_osm_ends *ends;
    bool of_ways;
} search;

/* Records which kinds of entities a blob has, so that later passes need not decompress it for kinds that it does not
 * have. */
static bool look_at_blob(const search *self, size_t blob, camber_osm_pass *pass, block *one,
                         camber_osm_failure *failure) {
    camber_osm_blob *to = &self->file->blobs[blob];
    camber_osm_entities entities;
    camber_wire group;
    uint64_t key;
    unsigned kinds = CAMBER_OSM_LOOKED_AT, first = 0;
    if (!camber_osm_file_unpack(self->file, blob, pass, &one->unpacked, &entities, failure))
        return false;
    while (camber_osm_entities_next(&entities, &group)) {
        while (camber_wire_next(&group, &key)) {
            const unsigned kind = camber_osm_kind_of(key);
            first = first ? first : kind;
            kinds |= kind;
            camber_wire_skip(&group, key);
        }
        if (group.bad)
            return camber_osm_fail(failure, "a group that does not parse");
    }
    to->kinds = (uint8_t)kinds;
    to->first = (uint8_t)first;
    return !entities.groups.bad || camber_osm_fail(failure, "a block that does not parse");
}

/* Finds the first blob that begins with a kind after last_kind. Starts at a guess, searches in growing steps until that
 * blob is between two examined ones, and then bisects. A blob without entities may count as any kind. */
static bool find_end(const search *self, unsigned last_kind, size_t at, size_t *first, camber_osm_pass *pass,
                     block *one, camber_osm_failure *failure) {
    size_t end = self->file->blob_count, step = 1;
    bool begins, before = false, turned = false;
    *first = 0;
    for (bool looked = false; *first < end; looked = true) {
        if (!self->file->blobs[at].kinds && !look_at_blob(self, at, pass, one, failure))
            return false;
        begins = self->file->blobs[at].first <= last_kind;
        turned = turned || (looked && begins != before);
        before = begins;
        *(begins ? first : &end) = at + begins;
        turned = turned || step >= end - *first;
        at = turned ? *first + (end - *first) / 2 : begins ? *first + step - 1 : end - step;
        step *= 2;
    }
    return true;
}

static bool search_blobs(void *user, camber_osm_pass *pass, size_t part, void *slot, camber_osm_failure *failure) {
    const search *self = user;
    const size_t count = self->file->blob_count;
    (void)part;
    /* The guesses: in most files, six of seven blobs have nodes, and the last few have relations. */
    return find_end(self, CAMBER_OSM_HAS_NODES, count / 7 * 6 + count % 7 * 6 / 7, &self->ends->nodes, pass, slot,
                    failure) &&
           (!self->of_ways || count == 0 ||
            find_end(self, CAMBER_OSM_HAS_WAYS, count - 1, &self->ends->ways, pass, slot, failure));
}

camber_status camber_osm_find_ends(camber_osm_file *file, bool of_ways, camber_osm_ends *ends, bool *declined) {
    search self = {.file = file, .ends = ends, .of_ways = of_ways};
    const camber_osm_pass_desc pass = {.context = file->context,
                                       .name = file->path,
                                       .part_count = 1,
                                       .threads = 1,
                                       .slot_bytes = sizeof(block),
                                       .user = &self,
                                       .work = search_blobs,
                                       .free_slot = free_block};
    *ends = (camber_osm_ends){0, 0};
    return camber_osm_pass_run(&pass, declined);
}
