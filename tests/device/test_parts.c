/* Meshes in parts and work-groups of other sizes: what is read, told and drawn is the same as of one part of 256s; no
 * buffer is larger than allowed; what fits no part is refused by name. */
#include "pictures.h"

#include "cl_calls.h"

#include "draw/renderer.h"
#include "gpu/opencl/opencl.h"
#include "vertices/vertices.h"

/* ---- Watching OpenCL ---- */

static cl_context watched;
static cl_command_queue watched_queue;
static size_t largest_buffer, writes; /* of the watched one */

static cl_mem watch_buffer(cl_context context, cl_mem_flags flags, size_t size, void *memory, cl_int *code) {
    if (context == watched && size > largest_buffer)
        largest_buffer = size;
    return cl_real.CreateBuffer(context, flags, size, memory, code);
}

static cl_int watch_write(cl_command_queue queue, cl_mem mem, cl_bool blocking, size_t offset, size_t size,
                          const void *bytes, cl_uint wait_count, const cl_event *waits, cl_event *event) {
    writes += queue == watched_queue;
    return cl_real.EnqueueWriteBuffer(queue, mem, blocking, offset, size, bytes, wait_count, waits, event);
}

static void cl_take(void) {
    camber_cl.CreateBuffer = watch_buffer;
    camber_cl.EnqueueWriteBuffer = watch_write;
}

/* ---- Meshes and what is known of them ---- */

static void bounded_open(fixture *b, uint64_t largest_buffer_bytes, uint32_t work_group_size) {
    const camber_device_desc desc = {.work_group_size = work_group_size, .largest_buffer_bytes = largest_buffer_bytes};
    fixture_open_mesh(b, &desc);
    watched = opencl_of(b->on.device)->cl;
    watched_queue = opencl_of(b->on.device)->queue;
    largest_buffer = 0;
}

static void bounded_close(fixture *b) {
    if (watched == opencl_of(b->on.device)->cl)
        assert_true(largest_buffer > 0 && largest_buffer <= camber_device_get_info(b->on.device).largest_buffer_bytes);
    fixture_close(b);
}

typedef struct result {
    camber_mesh_data mesh;
    camber_stages stages;
    size_t parts;
} result;

static result read_result(fixture *b) {
    result r = {.parts = b->mesh->part_count};
    assert_int_equal(camber_mesh_read(b->mesh, &r.mesh), CAMBER_OK);
    assert_int_equal(camber_mesh_read_stages(b->mesh, &r.stages), CAMBER_OK);
    const camber_mesh_info told = camber_mesh_get_info(b->mesh);
    assert_memory_equal(&told, &r.mesh.info, sizeof told);
    return r;
}

static result tessellate(fixture *b, const camber_made_scene *s, const camber_tessellation_desc *desc) {
    camber_polylines *polylines = scene_polylines(b->context, s);
    assert_int_equal(camber_mesh_tessellate(b->mesh, polylines, desc), CAMBER_OK);
    camber_polylines_destroy(polylines);
    return read_result(b);
}

static void free_result(result *r) {
    camber_mesh_data_destroy(&r->mesh);
    camber_stages_destroy(&r->stages);
}

static void assert_same(const result *a, const result *b) {
    camber_mesh_info x = a->mesh.info, y = b->mesh.info;
    x.times = y.times = (camber_stage_times){0};
    assert_memory_equal(&x, &y, sizeof x);
    assert_memory_equal(a->mesh.records, b->mesh.records, x.record_count * sizeof *a->mesh.records);
    if (a->mesh.corners)
        assert_memory_equal(a->mesh.corners, b->mesh.corners, x.index_count * sizeof *a->mesh.corners);
    for (size_t i = 0; i < x.vertex_count; i++)
        if (memcmp(a->mesh.vertices + i, b->mesh.vertices + i, sizeof *a->mesh.vertices) != 0)
            fail_msg("%zu and %zu parts: vertex %zu of %zu differs", a->parts, b->parts, i, x.vertex_count);
    for (size_t i = 0; i < x.index_count; i++)
        if (a->mesh.indices[i] != b->mesh.indices[i])
            fail_msg("%zu and %zu parts: index %zu of %zu: %u, %u", a->parts, b->parts, i, x.index_count,
                     a->mesh.indices[i], b->mesh.indices[i]);
    assert_int_equal(a->stages.point_count, b->stages.point_count);
    for (size_t i = 0; i < a->stages.point_count; i++)
        if (memcmp(a->stages.points + i, b->stages.points + i, sizeof *a->stages.points) != 0)
            fail_msg("%zu and %zu parts: point %zu of %zu differs", a->parts, b->parts, i, a->stages.point_count);
}

