/* OpenCL's failures: the n-th call is refused, once or from there on, for every n. Each time the call says so in one
 * line, leaks nothing, and works when the fault is gone; what is drawn and read then is right. */
#include "pictures.h"

#include "cl_fault.h"
#include "residency/mesh.h"

static const struct {
    cl_int code;
    camber_status status;
} FAULTS[] = {{CL_OUT_OF_HOST_MEMORY, CAMBER_ERROR_MEMORY}, {CL_DEVICE_NOT_AVAILABLE, CAMBER_ERROR_DEVICE}};
enum { CALLS_MAX = 3000, SIDE_PX = 64 };
enum { FAULT_COUNT = IS_SANITIZED ? 1 : 2 }; /* a sanitizer has the same to see whatever the code */

/* Calls that something else stands in for. */
static bool is_optional(const char *call) {
    static const char *const optional[] = {"clGetDeviceInfo, optional", "clGetEventProfilingInfo", "clGetProgramInfo"};
    for (size_t i = 0; i < sizeof optional / sizeof *optional; i++)
        if (strcmp(call, optional[i]) == 0)
            return true;
    return false;
}

static void assert_live(const cl_objects *wanted) {
    assert_memory_equal(&cl_fault.live, wanted, sizeof *wanted);
}

/* ---- Lines and the mesh that they make ---- */

typedef struct stage_set {
    host h;
    camber_context *context;
    camber_device *device;
    camber_polylines *polylines, *others;
    camber_stroke strokes[CAMBER_KERNEL_ROWS];
    camber_tessellation_desc desc;
    camber_mesh_data wanted; /* of polylines */
    camber_stages stages;
    cl_objects before;
} stage_set;

static camber_polylines *make_lines(camber_context *context, uint64_t seed, size_t count) {
    camber_made_scene s = {0};
    for (size_t i = 0; i < count; i++) {
        camber_made_scene_walk(&s, &seed, 20, (const double[]){20, 200}, 1);
        camber_made_scene_end(&s, i % CAMBER_KERNEL_ROWS);
    }
    for (size_t i = 0; i < 2 * s.point_count; i++)
        s.points[i] *= SIDE_PX / 1000.0f; /* into the picture */
    camber_polylines *polylines = scene_polylines(context, &s);
    camber_made_scene_free(&s);
    return polylines;
}

/* In parts: several uploads, and a part that is split. */
static void open_set(stage_set *s, bool parts, camber_method method) {
    *s = (stage_set){.before = cl_fault.live};
    s->context = host_context(&s->h);
    const camber_device_desc device_desc = {.largest_buffer_bytes = parts && !cl_fault.largest_bytes ? 6000 : 0};
    assert_int_equal(camber_device_create(s->context, &device_desc, &s->device), CAMBER_OK);
    s->polylines = make_lines(s->context, 3, 60);
    s->others = make_lines(s->context, 4, 30);
    scene_strokes(s->strokes);
    s->strokes[1].offset_px = 6;
    s->desc = (camber_tessellation_desc){s->strokes, CAMBER_KERNEL_ROWS, method, 0, false};
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_mesh_create(s->device, NULL, &mesh), CAMBER_OK);
    assert_int_equal(camber_mesh_tessellate(mesh, s->polylines, &s->desc), CAMBER_OK);
    assert_true(parts ? mesh->part_count > 2 : mesh->part_count == 1);
    assert_int_equal(camber_mesh_read(mesh, &s->wanted), CAMBER_OK);
    assert_int_equal(camber_mesh_read_stages(mesh, &s->stages), CAMBER_OK);
    assert_true(s->wanted.info.vertex_count > 2000);
    camber_mesh_destroy(mesh);
}

static void close_set(stage_set *s) {
    camber_mesh_data_destroy(&s->wanted);
    camber_stages_destroy(&s->stages);
    camber_polylines_destroy(s->others);
    camber_polylines_destroy(s->polylines);
    camber_device_destroy(s->device);
    host_done(&s->h, s->context);
    assert_live(&s->before);
}

