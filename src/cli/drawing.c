/* Pictures for checks: one channel, in memory. */
#include "cli/checks.h"
#include "cli/levels.h"

#include <stdlib.h>

camber_status camber_draw_levels(const camber_path *path, const camber_drawing *drawing, uint8_t *levels) {
    const size_t count = drawing->stroke_count;
    camber_paint *paints = calloc(count + 1, sizeof *paints);
    camber_levels kept = {levels, drawing->width, 0};
    if (!paints)
        return CAMBER_ERROR_MEMORY;
    for (size_t row = 0; row < count; row++)
        paints[row] = (camber_paint){.width_px = drawing->strokes[row].width_px, .color = {1, 1, 1, 1}};
    const camber_pass pass = {.mesh = path->mesh, .paints = paints, .paint_count = count, .overlap = drawing->overlap};
    const camber_frame frame = {.width = drawing->width,
                                .height = drawing->height,
                                .background = {0, 0, 0, 1},
                                .passes = &pass,
                                .pass_count = 1,
                                .coverage = drawing->coverage};
    const camber_status status = camber_render(path->renderer, &frame, camber_levels_take, &kept, NULL);
    free(paints);
    return status;
}
