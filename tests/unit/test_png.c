/* PNG: what is written, read back by libpng and chunk by chunk. */
#include "core.h"
#include "png_file.h"

static const camber_png_text TEXTS[] = {
    {"Software", "camber"},
    {"Copyright", "\xc2\xa9 OpenStreetMap contributors"},
};

static byte_list write_png(camber_context *context, const camber_png_desc *desc, const uint8_t *rgba,
                           uint32_t rows_a_call) {
    byte_list file = {.refuse_at = SIZE_MAX};
    camber_png *png = NULL;
    assert_int_equal(camber_png_create(context, desc, (camber_sink){byte_list_write, &file}, &png), CAMBER_OK);
    for (uint32_t row = 0; row < desc->height; row += rows_a_call) {
        const uint32_t some = desc->height - row < rows_a_call ? desc->height - row : rows_a_call;
        assert_int_equal(camber_png_write_rows(png, rgba + 4 * (size_t)desc->width * row, some), CAMBER_OK);
    }
    assert_int_equal(camber_png_finish(png), CAMBER_OK);
    camber_png_destroy(png);
    return file;
}

/* The pixels as RGBA, straight, by libpng's own reader. */
static uint8_t *read_png(const byte_list *file, uint32_t width, uint32_t height, bool alpha) {
    const png_pixels read = png_pixels_decode(file->bytes, file->size);
    assert_non_null(read.rgba);
    assert_false(read.warned);
    assert_int_equal(read.width, width);
    assert_int_equal(read.height, height);
    assert_true(read.alpha == alpha);
    return read.rgba;
}

/* Every premultiplied pair of a channel and an alpha: straight = round(255 * channel / alpha). */
static void test_unpremultiply(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    uint8_t *rgba = malloc(256 * 256 * 4);
    assert_non_null(rgba);
    for (unsigned alpha = 0; alpha < 256; alpha++) {
        for (unsigned c = 0; c < 256; c++) {
            uint8_t *pixel = rgba + 4 * (256 * alpha + c);
            pixel[0] = (uint8_t)(c < alpha ? c : alpha);
            pixel[1] = 0;
            pixel[2] = (uint8_t)c; /* past alpha: not premultiplied; white, no wrap */
            pixel[3] = (uint8_t)alpha;
        }
    }
    const camber_png_desc desc = {.width = 256, .height = 256};
    byte_list file = write_png(context, &desc, rgba, 100);
    uint8_t *back = read_png(&file, 256, 256, true);
    for (unsigned alpha = 0; alpha < 256; alpha++) {
        for (unsigned c = 0; c < 256; c++) {
            const uint8_t *pixel = back + 4 * (256 * alpha + c), *given = rgba + 4 * (256 * alpha + c);
            assert_int_equal(pixel[3], alpha);
            assert_int_equal(pixel[1], 0);
            const double exact = alpha ? 255.0 * given[0] / alpha : 0.0;
            assert_true((double)pixel[0] - exact <= 0.5 && exact - (double)pixel[0] <= 0.5);
            if (c >= alpha && alpha)
                assert_int_equal(pixel[2], 255);
        }
    }
    free(back);
    free(file.bytes);
    free(rgba);
    host_done(&h, context);
}

static void test_opaque_is_rgb(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    enum { WIDTH = 37, HEIGHT = 23 };
    uint8_t rgba[4 * WIDTH * HEIGHT];
    uint64_t seed = 3;
    for (size_t i = 0; i < sizeof rgba; i++)
        rgba[i] = i % 4 == 3 ? 255 : (uint8_t)camber_random_bits(&seed);
    for (int compression = 0; compression <= 9; compression++) {
        for (uint32_t rows = 1; rows < 30; rows += 11) {
            for (int opaque = 0; opaque < 2; opaque++) {
                const camber_png_desc desc = {
                    .width = WIDTH, .height = HEIGHT, .opaque = opaque, .compression = compression};
                byte_list file = write_png(context, &desc, rgba, rows);
                uint8_t *back = read_png(&file, WIDTH, HEIGHT, false); /* no pixel needs an alpha */
                assert_memory_equal(back, rgba, sizeof rgba);
                free(back);
                free(file.bytes);
            }
        }
    }
    host_done(&h, context);
}

