/* Prepares images that lines and fills are drawn with. The host averages each to about the size at which it is drawn,
 * and adds a border of one texel, so that no filter reads a neighbouring image. */
#include "draw/images.h"

#include <math.h>
#include <string.h>

/* ---- The images of a frame ---- */

enum { FIRST_SLOTS = 16 };

void camber_image_set_clear(camber_image_set *set) {
    if (set->count)
        memset(set->slots, 0, set->slot_count * sizeof *set->slots);
    set->count = 0;
}

void camber_image_set_free(camber_image_set *set) {
    camber_free(set->context, set->slots);
    camber_free(set->context, set->images);
}

/* Returns the slot that has the image, or else the free slot for it. */
static uint32_t *find_slot(const camber_image_set *set, const camber_image *image) {
    size_t at = (size_t)camber_hash(CAMBER_HASH_START, &image, sizeof image) & (set->slot_count - 1);
    while (set->slots[at] && set->images[set->slots[at] - 1] != image)
        at = (at + 1) & (set->slot_count - 1);
    return set->slots + at;
}

/* Makes room for one more image, so that at most half of the slots are in use. */
static camber_status grow_set(camber_image_set *set) {
    if (!camber_grow(set->context, &set->images, &set->capacity, set->count + 1, sizeof *set->images))
        return CAMBER_ERROR_MEMORY;
    if (2 * (set->count + 1) < set->slot_count)
        return CAMBER_OK;
    const size_t slot_count = set->slot_count ? 2 * set->slot_count : FIRST_SLOTS;
    uint32_t *slots = camber_alloc_zero(set->context, slot_count, sizeof *slots);
    if (!slots)
        return CAMBER_ERROR_MEMORY;
    camber_free(set->context, set->slots);
    set->slots = slots;
    set->slot_count = slot_count;
    for (size_t i = 0; i < set->count; i++)
        *find_slot(set, set->images[i]) = (uint32_t)i + 1;
    return CAMBER_OK;
}

static bool is_valid(const camber_image *image) {
    return image->rgba && image->width >= 1 && image->width <= CAMBER_IMAGE_SIDE_MAX && image->height >= 1 &&
           image->height <= CAMBER_IMAGE_SIDE_MAX &&
           (image->stride_bytes == 0 || image->stride_bytes >= 4 * (size_t)image->width);
}

camber_status camber_image_set_add(camber_image_set *set, const camber_image *image, size_t *number) {
    /* Consecutive rows usually have the same image. */
    if (set->count && set->images[set->count - 1] == image) {
        *number = set->count - 1;
        return CAMBER_OK;
    }
    if (set->count && *find_slot(set, image)) {
        *number = *find_slot(set, image) - 1;
        return CAMBER_OK;
    }
    if (!is_valid(image))
        return camber_fail(set->context, CAMBER_ERROR_ARGUMENT,
                           "an image of %u x %u px; give 1 to %d a side, and rows that do not overlap", image->width,
                           image->height, CAMBER_IMAGE_SIDE_MAX);
    const camber_status status = grow_set(set);
    if (status != CAMBER_OK)
        return status;
    *number = set->count;
    set->images[set->count++] = image;
    *find_slot(set, image) = (uint32_t)set->count;
    return CAMBER_OK;
}

/* ---- Sizes ---- */

camber_image_use camber_image_use_in_fill(const camber_image *image, size_t number, double width_px, double height_px) {
    return (camber_image_use){image, number, width_px > 0.0 ? width_px : image->width,
                              height_px > 0.0 ? height_px : image->height, true};
}

camber_image_use camber_image_use_as_mean(const camber_image *image, size_t number) {
    return (camber_image_use){image, number, 0.0, 0.0, true};
}

camber_image_use camber_image_use_on_line(const camber_image *image, size_t number, double stroke_px,
                                          double length_px) {
    const double px = length_px > 0.0 ? length_px : stroke_px * image->width / image->height;
    return (camber_image_use){image, number, fmin(fmax(px, 1e-3), 1e9), stroke_px, false};
}

/* Returns the texels for a side that is drawn at this length: all pixels of the image, unless they are far finer than
 * the pixels of the picture. Sizes differ by steps of sqrt(2), so that zooming does not fill the texture. */
