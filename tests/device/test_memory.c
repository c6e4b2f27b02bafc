/* Meshes in bounded memory: what is read, told, drawn and counted is the same as without a bound, no more is held than
 * allowed, parts that are not there are made again, and what cannot fit is refused by name. */
#include "pictures.h"

#include "cl_calls.h"

#include "gpu/opencl/opencl.h"
#include "residency/memory.h"
#include "residency/parts.h"

/* ---- Held by OpenCL ---- */

enum { MEMS_MAX = 4096 };

/* Buffers of the watched context that have not been released. Those on host memory take none of their own. */
static struct {
    cl_context context;
    cl_mem mems[MEMS_MAX];
    size_t bytes[MEMS_MAX];
    size_t count, held_bytes, most_bytes;
    int refuse_in; /* buffers: the last of so many is refused. 0: none is */
} watch;

static cl_mem watch_buffer(cl_context context, cl_mem_flags flags, size_t size, void *memory, cl_int *code) {
    if (context == watch.context && watch.refuse_in && --watch.refuse_in == 0) {
        *code = CL_MEM_OBJECT_ALLOCATION_FAILURE;
        return NULL;
    }
    const cl_mem mem = cl_real.CreateBuffer(context, flags, size, memory, code);
    /* Zero copy puts an output buffer on GL's memory, which is the mesh's; a network's memory is its own. */
    if (context != watch.context || !mem || flags == (CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR))
        return mem;
    assert_true(watch.count < MEMS_MAX);
    watch.mems[watch.count] = mem;
    watch.bytes[watch.count++] = size;
    watch.held_bytes += size;
    watch.most_bytes = watch.held_bytes > watch.most_bytes ? watch.held_bytes : watch.most_bytes;
    return mem;
}

static cl_int watch_release(cl_mem mem) {
    for (size_t i = 0; i < watch.count; i++)
        if (watch.mems[i] == mem) {
            watch.held_bytes -= watch.bytes[i];
            watch.mems[i] = watch.mems[--watch.count];
            watch.bytes[i] = watch.bytes[watch.count];
        }
    return cl_real.ReleaseMemObject(mem);
}

static void cl_take(void) {
    camber_cl.CreateBuffer = watch_buffer;
    camber_cl.ReleaseMemObject = watch_release;
}

/* ---- Devices with a bound ---- */

static void bounded_open(fixture *b, uint64_t memory_bytes, uint32_t work_group_size) {
    const camber_device_desc desc = {.work_group_size = work_group_size, .memory_bytes = memory_bytes};
    fixture_open_mesh(b, &desc);
    memset(&watch, 0, sizeof watch);
    watch.context = opencl_of(b->on.device)->cl;
}

/* The count is of what OpenCL was asked for, and no more than allowed. */
static void assert_bounded(const camber_device *device) {
    const camber_device_memory memory = camber_device_get_memory(device);
    if (watch.context != opencl_of(device)->cl)
        return;
    assert_true(memory.held_bytes <= memory.most_bytes && memory.most_bytes > 0);
    assert_true(watch.held_bytes <= memory.held_bytes && watch.most_bytes <= memory.most_bytes);
    if (memory.allowed_bytes)
        assert_true(memory.most_bytes <= memory.allowed_bytes);
}

static void bounded_close(fixture *b) {
    assert_bounded(b->on.device);
    camber_mesh_destroy(b->mesh);
    b->mesh = NULL;
    assert_true(camber_device_get_memory(b->on.device).held_bytes == 0);
    if (watch.context == opencl_of(b->on.device)->cl)
        assert_int_equal(watch.count, 0);
    fixture_close(b);
}

typedef struct result {
    camber_mesh_data mesh;
    camber_stages stages;
    camber_mesh_memory memory;
} result;

static result read_result(fixture *b, camber_mesh *mesh) {
    result r = {.memory = camber_mesh_get_memory(mesh)};
    assert_int_equal(camber_mesh_read(mesh, &r.mesh), CAMBER_OK);
    assert_int_equal(camber_mesh_read_stages(mesh, &r.stages), CAMBER_OK);
    const camber_mesh_info told = camber_mesh_get_info(mesh);
    assert_memory_equal(&told, &r.mesh.info, sizeof told);
    assert_bounded(b->on.device);
    return r;
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
    assert_memory_equal(a->mesh.vertices, b->mesh.vertices, x.vertex_count * sizeof *a->mesh.vertices);
    assert_memory_equal(a->mesh.indices, b->mesh.indices, x.index_count * sizeof *a->mesh.indices);
    assert_int_equal(a->stages.point_count, b->stages.point_count);
    assert_memory_equal(a->stages.points, b->stages.points, a->stages.point_count * sizeof *a->stages.points);
}

