/* offset_clip: computes how much remains of the offset segment that begins at each slot, and of the arc at the slot.
 * Reads x, y, info[n + 2] and the rows' offsets; writes clips[n + 2] except the first and the last, which nobody reads.
 * One work-item per slot. */
#include "offset_clip.h"

CAMBER_KERNEL(CAMBER_BLOCK, offset_clip,
              (global const float *restrict x, global const float *restrict y, global const camber_u32 *restrict info,
               global const camber_offset_row *restrict offset_rows, global camber_offset_clip *restrict clips),
              (x, y, info, offset_rows, clips)) {
    const camber_source_line source_line = {x, y, info, offset_rows, clips, 0, (camber_u32)CAMBER_WORK_ITEMS};
    const camber_u32 slot = (camber_u32)CAMBER_WORK_ITEM + 1u;
    clips[slot] = camber_offset_clip_of(&source_line, slot);
}