/* Lines, rings, dots, empty polylines, split ones. */
static camber_made_scene make_scene(int repeats) {
    camber_made_scene s = {0};
    uint64_t seed = 21;
    for (int i = 0; i < repeats; i++) {
        camber_scene_add_walks(&s, &seed);
        camber_scene_add_degenerate(&s, &seed);
        camber_scene_add_rings(&s, &seed);
    }
    return s;
}

/* ---- Bytes ---- */

static uint64_t larger_buffer(const camber_mesh_info *info) {
    const uint64_t records = info->record_count * sizeof(camber_record), indices = info->bytes - records;
    return records > indices ? records : indices;
}

static void test_same_bytes(void **state) {
    (void)state;
    static const uint64_t limits[] = {UINT64_MAX, 1 << 18, 100000, 1 << 15, 10000};
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    camber_made_scene s = make_scene(3);
    fixture whole;
    bounded_open(&whole, 0, 0);
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        fixture b;
        size_t parts[3];
        bounded_open(&b, limits[i], 0);
        for (int method = 0; method < 3; method++) {
            const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, (camber_method)method, 0, false};
            result wanted = tessellate(&whole, &s, &desc), r = tessellate(&b, &s, &desc);
            assert_same(&r, &wanted);
            assert_int_equal(wanted.parts, 1);
            parts[method] = r.parts;
            /* Not more parts than twice what the bytes take: each but the last is as full as whole polylines allow. */
            const uint64_t bytes = larger_buffer(&r.mesh.info);
            assert_true(r.parts >= bytes / limits[i] + 1 && r.parts <= 2 * (bytes / limits[i] + 1));
            free_result(&r);
            free_result(&wanted);
        }
        print_message("%llu bytes: %zu, %zu, %zu parts, no buffer above %zu\n", (unsigned long long)limits[i], parts[0],
                      parts[1], parts[2], largest_buffer);
        bounded_close(&b);
    }
    bounded_close(&whole);
    camber_made_scene_free(&s);
}

static void test_work_groups(void **state) {
    (void)state;
    static const uint32_t sizes[] = {64, 128, 256};
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    fixture whole;
    bounded_open(&whole, 0, 0);
    size_t parts = 0;
    for (size_t i = 0; i < 6; i++) { /* the second three in parts */
        fixture b;
        bounded_open(&b, i < 3 ? 0 : 1 << 18, sizes[i % 3]);
        for (size_t which = 0; which < CAMBER_KERNEL_SCENES; which++) {
            if (i >= 3 && which == 1)
                continue; /* a line that fits no part */
            camber_made_scene s = scene_make(which);
            for (int method = 0; method < 3; method++) {
                const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, (camber_method)method, 0, false};
                result wanted = tessellate(&whole, &s, &desc), r = tessellate(&b, &s, &desc);
                assert_same(&r, &wanted);
                parts += i < 3 ? 0 : r.parts - 1;
                free_result(&r);
                free_result(&wanted);
            }
            camber_made_scene_free(&s);
        }
        bounded_close(&b);
    }
    assert_true(parts > 10);
    bounded_close(&whole);
}

