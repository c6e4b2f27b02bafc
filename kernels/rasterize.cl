/* rasterize: draws the pixels of a tile, or of some rows of its cells, from the tile's list of segments.
 *
 * Reads segments and edges, as setup writes them, starts[tiles + 2], lists[starts[tiles]], brushes[brush count],
 * jobs[CAMBER_JOB_WORDS * job count]. With CAMBER_RASTER_RICH it also reads arc_lengths[CAMBER_SEGMENT_ARC_LENGTHS *
 * n], brush_ext[brush count] and the side_table that these point into; with CAMBER_RASTER_PITCHED
 * planes[CAMBER_PLANE_WORDS * n]. If there are polygons, it reads crossings and ends, as wind writes them. Writes
 * pixels, rows of `stride` words. Before the last slice it writes spill[spills * tile_words] instead.
 *
 * The list is walked from its end, because what is drawn last is on top. Segments below cells that are full are
 * skipped. Each brush is accumulated as the fraction of light that it lets through, and then composited under the
 * colours that are there already. */
#include "spill_cell.cl"

#if !CAMBER_SHARES_TILE /* rasterize_gpu.cl does this for work-items that share a tile */
#include "rasterize_rich.cl"
#include "rasterize_sixteen.cl"
#include "spill.cl"

/* A list's segments are scattered in memory. If the compiler is known to be clang, the segments of the next batch are
 * prefetched while a batch is drawn. Pixels bypass the caches, because nobody reads them before all tiles are drawn. */
#if (defined(POCL_DEVICE_ADDRESS_BITS) || defined(CAMBER_AHEAD_OF_TIME)) && CAMBER_POINT_CHUNK == CAMBER_BLOCK
#define AHEAD 24
#define ASK_FOR(address) __builtin_prefetch((const void *)(size_t)(address))
#define WRITE(vector, at) __builtin_nontemporal_store(vector, (global camber_words *)(at))
#else
#define AHEAD 0
#define ASK_FOR(address) ((void)(address))
#define WRITE(vector, at) CAMBER_STORE(vector, 0, at)
#endif

/* How many adjacent cells are written together: as many as a vector holds rows of a cell, so that one row of all these
 * cells fills a vector. */
#define CELLS_ABREAST (CAMBER_LANES / CAMBER_CELL_PX)
#if CAMBER_LANES == 16
#define ABREAST(cells, row) (uint16)((cells)[0].row, (cells)[1].row, (cells)[2].row, (cells)[3].row)
#else
#define ABREAST(cells, row) (uint8)((cells)[0].row, (cells)[1].row)
#endif

/* Writes the rows of adjacent cells. Rows of many pixels write whole cache lines. */
static inline void write_abreast(const camber_words *cells, global camber_u32 *at, size_t stride) {
#if CAMBER_LANES == 16
    WRITE(ABREAST(cells, s0123), at);
    WRITE(ABREAST(cells, s4567), at + stride);
    WRITE(ABREAST(cells, s89ab), at + 2 * stride);
    WRITE(ABREAST(cells, scdef), at + 3 * stride);
#else
    WRITE(ABREAST(cells, lo), at);
    WRITE(ABREAST(cells, hi), at + stride);
#endif
}

/* The background behind a tile's pixels; above the horizon it is the sky. Cells that the last brush covers completely
 * have its colour. */
typedef struct backdrop {
    float back[4], top;
    camber_words bare, covered;
    ulong bare_cells, covered_cells;
#if CAMBER_RASTER_PITCHED
    camber_words sky;
    float horizon;
#endif
} backdrop;

static inline void begin_backdrop(const camber_tile_state *c, camber_target_args s, float top, backdrop *b) {
    *b = (backdrop){.back = {s.r, s.g, s.b, s.a}, .top = top};
    b->bare = camber_bare_pixels(b->back);
    b->covered = camber_rgba(CAMBER_REAL(c->now.r), CAMBER_REAL(c->now.g), CAMBER_REAL(c->now.b), CAMBER_REAL(1.0f));
    b->bare_cells = ~(c->touched[CAMBER_PICTURE] | c->brushed);
    b->covered_cells = c->whole & c->brushed & ~c->touched[CAMBER_PICTURE];
#if CAMBER_RASTER_PITCHED
    b->sky = camber_rgba(CAMBER_REAL(s.sky[0]), CAMBER_REAL(s.sky[1]), CAMBER_REAL(s.sky[2]), CAMBER_REAL(s.sky[3]));
    b->horizon = s.horizon;
#endif
}

