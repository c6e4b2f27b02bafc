/* Finds the point of a polygon that is farthest from its edges: its pole of inaccessibility, for labels of areas.
 *
 * Input: rings. Output: the point, within a precision. Main idea (polylabel, by Vladimir Agafonkin): squares cover the
 * polygon. The square that may contain the farthest point is cut into four, until no square can contain a point that is
 * farther by more than the precision. */
#include "map/label_anchors.h"

#include <math.h>

/* The most squares along a side of the polygon's box at first; and the most edges to look at, after which the best
 * point so far is used. */
enum { MOST_SQUARES_A_SIDE = 64, MOST_EDGES = 1 << 26 };

typedef struct square {
    double x, y, half;
    double distance; /* from its middle to the edges; negative: the middle is outside */
    double most;     /* an upper bound of the distance of any of its points */
} square;

typedef struct pole_search {
    camber_context *context;
    const double *points;
    const size_t *offsets;
    size_t ring_count;
    square *heap; /* the square with the largest `most` is first */
    size_t count, capacity;
    size_t edges; /* how many edges were looked at */
    double best;  /* distance of the best point so far */
    double precision;
} pole_search;

static double square_distance(const double *a, const double *b, double x, double y) {
    const double dx = b[0] - a[0], dy = b[1] - a[1], px = x - a[0], py = y - a[1];
    const double along = px * dx + py * dy, length = dx * dx + dy * dy;
    if (along <= 0.0)
        return px * px + py * py;
    if (along >= length)
        return (x - b[0]) * (x - b[0]) + (y - b[1]) * (y - b[1]);
    const double across = px * dy - py * dx;
    return across * across / length;
}

/* Returns the distance of a point from the edges, which is negative outside. Stops at an edge that is nearer than
 * `enough`. */
static double distance_of(pole_search *s, double x, double y, double enough) {
    const double bound = enough > 0.0 ? enough * enough : -1.0;
    bool inside = false;
    double least = INFINITY;
    for (size_t r = 0; r < s->ring_count; r++) {
        s->edges += s->offsets[r + 1] - s->offsets[r];
        for (size_t i = s->offsets[r]; i + 1 < s->offsets[r + 1] && least > bound; i++) {
            const double *a = s->points + 2 * i, *b = a + 2;
            if ((a[1] > y) != (b[1] > y) && x < (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]) + a[0])
                inside = !inside;
            const double distance = square_distance(a, b, x, y);
            least = distance < least ? distance : least;
        }
    }
    return least <= bound ? -INFINITY : inside ? sqrt(least) : -sqrt(least);
}

/* Measures a square. If its middle is no better than the best point, and no point in it can be better by more than the
 * precision, its distance is infinite. */
static square look(pole_search *s, double x, double y, double half) {
    const double reach = half * 1.4142135623730951;
    square made = {.x = x, .y = y, .half = half};
    made.distance = distance_of(s, x, y, fmin(s->best, s->best + s->precision - reach));
    made.most = made.distance + reach;
    return made;
}

static bool push(pole_search *s, square pushed) {
    if (!isfinite(pushed.distance))
        return true;
    if (!camber_grow(s->context, &s->heap, &s->capacity, s->count + 1, sizeof *s->heap))
        return false;
    size_t at = s->count++;
    for (; at > 0 && s->heap[(at - 1) / 2].most < pushed.most; at = (at - 1) / 2)
        s->heap[at] = s->heap[(at - 1) / 2];
    s->heap[at] = pushed;
    return true;
}

static square pop(pole_search *s) {
    const square top = s->heap[0], last = s->heap[--s->count];
    size_t at = 0;
    for (size_t next = 1; next < s->count; next = 2 * at + 1) {
        if (next + 1 < s->count && s->heap[next + 1].most > s->heap[next].most)
            next++;
        if (!(s->heap[next].most > last.most))
            break;
        s->heap[at] = s->heap[next];
        at = next;
    }
    if (s->count)
        s->heap[at] = last;
    return top;
}

/* Measures the centroid of the outer ring. */
static square first_guess(pole_search *s) {
    double area = 0.0, x = 0.0, y = 0.0;
    const double *origin = s->points + 2 * s->offsets[0];
    for (size_t i = s->offsets[0]; i + 1 < s->offsets[1]; i++) {
        const double ax = s->points[2 * i] - origin[0], ay = s->points[2 * i + 1] - origin[1];
        const double bx = s->points[2 * i + 2] - origin[0], by = s->points[2 * i + 3] - origin[1];
        const double cross = ax * by - bx * ay;
        x += (ax + bx) * cross;
        y += (ay + by) * cross;
        area += 3.0 * cross;
    }
    return area == 0.0 ? look(s, origin[0], origin[1], 0.0) : look(s, origin[0] + x / area, origin[1] + y / area, 0.0);
}

static camber_box box_of(const pole_search *s) {
    camber_box box = CAMBER_BOX_EMPTY;
    for (size_t i = s->offsets[0]; i < s->offsets[1]; i++)
        camber_box_add(&box, s->points[2 * i], s->points[2 * i + 1]);
    return box;
}

static bool cover(pole_search *s, const camber_box *box, double side) {
    for (double x = box->x0; x < box->x1; x += side)
        for (double y = box->y0; y < box->y1; y += side)
            if (!push(s, look(s, x + 0.5 * side, y + 0.5 * side, 0.5 * side)))
                return false;
    return true;
}

camber_status camber_pole_find(camber_context *context, const double *points, const size_t *offsets, size_t ring_count,
                               double precision, double pole[2]) {
    pole_search s = {.context = context,
                     .points = points,
                     .offsets = offsets,
                     .ring_count = ring_count,
                     .best = -INFINITY,
                     .precision = precision};
    const camber_box box = box_of(&s);
    const double width = box.x1 - box.x0, height = box.y1 - box.y0;
    const double side = fmax(fmin(width, height), fmax(width, height) / MOST_SQUARES_A_SIDE);
    square best = first_guess(&s);
    s.best = best.distance;
    bool made = !(side > 0.0) || !isfinite(side) || cover(&s, &box, side);
    while (made && s.count && s.edges < MOST_EDGES) {
        const square top = pop(&s);
        if (top.distance > best.distance)
            best = top;
        s.best = best.distance;
        if (!(top.most - best.distance > precision))
            continue;
        const double half = 0.5 * top.half;
        for (int i = 0; i < 4 && made; i++)
            made = push(&s, look(&s, top.x + (i & 1 ? half : -half), top.y + (i & 2 ? half : -half), half));
    }
    camber_free(context, s.heap);
    pole[0] = best.x;
    pole[1] = best.y;
    return made ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}
