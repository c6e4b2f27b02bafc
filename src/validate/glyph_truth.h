/* A sheet of made-up glyphs with halos, as labels draw them, and its exact picture from samples. Shares no formula with
 * kernels and shaders. */
#ifndef CAMBER_VALIDATE_GLYPH_TRUTH_H
#define CAMBER_VALIDATE_GLYPH_TRUTH_H

#include "camber.h"

enum {
    CAMBER_SHEET_SIDE_PX = 96,
    CAMBER_SHEET_GLYPHS = 36,
    CAMBER_SHEET_RINGS = 2 * CAMBER_SHEET_GLYPHS,
    CAMBER_SHEET_POINTS_MAX = 40 * CAMBER_SHEET_RINGS,
    CAMBER_SHEET_ROWS = 2,
};

/* Closed rings in px: two for each glyph, of which the second is a hole or a dot. Both have the glyph's row. */
typedef struct camber_glyph_sheet {
    float points[2 * CAMBER_SHEET_POINTS_MAX];
    uint32_t offsets[CAMBER_SHEET_RINGS + 1], rows[CAMBER_SHEET_RINGS];
} camber_glyph_sheet;

void camber_glyph_sheet_make(camber_glyph_sheet *sheet);
/* Returns how wide the halo of a row is beyond the glyph's edge, px. */
float camber_glyph_sheet_halo_px(size_t row);
/* Writes the truth, 0 to 1: first the share of each pixel that is inside glyphs, then the share inside glyphs or their
 * halos. */
void camber_glyph_sheet_sample(const camber_glyph_sheet *sheet,
                               float truth[2 * CAMBER_SHEET_SIDE_PX * CAMBER_SHEET_SIDE_PX]);

#endif
