/* Finds which ends of lines are round, in layers that tuck the ends of their lines.
 *
 * Input: a set whose lines are merged. Output: dots, in classes of their own, for the ends that are round; in such
 * layers the lines themselves end flat. The main idea: the style ranks the lines in the order in which they are drawn.
 * An end is flat if the line goes on as lines that are below it, because a round end would lie on these:
 *
 *      ________                        ________                          ________
 *              |------   below                 |  above                          ) nothing, or an equal line that
 *      ________|------   it: flat      ________|)------  it: round       ________) also ends here: round
 *
 * No dot is needed where a line passes that is as high or higher, because it covers the end. */
#include "base/maths.h"
#include "features/features.h"

#include <string.h>

#define NONE UINT32_MAX

/* A point at which lines end. */
typedef struct end_node {
    double at[2];
    double top;      /* the highest rank of the lines that touch it */
    uint8_t touches; /* by lines of any rank, counted up to 2 */
    uint8_t at_top;  /* by lines of the highest rank, counted up to 2 */
    bool passes;     /* a line of the highest rank does not end here */
} end_node;

typedef struct end_dot {
    uint32_t node;
    uint32_t class_index; /* of the line */
} end_dot;

typedef struct finder {
    camber_features *features;
    size_t first_polyline, polyline_end;
    double *ranks;       /* by class */
    uint32_t *dot_class; /* by class: the class of its dots; NONE: not known yet */
    end_node *nodes;
    uint32_t *ends;                /* the nodes of the two ends of each open line that has a rank, in order */
    uint32_t *slots;               /* hash table: a node + 1, later a dot + 1; 0: free. At most half are in use */
    size_t node_count, slot_count; /* slot_count: a power of two */
    end_dot *dots;                 /* at most one for each end */
    size_t dot_count;
} finder;

typedef struct line {
    const double *points;
    size_t count;
    uint32_t class_index;
    double rank;
    bool open; /* it has a rank and two ends, which may be one point: rings have more points */
} line;

static line line_at(const finder *f, size_t polyline) {
    const camber_features *features = f->features;
    const size_t first = features->offsets[polyline];
    line l = {.points = features->points + 2 * first,
              .count = features->offsets[polyline + 1] - first,
              .class_index = features->feature_class[features->polyline_feature[polyline]]};
    l.rank = f->ranks[l.class_index];
    l.open = l.rank != CAMBER_NO_RANK &&
             (l.count < 3 || memcmp(l.points, l.points + 2 * (l.count - 1), 2 * sizeof *l.points) != 0);
    return l;
}

/* Returns the slot of the node at a point, or the free slot at which it would be. */
static uint32_t *slot_of(const finder *f, const double *at) {
    size_t slot = (size_t)camber_mix_point(0, at) & (f->slot_count - 1);
    while (f->slots[slot] && memcmp(f->nodes[f->slots[slot] - 1].at, at, 2 * sizeof *at) != 0)
        slot = (slot + 1) & (f->slot_count - 1);
    return f->slots + slot;
}

static uint32_t add_node(finder *f, const double *at) {
    uint32_t *slot = slot_of(f, at);
    if (!*slot) {
        f->nodes[f->node_count] = (end_node){.at = {at[0], at[1]}, .top = CAMBER_NO_RANK};
        *slot = (uint32_t)++f->node_count;
    }
    return *slot - 1;
}

static void touch(end_node *node, double rank, bool ends) {
    if (rank > node->top) {
        node->top = rank;
        node->at_top = 0;
        node->passes = false;
    }
    if (node->touches < 2)
        node->touches++;
    if (rank < node->top)
        return;
    if (node->at_top < 2)
        node->at_top++;
    node->passes |= !ends;
}

static void add_nodes(finder *f) {
    uint32_t *end = f->ends;
    for (size_t p = f->first_polyline; p < f->polyline_end; p++) {
        const line l = line_at(f, p);
        for (int last = 0; last < 2 && l.open; last++) {
            *end = add_node(f, l.points + (last ? 2 * (l.count - 1) : 0));
            touch(f->nodes + *end++, l.rank, true);
        }
    }
}

/* Tells the nodes of lines that pass. A ring has none of its points twice. */
static void pass_nodes(finder *f) {
    for (size_t p = f->first_polyline; p < f->polyline_end; p++) {
        const line l = line_at(f, p);
        for (size_t i = 1; l.rank != CAMBER_NO_RANK && i + l.open < l.count; i++) {
            const uint32_t slot = *slot_of(f, l.points + 2 * i);
            if (slot)
                touch(f->nodes + slot - 1, l.rank, false);
        }
    }
}

