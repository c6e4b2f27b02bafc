/* Turns the coast into an area of sea.
 *
 * Input: ways with land on their left, and a box. Output: the rings around the sea. The main idea: ways that continue
 * each other are joined into lines. Each part of a line inside the box is either a ring, or a stretch from one place on
 * the box's sides to another. The sea is to the right of a stretch, so the outline of the sea continues clockwise along
 * the box's sides, from the end of the stretch to the beginning of the next one:
 *
 *        +---end--->--+       Ends and beginnings alternate around the box. If they do not, a part of the coast is
 *        |    |       |       missing, and then drawing no sea is better than flooding the land.
 *        | land  sea  v
 *        |    ^       |       Rings are islands, or seas surrounded by land. How often the other rings wind around a
 *        +--begin--<--+       ring shows whether it fits, and, if there are no stretches, whether the box is in the
 * sea.
 */
#include "osm/coast.h"

#include "osm/node_set.h"

#include <math.h>
#include <stdlib.h>

/* The coast may end at most this far from a side of the box: 1 / NEAR_SHARE of the box's shorter side, and NEAR_MOST in
 * 10^-7 degrees. */
enum { NEAR_SHARE = 16, NEAR_MOST = 500000 };
/* The maximum number of pairs of an edge and a ring that are examined. A real coast needs about one per edge. */
static const size_t MOST_PROBED = (size_t)1 << 31;

/* A way and its first place. */
typedef struct way_start {
    uint64_t place;
    uint32_t way;
    uint32_t used_count; /* only for the first of the ways that begin at a place: how many of these are used */
    bool used;
} way_start;

/* A part of the coast that leads through the box from side to side: its places, and the positions along the sides at
 * which it begins and ends. */
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
    way_start *starts; /* way_count, sorted by place */
    uint64_t *line;    /* the places of the ways that were joined */
    size_t line_count, line_capacity;
    uint64_t *cut; /* the places of all stretches */
    size_t cut_count, cut_capacity;
    stretch *stretches;
    size_t stretch_count, stretch_capacity;
    bool in_stretch;
    bool failed; /* out of memory */
} shore;

/* ---- Ways ---- */

/* Returns the side that a place in the box is near: 0 left, 1 right, 2 bottom, 3 top; negative if it is near none. */
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

/* Moves a place to the side that it is near, and returns the result. A place that is near no side stays as it is. */
static uint64_t nearest_on_side(camber_osm_box b, uint64_t place) {
    const int side = find_side(b, place), x = camber_osm_longitude(place), y = camber_osm_latitude(place);
    return side < 0   ? place
           : side < 2 ? camber_osm_place(side ? b.right : b.left, y)
                      : camber_osm_place(x, side == 2 ? b.bottom : b.top);
}

/* A gap between two nodes of a way: the coast leaves the box there, and returns on the same side or on another one. */
typedef enum gap { NO_GAP, GAP_AT_SIDE, GAP_BETWEEN_SIDES } gap;

/* A segment along one side counts as a gap if it is long compared with the distances of its ends from the side. If it
 * were taken for coast, it would wrongly cut off a narrow strip. */
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

/* Ends the way whose places begin at `first`. It is dropped if it has fewer than two places. */
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

/* At a gap, the coast continues outside the box. If it returns on the same side, the way is led along that side. If it
 * returns on another side, the way is split in two. */
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

/* Returns the index of the first of the ways that begin at a place, or the index at which it would be. */
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

/* Returns the next way that begins at a place and is not in a line yet, or way_count if there is none. */
static size_t find_next(shore *s, uint64_t place) {
    const size_t count = s->coast->way_count, first = find_start(s, place);
    if (first == count)
        return count;
    uint32_t *used = &s->starts[first].used_count;
    while (first + *used < count && s->starts[first + *used].used && s->starts[first + *used].place == place)
        ++*used;
    return first + *used < count && s->starts[first + *used].place == place ? first + *used : count;
}

/* Makes a line from a way and those that continue it. */
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

/* Returns the position of a place along the sides, clockwise from the upper left corner; negative if it is on no side.
 */
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

/* The part of a segment that is inside the box, as fractions of its length, and the sides on which it begins and ends.
 */
typedef struct inside {
    double from, to;
    int from_side, to_side; /* 0: an end of the segment; otherwise 1 left, 2 right, 3 bottom, 4 top */
} inside;

/* Cuts a segment at one side. distance: how far the segment's beginning is from the side, positive inside. taken: by
 * how much this distance shrinks along the segment. */
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

/* Returns the place at a fraction of a segment, moved exactly onto a side. */
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

/* Closes and adds the ring whose first place has the index `first`. */
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

/* Adds a closed line that is wholly inside the box. If it goes counter-clockwise on the map, land is inside it. */
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

/* Ends a stretch, which must lead from one place on the sides to another. A stretch that only touches a side is
 * dropped, and a stretch that ends where it begins becomes a ring. */
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

/* Extends the ends of the coast to the sides. An extract may have no nodes outside its box; then the coast ends at the
 * last node before a side. */
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

/* Cuts the line into stretches, starting from its place `first`. */
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

/* Adds a line that is a ring inside the box, drops a line outside the box, and cuts any other into stretches. If the
 * line is closed, cutting starts from a place outside the box. */
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
    /* A way is the first of its line if no other way ends where it begins. */
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

/* Adds the corners of the box between two positions on its sides, clockwise. */
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

/* Joins the stretches along the sides. marks: two per stretch, sorted by position; at the same position ends come
 * before beginnings. */
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

/* ---- Which rings fit ---- */

/* A place on a ring that is closed in the box, and how often the other rings of the sea wind around it. */
typedef struct probe {
    double x, y;
    size_t ring;
    int around;
} probe;

static int compare_probes(const void *a, const void *b) {
    const probe *one = a, *other = b;
    return (one->y > other->y) - (one->y < other->y);
}

/* Adds the contribution of a ring's edge from a to b to the winding around the probes. *left: how many more probes may
 * be examined. */
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

/* Drops rings that are on the wrong side of others. If there are no stretches, the rings decide whether the box is in
 * the sea, and all of them must agree. closed_count: the number of rings that are closed in the box, which come
 * first. */
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
