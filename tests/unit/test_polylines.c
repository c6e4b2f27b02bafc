/* Cleaning: what is kept, what is counted, and the slots that the kernels read. */
#include "core.h"

#include "lines/lines.h"

#include <math.h>

static camber_polylines *make(camber_context *context, const camber_polylines_desc *desc) {
    camber_polylines *polylines = NULL;
    assert_int_equal(camber_polylines_create(context, desc, &polylines), CAMBER_OK);
    return polylines;
}

typedef struct slot {
    float x, y;
    uint32_t info;
} slot;

enum {
    REAL = CAMBER_POINT_REAL,
    FIRST = CAMBER_POINT_REAL | CAMBER_POINT_FIRST,
    LAST = CAMBER_POINT_REAL | CAMBER_POINT_LAST,
    DOT = FIRST | LAST,
    RING_FIRST = FIRST | CAMBER_POINT_RING,
    RING_LAST = LAST | CAMBER_POINT_RING
};

/* The slots are those wanted, and sentinels around and behind them. */
static void assert_slots(const camber_polylines *p, const slot *wanted, size_t count) {
    assert_int_equal(p->first_slots[p->polyline_count], count);
    assert_int_equal(p->slot_count, (count + CAMBER_BLOCK - 1) / CAMBER_BLOCK * CAMBER_BLOCK);
    assert_int_equal(p->info[0], 0);
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(p->info[i + 1], wanted[i].info);
        assert_true(p->x[i + 1] == wanted[i].x && p->y[i + 1] == wanted[i].y);
    }
    for (size_t i = count + 1; i < p->slot_count + 2; i++)
        assert_true(p->info[i] == 0 && isfinite(p->x[i]) && isfinite(p->y[i]));
}

static void test_plain(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const float points[] = {0, 0, 1, 2, 3, 4, 5, 6, 7, 8};
    const uint32_t offsets[] = {0, 3, 5}, rows[] = {7, (1u << 24) - 1};
    camber_polylines *p = make(context, &(camber_polylines_desc){points, 5, offsets, 2, rows, false});
    const uint32_t a = 7u << CAMBER_POINT_ROW_SHIFT, b = rows[1] << CAMBER_POINT_ROW_SHIFT;
    const slot wanted[] = {{0, 0, a | FIRST}, {1, 2, a | REAL}, {3, 4, a | LAST}, {5, 6, b | FIRST}, {7, 8, b | LAST}};
    assert_slots(p, wanted, 5);
    assert_int_equal(p->row_count, 1u << 24);
    assert_true(p->polyline_rows[0] == rows[0] && p->polyline_rows[1] == rows[1]);
    const camber_polylines_stats s = camber_polylines_get_stats(p);
    const camber_polylines_stats expected = {.polylines = 2, .points = 5, .kept_points = 5, .kept_segments = 3};
    assert_memory_equal(&s, &expected, sizeof s);
    camber_polylines_destroy(p);
    host_done(&h, context);
}

static void test_repeated_points(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    /* Up to 1e-9 px is the same place. */
    const float points[] = {0, 0, 0, 0, 0.9e-9f, 0, 1.1e-9f, 0, 5, 5, 5, 5, 5, 5, 0, 0};
    const uint32_t offsets[] = {0, 8};
    camber_polylines *p = make(context, &(camber_polylines_desc){points, 8, offsets, 1, NULL, true});
    const slot wanted[] = {{0, 0, FIRST}, {1.1e-9f, 0, REAL}, {5, 5, REAL}, {0, 0, LAST}};
    assert_slots(p, wanted, 4);
    const camber_polylines_stats s = camber_polylines_get_stats(p);
    const camber_polylines_stats expected = {
        .polylines = 1, .points = 8, .kept_points = 4, .kept_segments = 3, .repeated_points = 4};
    assert_memory_equal(&s, &expected, sizeof s);
    camber_polylines_destroy(p);
    host_done(&h, context);
}

