/* Outlines of glyphs: rings in em units, y down. Outer rings have positive areas. */
#ifndef CAMBER_TEXT_OUTLINE_H
#define CAMBER_TEXT_OUTLINE_H

#include "text/face.h"

#include "camber_text.h"

/* An outline that grows. */
typedef struct camber_outline_maker {
    camber_context *context;
    float *points; /* point_count pairs */
    size_t point_count, point_capacity;
    uint32_t *offsets;
    size_t ring_count, offset_capacity;
    float scale;        /* from the font's units to ems */
    float tolerance_em; /* for flattening curves */
    float wider_em;     /* how much wider strokes become: half of it on either side */
    camber_status status;
} camber_outline_maker;

void camber_outline_begin_ring(camber_outline_maker *maker);
void camber_outline_add_point(camber_outline_maker *maker, float x, float y);
/* Drops the ring if it has no area. */
void camber_outline_end_ring(camber_outline_maker *maker);
/* Orients the rings, moves their edges apart by maker->wider_em, and copies them into one block, which camber_free
 * frees. An outline without rings has no block. */
camber_status camber_outline_finish(camber_outline_maker *maker, camber_outline *outline, void **block);

/* Draws the glyph that has this number in a font. */
void camber_outline_draw_glyph(camber_outline_maker *maker, const camber_face *face, uint32_t glyph);
/* Whether a glyph has an outline. */
bool camber_face_has_outline(const camber_face *face, uint32_t glyph);

#endif
