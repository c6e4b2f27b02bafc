/* Makes the draw list of a frame. Only this file reads passes and paints.
 *
 * A pass becomes rows and commands. Rows are its paints; the dashes and ramps that these refer to are put into the side
 * table. Consecutive polylines whose rows have the same alpha make a span; a span becomes a command. A translucent span
 * needs a layer, so that a pixel is covered once however often lines cross it. A layer costs time for each of its
 * pixels. If a pass would need more than LAYERS_MAX of them, its lines are drawn out of order, with one command per
 * alpha; and if it has more than ALPHAS_MAX alphas, all lines are drawn into one masked layer, each with its own alpha.
 *
 * Consecutive polygons also make a span, which needs no layer: the rasterizer takes all rings of one fill at once, and
 * changes the fill whenever the polygons do, in their order. If polygons and lines of a pass alternate more than
 * AREAS_MAX times, all polygons are drawn below the lines.
 *
 * A pass with an opacity is composited onto the picture as a whole: with the opacity of its only layer, or as a group.
 */
#include "draw/draw_list.h"

#include "base/perspective.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { SIDE_MAX_PX = 65535, LAYERS_MAX = 32, ALPHAS_MAX = 16, AREAS_MAX = 64 };

/* A position beyond the ends of all lines, as a fraction of their length. */
static const float FAR_BEYOND = 1e9f;

/* ---- Checks ---- */

/* Checks a pass. Dashes, ramps, images and trims need arc lengths. */
static camber_status check_pass(camber_context *context, const camber_pass *pass) {
    assert(pass->paint_count == 0 || pass->paints);
    if (pass->kind != CAMBER_PASS_LINES)
        return CAMBER_OK;
    const bool has_arc_length = pass->mesh->mesh_info.has_arc_length || pass->mesh->empty;
    for (size_t i = 0; i < pass->paint_count; i++) {
        const camber_paint *paint = pass->paints + i;
        const char *what = paint->image ? "images" : paint->dash ? "dashes" : paint->ramp ? "ramps" : "trims";
        const bool trims = paint->trim_end > paint->trim_start;
        if (!has_arc_length && !paint->fill && (paint->dash || paint->ramp || paint->image || trims))
            return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                               "%s of a mesh without arc lengths; tessellate it with has_arc_length", what);
    }
    return CAMBER_OK;
}

static camber_status check_frame(camber_context *context, const camber_frame *frame) {
    if (frame->width < 1 || frame->width > SIDE_MAX_PX || frame->height < 1 || frame->height > SIDE_MAX_PX)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "a picture of %u x %u px; each side must be 1 to %d",
                           frame->width, frame->height, SIDE_MAX_PX);
    if (!camber_pitch_is_valid(frame->pitch_deg))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "a picture with a pitch of %g degrees; choose 0 to %g",
                           frame->pitch_deg, CAMBER_PITCH_MAX_DEG);
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < frame->pass_count && status == CAMBER_OK; i++)
        status = check_pass(context, frame->passes + i);
    return status;
}

/* ---- Rows ---- */

/* Makes the rows of a pass. */
typedef struct row_maker {
    camber_draw_list *list;
    const camber_pass *pass;
    const camber_ramp *ramp; /* the ramp that was checked last, and whether it has translucent colours */
    bool is_translucent;
} row_maker;

/* Adds a use of an image, unless it equals the last one. *number is the number of the use. */
static camber_status add_image_use(camber_draw_list *list, const camber_image_use *use, size_t *number) {
    const camber_image_use *last = list->use_count ? list->image_uses + list->use_count - 1 : NULL;
    if (last && last->number == use->number && last->width_px == use->width_px && last->height_px == use->height_px &&
        last->tiled == use->tiled) {
        *number = list->use_count - 1;
        return CAMBER_OK;
    }
    if (!camber_grow(list->context, &list->image_uses, &list->use_capacity, list->use_count + 1,
                     sizeof *list->image_uses))
        return CAMBER_ERROR_MEMORY;
    *number = list->use_count;
    list->image_uses[list->use_count++] = *use;
    return CAMBER_OK;
}

static bool is_translucent(const camber_ramp *ramp) {
    for (size_t i = 0; i < ramp->count; i++)
        if (ramp->stops[i].color.a < 1.0f)
            return true;
    return false;
}

