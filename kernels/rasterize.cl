/* rasterize: draws the pixels of a tile, or of some rows of its cells, from the tile's list of segments.
 *
 * Reads segments[CAMBER_SEGMENT_WORDS * n], starts[tiles + 1], lists[starts[tiles]], brushes[brush count],
 * jobs[CAMBER_JOB_WORDS * job count]. With CAMBER_RASTER_RICH it also reads arc_lengths[CAMBER_SEGMENT_ARC_LENGTHS *
 * n], brush_ext[brush count] and the side_table that these point into; with CAMBER_RASTER_PITCHED
 * planes[CAMBER_PLANE_WORDS * n]. Writes pixels, rows of `stride` words. Before the last slice it writes spill[tiles *
 * tile_words] instead.
 *
 * The list is walked from its end, as what is drawn last is seen first. Segments below cells that are full are skipped.
 * Each brush is gathered as the share of light that it lets through, and then put under what is there already.
 * rasterize_gpu.cl writes the same bytes, with a work-item for each pixel. */
#include "rasterize_pitch.cl"
#include "rasterize_rich.cl"
#include "rasterize_sixteen.cl"

/* A list's segments are scattered in memory. Where the compiler is known to be clang, they are prefetched. */
#if defined(POCL_DEVICE_ADDRESS_BITS) && CAMBER_POINT_CHUNK == CAMBER_BLOCK
#define AHEAD 6
#define ASK_FOR(address) __builtin_prefetch((const void *)(size_t)(address))
#else
#define AHEAD 0
#define ASK_FOR(address) ((void)0)
#endif

#if CAMBER_LANES == 16
/* Whether nothing shows of the segments to come. A cell that is filled in a layer or group may still be translucent. */
static inline int is_full(private const tile_state *c) {
    const int opaque = c->now.mode != CAMBER_BRUSH_UNION && !c->is_open[1] && !c->is_open[2];
    return (c->done | (opaque ? c->filled : 0ul)) == ~0ul;
}

static inline uint16 level_of(float16 value) {
    const float16 scaled = value * 255.0f + 0.5f, least = scaled > 0.0f ? scaled : (float16)(0.0f);
    return convert_uint16(least < 255.0f ? least : (float16)(255.0f));
}

static inline uint16 pixels_of(private const float16 *r, private const float16 *g, private const float16 *b,
                               float16 through, camber_target_args s) {
    return level_of(*r + through * s.r) | level_of(*g + through * s.g) << 8 | level_of(*b + through * s.b) << 16 |
           level_of(1.0f - through + through * s.a) << 24;
}

static inline void write_cells(private const tile_state *c, global camber_u32 *pixels, camber_target_args s, float top,
                               int first, int last) {
    const float16 none = (float16)(0.0f);
    const uint16 bare = pixels_of(&none, &none, &none, (float16)(1.0f), s);
#if CAMBER_RASTER_PITCHED
    const uint16 sky = level_of((float16)(s.sky[0])) | level_of((float16)(s.sky[1])) << 8 |
                       level_of((float16)(s.sky[2])) << 16 | level_of((float16)(s.sky[3])) << 24;
#endif
    for (int i = CAMBER_TILE_CELLS * first; i < CAMBER_TILE_CELLS * (last + 1); i++) {
        uint16 rgba = bare;
        if (c->touched[0] >> i & 1ul)
            rgba = pixels_of(c->level[0][0] + i, c->level[0][1] + i, c->level[0][2] + i, c->level[0][3][i], s);
#if CAMBER_RASTER_PITCHED
        const float16 y = top + (float)(CAMBER_CELL_PX * (i / CAMBER_TILE_CELLS)) + vload16(0, DOWN);
        rgba = y < s.horizon ? sky : rgba;
#endif
        global camber_u32 *at = pixels + (size_t)(i / CAMBER_TILE_CELLS * CAMBER_CELL_PX) * s.stride +
                                i % CAMBER_TILE_CELLS * CAMBER_CELL_PX;
        vstore4(rgba.s0123, 0, at);
        vstore4(rgba.s4567, 0, at + s.stride);
        vstore4(rgba.s89ab, 0, at + 2 * (size_t)s.stride);
        vstore4(rgba.scdef, 0, at + 3 * (size_t)s.stride);
    }
}