/* Lines, rings, dots, empty polylines, split ones, and none that is long. */
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

/* ---- Polylines ---- */

static void test_same_bytes(void **state) {
    (void)state;
    static const uint64_t limits[] = {1 << 16, 1 << 17, 1 << 18, 1 << 19, 1 << 26};
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    camber_made_scene s = make_scene(1);
    fixture whole;
    bounded_open(&whole, 0, 0);
    result wanted[3];
    for (int method = 0; method < 3; method++) {
        const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, (camber_method)method, 0, false};
        camber_polylines *polylines = scene_polylines(whole.context, &s);
        assert_int_equal(camber_mesh_tessellate(whole.mesh, polylines, &desc), CAMBER_OK);
        camber_polylines_destroy(polylines);
        wanted[method] = read_result(&whole, whole.mesh);
        assert_int_equal(wanted[method].memory.parts, 1);
        assert_int_equal(wanted[method].memory.resident_parts, 1);
        assert_int_equal(camber_mesh_get_memory(whole.mesh).remade_parts, 0);
    }
    for (size_t i = 0; i < 2 * sizeof limits / sizeof *limits; i++) {
        fixture b;
        bounded_open(&b, limits[i / 2], i % 2 ? 64 : 256);
        for (int method = 0; method < 3; method++) {
            const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, (camber_method)method, 0, false};
            camber_polylines *polylines = scene_polylines(b.context, &s);
            assert_int_equal(camber_mesh_tessellate(b.mesh, polylines, &desc), CAMBER_OK);
            camber_polylines_destroy(polylines); /* the mesh keeps what it needs */
            result r = read_result(&b, b.mesh);
            assert_same(&r, wanted + method);
            const camber_mesh_memory now = camber_mesh_get_memory(b.mesh);
            const bool all = limits[i / 2] == 1 << 26;
            assert_true(all ? r.memory.parts == 1 : r.memory.parts > 4);
            if (limits[i / 2] < 1 << 19) {
                assert_true(r.memory.resident_parts < r.memory.parts && r.memory.resident_parts > 0);
                assert_true(now.remade_parts > r.memory.parts - r.memory.resident_parts);
            } else if (all) {
                assert_int_equal(r.memory.resident_parts, 1);
                assert_int_equal(now.remade_parts, 0);
            }
            if (method == 0 || limits[i / 2] <= 1 << 17)
                print_message("%llu bytes, method %d: %zu of %zu parts stay, %zu made again; %zu of OpenCL at most\n",
                              (unsigned long long)limits[i / 2], method, r.memory.resident_parts, r.memory.parts,
                              now.remade_parts, watch.most_bytes);
            free_result(&r);
        }
        bounded_close(&b);
    }
    for (int method = 0; method < 3; method++)
        free_result(wanted + method);
    bounded_close(&whole);
    camber_made_scene_free(&s);
}

/* Parts that stay are used: of the bound three quarters at least are full, and reading in order makes no part again
 * that is there. */
static void test_keeps_what_fits(void **state) {
    (void)state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, CAMBER_METHOD_STRIP, 0, false};
    camber_made_scene s = make_scene(6);
    fixture b;
    bounded_open(&b, 3 << 19, 64);
    camber_polylines *polylines = scene_polylines(b.context, &s);
    assert_int_equal(camber_mesh_tessellate(b.mesh, polylines, &desc), CAMBER_OK);
    const camber_mesh_memory before = camber_mesh_get_memory(b.mesh);
    assert_true(before.held_bytes > (3 << 19) / 4 * 3);
    assert_true(before.resident_parts >= 5 && before.resident_parts < before.parts - 2);
    for (int round = 1; round <= 3; round++) {
        camber_mesh_data data;
        camber_stages stages;
        assert_int_equal(camber_mesh_read_stages(b.mesh, &stages), CAMBER_OK);
        camber_stages_destroy(&stages);
        const camber_mesh_memory after = camber_mesh_get_memory(b.mesh);
        /* All that were not there, and of those that were at most the one whose place the others took. */
        const size_t gone = before.parts - before.resident_parts;
        assert_in_range(after.remade_parts, (size_t)round * (gone - 2), (size_t)round * (gone + 1));
        if (round == 3) {
            assert_int_equal(camber_mesh_read(b.mesh, &data), CAMBER_OK);
            camber_mesh_data_destroy(&data);
        }
    }
    camber_polylines_destroy(polylines);
    bounded_close(&b);
    camber_made_scene_free(&s);
}

/* ---- Networks ---- */

static const double WORLD_UNIT = 1e-7;

