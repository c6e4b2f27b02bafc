/* Opens the sources that a style's layers name, and reads them.
 *
 * Input: the style, the folder that its relative paths start from, and the quadrangle that the view sees. Output:
 * features. GeoJSON is read when it is opened; tiles are read for the view, at its zoom. */
#include "map/sources.h"
#include "features/mercator.h"
#include "features/rings.h"
#include "formats/geojson.h"
#include "formats/tile_reader.h"
#include "style/json.h"
#include "style/style.h"
#include "style/url.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <sys/stat.h>

typedef struct source {
    const camber_style_source *style;
    uint32_t index;
    char what[160];       /* source "name", for messages */
    char pointer[1024];   /* STYLE: /sources/name, for messages about the style */
    camber_tile_set *set; /* only for a vector source */
    bool is_bounded;      /* the document has bounds: there are no tiles outside */
    double bounds[4];     /* world coordinates; x0 > x1: unknown */
} source;

struct camber_sources {
    camber_context *context;
    camber_features *features;
    camber_sources_desc desc;
    source *items;
    size_t count;
};

/* Returns the kinds of features that a layer takes: CAMBER_KIND_*. A fill draws outlines if they have a colour. labels:
 * the kinds of labels that are read. */
static unsigned kinds_of(const camber_style_layer *layer, unsigned labels) {
    switch (layer->kind) {
    case CAMBER_LAYER_BACKGROUND: return 0;
    case CAMBER_LAYER_SYMBOL:
        return labels & ((camber_style_layer_may_take(layer, "LineString") ? CAMBER_KIND_LABEL_LINE : 0u) |
                         (camber_style_layer_may_take(layer, "Polygon") ? CAMBER_KIND_LABEL_AREA : 0u) |
                         (camber_style_layer_may_take(layer, "Point") ? CAMBER_KIND_LABEL_POINT : 0u));
    case CAMBER_LAYER_LINE:
        return (camber_style_layer_may_take(layer, "LineString") ? CAMBER_KIND_LINE : 0u) |
               (camber_style_layer_may_take(layer, "Polygon") ? CAMBER_KIND_POLYGON : 0u);
    case CAMBER_LAYER_CIRCLE:
        return (camber_style_layer_may_take(layer, "Point") ? CAMBER_KIND_POINT : 0u) |
               (camber_style_layer_may_take(layer, "LineString") ? CAMBER_KIND_LINE : 0u) |
               (camber_style_layer_may_take(layer, "Polygon") ? CAMBER_KIND_POLYGON : 0u);
    case CAMBER_LAYER_FILL: break;
    }
    return CAMBER_KIND_AREA | (layer->properties[CAMBER_FILL_OUTLINE_COLOR] ? CAMBER_KIND_POLYGON : 0u);
}

static bool is_drawn_from(const camber_style_layer *layer, uint32_t index, unsigned labels) {
    return kinds_of(layer, labels) && layer->visible && layer->source_index == index;
}

/* Returns the kinds of features that the style takes from a source. source_layer: NULL for the whole source. */
static unsigned kinds_from(const camber_features *features, uint32_t index, const char *source_layer) {
    const camber_style *style = features->style;
    const unsigned labels = camber_features_label_kinds(features);
    unsigned kinds = 0;
    for (size_t i = 0; i < style->layer_count; i++) {
        const camber_style_layer *layer = &style->layers[i];
        if (is_drawn_from(layer, index, labels) &&
            (!source_layer || (layer->source_layer && strcmp(layer->source_layer, source_layer) == 0)))
            kinds |= kinds_of(layer, labels);
    }
    return kinds;
}

static camber_status load_json(camber_context *context, const char *what, const char *path, json_t **root) {
    char *text;
    size_t size;
    json_error_t error;
    camber_status status = camber_read_file(context, path, CAMBER_NAMED_BY_STYLE, &text, &size);
    if (status != CAMBER_OK)
        return status;
    if (!camber_budget_has(context, CAMBER_GEOJSON_BYTES_A_BYTE * (uint64_t)size)) {
        camber_free(context, text);
        return camber_budget_fail(context, CAMBER_GEOJSON_BYTES_A_BYTE * (uint64_t)size);
    }
    status = camber_json_load(context, text, size, JSON_DECODE_INT_AS_REAL | JSON_ALLOW_NUL, true, root, &error);
    camber_free(context, text);
    if (status != CAMBER_ERROR_INPUT)
        return status;
    camber_json_unquote(&error);
    return camber_fail(context, CAMBER_ERROR_INPUT, "%s: %s: invalid JSON at line %d, column %d: %s; %s", what, path,
                       error.line, error.column, error.text,
                       json_error_code(&error) == json_error_invalid_utf8 ? camber_json_cure(&error)
                                                                          : "get the file again");
}