/* Borders of parts fall on rings, dots and empty polylines, with one and with several of them in a part. */
static void test_borders(void **state) {
    (void)state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    strokes[8].width_px = 30;
    camber_made_scene s = {0};
    uint64_t seed = 5;
    for (int i = 0; i < 5; i++)
        camber_made_scene_end(&s, 0); /* empty ones first, last, and between */
    camber_scene_add_degenerate(&s, &seed);
    camber_scene_add_rings(&s, &seed);
    for (int i = 0; i < 40; i++) {
        camber_made_scene_end(&s, 3);
        camber_made_scene_point(&s, i, i);
        camber_made_scene_end(&s, (size_t)i % CAMBER_KERNEL_ROWS);
    }
    for (int i = 0; i < 80; i++) { /* rings behind open lines, whose ends are none of theirs */
        for (int k = 0; k <= 3 + i % 5; k++)
            camber_made_scene_point(&s, 30 * k, i % 7);
        camber_made_scene_end(&s, 3);
        for (int k = 0; k <= 8; k++)
            camber_made_scene_point(&s, 50 * cos(k % 8 * SCENE_PI / 4), 50 * sin(k % 8 * SCENE_PI / 4));
        camber_made_scene_end(&s, (size_t)i % CAMBER_KERNEL_ROWS);
    }
    for (int i = 0; i < 300; i++)
        camber_made_scene_end(&s, 0);
    fixture whole;
    bounded_open(&whole, 0, 0);
    result wanted[3];
    size_t borders = 0;
    for (int method = 0; method < 3; method++)
        wanted[method] = tessellate(
            &whole, &s, &(camber_tessellation_desc){strokes, CAMBER_KERNEL_ROWS, (camber_method)method, 0, false});
    for (uint64_t limit = 7000; limit < 14000; limit += 622) {
        fixture b;
        bounded_open(&b, limit, limit % 2 ? 64 : 256);
        for (int method = 0; method < 3; method++) {
            result r = tessellate(
                &b, &s, &(camber_tessellation_desc){strokes, CAMBER_KERNEL_ROWS, (camber_method)method, 0, false});
            assert_same(&r, wanted + method);
            borders += r.parts - 1;
            free_result(&r);
        }
        bounded_close(&b);
    }
    assert_true(borders > 500);
    for (int method = 0; method < 3; method++)
        free_result(wanted + method);
    bounded_close(&whole);
    camber_made_scene_free(&s);
}

static void test_first_index(void **state) {
    (void)state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    camber_made_scene s = make_scene(1);
    fixture b, whole;
    bounded_open(&whole, 0, 0);
    bounded_open(&b, 30000, 128);
    for (int method = 0; method < 3; method += 2) {
        const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, (camber_method)method, 0, false};
        result wanted = tessellate(&whole, &s, &desc), r = tessellate(&b, &s, &desc);
        for (size_t i = 0; i <= s.polyline_count; i++) {
            uint64_t first, first_of_whole;
            assert_int_equal(camber_mesh_first_index(b.mesh, i, &first), CAMBER_OK);
            assert_int_equal(camber_mesh_first_index(whole.mesh, i, &first_of_whole), CAMBER_OK);
            assert_true(first == first_of_whole);
        }
        free_result(&r);
        free_result(&wanted);
    }
    bounded_close(&b);
    bounded_close(&whole);
    camber_made_scene_free(&s);
}

