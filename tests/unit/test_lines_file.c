/* The interchange file of polylines. */
#include "core.h"

#include "lines/lines.h"

enum { MAGIC_SIZE = 4, HEAD_SIZE = 12 };

static void put_word(byte_list *list, uint32_t word) {
    const unsigned char bytes[4] = {(unsigned char)word, (unsigned char)(word >> 8), (unsigned char)(word >> 16),
                                    (unsigned char)(word >> 24)};
    assert_true(byte_list_write(list, bytes, 4));
}

static void put_float(byte_list *list, float value) {
    uint32_t word;
    memcpy(&word, &value, 4);
    put_word(list, word);
}

/* A file by the words of the contract: three polylines, of which the second is empty. */
static byte_list make_file(void) {
    byte_list list = {.refuse_at = SIZE_MAX};
    const uint32_t words[] = {0x4c594c50u, 3, 5, 0, 2, 2, 5};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        put_word(&list, words[i]);
    for (int i = 0; i < 10; i++)
        put_float(&list, (float)i * 1.25f - 3.0f);
    return list;
}

static void assert_refused(camber_context *context, host *h, const byte_list *file, const char *part) {
    const camber_lines untouched = {.points = NULL, .offsets = NULL, .point_count = 123, .polyline_count = 456};
    camber_lines lines = untouched;
    /* A copy of the exact size: an overrun shows under a sanitizer. */
    unsigned char *exact = malloc(file->size ? file->size : 1);
    assert_non_null(exact);
    if (file->size)
        memcpy(exact, file->bytes, file->size);
    assert_int_equal(camber_lines_parse(context, exact, file->size, "some.plyl", &lines), CAMBER_ERROR_INPUT);
    assert_story(h, "some.plyl: ");
    if (part)
        assert_non_null(strstr(h->last, part));
    assert_memory_equal(&lines, &untouched, sizeof lines);
    free(exact);
}

static void test_parse(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    byte_list file = make_file();
    assert_memory_equal(file.bytes, "PLYL", MAGIC_SIZE);
    camber_lines lines;
    assert_int_equal(camber_lines_parse(context, file.bytes, file.size, "x", &lines), CAMBER_OK);
    assert_int_equal(lines.polyline_count, 3);
    assert_int_equal(lines.point_count, 5);
    const uint32_t offsets[] = {0, 2, 2, 5};
    assert_memory_equal(lines.offsets, offsets, sizeof offsets);
    for (int i = 0; i < 10; i++)
        assert_true(lines.points[i] == (float)i * 1.25f - 3.0f);
    byte_list again = {.refuse_at = SIZE_MAX};
    assert_int_equal(camber_lines_write(context, &lines, (camber_sink){byte_list_write, &again}), CAMBER_OK);
    assert_int_equal(again.size, file.size);
    assert_memory_equal(again.bytes, file.bytes, file.size);
    camber_lines_destroy(&lines);
    assert_true(!lines.points && !lines.offsets && lines.point_count == 0);
    free(again.bytes);
    free(file.bytes);
    host_done(&h, context);
}

/* NaN and infinity are the reader's business as much as any other bits: they come through. */
static void test_round_trip(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    uint64_t seed = 5;
    for (int round = 0; round < 20; round++) {
        const size_t n = camber_random_below(&seed, 3000);
        uint32_t *offsets = calloc(n + 1, sizeof *offsets);
        assert_non_null(offsets);
        for (size_t i = 0; i < n; i++)
            offsets[i + 1] = offsets[i] + (uint32_t)camber_random_below(&seed, 4);
        const size_t p = offsets[n];
        float *points = calloc(2 * p + 1, sizeof *points);
        assert_non_null(points);
        for (size_t i = 0; i < 2 * p; i++) {
            const uint32_t bits = (uint32_t)camber_random_bits(&seed);
            memcpy(points + i, &bits, 4);
        }
        byte_list file = {.refuse_at = SIZE_MAX};
        const camber_lines lines = {.points = points, .offsets = offsets, .point_count = p, .polyline_count = n};
        assert_int_equal(camber_lines_write(context, &lines, (camber_sink){byte_list_write, &file}), CAMBER_OK);
        assert_int_equal(file.size, HEAD_SIZE + 4 * (n + 1) + 8 * p);
        camber_lines back;
        assert_int_equal(camber_lines_parse(context, file.bytes, file.size, "x", &back), CAMBER_OK);
        assert_true(back.polyline_count == n && back.point_count == p);
        assert_memory_equal(back.offsets, offsets, 4 * (n + 1));
        if (p)
            assert_memory_equal(back.points, points, 8 * p);
        camber_lines_destroy(&back);
        free(file.bytes);
        free(points);
        free(offsets);
    }
    host_done(&h, context);
}

