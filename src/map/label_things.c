/* Finds the things that labels may name.
 *
 * Input: features. Output: their lines, areas and points that are there for labels, with boxes, sorted by class,
 * because all features of a class have the same texts and icons. The tree: things are sorted along a curve through the
 * squares of the map, so those that are under one node are near to each other. */
#include "map/label_things.h"

#include <math.h>

static bool is_finite(const double *point) {
    return isfinite(point[0]) && isfinite(point[1]);
}

camber_box camber_label_box_of(const camber_features *f, size_t first_polyline, size_t end_polyline) {
    camber_box box = CAMBER_BOX_EMPTY;
    for (size_t i = f->offsets[first_polyline]; i < f->offsets[end_polyline]; i++)
        if (is_finite(f->points + 2 * i))
            camber_box_add(&box, f->points[2 * i], f->points[2 * i + 1]);
    return box;
}

uint8_t camber_label_find_worlds(const camber_box *seen, const camber_box *box) {
    uint8_t worlds = 0;
    for (int i = 0; i < 3; i++)
        if (box->x0 + (i - 1) <= seen->x1 && box->x1 + (i - 1) >= seen->x0 && box->y0 <= seen->y1 &&
            box->y1 >= seen->y0)
            worlds |= (uint8_t)(1 << i);
    return worlds;
}

static camber_status add(camber_label_things *things, const camber_label_thing *thing) {
    if (!camber_grow(things->context, &things->items, &things->capacity, things->count + 1, sizeof *things->items))
        return CAMBER_ERROR_MEMORY;
    things->items[things->count++] = *thing;
    return CAMBER_OK;
}

/* Sorts the things by class. The sort is stable. */
static camber_status sort(camber_label_things *things) {
    camber_context *context = things->context;
    const size_t classes = things->class_count;
    size_t *first = things->class_first = camber_alloc_zero(context, classes + 2, sizeof *first);
    camber_label_thing *sorted = camber_alloc(context, things->count, sizeof *sorted);
    if (!first || !sorted) {
        camber_free(context, sorted);
        return CAMBER_ERROR_MEMORY;
    }
    for (size_t i = 0; i < things->count; i++)
        first[things->items[i].class + 2]++;
    for (size_t c = 0; c < classes; c++)
        first[c + 2] += first[c + 1];
    for (size_t i = 0; i < things->count; i++)
        sorted[first[things->items[i].class + 1]++] = things->items[i];
    camber_free(context, things->items);
    things->items = sorted;
    things->capacity = things->count;
    return CAMBER_OK;
}

camber_status camber_label_things_find(const camber_features *features, const camber_box *seen,
                                       camber_label_things *things) {
    const camber_features *f = features;
    camber_status status = CAMBER_OK;
    *things = (camber_label_things){.context = f->context, .class_count = f->class_count};
    for (size_t p = 0, next; p < f->polyline_count && f->points && status == CAMBER_OK; p = next) {
        const camber_geometry_kind kind = camber_features_kind(f, p);
        next = p + 1;
        if (kind == CAMBER_GEOMETRY_LABEL_AREA)
            while (next < f->polyline_count && f->polyline_feature[next] == f->polyline_feature[p])
                next++;
        if (!camber_geometry_is_label(kind))
            continue;
        const uint32_t feature = f->polyline_feature[p];
        const camber_label_thing thing = {f->feature_class[feature], feature, (uint32_t)p, (uint32_t)next,
                                          camber_label_box_of(f, p, next)};
        if (thing.box.x0 <= thing.box.x1 && (!seen || camber_label_find_worlds(seen, &thing.box)))
            status = add(things, &thing);
    }
    return status == CAMBER_OK ? sort(things) : status;
}

/* ---- The tree ---- */

enum { CODE_LEVEL = 24, FAN = 16 };

/* Puts a zero before each bit. */
static uint64_t spread(uint64_t bits) {
    bits = (bits | bits << 16) & UINT64_C(0x0000ffff0000ffff);
    bits = (bits | bits << 8) & UINT64_C(0x00ff00ff00ff00ff);
    bits = (bits | bits << 4) & UINT64_C(0x0f0f0f0f0f0f0f0f);
    bits = (bits | bits << 2) & UINT64_C(0x3333333333333333);
    return (bits | bits << 1) & UINT64_C(0x5555555555555555);
}

/* Interleaves the bits of a position, so that the positions of a square are consecutive. */
static uint64_t code_of(uint32_t column, uint32_t row) {
    return spread(column) | spread(row) << 1;
}

static uint32_t position_of(double share) {
    const double most = exp2(CODE_LEVEL);
    return (uint32_t)fmin(fmax(floor(share * most), 0.0), most - 1.0);
}