static void test_invalid_points_split(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const float nan = NAN, inf = INFINITY, far = 1.0000001e9f;
    const float points[] = {nan,
                            0,
                            1,
                            1,
                            2,
                            2,
                            3,
                            inf,
                            4,
                            4,
                            far,
                            5,
                            0,
                            -far,
                            6,
                            6,
                            1e9f,
                            -1e9f,
                            7,
                            -inf,
                            /* the second polyline */ 8,
                            8,
                            9,
                            9};
    const uint32_t offsets[] = {0, 10, 12}, rows[] = {3, 4};
    camber_polylines *p = make(context, &(camber_polylines_desc){points, 12, offsets, 2, rows, false});
    const uint32_t a = 3u << CAMBER_POINT_ROW_SHIFT, b = 4u << CAMBER_POINT_ROW_SHIFT;
    const slot wanted[] = {{1, 1, a | FIRST},       {2, 2, a | LAST},  {4, 4, a | DOT}, {6, 6, a | FIRST},
                           {1e9f, -1e9f, a | LAST}, {8, 8, b | FIRST}, {9, 9, b | LAST}};
    assert_slots(p, wanted, 7);
    const camber_polylines_stats s = camber_polylines_get_stats(p);
    const camber_polylines_stats expected = {
        .polylines = 2, .points = 12, .kept_points = 7, .kept_segments = 3, .dots = 1, .invalid_points = 5};
    assert_memory_equal(&s, &expected, sizeof s);
    for (size_t i = 0; i < 7; i++)
        assert_int_equal(camber_polylines_find(p, i), i < 5 ? 0 : 1);
    camber_polylines_destroy(p);
    host_done(&h, context);
}

static void test_rings(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const float points[] = {0, 0, 10, 0, 10, 10, 0, 0};
    const uint32_t offsets[] = {0, 4};
    camber_polylines *p = make(context, &(camber_polylines_desc){points, 4, offsets, 1, NULL, false});
    const slot ring[] = {{10, 10, 0}, {0, 0, RING_FIRST}, {10, 0, REAL}, {10, 10, REAL}, {0, 0, RING_LAST}, {10, 0, 0}};
    assert_slots(p, ring, 6);
    assert_int_equal(camber_polylines_get_stats(p).rings, 1);
    assert_int_equal(camber_polylines_get_stats(p).kept_segments, 3);
    camber_polylines_destroy(p);

    p = make(context, &(camber_polylines_desc){points, 4, offsets, 1, NULL, true});
    const slot open[] = {{0, 0, FIRST}, {10, 0, REAL}, {10, 10, REAL}, {0, 0, LAST}};
    assert_slots(p, open, 4);
    assert_int_equal(camber_polylines_get_stats(p).rings, 0);
    camber_polylines_destroy(p);
    host_done(&h, context);
}

/* Rings that are less than they seem, and their slots. */
static void test_odd_rings(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const float nan = NAN;
    const float points[] = {
        1, 1, 2, 2, 1,   1,                  /* there and back: a ring of two segments */
        3, 3, 3, 3, 3,   3,                  /* one place: a dot */
        4, 4, 5, 4, nan, 0, 5,      5, 4, 4, /* split: its halves are open */
        6, 6, 7, 6, 7,   7, 6,      6, 6, 6, /* the closing point comes twice */
        0, 0, 1, 0, 1,   1, 1e-19f, 0, 0, 0, /* and where the first of the two is not quite the same */
        8, 8, 8, 8,                          /* two points at one place: no ring, a dot */
    };
    const uint32_t offsets[] = {0, 3, 6, 11, 16, 21, 23};
    camber_polylines *p = make(context, &(camber_polylines_desc){points, 23, offsets, 6, NULL, false});
    const slot wanted[] = {
        {2, 2, 0},     {1, 1, RING_FIRST}, {2, 2, REAL},  {1, 1, RING_LAST}, {2, 2, 0}, /* 0 */
        {3, 3, 0},     {3, 3, DOT},                                                     /* 1: its sentinel is unused */
        {4, 4, FIRST}, {5, 4, LAST},       {5, 5, FIRST}, {4, 4, LAST},                 /* 2 */
        {7, 7, 0},     {6, 6, RING_FIRST}, {7, 6, REAL},  {7, 7, REAL},      {6, 6, RING_LAST}, {7, 6, 0}, /* 3 */
        {1, 1, 0},     {0, 0, RING_FIRST}, {1, 0, REAL},  {1, 1, REAL},      {0, 0, RING_LAST}, {1, 0, 0}, /* 4 */
        {8, 8, DOT},
    };
    assert_slots(p, wanted, sizeof wanted / sizeof *wanted);
    const camber_polylines_stats s = camber_polylines_get_stats(p);
    assert_int_equal(s.rings, 3);
    assert_int_equal(s.dots, 2);
    assert_int_equal(s.invalid_points, 1);
    assert_int_equal(s.repeated_points, 2 + 1 + 1 + 1);
    assert_int_equal(s.kept_points + s.repeated_points + s.invalid_points, s.points);
    camber_polylines_destroy(p);
    host_done(&h, context);
}

