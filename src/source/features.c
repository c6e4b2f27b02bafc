#include "lines/importance.h"
#include "source/source.h"

#include <string.h>

/* Open addressing with linear probing; at most half of the slots are in use, so that probes stay short. */
typedef struct interner {
    char **strings; /* NULL: free */
    size_t string_slots, string_count;
    uint32_t *classes; /* index + 1; 0: free */
    size_t class_slots;
} interner;

enum { FIRST_SLOTS = 256 };

camber_status camber_features_create(camber_context *context, const camber_style *style, camber_features **features) {
    camber_features *made = camber_alloc_zero(context, 1, sizeof *made);
    interner *set = made ? camber_alloc_zero(context, 1, sizeof *set) : NULL;
    if (!set)
        goto failed;
    made->context = context;
    made->style = style;
    made->source = CAMBER_NO_SOURCE;
    made->interned = set;
    if (!(set->strings = camber_alloc_zero(context, FIRST_SLOTS, sizeof *set->strings)) ||
        !(set->classes = camber_alloc_zero(context, FIRST_SLOTS, sizeof *set->classes)))
        goto failed;
    set->string_slots = set->class_slots = FIRST_SLOTS;
    *features = made;
    return CAMBER_OK;
failed:
    if (set) {
        camber_free(context, set->classes);
        camber_free(context, set->strings);
    }
    camber_free(context, set);
    camber_free(context, made);
    return CAMBER_ERROR_MEMORY;
}

void camber_features_destroy(camber_features *features) {
    if (!features)
        return;
    camber_context *context = features->context;
    interner *set = features->interned;
    camber_free(context, set->classes);
    for (size_t i = 0; i < set->string_slots; i++)
        camber_free(context, set->strings[i]);
    camber_free(context, set->strings);
    camber_free(context, set);
    for (size_t i = 0; i < features->layer_count; i++)
        camber_free(context, features->layer_names[i]);
    camber_free(context, features->layer_names);
    camber_free(context, features->values);
    camber_free(context, features->classes);
    camber_free(context, features->feature_class);
    camber_free(context, features->feature_counts);
    camber_free(context, features->polyline_feature);
    camber_free(context, features->offsets);
    camber_free(context, features->importance);
    camber_free(context, features->points);
    camber_free(context, features);
}

camber_features_stats camber_features_get_stats(const camber_features *features) {
    return features->stats;
}

camber_features_times camber_features_get_times(const camber_features *features) {
    return features->times;
}

bool camber_features_is_osm(const camber_features *features) {
    return features->is_osm;
}

/* FNV's low bits are weak for short keys; fold the high ones in. */
static size_t slot_of(uint64_t hash, size_t slots) {
    return (size_t)(hash ^ hash >> 32) & (slots - 1);
}

static size_t string_slot(char *const *strings, size_t slots, const char *text) {
    size_t slot = slot_of(camber_hash(CAMBER_HASH_START, text, strlen(text)), slots);
    while (strings[slot] && strcmp(strings[slot], text) != 0)
        slot = (slot + 1) & (slots - 1);
    return slot;
}

static bool grow_strings(camber_context *context, interner *set) {
    const size_t slots = set->string_slots * 2;
    char **strings = camber_alloc_zero(context, slots, sizeof *strings);
    if (!strings)
        return false;
    for (size_t i = 0; i < set->string_slots; i++)
        if (set->strings[i])
            strings[string_slot(strings, slots, set->strings[i])] = set->strings[i];
    camber_free(context, set->strings);
    set->strings = strings;
    set->string_slots = slots;
    return true;
}

camber_status camber_features_intern(camber_features *features, const char *text, const char **interned) {
    interner *set = features->interned;
    size_t slot = string_slot(set->strings, set->string_slots, text);
    if (!set->strings[slot]) {
        if (set->string_count >= set->string_slots / 2) {
            if (!grow_strings(features->context, set))
                return CAMBER_ERROR_MEMORY;
            slot = string_slot(set->strings, set->string_slots, text);
        }
        char *copy = camber_copy_string(features->context, text);
        if (!copy)
            return CAMBER_ERROR_MEMORY;
        set->strings[slot] = copy;
        set->string_count++;
    }
    *interned = set->strings[slot];
    return CAMBER_OK;
}

