/* Saves a set of features to a file, and loads it again.
 *
 * Input: a set whose lines are merged and whose points have their importance. Output: a file, from which the same set
 * can be loaded, or the part of it that touches a region. Loading takes a tenth of the time that reading the original
 * files takes. The machines that draw the parts of one run read the file; after the run it is not needed. Numbers are
 * in the machine's byte order; a file with another byte order is refused.
 *
 *     header | JSON: layers, classes | numbers by feature | numbers by polyline | blocks of points | checksum
 *
 * A block contains the points of some polylines, then their importance. All polylines of a feature are in one block,
 * because the rings of an area are taken together. A reader holds one block at a time. */
#define _FILE_OFFSET_BITS 64
#define _XOPEN_SOURCE 700

#include "tiles/features_file.h"

#include "archive/contents.h"
#include "archive/output_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { BLOCK_POLYLINES = 1 << 14 };
#define MAGIC UINT64_C(0x34746165666d6163)

typedef struct header {
    uint64_t magic, input, json_bytes, feature_count, polyline_count, point_count, has_progress;
} header;

/* A file that is written or read sequentially. */
typedef struct stream {
    camber_context *context;
    const char *path;
    int file;
    uint64_t at, size_bytes;
    uint64_t hash;
} stream;

/* ---- Values as JSON ---- */

static json_t *value_json(const camber_value *value) {
    json_t *json = NULL;
    switch (value->type) {
    case CAMBER_VALUE_BOOL: return json_boolean(value->boolean);
    case CAMBER_VALUE_NUMBER: return json_real(value->number); /* json_real returns NULL if the number is not finite */
    case CAMBER_VALUE_STRING: return json_string(value->string);
    case CAMBER_VALUE_ARRAY:
        json = json_array();
        for (uint32_t i = 0; i < value->count; i++)
            json_array_append_new(json, value_json(value->items + i));
        return json;
    case CAMBER_VALUE_OBJECT:
        /* Members are sorted by key, and found by position. */
        json = json_object();
        for (uint32_t at = 0; at < value->count; at++)
            for (uint32_t i = 0; i < value->count; i++)
                if (value->members[i].position == at)
                    json_object_set_new(json, value->members[i].key, value_json(&value->members[i].value));
        return json;
    default: return json_null();
    }
}

/* Appends an array that contains only the value, or null if there is no value. So a null value in the file differs from
 * a missing one. */
static bool append_value(json_t *to, const camber_value *value) {
    if (value->type == CAMBER_VALUE_NULL && !value->boolean)
        return json_array_append_new(to, json_null()) == 0;
    json_t *one = value_json(value);
    return one && json_array_append_new(to, json_pack("[o]", one)) == 0;
}

static camber_status take_value(camber_features *features, const json_t *json, camber_value *value) {
    const json_t *one = json_array_get(json, 0);
    const camber_value *found;
    *value = (camber_value){0};
    if (!one)
        return CAMBER_OK;
    switch (json_typeof(one)) {
    case JSON_STRING:
        value->type = CAMBER_VALUE_STRING;
        return camber_features_intern(features, json_string_value(one), &value->string);
    case JSON_INTEGER:
    case JSON_REAL: *value = (camber_value){.type = CAMBER_VALUE_NUMBER, .number = json_number_value(one)}; break;
    case JSON_TRUE:
    case JSON_FALSE: *value = (camber_value){.type = CAMBER_VALUE_BOOL, .boolean = json_is_true(one)}; break;
    case JSON_NULL: value->boolean = true; break;
    default: {
        const camber_status status = camber_features_intern_json(features, one, &found);
        if (status != CAMBER_OK)
            return status;
        *value = *found;
    }
    }
    return CAMBER_OK;
}

/* ---- Classes ---- */

static bool append_class(json_t *to, const camber_features *features, const camber_feature_class *class) {
    json_t *json = json_pack("[I,I,I,b,b]", (json_int_t) class->source, (json_int_t) class->layer,
                             (json_int_t) class->geometry, class->unsorted, class->is_ends);
    const camber_value none = {.type = CAMBER_VALUE_NULL};
    bool good = json && append_value(json, &class->id) && append_value(json, class->all ? class->all : &none);
    for (size_t i = 0; i < features->schema->property_count && good; i++)
        good = append_value(json, features->values + class->first_value + i);
    return json_array_append_new(to, json) == 0 && good;
}

