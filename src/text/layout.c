/* Gives the glyphs of lines their positions. Along a line, each glyph is one advance after the previous one. Across it,
 * as in MapLibre, the ems of a line's runs have the same bottom, and their top is 17/24 em above the middle of the
 * line:
 *
 *     ---------------  top of the ems = middle - 17/24 em
 *      |   | --- |  |
 *      |---| |   |  |  <- middle of the line
 *      |   | --- |__|
 *     --------- baseline = top + ascender of the first font -------
 *
 * All text is laid out in horizontal lines first: u along a line, v across it. Vertical text is turned by 90 degrees
 * clockwise at the end, so that x = -v and y = u. */
#include "text/fonts.h"
#include "text/scripts.h"

#include <math.h>

/* Whether an item begins or ends at the character, or can be cut before it. */
static bool is_at_boundary(const camber_shaping *shaping, const camber_text_item *item, uint32_t character) {
    if (character == item->first || character == item->end)
        return true;
    for (size_t i = item->glyph; i < item->glyph + item->glyph_count; i++)
        if (shaping->glyphs[i].character == character)
            return !shaping->glyphs[i].is_unsafe_to_break;
    return false;
}

/* Adds the part of an item between two characters to the line. If the item can be cut at both characters, the part
 * keeps the item's glyphs; otherwise it is shaped again. */
static camber_status add_piece(camber_fonts *fonts, const camber_text_desc *desc, const camber_text_item *item,
                               camber_line_break part) {
    camber_shaping *shaping = &fonts->shaping;
    if (!camber_grow(fonts->context, &shaping->pieces, &shaping->piece_capacity, shaping->piece_count + 1,
                     sizeof *shaping->pieces))
        return CAMBER_ERROR_MEMORY;
    camber_text_item *piece = &shaping->pieces[shaping->piece_count++];
    *piece = *item;
    piece->first = part.first;
    piece->end = part.end;
    if (!is_at_boundary(shaping, item, part.first) || !is_at_boundary(shaping, item, part.end))
        return camber_shaping_shape_item(fonts, desc, piece);
    size_t first = item->glyph, end = item->glyph + item->glyph_count;
    const camber_item_glyph *glyphs = shaping->glyphs;
    while (first < end && (glyphs[first].character < part.first || glyphs[first].character >= part.end))
        first++;
    while (end > first && (glyphs[end - 1].character < part.first || glyphs[end - 1].character >= part.end))
        end--;
    piece->glyph = first;
    piece->glyph_count = end - first;
    return CAMBER_OK;
}

/* Finds a line's pieces and the order in which they are drawn. */
static camber_status find_pieces(camber_fonts *fonts, const camber_text_desc *desc, camber_line_break line,
                                 size_t *item) {
    camber_shaping *shaping = &fonts->shaping;
    camber_status status = CAMBER_OK;
    shaping->piece_count = 0;
    while (*item < shaping->item_count && shaping->items[*item].end <= line.first)
        ++*item;
    for (size_t i = *item; i < shaping->item_count && shaping->items[i].first < line.end && !status; i++) {
        const camber_text_item *of = &shaping->items[i];
        const camber_line_break part = {of->first > line.first ? of->first : line.first,
                                        of->end < line.end ? of->end : line.end};
        status = add_piece(fonts, desc, of, part);
    }
    const size_t count = shaping->piece_count;
    if (status || !camber_grow(fonts->context, &shaping->levels, &shaping->level_capacity, count, 1) ||
        !camber_grow(fonts->context, &shaping->order, &shaping->order_capacity, count, sizeof *shaping->order))
        return status ? status : CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++)
        shaping->levels[i] = shaping->characters[shaping->pieces[i].first].level;
    camber_bidi_find_order(shaping->levels, count, shaping->order);
    return CAMBER_OK;
}

typedef struct layout {
    camber_fonts *fonts;
    const camber_text_desc *desc;
    camber_text *text;
    size_t glyph_capacity;
    float spacing, ascender_em;
    float scale, content_em; /* the line's largest scale, and the height of its highest run or image */
    float u, v;              /* v: the top of the line's ems */
} layout;

static float get_align_share(camber_text_align align) {
    return align == CAMBER_ALIGN_TOP ? 0.0f : align == CAMBER_ALIGN_CENTER ? 0.5f : 1.0f;
}

/* Returns where a run's baseline is across the line; for an image, where its top is. */
static float get_across(const layout *l, const camber_text_run *run) {
    const float share = get_align_share(run->align);
    if (!run->text) {
        const float size = l->desc->vertical ? run->image_width_em : run->image_height_em;
        return l->v + (l->content_em - size) * share;
    }
    const float scale = camber_run_scale(run);
    if (run->align == CAMBER_ALIGN_BOTTOM) /* all on one baseline */
        return l->v + l->content_em - l->scale + l->ascender_em * l->scale;
    return l->v + (l->content_em - scale) * share + l->ascender_em * scale;
}

