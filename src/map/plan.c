/* Makes the plan of a scene: evaluates the style at a view's zoom, once for each set of layers and each class of
 * features.
 *
 * Input: features with their style, and a view. Output: camber_plan. Layers that may share polylines are put into sets.
 * Each set evaluates its layers for each class, and equal results become one row. Then the polylines are listed by set,
 * as entries. A city of 50,000 ways has a few hundred classes, so there are few rows, and the number of evaluations
 * does not grow with the number of features. */
#include "map/plan.h"

#include "base/maths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The round ends of thinner lines are not drawn, since nobody sees them. */
static const float THINNEST_END_PX = 2.0f;
/* The largest width of a stroke, as in camber.h. */
static const double WIDEST_PX = 16384.0;
static const size_t MOST_ROWS = (size_t)1 << 24, MOST_MATCHES = (size_t)1 << 26;

/* Does the part of camber_style_layer_matches that needs no feature. A max_zoom of 24 means no limit. */
static bool is_active(const camber_style_layer *layer, double zoom) {
    return layer->visible && layer->min_zoom <= zoom && (zoom < layer->max_zoom || layer->max_zoom >= 24.0);
}

camber_feature_view camber_plan_view_of(const camber_features *features, const camber_feature_class *class) {
    return (camber_feature_view){
        .values = features->values ? features->values + class->first_value : NULL,
        .geometry_type = camber_geometry_type(class->geometry),
        .id = class->id,
        .all = class->all,
    };
}

/* Areas are filled. The outlines of polygons are also lines. Points are drawn only by circles, and by plain layers as
 * dots, which are round caps. Circles are drawn at all points of any geometry, and the ends of lines by layers that
 * tuck them. */
static bool takes_kind(const camber_style_layer *layer, camber_plan_part part, const camber_feature_class *class) {
    const camber_geometry_kind kind = class->geometry;
    if (class->is_ends)
        return layer->tucks && part <= CAMBER_PLAN_BORDER;
    if (part == CAMBER_PLAN_AREA)
        return kind == CAMBER_GEOMETRY_AREA;
    if (part == CAMBER_PLAN_OUTLINE)
        return kind == CAMBER_GEOMETRY_POLYGON;
    const bool points = part == CAMBER_PLAN_CIRCLES || layer->plain;
    return kind == CAMBER_GEOMETRY_LINE || kind == CAMBER_GEOMETRY_POLYGON || (kind == CAMBER_GEOMETRY_POINT && points);
}

bool camber_plan_comes_to(const camber_features *features, const camber_style_layer *layer,
                          const camber_feature_class *class) {
    if (layer->plain && !class->plain)
        return false;
    if (class->source != CAMBER_NO_SOURCE && class->source != layer->source_index)
        return false;
    return !layer->source_layer || strcmp(layer->source_layer, features->layer_names[class->layer]) == 0;
}

/* Returns the main part of a layer, the one that gives the layer type its name. */
static camber_plan_part part_of(const camber_style_layer *layer) {
    return layer->kind == CAMBER_LAYER_FILL     ? CAMBER_PLAN_AREA
           : layer->kind == CAMBER_LAYER_CIRCLE ? CAMBER_PLAN_CIRCLES
                                                : CAMBER_PLAN_LINE;
}

bool camber_plan_labels(const camber_features *features, const camber_style_layer *layer, double zoom,
                        const camber_feature_class *class) {
    if (layer->kind != CAMBER_LAYER_SYMBOL || !class->labelled || !camber_plan_comes_to(features, layer, class))
        return false;
    const camber_feature_view feature = camber_plan_view_of(features, class);
    return camber_style_layer_matches(layer, zoom, &feature);
}

bool camber_plan_takes(const camber_features *features, const camber_style_layer *layer, double zoom,
                       const camber_feature_class *class) {
    const bool outlined = layer->kind == CAMBER_LAYER_FILL && layer->properties[CAMBER_FILL_OUTLINE_COLOR];
    const bool fits =
        takes_kind(layer, part_of(layer), class) || (outlined && takes_kind(layer, CAMBER_PLAN_OUTLINE, class));
    if (layer->kind == CAMBER_LAYER_BACKGROUND || layer->kind == CAMBER_LAYER_SYMBOL || !fits ||
        !camber_plan_comes_to(features, layer, class))
        return false;
    const camber_feature_view feature = camber_plan_view_of(features, class);
    return camber_style_layer_matches(layer, zoom, &feature);
}

static bool draws_class(const camber_features *features, const camber_plan_layer *drawn, const camber_view *view,
                        const camber_feature_class *class) {
    const camber_style_layer *layer = drawn->look.layer;
    if (!takes_kind(layer, drawn->part, class) || !camber_plan_comes_to(features, layer, class))
        return false;
    const camber_feature_view feature = camber_plan_view_of(features, class);
    return camber_style_layer_matches(layer, camber_view_style_zoom(view), &feature);
}

/* ---- Background ---- */

/* Finds the first layer to draw: an opaque background hides all layers before it. */
static size_t find_first(const camber_style *style, double zoom) {
    for (size_t i = style->layer_count; i-- > 0;) {
        const camber_style_layer *layer = style->layers + i;
        if (layer->kind == CAMBER_LAYER_BACKGROUND && is_active(layer, zoom) &&
            !layer->properties[CAMBER_BACKGROUND_PATTERN] &&
            camber_style_layer_paint(layer, zoom, NULL).color.a >= 1.0f)
            return i;
    }
    return 0;
}

/* ---- Sets ---- */

static bool same_text(const char *a, const char *b) {
    return a == b || (a && b && strcmp(a, b) == 0);
}

static bool shares_polylines(const camber_plan_layer *one, const camber_plan_layer *other) {
    const camber_style_layer *a = one->look.layer, *b = other->look.layer;
    const bool same_part =
        one->part == other->part || (one->part <= CAMBER_PLAN_BORDER && other->part <= CAMBER_PLAN_BORDER);
    return same_part && a->plain == b->plain && a->tucks == b->tucks && a->least_area == b->least_area &&
           a->source_index == b->source_index && same_text(a->source_layer, b->source_layer) &&
           same_text(a->filter_key, b->filter_key) && camber_layer_look_shares(&one->look, &other->look);
}

/* A hash table of sets. The key is what layers must have in common to share one, so that the time grows only linearly
 * with the number of layers. */
typedef struct set_table {
    uint32_t *slots;   /* set + 1; 0: free */
    size_t slot_count; /* a power of two */
} set_table;

