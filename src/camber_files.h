/* camber: the files that it reads and writes by itself: polylines for interchange, and PNG.
 *
 * The rules of camber.h hold here too.
 */
#ifndef CAMBER_FILES_H
#define CAMBER_FILES_H

#include "camber.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Polylines ----------------------------------------------------------------------------------- */

/* Polylines as arrays, in the form of camber_polylines_desc. What a call makes is freed by camber_lines_destroy. */
typedef struct camber_lines {
    camber_context *context; /* which allocated the arrays. NULL: they are the caller's, and destroy leaves them */
    float *points;
    uint32_t *offsets;
    size_t point_count;
    size_t polyline_count;
    uint32_t *entries; /* camber_network_project_lines: the entry that each polyline is of. NULL: not of a network */
} camber_lines;

/* Reads the interchange file: little-endian uint32 0x4c594c50, polyline count n, point count p; n + 1
 * uint32 offsets; p pairs of float32 x, y. bytes is the whole file; name stands in messages.
 * Returns CAMBER_ERROR_INPUT (wrong magic, cut off, bytes left over, offsets that do not ascend),
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_lines_parse(camber_context *context, const void *bytes, size_t size_bytes,
                                            const char *name, camber_lines *lines);
/* Drops points where the line that is left stays within tolerance_px of them (Douglas and Peucker). Ends stay, and
 * rings keep their seam. Returns CAMBER_ERROR_ARGUMENT (a tolerance
 * that is negative or not a number), CAMBER_ERROR_MEMORY. Cost: n log n. */
CAMBER_API camber_status camber_lines_simplify(camber_context *context, const camber_lines *lines, double tolerance_px,
                                               camber_lines *simplified);
CAMBER_API void camber_lines_destroy(camber_lines *lines);

/* Where output goes: returns false when the bytes could not be taken (the caller knows why). */
typedef struct camber_sink {
    bool (*write)(void *user, const void *bytes, size_t size_bytes);
    void *user;
} camber_sink;

/* Writes the interchange file. Returns CAMBER_ERROR_IO when the sink refuses. */
CAMBER_API camber_status camber_lines_write(camber_context *context, const camber_lines *lines, camber_sink sink);

/* ---- PNG ------------------------------------------------------------------------------------------- */

typedef struct camber_png_text {
    const char *key;  /* 1 to 79 Latin-1 characters */
    const char *text; /* UTF-8 */
} camber_png_text;

typedef struct camber_png_desc {
    uint32_t width, height; /* px, 1 to 65535 */
    bool opaque;            /* alpha is dropped: RGB instead of RGBA */
    const camber_png_text *texts;
    size_t text_count;
    int compression; /* zlib's level 1 to 9. 0: 1 */
} camber_png_desc;

typedef struct camber_png camber_png;

/* Writes the head of a PNG. Then camber_png_write_rows until all rows are there, then camber_png_finish. They return
 * CAMBER_ERROR_IO when the sink refuses, and CAMBER_ERROR_MEMORY; once a writer has failed, it stays so. */
CAMBER_API camber_status camber_png_create(camber_context *context, const camber_png_desc *desc, camber_sink sink,
                                           camber_png **png);
/* rgba: premultiplied, row_count rows of width * 4 bytes; written unpremultiplied, as PNG wants it. */
CAMBER_API camber_status camber_png_write_rows(camber_png *png, const uint8_t *rgba, uint32_t row_count);
/* Writes the end. CAMBER_ERROR_IO when rows are missing or the sink refuses. */
CAMBER_API camber_status camber_png_finish(camber_png *png);
CAMBER_API void camber_png_destroy(camber_png *png);

#ifdef __cplusplus
}
#endif

#endif
