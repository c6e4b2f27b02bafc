/* Cuts the lines of a picture into mesh tiles.
 *
 * Input: the points of a mesh, as the device tessellated them for a picture of tiles. Output: for each tile, the points
 * of the segments within reach of it, in whole units of the tile. Main idea: a segment that touches the tile, extended
 * by the reach of its row, is kept as it is; all others are dropped. So a tile that is clipped to its square looks like
 * this part of the picture. A segment is cut only where it leaves the range of 16 bits.
 *
 *     +-----------------------------+  range of 16 bits: half a tile beyond each side
 *     |      .-----------------.    |
 *     |  a---|--b    tile      |    |      a: first, cut       c: last, cut
 *     |      |   \.____________|_c  |
 *     |      '-----------------'    |
 *     +-----------------------------+ */
#include "tiles/mesh_tile.h"

#include "kernels/layout.h"

#include <math.h>

/* ---- The lines of a picture ---- */

/* Capacities of the lists of a picture. */
typedef struct room {
    size_t lines, points;
} room;

static bool add_point(camber_mesh_picture *picture, room *has, camber_mesh_point point) {
    if (!camber_grow(picture->plan->context, &picture->points, &has->points, picture->point_count + 1,
                     sizeof *picture->points))
        return false;
    picture->points[picture->point_count++] = point;
    camber_mesh_line *line = picture->lines + picture->line_count - 1;
    line->x0 = fminf(line->x0, point.x);
    line->y0 = fminf(line->y0, point.y);
    line->x1 = fmaxf(line->x1, point.x);
    line->y1 = fmaxf(line->y1, point.y);
    line->count++;
    return true;
}

static bool add_line(camber_mesh_picture *picture, room *has, const camber_mesh_point *first) {
    if (!camber_grow(picture->plan->context, &picture->lines, &has->lines, picture->line_count + 1,
                     sizeof *picture->lines))
        return false;
    picture->lines[picture->line_count++] = (camber_mesh_line){.first = picture->point_count,
                                                               .pair = first->info >> CAMBER_POINT_ROW_SHIFT,
                                                               .x0 = first->x,
                                                               .y0 = first->y,
                                                               .x1 = first->x,
                                                               .y1 = first->y};
    return true;
}

/* Lists lines and points. Dots that are not drawn are left out; other dots become a segment from their point to
 * itself. */
static camber_status list_lines(camber_mesh_picture *picture, const camber_stages *stages) {
    room has = {0, 0};
    for (size_t i = 0; i < stages->point_count; i++) {
        const camber_point_stages *p = stages->points + i;
        const camber_mesh_point point = {
            p->x, p->y, p->info, stages->arc_lengths ? stages->arc_lengths[i] : (camber_arc_length){0.0f, 0.0f}};
        const bool begins = p->info & CAMBER_POINT_FIRST;
        if (p->join >> CAMBER_JOIN_KIND_SHIFT == CAMBER_KIND_SENTINEL || (!begins && !picture->line_count))
            continue;
        if ((begins && !add_line(picture, &has, &point)) || !add_point(picture, &has, point) ||
            (begins && p->info & CAMBER_POINT_LAST && !add_point(picture, &has, point)))
            return CAMBER_ERROR_MEMORY;
    }
    return CAMBER_OK;
}

static bool is_seam(const camber_mesh_picture *picture, size_t point) {
    return picture->points[point].info & CAMBER_POINT_RING;
}

/* Links the first and last pieces of rings that the picture has cut, because these pieces meet at the ring's seam. */
static void join_seams(camber_mesh_picture *picture) {
    for (size_t i = 0; i < picture->line_count; i++) {
        camber_mesh_line *begin = picture->lines + i, *end = begin;
        if (begin->count < 2 || !is_seam(picture, begin->first) || is_seam(picture, begin->first + begin->count - 1))
            continue;
        while (++end < picture->lines + picture->line_count && end->pair == begin->pair)
            if (end->count > 1 && is_seam(picture, end->first + end->count - 1)) {
                begin->before = end->first + end->count - 1;
                end->behind = begin->first + 2;
                break;
            }
    }
}

