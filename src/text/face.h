/* An open font file, for HarfBuzz. */
#ifndef CAMBER_TEXT_FACE_H
#define CAMBER_TEXT_FACE_H

#include "text/font_name.h"

#include <hb.h>

typedef struct camber_face {
    hb_font_t *font; /* its scale is units_per_em */
    float units_per_em;
    float ascender_em;
    bool is_colored; /* some of its glyphs are pictures and have no outlines */
} camber_face;

/* Opens a font from a file. index: the number of the font in a collection, and in the upper 16 bits the number of a
 * named instance, counted from 1.
 * Returns CAMBER_ERROR_INPUT (no font with glyphs), CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_IO, CAMBER_ERROR_MEMORY. */
camber_status camber_face_open(camber_context *context, const char *path, uint32_t index, camber_face **face);
/* Opens a font from bytes, which must outlive the face. name is used in messages. */
camber_status camber_face_open_bytes(camber_context *context, const char *name, const unsigned char *bytes,
                                     size_t size_bytes, camber_face **face);
void camber_face_close(camber_context *context, camber_face *face);

/* Maps a font file into memory without looking at its contents. NULL: it cannot be read; *status and the log say why.
 */
hb_blob_t *camber_face_map_file(camber_context *context, const char *path, camber_status *status);

/* Whether the font has an outline for a code point, or needs none, as for a space. */
bool camber_face_has(const camber_face *face, uint32_t code);
#endif
