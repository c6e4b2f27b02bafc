/* Frames that overlap: what camber_renderer_begin and camber_renderer_end hand over is what camber_renderer_render
 * does. */
#include "pictures.h"

enum { SIDE = 96 };

static const camber_paint paint = {.width_px = 6, .color = {0.2f, 0.4f, 1, 0.5f}};

/* A zigzag that depends on the number. */
static void fill(fixture *s, camber_mesh *mesh, int number) {
    camber_made_scene lines = {0};
    for (int i = 0; i < 12; i++)
        camber_made_scene_point(&lines, 6 + 7 * i, (i % 2 ? 70 : 20) + 3 * number);
    camber_made_scene_end(&lines, 0);
    const camber_stroke stroke = {.width_px = paint.width_px};
    camber_polylines *polylines = scene_polylines(s->context, &lines);
    assert_int_equal(
        camber_mesh_tessellate(mesh, polylines, &(camber_tessellation_desc){.strokes = &stroke, .stroke_count = 1}),
        CAMBER_OK);
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&lines);
}

static camber_mesh *make_mesh(fixture *s, camber_renderer *renderer) {
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_mesh_create(s->on.device, renderer, &mesh), CAMBER_OK);
    return mesh;
}

static camber_frame frame_of(const camber_pass *pass, uint32_t largest_area_px) {
    return (camber_frame){.width = SIDE,
                          .height = SIDE,
                          .background = {1, 1, 1, 1},
                          .passes = pass,
                          .pass_count = 1,
                          .largest_area_px = largest_area_px};
}

static void begin(camber_renderer *renderer, camber_mesh *mesh, uint32_t largest_area_px) {
    camber_paint own = paint;
    camber_pass pass = {.mesh = mesh, .paints = &own, .paint_count = 1};
    camber_frame frame = frame_of(&pass, largest_area_px);
    assert_int_equal(camber_renderer_begin(renderer, &frame), CAMBER_OK);
    /* They are the caller's again. */
    own = (camber_paint){.width_px = 1};
    pass = (camber_pass){0};
    frame = (camber_frame){0};
}

static picture end(camber_renderer *renderer, camber_frame_stats *stats) {
    picture p = {.width = SIDE, .height = SIDE, .rgba = calloc(SIDE * SIDE, 4)};
    assert_non_null(p.rgba);
    assert_int_equal(camber_renderer_end(renderer, picture_rows, &p, stats), CAMBER_OK);
    assert_int_equal(p.rows, SIDE);
    return p;
}

static picture alone(fixture *s, camber_renderer *renderer, int number) {
    camber_mesh *mesh = make_mesh(s, renderer);
    fill(s, mesh, number);
    const camber_pass pass = {.mesh = mesh, .paints = &paint, .paint_count = 1};
    const camber_frame frame = frame_of(&pass, 0);
    picture p = picture_draw(renderer, &frame);
    camber_mesh_destroy(mesh);
    return p;
}

static void assert_same(const picture *a, const picture *b) {
    assert_memory_equal(a->rgba, b->rgba, 4 * SIDE * SIDE);
}

/* Frames in turn from two meshes, one or two of them in flight, whole or in pieces. */
static void run_frames(fixture *s, camber_renderer *renderer, size_t in_flight, uint32_t largest_area_px) {
    enum { FRAMES = 5 };
    camber_mesh *meshes[2] = {make_mesh(s, renderer), make_mesh(s, renderer)};
    for (int n = 0; n < FRAMES + (int)in_flight - 1; n++) {
        if (n < FRAMES) {
            fill(s, meshes[n % 2], n);
            begin(renderer, meshes[n % 2], largest_area_px);
        }
        const int ready = n - (int)in_flight + 1;
        if (ready < 0)
            continue;
        camber_frame_stats stats = {0};
        picture got = end(renderer, &stats), wanted;
        assert_int_equal(stats.areas, largest_area_px ? 9 : 1);
        assert_true((stats.draw_calls >= 1) != draws_in_cl() && stats.draw_ms > 0);
        if (n + 1 < FRAMES + (int)in_flight - 1 && in_flight > 1) {
            picture_free(&got); /* camber_renderer_render waits for none in flight: the last one is looked at */
            continue;
        }
        wanted = alone(s, renderer, ready);
        assert_same(&got, &wanted);
        picture_free(&wanted);
        picture_free(&got);
    }
    for (int i = 0; i < 2; i++)
        camber_mesh_destroy(meshes[i]);
}