static uint32_t texels_for(uint32_t side_px, double drawn_px) {
    const double most = (double)(side_px < CAMBER_IMAGE_TEXELS_MAX ? side_px : CAMBER_IMAGE_TEXELS_MAX),
                 step = 1.4142135623730951;
    if (!(drawn_px * step < most))
        return (uint32_t)most;
    const double exponent = ceil(log2(fmax(drawn_px, 1.0)) * 2.0);
    return (uint32_t)fmax(fmin(ceil(exp2(0.5 * exponent)), most), 1.0);
}

camber_image_size camber_image_texels(const camber_image_use *use, double nearest) {
    return (camber_image_size){texels_for(use->image->width, use->width_px * nearest),
                               texels_for(use->image->height, use->height_px * nearest), use->tiled};
}

/* ---- Texels ---- */

const uint8_t *camber_image_row(const camber_image *image, uint32_t y) {
    return image->rgba + y * (image->stride_bytes ? image->stride_bytes : 4 * (size_t)image->width);
}

/* Averages the pixels of a row that overlap each texel, weighted by the fraction of the texel that they cover. */
static void shrink_row(const camber_image *image, uint32_t y, float *texels, uint32_t count) {
    const uint8_t *row = camber_image_row(image, y);
    const double share = (double)image->width / count;
    for (uint32_t i = 0; i < count; i++) {
        const double from = i * share, to = fmin((i + 1) * share, image->width);
        double sums[4] = {0};
        for (uint32_t k = (uint32_t)from; k < to; k++)
            for (size_t c = 0; c < 4; c++)
                sums[c] += (fmin(to, k + 1.0) - fmax(from, k)) * row[4 * (size_t)k + c];
        for (size_t c = 0; c < 4; c++)
            texels[4 * (size_t)i + c] = (float)(sums[c] / (to - from));
    }
}

/* Averages down the columns as well, one row of texels after another. line and sums have room for a row each. */
static void shrink(const camber_image *image, const camber_image_size *size, float *line, float *sums,
                   uint8_t *texels) {
    const size_t floats = 4 * (size_t)size->width, stride = floats + 8;
    const double share = (double)image->height / size->height;
    uint32_t row = 0;
    memset(sums, 0, floats * sizeof *sums);
    for (uint32_t y = 0; y < image->height; y++) {
        shrink_row(image, y, line, size->width);
        while (row < size->height && row * share < y + 1.0) {
            const double from = row * share, to = fmin((row + 1) * share, image->height);
            const float part = (float)((fmin(to, y + 1.0) - fmax(from, y)) / (to - from));
            for (size_t i = 0; i < floats; i++)
                sums[i] += part * line[i];
            if (to > y + 1.0)
                break;
            for (size_t i = 0; i < floats; i++)
                texels[stride * row + i] = (uint8_t)fminf(sums[i] + 0.5f, 255.0f);
            memset(sums, 0, floats * sizeof *sums);
            row++;
        }
    }
}

/* Adds a border: each side of it repeats the opposite edge of the image; above and below an image that is not tiled it
 * repeats the near edge. */
static void add_border(const camber_image_size *size, uint8_t *texels) {
    const size_t width = size->width, height = size->height, stride = 4 * (width + 2);
    for (size_t y = 1; y <= height; y++) {
        memcpy(texels + stride * y, texels + stride * y + 4 * width, 4);
        memcpy(texels + stride * y + 4 * (width + 1), texels + stride * y + 4, 4);
    }
    memcpy(texels, texels + stride * (size->tiled ? height : 1), stride);
    memcpy(texels + stride * (height + 1), texels + stride * (size->tiled ? 1 : height), stride);
}

camber_status camber_image_shrink(camber_context *context, const camber_image *image, camber_image_size size,
                                  uint8_t *texels) {
    const size_t width = (size_t)size.width + 2;
    float *rows = camber_alloc(context, 2 * width, 4 * sizeof *rows);
    if (!rows)
        return CAMBER_ERROR_MEMORY;
    shrink(image, &size, rows, rows + 4 * width, texels + 4 * width + 4);
    add_border(&size, texels);
    camber_free(context, rows);
    return CAMBER_OK;
}
