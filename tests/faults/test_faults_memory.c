/* The n-th allocation fails, for every n, in all of libcamber: the status says so in one line, nothing is kept, inputs
 * stay as they are, what comes out in spite of it is right, and what failed works afterwards. test_faults_map.c does
 * the same for libcamber-map. */
#include "pictures.h"

enum { WIDTH = 80, HEIGHT = 60, PIECE_PX = 32, ROWS = 3 };

/* The input of an attempt, and what came of it the first time. */
typedef struct desk {
    fixture s;
    camber_made_scene lines;
    camber_polylines *polylines;
    camber_mesh_data mesh; /* of the twin */
    camber_stages stages;
    uint8_t rgba[4 * WIDTH * HEIGHT];
    camber_overdraw overdraw;
    byte_list file; /* a polyline file */
    byte_list png;
    int backend; /* CAMBER_FIXTURE_BACKENDS: kernels draw */
    bool known;  /* rgba and overdraw are there */
} desk;

static const camber_stroke STROKES[ROWS] = {{9, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0},
                                            {6, CAMBER_JOIN_MITER, CAMBER_CAP_ROUND, 0},
                                            {4, CAMBER_JOIN_BEVEL, CAMBER_CAP_SQUARE, .offset_px = 5}};
static const camber_tessellation_desc STRIPS = {STROKES, ROWS, CAMBER_METHOD_STRIP, 0, false};

static void assert_same_mesh(const camber_mesh_data *a, const camber_mesh_data *b) {
    assert_true(a->info.vertex_count == b->info.vertex_count && a->info.index_count == b->info.index_count);
    assert_memory_equal(a->vertices, b->vertices, a->info.vertex_count * sizeof *a->vertices);
    assert_memory_equal(a->indices, b->indices, a->info.index_count * sizeof *a->indices);
    assert_true(a->info.joins == b->info.joins && a->info.tight_joins == b->info.tight_joins &&
                a->info.triangle_count == b->info.triangle_count);
}

static void assert_same_stages(const camber_stages *a, const camber_stages *b) {
    assert_int_equal(a->point_count, b->point_count);
    assert_memory_equal(a->points, b->points, a->point_count * sizeof *a->points);
}

/* ---- Lines ---- */

static camber_status try_lines(camber_context *context, void *user) {
    desk *d = user;
    camber_lines lines = {0}, simplified = {0};
    byte_list again = {.refuse_at = SIZE_MAX};
    camber_status status = camber_lines_parse(context, d->file.bytes, d->file.size, "lines", &lines);
    if (status == CAMBER_OK)
        status = camber_lines_simplify(context, &lines, 0, &simplified);
    if (status == CAMBER_OK)
        status = camber_lines_write(context, &simplified, (camber_sink){byte_list_write, &again});
    if (status == CAMBER_OK) {
        assert_int_equal(again.size, d->file.size);
        assert_memory_equal(again.bytes, d->file.bytes, again.size);
    }
    free(again.bytes);
    camber_lines_destroy(&simplified);
    camber_lines_destroy(&lines);
    return status;
}

static camber_status try_polylines(camber_context *context, void *user) {
    desk *d = user;
    camber_polylines *const untouched = (camber_polylines *)(void *)d;
    camber_polylines *made = untouched;
    const camber_made_scene *s = &d->lines;
    const camber_polylines_desc desc = {s->points, s->point_count, s->offsets, s->polyline_count, s->rows, false};
    const camber_status status = camber_polylines_create(context, &desc, &made);
    if (status != CAMBER_OK) {
        assert_ptr_equal(made, untouched);
        return status;
    }
    const camber_polylines_stats stats = camber_polylines_get_stats(made);
    const camber_polylines_stats wanted = camber_polylines_get_stats(d->polylines);
    assert_memory_equal(&stats, &wanted, sizeof stats);
    assert_int_equal(made->slot_count, d->polylines->slot_count);
    assert_memory_equal(made->x, d->polylines->x, made->slot_count * sizeof *made->x);
    assert_memory_equal(made->info, d->polylines->info, made->slot_count * sizeof *made->info);
    camber_polylines_destroy(made);
    return status;
}

