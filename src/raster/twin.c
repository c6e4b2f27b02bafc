/* The rasterizer's CPU twin: computes the same segments, boxes, lists and pixels as the kernels. It takes one segment,
 * tile and pixel at a time, without chunks and sums. This file makes everything except the pixels. */
#include "raster/twin.h"

#include "camber_proof.h"
#include "kernels/join.h"

#include <math.h>
#include <string.h>

/* ---- Segments ---- */

/* Returns a word's index; outside the part, the index of the nearest word in it. */
static size_t word_at(int64_t i, const camber_setup_args *r) {
    const int64_t last = (int64_t)r->slot_count + 1;
    return (size_t)(i < 0 ? 0 : i > last ? last : i);
}

/* Returns a slot's number; outside the part, the number of the nearest slot in it. */
static size_t slot_at(int64_t slot, const camber_setup_args *r) {
    const int64_t last = (int64_t)r->slot_count - 1;
    return (size_t)(slot < 0 ? 0 : slot > last ? last : slot);
}

/* A point with its join word and its info, as setup reads them. */
typedef struct point {
    float x, y;
    uint32_t join, info;
} point;

static point point_at(const camber_part_points *part, int64_t word, const camber_setup_args *r) {
    const size_t i = word_at(word, r);
    return (point){part->x[i], part->y[i], part->joins[i], part->info[i]};
}

static bool ends_segment(const point *b, bool is_edge) {
    const uint32_t kind = camber_join_kind(b->join);
    const bool follows = b->info & CAMBER_POINT_REAL && !(b->info & CAMBER_POINT_FIRST);
    return is_edge ? follows : kind == CAMBER_KIND_DOT || (follows && kind != CAMBER_KIND_SENTINEL);
}

/* The point that may end a segment in a slot, and the two before it. */
typedef struct three_points {
    point b, before, first;
    bool ends; /* b ends a segment */
} three_points;

static three_points points_of(const camber_part_points *part, const camber_setup_args *r, int64_t slot) {
    three_points p = {point_at(part, slot + 1, r), point_at(part, slot, r), point_at(part, slot - 1, r), false};
    p.ends = slot < r->end && ends_segment(&p.b, r->makes_edges);
    return p;
}

/* Writes how far along its line a segment is, from the arc lengths of its two points. */
static void put_arc_length(const camber_arc_length *arc_lengths, size_t from, size_t to, const camber_segment *s,
                           float arc_length[CAMBER_SEGMENT_ARC_LENGTHS]) {
    memset(arc_length, 0, CAMBER_SEGMENT_ARC_LENGTHS * sizeof *arc_length);
    if (!arc_lengths)
        return;
    arc_length[0] = arc_lengths[from].along_px;
    arc_length[1] = camber_segment_rate(s, arc_lengths[from].along_px, arc_lengths[to].along_px);
    arc_length[2] = arc_lengths[from].total_px;
}

static void put_words(const camber_segment *s, float brush, float *made) {
    const float words[CAMBER_SEGMENT_WORDS] = {s->ax,    s->ay,    s->bx,  s->by,  s->ux,         s->uy,
                                               s->nax,   s->nay,   s->nbx, s->nby, s->half_width, s->reach,
                                               s->slope, s->curve, 0,      brush};
    memcpy(made, words, sizeof words);
    made[CAMBER_SEGMENT_FLAGS] = camber_float_of(s->flags);
}

static void put_plane(const camber_segment *s, const camber_plane *p, camber_eye e, float *made) {
    const float words[] = {
        s->ax,         s->ay,      s->bx,         s->by,          s->ux,          s->uy,      s->nax,     s->nay,
        s->nbx,        s->nby,     s->half_width, p->cut_a.owner, p->cut_b.owner, p->cut_a.x, p->cut_a.y, p->cut_a.at,
        p->cut_a.wide, p->cut_b.x, p->cut_b.y,    p->cut_b.at,    p->cut_b.wide,  p->ends,    p->margin,  p->left[0],
        p->left[1],    p->left[2], p->right[0],   p->right[1],    p->right[2],    e.cosine,   e.fall,     0};
    _Static_assert(sizeof words == 4 * CAMBER_PLANE_WORDS, "all words of a plane");
    memcpy(made, words, sizeof words);
}

