/* The benchmark from outside, on scenes too small to mean anything: that it measures what it should, and that it tells
 * a loss from none. Ratios of times are spoilt a billionfold: no machine changes the verdict. */
#include <jansson.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include <cmocka.h>

#define MADE CAMBER_BENCH_OUT "/made.json"
#define KEPT CAMBER_BENCH_OUT "/kept.json"
#define OLD CAMBER_BENCH_OUT "/old.json"
#define AGAIN CAMBER_BENCH_OUT "/again.json"
#define SAID CAMBER_BENCH_OUT "/said.txt"
#define README CAMBER_BENCH_OUT "/README.md"

/* Gives the exit status of a shell command. */
static int shell(const char *command) {
    const int status = system(command);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static int run(const char *arguments) {
    char command[2048];
    snprintf(command, sizeof command, "'%s' %s > '%s' 2>&1", CAMBER_BENCH, arguments, SAID);
    return shell(command);
}

static json_t *load(const char *path) {
    json_error_t error;
    json_t *document = json_load_file(path, 0, &error);
    if (!document)
        fail_msg("%s: %s", path, error.text);
    return document;
}

static const json_t *section_of(const json_t *document, const char *name) {
    const json_t *section = json_object_get(json_object_get(document, "sections"), name);
    if (!section)
        fail_msg("the document has no section %s", name);
    return section;
}

static double number_of(const json_t *object, const char *key) {
    const json_t *value = json_object_get(object, key);
    if (!json_is_number(value))
        fail_msg("%s is no number", key);
    return json_number_value(value);
}

static bool said(const char *text) {
    char line[512];
    bool found = false;
    FILE *file = fopen(SAID, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file))
        found = found || strstr(line, text);
    fclose(file);
    return found;
}

/* ---- Measurements ---- */

static void check_stages(const json_t *document) {
    const json_t *rows = json_object_get(section_of(document, "stages"), "rows"), *row;
    static const char *const stages[] = {"classify", "scan", "emit", "all"};
    size_t i;
    assert_int_equal(json_array_size(rows), 2 * 3 * 2); /* scenes, methods, widths */
    json_array_foreach(rows, i, row) {
        const double segments = number_of(row, "segments"), bytes = number_of(row, "bytes_a_segment");
        assert_true(segments > 100 && bytes >= 8 && bytes < 400);
        assert_true(number_of(row, "memcpy_gb_s") > 0);
        for (size_t k = 0; k < 4; k++) {
            const json_t *stage = json_object_get(row, stages[k]);
            assert_true(number_of(stage, "m_points_s") > 0 && number_of(stage, "gb_s") > 0);
            assert_true(number_of(stage, "share") > 0);
        }
    }
}

static void check_frames(const json_t *document) {
    const json_t *rows = json_object_get(section_of(document, "frames"), "rows"), *row;
    const size_t peers = json_object_size(json_object_get(document, "peers"));
    size_t i;
    assert_int_equal(json_array_size(rows), 2);
    json_array_foreach(rows, i, row) {
        const char *key;
        json_t *peer;
        assert_true(number_of(row, "draw_ms") > 0 && number_of(row, "simple_draw_ms") > 0);
        assert_true(number_of(row, "frame_ms") > 0);
        assert_true(number_of(row, "cl_frame_ms") > 0 && number_of(row, "cl_simple_frame_ms") > 0);
        assert_true(number_of(row, "cl_difference") < 1);
        assert_int_equal(json_object_size(json_object_get(row, "peers")), peers);
        json_object_foreach(json_object_get(row, "peers"), key, peer) {
            if (!json_is_true(json_object_get(peer, "alike")))
                fail_msg("%s draws another picture: it differs by %g of 255", key, number_of(peer, "difference"));
            assert_true(number_of(peer, "ms") > 0 && number_of(peer, "difference") > 0);
        }
    }
}