camber_status camber_features_find_layer(camber_features *features, const char *name, uint32_t *layer) {
    for (size_t i = 0; i < features->layer_count; i++) {
        if (strcmp(features->layer_names[i], name) == 0) {
            *layer = (uint32_t)i;
            return CAMBER_OK;
        }
    }
    if (!camber_grow(features->context, &features->layer_names, &features->layer_capacity, features->layer_count + 1,
                     sizeof *features->layer_names))
        return CAMBER_ERROR_MEMORY;
    char *copy = camber_copy_string(features->context, name);
    if (!copy)
        return CAMBER_ERROR_MEMORY;
    features->layer_names[features->layer_count] = copy;
    *layer = (uint32_t)features->layer_count++;
    return CAMBER_OK;
}

/* ---- Classes ---- */

/* Interned strings are equal where their pointers are. Numbers compare by their bits: a class is a key, and NaN
 * must equal itself. */
static bool equal_values(const camber_value *a, const camber_value *b, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (a[i].type != b[i].type)
            return false;
        if (a[i].type == CAMBER_VALUE_BOOL && a[i].boolean != b[i].boolean)
            return false;
        if (a[i].type == CAMBER_VALUE_NUMBER && memcmp(&a[i].number, &b[i].number, sizeof a[i].number) != 0)
            return false;
        if (a[i].type == CAMBER_VALUE_STRING && a[i].string != b[i].string)
            return false;
    }
    return true;
}

static uint64_t hash_class(const camber_feature_class *one, const camber_value *values, size_t count) {
    uint64_t hash = camber_mix(camber_mix(one->source, one->layer), (uint64_t)one->geometry);
    for (size_t i = 0; i < count; i++) {
        uint64_t word = 0;
        if (values[i].type == CAMBER_VALUE_BOOL)
            word = values[i].boolean;
        else if (values[i].type == CAMBER_VALUE_NUMBER)
            memcpy(&word, &values[i].number, sizeof word);
        else if (values[i].type == CAMBER_VALUE_STRING)
            word = (uintptr_t)values[i].string;
        hash = camber_mix(hash, word ^ (uint64_t)values[i].type << 56);
    }
    return hash;
}

static const camber_value *values_of(const camber_features *features, const camber_feature_class *one) {
    return features->style->property_count ? features->values + one->first_value : NULL;
}

static bool grow_classes(camber_features *features) {
    interner *set = features->interned;
    const size_t slots = set->class_slots * 2;
    uint32_t *classes = camber_alloc_zero(features->context, slots, sizeof *classes);
    if (!classes)
        return false;
    for (size_t i = 0; i < features->class_count; i++) {
        const camber_feature_class *one = &features->classes[i];
        const uint64_t hash = hash_class(one, values_of(features, one), features->style->property_count);
        size_t slot = slot_of(hash, slots);
        while (classes[slot])
            slot = (slot + 1) & (slots - 1);
        classes[slot] = (uint32_t)i + 1;
    }
    camber_free(features->context, set->classes);
    set->classes = classes;
    set->class_slots = slots;
    return true;
}

static camber_status add_class(camber_features *features, const camber_feature_class *one, const camber_value *values) {
    const size_t count = features->style->property_count;
    if (features->class_count >= UINT32_MAX - 1)
        return camber_fail(features->context, CAMBER_ERROR_LIMIT,
                           "more than 4294967294 different features; read fewer attributes");
    if (!camber_grow(features->context, &features->classes, &features->class_capacity, features->class_count + 1,
                     sizeof *features->classes) ||
        !camber_grow(features->context, &features->values, &features->value_capacity, features->value_count + count,
                     sizeof *features->values))
        return CAMBER_ERROR_MEMORY;
    features->classes[features->class_count] = *one;
    if (count)
        memcpy(features->values + features->value_count, values, count * sizeof *values);
    features->value_count += count;
    features->class_count++;
    return CAMBER_OK;
}

