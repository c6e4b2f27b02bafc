/* Lines beside others: against offset curves that are sampled in double precision and thinned by distance, the device
 * against the twin to the last bit, over borders of chunks and parts, and cameras against each other. */
#include "test_fixture.h"

#include "residency/memory.h"

#include <float.h>

enum { POINTS_MAX = 600, SAMPLES_MAX = 1 << 18 };

/* ---- Truth ---- */

typedef struct line {
    double points[2 * POINTS_MAX];
    size_t count;
} line;

typedef struct samples {
    double *points;
    size_t count;
} samples;

static void add(line *l, double x, double y) {
    assert_true(l->count < POINTS_MAX);
    l->points[2 * l->count] = x;
    l->points[2 * l->count++ + 1] = y;
}

static bool is_ring(const line *l) {
    const double *p = l->points, *q = p + 2 * (l->count - 1);
    return l->count > 3 && hypot(p[0] - q[0], p[1] - q[1]) < 1e-9;
}

static double distance_to_segment(const double *a, const double *b, double x, double y) {
    const double ex = b[0] - a[0], ey = b[1] - a[1], l2 = ex * ex + ey * ey;
    const double t = l2 > 0 ? fmin(fmax(((x - a[0]) * ex + (y - a[1]) * ey) / l2, 0), 1) : 0;
    return hypot(x - a[0] - t * ex, y - a[1] - t * ey);
}

static double distance_to_line(const line *l, double x, double y) {
    double least = DBL_MAX;
    for (size_t i = 0; i + 1 < l->count; i++)
        least = fmin(least, distance_to_segment(l->points + 2 * i, l->points + 2 * i + 2, x, y));
    return least;
}

static void sample(samples *s, double x, double y) {
    if (!s->points)
        assert_non_null(s->points = malloc(2 * SAMPLES_MAX * sizeof *s->points));
    assert_true(s->count < SAMPLES_MAX);
    s->points[2 * s->count] = x;
    s->points[2 * s->count++ + 1] = y;
}

/* Every place at the offset of a segment, or about a bend on its outer side, that lies no nearer than that to the line:
 * each offset segment by itself, no thought of what comes before or behind. */
static samples sample_truth(const line *l, double offset, double step) {
    samples s = {0};
    const double least = fabs(offset) - 1e-6;
    for (size_t i = 0; i + 1 < l->count; i++) {
        const double *a = l->points + 2 * i, *b = a + 2;
        const double dx = b[0] - a[0], dy = b[1] - a[1], length = hypot(dx, dy);
        const size_t parts = (size_t)(length / step) + 1;
        for (size_t k = 0; k <= parts; k++) {
            const double t = (double)k / (double)parts;
            const double x = a[0] + dx * t - dy / length * offset, y = a[1] + dy * t + dx / length * offset;
            if (distance_to_line(l, x, y) >= least)
                sample(&s, x, y);
        }
        const double *c = i + 2 < l->count ? b + 2 : is_ring(l) ? l->points + 2 : NULL;
        if (!c)
            continue;
        const double ex = c[0] - b[0], ey = c[1] - b[1];
        const double turn = atan2(dx * ey - dy * ex, dx * ex + dy * ey), from = atan2(dx * offset, -dy * offset);
        const size_t pieces = (size_t)(fabs(turn * offset) / step) + 1;
        for (size_t k = 0; k <= pieces && turn * offset < 0; k++) {
            const double angle = from + turn * (double)k / (double)pieces;
            const double x = b[0] + fabs(offset) * cos(angle), y = b[1] + fabs(offset) * sin(angle);
            if (distance_to_line(l, x, y) >= least)
                sample(&s, x, y);
        }
    }
    return s;
}

/* ---- Making lines ---- */

static camber_polylines *polylines_of(fixture *b, const line *l) {
    float points[2 * POINTS_MAX];
    const uint32_t offsets[] = {0, (uint32_t)l->count};
    for (size_t i = 0; i < 2 * l->count; i++)
        points[i] = (float)l->points[i];
    const camber_polylines_desc desc = {
        .points = points, .point_count = l->count, .offsets = offsets, .polyline_count = 1};
    camber_polylines *polylines = NULL;
    assert_int_equal(camber_polylines_create(b->context, &desc, &polylines), CAMBER_OK);
    return polylines;
}

