/* The results of classify and scan: the device against the twin's walk, and both against the mesh that came of it. */
#include "test_fixture.h"

#include "kernels/join.h"

/* The first point where two stages differ, in any field; the count of points where they do not. */
static size_t first_difference(const camber_stages *a, const camber_stages *b) {
    assert_int_equal(a->point_count, b->point_count);
    for (size_t i = 0; i < a->point_count; i++) {
        const camber_point_stages p = a->points[i], q = b->points[i];
        if (p.polyline != q.polyline || p.point != q.point || memcmp(&p.x, &q.x, 4) != 0 ||
            memcmp(&p.y, &q.y, 4) != 0 || p.join != q.join || p.first_vertex != q.first_vertex ||
            p.first_index != q.first_index)
            return i;
    }
    return a->point_count;
}

static camber_stages on_device(fixture *b) {
    camber_stages stages;
    assert_int_equal(camber_mesh_read_stages(b->mesh, &stages), CAMBER_OK);
    return stages;
}

static camber_stages on_host(fixture *b, const camber_polylines *polylines, const camber_tessellation_desc *desc) {
    camber_stages stages;
    assert_int_equal(camber_stages_tessellate(b->context, polylines, desc, &stages), CAMBER_OK);
    return stages;
}

/* Points ascend within polylines that ascend, and what lies at a point's first vertex is the point. */
static void check_against_mesh(fixture *b, const camber_polylines *polylines, const camber_stages *stages) {
    camber_mesh_data data;
    assert_int_equal(camber_mesh_read(b->mesh, &data), CAMBER_OK);
    assert_int_equal(stages->point_count, polylines->stats.kept_points);
    size_t rings = 0, drawn = 0;
    for (size_t i = 0; i < stages->point_count; i++) {
        const camber_point_stages p = stages->points[i];
        const camber_point_stages before = i ? stages->points[i - 1] : (camber_point_stages){.polyline = UINT32_MAX};
        assert_true(p.polyline < polylines->polyline_count);
        if (i && p.polyline == before.polyline)
            assert_int_equal(p.point, before.point + 1);
        else
            assert_int_equal(p.point, 0);
        assert_true(i == 0 || p.polyline >= before.polyline);
        if (camber_join_kind(p.join) == CAMBER_KIND_SENTINEL)
            continue;
        drawn++;
        rings += p.point == 0 && camber_join_kind(p.join) >= CAMBER_KIND_CUT;
        assert_true(p.first_vertex < data.info.vertex_count && p.first_index <= data.info.index_count);
        const camber_vertex *v = data.vertices + p.first_vertex;
        assert_true(v->x == p.x && v->y == p.y && v->row == polylines->polyline_rows[p.polyline]);
    }
    assert_int_equal(drawn + data.info.undrawn_dots, stages->point_count);
    assert_true(rings <= polylines->stats.rings);
    camber_mesh_data_destroy(&data);
}

static void test_device_equals_twin(void **state) {
    fixture *b = *state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    for (size_t which = 0; which < CAMBER_KERNEL_SCENES; which++) {
        camber_made_scene s = scene_make(which);
        for (int i = 0; i < 6; i++) {
            const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, (camber_method)(i / 2), 0, false};
            camber_polylines *polylines = scene_first(b->context, &s, s.polyline_count, i % 2);
            assert_int_equal(camber_mesh_tessellate(b->mesh, polylines, &desc), CAMBER_OK);
            camber_stages device = on_device(b), twin = on_host(b, polylines, &desc);
            assert_true(device.point_count > 100);
            check_against_mesh(b, polylines, &device);
            if (b->rounds)
                assert_int_equal(first_difference(&device, &twin), device.point_count);
            camber_stages_destroy(&device);
            assert_null(device.points);
            camber_stages_destroy(&twin);
            camber_polylines_destroy(polylines);
        }
        camber_made_scene_free(&s);
    }
}