/* Fails if a file is missing. The message gives the style's own advice, if it has one, or says to check the path. */
static camber_status check_exists(const camber_sources *sources, const source *one, const char *path) {
    struct stat about;
    if (!camber_file_is_reached(sources->context, path) || stat(path, &about) == 0 ||
        (errno != ENOENT && errno != ENOTDIR))
        return CAMBER_OK;
    return camber_fail(sources->context, CAMBER_ERROR_NOT_FOUND, "%s: %s: no such file; %s", one->pointer, path,
                       one->style->missing ? one->style->missing : "check the path in the style");
}

/* ---- GeoJSON ---- */

static void warn_invalid(const camber_sources *sources, const char *what, size_t points) {
    if (points)
        camber_log(sources->context, CAMBER_LOG_WARNING,
                   "%s: %zu points are not numbers and are left out; their lines are split there", what, points);
}

static void warn_of_losses(const camber_sources *sources, const char *what, size_t damaged, const char *damage,
                           size_t skipped) {
    if (damaged)
        camber_log(sources->context, CAMBER_LOG_WARNING,
                   "%s: %zu damaged features (the first: %s); their readable parts are kept", what, damaged, damage);
    if (skipped)
        camber_log(sources->context, CAMBER_LOG_INFO, "%s: left out what is %s of %zu features", what,
                   camber_features_left_out(camber_features_kinds(sources->features, false)), skipped);
}

static camber_status fail_damaged(const camber_sources *sources, const char *what, const char *damage) {
    return camber_fail(sources->context, CAMBER_ERROR_INPUT,
                       "%s: no feature can be read: %s; correct it, or get the file again", what, damage);
}

static bool is_selected(const void *user, const camber_feature_view *feature) {
    return camber_style_source_matches(user, feature);
}

static camber_status read_geojson(camber_sources *sources, source *one) {
    camber_context *context = sources->context;
    const camber_features_stats before = sources->features->stats;
    const size_t features_before = sources->features->feature_count;
    const size_t first_polyline = sources->features->polyline_count;
    const json_t *data = json_object_get(one->style->json, "data");
    json_t *loaded = NULL;
    camber_status status = CAMBER_OK;
    if (json_is_string(data)) {
        camber_url url = {0};
        status = camber_url_resolve(context, one->pointer, json_string_value(data), sources->desc.base_path, &url);
        if (status == CAMBER_OK)
            status = check_exists(sources, one, url.path);
        if (status == CAMBER_OK)
            status = load_json(context, one->what, url.path, &loaded);
        camber_free(context, url.path);
    } else if (!json_is_object(data)) {
        status = camber_fail(context, CAMBER_ERROR_INPUT, "%s: no \"data\"; write GeoJSON, or the path of a file",
                             one->pointer);
    }
    camber_geojson_stats stats = {0};
    const camber_geojson_desc desc = {.what = one->what,
                                      .root = loaded ? loaded : data,
                                      .promote_id = json_object_get(one->style->json, "promoteId"),
                                      .generates_ids = json_is_true(json_object_get(one->style->json, "generateId")),
                                      .matches = is_selected,
                                      .user = one->style,
                                      .kinds = kinds_from(sources->features, one->index, NULL)};
    if (status == CAMBER_OK)
        status = camber_geojson_read(sources->features, &desc, &stats);
    json_decref(loaded);
    if (status == CAMBER_OK && stats.damaged_features && sources->features->feature_count == features_before)
        status = fail_damaged(sources, one->what, stats.damage);
    if (status != CAMBER_OK)
        return status;
    memcpy(one->bounds, stats.bounds, sizeof one->bounds);
    sources->features->stats.skipped_features += stats.skipped_features;
    sources->features->stats.damaged_features += stats.damaged_features;
    sources->features->stats.invalid_points += stats.invalid_points;
    warn_of_losses(sources, one->what, stats.damaged_features, stats.damage, stats.skipped_features);
    warn_invalid(sources, one->what, stats.invalid_points);
    camber_rings_report(sources->features, one->what, first_polyline, &before);
    return camber_features_add_attribution(sources->features,
                                           json_string_value(json_object_get(one->style->json, "attribution")));
}

