/* The arguments of the rasterizer's kernels that are not buffers, and the layout of spills and jobs. Host and device
 * compile these structs, and both assert their sizes. */
#ifndef CAMBER_KERNELS_RASTER_ARGS_H
#define CAMBER_KERNELS_RASTER_ARGS_H

#include "pitch.h"

/* The tiles of an area: the position of the first in the picture, in px, and how many there are. */
typedef struct camber_tile_grid {
    float left, top;
    camber_u32 columns, rows;
} camber_tile_grid;

/* setup: the slots of a range, and where their segments go. Ranges of one part are set up together. */
typedef struct camber_setup_args {
    camber_u32 first, end, slot_count; /* the range's slots [first, end), and how many the part has */
    camber_u32 has_arc_length, linear; /* has_arc_length: the part's slots have arc lengths */
    camber_u32 makes_edges;            /* setup makes edges of rings instead of segments */
    camber_u32 among_edges;            /* whether there are edges of rings before and after them */
    /* where the range's segments begin, a multiple of 16, and where its table begins among all rows */
    camber_u32 base, first_row;
    float left, top;          /* where the area begins in the picture, px */
    camber_u32 columns, rows; /* tiles */
    float horizon;            /* rows of pixels at the picture's top in which no segment is drawn */
    camber_eye eye;
    /* The range's slots at which the brush changes, and how many changes of the same input are before the part. */
    camber_u32 first_change, change_count, changes_before;
    camber_u32 first_item; /* the first of its work-items; each range begins a new work-item */
} camber_setup_args;

/* The number of slots that a work-item of setup takes: several, because starting a work-group takes a while. */
#define CAMBER_SETUP_SLOTS(lanes) ((lanes) == 1u ? 16u : 128u)

/* bin_count and bin_scatter: the segments, cut into chunks, and the tiles. */
typedef struct camber_bin_args {
    camber_u32 segment_count, a_chunk; /* segments of all chunks, and of one chunk */
    camber_u32 lists;                  /* lists of tiles and of rows of tiles, rounded up to a multiple of 16 */
    camber_u32 first_edge, edge_count; /* all edges of rings are among these segments */
    camber_tile_grid of;
} camber_bin_args;

/* rasterize: the area that is drawn into. */
typedef struct camber_target_args {
    float left, top; /* position of the first tile in the picture, in px */
    camber_u32 columns, stride;
    camber_u32 first_row;              /* the list of the first row of tiles; ~0: there are no polygons */
    camber_u32 first_edge, edge_count; /* all edges of rings are among these segments */
    float r, g, b, a;                  /* background, premultiplied */
    camber_u32 above;                  /* rows of pixels of the target before the first tile */
    float horizon; /* CAMBER_RASTER_PITCHED: rows of pixels at the picture's top that show the sky */
    camber_eye eye;
    float sky[4];         /* the sky's colour, premultiplied */
    camber_u32 first_job; /* an argument, because PoCL compiles a kernel again for an offset of its work-items */
} camber_target_args;

/* rasterize draws the segments slice by slice, from the last in drawing order to the first. Between two slices a tile
 * spills its state, if it has one: some words per cell, and then planes of sixteen floats per cell, of which the first
 * are the brush and the picture. After them there are the winding changes of a brush of polygons, and its edges so far.
 */
typedef struct camber_spill_args {
    camber_u32 is_last; /* the slice that is drawn last: pixels are written */
    camber_u32 tile_words;
    /* the first plane of sums, of a group, of a layer, and the end of all planes */
    camber_u32 sums, group, layer, behind;
} camber_spill_args;

/* The words of a cell: the sets it is in, and which cells of its row edges pass; the brush, and which levels are open;
 * the winding number of a polygon's rings; 0 if it has no edges, else 1 + their number, and in the upper half how many
 * of them are kept. */
