/* The back end cpu: its pool of threads, and pictures that are the same on every level of the processor, with any
 * number of threads, and in OpenCL. pthread_create is wrapped, and refuses from some call on. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "core.h"

#include "gpu/cpu/pool.h"
#include "gpu/hardware.h"

#include <errno.h>
#include <fenv.h>
#include <pthread.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

static int allowed = 1000, created;

int __real_pthread_create(pthread_t *id, const pthread_attr_t *how, void *(*work)(void *), void *user);
int __wrap_pthread_create(pthread_t *id, const pthread_attr_t *how, void *(*work)(void *), void *user);
int __wrap_pthread_create(pthread_t *id, const pthread_attr_t *how, void *(*work)(void *), void *user) {
    if (allowed-- <= 0)
        return EAGAIN;
    created++;
    return __real_pthread_create(id, how, work, user);
}

/* ---- The pool ---- */

enum { ITEMS_MAX = 5000 };

typedef struct calls {
    size_t count;
    atomic_int of[ITEMS_MAX];
    atomic_int wrong; /* calls with another count, with the caller's rounding, or with the wrong signals */
    pthread_t caller;
} calls;

/* Faults reach each thread, and signals from outside only the caller's. */
static bool takes_signals(const calls *c) {
    sigset_t blocked;
    pthread_sigmask(SIG_BLOCK, NULL, &blocked);
    return !sigismember(&blocked, SIGSEGV) && !sigismember(&blocked, SIGABRT) &&
           !sigismember(&blocked, SIGTERM) == !!pthread_equal(c->caller, pthread_self());
}

static void count_items(const void *args, size_t first, size_t end, size_t count) {
    calls *c;
    memcpy(&c, args, sizeof c);
    atomic_fetch_add(&c->wrong, count != c->count || end > count || first >= end || fegetround() != FE_TONEAREST ||
                                    !takes_signals(c));
    for (size_t i = first; i < end; i++)
        atomic_fetch_add(&c->of[i], 1);
}

static void run_pool(size_t threads, int started) {
    static calls c;
    static const size_t counts[] = {1, 2, 3, 7, 64, ITEMS_MAX, 5, 1, ITEMS_MAX};
    host h;
    camber_context *context = host_context(&h);
    camber_cpu_pool *pool = NULL;
    calls *args = &c;
    assert_int_equal(camber_cpu_pool_create(context, threads, &pool), CAMBER_OK);
    allowed = started;
    for (size_t n = 0; n < sizeof counts / sizeof *counts; n++) {
        memset(&c, 0, sizeof c);
        c.count = counts[n];
        c.caller = pthread_self();
        fesetround(FE_UPWARD);
        camber_cpu_pool_run(pool, &(camber_cpu_work){count_items, &args, counts[n]});
        assert_int_equal(fegetround(), FE_UPWARD);
        fesetround(FE_TONEAREST);
        assert_int_equal(c.wrong, 0);
        for (size_t i = 0; i < ITEMS_MAX; i++)
            assert_int_equal(c.of[i], i < counts[n]);
    }
    camber_cpu_pool_destroy(pool);
    allowed = 1000;
    host_done(&h, context);
}

static void test_pool(void **state) {
    (void)state;
    run_pool(1, 1000);
    run_pool(2, 1000);
    run_pool(9, 1000);
    run_pool(9, 3);
    run_pool(9, 0);
    run_pool(64, 1000);
    camber_cpu_pool_destroy(NULL);
}

static void do_nothing(const void *args, size_t first, size_t end, size_t count) {
    (void)args, (void)first, (void)end, (void)count;
}

/* The threads that the system has refused are there some launches later, and each of them once. */
static void test_refused_threads(void **state) {
    (void)state;
    enum { THREADS = 9, REFUSED = 5 };
    host h;
    camber_context *context = host_context(&h);
    camber_cpu_pool *pool = NULL;
    assert_int_equal(camber_cpu_pool_create(context, THREADS, &pool), CAMBER_OK);
    allowed = THREADS - 1 - REFUSED;
    created = 0;
    for (int n = 0; n < 100; n++) {
        camber_cpu_pool_run(pool, &(camber_cpu_work){do_nothing, NULL, THREADS});
        if (n == 20) {
            assert_int_equal(created, THREADS - 1 - REFUSED);
            assert_in_range(-allowed, 1, 5); /* it does not ask at each launch */
            allowed = 1000;
        }
    }
    assert_int_equal(created, THREADS - 1);
    camber_cpu_pool_destroy(pool);
    host_done(&h, context);
}

/* ---- Pictures ---- */