camber_status camber_mesh_picture_take(const camber_mesh_plan *plan, camber_mesh *mesh, camber_mesh_picture *picture) {
    camber_stages stages = {0};
    camber_status status = camber_mesh_read_stages(mesh, &stages);
    *picture = (camber_mesh_picture){.plan = plan};
    if (status == CAMBER_OK)
        status = list_lines(picture, &stages);
    if (status == CAMBER_OK)
        join_seams(picture);
    camber_stages_destroy(&stages);
    return status;
}

void camber_mesh_picture_free(camber_mesh_picture *picture) {
    if (picture->plan) {
        camber_free(picture->plan->context, picture->points);
        camber_free(picture->plan->context, picture->lines);
        camber_free(picture->plan->context, picture->rings);
        camber_free(picture->plan->context, picture->ring_points);
    }
    *picture = (camber_mesh_picture){0};
}

/* ---- Cutting ---- */

typedef struct cutter {
    const camber_mesh_picture *picture;
    camber_mesh_tile *tile;
    double centre_x, centre_y; /* of the tile, in px of the picture */
    double half;               /* half the tile's width, px */
    double limit;              /* range of 16 bits, px from the centre */
    double scale;              /* units per px */
    bool sentinel_is_used;     /* the last sentinel holds the neighbour of a ring, and cannot be shared */
    camber_status failed;      /* CAMBER_OK: no failure */
} cutter;

typedef struct cut_point {
    double x, y; /* px from the centre */
    float along_px, total_px;
} cut_point;

static cut_point point_at(const cutter *c, const camber_mesh_line *line, size_t i) {
    const camber_mesh_point *p = c->picture->points + line->first + i;
    const bool is_along = c->picture->plan->has_arc_length[c->picture->plan->pair_rows[line->pair]];
    return (cut_point){(double)p->x - c->centre_x, (double)p->y - c->centre_y, is_along ? p->at.along_px : 0.0f,
                       is_along ? p->at.total_px : 0.0f};
}

/* Clips a segment to a square about the centre, and sets the fractions at which it enters and leaves. Returns false if
 * it misses the square. */
static bool clip(cut_point a, cut_point b, double half, double *from, double *to) {
    const double start[] = {a.x, a.y}, run[] = {b.x - a.x, b.y - a.y};
    *from = 0.0;
    *to = 1.0;
    for (int k = 0; k < 2; k++) {
        if (fabs(run[k]) > 0.0) {
            const double one = (-half - start[k]) / run[k], other = (half - start[k]) / run[k];
            *from = fmax(*from, fmin(one, other));
            *to = fmin(*to, fmax(one, other));
        } else if (fabs(start[k]) > half) {
            return false;
        }
    }
    return *from <= *to;
}

static cut_point between(cut_point a, cut_point b, double share) {
    return (cut_point){a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share,
                       a.along_px + (b.along_px - a.along_px) * (float)share, a.total_px};
}

static void put(cutter *c, cut_point at, uint16_t row, unsigned flags) {
    camber_mesh_tile *tile = c->tile;
    if (c->failed ||
        !camber_grow(tile->context, &tile->records, &tile->record_capacity, tile->record_count + 1,
                     sizeof *tile->records) ||
        !tile->records) {
        c->failed = CAMBER_ERROR_MEMORY;
        return;
    }
    const camber_mesh_record made = {camber_mesh_quantise(at.x, c->scale),
                                     camber_mesh_quantise(at.y, c->scale),
                                     row,
                                     (uint16_t)flags,
                                     at.along_px,
                                     at.total_px};
    camber_mesh_record *last = tile->record_count ? tile->records + tile->record_count - 1 : NULL;
    const bool repeats = last && last->x == made.x && last->y == made.y;
    if (!(flags & (CAMBER_MESH_SENTINEL | CAMBER_MESH_FIRST)) && repeats) {
        if (!(flags & CAMBER_MESH_LAST))
            return;
        if (!(last->flags & CAMBER_MESH_FIRST)) {
            last->flags |= (uint16_t)flags;
            return;
        }
    }
    tile->records[tile->record_count++] = made;
    tile->segments += !(flags & (CAMBER_MESH_SENTINEL | CAMBER_MESH_FIRST));
}

/* Adds a sentinel before a line, unless the line can share the last sentinel of the previous line. */
static void put_sentinel_before(cutter *c, cut_point first, uint16_t row, bool is_ring) {
    if (!c->tile->record_count || (is_ring && c->sentinel_is_used))
        put(c, first, row, CAMBER_MESH_SENTINEL);
}

