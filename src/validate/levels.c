#include "validate/levels.h"

#include <stdlib.h>

bool camber_levels_take(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    const camber_levels *to = user;
    uint8_t *levels = to->levels + first_row * to->width;
    for (size_t i = 0; i < row_count * to->width; i++)
        levels[i] = rgba[4 * i + (size_t)to->channel];
    return true;
}

static const camber_fill white = {.color = {1, 1, 1, 1}};

/* Returns paints, to be freed with free; NULL if memory is exhausted. */
static camber_paint *make_paints(const camber_drawing *drawing) {
    camber_paint *paints = calloc(drawing->stroke_count + 1, sizeof *paints);
    for (size_t row = 0; paints && row < drawing->stroke_count; row++)
        paints[row] = (camber_paint){.width_px = drawing->strokes[row].width_px,
                                     .color = {1, 1, 1, drawing->alpha > 0 ? drawing->alpha : 1},
                                     .fill = drawing->fills ? &white : NULL};
    return paints;
}

camber_status camber_draw_levels(const camber_drawing_path *path, const camber_drawing *drawing, uint8_t *levels) {
    const size_t count = drawing->stroke_count;
    camber_paint *paints = make_paints(drawing);
    camber_levels kept = {levels, drawing->width, 0};
    if (!paints)
        return CAMBER_ERROR_MEMORY;
    const camber_pass pass = {.mesh = path->mesh, .paints = paints, .paint_count = count, .overlap = drawing->overlap};
    const camber_pass passes[CAMBER_DRAWING_PASSES_MAX] = {pass, pass};
    const camber_frame frame = {.width = drawing->width,
                                .height = drawing->height,
                                .background = {0, 0, 0, 1},
                                .passes = passes,
                                .pass_count = drawing->passes ? (size_t)drawing->passes : 1,
                                .coverage = drawing->coverage};
    const camber_status status = camber_renderer_render(path->renderer, &frame, camber_levels_take, &kept, NULL);
    free(paints);
    return status;
}

camber_status camber_draw_count(const camber_drawing_path *path, const camber_drawing *drawing, camber_overdraw *sum) {
    camber_paint *paints = make_paints(drawing);
    if (!paints)
        return CAMBER_ERROR_MEMORY;
    const camber_overdraw_desc desc = {.width = drawing->width,
                                       .height = drawing->height,
                                       .mesh = path->mesh,
                                       .paints = paints,
                                       .paint_count = drawing->stroke_count};
    const camber_status status = camber_renderer_count_overdraw(path->renderer, &desc, sum);
    free(paints);
    return status;
}
