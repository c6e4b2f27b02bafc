/* Overdraw against counts by hand, against the oracle, and against itself in other ranges, pieces and back ends. */
#include "pictures.h"

#include "validate/oracle.h"
#include "vertices/vertices.h"

/* ---- Counting ---- */

typedef struct counts {
    camber_overdraw sum;
    uint8_t *map; /* width * height */
} counts;

static counts count(camber_renderer *renderer, camber_overdraw_desc desc) {
    counts made = {.map = malloc((size_t)desc.width * desc.height)};
    assert_non_null(made.map);
    memset(made.map, 7, (size_t)desc.width * desc.height);
    desc.map = made.map;
    assert_int_equal(camber_renderer_count_overdraw(renderer, &desc, &made.sum), CAMBER_OK);
    camber_overdraw bare;
    desc.map = NULL;
    assert_int_equal(camber_renderer_count_overdraw(renderer, &desc, &bare), CAMBER_OK);
    assert_memory_equal(&bare, &made.sum, sizeof bare);
    return made;
}

/* The polylines of a scene at one width with butt caps, on 64 x 64 px. */
static counts count_lines(fixture *s, camber_made_scene *lines, float width_px, camber_method method) {
    const camber_stroke stroke = {width_px, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    const camber_paint paint = {.width_px = width_px, .color = {0, 0, 0, 0}};
    camber_mesh *mesh =
        fixture_mesh(s, fixture_any(s), lines, &(camber_tessellation_desc){&stroke, 1, method, 0, false});
    const counts made =
        count(fixture_any(s),
              (camber_overdraw_desc){.width = 64, .height = 64, .mesh = mesh, .paints = &paint, .paint_count = 1});
    camber_mesh_destroy(mesh);
    camber_made_scene_free(lines);
    return made;
}

static void assert_counts(counts *made, uint64_t fragments, uint64_t drawn, uint64_t repeated) {
    if (fragments)
        assert_int_equal(made->sum.fragments, fragments);
    assert_int_equal(made->sum.drawn_pixels, drawn);
    assert_int_equal(made->sum.repeated_pixels, repeated);
    free(made->map);
}

static void add(camber_made_scene *s, size_t row, const double *points, size_t point_count) {
    for (size_t i = 0; i < point_count; i++)
        camber_made_scene_point(s, points[2 * i], points[2 * i + 1]);
    camber_made_scene_end(s, row);
}

/* A line of 40 x 4 px on whole pixels; the pad adds a pixel on every side. */
enum { BAR_DRAWN = 40 * 4, BAR_FRAGMENTS = 42 * 6 };
static const double BAR[] = {10, 20, 50, 20};

static void test_bar(void **state) {
    for (int method = 0; method < 3; method++) {
        camber_made_scene lines = {0};
        add(&lines, 0, BAR, 2);
        counts made = count_lines(*state, &lines, 4, (camber_method)method);
        assert_counts(&made, BAR_FRAGMENTS, BAR_DRAWN, 0);
    }
}

/* One polyline that crosses itself at a right angle: 4 x 4 px on whole pixels, 5 x 5 between them. */
static void test_crossing(void **state) {
    for (int method = 0; method < 2; method++) {
        for (int between = 0; between < 2; between++) {
            const double d = between ? 0.3 : 0, side = between ? 5 : 4;
            camber_made_scene lines = {0};
            add(&lines, 0, (const double[]){10, 32 + d, 54 + d, 32 + d, 54 + d, 10, 32 + d, 10, 32 + d, 54}, 5);
            counts made = count_lines(*state, &lines, 4, (camber_method)method);
            assert_int_equal(made.sum.repeated_pixels, side * side);
            for (int y = 0; y < 64; y++)
                for (int x = 0; x < 64; x++)
                    assert_int_equal(made.map[64 * y + x], x >= 30 && x < 30 + side && y >= 30 && y < 30 + side);
            free(made.map);
        }
    }
}

static void test_two_polylines(void **state) {
    camber_made_scene lines = {0};
    add(&lines, 0, BAR, 2);
    add(&lines, 0, (const double[]){30, 4, 30, 44}, 2);
    counts made = count_lines(*state, &lines, 4, CAMBER_METHOD_STRIP);
    for (int i = 0; i < 64 * 64; i++)
        assert_int_equal(made.map[i], 0);
    assert_counts(&made, 2 * BAR_FRAGMENTS, 2 * BAR_DRAWN, 0);
}

/* How many pixels the oracle finds under two strokes at once. */
static uint64_t shared_pixels(const float *a, const float *b, double width_px, double *most) {
    camber_oracle_window windows[2];
    const camber_oracle_style style = {width_px, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 2, false};
    const camber_oracle_style wide = {width_px + 2, CAMBER_JOIN_ROUND, CAMBER_CAP_SQUARE, 2, false};
    uint64_t found[2] = {0, 0};
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < 2; i++) {
            assert_true(camber_oracle_open(windows + i, 0, 0, 64, 64));
            assert_true(camber_oracle_stroke(windows + i, i ? b : a, 2, pass ? &wide : &style));
        }
        for (int y = 0; y < 64; y++)
            for (int x = 0; x < 64; x++)
                found[pass] +=
                    camber_oracle_coverage(windows, x, y) > 0 && camber_oracle_coverage(windows + 1, x, y) > 0;
        for (int i = 0; i < 2; i++)
            camber_oracle_close(windows + i);
    }
    *most = (double)found[1];
    return found[0];
}

