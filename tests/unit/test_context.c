/* Contexts, memory, log, files and the cache folder. */
#include "core.h"

#include "lines/lines.h"
#include "residency/mesh.h"

#include <sys/stat.h>
#include <time.h>

/* ---- Context and memory ---- */

static void test_defaults(void **state) {
    (void)state;
    camber_context *context = NULL;
    assert_int_equal(camber_context_create(NULL, &context), CAMBER_OK);
    void *block = camber_alloc(context, 3, 5);
    assert_non_null(block);
    camber_free(context, block);
    camber_context_destroy(context);
    const camber_context_desc zero = {0};
    assert_int_equal(camber_context_create(&zero, &context), CAMBER_OK);
    assert_int_equal(camber_fail(context, CAMBER_ERROR_LIMIT, "nobody listens"), CAMBER_ERROR_LIMIT);
    camber_progress(context, "nobody listens", 0.5);
    camber_context_destroy(context);
}

static void test_destroy_accepts_null(void **state) {
    (void)state;
    camber_context_destroy(NULL);
    camber_polylines_destroy(NULL);
    camber_device_destroy(NULL);
    camber_surface_destroy(NULL);
    camber_renderer_destroy(NULL);
    camber_mesh_destroy(NULL);
    camber_png_destroy(NULL);
}

static void test_status_names(void **state) {
    (void)state;
    for (int a = CAMBER_OK; a <= CAMBER_ERROR_LIMIT; a++) {
        assert_non_null(camber_status_get_name((camber_status)a));
        assert_string_not_equal(camber_status_get_name((camber_status)a), camber_status_get_name((camber_status)1000));
        for (int b = CAMBER_OK; b < a; b++)
            assert_string_not_equal(camber_status_get_name((camber_status)a), camber_status_get_name((camber_status)b));
    }
    assert_non_null(camber_status_get_name((camber_status)1000));
    int major = -1, minor = -1, patch = -1;
    char behind = 0;
    assert_int_equal(sscanf(camber_version(), "%d.%d.%d%c", &major, &minor, &patch, &behind), 3);
    assert_int_equal(major, CAMBER_VERSION_MAJOR);
    assert_int_equal(minor, CAMBER_VERSION_MINOR);
    assert_int_equal(patch, CAMBER_VERSION_PATCH);
}

static void test_cache_dir_is_copied(void **state) {
    (void)state;
    host h = {0};
    char folder[] = "/nowhere";
    camber_context_desc desc = host_desc(&h);
    desc.cache_dir = folder;
    camber_context *context = NULL;
    assert_int_equal(camber_context_create(&desc, &context), CAMBER_OK);
    folder[1] = 'X';
    assert_string_equal(context->desc.cache_dir, "/nowhere");
    host_done(&h, context);
}

static void test_alloc(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const size_t calls = h.calls;
    assert_null(camber_alloc(context, SIZE_MAX / 2, 3));
    assert_story(&h, "memory");
    assert_null(camber_alloc_zero(context, SIZE_MAX, SIZE_MAX));
    assert_story(&h, "memory");
    assert_int_equal(h.calls, calls); /* never asked for the wrapped size */
    void *nothing = camber_alloc(context, 0, 8);
    assert_non_null(nothing);
    camber_free(context, nothing);
    camber_free(context, NULL);
    unsigned char *zeros = camber_alloc_zero(context, 100, 3);
    assert_non_null(zeros);
    for (int i = 0; i < 300; i++)
        assert_int_equal(zeros[i], 0);
    camber_free(context, zeros);
    host_done(&h, context);
}

static void test_grow(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    uint32_t *items = NULL;
    size_t capacity = 0, calls = h.calls;
    for (uint32_t i = 0; i < 100000; i++) {
        assert_true(camber_grow(context, &items, &capacity, i + 1, sizeof *items));
        assert_true(capacity > i);
        items[i] = i;
    }
    assert_true(h.calls - calls < 40); /* by half or more: logarithmic */
    const size_t before = capacity;
    const uint32_t *old = items;
    assert_false(camber_grow(context, &items, &capacity, SIZE_MAX / 2, sizeof *items));
    assert_story(&h, "memory");
    h.refuse_first = h.calls + 1;
    h.refuse_count = 1;
    assert_false(camber_grow(context, &items, &capacity, before + 1, sizeof *items));
    assert_story(&h, "memory");
    assert_true(capacity == before && items == old);
    for (uint32_t i = 0; i < 100000; i++)
        assert_int_equal(items[i], i);
    calls = h.calls;
    assert_true(camber_grow(context, &items, &capacity, before, sizeof *items));
    assert_int_equal(h.calls, calls);
    camber_free(context, items);
    host_done(&h, context);
}

