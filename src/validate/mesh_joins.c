/* Consecutive triangles with the same segment form that segment. If one segment ends where the next one begins, there
 * is a join between them. The room of a join is computed from lengths and angles in double precision. */
#include "validate/mesh_joins.h"

#include <math.h>
#include <stdlib.h>

/* A join with a larger tangent is split. */
static const double TAN_SPLIT = 2.0;
/* This close to the bound, a mesh in single precision may decide either way. */
static const double AT_BOUND = 1e-5;

/* A triangle, by the positions of its indices. */
typedef struct triangle {
    uint64_t first_index, end_index;
    uint32_t least, most; /* vertices */
    const camber_vertex *segment;
} triangle;

/* Consecutive triangles with the same segment. */
typedef struct drawn_segment {
    uint64_t first_index, end_index;
    uint32_t least; /* first vertex of its first triangle */
    uint32_t most;  /* last vertex of all its triangles */
    const camber_vertex *segment;
} drawn_segment;

/* Iterates over the triangles of a mesh in index order. */
typedef struct walk {
    const camber_mesh_data *mesh;
    uint64_t next; /* index */
} walk;

static triangle make_triangle(const camber_mesh_data *mesh, uint64_t first) {
    const uint32_t *i = mesh->indices + first;
    triangle t = {first, first + 3, i[0], i[0], mesh->vertices + i[2]};
    for (int k = 1; k < 3; k++) {
        t.least = i[k] < t.least ? i[k] : t.least;
        t.most = i[k] > t.most ? i[k] : t.most;
    }
    return t;
}

static bool next_triangle(walk *w, triangle *t) {
    const camber_mesh_data *mesh = w->mesh;
    const uint64_t step = mesh->info.strips ? 1 : 3;
    for (; w->next + 3 <= mesh->info.index_count; w->next += step) {
        const uint32_t *i = mesh->indices + w->next;
        if (!camber_mesh_data_draws(mesh, w->next) || i[0] == i[1] || i[1] == i[2] || i[0] == i[2])
            continue;
        *t = make_triangle(mesh, w->next);
        w->next += step;
        return true;
    }
    return false;
}

/* ---- Segments ---- */

typedef struct point {
    double x, y;
} point;

static point start_of(const camber_vertex *v) {
    const bool at_end = v->flags >> 6 & 1;
    return at_end ? (point){(double)v->x - (double)v->dx, (double)v->y - (double)v->dy}
                  : (point){(double)v->x, (double)v->y};
}

static point end_of(const camber_vertex *v) {
    const point a = start_of(v);
    return (point){a.x + (double)v->dx, a.y + (double)v->dy};
}

static double length_of(const camber_vertex *v) {
    return hypot((double)v->dx, (double)v->dy);
}

/* Whether two points are equal, apart from errors of single precision. */
static bool is_near(point a, point b, double length) {
    return hypot(a.x - b.x, a.y - b.y) <= 0.25 * length;
}

static bool same_segment(const camber_vertex *v, const camber_vertex *w) {
    return v == w ||
           (v->dx == w->dx && v->dy == w->dy && v->row == w->row && is_near(end_of(v), end_of(w), length_of(v)));
}

/* Whether a drawn segment repeats the first segment of its polyline, which begins with a join: the seam of a ring. */
static bool is_again(const camber_vertex *first, const camber_vertex *v) {
    return first->turn_a != 0 && first->turn_a == v->turn_a && same_segment(first, v);
}

/* Computes turn and room of the join between two segments. */
static void judge(camber_found_join *join, const camber_vertex *in, const camber_vertex *out,
                  const camber_stroke *stroke) {
    const double dx = (double)in->dx, dy = (double)in->dy, ex = (double)out->dx, ey = (double)out->dy;
    const double cross = dx * ey - dy * ex, turn = atan2(fabs(cross), dx * ex + dy * ey);
    const double limit = stroke->miter_limit > 0 ? (double)stroke->miter_limit : 2;
    const bool sharp = stroke->join == CAMBER_JOIN_MITER ||
                       (stroke->join == CAMBER_JOIN_ROUND && (double)stroke->round_limit * cos(turn / 2) > 1);
    const bool miter = sharp && cross != 0 && cos(turn / 2) * limit >= 1;
    const double reach = (double)stroke->width_px / 2 + (double)CAMBER_PAD_PX;
    const double half_shorter = fmin(length_of(in), length_of(out)) / 2;
    const bool tight = reach * tan(turn / 2) > half_shorter * (1 - AT_BOUND);
    join->turn_deg = turn * 57.29577951308232;
    join->room = tan(turn / 2) > TAN_SPLIT && !miter ? CAMBER_JOIN_SPLIT
                 : tight                             ? CAMBER_JOIN_TIGHT
                                                     : CAMBER_JOIN_PLAIN;
}

