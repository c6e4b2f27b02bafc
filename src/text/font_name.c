/* Splits the names of fonts. Words of a style are cut off the end of a name until its last word is not one: "Open Sans
 * Semibold Italic" is the family "Open Sans" with the weight 600, italic. Names are compared by their letters and
 * digits, since fonts and styles differ in case, spaces and hyphens. */
#include "text/font_name.h"

#include <ctype.h>
#include <math.h>

enum { NAME_SIZE = 128 }; /* letters and digits of a name that are compared */

typedef struct style_word {
    const char *word;
    float weight, width; /* 0: the word does not say */
    bool is_italic;
} style_word;

/* A word that ends with another word is listed before it. */
static const style_word words[] = {
    {"hairline", 100, 0, false},
    {"thin", 100, 0, false},
    {"extralight", 200, 0, false},
    {"ultralight", 200, 0, false},
    {"demilight", 350, 0, false},
    {"semilight", 350, 0, false},
    {"light", 300, 0, false},
    {"book", 400, 0, false},
    {"regular", 400, 0, false},
    {"normal", 400, 0, false},
    {"roman", 400, 0, false},
    {"medium", 500, 0, false},
    {"semibold", 600, 0, false},
    {"demibold", 600, 0, false},
    {"extrabold", 800, 0, false},
    {"ultrabold", 800, 0, false},
    {"bold", 700, 0, false},
    {"extrablack", 950, 0, false},
    {"ultrablack", 950, 0, false},
    {"black", 900, 0, false},
    {"heavy", 900, 0, false},
    {"italic", 0, 0, true},
    {"oblique", 0, 0, true},
    {"ultracondensed", 0, 50, false},
    {"extracondensed", 0, 62.5f, false},
    {"semicondensed", 0, 87.5f, false},
    {"condensed", 0, 75, false},
    {"narrow", 0, 75, false},
    {"semiexpanded", 0, 112.5f, false},
    {"expanded", 0, 125, false},
};

/* Appends the letters and digits of a name in lower case; bytes beyond ASCII stay as they are. */
static size_t append_plain(char plain[NAME_SIZE], size_t length, const char *name) {
    for (; name && *name && length < NAME_SIZE - 1; name++) {
        const unsigned char c = (unsigned char)*name;
        if (c >= 128 || isalnum(c))
            plain[length++] = (char)(c < 128 ? tolower(c) : c);
    }
    plain[length] = 0;
    return length;
}

static const style_word *find_last_word(const char *plain, size_t length) {
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        const size_t size = strlen(words[i].word);
        if (size < length && memcmp(plain + length - size, words[i].word, size) == 0)
            return &words[i];
    }
    return NULL;
}

static uint64_t key_of(const char *plain, size_t length) {
    static const char regular[] = "regular";
    const size_t size = sizeof regular - 1;
    if (length > size && memcmp(plain + length - size, regular, size) == 0)
        length -= size;
    return camber_hash(CAMBER_HASH_START, plain, length);
}

uint64_t camber_font_name_key(const char *a, const char *b) {
    char plain[NAME_SIZE];
    return key_of(plain, append_plain(plain, append_plain(plain, 0, a), b));
}

camber_font_name camber_font_name_split(const char *name) {
    char plain[NAME_SIZE];
    size_t length = append_plain(plain, 0, name);
    camber_font_name split = {.whole_key = key_of(plain, length), .style = CAMBER_FONT_STYLE_REGULAR};
    const style_word *word;
    while ((word = find_last_word(plain, length))) {
        if (word->weight > 0.0f)
            split.style.weight = word->weight;
        if (word->width > 0.0f)
            split.style.width = word->width;
        split.style.is_italic = split.style.is_italic || word->is_italic;
        length -= strlen(word->word);
    }
    split.family_key = key_of(plain, length);
    return split;
}

float camber_font_style_compare(const camber_font_style *a, const camber_font_style *b) {
    return fabsf(a->weight - b->weight) + 4.0f * fabsf(a->width - b->width) +
           (a->is_italic == b->is_italic ? 0.0f : 1000.0f);
}

const char *camber_font_name_package(const char *name) {
    /* The beginnings of names. A name that begins with another name is listed before it. */
    static const char *const packages[][2] = {
        {"notosanscjk", "fonts-noto-cjk"},   {"notoserifcjk", "fonts-noto-cjk"},
        {"notosansjp", "fonts-noto-cjk"},    {"notosanskr", "fonts-noto-cjk"},
        {"notosanssc", "fonts-noto-cjk"},    {"notosanstc", "fonts-noto-cjk"},
        {"notocjk", "fonts-noto-cjk"},       {"notocoloremoji", "fonts-noto-color-emoji"},
        {"notosansmono", "fonts-noto-mono"}, {"notomono", "fonts-noto-mono"},
        {"noto", "fonts-noto-core"},         {"opensans", "fonts-open-sans"},
        {"robotoslab", "fonts-roboto-slab"}, {"roboto", "fonts-roboto"},
        {"dejavu", "fonts-dejavu"},          {"lato", "fonts-lato"},
        {"liberation", "fonts-liberation"},  {"inter", "fonts-inter"},
        {"cantarell", "fonts-cantarell"},    {"unifont", "fonts-unifont"},
    };
    char plain[NAME_SIZE];
    append_plain(plain, 0, name);
    for (size_t i = 0; i < sizeof packages / sizeof *packages; i++)
        if (strncmp(plain, packages[i][0], strlen(packages[i][0])) == 0)
            return packages[i][1];
    return NULL;
}
