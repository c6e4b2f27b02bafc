/* camber_text.h shapes text: from UTF-8 and the names of fonts to glyphs, their places and their outlines.
 *
 *     runs of text -> camber_text_shape -> glyphs of lines -> camber_text_rings_add -> rings in px, for a mesh
 *                                                          -> camber_fonts_get_sized_outline -> rings in em
 *
 * It is part of libcamber-map. HarfBuzz shapes the text, FriBidi orders text that mixes both directions, and lines
 * break by the rules of the MapLibre style specification. Errors, ownership and threads are as in camber.h: fonts
 * belong to a context.
 *
 * Units. Lengths are in ems: 1 is the size of the text. x points right, y down. Outlines are relative to the glyph's
 * origin on the baseline. */
#ifndef CAMBER_TEXT_H
#define CAMBER_TEXT_H

#include "camber.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Fonts ------------------------------------------------------------------------------------------ */

/* A run of text names a stack of fonts. A character, with the marks on it, is drawn by the first of these that has it:
 *
 *     1. the glyphs that the caller's function provides
 *     2. the fonts of the stack: from a folder, else the shipped font, else from the system; a name means the font with
 *        this name or else the font of its family with the nearest weight, width and slant
 *     3. the shipped font: Noto Sans for Latin, Greek and Cyrillic, regular, bold or italic
 *     4. Noto Sans for the character's script, such as Noto Sans Arabic
 *     5. any font in the folders
 *     6. the system's fonts, in fontconfig's order
 *
 * The choice never depends on earlier texts. One warning is logged for each font of a stack that is missing; at
 * CAMBER_LOG_INFO the log says which fonts are used. Glyphs that are colour pictures are left out. */

/* Provides the glyphs for 256 code points, starting with first, as a glyph PBF of the style specification. stack: the
 * names of the fonts, separated by commas. *bytes stays valid until the next call.
 * Returns CAMBER_ERROR_NOT_FOUND if there is no such range: fonts are then used instead. */
typedef camber_status camber_glyph_range_fn(void *user, const char *stack, uint32_t first, const uint8_t **bytes,
                                            size_t *size_bytes);

typedef struct camber_fonts_desc {
    const char *const *folders; /* folder_count folders that are searched for font files, before the system's fonts */
    size_t folder_count;
    bool no_system;                /* leave out the fonts that fontconfig knows */
    camber_glyph_range_fn *glyphs; /* asked before any font. NULL: there is none */
    void *glyphs_user;
} camber_fonts_desc;

typedef struct camber_fonts camber_fonts;

/* Makes a set of fonts. Font files are opened when text needs them. Besides the fonts of folders and of the system, the
 * set always has the font that camber ships. desc may be NULL.
 * Returns CAMBER_ERROR_NOT_FOUND (a folder), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_fonts_create(camber_context *context, const camber_fonts_desc *desc,
                                             camber_fonts **fonts);
CAMBER_API void camber_fonts_destroy(camber_fonts *fonts);

typedef struct camber_font_info {
    const char *name; /* as a run may name it, such as "Noto Sans Bold" */
    const char *path; /* NULL: camber ships it */
    float weight;     /* 1 to 1000; 400 is regular, 700 bold */
    float width;      /* percent; 100 is normal */
    bool italic;      /* or oblique */
} camber_font_info;

/* Describes the n-th font, counted from 0: first the fonts of the folders, then the shipped fonts, then the system's.
 * Sets info->name to NULL past the last one. The strings belong to the fonts.
 * Returns CAMBER_ERROR_MEMORY.
 * Cost: the first call reads the names in all font files of the folders, as the first text does. */
CAMBER_API camber_status camber_fonts_list(camber_fonts *fonts, size_t n, camber_font_info *info);

/* A glyph's outline: closed rings without repeated points. A point is inside if its winding number is not 0. */
typedef struct camber_outline {
    const float *points;     /* pairs of x, y */
    const uint32_t *offsets; /* ring_count + 1 indices into points */
    size_t ring_count;       /* 0: nothing is drawn, as for a space */
    float left, top, right, bottom;
} camber_outline;

/* Returns a glyph's outline. A curve becomes segments that are at most tolerance_em away from it; 0 means 1/256. The
 * outline belongs to the fonts and stays valid as long as they exist.
 * Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT (an outline of more than 2^20 points). */
