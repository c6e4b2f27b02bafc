/* Culls a network for a frame: decides which of its points become slots, and where these are in the picture.
 *
 *     network   x[], y[], importance[]: every point; rings repeat their first point at the end
 *     stretches its polylines without invalid points, with their boxes
 *     slots     what classify reads: the points that the camera sees at its tolerance, in px
 *
 * Each chunk of points is walked separately: each point writes its own slot, and, if the window cuts the segment after
 * it, the ends of that segment. The walk also reads points past the chunk's end, so that slots do not depend on how
 * points are divided into chunks.
 *
 *     window  +-----------------------------+
 *             |   A1.....A2                 |      A1, A2, then an end at A3 that A2 writes
 *             |            \                |
 *             +-------------\---------------+
 *                            A3        A5          A3 writes nothing, A4 a beginning at A4
 *             +----------------------/------+
 *                               A4--'              (pictured: two sides of one window)
 *
 * So that a line has the same bits in each window, its segments stay whole. Only long ones are halved until they are
 * short enough for exact floats, in the network's steps, and so at the same points for every window. The window does
 * cut segments of networks with coarse steps, because they would bend where they are halved, and those that are seen
 * with a pitch, because what is behind the camera has no place in the picture. */
#ifndef CAMBER_KERNELS_CULL_H
#define CAMBER_KERNELS_CULL_H

#include "layout.h"

/* Points that a work-item walks, and work-items in a group. */
#define CAMBER_CULL_CHUNK 64
#define CAMBER_WALKERS (CAMBER_BLOCK / 8)
/* Longer segments are halved. Floats are exact to 1/4096 px up to 4096 px: so far reaches a piece that touches a window
 * of 2048 px and the margin around it. */
#define CAMBER_PIECE_PX 1536.0f
/* Segments are halved only if the network's steps are no longer than this. Those of maps have 1/4096 px. */
#define CAMBER_FINE_PX (1.0f / 2048.0f)
/* If segments are cut, points farther from the window than this are moved closer. */
#define CAMBER_NEAR_PX 4096.0f
#define CAMBER_NO_POINT 0xffffffffu
/* Whether a walk finds the arc length of each slot. The host's walk can do both. */
#if defined(CAMBER_DEVICE) && !CAMBER_HAS_ARC_LENGTH
#define CAMBER_WALK_ARC_LENGTHS 0
#else
#define CAMBER_WALK_ARC_LENGTHS 1
#endif
/* Whether the camera may have a pitch. On the host it always may. */
#ifndef CAMBER_PITCHED
#define CAMBER_PITCHED 0
#endif
#if defined(CAMBER_DEVICE) && !CAMBER_PITCHED
#define CAMBER_WALK_PITCHED 0
#else
#define CAMBER_WALK_PITCHED 1
#endif
/* Flags of a stretch's word, which also holds the row at CAMBER_POINT_ROW_SHIFT. An area is a ring that is filled. */
#define CAMBER_STRETCH_RING CAMBER_POINT_RING
#define CAMBER_STRETCH_AREA CAMBER_POINT_AREA

/* Consecutive points of a polyline, with no invalid point among them. A final stretch begins at the total number of
 * points. */
typedef struct camber_stretch {
    camber_u32 first; /* its first point; it ends where the next stretch begins */
    camber_u32 word;
    camber_i32 x0, y0, x1, y1; /* the box of its points */
} camber_stretch;

/* The camera, as the kernels need it. px = (x - origin_x) * across_x + (y - origin_y) * down_x + at_x. */
typedef struct camber_projection {
    camber_i32 origin_x, origin_y;
    float across_x, down_x, at_x;
    float across_y, down_y, at_y;
    float tolerance;                                  /* points of less importance are left out */
    float window_x0, window_y0, window_x1, window_y1; /* px: segments that touch it get slots */
    camber_i32 seen_x0, seen_y0, seen_x1, seen_y1;    /* stretches whose boxes do not touch it are not seen */
    camber_u32 first_point;                           /* where the arrays of points begin in the network */
    camber_u32 begin, end;                            /* the points to walk, counted from first_point */
    float step_px;
    /* For a camera with a pitch, the window is a trapezoid. Its sides come `slope` px closer per px down, to window_x0
     * and window_x1 at its bottom. Depth is 1 at middle_y, where `tolerance` holds, and falls by `fall` per px down. */
    float slope; /* 0: no pitch */
    float middle_y, fall, nearest, inverse_cosine;
} camber_projection;