static bool is_drawn(const camber_pass *pass, size_t row) {
    const camber_paint *paint = pass->paints + row;
    if (row >= pass->paint_count)
        return false;
    return paint->fill ? paint->fill->color.a > 0.0f : paint->width_px > 0.0f && paint->color.a > 0.0f;
}

static unsigned features_of(const camber_paint *paint) {
    return (paint->gap_px > 0.0f ? CAMBER_FEATURE_GAP : 0u) | (paint->blur_px > 0.0f ? CAMBER_FEATURE_BLUR : 0u) |
           (paint->dash ? CAMBER_FEATURE_DASH : 0u) | (paint->trim_end > paint->trim_start ? CAMBER_FEATURE_TRIM : 0u) |
           (paint->ramp ? CAMBER_FEATURE_RAMP : 0u) | (paint->image ? CAMBER_FEATURE_IMAGE : 0u);
}

static void set_trim(const camber_paint *paint, float trim[2]) {
    const bool trims = paint->trim_end > paint->trim_start;
    trim[0] = !trims ? FAR_BEYOND : paint->trim_start <= 0.0f ? -FAR_BEYOND : paint->trim_start;
    trim[1] = !trims || paint->trim_end >= 1.0f ? FAR_BEYOND : paint->trim_end;
}

static camber_status set_ramp(row_maker *m, const camber_ramp *ramp, camber_row_paint *row) {
    const camber_status status = camber_side_table_add_ramp(&m->list->side_table, ramp, &row->first_stop);
    if (status != CAMBER_OK)
        return status;
    if (m->ramp != ramp) {
        m->ramp = ramp;
        m->is_translucent = is_translucent(ramp);
    }
    row->has_translucent_ramp = m->is_translucent;
    row->stop_count = (uint32_t)ramp->count;
    return CAMBER_OK;
}

static camber_status set_image(camber_draw_list *list, const camber_paint *paint, camber_row_paint *row) {
    size_t number;
    const camber_status status = camber_image_set_add(&list->images, paint->image, &number);
    if (status != CAMBER_OK)
        return status;
    const camber_image_use use =
        camber_image_use_on_line(paint->image, number, 2.0 * (double)row->half_width_px, (double)paint->image_px);
    return add_image_use(list, &use, &row->image_use);
}

static camber_status set_fill_image(camber_draw_list *list, const camber_fill *fill, camber_fill_paint *paint) {
    size_t number;
    camber_status status = camber_image_set_add(&list->images, fill->image, &number);
    if (status != CAMBER_OK)
        return status;
    const camber_image_use mean = camber_image_use_as_mean(fill->image, number);
    const camber_image_use use =
        camber_image_use_in_fill(fill->image, number, (double)fill->width_px, (double)fill->height_px);
    paint->color.r = paint->color.g = paint->color.b = 1.0f;
    status = add_image_use(list, &mean, &paint->mean_use);
    return status == CAMBER_OK ? add_image_use(list, &use, &paint->image_use) : status;
}

/* Resolves a fill. */
static camber_status make_fill(camber_draw_list *list, const camber_fill *fill, camber_fill_paint *made) {
    memset(made, 0, sizeof *made); /* fills are compared by their bytes */
    made->color = fill->color;
    made->has_image = fill->image != NULL;
    made->x_px = fill->x_px;
    made->y_px = fill->y_px;
    made->bearing_deg = fill->bearing_deg;
    made->rule = fill->rule;
    return made->has_image ? set_fill_image(list, fill, made) : CAMBER_OK;
}

/* Makes the row of a polygon, with its own fill. */
static camber_status make_area_row(const row_maker *m, const camber_paint *paint, camber_row_paint *row) {
    camber_draw_list *list = m->list;
    if (!camber_grow(list->context, &list->fills, &list->fill_capacity, list->fill_count + 1, sizeof *list->fills))
        return CAMBER_ERROR_MEMORY;
    *row = (camber_row_paint){.half_gap_px = -1.0f,
                              .translate_px = {paint->translate_x_px, paint->translate_y_px},
                              .color = {1.0f, 1.0f, 1.0f, paint->fill->color.a},
                              .fill = (int32_t)list->fill_count};
    camber_fill_paint *fill = list->fills + list->fill_count++;
    const camber_status status = make_fill(list, paint->fill, fill);
    fill->upright = m->pass->upright;
    return status;
}

