/* Compares the kernels that draw with their CPU twin, stage by stage and byte for byte. Also compares drawing in slices
 * with drawing at once. */
#include "validate/checks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PASSES = 3, SIDE_PX = 2048, RECORDS_MAX = 1 << 20 };
/* The side of the picture of a made-up scene, unless all checks are requested: the twin takes longer than everything
 * else. */
enum { PART_PX = 512 };

/* ---- The picture: crossing lines, a united layer, and a group ---- */

/* Fills of consecutive rows. */
static const camber_fill fills[] = {{.color = {1, 0.5f, 0, 1}},
                                    {.color = {0, 0.5f, 1, 0.5f}, .rule = CAMBER_FILL_EVENODD}};

/* Kernels are built in variants: without rails next to the lines, with them, and for planes that are seen at an
 * angle. */
static const struct {
    const char *name;
    float gap_px, blur_px;
    double pitch_deg;
    bool fills; /* also fills the inside of the lines */
} variants[] = {{"", 0, 0, 0, false},
                {", gaps and blurs", 1.5f, 0.8f, 0, false},
                {", at 40 degrees", 0, 0, 40, false},
                {", areas", 0, 0, 0, true}};
enum { VARIANTS = sizeof variants / sizeof *variants, AREAS = VARIANTS - 1 };

typedef struct drawn {
    camber_paint *paints; /* of a pass, stroke_count of them */
    camber_pass passes[PASSES];
    camber_frame frame;
} drawn;

static camber_color color_of(size_t row, size_t pass) {
    const size_t i = row + 2 * pass;
    const float alphas[PASSES] = {1.0f, 0.5f, row % 2 ? 1.0f : 0.6f};
    return (camber_color){0.2f * (float)(i % 6), 1.0f - 0.2f * (float)(i % 5), 0.25f * (float)(i % 4), alphas[pass]};
}

static bool make_frame(const camber_subject *s, const camber_validation_desc *desc, camber_mesh *mesh, int variant,
                       drawn *d) {
    static const float widths[PASSES] = {1.0f, 0.6f, 0.3f};
    const uint32_t side = s->scene && !desc->full ? PART_PX : SIDE_PX;
    *d = (drawn){.paints = calloc(PASSES * s->stroke_count + 1, sizeof *d->paints)};
    if (!d->paints)
        return false;
    for (size_t pass = 0; pass < PASSES; pass++) {
        camber_paint *paints = d->paints + pass * s->stroke_count;
        for (size_t row = 0; row < s->stroke_count; row++)
            paints[row] = (camber_paint){.width_px = widths[pass] * s->strokes[row].width_px,
                                         .color = pass == 1 ? color_of(0, 1) : color_of(row, pass),
                                         .translate_x_px = pass == 2 ? 1.5f : 0.0f,
                                         .gap_px = row % 2 ? variants[variant].gap_px : 0.0f,
                                         .blur_px = pass == 2 ? variants[variant].blur_px : 0.0f,
                                         .fill = variants[variant].fills && pass != 1 ? fills + row % 2 : NULL};
        d->passes[pass] = (camber_pass){.mesh = mesh, .paints = paints, .paint_count = s->stroke_count};
    }
    d->passes[1].overlap = CAMBER_OVERLAP_UNITE;
    d->passes[1].upright = true; /* makes a difference with a pitch */
    d->passes[2].overlap = CAMBER_OVERLAP_ACCUMULATE;
    d->passes[2].opacity = 0.7f;
    d->frame = (camber_frame){.width = s->width < side ? s->width : side,
                              .height = s->height < side ? s->height : side,
                              .background = {0.2f, 0.3f, 0.4f, 0.5f},
                              .passes = d->passes,
                              .pass_count = PASSES,
                              .coverage = (camber_coverage)desc->coverage,
                              .pitch_deg = variants[variant].pitch_deg};
    return true;
}

/* ---- Differences ---- */

static bool tell(camber_finding *finding, const char *stage, const char *where, double got, double expected) {
    finding->stage = stage;
    finding->got = got;
    finding->expected = expected;
    snprintf(finding->what, sizeof finding->what, "%s: %s is %s, not %s", stage, where, camber_value_print(got).text,
             camber_value_print(expected).text);
    return true;
}

