/* Projects the polylines of a scene for a page, whole or cut far outside the picture.
 *
 * Input: the features' points and the entries of the scene's network. Output: lines in px of the view. Main idea:
 * unlike a network's stretches (camber_network_project_lines), these know how far along their line they begin, so
 * dashes and gradients of a page are those of the picture. */
#include "print/page.h"

#include "camber_proof.h"
#include "kernels/layout.h"

#include <math.h>

/* The picture, and a margin around it. */
typedef struct window {
    double x0, y0, x1, y1;
} window;

static window window_of(const camber_view *view, double reach_px) {
    return (window){-reach_px, -reach_px, view->width + reach_px, view->height + reach_px};
}

void camber_page_lines_clear(camber_page_lines *l) {
    l->count = l->point_count = 0;
}

void camber_page_lines_free(camber_page_lines *l) {
    if (!l->context)
        return;
    camber_free(l->context, l->points);
    camber_free(l->context, l->offsets);
    camber_free(l->context, l->arcs);
    camber_free(l->context, l->closed);
    camber_free(l->context, l->scratch[0]);
    camber_free(l->context, l->scratch[1]);
    *l = (camber_page_lines){0};
}

/* ---- Appending ---- */

static bool begin_line(camber_page_lines *l, double first_px, double whole_px) {
    if (!camber_grow(l->context, &l->offsets, &l->offset_capacity, l->count + 2, sizeof *l->offsets) ||
        !camber_grow(l->context, &l->arcs, &l->arc_capacity, 2 * (l->count + 1), sizeof *l->arcs) ||
        !camber_grow(l->context, &l->closed, &l->closed_capacity, l->count + 1, sizeof *l->closed))
        return false;
    l->offsets[l->count] = l->offsets[l->count + 1] = (uint32_t)l->point_count;
    l->arcs[2 * l->count] = (float)first_px;
    l->arcs[2 * l->count + 1] = (float)whole_px;
    l->closed[l->count++] = false;
    return true;
}

/* Adds a point to the last line. */
static bool put_point(camber_page_lines *l, double x, double y) {
    if (l->point_count >= UINT32_MAX / 2 ||
        !camber_grow(l->context, &l->points, &l->point_capacity, 2 * (l->point_count + 1), sizeof *l->points))
        return false;
    l->points[2 * l->point_count] = (float)x;
    l->points[2 * l->point_count + 1] = (float)y;
    l->offsets[l->count] = (uint32_t)++l->point_count;
    return true;
}

/* ---- Projecting ---- */

/* Projects an entry's polyline into the first scratch array: triples of x, y and the distance from the beginning.
 * *count is 0 if it cannot reach the window. */
