/* Fingerprints depend on what was read and on the options, not on file names or times: the same lines read from another
 * path make the same tiles. */
#include "tiles/fingerprint.h"

#include "archive/contents.h"
#include "features/features.h"
#include "style/sprite.h"

#include <inttypes.h>
#include <stdio.h>

static uint64_t hash_more(uint64_t hash, const void *bytes, size_t size_bytes) {
    return camber_mix(hash, bytes && size_bytes ? camber_content_hash(bytes, size_bytes) : size_bytes);
}

static uint64_t hash_text(uint64_t hash, const char *text) {
    return hash_more(hash, text ? text : "", text ? strlen(text) + 1 : 0);
}

/* ---- The input ---- */

static uint64_t hash_value(uint64_t hash, const camber_value *value) {
    hash = camber_mix(hash, (uint64_t)value->type << 32 | value->count);
    switch (value->type) {
    case CAMBER_VALUE_NULL:
    case CAMBER_VALUE_BOOL: return camber_mix(hash, value->boolean);
    case CAMBER_VALUE_NUMBER: return hash_more(hash, &value->number, sizeof value->number);
    case CAMBER_VALUE_STRING: return hash_text(hash, value->string);
    case CAMBER_VALUE_COLOR: return hash_more(hash, &value->color, sizeof value->color);
    case CAMBER_VALUE_ARRAY:
        for (uint32_t i = 0; i < value->count; i++)
            hash = hash_value(hash, value->items + i);
        return hash;
    case CAMBER_VALUE_FORMATTED: return hash; /* features have no such values */
    case CAMBER_VALUE_OBJECT:
        for (uint32_t i = 0; i < value->count; i++)
            hash = hash_value(hash_text(hash, value->members[i].key), &value->members[i].value);
        return hash;
    }
    return hash;
}

static uint64_t hash_classes(const camber_features *features, uint64_t hash) {
    for (size_t i = 0; i < features->class_count; i++) {
        const camber_feature_class *class = features->classes + i;
        hash = camber_mix(hash, (uint64_t) class->source << 32 | (uint64_t) class->geometry);
        hash = hash_text(hash, features->layer_names ? features->layer_names[class->layer] : NULL);
        hash = hash_value(hash, &class->id);
        for (size_t k = 0; k < features->schema->property_count; k++)
            hash = hash_value(hash, features->values + class->first_value + k);
        if (class->all)
            hash = hash_value(hash, class->all);
    }
    return hash;
}

uint64_t camber_features_hash(const camber_features *features, camber_box *box) {
    enum { PIECE = 1 << 16 };
    uint64_t hash = camber_mix(0, features->point_count);
    *box = CAMBER_BOX_EMPTY;
    for (size_t at = 0; at < features->point_count; at += PIECE) {
        const size_t count = features->point_count - at < PIECE ? features->point_count - at : PIECE;
        hash = hash_more(hash, features->points + 2 * at, 2 * sizeof(double) * count);
        for (size_t i = at; i < at + count; i++)
            camber_box_add(box, features->points[2 * i], features->points[2 * i + 1]);
    }
    if (features->polyline_count) {
        hash = hash_more(hash, features->offsets, (features->polyline_count + 1) * sizeof *features->offsets);
        hash = hash_more(hash, features->polyline_feature, features->polyline_count * sizeof(uint32_t));
    }
    if (features->progress)
        hash = hash_more(hash, features->progress, 2 * features->polyline_count * sizeof *features->progress);
    hash = hash_more(hash, features->feature_class, features->feature_count * sizeof *features->feature_class);
    return hash_classes(features, hash);
}

/* ---- The rest ---- */

/* Hashes the style's document and the images of its sprites. */
static uint64_t hash_style(const camber_features *features) {
    uint64_t hash = features->style->hash;
    const camber_sprites *sprites = features->sprites;
    for (size_t i = 0; sprites && i < sprites->sheet_count; i++)
        hash =
            hash_more(hash, sprites->sheets[i].rgba, 4 * (size_t)sprites->sheets[i].width * sprites->sheets[i].height);
    return hash;
}

