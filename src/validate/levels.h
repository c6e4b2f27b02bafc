/* One channel of a picture, in memory. */
#ifndef CAMBER_VALIDATE_LEVELS_H
#define CAMBER_VALIDATE_LEVELS_H

#include "camber.h"

typedef struct camber_levels {
    uint8_t *levels;
    size_t width;
    int channel; /* 0 to 3: red to alpha */
} camber_levels;

/* A camber_rows_fn; user is a camber_levels. */
bool camber_levels_take(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count);

#endif
