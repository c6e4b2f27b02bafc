/* Compares the methods fan, kite and strip. Each network is tessellated and drawn with each method: several times for
 * the timings, once more for the picture, and its triangles again to count repeated pixels. The pictures are compared
 * with the exact coverage of the lines. The results are rows of figures and metrics, and their average. */
#include "cli/comparison.h"
#include "validate/batches.h"
#include "validate/levels.h"
#include "validate/mesh_joins.h"
#include "validate/picture_error.h"
#include "validate/statistics.h"
#include "validate/turn_classes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WARM_UPS 3

_Static_assert(CAMBER_FIGURE_TIGHT_JOINS - CAMBER_FIGURE_TURNS == CAMBER_TURN_CLASSES, "one figure per class of turns");
_Static_assert(CAMBER_METRIC_REPEATED_ELSEWHERE - CAMBER_METRIC_REPEATED_AT_PLAIN == CAMBER_JOIN_ROOMS,
               "one metric per kind of join");
_Static_assert(CAMBER_METHODS <= CAMBER_PICTURES_MAX, "a picture a method");

const camber_method camber_methods_shown[CAMBER_METHODS] = {CAMBER_METHOD_FAN, CAMBER_METHOD_KITE, CAMBER_METHOD_STRIP};

const camber_metric_info camber_figures[CAMBER_FIGURE_COUNT] = {
    {"polylines", "polylines", 10, 0}, {"segments", "segments", 10, 0},
    {"joins", "joins", 10, 0},         {"0-30", "0-30", 9, 0},
    {"30-60", "30-60", 7, 0},          {"60-90", "60-90", 7, 0},
    {"90-120", "90-120", 7, 0},        {"120-150", "120-150", 8, 0},
    {"150-180", "150-180", 8, 0},      {"tight_joins", "tight", 9, 0},
    {"split_joins", "split", 7, 0},
};

const camber_metric_info camber_metrics[CAMBER_METRIC_COUNT] = {
    {"vertices", "vertices", 11, 0},
    {"triangles", "triangles", 11, 0},
    {"bytes", "bytes", 13, 0},
    {"draw_calls_16_bit", "calls, 16-bit", 15, 0},
    {"draw_calls", "calls", 7, 0},
    {"tessellate_ms", "tess. ms", 10, 3},
    {"draw_ms", "draw ms", 10, 2},
    {"mean_error", "error", 8, 3},
    {"max_error", "max", 5, 0},
    {"fragments", "fragments", 13, 0},
    {"drawn_pixels", "drawn", 12, 0},
    {"repeated_pixels", "repeated", 10, 0},
    {"repeated_at_plain_joins", "at plain", 10, 0},
    {"repeated_at_tight_joins", "at tight", 10, 0},
    {"repeated_at_split_joins", "at split", 10, 0},
    {"repeated_elsewhere", "elsewhere", 11, 0},
};

/* ---- Progress ---- */

/* The progress of the comparison. Networks have equal shares; in each share the methods come first, then the exact
 * coverage. */
typedef struct position {
    camber_comparison *comparison;
    size_t network;
} position;

static void tell(const position *p, double fraction) {
    camber_comparison *c = p->comparison;
    const double done = ((double)p->network + fraction) / (double)c->networks.count;
    camber_report_progress(c->session->report,
                           &(camber_progress_info){"comparing", done, "networks", p->network, c->networks.count});
}

static void tell_truth(void *user, double fraction) {
    tell(user, 0.5 + 0.5 * fraction);
}

/* ---- A method on a network ---- */

typedef struct experiment {
    camber_comparison *comparison;
    const camber_compared_network *network;
    camber_paint *paints; /* black, as wide as the strokes */
    camber_comparison_row *row;
    int method; /* index in camber_methods_shown */
} experiment;

static camber_status tessellate(const experiment *e) {
    const camber_tessellation_desc desc = {.strokes = e->network->strokes,
                                           .stroke_count = e->network->stroke_count,
                                           .method = camber_methods_shown[e->method],
                                           .fan_tolerance_px =
                                               (float)e->comparison->session->options->fan_tolerance_px};
    return camber_mesh_tessellate(e->comparison->mesh, e->network->polylines, &desc);
}

