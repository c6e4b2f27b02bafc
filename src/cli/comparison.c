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

_Static_assert(CAMBER_FIGURE_TIGHT_JOINS - CAMBER_FIGURE_TURNS == CAMBER_TURN_CLASSES, "a figure a class of turns");
_Static_assert(CAMBER_MEASURE_REPEATED_ELSEWHERE - CAMBER_MEASURE_REPEATED_AT_PLAIN == CAMBER_JOIN_ROOMS,
               "a measure a room of joins");
_Static_assert(CAMBER_METHODS <= CAMBER_PICTURES_MAX, "a picture a method");

const camber_method camber_methods_shown[CAMBER_METHODS] = {CAMBER_METHOD_FAN, CAMBER_METHOD_KITE, CAMBER_METHOD_STRIP};

const camber_measure_info camber_figures[CAMBER_FIGURE_COUNT] = {
    {"polylines", "polylines", 10, 0}, {"segments", "segments", 10, 0},
    {"joins", "joins", 10, 0},         {"0-30", "0-30", 9, 0},
    {"30-60", "30-60", 7, 0},          {"60-90", "60-90", 7, 0},
    {"90-120", "90-120", 7, 0},        {"120-150", "120-150", 8, 0},
    {"150-180", "150-180", 8, 0},      {"tight_joins", "tight", 9, 0},
    {"split_joins", "split", 7, 0},
};

const camber_measure_info camber_measures[CAMBER_MEASURE_COUNT] = {
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

/* How far all is: networks of equal shares, in each the methods and then the truth. */
typedef struct place {
    camber_comparison *comparison;
    size_t network;
} place;

static void tell(const place *p, double fraction) {
    camber_comparison *c = p->comparison;
    camber_report_progress(c->session->report, "comparing",
                           ((double)p->network + fraction) / (double)c->networks.count);
}

static void tell_truth(void *user, double fraction) {
    tell(user, 0.5 + 0.5 * fraction);
}

/* ---- A method on a network ---- */

typedef struct trial {
    camber_comparison *comparison;
    const camber_compared_network *network;
    camber_paint *paints; /* black, of the strokes' widths */
    camber_comparison_row *row;
    int method; /* of camber_methods_shown */
} trial;

static camber_status tessellate(const trial *t) {
    const camber_tessellation_desc desc = {.strokes = t->network->strokes,
                                           .stroke_count = t->network->stroke_count,
                                           .method = camber_methods_shown[t->method],
                                           .fan_tolerance_px =
                                               (float)t->comparison->session->options->fan_tolerance_px};
    return camber_tessellate(t->comparison->mesh, t->network->polylines, &desc);
}

static camber_status draw(const trial *t, bool keep, camber_frame_stats *stats) {
    camber_comparison *c = t->comparison;
    const camber_pass pass = {.mesh = c->mesh, .paints = t->paints, .paint_count = t->network->stroke_count};
    const camber_frame frame = {.width = c->networks.width,
                                .height = c->networks.height,
                                .passes = &pass,
                                .pass_count = 1,
                                .coverage = (camber_coverage)c->session->options->coverage};
    /* Black on nothing has its coverage as alpha. */
    camber_levels to = {c->levels[t->method], frame.width, 3};
    return camber_render(c->session->renderer, &frame, keep ? camber_levels_take : NULL, &to, stats);
}

static camber_status time_runs(const trial *t) {
    camber_comparison *c = t->comparison;
    const size_t runs = c->session->options->runs;
    double *tessellate_ms = calloc(runs, sizeof *tessellate_ms), *draw_ms = calloc(runs, sizeof *draw_ms);
    camber_status status = tessellate_ms && draw_ms ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < WARM_UPS + runs && status == CAMBER_OK; i++) {
        camber_frame_stats stats;
        status = tessellate(t);
        if (status == CAMBER_OK)
            status = draw(t, false, &stats);
        if (status != CAMBER_OK || i < WARM_UPS)
            continue;
        const camber_mesh_info info = camber_mesh_get_info(c->mesh);
        tessellate_ms[i - WARM_UPS] = info.classify_ms + info.scan_ms + info.emit_ms;
        draw_ms[i - WARM_UPS] = stats.draw_ms;
    }
    if (status == CAMBER_OK) {
        t->row->measures[t->method][CAMBER_MEASURE_TESSELLATE_MS] = camber_statistics_median(tessellate_ms, runs);
        t->row->measures[t->method][CAMBER_MEASURE_DRAW_MS] = camber_statistics_median(draw_ms, runs);
    }
    free(tessellate_ms);
    free(draw_ms);
    return status;
}

static void count_mesh(const trial *t, const camber_mesh_data *mesh) {
    double *measures = t->row->measures[t->method], *figures = t->row->figures;
    const camber_mesh_info *info = &mesh->info;
    measures[CAMBER_MEASURE_VERTICES] = (double)info->vertex_count;
    measures[CAMBER_MEASURE_TRIANGLES] = (double)info->triangle_count;
    measures[CAMBER_MEASURE_BYTES] = (double)info->bytes;
    measures[CAMBER_MEASURE_DRAW_CALLS_16_BIT] = (double)camber_batches_count(mesh, CAMBER_BATCH_VERTICES);
    figures[CAMBER_FIGURE_TIGHT_JOINS] = (double)info->tight_joins;
    figures[CAMBER_FIGURE_SPLIT_JOINS] = (double)info->split_joins;
}

/* ---- Pixels ---- */

