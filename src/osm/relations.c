/* Keeps relations, and the places of the ways that they name, until rings are assembled from them.
 *
 * Input: relations, before any way is read; then the ways that they name, in the order of the file. Output: rings. Ways
 * are found by their ids, and a way that several relations name is stored once. */
#include "osm/relations.h"

void camber_osm_relations_init(camber_osm_relations *relations, camber_context *context) {
    *relations = (camber_osm_relations){.context = context};
    camber_osm_node_set_init(&relations->ids, context);
}

void camber_osm_relations_free(camber_osm_relations *relations) {
    camber_context *context = relations->context;
    camber_free(context, relations->places);
    camber_free(context, relations->met);
    camber_free(context, relations->ways);
    camber_osm_node_set_free(&relations->ids);
    camber_free(context, relations->members);
    camber_free(context, relations->items);
    camber_osm_relations_init(relations, context);
}

camber_status camber_osm_relations_complete(camber_osm_relations *relations) {
    if (relations->count == 0)
        return CAMBER_OK;
    const camber_status status = camber_osm_node_set_complete(&relations->ids);
    if (status == CAMBER_OK &&
        !(relations->ways = camber_alloc_zero(relations->context, relations->ids.node_count, sizeof *relations->ways)))
        return CAMBER_ERROR_MEMORY;
    return status;
}

/* Gives a relation the tags of its first outer way that has tags. */
static void take_tags(camber_osm_relations *relations, camber_osm_relation *one) {
    camber_osm_search_hint hint = {.leaf_id = UINT64_MAX, .id = -2};
    for (size_t m = one->first_member; m < one->first_member + one->member_count; m++) {
        uint32_t index;
        if (relations->members[m].role == CAMBER_OSM_ROLE_INNER ||
            !camber_osm_relations_find(relations, relations->members[m].way, &hint, &index))
            continue;
        one->set = one->set ? one->set : relations->ways[index].set;
        relations->ways[index].is_outer |= one->set && relations->ways[index].set == one->set;
    }
}

void camber_osm_relations_settle(camber_osm_relations *relations) {
    for (size_t i = 0; i < relations->count; i++)
        if (!relations->items[i].is_tagged)
            take_tags(relations, &relations->items[i]);
}

bool camber_osm_relations_find(const camber_osm_relations *relations, int64_t way, camber_osm_search_hint *hint,
                               uint32_t *index) {
    return relations->ways && camber_osm_node_set_find(&relations->ids, way, hint, index);
}

camber_status camber_osm_relations_add_places(camber_osm_relations *relations, size_t met, const uint64_t *places,
                                              uint32_t count) {
    camber_osm_member_way *way = &relations->ways[relations->met[met]];
    if (!camber_grow(relations->context, &relations->places, &relations->place_capacity, relations->place_count + count,
                     sizeof *relations->places))
        return CAMBER_ERROR_MEMORY;
    if (count)
        memcpy(relations->places + relations->place_count, places, count * sizeof *places);
    way->first_place = relations->place_count;
    way->place_count = count;
    relations->place_count += count;
    return CAMBER_OK;
}

size_t camber_osm_relations_count_missing(const camber_osm_relations *relations) {
    size_t count = 0;
    for (size_t i = 0; relations->ways && i < relations->ids.node_count; i++)
        count += relations->ways[i].place_count == 0;
    return count;
}

size_t camber_osm_relations_count_places(const camber_osm_relations *relations, size_t relation) {
    const camber_osm_relation *one = &relations->items[relation];
    camber_osm_search_hint hint = {.leaf_id = UINT64_MAX, .id = -2};
    size_t count = 0;
    for (size_t m = one->first_member; m < one->first_member + one->member_count; m++) {
        uint32_t index;
        if (camber_osm_relations_find(relations, relations->members[m].way, &hint, &index))
            count += relations->ways[index].place_count;
    }
    return count;
}

/* Lists the pieces of a relation that the file contains. *lacks becomes true if some are missing. */
static size_t list_pieces(const camber_osm_relations *relations, size_t relation, camber_osm_piece *pieces,
                          bool *lacks) {
    const camber_osm_relation *one = &relations->items[relation];
    camber_osm_search_hint hint = {.leaf_id = UINT64_MAX, .id = -2};
    size_t count = 0;
    for (size_t m = one->first_member; m < one->first_member + one->member_count; m++) {
        const camber_osm_member *member = &relations->members[m];
        uint32_t index;
        const bool found = camber_osm_relations_find(relations, member->way, &hint, &index);
        camber_osm_member_way *way = found ? &relations->ways[index] : NULL;
        *lacks = *lacks || !way || way->place_count < 2;
        if (!way || way->place_count < 2 || way->listed == (uint32_t)relation + 1)
            continue;
        way->listed = (uint32_t)relation + 1;
        pieces[count++] = (camber_osm_piece){relations->places + way->first_place, way->place_count, member->role};
    }
    return count;
}

camber_status camber_osm_relations_assemble(const camber_osm_relations *relations, size_t relation,
                                            camber_osm_assembly *assembly) {
    const camber_osm_relation *one = &relations->items[relation];
    camber_osm_piece *pieces = camber_alloc(relations->context, one->member_count, sizeof *pieces);
    if (!pieces)
        return CAMBER_ERROR_MEMORY;
    bool lacks = false;
    const size_t count = list_pieces(relations, relation, pieces, &lacks);
    const camber_status status = camber_osm_assemble(assembly, pieces, count, !lacks);
    assembly->open = assembly->open || lacks;
    camber_free(relations->context, pieces);
    return status;
}
