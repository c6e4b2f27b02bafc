/* Makes the sea of a coast.
 *
 * Input: ways with land on their left, and a box. Output: rings. Main idea: ways that go on from each other are chains.
 * What of a chain lies in the box is a piece from one place of the box's sides to another, or a ring. Along a piece the
 * sea is on the right, and so it is on the way that goes on from its end clockwise along the sides, until the next
 * piece begins:
 *
 *        +---end--->--+       Ends and beginnings take turns around the box. Where they do not, some of the coast is
 *        |    |       |       missing, and no sea is better than one that floods the land.
 *        | land  sea  v
 *        |    ^       |       Rings are islands, or seas of their own. Without pieces the box lies in the sea if the
 *        +--begin--<--+       ring that reaches farthest west is an island.
 */
#include "osm/coast.h"

#include "osm/node_set.h"

#include <stdlib.h>

/* How far from a side the coast may end: a share of the box's shorter side, and 10^-7 degrees. */
enum { NEAR_SHARE = 16, NEAR_MOST = 500000 };

/* A way by where it begins. */
typedef struct way_start {
    uint64_t place;
    uint32_t way;
    bool used;
} way_start;

/* A piece of the coast in the box: its places, and where it begins and ends along the box's sides. */
typedef struct piece {
    size_t first, count;
    int64_t begin, end;
} piece;

/* An end or a beginning of a piece. */
typedef struct border_mark {
    int64_t at;
    uint32_t piece;
    bool begins;
} border_mark;

typedef struct shore {
    camber_context *context;
    const camber_osm_coast *coast;
    camber_osm_box box;
    camber_osm_assembly *sea;
    way_start *starts; /* way_count, by place */
    uint64_t *chain;   /* places of the chain that is cut */
    size_t chain_count, chain_capacity;
    uint64_t *cut; /* places of pieces */
    size_t cut_count, cut_capacity;
    piece *pieces;
    size_t piece_count, piece_capacity;
    bool in_piece;
    bool failed; /* no memory */
} shore;

/* ---- Ways ---- */

camber_status camber_osm_coast_add(camber_osm_coast *coast, const uint64_t *places, size_t count) {
    if (count < 2)
        return CAMBER_OK;
    if (!camber_grow(coast->context, &coast->places, &coast->place_capacity, coast->place_count + count,
                     sizeof *coast->places) ||
        !camber_grow(coast->context, &coast->ends, &coast->way_capacity, coast->way_count + 1, sizeof *coast->ends))
        return CAMBER_ERROR_MEMORY;
    memcpy(coast->places + coast->place_count, places, count * sizeof *places);
    coast->place_count += count;
    coast->ends[coast->way_count++] = coast->place_count;
    return CAMBER_OK;
}

void camber_osm_coast_free(camber_osm_coast *coast) {
    camber_free(coast->context, coast->ends);
    camber_free(coast->context, coast->places);
    *coast = (camber_osm_coast){.context = coast->context};
}

static size_t first_of(const camber_osm_coast *coast, size_t way) {
    return way ? coast->ends[way - 1] : 0;
}

static int compare_starts(const void *a, const void *b) {
    const way_start *one = a, *other = b;
    return one->place != other->place ? (one->place > other->place) - (one->place < other->place)
                                      : (one->way > other->way) - (one->way < other->way);
}

/* The first of the ways that begin at a place, or where it would be. */
static size_t find_start(const shore *s, uint64_t place) {
    size_t first = 0;
    for (size_t count = s->coast->way_count; count > 0;) {
        const size_t half = count / 2;
        if (s->starts[first + half].place < place) {
            first += half + 1;
            count -= half + 1;
        } else {
            count = half;
        }
    }
    return first;
}

/* The next way that begins at a place and is in no chain yet. way_count: there is none. */
static size_t find_next(const shore *s, uint64_t place) {
    for (size_t i = find_start(s, place); i < s->coast->way_count && s->starts[i].place == place; i++)
        if (!s->starts[i].used)
            return i;
    return s->coast->way_count;
}

