/* Faults of the GL: the n-th call fails for every n, and so does making the context current. Each is told once, no row
 * of a wrong picture is handed over, all can be destroyed, and drawing works again: with the same objects, or after the
 * context's loss with new ones. */
#include "gl_fault.h"
#include "gpu/opencl/opencl.h"
#include "pictures.h"

#include "gl/egl.h"

#include <dlfcn.h>

/* ---- The pictures: every kind of pass, in two pieces ---- */

enum { WIDTH = 97, HEIGHT = 61, PIECE_PX = 64, MESHES = 2, ROWS = 3 };

typedef struct drawn_lines {
    host h;
    camber_context *context;
    camber_device *device;
    camber_backend backend;
    camber_sharing sharing;
    camber_surface *surface;
    camber_renderer *renderer;
    camber_mesh *meshes[MESHES];
    bool ready[MESHES]; /* tessellated */
    camber_polylines *polylines;
    uint8_t wanted[4 * WIDTH * HEIGHT];
    bool known; /* wanted is there */
    uint32_t rows;
    bool counts;              /* overdraw, instead of drawing */
    camber_overdraw overdraw; /* the first */
} drawn_lines;

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    drawn_lines *e = user;
    uint8_t *wanted = e->wanted + 4 * WIDTH * (size_t)first_row;
    assert_int_equal(first_row, e->rows);
    assert_true(row_count <= HEIGHT - first_row);
    if (e->known)
        assert_memory_equal(rgba, wanted, 4 * WIDTH * (size_t)row_count);
    else
        memcpy(wanted, rgba, 4 * WIDTH * (size_t)row_count);
    e->rows += row_count;
    return true;
}

static camber_status count(drawn_lines *e, const camber_paint *paints) {
    const camber_overdraw_desc desc = {
        .width = WIDTH, .height = HEIGHT, .mesh = e->meshes[0], .paints = paints, .paint_count = ROWS};
    camber_overdraw counted = {0};
    const camber_status status = camber_renderer_count_overdraw(e->renderer, &desc, &counted);
    if (status == CAMBER_OK && e->overdraw.fragments == 0)
        e->overdraw = counted;
    if (status == CAMBER_OK)
        assert_memory_equal(&counted, &e->overdraw, sizeof counted);
    return status;
}

/* Whatever is missing is made; a mesh that was tessellated is whole. Pictures are held against the first. */
static camber_status draw(drawn_lines *e) {
    static const camber_paint solid[ROWS] = {{.width_px = 9, .color = {1, 0, 0, 1}},
                                             {.width_px = 9, .color = {0, 1, 0, 1}},
                                             {.width_px = 9, .color = {0, 0, 1, 1}}};
    static const camber_paint overlay[ROWS] = {{.width_px = 7, .color = {0, 0, 0, 0.5f}},
                                               {.width_px = 7, .color = {0, 0, 0, 0.5f}},
                                               {.width_px = 7, .color = {0, 0, 0, 0.5f}}};
    static const camber_paint mixed[ROWS] = {{.width_px = 5, .color = {1, 1, 0, 0.4f}},
                                             {.width_px = 5, .color = {0, 1, 1, 0.4f}},
                                             {.width_px = 5, .color = {1, 0, 1, 0.7f}}};
    camber_status status = CAMBER_OK;
    if (!e->renderer)
        status = camber_renderer_create(
            e->device, e->surface, &(camber_renderer_desc){.sharing = e->sharing, .rasterizer = CAMBER_RASTERIZER_GL},
            &e->renderer);
    for (int i = 0; i < MESHES && status == CAMBER_OK; i++) {
        camber_stroke strokes[ROWS];
        for (int k = 0; k < ROWS; k++)
            strokes[k] = (camber_stroke){9, i ? CAMBER_JOIN_MITER : CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0};
        if (!e->meshes[i])
            status = camber_mesh_create(e->device, e->renderer, e->meshes + i);
        if (status == CAMBER_OK && !e->ready[i])
            status = camber_mesh_tessellate(e->meshes[i], e->polylines,
                                            &(camber_tessellation_desc){strokes, ROWS, CAMBER_METHOD_STRIP, 0, false});
        e->ready[i] = status == CAMBER_OK;
    }
    const camber_pass passes[] = {
        {.mesh = e->meshes[0], .paints = solid, .paint_count = ROWS},
        {.mesh = e->meshes[1], .paints = overlay, .paint_count = ROWS},
        {.mesh = e->meshes[0], .paints = mixed, .paint_count = ROWS},
        {.mesh = e->meshes[1], .paints = mixed, .paint_count = ROWS, .overlap = CAMBER_OVERLAP_ACCUMULATE}};
    const camber_frame frame = {.width = WIDTH,
                                .height = HEIGHT,
                                .background = {1, 1, 1, 1},
                                .passes = passes,
                                .pass_count = 4,
                                .largest_area_px = PIECE_PX};
    e->rows = 0;
    if (status == CAMBER_OK && e->counts)
        return count(e, solid);
    if (status == CAMBER_OK)
        status = camber_renderer_render(e->renderer, &frame, take_rows, e, NULL);
    if (status == CAMBER_OK)
        assert_int_equal(e->rows, HEIGHT);
    return status;
}

