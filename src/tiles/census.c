/* Takes the census of a zoom: finds the tiles that lines touch and areas cover, before anything is drawn.
 *
 * Input: features and a zoom's plan. Output: metatiles along the Hilbert curve, each with the tiles that a line comes
 * near and the polylines to draw. Main idea: walk the points that the zoom draws, with tiles as the unit of length, and
 * mark the tiles within reach of each segment's stroke. Tiles inside an area's ring are marked too. The polylines are
 * divided into shares, which threads take one after another. Each share has a table of metatiles. The tables are merged
 * in order, so the result does not depend on the threads.
 *
 *     +-----+-----+-----+
 *     |  x  |  x  |     |      x: touched by the segment, or within its reach
 *     |  .__|     |     |
 *     +--x-\+--x--+-----+
 *     |     \__x__|__x__|
 *     +-----+-----+-----+ */
#include "tiles/census.h"

#include "archive/pmtiles.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

#define NOT_YET UINT32_MAX
enum { SHARES_A_THREAD = 8 }; /* a share of wide lines takes longer than one of narrow ones */

typedef struct metatile_pair {
    uint32_t metatile, polyline;
} metatile_pair;

/* A metatile that a share has found. */
typedef struct found_metatile {
    uint32_t column, row;
    uint32_t last; /* the polyline that was last listed for it; NOT_YET at first */
    uint64_t tiles, points;
} found_metatile;

/* Where a ring crosses the horizontal line through the middle of a row of tiles: at x, in tiles; 1 if the ring goes
 * down, -1 if it goes up. */
typedef struct crossing {
    int64_t row;
    double x;
    int winding;
} crossing;

/* One share of the polylines. */
typedef struct share {
    camber_context *context; /* the context of the thread that walks it */
    const camber_zoom_plan *plan;
    int64_t tiles; /* width of the world in tiles */
    uint32_t side;
    size_t first, end; /* polylines */
    found_metatile *metatiles;
    size_t metatile_count, metatile_capacity;
    uint32_t *slots; /* index of a metatile + 1; 0: free. slot_count is a power of two */
    size_t slot_count;
    metatile_pair *pairs; /* in the order of the polylines */
    size_t pair_count, pair_capacity;
    crossing *crossings; /* of the current ring */
    size_t crossing_count, crossing_capacity;
    uint32_t polyline;
    size_t metatile; /* the metatile that was marked last; metatile_count: none yet */
} share;

/* ---- Metatiles of a share ---- */

static size_t slot_of(const share *s, uint32_t column, uint32_t row) {
    const uint64_t hash = camber_mix(0, (uint64_t)row << 32 | column);
    size_t at = (size_t)hash & (s->slot_count - 1);
    while (s->slots[at] &&
           (s->metatiles[s->slots[at] - 1].column != column || s->metatiles[s->slots[at] - 1].row != row))
        at = (at + 1) & (s->slot_count - 1);
    return at;
}

static bool grow_slots(share *s) {
    if (s->slot_count > 2 * (s->metatile_count + 1))
        return true;
    const size_t count = s->slot_count ? 4 * s->slot_count : 256;
    uint32_t *slots = camber_alloc_zero(s->context, count, sizeof *slots);
    if (!slots)
        return false;
    camber_free(s->context, s->slots);
    s->slots = slots;
    s->slot_count = count;
    for (size_t i = 0; i < s->metatile_count; i++)
        slots[slot_of(s, s->metatiles[i].column, s->metatiles[i].row)] = (uint32_t)i + 1;
    return true;
}

/* Finds the metatile, or adds it. Returns false if memory is exhausted. */
static bool find_metatile(share *s, uint32_t column, uint32_t row) {
    if (s->metatile < s->metatile_count && s->metatiles[s->metatile].column == column &&
        s->metatiles[s->metatile].row == row)
        return true;
    if (!grow_slots(s))
        return false;
    const size_t slot = slot_of(s, column, row);
    if (!s->slots[slot]) {
        if (!camber_grow(s->context, &s->metatiles, &s->metatile_capacity, s->metatile_count + 1, sizeof *s->metatiles))
            return false;
        s->metatiles[s->metatile_count] = (found_metatile){.column = column, .row = row, .last = NOT_YET};
        s->slots[slot] = (uint32_t)++s->metatile_count;
    }
    s->metatile = s->slots[slot] - 1;
    return true;
}

