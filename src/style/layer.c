/* Reads the layers of a style document: source, zooms, filter, and the layout and paint properties of properties.c.
 *
 * Input: JSON of a layer. Output: camber_style_layer. Layers of types that are not supported are left out with a
 * warning. */
#include "style/document.h"
#include "style/ramp.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- Layout and paint ---- */

static bool ends_with(const char *text, const char *end) {
    const size_t length = strlen(text), end_length = strlen(end);
    return length >= end_length && strcmp(text + length - end_length, end) == 0;
}

/* Evaluates visibility that is an expression, which may read only the style's state. */
static bool evaluate_visibility(camber_document *d, json_t *json, bool *visible) {
    static const char *const values[] = {"visible", "none", NULL};
    static const camber_property property = {
        .name = "visibility", .type = CAMBER_TYPE_STRING, .values = values, .without_zoom = true};
    camber_expression *expression = NULL;
    camber_evaluation evaluation;
    camber_value value;
    if (!camber_compile_property(&d->compiler, json, &property, &expression))
        return false;
    camber_evaluation_begin(&evaluation, 0.0, NULL);
    *visible = !camber_expression_evaluate(expression, &evaluation, &value) || value.type != CAMBER_VALUE_STRING ||
               strcmp(value.string, "none") != 0;
    camber_evaluation_end(&evaluation);
    camber_expression_destroy(d->compiler.context, expression);
    return true;
}

static bool read_visibility(camber_document *d, json_t *json, bool *visible) {
    const char *text = json_string_value(json);
    if (json_is_array(json))
        return evaluate_visibility(d, json, visible);
    if (!text || (strcmp(text, "visible") != 0 && strcmp(text, "none") != 0))
        return camber_compiler_fail(&d->compiler, "expected \"visible\" or \"none\"; write one of them");
    *visible = strcmp(text, "visible") == 0;
    return true;
}

/* Whether the value is the specification's default. */
static bool is_default(const camber_property_row *row, const json_t *json) {
    json_t *fallback = row->property.fallback
                           ? json_loads(row->property.fallback, JSON_DECODE_ANY | JSON_DECODE_INT_AS_REAL, NULL)
                           : NULL;
    const bool same = fallback && json_equal(json, fallback);
    json_decref(fallback);
    return same;
}

static bool read_known(camber_document *d, const camber_property_row *row, json_t *json, camber_style_layer *layer) {
    camber_compiler *c = &d->compiler;
    camber_expression **expression = layer->properties + camber_property_id_of(row);
    if (!camber_compile_property(c, json, &row->property, expression))
        return false;
    if (is_default(row, json))
        return true;
    c->style->schema.directed |= row->directed;
    return true;
}

static bool read_property(camber_document *d, bool layout, const char *key, json_t *json, camber_style_layer *layer) {
    if (layout && strcmp(key, "visibility") == 0)
        return true; /* has already been read */
    const camber_property_row *row = camber_property_find(layer->kind, layout, key);
    if (row)
        return read_known(d, row, json, layer);
    /* Transitions only matter for animated pictures. */
    if (!(!layout && ends_with(key, "-transition")) && camber_document_first_time(d, key))
        camber_compiler_warn(&d->compiler,
                             camber_property_find(layer->kind, !layout, key)
                                 ? "this property is in the wrong group; move it to \"%s\""
                                 : "unknown property; the layer is drawn without it",
                             layout ? "paint" : "layout");
    return true;
}

/* Reads layout or paint. */
static bool read_properties(camber_document *d, const json_t *json, const char *group, camber_style_layer *layer) {
    camber_compiler *c = &d->compiler;
    json_t *properties = json_object_get(json, group), *value;
    const size_t depth = c->path_length;
    const bool layout = strcmp(group, "layout") == 0;
    const char *key;
    if (!properties)
        return true;
    camber_compiler_enter_key(c, group);
    if (!json_is_object(properties))
        return camber_compiler_fail(c, "expected an object, found %s; write {\"name\": value, ...}",
                                    camber_json_name(properties)) ||
               camber_document_continues(d, depth);
    json_object_foreach(properties, key, value) {
        camber_compiler_enter_key(c, key);
        if (read_property(d, layout, key, value, layer))
            camber_compiler_leave(c);
        else if (!camber_document_continues(d, depth + 1))
            return false;
    }
    camber_compiler_leave(c);
    return true;
}

