#include "map/plan.h"

#include <math.h>
#include <string.h>

/* The widest that a stroke may be: camber.h. */
static const double WIDEST_PX = 16384.0;
static const size_t MOST_ROWS = (size_t)1 << 24;

/* The part of camber_style_layer_matches that needs no feature; a limit of 24 stands for none. */
static bool is_active(const camber_style_layer *layer, double zoom) {
    return layer->visible && layer->min_zoom <= zoom && (zoom < layer->max_zoom || layer->max_zoom >= 24.0);
}

static camber_feature_view view_of(const camber_features *features, const camber_feature_class *class) {
    return (camber_feature_view){
        .values = features->values ? features->values + class->first_value : NULL,
        .geometry_type = class->geometry == CAMBER_GEOMETRY_POLYGON ? "Polygon" : "LineString",
    };
}

static bool draws_class(const camber_features *features, const camber_style_layer *layer, double zoom,
                        const camber_feature_class *class) {
    if (layer->source_layer && strcmp(layer->source_layer, features->layer_names[class->layer]) != 0)
        return false;
    const camber_feature_view feature = view_of(features, class);
    return camber_style_layer_matches(layer, zoom, &feature);
}

/* ---- Background ---- */

static camber_color over(camber_color top, camber_color below) {
    const float rest = below.a * (1.0f - top.a), a = top.a + rest;
    if (a <= 0.0f)
        return (camber_color){0};
    return (camber_color){(top.r * top.a + below.r * rest) / a, (top.g * top.a + below.g * rest) / a,
                          (top.b * top.a + below.b * rest) / a, a};
}

/* Composes the backgrounds. An opaque one hides all layers before it, so the first layer to draw is returned. */
static size_t compose_background(camber_plan *plan, const camber_style *style, double zoom) {
    size_t first = 0, first_line = SIZE_MAX;
    for (size_t i = 0; i < style->layer_count; i++) {
        const camber_style_layer *layer = style->layers + i;
        if (!is_active(layer, zoom))
            continue;
        if (layer->kind == CAMBER_LAYER_LINE)
            first_line = first_line < i ? first_line : i;
        if (layer->kind != CAMBER_LAYER_BACKGROUND)
            continue;
        const camber_color color = camber_style_layer_paint(layer, zoom, NULL).color;
        plan->background = over(color, plan->background);
        if (color.a >= 1.0f) {
            first = i + 1;
            first_line = SIZE_MAX;
            plan->misplaced_background = false;
        } else if (color.a > 0.0f && first_line < i) {
            plan->misplaced_background = true;
        }
    }
    return first;
}

/* ---- Sets ---- */

static bool same_text(const char *a, const char *b) {
    return a == b || (a && b && strcmp(a, b) == 0);
}

static bool shares_polylines(const camber_style_layer *a, const camber_style_layer *b) {
    return a->cap == b->cap && a->join == b->join &&
           (a->join != CAMBER_JOIN_MITER || a->miter_limit == b->miter_limit) &&
           same_text(a->source_layer, b->source_layer) && same_text(a->filter_key, b->filter_key);
}

