/* Shapes the texts of labels, each wording once.
 *
 * Input: a symbol. Output: its text, and the same text written downwards if it may be. Main idea: classes differ in
 * more than names, so the name of one street is needed again and again; a table keeps the texts that were shaped. */
#include "map/label_layout.h"
#include "style/unicode.h"
#include "text/fonts.h"

#include <stdlib.h>

/* A text, and the key of what it was made from. */
typedef struct word {
    uint64_t hash;
    char *key; /* bytes */
    size_t key_size;
    camber_text *text;
    char *said; /* the characters of its runs, each with a 0 at its end */
} word;

struct camber_label_words {
    word *items;
    size_t count, capacity;
    uint32_t *slots; /* numbers + 1 by hash; 0: free. slot_count is a power of two */
    size_t slot_count;
    char *key; /* of the current text */
    size_t key_size, key_capacity;
    camber_arena arena; /* keys */
    camber_text_run *runs;
    size_t run_capacity;
};

/* The most memory for keys. */
#define KEY_LIMIT ((size_t)256 << 20)

static void free_word(camber_context *context, word *w) {
    camber_text_destroy(w->text);
    camber_free(context, w->said);
}

void camber_label_words_free(camber_label_layout *layout) {
    struct camber_label_words *words = layout->words;
    if (!words)
        return;
    for (size_t i = 0; i < words->count; i++)
        free_word(layout->context, words->items + i);
    camber_arena_free(&words->arena);
    camber_free(layout->context, words->items);
    camber_free(layout->context, words->slots);
    camber_free(layout->context, words->key);
    camber_free(layout->context, words->runs);
    camber_free(layout->context, words);
    layout->words = NULL;
}

static int compare_texts(const void *left, const void *right) {
    const camber_text *a, *b;
    memcpy(&a, left, sizeof a);
    memcpy(&b, right, sizeof b);
    return a < b ? -1 : a > b;
}

camber_status camber_label_words_keep(camber_label_layout *layout) {
    struct camber_label_words *words = layout->words;
    size_t used = 0, kept = 0;
    if (!words)
        return CAMBER_OK;
    const camber_text **texts = camber_alloc(layout->context, 2 * layout->form_count, sizeof *texts);
    if (!texts)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < layout->form_count; i++) {
        texts[used++] = layout->forms[i].text;
        texts[used++] = layout->forms[i].vertical;
    }
    if (used)
        qsort(texts, used, sizeof *texts, compare_texts);
    for (size_t i = 0; i < words->count; i++) {
        camber_text *text = words->items[i].text;
        if (used && bsearch(&text, texts, used, sizeof *texts, compare_texts))
            words->items[kept++] = words->items[i];
        else
            free_word(layout->context, words->items + i);
    }
    words->count = kept;
    camber_free(layout->context, texts);
    camber_arena_free(&words->arena);
    camber_free(layout->context, words->slots);
    words->slots = NULL;
    words->slot_count = 0;
    return CAMBER_OK;
}

static struct camber_label_words *words_of(camber_label_layout *layout) {
    if (!layout->words && (layout->words = camber_alloc_zero(layout->context, 1, sizeof *layout->words)))
        layout->words->arena = (camber_arena){.context = layout->context, .limit = KEY_LIMIT};
    return layout->words;
}

/* ---- The table ---- */

static bool put(camber_context *context, struct camber_label_words *words, const void *bytes, size_t size) {
    if (!camber_grow(context, &words->key, &words->key_capacity, words->key_size + size, 1))
        return false;
    if (size)
        memcpy(words->key + words->key_size, bytes, size);
    words->key_size += size;
    return true;
}

static bool put_text(camber_context *context, struct camber_label_words *words, const char *text) {
    return put(context, words, text ? text : "", text ? strlen(text) + 1 : 1);
}

/* Writes a text's key: everything that the text depends on. */
static bool write_key(camber_context *context, struct camber_label_words *words, const camber_text_desc *desc) {
    const double lengths[] = {(double)desc->max_width_em,
                              (double)desc->line_height_em,
                              (double)desc->letter_spacing_em,
                              desc->anchor,
                              desc->justify,
                              desc->vertical};
    words->key_size = 0;
    bool written = put(context, words, lengths, sizeof lengths) && put_text(context, words, desc->language);
    for (size_t i = 0; i < desc->run_count && written; i++) {
        const camber_text_run *run = desc->runs + i;
        const double numbers[] = {(double)run->scale, (double)run->image_width_em, (double)run->image_height_em,
                                  run->align,         run->text ? 1.0 : 0.0,       (double)run->font_count};
        written = put(context, words, numbers, sizeof numbers) && put_text(context, words, run->text);
        for (size_t f = 0; f < run->font_count && written; f++)
            written = put_text(context, words, run->fonts[f]);
    }
    return written;
}

