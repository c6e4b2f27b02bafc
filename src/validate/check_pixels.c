/* Checks pictures: against the oracle in sampled windows, the sharing paths against each other, and GL back ends and
 * OpenCL against each other. */
#include "validate/levels.h"
#include "validate/samples.h"
#include "validate/scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Two layers with this alpha let less than half through, but not nothing. */
static const float TRANSLUCENT = 0.6f;

/* A subject in one style: its truth, and its pictures on one device with one method. */
typedef struct job {
    camber_validation *v;
    const camber_subject *s;
    const camber_checked_device *checked;
    camber_tessellation_desc desc;
    char style[64]; /* "round joins, butt caps" */
    bool is_drawn_once;
    bool is_shared; /* also try other sharing paths, for which the style does not matter */
    camber_samples samples;
    camber_pixel_bounds bounds;
    /* from the first back end; from this one; from it by another path or in another way */
    uint8_t *first, *own, *other;
    uint8_t *twice; /* drawn twice, translucent */
} job;

/* A few straight edges of a ramp can have larger errors than many edges; this does not depend on the camera. */
static camber_coverage coverage_of(const job *j) {
    return j->s->network ? CAMBER_COVERAGE_EXACT : (camber_coverage)j->v->desc->coverage;
}

static camber_drawing drawing_of(const job *j, camber_overlap overlap) {
    return (camber_drawing){.strokes = j->desc.strokes,
                            .stroke_count = j->desc.stroke_count,
                            .width = j->s->width,
                            .height = j->s->height,
                            .coverage = coverage_of(j),
                            .overlap = overlap,
                            .fills = j->s->fills};
}

static camber_status draw(const job *j, const camber_drawing_path *path, const camber_drawing *drawing,
                          uint8_t *levels) {
    const camber_status status = camber_subject_tessellate(j->s, path->mesh, &j->desc);
    return status == CAMBER_OK ? camber_draw_levels(path, drawing, levels) : status;
}

/* ---- Comparison with the truth ---- */

static camber_status check_truth(job *j, camber_check *check, camber_truth_kind kind, const uint8_t *levels) {
    size_t worst = 0;
    camber_status status = CAMBER_OK;
    camber_finding *finding = &check->finding;
    if (j->samples.count == 0) {
        camber_results_skip(&j->v->results, *check, "no point is in the picture");
        return status;
    }
    check->has_error = true;
    check->most =
        kind == CAMBER_TRUTH_OVER || j->s->fills ? j->bounds : camber_bounds_of_united(j->s->scene, j->bounds);
    camber_samples_compare(&j->samples, kind, levels, j->s->width, &check->error, &worst);
    if (!j->s->scene)
        check->most = camber_bounds_of_few(check->most, &check->error);
    if (camber_bounds_are_passed(&check->error.of, &check->most, finding)) {
        const camber_sample *sample = &j->samples.list[worst];
        check->result = CAMBER_RESULT_FAILED;
        finding->stage = "pixels";
        finding->has_point = true;
        finding->polyline = sample->polyline;
        finding->point = sample->point;
        finding->x = sample->x;
        finding->y = sample->y;
        snprintf(finding->what, sizeof finding->what,
                 "pixels: %s is %.4g, at most %.4g; worst in the %d x %d px at %d, %d, about polyline %zu, point %zu",
                 finding->field, finding->got, finding->expected, sample->window.width, sample->window.height,
                 sample->window.x0, sample->window.y0, sample->polyline, sample->point);
        uint8_t *cut = calloc((size_t)sample->window.width, (size_t)sample->window.height);
        if (!cut)
            return CAMBER_ERROR_MEMORY;
        camber_sample_cut(sample, levels, j->s->width, cut);
        status = camber_failure_image_write(j->v, sample->window, sample->truths[kind], cut, finding);
        free(cut);
    }
    if (status == CAMBER_OK)
        camber_results_add(&j->v->results, check);
    return status;
}

/* ---- Comparison of pictures ---- */