static line made_of(fixture *b, const line *l, camber_stroke stroke) {
    static line made;
    camber_polylines *polylines = polylines_of(b, l);
    const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1};
    camber_stages stages;
    made.count = 0;
    assert_int_equal(camber_stages_tessellate(b->context, polylines, &desc, &stages), CAMBER_OK);
    for (size_t i = 0; i < stages.point_count; i++)
        add(&made, (double)stages.points[i].x, (double)stages.points[i].y);
    camber_stages_destroy(&stages);
    camber_polylines_destroy(polylines);
    return made;
}

static double farthest_from(const samples *s, const line *made) {
    double most = 0;
    for (size_t i = 0; i < s->count; i++)
        most = fmax(most, made->count ? distance_to_line(made, s->points[2 * i], s->points[2 * i + 1]) : DBL_MAX);
    return most;
}

static double distance_to_samples(const samples *s, double x, double y) {
    double least = DBL_MAX;
    for (size_t i = 0; i < s->count; i++)
        least = fmin(least, hypot(s->points[2 * i] - x, s->points[2 * i + 1] - y));
    return least;
}

/* The line beside is where the truth is and nowhere else. aside: how far either may lie from the other, where links cut
 * corners. */
static void check_shape(fixture *b, const char *name, const line *l, double offset, double aside) {
    const camber_stroke stroke = {.width_px = 2, .offset_px = (float)offset};
    const line made = made_of(b, l, stroke);
    samples truth = sample_truth(l, offset, 0.1);
    const double missed = truth.count ? farthest_from(&truth, &made) : 0;
    double stray = 0, nearest = DBL_MAX;
    for (size_t i = 0; i < made.count; i++)
        nearest = fmin(nearest, distance_to_line(l, made.points[2 * i], made.points[2 * i + 1]));
    for (size_t i = 0; i + 1 < made.count; i++) {
        const double *p = made.points + 2 * i, *q = p + 2;
        const size_t parts = (size_t)(hypot(q[0] - p[0], q[1] - p[1]) / 0.5) + 1;
        for (size_t k = 0; k <= parts && truth.count; k++) {
            const double t = (double)k / (double)parts;
            stray = fmax(stray, distance_to_samples(&truth, p[0] + (q[0] - p[0]) * t, p[1] + (q[1] - p[1]) * t));
        }
    }
    if ((truth.count == 0) != (made.count == 0) || missed > aside || stray > aside || nearest < fabs(offset) - 0.04)
        fail_msg("%s, offset %g: %zu points, %g missed, %g astray, nearest %g", name, offset, made.count, missed, stray,
                 nearest);
    free(truth.points);
}

static void walk_arc(line *l, double x, double y, double radius, double from, double to, double step) {
    const size_t parts = (size_t)(fabs(to - from) * radius / step) + 1;
    for (size_t i = 0; i <= parts; i++) {
        const double angle = from + (to - from) * (double)i / (double)parts;
        add(l, x + radius * cos(angle), y + radius * sin(angle));
    }
}

static void test_bends(void **state) {
    for (int degree = -140; degree <= 140; degree += 5)
        for (int sign = -1; sign < 2; sign += 2) {
            const double angle = degree * SCENE_PI / 180;
            line l = {0};
            add(&l, 20, 30);
            add(&l, 120, 37);
            add(&l, 120 + 100 * cos(angle), 37 + 100 * sin(angle));
            check_shape(*state, "bend", &l, sign * 6, 0.2);
            add(&l, l.points[4] + 80 * cos(angle / 2), l.points[5] + 80 * sin(angle / 2));
            check_shape(*state, "bends", &l, sign * 3.5, 0.2);
        }
}

/* Between two straights a quarter of a circle, of any radius and as fine or coarse as may be: where it is narrower than
 * the offset, its inside is nothing but the place where the straights cross. */