static inline camber_words look_at(camber_tile_state *c, const backdrop *b, int i, int v) {
    camber_words rgba = b->bare_cells >> i & 1      ? b->bare
                        : b->covered_cells >> i & 1 ? b->covered
                                                    : camber_tile_pixels(c, i, v, b->back);
#if CAMBER_RASTER_PITCHED
    const camber_real y = b->top + (float)(CAMBER_CELL_PX * (i / CAMBER_TILE_CELLS)) + CAMBER_LOAD((size_t)v, ROWS);
    rgba = y < b->horizon ? b->sky : rgba;
#endif
    return rgba;
}

/* Writes a row of cells of one colour. */
static inline void write_row(camber_words rgba, global camber_u32 *pixels, size_t stride) {
    for (size_t y = 0; y < CAMBER_CELL_PX; y++)
        for (size_t x = 0; x < CAMBER_TILE_PX; x += CAMBER_LANES)
            WRITE(rgba, pixels + y * stride + x);
}

static inline void write_cells(camber_tile_state *c, global camber_u32 *pixels, camber_target_args s, float top,
                               int first, int last) {
    backdrop b;
    begin_backdrop(c, s, top, &b);
    for (int j = first; j <= last; j++) {
        global camber_u32 *to = pixels + (size_t)(CAMBER_CELL_PX * j) * s.stride;
#if !CAMBER_RASTER_PITCHED
        const uint bare = b.bare_cells >> (CAMBER_TILE_CELLS * j) & 255,
                   covered = b.covered_cells >> (CAMBER_TILE_CELLS * j) & 255;
        if (bare == 255 || covered == 255) {
            write_row(bare ? b.bare : b.covered, to, s.stride);
            continue;
        }
#endif
        for (int i = CAMBER_TILE_CELLS * j; i < CAMBER_TILE_CELLS * (j + 1); i += CELLS_ABREAST)
            for (int v = 0; v < CAMBER_VECTORS; v++) {
                const int row = v * (CAMBER_LANES / CAMBER_CELL_PX);
                camber_words cells[CELLS_ABREAST];
#pragma unroll
                for (int k = 0; k < CELLS_ABREAST; k++)
                    cells[k] = look_at(c, &b, i + k, v);
                write_abreast(cells, to + (size_t)row * s.stride + i % CAMBER_TILE_CELLS * CAMBER_CELL_PX, s.stride);
            }
    }
}

/* ---- Areas ---- */

/* The data that brushes need in addition to a tile's state. */
typedef struct tile_brushes {
    global const camber_brush *brushes;
#if CAMBER_RASTER_RICH
    global const camber_brush_ext *brush_ext;
    global const float *side_table;
#if CAMBER_RASTER_PITCHED
    camber_eye eye;
#endif
#endif
} tile_brushes;

/* Queued edges of the current brush. A whole vector is queued when fifteen may be waiting, so there is room for it. */
typedef struct edge_batch {
    float ends[4][SIXTEEN + CAMBER_LANES]; /* ax, ay, bx, by; behind the last edge, anything */
    uint count;
} edge_batch;

/* Adds the first sixteen queued edges, or all if they are fewer, to the polygon. */
static __attribute__((noinline)) void add_edges(camber_tile_state *c, camber_tile_rows where, edge_batch *b) {
    for (uint v = 0; v < CAMBER_VECTORS && CAMBER_LANES * v < b->count; v++) {
        const int left = (int)b->count - (int)(CAMBER_LANES * v), count = left < CAMBER_LANES ? left : CAMBER_LANES;
        camber_ring_edges e;
        camber_ring_edges_of(CAMBER_LOAD(v, b->ends[0]), CAMBER_LOAD(v, b->ends[1]), CAMBER_LOAD(v, b->ends[2]),
                             CAMBER_LOAD(v, b->ends[3]), &e);
        camber_area_add(&c->area, &e, count, where);
    }
    b->count = b->count / SIXTEEN * (b->count % SIXTEEN); /* not as a difference: Oclgrind knows none that saturates */
    for (uint i = 0; i < 4 && b->count != 0; i++)
        CAMBER_STORE(CAMBER_LOAD(0, b->ends[i] + SIXTEEN), 0, b->ends[i]);
}

