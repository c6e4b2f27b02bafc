/* Draws the passes of a scene by Cairo.
 *
 * Input: passes over the entries of the scene's network, with their paints. Output: paths, strokes and fills. Main
 * idea: consecutive entries of one row are one path with one stroke or fill, as in the picture. A stroke of one path
 * covers each place once, so a translucent line does not darken where it crosses itself; several of them are drawn into
 * a group, which is then drawn with their alpha. */
#include "print/page.h"

#include <math.h>

static const double PI = 3.14159265358979323846;
/* Opaque strokes are drawn in paths of so many lines, so that readers need not keep a whole city's. */
enum { LINES_OF_A_PATH = 4096 };
/* A gradient is drawn in pieces that differ by this in a channel, and are at least this long. Opaque pieces reach back
 * over the one before, so that no seam shows. */
static const double RAMP_STEP = 1.0 / 64.0, RAMP_LEAST_PX = 2.0, RAMP_OVERLAP_PX = 1.5;
/* Beyond the reach of a stroke, lines are kept this far, as in the picture. */
static const double MARGIN_PX = 64.0;
/* This is more than Cairo's own steps of 1/256 point at any resolution that is worth printing. */
static const double PAST_PX = 0.1;

static void set_color(cairo_t *cr, camber_color c, double alpha) {
    cairo_set_source_rgba(cr, (double)c.r, (double)c.g, (double)c.b, alpha);
}

/* ---- Fills ---- */

/* Sets the fill's repeated image as the source. */
static camber_status set_pattern(camber_page_map *map, const camber_fill *fill) {
    cairo_surface_t *surface = camber_page_image(map, fill->image);
    if (!surface)
        return camber_fail(map->context, CAMBER_ERROR_MEMORY, "page: no memory for an image of %u x %u px",
                           fill->image->width, fill->image->height);
    const double angle = -fill->bearing_deg * PI / 180.0;
    const double width = fill->width_px > 0.0f ? (double)fill->width_px : fill->image->width;
    const double height = fill->height_px > 0.0f ? (double)fill->height_px : fill->image->height;
    cairo_matrix_t matrix;
    cairo_matrix_init_translate(&matrix, (double)fill->x_px, (double)fill->y_px);
    cairo_matrix_rotate(&matrix, angle);
    cairo_matrix_scale(&matrix, width / fill->image->width, height / fill->image->height);
    if (cairo_matrix_invert(&matrix) != CAIRO_STATUS_SUCCESS)
        return CAMBER_OK;
    cairo_pattern_t *pattern = cairo_pattern_create_for_surface(surface);
    cairo_pattern_set_extend(pattern, CAIRO_EXTEND_REPEAT);
    cairo_pattern_set_matrix(pattern, &matrix);
    cairo_set_source(map->cr, pattern);
    cairo_pattern_destroy(pattern);
    return CAMBER_OK;
}

/* Fills the current path, or with is_all everything. */
static camber_status fill_path(camber_page_map *map, const camber_fill *fill, double opacity, bool is_all) {
    cairo_t *cr = map->cr;
    const double alpha = (double)fill->color.a * opacity;
    camber_status status = CAMBER_OK;
    cairo_set_fill_rule(cr, fill->rule == CAMBER_FILL_EVENODD ? CAIRO_FILL_RULE_EVEN_ODD : CAIRO_FILL_RULE_WINDING);
    if (!fill->image) {
        set_color(cr, fill->color, alpha);
        if (is_all)
            cairo_paint(cr);
        else
            cairo_fill(cr);
        return CAMBER_OK;
    }
    cairo_save(cr);
    status = set_pattern(map, fill);
    if (status == CAMBER_OK && is_all) {
        cairo_paint_with_alpha(cr, alpha);
    } else if (status == CAMBER_OK && alpha >= 1.0) {
        cairo_fill(cr);
    } else if (status == CAMBER_OK) {
        /* Not by a clip: if Cairo has no memory for one, it clips everything, and its status stays the same. */
        cairo_push_group(cr);
        cairo_fill(cr);
        cairo_pop_group_to_source(cr);
        cairo_paint_with_alpha(cr, alpha);
    }
    cairo_restore(cr);
    cairo_new_path(cr);
    return status;
}

/* ---- Strokes ---- */

/* Adds a line to the path. dashed: a ring of four corners ends a little past its beginning, because Cairo writes
 * rectangles as such, and their dashes would begin at another corner. */
