/* Meshes as geometry: what the public header says of vertices, held against double precision. The twin makes them;
 * test_tessellate shows that the device gives the same bytes. */
#include "scene.h"

#include "vertices/vertices.h"

typedef struct place {
    double x, y;
} place;

/* camber_vertex's formula, at the width that the stroke was tessellated for. */
static place position(const camber_vertex *v, const camber_stroke *strokes) {
    const double reach = 0.5 * (double)strokes[v->row].width_px + 0.75;
    const double length = hypot(v->dx, v->dy), limit = v->limit_px;
    const double ux = length > 0 ? v->dx / length : 1, uy = length > 0 ? v->dy / length : 0;
    const double along = fmax(fmin(v->along * reach, limit), -limit), across = v->across / 16384.0 * reach;
    return (place){v->x + ux * along - uy * across, v->y + uy * along + ux * across};
}

/* Twice the signed area. */
static double area2(place a, place b, place c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static camber_mesh_data tessellate(camber_context *context, const camber_polylines *polylines,
                                   const camber_stroke *strokes, camber_method method) {
    camber_mesh_data data;
    const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, method, 0, false};
    assert_int_equal(camber_mesh_data_tessellate(context, polylines, &desc, &data), CAMBER_OK);
    return data;
}

/* ---- True of any mesh ---- */

static bool is_near(float a, double b, double scale) {
    return fabs(a - b) <= 1e-6 * (fabs(b) + scale) + 1e-30;
}

/* The vertex that a triangle ends with carries the segment: every vertex of the triangle lies at an end of it. */
static void check_provoking(const camber_mesh_data *mesh, const uint32_t triangle[3]) {
    const camber_vertex *last = mesh->vertices + triangle[2];
    const bool at_end = last->flags & 64u;
    const double ax = at_end ? (double)last->x - last->dx : last->x, ay = at_end ? (double)last->y - last->dy : last->y;
    const double bx = ax + last->dx, by = ay + last->dy, scale = fabs(last->dx) + fabs(last->dy) + fabs(ax) + fabs(ay);
    for (int i = 0; i < 3; i++) {
        const camber_vertex *v = mesh->vertices + triangle[i];
        const bool at_a = is_near(v->x, ax, scale) && is_near(v->y, ay, scale);
        const bool at_b = is_near(v->x, bx, scale) && is_near(v->y, by, scale);
        assert_true(at_a || at_b);
        assert_int_equal(v->row, last->row);
    }
}

typedef void triangle_fn(const camber_mesh_data *mesh, const uint32_t triangle[3], void *user);

/* The triangles as GL draws them: strips turn every other one, and it keeps its last vertex. */
static size_t each_triangle(const camber_mesh_data *mesh, triangle_fn *fn, void *user) {
    size_t count = 0;
    if (!mesh->info.strips) {
        assert_int_equal(mesh->info.index_count % 3, 0);
        for (size_t i = 0; i < mesh->info.index_count; i += 3, count++)
            fn(mesh, mesh->indices + i, user);
        return count;
    }
    for (size_t i = 0; i < mesh->info.index_count; i++) {
        const uint32_t *at = mesh->indices + i;
        if (!camber_mesh_data_draws(mesh, i))
            continue;
        const uint32_t triangle[3] = {at[i % 2], at[1 - i % 2], at[2]};
        fn(mesh, triangle, user);
        count++;
    }
    /* The first strip is begun like any other: polylines can be drawn one by one or behind one another. */
    assert_true(mesh->info.index_count == 0 || mesh->indices[0] == CAMBER_RESTART_INDEX);
    return count;
}

static void check_triangle(const camber_mesh_data *mesh, const uint32_t triangle[3], void *user) {
    bool *used = user;
    for (int i = 0; i < 3; i++) {
        assert_true(triangle[i] < mesh->info.vertex_count);
        used[triangle[i]] = true;
    }
    assert_true(triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[0] != triangle[2]);
    check_provoking(mesh, triangle);
}

static void check_mesh(const camber_mesh_data *mesh, size_t row_count) {
    bool *used = calloc(mesh->info.vertex_count + 1, sizeof *used);
    assert_non_null(used);
    for (size_t i = 0; i < mesh->info.vertex_count; i++) {
        const camber_vertex *v = mesh->vertices + i;
        assert_true(isfinite(v->x) && isfinite(v->y) && isfinite(v->dx) && isfinite(v->dy) && isfinite(v->along));
        assert_true(v->limit_px >= 0.0f && v->limit_px <= 3.0e38f);
        assert_true(abs(v->across) <= 2 * 16384 && v->flags < 512 && v->row < row_count);
        assert_true(abs(v->turn_a) <= 32767 && abs(v->turn_b) <= 32767);
    }
    assert_int_equal(each_triangle(mesh, check_triangle, used), mesh->info.triangle_count);
    size_t unused = 0;
    for (size_t i = 0; i < mesh->info.vertex_count; i++)
        unused += !used[i];
    assert_int_equal(unused, 0);
    free(used);
}

