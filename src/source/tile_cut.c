/* Cuts features at the borders of their vector tiles, for join.c to join.
 *
 * A tile holds a feature's points inside it and in a buffer around it, so neighbours hold the buffer's lines
 * twice. Each piece is cut at its tile's border, where the neighbour's piece goes on:
 *
 *         tile A    |    tile B
 *     a ------------c - - -            A's piece, with its buffer
 *             - - - c ------------ b   B's piece
 */
#include "source/tile_stitcher.h"

#include <math.h>
#include <string.h>

/* Coordinates come through metres; what lies this close to a multiple of 1/16 unit was one. */
static const double SNAP = 0.01 / 16;

camber_status camber_tile_stitcher_create(camber_context *context, int zoom, camber_tile_stitcher **tiles) {
    camber_tile_stitcher *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->units = ldexp(CAMBER_TILE_UNITS, zoom);
    made->grid = 1;
    *tiles = made;
    return CAMBER_OK;
}

void camber_tile_stitcher_destroy(camber_tile_stitcher *tiles) {
    if (!tiles)
        return;
    camber_context *context = tiles->context;
    camber_free(context, tiles->scratch);
    camber_free(context, tiles->slots);
    camber_free(context, tiles->features);
    camber_free(context, tiles->pieces);
    camber_free(context, tiles->points);
    camber_free(context, tiles);
}

/* ---- Features: one record for all the pieces with one id ---- */

static size_t id_slot(const camber_tile_stitcher *tiles, uint64_t id, uint32_t class_index) {
    return (size_t)camber_mix(camber_mix(0, id), class_index) & (tiles->slot_count - 1);
}

static bool grow_slots(camber_tile_stitcher *tiles) {
    const size_t count = tiles->slot_count ? 2 * tiles->slot_count : 1024;
    uint32_t *slots = camber_alloc_zero(tiles->context, count, sizeof *slots);
    if (!slots)
        return false;
    camber_free(tiles->context, tiles->slots);
    tiles->slots = slots;
    tiles->slot_count = count;
    for (size_t i = 0; i < tiles->feature_count; i++) {
        camber_cut_feature *record = &tiles->features[i];
        if (!record->has_id)
            continue;
        const size_t slot = id_slot(tiles, record->id, record->class_index);
        record->next = slots[slot];
        slots[slot] = (uint32_t)i + 1;
    }
    return true;
}

static camber_status find_feature(camber_tile_stitcher *tiles, const camber_tile_feature *feature, uint32_t *index) {
    if (tiles->feature_count >= tiles->slot_count && !grow_slots(tiles))
        return CAMBER_ERROR_MEMORY;
    const size_t slot = id_slot(tiles, feature->id, feature->class_index);
    for (uint32_t i = feature->has_id ? tiles->slots[slot] : 0; i; i = tiles->features[i - 1].next) {
        const camber_cut_feature *record = &tiles->features[i - 1];
        if (record->id == feature->id && record->class_index == feature->class_index) {
            *index = i - 1;
            return CAMBER_OK;
        }
    }
    if (tiles->feature_count >= UINT32_MAX - 1)
        return camber_fail(tiles->context, CAMBER_ERROR_LIMIT,
                           "more than 4294967294 features in tiles; select fewer with an attribute filter");
    if (!camber_grow(tiles->context, &tiles->features, &tiles->feature_capacity, tiles->feature_count + 1,
                     sizeof *tiles->features))
        return CAMBER_ERROR_MEMORY;
    camber_cut_feature record = {.id = feature->id, .class_index = feature->class_index, .has_id = feature->has_id};
    if (record.has_id) {
        record.next = tiles->slots[slot];
        tiles->slots[slot] = (uint32_t)tiles->feature_count + 1;
    }
    tiles->features[tiles->feature_count] = record;
    *index = (uint32_t)tiles->feature_count++;
    return CAMBER_OK;
}

/* ---- Cutting at the border ---- */

typedef struct tile_box {
    double low[2], high[2];
} tile_box;

typedef struct tile_cut {
    camber_tile_stitcher *tiles;
    tile_box box;
    camber_cut_line piece; /* the open one where open; its place and feature hold for all */
    bool open;
    const double *progress; /* NULL: none */
    double length, done;    /* of the part, and of it before the segment */
} tile_cut;

