/* Checks a style document: lists everything that is wrong with it, and says which layers and sources are drawn.
 *
 * Input: the document's bytes. Output: a report of findings, each with a JSON pointer. Reading continues after each
 * error to the end of the document, and its messages are collected instead of logged. */
#include "style/document.h"

#include <stdio.h>

/* A report, and the memory that it uses. */
typedef struct checker {
    camber_style_report report; /* the first member, because its address is given to the caller */
    camber_context *context;
    camber_style_finding *findings;
    camber_style_type *types;
    camber_style_report_source *sources;
    size_t finding_capacity, type_capacity, source_capacity;
    char **texts;
    size_t text_count, text_capacity;
    bool out_of_memory;
    camber_saved_log log; /* suppresses messages after memory has run out */
} checker;

static void fail_memory(checker *k) {
    if (!k->out_of_memory)
        camber_log_demote_errors(k->context, &k->log);
    k->out_of_memory = true;
}

static const char *keep(checker *k, const char *text) {
    char *copy = camber_copy_string(k->context, text);
    if (copy && camber_grow(k->context, &k->texts, &k->text_capacity, k->text_count + 1, sizeof *k->texts)) {
        k->texts[k->text_count++] = copy;
        return copy;
    }
    camber_free(k->context, copy);
    fail_memory(k);
    return "";
}

/* ---- Findings ---- */

static void keep_problem(void *user, const camber_compiler *c, camber_log_level level, const char *message) {
    checker *k = user;
    camber_style_report *report = &k->report;
    char pointer[CAMBER_POINTER_SIZE];
    camber_compiler_write_pointer(c, pointer);
    if (k->out_of_memory ||
        !camber_grow(k->context, &k->findings, &k->finding_capacity, report->finding_count + 1, sizeof *k->findings)) {
        fail_memory(k);
        return;
    }
    const bool error = level == CAMBER_LOG_ERROR;
    k->findings[report->finding_count++] = (camber_style_finding){error, keep(k, pointer), keep(k, message)};
    report->error_count += error;
}

/* Warns of things that are valid but may not be drawn as expected, in layers and in the sources that they name. */
static void find_in_layer(camber_document *d, const camber_style_layer *layer, const char *type) {
    camber_compiler *c = &d->compiler;
    if (layer->kind == CAMBER_LAYER_BACKGROUND)
        return;
    if (layer->min_zoom >= layer->max_zoom)
        camber_compiler_warn(c, "the layer is drawn at no zoom: its minzoom is %g, its maxzoom %g; swap or change them",
                             layer->min_zoom, layer->max_zoom);
    if (!layer->source) {
        if (c->style->source_count && camber_document_first_time(d, "source"))
            camber_compiler_warn(c, "the layer names no source; name one, or it is drawn only from input files");
        return;
    }
    if (layer->source_index == CAMBER_NO_SOURCE)
        return;
    const json_t *source = c->style->sources[layer->source_index].json;
    if (strcmp(type, "vector") == 0 && !layer->source_layer)
        camber_compiler_warn(
            c, "the layer names no \"source-layer\", which vector sources require; it is drawn from all of them");
    for (unsigned i = 0; i < CAMBER_PROPERTIES; i++)
        if (layer->properties[i] && camber_property_rows[i].needs_line_metrics &&
            !json_is_true(json_object_get(source, "lineMetrics")))
            camber_compiler_warn(c, "%s needs a geojson source with \"lineMetrics\": true; add that to \"%.64s\"",
                                 camber_property_rows[i].property.name, layer->source);
}

/* The style has only the layers that are drawn, in the document's order. */
static void find_in_layers(camber_document *d) {
    camber_compiler *c = &d->compiler;
    const json_t *layers = json_object_get(d->root, "layers");
    size_t drawn = 0;
    camber_compiler_enter_key(c, "layers");
    for (size_t i = 0; i < json_array_size(layers) && drawn < c->style->layer_count; i++) {
        const camber_style_layer *layer = c->style->layers + drawn;
        const char *id = json_string_value(json_object_get(json_array_get(layers, i), "id"));
        if (!id || !layer->id || strcmp(id, layer->id) != 0)
            continue;
        drawn++;
        camber_compiler_enter_index(c, i);
        find_in_layer(d, layer,
                      layer->source_index == CAMBER_NO_SOURCE ? "" : c->style->sources[layer->source_index].type);
        camber_compiler_leave(c);
    }
    camber_compiler_leave(c);
}

