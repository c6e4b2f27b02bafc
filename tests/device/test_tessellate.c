/* Tessellation on the device: the twin's bytes, whatever came before; and what a call refuses. */
#include "test_fixture.h"

static camber_mesh_data on_device(fixture *b, const camber_polylines *polylines, const camber_tessellation_desc *desc) {
    camber_mesh_data data;
    assert_int_equal(camber_mesh_tessellate(b->mesh, polylines, desc), CAMBER_OK);
    assert_int_equal(camber_mesh_read(b->mesh, &data), CAMBER_OK);
    return data;
}

static camber_mesh_data on_host(fixture *b, const camber_polylines *polylines, const camber_tessellation_desc *desc) {
    camber_mesh_data data;
    assert_int_equal(camber_mesh_data_tessellate(b->context, polylines, desc, &data), CAMBER_OK);
    return data;
}

static void assert_same(const camber_mesh_data *a, const camber_mesh_data *b) {
    assert_int_equal(a->info.method, b->info.method);
    assert_int_equal(a->info.strips, b->info.strips);
    assert_int_equal(a->info.vertex_count, b->info.vertex_count);
    assert_int_equal(a->info.index_count, b->info.index_count);
    assert_int_equal(a->info.triangle_count, b->info.triangle_count);
    assert_int_equal(a->info.joins, b->info.joins);
    assert_int_equal(a->info.tight_joins, b->info.tight_joins);
    assert_int_equal(a->info.split_joins, b->info.split_joins);
    assert_int_equal(a->info.undrawn_dots, b->info.undrawn_dots);
    assert_int_equal(a->info.record_count, b->info.record_count);
    assert_int_equal(a->info.bytes, b->info.bytes);
    for (size_t i = 0; i < a->info.record_count; i++)
        if (memcmp(a->records + i, b->records + i, sizeof *a->records) != 0)
            fail_msg("record %zu of %zu differs", i, a->info.record_count);
    for (size_t i = 0; a->corners && i < a->info.index_count; i++)
        if (a->corners[i] != b->corners[i])
            fail_msg("corner %zu of %zu: %#x, %#x", i, a->info.index_count, a->corners[i], b->corners[i]);
    for (size_t i = 0; i < a->info.vertex_count; i++)
        if (memcmp(a->vertices + i, b->vertices + i, sizeof *a->vertices) != 0)
            fail_msg("vertex %zu of %zu differs", i, a->info.vertex_count);
    for (size_t i = 0; i < a->info.index_count; i++)
        if (a->indices[i] != b->indices[i])
            fail_msg("index %zu of %zu: %u, %u", i, a->info.index_count, a->indices[i], b->indices[i]);
}

/* Tessellates on both sides and compares. */
static void compare(fixture *b, const camber_polylines *polylines, const camber_tessellation_desc *desc) {
    camber_mesh_data device = on_device(b, polylines, desc), twin = on_host(b, polylines, desc);
    assert_same(&device, &twin);
    assert_int_equal(camber_mesh_get_info(b->mesh).vertex_count, twin.info.vertex_count); /* as scan counts them */
    camber_mesh_data_destroy(&device);
    camber_mesh_data_destroy(&twin);
}

static void test_device_equals_twin(void **state) {
    fixture *b = *state;
    if (!b->rounds)
        skip();
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    for (size_t which = 0; which < CAMBER_KERNEL_SCENES; which++) {
        camber_made_scene s = scene_make(which);
        for (int keep_open = 0; keep_open < 2; keep_open++) {
            camber_polylines *polylines = scene_first(b->context, &s, s.polyline_count, keep_open);
            for (int method = 0; method < 3; method++) {
                const float tolerances[] = {0.0f, 1e-6f, 1e9f};
                for (size_t t = 0; t < (method == CAMBER_METHOD_FAN ? 3 : 1); t++)
                    compare(b, polylines,
                            &(camber_tessellation_desc){strokes, CAMBER_KERNEL_ROWS, (camber_method)method,
                                                        tolerances[t], false});
            }
            camber_polylines_destroy(polylines);
        }
        camber_made_scene_free(&s);
    }
}

