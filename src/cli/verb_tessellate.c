/* Runs `camber tessellate`: reads the input, projects and tessellates it, and writes the mesh with its paints as binary
 * glTF. */
#include "camber_proof.h"
#include "cli/input.h"
#include "cli/verbs.h"

#include <stdlib.h>

#ifdef CAMBER_MAP

typedef struct job {
    camber_session *session;
    camber_input input;
    camber_output output;
    camber_mesh *mesh;
    camber_paint *paints;
    camber_mesh_data data;
    camber_area_data areas;
    double tessellate_ms, write_ms, total_ms;
    size_t written_bytes;
} job;

/* The time that belongs to no stage: loading libraries, and opening the device and its kernels. Together with the times
 * of the stages it adds up to the total. */
static double start_ms(const job *j) {
    return j->total_ms - j->input.read_ms - j->input.scene_ms - j->tessellate_ms - j->write_ms;
}

/* A row gets the paint of the topmost pass that draws it. If there is a casing, this is the fill's paint. */
static bool gather_paints(job *j, size_t count) {
    j->paints = calloc(count ? count : 1, sizeof *j->paints);
    if (!j->paints)
        return false;
    const camber_frame frame = camber_input_frame(&j->input, j->mesh);
    for (size_t i = 0; i < frame.pass_count; i++)
        for (size_t row = 0; row < frame.passes[i].paint_count && row < count; row++)
            if (frame.passes[i].paints[row].width_px > 0)
                j->paints[row] = frame.passes[i].paints[row];
    return true;
}

static int write_mesh(job *j) {
    camber_session *session = j->session;
    const double began_ms = camber_now_ms();
    camber_glb_desc desc = {.copyright = j->input.attribution};
    desc.strokes = camber_input_strokes(&j->input, &desc.stroke_count);
    if (!gather_paints(j, desc.stroke_count))
        return camber_report_status(session->report, CAMBER_ERROR_MEMORY);
    desc.paints = j->paints;
    desc.areas = &j->areas;
    camber_report_step(session->report, "writing", NULL, 0, 0);
    const camber_status status = camber_glb_write(session->context, &j->data, &desc, camber_output_sink(&j->output));
    if (status != CAMBER_OK)
        return camber_output_status(&j->output, status);
    j->written_bytes = j->output.size_bytes;
    const int published = camber_output_publish(&j->output);
    j->write_ms = camber_now_ms() - began_ms;
    camber_report_erase_bar(session->report);
    return published;
}

static int run(job *j) {
    camber_session *session = j->session;
    int status = camber_output_open(&j->output, session->report, session->guard, session->options->output,
                                    session->options->force);
    if (status == CAMBER_EXIT_DONE)
        status = camber_session_need(session, CAMBER_NEEDS_DEVICE);
    if (status == CAMBER_EXIT_DONE)
        status = camber_input_open(&j->input, session);
    if (status == CAMBER_EXIT_DONE)
        status = camber_input_project(&j->input);
    if (status != CAMBER_EXIT_DONE)
        return status;
    camber_report_step(session->report, "tessellating", NULL, 0, 0);
    const double began_ms = camber_now_ms();
    camber_status made = camber_mesh_create(session->device, NULL, &j->mesh);
    if (made == CAMBER_OK)
        made = camber_input_tessellate(&j->input, j->mesh);
    if (made == CAMBER_OK)
        made = camber_mesh_read(j->mesh, &j->data);
    if (made == CAMBER_OK)
        made = camber_scene_triangulate(j->input.scene, &j->areas);
    j->tessellate_ms = camber_now_ms() - began_ms;
    if (made != CAMBER_OK)
        return camber_report_status(session->report, made);
    if (j->areas.index_count == 0)
        camber_input_warn_empty(&j->input, "the mesh is empty");
    return write_mesh(j);
}