/* Writes an image of the window around the first pixel that differs, with the first picture as the truth. */
static camber_status show_pixel(job *j, const uint8_t *first, const uint8_t *second, size_t at,
                                camber_finding *finding) {
    enum { SIDE_PX = 48 };
    const int width = (int)j->s->width, height = (int)j->s->height;
    const int x = (int)(at % j->s->width) - SIDE_PX / 2, y = (int)(at / j->s->width) - SIDE_PX / 2;
    camber_window window = {x, y, width < SIDE_PX ? width : SIDE_PX, height < SIDE_PX ? height : SIDE_PX};
    window.x0 = x > width - window.width ? width - window.width : x < 0 ? 0 : x;
    window.y0 = y > height - window.height ? height - window.height : y < 0 ? 0 : y;
    float truth[SIDE_PX * SIDE_PX];
    uint8_t drawn[SIDE_PX * SIDE_PX];
    for (int i = 0; i < window.width * window.height; i++) {
        const size_t pixel =
            (size_t)(window.y0 + i / window.width) * j->s->width + (size_t)(window.x0 + i % window.width);
        truth[i] = (float)first[pixel] / 255.0f;
        drawn[i] = second[pixel];
    }
    return camber_failure_image_write(j->v, window, truth, drawn, finding);
}

/* Finds the first pixel in which two pictures differ. */
static bool first_pixel(const job *j, const uint8_t *first, const uint8_t *second, camber_finding *finding,
                        size_t *pixel) {
    const size_t count = (size_t)j->s->width * j->s->height;
    for (size_t i = 0; i < count; i++)
        if (first[i] != second[i]) {
            *pixel = i;
            finding->field = "level";
            finding->got = second[i];
            finding->expected = first[i];
            snprintf(finding->what, sizeof finding->what, "%s: pixel %zu, %zu: level %u, not %u", finding->stage,
                     i % j->s->width, i / j->s->width, second[i], first[i]);
            return true;
        }
    return false;
}

static camber_status meshes_differ(camber_checked_drawer *drawer, size_t path, camber_finding *finding, bool *differ) {
    camber_mesh_state first = {0}, other = {0};
    camber_status status = camber_mesh_state_read(drawer->paths[0].mesh, true, &first);
    if (status == CAMBER_OK)
        status = camber_mesh_state_read(drawer->paths[path].mesh, false, &other);
    if (status == CAMBER_OK)
        *differ = camber_mesh_states_differ(&other, &first, finding);
    camber_mesh_state_close(&first);
    camber_mesh_state_close(&other);
    return status;
}

/* Compares a sharing path with the first one: the bytes of the mesh and of the picture. */
static camber_status check_path(job *j, camber_checked_drawer *drawer, size_t path) {
    camber_check check =
        camber_check_start(j->checked->name, drawer->name, "%s: %s, %s: %s as %s, on %s, %s", j->s->name,
                           camber_method_get_name(j->desc.method), j->style, drawer->paths[path].name,
                           drawer->paths[0].name, j->checked->name, drawer->name);
    bool differ = false;
    size_t pixel = 0;
    const camber_drawing drawing = drawing_of(j, CAMBER_OVERLAP_FLATTEN);
    camber_status drawn = draw(j, &drawer->paths[path], &drawing, j->other);
    if (drawn == CAMBER_OK)
        drawn = meshes_differ(drawer, path, &check.finding, &differ);
    camber_status status = drawn;
    if (status != CAMBER_OK)
        return status;
    if (!differ) {
        check.finding.stage = "sharing";
        differ = first_pixel(j, j->own, j->other, &check.finding, &pixel);
        if (differ)
            status = show_pixel(j, j->own, j->other, pixel, &check.finding);
    }
    check.result = differ ? CAMBER_RESULT_FAILED : CAMBER_RESULT_PASSED;
    if (status == CAMBER_OK)
        camber_results_add(&j->v->results, &check);
    return status;
}

