/* Turns rings of areas into the form that fill layers draw.
 *
 * Input: a ring from a file, open or closed, in either direction. Output: a closed ring whose direction shows whether
 * it is an outer ring or a hole, or nothing if the ring has no area. Every repair is counted. Rings that cross
 * themselves or have spikes, and holes outside their area, are only counted and stay as they are. */
#include "features/rings.h"

#include "base/threads.h"

#include <math.h>
#include <string.h>

static bool same(const double *p, const double *q) {
    return p[0] == q[0] && p[1] == q[1];
}

/* Returns twice the area of the triangle with these corners. */
static double cross(const double *origin, const double *p, const double *q) {
    return (p[0] - origin[0]) * (q[1] - origin[1]) - (p[1] - origin[1]) * (q[0] - origin[0]);
}

double camber_ring_area(const double *points, size_t count) {
    double area = 0.0;
    for (size_t i = 1; i + 1 < count; i++)
        area += cross(points, points + 2 * i, points + 2 * i + 2);
    return area;
}

void camber_ring_turn(double *points, size_t count) {
    for (size_t i = 0; i < count / 2; i++) {
        double *a = points + 2 * i, *b = points + 2 * (count - 1 - i), kept[2];
        memcpy(kept, a, sizeof kept);
        memcpy(a, b, sizeof kept);
        memcpy(b, kept, sizeof kept);
    }
}

bool camber_ring_is_flat(const double *points, size_t count) {
    const double *far = points;
    double most = 0.0;
    for (size_t i = 1; i < count; i++) {
        const double dx = points[2 * i] - points[0], dy = points[2 * i + 1] - points[1], squared = dx * dx + dy * dy;
        far = squared > most ? points + 2 * i : far;
        most = fmax(most, squared);
    }
    for (size_t i = 1; i < count; i++)
        if (cross(points, far, points + 2 * i) != 0.0)
            return false;
    return true;
}

static size_t drop_invalid(double *points, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(points[2 * i]) || !isfinite(points[2 * i + 1]))
            continue;
        points[2 * kept] = points[2 * i];
        points[2 * kept + 1] = points[2 * i + 1];
        kept++;
    }
    return kept;
}

size_t camber_rings_take(camber_rings *rings, double *points, size_t count, bool hole) {
    count = drop_invalid(points, count);
    const bool flat = camber_ring_is_flat(points, count);
    const double area = camber_ring_area(points, count);
    const bool keeps =
        flat && rings->any_winding && rings->outer_area != 0.0; /* a hole may belong to another outer ring */
    if (!hole && !keeps)
        rings->outer_area = flat ? 0.0 : area != 0.0 ? area : 1.0;
    if (flat || (hole && rings->outer_area == 0.0)) {
        rings->stats->empty_rings++;
        return 0;
    }
    if (!same(points, points + 2 * (count - 1))) {
        rings->stats->closed_rings++;
        memcpy(points + 2 * count++, points, 2 * sizeof *points);
    }
    rings->stats->turned_rings += hole && !rings->any_winding && area * rings->outer_area > 0.0;
    if (hole ? area > 0.0 : area < 0.0)
        camber_ring_turn(points, count);
    return count;
}

/* ---- Rings that cross themselves ---- */

/* The edges [first, end) of a ring and the box around them. Edge i goes from point i to the next. */
typedef struct span {
    size_t first, end;
    double x0, y0, x1, y1;
} span;

enum { FEW_EDGES = 8, LOOKS_AN_EDGE = 200 };