static json_t *make_json(const camber_features *features) {
    json_t *json = json_object(), *layers = json_array(), *classes = json_array();
    bool good = true;
    for (size_t i = 0; i < features->layer_count && good; i++)
        good = json_array_append_new(layers, json_string(features->layer_names[i])) == 0;
    for (size_t i = 0; i < features->class_count && good; i++)
        good = append_class(classes, features, features->classes + i);
    json_object_set_new(json, "layers", layers);
    json_object_set_new(json, "classes", classes);
    if (features->attribution)
        json_object_set_new(json, "attribution", json_string(features->attribution));
    if (good)
        return json;
    json_decref(json);
    return NULL;
}

static camber_status take_class(camber_features *features, const json_t *json, camber_value *values, size_t number) {
    enum { BEFORE = 7 };
    const size_t count = features->schema->property_count;
    const json_int_t kind = json_integer_value(json_array_get(json, 2));
    camber_feature_class class = {.layer = (uint32_t)json_integer_value(json_array_get(json, 1)),
                                  .geometry = (camber_geometry_kind)kind,
                                  .unsorted = json_is_true(json_array_get(json, 3)),
                                  .is_ends = json_is_true(json_array_get(json, 4))};
    camber_value all;
    uint32_t index = 0;
    if (json_array_size(json) != BEFORE + count || class.layer >= features->layer_count || kind < 0 ||
        kind >= CAMBER_GEOMETRY_KINDS)
        return CAMBER_ERROR_INPUT;
    camber_status status = take_value(features, json_array_get(json, 5), &class.id);
    if (status == CAMBER_OK)
        status = take_value(features, json_array_get(json, 6), &all);
    const json_t *object = json_array_get(json_array_get(json, 6), 0);
    if (status == CAMBER_OK && object)
        status = camber_features_intern_json(features, object, &class.all);
    for (size_t i = 0; i < count && status == CAMBER_OK; i++)
        status = take_value(features, json_array_get(json, BEFORE + i), values + i);
    features->source = (uint32_t)json_integer_value(json_array_get(json, 0));
    features->wants_labels = features->wants_labels || camber_geometry_is_label(class.geometry);
    if (status == CAMBER_OK)
        status = camber_features_find_class_of(features, &class, values, &index);
    return status == CAMBER_OK && index != number ? CAMBER_ERROR_INPUT : status;
}

static camber_status take_json(camber_features *features, const json_t *json) {
    const json_t *layers = json_object_get(json, "layers"), *classes = json_object_get(json, "classes");
    const uint32_t source = features->source;
    uint32_t layer;
    camber_value *values = camber_alloc_zero(features->context, features->schema->property_count, sizeof *values);
    camber_status status = values ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK && !(json_is_array(layers) && json_is_array(classes)))
        status = CAMBER_ERROR_INPUT;
    for (size_t i = 0; i < json_array_size(layers) && status == CAMBER_OK; i++) {
        const char *name = json_string_value(json_array_get(layers, i));
        status = name ? camber_features_find_layer(features, name, &layer) : CAMBER_ERROR_INPUT;
    }
    for (size_t i = 0; i < json_array_size(classes) && status == CAMBER_OK; i++)
        status = take_class(features, json_array_get(classes, i), values, i);
    if (status == CAMBER_OK)
        status = camber_features_add_attribution(features, json_string_value(json_object_get(json, "attribution")));
    features->source = source;
    camber_free(features->context, values);
    return status;
}

/* Returns the end of the block that begins with the polyline `first`. */
static size_t end_of_block(const uint32_t *polyline_feature, size_t first, size_t count) {
    size_t end = count - first < BLOCK_POLYLINES ? count : first + BLOCK_POLYLINES;
    while (end < count && polyline_feature[end] == polyline_feature[end - 1])
        end++;
    return end;
}

/* ---- Writing ---- */

static camber_status put(stream *to, const void *bytes, size_t size_bytes) {
    if (size_bytes == 0)
        return CAMBER_OK;
    const camber_status status = camber_write_at(to->context, to->path, to->file, bytes, size_bytes, to->at);
    to->at += size_bytes;
    to->hash = camber_mix(to->hash, camber_content_hash(bytes, size_bytes));
    return status;
}

