/* A set of features in memory: adds features to it, and stores equal values only once.
 *
 * Input: the lines and attributes from a reader, one feature after the other. Output: camber_features. Texts and values
 * are interned, so that equal ones have the same pointer; features with equal attributes form one class.
 */
#include "features/features.h"
#include "features/mercator.h"

#include "base/threads.h"
#include "lines/importance.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Hash tables use open addressing with linear probing. At most half of the slots are in use, so that probes stay short.
 */
typedef struct interned {
    camber_value value; /* the array or object that the text encodes as JSON, if a caller has asked for it */
    char text[];
} interned;

typedef struct interner {
    interned **strings; /* NULL: free */
    size_t string_slots, string_count;
    uint32_t *classes; /* index + 1; 0: free */
    size_t class_slots;
    camber_value *read; /* scratch: the values of the class that is being looked up. NULL: no class was looked up yet */
    uint32_t layer;     /* the layer of the last lookup, and whether a layer of the style names it */
    bool layer_is_named;
} interner;

enum { FIRST_SLOTS = 256 };

/* Frees the items and members of a value, which the set owns. */
static void free_value(camber_context *context, camber_value *value) {
    if (value->type == CAMBER_VALUE_ARRAY) {
        camber_value *items = (camber_value *)(uintptr_t)value->items;
        for (uint32_t i = 0; i < value->count; i++)
            free_value(context, &items[i]);
        camber_free(context, items);
    } else if (value->type == CAMBER_VALUE_OBJECT) {
        camber_member *members = (camber_member *)(uintptr_t)value->members;
        for (uint32_t i = 0; i < value->count; i++)
            free_value(context, &members[i].value);
        camber_free(context, members);
    }
    *value = (camber_value){0};
}

camber_status camber_features_create_for(camber_context *context, const camber_schema *schema,
                                         const camber_style *style, camber_features **features) {
    camber_features *made = camber_alloc_zero(context, 1, sizeof *made);
    interner *set = made ? camber_alloc_zero(context, 1, sizeof *set) : NULL;
    if (!set)
        goto failed;
    made->context = context;
    made->schema = schema;
    made->style = style;
    made->source = CAMBER_NO_SOURCE;
    made->interned = set;
    camber_budget_begin(context);
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
    for (size_t i = 0; i < set->string_slots; i++) {
        if (set->strings[i])
            free_value(context, &set->strings[i]->value);
        camber_free(context, set->strings[i]);
    }
    camber_free(context, set->strings);
    camber_free(context, set->read);
    camber_free(context, set);
    for (size_t i = 0; i < features->layer_count; i++)
        camber_free(context, features->layer_names[i]);
    camber_free(context, features->layer_names);
    camber_free(context, features->attribution);
    camber_free(context, features->values);
    camber_free(context, features->classes);
    camber_free(context, features->feature_class);
    camber_free(context, features->feature_counts);
    camber_free(context, features->polyline_feature);
    camber_free(context, features->offsets);
    camber_free(context, features->progress);
    camber_free(context, features->whole_counts);
    camber_free(context, features->importance);
    camber_free(context, features->points);
    if (features->fonts)
        features->free_fonts(features);
    if (features->sprites)
        features->free_sprites(features->sprites);
    camber_free(context, features);
}

void camber_features_add_extract(camber_features *features, size_t first_polyline) {
    if (features->extract_end != first_polyline)
        features->extract_first = first_polyline;
    features->extract_end = features->polyline_count;
}

uint64_t camber_features_key(const camber_features *f) {
    /* Addresses would not do: new sprites or points may have those of the old ones. */
    const uint64_t values[] = {f->changes,       f->point_count, f->polyline_count,
                               f->feature_count, f->class_count, f->value_count};
    return camber_hash(CAMBER_HASH_START, values, sizeof values);
}

void camber_features_release_points(camber_features *features) {
    camber_free(features->context, features->importance);
    camber_free(features->context, features->points);
    features->importance = NULL;
    features->points = NULL;
    features->point_count = features->point_capacity = features->importance_capacity = 0;
    features->changes++;
}