/* ---- Tessellation ---- */

static camber_status try_twin(camber_context *context, void *user) {
    desk *d = user;
    camber_mesh_data mesh = {.vertices = (camber_vertex *)(uintptr_t)8};
    camber_stages stages = {.point_count = 7};
    camber_status status = camber_mesh_data_tessellate(context, d->polylines, &STRIPS, &mesh);
    if (status != CAMBER_OK) {
        assert_ptr_equal(mesh.vertices, (camber_vertex *)(uintptr_t)8);
        return status;
    }
    assert_same_mesh(&mesh, &d->mesh);
    camber_mesh_data_destroy(&mesh);
    status = camber_stages_tessellate(context, d->polylines, &STRIPS, &stages);
    if (status != CAMBER_OK) {
        assert_true(stages.point_count == 7 && !stages.points);
        return status;
    }
    assert_same_stages(&stages, &d->stages);
    camber_stages_destroy(&stages);
    return status;
}

/* A mesh of the device, read back. */
static camber_status read_all(camber_mesh *mesh, const desk *d) {
    camber_mesh_data data = {.indices = (uint32_t *)(uintptr_t)8};
    camber_stages stages = {.point_count = 7};
    camber_status status = camber_mesh_read(mesh, &data);
    if (status != CAMBER_OK) {
        assert_ptr_equal(data.indices, (uint32_t *)(uintptr_t)8);
        return status;
    }
    assert_same_mesh(&data, &d->mesh);
    camber_mesh_data_destroy(&data);
    status = camber_mesh_read_stages(mesh, &stages);
    if (status != CAMBER_OK) {
        assert_true(stages.point_count == 7 && !stages.points);
        return status;
    }
    assert_same_stages(&stages, &d->stages);
    camber_stages_destroy(&stages);
    return status;
}

/* A device of its own, so that the kernels are built or loaded under the fault too. */
static camber_status try_device(camber_context *context, void *user) {
    desk *d = user;
    camber_device *device = NULL;
    camber_mesh *mesh = NULL;
    camber_status status = camber_device_create(context, NULL, &device);
    if (status == CAMBER_OK)
        status = camber_mesh_create(device, NULL, &mesh);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate(mesh, d->polylines, &STRIPS);
    if (status == CAMBER_OK)
        status = read_all(mesh, d);
    camber_mesh_destroy(mesh);
    camber_device_destroy(device);
    return status;
}

/* ---- Drawing ---- */

typedef struct taker {
    desk *d;
    uint32_t rows;
} taker;

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    taker *t = user;
    uint8_t *wanted = t->d->rgba + 4 * WIDTH * (size_t)first_row;
    assert_true(first_row == t->rows && row_count <= HEIGHT - first_row);
    if (t->d->known)
        assert_memory_equal(rgba, wanted, 4 * WIDTH * (size_t)row_count);
    else
        memcpy(wanted, rgba, 4 * WIDTH * (size_t)row_count);
    t->rows += row_count;
    return true;
}

