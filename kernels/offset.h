/* Offset lines: computes the points of a line that runs beside another one, its source line.
 *
 *     offset segment   the segment from a slot to the next, moved sideways
 *     corner           where two of them meet: an arc about the point on the outer side, a crossing on the inner side
 *
 *         T0___T1                 outer: points on tangents, so that none is nearer than the offset;
 *         /       \               the first and the last are on the segments
 *        /    P----T2---- segment
 *       /    /                        seg ------J   P      inner: J, if both have room
 *      seg  /                                    \   \
 *
 * Parts without room are removed: what remains of a segment or an arc is at least the offset away from every part of
 * the source line within its reach, which is CAMBER_OFFSET_REACH offsets around the end of the segment. A segment of
 * the source line hides everything that is nearer to it than the offset, which is a capsule. Since a capsule is convex,
 * it hides one interval of an offset segment; the line before hides the beginning of the offset segment up to that
 * interval's end, the line after hides its end. The remaining parts are linked in the order of the line. So an offset
 * line has no more segments than its source line, and parts of the line beyond the reach do not count: a line that
 * crosses itself is drawn through the crossing. */
#ifndef CAMBER_KERNELS_OFFSET_H
#define CAMBER_KERNELS_OFFSET_H

#include "join.h"

/* Number of slots whose points a work-item counts and emits. */
#define CAMBER_OFFSET_CHUNK 16
/* How far around a segment's end the line is searched, in offsets, and how many of its segments at most. */
#define CAMBER_OFFSET_REACH 3.0f
#define CAMBER_OFFSET_SEGMENTS 128u
/* The most slots that are passed to find a ring's other end, if the search crosses its seam. */
#define CAMBER_OFFSET_SEAM 65536u
/* The most that an arc's points may be outside it, and the most points of an arc. */
#define CAMBER_OFFSET_ARC_TOLERANCE_PX 0.125f
#define CAMBER_OFFSET_ARC_POINTS_MAX 64u
/* The rest of a cut segment is kept only if it is longer than SHORTEST. Linked elements share one point if their ends
 * are closer than GAP. */
#define CAMBER_OFFSET_SEGMENT_SHORTEST_PX (1.0f / 1024.0f)
#define CAMBER_OFFSET_GAP_PX 0.25f
/* Cut segments may end this far from the point where they cross. */
#define CAMBER_OFFSET_SLACK_PX 1.0f
/* Marks an end of a segment that is not cut. */
#define CAMBER_OFFSET_SEGMENT_WHOLE 1.0e30f

/* The part of a row that an offset needs. */
typedef struct camber_offset_row {
    float offset_px; /* to the right, as seen with y down */
    float miter_limit;
    camber_u32 join; /* camber_join */
    camber_u32 spare;
} camber_offset_row;

/* The rest of the offset segment that begins at a slot, in px along it, and the rest of the arc at the slot. */
typedef struct camber_offset_clip {
    float from, to; /* nothing if to is not above from */
    camber_u32 arc; /* its first point | the one after its last << 8 | how many it would have in full << 16 */
} camber_offset_clip;

/* The source lines, as classify would read them, with their rows and arc lengths. */
typedef struct camber_source_line {
    CAMBER_GLOBAL const float *x, *y;
    CAMBER_GLOBAL const camber_u32 *info;
    CAMBER_GLOBAL const camber_offset_row *offset_rows;
    CAMBER_GLOBAL const camber_offset_clip *clips;
    CAMBER_GLOBAL const float *arc_lengths; /* camber_arc_length of each slot. NULL: no arc lengths */
    camber_u32 slots;
} camber_source_line;

/* ---- Slots along a line ---- */

/* Returns the other end of a ring, which is somewhere after its first slot or before its last; 0: not found. */
CAMBER_FN camber_u32 camber_seam_last(const camber_source_line *c, camber_u32 first, camber_u32 most) {
    const camber_u32 wanted = CAMBER_POINT_LAST | CAMBER_POINT_RING;
    const camber_u32 end = c->slots - first > most ? first + most : c->slots;
    camber_u32 i = first;
    while (i <= end && (c->info[i] & wanted) != wanted)
        i++;
    return i <= end ? i : 0u;
}

CAMBER_FN camber_u32 camber_seam_first(const camber_source_line *c, camber_u32 last, camber_u32 most) {
    const camber_u32 wanted = CAMBER_POINT_FIRST | CAMBER_POINT_RING;
    const camber_u32 end = last > most ? last - most : 1u;
    camber_u32 i = last;
    while (i >= end && (c->info[i] & wanted) != wanted)
        i--;
    return i >= end ? i : 0u;
}