static bool boxes_differ(const camber_drawing_stages *got, const camber_drawing_stages *expected,
                         camber_finding *finding) {
    char where[96];
    finding->field = "tiles";
    if (got->segment_count != expected->segment_count)
        return tell(finding, "setup", "the number of segments", (double)got->segment_count,
                    (double)expected->segment_count);
    for (size_t i = 0; i < expected->segment_count; i++)
        if (got->boxes[i] != expected->boxes[i]) {
            snprintf(where, sizeof where, "the box of segment %zu", i);
            return tell(finding, "setup", where, got->boxes[i], expected->boxes[i]);
        }
    return false;
}

/* Compares the words of segments; each segment has `words` of them. The words of segments that are not drawn are
 * undefined, so they are skipped. */
static bool words_differ(const char *field, const float *got, const float *expected, size_t words,
                         const camber_drawing_stages *of, camber_finding *finding) {
    char where[96];
    finding->field = field;
    for (size_t i = 0; i < words * of->segment_count; i++) {
        const uint32_t box = of->boxes[i / words];
        if ((box & 255u) > (box >> 16 & 255u) || memcmp(got + i, expected + i, sizeof(float)) == 0)
            continue;
        snprintf(where, sizeof where, "word %zu of segment %zu's %s", i % words, i / words, field);
        return tell(finding, "setup", where, (double)got[i], (double)expected[i]);
    }
    return false;
}

static bool shapes_differ(const camber_drawing_stages *got, const camber_drawing_stages *expected,
                          camber_finding *finding) {
    return words_differ("setup", got->segments, expected->segments, expected->segment_words, expected, finding) ||
           (expected->arc_lengths && words_differ("measures", got->arc_lengths, expected->arc_lengths,
                                                  expected->arc_length_words, expected, finding)) ||
           (expected->planes &&
            words_differ("plane", got->planes, expected->planes, expected->plane_words, expected, finding));
}

static bool lists_differ(const camber_drawing_stages *got, const camber_drawing_stages *expected,
                         camber_finding *finding) {
    const size_t tiles = (size_t)expected->columns * expected->rows;
    char where[96];
    for (size_t i = 0; i <= tiles; i++)
        if (got->starts[i] != expected->starts[i]) {
            finding->field = "starts";
            snprintf(where, sizeof where, "where the list of tile %zu, %zu begins", i % expected->columns,
                     i / expected->columns);
            return tell(finding, "count", where, got->starts[i], expected->starts[i]);
        }
    for (size_t i = 0; i < expected->starts[tiles]; i++)
        if (got->lists[i] != expected->lists[i]) {
            finding->field = "lists";
            snprintf(where, sizeof where, "entry %zu of all lists", i);
            return tell(finding, "fill", where, got->lists[i], expected->lists[i]);
        }
    return false;
}

static bool pixels_differ(const camber_drawing_stages *got, const camber_drawing_stages *expected,
                          camber_finding *finding) {
    char where[96];
    finding->field = "rgba";
    for (size_t i = 0; i < 4 * (size_t)expected->width * expected->height; i++)
        if (got->rgba[i] != expected->rgba[i]) {
            snprintf(where, sizeof where, "channel %zu of pixel %zu, %zu", i % 4, i / 4 % expected->width,
                     i / 4 / expected->width);
            return tell(finding, "cover", where, got->rgba[i], expected->rgba[i]);
        }
    return false;
}

/* Compares stage by stage, because later stages inherit the errors of earlier ones. */
static bool stages_differ(const camber_drawing_stages *got, const camber_drawing_stages *expected,
                          camber_finding *finding) {
    return boxes_differ(got, expected, finding) || shapes_differ(got, expected, finding) ||
           lists_differ(got, expected, finding) || pixels_differ(got, expected, finding);
}

/* ---- The check ---- */

static camber_status compare_frame(camber_renderer *renderer, const camber_frame *frame, camber_check *check) {
    camber_drawing_stages got = {0}, expected = {0};
    camber_status status = camber_renderer_read_stages(renderer, frame, &got);
    if (status == CAMBER_OK)
        status = camber_drawing_stages_rasterize(renderer, frame, &expected);
    if (status == CAMBER_OK && stages_differ(&got, &expected, &check->finding))
        check->result = CAMBER_RESULT_FAILED;
    camber_drawing_stages_destroy(&got);
    camber_drawing_stages_destroy(&expected);
    return status;
}