static void add_line(cairo_t *cr, const camber_page_lines *l, size_t line, bool dashed) {
    const float *p = l->points + 2 * (size_t)l->offsets[line];
    size_t count = l->offsets[line + 1] - l->offsets[line];
    const bool closed = l->closed[line] && !dashed;
    if (closed && count > 1 && p[0] == p[2 * count - 2] && p[1] == p[2 * count - 1])
        count--;
    cairo_move_to(cr, (double)p[0], (double)p[1]);
    for (size_t i = 1; i < count; i++)
        cairo_line_to(cr, (double)p[2 * i], (double)p[2 * i + 1]);
    if (!closed && l->closed[line] && count == 5)
        cairo_rel_line_to(cr, copysign(PAST_PX, (double)(p[8] - p[6])), copysign(PAST_PX, (double)(p[9] - p[7])));
    if (closed || count == 1) /* a closed point is a dot */
        cairo_close_path(cr);
}

/* The look of a group of lines. */
typedef struct stroke_look {
    const camber_stroke *stroke;
    const camber_paint *paint;
    double width;
    camber_color color;
    double alpha;
    bool butt; /* the ends are cut straight, whatever the stroke's caps are */
} stroke_look;

static void set_stroke(cairo_t *cr, const stroke_look *look) {
    const camber_stroke *s = look->stroke;
    const bool dashed = look->paint->dash != NULL;
    cairo_set_line_width(cr, look->width);
    cairo_set_line_join(cr, s->join == CAMBER_JOIN_MITER   ? CAIRO_LINE_JOIN_MITER
                            : s->join == CAMBER_JOIN_BEVEL ? CAIRO_LINE_JOIN_BEVEL
                                                           : CAIRO_LINE_JOIN_ROUND);
    cairo_set_miter_limit(cr, s->miter_limit > 0.0f ? (double)s->miter_limit : 2.0);
    cairo_set_line_cap(cr, look->butt || (dashed && s->cap == CAMBER_CAP_SQUARE) ? CAIRO_LINE_CAP_BUTT
                           : s->cap == CAMBER_CAP_ROUND                          ? CAIRO_LINE_CAP_ROUND
                           : s->cap == CAMBER_CAP_SQUARE                         ? CAIRO_LINE_CAP_SQUARE
                                                                                 : CAIRO_LINE_CAP_BUTT);
    set_color(cr, look->color, look->alpha);
}

/* Sets the dashes of a line that begins at a distance along its whole line. */
static void set_dash(cairo_t *cr, const camber_paint *paint, double distance) {
    double lengths[CAMBER_DASH_LENGTHS_MAX], sum = 0.0;
    const size_t count = paint->dash->count;
    for (size_t i = 0; i < count; i++) {
        lengths[i] = fmax((double)paint->dash->lengths[i] * (double)paint->dash_unit_px, 0.0);
        sum += lengths[i];
    }
    if (sum > 1e-3)
        cairo_set_dash(cr, lengths, (int)count, distance);
}

static void draw_lines(camber_page_map *map, const camber_page_lines *l, const stroke_look *look) {
    cairo_t *cr = map->cr;
    size_t in_path = 0;
    set_stroke(cr, look);
    cairo_new_path(cr);
    for (size_t i = 0; i < l->count; i++) {
        add_line(cr, l, i, look->paint->dash != NULL);
        if (look->paint->dash) {
            set_dash(cr, look->paint, (double)l->arcs[2 * i]);
            cairo_stroke(cr);
        } else if (++in_path >= LINES_OF_A_PATH && look->alpha >= 1.0) {
            cairo_stroke(cr);
            in_path = 0;
        }
    }
    cairo_stroke(cr);
    cairo_set_dash(cr, NULL, 0, 0.0);
}

/* ---- Rails: lines with a gap ---- */