static void test_nothing(void **state) {
    (void)state;
    const camber_stroke stroke = {2, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
    const camber_tessellation_desc desc = {&stroke, 1, CAMBER_METHOD_STRIP, 0, false};
    fixture b;
    bounded_open(&b, 4096, 0);
    camber_made_scene s = {0};
    for (int i = 0; i < 3000; i++) {
        result r = {.parts = 0};
        if (i % 1000 == 0) { /* none; then dots that nothing is drawn of: parts without output */
            r = tessellate(&b, &s, &desc);
            assert_int_equal(r.mesh.info.vertex_count, 0);
            assert_int_equal(r.mesh.info.undrawn_dots, i);
            assert_int_equal(r.stages.point_count, i);
            assert_true(i ? r.parts > 1 : r.parts == 0);
            free_result(&r);
        }
        camber_made_scene_point(&s, i, 0);
        camber_made_scene_end(&s, 0);
    }
    camber_made_scene_free(&s);
    bounded_close(&b);
}

/* ---- Again and again ---- */

static result again(fixture *b, const camber_polylines *polylines, const camber_tessellation_desc *desc,
                    size_t *count) {
    writes = 0;
    assert_int_equal(camber_mesh_tessellate(b->mesh, polylines, desc), CAMBER_OK);
    *count = writes;
    return read_result(b);
}

/* Other strokes and methods over the same polylines, other polylines between: the same bytes as of a new mesh.
 * Polylines that are there are not uploaded again: strokes once, and the bases of each part. A device that works in the
 * host's memory reads those of a single part in place. */
static void test_again(void **state) {
    (void)state;
    static const uint64_t limits[] = {0, 100000};
    camber_stroke wide[CAMBER_KERNEL_ROWS], narrow[CAMBER_KERNEL_ROWS];
    scene_strokes(wide);
    for (int i = 0; i < CAMBER_KERNEL_ROWS; i++)
        narrow[i] = (camber_stroke){0.5f, CAMBER_JOIN_MITER, CAMBER_CAP_SQUARE, 0};
    camber_made_scene scenes[] = {make_scene(2), scene_make(3), make_scene(1)};
    const struct {
        size_t scene;
        camber_method method;
        const camber_stroke *strokes;
    } steps[] = {
        {0, CAMBER_METHOD_STRIP, wide}, {0, CAMBER_METHOD_STRIP, narrow}, {0, CAMBER_METHOD_FAN, wide},
        {0, CAMBER_METHOD_FAN, wide},   {0, CAMBER_METHOD_STRIP, wide},   {1, CAMBER_METHOD_KITE, wide},
        {2, CAMBER_METHOD_FAN, wide},   {0, CAMBER_METHOD_KITE, narrow},  {1, CAMBER_METHOD_STRIP, narrow},
        {1, CAMBER_METHOD_STRIP, wide},
    };
    for (size_t k = 0; k < 2; k++) {
        fixture b, whole;
        camber_polylines *polylines[3];
        bounded_open(&whole, 0, 0);
        bounded_open(&b, limits[k], 0);
        for (size_t i = 0; i < 3; i++)
            polylines[i] = scene_polylines(b.context, scenes + i);
        size_t parts = 0, count;
        for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
            const camber_tessellation_desc desc = {steps[i].strokes, CAMBER_KERNEL_ROWS, steps[i].method, 0, false};
            result wanted = tessellate(&whole, scenes + steps[i].scene, &desc);
            result r = again(&b, polylines[steps[i].scene], &desc, &count);
            assert_same(&r, &wanted);
            const bool same = i && steps[i].scene == steps[i - 1].scene && r.parts == parts;
            parts = r.parts;
            assert_true(k ? parts > 1 : parts == 1);
            if (same)
                assert_int_equal(count, 1 + parts);
            else if (!i || steps[i].scene != steps[i - 1].scene)
                assert_true(parts == 1 && b.on.device->host_memory ? count == 4 : count >= 1 + 6 * parts);
            if (i == 4) /* what the fan needed is kept for the strip */
                assert_true(same);
            free_result(&r);
            free_result(&wanted);
        }
        for (size_t i = 0; i < 3; i++)
            camber_polylines_destroy(polylines[i]);
        bounded_close(&b);
        bounded_close(&whole);
    }
    for (size_t i = 0; i < 3; i++)
        camber_made_scene_free(scenes + i);
}

/* ---- Limits ---- */

