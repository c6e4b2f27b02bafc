/* Emits the points of the remaining parts of an offset line, in the order of the line. */
#ifndef CAMBER_KERNELS_OFFSET_EMIT_H
#define CAMBER_KERNELS_OFFSET_EMIT_H

#include "offset_clip.h"

/* ---- Elements: what is left, in the order of the line ---- */

#define CAMBER_OFFSET_NONE 0u
#define CAMBER_OFFSET_SEGMENT 1u
#define CAMBER_OFFSET_ARC 2u

typedef struct camber_offset_element {
    camber_u32 kind, slot;
    camber_u32 steps; /* slots back */
    camber_u32 seam;  /* 1: a ring's seam is between them */
} camber_offset_element;

/* Whether there is an arc. An arc of one point, the tip, exists only if both its segments reach it. */
CAMBER_FN camber_u32 camber_has_arc(const camber_source_line *c, camber_u32 slot) {
    const camber_offset_clip clip = c->clips[slot];
    if (camber_offset_arc_count(clip.arc) != 1u)
        return camber_offset_arc_end(clip.arc) > camber_offset_arc_first(clip.arc) ? 1u : 0u;
    const camber_u32 before = camber_slot_before(c, slot, c->slots);
    return before && camber_offset_has_segment(clip) && clip.from <= 0.0f &&
                   c->clips[before].to >= CAMBER_OFFSET_SEGMENT_WHOLE
               ? 1u
               : 0u;
}

/* Returns the last element before a slot's own. */
CAMBER_FN camber_offset_element camber_offset_element_before(const camber_source_line *c, camber_u32 slot) {
    camber_offset_element element = {CAMBER_OFFSET_NONE, slot, 0u, 0u};
    camber_u32 around = c->info[slot] & CAMBER_POINT_LAST ? 1u : 0u; /* all of a ring has been seen at its seam */
    for (;;) {
        const camber_u32 begins = c->info[element.slot] & CAMBER_POINT_FIRST ? 1u : 0u;
        if (begins && around)
            return element;
        around |= begins;
        element.seam |= begins;
        element.slot = camber_slot_before(c, element.slot, c->slots);
        element.steps++;
        if (element.slot == 0u || element.slot == slot)
            return element;
        if (camber_offset_has_segment(c->clips[element.slot]))
            element.kind = CAMBER_OFFSET_SEGMENT;
        else if (camber_has_arc(c, element.slot))
            element.kind = CAMBER_OFFSET_ARC;
        if (element.kind != CAMBER_OFFSET_NONE)
            return element;
    }
}

/* ---- Points ---- */

/* Receives points, and remembers the first two and the last. */
typedef struct camber_offset_writer {
    CAMBER_GLOBAL float *x, *y;
    CAMBER_GLOBAL camber_u32 *info;
    CAMBER_GLOBAL float *arc_lengths;
    camber_u32 emits;       /* 0: points are only counted, 1: they are also written */
    camber_u32 at;          /* the next slot */
    camber_u32 word, flags; /* info word and flags of the next point; flags are only for one point */
    camber_u32 count;
    float x0, y0, x1, y1, last_x, last_y;
    float total;
} camber_offset_writer;

CAMBER_FN void camber_offset_writer_slot(camber_offset_writer *writer, float x, float y, camber_u32 info, float along) {
    if (writer->emits) {
        writer->x[writer->at] = x;
        writer->y[writer->at] = y;
        writer->info[writer->at] = info;
        if (writer->arc_lengths) {
            writer->arc_lengths[2u * (writer->at - 1u)] = info ? along : 0.0f;
            writer->arc_lengths[2u * (writer->at - 1u) + 1u] = info ? writer->total : 0.0f;
        }
    }
    writer->at++;
}

CAMBER_FN void camber_offset_writer_point(camber_offset_writer *writer, float x, float y, float along) {
    camber_offset_writer_slot(writer, x, y, writer->word | writer->flags, along);
    writer->flags = 0u;
    if (writer->count == 0u) {
        writer->x0 = x;
        writer->y0 = y;
    } else if (writer->count == 1u) {
        writer->x1 = x;
        writer->y1 = y;
    }
    writer->last_x = x;
    writer->last_y = y;
    writer->count++;
}

CAMBER_FN float camber_offset_along_slot(const camber_source_line *c, camber_u32 slot) {
    return c->arc_lengths ? c->arc_lengths[2u * (slot - 1u)] : 0.0f;
}

CAMBER_FN float camber_offset_along_segment(const camber_source_line *c, camber_u32 slot,
                                            const camber_offset_segment *segment, float along) {
    const float from = camber_offset_along_slot(c, slot), to = camber_offset_along_slot(c, slot + 1u);
    return from + (to - from) * (along / segment->length);
}

