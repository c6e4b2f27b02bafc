/* Adds features for symbol layers to a set, apart from the features that are drawn.
 *
 * Input: a set whose program draws labels. Output: the same lines, areas and points once more. They have the kinds of
 * labels, and their classes have the properties that symbol layers read. The main idea: the labels of a file come after
 * its drawn features, and their lines are merged and get their importance separately, so that the rest of
 * the picture is the same with and without labels, to the last bit. */
#include "features/features.h"

#include <string.h>

void camber_features_want_labels(camber_features *features) {
    features->wants_labels = true;
}

unsigned camber_features_label_kinds(const camber_features *features) {
    const camber_schema *schema = features->schema;
    if (!features->wants_labels)
        return 0;
    return (schema->wants_label_lines ? CAMBER_KIND_LABEL_LINE : 0u) |
           (schema->wants_label_areas ? CAMBER_KIND_LABEL_AREA : 0u) |
           (schema->wants_label_points ? CAMBER_KIND_LABEL_POINT : 0u);
}

size_t camber_features_find_labels(const camber_features *features, size_t first_polyline) {
    size_t first = features->polyline_count;
    while (features->wants_labels && first > first_polyline &&
           camber_geometry_is_label(camber_features_kind(features, first - 1)))
        first--;
    return first;
}

/* The features of labels, which are set aside while the others close up. */
typedef struct aside {
    uint32_t *classes; /* feature_count */
    size_t feature_count;
    double *points;
    size_t point_count;
    size_t *counts; /* polyline_count: the number of points */
    uint32_t *features, *feature_counts;
    size_t polyline_count;
} aside;

static bool is_label(const camber_features *features, size_t feature) {
    return camber_geometry_is_label(features->classes[features->feature_class[feature]].geometry);
}

static bool make_room(const camber_features *f, size_t first_polyline, size_t first_feature, aside *labels) {
    size_t feature_count = 0, polylines = 0, points = 0;
    for (size_t i = first_feature; i < f->feature_count; i++)
        feature_count += is_label(f, i);
    for (size_t p = first_polyline; p < f->polyline_count; p++) {
        const bool label = is_label(f, f->polyline_feature[p]);
        polylines += label;
        points += label ? f->offsets[p + 1] - f->offsets[p] : 0;
    }
    return (labels->classes = camber_alloc(f->context, feature_count, sizeof *labels->classes)) &&
           (labels->points = camber_alloc(f->context, points, 2 * sizeof *labels->points)) &&
           (labels->counts = camber_alloc(f->context, polylines, sizeof *labels->counts)) &&
           (labels->features = camber_alloc(f->context, polylines, sizeof *labels->features)) &&
           (labels->feature_counts = camber_alloc(f->context, polylines, sizeof *labels->feature_counts));
}

/* Appends a polyline to the part of the set that has closed up. */
static void put(camber_features *f, const double *points, size_t count, size_t feature, uint32_t counted) {
    const size_t p = f->polyline_count++, first = f->point_count;
    if (count)
        memmove(f->points + 2 * first, points, 2 * count * sizeof *points);
    f->polyline_feature[p] = (uint32_t)feature;
    f->feature_counts[p] = counted;
    f->point_count = f->offsets[p + 1] = first + count;
}

static void set_aside(aside *labels, const double *points, size_t count, uint32_t counted) {
    const size_t p = labels->polyline_count++;
    if (count)
        memcpy(labels->points + 2 * labels->point_count, points, 2 * count * sizeof *points);
    labels->point_count += count;
    labels->counts[p] = count;
    labels->features[p] = (uint32_t)labels->feature_count;
    labels->feature_counts[p] = counted;
}

/* Sets the labels from first_polyline on aside, closes the gaps that they leave, and appends them at the end. */
static void part(camber_features *f, size_t first_polyline, size_t first_feature, aside *labels) {
    const size_t feature_end = f->feature_count, polyline_end = f->polyline_count;
    size_t p = first_polyline, begin = f->offsets[first_polyline];
    f->feature_count = first_feature;
    f->polyline_count = first_polyline;
    f->point_count = begin;
    for (size_t i = first_feature; i < feature_end; i++) {
        const uint32_t class_index = f->feature_class[i];
        const bool label = camber_geometry_is_label(f->classes[class_index].geometry);
        for (; p < polyline_end && f->polyline_feature[p] == i; p++) {
            const size_t end = f->offsets[p + 1];
            if (label)
                set_aside(labels, f->points + 2 * begin, end - begin, f->feature_counts[p]);
            else
                put(f, f->points + 2 * begin, end - begin, f->feature_count, f->feature_counts[p]);
            begin = end;
        }
        if (label)
            labels->classes[labels->feature_count++] = class_index;
        else
            f->feature_class[f->feature_count++] = class_index;
    }
    const double *points = labels->points;
    for (size_t i = 0; i < labels->polyline_count; points += 2 * labels->counts[i++])
        put(f, points, labels->counts[i], f->feature_count + labels->features[i], labels->feature_counts[i]);
    for (size_t i = 0; i < labels->feature_count; i++)
        f->feature_class[f->feature_count++] = labels->classes[i];
}

camber_status camber_features_part_labels(camber_features *features, size_t first_polyline) {
    bool sorted = true;
    for (size_t p = first_polyline + 1; features->wants_labels && p < features->polyline_count && sorted; p++)
        sorted = !camber_geometry_is_label(camber_features_kind(features, p - 1)) ||
                 camber_geometry_is_label(camber_features_kind(features, p));
    if (sorted)
        return CAMBER_OK;
    aside labels = {0};
    const size_t first_feature = features->polyline_feature[first_polyline];
    const bool fits = make_room(features, first_polyline, first_feature, &labels);
    if (fits)
        part(features, first_polyline, first_feature, &labels);
    camber_free(features->context, labels.feature_counts);
    camber_free(features->context, labels.features);
    camber_free(features->context, labels.counts);
    camber_free(features->context, labels.points);
    camber_free(features->context, labels.classes);
    return fits ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

static bool counts(const camber_features *features, size_t feature) {
    return camber_feature_class_counts(&features->classes[features->feature_class[feature]]);
}

size_t camber_features_count_drawn(const camber_features *features) {
    size_t count = 0;
    for (size_t i = 0; i < features->feature_count; i++)
        count += counts(features, i);
    return count;
}

void camber_features_count(camber_features *features) {
    camber_features_stats *stats = &features->stats;
    stats->features = camber_features_count_drawn(features);
    stats->polylines = stats->points = 0;
    for (size_t p = 0; p < features->polyline_count; p++) {
        if (!counts(features, features->polyline_feature[p]))
            continue;
        stats->polylines++;
        stats->points += features->offsets[p + 1] - features->offsets[p];
    }
}