static void test_too_long(void **state) {
    (void)state;
    const camber_stroke stroke = {2, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0};
    /* 20,000 points take 80 kB of input; 4200 take 17 kB, and 67 kB of records; 1400 take 22 kB as a strip, and more
     * than 64 KiB of indices otherwise. */
    static const size_t lengths[] = {20000, 4200, 1400};
    for (size_t k = 0; k < 3; k++) {
        fixture b;
        camber_made_scene s = {0}, lines = make_scene(1);
        uint64_t seed = 2;
        bounded_open(&b, 1 << 16, 0);
        for (size_t i = 0; i < 60; i++) {
            camber_made_scene_walk(&s, &seed, i == 41 ? lengths[k] : 30, (const double[]){5, 50}, 1);
            camber_made_scene_end(&s, 0);
        }
        camber_polylines *polylines = scene_polylines(b.context, &s), *others = scene_polylines(b.context, &lines);
        for (int method = 0; method < 3; method++) {
            const camber_tessellation_desc desc = {&stroke, 1, (camber_method)method, 0, false};
            const bool fits = k == 2 && method == CAMBER_METHOD_STRIP;
            for (int time = 0; time < 2; time++) {
                assert_int_equal(camber_mesh_tessellate(b.mesh, polylines, &desc),
                                 fits ? CAMBER_OK : CAMBER_ERROR_LIMIT);
                if (fits)
                    continue;
                assert_story(&b.h, "polyline 41 ");
                camber_mesh_data none;
                camber_stages no_stages;
                assert_int_equal(camber_mesh_read(b.mesh, &none), CAMBER_OK);
                assert_int_equal(camber_mesh_read_stages(b.mesh, &no_stages), CAMBER_OK);
                assert_int_equal(none.info.vertex_count + none.info.joins + no_stages.point_count, 0);
                camber_mesh_data_destroy(&none);
                camber_stages_destroy(&no_stages);
            }
            camber_stroke strokes[CAMBER_KERNEL_ROWS];
            scene_strokes(strokes);
            const camber_tessellation_desc next = {strokes, CAMBER_KERNEL_ROWS, (camber_method)method, 0, false};
            camber_mesh_data mesh, twin;
            assert_int_equal(camber_mesh_tessellate(b.mesh, others, &next), CAMBER_OK);
            assert_int_equal(camber_mesh_read(b.mesh, &mesh), CAMBER_OK);
            assert_int_equal(camber_mesh_data_tessellate(b.context, others, &next, &twin), CAMBER_OK);
            assert_int_equal(mesh.info.vertex_count, twin.info.vertex_count);
            assert_memory_equal(mesh.indices, twin.indices, twin.info.index_count * sizeof *twin.indices);
            camber_mesh_data_destroy(&mesh);
            camber_mesh_data_destroy(&twin);
        }
        camber_polylines_destroy(polylines);
        camber_polylines_destroy(others);
        camber_made_scene_free(&lines);
        camber_made_scene_free(&s);
        bounded_close(&b);
    }
}

static void test_too_many_strokes(void **state) {
    (void)state;
    enum { STROKES = 128 }; /* and one that is never read: 4128 bytes */
    static camber_stroke strokes[STROKES];
    fixture b;
    bounded_open(&b, 4096, 0);
    camber_made_scene s = {0};
    camber_made_scene_point(&s, 0, 0);
    camber_made_scene_point(&s, 9, 9);
    camber_made_scene_end(&s, 0);
    camber_polylines *polylines = scene_polylines(b.context, &s);
    assert_int_equal(
        camber_mesh_tessellate(b.mesh, polylines,
                               &(camber_tessellation_desc){strokes, STROKES, CAMBER_METHOD_STRIP, 0, false}),
        CAMBER_ERROR_LIMIT);
    assert_story(&b.h, "128 strokes");
    assert_int_equal(
        camber_mesh_tessellate(b.mesh, polylines,
                               &(camber_tessellation_desc){strokes, STROKES - 1, CAMBER_METHOD_STRIP, 0, false}),
        CAMBER_OK);
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
    bounded_close(&b);
}

static void test_descriptions(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const camber_device_desc bad[] = {{.lanes = 4},
                                      {.work_group_size = 1},
                                      {.work_group_size = 32},
                                      {.work_group_size = 255},
                                      {.work_group_size = 512},
                                      {.largest_buffer_bytes = 4095},
                                      {.largest_buffer_bytes = 1}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        camber_device *const untouched = (camber_device *)(void *)&h;
        camber_device *device = untouched;
        assert_int_equal(camber_device_create(context, bad + i, &device), CAMBER_ERROR_ARGUMENT);
        assert_ptr_equal(device, untouched);
        assert_story(&h, "; it must be ");
    }
    camber_device *device = NULL;
    assert_int_equal(camber_device_create(context, NULL, &device), CAMBER_OK);
    const uint64_t own = camber_device_get_info(device).largest_buffer_bytes;
    camber_device_destroy(device);
    const uint64_t asked[] = {4096, own - 1, own, own + 1, UINT64_MAX};
    for (size_t i = 0; i < 5; i++) {
        const camber_device_desc desc = {.largest_buffer_bytes = asked[i]};
        assert_int_equal(camber_device_create(context, &desc, &device), CAMBER_OK);
        assert_true(camber_device_get_info(device).largest_buffer_bytes == (asked[i] < own ? asked[i] : own));
        camber_device_destroy(device);
    }
    host_done(&h, context);
}

/* ---- Memory ---- */

