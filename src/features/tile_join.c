/* Joins the lines of features that vector tiles have cut.
 *
 * Ends on borders are hashed by feature and position; the nearest end in another tile becomes the partner. If both ends
 * were made by cutting, they are not points of the feature and are dropped, because the points before and after them
 * were neighbours. Chains of partners become polylines. The time is linear in the number of points.
 */
#include "base/maths.h"
#include "features/chains.h"
#include "features/order.h"
#include "features/tile_stitcher.h"

#include <math.h>
#include <string.h>

/* The maximum distance between partners, in units. A tile's lines are rounded to its grid, which mostly has 2048 or
 * 4096 steps. A line that is cut at the buffer's edge is rounded once more, which moves the point at which it crosses
 * the border. */
static const double REACH = 4;

/* The maximum distance for lines with an id, which may cross the border at a flat angle: 1/128 of a tile. */
static const double ID_REACH = 32;

/* No known map uses a grid coarser than 1/64 of a tile. */
static const double MOST_REACH = 32;

/* Partners that match exactly are joined first, so that two lines that cross the border side by side stay separate. */
static const double EXACT = 0.01;

/* How many candidates are compared in a cell. Only malicious files have more in one cell. */
enum { MAX_CANDIDATES = 64 };

#define NONE CAMBER_NO_END

typedef struct joiner {
    camber_tile_stitcher *stitcher;
    uint32_t *partner;
    uint32_t *heads; /* the first end in each cell's list; head_count is a power of two */
    size_t head_count;
    uint32_t *next;
} joiner;

typedef struct join_pass {
    bool by_id; /* false: match by class. The lines that are left have no id, or one that is valid only in their tile */
    double reach;
    bool directed;
} join_pass;

static const double *end_point(const camber_tile_stitcher *stitcher, uint32_t end) {
    const camber_cut_line *line = &stitcher->lines[end / 2];
    return stitcher->points + 2 * (line->first + (end & 1 ? line->count - 1 : 0));
}

static uint32_t group_of(const camber_tile_stitcher *stitcher, uint32_t end, bool by_id) {
    const uint32_t feature = stitcher->lines[end / 2].feature;
    return by_id ? feature : stitcher->features[feature].class_index;
}

static int64_t cell_of(double unit, double cell) {
    return (int64_t)floor(unit / cell);
}

static size_t head_of(const joiner *join, uint32_t group, int64_t column, int64_t row) {
    const uint64_t hash = camber_mix(camber_mix(group, (uint64_t)column), (uint64_t)row);
    return (size_t)hash & (join->head_count - 1);
}

static bool is_candidate(const joiner *join, uint32_t end, const join_pass *pass) {
    const camber_cut_line *line = &join->stitcher->lines[end / 2];
    return line->count > 1 && line->border[end & 1] && join->partner[end] == NONE &&
           (!pass->by_id || join->stitcher->features[line->feature].has_id);
}

static bool may_join(const joiner *join, uint32_t a, uint32_t b, const join_pass *pass) {
    const camber_tile_stitcher *stitcher = join->stitcher;
    const camber_cut_line *p = &stitcher->lines[a / 2], *q = &stitcher->lines[b / 2];
    const bool by_id = pass->by_id;
    if (p == q || join->partner[b] != NONE || group_of(stitcher, a, by_id) != group_of(stitcher, b, by_id))
        return false;
    if (pass->directed && ((a ^ b) & 1) == 0)
        return false;
    /* Two features with different ids whose ends are at the same point of a border only touch there. */
    if (!by_id && stitcher->features[p->feature].has_id && stitcher->features[q->feature].has_id &&
        !(p->cut[a & 1] && q->cut[b & 1]))
        return false;
    return p->column != q->column || p->row != q->row || p->along_border || q->along_border;
}

static uint32_t nearest(const joiner *join, uint32_t end, const join_pass *pass) {
    const double *at = end_point(join->stitcher, end);
    const uint32_t group = group_of(join->stitcher, end, pass->by_id);
    const double cell = 2 * pass->reach;
    double best = pass->reach * pass->reach;
    uint32_t found = NONE;
    const int64_t left = cell_of(at[0] - pass->reach, cell), right = cell_of(at[0] + pass->reach, cell);
    const int64_t top = cell_of(at[1] - pass->reach, cell), bottom = cell_of(at[1] + pass->reach, cell);
    for (int64_t column = left; column <= right; column++) {
        for (int64_t row = top; row <= bottom; row++) {
            uint32_t other = join->heads[head_of(join, group, column, row)];
            for (int i = 0; other != NONE && i < MAX_CANDIDATES; i++, other = join->next[other]) {
                const double *there = end_point(join->stitcher, other);
                const double dx = there[0] - at[0], dy = there[1] - at[1], distance = dx * dx + dy * dy;
                if (distance <= best && (found == NONE || distance < best) && may_join(join, end, other, pass)) {
                    best = distance;
                    found = other;
                }
            }
        }
    }
    return found;
}

