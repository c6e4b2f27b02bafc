/* rasterize on a GPU: a work-group draws a row of a tile's cells, a work-item a pixel. Only plain frames are drawn so.
 *
 * It reads what rasterize.cl reads without CAMBER_RASTER_RICH, and writes the same pixels; its spills are laid out in
 * another way. The sixteen work-items of a cell decide alike, by values that all have or by the largest of theirs. So
 * the whole group comes to the same barriers. */
#include "tile_state.cl"

#if CAMBER_LANES == 1

#define RASTERIZE_LANES (CAMBER_TILE_PX * CAMBER_CELL_PX)
#define CELL_LANES (CAMBER_CELL_PX * CAMBER_CELL_PX)
/* segments that are drawn at once: so a cell has to be checked only once among them */
#define SIXTEEN CAMBER_LOOK_EVERY

/* For functions with arguments in local memory: PoCL 3.1 loses these in a call that is not inlined. */
#define HERE inline __attribute__((always_inline))

/* Up to sixteen segments in local memory, which all lanes read. */
typedef struct sixteen {
    camber_edge edges[SIXTEEN];
    float reaches[SIXTEEN];
    camber_u32 brushes[SIXTEEN];
} sixteen;

typedef struct level {
    float r, g, b, through;
} level;

/* The state of a pixel; from `done` on it is the state of its cell, the same in all lanes of the cell. */
typedef struct tile_state {
    float x, y;      /* the pixel in its cell, px */
    int column, row; /* of the cell in its tile */
    float brush, sum, normal_x, normal_y;
    level levels[LEVELS]; /* indexed by constants only, so that they stay in registers */
    int done, filled, brushed, touched[LEVELS];
    camber_u32 blend_count;
    int is_open[LEVELS]; /* the same in all cells */
    camber_brush now;
} tile_state;

/* The largest value among the lanes of a cell. All lanes of the group call this together. */
static HERE float most_of(local float *values, float value) {
    const camber_u32 lane = (camber_u32)get_local_id(0), first = lane / CELL_LANES * CELL_LANES;
    float most = 0.0f;
    values[lane] = value;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (camber_u32 i = 0; i < CELL_LANES; i++)
        most = CAMBER_MORE(values[first + i], most);
    barrier(CLK_LOCAL_MEM_FENCE);
    return most;
}

static inline void begin_tile_state(private tile_state *c, int row) {
    const int lane = (int)get_local_id(0), at = lane % CELL_LANES;
    c->x = (float)(at % CAMBER_CELL_PX);
    c->y = (float)(at / CAMBER_CELL_PX);
    c->column = lane / CELL_LANES;
    c->row = row;
    c->brush = 1.0f;
    c->sum = c->normal_x = c->normal_y = 0.0f;
    for (int k = 0; k < LEVELS; k++) {
        c->levels[k] = (level){0.0f, 0.0f, 0.0f, 1.0f};
        c->touched[k] = c->is_open[k] = 0;
    }
    c->done = c->filled = c->brushed = 0;
    c->blend_count = 0;
}

static inline void close_brush(private tile_state *c) {
    const int at = c->is_open[2] ? 2 : c->is_open[1] ? 1 : 0;
    float area = 1.0f - c->brush;
    if (c->now.mode == CAMBER_BRUSH_UNION)
        area = camber_united(area, c->sum, c->normal_x, c->normal_y) * c->now.a;
#pragma unroll
    for (int k = 0; k < LEVELS; k++)
        if (k == at && c->brushed) {
          private
            level *to = c->levels + k;
            const float seen = to->through * area;
            to->r += seen * c->now.r;
            to->g += seen * c->now.g;
            to->b += seen * c->now.b;
            to->through = to->through * (1.0f - area);
            c->touched[k] = 1;
        }
    c->brush = 1.0f;
    c->sum = c->normal_x = c->normal_y = 0.0f;
    c->brushed = c->filled = 0;
}

static inline void close_level(private tile_state *c, int from, int below, float opacity) {
  private
    level *of = c->levels + from, *to = c->levels + below;
    if (c->touched[from]) {
        const float seen = to->through * opacity;
        to->r += seen * of->r;
        to->g += seen * of->g;
        to->b += seen * of->b;
        to->through = to->through * (1.0f - (1.0f - of->through) * opacity);
        *of = (level){0.0f, 0.0f, 0.0f, 1.0f};
        c->touched[below] = 1;
    }
    c->touched[from] = c->is_open[from] = 0;
}

static inline void close_layer(private tile_state *c) {
    if (c->is_open[1])
        close_level(c, 2, 1, c->now.layer_opacity);
    else
        close_level(c, 2, 0, c->now.layer_opacity);
}