static void test_each_join_and_cap(void **state) {
    fixture *b = *state;
    if (!b->rounds)
        skip();
    for (size_t which = 0; which < CAMBER_KERNEL_SCENES; which++) {
        camber_made_scene s = scene_make(which);
        memset(s.rows, 0, s.polyline_count * sizeof *s.rows);
        camber_polylines *polylines = scene_polylines(b->context, &s);
        for (int i = 0; i < 27; i++) {
            const camber_stroke stroke = {6, (camber_join)(i % 3), (camber_cap)(i / 3 % 3), 0};
            compare(b, polylines, &(camber_tessellation_desc){&stroke, 1, (camber_method)(i / 9), 0, false});
        }
        camber_polylines_destroy(polylines);
        camber_made_scene_free(&s);
    }
}

/* More rows than a block has points; each polyline has its own. */
static void test_many_rows(void **state) {
    fixture *b = *state;
    enum { ROWS = 20000 };
    camber_stroke *strokes = calloc(ROWS, sizeof *strokes);
    assert_non_null(strokes);
    camber_made_scene s = {0};
    uint64_t seed = 8;
    for (size_t i = 0; i < ROWS; i++) {
        strokes[i] = (camber_stroke){(float)i * 0.01f, (camber_join)(i % 3), (camber_cap)(i / 3 % 3), 0};
        camber_made_scene_walk(&s, &seed, 3, (const double[]){5, 50}, 3);
        camber_made_scene_end(&s, ROWS - 1 - i);
    }
    camber_polylines *polylines = scene_polylines(b->context, &s);
    for (int method = 0; method < 3 && b->rounds; method++)
        compare(b, polylines, &(camber_tessellation_desc){strokes, ROWS, (camber_method)method, 0, false});
    const camber_tessellation_desc desc = {strokes, ROWS, CAMBER_METHOD_STRIP, 0, false};
    camber_mesh_data data = on_device(b, polylines, &desc);
    uint32_t last = ROWS - 1;
    for (size_t i = 0; i < data.info.vertex_count; i++) { /* input order */
        assert_true(data.vertices[i].row == last || data.vertices[i].row + 1 == last);
        last = data.vertices[i].row;
    }
    assert_int_equal(last, 0);
    camber_mesh_data_destroy(&data);
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
    free(strokes);
}

static void test_run_to_run(void **state) {
    fixture *b = *state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    camber_made_scene s = scene_make(0), other = scene_make(1);
    camber_polylines *polylines = scene_polylines(b->context, &s), *others = scene_polylines(b->context, &other);
    for (int method = 0; method < 3; method++) {
        const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, (camber_method)method, 0, false};
        camber_mesh_data first = on_device(b, polylines, &desc);
        for (int i = 0; i < 4; i++) {
            if (i % 2) { /* whatever the mesh held before */
                camber_mesh_data between = on_device(b, others, &desc);
                camber_mesh_data_destroy(&between);
            }
            camber_mesh_data again = on_device(b, polylines, &desc);
            assert_same(&first, &again);
            camber_mesh_data_destroy(&again);
        }
        camber_mesh_data_destroy(&first);
    }
    camber_polylines_destroy(others);
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&other);
    camber_made_scene_free(&s);
}

/* A mesh keeps what it has uploaded: it does not see what becomes of the host's copy. Where it reads that in place, the
 * caller's destroying it does not matter. */
