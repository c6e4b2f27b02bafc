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

/* Polylines as arrays, in the form of camber_polylines_desc. camber_lines_destroy frees those that a call made. */
typedef struct camber_lines {
    camber_context *context; /* which allocated the arrays. NULL: they are the caller's, and destroy leaves them */
    float *points;
    uint32_t *offsets;
    size_t point_count;
    size_t polyline_count;
    uint32_t
        *entries; /* the network's entry that each polyline comes from (camber_network_project_lines). NULL: none */
} camber_lines;

/* Reads polylines from the interchange file. All its numbers are little-endian: uint32 0x4c594c50, polyline count n,
 * point count p; n + 1 uint32 offsets; p pairs of float32 x, y.
 * bytes is the whole file. name stands in messages.
 * Returns CAMBER_ERROR_INPUT (a wrong first number, cut off, bytes left over, offsets that do not ascend),
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_lines_parse(camber_context *context, const void *bytes, size_t size_bytes,
                                            const char *name, camber_lines *lines);
/* Drops points where the line that is left stays within tolerance_px of them (Douglas and Peucker). Ends stay, and
 * rings keep their seam. simplified has arrays of its own.
 * Returns CAMBER_ERROR_ARGUMENT (a tolerance that is negative or not a number), CAMBER_ERROR_MEMORY.
 * The cost is n log n. */
CAMBER_API camber_status camber_lines_simplify(camber_context *context, const camber_lines *lines, double tolerance_px,
                                               camber_lines *simplified);
/* Frees the arrays, unless they are the caller's. */
CAMBER_API void camber_lines_destroy(camber_lines *lines);

/* Where output goes. */
typedef struct camber_sink {
    /* Takes bytes, in order. Returns false where it cannot take them; the caller knows why. */
    bool (*write)(void *user, const void *bytes, size_t size_bytes);
    void *user;
} camber_sink;

/* Writes polylines as the interchange file that camber_lines_parse reads.
 * Returns CAMBER_ERROR_IO where the sink refuses, CAMBER_ERROR_LIMIT (too many points for the file's numbers). */
CAMBER_API camber_status camber_lines_write(camber_context *context, const camber_lines *lines, camber_sink sink);

/* ---- PNG ------------------------------------------------------------------------------------------- */

typedef struct camber_png_text {
    const char *key;  /* 1 to 79 Latin-1 characters */
    const char *text; /* UTF-8 */
} camber_png_text;

typedef struct camber_png_desc {
    uint32_t width, height;       /* px, 1 to 65535 */
    bool opaque;                  /* true: alpha is dropped, and the file is RGB. false: RGBA */
    const camber_png_text *texts; /* text_count. NULL: none */
    size_t text_count;
    int compression; /* zlib's level, 1 to 9. 0: 1 */
} camber_png_desc;

typedef struct camber_png camber_png;

/* Makes a writer of a PNG and writes the head. camber_png_write_rows follows until all rows are there, and then
 * camber_png_finish. Once a writer has failed, it goes on failing.
 * Returns CAMBER_ERROR_IO where the sink refuses, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_png_create(camber_context *context, const camber_png_desc *desc, camber_sink sink,
                                           camber_png **png);
/* Writes the next rows, from the top down; their colours go to the file unpremultiplied, as PNG wants it.
 * rgba has row_count rows of width * 4 bytes, premultiplied RGBA8.
 * Returns what camber_png_create returns. */
CAMBER_API camber_status camber_png_write_rows(camber_png *png, const uint8_t *rgba, uint32_t row_count);
/* Writes the end of the file.
 * Returns CAMBER_ERROR_IO where rows are missing or the sink refuses, CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_png_finish(camber_png *png);
/* Frees the writer, finished or not. */
CAMBER_API void camber_png_destroy(camber_png *png);

#ifdef __cplusplus
}
#endif

#endif