/* ---- Marking ---- */

/* Marks a tile. Columns wrap around the world. */
static bool mark_tile(share *s, int64_t column, int64_t row) {
    if (row < 0 || row >= s->tiles)
        return true;
    column = ((column % s->tiles) + s->tiles) % s->tiles;
    const uint32_t side = s->side, x = (uint32_t)column, y = (uint32_t)row;
    if (!find_metatile(s, x / side, y / side))
        return false;
    found_metatile *metatile = s->metatiles + s->metatile;
    metatile->tiles |= UINT64_C(1) << (y % side * side + x % side);
    if (metatile->last == s->polyline)
        return true;
    metatile->last = s->polyline;
    if (!camber_grow(s->context, &s->pairs, &s->pair_capacity, s->pair_count + 1, sizeof *s->pairs))
        return false;
    s->pairs[s->pair_count++] = (metatile_pair){(uint32_t)s->metatile, s->polyline};
    return true;
}

static int64_t clamp(double value, int64_t least, int64_t most) {
    const double whole = floor(value);
    return whole < (double)least ? least : whole > (double)most ? most : (int64_t)whole;
}

/* Marks the columns of a row that [x0, x1], in tiles, overlaps. */
static bool mark_row(share *s, int64_t row, double x0, double x1) {
    const int64_t first = clamp(x0, -s->tiles, 2 * s->tiles);
    int64_t last = clamp(x1, -s->tiles, 2 * s->tiles);
    last = last - first < s->tiles ? last : first + s->tiles - 1;
    for (int64_t column = first; column <= last; column++)
        if (!mark_tile(s, column, row))
            return false;
    return true;
}

typedef struct tile_point {
    double x, y; /* in tiles */
} tile_point;

/* Marks the tiles of a segment that spans several tiles in both directions. For each row it takes the part of the
 * segment that is within reach of the row. */
static bool mark_long(share *s, tile_point a, tile_point b, double reach, int64_t first_row, int64_t last_row) {
    const tile_point top = a.y <= b.y ? a : b, bottom = a.y <= b.y ? b : a;
    const double height = bottom.y - top.y, slope = height > 0.0 ? (bottom.x - top.x) / height : 0.0;
    for (int64_t row = first_row; row <= last_row; row++) {
        const double y0 = fmax(top.y, (double)row - reach), y1 = fmin(bottom.y, (double)row + 1.0 + reach);
        double x0 = top.x + (y0 - top.y) * slope, x1 = top.x + (y1 - top.y) * slope;
        if (!(height > 0.0)) {
            x0 = top.x;
            x1 = bottom.x;
        }
        if (!mark_row(s, row, fmin(x0, x1) - reach, fmax(x0, x1) + reach))
            return false;
    }
    return true;
}

static bool mark_segment(share *s, tile_point a, tile_point b, double reach) {
    const double x0 = fmin(a.x, b.x) - reach, x1 = fmax(a.x, b.x) + reach;
    const int64_t first_row = clamp(fmin(a.y, b.y) - reach, 0, s->tiles - 1);
    const int64_t last_row = clamp(fmax(a.y, b.y) + reach, 0, s->tiles - 1);
    if (fmax(a.y, b.y) + reach < 0.0 || fmin(a.y, b.y) - reach > (double)s->tiles)
        return true;
    if (last_row - first_row > 1 && x1 - x0 > 1.0)
        return mark_long(s, a, b, reach, first_row, last_row);
    for (int64_t row = first_row; row <= last_row; row++)
        if (!mark_row(s, row, x0, x1))
            return false;
    return true;
}

