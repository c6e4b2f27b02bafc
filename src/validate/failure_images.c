/* Images of failures: truth, drawn and their difference next to each other. The host decides where to write them. */
#include "validate/checks.h"
#include "validate/levels.h"

#include <math.h>
#include <stdlib.h>

enum { PICTURES_MAX = 32, SIDE_PX = 96 };

static bool is_wanted(const camber_validation *v) {
    return v->desc->host.write_image && v->picture_count < PICTURES_MAX;
}

camber_status camber_failure_image_write(camber_validation *v, camber_window window, const float *truth,
                                         const uint8_t *drawn, camber_finding *finding) {
    const camber_failure_image image = {v->results.count + 1, window, truth, drawn};
    if (!is_wanted(v))
        return CAMBER_OK;
    const camber_status status = v->desc->host.write_image(v->desc->host.user, &image, &finding->picture);
    v->picture_count += status == CAMBER_OK;
    return status;
}

/* ---- A mesh ---- */

/* Copies the lines, shifted by whole pixels so that a point is in the middle of the window. */
static bool shift_lines(const camber_lines *lines, const camber_finding *finding, float **points) {
    const double dx = SIDE_PX / 2 - floor(finding->x), dy = SIDE_PX / 2 - floor(finding->y);
    *points = calloc(2 * lines->point_count + 1, sizeof **points);
    for (size_t i = 0; *points && i < lines->point_count; i++) {
        (*points)[2 * i] = (float)((double)lines->points[2 * i] + dx);
        (*points)[2 * i + 1] = (float)((double)lines->points[2 * i + 1] + dy);
    }
    return *points != NULL;
}

/* Whether GL can draw the mesh safely: all its indices refer to vertices. */
static camber_status look_at_indices(camber_mesh *mesh, bool *sound) {
    camber_mesh_data data = {0};
    const camber_status status = camber_mesh_read(mesh, &data);
    *sound = status == CAMBER_OK;
    for (size_t i = 0; *sound && i < data.info.index_count; i++)
        *sound = data.indices[i] < data.info.vertex_count || data.indices[i] == CAMBER_RESTART_INDEX;
    camber_mesh_data_destroy(&data);
    return status;
}

/* Draws the subject, or nothing if the mesh cannot be drawn safely. */
static camber_status draw_subject(camber_validation *v, const camber_drawing_path *path, const camber_subject *subject,
                                  const camber_tessellation_desc *desc, uint8_t *levels) {
    const camber_drawing drawing = {.strokes = desc->strokes,
                                    .stroke_count = desc->stroke_count,
                                    .width = SIDE_PX,
                                    .height = SIDE_PX,
                                    .coverage = (camber_coverage)v->desc->coverage};
    camber_status status = camber_subject_tessellate(subject, path->mesh, desc);
    bool sound = false;
    if (status == CAMBER_OK)
        status = look_at_indices(path->mesh, &sound);
    if (status == CAMBER_OK && sound)
        status = camber_draw_levels(path, &drawing, levels);
    return status;
}

/* Draws the subject in the window, after moving its lines or the camera. */
static camber_status draw_shifted(camber_validation *v, const camber_drawing_path *path, const camber_subject *subject,
                                  const camber_tessellation_desc *desc, const camber_finding *finding,
                                  uint8_t *levels) {
    const camber_polylines_desc lines = {subject->lines.points,  subject->lines.point_count,
                                         subject->lines.offsets, subject->lines.polyline_count,
                                         subject->rows,          subject->keep_open};
    camber_subject shifted = *subject;
    camber_polylines *polylines = NULL;
    camber_status status = CAMBER_OK;
    if (subject->network) {
        camber_camera_center(&shifted.camera, floor(finding->x), floor(finding->y));
        shifted.camera.width = shifted.camera.height = SIDE_PX;
    } else {
        status = camber_polylines_create(v->desc->context, &lines, &polylines);
        shifted.polylines = polylines;
    }
    if (status == CAMBER_OK)
        status = draw_subject(v, path, &shifted, desc, levels);
    camber_polylines_destroy(polylines);
    return status;
}

camber_status camber_failure_image_of_mesh(camber_validation *v, const camber_checked_device *checked,
                                           const camber_subject *subject, const camber_tessellation_desc *desc,
                                           camber_finding *finding) {
    static const camber_window window = {0, 0, SIDE_PX, SIDE_PX};
    camber_subject shifted = *subject;
    if (!is_wanted(v) || !checked->drawer_count || !finding->has_point || subject->lines.point_count == 0)
        return CAMBER_OK;
    float *truth = calloc(SIDE_PX * SIDE_PX, sizeof *truth);
    uint8_t *levels = calloc(SIDE_PX, SIDE_PX);
    camber_status made = CAMBER_ERROR_MEMORY;
    if (shift_lines(&subject->lines, finding, &shifted.lines.points) && truth && levels) {
        const camber_truth_desc truths = {.lines = &shifted.lines,
                                          .rows = subject->rows,
                                          .strokes = desc->strokes,
                                          .keep_open = subject->keep_open,
                                          .kind = CAMBER_TRUTH_OVER};
        if (camber_truth_make(&truths, window, truth))
            made = draw_shifted(v, &checked->drawers[0].paths[0], &shifted, desc, finding, levels);
    }
    camber_status status = made;
    if (status == CAMBER_OK)
        status = camber_failure_image_write(v, window, truth, levels, finding);
    free(levels);
    free(truth);
    free(shifted.lines.points);
    return status;
}