static void test_curves(void **state) {
    static const double radii[] = {0.5, 2, 4, 5.5, 6.5, 9, 20}, steps[] = {0.3, 1, 3};
    for (size_t r = 0; r < sizeof radii / sizeof *radii; r++)
        for (size_t k = 0; k < sizeof steps / sizeof *steps; k++)
            for (int sign = -1; sign < 2; sign += 2) {
                const double radius = radii[r];
                line l = {0};
                add(&l, 20, 100 - radius);
                walk_arc(&l, 100, 100, radius, -SCENE_PI / 2, 0, steps[k]);
                add(&l, 100 + radius, 190);
                check_shape(*state, "curve", &l, sign * 6, 0.45);
            }
}

static void test_small_shapes(void **state) {
    for (int sign = -1; sign < 2; sign += 2) {
        line zigzag = {0}, steps = {0}, jog = {0}, barb = {0};
        add(&zigzag, 10, 50);
        for (int i = 0; i < 12; i++)
            add(&zigzag, 60 + 1.1 * i, i % 2 ? 50 : 51.3);
        add(&zigzag, 130, 50);
        check_shape(*state, "zigzag", &zigzag, sign * 6, 0.5);
        for (int i = 0; i < 20; i++) {
            add(&steps, 20 + 4 * i, 20 + 3 * i);
            add(&steps, 24 + 4 * i, 20 + 3 * i);
        }
        check_shape(*state, "steps", &steps, sign * 6, 0.6);
        add(&jog, 10, 50);
        add(&jog, 60, 50);
        add(&jog, 60, 53);
        add(&jog, 110, 53);
        check_shape(*state, "jog", &jog, sign * 6, 0.3);
        add(&barb, 10, 50);
        add(&barb, 60, 50);
        add(&barb, 61, 44);
        add(&barb, 62, 50);
        add(&barb, 110, 52);
        check_shape(*state, "barb", &barb, sign * 6, 0.5);
    }
}

static void test_rings(void **state) {
    static const double radii[] = {3, 5, 7, 13, 60};
    for (size_t r = 0; r < sizeof radii / sizeof *radii; r++)
        for (size_t sides = 3; sides < 40; sides += sides < 8 ? 1 : 9)
            for (int sign = -1; sign < 2; sign += 2) {
                line l = {0};
                for (size_t i = 0; i < sides; i++)
                    add(&l, 100 + radii[r] * cos(2 * SCENE_PI * (double)i / (double)sides),
                        100 + radii[r] * sin(2 * SCENE_PI * (double)i / (double)sides));
                add(&l, l.points[0], l.points[1]);
                for (size_t i = 0; i < 2; i++) /* what polylines make of it */
                    l.points[2 * (l.count - 1) + i] = l.points[i];
                check_shape(*state, "ring", &l, sign * 6, 0.3);
            }
}

/* A way there and back: as an exact reversal, and with legs that part a little: no loop, and around the end once. */
static void test_hairpins(void **state) {
    for (int sign = -1; sign < 2; sign += 2)
        for (int k = 0; k < 40; k++) {
            const double gap = k < 20 ? 0.003 * (k + 1) : 0.5 * (k - 19); /* without one it is a ring */
            line l = {0};
            add(&l, 20, 50);
            add(&l, 140, 50);
            add(&l, 20, 50 + gap);
            const line made = made_of(*state, &l, (camber_stroke){.width_px = 2, .offset_px = (float)(6 * sign)});
            double least = DBL_MAX, most = 0, length = 0, right = 0;
            for (size_t i = 0; i < made.count; i++) {
                const double d = distance_to_line(&l, made.points[2 * i], made.points[2 * i + 1]);
                least = fmin(least, d);
                most = fmax(most, d);
                right = fmax(right, made.points[2 * i]);
                if (i > 0)
                    length += hypot(made.points[2 * i] - made.points[2 * i - 2],
                                    made.points[2 * i + 1] - made.points[2 * i - 1]);
            }
            assert_true(most <= 6.13 && made.count >= 2);
            if (sign < 0 || gap < 1.6) { /* outside: around the end */
                assert_true(right > 145.9 && least > 5.9 - gap);
                assert_true(length > 2 * 119 + 6 * SCENE_PI - 1 && length < 2 * 121 + 6 * SCENE_PI + 1);
            } else { /* inside: there, across, and back */
                assert_true(right < 140 && length < 2 * 120 + 13);
            }
        }
}

