/* Makes triangles from areas.
 *
 * Input: rings in px, and the window to clip them to. Output: corners and triangles. Main idea: each ring is clipped at
 * each side of the window, which keeps the winding numbers inside the window. Most rings are buildings and the like,
 * which do not cross themselves and share only sides with others: their ears are cut off one by one. The remaining
 * rings overlap, have holes, or cross themselves. They are put into groups, and each group is a polygon of GLU's
 * tessellator, whose time grows with the number of edges that are side by side. All tests are exact, because
 * coordinates are whole units. */
#define _GNU_SOURCE /* RTLD_NODELETE: GLU stays loaded for the next triangulator */

#include "map/triangulator.h"

#include <dlfcn.h>
#include <math.h>
#include <stdlib.h>

/* The number of directions in which the extent of rings is measured. The edges of a ring with more points than
 * MOST_COMPARED are not compared with all others. */
enum { DIRECTIONS = 8, MOST_COMPARED = 256 };

typedef struct ring {
    size_t first, count;                       /* its points in corners */
    int32_t low[DIRECTIONS], high[DIRECTIONS]; /* by direction */
    int side;                                  /* 1: clockwise, -1: counter-clockwise; 0: it may cross itself */
    bool convex;
    uint32_t group; /* an earlier ring of the same group, or itself */
    uint32_t next;  /* number of the group's next ring, + 1; 0: none */
} ring;

/* GLU's constants. The callbacks are the variants that get the polygon's data. */
enum {
    GLU_VERTEX = 100107,
    GLU_ERROR = 100109,
    GLU_EDGE_FLAG = 100110,
    GLU_COMBINE = 100111,
    GLU_RULE = 100140,
    GLU_NONZERO = 100131
};

typedef void callback(void);
typedef struct glu {
    void *handle;
    void *(*create)(void);
    void (*destroy)(void *);
    void (*set_callback)(void *, unsigned, callback *);
    void (*set_property)(void *, unsigned, double);
    void (*set_normal)(void *, double, double, double);
    void (*begin_polygon)(void *, void *);
    void (*begin_contour)(void *);
    void (*put_vertex)(void *, double *, void *);
    void (*end_contour)(void *);
    void (*end_polygon)(void *);
} glu;

/* A remaining point of a ring whose ears are being cut, and its neighbours. */
typedef struct ear_point {
    uint32_t before, next;
    bool reflex; /* or on a straight line */
} ear_point;

/* The western side of a ring. */
typedef struct left_side {
    int32_t x;
    uint32_t ring;
} left_side;

struct camber_triangulator {
    camber_context *context;
    glu glu;
    void *tess;
    camber_corner *corners; /* of the rings, then of crossings */
    size_t corner_count, corner_capacity;
    ring *rings;
    size_t ring_count, ring_capacity;
    uint32_t *indices;
    size_t index_count, index_capacity;
    float *clipped[2]; /* pairs of px, relative to the centre */
    size_t clipped_capacity[2];
    left_side *sides; /* by ring, sorted */
    size_t side_capacity;
    uint32_t *numbers; /* by corner: its number among the corners that triangles use */
    size_t number_capacity;
    uint32_t *slots; /* hash table by position: number + 1; 0: free */
    size_t slot_capacity;
    ear_point *ears;
    size_t ear_capacity;
    bool failed; /* out of memory */
};

/* ---- GLU ---- */

static bool find(const glu *g, const char *name, void *function) {
    void *found = dlsym(g->handle, name);
    memcpy(function, &found, sizeof found);
    return found != NULL;
}