static void test_turns(void **state) {
    fixture *s = *state;
    for (int i = 0; i < CAMBER_FIXTURE_DRAWERS; i++)
        for (size_t in_flight = 1; s->on.renderer[i] && in_flight <= CAMBER_FRAMES_IN_FLIGHT; in_flight++) {
            run_frames(s, s->on.renderer[i], in_flight, 0);
            run_frames(s, s->on.renderer[i], in_flight, 40);
        }
    assert_int_equal(s->h.errors, 0);
}

/* Every frame of two in flight, against frames by themselves. */
static void test_each_of_two(void **state) {
    fixture *s = *state;
    camber_renderer *renderer = fixture_any(s);
    picture wanted[2] = {alone(s, renderer, 0), alone(s, renderer, 4)};
    camber_mesh *meshes[2] = {make_mesh(s, renderer), make_mesh(s, renderer)};
    for (int i = 0; i < 2; i++) {
        fill(s, meshes[i], 4 * i);
        begin(renderer, meshes[i], 0);
    }
    for (int i = 0; i < 2; i++) {
        picture got = end(renderer, NULL);
        assert_same(&got, wanted + i);
        picture_free(&got);
        picture_free(wanted + i);
        camber_mesh_destroy(meshes[i]);
    }
}

/* A mesh that changes while its frame is in flight: the drawing is awaited. */
static void test_mesh_in_flight(void **state) {
    fixture *s = *state;
    camber_renderer *renderer = fixture_any(s);
    picture wanted = alone(s, renderer, 1), next = alone(s, renderer, 5);
    camber_mesh *mesh = make_mesh(s, renderer);
    fill(s, mesh, 1);
    begin(renderer, mesh, 0);
    fill(s, mesh, 5);
    begin(renderer, mesh, 0);
    picture got = end(renderer, NULL), later = end(renderer, NULL);
    assert_same(&got, &wanted);
    assert_same(&later, &next);
    camber_mesh_destroy(mesh);
    picture_free(&later);
    picture_free(&got);
    picture_free(&next);
    picture_free(&wanted);
}

static bool refuse(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    (void)user;
    (void)rgba;
    (void)first_row;
    (void)row_count;
    return false;
}

/* A frame that does not begin leaves none in flight, one that does not end is given up; what follows is right. */
static void test_failures(void **state) {
    fixture *s = *state;
    camber_renderer *renderer = fixture_any(s);
    camber_mesh *mesh = make_mesh(s, renderer);
    fill(s, mesh, 2);
    const camber_frame wide = {.width = 70000, .height = 1};
    assert_int_equal(camber_renderer_begin(renderer, &wide), CAMBER_ERROR_ARGUMENT);
    begin(renderer, mesh, 40);
    assert_int_equal(camber_renderer_end(renderer, refuse, NULL, NULL), CAMBER_ERROR_IO);
    begin(renderer, mesh, 0);
    assert_int_equal(camber_renderer_end(renderer, NULL, NULL, NULL), CAMBER_OK); /* drawn, not read */
    picture got = alone(s, renderer, 2), wanted = alone(s, renderer, 2);
    assert_same(&got, &wanted);
    picture_free(&got);
    picture_free(&wanted);
    camber_mesh_destroy(mesh);
    s->h.errors = 0;
}

/* Frames in flight go with their renderer; tear-down counts the blocks. */
static void test_renderer_destroyed(void **state) {
    fixture *s = *state;
    for (int i = 0; i < CAMBER_FIXTURE_DRAWERS; i++) {
        camber_renderer *renderer = NULL;
        if (!s->on.renderer[i])
            continue;
        assert_int_equal(camber_fixture_open_renderer(&s->on, (camber_fixture_drawer)i, CAMBER_SHARING_AUTO, &renderer),
                         CAMBER_OK);
        camber_mesh *mesh = make_mesh(s, renderer);
        fill(s, mesh, 3);
        begin(renderer, mesh, 0);
        begin(renderer, mesh, 40);
        camber_mesh_destroy(mesh);
        camber_renderer_destroy(renderer);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_turns),
        cmocka_unit_test(test_each_of_two),
        cmocka_unit_test(test_mesh_in_flight),
        cmocka_unit_test(test_failures),
        cmocka_unit_test(test_renderer_destroyed),
    };
    return FIXTURE_RUN(tests);
}