static camber_network *make_network(camber_context *context, const camber_made_scene *s) {
    double *points = malloc((s->point_count + 1) * 2 * sizeof *points);
    size_t *offsets = malloc((s->polyline_count + 1) * sizeof *offsets);
    camber_network_entry *entries = calloc(s->polyline_count + 1, sizeof *entries);
    camber_network *network = NULL;
    assert_true(points && offsets && entries);
    for (size_t i = 0; i < 2 * s->point_count; i++)
        points[i] = 0.4 + WORLD_UNIT * (double)s->points[i];
    for (size_t i = 0; i <= s->polyline_count; i++)
        offsets[i] = s->offsets[i];
    for (size_t i = 0; i < s->polyline_count; i++)
        entries[i] = (camber_network_entry){(uint32_t)i, s->rows[i], 0};
    const camber_network_desc desc = {.points = points,
                                      .offsets = offsets,
                                      .polyline_count = s->polyline_count,
                                      .entries = entries,
                                      .entry_count = s->polyline_count};
    assert_int_equal(camber_network_create(context, &desc, &network), CAMBER_OK);
    free(entries);
    free(offsets);
    free(points);
    return network;
}

static camber_camera camera_at(double scale_px, double bearing_deg) {
    return (camber_camera){.x = 0.4 + 480 * WORLD_UNIT,
                           .y = 0.4 + 510 * WORLD_UNIT,
                           .scale_px = scale_px / WORLD_UNIT,
                           .bearing_deg = bearing_deg,
                           .width = 600,
                           .height = 500};
}

/* A flight over a network, on a device that reads its memory and on one that has to be given copies. */
static void test_networks(void **state) {
    (void)state;
    static const uint64_t limits[] = {1 << 17, 300000, 1 << 20};
    static const double scales[] = {0.6, 2, 0.05, 10, 0.6};
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    camber_made_scene s = make_scene(2);
    fixture whole;
    bounded_open(&whole, 0, 0);
    camber_network *network = make_network(whole.context, &s);
    size_t remade = 0;
    for (size_t i = 0; i < 6; i++) {
        fixture b;
        bounded_open(&b, limits[i / 2], 64);
        b.on.device->host_memory &= i % 2 == 0;
        camber_network *own = make_network(b.context, &s);
        for (size_t k = 0; k < sizeof scales / sizeof *scales; k++) {
            const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, (camber_method)(k % 3), 0, false};
            const camber_camera camera = camera_at(scales[k], 30.0 * (double)k);
            assert_int_equal(camber_mesh_tessellate_network(whole.mesh, network, &camera, &desc), CAMBER_OK);
            assert_int_equal(camber_mesh_tessellate_network(b.mesh, own, &camera, &desc), CAMBER_OK);
            if (k == 4)
                camber_network_destroy(own);
            result wanted = read_result(&whole, whole.mesh), r = read_result(&b, b.mesh);
            assert_same(&r, &wanted);
            remade += camber_mesh_get_memory(b.mesh).remade_parts;
            if (k == 4)
                print_message("%llu bytes, %s: %zu sections, %zu of %zu parts stay; %zu of OpenCL at most\n",
                              (unsigned long long)limits[i / 2], i % 2 ? "copied" : "shared",
                              b.mesh->held->section_count, r.memory.resident_parts, r.memory.parts, watch.most_bytes);
            free_result(&r);
            free_result(&wanted);
        }
        if (i < 2)
            assert_true(b.mesh->held->section_count > 8);
        bounded_close(&b);
    }
    assert_true(remade > 100);
    camber_network_destroy(network);
    bounded_close(&whole);
    camber_made_scene_free(&s);
}

/* Parts that were cut for all of a network come together where little of it is seen, and are cut again. A device that
 * has to be given copies holds the network, too. */
