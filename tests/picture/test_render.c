/* Drawing: back ends, methods, sharing paths and pieces give one picture; passes do what they say. */
#include "pictures.h"

#include "draw/renderer.h"
#include "raster/rasterizer.h"

static camber_mesh *make_mesh(fixture *s, camber_renderer *renderer, const camber_made_scene *lines,
                              const camber_tessellation_desc *desc) {
    camber_mesh *mesh = NULL;
    camber_polylines *polylines = scene_polylines(s->context, lines);
    assert_int_equal(camber_mesh_create(s->on.device, renderer, &mesh), CAMBER_OK);
    assert_int_equal(camber_mesh_tessellate(mesh, polylines, desc), CAMBER_OK);
    camber_polylines_destroy(polylines);
    return mesh;
}

/* Rows of widths that a map has, every join and cap; the paints are as wide as the strokes. */
enum { MAP_ROWS = 9 };
typedef struct map_style {
    camber_stroke strokes[MAP_ROWS];
    camber_paint paints[MAP_ROWS];
} map_style;

static map_style make_style(float alpha) {
    static const float widths[MAP_ROWS] = {0.4f, 1, 1.5f, 2, 3, 4.5f, 6, 9, 14};
    map_style style;
    for (int i = 0; i < MAP_ROWS; i++) {
        const float f = (float)i / (MAP_ROWS - 1);
        style.strokes[i] = (camber_stroke){widths[i], (camber_join)(i % 3), (camber_cap)(i / 3), 0};
        style.paints[i] = (camber_paint){.width_px = widths[i], .color = {f, 1 - f, 0.5f, alpha}};
    }
    return style;
}

/* Segments far longer than the widths, turns that can be cut: no tight joins. */
static camber_made_scene roomy_scene(void) {
    camber_made_scene s = {0};
    uint64_t seed = 9;
    for (size_t i = 0; i < 60; i++) {
        camber_made_scene_walk(&s, &seed, 12, (const double[]){60, 150}, 2);
        camber_made_scene_end(&s, i % MAP_ROWS);
    }
    return s;
}

/* Winding roads, short segments and sharp turns among them. */
static camber_made_scene road_scene(void) {
    camber_made_scene s = {0};
    uint64_t seed = 10;
    for (size_t i = 0; i < 90; i++) {
        camber_made_scene_walk(&s, &seed, 60, (const double[]){2, 25}, i % 3 ? 0.5 : 2.5);
        camber_made_scene_end(&s, i % MAP_ROWS);
    }
    return s;
}

static picture draw_scene(fixture *s, camber_renderer *renderer, const camber_made_scene *lines, camber_method method,
                          const camber_frame *like) {
    const map_style style = make_style(1);
    camber_mesh *mesh =
        make_mesh(s, renderer, lines, &(camber_tessellation_desc){style.strokes, MAP_ROWS, method, 0.05f, false});
    const camber_pass pass = {.mesh = mesh, .paints = style.paints, .paint_count = MAP_ROWS};
    camber_frame frame = *like;
    frame.passes = &pass;
    frame.pass_count = 1;
    picture p = picture_draw(renderer, &frame);
    camber_mesh_destroy(mesh);
    return p;
}

static const camber_frame SQUARE = {.width = 768, .height = 768};

/* ---- One picture ---- */

/* Within 1/255: what rounding leaves open between GLES and desktop GL. */
static void test_backends_agree(void **state) {
    fixture *s = *state;
    if (!s->on.renderer[0] || !s->on.renderer[1])
        skip();
    for (int which = 0; which < 2; which++) {
        camber_made_scene lines = which ? road_scene() : roomy_scene();
        for (int method = 0; method < 3; method++) {
            picture a = draw_scene(s, s->on.renderer[0], &lines, (camber_method)method, &SQUARE);
            picture b = draw_scene(s, s->on.renderer[1], &lines, (camber_method)method, &SQUARE);
            const difference d = picture_compare(&a, &b);
            assert_true(d.drawn > 50000);
            assert_in_range(d.most, 0, 1); /* measured with Mesa 22.3: 0 */
            picture_free(&b);
            picture_free(&a);
        }
        camber_made_scene_free(&lines);
    }
}