static void put_sentinel_behind(cutter *c, cut_point at, uint16_t row, bool is_ring) {
    put(c, at, row, CAMBER_MESH_SENTINEL);
    c->sentinel_is_used = is_ring;
}

/* A line, which may be cut into several runs. */
typedef struct line_walk {
    const camber_mesh_line *line;
    double reach; /* half of the tile plus the reach of the row, px */
    bool is_ring;
    bool has_row; /* row has been numbered, because some of the line is near */
    uint16_t row;
} line_walk;

static bool is_outside(const cutter *c, cut_point p) {
    return fabs(p.x) > c->limit || fabs(p.y) > c->limit;
}

/* Whether the segment that starts at point i comes near the tile. */
static bool is_near(const cutter *c, const line_walk *w, size_t i) {
    double from, to;
    return clip(point_at(c, w->line, i), point_at(c, w->line, i + 1), w->reach, &from, &to);
}

/* Returns the flags of a run's end. own: it is also the end of the line itself. */
static unsigned end_flags(const cutter *c, const line_walk *w, size_t point, bool own) {
    const uint32_t info = c->picture->points[w->line->first + point].info;
    return own && !(info & CAMBER_POINT_CUT) && !w->is_ring ? 0u : CAMBER_MESH_CUT;
}

camber_status camber_mesh_tile_number(camber_mesh_tile *tile, uint32_t row, uint16_t *number) {
    if (!tile->row_slots[row]) {
        if (tile->row_count == INT16_MAX)
            return camber_fail(tile->context, CAMBER_ERROR_LIMIT,
                               "tiles: more than %d kinds of lines and areas in a mesh tile; make the style "
                               "distinguish fewer, or begin at a higher --min-zoom",
                               INT16_MAX);
        if (!camber_grow(tile->context, &tile->rows, &tile->row_capacity, tile->row_count + 1, sizeof *tile->rows))
            return CAMBER_ERROR_MEMORY;
        tile->rows[tile->row_count++] = row;
        tile->row_slots[row] = (uint32_t)tile->row_count;
    }
    *number = (uint16_t)(tile->row_slots[row] - 1);
    return CAMBER_OK;
}

static void number_row(cutter *c, line_walk *w) {
    const camber_status status = camber_mesh_tile_number(c->tile, c->picture->plan->pair_rows[w->line->pair], &w->row);
    c->failed = c->failed ? c->failed : status;
    w->has_row = true;
}

/* Returns a point of the picture, counted from 1, as the neighbour of another point. If it is outside the range of 16
 * bits, it is moved towards that point. */
static cut_point neighbour_of(const cutter *c, cut_point point, size_t neighbour) {
    const camber_mesh_point *p = c->picture->points + neighbour - 1;
    const cut_point other = {.x = (double)p->x - c->centre_x, .y = (double)p->y - c->centre_y};
    double from, to;
    return clip(point, other, c->limit, &from, &to) ? between(point, other, to) : other;
}

/* Begins a run. At the beginning of a piece of a ring, the sentinel before the run holds the neighbour. neighbour: a
 * point, counted from 1; 0: none. */
static void begin_run(cutter *c, line_walk *w, cut_point start, unsigned flags, size_t neighbour) {
    if (!w->has_row)
        number_row(c, w);
    put_sentinel_before(c, start, w->row, neighbour != 0);
    if (neighbour && !c->failed) {
        const cut_point before = neighbour_of(c, start, neighbour);
        camber_mesh_record *sentinel = c->tile->records + c->tile->record_count - 1;
        sentinel->x = camber_mesh_quantise(before.x, c->scale);
        sentinel->y = camber_mesh_quantise(before.y, c->scale);
        flags = CAMBER_MESH_RING;
    }
    put(c, start, w->row, CAMBER_MESH_FIRST | flags);
}

/* Ends a run. At the end of a piece of a ring, the sentinel after the run holds the neighbour. */
static void end_run(cutter *c, const line_walk *w, cut_point stop, unsigned flags, size_t neighbour) {
    cut_point behind = stop;
    if (neighbour) {
        behind = neighbour_of(c, stop, neighbour);
        flags = CAMBER_MESH_RING;
    }
    put(c, stop, w->row, CAMBER_MESH_LAST | flags);
    put_sentinel_behind(c, behind, w->row, neighbour != 0);
}

