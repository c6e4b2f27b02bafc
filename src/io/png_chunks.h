/* The chunks that a PNG is made of, and its rows. */
#ifndef CAMBER_IO_PNG_CHUNKS_H
#define CAMBER_IO_PNG_CHUNKS_H

#include "base/base.h"

enum { CAMBER_PALETTE_MOST = 256 };

/* Values are those of the PNG specification. */
typedef enum camber_png_kind {
    CAMBER_PNG_KIND_RGB = 2,
    CAMBER_PNG_KIND_PALETTE = 3,
    CAMBER_PNG_KIND_RGBA = 6,
} camber_png_kind;

typedef struct camber_png_head {
    uint32_t width, height;
    camber_png_kind kind;
    int depth; /* bits of a sample: 8, of a palette's also 1, 2 and 4 */
    const camber_png_text *texts;
    size_t text_count;
    const uint8_t (*palette)[4]; /* straight RGBA; those with an alpha stand before the opaque ones */
    size_t palette_count;
} camber_png_head;

/* Writes all that stands before the pixels. These three return false where the sink refuses. */
bool camber_png_put_head(camber_sink sink, const camber_png_head *head);
/* Writes a piece of the compressed rows. */
bool camber_png_put_data(camber_sink sink, const void *bytes, size_t size_bytes);
bool camber_png_put_end(camber_sink sink);

/* Compressed rows that are made in their place in the file have so many bytes of their chunk before and behind them. */
enum { CAMBER_PNG_BEFORE_DATA = 8, CAMBER_PNG_BEHIND_DATA = 4 };
/* Writes these. chunk is where the first of them goes. */
void camber_png_enclose_data(uint8_t *chunk, size_t size_bytes);

/* The bytes of a row in the file: its filter and its samples. */
size_t camber_png_row_bytes(camber_png_kind kind, int depth, uint32_t width);
/* Makes a row of kind RGB or RGBA of premultiplied RGBA. */
void camber_png_make_row(camber_png_kind kind, const uint8_t *rgba, uint32_t width, uint8_t *row);
/* Makes straight RGBA of premultiplied. */
void camber_unpremultiply(const uint8_t *from, uint32_t count, uint8_t *to);

#endif
