/* Threads that open and draw at once, each with a context of its own, in processes that have asked no driver before:
 * drivers set themselves up when they are first asked. Each round is a child, since a process is cold once only. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */

#include "core.h"

#include <pthread.h>
#include <sys/mman.h>
#include <sys/wait.h>

enum { SIDE_PX = 64, PICTURE_BYTES = 4 * SIDE_PX * SIDE_PX, THREADS_MAX = 8, LONGEST_S = 60 };

typedef enum place {
    IN_CL,
    IN_EGL,
    IN_OSMESA,
    PLACES,
} place;

static const char *const PLACE_NAME[PLACES] = {"OpenCL", "EGL", "OSMesa"};

/* One thread's: where it draws, and what came of it. */
typedef struct task {
    place where;
    camber_status status;
    char error[256];
    uint8_t rgba[PICTURE_BYTES];
} task;

/* Memory that children share with this process. */
typedef struct stage {
    task alone[PLACES]; /* what one thread draws where nothing else runs */
    task tasks[THREADS_MAX];
} stage;

static pthread_barrier_t start;

/* ---- A thread ---- */

static void take_log(void *user, camber_log_level level, const char *message) {
    task *t = user;
    if (level == CAMBER_LOG_ERROR)
        snprintf(t->error, sizeof t->error, "%s", message);
}

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    task *t = user;
    memcpy(t->rgba + (size_t)4 * SIDE_PX * first_row, rgba, (size_t)4 * SIDE_PX * row_count);
    return true;
}

static camber_status draw(task *t, camber_renderer *renderer, camber_mesh *mesh, const camber_polylines *polylines) {
    const camber_stroke strokes[] = {{.width_px = 9, .join = CAMBER_JOIN_ROUND, .cap = CAMBER_CAP_ROUND},
                                     {.width_px = 3, .join = CAMBER_JOIN_MITER}};
    const camber_paint paints[] = {{9, {0.1f, 0.2f, 0.4f, 0.5f}}, {3, {0.5f, 0.2f, 0.1f, 0.9f}}};
    const camber_tessellation_desc tessellation = {.strokes = strokes, .stroke_count = 2};
    const camber_pass pass = {.mesh = mesh, .paints = paints, .paint_count = 2};
    const camber_frame frame = {.width = SIDE_PX, .height = SIDE_PX, .passes = &pass, .pass_count = 1};
    const camber_status status = camber_mesh_tessellate(mesh, polylines, &tessellation);
    return status == CAMBER_OK ? camber_renderer_render(renderer, &frame, take_rows, t, NULL) : status;
}

static camber_status draw_lines(task *t, camber_context *context, camber_device *device, camber_renderer *renderer) {
    static const float points[] = {8, 8, 52, 14, 20, 50, 55, 55, 4, 60, 60, 4};
    static const uint32_t offsets[] = {0, 4, 6}, rows[] = {0, 1};
    const camber_polylines_desc desc = {
        .points = points, .point_count = 6, .offsets = offsets, .polyline_count = 2, .rows = rows};
    camber_polylines *polylines = NULL;
    camber_mesh *mesh = NULL;
    camber_status status = camber_polylines_create(context, &desc, &polylines);
    if (status == CAMBER_OK)
        status = camber_mesh_create(device, renderer, &mesh);
    if (status == CAMBER_OK)
        status = draw(t, renderer, mesh, polylines);
    camber_mesh_destroy(mesh);
    camber_polylines_destroy(polylines);
    return status;
}

/* All that a program does, from its first call to its last. */
static void *work(void *user) {
    task *t = user;
    const camber_context_desc desc = {.log = take_log, .log_user = t};
    const camber_surface_desc surface_desc = {t->where == IN_OSMESA ? CAMBER_BACKEND_OSMESA : CAMBER_BACKEND_EGL};
    const camber_renderer_desc renderer_desc = {.rasterizer = t->where == IN_CL ? CAMBER_RASTERIZER_OPENCL
                                                                                : CAMBER_RASTERIZER_GL};
    camber_context *context = NULL;
    camber_surface *surface = NULL;
    camber_device *device = NULL;
    camber_renderer *renderer = NULL;
    pthread_barrier_wait(&start);
    t->status = camber_context_create(&desc, &context);
    if (t->status == CAMBER_OK && t->where != IN_CL)
        t->status = camber_surface_create(context, &surface_desc, &surface);
    if (t->status == CAMBER_OK)
        t->status =
            camber_device_create(context, &(camber_device_desc){.gl = camber_surface_get_handles(surface)}, &device);
    if (t->status == CAMBER_OK)
        t->status = camber_renderer_create(device, surface, &renderer_desc, &renderer);
    if (t->status == CAMBER_OK)
        t->status = draw_lines(t, context, device, renderer);
    camber_renderer_destroy(renderer);
    camber_device_destroy(device);
    camber_surface_destroy(surface);
    camber_context_destroy(context);
    return NULL;
}

/* ---- A process ---- */