static void test_any_mesh(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    for (size_t which = 0; which < CAMBER_KERNEL_SCENES; which++) {
        camber_made_scene s = scene_make(which);
        camber_polylines *polylines = scene_polylines(context, &s);
        for (int method = 0; method < 3; method++) {
            camber_mesh_data mesh = tessellate(context, polylines, strokes, (camber_method)method);
            assert_int_equal(mesh.info.strips, method == CAMBER_METHOD_STRIP);
            check_mesh(&mesh, CAMBER_KERNEL_ROWS);
            camber_mesh_data_destroy(&mesh);
        }
        camber_polylines_destroy(polylines);
        camber_made_scene_free(&s);
    }
    host_done(&h, context);
}

/* Input order: the mesh of the first polylines is the beginning of the mesh of all. */
static void test_input_order(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    for (size_t which = 0; which < CAMBER_KERNEL_SCENES; which++) {
        camber_made_scene s = scene_make(which);
        camber_polylines *polylines = scene_polylines(context, &s);
        for (int method = 0; method < 3; method++) {
            camber_mesh_data all = tessellate(context, polylines, strokes, (camber_method)method);
            for (size_t n = 0; n < s.polyline_count; n += 1 + s.polyline_count / 7) {
                camber_polylines *some = scene_first(context, &s, n, false);
                camber_mesh_data first = tessellate(context, some, strokes, (camber_method)method);
                assert_memory_equal(all.vertices, first.vertices, first.info.vertex_count * sizeof *all.vertices);
                assert_memory_equal(all.indices, first.indices, first.info.index_count * sizeof *all.indices);
                camber_mesh_data_destroy(&first);
                camber_polylines_destroy(some);
            }
            camber_mesh_data_destroy(&all);
        }
        camber_polylines_destroy(polylines);
        camber_made_scene_free(&s);
    }
    host_done(&h, context);
}

/* ---- Counts of joins ---- */

typedef struct join_counts {
    size_t joins, tight, split, unsure;
} join_counts;

/* One join by the header's words: tight where (h + pad) tan(t/2) > half the shorter neighbour, split past 127 degrees.
 */
static void count_join(const camber_polylines *p, size_t i, const camber_stroke *stroke, join_counts *counts) {
    const double dx = (double)p->x[i] - p->x[i - 1], dy = (double)p->y[i] - p->y[i - 1];
    const double ex = (double)p->x[i + 1] - p->x[i], ey = (double)p->y[i + 1] - p->y[i];
    const double t = fabs(atan2(dx * ey - dy * ex, dx * ex + dy * ey)), tan_half = tan(fmin(t, SCENE_PI - 1e-12) / 2);
    const double room = 0.5 * fmin(hypot(dx, dy), hypot(ex, ey));
    const double wanted = (0.5 * (double)stroke->width_px + 0.75) * tan_half;
    const double limit = stroke->miter_limit > 0 ? (double)stroke->miter_limit : 2;
    const bool miter = stroke->join == CAMBER_JOIN_MITER && 1 / cos(fmin(t, SCENE_PI - 1e-12) / 2) <= limit;
    const bool split = tan_half > 2 && !miter;
    counts->joins++;
    counts->split += split;
    counts->tight += !split && wanted > room;
    counts->unsure += fabs(wanted - room) < 1e-4 * room || fabs(tan_half - 2) < 1e-4 || t > 179.9 * SCENE_PI / 180 ||
                      (tan_half > 1.9 && fabs(1 / cos(t / 2) - limit) < 1e-4 * limit);
}

static void test_join_counts(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    size_t kinds[3] = {0};
    for (size_t which = 0; which < 4; which++) {
        camber_made_scene s = scene_make(which);
        camber_polylines *p = scene_polylines(context, &s);
        join_counts counts = {0};
        size_t undrawn = 0;
        for (size_t i = 1; i <= p->slot_count; i++) {
            const uint32_t info = p->info[i];
            const bool first = info & CAMBER_POINT_FIRST, last = info & CAMBER_POINT_LAST;
            const camber_stroke *stroke = strokes + (info >> CAMBER_POINT_ROW_SHIFT);
            undrawn += first && last && stroke->cap == CAMBER_CAP_BUTT;
            if (info & CAMBER_POINT_REAL && !first && (!last || info & CAMBER_POINT_RING))
                count_join(p, i, stroke, &counts);
        }
        for (int method = 0; method < 3; method++) {
            camber_mesh_data mesh = tessellate(context, p, strokes, (camber_method)method);
            assert_int_equal(mesh.info.joins, counts.joins);
            assert_int_equal(mesh.info.undrawn_dots, undrawn);
            assert_true(llabs((long long)mesh.info.tight_joins - (long long)counts.tight) <= (long long)counts.unsure);
            assert_true(llabs((long long)mesh.info.split_joins - (long long)counts.split) <= (long long)counts.unsure);
            camber_mesh_data_destroy(&mesh);
        }
        if (which != 3) /* there a third are exact reversals */
            assert_true(counts.unsure < 10 + counts.joins / 200);
        kinds[0] += counts.joins - counts.tight - counts.split;
        kinds[1] += counts.tight;
        kinds[2] += counts.split;
        camber_polylines_destroy(p);
        camber_made_scene_free(&s);
    }
    assert_true(kinds[0] > 100 && kinds[1] > 100 && kinds[2] > 100);
    host_done(&h, context);
}

