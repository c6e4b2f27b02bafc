/* Memory stays flat over 1,000 frames, and over 200 cycles of making and destroying everything, with each drawer; what
 * the drivers keep by themselves is measured apart, on bare contexts, and taken off. Files and threads are counted too.
 * The first run draws in GL what OpenCL makes, the second draws by kernels of the back end cpu, which has no drivers.
 */
#define _DEFAULT_SOURCE /* mallinfo2 */
#define _XOPEN_SOURCE 700

#include "pictures.h"

#include "gl/egl.h"
#include "gpu/opencl/cl.h"
#include "residency/mesh.h"

#include <dirent.h>
#include <dlfcn.h>
#include <malloc.h>

/* AddressSanitizer keeps freed memory back, and looks for leaks by itself. */
#if defined(__SANITIZE_ADDRESS__)
enum { HOLDS_BACK = 1, FRAMES = 100, CYCLES = 20 };
#else
enum { HOLDS_BACK = 0, FRAMES = 1000, CYCLES = 200 };
#endif

/* ---- Held by the process ---- */

typedef struct usage {
    double resident, heap; /* bytes; heap is 0 where the C library does not tell */
    size_t files, threads;
} usage;

static size_t count_entries(const char *path) {
    DIR *folder = opendir(path);
    size_t count = 0;
    while (folder && readdir(folder))
        count++;
    if (folder)
        closedir(folder);
    return count;
}

static usage measure(void) {
    usage u = {.files = count_entries("/proc/self/fd"), .threads = count_entries("/proc/self/task")};
    size_t total = 0, resident = 0;
#if defined(__GLIBC__)
    malloc_trim(0);
#if __GLIBC_PREREQ(2, 33)
    const struct mallinfo2 info = mallinfo2();
    u.heap = (double)info.uordblks + (double)info.hblkhd;
#endif
#endif
    FILE *file = fopen("/proc/self/statm", "r");
    if (file && fscanf(file, "%zu %zu", &total, &resident) == 2)
        u.resident = (double)resident * (double)sysconf(_SC_PAGESIZE);
    if (file)
        fclose(file);
    return u;
}

/* Growth from a to b; bytes a cycle. */
typedef struct growth {
    double resident, heap;
} growth;

static growth grown(usage a, usage b, size_t cycles, const char *what) {
    const growth g = {(b.resident - a.resident) / (double)cycles, (b.heap - a.heap) / (double)cycles};
    print_message("%-34s %8.1f MB, %+9.1f bytes of it and %+9.1f of the heap a cycle, %zu files, %zu threads\n", what,
                  b.resident / 1e6, g.resident, g.heap, b.files, b.threads);
    if (b.files > a.files)
        fail_msg("%s: %zu open files, and then %zu", what, a.files, b.files);
    if (b.threads > a.threads)
        fail_msg("%s: %zu threads, and then %zu", what, a.threads, b.threads);
    return g;
}

static void assert_at_most(growth g, double resident, double heap, const char *what) {
    if (HOLDS_BACK)
        return;
    if (g.resident > resident)
        fail_msg("%s: %.1f bytes a cycle stay resident, more than %.1f", what, g.resident, resident);
    if (g.heap > heap)
        fail_msg("%s: %.1f bytes a cycle stay on the heap, more than %.1f", what, g.heap, heap);
}

/* ---- Bare contexts, without camber ---- */

typedef void draw_fn(void);

static void clear(void (*(*load)(const char *name))(void)) {
    void (*clear_color)(GLfloat, GLfloat, GLfloat, GLfloat), (*clear_buffer)(GLbitfield), (*finish)(void);
    draw_fn *functions[] = {load("glClearColor"), load("glClear"), load("glFinish")};
    memcpy(&clear_color, functions, sizeof clear_color);
    memcpy(&clear_buffer, functions + 1, sizeof clear_buffer);
    memcpy(&finish, functions + 2, sizeof finish);
    clear_color(1, 0, 0, 1);
    clear_buffer(GL_COLOR_BUFFER_BIT);
    finish();
}

static void find(void *library, const char *name, void *function) {
    void *symbol = dlsym(library, name);
    assert_non_null(symbol);
    memcpy(function, &symbol, sizeof symbol);
}

