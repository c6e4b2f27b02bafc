#include "validate/coverage_truth.h"

#include <math.h>
#include <stdlib.h>

camber_difference camber_difference_of(const float *truth, const uint8_t *drawn, size_t count) {
    camber_difference d = {0};
    for (size_t i = 0; i < count; i++) {
        if (truth[i] <= 0 && drawn[i] == 0)
            continue;
        const int apart = abs((int)drawn[i] - (int)lrintf(255 * truth[i]));
        d.touched++;
        d.sum += apart;
        d.past_16 += apart > 16;
        d.past_64 += apart > 64;
        if (apart > d.max) {
            d.max = apart;
            d.max_at = i;
        }
    }
    return d;
}

void camber_difference_add(camber_difference *sum, const camber_difference *more) {
    sum->sum += more->sum;
    sum->touched += more->touched;
    sum->past_16 += more->past_16;
    sum->past_64 += more->past_64;
    sum->max = more->max > sum->max ? more->max : sum->max;
}

double camber_difference_mean(const camber_difference *difference) {
    return difference->touched ? difference->sum / (double)difference->touched : 0;
}

/* ---- Images of differences ---- */

enum { PANELS = 3, GAP_PX = 4 };

/* Black ink on white. The difference is drawn on grey: red for too much ink, blue for too little. */
static void shade(uint8_t pixel[4], int panel, int truth, int drawn) {
    const int level = 255 - (panel == 0 ? truth : drawn), apart = drawn - truth;
    const int red = apart < 0 ? -apart : 0, green = abs(apart), blue = apart > 0 ? apart : 0;
    pixel[0] = (uint8_t)(panel < 2 ? level : 255 - red);
    pixel[1] = (uint8_t)(panel < 2 ? level : 255 - green);
    pixel[2] = (uint8_t)(panel < 2 ? level : 255 - blue);
    pixel[3] = 255;
}

camber_status camber_difference_write(camber_context *context, camber_window window, const float *truth,
                                      const uint8_t *drawn, unsigned scale, camber_sink sink) {
    const size_t panel_px = (size_t)window.width * scale, width = PANELS * panel_px + (PANELS - 1) * GAP_PX;
    const camber_png_desc desc = {
        .width = (uint32_t)width, .height = (uint32_t)window.height * scale, .opaque = true, .compression = 6};
    camber_png *png = NULL;
    uint8_t *row = calloc(width, 4);
    camber_status status = row ? camber_png_create(context, &desc, sink, &png) : CAMBER_ERROR_MEMORY;
    for (size_t y = 0; y < desc.height && status == CAMBER_OK; y++) {
        for (size_t x = 0; x < PANELS * panel_px; x++) {
            const size_t panel = x / panel_px, at = y / scale * (size_t)window.width + x % panel_px / scale;
            shade(row + 4 * (x + panel * GAP_PX), (int)panel, (int)lrintf(255 * truth[at]), drawn[at]);
        }
        status = camber_png_write_rows(png, row, 1);
    }
    if (status == CAMBER_OK)
        status = camber_png_finish(png);
    camber_png_destroy(png);
    free(row);
    return status;
}