static void join_parts(bool copied) {
    static const double scales[] = {0.9, 9, 9, 9, 9, 9, 9, 0.9};
    enum { FRAMES = 8 };
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    for (int i = 0; i < CAMBER_KERNEL_ROWS; i++) /* that do not reach far into the picture */
        strokes[i] = (camber_stroke){2, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0};
    camber_made_scene s = {0};
    uint64_t seed = 8;
    for (int i = 0; i < 8; i++)
        camber_scene_add_walks(&s, &seed);
    fixture whole, b;
    bounded_open(&whole, 0, 0);
    copied = copied || !whole.on.device->host_memory;
    bounded_open(&b, copied ? 700000 : 500000, 64);
    b.on.device->host_memory = !copied;
    camber_network *network = make_network(whole.context, &s), *own = make_network(b.context, &s);
    size_t parts[FRAMES];
    for (size_t k = 0; k < FRAMES; k++) {
        const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS,
                                               k == 3 ? CAMBER_METHOD_FAN : CAMBER_METHOD_STRIP, 0, false};
        const camber_camera camera = camera_at(scales[k], 10);
        assert_int_equal(camber_mesh_tessellate_network(whole.mesh, network, &camera, &desc), CAMBER_OK);
        assert_int_equal(camber_mesh_tessellate_network(b.mesh, own, &camera, &desc), CAMBER_OK);
        result wanted = read_result(&whole, whole.mesh), r = read_result(&b, b.mesh);
        assert_same(&r, &wanted);
        parts[k] = r.memory.parts;
        if (k > 3)
            assert_true(k == FRAMES - 1 || r.memory.resident_parts == r.memory.parts);
        free_result(&r);
        free_result(&wanted);
    }
    print_message("%zu parts, %zu near by, %zu again; %zu sections\n", parts[0], parts[FRAMES - 2], parts[FRAMES - 1],
                  b.mesh->held->section_count);
    assert_int_equal(parts[FRAMES - 2], b.mesh->held->section_count); /* no part is of two */
    assert_true(parts[0] > b.mesh->held->section_count * 3 / 2 &&
                parts[FRAMES - 1] > b.mesh->held->section_count * 3 / 2);
    camber_network_destroy(own);
    camber_network_destroy(network);
    bounded_close(&b);
    bounded_close(&whole);
    camber_made_scene_free(&s);
}

static void test_parts_join(void **state) {
    (void)state;
    join_parts(false);
    join_parts(true);
}

/* ---- Several meshes ---- */

/* Meshes of one device share its memory: what one needs, another gives, and has again when it is asked. */
static void test_meshes_share(void **state) {
    (void)state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, CAMBER_METHOD_FAN, 0, false};
    camber_made_scene s = make_scene(1);
    fixture whole, b;
    bounded_open(&whole, 0, 0);
    camber_polylines *polylines = scene_polylines(whole.context, &s);
    assert_int_equal(camber_mesh_tessellate(whole.mesh, polylines, &desc), CAMBER_OK);
    camber_polylines_destroy(polylines);
    result wanted = read_result(&whole, whole.mesh);
    bounded_open(&b, 1200000, 64);
    camber_mesh *meshes[4] = {b.mesh};
    camber_network *network = make_network(b.context, &s);
    const camber_camera camera = camera_at(1, 0);
    polylines = scene_polylines(b.context, &s);
    for (int i = 1; i < 4; i++)
        assert_int_equal(camber_mesh_create(b.on.device, NULL, meshes + i), CAMBER_OK);
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < 4; i++)
            if (i < 3)
                assert_int_equal(camber_mesh_tessellate(meshes[i], polylines, &desc), CAMBER_OK);
            else
                assert_int_equal(camber_mesh_tessellate_network(meshes[i], network, &camera, &desc), CAMBER_OK);
        size_t there = 0, all = 0;
        for (int i = 0; i < 4; i++) {
            const camber_mesh_memory memory = camber_mesh_get_memory(meshes[i]);
            there += memory.resident_parts;
            all += memory.parts;
        }
        assert_true(there > 0 && there < all);
        for (int i = 2; i >= 0; i--) {
            result r = read_result(&b, meshes[i]);
            assert_same(&r, &wanted);
            free_result(&r);
        }
    }
    uint64_t held = 0;
    for (int i = 0; i < 4; i++)
        held += camber_mesh_get_memory(meshes[i]).held_bytes;
    assert_true(held == camber_device_get_memory(b.on.device).held_bytes);
    for (int i = 3; i > 0; i--)
        camber_mesh_destroy(meshes[i == 3 ? 1 : i == 1 ? 3 : i]);
    camber_polylines_destroy(polylines);
    camber_network_destroy(network);
    bounded_close(&b);
    free_result(&wanted);
    bounded_close(&whole);
    camber_made_scene_free(&s);
}

/* ---- Limits ---- */

static void test_too_small(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    static const uint64_t bad[] = {1, 65535};
    for (size_t i = 0; i < 2; i++) {
        camber_device *device = NULL;
        assert_int_equal(camber_device_create(context, &(camber_device_desc){.memory_bytes = bad[i]}, &device),
                         CAMBER_ERROR_ARGUMENT);
        assert_null(device);
        assert_story(&h, "of memory for meshes; it must be 65536 or more");
    }
    host_done(&h, context);
}

