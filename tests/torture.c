#include "torture.h"

/* Room around a stroke: half a width times the miter limit of 2 or a square cap's corner, and what is drawn beside. */
enum { MARGIN_PX = 4 };

torture_set torture_begin(int width) {
    return (torture_set){.width = width};
}

void torture_free(torture_set *set) {
    scene_free(&set->lines);
    free(set->figures);
    for (size_t i = 0; i < sizeof set->truths / sizeof *set->truths; i++)
        free(set->truths[i]);
    *set = (torture_set){0};
}

/* Moves the figure's points so that its cell lies right of the last one, or below all when the row is full. Fractions
 * of a pixel stay: they are part of the figure. */
static void place(torture_set *set, torture_figure *f, size_t first) {
    float *points = set->lines.points;
    double left = INFINITY, top = INFINITY, right = -INFINITY, bottom = -INFINITY;
    for (size_t i = first; i < set->lines.point_count; i++) {
        left = fmin(left, (double)points[2 * i]), right = fmax(right, (double)points[2 * i]);
        top = fmin(top, (double)points[2 * i + 1]), bottom = fmax(bottom, (double)points[2 * i + 1]);
    }
    const double reach = f->width_px + MARGIN_PX;
    left = floor(left - reach), top = floor(top - reach);
    f->cell.width = (int)ceil(right + reach - left);
    f->cell.height = (int)ceil(bottom + reach - top);
    const camber_window *last = set->count ? &set->figures[set->count - 1].cell : NULL;
    const int next = last ? last->x0 + last->width : 0;
    const bool fits = next + f->cell.width <= set->width;
    f->cell.x0 = fits ? next : 0;
    f->cell.y0 = !last ? 0 : fits ? last->y0 : set->height;
    for (size_t i = first; i < set->lines.point_count; i++) {
        points[2 * i] = (float)((double)points[2 * i] - left + f->cell.x0);
        points[2 * i + 1] = (float)((double)points[2 * i + 1] - top + f->cell.y0);
    }
    const int end = f->cell.y0 + f->cell.height;
    set->height = end > set->height ? end : set->height;
}

void torture_end_figure(torture_set *set, const char *name, double width_px) {
    scene *lines = &set->lines;
    const size_t first = lines->polyline_count ? lines->offsets[lines->polyline_count] : 0;
    set->figures = realloc(set->figures, (set->count + 1) * sizeof *set->figures);
    assert_non_null(set->figures);
    torture_figure *f = set->figures + set->count;
    *f = (torture_figure){.width_px = width_px};
    snprintf(f->name, sizeof f->name, "%s", name);
    place(set, f, first);
    scene_end(lines, set->count++);
}

/* ---- The figures ---- */

/* A turtle. */
typedef struct pen {
    scene *lines;
    double x, y, direction; /* radians */
} pen;

static pen pen_at(torture_set *set, double direction_deg) {
    /* Another part of a pixel for each figure. */
    const double k = (double)set->count;
    pen p = {&set->lines, fmod(0.37 * k, 1), fmod(0.61 * k, 1), direction_deg * SCENE_PI / 180};
    scene_point(p.lines, p.x, p.y);
    return p;
}

static void go(pen *p, double length, double turn_deg) {
    p->direction += turn_deg * SCENE_PI / 180;
    p->x += length * cos(p->direction);
    p->y += length * sin(p->direction);
    scene_point(p->lines, p->x, p->y);
}

static void end_named(torture_set *set, double width_px, const char *format, double value) {
    char name[48];
    /* The formats are literals of this file. */
    snprintf(name, sizeof name, "%s %g", format, value);
    torture_end_figure(set, name, width_px);
}

static void add_hairpins(torture_set *set) {
    static const double gaps_px[] = {0.02, 0.5, 2, 5, 10, 16, 24};
    static const double turns_deg[] = {179.99, 179, 175, 165, 150, 130};
    for (size_t i = 0; i < sizeof gaps_px / sizeof *gaps_px; i++) {
        pen p = pen_at(set, 80);
        go(&p, 60, 0);
        go(&p, gaps_px[i], i % 2 ? 90 : -90);
        go(&p, 55, i % 2 ? 90 : -90);
        end_named(set, 20, "hairpin, gap", gaps_px[i]);
    }
    for (size_t i = 0; i < sizeof turns_deg / sizeof *turns_deg; i++) {
        pen p = pen_at(set, 75);
        go(&p, 60, 0);
        go(&p, 50, i % 2 ? turns_deg[i] : -turns_deg[i]);
        end_named(set, i < 3 ? 16 : 24, "hairpin, turn", turns_deg[i]);
    }
}

