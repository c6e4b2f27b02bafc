/* One channel of a picture in memory, in which a mesh is drawn white on black. */
#ifndef CAMBER_VALIDATE_LEVELS_H
#define CAMBER_VALIDATE_LEVELS_H

#include "validate/devices.h"

typedef struct camber_levels {
    uint8_t *levels;
    size_t width;
    int channel; /* 0 to 3: red to alpha */
} camber_levels;

/* A camber_rows_fn; user is a camber_levels. */
bool camber_levels_take(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count);

typedef struct camber_drawing {
    const camber_stroke *strokes; /* stroke_count of them: all rows are drawn with their full widths */
    size_t stroke_count;
    uint32_t width, height; /* px */
    camber_coverage coverage;
    camber_overlap overlap;
    bool fills;  /* fill the lines' inside instead of drawing lines */
    int passes;  /* each pass draws the whole mesh over the one before; 0: one pass */
    float alpha; /* of each pass; 0: opaque */
} camber_drawing;

enum { CAMBER_DRAWING_PASSES_MAX = 2 };

/* Draws the path's mesh. levels receives width * height bytes. */
camber_status camber_draw_levels(const camber_drawing_path *path, const camber_drawing *drawing, uint8_t *levels);
/* Counts the overdraw of the same drawing, line by line. */
camber_status camber_draw_count(const camber_drawing_path *path, const camber_drawing *drawing, camber_overdraw *sum);

#endif
