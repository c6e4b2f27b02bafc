/* Shapes items. HarfBuzz shapes them if a font draws them. A glyph of a range draws one character. */
#include "text/fonts.h"
#include "text/scripts.h"

#include <fribidi.h>

/* How far the top of the line that glyphs of ranges have is above the top of the square in which they stand upright, as
 * in MapLibre. */
static const float UPRIGHT_TOP_EM = 7.0f / 24.0f;

static camber_item_glyph *add_glyph(camber_fonts *fonts) {
    camber_shaping *shaping = &fonts->shaping;
    if (!camber_grow(fonts->context, &shaping->glyphs, &shaping->glyph_capacity, shaping->glyph_count + 1,
                     sizeof *shaping->glyphs))
        return NULL;
    camber_item_glyph *made = &shaping->glyphs[shaping->glyph_count++];
    *made = (camber_item_glyph){0};
    return made;
}

/* ---- Glyphs of ranges ---- */

/* Whether there are glyphs for all forms that differ from the characters. */
static bool has_forms(const camber_glyph_source *source, const uint32_t *codes, const uint32_t *forms, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (forms[i] != codes[i] && forms[i] != FRIBIDI_CHAR_FILL && !camber_glyph_source_has(source, forms[i]))
            return false;
    return true;
}

/* Replaces Arabic letters by the forms in which they join their neighbours, with ligatures if there are glyphs for
 * these. */
static bool join_letters(camber_fonts *fonts, const camber_text_item *item, uint32_t *forms) {
    camber_context *context = fonts->context;
    const uint32_t *codes = fonts->shaping.codes + item->first;
    const size_t count = item->end - item->first;
    FriBidiArabicProp *properties = camber_alloc(context, count, sizeof *properties);
    FriBidiLevel *levels = properties ? camber_alloc(context, count, sizeof *levels) : NULL;
    FriBidiCharType *types = levels ? camber_alloc(context, count, sizeof *types) : NULL;
    const bool has_memory = types != NULL;
    for (int attempt = 0; has_memory && attempt < 2; attempt++) {
        memcpy(forms, codes, count * sizeof *forms);
        memset(levels, fonts->shaping.characters[item->first].level & 1, count);
        fribidi_get_bidi_types(codes, (FriBidiStrIndex)count, types);
        fribidi_get_joining_types(codes, (FriBidiStrIndex)count, properties);
        fribidi_join_arabic(types, (FriBidiStrIndex)count, levels, properties);
        fribidi_shape_arabic(attempt ? FRIBIDI_FLAG_SHAPE_ARAB_PRES : FRIBIDI_FLAGS_ARABIC, levels,
                             (FriBidiStrIndex)count, properties, forms);
        if (has_forms(&fonts->sources[item->source], codes, forms, count))
            break;
    }
    camber_free(context, properties);
    camber_free(context, levels);
    camber_free(context, types);
    return has_memory;
}

/* Returns the code point whose glyph draws a character. */
static uint32_t choose_form(const camber_glyph_source *source, uint32_t code, uint32_t form, bool is_reversed,
                            bool is_upright) {
    FriBidiChar mirrored;
    const uint32_t vertical = is_upright ? camber_get_vertical_form(code) : 0;
    if (vertical && camber_glyph_source_has(source, vertical))
        return vertical;
    if (is_reversed && fribidi_get_mirror_char(code, &mirrored) && camber_glyph_source_has(source, mirrored))
        return mirrored;
    return form == FRIBIDI_CHAR_FILL || camber_glyph_source_has(source, form) ? form : code;
}

