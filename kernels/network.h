/* The frame's part of a network, the one place where it is decided which points of it become slots, and where they lie.
 *
 *     network   x[], y[], importance[]: every point, rings with their first point again at the end
 *     runs      its polylines, with their boxes
 *     slots     what classify reads: the points that the camera sees at its tolerance, in px
 *
 * A chunk of points is walked by itself: each point puts its own slot, and the ends of the segment behind it where the
 * window cuts that. Points behind the chunk's end are looked at, and slots do not depend on how chunks are cut.
 *
 *     window  +-----------------------------+
 *             |   A1.....A2                 |      A1, A2, then a piece's end put by A2
 *             |            \                |
 *             +-------------e---------------+
 *                            A3        A5          A3 puts nothing, A4 a piece's begin
 *             +--------------------b---/----+
 *                               A4-'               (pictured: two sides of one window)
 */
#ifndef CAMBER_NETWORK_MATHS_H
#define CAMBER_NETWORK_MATHS_H

#include "layout.h"

/* Points a work-item walks. */
#define CAMBER_CHUNK 64
/* Of a run's word, whose row stands at CAMBER_POINT_ROW_SHIFT. */
#define CAMBER_RUN_RING CAMBER_POINT_RING

/* A polyline without invalid points. Behind the last run stands one that begins with the number of points. */
typedef struct camber_run {
    camber_u32 first; /* of its points */
    camber_u32 word;
    camber_i32 x0, y0, x1, y1; /* of its points */
} camber_run;

/* The camera, as the kernels need it. px = (x - origin_x) * across_x + (y - origin_y) * down_x + at_x. */
typedef struct camber_projection {
    camber_i32 origin_x, origin_y;
    float across_x, down_x, at_x;
    float across_y, down_y, at_y;
    float tolerance;                                  /* points of less importance are left out */
    float window_x0, window_y0, window_x1, window_y1; /* px: nothing lies outside it */
    camber_i32 seen_x0, seen_y0, seen_x1, seen_y1;    /* the box of that in the network's steps */
    camber_u32 first_point;                           /* where the arrays of points begin in the network */
    camber_u32 begin, end;                            /* the points to walk, counted from there */
} camber_projection;

/* What a walk reads and where it puts slots. */
typedef struct camber_walk {
    CAMBER_GLOBAL const camber_i32 *x, *y;
    CAMBER_GLOBAL const float *importance;
    CAMBER_GLOBAL float *slot_x, *slot_y;
    CAMBER_GLOBAL camber_u32 *slot_info;
    camber_u32 puts;             /* 0: slots are counted, 1: and put */
    camber_u32 at;               /* the next slot */
    camber_u32 first, end, word; /* of the run */
} camber_walk;

CAMBER_FN float camber_project_x(const camber_projection *p, camber_i32 x, camber_i32 y) {
    return (float)(x - p->origin_x) * p->across_x + (float)(y - p->origin_y) * p->down_x + p->at_x;
}

CAMBER_FN float camber_project_y(const camber_projection *p, camber_i32 x, camber_i32 y) {
    return (float)(x - p->origin_x) * p->across_y + (float)(y - p->origin_y) * p->down_y + p->at_y;
}

CAMBER_FN camber_u32 camber_is_inside(const camber_projection *p, float x, float y) {
    return x >= p->window_x0 && x <= p->window_x1 && y >= p->window_y0 && y <= p->window_y1;
}

CAMBER_FN camber_u32 camber_misses(const camber_projection *p, float ax, float ay, float bx, float by) {
    return (ax < p->window_x0 && bx < p->window_x0) || (ax > p->window_x1 && bx > p->window_x1) ||
           (ay < p->window_y0 && by < p->window_y0) || (ay > p->window_y1 && by > p->window_y1);
}

/* How far from a to b, 0 to 1, the first side of the window lies that b is beyond; 1 where it is beyond none. a is not
 * beyond any of these sides: no division by 0. */