static camber_status add_glyph(layout *l, const camber_text_item *piece, const camber_item_glyph *glyph) {
    const camber_character *character = &l->fonts->shaping.characters[glyph->character];
    const camber_text_run *run = &l->desc->runs[character->run];
    const float scale = run->text ? camber_run_scale(run) : 1.0f;
    camber_text *text = l->text;
    camber_text_glyph made = {.glyph = CAMBER_NO_GLYPH, .run = character->run, .byte = character->byte, .scale = scale};
    camber_status status = CAMBER_OK;
    if (run->text)
        status = camber_fonts_find_glyph(l->fonts, piece->source, glyph->number, &made.glyph);
    if (status ||
        !camber_grow(l->fonts->context, &text->glyphs, &l->glyph_capacity, text->glyph_count + 1, sizeof *text->glyphs))
        return status ? status : CAMBER_ERROR_MEMORY;
    const float across = get_across(l, run);
    made.advance = glyph->advance * scale + (glyph->ends_cluster ? l->spacing : 0.0f);
    made.x = l->u + glyph->x * scale;
    made.y = across + glyph->y * scale;
    if (l->desc->vertical && !run->text) {
        made.x = -across - run->image_width_em;
        made.y = l->u;
    } else if (l->desc->vertical && (!piece->is_upright || glyph->is_turned)) {
        const float x = made.x;
        made.x = -made.y;
        made.y = x;
        made.turned = true;
    } else if (l->desc->vertical) {
        /* The pen of an upright glyph is in the middle of the line. */
        made.x = -(l->v + l->content_em - l->scale - CAMBER_LINE_TOP_EM * l->scale) + glyph->x * scale;
        made.y = l->u + glyph->y * scale;
    }
    l->u += made.advance;
    text->glyphs[text->glyph_count++] = made;
    return CAMBER_OK;
}

/* Finds how high a line is: its scale and its content. */
static void measure_line(layout *l, camber_line_break line) {
    const camber_character *characters = l->fonts->shaping.characters;
    l->scale = l->content_em = 0.0f;
    for (uint32_t i = line.first; i < line.end; i++) {
        const camber_text_run *run = &l->desc->runs[characters[i].run];
        const float scale = camber_run_scale(run);
        const float height = run->text ? scale : l->desc->vertical ? run->image_width_em : run->image_height_em;
        l->scale = fmaxf(l->scale, scale);
        l->content_em = fmaxf(l->content_em, height);
    }
    l->content_em = fmaxf(l->content_em, l->scale);
}

/* Adds a line's glyphs, and sets *width to its length without the last spacing. It is negative if the spacing is so
 * small that the line runs back. */
static camber_status add_line(layout *l, camber_line_break line, size_t *item, float *width) {
    camber_shaping *shaping = &l->fonts->shaping;
    camber_status status = find_pieces(l->fonts, l->desc, line, item);
    const size_t first = l->text->glyph_count;
    l->u = 0.0f;
    for (size_t i = 0; i < shaping->piece_count && !status; i++) {
        const camber_text_item piece = shaping->pieces[shaping->order[i]];
        for (size_t g = 0; g < piece.glyph_count && !status; g++)
            status = add_glyph(l, &piece, &shaping->glyphs[piece.glyph + g]);
    }
    *width = l->text->glyph_count > first ? l->u - l->spacing : 0.0f;
    return status;
}

/* ---- Anchors ---- */

/* Returns which fraction of the box's width is to the left of the anchor, and which fraction of its height is above it.
 */
static void get_anchor_shares(camber_text_anchor anchor, float *across, float *down) {
    static const float shares[][2] = {
        [CAMBER_ANCHOR_CENTER] = {0.5f, 0.5f},      [CAMBER_ANCHOR_LEFT] = {0.0f, 0.5f},
        [CAMBER_ANCHOR_RIGHT] = {1.0f, 0.5f},       [CAMBER_ANCHOR_TOP] = {0.5f, 0.0f},
        [CAMBER_ANCHOR_BOTTOM] = {0.5f, 1.0f},      [CAMBER_ANCHOR_TOP_LEFT] = {0.0f, 0.0f},
        [CAMBER_ANCHOR_TOP_RIGHT] = {1.0f, 0.0f},   [CAMBER_ANCHOR_BOTTOM_LEFT] = {0.0f, 1.0f},
        [CAMBER_ANCHOR_BOTTOM_RIGHT] = {1.0f, 1.0f}};
    *across = shares[anchor][0];
    *down = shares[anchor][1];
}

