/* A frame of every scene, and the same polylines drawn by every peer, in turn in one run. */
#include "bench.h"

#include "base/base.h"

#include <stdlib.h>
#include <string.h>

/* camber's own times: by GL and by kernels, with every point and with those that BENCH_SIMPLIFY_PX leaves. */
enum { DRAW, FRAME, SIMPLE_DRAW, SIMPLE_FRAME, UNITED_DRAW, CL_FRAME, CL_SIMPLE_FRAME, OURS };

static const struct {
    const char *key, *what, *heading;
} ours[OURS] = {
    [DRAW] = {"draw_ms", "draw", "draw"},
    [FRAME] = {"frame_ms", "frame", "frame"},
    [SIMPLE_DRAW] = {"simple_draw_ms", "draw at 0.1 px", "draw .1"},
    [SIMPLE_FRAME] = {"simple_frame_ms", "frame at 0.1 px", "frame .1"},
    [UNITED_DRAW] = {"united_draw_ms", "draw united at 0.1 px", "united"},
    [CL_FRAME] = {"cl_frame_ms", "frame in OpenCL", "cl"},
    [CL_SIMPLE_FRAME] = {"cl_simple_frame_ms", "frame in OpenCL at 0.1 px", "cl .1"},
};

typedef struct trial {
    bench *b;
    const bench_scene *scene;
    camber_network *network;
    bench_series ours[OURS];
    double cl_difference;
    bench_peers_trial peers;
} trial;

static double difference_of(const uint8_t *a, const uint8_t *b) {
    double sum = 0;
    size_t drawn = 0;
    for (size_t i = 0; i < 4 * (size_t)BENCH_SIDE_PX * BENCH_SIDE_PX; i += 4) {
        sum += abs(a[i] - b[i]);
        drawn += a[i] < 255 || b[i] < 255;
    }
    return drawn ? sum / (double)drawn : 0;
}

/* b->picture gets everything drawn by GL, which peers are held against. */
static camber_status draw_ours(trial *t, bool counts) {
    bench *b = t->b;
    bench_frame_times times = {0}, simple = {0}, united = {0}, covered = {0}, simply_covered = {0};
    bench_frame_desc desc = {.lines = &t->scene->lines, .width_px = t->scene->width_px, .picture = b->picture};
    camber_status status = bench_frame(b, &desc, &times);
    desc.in_cl = true;
    desc.picture = b->pictured;
    if (status == CAMBER_OK)
        status = bench_frame(b, &desc, &covered);
    t->cl_difference = status == CAMBER_OK ? difference_of(b->picture, b->pictured) : 0;
    desc.network = t->network;
    desc.camera = bench_camera(BENCH_SIMPLIFY_PX);
    if (status == CAMBER_OK)
        status = bench_frame(b, &desc, &simply_covered);
    desc.in_cl = false;
    if (status == CAMBER_OK)
        status = bench_frame(b, &desc, &simple);
    desc.overlap = CAMBER_OVERLAP_UNITE;
    if (status == CAMBER_OK)
        status = bench_frame(b, &desc, &united);
    const double ms[OURS] = {times.draw_ms,  times.frame_ms,   simple.draw_ms,         simple.frame_ms,
                             united.draw_ms, covered.frame_ms, simply_covered.frame_ms};
    for (int i = 0; i < OURS && status == CAMBER_OK && counts; i++)
        bench_series_add(t->ours + i, ms[i]);
    return status;
}

static double peer_difference(const bench *b, const void *user) {
    (void)user;
    return difference_of(b->picture, b->pictured);
}

static void add_figures(const trial *t, const json_t *peers, json_t *result) {
    for (size_t i = 0; i < bench_peer_count; i++) {
        const double peer_ms = strchr(bench_peers[i]->key, '_') ? 0 : bench_best_peer(peers, bench_peers[i]->key);
        for (int k = 0; k < OURS; k++)
            bench_result_add_figure(result, &(bench_figure){t->scene->key, ours[k].what, bench_peers[i]->name,
                                                            peer_ms / bench_series_median(t->ours + k), false});
    }
    for (int k = CL_FRAME; k <= CL_SIMPLE_FRAME; k++) {
        const bench_series *gl = t->ours + (k == CL_FRAME ? FRAME : SIMPLE_FRAME);
        bench_result_add_figure(result,
                                &(bench_figure){t->scene->key, ours[k].what, "GL",
                                                bench_series_median(gl) / bench_series_median(t->ours + k), false});
    }
}

