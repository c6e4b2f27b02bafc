/* Budgets: how much memory files may make a run take, and which files may be read. */
#include "core.h"

#include <fcntl.h>
#include <sys/stat.h>

static camber_context *context_of(host *h, camber_budget *budget, camber_access access) {
    *h = (host){0};
    camber_context_desc desc = host_desc(h);
    desc.budget = budget;
    desc.access = access;
    camber_context *context = NULL;
    assert_int_equal(camber_context_create(&desc, &context), CAMBER_OK);
    return context;
}

static camber_budget *budget_of(camber_budget_desc desc) {
    camber_budget *budget = NULL;
    assert_int_equal(camber_budget_create(&desc, &budget), CAMBER_OK);
    return budget;
}

/* ---- Memory ---- */

/* Two contexts hold what they hold together, and what goes can be had again. */
static void test_memory(void **state) {
    (void)state;
    host h[2];
    camber_budget *budget = budget_of((camber_budget_desc){.memory_bytes = 1 << 20});
    camber_context *one = context_of(&h[0], budget, (camber_access){0}),
                   *two = context_of(&h[1], budget, (camber_access){0});
    void *first = camber_alloc(one, 600 << 10, 1), *second = camber_alloc(two, 600 << 10, 1);
    assert_non_null(first);
    assert_null(second);
    assert_story(&h[1], "memory: 0.6 MB are in use, 0.6 MB more are needed, and 1.0 MB are allowed");
    assert_int_equal(camber_budget_get_held_bytes(budget), 600 << 10);
    camber_free(one, first);
    assert_int_equal(camber_budget_get_held_bytes(budget), 0);
    second = camber_alloc(two, 600 << 10, 1);
    assert_non_null(second);
    size_t capacity = 600 << 10;
    assert_true(camber_grow(two, &second, &capacity, 700 << 10, 1));
    assert_true(capacity >= 700 << 10);
    assert_int_equal(camber_budget_get_held_bytes(budget), capacity);
    assert_false(camber_grow(two, &second, &capacity, 2 << 20, 1));
    assert_story(&h[1], "memory:");
    assert_int_equal(camber_budget_get_held_bytes(budget), capacity);
    camber_free(two, second);
    assert_null(camber_alloc(two, SIZE_MAX / 2, 4));
    assert_story(&h[1], "out of memory");
    host_done(&h[0], one);
    host_done(&h[1], two);
    assert_int_equal(camber_budget_get_held_bytes(budget), 0);
    camber_budget_destroy(budget);
}

/* Nobody asks the machine for a small run; a large one is bounded by what there is. */
static void test_machine(void **state) {
    (void)state;
    host h;
    camber_budget *budget = budget_of((camber_budget_desc){0});
    camber_context *context = context_of(&h, budget, (camber_access){0});
    void *block = camber_alloc(context, 32 << 20, 1);
    assert_non_null(block);
    assert_true(atomic_load(&budget->most_bytes) == UINT64_MAX);
    camber_free(context, block);
    block = camber_alloc(context, 96 << 20, 1);
    const uint64_t most = camber_budget_get_most_bytes(budget);
    assert_true(most < UINT64_MAX);
    assert_true(!block || most >= 96 << 20);
    assert_false(camber_budget_take(context, most));
    camber_free(context, block);
    host_done(&h, context);
    camber_budget_destroy(budget);
}

