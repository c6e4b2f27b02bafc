/* Copies texts, and remembers those that were shaped, because the name of a street is needed at each zoom and in each
 * part of the map that is placed by itself.
 *
 * Input: a text, and what it depends on, as bytes. Output: copies of the text. Main idea: a text has one slot, which
 * the hash of its key chooses, and takes the place of the text that was there, so the memory is bounded. */
#include "text/fonts.h"

/* A longer text is not remembered; nor is one with a long key, since characters without glyphs make keys longer. */
enum { SLOTS = 16384, MOST_GLYPHS = 64, MOST_LINES = 64, MOST_KEY_BYTES = 2048 };

typedef struct remembered {
    uint64_t hash;
    void *key; /* key_size bytes; NULL: the slot is free */
    size_t key_size;
    camber_text *text;
} remembered;

struct camber_text_memo {
    remembered slots[SLOTS];
};

void camber_text_destroy(camber_text *text) {
    if (!text)
        return;
    camber_context *context = text->context;
    camber_free(context, text->glyphs);
    camber_free(context, text->lines);
    camber_free(context, text);
}

static void forget(camber_context *context, remembered *slot) {
    camber_free(context, slot->key);
    camber_text_destroy(slot->text);
    *slot = (remembered){0};
}

void camber_text_memo_free(camber_context *context, struct camber_text_memo *memo) {
    for (size_t i = 0; memo && i < SLOTS; i++)
        forget(context, memo->slots + i);
    camber_free(context, memo);
}

static camber_text *copy_text(const camber_text *text) {
    camber_context *context = text->context;
    camber_text *copy = camber_alloc_zero(context, 1, sizeof *copy);
    if (!copy)
        return NULL;
    *copy = *text;
    copy->glyphs = camber_alloc(context, text->glyph_count, sizeof *copy->glyphs);
    copy->lines = copy->glyphs ? camber_alloc(context, text->line_count, sizeof *copy->lines) : NULL;
    if (!copy->lines) {
        camber_text_destroy(copy);
        return NULL;
    }
    if (text->glyph_count)
        memcpy(copy->glyphs, text->glyphs, text->glyph_count * sizeof *copy->glyphs);
    if (text->line_count)
        memcpy(copy->lines, text->lines, text->line_count * sizeof *copy->lines);
    return copy;
}

static remembered *slot_of(camber_fonts *fonts, const camber_text_key *key) {
    if (!fonts->memo && !(fonts->memo = camber_alloc_zero(fonts->context, 1, sizeof *fonts->memo)))
        return NULL;
    return fonts->memo->slots + (key->hash ^ key->hash >> 32) % SLOTS;
}

camber_status camber_text_memo_find(camber_fonts *fonts, const camber_text_key *key, bool *found, camber_text **text) {
    const remembered *slot = slot_of(fonts, key);
    if (!slot)
        return CAMBER_ERROR_MEMORY;
    *found = slot->key && slot->hash == key->hash && slot->key_size == key->size_bytes &&
             memcmp(slot->key, key->bytes, key->size_bytes) == 0;
    return !*found || (*text = copy_text(slot->text)) ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

camber_status camber_text_memo_put(camber_fonts *fonts, const camber_text_key *key, const camber_text *text) {
    remembered *slot = slot_of(fonts, key);
    if (!slot)
        return CAMBER_ERROR_MEMORY;
    if (text->glyph_count > MOST_GLYPHS || text->line_count > MOST_LINES || key->size_bytes > MOST_KEY_BYTES)
        return CAMBER_OK;
    forget(fonts->context, slot);
    if (!(slot->key = camber_alloc(fonts->context, key->size_bytes, 1)) || !(slot->text = copy_text(text))) {
        forget(fonts->context, slot);
        return CAMBER_ERROR_MEMORY;
    }
    memcpy(slot->key, key->bytes, key->size_bytes);
    slot->key_size = key->size_bytes;
    slot->hash = key->hash;
    return CAMBER_OK;
}
