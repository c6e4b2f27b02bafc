/* Encoders: pictures of all numbers of colours, read back by libpng and libwebp; by how much png8 differs; that bytes
 * depend on the pixels alone; and what fails where there is no memory. */
#include "core.h"
#include "io/deflate.h"
#include "png_file.h"

#include <math.h>
#include <pthread.h>
#ifdef CAMBER_WEBP
#include <webp/decode.h>
#include <webp/encode.h>
#endif

/* Where png8 is to change on purpose, the test says the new one. */
static const uint64_t PINNED_HASH = 0xe5ae791a4e3a3853;

typedef struct picture {
    uint8_t *rgba; /* premultiplied */
    uint32_t width, height;
    size_t stride_bytes;
} picture;

static picture picture_make(uint32_t width, uint32_t height) {
    picture made = {.width = width, .height = height, .stride_bytes = 4 * (size_t)width + 12};
    made.rgba = calloc(made.stride_bytes, height);
    assert_non_null(made.rgba);
    return made;
}

static uint8_t *pixel(const picture *from, size_t x, size_t y) {
    return from->rgba + from->stride_bytes * y + 4 * x;
}

static camber_pixels pixels_of(const picture *from) {
    return (camber_pixels){from->rgba, from->width, from->height, from->stride_bytes};
}

static camber_encoder *make_encoder(camber_context *context, camber_encoding encoding, int quality) {
    const camber_encoder_desc desc = {.encoding = encoding, .quality = quality};
    camber_encoder *made = NULL;
    assert_int_equal(camber_encoder_create(context, &desc, &made), CAMBER_OK);
    return made;
}

static camber_status encode(camber_encoder *encoder, const picture *from, const uint8_t **bytes, size_t *size) {
    const camber_pixels pixels = pixels_of(from);
    return camber_encoder_encode(encoder, &pixels, bytes, size);
}

/* ---- Reading back ---- */

/* Straight RGBA, by libpng. */
static uint8_t *read_png(const uint8_t *bytes, size_t size, const picture *given) {
    const png_pixels read = png_pixels_decode(bytes, size);
    assert_non_null(read.rgba);
    assert_false(read.warned);
    assert_int_equal(read.width, given->width);
    assert_int_equal(read.height, given->height);
    return read.rgba;
}

/* Premultiplied again: the straight colour that is nearest gives back what it was made of. */
static void premultiply(uint8_t *rgba, size_t count) {
    for (size_t i = 0; i < count; i++, rgba += 4)
        for (int c = 0; c < 3; c++)
            rgba[c] = (uint8_t)((rgba[c] * rgba[3] + 127) / 255);
}

static void assert_same(uint8_t *straight, const picture *given) {
    premultiply(straight, (size_t)given->width * given->height);
    for (size_t y = 0; y < given->height; y++)
        assert_memory_equal(straight + 4 * given->width * y, pixel(given, 0, y), 4 * (size_t)given->width);
}

/* ---- Pictures ---- */

enum { OPAQUE, TRANSLUCENT, TRANSPARENT_TOO };

/* So many different colours of a kind. */
static void make_color(size_t number, int kind, uint8_t color[4]) {
    const unsigned alpha = kind == OPAQUE                           ? 255
                           : kind == TRANSPARENT_TOO && number == 0 ? 0
                                                                    : 255 - (unsigned)(number % 16) * 8;
    const unsigned levels[3] = {(unsigned)(number / 16 % 64), (unsigned)(number % 16), (unsigned)(number / 1024)};
    for (int c = 0; c < 3; c++)
        color[c] = (uint8_t)(levels[c] < alpha ? levels[c] : alpha);
    color[3] = (uint8_t)alpha;
}

static void fill(picture *made, size_t color_count, int kind, uint64_t *seed) {
    size_t next = 0;
    for (size_t y = 0; y < made->height; y++)
        for (size_t x = 0; x < made->width; x++) {
            const size_t number = next < color_count ? next++ : camber_random_bits(seed) % color_count;
            make_color(number, kind, pixel(made, x, y));
        }
}