static void test_other_strokes_upload_nothing(void **state) {
    fixture *b = *state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    camber_made_scene s = scene_make(0);
    camber_polylines *polylines = scene_polylines(b->context, &s), *twin = scene_polylines(b->context, &s);
    camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, CAMBER_METHOD_STRIP, 0, false};
    camber_mesh_data data = on_device(b, polylines, &desc);
    camber_mesh_data_destroy(&data);
    if (b->mesh->parts[0].borrowed)
        assert_ptr_equal(b->mesh->polylines, polylines);
    else
        memset(polylines->x, 0, polylines->slot_count * sizeof *polylines->x);
    for (int i = 0; i < CAMBER_KERNEL_ROWS; i++)
        strokes[i].width_px = 1.0f + (float)i;
    desc.method = CAMBER_METHOD_KITE;
    data = on_device(b, polylines, &desc);
    camber_mesh *fresh = NULL;
    camber_mesh_data wanted;
    assert_int_equal(camber_mesh_create(b->on.device, NULL, &fresh), CAMBER_OK);
    assert_int_equal(camber_mesh_tessellate(fresh, twin, &desc), CAMBER_OK);
    assert_int_equal(camber_mesh_read(fresh, &wanted), CAMBER_OK);
    assert_same(&data, &wanted);
    camber_mesh_data_destroy(&wanted);
    camber_mesh_data_destroy(&data);
    camber_polylines_destroy(twin);
    camber_polylines_destroy(polylines);
    camber_stages stages, of_fresh;
    assert_int_equal(camber_mesh_read_stages(b->mesh, &stages), CAMBER_OK);
    assert_int_equal(camber_mesh_read_stages(fresh, &of_fresh), CAMBER_OK);
    assert_true(stages.point_count > 0 && stages.point_count == of_fresh.point_count);
    assert_memory_equal(stages.points, of_fresh.points, stages.point_count * sizeof *stages.points);
    camber_stages_destroy(&stages);
    camber_stages_destroy(&of_fresh);
    camber_mesh_destroy(fresh);
    camber_made_scene_free(&s);
}

static void assert_nothing(fixture *b, size_t undrawn_dots) {
    camber_mesh_data data;
    assert_int_equal(camber_mesh_read(b->mesh, &data), CAMBER_OK);
    assert_int_equal(data.info.vertex_count + data.info.index_count + data.info.triangle_count + data.info.joins, 0);
    assert_int_equal(data.info.undrawn_dots, undrawn_dots);
    camber_mesh_data_destroy(&data);
}

static void test_nothing(void **state) {
    fixture *b = *state;
    camber_mesh_destroy(b->mesh);
    b->mesh = NULL;
    assert_int_equal(camber_mesh_create(b->on.device, NULL, &b->mesh), CAMBER_OK);
    assert_nothing(b, 0); /* before the first tessellation */
    const camber_stroke stroke = {4, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    camber_made_scene none = {0}, empties = {0}, dots = {0}, line = {0};
    for (int i = 0; i < 5; i++)
        camber_made_scene_end(&empties, 0);
    for (int i = 0; i < 300; i++) {
        camber_made_scene_point(&dots, i, i);
        camber_made_scene_end(&dots, 0);
    }
    camber_made_scene_point(&line, 0, 0);
    camber_made_scene_point(&line, 9, 9);
    camber_made_scene_end(&line, 0);
    const camber_made_scene *scenes[] = {&none, &line, &empties, &line, &dots, &line, &none};
    for (int method = 0; method < 3; method++) {
        const camber_tessellation_desc desc = {&stroke, 1, (camber_method)method, 0, false};
        for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
            camber_polylines *polylines = scene_polylines(b->context, scenes[i]);
            compare(b, polylines, &desc);
            if (scenes[i] != &line)
                assert_nothing(b, scenes[i] == &dots ? 300 : 0);
            camber_polylines_destroy(polylines);
        }
    }
    camber_polylines *polylines = scene_polylines(b->context, &none);
    compare(b, polylines, &(camber_tessellation_desc){0}); /* no strokes either */
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&line);
    camber_made_scene_free(&dots);
    camber_made_scene_free(&empties);
}