static bool on_border(const tile_box *box, const double *point) {
    return point[0] == box->low[0] || point[0] == box->high[0] || point[1] == box->low[1] || point[1] == box->high[1];
}

static bool inside(const tile_box *box, const double *point) {
    return point[0] >= box->low[0] && point[0] <= box->high[0] && point[1] >= box->low[1] && point[1] <= box->high[1];
}

static bool along_border(const tile_box *box, const double *p, const double *q) {
    for (int axis = 0; axis < 2; axis++)
        if (p[axis] == q[axis] && (p[axis] == box->low[axis] || p[axis] == box->high[axis]))
            return true;
    return false;
}

/* Liang and Barsky: the part of the segment p q inside the box, ends put on the border exactly. false: none, or a
 * point only. */
static bool clip_segment(const tile_box *box, const double *p, const double *q, double ends[4], bool cut[2]) {
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

static bool add_point(camber_tile_stitcher *tiles, const double *point) {
    if (!camber_grow(tiles->context, &tiles->points, &tiles->point_capacity, tiles->point_count + 1,
                     2 * sizeof *tiles->points))
        return false;
    memcpy(tiles->points + 2 * tiles->point_count++, point, 2 * sizeof *point);
    return true;
}

static camber_status close_piece(tile_cut *cut, bool is_cut) {
    camber_tile_stitcher *tiles = cut->tiles;
    if (!cut->open)
        return CAMBER_OK;
    cut->open = false;
    camber_cut_line *piece = &cut->piece;
    piece->count = tiles->point_count - piece->first;
    piece->cut[1] = is_cut;
    piece->border[0] = on_border(&cut->box, tiles->points + 2 * piece->first);
    piece->border[1] = on_border(&cut->box, tiles->points + 2 * (tiles->point_count - 1));
    if (tiles->piece_count >= UINT32_MAX / 2 - 1)
        return camber_fail(tiles->context, CAMBER_ERROR_LIMIT,
                           "more than 2147483646 pieces in tiles; select fewer with an attribute filter");
    if (!camber_grow(tiles->context, &tiles->pieces, &tiles->piece_capacity, tiles->piece_count + 1,
                     sizeof *tiles->pieces))
        return CAMBER_ERROR_MEMORY;
    tiles->pieces[tiles->piece_count++] = *piece;
    return CAMBER_OK;
}

static camber_status open_piece(tile_cut *cut, const double *point, bool is_cut, bool run) {
    cut->open = true;
    cut->piece.first = cut->tiles->point_count;
    cut->piece.cut[0] = is_cut;
    cut->piece.run = run;
    return add_point(cut->tiles, point) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

static float progress_at(const tile_cut *cut, const double *p, const double *at) {
    const double along = cut->done + hypot(at[0] - p[0], at[1] - p[1]);
    return (float)(cut->progress[0] + (cut->progress[1] - cut->progress[0]) * (along / cut->length));
}

static camber_status cut_segment(tile_cut *cut, const double *p, const double *q, bool outline) {
    if (camber_tile_stitcher_same(p, q))
        return cut->open && !add_point(cut->tiles, q) ? CAMBER_ERROR_MEMORY : CAMBER_OK;
    double ends[4];
    bool is_cut[2];
    if (!clip_segment(&cut->box, p, q, ends, is_cut))
        return close_piece(cut, false);
    const bool run = along_border(&cut->box, ends, ends + 2);
    camber_status status = CAMBER_OK;
    if (is_cut[0] || (cut->open && run != cut->piece.run) || (run && outline))
        status = close_piece(cut, false);
    if (status != CAMBER_OK || (run && outline))
        return status;
    if (!cut->open) {
        status = open_piece(cut, ends, is_cut[0], run);
        if (cut->progress)
            cut->piece.progress[0] = progress_at(cut, p, ends);
    }
    if (cut->progress)
        cut->piece.progress[1] = progress_at(cut, p, ends + 2);
    if (status == CAMBER_OK && !add_point(cut->tiles, ends + 2))
        status = CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK && is_cut[1])
        status = close_piece(cut, true);
    return status;
}

/* A ring that the border cuts comes in two pieces at the point where it happens to begin: makes them one. */
static camber_status close_ring(camber_tile_stitcher *tiles, size_t first_piece, const double *start) {
    if (tiles->piece_count < first_piece + 2)
        return CAMBER_OK;
    camber_cut_line *head = &tiles->pieces[first_piece], *tail = &tiles->pieces[tiles->piece_count - 1];
    if (head->run || tail->run || head->cut[0] || tail->cut[1] ||
        !camber_tile_stitcher_same(tiles->points + 2 * head->first, start) ||
        !camber_tile_stitcher_same(tiles->points + 2 * (tail->first + tail->count - 1), start))
        return CAMBER_OK;
    for (size_t i = 1; i < head->count; i++) {
        double point[2];
        memcpy(point, tiles->points + 2 * (head->first + i), sizeof point);
        if (!add_point(tiles, point))
            return CAMBER_ERROR_MEMORY;
    }
    tail->count += head->count - 1;
    tail->cut[1] = head->cut[1];
    tail->border[1] = head->border[1];
    head->count = 0;
    return CAMBER_OK;
}

/* To the next point. */
static double segment_length(const double *point) {
    return hypot(point[2] - point[0], point[3] - point[1]);
}

static camber_status cut_part(tile_cut *cut, const double *points, size_t count, bool outline) {
    camber_tile_stitcher *tiles = cut->tiles;
    const size_t first_piece = tiles->piece_count;
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
        /* A dot: all points are one. */
        status = open_piece(cut, points, false, false);
        for (size_t i = 1; i < count && status == CAMBER_OK; i++)
            status = add_point(tiles, points) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    }
    if (status == CAMBER_OK)
        status = close_piece(cut, false);
    if (status == CAMBER_OK && moves && !cut->progress && camber_tile_stitcher_same(points, last))
        status = close_ring(tiles, first_piece, points);
    return status;
}