static camber_status put_polylines(stream *to, const camber_features *f) {
    const size_t count = f->polyline_count;
    camber_status status = put(to, f->feature_class, f->feature_count * sizeof *f->feature_class);
    if (status == CAMBER_OK)
        status = put(to, f->polyline_feature, count * sizeof *f->polyline_feature);
    if (status == CAMBER_OK)
        status = put(to, f->feature_counts, count * sizeof *f->feature_counts);
    if (status == CAMBER_OK && count)
        status = put(to, f->offsets, (count + 1) * sizeof *f->offsets);
    if (status == CAMBER_OK && f->progress)
        status = put(to, f->progress, 2 * count * sizeof *f->progress);
    for (size_t first = 0, end; first < count && status == CAMBER_OK; first = end) {
        end = end_of_block(f->polyline_feature, first, count);
        const size_t begin = f->offsets[first], points = f->offsets[end] - begin;
        status = put(to, f->points + 2 * begin, 2 * points * sizeof *f->points);
        if (status == CAMBER_OK)
            status = put(to, f->importance + begin, points * sizeof *f->importance);
    }
    return status == CAMBER_OK ? put(to, &(uint64_t){to->hash}, sizeof to->hash) : status;
}

camber_status camber_features_save(const camber_features *features, uint64_t input, const char *path, bool force) {
    camber_context *context = features->context;
    camber_whole_file output;
    json_t *json = make_json(features);
    char *text = json ? json_dumps(json, JSON_COMPACT | JSON_REAL_PRECISION(17)) : NULL;
    json_decref(json);
    if (!text)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "%s: a property is not a finite number, or memory is exhausted; draw without a schedule",
                           path);
    const header head = {MAGIC,
                         input,
                         strlen(text),
                         features->feature_count,
                         features->polyline_count,
                         features->point_count,
                         features->progress != NULL};
    camber_status status = camber_output_begin(context, path, &output);
    if (status == CAMBER_OK) {
        stream to = {.context = context, .path = path, .file = output.file};
        status = put(&to, &head, sizeof head);
        if (status == CAMBER_OK)
            status = put(&to, text, strlen(text));
        if (status == CAMBER_OK)
            status = put_polylines(&to, features);
        status = camber_output_end(context, &output, status, force);
    }
    free(text);
    return status;
}

/* ---- Reading ---- */

static camber_status fail_damaged(const stream *from) {
    return camber_fail(from->context, CAMBER_ERROR_INPUT,
                       "%s: damaged, or made from another input; make it again with --dry-run --schedule --force",
                       from->path);
}

static camber_status get(stream *from, void *bytes, uint64_t size_bytes) {
    if (size_bytes > from->size_bytes - from->at)
        return fail_damaged(from);
    size_t done;
    const int cause = camber_file_read(from->file, bytes, size_bytes, from->at, &done);
    if (cause || done < size_bytes)
        return cause ? camber_file_fail(from->context, from->path, cause) : fail_damaged(from);
    from->at += size_bytes;
    if (size_bytes)
        from->hash = camber_mix(from->hash, camber_content_hash(bytes, size_bytes));
    return CAMBER_OK;
}

/* Allocates an array for `count` items, and reads them. */
static camber_status get_all(stream *from, void *items, uint64_t count, size_t size_bytes) {
    if (count > (from->size_bytes - from->at) / size_bytes)
        return fail_damaged(from);
    void *made = camber_alloc(from->context, (size_t)count + 1, size_bytes);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    memcpy(items, &made, sizeof made);
    return get(from, made, count * size_bytes);
}

static camber_status get_json(stream *from, uint64_t size_bytes, camber_features *features) {
    char *text = NULL;
    camber_status status = get_all(from, &text, size_bytes, 1);
    json_t *json = status == CAMBER_OK ? json_loadb(text, (size_t)size_bytes, 0, NULL) : NULL;
    camber_free(from->context, text);
    if (status == CAMBER_OK && (status = take_json(features, json)) == CAMBER_ERROR_INPUT)
        status = fail_damaged(from);
    json_decref(json);
    return status;
}