static bool load(glu *g) {
    g->handle = dlopen("libGLU.so.1", RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    return g->handle && find(g, "gluNewTess", &g->create) && find(g, "gluDeleteTess", &g->destroy) &&
           find(g, "gluTessCallback", &g->set_callback) && find(g, "gluTessProperty", &g->set_property) &&
           find(g, "gluTessNormal", &g->set_normal) && find(g, "gluTessBeginPolygon", &g->begin_polygon) &&
           find(g, "gluTessBeginContour", &g->begin_contour) && find(g, "gluTessVertex", &g->put_vertex) &&
           find(g, "gluTessEndContour", &g->end_contour) && find(g, "gluTessEndPolygon", &g->end_polygon);
}

bool camber_triangulator_is_available(void) {
    glu g = {0};
    const bool found = load(&g);
    if (g.handle)
        dlclose(g.handle);
    return found;
}

/* Adds a corner and returns its number. */
static size_t add_corner(camber_triangulator *t, int32_t x, int32_t y) {
    if (!camber_grow(t->context, &t->corners, &t->corner_capacity, t->corner_count + 1, sizeof *t->corners)) {
        t->failed = true;
        return 0;
    }
    t->corners[t->corner_count] = (camber_corner){x, y};
    return t->corner_count++;
}

static void put_index(camber_triangulator *t, size_t corner) {
    if (!camber_grow(t->context, &t->indices, &t->index_capacity, t->index_count + 1, sizeof *t->indices)) {
        t->failed = true;
        return;
    }
    t->indices[t->index_count++] = (uint32_t)corner;
}

static void take_vertex(void *corner, void *user) {
    put_index(user, (size_t)(uintptr_t)corner);
}

/* Does nothing, but if this callback is set, GLU returns separate triangles instead of strips and fans. */
static void take_edge_flag(unsigned char flag, void *user) {
    (void)flag;
    (void)user;
}

/* Adds a corner where edges cross. */
static void take_crossing(double at[3], void *corners[4], float weights[4], void **made, void *user) {
    (void)corners;
    (void)weights;
    *made = (void *)(uintptr_t)add_corner(user, (int32_t)floor(at[0] + 0.5), (int32_t)floor(at[1] + 0.5));
}

/* GLU is out of memory. It can report nothing else for polygons that are begun and ended correctly. */
static void take_error(unsigned error, void *user) {
    (void)error;
    ((camber_triangulator *)user)->failed = true;
}

camber_status camber_triangulator_fail_missing(camber_context *context) {
    return camber_fail(
        context, CAMBER_ERROR_DEVICE,
        "mesh: areas need GLU (Debian: libglu1-mesa); install it, or choose a style with only lines with --style");
}

camber_status camber_triangulator_create(camber_context *context, camber_triangulator **triangulator) {
    camber_triangulator *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    if (!load(&made->glu) || !(made->tess = made->glu.create())) {
        const bool found = made->glu.end_polygon;
        camber_triangulator_destroy(made);
        return found ? CAMBER_ERROR_MEMORY : camber_triangulator_fail_missing(context);
    }
    made->glu.set_callback(made->tess, GLU_VERTEX, (callback *)take_vertex);
    made->glu.set_callback(made->tess, GLU_EDGE_FLAG, (callback *)take_edge_flag);
    made->glu.set_callback(made->tess, GLU_COMBINE, (callback *)take_crossing);
    made->glu.set_callback(made->tess, GLU_ERROR, (callback *)take_error);
    made->glu.set_property(made->tess, GLU_RULE, GLU_NONZERO);
    made->glu.set_normal(made->tess, 0.0, 0.0, -1.0); /* y points down, and outlines face up */
    *triangulator = made;
    return CAMBER_OK;
}

void camber_triangulator_destroy(camber_triangulator *triangulator) {
    if (!triangulator)
        return;
    if (triangulator->tess)
        triangulator->glu.destroy(triangulator->tess);
    if (triangulator->glu.handle)
        dlclose(triangulator->glu.handle);
    camber_free(triangulator->context, triangulator->corners);
    camber_free(triangulator->context, triangulator->rings);
    camber_free(triangulator->context, triangulator->indices);
    camber_free(triangulator->context, triangulator->clipped[0]);
    camber_free(triangulator->context, triangulator->clipped[1]);
    camber_free(triangulator->context, triangulator->sides);
    camber_free(triangulator->context, triangulator->numbers);
    camber_free(triangulator->context, triangulator->slots);
    camber_free(triangulator->context, triangulator->ears);
    camber_free(triangulator->context, triangulator);
}

/* ---- Clipping ---- */

/* Cuts a closed ring at one side of the window: the part beyond it is removed, and the ends are joined. axis: 0 for x,
 * 1 for y. */
static size_t clip_side(const float *from, size_t count, float *to, int axis, float side) {
    const float sign = side < 0.0f ? -1.0f : 1.0f, edge = fabsf(side);
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        const float *a = from + 2 * i, *b = from + 2 * (i + 1 < count ? i + 1 : 0);
        const float da = edge - sign * a[axis], db = edge - sign * b[axis];
        float *out = to + 2 * kept;
        if (da >= 0.0f) {
            out[0] = a[0];
            out[1] = a[1];
            out += 2;
            kept++;
        }
        if ((da < 0.0f) != (db < 0.0f)) {
            /* Interpolates from the inside out, so that neighbours are cut at exactly the same point. */
            const float *in = da >= 0.0f ? a : b, *beyond = da >= 0.0f ? b : a;
            const float share = fabsf(da >= 0.0f ? da : db) / (fabsf(da) + fabsf(db));
            out[axis] = side;
            out[1 - axis] = in[1 - axis] + (beyond[1 - axis] - in[1 - axis]) * share;
            kept++;
        }
    }
    return kept;
}

