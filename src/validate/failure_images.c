/* Pictures of failures: truth, drawn and their difference beside each other. */
#include "validate/checks.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PICTURES_MAX = 32, SCALE = 8, SIDE_PX = 96 };

static bool is_empty(const char *folder) {
    DIR *directory = opendir(folder);
    bool empty = true;
    for (const struct dirent *entry; directory && (entry = readdir(directory)) != NULL;)
        empty = empty && (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0);
    if (directory)
        closedir(directory);
    return empty;
}

int camber_evidence_check(const camber_session *session) {
    const char *folder = session->options->pictures;
    struct stat info;
    if (!folder)
        return CAMBER_EXIT_DONE;
    if (stat(folder, &info) != 0) {
        /* It is made for the first picture, so that a run without failures leaves nothing. */
        const int made = mkdir(folder, 0777);
        if (made == 0)
            rmdir(folder);
        return made == 0
                   ? CAMBER_EXIT_DONE
                   : camber_report_fail(session->report, CAMBER_EXIT_CREATE,
                                        "%s: cannot be made (%s); name a folder that can", folder, strerror(errno));
    }
    if (!S_ISDIR(info.st_mode))
        return camber_report_fail(session->report, CAMBER_EXIT_CREATE, "%s: is no folder; name one", folder);
    if (access(folder, W_OK | X_OK) != 0)
        return camber_report_fail(session->report, CAMBER_EXIT_CREATE,
                                  "%s: cannot be written to (%s); name a folder that you may write to", folder,
                                  strerror(errno));
    if (!session->options->force && !is_empty(folder))
        return camber_report_fail(session->report, CAMBER_EXIT_CREATE,
                                  "%s: is not empty; name another folder, or replace what is there with --force",
                                  folder);
    return CAMBER_EXIT_DONE;
}

static bool is_wanted(const camber_validation *v) {
    return v->session->options->pictures && v->picture_count < PICTURES_MAX;
}

int camber_failure_image_write(camber_validation *v, camber_window window, const float *truth, const uint8_t *drawn,
                               camber_finding *finding) {
    camber_session *session = v->session;
    const char *folder = session->options->pictures;
    if (!is_wanted(v))
        return CAMBER_EXIT_DONE;
    const size_t size = strlen(folder) + 32;
    char *path = malloc(size);
    if (!path)
        return camber_report_status(session->report, CAMBER_ERROR_MEMORY);
    snprintf(path, size, "%s/check-%04zu.png", folder, v->verdicts.count + 1);
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        free(path);
        return camber_report_fail(session->report, CAMBER_EXIT_CREATE,
                                  "%s: cannot be made (%s); name a folder that can", folder, strerror(errno));
    }
    camber_output output = {0};
    int status = camber_output_open(&output, session->report, session->guard, path, session->options->force);
    if (status == CAMBER_EXIT_DONE) {
        const camber_status written =
            camber_difference_write(session->context, window, truth, drawn, SCALE, camber_output_sink(&output));
        status = written == CAMBER_OK ? camber_output_publish(&output) : camber_output_status(&output, written);
    }
    camber_output_discard(&output);
    if (status != CAMBER_EXIT_DONE) {
        free(path);
        return status;
    }
    v->picture_count++;
    finding->picture = path;
    return CAMBER_EXIT_DONE;
}

/* ---- Of a mesh ---- */

/* The lines with a point moved to the middle of the window, by whole pixels. */
static bool shift_lines(const camber_lines *lines, const camber_finding *finding, float **points) {
    const double dx = SIDE_PX / 2 - floor(finding->x), dy = SIDE_PX / 2 - floor(finding->y);
    *points = calloc(2 * lines->point_count + 1, sizeof **points);
    for (size_t i = 0; *points && i < lines->point_count; i++) {
        (*points)[2 * i] = (float)((double)lines->points[2 * i] + dx);
        (*points)[2 * i + 1] = (float)((double)lines->points[2 * i + 1] + dy);
    }
    return *points != NULL;
}

/* Whether GL can be given the mesh: its indices lead to vertices. */
static camber_status look_at_indices(camber_context *context, camber_mesh *mesh, bool *sound) {
    camber_mesh_data data = {0};
    const camber_status status = camber_mesh_read(mesh, &data);
    *sound = status == CAMBER_OK;
    for (size_t i = 0; *sound && i < data.info.index_count; i++)
        *sound = data.indices[i] < data.info.vertex_count || data.indices[i] == CAMBER_RESTART_INDEX;
    camber_mesh_data_free(context, &data);
    return status;
}

/* Draws nothing where the mesh is not fit for it. */
static camber_status draw_subject(camber_validation *v, const camber_drawing_path *path, const camber_subject *subject,
                                  const camber_tessellation_desc *desc, uint8_t *levels) {
    const camber_drawing drawing = {.strokes = desc->strokes,
                                    .stroke_count = desc->stroke_count,
                                    .width = SIDE_PX,
                                    .height = SIDE_PX,
                                    .coverage = (camber_coverage)v->session->options->coverage};
    camber_status status = camber_subject_tessellate(subject, path->mesh, desc);
    bool sound = false;
    if (status == CAMBER_OK)
        status = look_at_indices(v->session->context, path->mesh, &sound);
    if (status == CAMBER_OK && sound)
        status = camber_draw_levels(path, &drawing, levels);
    return status;
}

/* What the subject looks like in the window: its lines moved there, or the camera. */
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
        status = camber_polylines_create(v->session->context, &lines, &polylines);
        shifted.polylines = polylines;
    }
    if (status == CAMBER_OK)
        status = draw_subject(v, path, &shifted, desc, levels);
    camber_polylines_destroy(polylines);
    return status;
}

int camber_failure_image_of_mesh(camber_validation *v, const camber_checked_device *rig, const camber_subject *subject,
                                 const camber_tessellation_desc *desc, camber_finding *finding) {
    static const camber_window window = {0, 0, SIDE_PX, SIDE_PX};
    camber_subject shifted = *subject;
    if (!is_wanted(v) || !rig->easel_count || !finding->has_point || subject->lines.point_count == 0)
        return CAMBER_EXIT_DONE;
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
            made = draw_shifted(v, &rig->easels[0].paths[0], &shifted, desc, finding, levels);
    }
    int status = camber_report_status(v->session->report, made);
    if (status == CAMBER_EXIT_DONE)
        status = camber_failure_image_write(v, window, truth, levels, finding);
    free(levels);
    free(truth);
    free(shifted.lines.points);
    return status;
}