static void put_away_renderer(drawn_lines *e) {
    for (int i = 0; i < MESHES; i++) {
        camber_mesh_destroy(e->meshes[i]);
        e->meshes[i] = NULL;
        e->ready[i] = false;
    }
    camber_renderer_destroy(e->renderer);
    e->renderer = NULL;
}

/* The next picture is drawn under a fault, from the tessellation on. */
static void begin(drawn_lines *e) {
    memset(e->ready, 0, sizeof e->ready);
    fault_on(e->surface);
}

static void assert_draws(drawn_lines *e) {
    if (draw(e) != CAMBER_OK)
        fail_msg("does not draw again: %s", e->h.last);
    assert_int_equal(e->h.errors, 0);
}

static camber_status new_surface(drawn_lines *e) {
    return camber_surface_create(e->context, &(camber_surface_desc){e->backend}, &e->surface);
}

/* false: not on this machine. */
static bool set_up_drawn_lines(drawn_lines *e, camber_backend backend, camber_sharing sharing) {
    *e = (drawn_lines){.backend = backend, .sharing = sharing};
    camber_context_desc desc = host_desc(&e->h);
    desc.cache_dir = ""; /* or linked shaders are loaded, and fewer calls are made */
    assert_int_equal(camber_context_create(&desc, &e->context), CAMBER_OK);
    assert_int_equal(camber_device_create(e->context, NULL, &e->device), CAMBER_OK);
    camber_made_scene lines = {0};
    uint64_t seed = 3;
    for (size_t i = 0; i < 12; i++) {
        const size_t first = lines.point_count;
        camber_made_scene_walk(&lines, &seed, 6, (const double[]){5, 40}, 1.5);
        for (size_t k = first; k < lines.point_count; k++) {
            lines.points[2 * k] = fmodf(fabsf(lines.points[2 * k]), WIDTH);
            lines.points[2 * k + 1] = fmodf(fabsf(lines.points[2 * k + 1]), HEIGHT);
        }
        camber_made_scene_end(&lines, i % ROWS);
    }
    e->polylines = scene_polylines(e->context, &lines);
    camber_made_scene_free(&lines);
    if (new_surface(e) == CAMBER_OK && draw(e) == CAMBER_OK) {
        e->known = true;
        return true;
    }
    printf("not here: %s\n", e->h.last);
    e->h.errors = 0;
    return false;
}

static void put_away(drawn_lines *e) {
    put_away_renderer(e);
    camber_surface_destroy(e->surface);
    camber_polylines_destroy(e->polylines);
    camber_device_destroy(e->device);
    assert_int_equal(e->h.errors, 0);
    host_done(&e->h, e->context);
}

static const struct road {
    camber_backend backend;
    camber_sharing sharing;
} ROADS[] = {{CAMBER_BACKEND_EGL, CAMBER_SHARING_ZERO_COPY},
             {CAMBER_BACKEND_EGL, CAMBER_SHARING_COPY},
             {CAMBER_BACKEND_OSMESA, CAMBER_SHARING_AUTO}};

/* Calls check with drawn lines for each way of drawing that is here. */
static void on_each_road(void (*check)(drawn_lines *e)) {
    size_t found = 0;
    for (size_t i = 0; i < sizeof ROADS / sizeof *ROADS; i++) {
        drawn_lines e;
        if (set_up_drawn_lines(&e, ROADS[i].backend, ROADS[i].sharing)) {
            check(&e);
            found++;
        }
        put_away(&e);
    }
    assert_true(found > 0);
}