static bool want_clipped(camber_triangulator *t, size_t which, size_t count) {
    return camber_grow(t->context, &t->clipped[which], &t->clipped_capacity[which], count, 2 * sizeof **t->clipped);
}

/* Clips the ring in clipped[0] at the sides that it crosses, and returns which of the two buffers has the result. */
static size_t clip_ring(camber_triangulator *t, size_t *count, const camber_ring_window *window) {
    size_t at = 0;
    for (int i = 0; i < 4 && *count > 2; i++) {
        const int axis = i / 2;
        const float half = axis ? window->half_height : window->half_width, side = i % 2 ? -half : half;
        bool passes = false;
        for (size_t k = 0; k < *count; k++)
            passes |= (i % 2 ? -t->clipped[at][2 * k + (size_t)axis] : t->clipped[at][2 * k + (size_t)axis]) > half;
        if (!passes)
            continue;
        if (!want_clipped(t, 1 - at, 2 * *count + 2)) {
            t->failed = true;
            return at;
        }
        *count = clip_side(t->clipped[at], *count, t->clipped[1 - at], axis, side);
        at = 1 - at;
    }
    return at;
}

/* ---- Points ---- */

/* Returns twice the area of the triangle a, b, c. It is above 0 if they turn clockwise, with y pointing down. */
static int64_t turn(camber_corner a, camber_corner b, camber_corner c) {
    return (int64_t)(b.x - a.x) * (c.y - a.y) - (int64_t)(b.y - a.y) * (c.x - a.x);
}

/* Adds a point to the last ring. Removes previous points that are on a straight line with it, and spikes. */
static void add_point(camber_triangulator *t, ring *r, camber_corner p) {
    for (; r->count > 1; r->count--, t->corner_count--) {
        const camber_corner *last = t->corners + t->corner_count - 1;
        if (turn(last[-1], *last, p) != 0)
            break;
    }
    if (r->count == 1 && t->corners[r->first].x == p.x && t->corners[r->first].y == p.y)
        return;
    (void)add_corner(t, p.x, p.y);
    r->count++;
}

/* Does the same at the point where the ring closes. */
static void close_ring(camber_triangulator *t, ring *r) {
    size_t begin = r->first, end = r->first + r->count;
    const camber_corner *c = t->corners;
    while (end - begin > 2) {
        if (turn(c[end - 2], c[end - 1], c[begin]) == 0)
            end--;
        else if (turn(c[end - 1], c[begin], c[begin + 1]) == 0)
            begin++;
        else
            break;
    }
    r->first = begin;
    r->count = end - begin;
    t->corner_count = end;
}

