/* A frame of every scene, and the same polylines drawn by every peer, in turn in one run. */
#include "bench.h"

#include <stdlib.h>
#include <string.h>

enum { PEERS_MAX = 8 };
/* A peer whose picture is farther from camber's than this draws something else, and counts for nothing: mean
 * difference, 255ths, over the pixels that either draws on. On Porto those that draw line over line come to 1.3, those
 * that unite all lines to 3.9; an empty picture, of lines 2 px wide or more, comes to more than 100. */
#define DIFFERENCE_MAX 20.0

typedef struct trial {
    bench *b;
    const bench_scene *scene;
    camber_network *network;
    bench_series draw, frame, simple_draw, simple_frame, united_draw, peers[PEERS_MAX];
    double differences[PEERS_MAX];
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

static camber_status draw_ours(trial *t, bool counts) {
    bench *b = t->b;
    bench_frame_times times = {0}, simple = {0}, united = {0};
    bench_frame_desc desc = {.lines = &t->scene->lines, .width_px = t->scene->width_px, .picture = b->picture};
    camber_status status = bench_frame(b, &desc, &times);
    desc.network = t->network;
    desc.camera = bench_camera(BENCH_SIMPLIFY_PX);
    desc.picture = b->pictured; /* the one of everything is what peers are held against */
    if (status == CAMBER_OK)
        status = bench_frame(b, &desc, &simple);
    desc.overlap = CAMBER_OVERLAP_UNITE;
    if (status == CAMBER_OK)
        status = bench_frame(b, &desc, &united);
    if (status == CAMBER_OK && counts) {
        bench_series_add(&t->draw, times.draw_ms);
        bench_series_add(&t->frame, times.frame_ms);
        bench_series_add(&t->simple_draw, simple.draw_ms);
        bench_series_add(&t->simple_frame, simple.frame_ms);
        bench_series_add(&t->united_draw, united.draw_ms);
    }
    return status;
}

static void draw_peers(trial *t, bool counts) {
    for (size_t i = 0; i < bench_peer_count && i < PEERS_MAX; i++) {
        const double ms = bench_peers[i]->draw(&t->scene->lines, t->scene->width_px, t->b->pictured);
        if (!counts)
            t->differences[i] = ms > 0 ? difference_of(t->b->picture, t->b->pictured) : -1;
        else if (ms > 0)
            bench_series_add(t->peers + i, ms);
    }
}

static void add_figures(const trial *t, const json_t *peers, json_t *result) {
    const struct {
        const char *what;
        const bench_series *series;
    } ours[] = {{"draw", &t->draw},
                {"draw at 0.1 px", &t->simple_draw},
                {"frame", &t->frame},
                {"frame at 0.1 px", &t->simple_frame},
                {"draw united at 0.1 px", &t->united_draw}};
    for (size_t i = 0; i < bench_peer_count; i++) {
        const double peer_ms = strchr(bench_peers[i]->key, '_') ? 0 : bench_best_peer(peers, bench_peers[i]->key);
        for (size_t k = 0; k < sizeof ours / sizeof *ours; k++)
            bench_result_add_figure(result, &(bench_figure){t->scene->key, ours[k].what, bench_peers[i]->name,
                                                            peer_ms / bench_series_median(ours[k].series), false});
    }
}

static void report(const trial *t, json_t *result) {
    json_t *peers = json_object();
    json_t *row = json_pack(
        "{s:s, s:s, s:f, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o}", "key", t->scene->key, "scene", t->scene->name,
        "width_px", (double)t->scene->width_px, "polylines", (json_int_t)t->scene->lines.polyline_count, "segments",
        (json_int_t)t->scene->segments, "draw_ms", bench_ms(bench_series_median(&t->draw)), "frame_ms",
        bench_ms(bench_series_median(&t->frame)), "simple_draw_ms", bench_ms(bench_series_median(&t->simple_draw)),
        "simple_frame_ms", bench_ms(bench_series_median(&t->simple_frame)), "united_draw_ms",
        bench_ms(bench_series_median(&t->united_draw)), "peers", peers);
    for (size_t i = 0; i < bench_peer_count; i++) {
        const double difference = t->differences[i];
        const bool alike = difference >= 0 && difference <= DIFFERENCE_MAX;
        if (!alike)
            fprintf(stderr, "camber_bench: %s on %s does not count: its picture differs by %.0f of 255\n",
                    bench_peers[i]->name, t->scene->name, difference);
        json_object_set_new(peers, bench_peers[i]->key,
                            json_pack("{s:o, s:f, s:b}", "ms", bench_ms(bench_series_median(t->peers + i)),
                                      "difference", difference, "alike", alike));
    }
    add_figures(t, peers, result);
    bench_result_add_row(result, row);
}

static camber_status measure_scene(bench *b, const bench_scene *scene, void *user, json_t *result) {
    (void)user;
    trial t = {.b = b, .scene = scene};
    camber_status status = bench_network_of_lines(b, &scene->lines, &t.network);
    /* In turn, so that a machine whose speed drifts is fair to all. */
    for (size_t run = 0; run < b->warm_ups + b->runs && status == CAMBER_OK; run++) {
        status = draw_ours(&t, run >= b->warm_ups);
        draw_peers(&t, run >= b->warm_ups);
    }
    camber_network_destroy(t.network);
    if (status == CAMBER_OK)
        report(&t, result);
    return status;
}

static json_t *measure(bench *b, const char *only) {
    return bench_measure_scenes(b, only, measure_scene, NULL);
}

static void print_ratio(double peer_ms, double ours_ms, bool alike, FILE *to) {
    if (alike && peer_ms > 0 && ours_ms > 0)
        fprintf(to, " %9.1f %5.2f", peer_ms, peer_ms / ours_ms);
    else
        fprintf(to, " %9s %5s", "-", "-");
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to,
            "Drawing, %d x %d px, round joins, butt caps, black on white, ms. draw: clear, draw, finish; frame: from "
            "lines in\n"
            "memory to pixels in memory; at %g px: what lies closer is left out. Peers: from lines to pixels in "
            "memory, and\n"
            "how many times camber's drawing at %g px fits into that.\n\n",
            BENCH_SIDE_PX, BENCH_SIDE_PX, BENCH_SIMPLIFY_PX, BENCH_SIMPLIFY_PX);
    fprintf(to, "%-12s %3s %9s %7s %7s %8s %8s %7s", "scene", "px", "segments", "draw", "frame", "draw .1", "frame .1",
            "united");
    json_t *first = json_object_get(json_array_get(bench_result_rows(result), 0), "peers"), *peer;
    const char *key;
    json_object_foreach(first, key, peer) fprintf(to, " %15s", key);
    fprintf(to, "\n");
    json_array_foreach(bench_result_rows(result), i, row) {
        fprintf(to, "%-12s %3g %9.0f %7.1f %7.1f %8.1f %8.1f %7.1f", bench_text(row, "scene"),
                bench_number(row, "width_px"), bench_number(row, "segments"), bench_number(row, "draw_ms"),
                bench_number(row, "frame_ms"), bench_number(row, "simple_draw_ms"),
                bench_number(row, "simple_frame_ms"), bench_number(row, "united_draw_ms"));
        json_object_foreach(json_object_get(row, "peers"), key, peer)
            print_ratio(bench_number(peer, "ms"), bench_number(row, "simple_draw_ms"),
                        json_is_true(json_object_get(peer, "alike")), to);
        fprintf(to, "\n");
    }
}

const bench_section bench_section_frames = {"frames", measure, print};