/* A walk over points: the arrays that it reads, and where it writes slots. */
typedef struct camber_walk {
    CAMBER_GLOBAL const camber_i32 *x, *y;
    CAMBER_GLOBAL const float *importance;
    CAMBER_GLOBAL float *slot_x, *slot_y;
    CAMBER_GLOBAL camber_u32 *slot_info;
    camber_u32 puts;             /* 0: slots are only counted, 1: they are also written */
    camber_u32 at;               /* the next slot */
    camber_u32 first, end, word; /* first point, end and word of the stretch */
#if CAMBER_WALK_ARC_LENGTHS
    CAMBER_GLOBAL const float *lengths;    /* how far along its stretch each point is, in steps. NULL: no arc lengths */
    CAMBER_GLOBAL float *slot_arc_lengths; /* camber_arc_length of each slot */
    CAMBER_GLOBAL const float *totals;     /* for each stretch the length of its whole line, in steps */
    CAMBER_GLOBAL const camber_stretch *stretches;
    float total; /* length of the whole line of the stretch, in steps */
#endif
} camber_walk;

/* A point that is kept: its pixel, and which sides of the window it is beyond. */
typedef struct camber_kept_point {
    camber_u32 point; /* CAMBER_NO_POINT: there is none */
    camber_u32 beyond;
    float x, y;
#if CAMBER_WALK_ARC_LENGTHS
    float along; /* how far along its stretch it is, in steps */
#endif
} camber_kept_point;

CAMBER_FN float camber_project_x(const camber_projection *p, camber_i32 x, camber_i32 y) {
    return (float)(x - p->origin_x) * p->across_x + (float)(y - p->origin_y) * p->down_x + p->at_x;
}

CAMBER_FN float camber_project_y(const camber_projection *p, camber_i32 x, camber_i32 y) {
    return (float)(x - p->origin_x) * p->across_y + (float)(y - p->origin_y) * p->down_y + p->at_y;
}

/* Returns the sides of the window, grown by some px, that a pixel is beyond. A segment whose ends have a side in common
 * does not touch the window. */
CAMBER_FN camber_u32 camber_beyond(const camber_projection *p, float x, float y, float grown) {
#if CAMBER_WALK_PITCHED
    const float wider = p->slope * (p->window_y1 - y);
    if (p->slope > 0.0f)
        return (x < p->window_x0 - wider - grown ? 1u : 0u) | (x > p->window_x1 + wider + grown ? 2u : 0u) |
               (y < p->window_y0 - grown ? 4u : 0u) | (y > p->window_y1 + grown ? 8u : 0u);
#endif
    return (x < p->window_x0 - grown ? 1u : 0u) | (x > p->window_x1 + grown ? 2u : 0u) |
           (y < p->window_y0 - grown ? 4u : 0u) | (y > p->window_y1 + grown ? 8u : 0u);
}

CAMBER_FN camber_kept_point camber_kept_point_at(const camber_projection *p, camber_u32 point, camber_i32 x,
                                                 camber_i32 y) {
    camber_kept_point kept;
    kept.point = point;
    kept.x = camber_project_x(p, x, y);
    kept.y = camber_project_y(p, x, y);
    kept.beyond = camber_beyond(p, kept.x, kept.y, 0.0f);
    return kept;
}

CAMBER_FN camber_kept_point camber_kept_point_of(const camber_walk *w, const camber_projection *p, camber_u32 point) {
    camber_kept_point kept = camber_kept_point_at(p, point, w->x[point], w->y[point]);
#if CAMBER_WALK_ARC_LENGTHS
    kept.along = w->lengths ? w->lengths[point] : 0.0f;
#endif
    return kept;
}

#if CAMBER_WALK_ARC_LENGTHS
/* Returns how far along its stretch a point of the segment from a to b is, in steps. */
CAMBER_FN float camber_along_at(const camber_walk *w, camber_kept_point a, camber_kept_point b, camber_i32 x,
                                camber_i32 y) {
    const float dx = (float)(w->x[b.point] - w->x[a.point]), dy = (float)(w->y[b.point] - w->y[a.point]);
    const float t =
        CAMBER_FABS(dx) > CAMBER_FABS(dy) ? (float)(x - w->x[a.point]) / dx : (float)(y - w->y[a.point]) / dy;
    return a.along + (b.along - a.along) * t;
}
#endif