static uint32_t *find_slot(const struct camber_label_words *words, uint64_t hash) {
    size_t at = (size_t)(hash ^ hash >> 32) & (words->slot_count - 1);
    for (; words->slots[at]; at = (at + 1) & (words->slot_count - 1)) {
        const word *w = words->items + words->slots[at] - 1;
        if (w->hash == hash && w->key_size == words->key_size && memcmp(w->key, words->key, w->key_size) == 0)
            break;
    }
    return words->slots + at;
}

static bool widen(camber_context *context, struct camber_label_words *words) {
    if (2 * (words->count + 1) <= words->slot_count)
        return true;
    const size_t count = words->slot_count ? 2 * words->slot_count : 256;
    uint32_t *slots = camber_alloc_zero(context, count, sizeof *slots);
    if (!slots)
        return false;
    camber_free(context, words->slots);
    words->slots = slots;
    words->slot_count = count;
    for (size_t i = 0; i < words->count; i++) {
        size_t at = (size_t)(words->items[i].hash ^ words->items[i].hash >> 32) & (count - 1);
        while (slots[at])
            at = (at + 1) & (count - 1);
        slots[at] = (uint32_t)i + 1;
    }
    return true;
}

/* Copies the characters of the runs; an image has none. */
static char *copy_said(camber_context *context, const camber_text_desc *desc) {
    size_t size = 1;
    for (size_t i = 0; i < desc->run_count; i++)
        size += desc->runs[i].size_bytes + 1;
    char *said = camber_alloc_zero(context, size, 1), *to = said;
    for (size_t i = 0; i < desc->run_count && said; i++) {
        if (desc->runs[i].size_bytes)
            memcpy(to, desc->runs[i].text, desc->runs[i].size_bytes);
        to += desc->runs[i].size_bytes + 1;
    }
    return said;
}

/* Finds the text of a desc in the table, or shapes it. NULL: the text would show nothing. *said receives its
 * characters.
 */
static camber_status shape(camber_label_layout *layout, const camber_text_desc *desc, camber_text **text,
                           const char **said) {
    camber_context *context = layout->context;
    struct camber_label_words *words = layout->words;
    if (!write_key(context, words, desc) || !widen(context, words))
        return CAMBER_ERROR_MEMORY;
    const uint64_t hash = camber_hash(CAMBER_HASH_START, words->key, words->key_size);
    uint32_t *slot = find_slot(words, hash);
    if (!*slot) {
        char *key = camber_arena_text(&words->arena, words->key, words->key_size);
        if (!key || !camber_grow(context, &words->items, &words->capacity, words->count + 1, sizeof *words->items))
            return camber_fail(context, CAMBER_ERROR_MEMORY, "labels: no memory for their texts");
        camber_text *made = NULL;
        const camber_text_key all = {words->key, words->key_size, hash};
        const camber_status status = camber_text_recall(layout->fonts, &all, desc, &made);
        if (status != CAMBER_OK)
            return status;
        char *copy = copy_said(context, desc);
        if (!copy) {
            camber_text_destroy(made);
            return CAMBER_ERROR_MEMORY;
        }
        words->items[words->count++] = (word){hash, key, words->key_size, made, copy};
        *slot = (uint32_t)words->count;
    }
    *text = words->items[*slot - 1].text;
    *said = words->items[*slot - 1].said;
    if ((*text)->glyph_count == 0)
        *text = NULL;
    return CAMBER_OK;
}

/* ---- Images ---- */

const camber_sprite_image *camber_label_find_image(const camber_label_layout *layout, const char *name) {
    const camber_sprite_image *image = layout->sprites ? camber_sprites_find(layout->sprites, name) : NULL;
    if (!image && layout->sprites)
        (void)camber_sprites_warn_missing(layout->sprites, name);
    return image && image->width && image->height ? image : NULL;
}

/* ---- Texts of symbols ---- */

/* Whether the script of a character may be written downwards with upright characters. */
static bool is_written_down(uint32_t code) {
    return (code >= 0x1100 && code <= 0x11ff) || (code >= 0x2e80 && code <= 0xa4cf) ||
           (code >= 0xa960 && code <= 0xa97f) || (code >= 0xac00 && code <= 0xd7ff) ||
           (code >= 0xf900 && code <= 0xfaff) || (code >= 0xfe30 && code <= 0xfe4f) ||
           (code >= 0xff01 && code <= 0xffe6) || (code >= 0x16fe0 && code <= 0x18aff) ||
           (code >= 0x1b000 && code <= 0x1b2ff) || (code >= 0x20000 && code <= 0x3ffff);
}

static bool may_be_vertical(const camber_symbol *symbol) {
    for (size_t i = 0; i < symbol->section_count; i++) {
        uint32_t code;
        for (const char *at = symbol->sections[i].text; at && *at; at += camber_unicode_read(at, &code)) {
            (void)camber_unicode_read(at, &code);
            if (is_written_down(code))
                return true;
        }
    }
    return false;
}