/* ---- Vector tiles: opening ---- */

static camber_status open_archive(camber_sources *sources, source *one, const camber_url *url) {
    const camber_status status = check_exists(sources, one, url->path);
    if (status != CAMBER_OK)
        return status;
    if (url->kind == CAMBER_URL_FILE || camber_tile_set_knows(url->path))
        return camber_tile_set_open(sources->context, url->path, CAMBER_NAMED_BY_STYLE, &one->set);
    return camber_fail(sources->context, CAMBER_ERROR_INPUT,
                       "%s: the name %s does not end in .mbtiles or .pmtiles; rename the file", one->what, url->path);
}

/* about: the style's own object, or the TileJSON file at base_path. */
static camber_status open_template(camber_sources *sources, source *one, const json_t *about, const char *base_path) {
    const bool is_style = base_path == sources->desc.base_path;
    const char *pointer = is_style ? one->pointer : base_path;
    const char *text = json_string_value(json_array_get(json_object_get(about, "tiles"), 0));
    const char *scheme = json_string_value(json_object_get(about, "scheme"));
    camber_url url = {0};
    if (!text)
        return camber_fail(sources->context, CAMBER_ERROR_INPUT,
                           "%s: no %s\"tiles\" with a URL; write \"tiles\": [\"tiles/{z}/{x}/{y}.mvt\"]", pointer,
                           is_style ? "\"url\" and no " : "");
    camber_status status = camber_url_resolve(sources->context, pointer, text, base_path, &url);
    if (status == CAMBER_OK && url.kind != CAMBER_URL_FILE) {
        status = open_archive(sources, one, &url);
    } else if (status == CAMBER_OK) {
        const camber_tile_template files = {.name = text,
                                            .path = url.path,
                                            .south_first = scheme && strcmp(scheme, "tms") == 0,
                                            .high_resolution = sources->desc.ratio > 1.0};
        status = camber_tile_set_of_files(sources->context, &files, &one->set);
    }
    camber_free(sources->context, url.path);
    return status;
}

/* about: the style's own object, whose members override the members of the TileJSON file. */
static camber_status open_tilejson(camber_sources *sources, source *one, const char *path, json_t *about) {
    json_t *loaded = NULL;
    camber_status status = check_exists(sources, one, path);
    if (status == CAMBER_OK)
        status = load_json(sources->context, one->what, path, &loaded);
    if (status != CAMBER_OK)
        return status;
    /* Paths in the TileJSON file start from its own folder. */
    const char *base_path = json_object_get(about, "tiles") ? sources->desc.base_path : path;
    json_object_update_missing(about, loaded);
    json_decref(loaded);
    return open_template(sources, one, about, base_path);
}

static void set_bounds(source *one) {
    const double *degrees = one->set->bounds;
    if (!one->set->has_bounds)
        return;
    double y[2];
    for (int i = 0; i < 2; i++)
        y[i] = fmin(fmax(degrees[1 + 2 * i], -CAMBER_MERCATOR_LATITUDE), CAMBER_MERCATOR_LATITUDE);
    camber_mercator_project(degrees[0], y[1], &one->bounds[0], &one->bounds[1]);
    camber_mercator_project(degrees[2], y[0], &one->bounds[2], &one->bounds[3]);
}

static camber_status open_vector(camber_sources *sources, source *one) {
    camber_context *context = sources->context;
    json_t *about = json_copy(one->style->json);
    const char *text = json_string_value(json_object_get(about, "url"));
    camber_url url = {0};
    camber_status status = about ? CAMBER_OK : camber_fail(context, CAMBER_ERROR_MEMORY, "out of memory for a source");
    if (status == CAMBER_OK && text)
        status = camber_url_resolve(context, one->pointer, text, sources->desc.base_path, &url);
    if (status != CAMBER_OK)
        goto done;
    if (!text)
        status = open_template(sources, one, about, sources->desc.base_path);
    else if (url.kind != CAMBER_URL_FILE || camber_tile_set_knows(url.path))
        status = open_archive(sources, one, &url);
    else
        status = open_tilejson(sources, one, url.path, about);
    if (status != CAMBER_OK)
        goto done;
    status = camber_tile_set_describe(one->set, about);
    one->is_bounded = json_object_get(about, "bounds") != NULL;
    set_bounds(one);
    if (status == CAMBER_OK && one->set->min_zoom > one->set->max_zoom)
        status = camber_fail(context, CAMBER_ERROR_INPUT, "%s: minzoom %d is greater than maxzoom %d; swap them",
                             one->what, one->set->min_zoom, one->set->max_zoom);
done:
    camber_free(context, url.path);
    json_decref(about);
    return status;
}