/* Whether two points in the window are on the same pixel; outside, where floats may be coarse, none count as such. */
CAMBER_FN camber_u32 camber_same_pixel(camber_kept_point a, camber_kept_point b) {
    return a.x == b.x && a.y == b.y && a.beyond == 0u ? 1u : 0u;
}

/* ---- Whole segments ---- */

/* Whether segments are cut at the window. They are, too, if steps are so coarse that a line would bend where it is
 * halved. */
CAMBER_FN camber_u32 camber_cuts(const camber_projection *p) {
    return p->slope > 0.0f || p->step_px > CAMBER_FINE_PX ? 1u : 0u;
}

/* Returns how often a segment is halved. */
CAMBER_FN camber_u32 camber_halvings(const camber_walk *w, const camber_projection *p, camber_kept_point a,
                                     camber_kept_point b) {
    const float dx = CAMBER_FABS((float)(w->x[b.point] - w->x[a.point])),
                dy = CAMBER_FABS((float)(w->y[b.point] - w->y[a.point]));
    float length = (dx > dy ? dx : dy) * p->step_px;
    camber_u32 count = 0;
    for (; length > CAMBER_PIECE_PX; count++)
        length *= 0.5f;
    return count;
}

/* Returns the i-th end of the pieces of a segment that is halved `count` times; from b to a they are the same. Those
 * that are not a or b have no point. */
CAMBER_FN camber_kept_point camber_piece_end(const camber_walk *w, const camber_projection *p, camber_kept_point a,
                                             camber_kept_point b, camber_u32 count, camber_u32 i) {
    if (i == 0u || i >> count)
        return i ? b : a;
    camber_u32 x0 = (camber_u32)w->x[a.point], y0 = (camber_u32)w->y[a.point];
    camber_u32 x1 = (camber_u32)w->x[b.point], y1 = (camber_u32)w->y[b.point];
    for (camber_u32 k = count; k-- > 0u;) {
        const camber_u32 x = (x0 + x1) / 2u, y = (y0 + y1) / 2u, later = i >> k & 1u;
        x0 = later ? x : x0;
        y0 = later ? y : y0;
        x1 = later ? x1 : x;
        y1 = later ? y1 : y;
    }
    camber_kept_point at = camber_kept_point_at(p, CAMBER_NO_POINT, (camber_i32)x0, (camber_i32)y0);
#if CAMBER_WALK_ARC_LENGTHS
    at.along = w->lengths ? camber_along_at(w, a, b, (camber_i32)x0, (camber_i32)y0) : 0.0f;
#endif
    return at;
}

/* Returns the end of the first piece from a point towards another one; `to` itself if that is no point. */
CAMBER_FN camber_kept_point camber_first_piece(const camber_walk *w, const camber_projection *p, camber_kept_point from,
                                               camber_kept_point to) {
    return to.point != CAMBER_NO_POINT ? camber_piece_end(w, p, from, to, camber_halvings(w, p, from, to), 1u) : to;
}

/* ---- Cut segments ---- */

/* Returns the end a of a segment to b. If a is so far out that its pixel is coarse, it returns a nearer point of the
 * segment, outside the window. It is found by halving, and exact to a step of the network. If the segment stays far
 * from the window, so does that point. */
CAMBER_FN camber_kept_point camber_pull(const camber_walk *w, const camber_projection *p, camber_kept_point a,
                                        camber_kept_point b) {
    camber_u32 out = camber_beyond(p, a.x, a.y, CAMBER_NEAR_PX);
    if (out == 0u)
        return a;
    camber_i32 x = w->x[a.point], y = w->y[a.point], to_x = w->x[b.point], to_y = w->y[b.point];
    camber_kept_point found = b;
    for (camber_u32 i = 0; i < 32u; i++) {
        const camber_i32 mid_x = x + (to_x - x) / 2, mid_y = y + (to_y - y) / 2;
        const camber_kept_point mid = camber_kept_point_at(p, a.point, mid_x, mid_y);
        const camber_u32 mid_out = camber_beyond(p, mid.x, mid.y, CAMBER_NEAR_PX);
        if (mid_out & out) {
            x = mid_x;
            y = mid_y;
            out = mid_out;
            continue;
        }
        to_x = mid_x;
        to_y = mid_y;
        found = mid;
#if CAMBER_WALK_ARC_LENGTHS
        found.along = camber_along_at(w, a, b, mid_x, mid_y);
#endif
        if (mid_out == 0u && (mid.beyond & a.beyond))
            break;
    }
    return found;
}

