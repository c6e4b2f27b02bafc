/* camber's own file formats: it reads and writes polylines for interchange, and writes pictures as PNG and WebP.
 *
 * The rules of camber.h apply here too. */
#ifndef CAMBER_FILES_H
#define CAMBER_FILES_H

#include "camber.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Polylines ----------------------------------------------------------------------------------- */

/* Polylines as arrays, in the form of camber_polylines_desc. camber_lines_destroy frees arrays that the library
 * allocated. */
typedef struct camber_lines {
    camber_context *context; /* the arrays' allocator. NULL: they are the caller's, and destroy does not free them */
    float *points;
    uint32_t *offsets;
    size_t point_count;
    size_t polyline_count;
    /* for each polyline the network entry that it comes from (camber_network_project_lines). NULL: none */
    uint32_t *entries;
} camber_lines;

/* Reads polylines from an interchange file. All numbers in it are little-endian: uint32 0x4c594c50, polyline count n,
 * point count p; n + 1 uint32 offsets; p pairs of float32 x, y.
 * bytes is the whole file. name is used in messages.
 * Returns CAMBER_ERROR_INPUT (a wrong first number, a truncated file, bytes left over, offsets that do not ascend),
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_lines_parse(camber_context *context, const void *bytes, size_t size_bytes,
                                            const char *name, camber_lines *lines);
/* Drops points that are within tolerance_px of the simplified line (Douglas-Peucker). Ends are kept, and rings keep the
 * point where they close. simplified gets arrays of its own.
 * Returns CAMBER_ERROR_ARGUMENT (a tolerance that is negative or not a number), CAMBER_ERROR_MEMORY.
 * Cost: n log n. */
CAMBER_API camber_status camber_lines_simplify(camber_context *context, const camber_lines *lines, double tolerance_px,
                                               camber_lines *simplified);
/* Frees the arrays, unless they are the caller's. */
CAMBER_API void camber_lines_destroy(camber_lines *lines);

/* Receives output. */
typedef struct camber_sink {
    /* Receives bytes, in order. Returns false if it cannot take them; the caller knows why. */
    bool (*write)(void *user, const void *bytes, size_t size_bytes);
    void *user;
} camber_sink;

/* Writes polylines as an interchange file, which camber_lines_parse reads.
 * Returns CAMBER_ERROR_IO (the sink returned false), CAMBER_ERROR_LIMIT (too many points for the file's numbers). */
CAMBER_API camber_status camber_lines_write(camber_context *context, const camber_lines *lines, camber_sink sink);

/* ---- PNG ------------------------------------------------------------------------------------------- */

typedef struct camber_png_text {
    const char *key;  /* 1 to 79 Latin-1 characters */
    const char *text; /* UTF-8 */
} camber_png_text;

typedef struct camber_png_desc {
    uint32_t width, height;       /* px, 1 to 65535 */
    bool opaque;                  /* true: alpha is dropped. false: alpha is kept if it is below 255 in any pixel */
    const camber_png_text *texts; /* text_count of them. NULL: none */
    size_t text_count;
    int compression; /* DEFLATE's level, 1 to 9. 0: 1 */
    double dpi;      /* px per inch of paper, which the file tells (pHYs). 0: it tells nothing */
} camber_png_desc;

typedef struct camber_png camber_png;

/* Makes a PNG writer. Call camber_png_write_rows until all rows are written, and then camber_png_finish. The writer
 * buffers a picture of up to 2^22 px, uses a palette if 256 colours are enough, and writes the file at the end. It
 * writes the rows of a larger picture as it receives them, at half the speed and without a palette. After a failure,
 * all further calls fail.
 * Returns CAMBER_ERROR_ARGUMENT (a size, a level or the length of a text's key is out of range), CAMBER_ERROR_IO (the
 * sink returned false), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_png_create(camber_context *context, const camber_png_desc *desc, camber_sink sink,
                                           camber_png **png);
/* Takes the next rows, from the top down; the file gets unpremultiplied colours, as PNG requires.
 * rgba has row_count rows of width * 4 bytes, premultiplied RGBA8.
 * Returns the same errors as camber_png_create. */
CAMBER_API camber_status camber_png_write_rows(camber_png *png, const uint8_t *rgba, uint32_t row_count);
/* Writes the end of the file.
 * Returns CAMBER_ERROR_IO (rows are missing, or the sink returned false), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_png_finish(camber_png *png);
/* Frees the writer, finished or not. */
CAMBER_API void camber_png_destroy(camber_png *png);

/* ---- Encoders ---------------------------------------------------------------------------------------- */

typedef enum camber_encoding {
    CAMBER_ENCODING_PNG = 0, /* lossless: a palette if 256 colours are enough, else RGB or RGBA */
    /* always a palette, in which similar blended colours share an entry; docs/encoding.md says how much they differ.
     * Opaque and transparent pixels stay opaque and transparent */
    CAMBER_ENCODING_PNG8,
    CAMBER_ENCODING_WEBP,
} camber_encoding;

/* Whether this build has the encoding: WebP needs libwebp. */
CAMBER_API bool camber_encoding_is_built(camber_encoding encoding);
/* The longest side of a picture in px: 16383 for WebP, else 65535. */
CAMBER_API uint32_t camber_encoding_get_longest_side(camber_encoding encoding);

typedef struct camber_encoder_desc {
    camber_encoding encoding;
    bool opaque;                  /* true: alpha is dropped */
    int compression;              /* PNG: DEFLATE's level, 1 to 9. 0: 1, or 6 for png8 */
    int quality;                  /* WebP: 1 to 100; 100 is lossless. 0: 80 */
    const camber_png_text *texts; /* PNG: text_count of them. NULL: none */
    size_t text_count;
    double dpi; /* PNG: px per inch of paper, which the file tells (pHYs). 0: it tells nothing */
} camber_encoder_desc;

enum { CAMBER_PIXELS_MOST = 1 << 28 };

/* Rows of premultiplied RGBA8, from the top down. */
typedef struct camber_pixels {
    const uint8_t *rgba;
    uint32_t width, height; /* 1 to the encoding's longest side, and at most CAMBER_PIXELS_MOST px in total */
    size_t stride_bytes;    /* from one row to the next. 0: 4 * width */
} camber_pixels;

/* An encoder encodes whole pictures in memory, one after another. It keeps its buffers, so tiles of the same size need
 * no further allocations. Each thread needs its own encoder, made from its own context. With the same versions of
 * ISA-L, libdeflate, zlib and libwebp, the same pixels give the same bytes, whatever was encoded before. */
typedef struct camber_encoder camber_encoder;

/* Returns CAMBER_ERROR_ARGUMENT (an encoding that is not built in; a level, a quality or a text's key out of range),
 * CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_encoder_create(camber_context *context, const camber_encoder_desc *desc,
                                               camber_encoder **encoder);
/* Encodes a picture. The encoder owns *bytes, which are valid until its next call.
 * Returns CAMBER_ERROR_ARGUMENT (a size out of range), CAMBER_ERROR_MEMORY. */
CAMBER_API camber_status camber_encoder_encode(camber_encoder *encoder, const camber_pixels *pixels,
                                               const uint8_t **bytes, size_t *size_bytes);
CAMBER_API void camber_encoder_destroy(camber_encoder *encoder);

#ifdef __cplusplus
}
#endif

#endif