static camber_status make_row(row_maker *m, size_t number, camber_row_paint *row) {
    static const camber_color white = {1, 1, 1, 1};
    const camber_pass *pass = m->pass;
    const camber_paint *paint = pass->paints + number;
    camber_status status = CAMBER_OK;
    if (paint->fill)
        return make_area_row(m, paint, row);
    *row = (camber_row_paint){.half_width_px = camber_paint_half_width(paint),
                              .half_gap_px = paint->gap_px > 0.0f ? 0.5f * paint->gap_px : -1.0f,
                              .blur_px = (paint->smooth_blur ? -1.0f : 1.0f) * fmaxf(paint->blur_px, 0.0f),
                              .translate_px = {paint->translate_x_px, paint->translate_y_px},
                              .color = paint->image ? white : paint->color,
                              .fill = CAMBER_NO_FILL,
                              .features = features_of(paint)};
    row->color.a = paint->color.a;
    set_trim(paint, row->trim);
    if (paint->dash)
        status = camber_side_table_add_dash(&m->list->side_table, paint->dash, paint->dash_unit_px,
                                            pass->mesh->host_rows[number].cap == CAMBER_CAP_ROUND, &row->dashes);
    if (paint->ramp && status == CAMBER_OK)
        status = set_ramp(m, paint->ramp, row);
    if (paint->image && status == CAMBER_OK)
        status = set_image(m->list, paint, row);
    return status;
}

/* Adds the rows of a pass to the list, one for each row of the pass's mesh. */
static camber_status make_rows(row_maker *m) {
    camber_draw_list *list = m->list;
    const size_t count = m->pass->mesh->row_count;
    camber_status status = CAMBER_OK;
    if (!camber_grow(list->context, &list->rows, &list->row_capacity, list->row_count + count, sizeof *list->rows))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count && status == CAMBER_OK; i++) {
        camber_row_paint *row = list->rows + list->row_count++;
        if (is_drawn(m->pass, i))
            status = make_row(m, i, row);
        else
            row->half_width_px = -1.0f;
    }
    return status;
}

/* ---- Spans: polylines of a pass that are drawn in one way ---- */

typedef struct pass_lines {
    const camber_mesh *mesh;
    const camber_row_paint *rows; /* rows of the pass */
    size_t first, end;            /* polylines of the pass */
    camber_overlap overlap;
} pass_lines;

typedef struct span {
    size_t first, end; /* polylines */
    float alpha;       /* alpha of its drawn rows. 0: it has none; 1 if overlaps accumulate */
    bool one_alpha;    /* polylines of other alphas within it are not drawn */
    bool is_layered, is_masked, is_one_color;
    bool is_begun; /* one of its rows is drawn */
    bool is_area;  /* its polygons are drawn, each with its fill; else its lines are drawn */
    camber_color color;
    unsigned features;
} span;

static span begin_span(size_t first, size_t end) {
    return (span){.first = first, .end = end, .alpha = 1.0f, .is_one_color = true};
}

static void add_to_span(const pass_lines *lines, const camber_row_paint *row, span *s) {
    const bool accumulates = lines->overlap == CAMBER_OVERLAP_ACCUMULATE;
    const camber_color c = row->color;
    if (!s->is_begun) {
        s->alpha = accumulates ? 1.0f : c.a;
        s->color = c;
        s->is_area = row->fill != CAMBER_NO_FILL;
    }
    s->is_one_color = s->is_one_color && c.r == s->color.r && c.g == s->color.g && c.b == s->color.b &&
                      !(row->features & CAMBER_FEATURES_COLORS);
    s->is_masked = s->is_masked || (row->has_translucent_ramp && !accumulates);
    s->features |= row->features;
    s->is_begun = true;
}

static void end_span(const pass_lines *lines, span *s) {
    if (!s->is_begun)
        s->alpha = 0.0f;
    if (s->is_area)
        return;
    s->is_layered = s->alpha < 1.0f || s->is_masked || (lines->overlap == CAMBER_OVERLAP_UNITE && s->is_one_color);
    s->one_alpha = s->one_alpha || s->is_layered;
}

static const camber_row_paint *row_of(const pass_lines *lines, size_t polyline) {
    return lines->rows + lines->mesh->polyline_rows[polyline];
}

