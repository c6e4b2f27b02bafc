/* Style documents: what the specification calls the root and its layers. */
#include "style/style.h"

#include "base/embedded.h"
#include "style/compiler.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Warnings of one document, past which it says so once more and no longer. */
enum { WARNING_LIMIT = 32 };

typedef struct parser {
    camber_compiler compiler;
    json_t *root;
    const char *warned[WARNING_LIMIT]; /* layer types and properties that were warned of; the document's strings */
    size_t warned_count;
} parser;

static const camber_property line_color = {
    .name = "line-color", .type = CAMBER_TYPE_COLOR, .interpolated = true, .data_driven = true};
static const camber_property line_opacity = {
    .name = "line-opacity", .type = CAMBER_TYPE_NUMBER, .interpolated = true, .data_driven = true, .high = 1.0};
static const camber_property line_width = {
    .name = "line-width", .type = CAMBER_TYPE_NUMBER, .interpolated = true, .data_driven = true, .high = HUGE_VAL};
static const camber_property line_cap = {.name = "line-cap", .type = CAMBER_TYPE_STRING};
static const camber_property line_join = {.name = "line-join", .type = CAMBER_TYPE_STRING, .data_driven = true};
static const camber_property line_miter_limit = {
    .name = "line-miter-limit", .type = CAMBER_TYPE_NUMBER, .interpolated = true, .high = HUGE_VAL};
static const camber_property background_color = {
    .name = "background-color", .type = CAMBER_TYPE_COLOR, .interpolated = true};
static const camber_property background_opacity = {
    .name = "background-opacity", .type = CAMBER_TYPE_NUMBER, .interpolated = true, .high = 1.0};

/* ---- Warnings ---- */

/* Whether this is the first time, and then it counts as said. */
static bool first_time(parser *p, const char *what) {
    for (size_t i = 0; i < p->warned_count; i++)
        if (strcmp(p->warned[i], what) == 0)
            return false;
    if (p->warned_count == WARNING_LIMIT)
        return false;
    p->warned[p->warned_count++] = what;
    if (p->warned_count == WARNING_LIMIT)
        camber_compiler_warn(&p->compiler, "more is not drawn; warnings end here");
    return p->warned_count < WARNING_LIMIT;
}

static bool ends_with(const char *text, const char *end) {
    const size_t length = strlen(text), end_length = strlen(end);
    return length >= end_length && strcmp(text + length - end_length, end) == 0;
}

static bool is_directed(const char *name) {
    static const char *const names[] = {"line-dasharray", "line-offset", "line-gradient", "line-pattern",
                                        "line-trim-offset"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i]) == 0)
            return true;
    return false;
}

static void warn_of_property(parser *p, const char *name, const char *prefix) {
    p->compiler.style->directed |= is_directed(name);
    /* Transitions are for pictures that change. */
    if (ends_with(name, "-transition") || !first_time(p, name))
        return;
    camber_compiler_enter_key(&p->compiler, name);
    if (strncmp(name, prefix, strlen(prefix)) == 0)
        camber_compiler_warn(&p->compiler, "this property is not drawn; the layer is drawn without it");
    else
        camber_compiler_warn(&p->compiler, "unknown property; the layer is drawn without it");
    camber_compiler_leave(&p->compiler);
}

/* ---- Layers ---- */

static bool fail_memory(camber_compiler *c) {
    c->status = CAMBER_ERROR_MEMORY;
    return false;
}

static bool copy_string(camber_compiler *c, const json_t *json, char **copy) {
    *copy = camber_copy_string(c->context, json_string_value(json));
    return *copy || fail_memory(c);
}

/* A string of the layer, left NULL where it is missing. */
static bool read_string(camber_compiler *c, const json_t *layer, const char *key, char **string) {
    const json_t *json = json_object_get(layer, key);
    if (!json)
        return true;
    camber_compiler_enter_key(c, key);
    if (!json_is_string(json))
        return camber_compiler_fail(c, "expected a string, found %s; write a name", camber_json_name(json));
    camber_compiler_leave(c);
    return copy_string(c, json, string);
}

