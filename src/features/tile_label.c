/* Chooses the piece of an area that symbol layers label, if vector tiles have cut the area.
 *
 * Input: the rings of label areas in a stitcher, cut to their tiles. Output: of pieces that meet at the tiles' borders
 * only the largest. Main idea: a piece runs along the border where it was cut, and so does the piece in the next tile.
 * Pieces of a class whose edges overlap there are one area.
 *
 *      tile A  |  tile B
 *      .-------|------.
 *      |       |      |      B's edge is above A's, so they are one area. A's piece is larger: it has the label.
 *      |       |------'
 *      '-------|
 */
#include "features/rings.h"
#include "features/tile_stitcher.h"

#include <math.h>
#include <stdlib.h>

/* An outer ring and its holes: lines [first, end). */
typedef struct piece {
    size_t first, end;
    double area;
    size_t group; /* a piece of the same area, which may be this one */
} piece;

/* An edge along a side of its tile: from low to high on the line where the coordinate `axis` is `at`. */
typedef struct border_edge {
    uint32_t class_index;
    int axis;
    double at, low, high;
    size_t piece;
} border_edge;

typedef struct chooser {
    camber_tile_stitcher *stitcher;
    piece *pieces;
    size_t piece_count, piece_capacity;
    border_edge *edges;
    size_t edge_count, edge_capacity;
} chooser;

static bool add_edges(chooser *c, const camber_cut_line *line) {
    const camber_tile_stitcher *s = c->stitcher;
    const uint32_t tile[2] = {line->column, line->row};
    for (size_t i = line->first; i + 1 < line->first + line->count; i++) {
        const double *p = s->points + 2 * i, *q = p + 2;
        for (int axis = 0; axis < 2; axis++) {
            const double side = p[axis] / CAMBER_TILE_UNITS - tile[axis], a = p[1 - axis], b = q[1 - axis];
            if (p[axis] != q[axis] || a == b || (side != 0.0 && side != 1.0))
                continue;
            if (!camber_grow(s->context, &c->edges, &c->edge_capacity, c->edge_count + 1, sizeof *c->edges))
                return false;
            c->edges[c->edge_count++] = (border_edge){
                s->features[line->feature].class_index, axis, p[axis], fmin(a, b), fmax(a, b), c->piece_count - 1};
        }
    }
    return true;
}

/* Whether a ring comes right after those of a piece, and is of the same feature and tile. */
static bool follows(const camber_tile_stitcher *s, const piece *of, size_t ring) {
    const camber_cut_line *p = s->lines + of->first, *q = s->lines + ring;
    return of->end == ring && p->feature == q->feature && p->column == q->column && p->row == q->row;
}

/* Finds the pieces and their edges on borders. Holes come after their outer ring. */
static bool find_pieces(chooser *c, const camber_features *features) {
    const camber_tile_stitcher *s = c->stitcher;
    for (size_t i = 0; i < s->line_count; i++) {
        const camber_cut_line *line = s->lines + i;
        const uint32_t class_index = s->features[line->feature].class_index;
        if (line->count == 0 || features->classes[class_index].geometry != CAMBER_GEOMETRY_LABEL_AREA)
            continue;
        const double area = camber_ring_area(s->points + 2 * line->first, line->count);
        if (area > 0.0 || c->piece_count == 0 || !follows(s, c->pieces + c->piece_count - 1, i)) {
            if (!camber_grow(s->context, &c->pieces, &c->piece_capacity, c->piece_count + 1, sizeof *c->pieces))
                return false;
            c->pieces[c->piece_count] = (piece){.first = i, .group = c->piece_count};
            c->piece_count++;
        }
        piece *of = c->pieces + c->piece_count - 1;
        of->end = i + 1;
        of->area += area;
        if (!add_edges(c, line))
            return false;
    }
    return true;
}

static int compare_edges(const void *a, const void *b) {
    const border_edge *p = a, *q = b;
    if (p->class_index != q->class_index)
        return p->class_index < q->class_index ? -1 : 1;
    if (p->axis != q->axis)
        return p->axis - q->axis;
    if (p->at != q->at)
        return p->at < q->at ? -1 : 1;
    return (p->low > q->low) - (p->low < q->low);
}

static size_t group_of(chooser *c, size_t piece_index) {
    while (c->pieces[piece_index].group != piece_index)
        piece_index = c->pieces[piece_index].group = c->pieces[c->pieces[piece_index].group].group;
    return piece_index;
}

/* Puts pieces into one group whose edges on a border overlap. */
static void join_pieces(chooser *c) {
    qsort(c->edges, c->edge_count, sizeof *c->edges, compare_edges);
    for (size_t i = 0, longest = 0; i < c->edge_count; i++) {
        const border_edge *before = c->edges + longest, *edge = c->edges + i;
        const bool same_line =
            before->class_index == edge->class_index && before->axis == edge->axis && before->at == edge->at;
        if (same_line && edge->low < before->high)
            c->pieces[group_of(c, edge->piece)].group = group_of(c, before->piece);
        if (!same_line || edge->high > before->high)
            longest = i;
    }
}

/* Whether a piece has the label rather than another one: the larger one, or the one farther north-west. */
static bool is_before(const chooser *c, const piece *a, const piece *b) {
    const camber_cut_line *p = c->stitcher->lines + a->first, *q = c->stitcher->lines + b->first;
    if (a->area != b->area)
        return a->area > b->area;
    if (p->row != q->row || p->column != q->column)
        return p->row != q->row ? p->row < q->row : p->column < q->column;
    const double *at = c->stitcher->points + 2 * p->first, *other = c->stitcher->points + 2 * q->first;
    return at[1] != other[1] ? at[1] < other[1] : at[0] < other[0];
}

/* Removes all pieces of an area but one. */
static bool keep_largest(chooser *c) {
    size_t *largest = camber_alloc(c->stitcher->context, c->piece_count, sizeof *largest);
    if (!largest)
        return false;
    for (size_t i = 0; i < c->piece_count; i++)
        largest[i] = i;
    for (size_t i = 0; i < c->piece_count; i++) {
        size_t *of = largest + group_of(c, i);
        if (is_before(c, c->pieces + i, c->pieces + *of))
            *of = i;
    }
    for (size_t i = 0; i < c->piece_count; i++)
        for (size_t k = c->pieces[i].first; k < c->pieces[i].end && largest[group_of(c, i)] != i; k++)
            c->stitcher->lines[k].count = 0;
    camber_free(c->stitcher->context, largest);
    return true;
}

camber_status camber_tile_stitcher_keep_largest(camber_tile_stitcher *labels, const camber_features *features) {
    chooser c = {.stitcher = labels};
    bool made = find_pieces(&c, features);
    if (made && c.edge_count) {
        join_pieces(&c);
        made = keep_largest(&c);
    }
    camber_free(labels->context, c.edges);
    camber_free(labels->context, c.pieces);
    return made ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}
