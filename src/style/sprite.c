/* Loads the sprites of a style: a sheet of pictures (PNG) and an index (JSON) with the position of each picture.
 *
 * Input: the style's sprite URLs and the ratio of device pixels. Output: images by name. A sprite on the network causes
 * a warning and is left out, because a map without its patterns is better than no map. */
#include "style/sprite.h"

#include "features/features.h"
#include "style/json.h"
#include "style/signs.h"
#include "style/symbol.h"
#include "style/url.h"

#include <errno.h>
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

enum { SIDE_MAX_PX = CAMBER_IMAGE_SIDE_MAX, AREA_MAX_PX = 1 << 24, MISSING_MAX = 16 };

/* ---- Sheets ---- */

static void premultiply(camber_sprite_sheet *sheet) {
    for (size_t i = 0; i < (size_t)sheet->width * sheet->height; i++) {
        uint8_t *pixel = sheet->rgba + 4 * i;
        for (int c = 0; c < 3; c++)
            pixel[c] = (uint8_t)((pixel[c] * pixel[3] + 127) / 255);
    }
}

/* Uses libpng's simplified interface, which returns errors as text instead of calling longjmp. */
static camber_status decode_png(camber_context *context, const char *path, png_image *image,
                                camber_sprite_sheet *sheet) {
    if (image->width > SIDE_MAX_PX || image->height > SIDE_MAX_PX || image->width > AREA_MAX_PX / image->height)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "%s: %u x %u px are too large; cut it to at most %d px per side and 2^24 px in total", path,
                           image->width, image->height, (int)SIDE_MAX_PX);
    image->format = PNG_FORMAT_RGBA;
    uint8_t *rgba = camber_alloc(context, (size_t)image->width * image->height, 4);
    if (!rgba)
        return CAMBER_ERROR_MEMORY;
    if (!png_image_finish_read(image, NULL, rgba, 0, NULL)) {
        camber_free(context, rgba);
        return camber_fail(context, CAMBER_ERROR_INPUT, "%s: %s; get the sprite again", path, image->message);
    }
    *sheet = (camber_sprite_sheet){image->width, image->height, rgba};
    premultiply(sheet);
    return CAMBER_OK;
}

static camber_status load_sheet(camber_context *context, const char *path, camber_sprite_sheet *sheet) {
    png_image image = {.version = PNG_IMAGE_VERSION};
    char *bytes = NULL;
    size_t size_bytes;
    camber_status status = camber_read_file(context, path, CAMBER_NAMED_BY_STYLE, &bytes, &size_bytes);
    if (status != CAMBER_OK)
        return status;
    if (png_image_begin_read_from_memory(&image, bytes, size_bytes))
        status = decode_png(context, path, &image, sheet);
    else
        status =
            camber_fail(context, CAMBER_ERROR_INPUT, "%s: not a PNG (%s); get the sprite again", path, image.message);
    png_image_free(&image);
    camber_free(context, bytes);
    return status;
}

/* ---- Indices ---- */

typedef struct index_reader {
    camber_sprites *sprites;
    const char *path, *id;
    size_t sheet;
} index_reader;

/* Reads a whole number of px. */
static bool read_px(const json_t *image, const char *key, double least, uint32_t *px) {
    const json_t *json = json_object_get(image, key);
    const double value = json_number_value(json);
    if (!json_is_number(json) || !(value >= least && value <= SIDE_MAX_PX) || value > floor(value))
        return false;
    *px = (uint32_t)value;
    return true;
}

/* Reads numbers of px in ascending order, from 0 to side at most. */
static bool read_ascending(const json_t *array, size_t count, uint32_t side, float *px) {
    bool fits = json_array_size(array) == count;
    for (size_t i = 0; fits && i < count; i++) {
        const json_t *json = json_array_get(array, i);
        px[i] = (float)json_number_value(json);
        fits = json_is_number(json) && px[i] >= (i ? px[i - 1] : 0.0f) && px[i] <= (float)side;
    }
    return fits;
}

/* Reads the parts of a side that may be stretched. Each part is a pair of numbers, and begins at or after the end of
 * the previous part. */
static camber_status read_stretches(index_reader *r, const json_t *array, uint32_t side, float (**stretches)[2],
                                    size_t *count) {
    const size_t size = json_array_size(array);
    float before = 0.0f;
    if (!array)
        return CAMBER_OK;
    if (!(*stretches = camber_alloc_zero(r->sprites->context, size ? size : 1, sizeof **stretches)))
        return CAMBER_ERROR_MEMORY;
    for (*count = 0; *count < size; before = (*stretches)[(*count)++][1])
        if (!read_ascending(json_array_get(array, *count), 2, side, (*stretches)[*count]) ||
            (*stretches)[*count][0] < before)
            return CAMBER_ERROR_INPUT;
    return json_is_array(array) ? CAMBER_OK : CAMBER_ERROR_INPUT;
}

