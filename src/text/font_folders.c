/* Fonts in the caller's folders. Their names are read from the files themselves. */
#include "text/font_index.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <hb-ot.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>
#include <sys/stat.h>

enum { MOST_DEPTH = 16, MOST_FONTS_OF_FILE = 256, NAME_SIZE = 128 };
static const size_t MOST_ENTRIES = 1 << 16;

static bool is_font_file(const char *name) {
    const char *suffix = strrchr(name, '.');
    return suffix && (strcasecmp(suffix, ".ttf") == 0 || strcasecmp(suffix, ".otf") == 0 ||
                      strcasecmp(suffix, ".ttc") == 0 || strcasecmp(suffix, ".otc") == 0);
}

static const char *get_name(hb_face_t *face, hb_ot_name_id_t id, char name[NAME_SIZE]) {
    unsigned size = NAME_SIZE;
    name[0] = 0;
    hb_ot_name_get_utf8(face, id, hb_language_from_string("en", -1), &size, name);
    return name;
}

static camber_status describe(camber_context *context, camber_font_entry *entry, hb_face_t *face) {
    char family[NAME_SIZE], style[NAME_SIZE], full[NAME_SIZE];
    camber_font_entry_name(entry, get_name(face, HB_OT_NAME_ID_TYPOGRAPHIC_FAMILY, family),
                           get_name(face, HB_OT_NAME_ID_TYPOGRAPHIC_SUBFAMILY, style),
                           get_name(face, HB_OT_NAME_ID_FULL_NAME, full));
    entry->name = camber_copy_string(context, full);
    camber_font_entry_name(entry, get_name(face, HB_OT_NAME_ID_FONT_FAMILY, family),
                           get_name(face, HB_OT_NAME_ID_FONT_SUBFAMILY, style),
                           get_name(face, HB_OT_NAME_ID_POSTSCRIPT_NAME, full));
    hb_font_t *font = hb_font_create(face);
    entry->style.weight = hb_style_get_value(font, HB_STYLE_TAG_WEIGHT);
    entry->style.width = hb_style_get_value(font, HB_STYLE_TAG_WIDTH);
    entry->style.is_italic = hb_style_get_value(font, HB_STYLE_TAG_ITALIC) > 0.0f ||
                             hb_style_get_value(font, HB_STYLE_TAG_SLANT_ANGLE) != 0.0f;
    hb_font_destroy(font);
    return entry->name ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

static camber_status add_file(camber_font_index *index, const char *path) {
    camber_status status;
    camber_saved_log kept;
    camber_log_demote_errors(index->context, &kept);
    hb_blob_t *blob = camber_face_map_file(index->context, path, &status);
    camber_log_restore(index->context, &kept);
    if (status == CAMBER_ERROR_MEMORY)
        return camber_fail(index->context, status, "%s: there is no memory to open this font", path);
    unsigned count = blob ? hb_face_count(blob) : 0;
    count = count < MOST_FONTS_OF_FILE ? count : MOST_FONTS_OF_FILE;
    bool has_any = false;
    for (unsigned i = 0; i < count && !status && index->count < MOST_ENTRIES; i++) {
        hb_face_t *face = hb_face_create(blob, i);
        if (hb_face_get_glyph_count(face)) {
            camber_font_entry *entry = camber_font_index_add(index, CAMBER_FONT_FROM_FOLDER, path);
            status = entry ? CAMBER_OK : CAMBER_ERROR_MEMORY;
            has_any = true;
            if (entry) {
                entry->index = i;
                status = describe(index->context, entry, face);
            }
        }
        hb_face_destroy(face);
    }
    hb_blob_destroy(blob);
    if (status == CAMBER_ERROR_MEMORY)
        return status;
    if (!has_any)
        camber_log(index->context, CAMBER_LOG_WARNING, "%s: this is no font that can be read: left out", path);
    return CAMBER_OK;
}

static camber_status add_folder(camber_font_index *index, const char *folder, int depth) {
    DIR *opened = opendir(folder);
    camber_status status = CAMBER_OK;
    if (!opened)
        return depth ? CAMBER_OK : camber_file_fail(index->context, folder, errno);
    for (struct dirent *found; !status && (found = readdir(opened));) {
        char path[PATH_MAX];
        struct stat about;
        const int length = snprintf(path, sizeof path, "%s/%s", folder, found->d_name);
        if (found->d_name[0] == '.' || length < 0 || (size_t)length >= sizeof path || lstat(path, &about))
            continue;
        const bool is_link = S_ISLNK(about.st_mode);
        if (is_link && stat(path, &about))
            continue;
        if (S_ISDIR(about.st_mode) && !is_link && depth < MOST_DEPTH) /* links may lead in a circle */
            status = add_folder(index, path, depth + 1);
        else if (S_ISREG(about.st_mode) && is_font_file(path))
            status = add_file(index, path);
    }
    closedir(opened);
    return status;
}

camber_status camber_font_index_add_folder(camber_font_index *index, const char *folder) {
    return add_folder(index, folder, 0);
}