/* Puts the ways that go on from each other into the chain. */
static void take_chain(shore *s, size_t start) {
    const camber_osm_coast *coast = s->coast;
    s->chain_count = 0;
    for (size_t i = start; i < coast->way_count;) {
        const size_t way = s->starts[i].way, first = first_of(coast, way) + (s->chain_count > 0),
                     count = coast->ends[way] - first;
        s->starts[i].used = true;
        if (!camber_grow(s->context, &s->chain, &s->chain_capacity, s->chain_count + count, sizeof *s->chain)) {
            s->failed = true;
            return;
        }
        memcpy(s->chain + s->chain_count, coast->places + first, count * sizeof *s->chain);
        s->chain_count += count;
        i = find_next(s, coast->places[coast->ends[way] - 1]);
    }
}

/* ---- The box ---- */

static bool is_in_box(const shore *s, uint64_t place) {
    const int32_t x = camber_osm_longitude(place), y = camber_osm_latitude(place);
    return x >= s->box.left && x <= s->box.right && y >= s->box.bottom && y <= s->box.top;
}

/* How far along the sides a place lies, clockwise from the upper left corner; below 0: on no side. */
static int64_t find_border(const shore *s, uint64_t place) {
    const int64_t x = camber_osm_longitude(place), y = camber_osm_latitude(place);
    const int64_t wide = (int64_t)s->box.right - s->box.left, high = (int64_t)s->box.top - s->box.bottom;
    if (y == s->box.top)
        return x - s->box.left;
    if (x == s->box.right)
        return wide + s->box.top - y;
    if (y == s->box.bottom)
        return wide + high + s->box.right - x;
    return x == s->box.left ? 2 * wide + high + y - s->box.bottom : -1;
}

/* The part of a segment that lies in the box: shares of its length, and the sides at which they lie. */
typedef struct inside {
    double from, to;
    int from_side, to_side; /* 0: an end of the segment; else 1 left, 2 right, 3 bottom, 4 top */
} inside;

static void cut_at(inside *i, double distance, double way, int side) {
    /* distance: of the segment's beginning from the side, above 0 inside; way: how much of it the segment takes */
    const double share = distance / way;
    if (way > 0.0 && share < i->to) {
        i->to = share;
        i->to_side = side;
    } else if (way < 0.0 && share > i->from) {
        i->from = share;
        i->from_side = side;
    } else if (way == 0.0 && distance < 0.0) {
        i->to = -1.0;
    }
}

static inside find_inside(const shore *s, uint64_t a, uint64_t b) {
    const double x = camber_osm_longitude(a), y = camber_osm_latitude(a), dx = camber_osm_longitude(b) - x,
                 dy = camber_osm_latitude(b) - y;
    inside i = {.from = 0.0, .to = 1.0};
    cut_at(&i, x - s->box.left, -dx, 1);
    cut_at(&i, s->box.right - x, dx, 2);
    cut_at(&i, y - s->box.bottom, -dy, 3);
    cut_at(&i, s->box.top - y, dy, 4);
    return i;
}

static int32_t between(double from, double to, double share, int32_t least, int32_t most) {
    const double at = from + (to - from) * share, rounded = at < 0.0 ? at - 0.5 : at + 0.5;
    return rounded < least ? least : rounded > most ? most : (int32_t)rounded;
}

/* The place at a share of a segment, on a side. */
static uint64_t place_on(const shore *s, uint64_t a, uint64_t b, double share, int side) {
    const camber_osm_box box = s->box;
    const int32_t x = between(camber_osm_longitude(a), camber_osm_longitude(b), share, box.left, box.right),
                  y = between(camber_osm_latitude(a), camber_osm_latitude(b), share, box.bottom, box.top);
    return camber_osm_place(side == 1   ? box.left
                            : side == 2 ? box.right
                                        : x,
                            side == 3   ? box.bottom
                            : side == 4 ? box.top
                                        : y);
}

/* ---- Pieces ---- */

static void add_place(shore *s, uint64_t place) {
    if (s->cut_count > s->pieces[s->piece_count - 1].first && s->cut[s->cut_count - 1] == place)
        return;
    if (!camber_grow(s->context, &s->cut, &s->cut_capacity, s->cut_count + 1, sizeof *s->cut)) {
        s->failed = true;
        return;
    }
    s->cut[s->cut_count++] = place;
}

static void begin_piece(shore *s, uint64_t place) {
    if (!camber_grow(s->context, &s->pieces, &s->piece_capacity, s->piece_count + 1, sizeof *s->pieces)) {
        s->failed = true;
        return;
    }
    s->pieces[s->piece_count++] = (piece){.first = s->cut_count};
    s->in_piece = true;
    add_place(s, place);
}