#if CAMBER_WALK_PITCHED
/* Returns where between a and b, 0 to 1, the segment crosses a side of the window. The arguments say how far inside the
 * side a and b are, in px; b's is below 0. */
CAMBER_FN float camber_share_to(float a_inside, float b_inside) {
    return a_inside / (a_inside - b_inside);
}

CAMBER_FN float camber_share_within_pitched(const camber_projection *p, camber_kept_point a, camber_kept_point b) {
    const float a_wider = p->slope * (p->window_y1 - a.y), b_wider = p->slope * (p->window_y1 - b.y);
    float t = 1.0f, part;
    if (b.beyond & 1u)
        t = camber_share_to(a.x - p->window_x0 + a_wider, b.x - p->window_x0 + b_wider);
    if (b.beyond & 2u) {
        part = camber_share_to(p->window_x1 - a.x + a_wider, p->window_x1 - b.x + b_wider);
        t = part < t ? part : t;
    }
    if (b.beyond & 4u) {
        part = camber_share_to(a.y - p->window_y0, b.y - p->window_y0);
        t = part < t ? part : t;
    }
    if (b.beyond & 8u) {
        part = camber_share_to(p->window_y1 - a.y, p->window_y1 - b.y);
        t = part < t ? part : t;
    }
    return t > 0.0f ? t : 0.0f;
}

/* Returns the tolerance at a point. A px of the picture there spans `depth` px of the plane from side to side, and more
 * from front to back, but less near the camera. */
CAMBER_FN float camber_tolerance_at(const camber_projection *p, camber_i32 x, camber_i32 y) {
    const float depth = 1.0f - p->fall * (camber_project_y(p, x, y) - p->middle_y);
    const float seen = depth > p->nearest ? depth : p->nearest;
    const float back = seen * seen * p->inverse_cosine;
    return p->tolerance * (back < seen ? back : seen);
}
#endif

/* Whether the camera keeps a point. A point that lines share has the same importance and position in each. */
CAMBER_FN camber_u32 camber_matters(const camber_walk *w, const camber_projection *p, camber_u32 i) {
#if CAMBER_WALK_PITCHED
    if (p->slope > 0.0f)
        return w->importance[i] >= camber_tolerance_at(p, w->x[i], w->y[i]) ? 1u : 0u;
#endif
    return w->importance[i] >= p->tolerance ? 1u : 0u;
}

/* Returns where between a and b, 0 to 1, the segment crosses the first side of the window that b is beyond; 1 if b is
 * beyond none. a is not beyond any of these sides, so there is no division by 0. */
