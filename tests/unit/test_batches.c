/* Draw calls of a mesh with 16-bit indices, counted by hand and held against a batcher that copies vertices. */
#include "scene.h"

#include "validate/batches.h"

enum { R = -1 }; /* a restart */

static size_t count_of(bool strips, const int *indices, size_t count, uint32_t vertices_max) {
    uint32_t list[64];
    assert_true(count <= 64);
    for (size_t i = 0; i < count; i++)
        list[i] = indices[i] == R ? CAMBER_RESTART_INDEX : (uint32_t)indices[i];
    const camber_mesh_data mesh = {.info = {.strips = strips, .index_count = count}, .indices = list};
    return camber_batches_count(&mesh, vertices_max);
}

#define TRIANGLES(vertices_max, ...)                                                                                   \
    count_of(false, (const int[]){__VA_ARGS__}, sizeof((const int[]){__VA_ARGS__}) / sizeof(int), vertices_max)
#define STRIPS(vertices_max, ...)                                                                                      \
    count_of(true, (const int[]){__VA_ARGS__}, sizeof((const int[]){__VA_ARGS__}) / sizeof(int), vertices_max)

static void test_triangles(void **state) {
    (void)state;
    assert_int_equal(count_of(false, NULL, 0, 3), 0);
    assert_int_equal(TRIANGLES(3, 0, 1, 2), 1);
    assert_int_equal(TRIANGLES(4, 0, 1, 2, 1, 2, 3), 1);
    assert_int_equal(TRIANGLES(3, 0, 1, 2, 1, 2, 3), 2);
    /* The base vertex moves: what counts is the span, not how far from 0 it lies. */
    assert_int_equal(TRIANGLES(4, 1000, 1001, 1002, 1003, 1002, 1001), 1);
    assert_int_equal(TRIANGLES(6, 0, 1, 2, 3, 4, 5, 6, 7, 8), 2);
    assert_int_equal(TRIANGLES(9, 0, 1, 2, 3, 4, 5, 6, 7, 8), 1);
    /* Greedy, in order: it does not go back to a batch that it has left. */
    assert_int_equal(TRIANGLES(3, 0, 1, 2, 9, 10, 11, 0, 1, 2), 3);
    assert_int_equal(TRIANGLES(3, 11, 9, 10, 2, 0, 1), 2);
    assert_int_equal(TRIANGLES(3, 0, 1, 9, 0, 1, 2), 2);
}

static void test_strips(void **state) {
    (void)state;
    assert_int_equal(STRIPS(3, R), 0);
    assert_int_equal(STRIPS(3, R, 0, 1), 0);
    assert_int_equal(STRIPS(6, R, 0, 1, 2, 3, 4, 5), 1);
    /* Cut between two triangles, of which the second takes its first two vertices again. */
    assert_int_equal(STRIPS(5, R, 0, 1, 2, 3, 4, 5), 2);
    assert_int_equal(STRIPS(4, R, 0, 1, 2, 3, 4, 5), 2);
    assert_int_equal(STRIPS(3, R, 0, 1, 2, 3, 4, 5), 4);
    assert_int_equal(STRIPS(8, R, 0, 1, 2, 3, R, 4, 5, 6, 7), 1);
    assert_int_equal(STRIPS(7, R, 0, 1, 2, 3, R, 4, 5, 6, 7), 2);
    assert_int_equal(STRIPS(4, R, 0, 1, 2, 3, R, R, 4, 5, 6, 7), 2);
    /* A restart is no vertex, and no triangle goes across it. */
    assert_int_equal(STRIPS(4, R, 0, 1, 2, R, 3, R, 1, 2, 3), 1);
}

/* A batcher that copies the vertices of whole triangles while there is room for what is new: with base vertices that
 * can only be worse by what lies between. */
static size_t copied_batches(const camber_mesh_data *mesh, uint32_t vertices_max) {
    uint32_t *batch_of = calloc(mesh->info.vertex_count + 1, sizeof *batch_of);
    assert_non_null(batch_of);
    size_t batches = 0, used = 0, length = 0;
    for (size_t i = 0; i < mesh->info.index_count; i++) {
        const uint32_t *at = mesh->indices + i;
        length = mesh->info.strips && *at == CAMBER_RESTART_INDEX ? 0 : length + 1;
        if (mesh->info.strips ? length < 3 : i % 3 != 2)
            continue;
        size_t fresh = 0;
        for (int k = -2; k <= 0; k++)
            fresh += batches == 0 || batch_of[at[k]] != batches;
        if (batches == 0 || used + fresh > vertices_max) {
            batches++;
            used = 0;
        }
        for (int k = -2; k <= 0; k++) {
            used += batch_of[at[k]] != batches;
            batch_of[at[k]] = (uint32_t)batches;
        }
    }
    free(batch_of);
    return batches;
}

static void test_meshes(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_made_scene s = scene_make(1); /* over many blocks */
    camber_polylines *polylines = scene_polylines(context, &s);
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    for (int method = 0; method < 3; method++) {
        const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, (camber_method)method, 0, false};
        camber_mesh_data mesh;
        assert_int_equal(camber_mesh_data_tessellate(context, polylines, &desc, &mesh), CAMBER_OK);
        assert_true(mesh.info.vertex_count > 10000 && mesh.info.vertex_count < CAMBER_BATCH_VERTICES);
        assert_int_equal(camber_batches_count(&mesh, CAMBER_BATCH_VERTICES), 1);
        for (uint32_t most = 200; most < 12000; most = most * 3 / 2) {
            const size_t batches = camber_batches_count(&mesh, most), copied = copied_batches(&mesh, most);
            assert_true(batches >= (mesh.info.vertex_count - 2 * CAMBER_KERNEL_ROWS) / most);
            assert_true(batches >= copied);
            assert_true(batches <= copied + copied / 50 + 1);
        }
        camber_mesh_data_destroy(&mesh);
    }
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_triangles),
        cmocka_unit_test(test_strips),
        cmocka_unit_test(test_meshes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