/* Returns the brush of the edge that ends in a slot, given the brush of its row. */
static float brush_of(const camber_twin *t, const camber_setup_args *r, int64_t slot, float of_row) {
    const uint32_t *changes = r->change_count ? t->changes + r->first_change : NULL;
    const uint32_t passed = r->changes_before + camber_changes_until(changes, r->change_count, (uint32_t)slot);
    return camber_float_of(camber_bits_of(of_row) + passed);
}

static void put_edge(const camber_segment *s, float brush, float *edges, size_t which) {
    const float ends[] = {s->ax, s->ay, s->bx, s->by};
    memcpy(edges + camber_edge_ends(which), ends, sizeof ends);
    edges[camber_edge_brush(which)] = brush;
}

/* Writes the words of the segment, or of the edge of a ring, that ends in a slot. Its box says whether there is one. */
static void put_segment(const camber_twin *t, const camber_part_points *part, const camber_setup_args *r, int64_t slot,
                        size_t segment) {
    const three_points points = points_of(part, r, slot);
    const point b = points.b, p = points.first;
    const bool is_edge = r->makes_edges, ends = points.ends;
    const bool is_dot = !is_edge && camber_join_kind(b.join) == CAMBER_KIND_DOT;
    const point a = is_dot ? b : points.before;
    const float *row =
        t->scene->rows + CAMBER_RASTER_ROW_WORDS * (r->first_row + (ends ? b.info >> CAMBER_POINT_ROW_SHIFT : 0));
    const float x = row[1] - r->eye.x, y = row[2] - r->eye.y; /* 0 if there is no pitch */
    camber_segment s;
    bool drawn = ends && row[0] >= 0.0f;
    if (is_edge) {
        camber_edge_segment(a.x + x, a.y + y, b.x + x, b.y + y, &s);
        const camber_segment flat = s;
        drawn = drawn && (!t->scene->pitched || camber_pitch_edge_of(r->eye, &flat, &s));
        const uint32_t box = camber_segment_box(&s, drawn, r->left, r->top, r->columns, r->rows);
        const float brush = box == CAMBER_NO_BOX ? camber_float_of(CAMBER_NO_EDGE) : brush_of(t, r, slot, row[3]);
        put_edge(&s, brush, t->stages->edges, segment);
        t->stages->boxes[segment] = box;
        return;
    }
    camber_segment_of(p.x + x, p.y + y, a.x + x, a.y + y, b.x + x, b.y + y, a.join, b.join, row[0], r->linear, &s);
    if (t->stages->arc_lengths)
        put_arc_length(part->arc_lengths, slot_at(is_dot ? slot : slot - 1, r), slot_at(slot, r), &s,
                       t->stages->arc_lengths + CAMBER_SEGMENT_ARC_LENGTHS * segment);
    if (t->stages->planes) {
        camber_segment footprint;
        camber_plane plane;
        drawn = drawn && camber_pitch_segment_of(r->eye, r->horizon, &s, &footprint, &plane);
        if (drawn) {
            put_plane(&s, &plane, r->eye, t->stages->planes + CAMBER_PLANE_WORDS * segment);
            s = footprint;
        }
    }
    put_words(&s, row[3], t->stages->segments + CAMBER_SEGMENT_WORDS * segment);
    if (r->among_edges && t->stages->edges)
        t->stages->edges[camber_edge_brush(segment)] = camber_float_of(CAMBER_NO_EDGE);
    t->stages->boxes[segment] = camber_segment_box(&s, drawn, r->left, r->top, r->columns, r->rows);
}

