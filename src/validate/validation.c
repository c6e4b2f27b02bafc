/* Runs the checks: input is a desc and, optionally, a user's lines; output is the results, in groups. The made-up
 * scenes and the input are subjects, which the functions of check_*.c check one after the other. */
#include "validate/validation.h"

#include "validate/checks.h"
#include "validate/scenes.h"

#define NETWORKS "%s: networks under five cameras" /* name of a group */

static camber_status check_lines(camber_validation *v, const camber_subject *s) {
    camber_results *results = &v->results;
    camber_status status = CAMBER_OK;
    if (camber_results_group(results, "%s: meshes as the CPU twin's", s->name))
        status = camber_check_meshes(v, s);
    if (status == CAMBER_OK && camber_results_group(results, "%s: pictures as the CPU twin's", s->name))
        status = camber_check_drawing(v, s);
    if (status == CAMBER_OK && camber_results_group(results, "%s: pixels as the oracle's", s->name))
        status = camber_check_pixels(v, s);
    return status;
}

/* All widths for which a kernel or a shader has a special case. Pictures use scene_drawn_strokes instead, because the
 * largest of these widths would cover everything. */
static const camber_stroke scene_strokes[CAMBER_SCENE_ROWS] = {{.width_px = 0.3f, .miter_limit = 1},
                                                               {.width_px = 2, .miter_limit = 0},
                                                               {.width_px = 9, .miter_limit = 10},
                                                               {.width_px = 64, .miter_limit = 4, .round_limit = 1.3f},
                                                               {.width_px = 1, .miter_limit = 2}};
/* The third row is CAMBER_SCENE_WIDTH_ROW. */
static const camber_stroke scene_drawn_strokes[CAMBER_SCENE_ROWS] = {
    {.width_px = 0.4f, .miter_limit = 1},
    {.width_px = 3, .miter_limit = 0},
    {.width_px = CAMBER_SCENE_WIDTH_PX, .miter_limit = 10},
    {.width_px = 20, .miter_limit = 4, .round_limit = 1.3f},
    {.width_px = 1, .miter_limit = 2}};

static camber_status check_scene(camber_validation *v, size_t number) {
    camber_made_scene scene;
    camber_polylines *polylines = NULL;
    camber_status status = CAMBER_ERROR_MEMORY;
    if (camber_checked_scene_make(number, &scene)) {
        const camber_polylines_desc desc = camber_made_scene_polylines(&scene);
        status = camber_polylines_create(v->desc->context, &desc, &polylines);
    }
    if (status == CAMBER_OK) {
        const camber_subject s = {
            .name = scene.name,
            .scene = scene.name,
            .lines = {.points = scene.points,
                      .offsets = scene.offsets,
                      .point_count = scene.point_count,
                      .polyline_count = scene.polyline_count},
            .rows = scene.rows,
            .polylines = polylines,
            .strokes = scene_strokes,
            .drawn_strokes = scene_drawn_strokes,
            .stroke_count = CAMBER_SCENE_ROWS,
            .width = CAMBER_SCENE_SIDE_PX,
            .height = CAMBER_SCENE_SIDE_PX,
        };
        status = check_lines(v, &s);
        if (status == CAMBER_OK && camber_results_group(&v->results, NETWORKS, s.name))
            status = camber_check_networks(v, &s, NULL, NULL, NULL);
    }
    camber_polylines_destroy(polylines);
    camber_made_scene_free(&scene);
    return status;
}

static camber_status check_input(camber_validation *v, const camber_validation_input *input) {
    const char *name = input->subject.name;
    camber_status status = check_lines(v, &input->subject);
    if (status == CAMBER_OK && camber_results_group(&v->results, NETWORKS, name))
        status = camber_check_networks(v, &input->subject, input->network, &input->camera, &input->strokes);
    if (status == CAMBER_OK && input->frame.pass_count && camber_results_group(&v->results, "%s: areas", name))
        status = camber_check_areas(v, &input->map, &input->frame);
    return status;
}

camber_status camber_validation_run(camber_validation *v, const camber_validation_desc *desc,
                                    const camber_validation_input *input) {
    const size_t count = input ? 1 : camber_checked_scene_count();
    *v = (camber_validation){.desc = desc, .results = {.listener = desc->listener, .only = desc->only}};
    camber_results_group(&v->results, "devices and back ends");
    camber_status status = camber_checked_devices_open(v);
    v->results.wanted = 0; /* this group does not count, because devices are opened in any case */
    for (size_t i = 0; i < count && status == CAMBER_OK; i++) {
        if (desc->host.progress)
            desc->host.progress(desc->host.user, i, count);
        status = input ? check_input(v, input) : check_scene(v, i);
    }
    if (status == CAMBER_OK && !input && camber_results_group(&v->results, "offset lines"))
        status = camber_check_offsets(v);
    if (status == CAMBER_OK && !input)
        status = camber_check_along(v);
    camber_results_end(&v->results);
    return status;
}

void camber_validation_close(camber_validation *v) {
    camber_results_close(&v->results);
    camber_checked_devices_close(&v->devices);
}