/* Counts a point for the tile that contains it. */
static bool count_point(share *s, tile_point at) {
    if (!(at.y >= 0.0 && at.y < (double)s->tiles))
        return true;
    if (!mark_tile(s, (int64_t)floor(at.x), (int64_t)at.y))
        return false;
    s->metatiles[s->metatile].points++;
    return true;
}

/* ---- Tiles inside areas ---- */

/* Records where a ring's segment crosses the middles of rows of tiles. */
static bool add_crossings(share *s, tile_point a, tile_point b) {
    const tile_point top = a.y <= b.y ? a : b, bottom = a.y <= b.y ? b : a;
    const int64_t first = clamp(top.y + 0.5, 0, s->tiles), end = clamp(bottom.y + 0.5, 0, s->tiles);
    if (!camber_grow(s->context, &s->crossings, &s->crossing_capacity, s->crossing_count + (size_t)(end - first),
                     sizeof *s->crossings))
        return false;
    for (int64_t row = first; row < end; row++) {
        const double part = ((double)row + 0.5 - top.y) / (bottom.y - top.y);
        s->crossings[s->crossing_count++] = (crossing){row, top.x + (bottom.x - top.x) * part, a.y <= b.y ? 1 : -1};
    }
    return true;
}

static int compare_crossings(const void *left, const void *right) {
    const crossing *a = left, *b = right;
    if (a->row != b->row)
        return a->row < b->row ? -1 : 1;
    return a->x < b->x ? -1 : a->x > b->x;
}

/* Marks the tiles whose middles the ring winds around. Tiles that its segments touch are already marked, so in all
 * others the middle decides for the whole tile. Tiles inside a hole are marked too: such a tile is drawn from the hole
 * and the outer ring. */
static bool mark_inside(share *s) {
    int winding = 0;
    if (s->crossing_count)
        qsort(s->crossings, s->crossing_count, sizeof *s->crossings, compare_crossings);
    for (size_t i = 0; i + 1 < s->crossing_count; i++) {
        const crossing *from = s->crossings + i, *to = from + 1;
        winding = from->row == to->row ? winding + from->winding : 0;
        const double first = ceil(from->x - 0.5), last = floor(to->x - 0.5);
        if (winding != 0 && first <= last && !mark_row(s, from->row, first, last))
            return false;
    }
    s->crossing_count = 0;
    return true;
}

static bool mark_polyline(share *s, size_t polyline) {
    const camber_features *features = s->plan->features;
    const double reach_px = (double)camber_zoom_plan_reach(s->plan, polyline), scale = (double)s->tiles;
    const double reach = reach_px / (s->plan->view.scale_px / scale);
    const size_t first = features->offsets[polyline], end = features->offsets[polyline + 1];
    const bool area = camber_features_kind(features, polyline) == CAMBER_GEOMETRY_AREA;
    tile_point before = {0};
    if (reach_px < 0.0)
        return true;
    s->polyline = (uint32_t)polyline;
    for (size_t i = first; i < end; i++) {
        if (i > first && i + 1 < end && features->importance && features->importance[i] < s->plan->least_importance)
            continue;
        const tile_point at = {features->points[2 * i] * scale, features->points[2 * i + 1] * scale};
        if (!isfinite(at.x) || !isfinite(at.y))
            continue;
        if (!count_point(s, at) || !mark_segment(s, i > first ? before : at, at, reach) ||
            (area && i > first && !add_crossings(s, before, at)))
            return false;
        before = at;
    }
    return mark_inside(s);
}

/* ---- Threads ---- */

typedef struct taking_census {
    camber_workers *workers;
    share *shares;
    size_t share_count;
    atomic_size_t next;   /* the first share that no thread has taken yet */
    atomic_size_t failed; /* 1 + the number of a worker that ran out of memory; 0: none did */
} taking_census;

static void walk_shares(void *user, size_t number) {
    taking_census *taking = user;
    for (size_t i; !taking->failed && (i = atomic_fetch_add(&taking->next, 1)) < taking->share_count;) {
        share *s = taking->shares + i;
        s->context = taking->workers->contexts[number];
        for (size_t k = s->first; k < s->end && !taking->failed; k++)
            if (!mark_polyline(s, k))
                taking->failed = number + 1;
    }
}