/* Reads the rectangle for text: left, top, right, bottom. If there is none, it is the whole image. */
static bool read_content(const json_t *array, camber_sprite_image *image) {
    const uint32_t sides[2] = {image->width, image->height};
    image->has_content = array != NULL;
    for (size_t i = 0; i < 2; i++) {
        json_t *pair = json_pack("[O?, O?]", json_array_get(array, i), json_array_get(array, i + 2));
        float px[2] = {0.0f, (float)sides[i]};
        const bool fits = !array || (json_array_size(array) == 4 && read_ascending(pair, 2, sides[i], px));
        json_decref(pair);
        if (!fits)
            return false;
        image->content[i] = px[0];
        image->content[i + 2] = px[1];
    }
    return true;
}

/* Reads how the image is fitted to a text. */
static camber_status read_fit(index_reader *r, const char *name, const json_t *json, camber_sprite_image *image) {
    camber_status status =
        read_stretches(r, json_object_get(json, "stretchX"), image->width, &image->stretch_x, &image->stretch_x_count);
    if (status == CAMBER_OK)
        status = read_stretches(r, json_object_get(json, "stretchY"), image->height, &image->stretch_y,
                                &image->stretch_y_count);
    if (status == CAMBER_OK && !read_content(json_object_get(json, "content"), image))
        status = CAMBER_ERROR_INPUT;
    return status == CAMBER_ERROR_INPUT
               ? camber_fail(r->sprites->context, status,
                             "%s: /%.64s: expected stretchX and stretchY as lists of [from, to], and content as [left, "
                             "top, right, bottom], within the image's %u x %u px; correct them",
                             r->path, name, image->width, image->height)
               : status;
}

static void free_image(camber_context *context, camber_sprite_image *image) {
    camber_free(context, image->stretch_x);
    camber_free(context, image->stretch_y);
    camber_free(context, image->name);
}

/* Names the image and adds it to the sprites, which then own its memory. */
static camber_status keep_image(index_reader *r, const char *name, camber_sprite_image *image) {
    camber_sprites *sprites = r->sprites;
    const bool plain = strcmp(r->id, "default") == 0;
    const size_t size = (plain ? 0 : strlen(r->id) + 1) + strlen(name) + 1;
    if (!camber_grow(sprites->context, &sprites->images, &sprites->image_capacity, sprites->image_count + 1,
                     sizeof *sprites->images) ||
        !(image->name = camber_alloc(sprites->context, size, 1)))
        return CAMBER_ERROR_MEMORY;
    snprintf(image->name, size, "%s%s%s", plain ? "" : r->id, plain ? "" : ":", name);
    sprites->images[sprites->image_count++] = *image;
    return CAMBER_OK;
}

static camber_status add_image(index_reader *r, const char *name, const json_t *json) {
    camber_sprites *sprites = r->sprites;
    camber_context *context = sprites->context;
    const camber_sprite_sheet *sheet = sprites->sheets + r->sheet;
    const json_t *ratio = json_object_get(json, "pixelRatio");
    camber_sprite_image image = {.sheet = r->sheet,
                                 .pixel_ratio = ratio ? json_number_value(ratio) : 1.0,
                                 .sdf = json_is_true(json_object_get(json, "sdf"))};
    if (!read_px(json, "x", 0.0, &image.x) || !read_px(json, "y", 0.0, &image.y) ||
        !read_px(json, "width", 1.0, &image.width) || !read_px(json, "height", 1.0, &image.height) ||
        !(image.pixel_ratio >= 1e-3 && image.pixel_ratio <= 1e3))
        return camber_fail(context, CAMBER_ERROR_INPUT,
                           "%s: /%.64s: expected x, y, width and height in whole pixels, width and height at least 1, "
                           "and a pixelRatio from 0.001 to 1000; correct them",
                           r->path, name);
    if (image.x + image.width > sheet->width || image.y + image.height > sheet->height)
        return camber_fail(context, CAMBER_ERROR_INPUT,
                           "%s: /%.64s: %u x %u px at %u, %u are outside its sheet of %u x %u px; get the sprite again",
                           r->path, name, image.width, image.height, image.x, image.y, sheet->width, sheet->height);
    image.image = (camber_image){sheet->rgba + 4 * ((size_t)sheet->width * image.y + image.x), image.width,
                                 image.height, 4 * (size_t)sheet->width};
    camber_status status = read_fit(r, name, json, &image);
    if (status == CAMBER_OK)
        status = keep_image(r, name, &image);
    if (status != CAMBER_OK)
        free_image(context, &image);
    return status;
}