static bool read_layer_visibility(camber_document *d, const json_t *json, camber_style_layer *layer) {
    json_t *visibility = json_object_get(json_object_get(json, "layout"), "visibility");
    const size_t depth = d->compiler.path_length;
    layer->visible = true;
    if (!visibility)
        return true;
    camber_compiler_enter_key(&d->compiler, "layout");
    camber_compiler_enter_key(&d->compiler, "visibility");
    if (!read_visibility(d, visibility, &layer->visible))
        return camber_document_continues(d, depth);
    d->compiler.path_length = depth;
    return true;
}

/* Fails at a key of a layer's metadata. */
static bool fail_metadata(camber_document *d, const char *key, const char *message) {
    const size_t depth = d->compiler.path_length;
    camber_compiler_enter_key(&d->compiler, "metadata");
    camber_compiler_enter_key(&d->compiler, key);
    camber_compiler_fail(&d->compiler, "%s", message);
    return camber_document_continues(d, depth);
}

/* Reads metadata such as {"camber:plain": true}. */
static bool read_flag(camber_document *d, const json_t *json, const char *key, bool *flag) {
    const json_t *value = json_object_get(json_object_get(json, "metadata"), key);
    *flag = json_is_true(value);
    return !value || json_is_boolean(value) || fail_metadata(d, key, "expected true or false; write one of them");
}

static void warn_overlap(camber_document *d, const char *key, camber_layer_kind kind) {
    const size_t depth = d->compiler.path_length;
    camber_compiler_enter_key(&d->compiler, "metadata");
    camber_compiler_enter_key(&d->compiler, key);
    camber_compiler_warn(&d->compiler, "applies only to line layers, because %s; leave it out",
                         kind == CAMBER_LAYER_FILL     ? "areas of one colour are filled together"
                         : kind == CAMBER_LAYER_SYMBOL ? "labels have \"text-overlap\" and \"icon-overlap\""
                                                       : "circles are drawn on top of each other");
    d->compiler.path_length = depth;
}

/* Reads the metadata {"camber:overlap": ...}. */
static bool read_overlap(camber_document *d, const json_t *json, camber_style_layer *layer) {
    static const char *const names[] = {[CAMBER_OVERLAP_FLATTEN] = "flatten",
                                        [CAMBER_OVERLAP_ACCUMULATE] = "accumulate",
                                        [CAMBER_OVERLAP_UNITE] = "unite"};
    static const char key[] = "camber:overlap";
    const json_t *overlap = json_object_get(json_object_get(json, "metadata"), key);
    if (!overlap)
        return true;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (json_is_string(overlap) && strcmp(json_string_value(overlap), names[i]) == 0) {
            const bool other = layer->kind == CAMBER_LAYER_CIRCLE || layer->kind == CAMBER_LAYER_SYMBOL;
            if (other || (layer->kind == CAMBER_LAYER_FILL && i != CAMBER_OVERLAP_FLATTEN))
                warn_overlap(d, key, layer->kind);
            if (other)
                return true;
            layer->overlap = (camber_overlap)i;
            d->compiler.style->accumulates |= layer->overlap == CAMBER_OVERLAP_ACCUMULATE;
            return true;
        }
    return fail_metadata(d, key, "expected \"flatten\", \"accumulate\" or \"unite\"; write one of them");
}

/* Reads metadata such as {"camber:repeat": PX}, a number from 0 to 1000. */
static bool read_size(camber_document *d, const json_t *json, const char *key, double missing, double *size) {
    const json_t *value = json_object_get(json_object_get(json, "metadata"), key);
    *size = value ? json_number_value(value) : missing;
    return !value || (json_is_number(value) && *size >= 0.0 && *size <= 1000.0) ||
           fail_metadata(d, key, "expected a number of px from 0 to 1000; write one");
}

static bool read_metadata(camber_document *d, const json_t *json, camber_style_layer *layer) {
    return read_overlap(d, json, layer) && read_flag(d, json, "camber:plain", &layer->plain) &&
           read_flag(d, json, "camber:tuck", &layer->tucks) &&
           read_size(d, json, "camber:repeat", -1.0, &layer->repeat_px) &&
           read_size(d, json, "camber:least-area", 0.0, &layer->least_area);
}

/* Dots stand for the round caps of a layer that tucks them, so these must look like a dot. */
static void check_tucks(camber_document *d, camber_style_layer *layer) {
    static const camber_property_id others[] = {CAMBER_LINE_OFFSET,    CAMBER_LINE_GAP_WIDTH, CAMBER_LINE_BLUR,
                                                CAMBER_LINE_DASHARRAY, CAMBER_LINE_PATTERN,   CAMBER_LINE_GRADIENT};
    bool fits = layer->kind == CAMBER_LAYER_LINE && layer->overlap != CAMBER_OVERLAP_ACCUMULATE;
    const size_t depth = d->compiler.path_length;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        fits = fits && !layer->properties[others[i]];
    if (!layer->tucks || fits)
        return;
    layer->tucks = false;
    camber_compiler_enter_key(&d->compiler, "metadata");
    camber_compiler_enter_key(&d->compiler, "camber:tuck");
    camber_compiler_warn(&d->compiler,
                         "applies only to line layers without line-offset, line-gap-width, line-blur, line-dasharray, "
                         "line-pattern, line-gradient and \"camber:overlap\": \"accumulate\"; leave it out");
    d->compiler.path_length = depth;
}

