/* Merges lines of one class that meet end to end, as GEOS's LineMerge does: if exactly two ends of a class meet at a
 * point, the two lines become one. Lines of one class are drawn alike at every zoom, so only the caps at these ends
 * disappear. Fewer lines also have fewer ends, which simplification must keep.
 *
 * Lines from a style's own sources are merged only if they continue almost straight. Without merging, two butt ends
 * would leave a light seam, because each of them covers only a part of the same pixels. Lines that bend there keep
 * their caps.
 */
#include "base/maths.h"
#include "features/chains.h"
#include "features/features.h"

#include <math.h>
#include <string.h>

/* The cosine of a turn by 40 degrees. */
static const double STRAIGHT_COSINE = 0.766;
/* If more ends than this meet at a node, the straight rule joins none of them. */
enum { NODE_ENDS_MAX = 16 };

/* The state of merging the lines from first_polyline on. */
typedef struct merger {
    camber_features *features;
    size_t first_polyline;
    size_t line_count;
    camber_geometry_kind kind; /* lines of this kind are merged; others stay */
    uint32_t *partner;         /* by end: the end to which it is joined; CAMBER_NO_END: none */
    uint32_t *next;            /* used by the straight rule: another end at the same node, or CAMBER_NO_END */
    uint8_t *met;              /* the number of ends at the node whose first end this is, counted up to 3 */
    uint32_t *slots; /* hash table: the first end at a node, + 1; 0: free. Its size is a power of two, and at most half
                        are in use */
    size_t slot_count;
    bool *visited;
    camber_chain *chains;
    size_t chain_count;
} merger;

static const double *line_points(const merger *m, size_t line, size_t *count) {
    const size_t *offsets = m->features->offsets + m->first_polyline + line;
    *count = offsets[1] - offsets[0];
    return m->features->points + 2 * offsets[0];
}

static const double *end_point(const merger *m, uint32_t end) {
    size_t count;
    const double *points = line_points(m, end / 2, &count);
    return points + (end & 1 ? 2 * (count - 1) : 0);
}

static uint32_t class_of(const merger *m, uint32_t end) {
    return m->features->feature_class[m->features->polyline_feature[m->first_polyline + end / 2]];
}

/* Whether the line has ends that can be joined. If all its points are equal, it is a dot and has none. */
static bool has_ends(const merger *m, size_t line) {
    size_t count;
    const double *points = line_points(m, line, &count);
    if (m->features->classes[class_of(m, (uint32_t)(2 * line))].geometry != m->kind)
        return false;
    for (size_t i = 1; i < count; i++)
        if (memcmp(points, points + 2 * i, 2 * sizeof *points) != 0)
            return true;
    return false;
}

/* Returns the end that was found first at this end's node, which is this end itself if it is the first. */
static uint32_t find_node(merger *m, uint32_t end) {
    const double *at = end_point(m, end);
    const uint32_t class_index = class_of(m, end);
    size_t slot = (size_t)camber_mix_point(camber_mix(0, class_index), at) & (m->slot_count - 1);
    for (; m->slots[slot]; slot = (slot + 1) & (m->slot_count - 1)) {
        const uint32_t other = m->slots[slot] - 1;
        if (class_of(m, other) == class_index && memcmp(end_point(m, other), at, 2 * sizeof *at) == 0)
            return other;
    }
    m->slots[slot] = end + 1;
    return end;
}

static void separate(merger *m, uint32_t end) {
    if (m->partner[end] == CAMBER_NO_END)
        return;
    m->partner[m->partner[end]] = CAMBER_NO_END;
    m->partner[end] = CAMBER_NO_END;
}

static void find_partners(merger *m, bool directed) {
    for (size_t i = 0; i < m->line_count; i++) {
        if (!has_ends(m, i))
            continue;
        for (uint32_t end = (uint32_t)(2 * i); end <= 2 * i + 1; end++) {
            const uint32_t first = find_node(m, end);
            m->met[first] = (uint8_t)(m->met[first] < 3 ? m->met[first] + 1 : 3);
            if (m->met[first] == 2) {
                m->partner[first] = end;
                m->partner[end] = first;
            } else {
                separate(m, first);
            }
        }
    }
    for (uint32_t end = 0; end < 2 * m->line_count; end++) {
        const uint32_t other = m->partner[end];
        const bool closes = other == (end ^ 1), turns = ((end ^ other) & 1) == 0;
        if (other != CAMBER_NO_END && (closes || (directed && turns)))
            separate(m, end);
    }
}