CAMBER_FN float camber_share_within(const camber_projection *p, camber_kept_point a, camber_kept_point b) {
#if CAMBER_WALK_PITCHED
    if (p->slope > 0.0f)
        return camber_share_within_pitched(p, a, b);
#endif
    const float side_x = b.beyond & 2u ? p->window_x1 : p->window_x0;
    const float side_y = b.beyond & 8u ? p->window_y1 : p->window_y0;
    const float tx = b.beyond & 3u ? (side_x - a.x) / (b.x - a.x) : 1.0f;
    const float ty = b.beyond & 12u ? (side_y - a.y) / (b.y - a.y) : 1.0f;
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

#if CAMBER_WALK_ARC_LENGTHS
/* Writes the arc length of the last slot. */
CAMBER_FN void camber_walk_put_arc_length(const camber_walk *w, const camber_projection *p, float along) {
    if (w->puts && w->lengths) {
        w->slot_arc_lengths[2 * (w->at - 2u)] = along * p->step_px;
        w->slot_arc_lengths[2 * (w->at - 2u) + 1u] = w->total * p->step_px;
    }
}
#endif

/* Returns the info of a slot that is neither a line's first nor its last. */
CAMBER_FN camber_u32 camber_real_info(const camber_walk *w) {
    return (w->word & (CAMBER_ROW_BITS | CAMBER_STRETCH_AREA)) | CAMBER_POINT_REAL;
}

CAMBER_FN void camber_put_kept(camber_walk *w, const camber_projection *p, camber_kept_point at, camber_u32 info) {
    camber_put_slot(w, at.x, at.y, info);
#if CAMBER_WALK_ARC_LENGTHS
    camber_walk_put_arc_length(w, p, at.along);
#else
    CAMBER_UNUSED(p)
#endif
}

/* Writes a slot for b, or for the point where the segment from a to b leaves the window. */
CAMBER_FN void camber_put_cut(camber_walk *w, const camber_projection *p, camber_kept_point a, camber_kept_point b,
                              camber_u32 info) {
    const float t = camber_share_within(p, a, b);
    camber_put_slot(w, b.beyond ? a.x + (b.x - a.x) * t : b.x, b.beyond ? a.y + (b.y - a.y) * t : b.y, info);
#if CAMBER_WALK_ARC_LENGTHS
    camber_walk_put_arc_length(w, p, b.beyond ? a.along + (b.along - a.along) * t : b.along);
#endif
}

/* Returns the last kept point before `from`. A stretch's first point is always kept. */
CAMBER_FN camber_kept_point camber_find_before(const camber_walk *w, const camber_projection *p, camber_u32 from) {
    camber_u32 i = from - 1;
    while (i > w->first && !camber_matters(w, p, i))
        i--;
    return camber_kept_point_of(w, p, i);
}

/* Returns the kept point before `from` that the segment to it begins at: the first one on its pixel. */
CAMBER_FN camber_kept_point camber_find_start(const camber_walk *w, const camber_projection *p, camber_u32 from) {
    camber_kept_point start = camber_find_before(w, p, from);
    while (start.point > w->first && start.beyond == 0u) {
        const camber_kept_point before = camber_find_before(w, p, start.point);
        if (!camber_same_pixel(before, start))
            break;
        start = before;
    }
    return start;
}

/* Returns the first kept point from `from` on that is on another pixel; `other` itself if there is none. */
CAMBER_FN camber_kept_point camber_find_next(const camber_walk *w, const camber_projection *p, camber_u32 from,
                                             camber_kept_point other) {
    camber_kept_point next = other;
    for (camber_u32 i = from; i < w->end; i++) {
        if (!camber_matters(w, p, i))
            continue;
        next = camber_kept_point_of(w, p, i);
        if (!camber_same_pixel(next, other))
            return next;
    }
    next.point = CAMBER_NO_POINT;
    return next;
}

/* Writes the sentinel of a ring: before the first point the last different one, after the last point the second one. It
 * is halved or cut like the segment that it represents, so that both ends of the ring have the same turn. */
CAMBER_FN void camber_walk_put_sentinel(camber_walk *w, const camber_projection *p, camber_u32 before,
                                        camber_kept_point seam) {
    camber_kept_point other = seam;
    if (before) {
        other.point = w->end;
        while (other.point > w->first && camber_same_pixel(other, seam))
            other = camber_find_before(w, p, other.point);
    } else {
        other = camber_find_next(w, p, w->first, seam);
    }
    if (camber_cuts(p))
        camber_put_cut(w, p, seam, camber_pull(w, p, other, seam), 0u);
    else
        camber_put_kept(w, p, camber_first_piece(w, p, seam, other), 0u);
}

/* ---- Areas ---- */

/* Returns where the segment from `in` to `out` crosses the window's left side, which only `out` is beyond. The result
 * has the same bits that camber_put_cut computes if it cuts there. */
CAMBER_FN float camber_left_crossing(const camber_projection *p, camber_kept_point in, camber_kept_point out) {
#if CAMBER_WALK_PITCHED
    if (p->slope > 0.0f) {
        const float in_wider = p->slope * (p->window_y1 - in.y), out_wider = p->slope * (p->window_y1 - out.y);
        const float share = camber_share_to(in.x - p->window_x0 + in_wider, out.x - p->window_x0 + out_wider);
        return in.y + (out.y - in.y) * (share > 0.0f ? share : 0.0f);
    }
#endif
    return in.y + (out.y - in.y) * ((p->window_x0 - in.x) / (out.x - in.x));
}

CAMBER_FN void camber_put_left_slot(camber_walk *w, const camber_projection *p, camber_kept_point at, float y,
                                    camber_u32 info) {
    camber_put_slot(w, p->window_x0 - p->slope * (p->window_y1 - y), y, info | CAMBER_POINT_CUT);
#if CAMBER_WALK_ARC_LENGTHS
    camber_walk_put_arc_length(w, p, at.along);
#endif
}

/* Left of the window a polygon's segment still changes the winding number of points in the window. It is written as a
 * line along the window's left side, as high as its ends. Of a segment that is cut, the part left of the window is
 * written so, from where the segment crosses that side to the height of the segment's end:
 *
 *     A1----------+---A2           A1'---+
 *      \          | window          |    |     A1' is on the left side, as high as A1. Points of the ring left of
 *       A0        |                 A0'  |     the window change nothing else in it. */
CAMBER_FN void camber_put_left(camber_walk *w, const camber_projection *p, camber_kept_point a, camber_kept_point b) {
    const camber_u32 real = camber_real_info(w);
    float from = a.y, to = b.y;
    if (!(a.beyond & b.beyond & 1u)) {
        const camber_kept_point near_a = camber_pull(w, p, a, b), near_b = camber_pull(w, p, b, a);
        if (!((near_a.beyond | near_b.beyond) & 1u))
            return; /* it crosses the left side above or below the window */
        if (near_a.beyond & 1u)
            to = camber_left_crossing(p, near_b, near_a);
        else
            from = camber_left_crossing(p, near_a, near_b);
    }
    if (from == to || (from < p->window_y0 && to < p->window_y0) || (from > p->window_y1 && to > p->window_y1))
        return;
    camber_put_left_slot(w, p, a, from, real | CAMBER_POINT_FIRST);
    camber_put_left_slot(w, p, b, to, real | CAMBER_POINT_LAST);
}

/* ---- Points ---- */

/* The piece of a segment from a to b that begins at the given end. */
typedef struct camber_segment_piece {
    camber_kept_point a, b, from, to;
    camber_u32 halvings, at, end;
} camber_segment_piece;

/* Writes the point at which a line comes into the window. So that the joins at both ends of the piece are those of the
 * whole line, the point before it is written, too, unless the line begins here. If the piece before touches the window
 * as well, it has written this point; but a ring's seam divides the two. Areas have no joins. */
CAMBER_FN void camber_put_beginning(camber_walk *w, const camber_projection *p, const camber_segment_piece *piece) {
    const camber_u32 real = camber_real_info(w), is_ring = w->word & CAMBER_STRETCH_RING;
    const camber_u32 is_first = piece->at == 0u && piece->a.point == w->first;
    if (w->word & CAMBER_STRETCH_AREA) {
        camber_put_kept(w, p, piece->from, real | CAMBER_POINT_FIRST | CAMBER_POINT_CUT);
        return;
    }
    if (is_first && !is_ring) {
        camber_put_kept(w, p, piece->from, real | CAMBER_POINT_FIRST);
        return;
    }
    const camber_kept_point before =
        piece->at > 0u
            ? camber_piece_end(w, p, piece->a, piece->b, piece->halvings, piece->at - 1u)
            : camber_first_piece(w, p, piece->a, camber_find_start(w, p, is_first ? w->end - 1u : piece->a.point));
    if (before.beyond & piece->from.beyond) {
        camber_put_kept(w, p, before,
                        real | CAMBER_POINT_FIRST | (before.point != w->first || is_ring ? CAMBER_POINT_CUT : 0u));
        camber_put_kept(w, p, piece->from, real);
    } else if (is_first) {
        camber_put_kept(w, p, before, 0u);
        camber_put_kept(w, p, piece->from, real | CAMBER_POINT_FIRST | CAMBER_POINT_RING);
    }
}

/* Writes the point at which a line leaves the window, and in the same way the point after it. */
CAMBER_FN void camber_put_end(camber_walk *w, const camber_projection *p, const camber_segment_piece *piece) {
    const camber_u32 real = camber_real_info(w), is_ring = w->word & CAMBER_STRETCH_RING;
    const camber_u32 is_last = piece->at + 1u == piece->end && piece->b.point + 1u == w->end;
    if (w->word & CAMBER_STRETCH_AREA) {
        camber_put_kept(w, p, piece->to, real | CAMBER_POINT_LAST | CAMBER_POINT_CUT);
        return;
    }
    if (is_last && !is_ring) {
        camber_put_kept(w, p, piece->to, real | CAMBER_POINT_LAST);
        return;
    }
    const camber_kept_point after =
        piece->at + 1u < piece->end
            ? camber_piece_end(w, p, piece->a, piece->b, piece->halvings, piece->at + 2u)
            : camber_first_piece(w, p, piece->b,
                                 camber_find_next(w, p, (is_last ? w->first : piece->b.point) + 1u, piece->b));
    const camber_u32 is_end = after.beyond & piece->to.beyond, is_seam = !is_end && is_last;
    camber_put_kept(w, p, piece->to, real | (is_seam ? CAMBER_POINT_LAST | CAMBER_POINT_RING : 0u));
    if (is_end)
        camber_put_kept(w, p, after,
                        real | CAMBER_POINT_LAST | (after.point + 1u != w->end || is_ring ? CAMBER_POINT_CUT : 0u));
    else if (is_seam)
        camber_put_kept(w, p, after, 0u);
}

/* Writes the pieces of a segment that touch the window. Where several in a row do not, they are passed at once. */
CAMBER_FN void camber_put_pieces(camber_walk *w, const camber_projection *p, camber_kept_point a, camber_kept_point b) {
    camber_segment_piece piece = {a, b, a, b, 0, 0, 1};
    if (!(a.beyond & b.beyond))
        piece.halvings = camber_halvings(w, p, a, b);
    piece.end = 1u << piece.halvings;
    for (camber_u32 more = piece.end; piece.at < piece.end;) {
        piece.to = camber_piece_end(w, p, a, b, piece.halvings, piece.at + more);
        const camber_u32 outside = piece.from.beyond & piece.to.beyond;
        if (more > 1u && !outside) {
            more /= 2u;
            continue;
        }
        if (outside == 1u && (w->word & CAMBER_STRETCH_AREA))
            camber_put_left(w, p, piece.from, piece.to);
        if (!outside && piece.from.beyond)
            camber_put_beginning(w, p, &piece);
        if (!outside && piece.to.beyond)
            camber_put_end(w, p, &piece);
        else if (!outside && piece.at + 1u < piece.end)
            camber_put_kept(w, p, piece.to, camber_real_info(w));
        piece.from = piece.to;
        piece.at += more;
        more = piece.at & (0u - piece.at);
    }
}

/* Writes what the window has of a segment, cut at its sides. */
CAMBER_FN void camber_put_cut_segment(camber_walk *w, const camber_projection *p, camber_kept_point a,
                                      camber_kept_point b) {
    const camber_u32 real = camber_real_info(w);
    const camber_u32 is_left =
        (w->word & CAMBER_STRETCH_AREA) && ((a.beyond | b.beyond) & 1u) && !(a.beyond & b.beyond & 12u);
    if (is_left && a.beyond)
        camber_put_left(w, p, a, b);
    if ((a.beyond & b.beyond) || !(a.beyond | b.beyond))
        return;
    const camber_kept_point from = camber_pull(w, p, a, b), to = camber_pull(w, p, b, a);
    if (from.beyond && to.beyond &&
        ((from.beyond & to.beyond) || !(camber_share_within(p, from, to) + camber_share_within(p, to, from) > 1.0f)))
        return;
    if (a.beyond)
        camber_put_cut(w, p, to, from, real | CAMBER_POINT_FIRST | CAMBER_POINT_CUT);
    if (b.beyond)
        camber_put_cut(w, p, from, to, real | CAMBER_POINT_LAST | CAMBER_POINT_CUT);
    if (is_left && !a.beyond)
        camber_put_left(w, p, a, b);
}

/* Writes the slots that belong to a point: its own, a ring's sentinel, and those of the segment to the next point. */
CAMBER_FN void camber_put_point(camber_walk *w, const camber_projection *p, camber_kept_point a, camber_kept_point b) {
    const camber_u32 has_next = b.point != CAMBER_NO_POINT ? 1u : 0u;
    if (!a.beyond) {
        const camber_u32 begins = a.point == w->first ? 1u : 0u;
        const camber_u32 seam = (w->word & CAMBER_STRETCH_RING) && begins == has_next ? CAMBER_POINT_RING : 0u;
        if (seam && begins)
            camber_walk_put_sentinel(w, p, 1u, a);
        camber_put_kept(w, p, a,
                        camber_real_info(w) | (begins ? CAMBER_POINT_FIRST : 0u) | (has_next ? 0u : CAMBER_POINT_LAST) |
                            seam);
        if (seam && !begins)
            camber_walk_put_sentinel(w, p, 0u, a);
    }
    if (has_next && camber_cuts(p))
        camber_put_cut_segment(w, p, a, b);
    else if (has_next)
        camber_put_pieces(w, p, a, b);
}

/* Walks the points [begin, end) of the stretch, at most CAMBER_CULL_CHUNK. Of neighbours on the same pixel only the
 * first counts. It decides without a branch which points are kept, because no processor could predict it. */
CAMBER_FN void camber_walk_points(camber_walk *w, const camber_projection *p, camber_u32 begin, camber_u32 end) {
    camber_u32 kept[CAMBER_CULL_CHUNK];
    camber_u32 count = 0;
    for (camber_u32 i = begin; i < end; i++) {
        kept[count] = i;
        count += camber_matters(w, p, i) ? 1u : 0u;
    }
    if (count == 0u)
        return;
    camber_kept_point now = {0};
    now.point = CAMBER_NO_POINT;
    if (kept[0] > w->first)
        now = camber_find_before(w, p, kept[0]);
    camber_u32 waits = 0;
    for (camber_u32 i = 0; i < count; i++) {
        const camber_kept_point next = camber_kept_point_of(w, p, kept[i]);
        if (now.point != CAMBER_NO_POINT && camber_same_pixel(now, next))
            continue;
        if (waits)
            camber_put_point(w, p, now, next);
        waits = 1u;
        now = next;
    }
    if (waits)
        camber_put_point(w, p, now, camber_find_next(w, p, end, now));
}

/* Walks the points [begin, end) of the stretch. */
CAMBER_FN void camber_walk_stretch(camber_walk *w, const camber_projection *p, camber_u32 begin, camber_u32 end) {
    for (camber_u32 from = begin; from < end; from += CAMBER_CULL_CHUNK)
        camber_walk_points(w, p, from, end - from > CAMBER_CULL_CHUNK ? from + CAMBER_CULL_CHUNK : end);
}

/* Walks the points [begin, end), the first of which belongs to the given stretch. */
CAMBER_FN void camber_walk_chunk(camber_walk *w, const camber_projection *p,
                                 CAMBER_GLOBAL const camber_stretch *stretch, camber_u32 begin, camber_u32 end) {
    for (; stretch->first - p->first_point < end; stretch++) {
        if (stretch->x1 < p->seen_x0 || stretch->x0 > p->seen_x1 || stretch->y1 < p->seen_y0 ||
            stretch->y0 > p->seen_y1)
            continue;
        w->first = stretch->first - p->first_point;
        w->end = stretch[1].first - p->first_point;
        w->word = stretch->word;
#if CAMBER_WALK_ARC_LENGTHS
        w->total = w->lengths ? w->totals[stretch - w->stretches] : 0.0f;
#endif
        camber_walk_stretch(w, p, w->first > begin ? w->first : begin, w->end < end ? w->end : end);
    }
}

/* Computes the points of a chunk to walk, counted from the start of the arrays; there are none if end is not above
 * begin. */
CAMBER_FN void camber_chunk_bounds(const camber_projection *p, camber_u32 chunk, camber_u32 *begin, camber_u32 *end) {
    const camber_u32 first = chunk * CAMBER_CULL_CHUNK;
    *begin = first > p->begin ? first : p->begin;
    *end = p->end > first && p->end - first > CAMBER_CULL_CHUNK ? first + CAMBER_CULL_CHUNK : p->end;
}

#ifdef CAMBER_DEVICE
typedef char camber_projection_is_104_bytes[sizeof(camber_projection) == 104 ? 1 : -1];
typedef char camber_stretch_is_24_bytes[sizeof(camber_stretch) == 24 ? 1 : -1];
#else
_Static_assert(sizeof(camber_projection) == 104, "the device reads a projection of 104 bytes");
_Static_assert(sizeof(camber_stretch) == 24, "the device reads stretches of 24 bytes");
#endif

#endif
