/* Tessellation: every stage against what memcpy moves in the same run, and how large the mesh is by method. And the
 * kernels that draw strips, each by itself. */
#include "bench.h"

#include <string.h>

enum { STAGES = 3, METHODS = 3, WIDTHS = 2, DRAWN = 5 };

static const float widths_px[WIDTHS] = {2, 8};
static const float OFFSET_PX = 6;

/* Bytes a point that a stage reads and writes, by the heads of kernels/<stage>.cl, but for the mesh that emit writes;
 * what there is once a block is left out. */
static const struct {
    const char *name;
    double read, written;
} stages[STAGES] = {
    {"classify", 12, 4}, /* x, y, info; joins */
    {"scan", 8, 0},      /* joins, info */
    {"emit", 16, 0},     /* x, y, info, joins; the mesh */
};

static const char *const drawn_names[DRAWN] = {"setup", "bin_count", "bin_scan", "bin_scatter", "rasterize"};

typedef struct trial {
    bench *b;
    const bench_scene *scene;
    camber_polylines *polylines;
    float width_px;
    camber_method method;
    camber_mesh_info info;
    double copied_gb_s; /* by memcpy */
    bench_series series[STAGES], all;
    bench_series offset; /* of lines beside these, before the stages */
    bench_series drawn[DRAWN];
} trial;

static double offset_ms(camber_mesh_info info) {
    return camber_stage_times_get_ms(&info.times, "offset_clip") +
           camber_stage_times_get_ms(&info.times, "offset_count") +
           camber_stage_times_get_ms(&info.times, "offset_emit");
}

static camber_status measure_offset(trial *t) {
    const camber_stroke stroke = {.width_px = t->width_px, .offset_px = OFFSET_PX};
    const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1, .method = t->method};
    camber_status status = CAMBER_OK;
    t->offset.count = 0;
    for (size_t run = 0; run < t->b->warm_ups + t->b->runs && status == CAMBER_OK; run++) {
        status = camber_mesh_tessellate(t->b->mesh, t->polylines, &desc);
        if (status == CAMBER_OK && run >= t->b->warm_ups)
            bench_series_add(&t->offset, offset_ms(camber_mesh_get_info(t->b->mesh)));
    }
    return status;
}

static camber_status tessellate(trial *t) {
    const camber_stroke stroke = {.width_px = t->width_px};
    const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1, .method = t->method};
    camber_status status = CAMBER_OK;
    for (size_t run = 0; run < t->b->warm_ups + t->b->runs && status == CAMBER_OK; run++) {
        status = camber_mesh_tessellate(t->b->mesh, t->polylines, &desc);
        if (status != CAMBER_OK || run < t->b->warm_ups)
            continue;
        const camber_mesh_info info = camber_mesh_get_info(t->b->mesh);
        double all = 0;
        for (int i = 0; i < STAGES; i++) {
            const double ms = camber_stage_times_get_ms(&info.times, stages[i].name);
            bench_series_add(t->series + i, ms);
            all += ms;
        }
        bench_series_add(&t->all, all);
        t->info = info;
    }
    return status;
}

/* The lines in one pass, in the square. */
static camber_status measure_drawing(trial *t) {
    bench *b = t->b;
    const camber_stroke stroke = {.width_px = t->width_px};
    const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1};
    const camber_paint paint = {.width_px = t->width_px, .color = {0, 0, 0, 1}};
    const camber_pass pass = {.mesh = b->cl_mesh, .paints = &paint, .paint_count = 1};
    const camber_frame frame = {
        .width = BENCH_SIDE_PX, .height = BENCH_SIDE_PX, .background = {1, 1, 1, 1}, .passes = &pass, .pass_count = 1};
    camber_status status = camber_mesh_tessellate(b->cl_mesh, t->polylines, &desc);
    for (size_t run = 0; run < b->warm_ups + b->runs && status == CAMBER_OK; run++) {
        camber_frame_stats stats;
        status = camber_renderer_render(b->cl_renderer, &frame, NULL, NULL, &stats);
        if (status != CAMBER_OK || run < b->warm_ups)
            continue;
        const double ms[DRAWN] = {
            camber_stage_times_get_ms(&stats.times, "setup"), camber_stage_times_get_ms(&stats.times, "bin_count"),
            camber_stage_times_get_ms(&stats.times, "bin_scan"), camber_stage_times_get_ms(&stats.times, "bin_scatter"),
            camber_stage_times_get_ms(&stats.times, "rasterize")};
        for (int i = 0; i < DRAWN; i++)
            bench_series_add(t->drawn + i, ms[i]);
    }
    return status;
}

