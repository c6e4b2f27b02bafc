/* Packs ways: stores each node as the difference from the node before it.
 *
 * Input: ways with ids of nodes, and the places of these nodes. Output: the places of the ways, one way after the
 * other; the memory of ids and nodes is freed. The main idea: lines in world coordinates take 16 bytes per point, and
 * nodes 8 bytes or more. If lines were made from the nodes directly, both would be in memory together. Packed ways take
 * a quarter of the memory of lines, because the nodes of a way are close to each other.
 */
#include "osm/packed.h"

/* A word contains a difference of longitudes and one of latitudes, 16 bits each, in 10^-7 degrees. If it has this value
 * instead, a place follows. */
static const uint32_t FAR = 0x8000;
enum { MOST_PLACE_WORDS = 3 };

typedef struct packed_run {
    camber_osm_block places, words, ways; /* uint64_t; uint32_t; camber_osm_way, in their final form */
    size_t word_count, node_count, dropped;
} packed_run;

static void free_run(camber_context *context, void *slot) {
    packed_run *run = slot;
    camber_free(context, run->ways.bytes);
    camber_free(context, run->words.bytes);
    camber_free(context, run->places.bytes);
}

typedef struct packing {
    camber_osm_ways *ways;
    const camber_osm_pack_desc *desc;
    size_t dropped;
} packing;

/* A thread's position in its run. */
typedef struct packer {
    const uint64_t *places; /* the places of the next nodes */
    uint32_t *at;
    uint64_t place; /* the place that was packed last */
} packer;

static void put_place(packer *to, uint64_t place) {
    const int64_t east = (int64_t)camber_osm_longitude(place) - camber_osm_longitude(to->place),
                  north = (int64_t)camber_osm_latitude(place) - camber_osm_latitude(to->place);
    if (east > INT16_MIN && east <= INT16_MAX && north >= INT16_MIN && north <= INT16_MAX) {
        *to->at++ = ((uint32_t)east & 0xffff) | (uint32_t)north << 16;
    } else {
        *to->at++ = FAR;
        *to->at++ = (uint32_t)(place >> 32);
        *to->at++ = (uint32_t)place;
    }
    to->place = place;
}

/* Looks up the places of a run. There are no branches here, so the processor can wait for many memory accesses at a
 * time. */
static void look_up_places(const camber_osm_ways *ways, const camber_osm_run *run, uint64_t *places) {
    const camber_osm_node_set *nodes = &ways->nodes;
    const uint32_t *ids = ways->ids + run->first_id, *leaves = ways->leaves + run->first_leaf;
    for (size_t i = 0; i < run->node_count; i++) {
        const uint32_t index = camber_osm_node_set_index(nodes, leaves[ids[i] >> CAMBER_OSM_LEAF_BITS], ids[i]);
        places[i] = atomic_load_explicit(&nodes->places[index], memory_order_relaxed);
    }
}

/* Packs a way, and returns its new form. Fewer than two nodes make no line. *dropped counts the areas that are lost. */
static camber_osm_way pack_way(const packing *all, const camber_osm_way *way, packer *to, size_t *dropped) {
    const packer before = *to;
    uint64_t first = 0, last = 0;
    uint32_t found = 0, last_found = 0;
    bool gaps = false;
    for (uint32_t i = 0; i < way->node_count; i++) {
        const uint64_t place = *to->places++;
        if (place == CAMBER_OSM_NOWHERE)
            continue;
        gaps |= found && i > last_found + 1;
        last_found = i;
        first = found++ ? first : place;
        last = place;
        put_place(to, place);
    }
    const bool area = (way->tags & CAMBER_OSM_WAY_AREA) && found > 3 && first == last;
    const bool drops = area && all->desc->drops_areas;
    *dropped += drops;
    if (drops || found < 2) {
        to->at = before.at;
        to->place = before.place;
        found = 0;
    }
    return (camber_osm_way){(way->tags & ~(area ? 0u : (uint32_t)CAMBER_OSM_WAY_AREA)) |
                                (gaps ? (uint32_t)CAMBER_OSM_WAY_GAPS : 0u),
                            found};
}