/* Made scenes of areas: camber's picture is as near to the samples as they can tell, and every peer's is alike. */
static void check_areas(const json_t *document) {
    const json_t *rows = json_object_get(section_of(document, "areas"), "rows"), *row;
    const size_t peers = json_object_size(json_object_get(document, "peers"));
    size_t i;
    assert_int_equal(json_array_size(rows), 2);
    json_array_foreach(rows, i, row) {
        const char *key;
        json_t *peer;
        assert_true(number_of(row, "cl_frame_ms") > 0 && number_of(row, "tessellate_ms") > 0);
        assert_true(number_of(row, "edges") > 3 * number_of(row, "areas"));
        assert_true(number_of(row, "error") > 0 && number_of(row, "error") <= 0.15);
        assert_int_equal(json_object_size(json_object_get(row, "peers")), peers);
        json_object_foreach(json_object_get(row, "peers"), key, peer) {
            if (!json_is_true(json_object_get(peer, "alike")))
                fail_msg("%s fills other areas: it is off by %g of 255", key, number_of(peer, "error"));
            assert_true(number_of(peer, "ms") > 0 && number_of(peer, "error") > 0);
        }
    }
}

/* Rings as small as glyphs, by one thread, look as FreeType draws them. */
static void check_glyphs(const json_t *document) {
    const json_t *rows = json_object_get(section_of(document, "glyphs"), "rows"), *row = json_array_get(rows, 0);
    if (json_array_size(rows) == 0)
        return; /* no FreeType, or a device whose threads cannot be chosen */
    assert_true(number_of(row, "million_ms") > 0 && number_of(row, "freetype_ms") > 0);
    assert_true(number_of(row, "edges") == 40 * number_of(row, "rings"));
    assert_true(number_of(row, "difference") > 0 && number_of(row, "difference") < 2);
}

/* The demo's city by camber and by Mapnik: one picture, but for how each rounds and joins. */
static void check_city(const json_t *document) {
    const json_t *rows = json_object_get(section_of(document, "city"), "rows"), *row = json_array_get(rows, 0);
    if (!json_object_get(json_object_get(document, "peers"), "mapnik"))
        return;
    assert_int_equal(json_array_size(rows), 1);
    assert_true(number_of(row, "cl_frame_ms") > 0 && number_of(row, "tessellate_ms") > 0);
    assert_true(number_of(row, "mapnik_ms") > 0);
    assert_true(number_of(row, "layers") > 10 && number_of(row, "difference") < 1);
}

static void check_network(const json_t *document) {
    const json_t *rows = json_object_get(section_of(document, "network"), "rows"), *row;
    size_t i;
    assert_int_equal(json_array_size(rows), 2 * 2); /* scenes, tolerances */
    json_array_foreach(rows, i, row) {
        assert_true(number_of(row, "cull_emit_ms") > 0 && number_of(row, "m_points_s") > 0);
        assert_true(number_of(row, "all_ms") > 0 && number_of(row, "emit_ms") > 0);
    }
    assert_true(number_of(json_array_get(rows, 1), "mesh_bytes") < number_of(json_array_get(rows, 0), "mesh_bytes"));
}

static void check_mosaic(const json_t *document) {
    const json_t *rows = json_object_get(section_of(document, "mosaic"), "rows"), *row;
    double before = 0;
    size_t i;
    assert_int_equal(json_array_size(rows), 2);
    json_array_foreach(rows, i, row) {
        const double points = number_of(row, "points");
        assert_true(points > before);
        assert_true(number_of(row, "peak_bytes") > 12 * points);
        assert_true(number_of(json_object_get(row, "simple"), "frame_ms") > 0);
        before = points;
    }
}

static void check_many(const json_t *document) {
    const json_t *rows = json_object_get(section_of(document, "many"), "rows"), *row = json_array_get(rows, 0);
    assert_int_equal(json_array_size(rows), 1); /* that of layers needs a city */
    assert_true(number_of(row, "areas") > 0 && number_of(row, "one_ms") > 0 && number_of(row, "many_ms") > 0);
}

static void test_document(void **state) {
    (void)state;
    assert_int_equal(run("--tiny --json '" MADE "' --keep '" KEPT "'"), 0);
    json_t *document = load(MADE);
    assert_true(strlen(json_string_value(json_object_get(document, "date"))) == 20);
    assert_non_null(json_object_get(json_object_get(document, "device"), "driver"));
    assert_non_null(json_object_get(json_object_get(document, "gl"), "renderer"));
    check_stages(document);
    check_frames(document);
    check_areas(document);
    check_glyphs(document);
    check_city(document);
    check_network(document);
    check_mosaic(document);
    check_many(document);
    json_decref(document);
}

/* The kernels are for the processor that the device names, and --cpu-features is refused where that has more than AVX2
 * and cannot be limited. */