bool camber_features_get_bounds(const camber_features *features, double bounds[4]) {
    double west = INFINITY, north = INFINITY, east = -INFINITY, south = -INFINITY;
    for (size_t p = 0; p < features->polyline_count; p++) {
        if (features->wants_labels && camber_geometry_is_label(camber_features_kind(features, p)))
            continue;
        for (size_t i = features->offsets[p]; i < features->offsets[p + 1] && features->points; i++) {
            const double x = features->points[2 * i], y = features->points[2 * i + 1];
            west = x < west ? x : west;
            east = x > east ? x : east;
            north = y < north ? y : north;
            south = y > south ? y : south;
        }
    }
    if (!(west <= east && north <= south))
        return false;
    camber_mercator_unproject(west, south, &bounds[0], &bounds[1]);
    camber_mercator_unproject(east, north, &bounds[2], &bounds[3]);
    return true;
}

static bool is_of_files(const camber_features *features) {
    for (size_t i = 0; i < features->class_count; i++)
        if (features->classes[i].source != CAMBER_NO_SOURCE)
            return false;
    return true;
}

static bool has_name(const char *const *names, size_t count, const char *name) {
    for (size_t i = 0; i < count; i++)
        if (strcmp(names[i], name) == 0)
            return true;
    return false;
}

bool camber_schema_names_layer(const camber_schema *schema, const char *source_layer) {
    return has_name(schema->source_layers, schema->source_layer_count, source_layer);
}

bool camber_schema_only_labels_layer(const camber_schema *schema, const char *source_layer) {
    const size_t drawn = schema->drawn_source_layer_count;
    return schema->label_source_layer_count && !has_name(schema->source_layers, drawn, source_layer) &&
           has_name(schema->source_layers + drawn, schema->label_source_layer_count, source_layer);
}

static bool names_layers_of(const camber_schema *one, const camber_schema *other) {
    for (size_t i = 0; i < other->source_layer_count; i++)
        if (!camber_schema_names_layer(one, other->source_layers[i]))
            return false;
    return true;
}

static camber_property_readers readers_of(const camber_schema *schema, size_t property) {
    return schema->property_readers ? schema->property_readers[property]
                                    : (camber_property_readers){UINT_MAX, UINT_MAX};
}

bool camber_schema_draws_property(const camber_schema *schema, size_t property) {
    const camber_property_readers readers = readers_of(schema, property);
    const unsigned kinds = readers.kinds | readers.named_kinds;
    return !kinds || kinds & ~(unsigned)CAMBER_KINDS_OF_LABELS;
}

bool camber_features_reads_property(const camber_features *features, size_t property) {
    return features->wants_labels || camber_schema_draws_property(features->schema, property);
}

static bool reads_the_same(const camber_schema *one, const camber_schema *other) {
    bool same =
        one->property_count == other->property_count && one->wants_id == other->wants_id &&
        one->wants_all_properties == other->wants_all_properties && one->directed == other->directed &&
        one->labels_directed == other->labels_directed && one->wants_polygons == other->wants_polygons &&
        one->wants_areas == other->wants_areas && one->wants_points == other->wants_points &&
        one->wants_plain == other->wants_plain && one->wants_plain_areas == other->wants_plain_areas &&
        one->wants_plain_points == other->wants_plain_points && one->wants_label_lines == other->wants_label_lines &&
        one->wants_label_areas == other->wants_label_areas && one->wants_label_points == other->wants_label_points;
    for (size_t i = 0; same && i < one->property_count; i++) {
        const camber_property_readers a = readers_of(one, i), b = readers_of(other, i);
        same = strcmp(one->properties[i], other->properties[i]) == 0 && a.kinds == b.kinds &&
               a.named_kinds == b.named_kinds;
    }
    return same && names_layers_of(one, other) && names_layers_of(other, one);
}

static const camber_value *values_of(const camber_features *features, const camber_feature_class *one) {
    return features->schema->property_count ? features->values + one->first_value : NULL;
}