static camber_status project(camber_page_lines *l, const camber_scene_parts *parts, size_t entry, const window *w,
                             size_t *count) {
    const camber_features *f = parts->zoom->features;
    const camber_network_entry *e = parts->geometry->entries + entry;
    const size_t first = f->offsets[e->polyline], end = f->offsets[e->polyline + 1];
    const float least = e->is_dots || parts->zoom->plan.has_corners ? 0.0f : parts->zoom->least_importance;
    double box[4] = {INFINITY, INFINITY, -INFINITY, -INFINITY}, last[2] = {0.0, 0.0}, distance = 0.0;
    bool begun = false;
    *count = 0;
    if (!camber_grow(l->context, &l->scratch[0], &l->scratch_capacity[0], 3 * (end - first + 1), sizeof(double)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = first; i < end; i++) {
        double px[2];
        camber_view_project(parts->view, f->points[2 * i] + e->shift_x, f->points[2 * i + 1], px);
        if (!isfinite(px[0]) || !isfinite(px[1]))
            continue;
        if (begun)
            distance += hypot(px[0] - last[0], px[1] - last[1]);
        begun = true;
        last[0] = px[0];
        last[1] = px[1];
        if (i > first && i + 1 < end && f->importance && f->importance[i] < least)
            continue;
        box[0] = fmin(box[0], px[0]);
        box[1] = fmin(box[1], px[1]);
        box[2] = fmax(box[2], px[0]);
        box[3] = fmax(box[3], px[1]);
        double *to = l->scratch[0] + 3 * (*count)++;
        to[0] = px[0];
        to[1] = px[1];
        to[2] = distance;
    }
    if (!(box[0] <= w->x1 && box[2] >= w->x0 && box[1] <= w->y1 && box[3] >= w->y0))
        *count = 0;
    return CAMBER_OK;
}

/* Cuts a segment at the window: sets the two fractions of it between which it is inside. */
static bool cut(const window *w, const double *a, const double *b, double range[2]) {
    const double step[2] = {b[0] - a[0], b[1] - a[1]}, low[2] = {w->x0, w->y0}, high[2] = {w->x1, w->y1};
    range[0] = 0.0;
    range[1] = 1.0;
    for (int i = 0; i < 2; i++) {
        if (step[i] == 0.0) {
            if (a[i] < low[i] || a[i] > high[i])
                return false;
            continue;
        }
        const double p = (low[i] - a[i]) / step[i], q = (high[i] - a[i]) / step[i];
        range[0] = fmax(range[0], fmin(p, q));
        range[1] = fmin(range[1], fmax(p, q));
    }
    return range[0] <= range[1];
}

/* Adds the visible stretches of the projected polyline. *whole: the first stretch is all of it. */
static bool add_stretches(camber_page_lines *l, const double *p, size_t count, const window *w, const double along[2],
                          bool *whole) {
    const double from = along[0], length = along[1];
    bool open = false;
    *whole = true;
    for (size_t i = 0; i + 1 < count; i++, p += 3) {
        double range[2];
        if (!cut(w, p, p + 3, range)) {
            open = *whole = false;
            continue;
        }
        const double step[3] = {p[3] - p[0], p[4] - p[1], p[5] - p[2]};
        if (!open && !(begin_line(l, from + p[2] + range[0] * step[2], length) &&
                       put_point(l, p[0] + range[0] * step[0], p[1] + range[0] * step[1])))
            return false;
        if (!put_point(l, p[0] + range[1] * step[0], p[1] + range[1] * step[1]))
            return false;
        *whole &= range[0] == 0.0 && range[1] == 1.0;
        open = range[1] == 1.0;
    }
    return true;
}

/* Turns the points of a closed polyline so that it begins outside the window, if any of it is there: a ring that is cut
 * has no end where it begins. */
static void rotate_ring(double *p, size_t count, const window *w) {
    size_t first = 0;
    while (first < count && p[3 * first] >= w->x0 && p[3 * first] <= w->x1 && p[3 * first + 1] >= w->y0 &&
           p[3 * first + 1] <= w->y1)
        first++;
    if (first == 0 || first >= count)
        return;
    /* Three reversals rotate in place; the repeated last point is left out and put back. */
    const size_t n = count - 1, parts[3][2] = {{0, first}, {first, n}, {0, n}};
    for (int k = 0; k < 3; k++)
        for (size_t a = parts[k][0], b = parts[k][1]; a + 1 < b; a++) {
            b--;
            for (int c = 0; c < 3; c++) {
                const double kept = p[3 * a + (size_t)c];
                p[3 * a + (size_t)c] = p[3 * b + (size_t)c];
                p[3 * b + (size_t)c] = kept;
            }
        }
    for (int c = 0; c < 3; c++)
        p[3 * n + (size_t)c] = p[c];
}

static bool is_ring(const double *p, size_t count) {
    return count > 3 && p[0] == p[3 * (count - 1)] && p[1] == p[3 * (count - 1) + 1];
}

camber_status camber_page_lines_add(camber_page_lines *l, const camber_scene_parts *parts, size_t entry,
                                    double reach_px, bool has_arcs) {
    const camber_features *f = parts->zoom->features;
    const uint32_t polyline = parts->geometry->entries[entry].polyline;
    const window w = window_of(parts->view, reach_px);
    const size_t first_line = l->count;
    size_t count;
    camber_status status = project(l, parts, entry, &w, &count);
    if (status != CAMBER_OK || count == 0)
        return status;
    double *p = l->scratch[0];
    /* A polyline may be a part of a longer line. */
    const float *progress = f->progress ? f->progress + 2 * (size_t)polyline : NULL;
    const double part = progress ? (double)progress[1] - (double)progress[0] : 1.0, length = p[3 * (count - 1) + 2];
    const double whole = part > 0.0 ? length / part : length;
    const double along[2] = {progress ? (double)progress[0] * whole : 0.0, whole};
    if (length == 0.0) { /* a dot */
        if (!begin_line(l, 0.0, 0.0) || !put_point(l, p[0], p[1]))
            return CAMBER_ERROR_MEMORY;
        return CAMBER_OK;
    }
    const bool ring = is_ring(p, count);
    if (ring && !has_arcs)
        rotate_ring(p, count, &w);
    bool all;
    if (!add_stretches(l, p, count, &w, along, &all))
        return CAMBER_ERROR_MEMORY;
    if (ring && all && l->count == first_line + 1)
        l->closed[first_line] = true;
    return CAMBER_OK;
}

/* Cuts a ring at one side of a window: keeps where sign * coordinate <= limit. Points are triples. */
static size_t cut_ring(const double *from, size_t count, int axis, double sign, double limit, double *to) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        const double *a = from + 3 * i, *b = from + 3 * ((i + 1) % count);
        const double at = sign * a[axis], next = sign * b[axis];
        if (at <= limit) {
            memcpy(to + 3 * kept++, a, 3 * sizeof *to);
        }
        if ((at <= limit) != (next <= limit)) {
            const double t = (limit - at) / (next - at);
            for (int c = 0; c < 3; c++)
                to[3 * kept + (size_t)c] = a[c] + t * (b[c] - a[c]);
            to[3 * kept++ + (size_t)axis] = sign * limit;
        }
    }
    return kept;
}

