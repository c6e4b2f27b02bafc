#include "lines/importance.h"

#include "lines/farthest.h"

#include <math.h>
#include <string.h>

/* ---- Polylines one by one ---- */

typedef struct range {
    size_t first, last;
    double limit; /* squared; what lies between goes when what split the range off goes */
    unsigned depth;
} range;

/* Never below the distance, so that a point farther than the tolerance is never dropped. */
static float round_up(double squared) {
    const double distance = sqrt(squared);
    const float nearest = (float)distance;
    return (double)nearest < distance ? nextafterf(nearest, INFINITY) : nearest;
}

static void weigh_range(const double *points, range whole, float *importance) {
    /* The larger half waits, the smaller is split on: no more than log2(count) ranges wait. */
    range waiting[64];
    size_t count = 0;
    range now = whole;
    for (;;) {
        double largest = 0.0;
        size_t at = camber_farthest(points, now.first, now.last, &largest);
        if (largest == 0.0) {
            for (size_t i = now.first + 1; i < now.last; i++)
                importance[i] = 0.0f;
            if (count == 0)
                return;
            now = waiting[--count];
            continue;
        }
        largest = largest < now.limit ? largest : now.limit;
        if (now.depth >= CAMBER_FARTHEST_SPLITS)
            at = now.first + (now.last - now.first) / 2;
        importance[at] = round_up(largest);
        const range a = {now.first, at, largest, now.depth + 1}, b = {at, now.last, largest, now.depth + 1};
        const bool a_larger = at - now.first > now.last - at;
        waiting[count++] = a_larger ? a : b;
        now = a_larger ? b : a;
    }
}

/* A ring's own base line has no length: it is split at the point farthest from the seam, and the point farthest from
 * that line stays too, so that an area stays one however small. */
static void weigh_ring(const double *points, size_t first, size_t last, float *importance) {
    double largest, before, after;
    const size_t far = camber_farthest(points, first, last, &largest);
    if (far == first) { /* all points are one */
        weigh_range(points, (range){first, last, INFINITY, 0}, importance);
        return;
    }
    weigh_range(points, (range){first, far, INFINITY, 0}, importance);
    weigh_range(points, (range){far, last, INFINITY, 0}, importance);
    importance[far] = INFINITY;
    const size_t a = camber_farthest(points, first, far, &before), b = camber_farthest(points, far, last, &after);
    if (before > 0.0 || after > 0.0)
        importance[before >= after ? a : b] = INFINITY;
}

static void weigh_polyline(const double *points, size_t first, size_t end, float *importance) {
    if (first == end)
        return;
    const size_t last = end - 1;
    const double *p = points + 2 * first, *q = points + 2 * last;
    if (last - first > 2 && p[0] == q[0] && p[1] == q[1])
        weigh_ring(points, first, last, importance);
    else
        weigh_range(points, (range){first, last, INFINITY, 0}, importance);
    importance[first] = importance[last] = INFINITY;
}

/* ---- Shared nodes ---- */

typedef struct repeat {
    uint32_t node, point; /* the first point of a node, and a later one */
} repeat;

typedef struct node_table {
    uint32_t *slots; /* point + 1; 0: free. A power of two of them, at most half in use */
    size_t slot_count;
    repeat *repeats;
    size_t repeat_count, repeat_capacity;
} node_table;

/* The first of the points equal to this one; itself where it is that. */
static size_t find_node(node_table *table, const double *points, size_t point) {
    size_t slot = (size_t)camber_mix_point(0, points + 2 * point) & (table->slot_count - 1);
    for (; table->slots[slot]; slot = (slot + 1) & (table->slot_count - 1)) {
        const size_t other = table->slots[slot] - 1;
        if (memcmp(points + 2 * other, points + 2 * point, 2 * sizeof *points) == 0)
            return other;
    }
    table->slots[slot] = (uint32_t)point + 1;
    return point;
}

static camber_status share_nodes(camber_context *context, const double *points, size_t count, float *importance) {
    if (count >= (size_t)1 << 31)
        return camber_fail(context, CAMBER_ERROR_LIMIT, "%zu points at once are more than 2^31; read fewer", count);
    node_table table = {.slot_count = 16};
    while (table.slot_count < 2 * count)
        table.slot_count *= 2;
    camber_status status = CAMBER_ERROR_MEMORY;
    if (!(table.slots = camber_alloc_zero(context, table.slot_count, sizeof *table.slots)))
        return status;
    for (size_t i = 0; i < count; i++) {
        const size_t node = find_node(&table, points, i);
        if (node == i)
            continue;
        if (!camber_grow(context, &table.repeats, &table.repeat_capacity, table.repeat_count + 1,
                         sizeof *table.repeats))
            goto done;
        table.repeats[table.repeat_count++] = (repeat){(uint32_t)node, (uint32_t)i};
        importance[node] = fmaxf(importance[node], importance[i]);
    }
    for (size_t i = 0; i < table.repeat_count; i++)
        importance[table.repeats[i].point] = importance[table.repeats[i].node];
    status = CAMBER_OK;
done:
    camber_free(context, table.repeats);
    camber_free(context, table.slots);
    return status;
}

camber_status camber_importance_weigh(camber_context *context, const double *points, const size_t *offsets,
                                      size_t polyline_count, float *importance) {
    if (polyline_count == 0)
        return CAMBER_OK;
    for (size_t i = 0; i < polyline_count; i++)
        weigh_polyline(points, offsets[i], offsets[i + 1], importance);
    const size_t first = offsets[0];
    return share_nodes(context, points + 2 * first, offsets[polyline_count] - first, importance + first);
}