/* Measures the ring in all directions, and finds out whether it is convex; if so, sets its side. */
static void measure(const camber_triangulator *t, ring *r) {
    const camber_corner *c = t->corners + r->first;
    bool left = false, right = false;
    int turns_back = 0;
    for (int k = 0; k < DIRECTIONS; k++) {
        r->low[k] = INT32_MAX;
        r->high[k] = INT32_MIN;
    }
    for (size_t i = 0; i < r->count; i++) {
        const camber_corner a = c[i ? i - 1 : r->count - 1], b = c[i], d = c[i + 1 < r->count ? i + 1 : 0];
        const int32_t along[DIRECTIONS] = {b.x,           b.y,           b.x + b.y,     b.x - b.y,
                                           2 * b.x + b.y, 2 * b.x - b.y, b.x + 2 * b.y, b.x - 2 * b.y};
        for (int k = 0; k < DIRECTIONS; k++) {
            r->low[k] = along[k] < r->low[k] ? along[k] : r->low[k];
            r->high[k] = along[k] > r->high[k] ? along[k] : r->high[k];
        }
        const int64_t turned = turn(a, b, d);
        left |= turned < 0;
        right |= turned > 0;
        /* A horizontal side counts as running up if it runs west, otherwise as running down. */
        const bool up = b.y < a.y || (b.y == a.y && b.x < a.x), up_next = d.y < b.y || (d.y == b.y && d.x < b.x);
        turns_back += up != up_next;
    }
    r->convex = left != right && turns_back == 2;
    r->side = !r->convex ? 0 : right ? 1 : -1;
}

/* Prepares for the next fill, and returns the status. */
static camber_status forget(camber_triangulator *t, camber_status status) {
    t->ring_count = t->corner_count = 0;
    t->failed = false;
    return status;
}

camber_status camber_triangulator_add(camber_triangulator *t, const float *points, size_t count,
                                      const camber_ring_window *window) {
    ring made = {.first = t->corner_count};
    size_t left = count ? count - 1 : 0; /* the last point repeats the first */
    if (!want_clipped(t, 0, count + 1))
        return forget(t, CAMBER_ERROR_MEMORY);
    for (size_t i = 0; i < left; i++) {
        t->clipped[0][2 * i] = points[2 * i] - (float)window->centre_x;
        t->clipped[0][2 * i + 1] = points[2 * i + 1] - (float)window->centre_y;
    }
    const float *at = t->clipped[clip_ring(t, &left, window)];
    for (size_t i = 0; i < left && left > 2 && !t->failed; i++)
        add_point(t, &made,
                  (camber_corner){(int32_t)floor((double)at[2 * i] * window->units + 0.5),
                                  (int32_t)floor((double)at[2 * i + 1] * window->units + 0.5)});
    if (t->failed)
        return forget(t, CAMBER_ERROR_MEMORY);
    close_ring(t, &made);
    if (made.count < 3) {
        t->corner_count = made.first;
        return CAMBER_OK;
    }
    if (!camber_grow(t->context, &t->rings, &t->ring_capacity, t->ring_count + 1, sizeof *t->rings))
        return forget(t, CAMBER_ERROR_MEMORY);
    measure(t, &made);
    made.group = (uint32_t)t->ring_count;
    t->rings[t->ring_count++] = made;
    return CAMBER_OK;
}

/* ---- Rings that cross nothing ---- */

static camber_corner point_of(const camber_triangulator *t, const ring *r, size_t i) {
    return t->corners[r->first + (i < r->count ? i : i - r->count)];
}

static int sign_of(int64_t value) {
    return (value > 0) - (value < 0);
}