static void test_arguments(void **state) {
    fixture *b = *state;
    const camber_stroke good = {4, CAMBER_JOIN_MITER, CAMBER_CAP_BUTT, 0};
    const camber_stroke bad[] = {
        {NAN, 0, 0, 0},       {-1, 0, 0, 0},    {16384.5f, 0, 0, 0},        {INFINITY, 0, 0, 0},
        {1, 0, 0, NAN},       {1, 0, 0, -1},    {1, (camber_join)3, 0, 0},  {1, 0, (camber_cap)3, 0},
        {1, 0, 0, -INFINITY}, {-0.1f, 0, 0, 0}, {1, (camber_join)-1, 0, 0}, {1, 0, (camber_cap)-1, 0},
    };
    camber_made_scene s = {0};
    camber_made_scene_point(&s, 0, 0);
    camber_made_scene_point(&s, 9, 9);
    camber_made_scene_end(&s, 1);
    camber_polylines *polylines = scene_polylines(b->context, &s);
    camber_tessellation_desc descs[sizeof bad / sizeof *bad + 6];
    camber_stroke pairs[sizeof bad / sizeof *bad][2];
    size_t count = 0;
    for (; count < sizeof bad / sizeof *bad; count++) {
        pairs[count][0] = good;
        pairs[count][1] = bad[count];
        descs[count] = (camber_tessellation_desc){pairs[count], 2, CAMBER_METHOD_STRIP, 0, false};
    }
    const camber_stroke goods[] = {good, good};
    descs[count++] = (camber_tessellation_desc){goods, 1, CAMBER_METHOD_STRIP, 0, false}; /* row 1 has no stroke */
    descs[count++] = (camber_tessellation_desc){NULL, 0, CAMBER_METHOD_STRIP, 0, false};
    descs[count++] = (camber_tessellation_desc){goods, 2, (camber_method)3, 0, false};
    descs[count++] = (camber_tessellation_desc){goods, 2, (camber_method)-1, 0, false};
    descs[count++] = (camber_tessellation_desc){goods, 2, CAMBER_METHOD_FAN, -1, false};
    descs[count++] = (camber_tessellation_desc){goods, 2, CAMBER_METHOD_FAN, NAN, false};
    for (size_t i = 0; i < count; i++) {
        b->h.errors = 0;
        assert_int_equal(camber_mesh_tessellate(b->mesh, polylines, descs + i), CAMBER_ERROR_ARGUMENT);
        assert_story(&b->h, "; ");
        assert_nothing(b, 0);
        const camber_mesh_data untouched = {.vertices = (camber_vertex *)(uintptr_t)8};
        camber_mesh_data data = untouched;
        assert_int_equal(camber_mesh_data_tessellate(b->context, polylines, descs + i, &data), CAMBER_ERROR_ARGUMENT);
        assert_story(&b->h, "; ");
        assert_memory_equal(&data, &untouched, sizeof data);
    }
    const camber_stroke edges[] = {{0, 0, 0, 0}, {16384, CAMBER_JOIN_BEVEL, CAMBER_CAP_SQUARE, INFINITY}};
    compare(b, polylines, &(camber_tessellation_desc){edges, 2, CAMBER_METHOD_FAN, INFINITY, false});
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
}

/* A polyline's first index is the index count of the polylines before it. */
static void test_first_index(void **state) {
    fixture *b = *state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    static const size_t scenes[] = {1, 4};
    for (size_t k = 0; k < 2; k++) {
        camber_made_scene s = scene_make(scenes[k]);
        camber_polylines *all = scene_polylines(b->context, &s);
        for (int method = 0; method < 3; method++) {
            const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, (camber_method)method, 0, false};
            assert_int_equal(camber_mesh_tessellate(b->mesh, all, &desc), CAMBER_OK);
            for (size_t i = 0; i <= s.polyline_count; i++) {
                camber_polylines *before = scene_first(b->context, &s, i, false);
                camber_mesh_data twin = on_host(b, before, &desc);
                uint64_t first = UINT64_MAX;
                assert_int_equal(camber_mesh_first_index(b->mesh, i, &first), CAMBER_OK);
                assert_true(first == twin.info.index_count);
                camber_mesh_data_destroy(&twin);
                camber_polylines_destroy(before);
            }
        }
        camber_polylines_destroy(all);
        camber_made_scene_free(&s);
    }
}

