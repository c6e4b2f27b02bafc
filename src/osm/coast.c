/* Makes the sea of a coast.
 *
 * Input: ways with land on their left, and a box. Output: rings. Main idea: ways that follow each other are put
 * together. What of them lies in the box is a stretch from one place of the box's sides to another, or a ring. Along a
 * stretch the sea is on the right. So it is along the box's sides, clockwise, from the stretch's end to where the next
 * one begins:
 *
 *        +---end--->--+       Ends and beginnings take turns around the box. Where they do not, some of the coast is
 *        |    |       |       missing, and no sea is better than one that floods the land.
 *        | land  sea  v
 *        |    ^       |       Rings are islands, or seas in land. Which of them fit is found by how often the others
 *        +--begin--<--+       wind around them. Without stretches that also tells whether the box lies in the sea.
 */
#include "osm/coast.h"

#include "osm/node_set.h"

#include <math.h>
#include <stdlib.h>

/* How far from a side the coast may end: a share of the box's shorter side, and 10^-7 degrees. */
enum { NEAR_SHARE = 16, NEAR_MOST = 500000 };
/* Pairs of an edge and a ring that are looked at; a coast has about one an edge. */
static const size_t MOST_PROBED = (size_t)1 << 31;

/* A way by where it begins. */
typedef struct way_start {
    uint64_t place;
    uint32_t way;
    uint32_t used_count; /* where it is the first that begins at its place: so many from it on are used */
    bool used;
} way_start;

/* A part of the coast in the box, from side to side: its places, and where along the sides it begins and ends. */
typedef struct stretch {
    size_t first, count;
    int64_t begin, end;
} stretch;

/* An end or a beginning of a stretch. */
typedef struct border_mark {
    int64_t at;
    uint32_t stretch;
    bool begins;
} border_mark;

typedef struct shore {
    camber_context *context;
    const camber_osm_coast *coast;
    camber_osm_box box;
    camber_osm_assembly *sea;
    way_start *starts; /* way_count, by place */
    uint64_t *line;    /* places of the ways that were put together */
    size_t line_count, line_capacity;
    uint64_t *cut; /* places of stretches */
    size_t cut_count, cut_capacity;
    stretch *stretches;
    size_t stretch_count, stretch_capacity;
    bool in_stretch;
    bool failed; /* no memory */
} shore;

/* ---- Ways ---- */

/* The side that a place in the box is near to: 0 left, 1 right, 2 bottom, 3 top. Below 0: it is near to none. */
static int find_side(camber_osm_box b, uint64_t place) {
    const int64_t x = camber_osm_longitude(place), y = camber_osm_latitude(place), wide = (int64_t)b.right - b.left,
                  high = (int64_t)b.top - b.bottom, shorter = wide < high ? wide : high;
    const int64_t most = shorter / NEAR_SHARE < NEAR_MOST ? shorter / NEAR_SHARE : NEAR_MOST;
    const int64_t distances[4] = {x - b.left, b.right - x, y - b.bottom, b.top - y};
    int side = 0;
    for (int i = 1; i < 4; i++)
        side = distances[i] < distances[side] ? i : side;
    return distances[side] >= 0 && distances[side] <= most ? side : -1;
}

/* The nearest place on the side that a place is near to, or the place itself. */
static uint64_t nearest_on_side(camber_osm_box b, uint64_t place) {
    const int side = find_side(b, place), x = camber_osm_longitude(place), y = camber_osm_latitude(place);
    return side < 0   ? place
           : side < 2 ? camber_osm_place(side ? b.right : b.left, y)
                      : camber_osm_place(x, side == 2 ? b.bottom : b.top);
}

/* A gap between two nodes of a way: the coast leaves the box there and comes back at the same side, or at another. */
typedef enum gap { NO_GAP, GAP_AT_SIDE, GAP_BETWEEN_SIDES } gap;

/* Along one side a segment is taken for a gap if it is long beside its ends' distances from the side: then it would cut
 * off little, but cut it off wrongly. */
