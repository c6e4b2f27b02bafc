/* A text on its way to lines, in memory that is kept for the next text:
 *
 *     characters (characters.c) -> levels (bidi.c) -> items of one source, script and direction (items.c)
 *     -> glyphs of items (shape.c) -> lines (breaks.c) -> places (layout.c)
 */
#ifndef CAMBER_TEXT_SHAPING_H
#define CAMBER_TEXT_SHAPING_H

#include "base/base.h"

#include "camber_text.h"

#include <hb.h>

/* The character that takes the place of an image. */
#define CAMBER_IMAGE_CODE 0xfffcu

/* From the middle of a line to the top of its ems, as in MapLibre. */
#define CAMBER_LINE_TOP_EM (-17.0f / 24.0f)

typedef struct camber_character {
    uint32_t run, byte;
    uint32_t source; /* the source that draws it. CAMBER_NO_SOURCE: nothing does */
    hb_script_t script;
    float width_em; /* in a line, without spacing: the advance of its cluster if it is the first in it, otherwise 0 */
    uint8_t level;  /* if odd, it is read from right to left */
    bool is_image, is_mark, is_upright, begins_item;
} camber_character;

/* Characters that are shaped together. */
typedef struct camber_text_item {
    uint32_t first, end;       /* characters */
    uint32_t source;           /* CAMBER_NO_SOURCE: an image, or nothing */
    size_t glyph, glyph_count; /* in order from left to right, or from the top down */
    bool is_upright;
} camber_text_item;

/* A glyph of an item, in ems of the run. */
typedef struct camber_item_glyph {
    uint32_t number;    /* its number in its source */
    uint32_t character; /* the first character of its cluster */
    float x, y, advance;
    bool is_unsafe_to_break, ends_cluster, is_turned;
} camber_item_glyph;

typedef struct camber_line_break {
    uint32_t first, end; /* characters of a line */
} camber_line_break;

typedef struct camber_shaping {
    uint32_t *codes; /* there are count codes, and as many characters */
    camber_character *characters;
    size_t count, code_capacity, character_capacity;
    bool has_right_to_left, has_cursive;
    camber_text_item *items;
    size_t item_count, item_capacity;
    camber_item_glyph *glyphs;
    size_t glyph_count, glyph_capacity;
    camber_line_break *lines;
    size_t line_count, line_capacity;
    camber_text_item *pieces; /* of a line */
    size_t piece_count, piece_capacity;
    uint8_t *levels; /* levels of the pieces. order has the piece at each position of the line */
    uint32_t *order;
    size_t level_capacity, order_capacity;
    void *breaks; /* used by breaks.c only */
    size_t break_capacity;
    uint32_t *stacks; /* by run */
    size_t stack_capacity;
    hb_buffer_t *buffer;
} camber_shaping;

void camber_shaping_free(camber_context *context, camber_shaping *shaping);

/* Reads the runs: fills codes and characters. Control characters are left out. */
camber_status camber_shaping_read(camber_context *context, camber_shaping *shaping, const camber_text_desc *desc);
/* Sets the levels of characters; each paragraph has the direction of its first strong character. */
camber_status camber_shaping_order(camber_context *context, camber_shaping *shaping);
/* Decides what draws each character, and makes items. */
camber_status camber_shaping_itemize(camber_fonts *fonts, const camber_text_desc *desc);
/* Shapes all items, and sets the characters' widths. */
camber_status camber_shaping_shape(camber_fonts *fonts, const camber_text_desc *desc);
/* Appends the glyphs of an item, or of a part of an item, and stores in the item which they are. */
camber_status camber_shaping_shape_item(camber_fonts *fonts, const camber_text_desc *desc, camber_text_item *item);
/* Finds the lines, and cuts white space from their ends. */
camber_status camber_shaping_break(camber_context *context, camber_shaping *shaping, const camber_text_desc *desc);
/* Makes the text from the lines. */
camber_status camber_shaping_lay_out(camber_fonts *fonts, const camber_text_desc *desc, camber_text *text);

/* Finds the levels of a paragraph. direction: 0 from left to right, 1 from right to left, -1 as its first strong
 * character says. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_bidi_find_levels(camber_context *context, const uint32_t *codes, size_t count, int direction,
                                      uint8_t *levels);
/* Orders pieces with these levels from left to right: order[i] is the piece at position i. */
void camber_bidi_find_order(const uint8_t *levels, size_t count, uint32_t *order);

static inline float camber_run_scale(const camber_text_run *run) {
    return run->scale > 0.0f ? run->scale : 1.0f;
}
/* Returns the spacing after each cluster: 0 in cursive scripts, whose letters touch. */
static inline float camber_shaping_spacing(const camber_shaping *shaping, const camber_text_desc *desc) {
    return shaping->has_cursive ? 0.0f : desc->letter_spacing_em;
}

#endif