static camber_status draw(const experiment *e, bool keep, camber_frame_stats *stats) {
    camber_comparison *c = e->comparison;
    const camber_pass pass = {.mesh = c->mesh, .paints = e->paints, .paint_count = e->network->stroke_count};
    const camber_frame frame = {.width = c->networks.width,
                                .height = c->networks.height,
                                .passes = &pass,
                                .pass_count = 1,
                                .coverage = (camber_coverage)c->session->options->coverage};
    /* Black on a transparent picture: the alpha value of a pixel is its coverage. */
    camber_levels to = {c->levels[e->method], frame.width, 3};
    return camber_renderer_render(c->session->renderer, &frame, keep ? camber_levels_take : NULL, &to, stats);
}

static camber_status time_runs(const experiment *e) {
    camber_comparison *c = e->comparison;
    const size_t runs = c->session->options->runs;
    double *tessellate_ms = calloc(runs, sizeof *tessellate_ms), *draw_ms = calloc(runs, sizeof *draw_ms);
    camber_status status = tessellate_ms && draw_ms ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < WARM_UPS + runs && status == CAMBER_OK; i++) {
        camber_frame_stats stats;
        status = tessellate(e);
        if (status == CAMBER_OK)
            status = draw(e, false, &stats);
        if (status != CAMBER_OK || i < WARM_UPS)
            continue;
        const camber_mesh_info info = camber_mesh_get_info(c->mesh);
        tessellate_ms[i - WARM_UPS] = camber_stage_times_get_ms(&info.times, "classify") +
                                      camber_stage_times_get_ms(&info.times, "scan") +
                                      camber_stage_times_get_ms(&info.times, "emit");
        draw_ms[i - WARM_UPS] = stats.draw_ms;
    }
    if (status == CAMBER_OK) {
        e->row->metrics[e->method][CAMBER_METRIC_TESSELLATE_MS] = camber_statistics_median(tessellate_ms, runs);
        e->row->metrics[e->method][CAMBER_METRIC_DRAW_MS] = camber_statistics_median(draw_ms, runs);
    }
    free(tessellate_ms);
    free(draw_ms);
    return status;
}

static void count_mesh(const experiment *e, const camber_mesh_data *mesh) {
    double *metrics = e->row->metrics[e->method], *figures = e->row->figures;
    const camber_mesh_info *info = &mesh->info;
    metrics[CAMBER_METRIC_VERTICES] = (double)info->vertex_count;
    metrics[CAMBER_METRIC_TRIANGLES] = (double)info->triangle_count;
    metrics[CAMBER_METRIC_BYTES] = (double)info->bytes;
    metrics[CAMBER_METRIC_DRAW_CALLS_16_BIT] = (double)camber_batches_count(mesh, CAMBER_BATCH_VERTICES);
    figures[CAMBER_FIGURE_TIGHT_JOINS] = (double)info->tight_joins;
    figures[CAMBER_FIGURE_SPLIT_JOINS] = (double)info->split_joins;
}

/* ---- Pixels ---- */

/* Draws ranges of indices, and counts for each range how often it draws a pixel again. map receives the positions of
 * these pixels. */
static camber_status count_ranges(const experiment *e, const camber_index_range *ranges, size_t count, uint8_t *map,
                                  camber_overdraw *overdraw) {
    camber_comparison *c = e->comparison;
    const camber_overdraw_desc desc = {.width = c->networks.width,
                                       .height = c->networks.height,
                                       .mesh = c->mesh,
                                       .paints = e->paints,
                                       .paint_count = e->network->stroke_count,
                                       .ranges = ranges,
                                       .range_count = count,
                                       .map = map};
    /* The bar shows the progress of the whole comparison, so this step reports none. */
    const bool bars = c->session->report->bars;
    c->session->report->bars = false;
    const camber_status status = camber_renderer_count_overdraw(c->session->renderer, &desc, overdraw);
    c->session->report->bars = bars;
    return status;
}

/* Counts the pixels that joins of one kind draw again. c->repeated keeps the pixels that no join draws again. */
static camber_status count_joins(const experiment *e, const camber_mesh_joins *joins, camber_join_room room) {
    camber_comparison *c = e->comparison;
    camber_index_range *ranges = malloc((joins->count + 1) * sizeof *ranges);
    size_t count = 0;
    for (size_t i = 0; i < joins->count && ranges; i++)
        if (joins->items[i].room == room)
            ranges[count++] = joins->items[i].range;
    camber_overdraw overdraw = {0};
    camber_status status = ranges ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (count > 0)
        status = count_ranges(e, ranges, count, c->at_joins, &overdraw);
    for (size_t i = 0; i < (size_t)c->networks.width * c->networks.height && count > 0; i++)
        c->repeated[i] = c->at_joins[i] ? 0 : c->repeated[i];
    e->row->metrics[e->method][CAMBER_METRIC_REPEATED_AT_PLAIN + (int)room] = (double)overdraw.repeated_pixels;
    free(ranges);
    return status;
}