static void test_machine(void **state) {
    (void)state;
    json_t *document = load(MADE);
    const json_t *machine = json_object_get(document, "machine");
    json_t *peer;
    const char *key, *target = json_string_value(json_object_get(machine, "kernels_for"));
    assert_true(json_string_length(json_object_get(machine, "processor")) > 0);
    assert_true(json_string_length(json_object_get(machine, "compiler")) > 0);
    assert_true(number_of(machine, "cores") >= 1);
    assert_string_equal(json_string_value(json_object_get(machine, "code")),
                        json_string_value(json_object_get(machine, "vectors")));
    json_object_foreach(json_object_get(document, "peers"), key, peer)
        assert_true(json_string_length(json_object_get(peer, "build")) > 0);
    const bool is_avx2 = strcmp(target, "x86-64-v3") == 0 || strcmp(target, "haswell") == 0 ||
                         strcmp(target, "skylake") == 0 || strcmp(target, "broadwell") == 0 ||
                         strcmp(target, "znver3") == 0 || strncmp(target, "x86-64-v4", strlen("x86-64-v4")) == 0;
    assert_int_equal(run("--tiny --section stages --cpu-features avx2"), is_avx2 ? 0 : 69);
    assert_true(is_avx2 || (said("the kernels are compiled for") && said("POCL_KERNELLIB_NAME=avx2")));
    assert_int_equal(run("--tiny --section stages --cpu-features avx3"), 2);
    json_decref(document);
}

/* The back end cpu is limited to the level that has AVX2, unless the caller has asked for another one. It draws glyphs
 * by one thread. */
static void check_level(const json_t *document) {
    const json_t *machine = json_object_get(document, "machine");
    assert_string_equal(json_string_value(json_object_get(machine, "code")), "AVX2");
    check_glyphs(document);
    assert_int_equal(setenv("CAMBER_CPU", "x86-64-v2", 1), 0);
    assert_int_equal(run("--tiny --section stages --cpu-features avx2"), 69);
    assert_true(said("the kernels are compiled for x86-64-v2"));
}

static void test_level(void **state) {
    const char *level = getenv("CAMBER_CPU");
    char before[64];
    (void)state;
    snprintf(before, sizeof before, "%s", level ? level : "");
    assert_int_equal(unsetenv("CAMBER_CPU"), 0);
    json_t *document = run("--tiny --section glyphs --cpu-features avx2 --json '" AGAIN "'") == 0 ? load(AGAIN) : NULL;
    const json_t *machine = json_object_get(document, "machine");
    const char *target = json_string_value(json_object_get(machine, "kernels_for"));
    const bool here = target && strcmp(target, "x86-64-v3") == 0;
    if (here)
        check_level(document);
    json_decref(document);
    assert_int_equal(*before ? setenv("CAMBER_CPU", before, 1) : unsetenv("CAMBER_CPU"), 0);
    if (!here) {
        printf("the library has no kernels for x86-64-v3, or this processor cannot run them\n");
        skip();
    }
}

/* ---- Losses ---- */

/* Figures of one section as they would be if that had been so many times better, in frames; all others left out. */
static void write_old(double better) {
    json_t *document = load(MADE), *sections = json_object_get(document, "sections"), *section, *figure;
    const char *name;
    void *next;
    json_object_foreach_safe(sections, next, name, section) {
        size_t i;
        if (strcmp(name, "frames") != 0) {
            json_object_del(sections, name);
            continue;
        }
        json_array_foreach(json_object_get(section, "figures"), i, figure) {
            const double factor = json_is_true(json_object_get(figure, "less")) ? 1 / better : better;
            json_object_set_new(figure, "value", json_real(number_of(figure, "value") * factor));
        }
    }
    assert_int_equal(json_dump_file(document, OLD, 0), 0);
    json_decref(document);
}

static void need_peers(void) {
    json_t *document = load(MADE);
    const bool none = json_object_size(json_object_get(document, "peers")) == 0;
    json_decref(document);
    if (none) {
        printf("no peer is built in: there is nothing to lose against\n");
        skip();
    }
}

static void test_loss(void **state) {
    (void)state;
    need_peers();
    write_old(1e9);
    assert_int_equal(run("--tiny --section frames --json '" AGAIN "' --against '" OLD "'"), 1);
    assert_true(said("LOSS") && said("again  frames: zoom") && said("synth: draw at 0.1 px"));
}