enum { SIDE_PX = 160, PICTURE_BYTES = 4 * SIDE_PX * SIDE_PX };

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    memcpy((uint8_t *)user + (size_t)4 * SIDE_PX * first_row, rgba, (size_t)4 * SIDE_PX * row_count);
    return true;
}

/* Draws lines and dashes, which are translucent and cross each other. */
static camber_status draw(camber_context *context, camber_device *device, uint8_t *rgba) {
    static const float points[] = {8, 8, 152, 14, 20, 150, 155, 155, 4, 120, 160, 4, 80, 80, 81, 82, 150, 60};
    static const uint32_t offsets[] = {0, 4, 6, 9}, rows[] = {0, 1, 1};
    static const float lengths[] = {7, 3};
    const camber_dash dash = {lengths, 2};
    const camber_polylines_desc lines = {
        .points = points, .point_count = 9, .offsets = offsets, .polyline_count = 3, .rows = rows};
    const camber_stroke strokes[] = {{.width_px = 21, .join = CAMBER_JOIN_ROUND, .cap = CAMBER_CAP_ROUND},
                                     {.width_px = 3, .join = CAMBER_JOIN_MITER}};
    const camber_paint paints[] = {{.width_px = 21, .color = {0.1f, 0.2f, 0.4f, 0.5f}},
                                   {.width_px = 3, .color = {0.5f, 0.2f, 0.1f, 0.9f}, .dash = &dash}};
    const camber_tessellation_desc tessellation = {.strokes = strokes, .stroke_count = 2, .has_arc_length = true};
    camber_pass pass = {.paints = paints, .paint_count = 2};
    camber_frame frame = {.width = SIDE_PX, .height = SIDE_PX, .passes = &pass, .pass_count = 1};
    camber_polylines *polylines = NULL;
    camber_renderer *renderer = NULL;
    camber_status status = camber_polylines_create(context, &lines, &polylines);
    if (status == CAMBER_OK)
        status = camber_renderer_create(device, NULL, NULL, &renderer);
    if (status == CAMBER_OK)
        status = camber_mesh_create(device, renderer, &pass.mesh);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate(pass.mesh, polylines, &tessellation);
    if (status == CAMBER_OK)
        status = camber_renderer_render(renderer, &frame, take_rows, rgba, NULL);
    camber_mesh_destroy(pass.mesh);
    camber_renderer_destroy(renderer);
    camber_polylines_destroy(polylines);
    return status;
}

static camber_status draw_on(camber_context *context, const camber_device_desc *desc, uint8_t *rgba) {
    camber_device *device = NULL;
    camber_status status = camber_device_create(context, desc, &device);
    if (status == CAMBER_OK)
        status = draw(context, device, rgba);
    camber_device_destroy(device);
    return status;
}

static bool is_loaded(const char *library) {
    char line[1024];
    bool found = false;
    FILE *maps = fopen("/proc/self/maps", "r");
    assert_non_null(maps);
    while (!found && fgets(line, sizeof line, maps))
        found = strstr(line, library) != NULL;
    fclose(maps);
    return found;
}

/* Runs first: no other test has asked a driver yet. */
static void test_no_driver(void **state) {
    (void)state;
    static const char *const words[] = {NULL, "cpu", "camber"};
    static uint8_t rgba[PICTURE_BYTES];
    host h;
    camber_context *context = host_context(&h);
    for (size_t i = camber_hardware_is_here(); i < sizeof words / sizeof *words; i++)
        assert_int_equal(draw_on(context, &(camber_device_desc){.match = words[i]}, rgba), CAMBER_OK);
    assert_false(is_loaded("libpocl"));
    assert_false(is_loaded("libLLVM"));
    host_done(&h, context);
}

/* Leaves the process some address space, which is too little for drivers. Returns the limit that was before. QEMU's
 * emulation of a process takes a limit and does not keep it: then the test is skipped. */
