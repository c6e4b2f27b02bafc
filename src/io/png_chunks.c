/* The chunks of a PNG as its specification defines them: length, type, data, CRC; and its rows.
 *
 * Rows are not filtered. Maps consist of flat areas and thin lines in few colours, whose repetitions filters would
 * destroy. Without filters files are a third smaller, and are made in less time. */
#include "io/png_chunks.h"

#include "io/deflate.h"

typedef struct part {
    const void *bytes;
    size_t size_bytes;
} part;

static void put_u32(uint8_t *bytes, uint32_t value) {
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(value >> (24 - 8 * i));
}

static bool put(camber_sink sink, const void *bytes, size_t size_bytes) {
    return size_bytes == 0 || sink.write(sink.user, bytes, size_bytes);
}

static bool put_chunk(camber_sink sink, const char *type, const part *parts, size_t count) {
    uint8_t head[8], tail[4];
    size_t size_bytes = 0;
    for (size_t i = 0; i < count; i++)
        size_bytes += parts[i].size_bytes;
    put_u32(head, (uint32_t)size_bytes);
    memcpy(head + 4, type, 4);
    uint32_t crc = camber_crc32(0, head + 4, 4);
    bool taken = put(sink, head, sizeof head);
    for (size_t i = 0; i < count && taken; i++) {
        crc = camber_crc32(crc, parts[i].bytes, parts[i].size_bytes);
        taken = put(sink, parts[i].bytes, parts[i].size_bytes);
    }
    put_u32(tail, crc);
    return taken && put(sink, tail, sizeof tail);
}

/* The fields: keyword, 0, no compression, compression method, no language, no translated keyword, text. */
static bool put_text(camber_sink sink, const camber_png_text *text) {
    static const uint8_t between[5] = {0};
    const part parts[] = {{text->key, strlen(text->key)}, {between, sizeof between}, {text->text, strlen(text->text)}};
    return put_chunk(sink, "iTXt", parts, 3);
}

static bool put_palette(camber_sink sink, const camber_png_head *head) {
    uint8_t colors[3 * CAMBER_PALETTE_MOST], alphas[CAMBER_PALETTE_MOST];
    size_t alpha_count = 0;
    for (size_t i = 0; i < head->palette_count; i++) {
        memcpy(colors + 3 * i, head->palette[i], 3);
        alphas[i] = head->palette[i][3];
        if (alphas[i] < 255)
            alpha_count = i + 1;
    }
    return put_chunk(sink, "PLTE", &(part){colors, 3 * head->palette_count}, 1) &&
           (alpha_count == 0 || put_chunk(sink, "tRNS", &(part){alphas, alpha_count}, 1));
}

/* The fields: pixels per unit along both axes, and the unit, which is the metre. */
static bool put_density(camber_sink sink, double dpi) {
    uint8_t phys[9] = {[8] = 1};
    const double per_metre = dpi / 0.0254 + 0.5;
    if (!(per_metre >= 1.0 && per_metre < 2147483648.0))
        return true;
    put_u32(phys, (uint32_t)per_metre);
    put_u32(phys + 4, (uint32_t)per_metre);
    return put_chunk(sink, "pHYs", &(part){phys, sizeof phys}, 1);
}

bool camber_png_put_head(camber_sink sink, const camber_png_head *head) {
    static const uint8_t signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    static const uint8_t perceptual = 0; /* the rendering intent of sRGB */
    uint8_t ihdr[13] = {0};
    put_u32(ihdr, head->width);
    put_u32(ihdr + 4, head->height);
    ihdr[8] = (uint8_t)head->depth;
    ihdr[9] = (uint8_t)head->kind;
    bool taken = put(sink, signature, sizeof signature) && put_chunk(sink, "IHDR", &(part){ihdr, sizeof ihdr}, 1) &&
                 put_chunk(sink, "sRGB", &(part){&perceptual, 1}, 1) && put_density(sink, head->dpi);
    for (size_t i = 0; i < head->text_count && taken; i++)
        taken = put_text(sink, &head->texts[i]);
    return taken && (head->kind != CAMBER_PNG_KIND_PALETTE || put_palette(sink, head));
}

bool camber_png_put_data(camber_sink sink, const void *bytes, size_t size_bytes) {
    return put_chunk(sink, "IDAT", &(part){bytes, size_bytes}, 1);
}

void camber_png_enclose_data(uint8_t *chunk, size_t size_bytes) {
    put_u32(chunk, (uint32_t)size_bytes);
    memcpy(chunk + 4, "IDAT", 4);
    put_u32(chunk + CAMBER_PNG_BEFORE_DATA + size_bytes, camber_crc32(0, chunk + 4, 4 + size_bytes));
}

bool camber_png_put_end(camber_sink sink) {
    return put_chunk(sink, "IEND", NULL, 0);
}

/* ---- Rows ---- */

size_t camber_png_row_bytes(camber_png_kind kind, int depth, uint32_t width) {
    const size_t samples = kind == CAMBER_PNG_KIND_RGBA ? 4 : kind == CAMBER_PNG_KIND_RGB ? 3 : 1;
    return 1 + (samples * width * (size_t)depth + 7) / 8;
}

void camber_unpremultiply(const uint8_t *from, uint32_t count, uint8_t *to) {
    for (size_t i = 0; i < count; i++, from += 4, to += 4) {
        const unsigned alpha = from[3];
        memcpy(to, from, 4);
        if (alpha == 255)
            continue;
        for (unsigned c = 0; c < 3; c++) {
            const unsigned straight = alpha ? (from[c] * 255u + alpha / 2) / alpha : 0;
            to[c] = (uint8_t)(straight < 255 ? straight : 255);
        }
    }
}

void camber_png_make_row(camber_png_kind kind, const uint8_t *rgba, uint32_t width, uint8_t *row) {
    *row++ = 0; /* no filter */
    if (kind == CAMBER_PNG_KIND_RGBA) {
        camber_unpremultiply(rgba, width, row);
        return;
    }
    for (size_t i = 0; i + 1 < width; i++) /* four bytes are stored at once; the fourth belongs to the next pixel */
        memcpy(row + 3 * i, rgba + 4 * i, 4);
    memcpy(row + 3 * (size_t)(width - 1), rgba + 4 * (size_t)(width - 1), 3);
}