typedef struct attempt {
    camber_device *device;
    const camber_polylines *polylines;
    const camber_tessellation_desc *desc;
} attempt;

static camber_status try_parts(camber_context *context, void *user) {
    (void)context;
    const attempt *a = user;
    camber_mesh *mesh = NULL;
    camber_mesh_data data;
    camber_stages stages;
    camber_status status = camber_mesh_create(a->device, NULL, &mesh);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate(mesh, a->polylines, a->desc);
    if (status == CAMBER_OK)
        status = camber_mesh_read(mesh, &data);
    if (status == CAMBER_OK) {
        camber_mesh_data_destroy(&data);
        status = camber_mesh_read_stages(mesh, &stages);
    }
    if (status == CAMBER_OK)
        camber_stages_destroy(&stages);
    camber_mesh_destroy(mesh);
    return status;
}

static void test_memory(void **state) {
    (void)state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, CAMBER_METHOD_STRIP, 0, false};
    camber_made_scene s = make_scene(1);
    fixture b;
    bounded_open(&b, 50000, 0);
    camber_polylines *polylines = scene_polylines(b.context, &s);
    attempt a = {b.on.device, polylines, &desc};
    assert_int_equal(try_parts(b.context, &a), CAMBER_OK); /* builds the kernels */
    each_allocation_fails(&b.h, try_parts, b.context, &a);
    camber_polylines_destroy(polylines);
    bounded_close(&b);
    camber_made_scene_free(&s);
}

/* ---- Pictures ---- */

enum { SIDE_PX = 192, PASSES = 3 };

typedef struct drawing {
    picture picture;
    camber_overdraw overdraw;
    uint8_t *map;
    size_t parts, largest_buffer;
} drawing;

/* An opaque pass, a flattened translucent one with rows of two alphas, and a range of the polylines. */
static bool draw(uint64_t limit, camber_backend backend, camber_sharing sharing, const camber_made_scene *s,
                 drawing *d) {
    host h;
    camber_context *context = host_context(&h);
    camber_device_desc device_desc = {.largest_buffer_bytes = limit};
    const camber_surface_desc surface_desc = {backend};
    const camber_renderer_desc renderer_desc = {.sharing = sharing, .rasterizer = CAMBER_RASTERIZER_GL};
    camber_surface *surface = NULL;
    camber_device *device = NULL;
    camber_renderer *renderer = NULL;
    const bool has_surface = camber_surface_create(context, &surface_desc, &surface) == CAMBER_OK;
    device_desc.gl = camber_surface_get_handles(surface);
    const bool there = has_surface && camber_device_create(context, &device_desc, &device) == CAMBER_OK &&
                       camber_renderer_create(device, surface, &renderer_desc, &renderer) == CAMBER_OK;
    if (there) {
        watched = opencl_of(device)->cl;
        largest_buffer = 0;
        camber_stroke strokes[CAMBER_KERNEL_ROWS];
        camber_paint paints[CAMBER_KERNEL_ROWS];
        scene_strokes(strokes);
        for (int i = 0; i < CAMBER_KERNEL_ROWS; i++) {
            const float hue = (float)i / CAMBER_KERNEL_ROWS;
            paints[i] = (camber_paint){.width_px = fminf(strokes[i].width_px, 1),
                                       .color = {hue, 1 - hue, 0.5f, i == 4 ? 0.3f : 0.6f}};
        }
        camber_paint opaque[CAMBER_KERNEL_ROWS];
        memcpy(opaque, paints, sizeof opaque);
        for (int i = 0; i < CAMBER_KERNEL_ROWS; i++)
            opaque[i].color = (camber_color){1, 1, paints[i].color.r, 1}; /* not what goes over it */
        camber_mesh *mesh = NULL;
        camber_polylines *polylines = scene_polylines(context, s);
        assert_int_equal(camber_mesh_create(device, renderer, &mesh), CAMBER_OK);
        assert_int_equal(camber_mesh_tessellate(
                             mesh, polylines,
                             &(camber_tessellation_desc){strokes, CAMBER_KERNEL_ROWS, CAMBER_METHOD_STRIP, 0, false}),
                         CAMBER_OK);
        const camber_pass passes[PASSES] = {{.mesh = mesh, .paints = opaque, .paint_count = CAMBER_KERNEL_ROWS},
                                            {.mesh = mesh, .paints = paints, .paint_count = CAMBER_KERNEL_ROWS},
                                            {.mesh = mesh,
                                             .first_polyline = 137,
                                             .polyline_count = s->polyline_count - 260,
                                             .paints = paints,
                                             .paint_count = CAMBER_KERNEL_ROWS,
                                             .overlap = CAMBER_OVERLAP_ACCUMULATE}};
        d->picture = picture_draw(
            renderer, &(camber_frame){.width = SIDE_PX, .height = SIDE_PX, .passes = passes, .pass_count = PASSES});
        d->map = malloc(SIDE_PX * SIDE_PX);
        assert_non_null(d->map);
        const camber_overdraw_desc counted = {.width = SIDE_PX,
                                              .height = SIDE_PX,
                                              .mesh = mesh,
                                              .paints = paints,
                                              .paint_count = CAMBER_KERNEL_ROWS,
                                              .map = d->map};
        assert_int_equal(camber_renderer_count_overdraw(renderer, &counted, &d->overdraw), CAMBER_OK);
        d->parts = mesh->part_count;
        d->largest_buffer = largest_buffer;
        camber_mesh_destroy(mesh);
        camber_polylines_destroy(polylines);
    }
    camber_renderer_destroy(renderer);
    camber_device_destroy(device);
    camber_surface_destroy(surface);
    host_done(&h, context);
    return there;
}