/* ---- Filters ---- */

static bool write_filter_key(camber_compiler *c, const json_t *filter, char **key) {
    const size_t size = filter ? json_dumpb(filter, NULL, 0, JSON_COMPACT | JSON_ENCODE_ANY) : 0;
    *key = camber_alloc(c->context, size + 1, 1);
    if (!*key) {
        c->status = CAMBER_ERROR_MEMORY;
        return false;
    }
    (*key)[size] = 0;
    /* A filter's text is never empty, so jansson has run out of memory. */
    if (filter && (size == 0 || json_dumpb(filter, *key, size, JSON_COMPACT | JSON_ENCODE_ANY) != size))
        c->status =
            camber_fail(c->context, CAMBER_ERROR_MEMORY, "%s: out of memory for a filter; make it shorter", c->name);
    return c->status == CAMBER_OK;
}

static bool read_filter(camber_document *d, const json_t *json, camber_style_layer *layer) {
    camber_compiler *c = &d->compiler;
    json_t *filter = json_object_get(json, "filter");
    const size_t depth = c->path_length;
    if (!filter || layer->kind == CAMBER_LAYER_BACKGROUND)
        return write_filter_key(c, NULL, &layer->filter_key);
    camber_compiler_enter_key(c, "filter");
    if (!camber_compile_filter(c, filter, &layer->filter))
        return camber_document_continues(d, depth);
    if (!write_filter_key(c, filter, &layer->filter_key))
        return false;
    camber_compiler_leave(c);
    return true;
}

/* ---- Gradients ---- */

static camber_color opaque_border(camber_color color) {
    camber_color border = camber_border_color(color);
    border.a = color.a;
    return border;
}

/* Makes the ramps of the line and its border. A border without a colour gets a colour that is derived from the line's.
 */
static camber_status make_ramps(camber_compiler *c, camber_style_layer *layer) {
    const char *cause;
    double at = 0.0;
    camber_status status = camber_layer_ramp_create(layer->properties[CAMBER_LINE_GRADIENT], &layer->ramp, &cause, &at);
    if (status == CAMBER_OK && cause)
        camber_compiler_warn(c, "at a progress of %.6g: %s; nothing is drawn there", at, cause);
    if (status == CAMBER_OK && layer->properties[CAMBER_LINE_BORDER_WIDTH] &&
        !layer->properties[CAMBER_LINE_BORDER_COLOR])
        status = camber_layer_ramp_copy(c->context, &layer->ramp, opaque_border, &layer->border_ramp);
    return status;
}

static bool read_gradient(camber_document *d, camber_style_layer *layer) {
    camber_compiler *c = &d->compiler;
    if (layer->kind != CAMBER_LAYER_LINE || !layer->properties[CAMBER_LINE_GRADIENT])
        return true;
    camber_compiler_enter_key(c, "paint");
    camber_compiler_enter_key(c, "line-gradient");
    const camber_status status = make_ramps(c, layer);
    camber_compiler_leave(c);
    camber_compiler_leave(c);
    if (status != CAMBER_OK)
        c->status = status;
    return status == CAMBER_OK;
}

/* ---- Layers ---- */

static bool find_source(camber_document *d, camber_style_layer *layer) {
    camber_compiler *c = &d->compiler;
    const camber_style *style = c->style;
    const size_t depth = c->path_length;
    const json_t *index = layer->source ? json_object_get(d->source_indices, layer->source) : NULL;
    layer->source_index = index ? (uint32_t)json_integer_value(index) : CAMBER_NO_SOURCE;
    /* A style without sources is for files that are given separately. */
    if (!layer->source || layer->source_index != CAMBER_NO_SOURCE || style->source_count == 0)
        return true;
    camber_compiler_enter_key(c, "source");
    camber_compiler_fail(c, "the style has no source \"%.64s\"; add it to \"sources\", or name one of those there",
                         layer->source);
    return camber_document_continues(d, depth);
}