/* Ends a piece, which has to lie between two places of the sides; one that only touches a side is none. */
static void end_piece(shore *s) {
    piece *p = s->pieces + s->piece_count - 1;
    s->in_piece = false;
    p->count = s->cut_count - p->first;
    if (p->count < 2) {
        s->cut_count = p->first;
        s->piece_count--;
        return;
    }
    p->begin = find_border(s, s->cut[p->first]);
    p->end = find_border(s, s->cut[s->cut_count - 1]);
    s->sea->open |= p->begin < 0 || p->end < 0;
}

/* The nearest place on a side. The same place: that is too far, or the place is on a side, or outside. */
static uint64_t nearest_on_side(const shore *s, uint64_t place) {
    const camber_osm_box b = s->box;
    const int64_t x = camber_osm_longitude(place), y = camber_osm_latitude(place), wide = (int64_t)b.right - b.left,
                  high = (int64_t)b.top - b.bottom, shorter = wide < high ? wide : high;
    const int64_t distances[4] = {x - b.left, b.right - x, y - b.bottom, b.top - y};
    int side = 0;
    for (int i = 1; i < 4; i++)
        side = distances[i] < distances[side] ? i : side;
    const int64_t most = shorter / NEAR_SHARE < NEAR_MOST ? shorter / NEAR_SHARE : NEAR_MOST;
    if (distances[side] <= 0 || distances[side] > most)
        return place;
    return side < 2 ? camber_osm_place(side ? b.right : b.left, (int32_t)y)
                    : camber_osm_place((int32_t)x, side == 2 ? b.bottom : b.top);
}

/* An extract may have no node beyond its box: then the coast ends at the last one before a side, and goes on to it. */
static void reach_sides(shore *s) {
    const uint64_t first = nearest_on_side(s, s->chain[0]), last = nearest_on_side(s, s->chain[s->chain_count - 1]);
    if (!camber_grow(s->context, &s->chain, &s->chain_capacity, s->chain_count + 2, sizeof *s->chain)) {
        s->failed = true;
        return;
    }
    if (last != s->chain[s->chain_count - 1])
        s->chain[s->chain_count++] = last;
    if (first == s->chain[0])
        return;
    memmove(s->chain + 1, s->chain, s->chain_count * sizeof *s->chain);
    s->chain[0] = first;
    s->chain_count++;
}

/* Cuts pieces of the chain, from its place `first` on. */
static void cut_chain(shore *s, size_t first) {
    const size_t count = s->chain_count;
    const bool closed = s->chain[0] == s->chain[count - 1];
    for (size_t k = first; k + 1 < first + count && !s->failed; k++) {
        const size_t at = closed ? k % (count - 1) : k;
        const uint64_t a = s->chain[at], b = s->chain[at + 1];
        const inside i = find_inside(s, a, b);
        const bool empty = i.from >= i.to;
        if (s->in_piece && empty)
            end_piece(s);
        if (empty)
            continue;
        if (!s->in_piece)
            begin_piece(s, i.from > 0.0 ? place_on(s, a, b, i.from, i.from_side) : a);
        if (!s->failed)
            add_place(s, i.to < 1.0 ? place_on(s, a, b, i.to, i.to_side) : b);
        if (i.to < 1.0 && !s->failed)
            end_piece(s);
    }
    if (s->in_piece && !s->failed)
        end_piece(s);
}

/* ---- Rings ---- */

static void put_place(camber_osm_assembly *sea, uint64_t place, bool *failed) {
    if (!camber_grow(sea->context, &sea->places, &sea->place_capacity, sea->place_count + 1, sizeof *sea->places)) {
        *failed = true;
        return;
    }
    sea->places[sea->place_count++] = place;
}

/* Ends the ring that begins at a place, and closes it. */
static void put_ring(shore *s, size_t first, camber_osm_role role) {
    camber_osm_assembly *sea = s->sea;
    if (!s->failed && sea->places[first] != sea->places[sea->place_count - 1])
        put_place(sea, sea->places[first], &s->failed);
    if (s->failed ||
        !camber_grow(sea->context, &sea->rings, &sea->ring_capacity, sea->ring_count + 1, sizeof *sea->rings)) {
        s->failed = true;
        return;
    }
    sea->rings[sea->ring_count++] = (camber_osm_ring){first, sea->place_count - first, role};
}