/* Returns the previous slot along the line, across a ring's seam; 0: there is none. */
CAMBER_FN camber_u32 camber_slot_before(const camber_source_line *c, camber_u32 at, camber_u32 most) {
    if (!(c->info[at] & CAMBER_POINT_FIRST))
        return at - 1u;
    const camber_u32 last = c->info[at] & CAMBER_POINT_RING ? camber_seam_last(c, at, most) : 0u;
    return last && !(c->info[last] & CAMBER_POINT_FIRST) ? last - 1u : 0u;
}

CAMBER_FN camber_u32 camber_slot_behind(const camber_source_line *c, camber_u32 at, camber_u32 most) {
    if (!(c->info[at] & CAMBER_POINT_LAST))
        return at + 1u;
    const camber_u32 first = c->info[at] & CAMBER_POINT_RING ? camber_seam_first(c, at, most) : 0u;
    return first && !(c->info[first] & CAMBER_POINT_LAST) ? first + 1u : 0u;
}

CAMBER_FN camber_u32 camber_is_dot(camber_u32 info) {
    const camber_u32 ends = CAMBER_POINT_FIRST | CAMBER_POINT_LAST;
    return (info & ends) == ends ? 1u : 0u;
}

CAMBER_FN camber_u32 camber_is_open_end(camber_u32 info) {
    return (info & (CAMBER_POINT_FIRST | CAMBER_POINT_LAST)) && !(info & CAMBER_POINT_RING) ? 1u : 0u;
}

/* ---- Offset segments ---- */

/* Returns a component of a direction: 0 if two slots have the same position, as happens if a camera sees a whole city
 * in a pixel. */
CAMBER_FN float camber_direction(float offset, float length) {
    return length > 0.0f ? offset / length : 0.0f;
}

typedef struct camber_offset_segment {
    float x, y; /* its start in px, not moved */
    float ux, uy, length;
} camber_offset_segment;

CAMBER_FN camber_offset_segment camber_offset_segment_at(const camber_source_line *c, camber_u32 slot) {
    camber_offset_segment segment;
    segment.x = c->x[slot];
    segment.y = c->y[slot];
    const float dx = c->x[slot + 1u] - segment.x, dy = c->y[slot + 1u] - segment.y;
    segment.length = CAMBER_SQRT(dx * dx + dy * dy);
    segment.ux = camber_direction(dx, segment.length);
    segment.uy = camber_direction(dy, segment.length);
    return segment;
}

/* Rounds how far a point is from one of the source line to 1/4096 px, the step of points of tiles. So the point has the
 * same bits wherever in a picture it is. */
CAMBER_FN float camber_offset_round(float px) {
    const camber_u32 far = px > 65536.0f || px < -65536.0f ? 1u : 0u;
    return far ? px : (float)(camber_i32)(px * 4096.0f + (px < 0.0f ? -0.5f : 0.5f)) * (1.0f / 4096.0f);
}

CAMBER_FN float camber_offset_segment_x(const camber_offset_segment *segment, float offset, float along) {
    return segment->x + camber_offset_round(segment->ux * along - segment->uy * offset);
}

CAMBER_FN float camber_offset_segment_y(const camber_offset_segment *segment, float offset, float along) {
    return segment->y + camber_offset_round(segment->uy * along + segment->ux * offset);
}

CAMBER_FN camber_u32 camber_offset_has_segment(camber_offset_clip clip) {
    return clip.to > clip.from ? 1u : 0u;
}

/* ---- Corners ---- */

typedef struct camber_offset_corner {
    float c, s;    /* cosine and sine of half the turn that the offset makes, positive from x to y */
    float in, out; /* lengths of the segments */
    float ix, iy;  /* direction of the incoming segment */
    float x, y;    /* px */
    camber_u32 inner;
} camber_offset_corner;

/* Returns the corner at a slot that has neighbours. If its segments coincide, as on a way to a dead end and back, the
 * offset line runs around the end on either side. */
CAMBER_FN camber_offset_corner camber_offset_corner_at(const camber_source_line *c, camber_u32 slot, float offset) {
    const float x = c->x[slot], y = c->y[slot];
    const float dx = x - c->x[slot - 1u], dy = y - c->y[slot - 1u];
    const float ex = c->x[slot + 1u] - x, ey = c->y[slot + 1u] - y;
    const camber_turn turn = camber_turn_between(dx, dy, ex, ey);
    const float reach = CAMBER_OFFSET_REACH * CAMBER_FABS(offset);
    camber_offset_corner corner;
    corner.x = x;
    corner.y = y;
    corner.c = turn.c;
    corner.s = turn.s;
    corner.in = CAMBER_SQRT(dx * dx + dy * dy);
    corner.out = CAMBER_SQRT(ex * ex + ey * ey);
    corner.ix = camber_direction(dx, corner.in);
    corner.iy = camber_direction(dy, corner.in);
    const float shorter = 2.0f * turn.half_shorter < reach ? 2.0f * turn.half_shorter : reach;
    const float aside = CAMBER_FABS(2.0f * turn.s * turn.c);
    const camber_u32 folds = turn.dot < 0.0f && aside < 0.05f && aside * shorter < 0.25f ? 1u : 0u;
    corner.inner = offset * turn.s > 0.0f ? 1u : 0u;
    if (folds && corner.inner) {
        corner.c = -turn.c;
        corner.s = -turn.s;
        corner.inner = 0u;
    }
    return corner;
}