/* ---- Every allocation fails once ---- */

static void test_context_memory(void **state) {
    (void)state;
    host h = {0};
    camber_context_desc desc = host_desc(&h);
    desc.cache_dir = "/nowhere";
    size_t n = 1;
    for (;; n++) {
        camber_context *const untouched = (camber_context *)(void *)&h;
        camber_context *context = untouched;
        h.calls = 0;
        h.refuse_first = n;
        h.refuse_count = 1;
        const camber_status status = camber_context_create(&desc, &context);
        if (status == CAMBER_OK) {
            host_done(&h, context);
            break;
        }
        assert_int_equal(status, CAMBER_ERROR_MEMORY);
        assert_ptr_equal(context, untouched);
        assert_int_equal(h.live_blocks, 0);
    }
    assert_int_equal(n, 3); /* the context and the copy of its cache folder's name */
}

static camber_status try_polylines(camber_context *context, void *user) {
    const float points[] = {0, 0, 10, 0, 10, 10, 0, 0, 5, 5, 6, 6};
    const uint32_t offsets[] = {0, 4, 6}, rows[] = {0, 1};
    const camber_polylines_desc desc = {points, 6, offsets, 2, rows, false};
    camber_polylines *const untouched = user;
    camber_polylines *made = untouched;
    const camber_status status = camber_polylines_create(context, &desc, &made);
    if (status == CAMBER_OK)
        camber_polylines_destroy(made);
    else
        assert_ptr_equal(made, untouched);
    return status;
}

static camber_status try_parse(camber_context *context, void *user) {
    (void)user;
    const uint32_t file[] = {0x4c594c50u, 1, 2, 0, 2, 0, 0, 0x3f800000u, 0x3f800000u};
    const camber_lines untouched = {
        .points = (float *)(uintptr_t)8, .offsets = (uint32_t *)(uintptr_t)16, .point_count = 7, .polyline_count = 9};
    camber_lines made = untouched;
    const camber_status status = camber_lines_parse(context, file, sizeof file, "file", &made);
    if (status == CAMBER_OK)
        camber_lines_destroy(&made);
    else
        assert_memory_equal(&made, &untouched, sizeof made);
    return status;
}

static camber_status try_twin(camber_context *context, void *user) {
    const camber_stroke stroke = {.width_px = 4};
    for (int method = 0; method < 3; method++) {
        const camber_tessellation_desc desc = {&stroke, 1, (camber_method)method, 0, false};
        camber_mesh_data made = {.vertices = (camber_vertex *)(uintptr_t)8};
        const camber_status status = camber_mesh_data_tessellate(context, user, &desc, &made);
        if (status != CAMBER_OK) {
            assert_ptr_equal(made.vertices, (camber_vertex *)(uintptr_t)8);
            return status;
        }
        camber_mesh_data_destroy(&made);
        assert_null(made.vertices);
    }
    return CAMBER_OK;
}

static bool take_all(void *user, const void *bytes, size_t size_bytes) {
    (void)user;
    (void)bytes;
    (void)size_bytes;
    return true;
}

static camber_status try_png(camber_context *context, void *user) {
    const camber_png_desc desc = {.width = 3, .height = 1};
    camber_png *const untouched = user;
    camber_png *made = untouched;
    const camber_status status = camber_png_create(context, &desc, (camber_sink){take_all, NULL}, &made);
    if (status == CAMBER_OK)
        camber_png_destroy(made);
    else
        assert_ptr_equal(made, untouched);
    return status;
}

