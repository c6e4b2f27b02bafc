/* Reads the runs of a text as characters. */
#include "text/scripts.h"
#include "text/shaping.h"

static const size_t MOST_BYTES = (size_t)1 << 20;

void camber_shaping_free(camber_context *context, camber_shaping *shaping) {
    camber_free(context, shaping->codes);
    camber_free(context, shaping->characters);
    camber_free(context, shaping->levels);
    camber_free(context, shaping->order);
    camber_free(context, shaping->items);
    camber_free(context, shaping->glyphs);
    camber_free(context, shaping->lines);
    camber_free(context, shaping->pieces);
    camber_free(context, shaping->breaks);
    camber_free(context, shaping->stacks);
    hb_buffer_destroy(shaping->buffer);
}

/* Reads a character, and returns how many bytes it takes. A byte that is not UTF-8 is read as U+FFFD. */
static size_t read_code(const unsigned char *text, size_t left, uint32_t *code) {
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    const size_t size = text[0] < 0x80 ? 1 : text[0] < 0xc2 ? 0 : text[0] < 0xe0 ? 2 : text[0] < 0xf0 ? 3 : 4;
    uint32_t value = size == 1 ? text[0] : text[0] & (0x7fu >> size);
    *code = 0xfffd;
    if (size == 0 || size > left || text[0] > 0xf4)
        return 1;
    for (size_t i = 1; i < size; i++) {
        if ((text[i] & 0xc0) != 0x80)
            return 1;
        value = value << 6 | (text[i] & 0x3f);
    }
    if (value < least[size] || value > 0x10ffff || (value >= 0xd800 && value <= 0xdfff))
        return 1;
    *code = value;
    return size;
}

static bool is_left_out(uint32_t code) {
    return (code < ' ' && code != '\n') || (code >= 0x7f && code <= 0x9f) || code == 0xfeff ||
           (code >= 0xfdd0 && code <= 0xfdef) || (code & 0xfffe) == 0xfffe;
}

static bool is_mark(uint32_t code) {
    if (code < 0x300)
        return false;
    const hb_unicode_general_category_t category = hb_unicode_general_category(hb_unicode_funcs_get_default(), code);
    return category == HB_UNICODE_GENERAL_CATEGORY_NON_SPACING_MARK ||
           category == HB_UNICODE_GENERAL_CATEGORY_SPACING_MARK ||
           category == HB_UNICODE_GENERAL_CATEGORY_ENCLOSING_MARK || code == 0x200d || code == 0x200c;
}

/* Unicode's separators of lines and paragraphs. */
static bool is_separator(uint32_t code) {
    return (code >= 0x1c && code <= 0x1e) || code == 0x85 || code == 0x2028 || code == 0x2029;
}

/* Whether a paragraph with this character may run from right to left. */
static bool is_right_to_left(uint32_t code) {
    return (code >= 0x590 && code <= 0x8ff) || (code >= 0x200f && code <= 0x202e && code != 0x2010) ||
           (code >= 0x2066 && code <= 0x2069) || (code >= 0xfb1d && code <= 0xfdff) ||
           (code >= 0xfe70 && code <= 0xfeff) || (code >= 0x10800 && code <= 0x10fff) ||
           (code >= 0x1e800 && code <= 0x1efff);
}

static void add(camber_shaping *shaping, uint32_t code, uint32_t run, uint32_t byte) {
    camber_character *made = &shaping->characters[shaping->count];
    shaping->codes[shaping->count++] = code;
    *made = (camber_character){.run = run, .byte = byte, .is_mark = is_mark(code)};
    made->script = code < 0x80 && (code | 32) >= 'a' && (code | 32) <= 'z'
                       ? HB_SCRIPT_LATIN
                       : hb_unicode_script(hb_unicode_funcs_get_default(), code);
    shaping->has_right_to_left = shaping->has_right_to_left || is_right_to_left(code);
    shaping->has_cursive = shaping->has_cursive || camber_is_cursive(code);
}

camber_status camber_shaping_read(camber_context *context, camber_shaping *shaping, const camber_text_desc *desc) {
    size_t most = 0;
    shaping->count = shaping->item_count = shaping->glyph_count = shaping->line_count = 0;
    shaping->has_right_to_left = shaping->has_cursive = false;
    for (size_t i = 0; i < desc->run_count; i++) {
        const size_t size_bytes = desc->runs[i].text ? desc->runs[i].size_bytes : 1;
        if (size_bytes > MOST_BYTES - most)
            return camber_fail(context, CAMBER_ERROR_LIMIT, "a text has more than %zu bytes", MOST_BYTES);
        most += size_bytes;
    }
    if (!camber_grow(context, &shaping->codes, &shaping->code_capacity, most, sizeof *shaping->codes) ||
        !camber_grow(context, &shaping->characters, &shaping->character_capacity, most, sizeof *shaping->characters))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < desc->run_count; i++) {
        const camber_text_run *run = &desc->runs[i];
        uint32_t code;
        if (!run->text) {
            add(shaping, CAMBER_IMAGE_CODE, (uint32_t)i, 0);
            shaping->characters[shaping->count - 1].is_image = true;
            shaping->characters[shaping->count - 1].script = HB_SCRIPT_COMMON;
        }
        for (size_t at = 0, size; run->text && at < run->size_bytes; at += size) {
            size = read_code((const unsigned char *)run->text + at, run->size_bytes - at, &code);
            if (is_separator(code))
                code = '\n';
            if (!is_left_out(code))
                add(shaping, code, (uint32_t)i, (uint32_t)at);
        }
    }
    return CAMBER_OK;
}