static bool cycle_egl(void) {
    static void *library;
    static EGLDisplay display = NULL;
    draw_fn *(*load)(const char *);
    EGLBoolean (*initialize)(EGLDisplay, EGLint *, EGLint *);
    EGLBoolean (*bind)(EGLenum);
    EGLContext (*create)(EGLDisplay, EGLConfig, EGLContext, const EGLint *);
    EGLBoolean (*make_current)(EGLDisplay, EGLSurface, EGLSurface, EGLContext);
    EGLBoolean (*destroy)(EGLDisplay, EGLContext);
    camber_egl_get_platform_display_fn *get_display;
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION_KHR, 3, EGL_NONE};
    library = library ? library : dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!library)
        return false;
    find(library, "eglGetProcAddress", &load);
    find(library, "eglInitialize", &initialize);
    find(library, "eglBindAPI", &bind);
    find(library, "eglCreateContext", &create);
    find(library, "eglMakeCurrent", &make_current);
    find(library, "eglDestroyContext", &destroy);
    draw_fn *function = load("eglGetPlatformDisplayEXT");
    memcpy(&get_display, &function, sizeof function);
    if (!display) {
        display = get_display(EGL_PLATFORM_SURFACELESS_MESA, NULL, NULL);
        if (!initialize(display, NULL, NULL))
            return false;
    }
    bind(EGL_OPENGL_ES_API);
    EGLContext context = create(display, NULL, NULL, wanted);
    if (!context || !make_current(display, NULL, NULL, context))
        return false;
    clear(load);
    make_current(display, NULL, NULL, NULL);
    return destroy(display, context);
}

static bool cycle_osmesa(void) {
    static void *library;
    const int wanted[] = {0x22, GL_RGBA, 0x33, 0x34, 0x36, 4, 0x37, 3, 0}; /* RGBA, core profile, 4.3 */
    void *(*create)(const int *attributes, void *share);
    GLboolean (*make_current)(void *context, void *buffer, GLenum type, GLsizei width, GLsizei height);
    void (*destroy)(void *context);
    draw_fn *(*load)(const char *name);
    uint32_t pixel;
    library = library ? library : dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
    if (!library)
        return false;
    find(library, "OSMesaCreateContextAttribs", &create);
    find(library, "OSMesaMakeCurrent", &make_current);
    find(library, "OSMesaDestroyContext", &destroy);
    find(library, "OSMesaGetProcAddress", &load);
    void *context = create(wanted, NULL);
    if (!context || !make_current(context, &pixel, GL_UNSIGNED_BYTE, 1, 1))
        return false;
    clear(load);
    make_current(NULL, NULL, 0, 0, 0);
    destroy(context);
    return true;
}

static bool (*const CYCLE_BARE[CAMBER_FIXTURE_BACKENDS])(void) = {cycle_egl, cycle_osmesa};

/* The same of OpenCL: a context, a program that is built and run. */
static bool cycle_opencl(void) {
    static const char *source = "kernel void fill(global float *to) { to[get_global_id(0)] = sqrt(2.0f); }";
    const size_t count = 64;
    cl_platform_id platform;
    cl_device_id id;
    cl_int code = camber_cl_load() ? CL_DEVICE_NOT_FOUND : camber_cl.GetPlatformIDs(1, &platform, NULL);
    if (code != CL_SUCCESS || camber_cl.GetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &id, NULL) != CL_SUCCESS)
        return false;
    cl_context context = camber_cl.CreateContext(NULL, 1, &id, NULL, NULL, &code);
    assert_int_equal(code, CL_SUCCESS);
    cl_command_queue queue = camber_cl.CreateCommandQueue(context, id, 0, &code);
    cl_program program = camber_cl.CreateProgramWithSource(context, 1, &source, NULL, &code);
    assert_int_equal(camber_cl.BuildProgram(program, 1, &id, "", NULL, NULL), CL_SUCCESS);
    cl_kernel kernel = camber_cl.CreateKernel(program, "fill", &code);
    cl_mem mem = camber_cl.CreateBuffer(context, CL_MEM_READ_WRITE, 4 * count, NULL, &code);
    assert_int_equal(camber_cl.SetKernelArg(kernel, 0, sizeof mem, &mem), CL_SUCCESS);
    assert_int_equal(camber_cl.EnqueueNDRangeKernel(queue, kernel, 1, NULL, &count, NULL, 0, NULL, NULL), CL_SUCCESS);
    assert_int_equal(camber_cl.Finish(queue), CL_SUCCESS);
    camber_cl.ReleaseMemObject(mem);
    camber_cl.ReleaseKernel(kernel);
    camber_cl.ReleaseProgram(program);
    camber_cl.ReleaseCommandQueue(queue);
    return camber_cl.ReleaseContext(context) == CL_SUCCESS;
}

