/* Walks outwards from the lines that touch a region.
 *
 * Input: lines, some of which touch the region, and later the lines that the frontier asked for. Output: the points
 * whose lines the frontier asks for. The main idea is to rank lines:
 *
 *     rank 0    touches the region, or is merged with a line that does, so it is drawn. If a part of an area is in the
 *               region, all its rings have this rank
 *     rank 1    shares a point with a line of rank 0, or is merged with such a line: it affects the importance of
 *               points of the line of rank 0
 *     others    were read along with these, and have no influence
 *
 * At every point of a line of rank 0, all lines must be known, because they affect the importance of the point. At the
 * ends of a line of rank 1, they must be known because they decide how the line is merged. At points inside the region
 * they are known already, so lines that are wholly inside need nothing more. merge.c defines when lines are merged: if
 * exactly two ends of a class meet. */
#include "features/frontier.h"

static const uint32_t NONE = UINT32_MAX;

typedef struct frontier_point {
    size_t point;   /* index into the set's points */
    uint32_t line;  /* index into the frontier's lines */
    uint32_t next;  /* another point at the same node */
    uint32_t first; /* the first point at the node; it has the node's state */
    bool end;       /* an end of a line that may be merged */
    bool known;     /* state of the node: its lines were asked for */
} frontier_point;

/* A line that has points outside the region. */
typedef struct frontier_line {
    uint32_t class_index;
    uint32_t first_point, point_count;
    uint8_t rank;
    bool waits; /* the line is in the queue */
} frontier_line;

struct camber_frontier {
    camber_context *context;
    camber_features *features;
    bool merges;
    size_t taken;    /* how many polylines of the set were examined */
    size_t area_end; /* the polyline after the rings of the area that was examined last */
    bool area_touches;
    frontier_line *lines;
    size_t line_count, line_capacity;
    frontier_point *points;
    size_t point_count, point_capacity;
    uint32_t *slots; /* a hash table of nodes: the index of a node's first point + 1. Its size is a power of two, and at
                        most half are in use */
    size_t slot_count;
    uint32_t *queue; /* a ring buffer of line_capacity entries */
    size_t queue_capacity, queued, queue_head;
    double *asked;
    size_t asked_count, asked_capacity;
};