/* The end of an element. */
typedef struct camber_offset_point {
    float x, y, along;
} camber_offset_point;

CAMBER_FN camber_offset_point camber_offset_element_end(const camber_source_line *c, camber_offset_element element,
                                                        camber_offset_row row) {
    camber_offset_point place;
    const camber_offset_clip clip = c->clips[element.slot];
    if (element.kind == CAMBER_OFFSET_SEGMENT) {
        const camber_offset_segment segment = camber_offset_segment_at(c, element.slot);
        const float to = clip.to < segment.length ? clip.to : segment.length;
        place.x = camber_offset_segment_x(&segment, row.offset_px, to);
        place.y = camber_offset_segment_y(&segment, row.offset_px, to);
        place.along = camber_offset_along_segment(c, element.slot, &segment, to);
        return place;
    }
    const camber_offset_corner corner = camber_offset_corner_at(c, element.slot, row.offset_px);
    camber_offset_arc arc = camber_offset_arc_of(&corner, row);
    for (camber_u32 i = 1; i < camber_offset_arc_end(clip.arc); i++)
        camber_offset_arc_step(&arc);
    place.x = corner.x + camber_offset_round(arc.vx);
    place.y = corner.y + camber_offset_round(arc.vy);
    place.along = camber_offset_along_slot(c, element.slot);
    return place;
}

CAMBER_FN camber_u32 camber_is_close(camber_offset_point place, float x, float y) {
    const float dx = x - place.x, dy = y - place.y;
    return dx * dx + dy * dy <= CAMBER_OFFSET_GAP_PX * CAMBER_OFFSET_GAP_PX ? 1u : 0u;
}

CAMBER_FN void camber_offset_emit_end(const camber_source_line *c, camber_offset_element element, camber_offset_row row,
                                      camber_offset_writer *writer) {
    const camber_offset_point place = camber_offset_element_end(c, element, row);
    camber_offset_writer_point(writer, place.x, place.y, place.along);
}

/* Emits the remaining part of an arc, except its last point, which the next element emits. */
CAMBER_FN void camber_offset_emit_arc(const camber_source_line *c, camber_offset_element before, camber_u32 slot,
                                      camber_offset_row row, camber_offset_writer *writer) {
    const camber_offset_clip clip = c->clips[slot];
    const camber_offset_corner corner = camber_offset_corner_at(c, slot, row.offset_px);
    camber_offset_arc arc = camber_offset_arc_of(&corner, row);
    const camber_u32 joins =
        before.kind == CAMBER_OFFSET_SEGMENT && before.steps == 1u && camber_offset_arc_first(clip.arc) == 0u;
    const camber_u32 goes_on = joins && c->clips[before.slot].to >= CAMBER_OFFSET_SEGMENT_WHOLE ? 1u : 0u;
    for (camber_u32 i = 0; i < camber_offset_arc_end(clip.arc); i++) {
        const float x = corner.x + camber_offset_round(arc.vx), y = corner.y + camber_offset_round(arc.vy);
        if (i == camber_offset_arc_first(clip.arc) && before.kind != CAMBER_OFFSET_NONE && !goes_on) {
            const camber_offset_point end = camber_offset_element_end(c, before, row);
            if (!camber_is_close(end, x, y))
                camber_offset_writer_point(writer, end.x, end.y, end.along);
        }
        if (i >= camber_offset_arc_first(clip.arc) && i + 1u < camber_offset_arc_end(clip.arc))
            camber_offset_writer_point(writer, x, y, camber_offset_along_slot(c, slot));
        camber_offset_arc_step(&arc);
    }
}

/* Whether segments end approximately where they cross, and each keeps the half that leads away from the crossing. */
CAMBER_FN camber_u32 camber_crossing_holds(float p, float q, camber_offset_clip a, float a_length, camber_offset_clip b,
                                           float b_length) {
    const float a_to = a.to < a_length ? a.to : a_length, b_to = b.to < b_length ? b.to : b_length;
    return CAMBER_FABS(p - a_to) <= CAMBER_OFFSET_SLACK_PX && CAMBER_FABS(q - b.from) <= CAMBER_OFFSET_SLACK_PX &&
                   p > 0.5f * (a.from + a_to) && q < 0.5f * (b.from + b_to)
               ? 1u
               : 0u;
}