static void add_reversals(torture_set *set) {
    pen p = pen_at(set, 0);
    go(&p, 64, 0);
    go(&p, 40, 180);
    torture_end_figure(set, "reversal", 18);
    p = pen_at(set, 33);
    for (int i = 0; i < 9; i++)
        go(&p, 60 - 6 * i, i ? 180 : 0);
    torture_end_figure(set, "reversals, eight on one line", 14);
    p = pen_at(set, 60);
    go(&p, 50, 0);
    for (int i = 0; i < 40; i++)
        go(&p, 0.25, i % 2 ? 180 : 35);
    go(&p, 50, 40);
    torture_end_figure(set, "reversals of a quarter pixel", 16);
    p = pen_at(set, -20);
    go(&p, 60, 0);
    go(&p, 30, 180);
    go(&p, 40, 100);
    torture_end_figure(set, "dead end", 12);
}

static void add_zigzags(torture_set *set) {
    static const struct {
        double step_px, turn_deg, width_px;
    } cases[] = {{10, 150, 24}, {4, 120, 24}, {1.2, 90, 24}, {20, 165, 18}, {0.4, 170, 12}, {9, 60, 20}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double turn = cases[i].turn_deg, across = cos(turn / 2 * SCENE_PI / 180);
        pen p = pen_at(set, 12);
        go(&p, 20, 0);
        const int steps = (int)(70 / (cases[i].step_px * across));
        for (int k = 0; k < steps; k++)
            go(&p, cases[i].step_px, k == 0 ? turn / 2 : k % 2 ? -turn : turn);
        go(&p, 20, steps % 2 ? -turn / 2 : turn / 2);
        end_named(set, cases[i].width_px, "zigzag, steps of", cases[i].step_px);
    }
}

static void add_spirals(torture_set *set) {
    static const struct {
        double step_deg, radius_px, width_px;
    } cases[] = {{10, 14, 40}, {30, 18, 40}, {75, 20, 36}, {20, 34, 12}, {130, 26, 30}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        pen p = pen_at(set, 0);
        for (double turned = 0; turned < 3.2 * 360; turned += cases[i].step_deg) {
            const double radius = cases[i].radius_px * (1 - turned / (3.4 * 360));
            go(&p, 2 * radius * sin(cases[i].step_deg / 2 * SCENE_PI / 180),
               i % 2 ? -cases[i].step_deg : cases[i].step_deg);
        }
        end_named(set, cases[i].width_px, "spiral, degrees a step", cases[i].step_deg);
    }
    pen p = pen_at(set, 0); /* a point in the middle, turned about by a pixel */
    go(&p, 40, 0);
    for (int i = 0; i < 60; i++)
        go(&p, 0.6, 25);
    go(&p, 40, 60);
    torture_end_figure(set, "knot of steps of 0.6", 30);
}

static void add_stars(torture_set *set) {
    static const int tips[] = {5, 7, 12}, skips[] = {2, 3, 5};
    for (int i = 0; i < 3; i++) {
        pen p = pen_at(set, 7);
        const size_t first = set->lines.point_count - 1;
        for (int k = 1; k < tips[i]; k++)
            go(&p, 84, k == 1 ? 0 : 360.0 * skips[i] / tips[i]);
        scene_point(&set->lines, (double)set->lines.points[2 * first], (double)set->lines.points[2 * first + 1]);
        end_named(set, 9, "star, closed, tips", tips[i]);
    }
    for (int i = 0; i < 2; i++) {
        pen p = pen_at(set, 0);
        const int rays = i ? 23 : 8;
        for (int k = 0; k < rays; k++) {
            go(&p, 40, k ? 180 + 360.0 / rays : 5);
            go(&p, 40, 180);
        }
        end_named(set, i ? 5 : 14, "star of reversals, rays", rays);
    }
}

static void add_short_ends(torture_set *set) {
    static const double lengths_px[] = {0.02, 0.3, 1, 3, 8};
    static const double turns_deg[] = {170, 90, -135, 60, -100};
    for (size_t i = 0; i < 5; i++) {
        pen p = pen_at(set, -10 - 5 * (double)i);
        go(&p, lengths_px[i], 0);
        go(&p, 60, -turns_deg[i] / 2);
        go(&p, lengths_px[i], turns_deg[i]);
        end_named(set, 22, "ends of px", lengths_px[i]);
    }
    pen p = pen_at(set, 25);
    go(&p, 50, 0);
    for (int i = 0; i < 5; i++)
        go(&p, 1.5, 70);
    torture_end_figure(set, "curl at the end", 24);
}