static bool is_taken(const camber_features *features, const camber_schema *schema, const camber_style *style,
                     const camber_feature_class *one, const camber_value *values) {
    const camber_feature_view feature = {
        .values = values, .geometry_type = camber_geometry_type(one->geometry), .id = one->id, .all = one->all};
    return schema->takes && schema->takes(style, one->geometry, features->layer_names[one->layer], &feature);
}

static double rank_of(const camber_features *features, const camber_schema *schema, const camber_style *style,
                      const camber_feature_class *one) {
    const camber_feature_view feature = {.values = values_of(features, one),
                                         .geometry_type = camber_geometry_type(one->geometry),
                                         .id = one->id,
                                         .all = one->all};
    const bool line = one->geometry == CAMBER_GEOMETRY_LINE && !one->is_ends && schema->rank_ends;
    return line ? schema->rank_ends(style, features->layer_names[one->layer], &feature) : CAMBER_NO_RANK;
}

double camber_features_rank_ends(const camber_features *features, uint32_t class_index) {
    return rank_of(features, features->schema, features->style, &features->classes[class_index]);
}

/* Whether the other style leaves the same classes to plain layers, gives lines the same ends, and its symbol layers
 * take the same classes. */
static bool takes_the_same(const camber_features *features, const camber_schema *schema, const camber_style *style) {
    for (size_t i = 0; i < features->class_count; i++) {
        const camber_feature_class *one = &features->classes[i];
        if (camber_geometry_is_label(one->geometry)) {
            if (one->labelled != is_taken(features, schema, style, one, values_of(features, one)))
                return false;
        } else if (one->unsorted && schema->wants_plain &&
                   one->plain == is_taken(features, schema, style, one, values_of(features, one)))
            return false;
        if (rank_of(features, schema, style, one) != camber_features_rank_ends(features, (uint32_t)i))
            return false;
    }
    return true;
}

bool camber_features_suit(const camber_features *features, const camber_schema *schema, const camber_style *style) {
    /* A set with a region drops the classes that no symbol layer takes, so these cannot be compared. */
    const bool dropped = features->has_region && camber_features_label_kinds(features);
    return is_of_files(features) && !dropped && reads_the_same(features->schema, schema) &&
           takes_the_same(features, schema, style);
}

camber_features_stats camber_features_get_stats(const camber_features *features) {
    return features->stats;
}

camber_features_times camber_features_get_times(const camber_features *features) {
    return features->times;
}

camber_features_mark camber_features_get_mark(const camber_features *features) {
    return (camber_features_mark){features->point_count,      features->polyline_count, features->feature_count,
                                  features->attribution_size, features->stats,          features->source};
}

void camber_features_reset(camber_features *features, const camber_features_mark *mark) {
    features->point_count = mark->point_count;
    features->polyline_count = mark->polyline_count;
    features->feature_count = mark->feature_count;
    camber_features_cut_attribution(features, mark->attribution_size);
    features->stats = mark->stats;
    features->source = mark->source;
    features->changes++;
}

/* The low bits of FNV are weak for short keys, so the high bits are folded into them. */
static size_t slot_of(uint64_t hash, size_t slots) {
    return (size_t)(hash ^ hash >> 32) & (slots - 1);
}

static size_t string_slot(interned *const *strings, size_t slots, const char *text) {
    size_t slot = slot_of(camber_hash(CAMBER_HASH_START, text, strlen(text)), slots);
    while (strings[slot] && strcmp(strings[slot]->text, text) != 0)
        slot = (slot + 1) & (slots - 1);
    return slot;
}

static bool grow_strings(camber_context *context, interner *set) {
    const size_t slots = set->string_slots * 2;
    interned **strings = camber_alloc_zero(context, slots, sizeof *strings);
    if (!strings)
        return false;
    for (size_t i = 0; i < set->string_slots; i++)
        if (set->strings[i])
            strings[string_slot(strings, slots, set->strings[i]->text)] = set->strings[i];
    camber_free(context, set->strings);
    set->strings = strings;
    set->string_slots = slots;
    return true;
}