/* Crossings at other angles: no fewer pixels than 256 samples find, and few more. */
static void test_slanted_crossings(void **state) {
    uint64_t seed = 3;
    for (int i = 0; i < 20; i++) {
        const double a = camber_random_between(&seed, 0, 6), b = a + camber_random_between(&seed, 1, 1.8),
                     m = (a + b) / 2;
        const double width = camber_random_between(&seed, 1, 7);
        /* Through 32, 32 twice, and around in between. */
        const double p[] = {32 - 20 * cos(a), 32 - 20 * sin(a), 32 + 20 * cos(a), 32 + 20 * sin(a), 32 + 26 * cos(m),
                            32 + 26 * sin(m), 32 + 20 * cos(b), 32 + 20 * sin(b), 32 - 20 * cos(b), 32 - 20 * sin(b)};
        const float f[] = {(float)p[0], (float)p[1], (float)p[2], (float)p[3],
                           (float)p[6], (float)p[7], (float)p[8], (float)p[9]};
        double most;
        const uint64_t least = shared_pixels(f, f + 4, width, &most);
        camber_made_scene lines = {0};
        add(&lines, 0, p, 5);
        counts made = count_lines(*state, &lines, (float)width, CAMBER_METHOD_STRIP);
        assert_in_range(made.sum.repeated_pixels, least, (uint64_t)most);
        free(made.map);
    }
}

/* Plain bends: strip and kite give each pixel to one segment, a fan does not. */
static void test_bends(void **state) {
    uint64_t fans = 0;
    for (int degree = -124; degree <= 124; degree += 4) {
        for (int method = 0; method < 3; method++) {
            const double angle = degree * SCENE_PI / 180;
            camber_made_scene lines = {0};
            add(&lines, 0, (const double[]){8, 32.3, 31.7, 32.3, 31.7 + 24 * cos(angle), 32.3 + 24 * sin(angle)}, 3);
            counts made = count_lines(*state, &lines, 5, (camber_method)method);
            if (method < 2)
                assert_int_equal(made.sum.repeated_pixels, 0);
            else
                fans += made.sum.repeated_pixels;
            assert_true(made.sum.drawn_pixels > 100);
            free(made.map);
        }
    }
    assert_true(fans > 62 * 4);
}

