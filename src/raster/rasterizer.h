/* The rasterizer on a device: the state that rasterizer.c and buffers.c share. */
#ifndef CAMBER_RASTER_RASTERIZER_H
#define CAMBER_RASTER_RASTERIZER_H

#include "raster/raster.h"

#include "kernels/cells.h"

enum {
    BUFFER_ROWS,
    BUFFER_BRUSHES,
    BUFFER_BRUSH_EXT,
    BUFFER_SIDE_TABLE,
    BUFFER_CHANGES, /* slots at which the brush changes */
    BUFFER_SETUPS,  /* arguments of setup for the ranges of a part */
    BUFFER_SEGMENTS,
    BUFFER_EDGES, /* edges of rings */
    BUFFER_BOXES,
    BUFFER_ARC_LENGTHS,
    BUFFER_PLANES,
    BUFFER_BUNCHES, /* of edges: a word for each sixteen segments */
    BUFFER_COUNTS,
    BUFFER_TOTALS,
    BUFFER_STARTS,
    BUFFER_LISTS,
    BUFFER_CROSSINGS,
    BUFFER_ENDS, /* ends of the crossings of each row */
    BUFFER_JOBS,
    BUFFER_PIXELS,
    BUFFER_SPILL, /* state of tiles between slices */
    BUFFERS
};

enum { STAGE_SETUP, STAGE_BIN_COUNT, STAGE_BIN_SCAN, STAGE_BIN_SCATTER, STAGE_WIND, STAGE_RASTERIZE, STAGES };

/* A kernel that was started, and its stage. */
typedef struct camber_raster_pending {
    camber_event *event;
    int stage;
} camber_raster_pending;
enum { CAMBER_RASTER_PENDING = 32 };

struct camber_raster {
    camber_device *device;
    camber_program *program; /* program of the variant */
    unsigned variant;        /* variant of the last drawing */
    camber_buffer *buffers[BUFFERS];
    size_t capacities[BUFFERS];
    camber_setup_args *setups; /* for the slice's ranges. This array and the next are in host memory */
    size_t setup_capacity;
    uint32_t *starts, *jobs;
    uint32_t *spills; /* number of the spill of each tile of the band. UINT32_MAX: it has none */
    size_t start_capacity, job_capacity, spill_capacity;
    size_t spill_count, spills_before; /* tiles that have a spill, and tiles that had one before the slice */
    camber_raster_area area;           /* drawn last */
    /* the current band of the area: whole rows of tiles whose lists and spills fit */
    camber_raster_area band;
    camber_buffer *given;                /* the caller's buffer for the pixels; NULL: the rasterizer's own */
    uint32_t columns;                    /* tiles */
    size_t first_segment, segment_count; /* segments of the slice */
    size_t first_edge, end_edge;         /* as in camber_range_list */
    size_t tile_count;
    size_t list_count; /* lists of tiles, then lists of rows of tiles if there are polygons */
    uint32_t slice_count;
    camber_drawing_memory memory;
    camber_raster_pending pending[CAMBER_RASTER_PENDING];
    size_t pending_count;
    double ms[STAGES];
};

/* Whether the work-items of a group share a tile, as on GPUs. */
static inline bool camber_raster_shares_tiles(const camber_raster *raster) {
    return raster->device->lanes == 1;
}

/* Returns how many words a tile spills for a brush of polygons, and for everything else but its planes. */
static inline uint32_t camber_raster_area_words(const camber_raster *raster) {
    return camber_raster_shares_tiles(raster) ? CAMBER_SHARED_AREA_WORDS : CAMBER_AREA_WORDS;
}

static inline uint32_t camber_raster_state_words(const camber_raster *raster) {
    return camber_raster_shares_tiles(raster) ? CAMBER_TILE_ITEMS_WORDS : CAMBER_SPILL_CELL_WORDS * CAMBER_CELLS;
}

/* How many eighths of the drawing memory each kind of buffer may take. A picture with more segments is drawn in slices,
 * from the last to the first. If lists or spills would take more, a band is halved; if the lists of a single row of
 * tiles would, the slice is halved. There are as many chunks of segments as there is room for their counts. */
typedef enum camber_raster_eighths {
    CAMBER_RASTER_COUNTS = 1,
    CAMBER_RASTER_LISTS = 1,
    CAMBER_RASTER_SPILLS = 2,
    CAMBER_RASTER_SEGMENTS = 4,
} camber_raster_eighths;
/* Returns the given eighths in bytes; without a memory limit, as many bytes as are useful. */
uint64_t camber_raster_most_bytes(const camber_raster *raster, camber_raster_eighths eighths);
/* Frees a buffer. */
void camber_raster_drop(camber_raster *raster, int which);
/* Makes a buffer hold at least size_bytes. If it grows, its contents are lost. */
camber_status camber_raster_reserve(camber_raster *raster, int which, size_t size_bytes);
/* Writes bytes to a buffer. They must stay valid until the caller has waited for the drawing. */
camber_status camber_raster_put(camber_raster *raster, int which, const void *bytes, size_t size_bytes);

#endif
