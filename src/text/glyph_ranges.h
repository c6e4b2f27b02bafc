/* The glyphs of a style's `glyphs`: signed distances in ranges of 256 code points, which a function of the caller
 * provides. */
#ifndef CAMBER_TEXT_GLYPH_RANGES_H
#define CAMBER_TEXT_GLYPH_RANGES_H

#include "text/number_map.h"
#include "text/outline.h"

#include "camber_text.h"

/* MapLibre's glyphs are made for text of this size, with a border around each bitmap. */
#define CAMBER_RANGE_EM_PX 24.0f
#define CAMBER_RANGE_BORDER_PX 3

typedef struct camber_range_glyph {
    const uint8_t *values;  /* with the border; NULL if width is 0 */
    uint32_t width, height; /* without the border */
    int32_t left, top;
    uint32_t advance;
} camber_range_glyph;

typedef struct camber_glyph_ranges {
    camber_context *context;
    camber_glyph_range_fn *read;
    void *user;
    char *stack;             /* names of fonts, separated by commas */
    camber_number_map asked; /* a range's number -> 1 if it has been asked for */
    void **loaded;           /* protobuf's messages */
    size_t loaded_count, loaded_capacity;
    camber_number_map found; /* a code point -> its glyph's index in glyphs + 1 */
    camber_range_glyph *glyphs;
    size_t glyph_count, glyph_capacity;
    float ascender_em;    /* from MapLibre's top of a line to the baseline */
    bool is_told;         /* the log says that a range is broken */
    camber_status status; /* CAMBER_ERROR_MEMORY: a range could not be loaded */
} camber_glyph_ranges;

camber_status camber_glyph_ranges_open(camber_context *context, camber_glyph_range_fn *read, void *user,
                                       const char *stack, camber_glyph_ranges **ranges);
void camber_glyph_ranges_close(camber_glyph_ranges *ranges);

/* Whether there is a glyph for a code point. If memory runs out, ranges->status says so from then on. */
bool camber_glyph_ranges_has(camber_glyph_ranges *ranges, uint32_t code);
/* Returns the advance of a glyph, which must exist. */
float camber_glyph_ranges_advance_em(const camber_glyph_ranges *ranges, uint32_t code);
/* Draws a glyph: adds the rings of its bitmap, relative to its origin on the baseline. */
void camber_glyph_ranges_draw(const camber_glyph_ranges *ranges, uint32_t code, camber_outline_maker *maker);

#endif