/* ---- All of them ---- */

/* Merges the lines that one source added, and computes the importance of their points. Lines are not merged if dashes
 * or line-progress restart with each feature, or if the style wants overlapping ends to darken each other. */
static camber_status merge_and_weigh(camber_features *features, size_t first_polyline) {
    const camber_style *style = features->style;
    const bool merges = !style->schema.directed && !style->accumulates && !features->progress;
    const camber_status status =
        camber_features_merge_and_weigh(features, first_polyline, merges, CAMBER_MERGE_STRAIGHT);
    camber_features_count(features);
    return status;
}

static camber_status open_source(camber_sources *sources, source *one) {
    camber_features *features = sources->features;
    const size_t first_polyline = features->polyline_count;
    const char *type = one->style->type;
    features->source = one->index;
    if (strcmp(type, "vector") == 0)
        return open_vector(sources, one);
    if (strcmp(type, "geojson") == 0) {
        const camber_status status = read_geojson(sources, one);
        return status == CAMBER_OK ? merge_and_weigh(features, first_polyline) : status;
    }
    camber_log(sources->context, CAMBER_LOG_WARNING,
               "%s: sources of type %s are not supported, so its layers are left out; use vector or geojson", one->what,
               type);
    return CAMBER_OK;
}

/* Writes the source's position in the style. A style that is not a file is called by its own name. */
static void write_pointer(source *one, const camber_style *style, const char *base_path) {
    const char *name = style->name && *style->name ? style->name : "style";
    snprintf(one->pointer, sizeof one->pointer, "%.800s: /sources/", base_path ? base_path : name);
    size_t used = strlen(one->pointer);
    for (const char *c = one->style->name; *c && used + 3 < sizeof one->pointer; c++) {
        const bool is_escaped = *c == '~' || *c == '/';
        one->pointer[used++] = is_escaped ? '~' : *c;
        if (is_escaped)
            one->pointer[used++] = *c == '~' ? '0' : '1';
    }
    one->pointer[used] = 0;
}

camber_status camber_sources_open(camber_features *features, const camber_sources_desc *desc,
                                  camber_sources **sources) {
    camber_context *context = features->context;
    const camber_style *style = features->style;
    camber_sources *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    *made = (camber_sources){.context = context, .features = features, .desc = *desc};
    camber_status status = CAMBER_OK;
    if (!(made->items = camber_alloc_zero(context, style->source_count, sizeof *made->items)))
        status = CAMBER_ERROR_MEMORY;
    const double start_ms = camber_now_ms();
    for (uint32_t i = 0; status == CAMBER_OK && i < style->source_count; i++) {
        if (!kinds_from(features, i, NULL))
            continue;
        source *one = &made->items[made->count++];
        *one = (source){.style = &style->sources[i], .index = i, .bounds = {1, 1, 0, 0}};
        snprintf(one->what, sizeof one->what, "source \"%s\"", style->sources[i].name);
        write_pointer(one, style, desc->base_path);
        status = open_source(made, one);
    }
    features->times.file_ms += camber_now_ms() - start_ms;
    features->source = CAMBER_NO_SOURCE;
    if (status != CAMBER_OK) {
        camber_sources_close(made);
        return status;
    }
    *sources = made;
    return CAMBER_OK;
}

bool camber_sources_bounds(const camber_sources *sources, double bounds[4]) {
    bool any = false;
    for (size_t i = 0; i < sources->count; i++) {
        const double *one = sources->items[i].bounds;
        if (one[0] > one[2])
            continue;
        bounds[0] = any ? fmin(bounds[0], one[0]) : one[0];
        bounds[1] = any ? fmin(bounds[1], one[1]) : one[1];
        bounds[2] = any ? fmax(bounds[2], one[2]) : one[2];
        bounds[3] = any ? fmax(bounds[3], one[3]) : one[3];
        any = true;
    }
    return any;
}

/* ---- Vector tiles: reading ---- */

