/* The CPU twin of cull_count and cull_emit: projects a network on the host, and returns the visible lines as polylines.
 *
 * Input: a network, a camera, strokes. Output: camber_polylines with the slots that the device would make; or lines of
 * points in px. Main idea: it runs the kernels' own walk (kernels/cull.h), but entry by entry instead of chunk by
 * chunk, since slots do not depend on how points are divided into chunks. */
#include "points/network.h"
#include "points/rows.h"

#include <string.h>

camber_walk camber_network_walk(const camber_network *network) {
    return (camber_walk){.x = network->x,
                         .y = network->y,
                         .importance = network->importance,
                         .lengths = network->lengths,
                         .totals = network->totals,
                         .stretches = network->stretches};
}

/* Finds the stretch that contains a point. */
static const camber_stretch *find_stretch(const camber_network *network, size_t point) {
    size_t low = 0, high = network->stretch_count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (network->stretches[middle].first <= point)
            low = middle;
        else
            high = middle;
    }
    return network->stretches + low;
}

uint64_t camber_network_count_slots(const camber_network *network, const camber_projection *projection, size_t begin,
                                    size_t end) {
    /* The walk counts in 32 bits, so it gets this many points at a time. */
    static const size_t POINTS_AT_ONCE = (size_t)1 << 28;
    camber_projection p = *projection;
    uint64_t count = 0;
    p.first_point = 0;
    while (begin < end) {
        const size_t until = end - begin > POINTS_AT_ONCE ? begin + POINTS_AT_ONCE : end;
        camber_walk w = camber_network_walk(network);
        camber_walk_chunk(&w, &p, find_stretch(network, begin), (uint32_t)begin, (uint32_t)until);
        count += w.at;
        begin = until;
    }
    return count;
}

static camber_status check_strokes(const camber_network *network, const camber_tessellation_desc *desc) {
    camber_row *rows = NULL;
    const camber_status status = camber_rows_create(network->context, network->row_count, desc, &rows);
    camber_free(network->context, rows);
    return status;
}

/* Fills the stats from the slots. */
static void count_slots(camber_polylines *p) {
    for (size_t i = 1; i <= p->slot_count; i++) {
        const uint32_t info = p->info[i], ends = info & (CAMBER_POINT_FIRST | CAMBER_POINT_LAST);
        p->stats.kept_points += info & CAMBER_POINT_REAL;
        p->stats.kept_segments += (info & CAMBER_POINT_REAL) && !(info & CAMBER_POINT_FIRST);
        p->stats.dots += ends == (CAMBER_POINT_FIRST | CAMBER_POINT_LAST);
        p->stats.rings += (info & CAMBER_POINT_FIRST) && (info & CAMBER_POINT_RING);
    }
}

/* Makes `count` slots, padded to whole blocks, and the array that says where each entry begins. */
static camber_status make_slots(const camber_network *network, const camber_projection *projection, size_t count,
                                camber_polylines *p) {
    camber_context *context = network->context;
    const size_t slots = (count + CAMBER_BLOCK - 1) / CAMBER_BLOCK * CAMBER_BLOCK;
    if (!(p->x = camber_alloc_zero(context, slots + 2, sizeof *p->x)) ||
        !(p->y = camber_alloc_zero(context, slots + 2, sizeof *p->y)) ||
        !(p->info = camber_alloc_zero(context, slots + 2, sizeof *p->info)) ||
        (network->lengths && !(p->arc_lengths = camber_alloc_zero(context, slots, sizeof *p->arc_lengths))) ||
        !(p->first_slots = camber_alloc(context, network->entry_count + 1, sizeof *p->first_slots)) ||
        !(p->polyline_rows = camber_alloc(context, network->entry_count, sizeof *p->polyline_rows)))
        return CAMBER_ERROR_MEMORY;
    camber_walk w = camber_network_walk(network);
    w.slot_x = p->x;
    w.slot_y = p->y;
    w.slot_info = p->info;
    w.slot_arc_lengths = (float *)p->arc_lengths;
    w.puts = 1;
    w.at = 1;
    for (size_t i = 0; i < network->entry_count; i++) {
        const size_t begin = camber_network_first_point(network, i), end = camber_network_first_point(network, i + 1);
        p->first_slots[i] = w.at - 1;
        p->polyline_rows[i] = network->entry_rows[i];
        if (begin < end)
            camber_walk_chunk(&w, projection, network->stretches + network->entry_stretches[i], (uint32_t)begin,
                              (uint32_t)end);
    }
    p->first_slots[network->entry_count] = w.at - 1;
    p->slot_count = slots;
    return CAMBER_OK;
}

