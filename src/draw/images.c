/* Images that rows and fills are drawn with: each at about the size it is drawn in, with what lies beyond its edges
 * around it, so that no filter reaches into a neighbour. */
#include "draw/renderer.h"

#include <math.h>
#include <string.h>

bool camber_image_is_valid(const camber_image *image) {
    return image->rgba && image->width >= 1 && image->width <= CAMBER_IMAGE_SIDE_MAX && image->height >= 1 &&
           image->height <= CAMBER_IMAGE_SIDE_MAX &&
           (image->stride_bytes == 0 || image->stride_bytes >= 4 * (size_t)image->width);
}

/* ---- Sizes ---- */

camber_image_use camber_image_use_of_fill(const camber_pass *pass) {
    const camber_fill *fill = &pass->fill;
    const camber_image *image = pass->images + fill->pattern - 1;
    return (camber_image_use){fill->pattern, fill->width_px > 0.0f ? (double)fill->width_px : image->width,
                              fill->height_px > 0.0f ? (double)fill->height_px : image->height, true};
}

camber_image_use camber_image_mean_of_fill(const camber_pass *pass) {
    return (camber_image_use){pass->fill.pattern, 0.0, 0.0, true};
}

camber_image_use camber_image_use_of_paint(const camber_pass *pass, const camber_paint *paint) {
    const camber_image *image = pass->images + paint->pattern - 1;
    const double whole_px = 2.0 * (double)camber_paint_half_width(paint);
    const double length_px =
        paint->pattern_px > 0.0f ? (double)paint->pattern_px : whole_px * image->width / image->height;
    return (camber_image_use){paint->pattern, fmin(fmax(length_px, 1e-3), 1e9), whole_px, false};
}

/* Texels for a side that is drawn so long: all there are, unless they are finer than pixels by far. Sizes in steps of
 * sqrt(2) keep a zoom from filling the texture. */
static uint32_t texels_for(uint32_t side_px, double drawn_px) {
    const double most = (double)(side_px < CAMBER_TEXELS_SIDE_MAX ? side_px : CAMBER_TEXELS_SIDE_MAX),
                 step = 1.4142135623730951;
    if (!(drawn_px * step < most))
        return (uint32_t)most;
    const double exponent = ceil(log2(fmax(drawn_px, 1.0)) * 2.0);
    return (uint32_t)fmax(fmin(ceil(exp2(0.5 * exponent)), most), 1.0);
}

camber_texels camber_image_texels(const camber_image *image, const camber_image_use *use, double nearest) {
    return (camber_texels){texels_for(image->width, use->width_px * nearest),
                           texels_for(image->height, use->height_px * nearest), use->tiled};
}

/* ---- Texels ---- */

const uint8_t *camber_image_row(const camber_image *image, uint32_t y) {
    return image->rgba + y * (image->stride_bytes ? image->stride_bytes : 4 * (size_t)image->width);
}

/* Averages of as many px of a row as fall on each texel, by their share. */
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

/* The same down the columns, a row of texels after the other. line and sums: a row each. */
static void shrink(const camber_image *image, const camber_texels *size, float *line, float *sums, uint8_t *texels) {
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

/* What lies beyond the edges: the other edge; above and below of what is not tiled the same edge. */
static void add_border(const camber_texels *size, uint8_t *texels) {
    const size_t width = size->width, height = size->height, stride = 4 * (width + 2);
    for (size_t y = 1; y <= height; y++) {
        memcpy(texels + stride * y, texels + stride * y + 4 * width, 4);
        memcpy(texels + stride * y + 4 * (width + 1), texels + stride * y + 4, 4);
    }
    memcpy(texels, texels + stride * (size->tiled ? height : 1), stride);
    memcpy(texels + stride * (height + 1), texels + stride * (size->tiled ? 1 : height), stride);
}

camber_status camber_image_shrink(camber_context *context, const camber_image *image, camber_texels size,
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
