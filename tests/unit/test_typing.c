/* Types of expressions: which fit where, their names, what values are; and the memory that values come from. */
#include "core.h"

#include "style/arena.h"
#include "style/typing.h"

#define NUMBER camber_typing_of(CAMBER_TYPE_NUMBER)
#define VALUE camber_typing_of(CAMBER_TYPE_VALUE)
#define ANY CAMBER_ANY_LENGTH

static void test_fits(void **state) {
    (void)state;
    const camber_typing string = camber_typing_of(CAMBER_TYPE_STRING);
    const camber_typing numbers = camber_typing_array(NUMBER, ANY), pair = camber_typing_array(NUMBER, 2);
    const camber_typing values = camber_typing_array(VALUE, ANY), none = camber_typing_array(VALUE, 0);
    assert_true(camber_typing_fits(NUMBER, NUMBER));
    assert_false(camber_typing_fits(NUMBER, string));
    assert_false(camber_typing_fits(NUMBER, VALUE));
    assert_true(camber_typing_fits(VALUE, pair));
    assert_true(camber_typing_fits(NUMBER, camber_typing_of(CAMBER_TYPE_ERROR)));
    assert_false(camber_typing_fits(VALUE, camber_typing_of(CAMBER_TYPE_COLLATOR)));
    assert_true(camber_typing_fits(numbers, pair));
    assert_false(camber_typing_fits(pair, numbers));
    assert_true(camber_typing_fits(values, numbers));
    assert_false(camber_typing_fits(numbers, values));
    assert_true(camber_typing_fits(numbers, none));
    assert_false(camber_typing_fits(pair, none));
    assert_true(camber_typing_fits(camber_typing_array(numbers, ANY), camber_typing_array(pair, 3)));
    assert_false(camber_typing_fits(camber_typing_array(pair, ANY), camber_typing_array(numbers, 3)));
}

static void test_names(void **state) {
    (void)state;
    char text[CAMBER_TYPING_TEXT_SIZE];
    camber_typing type = camber_typing_array(NUMBER, 2);
    assert_string_equal(camber_typing_write(type, text), "array<number, 2>");
    assert_string_equal(camber_typing_write(camber_typing_array(NUMBER, ANY), text), "array<number>");
    assert_string_equal(camber_typing_write(camber_typing_array(VALUE, ANY), text), "array");
    assert_string_equal(camber_typing_write(camber_typing_array(VALUE, 0), text), "array<value, 0>");
    assert_string_equal(camber_typing_name(type, text), "an array<number, 2>");
    assert_string_equal(camber_typing_name(NUMBER, text), "a number");
    for (int i = 0; i < 5; i++)
        type = camber_typing_array(type, UINT32_MAX - 1);
    assert_true(type.depth <= CAMBER_ARRAY_DEPTH);
    assert_true(strlen(camber_typing_write(type, text)) < CAMBER_TYPING_TEXT_SIZE);
    for (int i = 0; i < 5; i++)
        type = camber_typing_item(type);
    assert_int_equal(type.type, CAMBER_TYPE_VALUE);
}

static void test_values(void **state) {
    (void)state;
    char text[CAMBER_TYPING_TEXT_SIZE];
    const camber_value numbers[] = {{.type = CAMBER_VALUE_NUMBER}, {.type = CAMBER_VALUE_NUMBER}};
    const camber_value pair = {.type = CAMBER_VALUE_ARRAY, .count = 2, .items = numbers};
    const camber_value pairs[] = {pair, pair, {.type = CAMBER_VALUE_NULL}};
    const camber_value nested = {.type = CAMBER_VALUE_ARRAY, .count = 1, .items = pairs};
    const camber_value several = {.type = CAMBER_VALUE_ARRAY, .count = 2, .items = pairs};
    assert_string_equal(camber_typing_write(camber_typing_of_value(&pair), text), "array<number, 2>");
    assert_string_equal(camber_typing_write(camber_typing_of_value(&nested), text), "array<array<number, 2>, 1>");
    assert_string_equal(camber_typing_write(camber_typing_of_value(&several), text), "array<value, 2>");
    const camber_member members[] = {{.key = "a", .value = numbers[0]}, {.key = "b", .value = pair}};
    const camber_value object = {.type = CAMBER_VALUE_OBJECT, .count = 2, .members = members};
    assert_ptr_equal(camber_object_get(&object, "b"), &members[1].value);
    assert_null(camber_object_get(&object, "c"));
    assert_null(camber_object_get(&pair, "a"));
}

/* Pieces are aligned, do not overlap, begin in the owner's room, and end at the limit or where memory does. */
static void test_arena(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    _Alignas(8) char room[64];
    const size_t live = h.live_blocks;
    camber_arena arena = {.context = context, .at = room, .left = sizeof room, .limit = 100000};
    char *first = camber_arena_alloc(&arena, 3), *second = camber_arena_alloc(&arena, 0);
    assert_true(first == room && second == room + 8);
    assert_non_null(camber_arena_alloc(&arena, 48));
    assert_int_equal(h.live_blocks, live);
    for (size_t i = 0; i < 500; i++) {
        char *text = camber_arena_text(&arena, "0123456789", 1 + i % 10);
        assert_non_null(text);
        assert_int_equal((uintptr_t)text % 8, 0);
        assert_int_equal(strlen(text), 1 + i % 10);
    }
    assert_non_null(camber_arena_alloc(&arena, 50000));
    assert_null(camber_arena_alloc(&arena, 50000));
    assert_null(camber_arena_alloc(&arena, SIZE_MAX));
    assert_false(arena.starved);
    h.refuse_first = h.calls + 1;
    h.refuse_count = 1;
    arena.limit = SIZE_MAX;
    assert_null(camber_arena_alloc(&arena, (size_t)1 << 20));
    assert_true(arena.starved);
    assert_int_equal(h.errors, 0);
    camber_arena_free(&arena);
    assert_int_equal(h.live_blocks, live);
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_fits), cmocka_unit_test(test_names),
                                       cmocka_unit_test(test_values), cmocka_unit_test(test_arena)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