/* Adds the segments of [first, end) that are near the tile, in order. Segments of a ring are counted around it. */
static void put_runs(cutter *c, line_walk *w, size_t first, size_t end) {
    const size_t segments = w->line->count - 1;
    bool runs = false, near = is_near(c, w, first % segments);
    for (size_t n = first; n < end && !c->failed; n++) {
        const bool near_next = n + 1 < end && is_near(c, w, (n + 1) % segments), is_here = near;
        const size_t i = n % segments;
        const cut_point a = point_at(c, w->line, i), b = point_at(c, w->line, i + 1);
        double from, to;
        near = near_next;
        if (!is_here || !clip(a, b, c->limit, &from, &to))
            continue;
        const bool begins_cut = is_outside(c, a), ends_cut = is_outside(c, b), ends = ends_cut || !near_next;
        if (!runs) {
            const cut_point start = begins_cut ? between(a, b, from) : a;
            const bool own = i == 0 && !begins_cut;
            begin_run(c, w, start, end_flags(c, w, i, own), own ? w->line->before : 0);
        }
        const cut_point stop = ends_cut ? between(a, b, to) : b;
        const bool own_end = i + 1 == segments && !ends_cut;
        if (ends)
            end_run(c, w, stop, end_flags(c, w, i + 1, own_end), own_end ? w->line->behind : 0);
        else
            put(c, stop, w->row, 0u);
        runs = !ends;
    }
}

/* Adds a whole ring to the tile. */
static void put_whole_ring(cutter *c, line_walk *w) {
    const size_t segments = w->line->count - 1;
    camber_mesh_tile *tile = c->tile;
    number_row(c, w);
    put_sentinel_before(c, point_at(c, w->line, 0), w->row, true);
    const size_t first = tile->record_count;
    for (size_t i = 0; i <= segments; i++)
        put(c, point_at(c, w->line, i), w->row,
            i == 0          ? CAMBER_MESH_FIRST | CAMBER_MESH_RING
            : i == segments ? CAMBER_MESH_LAST | CAMBER_MESH_RING
                            : 0u);
    put_sentinel_behind(c, point_at(c, w->line, 0), w->row, true);
    if (c->failed)
        return;
    camber_mesh_record *begin = tile->records + first, *behind = tile->records + tile->record_count - 1;
    begin[-1].x = behind[-2].x;
    begin[-1].y = behind[-2].y;
    behind->x = begin[1].x;
    behind->y = begin[1].y;
}

static void put_ring(cutter *c, line_walk *w) {
    const size_t segments = w->line->count - 1;
    for (size_t i = 0; i < segments; i++)
        if (!is_near(c, w, i) || is_outside(c, point_at(c, w->line, i))) {
            put_runs(c, w, i, i + segments);
            return;
        }
    put_whole_ring(c, w);
}

/* ---- A tile ---- */

/* Whether the line is drawn and its box comes near the tile. */
static bool touches(const cutter *c, const camber_mesh_line *line) {
    const camber_mesh_plan *plan = c->picture->plan;
    const double own = (double)plan->reach_px[plan->pair_rows[line->pair]], reach = c->half + own;
    return line->count > 1 && own >= 0.0 && (double)line->x0 - c->centre_x <= reach &&
           (double)line->x1 - c->centre_x >= -reach && (double)line->y0 - c->centre_y <= reach &&
           (double)line->y1 - c->centre_y >= -reach;
}

/* Chooses the units: as fine as 16 bits allow for the line with the largest reach. */
static void choose_units(cutter *c) {
    const camber_mesh_plan *plan = c->picture->plan;
    double most = 0.0;
    for (size_t i = 0; i < c->picture->line_count + c->picture->ring_count; i++) {
        const camber_mesh_line *line =
            i < c->picture->line_count ? c->picture->lines + i : c->picture->rings + (i - c->picture->line_count);
        if (touches(c, line))
            most = fmax(most, (double)plan->reach_px[plan->pair_rows[line->pair]]);
    }
    c->tile->units = CAMBER_MESH_UNITS;
    do {
        c->scale = c->tile->units / (2.0 * c->half);
        c->limit = 32767.0 / c->scale;
    } while (c->limit < c->half + most + 1.0 && (c->tile->units /= 2) > 1);
}