/* The mesh of what was refused is empty, and takes what fits. */
static void assert_goes_on(fixture *b, const camber_tessellation_desc *desc) {
    camber_made_scene s = {0};
    camber_mesh_data data, twin;
    assert_int_equal(camber_mesh_read(b->mesh, &data), CAMBER_OK);
    assert_int_equal(data.info.vertex_count, 0);
    camber_mesh_data_destroy(&data);
    for (int i = 0; i < 40; i++)
        camber_made_scene_point(&s, 3 * i, i % 3);
    camber_made_scene_end(&s, 0);
    camber_polylines *polylines = scene_polylines(b->context, &s);
    assert_int_equal(camber_mesh_tessellate(b->mesh, polylines, desc), CAMBER_OK);
    assert_int_equal(camber_mesh_read(b->mesh, &data), CAMBER_OK);
    assert_int_equal(camber_mesh_data_tessellate(b->context, polylines, desc, &twin), CAMBER_OK);
    assert_int_equal(data.info.record_count, twin.info.record_count);
    assert_memory_equal(data.records, twin.records, twin.info.record_count * sizeof *twin.records);
    camber_mesh_data_destroy(&data);
    camber_mesh_data_destroy(&twin);
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
    assert_bounded(b->on.device);
}

static void test_too_long(void **state) {
    (void)state;
    static const struct {
        size_t points;
        bool fits, fits_network;
    } cases[] = {{900, true, true}, {5000, false, false}, {30000, false, false}};
    const camber_stroke stroke = {2, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0};
    const camber_tessellation_desc desc = {&stroke, 1, CAMBER_METHOD_STRIP, 0, false};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        fixture b;
        camber_made_scene s = {0};
        uint64_t seed = 2;
        bounded_open(&b, 1 << 17, 64);
        for (size_t i = 0; i < 60; i++) {
            camber_made_scene_walk(&s, &seed, i == 41 ? cases[k].points : 30, (const double[]){0.5, 5}, 1);
            camber_made_scene_end(&s, 0);
        }
        camber_polylines *polylines = scene_polylines(b.context, &s);
        camber_network *network = make_network(b.context, &s);
        const camber_camera camera = camera_at(0.1, 0);
        for (int time = 0; time < 2; time++) {
            assert_int_equal(camber_mesh_tessellate(b.mesh, polylines, &desc),
                             cases[k].fits ? CAMBER_OK : CAMBER_ERROR_LIMIT);
            if (!cases[k].fits) {
                assert_story(&b.h, "polyline 41 takes ");
                assert_non_null(strstr(b.h.last, "of the 131072 that meshes may hold; allow more memory, "));
                assert_goes_on(&b, &desc);
            }
            assert_int_equal(camber_mesh_tessellate_network(b.mesh, network, &camera, &desc),
                             cases[k].fits_network ? CAMBER_OK : CAMBER_ERROR_LIMIT);
            if (!cases[k].fits_network) {
                assert_story(&b.h, "polyline 41 takes ");
                assert_goes_on(&b, &desc);
            }
        }
        camber_network_destroy(network);
        camber_polylines_destroy(polylines);
        camber_made_scene_free(&s);
        bounded_close(&b);
    }
}

static void test_too_many_strokes(void **state) {
    (void)state;
    enum { STROKES = 300 };
    static camber_stroke strokes[STROKES];
    fixture b;
    bounded_open(&b, 65536, 0);
    camber_made_scene s = {0};
    camber_made_scene_point(&s, 0, 0);
    camber_made_scene_point(&s, 9, 9);
    camber_made_scene_end(&s, 0);
    camber_polylines *polylines = scene_polylines(b.context, &s);
    assert_int_equal(
        camber_mesh_tessellate(b.mesh, polylines,
                               &(camber_tessellation_desc){strokes, STROKES, CAMBER_METHOD_STRIP, 0, false}),
        CAMBER_ERROR_LIMIT);
    assert_story(&b.h, "300 strokes take ");
    assert_goes_on(&b, &(camber_tessellation_desc){strokes, 50, CAMBER_METHOD_STRIP, 0, false});
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&s);
    bounded_close(&b);
}

/* ---- Failures ---- */

