/* Small rings as text has them: a page of 21,316 rings of 40 edges, 12 px high, by kernels on one thread, beside
 * FreeType's smooth rasterizer, whose outlines are kept and lie where they are drawn, so that it only rasterizes.
 * Camber makes its mesh of the rings again in each frame, and a picture of four bytes a pixel; FreeType's has one. */
#include "bench.h"

#include "base/base.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifdef CAMBER_BENCH_FREETYPE

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

enum { PIXELS = BENCH_SIDE_PX * BENCH_SIDE_PX, MILLION = 1000000 };

typedef struct trial {
    bench b; /* with a device of one thread */
    camber_fixture opened;
    const bench_scene *scene;
    FT_Library library;
    FT_Outline *outlines;
    size_t outline_count;
    uint8_t *gray;
    bench_series ours, theirs;
} trial;

/* ---- FreeType ---- */

/* In 64ths of a pixel, y up. The last point of a ring is its first one, which an outline does not repeat. */
static bool make_outline(trial *t, size_t ring) {
    const camber_lines *lines = &t->scene->lines;
    const size_t first = lines->offsets[ring], count = lines->offsets[ring + 1] - first - 1;
    const uint16_t last = (uint16_t)(count - 1); /* FreeType 2.13.3 has no short here any more */
    FT_Outline *outline = t->outlines + ring;
    if (FT_Outline_New(t->library, (FT_UInt)count, 1, outline) != 0)
        return false;
    t->outline_count = ring + 1;
    for (size_t k = 0; k < count; k++) {
        const float *point = lines->points + 2 * (first + k);
        outline->points[k] = (FT_Vector){lroundf(point[0] * 64), lroundf((BENCH_SIDE_PX - point[1]) * 64)};
        outline->tags[k] = FT_CURVE_TAG_ON;
    }
    memcpy(outline->contours, &last, sizeof last);
    return true;
}

static bool make_outlines(trial *t) {
    t->gray = malloc(PIXELS);
    t->outlines = calloc(t->scene->lines.polyline_count, sizeof *t->outlines);
    bool done = t->gray && t->outlines && FT_Init_FreeType(&t->library) == 0;
    for (size_t i = 0; i < t->scene->lines.polyline_count && done; i++)
        done = make_outline(t, i);
    return done;
}

/* Gives the milliseconds; below 0: it fails. */
static double draw_freetype(trial *t) {
    const FT_Bitmap bitmap = {.rows = BENCH_SIDE_PX,
                              .width = BENCH_SIDE_PX,
                              .pitch = BENCH_SIDE_PX,
                              .buffer = t->gray,
                              .num_grays = 256,
                              .pixel_mode = FT_PIXEL_MODE_GRAY};
    const double begin = camber_now_ms();
    bool done = true;
    memset(t->gray, 0, PIXELS);
    for (size_t i = 0; i < t->outline_count && done; i++)
        done = FT_Outline_Get_Bitmap(t->library, t->outlines + i, &bitmap) == 0;
    return done ? camber_now_ms() - begin : -1;
}

/* Mean, of 255, over the pixels that either draws on. */
static double difference_of(const trial *t) {
    double sum = 0;
    size_t drawn = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        const int ours = 255 - t->b.picture[4 * i], theirs = t->gray[i];
        sum += abs(ours - theirs);
        drawn += ours > 0 || theirs > 0;
    }
    return drawn ? sum / (double)drawn : 0;
}

/* ---- The section ---- */