/* ---- Places ---- */

/* Lines whose joins all have room: segments far longer than the widths, turns below 127 degrees. */
static camber_made_scene roomy_scene(void) {
    camber_made_scene s = {0};
    uint64_t seed = 31;
    for (size_t i = 0; i < 90; i++) {
        camber_made_scene_walk(&s, &seed, 2 + i % 20, (const double[]){150, 300}, 2.15);
        camber_made_scene_end(&s, i % 6); /* rows up to 8 px */
    }
    return s;
}

typedef struct winding {
    const camber_stroke *strokes;
    size_t backward, flat;
} winding;

static void check_winding(const camber_mesh_data *mesh, const uint32_t triangle[3], void *user) {
    winding *w = user;
    place p[3];
    double longest = 0;
    for (int i = 0; i < 3; i++)
        p[i] = position(mesh->vertices + triangle[i], w->strokes);
    for (int i = 0; i < 3; i++)
        longest = fmax(longest, hypot(p[i].x - p[(i + 1) % 3].x, p[i].y - p[(i + 1) % 3].y));
    const double a = area2(p[0], p[1], p[2]);
    /* A line towards +x has its left edge at +y: left, right, left of the end has a positive area. */
    w->backward += a < -1e-3 * longest;
    w->flat += fabs(a) <= 1e-3 * longest;
}

static void test_winding(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    camber_made_scene s = roomy_scene();
    camber_polylines *polylines = scene_polylines(context, &s);
    for (int method = 0; method < 3; method++) {
        camber_mesh_data mesh = tessellate(context, polylines, strokes, (camber_method)method);
        assert_int_equal(mesh.info.tight_joins + mesh.info.split_joins, 0);
        winding w = {strokes, 0, 0};
        const size_t count = each_triangle(&mesh, check_winding, &w);
        assert_int_equal(w.backward, 0);
        assert_true(w.flat < count / 50); /* joins that hardly turn */
        camber_mesh_data_destroy(&mesh);
    }
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
    host_done(&h, context);
}

/* A strip without tight joins has two vertices a point, and both lie on the bisector: as far from the line of the
 * segment in as from that of the segment out, half the width and the pad. */
static void test_two_vertices_a_point(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    camber_made_scene s = roomy_scene();
    camber_polylines *p = scene_polylines(context, &s);
    camber_mesh_data mesh = tessellate(context, p, strokes, CAMBER_METHOD_STRIP);
    assert_int_equal(mesh.info.vertex_count, 2 * camber_polylines_get_stats(p).kept_points);
    assert_int_equal(mesh.info.index_count, 2 * camber_polylines_get_stats(p).kept_points + 2 * s.polyline_count);
    assert_int_equal(mesh.info.triangle_count, 2 * camber_polylines_get_stats(p).kept_segments);
    for (size_t i = 1; i <= s.point_count; i++) {
        if (p->info[i] & (CAMBER_POINT_FIRST | CAMBER_POINT_LAST))
            continue;
        for (size_t k = 2 * (i - 1); k < 2 * i; k++) {
            const camber_vertex *v = mesh.vertices + k;
            const double reach = 0.5 * (double)strokes[v->row].width_px + 0.75;
            const place at = position(v, strokes);
            for (size_t j = i - 1; j <= i; j++) {
                const double dx = (double)p->x[j + 1] - p->x[j], dy = (double)p->y[j + 1] - p->y[j];
                const double off = (dx * (at.y - p->y[i]) - dy * (at.x - p->x[i])) / hypot(dx, dy);
                assert_true(fabs(off - (k % 2 ? -reach : reach)) < 1e-3 * reach); /* turns have 16 bits */
            }
        }
    }
    camber_mesh_data_destroy(&mesh);
    camber_polylines_destroy(p);
    camber_made_scene_free(&s);
    host_done(&h, context);
}