/* ---- The pictures ---- */

enum { ROWS = 4, SCENES = 7 };

typedef struct atelier {
    fixture s;
    bool here[CAMBER_FIXTURE_DRAWERS];
    bool is_cpu;                      /* the device has no driver */
    char cache[64];                   /* of kernels */
    camber_made_scene scenes[SCENES]; /* of sizes that go up and down */
    uint64_t sum;                     /* of what has been drawn: the work is not left out */
} atelier;

static const camber_stroke STROKES[ROWS] = {{12, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0},
                                            {5, CAMBER_JOIN_MITER, CAMBER_CAP_BUTT, 0},
                                            {3, CAMBER_JOIN_BEVEL, CAMBER_CAP_SQUARE, 0},
                                            {1, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0}};

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    atelier *a = user;
    a->sum += rgba[0] + (uint64_t)first_row + row_count;
    return true;
}

/* The n-th frame: other lines, another method, size, pieces, and every kind of pass. */
static camber_status draw(camber_context *context, camber_renderer *renderer, camber_mesh *mesh, atelier *a, size_t n) {
    static const uint32_t pieces[] = {0, 96, 61, 128, 33};
    camber_paint solid[ROWS], layered[ROWS];
    for (size_t i = 0; i < ROWS; i++) {
        solid[i] = (camber_paint){.width_px = STROKES[i].width_px, .color = {1, (float)i / ROWS, 0, 1}};
        layered[i] = (camber_paint){.width_px = STROKES[i].width_px,
                                    .color = {0, 0, n % 2 ? (float)i / ROWS : 1.0f, i < 2 ? 0.5f : 0.3f}};
    }
    camber_polylines *polylines = scene_polylines(context, a->scenes + n % SCENES);
    const camber_tessellation_desc desc = {STROKES, ROWS, (camber_method)(n % 3), 0, false};
    camber_status status = camber_mesh_tessellate(mesh, polylines, &desc);
    const camber_pass passes[] = {
        {.mesh = mesh, .paints = solid, .paint_count = ROWS},
        {.mesh = mesh, .paints = layered, .paint_count = ROWS},
        {.mesh = mesh, .paints = layered, .paint_count = ROWS, .overlap = CAMBER_OVERLAP_ACCUMULATE}};
    const camber_frame frame = {.width = 100 + (uint32_t)(n * 37 % 60),
                                .height = 80 + (uint32_t)(n * 23 % 50),
                                .passes = passes,
                                .pass_count = 3,
                                .coverage = (camber_coverage)(n / 3 % 2),
                                .largest_area_px = pieces[n % 5]};
    if (status == CAMBER_OK)
        status = camber_renderer_render(renderer, &frame, take_rows, a, NULL);
    camber_polylines_destroy(polylines);
    return status;
}

static int set_up(void **state) {
    atelier *a = calloc(1, sizeof *a);
    assert_non_null(a);
    static const size_t lines[SCENES] = {3, 200, 20, 400, 1, 90, 300};
    uint64_t seed = 6;
    for (size_t i = 0; i < SCENES; i++)
        for (size_t k = 0; k < lines[i]; k++) {
            camber_made_scene_walk(a->scenes + i, &seed, 10, (const double[]){2, 20}, 2);
            camber_made_scene_end(a->scenes + i, k * ROWS / lines[i]);
        }
    folder_make(a->cache);
    /* With the drivers' threads and libraries there from the beginning. */
    assert_true(fixture_open(&a->s));
    for (int i = 0; i < CAMBER_FIXTURE_DRAWERS; i++)
        a->here[i] = a->s.on.renderer[i] != NULL;
    a->is_cpu = camber_device_get_info(a->s.on.device).fixed_kernels;
    fixture_close(&a->s);
    *state = a;
    return 0;
}

