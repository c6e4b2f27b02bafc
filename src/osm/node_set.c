/* A set of ids as a tree of bitmaps, with a place for each id.
 *
 * Input: ids in any order, often consecutive. Output: an id's index among all ids, in the order in which leaves were
 * made. In the data of a country, ids come in runs, so an id takes a few bits; an isolated id takes 350 bytes. */
#include "osm/node_set.h"

enum { LEAF_BITS = CAMBER_OSM_LEAF_BITS, TWIG_BITS = 6 };

void camber_osm_node_set_init(camber_osm_node_set *set, camber_context *context) {
    *set = (camber_osm_node_set){.context = context, .last_leaf_id = UINT64_MAX};
}

void camber_osm_node_set_free(camber_osm_node_set *set) {
    camber_free(set->context, (void *)set->places);
    camber_free(set->context, set->ranks);
    camber_free(set->context, set->leaves);
    camber_free(set->context, set->twigs);
    camber_free(set->context, set->branches);
    camber_osm_node_set_init(set, set->context);
}

static camber_status make_branches(camber_osm_node_set *set, size_t count) {
    if (!camber_grow(set->context, &set->branches, &set->branch_capacity, count, sizeof *set->branches))
        return CAMBER_ERROR_MEMORY;
    memset(set->branches + set->branch_count, 0, (set->branch_capacity - set->branch_count) * sizeof *set->branches);
    set->branch_count = set->branch_capacity;
    return CAMBER_OK;
}

static camber_status find_leaf(camber_osm_node_set *set, uint64_t leaf_id) {
    const uint64_t branch = leaf_id >> TWIG_BITS;
    camber_status status = CAMBER_OK;
    if (branch >= set->branch_count)
        status = make_branches(set, (size_t)branch + 1);
    if (status == CAMBER_OK && set->branches[branch] == 0) {
        if (!camber_grow(set->context, &set->twigs, &set->twig_capacity, set->twig_count + 1, sizeof *set->twigs))
            return CAMBER_ERROR_MEMORY;
        memset(set->twigs[set->twig_count], 0, sizeof *set->twigs);
        set->branches[branch] = (uint32_t)++set->twig_count;
    }
    if (status != CAMBER_OK)
        return status;
    uint32_t *leaf = &set->twigs[set->branches[branch] - 1][leaf_id & ((1 << TWIG_BITS) - 1)];
    if (*leaf == 0) {
        if (!camber_grow(set->context, &set->leaves, &set->leaf_capacity, set->leaf_count + 1, sizeof *set->leaves))
            return CAMBER_ERROR_MEMORY;
        set->leaves[set->leaf_count] = (camber_osm_leaf){.bits = {0}};
        *leaf = (uint32_t)++set->leaf_count;
    }
    set->last_leaf_id = leaf_id;
    set->last_leaf = *leaf - 1;
    return CAMBER_OK;
}

camber_status camber_osm_node_set_add(camber_osm_node_set *set, int64_t id) {
    const uint64_t leaf_id = (uint64_t)id >> LEAF_BITS;
    if (leaf_id != set->last_leaf_id) {
        const camber_status status = find_leaf(set, leaf_id);
        if (status != CAMBER_OK)
            return status;
    }
    set->leaves[set->last_leaf].bits[id >> 6 & (CAMBER_OSM_LEAF_WORDS - 1)] |= UINT64_C(1) << (id & 63);
    return CAMBER_OK;
}

camber_status camber_osm_node_set_add_leaf(camber_osm_node_set *set, uint64_t leaf_id,
                                           const uint64_t bits[CAMBER_OSM_LEAF_WORDS], uint32_t *leaf) {
    const camber_status status = find_leaf(set, leaf_id);
    if (status != CAMBER_OK)
        return status;
    for (int w = 0; w < CAMBER_OSM_LEAF_WORDS; w++)
        set->leaves[set->last_leaf].bits[w] |= bits[w];
    *leaf = (uint32_t)set->last_leaf;
    return CAMBER_OK;
}

camber_status camber_osm_node_set_complete(camber_osm_node_set *set) {
    camber_context *context = set->context;
    uint64_t count = 0;
    if (!(set->ranks = camber_alloc(context, set->leaf_count, sizeof *set->ranks)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < set->leaf_count && count <= UINT32_MAX; i++) {
        set->ranks[i] = (uint32_t)count;
        for (int w = 0; w < CAMBER_OSM_LEAF_WORDS; w++) {
            set->leaves[i].before[w] = (uint16_t)(count - set->ranks[i]);
            count += camber_osm_count_bits(set->leaves[i].bits[w]);
        }
    }
    if (count > UINT32_MAX)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "the lines have more than 4294967295 nodes; select fewer with an attribute filter");
    set->node_count = (size_t)count;
    if (!(set->places = camber_alloc(context, set->node_count, sizeof *set->places)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < set->node_count; i++)
        atomic_init(&set->places[i], CAMBER_OSM_NOWHERE);
    return CAMBER_OK;
}

bool camber_osm_node_set_find(const camber_osm_node_set *set, int64_t id, camber_osm_search_hint *hint,
                              uint32_t *index) {
    const uint64_t leaf_id = (uint64_t)id >> LEAF_BITS, branch = leaf_id >> TWIG_BITS;
    if (leaf_id != hint->leaf_id) {
        const uint32_t twig = branch < set->branch_count ? set->branches[branch] : 0;
        hint->leaf_id = leaf_id;
        hint->leaf = twig ? set->twigs[twig - 1][leaf_id & ((1 << TWIG_BITS) - 1)] : 0;
    }
    if (hint->leaf == 0)
        return false;
    const camber_osm_leaf *leaf = &set->leaves[hint->leaf - 1];
    const unsigned word = id >> 6 & (CAMBER_OSM_LEAF_WORDS - 1);
    const uint64_t bit = UINT64_C(1) << (id & 63);
    if (!(leaf->bits[word] & bit))
        return false;
    const bool follows = id == hint->id + 1 && (id & ((1 << LEAF_BITS) - 1)) != 0;
    hint->index =
        follows ? hint->index + 1
                : set->ranks[hint->leaf - 1] + leaf->before[word] + camber_osm_count_bits(leaf->bits[word] & (bit - 1));
    hint->id = id;
    *index = hint->index;
    return true;
}