/* Each kernel's share of them all, and figures: how many times what tessellates fits into the lists, and into cover. */
static void report_drawing(const trial *t, json_t *row, json_t *result) {
    double ms[DRAWN], sum = 0;
    char what[64];
    for (int i = 0; i < DRAWN; i++)
        sum += ms[i] = bench_series_median(t->drawn + i);
    if (sum <= 0)
        return;
    for (int i = 0; i < DRAWN; i++)
        json_object_set_new(row, drawn_names[i],
                            json_pack("{s:o, s:f, s:f}", "ms", bench_ms(ms[i]), "m_segments_s",
                                      ms[i] > 0 ? (double)t->scene->segments / ms[i] / 1e3 : 0, "share", ms[i] / sum));
    const double tessellated_ms = bench_series_median(&t->all);
    snprintf(what, sizeof what, "lists of tiles, %g px", (double)t->width_px);
    bench_result_add_figure(result,
                            &(bench_figure){t->scene->key, what, "kernels", tessellated_ms / (sum - ms[4]), false});
    snprintf(what, sizeof what, "cover, %g px", (double)t->width_px);
    bench_result_add_figure(result, &(bench_figure){t->scene->key, what, "kernels", tessellated_ms / ms[4], false});
}

static void add_stage(json_t *row, const char *name, double ms, double points, double bytes, double copied_gb_s) {
    const double gb_s = ms > 0 ? bytes / ms / 1e6 : 0;
    json_object_set_new(row, name,
                        json_pack("{s:o, s:f, s:f, s:f}", "ms", bench_ms(ms), "m_points_s",
                                  ms > 0 ? points / ms / 1e3 : 0, "gb_s", gb_s, "share",
                                  copied_gb_s > 0 ? gb_s / copied_gb_s : 0));
}

static void report(trial *t, json_t *result) {
    const double points = (double)camber_polylines_get_stats(t->polylines).kept_points;
    const double segments = (double)t->scene->segments, mesh = (double)t->info.bytes, ms = bench_series_median(&t->all);
    double moved[STAGES], sum = 0;
    for (int i = 0; i < STAGES; i++) {
        moved[i] = points * (stages[i].read + stages[i].written) + (i == STAGES - 1 ? mesh : 0);
        sum += moved[i];
    }
    const char *method = camber_method_get_name(t->method);
    json_t *row =
        json_pack("{s:s, s:s, s:s, s:f, s:I, s:I, s:f, s:f, s:f, s:f}", "key", t->scene->key, "scene", t->scene->name,
                  "method", method, "width_px", (double)t->width_px, "points", (json_int_t)points, "segments",
                  (json_int_t)segments, "mesh_bytes", mesh, "bytes_a_segment", mesh / segments, "m_segments_s",
                  ms > 0 ? segments / ms / 1e3 : 0, "memcpy_gb_s", t->copied_gb_s);
    for (int i = 0; i < STAGES; i++)
        add_stage(row, stages[i].name, bench_series_median(t->series + i), points, moved[i], t->copied_gb_s);
    add_stage(row, "all", ms, points, sum, t->copied_gb_s);
    if (t->offset.count) {
        const double beside_ms = bench_series_median(&t->offset);
        json_object_set_new(row, "offset_m_points_s", json_real(beside_ms > 0 ? points / beside_ms / 1e3 : 0));
        bench_result_add_figure(result, &(bench_figure){t->scene->key, "offset of 6 px, 2 px wide", "kernels",
                                                        beside_ms > 0 ? ms / beside_ms : 0, false});
    }
    report_drawing(t, row, result);
    char what[64];
    snprintf(what, sizeof what, "bytes a segment, %s, %g px", method, (double)t->width_px);
    bench_result_add_figure(result, &(bench_figure){t->scene->key, what, NULL, mesh / segments, true});
    snprintf(what, sizeof what, "kernels, %s, %g px", method, (double)t->width_px);
    const double share = bench_number(json_object_get(row, "all"), "share");
    bench_result_add_figure(result, &(bench_figure){t->scene->key, what, "memcpy", share, false});
    bench_result_add_row(result, row);
}

