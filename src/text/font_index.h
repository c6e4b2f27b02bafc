/* The font files that text may be drawn with, and their names: first the fonts in the caller's folders, then the fonts
 * that camber ships, then the fonts that fontconfig knows. A file is opened when a text needs it. */
#ifndef CAMBER_TEXT_FONT_INDEX_H
#define CAMBER_TEXT_FONT_INDEX_H

#include "text/face.h"
#include "text/font_name.h"

#include <fontconfig/fontconfig.h>

enum { CAMBER_FONT_KEYS = 8 };

typedef enum camber_font_origin {
    CAMBER_FONT_FROM_FOLDER = 0,
    CAMBER_FONT_SHIPPED, /* before the system's, so that texts in this font are alike on all machines */
    CAMBER_FONT_FROM_SYSTEM,
} camber_font_origin;

typedef struct camber_font_entry {
    camber_font_origin origin;
    char *path;     /* a shipped font has its name here */
    char *name;     /* NULL: a font of the system, whose pattern has it */
    uint32_t index; /* as camber_face_open takes it */
    uint64_t whole_keys[CAMBER_FONT_KEYS], family_keys[CAMBER_FONT_KEYS]; /* font_name.h */
    size_t whole_count, family_count;
    camber_font_style style;
    FcPattern *pattern;         /* of a font of the system; otherwise NULL */
    const unsigned char *bytes; /* of a shipped font */
    size_t size_bytes;
    camber_face *face; /* NULL: not opened yet */
    bool is_broken;    /* it could not be opened; the log says why */
} camber_font_entry;

typedef struct camber_font_index {
    camber_context *context;
    camber_font_entry *entries; /* by origin, then by path */
    size_t count, capacity;
    FcConfig *config; /* NULL: without the system's fonts */
} camber_font_index;

/* Fills a zeroed index. */
camber_status camber_font_index_fill(camber_font_index *index, const char *const *folders, size_t folder_count,
                                     bool has_system);
void camber_font_index_free(camber_font_index *index);

/* Appends an entry for the file, whose path is copied. NULL: no memory. The pointer is valid until the next entry is
 * added. */
camber_font_entry *camber_font_index_add(camber_font_index *index, camber_font_origin origin, const char *path);
/* Adds the entry's names as keys if there is room. A name that is NULL or empty adds no key. */
void camber_font_entry_name(camber_font_entry *entry, const char *family, const char *style, const char *full_name);

/* Adds the files in a folder, and in the folders inside it, whose suffix says that they are fonts. */
camber_status camber_font_index_add_folder(camber_font_index *index, const char *folder);
/* Adds the system's fonts that have outlines. */
camber_status camber_font_index_add_system(camber_font_index *index);

/* Returns the entry that a style means by a name: the entry with this name or, if there is none, the entry of its
 * family with the nearest style. SIZE_MAX: there is none. */
size_t camber_font_index_find(const camber_font_index *index, const char *name);
/* Returns the entry of a family with the nearest style. SIZE_MAX: there is none. */
size_t camber_font_index_find_family(const camber_font_index *index, uint64_t family_key,
                                     const camber_font_style *style);
/* Returns the full name of the font of the system that has this pattern. NULL: it has none. */
const char *camber_font_pattern_name(const FcPattern *pattern);
/* Opens the font of the entry with this number. Sets *face to NULL if it is broken. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_font_index_open(camber_font_index *index, size_t number, camber_face **face);

/* Returns the system's fonts in the order in which fontconfig would try them for a style and a language, as patterns of
 * entries. NULL: there are none. */
FcFontSet *camber_font_index_sort_system(const camber_font_index *index, const camber_font_style *style,
                                         const char *language);
/* Returns the entry with this pattern. SIZE_MAX: there is none. */
size_t camber_font_index_find_pattern(const camber_font_index *index, const FcPattern *pattern);

#endif
