/* Tiles of 256 px, cut from pictures that the tool draws, as files of each encoding; beside them libpng as it comes and
 * libpng with zlib's level 1 and no filter. */
#define _XOPEN_SOURCE 700 /* mkdtemp */

#include "bench.h"

#include "base/base.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TILE_PX = 256, ACROSS = BENCH_SIDE_PX / TILE_PX, TILES = ACROSS * ACROSS };

typedef enum way {
    WAY_LIBPNG,
    WAY_LIBPNG_FAST,
    WAY_PNG,
    WAY_PNG8,
    WAY_WEBP,
    WAY_LOSSLESS,
    WAYS,
} way;

static const struct {
    const char *key, *name;
    camber_encoder_desc desc;
} ways[WAYS] = {
    [WAY_LIBPNG] = {"libpng", "libpng", {.encoding = CAMBER_ENCODING_PNG}},
    [WAY_LIBPNG_FAST] = {"libpng_1", "libpng, zlib 1, no filter", {.encoding = CAMBER_ENCODING_PNG}},
    [WAY_PNG] = {"png", "png", {.encoding = CAMBER_ENCODING_PNG, .opaque = true}},
    [WAY_PNG8] = {"png8", "png8", {.encoding = CAMBER_ENCODING_PNG8, .opaque = true}},
    [WAY_WEBP] = {"webp", "webp", {.encoding = CAMBER_ENCODING_WEBP, .opaque = true}},
    [WAY_LOSSLESS] = {"webp_100", "webp, lossless", {.encoding = CAMBER_ENCODING_WEBP, .opaque = true, .quality = 100}},
};

/* A city's map, drawn by the tool: all of it, or what the camera says. */
static const struct {
    const char *key, *name, *city, *center, *zoom;
} pictures[] = {
    {"santa_cruz", "Santa Cruz", "santa_cruz", NULL, NULL},
    {"porto", "Porto", "porto", NULL, NULL},
    {"porto_15", "Porto, zoom 15", "porto", "-8.611,41.148", "15"},
};

typedef struct tile_sum {
    size_t bytes, palettes;
} tile_sum;

/* ---- Pictures ---- */

/* Straight RGBA, which is premultiplied as well: the style's ground is opaque. */
static bool read_picture(const char *path, uint8_t *rgba) {
    png_image image = {.version = PNG_IMAGE_VERSION};
    bool read =
        png_image_begin_read_from_file(&image, path) && image.width == BENCH_SIDE_PX && image.height == BENCH_SIDE_PX;
    image.format = PNG_FORMAT_RGBA;
    read = read && png_image_finish_read(&image, NULL, rgba, 0, NULL);
    png_image_free(&image);
    return read;
}

static bool draw_picture(const bench *b, size_t at, uint8_t *rgba) {
    char folder[] = "/tmp/camber_bench.XXXXXX", path[64], city[1024];
    if (!bench_scene_path(b, pictures[at].city, city, sizeof city) || !mkdtemp(folder))
        return false;
    snprintf(path, sizeof path, "%s/map.png", folder);
    const char *const arguments[] = {b->tool,
                                     "render",
                                     "-q",
                                     city,
                                     "-o",
                                     path,
                                     "--size",
                                     "2048x2048",
                                     pictures[at].center ? "--center" : NULL,
                                     pictures[at].center,
                                     "--zoom",
                                     pictures[at].zoom,
                                     NULL};
    bench_child child = bench_child_run(arguments, NULL, NULL);
    free(child.output);
    const bool drawn = child.status == 0 && read_picture(path, rgba);
    remove(path);
    rmdir(folder);
    return drawn;
}

static camber_pixels tile_of(const uint8_t *rgba, size_t tile) {
    const size_t x = tile % ACROSS, y = tile / ACROSS, stride = 4 * (size_t)BENCH_SIDE_PX;
    return (camber_pixels){rgba + stride * TILE_PX * y + 4 * TILE_PX * x, TILE_PX, TILE_PX, stride};
}

/* ---- Encoding ---- */

static void count_bytes(png_structp png, png_bytep bytes, size_t size_bytes) {
    (void)bytes;
    *(size_t *)png_get_io_ptr(png) += size_bytes;
}

static void flush_nothing(png_structp png) {
    (void)png;
}

static void encode_by_libpng(const camber_pixels *pixels, bool fast, tile_sum *t) {
    static uint8_t row[3 * TILE_PX];
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &t->bytes, count_bytes, flush_nothing);
    png_set_IHDR(png, info, TILE_PX, TILE_PX, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE,
                 PNG_FILTER_TYPE_BASE);
    if (fast) {
        png_set_compression_level(png, 1);
        png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    }
    png_write_info(png, info);
    for (size_t y = 0; y < TILE_PX; y++) {
        for (size_t x = 0; x < TILE_PX; x++)
            memcpy(row + 3 * x, pixels->rgba + pixels->stride_bytes * y + 4 * x, 3);
        png_write_row(png, row);
    }
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
}

static bool encode_tiles(const uint8_t *rgba, way by, camber_encoder *encoder, tile_sum *t) {
    *t = (tile_sum){0};
    for (size_t tile = 0; tile < TILES; tile++) {
        const camber_pixels pixels = tile_of(rgba, tile);
        const uint8_t *bytes = NULL;
        size_t size_bytes = 0;
        if (by <= WAY_LIBPNG_FAST) {
            encode_by_libpng(&pixels, by == WAY_LIBPNG_FAST, t);
            continue;
        }
        if (camber_encoder_encode(encoder, &pixels, &bytes, &size_bytes) != CAMBER_OK)
            return false;
        t->bytes += size_bytes;
        t->palettes += by <= WAY_PNG8 && bytes[25] == PNG_COLOR_TYPE_PALETTE;
    }
    return true;
}