/* Queues one edge. */
static inline void queue_edge(camber_tile_state *c, global const float *edges, camber_tile_rows where, size_t which,
                              edge_batch *b) {
    const float4 ends = vload4(0, edges + camber_edge_ends(which));
    b->ends[0][b->count] = ends.s0;
    b->ends[1][b->count] = ends.s1;
    b->ends[2][b->count] = ends.s2;
    b->ends[3][b->count++] = ends.s3;
    if (b->count >= SIXTEEN)
        add_edges(c, where, b);
}

/* Queues the wanted edges of a vector. */
static inline void queue_vector(const camber_words *words, camber_mask wanted, edge_batch *b) {
#if defined(CAMBER_AHEAD_OF_TIME) && defined(__AVX512DQ__) && CAMBER_LANES == 16
    const ushort lanes = __builtin_ia32_cvtd2mask512(wanted);
    for (size_t i = 0; i < 4; i++)
        CAMBER_STORE(
            __builtin_astype(__builtin_ia32_compresssi512_mask(__builtin_astype(words[i], camber_mask), wanted, lanes),
                             camber_real),
            0, b->ends[i] + b->count);
    b->count += (uint)popcount((ulong)lanes);
#elif defined(CAMBER_AHEAD_OF_TIME) && defined(__AVX2__) && defined(__BMI2__) && CAMBER_LANES == 8
    const ulong lanes = camber_lanes_set(wanted), bytes = 255ul * __builtin_ia32_pdep_di(lanes, 0x0101010101010101ul);
    const int8 order = convert_int8(__builtin_astype(__builtin_ia32_pext_di(0x0706050403020100ul, bytes), uchar8));
    for (size_t i = 0; i < 4; i++)
        CAMBER_STORE(__builtin_ia32_permvarsf256(CAMBER_AS_REAL(words[i]), order), 0, b->ends[i] + b->count);
    b->count += (uint)popcount(lanes);
#else
    for (int k = 0; k < CAMBER_LANES; k++) {
        for (size_t i = 0; i < 4; i++)
            b->ends[i][b->count] = as_float(((const uint *)(words + i))[k]);
        b->count += camber_integer_of(&wanted, k) != 0;
    }
#endif
}

/* Queues those edges of a bunch whose boxes touch the tile. They are stored together. */
static __attribute__((noinline)) void queue_bunch(camber_tile_state *c, global const float *edges,
                                                  camber_tile_rows where, size_t first, camber_u32 brush,
                                                  edge_batch *b) {
    global const camber_u32 *ends = (global const camber_u32 *)edges + camber_edge_ends(first / 16 * 16);
    global const camber_u32 *brushes = (global const camber_u32 *)edges + camber_edge_brush(first / 16 * 16);
    for (size_t v = 0; v < CAMBER_VECTORS; v++) {
        camber_words taken[4], words[4];
        for (size_t i = 0; i < 4; i++)
            taken[i] = CAMBER_LOAD(4 * v + i, ends);
        turn_fours_over(taken, words);
        const camber_mask at_tile = camber_boxes_touch_tile(CAMBER_AS_REAL(words[0]), CAMBER_AS_REAL(words[1]),
                                                            CAMBER_AS_REAL(words[2]), CAMBER_AS_REAL(words[3]), where);
        queue_vector(words, at_tile & (CAMBER_LOAD(v, brushes) == brush), b);
        if (b->count >= SIXTEEN)
            add_edges(c, where, b);
    }
}

/* Draws the queued segments, which all have the current brush. */
static inline void draw_waiting(camber_tile_state *c, const positions *at, global const float *segments,
                                camber_tile_rows where, segment_batch *b, edge_batch *queued) {
    if (queued->count != 0)
        add_edges(c, where, queued);
    else
        draw_segment_batch(c, at, segments, where, b);
}

/* Draws the polygon whose edges have been added. */
static inline void end_area(camber_tile_state *c, const positions *at, const tile_brushes *from,
                            camber_tile_rows where) {
    camber_area_cells found;
    if (!camber_brush_is_area(&c->now))
        return;
    camber_area_find(c, where, &found);
#if CAMBER_RASTER_RICH
    if (c->brush_ext.features & CAMBER_FEATURE_IMAGE) {
        const drawn_segment source = {
            0,
            0,
            from->side_table,
#if CAMBER_RASTER_PITCHED
            0,
            from->eye
#endif
        };
        fill_with_images(c, at, source, found);
        return;
    }
#endif
    camber_area_put(c, found);
}