static void assert_wanted(const stage_set *s, const camber_mesh_data *mesh) {
    assert_int_equal(mesh->info.vertex_count, s->wanted.info.vertex_count);
    assert_int_equal(mesh->info.index_count, s->wanted.info.index_count);
    assert_int_equal(mesh->info.joins, s->wanted.info.joins);
    assert_memory_equal(mesh->vertices, s->wanted.vertices, mesh->info.vertex_count * sizeof *mesh->vertices);
    assert_memory_equal(mesh->indices, s->wanted.indices, mesh->info.index_count * sizeof *mesh->indices);
}

/* ---- Every call ---- */

typedef camber_status attempt_fn(stage_set *s, void *user);

/* story: what the log says in place of the call's name. NULL: the name. */
static size_t refuse(stage_set *s, attempt_fn *attempt, void *user, const char *story, size_t fault, bool forever) {
    size_t n = 1;
    for (;; n++) {
        assert_true(n < CALLS_MAX);
        const cl_objects live = cl_fault.live;
        const size_t blocks = s->h.live_blocks;
        s->h.errors = 0;
        cl_fault_arm(n, forever ? SIZE_MAX : n, FAULTS[fault].code);
        const camber_status status = attempt(s, user);
        cl_fault_disarm();
        assert_live(&live);
        assert_int_equal(s->h.live_blocks, blocks);
        if (status == CAMBER_OK) {
            assert_int_equal(s->h.errors, 0);
            if (cl_fault.refusals == 0)
                return n;
            if (!story && !is_optional(cl_fault.refused))
                fail_msg("%s (call %zu) was refused, and nothing failed", cl_fault.refused, n);
            continue;
        }
        if (cl_fault.refusals == 0)
            fail_msg("%s, and no call was refused: %s", camber_status_get_name(status), s->h.last);
        if (!story)
            assert_int_equal(status, FAULTS[fault].status);
        else
            assert_true(status == CAMBER_ERROR_MEMORY || status == CAMBER_ERROR_DEVICE);
        assert_non_null(strstr(s->h.last, "; "));
        assert_story(&s->h, story ? story : forever ? ": OpenCL " : cl_fault.refused);
    }
}

static void each_call_fails(stage_set *s, attempt_fn *attempt, void *user, const char *story, size_t least) {
    for (size_t fault = 0; fault < FAULT_COUNT; fault++)
        for (int forever = 0; forever < 2; forever++)
            assert_true(refuse(s, attempt, user, story, fault, forever) > least);
}

static camber_status try_device(stage_set *s, void *user) {
    (void)user;
    camber_device *device = NULL;
    const camber_status status = camber_device_create(s->context, NULL, &device);
    assert_true((status == CAMBER_OK) == (device != NULL));
    if (status == CAMBER_OK) {
        const camber_device_info info = camber_device_get_info(device), wanted = camber_device_get_info(s->device);
        assert_string_equal(info.name, wanted.name);
        assert_true(info.largest_buffer_bytes == wanted.largest_buffer_bytes);
    }
    camber_device_destroy(device);
    return status;
}

static void test_device(void **state) {
    (void)state;
    stage_set s;
    open_set(&s, false, CAMBER_METHOD_STRIP);
    each_call_fails(&s, try_device, NULL, NULL, 12);
    close_set(&s);
}

/* On a device of its own, or on the set's: everything that is known of a mesh. */
static camber_status read_mesh(stage_set *s, camber_device *device) {
    camber_mesh *mesh = NULL;
    camber_mesh_data data;
    camber_stages stages;
    camber_status status = camber_mesh_create(device, NULL, &mesh);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate(mesh, s->polylines, &s->desc);
    if (status == CAMBER_OK)
        status = camber_mesh_read(mesh, &data);
    if (status == CAMBER_OK) {
        assert_wanted(s, &data);
        camber_mesh_data_destroy(&data);
        status = camber_mesh_read_stages(mesh, &stages);
    }
    if (status == CAMBER_OK) {
        assert_int_equal(stages.point_count, s->stages.point_count);
        assert_memory_equal(stages.points, s->stages.points, stages.point_count * sizeof *stages.points);
        camber_stages_destroy(&stages);
    }
    camber_mesh_destroy(mesh);
    return status;
}