CAMBER_API camber_status camber_fonts_get_outline(camber_fonts *fonts, uint32_t glyph, float tolerance_em,
                                                  camber_outline *outline);

/* Returns a glyph's outline as camber draws it in a text of size_px device px per em, which is above 0. Its segments
 * are at most 1/32 px away from its curves. Below 20 px, strokes are 0.2 px * (1 - size_px / 20) wider than in the
 * font, so that small text is as dark as other programs draw it. Glyphs that the caller provides are unchanged.
 * Otherwise as camber_fonts_get_outline. */
CAMBER_API camber_status camber_fonts_get_sized_outline(camber_fonts *fonts, uint32_t glyph, float size_px,
                                                        camber_outline *outline);

/* ---- Text ------------------------------------------------------------------------------------------- */

typedef enum camber_text_anchor {
    CAMBER_ANCHOR_CENTER = 0,
    CAMBER_ANCHOR_LEFT, /* the anchor is at the middle of the text's left side */
    CAMBER_ANCHOR_RIGHT,
    CAMBER_ANCHOR_TOP,
    CAMBER_ANCHOR_BOTTOM,
    CAMBER_ANCHOR_TOP_LEFT,
    CAMBER_ANCHOR_TOP_RIGHT,
    CAMBER_ANCHOR_BOTTOM_LEFT,
    CAMBER_ANCHOR_BOTTOM_RIGHT,
} camber_text_anchor;

typedef enum camber_text_justify {
    CAMBER_JUSTIFY_CENTER = 0,
    CAMBER_JUSTIFY_LEFT,
    CAMBER_JUSTIFY_RIGHT,
    CAMBER_JUSTIFY_AUTO, /* towards the anchor's side */
} camber_text_justify;

/* How a run that is smaller than the others in its line is aligned with them. */
typedef enum camber_text_align {
    CAMBER_ALIGN_BOTTOM = 0, /* on their baseline */
    CAMBER_ALIGN_CENTER,
    CAMBER_ALIGN_TOP,
} camber_text_align;

/* Text with one font and size, or an image in the text. */
typedef struct camber_text_run {
    const char *text; /* size_bytes of UTF-8; invalid bytes are shown as U+FFFD. NULL: an image */
    size_t size_bytes;
    const char *const
        *fonts; /* font_count names, each with its style, such as "Noto Sans Bold"; the first is preferred */
    size_t font_count;
    float scale;                           /* relative to the text's size. 0: 1 */
    float image_width_em, image_height_em; /* of an image */
    camber_text_align align;
} camber_text_run;

typedef struct camber_text_desc {
    const camber_text_run *runs; /* run_count of them */
    size_t run_count;
    float max_width_em;   /* longer lines are broken. 0: only newlines in the text break lines */
    float line_height_em; /* 0: 1.2 */
    float letter_spacing_em;
    camber_text_anchor anchor;
    camber_text_justify justify;
    bool vertical;        /* lines run downwards, side by side: ideographs are upright, other scripts turned */
    const char *language; /* BCP 47, for scripts whose shapes depend on it. NULL: none */
} camber_text_desc;

#define CAMBER_NO_GLYPH UINT32_MAX

/* A glyph of a text, in the order in which it is drawn: from left to right, or down. */
typedef struct camber_text_glyph {
    uint32_t glyph; /* its number in the fonts. CAMBER_NO_GLYPH: the run's image, whose top left corner is at x, y */
    uint32_t run;
    uint32_t byte; /* where in the run's text its character begins */
    float x, y;    /* its origin, relative to the text's anchor */
    float advance; /* along the line, including the spacing */
    float scale;   /* scale of its outline */
    bool turned;   /* its outline is turned by 90 degrees clockwise */
} camber_text_glyph;

typedef struct camber_text_line {
    size_t first, count; /* glyphs */
    float width;
} camber_text_line;

typedef struct camber_text {
    camber_context *context;
    camber_text_glyph *glyphs; /* glyph_count of them, line by line */
    size_t glyph_count;
    camber_text_line *lines; /* line_count of them, from the top down; vertical lines from right to left */
    size_t line_count;
    float left, top, right, bottom; /* box around all lines, each line_height_em high, relative to the anchor */
    float line_height_em;
    float letter_spacing_em; /* after each cluster: 0 in cursive scripts, whose letters touch */
    bool vertical;
    camber_text_anchor anchor; /* how the text is placed now */
    camber_text_justify justify;
} camber_text;