static camber_status intern(camber_features *features, const char *text, interned **found) {
    interner *set = features->interned;
    size_t slot = string_slot(set->strings, set->string_slots, text);
    if (!set->strings[slot]) {
        if (set->string_count >= set->string_slots / 2) {
            if (!grow_strings(features->context, set))
                return CAMBER_ERROR_MEMORY;
            slot = string_slot(set->strings, set->string_slots, text);
        }
        const size_t length = strlen(text);
        interned *made = camber_alloc(features->context, 1, sizeof *made + length + 1);
        if (!made)
            return CAMBER_ERROR_MEMORY;
        made->value = (camber_value){0};
        memcpy(made->text, text, length + 1);
        set->strings[slot] = made;
        set->string_count++;
    }
    *found = set->strings[slot];
    return CAMBER_OK;
}

camber_status camber_features_intern(camber_features *features, const char *text, const char **interned_text) {
    interned *found;
    const camber_status status = intern(features, text, &found);
    if (status == CAMBER_OK)
        *interned_text = found->text;
    return status;
}

/* ---- Arrays and objects ---- */

static camber_status copy_json(camber_features *features, const json_t *json, camber_value *value);

static camber_status copy_array(camber_features *features, const json_t *json, camber_value *value) {
    const size_t count = json_array_size(json);
    camber_value *items = camber_alloc_zero(features->context, count, sizeof *items);
    if (!items)
        return CAMBER_ERROR_MEMORY;
    *value = (camber_value){.type = CAMBER_VALUE_ARRAY, .items = items};
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < count && status == CAMBER_OK; i++, value->count++)
        status = copy_json(features, json_array_get(json, i), &items[i]);
    return status;
}

static int compare_members(const void *a, const void *b) {
    return strcmp(((const camber_member *)a)->key, ((const camber_member *)b)->key);
}

static camber_status copy_object(camber_features *features, const json_t *json, camber_value *value) {
    camber_member *members = camber_alloc_zero(features->context, json_object_size(json), sizeof *members);
    if (!members)
        return CAMBER_ERROR_MEMORY;
    *value = (camber_value){.type = CAMBER_VALUE_OBJECT, .members = members};
    camber_status status = CAMBER_OK;
    const char *key;
    json_t *member;
    json_object_foreach((json_t *)(uintptr_t)json, key, member) {
        camber_member *one = &members[value->count];
        one->position = value->count++;
        status = camber_features_intern(features, key, &one->key);
        if (status == CAMBER_OK)
            status = copy_json(features, member, &one->value);
        if (status != CAMBER_OK)
            return status;
    }
    if (value->count)
        qsort(members, value->count, sizeof *members, compare_members);
    return CAMBER_OK;
}

static camber_status copy_json(camber_features *features, const json_t *json, camber_value *value) {
    *value = (camber_value){0};
    switch (json_typeof(json)) {
    case JSON_OBJECT: return copy_object(features, json, value);
    case JSON_ARRAY: return copy_array(features, json, value);
    case JSON_STRING:
        value->type = CAMBER_VALUE_STRING;
        return camber_features_intern(features, json_string_value(json), &value->string);
    case JSON_INTEGER:
    case JSON_REAL: *value = (camber_value){.type = CAMBER_VALUE_NUMBER, .number = json_number_value(json)}; break;
    case JSON_TRUE:
    case JSON_FALSE: *value = (camber_value){.type = CAMBER_VALUE_BOOL, .boolean = json_is_true(json)}; break;
    case JSON_NULL: value->boolean = true; break;
    }
    return CAMBER_OK;
}