static bool is_round(const end_node *node, double rank) {
    const bool alone = node->touches < 2, highest = rank >= node->top && node->at_top < 2;
    return alone || (!highest && !node->passes);
}

/* Adds a dot, unless a line of the same class has it. */
static void add_dot(finder *f, end_dot dot) {
    size_t slot = (size_t)camber_mix(dot.node, dot.class_index) & (f->slot_count - 1);
    for (; f->slots[slot]; slot = (slot + 1) & (f->slot_count - 1)) {
        const end_dot *other = f->dots + f->slots[slot] - 1;
        if (other->node == dot.node && other->class_index == dot.class_index)
            return;
    }
    f->dots[f->dot_count] = dot;
    f->slots[slot] = (uint32_t)++f->dot_count;
}

static void find_dots(finder *f) {
    const uint32_t *end = f->ends;
    memset(f->slots, 0, f->slot_count * sizeof *f->slots);
    for (size_t p = f->first_polyline; p < f->polyline_end; p++) {
        const line l = line_at(f, p);
        for (int last = 0; last < 2 && l.open; last++, end++)
            if (is_round(f->nodes + *end, l.rank))
                add_dot(f, (end_dot){*end, l.class_index});
    }
}

/* Finds the class of a line's dots. */
static camber_status find_class(const finder *f, uint32_t class_index, uint32_t *dot_class) {
    camber_features *features = f->features;
    const uint32_t source = features->source;
    camber_feature_class wanted = features->classes[class_index];
    if (*dot_class != NONE)
        return CAMBER_OK;
    wanted.is_ends = true;
    features->source = wanted.source;
    const camber_value *values = features->schema->property_count ? features->values + wanted.first_value : NULL;
    const camber_status status = camber_features_find_class_of(features, &wanted, values, dot_class);
    features->source = source;
    return status;
}

static camber_status append_dots(const finder *f) {
    camber_features *features = f->features;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < f->dot_count && status == CAMBER_OK; i++) {
        const end_dot *dot = f->dots + i;
        uint32_t *dot_class = f->dot_class + dot->class_index;
        status = find_class(f, dot->class_index, dot_class);
        if (status == CAMBER_OK)
            status = camber_features_add_feature(features, *dot_class);
        if (status == CAMBER_OK)
            status = camber_features_add_polyline(features, f->nodes[dot->node].at, 1);
    }
    return status;
}

/* Ranks the classes, and counts the ends of lines that have a rank. */
static size_t rank_classes(finder *f) {
    size_t ends = 0;
    for (size_t c = 0; c < f->features->class_count; c++) {
        f->ranks[c] = camber_features_rank_ends(f->features, (uint32_t)c);
        f->dot_class[c] = NONE;
    }
    for (size_t p = f->first_polyline; p < f->polyline_end; p++)
        ends += line_at(f, p).open ? 2 : 0;
    return ends;
}

camber_status camber_features_add_ends(camber_features *features, size_t first_polyline) {
    camber_context *context = features->context;
    finder f = {.features = features,
                .first_polyline = first_polyline,
                .polyline_end = features->polyline_count,
                .slot_count = 16};
    camber_status status = CAMBER_ERROR_MEMORY;
    if (!features->schema->rank_ends || first_polyline == features->polyline_count)
        return CAMBER_OK;
    if (!(f.ranks = camber_alloc(context, features->class_count, sizeof *f.ranks)) ||
        !(f.dot_class = camber_alloc(context, features->class_count, sizeof *f.dot_class)))
        goto done;
    const size_t end_count = rank_classes(&f);
    while (f.slot_count < 2 * end_count)
        f.slot_count *= 2;
    if (!(f.nodes = camber_alloc(context, end_count, sizeof *f.nodes)) ||
        !(f.ends = camber_alloc(context, end_count, sizeof *f.ends)) ||
        !(f.dots = camber_alloc(context, end_count, sizeof *f.dots)) ||
        !(f.slots = camber_alloc_zero(context, f.slot_count, sizeof *f.slots)))
        goto done;
    add_nodes(&f);
    pass_nodes(&f);
    find_dots(&f);
    status = append_dots(&f);
done:
    camber_free(context, f.dots);
    camber_free(context, f.slots);
    camber_free(context, f.ends);
    camber_free(context, f.nodes);
    camber_free(context, f.dot_class);
    camber_free(context, f.ranks);
    return status;
}