static void test_reversal(void **state) {
    camber_made_scene lines = {0};
    add(&lines, 0, (const double[]){10, 20, 50, 20, 20, 20}, 3);
    counts made = count_lines(*state, &lines, 4, CAMBER_METHOD_STRIP);
    assert_int_equal(made.sum.repeated_pixels, 30 * 4);
    free(made.map);
}

/* ---- Many layers ---- */

enum { LAYERS = 3000 };

/* More ranges on a pixel than a channel holds, or than a 16-bit float counts. */
static void test_layers(void **state) {
    for (int method = 0; method < 2; method++) {
        camber_made_scene lines = {0};
        for (int i = 0; i < LAYERS; i++)
            add(&lines, 0, BAR, 2);
        counts made = count_lines(*state, &lines, 4, (camber_method)method);
        assert_counts(&made, (uint64_t)LAYERS * BAR_FRAGMENTS, (uint64_t)LAYERS * BAR_DRAWN, 0);
    }
}

/* More fragments of one range on a pixel than a channel or the stencil holds. */
static void test_layers_of_one(void **state) {
    fixture *s = *state;
    const camber_stroke stroke = {4, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    const camber_paint paint = {.width_px = 4, .color = {0, 0, 0, 1}};
    for (int method = 0; method < 3; method++) {
        camber_made_scene lines = {0};
        for (int i = 0; i <= LAYERS; i++) /* there and back from 10 to 50 */
            camber_made_scene_point(&lines, i % 2 ? 50 : 10, 20);
        camber_made_scene_end(&lines, 0);
        camber_mesh *mesh = fixture_mesh(s, fixture_any(s), &lines,
                                         &(camber_tessellation_desc){&stroke, 1, (camber_method)method, 0, false});
        const camber_overdraw_desc desc = {.width = 64, .height = 64, .mesh = mesh, .paints = &paint, .paint_count = 1};
        counts made = count(fixture_any(s), desc);
        assert_true(made.sum.fragments >= (uint64_t)LAYERS * BAR_DRAWN);
        assert_true(made.sum.repeated_pixels >= BAR_DRAWN && made.sum.repeated_pixels <= made.sum.drawn_pixels);
        if (method != CAMBER_METHOD_STRIP) {
            /* The same triangles, 40 at a time: never a full channel. */
            assert_int_equal(camber_mesh_count_joins(mesh), CAMBER_OK);
            const size_t triangles = camber_mesh_get_info(mesh).triangle_count;
            uint64_t sum = 0;
            for (size_t first = 0; first < triangles; first += 40) {
                const camber_index_range part = {3 * first, 3 * (triangles - first < 40 ? triangles - first : 40)};
                camber_overdraw_desc apart = desc;
                apart.ranges = &part;
                apart.range_count = 1;
                counts few = count(fixture_any(s), apart);
                sum += few.sum.fragments;
                free(few.map);
            }
            assert_int_equal(sum, made.sum.fragments);
        }
        free(made.map);
        camber_mesh_destroy(mesh);
        camber_made_scene_free(&lines);
    }
}

/* The map stops at 255. */
static void test_full_map(void **state) {
    camber_made_scene lines = {0};
    for (int i = 0; i < 300; i++)
        add(&lines, 0, (const double[]){10, 20, 50, 20, 20, 20}, 3);
    add(&lines, 0, (const double[]){10, 40, 50, 40, 20, 40}, 3);
    counts made = count_lines(*state, &lines, 4, CAMBER_METHOD_KITE);
    assert_int_equal(made.sum.repeated_pixels, 301 * 30 * 4);
    assert_int_equal(made.map[64 * 20 + 30], 255);
    assert_int_equal(made.map[64 * 40 + 30], 1);
    assert_int_equal(made.map[64 * 20 + 15], 0);
    free(made.map);
}

/* ---- Ranges, paints, pieces, back ends ---- */

/* Two segments of a strip that lie on each other, apart and together. */
static void test_ranges(void **state) {
    fixture *s = *state;
    const camber_stroke stroke = {4, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    const camber_paint paint = {.width_px = 4, .color = {0, 0, 0, 1}};
    camber_made_scene lines = {0};
    add(&lines, 0, (const double[]){10, 20, 50, 20, 20, 20}, 3);
    camber_mesh *mesh =
        fixture_mesh(s, fixture_any(s), &lines, &(camber_tessellation_desc){&stroke, 1, CAMBER_METHOD_STRIP, 0, false});
    camber_mesh_data data;
    assert_int_equal(camber_mesh_read(mesh, &data), CAMBER_OK);
    size_t second = 2; /* where the strip breaks, behind its begin */
    while (data.indices[second] != CAMBER_RESTART_INDEX)
        second++;
    const camber_index_range ranges[] = {
        {0, second}, {second, data.info.index_count - second}, {0, data.info.index_count}, {0, 0}};
    camber_overdraw_desc desc = {
        .width = 64, .height = 64, .mesh = mesh, .paints = &paint, .paint_count = 1, .ranges = ranges};
    counts made[4];
    for (size_t i = 0; i < 4; i++) {
        desc.range_count = i < 3 ? 1 : 4;
        desc.ranges = i < 3 ? ranges + i : ranges;
        made[i] = count(fixture_any(s), desc);
        free(made[i].map);
    }
    assert_int_equal(made[0].sum.repeated_pixels, 0);
    assert_int_equal(made[1].sum.repeated_pixels, 0);
    assert_int_equal(made[2].sum.repeated_pixels, 30 * 4);
    assert_int_equal(made[2].sum.fragments, made[0].sum.fragments + made[1].sum.fragments);
    assert_int_equal(made[3].sum.fragments, 2 * made[2].sum.fragments);
    assert_int_equal(made[3].sum.repeated_pixels, made[2].sum.repeated_pixels);
    assert_int_equal(made[3].sum.drawn_pixels,
                     made[0].sum.drawn_pixels + made[1].sum.drawn_pixels + made[2].sum.drawn_pixels);

    camber_overdraw sum = {1, 2, 3};
    const camber_index_range outside[] = {{0, data.info.index_count + 1}, {UINT64_MAX, 3}, {4, UINT64_MAX}, {3, 4}};
    for (size_t i = 0; i < 4; i++) {
        desc.ranges = outside + i;
        desc.range_count = 1;
        assert_int_equal(camber_renderer_count_overdraw(fixture_any(s), &desc, &sum), CAMBER_ERROR_ARGUMENT);
        assert_story(&s->h, "range 0");
    }
    desc.ranges = NULL;
    desc.width = 0;
    assert_int_equal(camber_renderer_count_overdraw(fixture_any(s), &desc, &sum), CAMBER_ERROR_ARGUMENT);
    assert_story(&s->h, "0 x 64");
    assert_int_equal(sum.fragments, 1);
    camber_mesh_data_destroy(&data);
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&lines);
}

/* Rows that are not drawn, whatever was drawn before, and rows drawn narrower than they were tessellated. */
static void test_paints(void **state) {
    fixture *s = *state;
    const camber_stroke strokes[] = {{8, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0},
                                     {8, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0}};
    const camber_paint wide[] = {{.width_px = 8}, {.width_px = 8}}, narrow[] = {{.width_px = 4}, {.width_px = 0}};
    camber_made_scene lines = {0};
    add(&lines, 0, BAR, 2);
    add(&lines, 1, BAR, 2);
    camber_mesh *mesh =
        fixture_mesh(s, fixture_any(s), &lines, &(camber_tessellation_desc){strokes, 2, CAMBER_METHOD_STRIP, 0, false});
    const camber_index_range all = {0, camber_mesh_get_info(mesh).index_count};
    camber_overdraw_desc desc = {.width = 64, .height = 64, .mesh = mesh, .paints = wide, .paint_count = 2};
    counts made = count(fixture_any(s), desc);
    assert_counts(&made, 2 * 42 * 10, 2 * 40 * 8, 0);
    for (int ranges = 0; ranges < 2; ranges++) {
        for (size_t paints = 1; paints <= 2; paints++) {
            desc = (camber_overdraw_desc){
                .width = 64, .height = 64, .mesh = mesh, .paints = narrow, .paint_count = paints};
            desc.ranges = ranges ? &all : NULL;
            desc.range_count = (size_t)ranges;
            made = count(fixture_any(s), desc);
            assert_counts(&made, BAR_FRAGMENTS, BAR_DRAWN, 0);
        }
    }
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&lines);
}