/* Mixtures by coverage of a few colours, as lines make them on a map: streets of some inks, four at most, on a ground,
 * which is flat. */
static void draw_lines(picture *made, bool transparent, size_t ink_count) {
    static const uint8_t inks[5][4] = {
        {242, 239, 233, 255}, {255, 255, 255, 255}, {252, 214, 164, 255}, {170, 211, 223, 255}, {200, 60, 90, 255}};
    uint64_t seed = 5;
    for (size_t y = 0; y < made->height; y++)
        for (size_t x = 0; x < made->width; x++) {
            uint8_t *at = pixel(made, x, y);
            memcpy(at, inks[0], 4);
            if (transparent)
                memset(at, 0, 4);
        }
    for (int line = 0; line < 60; line++) {
        const uint8_t *ink = inks[1 + camber_random_bits(&seed) % ink_count];
        const double slope = (double)(camber_random_bits(&seed) % 2000) / 1000 - 1;
        const double start =
            (double)(camber_random_bits(&seed) % 10000) / 10000 * made->height * 2 - made->height / 2.0;
        for (size_t x = 0; x < made->width; x++)
            for (size_t y = 0; y < made->height; y++) {
                double part = 2.5 - fabs((double)y - start - slope * (double)x);
                part = part < 0 ? 0 : part > 1 ? 1 : part;
                uint8_t *at = pixel(made, x, y);
                for (int c = 0; c < 4 && part > 0; c++)
                    at[c] = (uint8_t)(part * ink[c] + (1 - part) * at[c] + 0.5);
            }
    }
}

static void draw_map(picture *made, bool transparent) {
    draw_lines(made, transparent, 4);
}

/* ---- PNG ---- */

static void check_kind(const uint8_t *bytes, size_t size, int depth, int kind) {
    assert_true(size > 26);
    assert_int_equal(bytes[24], depth);
    assert_int_equal(bytes[25], kind);
}

static void test_round_trip(void **state) {
    (void)state;
    static const struct {
        size_t colors;
        int depth; /* 0: no palette */
    } cases[] = {{1, 1}, {2, 1}, {3, 2}, {4, 2}, {5, 4}, {16, 4}, {17, 8}, {255, 8}, {256, 8}, {257, 0}, {4000, 0}};
    host h;
    camber_context *context = host_context(&h);
    camber_encoder *encoder = make_encoder(context, CAMBER_ENCODING_PNG, 0);
    uint64_t seed = 17;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int kind = OPAQUE; kind <= TRANSPARENT_TOO; kind++) {
            picture given = picture_make(61 + (uint32_t)i, 67);
            fill(&given, cases[i].colors, kind, &seed);
            const uint8_t *bytes;
            size_t size;
            assert_int_equal(encode(encoder, &given, &bytes, &size), CAMBER_OK);
            const bool alpha = kind != OPAQUE && cases[i].colors > 1;
            if (cases[i].depth)
                check_kind(bytes, size, cases[i].depth, PNG_COLOR_TYPE_PALETTE);
            else
                check_kind(bytes, size, 8, alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB);
            uint8_t *back = read_png(bytes, size, &given);
            assert_same(back, &given);
            free(back);
            free(given.rgba);
        }
    camber_encoder_destroy(encoder);
    host_done(&h, context);
}

/* All encodings that keep every pixel, in sizes of few pixels, and of many in one direction. */
static void test_sizes(void **state) {
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {2, 1},    {1, 2},     {3, 3},    {7, 5},
                                        {9, 1}, {1, 4000}, {65535, 1}, {1, 65535}};
    host h;
    camber_context *context = host_context(&h);
    uint64_t seed = 23;
    for (int encoding = CAMBER_ENCODING_PNG; encoding <= CAMBER_ENCODING_PNG8; encoding++) {
        camber_encoder *encoder = make_encoder(context, (camber_encoding)encoding, 0);
        for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
            for (size_t colors = 1; colors <= 256; colors *= 4) {
                picture given = picture_make(sizes[i][0], sizes[i][1]);
                fill(&given, colors, TRANSLUCENT, &seed);
                const uint8_t *bytes;
                size_t size;
                assert_int_equal(encode(encoder, &given, &bytes, &size), CAMBER_OK);
                uint8_t *back = read_png(bytes, size, &given);
                assert_same(back, &given);
                free(back);
                free(given.rgba);
            }
        camber_encoder_destroy(encoder);
    }
    host_done(&h, context);
}