/* Compares one drawer's picture with the first drawer's picture. */
static camber_status check_drawer(job *j, const camber_checked_drawer *drawer) {
    camber_check check = camber_check_start(j->checked->name, drawer->name, "%s: %s, %s: %s as %s, on %s", j->s->name,
                                            camber_method_get_name(j->desc.method), j->style, drawer->name,
                                            j->checked->drawers[0].name, j->checked->name);
    size_t pixel = 0;
    check.has_error = true;
    check.most = camber_bounds_of_drawers(drawer->in_gl == j->checked->drawers[0].in_gl);
    camber_status status = camber_pictures_compare(j->first, j->own, j->s->width, j->s->height, &check.error);
    camber_finding past = {0};
    if (status == CAMBER_OK && camber_bounds_are_passed(&check.error.of, &check.most, &past)) {
        check.result = CAMBER_RESULT_FAILED;
        check.finding.stage = "back ends";
        if (first_pixel(j, j->first, j->own, &check.finding, &pixel))
            status = show_pixel(j, j->first, j->own, pixel, &check.finding);
    }
    if (status == CAMBER_OK)
        camber_results_add(&j->v->results, &check);
    return status;
}

/* ---- All checks ---- */

/* Compares the layers of translucent lines, drawn opaque, with the union of all lines. */
static camber_status check_united(job *j, const camber_checked_drawer *drawer) {
    camber_check check =
        camber_check_start(j->checked->name, drawer->name, "%s: %s, %s: united, on %s, %s", j->s->name,
                           camber_method_get_name(j->desc.method), j->style, j->checked->name, drawer->name);
    const camber_drawing drawing = drawing_of(j, CAMBER_OVERLAP_UNITE);
    const camber_status status = draw(j, &drawer->paths[0], &drawing, j->other);
    return status == CAMBER_OK ? check_truth(j, &check, CAMBER_TRUTH_UNION, j->other) : status;
}

/* The opaque layer, in j->other, determines how much two translucent layers let through. Levels are rounded, with an
 * error of at most a half: in the opaque layer, whose error is multiplied by 1.2 at alpha 0.6; in each of the two
 * layers, multiplied by 0.6; and when each is put onto the picture. The sum is 0.6 + 2 * 0.3 + 2 * 0.5. */
static bool layers_differ(const job *j, camber_finding *finding, size_t *pixel) {
    static const double MOST = 2.2;
    for (size_t i = 0; i < (size_t)j->s->width * j->s->height; i++) {
        const double through = 1.0 - TRANSLUCENT * j->other[i] / 255.0, expected = 255.0 * (1.0 - through * through);
        if (fabs(j->twice[i] - expected) <= MOST)
            continue;
        *pixel = i;
        *finding = (camber_finding){.stage = "layers", .field = "level", .got = j->twice[i], .expected = expected};
        snprintf(finding->what, sizeof finding->what,
                 "layers: pixel %zu, %zu: level %u of two layers at %.1f, not %.1f, because an opaque one has %u",
                 i % j->s->width, i / j->s->width, j->twice[i], (double)TRANSLUCENT, expected, j->other[i]);
        return true;
    }
    return false;
}

static camber_status check_translucent(job *j, const camber_checked_drawer *drawer) {
    camber_check check =
        camber_check_start(j->checked->name, drawer->name, "%s: %s, %s: two translucent layers, on %s, %s", j->s->name,
                           camber_method_get_name(j->desc.method), j->style, j->checked->name, drawer->name);
    camber_drawing drawing = drawing_of(j, CAMBER_OVERLAP_UNITE);
    drawing.passes = 2;
    drawing.alpha = TRANSLUCENT;
    size_t pixel = 0;
    camber_status status = draw(j, &drawer->paths[0], &drawing, j->twice);
    if (status == CAMBER_OK && layers_differ(j, &check.finding, &pixel)) {
        check.result = CAMBER_RESULT_FAILED;
        status = show_pixel(j, j->other, j->twice, pixel, &check.finding);
    }
    if (status == CAMBER_OK)
        camber_results_add(&j->v->results, &check);
    return status;
}