static camber_status compare(const camber_validation *v, const camber_subject *s, const camber_drawing_path *path,
                             int variant, camber_check *check) {
    drawn d;
    if (!make_frame(s, v->desc, path->mesh, variant, &d))
        return CAMBER_ERROR_MEMORY;
    const camber_status status = compare_frame(path->renderer, &d.frame, check);
    free(d.paints);
    return status;
}

/* Returns how many records a mesh has, or would have if it were not drawn from its points. */
static size_t count_records(camber_mesh *mesh) {
    (void)camber_mesh_count_joins(mesh); /* a failure is logged, and the count is 0 */
    return camber_mesh_get_info(mesh).record_count;
}

static bool is_long(camber_mesh *mesh) {
    return count_records(mesh) > RECORDS_MAX;
}

/* Adds a check that was run. It is skipped if it needs larger buffers, or has no stages to compare. */
static camber_status end_check(camber_validation *v, camber_check *check, camber_status status) {
    char reason[sizeof check->reason];
    if (status == CAMBER_ERROR_LIMIT) {
        v->desc->host.take_message(v->desc->host.user, reason, sizeof reason);
        camber_results_skip(&v->results, *check, reason);
        return CAMBER_OK;
    }
    if (status == CAMBER_OK)
        camber_results_add(&v->results, check);
    return status;
}

static const char too_long[] = "there are more than a million points, which take the twin minutes";

/* The kernels that draw, with the device's own vector width or the other one. */
typedef struct kernels {
    const char *name, *how;
    camber_drawing_path path;
    int variant;
} kernels;

static camber_status check_method(camber_validation *v, const camber_subject *s, const camber_checked_device *checked,
                                  const kernels *on, camber_method method) {
    const camber_tessellation_desc desc = {s->strokes, s->stroke_count, method, 0, false};
    camber_check check =
        camber_check_start(checked->name, on->name, "%s: %s%s: drawn as by the CPU twin%s, on %s", s->name,
                           camber_method_get_name(method), variants[on->variant].name, on->how, checked->name);
    if (checked->broken[method]) {
        camber_results_skip(&v->results, check, "the mesh is not the CPU twin's");
        return CAMBER_OK;
    }
    camber_status made = camber_subject_tessellate(s, on->path.mesh, &desc);
    if (made == CAMBER_OK && is_long(on->path.mesh)) {
        camber_results_skip(&v->results, check, too_long);
        return CAMBER_OK;
    }
    if (made == CAMBER_OK)
        made = compare(v, s, &on->path, on->variant, &check);
    return end_check(v, &check, made);
}

static camber_status check_methods(camber_validation *v, const camber_subject *s, const camber_checked_device *checked,
                                   const kernels *on) {
    camber_status status = CAMBER_OK;
    for (int m = CAMBER_METHOD_STRIP; m <= CAMBER_METHOD_FAN && status == CAMBER_OK; m++)
        if (camber_subject_takes(s, v->desc, (camber_method)m) && camber_draws_method(v->desc, (camber_method)m))
            status = check_method(v, s, checked, on, (camber_method)m);
    return status;
}

static camber_status open_path(camber_device *device, camber_drawing_path *path) {
    const camber_status status = camber_renderer_create(device, NULL, NULL, &path->renderer);
    return status == CAMBER_OK ? camber_mesh_create(device, path->renderer, &path->mesh) : status;
}

static void close_path(camber_drawing_path *path) {
    camber_mesh_destroy(path->mesh);
    camber_renderer_destroy(path->renderer);
}

/* Checks with the vector width of the n-th of the device's other work-groups. Areas are checked, too, because vectors
 * of another width process other rows and columns of cells. */
static camber_status check_lanes(camber_validation *v, const camber_subject *s, const camber_checked_device *checked,
                                 const char *name, size_t n) {
    camber_device *device = checked->groups[n].device;
    char how[32];
    snprintf(how, sizeof how, ", with lanes: %u", checked->groups[n].lanes);
    kernels on = {.name = name, .how = how};
    camber_status status = open_path(device, &on.path);
    if (status == CAMBER_OK)
        status = check_methods(v, s, checked, &on);
    on.variant = AREAS;
    if (status == CAMBER_OK)
        status = check_methods(v, s, checked, &on);
    close_path(&on.path);
    return status;
}