/* The polylines in the file, before the wanted ones are taken. */
typedef struct loading {
    stream *from;
    camber_features *features;
    const camber_region *boxes;
    size_t box_count;
    uint32_t *polyline_feature, *feature_counts;
    uint64_t *offsets;
    float *progress;
    double *points; /* the points of one block */
    float *importance;
    size_t point_room, importance_room;
} loading;

static bool makes_sense(const loading *l, const header *head) {
    const camber_features *f = l->features;
    bool good =
        head->polyline_count == 0 || (l->offsets[0] == 0 && l->offsets[head->polyline_count] == head->point_count);
    for (size_t i = 0; i < head->feature_count && good; i++)
        good = f->feature_class[i] < f->class_count;
    for (size_t p = 0; p < head->polyline_count && good; p++)
        good = l->offsets[p] < l->offsets[p + 1] && l->polyline_feature[p] < head->feature_count &&
               (p == 0 || l->polyline_feature[p - 1] <= l->polyline_feature[p]);
    return good;
}

/* Takes a polyline of a block whose points start at `begin`. */
static bool take_polyline(loading *l, size_t polyline, uint64_t begin) {
    camber_features *f = l->features;
    const size_t first = (size_t)(l->offsets[polyline] - begin);
    const size_t count = (size_t)(l->offsets[polyline + 1] - l->offsets[polyline]), n = f->polyline_count;
    if (!camber_grow(f->context, &f->points, &f->point_capacity, f->point_count + count, 2 * sizeof *f->points) ||
        !camber_grow(f->context, &f->importance, &f->importance_capacity, f->point_count + count,
                     sizeof *f->importance))
        return false;
    memcpy(f->points + 2 * f->point_count, l->points + 2 * first, 2 * count * sizeof *f->points);
    memcpy(f->importance + f->point_count, l->importance + first, count * sizeof *f->importance);
    f->polyline_feature[n] = l->polyline_feature[polyline];
    f->feature_counts[n] = l->feature_counts[polyline];
    if (l->progress)
        memcpy(f->progress + 2 * n, l->progress + 2 * polyline, 2 * sizeof *f->progress);
    f->offsets[n] = f->point_count;
    f->point_count += count;
    f->offsets[++f->polyline_count] = f->point_count;
    return true;
}

/* Whether the line or area that starts with this polyline is wanted. What has a label is always wanted, because which
 * labels are shown may depend on labels outside the region. The region contains all boxes; checking it first
 * rejects most lines that are in none of them. */
static bool is_wanted(const loading *l, size_t polyline) {
    const camber_features *f = l->features;
    size_t next;
    if (camber_geometry_is_label(camber_features_kind(f, polyline)))
        return true;
    if (f->has_region && !camber_features_touch(f, &f->region, polyline, &next))
        return false;
    for (size_t i = 0; i < l->box_count && l->box_count > 1; i++)
        if (camber_features_touch(f, l->boxes + i, polyline, &next))
            return true;
    return l->box_count < 2;
}

/* Takes the wanted polylines of a block: either all rings of an area, or none. */
static bool take_block(loading *l, size_t first, size_t end) {
    camber_features *f = l->features;
    const uint64_t begin = l->offsets[first];
    for (size_t p = first; p < end;) {
        const size_t before = f->polyline_count, feature = l->polyline_feature[p];
        const bool area = camber_geometry_is_area(f->classes[f->feature_class[feature]].geometry);
        do {
            if (!take_polyline(l, p++, begin))
                return false;
        } while (area && p < end && l->polyline_feature[p] == feature);
        if (is_wanted(l, before))
            continue;
        f->point_count = f->offsets[before];
        f->polyline_count = before;
    }
    return true;
}

static camber_status get_blocks(loading *l, size_t polylines) {
    camber_context *context = l->from->context;
    camber_status status = CAMBER_OK;
    for (size_t first = 0, end; first < polylines && status == CAMBER_OK; first = end) {
        end = end_of_block(l->polyline_feature, first, polylines);
        const uint64_t points = l->offsets[end] - l->offsets[first];
        if (points > l->from->size_bytes / (2 * sizeof *l->points))
            return fail_damaged(l->from);
        if (!camber_grow(context, &l->points, &l->point_room, (size_t)points, 2 * sizeof *l->points) ||
            !camber_grow(context, &l->importance, &l->importance_room, (size_t)points, sizeof *l->importance))
            return CAMBER_ERROR_MEMORY;
        status = get(l->from, l->points, points * 2 * sizeof *l->points);
        if (status == CAMBER_OK)
            status = get(l->from, l->importance, points * sizeof *l->importance);
        if (status == CAMBER_OK && !take_block(l, first, end))
            status = CAMBER_ERROR_MEMORY;
    }
    return status;
}

