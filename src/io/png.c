/* Writes a PNG through libpng, row by row, so that the whole picture need not be in memory. libpng reports errors by
 * longjmp; every call of it that may jump is in a function with setjmp and no changing locals. */
#include "base/base.h"

#include <png.h>
#include <setjmp.h>
#include <string.h>

struct camber_png {
    camber_context *context;
    png_structp png;
    png_infop info;
    camber_sink sink;
    uint32_t width, rows_left;
    bool opaque;
    camber_status failed; /* the first failure; nothing is written after it */
    uint8_t *row;
};

static void on_error(png_structp png, png_const_charp message) {
    camber_png *writer = png_get_error_ptr(png);
    /* A sink that refuses has said why, and a lack of memory has been logged. */
    if (writer->failed == CAMBER_OK)
        writer->failed = camber_fail(writer->context, CAMBER_ERROR_IO, "PNG: %s; write a smaller picture", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message) {
    const camber_png *writer = png_get_error_ptr(png);
    if (writer->failed == CAMBER_OK)
        camber_log(writer->context, CAMBER_LOG_WARNING, "PNG: %s", message);
}

/* Also serves zlib. libpng can do without some allocations, but a writer cannot. */
static png_voidp on_allocate(png_structp png, png_alloc_size_t size_bytes) {
    camber_png *writer = png_get_mem_ptr(png);
    void *block = camber_resize_quietly(writer->context, NULL, size_bytes);
    if (!block && writer->failed == CAMBER_OK)
        writer->failed = camber_fail(writer->context, CAMBER_ERROR_MEMORY,
                                     "PNG: out of memory: %zu bytes; write a smaller picture", (size_t)size_bytes);
    return block;
}

static void on_free(png_structp png, png_voidp block) {
    const camber_png *writer = png_get_mem_ptr(png);
    camber_free(writer->context, block);
}

static void on_write(png_structp png, png_bytep bytes, size_t size_bytes) {
    camber_png *writer = png_get_io_ptr(png);
    if (writer->sink.write(writer->sink.user, bytes, size_bytes))
        return;
    writer->failed = CAMBER_ERROR_IO;
    png_error(png, "the output takes no more");
}

static void on_flush(png_structp png) {
    (void)png;
}

/* No local changes between setjmp and the calls that may jump. */
static camber_status write_head(camber_png *writer, const camber_png_desc *desc) {
    if (setjmp(png_jmpbuf(writer->png)))
        return writer->failed;
    png_set_write_fn(writer->png, writer, on_write, on_flush);
    png_set_compression_level(writer->png, desc->compression ? desc->compression : 1);
    /* No filter: maps are flat areas and thin lines of few colours, whose repetitions filters destroy. Porto at 1024
     * px: with differences at level 3 39 ms and 1013 kB; without them 34 ms and 839 kB, and at level 1 28 ms and 857
     * kB. */
    png_set_filter(writer->png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    png_set_IHDR(writer->png, writer->info, desc->width, desc->height, 8,
                 desc->opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    png_set_sRGB(writer->png, writer->info, PNG_sRGB_INTENT_PERCEPTUAL);
    for (size_t i = 0; i < desc->text_count; i++) {
        png_text text = {.compression = PNG_ITXT_COMPRESSION_NONE,
                         .key = (char *)(uintptr_t)desc->texts[i].key,
                         .text = (char *)(uintptr_t)desc->texts[i].text};
        png_set_text(writer->png, writer->info, &text, 1);
    }
    png_write_info(writer->png, writer->info);
    return writer->failed;
}

static camber_status check_desc(camber_context *context, const camber_png_desc *desc) {
    if (desc->width < 1 || desc->width > 65535 || desc->height < 1 || desc->height > 65535)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "a picture of %u x %u px; each side must be 1 to 65535",
                           desc->width, desc->height);
    if (desc->compression < 0 || desc->compression > 9)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "a PNG compression of %d; it must be 1 to 9, or 0 for 1",
                           desc->compression);
    for (size_t i = 0; i < desc->text_count; i++) {
        const size_t length = strlen(desc->texts[i].key);
        if (length < 1 || length > 79)
            return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                               "a PNG text's key of %zu characters; it must have 1 to 79", length);
    }
    return CAMBER_OK;
}

