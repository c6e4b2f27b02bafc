/* Writes a PNG from rows that arrive as they are drawn. A small picture is kept in memory, and an encoder makes the
 * file at the end. A large one is a stream, for which only one row and the compressor's state are in memory. */
#include "io/deflate.h"
#include "io/encoder.h"
#include "io/png_chunks.h"

enum { HELD_PX = 1 << 22 };

struct camber_png {
    camber_context *context;
    camber_sink sink;
    uint32_t width, height, rows_left;
    camber_status failed; /* the first failure; nothing is written after it */
    /* for a small picture: */
    camber_encoder *encoder;
    uint8_t *rgba; /* the rows so far */
    /* for a large one: */
    camber_deflate_stream *stream;
    camber_png_kind kind;
    uint8_t *row;
};

static camber_status check_desc(camber_context *context, const camber_png_desc *desc) {
    if (desc->width < 1 || desc->width > 65535 || desc->height < 1 || desc->height > 65535)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "a picture of %u x %u px; each side must be 1 to 65535",
                           desc->width, desc->height);
    return camber_png_check(context, desc->compression, desc->texts, desc->text_count);
}

/* ---- A small picture ---- */

static camber_status begin_held(camber_png *png, const camber_png_desc *desc) {
    const camber_encoder_desc encoder = {.opaque = desc->opaque,
                                         .compression = desc->compression,
                                         .texts = desc->texts,
                                         .text_count = desc->text_count,
                                         .dpi = desc->dpi};
    png->rgba = camber_alloc(png->context, (size_t)desc->width * desc->height, 4);
    return png->rgba ? camber_encoder_create(png->context, &encoder, &png->encoder) : CAMBER_ERROR_MEMORY;
}

static camber_status finish_held(camber_png *png) {
    const camber_pixels pixels = {.rgba = png->rgba, .width = png->width, .height = png->height};
    const uint8_t *bytes = NULL;
    size_t size_bytes = 0;
    const camber_status status = camber_encoder_encode(png->encoder, &pixels, &bytes, &size_bytes);
    if (status != CAMBER_OK)
        return status;
    return png->sink.write(png->sink.user, bytes, size_bytes) ? CAMBER_OK : CAMBER_ERROR_IO;
}

/* ---- A large picture ---- */

static bool put_data(void *user, const void *bytes, size_t size_bytes) {
    const camber_png *png = user;
    return camber_png_put_data(png->sink, bytes, size_bytes);
}

static camber_status begin_stream(camber_png *png, const camber_png_desc *desc) {
    png->kind = desc->opaque ? CAMBER_PNG_KIND_RGB : CAMBER_PNG_KIND_RGBA;
    const camber_png_head head = {.width = desc->width,
                                  .height = desc->height,
                                  .kind = png->kind,
                                  .depth = 8,
                                  .texts = desc->texts,
                                  .text_count = desc->text_count,
                                  .dpi = desc->dpi};
    png->row = camber_alloc(png->context, camber_png_row_bytes(png->kind, 8, desc->width), 1);
    if (!png->row)
        return CAMBER_ERROR_MEMORY;
    const camber_status status = camber_deflate_stream_create(png->context, desc->compression ? desc->compression : 1,
                                                              (camber_sink){put_data, png}, &png->stream);
    if (status != CAMBER_OK)
        return status;
    return camber_png_put_head(png->sink, &head) ? CAMBER_OK : CAMBER_ERROR_IO;
}

static camber_status finish_stream(camber_png *png) {
    return camber_deflate_stream_finish(png->stream) && camber_png_put_end(png->sink) ? CAMBER_OK : CAMBER_ERROR_IO;
}

static bool stream_row(camber_png *png, const uint8_t *rgba) {
    camber_png_make_row(png->kind, rgba, png->width, png->row);
    return camber_deflate_stream_write(png->stream, png->row, camber_png_row_bytes(png->kind, 8, png->width));
}

/* ---- Both ---- */

camber_status camber_png_create(camber_context *context, const camber_png_desc *desc, camber_sink sink,
                                camber_png **png) {
    camber_status status = check_desc(context, desc);
    if (status != CAMBER_OK)
        return status;
    camber_png *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->sink = sink;
    made->width = desc->width;
    made->height = made->rows_left = desc->height;
    status = (uint64_t)desc->width * desc->height <= HELD_PX ? begin_held(made, desc) : begin_stream(made, desc);
    if (status == CAMBER_OK)
        *png = made;
    else
        camber_png_destroy(made);
    return status;
}

camber_status camber_png_write_rows(camber_png *png, const uint8_t *rgba, uint32_t row_count) {
    if (png->failed != CAMBER_OK)
        return png->failed; /* logged when it failed */
    if (row_count > png->rows_left)
        return camber_fail(png->context, CAMBER_ERROR_IO,
                           "PNG: %u more rows, but it lacks only %u; write as many rows as its height", row_count,
                           png->rows_left);
    const size_t row_bytes = 4 * (size_t)png->width;
    if (png->rgba)
        memcpy(png->rgba + row_bytes * (png->height - png->rows_left), rgba, row_bytes * row_count);
    for (uint32_t i = 0; i < row_count && png->stream; i++)
        if (!stream_row(png, rgba + row_bytes * i))
            return png->failed = CAMBER_ERROR_IO;
    png->rows_left -= row_count;
    return CAMBER_OK;
}

camber_status camber_png_finish(camber_png *png) {
    if (png->failed != CAMBER_OK)
        return png->failed; /* logged when it failed */
    if (png->rows_left > 0)
        return camber_fail(png->context, CAMBER_ERROR_IO, "PNG: %u rows are missing; write them before the end",
                           png->rows_left);
    return png->failed = png->encoder ? finish_held(png) : finish_stream(png);
}

void camber_png_destroy(camber_png *png) {
    if (!png)
        return;
    camber_encoder_destroy(png->encoder);
    camber_deflate_stream_destroy(png->stream);
    camber_free(png->context, png->rgba);
    camber_free(png->context, png->row);
    camber_free(png->context, png);
}