static camber_status add_range_glyph(camber_fonts *fonts, const camber_text_item *item, uint32_t character,
                                     uint32_t form) {
    const camber_shaping *shaping = &fonts->shaping;
    const camber_glyph_source *source = &fonts->sources[item->source];
    const uint32_t code = shaping->codes[character];
    const uint32_t chosen = choose_form(source, code, form, shaping->characters[character].level & 1, item->is_upright);
    if (chosen == FRIBIDI_CHAR_FILL || camber_is_invisible(code) || !camber_glyph_source_has(source, chosen))
        return CAMBER_OK;
    camber_item_glyph *glyph = add_glyph(fonts);
    if (!glyph)
        return CAMBER_ERROR_MEMORY;
    glyph->number = chosen;
    glyph->character = character;
    glyph->ends_cluster = true;
    glyph->advance = camber_glyph_ranges_advance_em(source->ranges, chosen);
    glyph->is_turned = item->is_upright && chosen == code && camber_turns_without_form(code);
    if (item->is_upright && !glyph->is_turned) {
        /* The glyph is in a square with sides of one em. */
        glyph->x = -0.5f * glyph->advance;
        glyph->y = source->ranges->ascender_em - UPRIGHT_TOP_EM;
        glyph->advance = 1.0f;
    }
    return CAMBER_OK;
}

static camber_status shape_ranges(camber_fonts *fonts, const camber_text_item *item) {
    const size_t count = item->end - item->first;
    const bool is_reversed = fonts->shaping.characters[item->first].level & 1;
    uint32_t *forms = NULL;
    camber_status status = CAMBER_OK;
    if (fonts->shaping.has_cursive) {
        forms = camber_alloc(fonts->context, count, sizeof *forms);
        if (!forms || !join_letters(fonts, item, forms))
            status = CAMBER_ERROR_MEMORY;
    }
    for (size_t i = 0; i < count && !status; i++) {
        const size_t at = is_reversed ? count - 1 - i : i;
        status = add_range_glyph(fonts, item, item->first + (uint32_t)at,
                                 forms ? forms[at] : fonts->shaping.codes[item->first + at]);
    }
    camber_free(fonts->context, forms);
    return status;
}

/* ---- Glyphs of fonts ---- */

static void fill_buffer(camber_shaping *shaping, const camber_text_desc *desc, const camber_text_item *item) {
    const camber_character *first = &shaping->characters[item->first];
    hb_buffer_clear_contents(shaping->buffer);
    hb_buffer_set_flags(shaping->buffer, HB_BUFFER_FLAG_REMOVE_DEFAULT_IGNORABLES);
    hb_buffer_add_codepoints(shaping->buffer, shaping->codes, (int)shaping->count, item->first,
                             (int)(item->end - item->first));
    hb_buffer_set_direction(shaping->buffer, item->is_upright     ? HB_DIRECTION_TTB
                                             : (first->level & 1) ? HB_DIRECTION_RTL
                                                                  : HB_DIRECTION_LTR);
    hb_buffer_set_script(shaping->buffer, first->script);
    if (desc->language)
        hb_buffer_set_language(shaping->buffer, hb_language_from_string(desc->language, -1));
}

/* In vertical lines, turns a bracket if the font has no vertical form for it. */
static void turn_glyph(const camber_shaping *shaping, const camber_face *face, camber_item_glyph *glyph) {
    const uint32_t code = shaping->codes[glyph->character];
    hb_codepoint_t nominal;
    if (!camber_turns_without_form(code) || !hb_font_get_nominal_glyph(face->font, code, &nominal) ||
        nominal != glyph->number)
        return;
    glyph->is_turned = true;
    glyph->x = glyph->y = 0.0f;
    glyph->advance = (float)hb_font_get_glyph_h_advance(face->font, nominal) / face->units_per_em;
}