/* Every vertex of a has its like in b. */
static void assert_same_places(const camber_mesh_data *a, const camber_mesh_data *b, const camber_stroke *strokes) {
    assert_int_equal(a->info.vertex_count, b->info.vertex_count);
    assert_int_equal(a->info.index_count, b->info.index_count);
    bool *taken = calloc(b->info.vertex_count, sizeof *taken);
    assert_non_null(taken);
    for (size_t i = 0; i < a->info.vertex_count; i++) {
        const place at = position(a->vertices + i, strokes);
        size_t best = 0;
        double nearest = INFINITY;
        for (size_t k = 0; k < b->info.vertex_count; k++) {
            const place other = position(b->vertices + k, strokes);
            const double distance = hypot(at.x - other.x, at.y - other.y);
            if (!taken[k] && distance < nearest) {
                nearest = distance;
                best = k;
            }
        }
        const double reach = 0.5 * (double)strokes[a->vertices[i].row].width_px + 0.75;
        if (!(nearest <= 2e-3 * reach))
            fail_msg("vertex %zu of %zu has no like nearer than %g px", i, a->info.vertex_count, nearest);
        taken[best] = true;
    }
    free(taken);
}

/* A line drawn backwards is the same geometry, tight and split joins among it. */
static void test_reversed_line(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    uint64_t seed = 6;
    for (size_t round = 0; round < 60; round++) {
        camber_made_scene s = {0}, reversed = {0};
        camber_made_scene_walk(&s, &seed, 2 + round % 25, (const double[]){1, 60}, round % 2 ? 1 : 3);
        camber_made_scene_end(&s, round % 8);
        for (size_t i = s.point_count; i > 0; i--)
            camber_made_scene_point(&reversed, (double)s.points[2 * i - 2], (double)s.points[2 * i - 1]);
        camber_made_scene_end(&reversed, round % 8);
        camber_polylines *p = scene_polylines(context, &s), *r = scene_polylines(context, &reversed);
        for (int method = 0; method < 2; method++) { /* a fan's last step is shorter than its first */
            camber_mesh_data a = tessellate(context, p, strokes, (camber_method)method);
            camber_mesh_data b = tessellate(context, r, strokes, (camber_method)method);
            assert_int_equal(a.info.tight_joins, b.info.tight_joins);
            assert_int_equal(a.info.split_joins, b.info.split_joins);
            assert_same_places(&a, &b, strokes);
            camber_mesh_data_destroy(&a);
            camber_mesh_data_destroy(&b);
        }
        camber_polylines_destroy(r);
        camber_polylines_destroy(p);
        camber_made_scene_free(&reversed);
        camber_made_scene_free(&s);
    }
    host_done(&h, context);
}

/* A fan's outer vertices lie outside of the arc and its chords no farther than the tolerance from it. */
static void test_fan_tolerance(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const float tolerances[] = {0.0f, 0.05f, 0.25f, 1.0f};
    camber_made_scene s = {0};
    camber_made_scene_point(&s, 0, 0);
    camber_made_scene_point(&s, 1000, 0);
    camber_made_scene_point(&s, 1000, 1000);
    camber_made_scene_end(&s, 0);
    camber_polylines *p = scene_polylines(context, &s);
    for (size_t i = 0; i < 4; i++) {
        const camber_stroke stroke = {60, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
        camber_mesh_data mesh;
        assert_int_equal(
            camber_mesh_data_tessellate(
                context, p, &(camber_tessellation_desc){&stroke, 1, CAMBER_METHOD_FAN, tolerances[i], false}, &mesh),
            CAMBER_OK);
        const double reach = 30.75, tolerance = tolerances[i] > 0 ? (double)tolerances[i] : 0.25;
        const double triangles = ceil(SCENE_PI / 2 / (2 * acos(1 - tolerance / reach)));
        /* The start's L, R; P, the end's L, R, the start's L, R, and chords; the end's L, R. */
        assert_int_equal(mesh.info.vertex_count, 2 + 2 + (size_t)triangles - 1 + 1 + 2 + 2);
        for (size_t k = 7; k < 7 + (size_t)triangles - 1; k++) {
            const place at = position(mesh.vertices + k, &stroke);
            const double radius = hypot(at.x - 1000, at.y);
            assert_true(radius > reach - 1e-3 && radius < reach + 1.1 * tolerance);
            assert_true(at.x >= 1000 && at.y <= 0);
        }
        camber_mesh_data_destroy(&mesh);
    }
    camber_polylines_destroy(p);
    camber_made_scene_free(&s);
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_mesh),
        cmocka_unit_test(test_input_order),
        cmocka_unit_test(test_join_counts),
        cmocka_unit_test(test_winding),
        cmocka_unit_test(test_two_vertices_a_point),
        cmocka_unit_test(test_reversed_line),
        cmocka_unit_test(test_fan_tolerance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