static void flip_bit(const camber_device *device, camber_buffer *buffer, size_t word, int bit) {
    uint32_t *words;
    assert_int_equal(camber_buffer_map(device, buffer, CAMBER_MAP_READ_WRITE, 4 * (word + 1), &words), CAMBER_OK);
    words[word] ^= 1u << bit;
    assert_int_equal(camber_buffer_unmap_written(device, buffer, words), CAMBER_OK);
}

/* A word that is wrong on the device shows where it is. */
static void test_wrong_words_show(void **state) {
    fixture *b = *state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, CAMBER_METHOD_STRIP, 0, false};
    camber_made_scene s = scene_make(1);
    camber_polylines *polylines = scene_first(b->context, &s, s.polyline_count, true);
    assert_int_equal(camber_mesh_tessellate(b->mesh, polylines, &desc), CAMBER_OK);
    camber_stages good = on_device(b);
    /* Without rings and repeated points a point's slot is its place in the list. */
    assert_int_equal(good.point_count, polylines->first_slots[polylines->polyline_count]);
    const size_t item = b->mesh->device->point_chunk; /* an offset is that of a run */
    camber_buffer *const buffers[] = {b->mesh->parts->x, b->mesh->parts->y, b->mesh->parts->joins,
                                      b->mesh->parts->offsets};
    for (size_t k = 0; k < 4; k++) {
        const size_t points[] = {0, 255, 256, 1000, good.point_count - 1};
        for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
            const size_t at = k < 3 ? points[i] + 1 : points[i] / item;
            for (int bit = 0; bit < 32; bit += 7) {
                flip_bit(b->on.device, buffers[k], at, bit);
                camber_stages bad = on_device(b);
                assert_int_equal(first_difference(&good, &bad), k < 3 ? points[i] : points[i] / item * item);
                camber_stages_destroy(&bad);
                flip_bit(b->on.device, buffers[k], at, bit);
            }
        }
    }
    camber_stages again = on_device(b);
    assert_int_equal(first_difference(&good, &again), good.point_count);
    camber_stages_destroy(&again);
    camber_stages_destroy(&good);
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
}

static void test_ring_by_hand(void **state) {
    fixture *b = *state;
    camber_made_scene s = {0};
    const double points[][2] = {{0, 0}, {40, 0}, {10, 10}, {0, 0}};
    camber_made_scene_end(&s, 0); /* empty */
    for (size_t i = 0; i < 4; i++)
        camber_made_scene_point(&s, points[i][0], points[i][1]);
    camber_made_scene_end(&s, 0);
    const camber_stroke stroke = {2, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0};
    const camber_tessellation_desc desc = {&stroke, 1, CAMBER_METHOD_STRIP, 0, false};
    camber_polylines *polylines = scene_polylines(b->context, &s);
    assert_int_equal(camber_mesh_tessellate(b->mesh, polylines, &desc), CAMBER_OK);
    camber_stages stages = on_device(b);
    assert_int_equal(stages.point_count, 4);
    /* A break and a start; a turn past 127 degrees: an end, a break and a start; an end. Two indices each. */
    const uint32_t vertices[] = {0, 2, 6, 8}, indices[] = {0, 4, 10, 12};
    for (size_t i = 0; i < 4; i++) {
        const camber_point_stages p = stages.points[i];
        assert_int_equal(p.polyline, 1);
        assert_int_equal(p.point, i);
        assert_true((double)p.x == points[i][0] && (double)p.y == points[i][1]);
        assert_int_equal(p.first_vertex, vertices[i]);
        assert_int_equal(p.first_index, indices[i]);
    }
    assert_int_equal(stages.points[0].join, stages.points[3].join);
    assert_int_equal(camber_join_kind(stages.points[0].join), CAMBER_KIND_SPLIT);
    assert_int_equal(camber_join_kind(stages.points[1].join), CAMBER_KIND_SPLIT);
    assert_int_equal(camber_join_kind(stages.points[2].join), CAMBER_KIND_CUT);
    camber_stages_destroy(&stages);
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
}