camber_status camber_features_intern_json(camber_features *features, const json_t *json, const camber_value **value) {
    char *text = json_dumps(json, JSON_COMPACT | JSON_ENCODE_ANY);
    if (!text)
        return camber_fail(features->context, CAMBER_ERROR_MEMORY, "out of memory for a property");
    interned *found;
    camber_status status = intern(features, text, &found);
    free(text);
    if (status != CAMBER_OK)
        return status;
    if (found->value.type == CAMBER_VALUE_NULL)
        status = copy_json(features, json, &found->value);
    if (status != CAMBER_OK)
        free_value(features->context, &found->value);
    else
        *value = &found->value;
    return status;
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

/* Whether the value is interned, so that its pointer identifies it. */
static bool is_pointer(const camber_value *value) {
    return value->type == CAMBER_VALUE_STRING || value->type == CAMBER_VALUE_ARRAY ||
           value->type == CAMBER_VALUE_OBJECT;
}

/* Interned values are equal if their pointers are. Numbers are compared by their bits, because a class is a key, and
 * NaN must equal itself. */
static bool equal_values(const camber_value *a, const camber_value *b, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (a[i].type != b[i].type)
            return false;
        if (a[i].type <= CAMBER_VALUE_BOOL && a[i].boolean != b[i].boolean)
            return false;
        if (a[i].type == CAMBER_VALUE_NUMBER && memcmp(&a[i].number, &b[i].number, sizeof a[i].number) != 0)
            return false;
        if (is_pointer(&a[i]) && a[i].string != b[i].string)
            return false;
    }
    return true;
}

static uint64_t hash_value(uint64_t hash, const camber_value *value) {
    uint64_t word = 0;
    if (value->type <= CAMBER_VALUE_BOOL)
        word = value->boolean;
    else if (value->type == CAMBER_VALUE_NUMBER)
        memcpy(&word, &value->number, sizeof word);
    else if (is_pointer(value))
        word = (uintptr_t)value->string;
    return camber_mix(hash, word ^ (uint64_t)value->type << 56);
}

static uint64_t hash_class(const camber_feature_class *one, const camber_value *values, size_t count) {
    uint64_t hash = camber_mix(camber_mix(one->source, one->layer),
                               (uint64_t)one->geometry << 2 | (uint64_t)one->is_ends << 1 | one->unsorted);
    hash = camber_mix(hash_value(hash, &one->id), (uintptr_t)one->all);
    for (size_t i = 0; i < count; i++)
        hash = hash_value(hash, &values[i]);
    return hash;
}