/* Miters to their limit, then bevels. */
static void test_joins(void **state) {
    for (int degree = 5; degree <= 170; degree += 5) {
        const double angle = degree * SCENE_PI / 180, tip = 6 / cos(angle / 2);
        line l = {0};
        add(&l, 20, 50);
        add(&l, 120, 50);
        add(&l, 120 + 100 * cos(angle), 50 + 100 * sin(angle));
        const camber_stroke miter = {2, CAMBER_JOIN_MITER, CAMBER_CAP_BUTT, 2.5f, -6};
        const camber_stroke bevel = {2, CAMBER_JOIN_BEVEL, CAMBER_CAP_BUTT, 2.5f, -6};
        const line mitered = made_of(*state, &l, miter), beveled = made_of(*state, &l, bevel);
        const bool gentle = tip <= 6.125, within = 1 / cos(angle / 2) <= 2.5;
        assert_int_equal(beveled.count, gentle ? 3 : 4);
        assert_int_equal(mitered.count, gentle || within ? 3 : 4);
        if (mitered.count == 3)
            assert_true(fabs(hypot(mitered.points[2] - 120, mitered.points[3] - 50) - tip) < 1e-3);
    }
}

/* No point lies farther than the offset, and rings begin where they end, whatever the line. */
static void test_walks(void **state) {
    fixture *b = *state;
    uint64_t seed = 77;
    for (int n = 0; n < 400; n++) {
        static line l;
        l.count = 0;
        const double turn = camber_random_between(&seed, 0.1, SCENE_PI),
                     longest = camber_random_between(&seed, 0.5, 30);
        const size_t count = 2 + camber_random_below(&seed, 60);
        double x = 200, y = 200, direction = 0;
        for (size_t i = 0; i < count; i++) {
            add(&l, (double)(float)x, (double)(float)y);
            direction += camber_random_between(&seed, -turn, turn);
            const double step = camber_random_between(&seed, 0.05, longest);
            x += step * cos(direction);
            y += step * sin(direction);
        }
        if (n % 3 == 0 && count > 3)
            add(&l, l.points[0], l.points[1]);
        const double offset = camber_random_between(&seed, -25, 25);
        const line made = made_of(b, &l, (camber_stroke){.width_px = 2, .offset_px = (float)offset});
        for (size_t i = 0; i < made.count; i++) {
            const double d = distance_to_line(&l, made.points[2 * i], made.points[2 * i + 1]);
            if (d > fabs(offset) + 0.13)
                fail_msg("walk %d, offset %g: point %zu lies %g away", n, offset, i, d);
            if (i > 0)
                assert_true(made.points[2 * i] != made.points[2 * i - 2] ||
                            made.points[2 * i + 1] != made.points[2 * i - 1]);
        }
    }
}

/* ---- Device and twin ---- */

static void offset_strokes(camber_stroke strokes[CAMBER_KERNEL_ROWS]) {
    static const float offsets[] = {6, -6, 0, 0.4f, -25, 3, 140, -3, 12};
    scene_strokes(strokes);
    for (size_t i = 0; i < CAMBER_KERNEL_ROWS; i++)
        strokes[i].offset_px = offsets[i];
}

static void assert_same(const camber_mesh_data *a, const camber_mesh_data *b) {
    assert_int_equal(a->info.record_count, b->info.record_count);
    assert_int_equal(a->info.index_count, b->info.index_count);
    for (size_t i = 0; i < a->info.record_count; i++)
        if (memcmp(a->records + i, b->records + i, sizeof *a->records) != 0)
            fail_msg("record %zu: %.9g, %.9g and %.9g, %.9g", i, (double)a->records[i].x, (double)a->records[i].y,
                     (double)b->records[i].x, (double)b->records[i].y);
    assert_int_equal(a->arc_lengths != NULL, b->arc_lengths != NULL);
    if (a->arc_lengths)
        assert_memory_equal(a->arc_lengths, b->arc_lengths, a->info.record_count * sizeof *a->arc_lengths);
    if (a->corners)
        assert_memory_equal(a->corners, b->corners, a->info.index_count * sizeof *a->corners);
}