static void test_one_color_is_tiny(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    for (int encoding = CAMBER_ENCODING_PNG; encoding <= CAMBER_ENCODING_PNG8; encoding++) {
        camber_encoder *encoder = make_encoder(context, (camber_encoding)encoding, 0);
        picture given = picture_make(256, 256);
        uint64_t seed = 1;
        fill(&given, 1, OPAQUE, &seed);
        const uint8_t *bytes;
        size_t size;
        assert_int_equal(encode(encoder, &given, &bytes, &size), CAMBER_OK);
        assert_true(size < 180);
        free(given.rgba);
        camber_encoder_destroy(encoder);
    }
    host_done(&h, context);
}

/* ---- png8 ---- */

typedef struct errors {
    double mean;
    int most;
} errors;

/* Errors are those of premultiplied channels. Pixels that are opaque, or transparent, must stay so. */
static errors compare(const uint8_t *straight, const picture *given) {
    errors found = {0};
    double sum = 0;
    for (size_t y = 0; y < given->height; y++)
        for (size_t x = 0; x < given->width; x++) {
            uint8_t read[4];
            const uint8_t *is = pixel(given, x, y);
            memcpy(read, straight + 4 * (given->width * y + x), 4);
            assert_true((read[3] == 255) == (is[3] == 255) && (read[3] == 0) == (is[3] == 0));
            premultiply(read, 1);
            for (int c = 0; c < 4; c++) {
                const int apart = abs(read[c] - is[c]);
                sum += apart;
                found.most = apart > found.most ? apart : found.most;
            }
        }
    found.mean = sum / (4.0 * given->width * given->height);
    return found;
}

static errors quantize_to(camber_encoder *encoder, const picture *given, int depth) {
    const uint8_t *bytes;
    size_t size;
    assert_int_equal(encode(encoder, given, &bytes, &size), CAMBER_OK);
    check_kind(bytes, size, depth, PNG_COLOR_TYPE_PALETTE);
    uint8_t *back = read_png(bytes, size, given);
    const errors found = compare(back, given);
    free(back);
    return found;
}

static errors quantize(camber_encoder *encoder, const picture *given) {
    return quantize_to(encoder, given, 8);
}

static void test_map_as_png8(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_encoder *encoder = make_encoder(context, CAMBER_ENCODING_PNG8, 0);
    for (int transparent = 0; transparent < 2; transparent++) {
        picture given = picture_make(256, 256);
        draw_map(&given, transparent);
        const errors found = quantize(encoder, &given);
        if (found.mean > 0.5 || found.most > 20)
            fail_msg("mean error %g, greatest %d", found.mean, found.most);
        assert_true(found.most > 0); /* there is something to quantize */
        free(given.rgba);
    }
    camber_encoder_destroy(encoder);
    host_done(&h, context);
}

/* Mixtures of two colours need no more than 16, and so 4 bits a pixel. */
static void test_map_of_two_colors(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_encoder *encoder = make_encoder(context, CAMBER_ENCODING_PNG8, 0);
    picture given = picture_make(256, 256);
    draw_lines(&given, false, 1);
    const errors found = quantize_to(encoder, &given, 4);
    if (found.mean > 0.1 || found.most > 4)
        fail_msg("mean error %g, greatest %d", found.mean, found.most);
    assert_true(found.most > 0);
    free(given.rgba);
    camber_encoder_destroy(encoder);
    host_done(&h, context);
}

