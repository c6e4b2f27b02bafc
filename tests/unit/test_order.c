/* One order out of several: each list's own, where they agree. */
#include "core.h"
#include "features/order.h"

#define END CAMBER_LIST_END
#define MERGE(count, ...) merge(count, sizeof((uint32_t[]){__VA_ARGS__}) / sizeof(uint32_t), (uint32_t[]){__VA_ARGS__})

static uint32_t merged[64];

static void merge(size_t count, size_t item_count, const uint32_t *lists) {
    camber_context *context;
    assert_int_equal(camber_context_create(NULL, &context), CAMBER_OK);
    const camber_order_desc desc = {.count = count, .lists = lists, .item_count = item_count};
    assert_int_equal(camber_order_merge(context, &desc, merged), CAMBER_OK);
    camber_context_destroy(context);
}

static void expect(size_t count, const uint32_t *order) {
    for (size_t i = 0; i < count; i++)
        assert_int_equal(merged[i], order[i]);
}

#define EXPECT(...) expect(sizeof((uint32_t[]){__VA_ARGS__}) / sizeof(uint32_t), (uint32_t[]){__VA_ARGS__})

static void test_agreeing(void **state) {
    (void)state;
    MERGE(3, 0, 1, 2);
    EXPECT(0, 1, 2);
    /* Thing 1 is in both lists: what lies below it in the second goes below it. */
    MERGE(4, 0, 1, END, 2, 1, END, 3);
    EXPECT(0, 2, 1, 3);
    MERGE(5, 4, 3, END, 3, 2, END, 2, 1, 0, END);
    EXPECT(4, 3, 2, 1, 0);
}

static void test_repeated(void **state) {
    (void)state;
    MERGE(3, 1, 1, 2, END, END, 2, 2, 0);
    EXPECT(1, 2, 0);
}

/* Whatever the lists say, all things come, once. */
static void test_contradictions(void **state) {
    (void)state;
    MERGE(3, 0, 1, 2, END, 2, 1, 0);
    bool seen[3] = {false};
    for (int i = 0; i < 3; i++)
        seen[merged[i]] = true;
    assert_true(seen[0] && seen[1] && seen[2]);
}

static void test_none(void **state) {
    (void)state;
    MERGE(2, END);
    EXPECT(0, 1);
}

/* Lists drawn from one order are all kept by what is made of them. */
static void test_drawn(void **state) {
    (void)state;
    uint32_t random = 7;
    for (int run = 0; run < 200; run++) {
        uint32_t lists[256], place[64], hidden[40];
        size_t items = 0;
        for (uint32_t i = 0; i < 40; i++)
            hidden[i] = i * 7 % 40;
        for (int list = 0; list < 8; list++) {
            for (int i = 0; i < 40 && items < 255; i++)
                if ((random = random * 1664525u + 1013904223u) >> 30 == 0)
                    lists[items++] = hidden[i];
            lists[items++] = END;
        }
        merge(40, items, lists);
        for (uint32_t i = 0; i < 40; i++)
            place[merged[i]] = i;
        for (size_t i = 1; i < items; i++)
            if (lists[i] != END && lists[i - 1] != END)
                assert_true(place[lists[i - 1]] < place[lists[i]]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_agreeing), cmocka_unit_test(test_repeated),
                                       cmocka_unit_test(test_contradictions), cmocka_unit_test(test_none),
                                       cmocka_unit_test(test_drawn)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
