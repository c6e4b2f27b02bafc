/* The stages that run on the device: the only table of their names, and the times that they take. */
#ifndef CAMBER_BASE_STAGES_H
#define CAMBER_BASE_STAGES_H

#include "camber.h"

/* The stages in the order in which they run. Each is named after its kernel. */
typedef enum camber_stage_id {
    CAMBER_STAGE_CULL_COUNT,
    CAMBER_STAGE_CULL_EMIT,
    CAMBER_STAGE_ARC_LENGTH_SUM,
    CAMBER_STAGE_ARC_LENGTH_SCAN,
    CAMBER_STAGE_OFFSET_CLIP,
    CAMBER_STAGE_OFFSET_COUNT,
    CAMBER_STAGE_OFFSET_EMIT,
    CAMBER_STAGE_CLASSIFY,
    CAMBER_STAGE_SCAN,
    CAMBER_STAGE_EMIT,
    CAMBER_STAGE_SETUP,
    CAMBER_STAGE_BIN_COUNT,
    CAMBER_STAGE_BIN_SCAN,
    CAMBER_STAGE_BIN_SCATTER,
    CAMBER_STAGE_WIND,
    CAMBER_STAGE_RASTERIZE,
    CAMBER_STAGE_COUNT
} camber_stage_id;

const char *camber_stage_name(camber_stage_id stage);

/* Adds to the stage's time. The stage joins the list, which stays in the order above, when it is first timed. */
void camber_stage_times_add(camber_stage_times *times, camber_stage_id stage, double ms);

#endif