static bool read_layer(camber_document *d, const json_t *json, camber_style_layer *layer) {
    layer->max_zoom = 24.0;
    if (!camber_document_read_string(d, json, "id", &layer->id) ||
        !camber_document_read_string(d, json, "source", &layer->source) ||
        !camber_document_read_string(d, json, "source-layer", &layer->source_layer) ||
        !camber_document_read_number(d, json, "minzoom", 0.0, 24.0, &layer->min_zoom) ||
        !camber_document_read_number(d, json, "maxzoom", 0.0, 24.0, &layer->max_zoom))
        return false;
    if (!read_layer_visibility(d, json, layer) || !read_metadata(d, json, layer) || !find_source(d, layer) ||
        !read_filter(d, json, layer) || !read_properties(d, json, "layout", layer) ||
        !read_properties(d, json, "paint", layer) || !read_gradient(d, layer))
        return false;
    check_tucks(d, layer);
    return true;
}

void camber_style_layer_free(camber_context *context, camber_style_layer *layer) {
    for (size_t i = 0; i < CAMBER_PROPERTIES; i++)
        camber_expression_destroy(context, layer->properties[i]);
    camber_free(context, layer->ramp.stops);
    camber_free(context, layer->border_ramp.stops);
    camber_expression_destroy(context, layer->filter);
    camber_free(context, layer->filter_key);
    camber_free(context, layer->source_layer);
    camber_free(context, layer->source);
    camber_free(context, layer->id);
}

bool camber_layer_kind_find(const char *type, camber_layer_kind *kind) {
    static const char *const types[] = {[CAMBER_LAYER_BACKGROUND] = "background",
                                        [CAMBER_LAYER_LINE] = "line",
                                        [CAMBER_LAYER_FILL] = "fill",
                                        [CAMBER_LAYER_CIRCLE] = "circle",
                                        [CAMBER_LAYER_SYMBOL] = "symbol"};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (strcmp(types[i], type) == 0) {
            *kind = (camber_layer_kind)i;
            return true;
        }
    return false;
}

/* Whether the specification has this type of layer, although it is not supported. Other types are misspelled. */
static bool is_known_type(const char *type) {
    static const char *const types[] = {"heatmap", "fill-extrusion", "raster", "hillshade", "color-relief", "sky"};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (strcmp(types[i], type) == 0)
            return true;
    return false;
}

/* A layer with a "ref" takes everything except its paint properties from the referenced layer. *resolved is a new
 * reference. */
static bool resolve_reference(camber_document *d, json_t *json, json_t **resolved) {
    static const char *const taken[] = {"type", "source", "source-layer", "minzoom", "maxzoom", "filter", "layout"};
    camber_compiler *c = &d->compiler;
    const json_t *ref = json_object_get(json, "ref");
    *resolved = json_incref(json);
    if (!ref)
        return true;
    camber_compiler_enter_key(c, "ref");
    const json_t *parent = json_is_string(ref) ? json_object_get(d->by_id, json_string_value(ref)) : NULL;
    if (!parent || json_object_get(parent, "ref"))
        return camber_compiler_fail(c, !parent ? "no layer has this id; use the id of another layer"
                                               : "the layer itself refers to another one; refer to that one instead");
    camber_compiler_leave(c);
    json_t *made = json_copy(json);
    bool done = made != NULL;
    for (size_t i = 0; i < sizeof taken / sizeof *taken && done; i++) {
        json_t *value = json_object_get(parent, taken[i]);
        done = !value || json_object_set(made, taken[i], value) == 0;
    }
    json_decref(*resolved);
    *resolved = made;
    return done || camber_compiler_fail_memory(&d->compiler);
}

/* Appends the layer if its type is supported. */
static bool read_resolved(camber_document *d, const json_t *json) {
    camber_compiler *c = &d->compiler;
    camber_style *style = c->style;
    const char *type = json_string_value(json_object_get(json, "type"));
    if (!type)
        return camber_compiler_fail(c, "the layer has no \"type\" that is a string; write e.g. \"type\": \"line\"");
    camber_layer_kind kind;
    if (!camber_layer_kind_find(type, &kind)) {
        if (camber_document_first_time(d, type))
            camber_compiler_warn(c,
                                 is_known_type(type) ? "layers of type \"%.64s\" are not supported and are left out"
                                                     : "layers of the unknown type \"%.64s\" are left out",
                                 type);
        return true;
    }
    camber_style_layer *layer = &style->layers[style->layer_count++];
    layer->kind = kind;
    layer->overlap = kind == CAMBER_LAYER_CIRCLE ? CAMBER_OVERLAP_ACCUMULATE : CAMBER_OVERLAP_FLATTEN;
    const unsigned kinds = camber_style_layer_kinds(kind);
    c->readers = json_object_get(json, "source-layer") ? (camber_property_readers){.named_kinds = kinds}
                                                       : (camber_property_readers){.kinds = kinds};
    const size_t depth = c->path_length;
    const bool done = read_layer(d, json, layer);
    c->readers = (camber_property_readers){0};
    if (!c->leaves_out || (c->status != CAMBER_OK && c->status != CAMBER_ERROR_INPUT))
        return done;
    c->leaves_out = false;
    c->status = CAMBER_OK;
    c->path_length = depth;
    camber_style_layer_free(c->context, layer);
    memset(layer, 0, sizeof *layer);
    style->layer_count--;
    d->left_out[kind]++;
    return true;
}

