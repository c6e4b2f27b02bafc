/* count: how many segments of each chunk each tile has; a chunk is a work-item.
 * Reads shapes, boxes[shape_count]; writes counts[chunks * tiles]. */
typedef struct camber_chunks {
    camber_u32 shape_count, a_chunk; /* segments */
    camber_u32 columns, tiles;       /* tiles: columns * rows, rounded up to sixteens */
    float left, top;
} camber_chunks;

#define FIRST_X(box) ((box)&255u)
#define FIRST_Y(box) ((box) >> 8 & 255u)
#define LAST_X(box) ((box) >> 16 & 255u)
#define LAST_Y(box) ((box) >> 24)

/* The tiles of a box's row that a segment meets; those of small boxes all. */
static inline camber_u32 span_of(global const float *shapes, size_t i, camber_u32 box, camber_u32 y, camber_chunks c) {
    const camber_u32 first = FIRST_X(box), last = LAST_X(box);
    if (first == last || FIRST_Y(box) == LAST_Y(box))
        return first | last << 8;
    const float middle = c.top + ((float)y + 0.5f) * CAMBER_TILE_PX;
    return camber_row_span(shapes + CAMBER_SHAPE_WORDS * i, middle, c.left, first, last, CAMBER_TILE_PX);
}

kernel __attribute__((reqd_work_group_size(1, 1, 1))) void count(global const float *restrict shapes,
                                                                 global const camber_u32 *restrict boxes,
                                                                 global camber_u32 *restrict counts,
                                                                 const camber_chunks c) {
    const size_t chunk = get_global_id(0), first = chunk * c.a_chunk;
    const size_t end = first + c.a_chunk < c.shape_count ? first + c.a_chunk : c.shape_count;
    global camber_u32 *own = counts + chunk * c.tiles;
    for (size_t i = 0; i < c.tiles / 16; i++)
        vstore16((uint16)(0u), i, own);
    for (size_t i = first; i < end; i++) {
        const camber_u32 box = boxes[i];
        if (FIRST_X(box) > LAST_X(box))
            continue;
        for (camber_u32 y = FIRST_Y(box); y <= LAST_Y(box); y++) {
            const camber_u32 span = span_of(shapes, i, box, y, c);
            for (camber_u32 x = span & 255u; x <= span >> 8; x++)
                own[y * c.columns + x]++;
        }
    }
}
