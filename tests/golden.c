#include "golden.h"

#include "proof/truth.h"

#include <png.h>

/* Another Mesa or LLVM may round the last bits of coverage another way: one level anywhere; up to three, on a
 * thousandth of the pixels. */
enum { LEVELS_ANYWHERE = 1, LEVELS_AT_MOST = 3, PIXELS_A_MISS = 1000 };

static void path_of(char path[1024], const char *folder, const char *name, const char *ending) {
    snprintf(path, 1024, "%s/%s%s", folder, name, ending);
}

/* ---- Files ---- */

/* Grey where it has no colours, and unfiltered: what these pictures come out smallest with. */
static long write_png(const char *path, const picture *drawn) {
    const size_t pixels = (size_t)drawn->width * drawn->height;
    bool grey = true;
    for (size_t i = 0; i < pixels; i++) {
        const uint8_t *p = drawn->rgba + 4 * i;
        grey = grey && p[0] == p[1] && p[1] == p[2];
        assert_int_equal(p[3], 255);
    }
    FILE *file = fopen(path, "wb");
    if (!file)
        fail_msg("%s cannot be written", path);
    /* Without a jump buffer libpng aborts where it fails. */
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    const size_t channels = grey ? 1 : 3;
    uint8_t *row = malloc(channels * drawn->width);
    assert_non_null(row);
    png_init_io(png, file);
    png_set_compression_level(png, 9);
    png_set_filter(png, 0, PNG_FILTER_NONE);
    png_set_IHDR(png, info, drawn->width, drawn->height, 8, grey ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (uint32_t y = 0; y < drawn->height; y++) {
        for (uint32_t x = 0; x < drawn->width; x++)
            memcpy(row + channels * x, picture_at(drawn, x, y), channels);
        png_write_row(png, row);
    }
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    free(row);
    const long size_bytes = ftell(file);
    assert_int_equal(fclose(file), 0);
    return size_bytes;
}

static bool read_png(const char *path, picture *read) {
    png_image image = {.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_file(&image, path))
        return false;
    image.format = PNG_FORMAT_RGBA;
    *read = (picture){.width = image.width, .height = image.height, .rgba = malloc(PNG_IMAGE_SIZE(image))};
    assert_non_null(read->rgba);
    if (png_image_finish_read(&image, NULL, read->rgba, 0, NULL))
        return true;
    picture_free(read);
    return false;
}

/* ---- Against the file ---- */

static int pixel_apart(const picture *a, const picture *b, size_t i) {
    int most = 0;
    for (int c = 0; c < 4; c++) {
        const int apart = abs(a->rgba[4 * i + (size_t)c] - b->rgba[4 * i + (size_t)c]);
        most = apart > most ? apart : most;
    }
    return most;
}

/* Black where nothing differs; a level off is seen already. */
static void write_difference(const char *path, const picture *a, const picture *b) {
    picture d = {.width = a->width, .height = a->height, .rgba = malloc(4 * (size_t)a->width * a->height)};
    assert_non_null(d.rgba);
    for (size_t i = 0; i < (size_t)a->width * a->height; i++) {
        const int apart = pixel_apart(a, b, i), level = apart ? 64 + 6 * apart : 0;
        memset(d.rgba + 4 * i, level > 255 ? 255 : level, 3);
        d.rgba[4 * i + 3] = 255;
    }
    write_png(path, &d);
    picture_free(&d);
}

/* OpenCL rounds once where GL rounds at every line, draws kites and fans as it draws strips, and gives single pixels on
 * the bisector of a sharp join to the other segment. */
static bool is_close_in_cl(const char *name, const picture *drawn, const picture *expected) {
    static const double MEAN_MAX = 0.2;
    const difference d = picture_compare(drawn, expected);
    printf("# %-40s off GL's by %.4f of 255 on average, %d at most, %zu pixels past 8\n", name, d.mean, d.most,
           d.past_8);
    return d.mean < MEAN_MAX && d.past_8 <= d.drawn / PIXELS_A_MISS;
}

static bool is_close(const char *name, const picture *drawn, const picture *expected) {
    if (drawn->width != expected->width || drawn->height != expected->height) {
        printf("%s: %u x %u px, not %u x %u\n", name, drawn->width, drawn->height, expected->width, expected->height);
        return false;
    }
    if (draws_in_cl())
        return is_close_in_cl(name, drawn, expected);
    const size_t pixels = (size_t)drawn->width * drawn->height;
    size_t off = 0;
    int most = 0;
    for (size_t i = 0; i < pixels; i++) {
        const int apart = pixel_apart(drawn, expected, i);
        off += apart > LEVELS_ANYWHERE;
        most = apart > most ? apart : most;
    }
    if (most <= LEVELS_AT_MOST && off <= pixels / PIXELS_A_MISS)
        return true;
    printf("%s: %zu pixels differ by more than %d (at most %zu may), by up to %d (at most %d)\n", name, off,
           LEVELS_ANYWHERE, pixels / PIXELS_A_MISS, most, LEVELS_AT_MOST);
    return false;
}

static bool renew(const char *name, const char *path, const picture *drawn) {
    picture before;
    const bool was_there = read_png(path, &before);
    const bool same = was_there && before.width == drawn->width && before.height == drawn->height &&
                      picture_compare(drawn, &before).most == 0;
    if (was_there)
        picture_free(&before);
    if (same)
        return true;
    const long size_bytes = write_png(path, drawn);
    printf("%s: renewed, %ld bytes\n", name, size_bytes);
    if (size_bytes > GOLDEN_BYTES_MAX)
        printf("%s: more than %d bytes; show less\n", name, GOLDEN_BYTES_MAX);
    return size_bytes <= GOLDEN_BYTES_MAX;
}

bool golden_judge(const char *name, const picture *drawn) {
    const char *wish = getenv("CAMBER_GOLDEN");
    char path[1024], actual[1024], apart[1024];
    path_of(path, CAMBER_GOLDEN_FOLDER, name, ".png");
    path_of(actual, CAMBER_GOLDEN_OUT, name, ".actual.png");
    path_of(apart, CAMBER_GOLDEN_OUT, name, ".difference.png");
    remove(actual);
    remove(apart);
    if (wish && strcmp(wish, "renew") == 0)
        return renew(name, path, drawn);
    picture expected = {0};
    const bool is_there = read_png(path, &expected);
    const bool close = is_there && is_close(name, drawn, &expected);
    if (!is_there)
        printf("%s: %s is not there or no PNG; ./dev golden makes it\n", name, path);
    if (!close) {
        write_png(actual, drawn);
        printf("%s: what was drawn is in %s\n", name, actual);
    }
    if (is_there && !close && drawn->width == expected.width && drawn->height == expected.height) {
        write_difference(apart, drawn, &expected);
        printf("%s: the difference is in %s\n", name, apart);
    }
    picture_free(&expected);
    return close;
}

/* ---- Scenes ---- */

size_t golden_row(golden *g, camber_stroke stroke) {
    assert_true(g->stroke_count < GOLDEN_ROWS);
    g->strokes[g->stroke_count] = stroke;
    g->paints[0][g->stroke_count] = (camber_paint){.width_px = stroke.width_px, .color = {0, 0, 0, 1}};
    return g->stroke_count++;
}

/* The picture is black on white: its darkness is coverage. */
static bool agrees_with_oracle(const golden *g, const picture *drawn) {
    const scene *s = &g->lines;
    const size_t pixels = (size_t)g->width * g->height;
    const camber_lines lines = {s->points, s->offsets, s->point_count, s->polyline_count};
    const camber_truth_desc desc = {&lines, s->rows, g->strokes, false, CAMBER_TRUTH_OVER};
    float *truth = malloc(pixels * sizeof *truth);
    uint8_t *ink = malloc(pixels);
    assert_true(truth && ink);
    assert_true(camber_truth_make(&desc, (camber_window){0, 0, (int)g->width, (int)g->height}, truth));
    for (size_t i = 0; i < pixels; i++)
        ink[i] = (uint8_t)(255 - drawn->rgba[4 * i]);
    const camber_difference d = camber_difference_of(truth, ink, pixels);
    const double mean = camber_difference_mean(&d);
    printf("# %-32s off the oracle by %.3f of 255 on average (bound %.3f), by %d at most at %zu, %zu\n", g->name, mean,
           g->oracle_mean, d.max, d.max_at % g->width, d.max_at / g->width);
    free(ink);
    free(truth);
    return d.touched > 0 && mean <= g->oracle_mean;
}

static picture draw(const studio *s, camber_renderer *renderer, const golden *g) {
    camber_polylines *polylines = scene_polylines(s->context, &g->lines);
    const camber_tessellation_desc desc = {g->strokes, g->stroke_count, g->method, 0, false};
    camber_mesh *mesh = NULL;
    camber_pass passes[GOLDEN_PASSES];
    assert_int_equal(camber_mesh_create(s->device, renderer, &mesh), CAMBER_OK);
    assert_int_equal(camber_tessellate(mesh, polylines, &desc), CAMBER_OK);
    for (size_t i = 0; i < g->pass_count; i++)
        passes[i] = (camber_pass){.mesh = mesh,
                                  .first_polyline = g->first_polyline[i],
                                  .polyline_count = g->polyline_count[i],
                                  .paints = g->paints[i],
                                  .paint_count = g->stroke_count,
                                  .overlap = g->overlap[i]};
    const camber_frame frame = {.width = g->width,
                                .height = g->height,
                                .background = g->background,
                                .passes = passes,
                                .pass_count = g->pass_count,
                                .coverage = g->coverage};
    picture drawn = picture_draw(renderer, &frame);
    camber_mesh_destroy(mesh);
    camber_polylines_destroy(polylines);
    return drawn;
}

bool golden_draw(const studio *s, golden *g) {
    bool good = true;
    for (int b = 0; b < BACKENDS && good; b++) {
        if (!s->renderer[b])
            continue;
        picture drawn = draw(s, s->renderer[b], g);
        good = (g->oracle_mean <= 0 || agrees_with_oracle(g, &drawn)) && golden_judge(g->name, &drawn);
        if (!good)
            printf("%s: not as it should be with %s\n", g->name, BACKEND_NAME[b]);
        picture_free(&drawn);
    }
    scene_free(&g->lines);
    return good;
}