/* Fails on a device whose threads camber cannot choose, unless it has one. */
static camber_status open_one_thread(const bench *b, trial *t) {
    const camber_fixture_desc desc = {.device = {.match = "cpu", .threads = 1}, .drawers = CAMBER_FIXTURE_IN_OPENCL};
    t->b = *b;
    t->b.cl_mesh = NULL;
    camber_status status = camber_fixture_open(b->context, &desc, &t->opened);
    t->b.device = t->opened.device;
    t->b.cl_renderer = t->opened.renderer[CAMBER_FIXTURE_OPENCL];
    if (status == CAMBER_OK && camber_device_get_info(t->b.device).compute_units != 1) {
        fprintf(stderr, "camber_bench: glyphs are left out: this device has more than one thread\n");
        status = CAMBER_ERROR_DEVICE;
    }
    if (status == CAMBER_OK)
        status = camber_mesh_create(t->b.device, t->b.cl_renderer, &t->b.cl_mesh);
    return status;
}

static bool draw_both(trial *t, json_t *result) {
    const bench_frame_desc desc = {.areas = t->scene, .in_cl = true, .picture = t->b.picture};
    for (size_t run = 0; run < t->b.warm_ups + t->b.runs; run++) {
        bench_frame_times times = {0};
        if (bench_frame(&t->b, &desc, &times) != CAMBER_OK)
            return false;
        const double theirs = draw_freetype(t);
        if (theirs < 0)
            return false;
        if (run < t->b.warm_ups)
            continue;
        bench_series_add(&t->ours, times.frame_ms);
        bench_series_add(&t->theirs, theirs);
    }
    const double rings = (double)t->outline_count, ms = bench_series_median(&t->ours) * MILLION / rings,
                 theirs = bench_series_median(&t->theirs) * MILLION / rings;
    int version[3];
    char text[64];
    FT_Library_Version(t->library, version, version + 1, version + 2);
    snprintf(text, sizeof text, "%d.%d.%d", version[0], version[1], version[2]);
    bench_result_add_row(result, json_pack("{s:s, s:I, s:I, s:o, s:o, s:f, s:s}", "key", t->scene->key, "rings",
                                           (json_int_t)t->outline_count, "edges", (json_int_t)t->scene->segments,
                                           "million_ms", bench_ms(ms), "freetype_ms", bench_ms(theirs), "difference",
                                           difference_of(t), "version", text));
    bench_result_add_figure(result,
                            &(bench_figure){t->scene->key, "glyphs by one thread", "FreeType", theirs / ms, false});
    return true;
}

static void close_trial(trial *t) {
    for (size_t i = 0; i < t->outline_count; i++)
        FT_Outline_Done(t->library, t->outlines + i);
    if (t->library)
        FT_Done_FreeType(t->library);
    free(t->outlines);
    free(t->gray);
    camber_mesh_destroy(t->b.cl_mesh);
    camber_fixture_close(&t->opened);
}

static json_t *measure(bench *b, const char *only) {
    json_t *result = bench_result_new();
    bench_scene scenes[BENCH_SCENES_MAX];
    const size_t count = !only || strcmp(only, "glyphs") == 0 ? bench_areas_make(b, "glyphs", scenes) : 0;
    trial t = {.scene = scenes};
    bool done = true;
    if (count > 0 && open_one_thread(b, &t) == CAMBER_OK)
        done = make_outlines(&t) && draw_both(&t, result);
    if (count > 0)
        close_trial(&t);
    bench_areas_free(scenes, count);
    if (done)
        return result;
    json_decref(result);
    return NULL;
}

#else
#define measure NULL
#endif

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    json_array_foreach(bench_result_rows(result), i, row) {
        const double ms = bench_number(row, "million_ms"), theirs = bench_number(row, "freetype_ms");
        fprintf(
            to,
            "A million rings of 40 edges, 12 px high, in pages of %.0f, by one thread: %.0f ms, from rings to pixels; "
            "FreeType %s %.0f\nms, from outlines to coverage, %.2f times as long. Mean difference of the pictures, of "
            "255: %.2f.\n",
            bench_number(row, "rings"), ms, bench_text(row, "version"), theirs, theirs / ms,
            bench_number(row, "difference"));
    }
}

const bench_section bench_section_glyphs = {"glyphs", measure, print};
