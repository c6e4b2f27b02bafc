#include "features/chains.h"

#include <string.h>

static camber_chain follow_chain(const camber_chains_desc *desc, uint32_t start) {
    camber_chain made = {start, UINT32_MAX};
    uint32_t end = start;
    do {
        const uint32_t key = desc->keys ? desc->keys[end / 2] : end / 2;
        made.key = key < made.key ? key : made.key;
        desc->visited[end / 2] = true;
        end = desc->partner[end ^ 1];
    } while (end != CAMBER_NO_END && end != start);
    return made;
}

/* Finds chains in three rounds, so that a chain has the direction of its lines if all of them have the same. */
static size_t find_chains(const camber_chains_desc *desc, camber_chain *chains) {
    size_t count = 0;
    for (int round = 0; round < 3; round++) {
        for (uint32_t i = 0; i < desc->line_count; i++) {
            const uint32_t start = round == 1 ? 2 * i + 1 : 2 * i;
            if (!desc->visited[i] && (round == 2 || desc->partner[start] == CAMBER_NO_END))
                chains[count++] = follow_chain(desc, start);
        }
    }
    return count;
}

camber_status camber_chains_find(camber_context *context, const camber_chains_desc *desc, camber_chain **chains,
                                 size_t *count) {
    camber_chain *found = camber_alloc(context, desc->line_count, sizeof *found);
    camber_chain *sorted = found ? camber_alloc(context, desc->line_count, sizeof *sorted) : NULL;
    uint32_t *starts = sorted ? camber_alloc_zero(context, desc->key_count + 1, sizeof *starts) : NULL;
    if (!starts) {
        camber_free(context, sorted);
        camber_free(context, found);
        return CAMBER_ERROR_MEMORY;
    }
    *count = find_chains(desc, found);
    for (size_t i = 0; i < *count; i++)
        starts[found[i].key + 1]++;
    for (size_t i = 0; i < desc->key_count; i++)
        starts[i + 1] += starts[i];
    for (size_t i = 0; i < *count; i++)
        sorted[starts[found[i].key]++] = found[i];
    camber_free(context, starts);
    camber_free(context, found);
    *chains = sorted;
    return CAMBER_OK;
}