/* Whether the boxes of two segments do not touch. */
static bool are_apart(camber_corner a, camber_corner b, camber_corner c, camber_corner d) {
    return (a.x < c.x && a.x < d.x && b.x < c.x && b.x < d.x) || (a.x > c.x && a.x > d.x && b.x > c.x && b.x > d.x) ||
           (a.y < c.y && a.y < d.y && b.y < c.y && b.y < d.y) || (a.y > c.y && a.y > d.y && b.y > c.y && b.y > d.y);
}

/* Sets the side of a ring if it does not touch itself. */
static void find_side(const camber_triangulator *t, ring *r) {
    int64_t area = 0;
    if (r->side || r->count > MOST_COMPARED)
        return;
    const camber_corner start = point_of(t, r, 0);
    for (size_t i = 0; i < r->count; i++) {
        const camber_corner a = point_of(t, r, i), b = point_of(t, r, i + 1);
        area += turn(start, a, b);
        for (size_t k = i + 2; k < r->count; k++) {
            const camber_corner c = point_of(t, r, k), d = point_of(t, r, k + 1);
            if (are_apart(a, b, c, d) || (i == 0 && k + 1 == r->count))
                continue;
            if (sign_of(turn(a, b, c)) * sign_of(turn(a, b, d)) <= 0 &&
                sign_of(turn(c, d, a)) * sign_of(turn(c, d, b)) <= 0)
                return;
        }
    }
    r->side = sign_of(area);
}

/* ---- Rings next to each other ---- */

/* Returns point i of a ring that does not touch itself, in the order in which its inside is where turns are above 0. i
 * may go around up to twice. */
static camber_corner ordered_point(const camber_triangulator *t, const ring *r, size_t i) {
    const size_t k = i < r->count ? i : i - r->count;
    return t->corners[r->first + (r->side > 0 ? k : r->count - 1 - k)];
}

/* A corner of such a ring. */
typedef struct sector {
    camber_corner from, at, to;
} sector;

static sector sector_of(const camber_triangulator *t, const ring *r, size_t i) {
    return (sector){ordered_point(t, r, i + r->count - 1), ordered_point(t, r, i), ordered_point(t, r, i + 1)};
}

/* Whether the line from the corner to p begins inside the ring. */
static bool leads_in(sector s, camber_corner p) {
    const bool one = turn(s.from, s.at, p) > 0, other = turn(s.at, s.to, p) > 0;
    return turn(s.from, s.at, s.to) > 0 ? one && other : one || other;
}

/* Whether two corners at the same position have part of their insides in common. */
static bool sectors_meet(sector a, sector b) {
    const int64_t ahead =
        (int64_t)(a.to.x - a.at.x) * (b.to.x - b.at.x) + (int64_t)(a.to.y - a.at.y) * (b.to.y - b.at.y);
    return leads_in(a, b.from) || leads_in(a, b.to) || leads_in(b, a.from) || leads_in(b, a.to) ||
           (turn(a.at, a.to, b.to) == 0 && ahead > 0);
}

/* Whether the inside at a corner and the inside of the edge from a to b, on which the corner is, have a common part. */
static bool reaches_past(sector s, camber_corner a, camber_corner b) {
    return turn(s.from, s.at, s.to) < 0 || turn(a, b, s.from) > 0 || turn(a, b, s.to) > 0;
}

/* Whether p is between a and b, if all three are on a line. */
static bool is_between(camber_corner a, camber_corner b, camber_corner p) {
    return a.x != b.x ? (p.x > a.x && p.x < b.x) || (p.x < a.x && p.x > b.x)
                      : (p.y > a.y && p.y < b.y) || (p.y < a.y && p.y > b.y);
}

/* How two rings, or two of their edges, meet: apart; touching, without a common inside; or possibly with a common
 * inside. */
typedef enum meeting { APART, TOUCHING, MEETING } meeting;

