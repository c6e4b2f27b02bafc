/* wind: computes the winding numbers of the rings of each polygon at the corners of tiles, from the edges that cross
 * the tops of rows of tiles. A work-item takes a row.
 * Reads edges, as setup writes them, starts[tiles + rows + 1], lists[starts[tiles + rows]]. Writes
 * crossings[CAMBER_CROSSING_WORDS * m], m being the length of all rows' lists: the crossings of a row have the same
 * positions as its list. Writes ends[rows], where the crossings of each row end. */
#include "area.h"

CAMBER_KERNEL(1, wind,
              (global const float *restrict edges, global const camber_u32 *restrict starts,
               global const camber_u32 *restrict lists, global camber_u32 *restrict crossings,
               global camber_u32 *restrict ends, const camber_tile_grid of),
              (edges, starts, lists, crossings, ends, of)) {
    const camber_u32 row = (camber_u32)CAMBER_WORK_ITEM, first_row = of.columns * of.rows;
    const camber_u32 from = starts[first_row + row], end = starts[first_row + row + 1], at = from - starts[first_row];
    ends[row] = at + camber_wind_row(edges, lists + from, end - from, of, of.top + (float)(row * CAMBER_TILE_PX),
                                     crossings + CAMBER_CROSSING_WORDS * (size_t)at);
}