/* ---- Lines that continue straight ---- */

/* Computes the direction in which a line leaves its end. */
static void find_direction(const merger *m, uint32_t end, double direction[2]) {
    size_t count;
    const double *points = line_points(m, end / 2, &count), *at = points + (end & 1 ? 2 * (count - 1) : 0);
    direction[0] = direction[1] = 0.0;
    for (size_t i = 1; i < count && direction[0] == 0.0 && direction[1] == 0.0; i++) {
        const double *other = points + 2 * (end & 1 ? count - 1 - i : i);
        direction[0] = other[0] - at[0];
        direction[1] = other[1] - at[1];
    }
    const double length = camber_length(direction[0], direction[1]);
    direction[0] /= length;
    direction[1] /= length;
}

/* Pairs the ends at a node, of which first is one. Pairs that turn least are made first. */
static void pair_straight(merger *m, uint32_t first) {
    uint32_t ends[NODE_ENDS_MAX];
    double directions[NODE_ENDS_MAX][2];
    size_t count = 0;
    for (uint32_t end = first; end != CAMBER_NO_END && count < NODE_ENDS_MAX; end = m->next[end])
        ends[count++] = end;
    for (size_t i = 0; i < count; i++)
        find_direction(m, ends[i], directions[i]);
    for (;;) {
        size_t a = 0, b = 0;
        double best = STRAIGHT_COSINE;
        for (size_t i = 0; i < count; i++)
            for (size_t k = i + 1; k < count; k++) {
                const double cosine = -(directions[i][0] * directions[k][0] + directions[i][1] * directions[k][1]);
                const bool free = m->partner[ends[i]] == CAMBER_NO_END && m->partner[ends[k]] == CAMBER_NO_END;
                if (!free || ends[i] / 2 == ends[k] / 2 || !(cosine > best))
                    continue;
                best = cosine;
                a = i;
                b = k;
            }
        if (a == b)
            return;
        m->partner[ends[a]] = ends[b];
        m->partner[ends[b]] = ends[a];
    }
}

static void find_straight_partners(merger *m) {
    for (size_t i = 0; i < m->line_count; i++) {
        if (!has_ends(m, i))
            continue;
        for (uint32_t end = (uint32_t)(2 * i); end <= 2 * i + 1; end++) {
            const uint32_t first = find_node(m, end);
            m->met[first] = 1;
            if (first == end)
                continue;
            m->next[end] = m->next[first];
            m->next[first] = end;
        }
    }
    for (uint32_t end = 0; end < 2 * m->line_count; end++)
        if (m->met[end] && m->next[end] != CAMBER_NO_END)
            pair_straight(m, end);
}

/* ---- The merged lines ---- */

/* The merged lines. Chains of several lines are copied; lines that were not joined are moved within the set's arrays.
 */
typedef struct merged {
    double *points; /* the points of chains of several lines, one chain after the other */
    size_t point_count, all_points;
    size_t *counts; /* by chain: its number of points */
    uint32_t *polyline_feature, *feature_counts;
} merged;

static bool is_alone(const merger *m, const camber_chain *chain) {
    return m->partner[chain->start ^ 1] == CAMBER_NO_END && !(chain->start & 1);
}

static void copy_chain(const merger *m, size_t index, merged *made) {
    const camber_features *features = m->features;
    const camber_chain *chain = &m->chains[index];
    uint32_t end = chain->start;
    size_t sum = 0;
    made->polyline_feature[index] = features->polyline_feature[m->first_polyline + chain->key];
    made->feature_counts[index] = 0;
    do {
        size_t count;
        const double *points = line_points(m, end / 2, &count);
        /* One point remains where two lines meet; a ring has the point at its seam twice. */
        for (size_t i = end != chain->start; i < count && made->points; i++) {
            const double *from = points + 2 * (end & 1 ? count - 1 - i : i);
            memcpy(made->points + 2 * made->point_count++, from, 2 * sizeof *from);
        }
        sum += count - (end != chain->start);
        made->feature_counts[index] += features->feature_counts[m->first_polyline + end / 2];
        end = m->partner[end ^ 1];
    } while (end != CAMBER_NO_END && end != chain->start);
    made->counts[index] = sum;
}