static meeting meeting_of_edges(const camber_triangulator *t, const ring *one, size_t i, const ring *other, size_t k) {
    const camber_corner a = ordered_point(t, one, i), b = ordered_point(t, one, i + 1), c = ordered_point(t, other, k),
                        d = ordered_point(t, other, k + 1);
    if (are_apart(a, b, c, d))
        return APART;
    const int64_t abc = turn(a, b, c), cda = turn(c, d, a);
    if (sign_of(abc) * sign_of(turn(a, b, d)) < 0 && sign_of(cda) * sign_of(turn(c, d, b)) < 0)
        return MEETING;
    if (a.x == c.x && a.y == c.y)
        return sectors_meet(sector_of(t, one, i), sector_of(t, other, k)) ? MEETING : TOUCHING;
    if (abc == 0 && is_between(a, b, c))
        return reaches_past(sector_of(t, other, k), a, b) ? MEETING : TOUCHING;
    if (cda == 0 && is_between(c, d, a))
        return reaches_past(sector_of(t, one, i), c, d) ? MEETING : TOUCHING;
    return APART;
}

/* Whether p is inside the ring. p must not be on an edge. */
static bool is_inside(const camber_triangulator *t, const ring *r, camber_corner p) {
    bool inside = false;
    for (size_t i = 0; i < r->count; i++) {
        const camber_corner a = point_of(t, r, i), b = point_of(t, r, i + 1);
        if ((a.y <= p.y) != (b.y <= p.y))
            inside ^= (turn(a, b, p) > 0) == (b.y > a.y);
    }
    return inside;
}

static bool boxes_meet(const ring *one, const ring *other) {
    for (int k = 1; k < DIRECTIONS; k++) /* skips the first direction, by which they are sorted */
        if (one->low[k] > other->high[k] || other->low[k] > one->high[k])
            return false;
    return true;
}

/* Whether two rings have to be filled together. */
static bool rings_meet(const camber_triangulator *t, const ring *one, const ring *other) {
    bool touch = false;
    if (!boxes_meet(one, other))
        return false;
    if (!one->side || !other->side || one->count * other->count > MOST_COMPARED * MOST_COMPARED / 4)
        return true;
    for (size_t i = 0; i < one->count; i++) {
        const camber_corner a = ordered_point(t, one, i), b = ordered_point(t, one, i + 1);
        if ((a.x < other->low[0] && b.x < other->low[0]) || (a.x > other->high[0] && b.x > other->high[0]) ||
            (a.y < other->low[1] && b.y < other->low[1]) || (a.y > other->high[1] && b.y > other->high[1]))
            continue;
        for (size_t k = 0; k < other->count; k++) {
            const meeting found = meeting_of_edges(t, one, i, other, k);
            if (found == MEETING)
                return true;
            touch |= found == TOUCHING;
        }
    }
    return !touch && (is_inside(t, one, point_of(t, other, 0)) || is_inside(t, other, point_of(t, one, 0)));
}

/* ---- Groups ---- */

static uint32_t group_of(ring *rings, uint32_t i) {
    while (rings[i].group != i)
        i = rings[i].group = rings[rings[i].group].group;
    return i;
}

/* Compares left sides and, if these are equal, the order in which the rings were added. */
static int compare_sides(const void *a, const void *b) {
    const left_side *one = a, *other = b;
    return one->x != other->x ? (one->x > other->x) - (one->x < other->x)
                              : (one->ring > other->ring) - (one->ring < other->ring);
}

/* Puts rings that have to be filled together into one group. */
static void find_groups(camber_triangulator *t) {
    ring *rings = t->rings;
    for (size_t i = 0; i < t->ring_count; i++)
        t->sides[i] = (left_side){rings[i].low[0], (uint32_t)i};
    qsort(t->sides, t->ring_count, sizeof *t->sides, compare_sides);
    for (size_t n = 0; n < t->ring_count; n++) {
        const uint32_t i = t->sides[n].ring;
        for (size_t m = n + 1; m < t->ring_count && t->sides[m].x <= rings[i].high[0]; m++) {
            const uint32_t k = t->sides[m].ring, one = group_of(rings, i), other = group_of(rings, k);
            if (one != other && rings_meet(t, rings + i, rings + k))
                rings[one > other ? one : other].group = one < other ? one : other;
        }
    }
    for (size_t i = t->ring_count; i-- > 0;) {
        const uint32_t head = group_of(rings, (uint32_t)i);
        if (head == i)
            continue;
        rings[i].next = rings[head].next;
        rings[head].next = (uint32_t)i + 1;
    }
}

