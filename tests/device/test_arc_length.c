/* Measures: how far along its polyline each record lies. Against sums in double precision, and the device against the
 * twin to the last bit, over borders of chunks and parts. */
#include "test_fixture.h"

#include "residency/memory.h"

static const camber_method METHODS[] = {CAMBER_METHOD_STRIP, CAMBER_METHOD_KITE, CAMBER_METHOD_FAN};

static camber_mesh_data measured_on_host(fixture *b, const camber_polylines *polylines, const camber_stroke *strokes,
                                         camber_method method) {
    camber_mesh_data data;
    const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, method, 0, true};
    assert_int_equal(camber_mesh_data_tessellate(b->context, polylines, &desc, &data), CAMBER_OK);
    return data;
}

/* Records of a strip lie at their points, in order, but for breaks: following the points of a line, they are found one
 * after the other. */
static void check_line(const float *points, size_t count, const camber_mesh_data *data, size_t *record) {
    double along = 0, total = 0;
    for (size_t i = 1; i < count; i++)
        total += hypot((double)points[2 * i] - points[2 * i - 2], (double)points[2 * i + 1] - points[2 * i - 1]);
    const double bound = 1e-6 * total + (double)count / 1024;
    for (size_t i = 0; i < count; i++) {
        if (i > 0)
            along += hypot((double)points[2 * i] - points[2 * i - 2], (double)points[2 * i + 1] - points[2 * i - 1]);
        size_t found = 0;
        for (; *record < data->info.record_count; ++*record, found++) {
            const camber_record *r = data->records + *record;
            const bool here = r->x == points[2 * i] && r->y == points[2 * i + 1];
            if (!(r->last & CAMBER_RECORD_BREAK) && !here)
                break;
            const camber_arc_length *measure = data->arc_lengths + *record;
            assert_true(!here || fabs((double)measure->along_px - along) <= bound);
            assert_true(fabs((double)measure->total_px - total) <= bound);
            if (i + 1 == count && here) {
                ++*record;
                return;
            }
        }
        assert_true(found > 0);
    }
}

static void test_against_doubles(void **state) {
    fixture *b = *state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    uint64_t seed = 5;
    camber_made_scene s = {0};
    scene_strokes(strokes);
    for (int line = 0; line < 40; line++) {
        camber_made_scene_walk(&s, &seed, 2 + camber_random_below(&seed, 400), (const double[]){0.5, 30}, 0.5);
        camber_made_scene_end(&s, 5);
    }
    camber_polylines *polylines = scene_first(b->context, &s, s.polyline_count, true);
    camber_mesh_data data = measured_on_host(b, polylines, strokes, CAMBER_METHOD_STRIP);
    assert_true(data.info.has_arc_length);
    assert_int_equal(data.info.bytes, data.info.record_count * 32);
    size_t record = 0;
    for (size_t i = 0; i < s.polyline_count; i++) {
        while (data.records[record].last & CAMBER_RECORD_BREAK)
            record++;
        check_line(s.points + 2 * s.offsets[i], s.offsets[i + 1] - s.offsets[i], &data, &record);
    }
    assert_int_equal(record, data.info.record_count);
    camber_mesh_data_destroy(&data);
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
}

static void assert_same(const camber_mesh_data *a, const camber_mesh_data *b) {
    assert_int_equal(a->info.record_count, b->info.record_count);
    assert_memory_equal(a->records, b->records, a->info.record_count * sizeof *a->records);
    assert_non_null(a->arc_lengths);
    for (size_t i = 0; i < a->info.record_count; i++)
        if (memcmp(a->arc_lengths + i, b->arc_lengths + i, sizeof *a->arc_lengths) != 0)
            fail_msg("record %zu: %.9g of %.9g, %.9g of %.9g", i, (double)a->arc_lengths[i].along_px,
                     (double)a->arc_lengths[i].total_px, (double)b->arc_lengths[i].along_px,
                     (double)b->arc_lengths[i].total_px);
}

