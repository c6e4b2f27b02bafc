/* Frees memory that a set of features no longer needs.
 *
 * Input: a set whose lines are merged and have importance. Output: the same lines with fewer points, in less memory.
 * The main idea: a picture of a large country leaves out most points, because each pixel contains many of them. Points
 * that no later picture needs are dropped: before the network of a single view is made, and between the zooms of a
 * pyramid. */
#include "features/features.h"

#include <math.h>

/* Shrinks a block to its used size. Returns false if that fails; the block is then unchanged. */
static bool fit(camber_context *context, void *block, size_t count, size_t size_bytes) {
    void *held;
    memcpy(&held, block, sizeof held);
    held = held ? camber_resize_quietly(context, held, (count ? count : 1) * size_bytes) : NULL;
    if (held)
        memcpy(block, &held, sizeof held);
    return held != NULL;
}

void camber_features_shrink(camber_features *f) {
    camber_context *context = f->context;
    const size_t polylines = f->polyline_count + 1;
    if (f->point_count < f->point_capacity && fit(context, &f->points, f->point_count, 2 * sizeof *f->points))
        f->point_capacity = f->point_count ? f->point_count : 1;
    if (f->point_count < f->importance_capacity && fit(context, &f->importance, f->point_count, sizeof *f->importance))
        f->importance_capacity = f->point_count ? f->point_count : 1;
    /* One capacity counts the entries of all these arrays. The smaller value is also safe for arrays that could not be
     * shrunk. */
    if (polylines < f->polyline_capacity) {
        f->polyline_capacity = polylines;
        (void)fit(context, &f->offsets, polylines, sizeof *f->offsets);
        (void)fit(context, &f->polyline_feature, polylines, sizeof *f->polyline_feature);
        (void)fit(context, &f->feature_counts, polylines, sizeof *f->feature_counts);
    }
}

static bool is_place(const double *point) {
    return isfinite(point[0]) && isfinite(point[1]);
}

static camber_status count_whole(camber_features *f) {
    if (f->whole_counts)
        return CAMBER_OK;
    if (!(f->whole_counts = camber_alloc(f->context, f->polyline_count, sizeof *f->whole_counts)))
        return CAMBER_ERROR_MEMORY;
    for (size_t p = 0; p < f->polyline_count; p++)
        f->whole_counts[p] = (uint32_t)(f->offsets[p + 1] - f->offsets[p]);
    return CAMBER_OK;
}

camber_status camber_features_thin(camber_features *features, float least_importance) {
    camber_features *f = features;
    if (!(least_importance > 0.0f) || !f->importance || f->polyline_count == 0)
        return CAMBER_OK;
    if (count_whole(f) != CAMBER_OK)
        return CAMBER_ERROR_MEMORY;
    f->changes++;
    /* A network ends a line at a point that is not finite, so the neighbours of such a point stay. before: the last
     * point before thinning, because its memory may already have been overwritten. */
    double before[2] = {0.0, 0.0};
    size_t to = f->offsets[0], begin = to;
    for (size_t p = 0; p < f->polyline_count; p++) {
        const size_t end = f->offsets[p + 1];
        f->offsets[p] = to;
        for (size_t i = begin; i < end; i++) {
            double at[2];
            memcpy(at, f->points + 2 * i, sizeof at);
            const bool kept = i == begin || i + 1 == end || !(f->importance[i] < least_importance) ||
                              !is_place(before) || !is_place(at) || !is_place(f->points + 2 * i + 2);
            memcpy(before, at, sizeof at);
            if (!kept)
                continue;
            memcpy(f->points + 2 * to, at, sizeof at);
            f->importance[to++] = f->importance[i];
        }
        begin = end;
    }
    f->offsets[f->polyline_count] = f->point_count = to;
    camber_features_shrink(f);
    return CAMBER_OK;
}