/* ---- Slices, between which tiles are spilled ---- */

/* Bytes of a segment in the buffer of segments; the largest number of bytes that a tile spills. */
enum { SEGMENT_BYTES = 64, TILE_BYTES = 160 * 1024 };

/* Returns a memory limit with which the frame is drawn in slices: in three, if the spill of a tile fits. Returns 0 if
 * there are too few segments. */
static uint64_t slice_bytes(camber_mesh *mesh) {
    const uint64_t all = PASSES * (uint64_t)count_records(mesh) * SEGMENT_BYTES;
    const uint64_t wanted = all / 3 > TILE_BYTES ? all / 3 : TILE_BYTES;
    return wanted < all ? wanted : 0;
}

/* Draws the frame's picture, and leaves the other stages empty. The caller frees it. */
static camber_status draw_picture(camber_renderer *renderer, const camber_frame *frame,
                                  camber_drawing_stages *picture) {
    *picture = (camber_drawing_stages){.width = frame->width, .height = frame->height};
    picture->rgba = malloc(4 * (size_t)frame->width * frame->height);
    return picture->rgba ? camber_renderer_render_into(renderer, frame, picture->rgba, 0, NULL) : CAMBER_ERROR_MEMORY;
}

/* Skips the check if the frame has stages to read, which means that it was drawn in one slice. */
static camber_status want_slices(const camber_validation *v, camber_renderer *renderer, const camber_frame *frame,
                                 camber_check *check) {
    camber_drawing_stages stages = {0};
    char message[sizeof check->reason];
    const camber_status status = camber_renderer_read_stages(renderer, frame, &stages);
    camber_drawing_stages_destroy(&stages);
    if (status == CAMBER_ERROR_LIMIT) {
        v->desc->host.take_message(v->desc->host.user, message, sizeof message);
        return CAMBER_OK;
    }
    if (status == CAMBER_OK) {
        check->result = CAMBER_RESULT_SKIPPED;
        snprintf(check->reason, sizeof check->reason, "one slice holds it all");
    }
    return status;
}

/* small: the same mesh, on a device with small buffers. */
static camber_status compare_slices(const camber_validation *v, const camber_subject *s,
                                    const camber_drawing_path *whole, const camber_drawing_path *small, int variant,
                                    camber_check *check) {
    camber_drawing_stages expected = {0}, got = {0};
    drawn on_whole = {0}, on_small = {0};
    const bool made = make_frame(s, v->desc, whole->mesh, variant, &on_whole) &&
                      make_frame(s, v->desc, small->mesh, variant, &on_small);
    camber_status status = made ? draw_picture(whole->renderer, &on_whole.frame, &expected) : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK)
        status = draw_picture(small->renderer, &on_small.frame, &got);
    if (status == CAMBER_OK)
        status = want_slices(v, small->renderer, &on_small.frame, check);
    if (status == CAMBER_OK && pixels_differ(&got, &expected, &check->finding))
        check->result = CAMBER_RESULT_FAILED;
    free(expected.rgba);
    free(got.rgba);
    free(on_whole.paints);
    free(on_small.paints);
    return status;
}

/* Checks one variant. reason: why the check cannot be run; otherwise NULL. */
static camber_status check_sliced(camber_validation *v, const camber_subject *s, const camber_checked_device *checked,
                                  const camber_checked_drawer *drawer, const camber_drawing_path *small, int variant,
                                  const char *reason) {
    camber_check check =
        camber_check_start(checked->name, drawer->name, "%s: strip%s: the same pixels in slices, on %s", s->name,
                           variants[variant].name, checked->name);
    if (reason) {
        camber_results_skip(&v->results, check, reason);
        return CAMBER_OK;
    }
    return end_check(v, &check, compare_slices(v, s, drawer->paths, small, variant, &check));
}