static void assert_told(drawn_lines *e, camber_status status, camber_status wanted, const char *part) {
    if (status != wanted)
        fail_msg("status '%s', not '%s': %s", camber_status_get_name(status), camber_status_get_name(wanted),
                 e->h.last);
    assert_non_null(strchr(e->h.last, ';')); /* the cure */
    assert_story(&e->h, part);
}

/* After a loss: all is refused in one line, destroyed without a word, and made again. */
static void assert_lost_and_found(drawn_lines *e) {
    assert_true(camber_surface_is_lost(e->surface));
    assert_told(e, draw(e), CAMBER_ERROR_DEVICE, "lost");
    fault_off();
    assert_told(e, draw(e), CAMBER_ERROR_DEVICE, "lost");
    put_away_renderer(e);
    camber_surface_destroy(e->surface);
    e->surface = NULL;
    assert_int_equal(e->h.errors, 0);
    assert_int_equal(new_surface(e), CAMBER_OK);
    assert_false(camber_surface_is_lost(e->surface));
    assert_draws(e);
}

/* ---- Every call ---- */

/* fresh: the renderer is made under the fault too. */
static void sweep(drawn_lines *e, GLenum error, bool fresh) {
    const bool lost = error == GL_CONTEXT_LOST_KHR;
    size_t n = 1, told = 0;
    for (bool reached = true; reached; n++) {
        assert_true(n < 2000);
        if (fresh)
            put_away_renderer(e);
        begin(e);
        fault.fail_at = n;
        fault.error = error;
        const camber_status status = draw(e);
        reached = fault.calls >= n;
        if (status != CAMBER_OK) {
            assert_told(e, status, error == GL_OUT_OF_MEMORY ? CAMBER_ERROR_MEMORY : CAMBER_ERROR_DEVICE, NULL);
            told++;
        }
        assert_int_equal(e->h.errors, 0);
        if (lost && reached) {
            assert_lost_and_found(e);
        } else {
            fault_off();
            assert_draws(e);
        }
    }
    assert_true(n > (e->counts ? 50 : 100));
    /* Where another way of sharing stands in for one that fails, drawing goes on. */
    assert_true(told == n - 2 || (fresh && e->sharing == CAMBER_SHARING_AUTO && told > n - 20));
}

static void check_calls(drawn_lines *e) {
    sweep(e, GL_OUT_OF_MEMORY, true);
    if (e->sharing == CAMBER_SHARING_COPY)
        return; /* drawn as the others are */
    sweep(e, GL_INVALID_OPERATION, false);
    sweep(e, GL_CONTEXT_LOST_KHR, false);
    e->counts = true;
    assert_draws(e);
    assert_true(e->overdraw.drawn_pixels > 0);
    sweep(e, GL_OUT_OF_MEMORY, true);
}

static void test_each_call_fails(void **state) {
    (void)state;
    on_each_road(check_calls);
}

/* ---- Calls that fail without an error of GL's ---- */

static void fail_silently(drawn_lines *e, const char *function, camber_status wanted, const char *part) {
    for (size_t n = 1;; n++) {
        put_away_renderer(e);
        begin(e);
        fault.only = function;
        fault.fail_at = n;
        fault.error = GL_NO_ERROR;
        const camber_status status = draw(e);
        const bool reached = fault.calls >= n;
        fault_off();
        if (status != CAMBER_OK)
            assert_told(e, status, wanted, part);
        assert_int_equal(e->h.errors, 0);
        assert_draws(e);
        if (!reached) {
            assert_true(n > 1);
            return;
        }
        assert_true(status != CAMBER_OK || e->sharing == CAMBER_SHARING_AUTO);
    }
}

static void check_silent(drawn_lines *e) {
    fail_silently(e, "CompileShader", CAMBER_ERROR_DEVICE, "does not compile on ");
    fail_silently(e, "CompileShader", CAMBER_ERROR_DEVICE, "0:1: no such thing 0:2: nor this");
    fail_silently(e, "LinkProgram", CAMBER_ERROR_DEVICE, "do not link on ");
    fail_silently(e, "LinkProgram", CAMBER_ERROR_DEVICE, "0:1: no such thing 0:2: nor this");
    fail_silently(e, "CheckFramebufferStatus", CAMBER_ERROR_DEVICE, "0x8cdd");
}

static void test_silent_failures(void **state) {
    (void)state;
    on_each_road(check_silent);
}