static void test_nothing(void **state) {
    fixture *s = *state;
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_mesh_create(s->on.device, fixture_any(s), &mesh), CAMBER_OK);
    counts made = count(fixture_any(s), (camber_overdraw_desc){.width = 8, .height = 8, .mesh = mesh});
    assert_int_equal(made.map[9], 0);
    assert_counts(&made, 0, 0, 0);
    assert_int_equal(made.sum.fragments, 0);
    camber_mesh_destroy(mesh);
}

/* Larger than a piece: across their borders nothing is lost and nothing counted twice. */
static void test_pieces(void **state) {
    fixture *s = *state;
    enum { W = 5000, H = 2500 };
    const camber_stroke stroke = {4, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    const camber_paint paint = {.width_px = 4, .color = {0, 0, 0, 1}};
    camber_made_scene lines = {0};
    add(&lines, 0, (const double[]){100, 2048, 4900, 2048}, 2);
    add(&lines, 0, (const double[]){4096, 100, 4096, 2400}, 2);
    add(&lines, 0, (const double[]){2000, 2046, 2100, 2046, 2050, 2046}, 3);
    camber_mesh *mesh =
        fixture_mesh(s, fixture_any(s), &lines, &(camber_tessellation_desc){&stroke, 1, CAMBER_METHOD_STRIP, 0, false});
    const camber_index_range two = {0, 12};
    camber_overdraw_desc desc = {.width = W, .height = H, .mesh = mesh, .paints = &paint, .paint_count = 1};
    counts made = count(fixture_any(s), desc);
    assert_int_equal(made.sum.repeated_pixels, 50 * 4);
    for (size_t y = 2040; y < 2056; y++)
        for (size_t x = 0; x < W; x++)
            assert_int_equal(made.map[W * y + x], x >= 2050 && x < 2100 && y >= 2044 && y < 2048);
    free(made.map);
    desc.ranges = &two; /* the lines as one range: they cross once */
    desc.range_count = 1;
    made = count(fixture_any(s), desc);
    /* A GPU may have an end that lies 4,900 px along reach a little into the next pixels. */
    const uint64_t drawn = 4800 * 4 + 2300 * 4 - 16, more = made.sum.drawn_pixels - drawn;
    assert_counts(&made, 4802 * 6 + 2302 * 6, fixture_has_gpu(s) && more <= 4 ? drawn + more : drawn, 16);
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&lines);
}