/* Allocates memory for the polylines that will be taken, which may be all of them. */
static camber_status make_room(camber_features *f, size_t polylines, bool has_progress) {
    if (!(f->polyline_feature = camber_alloc(f->context, polylines + 1, sizeof *f->polyline_feature)) ||
        !(f->feature_counts = camber_alloc(f->context, polylines + 1, sizeof *f->feature_counts)) ||
        !(f->offsets = camber_alloc(f->context, polylines + 1, sizeof *f->offsets)) ||
        (has_progress && !(f->progress = camber_alloc(f->context, polylines + 1, 2 * sizeof *f->progress))))
        return CAMBER_ERROR_MEMORY;
    f->offsets[0] = 0;
    f->polyline_capacity = polylines + 1;
    f->progress_capacity = has_progress ? polylines + 1 : 0;
    return CAMBER_OK;
}

static camber_status load(loading *l, const header *head) {
    camber_features *f = l->features;
    stream *from = l->from;
    const size_t polylines = (size_t)head->polyline_count;
    camber_status status = get_json(from, head->json_bytes, f);
    if (status == CAMBER_OK)
        status = get_all(from, &f->feature_class, head->feature_count, sizeof *f->feature_class);
    if (status == CAMBER_OK)
        status = get_all(from, &l->polyline_feature, polylines, sizeof *l->polyline_feature);
    if (status == CAMBER_OK)
        status = get_all(from, &l->feature_counts, polylines, sizeof *l->feature_counts);
    if (status == CAMBER_OK && polylines)
        status = get_all(from, &l->offsets, (uint64_t)polylines + 1, sizeof *l->offsets);
    if (status == CAMBER_OK && head->has_progress)
        status = get_all(from, &l->progress, polylines, 2 * sizeof *l->progress);
    if (status == CAMBER_OK && !makes_sense(l, head))
        status = fail_damaged(from);
    f->feature_count = f->feature_capacity = status == CAMBER_OK ? (size_t)head->feature_count : 0;
    if (status == CAMBER_OK && polylines)
        status = make_room(f, polylines, head->has_progress);
    if (status == CAMBER_OK)
        status = get_blocks(l, polylines);
    uint64_t hash = 0;
    const uint64_t expected = from->hash;
    if (status == CAMBER_OK)
        status = get(from, &hash, sizeof hash);
    if (status == CAMBER_OK && (hash != expected || from->at != from->size_bytes))
        status = fail_damaged(from);
    return status;
}

camber_status camber_features_load(camber_features *features, const camber_region *boxes, size_t box_count,
                                   uint64_t input, const char *path) {
    camber_context *context = features->context;
    stream from = {.context = context, .path = path};
    header head = {0};
    loading l = {.from = &from, .features = features, .boxes = boxes, .box_count = box_count};
    camber_status status = camber_file_open(context, path, CAMBER_NAMED_BY_CALLER, &from.file, &from.size_bytes);
    if (status != CAMBER_OK)
        return status;
    status = get(&from, &head, sizeof head);
    if (status == CAMBER_OK && (head.magic != MAGIC || head.input != input || head.polyline_count > UINT32_MAX ||
                                head.feature_count > UINT32_MAX || features->polyline_count || features->class_count))
        status = fail_damaged(&from);
    if (status == CAMBER_OK)
        status = load(&l, &head);
    features->changes++;
    close(from.file);
    camber_free(context, l.importance);
    camber_free(context, l.points);
    camber_free(context, l.progress);
    camber_free(context, l.offsets);
    camber_free(context, l.feature_counts);
    camber_free(context, l.polyline_feature);
    if (status == CAMBER_OK) {
        camber_features_shrink(features);
        camber_features_count(features);
    }
    return status;
}