static camber_status try_mesh(stage_set *s, void *user) {
    (void)user;
    return read_mesh(s, s->device);
}

static void test_mesh(void **state) {
    (void)state;
    for (int parts = 0; parts < 2; parts++) {
        stage_set s;
        open_set(&s, parts, parts ? CAMBER_METHOD_FAN : CAMBER_METHOD_STRIP);
        if (!parts)
            each_call_fails(&s, try_mesh, NULL, NULL, 50);
        for (int forever = 0; forever < 2 && parts; forever++) /* the same calls for each part: a code for each way */
            assert_true(refuse(&s, try_mesh, NULL, NULL, (size_t)forever % FAULT_COUNT, forever) > 200);
        close_set(&s);
    }
}

static camber_status try_program(stage_set *s, void *user) {
    (void)user;
    camber_device *device = NULL;
    camber_status status = camber_device_create(s->context, NULL, &device);
    if (status == CAMBER_OK)
        status = read_mesh(s, device);
    camber_device_destroy(device);
    return status;
}

static void test_program(void **state) {
    (void)state;
    stage_set s;
    open_set(&s, false, CAMBER_METHOD_STRIP);
    for (size_t fault = 0; fault < FAULT_COUNT; fault++)
        assert_true(refuse(&s, try_program, NULL, NULL, fault, true) > 70);
    close_set(&s);
}

/* ---- The same objects, before and after ---- */

static void assert_right(stage_set *s, camber_mesh *mesh) {
    camber_mesh_data data;
    assert_int_equal(camber_mesh_read(mesh, &data), CAMBER_OK);
    assert_wanted(s, &data);
    camber_mesh_data_destroy(&data);
}

static void assert_nothing(camber_mesh *mesh) {
    camber_mesh_data data;
    assert_int_equal(camber_mesh_read(mesh, &data), CAMBER_OK);
    assert_int_equal(data.info.vertex_count + data.info.index_count + data.info.joins, 0);
    camber_mesh_data_destroy(&data);
}

/* A failed tessellation leaves an empty mesh that works again, whether its polylines were there or are new. */
static void test_mesh_again(void **state) {
    (void)state;
    for (int i = 0; i < 4; i++) {
        const bool parts = i % 2, fresh = i / 2;
        stage_set s;
        camber_mesh *mesh = NULL;
        open_set(&s, parts, CAMBER_METHOD_STRIP);
        assert_int_equal(camber_mesh_create(s.device, NULL, &mesh), CAMBER_OK);
        assert_int_equal(camber_mesh_tessellate(mesh, s.polylines, &s.desc), CAMBER_OK);
        for (size_t n = 1;; n++) {
            assert_true(n < CALLS_MAX);
            if (fresh)
                assert_int_equal(camber_mesh_tessellate(mesh, s.others, &s.desc), CAMBER_OK);
            cl_fault_arm(n, n, CL_OUT_OF_RESOURCES);
            const camber_status status = camber_mesh_tessellate(mesh, s.polylines, &s.desc);
            cl_fault_disarm();
            if (status != CAMBER_OK) {
                assert_int_equal(status, CAMBER_ERROR_MEMORY);
                assert_story(&s.h, cl_fault.refused);
                assert_nothing(mesh);
                assert_int_equal(camber_mesh_tessellate(mesh, s.polylines, &s.desc), CAMBER_OK);
            }
            assert_right(&s, mesh);
            if (cl_fault.refusals == 0)
                break;
        }
        camber_mesh_destroy(mesh);
        close_set(&s);
    }
}

