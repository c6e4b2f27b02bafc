/* The fonts that labels are drawn with.
 *
 * Input: folders of fonts, and the style's glyphs, a template of file names with {fontstack} and {range}. Output: fonts
 * that belong to a set of features. Main idea: the style's own glyphs are used first, as in browsers; fonts on this
 * machine draw the other characters. */
#include "camber_text.h"
#include "features/features.h"
#include "style/style.h"
#include "style/url.h"

#include <stdio.h>
#include <string.h>

typedef struct glyph_files {
    camber_context *context;
    char *folder; /* ends with / */
    char *name;   /* its template within the folder, with {fontstack} and {range} */
    char *bytes;  /* contents of the last range */
} glyph_files;

static void free_files(glyph_files *files) {
    if (!files)
        return;
    camber_context *context = files->context;
    camber_free(context, files->folder);
    camber_free(context, files->name);
    camber_free(context, files->bytes);
    camber_free(context, files);
}

/* Returns a copy of the text with a value in place of a name in braces. NULL: no memory. */
static char *fill_in(camber_context *context, const char *text, const char *name, const char *value) {
    const char *at = strstr(text, name);
    const size_t before = at ? (size_t)(at - text) : strlen(text), size = strlen(text) + strlen(value) + 1;
    char *made = camber_alloc(context, size, 1);
    if (made)
        snprintf(made, size, "%.*s%s%s", (int)before, text, at ? value : "", at ? at + strlen(name) : "");
    return made;
}

/* Whether a name leads out of its folder. It is checked because a style also chooses the names of fonts. */
static bool leads_up(const char *name) {
    for (const char *at = strstr(name, ".."); at; at = strstr(at + 1, ".."))
        if ((at == name || at[-1] == '/') && (at[2] == 0 || at[2] == '/'))
            return true;
    return false;
}

static camber_status read_range(void *user, const char *stack, uint32_t first, const uint8_t **bytes,
                                size_t *size_bytes) {
    glyph_files *files = user;
    camber_context *context = files->context;
    char range[32], *with_stack, *name = NULL;
    camber_status status = CAMBER_ERROR_MEMORY;
    camber_free(context, files->bytes);
    files->bytes = NULL;
    snprintf(range, sizeof range, "%u-%u", first, first + 255);
    if ((with_stack = fill_in(context, files->name, "{fontstack}", stack)) &&
        (name = fill_in(context, with_stack, "{range}", range)))
        status = leads_up(name) ? CAMBER_ERROR_NOT_FOUND
                                : camber_read_file_below(context, files->folder, name, &files->bytes, size_bytes);
    camber_free(context, with_stack);
    camber_free(context, name);
    *bytes = (const uint8_t *)files->bytes;
    return status;
}

/* Splits the template at the folder before its first name in braces. */
static camber_status split(glyph_files *files, const char *path) {
    const char *brace = strchr(path, '{'), *end = path;
    for (const char *at = path; at < brace; at++)
        end = *at == '/' ? at + 1 : end;
    const size_t size = (size_t)(end - path) + 1;
    files->folder = camber_alloc(files->context, size + 2, 1);
    files->name = camber_alloc(files->context, strlen(end) + 1, 1);
    if (!files->folder || !files->name)
        return CAMBER_ERROR_MEMORY;
    snprintf(files->folder, size + 2, "%.*s", end > path ? (int)(end - path) : 2, end > path ? path : "./");
    memcpy(files->name, end, strlen(end) + 1);
    return CAMBER_OK;
}

/* Finds the files of the style's glyphs. NULL: the style has none on this machine. */
static camber_status find_files(camber_context *context, const char *template, const char *base_path,
                                glyph_files **found) {
    camber_url url;
    if (!template)
        return CAMBER_OK;
    if (camber_url_is_remote(template)) {
        camber_log(context, CAMBER_LOG_INFO, "style: its glyphs are on the network; fonts of this machine are used");
        return CAMBER_OK;
    }
    if (!strstr(template, "{range}"))
        return camber_fail(context, CAMBER_ERROR_INPUT,
                           "style: /glyphs: \"%.128s\" lacks {range}; write .../{fontstack}/{range}.pbf", template);
    camber_status status = camber_url_resolve(context, "style: /glyphs", template, base_path, &url);
    if (status != CAMBER_OK)
        return status;
    glyph_files *files = camber_alloc_zero(context, 1, sizeof *files);
    status = CAMBER_ERROR_MEMORY;
    if (files) {
        files->context = context;
        status = split(files, url.path);
    }
    /* Files below the folder are in the root, too, because no link below it is followed. */
    if (status == CAMBER_OK && !camber_file_is_reached(context, files->folder))
        status = camber_fail(context, CAMBER_ERROR_INPUT,
                             "style: /glyphs: %s is not in %s, and a style may name files only there; put it there",
                             files->folder, context->desc.access.root);
    camber_free(context, url.path);
    if (status == CAMBER_OK)
        *found = files;
    else
        free_files(files);
    return status;
}

static void free_fonts(camber_features *features) {
    camber_fonts_destroy(features->fonts);
    free_files(features->fonts_user);
    features->fonts = NULL;
    features->fonts_user = NULL;
}

camber_status camber_features_read_fonts(camber_features *features, const camber_fonts_desc *desc,
                                         const char *base_path) {
    camber_fonts_desc made = desc ? *desc : (camber_fonts_desc){0};
    glyph_files *files = NULL;
    camber_fonts *fonts = NULL;
    camber_status status = CAMBER_OK;
    if (!made.glyphs)
        status = find_files(features->context, features->style->glyphs, base_path, &files);
    if (files) {
        made.glyphs = read_range;
        made.glyphs_user = files;
    }
    if (status == CAMBER_OK)
        status = camber_fonts_create(features->context, &made, &fonts);
    if (status != CAMBER_OK) {
        free_files(files);
        return status;
    }
    if (features->free_fonts)
        features->free_fonts(features);
    features->fonts = fonts;
    features->changes++;
    features->fonts_user = files;
    features->free_fonts = free_fonts;
    camber_features_want_labels(features);
    return CAMBER_OK;
}