/* Kite and strip: 0.01/255 on average; a pixel in 3,000 lies where two bodies of kites meet and is drawn by both, so it
 * has up to a quarter more. Fan has no cut on the inner side, where both bodies draw the pixels on their edges:
 * 0.3/255 on average, a pixel in 80. Measured: 0.004 and 0.14, 31 and 1118 of 162,000 pixels. */
static void test_methods_agree(void **state) {
    fixture *s = *state;
    for (int i = 0; i < CAMBER_FIXTURE_DRAWERS; i++) {
        for (int which = 0; which < 2 && s->on.renderer[i]; which++) {
            camber_made_scene lines = which ? road_scene() : roomy_scene();
            picture strip = draw_scene(s, s->on.renderer[i], &lines, CAMBER_METHOD_STRIP, &SQUARE);
            for (int method = 1; method < 3; method++) {
                picture other = draw_scene(s, s->on.renderer[i], &lines, (camber_method)method, &SQUARE);
                const difference d = picture_compare(&strip, &other);
                assert_true(d.drawn > 50000);
                assert_in_range(d.most, 0, 80);
                assert_true(d.mean < (method == CAMBER_METHOD_KITE ? 0.01 : 0.3));
                assert_true(d.past_8 < d.drawn / (method == CAMBER_METHOD_KITE ? 3000 : 80));
                picture_free(&other);
            }
            picture_free(&strip);
            camber_made_scene_free(&lines);
        }
    }
}

static void test_sharing_paths_agree(void **state) {
    fixture *s = *state;
    const camber_sharing paths[] = {CAMBER_SHARING_COPY, CAMBER_SHARING_ZERO_COPY, CAMBER_SHARING_GL};
    const map_style style = make_style(0.5f);
    camber_made_scene lines = road_scene();
    size_t compared = 0;
    for (int i = 0; i < CAMBER_FIXTURE_BACKENDS; i++) {
        picture wanted = {0};
        camber_mesh_data wanted_mesh = {0};
        for (int path = 0; path < 3 && s->on.surface[i]; path++) {
            camber_renderer *renderer = NULL;
            s->h.errors = 0;
            const camber_status status = camber_renderer_create(
                s->on.device, s->on.surface[i],
                &(camber_renderer_desc){.sharing = paths[path], .rasterizer = CAMBER_RASTERIZER_GL}, &renderer);
            if (status != CAMBER_OK) {
                assert_int_equal(status, CAMBER_ERROR_DEVICE);
                assert_story(&s->h, camber_sharing_get_name(paths[path]));
                assert_true(path > 0); /* a copy works anywhere */
                assert_null(renderer);
                continue;
            }
            assert_int_equal(camber_renderer_get_sharing(renderer), paths[path]);
            camber_mesh *mesh =
                make_mesh(s, renderer, &lines,
                          &(camber_tessellation_desc){style.strokes, MAP_ROWS, CAMBER_METHOD_STRIP, 0, false});
            const camber_pass pass = {.mesh = mesh, .paints = style.paints, .paint_count = MAP_ROWS};
            picture p =
                picture_draw(renderer, &(camber_frame){.width = 500, .height = 400, .passes = &pass, .pass_count = 1});
            camber_mesh_data data;
            assert_int_equal(camber_mesh_read(mesh, &data), CAMBER_OK);
            if (path > 0) {
                assert_int_equal(data.info.vertex_count, wanted_mesh.info.vertex_count);
                assert_int_equal(data.info.index_count, wanted_mesh.info.index_count);
                assert_memory_equal(data.vertices, wanted_mesh.vertices,
                                    data.info.vertex_count * sizeof *data.vertices);
                assert_memory_equal(data.indices, wanted_mesh.indices, data.info.index_count * sizeof *data.indices);
                picture_assert_same(&p, &wanted);
                compared++;
                picture_free(&p);
                camber_mesh_data_destroy(&data);
            } else {
                wanted = p;
                wanted_mesh = data;
            }
            camber_mesh_destroy(mesh);
            camber_renderer_destroy(renderer);
        }
        picture_free(&wanted);
        camber_mesh_data_destroy(&wanted_mesh);
    }
    camber_made_scene_free(&lines);
    if (compared == 0)
        skip();
}

