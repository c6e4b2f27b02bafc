/* Reads a style document: its root, sources, sprites, camera and state. layer.c reads the layers.
 *
 * Input: bytes. Output: camber_style. Sources are read before the layers that refer to them. */
#include "style/document.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>

/* ---- Sources and sprites ---- */

static bool read_source(camber_document *d, const char *name, json_t *json) {
    camber_compiler *c = &d->compiler;
    const json_t *type = json_object_get(json, "type");
    if (!json_is_object(json))
        return camber_compiler_fail(c, "expected a source, an object, found %s; write {\"type\": \"vector\", ...}",
                                    camber_json_name(json));
    if (!json_is_string(type))
        return camber_compiler_fail(c, "the source has no \"type\" that is a string; write e.g. \"type\": \"geojson\"");
    camber_style_source *source = &c->style->sources[c->style->source_count++];
    if (json_object_set_new(d->source_indices, name, json_integer((json_int_t)c->style->source_count - 1)) != 0)
        return camber_compiler_fail_memory(c);
    const json_t *metadata = json_object_get(d->root, "metadata");
    const json_t *missing = json_object_get(json_object_get(metadata, "camber:missing"), name);
    source->json = json_incref(json);
    source->name = camber_copy_string(c->context, name);
    if (!source->name)
        return camber_document_fail_memory(d);
    if (json_is_string(missing) && !camber_document_copy_string(d, missing, &source->missing))
        return false;
    if (!camber_document_copy_string(d, type, &source->type))
        return false;
    json_t *filter = json_object_get(json, "filter");
    if (!filter || strcmp(source->type, "geojson") != 0)
        return true;
    camber_compiler_enter_key(c, "filter");
    const bool compiled = camber_compile_filter(c, filter, &source->filter);
    camber_compiler_leave(c);
    return compiled;
}

/* Called before the layers are read, because they refer to sources. */
static bool read_sources(camber_document *d, json_t *sources) {
    camber_compiler *c = &d->compiler;
    const char *name;
    json_t *json;
    if (!sources)
        return true;
    camber_compiler_enter_key(c, "sources");
    const size_t depth = c->path_length;
    if (!json_is_object(sources))
        return camber_compiler_fail(c, "expected an object, found %s; write {\"name\": {...}, ...}",
                                    camber_json_name(sources)) ||
               camber_document_continues(d, depth - 1);
    c->style->sources = camber_alloc_zero(c->context, json_object_size(sources), sizeof *c->style->sources);
    d->source_indices = json_object();
    if (!c->style->sources)
        return camber_document_fail_memory(d);
    if (!d->source_indices)
        return camber_compiler_fail_memory(c);
    json_object_foreach(sources, name, json) {
        camber_compiler_enter_key(c, name);
        if (!read_source(d, name, json) && !camber_document_continues(d, depth))
            return false;
        c->path_length = depth;
    }
    camber_compiler_leave(c);
    return true;
}

static bool add_sprite(camber_document *d, const char *id, const char *url) {
    camber_style *style = d->compiler.style;
    camber_style_sprite *sprite = &style->sprites[style->sprite_count++];
    sprite->id = camber_copy_string(style->context, id);
    sprite->url = sprite->id ? camber_copy_string(style->context, url) : NULL;
    return sprite->url || camber_document_fail_memory(d);
}

/* Reads one sprite URL, or several with ids. */
static bool read_sprites(camber_document *d, const json_t *json) {
    camber_compiler *c = &d->compiler;
    const size_t depth = c->path_length, count = json_is_array(json) ? json_array_size(json) : 1;
    if (!json)
        return true;
    camber_compiler_enter_key(c, "sprite");
    c->style->sprites = camber_alloc_zero(c->context, count, sizeof *c->style->sprites);
    if (!c->style->sprites)
        return camber_document_fail_memory(d);
    for (size_t i = 0; i < count; i++) {
        const json_t *item = json_is_array(json) ? json_array_get(json, i) : NULL;
        const char *url = json_string_value(item ? json_object_get(item, "url") : json);
        const char *id = item ? json_string_value(json_object_get(item, "id")) : "default";
        if (!url || !id)
            return camber_compiler_fail(c, "expected a URL, or an array of {\"id\": \"default\", \"url\": \"...\"}; "
                                           "write one of them") ||
                   camber_document_continues(d, depth);
        if (!add_sprite(d, id, url))
            return false;
    }
    c->path_length = depth;
    return true;
}

/* ---- The root ---- */

static bool read_version(camber_document *d) {
    camber_compiler *c = &d->compiler;
    const json_t *version = json_object_get(d->root, "version");
    const size_t depth = c->path_length;
    camber_compiler_enter_key(c, "version");
    if (!json_is_number(version) || json_number_value(version) < 8.0 || json_number_value(version) > 8.0)
        if (!camber_compiler_fail(c, "expected the number 8; write \"version\": 8") &&
            !camber_document_continues(d, depth))
            return false;
    c->path_length = depth;
    if (!json_object_get(d->root, "constants"))
        return true;
    camber_compiler_enter_key(c, "constants");
    return camber_compiler_fail(c, "version 8 has no constants; write their values where they are used") ||
           camber_document_continues(d, depth);
}

