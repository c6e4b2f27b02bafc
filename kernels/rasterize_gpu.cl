/* rasterize for GPUs: a work-group draws a tile, and each of its work-items a row of the pixels of one cell.
 * rasterize.cl says what is read and written.
 *
 * The list is walked from its end in batches of as many entries as there are work-items. Each work-item reads one
 * entry, and sets its bit in the words of the cells that its box touches. Then each draws only the entries of its own
 * cell, in the order of the list. Bits mark the entries that change to another brush, layer or group: a work-item
 * that has no entry between two others must still close what has ended. The entries of a batch are all segments, or all
 * edges of one brush, which area_gpu.cl adds up. Work-items tell each other only sums of integers and sets of bits,
 * which do not depend on their order, so the bytes are those of the twin. */
#include "spill_cell.cl"

#if CAMBER_SHARES_TILE
#include "spill_gpu.cl"

#define BATCH_WORDS (CAMBER_TILE_ITEMS / 32u)

/* How often the brush, the layer and the group have changed along the list. */
typedef struct list_changes {
    camber_u32 brush, layer, group;
} list_changes;

/* The batch that work-items share; entries are numbered from the end of the list. */
typedef struct tile_batch {
    camber_u32 segments[CAMBER_TILE_ITEMS], brushes[CAMBER_TILE_ITEMS];
    camber_u32 touching[CAMBER_CELLS][BATCH_WORDS]; /* for each cell, the entries whose boxes touch it */
    camber_u32 brush[BATCH_WORDS], layer[BATCH_WORDS], group[BATCH_WORDS]; /* entries that have others than before */
    camber_u32 count;                                                      /* entries */
    camber_u32 is_open;                                                    /* whether entries show in any pixel */
} tile_batch;

/* Returns the brush of an entry if it is an edge or a bunch of them, else CAMBER_NO_EDGE. */
static inline camber_u32 edge_brush(const camber_drawn_tile *d, camber_u32 entry) {
    return camber_brush_of_edge(&d->from, camber_listed(entry));
}

static inline camber_u32 brush_of_entry(const camber_drawn_tile *d, camber_u32 entry) {
    const camber_u32 edge = edge_brush(d, entry);
    return edge != CAMBER_NO_EDGE ? edge : camber_brush_of_segment(&d->from, camber_listed(entry));
}

/* Empties a batch for at most `most` entries. Barriers must be before and after it. */
CAMBER_FN CAMBER_INLINE void begin_batch(local tile_batch *b, camber_u32 item, camber_u32 most) {
    local camber_u32 *words = &b->touching[0][0];
    for (camber_u32 i = item; i < CAMBER_CELLS * BATCH_WORDS; i += CAMBER_TILE_ITEMS)
        words[i] = 0;
    if (item < BATCH_WORDS)
        b->brush[item] = b->layer[item] = b->group[item] = 0;
    if (item == 0) {
        b->count = most;
        b->is_open = 0;
    }
}

/* Notes what an entry changes, and ends the batch before one that is unlike its first. before: the brush of the entry
 * before, ~0 if there is none. A barrier must follow. */
CAMBER_FN CAMBER_INLINE void look_at_entry(local tile_batch *b, const camber_drawn_tile *d, camber_u32 entry,
                                           camber_u32 first, camber_u32 before, camber_u32 item) {
    const camber_u32 brush = brush_of_entry(d, entry), word = item / 32u, bit = 1u << item % 32u;
    if (edge_brush(d, entry) != first)
        atomic_min(&b->count, item);
    if (brush == before)
        return;
    atomic_or(&b->brush[word], bit);
    if (before == ~0u || d->from.brushes[brush].layer != d->from.brushes[before].layer)
        atomic_or(&b->layer[word], bit);
    if (before == ~0u || d->from.brushes[brush].group != d->from.brushes[before].group)
        atomic_or(&b->group[word], bit);
}

/* Returns how many of the first `count` entries are in a set. */
CAMBER_FN CAMBER_INLINE camber_u32 count_until(local const camber_u32 *set, camber_u32 count) {
    camber_u32 found = 0;
    for (camber_u32 i = 0; i < count / 32u; i++)
        found += (camber_u32)popcount(set[i]);
    return count % 32u ? found + (camber_u32)popcount(set[count / 32u] & ((1u << count % 32u) - 1u)) : found;
}