/* ---- Triangles ---- */

/* Adds a triangle with reversed winding, like GLU's. */
static void put_triangle(camber_triangulator *t, size_t a, size_t b, size_t c) {
    if (!camber_grow(t->context, &t->indices, &t->index_capacity, t->index_count + 3, sizeof *t->indices)) {
        t->failed = true;
        return;
    }
    t->indices[t->index_count++] = (uint32_t)a;
    t->indices[t->index_count++] = (uint32_t)c;
    t->indices[t->index_count++] = (uint32_t)b;
}

/* Returns the corner of ordered point i of a ring. */
static size_t ordered_corner(const ring *r, size_t i) {
    return r->first + (r->side > 0 ? i : r->count - 1 - i);
}

/* Whether a corner can be cut off: it must not be reflex, and no remaining point may be in its triangle. It is enough
 * to test reflex and flat points: if any other point is in the triangle, so is one of these. */
static bool is_ear(const camber_triangulator *t, const ring *r, size_t i) {
    const ear_point *ears = t->ears;
    const camber_corner a = ordered_point(t, r, ears[i].before), b = ordered_point(t, r, i),
                        c = ordered_point(t, r, ears[i].next);
    if (ears[i].reflex)
        return false;
    for (size_t k = ears[ears[i].next].next; k != ears[i].before; k = ears[k].next) {
        if (!ears[k].reflex)
            continue;
        const camber_corner p = ordered_point(t, r, k);
        if (turn(c, a, p) >= 0 && turn(a, b, p) >= 0 && turn(b, c, p) >= 0)
            return false;
    }
    return true;
}

static bool is_reflex(const camber_triangulator *t, const ring *r, size_t i) {
    return turn(ordered_point(t, r, t->ears[i].before), ordered_point(t, r, i), ordered_point(t, r, t->ears[i].next)) <=
           0;
}

/* Cuts a ring that does not touch itself into triangles, ear by ear. There is always an ear. */
static void cut_ears(camber_triangulator *t, const ring *r) {
    ear_point *ears = t->ears;
    for (size_t i = 0; i < r->count; i++) {
        ears[i].before = (uint32_t)(i ? i - 1 : r->count - 1);
        ears[i].next = (uint32_t)(i + 1 < r->count ? i + 1 : 0);
    }
    for (size_t i = 0; i < r->count; i++)
        ears[i].reflex = is_reflex(t, r, i);
    size_t i = 0;
    for (size_t left = r->count, tried = 0; left > 2 && tried < left;) {
        const size_t before = ears[i].before, next = ears[i].next;
        if (!is_ear(t, r, i)) {
            i = next;
            tried++;
            continue;
        }
        put_triangle(t, ordered_corner(r, before), ordered_corner(r, i), ordered_corner(r, next));
        ears[before].next = (uint32_t)next;
        ears[next].before = (uint32_t)before;
        ears[before].reflex = is_reflex(t, r, before);
        ears[next].reflex = is_reflex(t, r, next);
        left--;
        tried = 0;
        i = ears[next].next; /* not the neighbour, because triangles would become thin */
    }
}

static void cut_convex(camber_triangulator *t, const ring *r) {
    for (size_t i = 2; i < r->count; i++)
        put_triangle(t, ordered_corner(r, 0), ordered_corner(r, i - 1), ordered_corner(r, i));
}