static inline void change_brush(private tile_state *c, camber_brush next) {
    close_brush(c);
    if (c->is_open[2] && next.layer != c->now.layer)
        close_layer(c);
    if (c->is_open[1] && next.group != c->now.group)
        close_level(c, 1, 0, c->now.group_opacity);
    c->is_open[1] |= next.group != 0u;
    c->is_open[2] |= next.layer != 0u;
    c->now = next;
}

/* Whether the cell lies in the box of a segment. */
static inline int is_in_box(private const tile_state *c, private const camber_edge *p, float reach, float left,
                            float top) {
    const float a_cell = 1.0f / CAMBER_CELL_PX, side = (float)(CAMBER_TILE_CELLS - 1);
    const float x0 = (CAMBER_LESS(p->ax, p->bx) - reach - left + 0.5f) * a_cell;
    const float x1 = (CAMBER_MORE(p->ax, p->bx) + reach - left - 0.5f) * a_cell;
    const float y0 = (CAMBER_LESS(p->ay, p->by) - reach - top + 0.5f) * a_cell;
    const float y1 = (CAMBER_MORE(p->ay, p->by) + reach - top - 0.5f) * a_cell;
    if (x1 < 0.0f || y1 < 0.0f || x0 >= side + 1.0f || y0 >= side + 1.0f)
        return 0;
    const int from_x = x0 > 0.0f ? (int)x0 : 0, to_x = x1 < side ? (int)x1 : CAMBER_TILE_CELLS - 1;
    const int from_y = y0 > 0.0f ? (int)y0 : 0, to_y = y1 < side ? (int)y1 : CAMBER_TILE_CELLS - 1;
    return c->column >= from_x && c->column <= to_x && c->row >= from_y && c->row <= to_y;
}

static inline void put_area(private tile_state *c, private const camber_edge *p, float area, float x, float y) {
    if (c->now.mode != CAMBER_BRUSH_UNION) {
        c->brush *= 1.0f - area * c->now.a;
        c->blend_count++;
        return;
    }
    c->brush *= 1.0f - area;
    if (p->half_width > 0.4f) {
        float nx, ny;
        camber_edge_normal(p, x, y, &nx, &ny);
        const float edge = area * (1.0f - area);
        c->sum += area;
        c->normal_x += nx * edge;
        c->normal_y += ny * edge;
    }
}

/* Draws a segment into the pixel. Returns whether it is time to check if the cell is filled. */
static inline int draw_segment(private tile_state *c, private const camber_edge *p, float reach, float left,
                               float top) {
    if (c->done || c->filled || !is_in_box(c, p, reach, left, top))
        return 0;
    const int is_union = c->now.mode == CAMBER_BRUSH_UNION;
    const float to_middle = 0.5f * (CAMBER_CELL_PX - 1);
    const float first_x = left + 0.5f + (float)(CAMBER_CELL_PX * c->column);
    const float first_y = top + 0.5f + (float)(CAMBER_CELL_PX * c->row);
    camber_cell_masks cell;
    camber_cell_masks_of(p, first_x + to_middle, first_y + to_middle, &cell);
    if (!cell.partial)
        return 0;
    c->brushed = 1;
    if (p->half_width > 2.0f && cell.full && !cell.near_end) {
        c->brush *= is_union ? 0.0f : 1.0f - c->now.a;
        c->filled = is_union || c->now.a == 1.0f;
        return 0;
    }
    const float px = first_x + c->x, py = first_y + c->y, qx = px - p->ax, qy = py - p->ay;
    const float x = qx * p->ux + qy * p->uy, y = qy * p->ux - qx * p->uy;
    const float fa = qx * p->nax + qy * p->nay, fb = (px - p->bx) * p->nbx + (py - p->by) * p->nby;
    const float area = cell.near_end ? camber_edge_area(p, x, y, fa, fb) : camber_edge_side(p, y);
    put_area(c, p, area, x, y);
    return !is_union && c->now.a == 1.0f && c->blend_count % CAMBER_LOOK_EVERY == 0;
}

/* Draws segments [from, count) until the cell has to be checked. Returns the next segment; past SIXTEEN: all are drawn.
 */
static HERE camber_u32 draw_some(private tile_state *c, local const sixteen *b, camber_u32 from, camber_u32 count,
                                 float2 corner) {
    int looks = 0;
    for (; from < count && !looks; from++) {
        const camber_edge p = b->edges[from];
        looks = draw_segment(c, &p, b->reaches[from], corner.x, corner.y);
    }
    return looks ? from : SIXTEEN + 1;
}

static inline camber_u32 level_of(float value) {
    const float scaled = value * 255.0f + 0.5f, least = scaled > 0.0f ? scaled : 0.0f;
    return (camber_u32)(least < 255.0f ? least : 255.0f);
}