static uint32_t big_endian(const unsigned char *bytes) {
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* The n-th chunk of a type, by the PNG specification: length, type, data, CRC. */
static const unsigned char *find_chunk(const byte_list *file, const char *type, size_t n, uint32_t *length) {
    for (size_t at = 8; at + 12 <= file->size; at += 12 + big_endian(file->bytes + at)) {
        *length = big_endian(file->bytes + at);
        if (memcmp(file->bytes + at + 4, type, 4) == 0 && n-- == 0)
            return file->bytes + at + 8;
    }
    return NULL;
}

static void test_chunks(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const uint8_t rgba[4] = {1, 2, 3, 255};
    const camber_png_desc desc = {.width = 1, .height = 1, .texts = TEXTS, .text_count = 2};
    byte_list file = write_png(context, &desc, rgba, 1);
    assert_memory_equal(file.bytes, "\x89PNG\r\n\x1a\n", 8);
    uint32_t length;
    for (size_t i = 0; i < 2; i++) {
        /* iTXt: keyword 0 flag method language 0 translated 0 text */
        const unsigned char *text = find_chunk(&file, "iTXt", i, &length);
        assert_non_null(text);
        const size_t key = strlen(TEXTS[i].key), size = strlen(TEXTS[i].text);
        assert_int_equal(length, key + 5 + size);
        assert_memory_equal(text, TEXTS[i].key, key + 1);
        assert_int_equal(text[key + 1], 0); /* not compressed */
        assert_memory_equal(text + key + 5, TEXTS[i].text, size);
    }
    assert_null(find_chunk(&file, "iTXt", 2, &length));
    assert_non_null(find_chunk(&file, "sRGB", 0, &length));
    const unsigned char *end = find_chunk(&file, "IEND", 0, &length);
    assert_non_null(end);
    assert_ptr_equal(end + 4, file.bytes + file.size);
    free(file.bytes);
    host_done(&h, context);
}

static void test_arguments(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    char long_key[81];
    memset(long_key, 'k', 80);
    long_key[80] = 0;
    const camber_png_text no_key = {"", "text"}, too_long = {long_key, "text"};
    const camber_png_desc bad[] = {
        {.width = 0, .height = 1},
        {.width = 1, .height = 0},
        {.width = 65536, .height = 1},
        {.width = 1, .height = 0xffffffffu},
        {.width = 1, .height = 1, .compression = 10},
        {.width = 1, .height = 1, .compression = -1},
        {.width = 1, .height = 1, .texts = &no_key, .text_count = 1},
        {.width = 1, .height = 1, .texts = &too_long, .text_count = 1},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        byte_list file = {.refuse_at = SIZE_MAX};
        camber_png *png = (camber_png *)(void *)&h;
        assert_int_equal(camber_png_create(context, bad + i, (camber_sink){byte_list_write, &file}, &png),
                         CAMBER_ERROR_ARGUMENT);
        assert_story(&h, "; ");
        assert_ptr_equal(png, &h);
        assert_int_equal(file.size, 0);
    }
    long_key[79] = 0;
    const camber_png_text longest = {long_key, ""};
    const uint8_t row[4 * 65535] = {0};
    const camber_png_desc widest = {.width = 65535, .height = 1, .texts = &longest, .text_count = 1};
    byte_list file = write_png(context, &widest, row, 1);
    free(file.bytes);
    host_done(&h, context);
}

static void test_row_counts(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    byte_list file = {.refuse_at = SIZE_MAX};
    const uint8_t rows[4 * 2 * 4] = {0};
    const camber_png_desc desc = {.width = 2, .height = 3};
    camber_png *png = NULL;
    assert_int_equal(camber_png_create(context, &desc, (camber_sink){byte_list_write, &file}, &png), CAMBER_OK);
    assert_int_equal(camber_png_write_rows(png, rows, 0), CAMBER_OK);
    assert_int_equal(camber_png_write_rows(png, rows, 2), CAMBER_OK);
    assert_int_equal(camber_png_finish(png), CAMBER_ERROR_IO);
    assert_story(&h, "1 rows are missing");
    assert_int_equal(camber_png_write_rows(png, rows, 2), CAMBER_ERROR_IO);
    assert_story(&h, "; ");
    assert_int_equal(camber_png_write_rows(png, rows, 1), CAMBER_OK);
    assert_int_equal(camber_png_finish(png), CAMBER_OK);
    camber_png_destroy(png);
    free(file.bytes);
    host_done(&h, context);
}

/* A full disk at any byte: CAMBER_ERROR_IO from then on, and the sink's owner knows why. */
static void test_sink_refuses(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    enum { SIDE = 64 };
    uint8_t rgba[4 * SIDE * SIDE];
    uint64_t seed = 9;
    for (size_t i = 0; i < sizeof rgba; i++)
        rgba[i] = (uint8_t)camber_random_bits(&seed);
    const camber_png_desc desc = {.width = SIDE, .height = SIDE, .texts = TEXTS, .text_count = 2, .compression = 1};
    byte_list whole = write_png(context, &desc, rgba, SIDE);
    for (size_t at = 0; at < whole.size; at += at < 300 || at + 60 > whole.size ? 1 : 211) {
        byte_list file = {.refuse_at = at};
        camber_png *const untouched = (camber_png *)(void *)&h;
        camber_png *png = untouched;
        camber_status status = camber_png_create(context, &desc, (camber_sink){byte_list_write, &file}, &png);
        if (status != CAMBER_OK) {
            assert_int_equal(status, CAMBER_ERROR_IO);
            assert_ptr_equal(png, untouched);
        } else {
            status = camber_png_write_rows(png, rgba, SIDE);
            if (status == CAMBER_OK)
                status = camber_png_finish(png);
            else
                assert_int_equal(camber_png_write_rows(png, rgba, 1), CAMBER_ERROR_IO);
            assert_int_equal(status, CAMBER_ERROR_IO);
            assert_int_equal(camber_png_finish(png), CAMBER_ERROR_IO);
            camber_png_destroy(png);
        }
        assert_true(file.size <= at);
        assert_int_equal(h.errors, 0);
        free(file.bytes);
    }
    free(whole.bytes);
    host_done(&h, context);
}

/* Pictures beyond 2^22 px are written as they come. */
enum { STREAM_WIDTH = 65535, STREAM_HEIGHT = 65 };

static uint8_t *make_stream_rows(bool translucent) {
    uint8_t *rgba = malloc(4 * (size_t)STREAM_WIDTH * STREAM_HEIGHT);
    uint64_t seed = 11;
    assert_non_null(rgba);
    for (size_t i = 0; i < (size_t)STREAM_WIDTH * STREAM_HEIGHT; i++) {
        const uint8_t level = i % 997 == 0 ? (uint8_t)camber_random_bits(&seed) : (uint8_t)(i >> 12);
        memcpy(rgba + 4 * i, (const uint8_t[4]){level, level, level, translucent ? level : 255}, 4);
    }
    return rgba;
}

static void test_stream(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    for (int opaque = 0; opaque < 2; opaque++) {
        uint8_t *rgba = make_stream_rows(!opaque);
        const camber_png_desc desc = {
            .width = STREAM_WIDTH, .height = STREAM_HEIGHT, .opaque = opaque, .texts = TEXTS, .text_count = 2};
        byte_list file = write_png(context, &desc, rgba, 7);
        uint8_t *back = read_png(&file, STREAM_WIDTH, STREAM_HEIGHT, !opaque);
        for (size_t i = 0; i < (size_t)STREAM_WIDTH * STREAM_HEIGHT; i++) {
            const uint8_t *given = rgba + 4 * i, straight = given[3] ? 255 : 0;
            const uint8_t expected[4] = {straight, straight, straight, given[3]};
            assert_memory_equal(back + 4 * i, opaque ? given : expected, 4);
        }
        free(back);
        free(file.bytes);
        free(rgba);
    }
    host_done(&h, context);
}

static void test_stream_refused(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    uint8_t *rgba = make_stream_rows(false);
    const camber_png_desc desc = {.width = STREAM_WIDTH, .height = STREAM_HEIGHT, .opaque = true};
    byte_list whole = write_png(context, &desc, rgba, STREAM_HEIGHT);
    for (size_t at = 0; at < whole.size; at += at < 60 ? 11 : at + 60 > whole.size ? 5 : whole.size / 7) {
        byte_list file = {.refuse_at = at};
        camber_png *png = NULL;
        camber_status status = camber_png_create(context, &desc, (camber_sink){byte_list_write, &file}, &png);
        if (status == CAMBER_OK)
            status = camber_png_write_rows(png, rgba, STREAM_HEIGHT);
        if (status == CAMBER_OK)
            status = camber_png_finish(png);
        assert_int_equal(status, CAMBER_ERROR_IO);
        if (png)
            assert_int_equal(camber_png_finish(png), CAMBER_ERROR_IO);
        camber_png_destroy(png);
        assert_true(file.size <= at);
        assert_int_equal(h.errors, 0);
        free(file.bytes);
    }
    free(whole.bytes);
    free(rgba);
    host_done(&h, context);
}

/* A small picture and a large one: the first is encoded at the end, the second as a stream. */
static void test_density(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const uint32_t widths[] = {3, STREAM_WIDTH}, heights[] = {2, STREAM_HEIGHT};
    uint8_t *rgba = make_stream_rows(false);
    for (size_t i = 0; i < 2; i++) {
        camber_png_desc desc = {.width = widths[i], .height = heights[i], .opaque = true, .dpi = 300};
        byte_list file = write_png(context, &desc, rgba, heights[i]);
        static const uint8_t chunk[] = {0, 0, 0, 9, 'p', 'H', 'Y', 's', 0, 0, 0x2e, 0x23, 0, 0, 0x2e, 0x23, 1};
        bool found = false;
        for (size_t at = 0; at + sizeof chunk < 200; at++)
            found = found || memcmp(file.bytes + at, chunk, sizeof chunk) == 0;
        assert_true(found);
        free(file.bytes);
    }
    free(rgba);
    host_done(&h, context);
}

static camber_status try_stream(camber_context *context, void *user) {
    const camber_png_desc desc = {.width = STREAM_WIDTH, .height = STREAM_HEIGHT, .opaque = true};
    byte_list file = {.refuse_at = SIZE_MAX};
    camber_png *png = NULL;
    camber_status status = camber_png_create(context, &desc, (camber_sink){byte_list_write, &file}, &png);
    if (status == CAMBER_OK)
        status = camber_png_write_rows(png, user, STREAM_HEIGHT);
    if (status == CAMBER_OK)
        status = camber_png_finish(png);
    camber_png_destroy(png);
    free(file.bytes);
    return status;
}

static void test_stream_memory(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    uint8_t *rgba = make_stream_rows(false);
    each_allocation_fails(&h, try_stream, context, rgba);
    free(rgba);
    host_done(&h, context);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stream),        cmocka_unit_test(test_stream_refused),
        cmocka_unit_test(test_stream_memory), cmocka_unit_test(test_unpremultiply),
        cmocka_unit_test(test_opaque_is_rgb), cmocka_unit_test(test_chunks),
        cmocka_unit_test(test_arguments),     cmocka_unit_test(test_row_counts),
        cmocka_unit_test(test_sink_refuses),  cmocka_unit_test(test_density),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
