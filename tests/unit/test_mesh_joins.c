/* The joins that proofs find in a mesh against those that its tessellation counted, and against joins by hand. */
#include "scene.h"

#include "validate/mesh_joins.h"

typedef struct found {
    camber_mesh_data mesh;
    camber_mesh_joins joins;
    size_t rooms[CAMBER_JOIN_ROOMS], seams;
} found;

static found find(camber_context *context, const camber_made_scene *lines, const camber_stroke *strokes,
                  camber_method method) {
    found f = {0};
    camber_polylines *polylines = scene_polylines(context, lines);
    const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, method, 0, false};
    assert_int_equal(camber_mesh_data_tessellate(context, polylines, &desc, &f.mesh), CAMBER_OK);
    assert_true(camber_mesh_joins_find(&f.mesh, strokes, &f.joins));
    for (size_t i = 0; i < f.joins.count; i++) {
        f.rooms[f.joins.items[i].room]++;
        f.seams += f.joins.items[i].seam;
    }
    camber_polylines_destroy(polylines);
    return f;
}

static void forget(found *f) {
    camber_mesh_joins_free(&f->joins);
    camber_mesh_data_destroy(&f->mesh);
}

/* How many segments the triangles of a range carry, by where they end, one after the other. */
static size_t segments_in(const camber_mesh_data *mesh, camber_index_range range) {
    size_t count = 0;
    float end_x = 0, end_y = 0;
    for (uint64_t i = range.first_index + 2; i < range.first_index + range.index_count; i++) {
        const uint32_t *k = mesh->indices + i;
        if (!camber_mesh_data_draws(mesh, i - 2))
            continue;
        const camber_vertex *v = mesh->vertices + k[0];
        const float far = v->flags >> 6 & 1 ? 0.0f : 1.0f;
        const float x = v->x + far * v->dx, y = v->y + far * v->dy;
        count += count == 0 || hypotf(x - end_x, y - end_y) > 0.25f * hypotf(v->dx, v->dy);
        end_x = x;
        end_y = y;
    }
    return count;
}

/* On every made up scene but that of sizes beyond a map's, where products overflow. */
static void test_counts(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    for (size_t which = 0; which + 1 < CAMBER_KERNEL_SCENES; which++) {
        camber_made_scene lines = scene_make(which);
        size_t seams = 0;
        for (int method = CAMBER_METHOD_FAN; method >= 0; method--) {
            found f = find(context, &lines, strokes, (camber_method)method);
            const camber_mesh_info *info = &f.mesh.info;
            if (method != CAMBER_METHOD_STRIP) {
                seams = f.seams;
                /* A straight seam has no triangles of its own: there are few, among the degenerate. */
                assert_in_range(info->joins, f.joins.count, f.joins.count + (which == 4 ? 4 : 0));
                /* Where either may be right, few. */
                assert_in_range(f.rooms[CAMBER_JOIN_TIGHT] + 8, info->tight_joins, info->tight_joins + 16);
                assert_in_range(f.rooms[CAMBER_JOIN_SPLIT] + 2, info->split_joins, info->split_joins + 4);
            } else {
                assert_int_equal(f.seams, 0);
                assert_in_range(info->joins, f.joins.count + seams, f.joins.count + seams + (which == 4 ? 4 : 0));
            }
            printf("scene %zu %-5s joins %6zu of %6zu  plain %5zu tight %5zu of %5zu split %5zu of %5zu seams %zu\n",
                   which, camber_method_get_name((camber_method)method), f.joins.count, info->joins, f.rooms[0],
                   f.rooms[1], info->tight_joins, f.rooms[2], info->split_joins, f.seams);
            forget(&f);
        }
        camber_made_scene_free(&lines);
    }
    host_done(&h, context);
}