static camber_status measure_scene(bench *b, const bench_scene *scene, void *copied_gb_s, json_t *result) {
    trial t = {.b = b, .scene = scene, .copied_gb_s = *(const double *)copied_gb_s};
    const camber_polylines_desc desc = {.points = scene->lines.points,
                                        .point_count = scene->lines.point_count,
                                        .offsets = scene->lines.offsets,
                                        .polyline_count = scene->lines.polyline_count,
                                        .keep_open = true};
    camber_status status = camber_polylines_create(b->context, &desc, &t.polylines);
    for (int i = 0; i < METHODS * WIDTHS && status == CAMBER_OK; i++) {
        t.method = (camber_method)(i / WIDTHS);
        t.width_px = widths_px[i % WIDTHS];
        t.all.count = 0;
        for (int k = 0; k < STAGES; k++)
            t.series[k].count = 0;
        status = tessellate(&t);
        t.offset.count = 0;
        if (status == CAMBER_OK && i == 0)
            status = measure_offset(&t);
        for (int k = 0; k < DRAWN; k++)
            t.drawn[k].count = 0;
        if (status == CAMBER_OK && t.method == CAMBER_METHOD_STRIP)
            status = measure_drawing(&t);
        if (status == CAMBER_OK)
            report(&t, result);
    }
    camber_polylines_destroy(t.polylines);
    return status;
}

static json_t *measure(bench *b, const char *only) {
    double copied_gb_s = bench_copy_gb_s(b);
    return bench_measure_scenes(b, only, measure_scene, &copied_gb_s);
}

static void print_drawing(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to, "\nKernels that draw, strips in one pass: ms, M segments a second, their share of all five.\n%-12s %3s",
            "scene", "px");
    for (int k = 0; k < DRAWN; k++)
        fprintf(to, " | %-6s ms   M/s share", drawn_names[k]);
    fprintf(to, "\n");
    json_array_foreach(bench_result_rows(result), i, row) if (json_object_get(row, drawn_names[0])) {
        fprintf(to, "%-12s %3g", bench_text(row, "scene"), bench_number(row, "width_px"));
        for (int k = 0; k < DRAWN; k++) {
            const json_t *stage = json_object_get(row, drawn_names[k]);
            fprintf(to, " | %8.2f %6.1f %4.0f%%", bench_number(stage, "ms"), bench_number(stage, "m_segments_s"),
                    100 * bench_number(stage, "share"));
        }
        fprintf(to, "\n");
    }
}

static void print(const json_t *result, FILE *to) {
    size_t i;
    const json_t *row;
    fprintf(to,
            "Tessellation: M points a second, GB/s of bytes read and written, and their share of memcpy's (of 16 MB, "
            "on as\n"
            "many threads: %.1f GB/s). B/seg: bytes of the mesh a segment, everything included.\n\n",
            bench_number(json_array_get(bench_result_rows(result), 0), "memcpy_gb_s"));
    fprintf(to, "%-12s %-6s %3s %9s %6s %8s", "scene", "method", "px", "segments", "B/seg", "M seg/s");
    for (int k = 0; k < STAGES; k++)
        fprintf(to, " | %-8s M/s  GB/s share", stages[k].name);
    fprintf(to, " | all      M/s  GB/s share\n");
    json_array_foreach(bench_result_rows(result), i, row) {
        fprintf(to, "%-12s %-6s %3g %9.0f %6.1f %8.1f", bench_text(row, "scene"), bench_text(row, "method"),
                bench_number(row, "width_px"), bench_number(row, "segments"), bench_number(row, "bytes_a_segment"),
                bench_number(row, "m_segments_s"));
        for (int k = 0; k <= STAGES; k++) {
            const json_t *stage = json_object_get(row, k < STAGES ? stages[k].name : "all");
            fprintf(to, " | %12.1f %5.1f %4.0f%%", bench_number(stage, "m_points_s"), bench_number(stage, "gb_s"),
                    100 * bench_number(stage, "share"));
        }
        fprintf(to, "\n");
    }
    print_drawing(result, to);
    fprintf(to, "\nOffset of 6 px, M points a second:\n");
    json_array_foreach(bench_result_rows(result), i, row) if (json_object_get(row, "offset_m_points_s"))
        fprintf(to, "%-12s %6.1f\n", bench_text(row, "scene"), bench_number(row, "offset_m_points_s"));
}

const bench_section bench_section_stages = {"stages", measure, print};