/* Counts ranges, each by itself; map takes where they repeat. */
static camber_status count_ranges(const trial *t, const camber_index_range *ranges, size_t count, uint8_t *map,
                                  camber_overdraw *overdraw) {
    camber_comparison *c = t->comparison;
    const camber_overdraw_desc desc = {.width = c->networks.width,
                                       .height = c->networks.height,
                                       .mesh = c->mesh,
                                       .paints = t->paints,
                                       .paint_count = t->network->stroke_count,
                                       .ranges = ranges,
                                       .range_count = count,
                                       .map = map};
    /* Its progress would stand where that of the whole does. */
    const bool bars = c->session->report->bars;
    c->session->report->bars = false;
    const camber_status status = camber_overdraw_count(c->session->renderer, &desc, overdraw);
    c->session->report->bars = bars;
    return status;
}

/* What the joins of a room repeat; c->repeated keeps what no join has repeated. */
static camber_status count_joins(const trial *t, const camber_mesh_joins *joins, camber_join_room room) {
    camber_comparison *c = t->comparison;
    camber_index_range *ranges = malloc((joins->count + 1) * sizeof *ranges);
    size_t count = 0;
    for (size_t i = 0; i < joins->count && ranges; i++)
        if (joins->items[i].room == room)
            ranges[count++] = joins->items[i].range;
    camber_overdraw overdraw = {0};
    camber_status status = ranges ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (count > 0)
        status = count_ranges(t, ranges, count, c->at_joins, &overdraw);
    for (size_t i = 0; i < (size_t)c->networks.width * c->networks.height && count > 0; i++)
        c->repeated[i] = c->at_joins[i] ? 0 : c->repeated[i];
    t->row->measures[t->method][CAMBER_MEASURE_REPEATED_AT_PLAIN + (int)room] = (double)overdraw.repeated_pixels;
    free(ranges);
    return status;
}

static camber_status count_pixels(const trial *t, const camber_mesh_data *mesh) {
    camber_comparison *c = t->comparison;
    double *measures = t->row->measures[t->method];
    camber_mesh_joins joins = {0};
    camber_overdraw overdraw = {0};
    camber_status status = count_ranges(t, NULL, 0, c->repeated, &overdraw);
    measures[CAMBER_MEASURE_FRAGMENTS] = (double)overdraw.fragments;
    measures[CAMBER_MEASURE_DRAWN_PIXELS] = (double)overdraw.drawn_pixels;
    measures[CAMBER_MEASURE_REPEATED_PIXELS] = (double)overdraw.repeated_pixels;
    if (status == CAMBER_OK && !camber_mesh_joins_find(mesh, t->network->strokes, &joins))
        status = CAMBER_ERROR_MEMORY;
    for (int room = 0; room < CAMBER_JOIN_ROOMS && status == CAMBER_OK; room++)
        status = count_joins(t, &joins, (camber_join_room)room);
    for (size_t i = 0; i < (size_t)c->networks.width * c->networks.height; i++)
        measures[CAMBER_MEASURE_REPEATED_ELSEWHERE] += c->repeated[i];
    camber_mesh_joins_free(&joins);
    return status;
}

/* What kernels have no such thing of. */
static void leave_out_gl(const trial *t) {
    double *measures = t->row->measures[t->method];
    measures[CAMBER_MEASURE_DRAW_CALLS_16_BIT] = measures[CAMBER_MEASURE_DRAW_CALLS] = NAN;
    for (int i = CAMBER_MEASURE_OF_PIXELS; i < CAMBER_MEASURE_COUNT; i++)
        measures[i] = NAN;
}

static camber_status try_method(const trial *t) {
    camber_frame_stats stats = {0};
    camber_mesh_data mesh;
    camber_status status = time_runs(t);
    if (status == CAMBER_OK)
        status = draw(t, true, &stats);
    t->row->measures[t->method][CAMBER_MEASURE_DRAW_CALLS] = (double)stats.draw_calls;
    if (status == CAMBER_OK)
        status = camber_mesh_read(t->comparison->mesh, &mesh);
    if (status != CAMBER_OK)
        return status;
    count_mesh(t, &mesh);
    if (t->comparison->session->draw == CAMBER_DRAW_GL)
        status = count_pixels(t, &mesh);
    else
        leave_out_gl(t);
    camber_mesh_data_free(t->comparison->session->context, &mesh);
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

static camber_status measure_errors(const camber_comparison *c, const camber_compared_network *network, place *here,
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
        row->measures[methods[i]][CAMBER_MEASURE_MEAN_ERROR] = camber_difference_mean(&differences[i]);
        row->measures[methods[i]][CAMBER_MEASURE_MAX_ERROR] = differences[i].max;
        row->max_at[methods[i]] = differences[i].max_at;
    }
    return CAMBER_OK;
}

static int measure_network(camber_comparison *c, size_t i) {
    place here = {c, i};
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
        const trial t = {c, &network, paints, row, method};
        tell(&here, method * 0.5 / CAMBER_METHODS);
        if (c->shown[method])
            status = try_method(&t);
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
            for (int k = 0; k < CAMBER_MEASURE_COUNT; k++) {
                const double measure = c->rows[i].measures[method][k];
                double *to = &sum->measures[method][k];
                *to = k != CAMBER_MEASURE_MAX_ERROR ? *to + measure / count : measure > *to ? measure : *to;
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

double camber_comparison_ratio(const camber_comparison *comparison, int method, int measure) {
    for (int i = 0; i < CAMBER_METHODS; i++) {
        const double kite = comparison->average.measures[i][measure];
        if (camber_methods_shown[i] == CAMBER_METHOD_KITE && kite > 0)
            return comparison->average.measures[method][measure] / kite;
    }
    return NAN;
}