static size_t list_layers(const camber_features *features, uint32_t index, const char **names) {
    const camber_style *style = features->style;
    const unsigned labels = camber_features_label_kinds(features);
    size_t count = 0;
    for (size_t i = 0; i < style->layer_count; i++) {
        const camber_style_layer *layer = &style->layers[i];
        size_t k = 0;
        if (!is_drawn_from(layer, index, labels) || !layer->source_layer)
            continue;
        while (k < count && strcmp(names[k], layer->source_layer) != 0)
            k++;
        if (k == count)
            names[count++] = layer->source_layer;
    }
    return count;
}

static camber_status read_addresses(camber_sources *sources, const source *one, const camber_tile_reading *reading) {
    camber_features *features = sources->features;
    camber_tile_result result;
    const size_t first_polyline = features->polyline_count;
    const camber_features_stats before = features->stats;
    features->source = one->index;
    camber_status status = camber_features_read_tiles(features, reading, &result);
    if (status == CAMBER_OK && result.found > 0 && result.lost == result.found)
        status = fail_damaged(sources, one->what, result.stats.damage);
    if (status == CAMBER_OK)
        status = merge_and_weigh(features, first_polyline);
    if (status == CAMBER_OK)
        status = camber_features_add_attribution(features, one->set->attribution);
    if (status != CAMBER_OK)
        return status;
    camber_features_pin_borders(features, first_polyline, reading->zoom);
    camber_rings_report(features, one->what, first_polyline, &before);
    features->stats.skipped_features += result.stats.skipped_features;
    features->stats.damaged_features += result.stats.damaged_features;
    warn_of_losses(sources, one->what, result.stats.damaged_features, result.stats.damage,
                   result.stats.skipped_features);
    if (reading->address_count && result.found == 0)
        camber_log(sources->context, CAMBER_LOG_WARNING,
                   "%s: %s has none of the %zu tiles of zoom %d that the view sees; check the view, the path and the "
                   "zooms",
                   one->what, one->set->name, reading->address_count, reading->zoom);
    return CAMBER_OK;
}

static camber_status read_tiles(camber_sources *sources, const source *one, const camber_tile_cover *cover) {
    const camber_style *style = sources->features->style;
    const int zoom = (int)fmin(floor(fmax(cover->zoom, 0)), one->set->max_zoom);
    if (zoom < one->set->min_zoom)
        return CAMBER_OK;
    camber_tile_address *addresses = NULL;
    camber_tile_reading reading = {.set = one->set, .zoom = zoom};
    camber_status status = CAMBER_ERROR_MEMORY;
    const char **names = camber_alloc(sources->context, style->layer_count, sizeof *names);
    unsigned *kinds = camber_alloc(sources->context, style->layer_count, sizeof *kinds);
    if (names && kinds)
        status = camber_tile_cover_list(sources->context, cover, zoom, one->is_bounded ? one->bounds : NULL, &addresses,
                                        &reading.address_count);
    if (status == CAMBER_OK)
        status = camber_budget_take_tiles(sources->context, one->what, reading.address_count);
    if (status == CAMBER_OK) {
        reading.addresses = addresses;
        reading.mvt = (camber_mvt_desc){.features = sources->features,
                                        .layers = names,
                                        .layer_count = list_layers(sources->features, one->index, names),
                                        .layer_kinds = kinds,
                                        .wants_progress = style->schema.directed,
                                        .promote_id = json_object_get(one->style->json, "promoteId")};
        for (size_t i = 0; i < reading.mvt.layer_count; i++)
            kinds[i] = kinds_from(sources->features, one->index, names[i]);
        status = read_addresses(sources, one, &reading);
    }
    camber_free(sources->context, addresses);
    camber_free(sources->context, kinds);
    camber_free(sources->context, names);
    return status;
}

camber_status camber_sources_read(camber_sources *sources, const camber_tile_cover *cover) {
    const double start_ms = camber_now_ms(),
                 others_ms = sources->features->times.weigh_ms + sources->features->times.merge_ms;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < sources->count && status == CAMBER_OK; i++)
        if (sources->items[i].set)
            status = read_tiles(sources, &sources->items[i], cover);
    camber_features_times *times = &sources->features->times;
    times->file_ms += camber_now_ms() - start_ms - (times->weigh_ms + times->merge_ms - others_ms);
    sources->features->source = CAMBER_NO_SOURCE;
    return status;
}

void camber_sources_close(camber_sources *sources) {
    if (!sources)
        return;
    for (size_t i = 0; i < sources->count; i++)
        camber_tile_set_close(sources->items[i].set);
    camber_free(sources->context, sources->items);
    camber_free(sources->context, sources);
}
