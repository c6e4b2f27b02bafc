/* Runs `camber render`: reads the input, projects and tessellates it, and draws it into a picture. A summary of counts
 * and times goes to standard error, or to standard output as JSON. */
#include "cli/picture.h"
#include "cli/verbs.h"

#ifdef CAMBER_MAP

typedef struct job {
    camber_session *session;
    camber_input input;
    camber_output output;
    camber_mesh *mesh;
    double tessellate_ms;
    camber_picture_times times;
    double total_ms;
    size_t written_bytes;
} job;

/* The time that belongs to no stage: loading libraries, and opening the device and its kernels while files are read, as
 * far as it takes longer than reading. Together with the times of the stages it adds up to the total. */
static double start_ms(const job *j) {
    const camber_frame_stats *frame = &j->times.frame;
    return j->total_ms - j->input.read_ms - j->input.scene_ms - j->tessellate_ms - frame->draw_ms - frame->read_ms -
           j->times.write_ms;
}

/* Finds the picture's size: the sheet's, if there is one. */
static void find_size(const job *j, uint32_t *width, uint32_t *height) {
    const camber_scene_info scene = camber_scene_get_info(j->input.scene);
    const bool on_sheet = j->input.page != NULL;
    const camber_page_info sheet = on_sheet ? camber_page_get_info(j->input.page) : (camber_page_info){0};
    *width = on_sheet ? sheet.width : scene.width;
    *height = on_sheet ? sheet.height : scene.height;
}

static int draw(job *j) {
    camber_session *session = j->session;
    int status = camber_output_open(&j->output, session->report, session->guard, session->options->output,
                                    session->options->force);
    if (status == CAMBER_EXIT_DONE)
        status = camber_session_need(session, CAMBER_NEEDS_CONTEXT);
    if (status != CAMBER_EXIT_DONE)
        return status;
    session->opens_beside = true;
    status = camber_input_open(&j->input, session);
    if (status == CAMBER_EXIT_DONE)
        status = camber_input_project(&j->input);
    if (status == CAMBER_EXIT_DONE)
        status = camber_session_need(session, CAMBER_NEEDS_RENDERER);
    if (status != CAMBER_EXIT_DONE)
        return status;
    camber_report_step(session->report, "tessellating", NULL, 0, 0);
    const double began_ms = camber_now_ms();
    camber_status made = camber_mesh_create(session->device, session->renderer, &j->mesh);
    const bool vector = camber_format_is_vector(session->options->format);
    if (made == CAMBER_OK && !vector)
        made = camber_input_tessellate(&j->input, j->mesh);
    j->tessellate_ms = camber_now_ms() - began_ms;
    if (made != CAMBER_OK)
        return camber_report_status(session->report, made);
    if (camber_mesh_get_info(j->mesh).bytes == 0) /* nothing in the picture, or a page of vectors, which has no mesh */
        camber_input_warn_empty(&j->input, "nothing is drawn");
    status = vector ? camber_picture_write_page(&j->input, j->mesh, &j->output, &j->times)
                    : camber_picture_write(&j->input, j->mesh, &j->output, &j->times);
    j->written_bytes = j->output.size_bytes;
    return status;
}

static void put_counts(const job *j, const camber_scene_info *scene, const camber_mesh_info *mesh, json_t *object) {
    const camber_polylines_stats lines = j->input.drawn;
    const camber_features_stats read = camber_features_get_stats(j->input.features);
    const struct {
        const char *name;
        size_t count;
    } counts[] = {
        {"layers", scene->layers},
        {"features", scene->features},
        {"polylines", scene->polylines},
        {"points_in", scene->points_in},
        {"labels", scene->labels},
        {"closed_rings", read.closed_rings},
        {"turned_rings", read.turned_rings},
        {"empty_rings", read.empty_rings},
        {"open_relations", read.open_relations},
        {"crossing_rings", read.crossing_rings},
        {"spiked_rings", read.spiked_rings},
        {"outside_holes", read.outside_holes},
        {"missing_nodes", read.missing_nodes},
        {"missing_ways", read.missing_ways},
        {"dropped_relations", read.dropped_relations},
        {"antimeridian_splits", read.antimeridian_splits},
        {"points", lines.kept_points},
        {"segments", lines.kept_segments},
        {"joins", mesh->joins},
        {"vertices", mesh->vertex_count},
        {"triangles", mesh->triangle_count},
        {"draw_calls", j->times.frame.draw_calls},
        {"pieces", j->times.frame.areas},
        {"peak_rss_bytes", camber_peak_rss_bytes()},
    };
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        json_object_set_new(object, counts[i].name, camber_json_count(counts[i].count));
}

static int print_json(const job *j) {
    const camber_session *session = j->session;
    const camber_scene_info scene = camber_scene_get_info(j->input.scene);
    (void)camber_mesh_count_joins(j->mesh); /* a failure is logged, and the counts are 0 */
    const camber_mesh_info mesh = camber_mesh_get_info(j->mesh);
    uint32_t width, height;
    find_size(j, &width, &height);
    json_t *object = json_pack(
        "{s:o, s:I, s:I, s:o, s:f, s:f, s:f, s:f, s:f, s:s, s:s}", "output", camber_json_text(session->options->output),
        "width", (json_int_t)width, "height", (json_int_t)height, "output_bytes", camber_json_count(j->written_bytes),
        "longitude", scene.longitude, "latitude", scene.latitude, "zoom", scene.zoom, "bearing", scene.bearing_deg,
        "pitch", scene.pitch_deg, "method", camber_method_get_name(mesh.method), "coverage",
        session->options->coverage == CAMBER_COVERAGE_EXACT ? "exact" : "linear");
    if (!object)
        return camber_report_json(session->report, NULL);
    camber_session_describe(session, object);
    put_counts(j, &scene, &mesh, object);
    const struct {
        const char *name;
        double ms;
    } times[] = {
        {"start_ms", start_ms(j)},           {"read_ms", j->input.read_ms},
        {"project_ms", j->input.scene_ms},   {"tessellate_ms", j->tessellate_ms},
        {"draw_ms", j->times.frame.draw_ms}, {"read_back_ms", j->times.frame.read_ms},
        {"write_ms", j->times.write_ms},     {"total_ms", j->total_ms},
    };
    for (size_t i = 0; i < sizeof times / sizeof *times; i++)
        json_object_set_new(object, times[i].name, camber_json_ms(times[i].ms));
    json_object_set_new(object, "attribution",
                        j->input.attribution ? camber_json_text(j->input.attribution) : json_null());
    return camber_report_json(session->report, object);
}