static bool read_zoom(camber_compiler *c, const json_t *layer, const char *key, double *zoom) {
    const json_t *json = json_object_get(layer, key);
    if (!json)
        return true;
    camber_compiler_enter_key(c, key);
    if (!json_is_number(json))
        return camber_compiler_fail(c, "expected a number, found %s; use 0 to 24", camber_json_name(json));
    *zoom = json_number_value(json);
    if (!(*zoom >= 0.0 && *zoom <= 24.0))
        return camber_compiler_fail(c, "%g is out of range; use 0 to 24", *zoom);
    camber_compiler_leave(c);
    return true;
}

static bool read_visibility(camber_compiler *c, const json_t *json, bool *visible) {
    const char *text = json_string_value(json);
    if (!text || (strcmp(text, "visible") != 0 && strcmp(text, "none") != 0))
        return camber_compiler_fail(c, "expected \"visible\" or \"none\"; write one of them");
    *visible = strcmp(text, "visible") == 0;
    return true;
}

/* A property that the layer holds as a constant: one value is chosen where the style varies it by zoom or feature.
 * The value's string lives as long as the expression. */
static bool read_constant(parser *p, json_t *json, const camber_property *property, camber_expression **expression,
                          camber_value *value) {
    enum { USUAL_ZOOM = 14 };
    if (!camber_compile_property(&p->compiler, json, property, expression))
        return false;
    const camber_expression *made = *expression;
    camber_evaluation evaluation;
    camber_evaluation_begin(&evaluation, USUAL_ZOOM, NULL);
    if (!camber_expression_evaluate(made, &evaluation, value))
        *value = (camber_value){.type = CAMBER_VALUE_NULL};
    if (made->nodes[made->root].op != CAMBER_OP_CONSTANT && first_time(p, property->name))
        camber_compiler_warn(&p->compiler, "%s does not vary within a layer yet; its value at zoom %d is used",
                             property->name, USUAL_ZOOM);
    return true;
}

/* Index of the property's value among the names; left alone where it has no value at the usual zoom. */
static bool read_choice(parser *p, json_t *json, const camber_property *property, const char *const names[3],
                        size_t *choice) {
    camber_expression *expression;
    camber_value value;
    if (!read_constant(p, json, property, &expression, &value))
        return false;
    bool found = value.type != CAMBER_VALUE_STRING;
    for (size_t i = 0; i < 3 && !found; i++) {
        found = strcmp(value.string, names[i]) == 0;
        if (found)
            *choice = i;
    }
    if (!found)
        camber_compiler_fail(&p->compiler, "\"%.64s\" is no %s; use \"%s\", \"%s\" or \"%s\"", value.string,
                             property->name, names[0], names[1], names[2]);
    camber_expression_destroy(p->compiler.context, expression);
    return found;
}

static bool read_miter_limit(parser *p, json_t *json, float *limit) {
    camber_expression *expression;
    camber_value value;
    if (!read_constant(p, json, &line_miter_limit, &expression, &value))
        return false;
    /* Below 1 no join is a miter, which is what 1 says; 0 would be the default of a stroke. */
    if (value.type == CAMBER_VALUE_NUMBER)
        *limit = (float)fmin(fmax(value.number, 1.0), 1e6);
    camber_expression_destroy(p->compiler.context, expression);
    return true;
}