/* Shapes and lays out a text. An empty text has no lines. A character that no font has is drawn as its font's box for
 * missing characters, and one warning names it.
 * Returns CAMBER_ERROR_LIMIT (more than 2^20 bytes of text), CAMBER_ERROR_MEMORY.
 * Cost: linear in the length of the text, about 0.2 us per character once its fonts are open. */
CAMBER_API camber_status camber_text_shape(camber_fonts *fonts, const camber_text_desc *desc, camber_text **text);
/* Moves a text's glyphs for another anchor and justification. */
CAMBER_API void camber_text_place(camber_text *text, camber_text_anchor anchor, camber_text_justify justify);
CAMBER_API void camber_text_destroy(camber_text *text);

/* ---- Drawing texts: for programs that place them ----------------------------------------------------- */

/* Collects texts as rings in px. A mesh of these rings is drawn twice: by a pass whose paints are lines, which are the
 * halos of the texts, and then by a pass whose paints are fills. For a text with a halo of 1.5 px:
 *
 *     camber_text_rings_add(rings, text, &(camber_text_position){.x = 100, .y = 50, .size_px = 16}, NULL);
 *     camber_polylines_desc desc = camber_text_rings_get(rings);
 *     camber_polylines_create(context, &desc, &polylines);
 *
 *     camber_stroke stroke = {.width_px = 3};                            for camber_mesh_tessellate
 *     camber_paint halo = {.width_px = 3, .color = {1, 1, 1, 1}};        for the first pass
 *     camber_paint text = {.fill = &(camber_fill){.color = {0, 0, 0, 1}}};    for the second pass
 *
 * A row has the look of one or more texts: rows are indices into the strokes and into the paints of both passes.
 * examples/streets.c is a whole program. */
typedef struct camber_text_rings camber_text_rings;

/* Where a text is drawn: at a point, or along a line. */
typedef struct camber_text_position {
    float size_px; /* px per em, up to 16384. 0: 16 */
    uint32_t row;
    float x, y;     /* px: where the text's anchor is. Along a line these are ignored */
    float turn_deg; /* turns the text about its anchor, clockwise. Along a line it is ignored */
    /* The line that the text follows: point_count pairs of x, y in px. Each cluster of glyphs is turned about its
     * middle as the line is there. A part of the text that is above its anchor is on the left of the line as the text
     * runs. NULL: none. */
    const float *points;
    size_t point_count;
    float shift_px;      /* how far along the line the text's anchor is from the middle of the line */
    bool keep_direction; /* true: the text runs as the line does. false: it runs the way in which it can be read */
    /* A text is not drawn where its line turns by more than this from one cluster to the next. 0: 45; at most 180 */
    float max_turn_deg;
} camber_text_position;

/* The box around the rings of a text, px; halos are not included. */
typedef struct camber_text_box {
    float left, top, right, bottom; /* left > right: the box is empty */
} camber_text_box;

/* Makes an empty collection for texts that were shaped with these fonts, which must outlive it.
 * Returns CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_text_rings_create(camber_fonts *fonts, camber_text_rings **rings);
CAMBER_API void camber_text_rings_destroy(camber_text_rings *rings);
/* Adds a text. *box receives its box; NULL: it is not needed. The box is empty if nothing was added, because the text
 * has no outlines, or because its line is too short, turns too sharply, or has an invalid point. Images in the text are
 * left to the caller. A text that is added and removed again shows whether there is room for it.
 * Returns CAMBER_ERROR_ARGUMENT (a position or a size that is out of range; vertical text along a line),
 * CAMBER_ERROR_LIMIT (more than 2^31 points), CAMBER_ERROR_MEMORY. After a failure the collection is as it was. */
CAMBER_API camber_status camber_text_rings_add(camber_text_rings *rings, const camber_text *text,
                                               const camber_text_position *position, camber_text_box *box);
/* Removes what the last call of camber_text_rings_add has added. A second call does nothing. */
CAMBER_API void camber_text_rings_remove_last(camber_text_rings *rings);
/* Removes everything. Memory is kept for the next texts. */
CAMBER_API void camber_text_rings_clear(camber_text_rings *rings);
/* Returns the rings as polylines whose last point is their first, in the order in which they were added. They are valid
 * until the collection changes. */
CAMBER_API camber_polylines_desc camber_text_rings_get(const camber_text_rings *rings);

#ifdef __cplusplus
}
#endif

#endif