static camber_status make_segments(const camber_twin *t, const camber_range_list *list) {
    const camber_slot_range *ranges = list->ranges;
    camber_status status = CAMBER_OK;
    for (size_t p = 0; p < list->count && status == CAMBER_OK; p++) {
        const camber_setup_args r = camber_raster_setup_args(t->scene, ranges + p, t->area);
        camber_part_points part = {0};
        status = camber_part_read_points(ranges[p].mesh, ranges[p].mesh->parts + ranges[p].part, &part);
        const size_t count = (ranges[p].end - ranges[p].first + 15) / 16 * 16;
        for (size_t i = 0; i < count && status == CAMBER_OK; i++)
            put_segment(t, &part, &r, (int64_t)(ranges[p].first + i), ranges[p].base + i);
        camber_part_points_free(t->context, &part);
    }
    return status;
}

/* ---- Lists ---- */

static void add_to_list(const camber_twin *t, uint32_t entry, uint32_t *count, bool fill) {
    if (fill)
        t->stages->lists[*count] = entry;
    ++*count;
}

/* Does the same as each_tile for the rows of tiles whose tops the segment may cross as the edge of a ring. */
static void each_row(const camber_twin *t, size_t segment, uint32_t *counts, bool fill) {
    const uint32_t box = t->stages->boxes[segment];
    if (CAMBER_BOX_FIRST_X(box) > CAMBER_BOX_LAST_X(box) || segment < t->first_edge || segment >= t->end_edge)
        return;
    for (uint32_t y = camber_first_top(box); y <= CAMBER_BOX_LAST_Y(box); y++)
        add_to_list(t, (uint32_t)segment, counts + t->stages->tile_count + y, fill);
}

/* Counts a segment in each tile that it touches, or adds it to their lists. */
static void each_tile(const camber_twin *t, size_t segment, uint32_t *counts, bool fill) {
    const uint32_t box = t->stages->boxes[segment];
    const uint32_t x0 = box & 255u, y0 = box >> 8 & 255u, x1 = box >> 16 & 255u, y1 = box >> 24;
    const camber_tile_grid of = {(float)t->area->x, (float)t->area->y, t->columns, t->rows};
    const bool is_edge = camber_twin_is_edge(t, segment);
    const float *words =
        is_edge ? t->stages->edges + camber_edge_ends(segment) : t->stages->segments + CAMBER_SEGMENT_WORDS * segment;
    for (uint32_t y = y0; x0 <= x1 && y <= y1; y++) {
        const uint32_t span = camber_tile_span(words, is_edge, box, y, &of);
        for (uint32_t x = span & 255u; x <= span >> 8; x++)
            add_to_list(t, (uint32_t)segment, counts + y * t->columns + x, fill);
    }
    each_row(t, segment, counts, fill);
}

/* Does the same for sixteen edges that are a bunch, of which `from` is the number of the first. */
static void each_tile_of_bunch(const camber_twin *t, uint32_t bunch, size_t from, uint32_t *counts, bool fill) {
    const uint32_t entry = ((uint32_t)from + CAMBER_BUNCH_FIRST(bunch)) | CAMBER_LISTED_BUNCH;
    for (uint32_t y = CAMBER_BUNCH_Y(bunch); y <= CAMBER_BUNCH_LAST_Y(bunch); y++)
        for (uint32_t x = CAMBER_BUNCH_X(bunch); x <= CAMBER_BUNCH_LAST_X(bunch); x++)
            add_to_list(t, entry, counts + y * t->columns + x, fill);
    for (size_t i = from; i < from + 16; i++)
        each_row(t, i, counts, fill);
}

/* Returns the bunch that sixteen segments are, of which `from` is the number of the first. */
static uint32_t bunch_at(const camber_twin *t, size_t from) {
    uint32_t brushes[16];
    if (from < t->first_edge || from >= t->end_edge)
        return CAMBER_NO_BUNCH;
    for (size_t k = 0; k < 16; k++)
        brushes[k] = camber_bits_of(t->stages->edges[camber_edge_brush(from + k)]);
    const uint32_t bunch = camber_bunch_of(t->stages->boxes + from, brushes);
    const bool of_lines = bunch != CAMBER_NO_BUNCH && !camber_twin_is_edge(t, from + CAMBER_BUNCH_FIRST(bunch));
    return of_lines ? CAMBER_NO_BUNCH : bunch;
}