static void test_device_equals_twin(void **state) {
    fixture *b = *state;
    if (!b->rounds)
        skip();
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    for (size_t which = 0; which < CAMBER_KERNEL_SCENES; which++) {
        camber_made_scene s = scene_make(which);
        camber_polylines *polylines = scene_polylines(b->context, &s);
        for (size_t m = 0; m < 3; m++) {
            const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, METHODS[m], 0, true};
            camber_mesh_data twin = measured_on_host(b, polylines, strokes, METHODS[m]), device;
            assert_int_equal(camber_mesh_tessellate(b->mesh, polylines, &desc), CAMBER_OK);
            assert_int_equal(camber_mesh_read(b->mesh, &device), CAMBER_OK);
            assert_same(&twin, &device);
            camber_mesh_data_destroy(&twin);
            camber_mesh_data_destroy(&device);
        }
        camber_polylines_destroy(polylines);
        camber_made_scene_free(&s);
    }
}

/* The same mesh without and with measures, in turn: what is not measured is as if nothing had been. */
static void test_in_turn(void **state) {
    fixture *b = *state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    camber_made_scene s = scene_make(0);
    camber_polylines *polylines = scene_polylines(b->context, &s);
    camber_mesh_data meshes[4];
    for (size_t i = 0; i < 4; i++) {
        const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, CAMBER_METHOD_STRIP, 0, i % 2 == 1};
        assert_int_equal(camber_mesh_tessellate(b->mesh, polylines, &desc), CAMBER_OK);
        assert_int_equal(camber_mesh_read(b->mesh, meshes + i), CAMBER_OK);
        assert_int_equal(meshes[i].arc_lengths != NULL, i % 2);
        assert_int_equal(meshes[i].info.record_count, meshes[0].info.record_count);
        assert_memory_equal(meshes[i].records, meshes[0].records,
                            meshes[0].info.record_count * sizeof *meshes[0].records);
    }
    assert_same(meshes + 1, meshes + 3);
    for (size_t i = 0; i < 4; i++)
        camber_mesh_data_destroy(meshes + i);
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
}

/* ---- Networks ---- */

/* Walks that leave the window far behind and come back. */
static camber_network *wander(fixture *b, double *points, size_t count, size_t lines) {
    uint64_t seed = 11;
    size_t offsets[9];
    float *importance = calloc(lines * count, sizeof *importance);
    assert_non_null(importance);
    for (size_t line = 0; line < lines; line++) {
        double x = 5, y = 5, direction = (double)line;
        offsets[line] = line * count;
        for (size_t i = 0; i < count; i++) {
            points[2 * (line * count + i)] = x;
            points[2 * (line * count + i) + 1] = y;
            importance[line * count + i] = (float)camber_random_between(&seed, 0, 0.02);
            direction += camber_random_between(&seed, -0.8, 0.8);
            const double length = i % 50 == 48 ? 200 : camber_random_between(&seed, 0.001, 0.3);
            x = i % 50 == 49 ? camber_random_between(&seed, 4, 6) : x + length * cos(direction);
            y = i % 50 == 49 ? camber_random_between(&seed, 4, 6) : y + length * sin(direction);
        }
    }
    offsets[lines] = lines * count;
    camber_network *network = NULL;
    const camber_network_desc desc = {.points = points,
                                      .offsets = offsets,
                                      .polyline_count = lines,
                                      .importance = importance,
                                      .has_arc_length = true};
    assert_int_equal(camber_network_create(b->context, &desc, &network), CAMBER_OK);
    free(importance);
    return network;
}