/* Returns the longest span that begins at a polyline. Polylines that are not drawn may be in any span. */
static span find_span(const pass_lines *lines, size_t first) {
    const bool accumulates = lines->overlap == CAMBER_OVERLAP_ACCUMULATE;
    span s = begin_span(first, first);
    for (; s.end < lines->end; s.end++) {
        const camber_row_paint *row = row_of(lines, s.end);
        if (row->half_width_px < 0.0f)
            continue;
        const bool is_area = row->fill != CAMBER_NO_FILL;
        if (s.is_begun && (is_area != s.is_area || (!is_area && !accumulates && row->color.a != s.alpha)))
            break;
        add_to_span(lines, row, &s);
        if (lines->mesh->row_count == 1)
            s.end = lines->end - 1; /* all are the same */
    }
    end_span(lines, &s);
    return s;
}

/* Returns all polylines with the same alpha as one span. */
static span pick_alpha(const pass_lines *lines, float alpha) {
    span s = begin_span(lines->first, lines->end);
    s.one_alpha = true;
    for (size_t i = lines->first; i < lines->end; i++) {
        const camber_row_paint *row = row_of(lines, i);
        if (row->half_width_px >= 0.0f && row->fill == CAMBER_NO_FILL && row->color.a == alpha)
            add_to_span(lines, row, &s);
    }
    end_span(lines, &s);
    return s;
}

/* Returns all polygons as one span. */
static span pick_areas(const pass_lines *lines) {
    span s = begin_span(lines->first, lines->end);
    s.is_area = true;
    return s;
}

/* Returns all polylines, each with its own alpha, as one masked layer. */
static span mask_all(const pass_lines *lines) {
    span s = begin_span(lines->first, lines->end);
    for (size_t i = lines->first; i < lines->end; i++)
        if (row_of(lines, i)->half_width_px >= 0.0f && row_of(lines, i)->fill == CAMBER_NO_FILL)
            add_to_span(lines, row_of(lines, i), &s);
    s.alpha = 1.0f;
    s.is_one_color = false;
    s.is_masked = s.is_layered = true;
    return s;
}

/* ---- Commands ---- */

static camber_status add_command(camber_draw_list *list, const camber_draw_command *command) {
    if (!camber_grow(list->context, &list->commands, &list->command_capacity, list->command_count + 1,
                     sizeof *list->commands))
        return CAMBER_ERROR_MEMORY;
    list->commands[list->command_count++] = *command;
    return CAMBER_OK;
}

static bool fades(const camber_pass *pass) {
    return pass->opacity > 0.0f && pass->opacity < 1.0f;
}

/* Adds a fill. Its opacity is in its colour, so it needs no layer. */
static camber_status add_fill(camber_draw_list *list, const camber_pass *pass) {
    camber_draw_command command = {0};
    const float alpha = pass->fill.color.a * (pass->opacity > 0.0f ? pass->opacity : 1.0f);
    if (!(alpha > 0.0f))
        return CAMBER_OK;
    const camber_status status = make_fill(list, &pass->fill, &command.fill);
    command.fill.color.a = alpha;
    return status == CAMBER_OK ? add_command(list, &command) : status;
}

static camber_composite composite_of(const span *s) {
    if (s->is_area)
        return CAMBER_COMPOSITE_AREA;
    if (!s->is_layered)
        return CAMBER_COMPOSITE_STRAIGHT;
    if (s->is_masked)
        return CAMBER_COMPOSITE_MASKED;
    if (!s->is_one_color)
        return CAMBER_COMPOSITE_COLORS;
    /* Only strokes with one edge on each side can be united. */
    return s->features ? CAMBER_COMPOSITE_COVERAGE : CAMBER_COMPOSITE_UNION;
}

/* Makes the commands of a pass. */
typedef struct command_maker {
    camber_draw_list *list;
    const camber_pass *pass;
    const pass_lines *lines;
    size_t first_row; /* first row of the pass in the list */
    uint32_t group;   /* 0: none yet */
} command_maker;

static bool is_same_fill(const camber_draw_list *list, int32_t a, int32_t b) {
    return a == b || memcmp(list->fills + a, list->fills + b, sizeof *list->fills) == 0;
}

/* Lists where the fill of the span's polygons changes, including its first polygon. */
static camber_status list_fills(const command_maker *m, const span *s) {
    camber_draw_list *list = m->list;
    int32_t fill = CAMBER_NO_FILL;
    for (size_t i = s->first; i < s->end; i++) {
        const camber_row_paint *row = row_of(m->lines, i);
        if (row->half_width_px < 0.0f || row->fill == CAMBER_NO_FILL)
            continue;
        if (fill == CAMBER_NO_FILL || !is_same_fill(list, fill, row->fill)) {
            if (!camber_grow(list->context, &list->spans, &list->span_capacity, list->span_count + 1,
                             sizeof *list->spans))
                return CAMBER_ERROR_MEMORY;
            list->spans[list->span_count++] = (camber_area_span){i, row->fill};
        }
        fill = row->fill;
        if (m->lines->mesh->row_count == 1)
            break; /* all are the same */
    }
    return CAMBER_OK;
}