static int tear_down(void **state) {
    atelier *a = *state;
    for (size_t i = 0; i < SCENES; i++)
        camber_made_scene_free(a->scenes + i);
    folder_remove(a->cache);
    free(a);
    return 0;
}

/* With a fixture around the test, but for those that want nothing else to be open. */
static int open_fixture(void **state) {
    atelier *a = *state;
    assert_true(fixture_open(&a->s));
    return 0;
}

static int close_fixture(void **state) {
    atelier *a = *state;
    fixture_close(&a->s);
    assert_int_equal(a->s.h.live_blocks, 0);
    return 0;
}

/* ---- 1,000 frames ---- */

static void test_frames(void **state) {
    enum { WARM_UP = 210 }; /* all combinations of the above */
    atelier *a = *state;
    for (int i = 0; i < CAMBER_FIXTURE_DRAWERS; i++) {
        if (!a->s.on.renderer[i])
            continue;
        camber_mesh *mesh = NULL;
        usage before = {0};
        size_t live = 0;
        assert_int_equal(camber_mesh_create(a->s.on.device, a->s.on.renderer[i], &mesh), CAMBER_OK);
        for (size_t n = 0; n < WARM_UP + FRAMES; n++) {
            if (n == WARM_UP) {
                before = measure();
                live = a->s.h.live_blocks;
            }
            assert_int_equal(draw(a->s.context, a->s.on.renderer[i], mesh, a, n), CAMBER_OK);
        }
        const usage after = measure();
        assert_int_equal(a->s.h.live_blocks, live);
        const growth g = grown(before, after, FRAMES, fixture_name(i));
        assert_at_most(g, 1024, 64, "a frame"); /* 1 MB of noise in all */
        camber_mesh_destroy(mesh);
    }
}

/* ---- 200 cycles ---- */

typedef camber_status cycle_fn(atelier *a, int drawer);

static camber_status cycle_meshes(atelier *a, int drawer) {
    camber_mesh *mesh = NULL;
    camber_status status = camber_mesh_create(a->s.on.device, a->s.on.renderer[drawer], &mesh);
    if (status == CAMBER_OK)
        status = draw(a->s.context, a->s.on.renderer[drawer], mesh, a, 1);
    camber_mesh_destroy(mesh);
    return status;
}

static camber_status draw_on(atelier *a, camber_context *context, camber_device *device, camber_surface *surface) {
    camber_renderer *renderer = NULL;
    camber_mesh *mesh = NULL;
    const camber_renderer_desc desc = {.rasterizer = surface ? CAMBER_RASTERIZER_GL : CAMBER_RASTERIZER_OPENCL};
    camber_status status = camber_renderer_create(device, surface, &desc, &renderer);
    if (status == CAMBER_OK)
        status = camber_mesh_create(device, renderer, &mesh);
    if (status == CAMBER_OK)
        status = draw(context, renderer, mesh, a, 1);
    camber_mesh_destroy(mesh);
    camber_renderer_destroy(renderer);
    return status;
}

static camber_status cycle_renderers(atelier *a, int drawer) {
    return draw_on(a, a->s.context, a->s.on.device, drawer == CAMBER_FIXTURE_OPENCL ? NULL : a->s.on.surface[drawer]);
}

static camber_status cycle_surfaces(atelier *a, int drawer) {
    camber_surface *surface = NULL;
    camber_status status =
        camber_surface_create(a->s.context, &(camber_surface_desc){fixture_backend(drawer)}, &surface);
    if (status == CAMBER_OK)
        status = draw_on(a, a->s.context, a->s.on.device, surface);
    camber_surface_destroy(surface);
    return status;
}

