/* Pictures for checks: one channel, in memory. */
#include "cli/checks.h"

#include <stdlib.h>
#include <string.h>

typedef struct taker {
    uint8_t *levels;
    size_t width;
} taker;

static bool take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    const taker *t = user;
    uint8_t *levels = t->levels + first_row * t->width;
    for (size_t i = 0; i < row_count * t->width; i++)
        levels[i] = rgba[4 * i];
    return true;
}

camber_status camber_draw_levels(const camber_path *path, const camber_drawing *drawing, uint8_t *levels) {
    const size_t count = drawing->stroke_count;
    camber_paint *paints = calloc(count + 1, sizeof *paints);
    taker t = {levels, drawing->width};
    if (!paints)
        return CAMBER_ERROR_MEMORY;
    for (size_t row = 0; row < count; row++)
        paints[row] = (camber_paint){drawing->strokes[row].width_px, {1, 1, 1, 1}};
    const camber_pass pass = {.mesh = path->mesh, .paints = paints, .paint_count = count, .overlap = drawing->overlap};
    const camber_frame frame = {.width = drawing->width,
                                .height = drawing->height,
                                .background = {0, 0, 0, 1},
                                .passes = &pass,
                                .pass_count = 1,
                                .coverage = drawing->coverage};
    const camber_status status = camber_render(path->renderer, &frame, take_rows, &t, NULL);
    free(paints);
    return status;
}