/* Adds the changes by the first `count` entries of the batch. */
CAMBER_FN CAMBER_INLINE void add_changes(local const tile_batch *b, camber_u32 count, list_changes *to) {
    to->brush += count_until(b->brush, count);
    to->layer += count_until(b->layer, count);
    to->group += count_until(b->group, count);
}

/* Notes the cells that a segment may touch. A barrier must follow. */
CAMBER_FN CAMBER_INLINE void note_segment(local tile_batch *b, const camber_drawn_tile *d, camber_u32 entry,
                                          camber_u32 item) {
    const size_t which = camber_listed(entry);
    camber_footprint footprint;
    camber_cell_boxes box;
    camber_footprint_of(d->from.segments + CAMBER_SEGMENT_WORDS * which, &footprint);
    camber_cell_boxes_of(&footprint, d->where, 1, &box);
    b->segments[item] = (camber_u32)which;
    b->brushes[item] = camber_brush_of_segment(&d->from, which);
    for (int row = box.y; row < box.y + box.rows; row++)
        for (int column = box.x; column < box.x + box.columns; column++)
            atomic_or(&b->touching[CAMBER_TILE_CELLS * row + column][item / 32u], 1u << item % 32u);
}

/* Changes to the brush of an entry, unless a work-item has it already. to: the changes of the list until there. A layer
 * or group that has ended is closed, even if one of the same number follows. */
CAMBER_NOINLINE void change_to(camber_tile_state *c, camber_drawn_tile *d, list_changes *seen, const list_changes *to,
                               camber_u32 brush) {
    if (seen->brush == to->brush)
        return;
    if (seen->layer != to->layer && c->now.layer == d->from.brushes[brush].layer)
        c->now.layer = ~0u;
    if (seen->group != to->group && c->now.group == d->from.brushes[brush].group)
        c->now.group = ~0u;
    *seen = *to;
    d->brush = ~0u;
    camber_draw_next_with(c, d, brush);
}

CAMBER_NOINLINE void draw_segment(camber_tile_state *c, const camber_drawn_tile *d, camber_u32 which) {
    camber_drawn_segment t;
    if ((c->done | c->filled) & 1ul)
        return;
    camber_begin_segment(&d->from, c, which, &t);
    camber_draw_cell(c, &t, d->own);
}

/* Draws the batch's segments that touch a cell. before: the changes of the list before the batch. */
CAMBER_FN CAMBER_INLINE void draw_segments(camber_tile_state *c, camber_drawn_tile *d, local const tile_batch *b,
                                           int cell, const list_changes *before, list_changes *seen) {
    for (camber_u32 i = 0; i < BATCH_WORDS; i++)
        for (camber_u32 left = b->touching[cell][i]; left && !camber_tile_is_full(c); left &= left - 1u) {
            const camber_u32 k = 32u * i + (camber_u32)popcount((left - 1u) & ~left);
            if (before->brush + count_until(b->brush, k + 1u) != seen->brush) {
                list_changes to = *before;
                add_changes(b, k + 1u, &to);
                change_to(c, d, seen, &to, b->brushes[k]);
            }
            draw_segment(c, d, b->segments[k]);
        }
}

/* Whether a brush whose edges are all that a slice still has ends: in a later slice there may be more of them. All
 * work-items have that brush then, and the same crossings left. */
static inline int is_ended(const camber_tile_state *c, const camber_drawn_tile *d, const camber_spill_args *slice) {
    return slice->is_last || camber_next_area(&d->left, &c->now) > camber_areas_end(&d->left, slice->is_last);
}

/* Restores what a work-item has drawn in earlier slices. */
static inline void restore_drawn(camber_tile_state *c, camber_drawn_tile *d, const spilled_tile *from,
                                 camber_spill_args slice, camber_u32 item) {
    d->brush = restore_own(c, from, slice, item, d->from.brushes);
    if (d->brush == ~0u)
        return;
#if CAMBER_RASTER_RICH
    camber_tile_use_ext(c, d->from.brush_ext[d->brush]);
#endif
    c->winding += camber_take_winding(&d->left, d->brush);
}