/* Each buffer that a mesh with parts to make again asks for is refused once: the call says so, the next one works. */
static void test_refused_buffers(void **state) {
    (void)state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, CAMBER_METHOD_STRIP, 0, false};
    camber_made_scene s = make_scene(1);
    fixture b;
    bounded_open(&b, 300000, 64);
    camber_polylines *polylines = scene_polylines(b.context, &s);
    assert_int_equal(camber_mesh_tessellate(b.mesh, polylines, &desc), CAMBER_OK);
    result wanted = read_result(&b, b.mesh);
    size_t refused = 0;
    for (int n = 1; n < 60; n++) {
        camber_stages stages;
        watch.refuse_in = n;
        const camber_status made = camber_mesh_tessellate(b.mesh, polylines, &desc);
        const camber_status read = made == CAMBER_OK ? camber_mesh_read_stages(b.mesh, &stages) : made;
        if (read == CAMBER_OK)
            camber_stages_destroy(&stages);
        if (!watch.refuse_in) {
            assert_int_equal(read, CAMBER_ERROR_MEMORY);
            assert_story(&b.h, "clCreateBuffer");
            refused += made == CAMBER_OK;
        }
        watch.refuse_in = 0;
        if (made != CAMBER_OK)
            assert_int_equal(camber_mesh_tessellate(b.mesh, polylines, &desc), CAMBER_OK);
        result r = read_result(&b, b.mesh);
        assert_same(&r, &wanted);
        free_result(&r);
    }
    assert_true(refused > 5);
    free_result(&wanted);
    camber_polylines_destroy(polylines);
    bounded_close(&b);
    camber_made_scene_free(&s);
}

typedef struct attempt {
    camber_device *device;
    const camber_polylines *polylines;
    camber_network *network;
    const camber_tessellation_desc *desc;
} attempt;

static camber_status try_parts(camber_context *context, void *user) {
    (void)context;
    const attempt *a = user;
    camber_mesh *mesh = NULL;
    camber_mesh_data data;
    const camber_camera camera = camera_at(1, 0);
    camber_status status = camber_mesh_create(a->device, NULL, &mesh);
    for (int i = 0; i < 2 && status == CAMBER_OK; i++) {
        status = i ? camber_mesh_tessellate_network(mesh, a->network, &camera, a->desc)
                   : camber_mesh_tessellate(mesh, a->polylines, a->desc);
        if (status == CAMBER_OK)
            status = camber_mesh_read(mesh, &data);
        if (status == CAMBER_OK)
            camber_mesh_data_destroy(&data);
    }
    camber_mesh_destroy(mesh);
    return status;
}

static void test_allocations(void **state) {
    (void)state;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, CAMBER_METHOD_STRIP, 0, false};
    camber_made_scene s = {0};
    uint64_t seed = 3;
    camber_scene_add_walks(&s, &seed);
    fixture b;
    bounded_open(&b, 150000, 64);
    camber_polylines *polylines = scene_polylines(b.context, &s);
    camber_network *network = make_network(b.context, &s);
    attempt a = {b.on.device, polylines, network, &desc};
    assert_int_equal(try_parts(b.context, &a), CAMBER_OK); /* builds the kernels */
    each_allocation_fails(&b.h, try_parts, b.context, &a);
    camber_network_destroy(network);
    camber_polylines_destroy(polylines);
    bounded_close(&b);
    camber_made_scene_free(&s);
}

/* ---- Pictures ---- */

enum { SIDE_PX = 192, PASSES = 5 };

typedef struct drawn_lines {
    fixture f;
    camber_renderer *renderer; /* with a sharing of its own */
    camber_mesh *mesh;
    camber_paint opaque[CAMBER_KERNEL_ROWS], glass[CAMBER_KERNEL_ROWS], plain[CAMBER_KERNEL_ROWS];
    camber_pass passes[PASSES];
} drawn_lines;

static void drawn_close(drawn_lines *e) {
    camber_mesh_destroy(e->mesh);
    camber_renderer_destroy(e->renderer);
    if (e->f.on.device)
        assert_true(camber_device_get_memory(e->f.on.device).held_bytes == 0);
    fixture_close(&e->f);
}

/* drawers: CAMBER_FIXTURE_IN_* of GL, the first that is here. false: none is, or this path is not. */
static bool drawn_open(drawn_lines *e, uint64_t memory_bytes, unsigned drawers, camber_sharing sharing) {
    *e = (drawn_lines){0};
    const camber_fixture_desc desc = {.device = {.work_group_size = 64, .memory_bytes = memory_bytes},
                                      .drawers = drawers,
                                      .first_gl = true,
                                      .on_surface = true,
                                      .surfaces_alone = true};
    memset(&watch, 0, sizeof watch);
    bool opened = fixture_open_with(&e->f, desc);
    const camber_fixture_drawer drawer =
        e->f.on.surface[CAMBER_FIXTURE_EGL] ? CAMBER_FIXTURE_EGL : CAMBER_FIXTURE_OSMESA;
    opened = opened && camber_fixture_open_renderer(&e->f.on, drawer, sharing, &e->renderer) == CAMBER_OK;
    if (!opened) {
        drawn_close(e);
        return false;
    }
    assert_int_equal(camber_mesh_create(e->f.on.device, e->renderer, &e->mesh), CAMBER_OK);
    watch.context = opencl_of(e->f.on.device)->cl;
    return true;
}