/* Returns how far along both segments the point is at which they cross. */
CAMBER_FN float camber_offset_corner_overlap(const camber_offset_corner *corner, float offset) {
    const float c = corner->c > 1.0e-6f ? corner->c : 1.0e-6f;
    return CAMBER_FABS(offset * corner->s) / c;
}

/* Returns how much of a segment its neighbour hides at an inner corner. If the neighbour is too short to reach the
 * crossing, the disc about its other end hides it. */
CAMBER_FN float camber_offset_corner_hides(const camber_offset_corner *corner, float offset, float neighbour) {
    const float d = CAMBER_FABS(offset), reach = CAMBER_OFFSET_REACH * d;
    const float length = neighbour < reach ? neighbour : reach, room = camber_offset_corner_overlap(corner, offset);
    if (room <= length)
        return room;
    const float aside = length * CAMBER_FABS(2.0f * corner->s * corner->c);
    const float rest = aside * (2.0f * d - aside);
    const float hidden =
        CAMBER_SQRT(rest > 0.0f ? rest : 0.0f) - length * (corner->c * corner->c - corner->s * corner->s);
    return hidden > 0.0f ? hidden : 0.0f;
}

/* An arc: the position of its next point relative to the corner, and the turn to the one after that. */
typedef struct camber_offset_arc {
    float vx, vy;
    float c, s;
    camber_u32 count;
} camber_offset_arc;

CAMBER_FN void camber_offset_arc_step(camber_offset_arc *arc) {
    const float vx = arc->vx * arc->c - arc->vy * arc->s;
    arc->vy = arc->vx * arc->s + arc->vy * arc->c;
    arc->vx = vx;
}

/* Returns the arc of an outer corner; a bevel has none. If it has one point, this is the tip. */
CAMBER_FN camber_offset_arc camber_offset_arc_of(const camber_offset_corner *corner, camber_offset_row row) {
    const float d = CAMBER_FABS(row.offset_px);
    float c = corner->c, s = corner->s;
    camber_offset_arc arc = {0.0f, 0.0f, 1.0f, 0.0f, 1u};
    const camber_u32 gentle = d * (1.0f - c) <= CAMBER_OFFSET_ARC_TOLERANCE_PX * c ? 1u : 0u;
    if (!gentle && row.join != CAMBER_JOINS_ROUND)
        arc.count = row.join == CAMBER_JOINS_MITER && c * row.miter_limit >= 1.0f ? 1u : 0u;
    if (row.join == CAMBER_JOINS_ROUND)
        while (d * (1.0f - c) > CAMBER_OFFSET_ARC_TOLERANCE_PX * c && arc.count < CAMBER_OFFSET_ARC_POINTS_MAX) {
            const float cosine = CAMBER_SQRT(0.5f + 0.5f * c);
            s = 0.5f * s / cosine;
            c = cosine;
            arc.count *= 2u;
        }
    if (arc.count == 0u)
        return arc;
    const float nx = -corner->iy * row.offset_px / c, ny = corner->ix * row.offset_px / c;
    arc.vx = nx * c - ny * s;
    arc.vy = nx * s + ny * c;
    arc.c = c * c - s * s;
    arc.s = 2.0f * s * c;
    return arc;
}

CAMBER_FN camber_u32 camber_offset_arc_first(camber_u32 word) {
    return word & 255u;
}

CAMBER_FN camber_u32 camber_offset_arc_end(camber_u32 word) {
    return word >> 8 & 255u;
}

CAMBER_FN camber_u32 camber_offset_arc_count(camber_u32 word) {
    return word >> 16;
}

#ifdef CAMBER_DEVICE
typedef char camber_offset_row_is_16_bytes[sizeof(camber_offset_row) == 16 ? 1 : -1];
typedef char camber_offset_clip_is_12_bytes[sizeof(camber_offset_clip) == 12 ? 1 : -1];
#else
_Static_assert(sizeof(camber_offset_row) == 16, "the device reads rows of 16 bytes");
_Static_assert(sizeof(camber_offset_clip) == 12, "the device writes clips of 12 bytes");
#endif

#endif