/* Closes what the last slice leaves open, and in other slices a cell that is full, which is then done. */
CAMBER_NOINLINE void end_drawn(camber_tile_state *c, const camber_drawn_tile *d, camber_u32 is_last) {
    const int is_full = camber_tile_is_full(c);
    if (is_last)
        camber_end_area(c, d);
    if (is_last || is_full)
        camber_tile_end(c);
    if (!is_last && is_full) {
        camber_tile_close_brush(c);
        c->done = ~0ul;
    }
}

/* Writes a row of pixels. Above the horizon is the sky. */
CAMBER_NOINLINE void write_row(camber_tile_state *c, int is_sky, global camber_u32 *pixels, camber_target_args s) {
    const float back[4] = {s.r, s.g, s.b, s.a};
    const camber_u32 sky = camber_rgba(s.sky[0], s.sky[1], s.sky[2], s.sky[3]);
    const int has_pixels = camber_tile_has_pixels(c, 0);
    camber_u32 row[CAMBER_CELL_PX];
    for (int x = 0; x < CAMBER_CELL_PX; x++)
        row[x] = is_sky ? sky : has_pixels ? camber_tile_pixels(c, 0, x, back) : camber_bare_pixels(back);
    vstore4((uint4)(row[0], row[1], row[2], row[3]), 0, pixels);
}