CAMBER_FN float camber_part_within(const camber_projection *p, float ax, float ay, float bx, float by) {
    const float dx = bx - ax, dy = by - ay;
    const float side_x = bx > p->window_x1 ? p->window_x1 : p->window_x0;
    const float side_y = by > p->window_y1 ? p->window_y1 : p->window_y0;
    const float tx = bx > p->window_x1 || bx < p->window_x0 ? (side_x - ax) / dx : 1.0f;
    const float ty = by > p->window_y1 || by < p->window_y0 ? (side_y - ay) / dy : 1.0f;
    return tx < ty ? tx : ty;
}

CAMBER_FN void camber_put_slot(camber_walk *w, float x, float y, camber_u32 info) {
    if (w->puts) {
        w->slot_x[w->at] = x;
        w->slot_y[w->at] = y;
        w->slot_info[w->at] = info;
    }
    w->at++;
}

/* b, or where the way to it leaves the window. */
CAMBER_FN void camber_put_cut(camber_walk *w, const camber_projection *p, float ax, float ay, float bx, float by,
                              camber_u32 info) {
    const float t = camber_part_within(p, ax, ay, bx, by);
    const camber_u32 cut = !camber_is_inside(p, bx, by);
    camber_put_slot(w, cut ? ax + (bx - ax) * t : bx, cut ? ay + (by - ay) * t : by, info);
}

/* The point before from that is kept: its place, its pixel. The run's first point is always kept. */
CAMBER_FN camber_u32 camber_find_before(const camber_walk *w, const camber_projection *p, camber_u32 from, float *x,
                                        float *y) {
    camber_u32 i = from - 1;
    while (i > w->first && !(w->importance[i] >= p->tolerance))
        i--;
    *x = camber_project_x(p, w->x[i], w->y[i]);
    *y = camber_project_y(p, w->x[i], w->y[i]);
    return i;
}

/* The first point from a place on that is kept and does not lie on the pixel x, y. 0: there is none. */
CAMBER_FN camber_u32 camber_find_next(const camber_walk *w, const camber_projection *p, camber_u32 from, float x,
                                      float y, float *next_x, float *next_y) {
    for (camber_u32 i = from; i < w->end; i++) {
        if (!(w->importance[i] >= p->tolerance))
            continue;
        const float px = camber_project_x(p, w->x[i], w->y[i]), py = camber_project_y(p, w->x[i], w->y[i]);
        if (px != x || py != y) {
            *next_x = px;
            *next_y = py;
            return 1u;
        }
    }
    return 0u;
}

/* The ghost of a ring: its last other point before the first, its second behind the last. Cut like the segment that
 * it stands for, so that both ends of the ring see the same turn. */
CAMBER_FN void camber_put_ghost(camber_walk *w, const camber_projection *p, camber_u32 before, float x, float y) {
    float other_x = x, other_y = y;
    if (before) {
        camber_u32 i = w->end;
        while (i > w->first && other_x == x && other_y == y)
            i = camber_find_before(w, p, i, &other_x, &other_y);
    } else {
        camber_find_next(w, p, w->first, x, y, &other_x, &other_y);
    }
    camber_put_cut(w, p, x, y, other_x, other_y, 0u);
}