static camber_status draw(camber_renderer *renderer, camber_mesh *mesh, desk *d) {
    static const camber_paint solid[ROWS] = {{.width_px = 9, .color = {1, 0, 0, 1}},
                                             {.width_px = 6, .color = {0, 1, 0, 1}},
                                             {.width_px = 4, .color = {0, 0, 1, 1}}};
    static const camber_paint mixed[ROWS] = {{.width_px = 5, .color = {1, 1, 0, 0.4f}},
                                             {.width_px = 5, .color = {0, 1, 1, 0.4f}},
                                             {.width_px = 4, .color = {1, 0, 1, 0.7f}}};
    const camber_pass passes[] = {
        {.mesh = mesh, .paints = solid, .paint_count = ROWS},
        {.mesh = mesh, .paints = mixed, .paint_count = ROWS},
        {.mesh = mesh, .paints = mixed, .paint_count = ROWS, .overlap = CAMBER_OVERLAP_ACCUMULATE}};
    const camber_frame frame = {.width = WIDTH,
                                .height = HEIGHT,
                                .background = {1, 1, 1, 1},
                                .passes = passes,
                                .pass_count = 3,
                                .largest_area_px = PIECE_PX};
    taker t = {d, 0};
    camber_status status = camber_renderer_render(renderer, &frame, take_rows, &t, NULL);
    if (status != CAMBER_OK)
        return status;
    assert_int_equal(t.rows, HEIGHT);
    if (camber_renderer_get_rasterizer(renderer) == CAMBER_RASTERIZER_OPENCL)
        return CAMBER_OK;
    camber_overdraw overdraw = {0};
    status = camber_renderer_count_overdraw(
        renderer,
        &(camber_overdraw_desc){.width = WIDTH, .height = HEIGHT, .mesh = mesh, .paints = solid, .paint_count = ROWS},
        &overdraw);
    if (status != CAMBER_OK)
        return status;
    if (d->known)
        assert_memory_equal(&overdraw, &d->overdraw, sizeof overdraw);
    d->overdraw = overdraw;
    return status;
}

static camber_status try_drawing(camber_context *context, void *user) {
    desk *d = user;
    camber_surface *surface = NULL;
    camber_renderer *renderer = NULL;
    camber_mesh *mesh = NULL;
    const bool in_cl = d->backend == CAMBER_FIXTURE_BACKENDS;
    const camber_renderer_desc desc = {.rasterizer = in_cl ? CAMBER_RASTERIZER_OPENCL : CAMBER_RASTERIZER_GL};
    camber_status status = CAMBER_OK;
    if (!in_cl)
        status = camber_surface_create(context, &(camber_surface_desc){fixture_backend(d->backend)}, &surface);
    if (status == CAMBER_OK)
        status = camber_renderer_create(d->s.on.device, surface, &desc, &renderer);
    if (status == CAMBER_OK)
        status = camber_mesh_create(d->s.on.device, renderer, &mesh);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate(mesh, d->polylines, &STRIPS);
    if (status == CAMBER_OK)
        status = draw(renderer, mesh, d);
    camber_mesh_destroy(mesh);
    camber_renderer_destroy(renderer);
    camber_surface_destroy(surface);
    return status;
}

/* The first back end that is there stands in for one that finds no memory: it must not. */
static camber_status try_any_surface(camber_context *context, void *user) {
    (void)user;
    camber_surface *surface = NULL;
    const camber_status status = camber_surface_create(context, NULL, &surface);
    camber_surface_destroy(surface);
    return status;
}

/* ---- PNG ---- */

static camber_status write_png(camber_context *context, const desk *d, byte_list *file) {
    const camber_png_text texts[] = {{"Software", "camber"}, {"Copyright", "\xc2\xa9 nobody"}};
    const camber_png_desc desc = {.width = WIDTH, .height = HEIGHT, .texts = texts, .text_count = 2};
    camber_png *png = NULL;
    camber_status status = camber_png_create(context, &desc, (camber_sink){byte_list_write, file}, &png);
    if (status != CAMBER_OK)
        return status;
    status = camber_png_write_rows(png, d->rgba, HEIGHT / 2);
    if (status == CAMBER_OK)
        status = camber_png_write_rows(png, d->rgba + 4 * WIDTH * (HEIGHT / 2), HEIGHT - HEIGHT / 2);
    if (status == CAMBER_OK)
        status = camber_png_finish(png);
    else
        assert_int_equal(camber_png_finish(png), status); /* once failed, it stays so */
    camber_png_destroy(png);
    return status;
}

static camber_status try_png(camber_context *context, void *user) {
    desk *d = user;
    byte_list file = {.refuse_at = SIZE_MAX};
    const camber_status status = write_png(context, d, &file);
    if (status == CAMBER_OK) {
        assert_int_equal(file.size, d->png.size);
        assert_memory_equal(file.bytes, d->png.bytes, file.size);
    }
    free(file.bytes);
    return status;
}

/* ---- All of them ---- */