static bool read_any_layer(camber_document *d, json_t *json) {
    static const char *const known[] = {"id",     "type",   "metadata", "source", "source-layer", "minzoom", "maxzoom",
                                        "filter", "layout", "paint",    "ref",    "interactive",  NULL};
    camber_compiler *c = &d->compiler;
    json_t *resolved = NULL;
    if (!json_is_object(json))
        return camber_compiler_fail(c, "expected a layer, an object, found %s; take it out", camber_json_name(json));
    if (!json_is_string(json_object_get(json, "id")))
        return camber_compiler_fail(c, "the layer has no \"id\" that is a string; name it");
    camber_document_warn_unknown(d, json, known, "layer");
    const bool done = resolve_reference(d, json, &resolved) && read_resolved(d, resolved);
    json_decref(resolved);
    return done;
}

/* ---- All of them ---- */

typedef struct layer_id {
    const char *id;
    size_t index;
} layer_id;

static int compare_ids(const void *left, const void *right) {
    const layer_id *a = left, *b = right;
    const int order = strcmp(a->id, b->id);
    return order ? order : a->index < b->index ? -1 : a->index > b->index;
}

static bool check_ids(camber_document *d, const json_t *layers) {
    camber_compiler *c = &d->compiler;
    const size_t depth = c->path_length;
    size_t count = 0;
    layer_id *ids = camber_alloc(c->context, json_array_size(layers), sizeof *ids);
    if (!ids)
        return camber_document_fail_memory(d);
    for (size_t i = 0; i < json_array_size(layers); i++) {
        const char *id = json_string_value(json_object_get(json_array_get(layers, i), "id"));
        if (id)
            ids[count++] = (layer_id){id, i};
    }
    qsort(ids, count, sizeof *ids, compare_ids);
    bool continues = true;
    for (size_t i = 1; i < count && continues; i++) {
        if (strcmp(ids[i - 1].id, ids[i].id) != 0)
            continue;
        camber_compiler_enter_index(c, ids[i].index);
        camber_compiler_enter_key(c, "id");
        camber_compiler_fail(c, "\"%.64s\" is also the id of /layers/%zu; rename one of them", ids[i].id,
                             ids[i - 1].index);
        continues = camber_document_continues(d, depth);
    }
    camber_free(c->context, ids);
    return continues;
}

static bool index_layers(camber_document *d, const json_t *layers) {
    json_t *layer;
    size_t i;
    d->by_id = json_object();
    bool done = d->by_id != NULL;
    json_array_foreach(layers, i, layer) {
        const char *id = json_string_value(json_object_get(layer, "id"));
        done = done && (!id || json_object_set(d->by_id, id, layer) == 0);
    }
    return done || camber_compiler_fail_memory(&d->compiler);
}

bool camber_document_read_layers(camber_document *d, const json_t *layers) {
    camber_compiler *c = &d->compiler;
    camber_compiler_enter_key(c, "layers");
    const size_t depth = c->path_length;
    if (!json_is_array(layers))
        return camber_compiler_fail(c, "expected an array of layers; write \"layers\": [...]");
    camber_style *style = c->style;
    const size_t count = json_array_size(layers);
    if (!(style->layers = camber_alloc_zero(c->context, count, sizeof *style->layers)) ||
        !(style->schema.source_layers = camber_alloc(c->context, count, sizeof *style->schema.source_layers)))
        return camber_document_fail_memory(d);
    if (!index_layers(d, layers))
        return false;
    for (size_t i = 0; i < count; i++) {
        camber_compiler_enter_index(c, i);
        if (read_any_layer(d, json_array_get(layers, i)))
            camber_compiler_leave(c);
        else if (!camber_document_continues(d, depth))
            return false;
    }
    if (!check_ids(d, layers))
        return false;
    camber_style_describe_layers(style);
    camber_compiler_leave(c);
    return true;
}