/* Whatever the pieces are, the same bytes; and the rows come whole. */
static void test_pieces(void **state) {
    fixture *s = *state;
    camber_made_scene lines = road_scene();
    for (int i = 0; i < CAMBER_FIXTURE_DRAWERS; i++) {
        if (!s->on.renderer[i])
            continue;
        for (int alpha = 0; alpha < 2; alpha++) {
            const map_style style = make_style(alpha ? 0.5f : 1.0f);
            camber_mesh *mesh =
                make_mesh(s, s->on.renderer[i], &lines,
                          &(camber_tessellation_desc){style.strokes, MAP_ROWS, CAMBER_METHOD_STRIP, 0, false});
            const camber_pass pass = {.mesh = mesh, .paints = style.paints, .paint_count = MAP_ROWS};
            camber_frame frame = {.width = 300, .height = 200, .passes = &pass, .pass_count = 1};
            picture whole = picture_draw(s->on.renderer[i], &frame);
            const uint32_t sides[] = {64, 61, 100, 299, 300, 70000, 17};
            for (size_t k = 0; k < sizeof sides / sizeof *sides; k++) {
                frame.largest_area_px = sides[k];
                picture pieces = picture_draw(s->on.renderer[i], &frame);
                camber_frame_stats stats = {0};
                assert_int_equal(camber_renderer_render(s->on.renderer[i], &frame, NULL, NULL, &stats), CAMBER_OK);
                /* Areas are whole tiles of the kernels, 32 px. */
                const uint32_t side = !draws_in_cl() ? sides[k] : sides[k] < 32 ? 32 : sides[k] / 32 * 32;
                assert_int_equal(stats.areas, ((300 + side - 1) / side) * ((200 + side - 1) / side));
                assert_int_equal(pieces.calls, (200 + side - 1) / side);
                picture_assert_same(&whole, &pieces);
                picture_free(&pieces);
            }
            picture_free(&whole);
            camber_mesh_destroy(mesh);
        }
    }
    camber_made_scene_free(&lines);
}

/* Surfaces share one dispatch: drawing with one, then the other, then the first again changes nothing. */
static void test_surfaces_in_turn(void **state) {
    fixture *s = *state;
    if (!s->on.renderer[0] || !s->on.renderer[1])
        skip();
    camber_made_scene lines = roomy_scene();
    picture first[CAMBER_FIXTURE_BACKENDS];
    for (int round = 0; round < 3; round++) {
        for (int i = 0; i < CAMBER_FIXTURE_BACKENDS; i++) {
            picture p = draw_scene(s, s->on.renderer[i], &lines, CAMBER_METHOD_STRIP, &SQUARE);
            if (round == 0) {
                first[i] = p;
            } else {
                picture_assert_same(&first[i], &p);
                picture_free(&p);
            }
        }
    }
    picture_free(&first[0]);
    picture_free(&first[1]);
    camber_made_scene_free(&lines);
}

/* ---- Frames ---- */

static bool refuse_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    (void)rgba;
    (void)first_row;
    (void)row_count;
    return --*(int *)user > 0;
}

static void test_sizes(void **state) {
    fixture *s = *state;
    static const uint32_t bad[][2] = {{0, 1}, {1, 0}, {65536, 1}, {1, 65536}, {0, 0}, {0xffffffffu, 0xffffffffu}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        camber_frame_stats stats = {.areas = 77};
        int left = 2;
        s->h.errors = 0;
        assert_int_equal(camber_renderer_render(fixture_any(s),
                                                &(camber_frame){.width = bad[i][0], .height = bad[i][1]}, refuse_rows,
                                                &left, &stats),
                         CAMBER_ERROR_ARGUMENT);
        assert_story(&s->h, "; ");
        assert_int_equal(stats.areas, 77);
        assert_int_equal(left, 2);
    }
    /* The longest sides, where a picture is many pieces wide or high. */
    static const uint32_t good[][2] = {{1, 1}, {65535, 1}, {1, 65535}, {65535, 3}, {2, 40001}};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        const camber_frame frame = {.width = good[i][0], .height = good[i][1], .background = {0, 1, 0, 1}};
        picture p = picture_draw(fixture_any(s), &frame);
        for (size_t k = 0; k < (size_t)p.width * p.height; k++)
            assert_memory_equal(p.rgba + 4 * k, "\0\xff\0\xff", 4);
        picture_free(&p);
    }
}