/* The memory limits of control groups leave what the group does not use yet, or only for cached files. */
static void test_groups(void **state) {
    (void)state;
    static const char unlimited[] = "9223372036854771712\n"; /* as version 1 writes it */
    char root[64];
    folder_make(root);
    assert_true(camber_control_groups_left(root) == UINT64_MAX); /* no control group */
    folder_write(root, "proc/self/cgroup", "0::/app/worker\n");
    folder_write(root, "sys/fs/cgroup/app/worker/memory.max", "max\n");
    assert_true(camber_control_groups_left(root) == UINT64_MAX);
    folder_write(root, "sys/fs/cgroup/app/worker/memory.max", "1000\n");
    assert_int_equal(camber_control_groups_left(root), 1000);
    folder_write(root, "sys/fs/cgroup/app/worker/memory.current", "700\n");
    folder_write(root, "sys/fs/cgroup/app/worker/memory.stat", "file 600\ninactive_file 200\n");
    assert_int_equal(camber_control_groups_left(root), 500);
    folder_write(root, "sys/fs/cgroup/app/memory.max", "400\n");
    assert_int_equal(camber_control_groups_left(root), 400);
    folder_write(root, "sys/fs/cgroup/app/memory.current", "900\n");
    assert_int_equal(camber_control_groups_left(root), 0);

    folder_write(root, "proc/self/cgroup", "5:cpu:/\n4:memory:/docker/0123\n0::/\n");
    assert_true(camber_control_groups_left(root) == UINT64_MAX);
    folder_write(root, "sys/fs/cgroup/memory/memory.limit_in_bytes", unlimited);
    assert_int_equal(camber_control_groups_left(root), INT64_C(9223372036854771712));
    folder_write(root, "sys/fs/cgroup/memory/memory.limit_in_bytes", "2000\n");
    folder_write(root, "sys/fs/cgroup/memory/memory.usage_in_bytes", "1500\n");
    folder_write(root, "sys/fs/cgroup/memory/memory.stat", "inactive_file 0\ntotal_inactive_file 300\n");
    assert_int_equal(camber_control_groups_left(root), 800);
    folder_write(root, "proc/self/cgroup", "4:cpu:/\n"); /* of another controller */
    assert_true(camber_control_groups_left(root) == UINT64_MAX);
    folder_remove(root);
}

/* ---- Reading one set ---- */

static void test_reading(void **state) {
    (void)state;
    host h;
    camber_budget *budget = budget_of((camber_budget_desc){.tiles = 10, .steps = 1000, .unfold = 2});
    camber_context *context = context_of(&h, budget, (camber_access){0});
    for (int again = 0; again < 2; again++) {
        camber_budget_begin(context);
        assert_int_equal(camber_budget_take_tiles(context, "x.pmtiles", 10), CAMBER_OK);
        assert_int_equal(camber_budget_take_tiles(context, "x.pmtiles", 1), CAMBER_ERROR_LIMIT);
        assert_story(&h, "x.pmtiles: more than 10 tiles; ");
        assert_int_equal(camber_budget_take_tiles(context, "x.pmtiles", UINT64_MAX), CAMBER_ERROR_LIMIT);
        assert_story(&h, "10 tiles");
        assert_true(camber_budget_take_steps(context, 1000 + 10 * 4096));
        assert_false(camber_budget_take_steps(context, 1));
        camber_budget_open(context, 1000000);
        const uint64_t left = camber_budget_unfolds(context);
        assert_int_equal(left, (4 << 20) + 128 * 10 + 2 * 1000000);
        assert_int_equal(camber_budget_unfold(context, "x.mbtiles", left), CAMBER_OK);
        assert_int_equal(camber_budget_unfolds(context), 0);
        assert_int_equal(camber_budget_unfold(context, "x.mbtiles", 1), CAMBER_ERROR_LIMIT);
        assert_story(&h, "x.mbtiles: its tiles hold more than 6.2 MB, 2 times what the file has");
    }
    host_done(&h, context);
    camber_budget_destroy(budget);
}

/* ---- Files ---- */

static camber_status read_one(camber_context *context, const char *path, camber_file_naming naming) {
    char *bytes = NULL;
    size_t size = 0;
    const camber_status status = camber_read_file(context, path, naming, &bytes, &size);
    camber_free(context, bytes);
    return status;
}

static void test_kinds(void **state) {
    (void)state;
    host h;
    char folder[64], path[128];
    camber_context *context = host_context(&h);
    folder_make(folder);
    assert_int_equal(read_one(context, "/dev/zero", CAMBER_NAMED_BY_STYLE), CAMBER_ERROR_INPUT);
    assert_story(&h, "a device or a pipe");
    assert_int_equal(read_one(context, folder, CAMBER_NAMED_BY_STYLE), CAMBER_ERROR_INPUT);
    assert_story(&h, "folder");
    snprintf(path, sizeof path, "%s/pipe", folder);
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_int_equal(read_one(context, path, CAMBER_NAMED_BY_CALLER), CAMBER_ERROR_INPUT); /* and does not wait */
    assert_story(&h, "a device or a pipe");
    uint64_t size;
    assert_int_equal(camber_file_check(context, path, CAMBER_NAMED_BY_CALLER, &size), CAMBER_ERROR_INPUT);
    assert_story(&h, "a device or a pipe");
    host_done(&h, context);
    folder_remove(folder);
}