camber_status camber_frontier_create(camber_features *features, size_t first_polyline, bool merges,
                                     camber_frontier **frontier) {
    camber_frontier *made = camber_alloc_zero(features->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    *made = (camber_frontier){.context = features->context,
                              .features = features,
                              .merges = merges,
                              .taken = first_polyline,
                              .slot_count = 1024};
    if (!(made->slots = camber_alloc_zero(made->context, made->slot_count, sizeof *made->slots))) {
        camber_frontier_destroy(made);
        return CAMBER_ERROR_MEMORY;
    }
    *frontier = made;
    return CAMBER_OK;
}

void camber_frontier_destroy(camber_frontier *frontier) {
    if (!frontier)
        return;
    camber_context *context = frontier->context;
    camber_free(context, frontier->asked);
    camber_free(context, frontier->queue);
    camber_free(context, frontier->slots);
    camber_free(context, frontier->points);
    camber_free(context, frontier->lines);
    camber_free(context, frontier);
}

/* ---- Nodes ---- */

static const double *place_of(const camber_frontier *f, uint32_t point) {
    return f->features->points + 2 * f->points[point].point;
}

/* Returns the slot of the node at a place, or a free slot. */
static size_t find_slot(const camber_frontier *f, const double *place) {
    size_t slot = (size_t)camber_mix_point(0, place) & (f->slot_count - 1);
    while (f->slots[slot] && memcmp(place_of(f, f->slots[slot] - 1), place, 2 * sizeof *place) != 0)
        slot = (slot + 1) & (f->slot_count - 1);
    return slot;
}

static bool grow_slots(camber_frontier *f) {
    if (2 * f->point_count < f->slot_count)
        return true;
    const size_t count = 4 * f->slot_count;
    uint32_t *slots = camber_alloc_zero(f->context, count, sizeof *slots);
    if (!slots)
        return false;
    camber_free(f->context, f->slots);
    f->slots = slots;
    f->slot_count = count;
    for (uint32_t i = 0; i < f->point_count; i++)
        if (f->points[i].first == i)
            f->slots[find_slot(f, place_of(f, i))] = i + 1;
    return true;
}

static bool add_point(camber_frontier *f, size_t point, bool end) {
    if (!camber_grow(f->context, &f->points, &f->point_capacity, f->point_count + 1, sizeof *f->points) ||
        !grow_slots(f))
        return false;
    const uint32_t index = (uint32_t)f->point_count++;
    f->points[index] =
        (frontier_point){.point = point, .line = (uint32_t)f->line_count - 1, .next = NONE, .first = index, .end = end};
    uint32_t *slot = &f->slots[find_slot(f, place_of(f, index))];
    if (*slot == 0) {
        *slot = index + 1;
        return true;
    }
    frontier_point *first = &f->points[*slot - 1];
    f->points[index].first = *slot - 1;
    f->points[index].next = first->next;
    first->next = index;
    return true;
}

/* ---- Lines ---- */

/* If all points of a line are equal, it is a dot, which has no ends. */
static bool has_ends(const camber_features *features, size_t polyline, uint32_t class_index) {
    const size_t begin = features->offsets[polyline], end = features->offsets[polyline + 1];
    if (camber_geometry_shape(features->classes[class_index].geometry) != CAMBER_GEOMETRY_LINE)
        return false;
    for (size_t i = begin + 1; i < end; i++)
        if (memcmp(features->points + 2 * begin, features->points + 2 * i, 2 * sizeof *features->points) != 0)
            return true;
    return false;
}

/* Whether the line touches the region, or, if it is a ring, whether its area does. */
static bool touches(camber_frontier *f, size_t polyline) {
    const camber_features *features = f->features;
    size_t next;
    if (!camber_geometry_is_area(camber_features_kind(features, polyline)))
        return camber_features_touch(features, &features->region, polyline, &next);
    if (polyline < f->area_end)
        return f->area_touches;
    while (polyline > 0 && features->polyline_feature[polyline - 1] == features->polyline_feature[polyline])
        polyline--;
    f->area_touches = camber_features_touch(features, &features->region, polyline, &f->area_end);
    return f->area_touches;
}

static bool take_line(camber_frontier *f, size_t polyline) {
    const camber_features *features = f->features;
    const camber_region *region = &features->region;
    const size_t begin = features->offsets[polyline], end = features->offsets[polyline + 1];
    size_t inside = 0;
    for (size_t i = begin; i < end; i++)
        inside += camber_region_has_point(region, features->points + 2 * i);
    if (inside == end - begin)
        return true;
    if (!camber_grow(f->context, &f->lines, &f->line_capacity, f->line_count + 1, sizeof *f->lines))
        return false;
    const uint32_t class_index = features->feature_class[features->polyline_feature[polyline]];
    f->lines[f->line_count++] = (frontier_line){
        .class_index = class_index, .first_point = (uint32_t)f->point_count, .rank = touches(f, polyline) ? 0 : 2};
    const bool ends = has_ends(features, polyline, class_index);
    for (size_t i = begin; i < end; i++)
        if (!camber_region_has_point(region, features->points + 2 * i) &&
            !add_point(f, i, ends && (i == begin || i == end - 1)))
            return false;
    frontier_line *line = &f->lines[f->line_count - 1];
    line->point_count = (uint32_t)f->point_count - line->first_point;
    return true;
}

/* ---- Ranks ---- */

static void push(camber_frontier *f, uint32_t line) {
    if (f->lines[line].waits)
        return;
    f->lines[line].waits = true;
    f->queue[(f->queue_head + f->queued++) % f->queue_capacity] = line;
}

static void lower(camber_frontier *f, uint32_t line, uint8_t rank) {
    if (f->lines[line].rank <= rank)
        return;
    f->lines[line].rank = rank;
    push(f, line);
}

/* Returns the line that is merged with this one at its end. NONE: no other end meets it, or several do. */
static uint32_t find_partner(const camber_frontier *f, uint32_t end) {
    const uint32_t line = f->points[end].line;
    uint32_t partner = NONE, count = 0;
    for (uint32_t p = f->points[end].first; p != NONE; p = f->points[p].next) {
        if (!f->points[p].end || p == end || f->lines[f->points[p].line].class_index != f->lines[line].class_index)
            continue;
        partner = f->points[p].line;
        count++;
    }
    return count == 1 ? partner : NONE;
}

/* Ranks the lines that are merged or share points with a line. */
static void spread(camber_frontier *f, uint32_t line) {
    const frontier_line self = f->lines[line];
    for (uint32_t p = self.first_point; p < self.first_point + self.point_count; p++) {
        const uint32_t first = f->points[p].first;
        for (uint32_t other = first; self.rank == 0 && other != NONE; other = f->points[other].next)
            lower(f, f->points[other].line, 1);
        if (!f->merges || !f->points[p].end || !f->points[first].known)
            continue;
        const uint32_t partner = find_partner(f, p);
        if (partner != NONE)
            lower(f, partner, self.rank);
    }
}

static bool rank_lines(camber_frontier *f) {
    if (!camber_grow(f->context, &f->queue, &f->queue_capacity, f->line_count, sizeof *f->queue))
        return false;
    f->queue_head = f->queued = 0;
    for (uint32_t i = 0; i < f->line_count; i++)
        if (f->lines[i].rank < 2)
            push(f, i);
    while (f->queued) {
        const uint32_t line = f->queue[f->queue_head];
        f->queue_head = (f->queue_head + 1) % f->queue_capacity;
        f->queued--;
        f->lines[line].waits = false;
        spread(f, line);
    }
    return true;
}

/* ---- Asking ---- */

static bool ask_at(camber_frontier *f, uint32_t point) {
    frontier_point *node = &f->points[f->points[point].first];
    if (node->known)
        return true;
    node->known = true;
    if (!camber_grow(f->context, &f->asked, &f->asked_capacity, f->asked_count + 1, 2 * sizeof *f->asked))
        return false;
    memcpy(f->asked + 2 * f->asked_count++, place_of(f, point), 2 * sizeof *f->asked);
    return true;
}

camber_status camber_frontier_ask(camber_frontier *frontier, const double **points, size_t *count) {
    camber_frontier *f = frontier;
    for (; f->taken < f->features->polyline_count; f->taken++)
        if (!take_line(f, f->taken))
            return CAMBER_ERROR_MEMORY;
    if (!rank_lines(f))
        return CAMBER_ERROR_MEMORY;
    f->asked_count = 0;
    for (size_t i = 0; i < f->line_count; i++) {
        const frontier_line *line = &f->lines[i];
        for (uint32_t p = line->first_point; p < line->first_point + line->point_count; p++) {
            const bool needed = line->rank == 0 || (line->rank == 1 && f->merges && f->points[p].end);
            if (needed && !ask_at(f, p))
                return CAMBER_ERROR_MEMORY;
        }
    }
    *points = f->asked;
    *count = f->asked_count;
    return CAMBER_OK;
}

bool camber_frontier_wants(const camber_frontier *frontier, const double *points, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const uint32_t slot = frontier->slots[find_slot(frontier, points + 2 * i)];
        if (slot && frontier->points[slot - 1].known)
            return true;
    }
    return false;
}
