/* Runs `camber bench`: draws the input several times and prints minimum, median and maximum of every stage, as a table
 * or JSON. On request it writes the picture and the polylines. */
#include "cli/picture.h"
#include "cli/verbs.h"
#include "validate/statistics.h"

#include <stdlib.h>
#include <string.h>

#define WARM_UPS 3

/* The times of one run in ms; every member becomes a series. */
typedef struct run_times {
    double tessellate, draw, frame, cull_count, project, classify, scan, emit;
    double shape, count, total, fill, cover; /* kernels that rasterize */
} run_times;

#define TIMES (sizeof(run_times) / sizeof(double))

typedef struct summary {
    double min, median, max;
} summary;

typedef struct job {
    camber_session *session;
    camber_input input;
    camber_output output, dump;
    camber_mesh *mesh;
    uint8_t *pixels;
    run_times *runs;
    summary summaries[TIMES]; /* in the order of the members of run_times */
    camber_frame_stats stats;
    uint32_t width, height;
    size_t output_bytes, dump_bytes;
} job;

/* Times a whole frame, from the lines to pixels in memory, and then only its stages, with their input already on the
 * device. */
static int time_run(job *j, run_times *times) {
    const double start_ms = camber_now_ms();
    const int projected = camber_input_project(&j->input);
    if (projected != CAMBER_EXIT_DONE)
        return projected;
    camber_status status = camber_input_tessellate(&j->input, j->mesh);
    camber_frame frame = camber_input_frame(&j->input, j->mesh);
    if (status == CAMBER_OK)
        status = camber_renderer_render_into(j->session->renderer, &frame, j->pixels, 0, NULL);
    times->frame = camber_now_ms() - start_ms;
    const double resident_ms = camber_now_ms();
    if (status == CAMBER_OK)
        status = camber_input_tessellate(&j->input, j->mesh);
    times->tessellate = camber_now_ms() - resident_ms;
    camber_mesh_info info = camber_mesh_get_info(j->mesh);
    times->cull_count = camber_stage_times_get_ms(&info.times, "cull_count");
    times->project = camber_stage_times_get_ms(&info.times, "cull_emit");
    times->tessellate -= times->cull_count + times->project; /* from classify on */
    const double classified_ms = camber_stage_times_get_ms(&info.times, "classify");
    times->scan = camber_stage_times_get_ms(&info.times, "scan");
    times->emit = camber_stage_times_get_ms(&info.times, "emit");
    frame = camber_input_frame(&j->input, j->mesh); /* a scene's frame is valid until the next call on the scene */
    if (status == CAMBER_OK)
        status = camber_renderer_render(j->session->renderer, &frame, NULL, NULL, &j->stats);
    times->draw = j->stats.draw_ms;
    info = camber_mesh_get_info(j->mesh);
    times->classify = camber_stage_times_get_ms(&info.times, "classify");
    times->tessellate += times->classify - classified_ms; /* kernels classify the mesh when they draw its lines */
    times->draw -= times->classify - classified_ms;
    times->shape = camber_stage_times_get_ms(&j->stats.times, "setup");
    times->count = camber_stage_times_get_ms(&j->stats.times, "bin_count");
    times->total = camber_stage_times_get_ms(&j->stats.times, "bin_scan");
    times->fill = camber_stage_times_get_ms(&j->stats.times, "bin_scatter");
    times->cover = camber_stage_times_get_ms(&j->stats.times, "rasterize");
    return camber_report_status(j->session->report, status);
}

static bool summarise(job *j, size_t count) {
    double *series = calloc(count, sizeof *series);
    if (!series)
        return false;
    for (size_t member = 0; member < TIMES; member++) {
        for (size_t i = 0; i < count; i++)
            memcpy(&series[i], (const char *)&j->runs[i] + member * sizeof(double), sizeof(double));
        const double median = camber_statistics_median(series, count);
        j->summaries[member] = (summary){series[0], median, series[count - 1]};
    }
    free(series);
    return true;
}

static int open_outputs(job *j) {
    camber_session *session = j->session;
    const camber_options *options = session->options;
    int status = CAMBER_EXIT_DONE;
    if (options->output)
        status = camber_output_open(&j->output, session->report, session->guard, options->output, options->force);
    if (status == CAMBER_EXIT_DONE && options->dump)
        status = camber_output_open(&j->dump, session->report, session->guard, options->dump, options->force);
    return status;
}

static int write_dump(job *j) {
    const camber_status status =
        camber_lines_write(j->session->context, camber_input_lines(&j->input), camber_output_sink(&j->dump));
    return status == CAMBER_OK ? camber_output_publish(&j->dump) : camber_output_status(&j->dump, status);
}