/* Reading and counting leave the mesh as it is. */
static void test_read_again(void **state) {
    (void)state;
    stage_set s;
    camber_mesh *mesh = NULL;
    open_set(&s, true, CAMBER_METHOD_STRIP);
    assert_int_equal(camber_mesh_create(s.device, NULL, &mesh), CAMBER_OK);
    for (size_t n = 1;; n++) {
        const camber_mesh_data untouched = {.indices = (uint32_t *)(uintptr_t)8};
        camber_mesh_data data = untouched;
        assert_int_equal(camber_mesh_tessellate(mesh, s.polylines, &s.desc), CAMBER_OK);
        cl_fault_arm(n, n, CL_OUT_OF_HOST_MEMORY);
        const camber_status status = camber_mesh_read(mesh, &data);
        cl_fault_disarm();
        assert_int_equal(status, cl_fault.refusals ? CAMBER_ERROR_MEMORY : CAMBER_OK);
        if (status == CAMBER_OK) {
            camber_mesh_data_destroy(&data);
            break;
        }
        assert_memory_equal(&data, &untouched, sizeof data);
        assert_story(&s.h, cl_fault.refused);
        assert_right(&s, mesh);
    }
    assert_int_equal(camber_mesh_tessellate(mesh, s.polylines, &s.desc), CAMBER_OK);
    cl_fault_arm(2, 2, CL_OUT_OF_HOST_MEMORY); /* the second map of the first part */
    assert_int_equal(camber_mesh_count_joins(mesh), CAMBER_ERROR_MEMORY);
    camber_mesh_info info = camber_mesh_get_info(mesh);
    cl_fault_disarm();
    assert_story(&s.h, "clEnqueueMapBuffer");
    assert_int_equal(info.vertex_count, s.wanted.info.vertex_count);
    assert_int_equal(info.joins + info.triangle_count, 0);
    assert_int_equal(camber_mesh_count_joins(mesh), CAMBER_OK);
    info = camber_mesh_get_info(mesh);
    assert_int_equal(info.joins, s.wanted.info.joins);
    assert_int_equal(info.triangle_count, s.wanted.info.triangle_count);
    camber_mesh_destroy(mesh);
    close_set(&s);
}

/* ---- Programs ---- */

static void test_build_log(void **state) {
    (void)state;
    stage_set s;
    camber_device *device = NULL;
    camber_mesh *mesh = NULL;
    open_set(&s, false, CAMBER_METHOD_STRIP);
    assert_int_equal(camber_device_create(s.context, NULL, &device), CAMBER_OK);
    assert_int_equal(camber_mesh_create(device, NULL, &mesh), CAMBER_OK);
    const cl_objects live = cl_fault.live;
    char long_log[20000];
    memset(long_log, 'x', sizeof long_log - 1);
    long_log[sizeof long_log - 1] = 0;
    const char *const logs[] = {"emit.cl:7:3: error: no such thing\n  thing(7);\r\n", "", long_log};
    for (size_t i = 0; i < 3; i++) {
        cl_fault.build_log = logs[i];
        assert_int_equal(camber_mesh_tessellate(mesh, s.polylines, &s.desc), CAMBER_ERROR_DEVICE);
        cl_fault.build_log = NULL;
        assert_non_null(strstr(s.h.last, "clBuildProgram"));
        assert_non_null(strstr(s.h.last, "; update"));
        assert_non_null(strstr(s.h.last, camber_device_get_info(device).name));
        assert_true(i != 2 || strstr(s.h.last, "xxxxxxxx"));
        assert_story(&s.h, i == 0 ? "emit.cl:7:3: error: no such thing" : NULL);
        assert_int_equal(cl_fault.live.programs, live.programs);
        assert_int_equal(cl_fault.live.kernels, live.kernels);
    }
    assert_int_equal(camber_mesh_tessellate(mesh, s.polylines, &s.desc), CAMBER_OK);
    assert_right(&s, mesh);
    camber_mesh_destroy(mesh);
    camber_device_destroy(device);
    close_set(&s);
}

