/* Finds the places along a line that labels may take, as MapLibre does.
 *
 * Input: a line in px, how long a label is, how far apart labels are. Output: distances along the line.
 *
 *     |-- half a label, 2 em --o---- spacing ----o---- spacing ----o---|
 *
 * Main idea: anchors are counted from the line's first point, wherever the picture is, so that a part of the map has
 * the same anchors in every picture. Only segments that touch the box in which anchors are needed are searched. */
#include "map/label_anchors.h"

#include <math.h>

static double length_of(const camber_label_path *path) {
    return path->along[path->count - 1];
}

/* Returns the turn at a point between two segments, in radians. */
static double turn_at(const camber_label_path *path, size_t i) {
    const double *p = path->points + 2 * i;
    const double ax = p[0] - p[-2], ay = p[1] - p[-1], bx = p[2] - p[0], by = p[3] - p[1];
    return fabs(atan2(ax * by - ay * bx, ax * bx + ay * by));
}

bool camber_path_takes(const camber_label_path *path, const camber_path_anchor *anchor,
                       const camber_anchor_rule *rule) {
    const double half = 0.5 * rule->label_length, first = anchor->along - half, last = anchor->along + half;
    if (first < 0.0 || last > length_of(path))
        return false;
    if (!(rule->window > 0.0))
        return true;
    size_t at = anchor->segment + 1;
    while (at > 1 && path->along[at - 1] > first)
        at--;
    double sum = 0.0;
    for (size_t tail = at; at + 1 < path->count && path->along[at] < last; at++) {
        sum += turn_at(path, at);
        for (; path->along[at] - path->along[tail] > rule->window; tail++)
            sum -= turn_at(path, tail);
        if (sum > rule->max_angle)
            return false;
    }
    return true;
}

void camber_path_point(const camber_label_path *path, const camber_path_anchor *anchor, double point[2]) {
    const double *a = path->points + 2 * anchor->segment, first = path->along[anchor->segment];
    const double t = (anchor->along - first) / (path->along[anchor->segment + 1] - first);
    point[0] = a[0] + (a[2] - a[0]) * t;
    point[1] = a[1] + (a[3] - a[1]) * t;
}

static camber_status add(camber_path_anchors *anchors, camber_path_anchor anchor) {
    if (!camber_grow(anchors->context, &anchors->items, &anchors->capacity, anchors->count + 1, sizeof *anchors->items))
        return CAMBER_ERROR_MEMORY;
    anchors->items[anchors->count++] = anchor;
    return CAMBER_OK;
}

/* Reduces share, two fractions of a segment's length, to the part of the segment that is in the box along one axis. */
static void cut(double from, double to, double low, double high, double share[2]) {
    const double step = to - from;
    if (step == 0.0) {
        if (from < low || from > high)
            share[1] = -1.0;
        return;
    }
    const double a = (low - from) / step, b = (high - from) / step;
    share[0] = fmax(share[0], fmin(a, b));
    share[1] = fmin(share[1], fmax(a, b));
}

static bool is_in(const camber_box *box, const double point[2]) {
    return point[0] >= box->x0 && point[0] <= box->x1 && point[1] >= box->y0 && point[1] <= box->y1;
}

/* Evenly spaced anchors, the first of them at an offset. wanted NULL: only finds out whether there are any. */
typedef struct anchor_series {
    const camber_label_path *path;
    const camber_anchor_rule *rule;
    double offset, spacing;
    camber_path_anchors *wanted;
    bool any;
} anchor_series;

static camber_status search_segment(anchor_series *series, size_t i) {
    const camber_label_path *path = series->path;
    const double *a = path->points + 2 * i, from = path->along[i], to = path->along[i + 1];
    const camber_box *seen = &series->rule->seen;
    double share[2] = {0.0, 1.0};
    if (series->wanted) {
        cut(a[0], a[2], seen->x0, seen->x1, share);
        cut(a[1], a[3], seen->y0, seen->y1, share);
        if (!(share[0] <= share[1]))
            return CAMBER_OK;
    }
    const double low = fmax(from + share[0] * (to - from), 0.5 * series->rule->label_length);
    const double high = fmin(from + share[1] * (to - from), length_of(path) - 0.5 * series->rule->label_length);
    for (double k = fmax(floor((low - series->offset) / series->spacing) - 1.0, 0.0);; k += 1.0) {
        const camber_path_anchor anchor = {series->offset + k * series->spacing, i, k};
        if (!(anchor.along < to) || anchor.along > high + series->spacing)
            return CAMBER_OK;
        if (anchor.along < from)
            continue;
        double point[2];
        camber_path_point(path, &anchor, point);
        if ((series->wanted && !is_in(seen, point)) || !camber_path_takes(path, &anchor, series->rule))
            continue;
        series->any = true;
        if (!series->wanted)
            return CAMBER_OK;
        if (add(series->wanted, anchor) != CAMBER_OK)
            return CAMBER_ERROR_MEMORY;
    }
}

static camber_status search(anchor_series *series) {
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i + 1 < series->path->count && status == CAMBER_OK && (series->wanted || !series->any); i++)
        status = search_segment(series, i);
    return status;
}

camber_status camber_path_repeat(const camber_label_path *path, const camber_anchor_rule *rule,
                                 camber_path_anchors *anchors) {
    if (path->count < 2 || rule->label_length > length_of(path) || !(rule->spacing > 0.0))
        return CAMBER_OK;
    const double least = rule->spacing / 4.0;
    const double spacing = rule->spacing - rule->label_length < least ? rule->label_length + least : rule->spacing;
    const size_t before = anchors->count;
    anchor_series series = {.path = path,
                            .rule = rule,
                            .offset = fmod(0.5 * rule->label_length + 2.0 * rule->em, spacing),
                            .spacing = spacing,
                            .wanted = anchors};
    camber_status status = search(&series);
    if (status != CAMBER_OK || series.any)
        return status;
    anchor_series middle = series, others = series;
    middle.offset = 0.5 * length_of(path);
    status = search(&middle);
    if (status != CAMBER_OK || !middle.any)
        return status;
    others.wanted = NULL;
    status = search(&others);
    if (others.any)
        anchors->count = before;
    return status;
}

camber_status camber_path_middle(const camber_label_path *path, const camber_anchor_rule *rule,
                                 camber_path_anchors *anchors) {
    if (path->count < 2)
        return CAMBER_OK;
    camber_path_anchor anchor = {.along = 0.5 * length_of(path)};
    while (anchor.segment + 2 < path->count && path->along[anchor.segment + 1] <= anchor.along)
        anchor.segment++;
    double point[2];
    camber_path_point(path, &anchor, point);
    return is_in(&rule->seen, point) && camber_path_takes(path, &anchor, rule) ? add(anchors, anchor) : CAMBER_OK;
}