static camber_status read_index(index_reader *r, const char *bytes, size_t size_bytes) {
    camber_context *context = r->sprites->context;
    json_t *root = NULL, *value;
    const char *name;
    camber_status status = camber_json_read(context, bytes, size_bytes, r->path, &root);
    if (status == CAMBER_OK && !json_is_object(root))
        status =
            camber_fail(context, CAMBER_ERROR_INPUT, "%s: expected an object of images; get the sprite again", r->path);
    json_object_foreach(root, name, value) {
        if (status == CAMBER_OK)
            status = add_image(r, name, value);
    }
    json_decref(root);
    return status;
}

static camber_status load_index(index_reader *r) {
    camber_context *context = r->sprites->context;
    char *bytes = NULL;
    size_t size_bytes;
    camber_status status = camber_read_file(context, r->path, CAMBER_NAMED_BY_STYLE, &bytes, &size_bytes);
    if (status == CAMBER_OK)
        status = read_index(r, bytes, size_bytes);
    camber_free(context, bytes);
    return status;
}

/* ---- Sprites ---- */

/* Appends a suffix to the path. */
static char *add_suffix(camber_context *context, const char *path, const char *tail) {
    const size_t size = strlen(path) + strlen(tail) + 1;
    char *made = camber_alloc(context, size, 1);
    if (made)
        snprintf(made, size, "%s%s", path, tail);
    return made;
}

static camber_status load_density(camber_sprites *sprites, const camber_style_sprite *sprite, const char *path,
                                  bool large) {
    camber_context *context = sprites->context;
    index_reader r = {.sprites = sprites, .id = sprite->id, .sheet = sprites->sheet_count};
    char *sheet = add_suffix(context, path, large ? "@2x.png" : ".png");
    char *index = sheet ? add_suffix(context, path, large ? "@2x.json" : ".json") : NULL;
    camber_status status = sheet && index ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    if (status == CAMBER_OK)
        status = load_sheet(context, sheet, sprites->sheets + r.sheet);
    if (status == CAMBER_OK) {
        sprites->sheet_count++;
        r.path = index;
        status = load_index(&r);
    }
    camber_free(context, index);
    camber_free(context, sheet);
    return status;
}

/* Loads the sprite of the styles that ship, which needs no files. */
static camber_status load_signs(camber_sprites *sprites, const camber_style_sprite *sprite) {
    index_reader r = {.sprites = sprites, .path = CAMBER_SIGNS_URL, .id = sprite->id, .sheet = sprites->sheet_count};
    const camber_status status = camber_signs_draw(sprites->context, sprites->sheets + r.sheet);
    if (status != CAMBER_OK)
        return status;
    sprites->sheet_count++;
    return read_index(&r, camber_signs_index, strlen(camber_signs_index));
}

static camber_status find_file(camber_context *context, const char *path, const char *tail, bool *found) {
    char *whole = add_suffix(context, path, tail);
    if (!whole)
        return CAMBER_ERROR_MEMORY;
    struct stat about;
    *found = !camber_file_is_reached(context, whole) || stat(whole, &about) == 0 ||
             (errno != ENOENT && errno != ENOTDIR); /* other errors are reported when the file is read */
    camber_free(context, whole);
    return CAMBER_OK;
}

/* Loads the large form of a sprite, or the small one if there is no large one. */
static camber_status load_either_density(camber_sprites *sprites, const camber_style_sprite *sprite, const char *path,
                                         double ratio) {
    bool large = false, small = false;
    camber_status status = CAMBER_OK;
    if (ratio > 1.0)
        status = find_file(sprites->context, path, "@2x.png", &large);
    if (status == CAMBER_OK && !large)
        status = find_file(sprites->context, path, ".png", &small);
    if (status != CAMBER_OK || large || small)
        return status == CAMBER_OK ? load_density(sprites, sprite, path, large) : status;
    return camber_fail(
        sprites->context, CAMBER_ERROR_NOT_FOUND,
        "sprite \"%s\": %s.png: no such file; check the path in the style, or take its patterns and icons out",
        sprite->id, path);
}

/* Warns of a sprite on the network. */
static void warn_left_out(const camber_sprites *sprites, const camber_style_sprite *sprite) {
    camber_log(
        sprites->context, CAMBER_LOG_WARNING,
        "sprite \"%s\": %s is a network address, and sprites are read only from files; everything drawn with its "
        "images is left out; download it and name the file",
        sprite->id, sprite->url);
}