static void compare(fixture *b, camber_mesh *mesh, const camber_polylines *polylines,
                    const camber_tessellation_desc *desc) {
    camber_mesh_data device, twin;
    camber_stages seen, wanted;
    assert_int_equal(camber_mesh_data_tessellate(b->context, polylines, desc, &twin), CAMBER_OK);
    assert_int_equal(camber_stages_tessellate(b->context, polylines, desc, &wanted), CAMBER_OK);
    assert_int_equal(camber_mesh_tessellate(mesh, polylines, desc), CAMBER_OK);
    assert_int_equal(camber_mesh_read(mesh, &device), CAMBER_OK);
    assert_int_equal(camber_mesh_read_stages(mesh, &seen), CAMBER_OK);
    assert_same(&twin, &device);
    assert_int_equal(seen.point_count, wanted.point_count);
    assert_memory_equal(seen.points, wanted.points, seen.point_count * sizeof *seen.points);
    camber_stages_destroy(&seen);
    camber_stages_destroy(&wanted);
    camber_mesh_data_destroy(&device);
    camber_mesh_data_destroy(&twin);
}

/* Every scene, as one part of work-groups of 256, and in parts of other ones. */
static void test_device_equals_twin(void **state) {
    fixture *b = *state;
    if (!b->rounds)
        skip();
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    camber_device *small = NULL;
    camber_mesh *mesh = NULL;
    const camber_device_desc parts = {.work_group_size = 64, .memory_bytes = 64 << 20};
    offset_strokes(strokes);
    assert_int_equal(camber_device_create(b->context, &parts, &small), CAMBER_OK);
    assert_int_equal(camber_mesh_create(small, NULL, &mesh), CAMBER_OK);
    for (size_t which = 0; which < CAMBER_KERNEL_SCENES; which++) {
        camber_made_scene s = scene_make(which);
        camber_polylines *polylines = scene_polylines(b->context, &s);
        for (int method = 0; method < 3; method++) {
            camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, (camber_method)method, 0, method != 1};
            compare(b, b->mesh, polylines, &desc);
            desc.has_arc_length = !desc.has_arc_length;
            compare(b, mesh, polylines, &desc);
        }
        camber_polylines_destroy(polylines);
        camber_made_scene_free(&s);
    }
    camber_mesh_destroy(mesh);
    camber_device_destroy(small);
}

/* A mesh whose buffers or memory are too small for one part: the same bytes. */
static void test_parts(void **state) {
    fixture *b = *state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    offset_strokes(strokes);
    camber_made_scene s = {0};
    uint64_t seed = 3;
    for (size_t i = 0; i < 600; i++) {
        camber_made_scene_walk(&s, &seed, 3 + camber_random_below(&seed, 90), (const double[]){0.3, 12}, 1.2);
        camber_made_scene_end(&s, i % CAMBER_KERNEL_ROWS);
    }
    static const camber_device_desc descs[] = {{.largest_buffer_bytes = 70000},
                                               {.memory_bytes = 700000},
                                               {.memory_bytes = 2 << 20},
                                               {.match = "opencl", .largest_buffer_bytes = 70000}};
    camber_polylines *polylines = scene_polylines(b->context, &s);
    const camber_tessellation_desc desc = {
        .strokes = strokes, .stroke_count = CAMBER_KERNEL_ROWS, .has_arc_length = true};
    for (size_t i = 0; i < sizeof descs / sizeof *descs; i++) {
        camber_device *device = NULL;
        camber_mesh *mesh = NULL;
        assert_int_equal(camber_device_create(b->context, descs + i, &device), CAMBER_OK);
        assert_int_equal(camber_mesh_create(device, NULL, &mesh), CAMBER_OK);
        for (int again = 0; again < 2; again++)
            compare(b, mesh, polylines, &desc);
        assert_true(camber_mesh_get_memory(mesh).parts > 1);
        const camber_device_memory memory = camber_device_get_memory(device);
        assert_true(!memory.allowed_bytes || memory.most_bytes <= memory.allowed_bytes);
        camber_mesh_destroy(mesh);
        assert_int_equal(camber_device_get_memory(device).held_bytes, 0);
        camber_device_destroy(device);
    }
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
}