static uint64_t set_hash(const camber_style_layer *layer) {
    const char *source_layer = layer->source_layer ? layer->source_layer : "";
    uint64_t hash = camber_hash(CAMBER_HASH_START, &layer->source_index, sizeof layer->source_index);
    hash = camber_hash(hash, source_layer, strlen(source_layer) + 1);
    return camber_hash(hash, layer->filter_key, strlen(layer->filter_key));
}

/* Finds the slot of the set that the layer can share, or an empty slot for a new set. */
static uint32_t *find_set(const camber_plan *plan, const set_table *table, const camber_plan_layer *layer) {
    const uint64_t hash = set_hash(layer->look.layer);
    size_t at = (size_t)(hash ^ hash >> 32) & (table->slot_count - 1);
    while (table->slots[at] && !shares_polylines(plan->layers + plan->sets[table->slots[at] - 1].first_layer, layer))
        at = (at + 1) & (table->slot_count - 1);
    return table->slots + at;
}

/* Computes the translation. If it is anchored to the map, it rotates with the map. */
static void find_translation(const camber_layer_look *look, const camber_view *view, float translate_px[2]) {
    const bool turns = look->paint.translate_anchor == CAMBER_TRANSLATE_MAP;
    const double cosine = turns ? view->cosine : 1.0, sine = turns ? view->sine : 0.0;
    const double x = look->paint.translate[0] * view->ratio, y = look->paint.translate[1] * view->ratio;
    translate_px[0] = (float)fmin(fmax(x * cosine + y * sine, -WIDEST_PX), WIDEST_PX);
    translate_px[1] = (float)fmin(fmax(y * cosine - x * sine, -WIDEST_PX), WIDEST_PX);
}

static void find_ramp(camber_plan *plan, camber_plan_layer *layer) {
    const camber_style_layer *from = layer->look.layer;
    const camber_layer_ramp *ramp = layer->part == CAMBER_PLAN_BORDER ? &from->border_ramp : &from->ramp;
    layer->translucent_ramp = from->ramp.translucent;
    if (!ramp->count)
        return;
    camber_ramp *made = plan->ramps + plan->ramp_count++;
    *made = (camber_ramp){ramp->stops, ramp->count};
    layer->ramp = made;
}

/* Returns the least area of the rings that a layer fills or outlines. It changes at whole zooms only, so that between
 * them the same rings are drawn. */
static double least_area_of(const camber_plan_layer *layer) {
    const double px = CAMBER_WORLD_CSS_PX * camber_exp2(floor(layer->look.zoom));
    return layer->look.layer->kind == CAMBER_LAYER_FILL ? layer->look.layer->least_area / (px * px) : 0.0;
}

static void add_layer(camber_plan *plan, const set_table *table, const camber_style_layer *layer,
                      const camber_view *view, camber_plan_part part) {
    camber_plan_layer *made = plan->layers + plan->layer_count;
    *made = (camber_plan_layer){.look = camber_style_layer_look(layer, camber_view_style_zoom(view)), .part = part};
    if (layer->properties[CAMBER_LINE_DASHARRAY] || layer->properties[CAMBER_LINE_PATTERN])
        made->below = camber_style_layer_look(layer, floor(made->look.zoom));
    find_translation(&made->look, view, made->translate_px);
    find_ramp(plan, made);
    uint32_t *slot = find_set(plan, table, made);
    if (*slot == 0) {
        plan->sets[plan->set_count] = (camber_plan_set){
            .first_layer = plan->layer_count, .last_layer = plan->layer_count, .least_area = least_area_of(made)};
        *slot = (uint32_t)++plan->set_count;
    }
    made->set = *slot - 1;
    camber_plan_set *set = plan->sets + made->set;
    made->slot = set->layer_count++;
    plan->layers[set->last_layer].next = plan->layer_count;
    set->last_layer = plan->layer_count++;
}

