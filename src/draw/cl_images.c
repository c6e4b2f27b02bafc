/* Stores the images of a frame that OpenCL draws in the side table: their texels, once for each size, and the words
 * that kernels/images.h lists, for each brush with an image. */
#include "draw/draw_cl.h"

#include "kernels/images.h"

#include <math.h>
#include <string.h>

static bool is_same(const camber_cl_image *held, const camber_image *image, camber_image_size size) {
    const camber_image *have = &held->image;
    return have->rgba == image->rgba && have->stride_bytes == image->stride_bytes && have->width == image->width &&
           have->height == image->height && held->size.width == size.width && held->size.height == size.height &&
           held->size.tiled == size.tiled;
}

static bool are_opaque(const uint8_t *texels, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (texels[4 * i + 3] < 255)
            return false;
    return true;
}

/* Adds texels to the side table. *words points to them, and *first is the number of the first texel. */
static camber_status add_texels(camber_side_table *table, size_t count, size_t *first, float **words) {
    if (table->count + count > CAMBER_SIDE_TABLE_MAX) {
        camber_fail(table->context, CAMBER_ERROR_LIMIT,
                    "the images of a frame take more than %d texels; draw fewer images in fewer sizes",
                    4 * CAMBER_SIDE_TABLE_MAX);
        return CAMBER_ERROR_LIMIT;
    }
    *first = table->count;
    *words = camber_side_table_add(table, count);
    return *words ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

/* Finds an image in the size that a use needs, or adds it. nearest: the most px of the picture that one of its px
 * takes. */
static camber_status hold(camber_cl_images *images, const camber_image_use *use, double nearest,
                          camber_cl_image *found) {
    camber_context *context = images->table->context;
    const camber_image_size size = camber_image_texels(use, nearest);
    for (size_t i = images->count; i-- > 0;)
        if (is_same(images->held + i, use->image, size)) {
            *found = images->held[i];
            return CAMBER_OK;
        }
    const size_t texels = ((size_t)size.width + 2) * ((size_t)size.height + 2);
    camber_cl_image made = {*use->image, size, 0, false};
    float *words = NULL;
    camber_status status = add_texels(images->table, (texels + 3) / 4, &made.first, &words);
    if (status == CAMBER_OK)
        status = camber_image_shrink(context, use->image, size, (uint8_t *)words);
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

static void put_texels(float words[CAMBER_IMAGE_WORDS], const camber_cl_image *held, double width_px) {
    put_bits(words, 4 * held->first);
    put_bits(words + 1, held->size.width);
    put_bits(words + 2, held->size.height);
    words[3] = (float)width_px;
}

/* Adds the words of an image, unless they equal the words that were added last. */
static camber_status add_words(camber_cl_images *images, const float words[CAMBER_IMAGE_WORDS], uint32_t *first) {
    const size_t size_bytes = CAMBER_IMAGE_WORDS * sizeof *words;
    float *made = NULL;
    size_t texel = images->last_words;
    if (texel == 0 || memcmp(images->table->texels + 4 * texel, words, size_bytes) != 0) {
        const camber_status status = add_texels(images->table, CAMBER_IMAGE_WORDS / 4, &texel, &made);
        if (status != CAMBER_OK)
            return status;
        memcpy(made, words, size_bytes);
        images->last_words = texel;
    }
    *first = (uint32_t)texel;
    return CAMBER_OK;
}

camber_status camber_cl_images_add_line(camber_cl_images *images, const camber_image_use *use, uint32_t *words) {
    camber_cl_image held;
    float put[CAMBER_IMAGE_WORDS] = {0};
    const camber_status status = hold(images, use, images->nearest, &held);
    if (status != CAMBER_OK)
        return status;
    put_texels(put, &held, use->width_px);
    return add_words(images, put, words);
}

camber_status camber_cl_images_add_fill(camber_cl_images *images, const camber_draw_list *list,
                                        const camber_fill_paint *fill, uint32_t *words, bool *is_opaque) {
    const camber_image_use *use = list->image_uses + fill->image_use;
    const double angle = fill->bearing_deg * (3.14159265358979323846 / 180.0);
    const float cosine = (float)cos(angle), sine = (float)sin(angle);
    const float width_px = (float)use->width_px, height_px = (float)use->height_px;
    camber_cl_image mean, held;
    float put[CAMBER_IMAGE_WORDS] = {0};
    const double nearest = fill->upright ? 1.0 : images->nearest;
    camber_status status = hold(images, list->image_uses + fill->mean_use, nearest, &mean);
    if (status == CAMBER_OK)
        status = hold(images, use, nearest, &held);
    if (status != CAMBER_OK)
        return status;
    put_texels(put, &held, use->width_px);
    put[4] = fill->x_px;
    put[5] = fill->y_px;
    put[6] = cosine / width_px;
    put[7] = sine / height_px;
    put[8] = -sine / width_px;
    put[9] = cosine / height_px;
    put[10] = fill->upright ? 1.0f : 0.0f;
    /* The mean is one texel, in the middle of three by three. */
    const uint8_t *middle = (const uint8_t *)(images->table->texels + 4 * mean.first) + 16;
    for (size_t k = 0; k < 4; k++)
        put[12 + k] = (float)middle[k];
    *is_opaque = held.is_opaque;
    return add_words(images, put, words);
}
