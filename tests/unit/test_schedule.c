/* Parts of a schedule: each task is in one, and none takes much longer than the others. */
#include "tiles/schedule.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { WIDE = 7, DEEP = 100, TASKS = WIDE + DEEP, SHARDS = 8 };

/* A country of two million points: few tiles have all of them down to zoom 6, then many have a share. */
static void make(camber_context *context, camber_schedule *schedule) {
    static const unsigned tiles[WIDE] = {1, 2, 2, 2, 3, 5, 10};
    *schedule = (camber_schedule){.context = context, .count = TASKS};
    schedule->tasks = camber_alloc_zero(context, TASKS, sizeof *schedule->tasks);
    assert_non_null(schedule->tasks);
    for (int i = 0; i < TASKS; i++) {
        camber_tile_task *task = schedule->tasks + i;
        task->zoom = i < WIDE ? i : 9;
        task->level = i < 3 ? 0 : task->zoom - 3;
        task->column = i < WIDE ? 0 : (uint32_t)(i - WIDE) % 10;
        task->row = i < WIDE ? 0 : (uint32_t)(i - WIDE) / 10;
        task->points = i < 4 ? 2000000 : i < WIDE ? 500000 : 250000;
        task->wanted = task->touched = i < WIDE ? (UINT64_C(1) << tiles[i]) - 1 : 0xff;
    }
}

static void test_parts(void **state) {
    uint32_t parts[TASKS] = {0};
    double most = 0.0, all = 0.0;
    camber_context *context;
    (void)state;
    assert_int_equal(camber_context_create(NULL, &context), CAMBER_OK);
    for (uint32_t shard = 1; shard <= SHARDS; shard++) {
        camber_schedule whole, part;
        make(context, &whole);
        make(context, &part);
        assert_int_equal(camber_schedule_choose(&part, shard, SHARDS), CAMBER_OK);
        assert_true(part.count > 0);
        all += part.cost;
        most = part.cost > most ? part.cost : most;
        for (size_t i = 0, at = 0; i < part.count; i++, at++) {
            while (at < TASKS && memcmp(whole.tasks + at, part.tasks + i, sizeof *part.tasks) != 0)
                at++;
            assert_true(at < TASKS); /* in the same order */
            assert_int_equal(parts[at], 0);
            parts[at] = shard;
        }
        camber_schedule_free(&part);
        camber_schedule_free(&whole);
    }
    for (int i = 0; i < TASKS; i++)
        assert_int_not_equal(parts[i], 0);
    assert_true(most < 1.15 * all / SHARDS);
    camber_context_destroy(context);
}

/* Measured in parts of a run: 1.02 to 1.32 s of a processor for two million points in one tile, 12 to 13 ms for twelve
 * thousand in 32. */
static void test_cost(void **state) {
    (void)state;
    const camber_tile_task one = {.touched = 1, .points = 2000000}, many = {.touched = UINT32_MAX, .points = 12000};
    assert_true(camber_task_cost(&one) > 1.0e6 && camber_task_cost(&one) < 1.35e6);
    assert_true(camber_task_cost(&many) > 9e3 && camber_task_cost(&many) < 16e3);
    assert_true(camber_task_cost(&(camber_tile_task){.points = 100}) == 0.0); /* nothing to draw */
}

/* More parts than tasks: each has one at most, and parts without any take no memory. */
static void test_many_parts(void **state) {
    size_t tasks = 0;
    camber_context *context;
    (void)state;
    assert_int_equal(camber_context_create(NULL, &context), CAMBER_OK);
    for (uint32_t shard = 1; shard <= TASKS + 1; shard++) {
        camber_schedule part;
        make(context, &part);
        assert_int_equal(camber_schedule_choose(&part, shard, UINT32_MAX), CAMBER_OK);
        assert_true(part.count <= 1);
        tasks += part.count;
        camber_schedule_free(&part);
    }
    assert_int_equal(tasks, TASKS);
    camber_context_destroy(context);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_parts), cmocka_unit_test(test_cost),
                                       cmocka_unit_test(test_many_parts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
