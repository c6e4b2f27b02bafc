/* Text: a font file, a range of glyphs, or a text for the shipped fonts. The first byte says which, the second how it
 * is laid out. */
#include "fuzz.h"

#include "camber_text.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { OF_FONT, OF_RANGE, OF_TEXT };

static const char *const names[] = {"Fuzz"};
/* Latin with marks, Arabic, Devanagari, an ideograph and a bracket. */
static const char letters[] = "oH fi A\xcc\x81(x)\n\xd8\xa7\xd9\x84\xd9\x84 \xe0\xa4\x95\xe0\xa5\x8d\xe0\xa4\xb7 "
                              "\xe6\x9d\xb1\xe3\x80\x8c";

typedef struct range_bytes {
    const uint8_t *bytes;
    size_t size;
} range_bytes;

static camber_status read_range(void *user, const char *stack, uint32_t first, const uint8_t **bytes,
                                size_t *size_bytes) {
    const range_bytes *range = user;
    REQUIRE(strcmp(stack, names[0]) == 0 && first % 256 == 0);
    if (first > 0x600)
        return CAMBER_ERROR_NOT_FOUND;
    *bytes = range->bytes;
    *size_bytes = range->size;
    return CAMBER_OK;
}

static void check_outline(const camber_outline *outline) {
    for (size_t i = 0; i < outline->ring_count; i++) {
        REQUIRE(outline->offsets[i] + 3 <= outline->offsets[i + 1]);
        for (size_t p = outline->offsets[i]; p < outline->offsets[i + 1]; p++) {
            const float x = outline->points[2 * p], y = outline->points[2 * p + 1];
            REQUIRE(x >= outline->left && x <= outline->right && y >= outline->top && y <= outline->bottom);
        }
    }
}

static void check(fuzz_run *run, camber_fonts *fonts, const camber_text_run *of, const camber_text *text) {
    size_t next = 0;
    for (size_t i = 0; i < text->line_count; i++) {
        REQUIRE(text->lines[i].first == next && isfinite(text->lines[i].width));
        next += text->lines[i].count;
    }
    REQUIRE(next == text->glyph_count);
    for (size_t i = 0; i < text->glyph_count; i++) {
        const camber_text_glyph *glyph = &text->glyphs[i];
        camber_outline outline;
        REQUIRE(glyph->run == 0 && glyph->byte < of->size_bytes && isfinite(glyph->x) && isfinite(glyph->y));
        if (i < 64 && fuzz_done(run, camber_fonts_get_outline(fonts, glyph->glyph, 0.0f, &outline)))
            check_outline(&outline);
    }
}

/* Draws the text at a point and along a line that turns. */
static void draw(fuzz_run *run, camber_fonts *fonts, const camber_text *text, uint8_t how) {
    const float line[] = {0.0f, 0.0f, 200.0f, 10.0f, 200.0f, 10.0f, 150.0f, (float)how, 900.0f, 0.0f};
    const camber_text_position positions[] = {
        {.x = 10.0f, .size_px = 12.0f, .turn_deg = (float)how},
        {.size_px = 12.0f, .points = line, .point_count = 5, .shift_px = (float)how, .max_turn_deg = 180.0f}};
    camber_text_rings *rings = NULL;
    camber_text_box box;
    if (!fuzz_done(run, camber_text_rings_create(fonts, &rings)))
        return;
    for (size_t i = 0; i < (text->vertical ? 1u : 2u); i++)
        if (fuzz_done(run, camber_text_rings_add(rings, text, &positions[i], &box))) {
            const camber_polylines_desc desc = camber_text_rings_get(rings);
            REQUIRE(desc.offsets[desc.polyline_count] == desc.point_count);
            for (size_t p = 0; p < 2 * desc.point_count; p++)
                REQUIRE(isfinite(desc.points[p]));
        }
    camber_text_rings_remove_last(rings);
    camber_text_rings_destroy(rings);
}

static void lay_out(fuzz_run *run, const camber_fonts_desc *desc, const camber_text_run *of, uint8_t how) {
    camber_fonts *fonts = NULL;
    camber_text *text = NULL;
    const camber_text_desc laid_out = {.runs = of,
                                       .run_count = 1,
                                       .max_width_em = (float)(how & 7),
                                       .letter_spacing_em = how & 8 ? 0.1f : 0.0f,
                                       .anchor = (camber_text_anchor)((how >> 4) % 9),
                                       .justify = (camber_text_justify)(how & 3),
                                       .vertical = how >> 7};
    if (fuzz_done(run, camber_fonts_create(run->context, desc, &fonts)) &&
        fuzz_done(run, camber_text_shape(fonts, &laid_out, &text))) {
        check(run, fonts, of, text);
        draw(run, fonts, text, how);
    }
    camber_text_destroy(text);
    camber_fonts_destroy(fonts);
}

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    char folder[64], path[80];
    const int kind = bytes[0] % 3;
    range_bytes range = {bytes + 2, size - 2};
    const char *const folders[] = {folder};
    camber_fonts_desc desc = {.no_system = true};
    camber_text_run of = {.text = letters, .size_bytes = sizeof letters - 1, .fonts = names, .font_count = 1};
    if (kind == OF_FONT) {
        snprintf(folder, sizeof folder, "/tmp/camber-fuzz-%ld-fonts", (long)getpid());
        snprintf(path, sizeof path, "%s/fuzz.ttf", folder);
        mkdir(folder, 0700);
        FILE *file = fopen(path, "wb");
        REQUIRE(file && fwrite(range.bytes, 1, range.size, file) == range.size && fclose(file) == 0);
        desc.folders = folders;
        desc.folder_count = 1;
    } else if (kind == OF_RANGE) {
        desc.glyphs = read_range;
        desc.glyphs_user = &range;
    } else {
        of.text = (const char *)range.bytes;
        of.size_bytes = range.size;
    }
    lay_out(run, &desc, &of, bytes[1]);
    if (kind == OF_FONT) {
        remove(path);
        rmdir(folder);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    if (size > 2)
        fuzz_each(bytes, size, use);
    return 0;
}
