/* Fills in a style's schema, and makes sets of features for a style.
 *
 * Input: a style whose layers are compiled. Output: what the schema says about its layers. The compiler has already
 * added the properties, and which layers read them. */
#include "features/features.h"
#include "style/expression.h"
#include "style/symbol.h"

#include <math.h>
#include <string.h>

unsigned camber_style_layer_kinds(camber_layer_kind kind) {
    switch (kind) {
    case CAMBER_LAYER_BACKGROUND: break;
    case CAMBER_LAYER_LINE:
    case CAMBER_LAYER_CIRCLE: return CAMBER_KIND_LINE | CAMBER_KIND_POLYGON | CAMBER_KIND_POINT;
    case CAMBER_LAYER_FILL: return CAMBER_KIND_POLYGON | CAMBER_KIND_AREA | CAMBER_KIND_POINT;
    case CAMBER_LAYER_SYMBOL: return CAMBER_KINDS_OF_LABELS;
    }
    return 0;
}

static void find_label_wants(const camber_style_layer *layer, camber_schema *schema) {
    if (!layer->properties[CAMBER_TEXT_FIELD] && !layer->properties[CAMBER_ICON_IMAGE])
        return;
    schema->wants_label_lines |= camber_style_layer_may_take(layer, "LineString");
    schema->wants_label_areas |= camber_style_layer_may_take(layer, "Polygon");
    schema->wants_label_points |= camber_style_layer_may_take(layer, "Point");
    schema->labels_directed |= camber_style_layer_turns_icons(layer);
}

/* Finds which geometries other than lines are drawn. */
static void find_wants(const camber_style *style, camber_schema *schema) {
    schema->wants_polygons = schema->wants_areas = schema->wants_points = false;
    schema->wants_label_lines = schema->wants_label_areas = schema->wants_label_points = false;
    schema->labels_directed = false;
    schema->wants_plain = schema->wants_plain_areas = schema->wants_plain_points = false;
    for (size_t i = 0; i < style->layer_count; i++) {
        const camber_style_layer *layer = style->layers + i;
        if (layer->kind == CAMBER_LAYER_SYMBOL) {
            find_label_wants(layer, schema);
            continue;
        }
        const bool polygons = layer->kind != CAMBER_LAYER_BACKGROUND && camber_style_layer_may_take(layer, "Polygon");
        const bool fills = polygons && layer->kind == CAMBER_LAYER_FILL, circles = layer->kind == CAMBER_LAYER_CIRCLE;
        const bool outlines = polygons && (!fills || layer->properties[CAMBER_FILL_OUTLINE_COLOR]);
        if (!layer->plain) {
            schema->wants_areas |= fills;
            schema->wants_polygons |= outlines;
            schema->wants_points |= circles && camber_style_layer_may_take(layer, "Point");
            continue;
        }
        schema->wants_plain |= layer->visible;
        schema->wants_plain_areas |= polygons;
        schema->wants_plain_points |=
            (circles || layer->kind == CAMBER_LAYER_LINE) && camber_style_layer_may_take(layer, "Point");
    }
}

static void list_source_layers(const camber_style *style, camber_schema *schema) {
    enum { DRAWN, LABELLED, HIDDEN, RANKS };
    size_t ends[RANKS] = {0};
    schema->source_layer_count = 0;
    for (int rank = 0; rank < RANKS; rank++) {
        for (size_t i = 0; i < style->layer_count; i++) {
            const camber_style_layer *layer = style->layers + i;
            const int own = !layer->visible ? HIDDEN : layer->kind == CAMBER_LAYER_SYMBOL ? LABELLED : DRAWN;
            if (layer->source_layer && own == rank)
                schema->source_layers[schema->source_layer_count++] = layer->source_layer;
        }
        ends[rank] = schema->source_layer_count;
    }
    schema->drawn_source_layer_count = ends[DRAWN];
    schema->label_source_layer_count = ends[LABELLED] - ends[DRAWN];
}

/* Whether any layer that is not plain draws the feature. Only plain line layers draw points. Symbol layers draw only
 * label kinds. */
static bool takes(const camber_style *style, camber_geometry_kind kind, const char *source_layer,
                  const camber_feature_view *feature) {
    for (size_t i = 0; i < style->layer_count; i++) {
        const camber_style_layer *layer = style->layers + i;
        const bool fits = kind == CAMBER_GEOMETRY_POINT ? layer->kind == CAMBER_LAYER_CIRCLE
                                                        : camber_style_layer_kinds(layer->kind) >> kind & 1;
        if (fits && !layer->plain && (!layer->source_layer || strcmp(layer->source_layer, source_layer) == 0) &&
            camber_style_layer_takes(layer, feature) &&
            (layer->kind != CAMBER_LAYER_SYMBOL || camber_style_layer_may_label(layer, feature)))
            return true;
    }
    return false;
}

/* Sort keys beyond this are cut off, so that layers do not mix. */
static const double KEYS_A_LAYER = 4096.0;

/* Whether a layer tucks the ends of a line. A filter that depends on the zoom may take it at the highest one only. */
static bool tucks(const camber_style_layer *layer, const char *source_layer, const camber_feature_view *feature) {
    return layer->tucks && (!layer->source_layer || strcmp(layer->source_layer, source_layer) == 0) &&
           (camber_style_layer_takes(layer, feature) ||
            (layer->filter && layer->filter->reads_zoom &&
             camber_style_layer_matches(layer, nextafter(layer->max_zoom, 0.0), feature)));
}

static double rank_ends(const camber_style *style, const char *source_layer, const camber_feature_view *feature) {
    for (size_t i = style->layer_count; i-- > 0;) {
        const camber_style_layer *layer = style->layers + i;
        if (!tucks(layer, source_layer, feature))
            continue;
        const double key = camber_style_layer_paint(layer, layer->min_zoom, feature).sort_key;
        return 2.0 * KEYS_A_LAYER * (double)(i + 1) + fmin(fmax(key, -KEYS_A_LAYER), KEYS_A_LAYER);
    }
    return CAMBER_NO_RANK;
}

void camber_style_describe_layers(camber_style *style) {
    find_wants(style, &style->schema);
    list_source_layers(style, &style->schema);
    style->schema.takes = takes;
    style->schema.rank_ends = NULL;
    for (size_t i = 0; i < style->layer_count; i++)
        if (style->layers[i].tucks)
            style->schema.rank_ends = rank_ends;
}

camber_status camber_features_create(camber_context *context, const camber_style *style, camber_features **features) {
    return camber_features_create_for(context, &style->schema, style, features);
}

/* Whether both styles name the same sprites, so that the images that were read serve the other one, too. */
static bool has_same_sprites(const camber_style *one, const camber_style *other) {
    bool same = one->sprite_count == other->sprite_count;
    for (size_t i = 0; same && i < one->sprite_count; i++)
        same = strcmp(one->sprites[i].id, other->sprites[i].id) == 0 &&
               strcmp(one->sprites[i].url, other->sprites[i].url) == 0;
    return same;
}

camber_status camber_features_restyle(camber_features *features, const camber_style *style) {
    if (!has_same_sprites(features->style, style) || !camber_features_suit(features, &style->schema, style))
        return camber_fail(features->context, CAMBER_ERROR_ARGUMENT,
                           "style: it reads other properties or images than the previous style; read the files again");
    features->schema = &style->schema;
    features->style = style;
    features->changes++;
    return CAMBER_OK;
}