/* Whether the second drawn segment continues where the first ends. Within a polyline, consecutive drawn segments share
 * vertices, except where a strip is split and continues from the same point. */
static bool is_next(const drawn_segment *a, const drawn_segment *b, camber_join_room room) {
    const camber_vertex *in = a->segment, *out = b->segment;
    const double shorter = fmin(length_of(in), length_of(out));
    if (in->turn_b == 0 || in->turn_b != out->turn_a || !(shorter > 0))
        return false;
    return b->least <= a->most || (room == CAMBER_JOIN_SPLIT && is_near(end_of(in), start_of(out), shorter));
}

/* ---- The list ---- */

typedef struct search {
    const camber_mesh_data *mesh;
    const camber_stroke *strokes;
    camber_mesh_joins found;
    size_t capacity;
    drawn_segment before, now;
    const camber_vertex *first; /* the polyline's first segment */
    bool joined;                /* the previous drawn segment is not the polyline's first */
} search;

static bool append(search *s, const camber_found_join *join) {
    if (s->found.count == s->capacity) {
        const size_t wanted = s->capacity ? 2 * s->capacity : 1024;
        camber_found_join *grown = realloc(s->found.items, wanted * sizeof *grown);
        if (!grown)
            return false;
        s->found.items = grown;
        s->capacity = wanted;
    }
    s->found.items[s->found.count++] = *join;
    return true;
}

/* Adds the join between a complete drawn segment and the one before it. */
static bool end_segment(search *s) {
    camber_found_join join = {0};
    bool joined = false;
    if (s->before.segment) {
        judge(&join, s->before.segment, s->now.segment, s->strokes + s->now.segment->row);
        joined = is_next(&s->before, &s->now, join.room);
    }
    if (joined) {
        const point at = end_of(s->before.segment);
        join.range = (camber_index_range){s->before.first_index, s->now.end_index - s->before.first_index};
        join.x = (float)at.x;
        join.y = (float)at.y;
        join.row = s->now.segment->row;
        join.seam = !s->mesh->info.strips && is_again(s->first, s->now.segment);
        if (s->joined) /* the join before was not a seam, because the line continues */
            s->found.items[s->found.count - 1].seam = false;
        if (!append(s, &join))
            return false;
    } else {
        s->first = s->now.segment;
    }
    s->joined = joined;
    s->before = s->now;
    return true;
}

bool camber_mesh_joins_find(const camber_mesh_data *mesh, const camber_stroke *strokes, camber_mesh_joins *joins) {
    search s = {.mesh = mesh, .strokes = strokes};
    walk w = {mesh, 0};
    triangle t;
    for (bool more = true; more;) {
        more = next_triangle(&w, &t);
        if (more && s.now.segment && t.least <= s.now.most && same_segment(s.now.segment, t.segment)) {
            s.now.end_index = t.end_index;
            s.now.most = t.most > s.now.most ? t.most : s.now.most;
            continue;
        }
        if (s.now.segment && !end_segment(&s)) {
            camber_mesh_joins_free(&s.found);
            return false;
        }
        if (more)
            s.now = (drawn_segment){t.first_index, t.end_index, t.least, t.most, t.segment};
    }
    *joins = s.found;
    return true;
}

void camber_mesh_joins_free(camber_mesh_joins *joins) {
    free(joins->items);
    *joins = (camber_mesh_joins){0};
}

const char *camber_join_room_name(camber_join_room room) {
    static const char *const names[] = {"plain", "tight", "split"};
    return (unsigned)room < CAMBER_JOIN_ROOMS ? names[room] : "unknown";
}