/* Links a segment to the next one: by the point where they cross, or else by both ends. */
CAMBER_FN void camber_offset_emit_crossing(const camber_source_line *c, camber_offset_element before, camber_u32 slot,
                                           const camber_offset_segment *segment, camber_offset_row row,
                                           camber_offset_writer *writer) {
    const camber_offset_segment other = camber_offset_segment_at(c, before.slot);
    const camber_offset_clip a = c->clips[before.slot], b = c->clips[slot];
    const float offset = row.offset_px, d = CAMBER_FABS(offset);
    if (before.steps == 1u) {
        const camber_offset_corner corner = camber_offset_corner_at(c, slot, offset);
        const float room = camber_offset_corner_overlap(&corner, offset);
        if (corner.inner && room <= CAMBER_OFFSET_REACH * d &&
            camber_crossing_holds(other.length - room, room, a, other.length, b, segment->length)) {
            const float nx = -corner.iy * offset / corner.c, ny = corner.ix * offset / corner.c;
            camber_offset_writer_point(writer, corner.x + camber_offset_round(nx * corner.c - ny * corner.s),
                                       corner.y + camber_offset_round(nx * corner.s + ny * corner.c),
                                       camber_offset_along_slot(c, slot));
            return;
        }
    }
    const float aside = other.ux * segment->uy - other.uy * segment->ux;
    const float wx = camber_offset_segment_x(segment, offset, 0.0f) - camber_offset_segment_x(&other, offset, 0.0f);
    const float wy = camber_offset_segment_y(segment, offset, 0.0f) - camber_offset_segment_y(&other, offset, 0.0f);
    const float safe = CAMBER_FABS(aside) > 1.0e-3f ? aside : 1.0f;
    const float p = (wx * segment->uy - wy * segment->ux) / safe, q = (wx * other.uy - wy * other.ux) / safe;
    if (CAMBER_FABS(aside) > 1.0e-3f && camber_crossing_holds(p, q, a, other.length, b, segment->length)) {
        const float along = camber_offset_along_segment(c, before.slot, &other, p);
        camber_offset_writer_point(writer, camber_offset_segment_x(segment, offset, q),
                                   camber_offset_segment_y(segment, offset, q),
                                   0.5f * (along + camber_offset_along_segment(c, slot, segment, q)));
        return;
    }
    const camber_offset_point end = camber_offset_element_end(c, before, row);
    const float x = camber_offset_segment_x(segment, offset, b.from),
                y = camber_offset_segment_y(segment, offset, b.from);
    if (!camber_is_close(end, x, y))
        camber_offset_writer_point(writer, end.x, end.y, end.along);
    camber_offset_writer_point(writer, x, y, camber_offset_along_segment(c, slot, segment, b.from));
}

CAMBER_FN void camber_offset_emit_segment(const camber_source_line *c, camber_offset_element before, camber_u32 slot,
                                          camber_offset_row row, camber_offset_writer *writer) {
    const camber_offset_segment segment = camber_offset_segment_at(c, slot);
    const camber_offset_clip clip = c->clips[slot];
    if (before.kind == CAMBER_OFFSET_SEGMENT) {
        camber_offset_emit_crossing(c, before, slot, &segment, row, writer);
        return;
    }
    const camber_offset_clip arc = c->clips[before.slot];
    const camber_u32 joins = before.kind == CAMBER_OFFSET_ARC && before.slot == slot && clip.from <= 0.0f &&
                                     camber_offset_arc_end(arc.arc) == camber_offset_arc_count(arc.arc)
                                 ? 1u
                                 : 0u;
    const float x = camber_offset_segment_x(&segment, row.offset_px, clip.from),
                y = camber_offset_segment_y(&segment, row.offset_px, clip.from);
    if (before.kind == CAMBER_OFFSET_ARC) {
        const camber_offset_point end = camber_offset_element_end(c, before, row);
        if (joins || !camber_is_close(end, x, y))
            camber_offset_writer_point(writer, end.x, end.y, end.along);
        if (joins)
            return;
    }
    camber_offset_writer_point(writer, x, y, camber_offset_along_segment(c, slot, &segment, clip.from));
}

/* Emits the points of a slot's arc and segment, each linked to the element before it. The slot may have neither. */
CAMBER_FN void camber_offset_emit_elements(const camber_source_line *c, camber_offset_element before, camber_u32 slot,
                                           camber_offset_row row, camber_offset_writer *writer) {
    if (camber_has_arc(c, slot)) {
        camber_offset_emit_arc(c, before, slot, row, writer);
        before.kind = CAMBER_OFFSET_ARC;
        before.slot = slot;
        before.steps = 0u;
    }
    if (camber_offset_has_segment(c->clips[slot]))
        camber_offset_emit_segment(c, before, slot, row, writer);
}

CAMBER_FN camber_u32 camber_offset_has_elements(const camber_source_line *c, camber_u32 slot) {
    return camber_offset_has_segment(c->clips[slot]) || camber_has_arc(c, slot) ? 1u : 0u;
}