/* With a cache that has the kernels: what cannot be loaded is built, and what cannot be saved is not missed. */
static camber_status try_cached(stage_set *s, void *user) {
    const char *folder = user;
    host h = {0};
    camber_context_desc context_desc = host_desc(&h);
    context_desc.cache_dir = folder;
    camber_context *context = NULL;
    camber_device *device = NULL;
    camber_program *program = NULL;
    assert_int_equal(camber_context_create(&context_desc, &context), CAMBER_OK);
    camber_status status = camber_device_create(context, NULL, &device);
    if (status == CAMBER_OK)
        status = camber_device_program(device, (camber_program_desc){s->desc.method, s->desc.has_arc_length, true},
                                       &program);
    s->h.errors += h.errors;
    if (h.errors)
        snprintf(s->h.last, sizeof s->h.last, "%s", h.last);
    camber_device_destroy(device);
    host_done(&h, context);
    return status;
}

static void test_cached_program(void **state) {
    (void)state;
    stage_set s;
    char folder[64];
    folder_make(folder);
    open_set(&s, false, CAMBER_METHOD_STRIP);
    cl_fault_arm(SIZE_MAX, SIZE_MAX, CL_SUCCESS);
    assert_int_equal(try_cached(&s, folder), CAMBER_OK);
    size_t stood_in = 0;
    for (size_t n = 1;; n++) {
        cl_fault_arm(n, n, CL_INVALID_BINARY);
        const camber_status status = try_cached(&s, folder);
        cl_fault_disarm();
        if (cl_fault.refusals == 0)
            break;
        const bool loads = strcmp(cl_fault.refused, "clCreateProgramWithBinary") == 0 ||
                           strcmp(cl_fault.refused, "clBuildProgram") == 0;
        stood_in += loads;
        assert_int_equal(status, loads || is_optional(cl_fault.refused) ? CAMBER_OK : CAMBER_ERROR_DEVICE);
        if (status == CAMBER_OK)
            assert_int_equal(s.h.errors, 0);
        else
            assert_story(&s.h, cl_fault.refused);
    }
    assert_int_equal(stood_in, 2);
    close_set(&s);
    folder_remove(folder);
}

/* ---- A small device ---- */

static void test_small_device(void **state) {
    (void)state;
    stage_set whole, small;
    open_set(&whole, false, CAMBER_METHOD_KITE);
    cl_fault.largest_bytes = 6000;
    open_set(&small, true, CAMBER_METHOD_KITE);
    assert_int_equal(camber_device_get_info(small.device).largest_buffer_bytes, 6000);
    assert_wanted(&whole, &small.wanted);
    assert_int_equal(whole.stages.point_count, small.stages.point_count);
    assert_memory_equal(whole.stages.points, small.stages.points,
                        small.stages.point_count * sizeof *small.stages.points);
    close_set(&small);
    cl_fault.largest_bytes = 0;
    close_set(&whole);
}

/* ---- Drawing ---- */

typedef struct drawn_lines {
    camber_surface *surface;
    camber_sharing sharing;
    camber_renderer *renderer;
    camber_mesh *mesh;
    picture wanted;
    camber_overdraw overdraw;
} drawn_lines;

static camber_paint paints[CAMBER_KERNEL_ROWS];

static camber_status try_renderer(stage_set *s, void *user) {
    const drawn_lines *e = user;
    camber_renderer *renderer = NULL;
    const camber_renderer_desc desc = {.sharing = e->sharing, .rasterizer = CAMBER_RASTERIZER_GL};
    const camber_status status = camber_renderer_create(s->device, e->surface, &desc, &renderer);
    camber_renderer_destroy(renderer);
    return status;
}

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    memcpy((uint8_t *)user + 4 * (size_t)SIDE_PX * first_row, rgba, 4 * (size_t)SIDE_PX * row_count);
    return true;
}

