/* Cuts the lines of features at the borders of their vector tiles; tile_join.c joins them again.
 *
 * A tile contains the points of a feature inside it and in a buffer around it, so neighbouring tiles both contain the
 * lines in their buffers. Each line is cut at its tile's border, where the neighbour's line continues it:
 *
 *         tile A    |    tile B
 *     a ------------c - - -            A's line, with its buffer
 *             - - - c ------------ b   B's line
 */
#include "base/maths.h"
#include "features/tile_stitcher.h"

#include <math.h>
#include <string.h>

/* Coordinates were converted to metres and back. If one is this close to a multiple of 1/16 unit, it is rounded to that
 * multiple. */
static const double SNAP = 0.01 / 16;

/* ---- Features: one record for all lines with the same id ---- */

static size_t id_slot(const camber_tile_stitcher *stitcher, uint64_t id, uint32_t class_index) {
    return (size_t)camber_mix(camber_mix(0, id), class_index) & (stitcher->slot_count - 1);
}

static bool grow_slots(camber_tile_stitcher *stitcher) {
    const size_t count = stitcher->slot_count ? 2 * stitcher->slot_count : 1024;
    uint32_t *slots = camber_alloc_zero(stitcher->context, count, sizeof *slots);
    if (!slots)
        return false;
    camber_free(stitcher->context, stitcher->slots);
    stitcher->slots = slots;
    stitcher->slot_count = count;
    for (size_t i = 0; i < stitcher->feature_count; i++) {
        camber_cut_feature *record = &stitcher->features[i];
        if (!record->has_id)
            continue;
        const size_t slot = id_slot(stitcher, record->id, record->class_index);
        record->next = slots[slot];
        slots[slot] = (uint32_t)i + 1;
    }
    return true;
}

static camber_status find_feature(camber_tile_stitcher *stitcher, const camber_tile_feature *feature, uint32_t *index) {
    if (stitcher->feature_count >= stitcher->slot_count && !grow_slots(stitcher))
        return CAMBER_ERROR_MEMORY;
    const size_t slot = id_slot(stitcher, feature->id, feature->class_index);
    for (uint32_t i = feature->has_id ? stitcher->slots[slot] : 0; i; i = stitcher->features[i - 1].next) {
        const camber_cut_feature *record = &stitcher->features[i - 1];
        if (record->id == feature->id && record->class_index == feature->class_index) {
            *index = i - 1;
            return CAMBER_OK;
        }
    }
    if (stitcher->feature_count >= UINT32_MAX - 1)
        return camber_fail(stitcher->context, CAMBER_ERROR_LIMIT,
                           "more than 4294967294 features in tiles; select fewer with an attribute filter");
    if (!camber_grow(stitcher->context, &stitcher->features, &stitcher->feature_capacity, stitcher->feature_count + 1,
                     sizeof *stitcher->features))
        return CAMBER_ERROR_MEMORY;
    camber_cut_feature record = {.id = feature->id, .class_index = feature->class_index, .has_id = feature->has_id};
    if (record.has_id) {
        record.next = stitcher->slots[slot];
        stitcher->slots[slot] = (uint32_t)stitcher->feature_count + 1;
    }
    stitcher->features[stitcher->feature_count] = record;
    *index = (uint32_t)stitcher->feature_count++;
    return CAMBER_OK;
}

/* ---- Cutting at the border ---- */

typedef struct tile_cut {
    camber_tile_stitcher *stitcher;
    camber_tile_box box;
    camber_cut_line line; /* the line being made, if open is set; its tile and feature are the same for all lines */
    bool open;
    const double *progress; /* NULL: none */
    double length, done;    /* the line's length, and its length up to the current segment */
} tile_cut;

static bool on_border(const camber_tile_box *box, const double *point) {
    return point[0] == box->low[0] || point[0] == box->high[0] || point[1] == box->low[1] || point[1] == box->high[1];
}

static bool inside(const camber_tile_box *box, const double *point) {
    return point[0] >= box->low[0] && point[0] <= box->high[0] && point[1] >= box->low[1] && point[1] <= box->high[1];
}

static bool along_border(const camber_tile_box *box, const double *p, const double *q) {
    for (int axis = 0; axis < 2; axis++)
        if (p[axis] == q[axis] && (p[axis] == box->low[axis] || p[axis] == box->high[axis]))
            return true;
    return false;
}

/* Clips the segment p q to the box (Liang-Barsky) and puts the new ends exactly on the border. Returns false if at most
 * one point of the segment is inside. */