/* With, without and with again: what has no offset is as if nothing had had one. */
static void test_in_turn(void **state) {
    fixture *b = *state;
    camber_stroke with[CAMBER_KERNEL_ROWS], without[CAMBER_KERNEL_ROWS];
    offset_strokes(with);
    scene_strokes(without);
    camber_made_scene s = scene_make(0);
    camber_polylines *polylines = scene_polylines(b->context, &s);
    for (int i = 0; i < 6; i++) {
        const camber_tessellation_desc desc = {i % 2 ? with : without, CAMBER_KERNEL_ROWS, CAMBER_METHOD_STRIP, 0,
                                               i > 2};
        compare(b, b->mesh, polylines, &desc);
        assert_int_equal(b->mesh->offset_rows != NULL, i % 2);
        assert_int_equal(b->mesh->parts[0].source_line.x != NULL, i % 2);
    }
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
}

/* Nothing is left of a line that lies inside a small bend: nothing is drawn, whatever the mesh had before. */
static void test_vanishes(void **state) {
    fixture *b = *state;
    line l = {0};
    add(&l, 13.49f, 93.51f);
    add(&l, 18.53f, 88.48f);
    add(&l, 23.56f, 93.51f);
    add(&l, 18.53f, 98.55f);
    camber_polylines *polylines = polylines_of(b, &l);
    size_t vanished = 0;
    for (int i = 0; i < 12; i++) {
        const camber_stroke stroke = {.width_px = 5, .offset_px = i % 3 ? (i % 3 == 1 ? 6 : -6) : 0};
        const camber_tessellation_desc desc = {&stroke, 1, (camber_method)(i / 4), 0, false};
        compare(b, b->mesh, polylines, &desc);
        vanished += camber_mesh_get_info(b->mesh).record_count == 0;
    }
    assert_true(vanished > 0);
    camber_polylines_destroy(polylines);
}

/* ---- Networks ---- */

typedef struct world {
    double *points;
    size_t *offsets;
    size_t count;
    camber_network_entry *entries;
    camber_network *network;
} world;

static world world_of(fixture *b, const camber_made_scene *s) {
    world w = {.points = malloc(2 * s->point_count * sizeof *w.points),
               .offsets = malloc((s->polyline_count + 1) * sizeof *w.offsets),
               .entries = malloc(s->polyline_count * sizeof *w.entries),
               .count = s->polyline_count};
    assert_true(w.points && w.offsets && w.entries);
    for (size_t i = 0; i < 2 * s->point_count; i++)
        w.points[i] = (double)s->points[i];
    for (size_t i = 0; i <= s->polyline_count; i++)
        w.offsets[i] = s->offsets[i];
    for (size_t i = 0; i < s->polyline_count; i++)
        w.entries[i] = (camber_network_entry){.polyline = (uint32_t)i, .row = s->rows[i]};
    const camber_network_desc desc = {.points = w.points,
                                      .offsets = w.offsets,
                                      .polyline_count = w.count,
                                      .entries = w.entries,
                                      .entry_count = w.count,
                                      .has_arc_length = true};
    assert_int_equal(camber_network_create(b->context, &desc, &w.network), CAMBER_OK);
    return w;
}

static void world_free(world *w) {
    camber_network_destroy(w->network);
    free(w->entries);
    free(w->offsets);
    free(w->points);
}

static camber_stages seen_by(fixture *b, const world *w, const camber_camera *camera,
                             const camber_tessellation_desc *desc) {
    camber_polylines *seen = NULL;
    camber_stages stages = {0}, device = {0};
    assert_int_equal(camber_network_project(w->network, camera, desc, &seen), CAMBER_OK);
    assert_int_equal(camber_stages_tessellate(b->context, seen, desc, &stages), CAMBER_OK);
    if (b->rounds) {
        assert_int_equal(camber_mesh_tessellate_network(b->mesh, w->network, camera, desc), CAMBER_OK);
        assert_int_equal(camber_mesh_read_stages(b->mesh, &device), CAMBER_OK);
        assert_int_equal(device.point_count, stages.point_count);
        assert_memory_equal(device.points, stages.points, device.point_count * sizeof *device.points);
        camber_stages_destroy(&device);
    }
    camber_polylines_destroy(seen);
    return stages;
}