/* The host's part of the scan for 2^31 points: 2^23 blocks, far past what 32 bits add up to. */
static void test_scan_of_many_blocks(void **state) {
    (void)state;
    const size_t blocks = (size_t)1 << 23;
    uint32_t *sums = malloc(blocks * sizeof *sums);
    uint64_t *bases = malloc(2 * (blocks + 1) * sizeof *bases);
    assert_true(sums && bases);
    for (size_t i = 0; i < blocks; i++)
        sums[i] = 511u | 65535u << 16;
    camber_scan_blocks(sums, blocks, bases);
    for (size_t i = 0; i <= blocks; i += 4099)
        assert_true(bases[2 * i] == 511ull * i && bases[2 * i + 1] == 65535ull * i);
    assert_true(bases[2 * blocks] == 511ull * blocks && bases[2 * blocks + 1] == 65535ull * blocks);
    free(bases);
    free(sums);
}

/* The last vertex of a strip, and the last corner of a record, that signed and unsigned 32 bits number. */
static void test_most_records(void **state) {
    fixture *b = *state;
    assert_true(2 * (uint64_t)camber_records_max(CAMBER_METHOD_STRIP) - 1 == INT32_MAX);
    for (int method = CAMBER_METHOD_KITE; method <= CAMBER_METHOD_FAN; method++) {
        const uint64_t last = (uint64_t)camber_records_max((camber_method)method) - 1;
        assert_true((last << CAMBER_CORNER_BITS | ((1u << CAMBER_CORNER_BITS) - 1u)) == UINT32_MAX);
        b->h.errors = 0;
        assert_int_equal(camber_fail_records(b->context, (camber_method)method), CAMBER_ERROR_LIMIT);
        assert_story(&b->h, "33554432 records");
    }
}

/* ---- Memory ---- */

static camber_status try_device(camber_context *context, void *user) {
    camber_device *device = user;
    camber_mesh *mesh = user;
    const camber_stroke stroke = {4, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0};
    const float points[] = {0, 0, 9, 9, 9, 0};
    const uint32_t offsets[] = {0, 3};
    camber_polylines *polylines = NULL;
    camber_status status = camber_device_create(context, NULL, &device);
    if (status != CAMBER_OK) {
        assert_ptr_equal(device, user);
        return status;
    }
    status = camber_polylines_create(context, &(camber_polylines_desc){points, 3, offsets, 1, NULL, false}, &polylines);
    if (status == CAMBER_OK)
        status = camber_mesh_create(device, NULL, &mesh);
    if (status != CAMBER_OK) {
        assert_ptr_equal(mesh, user);
    } else {
        camber_mesh_data data = {.indices = user};
        status = camber_mesh_tessellate(mesh, polylines,
                                        &(camber_tessellation_desc){&stroke, 1, CAMBER_METHOD_STRIP, 0, false});
        if (status == CAMBER_OK)
            status = camber_mesh_read(mesh, &data);
        if (status == CAMBER_OK)
            camber_mesh_data_destroy(&data);
        else
            assert_ptr_equal(data.indices, user);
        camber_mesh_destroy(mesh);
    }
    camber_polylines_destroy(polylines);
    camber_device_destroy(device);
    return status;
}

static void test_memory(void **state) {
    fixture *b = *state;
    each_allocation_fails(&b->h, try_device, b->context, b);
}

/* A failed tessellation leaves a mesh that works again. */
static void test_after_failure(void **state) {
    fixture *b = *state;
    const camber_stroke stroke = {4, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0};
    const camber_tessellation_desc desc = {&stroke, 1, CAMBER_METHOD_STRIP, 0, false};
    camber_made_scene s = {0};
    uint64_t seed = 4;
    camber_made_scene_walk(&s, &seed, 9000, (const double[]){1, 5}, 1);
    camber_made_scene_end(&s, 0);
    camber_polylines *polylines = scene_polylines(b->context, &s);
    camber_mesh_destroy(b->mesh);
    b->mesh = NULL;
    assert_int_equal(camber_mesh_create(b->on.device, NULL, &b->mesh), CAMBER_OK);
    for (size_t n = 1;; n++) {
        b->h.refuse_first = b->h.calls + n;
        b->h.refuse_count = 1;
        const camber_status status = camber_mesh_tessellate(b->mesh, polylines, &desc);
        b->h.refuse_first = 0;
        if (status == CAMBER_OK)
            break;
        assert_int_equal(status, CAMBER_ERROR_MEMORY);
        assert_nothing(b, 0);
    }
    compare(b, polylines, &desc);
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
}