static void test_nothing(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const camber_lines none = {0};
    byte_list file = {.refuse_at = SIZE_MAX};
    assert_int_equal(camber_lines_write(context, &none, (camber_sink){byte_list_write, &file}), CAMBER_OK);
    assert_int_equal(file.size, HEAD_SIZE + 4);
    camber_lines lines;
    assert_int_equal(camber_lines_parse(context, file.bytes, file.size, "x", &lines), CAMBER_OK);
    assert_true(lines.polyline_count == 0 && lines.point_count == 0);
    assert_int_equal(lines.offsets[0], 0);
    camber_lines_destroy(&lines);
    free(file.bytes);
    host_done(&h, context);
}

static void test_cut_off_everywhere(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    byte_list file = make_file();
    const size_t whole = file.size;
    for (size_t size = 0; size < whole; size++) {
        file.size = size;
        assert_refused(context, &h, &file, size < HEAD_SIZE ? "PLYL" : "cut off");
    }
    file.size = whole;
    for (int i = 0; i < 9; i++) {
        assert_true(byte_list_write(&file, "x", 1)); /* bytes left over */
        assert_refused(context, &h, &file, "announces");
    }
    free(file.bytes);
    host_done(&h, context);
}

static void test_damaged(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    byte_list file = make_file();
    for (int i = 0; i < MAGIC_SIZE; i++) {
        file.bytes[i] ^= 1;
        assert_refused(context, &h, &file, "PLYL");
        file.bytes[i] ^= 1;
    }
    /* Offsets 0 2 2 5, one damaged at a time. */
    static const struct {
        size_t which;
        uint32_t value;
    } damages[] = {{0, 1}, {1, 6}, {1, 3}, {2, 1}, {2, 6}, {3, 4}, {3, 6}, {3, 1}, {1, 0xffffffffu}, {3, 0x80000005u}};
    for (size_t i = 0; i < sizeof damages / sizeof *damages; i++) {
        unsigned char *at = file.bytes + HEAD_SIZE + 4 * damages[i].which, kept[4];
        memcpy(kept, at, 4);
        for (int b = 0; b < 4; b++)
            at[b] = (unsigned char)(damages[i].value >> 8 * b);
        assert_refused(context, &h, &file, "offset");
        memcpy(at, kept, 4);
    }
    camber_lines lines;
    assert_int_equal(camber_lines_parse(context, file.bytes, file.size, "x", &lines), CAMBER_OK);
    camber_lines_destroy(&lines);
    free(file.bytes);
    host_done(&h, context);
}

/* Counts whose sizes overflow 32 bits, or nearly: told from the size, before memory is asked for. */
static void test_counts_that_overflow(void **state) {
    (void)state;
    static const uint32_t counts[] = {0x1fffffffu, 0x20000000u, 0x3fffffffu, 0x40000000u,
                                      0x7fffffffu, 0x80000000u, 0xfffffffeu, 0xffffffffu};
    host h;
    camber_context *context = host_context(&h);
    const size_t calls = h.calls;
    for (size_t n = 0; n < sizeof counts / sizeof *counts; n++) {
        for (size_t p = 0; p < sizeof counts / sizeof *counts; p++) {
            byte_list file = {.refuse_at = SIZE_MAX};
            put_word(&file, 0x4c594c50u);
            put_word(&file, counts[n]);
            put_word(&file, counts[p]);
            for (int i = 0; i < 8; i++) {
                assert_refused(context, &h, &file, "announces");
                put_word(&file, 0);
            }
            free(file.bytes);
        }
    }
    assert_int_equal(h.calls, calls);
    host_done(&h, context);
}