static bool read_layout_property(parser *p, const char *key, json_t *json, camber_style_layer *layer) {
    static const char *const caps[] = {"butt", "round", "square"}, *const joins[] = {"round", "miter", "bevel"};
    static const camber_cap cap_values[] = {CAMBER_CAP_BUTT, CAMBER_CAP_ROUND, CAMBER_CAP_SQUARE};
    static const camber_join join_values[] = {CAMBER_JOIN_ROUND, CAMBER_JOIN_MITER, CAMBER_JOIN_BEVEL};
    size_t choice = 0;
    if (strcmp(key, "visibility") == 0)
        return read_visibility(&p->compiler, json, &layer->visible);
    if (layer->kind == CAMBER_LAYER_LINE && strcmp(key, line_cap.name) == 0) {
        if (!read_choice(p, json, &line_cap, caps, &choice))
            return false;
        layer->cap = cap_values[choice];
    } else if (layer->kind == CAMBER_LAYER_LINE && strcmp(key, line_join.name) == 0) {
        choice = 1;
        if (!read_choice(p, json, &line_join, joins, &choice))
            return false;
        layer->join = join_values[choice];
    } else if (layer->kind == CAMBER_LAYER_LINE && strcmp(key, line_miter_limit.name) == 0) {
        return read_miter_limit(p, json, &layer->miter_limit);
    } else {
        camber_compiler_leave(&p->compiler);
        warn_of_property(p, key, layer->kind == CAMBER_LAYER_LINE ? "line-" : "background-");
        camber_compiler_enter_key(&p->compiler, key);
    }
    return true;
}