static camber_status read_buffer(camber_fonts *fonts, const camber_text_item *item) {
    camber_shaping *shaping = &fonts->shaping;
    const camber_face *face = fonts->sources[item->source].face;
    unsigned count = 0;
    const hb_glyph_info_t *infos = hb_buffer_get_glyph_infos(shaping->buffer, &count);
    const hb_glyph_position_t *positions = hb_buffer_get_glyph_positions(shaping->buffer, NULL);
    const float scale = 1.0f / face->units_per_em;
    for (unsigned i = 0; i < count; i++) {
        camber_item_glyph *glyph = add_glyph(fonts);
        if (!glyph)
            return CAMBER_ERROR_MEMORY;
        *glyph = (camber_item_glyph){
            .number = infos[i].codepoint,
            .character = infos[i].cluster,
            .x = (float)positions[i].x_offset * scale,
            .y = (float)-positions[i].y_offset * scale,
            .advance = (float)(item->is_upright ? -positions[i].y_advance : positions[i].x_advance) * scale,
            .is_unsafe_to_break = hb_glyph_info_get_glyph_flags(&infos[i]) & HB_GLYPH_FLAG_UNSAFE_TO_BREAK,
            .ends_cluster = i + 1 == count || infos[i + 1].cluster != infos[i].cluster};
        if (item->is_upright)
            turn_glyph(shaping, face, glyph);
    }
    return CAMBER_OK;
}

static camber_status shape_face(camber_fonts *fonts, const camber_text_desc *desc, const camber_text_item *item) {
    static const hb_feature_t apart[] = {
        {HB_TAG('l', 'i', 'g', 'a'), 0, HB_FEATURE_GLOBAL_START, HB_FEATURE_GLOBAL_END},
        {HB_TAG('c', 'l', 'i', 'g'), 0, HB_FEATURE_GLOBAL_START, HB_FEATURE_GLOBAL_END},
    };
    camber_shaping *shaping = &fonts->shaping;
    const bool is_spaced = camber_shaping_spacing(shaping, desc) != 0.0f;
    if (!shaping->buffer)
        shaping->buffer = hb_buffer_create();
    fill_buffer(shaping, desc, item);
    hb_shape(fonts->sources[item->source].face->font, shaping->buffer, apart,
             is_spaced ? sizeof apart / sizeof *apart : 0);
    if (!hb_buffer_allocation_successful(shaping->buffer)) {
        hb_buffer_destroy(shaping->buffer);
        shaping->buffer = NULL;
        return camber_fail(fonts->context, CAMBER_ERROR_MEMORY, "there is no memory to shape a text of %zu characters",
                           shaping->count);
    }
    return read_buffer(fonts, item);
}

/* ---- Items ---- */

static camber_status shape_image(camber_fonts *fonts, const camber_text_desc *desc, const camber_text_item *item) {
    const camber_text_run *run = &desc->runs[fonts->shaping.characters[item->first].run];
    camber_item_glyph *glyph = add_glyph(fonts);
    if (!glyph)
        return CAMBER_ERROR_MEMORY;
    glyph->character = item->first;
    glyph->ends_cluster = true;
    glyph->advance = desc->vertical ? run->image_height_em : run->image_width_em;
    return CAMBER_OK;
}

camber_status camber_shaping_shape_item(camber_fonts *fonts, const camber_text_desc *desc, camber_text_item *item) {
    const camber_shaping *shaping = &fonts->shaping;
    camber_status status = CAMBER_OK;
    item->glyph = shaping->glyph_count;
    if (shaping->characters[item->first].is_image)
        status = shape_image(fonts, desc, item);
    else if (item->source != CAMBER_NO_SOURCE && fonts->sources[item->source].face)
        status = shape_face(fonts, desc, item);
    else if (item->source != CAMBER_NO_SOURCE)
        status = shape_ranges(fonts, item);
    item->glyph_count = shaping->glyph_count - item->glyph;
    return status;
}

camber_status camber_shaping_shape(camber_fonts *fonts, const camber_text_desc *desc) {
    camber_shaping *shaping = &fonts->shaping;
    for (size_t i = 0; i < shaping->item_count; i++) {
        camber_text_item *item = &shaping->items[i];
        const camber_status status = camber_shaping_shape_item(fonts, desc, item);
        if (status)
            return status;
        const camber_character *first = &shaping->characters[item->first];
        const float scale = first->is_image ? 1.0f : camber_run_scale(&desc->runs[first->run]);
        for (size_t g = 0; g < item->glyph_count; g++) {
            const camber_item_glyph *glyph = &shaping->glyphs[item->glyph + g];
            shaping->characters[glyph->character].width_em += glyph->advance * scale;
        }
    }
    return CAMBER_OK;
}
