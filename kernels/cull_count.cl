/* cull_count: counts for each chunk of a network's points how many slots it gives for the camera.
 * Reads x, y, importance[n], the stretches and the final one after them, chunk_stretches[n / CAMBER_CULL_CHUNK, rounded
 * up], which is the stretch of each chunk's first point; writes counts[chunks], for the chunks between the projection's
 * begin and end. One work-item per chunk. */
#include "cull.h"

CAMBER_KERNEL(CAMBER_WALKERS, cull_count,
              (global const camber_i32 *restrict x, global const camber_i32 *restrict y,
               global const float *restrict importance, global const camber_stretch *restrict stretches,
               global const camber_u32 *restrict chunk_stretches, global camber_u32 *restrict counts,
               const camber_projection projection),
              (x, y, importance, stretches, chunk_stretches, counts, projection)) {
    const camber_u32 item = (camber_u32)CAMBER_WORK_ITEM, chunk = projection.begin / CAMBER_CULL_CHUNK + item;
    camber_u32 begin, end;
    camber_chunk_bounds(&projection, chunk, &begin, &end);
    if (begin >= end)
        return;
    camber_walk w = {0};
    w.x = x;
    w.y = y;
    w.importance = importance;
    camber_walk_chunk(&w, &projection, stretches + chunk_stretches[chunk], begin, end);
    counts[item] = w.at;
}
