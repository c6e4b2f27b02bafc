/* Packs ways: each node by how far it lies from the one before.
 *
 * Input: ways with ids of nodes, and the places of these. Output: the ways' places one after the other, and the memory
 * of ids and nodes. Main idea: lines in world coordinates take 16 bytes a point, and the nodes 8 and more. They would
 * be in memory together if lines were made at once. Packed lines take a quarter, for nodes of a way lie close together.
 */
#include "osm/packed.h"

/* The most that a place takes: differences have 33 bits and a sign, seven bits a byte. */
enum { MOST_PLACE_BYTES = 2 * 5 };

typedef struct packed_run {
    camber_osm_block bytes, ways; /* ways: camber_osm_way, as they will be */
    size_t size_bytes, node_count, dropped;
} packed_run;

static void free_run(camber_context *context, void *slot) {
    packed_run *run = slot;
    camber_free(context, run->ways.bytes);
    camber_free(context, run->bytes.bytes);
}

typedef struct packing {
    camber_osm_ways *ways;
    const camber_osm_pack_desc *desc;
    size_t dropped;
} packing;

/* Where a thread is in its run. */
typedef struct packer {
    camber_wire ids;
    camber_osm_finger finger;
    uint8_t *at;
    int32_t longitude, latitude;
} packer;

static void put_place(packer *to, uint64_t place) {
    const int32_t longitude = (int32_t)(uint32_t)(place >> 32), latitude = (int32_t)(uint32_t)place;
    to->at = camber_wire_put_signed(to->at, (int64_t)longitude - to->longitude);
    to->at = camber_wire_put_signed(to->at, (int64_t)latitude - to->latitude);
    to->longitude = longitude;
    to->latitude = latitude;
}

/* Packs a way, and returns what it is now. Fewer than two nodes make no line. *dropped counts areas that go. */
static camber_osm_way pack_way(const packing *all, const camber_osm_way *way, packer *to, size_t *dropped) {
    const camber_osm_node_set *nodes = &all->ways->nodes;
    const packer before = *to;
    uint64_t id = 0, first = 0, last = 0;
    uint32_t found = 0;
    for (uint32_t i = 0; i < way->node_count; i++) {
        uint32_t index;
        id += (uint64_t)camber_wire_signed(&to->ids);
        if (!camber_osm_node_set_find(nodes, (int64_t)id, &to->finger, &index))
            continue;
        const uint64_t place = atomic_load_explicit(&nodes->places[index], memory_order_relaxed);
        if (place == CAMBER_OSM_NOWHERE)
            continue;
        first = found++ ? first : place;
        last = place;
        put_place(to, place);
    }
    const bool area = (way->tags & CAMBER_OSM_WAY_AREA) && found > 3 && first == last;
    const bool drops = area && all->desc->drops_areas;
    *dropped += drops;
    if (drops || found < 2) {
        to->at = before.at;
        to->longitude = before.longitude;
        to->latitude = before.latitude;
        found = 0;
    }
    return (camber_osm_way){way->tags & ~(area ? 0u : (uint32_t)CAMBER_OSM_WAY_AREA), found};
}

static bool pack_run(void *user, camber_osm_pass *pass, size_t part, void *slot, camber_osm_failure *failure) {
    const packing *all = user;
    const camber_osm_ways *ways = all->ways;
    const camber_osm_run *from = &ways->runs[part];
    packed_run *run = slot;
    if (!camber_osm_reserve(pass, &run->bytes, from->node_count * MOST_PLACE_BYTES, failure) ||
        !camber_osm_reserve(pass, &run->ways, from->way_count * sizeof(camber_osm_way), failure))
        return false;
    packer to = {.ids = {ways->ids + from->first_id, ways->ids + ways->id_bytes, false},
                 .finger = {.leaf_id = UINT64_MAX, .id = -2},
                 .at = run->bytes.bytes};
    camber_osm_way *packed = (camber_osm_way *)(void *)run->ways.bytes;
    run->node_count = run->dropped = 0;
    for (size_t i = 0; i < from->way_count; i++) {
        packed[i] = pack_way(all, &ways->ways[from->first_way + i], &to, &run->dropped);
        run->node_count += packed[i].node_count;
    }
    run->size_bytes = (size_t)(to.at - run->bytes.bytes);
    return true;
}

/* No thread reads the run any more. */
static camber_status add_run(void *user, size_t part, void *slot) {
    packing *all = user;
    camber_osm_ways *ways = all->ways;
    camber_osm_run *to = &ways->runs[part];
    const packed_run *run = slot;
    if (!camber_grow(ways->context, &ways->packed, &ways->packed_capacity, ways->packed_bytes + run->size_bytes, 1))
        return CAMBER_ERROR_MEMORY;
    if (run->size_bytes)
        memcpy(ways->packed + ways->packed_bytes, run->bytes.bytes, run->size_bytes);
    memcpy(ways->ways + to->first_way, run->ways.bytes, to->way_count * sizeof *ways->ways);
    to->first_packed = ways->packed_bytes;
    to->node_count = run->node_count;
    ways->packed_bytes += run->size_bytes;
    all->dropped += run->dropped;
    return CAMBER_OK;
}

camber_status camber_osm_pack(camber_osm_ways *ways, const camber_osm_pack_desc *desc, size_t *dropped) {
    packing all = {.ways = ways, .desc = desc};
    const camber_osm_pass_desc pass = {.context = ways->context,
                                       .name = desc->name,
                                       .part_count = ways->run_count,
                                       .threads = desc->threads,
                                       .slot_bytes = sizeof(packed_run),
                                       .user = &all,
                                       .work = pack_run,
                                       .commit = add_run,
                                       .free_slot = free_run,
                                       .from = desc->from,
                                       .to = desc->to};
    bool declined;
    const camber_status status = camber_osm_pass_run(&pass, &declined);
    camber_osm_node_set_free(&ways->nodes);
    camber_free(ways->context, ways->ids);
    ways->ids = NULL;
    ways->id_bytes = ways->id_capacity = 0;
    *dropped = all.dropped;
    return status;
}

camber_osm_unpacking camber_osm_unpack_run(const camber_osm_ways *ways, const camber_osm_run *run) {
    if (!ways->packed_bytes) /* no ways: nothing to point into */
        return (camber_osm_unpacking){.wire = {NULL, NULL, false}};
    return (camber_osm_unpacking){.wire = {ways->packed + run->first_packed, ways->packed + ways->packed_bytes, false}};
}