/* A chain that closes in the box: land lies inside where it goes counter-clockwise, as seen. */
static void put_closed(shore *s) {
    const size_t first = s->sea->place_count;
    const double x0 = camber_osm_longitude(s->chain[0]), y0 = camber_osm_latitude(s->chain[0]);
    double area = 0.0;
    for (size_t i = 0; i + 1 < s->chain_count && !s->failed; i++) {
        const uint64_t a = s->chain[i], b = s->chain[i + 1];
        area += (camber_osm_longitude(a) - x0) * (camber_osm_latitude(b) - y0) -
                (camber_osm_longitude(b) - x0) * (camber_osm_latitude(a) - y0);
        put_place(s->sea, a, &s->failed);
    }
    put_ring(s, first, area > 0.0 ? CAMBER_OSM_ROLE_INNER : CAMBER_OSM_ROLE_OUTER);
}

/* A chain is a ring in the box, or lies outside, or is cut: from a place outside on, where it is closed. */
static void take_pieces(shore *s) {
    const bool closed = s->chain_count > 2 && s->chain[0] == s->chain[s->chain_count - 1];
    size_t outside = 0;
    while (outside < s->chain_count && is_in_box(s, s->chain[outside]))
        outside++;
    if (closed && outside == s->chain_count) {
        put_closed(s);
        return;
    }
    if (!closed)
        reach_sides(s);
    if (!s->failed)
        cut_chain(s, closed ? outside : 0);
}

static void take_all(shore *s) {
    const camber_osm_coast *coast = s->coast;
    for (size_t i = 0; i < coast->way_count; i++)
        s->starts[i] = (way_start){coast->places[first_of(coast, i)], (uint32_t)i, false};
    qsort(s->starts, coast->way_count, sizeof *s->starts, compare_starts);
    /* A way is the first of its chain if none ends where it begins. */
    uint8_t *goes_on = camber_alloc_zero(s->context, coast->way_count, 1);
    s->failed = !goes_on;
    for (size_t i = 0; i < coast->way_count && !s->failed; i++) {
        const uint64_t end = coast->places[coast->ends[i] - 1];
        for (size_t k = find_start(s, end); k < coast->way_count && s->starts[k].place == end; k++)
            goes_on[k] = 1;
    }
    for (int rings = 0; rings < 2; rings++)
        for (size_t i = 0; i < coast->way_count && !s->failed && !s->sea->open; i++) {
            if (s->starts[i].used || goes_on[i] > rings)
                continue;
            take_chain(s, i);
            if (!s->failed)
                take_pieces(s);
        }
    camber_free(s->context, goes_on);
}

/* ---- Around the box ---- */

static int compare_marks(const void *a, const void *b) {
    const border_mark *one = a, *other = b;
    return one->at != other->at ? (one->at > other->at) - (one->at < other->at) : (int)one->begins - (int)other->begins;
}

static uint64_t corner_of(const shore *s, int corner) {
    const camber_osm_box b = s->box;
    const uint64_t corners[4] = {camber_osm_place(b.left, b.top), camber_osm_place(b.right, b.top),
                                 camber_osm_place(b.right, b.bottom), camber_osm_place(b.left, b.bottom)};
    return corners[corner & 3];
}

/* Puts the corners that lie between two places of the sides, clockwise. */
static void put_corners(shore *s, int64_t from, int64_t to) {
    const int64_t wide = (int64_t)s->box.right - s->box.left, high = (int64_t)s->box.top - s->box.bottom;
    const int64_t corners[8] = {0,
                                wide,
                                wide + high,
                                2 * wide + high,
                                2 * (wide + high),
                                3 * wide + 2 * high,
                                3 * wide + 3 * high,
                                4 * wide + 3 * high};
    const int64_t end = to < from ? to + 2 * (wide + high) : to;
    for (int i = 0; i < 8; i++)
        if (corners[i] > from && corners[i] < end)
            put_place(s->sea, corner_of(s, i), &s->failed);
}