static camber_status draw(const drawn_lines *e, uint8_t *rgba, camber_overdraw *overdraw) {
    const camber_pass pass = {.mesh = e->mesh, .paints = paints, .paint_count = CAMBER_KERNEL_ROWS};
    const camber_frame frame = {.width = SIDE_PX, .height = SIDE_PX, .passes = &pass, .pass_count = 1};
    const camber_overdraw_desc counted = {
        .width = SIDE_PX, .height = SIDE_PX, .mesh = e->mesh, .paints = paints, .paint_count = CAMBER_KERNEL_ROWS};
    const camber_status status = camber_renderer_render(e->renderer, &frame, take_rows, rgba, NULL);
    return status == CAMBER_OK ? camber_renderer_count_overdraw(e->renderer, &counted, overdraw) : status;
}

static void assert_drawn(const drawn_lines *e) {
    uint8_t rgba[4 * SIDE_PX * SIDE_PX];
    camber_overdraw overdraw;
    assert_int_equal(draw(e, rgba, &overdraw), CAMBER_OK);
    assert_memory_equal(rgba, e->wanted.rgba, sizeof rgba);
    assert_memory_equal(&overdraw, &e->overdraw, sizeof overdraw);
}

/* Tessellates and draws with the n-th call refused; then once more without. */
static void draw_after_each(stage_set *s, drawn_lines *e) {
    for (size_t n = 1;; n++) {
        uint8_t rgba[4 * SIDE_PX * SIDE_PX];
        camber_overdraw overdraw;
        assert_true(n < CALLS_MAX);
        assert_int_equal(camber_mesh_tessellate(e->mesh, s->others, &s->desc), CAMBER_OK);
        cl_fault_arm(n, n, CL_OUT_OF_RESOURCES);
        camber_status status = camber_mesh_tessellate(e->mesh, s->polylines, &s->desc);
        const bool tessellated = status == CAMBER_OK;
        if (tessellated)
            status = draw(e, rgba, &overdraw);
        cl_fault_disarm();
        if (status != CAMBER_OK) {
            assert_int_equal(status, CAMBER_ERROR_MEMORY);
            assert_story(&s->h, cl_fault.refused);
        }
        if (!tessellated)
            assert_int_equal(camber_mesh_tessellate(e->mesh, s->polylines, &s->desc), CAMBER_OK);
        assert_drawn(e);
        if (cl_fault.refusals == 0)
            break;
    }
}

static void test_drawing(void **state) {
    (void)state;
    static const camber_sharing sharings[] = {CAMBER_SHARING_AUTO, CAMBER_SHARING_ZERO_COPY, CAMBER_SHARING_COPY};
    size_t drawn = 0;
    for (int k = 0; k < 3 * CAMBER_FIXTURE_BACKENDS; k++) {
        const bool parts = k % 3 == 2;
        stage_set s;
        drawn_lines e = {.sharing = sharings[k % 3]};
        open_set(&s, parts, CAMBER_METHOD_STRIP);
        for (int i = 0; i < CAMBER_KERNEL_ROWS; i++)
            paints[i] = (camber_paint){.width_px = fminf(s.strokes[i].width_px, 2),
                                       .color = {1, 0.5f, (float)i / CAMBER_KERNEL_ROWS, 1}};
        const camber_surface_desc surface_desc = {fixture_backend(k / 3)};
        const camber_renderer_desc renderer_desc = {.sharing = e.sharing, .rasterizer = CAMBER_RASTERIZER_GL};
        if (camber_surface_create(s.context, &surface_desc, &e.surface) == CAMBER_OK &&
            camber_renderer_create(s.device, e.surface, &renderer_desc, &e.renderer) == CAMBER_OK) {
            each_call_fails(&s, try_renderer, &e, "sharing '", 2);
            assert_int_equal(camber_mesh_create(s.device, e.renderer, &e.mesh), CAMBER_OK);
            assert_int_equal(camber_mesh_tessellate(e.mesh, s.polylines, &s.desc), CAMBER_OK);
            assert_true(parts ? e.mesh->part_count > 2 : e.mesh->part_count == 1);
            e.wanted = (picture){.rgba = calloc(SIDE_PX * SIDE_PX, 4), .width = SIDE_PX, .height = SIDE_PX};
            assert_non_null(e.wanted.rgba);
            assert_int_equal(draw(&e, e.wanted.rgba, &e.overdraw), CAMBER_OK);
            assert_true(e.overdraw.drawn_pixels > 200);
            draw_after_each(&s, &e);
            picture_free(&e.wanted);
            drawn++;
        } else {
            print_message("%s, %s: not here\n", fixture_name(k / 3), camber_sharing_get_name(e.sharing));
        }
        camber_mesh_destroy(e.mesh);
        camber_renderer_destroy(e.renderer);
        camber_surface_destroy(e.surface);
        close_set(&s);
    }
    if (drawn == 0)
        skip();
}