static int set_up(void **state) {
    desk *d = calloc(1, sizeof *d);
    assert_non_null(d);
    assert_true(fixture_open(&d->s));
    uint64_t seed = 8;
    for (size_t i = 0; i < 40; i++) {
        camber_made_scene_walk(&d->lines, &seed, 12, (const double[]){4, 30}, 2);
        camber_made_scene_end(&d->lines, i % ROWS);
    }
    for (size_t i = 0; i < 2 * d->lines.point_count; i++)
        d->lines.points[i] = fmodf(fabsf(d->lines.points[i]), i % 2 ? HEIGHT : WIDTH);
    const camber_lines lines = {.points = d->lines.points,
                                .offsets = d->lines.offsets,
                                .point_count = d->lines.point_count,
                                .polyline_count = d->lines.polyline_count};
    d->file.refuse_at = d->png.refuse_at = SIZE_MAX;
    assert_int_equal(camber_lines_write(d->s.context, &lines, (camber_sink){byte_list_write, &d->file}), CAMBER_OK);
    d->polylines = scene_polylines(d->s.context, &d->lines);
    assert_int_equal(camber_mesh_data_tessellate(d->s.context, d->polylines, &STRIPS, &d->mesh), CAMBER_OK);
    assert_int_equal(camber_stages_tessellate(d->s.context, d->polylines, &STRIPS, &d->stages), CAMBER_OK);
    for (size_t i = 0; i < sizeof d->rgba; i++)
        d->rgba[i] = (uint8_t)(i % 4 == 3 ? 255 : camber_random_bits(&seed));
    assert_int_equal(write_png(d->s.context, d, &d->png), CAMBER_OK);
    *state = d;
    return 0;
}

static int tear_down(void **state) {
    desk *d = *state;
    camber_stages_destroy(&d->stages);
    camber_mesh_data_destroy(&d->mesh);
    camber_polylines_destroy(d->polylines);
    camber_made_scene_free(&d->lines);
    free(d->file.bytes);
    free(d->png.bytes);
    fixture_close(&d->s);
    assert_int_equal(d->s.h.live_blocks, 0);
    free(d);
    return 0;
}

/* Nothing that an attempt reads has changed. */
static uint64_t hash_inputs(const desk *d) {
    uint64_t hash = camber_hash(CAMBER_HASH_START, d->file.bytes, d->file.size);
    hash = camber_hash(hash, d->lines.points, 2 * d->lines.point_count * sizeof *d->lines.points);
    hash = camber_hash(hash, d->lines.offsets, (d->lines.polyline_count + 1) * sizeof *d->lines.offsets);
    hash = camber_hash(hash, d->lines.rows, d->lines.polyline_count * sizeof *d->lines.rows);
    hash = camber_hash(hash, d->polylines->x, d->polylines->slot_count * sizeof *d->polylines->x);
    hash = camber_hash(hash, d->polylines->y, d->polylines->slot_count * sizeof *d->polylines->y);
    return camber_hash(hash, d->polylines->info, d->polylines->slot_count * sizeof *d->polylines->info);
}

static void each_fails(desk *d, camber_status (*attempt)(camber_context *context, void *user)) {
    const uint64_t inputs = hash_inputs(d);
    assert_int_equal(attempt(d->s.context, d), CAMBER_OK);
    each_allocation_fails(&d->s.h, attempt, d->s.context, d);
    assert_true(hash_inputs(d) == inputs);
}

static void test_on_host(void **state) {
    each_fails(*state, try_lines);
    each_fails(*state, try_polylines);
    each_fails(*state, try_twin);
    each_fails(*state, try_png);
}

static void test_on_device(void **state) {
    each_fails(*state, try_device);
}

