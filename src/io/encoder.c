/* Encodes whole pictures in memory: premultiplied RGBA8 becomes a file.
 *
 * A PNG uses as few bits as its colours allow: a palette with 1, 2, 4 or 8 bits per pixel for up to 256 colours,
 * otherwise RGB, or RGBA if some pixel is not opaque. All rows are compressed as one block. */
#include "io/encoder.h"

#include "io/colors.h"
#include "io/deflate.h"
#include "io/png_chunks.h"
#include "io/quantize.h"

enum { LEVEL_USUAL = 1, LEVEL_USUAL_PNG8 = 6, LEVEL_MOST = 9, ROWS_AHEAD = 8 };

struct camber_encoder {
    camber_context *context;
    camber_encoder_desc desc;
    camber_png_text *texts; /* copies of desc.texts */
    camber_deflater *deflater;
    camber_colors colors;
    camber_quantizer *quantizer; /* for png8 */
    camber_palette palette;
    uint8_t straight[CAMBER_PALETTE_MOST][4]; /* the palette in the form of the file */
    uint8_t *rows;                            /* before compression; for WebP straight RGBA */
    size_t row_capacity;
    camber_file_bytes file;
};

static bool take_bytes(void *user, const void *bytes, size_t size_bytes) {
    return camber_file_bytes_add(user, bytes, size_bytes);
}

/* ---- Encodings ---- */

static const char *name_of(camber_encoding encoding) {
    return encoding == CAMBER_ENCODING_WEBP ? "webp" : encoding == CAMBER_ENCODING_PNG8 ? "png8" : "png";
}

bool camber_encoding_is_built(camber_encoding encoding) {
    return encoding != CAMBER_ENCODING_WEBP || camber_webp_is_built();
}

uint32_t camber_encoding_get_longest_side(camber_encoding encoding) {
    return encoding == CAMBER_ENCODING_WEBP ? CAMBER_WEBP_LONGEST_SIDE : 65535;
}

camber_status camber_png_check(camber_context *context, int compression, const camber_png_text *texts,
                               size_t text_count) {
    if (compression < 0 || compression > LEVEL_MOST)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "a PNG compression of %d; it must be 1 to 9, or 0 for the default, 1", compression);
    for (size_t i = 0; i < text_count; i++) {
        const size_t length = strlen(texts[i].key);
        if (length < 1 || length > 79)
            return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                               "a PNG text's key of %zu characters; it must have 1 to 79", length);
    }
    return CAMBER_OK;
}

static camber_status check_desc(camber_context *context, const camber_encoder_desc *desc) {
    if (!camber_encoding_is_built(desc->encoding))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "this build has no %s; build camber with libwebp (Debian: libwebp-dev), or write a PNG",
                           name_of(desc->encoding));
    if (desc->quality < 0 || desc->quality > 100)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "a quality of %d; it must be 1 to 100, or 0 for the default, 80", desc->quality);
    return camber_png_check(context, desc->compression, desc->texts, desc->text_count);
}

static camber_status check_size(const camber_encoder *self, const camber_pixels *pixels) {
    const uint32_t longest = camber_encoding_get_longest_side(self->desc.encoding);
    if (pixels->width < 1 || pixels->width > longest || pixels->height < 1 || pixels->height > longest)
        return camber_fail(self->context, CAMBER_ERROR_ARGUMENT,
                           "a picture of %u x %u px as %s; each side must be 1 to %u", pixels->width, pixels->height,
                           name_of(self->desc.encoding), longest);
    if ((uint64_t)pixels->width * pixels->height > CAMBER_PIXELS_MOST)
        return camber_fail(
            self->context, CAMBER_ERROR_ARGUMENT,
            "a picture of %u x %u px as %s, which may have at most %d px; draw a smaller one, or write a "
            "png",
            pixels->width, pixels->height, name_of(self->desc.encoding), CAMBER_PIXELS_MOST);
    return CAMBER_OK;
}

/* ---- Making an encoder ---- */