/* Rings and walks about the middle. */
static camber_made_scene make_streets(void) {
    camber_made_scene s = {0};
    uint64_t seed = 11;
    for (size_t i = 0; i < 120; i++) {
        camber_made_scene_walk(&s, &seed, 5 + camber_random_below(&seed, 60), (const double[]){1, 25},
                               i % 2 ? 0.7 : 2.5);
        camber_made_scene_end(&s, i % CAMBER_KERNEL_ROWS);
    }
    for (size_t i = 0; i < 60; i++) {
        const size_t sides = 4 + camber_random_below(&seed, 30), first = s.point_count;
        const double x = camber_random_between(&seed, 0, 1000), y = camber_random_between(&seed, 0, 1000);
        const double radius = camber_random_between(&seed, 5, 150);
        for (size_t k = 0; k < sides; k++)
            camber_made_scene_point(&s, x + radius * cos(2 * SCENE_PI * (double)k / (double)sides),
                                    y + radius * sin(2 * SCENE_PI * (double)k / (double)sides));
        camber_made_scene_point(&s, (double)s.points[2 * first], (double)s.points[2 * first + 1]);
        camber_made_scene_end(&s, i % CAMBER_KERNEL_ROWS);
    }
    return s;
}

/* Windows do not move a point: what a small picture shows lies where a large one has it. */
static void test_windows(void **state) {
    fixture *b = *state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    offset_strokes(strokes);
    for (size_t i = 0; i < CAMBER_KERNEL_ROWS; i++) {
        strokes[i].width_px = 3;
        strokes[i].miter_limit = 2;
        strokes[i].offset_px = i == 6 ? 18 : strokes[i].offset_px; /* farther out rounding is seen */
    }
    camber_made_scene s = make_streets();
    world w = world_of(b, &s);
    const camber_tessellation_desc desc = {
        .strokes = strokes, .stroke_count = CAMBER_KERNEL_ROWS, .has_arc_length = true};
    const camber_camera whole = {.x = 500, .y = 500, .scale_px = 1, .width = 6000, .height = 6000};
    camber_stages all = seen_by(b, &w, &whole, &desc);
    size_t compared = 0;
    for (int k = 0; k < 9; k++) {
        const double x = 250 + 250 * (k % 3), y = 250 + 250 * (k / 3);
        const camber_camera part = {.x = x, .y = y, .scale_px = 1, .width = 160, .height = 120};
        camber_stages few = seen_by(b, &w, &part, &desc);
        assert_true(few.point_count < all.point_count);
        size_t at = 0, inside[2] = {0, 0};
        for (size_t i = 0; i < all.point_count; i++) {
            const double px = (double)all.points[i].x - 3000 + 500 - x + 80,
                         py = (double)all.points[i].y - 3000 + 500 - y + 60;
            inside[0] += px > 0.01 && py > 0.01 && px < 159.99 && py < 119.99;
            if (!(px > 0.01 && py > 0.01 && px < 159.99 && py < 119.99))
                continue;
            while (at < few.point_count &&
                   !(few.points[at].polyline == all.points[i].polyline && fabs((double)few.points[at].x - px) < 5e-3 &&
                     fabs((double)few.points[at].y - py) < 5e-3))
                at++;
            if (at == few.point_count)
                fail_msg("camera %d: point %zu of polyline %u at %g, %g is not there", k, i, all.points[i].polyline, px,
                         py);
        }
        for (size_t i = 0; i < few.point_count; i++)
            inside[1] += few.points[i].x > 0.01f && few.points[i].y > 0.01f && few.points[i].x < 159.99f &&
                         few.points[i].y < 119.99f;
        assert_int_equal(inside[0], inside[1]);
        compared += inside[0];
        camber_stages_destroy(&few);
    }
    assert_true(compared > 500);
    camber_stages_destroy(&all);
    world_free(&w);
    camber_made_scene_free(&s);
}