/* The same limit as the map's view has. */
static const double PITCH_MAX_DEG = 85.0;

static bool read_camera(camber_document *d) {
    camber_compiler *c = &d->compiler;
    camber_style_camera *camera = &c->style->camera;
    const json_t *center = json_object_get(d->root, "center");
    const size_t depth = c->path_length;
    if (center) {
        const json_t *longitude = json_array_get(center, 0), *latitude = json_array_get(center, 1);
        camber_compiler_enter_key(c, "center");
        if (json_array_size(center) != 2 || !json_is_number(longitude) || !json_is_number(latitude) ||
            !(fabs(json_number_value(longitude)) <= 360.0 && fabs(json_number_value(latitude)) <= 90.0)) {
            camber_compiler_fail(c, "expected a position; write [longitude, latitude] in degrees");
            if (!camber_document_continues(d, depth))
                return false;
        } else {
            camera->longitude = json_number_value(longitude);
            camera->latitude = json_number_value(latitude);
        }
        c->path_length = depth;
    }
    if (!camber_document_read_number(d, d->root, "zoom", 0.0, 24.0, &camera->zoom) ||
        !camber_document_read_number(d, d->root, "bearing", -1e6, 1e6, &camera->bearing_deg) ||
        !camber_document_read_number(d, d->root, "pitch", 0.0, 180.0, &camera->pitch_deg))
        return false;
    if (camera->pitch_deg > PITCH_MAX_DEG && camber_document_first_time(d, "pitch")) {
        camber_compiler_enter_key(c, "pitch");
        camber_compiler_warn(c, "a pitch above 85 is drawn as 85; write 0 to 85");
        camber_compiler_leave(c);
    }
    return true;
}

/* Reads the defaults of ["global-state", key]. */
static bool read_state(camber_document *d) {
    camber_compiler *c = &d->compiler;
    json_t *state = json_object_get(d->root, "state"), *value;
    const size_t depth = c->path_length;
    const char *key;
    if (!state)
        return true;
    camber_compiler_enter_key(c, "state");
    bool good = json_is_object(state);
    json_object_foreach(state, key, value) {
        good = good && json_is_object(value) && json_object_get(value, "default");
    }
    if (!good)
        return camber_compiler_fail(c, "expected values with a default; write {\"name\": {\"default\": 1}, ...}") ||
               camber_document_continues(d, depth);
    c->style->state = json_incref(state);
    c->state = state;
    c->state_defaults = true;
    camber_compiler_leave(c);
    return true;
}

static void warn_at(camber_document *d, const char *key, const char *message) {
    camber_compiler_enter_key(&d->compiler, key);
    camber_compiler_warn(&d->compiler, "%s", message);
    camber_compiler_leave(&d->compiler);
}

/* Warns of root properties that would change the positions of lines. */
static void warn_of_places(camber_document *d) {
    const json_t *projection = json_object_get(json_object_get(d->root, "projection"), "type");
    if (projection && !(json_is_string(projection) && strcmp(json_string_value(projection), "mercator") == 0))
        warn_at(d, "projection", "maps are drawn in Web Mercator; write {\"type\": \"mercator\"}");
    if (json_is_object(json_object_get(d->root, "terrain")))
        warn_at(d, "terrain", "maps are drawn flat; leave it out");
}

static bool read_document(camber_document *d) {
    /* These include properties that do not affect lines: properties for other layer types and for animated pictures,
     * and properties that style editors store. */
    static const char *const known[] = {
        "version", "name",      "metadata", "center",     "centerAltitude", "zoom",   "bearing",    "pitch",
        "roll",    "state",     "light",    "sources",    "sprite",         "glyphs", "font-faces", "transition",
        "layers",  "constants", "sky",      "projection", "terrain",        "id",     "created",    "modified",
        "owner",   NULL};
    camber_compiler *c = &d->compiler;
    if (!json_is_object(d->root))
        return camber_compiler_fail(c, "expected a style document, an object, found %s; pass a MapLibre style",
                                    camber_json_name(d->root));
    if (!read_version(d))
        return false;
    camber_document_warn_unknown(d, d->root, known, "style");
    warn_of_places(d);
    return camber_document_read_string(d, d->root, "name", &c->style->name) &&
           camber_document_read_string(d, d->root, "glyphs", &c->style->glyphs) && read_camera(d) && read_state(d) &&
           read_sprites(d, json_object_get(d->root, "sprite")) &&
           read_sources(d, json_object_get(d->root, "sources")) &&
           camber_document_read_layers(d, json_object_get(d->root, "layers"));
}

static bool fail_json(camber_document *d, const json_error_t *error) {
    camber_compiler *c = &d->compiler;
    /* If jansson runs out of memory, it usually reports a wrong character. */
    if (json_error_code(error) != json_error_out_of_memory && errno != ENOMEM)
        return camber_compiler_fail(c, "line %d, column %d: %s; %s", error->line, error->column, error->text,
                                    camber_json_cure(error));
    c->status = camber_fail(c->context, CAMBER_ERROR_MEMORY, "%s: out of memory; make the document shorter", c->name);
    return false;
}