/* Adds a span. is_whole: the span is the whole pass, so that its only layer or fill can take the pass's opacity. */
static camber_status add_span(command_maker *m, span s, bool is_whole) {
    const size_t first_span = m->list->span_count;
    float opacity = 1.0f;
    if (s.alpha <= 0.0f)
        return CAMBER_OK;
    const camber_status status = s.is_area ? list_fills(m, &s) : CAMBER_OK;
    const size_t span_count = m->list->span_count - first_span;
    if (status != CAMBER_OK || (s.is_area && span_count == 0))
        return status;
    if (s.is_area && fades(m->pass) && is_whole && span_count == 1) {
        opacity = m->pass->opacity;
    } else if (!s.is_area && fades(m->pass) && is_whole && m->lines->overlap != CAMBER_OVERLAP_ACCUMULATE) {
        opacity = m->pass->opacity;
        s.one_alpha = s.one_alpha || !s.is_layered;
        s.is_layered = true;
    } else if (fades(m->pass) && m->group == 0) {
        m->group = ++m->list->group_count;
    }
    camber_draw_command command = {.mesh = m->pass->mesh,
                                   .first_span = first_span,
                                   .span_count = span_count,
                                   .first = s.first,
                                   .end = s.end,
                                   .upright = m->pass->upright,
                                   .first_row = m->first_row,
                                   .features = s.features,
                                   .composite = composite_of(&s),
                                   .one_alpha = s.one_alpha,
                                   .alpha = s.alpha,
                                   .color = s.color,
                                   .layer_opacity = s.is_area ? opacity : s.alpha * opacity,
                                   .group = m->group,
                                   .group_opacity = m->pass->opacity};
    return add_command(m->list, &command);
}

/* Whether the pass has more layers, or more spans of polygons, than a pass may have. */
static bool has_many_spans(const pass_lines *lines, const span *first) {
    span s = *first;
    size_t layers = s.is_layered && s.alpha > 0.0f, areas = s.is_area;
    while (s.end < lines->end && layers <= LAYERS_MAX && areas <= AREAS_MAX) {
        s = find_span(lines, s.end);
        layers += s.is_layered && s.alpha > 0.0f;
        areas += s.is_area;
    }
    return layers > LAYERS_MAX || areas > AREAS_MAX;
}

static camber_status add_in_order(command_maker *m, span s) {
    camber_status status = add_span(m, s, s.end == m->lines->end);
    while (s.end < m->lines->end && status == CAMBER_OK) {
        s = find_span(m->lines, s.end);
        status = add_span(m, s, false);
    }
    return status;
}

/* Lists the alphas of a pass in ascending order, and returns how many there are, or ALPHAS_MAX + 1 if there are more
 * than ALPHAS_MAX. */
static size_t list_alphas(const pass_lines *lines, float alphas[ALPHAS_MAX]) {
    size_t count = 0;
    for (size_t i = lines->first; i < lines->end; i++) {
        const camber_row_paint *row = row_of(lines, i);
        const float alpha = row->color.a;
        if (row->half_width_px < 0.0f || row->fill != CAMBER_NO_FILL)
            continue;
        size_t at = 0;
        while (at < count && alphas[at] < alpha)
            at++;
        if (at < count && alphas[at] <= alpha)
            continue;
        if (count == ALPHAS_MAX)
            return ALPHAS_MAX + 1;
        for (size_t k = count++; k > at; k--)
            alphas[k] = alphas[k - 1];
        alphas[at] = alpha;
    }
    return count;
}

/* Adds polygons in their order, and then lines, the faintest first. */
static camber_status add_by_alpha(command_maker *m) {
    float alphas[ALPHAS_MAX];
    const size_t count = list_alphas(m->lines, alphas);
    camber_status status = add_span(m, pick_areas(m->lines), false);
    if (status == CAMBER_OK && count > ALPHAS_MAX)
        return add_span(m, mask_all(m->lines), m->group == 0);
    for (size_t i = 0; i < count && status == CAMBER_OK; i++)
        status = add_span(m, pick_alpha(m->lines, alphas[i]), false);
    return status;
}

