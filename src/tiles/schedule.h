/* The metatiles that a run draws, in order, and which of them belong to a shard. */
#ifndef CAMBER_TILES_SCHEDULE_H
#define CAMBER_TILES_SCHEDULE_H

#include "tiles/area.h"
#include "tiles/engine.h"

/* A metatile with at least one wanted tile. */
typedef struct camber_tile_task {
    int zoom, level;      /* level: the zoom whose tiles correspond to the metatiles */
    uint32_t column, row; /* in metatiles */
    uint64_t wanted;      /* tiles that the archive gets, or loses if they are empty */
    uint64_t touched;     /* the wanted tiles that a line may touch */
    uint64_t points;
} camber_tile_task;

typedef struct camber_schedule {
    camber_context *context;
    camber_tile_task *tasks; /* sorted by zoom, then along the Hilbert curve */
    size_t count, capacity;
    double cost;         /* sum over all tasks */
    bool has_arc_length; /* some zoom needs lengths along lines */
} camber_schedule;

/* all: tiles that no line touches are wanted, too. Zooms stay open in the engine as long as they take little memory.
 * After a failure, camber_schedule_free must be called too. Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT. */
camber_status camber_schedule_make(camber_tiles_engine *engine, const camber_tiles_area *area, bool all,
                                   camber_schedule *schedule);
void camber_schedule_free(camber_schedule *schedule);
/* Keeps only the tasks of one shard. The division depends only on the tasks and the number of shards. Returns
 * CAMBER_ERROR_MEMORY. */
camber_status camber_schedule_choose(camber_schedule *schedule, uint32_t shard, uint32_t shards);
/* Extends the bounds of the area to include all tiles that are touched. */
void camber_schedule_meet(const camber_schedule *schedule, camber_tiles_area *area);
/* Returns how many tiles a task's metatile has on a side. */
static inline uint32_t camber_task_side(const camber_tile_task *task) {
    return (uint32_t)1 << (task->zoom - task->level);
}
/* Returns the estimated cost of a task, in microseconds of one processor. */
double camber_task_cost(const camber_tile_task *task);

#endif