/* Sorts the things by the codes of their middles, by eight bits at a time. */
static camber_status sort_by_codes(camber_label_things *things) {
    camber_context *context = things->context;
    const size_t count = things->count;
    camber_label_tree *tree = &things->tree;
    uint64_t *codes = camber_alloc(context, count, sizeof *codes), *other = camber_alloc(context, count, sizeof *other);
    uint32_t *order = camber_alloc(context, count, sizeof *order);
    uint32_t *other_order = camber_alloc(context, count, sizeof *other_order);
    const bool made = codes && other && order && other_order;
    for (size_t i = 0; made && i < count; i++) {
        const camber_box *box = &things->items[i].box;
        const double x = 0.5 * (box->x0 + box->x1);
        codes[i] = code_of(position_of(x - floor(x)), position_of(0.5 * (box->y0 + box->y1)));
        order[i] = (uint32_t)i;
    }
    for (int shift = 0; made && shift < 2 * CODE_LEVEL; shift += 8) {
        size_t firsts[257] = {0};
        for (size_t i = 0; i < count; i++)
            firsts[(codes[i] >> shift & 255) + 1]++;
        for (size_t i = 1; i < 256; i++)
            firsts[i] += firsts[i - 1];
        for (size_t i = 0; i < count; i++) {
            const size_t to = firsts[codes[i] >> shift & 255]++;
            other[to] = codes[i];
            other_order[to] = order[i];
        }
        uint64_t *const sorted = other;
        uint32_t *const sorted_order = other_order;
        other = codes;
        other_order = order;
        codes = sorted;
        order = sorted_order;
    }
    camber_free(context, other);
    camber_free(context, other_order);
    tree->codes = codes;
    tree->order = order;
    return made ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

static void free_tree(camber_label_things *things) {
    camber_free(things->context, things->tree.codes);
    camber_free(things->context, things->tree.order);
    camber_free(things->context, things->tree.nodes);
    things->tree = (camber_label_tree){0};
}

/* Returns the box of a thing (level 0), or of a node of the level before. */
static const camber_box *child_box(const camber_label_things *things, int level, size_t child) {
    const camber_label_tree *tree = &things->tree;
    return level == 0 ? &things->items[tree->order[child]].box : tree->nodes + tree->firsts[level - 1] + child;
}

/* Returns how many children the nodes of a level have. */
static size_t count_children(const camber_label_things *things, int level) {
    return level == 0 ? things->count : things->tree.firsts[level] - things->tree.firsts[level - 1];
}

static camber_status make_nodes(camber_label_things *things) {
    camber_label_tree *tree = &things->tree;
    size_t children = things->count;
    do {
        children = (children + FAN - 1) / FAN;
        tree->firsts[tree->level_count + 1] = tree->firsts[tree->level_count] + children;
        tree->level_count++;
    } while (children > 1);
    if (!(tree->nodes = camber_alloc(things->context, tree->firsts[tree->level_count], sizeof *tree->nodes)))
        return CAMBER_ERROR_MEMORY;
    for (int level = 0; level < tree->level_count; level++)
        for (size_t i = 0; i < count_children(things, level); i++) {
            camber_box *node = tree->nodes + tree->firsts[level] + i / FAN;
            const camber_box *box = child_box(things, level, i);
            if (i % FAN == 0)
                *node = *box;
            camber_box_add(node, box->x0, box->y0);
            camber_box_add(node, box->x1, box->y1);
        }
    return CAMBER_OK;
}

camber_status camber_label_things_make_tree(camber_label_things *things) {
    if (things->tree.codes || things->count == 0)
        return CAMBER_OK;
    camber_status status = sort_by_codes(things);
    if (status == CAMBER_OK)
        status = make_nodes(things);
    if (status != CAMBER_OK)
        free_tree(things);
    return status;
}

/* Marks the things below a node that touch a box, or, if marks is NULL, looks for the first one. Returns whether there
 * is one. */
static bool visit(const camber_label_things *things, const camber_box *seen, int level, size_t node, uint64_t *marks) {
    const size_t first = node * FAN, count = count_children(things, level),
                 end = first + FAN < count ? first + FAN : count;
    bool found = false;
    for (size_t i = first; i < end && (marks || !found); i++) {
        if (!camber_label_find_worlds(seen, child_box(things, level, i)))
            continue;
        if (level > 0) {
            found |= visit(things, seen, level - 1, i, marks);
            continue;
        }
        const uint32_t thing = things->tree.order[i];
        if (marks)
            marks[thing / 64] |= UINT64_C(1) << (thing % 64);
        found = true;
    }
    return found;
}

bool camber_label_things_touch(const camber_label_things *things, const camber_box *box) {
    return things->count && visit(things, box, things->tree.level_count - 1, 0, NULL);
}

static size_t count_below(const camber_label_things *things, uint64_t code) {
    size_t low = 0, high = things->count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (things->tree.codes[middle] < code)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

size_t camber_label_things_count(const camber_label_things *things, const camber_label_square *square) {
    const int shift = CODE_LEVEL - square->level;
    const uint64_t first = code_of(square->column << shift, square->row << shift);
    return count_below(things, first + (UINT64_C(1) << (2 * shift))) - count_below(things, first);
}

/* ---- Selecting ---- */

camber_status camber_label_things_select(const camber_label_things *all, const camber_box *seen,
                                         camber_label_things *things) {
    *things = (camber_label_things){.context = all->context, .class_count = all->class_count};
    const bool has_tree = all->tree.codes != NULL;
    uint64_t *marks = has_tree ? camber_alloc_zero(all->context, all->count / 64 + 1, sizeof *marks) : NULL;
    things->class_first = camber_alloc_zero(all->context, all->class_count + 2, sizeof *things->class_first);
    camber_status status = things->class_first && (marks || !has_tree) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (marks)
        visit(all, seen, all->tree.level_count - 1, 0, marks);
    for (size_t i = 0; i < all->count && status == CAMBER_OK; i++) {
        if (marks && i % 64 == 0 && !marks[i / 64]) {
            i += 63;
            continue;
        }
        if (marks ? marks[i / 64] >> (i % 64) & 1 : camber_label_find_worlds(seen, &all->items[i].box) != 0) {
            status = add(things, all->items + i);
            things->class_first[all->items[i].class + 1]++;
        }
    }
    for (size_t c = 0; c < all->class_count && status == CAMBER_OK; c++)
        things->class_first[c + 1] += things->class_first[c];
    camber_free(all->context, marks);
    return status;
}

void camber_label_things_free(camber_label_things *things) {
    if (!things->context)
        return;
    camber_free(things->context, things->items);
    camber_free(things->context, things->class_first);
    free_tree(things);
    *things = (camber_label_things){0};
}