/* Moves the points of lines that were not joined to the front and keeps their order. Returns how many points there are.
 */
static size_t gather_alone(const merger *m) {
    camber_features *features = m->features;
    size_t at = features->offsets[m->first_polyline];
    for (size_t i = 0; i < m->chain_count; i++) {
        size_t count;
        if (!is_alone(m, &m->chains[i]))
            continue;
        const double *points = line_points(m, m->chains[i].start / 2, &count);
        memmove(features->points + 2 * at, points, 2 * count * sizeof *points);
        at += count;
    }
    return at;
}

/* Moves lines and chains to their final positions, from the last to the first, so that none is overwritten before it is
 * moved. */
static void spread(const merger *m, const merged *made, size_t alone_end) {
    camber_features *features = m->features;
    size_t at = features->offsets[m->first_polyline] + made->all_points, copied = made->point_count;
    for (size_t i = m->chain_count; i-- > 0;) {
        const size_t count = made->counts[i];
        at -= count;
        if (is_alone(m, &m->chains[i])) {
            alone_end -= count;
            memmove(features->points + 2 * at, features->points + 2 * alone_end, 2 * count * sizeof *features->points);
        } else {
            copied -= count;
            memcpy(features->points + 2 * at, made->points + 2 * copied, 2 * count * sizeof *features->points);
        }
    }
}

static void replace_lines(const merger *m, const merged *made) {
    camber_features *features = m->features;
    const size_t first = m->first_polyline;
    spread(m, made, gather_alone(m));
    memcpy(features->polyline_feature + first, made->polyline_feature, m->chain_count * sizeof *made->polyline_feature);
    memcpy(features->feature_counts + first, made->feature_counts, m->chain_count * sizeof *made->feature_counts);
    for (size_t i = 0; i < m->chain_count; i++)
        features->offsets[first + i + 1] = features->offsets[first + i] + made->counts[i];
    features->polyline_count = first + m->chain_count;
    features->point_count = features->offsets[first] + made->all_points;
    features->stats.merged_polylines += m->line_count - m->chain_count;
}

/* Frees the tables that are only needed to find partners. */
static void forget_nodes(merger *m) {
    camber_context *context = m->features->context;
    camber_free(context, m->next);
    camber_free(context, m->slots);
    camber_free(context, m->met);
    m->next = m->slots = NULL;
    m->met = NULL;
}

static camber_status write_chains(const merger *m) {
    camber_context *context = m->features->context;
    merged made = {0};
    camber_status status = CAMBER_ERROR_MEMORY;
    size_t copied = 0;
    if (!(made.counts = camber_alloc(context, m->chain_count, sizeof *made.counts)) ||
        !(made.polyline_feature = camber_alloc(context, m->chain_count, sizeof *made.polyline_feature)) ||
        !(made.feature_counts = camber_alloc(context, m->chain_count, sizeof *made.feature_counts)))
        goto done;
    for (size_t i = 0; i < m->chain_count; i++) {
        copy_chain(m, i, &made); /* frees counts */
        made.all_points += made.counts[i];
        copied += is_alone(m, &m->chains[i]) ? 0 : made.counts[i];
    }
    if (!(made.points = camber_alloc(context, copied, 2 * sizeof *made.points)))
        goto done;
    for (size_t i = 0; i < m->chain_count; i++)
        if (!is_alone(m, &m->chains[i]))
            copy_chain(m, i, &made);
    replace_lines(m, &made);
    status = CAMBER_OK;
done:
    camber_free(context, made.points);
    camber_free(context, made.feature_counts);
    camber_free(context, made.polyline_feature);
    camber_free(context, made.counts);
    return status;
}

