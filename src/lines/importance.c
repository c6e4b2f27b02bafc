/* Computes the importance of the points of polylines; camber_network.h says what the numbers mean.
 *
 * Each polyline is treated separately, by the Douglas-Peucker method: a range of points is split at the point that is
 * farthest from the segment between its ends. That point's importance is its distance, but at most the importance of
 * the point that split the surrounding range, so that no point is kept if one that it depends on is dropped. Values are
 * rounded up. Then points with equal coordinates get the largest importance among them. Threads first divide the
 * polylines among themselves, and then the coordinates, by their hashes. */
#include "lines/importance.h"

#include "base/threads.h"
#include "lines/farthest.h"

#include "camber_network.h"

#include <math.h>
#include <string.h>

/* ---- Polylines one by one ---- */

typedef struct range {
    size_t first, last;
    double limit; /* squared importance of the point that split this range off: no point inside has more */
    unsigned depth;
} range;

/* Returns the square root as a float, rounded up, so that a point farther away than the tolerance is never dropped. */
static float round_up(double squared) {
    const double distance = sqrt(squared);
    const float nearest = (float)distance;
    return (double)nearest < distance ? nextafterf(nearest, INFINITY) : nearest;
}

static void weigh_range(const double *points, range whole, float *importance) {
    /* This is a stack instead of a recursion. The larger half waits while the smaller half is split, so that at most
     * log2(count) ranges wait. */
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

/* A ring begins and ends at the same point, so that the segment between its ends has no length. It is split at the
 * point farthest from the seam. The point farthest from the line between these two points is always kept as well, so
 * that an area remains an area, however small it is. */
static void weigh_ring(const double *points, size_t first, size_t last, float *importance) {
    double largest, before, after;
    const size_t far = camber_farthest(points, first, last, &largest);
    if (far == first) { /* all points have the same position */
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

/* Nodes are looked up in several rounds, each for a part of all hashes, so that the table stays this small however many
 * points there are. Each share costs one more pass over the points. */
static const size_t MOST_SLOTS = (size_t)1 << 24;
enum { BATCH = 64 };

typedef struct repeat {
    uint32_t node, point; /* the first point of a node, and a later one at the same position */
} repeat;

/* A hash table with open addressing, from coordinates to the first point that has them; and the repeated points found
 * so far. */
typedef struct node_table {
    uint32_t *slots; /* point + 1, or 0 for a free slot. Their number is a power of two; about half are in use */
    size_t slot_count, used;
    repeat *repeats;
    size_t repeat_count, repeat_capacity;
} node_table;

/* Returns the first point with these coordinates. If it is the point itself, the table remembers it. */
static size_t find_node(node_table *table, const double *points, size_t point, uint64_t hash) {
    size_t slot = (size_t)hash & (table->slot_count - 1);
    for (; table->slots[slot]; slot = (slot + 1) & (table->slot_count - 1)) {
        const size_t other = table->slots[slot] - 1;
        if (memcmp(points + 2 * other, points + 2 * point, 2 * sizeof *points) == 0)
            return other;
    }
    table->slots[slot] = (uint32_t)point + 1;
    table->used++;
    return point;
}

/* If the table fills up, because its share has more hashes than others, it is rebuilt twice as large. */
static bool grow_table(camber_context *context, node_table *table, const double *points) {
    if (table->used + BATCH < table->slot_count / 4 * 3)
        return true;
    uint32_t *old = table->slots;
    const size_t old_count = table->slot_count;
    uint32_t *slots = camber_alloc_zero(context, 2 * old_count, sizeof *slots);
    if (!slots)
        return false;
    *table = (node_table){slots, 2 * old_count, 0, table->repeats, table->repeat_count, table->repeat_capacity};
    for (size_t i = 0; i < old_count; i++)
        if (old[i])
            (void)find_node(table, points, old[i] - 1, camber_mix_point(0, points + 2 * (size_t)(old[i] - 1)));
    camber_free(context, old);
    return true;
}

/* One of several parts of all hashes. Their number is a power of two. */
typedef struct node_share {
    size_t number, count;
} node_share;

/* Whether a hash belongs to the share. The table itself uses the low bits. */
static bool is_of_share(uint64_t hash, node_share share) {
    return ((size_t)(hash >> 40) & (share.count - 1)) == share.number;
}

/* Points of a share that are looked up together: their slots are scattered over the table, so that memory can fetch
 * them all at the same time. */
typedef struct node_batch {
    uint32_t points[BATCH];
    uint64_t hashes[BATCH];
    size_t count;
} node_batch;

static inline void fetch(const void *at) {
#if defined(__GNUC__)
    __builtin_prefetch(at);
#else
    (void)at;
#endif
}

/* Looks up a batch; the first point of each node collects the largest importance. */
static camber_status look_up(camber_context *context, const double *points, node_batch *batch, node_table *table,
                             float *importance) {
    if (!grow_table(context, table, points) || !camber_grow(context, &table->repeats, &table->repeat_capacity,
                                                            table->repeat_count + BATCH, sizeof *table->repeats))
        return CAMBER_ERROR_MEMORY;
    for (size_t k = 0; k < batch->count; k++)
        fetch(table->slots + ((size_t)batch->hashes[k] & (table->slot_count - 1)));
    for (size_t k = 0; k < batch->count; k++) {
        const uint32_t slot = table->slots[(size_t)batch->hashes[k] & (table->slot_count - 1)];
        if (slot)
            fetch(points + 2 * (size_t)(slot - 1));
    }
    for (size_t k = 0; k < batch->count; k++) {
        const size_t point = batch->points[k], node = find_node(table, points, point, batch->hashes[k]);
        if (node == point)
            continue;
        table->repeats[table->repeat_count++] = (repeat){(uint32_t)node, (uint32_t)point};
        importance[node] = fmaxf(importance[node], importance[point]);
    }
    batch->count = 0;
    return CAMBER_OK;
}

static camber_status share_some(camber_context *context, const double *points, size_t count, node_share share,
                                node_table *table, float *importance) {
    node_batch batch = {.count = 0};
    camber_status status = CAMBER_OK;
    table->repeat_count = table->used = 0;
    memset(table->slots, 0, table->slot_count * sizeof *table->slots);
    for (size_t i = 0; i < count && status == CAMBER_OK; i++) {
        const uint64_t hash = camber_mix_point(0, points + 2 * i);
        batch.points[batch.count] = (uint32_t)i;
        batch.hashes[batch.count] = hash;
        batch.count += is_of_share(hash, share);
        if (batch.count == BATCH)
            status = look_up(context, points, &batch, table, importance);
    }
    if (status == CAMBER_OK)
        status = look_up(context, points, &batch, table, importance);
    for (size_t i = 0; i < table->repeat_count && status == CAMBER_OK; i++)
        importance[table->repeats[i].point] = importance[table->repeats[i].node];
    return status;
}

/* ---- Threads ---- */

/* With fewer points, starting a thread takes longer than it saves. */
static const size_t FEW_POINTS = (size_t)1 << 15;
/* Each thread looks at all points to find those of its shares, so more threads save nothing. */
enum { MOST_SHARERS = 4 };

typedef struct weighing {
    camber_context *context;
    const camber_importance_desc *desc;
    size_t thread_count, point_count;
    size_t sharer_count, share_count, slot_count; /* of each share's table */
    camber_status statuses[MOST_SHARERS];
} weighing;

/* Returns the first polyline that begins at a point or after it. */
static size_t first_polyline_at(const camber_importance_desc *desc, size_t point) {
    size_t low = 0, high = desc->polyline_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (desc->offsets[middle] < point)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Weighs the polylines that begin in a thread's part of the points. */
static void weigh_part(void *user, size_t number) {
    const weighing *w = user;
    const camber_importance_desc *desc = w->desc;
    const size_t first = desc->offsets[0], part = w->point_count / w->thread_count;
    size_t i = number ? first_polyline_at(desc, first + number * part) : 0;
    const size_t end =
        number + 1 < w->thread_count ? first_polyline_at(desc, first + (number + 1) * part) : desc->polyline_count;
    for (; i < end; i++)
        weigh_polyline(desc->points, desc->offsets[i], desc->offsets[i + 1], desc->importance);
}

/* Gives all points of the nodes of a thread's shares the largest importance among them. */
static void share_part(void *user, size_t number) {
    weighing *w = user;
    const size_t first = w->desc->offsets[0];
    node_table table = {.slot_count = w->slot_count};
    camber_status status = CAMBER_OK;
    if (!(table.slots = camber_alloc(w->context, table.slot_count, sizeof *table.slots)))
        status = CAMBER_ERROR_MEMORY;
    for (size_t share = number; share < w->share_count && status == CAMBER_OK; share += w->sharer_count)
        status = share_some(w->context, w->desc->points + 2 * first, w->point_count,
                            (node_share){share, w->share_count}, &table, w->desc->importance + first);
    camber_free(w->context, table.repeats);
    camber_free(w->context, table.slots);
    w->statuses[number] = status;
}

static camber_status share_nodes(weighing *w) {
    const size_t count = w->point_count;
    if (count >= (size_t)1 << 31)
        return camber_fail(w->context, CAMBER_ERROR_LIMIT, "%zu points are more than the limit of 2^31; read fewer",
                           count);
    w->sharer_count = w->thread_count >= 4 ? 4 : w->thread_count >= 2 ? 2 : 1;
    w->slot_count = 4 * BATCH;
    w->share_count = w->sharer_count;
    while (w->slot_count < MOST_SLOTS / w->sharer_count && w->share_count * w->slot_count < 2 * count)
        w->slot_count *= 2;
    while (w->share_count * w->slot_count < 2 * count)
        w->share_count *= 2;
    camber_threads_run(w->sharer_count, share_part, w);
    for (size_t i = 0; i < w->sharer_count; i++)
        if (w->statuses[i] != CAMBER_OK)
            return w->statuses[i];
    return CAMBER_OK;
}

camber_status camber_importance_weigh_by(camber_context *context, const camber_importance_desc *desc) {
    if (desc->polyline_count == 0)
        return CAMBER_OK;
    for (size_t i = 0; i < desc->polyline_count; i++)
        if (desc->offsets[i + 1] < desc->offsets[i])
            return camber_fail(context, CAMBER_ERROR_INPUT,
                               "importance: offset %zu is %zu, and the one before it is %zu; they must ascend", i + 1,
                               desc->offsets[i + 1], desc->offsets[i]);
    weighing w = {
        .context = context, .desc = desc, .point_count = desc->offsets[desc->polyline_count] - desc->offsets[0]};
    w.thread_count = w.point_count < FEW_POINTS ? 1 : desc->threads;
    camber_threads_run(w.thread_count, weigh_part, &w);
    return share_nodes(&w);
}

camber_status camber_importance_weigh(camber_context *context, const double *points, const size_t *offsets,
                                      size_t polyline_count, float *importance) {
    const camber_importance_desc desc = {points, offsets, polyline_count, importance, 1};
    return camber_importance_weigh_by(context, &desc);
}
