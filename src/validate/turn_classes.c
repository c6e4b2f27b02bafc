#define _XOPEN_SOURCE 700 /* M_PI */

#include "validate/turn_classes.h"

#include <math.h>

/* Visits a line's points one after the other. */
typedef struct walk {
    float x, y;                /* the last point */
    double dx, dy;             /* the step to the last point; doubles hold the exact difference of two floats */
    double first_dx, first_dy; /* the first step */
    size_t points;             /* valid points since the last invalid one */
    size_t counts[CAMBER_TURN_CLASSES];
} walk;

static void put_join(walk *w, double dx, double dy) {
    const double turn_deg = fabs(atan2(w->dx * dy - w->dy * dx, w->dx * dx + w->dy * dy)) * 180 / M_PI;
    const size_t class = (size_t)(turn_deg / CAMBER_TURN_CLASS_DEG);
    w->counts[class < CAMBER_TURN_CLASSES ? class : CAMBER_TURN_CLASSES - 1]++;
}

/* Compares floats, so that the same points are repeated as in camber_polylines_create. */
static bool is_repeated(const walk *w, const float *point) {
    const float dx = point[0] - w->x, dy = point[1] - w->y;
    return w->points > 0 && dx * dx + dy * dy <= 1e-18f;
}

static void put_point(walk *w, const float *point) {
    if (is_repeated(w, point))
        return;
    const double dx = (double)point[0] - (double)w->x, dy = (double)point[1] - (double)w->y;
    if (w->points > 1)
        put_join(w, dx, dy);
    if (w->points == 1) {
        w->first_dx = dx;
        w->first_dy = dy;
    }
    w->dx = dx;
    w->dy = dy;
    w->x = point[0];
    w->y = point[1];
    w->points++;
}

static bool is_number(const float *point) {
    return fabsf(point[0]) <= 1e9f && fabsf(point[1]) <= 1e9f;
}

static void walk_line(walk *w, const float *points, size_t count, bool keep_open) {
    size_t numbers = 0;
    w->points = 0;
    for (size_t i = 0; i < count; i++) {
        if (!is_number(points + 2 * i)) {
            w->points = 0;
            continue;
        }
        put_point(w, points + 2 * i);
        numbers++;
    }
    if (keep_open || count < 3 || numbers < count || w->points < 3)
        return;
    const float *last = points + 2 * (count - 1);
    if (points[0] == last[0] && points[1] == last[1])
        put_join(w, w->first_dx, w->first_dy);
}

void camber_turns_count(const camber_lines *lines, bool keep_open, size_t counts[CAMBER_TURN_CLASSES]) {
    walk w = {0};
    for (size_t i = 0; i < lines->polyline_count; i++)
        walk_line(&w, lines->points + 2 * (size_t)lines->offsets[i], lines->offsets[i + 1] - lines->offsets[i],
                  keep_open);
    for (size_t i = 0; i < CAMBER_TURN_CLASSES; i++)
        counts[i] += w.counts[i];
}