/* ---- Drawing with kernels ---- */

/* A device of its own where kernels are to be built, and everything else in any case. */
static camber_status draw_covered(const stage_set *s, camber_device *device, uint8_t *rgba) {
    const camber_renderer_desc desc = {.rasterizer = CAMBER_RASTERIZER_OPENCL};
    camber_pass passes[2] = {{.paints = paints, .paint_count = CAMBER_KERNEL_ROWS}};
    camber_renderer *renderer = NULL;
    camber_mesh *mesh = NULL;
    camber_status status = camber_renderer_create(device, NULL, &desc, &renderer);
    if (status == CAMBER_OK)
        status = camber_mesh_create(device, renderer, &mesh);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate(mesh, s->polylines, &s->desc);
    passes[0].mesh = mesh;
    passes[1] = passes[0];
    passes[1].overlap = CAMBER_OVERLAP_UNITE;
    passes[1].opacity = 0.5f;
    const camber_frame frame = {.width = SIDE_PX, .height = SIDE_PX, .passes = passes, .pass_count = 2};
    if (status == CAMBER_OK)
        status = camber_renderer_render(renderer, &frame, take_rows, rgba, NULL);
    camber_mesh_destroy(mesh);
    camber_renderer_destroy(renderer);
    return status;
}

typedef struct sheet {
    camber_device *device; /* NULL: one is made */
    uint8_t wanted[4 * SIDE_PX * SIDE_PX];
} sheet;

static camber_status try_covered(stage_set *s, void *user) {
    const sheet *of = user;
    uint8_t rgba[4 * SIDE_PX * SIDE_PX];
    camber_device *made = NULL;
    camber_status status = of->device ? CAMBER_OK : camber_device_create(s->context, NULL, &made);
    if (status == CAMBER_OK)
        status = draw_covered(s, of->device ? of->device : made, rgba);
    if (status == CAMBER_OK)
        assert_memory_equal(rgba, of->wanted, sizeof rgba);
    camber_device_destroy(made);
    return status;
}

/* The same calls come again in each slice, and kernels are built for each: of all calls every few. */
static void refuse_some(stage_set *s, sheet *of, bool forever) {
    size_t n = 1;
    for (bool reached = true; reached; n += 1 + n / 6) {
        const cl_objects live = cl_fault.live;
        const size_t blocks = s->h.live_blocks;
        cl_fault_arm(n, forever ? SIZE_MAX : n, FAULTS[0].code);
        const camber_status status = try_covered(s, of);
        cl_fault_disarm();
        reached = cl_fault.refusals > 0;
        assert_live(&live);
        assert_int_equal(s->h.live_blocks, blocks);
        if (status == CAMBER_OK ? reached && !is_optional(cl_fault.refused) : !reached)
            fail_msg("%s (call %zu) was refused: %s", cl_fault.refused, n, camber_status_get_name(status));
        if (status != CAMBER_OK)
            assert_story(&s->h, forever ? ": OpenCL " : cl_fault.refused);
    }
    assert_true(n > 150);
}