/* Checks that neighbouring segments share their edges to the last bit. */
static camber_status check_once(job *j, const camber_checked_drawer *drawer) {
    camber_check check =
        camber_check_start(j->checked->name, drawer->name, "%s: %s, %s: each pixel once, on %s, %s", j->s->name,
                           camber_method_get_name(j->desc.method), j->style, j->checked->name, drawer->name);
    camber_overdraw sum = {0};
    camber_finding *finding = &check.finding;
    const camber_drawing drawing = drawing_of(j, CAMBER_OVERLAP_FLATTEN);
    const camber_status status = camber_draw_count(&drawer->paths[0], &drawing, &sum);
    if (status != CAMBER_OK)
        return status;
    if (sum.repeated_pixels > 0) {
        check.result = CAMBER_RESULT_FAILED;
        *finding = (camber_finding){.stage = "pixels", .field = "repeated_pixels", .got = (double)sum.repeated_pixels};
        snprintf(finding->what, sizeof finding->what, "pixels: of %llu, %llu are drawn again by their line, not 0",
                 (unsigned long long)sum.drawn_pixels, (unsigned long long)sum.repeated_pixels);
    }
    camber_results_add(&j->v->results, &check);
    return status;
}

static camber_status check_drawn(job *j, size_t which) {
    camber_checked_drawer *drawer = (camber_checked_drawer *)&j->checked->drawers[which];
    camber_check check =
        camber_check_start(j->checked->name, drawer->name, "%s: %s, %s: pixels, on %s, %s", j->s->name,
                           camber_method_get_name(j->desc.method), j->style, j->checked->name, drawer->name);
    const camber_drawing drawing = drawing_of(j, CAMBER_OVERLAP_FLATTEN);
    camber_status status = draw(j, &drawer->paths[0], &drawing, j->own);
    if (status == CAMBER_OK)
        status = check_truth(j, &check, j->s->fills ? CAMBER_TRUTH_UNION : CAMBER_TRUTH_OVER, j->own);
    const bool unites = j->desc.method == CAMBER_METHOD_STRIP && !j->s->network && !j->s->fills;
    if (status == CAMBER_OK && unites)
        status = check_united(j, drawer);
    if (status == CAMBER_OK && unites && j->is_shared)
        status = check_translucent(j, drawer);
    const bool counts = drawer->in_gl && j->desc.method != CAMBER_METHOD_FAN;
    if (status == CAMBER_OK && j->is_drawn_once && counts)
        status = check_once(j, drawer);
    /* kernels draw any mesh in the same way as strips */
    const bool alike = drawer->in_gl == j->checked->drawers[0].in_gl;
    if (status == CAMBER_OK && which > 0 && (alike || j->desc.method == CAMBER_METHOD_STRIP))
        status = check_drawer(j, drawer);
    for (size_t path = 1; path < drawer->path_count && j->is_shared && status == CAMBER_OK; path++)
        status = check_path(j, drawer, path);
    if (which == 0)
        memcpy(j->first, j->own, (size_t)j->s->width * j->s->height);
    return status;
}

static camber_status check_device(job *j) {
    camber_status status = CAMBER_OK;
    /* Wrong indices can make a GPU hang for minutes, or crash it. */
    if (j->checked->broken[j->desc.method]) {
        camber_results_skip(&j->v->results,
                            camber_check_start(j->checked->name, NULL, "%s: %s, %s: pixels, on %s", j->s->name,
                                               camber_method_get_name(j->desc.method), j->style, j->checked->name),
                            "the mesh is not the CPU twin's");
        return status;
    }
    for (size_t e = 0; e < j->checked->drawer_count && status == CAMBER_OK; e++)
        status = check_drawn(j, e);
    return status;
}

static camber_status check_style(job *j) {
    camber_status status = CAMBER_OK;
    for (size_t r = 0; r < j->v->devices.count; r++)
        for (int method = 0; method < 3 && status == CAMBER_OK; method++) {
            j->checked = &j->v->devices.list[r];
            j->desc.method = (camber_method)method;
            if (camber_subject_takes(j->s, j->v->desc, j->desc.method) &&
                camber_draws_method(j->v->desc, j->desc.method))
                status = check_device(j);
        }
    return status;
}

