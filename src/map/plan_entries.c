/* The entries of a plan: polylines by set, in input order, or in that of their features' keys where a set is sorted. */
#include "map/plan.h"

#include <stdlib.h>
#include <string.h>

typedef struct set_pair {
    uint32_t set, pair;
} set_pair;

/* The sets that draw a class: [first[class], first[class + 1]) of pairs. */
typedef struct class_sets {
    size_t *first;
    set_pair *pairs;
} class_sets;

/* What is sorted is another order of entries for other keys. */
static void end_set(camber_plan *plan, camber_plan_set *set) {
    const double *keys = plan->pair_keys + set->first_pair;
    set->pair_count = plan->pair_count - set->first_pair;
    for (size_t i = 1; i < set->pair_count; i++)
        set->sorted = set->sorted || keys[i] < keys[0] || keys[i] > keys[0];
    if (set->sorted)
        plan->key = camber_hash(plan->key, keys, set->pair_count * sizeof *keys);
}

/* Numbers the pairs of sets and classes, by set. */
static camber_status number_pairs(const camber_features *features, camber_plan *plan,
                                  const camber_plan_classes *by_class) {
    const size_t class_count = features->class_count;
    size_t total = 0;
    for (size_t i = 0; i < plan->set_count * class_count; i++)
        total += by_class->rows[i] != CAMBER_NO_ROW;
    if (total >= CAMBER_PLAN_ROWS_MAX)
        return camber_fail(plan->context, CAMBER_ERROR_LIMIT,
                           "style: more than %zu combinations of layers and properties; let filters depend on fewer",
                           CAMBER_PLAN_ROWS_MAX);
    if (!(plan->pair_rows = camber_alloc(plan->context, total, sizeof *plan->pair_rows)) ||
        !(plan->pair_keys = camber_alloc(plan->context, total, sizeof *plan->pair_keys)))
        return CAMBER_ERROR_MEMORY;
    plan->key = camber_hash(CAMBER_HASH_START, &features->polyline_count, sizeof features->polyline_count);
    for (size_t s = 0; s < plan->set_count; s++) {
        plan->sets[s].first_pair = plan->pair_count;
        for (size_t c = 0; c < class_count; c++) {
            const size_t at = s * class_count + c;
            if (by_class->rows[at] == CAMBER_NO_ROW)
                continue;
            const size_t pair[2] = {s, c};
            plan->key = camber_hash(plan->key, pair, sizeof pair);
            plan->pair_keys[plan->pair_count] = by_class->keys[at];
            plan->pair_rows[plan->pair_count++] = by_class->rows[at];
        }
        end_set(plan, plan->sets + s);
    }
    return CAMBER_OK;
}

static camber_status group_by_class(const camber_features *features, const camber_plan *plan, const uint32_t *rows,
                                    class_sets *by_class) {
    const size_t class_count = features->class_count;
    by_class->first = camber_alloc(plan->context, class_count + 1, sizeof *by_class->first);
    if (!by_class->first)
        return CAMBER_ERROR_MEMORY;
    size_t total = 0;
    for (size_t c = 0; c < class_count; c++) {
        by_class->first[c] = total;
        for (size_t s = 0; s < plan->set_count; s++)
            total += rows[s * class_count + c] != CAMBER_NO_ROW;
    }
    by_class->first[class_count] = total;
    by_class->pairs = camber_alloc(plan->context, total, sizeof *by_class->pairs);
    if (!by_class->pairs)
        return CAMBER_ERROR_MEMORY;
    /* By set: each class takes its pairs in turn, as they are numbered. */
    uint32_t pair = 0;
    for (size_t s = 0; s < plan->set_count; s++)
        for (size_t c = 0; c < class_count; c++)
            if (rows[s * class_count + c] != CAMBER_NO_ROW)
                by_class->pairs[by_class->first[c]++] = (set_pair){(uint32_t)s, pair++};
    for (size_t c = class_count; c > 0; c--)
        by_class->first[c] = by_class->first[c - 1];
    by_class->first[0] = 0;
    return CAMBER_OK;
}

typedef struct keyed_pair {
    double key;
    size_t pair;
} keyed_pair;

static int compare_keys(const void *left, const void *right) {
    const keyed_pair *a = left, *b = right;
    return a->key < b->key ? -1 : a->key > b->key;
}

