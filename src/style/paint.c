/* Evaluates how a layer draws a feature. Properties that do not depend on features are evaluated only once.
 *
 * Input: a compiled layer, a zoom, a feature. Output: camber_layer_paint. */
#include "style/properties.h"

#include <math.h>

static bool passes_filter(const camber_expression *filter, double zoom, const camber_feature_view *feature) {
    return !filter || camber_filter_passes(filter, zoom, feature);
}

bool camber_style_layer_matches(const camber_style_layer *layer, double zoom, const camber_feature_view *feature) {
    /* A max_zoom of 24, the largest that a style can have, means no limit. */
    if (!layer->visible || zoom < layer->min_zoom || (zoom >= layer->max_zoom && layer->max_zoom < 24.0))
        return false;
    return passes_filter(layer->filter, zoom, feature);
}

bool camber_style_layer_takes(const camber_style_layer *layer, const camber_feature_view *feature) {
    const bool at_some_zoom = layer->kind == CAMBER_LAYER_SYMBOL && layer->filter && layer->filter->reads_zoom;
    return layer->visible && (at_some_zoom || passes_filter(layer->filter, layer->min_zoom, feature));
}

bool camber_style_source_matches(const camber_style_source *source, const camber_feature_view *feature) {
    return passes_filter(source->filter, 0.0, feature);
}

static bool store_number(const camber_property_row *row, const camber_value *value, double *number) {
    const camber_property *property = &row->property;
    if (value->type != CAMBER_VALUE_NUMBER || !isfinite(value->number))
        return false;
    const bool ranged = property->low < 0.0 || property->high > 0.0;
    *number = ranged ? fmin(fmax(value->number, property->low), property->high) : value->number;
    return true;
}

static bool store_bool(const camber_value *value, bool *field) {
    if (value->type != CAMBER_VALUE_BOOL)
        return false;
    *field = value->boolean;
    return true;
}

static bool store_choice(const camber_property_row *row, const camber_value *value, void *field) {
    _Static_assert(sizeof(int) == sizeof(camber_cap) && sizeof(int) == sizeof(camber_join) &&
                       sizeof(int) == sizeof(camber_translate_anchor),
                   "choices are ints");
    for (int i = 0; value->type == CAMBER_VALUE_STRING && row->property.values[i]; i++)
        if (strcmp(row->property.values[i], value->string) == 0) {
            memcpy(field, &i, sizeof i);
            return true;
        }
    return false;
}

enum { NUMBERS_MAX = 4 };

static bool store_numbers(const camber_property_row *row, const camber_value *value, uint32_t count, double *numbers) {
    double made[NUMBERS_MAX];
    if (value->type != CAMBER_VALUE_ARRAY || value->count != count || count > NUMBERS_MAX)
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (!store_number(row, value->items + i, made + i))
            return false;
    memcpy(numbers, made, count * sizeof *made);
    return true;
}

/* A style's list of odd length begins and ends with a dash, which run into each other where the list repeats, so a gap
 * of 0 is added between them. A single length is a solid line. */
static void close_dashes(camber_layer_dashes *dashes) {
    _Static_assert(CAMBER_DASH_LENGTHS_MAX % 2 == 0, "an odd list has room for one more length");
    if (dashes->count == 1)
        dashes->count = 0;
    else if (dashes->count % 2)
        dashes->lengths[dashes->count++] = 0.0f;
}

/* Stores dashes. If no length is above 0, or one is below 0, the line is solid. If there are too many lengths, only the
 * first ones are used. */
static bool store_dashes(const camber_property_row *row, const camber_value *value, camber_layer_dashes *dashes) {
    double sum = 0.0;
    if (value->type != CAMBER_VALUE_ARRAY)
        return false;
    const uint32_t count = value->count < CAMBER_DASH_LENGTHS_MAX ? value->count : CAMBER_DASH_LENGTHS_MAX;
    for (uint32_t i = 0; i < count; i++) {
        double length;
        if (!store_number(row, value->items + i, &length) || value->items[i].number < 0.0)
            return false;
        sum += length;
        dashes->lengths[i] = (float)fmin(length, 1e6);
    }
    dashes->count = sum > 0.0 ? count : 0;
    close_dashes(dashes);
    return true;
}

bool camber_property_store(const camber_property_row *row, const camber_value *value, void *field) {
    switch (row->property.type) {
    case CAMBER_TYPE_NUMBER: return store_number(row, value, field);
    case CAMBER_TYPE_BOOL: return store_bool(value, field);
    case CAMBER_TYPE_STRING: return store_choice(row, value, field);
    case CAMBER_TYPE_ARRAY:
        return row->property.length == 0 ? store_dashes(row, value, field)
                                         : store_numbers(row, value, row->property.length, field);
    case CAMBER_TYPE_PADDING: return store_numbers(row, value, 4, field);
    default: break;
    }
    if (value->type == CAMBER_VALUE_COLOR)
        memcpy(field, &value->color, sizeof value->color);
    return value->type == CAMBER_VALUE_COLOR;
}

/* Stores a property in its field of the paint. If the property cannot be evaluated, the field keeps its default. */
static void store_property(const camber_style_layer *layer, unsigned id, camber_evaluation *evaluation,
                           camber_layer_paint *paint) {
    const camber_property_row *row = camber_property_rows + id;
    camber_value value;
    if (camber_expression_evaluate(layer->properties[id], evaluation, &value))
        camber_property_store(row, &value, (char *)paint + row->offset);
}