/* Joins the pieces along the sides. marks: two a piece, by place; each end comes before a beginning. */
static void join_pieces(shore *s, const border_mark *marks, uint8_t *joined, const uint32_t *mark_of_end) {
    const size_t count = 2 * s->piece_count;
    for (size_t i = 0; i < s->piece_count && !s->failed; i++) {
        const size_t first = s->sea->place_count;
        for (uint32_t at = (uint32_t)i; !joined[at] && !s->failed;) {
            const piece *p = s->pieces + at;
            joined[at] = 1;
            for (size_t k = p->first; k < p->first + p->count; k++)
                put_place(s->sea, s->cut[k], &s->failed);
            const border_mark *next = marks + (mark_of_end[at] + 1) % count;
            put_corners(s, p->end, next->at);
            at = next->piece;
        }
        if (s->sea->place_count > first)
            put_ring(s, first, CAMBER_OSM_ROLE_OUTER);
    }
}

static void go_around(shore *s) {
    const size_t count = 2 * s->piece_count;
    border_mark *marks = camber_alloc(s->context, count, sizeof *marks);
    uint8_t *joined = camber_alloc_zero(s->context, s->piece_count, 1);
    uint32_t *mark_of_end = camber_alloc(s->context, s->piece_count, sizeof *mark_of_end);
    s->failed = !marks || !joined || !mark_of_end;
    for (size_t i = 0; i < s->piece_count && !s->failed; i++) {
        marks[2 * i] = (border_mark){s->pieces[i].begin, (uint32_t)i, true};
        marks[2 * i + 1] = (border_mark){s->pieces[i].end, (uint32_t)i, false};
    }
    if (!s->failed)
        qsort(marks, count, sizeof *marks, compare_marks);
    for (size_t i = 0; i < count && !s->failed; i++) {
        s->sea->open |= marks[i].begins == marks[(i + 1) % count].begins;
        if (!marks[i].begins)
            mark_of_end[marks[i].piece] = (uint32_t)i;
    }
    if (!s->failed && !s->sea->open)
        join_pieces(s, marks, joined, mark_of_end);
    camber_free(s->context, mark_of_end);
    camber_free(s->context, joined);
    camber_free(s->context, marks);
}

/* The box is sea around the rings, if the one that reaches farthest west is an island. */
static void put_box(shore *s) {
    const camber_osm_assembly *sea = s->sea;
    int32_t least = INT32_MAX;
    bool is_island = false;
    for (size_t i = 0; i < sea->ring_count; i++)
        for (size_t k = sea->rings[i].first; k < sea->rings[i].first + sea->rings[i].count; k++)
            if (camber_osm_longitude(sea->places[k]) < least) {
                least = camber_osm_longitude(sea->places[k]);
                is_island = sea->rings[i].role == CAMBER_OSM_ROLE_INNER;
            }
    const size_t first = sea->place_count;
    for (int i = 0; i < 4 && is_island; i++)
        put_place(s->sea, corner_of(s, i), &s->failed);
    if (is_island)
        put_ring(s, first, CAMBER_OSM_ROLE_OUTER);
}

static int compare_rings(const void *a, const void *b) {
    const camber_osm_ring *one = a, *other = b;
    return one->role != other->role ? (int)one->role - (int)other->role
                                    : (one->first > other->first) - (one->first < other->first);
}

camber_status camber_osm_coast_fill(const camber_osm_coast *coast, camber_osm_box box, camber_osm_assembly *sea) {
    shore s = {.context = sea->context, .coast = coast, .box = box, .sea = sea};
    sea->place_count = sea->ring_count = 0;
    sea->open = box.left >= box.right || box.bottom >= box.top;
    if (sea->open || coast->way_count == 0)
        return CAMBER_OK;
    if (!(s.starts = camber_alloc(s.context, coast->way_count, sizeof *s.starts)))
        return CAMBER_ERROR_MEMORY;
    take_all(&s);
    if (!s.failed && !sea->open && s.piece_count)
        go_around(&s);
    else if (!s.failed && !sea->open)
        put_box(&s);
    if (sea->open)
        sea->ring_count = 0;
    if (sea->ring_count)
        qsort(sea->rings, sea->ring_count, sizeof *sea->rings, compare_rings); /* outer rings come first */
    camber_free(s.context, s.pieces);
    camber_free(s.context, s.cut);
    camber_free(s.context, s.chain);
    camber_free(s.context, s.starts);
    return s.failed ? CAMBER_ERROR_MEMORY : CAMBER_OK;
}
