/* Finds the things that labels may name.
 *
 * Input: features. Output: their lines, areas and points that are there for labels, with boxes, sorted by class,
 * because all features of a class have the same texts and icons. */
#include "map/label_things.h"

#include <math.h>
#include <stdlib.h>

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

camber_status camber_label_things_select(const camber_label_things *all, const camber_box *seen,
                                         camber_label_things *things) {
    *things = (camber_label_things){.context = all->context, .class_count = all->class_count};
    if (!(things->class_first = camber_alloc_zero(all->context, all->class_count + 2, sizeof *things->class_first)))
        return CAMBER_ERROR_MEMORY;
    for (size_t c = 0; c < all->class_count; c++) {
        for (size_t i = all->class_first[c]; i < all->class_first[c + 1]; i++)
            if (camber_label_find_worlds(seen, &all->items[i].box) && add(things, all->items + i) != CAMBER_OK)
                return CAMBER_ERROR_MEMORY;
        things->class_first[c + 1] = things->count;
    }
    return CAMBER_OK;
}

/* ---- Middles ---- */

enum { CODE_LEVEL = 24 };

/* Interleaves the bits of a position, so that the positions of a square are consecutive. */
static uint64_t code_of(uint32_t column, uint32_t row) {
    uint64_t code = 0;
    for (int i = 0; i < CODE_LEVEL; i++)
        code |= (uint64_t)(column >> i & 1) << (2 * i) | (uint64_t)(row >> i & 1) << (2 * i + 1);
    return code;
}

static uint32_t position_of(double share) {
    const double most = exp2(CODE_LEVEL);
    return (uint32_t)fmin(fmax(floor(share * most), 0.0), most - 1.0);
}

static int compare_codes(const void *left, const void *right) {
    uint64_t a, b;
    memcpy(&a, left, sizeof a);
    memcpy(&b, right, sizeof b);
    return a < b ? -1 : a > b;
}

static size_t count_below(const camber_label_things *things, uint64_t code) {
    size_t low = 0, high = things->count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (things->codes[middle] < code)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

camber_status camber_label_things_count(camber_label_things *things, const camber_label_square *square, size_t *count) {
    if (!things->codes) {
        if (!(things->codes = camber_alloc(things->context, things->count, sizeof *things->codes)))
            return CAMBER_ERROR_MEMORY;
        for (size_t i = 0; i < things->count; i++) {
            const camber_box *box = &things->items[i].box;
            const double x = 0.5 * (box->x0 + box->x1);
            things->codes[i] = code_of(position_of(x - floor(x)), position_of(0.5 * (box->y0 + box->y1)));
        }
        qsort(things->codes, things->count, sizeof *things->codes, compare_codes);
    }
    const int shift = CODE_LEVEL - square->level;
    const uint64_t first = code_of(square->column << shift, square->row << shift);
    *count = count_below(things, first + (UINT64_C(1) << (2 * shift))) - count_below(things, first);
    return CAMBER_OK;
}

void camber_label_things_free(camber_label_things *things) {
    if (!things->context)
        return;
    camber_free(things->context, things->items);
    camber_free(things->context, things->class_first);
    camber_free(things->context, things->codes);
    *things = (camber_label_things){0};
}