/* Records that the items up to `end` belong to the set. Returns false if memory is exhausted. */
static bool end_range(camber_context *context, camber_mesh_range **ranges, size_t *count, size_t *capacity,
                      camber_mesh_range range) {
    camber_mesh_range *last = *count ? *ranges + *count - 1 : NULL;
    if (last && last->set == range.set) {
        last->end = range.end;
        return true;
    }
    if (!camber_grow(context, ranges, capacity, *count + 1, sizeof **ranges))
        return false;
    (*ranges)[(*count)++] = range;
    return true;
}

bool camber_mesh_tile_end_fill(camber_mesh_tile *tile, size_t set, size_t first) {
    return end_range(tile->context, &tile->fills, &tile->fill_count, &tile->fill_capacity,
                     (camber_mesh_range){set, first, tile->index_count});
}

static void put_line(cutter *c, const camber_mesh_line *line) {
    camber_mesh_tile *tile = c->tile;
    const camber_mesh_plan *plan = c->picture->plan;
    const uint32_t row = plan->pair_rows[line->pair];
    const camber_mesh_point *begin = c->picture->points + line->first;
    const size_t before = tile->segments, first = tile->record_count ? tile->record_count : 1;
    line_walk w = {.line = line, .reach = c->half + (double)plan->reach_px[row]};
    w.is_ring = line->count > 3 && (begin->info & begin[line->count - 1].info & CAMBER_POINT_RING);
    if (w.is_ring)
        put_ring(c, &w);
    else
        put_runs(c, &w, 0, line->count - 1);
    if (tile->segments == before || c->failed)
        return;
    tile->has_arc_length |= plan->has_arc_length[row];
    const camber_mesh_range range = {camber_mesh_set_of(&plan->zoom->plan, line->pair), first, tile->record_count - 1};
    if (!end_range(tile->context, &tile->ranges, &tile->range_count, &tile->range_capacity, range))
        c->failed = CAMBER_ERROR_MEMORY;
}

static camber_status clear(camber_mesh_tile *tile, const camber_mesh_plan *plan) {
    for (size_t i = 0; i < tile->row_count; i++)
        tile->row_slots[tile->rows[i]] = 0;
    tile->record_count = tile->row_count = tile->range_count = tile->segments = 0;
    tile->corner_count = tile->index_count = tile->fill_count = 0;
    tile->has_arc_length = false;
    if (tile->row_slot_count >= plan->row_count)
        return CAMBER_OK;
    camber_free(tile->context, tile->row_slots);
    tile->row_slot_count = 0;
    if (!(tile->row_slots = camber_alloc_zero(tile->context, plan->row_count, sizeof *tile->row_slots)))
        return CAMBER_ERROR_MEMORY;
    tile->row_slot_count = plan->row_count;
    return CAMBER_OK;
}

camber_status camber_mesh_tile_cut(camber_context *context, const camber_mesh_picture *picture, uint32_t tile_px,
                                   uint32_t x, uint32_t y, camber_mesh_tile *tile) {
    tile->context = context;
    tile->tile_px = tile_px;
    const camber_status status = clear(tile, picture->plan);
    if (status != CAMBER_OK)
        return status;
    cutter c = {.picture = picture,
                .tile = tile,
                .centre_x = ((double)x + 0.5) * tile_px,
                .centre_y = ((double)y + 0.5) * tile_px,
                .half = 0.5 * tile_px};
    choose_units(&c);
    for (size_t i = 0; i < picture->line_count && !c.failed; i++)
        if (touches(&c, picture->lines + i))
            put_line(&c, picture->lines + i);
    return c.failed;
}

void camber_mesh_tile_free(camber_mesh_tile *tile) {
    if (!tile->context)
        return;
    camber_free(tile->context, tile->records);
    camber_free(tile->context, tile->rows);
    camber_free(tile->context, tile->ranges);
    camber_free(tile->context, tile->corners);
    camber_free(tile->context, tile->triangles);
    camber_free(tile->context, tile->fills);
    camber_free(tile->context, tile->row_slots);
    camber_triangulator_destroy(tile->triangulator);
    *tile = (camber_mesh_tile){0};
}