/* By how many of 255 levels a channel of png8 is off: the mean, and the most. */
static void measure_error(bench *b, const uint8_t *rgba, json_t *row) {
    camber_encoder *encoder = NULL;
    uint8_t *read = malloc(4 * TILE_PX * TILE_PX);
    double sum = 0;
    int most = 0;
    bool known = read && camber_encoder_create(b->context, &ways[WAY_PNG8].desc, &encoder) == CAMBER_OK;
    for (size_t tile = 0; tile < TILES && known; tile++) {
        const camber_pixels pixels = tile_of(rgba, tile);
        const uint8_t *bytes = NULL;
        size_t size_bytes = 0;
        png_image image = {.version = PNG_IMAGE_VERSION};
        known = camber_encoder_encode(encoder, &pixels, &bytes, &size_bytes) == CAMBER_OK &&
                png_image_begin_read_from_memory(&image, bytes, size_bytes);
        image.format = PNG_FORMAT_RGBA;
        known = known && png_image_finish_read(&image, NULL, read, 0, NULL);
        for (size_t i = 0; i < 4 * TILE_PX * TILE_PX && known; i++) {
            const int apart = abs(read[i] - pixels.rgba[pixels.stride_bytes * (i / (4 * TILE_PX)) + i % (4 * TILE_PX)]);
            sum += i % 4 < 3 ? apart : 0;
            most = apart > most ? apart : most;
        }
    }
    if (known) {
        json_object_set_new(row, "png8_mean_error", json_real(sum / (3.0 * TILES * TILE_PX * TILE_PX)));
        json_object_set_new(row, "png8_most_error", json_integer(most));
    }
    free(read);
    camber_encoder_destroy(encoder);
}

/* ---- The section ---- */

static void add_way(way by, double ms, const tile_sum *t, json_t *row) {
    char key[64];
    snprintf(key, sizeof key, "%s_ms", ways[by].key);
    json_object_set_new(row, key, bench_ms(ms / TILES));
    snprintf(key, sizeof key, "%s_bytes", ways[by].key);
    json_object_set_new(row, key, json_integer((json_int_t)(t->bytes / TILES)));
    if (by == WAY_PNG)
        json_object_set_new(row, "palettes", json_integer((json_int_t)t->palettes));
}

static bool measure_picture(bench *b, size_t at, json_t *result) {
    camber_encoder *encoders[WAYS] = {0};
    bench_series series[WAYS] = {{.count = 0}};
    tile_sum tallies[WAYS] = {{0}};
    const uint8_t *rgba = b->picture;
    bool done = true;
    for (int by = WAY_PNG; by < WAYS && done; by++)
        if (camber_encoding_is_built(ways[by].desc.encoding))
            done = camber_encoder_create(b->context, &ways[by].desc, &encoders[by]) == CAMBER_OK;
    for (size_t run = 0; run < b->runs + 1 && done; run++)
        for (int by = 0; by < WAYS && done; by++) {
            if (by >= WAY_PNG && !encoders[by])
                continue;
            const double begin = camber_now_ms();
            done = encode_tiles(rgba, (way)by, encoders[by], &tallies[by]);
            if (run > 0)
                bench_series_add(&series[by], camber_now_ms() - begin);
        }
    json_t *row = json_pack("{s:s, s:s}", "key", pictures[at].key, "scene", pictures[at].name);
    const double fast_ms = bench_series_median(&series[WAY_LIBPNG_FAST]);
    for (int by = 0; by < WAYS && done; by++) {
        const double ms = bench_series_median(&series[by]);
        if (ms <= 0)
            continue;
        add_way((way)by, ms, &tallies[by], row);
        if (by < WAY_PNG)
            continue;
        bench_result_add_figure(
            result, &(bench_figure){pictures[at].key, ways[by].name, ways[WAY_LIBPNG_FAST].name, fast_ms / ms, false});
        bench_result_add_figure(
            result, &(bench_figure){pictures[at].key, ways[by].name, NULL, (double)(tallies[by].bytes / TILES), true});
    }
    if (done)
        measure_error(b, rgba, row);
    bench_result_add_row(result, row);
    for (int by = 0; by < WAYS; by++)
        camber_encoder_destroy(encoders[by]);
    return done;
}

static json_t *measure(bench *b, const char *only) {
    json_t *result = bench_result_new();
    for (size_t i = 0; i < (b->size == BENCH_TINY ? 1 : sizeof pictures / sizeof *pictures); i++)
        if ((!only || strcmp(only, pictures[i].key) == 0) && draw_picture(b, i, b->picture) &&
            !measure_picture(b, i, result)) {
            json_decref(result);
            return NULL;
        }
    return result;
}

static void print(const json_t *result, FILE *to) {
    const json_t *row;
    size_t i;
    fprintf(to, "\nEncoding: a tile of %d px, of one thread\n", TILE_PX);
    json_array_foreach(bench_result_rows(result), i, row) {
        fprintf(to, "  %s: %.0f of %d tiles have 256 colours or fewer; png8 is off by %.2f of 255, at most %.0f\n",
                bench_text(row, "scene"), bench_number(row, "palettes"), TILES, bench_number(row, "png8_mean_error"),
                bench_number(row, "png8_most_error"));
        for (int by = 0; by < WAYS; by++) {
            char ms[64], bytes[64];
            snprintf(ms, sizeof ms, "%s_ms", ways[by].key);
            snprintf(bytes, sizeof bytes, "%s_bytes", ways[by].key);
            if (bench_number(row, ms) > 0)
                fprintf(to, "    %-28s%8.3f ms %8.0f bytes\n", ways[by].name, bench_number(row, ms),
                        bench_number(row, bytes));
        }
    }
}

const bench_section bench_section_encode = {"encode", measure, print};
