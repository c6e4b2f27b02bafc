/* A set of fonts: finds what draws each character of a stack of fonts, and numbers the glyphs for texts.
 *
 * A character is drawn by the first of these that has it: the caller's ranges of glyphs; the fonts of its stack; the
 * fonts that camber ships, so that maps are alike on all machines; Noto Sans for its script; fonts in the folders; the
 * system's fonts, in the order in which fontconfig tries them. */
#ifndef CAMBER_TEXT_FONTS_H
#define CAMBER_TEXT_FONTS_H

#include "text/font_index.h"
#include "text/glyph_ranges.h"
#include "text/number_map.h"
#include "text/shaping.h"

#include "camber_text.h"

/* A face or ranges, which draw glyphs. */
typedef struct camber_glyph_source {
    camber_face *face;
    camber_glyph_ranges *ranges;
    const char *name;         /* for messages */
    camber_number_map glyphs; /* a glyph's number in the font, or its code point -> its number in the set + 1 */
} camber_glyph_source;

/* The fonts that a run names. */
typedef struct camber_font_stack {
    uint64_t key; /* a hash of its names and language */
    char **names;
    size_t name_count;
    char *language; /* NULL: none */
    camber_font_style style;
    float ascender_em;
    uint32_t ranges_source; /* CAMBER_NO_SOURCE: none */
    bool is_resolved, is_sorted;
    uint32_t *named; /* named_count sources */
    size_t named_count;
    FcFontSet *sorted;            /* the system's fonts */
    camber_number_map sources_of; /* a code point -> its source + 1 */
} camber_font_stack;

#define CAMBER_NO_SOURCE UINT32_MAX

/* An outline for a tolerance and a weight. */
typedef struct camber_made_outline camber_made_outline;
struct camber_made_outline {
    camber_made_outline *next;
    int exponent;    /* of the tolerance */
    unsigned weight; /* how much wider its strokes are */
    camber_outline outline;
    void *block;
};

typedef struct camber_font_glyph {
    uint32_t source;
    uint32_t number; /* its number in the face, or in ranges its code point */
    camber_made_outline *outlines;
} camber_font_glyph;

struct camber_fonts {
    camber_context *context;
    char **folders;
    size_t folder_count;
    bool has_system, is_filled;
    camber_glyph_range_fn *read;
    void *read_user;
    camber_font_index index; /* filled when a text needs a font */
    uint32_t *entry_sources; /* by entry: its source + 1, or 0 */
    camber_glyph_source *sources;
    size_t source_count, source_capacity;
    camber_font_stack *stacks;
    size_t stack_count, stack_capacity;
    camber_font_glyph *glyphs;
    size_t glyph_count, glyph_capacity;
    uint64_t *told; /* hashes of the names and scripts that a warning has named */
    size_t told_count, told_capacity;
    camber_shaping shaping;
    struct camber_text_memo *memo; /* texts that were shaped (memo.c); NULL: none yet */
};

/* Finds the stack of a run. Its index stays valid, but pointers to stacks do not. */
camber_status camber_fonts_find_stack(camber_fonts *fonts, const char *const *names, size_t name_count,
                                      const char *language, uint32_t *stack);
/* Finds the source for a character and the marks on it: a source that has them all or, if there is none, the source of
 * the character. CAMBER_NO_SOURCE: nothing is drawn. */
camber_status camber_fonts_find_source(camber_fonts *fonts, uint32_t stack, const uint32_t *codes, size_t count,
                                       uint32_t *source);
bool camber_glyph_source_has(const camber_glyph_source *source, uint32_t code);
/* Finds the number of a glyph in the set. */
camber_status camber_fonts_find_glyph(camber_fonts *fonts, uint32_t source, uint32_t number, uint32_t *glyph);

/* Everything that a text depends on: two texts with equal bytes are equal. */
typedef struct camber_text_key {
    const void *bytes;
    size_t size_bytes;
    uint64_t hash; /* of the bytes */
} camber_text_key;

/* Does the work of camber_text_shape, but copies a text that was shaped for the same key if it is still remembered. */
camber_status camber_text_recall(camber_fonts *fonts, const camber_text_key *key, const camber_text_desc *desc,
                                 camber_text **text);
/* Copies a remembered text, if it is found. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_text_memo_find(camber_fonts *fonts, const camber_text_key *key, bool *found, camber_text **text);
/* Remembers a copy of a text, unless it or its key is long. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_text_memo_put(camber_fonts *fonts, const camber_text_key *key, const camber_text *text);
void camber_text_memo_free(camber_context *context, struct camber_text_memo *memo);

#endif