static void free_drawing(drawing *d) {
    picture_free(&d->picture);
    free(d->map);
}

static void test_same_picture(void **state) {
    (void)state;
    static const uint64_t limits[] = {20000, 1 << 16, 200000};
    static const camber_sharing sharings[] = {CAMBER_SHARING_GL, CAMBER_SHARING_ZERO_COPY, CAMBER_SHARING_COPY};
    camber_made_scene s = make_scene(1);
    size_t drawn = 0;
    for (size_t i = 0; i < 2 * s.point_count; i++)
        s.points[i] *= (float)SIDE_PX / 1000; /* into the picture */
    for (int backend = 0; backend < CAMBER_FIXTURE_BACKENDS; backend++) {
        for (size_t k = 0; k < 3; k++) {
            drawing whole;
            if (!draw(0, fixture_backend(backend), sharings[k], &s, &whole)) {
                print_message("%s, %s: not here\n", fixture_name(backend), camber_sharing_get_name(sharings[k]));
                continue;
            }
            assert_int_equal(whole.parts, 1);
            assert_true(whole.overdraw.repeated_pixels > 0);
            const picture *p = &whole.picture;
            size_t left = 0; /* where nothing hides what lies below */
            for (size_t at = 0; at < (size_t)SIDE_PX * SIDE_PX; at++)
                left += p->rgba[4 * at + 3] == 0;
            assert_true(left > SIDE_PX * SIDE_PX / 5);
            for (size_t i = 0; i < 3; i++) {
                drawing d;
                assert_true(draw(limits[i], fixture_backend(backend), sharings[k], &s, &d));
                assert_true(d.parts > 1 && d.largest_buffer <= limits[i]);
                picture_assert_same(&d.picture, &whole.picture);
                assert_memory_equal(&d.overdraw, &whole.overdraw, sizeof d.overdraw);
                assert_memory_equal(d.map, whole.map, SIDE_PX * SIDE_PX);
                free_drawing(&d);
                drawn++;
            }
            free_drawing(&whole);
        }
    }
    camber_made_scene_free(&s);
    if (drawn == 0)
        skip();
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_bytes),   cmocka_unit_test(test_work_groups),
        cmocka_unit_test(test_borders),      cmocka_unit_test(test_first_index),
        cmocka_unit_test(test_nothing),      cmocka_unit_test(test_again),
        cmocka_unit_test(test_too_long),     cmocka_unit_test(test_too_many_strokes),
        cmocka_unit_test(test_descriptions), cmocka_unit_test(test_memory),
        cmocka_unit_test(test_same_picture),
    };
    int failed = 77;
    if (device_is_there())
        failed = cmocka_run_group_tests(tests, NULL, NULL);
    else
        puts("skipped: no OpenCL device");
    return failed;
}
