/* Computes distances between the pixels of a bitmap of distances. If a stroke is thinner than a pixel, no pixel's
 * centre is inside it, so the mean of two pixels would be outside, too. But distances are linear on both sides of the
 * stroke's middle, so both lines are extended until they meet:
 *
 *                 M         the middle, inside
 *     edge ----- / \ -----
 *               a   b       two pixels, outside
 *              /     \
 *             a'      b'
 *
 * If the values have such a ridge, or a valley between strokes that nearly touch, the value in the middle is taken from
 * the nearer line; otherwise it is the mean. */
#include "text/distances.h"

#include <math.h>

/* Returns the value between b and c, which are the middle two of four consecutive values. */
static float get_middle(float a, float b, float c, float d) {
    const float left = b + (b - a) / 2.0f, right = c + (c - d) / 2.0f;
    if (a < b && d < c)
        return fminf(left, right);
    if (a > b && d > c)
        return fmaxf(left, right);
    return (b + c) / 2.0f;
}

/* Computes the missing values between values that are two steps apart along a line. */
static void fill_between(float *values, size_t step, size_t count) {
    for (size_t i = 0; i + 1 < count; i++) {
        const float *at = values + 2 * i * step;
        const float before = i ? *(at - 2 * step) : at[0], after = i + 2 < count ? at[4 * step] : at[2 * step];
        values[(2 * i + 1) * step] = get_middle(before, at[0], at[2 * step], after);
    }
}

float *camber_distances_refine(camber_context *context, const uint8_t *values, size_t width, size_t height) {
    const size_t steps = CAMBER_DISTANCE_STEPS, wide = steps * (width - 1) + 1, high = steps * (height - 1) + 1;
    float *made = camber_alloc(context, wide * high, sizeof *made);
    if (!made)
        return NULL;
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++)
            made[steps * (y * wide + x)] = values[y * width + x];
    for (size_t gap = steps; gap > 1; gap /= 2) {
        for (size_t y = 0; y < high; y += gap)
            fill_between(made + y * wide, gap / 2, (wide - 1) / gap + 1);
        for (size_t x = 0; x < wide; x += gap / 2)
            fill_between(made + x, gap / 2 * wide, (high - 1) / gap + 1);
    }
    return made;
}