/* Draws the round ends of a line with a gap: half rings. */
static void draw_round_ends(camber_page_map *map, const stroke_look *look, double radius) {
    const camber_page_lines *l = &map->lines;
    cairo_t *cr = map->cr;
    set_stroke(cr, look);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
    for (size_t i = 0; i < l->count; i++) {
        const float *p = l->points + 2 * (size_t)l->offsets[i];
        const size_t n = l->offsets[i + 1] - l->offsets[i];
        if (n == 1) {
            cairo_new_sub_path(cr);
            cairo_arc(cr, (double)p[0], (double)p[1], radius, 0.0, 2.0 * PI);
        }
        if (n < 2 || l->closed[i])
            continue;
        const double first = atan2((double)(p[3] - p[1]), (double)(p[2] - p[0]));
        const float *q = p + 2 * (n - 2);
        const double last = atan2((double)(q[3] - q[1]), (double)(q[2] - q[0]));
        cairo_new_sub_path(cr);
        cairo_arc(cr, (double)p[0], (double)p[1], radius, first + 0.5 * PI, first + 1.5 * PI);
        cairo_new_sub_path(cr);
        cairo_arc(cr, (double)q[2], (double)q[3], radius, last - 0.5 * PI, last + 0.5 * PI);
    }
    cairo_stroke(cr);
}

/* Draws two rails beside the lines. */
static camber_status draw_rails(camber_page_map *map, const stroke_look *look) {
    const camber_paint *paint = look->paint;
    const float radius = 0.5f * (paint->gap_px + paint->width_px);
    stroke_look rail = *look;
    rail.width = (double)paint->width_px;
    rail.butt = true;
    camber_status status = CAMBER_OK;
    for (int side = -1; side <= 1 && status == CAMBER_OK; side += 2) {
        status = camber_page_lines_offset(&map->lines, look->stroke, look->stroke->offset_px + (float)side * radius,
                                          &map->beside);
        if (status == CAMBER_OK)
            draw_lines(map, &map->beside, &rail);
    }
    if (status == CAMBER_OK && look->stroke->cap == CAMBER_CAP_ROUND && look->stroke->offset_px == 0.0f)
        draw_round_ends(map, &rail, (double)radius);
    return status;
}

/* ---- Gradients and trims ---- */

static camber_color mix(camber_color a, camber_color b, double t) {
    const float u = (float)t;
    return (camber_color){a.r + u * (b.r - a.r), a.g + u * (b.g - a.g), a.b + u * (b.b - a.b), a.a + u * (b.a - a.a)};
}

static camber_status draw_part(camber_page_map *map, const camber_page_lines *l, size_t line, const double range[2],
                               const stroke_look *look) {
    camber_page_lines_clear(&map->part);
    const camber_status status = camber_page_lines_add_part(&map->part, l, line, range[0], range[1]);
    if (status == CAMBER_OK)
        draw_lines(map, &map->part, look);
    return status;
}

/* Draws a part of a line in the colours between two stops. */
static camber_status draw_between(camber_page_map *map, const camber_page_lines *l, size_t line,
                                  const camber_ramp_stop stops[2], const stroke_look *look) {
    const double whole = (double)l->arcs[2 * line + 1];
    const double from = (double)stops[0].place * whole, length = ((double)stops[1].place * whole) - from;
    const camber_color a = stops[0].color, b = stops[1].color;
    const float most = fmaxf(fmaxf(fabsf(a.r - b.r), fabsf(a.g - b.g)), fmaxf(fabsf(a.b - b.b), fabsf(a.a - b.a)));
    const double wanted = fmin(ceil((double)most / RAMP_STEP), floor(length / RAMP_LEAST_PX));
    const size_t pieces = (size_t)fmin(fmax(wanted, 1.0), 256.0);
    const bool opaque = a.a >= 1.0f && b.a >= 1.0f && look->alpha >= 1.0;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < pieces && status == CAMBER_OK; i++) {
        const double t = (double)i / (double)pieces, end = (double)(i + 1) / (double)pieces;
        const double range[2] = {from + t * length - (opaque ? RAMP_OVERLAP_PX : 0.0), from + end * length};
        stroke_look own = *look;
        own.color = mix(a, b, 0.5 * (t + end));
        own.alpha = look->alpha * (double)own.color.a;
        own.butt = true;
        status = draw_part(map, l, line, range, &own);
    }
    return status;
}

static void draw_ramp_end(camber_page_map *map, const camber_page_lines *l, size_t line, bool at_end,
                          const stroke_look *look) {
    const camber_ramp *ramp = look->paint->ramp;
    const float *p = l->points + 2 * (size_t)(at_end ? l->offsets[line + 1] - 1 : l->offsets[line]);
    stroke_look own = *look;
    own.color = ramp->stops[at_end ? ramp->count - 1 : 0].color;
    own.alpha = look->alpha * (double)own.color.a;
    set_stroke(map->cr, &own);
    cairo_new_path(map->cr);
    cairo_move_to(map->cr, (double)p[0], (double)p[1]);
    cairo_close_path(map->cr);
    cairo_stroke(map->cr);
}