/* Divides the polylines into shares with about equal numbers of points. */
static void divide(const camber_zoom_plan *plan, uint32_t side, int zoom, taking_census *taking) {
    const camber_features *features = plan->features;
    const size_t count = taking->share_count, polylines = features->polyline_count;
    size_t at = 0;
    for (size_t i = 0; i < count; i++) {
        const size_t end_point = (size_t)((double)features->point_count * (double)(i + 1) / (double)count);
        taking->shares[i] = (share){.context = taking->workers->contexts[0],
                                    .plan = plan,
                                    .tiles = (int64_t)1 << zoom,
                                    .side = side,
                                    .first = at};
        while (at < polylines && (i + 1 == count || features->offsets[at] < end_point))
            at++;
        taking->shares[i].end = at;
    }
}

/* ---- Merging ---- */

typedef struct numbered_metatile {
    uint64_t number; /* position along the Hilbert curve */
    uint32_t share, metatile;
} numbered_metatile;

static int compare_numbers(const void *left, const void *right) {
    const numbered_metatile *a = left, *b = right;
    return a->number != b->number ? (a->number < b->number ? -1 : 1) : a->share < b->share ? -1 : a->share > b->share;
}

static camber_status list_metatiles(camber_census *census, share *shares, size_t count, numbered_metatile **all,
                                    size_t *all_count) {
    const int zoom = camber_metatile_level(census->zoom, census->side);
    size_t total = 0;
    for (size_t i = 0; i < count; i++)
        total += shares[i].metatile_count;
    numbered_metatile *list = camber_alloc(census->context, total, sizeof *list);
    if (!list)
        return CAMBER_ERROR_MEMORY;
    size_t at = 0;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < shares[i].metatile_count; k++)
            list[at++] = (numbered_metatile){
                camber_pmtiles_number(zoom, shares[i].metatiles[k].column, shares[i].metatiles[k].row), (uint32_t)i,
                (uint32_t)k};
    qsort(list, total, sizeof *list, compare_numbers);
    *all = list;
    *all_count = total;
    return CAMBER_OK;
}

/* Merges the tables of the shares, and lists the polylines of each metatile, beginning with the first share's. */
static camber_status unite(camber_census *census, share *shares, size_t count) {
    numbered_metatile *all = NULL;
    size_t all_count = 0, pairs = 0;
    camber_status status = list_metatiles(census, shares, count, &all, &all_count);
    if (status != CAMBER_OK)
        return status;
    for (size_t i = 0; i < count; i++)
        pairs += shares[i].pair_count;
    size_t *fill = camber_alloc_zero(census->context, all_count, sizeof *fill);
    if (!fill || !(census->metatiles = camber_alloc(census->context, all_count, sizeof *census->metatiles)) ||
        !(census->polylines = camber_alloc(census->context, pairs, sizeof *census->polylines)))
        status = CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < all_count && status == CAMBER_OK; i++) {
        found_metatile *met = shares[all[i].share].metatiles + all[i].metatile;
        const bool same = i > 0 && all[i].number == all[i - 1].number;
        if (!same)
            census->metatiles[census->metatile_count++] = (camber_metatile){.column = met->column, .row = met->row};
        camber_metatile *metatile = census->metatiles + census->metatile_count - 1;
        metatile->tiles |= met->tiles;
        metatile->points += met->points;
        met->last = (uint32_t)census->metatile_count - 1; /* its index in the census */
    }
    for (int put = 0; put < 2 && status == CAMBER_OK; put++) {
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < shares[i].pair_count; k++) {
                const size_t metatile = shares[i].metatiles[shares[i].pairs[k].metatile].last;
                if (put)
                    census->polylines[fill[metatile]++] = shares[i].pairs[k].polyline;
                else
                    census->metatiles[metatile].end++;
            }
        for (size_t b = 0, at = 0; b < census->metatile_count && !put; b++) {
            const size_t size = census->metatiles[b].end;
            census->metatiles[b].first = fill[b] = at;
            census->metatiles[b].end = at += size;
        }
    }
    camber_free(census->context, fill);
    camber_free(census->context, all);
    return status;
}