camber_status camber_page_lines_add_ring(camber_page_lines *l, const camber_scene_parts *parts, size_t entry,
                                         double reach_px) {
    const window w = window_of(parts->view, reach_px);
    const struct {
        int axis;
        double sign, limit;
    } sides[] = {{0, -1.0, -w.x0}, {0, 1.0, w.x1}, {1, -1.0, -w.y0}, {1, 1.0, w.y1}};
    size_t count;
    camber_status status = project(l, parts, entry, &w, &count);
    if (status != CAMBER_OK || count < 4)
        return status;
    size_t left = count - 1;
    for (int i = 0; i < 4 && left >= 3; i++) {
        double *from = l->scratch[0];
        bool outside = false;
        for (size_t k = 0; k < left && !outside; k++)
            outside = !(sides[i].sign * from[3 * k + (size_t)sides[i].axis] <= sides[i].limit);
        if (!outside)
            continue;
        if (!camber_grow(l->context, &l->scratch[1], &l->scratch_capacity[1], 6 * left, sizeof(double)))
            return CAMBER_ERROR_MEMORY;
        left = cut_ring(from, left, sides[i].axis, sides[i].sign, sides[i].limit, l->scratch[1]);
        const size_t capacity = l->scratch_capacity[0];
        l->scratch[0] = l->scratch[1];
        l->scratch[1] = from;
        l->scratch_capacity[0] = l->scratch_capacity[1];
        l->scratch_capacity[1] = capacity;
    }
    if (left < 3)
        return CAMBER_OK;
    if (!begin_line(l, 0.0, 0.0))
        return CAMBER_ERROR_MEMORY;
    l->closed[l->count - 1] = true;
    for (size_t i = 0; i < left; i++)
        if (!put_point(l, l->scratch[0][3 * i], l->scratch[0][3 * i + 1]))
            return CAMBER_ERROR_MEMORY;
    return CAMBER_OK;
}