static camber_status try_read_file(camber_context *context, void *user) {
    char *bytes = user;
    size_t size = 77;
    const camber_status status = camber_read_file(context, user, CAMBER_NAMED_BY_CALLER, &bytes, &size);
    if (status == CAMBER_OK) {
        camber_free(context, bytes);
    } else {
        assert_ptr_equal(bytes, user);
        assert_int_equal(size, 77);
    }
    return status;
}

static void test_memory(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    each_allocation_fails(&h, try_polylines, context, &h);
    each_allocation_fails(&h, try_parse, context, NULL);
    each_allocation_fails(&h, try_png, context, &h);
    float points[2 * 60];
    uint64_t seed = 1;
    for (int i = 0; i < 120; i++)
        points[i] = (float)camber_random_between(&seed, 0, 50);
    const uint32_t offsets[] = {0, 60};
    const camber_polylines_desc desc = {points, 60, offsets, 1, NULL, false};
    camber_polylines *polylines = NULL;
    assert_int_equal(camber_polylines_create(context, &desc, &polylines), CAMBER_OK);
    each_allocation_fails(&h, try_twin, context, polylines);
    camber_polylines_destroy(polylines);
    host_done(&h, context);
}

/* ---- Log ---- */

static void test_log_is_one_line(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    char long_text[10000];
    memset(long_text, 'x', sizeof long_text);
    long_text[sizeof long_text - 1] = 0;
    long_text[7] = '\n';
    long_text[8] = '\r';
    long_text[12] = 0x1b; /* a terminal would obey */
    long_text[13] = 0x7f;
    assert_int_equal(camber_fail(context, CAMBER_ERROR_IO, "%s", long_text), CAMBER_ERROR_IO); /* host_log looks */
    assert_story(&h, "xxxxxxx  xxx  xxx");
    camber_log(context, CAMBER_LOG_WARNING, "%d of %s", 3, "these");
    assert_int_equal(h.warnings, 1);
    assert_int_equal(h.errors, 0);
    host_done(&h, context);
}

static void take_progress(void *user, const camber_progress_info *progress) {
    assert_string_equal(progress->stage, "reading");
    *(camber_progress_info *)user = *progress;
}

static void test_progress(void **state) {
    (void)state;
    camber_progress_info seen = {.fraction = 7};
    const camber_context_desc desc = {.progress = take_progress, .progress_user = &seen};
    camber_context *context = NULL;
    assert_int_equal(camber_context_create(&desc, &context), CAMBER_OK);
    camber_progress(context, "reading", 0.25);
    assert_true(seen.fraction == 0.25 && !seen.unit);
    camber_progress_count(context, "reading", "tiles", 3, 4);
    assert_true(seen.fraction == 0.75 && seen.done == 3 && seen.total == 4);
    assert_string_equal(seen.unit, "tiles");
    camber_progress_count(context, "reading", "features", 3, 0);
    assert_true(seen.fraction < 0 && seen.done == 3 && seen.total == 0);
    camber_context_destroy(context);
}

static void test_clock(void **state) {
    (void)state;
    struct timespec before, after;
    clock_gettime(CLOCK_MONOTONIC, &before);
    const double now_ms = camber_now_ms();
    clock_gettime(CLOCK_MONOTONIC, &after);
    assert_true(now_ms >= (double)before.tv_sec * 1e3 + (double)before.tv_nsec * 1e-6);
    assert_true(now_ms <= (double)after.tv_sec * 1e3 + (double)after.tv_nsec * 1e-6);
}

/* ---- Files ---- */

