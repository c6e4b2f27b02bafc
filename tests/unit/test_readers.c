/* Threads that read files at once, each with a context of its own, in processes that have not asked GDAL before. Each
 * round is a child, since a process is cold once only. */
#include "core.h"

#include "camber_map.h"

#include <pthread.h>
#include <sys/wait.h>

enum { THREADS_MAX = 8, POINTS = 3, LONGEST_S = 60 };

static const char LINES[] = "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":"
                            "{\"highway\":\"primary\"},\"geometry\":{\"type\":\"LineString\",\"coordinates\":"
                            "[[0,0],[1,1],[2,0]]}}]}";

/* One thread's. */
typedef struct task {
    const char *path;
    pthread_barrier_t *start;
    size_t points, formats; /* that GDAL reads */
} task;

static void say(void *user, camber_log_level level, const char *message) {
    (void)user;
    if (level == CAMBER_LOG_ERROR)
        puts(message);
}

static void *work(void *user) {
    task *t = user;
    const camber_source_desc source = {.path = t->path};
    camber_context *context = NULL;
    camber_style *style = NULL;
    camber_features *features = NULL;
    const bool made = camber_context_create(&(camber_context_desc){.log = say}, &context) == CAMBER_OK &&
                      camber_style_create_builtin(context, CAMBER_THEME_LIGHT, &style) == CAMBER_OK &&
                      camber_features_create(context, style, &features) == CAMBER_OK;
    pthread_barrier_wait(t->start);
    if (made && camber_features_read(features, &source) == CAMBER_OK)
        t->points = camber_features_get_stats(features).points;
    while (camber_format_list(t->formats))
        t->formats++;
    camber_features_destroy(features);
    camber_style_destroy(style);
    camber_context_destroy(context);
    return NULL;
}

/* Whether all have read all, and know the same formats. */
static bool read_together(const char *path, size_t count) {
    pthread_barrier_t start;
    pthread_t threads[THREADS_MAX];
    task tasks[THREADS_MAX];
    bool right = pthread_barrier_init(&start, NULL, (unsigned)count) == 0;
    for (size_t i = 0; i < count && right; i++) {
        tasks[i] = (task){.path = path, .start = &start};
        right = pthread_create(&threads[i], NULL, work, &tasks[i]) == 0;
    }
    for (size_t i = 0; i < count && right; i++)
        right = pthread_join(threads[i], NULL) == 0;
    for (size_t i = 0; i < count && right; i++)
        right = tasks[i].points == POINTS && tasks[i].formats > 0 && tasks[i].formats == tasks[0].formats;
    return right;
}

static void run_rounds(size_t count, int rounds) {
    char folder[64], path[96];
    folder_make(folder);
    snprintf(path, sizeof path, "%s/lines.geojson", folder);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(LINES, 1, sizeof LINES - 1, file), sizeof LINES - 1);
    assert_int_equal(fclose(file), 0);
    for (int i = 0; i < rounds; i++) {
        int ended = -1;
        fflush(NULL);
        const pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) {
            child_begin(LONGEST_S);
            const bool right = read_together(path, count);
            fflush(NULL);
            _exit(right ? EXIT_SUCCESS : EXIT_FAILURE);
        }
        assert_int_equal(waitpid(child, &ended, 0), child);
        if (WIFSIGNALED(ended))
            fail_msg("%zu threads: ended by signal %d", count, WTERMSIG(ended));
        assert_int_equal(ended, 0);
    }
    folder_remove(folder);
}

static void test_pairs(void **state) {
    (void)state;
    run_rounds(2, 20);
}

static void test_crowds(void **state) {
    (void)state;
    run_rounds(THREADS_MAX, 20);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_pairs), cmocka_unit_test(test_crowds)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