camber_status camber_document_read(camber_document *d, const char *json, size_t size_bytes) {
    json_error_t error;
    errno = 0;
    camber_json_load(d->compiler.context, json, size_bytes, JSON_DECODE_ANY | JSON_DECODE_INT_AS_REAL, false, &d->root,
                     &error);
    const bool done = d->root ? read_document(d) : fail_json(d, &error);
    (void)(done || camber_document_continues(d, 0));
    return d->compiler.status;
}

void camber_document_end(camber_document *d) {
    camber_compiler_end(&d->compiler);
    json_decref(d->source_indices);
    json_decref(d->by_id);
    json_decref(d->root);
}

camber_status camber_style_parse(camber_context *context, const char *json, size_t size_bytes, const char *name,
                                 camber_style **style) {
    camber_document d = {.compiler = {.context = context, .name = name}};
    d.compiler.style = camber_alloc_zero(context, 1, sizeof *d.compiler.style);
    if (!d.compiler.style)
        return CAMBER_ERROR_MEMORY;
    d.compiler.style->context = context;
    d.compiler.style->hash = camber_hash(CAMBER_HASH_START, json, size_bytes);
    const camber_status status = camber_document_read(&d, json, size_bytes);
    if (status == CAMBER_OK)
        *style = d.compiler.style;
    else
        camber_style_destroy(d.compiler.style);
    camber_document_end(&d);
    return status;
}

camber_status camber_style_create_builtin(camber_context *context, camber_theme theme, camber_style **style) {
    const char *name = theme == CAMBER_THEME_DARK ? "built-in dark style" : "built-in light style";
    size_t size_bytes;
    const char *text = camber_style_get_text("city", theme, &size_bytes);
    return camber_style_parse(context, text, size_bytes, name, style);
}

void camber_style_destroy(camber_style *style) {
    if (!style)
        return;
    camber_context *context = style->context;
    for (size_t i = 0; i < style->layer_count; i++)
        camber_style_layer_free(context, style->layers + i);
    for (size_t i = 0; i < style->source_count; i++) {
        camber_free(context, style->sources[i].name);
        camber_free(context, style->sources[i].type);
        camber_free(context, style->sources[i].missing);
        json_decref(style->sources[i].json);
        camber_expression_destroy(context, style->sources[i].filter);
    }
    for (size_t i = 0; i < style->sprite_count; i++) {
        camber_free(context, style->sprites[i].id);
        camber_free(context, style->sprites[i].url);
    }
    for (size_t i = 0; i < style->schema.property_count; i++)
        camber_free(context, style->schema.properties[i]);
    json_decref(style->state);
    camber_free(context, style->name);
    camber_free(context, style->glyphs);
    camber_free(context, style->schema.properties);
    camber_free(context, style->schema.property_readers);
    camber_free(context, style->schema.source_layers);
    camber_free(context, style->sprites);
    camber_free(context, style->sources);
    camber_free(context, style->layers);
    camber_free(context, style);
}

uint32_t camber_style_get_effects(const camber_style *style, double zoom) {
    static const struct {
        camber_property_id property;
        camber_style_effect effect;
    } named[] = {{CAMBER_LINE_GAP_WIDTH, CAMBER_STYLE_EFFECT_GAP},
                 {CAMBER_LINE_BLUR, CAMBER_STYLE_EFFECT_BLUR},
                 {CAMBER_LINE_DASHARRAY, CAMBER_STYLE_EFFECT_DASH},
                 {CAMBER_LINE_TRIM_OFFSET, CAMBER_STYLE_EFFECT_TRIM},
                 {CAMBER_LINE_GRADIENT, CAMBER_STYLE_EFFECT_GRADIENT},
                 {CAMBER_LINE_PATTERN, CAMBER_STYLE_EFFECT_PATTERN},
                 {CAMBER_BACKGROUND_PATTERN, CAMBER_STYLE_EFFECT_PATTERN},
                 {CAMBER_FILL_PATTERN, CAMBER_STYLE_EFFECT_PATTERN},
                 {CAMBER_LINE_BORDER_WIDTH, CAMBER_STYLE_EFFECT_BORDER},
                 {CAMBER_CIRCLE_STROKE_WIDTH, CAMBER_STYLE_EFFECT_GAP},
                 {CAMBER_CIRCLE_BLUR, CAMBER_STYLE_EFFECT_BLUR}};
    uint32_t effects = 0;
    for (size_t i = 0; i < style->layer_count; i++) {
        const camber_style_layer *layer = style->layers + i;
        const bool out = zoom < layer->min_zoom || (zoom >= layer->max_zoom && layer->max_zoom < 24.0);
        for (size_t k = 0; k < sizeof named / sizeof *named && layer->visible && !out; k++)
            if (layer->properties[named[k].property])
                effects |= (uint32_t)named[k].effect;
    }
    return effects;
}