/* The slots that belong to a point: its own, a ring's ghost, and the ends of the segment to the next point. */
CAMBER_FN void camber_put_point(camber_walk *w, const camber_projection *p, camber_u32 i, float x, float y,
                                camber_u32 has_next, float next_x, float next_y) {
    const camber_u32 real = (w->word & ~0xffu) | CAMBER_POINT_REAL;
    const camber_u32 inside = camber_is_inside(p, x, y);
    if (inside) {
        const camber_u32 begins = i == w->first ? 1u : 0u;
        const camber_u32 seam = (w->word & CAMBER_RUN_RING) && begins == has_next ? CAMBER_POINT_RING : 0u;
        if (seam && begins)
            camber_put_ghost(w, p, 1u, x, y);
        camber_put_slot(w, x, y,
                        real | (begins ? CAMBER_POINT_FIRST : 0u) | (has_next ? 0u : CAMBER_POINT_LAST) | seam);
        if (seam && !begins)
            camber_put_ghost(w, p, 0u, x, y);
    }
    if (!has_next)
        return;
    const camber_u32 next_inside = camber_is_inside(p, next_x, next_y);
    if (inside && next_inside)
        return;
    if (!inside && !next_inside &&
        (camber_misses(p, x, y, next_x, next_y) ||
         !(camber_part_within(p, x, y, next_x, next_y) + camber_part_within(p, next_x, next_y, x, y) > 1.0f)))
        return;
    if (!inside)
        camber_put_cut(w, p, next_x, next_y, x, y, real | CAMBER_POINT_FIRST);
    if (!next_inside)
        camber_put_cut(w, p, x, y, next_x, next_y, real | CAMBER_POINT_LAST);
}

/* The points [begin, end) of the run. Of points that follow each other on one pixel the first counts. */
CAMBER_FN void camber_walk_run(camber_walk *w, const camber_projection *p, camber_u32 begin, camber_u32 end) {
    camber_u32 waits = 0, at = 0;
    float x = 0.0f, y = 0.0f;
    for (camber_u32 i = begin; i < end; i++) {
        if (!(w->importance[i] >= p->tolerance))
            continue;
        const float next_x = camber_project_x(p, w->x[i], w->y[i]), next_y = camber_project_y(p, w->x[i], w->y[i]);
        if (!waits && i > w->first)
            camber_find_before(w, p, i, &x, &y);
        if ((waits || i > w->first) && next_x == x && next_y == y)
            continue;
        if (waits)
            camber_put_point(w, p, at, x, y, 1u, next_x, next_y);
        waits = 1u;
        at = i;
        x = next_x;
        y = next_y;
    }
    if (!waits)
        return;
    float next_x = 0.0f, next_y = 0.0f;
    const camber_u32 has_next = camber_find_next(w, p, end, x, y, &next_x, &next_y);
    camber_put_point(w, p, at, x, y, has_next, next_x, next_y);
}

/* The points [begin, end), of which the first belongs to the run that is given. */
CAMBER_FN void camber_walk_chunk(camber_walk *w, const camber_projection *p, CAMBER_GLOBAL const camber_run *run,
                                 camber_u32 begin, camber_u32 end) {
    for (; run->first - p->first_point < end; run++) {
        if (run->x1 < p->seen_x0 || run->x0 > p->seen_x1 || run->y1 < p->seen_y0 || run->y0 > p->seen_y1)
            continue;
        w->first = run->first - p->first_point;
        w->end = run[1].first - p->first_point;
        w->word = run->word;
        camber_walk_run(w, p, w->first > begin ? w->first : begin, w->end < end ? w->end : end);
    }
}

/* The points of a chunk, which are counted from the start of the arrays, that are to be walked; end is not above begin
 * where there are none. */
CAMBER_FN void camber_chunk_bounds(const camber_projection *p, camber_u32 chunk, camber_u32 *begin, camber_u32 *end) {
    const camber_u32 first = chunk * CAMBER_CHUNK;
    *begin = first > p->begin ? first : p->begin;
    *end = p->end > first && p->end - first > CAMBER_CHUNK ? first + CAMBER_CHUNK : p->end;
}

#ifdef __OPENCL_VERSION__
typedef char camber_projection_is_80_bytes[sizeof(camber_projection) == 80 ? 1 : -1];
typedef char camber_run_is_24_bytes[sizeof(camber_run) == 24 ? 1 : -1];
#else
_Static_assert(sizeof(camber_projection) == 80, "the device reads a projection of 80 bytes");
_Static_assert(sizeof(camber_run) == 24, "the device reads runs of 24 bytes");
#endif

#endif