/* The ground keeps its colour to the last bit, and so does each colour with enough pixels. */
static void test_flat_colors_stay(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_encoder *encoder = make_encoder(context, CAMBER_ENCODING_PNG8, 0);
    picture given = picture_make(200, 200);
    uint64_t seed = 3;
    for (size_t y = 0; y < 200; y++)
        for (size_t x = 0; x < 200; x++) {
            const uint8_t flat = (uint8_t)(y / 2);
            const uint8_t color[4] = {flat, (uint8_t)(255 - flat), 77, 255};
            uint8_t *at = pixel(&given, x, y);
            memcpy(at, color, 4);
            for (int c = 0; c < 3 && x >= 120; c++)
                at[c] = (uint8_t)camber_random_bits(&seed);
        }
    const uint8_t *bytes;
    size_t size;
    assert_int_equal(encode(encoder, &given, &bytes, &size), CAMBER_OK);
    uint8_t *back = read_png(bytes, size, &given);
    for (size_t y = 0; y < 200; y++)
        assert_memory_equal(back + 4 * 200 * y, pixel(&given, 0, y), 4 * 120);
    free(back);
    free(given.rgba);
    camber_encoder_destroy(encoder);
    host_done(&h, context);
}

/* More colours than are numbered one by one: noise, and gradients in all channels with a flat ground. */
static void test_many_colors(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_encoder *encoder = make_encoder(context, CAMBER_ENCODING_PNG8, 0);
    picture given = picture_make(512, 400);
    uint64_t seed = 29;
    for (size_t y = 0; y < 400; y++)
        for (size_t x = 0; x < 512; x++) {
            const uint32_t bits = (uint32_t)camber_random_bits(&seed);
            const uint8_t alpha = y < 100 ? (uint8_t)(bits >> 24) : 255;
            for (int c = 0; c < 3; c++)
                pixel(&given, x, y)[c] = (uint8_t)((bits >> 8 * c & 255) * alpha / 255);
            pixel(&given, x, y)[3] = alpha;
        }
    quantize(encoder, &given);
    for (size_t y = 0; y < 400; y++)
        for (size_t x = 0; x < 512; x++) {
            const uint8_t color[4] = {(uint8_t)(x / 2), (uint8_t)(y / 2), (uint8_t)((x + y) / 4), 255};
            memcpy(pixel(&given, x, y), y < 200 ? (const uint8_t[4]){31, 41, 59, 255} : color, 4);
        }
    const errors found = quantize(encoder, &given);
    if (found.mean > 6 || found.most > 40)
        fail_msg("mean error %g, greatest %d", found.mean, found.most);
    const uint8_t *bytes;
    size_t size;
    assert_int_equal(encode(encoder, &given, &bytes, &size), CAMBER_OK);
    uint8_t *back = read_png(bytes, size, &given);
    assert_memory_equal(back, pixel(&given, 0, 0), 4 * 512);
    free(back);
    free(given.rgba);
    camber_encoder_destroy(encoder);
    host_done(&h, context);
}

/* Any pixels at all, of which some have colours above their alpha, become a file that libpng reads. */
static void test_random(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_encoder *encoders[] = {make_encoder(context, CAMBER_ENCODING_PNG, 0),
                                  make_encoder(context, CAMBER_ENCODING_PNG8, 0)};
    uint64_t seed = 31;
    for (int run = 0; run < 400; run++) {
        const uint32_t width = 1 + (uint32_t)(camber_random_bits(&seed) % 90);
        picture given = picture_make(width, 1 + (uint32_t)(camber_random_bits(&seed) % 90));
        const uint64_t mask = camber_random_bits(&seed) & camber_random_bits(&seed);
        for (size_t i = 0; i < given.stride_bytes * given.height; i++)
            given.rgba[i] = (uint8_t)(camber_random_bits(&seed) & mask >> 8 * (i % 4));
        for (size_t k = 0; k < 2; k++) {
            const uint8_t *bytes;
            size_t size;
            assert_int_equal(encode(encoders[k], &given, &bytes, &size), CAMBER_OK);
            uint8_t *back = read_png(bytes, size, &given);
            for (size_t y = 0; y < given.height; y++)
                for (size_t x = 0; x < given.width; x++) {
                    const uint8_t alpha = back[4 * (given.width * y + x) + 3], was = pixel(&given, x, y)[3];
                    assert_true(k == 0 ? alpha == was : (alpha == 255) == (was == 255) && (alpha == 0) == (was == 0));
                }
            free(back);
        }
        free(given.rgba);
    }
    camber_encoder_destroy(encoders[0]);
    camber_encoder_destroy(encoders[1]);
    host_done(&h, context);
}