static void find_partners(joiner *join, const join_pass *pass) {
    const uint32_t ends = (uint32_t)(2 * join->stitcher->line_count);
    const double cell = 2 * pass->reach;
    memset(join->heads, 0xff, join->head_count * sizeof *join->heads);
    for (uint32_t end = 0; end < ends; end++) {
        if (!is_candidate(join, end, pass))
            continue;
        const double *at = end_point(join->stitcher, end);
        const uint32_t group = group_of(join->stitcher, end, pass->by_id);
        const size_t head = head_of(join, group, cell_of(at[0], cell), cell_of(at[1], cell));
        join->next[end] = join->heads[head];
        join->heads[head] = end;
    }
    for (uint32_t end = 0; end < ends; end++) {
        const uint32_t other = is_candidate(join, end, pass) ? nearest(join, end, pass) : NONE;
        if (other != NONE) {
            join->partner[end] = other;
            join->partner[other] = end;
        }
    }
}

/* Lines along a border are in both neighbouring tiles; keeps one line of each pair. Reuses the lists of ends for lines.
 */
static void drop_repeated_border_lines(joiner *join) {
    camber_tile_stitcher *stitcher = join->stitcher;
    memset(join->heads, 0xff, join->head_count * sizeof *join->heads);
    for (uint32_t i = 0; i < stitcher->line_count; i++) {
        camber_cut_line *line = &stitcher->lines[i];
        if (!line->along_border || line->count == 0)
            continue;
        const bool by_id = stitcher->features[line->feature].has_id;
        const uint32_t group = group_of(stitcher, 2 * i, by_id);
        const double *p = end_point(stitcher, 2 * i), *q = end_point(stitcher, 2 * i + 1);
        /* The sums are the same in both directions. Counted in sixteenths, they are whole numbers. */
        const size_t head = head_of(join, group, (int64_t)((p[0] + q[0]) * 16), (int64_t)((p[1] + q[1]) * 16));
        uint32_t other = join->heads[head];
        bool repeated = false;
        for (int k = 0; other != NONE && k < MAX_CANDIDATES && !repeated; k++, other = join->next[other]) {
            const double *r = end_point(stitcher, 2 * other), *s = end_point(stitcher, 2 * other + 1);
            const bool same = camber_tile_stitcher_same(p, r) && camber_tile_stitcher_same(q, s);
            const bool turned = camber_tile_stitcher_same(p, s) && camber_tile_stitcher_same(q, r);
            repeated = group_of(stitcher, 2 * other, by_id) == group && (same || turned);
        }
        if (repeated) {
            line->count = 0;
            continue;
        }
        join->next[i] = join->heads[head];
        join->heads[head] = i;
    }
}

/* Drops crumbs. If a line passes near the corner of four tiles, one tile may have only a tiny piece of it between two
 * cuts, and both ends of the piece are within reach of the neighbours' ends. Without this crumb, the neighbours' ends
 * find each other. */
static void drop_crumbs(const joiner *join, double reach) {
    camber_tile_stitcher *stitcher = join->stitcher;
    for (uint32_t i = 0; i < stitcher->line_count; i++) {
        camber_cut_line *line = &stitcher->lines[i];
        const double *p = end_point(stitcher, 2 * i);
        if (line->count == 2 && line->cut[0] && line->cut[1] && camber_length(p[2] - p[0], p[3] - p[1]) < reach / 2)
            line->count = 0;
    }
}

/* ---- Chains ---- */

/* Whether the point at which a line is entered is left out. At a joint, one of the two points remains, or none if
 * cutting made both. */
static bool skips_entry(const joiner *join, uint32_t enter) {
    const camber_cut_line *lines = join->stitcher->lines;
    const uint32_t leave = join->partner[enter];
    return leave != NONE && (!lines[leave / 2].cut[leave & 1] || lines[enter / 2].cut[enter & 1]);
}