static camber_status merge(camber_features *features, size_t first_polyline, camber_merge_rule rule,
                           camber_geometry_kind kind) {
    camber_context *context = features->context;
    merger m = {.features = features,
                .kind = kind,
                .first_polyline = first_polyline,
                .line_count = features->polyline_count - first_polyline,
                .slot_count = 16};
    if (m.line_count < 2)
        return CAMBER_OK;
    if (m.line_count >= (size_t)1 << 30)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "cannot merge %zu lines, because the limit is 2^30; read fewer features", m.line_count);
    while (m.slot_count < 4 * m.line_count)
        m.slot_count *= 2;
    camber_status status = CAMBER_ERROR_MEMORY;
    if (!(m.partner = camber_alloc(context, 2 * m.line_count, sizeof *m.partner)) ||
        !(m.met = camber_alloc_zero(context, 2 * m.line_count, sizeof *m.met)) ||
        !(m.slots = camber_alloc_zero(context, m.slot_count, sizeof *m.slots)) ||
        !(m.visited = camber_alloc_zero(context, m.line_count, sizeof *m.visited)) ||
        !(m.next = camber_alloc(context, rule == CAMBER_MERGE_STRAIGHT ? 2 * m.line_count : 1, sizeof *m.next)))
        goto done;
    memset(m.partner, 0xff, 2 * m.line_count * sizeof *m.partner);
    if (rule == CAMBER_MERGE_STRAIGHT) {
        memset(m.next, 0xff, 2 * m.line_count * sizeof *m.next);
        find_straight_partners(&m);
    } else {
        find_partners(&m, rule == CAMBER_MERGE_DIRECTED);
    }
    forget_nodes(&m);
    const camber_chains_desc chains = {
        .partner = m.partner, .line_count = m.line_count, .key_count = m.line_count, .visited = m.visited};
    status = camber_chains_find(context, &chains, &m.chains, &m.chain_count);
    camber_free(context, m.visited);
    m.visited = NULL;
    if (status == CAMBER_OK && m.chain_count < m.line_count)
        status = write_chains(&m);
done:
    forget_nodes(&m);
    camber_free(context, m.chains);
    camber_free(context, m.visited);
    camber_free(context, m.partner);
    return status;
}

camber_status camber_features_merge(camber_features *features, size_t first_polyline, camber_merge_rule rule) {
    return merge(features, first_polyline, rule, CAMBER_GEOMETRY_LINE);
}

/* Merges the lines of labels, which come last, so that the pieces of a street with one name become one line. They are
 * not counted. If icons show the direction of lines, as the arrows of one-way streets do, no line may be turned. */
static camber_status merge_labels(camber_features *features, size_t first_polyline, camber_merge_rule rule) {
    const size_t counted = features->stats.merged_polylines;
    const camber_status status =
        merge(features, camber_features_find_labels(features, first_polyline),
              features->schema->labels_directed ? CAMBER_MERGE_DIRECTED : rule, CAMBER_GEOMETRY_LABEL_LINE);
    features->stats.merged_polylines = counted;
    return status;
}

camber_status camber_features_merge_and_weigh(camber_features *features, size_t first_polyline, bool merges,
                                              camber_merge_rule rule) {
    const double start_ms = camber_now_ms();
    const bool directed = rule == CAMBER_MERGE_ANY && features->schema->directed;
    features->changes++;
    camber_status status = CAMBER_OK;
    if (merges)
        status = camber_features_merge(features, first_polyline, directed ? CAMBER_MERGE_DIRECTED : rule);
    if (status == CAMBER_OK)
        status = camber_features_add_ends(features, first_polyline);
    if (status == CAMBER_OK)
        status = camber_features_part_labels(features, first_polyline);
    if (status == CAMBER_OK && features->wants_labels)
        status = merge_labels(features, first_polyline, rule);
    camber_features_shrink(features);
    const double merged_ms = camber_now_ms();
    if (status == CAMBER_OK)
        status = camber_features_set_importance(features, first_polyline);
    if (status == CAMBER_OK && features->has_region)
        status = camber_features_confine(features, first_polyline, &features->region);
    features->times.merge_ms += merged_ms - start_ms;
    features->times.weigh_ms += camber_now_ms() - merged_ms;
    return status;
}