static camber_status draw_ramp(camber_page_map *map, const camber_page_lines *l, const stroke_look *look) {
    const camber_ramp *ramp = look->paint->ramp;
    camber_status status = CAMBER_OK;
    for (size_t line = 0; line < l->count && status == CAMBER_OK; line++) {
        if (look->stroke->cap == CAMBER_CAP_ROUND && !l->closed[line])
            for (int end = 0; end < 2; end++)
                draw_ramp_end(map, l, line, end, look);
        for (size_t i = 0; i <= ramp->count && status == CAMBER_OK; i++) {
            /* Before the first stop and after the last one the colour stays. */
            camber_ramp_stop stops[2] = {ramp->stops[i ? i - 1 : 0], ramp->stops[i < ramp->count ? i : i - 1]};
            if (i == 0)
                stops[0].place = -1e-3f;
            if (i == ramp->count)
                stops[1].place = 1.001f;
            if (stops[1].place > stops[0].place)
                status = draw_between(map, l, line, stops, look);
        }
    }
    return status;
}

/* Replaces the lines by what a trim leaves of them. */
static camber_status trim(camber_page_map *map, const camber_paint *paint) {
    camber_page_lines *l = &map->lines, *left = &map->beside;
    camber_status status = CAMBER_OK;
    camber_page_lines_clear(left);
    for (size_t i = 0; i < l->count && status == CAMBER_OK; i++) {
        const double whole = (double)l->arcs[2 * i + 1];
        status = camber_page_lines_add_part(left, l, i, -1.0, (double)paint->trim_start * whole);
        if (status == CAMBER_OK)
            status = camber_page_lines_add_part(left, l, i, (double)paint->trim_end * whole, INFINITY);
    }
    const camber_page_lines kept = *l;
    *l = *left;
    *left = kept;
    return status;
}

/* ---- Groups of entries ---- */

/* Draws the collected lines with a paint. */
static camber_status draw_group(camber_page_map *map, const camber_stroke *stroke, const camber_paint *paint,
                                double alpha) {
    stroke_look look = {
        .stroke = stroke, .paint = paint, .width = (double)paint->width_px, .color = paint->color, .alpha = alpha};
    const camber_page_lines *lines = &map->lines;
    camber_status status = CAMBER_OK;
    if (paint->trim_end > paint->trim_start) {
        look.butt = true;
        status = trim(map, paint);
    }
    if (status != CAMBER_OK)
        return status;
    cairo_save(map->cr);
    cairo_translate(map->cr, (double)paint->translate_x_px, (double)paint->translate_y_px);
    if (paint->gap_px > 0.0f) {
        status = draw_rails(map, &look);
    } else {
        if (stroke->offset_px != 0.0f) {
            status = camber_page_lines_offset(&map->lines, stroke, stroke->offset_px, &map->beside);
            lines = &map->beside;
        }
        if (status == CAMBER_OK && paint->ramp)
            status = draw_ramp(map, lines, &look);
        else if (status == CAMBER_OK)
            draw_lines(map, lines, &look);
    }
    cairo_restore(map->cr);
    return status;
}

/* How far lines of a pair may be outside the picture and still be seen. */
static double reach_of(const camber_page_map *map, uint32_t pair, const camber_paint *paint) {
    const double moved = hypot((double)paint->translate_x_px, (double)paint->translate_y_px);
    return camber_plan_stroke_reach(map->parts.zoom->strokes + pair) + moved + MARGIN_PX;
}

static bool same_bits(const camber_paint *a, const camber_paint *b) {
    return memcmp(a, b, sizeof *a) == 0;
}

static bool draws_line(const camber_paint *paint) {
    return !paint->fill && paint->width_px > 0.0f && (paint->color.a > 0.0f || paint->ramp);
}

/* The paint of an entry in a pass. NULL: it is not drawn. */
static const camber_paint *paint_of(const camber_page_map *map, const camber_pass *pass, size_t entry) {
    const uint32_t row = map->parts.geometry->entries[entry].row;
    const camber_paint *paint = row < pass->paint_count ? pass->paints + row : NULL;
    return paint && (draws_line(paint) || (paint->fill && paint->fill->color.a > 0.0f)) ? paint : NULL;
}