kernel __attribute__((reqd_work_group_size(CAMBER_TILE_ITEMS, 1, 1))) void rasterize(
    global const float *restrict segments, global const float *restrict edges, global const camber_u32 *restrict starts,
    global const camber_u32 *restrict lists, global const camber_brush *restrict brushes,
    global const camber_u32 *restrict jobs, global camber_u32 *restrict pixels, const camber_target_args s,
    global float *restrict spill, const camber_spill_args slice, global const float *restrict arc_lengths,
    global const camber_brush_ext *restrict brush_ext, global const float *restrict side_table,
    global const float *restrict planes, global const camber_u32 *restrict crossings,
    global const camber_u32 *restrict ends) {
    local tile_batch batch;
    local shared_edges shared;
    camber_tile_state c;
    global const camber_u32 *job = jobs + CAMBER_JOB_WORDS * get_group_id(0);
    const camber_u32 item = (camber_u32)get_local_id(0), tile = job[0], spilled = job[2];
    const camber_u32 column = tile % s.columns, row = tile / s.columns;
    const int cell = (int)item / CAMBER_CELL_PX, has_areas = s.first_row != ~0u;
    const own_row own = {cell / CAMBER_TILE_CELLS, cell % CAMBER_TILE_CELLS, (int)item % CAMBER_CELL_PX};
    const camber_eye flat = {0.0f, 0.0f, 0.0f, 0.0f}, eye = CAMBER_RASTER_PITCHED ? s.eye : flat;
    const camber_tile_rows where = {s.left + (float)(column * CAMBER_TILE_PX), s.top + (float)(row * CAMBER_TILE_PX), 0,
                                    CAMBER_TILE_CELLS - 1};
    camber_drawn_tile d = {
        {segments, edges, arc_lengths, planes, side_table, brushes, brush_ext, s.first_edge, s.edge_count, eye},
        {crossings, 0, 0, column},
        where,
        ~0u,
        camber_place_of(where, eye, cell)};
    d.own.number = 0;
    d.own.first = CAMBER_CELL_PX * own.row;
    const spilled_tile own_spill =
        spilled_tile_of(spill + (size_t)(spilled & ~CAMBER_JOB_BEGINS) * slice.tile_words, slice);
    edge_run run = {CAMBER_NO_EDGE, lists, 0, 0, own_spill.kept, 0};
    camber_tile_begin(&c, 1, brushes);
    if (has_areas) {
        d.left.first = starts[s.first_row + row] - starts[s.first_row];
        d.left.end = ends[row];
    }
    /* A cell above the horizon is done. */
    if (CAMBER_RASTER_PITCHED && where.top + (float)(CAMBER_CELL_PX * (own.cell_row + 1)) <= s.horizon)
        c.done = ~0ul;
    if (!(spilled & CAMBER_JOB_BEGINS)) {
        restore_drawn(&c, &d, &own_spill, slice, item);
        if (has_areas)
            restore_edges(&shared, &run, &own_spill, item);
    }
    const camber_u32 first = starts[tile], last = starts[tile + 1];
    list_changes changes = {0, 0, 0}, seen = {0, 0, 0};
    camber_u32 end = last;
    /* All barriers are passed in each round, whatever its batch is: PoCL copies what follows a barrier in a branch.
     * After the last entries one more round ends the edges, if there are any. */
    for (int goes_on = end > first || run.brush != CAMBER_NO_EDGE; goes_on;) {
        const camber_u32 most = min(end - first, CAMBER_TILE_ITEMS);
        const camber_u32 brush = most ? edge_brush(&d, lists[end - 1u]) : CAMBER_NO_EDGE;
        barrier(CLK_LOCAL_MEM_FENCE);
        begin_batch(&batch, item, most);
        barrier(CLK_LOCAL_MEM_FENCE);
        if (item < most) {
            const camber_u32 k = end - 1u - item;
            look_at_entry(&batch, &d, lists[k], brush, k + 1u < last ? brush_of_entry(&d, lists[k + 1u]) : d.brush,
                          item);
        }
        if (!camber_tile_is_full(&c))
            atomic_or(&batch.is_open, 1u);
        const int ends_edges = run.brush != CAMBER_NO_EDGE && run.brush != brush && (most || is_ended(&c, &d, &slice));
        if (ends_edges)
            find_own(&c, &shared, own);
        barrier(CLK_LOCAL_MEM_FENCE);
        const camber_u32 count = batch.count;
        const int is_open = batch.is_open != 0u;
        if (ends_edges) {
            draw_inside(&c, &d, &shared, &run, own);
            run.brush = CAMBER_NO_EDGE;
        }
        if (item < count && brush == CAMBER_NO_EDGE)
            note_segment(&batch, &d, lists[end - 1u - item], item);
        barrier(CLK_LOCAL_MEM_FENCE);
        if (brush != CAMBER_NO_EDGE && run.brush == CAMBER_NO_EDGE) {
            list_changes to = changes;
            add_changes(&batch, 1u, &to);
            change_to(&c, &d, &seen, &to, brush);
            begin_edges(&shared, item);
            run.brush = brush;
            run.first = run.end = run.kept_count = 0;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        if (brush == CAMBER_NO_EDGE)
            draw_segments(&c, &d, &batch, cell, &changes, &seen);
        else if (item < count)
            add_edges(&shared, &d, lists[end - 1u - item], brush);
        run.end = brush != CAMBER_NO_EDGE && run.first == run.end ? end : run.end;
        run.first = brush != CAMBER_NO_EDGE ? end - count : run.first;
        add_changes(&batch, count, &changes);
        end -= count;
        goes_on = is_open && most != 0u && (end > first || run.brush != CAMBER_NO_EDGE);
        run.brush = is_open ? run.brush : CAMBER_NO_EDGE;
    }
    if (!slice.is_last && last > first) /* the next slice begins with one brush in all work-items */
        change_to(&c, &d, &seen, &changes, brush_of_entry(&d, lists[first]));
    barrier(CLK_LOCAL_MEM_FENCE);
    camber_draw_areas_above(&c, &d, camber_areas_end(&d.left, slice.is_last));
    end_drawn(&c, &d, slice.is_last);
    if (!slice.is_last) {
        spill_own(&c, &own_spill, slice, item, d.brush);
        if (has_areas)
            spill_edges(&shared, &d, &run, &own_spill, item);
        return;
    }
    const int y = CAMBER_CELL_PX * own.cell_row + own.row, x = CAMBER_CELL_PX * own.cell_column;
    write_row(&c, CAMBER_RASTER_PITCHED && where.top + (float)y < s.horizon,
              pixels + ((size_t)row * CAMBER_TILE_PX + (size_t)y + s.above) * s.stride +
                  (size_t)column * CAMBER_TILE_PX + (size_t)x,
              s);
}

#endif
