/* count: how many segments of each chunk each tile has; a chunk is a work-item.
 * Reads shapes, boxes[shape_count]; writes counts[chunks * tiles]. */
typedef struct camber_bin_args {
    camber_u32 segment_count, a_chunk; /* segments */
    camber_u32 tiles;                  /* columns * rows, rounded up to sixteens */
    camber_tile_grid of;
} camber_bin_args;

#define FIRST_X(box) ((box)&255u)
#define FIRST_Y(box) ((box) >> 8 & 255u)
#define LAST_X(box) ((box) >> 16 & 255u)
#define LAST_Y(box) ((box) >> 24)

/* Whether a box is one tile that camber_tile_span says nothing of. */
static inline int is_one_tile(camber_u32 box, camber_u32 columns) {
    return box >> 16 == (box & 0xffffu) && FIRST_X(box) - 1u < columns - 2u;
}

#if CAMBER_LANES == 16
CAMBER_KERNEL(1, bin_count,
              (global const float *restrict segments, global const camber_u32 *restrict boxes,
               global camber_u32 *restrict counts, const camber_bin_args c),
              (segments, boxes, counts, c)) {
    const size_t chunk = CAMBER_WORK_ITEM, first = chunk * c.a_chunk;
    const size_t end = first + c.a_chunk < c.segment_count ? first + c.a_chunk : c.segment_count;
    const camber_tile_grid of = c.of;
    global camber_u32 *own = counts + chunk * c.tiles;
    for (size_t i = 0; i < c.tiles / 16; i++)
        vstore16((uint16)(0u), i, own);
    for (size_t i = first; i < end; i++) {
        const camber_u32 box = boxes[i];
        if (FIRST_X(box) > LAST_X(box))
            continue;
        if (is_one_tile(box, of.columns)) {
            own[FIRST_Y(box) * of.columns + FIRST_X(box)]++;
            continue;
        }
        for (camber_u32 y = FIRST_Y(box); y <= LAST_Y(box); y++) {
            const camber_u32 span = camber_tile_span(segments + CAMBER_SEGMENT_WORDS * i, box, y, &of);
            for (camber_u32 x = span & 255u; x <= span >> 8; x++)
                own[y * of.columns + x]++;
        }
    }
}
#endif
