/* Checks offset lines. Kernels and CPU twin share the code that makes them, so a mistake shows only in the positions of
 * their points. */
#include "validate/checks.h"

#include <math.h>
#include <stdio.h>

/* A line that bends to one side around a circle: a straight part, a turn, a straight part. */
typedef struct bend {
    const char *name;
    double radius, turn; /* px, radians; clockwise as seen */
    double step;         /* px */
} bend;

static const bend bends[] = {{"a corner", 0.01, 1.5, 1},     {"a sharp corner", 0.01, -2.4, 1},
                             {"a narrow curve", 4, 1.6, 1},  {"a narrow curve of long steps", 5, -1.6, 3},
                             {"a curve", 9, -2, 2},          {"a wide curve", 40, 1.2, 3},
                             {"a gentle bend", 0.01, 0.2, 1}};

enum { POINTS_MAX = 64 };
static const double STRAIGHT_PX = 90, OFFSET_PX = 6;

typedef struct path {
    float points[2 * POINTS_MAX];
    uint32_t count;
} path;

static void add(path *p, double x, double y) {
    p->points[2 * p->count] = (float)x;
    p->points[2 * p->count++ + 1] = (float)y;
}

static path make_path(const bend *b) {
    const double side = b->turn > 0 ? 1 : -1;
    const size_t steps = (size_t)(fabs(b->turn) * b->radius / b->step) + 1;
    path p = {.count = 0};
    add(&p, 20, 120);
    if (b->radius < 1)
        add(&p, 20 + STRAIGHT_PX, 120);
    for (size_t i = 0; i <= steps && b->radius >= 1; i++) {
        const double angle = b->turn * (double)i / (double)steps;
        add(&p, 20 + STRAIGHT_PX + b->radius * sin(fabs(angle)), 120 + side * b->radius * (1 - cos(angle)));
    }
    const float *last = p.points + 2 * (p.count - 1);
    add(&p, (double)last[0] + STRAIGHT_PX * cos(b->turn), (double)last[1] + STRAIGHT_PX * sin(b->turn));
    return p;
}

static double distance_to(const path *p, double x, double y) {
    double least = INFINITY;
    for (size_t i = 0; i + 1 < p->count; i++) {
        const float *a = p->points + 2 * i;
        const double ax = (double)a[0], ay = (double)a[1], ex = (double)a[2] - ax, ey = (double)a[3] - ay;
        const double t = fmin(fmax(((x - ax) * ex + (y - ay) * ey) / (ex * ex + ey * ey), 0), 1);
        least = fmin(least, hypot(x - ax - ex * t, y - ay - ey * t));
    }
    return least;
}

static void fail(camber_check *check, const camber_point_stages *at, const char *field, double got, double expected) {
    check->result = CAMBER_RESULT_FAILED;
    check->finding = (camber_finding){"offset", true, at->polyline, at->point, (double)at->x, (double)at->y,
                                      field,    got,  expected,     "",        NULL};
    snprintf(check->finding.what, sizeof check->finding.what,
             "offset: point %u at (%.9g, %.9g): its %s is %.9g px, expected %.9g", at->point, (double)at->x,
             (double)at->y, field, got, expected);
}

/* Arcs may be up to an eighth of a pixel too far out; rounding errors are smaller than that. */
static void check_points(const bend *b, const path *p, double offset, const camber_stages *stages,
                         camber_check *check) {
    static const double OUTSIDE_PX = 0.13, INSIDE_PX = 0.04, ROUNDING_PX = 1e-3;
    const camber_point_stages *first = stages->points, *last = stages->points + stages->point_count - 1;
    const double along = (double)first->x - (double)p->points[0], aside = (double)first->y - (double)p->points[1];
    for (size_t i = 0; i < stages->point_count; i++) {
        const double distance = distance_to(p, (double)stages->points[i].x, (double)stages->points[i].y);
        if (distance > fabs(offset) + OUTSIDE_PX || distance < fabs(offset) - INSIDE_PX)
            fail(check, stages->points + i, "distance", distance, fabs(offset));
    }
    if (!(fabs(along) <= ROUNDING_PX && fabs(aside - offset) <= ROUNDING_PX)) /* the line begins to the right */
        fail(check, first, "offset", aside, offset);
    const double end_x = (double)p->points[2 * p->count - 2] - sin(b->turn) * offset;
    const double end_y = (double)p->points[2 * p->count - 1] + cos(b->turn) * offset;
    const double missed = hypot((double)last->x - end_x, (double)last->y - end_y);
    if (!(missed <= 10 * ROUNDING_PX))
        fail(check, last, "end", missed, 0);
}

static camber_status check_bend(camber_validation *v, const bend *b, double offset) {
    const path p = make_path(b);
    const camber_stroke stroke = {.width_px = 3, .offset_px = (float)offset};
    const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1};
    const camber_polylines_desc given = {
        .points = p.points, .point_count = p.count, .offsets = (const uint32_t[]){0, p.count}, .polyline_count = 1};
    camber_check check = camber_check_start(NULL, NULL, "offset lines: %s %s: keep their distance",
                                            b->turn * offset > 0 ? "inside" : "outside", b->name);
    camber_polylines *polylines = NULL;
    camber_stages stages = {0};
    camber_status made = camber_polylines_create(v->desc->context, &given, &polylines);
    if (made == CAMBER_OK)
        made = camber_stages_tessellate(v->desc->context, polylines, &desc, &stages);
    if (made == CAMBER_OK && stages.point_count > 1) {
        check_points(b, &p, offset, &stages, &check);
    } else if (made == CAMBER_OK) {
        check.result = CAMBER_RESULT_FAILED;
        snprintf(check.finding.what, sizeof check.finding.what, "offset: the line is gone");
    }
    camber_stages_destroy(&stages);
    camber_polylines_destroy(polylines);
    const camber_status status = made;
    if (status == CAMBER_OK)
        camber_results_add(&v->results, &check);
    return status;
}

camber_status camber_check_offsets(camber_validation *validation) {
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < sizeof bends / sizeof *bends; i++)
        for (int side = -1; side < 2 && status == CAMBER_OK; side += 2)
            status = check_bend(validation, bends + i, side * OFFSET_PX);
    return status;
}