/* A ring that a window cuts: its seam stays a join, and both pieces have the same point there. */
static void test_cut_rings(void **state) {
    fixture *b = *state;
    for (int k = 0; k < 24; k++) {
        const double angle = k * SCENE_PI / 12;
        camber_made_scene s = {0};
        for (int i = 0; i < 36; i++)
            camber_made_scene_point(&s, 500 + 400 * cos(angle + i * SCENE_PI / 18),
                                    500 + 400 * sin(angle + i * SCENE_PI / 18));
        camber_made_scene_point(&s, (double)s.points[0], (double)s.points[1]);
        camber_made_scene_end(&s, 0);
        world w = world_of(b, &s);
        const camber_stroke stroke = {.width_px = 4, .offset_px = k % 2 ? 7 : -7};
        const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1};
        const camber_camera camera = {
            .x = (double)s.points[0], .y = (double)s.points[1], .scale_px = 1, .width = 90, .height = 90};
        camber_stages stages = seen_by(b, &w, &camera, &desc);
        const camber_point_stages *p = stages.points;
        assert_true(stages.point_count > 3);
        assert_true(p[0].x == p[stages.point_count - 1].x && p[0].y == p[stages.point_count - 1].y);
        assert_int_equal(p[0].join & 0xffffu, p[stages.point_count - 1].join & 0xffffu);
        assert_true((p[0].join >> 28) >= 3);
        camber_stages_destroy(&stages);
        world_free(&w);
        camber_made_scene_free(&s);
    }
}

/* ---- Measures and arguments ---- */

/* Along a line beside, what is measured is the line: it grows from 0 to all of it. */
static void test_arc_length(void **state) {
    fixture *b = *state;
    line l = {0};
    add(&l, 10, 10);
    add(&l, 110, 10);
    add(&l, 110, 60);
    add(&l, 30, 90);
    for (int sign = -1; sign < 2; sign += 2) {
        const double total = 150 + hypot(80, 30);
        const camber_stroke stroke = {.width_px = 3, .offset_px = (float)(6 * sign)};
        const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1, .has_arc_length = true};
        camber_polylines *polylines = polylines_of(b, &l);
        camber_mesh_data data;
        assert_int_equal(camber_mesh_data_tessellate(b->context, polylines, &desc, &data), CAMBER_OK);
        double before = 0;
        for (size_t i = 0; i < data.info.record_count; i++) {
            const camber_arc_length m = data.arc_lengths[i];
            assert_true(fabs((double)m.total_px - total) < 0.01);
            assert_true((double)m.along_px >= before - 1e-3 && (double)m.along_px <= total + 1e-3);
            before = (double)m.along_px;
            const double x = (double)data.records[i].x, y = (double)data.records[i].y;
            if (fabs(y - (10 + 6 * sign)) < 1e-3 && x < 100)
                assert_true(fabs((double)m.along_px - (x - 10)) < 0.01 || data.records[i].last & 16);
        }
        assert_true(fabs(before - total) < 0.01);
        camber_mesh_data_destroy(&data);
        camber_polylines_destroy(polylines);
    }
}

static void test_arguments(void **state) {
    fixture *b = *state;
    static const float wrong[] = {NAN, INFINITY, -INFINITY, 16385, -16385};
    line l = {0};
    add(&l, 10, 10);
    add(&l, 110, 10);
    camber_polylines *polylines = polylines_of(b, &l);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const camber_stroke stroke = {.width_px = 3, .offset_px = wrong[i]};
        const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1};
        camber_mesh_data data;
        assert_int_equal(camber_mesh_data_tessellate(b->context, polylines, &desc, &data), CAMBER_ERROR_ARGUMENT);
        assert_story(&b->h, "offset");
        assert_int_equal(camber_mesh_tessellate(b->mesh, polylines, &desc), CAMBER_ERROR_ARGUMENT);
        assert_story(&b->h, "offset");
    }
    camber_polylines_destroy(polylines);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bends),        cmocka_unit_test(test_curves),
        cmocka_unit_test(test_small_shapes), cmocka_unit_test(test_rings),
        cmocka_unit_test(test_hairpins),     cmocka_unit_test(test_joins),
        cmocka_unit_test(test_walks),        cmocka_unit_test(test_device_equals_twin),
        cmocka_unit_test(test_parts),        cmocka_unit_test(test_in_turn),
        cmocka_unit_test(test_windows),      cmocka_unit_test(test_cut_rings),
        cmocka_unit_test(test_arc_length),   cmocka_unit_test(test_arguments),
        cmocka_unit_test(test_vanishes),
    };
    return cmocka_run_group_tests(tests, fixture_set_up_mesh, fixture_tear_down);
}