static int measure(job *j) {
    camber_session *session = j->session;
    const uint32_t runs = session->options->runs;
    int status = camber_input_project(&j->input);
    if (status != CAMBER_EXIT_DONE)
        return status;
    camber_input_warn_empty(&j->input, "nothing is timed");
    const camber_frame frame = camber_input_frame(&j->input, j->mesh);
    j->width = frame.width;
    j->height = frame.height;
    const size_t bytes = (size_t)frame.width * frame.height * 4, step = CAMBER_PIXELS_ALIGNMENT;
    j->pixels = aligned_alloc(step, (bytes + step - 1) / step * step);
    j->runs = calloc(runs, sizeof *j->runs);
    if (!j->pixels || !j->runs)
        return camber_report_status(session->report, CAMBER_ERROR_MEMORY);
    run_times unused;
    for (uint32_t i = 0; i < WARM_UPS + runs && status == CAMBER_EXIT_DONE; i++) {
        camber_report_step(session->report, "timing", "runs", i, WARM_UPS + runs);
        status = time_run(j, i < WARM_UPS ? &unused : &j->runs[i - WARM_UPS]);
    }
    camber_report_erase_bar(session->report);
    if (status == CAMBER_EXIT_DONE && !summarise(j, runs))
        return camber_report_status(session->report, CAMBER_ERROR_MEMORY);
    return status;
}

static int run(job *j) {
    camber_session *session = j->session;
    int status = open_outputs(j);
    if (status == CAMBER_EXIT_DONE)
        status = camber_session_need(session, CAMBER_NEEDS_RENDERER);
    if (status == CAMBER_EXIT_DONE)
        status = camber_input_open(&j->input, session);
    if (status == CAMBER_EXIT_DONE)
        status =
            camber_report_status(session->report, camber_mesh_create(session->device, session->renderer, &j->mesh));
    if (status == CAMBER_EXIT_DONE)
        status = measure(j);
    /* After a scene has moved, its polylines must be made again. */
    if (status == CAMBER_EXIT_DONE && !camber_input_polylines(&j->input))
        status = camber_report_status(session->report, CAMBER_ERROR_MEMORY);
    if (status == CAMBER_EXIT_DONE && session->options->dump)
        status = write_dump(j);
    j->dump_bytes = j->dump.size_bytes;
    if (status == CAMBER_EXIT_DONE && session->options->output)
        status = camber_picture_write(&j->input, j->mesh, &j->output, NULL);
    j->output_bytes = j->output.size_bytes;
    return status;
}

static json_t *summary_json(const summary *s) {
    return json_pack("{s:o, s:o, s:o}", "min", camber_json_ms(s->min), "median", camber_json_ms(s->median), "max",
                     camber_json_ms(s->max));
}

static int print_json(const job *j) {
    const camber_session *session = j->session;
    const camber_polylines_stats lines = camber_polylines_get_stats(camber_input_polylines(&j->input));
    (void)camber_mesh_count_joins(j->mesh); /* a failure is logged, and the counts are 0 */
    const camber_mesh_info mesh = camber_mesh_get_info(j->mesh);
    json_t *object =
        json_pack("{s:s, s:I, s:I, s:I}", "method", camber_method_get_name(mesh.method), "width", (json_int_t)j->width,
                  "height", (json_int_t)j->height, "runs", (json_int_t)session->options->runs);
    if (!object)
        return camber_report_json(session->report, NULL);
    camber_session_describe(session, object);
    const struct {
        const char *name;
        size_t count;
    } counts[] = {
        {"polylines", lines.polylines},
        {"points_in", j->input.points_in},
        {"segments_in", j->input.segments_in},
        {"points", lines.kept_points},
        {"segments", lines.kept_segments},
        {"joins", mesh.joins},
        {"vertices", mesh.vertex_count},
        {"triangles", mesh.triangle_count},
        {"bytes", mesh.bytes},
        {"draw_calls", j->stats.draw_calls},
        {"peak_rss_bytes", camber_peak_rss_bytes()},
    };
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        json_object_set_new(object, counts[i].name, camber_json_count(counts[i].count));
    json_object_set_new(object, "tessellate_ms", summary_json(&j->summaries[0]));
    json_object_set_new(object, "draw_ms", summary_json(&j->summaries[1]));
    json_object_set_new(object, "frame_ms", summary_json(&j->summaries[2]));
    json_t *stages = json_object();
    /* The last rows are for the kernels that rasterize, if they drew. */
    static const char *const names[] = {"cull_count", "cull_emit", "classify", "scan",        "emit",
                                        "setup",      "bin_count", "bin_scan", "bin_scatter", "rasterize"};
    const size_t count = camber_renderer_get_rasterizer(session->renderer) == CAMBER_RASTERIZER_OPENCL ? 10 : 5;
    for (size_t i = 0; i < count; i++)
        json_object_set_new(stages, names[i], summary_json(&j->summaries[3 + i]));
    json_object_set_new(object, "stage_ms", stages);
    return camber_report_json(session->report, object);
}