static span span_of(const double *points, size_t first, size_t end, size_t *looks) {
    span s = {first, end, INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (size_t i = first; i <= end; i++) {
        s.x0 = points[2 * i] < s.x0 ? points[2 * i] : s.x0;
        s.y0 = points[2 * i + 1] < s.y0 ? points[2 * i + 1] : s.y0;
        s.x1 = points[2 * i] > s.x1 ? points[2 * i] : s.x1;
        s.y1 = points[2 * i + 1] > s.y1 ? points[2 * i + 1] : s.y1;
    }
    *looks -= *looks < end - first ? *looks : end - first;
    return s;
}

static bool edges_cross(const double *a, const double *c) {
    const double *b = a + 2, *d = c + 2;
    return cross(a, b, c) * cross(a, b, d) < 0.0 && cross(c, d, a) * cross(c, d, b) < 0.0;
}

/* Whether an edge in span a crosses an edge in span b. Halves the longer span until both are short. */
static bool spans_cross(const double *points, span a, span b, size_t *looks) {
    const bool apart = a.x1 < b.x0 || b.x1 < a.x0 || a.y1 < b.y0 || b.y1 < a.y0;
    if (apart || *looks == 0)
        return false;
    const size_t in_a = a.end - a.first, in_b = b.end - b.first;
    if (in_a <= FEW_EDGES && in_b <= FEW_EDGES) {
        *looks -= *looks < in_a * in_b ? *looks : in_a * in_b;
        for (size_t i = a.first; i < a.end; i++)
            for (size_t k = b.first; k < b.end; k++)
                if (edges_cross(points + 2 * i, points + 2 * k))
                    return true;
        return false;
    }
    const span longer = in_a > in_b ? a : b, other = in_a > in_b ? b : a;
    const size_t middle = (longer.first + longer.end) / 2;
    return spans_cross(points, span_of(points, longer.first, middle, looks), other, looks) ||
           spans_cross(points, span_of(points, middle, longer.end, looks), other, looks);
}

static bool span_crosses(const double *points, size_t first, size_t end, size_t *looks) {
    if (end - first <= FEW_EDGES) {
        for (size_t i = first; i < end; i++)
            for (size_t k = i + 2; k < end; k++)
                if (edges_cross(points + 2 * i, points + 2 * k))
                    return true;
        return false;
    }
    const size_t middle = (first + end) / 2;
    return span_crosses(points, first, middle, looks) || span_crosses(points, middle, end, looks) ||
           spans_cross(points, span_of(points, first, middle, looks), span_of(points, middle, end, looks), looks);
}

bool camber_ring_crosses(const double *points, size_t count) {
    size_t looks = LOOKS_AN_EDGE * count;
    return count > 3 && span_crosses(points, 0, count - 1, &looks);
}

/* ---- Spikes, and holes outside ---- */

bool camber_ring_has_spike(const double *points, size_t count) {
    static const double thin = 1e-7; /* as a fraction of the edge's length */
    size_t last = count - 1;
    while (last > 0 && same(points + 2 * last, points))
        last--;
    const double *before = points + 2 * last, *at = points;
    for (size_t i = 1; i < count; i++) {
        const double *next = points + 2 * i;
        if (same(at, next))
            continue;
        const double along = (at[0] - before[0]) * (next[0] - at[0]) + (at[1] - before[1]) * (next[1] - at[1]);
        if (along < 0.0 && fabs(cross(before, at, next)) <= -thin * along)
            return true;
        before = at;
        at = next;
    }
    return false;
}

/* Returns how often a closed ring winds around a point. *touches: an edge passes through the point. */
static int winding_around(const double *points, size_t count, const double *at, bool *touches) {
    int winding = 0;
    for (size_t i = 0; i + 1 < count; i++) {
        const double *a = points + 2 * i, *b = a + 2;
        if ((a[1] < at[1] && b[1] < at[1]) || (a[1] > at[1] && b[1] > at[1]))
            continue;
        const double side = cross(a, b, at);
        *touches |= side == 0.0 && at[0] >= fmin(a[0], b[0]) && at[0] <= fmax(a[0], b[0]);
        if ((a[1] <= at[1]) != (b[1] <= at[1]))
            winding += b[1] > a[1] ? side > 0.0 : -(side < 0.0);
    }
    return winding;
}

/* The rings of one area: polylines [first, end). */
typedef struct area_rings {
    const camber_features *features;
    size_t first, end;
    size_t looks; /* how many more edges may be examined; at 0 the test gives up */
} area_rings;

static size_t ring_of(const camber_features *features, size_t polyline, const double **points) {
    *points = features->points + 2 * features->offsets[polyline];
    return features->offsets[polyline + 1] - features->offsets[polyline];
}

/* Whether a hole is outside the area. The first corner of the hole that no outer ring touches decides. */
static bool is_outside(area_rings *area, size_t hole) {
    const double *corners, *points;
    const size_t corner_count = ring_of(area->features, hole, &corners);
    bool touches = true;
    int winding = 0;
    for (size_t i = 0; i < corner_count && touches && area->looks > 0; i++) {
        touches = false;
        winding = 0;
        for (size_t ring = area->first; ring < area->end; ring++) {
            const size_t count = ring_of(area->features, ring, &points);
            if (camber_ring_area(points, count) > 0.0)
                winding += winding_around(points, count, corners + 2 * i, &touches);
            area->looks -= area->looks < count ? area->looks : count;
        }
    }
    return !touches && winding == 0;
}

/* ---- The count ---- */

/* The most threads that count, and how many points make a second one worthwhile. */
enum { MOST_COUNTERS = 8, FEW_POINTS = 1 << 15 };

typedef struct odd_rings {
    size_t crossing, spiked, outside;
} odd_rings;

typedef struct ring_count {
    const camber_features *features;
    size_t first, end; /* polylines */
    size_t thread_count;
    odd_rings odd[MOST_COUNTERS];
} ring_count;

static void count_ring(odd_rings *odd, area_rings *area, size_t polyline) {
    const double *points;
    const size_t count = ring_of(area->features, polyline, &points);
    odd->crossing += camber_ring_crosses(points, count);
    odd->spiked += camber_ring_has_spike(points, count);
    odd->outside += camber_ring_area(points, count) < 0.0 && is_outside(area, polyline);
}

/* Returns the first polyline of a thread's part. Parts have about as many points, and whole features. */
static size_t part_begin(const ring_count *c, size_t number) {
    const camber_features *f = c->features;
    const size_t first = f->offsets[c->first], points = f->offsets[c->end] - first;
    size_t low = c->first, high = c->end;
    if (number == 0 || number == c->thread_count)
        return number ? c->end : c->first;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (f->offsets[middle] - first < points / c->thread_count * number)
            low = middle + 1;
        else
            high = middle;
    }
    while (low > c->first && low < c->end && f->polyline_feature[low] == f->polyline_feature[low - 1])
        low++;
    return low;
}