/* How far along the line the place lies that is nearest to a pixel, and how far that is away, px. */
static double nearest(const double *points, size_t count, const camber_camera *camera, double px, double py,
                      double along_px, double *distance) {
    double along = 0, best = INFINITY, found = 0;
    for (size_t i = 1; i < count; i++) {
        const double ax = (points[2 * i - 2] - camera->x) * camera->scale_px + camera->width / 2.0;
        const double ay = (points[2 * i - 1] - camera->y) * camera->scale_px + camera->height / 2.0;
        const double bx = (points[2 * i] - camera->x) * camera->scale_px + camera->width / 2.0;
        const double by = (points[2 * i + 1] - camera->y) * camera->scale_px + camera->height / 2.0;
        const double dx = bx - ax, dy = by - ay, length = hypot(dx, dy);
        double t = length > 0 ? ((px - ax) * dx + (py - ay) * dy) / (length * length) : 0;
        t = t < 0 ? 0 : t > 1 ? 1 : t;
        /* A line may cross itself: of places that are as near, the one that is as far along as is said. */
        const double away = hypot(ax + t * dx - px, ay + t * dy - py);
        const double off = away + 1e-3 * fabs(along + t * length - along_px);
        if (off < best) {
            best = off;
            found = along + t * length;
            *distance = away;
        }
        along += length;
    }
    return found;
}