/* ---- The same bytes ---- */

/* The pixels that png8 makes of a map: other machines have other versions of libdeflate, but no other pixels. */
static void test_pixels_are_everywhere_the_same(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_encoder *encoder = make_encoder(context, CAMBER_ENCODING_PNG8, 0);
    picture given = picture_make(256, 256);
    for (size_t y = 0; y < 256; y++)
        for (size_t x = 0; x < 256; x++) {
            const unsigned part = (unsigned)(x * y % 251), alpha = y < 64 ? part : 255;
            const uint8_t color[4] = {(uint8_t)(part * x / 256 * alpha / 255), (uint8_t)(part * alpha / 255),
                                      (uint8_t)((255 - part) * alpha / 255), (uint8_t)alpha};
            memcpy(pixel(&given, x, y), color, 4);
        }
    const uint8_t *bytes;
    size_t size;
    assert_int_equal(encode(encoder, &given, &bytes, &size), CAMBER_OK);
    uint8_t *back = read_png(bytes, size, &given);
    const uint64_t hash = camber_hash(CAMBER_HASH_START, back, 4 * 256 * 256);
    if (hash != PINNED_HASH)
        fail_msg("hash %llx", (unsigned long long)hash);
    free(back);
    free(given.rgba);
    camber_encoder_destroy(encoder);
    host_done(&h, context);
}

/* One encoder for tiles of all kinds, and a fresh one for each, in several threads at once, whatever their memory held
 * before. */
typedef struct job {
    camber_encoding encoding;
    uint64_t hashes[8];
    bool fresh;
    uint8_t held; /* every other byte, as in small numbers */
} job;

static void *reallocate_held(void *user, void *block, size_t size_bytes) {
    if (size_bytes == 0) {
        free(block);
        return NULL;
    }
    void *moved = realloc(block, size_bytes);
    for (size_t i = 0; !block && moved && i < size_bytes; i++)
        ((uint8_t *)moved)[i] = i % 2 ? 0 : ((const job *)user)->held;
    return moved;
}

static void *encode_tiles(void *user) {
    job *j = user;
    camber_context *context = NULL;
    camber_encoder *encoder = NULL;
    const camber_encoder_desc desc = {.encoding = j->encoding};
    uint64_t seed = 37;
    const camber_context_desc holds = {.reallocate = reallocate_held, .allocator_user = j};
    if (camber_context_create(&holds, &context) != CAMBER_OK)
        return user;
    for (size_t i = 0; i < 8; i++) {
        picture given = picture_make(i % 2 ? 256 : 100, 128);
        if (i % 3 == 0)
            draw_map(&given, i % 2);
        else
            fill(&given, i * i * 90, TRANSLUCENT, &seed);
        const uint8_t *bytes = NULL;
        size_t size = 0;
        if (j->fresh || !encoder) {
            camber_encoder_destroy(encoder);
            if (camber_encoder_create(context, &desc, &encoder) != CAMBER_OK)
                return user;
        }
        if (encode(encoder, &given, &bytes, &size) != CAMBER_OK)
            return user;
        j->hashes[i] = camber_hash(CAMBER_HASH_START, bytes, size);
        free(given.rgba);
    }
    camber_encoder_destroy(encoder);
    camber_context_destroy(context);
    return NULL;
}

static void test_same_bytes(void **state) {
    (void)state;
    for (int encoding = CAMBER_ENCODING_PNG; encoding <= CAMBER_ENCODING_WEBP; encoding++) {
        if (!camber_encoding_is_built((camber_encoding)encoding))
            continue;
        job jobs[4] = {{.encoding = (camber_encoding)encoding}};
        pthread_t threads[4];
        for (size_t i = 0; i < 4; i++) {
            jobs[i] = (job){.encoding = (camber_encoding)encoding, .fresh = i % 2, .held = (uint8_t)(4 * i)};
            assert_int_equal(pthread_create(&threads[i], NULL, encode_tiles, &jobs[i]), 0);
        }
        for (size_t i = 0; i < 4; i++) {
            void *failed;
            assert_int_equal(pthread_join(threads[i], &failed), 0);
            assert_null(failed);
            assert_memory_equal(jobs[i].hashes, jobs[0].hashes, sizeof jobs[0].hashes);
        }
    }
}