/* A style reaches what lies in the root, by any way, and nothing beyond it, by no way; nor is it told what is there. */
static void test_root(void **state) {
    (void)state;
    host h;
    char folder[64], root[128], inside[192], outside[192], path[256], hidden[4096];
    folder_make(folder);
    snprintf(root, sizeof root, "%s/root", folder);
    snprintf(inside, sizeof inside, "%s/in", root);
    snprintf(outside, sizeof outside, "%s/rooted", folder);
    assert_int_equal(mkdir(root, 0700), 0);
    file_write(inside, "x", 1);
    file_write(outside, "x", 1);
    camber_context *context = context_of(&h, NULL, (camber_access){.root = root});
    assert_int_equal(read_one(context, inside, CAMBER_NAMED_BY_STYLE), CAMBER_OK);
    snprintf(path, sizeof path, "%s/../root/./in", root);
    assert_int_equal(read_one(context, path, CAMBER_NAMED_BY_STYLE), CAMBER_OK);
    snprintf(path, sizeof path, "%s/none", root);
    assert_int_equal(read_one(context, path, CAMBER_NAMED_BY_STYLE), CAMBER_ERROR_NOT_FOUND);
    assert_story(&h, "none");
    assert_int_equal(read_one(context, outside, CAMBER_NAMED_BY_STYLE), CAMBER_ERROR_INPUT);
    assert_story(&h, "a style may name files only there");
    snprintf(hidden, sizeof hidden, "%s", h.last);
    unlink(outside);
    assert_int_equal(read_one(context, outside, CAMBER_NAMED_BY_STYLE), CAMBER_ERROR_INPUT);
    assert_string_equal(hidden, h.last);
    assert_story(&h, "a style may name files only there");
    file_write(outside, "x", 1);
    snprintf(path, sizeof path, "%s/link", root);
    assert_int_equal(symlink(outside, path), 0);
    assert_int_equal(read_one(context, path, CAMBER_NAMED_BY_STYLE), CAMBER_ERROR_INPUT);
    assert_story(&h, "a style may name files only there");
    snprintf(path, sizeof path, "%s/../rooted", root);
    assert_int_equal(read_one(context, path, CAMBER_NAMED_BY_STYLE), CAMBER_ERROR_INPUT);
    assert_story(&h, "a style may name files only there");
    assert_int_equal(read_one(context, outside, CAMBER_NAMED_BY_CALLER), CAMBER_OK);
    host_done(&h, context);
    folder_remove(folder);
}

/* A file that is about to be replaced is not read, by any of its names. */
static void test_output(void **state) {
    (void)state;
    host h;
    char folder[64], path[128], other[128];
    folder_make(folder);
    snprintf(path, sizeof path, "%s/a", folder);
    snprintf(other, sizeof other, "%s/b", folder);
    file_write(path, "x", 1);
    file_write(other, "x", 1);
    camber_context *context = context_of(&h, NULL, (camber_access){.outputs = {NULL, path}});
    assert_int_equal(read_one(context, other, CAMBER_NAMED_BY_STYLE), CAMBER_OK);
    assert_int_equal(read_one(context, path, CAMBER_NAMED_BY_STYLE), CAMBER_ERROR_ARGUMENT);
    assert_story(&h, "would be overwritten");
    unlink(other);
    assert_int_equal(symlink(path, other), 0);
    assert_int_equal(read_one(context, other, CAMBER_NAMED_BY_CALLER), CAMBER_ERROR_ARGUMENT);
    assert_story(&h, "would be overwritten");
    unlink(other);
    assert_int_equal(link(path, other), 0);
    assert_int_equal(read_one(context, other, CAMBER_NAMED_BY_CALLER), CAMBER_ERROR_ARGUMENT);
    assert_story(&h, "would be overwritten");
    host_done(&h, context);
    folder_remove(folder);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_memory),  cmocka_unit_test(test_machine), cmocka_unit_test(test_groups),
        cmocka_unit_test(test_reading), cmocka_unit_test(test_kinds),   cmocka_unit_test(test_root),
        cmocka_unit_test(test_output),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