static void test_read_file(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    char folder[64], path[128], *bytes = (char *)&h;
    size_t size = 77;
    folder_make(folder);
    snprintf(path, sizeof path, "%s/file", folder);
    assert_int_equal(camber_read_file(context, path, CAMBER_NAMED_BY_CALLER, &bytes, &size), CAMBER_ERROR_NOT_FOUND);
    assert_story(&h, path);
    assert_int_equal(camber_read_file(context, folder, CAMBER_NAMED_BY_CALLER, &bytes, &size), CAMBER_ERROR_INPUT);
    assert_story(&h, "folder");
    assert_true(bytes == (char *)&h && size == 77);
    static const size_t sizes[] = {0, 1, 65534, 65535, 65536, 65537, 131072, 300001};
    unsigned char *written = malloc(300001);
    assert_non_null(written);
    for (size_t i = 0; i < 300001; i++)
        written[i] = (unsigned char)(i * 7 + i / 251);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        file_write(path, written, sizes[i]);
        assert_int_equal(camber_read_file(context, path, CAMBER_NAMED_BY_CALLER, &bytes, &size), CAMBER_OK);
        assert_int_equal(size, sizes[i]);
        assert_memory_equal(bytes, written, size);
        assert_int_equal(bytes[size], 0);
        camber_free(context, bytes);
    }
    each_allocation_fails(&h, try_read_file, context, path);
    snprintf(path, sizeof path, "%s/file/below", folder);
    assert_int_equal(camber_read_file(context, path, CAMBER_NAMED_BY_CALLER, &bytes, &size), CAMBER_ERROR_NOT_FOUND);
    free(written);
    folder_remove(folder);
    host_done(&h, context);
}

/* FNV-1a's published test vectors (Noll). */
static void test_hash(void **state) {
    (void)state;
    assert_true(camber_hash(CAMBER_HASH_START, "", 0) == 0xcbf29ce484222325ull);
    assert_true(camber_hash(CAMBER_HASH_START, "a", 1) == 0xaf63dc4c8601ec8cull);
    assert_true(camber_hash(CAMBER_HASH_START, "foobar", 6) == 0x85944171f73967e8ull);
    assert_true(camber_hash(camber_hash(CAMBER_HASH_START, "foo", 3), "bar", 3) == 0x85944171f73967e8ull);
}

/* ---- Cache ---- */

static camber_context *cached_context(host *h, const char *cache_dir) {
    *h = (host){0};
    camber_context_desc desc = host_desc(h);
    desc.cache_dir = cache_dir;
    camber_context *context = NULL;
    assert_int_equal(camber_context_create(&desc, &context), CAMBER_OK);
    return context;
}

static int count_one(const char *path, const struct stat *about, int type, struct FTW *where) {
    (void)path;
    (void)about;
    (void)where;
    return type == FTW_F ? 1 : 0; /* stops at the first file */
}

static bool has_files(const char *folder) {
    return nftw(folder, count_one, 16, FTW_PHYS) == 1;
}

static void assert_miss(camber_context *context, host *h, const char *name) {
    char *bytes = (char *)h;
    size_t size = 77;
    assert_false(camber_cache_load(context, name, &bytes, &size));
    assert_true(bytes == (char *)h && size == 77);
    assert_int_equal(h->errors, 0);
}

static void assert_hit(camber_context *context, const char *name, const void *wanted, size_t wanted_size) {
    char *bytes = NULL;
    size_t size = 0;
    assert_true(camber_cache_load(context, name, &bytes, &size));
    assert_int_equal(size, wanted_size);
    assert_memory_equal(bytes, wanted, size);
    camber_free(context, bytes);
}

static void test_cache_round_trip(void **state) {
    (void)state;
    host h;
    char folder[64], deep[128], path[160];
    folder_make(folder);
    snprintf(deep, sizeof deep, "%s/a/b/c", folder);
    camber_context *context = cached_context(&h, deep);
    assert_miss(context, &h, "x.bin");
    camber_cache_save(context, "x.bin", "\0one\n", 5);
    assert_hit(context, "x.bin", "\0one\n", 5);
    camber_cache_save(context, "x.bin", "second", 6);
    assert_hit(context, "x.bin", "second", 6);
    assert_miss(context, &h, "y.bin");
    snprintf(path, sizeof path, "%s/x.bin", deep);
    struct stat about;
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(remove(path), 0);
    assert_false(has_files(folder)); /* nothing was left beside it */
    h.refuse_first = h.calls + 1;
    h.refuse_count = 1;
    camber_cache_save(context, "x.bin", "third", 5);
    h.refuse_first = 0;
    assert_int_equal(h.errors, 0);
    folder_remove(folder);
    host_done(&h, context);
}