/* ---- Where the state lies ---- */

enum { ADDRESSES = 512, ADDRESS_STEP = 1 << 16, WINDOW = 1 << 15, WINDOWS = 384 };

/* Gives large blocks other addresses each time; one is there at once. */
static char places[(ADDRESSES + 16) * ADDRESS_STEP];

static void *allocate_elsewhere(void *user, void *block, size_t size) {
    size_t *next = user;
    const bool placed = (char *)block >= places && (char *)block < places + sizeof places;
    if (size >= ADDRESS_STEP)
        return places + (size_t)ADDRESS_STEP * (++*next % ADDRESSES);
    if (size == 0 && placed)
        return NULL;
    return size ? realloc(block, size) : (free(block), NULL);
}

/* A flat ground in which a place that igzip does not note, at the beginning of each of its windows, comes again: where
 * it notes nothing else instead, it finds it all the same. */
static uint8_t *make_unnoted(size_t *size) {
    uint64_t seed = 77;
    uint8_t *made = calloc(WINDOWS + 1, WINDOW);
    assert_non_null(made);
    for (size_t window = 1; window <= WINDOWS; window++) {
        uint8_t *at = made + window * WINDOW;
        for (size_t i = 0; i < 24; i++) {
            at[(ptrdiff_t)i - 200] = (uint8_t)(camber_random_bits(&seed) % 255 + 1);
            at[(ptrdiff_t)i - 23] = at[(ptrdiff_t)i - 200]; /* up to at[0]: a match */
            at[i + 1] = (uint8_t)(camber_random_bits(&seed) % 255 + 1);
        }
        memcpy(at + 500, at, 16);
    }
    *size = (size_t)(WINDOWS + 1) * WINDOW;
    return made;
}

/* ISA-L looks at its state's address, which must make no difference. */
static void test_same_bytes_everywhere(void **state) {
    (void)state;
    size_t next = 0, size, first_size = 0;
    const camber_context_desc desc = {.reallocate = allocate_elsewhere, .allocator_user = &next, .cache_dir = ""};
    camber_context *context = NULL;
    uint8_t *given = make_unnoted(&size), *packed = malloc(2 * size), *first = malloc(2 * size);
    assert_non_null(packed);
    assert_non_null(first);
    assert_int_equal(camber_context_create(&desc, &context), CAMBER_OK);
    for (size_t i = 0; i < ADDRESSES; i++) {
        camber_deflater *deflater = NULL;
        assert_int_equal(camber_deflater_create(context, 1, &deflater), CAMBER_OK);
        assert_true(camber_deflater_bound(deflater, size) <= 2 * size);
        const size_t packed_size = camber_deflater_compress(deflater, given, size, packed);
        camber_deflater_destroy(deflater);
        if (i == 0) {
            memcpy(first, packed, packed_size);
            first_size = packed_size;
        }
        assert_int_equal(packed_size, first_size);
        assert_memory_equal(packed, first, first_size);
    }
    camber_context_destroy(context);
    free(given);
    free(packed);
    free(first);
}

/* ---- Memory ---- */

static void test_tiles_allocate_once(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    for (int encoding = CAMBER_ENCODING_PNG; encoding <= CAMBER_ENCODING_PNG8; encoding++) {
        camber_encoder *encoder = make_encoder(context, (camber_encoding)encoding, 0);
        picture given = picture_make(256, 256);
        const uint8_t *bytes;
        size_t size, calls = 0;
        draw_map(&given, false);
        for (int run = 0; run < 10; run++) {
            assert_int_equal(encode(encoder, &given, &bytes, &size), CAMBER_OK);
            if (run > 0)
                assert_int_equal(h.calls, calls);
            calls = h.calls;
        }
        free(given.rgba);
        camber_encoder_destroy(encoder);
    }
    host_done(&h, context);
}

