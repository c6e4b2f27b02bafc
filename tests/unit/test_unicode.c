/* Letters: UTF-8 whole and broken, case in several scripts, the order that collators have. */
#include "style/unicode.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static void test_round_trip(void **state) {
    (void)state;
    static const uint32_t codes[] = {'a', 0x7f, 0x80, 0x7ff, 0x800, 0xffff, 0x10000, 0x1f6e3, 0x10ffff};
    for (size_t i = 0; i < sizeof codes / sizeof *codes; i++) {
        char bytes[5] = "";
        uint32_t code;
        const size_t size = camber_unicode_write(codes[i], bytes);
        assert_int_equal(size, 1 + (codes[i] >= 0x80) + (codes[i] >= 0x800) + (codes[i] >= 0x10000));
        assert_int_equal(camber_unicode_read(bytes, &code), size);
        assert_int_equal(code, codes[i]);
    }
}

/* Bytes that are no UTF-8 are taken one by one, never past the end, and come out as they were. */
static void test_broken(void **state) {
    (void)state;
    static const char *const texts[] = {"\x80",     "\xc3",     "\xe2\x82",    "\xf0\x9f\x9b",
                                        "\xff\xfe", "\xc0\xaf", "\xf8\x88\x80"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char copy[16] = "";
        size_t used = 0;
        for (const char *at = texts[i]; *at;) {
            uint32_t code;
            at += camber_unicode_read(at, &code);
            used += camber_unicode_write(code, copy + used);
        }
        assert_string_equal(copy, texts[i]);
    }
}

static void change(const char *text, size_t (*letter)(uint32_t, uint32_t[2]), char *changed) {
    while (*text) {
        uint32_t code, other[2];
        text += camber_unicode_read(text, &code);
        const size_t count = letter(code, other);
        for (size_t i = 0; i < count; i++)
            changed += camber_unicode_write(other[i], changed);
    }
    *changed = 0;
}

static void test_case(void **state) {
    (void)state;
    static const char *const pairs[][2] = {
        {"azAZ09-", NULL},
        {"\xc3\xa4\xc3\xb7\xc3\xbf", "\xc3\x84\xc3\xb7\xc5\xb8"},         /* ä ÷ ÿ */
        {"\xc5\x82\xc4\xb1\xc5\xbe", "\xc5\x81I\xc5\xbd"},                /* ł ı ž */
        {"\xce\xac\xcf\x82\xcf\x89", "\xce\x86\xce\xa3\xce\xa9"},         /* ά ς ω */
        {"\xd0\xb0\xd1\x91\xd3\xa9", "\xd0\x90\xd0\x81\xd3\xa8"},         /* а ё ө */
        {"\xd5\xa1\xd6\x86", "\xd4\xb1\xd5\x96"},                         /* Armenian */
        {"\xe1\xba\xa1\xef\xbd\x81", "\xe1\xba\xa0\xef\xbc\xa1"},         /* ạ and a wide a */
        {"\xe4\xb8\xad\xf0\x9f\x9b\xa3", "\xe4\xb8\xad\xf0\x9f\x9b\xa3"}, /* no case */
        {"\xc3\x9f", "SS"},
    };
    char changed[64];
    change("azAZ09-", camber_unicode_upper, changed);
    assert_string_equal(changed, "AZAZ09-");
    for (size_t i = 1; i < sizeof pairs / sizeof *pairs; i++) {
        change(pairs[i][0], camber_unicode_upper, changed);
        assert_string_equal(changed, pairs[i][1]);
    }
    change("\xc3\x84\xc5\xb8\xd0\x81\xd4\xb1\xe1\xba\x9e", camber_unicode_lower, changed);
    assert_string_equal(changed, "\xc3\xa4\xc3\xbf\xd1\x91\xd5\xa1\xc3\x9f");
    change("\xc4\xb0", camber_unicode_lower, changed);
    assert_string_equal(changed, "i\xcc\x87");
}

static void test_order(void **state) {
    (void)state;
    static const struct {
        const char *a, *b;
        int base, by_case, by_diacritics, by_both;
    } samples[] = {
        {"a", "a", 0, 0, 0, 0},
        {"a", "A", 0, -1, 0, -1},
        {"A", "b", -1, -1, -1, -1},
        {"Z", "a", 1, 1, 1, 1},
        {"e", "\xc3\xa9", 0, 0, -1, -1},
        {"e\xcc\x81", "e", 0, 0, 1, 1},
        {"co\xc3\xb4p", "coop", 0, 0, 1, 1},
        {"ab", "abc", -1, -1, -1, -1},
        {"", "a", -1, -1, -1, -1},
        {"9", "a", -1, -1, -1, -1},
        {" b", "a", -1, -1, -1, -1},
        {"\xd0\x96", "\xd0\xb6", 0, 1, 0, 1},
    };
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        const char *a = samples[i].a, *b = samples[i].b;
        assert_int_equal(camber_unicode_compare(a, b, false, false), samples[i].base);
        assert_int_equal(camber_unicode_compare(a, b, true, false), samples[i].by_case);
        assert_int_equal(camber_unicode_compare(a, b, false, true), samples[i].by_diacritics);
        assert_int_equal(camber_unicode_compare(a, b, true, true), samples[i].by_both);
        assert_int_equal(camber_unicode_compare(b, a, true, true), -samples[i].by_both);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_round_trip), cmocka_unit_test(test_broken),
                                       cmocka_unit_test(test_case), cmocka_unit_test(test_order)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