static void test_empty(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_polylines *p = make(context, &(camber_polylines_desc){0});
    assert_slots(p, NULL, 0);
    camber_polylines_destroy(p);
    const float points[] = {1, 1, 2, 2, NAN, NAN};
    const uint32_t offsets[] = {0, 0, 0, 2, 2, 3, 3};
    p = make(context, &(camber_polylines_desc){points, 3, offsets, 6, NULL, false});
    const slot wanted[] = {{1, 1, FIRST}, {2, 2, LAST}};
    assert_slots(p, wanted, 2);
    const camber_polylines_stats s = camber_polylines_get_stats(p);
    assert_int_equal(s.empty_polylines, 4);
    assert_int_equal(s.invalid_points, 1);
    assert_int_equal(s.polylines, 6);
    assert_int_equal(camber_polylines_find(p, 0), 2);
    assert_int_equal(camber_polylines_find(p, 1), 2);
    camber_polylines_destroy(p);
    host_done(&h, context);
}

static void test_bad_input(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const float points[8] = {0};
    const uint32_t falling[] = {0, 3, 2, 4}, late[] = {1, 2, 4}, early[] = {0, 2, 3}, past[] = {0, 5, 4};
    const uint32_t good[] = {0, 2, 4}, most[] = {0, UINT32_MAX};
    const uint32_t rows[] = {0, 1u << 24};
    const struct {
        camber_polylines_desc desc;
        camber_status status;
    } bad[] = {
        {{points, 4, falling, 3, NULL, false}, CAMBER_ERROR_INPUT},
        {{points, 4, late, 2, NULL, false}, CAMBER_ERROR_INPUT}, /* would drop points without counting them */
        {{points, 4, early, 2, NULL, false}, CAMBER_ERROR_INPUT},
        {{points, 4, past, 2, NULL, false}, CAMBER_ERROR_INPUT},
        {{points, 4, NULL, 0, NULL, false}, CAMBER_ERROR_INPUT},
        {{points, 4, good, 2, rows, false}, CAMBER_ERROR_INPUT},
        {{points, UINT32_MAX, most, 1, NULL, false}, CAMBER_ERROR_LIMIT}, /* told before a point is read */
    };
    const size_t calls = h.calls;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        camber_polylines *p = (camber_polylines *)(void *)&h;
        assert_int_equal(camber_polylines_create(context, &bad[i].desc, &p), bad[i].status);
        assert_story(&h, "; ");
        assert_ptr_equal(p, &h);
    }
    assert_int_equal(h.calls, calls);
    host_done(&h, context);
}

/* A million lines of the same form differ in nothing but their serial. */
static void test_serials_differ(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_polylines *a = make(context, &(camber_polylines_desc){0}), *b = make(context, &(camber_polylines_desc){0});
    assert_true(a->serial != b->serial && a->serial != 0 && b->serial != 0);
    camber_polylines_destroy(b);
    camber_polylines_destroy(a);
    host_done(&h, context);
}

/* ---- Invariants over hostile input ---- */

static float hostile_number(uint64_t *seed) {
    static const float odd[] = {0.0f,   -0.0f, NAN,     INFINITY, -INFINITY, 1e9f,
                                1.1e9f, 3e38f, 0.5e-9f, 1.5e-9f,  1e-40f,    1.0f};
    switch (camber_random_below(seed, 6)) {
    case 0: return odd[camber_random_below(seed, sizeof odd / sizeof *odd)];
    case 1: return (float)camber_random_between(seed, -1e9, 1e9);
    default: return (float)camber_random_below(seed, 3); /* repeats and rings */
    }
}