/* Opaque; flattened with rows of two alphas; a range that darkens; opaque runs of one colour united, twice. */
static void make_passes(drawn_lines *e, const camber_stroke strokes[CAMBER_KERNEL_ROWS], size_t polyline_count) {
    for (int i = 0; i < CAMBER_KERNEL_ROWS; i++) {
        const float hue = (float)i / CAMBER_KERNEL_ROWS, width_px = fminf(strokes[i].width_px, 1);
        e->glass[i] = (camber_paint){.width_px = width_px, .color = {hue, 1 - hue, 0.5f, i == 4 ? 0.3f : 0.6f}};
        e->opaque[i] = (camber_paint){.width_px = width_px, .color = {1, 1, hue, 1}};
        e->plain[i] = (camber_paint){.width_px = 0.5f * width_px, .color = {0, 0.2f, 0.4f, 1}};
    }
    const camber_pass all = {.mesh = e->mesh, .paint_count = CAMBER_KERNEL_ROWS};
    for (int i = 0; i < PASSES; i++)
        e->passes[i] = all;
    e->passes[0].paints = e->opaque;
    e->passes[1].paints = e->glass;
    e->passes[2].paints = e->glass;
    e->passes[2].first_polyline = 137;
    e->passes[2].polyline_count = polyline_count - 260;
    e->passes[2].overlap = CAMBER_OVERLAP_ACCUMULATE;
    e->passes[3].paints = e->plain;
    e->passes[3].overlap = CAMBER_OVERLAP_UNITE;
    e->passes[4].paints = e->plain;
}

static picture draw(drawn_lines *e, uint32_t largest_area_px) {
    return picture_draw(e->renderer, &(camber_frame){.width = SIDE_PX,
                                                     .height = SIDE_PX,
                                                     .passes = e->passes,
                                                     .pass_count = PASSES,
                                                     .largest_area_px = largest_area_px});
}

static camber_overdraw count(drawn_lines *e, uint8_t *map) {
    camber_overdraw counted;
    const camber_overdraw_desc desc = {.width = SIDE_PX,
                                       .height = SIDE_PX,
                                       .mesh = e->mesh,
                                       .paints = e->opaque,
                                       .paint_count = CAMBER_KERNEL_ROWS,
                                       .map = map};
    assert_int_equal(camber_renderer_count_overdraw(e->renderer, &desc, &counted), CAMBER_OK);
    return counted;
}

/* A mesh of polylines, or of a network at three quarters of the size. */
static void tessellate_on(drawn_lines *e, const camber_made_scene *s, bool of_network, camber_method method) {
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    scene_strokes(strokes);
    const camber_tessellation_desc desc = {strokes, CAMBER_KERNEL_ROWS, method, 0, false};
    if (of_network) {
        const camber_camera camera = {.x = 0.4 + 0.5 * SIDE_PX * WORLD_UNIT,
                                      .y = 0.4 + 0.5 * SIDE_PX * WORLD_UNIT,
                                      .scale_px = 0.75 / WORLD_UNIT,
                                      .bearing_deg = 20,
                                      .width = SIDE_PX,
                                      .height = SIDE_PX};
        camber_network *network = make_network(e->f.context, s);
        assert_int_equal(camber_mesh_tessellate_network(e->mesh, network, &camera, &desc), CAMBER_OK);
        camber_network_destroy(network);
    } else {
        camber_polylines *polylines = scene_polylines(e->f.context, s);
        assert_int_equal(camber_mesh_tessellate(e->mesh, polylines, &desc), CAMBER_OK);
        camber_polylines_destroy(polylines);
    }
    make_passes(e, strokes, s->polyline_count);
}