static void test_networks(void **state) {
    enum { COUNT = 400, LINES = 8 };
    fixture *b = *state;
    static double points[2 * COUNT * LINES];
    camber_network *network = wander(b, points, COUNT, LINES);
    const camber_stroke stroke = {6, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    const double scales[] = {5, 20, 100, 20, 3000, 3000};
    size_t cuts = 0;
    for (size_t i = 0; i < 6; i++) {
        const camber_camera camera = {
            .x = 5, .y = 5, .scale_px = scales[i], .width = 300, .height = 200, .simplify_px = i % 2 ? 0.1 : 0};
        const camber_tessellation_desc desc = {&stroke, 1, CAMBER_METHOD_STRIP, 0, true};
        camber_polylines *seen = NULL;
        camber_mesh_data twin, device;
        assert_int_equal(camber_network_project(network, &camera, &desc, &seen), CAMBER_OK);
        assert_int_equal(camber_mesh_data_tessellate(b->context, seen, &desc, &twin), CAMBER_OK);
        assert_int_equal(camber_mesh_tessellate_network(b->mesh, network, &camera, &desc), CAMBER_OK);
        assert_int_equal(camber_mesh_read(b->mesh, &device), CAMBER_OK);
        if (b->rounds)
            assert_same(&twin, &device);
        for (size_t line = 0; line < LINES && camera.simplify_px <= 0; line++)
            for (size_t slot = seen->first_slots[line] + 1; slot <= seen->first_slots[line + 1]; slot++) {
                const camber_arc_length *measure = seen->arc_lengths + slot - 1;
                double away = INFINITY;
                const double along = nearest(points + 2 * COUNT * line, COUNT, &camera, (double)seen->x[slot],
                                             (double)seen->y[slot], (double)measure->along_px, &away);
                assert_true(away <= 0.2);
                assert_true(fabs(along - (double)measure->along_px) <= 0.3 + 1e-5 * along);
                cuts += (seen->info[slot] & CAMBER_POINT_FIRST) && along > 1;
            }
        camber_mesh_data_destroy(&twin);
        camber_mesh_data_destroy(&device);
        camber_polylines_destroy(seen);
    }
    assert_true(cuts > 20);
    camber_network_destroy(network);
}

/* Every line, and that it is a part of one that is longer: how far along differs by what lies before it. On a device
 * whose buffers hold a few lines each, so that there are sections. */
static void test_parts_of_lines(void **state) {
    enum { COUNT = 100, LINES = 120 };
    fixture *b = *state;
    static double points[2 * COUNT * LINES];
    static float progress[2 * LINES];
    size_t offsets[LINES + 1];
    uint64_t seed = 21;
    for (size_t line = 0; line <= LINES; line++)
        offsets[line] = line * COUNT;
    for (size_t i = 0; i < 2 * COUNT * LINES; i++)
        points[i] = camber_random_between(&seed, 0, 10);
    for (size_t line = 0; line < LINES; line++) {
        progress[2 * line] = line % 3 ? (float)camber_random_between(&seed, 0, 0.5) : 0.0f;
        progress[2 * line + 1] = line % 4 ? (float)camber_random_between(&seed, 0.6, 1) : 1.0f;
    }
    progress[2] = NAN;  /* as if nothing were said */
    progress[4] = 0.9f; /* no longer */
    progress[5] = 0.1f;
    const camber_device_desc small = {.largest_buffer_bytes = 16384};
    const camber_stroke stroke = {2, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    const camber_tessellation_desc desc = {&stroke, 1, CAMBER_METHOD_STRIP, 0, true};
    const camber_camera camera = {.x = 5, .y = 5, .scale_px = 30, .width = 400, .height = 400};
    camber_mesh_data data[3];
    camber_polylines *seen[2];
    for (int part = 0; part < 2; part++) {
        const camber_network_desc network_desc = {.points = points,
                                                  .offsets = offsets,
                                                  .polyline_count = LINES,
                                                  .has_arc_length = true,
                                                  .progress = part ? progress : NULL};
        camber_network *network = NULL;
        assert_int_equal(camber_network_create(b->context, &network_desc, &network), CAMBER_OK);
        assert_int_equal(camber_network_project(network, &camera, &desc, seen + part), CAMBER_OK);
        assert_int_equal(camber_mesh_data_tessellate(b->context, seen[part], &desc, data + part), CAMBER_OK);
        if (part) {
            camber_device *device = NULL;
            camber_mesh *mesh = NULL;
            assert_int_equal(camber_device_create(b->context, &small, &device), CAMBER_OK);
            assert_int_equal(camber_mesh_create(device, NULL, &mesh), CAMBER_OK);
            assert_int_equal(camber_mesh_tessellate_network(mesh, network, &camera, &desc), CAMBER_OK);
            assert_true(camber_mesh_get_memory(mesh).parts > 2);
            assert_int_equal(camber_mesh_read(mesh, data + 2), CAMBER_OK);
            if (b->rounds)
                assert_same(data + 1, data + 2);
            camber_mesh_data_destroy(data + 2);
            camber_mesh_destroy(mesh);
            camber_device_destroy(device);
        }
        camber_network_destroy(network);
    }
    assert_int_equal(data[0].info.record_count, data[1].info.record_count);
    for (size_t line = 0; line < LINES; line++)
        for (size_t slot = seen[0]->first_slots[line]; slot < seen[0]->first_slots[line + 1]; slot++) {
            if (!(seen[0]->info[slot + 1] & CAMBER_POINT_REAL))
                continue;
            const camber_arc_length whole = seen[0]->arc_lengths[slot], part = seen[1]->arc_lengths[slot];
            const bool said = line != 1 && line != 2;
            const double from = said ? (double)progress[2 * line] : 0, to = said ? (double)progress[2 * line + 1] : 1;
            const double total = (double)whole.total_px / (to - from), along = from * total + (double)whole.along_px;
            assert_true(fabs((double)part.total_px - total) <= 1e-5 * total);
            assert_true(fabs((double)part.along_px - along) <= 1e-5 * total);
        }
    for (int part = 0; part < 2; part++) {
        camber_mesh_data_destroy(data + part);
        camber_polylines_destroy(seen[part]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_doubles), cmocka_unit_test(test_device_equals_twin),
        cmocka_unit_test(test_in_turn),         cmocka_unit_test(test_networks),
        cmocka_unit_test(test_parts_of_lines),
    };
    int failed = 77;
    if (device_is_there())
        failed = cmocka_run_group_tests(tests, fixture_set_up_mesh, fixture_tear_down);
    else
        puts("skipped: no OpenCL device");
    return failed;
}