/* Under a regular file no folder can be made, not even by root. */
static void test_unwritable_cache_is_a_miss(void **state) {
    (void)state;
    host h;
    char folder[64], file[128], below[160];
    folder_make(folder);
    snprintf(file, sizeof file, "%s/file", folder);
    snprintf(below, sizeof below, "%s/file/cache", folder);
    file_write(file, "x", 1);
    const char *const dirs[] = {below, file, "/proc/nowhere", ""};
    for (size_t i = 0; i < sizeof dirs / sizeof *dirs; i++) {
        camber_context *context = cached_context(&h, dirs[i]);
        camber_cache_save(context, "x.bin", "one", 3);
        assert_int_equal(h.errors, 0);
        assert_miss(context, &h, "x.bin");
        host_done(&h, context);
    }
    char long_dir[3000];
    memset(long_dir, 'd', sizeof long_dir);
    memcpy(long_dir, "/tmp/", 5);
    long_dir[sizeof long_dir - 1] = 0;
    camber_context *context = cached_context(&h, long_dir);
    camber_cache_save(context, "x.bin", "one", 3);
    assert_miss(context, &h, "x.bin");
    host_done(&h, context);
    folder_remove(folder);
}

/* A writer that died leaves its own file, never one under the name that is read. */
static void test_torn_cache_file_is_a_miss(void **state) {
    (void)state;
    host h;
    char folder[64], path[160];
    folder_make(folder);
    camber_context *context = cached_context(&h, folder);
    snprintf(path, sizeof path, "%s/x.bin.Ab12Cd", folder);
    file_write(path, "hal", 3);
    assert_miss(context, &h, "x.bin");
    camber_cache_save(context, "x.bin", "whole", 5);
    assert_hit(context, "x.bin", "whole", 5);
    /* A folder in the name's place: nothing to read, nothing replaced, nothing left. */
    snprintf(path, sizeof path, "%s/d.bin", folder);
    assert_int_equal(mkdir(path, 0700), 0);
    camber_cache_save(context, "d.bin", "one", 3);
    assert_miss(context, &h, "d.bin");
    folder_remove(folder);
    host_done(&h, context);
}

static void test_cache_follows_xdg(void **state) {
    (void)state;
    host h;
    char folder[64], path[160];
    folder_make(folder);
    const char *home = getenv("HOME"), *xdg = getenv("XDG_CACHE_HOME");
    char *old_home = home ? strdup(home) : NULL, *old_xdg = xdg ? strdup(xdg) : NULL;
    setenv("XDG_CACHE_HOME", folder, 1);
    setenv("HOME", "/proc/nowhere", 1);
    camber_context *context = cached_context(&h, NULL);
    camber_cache_save(context, "x.bin", "one", 3);
    snprintf(path, sizeof path, "%s/camber/x.bin", folder);
    assert_int_equal(access(path, R_OK), 0);
    assert_hit(context, "x.bin", "one", 3);
    setenv("XDG_CACHE_HOME", "relative/is/ignored", 1); /* as the XDG base directory specification says */
    setenv("HOME", folder, 1);
    camber_cache_save(context, "y.bin", "two", 3);
    snprintf(path, sizeof path, "%s/.cache/camber/y.bin", folder);
    assert_int_equal(access(path, R_OK), 0);
    unsetenv("XDG_CACHE_HOME");
    assert_hit(context, "y.bin", "two", 3);
    unsetenv("HOME");
    camber_cache_save(context, "z.bin", "three", 5);
    assert_miss(context, &h, "z.bin");
    if (old_home)
        setenv("HOME", old_home, 1);
    if (old_xdg)
        setenv("XDG_CACHE_HOME", old_xdg, 1);
    free(old_home);
    free(old_xdg);
    folder_remove(folder);
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_destroy_accepts_null),
        cmocka_unit_test(test_status_names),
        cmocka_unit_test(test_cache_dir_is_copied),
        cmocka_unit_test(test_alloc),
        cmocka_unit_test(test_grow),
        cmocka_unit_test(test_context_memory),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_log_is_one_line),
        cmocka_unit_test(test_progress),
        cmocka_unit_test(test_clock),
        cmocka_unit_test(test_read_file),
        cmocka_unit_test(test_hash),
        cmocka_unit_test(test_cache_round_trip),
        cmocka_unit_test(test_unwritable_cache_is_a_miss),
        cmocka_unit_test(test_torn_cache_file_is_a_miss),
        cmocka_unit_test(test_cache_follows_xdg),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