/* The entries of a set by their features' keys, those of one key as they were. */
static camber_status sort_entries(camber_plan *plan, const camber_plan_set *set) {
    camber_plan_entry *entries = plan->entries + set->first_entry;
    keyed_pair *keyed = camber_alloc(plan->context, set->pair_count, sizeof *keyed);
    size_t *ranks = keyed ? camber_alloc(plan->context, set->pair_count, sizeof *ranks) : NULL;
    size_t *firsts = ranks ? camber_alloc_zero(plan->context, set->pair_count + 1, sizeof *firsts) : NULL;
    camber_plan_entry *sorted = firsts ? camber_alloc(plan->context, set->entry_count, sizeof *sorted) : NULL;
    const bool held = sorted != NULL;
    if (held) {
        for (size_t i = 0; i < set->pair_count; i++)
            keyed[i] = (keyed_pair){plan->pair_keys[set->first_pair + i], i};
        qsort(keyed, set->pair_count, sizeof *keyed, compare_keys);
        for (size_t i = 0, rank = 0; i < set->pair_count; i++) {
            rank += i > 0 && keyed[i].key > keyed[i - 1].key;
            ranks[keyed[i].pair] = rank;
        }
        for (size_t i = 0; i < set->entry_count; i++)
            firsts[ranks[entries[i].pair - set->first_pair] + 1]++;
        for (size_t i = 0; i < set->pair_count; i++)
            firsts[i + 1] += firsts[i];
        for (size_t i = 0; i < set->entry_count; i++)
            sorted[firsts[ranks[entries[i].pair - set->first_pair]]++] = entries[i];
        memcpy(entries, sorted, set->entry_count * sizeof *sorted);
    }
    camber_free(plan->context, sorted);
    camber_free(plan->context, firsts);
    camber_free(plan->context, ranks);
    camber_free(plan->context, keyed);
    return held ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

static camber_status list_by_set(const camber_features *features, camber_plan *plan, const class_sets *by_class) {
    if (features->polyline_count > UINT32_MAX)
        return camber_fail(plan->context, CAMBER_ERROR_LIMIT, "%zu polylines are more than 2^32; draw them in parts",
                           features->polyline_count);
    for (size_t p = 0; p < features->polyline_count; p++) {
        const uint32_t class = features->feature_class[features->polyline_feature[p]];
        if (by_class->first[class] == by_class->first[class + 1])
            plan->undrawn += features->feature_counts[p];
        for (size_t k = by_class->first[class]; k < by_class->first[class + 1]; k++)
            plan->sets[by_class->pairs[k].set].entry_count++;
    }
    size_t total = 0;
    for (size_t s = 0; s < plan->set_count; s++) {
        plan->sets[s].first_entry = total;
        total += plan->sets[s].entry_count;
        plan->sets[s].entry_count = 0;
    }
    plan->entries = camber_alloc(plan->context, total, sizeof *plan->entries);
    if (!plan->entries)
        return CAMBER_ERROR_MEMORY;
    for (size_t p = 0; p < features->polyline_count; p++) {
        const uint32_t class = features->feature_class[features->polyline_feature[p]];
        for (size_t k = by_class->first[class]; k < by_class->first[class + 1]; k++) {
            camber_plan_set *set = plan->sets + by_class->pairs[k].set;
            plan->entries[set->first_entry + set->entry_count++] =
                (camber_plan_entry){(uint32_t)p, by_class->pairs[k].pair};
        }
    }
    camber_status status = CAMBER_OK;
    for (size_t s = 0; s < plan->set_count && status == CAMBER_OK; s++)
        if (plan->sets[s].sorted)
            status = sort_entries(plan, plan->sets + s);
    return status;
}

camber_status camber_plan_list_entries(const camber_features *features, camber_plan *plan,
                                       const camber_plan_classes *by_class) {
    class_sets sets = {0};
    camber_status status = number_pairs(features, plan, by_class);
    if (status == CAMBER_OK)
        status = group_by_class(features, plan, by_class->rows, &sets);
    if (status == CAMBER_OK)
        status = list_by_set(features, plan, &sets);
    camber_free(plan->context, sets.pairs);
    camber_free(plan->context, sets.first);
    return status;
}