/* ---- Sources ---- */

static void fail_at(camber_document *d, const char *key, const char *message) {
    const size_t depth = d->compiler.path_length;
    camber_compiler_enter_key(&d->compiler, key);
    camber_compiler_fail(&d->compiler, "%s", message);
    camber_document_continues(d, depth);
}

static bool is_one_of(const char *text, const char *const *names) {
    while (*names && strcmp(*names, text) != 0)
        names++;
    return *names != NULL;
}

static bool are_strings(const json_t *array) {
    for (size_t i = 0; i < json_array_size(array); i++)
        if (!json_is_string(json_array_get(array, i)))
            return false;
    return json_array_size(array) > 0;
}

static bool are_bounds(const json_t *array) {
    for (size_t i = 0; i < json_array_size(array); i++)
        if (!json_is_number(json_array_get(array, i)))
            return false;
    return json_array_size(array) == 4;
}

static void find_in_tiles(camber_document *d, const json_t *source) {
    static const char *const schemes[] = {"xyz", "tms", NULL}, *const zooms[] = {"minzoom", "maxzoom"};
    const json_t *tiles = json_object_get(source, "tiles"), *url = json_object_get(source, "url"),
                 *bounds = json_object_get(source, "bounds"), *scheme = json_object_get(source, "scheme");
    if (tiles && !are_strings(tiles))
        fail_at(d, "tiles", "expected an array of URL templates; write e.g. [\"tiles/{z}/{x}/{y}.pbf\"]");
    if (url && !json_is_string(url))
        fail_at(d, "url", "expected a URL, a string; write e.g. \"mbtiles://roads.mbtiles\"");
    if (bounds && !are_bounds(bounds))
        fail_at(d, "bounds", "expected [west, south, east, north] in degrees; write four numbers");
    if (scheme && !(json_is_string(scheme) && is_one_of(json_string_value(scheme), schemes)))
        fail_at(d, "scheme", "expected \"xyz\" or \"tms\"; write one of them");
    for (size_t i = 0; i < 2; i++) {
        const json_t *zoom = json_object_get(source, zooms[i]);
        if (zoom && !(json_number_value(zoom) >= 0.0 && json_number_value(zoom) <= 30.0 && json_is_number(zoom)))
            fail_at(d, zooms[i], "expected a zoom; write a number from 0 to 30");
    }
}

/* Reports errors that reading a source would report if a layer named it. */
static void find_in_sources(camber_document *d) {
    static const char *const types[] = {"vector", "raster", "raster-dem", "geojson", "image", "video", "canvas", NULL};
    camber_compiler *c = &d->compiler;
    const camber_style *style = c->style;
    camber_compiler_enter_key(c, "sources");
    for (size_t i = 0; i < style->source_count; i++) {
        const camber_style_source *source = style->sources + i;
        const json_t *data = json_object_get(source->json, "data");
        const bool geojson = strcmp(source->type, "geojson") == 0;
        camber_compiler_enter_key(c, source->name);
        if (!is_one_of(source->type, types))
            fail_at(d, "type", "no source has this type; write e.g. \"vector\" or \"geojson\"");
        if (geojson && !json_is_object(data) && !json_is_string(data))
            fail_at(d, "data", "expected GeoJSON or the name of a file; add one");
        if (strcmp(source->type, "vector") == 0)
            find_in_tiles(d, source->json);
        camber_compiler_leave(c);
    }
    camber_compiler_leave(c);
}

/* ---- Contents ---- */

static void list_type(checker *k, const char *type, size_t layers) {
    camber_style_report *report = &k->report;
    if (k->out_of_memory ||
        !camber_grow(k->context, &k->types, &k->type_capacity, report->type_count + 1, sizeof *k->types)) {
        fail_memory(k);
        return;
    }
    camber_layer_kind kind;
    const bool drawn = camber_layer_kind_find(type, &kind);
    k->types[report->type_count++] = (camber_style_type){keep(k, type), layers, drawn};
}

static size_t count_left_out(const camber_document *d, const char *type) {
    camber_layer_kind kind;
    return camber_layer_kind_find(type, &kind) ? d->left_out[kind] : 0;
}