static struct rlimit limit_memory(void) {
    struct rlimit before, limit;
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%lu", &pages), 1);
    fclose(file);
    assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
    limit = before;
    limit.rlim_cur = (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE) + (500 << 20);
    assert_int_equal(setrlimit(RLIMIT_AS, &limit), 0);
    void *block = mmap(NULL, (size_t)1 << 30, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (block != MAP_FAILED) {
        munmap(block, (size_t)1 << 30);
        setrlimit(RLIMIT_AS, &before);
        skip();
    }
    return before;
}

/* Runs before any test that asks a driver. A number says that all devices are looked for. */
static void test_failing_drivers(void **state) {
    (void)state;
    static uint8_t rgba[PICTURE_BYTES];
    const struct rlimit before = limit_memory();
    host h;
    camber_context *context = host_context(&h);
    const camber_status any = draw_on(context, &(camber_device_desc){.number = 1}, rgba);
    const size_t errors = h.errors;
    const camber_status other = draw_on(context, &(camber_device_desc){.match = "opencl"}, rgba);
    setrlimit(RLIMIT_AS, &before);
    assert_int_equal(any, CAMBER_OK);
    assert_int_equal(errors, 0);
    assert_int_equal(other, CAMBER_ERROR_MEMORY);
    assert_story(&h, "address space");
    assert_false(is_loaded("libpocl"));
    host_done(&h, context);
}

/* Draws on a level, or, if level is NULL, in OpenCL. Returns whether it is here. */
static bool draw_level(const char *level, uint32_t threads, uint8_t *rgba) {
    host h;
    camber_context *context = host_context(&h);
    const camber_device_info *info = NULL;
    const char *match = level ? "camber" : "opencl";
    setenv("CAMBER_CPU", level ? level : "none", 1);
    assert_int_equal(camber_device_list(context, match, 0, &info), CAMBER_OK);
    const bool is_here = info != NULL;
    if (is_here && level) {
        assert_non_null(strstr(info->name, level));
        assert_true(info->fixed_kernels);
    }
    if (is_here)
        assert_int_equal(draw_on(context, &(camber_device_desc){.match = match, .threads = threads}, rgba), CAMBER_OK);
    unsetenv("CAMBER_CPU");
    host_done(&h, context);
    return is_here;
}

static void test_levels(void **state) {
    (void)state;
    static const char *const levels[] = {"x86-64-v2", "x86-64-v3", "x86-64-v4", "aarch64", NULL};
    static const uint32_t threads[] = {1, 2, 5};
    static uint8_t first[PICTURE_BYTES], other[PICTURE_BYTES];
    size_t count = 0, lit = 0;
    for (size_t i = 0; i < sizeof levels / sizeof *levels; i++)
        for (size_t k = 0; k < sizeof threads / sizeof *threads; k++) {
            uint8_t *rgba = count ? other : first;
            memset(rgba, 1, PICTURE_BYTES);
            if (!draw_level(levels[i], threads[k], rgba))
                break;
            assert_memory_equal(rgba, first, PICTURE_BYTES);
            count++;
        }
    for (size_t i = 3; i < PICTURE_BYTES; i += 4)
        lit += first[i] > 1;
    assert_true(count >= 3);
    assert_in_range(lit, PICTURE_BYTES / 4 / 10, PICTURE_BYTES / 4);
}

/* ---- Failures ---- */

static void test_unknown_level(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const camber_device_info *info = NULL;
    setenv("CAMBER_CPU", "x86-64-v9", 1);
    assert_int_equal(camber_device_list(context, "camber x", 0, &info), CAMBER_OK);
    unsetenv("CAMBER_CPU");
    assert_null(info);
    assert_int_equal(h.warnings, 1);
    assert_non_null(strstr(h.warning, "CAMBER_CPU"));
    assert_non_null(strstr(h.warning, "'x86-64-v9'"));
    assert_non_null(strstr(h.warning, "none"));
    h.warnings = 0;
    host_done(&h, context);
}

static void test_fixed_kernels(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_device *device = NULL;
    const camber_device_desc descs[] = {{.match = "camber", .work_group_size = 64}, {.match = "camber", .lanes = 1}};
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(camber_device_create(context, descs + i, &device), CAMBER_ERROR_DEVICE);
        assert_null(device);
        assert_story(&h, "; ask for 0 of both");
    }
    assert_int_equal(camber_device_create(context, &(camber_device_desc){.match = "camber"}, &device), CAMBER_OK);
    assert_true(camber_device_get_info(device).fixed_kernels);
    camber_device_destroy(device);
    host_done(&h, context);
}

static camber_status attempt(camber_context *context, void *user) {
    return draw_on(context, &(camber_device_desc){.match = "camber", .threads = 2}, user);
}

static void test_memory(void **state) {
    (void)state;
    static uint8_t rgba[PICTURE_BYTES];
    host h;
    camber_context *context = host_context(&h);
    each_allocation_fails(&h, attempt, context, rgba);
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_no_driver),       cmocka_unit_test(test_failing_drivers),
                                       cmocka_unit_test(test_unknown_level),   cmocka_unit_test(test_pool),
                                       cmocka_unit_test(test_refused_threads), cmocka_unit_test(test_levels),
                                       cmocka_unit_test(test_fixed_kernels),   cmocka_unit_test(test_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
