/* Images of a frame that kernels draw, in the tail: texels once a size, and for each brush that names one its place. */
#include "draw/renderer.h"

#include "kernels/images.h"

#include <math.h>
#include <string.h>

static bool is_same(const camber_covered_image *held, const camber_image *image, camber_texels size) {
    return held->rgba == image->rgba && held->stride_bytes == image->stride_bytes && held->px[0] == image->width &&
           held->px[1] == image->height && held->size.width == size.width && held->size.height == size.height &&
           held->size.tiled == size.tiled;
}

static bool are_opaque(const uint8_t *texels, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (texels[4 * i + 3] < 255)
            return false;
    return true;
}

/* Texels, or a place, in the tail. */
static camber_status add_words(camber_renderer *renderer, size_t count, size_t *first, float **words) {
    if (renderer->tail_count + count > CAMBER_COVERED_TAIL_MAX) {
        camber_fail(renderer->share.device->context, CAMBER_ERROR_LIMIT,
                    "the images of a frame take more than %d texels; draw fewer images in fewer sizes",
                    4 * CAMBER_COVERED_TAIL_MAX);
        return CAMBER_ERROR_LIMIT;
    }
    *first = renderer->tail_count;
    *words = camber_tail_add(renderer, count);
    return *words ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

/* The texels of an image for a size, made if they are not there. */
static camber_status hold(camber_renderer *renderer, camber_covered_images *images, const camber_image *image,
                          camber_texels size, camber_covered_image *found) {
    camber_context *context = renderer->share.device->context;
    for (size_t i = images->count; i-- > 0;)
        if (is_same(images->held + i, image, size)) {
            *found = images->held[i];
            return CAMBER_OK;
        }
    const size_t texels = ((size_t)size.width + 2) * ((size_t)size.height + 2);
    camber_covered_image made = {image->rgba, image->stride_bytes, {image->width, image->height}, size, 0, false};
    float *words = NULL;
    camber_status status = add_words(renderer, (texels + 3) / 4, &made.first, &words);
    if (status == CAMBER_OK)
        status = camber_image_shrink(context, image, size, (uint8_t *)words);
    if (status == CAMBER_OK &&
        !camber_grow(context, &images->held, &images->capacity, images->count + 1, sizeof *images->held))
        status = CAMBER_ERROR_MEMORY;
    if (status != CAMBER_OK)
        return status;
    made.is_opaque = are_opaque((const uint8_t *)words, texels);
    images->held[images->count++] = *found = made;
    return CAMBER_OK;
}

static void put_bits(float *word, size_t value) {
    const uint32_t bits = (uint32_t)value;
    memcpy(word, &bits, sizeof bits);
}

static void put_bits_of(float words[CAMBER_IMAGE_WORDS], const camber_covered_image *held, double width_px) {
    put_bits(words, 4 * held->first);
    put_bits(words + 1, held->size.width);
    put_bits(words + 2, held->size.height);
    words[3] = (float)width_px;
}

/* An image's place, which is the texel that a brush names; one like the last is that one. */
static camber_status put_place(camber_renderer *renderer, camber_covered_images *images,
                               const float words[CAMBER_IMAGE_WORDS], uint32_t *place) {
    const size_t size_bytes = CAMBER_IMAGE_WORDS * sizeof *words;
    float *made = NULL;
    size_t first = images->last_place;
    if (first == 0 || memcmp(renderer->tail_texels + 4 * first, words, size_bytes) != 0) {
        const camber_status status = add_words(renderer, CAMBER_IMAGE_WORDS / 4, &first, &made);
        if (status != CAMBER_OK)
            return status;
        memcpy(made, words, size_bytes);
        images->last_place = first;
    }
    *place = (uint32_t)first;
    return CAMBER_OK;
}

camber_status camber_covered_put_line(camber_renderer *renderer, camber_covered_images *images, const camber_pass *pass,
                                      const camber_paint *paint, uint32_t *place) {
    const camber_image_use use = camber_image_use_of_paint(pass, paint);
    const camber_image *image = pass->images + use.pattern - 1;
    camber_covered_image held;
    float words[CAMBER_IMAGE_WORDS] = {0};
    const camber_status status =
        hold(renderer, images, image, camber_image_texels(image, &use, images->nearest), &held);
    if (status != CAMBER_OK)
        return status;
    put_bits_of(words, &held, use.width_px);
    return put_place(renderer, images, words, place);
}

camber_status camber_covered_put_fill(camber_renderer *renderer, camber_covered_images *images, const camber_pass *pass,
                                      uint32_t *place, bool *is_opaque) {
    const camber_fill *fill = &pass->fill;
    const camber_image_use use = camber_image_use_of_fill(pass), one = camber_image_mean_of_fill(pass);
    const camber_image *image = pass->images + fill->pattern - 1;
    const double angle = fill->bearing_deg * (3.14159265358979323846 / 180.0);
    const float cosine = (float)cos(angle), sine = (float)sin(angle);
    const float width_px = (float)use.width_px, height_px = (float)use.height_px;
    camber_covered_image mean, held;
    float words[CAMBER_IMAGE_WORDS] = {0};
    camber_status status = hold(renderer, images, image, camber_image_texels(image, &one, 1.0), &mean);
    if (status == CAMBER_OK)
        status = hold(renderer, images, image, camber_image_texels(image, &use, images->nearest), &held);
    if (status != CAMBER_OK)
        return status;
    put_bits_of(words, &held, use.width_px);
    words[4] = fill->x_px;
    words[5] = fill->y_px;
    words[6] = cosine / width_px;
    words[7] = sine / height_px;
    words[8] = -sine / width_px;
    words[9] = cosine / height_px;
    const uint8_t *middle = (const uint8_t *)(renderer->tail_texels + 4 * mean.first) + 16; /* of three by three */
    for (size_t k = 0; k < 4; k++)
        words[12 + k] = (float)middle[k];
    *is_opaque = held.is_opaque;
    return put_place(renderer, images, words, place);
}
