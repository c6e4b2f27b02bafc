#include "base/stages.h"

#include <string.h>

static const char *const NAMES[CAMBER_STAGE_COUNT] = {
    [CAMBER_STAGE_CULL_COUNT] = "cull_count",
    [CAMBER_STAGE_CULL_EMIT] = "cull_emit",
    [CAMBER_STAGE_ARC_LENGTH_SUM] = "arc_length_sum",
    [CAMBER_STAGE_ARC_LENGTH_SCAN] = "arc_length_scan",
    [CAMBER_STAGE_OFFSET_CLIP] = "offset_clip",
    [CAMBER_STAGE_OFFSET_COUNT] = "offset_count",
    [CAMBER_STAGE_OFFSET_EMIT] = "offset_emit",
    [CAMBER_STAGE_CLASSIFY] = "classify",
    [CAMBER_STAGE_SCAN] = "scan",
    [CAMBER_STAGE_EMIT] = "emit",
    [CAMBER_STAGE_SETUP] = "setup",
    [CAMBER_STAGE_BIN_COUNT] = "bin_count",
    [CAMBER_STAGE_BIN_SCAN] = "bin_scan",
    [CAMBER_STAGE_BIN_SCATTER] = "bin_scatter",
    [CAMBER_STAGE_WIND] = "wind",
    [CAMBER_STAGE_RASTERIZE] = "rasterize",
};
_Static_assert((int)CAMBER_STAGE_COUNT <= (int)CAMBER_STAGE_TIMES_MAX, "a list has room for all stages");

const char *camber_stage_name(camber_stage_id stage) {
    return NAMES[stage];
}

static int position_of(const char *name) {
    int stage = 0;
    while (stage < CAMBER_STAGE_COUNT && strcmp(NAMES[stage], name) != 0)
        stage++;
    return stage;
}

void camber_stage_times_add(camber_stage_times *times, camber_stage_id stage, double ms) {
    size_t at = 0;
    while (at < times->count && position_of(times->stages[at].name) < (int)stage)
        at++;
    if (at == times->count || strcmp(times->stages[at].name, NAMES[stage]) != 0) {
        memmove(times->stages + at + 1, times->stages + at, (times->count - at) * sizeof *times->stages);
        times->stages[at] = (camber_stage_time){.name = NAMES[stage]};
        times->count++;
    }
    times->stages[at].ms += ms;
}

double camber_stage_times_get_ms(const camber_stage_times *times, const char *name) {
    for (size_t i = 0; i < times->count; i++)
        if (strcmp(times->stages[i].name, name) == 0)
            return times->stages[i].ms;
    return 0.0;
}