static void assert_no_points(fixture *b) {
    camber_stages stages = on_device(b);
    assert_int_equal(stages.point_count, 0);
    camber_stages_destroy(&stages);
}

static void test_nothing(void **state) {
    fixture *b = *state;
    camber_mesh *used = b->mesh;
    const camber_stroke stroke = {2, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    const camber_tessellation_desc desc = {&stroke, 1, CAMBER_METHOD_STRIP, 0, false};
    assert_int_equal(camber_mesh_create(b->on.device, NULL, &b->mesh), CAMBER_OK);
    assert_no_points(b); /* before the first tessellation */
    camber_made_scene s = {0};
    camber_polylines *none = scene_polylines(b->context, &s);
    camber_made_scene_point(&s, 3, 4);
    camber_made_scene_end(&s, 0);
    camber_polylines *dot = scene_polylines(b->context, &s);
    assert_int_equal(camber_mesh_tessellate(b->mesh, dot, &desc), CAMBER_OK);
    camber_stages stages = on_device(b), twin = on_host(b, dot, &desc);
    assert_int_equal(stages.point_count, 1); /* tessellated, and nothing drawn of it */
    assert_int_equal(first_difference(&stages, &twin), 1);
    camber_stages_destroy(&stages);
    camber_stages_destroy(&twin);
    assert_int_equal(camber_mesh_tessellate(b->mesh, none, &desc), CAMBER_OK);
    assert_no_points(b);
    twin = on_host(b, none, &desc);
    assert_int_equal(twin.point_count, 0);
    camber_stages_destroy(&twin);
    assert_int_equal(camber_mesh_tessellate(b->mesh, dot, &(camber_tessellation_desc){0}), CAMBER_ERROR_ARGUMENT);
    assert_no_points(b); /* of the last tessellation, which failed */
    const camber_stages untouched = {.point_count = 7};
    twin = untouched;
    assert_int_equal(camber_stages_tessellate(b->context, dot, &(camber_tessellation_desc){0}, &twin),
                     CAMBER_ERROR_ARGUMENT);
    assert_memory_equal(&twin, &untouched, sizeof twin);
    b->h.errors = 0;
    camber_polylines_destroy(dot);
    camber_polylines_destroy(none);
    camber_mesh_destroy(b->mesh);
    b->mesh = used;
    camber_made_scene_free(&s);
}

/* ---- Memory ---- */

typedef struct attempt {
    fixture *b;
    const camber_polylines *polylines;
    const camber_tessellation_desc *desc;
} attempt;

static camber_status try_stages(camber_context *context, void *user) {
    attempt *a = user;
    const camber_stages untouched = {.point_count = 7};
    camber_stages device = untouched, twin = untouched;
    camber_status status = camber_mesh_read_stages(a->b->mesh, &device);
    if (status == CAMBER_OK)
        status = camber_stages_tessellate(context, a->polylines, a->desc, &twin);
    if (status != CAMBER_OK)
        assert_memory_equal(&twin, &untouched, sizeof twin);
    else
        camber_stages_destroy(&twin);
    if (device.point_count != untouched.point_count)
        camber_stages_destroy(&device);
    return status;
}

static void test_memory(void **state) {
    fixture *b = *state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, CAMBER_METHOD_KITE, 0, false};
    camber_made_scene s = scene_make(0);
    camber_polylines *polylines = scene_polylines(b->context, &s);
    assert_int_equal(camber_mesh_tessellate(b->mesh, polylines, &desc), CAMBER_OK);
    attempt a = {b, polylines, &desc};
    each_allocation_fails(&b->h, try_stages, b->context, &a);
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_device_equals_twin),
        cmocka_unit_test(test_wrong_words_show),
        cmocka_unit_test(test_ring_by_hand),
        cmocka_unit_test(test_nothing),
        cmocka_unit_test(test_memory),
    };
    int failed = 77;
    if (device_is_there())
        failed = cmocka_run_group_tests(tests, fixture_set_up_mesh, fixture_tear_down);
    else
        puts("skipped: no OpenCL device");
    return failed;
}
