/* Fonts that fontconfig knows. Fontconfig's configuration belongs to the process: fontconfig sets it up once and does
 * its own locking, and camber only reads it. */
#include "text/font_index.h"

static const char *get_string(const FcPattern *pattern, const char *object, int number) {
    FcChar8 *text = NULL;
    return FcPatternGetString(pattern, object, number, &text) == FcResultMatch ? (const char *)text : NULL;
}

static int get_number(const FcPattern *pattern, const char *object, int without) {
    int number = without;
    return FcPatternGetInteger(pattern, object, 0, &number) == FcResultMatch ? number : without;
}

/* Whether camber can draw the font: it must be TrueType or OpenType with outlines, and not a variable font without a
 * style. */
static bool is_usable(const FcPattern *pattern) {
    FcBool is_outline = FcFalse, is_variable = FcFalse, is_colored = FcFalse;
    const char *format = get_string(pattern, FC_FONTFORMAT, 0);
    FcPatternGetBool(pattern, FC_OUTLINE, 0, &is_outline);
    FcPatternGetBool(pattern, FC_VARIABLE, 0, &is_variable);
    FcPatternGetBool(pattern, FC_COLOR, 0, &is_colored);
    return is_outline && !is_variable && !is_colored && format &&
           (strcmp(format, "TrueType") == 0 || strcmp(format, "CFF") == 0);
}

static void describe(camber_font_entry *entry, FcPattern *pattern) {
    double weight = FC_WEIGHT_REGULAR, width = FC_WIDTH_NORMAL;
    FcPatternGetDouble(pattern, FC_WEIGHT, 0, &weight);
    FcPatternGetDouble(pattern, FC_WIDTH, 0, &width);
    entry->pattern = pattern;
    entry->index = (uint32_t)get_number(pattern, FC_INDEX, 0);
    entry->style.weight = (float)FcWeightToOpenTypeDouble(weight);
    entry->style.width = (float)width;
    entry->style.is_italic = get_number(pattern, FC_SLANT, FC_SLANT_ROMAN) != FC_SLANT_ROMAN;
    const char *family, *full;
    for (int i = 0; (family = get_string(pattern, FC_FAMILY, i)); i++)
        camber_font_entry_name(entry, family, get_string(pattern, FC_STYLE, i), NULL);
    for (int i = 0; (full = get_string(pattern, FC_FULLNAME, i)); i++)
        camber_font_entry_name(entry, NULL, NULL, full);
}

const char *camber_font_pattern_name(const FcPattern *pattern) {
    const char *full = get_string(pattern, FC_FULLNAME, 0);
    return full ? full : get_string(pattern, FC_FAMILY, 0);
}

/* The file of fontconfig's configuration; NULL: there is none. Newer versions look for it by reading it, and complain,
 * unless they are asked with a configuration at hand. */
static FcChar8 *find_config(void) {
#if FC_VERSION >= 21391
    FcConfig *empty = FcConfigCreate();
    FcChar8 *path = empty ? FcConfigGetFilename(empty, NULL) : NULL;
    if (empty)
        FcConfigDestroy(empty);
    return path;
#else
    return FcConfigFilename(NULL);
#endif
}

/* A system without fontconfig's configuration has no fonts for it to find, and it would complain on standard error. */
static FcConfig *reference_config(void) {
    FcChar8 *path = find_config();
    FcConfig *config = path ? FcConfigReference(NULL) : NULL;
    FcStrFree(path);
    return config;
}

camber_status camber_font_index_add_system(camber_font_index *index) {
    index->config = reference_config();
    FcFontSet *fonts = index->config ? FcConfigGetFonts(index->config, FcSetSystem) : NULL;
    for (int i = 0; fonts && i < fonts->nfont; i++) {
        const char *path = get_string(fonts->fonts[i], FC_FILE, 0);
        if (!path || !is_usable(fonts->fonts[i]))
            continue;
        camber_font_entry *entry = camber_font_index_add(index, CAMBER_FONT_FROM_SYSTEM, path);
        if (!entry)
            return CAMBER_ERROR_MEMORY;
        describe(entry, fonts->fonts[i]);
    }
    return CAMBER_OK;
}

FcFontSet *camber_font_index_sort_system(const camber_font_index *index, const camber_font_style *style,
                                         const char *language) {
    FcPattern *pattern = index->config ? FcPatternCreate() : NULL;
    FcFontSet *sorted = NULL;
    FcResult result;
    if (!pattern)
        return NULL;
    FcPatternAddString(pattern, FC_FAMILY, (const FcChar8 *)"sans-serif");
    FcPatternAddString(pattern, FC_LANG, (const FcChar8 *)(language ? language : "en"));
    FcPatternAddDouble(pattern, FC_WEIGHT, FcWeightFromOpenTypeDouble((double)style->weight));
    FcPatternAddInteger(pattern, FC_SLANT, style->is_italic ? FC_SLANT_ITALIC : FC_SLANT_ROMAN);
    FcPatternAddBool(pattern, FC_OUTLINE, FcTrue);
    FcConfigSubstitute(index->config, pattern, FcMatchPattern);
    FcDefaultSubstitute(pattern);
    sorted = FcFontSort(index->config, pattern, FcFalse, NULL, &result);
    FcPatternDestroy(pattern);
    return sorted;
}

size_t camber_font_index_find_pattern(const camber_font_index *index, const FcPattern *pattern) {
    for (size_t i = 0; i < index->count; i++)
        if (index->entries[i].pattern == pattern)
            return i;
    return SIZE_MAX;
}