static void count_types(checker *k, const camber_document *d) {
    const json_t *layer;
    json_t *counts = json_object(), *count;
    const char *type;
    size_t i;
    json_array_foreach(json_object_get(d->root, "layers"), i, layer) {
        const char *ref = json_string_value(json_object_get(layer, "ref"));
        type = json_string_value(json_object_get(ref ? json_object_get(d->by_id, ref) : layer, "type"));
        if (type &&
            json_object_set_new(counts, type, json_integer(json_integer_value(json_object_get(counts, type)) + 1)) != 0)
            fail_memory(k);
    }
    json_object_foreach(counts, type, count) {
        const size_t layers = (size_t)json_integer_value(count), left_out = count_left_out(d, type);
        if (left_out < layers)
            list_type(k, type, layers - left_out);
    }
    json_decref(counts);
}

static bool is_remote(const json_t *json) {
    const char *url = json_string_value(json);
    return url &&
           (strncmp(url, "http://", 7) == 0 || strncmp(url, "https://", 8) == 0 || strncmp(url, "mapbox://", 9) == 0);
}

static const char *find_trouble(const camber_style_source *source) {
    static const char *const remote =
        "it is on the network, and nothing is downloaded; save it as a file and name the file";
    const bool geojson = strcmp(source->type, "geojson") == 0;
    if (!geojson && strcmp(source->type, "vector") != 0)
        return "sources of this type are not supported; use a geojson or vector source";
    const json_t *data = json_object_get(source->json, "data"), *url = json_object_get(source->json, "url");
    const json_t *tiles = json_object_get(source->json, "tiles");
    if (geojson ? !data : !url && !tiles)
        return geojson ? "it has no \"data\"; add GeoJSON or the name of a file"
                       : "it has neither \"url\" nor \"tiles\"; add one";
    return is_remote(geojson ? data : url) || is_remote(json_array_get(tiles, 0)) ? remote : NULL;
}

static void list_sources(checker *k, const camber_style *style) {
    if (k->out_of_memory ||
        !camber_grow(k->context, &k->sources, &k->source_capacity, style->source_count, sizeof *k->sources)) {
        fail_memory(k);
        return;
    }
    for (size_t i = 0; i < style->source_count; i++) {
        const camber_style_source *source = style->sources + i;
        size_t count = 0;
        for (size_t n = 0; n < style->layer_count; n++)
            count += style->layers[n].kind != CAMBER_LAYER_BACKGROUND && style->layers[n].source_index == i;
        k->sources[i] =
            (camber_style_report_source){keep(k, source->name), keep(k, source->type), count, find_trouble(source)};
    }
    k->report.source_count = style->source_count;
}

/* ---- Reports ---- */

static camber_status check_document(checker *k, const char *json, size_t size_bytes, const char *name) {
    camber_document d = {
        .compiler = {.context = k->context, .name = name, .report = keep_problem, .report_user = k, .checks = true},
        .collects_errors = true};
    d.compiler.style = camber_alloc_zero(k->context, 1, sizeof *d.compiler.style);
    if (!d.compiler.style)
        return CAMBER_ERROR_MEMORY;
    d.compiler.style->context = k->context;
    camber_status status = camber_document_read(&d, json, size_bytes);
    if (status == CAMBER_OK) {
        find_in_sources(&d);
        find_in_layers(&d);
        count_types(k, &d);
        list_sources(k, d.compiler.style);
    }
    camber_style_destroy(d.compiler.style);
    camber_document_end(&d);
    if (k->out_of_memory)
        camber_log_restore(k->context, &k->log);
    return status == CAMBER_OK && k->out_of_memory ? CAMBER_ERROR_MEMORY : status;
}

camber_status camber_style_check(camber_context *context, const char *json, size_t size_bytes, const char *name,
                                 camber_style_report **report) {
    checker *k = camber_alloc_zero(context, 1, sizeof *k);
    if (!k)
        return CAMBER_ERROR_MEMORY;
    k->context = context;
    const camber_status status = check_document(k, json, size_bytes, name);
    if (status != CAMBER_OK) {
        camber_style_report_destroy(&k->report);
        return status;
    }
    k->report.findings = k->findings;
    k->report.types = k->types;
    k->report.sources = k->sources;
    *report = &k->report;
    return CAMBER_OK;
}

void camber_style_report_destroy(camber_style_report *report) {
    checker *k = (checker *)report;
    if (!k)
        return;
    for (size_t i = 0; i < k->text_count; i++)
        camber_free(k->context, k->texts[i]);
    camber_free(k->context, k->texts);
    camber_free(k->context, k->sources);
    camber_free(k->context, k->types);
    camber_free(k->context, k->findings);
    camber_free(k->context, k);
}