static void test_ranges(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    for (size_t which = 0; which < 4; which++) {
        camber_made_scene lines = scene_make(which);
        for (int method = 0; method < 3; method++) {
            found f = find(context, &lines, strokes, (camber_method)method);
            for (size_t i = 0; i < f.joins.count; i++) {
                const camber_index_range r = f.joins.items[i].range;
                assert_true(r.first_index + r.index_count <= f.mesh.info.index_count);
                assert_int_equal(segments_in(&f.mesh, r), 2);
            }
            forget(&f);
        }
        camber_made_scene_free(&lines);
    }
    host_done(&h, context);
}

static void test_by_hand(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_stroke strokes[CAMBER_KERNEL_ROWS] = {{.width_px = 8.5f}}; /* reach 5 */
    for (int method = 0; method < 3; method++) {
        camber_made_scene lines = {0};
        static const double points[][2] = {{0, 0}, {20, 0}, {20, 20}, {20, 10.5}, {10.5, 20}};
        for (int i = 0; i < 5; i++)
            camber_made_scene_point(&lines, points[i][0], points[i][1]);
        camber_made_scene_end(&lines, 0);
        camber_made_scene_point(&lines, 0, 0); /* equal to the first, and no join between the two */
        camber_made_scene_point(&lines, 20, 0);
        camber_made_scene_point(&lines, 20, 9.9);
        camber_made_scene_end(&lines, 0);
        camber_made_scene_point(&lines, 0, 0); /* exactly at the bound */
        camber_made_scene_point(&lines, 20, 0);
        camber_made_scene_point(&lines, 20, 10);
        camber_made_scene_end(&lines, 0);
        camber_made_scene_point(&lines, 60, 0); /* there, back, and there again: no ring */
        camber_made_scene_point(&lines, 90, 0);
        camber_made_scene_point(&lines, 60, 0);
        camber_made_scene_point(&lines, 90, 0);
        camber_made_scene_end(&lines, 0);
        camber_made_scene_point(&lines, 5, 5); /* a dot */
        camber_made_scene_end(&lines, 0);
        found f = find(context, &lines, strokes, (camber_method)method);
        static const camber_join_room rooms[] = {CAMBER_JOIN_PLAIN, CAMBER_JOIN_SPLIT, CAMBER_JOIN_SPLIT,
                                                 CAMBER_JOIN_TIGHT, CAMBER_JOIN_TIGHT, CAMBER_JOIN_SPLIT,
                                                 CAMBER_JOIN_SPLIT};
        static const double turns[] = {90, 180, 135, 90, 90, 180, 180};
        assert_int_equal(f.joins.count, 7);
        for (size_t i = 0; i < 7; i++) {
            assert_int_equal(f.joins.items[i].room, rooms[i]);
            assert_true(fabs(f.joins.items[i].turn_deg - turns[i]) < 1e-6);
            assert_true(!f.joins.items[i].seam);
        }
        assert_true(f.joins.items[2].x == 20 && f.joins.items[2].y == 10.5f);
        forget(&f);
        camber_made_scene_free(&lines);
    }
    host_done(&h, context);
}

/* A ring given twice: its first segment comes again behind its last, and between the two rings there is no join. */
static void test_rings(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_stroke strokes[CAMBER_KERNEL_ROWS] = {{.width_px = 4}};
    for (int method = 0; method < 3; method++) {
        camber_made_scene lines = {0};
        for (int ring = 0; ring < 2; ring++) {
            for (int i = 0; i <= 6; i++)
                camber_made_scene_point(&lines, 100 + 50 * cos(i % 6 * SCENE_PI / 3),
                                        100 + 50 * sin(i % 6 * SCENE_PI / 3));
            camber_made_scene_end(&lines, 0);
        }
        found f = find(context, &lines, strokes, (camber_method)method);
        const size_t seams = method == CAMBER_METHOD_STRIP ? 0 : 2;
        assert_int_equal(f.seams, seams);
        assert_int_equal(f.joins.count, 10 + seams);
        assert_int_equal(f.rooms[CAMBER_JOIN_PLAIN], f.joins.count);
        forget(&f);
        camber_made_scene_free(&lines);
    }
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_counts),
        cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_by_hand),
        cmocka_unit_test(test_rings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
