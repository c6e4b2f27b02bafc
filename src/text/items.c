/* Cuts a text into items: stretches that one source draws, in one script and one direction. */
#include "text/fonts.h"
#include "text/scripts.h"

/* HarfBuzz searches for the letter of each mark, in time quadratic in the marks: longer clusters and items are cut. */
enum { MOST_OF_CLUSTER = 32, MOST_OF_ITEM = 1 << 13 };

/* Returns the end of a cluster: of a character with the marks on it. */
static size_t find_cluster_end(const camber_shaping *shaping, size_t first) {
    size_t end = first + 1;
    while (end < shaping->count && shaping->codes[first] != '\n' && end - first < MOST_OF_CLUSTER &&
           shaping->characters[end].is_mark && !shaping->characters[first].is_image &&
           shaping->characters[end].run == shaping->characters[first].run)
        end++;
    return end;
}

static camber_status choose_source(camber_fonts *fonts, size_t first, size_t end) {
    camber_shaping *shaping = &fonts->shaping;
    camber_character *characters = shaping->characters;
    const uint32_t stack = shaping->stacks[characters[first].run];
    uint32_t visible[MOST_OF_CLUSTER], source = CAMBER_NO_SOURCE;
    size_t visible_count = 0;
    camber_status status = CAMBER_OK;
    for (size_t i = first; i < end; i++)
        if (!camber_is_invisible(shaping->codes[i]))
            visible[visible_count++] = shaping->codes[i];
    if (visible_count && !characters[first].is_image)
        status = camber_fonts_find_source(fonts, stack, visible, visible_count, &source);
    else if (shaping->codes[first] != '\n' && first && !characters[first].is_image &&
             characters[first - 1].run == characters[first].run)
        source = characters[first - 1].source;
    for (size_t i = first; i < end && !status; i++)
        characters[i].source = source;
    return status;
}

/* Gives characters that all scripts share, such as spaces, the script of the character before them or, at the beginning
 * of a text, after them. */
static void spread_scripts(camber_shaping *shaping) {
    hb_script_t script = HB_SCRIPT_COMMON;
    for (size_t i = 0; i < shaping->count && script == HB_SCRIPT_COMMON; i++) {
        const hb_script_t own = shaping->characters[i].script;
        if (own != HB_SCRIPT_INHERITED && own != HB_SCRIPT_UNKNOWN)
            script = own;
    }
    for (size_t i = 0; i < shaping->count; i++) {
        const hb_script_t own = shaping->characters[i].script;
        if (own == HB_SCRIPT_COMMON || own == HB_SCRIPT_INHERITED || own == HB_SCRIPT_UNKNOWN)
            shaping->characters[i].script = script;
        else
            script = own;
    }
}

static bool is_same_item(const camber_character *a, const camber_character *b) {
    return a->run == b->run && a->source == b->source && a->script == b->script && a->level == b->level &&
           !a->is_image && !b->is_image && a->is_upright == b->is_upright && !b->begins_item;
}

/* Guesses the language of a text for which none is given: ideographs with kana are Japanese, with hangul Korean. */
static const char *guess_language(const camber_shaping *shaping) {
    bool has_ideographs = false;
    for (size_t i = 0; i < shaping->count; i++) {
        const hb_script_t script = shaping->characters[i].script;
        if (script == HB_SCRIPT_HIRAGANA || script == HB_SCRIPT_KATAKANA)
            return "ja";
        if (script == HB_SCRIPT_HANGUL)
            return "ko";
        has_ideographs = has_ideographs || script == HB_SCRIPT_HAN;
    }
    return has_ideographs ? "zh" : NULL;
}

static camber_status find_stacks(camber_fonts *fonts, const camber_text_desc *desc) {
    camber_shaping *shaping = &fonts->shaping;
    const char *language = desc->language ? desc->language : guess_language(shaping);
    camber_status status = CAMBER_OK;
    if (!camber_grow(fonts->context, &shaping->stacks, &shaping->stack_capacity, desc->run_count,
                     sizeof *shaping->stacks))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < desc->run_count && !status; i++) {
        const camber_text_run *run = &desc->runs[i];
        shaping->stacks[i] = 0;
        if (run->text)
            status = camber_fonts_find_stack(fonts, run->fonts, run->font_count, language, &shaping->stacks[i]);
    }
    return status;
}

/* Whether a character next to punctuation lets it take its vertical form: all but those that are turned do. */
static bool lets_turn(const camber_shaping *shaping, size_t i) {
    return i >= shaping->count || shaping->codes[i] == '\n' || camber_is_upright(shaping->codes[i]) ||
           camber_get_vertical_form(shaping->codes[i]);
}

/* Decides how a cluster stands in a vertical line. Punctuation that other scripts have, too, such as a quotation mark,
 * takes its vertical form between ideographs. */
static void set_upright(camber_fonts *fonts, size_t first, size_t end) {
    camber_shaping *shaping = &fonts->shaping;
    const uint32_t code = shaping->codes[first], source = shaping->characters[first].source;
    const uint32_t form = camber_get_vertical_form(code);
    bool is_upright = camber_is_upright(code);
    if (!is_upright && form && source != CAMBER_NO_SOURCE && end == first + 1 && lets_turn(shaping, first - 1) &&
        lets_turn(shaping, end) && camber_glyph_source_has(&fonts->sources[source], form)) {
        shaping->codes[first] = form;
        is_upright = true;
    }
    for (size_t i = first; i < end; i++)
        shaping->characters[i].is_upright = is_upright;
}

camber_status camber_shaping_itemize(camber_fonts *fonts, const camber_text_desc *desc) {
    camber_shaping *shaping = &fonts->shaping;
    camber_character *characters = shaping->characters;
    camber_status status = find_stacks(fonts, desc);
    for (size_t first = 0, end; first < shaping->count && !status; first = end) {
        end = find_cluster_end(shaping, first);
        status = choose_source(fonts, first, end);
        characters[first].begins_item = characters[first].is_mark;
        if (desc->vertical && !status)
            set_upright(fonts, first, end);
    }
    spread_scripts(shaping);
    for (size_t first = 0, end; first < shaping->count && !status; first = end) {
        for (end = first + 1;
             end < shaping->count && end - first < MOST_OF_ITEM && is_same_item(&characters[first], &characters[end]);
             end++)
            ;
        if (!camber_grow(fonts->context, &shaping->items, &shaping->item_capacity, shaping->item_count + 1,
                         sizeof *shaping->items))
            return CAMBER_ERROR_MEMORY;
        shaping->items[shaping->item_count++] = (camber_text_item){.first = (uint32_t)first,
                                                                   .end = (uint32_t)end,
                                                                   .source = characters[first].source,
                                                                   .is_upright = characters[first].is_upright};
    }
    return status;
}