camber_status camber_census_make(const camber_zoom_plan *plan, int zoom, uint32_t side, camber_workers *workers,
                                 camber_census *census) {
    *census = (camber_census){.context = workers->context, .zoom = zoom, .side = side};
    taking_census taking = {.workers = workers,
                            .share_count = workers->count > 1 ? SHARES_A_THREAD * workers->count : 1};
    if (!(taking.shares = camber_alloc_zero(workers->context, taking.share_count, sizeof *taking.shares)))
        return CAMBER_ERROR_MEMORY;
    divide(plan, side, zoom, &taking);
    camber_threads_run(workers->count, walk_shares, &taking);
    const camber_status status = taking.failed ? camber_workers_tell(workers, taking.failed - 1, CAMBER_ERROR_MEMORY)
                                               : unite(census, taking.shares, taking.share_count);
    for (size_t i = 0; i < taking.share_count; i++) {
        const share *s = taking.shares + i;
        camber_free(s->context, s->metatiles);
        camber_free(s->context, s->slots);
        camber_free(s->context, s->pairs);
        camber_free(s->context, s->crossings);
    }
    camber_free(workers->context, taking.shares);
    return status;
}

static int compare_metatiles(const void *left, const void *right) {
    const camber_metatile *a = left, *b = right;
    return a->points < b->points ? -1 : a->points > b->points;
}

camber_status camber_census_touch(camber_census *census, const camber_touched_tiles *touched, size_t count) {
    const int zoom = camber_metatile_level(census->zoom, census->side);
    size_t added = 0, at = census->metatile_count;
    camber_metatile *more = camber_alloc(census->context, count, sizeof *more);
    if (!more)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++) {
        const camber_metatile *there = camber_census_find(census, touched[i].column, touched[i].row);
        if (there)
            census->metatiles[there - census->metatiles].tiles |= touched[i].tiles;
        else /* points: its number along the Hilbert curve, until it is sorted */
            more[added++] = (camber_metatile){.column = touched[i].column,
                                              .row = touched[i].row,
                                              .tiles = touched[i].tiles,
                                              .points = camber_pmtiles_number(zoom, touched[i].column, touched[i].row)};
    }
    if (added)
        qsort(more, added, sizeof *more, compare_metatiles);
    camber_metatile *all = camber_alloc(census->context, at + added, sizeof *all);
    if (!all) {
        camber_free(census->context, more);
        return CAMBER_ERROR_MEMORY;
    }
    census->metatile_count = at + added;
    while (at + added > 0) {
        const camber_metatile *last = at ? census->metatiles + at - 1 : NULL;
        const bool own =
            last && (!added || camber_pmtiles_number(zoom, last->column, last->row) > more[added - 1].points);
        camber_metatile *to = all + (at + added - 1);
        *to = own ? *last : more[added - 1];
        if (own) {
            at--;
        } else {
            to->points = 0;
            added--;
        }
    }
    camber_free(census->context, more);
    camber_free(census->context, census->metatiles);
    census->metatiles = all;
    return CAMBER_OK;
}

void camber_census_free(camber_census *census) {
    if (!census->context)
        return;
    camber_free(census->context, census->metatiles);
    camber_free(census->context, census->polylines);
    *census = (camber_census){0};
}

const camber_metatile *camber_census_find(const camber_census *census, uint32_t column, uint32_t row) {
    const int zoom = camber_metatile_level(census->zoom, census->side);
    const uint64_t wanted = camber_pmtiles_number(zoom, column, row);
    size_t low = 0, high = census->metatile_count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        const camber_metatile *metatile = census->metatiles + middle;
        const uint64_t number = camber_pmtiles_number(zoom, metatile->column, metatile->row);
        if (number == wanted)
            return metatile;
        if (number < wanted)
            low = middle + 1;
        else
            high = middle;
    }
    return NULL;
}
