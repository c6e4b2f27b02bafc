/* cull_emit: writes the slots of a network that the camera sees, in px, as classify reads them.
 * Reads what cull_count reads and bases[chunks + 1], the slots before each chunk and their total; writes x, y, info[s +
 * 2], s being the total rounded up to CAMBER_BLOCK, with a sentinel before the slots and sentinels after them, and the
 * joins of the first and the last sentinel, which classify does not write. With CAMBER_HAS_ARC_LENGTH it reads
 * lengths[n] and totals[stretches] as well and writes slot_arc_lengths[2 * s]; else these are NULL. One work-item per
 * chunk. */
#include "cull.h"

CAMBER_KERNEL(CAMBER_WALKERS, cull_emit,
              (global const camber_i32 *restrict x, global const camber_i32 *restrict y,
               global const float *restrict importance, global const camber_stretch *restrict stretches,
               global const camber_u32 *restrict chunk_stretches, global const camber_u32 *restrict bases,
               global float *restrict slot_x, global float *restrict slot_y, global camber_u32 *restrict slot_info,
               global camber_u32 *restrict joins, global const float *restrict lengths,
               global const float *restrict totals, global float *restrict slot_arc_lengths,
               const camber_projection projection),
              (x, y, importance, stretches, chunk_stretches, bases, slot_x, slot_y, slot_info, joins, lengths, totals,
               slot_arc_lengths, projection)) {
    const camber_u32 item = (camber_u32)CAMBER_WORK_ITEM, chunk = projection.begin / CAMBER_CULL_CHUNK + item;
    camber_u32 begin, end;
    camber_chunk_bounds(&projection, chunk, &begin, &end);
    if (begin >= end)
        return;
    camber_walk w = {x, y, importance, slot_x, slot_y, slot_info, 1u, bases[item] + 1u, 0, 0, 0};
#if CAMBER_HAS_ARC_LENGTH
    w.lengths = lengths;
    w.slot_arc_lengths = slot_arc_lengths;
    w.totals = totals;
    w.stretches = stretches;
#endif
    if (item == 0u) {
        slot_x[0] = slot_y[0] = 0.0f;
        slot_info[0] = joins[0] = 0u;
    }
    if (bases[item + 1u] > bases[item])
        camber_walk_chunk(&w, &projection, stretches + chunk_stretches[chunk], begin, end);
    if (end == projection.end) {
        const camber_u32 count = bases[item + 1u];
        const camber_u32 padded = (count + CAMBER_BLOCK - 1u) / CAMBER_BLOCK * CAMBER_BLOCK;
        for (camber_u32 i = count + 1u; i < padded + 2u; i++) {
            slot_x[i] = slot_y[i] = 0.0f;
            slot_info[i] = 0u;
        }
        joins[padded + 1u] = 0u;
    }
}