static gap find_gap(camber_osm_box box, uint64_t a, uint64_t b) {
    const int side = find_side(box, a), next = find_side(box, b);
    if (side < 0 || next < 0 || side != next)
        return side < 0 || next < 0 ? NO_GAP : GAP_BETWEEN_SIDES;
    const uint64_t on_a = nearest_on_side(box, a), on_b = nearest_on_side(box, b);
    const double far_a = fabs((double)camber_osm_longitude(on_a) - camber_osm_longitude(a)) +
                         fabs((double)camber_osm_latitude(on_a) - camber_osm_latitude(a)),
                 far_b = fabs((double)camber_osm_longitude(on_b) - camber_osm_longitude(b)) +
                         fabs((double)camber_osm_latitude(on_b) - camber_osm_latitude(b)),
                 along = fabs((double)camber_osm_longitude(on_b) - camber_osm_longitude(on_a)) +
                         fabs((double)camber_osm_latitude(on_b) - camber_osm_latitude(on_a));
    return along > 2.0 * (far_a > far_b ? far_a : far_b) ? GAP_AT_SIDE : NO_GAP;
}

/* Ends the way whose places begin at `first`; one of fewer than two is none. */
static camber_status end_way(camber_osm_coast *coast, size_t first) {
    if (coast->place_count < first + 2) {
        coast->place_count = first;
        return CAMBER_OK;
    }
    if (!camber_grow(coast->context, &coast->ends, &coast->way_capacity, coast->way_count + 1, sizeof *coast->ends))
        return CAMBER_ERROR_MEMORY;
    coast->ends[coast->way_count++] = coast->place_count;
    return CAMBER_OK;
}

/* The coast went on beyond the box at a gap: along the side, or it comes in at another one as another way. */
camber_status camber_osm_coast_add(camber_osm_coast *coast, const uint64_t *places, size_t count, bool has_gaps) {
    size_t first = coast->place_count;
    camber_status status = CAMBER_OK;
    if (!camber_grow(coast->context, &coast->places, &coast->place_capacity, first + (has_gaps ? 3 : 1) * count,
                     sizeof *coast->places))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count && status == CAMBER_OK; i++) {
        coast->places[coast->place_count++] = places[i];
        const gap found = has_gaps && i + 1 < count ? find_gap(coast->box, places[i], places[i + 1]) : NO_GAP;
        if (found == GAP_AT_SIDE) {
            coast->places[coast->place_count++] = nearest_on_side(coast->box, places[i]);
            coast->places[coast->place_count++] = nearest_on_side(coast->box, places[i + 1]);
        } else if (found == GAP_BETWEEN_SIDES) {
            status = end_way(coast, first);
            first = coast->place_count;
        }
    }
    return status == CAMBER_OK ? end_way(coast, first) : status;
}

void camber_osm_coast_free(camber_osm_coast *coast) {
    camber_free(coast->context, coast->ends);
    camber_free(coast->context, coast->places);
    *coast = (camber_osm_coast){.context = coast->context, .box = coast->box};
}

static size_t first_of(const camber_osm_coast *coast, size_t way) {
    return way ? coast->ends[way - 1] : 0;
}