camber_status camber_network_project(const camber_network *network, const camber_camera *camera,
                                     const camber_tessellation_desc *desc, camber_polylines **polylines) {
    camber_context *context = network->context;
    camber_projection projection;
    camber_status status = check_strokes(network, desc);
    if (status == CAMBER_OK)
        status = camber_network_aim(network, camera, desc, &projection);
    if (status != CAMBER_OK)
        return status;
    const uint64_t count = camber_network_count_slots(network, &projection, 0, network->point_count);
    if (count > UINT32_MAX - 1024u)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "%llu points are more than 32-bit slots hold; draw a smaller part or simplify more",
                           (unsigned long long)count);
    camber_polylines *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->serial = context->next_serial++;
    made->polyline_count = made->stats.polylines = network->entry_count;
    made->row_count = network->row_count;
    made->stats.points = network->stats.points;
    status = make_slots(network, &projection, (size_t)count, made);
    if (status != CAMBER_OK) {
        camber_polylines_destroy(made);
        return status;
    }
    count_slots(made);
    *polylines = made;
    return CAMBER_OK;
}

/* ---- Visible lines ---- */

/* Lines made from slots. entries[i] is the entry that line i belongs to. */
typedef struct visible_lines {
    const camber_polylines *slots;
    camber_lines lines;
} visible_lines;

static void append_slot(visible_lines *p, size_t slot) {
    p->lines.points[2 * p->lines.point_count] = p->slots->x[slot + 1];
    p->lines.points[2 * p->lines.point_count + 1] = p->slots->y[slot + 1];
    p->lines.point_count++;
}

/* Begins another line of an entry. */
static void begin_line(visible_lines *p, size_t entry) {
    p->lines.entries[p->lines.polyline_count] = (uint32_t)entry;
    p->lines.offsets[p->lines.polyline_count++] = (uint32_t)p->lines.point_count;
}

/* Returns the last slot of the line that begins at slot first. */
static size_t last_of(const visible_lines *p, size_t first) {
    while (!(p->slots->info[first + 1] & CAMBER_POINT_LAST))
        first++;
    return first;
}

/* Appends the visible lines of an entry. If the window cuts a ring, the line across the ring's seam consists of two
 * halves, and its end is first in the slots. The end waits at `seam` until the beginning has been appended:
 *
 *     slots     S..e   b..S              S: the seam, the ring's first and last point
 *     line      b..S..e                  from b, where the window cuts, across the seam to e */
static void append_entry(visible_lines *p, size_t entry) {
    const uint32_t *info = p->slots->info + 1;
    size_t seam = SIZE_MAX, seam_end = 0;
    for (size_t i = p->slots->first_slots[entry]; i < p->slots->first_slots[entry + 1]; i++) {
        if (!(info[i] & CAMBER_POINT_FIRST))
            continue;
        const size_t first = i;
        i = last_of(p, i);
        if ((info[first] & CAMBER_POINT_RING) && !(info[i] & CAMBER_POINT_RING)) {
            seam = first;
            seam_end = i;
            continue;
        }
        begin_line(p, entry);
        for (size_t k = first; k <= i; k++)
            append_slot(p, k);
        if (seam == SIZE_MAX || !(info[i] & CAMBER_POINT_RING))
            continue;
        for (size_t k = seam + 1; k <= seam_end; k++)
            append_slot(p, k);
        seam = SIZE_MAX;
    }
}

camber_status camber_network_project_lines(const camber_network *network, const camber_camera *camera,
                                           const camber_tessellation_desc *desc, camber_lines *lines) {
    camber_context *context = network->context;
    camber_polylines *slots = NULL;
    camber_status status = camber_network_project(network, camera, desc, &slots);
    if (status != CAMBER_OK || !slots)
        return status;
    size_t count = 0;
    for (size_t i = 0; i < slots->slot_count; i++)
        count += (slots->info[i + 1] & CAMBER_POINT_FIRST) != 0;
    visible_lines p = {.slots = slots, .lines = {.context = context}};
    status = CAMBER_ERROR_MEMORY;
    if ((p.lines.points = camber_alloc(context, slots->stats.kept_points, 2 * sizeof *p.lines.points)) &&
        (p.lines.offsets = camber_alloc(context, count + 1, sizeof *p.lines.offsets)) &&
        (p.lines.entries = camber_alloc(context, count, sizeof *p.lines.entries))) {
        for (size_t i = 0; i < network->entry_count; i++)
            append_entry(&p, i);
        p.lines.offsets[p.lines.polyline_count] = (uint32_t)p.lines.point_count;
        status = CAMBER_OK;
        *lines = p.lines;
    } else {
        camber_lines_destroy(&p.lines);
    }
    camber_polylines_destroy(slots);
    return status;
}