static inline void change_brush(camber_tile_state *c, const positions *at, tile_brushes *from, camber_tile_rows where,
                                camber_u32 brush) {
    end_area(c, at, from, where);
    camber_tile_change_brush(c, from->brushes[brush]);
#if CAMBER_RASTER_RICH
    camber_tile_use_ext(c, from->brush_ext[brush]);
#endif
}

/* Prefetches the words of a listed segment. It is usually an edge if it is among edges. */
static inline void ask_for(global const float *segments, global const float *edges, camber_target_args s,
                           camber_u32 entry) {
    const size_t which = camber_listed(entry);
    if (which - s.first_edge < s.edge_count) {
        global const float *ends = edges + camber_edge_ends(which);
        ASK_FOR(edges + camber_edge_brush(which));
        ASK_FOR(ends);
        if (entry & CAMBER_LISTED_BUNCH)
            for (int i = 1; i < 4; i++)
                ASK_FOR(ends + 16 * i);
    } else {
        ASK_FOR(segments + CAMBER_SEGMENT_WORDS * which);
    }
}

/* Returns the brush of a listed segment. */
static inline camber_u32 brush_of(global const float *segments, global const float *edges, camber_target_args s,
                                  size_t which) {
    const camber_u32 brush =
        which - s.first_edge < s.edge_count ? as_uint(edges[camber_edge_brush(which)]) : CAMBER_NO_EDGE;
    return brush != CAMBER_NO_EDGE ? brush : as_uint(segments[CAMBER_SEGMENT_WORDS * which + CAMBER_SEGMENT_BRUSH]);
}

/* Draws the areas above a brush that cover the tile completely, with none of their edges in it. Returns the last brush
 * that was drawn. */
static __attribute__((noinline)) camber_u32 draw_areas_above(camber_tile_state *c, const positions *at,
                                                             tile_brushes *from, camber_tile_rows where,
                                                             camber_crossings_left *left, camber_u32 brush,
                                                             camber_u32 current) {
    for (camber_u32 next = camber_next_area(left, &c->now); next > brush && !camber_tile_is_full(c);
         next = camber_next_area(left, &c->now)) {
        const int winding = camber_take_winding(left, next) + (next == c->now.fill);
        if (winding == 0)
            continue;
        change_brush(c, at, from, where, next);
        c->winding = winding;
        current = next;
    }
    return current;
}

