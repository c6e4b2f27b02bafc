/* Parts of a schedule: each task is in one, and none takes much longer than the others. */
#include "tiles/schedule.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { WIDE = 7, MOST_DEEP = 200 };

/* A country of two million points: few tiles have all of them down to zoom 6, then many have a share. */
static void make(camber_context *context, int wide, int deep, uint64_t deep_points, camber_schedule *schedule) {
    static const unsigned tiles[WIDE] = {1, 2, 2, 2, 3, 5, 10};
    const int count = wide + deep;
    *schedule = (camber_schedule){.context = context, .count = (size_t)count};
    schedule->tasks = camber_alloc_zero(context, (size_t)count, sizeof *schedule->tasks);
    assert_non_null(schedule->tasks);
    for (int i = 0; i < count; i++) {
        camber_tile_task *task = schedule->tasks + i;
        task->zoom = i < wide ? i : 9;
        task->level = i < 3 && i < wide ? 0 : task->zoom - 3;
        task->column = i < wide ? 0 : (uint32_t)(i - wide) % 10;
        task->row = i < wide ? 0 : (uint32_t)(i - wide) / 10;
        task->points = i >= wide ? deep_points : i < 4 ? 2000000 : 500000;
        task->wanted = task->touched = i < wide ? (UINT64_C(1) << tiles[i]) - 1 : 0xff;
    }
}

/* Each task is in one part, in the same order, and no part takes much longer than the others. */
static void check_parts(int wide, int deep, uint32_t shards) {
    uint32_t parts[WIDE + MOST_DEEP] = {0};
    double most = 0.0, all = 0.0;
    camber_context *context;
    assert_int_equal(camber_context_create(NULL, &context), CAMBER_OK);
    for (uint32_t shard = 1; shard <= shards; shard++) {
        camber_schedule whole, part;
        make(context, wide, deep, 250000, &whole);
        make(context, wide, deep, 250000, &part);
        assert_int_equal(camber_schedule_choose(&part, shard, shards), CAMBER_OK);
        assert_true(part.count > 0);
        all += part.cost;
        most = part.cost > most ? part.cost : most;
        for (size_t i = 0, at = 0; i < part.count; i++, at++) {
            while (at < whole.count && memcmp(whole.tasks + at, part.tasks + i, sizeof *part.tasks) != 0)
                at++;
            assert_true(at < whole.count);
            assert_int_equal(parts[at], 0);
            parts[at] = shard;
        }
        camber_schedule_free(&part);
        camber_schedule_free(&whole);
    }
    for (int i = 0; i < wide + deep; i++)
        assert_int_not_equal(parts[i], 0);
    assert_true(most < 1.15 * all / shards);
    camber_context_destroy(context);
}

static void test_parts(void **state) {
    (void)state;
    check_parts(WIDE, 100, 8);
    check_parts(0, 100, 8);
    check_parts(WIDE, 0, 4);
}

/* Who draws the wide task looks at all points for the deep zoom, too, 0.024 us each of five million, and so has 120 ms
 * of other work less; a task takes 17. */
static void test_joining(void **state) {
    camber_schedule part[2];
    camber_context *context;
    (void)state;
    assert_int_equal(camber_context_create(NULL, &context), CAMBER_OK);
    for (uint32_t i = 0; i < 2; i++) {
        make(context, 1, MOST_DEEP, 25000, &part[i]);
        assert_int_equal(camber_schedule_choose(&part[i], i + 1, 2), CAMBER_OK);
    }
    assert_true(part[0].tasks[0].zoom == 0 && part[0].count > 1);
    assert_true(part[1].cost - part[0].cost > 120e3 - 17e3 && part[1].cost - part[0].cost < 120e3 + 17e3);
    for (uint32_t i = 0; i < 2; i++)
        camber_schedule_free(&part[i]);
    camber_context_destroy(context);
}

/* Measured in parts of a run: 1.02 to 1.32 s of a processor for two million points in one tile, 12 to 13 ms for twelve
 * thousand in 32. A cost grows with the tiles, and with the points, by no more than they do plus a fifth. */
static void test_cost(void **state) {
    (void)state;
    const camber_tile_task one = {.touched = 1, .points = 2000000}, many = {.touched = UINT32_MAX, .points = 12000};
    assert_true(camber_task_cost(&one) > 1.0e6 && camber_task_cost(&one) < 1.35e6);
    assert_true(camber_task_cost(&many) > 9e3 && camber_task_cost(&many) < 16e3);
    assert_true(camber_task_cost(&(camber_tile_task){.points = 100}) == 0.0); /* nothing to draw */
    for (uint64_t tiles = 1; tiles <= UINT64_MAX >> 3; tiles = tiles << 3 | 7) {
        camber_tile_task task = {.touched = tiles};
        double before = camber_task_cost(&task);
        assert_true(before < camber_task_cost(&(camber_tile_task){.touched = tiles << 3 | 7}));
        for (task.points = 64; task.points < 10000000; task.points += task.points / 64) {
            const double cost = camber_task_cost(&task);
            assert_true(cost > before && (task.points == 64 || cost < before * (1 + 1.2 / 64)));
            before = cost;
        }
    }
}

/* More parts than tasks: each has one at most, and parts without any take no memory. */
static void test_many_parts(void **state) {
    size_t tasks = 0;
    camber_context *context;
    (void)state;
    assert_int_equal(camber_context_create(NULL, &context), CAMBER_OK);
    for (uint32_t shard = 1; shard <= WIDE + 100 + 1; shard++) {
        camber_schedule part;
        make(context, WIDE, 100, 250000, &part);
        assert_int_equal(camber_schedule_choose(&part, shard, UINT32_MAX), CAMBER_OK);
        assert_true(part.count <= 1);
        tasks += part.count;
        camber_schedule_free(&part);
    }
    assert_int_equal(tasks, WIDE + 100);
    camber_context_destroy(context);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_parts), cmocka_unit_test(test_joining),
                                       cmocka_unit_test(test_cost), cmocka_unit_test(test_many_parts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