/* The child: all threads at once, and gone. Its leaks are test_leaks' to find. */
static void run_threads(task *tasks, size_t count) {
    pthread_t threads[THREADS_MAX];
    child_begin(LONGEST_S);
    bool made = pthread_barrier_init(&start, NULL, (unsigned)count) == 0;
    for (size_t i = 0; i < count && made; i++)
        made = pthread_create(&threads[i], NULL, work, &tasks[i]) == 0;
    for (size_t i = 0; i < count && made; i++)
        made = pthread_join(threads[i], NULL) == 0;
    _exit(made ? EXIT_SUCCESS : EXIT_FAILURE);
}

/* How a child ended that runs all tasks at once, as waitpid gives it. cold: with caches that are empty, too. */
static int run_process(task *tasks, size_t count, bool cold) {
    int ended = -1;
    char folder[64] = "";
    if (cold)
        folder_make(folder);
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        if (cold && (setenv("POCL_CACHE_DIR", folder, 1) != 0 || setenv("XDG_CACHE_HOME", folder, 1) != 0 ||
                     setenv("CAMBER_KERNELS", "", 1) != 0))
            _exit(EXIT_FAILURE);
        run_threads(tasks, count);
    }
    waitpid(child, &ended, 0);
    if (cold)
        folder_remove(folder);
    return ended;
}

static bool run_alone(task *t, place where) {
    *t = (task){.where = where, .status = CAMBER_ERROR_DEVICE};
    return run_process(t, 1, false) == 0;
}

/* Thread i draws in places[i % place_count]. */
static void run_round(stage *s, size_t count, const place *places, size_t place_count, bool cold) {
    memset(s->tasks, 0, sizeof s->tasks);
    for (size_t i = 0; i < count; i++)
        s->tasks[i] = (task){.where = places[i % place_count], .status = CAMBER_ERROR_DEVICE};
    const int ended = run_process(s->tasks, count, cold);
    if (WIFSIGNALED(ended))
        fail_msg("%zu threads: ended by signal %d", count, WTERMSIG(ended));
    assert_int_equal(ended, 0);
    for (size_t i = 0; i < count; i++) {
        const task *t = &s->tasks[i];
        if (t->status != CAMBER_OK)
            fail_msg("thread %zu of %zu, in %s: %s", i, count, PLACE_NAME[t->where], t->error);
        assert_memory_equal(t->rgba, s->alone[t->where].rgba, PICTURE_BYTES);
    }
}

/* ---- Tests ---- */

static void run_rounds(stage *s, place where, size_t pairs, size_t crowds) {
    if (s->alone[where].status != CAMBER_OK) {
        printf("%s is not there: %s\n", PLACE_NAME[where], s->alone[where].error);
        skip();
    }
    for (size_t i = 0; i < pairs; i++)
        run_round(s, 2, &where, 1, false);
    for (size_t i = 0; i < crowds; i++)
        run_round(s, THREADS_MAX, &where, 1, false);
}

static void test_alone(void **state) {
    const stage *s = *state;
    size_t drawn = 0;
    if (s->alone[IN_CL].status != CAMBER_OK)
        fail_msg("%s", s->alone[IN_CL].error);
    for (size_t i = 0; i < PICTURE_BYTES; i += 4)
        drawn += s->alone[IN_CL].rgba[i + 3] != 0;
    assert_in_range(drawn, SIDE_PX * SIDE_PX / 10, SIDE_PX * SIDE_PX - 1);
}

static void test_cl(void **state) {
    run_rounds(*state, IN_CL, 12, 4);
}

/* One compiles, the others wait for it. */
static void test_cl_compiled(void **state) {
    static const place where = IN_CL;
    run_round(*state, 4, &where, 1, true);
}

static void test_egl(void **state) {
    run_rounds(*state, IN_EGL, 4, 2);
}

static void test_osmesa(void **state) {
    run_rounds(*state, IN_OSMESA, 2, 1);
}

static void test_everywhere(void **state) {
    stage *s = *state;
    place places[PLACES] = {IN_CL};
    size_t count = 1;
    for (int i = 1; i < PLACES; i++)
        if (s->alone[i].status == CAMBER_OK)
            places[count++] = (place)i;
    run_round(s, 2, places, count, false);
    run_round(s, THREADS_MAX, places, count, false);
}

int main(void) {
    stage *s = mmap(NULL, sizeof *s, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (s == MAP_FAILED)
        return EXIT_FAILURE;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(test_alone, s),  cmocka_unit_test_prestate(test_cl, s),
        cmocka_unit_test_prestate(test_egl, s),    cmocka_unit_test_prestate(test_cl_compiled, s),
        cmocka_unit_test_prestate(test_osmesa, s), cmocka_unit_test_prestate(test_everywhere, s),
    };
    /* As camber.h tells to: PoCL sets it, under a getenv of Mesa's on another thread. */
    setenv("HWLOC_PLUGINS_PATH", "/dev/null", 0);
    for (int i = 0; i < PLACES; i++)
        if (!run_alone(&s->alone[i], (place)i)) {
            printf("%s: one thread alone has not come to its end\n", PLACE_NAME[i]);
            return EXIT_FAILURE;
        }
    if (strstr(s->alone[IN_CL].error, "no device")) {
        puts("skipped: no OpenCL device");
        return 77;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