/* The runs of a polyline by the contract's words, independent of the code: gives what must be counted. */
static void count_polyline(const float *points, size_t count, bool keep_open, camber_polylines_stats *s) {
    s->empty_polylines += count == 0;
    size_t run = 0, kept = 0;
    const float *last = NULL;
    bool whole = true;
    for (size_t i = 0; i <= count; i++) {
        const float *point = points + 2 * i;
        const bool valid = i < count && fabs((double)point[0]) <= 1e9 && fabs((double)point[1]) <= 1e9;
        if (valid) {
            const bool repeated = run && hypot((double)point[0] - last[0], (double)point[1] - last[1]) <= 1e-9;
            s->repeated_points += repeated;
            last = repeated ? last : point;
            kept += !repeated;
            run++;
            continue;
        }
        whole = whole && i == count;
        s->invalid_points += i < count;
        if (!run)
            continue;
        s->kept_points += kept;
        s->kept_segments += kept - 1;
        s->dots += kept == 1;
        const bool closes = whole && !keep_open && points[0] == point[-2] && points[1] == point[-1];
        s->rings += closes && kept >= 3;
        run = kept = 0;
    }
}

/* Each run of slots of one polyline: first, ..., last, its row throughout; rings have their sentinels. */
static void check_slots(const camber_polylines *p, const uint32_t *rows) {
    for (size_t i = 0; i < p->polyline_count; i++) {
        bool inside = false;
        for (size_t k = p->first_slots[i] + 1; k <= p->first_slots[i + 1]; k++) {
            const uint32_t info = p->info[k];
            assert_true(isfinite(p->x[k]) && isfinite(p->y[k]));
            if (!(info & CAMBER_POINT_REAL)) {
                assert_true(!inside && info == 0);
                continue;
            }
            assert_int_equal(info >> CAMBER_POINT_ROW_SHIFT, rows[i]);
            assert_int_equal(camber_polylines_find(p, k - 1), i);
            assert_true(inside != ((info & CAMBER_POINT_FIRST) != 0));
            const bool ring = info & CAMBER_POINT_RING;
            assert_true(!ring || info & (CAMBER_POINT_FIRST | CAMBER_POINT_LAST));
            if (inside)
                assert_true(p->x[k] != p->x[k - 1] || p->y[k] != p->y[k - 1] || ring);
            if (ring)
                assert_int_equal(p->info[info & CAMBER_POINT_FIRST ? k - 1 : k + 1], 0);
            inside = !(info & CAMBER_POINT_LAST);
        }
        assert_false(inside);
    }
}

static void test_hostile_input(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    uint64_t seed = 20;
    enum { POLYLINES = 12, POINTS = 400 };
    for (int round = 0; round < 3000; round++) {
        float points[2 * POINTS];
        uint32_t offsets[POLYLINES + 1] = {0}, rows[POLYLINES];
        const size_t n = 1 + camber_random_below(&seed, POLYLINES);
        for (size_t i = 0; i < n; i++) {
            offsets[i + 1] = offsets[i] + (uint32_t)camber_random_below(&seed, 30);
            rows[i] = (uint32_t)camber_random_below(&seed, 1u << 24);
        }
        for (size_t i = 0; i < 2 * (size_t)offsets[n]; i++)
            points[i] = hostile_number(&seed);
        for (size_t i = 0; i < n; i++) /* half of them close */
            if (offsets[i + 1] > offsets[i] && camber_random_below(&seed, 2))
                memcpy(points + 2 * (offsets[i + 1] - 1), points + 2 * offsets[i], 2 * sizeof *points);
        const camber_polylines_desc desc = {points, offsets[n], offsets, n, rows, camber_random_below(&seed, 4) == 0};
        camber_polylines *p = make(context, &desc);
        const camber_polylines_stats s = camber_polylines_get_stats(p);
        camber_polylines_stats wanted = {.polylines = n, .points = offsets[n]};
        for (size_t i = 0; i < n; i++)
            count_polyline(points + 2 * offsets[i], offsets[i + 1] - offsets[i], desc.keep_open, &wanted);
        assert_int_equal(s.kept_points + s.repeated_points + s.invalid_points, s.points);
        assert_memory_equal(&s, &wanted, sizeof s);
        size_t real = 0;
        for (size_t i = 0; i < p->slot_count + 2; i++)
            real += p->info[i] & CAMBER_POINT_REAL;
        assert_int_equal(real, s.kept_points);
        check_slots(p, rows);
        camber_polylines_destroy(p);
    }
    host_done(&h, context);
}