static camber_status count_pixels(const experiment *e, const camber_mesh_data *mesh) {
    camber_comparison *c = e->comparison;
    double *metrics = e->row->metrics[e->method];
    camber_mesh_joins joins = {0};
    camber_overdraw overdraw = {0};
    camber_status status = count_ranges(e, NULL, 0, c->repeated, &overdraw);
    metrics[CAMBER_METRIC_FRAGMENTS] = (double)overdraw.fragments;
    metrics[CAMBER_METRIC_DRAWN_PIXELS] = (double)overdraw.drawn_pixels;
    metrics[CAMBER_METRIC_REPEATED_PIXELS] = (double)overdraw.repeated_pixels;
    if (status == CAMBER_OK && !camber_mesh_joins_find(mesh, e->network->strokes, &joins))
        status = CAMBER_ERROR_MEMORY;
    for (int room = 0; room < CAMBER_JOIN_ROOMS && status == CAMBER_OK; room++)
        status = count_joins(e, &joins, (camber_join_room)room);
    for (size_t i = 0; i < (size_t)c->networks.width * c->networks.height; i++)
        metrics[CAMBER_METRIC_REPEATED_ELSEWHERE] += c->repeated[i];
    camber_mesh_joins_free(&joins);
    return status;
}

/* Marks metrics that exist only in GL as missing: kernels have no draw calls and no fragments. */
static void leave_out_gl(const experiment *e) {
    double *metrics = e->row->metrics[e->method];
    metrics[CAMBER_METRIC_DRAW_CALLS_16_BIT] = metrics[CAMBER_METRIC_DRAW_CALLS] = NAN;
    for (int i = CAMBER_METRIC_OF_PIXELS; i < CAMBER_METRIC_COUNT; i++)
        metrics[i] = NAN;
}

static camber_status try_method(const experiment *e) {
    camber_frame_stats stats = {0};
    camber_mesh_data mesh;
    camber_status status = time_runs(e);
    if (status == CAMBER_OK)
        status = draw(e, true, &stats);
    e->row->metrics[e->method][CAMBER_METRIC_DRAW_CALLS] = (double)stats.draw_calls;
    if (status == CAMBER_OK)
        status = camber_mesh_read(e->comparison->mesh, &mesh);
    if (status != CAMBER_OK)
        return status;
    count_mesh(e, &mesh);
    if (e->comparison->session->draw == CAMBER_RASTERIZER_GL)
        status = count_pixels(e, &mesh);
    else
        leave_out_gl(e);
    camber_mesh_data_destroy(&mesh);
    return status;
}

/* ---- A network ---- */

static void count_network(const camber_compared_network *network, camber_comparison_row *row) {
    const camber_polylines_stats stats = camber_polylines_get_stats(network->polylines);
    size_t turns[CAMBER_TURN_CLASSES] = {0};
    camber_turns_count(network->lines, network->keep_open, turns);
    row->figures[CAMBER_FIGURE_POLYLINES] = (double)stats.polylines;
    row->figures[CAMBER_FIGURE_SEGMENTS] = (double)stats.kept_segments;
    for (int i = 0; i < CAMBER_TURN_CLASSES; i++) {
        row->figures[CAMBER_FIGURE_TURNS + i] = (double)turns[i];
        row->figures[CAMBER_FIGURE_JOINS] += (double)turns[i];
    }
}

static camber_status measure_errors(const camber_comparison *c, const camber_compared_network *network, position *here,
                                    camber_comparison_row *row) {
    camber_picture_error_desc job = {.truth = {.lines = network->lines,
                                               .rows = network->rows,
                                               .strokes = network->strokes,
                                               .keep_open = network->keep_open,
                                               .kind = CAMBER_TRUTH_UNION},
                                     .width = (int)c->networks.width,
                                     .height = (int)c->networks.height,
                                     .threads = c->session->options->threads,
                                     .progress = tell_truth,
                                     .user = here};
    int methods[CAMBER_METHODS] = {0};
    for (int i = 0; i < CAMBER_METHODS; i++)
        if (c->shown[i]) {
            methods[job.picture_count] = i;
            job.pictures[job.picture_count++] = c->levels[i];
        }
    camber_difference differences[CAMBER_PICTURES_MAX];
    if (!camber_picture_errors_measure(&job, differences))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < job.picture_count; i++) {
        row->metrics[methods[i]][CAMBER_METRIC_MEAN_ERROR] = camber_difference_mean(&differences[i]);
        row->metrics[methods[i]][CAMBER_METRIC_MAX_ERROR] = differences[i].max;
        row->max_at[methods[i]] = differences[i].max_at;
    }
    return CAMBER_OK;
}

