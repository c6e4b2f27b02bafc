/* Joins by how much they turn: known figures, and as many as the tessellation finds. */
#include "scene.h"

#include "validate/turn_classes.h"

static camber_lines lines_of(const camber_made_scene *s) {
    return (camber_lines){
        .points = s->points, .offsets = s->offsets, .point_count = s->point_count, .polyline_count = s->polyline_count};
}

static void test_classes(void **state) {
    (void)state;
    camber_made_scene s = {0};
    for (int degree = -179; degree <= 180; degree++) { /* between whole degrees, where no class begins */
        const double angle = (degree - 0.5) * SCENE_PI / 180;
        camber_made_scene_point(&s, -10, 0);
        camber_made_scene_point(&s, 0, 0);
        camber_made_scene_point(&s, 10 * cos(angle), 10 * sin(angle));
        camber_made_scene_end(&s, 0);
    }
    camber_made_scene_point(&s, 0, 0);
    camber_made_scene_point(&s, 10, 0);
    camber_made_scene_point(&s, 0, 0); /* straight back, and a ring: two joins of 180 degrees */
    camber_made_scene_end(&s, 0);
    const camber_lines lines = lines_of(&s);
    size_t counts[CAMBER_TURN_CLASSES] = {1000};
    camber_turns_count(&lines, false, counts);
    const size_t expected[CAMBER_TURN_CLASSES] = {1060, 60, 60, 60, 60, 62};
    assert_memory_equal(counts, expected, sizeof counts);
    memset(counts, 0, sizeof counts);
    camber_turns_count(&lines, true, counts);
    assert_int_equal(counts[CAMBER_TURN_CLASSES - 1], 61);
    camber_made_scene_free(&s);
}

static void test_sums(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    for (size_t which = 0; which < CAMBER_KERNEL_SCENES; which++)
        for (int keep_open = 0; keep_open < 2; keep_open++) {
            camber_made_scene s = scene_make(which);
            camber_polylines *polylines = scene_first(context, &s, s.polyline_count, keep_open);
            const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, CAMBER_METHOD_STRIP, 0, false};
            const camber_lines lines = lines_of(&s);
            size_t counts[CAMBER_TURN_CLASSES] = {0}, sum = 0;
            camber_turns_count(&lines, keep_open, counts);
            for (int i = 0; i < CAMBER_TURN_CLASSES; i++)
                sum += counts[i];
            camber_mesh_data mesh;
            assert_int_equal(camber_mesh_data_tessellate(context, polylines, &desc, &mesh), CAMBER_OK);
            assert_int_equal(sum, mesh.info.joins);
            camber_mesh_data_destroy(&mesh);
            camber_polylines_destroy(polylines);
            camber_made_scene_free(&s);
        }
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_classes),
        cmocka_unit_test(test_sums),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