/* A map that is refused without an error: past the choice of a path the mesh is out of memory. */
static void check_maps(drawn_lines *e) {
    if (e->sharing != CAMBER_SHARING_ZERO_COPY)
        return;
    for (size_t n = 1; n <= 4; n++) { /* two of the choice, one a mesh */
        put_away_renderer(e);
        begin(e);
        fault.only = "MapBufferRange";
        fault.fail_at = n;
        fault.error = GL_NO_ERROR;
        const camber_status status = draw(e);
        const bool choosing = !e->renderer;
        fault_off();
        assert_told(e, status, choosing && n == 2 ? CAMBER_ERROR_DEVICE : CAMBER_ERROR_MEMORY,
                    choosing ? "'zero copy' does not work" : "cannot be mapped");
        assert_draws(e);
    }
}

static void test_no_map(void **state) {
    (void)state;
    on_each_road(check_maps);
}

/* ---- Errors at each query ---- */

static void check_queries(drawn_lines *e) {
    const GLenum errors[] = {GL_OUT_OF_MEMORY, GL_INVALID_OPERATION, GL_CONTEXT_LOST_KHR};
    for (int i = 0; i < 3; i++) {
        size_t n = 1;
        for (bool reached = true; reached; n++) {
            assert_true(n < 500);
            begin(e);
            fault.query_fail_at = n;
            fault.error = errors[i];
            const camber_status status = draw(e);
            reached = fault.queries >= n;
            if (reached)
                assert_told(e, status, i == 0 ? CAMBER_ERROR_MEMORY : CAMBER_ERROR_DEVICE,
                            i == 2 ? "lost" : e->surface->info.renderer);
            else
                assert_int_equal(status, CAMBER_OK);
            if (i == 2 && reached) {
                assert_lost_and_found(e);
            } else {
                fault_off();
                assert_draws(e);
            }
        }
        assert_true(n > 4);
    }
}

static void test_error_at_each_query(void **state) {
    (void)state;
    on_each_road(check_queries);
}

/* ---- Contexts that cannot be made current, and lost ones ---- */

static void check_current(drawn_lines *e) {
    for (int lost = 0; lost < 2; lost++) {
        size_t n = 1, told = 0;
        for (bool reached = true; reached; n++) {
            put_away_renderer(e);
            begin(e);
            fault.current_fail_at = n;
            fault.current_lost = lost;
            const camber_status status = draw(e);
            reached = fault.current_calls >= n;
            told += status != CAMBER_OK;
            if (status != CAMBER_OK)
                assert_told(e, status, CAMBER_ERROR_DEVICE, lost ? "lost" : "cannot be made current");
            if (lost && reached) {
                assert_lost_and_found(e);
            } else {
                fault_off();
                assert_draws(e);
            }
        }
        assert_true(told > 5 && told + 4 > n); /* what only frees does without */
    }
}

/* Whatever is destroyed while the context cannot be made current says nothing, and OpenCL's side of the buffers goes.
 */
static void check_destruction(drawn_lines *e) {
    enum { REFERENCE_COUNT = 0x1105 }; /* CL_MEM_REFERENCE_COUNT */
    cl_int (*retain)(cl_mem), (*get_info)(cl_mem, cl_uint, size_t, void *, size_t *);
    void *library = dlopen("libOpenCL.so.1", RTLD_NOW | RTLD_LOCAL);
    assert_non_null(library);
    void *symbols[] = {dlsym(library, "clRetainMemObject"), dlsym(library, "clGetMemObjectInfo")};
    memcpy(&retain, symbols, sizeof retain);
    memcpy(&get_info, symbols + 1, sizeof get_info);
    for (size_t n = 1; n <= 3; n++) { /* a buffer a mesh, and the renderer */
        cl_mem mem = e->meshes[0]->parts[0].buffers[CAMBER_BUFFER_RECORDS].buffer->native;
        cl_uint count = 0;
        assert_int_equal(retain(mem), CL_SUCCESS);
        begin(e);
        fault.current_fail_at = n;
        put_away_renderer(e);
        assert_true(fault.current_calls >= n);
        fault_off();
        assert_int_equal(e->h.errors, 0);
        assert_int_equal(get_info(mem, REFERENCE_COUNT, sizeof count, &count, NULL), CL_SUCCESS);
        assert_int_equal(count, 1);
        camber_cl.ReleaseMemObject(mem);
        assert_draws(e);
    }
    dlclose(library);
}

static void test_not_current(void **state) {
    (void)state;
    on_each_road(check_current);
    on_each_road(check_destruction);
}