typedef struct trial {
    camber_encoder_desc desc;
    picture given;
} trial;

static camber_status try_encoding(camber_context *context, void *user) {
    const trial *t = user;
    camber_encoder *const untouched = user;
    camber_encoder *encoder = untouched;
    camber_status status = camber_encoder_create(context, &t->desc, &encoder);
    if (status != CAMBER_OK) {
        assert_ptr_equal(encoder, untouched);
        return status;
    }
    const uint8_t *bytes = NULL;
    size_t size = 7;
    status = encode(encoder, &t->given, &bytes, &size);
    if (status == CAMBER_OK)
        assert_non_null(bytes);
    else
        assert_true(!bytes && size == 7);
    camber_encoder_destroy(encoder);
    return status;
}

static void test_allocations_fail(void **state) {
    (void)state;
    static const camber_png_text texts[] = {{"Software", "camber"}, {"Copyright", "nobody"}};
    host h;
    camber_context *context = host_context(&h);
    uint64_t seed = 41;
    for (int encoding = CAMBER_ENCODING_PNG; encoding <= CAMBER_ENCODING_WEBP; encoding++)
        for (size_t colors = 20; colors < 1000; colors *= 20) {
            trial t = {{.encoding = (camber_encoding)encoding, .texts = texts, .text_count = 2}, picture_make(40, 50)};
            fill(&t.given, colors, TRANSLUCENT, &seed);
            if (camber_encoding_is_built(t.desc.encoding))
                each_allocation_fails(&h, try_encoding, context, &t);
            free(t.given.rgba);
        }
    host_done(&h, context);
}

/* Libraries allocate by themselves. */
static bool library_fails;

#ifdef CAMBER_LIBDEFLATE
struct libdeflate_compressor *__real_libdeflate_alloc_compressor(int level);
struct libdeflate_compressor *__wrap_libdeflate_alloc_compressor(int level);
struct libdeflate_compressor *__wrap_libdeflate_alloc_compressor(int level) {
    return library_fails ? NULL : __real_libdeflate_alloc_compressor(level);
}
#endif
#ifdef CAMBER_WEBP
int __real_WebPPictureImportRGBA(WebPPicture *made, const uint8_t *rgba, int stride);
int __wrap_WebPPictureImportRGBA(WebPPicture *made, const uint8_t *rgba, int stride);
int __wrap_WebPPictureImportRGBA(WebPPicture *made, const uint8_t *rgba, int stride) {
    return !library_fails && __real_WebPPictureImportRGBA(made, rgba, stride);
}
#endif

static void test_libraries_fail(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    for (int encoding = CAMBER_ENCODING_PNG; encoding <= CAMBER_ENCODING_WEBP; encoding++) {
#ifndef CAMBER_LIBDEFLATE
        if (encoding != CAMBER_ENCODING_WEBP)
            continue; /* zlib allocates by the context */
#endif
        trial t = {{.encoding = (camber_encoding)encoding, .compression = 6}, picture_make(4, 5)};
        library_fails = true;
        if (camber_encoding_is_built(t.desc.encoding)) {
            assert_int_equal(try_encoding(context, &t), CAMBER_ERROR_MEMORY);
            assert_story(&h, "out of memory");
        }
        library_fails = false;
        free(t.given.rgba);
    }
    host_done(&h, context);
}

/* ---- Arguments ---- */

static void test_arguments(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const camber_png_text no_key = {"", "text"};
    const camber_encoder_desc bad[] = {{.compression = -1},
                                       {.compression = 10},
                                       {.quality = -1},
                                       {.quality = 101},
                                       {.texts = &no_key, .text_count = 1}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        camber_encoder *encoder = NULL;
        assert_int_equal(camber_encoder_create(context, &bad[i], &encoder), CAMBER_ERROR_ARGUMENT);
        assert_story(&h, "; ");
        assert_null(encoder);
    }
    static const uint32_t sizes[][2] = {{0, 1}, {1, 0}, {65536, 1}, {1, 65536}, {16385, 16384}};
    camber_encoder *encoder = make_encoder(context, CAMBER_ENCODING_PNG8, 0);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const camber_pixels pixels = {NULL, sizes[i][0], sizes[i][1], 0};
        const uint8_t *bytes;
        size_t size;
        assert_int_equal(camber_encoder_encode(encoder, &pixels, &bytes, &size), CAMBER_ERROR_ARGUMENT);
        assert_story(&h, "; ");
    }
    camber_encoder_destroy(encoder);
    host_done(&h, context);
}