/* As a whole, in slices and areas of what small buffers hold, and with the kernels built. */
static void test_covered(void **state) {
    (void)state;
    const camber_device_desc small = {.largest_buffer_bytes = 67000};
    stage_set s;
    sheet whole;
    open_set(&s, false, CAMBER_METHOD_STRIP);
    for (int i = 0; i < CAMBER_KERNEL_ROWS; i++)
        paints[i] = (camber_paint){.width_px = fminf(s.strokes[i].width_px, 2),
                                   .color = {1, 0.5f, (float)i / CAMBER_KERNEL_ROWS, i % 2 ? 1 : 0.5f}};
    whole.device = s.device;
    assert_int_equal(draw_covered(&s, s.device, whole.wanted), CAMBER_OK);
    assert_true(refuse(&s, try_covered, &whole, NULL, 0, false) > 100);
    sheet sliced = whole;
    assert_int_equal(camber_device_create(s.context, &small, &sliced.device), CAMBER_OK);
    assert_int_equal(try_covered(&s, &sliced), CAMBER_OK);
    refuse_some(&s, &sliced, false);
    camber_device_destroy(sliced.device);
    whole.device = NULL;
    refuse_some(&s, &whole, true);
    close_set(&s);
}

static void open_drawn_lines(stage_set *s, drawn_lines *e) {
    assert_int_equal(camber_renderer_create(s->device, NULL, NULL, &e->renderer), CAMBER_OK);
    assert_int_equal(camber_mesh_create(s->device, e->renderer, &e->mesh), CAMBER_OK);
    assert_int_equal(camber_mesh_tessellate(e->mesh, s->polylines, &s->desc), CAMBER_OK);
}

static void close_drawn_lines(drawn_lines *e) {
    camber_mesh_destroy(e->mesh);
    camber_renderer_destroy(e->renderer);
}

static camber_status draw_drawn_lines(const drawn_lines *e, uint8_t *rgba) {
    const camber_pass pass = {.mesh = e->mesh, .paints = paints, .paint_count = CAMBER_KERNEL_ROWS};
    const camber_frame frame = {.width = SIDE_PX, .height = SIDE_PX, .passes = &pass, .pass_count = 1};
    return camber_renderer_render(e->renderer, &frame, take_rows, rgba, NULL);
}

/* A renderer whose first frame has failed, wherever it did, draws the next one right. */
static void test_covered_again(void **state) {
    (void)state;
    stage_set s;
    drawn_lines e = {.renderer = NULL};
    uint8_t wanted[4 * SIDE_PX * SIDE_PX], rgba[sizeof wanted];
    open_set(&s, false, CAMBER_METHOD_STRIP);
    open_drawn_lines(&s, &e);
    assert_int_equal(draw_drawn_lines(&e, wanted), CAMBER_OK);
    close_drawn_lines(&e);
    for (size_t n = 1;; n++) {
        open_drawn_lines(&s, &e);
        cl_fault_arm(n, n, CL_OUT_OF_RESOURCES);
        const camber_status status = draw_drawn_lines(&e, rgba);
        cl_fault_disarm();
        assert_int_equal(status == CAMBER_OK, cl_fault.refusals == 0 || is_optional(cl_fault.refused));
        if (status != CAMBER_OK)
            assert_story(&s.h, cl_fault.refused);
        memset(rgba, 0, sizeof rgba);
        assert_int_equal(draw_drawn_lines(&e, rgba), CAMBER_OK);
        assert_memory_equal(rgba, wanted, sizeof wanted);
        close_drawn_lines(&e);
        if (cl_fault.refusals == 0)
            break;
        assert_true(n < CALLS_MAX);
    }
    close_set(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_device),         cmocka_unit_test(test_mesh),          cmocka_unit_test(test_program),
        cmocka_unit_test(test_mesh_again),     cmocka_unit_test(test_read_again),    cmocka_unit_test(test_build_log),
        cmocka_unit_test(test_cached_program), cmocka_unit_test(test_small_device),  cmocka_unit_test(test_drawing),
        cmocka_unit_test(test_covered),        cmocka_unit_test(test_covered_again),
    };
    int failed = 77;
    char pocl_cache[64];
    pocl_cache_apart(pocl_cache); /* kernels that are not saved are compiled for one size of work-groups */
    if (device_is_there())
        failed = cmocka_run_group_tests(tests, NULL, NULL);
    else
        puts("skipped: no OpenCL device");
    folder_remove(pocl_cache);
    return failed;
}