static camber_status add_lines(row_maker *rows) {
    const camber_pass *pass = rows->pass;
    const camber_mesh *mesh = pass->mesh;
    const size_t first_row = rows->list->row_count;
    if (mesh->empty)
        return CAMBER_OK;
    const size_t end = pass->polyline_count ? pass->first_polyline + pass->polyline_count : mesh->polyline_count;
    pass_lines lines = {mesh, NULL, pass->first_polyline, end < mesh->polyline_count ? end : mesh->polyline_count,
                        pass->overlap};
    if (lines.first >= lines.end)
        return CAMBER_OK;
    const camber_status status = make_rows(rows);
    if (status != CAMBER_OK)
        return status;
    lines.rows = rows->list->rows + first_row;
    command_maker m = {rows->list, pass, &lines, first_row, 0};
    const span first = find_span(&lines, lines.first);
    return has_many_spans(&lines, &first) ? add_by_alpha(&m) : add_in_order(&m, first);
}

/* ---- The list ---- */

static float thinnest_of(const camber_frame *frame) {
    float thinnest_px = INFINITY;
    for (size_t p = 0; p < frame->pass_count; p++)
        for (size_t i = 0; i < frame->passes[p].paint_count; i++) {
            const float width_px = frame->passes[p].paints[i].width_px;
            thinnest_px = width_px > 0.0f && width_px < thinnest_px ? width_px : thinnest_px;
        }
    return thinnest_px;
}

/* Finds the pitch: of the camera that the meshes were tessellated for, if there was one, or else of the frame. */
static camber_status find_pitch(camber_context *context, const camber_frame *frame, double *pitch_deg) {
    double pitch = frame->pitch_deg;
    bool found = pitch > 0.0;
    for (size_t i = 0; i < frame->pass_count; i++) {
        const camber_pass *pass = frame->passes + i;
        if (pass->kind != CAMBER_PASS_LINES || !pass->mesh->has_camera)
            continue;
        const double of_mesh = pass->mesh->pitch_deg;
        if (found && (of_mesh < pitch || of_mesh > pitch))
            return camber_fail(
                context, CAMBER_ERROR_ARGUMENT,
                "a mesh that was tessellated for a pitch of %g degrees, in a picture with a pitch of %g; tessellate "
                "all meshes of a picture for one camera",
                of_mesh, pitch);
        pitch = of_mesh;
        found = true;
    }
    *pitch_deg = pitch;
    return CAMBER_OK;
}

static camber_plane_view view_of(const camber_frame *frame, double pitch_deg) {
    if (!(pitch_deg > 0.0))
        return (camber_plane_view){.nearest = 1.0};
    const camber_perspective p = camber_perspective_of(pitch_deg, frame->height);
    return (camber_plane_view){
        .pitched = true,
        .eye = {0.5f * (float)frame->width, 0.5f * (float)frame->height, (float)p.cosine, (float)p.fall},
        .horizon = camber_perspective_horizon(&p, frame->height),
        .nearest = 1.0 / p.nearest};
}

camber_status camber_draw_list_build(camber_draw_list *list, const camber_frame *frame) {
    double pitch_deg = 0.0;
    camber_status status = check_frame(list->context, frame);
    if (status == CAMBER_OK)
        status = find_pitch(list->context, frame, &pitch_deg);
    list->command_count = list->row_count = list->use_count = list->fill_count = 0;
    list->span_count = list->group_count = 0;
    camber_image_set_clear(&list->images);
    camber_side_table_clear(&list->side_table);
    if (status != CAMBER_OK)
        return status;
    list->thinnest_px = thinnest_of(frame);
    list->view = view_of(frame, pitch_deg);
    row_maker m = {.list = list};
    for (size_t i = 0; i < frame->pass_count && status == CAMBER_OK; i++) {
        m.pass = frame->passes + i;
        status = m.pass->kind == CAMBER_PASS_LINES ? add_lines(&m) : add_fill(list, m.pass);
    }
    return status;
}

void camber_draw_list_free(camber_draw_list *list) {
    camber_image_set_free(&list->images);
    camber_side_table_free(&list->side_table);
    camber_free(list->context, list->image_uses);
    camber_free(list->context, list->spans);
    camber_free(list->context, list->fills);
    camber_free(list->context, list->rows);
    camber_free(list->context, list->commands);
}
