#include "validate/levels.h"

bool camber_levels_take(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    const camber_levels *to = user;
    uint8_t *levels = to->levels + first_row * to->width;
    for (size_t i = 0; i < row_count * to->width; i++)
        levels[i] = rgba[4 * i + (size_t)to->channel];
    return true;
}