static camber_status group_layers(camber_plan *plan, const camber_style *style, const camber_view *view) {
    const double zoom = camber_view_style_zoom(view);
    set_table table = {.slot_count = 16};
    while (table.slot_count / 4 < style->layer_count)
        table.slot_count *= 2;
    /* A line may add its border, and an area its outline. */
    if (!(plan->layers = camber_alloc(plan->context, style->layer_count, 2 * sizeof *plan->layers)) ||
        !(plan->ramps = camber_alloc(plan->context, style->layer_count, 2 * sizeof *plan->ramps)) ||
        !(plan->sets = camber_alloc_zero(plan->context, style->layer_count, 2 * sizeof *plan->sets)) ||
        !(table.slots = camber_alloc_zero(plan->context, table.slot_count, sizeof *table.slots)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = find_first(style, zoom); i < style->layer_count && !plan->patterns.failed; i++) {
        const camber_style_layer *layer = style->layers + i;
        if (!is_active(layer, zoom) || layer->kind == CAMBER_LAYER_SYMBOL)
            continue;
        if (layer->kind == CAMBER_LAYER_BACKGROUND) {
            camber_plan_patterns_add_background(&plan->patterns, layer, view, plan->layer_count, &plan->background);
            continue;
        }
        if (layer->properties[CAMBER_LINE_BORDER_WIDTH])
            add_layer(plan, &table, layer, view, CAMBER_PLAN_BORDER);
        add_layer(plan, &table, layer, view, part_of(layer));
        if (layer->properties[CAMBER_CIRCLE_STROKE_WIDTH])
            plan->dot_count = 2;
        if (layer->properties[CAMBER_FILL_OUTLINE_COLOR] && camber_style_layer_look(layer, zoom).paint.antialias)
            add_layer(plan, &table, layer, view, CAMBER_PLAN_OUTLINE);
    }
    camber_free(plan->context, table.slots);
    return plan->patterns.failed ? CAMBER_ERROR_MEMORY : CAMBER_OK;
}

/* ---- Rows ---- */

/* The stroke of one class in a set, its paints in all of the set's layers, and a hash table to find equal rows. */
typedef struct row_table {
    camber_stroke stroke;
    camber_paint *tuple;
    camber_plan_fill *areas; /* the fills of the tuple, if this is a set of areas */
    uint32_t *slots;         /* row + 1; 0: free */
    size_t slot_count;       /* a power of two */
    bool failed;             /* out of memory for dashes or patterns */
    bool of_stroke;          /* for circles: whether this dot is the stroke */
    bool is_ends;            /* for lines: whether the class is of their ends */
} row_table;

/* By set, class and dot: the row, or CAMBER_NO_ROW if the set does not draw it, and the key if the set is sorted. */
typedef struct plan_classes {
    uint32_t *rows;
    double *keys;
    uint32_t *drawn; /* the classes, except those of labels, which have neither rows nor keys */
    size_t drawn_count;
} plan_classes;

typedef struct class_rows {
    plan_classes by_class;
    row_table table;
} class_rows;

/* Returns the width that a paint covers, including its gap. */
static float whole_width(const camber_paint *paint) {
    return paint->gap_px > 0.0f ? paint->gap_px + 2.0f * paint->width_px : paint->width_px;
}

/* Returns the paint of one part of a layer: the line without its border, only the border, or an area's outline, which
 * is 1 px wide. The border is a wider line below; if it would shine through the line, it is two rails next to the line
 * instead. */
static camber_layer_paint paint_of_part(const camber_plan_layer *layer, const camber_layer_paint *whole) {
    camber_layer_paint own = *whole;
    if (layer->part == CAMBER_PLAN_OUTLINE) {
        own.color = whole->border_color;
        return own;
    }
    const double border = fmin(whole->border_width, 0.5 * whole->width), inside = whole->width - 2.0 * border;
    const float alpha = layer->ramp ? (float)whole->opacity : whole->color.a;
    const bool seen_through = alpha < 1.0f || layer->translucent_ramp || whole->layer_opacity < 1.0 ||
                              layer->look.layer->properties[CAMBER_LINE_PATTERN];
    if (layer->ramp)
        own.color = (camber_color){1.0f, 1.0f, 1.0f, (float)whole->opacity};
    if (layer->part == CAMBER_PLAN_BORDER) {
        own.color = layer->ramp ? own.color : whole->border_color;
        own.width = border > 0.0 ? whole->width : 0.0;
        if (seen_through && !(whole->gap_width > 0.0) && inside > 0.0 && border > 0.0) {
            own.width = border;
            own.gap_width = inside;
        }
    } else if (border > 0.0) {
        own.width = inside;
        own.gap_width = whole->gap_width > 0.0 ? whole->gap_width + 2.0 * border : 0.0;
    }
    return own;
}

/* Clears the whole struct first, including the padding, because rows are compared by the bytes of their paints. */
static void put_paint(const camber_plan_layer *layer, const camber_layer_paint *whole, double ratio,
                      camber_paint *paint) {
    const camber_layer_paint own = paint_of_part(layer, whole);
    const double widest_px = own.gap_width > 0.0 ? WIDEST_PX / 3.0 : WIDEST_PX; /* the largest width of one rail */
    memset(paint, 0, sizeof *paint);
    if (!(own.width * ratio > 0.0 && own.color.a > 0.0f && (float)own.layer_opacity > 0.0f))
        return;
    paint->width_px = (float)fmin(own.width * ratio, widest_px);
    paint->color = own.color;
    paint->gap_px = (float)fmin(own.gap_width * ratio, widest_px);
    paint->blur_px = (float)fmin(own.blur * ratio, WIDEST_PX);
    paint->translate_x_px = layer->translate_px[0];
    paint->translate_y_px = layer->translate_px[1];
    paint->trim_start = (float)whole->trim[0];
    paint->trim_end = (float)whole->trim[1];
    paint->ramp = layer->ramp;
}

/* Returns the half width of the dot that draws a circle of a radius, in px. As in MapLibre, circles fade out inside
 * their radius, by a smooth step over at least one pixel. The edge of a dot is as sharp as pixels allow, so the dot
 * gets the same area as the faded circle: the integral of 2 pi x step(r - x). Wider fades are drawn by the blur. */
static double dot_radius(double radius, double blur) {
    if (blur > 1.0)
        return fmax(radius - 0.5, 0.0);
    return radius >= 1.0 ? sqrt(radius * (radius - 1.0) + 0.3) : radius * radius * sqrt(0.5 - 0.2 * radius);
}

/* A circle's fill is a dot, and its stroke is a ring around it. If both are opaque and sharp, the stroke is a full dot
 * below the fill instead: with a ring, the background would show through pixels that both cut. */
static void put_circle(const camber_plan_layer *layer, const camber_layer_paint *whole, double ratio, bool of_stroke,
                       camber_paint *paint) {
    const camber_color color = of_stroke ? whole->stroke_color : whole->color;
    const double size = whole->radius + whole->stroke_width, blur = whole->blur * size * ratio;
    const double inner = dot_radius(whole->radius * ratio, blur), outer = dot_radius(size * ratio, blur);
    const bool solid = whole->color.a >= 1.0f && whole->stroke_color.a >= 1.0f && !(blur > 1.0);
    const bool is_ring = of_stroke && inner > 0.0 && !solid;
    memset(paint, 0, sizeof *paint);
    if (!((of_stroke ? whole->stroke_width : inner) > 0.0 && color.a > 0.0f))
        return;
    const double width = is_ring ? outer - inner : 2.0 * (of_stroke ? outer : inner);
    paint->width_px = (float)fmin(width, is_ring ? WIDEST_PX / 3.0 : WIDEST_PX);
    paint->gap_px = is_ring ? (float)fmin(2.0 * inner, WIDEST_PX / 3.0) : 0.0f;
    paint->color = color;
    paint->blur_px = (float)fmin(fmax(blur - 1.0, 0.0), WIDEST_PX);
    paint->smooth_blur = paint->blur_px > 0.0f;
    paint->translate_x_px = layer->translate_px[0];
    paint->translate_y_px = layer->translate_px[1];
}

static size_t dash_slot(const camber_plan *plan, const camber_layer_dashes *dashes) {
    const size_t size_bytes = dashes->count * sizeof *dashes->lengths;
    const uint64_t hash = camber_hash(CAMBER_HASH_START, dashes->lengths, size_bytes);
    size_t at = (size_t)(hash ^ hash >> 32) & (plan->dash_slot_count - 1);
    for (; plan->dash_slots[at]; at = (at + 1) & (plan->dash_slot_count - 1)) {
        const camber_layer_dashes *other = &plan->dashes[plan->dash_slots[at] - 1]->from;
        if (other->count == dashes->count && memcmp(other->lengths, dashes->lengths, size_bytes) == 0)
            break;
    }
    return at;
}

/* Keeps at least half of the slots free. */
static bool grow_dash_slots(camber_plan *plan) {
    if (plan->dash_slot_count > 2 * plan->dash_count)
        return true;
    const size_t count = plan->dash_slot_count ? 2 * plan->dash_slot_count : 16;
    uint32_t *slots = camber_alloc_zero(plan->context, count, sizeof *slots);
    if (!slots)
        return false;
    camber_free(plan->context, plan->dash_slots);
    plan->dash_slots = slots;
    plan->dash_slot_count = count;
    for (size_t i = 0; i < plan->dash_count; i++)
        slots[dash_slot(plan, &plan->dashes[i]->from)] = (uint32_t)i + 1;
    return true;
}

static camber_plan_dash *copy_dash(camber_context *context, const camber_layer_dashes *dashes) {
    camber_plan_dash *made = camber_alloc(context, 1, sizeof *made);
    if (!made)
        return NULL;
    made->from = *dashes;
    made->dash = (camber_dash){made->from.lengths, made->from.count};
    return made;
}

/* Finds the plan's dash of these lengths, or adds it. NULL: out of memory. */
static const camber_dash *intern_dash(camber_plan *plan, const camber_layer_dashes *dashes) {
    if (!grow_dash_slots(plan))
        return NULL;
    uint32_t *slot = plan->dash_slots + dash_slot(plan, dashes);
    if (*slot)
        return &plan->dashes[*slot - 1]->dash;
    if (!camber_grow(plan->context, &plan->dashes, &plan->dash_capacity, plan->dash_count + 1, sizeof *plan->dashes))
        return NULL;
    camber_plan_dash *made = copy_dash(plan->context, dashes);
    if (!made)
        return NULL;
    plan->dashes[plan->dash_count++] = made;
    *slot = (uint32_t)plan->dash_count;
    return &made->dash;
}

/* Returns the width at the next lower integer zoom, scaled with the map. Other engines draw dashes and patterns in that
 * width up to the next integer zoom. */
static float whole_zoom_px(const camber_plan_layer *layer, const camber_view *view,
                           const camber_feature_view *feature) {
    const double grown = camber_exp2(camber_view_style_zoom(view) - layer->below.zoom);
    return (float)fmin(fmax(camber_layer_look_paint(&layer->below, feature).width * grown * view->ratio, 1e-3),
                       WIDEST_PX);
}

typedef struct pattern_choice {
    bool patterned;            /* the style has a pattern */
    const camber_image *image; /* NULL: the sprites do not have the image */
    float one_px;              /* length of one image along the line, px */
} pattern_choice;

/* Chooses the pattern. With a pattern, only the opacity of the colour is used, and dashes are ignored. */
static pattern_choice choose_pattern(camber_plan *plan, const camber_plan_layer *layer, const camber_view *view,
                                     const camber_feature_view *feature, camber_layer_paint *paint) {
    pattern_choice choice = {0};
    const camber_sprite_image *found;
    if (layer->part == CAMBER_PLAN_OUTLINE)
        return choice;
    choice.patterned =
        camber_plan_patterns_find(&plan->patterns, layer->look.layer, floor(layer->look.zoom), feature, &found);
    if (!choice.patterned)
        return choice;
    paint->color.a = (float)paint->opacity;
    if (found) {
        choice.image = &found->image;
        choice.one_px = (float)found->width / (float)found->height * whole_zoom_px(layer, view, feature);
    }
    return choice;
}

static void put_pattern(const camber_plan_layer *layer, const pattern_choice *choice, camber_paint *paint) {
    if (!choice->image)
        memset(paint, 0, sizeof *paint);
    if (layer->part != CAMBER_PLAN_LINE || !(paint->width_px > 0.0f))
        return;
    paint->image = choice->image;
    paint->ramp = NULL;
    paint->image_px = choice->one_px;
}

/* Clears the whole struct first, because fills are also compared by their bytes. A fill that draws nothing has alpha 0.
 */
static void put_area(camber_plan *plan, const camber_plan_layer *layer, const camber_view *view,
                     const camber_feature_view *feature, const camber_layer_paint *paint, camber_plan_fill *area) {
    const camber_sprite_image *image;
    memset(area, 0, sizeof *area);
    if (!((float)paint->layer_opacity > 0.0f))
        return;
    if (!camber_plan_patterns_find(&plan->patterns, layer->look.layer, floor(layer->look.zoom), feature, &image)) {
        area->fill.color = paint->color;
    } else if (image) {
        area->fill.color.a = (float)paint->opacity;
        area->image = image;
        memcpy(area->translate_px, layer->translate_px, sizeof area->translate_px);
        camber_plan_fill_place(area, view);
    }
}

/* Makes the stroke of a paint. A miter limit of 1 or less bevels every turn; 0 would mean the default. tucks: whether
 * round caps are dots of their own. */
static camber_stroke stroke_of(const camber_layer_paint *paint, double ratio, bool tucks) {
    return (camber_stroke){
        .join = paint->join,
        .cap = tucks && paint->cap == CAMBER_CAP_ROUND ? CAMBER_CAP_BUTT : paint->cap,
        .miter_limit = (float)fmin(fmax(paint->miter_limit, 1.0), 1e6),
        .offset_px = (float)fmin(fmax(paint->offset * ratio, -WIDEST_PX), WIDEST_PX),
        .round_limit = paint->join == CAMBER_JOIN_ROUND ? (float)fmin(fmax(paint->round_limit, 0.0), 1e6) : 0.0f};
}

/* Returns the round limit, or 0 if it makes no visible difference: drawing miters takes a tenth of a frame, which is
 * not worth it for tips of up to a quarter of a pixel. */
static float round_limit_that_shows(const camber_stroke *stroke) {
    const double limit = (double)stroke->round_limit, half_px = 0.5 * (double)stroke->width_px;
    const double turn = limit > 1.0 ? 2.0 * acos(1.0 / limit) : 0.0;
    return half_px * half_px * (tan(0.5 * turn) - 0.5 * turn) > 0.25 ? stroke->round_limit : 0.0f;
}

static bool same_row(const camber_plan *plan, const camber_plan_set *set, const row_table *table, size_t row) {
    const size_t at = (row - set->first_row) * set->layer_count;
    return memcmp(plan->strokes + row, &table->stroke, sizeof table->stroke) == 0 &&
           memcmp(plan->paints + set->first_paint + at, table->tuple, set->layer_count * sizeof *table->tuple) == 0 &&
           (!camber_plan_is_area(plan, set) || memcmp(plan->patterns.areas + set->first_area + at, table->areas,
                                                      set->layer_count * sizeof *table->areas) == 0);
}

/* Adds the tuple's fills to the plan's fills, at the same index as its paints. */
static bool add_areas(camber_plan *plan, const camber_plan_set *set, const row_table *table) {
    camber_plan_patterns *p = &plan->patterns;
    if (!camber_plan_is_area(plan, set))
        return true;
    if (!camber_grow(plan->context, &p->areas, &p->area_capacity, p->area_count + set->layer_count, sizeof *p->areas))
        return false;
    memcpy(p->areas + p->area_count, table->areas, set->layer_count * sizeof *p->areas);
    p->area_count += set->layer_count;
    return true;
}

/* Finds the row of the stroke and its paints, or adds it if the set has no equal row. */
static uint32_t intern_row(camber_plan *plan, camber_plan_set *set, row_table *table) {
    const size_t size_bytes = set->layer_count * sizeof *table->tuple;
    uint64_t hash = camber_hash(CAMBER_HASH_START, &table->stroke, sizeof table->stroke);
    hash = camber_hash(hash, table->tuple, size_bytes);
    if (camber_plan_is_area(plan, set))
        hash = camber_hash(hash, table->areas, set->layer_count * sizeof *table->areas);
    size_t at = (size_t)(hash ^ hash >> 32) & (table->slot_count - 1);
    for (; table->slots[at]; at = (at + 1) & (table->slot_count - 1))
        if (same_row(plan, set, table, table->slots[at] - 1))
            return table->slots[at] - 1;
    if (!camber_grow(plan->context, &plan->paints, &plan->paint_capacity, plan->paint_count + set->layer_count,
                     sizeof *plan->paints) ||
        !camber_grow(plan->context, &plan->strokes, &plan->stroke_capacity, plan->row_count + 1,
                     sizeof *plan->strokes) ||
        !add_areas(plan, set, table))
        return CAMBER_NO_ROW;
    memcpy(plan->paints + plan->paint_count, table->tuple, size_bytes);
    plan->paint_count += set->layer_count;
    plan->strokes[plan->row_count] = table->stroke;
    const uint32_t row = (uint32_t)plan->row_count++;
    set->row_count++;
    table->slots[at] = row + 1;
    return row;
}

/* Computes the paints and the stroke of a class. false: no layer of the set draws it. */
static bool fill_tuple(camber_plan *plan, const camber_plan_set *set, const camber_view *view,
                       const camber_feature_view *feature, row_table *table, double *key) {
    bool *failed = &table->failed;
    size_t at = set->first_layer;
    table->stroke.width_px = 0.0f;
    for (size_t i = 0; i < set->layer_count; i++, at = plan->layers[at].next) {
        const camber_plan_layer *layer = plan->layers + at;
        camber_layer_paint paint = camber_layer_look_paint(&layer->look, feature);
        camber_paint *made = table->tuple + layer->slot;
        const pattern_choice pattern = choose_pattern(plan, layer, view, feature, &paint);
        if (table->is_ends && paint.cap != CAMBER_CAP_ROUND)
            paint.width = 0.0;
        put_paint(layer, &paint, view->ratio, made);
        if (pattern.patterned)
            put_pattern(layer, &pattern, made);
        else if (paint.dashes.count && made->width_px > 0.0f) {
            made->dash = intern_dash(plan, &paint.dashes);
            made->dash_unit_px = whole_zoom_px(layer, view, feature);
            *failed |= !made->dash;
        }
        const float width_px = fmaxf(table->stroke.width_px, whole_width(made));
        table->stroke = stroke_of(&paint, view->ratio, layer->look.layer->tucks && !table->is_ends);
        table->stroke.width_px = width_px;
        table->stroke.round_limit = round_limit_that_shows(&table->stroke);
        *key = paint.sort_key;
        plan->has_arc_length |= made->dash || made->ramp || made->image || made->trim_end > made->trim_start;
        if (made->width_px > 0.0f)
            plan->translate_px = fmaxf(plan->translate_px, hypotf(made->translate_x_px, made->translate_y_px));
    }
    *failed |= plan->patterns.failed;
    return table->stroke.width_px > (table->is_ends ? THINNEST_END_PX : 0.0f) || *failed;
}

/* Computes the tuple of a class of areas; link_areas points the paints to their fills later. false: no layer draws it.
 */
static bool fill_areas(camber_plan *plan, const camber_plan_set *set, const camber_view *view,
                       const camber_feature_view *feature, row_table *table, double *key) {
    bool draws = false;
    size_t at = set->first_layer;
    table->stroke = (camber_stroke){0};
    for (size_t i = 0; i < set->layer_count; i++, at = plan->layers[at].next) {
        const camber_plan_layer *layer = plan->layers + at;
        const camber_layer_paint paint = camber_layer_look_paint(&layer->look, feature);
        camber_paint *made = table->tuple + layer->slot;
        camber_plan_fill *area = table->areas + layer->slot;
        memset(made, 0, sizeof *made);
        put_area(plan, layer, view, feature, &paint, area);
        *key = paint.sort_key;
        if (!(area->fill.color.a > 0.0f))
            continue;
        made->translate_x_px = layer->translate_px[0];
        made->translate_y_px = layer->translate_px[1];
        plan->translate_px = fmaxf(plan->translate_px, hypotf(made->translate_x_px, made->translate_y_px));
        draws = true;
    }
    table->failed |= plan->patterns.failed;
    return draws || table->failed;
}

/* Computes the tuple of a class of circles for one of their dots. false: no layer draws it. */
static bool fill_circles(camber_plan *plan, const camber_plan_set *set, const camber_view *view,
                         const camber_feature_view *feature, row_table *table, double *key) {
    size_t at = set->first_layer;
    table->stroke = (camber_stroke){.cap = CAMBER_CAP_ROUND, .join = CAMBER_JOIN_ROUND, .miter_limit = 2.0f};
    for (size_t i = 0; i < set->layer_count; i++, at = plan->layers[at].next) {
        const camber_plan_layer *layer = plan->layers + at;
        const camber_layer_paint paint = camber_layer_look_paint(&layer->look, feature);
        camber_paint *made = table->tuple + layer->slot;
        put_circle(layer, &paint, view->ratio, table->of_stroke, made);
        table->stroke.width_px = fmaxf(table->stroke.width_px, whole_width(made));
        *key = paint.sort_key;
        if (made->width_px > 0.0f)
            plan->translate_px = fmaxf(plan->translate_px, hypotf(made->translate_x_px, made->translate_y_px));
    }
    return table->stroke.width_px > 0.0f;
}

/* Points the paints of areas to their fills, which do not move any more. */
static void link_areas(camber_plan *plan) {
    const camber_plan_fill *areas = plan->patterns.areas;
    for (size_t s = 0; s < plan->set_count && areas && plan->paints; s++) {
        const camber_plan_set *set = plan->sets + s;
        for (size_t i = 0; i < set->row_count * set->layer_count && camber_plan_is_area(plan, set); i++)
            if (areas[set->first_area + i].fill.color.a > 0.0f)
                plan->paints[set->first_paint + i].fill = &areas[set->first_area + i].fill;
    }
}

/* Finds the row of one dot of a class, in a set that draws the class. */
static camber_status match_dot(const camber_view *view, camber_plan *plan, camber_plan_set *set,
                               const camber_feature_view *feature, size_t at, class_rows *rows) {
    row_table *table = &rows->table;
    double *key = rows->by_class.keys + at;
    if (!(camber_plan_is_area(plan, set)      ? fill_areas(plan, set, view, feature, table, key)
          : camber_plan_is_circles(plan, set) ? fill_circles(plan, set, view, feature, table, key)
                                              : fill_tuple(plan, set, view, feature, table, key)))
        return CAMBER_OK;
    if (table->failed)
        return CAMBER_ERROR_MEMORY;
    if (plan->row_count >= MOST_ROWS)
        return camber_fail(plan->context, CAMBER_ERROR_LIMIT,
                           "style: more than %zu different widths and colours; make them depend on fewer properties",
                           MOST_ROWS);
    rows->by_class.rows[at] = intern_row(plan, set, table);
    return rows->by_class.rows[at] == CAMBER_NO_ROW ? CAMBER_ERROR_MEMORY : CAMBER_OK;
}

/* Lists the classes that may be drawn. There may be many more classes of labels. */
static camber_status list_drawn(const camber_features *features, plan_classes *classes) {
    if (!(classes->drawn = camber_alloc(features->context, features->class_count, sizeof *classes->drawn)))
        return CAMBER_ERROR_MEMORY;
    for (size_t c = 0; c < features->class_count; c++)
        if (!camber_geometry_is_label(features->classes[c].geometry))
            classes->drawn[classes->drawn_count++] = (uint32_t)c;
    return CAMBER_OK;
}

/* Finds the rows of every class in one set. */
static camber_status match_set(const camber_features *features, const camber_view *view, camber_plan *plan,
                               camber_plan_set *set, class_rows *rows) {
    const camber_plan_layer *first = plan->layers + set->first_layer;
    row_table *table = &rows->table;
    set->first_row = plan->row_count;
    set->first_paint = plan->paint_count;
    set->first_area = plan->patterns.area_count;
    memset(table->slots, 0, table->slot_count * sizeof *table->slots);
    const size_t last = plan->dot_count - 1, first_dot = camber_plan_is_circles(plan, set) ? 0 : last;
    camber_status status = CAMBER_OK;
    for (size_t c = 0; c < rows->by_class.drawn_count && status == CAMBER_OK; c++) {
        const camber_feature_class *class = features->classes + rows->by_class.drawn[c];
        const size_t at = ((size_t)(set - plan->sets) * rows->by_class.drawn_count + c) * plan->dot_count;
        for (size_t dot = 0; dot <= last; dot++)
            rows->by_class.rows[at + dot] = CAMBER_NO_ROW;
        if (!draws_class(features, first, view, class))
            continue;
        const camber_feature_view feature = camber_plan_view_of(features, class);
        plan->has_corners |= camber_plan_is_circles(plan, set) && class->geometry != CAMBER_GEOMETRY_POINT;
        table->is_ends = class->is_ends;
        for (size_t dot = first_dot; dot <= last && status == CAMBER_OK; dot++) {
            table->of_stroke = dot < last;
            status = match_dot(view, plan, set, &feature, at + dot, rows);
        }
    }
    return status;
}

/* ---- Entries: polylines by set, in input order, or in the order of their features' keys if the set is sorted ---- */

/* Returns the position of a colour in an order that does not depend on the input. */
static double rank_of(camber_color color) {
    const float parts[4] = {color.r, color.g, color.b, color.a};
    double rank = 0.0;
    for (int i = 0; i < 4; i++)
        rank = 4096.0 * rank + floor(4095.0 * (double)fminf(fmaxf(parts[i], 0.0f), 1.0f));
    return rank;
}

/* Sorts translucent fills of several colours by colour, so that areas of one colour are filled together wherever they
 * are in the file. Otherwise the areas between them would determine which of them overlap. An order that the style asks
 * for is kept. */
static void rank_translucent(camber_plan *plan, camber_plan_set *set) {
    double *keys = plan->pair_keys + set->first_pair;
    bool translucent = false;
    if (!plan->patterns.areas || !camber_plan_is_area(plan, set) || set->sorted || set->row_count < 2)
        return;
    const camber_plan_fill *areas = plan->patterns.areas + set->first_area;
    for (size_t i = 0; i < set->row_count * set->layer_count; i++)
        translucent = translucent || areas[i].fill.color.a < 1.0f;
    for (size_t i = 0; i < set->pair_count && translucent; i++) {
        const size_t row = plan->pair_rows[set->first_pair + i] - set->first_row;
        keys[i] = rank_of(areas[row * set->layer_count].fill.color);
        set->sorted = true;
    }
}

/* Completes the pairs of a set. If the set is sorted, the plan's key includes the sort keys, because other keys mean
 * another order. */
static void end_set(camber_plan *plan, camber_plan_set *set) {
    const double *keys = plan->pair_keys + set->first_pair;
    set->pair_count = plan->pair_count - set->first_pair;
    for (size_t i = 1; i < set->pair_count; i++)
        set->sorted = set->sorted || keys[i] < keys[0] || keys[i] > keys[0];
    rank_translucent(plan, set);
    if (set->sorted)
        plan->key = camber_hash(plan->key, keys, set->pair_count * sizeof *keys);
    if (set->least_area > 0.0)
        plan->key = camber_hash(plan->key, &set->least_area, sizeof set->least_area);
}

/* Numbers the pairs of sets and classes, set by set. */
static camber_status number_pairs(const camber_features *features, camber_plan *plan, const plan_classes *by_class) {
    const size_t column_count = by_class->drawn_count * plan->dot_count; /* classes times dots */
    size_t total = 0;
    for (size_t i = 0; i < plan->set_count * column_count; i++)
        total += by_class->rows[i] != CAMBER_NO_ROW;
    if (total >= MOST_ROWS)
        return camber_fail(
            plan->context, CAMBER_ERROR_LIMIT,
            "style: more than %zu combinations of layers and properties; make its filters depend on fewer properties",
            MOST_ROWS);
    if (!(plan->pair_rows = camber_alloc(plan->context, total, sizeof *plan->pair_rows)) ||
        !(plan->pair_keys = camber_alloc(plan->context, total, sizeof *plan->pair_keys)) ||
        !(plan->pair_dots = camber_alloc(plan->context, total, sizeof *plan->pair_dots)))
        return CAMBER_ERROR_MEMORY;
    plan->key = camber_hash(CAMBER_HASH_START, &features->polyline_count, sizeof features->polyline_count);
    for (size_t s = 0; s < plan->set_count; s++) {
        plan->sets[s].first_pair = plan->pair_count;
        for (size_t c = 0; c < column_count; c++) {
            const size_t at = s * column_count + c;
            if (by_class->rows[at] == CAMBER_NO_ROW)
                continue;
            const size_t pair[2] = {s, c};
            plan->key = camber_hash(plan->key, pair, sizeof pair);
            plan->pair_keys[plan->pair_count] = by_class->keys[at];
            plan->pair_dots[plan->pair_count] = (uint8_t)(c % plan->dot_count);
            plan->pair_rows[plan->pair_count++] = by_class->rows[at];
        }
        end_set(plan, plan->sets + s);
    }
    return CAMBER_OK;
}

static camber_status group_by_class(const camber_features *features, camber_plan *plan, const plan_classes *classes) {
    const size_t class_count = features->class_count, drawn_count = classes->drawn_count, dots = plan->dot_count;
    const uint32_t *rows = classes->rows;
    camber_class_sets *by_class = &plan->by_class;
    by_class->first = camber_alloc(plan->context, class_count + 1, sizeof *by_class->first);
    if (!by_class->first)
        return CAMBER_ERROR_MEMORY;
    size_t total = 0;
    for (size_t c = 0, d = 0; c < class_count; c++) {
        by_class->first[c] = total;
        if (d == drawn_count || classes->drawn[d] != c)
            continue;
        for (size_t s = 0; s < plan->set_count; s++)
            for (size_t dot = 0; dot < dots; dot++)
                total += rows[(s * drawn_count + d) * dots + dot] != CAMBER_NO_ROW;
        d++;
    }
    by_class->first[class_count] = total;
    by_class->pairs = camber_alloc(plan->context, total, sizeof *by_class->pairs);
    if (!by_class->pairs)
        return CAMBER_ERROR_MEMORY;
    /* Pairs are numbered set by set, so each class gets its pairs in that order. */
    uint32_t pair = 0;
    for (size_t s = 0; s < plan->set_count; s++)
        for (size_t c = 0; c < drawn_count * dots; c++)
            if (rows[s * drawn_count * dots + c] != CAMBER_NO_ROW)
                by_class->pairs[by_class->first[classes->drawn[c / dots]]++] = (camber_set_pair){(uint32_t)s, pair++};
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

/* Sorts the entries of a set by the keys of their features. The sort is stable. */
static camber_status sort_entries(const camber_plan *plan, const camber_plan_set *set, camber_plan_entry *entries,
                                  size_t count) {
    keyed_pair *keyed = camber_alloc(plan->context, set->pair_count, sizeof *keyed);
    size_t *ranks = keyed ? camber_alloc(plan->context, set->pair_count, sizeof *ranks) : NULL;
    size_t *firsts = ranks ? camber_alloc_zero(plan->context, set->pair_count + 1, sizeof *firsts) : NULL;
    camber_plan_entry *sorted = firsts ? camber_alloc(plan->context, count, sizeof *sorted) : NULL;
    const bool held = sorted != NULL;
    if (held) {
        for (size_t i = 0; i < set->pair_count; i++)
            keyed[i] = (keyed_pair){plan->pair_keys[set->first_pair + i], i};
        qsort(keyed, set->pair_count, sizeof *keyed, compare_keys);
        for (size_t i = 0, rank = 0; i < set->pair_count; i++) {
            rank += i > 0 && keyed[i].key > keyed[i - 1].key;
            ranks[keyed[i].pair] = rank;
        }
        for (size_t i = 0; i < count; i++)
            firsts[ranks[entries[i].pair - set->first_pair] + 1]++;
        for (size_t i = 0; i < set->pair_count; i++)
            firsts[i + 1] += firsts[i];
        for (size_t i = 0; i < count; i++)
            sorted[firsts[ranks[entries[i].pair - set->first_pair]]++] = entries[i];
        memcpy(entries, sorted, count * sizeof *sorted);
    }
    camber_free(plan->context, sorted);
    camber_free(plan->context, firsts);
    camber_free(plan->context, ranks);
    camber_free(plan->context, keyed);
    return held ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

/* Returns the class of the n-th listed polyline, and sets *polyline to its number. */
static uint32_t class_at(const camber_features *features, const uint32_t *polylines, size_t n, size_t *polyline) {
    *polyline = polylines ? polylines[n] : n;
    return features->feature_class[features->polyline_feature[*polyline]];
}

/* Whether a set draws a polyline of its classes: a ring may be too small. Its size is that of a box around the points
 * that no simplification drops, so it does not depend on which of the others are there. */
static bool is_large_enough(const camber_features *features, const camber_plan_set *set, size_t polyline) {
    double x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY;
    if (!(set->least_area > 0.0) || !features->importance)
        return true;
    for (size_t i = features->offsets[polyline]; i < features->offsets[polyline + 1]; i++) {
        const double x = features->points[2 * i], y = features->points[2 * i + 1];
        if (isfinite(features->importance[i]))
            continue;
        x0 = x < x0 ? x : x0;
        x1 = x > x1 ? x : x1;
        y0 = y < y0 ? y : y0;
        y1 = y > y1 ? y : y1;
        if ((x1 - x0) * (y1 - y0) >= set->least_area)
            return true;
    }
    return false;
}

camber_status camber_plan_list(const camber_features *features, const camber_plan *plan, const uint32_t *polylines,
                               size_t polyline_count, camber_plan_entries *list) {
    const camber_class_sets *by_class = &plan->by_class;
    size_t p;
    *list = (camber_plan_entries){.context = plan->context};
    if (!(list->first_entries = camber_alloc_zero(plan->context, plan->set_count + 2, sizeof *list->first_entries)))
        return CAMBER_ERROR_MEMORY;
    size_t *firsts = list->first_entries + 1; /* while entries are stored, firsts[set] is the index of its next one */
    for (size_t i = 0; i < polyline_count; i++) {
        const uint32_t class = class_at(features, polylines, i, &p);
        for (size_t k = by_class->first[class]; k < by_class->first[class + 1]; k++)
            firsts[by_class->pairs[k].set + 1] += is_large_enough(features, plan->sets + by_class->pairs[k].set, p);
    }
    for (size_t s = 0; s < plan->set_count; s++)
        firsts[s + 1] += firsts[s];
    const size_t total = firsts[plan->set_count];
    if (!(list->entries = camber_alloc(plan->context, total, sizeof *list->entries)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < polyline_count; i++) {
        const uint32_t class = class_at(features, polylines, i, &p);
        for (size_t k = by_class->first[class]; k < by_class->first[class + 1]; k++)
            if (is_large_enough(features, plan->sets + by_class->pairs[k].set, p))
                list->entries[firsts[by_class->pairs[k].set]++] =
                    (camber_plan_entry){(uint32_t)p, by_class->pairs[k].pair};
    }
    camber_status status = CAMBER_OK;
    for (size_t s = 0; s < plan->set_count && status == CAMBER_OK; s++)
        if (plan->sets[s].sorted)
            status = sort_entries(plan, plan->sets + s, list->entries + list->first_entries[s],
                                  list->first_entries[s + 1] - list->first_entries[s]);
    return status;
}

void camber_plan_entries_free(camber_plan_entries *list) {
    if (!list->context)
        return;
    camber_free(list->context, list->entries);
    camber_free(list->context, list->first_entries);
    *list = (camber_plan_entries){0};
}

/* Lists the polylines of each set, for all features. */
static camber_status list_all(const camber_features *features, camber_plan *plan) {
    const camber_class_sets *by_class = &plan->by_class;
    const camber_status status = camber_plan_list(features, plan, NULL, features->polyline_count, &plan->all);
    for (size_t p = 0; p < features->polyline_count; p++) {
        const uint32_t class = features->feature_class[features->polyline_feature[p]];
        if (by_class->first[class] == by_class->first[class + 1] &&
            camber_feature_class_counts(features->classes + class))
            plan->undrawn += features->feature_counts[p];
    }
    return status;
}

/* ---- The plan ---- */

camber_status camber_plan_evaluate(const camber_features *features, const camber_view *view, camber_plan *plan) {
    camber_context *context = features->context;
    *plan = (camber_plan){.context = context, .dot_count = 1};
    plan->patterns = (camber_plan_patterns){.context = context, .sprites = features->sprites};
    camber_status status = group_layers(plan, features->style, view);
    if (status != CAMBER_OK)
        return status;

    class_rows rows = {.table = {.slot_count = 16}};
    status = list_drawn(features, &rows.by_class);
    if (status != CAMBER_OK)
        return status;
    const size_t drawn_count = rows.by_class.drawn_count;
    if (plan->set_count > MOST_MATCHES / plan->dot_count / (drawn_count + 1)) {
        camber_free(context, rows.by_class.drawn);
        return camber_fail(
            context, CAMBER_ERROR_LIMIT,
            "style: %zu different layers for %zu classes of features are too many; use fewer layers or properties",
            plan->set_count, drawn_count);
    }
    row_table *table = &rows.table;
    while (table->slot_count / 2 < drawn_count * plan->dot_count)
        table->slot_count *= 2;
    status = CAMBER_ERROR_MEMORY;
    /* One row more than needed, so that no array is empty. Classes are in memory, so their count cannot overflow. */
    const size_t count = (drawn_count + 1) * plan->dot_count;
    if (!(table->tuple = camber_alloc(context, plan->layer_count, sizeof *table->tuple)) ||
        !(table->areas = camber_alloc(context, plan->layer_count, sizeof *table->areas)) ||
        !(table->slots = camber_alloc(context, table->slot_count, sizeof *table->slots)) ||
        !(rows.by_class.rows = camber_alloc(context, plan->set_count, count * sizeof *rows.by_class.rows)) ||
        !(rows.by_class.keys = camber_alloc(context, plan->set_count, count * sizeof *rows.by_class.keys)))
        goto done;
    status = CAMBER_OK;
    for (size_t s = 0; s < plan->set_count && status == CAMBER_OK; s++)
        status = match_set(features, view, plan, plan->sets + s, &rows);
    link_areas(plan);
    if (status == CAMBER_OK && features->polyline_count > UINT32_MAX)
        status = camber_fail(context, CAMBER_ERROR_LIMIT, "%zu polylines exceed the limit of 2^32; draw them in parts",
                             features->polyline_count);
    if (status == CAMBER_OK)
        status = number_pairs(features, plan, &rows.by_class);
    if (status == CAMBER_OK)
        status = group_by_class(features, plan, &rows.by_class);
done:
    camber_free(context, rows.by_class.keys);
    camber_free(context, rows.by_class.rows);
    camber_free(context, rows.by_class.drawn);
    camber_free(context, table->slots);
    camber_free(context, table->areas);
    camber_free(context, table->tuple);
    return status;
}

camber_status camber_plan_create(const camber_features *features, const camber_view *view, camber_plan *plan) {
    const camber_status status = camber_plan_evaluate(features, view, plan);
    return status == CAMBER_OK ? list_all(features, plan) : status;
}

void camber_plan_destroy(camber_plan *plan) {
    camber_free(plan->context, plan->ramps);
    camber_plan_patterns_free(&plan->patterns);
    for (size_t i = 0; i < plan->dash_count; i++)
        camber_free(plan->context, plan->dashes[i]);
    camber_free(plan->context, plan->dashes);
    camber_free(plan->context, plan->dash_slots);
    camber_plan_entries_free(&plan->all);
    camber_free(plan->context, plan->by_class.pairs);
    camber_free(plan->context, plan->by_class.first);
    camber_free(plan->context, plan->pair_dots);
    camber_free(plan->context, plan->pair_keys);
    camber_free(plan->context, plan->pair_rows);
    camber_free(plan->context, plan->strokes);
    camber_free(plan->context, plan->paints);
    camber_free(plan->context, plan->sets);
    camber_free(plan->context, plan->layers);
}