camber_status camber_page_lines_add_dots(camber_page_lines *l, const camber_scene_parts *parts, size_t entry,
                                         double reach_px) {
    const window w = window_of(parts->view, reach_px);
    size_t count;
    camber_status status = project(l, parts, entry, &w, &count);
    const double *p = l->scratch[0];
    const size_t dots = count && is_ring(p, count) ? count - 1 : count;
    for (size_t i = 0; i < dots && status == CAMBER_OK; i++, p += 3)
        if (p[0] >= w.x0 && p[0] <= w.x1 && p[1] >= w.y0 && p[1] <= w.y1 &&
            !(begin_line(l, 0.0, 0.0) && put_point(l, p[0], p[1])))
            status = CAMBER_ERROR_MEMORY;
    return status;
}

/* ---- Parts, and lines beside lines ---- */

camber_status camber_page_lines_add_part(camber_page_lines *l, const camber_page_lines *from, size_t line,
                                         double first_px, double end_px) {
    const uint32_t first = from->offsets[line], end = from->offsets[line + 1];
    double at = (double)from->arcs[2 * line];
    bool begun = false;
    for (uint32_t i = first; i + 1 < end; i++) {
        const float *a = from->points + 2 * (size_t)i;
        const double step[2] = {(double)(a[2] - a[0]), (double)(a[3] - a[1])}, length = hypot(step[0], step[1]);
        const double low = fmax(first_px, at), high = fmin(end_px, at + length);
        if (length > 0.0 && low < high) {
            const double s = (low - at) / length, t = (high - at) / length;
            if (!begun && !(begin_line(l, low, (double)from->arcs[2 * line + 1]) &&
                            put_point(l, (double)a[0] + s * step[0], (double)a[1] + s * step[1])))
                return CAMBER_ERROR_MEMORY;
            begun = true;
            if (!put_point(l, (double)a[0] + t * step[0], (double)a[1] + t * step[1]))
                return CAMBER_ERROR_MEMORY;
        }
        at += length;
    }
    return CAMBER_OK;
}

static camber_status read_beside(const camber_page_lines *l, const camber_stages *stages, camber_page_lines *beside) {
    for (size_t i = 0; i < stages->point_count; i++) {
        const camber_point_stages *p = stages->points + i;
        if (p->polyline >= l->count)
            continue;
        const float *arc = l->arcs + 2 * (size_t)p->polyline;
        if ((p->info & CAMBER_POINT_FIRST) || beside->count == 0) {
            const double along = stages->arc_lengths ? (double)stages->arc_lengths[i].along_px : 0.0;
            if (!begin_line(beside, (double)arc[0] + along, (double)arc[1]))
                return CAMBER_ERROR_MEMORY;
            beside->closed[beside->count - 1] = (p->info & CAMBER_POINT_RING) != 0;
        }
        if (!put_point(beside, (double)p->x, (double)p->y))
            return CAMBER_ERROR_MEMORY;
    }
    return CAMBER_OK;
}

camber_status camber_page_lines_offset(camber_page_lines *l, const camber_stroke *stroke, float offset_px,
                                       camber_page_lines *beside) {
    camber_polylines *polylines = NULL;
    camber_stages stages = {0};
    camber_stroke moved = *stroke;
    camber_page_lines_clear(beside);
    if (!l->count)
        return CAMBER_OK;
    moved.offset_px = fminf(fmaxf(offset_px, -16384.0f), 16384.0f);
    moved.width_px = fminf(moved.width_px, 16384.0f);
    const camber_polylines_desc desc = {
        .points = l->points, .point_count = l->point_count, .offsets = l->offsets, .polyline_count = l->count};
    const camber_tessellation_desc strokes = {.strokes = &moved, .stroke_count = 1, .has_arc_length = true};
    camber_status status = camber_polylines_create(l->context, &desc, &polylines);
    if (status == CAMBER_OK)
        status = camber_stages_tessellate(l->context, polylines, &strokes, &stages);
    if (status == CAMBER_OK)
        status = read_beside(l, &stages, beside);
    camber_stages_destroy(&stages);
    camber_polylines_destroy(polylines);
    return status;
}
