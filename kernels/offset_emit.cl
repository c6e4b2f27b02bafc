/* offset_emit: writes the slots of the offset lines. One work-item per chunk of CAMBER_OFFSET_CHUNK slots.
 * Reads what offset_count reads and bases[chunks + 1], the slots before each chunk and their total. Writes x, y, info[s
 * + 2], s being the total rounded up to CAMBER_BLOCK: a sentinel before the slots and sentinels after them; the joins
 * of the first and the last sentinel, which classify does not write; places[n], for each source slot the number of
 * slots that come from the slots before it. With CAMBER_HAS_ARC_LENGTH it reads arc_lengths[2 * n] and writes
 * out_arc_lengths[2 * s]; else both are NULL. */
#include "offset_emit.h"

CAMBER_KERNEL(CAMBER_BLOCK / CAMBER_OFFSET_CHUNK, offset_emit,
              (global const float *restrict x, global const float *restrict y, global const camber_u32 *restrict info,
               global const camber_offset_row *restrict offset_rows, global camber_offset_clip *restrict clips,
               global const camber_u32 *restrict bases, global float *restrict out_x, global float *restrict out_y,
               global camber_u32 *restrict out_info, global camber_u32 *restrict joins,
               global camber_u32 *restrict places, global const float *restrict arc_lengths,
               global float *restrict out_arc_lengths),
              (x, y, info, offset_rows, clips, bases, out_x, out_y, out_info, joins, places, arc_lengths,
               out_arc_lengths)) {
    const camber_u32 chunk = (camber_u32)CAMBER_WORK_ITEM, chunks = (camber_u32)CAMBER_WORK_ITEMS;
    camber_source_line source_line = {x, y, info, offset_rows, clips, 0, chunks * CAMBER_OFFSET_CHUNK};
    camber_offset_writer writer = camber_offset_writer_counting();
    writer.x = out_x;
    writer.y = out_y;
    writer.info = out_info;
#if CAMBER_HAS_ARC_LENGTH
    source_line.arc_lengths = arc_lengths;
    writer.arc_lengths = out_arc_lengths;
#endif
    writer.emits = 1u;
    writer.at = bases[chunk] + 1u;
    for (camber_u32 i = 1; i <= CAMBER_OFFSET_CHUNK; i++) {
        const camber_u32 slot = chunk * CAMBER_OFFSET_CHUNK + i;
        places[slot - 1u] = writer.at - 1u;
        camber_offset_emit_beside(&source_line, slot, &writer);
    }
    if (chunk == 0u) {
        out_x[0] = out_y[0] = 0.0f;
        out_info[0] = joins[0] = 0u;
    }
    if (chunk + 1u == chunks) {
        const camber_u32 count = bases[chunks];
        const camber_u32 padded = (count + CAMBER_BLOCK - 1u) / CAMBER_BLOCK * CAMBER_BLOCK;
        for (camber_u32 i = count + 1u; i < padded + 2u; i++) {
            out_x[i] = out_y[i] = 0.0f;
            out_info[i] = 0u;
#if CAMBER_HAS_ARC_LENGTH
            if (i <= padded)
                out_arc_lengths[2u * (i - 1u)] = out_arc_lengths[2u * (i - 1u) + 1u] = 0.0f;
#endif
        }
        joins[padded + 1u] = 0u;
    }
}
