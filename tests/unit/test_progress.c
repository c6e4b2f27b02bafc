/* The line of a progress bar, by a clock that the test sets; and numbers as people read them. */
#include "cli/figures.h"
#include "cli/progress.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static camber_progress_info drawing(uint64_t done) {
    return (camber_progress_info){"drawing tiles", (double)done / 3600, "tiles", done, 3600};
}

static const char *line_of(camber_progress_bar *bar, camber_progress_info progress, double now_ms, size_t columns) {
    static char line[256];
    camber_progress_write(bar, &progress, now_ms, columns, line, sizeof line);
    return line;
}

static void test_line(void **state) {
    (void)state;
    camber_progress_bar bar = {.drawn = false};
    assert_string_equal(line_of(&bar, drawing(0), 5e3, 120),
                        "drawing tiles   [                              ]   0 %  0 of 3,600 tiles");
    /* too early for a rate */
    assert_null(strstr(line_of(&bar, drawing(10), 5.5e3, 120), "left"));
    assert_string_equal(
        line_of(&bar, drawing(1800), 14e3, 120),
        "drawing tiles   [###############               ]  50 %  1,800 of 3,600 tiles, 200/s, 0:09 left");
    assert_string_equal(
        line_of(&bar, drawing(3600), 23e3, 120),
        "drawing tiles   [##############################] 100 %  3,600 of 3,600 tiles, 200/s, 0:00 left");
}

static void test_narrow(void **state) {
    (void)state;
    camber_progress_bar bar = {.drawn = false};
    (void)line_of(&bar, drawing(0), 0, 80);
    for (size_t columns = 1; columns < 120; columns++) {
        const char *line = line_of(&bar, drawing(1800), 9e3, columns);
        assert_true(strlen(line) < columns);
        assert_true(columns < 36 || strstr(line, "0:09 left"));
        assert_true(columns < 60 || strstr(line, "1,800 of 3,600 tiles"));
        assert_true(columns < 80 || (strchr(line, '[') && strstr(line, "200/s")));
    }
}

/* Tiles of an earlier run are passed over at once, which says nothing of how long the rest takes. */
static void test_pace(void **state) {
    (void)state;
    camber_progress_bar bar = {.drawn = false};
    (void)line_of(&bar, drawing(0), 0, 120);
    (void)line_of(&bar, drawing(1800), 1, 120);
    for (uint64_t s = 1; s <= 60; s++)
        (void)line_of(&bar, drawing(1800 + 10 * s), 1e3 * (double)s, 120);
    const char *line = line_of(&bar, drawing(2410), 61e3, 120);
    assert_non_null(strstr(line, ", 10/s, 1:59 left"));
    /* Another stage begins with a clock of its own. */
    const camber_progress_info writing = {"writing tiles", 0.5, "entries", 5, 10};
    line = line_of(&bar, writing, 62e3, 120);
    assert_non_null(strstr(line, "writing tiles"));
    assert_null(strstr(line, "left"));
}

static void test_unknown_end(void **state) {
    (void)state;
    camber_progress_bar bar = {.drawn = false};
    const camber_progress_info features = {"reading", -1, "features", 1234567, 0};
    assert_string_equal(line_of(&bar, features, 0, 80), "reading          1,234,567 features");
    const camber_progress_info one = {"comparing", 0.5, "networks", 0, 1};
    assert_string_equal(line_of(&bar, one, 0, 80), "comparing       [###############               ]  50 %");
    const camber_progress_info silent = {"tessellating", -1, NULL, 0, 0};
    assert_string_equal(line_of(&bar, silent, 0, 80), "tessellating    ...");
    const camber_progress_info long_stage = {"a stage with a name that is longer than a terminal is wide", 2, NULL, 0,
                                             0};
    assert_true(strlen(line_of(&bar, long_stage, 0, 20)) == 19);
}

static void test_figures(void **state) {
    (void)state;
    assert_string_equal(camber_figure_count(0).text, "0");
    assert_string_equal(camber_figure_count(999).text, "999");
    assert_string_equal(camber_figure_count(1000).text, "1,000");
    assert_string_equal(camber_figure_count(1234567890).text, "1,234,567,890");
    assert_string_equal(camber_figure_number(-1234.5, 2).text, "-1,234.50");
    assert_string_equal(camber_figure_number(-123, 0).text, "-123");
    assert_string_equal(camber_figure_bytes(0).text, "0 bytes");
    assert_string_equal(camber_figure_bytes(1).text, "1 byte");
    assert_string_equal(camber_figure_bytes(1500).text, "1.5 KB");
    assert_string_equal(camber_figure_limit(512 << 20).text, "512M");
    assert_string_equal(camber_figure_limit(3ull << 40).text, "3072G");
    assert_string_equal(camber_figure_limit(256 << 10).text, "256K");
    assert_string_equal(camber_figure_limit(100000000).text, "100 MB");
    assert_string_equal(camber_figure_limit(0).text, "0 bytes");
    assert_string_equal(camber_figure_bytes(999949).text, "1.0 MB");
    assert_string_equal(camber_figure_bytes(37300000).text, "37.3 MB");
    assert_string_equal(camber_figure_bytes(UINT64_C(123456789012)).text, "123 GB");
    assert_string_equal(camber_figure_bytes(UINT64_MAX).text, "18,446,744 TB");
    assert_string_equal(camber_figure_time(351).text, "0.35 s");
    assert_string_equal(camber_figure_time(12345).text, "12.3 s");
    assert_string_equal(camber_figure_time(59990).text, "1 min 0 s");
    assert_string_equal(camber_figure_time(125e3).text, "2 min 5 s");
    assert_string_equal(camber_figure_time(12000e3).text, "3 h 20 min");
    assert_string_equal(camber_figure_time(-1).text, "0.00 s");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_line),        cmocka_unit_test(test_narrow),  cmocka_unit_test(test_pace),
        cmocka_unit_test(test_unknown_end), cmocka_unit_test(test_figures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