/* Does the same for all segments, in their order. */
static void each_segment(const camber_twin *t, uint32_t *counts, bool fill) {
    for (size_t i = 0; i < t->stages->segment_count; i += 16) {
        const uint32_t bunch = bunch_at(t, i);
        if (bunch != CAMBER_NO_BUNCH)
            each_tile_of_bunch(t, bunch, i, counts, fill);
        for (size_t k = i; k < i + 16 && bunch == CAMBER_NO_BUNCH; k++)
            each_tile(t, k, counts, fill);
    }
}

static camber_status make_lists(const camber_twin *t) {
    camber_raster_stages *stages = t->stages;
    uint32_t *next = camber_alloc_zero(t->context, stages->list_count, sizeof *next);
    if (!next)
        return CAMBER_ERROR_MEMORY;
    each_segment(t, next, false);
    stages->starts[0] = 0;
    for (size_t i = 0; i < stages->list_count; i++) {
        stages->starts[i + 1] = stages->starts[i] + next[i];
        next[i] = stages->starts[i];
    }
    stages->lists = camber_alloc(t->context, stages->starts[stages->list_count], sizeof *stages->lists);
    if (stages->lists)
        each_segment(t, next, true);
    camber_free(t->context, next);
    return stages->lists ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

camber_status camber_raster_on_host(camber_context *context, const camber_raster_scene *scene,
                                    const camber_raster_area *area, camber_raster_stages *stages) {
    camber_raster_stages made = {0};
    camber_range_list list;
    camber_status status = camber_raster_list_ranges(context, scene, &list);
    const camber_twin t = {.context = context,
                           .scene = scene,
                           .area = area,
                           .stages = &made,
                           .changes = list.changes,
                           .columns = camber_raster_tiles(area->width),
                           .rows = camber_raster_tiles(area->height),
                           .first_edge = list.first_edge,
                           .end_edge = list.end_edge};
    made.segment_count = list.segment_count;
    made.tile_count = (size_t)t.columns * t.rows;
    made.list_count = made.tile_count + (t.end_edge ? t.rows : 0);
    made.segments = camber_alloc(context, made.segment_count, CAMBER_SEGMENT_WORDS * sizeof *made.segments);
    if (t.end_edge)
        made.edges = camber_alloc(context, made.segment_count / 16, CAMBER_SIXTEEN_EDGES_WORDS * sizeof *made.edges);
    made.boxes = camber_alloc(context, made.segment_count, sizeof *made.boxes);
    if (scene->brush_ext)
        made.arc_lengths =
            camber_alloc(context, made.segment_count, CAMBER_SEGMENT_ARC_LENGTHS * sizeof *made.arc_lengths);
    if (scene->pitched)
        made.planes = camber_alloc(context, made.segment_count, CAMBER_PLANE_WORDS * sizeof *made.planes);
    made.starts = camber_alloc(context, made.list_count + 1, sizeof *made.starts);
    made.rgba = camber_alloc(context, 4 * (size_t)area->width, area->height);
    if (status == CAMBER_OK &&
        (!made.segments || (t.end_edge && !made.edges) || !made.boxes || (scene->brush_ext && !made.arc_lengths) ||
         (scene->pitched && !made.planes) || !made.starts || !made.rgba))
        status = CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK)
        status = make_segments(&t, &list);
    if (status == CAMBER_OK)
        status = make_lists(&t);
    if (status == CAMBER_OK)
        status = scene->pitched ? camber_twin_draw_pitched(&t) : camber_twin_draw(&t);
    camber_raster_free_ranges(&list);
    if (status != CAMBER_OK) {
        camber_raster_stages_free(context, &made);
        return status;
    }
    camber_raster_stages_show_edges(context, &made, t.first_edge, t.end_edge);
    *stages = made;
    return CAMBER_OK;
}