static bool hash_classes(camber_features *features, size_t slots) {
    interner *set = features->interned;
    uint32_t *classes = camber_alloc_zero(features->context, slots, sizeof *classes);
    if (!classes)
        return false;
    for (size_t i = 0; i < features->class_count; i++) {
        const camber_feature_class *one = &features->classes[i];
        const uint64_t hash = hash_class(one, values_of(features, one), features->schema->property_count);
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

static bool grow_classes(camber_features *features) {
    const interner *set = features->interned;
    return hash_classes(features, 2 * set->class_slots);
}

static camber_status add_class(camber_features *features, const camber_feature_class *one, const camber_value *values) {
    const size_t count = features->schema->property_count;
    if (features->class_count >= UINT32_MAX - 1)
        return camber_fail(
            features->context, CAMBER_ERROR_LIMIT,
            "more than 4294967294 different sets of attributes; use a style that reads fewer attributes");
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

static bool equal_classes(const camber_feature_class *a, const camber_feature_class *b) {
    return a->source == b->source && a->layer == b->layer && a->geometry == b->geometry && a->all == b->all &&
           a->unsorted == b->unsorted && a->is_ends == b->is_ends && equal_values(&a->id, &b->id, 1);
}

/* Whether layers of the style name the source layer of a class. The last answer is remembered. */
static bool layer_is_named(camber_features *features, const camber_feature_class *one) {
    interner *set = features->interned;
    if (!set->read || set->layer != one->layer)
        set->layer_is_named = one->layer < features->layer_count &&
                              camber_schema_names_layer(features->schema, features->layer_names[one->layer]);
    set->layer = one->layer;
    return set->layer_is_named;
}

/* Replaces values by null if no layer reads them for features of this kind and layer, so that they do not split classes
 * needlessly. Returns NULL if there is no memory. */
static const camber_value *read_values(camber_features *features, const camber_feature_class *one,
                                       const camber_value *values) {
    interner *set = features->interned;
    const camber_schema *schema = features->schema;
    const bool is_named = layer_is_named(features, one);
    if (!set->read)
        set->read = camber_alloc(features->context, schema->property_count, sizeof *set->read);
    for (size_t i = 0; i < schema->property_count && set->read; i++) {
        const camber_property_readers readers = readers_of(schema, i);
        const unsigned kinds = readers.kinds | (is_named ? readers.named_kinds : 0u);
        set->read[i] = kinds >> one->geometry & 1 ? values[i] : (camber_value){0};
    }
    return set->read;
}

/* Returns the kinds that are drawn, CAMBER_KIND_*. */
static unsigned drawn_kinds(const camber_schema *schema, bool unsorted) {
    const bool plain_areas = unsorted && schema->wants_plain_areas;
    return CAMBER_KIND_LINE | (schema->wants_polygons || plain_areas ? CAMBER_KIND_POLYGON : 0u) |
           (schema->wants_areas || plain_areas ? CAMBER_KIND_AREA : 0u) |
           (schema->wants_points || (unsorted && schema->wants_plain_points) ? CAMBER_KIND_POINT : 0u);
}

unsigned camber_features_kinds(const camber_features *features, bool unsorted) {
    return drawn_kinds(features->schema, unsorted) | camber_features_label_kinds(features);
}

const char *camber_features_left_out(unsigned kinds) {
    const bool areas = kinds & CAMBER_KINDS_OF_AREAS;
    if (kinds & CAMBER_KINDS_OF_POINTS)
        return areas ? "neither line, area nor point (empty geometry)"
                     : "neither line nor point (areas, empty geometry)";
    return areas ? "neither line nor area (points, empty geometry)" : "no line (points, areas, empty geometry)";
}

bool camber_features_draw_class(const camber_features *features, uint32_t class_index) {
    const camber_feature_class *one = &features->classes[class_index];
    if (camber_geometry_is_label(one->geometry))
        return one->labelled;
    return !one->unsorted || one->plain || drawn_kinds(features->schema, false) >> one->geometry & 1;
}

camber_status camber_features_find_class_of(camber_features *features, const camber_feature_class *wanted,
                                            const camber_value *values, uint32_t *class_index) {
    interner *set = features->interned;
    const size_t count = features->schema->property_count;
    const camber_value *read = read_values(features, wanted, values);
    camber_feature_class made = *wanted;
    if (!read)
        return CAMBER_ERROR_MEMORY;
    made.source = features->source;
    made.first_value = features->value_count;
    if (features->class_count >= set->class_slots / 2 && !grow_classes(features))
        return CAMBER_ERROR_MEMORY;
    size_t slot = slot_of(hash_class(&made, read, count), set->class_slots);
    for (; set->classes[slot]; slot = (slot + 1) & (set->class_slots - 1)) {
        const camber_feature_class *one = &features->classes[set->classes[slot] - 1];
        if (equal_classes(one, &made) && equal_values(values_of(features, one), read, count)) {
            *class_index = set->classes[slot] - 1;
            return CAMBER_OK;
        }
    }
    const bool label = camber_geometry_is_label(made.geometry),
               asks_plain = made.unsorted && features->schema->wants_plain;
    const bool taken = (label || asks_plain) && is_taken(features, features->schema, features->style, &made, read);
    made.plain = !label && asks_plain && !taken;
    made.labelled = label && taken;
    const camber_status status = add_class(features, &made, read);
    if (status != CAMBER_OK)
        return status;
    set->classes[slot] = (uint32_t)features->class_count;
    *class_index = (uint32_t)features->class_count - 1;
    return CAMBER_OK;
}

camber_status camber_features_find_class(camber_features *features, uint32_t layer, camber_geometry_kind geometry,
                                         const camber_value *values, uint32_t *class_index) {
    const camber_feature_class wanted = {.layer = layer, .geometry = geometry};
    return camber_features_find_class_of(features, &wanted, values, class_index);
}

camber_status camber_features_renumber_classes(camber_features *features) {
    camber_context *context = features->context;
    const size_t count = features->schema->property_count, class_count = features->class_count;
    camber_status status = CAMBER_ERROR_MEMORY;
    size_t kept = 0;
    uint32_t *numbers = camber_alloc_zero(context, class_count, sizeof *numbers); /* new index + 1; 0: none yet */
    camber_feature_class *classes = camber_alloc(context, class_count, sizeof *classes);
    camber_value *values = camber_alloc(context, class_count * count, sizeof *values);
    if (!numbers || !classes || !values)
        goto done;
    for (size_t i = 0; i < features->feature_count; i++) {
        uint32_t *number = &numbers[features->feature_class[i]];
        if (*number)
            continue;
        classes[kept] = features->classes[features->feature_class[i]];
        if (count)
            memcpy(values + kept * count, values_of(features, &classes[kept]), count * sizeof *values);
        classes[kept].first_value = kept * count;
        *number = (uint32_t)++kept;
    }
    for (size_t i = 0; i < features->feature_count; i++)
        features->feature_class[i] = numbers[features->feature_class[i]] - 1;
    for (size_t i = 0; i < kept; i++)
        features->classes[i] = classes[i];
    if (kept && count)
        memcpy(features->values, values, kept * count * sizeof *values);
    features->class_count = kept;
    features->value_count = kept * count;
    status =
        hash_classes(features, ((const interner *)features->interned)->class_slots) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
done:
    camber_free(context, values);
    camber_free(context, classes);
    camber_free(context, numbers);
    return status;
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

/* Makes room for the progress of this many polylines, and gives the last one the progress of a whole line, 0 to 1. */
static bool grow_progress(camber_features *features, size_t polylines) {
    if (!camber_grow(features->context, &features->progress, &features->progress_capacity, polylines,
                     2 * sizeof *features->progress))
        return false;
    features->progress[2 * polylines - 2] = 0.0f;
    features->progress[2 * polylines - 1] = 1.0f;
    return true;
}

camber_status camber_features_set_progress(camber_features *features, double first, double last) {
    if (!features->progress)
        for (size_t n = 1; n <= features->polyline_count; n++)
            if (!grow_progress(features, n))
                return CAMBER_ERROR_MEMORY;
    if (!features->progress) /* there is no polyline yet */
        return CAMBER_OK;
    features->progress[2 * features->polyline_count - 2] = (float)first;
    features->progress[2 * features->polyline_count - 1] = (float)last;
    return CAMBER_OK;
}

camber_status camber_features_add_polyline(camber_features *features, const double *points, size_t point_count) {
    camber_context *context = features->context;
    size_t offset_capacity = features->polyline_capacity, count_capacity = offset_capacity;
    if (point_count > SIZE_MAX / 2 - features->point_count ||
        !camber_grow(context, &features->points, &features->point_capacity, features->point_count + point_count,
                     2 * sizeof *features->points))
        return CAMBER_ERROR_MEMORY;
    /* The arrays grow together, so one capacity counts the entries of each. */
    if (!camber_grow(context, &features->feature_counts, &count_capacity, features->polyline_count + 2,
                     sizeof *features->feature_counts) ||
        !camber_grow(context, &features->offsets, &offset_capacity, features->polyline_count + 2,
                     sizeof *features->offsets) ||
        !camber_grow(context, &features->polyline_feature, &features->polyline_capacity, features->polyline_count + 2,
                     sizeof *features->polyline_feature))
        return CAMBER_ERROR_MEMORY;
    if (features->progress && !grow_progress(features, features->polyline_count + 1))
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

camber_status camber_features_set_importance(camber_features *features, size_t first_polyline) {
    if (first_polyline == features->polyline_count)
        return CAMBER_OK;
    if (!camber_grow(features->context, &features->importance, &features->importance_capacity, features->point_count,
                     sizeof *features->importance))
        return CAMBER_ERROR_MEMORY;
    const size_t labels = camber_features_find_labels(features, first_polyline), end = features->polyline_count;
    camber_importance_desc desc = {.points = features->points,
                                   .offsets = features->offsets + first_polyline,
                                   .polyline_count = labels - first_polyline,
                                   .importance = features->importance,
                                   .threads = camber_threads_count(features->threads)};
    camber_status status = camber_importance_weigh_by(features->context, &desc);
    desc.offsets = features->offsets + labels;
    desc.polyline_count = end - labels;
    return status == CAMBER_OK ? camber_importance_weigh_by(features->context, &desc) : status;
}