static camber_status copy_texts(camber_encoder *self, const camber_encoder_desc *desc) {
    self->desc.text_count = 0;
    self->desc.texts = self->texts = camber_alloc(self->context, desc->text_count, sizeof *self->texts);
    for (size_t i = 0; self->texts && i < desc->text_count; i++) {
        char *key = camber_copy_string(self->context, desc->texts[i].key);
        char *text = key ? camber_copy_string(self->context, desc->texts[i].text) : NULL;
        self->texts[i] = (camber_png_text){key, text};
        self->desc.text_count = i + 1;
        if (!text)
            return CAMBER_ERROR_MEMORY;
    }
    return self->texts ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

static void free_texts(camber_encoder *self) {
    for (size_t i = 0; self->texts && i < self->desc.text_count; i++) {
        camber_free(self->context, (char *)(uintptr_t)self->texts[i].key);
        camber_free(self->context, (char *)(uintptr_t)self->texts[i].text);
    }
    camber_free(self->context, self->texts);
}

static camber_status make_png(camber_encoder *self, const camber_encoder_desc *desc) {
    const bool png8 = desc->encoding == CAMBER_ENCODING_PNG8;
    const int usual = png8 ? LEVEL_USUAL_PNG8 : LEVEL_USUAL;
    camber_status status =
        camber_deflater_create(self->context, desc->compression ? desc->compression : usual, &self->deflater);
    if (status == CAMBER_OK)
        status = camber_colors_make(self->context, png8 ? CAMBER_KEYS_MOST : CAMBER_PALETTE_MOST, &self->colors);
    if (status == CAMBER_OK && png8)
        status = camber_quantizer_create(self->context, &self->quantizer);
    return status;
}

camber_status camber_encoder_create(camber_context *context, const camber_encoder_desc *desc,
                                    camber_encoder **encoder) {
    camber_status status = check_desc(context, desc);
    if (status != CAMBER_OK)
        return status;
    camber_encoder *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = made->file.context = context;
    made->desc = *desc;
    status = copy_texts(made, desc);
    if (status == CAMBER_OK && desc->encoding != CAMBER_ENCODING_WEBP)
        status = make_png(made, desc);
    if (status == CAMBER_OK)
        *encoder = made;
    else
        camber_encoder_destroy(made);
    return status;
}

void camber_encoder_destroy(camber_encoder *encoder) {
    if (!encoder)
        return;
    camber_context *context = encoder->context;
    free_texts(encoder);
    camber_deflater_destroy(encoder->deflater);
    camber_quantizer_destroy(encoder->quantizer);
    camber_colors_free(&encoder->colors);
    camber_free(context, encoder->rows);
    camber_free(context, encoder->file.bytes);
    camber_free(context, encoder);
}

/* ---- PNG ---- */

static const uint8_t *row_of(const camber_pixels *pixels, size_t y) {
    return pixels->rgba + (pixels->stride_bytes ? pixels->stride_bytes : 4 * (size_t)pixels->width) * y;
}

static bool is_opaque(const camber_pixels *pixels) {
    for (size_t y = 0; y < pixels->height; y++) {
        const uint8_t *row = row_of(pixels, y);
        uint8_t all = 255;
        for (size_t x = 0; x < pixels->width; x++)
            all &= row[4 * x + 3];
        if (all < 255)
            return false;
    }
    return true;
}

/* Prefetches a row. In a large picture the rows of a tile are far apart, so processors do not prefetch them. */
static void ask_for_row(const camber_pixels *pixels, size_t y) {
#ifdef __GNUC__
    if (y < pixels->height)
        for (size_t i = 0; i < 4 * (size_t)pixels->width; i += 64)
            __builtin_prefetch(row_of(pixels, y) + i);
#else
    (void)pixels, (void)y;
#endif
}

static bool make_room(camber_encoder *self, size_t size_bytes) {
    return camber_grow(self->context, &self->rows, &self->row_capacity, size_bytes, 1);
}

/* Compresses the rows directly into the file. */
static bool put_rows(camber_encoder *self, size_t size_bytes) {
    camber_file_bytes *file = &self->file;
    const size_t most =
        CAMBER_PNG_BEFORE_DATA + camber_deflater_bound(self->deflater, size_bytes) + CAMBER_PNG_AFTER_DATA;
    if (!camber_grow(self->context, &file->bytes, &file->capacity, file->size + most, 1))
        return false;
    uint8_t *chunk = file->bytes + file->size;
    const size_t packed =
        camber_deflater_compress(self->deflater, self->rows, size_bytes, chunk + CAMBER_PNG_BEFORE_DATA);
    camber_png_enclose_data(chunk, packed);
    file->size += CAMBER_PNG_BEFORE_DATA + packed + CAMBER_PNG_AFTER_DATA;
    return true;
}

static camber_status finish_png(camber_encoder *self, const camber_png_head *head, size_t row_bytes) {
    const camber_sink sink = {take_bytes, &self->file};
    const bool written =
        camber_png_put_head(sink, head) && put_rows(self, row_bytes * head->height) && camber_png_put_end(sink);
    return written ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

static camber_status encode_true_color(camber_encoder *self, const camber_pixels *pixels, camber_png_head *head) {
    head->depth = 8;
    head->kind = self->desc.opaque || is_opaque(pixels) ? CAMBER_PNG_KIND_RGB : CAMBER_PNG_KIND_RGBA;
    const size_t row_bytes = camber_png_row_bytes(head->kind, head->depth, head->width);
    if (!make_room(self, row_bytes * head->height))
        return CAMBER_ERROR_MEMORY;
    for (size_t y = 0; y < head->height; y++) {
        ask_for_row(pixels, y + ROWS_AHEAD);
        camber_png_make_row(head->kind, row_of(pixels, y), head->width, self->rows + row_bytes * y);
    }
    return finish_png(self, head, row_bytes);
}

/* Packs indices into the palette, depth bits each, with the first in the highest bits. */
static void pack_row(const uint16_t *numbers, const uint8_t *places, size_t width, unsigned depth, uint8_t *row) {
    const size_t a_byte = 8 / depth;
    for (size_t x = 0; x < width; x += a_byte) {
        unsigned byte = 0;
        for (size_t k = 0; k < a_byte; k++)
            byte = byte << depth | (x + k < width ? places[numbers[x + k]] : 0u);
        *row++ = (uint8_t)byte;
    }
}

static void make_index_rows(const camber_encoder *self, const camber_png_head *head, size_t row_bytes) {
    const uint8_t *places = self->palette.places;
    const uint16_t *numbers = self->colors.numbers;
    for (size_t y = 0; y < head->height; y++, numbers += head->width) {
        uint8_t *row = self->rows + row_bytes * y;
        *row++ = 0; /* no filter */
        if (head->depth < 8)
            pack_row(numbers, places, head->width, (unsigned)head->depth, row);
        else
            for (size_t x = 0; x < head->width; x++)
                row[x] = places[numbers[x]];
    }
}

/* Moves colours that are not opaque to the front, so that the file needs no alpha for the others. order: the new index
 * of each colour. */
static void sort_palette(const camber_palette *palette, uint8_t straight[][4], uint8_t order[CAMBER_PALETTE_MOST]) {
    uint8_t at = 0;
    for (int opaque = 0; opaque < 2; opaque++)
        for (size_t i = 0; i < palette->count; i++)
            if ((palette->colors[i][3] == 255) == opaque) {
                camber_unpremultiply(palette->colors[i], 1, straight[at]);
                order[i] = at++;
            }
}

static int depth_of(size_t color_count) {
    return color_count <= 2 ? 1 : color_count <= 4 ? 2 : color_count <= 16 ? 4 : 8;
}

/* Whether a palette saves bytes, which it does not if the picture has hardly more pixels than colours. */
static bool is_worth_it(const camber_png_head *head) {
    const size_t indexed = camber_png_row_bytes(CAMBER_PNG_KIND_PALETTE, head->depth, head->width) * head->height;
    const size_t plain = camber_png_row_bytes(CAMBER_PNG_KIND_RGB, 8, head->width) * head->height;
    return indexed + 12 + 3 * head->palette_count <= plain;
}

/* Uses the numbered colours as the palette. */
static void take_colors(const camber_colors *colors, camber_palette *palette) {
    palette->count = colors->table.count;
    memcpy(palette->colors, colors->colors, sizeof *palette->colors * palette->count);
    for (size_t i = 0; i < palette->count; i++)
        palette->places[i] = (uint8_t)i;
}

static camber_status encode_palette(camber_encoder *self, camber_png_head *head) {
    camber_palette *palette = &self->palette;
    const size_t row_bytes = camber_png_row_bytes(head->kind, head->depth, head->width);
    uint8_t order[CAMBER_PALETTE_MOST];
    if (!make_room(self, row_bytes * head->height))
        return CAMBER_ERROR_MEMORY;
    sort_palette(palette, self->straight, order);
    head->palette = (const uint8_t(*)[4])self->straight;
    for (size_t i = 0; i < self->colors.table.count; i++)
        palette->places[i] = order[palette->places[i]];
    make_index_rows(self, head, row_bytes);
    return finish_png(self, head, row_bytes);
}

static camber_status encode_png(camber_encoder *self, const camber_pixels *pixels) {
    const bool png8 = self->desc.encoding == CAMBER_ENCODING_PNG8;
    camber_png_head head = {.width = pixels->width,
                            .height = pixels->height,
                            .kind = CAMBER_PNG_KIND_PALETTE,
                            .texts = self->desc.texts,
                            .text_count = self->desc.text_count,
                            .dpi = self->desc.dpi};
    bool fits;
    const camber_status status = camber_colors_number(&self->colors, pixels, self->desc.opaque, png8, &fits);
    if (status != CAMBER_OK)
        return status;
    if (!fits)
        return encode_true_color(self, pixels, &head);
    const bool few = self->colors.table.count <= CAMBER_PALETTE_MOST && self->colors.drop == 0;
    if (few && !(png8 && camber_colors_have_flat(&self->colors)))
        take_colors(&self->colors, &self->palette);
    else
        camber_quantize(self->quantizer, &self->colors, &self->palette);
    head.palette_count = self->palette.count;
    head.depth = depth_of(self->palette.count);
    return png8 || is_worth_it(&head) ? encode_palette(self, &head) : encode_true_color(self, pixels, &head);
}

camber_status camber_encoder_encode(camber_encoder *encoder, const camber_pixels *pixels, const uint8_t **bytes,
                                    size_t *size_bytes) {
    camber_status status = check_size(encoder, pixels);
    if (status != CAMBER_OK)
        return status;
    encoder->file.size = 0;
    encoder->file.refused = false;
    if (encoder->desc.encoding != CAMBER_ENCODING_WEBP)
        status = encode_png(encoder, pixels);
    else if (!make_room(encoder, 4 * (size_t)pixels->width * pixels->height))
        status = CAMBER_ERROR_MEMORY;
    else
        status = camber_webp_encode(&encoder->desc, pixels, encoder->rows, &encoder->file);
    if (status != CAMBER_OK)
        return status;
    *bytes = encoder->file.bytes;
    *size_bytes = encoder->file.size;
    return CAMBER_OK;
}
