#include "features/order.h"

#include <string.h>

/* By thing: the things that come directly before it in the lists. */
typedef struct predecessors {
    size_t *first; /* count + 1 */
    uint32_t *things;
} predecessors;

typedef struct sorter {
    predecessors before;
    size_t *next;    /* by thing: the first of its predecessors that was not visited yet */
    bool *begun;     /* by thing */
    uint32_t *stack; /* the things that wait for their predecessors */
    uint32_t *order;
    size_t done;
} sorter;

/* Whether another thing comes directly before item i in its list. */
static bool follows_in_list(const camber_order_desc *desc, size_t i) {
    return i > 0 && desc->lists[i] != CAMBER_LIST_END && desc->lists[i - 1] != CAMBER_LIST_END &&
           desc->lists[i] != desc->lists[i - 1];
}

static void list_predecessors(const camber_order_desc *desc, predecessors *before) {
    for (size_t i = 0; i < desc->item_count; i++)
        if (follows_in_list(desc, i))
            before->first[desc->lists[i] + 1]++;
    for (size_t i = 0; i < desc->count; i++)
        before->first[i + 1] += before->first[i];
    for (size_t i = 0; i < desc->item_count; i++)
        if (follows_in_list(desc, i))
            before->things[before->first[desc->lists[i]]++] = desc->lists[i - 1];
    memmove(before->first + 1, before->first, desc->count * sizeof *before->first);
    before->first[0] = 0;
}

/* Appends the thing after everything that must come before it. If the lists contradict each other, so that a thing
 * would wait for itself, it is appended without waiting. */
static void append_thing(sorter *sort, uint32_t thing) {
    size_t depth = 0;
    sort->stack[depth++] = thing;
    sort->begun[thing] = true;
    while (depth) {
        const uint32_t top = sort->stack[depth - 1];
        if (sort->next[top] == sort->before.first[top + 1]) {
            sort->order[sort->done++] = top;
            depth--;
            continue;
        }
        const uint32_t wanted = sort->before.things[sort->next[top]++];
        if (sort->begun[wanted])
            continue;
        sort->begun[wanted] = true;
        sort->stack[depth++] = wanted;
    }
}

camber_status camber_order_merge(camber_context *context, const camber_order_desc *desc, uint32_t *order) {
    sorter sort = {.order = order};
    camber_status status = CAMBER_ERROR_MEMORY;
    if (!(sort.before.first = camber_alloc_zero(context, desc->count + 1, sizeof *sort.before.first)) ||
        !(sort.before.things = camber_alloc(context, desc->item_count, sizeof *sort.before.things)) ||
        !(sort.next = camber_alloc(context, desc->count + 1, sizeof *sort.next)) ||
        !(sort.begun = camber_alloc_zero(context, desc->count, sizeof *sort.begun)) ||
        !(sort.stack = camber_alloc(context, desc->count, sizeof *sort.stack)))
        goto done;
    list_predecessors(desc, &sort.before);
    memcpy(sort.next, sort.before.first, (desc->count + 1) * sizeof *sort.next);
    for (size_t i = 0; i < desc->count; i++)
        if (!sort.begun[i])
            append_thing(&sort, (uint32_t)i);
    status = CAMBER_OK;
done:
    camber_free(context, sort.stack);
    camber_free(context, sort.begun);
    camber_free(context, sort.next);
    camber_free(context, sort.before.things);
    camber_free(context, sort.before.first);
    return status;
}