camber_status camber_png_create(camber_context *context, const camber_png_desc *desc, camber_sink sink,
                                camber_png **png) {
    camber_status status = check_desc(context, desc);
    if (status != CAMBER_OK)
        return status;
    camber_png *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    *made = (camber_png){
        .context = context, .sink = sink, .width = desc->width, .rows_left = desc->height, .opaque = desc->opaque};
    made->row = camber_alloc(context, desc->width, 4);
    made->png = !made->row ? NULL
                           : png_create_write_struct_2(PNG_LIBPNG_VER_STRING, made, on_error, on_warning, made,
                                                       on_allocate, on_free);
    made->info = made->png ? png_create_info_struct(made->png) : NULL;
    if (!made->info) {
        camber_png_destroy(made);
        return CAMBER_ERROR_MEMORY;
    }
    status = write_head(made, desc);
    if (status == CAMBER_OK)
        *png = made;
    else
        camber_png_destroy(made);
    return status;
}

static void pack_opaque(uint8_t *to, const uint8_t *from, uint32_t width) {
    for (uint32_t i = 0; i < width; i++)
        memcpy(to + 3 * i, from + 4 * i, 3);
}

static void unpremultiply(uint8_t *to, const uint8_t *from, uint32_t width) {
    for (uint32_t i = 0; i < width; i++) {
        const unsigned alpha = from[4 * i + 3];
        for (unsigned c = 0; c < 3; c++) {
            const unsigned straight = alpha ? (from[4 * i + c] * 255u + alpha / 2) / alpha : 0;
            to[4 * i + c] = (uint8_t)(straight < 255 ? straight : 255);
        }
        to[4 * i + 3] = (uint8_t)alpha;
    }
}

static camber_status write_row(camber_png *writer) {
    if (setjmp(png_jmpbuf(writer->png)))
        return writer->failed;
    png_write_row(writer->png, writer->row);
    return writer->failed;
}

camber_status camber_png_write_rows(camber_png *png, const uint8_t *rgba, uint32_t row_count) {
    if (png->failed != CAMBER_OK)
        return png->failed; /* told when it failed */
    if (row_count > png->rows_left)
        return camber_fail(png->context, CAMBER_ERROR_IO,
                           "PNG: %u rows, and it takes %u more; write those of its height", row_count, png->rows_left);
    for (uint32_t i = 0; i < row_count; i++) {
        const uint8_t *from = rgba + 4 * (size_t)png->width * i;
        if (png->opaque)
            pack_opaque(png->row, from, png->width);
        else
            unpremultiply(png->row, from, png->width);
        const camber_status status = write_row(png);
        if (status != CAMBER_OK)
            return status;
        png->rows_left--;
    }
    return CAMBER_OK;
}

static camber_status write_end(camber_png *writer) {
    if (setjmp(png_jmpbuf(writer->png)))
        return writer->failed;
    png_write_end(writer->png, NULL);
    return writer->failed;
}

camber_status camber_png_finish(camber_png *png) {
    if (png->failed != CAMBER_OK)
        return png->failed; /* told when it failed */
    if (png->rows_left > 0)
        return camber_fail(png->context, CAMBER_ERROR_IO, "PNG: %u rows are missing; write them before the end",
                           png->rows_left);
    return write_end(png);
}

void camber_png_destroy(camber_png *png) {
    if (!png)
        return;
    if (png->png)
        png_destroy_write_struct(&png->png, &png->info);
    camber_free(png->context, png->row);
    camber_free(png->context, png);
}