/* Every join and cap, tight and split ones among them. */
static void test_backends_agree(void **state) {
    fixture *s = *state;
    if (!s->on.renderer[0] || !s->on.renderer[1])
        skip();
    camber_stroke strokes[9];
    camber_paint paints[9];
    for (int i = 0; i < 9; i++) {
        strokes[i] = (camber_stroke){1.0f + (float)i, (camber_join)(i % 3), (camber_cap)(i / 3), 0};
        paints[i] = (camber_paint){.width_px = strokes[i].width_px, .color = {0, 0, 0, 1}};
    }
    camber_made_scene lines = {0};
    uint64_t seed = 17;
    for (size_t i = 0; i < 200; i++) {
        camber_made_scene_walk(&lines, &seed, 40, (const double[]){2, 30}, i % 3 ? 0.5 : 2.5);
        camber_made_scene_end(&lines, i % 9);
    }
    for (int method = 0; method < 3; method++) {
        counts made[2];
        for (int i = 0; i < 2; i++) {
            camber_mesh *mesh = fixture_mesh(s, s->on.renderer[i], &lines,
                                             &(camber_tessellation_desc){strokes, 9, (camber_method)method, 0, false});
            made[i] = count(s->on.renderer[i],
                            (camber_overdraw_desc){
                                .width = 1000, .height = 1000, .mesh = mesh, .paints = paints, .paint_count = 9});
            camber_mesh_destroy(mesh);
        }
        assert_memory_equal(&made[0].sum, &made[1].sum, sizeof made[0].sum);
        assert_memory_equal(made[0].map, made[1].map, 1000 * 1000);
        assert_true(made[0].sum.repeated_pixels > 1000);
        assert_true(made[0].sum.fragments >= made[0].sum.drawn_pixels + made[0].sum.repeated_pixels);
        free(made[0].map);
        free(made[1].map);
    }
    camber_made_scene_free(&lines);
}