/* The table goes to standard output, unless the picture or the polylines go there. */
static int print_text(const job *j) {
    camber_session *session = j->session;
    const camber_options *options = session->options;
    const bool taken =
        (options->output && strcmp(options->output, "-") == 0) || (options->dump && strcmp(options->dump, "-") == 0);
    FILE *file = taken ? stderr : stdout;
    const camber_polylines_stats lines = camber_polylines_get_stats(camber_input_polylines(&j->input));
    (void)camber_mesh_count_joins(j->mesh); /* a failure is logged, and the counts are 0 */
    const camber_mesh_info mesh = camber_mesh_get_info(j->mesh);
    const camber_device_info device = camber_device_get_info(session->device);
    if (session->surface)
        fprintf(file, "%s; %s; sharing: %s\n", device.name, camber_surface_get_info(session->surface).renderer,
                camber_sharing_get_name(camber_renderer_get_sharing(session->renderer)));
    else
        fprintf(file, "%s; drawn in OpenCL\n", device.name);
    fprintf(file, "%u x %u px, %s, %s polyline%s, %s points (%s read), %s segments (%s read)\n", j->width, j->height,
            camber_method_get_name(mesh.method), camber_figure_count(lines.polylines).text,
            camber_plural(lines.polylines), camber_figure_count(lines.kept_points).text,
            camber_figure_count(j->input.points_in).text, camber_figure_count(lines.kept_segments).text,
            camber_figure_count(j->input.segments_in).text);
    fprintf(file, "%s vertices, %s triangles, %s of meshes, ", camber_figure_count(mesh.vertex_count).text,
            camber_figure_count(mesh.triangle_count).text, camber_figure_bytes(mesh.bytes).text);
    if (session->surface) /* kernels have no draw calls */
        fprintf(file, "%s draw call%s, ", camber_figure_count(j->stats.draw_calls).text,
                camber_plural(j->stats.draw_calls));
    fprintf(file, "at most %s of memory, drivers and libraries included\n",
            camber_figure_bytes(camber_peak_rss_bytes()).text);
    static const char *const names[TIMES] = {"tessellate", "draw",        "frame",    "cull_count", "cull_emit",
                                             "classify",   "scan",        "emit",     "setup",      "bin_count",
                                             "bin_scan",   "bin_scatter", "rasterize"};
    const size_t count = camber_renderer_get_rasterizer(session->renderer) == CAMBER_RASTERIZER_OPENCL ? TIMES : 8;
    fprintf(file, "\n%-12s %10s %10s %10s   ms, %u run%s\n", "", "min", "median", "max", options->runs,
            camber_plural(options->runs));
    for (size_t i = 0; i < count; i++)
        fprintf(file, "%-12s %10.3f %10.3f %10.3f\n", names[i], j->summaries[i].min, j->summaries[i].median,
                j->summaries[i].max);
    const double kernels_ms = j->summaries[5].median + j->summaries[6].median + j->summaries[7].median;
    if (kernels_ms > 0)
        fprintf(file, "\n%.1f million segments a second through the kernels, %.1f including the work of the host\n",
                (double)lines.kept_segments / kernels_ms / 1e3,
                (double)lines.kept_segments / j->summaries[0].median / 1e3);
    return taken ? CAMBER_EXIT_DONE : camber_report_flush(session->report);
}

/* The times are the result, and so are files, if some were asked for. */
static void say_done(const job *j) {
    const camber_options *options = j->session->options;
    char files[2048] = "";
    const char *const paths[] = {options->output, options->dump};
    const size_t sizes[] = {j->output_bytes, j->dump_bytes};
    for (size_t i = 0; i < 2; i++)
        if (paths[i])
            snprintf(files + strlen(files), sizeof files - strlen(files), ", %.900s (%s)",
                     strcmp(paths[i], "-") == 0 ? "standard output" : paths[i], camber_figure_bytes(sizes[i]).text);
    camber_report_done(j->session->report, "bench", 0, camber_session_elapsed_ms(j->session),
                       "%s run%s of %u x %u px%s", camber_figure_count(options->runs).text,
                       camber_plural(options->runs), j->width, j->height, files);
}

int camber_verb_bench(camber_session *session) {
    job j = {.session = session};
    int status = run(&j);
    if (status == CAMBER_EXIT_DONE)
        status = session->options->json ? print_json(&j) : print_text(&j);
    if (status == CAMBER_EXIT_DONE)
        say_done(&j);
    free(j.runs);
    free(j.pixels);
    camber_mesh_destroy(j.mesh);
    camber_input_close(&j.input);
    camber_output_discard(&j.dump);
    camber_output_discard(&j.output);
    return status;
}