CAMBER_KERNEL(1, rasterize,
              (global const float *restrict segments, global const camber_u32 *restrict starts,
               global const camber_u32 *restrict lists, global const camber_brush *restrict brushes,
               global const camber_u32 *restrict jobs, global camber_u32 *restrict pixels, const camber_target_args s,
               global float *restrict spill, const camber_spill_args slice, global const float *restrict arc_lengths,
               global const camber_brush_ext *restrict brush_ext, global const float *restrict side_table,
               global const float *restrict planes),
              (segments, starts, lists, brushes, jobs, pixels, s, spill, slice, arc_lengths, brush_ext, side_table,
               planes)) {
    tile_state c;
    positions at;
    sixteen b;
    const size_t job = CAMBER_WORK_ITEM + s.first_job, tile = jobs[CAMBER_JOB_WORDS * job];
    const camber_u32 cells = jobs[CAMBER_JOB_WORDS * job + 1], column = (camber_u32)tile % s.columns,
                     row = (camber_u32)tile / s.columns;
    const int first = (int)(cells & 255u), last = (int)(cells >> 8);
    const float left = s.left + (float)(column * CAMBER_TILE_PX), top = s.top + (float)(row * CAMBER_TILE_PX);
    const ulong own = (~0ul >> (64 - CAMBER_TILE_CELLS * (last - first + 1))) << (CAMBER_TILE_CELLS * first);
    const tile_rows where = {left, top, first, last};
    camber_u32 current = ~0u;
    b.count = 0;
    begin_tile_state(&c, own);
    begin_positions(&at, left, top);
#if CAMBER_RASTER_PITCHED
    for (int j = first; j <= last; j++) /* cells above the horizon are done */
        if (top + (float)(CAMBER_CELL_PX * (j + 1)) <= s.horizon)
            c.done |= 255ul << (CAMBER_TILE_CELLS * j);
#endif
    c.now = brushes[0];
    global float *own_spill = spill + tile * slice.tile_words;
    if (!slice.is_first) {
        if (!slice.is_last && starts[tile] == starts[tile + 1])
            return;
        current = restore_cells(&c, own_spill, brushes, slice, first, last);
#if CAMBER_RASTER_RICH
        if (current != ~0u && current != CAMBER_SPILL_FULL)
            use_brush_ext(&c, brush_ext[current]);
#endif
    }
    for (camber_u32 k = starts[tile + 1]; k-- > starts[tile];) {
        global const float *segment = segments + (size_t)CAMBER_SEGMENT_WORDS * lists[k];
        ASK_FOR(segments + (size_t)CAMBER_SEGMENT_WORDS * lists[k > AHEAD ? k - AHEAD : 0]);
        const camber_u32 brush = as_uint(segment[CAMBER_SEGMENT_BRUSH]);
        if (brush != current) {
            draw_sixteen(&c, &at, segments, where, &b);
            change_brush(&c, brushes[brush]);
#if CAMBER_RASTER_RICH
            use_brush_ext(&c, brush_ext[brush]);
#endif
            current = brush;
        }
#if CAMBER_RASTER_PITCHED
        draw_tilted(&c, &at, where,
                    (tilted){segment, planes + (size_t)CAMBER_PLANE_WORDS * lists[k],
                             arc_lengths + CAMBER_SEGMENT_ARC_LENGTHS * (size_t)lists[k], side_table, s.eye});
#else
#if CAMBER_RASTER_RICH
        if (c.brush_ext.features) {
            draw_rich(&c, &at, segment, where, arc_lengths + CAMBER_SEGMENT_ARC_LENGTHS * (size_t)lists[k], side_table);
        } else
#endif
            if (c.now.mode == CAMBER_BRUSH_UNION) {
            draw_segment(&c, &at, segment, where);
        } else {
            b.which[b.count++] = lists[k];
            if (b.count < CAMBER_SIXTEEN)
                continue;
            draw_sixteen(&c, &at, segments, where, &b);
        }
#endif
        if (is_full(&c))
            break;
    }
    draw_sixteen(&c, &at, segments, where, &b);
    const int full = is_full(&c);
    if (!slice.is_last && !full) {
        const camber_u32 open = (camber_u32)c.is_open[1] << 30 | (camber_u32)c.is_open[2] << 31;
        spill_cells(&c, own_spill, slice, first, last, (current & CAMBER_SPILL_BRUSH) | open);
        return;
    }
    close_brush(&c);
    if (c.is_open[2])
        close_level(&c, 2, c.now.layer_opacity);
    if (c.is_open[1])
        close_level(&c, 1, c.now.group_opacity);
    if (!slice.is_last) {
        c.done = ~0ul;
        spill_cells(&c, own_spill, slice, first, last, CAMBER_SPILL_FULL);
        return;
    }
    write_cells(&c, pixels + ((size_t)row * CAMBER_TILE_PX + s.above) * s.stride + (size_t)column * CAMBER_TILE_PX, s,
                top, first, last);
}
#endif