/* A mesh in parts counts like a whole one, by its polylines, by ranges across the parts, and by all at once. */
static void test_parts(void **state) {
    enum { SEEN_PX = 500 };
    fixture *s = *state;
    const camber_stroke stroke = {5, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0};
    const camber_paint paint = {.width_px = 5, .color = {0, 0, 0, 1}};
    camber_made_scene lines = {0};
    uint64_t seed = 23;
    for (size_t i = 0; i < 300; i++) {
        camber_made_scene_walk(&lines, &seed, 60, (const double[]){2, 30}, 1);
        camber_made_scene_end(&lines, 0);
    }
    camber_device *small = NULL;
    camber_renderer *renderers[2] = {fixture_any(s), NULL};
    camber_surface *surface = NULL;
    assert_int_equal(camber_device_create(s->context, &(camber_device_desc){.largest_buffer_bytes = 1 << 15}, &small),
                     CAMBER_OK);
    assert_int_equal(camber_surface_create(s->context, NULL, &surface), CAMBER_OK);
    assert_int_equal(camber_renderer_create(small, surface, &(camber_renderer_desc){.rasterizer = CAMBER_RASTERIZER_GL},
                                            &renderers[1]),
                     CAMBER_OK);
    for (int method = 0; method < 3; method++) {
        counts made[2][3];
        for (int i = 0; i < 2; i++) {
            const camber_tessellation_desc desc = {&stroke, 1, (camber_method)method, 0, false};
            camber_polylines *polylines = scene_polylines(s->context, &lines);
            camber_mesh *mesh = NULL;
            assert_int_equal(camber_mesh_create(i ? small : s->on.device, renderers[i], &mesh), CAMBER_OK);
            assert_int_equal(camber_mesh_tessellate(mesh, polylines, &desc), CAMBER_OK);
            assert_true(i == 0 ? mesh->part_count == 1 : mesh->part_count > 4);
            const uint64_t end = camber_mesh_get_info(mesh).index_count, third = end / 9 * 3;
            const camber_index_range all = {0, end},
                                     thirds[] = {{0, third}, {third, third}, {2 * third, end - 2 * third}};
            camber_overdraw_desc wanted = {
                .width = SEEN_PX, .height = SEEN_PX, .mesh = mesh, .paints = &paint, .paint_count = 1};
            made[i][0] = count(renderers[i], wanted);
            wanted.ranges = &all;
            wanted.range_count = 1;
            made[i][1] = count(renderers[i], wanted);
            wanted.ranges = thirds;
            wanted.range_count = 3;
            made[i][2] = count(renderers[i], wanted);
            camber_mesh_destroy(mesh);
            camber_polylines_destroy(polylines);
        }
        for (int k = 0; k < 3; k++) {
            assert_memory_equal(&made[0][k].sum, &made[1][k].sum, sizeof made[0][k].sum);
            assert_memory_equal(made[0][k].map, made[1][k].map, SEEN_PX * SEEN_PX);
            assert_true(made[0][k].sum.repeated_pixels > 1000);
            free(made[0][k].map);
            free(made[1][k].map);
        }
    }
    camber_renderer_destroy(renderers[1]);
    camber_surface_destroy(surface);
    camber_device_destroy(small);
    camber_made_scene_free(&lines);
}