/* A renderer that has given its memory back draws the same again, and trimming what keeps nothing does nothing. */
static void test_trim(void **state) {
    fixture *s = *state;
    camber_made_scene lines = road_scene();
    for (int b = 0; b < CAMBER_FIXTURE_DRAWERS; b++) {
        camber_renderer *renderer = s->on.renderer[b];
        if (!renderer)
            continue;
        camber_renderer_trim(renderer);
        const uint64_t before = camber_device_get_memory(s->on.device).held_bytes;
        picture first = draw_scene(s, renderer, &lines, CAMBER_METHOD_STRIP, &SQUARE);
        const uint64_t kept = camber_device_get_memory(s->on.device).held_bytes;
        camber_renderer_trim(renderer);
        assert_int_equal(camber_device_get_memory(s->on.device).held_bytes, before);
        if (b == CAMBER_FIXTURE_OPENCL)
            assert_true(kept > before);
        picture again = draw_scene(s, renderer, &lines, CAMBER_METHOD_STRIP, &SQUARE);
        assert_int_equal(picture_compare(&first, &again).most, 0);
        picture_free(&again);
        picture_free(&first);
    }
    camber_made_scene_free(&lines);
}

/* The picture is the same in the caller's memory, whoever writes it there, and the bytes around it stay. */
static void test_into(void **state) {
    fixture *s = *state;
    enum { ROOM = 1 << 20, MARK = 0xa5 };
    static const struct {
        uint32_t width, height, largest_area_px;
        size_t shift, gap_bytes; /* of the first pixel from a multiple of the alignment; between rows */
    } cases[] = {{256, 160, 0, 0, 0},  {256, 160, 0, 4, 0}, {256, 160, 0, 0, 128},
                 {256, 160, 64, 0, 0}, {64, 160, 64, 0, 0}, {32, 3232, 0, 0, 0},
                 {250, 160, 0, 0, 0},  {256, 150, 0, 0, 0}, {1, 1, 0, 1, 3}};
    camber_made_scene lines = road_scene();
    uint8_t *room = aligned_alloc(CAMBER_PIXELS_ALIGNMENT, ROOM);
    assert_non_null(room);
    for (size_t i = 0; i < CAMBER_FIXTURE_DRAWERS * (sizeof cases / sizeof *cases); i++) {
        camber_renderer *renderer = s->on.renderer[i % CAMBER_FIXTURE_DRAWERS];
        const size_t k = i / CAMBER_FIXTURE_DRAWERS, row_bytes = 4 * (size_t)cases[k].width;
        const size_t stride = row_bytes + cases[k].gap_bytes;
        uint8_t *rgba = room + CAMBER_PIXELS_ALIGNMENT + cases[k].shift;
        if (!renderer)
            continue;
        const map_style style = make_style(1);
        camber_mesh *mesh = make_mesh(s, renderer, &lines,
                                      &(camber_tessellation_desc){.strokes = style.strokes, .stroke_count = MAP_ROWS});
        const camber_pass pass = {.mesh = mesh, .paints = style.paints, .paint_count = MAP_ROWS};
        const camber_frame frame = {.width = cases[k].width,
                                    .height = cases[k].height,
                                    .background = {0, 0.5f, 1, 1},
                                    .passes = &pass,
                                    .pass_count = 1,
                                    .largest_area_px = cases[k].largest_area_px};
        picture p = picture_draw(renderer, &frame);
        camber_frame_stats stats = {0};
        memset(room, MARK, ROOM);
        assert_int_equal(camber_renderer_render_into(renderer, &frame, rgba, cases[k].gap_bytes ? stride : 0, &stats),
                         CAMBER_OK);
        assert_int_equal(stats.areas, cases[k].largest_area_px ? (frame.width / 64) * 3 : 1);
        for (size_t at = 0; at < ROOM; at++) {
            const size_t past = (size_t)(room + at - rgba), row = past / stride, byte = past % stride;
            const bool inside = room + at >= rgba && row < frame.height && byte < row_bytes;
            assert_int_equal(room[at], inside ? p.rgba[row * row_bytes + byte] : MARK);
        }
        picture_free(&p);
        camber_mesh_destroy(mesh);
    }
    free(room);
    camber_made_scene_free(&lines);
}

