/* PNGs of any pixels, in any pieces: libpng reads back what was written; and a sink that takes no more is told of,
 * once.
 *
 *     u16 width | opaque << 15, u8 height, u8 compression | texts << 4, u8 rows a piece
 *     texts: u8 characters of the key, key, u8 characters, text
 *     premultiplied pixels, which repeat where they end
 */
#include "fuzz.h"

#include "camber_files.h"

#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

enum { TEXTS_MAX = 3, WIDTH_MAX = 400, HEIGHT_MAX = 64 };

typedef struct picture {
    camber_png_desc desc;
    camber_png_text texts[TEXTS_MAX];
    char words[2 * TEXTS_MAX][256];
    uint32_t piece; /* rows */
    uint8_t *rgba;
} picture;

/* ---- Reading the bytes ---- */

static const char *take_word(fuzz_reader *from, char word[256]) {
    const size_t size = (size_t)fuzz_take(from, 1);
    for (size_t i = 0; i < size && i < 255; i++)
        word[i] = (char)fuzz_take(from, 1);
    return word;
}

static void read_pixels(fuzz_reader *from, picture *made) {
    const size_t wanted = (size_t)4 * made->desc.width * made->desc.height;
    made->rgba = malloc(wanted + 1);
    REQUIRE(made->rgba);
    for (size_t i = 0; i < wanted; i++)
        made->rgba[i] = from->size ? from->bytes[i % from->size] : (uint8_t)(i / 4);
}

static void read_input(fuzz_reader *from, picture *made) {
    const unsigned head = (unsigned)fuzz_take(from, 2), height = (unsigned)fuzz_take(from, 1),
                   kinds = (unsigned)fuzz_take(from, 1);
    *made = (picture){.piece = 1 + (uint32_t)fuzz_take(from, 1)};
    made->desc = (camber_png_desc){.width = (head & 0x7fff) % (WIDTH_MAX + 1),
                                   .height = height % (HEIGHT_MAX + 1),
                                   .opaque = head >> 15,
                                   .texts = made->texts,
                                   .text_count = (kinds >> 4) % (TEXTS_MAX + 1),
                                   .compression = (int)(kinds & 15)};
    for (size_t i = 0; i < made->desc.text_count; i++)
        made->texts[i] =
            (camber_png_text){take_word(from, made->words[2 * i]), take_word(from, made->words[2 * i + 1])};
    read_pixels(from, made);
}

/* ---- Writing ---- */

typedef struct short_sink {
    fuzz_bytes *file;
    size_t calls, refuse_at; /* counted from 1. 0: none */
} short_sink;

static bool take_bytes(void *user, const void *bytes, size_t size_bytes) {
    short_sink *self = user;
    REQUIRE(self->refuse_at == 0 || self->calls < self->refuse_at); /* who was refused stops */
    if (++self->calls == self->refuse_at)
        return false;
    const camber_sink all = fuzz_sink(self->file);
    return all.write(all.user, bytes, size_bytes);
}

static camber_status write_rows(const picture *from, camber_png *png) {
    camber_status status = CAMBER_OK;
    for (uint32_t row = 0; row < from->desc.height && status == CAMBER_OK; row += from->piece) {
        const uint32_t left = from->desc.height - row, count = left < from->piece ? left : from->piece;
        status = camber_png_write_rows(png, from->rgba + (size_t)4 * from->desc.width * row, count);
    }
    return status == CAMBER_OK ? camber_png_finish(png) : status;
}

static camber_status write_picture(fuzz_run *run, const picture *from, short_sink *sink) {
    camber_png *png = NULL;
    camber_status status = camber_png_create(run->context, &from->desc, (camber_sink){take_bytes, sink}, &png);
    REQUIRE((status == CAMBER_OK) == (png != NULL));
    if (status == CAMBER_OK)
        status = write_rows(from, png);
    if (png && status != CAMBER_OK) /* it stays so, and is not told again */
        REQUIRE(camber_png_finish(png) == status);
    camber_png_destroy(png);
    return status;
}

/* ---- Reading ---- */

typedef struct file_reader {
    const fuzz_bytes *file;
    size_t at;
} file_reader;

static void give_bytes(png_structp png, png_bytep bytes, size_t size_bytes) {
    file_reader *from = png_get_io_ptr(png);
    REQUIRE(size_bytes <= from->file->size - from->at);
    memcpy(bytes, from->file->bytes + from->at, size_bytes);
    from->at += size_bytes;
}

static void on_error(png_structp png, png_const_charp message) {
    (void)png;
    fuzz_break(message, __FILE__, __LINE__);
    abort();
}

/* As it was, but for a colour above its alpha, which no straight colour gives. */
static void check_pixel(const uint8_t *read, const uint8_t *given, bool opaque) {
    const unsigned alpha = given[3];
    REQUIRE(read[3] == (opaque ? 255 : alpha));
    for (int c = 0; c < 3; c++) {
        const unsigned most = given[c] < alpha ? given[c] : alpha;
        REQUIRE(opaque ? read[c] == given[c] : (read[c] * alpha + 127) / 255 == most);
    }
}

static void check_texts(png_structp png, png_infop info, const picture *from) {
    png_textp texts = NULL;
    int count = 0;
    png_get_text(png, info, &texts, &count);
    REQUIRE((size_t)count <= from->desc.text_count);
}

static void check_file(const fuzz_bytes *file, const picture *from) {
    file_reader source = {file, 0};
    const uint32_t width = from->desc.width;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, on_error, NULL);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    uint8_t *row = malloc((size_t)4 * width);
    REQUIRE(info && row);
    png_set_read_fn(png, &source, give_bytes);
    png_read_info(png, info);
    REQUIRE(png_get_image_width(png, info) == width && png_get_image_height(png, info) == from->desc.height);
    REQUIRE(!from->desc.opaque || !(png_get_color_type(png, info) & PNG_COLOR_MASK_ALPHA));
    REQUIRE(!from->desc.opaque || !png_get_valid(png, info, PNG_INFO_tRNS));
    png_set_expand(png); /* palettes */
    png_set_add_alpha(png, 255, PNG_FILLER_AFTER);
    png_read_update_info(png, info);
    REQUIRE(png_get_rowbytes(png, info) == (size_t)4 * width && png_get_bit_depth(png, info) == 8);
    for (uint32_t y = 0; y < from->desc.height; y++) {
        png_read_row(png, row, NULL);
        for (uint32_t x = 0; x < width; x++)
            check_pixel(row + (size_t)4 * x, from->rgba + 4 * ((size_t)width * y + x), from->desc.opaque);
    }
    png_read_end(png, info);
    REQUIRE(source.at == file->size);
    check_texts(png, info, from);
    free(row);
    png_destroy_read_struct(&png, &info, NULL);
}

/* ---- All of it ---- */

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    fuzz_reader from = {bytes, size};
    fuzz_bytes file = {0};
    picture made;
    read_input(&from, &made);
    short_sink sink = {.file = &file};
    if (fuzz_done(run, write_picture(run, &made, &sink))) {
        check_file(&file, &made);
        sink = (short_sink){.file = &file, .refuse_at = 1 + (size_t)(run->hash >> 8) % sink.calls};
        const camber_status status = write_picture(run, &made, &sink);
        REQUIRE(status == CAMBER_ERROR_IO || (status == CAMBER_ERROR_MEMORY && run->refused));
        REQUIRE(run->errors == (status != CAMBER_ERROR_IO));
        run->errors = 0;
    }
    free(file.bytes);
    free(made.rgba);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fuzz_each(bytes, size, use);
    return 0;
}
