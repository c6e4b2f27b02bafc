/* Opens fonts: maps their files, and lets HarfBuzz read them. */
#include "text/outline.h"

#include <errno.h>
#include <hb-ot.h>
#include <math.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

/* Font files are mapped into memory, because a text needs only a small part of them, and a font of ideographs has 20
 * MB. Cairo keeps fonts of pages for longer than a context lives, so a mapping belongs to none. */
typedef struct mapping {
    void *bytes;
    size_t size_bytes;
} mapping;

static void unmap(void *user) {
    mapping *mapped = user;
    munmap(mapped->bytes, mapped->size_bytes);
    free(mapped);
}

hb_blob_t *camber_face_map_file(camber_context *context, const char *path, camber_status *status) {
    int file = -1;
    uint64_t size_bytes = 0;
    hb_blob_t *blob = NULL;
    mapping *mapped = NULL;
    *status = camber_file_open(context, path, CAMBER_NAMED_BY_CALLER, &file, &size_bytes);
    if (*status)
        return NULL;
    if (size_bytes == 0 || size_bytes > INT32_MAX) {
        *status = camber_fail(context, CAMBER_ERROR_INPUT, "%s: this is no font file", path);
        goto done;
    }
    mapped = calloc(1, sizeof *mapped);
    *status = mapped ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (!mapped)
        goto done;
    mapped->size_bytes = (size_t)size_bytes;
    mapped->bytes = mmap(NULL, mapped->size_bytes, PROT_READ, MAP_PRIVATE, file, 0);
    if (mapped->bytes == MAP_FAILED) {
        *status = camber_file_fail(context, path, errno);
        goto done;
    }
    /* If HarfBuzz has no memory, it calls unmap and returns an empty blob. */
    blob = hb_blob_create(mapped->bytes, (unsigned)mapped->size_bytes, HB_MEMORY_MODE_READONLY, mapped, unmap);
    mapped = NULL;
done:
    free(mapped);
    close(file);
    return blob;
}

static bool has_pictures(hb_face_t *face) {
    return hb_ot_color_has_layers(face) || hb_ot_color_has_png(face) || hb_ot_color_has_svg(face);
}

static camber_status make_face(camber_context *context, const char *name, hb_blob_t *blob, uint32_t index,
                               camber_face **face) {
    hb_face_t *opened = hb_face_create(blob, index & 0xffff);
    camber_face *made = camber_alloc_zero(context, 1, sizeof *made);
    camber_status status = made ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (!made)
        goto done;
    if (hb_face_get_glyph_count(opened) == 0) {
        status = camber_fail(context, CAMBER_ERROR_INPUT, "%s: there is no font number %u with glyphs", name,
                             (unsigned)(index & 0xffff));
        goto done;
    }
    const unsigned units = hb_face_get_upem(opened);
    made->font = hb_font_create(opened);
    made->units_per_em = (float)units;
    made->is_colored = has_pictures(opened);
    hb_font_set_scale(made->font, (int)units, (int)units);
    if (index >> 16)
        hb_font_set_var_named_instance(made->font, (index >> 16) - 1);
    hb_font_extents_t extents = {0};
    hb_font_get_h_extents(made->font, &extents);
    made->ascender_em = (float)extents.ascender / made->units_per_em;
    /* With the ascenders of most fonts, letters are in the middle of their lines. The ascenders of fonts for scripts
     * with high marks would push letters down. */
    made->ascender_em = fminf(fmaxf(made->ascender_em, 0.75f), 1.2f);
    hb_font_make_immutable(made->font);
    *face = made;
    made = NULL;
done:
    camber_free(context, made);
    hb_face_destroy(opened);
    return status;
}

camber_status camber_face_open(camber_context *context, const char *path, uint32_t index, camber_face **face) {
    camber_status status;
    hb_blob_t *blob = camber_face_map_file(context, path, &status);
    if (!status)
        status = make_face(context, path, blob, index, face);
    hb_blob_destroy(blob);
    return status;
}

camber_status camber_face_open_bytes(camber_context *context, const char *name, const unsigned char *bytes,
                                     size_t size_bytes, camber_face **face) {
    hb_blob_t *blob = hb_blob_create((const char *)bytes, (unsigned)size_bytes, HB_MEMORY_MODE_READONLY, NULL, NULL);
    const camber_status status = make_face(context, name, blob, 0, face);
    hb_blob_destroy(blob);
    return status;
}

void camber_face_close(camber_context *context, camber_face *face) {
    if (!face)
        return;
    hb_font_destroy(face->font);
    camber_free(context, face);
}

bool camber_face_has(const camber_face *face, uint32_t code) {
    hb_codepoint_t glyph;
    if (!hb_font_get_nominal_glyph(face->font, code, &glyph))
        return false;
    return !face->is_colored || code <= ' ' || camber_face_has_outline(face, glyph);
}