/* Pictures drawn before and after a count are the same, on the same renderer. */
static void test_pictures_after(void **state) {
    fixture *s = *state;
    const camber_stroke stroke = {6, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0};
    const camber_paint paint = {.width_px = 6, .color = {1, 0.5f, 0, 0.5f}};
    for (int i = 0; i < CAMBER_FIXTURE_BACKENDS; i++) {
        if (!s->on.renderer[i])
            continue;
        camber_made_scene lines = {0};
        uint64_t seed = 4;
        camber_made_scene_walk(&lines, &seed, 100, (const double[]){5, 30}, 1);
        camber_made_scene_end(&lines, 0);
        camber_mesh *mesh = fixture_mesh(s, s->on.renderer[i], &lines,
                                         &(camber_tessellation_desc){&stroke, 1, CAMBER_METHOD_KITE, 0, false});
        const camber_pass pass = {.mesh = mesh, .paints = &paint, .paint_count = 1};
        const camber_frame frame = {.width = 1000, .height = 1000, .passes = &pass, .pass_count = 1};
        picture before = picture_draw(s->on.renderer[i], &frame);
        counts made =
            count(s->on.renderer[i],
                  (camber_overdraw_desc){.width = 70, .height = 70, .mesh = mesh, .paints = &paint, .paint_count = 1});
        picture after = picture_draw(s->on.renderer[i], &frame);
        picture_assert_same(&before, &after);
        free(made.map);
        picture_free(&before);
        picture_free(&after);
        camber_mesh_destroy(mesh);
        camber_made_scene_free(&lines);
    }
}

typedef struct attempt {
    camber_renderer *renderer;
    camber_overdraw_desc desc;
} attempt;

static camber_status attempt_count(camber_context *context, void *user) {
    (void)context;
    const attempt *a = user;
    camber_overdraw sum;
    return camber_renderer_count_overdraw(a->renderer, &a->desc, &sum);
}

static void test_no_memory(void **state) {
    fixture *s = *state;
    const camber_stroke stroke = {4, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    const camber_paint paint = {.width_px = 4, .color = {0, 0, 0, 1}};
    camber_made_scene lines = {0};
    add(&lines, 0, BAR, 2);
    attempt a = {.renderer = fixture_any(s)};
    camber_mesh *mesh =
        fixture_mesh(s, a.renderer, &lines, &(camber_tessellation_desc){&stroke, 1, CAMBER_METHOD_STRIP, 0, false});
    a.desc = (camber_overdraw_desc){.width = 64, .height = 64, .mesh = mesh, .paints = &paint, .paint_count = 1};
    each_allocation_fails(&s->h, attempt_count, s->context, &a);
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&lines);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bar),           cmocka_unit_test(test_crossing),
        cmocka_unit_test(test_two_polylines), cmocka_unit_test(test_slanted_crossings),
        cmocka_unit_test(test_bends),         cmocka_unit_test(test_reversal),
        cmocka_unit_test(test_layers),        cmocka_unit_test(test_layers_of_one),
        cmocka_unit_test(test_full_map),      cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_paints),        cmocka_unit_test(test_nothing),
        cmocka_unit_test(test_pieces),        cmocka_unit_test(test_backends_agree),
        cmocka_unit_test(test_parts),         cmocka_unit_test(test_pictures_after),
        cmocka_unit_test(test_no_memory),
    };
    return FIXTURE_RUN(tests);
}