static void test_random_bytes(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    uint64_t seed = 77;
    byte_list file = make_file();
    unsigned char *original = malloc(file.size);
    assert_non_null(original);
    memcpy(original, file.bytes, file.size);
    for (int round = 0; round < 20000; round++) {
        memcpy(file.bytes, original, file.size);
        for (size_t i = 0; i < 1 + camber_random_below(&seed, 3); i++) {
            const unsigned char byte = (unsigned char)camber_random_bits(&seed);
            file.bytes[camber_random_below(&seed, HEAD_SIZE + 16)] = byte;
        }
        camber_lines lines;
        if (camber_lines_parse(context, file.bytes, file.size, "x", &lines) != CAMBER_OK)
            continue;
        for (size_t i = 0; i < lines.polyline_count; i++)
            assert_true(lines.offsets[i] <= lines.offsets[i + 1]);
        assert_int_equal(lines.offsets[lines.polyline_count], lines.point_count);
        camber_lines_destroy(&lines);
    }
    free(original);
    free(file.bytes);
    host_done(&h, context);
}

static void test_sink_refuses(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const size_t p = 3000; /* more than a block of the writer's */
    float *points = calloc(2 * p, sizeof *points);
    assert_non_null(points);
    uint32_t offsets[] = {0, (uint32_t)p};
    const camber_lines lines = {.points = points, .offsets = offsets, .point_count = p, .polyline_count = 1};
    const size_t whole = HEAD_SIZE + 8 + 8 * p;
    for (size_t at = 0; at <= whole; at += at < 32 ? 1 : 997) {
        byte_list file = {.refuse_at = at};
        assert_int_equal(camber_lines_write(context, &lines, (camber_sink){byte_list_write, &file}), CAMBER_ERROR_IO);
        free(file.bytes);
        if (at + 997 > whole)
            break;
    }
    free(points);
    host_done(&h, context);
}

/* Points that are no numbers, or beyond 1e9 px, stay bit for bit where they are, and the line is straightened between
 * them, not across. */
static void test_simplify(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const uint32_t signalling = 0x7f800001u;
    float nan;
    memcpy(&nan, &signalling, sizeof nan);
    float points[][2] = {{0, 0}, {5, 0.1f},     {9, 0}, {nan, 3}, {2e9f, 0}, {9, 9},       {9, 9}, {7, 9.2f}, {3, 9},
                         {7, 7}, {8, INFINITY}, {9, 7}, {1, 1},   {2, 2},    {1, 1.0625f}, {0, 0}, {0, 1},    {1, 1}};
    float wanted[][2] = {{0, 0},        {9, 0}, {nan, 3}, {2e9f, 0}, {9, 9}, {3, 9}, {7, 7},
                         {8, INFINITY}, {9, 7}, {1, 1},   {2, 2},    {0, 0}, {1, 1}};
    uint32_t offsets[] = {0, 9, 9, 12, 18};
    const uint32_t wanted_offsets[] = {0, 6, 6, 9, 13};
    memcpy(&points[3][0], &signalling, sizeof signalling); /* compilers quieten it */
    memcpy(&wanted[2][0], &signalling, sizeof signalling);
    const camber_lines lines = {.points = points[0], .offsets = offsets, .point_count = 18, .polyline_count = 4};
    camber_lines made = {0};
    assert_int_equal(camber_lines_simplify(context, &lines, 1, &made), CAMBER_OK);
    assert_int_equal(made.polyline_count, 4);
    assert_int_equal(made.point_count, 13);
    assert_memory_equal(made.offsets, wanted_offsets, sizeof wanted_offsets);
    assert_memory_equal(made.points, wanted, sizeof wanted);
    camber_lines_destroy(&made);
    assert_int_equal(camber_lines_simplify(context, &lines, 0, &made), CAMBER_OK);
    assert_memory_equal(made.points, points, sizeof points);
    camber_lines_destroy(&made);
    assert_int_equal(camber_lines_simplify(context, &lines, -1, &made), CAMBER_ERROR_ARGUMENT);
    assert_story(&h, "tolerance");
    assert_int_equal(camber_lines_simplify(context, &lines, (double)NAN, &made), CAMBER_ERROR_ARGUMENT);
    assert_story(&h, "tolerance");
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parse),        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_nothing),      cmocka_unit_test(test_cut_off_everywhere),
        cmocka_unit_test(test_damaged),      cmocka_unit_test(test_counts_that_overflow),
        cmocka_unit_test(test_random_bytes), cmocka_unit_test(test_sink_refuses),
        cmocka_unit_test(test_simplify),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