/* ---- WebP ---- */

#ifdef CAMBER_WEBP

static uint8_t *read_webp(const uint8_t *bytes, size_t size, const picture *given) {
    int width, height;
    uint8_t *read = WebPDecodeRGBA(bytes, size, &width, &height);
    assert_non_null(read);
    assert_int_equal(width, given->width);
    assert_int_equal(height, given->height);
    uint8_t *rgba = malloc(4 * (size_t)width * (size_t)height);
    assert_non_null(rgba);
    memcpy(rgba, read, 4 * (size_t)width * (size_t)height);
    WebPFree(read);
    return rgba;
}

static void test_webp(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    size_t sizes[2];
    for (int lossless = 0; lossless < 2; lossless++) {
        camber_encoder *encoder = make_encoder(context, CAMBER_ENCODING_WEBP, lossless ? 100 : 0);
        for (int transparent = 0; transparent < 2; transparent++) {
            picture given = picture_make(256, 200);
            draw_map(&given, transparent);
            const uint8_t *bytes;
            assert_int_equal(encode(encoder, &given, &bytes, &sizes[lossless]), CAMBER_OK);
            uint8_t *back = read_webp(bytes, sizes[lossless], &given);
            if (lossless)
                assert_same(back, &given);
            else
                assert_true(compare(back, &given).mean < 8);
            free(back);
            free(given.rgba);
        }
        camber_encoder_destroy(encoder);
    }
    assert_true(sizes[0] < sizes[1]);
    host_done(&h, context);
}

static void test_webp_bounds(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    camber_encoder *encoder = make_encoder(context, CAMBER_ENCODING_WEBP, 0);
    const uint8_t *bytes;
    size_t size;
    for (int across = 0; across < 2; across++)
        for (uint32_t side = 16383; side <= 16384; side++) {
            picture given = picture_make(across ? side : 1, across ? 1 : side);
            const camber_status status = encode(encoder, &given, &bytes, &size);
            assert_int_equal(status, side == 16383 ? CAMBER_OK : CAMBER_ERROR_ARGUMENT);
            if (status != CAMBER_OK)
                assert_story(&h, "16383");
            free(given.rgba);
        }
    camber_encoder_destroy(encoder);
    host_done(&h, context);
}

#else

static void test_webp(void **state) {
    (void)state;
    host h;
    camber_context *context = host_context(&h);
    const camber_encoder_desc desc = {.encoding = CAMBER_ENCODING_WEBP};
    camber_encoder *encoder = NULL;
    assert_int_equal(camber_encoder_create(context, &desc, &encoder), CAMBER_ERROR_ARGUMENT);
    assert_story(&h, "; build camber with libwebp");
    host_done(&h, context);
}

static void test_webp_bounds(void **state) {
    (void)state;
    assert_int_equal(camber_encoding_get_longest_side(CAMBER_ENCODING_WEBP), 16383);
}

#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_one_color_is_tiny),
        cmocka_unit_test(test_map_as_png8),
        cmocka_unit_test(test_map_of_two_colors),
        cmocka_unit_test(test_flat_colors_stay),
        cmocka_unit_test(test_many_colors),
        cmocka_unit_test(test_random),
        cmocka_unit_test(test_pixels_are_everywhere_the_same),
        cmocka_unit_test(test_same_bytes),
        cmocka_unit_test(test_same_bytes_everywhere),
        cmocka_unit_test(test_tiles_allocate_once),
        cmocka_unit_test(test_allocations_fail),
        cmocka_unit_test(test_libraries_fail),
        cmocka_unit_test(test_arguments),
        cmocka_unit_test(test_webp),
        cmocka_unit_test(test_webp_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