/* Every join and every cap, and each variant of the shader that they need. */
static const struct {
    camber_join join;
    camber_cap cap;
} styles[] = {{CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND},
              {CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT},
              {CAMBER_JOIN_MITER, CAMBER_CAP_ROUND},
              {CAMBER_JOIN_MITER, CAMBER_CAP_SQUARE},
              {CAMBER_JOIN_BEVEL, CAMBER_CAP_BUTT}};

static void set_style(camber_stroke *stroke, size_t row, size_t number) {
    (void)row;
    stroke->join = styles[number].join;
    stroke->cap = styles[number].cap;
}

/* The bounds depend on the share of tight and split joins, which the twin counts. */
static camber_status find_bounds(job *j) {
    camber_context *context = j->v->desc->context;
    camber_mesh_data twin = {0};
    const camber_status status = camber_mesh_data_tessellate(context, j->s->polylines, &j->desc, &twin);
    const double joins = (double)(twin.info.joins ? twin.info.joins : 1);
    const double share = (double)(twin.info.tight_joins + twin.info.split_joins) / joins;
    camber_mesh_data_destroy(&twin);
    camber_bounds_of_pixels(j->s->fills ? "areas" : j->s->scene, share, coverage_of(j), &j->bounds);
    if (j->s->network && j->s->camera.simplify_px > 0)
        j->bounds = camber_bounds_of_simplified(j->bounds);
    return status;
}

static camber_status check_number(job *j, size_t number) {
    const camber_subject *s = j->s;
    const bool styled = s->scene && !s->network;
    camber_stroke *strokes =
        camber_strokes_styled(s->drawn_strokes, s->stroke_count, styled ? set_style : camber_style_kept, number);
    camber_status made = CAMBER_ERROR_MEMORY;
    j->desc.strokes = strokes;
    j->is_drawn_once = styled && strcmp(s->scene, CAMBER_SCENE_DRAWN_ONCE) == 0;
    j->is_shared = number == 0 && !s->network;
    if (!styled)
        snprintf(j->style, sizeof j->style, s->fills ? "filled" : "as styled");
    else
        snprintf(j->style, sizeof j->style, "%s joins, %s caps", camber_join_name(styles[number].join),
                 camber_cap_name(styles[number].cap));
    if (strokes)
        made = find_bounds(j);
    if (made == CAMBER_OK)
        made = camber_samples_make(s, strokes, j->v->desc->windows, &j->samples);
    camber_status status = made;
    if (status == CAMBER_OK)
        status = check_style(j);
    camber_samples_free(&j->samples);
    free(strokes);
    return status;
}

/* The truth is computed for the lines without offsets. */
static camber_status skip_offsets(camber_validation *v, const camber_subject *s) {
    camber_check check = camber_check_start(NULL, NULL, "%s: pixels", s->name);
    check.result = CAMBER_RESULT_SKIPPED;
    snprintf(check.reason, sizeof check.reason, "the lines have offsets, so they are not drawn where their points are");
    camber_results_add(&v->results, &check);
    return CAMBER_OK;
}

camber_status camber_check_pixels(camber_validation *validation, const camber_subject *subject) {
    const size_t area = (size_t)subject->width * subject->height;
    job j = {.v = validation, .s = subject, .desc = {.stroke_count = subject->stroke_count}};
    camber_status status = CAMBER_OK;
    if (!camber_bounds_of_pixels(subject->scene, 0, CAMBER_COVERAGE_EXACT, &j.bounds))
        return status;
    for (size_t i = 0; i < subject->stroke_count; i++)
        if (subject->drawn_strokes[i].offset_px < 0 || subject->drawn_strokes[i].offset_px > 0)
            return skip_offsets(validation, subject);
    j.first = malloc(area);
    j.own = malloc(area);
    j.other = malloc(area);
    j.twice = malloc(area);
    if (!j.first || !j.own || !j.other || !j.twice)
        status = CAMBER_ERROR_MEMORY;
    const size_t count = !subject->scene || subject->network ? 1 : sizeof styles / sizeof *styles;
    for (size_t number = 0; number < count && status == CAMBER_OK; number++)
        status = check_number(&j, number);
    free(j.twice);
    free(j.other);
    free(j.own);
    free(j.first);
    return status;
}
