/* Restores the order of the file for features that were read in another order. This order decides which line is drawn
 * on top. */
#include "features/features.h"

#include <stdlib.h>

typedef struct keyed_feature {
    int64_t key;
    uint32_t feature;
} keyed_feature;

static int compare(const void *left, const void *right) {
    const keyed_feature *a = left, *b = right;
    if (a->key != b->key)
        return a->key < b->key ? -1 : 1;
    return a->feature < b->feature ? -1 : a->feature > b->feature;
}

/* The features and lines before sorting. */
typedef struct former {
    keyed_feature *features;
    size_t *first_polylines; /* by feature, and one more */
    double *points;
    size_t *offsets;
    uint32_t *classes, *counts;
} former;

static bool copy(const camber_features *f, size_t first_polyline, size_t first_feature, const int64_t *keys,
                 former *was) {
    const size_t features = f->feature_count - first_feature, polylines = f->polyline_count - first_polyline,
                 first_point = f->offsets[first_polyline], points = f->point_count - first_point;
    if (!(was->features = camber_alloc(f->context, features, sizeof *was->features)) ||
        !(was->first_polylines = camber_alloc(f->context, features + 1, sizeof *was->first_polylines)) ||
        !(was->points = camber_alloc(f->context, points, 2 * sizeof *was->points)) ||
        !(was->offsets = camber_alloc(f->context, polylines + 1, sizeof *was->offsets)) ||
        !(was->classes = camber_alloc(f->context, features, sizeof *was->classes)) ||
        !(was->counts = camber_alloc(f->context, polylines, sizeof *was->counts)))
        return false;
    memcpy(was->points, f->points + 2 * first_point, 2 * points * sizeof *was->points);
    memcpy(was->offsets, f->offsets + first_polyline, (polylines + 1) * sizeof *was->offsets);
    memcpy(was->classes, f->feature_class + first_feature, features * sizeof *was->classes);
    memcpy(was->counts, f->feature_counts + first_polyline, polylines * sizeof *was->counts);
    size_t polyline = 0;
    for (size_t i = 0; i < features; i++) {
        was->features[i] = (keyed_feature){keys[i], (uint32_t)i};
        was->first_polylines[i] = polyline;
        while (polyline < polylines && f->polyline_feature[first_polyline + polyline] == first_feature + i)
            polyline++;
    }
    was->first_polylines[features] = polyline;
    return true;
}

static void put_back(camber_features *f, size_t first_polyline, size_t first_feature, const former *was) {
    size_t polyline = first_polyline, point = f->offsets[first_polyline];
    const size_t first_point = point;
    for (size_t i = first_feature; i < f->feature_count; i++) {
        const uint32_t old = was->features[i - first_feature].feature;
        f->feature_class[i] = was->classes[old];
        for (size_t p = was->first_polylines[old]; p < was->first_polylines[old + 1]; p++) {
            const size_t count = was->offsets[p + 1] - was->offsets[p];
            memcpy(f->points + 2 * point, was->points + 2 * (was->offsets[p] - first_point),
                   2 * count * sizeof *f->points);
            f->polyline_feature[polyline] = (uint32_t)i;
            f->feature_counts[polyline] = was->counts[p];
            point += count;
            f->offsets[++polyline] = point;
        }
    }
}

camber_status camber_features_reorder(camber_features *features, size_t first_polyline, size_t first_feature,
                                      const int64_t *keys) {
    const size_t count = features->feature_count - first_feature;
    bool sorted = true;
    for (size_t i = 1; i < count; i++)
        sorted = sorted && keys[i - 1] <= keys[i];
    if (sorted)
        return CAMBER_OK;
    former was = {0};
    const bool copied = copy(features, first_polyline, first_feature, keys, &was);
    if (copied) {
        qsort(was.features, count, sizeof *was.features, compare);
        put_back(features, first_polyline, first_feature, &was);
    }
    camber_free(features->context, was.counts);
    camber_free(features->context, was.classes);
    camber_free(features->context, was.offsets);
    camber_free(features->context, was.points);
    camber_free(features->context, was.first_polylines);
    camber_free(features->context, was.features);
    return copied ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}