CAMBER_FN camber_offset_writer camber_offset_writer_counting(void) {
    camber_offset_writer writer = {0};
    return writer;
}

/* Emits the last point of a line: the end of its last element, or, if that is linked to a ring's first element across
 * the seam, the first point again, and a sentinel of the second. */
CAMBER_FN void camber_offset_emit_last(const camber_source_line *c, camber_offset_element before, camber_u32 slot,
                                       camber_offset_row row, camber_offset_writer *writer) {
    const camber_u32 first = c->info[slot] & CAMBER_POINT_RING ? camber_seam_first(c, slot, c->slots) : 0u;
    camber_offset_writer begin = camber_offset_writer_counting();
    camber_u32 at = first;
    for (; at && begin.count < 2u && at != slot; at++) {
        if (camber_offset_has_elements(c, at)) {
            const camber_offset_element linked = camber_offset_element_before(c, at);
            if (begin.count == 0u && linked.kind == CAMBER_OFFSET_NONE)
                break;
            camber_offset_emit_elements(c, linked, at, row, &begin);
        }
        if (c->info[at] & CAMBER_POINT_LAST) {
            if (begin.count == 1u)
                camber_offset_emit_end(c, camber_offset_element_before(c, at), row, &begin);
            break;
        }
    }
    if (begin.count == 0u) {
        writer->flags |= CAMBER_POINT_LAST | (c->info[slot] & CAMBER_POINT_CUT);
        camber_offset_emit_end(c, before, row, writer);
        return;
    }
    writer->flags |= CAMBER_POINT_LAST | CAMBER_POINT_RING;
    camber_offset_writer_point(writer, begin.x0, begin.y0, camber_offset_along_slot(c, slot));
    camber_offset_writer_slot(writer, begin.count > 1u ? begin.x1 : begin.x0, begin.count > 1u ? begin.y1 : begin.y0,
                              0u, 0.0f);
}

/* Emits a slot of a line without offset unchanged. */
CAMBER_FN void camber_offset_emit_same(const camber_source_line *c, camber_u32 slot, camber_offset_writer *writer) {
    const camber_u32 info = c->info[slot], ring = info & CAMBER_POINT_RING;
    if (ring && (info & CAMBER_POINT_FIRST))
        camber_offset_writer_slot(writer, c->x[slot - 1u], c->y[slot - 1u], 0u, 0.0f);
    camber_offset_writer_slot(writer, c->x[slot], c->y[slot], info, camber_offset_along_slot(c, slot));
    if (ring && (info & CAMBER_POINT_LAST))
        camber_offset_writer_slot(writer, c->x[slot + 1u], c->y[slot + 1u], 0u, 0.0f);
}

/* Emits the slots that come from a source slot: its own points, a ring's sentinels, a line's last point. */
CAMBER_FN void camber_offset_emit_beside(const camber_source_line *c, camber_u32 slot, camber_offset_writer *writer) {
    const camber_u32 info = c->info[slot];
    if (!(info & CAMBER_POINT_REAL))
        return;
    const camber_offset_row row = c->offset_rows[info >> CAMBER_POINT_ROW_SHIFT];
    writer->total = c->arc_lengths ? c->arc_lengths[2u * (slot - 1u) + 1u] : 0.0f;
    if (!(row.offset_px < 0.0f || row.offset_px > 0.0f) || camber_is_dot(info)) {
        camber_offset_emit_same(c, slot, writer);
        return;
    }
    const camber_u32 last = info & CAMBER_POINT_LAST;
    if (!last && !camber_offset_has_elements(c, slot))
        return;
    const camber_offset_element before = camber_offset_element_before(c, slot);
    writer->word = (info & CAMBER_ROW_BITS) | CAMBER_POINT_REAL;
    if (last) {
        if (before.kind != CAMBER_OFFSET_NONE)
            camber_offset_emit_last(c, before, slot, row, writer);
        return;
    }
    if (before.kind == CAMBER_OFFSET_NONE)
        writer->flags = CAMBER_POINT_FIRST | (info & CAMBER_POINT_CUT);
    if (before.kind != CAMBER_OFFSET_NONE && before.seam) {
        camber_offset_writer end = camber_offset_writer_counting();
        camber_offset_emit_elements(c, camber_offset_element_before(c, before.slot), before.slot, row, &end);
        camber_offset_writer_slot(writer, end.last_x, end.last_y, 0u, 0.0f);
        writer->flags = CAMBER_POINT_FIRST | CAMBER_POINT_RING;
    }
    camber_offset_emit_elements(c, before, slot, row, writer);
}

#endif