/* Copies the chain's points to scratch, in world coordinates. *last becomes the end at which the chain ends. */
static bool gather_points(const joiner *join, uint32_t start, size_t *count, uint32_t *last) {
    camber_tile_stitcher *stitcher = join->stitcher;
    size_t points = 0;
    uint32_t end = start;
    do {
        const camber_cut_line *line = &stitcher->lines[end / 2];
        const uint32_t leave = end ^ 1, enter = join->partner[leave];
        const bool skip_entry = skips_entry(join, end), skip_leave = enter != NONE && line->cut[leave & 1];
        if (!camber_grow(stitcher->context, &stitcher->scratch, &stitcher->scratch_capacity, points + line->count + 1,
                         2 * sizeof *stitcher->scratch))
            return false;
        for (size_t i = 0; i < line->count; i++) {
            if ((i == 0 && skip_entry) || (i + 1 == line->count && skip_leave))
                continue;
            const double *from = stitcher->points + 2 * (line->first + (end & 1 ? line->count - 1 - i : i));
            stitcher->scratch[2 * points] = from[0] / stitcher->units;
            stitcher->scratch[2 * points + 1] = from[1] / stitcher->units;
            points++;
        }
        *last = leave;
        end = enter;
    } while (end != NONE && end != start);
    if (end == start && points) {
        memcpy(stitcher->scratch + 2 * points, stitcher->scratch, 2 * sizeof *stitcher->scratch);
        points++;
    }
    *count = points;
    return true;
}

/* ---- Order of drawing ---- */

/* Chains, sorted by key, and their order of drawing. order: the keys in that order. */
typedef struct chain_list {
    camber_chain *chains;
    size_t count;
    uint32_t *order;
    size_t key_count;
} chain_list;

/* Gives each line the key of its chain. */
static void key_lines(const joiner *join, const chain_list *list, uint32_t *keys) {
    for (size_t i = 0; i < list->count; i++) {
        uint32_t end = list->chains[i].start;
        do {
            keys[end / 2] = list->chains[i].key;
            end = join->partner[end ^ 1];
        } while (end != NONE && end != list->chains[i].start);
    }
}

static bool same_list(const camber_tile_stitcher *stitcher, const camber_features *features, size_t a, size_t b) {
    const camber_cut_line *p = &stitcher->lines[a], *q = &stitcher->lines[b];
    const uint32_t classes[2] = {stitcher->features[p->feature].class_index,
                                 stitcher->features[q->feature].class_index};
    return p->column == q->column && p->row == q->row &&
           features->classes[classes[0]].layer == features->classes[classes[1]].layer;
}

/* Decides the order of drawing, so that a line that is on top in one tile is on top in all tiles. The order of features
 * within a tile is the author's, usually with important roads last. But a road that begins in the first tile must not
 * be drawn below everything in the second tile. */
static camber_status find_order(const joiner *join, const camber_features *features, uint32_t *keys, chain_list *list) {
    const camber_tile_stitcher *stitcher = join->stitcher;
    camber_context *context = stitcher->context;
    camber_status status = CAMBER_ERROR_MEMORY;
    uint32_t *lists = camber_alloc(context, 2 * stitcher->line_count, sizeof *lists);
    if (lists && (list->order = camber_alloc(context, list->key_count, sizeof *list->order))) {
        camber_order_desc desc = {.count = list->key_count, .lists = lists};
        size_t last = 0;
        key_lines(join, list, keys);
        for (size_t i = 0; i < stitcher->line_count; i++) {
            if (stitcher->lines[i].count == 0)
                continue;
            if (desc.item_count && !same_list(stitcher, features, last, i))
                lists[desc.item_count++] = CAMBER_LIST_END;
            lists[desc.item_count++] = keys[i];
            last = i;
        }
        status = camber_order_merge(context, &desc, list->order);
    }
    camber_free(context, lists);
    return status;
}

/* ---- Features ---- */

static camber_status add_chain(const joiner *join, const camber_chain *chain, camber_features *features) {
    const camber_cut_line *lines = join->stitcher->lines;
    size_t points = 0;
    uint32_t last = chain->start;
    if (!gather_points(join, chain->start, &points, &last))
        return CAMBER_ERROR_MEMORY;
    camber_status status = camber_features_add_polyline(features, join->stitcher->scratch, points);
    if (status == CAMBER_OK && join->stitcher->has_progress)
        status = camber_features_set_progress(features, (double)lines[chain->start / 2].progress[chain->start & 1],
                                              (double)lines[last / 2].progress[last & 1]);
    return status;
}