static void report(const trial *t, json_t *result) {
    json_t *peers = bench_peers_report(&t->peers, t->scene, "difference");
    json_t *row = json_pack("{s:s, s:s, s:f, s:I, s:I, s:f}", "key", t->scene->key, "scene", t->scene->name, "width_px",
                            (double)t->scene->width_px, "polylines", (json_int_t)t->scene->lines.polyline_count,
                            "segments", (json_int_t)t->scene->segments, "cl_difference", t->cl_difference);
    for (int i = 0; i < OURS; i++)
        json_object_set_new(row, ours[i].key, bench_ms(bench_series_median(t->ours + i)));
    json_object_set_new(row, "peers", peers);
    add_figures(t, peers, result);
    bench_result_add_row(result, row);
}

static camber_status measure_scene(bench *b, const bench_scene *scene, void *user, json_t *result) {
    (void)user;
    trial t = {.b = b, .scene = scene};
    camber_status status = bench_network_of_lines(b, &scene->lines, &t.network);
    const double begin_ms = camber_now_ms();
    /* In turn, so that a machine whose speed drifts is fair to all. */
    for (size_t run = 0; bench_goes_on(b, run, begin_ms) && status == CAMBER_OK; run++) {
        status = draw_ours(&t, run >= b->warm_ups);
        bench_peers_draw(b, &t.peers, scene, run >= b->warm_ups, peer_difference, NULL);
    }
    camber_network_destroy(t.network);
    if (status == CAMBER_OK)
        report(&t, result);
    return status;
}

static json_t *measure(bench *b, const char *only) {
    return bench_measure_scenes(b, only, measure_scene, NULL);
}

/* A peer's column is as wide as its key, and never narrower than its two numbers. */
static int width_of(const char *key) {
    enum { NUMBERS = 15 };
    const int length = (int)strlen(key);
    return length > NUMBERS ? length : NUMBERS;
}

static void print_ratio(const char *key, const json_t *peer, double ours_ms, FILE *to) {
    const double peer_ms = bench_number(peer, "ms");
    if (json_is_true(json_object_get(peer, "alike")) && peer_ms > 0 && ours_ms > 0)
        fprintf(to, " %*.1f %5.2f", width_of(key) - 6, peer_ms, peer_ms / ours_ms);
    else
        fprintf(to, " %*s", width_of(key), "-");
}

/* Every scene's row: what of camber comes first, and how often the one that counts fits into each peer. */
static void print_table(const json_t *result, const int *columns, int counting, FILE *to) {
    size_t i;
    const json_t *row;
    const char *key;
    json_t *first = json_object_get(json_array_get(bench_result_rows(result), 0), "peers"), *peer;
    fprintf(to, "%-12s %3s %9s", "scene", "px", "segments");
    for (const int *k = columns; *k < OURS; k++)
        fprintf(to, " %8s", ours[*k].heading);
    json_object_foreach(first, key, peer) fprintf(to, " %*s", width_of(key), key);
    fprintf(to, "\n");
    json_array_foreach(bench_result_rows(result), i, row) {
        fprintf(to, "%-12s %3g %9.0f", bench_text(row, "scene"), bench_number(row, "width_px"),
                bench_number(row, "segments"));
        for (const int *k = columns; *k < OURS; k++)
            fprintf(to, " %8.1f", bench_number(row, ours[*k].key));
        json_object_foreach(json_object_get(row, "peers"), key, peer)
            print_ratio(key, peer, bench_number(row, ours[counting].key), to);
        fprintf(to, "\n");
    }
}

static void print(const json_t *result, FILE *to) {
    static const int in_gl[] = {DRAW, FRAME, SIMPLE_DRAW, SIMPLE_FRAME, UNITED_DRAW, OURS};
    static const int in_cl[] = {CL_FRAME, CL_SIMPLE_FRAME, FRAME, SIMPLE_FRAME, OURS};
    fprintf(to,
            "Drawing in GL, %d x %d px, round joins, butt caps, black on white, ms. draw: clear, draw, finish; frame: "
            "from lines\nin memory to pixels in memory; .1: what lies closer than %g px is left out; united: draw .1, "
            "all lines as one area.\nPeers: from lines to pixels in memory, and that time relative to camber's "
            "frame.\n\n",
            BENCH_SIDE_PX, BENCH_SIDE_PX, BENCH_SIMPLIFY_PX);
    print_table(result, in_gl, FRAME, to);
    fprintf(to, "\nDrawing in OpenCL, the same lines: cl, whole frames; frame: GL's. Peers: their time relative to cl "
                "with every point drawn.\n\n");
    print_table(result, in_cl, CL_FRAME, to);
}

const bench_section bench_section_frames = {"frames", measure, print};