/* ---- Real lines ---- */

/* The parts of a shapefile's polylines (ESRI Shapefile Technical Description, 1998), fitted into side px. */
static void read_shapefile(const unsigned char *bytes, size_t size, double side, camber_made_scene *s) {
    double box[4];
    memcpy(box, bytes + 36, sizeof box);
    const double scale = side / fmax(box[2] - box[0], box[3] - box[1]);
    for (size_t at = 100; at + 12 <= size;) {
        const size_t words =
            (size_t)bytes[at + 4] << 24 | (size_t)bytes[at + 5] << 16 | (size_t)bytes[at + 6] << 8 | bytes[at + 7];
        const unsigned char *record = bytes + at + 8;
        at += 8 + 2 * words;
        int32_t head[2];
        memcpy(head, record + 36, sizeof head);
        if (record[0] != 3 || at > size)
            continue;
        for (int32_t part = 0; part < head[0]; part++) {
            int32_t first, end = head[1];
            memcpy(&first, record + 44 + 4 * part, 4);
            if (part + 1 < head[0])
                memcpy(&end, record + 48 + 4 * part, 4);
            for (int32_t i = first; i < end; i++) {
                double point[2];
                memcpy(point, record + 44 + 4 * (size_t)head[0] + 16 * (size_t)i, sizeof point);
                camber_made_scene_point(s, (point[0] - box[0]) * scale, (box[3] - point[1]) * scale);
            }
            camber_made_scene_end(s, s->polyline_count % CAMBER_KERNEL_ROWS);
        }
    }
}

static void test_real_lines(void **state) {
    fixture *b = *state;
    const char *folder = getenv("CAMBER_DATA");
    if (!folder || !b->rounds) {
        print_message("CAMBER_DATA is not set: no real lines\n");
        skip();
    }
    char path[1024], *bytes = NULL;
    size_t size = 0;
    snprintf(path, sizeof path, "%s/data/pittsburgh/edges.shp", folder);
    assert_int_equal(camber_read_file(b->context, path, CAMBER_NAMED_BY_CALLER, &bytes, &size), CAMBER_OK);
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    camber_made_scene s = {0};
    read_shapefile((const unsigned char *)bytes, size, 2048, &s);
    camber_free(b->context, bytes);
    print_message("%zu polylines, %zu points\n", s.polyline_count, s.point_count);
    assert_true(s.polyline_count > 20000);
    camber_polylines *polylines = scene_polylines(b->context, &s);
    for (int method = 0; method < 3; method++)
        compare(b, polylines,
                &(camber_tessellation_desc){strokes, CAMBER_KERNEL_ROWS, (camber_method)method, 0, false});
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_device_equals_twin),
        cmocka_unit_test(test_each_join_and_cap),
        cmocka_unit_test(test_many_rows),
        cmocka_unit_test(test_run_to_run),
        cmocka_unit_test(test_other_strokes_upload_nothing),
        cmocka_unit_test(test_nothing),
        cmocka_unit_test(test_arguments),
        cmocka_unit_test(test_first_index),
        cmocka_unit_test(test_scan_of_many_blocks),
        cmocka_unit_test(test_most_records),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_after_failure),
        cmocka_unit_test(test_real_lines),
    };
    int failed = 77;
    char pocl_cache[64];
    pocl_cache_apart(pocl_cache); /* without memory kernels are not saved, and compiled for one size of work-groups */
    if (device_is_there())
        failed = cmocka_run_group_tests(tests, fixture_set_up_mesh, fixture_tear_down);
    else
        puts("skipped: no OpenCL device");
    folder_remove(pocl_cache);
    return failed;
}