/* Draws consecutive entries that share a row. */
static camber_status draw_entries(camber_page_map *map, const camber_pass *pass, size_t first, size_t end,
                                  double alpha) {
    const camber_network_entry *entries = map->parts.geometry->entries;
    const uint32_t pair = entries[first].row;
    const camber_paint *paint = pass->paints + pair;
    const double reach = reach_of(map, pair, paint);
    camber_status status = CAMBER_OK;
    camber_page_lines_clear(&map->lines);
    for (size_t i = first; i < end && status == CAMBER_OK; i++) {
        if (!paint_of(map, pass, i))
            continue;
        const bool has_arcs = paint->dash || paint->ramp || paint->trim_end > paint->trim_start;
        status = entries[i].is_dots ? camber_page_lines_add_dots(&map->lines, &map->parts, i, reach)
                                    : camber_page_lines_add(&map->lines, &map->parts, i, reach, has_arcs);
        if (pass->overlap == CAMBER_OVERLAP_ACCUMULATE && alpha < 1.0 && map->lines.count && status == CAMBER_OK) {
            status = draw_group(map, map->parts.zoom->strokes + pair, paint, alpha);
            camber_page_lines_clear(&map->lines);
        }
    }
    if (status == CAMBER_OK && map->lines.count)
        status = draw_group(map, map->parts.zoom->strokes + pair, paint, alpha);
    return status;
}

/* Draws areas with the same fill as one path. */
static camber_status draw_areas(camber_page_map *map, const camber_pass *pass, size_t first, size_t end) {
    const camber_network_entry *entries = map->parts.geometry->entries;
    const camber_paint *paint = pass->paints + entries[first].row;
    camber_status status = CAMBER_OK;
    camber_page_lines_clear(&map->lines);
    for (size_t i = first; i < end && status == CAMBER_OK; i++)
        if (paint_of(map, pass, i))
            status = camber_page_lines_add_ring(&map->lines, &map->parts, i, reach_of(map, entries[i].row, paint));
    if (status != CAMBER_OK || !map->lines.count)
        return status;
    cairo_save(map->cr);
    cairo_new_path(map->cr);
    cairo_translate(map->cr, (double)paint->translate_x_px, (double)paint->translate_y_px);
    for (size_t i = 0; i < map->lines.count; i++)
        add_line(map->cr, &map->lines, i, false);
    cairo_translate(map->cr, -(double)paint->translate_x_px, -(double)paint->translate_y_px);
    status = fill_path(map, paint->fill, 1.0, false);
    cairo_restore(map->cr);
    return status;
}

static bool same_fill(const camber_paint *a, const camber_paint *b) {
    return a->fill && b->fill && (a->fill == b->fill || memcmp(a->fill, b->fill, sizeof *a->fill) == 0) &&
           memcmp(&a->translate_x_px, &b->translate_x_px, 2 * sizeof(float)) == 0;
}

/* Finds the end of the entries that are drawn like the first one: as one fill, or as lines of one paint. Entries that
 * are not drawn belong to either. */
static size_t end_of_alike(const camber_page_map *map, const camber_pass *pass, size_t first, size_t end) {
    const camber_network_entry *entries = map->parts.geometry->entries;
    const camber_paint *paint = paint_of(map, pass, first);
    size_t i = first + 1;
    for (; i < end; i++) {
        const camber_paint *next = paint_of(map, pass, i);
        if (!next)
            continue;
        const bool alike = paint->fill
                               ? same_fill(paint, next)
                               : entries[i].row == entries[first].row ||
                                     (same_bits(paint, next) && memcmp(map->parts.zoom->strokes + entries[i].row,
                                                                       map->parts.zoom->strokes + entries[first].row,
                                                                       sizeof(camber_stroke)) == 0);
        if (!alike)
            break;
    }
    return i;
}

/* Finds the end of the translucent lines that are flattened with the first one. */
static size_t end_of_flat(const camber_page_map *map, const camber_pass *pass, size_t first, size_t end) {
    const camber_paint *paint = paint_of(map, pass, first);
    size_t i = first + 1;
    for (; i < end; i++) {
        const camber_paint *next = paint_of(map, pass, i);
        if (next && (next->fill || next->color.a != paint->color.a))
            break;
    }
    return i;
}

static camber_status draw_run(camber_page_map *map, const camber_pass *pass, size_t first, size_t end, double alpha) {
    camber_status status = CAMBER_OK;
    for (size_t i = first, next; i < end && status == CAMBER_OK; i = next) {
        next = i + 1;
        if (!paint_of(map, pass, i))
            continue;
        next = end_of_alike(map, pass, i, end);
        status = draw_entries(map, pass, i, next, alpha);
    }
    return status;
}