static void test_gain(void **state) {
    (void)state;
    need_peers();
    write_old(1e-9);
    assert_int_equal(run("--tiny --section frames --json '" AGAIN "' --against '" OLD "'"), 0);
    assert_true(said("gain") && !said("LOSS") && !said("again"));
}

static void test_incomparable(void **state) {
    (void)state;
    json_t *document = load(MADE);
    json_object_set_new(document, "size", json_string("full"));
    assert_int_equal(json_dump_file(document, OLD, 0), 0);
    json_decref(document);
    assert_int_equal(run("--tiny --section stages --against '" OLD "'"), 2);
    assert_true(said("another size"));
    assert_int_equal(run("--tiny --section stages --against '" CAMBER_BENCH_OUT "/nothing.json'"), 66);
    assert_int_equal(run("--tiny --section city,glyphs:glyphs --json '" AGAIN "'"), 0);
    json_t *listed = load(AGAIN);
    assert_int_equal(json_object_size(json_object_get(listed, "sections")), 2);
    section_of(listed, "city");
    section_of(listed, "glyphs");
    json_decref(listed);
    assert_int_equal(run("--size 3"), 2);
    assert_int_equal(run("--fly 1280"), 2);
    assert_int_equal(run("--fly 8x8"), 2);
}

/* ---- The README ---- */

static void write_text(const char *path, const char *text) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* Writes OLD: MADE as AVX2 code on a processor that has more; camber draws in 10 ms, and peers, all alike, in 10 ms
 * times the number of their way. */
static void write_second(void) {
    json_t *document = load(MADE), *machine = json_object_get(document, "machine"), *row, *peer;
    json_t *rows = json_object_get(json_object_get(json_object_get(document, "sections"), "frames"), "rows");
    const char *key;
    size_t i;
    json_object_set_new(machine, "vectors", json_string("AVX-512"));
    json_object_set_new(machine, "code", json_string("AVX2"));
    json_object_set_new(machine, "kernels_for", json_string("haswell"));
    json_array_foreach(rows, i, row) {
        double ms = 0;
        json_object_set_new(row, "cl_frame_ms", json_real(10));
        json_object_foreach(json_object_get(row, "peers"), key, peer) {
            ms += 10;
            json_object_set_new(peer, "ms", json_real(ms));
            json_object_set_new(peer, "alike", json_true());
        }
    }
    assert_int_equal(json_dump_file(document, OLD, 0), 0);
    json_decref(document);
}

static void read_readme(char *text, size_t size) {
    FILE *file = fopen(README, "r");
    assert_non_null(file);
    text[fread(text, 1, size - 1, file)] = 0;
    fclose(file);
}

/* Publishes MADE and OLD into a file of that text, and reads it back. */
static void publish(const char *before, char *after, size_t size) {
    write_text(README, before);
    assert_int_equal(run("--readme '" MADE "' '" OLD "' '" README "'"), 0);
    read_readme(after, size);
    assert_null(strstr(after, "\nold\n"));
    assert_null(strstr(after, "nan"));
    for (const char *line = after; *line; line += strcspn(line, "\n") + 1)
        assert_in_range(strcspn(line, "\n"), 0, 120);
}

/* The second number of each column is OLD's: camber's time, and how many times each library's best way takes it, which
 * is the library's first. */
static void check_table(const char *text) {
    json_t *document = load(OLD), *peer;
    const char *key, *at = strstr(text, "\n| long walks, 8 px | ");
    int way = 0;
    assert_non_null(at);
    at = strstr(at, "/10.0 |");
    assert_non_null(at);
    json_object_foreach(json_object_get(document, "peers"), key, peer) {
        char column[32];
        way++;
        if (strchr(key, '_'))
            continue;
        snprintf(column, sizeof column, "/%.*f |", way < 2 ? 2 : 1, (double)way);
        at += strlen(" |");
        assert_int_equal(strncmp(at + strcspn(at, "/\n"), column, strlen(column)), 0);
        at = strstr(at, column) + strlen(column) - strlen(" |");
    }
    assert_non_null(strstr(text, "/AVX2 code."));
    assert_non_null(strstr(text, "\nAVX2: AVX2 code (haswell) on that processor, "));
    json_decref(document);
}