static bool pack_run(void *user, camber_osm_pass *pass, size_t part, void *slot, camber_osm_failure *failure) {
    const packing *all = user;
    const camber_osm_ways *ways = all->ways;
    const camber_osm_run *from = &ways->runs[part];
    packed_run *run = slot;
    if (!camber_osm_reserve(pass, &run->places, from->node_count * sizeof(uint64_t), failure) ||
        !camber_osm_reserve(pass, &run->words, from->node_count * MOST_PLACE_WORDS * sizeof(uint32_t), failure) ||
        !camber_osm_reserve(pass, &run->ways, from->way_count * sizeof(camber_osm_way), failure))
        return false;
    uint64_t *places = (uint64_t *)(void *)run->places.bytes;
    packer to = {.places = places, .at = (uint32_t *)(void *)run->words.bytes};
    camber_osm_way *packed = (camber_osm_way *)(void *)run->ways.bytes;
    look_up_places(ways, from, places);
    run->node_count = run->dropped = 0;
    for (size_t i = 0; i < from->way_count; i++) {
        packed[i] = pack_way(all, &ways->ways[from->first_way + i], &to, &run->dropped);
        run->node_count += packed[i].node_count;
    }
    run->word_count = (size_t)(to.at - (const uint32_t *)(const void *)run->words.bytes);
    return true;
}

/* No thread reads the run any more, so it can be freed. */
static camber_status add_run(void *user, size_t part, void *slot) {
    packing *all = user;
    camber_osm_ways *ways = all->ways;
    camber_osm_run *to = &ways->runs[part];
    const packed_run *run = slot;
    if (!camber_grow(ways->context, &ways->packed, &ways->packed_capacity, ways->packed_count + run->word_count,
                     sizeof *ways->packed))
        return CAMBER_ERROR_MEMORY;
    if (run->word_count)
        memcpy(ways->packed + ways->packed_count, run->words.bytes, run->word_count * sizeof *ways->packed);
    memcpy(ways->ways + to->first_way, run->ways.bytes, to->way_count * sizeof *ways->ways);
    to->first_packed = ways->packed_count;
    to->node_count = run->node_count;
    ways->packed_count += run->word_count;
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
    /* Most places take one word, but the first place of a way takes three. */
    camber_status status = CAMBER_ERROR_MEMORY;
    if (camber_grow(ways->context, &ways->packed, &ways->packed_capacity, ways->node_count + 2 * ways->way_count,
                    sizeof *ways->packed))
        status = camber_osm_pass_run(&pass, &declined);
    camber_osm_node_set_free(&ways->nodes);
    camber_free(ways->context, ways->leaves);
    camber_free(ways->context, ways->ids);
    ways->ids = ways->leaves = NULL;
    ways->id_capacity = ways->leaf_count = ways->leaf_capacity = 0;
    *dropped = all.dropped;
    return status;
}

/* Extends a signed number of 16 bits to 32 bits. */
static uint32_t extend(uint32_t number) {
    return (number ^ 0x8000) - 0x8000;
}

void camber_osm_unpack_run(const camber_osm_ways *ways, const camber_osm_run *run, uint64_t *places) {
    const uint32_t *at = run->node_count ? ways->packed + run->first_packed : NULL;
    uint32_t longitude = 0, latitude = 0;
    for (size_t i = 0; i < run->node_count; i++) {
        const uint32_t word = *at++;
        if ((word & 0xffff) == FAR) {
            longitude = *at++;
            latitude = *at++;
        } else {
            longitude += extend(word & 0xffff);
            latitude += extend(word >> 16);
        }
        places[i] = (uint64_t)longitude << 32 | latitude;
    }
}