static camber_status group_layers(camber_plan *plan, const camber_style *style, size_t first, double zoom) {
    if (!(plan->layers = camber_alloc(plan->context, style->layer_count, sizeof *plan->layers)) ||
        !(plan->sets = camber_alloc_zero(plan->context, style->layer_count, sizeof *plan->sets)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = first; i < style->layer_count; i++) {
        const camber_style_layer *layer = style->layers + i;
        if (layer->kind != CAMBER_LAYER_LINE || !is_active(layer, zoom))
            continue;
        size_t s = 0;
        while (s < plan->set_count && !shares_polylines(plan->sets[s].layer, layer))
            s++;
        if (s == plan->set_count) {
            plan->sets[s] = (camber_plan_set){.layer = layer, .first_layer = plan->layer_count};
            plan->set_count++;
        }
        plan->layers[plan->layer_count++] = (camber_plan_layer){layer, s, plan->sets[s].layer_count++};
    }
    return CAMBER_OK;
}

/* ---- Rows ---- */

/* The paints of one class in all layers of a set, and a hash of rows to find an equal tuple by. */
typedef struct row_table {
    camber_paint *tuple;
    uint32_t *slots;   /* row + 1; 0: free */
    size_t slot_count; /* a power of two */
} row_table;

static camber_paint paint_of(const camber_style_layer *layer, const camber_view *view,
                             const camber_feature_view *feature) {
    const camber_layer_paint paint = camber_style_layer_paint(layer, camber_view_style_zoom(view), feature);
    const double width_px = paint.width * view->ratio;
    if (!(width_px > 0.0 && paint.color.a > 0.0f))
        return (camber_paint){0};
    return (camber_paint){(float)fmin(width_px, WIDEST_PX), paint.color};
}

/* The row of the tuple, a new one where no row of the set has these paints. */
static uint32_t intern_row(camber_plan *plan, camber_plan_set *set, row_table *table) {
    const size_t size_bytes = set->layer_count * sizeof *table->tuple;
    const uint64_t hash = camber_hash(CAMBER_HASH_START, table->tuple, size_bytes);
    size_t at = (size_t)(hash ^ hash >> 32) & (table->slot_count - 1);
    for (; table->slots[at]; at = (at + 1) & (table->slot_count - 1)) {
        const uint32_t row = table->slots[at] - 1;
        const camber_paint *paints = plan->paints + set->first_paint + (row - set->first_row) * set->layer_count;
        if (memcmp(paints, table->tuple, size_bytes) == 0)
            return row;
    }
    if (!camber_grow(plan->context, &plan->paints, &plan->paint_capacity, plan->paint_count + set->layer_count,
                     sizeof *plan->paints))
        return CAMBER_NO_ROW;
    memcpy(plan->paints + plan->paint_count, table->tuple, size_bytes);
    plan->paint_count += set->layer_count;
    for (size_t i = 0; i < set->layer_count; i++)
        set->width_px = fmaxf(set->width_px, table->tuple[i].width_px);
    const uint32_t row = (uint32_t)plan->row_count++;
    set->row_count++;
    table->slots[at] = row + 1;
    return row;
}

/* Rows of every class in one set: class_rows[class], CAMBER_NO_ROW where the set does not draw the class. */
static camber_status match_set(const camber_features *features, const camber_view *view, camber_plan *plan,
                               camber_plan_set *set, uint32_t *class_rows, row_table *table) {
    const size_t index = (size_t)(set - plan->sets);
    set->first_row = plan->row_count;
    set->first_paint = plan->paint_count;
    memset(table->slots, 0, table->slot_count * sizeof *table->slots);
    for (size_t c = 0; c < features->class_count; c++) {
        class_rows[c] = CAMBER_NO_ROW;
        const camber_feature_class *class = features->classes + c;
        if (!draws_class(features, set->layer, camber_view_style_zoom(view), class))
            continue;
        const camber_feature_view feature = view_of(features, class);
        bool drawn = false;
        size_t found = 0;
        for (size_t i = set->first_layer; found < set->layer_count; i++) {
            if (plan->layers[i].set != index)
                continue;
            const camber_paint paint = paint_of(plan->layers[i].layer, view, &feature);
            table->tuple[plan->layers[i].slot] = paint;
            drawn |= paint.width_px > 0.0f;
            found++;
        }
        if (!drawn)
            continue;
        if (plan->row_count >= MOST_ROWS)
            return camber_fail(plan->context, CAMBER_ERROR_LIMIT,
                               "style: more than %zu different widths and colours; let them depend on fewer properties",
                               MOST_ROWS);
        class_rows[c] = intern_row(plan, set, table);
        if (class_rows[c] == CAMBER_NO_ROW)
            return CAMBER_ERROR_MEMORY;
    }
    return CAMBER_OK;
}

/* ---- Entries: polylines by set, in input order ---- */

typedef struct set_pair {
    uint32_t set, pair;
} set_pair;

/* The sets that draw a class: [first[class], first[class + 1]) of pairs. */
typedef struct class_sets {
    size_t *first;
    set_pair *pairs;
} class_sets;

/* Numbers the pairs of sets and classes, by set. */
static camber_status number_pairs(const camber_features *features, camber_plan *plan, const uint32_t *class_rows) {
    const size_t class_count = features->class_count;
    size_t total = 0;
    for (size_t i = 0; i < plan->set_count * class_count; i++)
        total += class_rows[i] != CAMBER_NO_ROW;
    if (total >= MOST_ROWS)
        return camber_fail(plan->context, CAMBER_ERROR_LIMIT,
                           "style: more than %zu combinations of layers and properties; let filters depend on fewer",
                           MOST_ROWS);
    plan->pair_rows = camber_alloc(plan->context, total, sizeof *plan->pair_rows);
    if (!plan->pair_rows)
        return CAMBER_ERROR_MEMORY;
    plan->key = camber_hash(CAMBER_HASH_START, &features->polyline_count, sizeof features->polyline_count);
    for (size_t s = 0; s < plan->set_count; s++) {
        plan->sets[s].first_pair = plan->pair_count;
        for (size_t c = 0; c < class_count; c++) {
            const uint32_t row = class_rows[s * class_count + c];
            if (row == CAMBER_NO_ROW)
                continue;
            const size_t pair[2] = {s, c};
            plan->key = camber_hash(plan->key, pair, sizeof pair);
            plan->pair_rows[plan->pair_count++] = row;
        }
        plan->sets[s].pair_count = plan->pair_count - plan->sets[s].first_pair;
    }
    return CAMBER_OK;
}

static camber_status group_by_class(const camber_features *features, const camber_plan *plan,
                                    const uint32_t *class_rows, class_sets *by_class) {
    const size_t class_count = features->class_count;
    by_class->first = camber_alloc(plan->context, class_count + 1, sizeof *by_class->first);
    if (!by_class->first)
        return CAMBER_ERROR_MEMORY;
    size_t total = 0;
    for (size_t c = 0; c < class_count; c++) {
        by_class->first[c] = total;
        for (size_t s = 0; s < plan->set_count; s++)
            total += class_rows[s * class_count + c] != CAMBER_NO_ROW;
    }
    by_class->first[class_count] = total;
    by_class->pairs = camber_alloc(plan->context, total, sizeof *by_class->pairs);
    if (!by_class->pairs)
        return CAMBER_ERROR_MEMORY;
    /* By set: each class takes its pairs in turn, as they are numbered. */
    uint32_t pair = 0;
    for (size_t s = 0; s < plan->set_count; s++)
        for (size_t c = 0; c < class_count; c++)
            if (class_rows[s * class_count + c] != CAMBER_NO_ROW)
                by_class->pairs[by_class->first[c]++] = (set_pair){(uint32_t)s, pair++};
    for (size_t c = class_count; c > 0; c--)
        by_class->first[c] = by_class->first[c - 1];
    by_class->first[0] = 0;
    return CAMBER_OK;
}

static camber_status list_entries(const camber_features *features, camber_plan *plan, const class_sets *by_class) {
    if (features->polyline_count > UINT32_MAX)
        return camber_fail(plan->context, CAMBER_ERROR_LIMIT, "%zu polylines are more than 2^32; draw them in parts",
                           features->polyline_count);
    for (size_t p = 0; p < features->polyline_count; p++) {
        const uint32_t class = features->feature_class[features->polyline_feature[p]];
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
    return CAMBER_OK;
}

camber_status camber_plan_create(const camber_features *features, const camber_view *view, camber_plan *plan) {
    camber_context *context = features->context;
    const double zoom = camber_view_style_zoom(view);
    *plan = (camber_plan){.context = context};
    const size_t first = compose_background(plan, features->style, zoom);
    camber_status status = group_layers(plan, features->style, first, zoom);
    if (status != CAMBER_OK)
        return status;

    uint32_t *class_rows = NULL;
    class_sets by_class = {0};
    row_table table = {.slot_count = 16};
    while (table.slot_count / 2 < features->class_count)
        table.slot_count *= 2;
    status = CAMBER_ERROR_MEMORY;
    /* Of rows one more than needed, so that no element is empty; classes are in memory: their count cannot overflow. */
    if (!(table.tuple = camber_alloc(context, plan->layer_count, sizeof *table.tuple)) ||
        !(table.slots = camber_alloc(context, table.slot_count, sizeof *table.slots)) ||
        !(class_rows = camber_alloc(context, plan->set_count, (features->class_count + 1) * sizeof *class_rows)))
        goto done;
    for (size_t s = 0; s < plan->set_count; s++) {
        status = match_set(features, view, plan, plan->sets + s, class_rows + s * features->class_count, &table);
        if (status != CAMBER_OK)
            goto done;
    }
    status = number_pairs(features, plan, class_rows);
    if (status == CAMBER_OK)
        status = group_by_class(features, plan, class_rows, &by_class);
    if (status == CAMBER_OK)
        status = list_entries(features, plan, &by_class);
done:
    camber_free(context, by_class.pairs);
    camber_free(context, by_class.first);
    camber_free(context, class_rows);
    camber_free(context, table.slots);
    camber_free(context, table.tuple);
    return status;
}

void camber_plan_destroy(camber_plan *plan) {
    camber_free(plan->context, plan->entries);
    camber_free(plan->context, plan->pair_rows);
    camber_free(plan->context, plan->paints);
    camber_free(plan->context, plan->sets);
    camber_free(plan->context, plan->layers);
}