/* Around a cache: from an empty one, which each attempt fills, and from a full one. */
static void test_with_cache(void **state) {
    desk *d = *state;
    char folder[64];
    folder_make(folder);
    camber_context_desc desc = host_desc(&d->s.h);
    desc.cache_dir = folder;
    camber_context *context = NULL;
    assert_int_equal(camber_context_create(&desc, &context), CAMBER_OK);
    for (int full = 0; full < 2; full++) {
        d->s.h.refuse_first = 0;
        for (size_t n = 1;; n++) {
            if (!full) {
                folder_remove(folder);
                assert_int_equal(mkdir(folder, 0700), 0);
            }
            const size_t live = d->s.h.live_blocks, refused = d->s.h.refuse_first = d->s.h.calls + n;
            d->s.h.refuse_count = 1;
            const camber_status status = try_device(context, d);
            d->s.h.refuse_first = 0;
            assert_int_equal(d->s.h.live_blocks, live);
            if (status != CAMBER_OK) {
                assert_int_equal(status, CAMBER_ERROR_MEMORY);
                assert_story(&d->s.h, "memory");
                continue;
            }
            assert_int_equal(d->s.h.errors, 0); /* the cache does without, and says nothing */
            if (d->s.h.calls < refused)
                break;
        }
        assert_int_not_equal(rmdir(folder), 0); /* something has been saved */
    }
    camber_context_destroy(context);
    folder_remove(folder);
}

static void test_drawing(void **state) {
    desk *d = *state;
    each_fails(d, try_any_surface);
    for (d->backend = 0; d->backend <= CAMBER_FIXTURE_BACKENDS; d->backend++) {
        if (d->backend < CAMBER_FIXTURE_BACKENDS && !d->s.on.renderer[d->backend])
            continue;
        d->known = false;
        assert_int_equal(try_drawing(d->s.context, d), CAMBER_OK);
        d->known = true;
        each_fails(d, try_drawing);
    }
}

/* One renderer and one mesh through all failures: each is followed by a success with the same objects. */
static void test_same_objects(void **state) {
    desk *d = *state;
    host *h = &d->s.h;
    d->known = false;
    for (int i = 0; i <= CAMBER_FIXTURE_BACKENDS; i++) {
        const bool in_cl = i == CAMBER_FIXTURE_BACKENDS;
        const camber_renderer_desc desc = {.rasterizer = in_cl ? CAMBER_RASTERIZER_OPENCL : CAMBER_RASTERIZER_GL};
        camber_renderer *renderer = NULL;
        if (!in_cl && !d->s.on.renderer[i])
            continue;
        assert_int_equal(camber_renderer_create(d->s.on.device, in_cl ? NULL : d->s.on.surface[i], &desc, &renderer),
                         CAMBER_OK);
        size_t n = 1;
        for (bool reached = true; reached; n++) {
            camber_mesh *mesh = NULL;
            assert_int_equal(camber_mesh_create(d->s.on.device, renderer, &mesh), CAMBER_OK);
            h->refuse_first = h->calls + n;
            h->refuse_count = 1;
            camber_status status = camber_mesh_tessellate(mesh, d->polylines, &STRIPS);
            if (status == CAMBER_OK)
                status = read_all(mesh, d);
            if (status == CAMBER_OK && d->known)
                status = draw(renderer, mesh, d);
            reached = h->calls >= h->refuse_first;
            h->refuse_first = 0;
            if (status != CAMBER_OK) {
                assert_int_equal(status, CAMBER_ERROR_MEMORY);
                assert_story(h, "memory");
            }
            assert_int_equal(camber_mesh_tessellate(mesh, d->polylines, &STRIPS), CAMBER_OK);
            assert_int_equal(read_all(mesh, d), CAMBER_OK);
            assert_int_equal(draw(renderer, mesh, d), CAMBER_OK);
            assert_int_equal(h->errors, 0);
            d->known = true;
            camber_mesh_destroy(mesh);
        }
        assert_true(n > 5);
        camber_renderer_destroy(renderer);
        d->known = false;
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_on_host), cmocka_unit_test(test_on_device),    cmocka_unit_test(test_with_cache),
        cmocka_unit_test(test_drawing), cmocka_unit_test(test_same_objects),
    };
    if (!fixture_begin())
        return 77;
    const int failed = cmocka_run_group_tests(tests, set_up, tear_down);
    return failed;
}
