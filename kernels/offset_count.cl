/* offset_count: counts how many slots each chunk of CAMBER_OFFSET_CHUNK slots yields. One work-item per chunk.
 * Reads what offset_clip reads and clips[n + 2]; writes counts[chunks]. */
#include "offset_emit.h"

kernel __attribute__((reqd_work_group_size(CAMBER_BLOCK / CAMBER_OFFSET_CHUNK, 1, 1))) void offset_count(
    global const float *restrict x, global const float *restrict y, global const camber_u32 *restrict info,
    global const camber_offset_row *restrict offset_rows, global camber_offset_clip *restrict clips,
    global camber_u32 *restrict counts) {
    const camber_u32 chunk = (camber_u32)get_global_id(0);
    const camber_source_line source_line = {
        x, y, info, offset_rows, clips, 0, (camber_u32)get_global_size(0) * CAMBER_OFFSET_CHUNK};
    camber_offset_writer writer = camber_offset_writer_counting();
    for (camber_u32 i = 1; i <= CAMBER_OFFSET_CHUNK; i++)
        camber_offset_emit_beside(&source_line, chunk * CAMBER_OFFSET_CHUNK + i, &writer);
    counts[chunk] = writer.at;
}