static bool read_paint_property(parser *p, const char *key, json_t *json, camber_style_layer *layer) {
    const struct {
        camber_layer_kind kind;
        const camber_property *property;
        camber_expression **expression;
    } known[] = {
        {CAMBER_LAYER_LINE, &line_color, &layer->color},
        {CAMBER_LAYER_LINE, &line_opacity, &layer->opacity},
        {CAMBER_LAYER_LINE, &line_width, &layer->width},
        {CAMBER_LAYER_BACKGROUND, &background_color, &layer->color},
        {CAMBER_LAYER_BACKGROUND, &background_opacity, &layer->opacity},
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (known[i].kind == layer->kind && strcmp(known[i].property->name, key) == 0)
            return camber_compile_property(&p->compiler, json, known[i].property, known[i].expression);
    camber_compiler_leave(&p->compiler);
    warn_of_property(p, key, layer->kind == CAMBER_LAYER_LINE ? "line-" : "background-");
    camber_compiler_enter_key(&p->compiler, key);
    return true;
}

typedef bool read_property_fn(parser *p, const char *key, json_t *json, camber_style_layer *layer);

/* layout or paint. */
static bool read_properties(parser *p, const json_t *json, const char *group, read_property_fn *read,
                            camber_style_layer *layer) {
    camber_compiler *c = &p->compiler;
    json_t *properties = json_object_get(json, group), *value;
    const char *key;
    if (!properties)
        return true;
    camber_compiler_enter_key(c, group);
    if (!json_is_object(properties))
        return camber_compiler_fail(c, "expected an object, found %s; write {\"name\": value, ...}",
                                    camber_json_name(properties));
    json_object_foreach(properties, key, value) {
        camber_compiler_enter_key(c, key);
        if (!read(p, key, value, layer))
            return false;
        camber_compiler_leave(c);
    }
    camber_compiler_leave(c);
    return true;
}

static bool write_filter_key(camber_compiler *c, const json_t *filter, char **key) {
    const size_t size = filter ? json_dumpb(filter, NULL, 0, JSON_COMPACT | JSON_ENCODE_ANY) : 0;
    *key = camber_alloc(c->context, size + 1, 1);
    if (!*key) {
        c->status = CAMBER_ERROR_MEMORY;
        return false;
    }
    (*key)[size] = 0;
    /* No filter's text is empty: jansson found no memory of its own. */
    if (filter && (size == 0 || json_dumpb(filter, *key, size, JSON_COMPACT | JSON_ENCODE_ANY) != size))
        c->status =
            camber_fail(c->context, CAMBER_ERROR_MEMORY, "%s: out of memory for a filter; make it shorter", c->name);
    return c->status == CAMBER_OK;
}

static bool read_filter(camber_compiler *c, const json_t *json, camber_style_layer *layer) {
    json_t *filter = json_object_get(json, "filter");
    if (!filter || layer->kind == CAMBER_LAYER_BACKGROUND)
        return write_filter_key(c, NULL, &layer->filter_key);
    camber_compiler_enter_key(c, "filter");
    if (!camber_compile_filter(c, filter, &layer->filter) || !write_filter_key(c, filter, &layer->filter_key))
        return false;
    camber_compiler_leave(c);
    c->style->wants_polygons = c->style->wants_polygons || camber_filter_asks_polygons(filter);
    return true;
}

static uint32_t find_source(const camber_style *style, const char *name) {
    for (size_t i = 0; name && i < style->source_count; i++)
        if (strcmp(style->sources[i].name, name) == 0)
            return (uint32_t)i;
    return CAMBER_NO_SOURCE;
}

static bool read_layer(parser *p, const json_t *json, camber_style_layer *layer) {
    camber_compiler *c = &p->compiler;
    layer->visible = true;
    layer->max_zoom = 24.0;
    layer->cap = CAMBER_CAP_BUTT;
    layer->join = CAMBER_JOIN_MITER;
    layer->miter_limit = 2.0f;
    if (!read_string(c, json, "id", &layer->id) || !read_string(c, json, "source", &layer->source) ||
        !read_string(c, json, "source-layer", &layer->source_layer) ||
        !read_zoom(c, json, "minzoom", &layer->min_zoom) || !read_zoom(c, json, "maxzoom", &layer->max_zoom))
        return false;
    layer->source_index = find_source(c->style, layer->source);
    return read_filter(c, json, layer) && read_properties(p, json, "layout", read_layout_property, layer) &&
           read_properties(p, json, "paint", read_paint_property, layer);
}

/* Types whose layers are drawn one day; others are misspelled. */
static bool is_known_type(const char *type) {
    static const char *const types[] = {"fill",   "symbol",    "circle",       "heatmap", "fill-extrusion",
                                        "raster", "hillshade", "color-relief", "sky"};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (strcmp(types[i], type) == 0)
            return true;
    return false;
}

/* Checks what any layer must have; appends it where it is of a kind that is drawn. */
static bool read_any_layer(parser *p, const json_t *json) {
    camber_compiler *c = &p->compiler;
    camber_style *style = c->style;
    if (!json_is_object(json))
        return camber_compiler_fail(c, "expected a layer, an object, found %s; take it out", camber_json_name(json));
    if (!json_is_string(json_object_get(json, "id")))
        return camber_compiler_fail(c, "the layer has no \"id\" that is a string; name it");
    const char *type = json_string_value(json_object_get(json, "type"));
    if (!type)
        return camber_compiler_fail(c, "the layer has no \"type\" that is a string; write e.g. \"type\": \"line\"");
    const bool line = strcmp(type, "line") == 0;
    if (!line && strcmp(type, "background") != 0) {
        if (first_time(p, type))
            camber_compiler_warn(c,
                                 is_known_type(type) ? "layers of type \"%.64s\" are not drawn and left out"
                                                     : "layers of the unknown type \"%.64s\" are left out",
                                 type);
        return true;
    }
    camber_style_layer *layer = &style->layers[style->layer_count++];
    layer->kind = line ? CAMBER_LAYER_LINE : CAMBER_LAYER_BACKGROUND;
    return read_layer(p, json, layer);
}

/* ---- Documents ---- */

typedef struct layer_id {
    const char *id;
    size_t index;
} layer_id;

static int compare_ids(const void *left, const void *right) {
    const layer_id *a = left, *b = right;
    const int order = strcmp(a->id, b->id);
    return order ? order : a->index < b->index ? -1 : a->index > b->index;
}

static bool check_ids(camber_compiler *c, const json_t *layers) {
    const size_t count = json_array_size(layers);
    layer_id *ids = camber_alloc(c->context, count, sizeof *ids);
    if (!ids) {
        c->status = CAMBER_ERROR_MEMORY;
        return false;
    }
    for (size_t i = 0; i < count; i++)
        ids[i] = (layer_id){json_string_value(json_object_get(json_array_get(layers, i), "id")), i};
    qsort(ids, count, sizeof *ids, compare_ids);
    bool unique = true;
    for (size_t i = 1; i < count && unique; i++) {
        if (strcmp(ids[i - 1].id, ids[i].id) == 0) {
            camber_compiler_enter_index(c, ids[i].index);
            camber_compiler_enter_key(c, "id");
            unique = camber_compiler_fail(c, "\"%.64s\" is the id of /layers/%zu too; rename one", ids[i].id,
                                          ids[i - 1].index);
        }
    }
    camber_free(c->context, ids);
    return unique;
}

static bool read_layers(parser *p, const json_t *layers) {
    camber_compiler *c = &p->compiler;
    camber_compiler_enter_key(c, "layers");
    if (!json_is_array(layers))
        return camber_compiler_fail(c, "expected an array of layers; write \"layers\": [...]");
    c->style->layers = camber_alloc_zero(c->context, json_array_size(layers), sizeof *c->style->layers);
    if (!c->style->layers) {
        c->status = CAMBER_ERROR_MEMORY;
        return false;
    }
    for (size_t i = 0; i < json_array_size(layers); i++) {
        camber_compiler_enter_index(c, i);
        if (!read_any_layer(p, json_array_get(layers, i)))
            return false;
        camber_compiler_leave(c);
    }
    const bool unique = check_ids(c, layers);
    camber_compiler_leave(c);
    return unique;
}

static bool read_source(parser *p, const char *name, json_t *json) {
    camber_compiler *c = &p->compiler;
    const json_t *type = json_object_get(json, "type");
    if (!json_is_object(json))
        return camber_compiler_fail(c, "expected a source, an object, found %s; write {\"type\": \"vector\", ...}",
                                    camber_json_name(json));
    if (!json_is_string(type))
        return camber_compiler_fail(c, "the source has no \"type\" that is a string; write e.g. \"type\": \"geojson\"");
    camber_style_source *source = &c->style->sources[c->style->source_count++];
    source->json = json_incref(json);
    source->name = camber_copy_string(c->context, name);
    return (source->name || fail_memory(c)) && copy_string(c, type, &source->type);
}

/* Before the layers, which name them. */
static bool read_sources(parser *p, json_t *sources) {
    camber_compiler *c = &p->compiler;
    const char *name;
    json_t *json;
    if (!sources)
        return true;
    camber_compiler_enter_key(c, "sources");
    if (!json_is_object(sources))
        return camber_compiler_fail(c, "expected an object, found %s; write {\"name\": {...}, ...}",
                                    camber_json_name(sources));
    c->style->sources = camber_alloc_zero(c->context, json_object_size(sources), sizeof *c->style->sources);
    if (!c->style->sources)
        return fail_memory(c);
    json_object_foreach(sources, name, json) {
        camber_compiler_enter_key(c, name);
        if (!read_source(p, name, json))
            return false;
        camber_compiler_leave(c);
    }
    camber_compiler_leave(c);
    return true;
}

static bool read_document(parser *p) {
    camber_compiler *c = &p->compiler;
    if (!json_is_object(p->root))
        return camber_compiler_fail(c, "expected a style document, an object, found %s; pass a MapLibre style",
                                    camber_json_name(p->root));
    const json_t *version = json_object_get(p->root, "version");
    camber_compiler_enter_key(c, "version");
    if (!json_is_number(version) || json_number_value(version) < 8.0 || json_number_value(version) > 8.0)
        return camber_compiler_fail(c, "expected the number 8; write \"version\": 8");
    camber_compiler_leave(c);
    return read_sources(p, json_object_get(p->root, "sources")) && read_layers(p, json_object_get(p->root, "layers"));
}

camber_status camber_style_parse(camber_context *context, const char *json, size_t size_bytes, const char *name,
                                 camber_style **style) {
    parser p = {.compiler = {.context = context, .name = name}};
    camber_compiler *c = &p.compiler;
    c->style = camber_alloc_zero(context, 1, sizeof *c->style);
    if (!c->style)
        return CAMBER_ERROR_MEMORY;
    c->style->context = context;
    c->status = camber_json_read(context, json, size_bytes, name, &p.root);
    if (c->status == CAMBER_OK && read_document(&p))
        *style = c->style;
    if (c->status != CAMBER_OK)
        camber_style_destroy(c->style);
    camber_compiler_end(c);
    json_decref(p.root);
    return c->status;
}

camber_status camber_style_builtin(camber_context *context, camber_theme theme, camber_style **style) {
    if (theme == CAMBER_THEME_DARK)
        return camber_style_parse(context, camber_style_dark, camber_style_dark_size, "built-in dark style", style);
    return camber_style_parse(context, camber_style_light, camber_style_light_size, "built-in light style", style);
}

void camber_style_destroy(camber_style *style) {
    if (!style)
        return;
    camber_context *context = style->context;
    for (size_t i = 0; i < style->layer_count; i++) {
        camber_style_layer *layer = &style->layers[i];
        camber_expression_destroy(context, layer->width);
        camber_expression_destroy(context, layer->opacity);
        camber_expression_destroy(context, layer->color);
        camber_expression_destroy(context, layer->filter);
        camber_free(context, layer->filter_key);
        camber_free(context, layer->source_layer);
        camber_free(context, layer->source);
        camber_free(context, layer->id);
    }
    for (size_t i = 0; i < style->source_count; i++) {
        camber_free(context, style->sources[i].name);
        camber_free(context, style->sources[i].type);
        json_decref(style->sources[i].json);
    }
    for (size_t i = 0; i < style->property_count; i++)
        camber_free(context, style->properties[i]);
    camber_free(context, style->sources);
    camber_free(context, style->properties);
    camber_free(context, style->layers);
    camber_free(context, style);
}

/* ---- Evaluation ---- */

bool camber_style_layer_matches(const camber_style_layer *layer, double zoom, const camber_feature_view *feature) {
    /* 24 is the largest limit that a style can name, and stands for none. */
    if (!layer->visible || zoom < layer->min_zoom || (zoom >= layer->max_zoom && layer->max_zoom < 24.0))
        return false;
    if (!layer->filter)
        return true;
    camber_evaluation evaluation;
    camber_evaluation_begin(&evaluation, zoom, feature);
    camber_value value;
    const bool matches = camber_expression_evaluate(layer->filter, &evaluation, &value) &&
                         value.type == CAMBER_VALUE_BOOL && value.boolean;
    camber_evaluation_end(&evaluation);
    return matches;
}

static double evaluate_number(const camber_expression *expression, camber_evaluation *evaluation, double fallback) {
    camber_value value;
    if (!expression || !camber_expression_evaluate(expression, evaluation, &value) ||
        value.type != CAMBER_VALUE_NUMBER || !isfinite(value.number))
        return fallback;
    return value.number;
}

camber_layer_paint camber_style_layer_paint(const camber_style_layer *layer, double zoom,
                                            const camber_feature_view *feature) {
    camber_evaluation evaluation;
    camber_evaluation_begin(&evaluation, zoom, feature);
    camber_layer_paint paint = {.color = {0.0f, 0.0f, 0.0f, 1.0f}};
    camber_value value;
    if (layer->color && camber_expression_evaluate(layer->color, &evaluation, &value) &&
        value.type == CAMBER_VALUE_COLOR)
        paint.color = value.color;
    paint.color.a *= (float)fmin(fmax(evaluate_number(layer->opacity, &evaluation, 1.0), 0.0), 1.0);
    paint.width = fmax(evaluate_number(layer->width, &evaluation, 1.0), 0.0);
    camber_evaluation_end(&evaluation);
    return paint;
}
