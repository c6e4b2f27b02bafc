/* offset_count: counts how many slots each chunk of CAMBER_OFFSET_CHUNK slots yields. One work-item per chunk.
 * Reads what offset_clip reads and clips[n + 2]; writes counts[chunks]. */
#include "offset_emit.h"

CAMBER_KERNEL(CAMBER_BLOCK / CAMBER_OFFSET_CHUNK, offset_count,
              (global const float *restrict x, global const float *restrict y, global const camber_u32 *restrict info,
               global const camber_offset_row *restrict offset_rows, global camber_offset_clip *restrict clips,
               global camber_u32 *restrict counts),
              (x, y, info, offset_rows, clips, counts)) {
    const camber_u32 chunk = (camber_u32)CAMBER_WORK_ITEM;
    const camber_source_line source_line = {
        x, y, info, offset_rows, clips, 0, (camber_u32)CAMBER_WORK_ITEMS * CAMBER_OFFSET_CHUNK};
    camber_offset_writer writer = camber_offset_writer_counting();
    for (camber_u32 i = 1; i <= CAMBER_OFFSET_CHUNK; i++)
        camber_offset_emit_beside(&source_line, chunk * CAMBER_OFFSET_CHUNK + i, &writer);
    counts[chunk] = writer.at;
}
