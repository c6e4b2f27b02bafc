/* Marching squares. The corners of the squares are the values, plus one more row or column on each side, which is
 * outside. A ring crosses each side of a square that has one end inside and the other outside. In each square, it runs
 * from the side where it enters to the side where it leaves, with the inside to its right:
 *
 *     o---x     o outside, x inside. The ring enters from the right side and leaves through the top:
 *     |  /      each crossing is followed by one other crossing, so walking from one to the next gives the rings.
 *     o-' o
 *
 * Afterwards, a point is left out if a straight line between other points passes it within a small tolerance. */
#include "text/contours.h"

#include <math.h>

/* Values are rounded down from 255 - (64 + 32 d), d px outside of the edge, so the edge is between 191 and 192. */
static const float EDGE = 191.5f;
/* The most distance from a ring to a point that is left out of it: 1/40 px of the bitmap. */
static const float TOLERANCE_EM = 1.0f / 960.0f;

typedef struct grid {
    const camber_contour_source *source;
    uint32_t width, height; /* in corners */
    uint32_t *next; /* a crossing -> the next one + 1. 0: no ring crosses the side, or the crossing has been used */
} grid;

static float get_value(const grid *g, uint32_t x, uint32_t y) {
    if (x == 0 || y == 0 || x > g->source->width || y > g->source->height)
        return 0.0f;
    return g->source->values[(size_t)(y - 1) * g->source->width + (x - 1)];
}

/* Returns the number of a square's side: its top (0), right (1), bottom (2) or left (3). The number of a side is made
 * from the corner at its left or top end. */
static uint32_t get_side(const grid *g, uint32_t x, uint32_t y, int side) {
    switch (side) {
    case 0: return 2 * (y * g->width + x);
    case 1: return 2 * (y * g->width + x + 1) + 1;
    case 2: return 2 * ((y + 1) * g->width + x);
    default: return 2 * (y * g->width + x) + 1;
    }
}

static void join_sides(grid *g, uint32_t x, uint32_t y, int from, int to) {
    g->next[get_side(g, x, y, from)] = get_side(g, x, y, to) + 1;
}

/* Joins the crossings of a square. Imagine walking around it clockwise: top left, top right, bottom right, bottom left.
 * A ring enters the square through a side on which this walk leaves the inside, and leaves the square through a side on
 * which the walk enters the inside. */
static void join_square(grid *g, uint32_t x, uint32_t y) {
    const float values[4] = {get_value(g, x, y), get_value(g, x + 1, y), get_value(g, x + 1, y + 1),
                             get_value(g, x, y + 1)};
    int in[2], out[2], count = 0, out_count = 0;
    for (int side = 0; side < 4; side++) {
        const bool from = values[side] > EDGE, to = values[(side + 1) & 3] > EDGE;
        if (!from && to)
            in[count++] = side;
        else if (from && !to)
            out[out_count++] = side;
    }
    if (count == 1)
        join_sides(g, x, y, out[0], in[0]);
    else if (count == 2) {
        /* Two opposite corners are inside. They are joined if the middle is inside, or nearly so: otherwise the thin
         * strokes of small glyphs would fall apart. */
        const bool is_joined = values[0] + values[1] + values[2] + values[3] > 4.0f * (EDGE - 4.0f);
        for (int i = 0; i < 2; i++) {
            const int after = (in[i] + 1) & 3, before = (in[i] + 3) & 3;
            join_sides(g, x, y, is_joined ? before : after, in[i]);
        }
    }
}

static void add_crossing(const grid *g, uint32_t side, camber_outline_maker *maker) {
    const uint32_t x = side / 2 % g->width, y = side / 2 / g->width;
    const bool is_vertical = side & 1;
    const float a = get_value(g, x, y);
    const float b = is_vertical ? get_value(g, x, y + 1) : get_value(g, x + 1, y);
    const float share = (EDGE - a) / (b - a);
    const float px = (float)x - 1.0f + (is_vertical ? 0.0f : share);
    const float py = (float)y - 1.0f + (is_vertical ? share : 0.0f);
    camber_outline_add_point(maker, g->source->left + px * g->source->scale, g->source->top + py * g->source->scale);
}

/* The directions in which a straight line from a point of a ring passes near all points that follow it. */
typedef struct sector {
    float x, y;      /* the point */
    float direction; /* towards the next point; low and high are relative to it */
    float low, high;
    float reach; /* distance of the farthest point */
} sector;

static sector begin_sector(float x, float y) {
    return (sector){.x = x, .y = y, .low = -4.0f, .high = 4.0f};
}

/* Whether the line from the sector's point to this one passes all points between them. */
static bool follow(sector *s, float x, float y) {
    const float dx = x - s->x, dy = y - s->y, distance = hypotf(dx, dy);
    const float direction = atan2f(dy, dx);
    if (s->reach == 0.0f)
        s->direction = direction;
    const float turn = remainderf(direction - s->direction, 6.28318531f);
    if (distance < s->reach || turn < s->low || turn > s->high)
        return false;
    if (distance > TOLERANCE_EM) {
        const float half = asinf(TOLERANCE_EM / distance);
        s->low = fmaxf(s->low, turn - half);
        s->high = fminf(s->high, turn + half);
    }
    s->reach = distance;
    return true;
}

/* Leaves out points of the last ring that are on a straight line between others: stems have one such point per pixel.
 */
static void thin_ring(camber_outline_maker *maker) {
    if (maker->status)
        return;
    float *points = maker->points + 2 * (size_t)maker->offsets[maker->ring_count - 1];
    const size_t count = maker->point_count - maker->offsets[maker->ring_count - 1];
    if (count < 3)
        return;
    size_t kept = 1;
    sector s = begin_sector(points[0], points[1]);
    for (size_t i = 1; i < count; i++) {
        const float x = points[2 * i], y = points[2 * i + 1];
        if (follow(&s, x, y))
            continue;
        const float before_x = points[2 * i - 2], before_y = points[2 * i - 1];
        points[2 * kept] = before_x;
        points[2 * kept + 1] = before_y;
        kept++;
        s = begin_sector(before_x, before_y);
        follow(&s, x, y);
    }
    points[2 * kept] = points[2 * count - 2];
    points[2 * kept + 1] = points[2 * count - 1];
    maker->point_count = maker->offsets[maker->ring_count - 1] + kept + 1;
}

void camber_contours_trace(const camber_contour_source *source, camber_outline_maker *maker) {
    grid g = {source, source->width + 2, source->height + 2, NULL};
    const size_t side_count = 2 * (size_t)g.width * g.height;
    if (maker->status)
        return;
    g.next = camber_alloc_zero(maker->context, side_count, sizeof *g.next);
    if (!g.next) {
        maker->status = CAMBER_ERROR_MEMORY;
        return;
    }
    for (uint32_t y = 0; y + 1 < g.height; y++)
        for (uint32_t x = 0; x + 1 < g.width; x++)
            join_square(&g, x, y);
    for (size_t first = 0; first < side_count && !maker->status; first++) {
        if (!g.next[first])
            continue;
        camber_outline_begin_ring(maker);
        for (uint32_t side = (uint32_t)first; g.next[side];) {
            const uint32_t following = g.next[side] - 1;
            g.next[side] = 0;
            add_crossing(&g, side, maker);
            side = following;
        }
        thin_ring(maker);
        camber_outline_end_ring(maker);
    }
    camber_free(maker->context, g.next);
}