camber_status camber_features_find_class(camber_features *features, uint32_t layer, camber_geometry_kind geometry,
                                         const camber_value *values, uint32_t *class_index) {
    interner *set = features->interned;
    const size_t count = features->style->property_count;
    const camber_feature_class wanted = {features->source, layer, geometry, features->value_count};
    if (features->class_count >= set->class_slots / 2 && !grow_classes(features))
        return CAMBER_ERROR_MEMORY;
    size_t slot = slot_of(hash_class(&wanted, values, count), set->class_slots);
    for (; set->classes[slot]; slot = (slot + 1) & (set->class_slots - 1)) {
        const camber_feature_class *one = &features->classes[set->classes[slot] - 1];
        if (one->source == wanted.source && one->layer == layer && one->geometry == geometry &&
            equal_values(values_of(features, one), values, count)) {
            *class_index = set->classes[slot] - 1;
            return CAMBER_OK;
        }
    }
    const camber_status status = add_class(features, &wanted, values);
    if (status != CAMBER_OK)
        return status;
    set->classes[slot] = (uint32_t)features->class_count;
    *class_index = (uint32_t)features->class_count - 1;
    return CAMBER_OK;
}

/* ---- Features and polylines ---- */

camber_status camber_features_add_feature(camber_features *features, uint32_t class_index) {
    if (features->feature_count >= UINT32_MAX)
        return camber_fail(features->context, CAMBER_ERROR_LIMIT,
                           "more than 4294967295 features; select fewer with an attribute filter");
    if (!camber_grow(features->context, &features->feature_class, &features->feature_capacity,
                     features->feature_count + 1, sizeof *features->feature_class))
        return CAMBER_ERROR_MEMORY;
    features->feature_class[features->feature_count++] = class_index;
    return CAMBER_OK;
}

camber_status camber_features_add_polyline(camber_features *features, const double *points, size_t point_count) {
    camber_context *context = features->context;
    size_t offset_capacity = features->polyline_capacity, count_capacity = offset_capacity;
    if (point_count > SIZE_MAX / 2 - features->point_count ||
        !camber_grow(context, &features->points, &features->point_capacity, features->point_count + point_count,
                     2 * sizeof *features->points))
        return CAMBER_ERROR_MEMORY;
    /* The arrays grow together: one capacity counts the entries of each. */
    if (!camber_grow(context, &features->feature_counts, &count_capacity, features->polyline_count + 2,
                     sizeof *features->feature_counts) ||
        !camber_grow(context, &features->offsets, &offset_capacity, features->polyline_count + 2,
                     sizeof *features->offsets) ||
        !camber_grow(context, &features->polyline_feature, &features->polyline_capacity, features->polyline_count + 2,
                     sizeof *features->polyline_feature))
        return CAMBER_ERROR_MEMORY;
    if (point_count)
        memcpy(features->points + 2 * features->point_count, points, 2 * point_count * sizeof *points);
    features->offsets[features->polyline_count] = features->point_count;
    const uint32_t feature = (uint32_t)(features->feature_count - 1);
    const size_t n = features->polyline_count;
    features->polyline_feature[n] = feature;
    features->feature_counts[n] = n == 0 || features->polyline_feature[n - 1] != feature;
    features->point_count += point_count;
    features->offsets[++features->polyline_count] = features->point_count;
    return CAMBER_OK;
}

camber_status camber_features_weigh(camber_features *features, size_t first_polyline) {
    if (first_polyline == features->polyline_count)
        return CAMBER_OK;
    if (!camber_grow(features->context, &features->importance, &features->importance_capacity, features->point_count,
                     sizeof *features->importance))
        return CAMBER_ERROR_MEMORY;
    return camber_importance_weigh(features->context, features->points, features->offsets + first_polyline,
                                   features->polyline_count - first_polyline, features->importance);
}