camber_layer_look camber_style_layer_look(const camber_style_layer *layer, double zoom) {
    camber_layer_look look = {.layer = layer, .zoom = zoom, .paint = camber_default_paint};
    camber_evaluation evaluation;
    camber_evaluation_begin(&evaluation, zoom, NULL);
    for (unsigned i = 0; i < CAMBER_PROPERTIES; i++) {
        const camber_expression *expression = layer->properties[i];
        if (!expression || camber_property_rows[i].offset == CAMBER_NO_OFFSET)
            continue;
        look.reads_feature |= expression->reads_feature;
        if (expression->reads_feature)
            camber_property_set_add(&look.by_feature, (camber_property_id)i);
        else
            store_property(layer, i, &evaluation, &look.paint);
    }
    camber_evaluation_end(&evaluation);
    return look;
}

/* Computes the colour of a border that has none of its own: darker than the line, or brighter if the line is dark. */
camber_color camber_border_color(camber_color color) {
    const float luminance = 0.2126f * color.r + 0.7152f * color.g + 0.0722f * color.b;
    const bool dark = luminance < 0.25f, black = luminance <= 0.0f;
    const float factor = !dark ? 0.6f : black ? 0.0f : 1.0f + 0.5f / luminance, more = black ? 0.45f : 0.0f;
    return (camber_color){fminf(factor * color.r + more, 1.0f), fminf(factor * color.g + more, 1.0f),
                          fminf(factor * color.b + more, 1.0f), 1.0f};
}

camber_layer_paint camber_layer_look_paint(const camber_layer_look *look, const camber_feature_view *feature) {
    camber_layer_paint paint = look->paint;
    if (look->reads_feature) {
        camber_evaluation evaluation;
        camber_evaluation_begin(&evaluation, look->zoom, feature);
        for (unsigned i = 0; i < CAMBER_PROPERTIES; i++)
            if (camber_property_set_has(&look->by_feature, (camber_property_id)i))
                store_property(look->layer, i, &evaluation, &paint);
        camber_evaluation_end(&evaluation);
    }
    if (paint.border_width > 0.0 && paint.border_color.a <= 0.0f) {
        paint.border_color = camber_border_color(paint.color);
        paint.border_color.a = paint.color.a;
    }
    paint.border_color.a *= (float)paint.opacity;
    paint.color.a *= (float)paint.opacity;
    paint.stroke_color.a *= (float)paint.stroke_opacity;
    return paint;
}

camber_layer_paint camber_style_layer_paint(const camber_style_layer *layer, double zoom,
                                            const camber_feature_view *feature) {
    const camber_layer_look look = camber_style_layer_look(layer, zoom);
    return camber_layer_look_paint(&look, feature);
}

bool camber_style_layer_pattern(const camber_style_layer *layer, double zoom, const camber_feature_view *feature,
                                const camber_style_images *images, uint32_t *image) {
    static const camber_property_id patterns[CAMBER_LAYER_CIRCLE] = {[CAMBER_LAYER_BACKGROUND] =
                                                                         CAMBER_BACKGROUND_PATTERN,
                                                                     [CAMBER_LAYER_LINE] = CAMBER_LINE_PATTERN,
                                                                     [CAMBER_LAYER_FILL] = CAMBER_FILL_PATTERN};
    const camber_expression *pattern =
        layer->kind < CAMBER_LAYER_CIRCLE ? layer->properties[patterns[layer->kind]] : NULL;
    camber_evaluation evaluation;
    camber_value value;
    *image = 0;
    if (!pattern)
        return false;
    camber_evaluation_begin(&evaluation, zoom, feature);
    evaluation.images = images;
    if (camber_expression_evaluate(pattern, &evaluation, &value) && value.type == CAMBER_VALUE_STRING &&
        value.string[0]) {
        *image = images->find(images->user, value.string);
        if (!*image)
            images->missing(images->user, value.string);
    }
    camber_evaluation_end(&evaluation);
    return true;
}

/* Whether the miter and round limits of both layers have the same effect on their common join. */
static bool join_ignores(const camber_layer_paint *p, const camber_layer_paint *q) {
    switch (p->join) {
    case CAMBER_JOIN_MITER: return p->miter_limit == q->miter_limit;
    case CAMBER_JOIN_ROUND:
        return p->round_limit == q->round_limit && fmin(p->miter_limit, q->miter_limit) >= p->round_limit;
    case CAMBER_JOIN_BEVEL: break;
    }
    return true;
}

bool camber_layer_look_shares(const camber_layer_look *a, const camber_layer_look *b) {
    for (unsigned i = 0; i < CAMBER_LAYER_GEOMETRY; i++) {
        const bool driven = camber_property_set_has(&a->by_feature, (camber_property_id)i);
        if (driven != camber_property_set_has(&b->by_feature, (camber_property_id)i) ||
            (driven && !json_equal(a->layer->properties[i]->document, b->layer->properties[i]->document)))
            return false;
    }
    /* Properties that depend on features still have their defaults in both looks. */
    const camber_layer_paint *p = &a->paint, *q = &b->paint;
    const bool driven = camber_property_set_has(&a->by_feature, CAMBER_LINE_JOIN);
    const bool limits = p->round_limit == q->round_limit && p->miter_limit == q->miter_limit;
    return p->cap == q->cap && p->join == q->join && (limits || (!driven && join_ignores(p, q))) &&
           p->offset == q->offset && p->sort_key == q->sort_key;
}

bool camber_style_layer_may_take(const camber_style_layer *layer, const char *type) {
    return layer->visible && (!layer->filter || camber_filter_may_take(layer->filter->document, type));
}