static void test_readme(void **state) {
    (void)state;
    char text[16384];
    write_second();
    publish("# head\n<!-- frames: made by ./dev bench --readme -->\nold\n<!-- /frames -->\n# tail\n", text,
            sizeof text);
    assert_true(strncmp(text, "# head\n<!-- frames", 18) == 0);
    assert_non_null(strstr(text, "\n| areas: an island | "));
    check_table(text);
    assert_non_null(strstr(text, "<!-- /frames -->\n# tail\n"));
    publish("# head\n<!-- measured: made by ./dev bench --readme -->\nold\n<!-- /measured -->\n# tail\n", text,
            sizeof text);
    assert_non_null(strstr(text, "### Tessellation\n"));
    assert_non_null(strstr(text, " AVX2: kernels |"));
    assert_non_null(strstr(text, "<!-- /measured -->\n# tail\n"));
    publish("# head\n<!-- areas: made by ./dev bench --readme -->\nold\n<!-- /areas -->\n# tail\n", text, sizeof text);
    assert_non_null(strstr(text, "\n| 100,000 houses, 4000 edges | "));
    assert_non_null(strstr(text, "<!-- /areas -->\n# tail\n"));
    write_text(README, "# head\n# tail\n");
    assert_int_equal(run("--readme '" MADE "' '" README "'"), 1);
    assert_true(said("lacks one of the lines"));
    assert_int_equal(run("--readme '" MADE "'"), 2);
}

/* KEPT, which has less, makes the same tables as MADE. Its figures are those of MADE, and the comparison finds them. */
static void test_kept(void **state) {
    static const char text[] = "<!-- frames: made by ./dev bench --readme -->\n<!-- /frames -->\n"
                               "<!-- areas: made by ./dev bench --readme -->\n<!-- /areas -->\n"
                               "<!-- measured: made by ./dev bench --readme -->\n<!-- /measured -->\n";
    (void)state;
    char made[32768], kept[32768];
    write_text(README, text);
    assert_int_equal(shell("cp '" MADE "' '" AGAIN "'"), 0); /* the tables name the file that they are made of */
    assert_int_equal(run("--readme '" AGAIN "' '" README "'"), 0);
    read_readme(made, sizeof made);
    write_text(README, text);
    assert_int_equal(shell("cp '" KEPT "' '" AGAIN "'"), 0);
    assert_int_equal(run("--readme '" AGAIN "' '" README "'"), 0);
    read_readme(kept, sizeof kept);
    assert_string_equal(made, kept);
    assert_int_equal(shell("test $(wc -l < '" KEPT "') -lt $(($(wc -l < '" MADE "') / 5))"), 0);
    json_t *all = load(MADE), *document = load(KEPT), *figure;
    const json_t *figures = json_object_get(section_of(all, "stages"), "figures");
    size_t i;
    json_array_foreach(figures, i, figure) {
        const char *against = json_string_value(json_object_get(figure, "against"));
        const json_t *value = json_object_get(section_of(document, "stages"), "figures");
        value = json_object_get(value, json_string_value(json_object_get(figure, "item")));
        value = json_object_get(value, json_string_value(json_object_get(figure, "what")));
        assert_true(number_of(value, against ? against : "") == number_of(figure, "value"));
    }
    assert_true(i > 0);
    assert_int_equal(run("--tiny --section stages --against '" KEPT "'") & ~1, 0);
    json_decref(document);
    json_decref(all);
}

/* The numbers of a document of the tree are what the results of the tree say: made again, it is the same. */
static void test_documents(void **state) {
    static const char *const paths[] = {"README.md", "docs/areas.md", "docs/performance.md"};
    (void)state;
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        char command[4096];
        snprintf(command, sizeof command,
                 "cd '%s' && cp '%s' '%s' && '%s' --readme bench/results/xeon-avx512.json bench/results/xeon-avx2.json "
                 "'%s' && cmp '%s' '%s'",
                 CAMBER_TEST_DATA "/../..", paths[i], README, CAMBER_BENCH, README, paths[i], README);
        assert_int_equal(shell(command), 0);
    }
}

int main(void) {
    if (run("--tiny --section stages") == 69) {
        printf("no OpenCL device or no GL here\n");
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_document), cmocka_unit_test(test_machine), cmocka_unit_test(test_level),
        cmocka_unit_test(test_loss),     cmocka_unit_test(test_gain),    cmocka_unit_test(test_incomparable),
        cmocka_unit_test(test_readme),   cmocka_unit_test(test_kept),    cmocka_unit_test(test_documents)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
