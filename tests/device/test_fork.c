/* A child that was forked after camber had looked for devices is refused, and waits for no thread of its parent. */
#include "core.h"

#include <dirent.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SIDE_PX = 256, LONGEST_S = 300 };

typedef struct drawing {
    char error[512];
    camber_context *context;
    camber_device *device;
    camber_renderer *renderer;
    camber_mesh *mesh;
    camber_polylines *polylines;
} drawing;

static void take_log(void *user, camber_log_level level, const char *message) {
    drawing *d = user;
    if (level == CAMBER_LOG_ERROR)
        snprintf(d->error, sizeof d->error, "%s", message);
}

static camber_status tessellate(drawing *d) {
    const camber_stroke stroke = {.width_px = 5};
    const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1};
    return camber_mesh_tessellate(d->mesh, d->polylines, &desc);
}

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    (void)user, (void)rgba, (void)first_row, (void)row_count;
    return true;
}

static camber_status render(drawing *d) {
    const camber_paint paint = {.width_px = 5, .color = {0, 0, 0, 1}};
    const camber_pass pass = {.mesh = d->mesh, .paints = &paint, .paint_count = 1};
    const camber_frame frame = {.width = SIDE_PX, .height = SIDE_PX, .passes = &pass, .pass_count = 1};
    return camber_renderer_render(d->renderer, &frame, take_rows, NULL, NULL);
}

static camber_status open_drawing(drawing *d) {
    static const float points[] = {4, 4, 250, 200};
    static const uint32_t offsets[] = {0, 2};
    const camber_context_desc context = {.log = take_log, .log_user = d};
    const camber_polylines_desc lines = {.points = points, .point_count = 2, .offsets = offsets, .polyline_count = 1};
    camber_status status = camber_context_create(&context, &d->context);
    if (status == CAMBER_OK)
        status = camber_device_create(d->context, NULL, &d->device);
    if (status == CAMBER_OK)
        status = camber_renderer_create(d->device, NULL, NULL, &d->renderer);
    if (status == CAMBER_OK)
        status = camber_mesh_create(d->device, d->renderer, &d->mesh);
    if (status == CAMBER_OK)
        status = camber_polylines_create(d->context, &lines, &d->polylines);
    return status;
}

static void close_drawing(drawing *d) {
    camber_polylines_destroy(d->polylines);
    camber_mesh_destroy(d->mesh);
    camber_renderer_destroy(d->renderer);
    camber_device_destroy(d->device);
    camber_context_destroy(d->context);
}

/* Makes the n-th call in a child, where everything else is the parent's. */
static camber_status call(drawing *d, int n) {
    drawing other = {.error = ""};
    camber_renderer *renderer = NULL;
    camber_mesh *mesh = NULL;
    camber_mesh_data data = {0};
    switch (n) {
    case 0: return tessellate(d);
    case 1: return render(d);
    case 2: return camber_mesh_read(d->mesh, &data);
    case 3: return camber_mesh_create(d->device, d->renderer, &mesh);
    case 4: return camber_renderer_create(d->device, NULL, NULL, &renderer);
    default: return open_drawing(&other);
    }
}

enum { CALLS = 6 };

static int run_child(drawing *d, int n) {
    alarm(LONGEST_S);
    d->error[0] = 0;
    if (call(d, n) != CAMBER_ERROR_DEVICE)
        return 1;
    return n < CALLS - 1 && !strstr(d->error, "forked") ? 2 : 0;
}

static void refuses_children(void **state) {
    drawing d = {.error = ""};
    (void)state;
    if (open_drawing(&d) != CAMBER_OK)
        fail_msg("%s", d.error);
    assert_int_equal(tessellate(&d), CAMBER_OK);
    assert_int_equal(render(&d), CAMBER_OK);
    for (int n = 0; n < CALLS; n++) {
        int status = 0;
        const pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0)
            _exit(run_child(&d, n));
        assert_int_equal(waitpid(child, &status, 0), child);
        if (status != 0)
            fail_msg("call %d: %s %d", n, WIFSIGNALED(status) ? "signal" : "status",
                     WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
    }
    assert_int_equal(render(&d), CAMBER_OK); /* the parent goes on */
    close_drawing(&d);
}

/* Whether each thread but this one, which is the first, waits. */
static bool others_wait(void) {
    bool all = true;
    DIR *tasks = opendir("/proc/self/task");
    assert_non_null(tasks);
    for (const struct dirent *one; all && (one = readdir(tasks));) {
        char path[64], line[256] = "";
        if (one->d_name[0] == '.' || strtol(one->d_name, NULL, 10) == getpid())
            continue;
        snprintf(path, sizeof path, "/proc/self/task/%.20s/stat", one->d_name);
        FILE *file = fopen(path, "r");
        if (!file) /* it has ended */
            continue;
        const char *name_end = fgets(line, sizeof line, file) ? strrchr(line, ')') : NULL;
        all = name_end && name_end[1] == ' ' && name_end[2] == 'S';
        fclose(file);
    }
    closedir(tasks);
    return all;
}

/* A child may destroy what it has inherited, as a language's run time does at its end. OpenCL's drivers may wait. */
static void destroys_in_child(void **state) {
    drawing d = {.error = ""};
    int status = 0;
    (void)state;
    if (open_drawing(&d) != CAMBER_OK)
        fail_msg("%s", d.error);
    assert_int_equal(tessellate(&d), CAMBER_OK);
    assert_int_equal(render(&d), CAMBER_OK);
    while (!others_wait()) /* for work: the pool's threads have just finished theirs */
        poll(NULL, 0, 1);
    const bool is_cpu = camber_device_get_info(d.device).fixed_kernels;
    const pid_t child = is_cpu ? fork() : getpid();
    if (child == 0) {
        alarm(LONGEST_S);
        close_drawing(&d);
        _exit(0);
    }
    if (is_cpu)
        assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    close_drawing(&d);
    if (!is_cpu)
        skip();
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(refuses_children), cmocka_unit_test(destroys_in_child)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