enum { MANY = 4000, MANY_POINTS = 9 * MANY };

/* Lines that begin where the one before ends, or repeat a point, or have an invalid one; most have none of it. */
static size_t make_many(float *points, uint32_t *offsets, uint32_t *rows) {
    uint32_t state = 1;
    size_t count = 0;
    for (size_t i = 0; i < MANY; i++) {
        offsets[i] = (uint32_t)count;
        rows[i] = (uint32_t)(i / 700);
        state = state * 1664525u + 1013904223u;
        const size_t points_here = 1 + (state >> 24) % 9, odd = (state >> 16) % 500;
        for (size_t k = 0; k < points_here; k++, count++) {
            const bool is_again = count > 0 && ((k == 0 && i % 3 == 0) || (odd == 0 && k == 1));
            points[2 * count] = is_again ? points[2 * count - 2] : odd == 1 && k == 2 ? NAN : (float)(count % 1000);
            points[2 * count + 1] = is_again ? points[2 * count - 1] : (float)(count % 777);
        }
    }
    offsets[MANY] = (uint32_t)count;
    return count;
}

/* Cleans an open line point by point. Gives how many slots. */
static size_t clean(const float *points, size_t count, uint32_t row, slot *slots) {
    size_t made = 0;
    bool begins = true;
    for (size_t i = 0; i < count; i++) {
        const float x = points[2 * i], y = points[2 * i + 1];
        if (!(fabsf(x) <= 1e9f && fabsf(y) <= 1e9f)) {
            begins = true;
            continue;
        }
        if (!begins && x == slots[made - 1].x && y == slots[made - 1].y)
            continue;
        if (!begins)
            slots[made - 1].info &= ~CAMBER_POINT_LAST;
        slots[made++] = (slot){x, y, row << CAMBER_POINT_ROW_SHIFT | LAST | (begins ? CAMBER_POINT_FIRST : 0u)};
        begins = false;
    }
    return made;
}

/* Lines are put in bundles where all their points are plain, and one by one elsewhere: nobody can tell. */
static void test_many(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    static float points[2 * MANY_POINTS];
    static uint32_t offsets[MANY + 1], rows[MANY], starts[MANY];
    static slot wanted[MANY_POINTS];
    const size_t count = make_many(points, offsets, rows);
    size_t slots = 0;
    for (size_t i = 0; i < MANY; i++) {
        starts[i] = (uint32_t)slots;
        slots += clean(points + 2 * offsets[i], offsets[i + 1] - offsets[i], rows[i], wanted + slots);
    }
    for (int open = 0; open < 2; open++) {
        camber_polylines *p = make(context, &(camber_polylines_desc){points, count, offsets, MANY, rows, open == 1});
        assert_slots(p, wanted, slots);
        assert_memory_equal(p->first_slots, starts, sizeof starts);
        assert_memory_equal(p->polyline_rows, rows, sizeof rows);
        const camber_polylines_stats s = camber_polylines_get_stats(p);
        assert_int_equal(s.kept_points, slots);
        assert_true(s.repeated_points > 0 && s.invalid_points > 0 && s.dots > 0);
        camber_polylines_destroy(p);
    }
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_many),
        cmocka_unit_test(test_plain),
        cmocka_unit_test(test_repeated_points),
        cmocka_unit_test(test_invalid_points_split),
        cmocka_unit_test(test_rings),
        cmocka_unit_test(test_odd_rings),
        cmocka_unit_test(test_empty),
        cmocka_unit_test(test_bad_input),
        cmocka_unit_test(test_serials_differ),
        cmocka_unit_test(test_hostile_input),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