static camber_status check_slices(camber_validation *v, const camber_subject *s, const camber_checked_device *checked,
                                  const camber_checked_drawer *drawer) {
    const camber_tessellation_desc desc = {s->strokes, s->stroke_count, CAMBER_METHOD_STRIP, 0, false};
    camber_drawing_path small = {0};
    camber_device *device = NULL;
    char message[sizeof((camber_check){0}).reason];
    camber_status status = camber_subject_tessellate(s, drawer->paths[0].mesh, &desc);
    const uint64_t bytes = slice_bytes(drawer->paths[0].mesh);
    const char *reason = bytes == 0                             ? "there are too few segments for slices"
                         : checked->broken[CAMBER_METHOD_STRIP] ? "the mesh is not the CPU twin's"
                                                                : NULL;
    if (status == CAMBER_OK && !reason)
        status = camber_checked_device_open_small(checked, v, bytes, &device, NULL);
    if (status == CAMBER_OK && !reason)
        status = open_path(device, &small);
    if (status == CAMBER_OK && !reason)
        status = camber_subject_tessellate(s, small.mesh, &desc);
    if (status == CAMBER_ERROR_LIMIT) {
        v->desc->host.take_message(v->desc->host.user, message, sizeof message);
        reason = message;
        status = CAMBER_OK;
    }
    for (int i = 0; i < VARIANTS && status == CAMBER_OK; i++)
        status = check_sliced(v, s, checked, drawer, &small, i, reason);
    close_path(&small);
    camber_device_destroy(device);
    return status;
}

camber_status camber_check_drawing(camber_validation *v, const camber_subject *s) {
    const bool takes_strips = camber_subject_takes(s, v->desc, CAMBER_METHOD_STRIP);
    camber_status status = CAMBER_OK;
    for (size_t r = 0; r < v->devices.count; r++)
        for (size_t e = 0; e < v->devices.list[r].drawer_count && status == CAMBER_OK; e++) {
            const camber_checked_device *checked = v->devices.list + r;
            const camber_checked_drawer *drawer = checked->drawers + e;
            if (drawer->in_gl)
                continue;
            for (int i = 0; i < VARIANTS && status == CAMBER_OK; i++)
                status = check_methods(v, s, checked, &(kernels){drawer->name, "", drawer->paths[0], i});
            if (status == CAMBER_OK && takes_strips)
                status = check_slices(v, s, checked, drawer);
            for (size_t n = 0; n < checked->group_count && status == CAMBER_OK && v->desc->full; n++)
                status = check_lanes(v, s, checked, drawer->name, n);
        }
    return status;
}

/* ---- A frame without changes ---- */

static camber_status check_frame_on(camber_validation *v, const camber_subject *s, const camber_frame *frame,
                                    const camber_checked_device *checked, const camber_checked_drawer *drawer) {
    const camber_tessellation_desc desc = {s->strokes, s->stroke_count, CAMBER_METHOD_STRIP, 0, false};
    const camber_drawing_path *path = drawer->paths;
    camber_check check =
        camber_check_start(checked->name, drawer->name,
                           "%s: as styled, areas and lines: drawn as by the CPU twin, on %s", s->name, checked->name);
    camber_frame part = *frame;
    part.width = frame->width < SIDE_PX ? frame->width : SIDE_PX;
    part.height = frame->height < SIDE_PX ? frame->height : SIDE_PX;
    part.coverage = (camber_coverage)v->desc->coverage;
    if (checked->broken[CAMBER_METHOD_STRIP]) {
        camber_results_skip(&v->results, check, "the mesh is not the CPU twin's");
        return CAMBER_OK;
    }
    camber_pass *passes = malloc(frame->pass_count * sizeof *passes);
    camber_status status = passes ? camber_subject_tessellate(s, path->mesh, &desc) : CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < frame->pass_count && passes; i++) {
        passes[i] = frame->passes[i];
        passes[i].mesh = path->mesh;
    }
    part.passes = passes;
    if (status == CAMBER_OK && is_long(path->mesh)) {
        camber_results_skip(&v->results, check, too_long);
    } else if (status == CAMBER_OK) {
        status = end_check(v, &check, compare_frame(path->renderer, &part, &check));
    }
    free(passes);
    return status;
}

camber_status camber_check_frame(camber_validation *v, const camber_subject *s, const camber_frame *frame) {
    camber_status status = CAMBER_OK;
    for (size_t r = 0; r < v->devices.count; r++)
        for (size_t e = 0; e < v->devices.list[r].drawer_count && status == CAMBER_OK; e++) {
            const camber_checked_device *checked = v->devices.list + r;
            if (!checked->drawers[e].in_gl)
                status = check_frame_on(v, s, frame, checked, checked->drawers + e);
        }
    return status;
}