static void check_reset(drawn_lines *e) {
    for (size_t n = 1;; n++) {
        begin(e);
        fault.reset_at = n;
        const camber_status status = draw(e);
        const bool reached = fault.resets >= n;
        if (!reached) {
            fault_off();
            assert_int_equal(status, CAMBER_OK);
            assert_true(n > 4);
            return;
        }
        assert_told(e, status, CAMBER_ERROR_DEVICE, "lost");
        assert_lost_and_found(e);
    }
}

static void test_reset(void **state) {
    (void)state;
    on_each_road(check_reset);
}

/* EGL's contexts ask to be told. */
static void check_notification(drawn_lines *e) {
    enum { RESET_NOTIFICATION_STRATEGY = 0x8256, LOSE_CONTEXT_ON_RESET = 0x8252 };
    GLint strategy = 0;
    assert_int_equal(camber_surface_make_current(e->surface), CAMBER_OK);
    if (e->backend != CAMBER_BACKEND_EGL || !e->surface->gl.GetGraphicsResetStatus)
        return;
    e->surface->gl.GetIntegerv(RESET_NOTIFICATION_STRATEGY, &strategy);
    assert_int_equal(strategy, LOSE_CONTEXT_ON_RESET);
    assert_int_equal(camber_surface_check(e->surface, "a query"), CAMBER_OK);
}

static void test_contexts_tell_of_resets(void **state) {
    (void)state;
    on_each_road(check_notification);
}

/* One surface is lost; the other, of the same context and device, does not notice. */
static void check_others(drawn_lines *e) {
    camber_surface *lost = e->surface;
    camber_renderer *renderer = e->renderer;
    camber_mesh *meshes[MESHES] = {e->meshes[0], e->meshes[1]};
    e->renderer = NULL;
    memset(e->meshes, 0, sizeof e->meshes);
    memset(e->ready, 0, sizeof e->ready);
    assert_int_equal(new_surface(e), CAMBER_OK);
    lost->lost = true;
    assert_draws(e);
    for (int i = 0; i < MESHES; i++)
        camber_mesh_destroy(meshes[i]);
    assert_draws(e);
    camber_renderer_destroy(renderer);
    camber_surface_destroy(lost);
    assert_draws(e);
}

static void test_loss_leaves_others(void **state) {
    (void)state;
    on_each_road(check_others);
}

/* No fake: another part of the process terminates the display that EGL gives to all of it. */
static void check_terminated(drawn_lines *e) {
    void *library = e->backend == CAMBER_BACKEND_EGL ? dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL) : NULL;
    if (!library || strcmp(e->surface->info.backend, "EGL surfaceless") != 0)
        return;
    EGLBoolean (*terminate)(EGLDisplay);
    camber_function *(*load)(const char *);
    camber_egl_get_platform_display_fn *get_display;
    void *symbol = dlsym(library, "eglTerminate");
    memcpy(&terminate, &symbol, sizeof symbol);
    symbol = dlsym(library, "eglGetProcAddress");
    memcpy(&load, &symbol, sizeof symbol);
    camber_function *function = load("eglGetPlatformDisplayEXT");
    memcpy(&get_display, &function, sizeof function);
    assert_true(terminate(get_display(EGL_PLATFORM_SURFACELESS_MESA, NULL, NULL)));
    assert_told(e, draw(e), CAMBER_ERROR_DEVICE, "cannot be made current");
    put_away_renderer(e);
    camber_surface_destroy(e->surface);
    e->surface = NULL;
    assert_int_equal(e->h.errors, 0);
    assert_int_equal(new_surface(e), CAMBER_OK);
    assert_draws(e);
    dlclose(library);
}

static void test_display_terminated(void **state) {
    (void)state;
    if (IS_SANITIZED)
        skip(); /* EGL unloads the driver, and what that leaves cannot be told from a leak of ours any more */
    on_each_road(check_terminated);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_call_fails),
        cmocka_unit_test(test_silent_failures),
        cmocka_unit_test(test_no_map),
        cmocka_unit_test(test_error_at_each_query),
        cmocka_unit_test(test_not_current),
        cmocka_unit_test(test_reset),
        cmocka_unit_test(test_contexts_tell_of_resets),
        cmocka_unit_test(test_loss_leaves_others),
        cmocka_unit_test(test_display_terminated),
    };
    const int failed = device_is_there() ? cmocka_run_group_tests(tests, NULL, NULL) : 77;
    return failed;
}