static void compare_pictures(const camber_made_scene *s, unsigned drawers, camber_sharing sharing,
                             uint64_t memory_bytes) {
    drawn_lines whole, e;
    uint8_t maps[2][SIDE_PX * SIDE_PX];
    assert_true(drawn_open(&whole, 0, drawers, sharing));
    assert_true(drawn_open(&e, memory_bytes, drawers, sharing));
    const bool all = drawers == CAMBER_FIXTURE_IN_EGL && sharing != CAMBER_SHARING_COPY;
    for (int i = 0; i < 6; i += all ? 1 : 5) {
        tessellate_on(&whole, s, i >= 3, (camber_method)(i % 3));
        tessellate_on(&e, s, i >= 3, (camber_method)(i % 3));
        const camber_mesh_memory memory = camber_mesh_get_memory(e.mesh);
        assert_true(memory.resident_parts < memory.parts);
        picture a = draw(&e, i == 1 ? 100 : 0), b = draw(&whole, 0);
        picture_assert_same(&a, &b);
        picture_free(&a);
        if (i % 3 == 1) {
            a = draw(&e, 0);
            picture_assert_same(&a, &b);
            picture_free(&a);
        }
        picture_free(&b);
        if (i % 3 == 0 || i == 5) {
            const camber_overdraw x = count(&e, maps[0]), y = count(&whole, maps[1]);
            assert_memory_equal(&x, &y, sizeof x);
            assert_memory_equal(maps[0], maps[1], sizeof maps[0]);
            assert_true(x.repeated_pixels > 0);
        }
        assert_true(camber_mesh_get_memory(e.mesh).remade_parts > memory.parts);
        assert_bounded(e.f.on.device);
    }
    drawn_close(&e);
    drawn_close(&whole);
}

static void test_same_pictures(void **state) {
    (void)state;
    static const camber_sharing sharings[] = {CAMBER_SHARING_GL, CAMBER_SHARING_ZERO_COPY, CAMBER_SHARING_COPY};
    camber_made_scene s = make_scene(1);
    size_t drawn = 0;
    for (size_t i = 0; i < 2 * s.point_count; i++)
        s.points[i] *= (float)SIDE_PX / 1000; /* into the picture */
    for (int backend = 0; backend < CAMBER_FIXTURE_BACKENDS; backend++)
        for (size_t k = 0; k < 3; k++) {
            drawn_lines probe;
            if (!drawn_open(&probe, 0, 1u << backend, sharings[k])) {
                print_message("%s, %s: not here\n", fixture_name(backend), camber_sharing_get_name(sharings[k]));
                continue;
            }
            drawn_close(&probe);
            compare_pictures(&s, 1u << backend, sharings[k], 400000);
            drawn++;
        }
    camber_made_scene_free(&s);
    if (drawn == 0)
        skip();
}

/* A buffer that a frame asks for while parts are made again is refused once: the frame says so, and after three of
 * them the next one is whole. */
static void test_refused_frames(void **state) {
    (void)state;
    drawn_lines e;
    camber_made_scene s = make_scene(1);
    size_t refused = 0;
    for (size_t i = 0; i < 2 * s.point_count; i++)
        s.points[i] *= (float)SIDE_PX / 1000;
    if (!drawn_open(&e, 400000, CAMBER_FIXTURE_IN_GL, CAMBER_SHARING_AUTO)) {
        camber_made_scene_free(&s);
        skip();
        return;
    }
    tessellate_on(&e, &s, false, CAMBER_METHOD_FAN);
    picture wanted = draw(&e, 0);
    const camber_frame frame = {.width = SIDE_PX, .height = SIDE_PX, .passes = e.passes, .pass_count = PASSES};
    for (int kind = 0; kind < 2; kind++)
        for (size_t n = 1; n < 40; n++) {
            if (kind == 0)
                watch.refuse_in = (int)n;
            else
                e.f.h.refuse_first = e.f.h.calls + n;
            e.f.h.refuse_count = 1;
            const camber_status status = camber_renderer_render(e.renderer, &frame, NULL, NULL, NULL);
            e.f.h.refuse_first = 0;
            watch.refuse_in = 0;
            if (status != CAMBER_OK) {
                assert_int_equal(status, CAMBER_ERROR_MEMORY);
                assert_story(&e.f.h, "memory");
                refused++;
            }
            assert_int_equal(e.f.h.errors, 0);
            if (n % (status == CAMBER_OK ? 8 : 3))
                continue;
            picture p = draw(&e, 0);
            picture_assert_same(&p, &wanted);
            picture_free(&p);
            assert_bounded(e.f.on.device);
        }
    assert_true(refused > 8);
    picture_free(&wanted);
    drawn_close(&e);
    camber_made_scene_free(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_bytes),      cmocka_unit_test(test_keeps_what_fits),
        cmocka_unit_test(test_networks),        cmocka_unit_test(test_parts_join),
        cmocka_unit_test(test_meshes_share),    cmocka_unit_test(test_too_small),
        cmocka_unit_test(test_too_long),        cmocka_unit_test(test_too_many_strokes),
        cmocka_unit_test(test_refused_buffers), cmocka_unit_test(test_allocations),
        cmocka_unit_test(test_same_pictures),   cmocka_unit_test(test_refused_frames),
    };
    int failed = 77;
    if (device_is_there())
        failed = cmocka_run_group_tests(tests, NULL, NULL);
    else
        puts("skipped: no OpenCL device");
    return failed;
}