/* Says what was made of the input; kernels have no draw calls. */
static void print_counts(const job *j, const camber_scene_info *scene) {
    (void)camber_mesh_count_joins(j->mesh); /* a failure is logged, and the counts are 0 */
    const camber_mesh_info mesh = camber_mesh_get_info(j->mesh);
    const size_t calls = j->times.frame.draw_calls;
    char drawn[64] = "drawn by OpenCL kernels";
    if (camber_renderer_get_rasterizer(j->session->renderer) == CAMBER_RASTERIZER_GL)
        snprintf(drawn, sizeof drawn, "%s draw call%s", camber_figure_count(calls).text, camber_plural(calls));
    camber_report_say(j->session->report, "%s feature%s, %s polyline%s, %s point%s, %s label%s, %s triangle%s (%s), %s",
                      camber_figure_count(scene->features).text, camber_plural(scene->features),
                      camber_figure_count(scene->polylines).text, camber_plural(scene->polylines),
                      camber_figure_count(scene->points).text, camber_plural(scene->points),
                      camber_figure_count(scene->labels).text, camber_plural(scene->labels),
                      camber_figure_count(mesh.triangle_count).text, camber_plural(mesh.triangle_count),
                      camber_method_get_name(mesh.method), drawn);
}

/* Says how many rings were invalid; usually none is. What was lost is always said, the rest with --verbose. */
static void print_rings(const job *j) {
    const camber_features_stats read = camber_features_get_stats(j->input.features);
    const struct {
        size_t count;
        const char *noun, *what;
        bool lost;
    } all[] = {{read.closed_rings, "ring", "closed", false},
               {read.turned_rings, "ring", "turned", false},
               {read.empty_rings, "ring", "without area left out", false},
               {read.crossing_rings, "self-crossing ring", "kept", false},
               {read.spiked_rings, "ring", "with a spike", false},
               {read.outside_holes, "hole", "filled outside of areas", false},
               {read.open_relations, "multipolygon", "lacking ways", false},
               {read.dropped_relations, "multipolygon", "left out", true}};
    char text[512] = "";
    size_t length = 0;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (all[i].count > 0 && (all[i].lost || j->session->report->verbose))
            length += (size_t)snprintf(text + length, sizeof text - length, "%s%s %s%s %s", length > 0 ? ", " : "",
                                       camber_figure_count(all[i].count).text, all[i].noun, camber_plural(all[i].count),
                                       all[i].what);
    if (length > 0)
        camber_report_say(j->session->report, "areas: %s", text);
}

static void print_times(const job *j) {
    camber_report_say(j->session->report,
                      "start %.1f ms (device, kernels), read %.1f, project %.1f, tessellate %.1f, draw %.1f, "
                      "read back %.1f, write %.1f; in all %.1f ms",
                      start_ms(j), j->input.read_ms, j->input.scene_ms, j->tessellate_ms, j->times.frame.draw_ms,
                      j->times.frame.read_ms, j->times.write_ms, j->total_ms);
    camber_session_say_memory(j->session);
}

/* Says how large the picture is: a sheet in mm, other pictures in px. */
static void put_size(const job *j, char *text, size_t size) {
    const camber_options *options = j->session->options;
    uint32_t width, height;
    find_size(j, &width, &height);
    if (camber_format_is_vector(options->format))
        snprintf(text, size, "%.4g x %.4g mm", options->paper_width_mm, options->paper_height_mm);
    else
        snprintf(text, size, "%s x %s px", camber_figure_count(width).text, camber_figure_count(height).text);
}

static void print_text(const job *j) {
    camber_session *session = j->session;
    camber_report *report = session->report;
    const camber_scene_info scene = camber_scene_get_info(j->input.scene);
    const char *path = session->options->output;
    char size[128];
    put_size(j, size, sizeof size);
    if (report->verbose)
        print_counts(j, &scene);
    print_rings(j);
    camber_input_say_missing(&j->input);
    camber_input_say_split(&j->input);
    if (report->verbose)
        print_times(j);
    if (j->input.attribution)
        camber_report_say(report, "%s", j->input.attribution);
    camber_report_done(report, path[0] == '-' && !path[1] ? "picture" : path, j->written_bytes, j->total_ms,
                       "%s, zoom %.2f at %.5f, %.5f", size, scene.zoom, scene.longitude, scene.latitude);
}

int camber_verb_render(camber_session *session) {
    job j = {.session = session};
    int status = draw(&j);
    j.total_ms = camber_now_ms() - session->start_ms;
    if (status == CAMBER_EXIT_DONE && session->options->json)
        status = print_json(&j);
    else if (status == CAMBER_EXIT_DONE)
        print_text(&j);
    camber_mesh_destroy(j.mesh);
    camber_input_close(&j.input);
    camber_output_discard(&j.output);
    return status;
}

#endif