static bool clip_segment(const camber_tile_box *box, const double *p, const double *q, double ends[4], bool cut[2]) {
    double t[2] = {0, 1};
    int axis_of[2] = {-1, -1};
    double edge_of[2] = {0, 0};
    for (int axis = 0; axis < 2; axis++) {
        const double delta = q[axis] - p[axis];
        if (delta == 0) {
            if (p[axis] < box->low[axis] || p[axis] > box->high[axis])
                return false;
            continue;
        }
        const double enter_edge = delta > 0 ? box->low[axis] : box->high[axis];
        const double leave_edge = delta > 0 ? box->high[axis] : box->low[axis];
        const double enter = (enter_edge - p[axis]) / delta, leave = (leave_edge - p[axis]) / delta;
        if (enter > t[0]) {
            t[0] = enter;
            axis_of[0] = axis;
            edge_of[0] = enter_edge;
        }
        if (leave < t[1]) {
            t[1] = leave;
            axis_of[1] = axis;
            edge_of[1] = leave_edge;
        }
    }
    if (!(t[0] < t[1]))
        return false;
    for (int end = 0; end < 2; end++) {
        cut[end] = axis_of[end] >= 0;
        for (int axis = 0; axis < 2; axis++) {
            const double whole = end == 0 ? p[axis] : q[axis];
            const double at = cut[end] ? p[axis] + (q[axis] - p[axis]) * t[end] : whole;
            ends[2 * end + axis] = fmin(fmax(at, box->low[axis]), box->high[axis]);
        }
        if (cut[end])
            ends[2 * end + axis_of[end]] = edge_of[end];
    }
    return ends[0] != ends[2] || ends[1] != ends[3];
}

static camber_status close_line(tile_cut *cut, bool is_cut) {
    camber_tile_stitcher *stitcher = cut->stitcher;
    if (!cut->open)
        return CAMBER_OK;
    cut->open = false;
    camber_cut_line *line = &cut->line;
    line->count = stitcher->point_count - line->first;
    line->cut[1] = is_cut;
    line->border[0] = on_border(&cut->box, stitcher->points + 2 * line->first);
    line->border[1] = on_border(&cut->box, stitcher->points + 2 * (stitcher->point_count - 1));
    return camber_tile_stitcher_add_line(stitcher, line);
}

static camber_status open_line(tile_cut *cut, const double *point, bool is_cut, bool along) {
    cut->open = true;
    cut->line.first = cut->stitcher->point_count;
    cut->line.cut[0] = is_cut;
    cut->line.along_border = along;
    return camber_tile_stitcher_add_point(cut->stitcher, point) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

static float progress_at(const tile_cut *cut, const double *p, const double *at) {
    const double along = cut->done + camber_length(at[0] - p[0], at[1] - p[1]);
    return (float)(cut->progress[0] + (cut->progress[1] - cut->progress[0]) * (along / cut->length));
}

static camber_status cut_segment(tile_cut *cut, const double *p, const double *q, bool outline) {
    if (camber_tile_stitcher_same(p, q))
        return cut->open && !camber_tile_stitcher_add_point(cut->stitcher, q) ? CAMBER_ERROR_MEMORY : CAMBER_OK;
    double ends[4];
    bool is_cut[2];
    if (!clip_segment(&cut->box, p, q, ends, is_cut))
        return close_line(cut, false);
    const bool along = along_border(&cut->box, ends, ends + 2);
    camber_status status = CAMBER_OK;
    if (is_cut[0] || (cut->open && along != cut->line.along_border) || (along && outline))
        status = close_line(cut, false);
    if (status != CAMBER_OK || (along && outline))
        return status;
    if (!cut->open) {
        status = open_line(cut, ends, is_cut[0], along);
        if (cut->progress)
            cut->line.progress[0] = progress_at(cut, p, ends);
    }
    if (cut->progress)
        cut->line.progress[1] = progress_at(cut, p, ends + 2);
    if (status == CAMBER_OK && !camber_tile_stitcher_add_point(cut->stitcher, ends + 2))
        status = CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK && is_cut[1])
        status = close_line(cut, true);
    return status;
}

/* A ring that is cut at the border becomes two lines that meet at the ring's first point. This function makes them one
 * line. */
