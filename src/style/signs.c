/* Draws the sprite of the styles that ship: the box of road shields, and the symbols of stations and peaks.
 *
 * The signs are signed distances, so one sheet serves all colours, sizes and densities:
 *
 *     .-----.     .-.      .---.       .
 *     |     |    (   )     |   |      / \
 *     '-----'     '-'      '---'     /___\
 *       box       dot     square    triangle
 *
 * The box is stretched in its middle to be as large as a text. */
#include "style/signs.h"

#include <math.h>

/* A sign takes a square of SIDE px, and 2 px are one CSS px. */
enum { SIDE = 24, SIGNS = 4 };

const char camber_signs_index[] =
    "{\"box\": {\"x\": 0, \"y\": 0, \"width\": 24, \"height\": 24, \"pixelRatio\": 2, \"sdf\": true,"
    "  \"stretchX\": [[11, 13]], \"stretchY\": [[11, 13]], \"content\": [4, 4, 20, 20]},"
    " \"dot\": {\"x\": 24, \"y\": 0, \"width\": 24, \"height\": 24, \"pixelRatio\": 2, \"sdf\": true},"
    " \"square\": {\"x\": 48, \"y\": 0, \"width\": 24, \"height\": 24, \"pixelRatio\": 2, \"sdf\": true},"
    " \"triangle\": {\"x\": 72, \"y\": 0, \"width\": 24, \"height\": 24, \"pixelRatio\": 2, \"sdf\": true}}";

/* The distances are px inside of the edge. x and y are px from the middle of the sign. */

static float inside_square(float x, float y, float half, float radius) {
    const float across = fabsf(x) - half + radius, down = fabsf(y) - half + radius;
    const float beyond = sqrtf(fmaxf(across, 0.0f) * fmaxf(across, 0.0f) + fmaxf(down, 0.0f) * fmaxf(down, 0.0f));
    return radius - beyond - fminf(fmaxf(across, down), 0.0f);
}

static float inside_circle(float x, float y, float radius) {
    return radius - sqrtf(x * x + y * y);
}

/* A triangle that stands on one of its sides. Each side is as far from the middle as the others. */
static float inside_triangle(float x, float y, float radius) {
    const float slope_x = 0.8660254f, slope_y = -0.5f; /* the normal of a slanting side: 60 degrees */
    return fminf(radius - y, radius - (fabsf(x) * slope_x + y * slope_y));
}

static float inside(int sign, float x, float y) {
    switch (sign) {
    case 0: return inside_square(x, y, 9.0f, 5.0f);
    case 1: return inside_circle(x, y, 9.0f);
    case 2: return inside_square(x, y, 8.0f, 3.0f);
    default: return inside_triangle(x, y - 2.0f, 5.0f);
    }
}

camber_status camber_signs_draw(camber_context *context, camber_sprite_sheet *sheet) {
    uint8_t *rgba = camber_alloc_zero(context, (size_t)SIGNS * SIDE * SIDE, 4);
    if (!rgba)
        return CAMBER_ERROR_MEMORY;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIGNS * SIDE; x++) {
            const float half = 0.5f * SIDE;
            const float px = inside(x / SIDE, (float)(x % SIDE) + 0.5f - half, (float)y + 0.5f - half);
            /* The edge is at three quarters of the range, which spans 8 px. */
            rgba[4 * (y * SIGNS * SIDE + x) + 3] = (uint8_t)fminf(fmaxf(191.5f + 32.0f * px, 0.0f), 255.0f);
        }
    *sheet = (camber_sprite_sheet){SIGNS * SIDE, SIDE, rgba};
    return CAMBER_OK;
}