#define CAMBER_SPILL_STATE 0
#define CAMBER_SPILL_NOW 1
#define CAMBER_SPILL_WINDING 2
#define CAMBER_SPILL_PLACED 3
#define CAMBER_SPILL_CELL_WORDS 4
#define CAMBER_SPILL_SETS 6
#define CAMBER_SPILL_BRUSHED 1u
#define CAMBER_SPILL_TOUCHED(level) (8u << (level))
#define CAMBER_SPILL_EDGED_SHIFT 8
#define CAMBER_SPILL_BRUSH 0x3fffffffu
#define CAMBER_SPILL_FULL 0x3ffffffeu /* instead of a brush: nothing below shows through the cell */

/* The most planes: of the brush and the picture, of sums, of a group, of a layer, and of masks. */
#define CAMBER_SPILL_PLANES 17u

/* An edge of a polygon as a tile keeps it: its start, its end, its slope, and its direction: 1 down the ring, -1 up,
 * multiplied by CAMBER_PLACED_ENTERS if it enters the tile through its left side, and by CAMBER_PLACED_LEAVES if it
 * leaves it there. CAMBER_PLACED_MOST is how many edges of one brush a tile keeps. */
#define CAMBER_PLACED_WORDS 5
#define CAMBER_PLACED_MOST 1024
#define CAMBER_PLACED_ENTERS 2.0f
#define CAMBER_PLACED_LEAVES 3.0f
/* Changes of a brush's winding numbers at the top and the bottom of a row of cells, as spilled; the edges follow the
 * changes of all rows. */
#define CAMBER_TURN_WORDS 18
#define CAMBER_AREA_WORDS (8 * CAMBER_TURN_WORDS + CAMBER_PLACED_WORDS * CAMBER_PLACED_MOST)
/* A cell that more edges than this pass keeps its plain sums even if polygons overlap, and so does a tile with more
 * than CAMBER_PLACED_MOST edges of one brush. */
#define CAMBER_OVERLAP_EDGES 64

/* On a GPU, CAMBER_TILE_ITEMS work-items share a tile. Each spills three words: its sets, its brush and open levels,
 * and the winding number; a plane has four floats of each. Then, if there are polygons: the brush whose edges are being
 * added, how many of its edges follow, the changes that they have made so far, and the edges. */
#define CAMBER_TILE_ITEMS 256u
#define CAMBER_TILE_ITEMS_WORDS (3u * CAMBER_TILE_ITEMS)
#define CAMBER_SHARED_CHANGES_WORDS 2388u
#define CAMBER_SHARED_AREA_WORDS (2u + CAMBER_SHARED_CHANGES_WORDS + CAMBER_PLACED_WORDS * CAMBER_PLACED_MOST)

/* rasterize: a job is three words: the tile, the first and the last row of its cells to draw, and the number of the
 * tile's spill. With CAMBER_JOB_BEGINS nothing of the tile was drawn yet, and there is nothing to restore. */
#define CAMBER_JOB_WORDS 3
#define CAMBER_JOB_ROWS(first, last) ((camber_u32)(first) | (camber_u32)(last) << 8)
#define CAMBER_JOB_BEGINS 0x80000000u

#ifdef CAMBER_DEVICE
typedef char camber_setup_args_has_88_bytes[sizeof(camber_setup_args) == 88 ? 1 : -1];
typedef char camber_bin_args_has_36_bytes[sizeof(camber_bin_args) == 36 ? 1 : -1];
typedef char camber_target_args_has_88_bytes[sizeof(camber_target_args) == 88 ? 1 : -1];
typedef char camber_spill_args_has_24_bytes[sizeof(camber_spill_args) == 24 ? 1 : -1];
#else
_Static_assert(sizeof(camber_setup_args) == 88, "setup reads 88 bytes");
_Static_assert(sizeof(camber_bin_args) == 36, "bin_count and bin_scatter read 36 bytes");
_Static_assert(sizeof(camber_target_args) == 88, "rasterize reads 88 bytes");
_Static_assert(sizeof(camber_spill_args) == 24, "rasterize reads 24 bytes");
#endif

#endif