static camber_status close_ring(camber_tile_stitcher *stitcher, size_t first_line, const double *start) {
    if (stitcher->line_count < first_line + 2)
        return CAMBER_OK;
    camber_cut_line *head = &stitcher->lines[first_line], *tail = &stitcher->lines[stitcher->line_count - 1];
    if (head->along_border || tail->along_border || head->cut[0] || tail->cut[1] ||
        !camber_tile_stitcher_same(stitcher->points + 2 * head->first, start) ||
        !camber_tile_stitcher_same(stitcher->points + 2 * (tail->first + tail->count - 1), start))
        return CAMBER_OK;
    for (size_t i = 1; i < head->count; i++) {
        double point[2];
        memcpy(point, stitcher->points + 2 * (head->first + i), sizeof point);
        if (!camber_tile_stitcher_add_point(stitcher, point))
            return CAMBER_ERROR_MEMORY;
    }
    tail->count += head->count - 1;
    tail->cut[1] = head->cut[1];
    tail->border[1] = head->border[1];
    head->count = 0;
    return CAMBER_OK;
}

/* Returns the distance to the next point. */
static double segment_length(const double *point) {
    return camber_length(point[2] - point[0], point[3] - point[1]);
}

static camber_status cut_line(tile_cut *cut, const double *points, size_t count, bool outline) {
    camber_tile_stitcher *stitcher = cut->stitcher;
    const size_t first_line = stitcher->line_count;
    const double *last = points + 2 * (count - 1);
    camber_status status = CAMBER_OK;
    bool moves = false;
    cut->length = cut->done = 0;
    for (size_t i = 1; i < count && cut->progress; i++)
        cut->length += segment_length(points + 2 * (i - 1));
    for (size_t i = 1; i < count && status == CAMBER_OK; i++) {
        moves = moves || !camber_tile_stitcher_same(points, points + 2 * i);
        status = cut_segment(cut, points + 2 * (i - 1), points + 2 * i, outline);
        cut->done += cut->progress ? segment_length(points + 2 * (i - 1)) : 0;
    }
    if (!moves && inside(&cut->box, points)) {
        /* All points are equal, so the line is a dot. */
        status = open_line(cut, points, false, false);
        for (size_t i = 1; i < count && status == CAMBER_OK; i++)
            status = camber_tile_stitcher_add_point(stitcher, points) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    }
    if (status == CAMBER_OK)
        status = close_line(cut, false);
    if (status == CAMBER_OK && moves && !cut->progress && camber_tile_stitcher_same(points, last))
        status = close_ring(stitcher, first_line, points);
    return status;
}

/* Returns the box to which lines are cut. For lines, the box is one tile larger at open sides, to keep the buffer. */
static camber_tile_box box_of(const camber_tile_feature *feature) {
    const double column = feature->column, row = feature->row;
    const unsigned open = feature->area ? 0 : feature->open_sides;
    return (camber_tile_box){{(column - (open & CAMBER_SIDE_WEST ? 1 : 0)) * CAMBER_TILE_UNITS,
                              (row - (open & CAMBER_SIDE_NORTH ? 1 : 0)) * CAMBER_TILE_UNITS},
                             {(column + (open & CAMBER_SIDE_EAST ? 2 : 1)) * CAMBER_TILE_UNITS,
                              (row + (open & CAMBER_SIDE_SOUTH ? 2 : 1)) * CAMBER_TILE_UNITS}};
}

camber_status camber_tile_stitcher_add(camber_tile_stitcher *stitcher, const camber_tile_feature *feature,
                                       const camber_tile_lines *lines) {
    uint32_t index = 0;
    camber_status status = find_feature(stitcher, feature, &index);
    if (status != CAMBER_OK)
        return status;
    tile_cut cut = {.stitcher = stitcher,
                    .box = box_of(feature),
                    .progress = feature->has_progress ? feature->progress : NULL,
                    .line = {.feature = index, .column = feature->column, .row = feature->row, .progress = {0, 1}}};
    stitcher->has_progress |= feature->has_progress;
    size_t first = 0;
    for (size_t i = 0; i < lines->line_count && status == CAMBER_OK; i++) {
        const size_t count = lines->ends[i] - first;
        if (!camber_grow(stitcher->context, &stitcher->scratch, &stitcher->scratch_capacity, count,
                         2 * sizeof *stitcher->scratch))
            return CAMBER_ERROR_MEMORY;
        for (size_t k = 0; k < 2 * count; k++) {
            const double unit = lines->points[2 * first + k] * stitcher->units, near = floor(unit * 16 + 0.5) / 16;
            stitcher->scratch[k] = fabs(unit - near) <= SNAP ? near : unit;
        }
        if (count)
            status = feature->area ? camber_tile_stitcher_add_ring(stitcher, &cut.line, &cut.box, count)
                                   : cut_line(&cut, stitcher->scratch, count, feature->outline);
        first = lines->ends[i];
    }
    return status;
}