static bool make_runs(camber_label_layout *layout, const camber_symbol *symbol) {
    struct camber_label_words *words = layout->words;
    if (!camber_grow(layout->context, &words->runs, &words->run_capacity, symbol->section_count, sizeof *words->runs))
        return false;
    for (size_t i = 0; i < symbol->section_count; i++) {
        const camber_symbol_section *section = symbol->sections + i;
        const camber_sprite_image *image = section->image ? camber_label_find_image(layout, section->image) : NULL;
        const double em = symbol->text_size_px;
        words->runs[i] = (camber_text_run){
            .text = section->image  ? NULL
                    : section->text ? section->text
                                    : "",
            .size_bytes = !section->image && section->text ? strlen(section->text) : 0,
            .fonts = section->fonts,
            .font_count = section->font_count,
            .scale = (float)section->scale,
            .align = section->align,
            .image_width_em = image ? (float)(image->width / image->pixel_ratio * section->scale / em) : 0.0f,
            .image_height_em = image ? (float)(image->height / image->pixel_ratio * section->scale / em) : 0.0f};
        if (section->image && !image) /* a missing image leaves no gap */
            words->runs[i].text = "";
    }
    return true;
}

/* Returns the side that is on top after a quarter turn: texts that run downwards are anchored as if they were turned.
 */
static camber_text_anchor turn_anchor(camber_text_anchor anchor) {
    switch (anchor) {
    case CAMBER_ANCHOR_LEFT: return CAMBER_ANCHOR_TOP;
    case CAMBER_ANCHOR_TOP: return CAMBER_ANCHOR_RIGHT;
    case CAMBER_ANCHOR_RIGHT: return CAMBER_ANCHOR_BOTTOM;
    case CAMBER_ANCHOR_BOTTOM: return CAMBER_ANCHOR_LEFT;
    case CAMBER_ANCHOR_TOP_LEFT: return CAMBER_ANCHOR_TOP_RIGHT;
    case CAMBER_ANCHOR_TOP_RIGHT: return CAMBER_ANCHOR_BOTTOM_RIGHT;
    case CAMBER_ANCHOR_BOTTOM_RIGHT: return CAMBER_ANCHOR_BOTTOM_LEFT;
    case CAMBER_ANCHOR_BOTTOM_LEFT: return CAMBER_ANCHOR_TOP_LEFT;
    default: return CAMBER_ANCHOR_CENTER;
    }
}

static void hash_words(const camber_symbol *symbol, camber_label_form *form) {
    uint64_t hash = form->hash ? form->hash : CAMBER_HASH_START;
    for (size_t i = 0; i < symbol->section_count; i++) {
        const char *said = symbol->sections[i].text ? symbol->sections[i].text : symbol->sections[i].image;
        if (said)
            hash = camber_hash(hash, said, strlen(said));
    }
    form->hash = hash;
}

/* Adds how the sections of a text look, which its rule does not say. */
static void hash_looks(const camber_symbol *symbol, camber_label_form *form) {
    uint64_t hash = form->look_hash;
    for (size_t i = 0; i < symbol->section_count; i++) {
        const camber_symbol_section *s = symbol->sections + i;
        const char *shown = s->image ? s->image : s->text ? s->text : "";
        const double numbers[] = {s->image != NULL, s->scale, s->align, (double)s->font_count, s->has_color};
        hash = camber_hash(hash, numbers, sizeof numbers);
        if (s->has_color)
            hash = camber_hash(hash, &s->color, sizeof s->color);
        hash = camber_hash(hash, shown, strlen(shown) + 1);
        for (size_t f = 0; f < s->font_count; f++)
            hash = camber_hash(hash, s->fonts[f], strlen(s->fonts[f]) + 1);
    }
    form->look_hash = hash;
}

camber_status camber_label_text_make(camber_label_layout *layout, const camber_symbol *symbol,
                                     camber_label_form *form) {
    const camber_label_rule *rule = layout->rules + form->rule;
    if (!words_of(layout) || !make_runs(layout, symbol))
        return CAMBER_ERROR_MEMORY;
    camber_text_desc desc = {.runs = layout->words->runs,
                             .run_count = symbol->section_count,
                             .max_width_em =
                                 symbol->placement == CAMBER_SYMBOL_POINT ? (float)symbol->max_width_em : 0.0f,
                             .line_height_em = (float)symbol->line_height_em,
                             .letter_spacing_em = (float)symbol->letter_spacing_em,
                             .anchor = rule->variable ? CAMBER_ANCHOR_CENTER : symbol->text_anchor,
                             .justify = rule->text_along ? CAMBER_JUSTIFY_CENTER : symbol->justify};
    camber_status status = shape(layout, &desc, &form->text, &form->words);
    if (status != CAMBER_OK || !form->text)
        return status;
    hash_words(symbol, form);
    hash_looks(symbol, form);
    const bool down =
        rule->text_along ? symbol->text.keep_upright : symbol->vertical && symbol->placement == CAMBER_SYMBOL_POINT;
    if (!down || !may_be_vertical(symbol))
        return CAMBER_OK;
    desc.vertical = true;
    if (!rule->text_along) {
        desc.justify = CAMBER_JUSTIFY_LEFT;
        desc.anchor = turn_anchor(desc.anchor);
    }
    return shape(layout, &desc, &form->vertical, &form->words);
}