/* Returns which fraction of a line's free space is before the line. */
static float get_justify_share(const camber_text *text, camber_text_anchor anchor, camber_text_justify justify) {
    float across, down;
    get_anchor_shares(anchor, &across, &down);
    switch (justify) {
    case CAMBER_JUSTIFY_LEFT: return 0.0f;
    case CAMBER_JUSTIFY_RIGHT: return 1.0f;
    case CAMBER_JUSTIFY_AUTO: return text->vertical ? down : across;
    default: return 0.5f;
    }
}

/* Moves the lines to their anchor. Before that, each line and the block of lines begin at 0. sign: 1, or -1 to move the
 * lines back. */
static void move(camber_text *text, camber_text_anchor anchor, camber_text_justify justify, float sign) {
    const float longest = text->vertical ? text->bottom - text->top : text->right - text->left;
    const float share = get_justify_share(text, anchor, justify);
    float across, down;
    get_anchor_shares(anchor, &across, &down);
    const float width = text->right - text->left, height = text->bottom - text->top;
    for (size_t i = 0; i < text->line_count; i++) {
        const camber_text_line *line = &text->lines[i];
        const float along = (longest - line->width) * share;
        /* The block of vertical text begins at its right side. */
        const float dx = text->vertical ? (1.0f - across) * width : along - across * width;
        const float dy = text->vertical ? along - down * height : -down * height;
        for (size_t g = line->first; g < line->first + line->count; g++) {
            text->glyphs[g].x += sign * dx;
            text->glyphs[g].y += sign * dy;
        }
    }
    text->left = -across * width;
    text->top = -down * height;
    text->right = text->left + width;
    text->bottom = text->top + height;
    text->anchor = anchor;
    text->justify = justify;
}

void camber_text_place(camber_text *text, camber_text_anchor anchor, camber_text_justify justify) {
    move(text, text->anchor, text->justify, -1.0f);
    move(text, anchor, justify, 1.0f);
}

/* ---- Texts ---- */

/* Returns the ascender of the first run's font, which is used for all runs. */
static float find_ascender(const camber_fonts *fonts, const camber_text_desc *desc) {
    for (size_t i = 0; i < desc->run_count; i++)
        if (desc->runs[i].text)
            return fonts->stacks[fonts->shaping.stacks[i]].ascender_em;
    return 1.0f;
}

/* If all lines have the same height, MapLibre puts the ems in the middle of the line's height; otherwise at its top. */
static void center_lines(camber_text *text, float line_height) {
    const float shift = line_height / 2.0f + CAMBER_LINE_TOP_EM;
    for (size_t i = 0; i < text->glyph_count; i++)
        if (text->vertical)
            text->glyphs[i].x -= shift;
        else
            text->glyphs[i].y += shift;
}

camber_status camber_shaping_lay_out(camber_fonts *fonts, const camber_text_desc *desc, camber_text *text) {
    const camber_shaping *shaping = &fonts->shaping;
    const float line_height = desc->line_height_em > 0.0f ? desc->line_height_em : 1.2f;
    layout l = {.fonts = fonts, .desc = desc, .text = text, .spacing = camber_shaping_spacing(shaping, desc)};
    float longest = 0.0f, highest = 0.0f;
    camber_status status = CAMBER_OK;
    size_t item = 0;
    l.ascender_em = find_ascender(fonts, desc);
    text->line_height_em = line_height;
    text->letter_spacing_em = l.spacing;
    text->lines = camber_alloc(fonts->context, shaping->line_count, sizeof *text->lines);
    text->glyphs = text->lines ? camber_alloc(fonts->context, shaping->glyph_count, sizeof *text->glyphs) : NULL;
    if (!text->glyphs)
        return CAMBER_ERROR_MEMORY;
    l.glyph_capacity = shaping->glyph_count;
    for (size_t i = 0; i < shaping->line_count && !status; i++) {
        camber_text_line *line = &text->lines[text->line_count++];
        *line = (camber_text_line){.first = text->glyph_count};
        measure_line(&l, shaping->lines[i]);
        if (shaping->lines[i].first < shaping->lines[i].end)
            status = add_line(&l, shaping->lines[i], &item, &line->width);
        line->count = text->glyph_count - line->first;
        const float height = l.scale > 0.0f ? line_height * l.scale + l.content_em - l.scale : line_height;
        longest = fmaxf(longest, line->width);
        highest = fmaxf(highest, height);
        l.v += height;
    }
    if (status)
        return status;
    if (highest == line_height)
        center_lines(text, line_height);
    text->right = text->vertical ? l.v : longest;
    text->bottom = text->vertical ? longest : l.v;
    move(text, desc->anchor, desc->justify, 1.0f);
    return CAMBER_OK;
}