/* Fills a group with GLU. */
static void fill_group(camber_triangulator *t, const ring *head) {
    const size_t before = t->index_count;
    t->glu.begin_polygon(t->tess, t);
    for (const ring *r = head; r && !t->failed; r = r->next ? t->rings + r->next - 1 : NULL) {
        t->glu.begin_contour(t->tess);
        for (size_t i = 0; i < r->count; i++) {
            const camber_corner *c = t->corners + r->first + i;
            double at[3] = {c->x, c->y, 0.0};
            t->glu.put_vertex(t->tess, at, (void *)(uintptr_t)(r->first + i));
        }
        t->glu.end_contour(t->tess);
    }
    t->glu.end_polygon(t->tess);
    t->index_count -= (t->index_count - before) % 3; /* drops a partial triangle if memory ran out */
}

/* Finds the number of a corner, or gives it the next one. The hash table has at least twice as many slots as corners.
 */
static uint32_t number_corner(camber_triangulator *t, camber_corner c, size_t slots, uint32_t *used) {
    size_t at = (size_t)camber_mix(0, (uint64_t)(uint32_t)c.x << 32 | (uint32_t)c.y) & (slots - 1);
    for (; t->slots[at]; at = (at + 1) & (slots - 1))
        if (t->corners[t->slots[at] - 1].x == c.x && t->corners[t->slots[at] - 1].y == c.y)
            return t->slots[at] - 1;
    t->corners[*used] = c;
    t->slots[at] = ++*used;
    return *used - 1;
}

/* Drops corners that no triangle uses, merges those at the same position, and drops triangles that become degenerate.
 */
static camber_status merge_corners(camber_triangulator *t) {
    uint32_t used = 0;
    size_t slots = 16;
    while (slots / 2 < t->corner_count)
        slots *= 2;
    if (!camber_grow(t->context, &t->numbers, &t->number_capacity, t->corner_count, sizeof *t->numbers) ||
        !camber_grow(t->context, &t->slots, &t->slot_capacity, slots, sizeof *t->slots))
        return CAMBER_ERROR_MEMORY;
    memset(t->numbers, 0, t->corner_count * sizeof *t->numbers);
    memset(t->slots, 0, slots * sizeof *t->slots);
    for (size_t i = 0; i < t->index_count; i++)
        t->numbers[t->indices[i]] = 1;
    for (size_t i = 0; i < t->corner_count; i++)
        if (t->numbers[i])
            t->numbers[i] = number_corner(t, t->corners[i], slots, &used);
    size_t kept = 0;
    for (size_t i = 0; i < t->index_count; i += 3) {
        const uint32_t a = t->numbers[t->indices[i]], b = t->numbers[t->indices[i + 1]],
                       c = t->numbers[t->indices[i + 2]];
        if (a == b || b == c || c == a)
            continue;
        t->indices[kept++] = a;
        t->indices[kept++] = b;
        t->indices[kept++] = c;
    }
    t->index_count = kept;
    t->corner_count = used;
    return CAMBER_OK;
}

camber_status camber_triangulator_fill(camber_triangulator *t, camber_triangles *triangles) {
    camber_status status = CAMBER_OK;
    t->index_count = 0;
    *triangles = (camber_triangles){0};
    if (t->ring_count == 0)
        return forget(t, status);
    if (!camber_grow(t->context, &t->sides, &t->side_capacity, t->ring_count, sizeof *t->sides) ||
        !camber_grow(t->context, &t->ears, &t->ear_capacity, MOST_COMPARED, sizeof *t->ears))
        status = CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < t->ring_count; i++)
        find_side(t, t->rings + i);
    if (status == CAMBER_OK)
        find_groups(t);
    for (size_t i = 0; i < t->ring_count && status == CAMBER_OK; i++) {
        const ring *r = t->rings + i;
        if (r->group != i)
            continue;
        if (r->next || !r->side)
            fill_group(t, r);
        else if (r->convex)
            cut_convex(t, r);
        else
            cut_ears(t, r);
        if (t->failed)
            status = CAMBER_ERROR_MEMORY;
    }
    if (status == CAMBER_OK)
        status = merge_corners(t);
    *triangles = (camber_triangles){t->corners, t->corner_count, t->indices, t->index_count};
    return forget(t, status);
}