/* Whether lines of one paint are drawn by a single stroke, which covers each place once. */
static bool is_single(const camber_paint *paint) {
    return !paint->dash && !paint->ramp && !(paint->gap_px > 0.0f);
}

/* Draws translucent lines so that each place is covered once. */
static camber_status draw_flat(camber_page_map *map, const camber_pass *pass, size_t first, size_t end) {
    const camber_paint *paint = paint_of(map, pass, first);
    const double alpha = (double)paint->color.a;
    const bool alike = end_of_alike(map, pass, first, end) >= end;
    if (alpha >= 1.0 || pass->overlap == CAMBER_OVERLAP_ACCUMULATE || (alike && is_single(paint)))
        return draw_run(map, pass, first, end, alpha);
    cairo_push_group(map->cr);
    const camber_status status = draw_run(map, pass, first, end, 1.0);
    cairo_pop_group_to_source(map->cr);
    cairo_paint_with_alpha(map->cr, alpha);
    return status;
}

static camber_status draw_lines_pass(camber_page_map *map, const camber_pass *pass) {
    const size_t entry_count = map->parts.geometry->first_entries[map->parts.geometry->set_count];
    const size_t first = pass->first_polyline;
    const size_t end = pass->polyline_count ? first + pass->polyline_count : entry_count;
    camber_status status = CAMBER_OK;
    for (size_t i = first, next; i < end && status == CAMBER_OK; i = next) {
        const camber_paint *paint = paint_of(map, pass, i);
        next = i + 1;
        if (!paint)
            continue;
        if (paint->fill) {
            next = end_of_alike(map, pass, i, end);
            status = draw_areas(map, pass, i, next);
        } else {
            next = end_of_flat(map, pass, i, end);
            status = draw_flat(map, pass, i, next);
        }
    }
    return status;
}

/* ---- Passes ---- */

/* Whether a pass draws lines that Cairo cannot draw. */
static bool needs_image(const camber_page_map *map, const camber_pass *pass) {
    const camber_plan_network *geometry = map->parts.geometry;
    const size_t entry_count = geometry->first_entries[geometry->set_count];
    const size_t end = pass->polyline_count ? pass->first_polyline + pass->polyline_count : entry_count;
    for (size_t i = pass->first_polyline; i < end; i++) {
        const camber_paint *paint = paint_of(map, pass, i);
        if (paint && !paint->fill && (paint->blur_px > 0.0f || paint->image))
            return true;
    }
    return false;
}

static camber_status draw_pass(camber_page_map *map, size_t number) {
    const camber_pass *pass = map->parts.passes->passes + number;
    if (map->parts.passes->meshes[number] != CAMBER_MESH_NETWORK)
        return camber_page_draw_labels(map, number);
    if (pass->kind == CAMBER_PASS_FILL)
        return fill_path(map, &pass->fill, pass->opacity != 0.0f ? (double)pass->opacity : 1.0, true);
    if (needs_image(map, pass))
        return camber_page_draw_image(map, number, 1);
    const bool layer = pass->opacity != 0.0f && pass->opacity < 1.0f;
    if (layer)
        cairo_push_group(map->cr);
    const camber_status status = draw_lines_pass(map, pass);
    if (layer) {
        cairo_pop_group_to_source(map->cr);
        cairo_paint_with_alpha(map->cr, (double)pass->opacity);
    }
    return status;
}

camber_status camber_page_draw_map(camber_page_map *map) {
    const size_t count = map->parts.passes->count;
    const camber_color below = map->frame.background;
    if (map->frame.pitch_deg > 0.0)
        return camber_page_draw_image(map, 0, count);
    camber_status status = CAMBER_OK;
    if (below.a > 0.0f) {
        set_color(map->cr, below, (double)below.a);
        cairo_paint(map->cr);
    }
    for (size_t i = 0; i < count && status == CAMBER_OK; i++) {
        status = draw_pass(map, i);
        camber_progress(map->context, "printing", (double)(i + 1) / (double)count);
        if (status == CAMBER_OK && cairo_status(map->cr) == CAIRO_STATUS_NO_MEMORY)
            status = camber_fail(map->context, CAMBER_ERROR_MEMORY, "page: Cairo has no memory left");
    }
    return status;
}