static void count_part(void *user, size_t number) {
    ring_count *c = user;
    const camber_features *f = c->features;
    const size_t part_end = part_begin(c, number + 1);
    size_t end = part_begin(c, number);
    odd_rings odd = {0};
    for (size_t first = end; first < part_end; first = end) {
        const uint32_t feature = f->polyline_feature[first];
        while (end < part_end && f->polyline_feature[end] == feature)
            end++;
        if (f->classes[f->feature_class[feature]].geometry != CAMBER_GEOMETRY_AREA)
            continue;
        area_rings area = {f, first, end, LOOKS_AN_EDGE * (f->offsets[end] - f->offsets[first])};
        for (size_t i = first; i < end; i++)
            count_ring(&odd, &area, i);
    }
    c->odd[number] = odd;
}

/* Counts defects of rings. The rings stay as they are. */
static void count_odd(camber_features *features, size_t first_polyline) {
    ring_count c = {.features = features, .first = first_polyline, .end = features->polyline_count, .thread_count = 1};
    if (c.first == c.end)
        return;
    if (features->offsets[c.end] - features->offsets[c.first] >= FEW_POINTS)
        c.thread_count = camber_threads_count(features->threads);
    c.thread_count = c.thread_count < MOST_COUNTERS ? c.thread_count : MOST_COUNTERS;
    camber_threads_run(c.thread_count, count_part, &c);
    for (size_t i = 0; i < c.thread_count; i++) {
        features->stats.crossing_rings += c.odd[i].crossing;
        features->stats.spiked_rings += c.odd[i].spiked;
        features->stats.outside_holes += c.odd[i].outside;
    }
}

/* ---- The antimeridian ---- */

/* Returns by how much x changes from one point to the next along the short way around the Earth. */
static double short_way(double from, double to) {
    const bool along = (from == 0.0 && to == 1.0) || (from == 1.0 && to == 0.0);
    return fabs(to - from) <= 0.5 || along ? 0.0 : to < from ? 1.0 : -1.0;
}

/* Whether a ring extends beyond the world on one side only, and at most once around. */
static bool crosses_once(const double *points, size_t count) {
    double moved = 0.0, west = 0.0, east = 0.0;
    for (size_t i = 1; i < count; i++) {
        moved += short_way(points[2 * i - 2], points[2 * i]);
        west = fmin(west, moved);
        east = fmax(east, moved);
    }
    return east - west == 1.0;
}

size_t camber_ring_unroll(double *points, size_t count, bool *crosses) {
    *crosses = crosses_once(points, count);
    if (!*crosses)
        return count;
    double moved = 0.0, before = points[0], y = 0.0;
    for (size_t i = 0; i < count; i++) {
        double *at = points + 2 * i;
        moved += short_way(before, at[0]);
        before = at[0];
        at[0] += moved;
        y += at[1];
    }
    double *last = points + 2 * (count - 1);
    const double first[2] = {points[0], points[1]};
    if (moved + short_way(before, first[0]) == 0.0)
        return count;
    /* The ring goes around the Earth, so the pole on its side of the equator is inside. */
    const double pole = y / (double)count < 0.5 ? 0.0 : 1.0,
                 close[6] = {last[0], pole, first[0], pole, first[0], first[1]};
    memcpy(last + 2, close, sizeof close);
    return count + 3;
}

/* ---- The report ---- */

void camber_rings_report(camber_features *features, const char *name, size_t first_polyline,
                         const camber_features_stats *before) {
    count_odd(features, first_polyline);
    const camber_features_stats *stats = &features->stats;
    const struct {
        size_t count;
        const char *what;
    } all[] = {
        {stats->closed_rings - before->closed_rings, "rings of areas were not closed; they are now"},
        {stats->turned_rings - before->turned_rings, "rings of areas wound the wrong way; they were turned around"},
        {stats->empty_rings - before->empty_rings, "rings have no area; they are left out"},
        {stats->crossing_rings - before->crossing_rings,
         "rings of areas cross themselves; they are drawn as they wind"},
        {stats->spiked_rings - before->spiked_rings,
         "rings of areas have a spike; it is not drawn, since it has no area"},
        {stats->outside_holes - before->outside_holes, "holes are outside their area; they are filled there"},
        {stats->open_relations - before->open_relations,
         "multipolygons lack ways; those of their rings that do not close are left out"}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (all[i].count)
            camber_log(features->context, i == 0 ? CAMBER_LOG_WARNING : CAMBER_LOG_INFO, "%s: %zu %s", name,
                       all[i].count, all[i].what);
}