CAMBER_KERNEL(1, rasterize,
              (global const float *restrict segments, global const float *restrict edges,
               global const camber_u32 *restrict starts, global const camber_u32 *restrict lists,
               global const camber_brush *restrict brushes, global const camber_u32 *restrict jobs,
               global camber_u32 *restrict pixels, const camber_target_args s, global float *restrict spill,
               const camber_spill_args slice, global const float *restrict arc_lengths,
               global const camber_brush_ext *restrict brush_ext, global const float *restrict side_table,
               global const float *restrict planes, global const camber_u32 *restrict crossings,
               global const camber_u32 *restrict ends),
              (segments, edges, starts, lists, brushes, jobs, pixels, s, spill, slice, arc_lengths, brush_ext,
               side_table, planes, crossings, ends)) {
    camber_tile_state c;
    positions at;
    segment_batch b;
    edge_batch queued;
    const size_t job = CAMBER_WORK_ITEM + s.first_job, tile = jobs[CAMBER_JOB_WORDS * job];
    const camber_u32 cells = jobs[CAMBER_JOB_WORDS * job + 1], spilled = jobs[CAMBER_JOB_WORDS * job + 2],
                     column = (camber_u32)tile % s.columns, row = (camber_u32)tile / s.columns;
    const int first = (int)(cells & 255u), last = (int)(cells >> 8);
    const float left = s.left + (float)(column * CAMBER_TILE_PX), top = s.top + (float)(row * CAMBER_TILE_PX);
    const ulong own = (~0ul >> (64 - CAMBER_TILE_CELLS * (last - first + 1))) << (CAMBER_TILE_CELLS * first);
    const camber_tile_rows where = {left, top, first, last};
    camber_u32 current = ~0u;
    /* Prefetches the next tile's first batch, and its list. They are usually needed next, and segments are scattered in
     * memory. */
    for (camber_u32 k = starts[tile + 2]; k > starts[tile + 1] && k + AHEAD > starts[tile + 2]; k--)
        ask_for(segments, edges, s, lists[k - 1]);
    for (camber_u32 k = 0; k < 4 * AHEAD; k += 16)
        ASK_FOR(lists + starts[tile + 2] + k);
    b.count = queued.count = 0;
    camber_tile_begin(&c, own, brushes);
    begin_positions(&at, left, top);
#if CAMBER_RASTER_PITCHED
    for (int j = first; j <= last; j++) /* cells above the horizon are done */
        if (top + (float)(CAMBER_CELL_PX * (j + 1)) <= s.horizon)
            c.done |= 255ul << (CAMBER_TILE_CELLS * j);
#endif
    global float *own_spill = spill + (size_t)(spilled & ~CAMBER_JOB_BEGINS) * slice.tile_words;
    tile_brushes from_brushes = {
        brushes,
#if CAMBER_RASTER_RICH
        brush_ext,
        side_table,
#if CAMBER_RASTER_PITCHED
        s.eye
#endif
#endif
    };
    camber_crossings_left left_of = {crossings, 0, 0, column};
    if (s.first_row != ~0u) {
        left_of.first = starts[s.first_row + row] - starts[s.first_row];
        left_of.end = ends[row];
    }
    if (!(spilled & CAMBER_JOB_BEGINS)) {
        current = restore_cells(&c, own_spill, brushes, slice, where);
        if (current != ~0u && current != CAMBER_SPILL_FULL) {
#if CAMBER_RASTER_RICH
            camber_tile_use_ext(&c, brush_ext[current]);
#endif
            c.winding += camber_take_winding(&left_of, current);
        }
    }
    for (camber_u32 k = starts[tile + 1]; k-- > starts[tile];) {
        ask_for(segments, edges, s, lists[k > AHEAD ? k - AHEAD : 0]);
        const size_t which = camber_listed(lists[k]);
        const camber_u32 brush = brush_of(segments, edges, s, which);
        if (brush != current) {
            draw_waiting(&c, &at, segments, where, &b, &queued);
            draw_areas_above(&c, &at, &from_brushes, where, &left_of, brush, current);
            if (camber_tile_is_full(&c))
                break;
            change_brush(&c, &at, &from_brushes, where, brush);
            c.winding = camber_take_winding(&left_of, brush);
            current = brush;
        }
        if (camber_brush_is_area(&c.now)) {
            if (lists[k] & CAMBER_LISTED_BUNCH)
                queue_bunch(&c, edges, where, which, brush, &queued);
            else
                queue_edge(&c, edges, where, which, &queued);
            continue;
        }
#if CAMBER_RASTER_RICH
        const drawn_segment from = {
            segments + CAMBER_SEGMENT_WORDS * which,
            arc_lengths + CAMBER_SEGMENT_ARC_LENGTHS * which,
            side_table,
#if CAMBER_RASTER_PITCHED
            planes + CAMBER_PLANE_WORDS * which,
            s.eye
#endif
        };
        if (c.brush_ext.features) {
            draw_rich(&c, &at, where, from);
        } else
#endif
        {
#if CAMBER_RASTER_PITCHED
            draw_segment(&c, &at, where, from);
#else
            b.which[b.count++] = (uint)which;
            if (b.count < SIXTEEN)
                continue;
            draw_segment_batch(&c, &at, segments, where, &b);
#endif
        }
        if (camber_tile_is_full(&c))
            break;
    }
    draw_waiting(&c, &at, segments, where, &b, &queued);
    current =
        draw_areas_above(&c, &at, &from_brushes, where, &left_of, camber_areas_end(&left_of, slice.is_last), current);
    const int full = camber_tile_is_full(&c);
    if (!slice.is_last && !full) {
        const camber_u32 open = (camber_u32)c.is_open[CAMBER_GROUP] << 30 | (camber_u32)c.is_open[CAMBER_LAYER] << 31;
        spill_cells(&c, own_spill, slice, where, (current & CAMBER_SPILL_BRUSH) | open);
        return;
    }
    end_area(&c, &at, &from_brushes, where);
    camber_tile_end(&c);
    if (!slice.is_last) {
        camber_tile_close_brush(&c);
        c.done = ~0ul;
        spill_cells(&c, own_spill, slice, where, CAMBER_SPILL_FULL);
        return;
    }
    write_cells(&c, pixels + ((size_t)row * CAMBER_TILE_PX + s.above) * s.stride + (size_t)column * CAMBER_TILE_PX, s,
                top, first, last);
}

#endif