static camber_status load_sprites(camber_sprites *sprites, const camber_style *style, const char *base_path,
                                  double ratio) {
    for (size_t i = 0; i < style->sprite_count; i++) {
        const camber_style_sprite *sprite = style->sprites + i;
        camber_url url = {0};
        if (camber_url_is_remote(sprite->url)) {
            warn_left_out(sprites, sprite);
            continue;
        }
        if (strcmp(sprite->url, CAMBER_SIGNS_URL) == 0) {
            const camber_status status = load_signs(sprites, sprite);
            if (status != CAMBER_OK)
                return status;
            continue;
        }
        camber_status status = camber_url_resolve(sprites->context, "sprite", sprite->url, base_path, &url);
        if (status != CAMBER_OK)
            return status;
        status = load_either_density(sprites, sprite, url.path, ratio);
        camber_free(sprites->context, url.path);
        if (status != CAMBER_OK)
            return status;
    }
    return CAMBER_OK;
}

static int compare_images(const void *left, const void *right) {
    const camber_sprite_image *a = left, *b = right;
    const int order = strcmp(a->name, b->name);
    return order ? order : a->sheet < b->sheet ? -1 : a->sheet > b->sheet;
}

camber_status camber_sprites_load(camber_context *context, const camber_style *style, const char *base_path,
                                  double ratio, camber_sprites **sprites) {
    camber_sprites *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->sheets = camber_alloc_zero(context, style->sprite_count, sizeof *made->sheets);
    const camber_status status = made->sheets ? load_sprites(made, style, base_path, ratio) : CAMBER_ERROR_MEMORY;
    if (status != CAMBER_OK) {
        camber_sprites_destroy(made);
        return status;
    }
    if (made->image_count)
        qsort(made->images, made->image_count, sizeof *made->images, compare_images);
    *sprites = made;
    return CAMBER_OK;
}

void camber_sprites_destroy(camber_sprites *sprites) {
    if (!sprites)
        return;
    for (size_t i = 0; i < sprites->image_count; i++)
        free_image(sprites->context, sprites->images + i);
    for (size_t i = 0; sprites->sheets && i < sprites->sheet_count; i++)
        camber_free(sprites->context, sprites->sheets[i].rgba);
    for (size_t i = 0; i < sprites->missing_count; i++)
        camber_free(sprites->context, sprites->missing[i]);
    camber_free(sprites->context, sprites->missing);
    camber_free(sprites->context, sprites->images);
    camber_free(sprites->context, sprites->sheets);
    camber_free(sprites->context, sprites);
}

const camber_sprite_image *camber_sprites_find(const camber_sprites *sprites, const char *name) {
    size_t low = 0, high = sprites->image_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (strcmp(sprites->images[middle].name, name) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low < sprites->image_count && strcmp(sprites->images[low].name, name) == 0 ? sprites->images + low : NULL;
}

bool camber_sprites_warn_missing(camber_sprites *sprites, const char *name) {
    for (size_t i = 0; i < sprites->missing_count; i++)
        if (strcmp(sprites->missing[i], name) == 0)
            return true;
    if (sprites->missing_count == MISSING_MAX)
        return true;
    char *kept = camber_copy_string(sprites->context, name);
    if (!kept || !camber_grow(sprites->context, &sprites->missing, &sprites->missing_capacity,
                              sprites->missing_count + 1, sizeof *sprites->missing)) {
        camber_free(sprites->context, kept);
        return false;
    }
    sprites->missing[sprites->missing_count++] = kept;
    camber_log(sprites->context, CAMBER_LOG_WARNING,
               "sprite: there is no image \"%.64s\"; everything drawn with it is left out%s", name,
               sprites->missing_count == MISSING_MAX ? ", and so are others that are not listed" : "");
    return true;
}

/* ---- The sprites of features ---- */

/* Whether a visible layer may name an image. */
static bool has_images(const camber_style *style) {
    for (size_t i = 0; i < style->layer_count; i++) {
        const camber_style_layer *layer = style->layers + i;
        if (layer->visible && (layer->properties[CAMBER_LINE_PATTERN] || layer->properties[CAMBER_FILL_PATTERN] ||
                               layer->properties[CAMBER_BACKGROUND_PATTERN] || camber_style_layer_names_images(layer)))
            return true;
    }
    return false;
}

camber_status camber_features_read_sprites(camber_features *features, double ratio, const char *base_path) {
    camber_sprites *sprites = NULL;
    if (!(ratio >= 0.0 && isfinite(ratio)))
        return camber_fail(features->context, CAMBER_ERROR_ARGUMENT, "sprites: the ratio is %g; choose one above 0",
                           ratio);
    if (!has_images(features->style))
        return CAMBER_OK;
    const camber_status status = camber_sprites_load(features->context, features->style, base_path, ratio, &sprites);
    if (status != CAMBER_OK)
        return status;
    camber_sprites_destroy(features->sprites);
    features->sprites = sprites;
    features->changes++;
    features->free_sprites = camber_sprites_destroy;
    return CAMBER_OK;
}
