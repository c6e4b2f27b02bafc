/* A style's sprite: an index beside a sheet of 16 x 16 px, or a sheet beside an index of one image. */
#include "fuzz.h"

#include "style/sprite.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char style_text[] = "{\"version\": 8, \"sprite\": \"%s\", \"layers\": [{\"id\": \"b\", \"type\": "
                                 "\"background\", \"paint\": {\"background-pattern\": \"a\"}}]}";
static const char one_image[] = "{\"a\": {\"x\": 3, \"y\": 2, \"width\": 5, \"height\": 7, \"pixelRatio\": 2}}";
/* 16 x 16 px, grey. */
static const uint8_t small_sheet[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00, 0x00,
    0x10, 0x00, 0x00, 0x00, 0x10, 0x08, 0x00, 0x00, 0x00, 0x00, 0x3a, 0x98, 0xa0, 0xbd, 0x00, 0x00, 0x00, 0x11, 0x49,
    0x44, 0x41, 0x54, 0x18, 0xd3, 0x63, 0x6c, 0x60, 0x40, 0x05, 0x4c, 0x0c, 0x23, 0x5a, 0x00, 0x00, 0x99, 0x90, 0x00,
    0xa0, 0xfe, 0x56, 0x1b, 0x60, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

static void write_file(const char *base, const char *tail, const void *bytes, size_t size) {
    char path[96];
    snprintf(path, sizeof path, "%s%s", base, tail);
    FILE *file = fopen(path, "wb");
    REQUIRE(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
}

static void remove_file(const char *base, const char *tail) {
    char path[96];
    snprintf(path, sizeof path, "%s%s", base, tail);
    remove(path);
}

static void check(fuzz_run *run, camber_sprites *sprites) {
    for (size_t i = 0; i < sprites->image_count; i++) {
        const camber_sprite_image *image = sprites->images + i;
        const camber_sprite_sheet *sheet = sprites->sheets + image->sheet;
        REQUIRE(image->width >= 1 && image->height >= 1 && image->pixel_ratio > 0.0);
        REQUIRE(image->x + image->width <= sheet->width && image->y + image->height <= sheet->height);
        REQUIRE(strcmp(camber_sprites_find(sprites, image->name)->name, image->name) == 0);
        REQUIRE(i == 0 || strcmp(sprites->images[i - 1].name, image->name) <= 0);
    }
    (void)run;
}

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    char base[64], text[512];
    camber_style *style = NULL;
    camber_sprites *sprites = NULL;
    const bool index = bytes[0] & 1;
    snprintf(base, sizeof base, "/tmp/camber-fuzz-%ld-sprite", (long)getpid());
    snprintf(text, sizeof text, style_text, base);
    write_file(base, ".png", index ? small_sheet : bytes + 1, index ? sizeof small_sheet : size - 1);
    write_file(base, ".json", index ? (const void *)(bytes + 1) : one_image, index ? size - 1 : sizeof one_image - 1);
    if (fuzz_done(run, camber_style_parse(run->context, text, strlen(text), "fuzz", &style)) &&
        fuzz_done(run, camber_sprites_load(run->context, style, NULL, 1.0, &sprites)))
        check(run, sprites);
    camber_sprites_destroy(sprites);
    camber_style_destroy(style);
    remove_file(base, ".png");
    remove_file(base, ".json");
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    if (size)
        fuzz_each(bytes, size, use);
    return 0;
}