static camber_status cycle_contexts(atelier *a, int drawer) {
    host h = {0};
    camber_context_desc desc = host_desc(&h);
    desc.cache_dir = a->cache;
    camber_context *context = NULL;
    camber_device *device = NULL;
    camber_surface *surface = NULL;
    camber_status status = camber_context_create(&desc, &context);
    if (status == CAMBER_OK && drawer != CAMBER_FIXTURE_OPENCL)
        status = camber_surface_create(context, &(camber_surface_desc){fixture_backend(drawer)}, &surface);
    if (status == CAMBER_OK)
        status =
            camber_device_create(context, &(camber_device_desc){.gl = camber_surface_get_handles(surface)}, &device);
    if (status == CAMBER_OK)
        status = draw_on(a, context, device, surface);
    camber_device_destroy(device);
    camber_surface_destroy(surface);
    camber_context_destroy(context);
    assert_int_equal(h.live_blocks, 0);
    return status;
}

enum { FIRST_CYCLES = 20 };

static growth repeat_bare(bool (*cycle)(void), const char *what) {
    usage before = {0};
    for (size_t n = 0; n < FIRST_CYCLES + CYCLES; n++) {
        if (n == FIRST_CYCLES)
            before = measure();
        assert_true(cycle());
    }
    return grown(before, measure(), CYCLES, what);
}

/* Growth over so many cycles, after some that fill what is filled once. */
static growth grow(atelier *a, int drawer, cycle_fn *cycle, const char *what) {
    usage before = {0};
    for (size_t n = 0; n < FIRST_CYCLES + CYCLES; n++) {
        if (n == FIRST_CYCLES)
            before = measure();
        assert_int_equal(cycle(a, drawer), CAMBER_OK);
    }
    return grown(before, measure(), CYCLES, what);
}

/* Ours is what grows past the drivers' own. They fill some things late, on a busy machine twice: what leaks grows every
 * time. */
static void repeat(atelier *a, int drawer, cycle_fn *cycle, growth drivers, const char *what) {
    static const double RESIDENT_MOST = 8192, HEAP_MOST = 512;
    char name[64];
    growth ours = {INFINITY, INFINITY};
    snprintf(name, sizeof name, "%s, %s", fixture_name(drawer), what);
    for (int turn = 0; turn < 4 && (ours.resident > RESIDENT_MOST || ours.heap > HEAP_MOST); turn++) {
        const growth all = grow(a, drawer, cycle, name);
        ours = (growth){all.resident - fmax(drivers.resident, 0), all.heap - fmax(drivers.heap, 0)};
    }
    assert_at_most(ours, RESIDENT_MOST, HEAP_MOST, name);
}

static void test_cycles(void **state) {
    atelier *a = *state;
    for (int i = 0; i < CAMBER_FIXTURE_DRAWERS; i++) {
        char name[64];
        if (!a->s.on.renderer[i])
            continue;
        repeat(a, i, cycle_meshes, (growth){0}, "meshes");
        repeat(a, i, cycle_renderers, (growth){0}, "renderers");
        if (i == CAMBER_FIXTURE_OPENCL)
            continue;
        snprintf(name, sizeof name, "%s, bare contexts", fixture_name(i));
        repeat(a, i, cycle_surfaces, repeat_bare(CYCLE_BARE[i], name), "surfaces");
    }
}

/* Everything that can be made. Nothing else is open: PoCL 3.1 keeps some 5 kB of each program as long as any OpenCL
 * context lives. */
static void test_context_cycles(void **state) {
    atelier *a = *state;
    growth drivers = {0};
    if (!a->is_cpu)
        drivers = repeat_bare(cycle_opencl, "OpenCL, bare contexts");
    for (int i = 0; i < CAMBER_FIXTURE_DRAWERS; i++)
        if (a->here[i])
            repeat(a, i, cycle_contexts, drivers, "contexts, devices, surfaces");
}

#define IN_FIXTURE(name) cmocka_unit_test_setup_teardown(name, open_fixture, close_fixture)

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_context_cycles), IN_FIXTURE(test_frames),
                                       IN_FIXTURE(test_cycles)};
    const int failed = device_is_there() ? cmocka_run_group_tests(tests, set_up, tear_down) : 77;
    return failed;
}