static bool are_same(const camber_osm_coast *coast, size_t way, size_t other) {
    const size_t first = first_of(coast, way), count = coast->ends[way] - first;
    return coast->ends[other] - first_of(coast, other) == count &&
           memcmp(coast->places + first, coast->places + first_of(coast, other), count * sizeof *coast->places) == 0;
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

/* The next way that begins at a place and is in no line yet. way_count: there is none. */
static size_t find_next(shore *s, uint64_t place) {
    const size_t count = s->coast->way_count, first = find_start(s, place);
    if (first == count)
        return count;
    uint32_t *used = &s->starts[first].used_count;
    while (first + *used < count && s->starts[first + *used].used && s->starts[first + *used].place == place)
        ++*used;
    return first + *used < count && s->starts[first + *used].place == place ? first + *used : count;
}

/* Puts ways that follow each other together. */
static void take_line(shore *s, size_t start) {
    const camber_osm_coast *coast = s->coast;
    s->line_count = 0;
    for (size_t i = start; i < coast->way_count;) {
        const size_t way = s->starts[i].way, first = first_of(coast, way) + (s->line_count > 0),
                     count = coast->ends[way] - first;
        s->starts[i].used = true;
        if (!camber_grow(s->context, &s->line, &s->line_capacity, s->line_count + count, sizeof *s->line)) {
            s->failed = true;
            return;
        }
        memcpy(s->line + s->line_count, coast->places + first, count * sizeof *s->line);
        s->line_count += count;
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

/* distance: of the segment's beginning from the side, above 0 inside. taken: how much of it the segment takes. */
static void cut_at(inside *i, double distance, double taken, int side) {
    const double share = distance / taken;
    if (taken > 0.0 && share < i->to) {
        i->to = share;
        i->to_side = side;
    } else if (taken < 0.0 && share > i->from) {
        i->from = share;
        i->from_side = side;
    } else if (taken == 0.0 && distance < 0.0) {
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

/* ---- Rings ---- */

static void put_place(shore *s, uint64_t place) {
    camber_osm_assembly *sea = s->sea;
    if (!camber_grow(sea->context, &sea->places, &sea->place_capacity, sea->place_count + 1, sizeof *sea->places)) {
        s->failed = true;
        return;
    }
    sea->places[sea->place_count++] = place;
}

/* Ends the ring that begins at a place, and closes it. */
static void put_ring(shore *s, size_t first, camber_osm_role role) {
    camber_osm_assembly *sea = s->sea;
    if (!s->failed && sea->places[first] != sea->places[sea->place_count - 1])
        put_place(s, sea->places[first]);
    if (s->failed ||
        !camber_grow(sea->context, &sea->rings, &sea->ring_capacity, sea->ring_count + 1, sizeof *sea->rings)) {
        s->failed = true;
        return;
    }
    sea->rings[sea->ring_count++] = (camber_osm_ring){first, sea->place_count - first, role};
}

/* A closed line in the box: land lies inside where it goes counter-clockwise, as seen. */
static void put_closed(shore *s, const uint64_t *places, size_t count) {
    const size_t first = s->sea->place_count;
    const double x0 = camber_osm_longitude(places[0]), y0 = camber_osm_latitude(places[0]);
    double area = 0.0;
    for (size_t i = 0; i + 1 < count && !s->failed; i++) {
        const uint64_t a = places[i], b = places[i + 1];
        area += (camber_osm_longitude(a) - x0) * (camber_osm_latitude(b) - y0) -
                (camber_osm_longitude(b) - x0) * (camber_osm_latitude(a) - y0);
        put_place(s, a);
    }
    if (area == 0.0)
        s->sea->place_count = first;
    else
        put_ring(s, first, area > 0.0 ? CAMBER_OSM_ROLE_INNER : CAMBER_OSM_ROLE_OUTER);
}

/* ---- Stretches ---- */

static void add_place(shore *s, uint64_t place) {
    if (s->cut_count > s->stretches[s->stretch_count - 1].first && s->cut[s->cut_count - 1] == place)
        return;
    if (!camber_grow(s->context, &s->cut, &s->cut_capacity, s->cut_count + 1, sizeof *s->cut)) {
        s->failed = true;
        return;
    }
    s->cut[s->cut_count++] = place;
}

static void begin_stretch(shore *s, uint64_t place) {
    if (!camber_grow(s->context, &s->stretches, &s->stretch_capacity, s->stretch_count + 1, sizeof *s->stretches)) {
        s->failed = true;
        return;
    }
    s->stretches[s->stretch_count++] = (stretch){.first = s->cut_count};
    s->in_stretch = true;
    add_place(s, place);
}

/* Ends a stretch, which has to lie between two places of the sides. One that only touches a side is none, and one that
 * ends where it begins is a ring. */
static void end_stretch(shore *s) {
    stretch *p = s->stretches + s->stretch_count - 1;
    s->in_stretch = false;
    p->count = s->cut_count - p->first;
    if (p->count < 2 || s->cut[p->first] == s->cut[s->cut_count - 1]) {
        if (p->count > 3)
            put_closed(s, s->cut + p->first, p->count);
        s->cut_count = p->first;
        s->stretch_count--;
        return;
    }
    p->begin = find_border(s, s->cut[p->first]);
    p->end = find_border(s, s->cut[s->cut_count - 1]);
    s->sea->open |= p->begin < 0 || p->end < 0;
}

/* An extract may have no node beyond its box: then the coast ends at the last one before a side, and goes on to it. */
static void reach_sides(shore *s) {
    const uint64_t first = nearest_on_side(s->box, s->line[0]),
                   last = nearest_on_side(s->box, s->line[s->line_count - 1]);
    if (!camber_grow(s->context, &s->line, &s->line_capacity, s->line_count + 2, sizeof *s->line)) {
        s->failed = true;
        return;
    }
    if (last != s->line[s->line_count - 1])
        s->line[s->line_count++] = last;
    if (first == s->line[0])
        return;
    memmove(s->line + 1, s->line, s->line_count * sizeof *s->line);
    s->line[0] = first;
    s->line_count++;
}

/* Cuts stretches of the line, from its place `first` on. */
static void cut_line(shore *s, size_t first) {
    const size_t count = s->line_count;
    const bool closed = s->line[0] == s->line[count - 1];
    for (size_t k = first; k + 1 < first + count && !s->failed; k++) {
        const size_t at = closed ? k % (count - 1) : k;
        const uint64_t a = s->line[at], b = s->line[at + 1];
        const inside i = find_inside(s, a, b);
        const bool empty = i.from >= i.to;
        if (s->in_stretch && empty)
            end_stretch(s);
        if (empty)
            continue;
        if (!s->in_stretch)
            begin_stretch(s, i.from > 0.0 ? place_on(s, a, b, i.from, i.from_side) : a);
        if (!s->failed)
            add_place(s, i.to < 1.0 ? place_on(s, a, b, i.to, i.to_side) : b);
        if (i.to < 1.0 && !s->failed)
            end_stretch(s);
    }
    if (s->in_stretch && !s->failed)
        end_stretch(s);
}

/* A line is a ring in the box, or lies outside, or is cut: from a place outside on, where it is closed. */
static void take_stretches(shore *s) {
    const bool closed = s->line[0] == s->line[s->line_count - 1];
    size_t outside = 0;
    if (s->line_count < 3 && closed)
        return;
    while (outside < s->line_count && is_in_box(s, s->line[outside]))
        outside++;
    if (closed && outside == s->line_count) {
        put_closed(s, s->line, s->line_count);
        return;
    }
    if (!closed)
        reach_sides(s);
    if (!s->failed)
        cut_line(s, closed ? outside : 0);
}

static void take_all(shore *s) {
    const camber_osm_coast *coast = s->coast;
    for (size_t i = 0; i < coast->way_count; i++)
        s->starts[i] = (way_start){coast->places[first_of(coast, i)], (uint32_t)i, 0, false};
    qsort(s->starts, coast->way_count, sizeof *s->starts, compare_starts);
    for (size_t i = 1; i < coast->way_count; i++)
        s->starts[i].used = are_same(coast, s->starts[i - 1].way, s->starts[i].way);
    /* A way is the first of its line if none ends where it begins. */
    uint8_t *goes_on = camber_alloc_zero(s->context, coast->way_count, 1);
    s->failed = !goes_on;
    for (size_t i = 0; i < coast->way_count && !s->failed; i++) {
        const uint64_t end = coast->places[coast->ends[i] - 1];
        for (size_t k = find_start(s, end); k < coast->way_count && s->starts[k].place == end && !goes_on[k]; k++)
            goes_on[k] = 1;
    }
    for (int rings = 0; rings < 2; rings++)
        for (size_t i = 0; i < coast->way_count && !s->failed && !s->sea->open; i++) {
            if (s->starts[i].used || goes_on[i] > rings)
                continue;
            take_line(s, i);
            if (!s->failed)
                take_stretches(s);
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
            put_place(s, corner_of(s, i));
}

/* Joins the stretches along the sides. marks: two a stretch, by place; each end comes before a beginning. */
static void join_stretches(shore *s, const border_mark *marks, uint8_t *joined, const uint32_t *mark_of_end) {
    const size_t count = 2 * s->stretch_count;
    for (size_t i = 0; i < s->stretch_count && !s->failed; i++) {
        const size_t first = s->sea->place_count;
        for (uint32_t at = (uint32_t)i; !joined[at] && !s->failed;) {
            const stretch *p = s->stretches + at;
            joined[at] = 1;
            for (size_t k = p->first; k < p->first + p->count; k++)
                put_place(s, s->cut[k]);
            const border_mark *next = marks + (mark_of_end[at] + 1) % count;
            put_corners(s, p->end, next->at);
            at = next->stretch;
        }
        if (s->sea->place_count > first)
            put_ring(s, first, CAMBER_OSM_ROLE_OUTER);
    }
}

static void go_around(shore *s) {
    const size_t count = 2 * s->stretch_count;
    border_mark *marks = camber_alloc(s->context, count, sizeof *marks);
    uint8_t *joined = camber_alloc_zero(s->context, s->stretch_count, 1);
    uint32_t *mark_of_end = camber_alloc(s->context, s->stretch_count, sizeof *mark_of_end);
    s->failed = !marks || !joined || !mark_of_end;
    for (size_t i = 0; i < s->stretch_count && !s->failed; i++) {
        marks[2 * i] = (border_mark){s->stretches[i].begin, (uint32_t)i, true};
        marks[2 * i + 1] = (border_mark){s->stretches[i].end, (uint32_t)i, false};
    }
    if (!s->failed)
        qsort(marks, count, sizeof *marks, compare_marks);
    for (size_t i = 0; i < count && !s->failed; i++) {
        s->sea->open |= marks[i].begins == marks[(i + 1) % count].begins;
        if (!marks[i].begins)
            mark_of_end[marks[i].stretch] = (uint32_t)i;
    }
    if (!s->failed && !s->sea->open)
        join_stretches(s, marks, joined, mark_of_end);
    camber_free(s->context, mark_of_end);
    camber_free(s->context, joined);
    camber_free(s->context, marks);
}

/* ---- Rings that fit ---- */

/* A place on a ring that closes in the box, and how often other rings of the sea wind around it. */
typedef struct probe {
    double x, y;
    size_t ring;
    int around;
} probe;

static int compare_probes(const void *a, const void *b) {
    const probe *one = a, *other = b;
    return (one->y > other->y) - (one->y < other->y);
}

/* Adds the edge from a to b of a ring to what winds around the probes. *left: probes that may be looked at. */
static void wind(probe *probes, size_t count, size_t ring, uint64_t a, uint64_t b, size_t *left) {
    const double ax = camber_osm_longitude(a), ay = camber_osm_latitude(a), bx = camber_osm_longitude(b),
                 by = camber_osm_latitude(b), low = ay < by ? ay : by, high = ay < by ? by : ay;
    size_t first = 0;
    for (size_t rest = count; rest > 0;) {
        const size_t half = rest / 2;
        const bool is_below = probes[first + half].y < low;
        first += is_below ? half + 1 : 0;
        rest = is_below ? rest - half - 1 : half;
    }
    for (size_t i = first; i < count && probes[i].y<high && * left> 0; i++, --*left)
        if (probes[i].ring != ring && ax + (probes[i].y - ay) * (bx - ax) / (by - ay) < probes[i].x)
            probes[i].around += by > ay ? 1 : -1;
}

/* Leaves out the rings that lie on the wrong side of others. Without stretches the rings tell whether the box lies in
 * the sea; all have to agree. closed_count: the first rings, which close in the box. */
static void fit_rings(shore *s, probe *probes, size_t closed_count) {
    camber_osm_assembly *sea = s->sea;
    size_t left = MOST_PROBED;
    for (size_t i = 0; i < closed_count; i++) {
        const uint64_t a = sea->places[sea->rings[i].first], b = sea->places[sea->rings[i].first + 1];
        probes[i] = (probe){.x = 0.5 * ((double)camber_osm_longitude(a) + camber_osm_longitude(b)),
                            .y = 0.5 * ((double)camber_osm_latitude(a) + camber_osm_latitude(b)),
                            .ring = i};
    }
    qsort(probes, closed_count, sizeof *probes, compare_probes);
    for (size_t i = 0; i < sea->ring_count; i++)
        for (size_t k = sea->rings[i].first; k + 1 < sea->rings[i].first + sea->rings[i].count; k++)
            wind(probes, closed_count, i, sea->places[k], sea->places[k + 1], &left);
    bool is_sea = false;
    for (size_t i = 0; i < closed_count; i++) {
        camber_osm_ring *ring = sea->rings + probes[i].ring;
        const int missing = (ring->role == CAMBER_OSM_ROLE_INNER) - probes[i].around;
        if (s->stretch_count)
            ring->count = missing == 0 ? ring->count : 0;
        else
            sea->open |= missing < 0 || missing > 1 || (i > 0 && is_sea != (missing == 1));
        is_sea = missing == 1;
    }
    sea->open |= left == 0;
    const size_t first = sea->place_count;
    for (int i = 0; i < 4 && is_sea && !s->stretch_count; i++)
        put_place(s, corner_of(s, i));
    if (is_sea && !s->stretch_count)
        put_ring(s, first, CAMBER_OSM_ROLE_OUTER);
}

static void find_fitting(shore *s, size_t closed_count) {
    camber_osm_assembly *sea = s->sea;
    probe *probes = camber_alloc(s->context, closed_count, sizeof *probes);
    s->failed = !probes;
    if (probes)
        fit_rings(s, probes, closed_count);
    camber_free(s->context, probes);
    size_t kept = 0;
    for (size_t i = 0; i < sea->ring_count; i++)
        if (sea->rings[i].count)
            sea->rings[kept++] = sea->rings[i];
    sea->ring_count = kept;
}

static int compare_rings(const void *a, const void *b) {
    const camber_osm_ring *one = a, *other = b;
    return one->role != other->role ? (int)one->role - (int)other->role
                                    : (one->first > other->first) - (one->first < other->first);
}

camber_status camber_osm_coast_fill(const camber_osm_coast *coast, camber_osm_assembly *sea) {
    const camber_osm_box box = coast->box;
    shore s = {.context = sea->context, .coast = coast, .box = box, .sea = sea};
    sea->place_count = sea->ring_count = 0;
    sea->open = box.left >= box.right || box.bottom >= box.top;
    if (sea->open || coast->way_count == 0)
        return CAMBER_OK;
    if (!(s.starts = camber_alloc(s.context, coast->way_count, sizeof *s.starts)))
        return CAMBER_ERROR_MEMORY;
    take_all(&s);
    const size_t closed_count = sea->ring_count;
    if (!s.failed && !sea->open && s.stretch_count)
        go_around(&s);
    if (!s.failed && !sea->open && closed_count)
        find_fitting(&s, closed_count);
    if (sea->open)
        sea->ring_count = 0;
    if (sea->ring_count)
        qsort(sea->rings, sea->ring_count, sizeof *sea->rings, compare_rings); /* outer rings come first */
    camber_free(s.context, s.stretches);
    camber_free(s.context, s.cut);
    camber_free(s.context, s.line);
    camber_free(s.context, s.starts);
    return s.failed ? CAMBER_ERROR_MEMORY : CAMBER_OK;
}