/* A whole tile more where the buffer is kept: what lies beyond is no buffer. */
static tile_box box_of(const camber_tile_feature *feature) {
    const double column = feature->column, row = feature->row;
    const unsigned open = feature->open_sides;
    return (tile_box){{(column - (open & CAMBER_SIDE_WEST ? 1 : 0)) * CAMBER_TILE_UNITS,
                       (row - (open & CAMBER_SIDE_NORTH ? 1 : 0)) * CAMBER_TILE_UNITS},
                      {(column + (open & CAMBER_SIDE_EAST ? 2 : 1)) * CAMBER_TILE_UNITS,
                       (row + (open & CAMBER_SIDE_SOUTH ? 2 : 1)) * CAMBER_TILE_UNITS}};
}

camber_status camber_tile_stitcher_add(camber_tile_stitcher *tiles, const camber_tile_feature *feature,
                                       const camber_tile_lines *parts) {
    uint32_t index = 0;
    camber_status status = find_feature(tiles, feature, &index);
    if (status != CAMBER_OK)
        return status;
    tile_cut cut = {.tiles = tiles,
                    .box = box_of(feature),
                    .progress = feature->has_progress ? feature->progress : NULL,
                    .piece = {.feature = index, .column = feature->column, .row = feature->row, .progress = {0, 1}}};
    tiles->has_progress |= feature->has_progress;
    size_t first = 0;
    for (size_t i = 0; i < parts->part_count && status == CAMBER_OK; i++) {
        const size_t count = parts->ends[i] - first;
        if (!camber_grow(tiles->context, &tiles->scratch, &tiles->scratch_capacity, count, 2 * sizeof *tiles->scratch))
            return CAMBER_ERROR_MEMORY;
        for (size_t k = 0; k < 2 * count; k++) {
            const double unit = parts->points[2 * first + k] * tiles->units, near = floor(unit * 16 + 0.5) / 16;
            tiles->scratch[k] = fabs(unit - near) <= SNAP ? near : unit;
        }
        if (count)
            status = cut_part(&cut, tiles->scratch, count, feature->outline);
        first = parts->ends[i];
    }
    return status;
}