static camber_status add_chains(const joiner *join, const chain_list *list, camber_features *features) {
    camber_context *context = join->stitcher->context;
    camber_status status = CAMBER_OK;
    size_t *firsts = camber_alloc_zero(context, list->key_count + 1, sizeof *firsts);
    if (!firsts)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < list->count; i++)
        firsts[list->chains[i].key + 1] = i + 1;
    for (size_t i = 0; i < list->key_count; i++)
        firsts[i + 1] = firsts[i + 1] ? firsts[i + 1] : firsts[i];
    for (size_t k = 0; k < list->key_count && status == CAMBER_OK; k++) {
        const uint32_t key = list->order[k];
        if (firsts[key] == firsts[key + 1])
            continue;
        status = camber_features_add_feature(features, join->stitcher->features[key].class_index);
        for (size_t i = firsts[key]; i < firsts[key + 1] && status == CAMBER_OK; i++)
            status = add_chain(join, &list->chains[i], features);
    }
    camber_free(context, firsts);
    return status;
}

static camber_status add_polylines(const joiner *join, camber_features *features) {
    camber_tile_stitcher *stitcher = join->stitcher;
    camber_context *context = stitcher->context;
    camber_chains_desc desc = {
        .partner = join->partner, .line_count = stitcher->line_count, .key_count = stitcher->feature_count};
    chain_list list = {.key_count = stitcher->feature_count};
    size_t left = 0;
    camber_status status = CAMBER_ERROR_MEMORY;
    uint32_t *keys = camber_alloc(context, stitcher->line_count, sizeof *keys);
    desc.keys = keys;
    if (!keys || !(desc.visited = camber_alloc_zero(context, stitcher->line_count, sizeof *desc.visited)))
        goto done;
    for (size_t i = 0; i < stitcher->line_count; i++) {
        keys[i] = stitcher->lines[i].feature;
        desc.visited[i] = stitcher->lines[i].count == 0;
        left += !desc.visited[i];
    }
    status = camber_chains_find(context, &desc, &list.chains, &list.count);
    if (status == CAMBER_OK)
        status = find_order(join, features, keys, &list);
    if (status == CAMBER_OK)
        status = add_chains(join, &list, features);
    if (status == CAMBER_OK)
        features->stats.joined_pieces += left - list.count;
done:
    camber_free(context, list.order);
    camber_free(context, list.chains);
    camber_free(context, desc.visited);
    camber_free(context, keys);
    return status;
}

static camber_status finish(camber_tile_stitcher *stitcher, camber_features *features, bool directed) {
    camber_context *context = stitcher->context;
    joiner join = {.stitcher = stitcher, .head_count = 1024};
    camber_status status = CAMBER_ERROR_MEMORY;
    while (join.head_count < 2 * stitcher->line_count)
        join.head_count *= 2;
    if (!(join.heads = camber_alloc(context, join.head_count, sizeof *join.heads)) ||
        !(join.next = camber_alloc(context, 2 * stitcher->line_count, sizeof *join.next)) ||
        !(join.partner = camber_alloc(context, 2 * stitcher->line_count, sizeof *join.partner)))
        goto done;
    for (size_t i = 0; i < 2 * stitcher->line_count; i++)
        join.partner[i] = NONE;
    drop_repeated_border_lines(&join);
    /* Tiles with a grid coarser than 2048 have correspondingly larger rounding errors. */
    const double reach = REACH * fmin(fmax(1, stitcher->grid / 2), MOST_REACH), id_reach = fmax(ID_REACH, reach);
    const join_pass passes[] = {{true, EXACT, directed},
                                {true, reach, directed},
                                {true, id_reach, directed},
                                {false, EXACT, directed},
                                {false, reach, directed}};
    drop_crumbs(&join, reach);
    for (size_t i = 0; i < sizeof passes / sizeof *passes; i++)
        find_partners(&join, &passes[i]);
    status = add_polylines(&join, features);
done:
    camber_free(context, join.partner);
    camber_free(context, join.next);
    camber_free(context, join.heads);
    return status;
}

camber_status camber_tile_stitcher_finish(camber_tile_stitcher *stitcher, camber_features *features) {
    return finish(stitcher, features, features->schema->directed);
}

camber_status camber_tile_stitcher_finish_labels(camber_tile_stitcher *labels, camber_features *features) {
    const size_t joined = features->stats.joined_pieces;
    camber_status status = camber_tile_stitcher_keep_largest(labels, features);
    if (status == CAMBER_OK)
        status = finish(labels, features, features->schema->labels_directed);
    features->stats.joined_pieces = joined;
    return status;
}
