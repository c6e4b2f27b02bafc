/* The chunks of a PNG, and its rows. */
#ifndef CAMBER_IO_PNG_CHUNKS_H
#define CAMBER_IO_PNG_CHUNKS_H

#include "base/base.h"

enum { CAMBER_PALETTE_MOST = 256 };

/* The values are defined by the PNG specification. */
typedef enum camber_png_kind {
    CAMBER_PNG_KIND_RGB = 2,
    CAMBER_PNG_KIND_PALETTE = 3,
    CAMBER_PNG_KIND_RGBA = 6,
} camber_png_kind;

typedef struct camber_png_head {
    uint32_t width, height;
    camber_png_kind kind;
    int depth; /* bits per sample: 8, or for a palette also 1, 2 and 4 */
    const camber_png_text *texts;
    size_t text_count;
    double dpi;                  /* 0: unknown */
    const uint8_t (*palette)[4]; /* straight RGBA; colours that are not opaque come first */
    size_t palette_count;
} camber_png_head;

/* Writes everything before the pixels. This function and the next two return false if the sink refuses the bytes. */
bool camber_png_put_head(camber_sink sink, const camber_png_head *head);
/* Writes a piece of the compressed rows. */
bool camber_png_put_data(camber_sink sink, const void *bytes, size_t size_bytes);
bool camber_png_put_end(camber_sink sink);

/* How many bytes a chunk has before and after its data. Needed if rows are compressed directly into the file. */
enum { CAMBER_PNG_BEFORE_DATA = 8, CAMBER_PNG_AFTER_DATA = 4 };
/* Writes these bytes around the data. chunk: the position of the first one. */
void camber_png_enclose_data(uint8_t *chunk, size_t size_bytes);

/* Returns the bytes of a row in the file: its filter type and its samples. */
size_t camber_png_row_bytes(camber_png_kind kind, int depth, uint32_t width);
/* Converts a row of premultiplied RGBA to RGB or RGBA. */
void camber_png_make_row(camber_png_kind kind, const uint8_t *rgba, uint32_t width, uint8_t *row);
/* Converts premultiplied RGBA to straight RGBA. */
void camber_unpremultiply(const uint8_t *from, uint32_t count, uint8_t *to);

#endif