static int measure_network(camber_comparison *c, size_t i) {
    position here = {c, i};
    camber_compared_network network;
    const int projected = camber_compared_networks_project(&c->networks, i, &network);
    if (projected != CAMBER_EXIT_DONE)
        return projected;
    camber_comparison_row *row = &c->rows[i];
    row->name = network.name;
    count_network(&network, row);
    if (!(row->figures[CAMBER_FIGURE_POLYLINES] > 0))
        camber_report_warn(c->session->report, "%s: nothing in the view; its row is empty", network.name);
    camber_paint *paints = calloc(network.stroke_count + 1, sizeof *paints);
    camber_status status = paints ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    for (size_t k = 0; k < network.stroke_count && paints; k++)
        paints[k] = (camber_paint){.width_px = network.strokes[k].width_px, .color = {0, 0, 0, 1}};
    for (int method = 0; method < CAMBER_METHODS && status == CAMBER_OK; method++) {
        const experiment e = {c, &network, paints, row, method};
        tell(&here, method * 0.5 / CAMBER_METHODS);
        if (c->shown[method])
            status = try_method(&e);
    }
    if (status == CAMBER_OK)
        status = measure_errors(c, &network, &here, row);
    free(paints);
    return camber_report_status(c->session->report, status);
}

/* ---- All ---- */

static void average(camber_comparison *c) {
    camber_comparison_row *sum = &c->average;
    const double count = (double)c->networks.count;
    sum->name = "average";
    for (size_t i = 0; i < c->networks.count; i++) {
        for (int k = 0; k < CAMBER_FIGURE_COUNT; k++)
            sum->figures[k] += c->rows[i].figures[k] / count;
        for (int method = 0; method < CAMBER_METHODS; method++)
            for (int k = 0; k < CAMBER_METRIC_COUNT; k++) {
                const double metric = c->rows[i].metrics[method][k];
                double *to = &sum->metrics[method][k];
                *to = k != CAMBER_METRIC_MAX_ERROR ? *to + metric / count : metric > *to ? metric : *to;
            }
    }
}

static int prepare(camber_comparison *c) {
    camber_session *session = c->session;
    const size_t pixels = (size_t)c->networks.width * c->networks.height;
    c->rows = calloc(c->networks.count, sizeof *c->rows);
    c->repeated = calloc(pixels, 1);
    c->at_joins = calloc(pixels, 1);
    bool made = c->rows && c->repeated && c->at_joins;
    for (int i = 0; i < CAMBER_METHODS; i++) {
        c->shown[i] = session->options->method < 0 || session->options->method == (int)camber_methods_shown[i];
        if (c->shown[i])
            made = (c->levels[i] = calloc(pixels, 1)) && made;
    }
    const camber_status status =
        made ? camber_mesh_create(session->device, session->renderer, &c->mesh) : CAMBER_ERROR_MEMORY;
    return camber_report_status(session->report, status);
}

int camber_comparison_run(camber_comparison *comparison, camber_session *session) {
    *comparison = (camber_comparison){.session = session};
    int status = camber_session_need(session, CAMBER_NEEDS_RENDERER);
    if (status == CAMBER_EXIT_DONE)
        status = camber_compared_networks_open(&comparison->networks, session);
    if (status == CAMBER_EXIT_DONE)
        status = prepare(comparison);
    for (size_t i = 0; i < comparison->networks.count && status == CAMBER_EXIT_DONE; i++)
        status = measure_network(comparison, i);
    camber_report_erase_bar(session->report);
    if (status == CAMBER_EXIT_DONE)
        average(comparison);
    return status;
}

void camber_comparison_close(camber_comparison *comparison) {
    for (int i = 0; i < CAMBER_METHODS; i++)
        free(comparison->levels[i]);
    free(comparison->repeated);
    free(comparison->at_joins);
    camber_mesh_destroy(comparison->mesh);
    camber_compared_networks_close(&comparison->networks);
    free(comparison->rows);
    *comparison = (camber_comparison){0};
}

double camber_comparison_ratio(const camber_comparison *comparison, int method, int metric) {
    for (int i = 0; i < CAMBER_METHODS; i++) {
        const double kite = comparison->average.metrics[i][metric];
        if (camber_methods_shown[i] == CAMBER_METHOD_KITE && kite > 0)
            return comparison->average.metrics[method][metric] / kite;
    }
    return NAN;
}