static HERE void load_sixteen(local sixteen *b, global const float *segments, global const camber_u32 *lists,
                              camber_u32 end, camber_u32 count) {
    const camber_u32 lane = (camber_u32)get_local_id(0);
    if (lane < count) {
        global const float *segment = segments + (size_t)CAMBER_SEGMENT_WORDS * lists[end - 1u - lane];
        camber_edge p;
        camber_edge_of(segment, as_uint(segment[CAMBER_SEGMENT_FLAGS]), &p);
        b->edges[lane] = p;
        b->reaches[lane] = segment[CAMBER_SEGMENT_REACH];
        b->brushes[lane] = as_uint(segment[CAMBER_SEGMENT_BRUSH]);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

/* Whether nothing shows of the segments to come, in any cell of the group. */
static HERE int is_full(private const tile_state *c, local float *values) {
    const int opaque = c->now.mode != CAMBER_BRUSH_UNION && !c->is_open[1] && !c->is_open[2];
    const camber_u32 lane = (camber_u32)get_local_id(0);
    int full = 1;
    if (lane % CELL_LANES == 0)
        values[lane / CELL_LANES] = c->done || (opaque && c->filled) ? 1.0f : 0.0f;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int i = 0; i < CAMBER_TILE_CELLS; i++)
        full &= values[i] > 0.0f;
    barrier(CLK_LOCAL_MEM_FENCE);
    return full;
}

/* ---- Between slices: 16 bits for each cell; a word for each row of cells, its brush and open levels; the planes ----
 */

#define LANES_ROWS 32 /* the word at which the rows' words begin */
#define PLANE (CAMBER_TILE_PX * CAMBER_TILE_PX)

static inline void spill_level(global float *planes, size_t plane, size_t at, private const level *l) {
    planes[plane * PLANE + at] = l->r;
    planes[(plane + 1) * PLANE + at] = l->g;
    planes[(plane + 2) * PLANE + at] = l->b;
    planes[(plane + 3) * PLANE + at] = l->through;
}

static inline void restore_level(global const float *planes, size_t plane, size_t at, private level *l) {
    l->r = planes[plane * PLANE + at];
    l->g = planes[(plane + 1) * PLANE + at];
    l->b = planes[(plane + 2) * PLANE + at];
    l->through = planes[(plane + 3) * PLANE + at];
}

static inline void spill_pixel(private const tile_state *c, global float *spill, camber_spill_args s, camber_u32 now) {
    global ushort *cells = (global ushort *)spill + CAMBER_TILE_CELLS * c->row;
    global float *planes = spill + CAMBER_SPILL_WORDS;
    const size_t lane = get_local_id(0), at = (size_t)(RASTERIZE_LANES * c->row) + lane;
    if (lane % CELL_LANES == 0)
        cells[c->column] =
            (ushort)((c->brushed != 0) | (c->filled != 0) << 1 | (c->done != 0) << 2 | (c->touched[0] != 0) << 3 |
                     (c->touched[1] != 0) << 4 | (c->touched[2] != 0) << 5 | (c->blend_count % CAMBER_LOOK_EVERY) << 6);
    if (lane == 0)
        ((global camber_u32 *)spill)[LANES_ROWS + c->row] = now;
    planes[at] = c->brush;
    spill_level(planes, 1, at, &c->levels[0]);
    if (c->now.mode == CAMBER_BRUSH_UNION) {
        planes[s.sums * PLANE + at] = c->sum;
        planes[(s.sums + 1) * PLANE + at] = c->normal_x;
        planes[(s.sums + 2) * PLANE + at] = c->normal_y;
    }
    if (c->is_open[1])
        spill_level(planes, s.group, at, &c->levels[1]);
    if (c->is_open[2])
        spill_level(planes, s.layer, at, &c->levels[2]);
}

/* Restores a pixel. Returns the brush that was drawn last, ~0 if none was, or CAMBER_SPILL_FULL. */
static inline camber_u32 restore_pixel(private tile_state *c, global const float *spill,
                                       global const camber_brush *brushes, camber_spill_args s) {
    global const float *planes = spill + CAMBER_SPILL_WORDS;
    const size_t at = (size_t)(RASTERIZE_LANES * c->row) + get_local_id(0);
    const camber_u32 cell = ((global const ushort *)spill)[CAMBER_TILE_CELLS * c->row + c->column];
    const camber_u32 now = ((global const camber_u32 *)spill)[LANES_ROWS + c->row];
    c->brushed = cell & 1u;
    c->filled = cell >> 1 & 1u;
    c->done = cell >> 2 & 1u;
    for (camber_u32 k = 0; k < LEVELS; k++)
        c->touched[k] = cell >> (3u + k) & 1u;
    c->blend_count = cell >> 6;
    c->brush = planes[at];
    restore_level(planes, 1, at, &c->levels[0]);
    if (now == CAMBER_SPILL_FULL)
        return now;
    c->is_open[1] = now >> 30 & 1u;
    c->is_open[2] = now >> 31 & 1u;
    if (c->is_open[1])
        restore_level(planes, s.group, at, &c->levels[1]);
    if (c->is_open[2])
        restore_level(planes, s.layer, at, &c->levels[2]);
    if ((now & CAMBER_SPILL_BRUSH) == CAMBER_SPILL_BRUSH)
        return ~0u;
    c->now = brushes[now & CAMBER_SPILL_BRUSH];
    if (c->now.mode == CAMBER_BRUSH_UNION) {
        c->sum = planes[s.sums * PLANE + at];
        c->normal_x = planes[(s.sums + 1) * PLANE + at];
        c->normal_y = planes[(s.sums + 2) * PLANE + at];
    }
    return now & CAMBER_SPILL_BRUSH;
}

/* ---- The row of cells ---- */

static inline void finish(private tile_state *c) {
    close_brush(c);
    if (c->is_open[2])
        close_layer(c);
    if (c->is_open[1])
        close_level(c, 1, 0, c->now.group_opacity);
}

static inline void write_pixel(private const tile_state *c, global camber_u32 *pixels, camber_target_args s,
                               camber_u32 column, camber_u32 row) {
    const level l = c->levels[0];
    const size_t x = (size_t)column * CAMBER_TILE_PX + (size_t)(CAMBER_CELL_PX * c->column + (int)c->x);
    const size_t y = (size_t)row * CAMBER_TILE_PX + s.above + (size_t)(CAMBER_CELL_PX * c->row + (int)c->y);
    pixels[y * s.stride + x] = level_of(l.r + l.through * s.r) | level_of(l.g + l.through * s.g) << 8 |
                               level_of(l.b + l.through * s.b) << 16 |
                               level_of(1.0f - l.through + l.through * s.a) << 24;
}

kernel __attribute__((reqd_work_group_size(RASTERIZE_LANES, 1, 1))) void rasterize(
    global const float *restrict segments, global const camber_u32 *restrict starts,
    global const camber_u32 *restrict lists, global const camber_brush *restrict brushes,
    global const camber_u32 *restrict jobs, global camber_u32 *restrict pixels, const camber_target_args s,
    global float *restrict spill, const camber_spill_args slice, global const float *restrict arc_lengths,
    global const camber_brush_ext *restrict brush_ext, global const float *restrict side_table,
    global const float *restrict planes) {
    local sixteen b;
    local float values[RASTERIZE_LANES];
    tile_state c;
    const size_t job = get_global_id(0) / RASTERIZE_LANES + s.first_job;
    const camber_u32 tile = jobs[CAMBER_JOB_WORDS * job], column = tile % s.columns, row = tile / s.columns,
                     from = starts[tile];
    const float2 corner = (float2)(s.left + (float)(column * CAMBER_TILE_PX), s.top + (float)(row * CAMBER_TILE_PX));
    global float *own_spill = spill + (size_t)tile * slice.tile_words;
    camber_u32 current = ~0u, end = starts[tile + 1];
    const int idles = !slice.is_first && !slice.is_last && end == from;
    begin_tile_state(&c, (int)(jobs[CAMBER_JOB_WORDS * job + 1] & 255u));
    c.now = brushes[0];
    if (!slice.is_first && !idles)
        current = restore_pixel(&c, own_spill, brushes, slice);
    barrier(CLK_GLOBAL_MEM_FENCE); /* no lane may spill before all have restored */
    int full = current == CAMBER_SPILL_FULL;
    while (end > from && !full) {
        const camber_u32 most = end - from < SIXTEEN ? end - from : SIXTEEN;
        load_sixteen(&b, segments, lists, end, most);
        camber_u32 count = 1;
        while (count < most && b.brushes[count] == b.brushes[0])
            count++;
        if (b.brushes[0] != current) {
            change_brush(&c, brushes[b.brushes[0]]);
            current = b.brushes[0];
        }
        c.done |= most_of(values, c.levels[0].through) < CAMBER_NOTHING_PX;
        const camber_u32 next = draw_some(&c, &b, 0, count, corner);
        c.filled |= (most_of(values, c.brush) < CAMBER_NOTHING_PX) & (next <= SIXTEEN);
        (void)draw_some(&c, &b, next, count, corner);
        full = is_full(&c, values);
        end -= count;
    }
    if (slice.is_last || full)
        finish(&c);
    if (slice.is_last)
        write_pixel(&c, pixels, s, column, row);
    else if (!idles)
        spill_pixel(&c, own_spill, slice,
                    full ? CAMBER_SPILL_FULL
                         : (current & CAMBER_SPILL_BRUSH) | (camber_u32)c.is_open[1] << 30 |
                               (camber_u32)c.is_open[2] << 31);
}
#endif
