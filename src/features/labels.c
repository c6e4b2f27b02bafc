/* Features for symbol layers, beside those that are drawn.
 *
 * Input: a set whose program draws labels. Output: the same lines, areas and points once more, under kinds of labels,
 * of classes that have the properties that symbol layers read. Main idea: labels come behind what is drawn of a file,
 * and are merged and weighed apart from it, so that a picture without its labels stays the same to the last bit. */
#include "features/features.h"

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

camber_status camber_features_part_labels(camber_features *features, size_t first_polyline) {
    if (!features->wants_labels || first_polyline == features->polyline_count)
        return CAMBER_OK;
    const size_t first_feature = features->polyline_feature[first_polyline];
    const size_t count = features->feature_count - first_feature;
    int64_t *keys = camber_alloc(features->context, count, sizeof *keys);
    if (!keys)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++) {
        const uint32_t class_index = features->feature_class[first_feature + i];
        keys[i] = camber_geometry_is_label(features->classes[class_index].geometry);
    }
    const camber_status status = camber_features_reorder(features, first_polyline, first_feature, keys);
    camber_free(features->context, keys);
    return status;
}

size_t camber_features_count_drawn(const camber_features *features) {
    size_t count = features->feature_count;
    for (size_t i = 0; features->wants_labels && i < features->feature_count; i++)
        count -= camber_geometry_is_label(features->classes[features->feature_class[i]].geometry);
    return count;
}

void camber_features_count(camber_features *features) {
    camber_features_stats *stats = &features->stats;
    stats->features = camber_features_count_drawn(features);
    stats->polylines = features->polyline_count;
    stats->points = features->point_count;
    for (size_t p = 0; features->wants_labels && p < features->polyline_count; p++) {
        if (!camber_geometry_is_label(camber_features_kind(features, p)))
            continue;
        stats->polylines--;
        stats->points -= features->offsets[p + 1] - features->offsets[p];
    }
}