static void add_u_turns(torture_set *set) {
    static const double radii_px[] = {0.3, 2, 6, 11, 14};
    for (size_t i = 0; i < sizeof radii_px / sizeof *radii_px; i++) {
        const int steps = 12 + 6 * (int)i;
        pen p = pen_at(set, 97);
        go(&p, 50, 0);
        for (int k = 0; k < steps; k++)
            go(&p, 2 * radii_px[i] * sin(SCENE_PI / 2 / steps), 180.0 / steps);
        go(&p, 50, 0);
        end_named(set, 24, "U-turn, radius", radii_px[i]);
    }
}

static void add_rings(torture_set *set) {
    static const struct {
        int sides;
        double side_px, width_px;
    } cases[] = {{3, 6, 20}, {4, 22, 20}, {24, 1, 24}, {3, 60, 22}, {40, 4, 30}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        pen p = pen_at(set, 15);
        const size_t first = set->lines.point_count - 1;
        for (int k = 1; k < cases[i].sides; k++)
            go(&p, cases[i].side_px, k == 1 ? 0 : 360.0 / cases[i].sides);
        scene_point(&set->lines, (double)set->lines.points[2 * first], (double)set->lines.points[2 * first + 1]);
        end_named(set, cases[i].width_px, "ring, sides of px", cases[i].side_px);
    }
}

static void add_scribbles(torture_set *set) {
    static const struct {
        size_t points;
        double box_px, width_px;
    } cases[] = {{12, 60, 18}, {40, 70, 12}, {30, 30, 26}, {200, 90, 7}, {60, 4, 16}};
    uint64_t seed = 20240229;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (size_t k = 0; k < cases[i].points; k++) {
            const double x = random_between(&seed, 0, cases[i].box_px);
            scene_point(&set->lines, x, random_between(&seed, 0, cases[i].box_px));
        }
        end_named(set, cases[i].width_px, "scribble, points", (double)cases[i].points);
    }
    for (int i = 0; i < 120; i++) { /* a receiver that stands still, then walks on */
        const double spread = i < 80 ? 1.5 : 0.2, along = i < 80 ? 0 : 1.5 * (i - 80);
        const double x = along + random_between(&seed, -spread, spread);
        scene_point(&set->lines, x, 0.4 * along + random_between(&seed, -spread, spread));
    }
    torture_end_figure(set, "trembling track", 14);
    pen p = pen_at(set, 90);
    for (int i = 0; i < 16; i++) {
        go(&p, 44, i == 0 ? 0 : i % 2 ? -90 : 90);
        go(&p, 5, i % 2 ? 90 : -90);
    }
    torture_end_figure(set, "comb narrower than the width", 14);
}

/* Parts of one line whose edges fall on each other: half of a pixel each. */
static void add_meetings(torture_set *set) {
    pen p = pen_at(set, 83);
    go(&p, 60, 0);
    go(&p, 20, -90);
    go(&p, 60, -90);
    torture_end_figure(set, "hairpin, gap of the width", 20);
    p = pen_at(set, 31);
    for (int i = 0; i < 6; i++) {
        go(&p, 50, i == 0 ? 0 : i % 2 ? -90 : 90);
        go(&p, 10, i % 2 ? 90 : -90);
    }
    torture_end_figure(set, "comb, pitch of the width", 10);
}

/* As long as the longest lines of real networks, with their mixture: straights of many short pieces, bends, hairpins,
 * points that lie on each other. */
static void add_long_line(torture_set *set) {
    enum { POINTS = 2217 };
    uint64_t seed = 1759;
    pen p = pen_at(set, 0);
    double bend = 0;
    for (int i = 1; i < POINTS; i++) {
        const double chance = random_between(&seed, 0, 1);
        const double step = pow(10, random_between(&seed, -1.7, 0.75));
        if (i % 40 == 0)
            bend = random_between(&seed, -14, 14);
        /* Bound for the middle of a box, so that it stays there. */
        const double home = atan2(70 - p.y, 110 - p.x) - p.direction, away = hypot((70 - p.y) / 70, (110 - p.x) / 110);
        const double pull = away > 0.8 ? 30 * sin(home) : 0;
        go(&p, step, chance < 0.02 ? 180 * (chance < 0.01) + 90 : bend + pull + random_between(&seed, -25, 25));
    }
    end_named(set, 8, "long line, points", POINTS);
}

torture_set torture_make(void) {
    torture_set set = torture_begin(960);
    add_hairpins(&set);
    add_reversals(&set);
    add_zigzags(&set);
    add_spirals(&set);
    add_stars(&set);
    add_short_ends(&set);
    add_u_turns(&set);
    add_rings(&set);
    add_scribbles(&set);
    add_meetings(&set);
    add_long_line(&set);
    return set;
}