static int print_json(const job *j) {
    const camber_session *session = j->session;
    (void)camber_scene_project(j->input.scene); /* counts are 0 if memory for them is exhausted */
    const camber_scene_info scene = camber_scene_get_info(j->input.scene);
    const camber_mesh_info *mesh = &j->data.info;
    json_t *object = json_pack(
        "{s:o, s:o, s:I, s:I, s:s, s:b, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "output",
        camber_json_text(session->options->output), "output_bytes", camber_json_count(j->written_bytes), "width",
        (json_int_t)scene.width, "height", (json_int_t)scene.height, "method", camber_method_get_name(mesh->method),
        "strips", mesh->strips, "features", camber_json_count(scene.features), "polylines",
        camber_json_count(scene.polylines), "points", camber_json_count(scene.points), "vertices",
        camber_json_count(mesh->vertex_count), "indices", camber_json_count(mesh->index_count), "triangles",
        camber_json_count(mesh->triangle_count), "joins", camber_json_count(mesh->joins));
    if (!object)
        return camber_report_json(session->report, NULL);
    json_object_set_new(object, "area_vertices", camber_json_count(j->areas.point_count));
    json_object_set_new(object, "area_triangles", camber_json_count(j->areas.index_count / 3));
    camber_session_describe(session, object);
    json_object_set_new(object, "start_ms", camber_json_ms(start_ms(j)));
    json_object_set_new(object, "read_ms", camber_json_ms(j->input.read_ms));
    json_object_set_new(object, "project_ms", camber_json_ms(j->input.scene_ms));
    json_object_set_new(object, "tessellate_ms", camber_json_ms(j->tessellate_ms));
    json_object_set_new(object, "write_ms", camber_json_ms(j->write_ms));
    json_object_set_new(object, "total_ms", camber_json_ms(j->total_ms));
    json_object_set_new(object, "peak_rss_bytes", camber_json_count(camber_peak_rss_bytes()));
    json_object_set_new(object, "attribution",
                        j->input.attribution ? camber_json_text(j->input.attribution) : json_null());
    return camber_report_json(session->report, object);
}

/* With --verbose. */
static void print_counts(const job *j, const camber_scene_info *scene) {
    camber_report *report = j->session->report;
    if (j->areas.index_count)
        camber_report_say(report, "areas: %s vertices, %s triangles", camber_figure_count(j->areas.point_count).text,
                          camber_figure_count(j->areas.index_count / 3).text);
    camber_report_say(report, "%s feature%s, %s polyline%s, %s point%s", camber_figure_count(scene->features).text,
                      camber_plural(scene->features), camber_figure_count(scene->polylines).text,
                      camber_plural(scene->polylines), camber_figure_count(scene->points).text,
                      camber_plural(scene->points));
    camber_report_say(report,
                      "start %.1f ms (device, kernels), read %.1f, project %.1f, tessellate %.1f, write %.1f; "
                      "in all %.1f ms",
                      start_ms(j), j->input.read_ms, j->input.scene_ms, j->tessellate_ms, j->write_ms, j->total_ms);
    camber_session_say_memory(j->session);
}

static void print_text(const job *j) {
    camber_session *session = j->session;
    camber_report *report = session->report;
    (void)camber_scene_project(j->input.scene); /* counts are 0 if memory for them is exhausted */
    const camber_scene_info scene = camber_scene_get_info(j->input.scene);
    const char *path = session->options->output;
    const size_t vertices = j->data.info.vertex_count + j->areas.point_count;
    const size_t triangles = j->data.info.triangle_count + j->areas.index_count / 3;
    if (report->verbose)
        print_counts(j, &scene);
    if (j->input.attribution)
        camber_report_say(report, "%s", j->input.attribution);
    camber_report_done(report, path[0] == '-' && !path[1] ? "mesh" : path, j->written_bytes, j->total_ms,
                       "%s vertices, %s triangle%s (%s)", camber_figure_count(vertices).text,
                       camber_figure_count(triangles).text, camber_plural(triangles),
                       camber_method_get_name(j->data.info.method));
}

int camber_verb_tessellate(camber_session *session) {
    job j = {.session = session};
    int status = run(&j);
    j.total_ms = camber_now_ms() - session->start_ms;
    if (status == CAMBER_EXIT_DONE && session->options->json)
        status = print_json(&j);
    else if (status == CAMBER_EXIT_DONE)
        print_text(&j);
    camber_area_data_destroy(&j.areas);
    camber_mesh_data_destroy(&j.data);
    free(j.paints);
    camber_mesh_destroy(j.mesh);
    camber_input_close(&j.input);
    camber_output_discard(&j.output);
    return status;
}

#endif
