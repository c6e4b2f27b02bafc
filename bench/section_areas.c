/* Areas alone: whole frames of one colour, every area of a scene as one path, by kernels, and the same rings filled by
 * every peer, in turn in one run. Each picture is held against 16 x 16 samples of every pixel. */
#include "bench.h"

#include "base/base.h"

#include "validate/oracle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PIXELS = BENCH_SIDE_PX * BENCH_SIDE_PX };

typedef struct trial {
    bench *b;
    const bench_scene *scene;
    float *truth; /* what is inside, of each pixel */
    bench_series frame, tessellate;
    double error;
    bench_peers_trial peers;
} trial;

/* Mean, 255ths, over the pixels that are not white in both. */
static double error_of(const float *truth, const uint8_t *rgba) {
    double sum = 0;
    size_t drawn = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        const double white = 255.0 * (1.0 - (double)truth[i]);
        if (white >= 255 && rgba[4 * i] == 255)
            continue;
        sum += fabs(white - rgba[4 * i]);
        drawn++;
    }
    return drawn ? sum / (double)drawn : 0;
}

static camber_status draw_ours(trial *t, bool counts) {
    const bench_frame_desc desc = {.areas = t->scene, .in_cl = true, .picture = t->b->picture};
    bench_frame_times times = {0};
    const camber_status status = bench_frame(t->b, &desc, &times);
    if (status != CAMBER_OK)
        return status;
    if (counts) {
        bench_series_add(&t->frame, times.frame_ms);
        bench_series_add(&t->tessellate, times.tessellate_ms);
    } else {
        t->error = error_of(t->truth, t->b->picture);
    }
    return CAMBER_OK;
}

static double peer_error(const bench *b, const void *truth) {
    return error_of(truth, b->pictured);
}

static void report(const trial *t, json_t *result) {
    const double frame_ms = bench_series_median(&t->frame);
    json_t *peers = bench_peers_report(&t->peers, t->scene, "error");
    json_t *row = json_pack("{s:s, s:s, s:I, s:I, s:f, s:o, s:o, s:o}", "key", t->scene->key, "scene", t->scene->name,
                            "areas", (json_int_t)t->scene->area_count, "edges", (json_int_t)t->scene->segments, "error",
                            t->error, "cl_frame_ms", bench_ms(frame_ms), "tessellate_ms",
                            bench_ms(bench_series_median(&t->tessellate)), "peers", peers);
    for (size_t i = 0; i < bench_peer_count; i++)
        if (!strchr(bench_peers[i]->key, '_'))
            bench_result_add_figure(result,
                                    &(bench_figure){t->scene->key, "areas in OpenCL", bench_peers[i]->name,
                                                    bench_best_peer(peers, bench_peers[i]->key) / frame_ms, false});
    bench_result_add_row(result, row);
}

static camber_status measure_scene(bench *b, const bench_scene *scene, json_t *result) {
    trial t = {.b = b, .scene = scene, .truth = malloc(PIXELS * sizeof *t.truth)};
    camber_status status =
        t.truth && camber_oracle_fill(&scene->lines, CAMBER_ORACLE_NONZERO, BENCH_SIDE_PX, BENCH_SIDE_PX, t.truth)
            ? CAMBER_OK
            : CAMBER_ERROR_MEMORY;
    const double begin_ms = camber_now_ms();
    /* In turn, so that a machine whose speed drifts is fair to all. */
    for (size_t run = 0; bench_goes_on(b, run, begin_ms) && status == CAMBER_OK; run++) {
        status = draw_ours(&t, run >= b->warm_ups);
        bench_peers_draw(b, &t.peers, scene, run >= b->warm_ups, peer_error, t.truth);
    }
    free(t.truth);
    if (status == CAMBER_OK)
        report(&t, result);
    return status;
}

static json_t *measure(bench *b, const char *only) {
    bench_scene scenes[BENCH_SCENES_MAX];
    const size_t count = bench_areas_make(b, only, scenes);
    json_t *result = bench_result_new();
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < count && status == CAMBER_OK; i++)
        status = measure_scene(b, scenes + i, result);
    bench_areas_free(scenes, count);
    if (status == CAMBER_OK)
        return result;
    json_decref(result);
    return NULL;
}

static void print_peers(const json_t *row, double ours_ms, FILE *to) {
    const char *key;
    json_t *peer;
    json_object_foreach(json_object_get(row, "peers"), key, peer) {
        const double ms = bench_number(peer, "ms");
        fprintf(to, "    %-22s %8.1f ms %6.2f times %8.3f\n", key, ms, ours_ms > 0 ? ms / ours_ms : 0,
                bench_number(peer, "error"));
    }
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to,
            "Areas in OpenCL, %d x %d px, black on white, from rings in memory to pixels in memory: ms, how many times "
            "camber's\nframe fits into a peer's, and the mean error beside 16 x 16 samples, of 255.\n\n",
            BENCH_SIDE_PX, BENCH_SIDE_PX);
    json_array_foreach(bench_result_rows(result), i, row) {
        const double ms = bench_number(row, "cl_frame_ms");
        fprintf(to, "%s: %.0f areas, %.0f edges\n    %-22s %8.1f ms %12s %8.3f (tessellate %.1f)\n",
                bench_text(row, "scene"), bench_number(row, "areas"), bench_number(row, "edges"), "camber", ms, "",
                bench_number(row, "error"), bench_number(row, "tessellate_ms"));
        print_peers(row, ms, to);
    }
}

const bench_section bench_section_areas = {"areas", measure, print};