/* On the host's processor whole tiles are drawn in their place, without a buffer of the renderer's. */
static void test_into_place(void **state) {
    fixture *s = *state;
    const camber_renderer_desc desc = {.rasterizer = CAMBER_RASTERIZER_OPENCL};
    const camber_frame frame = {.width = 64, .height = 64, .background = {0, 1, 0, 1}};
    uint8_t *room = aligned_alloc(CAMBER_PIXELS_ALIGNMENT, 4 * 64 * 64 + CAMBER_PIXELS_ALIGNMENT);
    assert_non_null(room);
    for (size_t shift = 0; shift < 2; shift++) {
        camber_renderer *renderer = NULL;
        assert_int_equal(camber_renderer_create(s->on.device, NULL, &desc, &renderer), CAMBER_OK);
        assert_int_equal(camber_renderer_render_into(renderer, &frame, room + shift, 0, NULL), CAMBER_OK);
        assert_memory_equal(room + shift, "\0\xff\0\xff", 4);
        const bool copies = shift || !s->on.device->host_memory;
        assert_int_equal(renderer->raster->capacities[BUFFER_PIXELS] > 0, copies);
        camber_renderer_destroy(renderer);
    }
    free(room);
}

static void test_rows_refused(void **state) {
    fixture *s = *state;
    for (int after = 1; after < 4; after++) {
        int left = after;
        camber_frame_stats stats = {.areas = 77};
        const camber_frame frame = {.width = 50, .height = 100, .largest_area_px = 32}; /* four bands */
        assert_int_equal(camber_renderer_render(fixture_any(s), &frame, refuse_rows, &left, &stats), CAMBER_ERROR_IO);
        assert_int_equal(left, 0); /* not called again */
        assert_int_equal(stats.areas, 77);
    }
    int left = 5;
    const camber_frame frame = {.width = 50, .height = 100, .largest_area_px = 32};
    assert_int_equal(camber_renderer_render(fixture_any(s), &frame, refuse_rows, &left, NULL), CAMBER_OK);
}

static void test_background_is_premultiplied(void **state) {
    fixture *s = *state;
    for (int i = 0; i < CAMBER_FIXTURE_DRAWERS; i++) {
        if (!s->on.renderer[i])
            continue;
        picture p =
            picture_draw(s->on.renderer[i], &(camber_frame){.width = 5, .height = 4, .background = {1, 0.5f, 0, 0.5f}});
        for (uint32_t k = 0; k < 20; k++) {
            const uint8_t *pixel = p.rgba + 4 * k;
            assert_in_range(pixel[0], 127, 128);
            assert_in_range(pixel[1], 63, 64);
            assert_int_equal(pixel[2], 0);
            assert_in_range(pixel[3], 127, 128);
        }
        picture_free(&p);
        p = picture_draw(s->on.renderer[i], &(camber_frame){.width = 5, .height = 4}); /* zero: transparent */
        for (uint32_t k = 0; k < 80; k++)
            assert_int_equal(p.rgba[k], 0);
        picture_free(&p);
    }
}

static void test_empty_mesh(void **state) {
    fixture *s = *state;
    const camber_frame like = {.width = 8, .height = 8, .background = {0, 0, 1, 1}};
    camber_made_scene nothing = {0};
    picture p = draw_scene(s, fixture_any(s), &nothing, CAMBER_METHOD_STRIP, &like);
    for (uint32_t k = 0; k < 64; k++)
        assert_memory_equal(p.rgba + 4 * k, "\0\0\xff\xff", 4);
    picture_free(&p);
}

static void test_surface_info(void **state) {
    fixture *s = *state;
    for (int i = 0; i < CAMBER_FIXTURE_BACKENDS; i++) {
        if (!s->on.surface[i])
            continue;
        const camber_surface_info info = camber_surface_get_info(s->on.surface[i]);
        assert_non_null(strstr(info.backend, fixture_name(i)));
        assert_true(info.renderer[0] && info.version[0]);
        assert_true(info.largest_target_px >= 2048); /* what GLES 3.0 promises */
        assert_int_equal(info.software, strstr(info.renderer, "llvmpipe") || strstr(info.renderer, "softpipe"));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_backends_agree),
        cmocka_unit_test(test_methods_agree),
        cmocka_unit_test(test_sharing_paths_agree),
        cmocka_unit_test(test_pieces),
        cmocka_unit_test(test_surfaces_in_turn),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_trim),
        cmocka_unit_test(test_into),
        cmocka_unit_test(test_into_place),
        cmocka_unit_test(test_rows_refused),
        cmocka_unit_test(test_background_is_premultiplied),
        cmocka_unit_test(test_empty_mesh),
        cmocka_unit_test(test_surface_info),
    };
    return FIXTURE_RUN(tests);
}
