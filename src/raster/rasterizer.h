/* What draws on a device, for the steps of it that lie in files of their own. */
#ifndef CAMBER_RASTER_RASTERIZER_H
#define CAMBER_RASTER_RASTERIZER_H

#include "raster/raster.h"

enum {
    BUFFER_FILL, /* camber_fill_records */
    BUFFER_ROWS,
    BUFFER_INKS,
    BUFFER_MORE,
    BUFFER_TAIL,
    BUFFER_SHAPES,
    BUFFER_BOXES,
    BUFFER_MEASURES,
    BUFFER_PLANES,
    BUFFER_COUNTS,
    BUFFER_TOTALS,
    BUFFER_STARTS,
    BUFFER_LISTS,
    BUFFER_ITEMS,
    BUFFER_PIXELS,
    BUFFER_KEPT, /* of tiles, between slices */
    BUFFERS
};

enum { STAGE_SHAPE, STAGE_COUNT, STAGE_TOTAL, STAGE_FILL, STAGE_COVER, STAGES };

/* A kernel that was started, and of which stage. */
typedef struct camber_cover_pending {
    cl_event event;
    int stage;
} camber_cover_pending;
enum { CAMBER_COVER_PENDING = 32 };

struct camber_cover {
    camber_device *device;
    camber_program *program; /* of the variant */
    unsigned variant;        /* of what was drawn last */
    cl_mem buffers[BUFFERS];
    size_t capacities[BUFFERS];
    uint32_t *starts, *items; /* of the host */
    size_t start_capacity, item_capacity;
    camber_cover_area area;          /* drawn last */
    camber_cover_area band;          /* of it: whole rows of tiles, as many as there is room for lists */
    cl_mem given;                    /* where its pixels are, if not in a buffer of its own */
    uint32_t columns;                /* tiles */
    size_t first_shape, shape_count; /* of the slice */
    size_t tile_count;
    uint32_t slice_count;
    camber_drawing_memory memory;
    camber_cover_pending pending[CAMBER_COVER_PENDING];
    size_t pending_count;
    double ms[STAGES];
};

/* Of shapes, of lists, and of what is kept of tiles, each. */
uint64_t camber_cover_most_bytes(const camber_cover *cover);
/* A buffer of that size at least; what it had is lost where it grows. */
camber_status camber_cover_reserve(camber_cover *cover, int which, size_t size_bytes);
/* What is put must stay until what is drawn is waited for. */
camber_status camber_cover_put(camber_cover *cover, int which, const void *bytes, size_t size_bytes);

#endif