/* Pictures without labels have the hash that they had before there were any. */
static uint64_t hash_labels(const camber_features *features, uint64_t hash) {
    return features->fonts ? hash_text(hash, "labels") : hash;
}

uint64_t camber_features_get_hash(const camber_features *features) {
    camber_box box;
    return hash_labels(
        features, camber_mix(hash_text(camber_features_hash(features, &box), camber_version()), hash_style(features)));
}

static uint64_t hash_options(const camber_tiles_engine *engine, const camber_tiles_draw_desc *desc) {
    const double numbers[] = {
        engine->desc.tile_size,
        engine->desc.ratio,
        engine->desc.simplify_px,
        (double)engine->desc.coverage,
        (double)desc->encoding,
        desc->encoding == CAMBER_ENCODING_WEBP ? (double)desc->quality : 0.0,
        (double)desc->keep_empty,
        engine->desc.meshes ? -1.0 : (double)camber_renderer_get_rasterizer(engine->desc.renderer)};
    return hash_labels(engine->features, hash_more(0, numbers, sizeof numbers));
}

static uint64_t hash_area(const camber_tiles_draw_desc *desc, const camber_tiles_area *area) {
    const double numbers[] = {area->min_zoom, area->max_zoom, area->box.x0, area->box.y0, area->box.x1, area->box.y1};
    uint64_t hash = hash_more(0, numbers, sizeof numbers);
    if (desc->region)
        hash = hash_more(hash, desc->region->points, 2 * sizeof(double) * desc->region->point_count);
    if (area->tiles)
        hash = hash_more(hash, area->tiles, area->tile_count * sizeof *area->tiles);
    return hash;
}

void camber_fingerprint_write(const camber_tiles_engine *engine, const camber_tiles_draw_desc *desc,
                              const camber_tiles_area *area, uint64_t input, char text[CAMBER_FINGERPRINT_SIZE]) {
    snprintf(text, CAMBER_FINGERPRINT_SIZE,
             "input=%016" PRIx64 " style=%016" PRIx64 " options=%016" PRIx64 " area=%016" PRIx64 " version=%s", input,
             hash_style(engine->features), hash_options(engine, desc), hash_area(desc, area), camber_version());
}

/* ---- Replacing tiles ---- */

/* Returns the value of a word and sets its length; NULL if the word is missing. */
static const char *find_word(const char *text, const char *name, size_t *length) {
    const size_t size = strlen(name);
    for (const char *at = text; at; at = strchr(at, ' '), at = at ? at + 1 : NULL)
        if (strncmp(at, name, size) == 0 && at[size] == '=') {
            *length = strcspn(at + size + 1, " ");
            return at + size + 1;
        }
    return NULL;
}

static bool same_word(const char *one, const char *other, const char *name) {
    size_t length = 0, other_length = 0;
    const char *a = find_word(one, name, &length), *b = find_word(other, name, &other_length);
    return a && b && length == other_length && strncmp(a, b, length) == 0;
}

bool camber_fingerprint_renew(const char *there, const char *now, char text[CAMBER_FINGERPRINT_SIZE], char *names,
                              size_t names_size) {
    static const char *const words[] = {"style", "options", "version"};
    size_t used = 0, input_length = 0, area_length = 0;
    names[0] = 0;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (!same_word(there, now, words[i]))
            used += (size_t)snprintf(names + used, names_size - used, "%s%s", used ? ", " : "", words[i]);
    const char *area = find_word(there, "area", &area_length), *input = find_word(now, "input", &input_length);
    const char *rest = strchr(now, ' '), *own_area = rest ? strstr(rest, " area=") : NULL;
    const char *version = own_area ? strchr(own_area + 1, ' ') : NULL;
    if (used || !area || !input || !version)
        return false;
    snprintf(text, CAMBER_FINGERPRINT_SIZE, "input=%.*s%.*s area=%.*s%s", (int)input_length, input,
             (int)(own_area - rest), rest, (int)area_length, area, version);
    return true;
}
