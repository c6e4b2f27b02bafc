/* The arguments of the rasterizer's kernels that are no buffers: structs that both compile, and what tiles keep
 * between slices. Their sizes are asserted on both sides. */
#ifndef CAMBER_KERNELS_RASTER_ARGS_H
#define CAMBER_KERNELS_RASTER_ARGS_H

#include "layout.h"

/* The camera of a plane that is seen at an angle, as stroke.vert has it. */
typedef struct camber_eye {
    float x, y;   /* half the picture's size, px */
    float cosine; /* of the pitch */
    float fall;   /* depth that is lost a px towards the viewer */
} camber_eye;

/* An area of the picture: its first tile, px, and its tiles. */
typedef struct camber_tile_grid {
    float left, top;
    camber_u32 columns, rows;
} camber_tile_grid;

/* setup: the records of a range, and where their segments go. */
typedef struct camber_setup_args {
    camber_u32 first, end, record_count; /* records: those of the range, and all there are */
    camber_u32 stride, strips, linear;   /* stride: 2 where records have arc lengths behind them */
    camber_u32 base, first_row;          /* the first segment, and the first row of the range's table */
    float left, top;                     /* where what is drawn begins in the picture, px */
    camber_u32 columns, rows;            /* tiles */
    float horizon;                       /* rows of pixels, from the picture's top, in which nothing is drawn */
    camber_eye eye;
} camber_setup_args;

/* bin_count and bin_scatter: how segments are cut into chunks. */
typedef struct camber_bin_args {
    camber_u32 segment_count, a_chunk; /* all, and those of a chunk */
    camber_u32 tiles;                  /* columns * rows, rounded up to sixteens */
    camber_tile_grid of;
} camber_bin_args;

/* rasterize: what is drawn into. */
typedef struct camber_target_args {
    float left, top; /* where the first tile lies in the picture, px */
    camber_u32 columns, stride;
    float r, g, b, a; /* background, premultiplied */
    camber_u32 above; /* rows of pixels before these */
    float horizon;    /* CAMBER_RASTER_PITCHED: rows of pixels of the picture in which nothing is drawn */
    camber_eye eye;
    float sky[4];         /* what they have, premultiplied */
    camber_u32 first_job; /* an offset of work-items would be a build of its own with PoCL */
} camber_target_args;

/* rasterize draws the segments in slices, one after the other, the last in drawing order first. Between two slices a
 * tile spills its state: bits and counts of its cells, a word a row of cells, and from CAMBER_SPILL_WORDS on planes,
 * each with the sixteen floats of every cell. The first planes are the brush and the picture's level. */
typedef struct camber_spill_args {
    camber_u32 is_first, is_last; /* in the order in which slices are drawn */
    camber_u32 tile_words;
    camber_u32 sums, group, layer; /* the first plane of what unions, groups and layers have besides */
} camber_spill_args;

#define CAMBER_SPILL_WORDS 48
#define CAMBER_SPILL_BLEND_COUNTS 48 /* bytes: six sets of cells, a bit a cell, lie before them */
#define CAMBER_SPILL_ROWS 28         /* words */
#define CAMBER_SPILL_BRUSH 0x3fffffffu
#define CAMBER_SPILL_FULL 0x3ffffffeu /* a row of cells that nothing shows through */

/* rasterize, two words a job: the tile, and the first and the last row of its cells that a work-item draws. */
#define CAMBER_JOB_WORDS 2
#define CAMBER_JOB_ROWS(first, last) ((camber_u32)(first) | (camber_u32)(last) << 8)

#ifdef CAMBER_DEVICE
typedef char camber_setup_args_has_68_bytes[sizeof(camber_setup_args) == 68 ? 1 : -1];
typedef char camber_bin_args_has_28_bytes[sizeof(camber_bin_args) == 28 ? 1 : -1];
typedef char camber_target_args_has_76_bytes[sizeof(camber_target_args) == 76 ? 1 : -1];
typedef char camber_spill_args_has_24_bytes[sizeof(camber_spill_args) == 24 ? 1 : -1];
#else
_Static_assert(sizeof(camber_setup_args) == 68, "setup reads 68 bytes");
_Static_assert(sizeof(camber_bin_args) == 28, "bin_count and bin_scatter read 28 bytes");
_Static_assert(sizeof(camber_target_args) == 76, "rasterize reads 76 bytes");
_Static_assert(sizeof(camber_spill_args) == 24, "rasterize reads 24 bytes");
#endif

#endif
