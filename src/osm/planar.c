/* Arranges the rings of a multipolygon as libosmium does: by their geometry, and not by the roles of their ways.
 *
 * Input: closed rings. Output: simple rings with the inside of the area on their right, so outer rings go clockwise.
 * The main idea: if no place occurs twice, the rings are simple, and a ring that an odd number of others contain is a
 * hole. Otherwise all rings are split into edges. Two equal edges bound nothing, so both are dropped. Around a place,
 * sectors inside and outside the area alternate:
 *
 *          \  in  /          An edge that arrives continues with the other edge of the same inner sector. A walk
 *      out  \    /  out      that returns to a place has found a ring, which is removed from the walk. So holes that
 *            >--<            touch each other or the outer ring stay separate, and an island between two holes that
 *           /    \           touch twice becomes an outer ring.
 *          /  in  \
 *
 * If the edges form several parts that are not connected, a ray from the westernmost place of each part shows whether
 * it is inside others. The time is n log n if places occur twice, otherwise linear, apart from the rays. */
#include "osm/planar.h"

#include "osm/node_set.h"

#include <stdlib.h>
#include <string.h>

/* The maximum number of edges that are compared with rays and other edges for a file. Only malicious files exceed
 * it. */
static const size_t MOST_STEPS = (size_t)1 << 28;
enum { MOST_ROWS = 1 << 16, MOST_SPANS = 4 };
/* If there are at most FEW_OWNERS owners, rays are compared with all edges, and if there are at most FEW_PLACES places,
 * they are compared with each other. Making the rows or a table would take longer. */
enum { FEW_OWNERS = 8, FEW_PLACES = 32 };

/* An edge. Its owner is a ring, or a connected part of the drawing. Its ends are keys, which sort places from west to
 * east, and then from south to north. */
typedef struct edge {
    uint64_t ends[2];
    uint32_t owner;
} edge;

/* An edge as it leaves one of its two places. */
typedef struct half_edge {
    uint64_t from, to;
    uint32_t edge;
} half_edge;

/* The edges sorted into rows of latitude, so that a ray meets few of them. */
typedef struct row_index {
    int32_t bottom;
    double rows_a_unit;
    size_t row_count; /* 0: the rows were not made */
    size_t *first;    /* by row, and one more at the end: index into items */
    uint32_t *items;  /* indices of edges */
} row_index;

typedef struct arranger {
    camber_osm_assembly *to;
    camber_context *context;
    edge *edges;
    size_t edge_count;
    uint32_t owner_count;
    uint64_t *tops; /* by owner: one of its places */
    uint8_t *odd;   /* by owner: it is inside an odd number of others */
    row_index rows;
    /* The following fields are used only if places occur twice. */
    half_edge *halves; /* sorted by place, and around each place counter-clockwise from the south */
    size_t half_count;
    uint32_t *twins, *nodes; /* by half-edge: the half-edge at the other end of its edge, and the index of its place */
    uint32_t *first;         /* by node, and one more at the end: its first half-edge */
    uint32_t node_count;
    uint32_t *parts;  /* by node: its connected part; NONE */
    uint8_t *leaves;  /* by half-edge: 1 if a ring leaves along it, 0 if one arrives along it; 2: not known */
    uint32_t *stack;  /* of nodes, or of the half-edges of a walk */
    uint32_t *walked; /* by node: its position on the walk; NONE */
} arranger;

#define NONE UINT32_MAX

static uint64_t key_of(uint64_t place) {
    return place ^ CAMBER_OSM_NOWHERE;
}

static double x_of(uint64_t key) {
    return camber_osm_longitude(key ^ CAMBER_OSM_NOWHERE);
}

static int32_t y_of(uint64_t key) {
    return camber_osm_latitude(key ^ CAMBER_OSM_NOWHERE);
}

/* ---- Rays ---- */

static size_t row_of(const row_index *rows, int32_t y) {
    const double row = ((double)y - rows->bottom) * rows->rows_a_unit;
    return row < 1.0 ? 0 : row < (double)rows->row_count ? (size_t)row : rows->row_count - 1;
}

static void get_rows(const arranger *self, size_t i, size_t *low, size_t *high) {
    const size_t a = row_of(&self->rows, y_of(self->edges[i].ends[0])),
                 b = row_of(&self->rows, y_of(self->edges[i].ends[1]));
    *low = a < b ? a : b;
    *high = a < b ? b : a;
}

/* Chooses the number of rows, so that an edge is in at most four rows on average. Returns the total number of entries.
 */
static size_t choose_rows(arranger *self) {
    row_index *rows = &self->rows;
    int32_t top = rows->bottom = y_of(self->edges[0].ends[0]);
    for (size_t i = 0; i < 2 * self->edge_count; i++) {
        const int32_t y = y_of(self->edges[i / 2].ends[i % 2]);
        rows->bottom = y < rows->bottom ? y : rows->bottom;
        top = y > top ? y : top;
    }
    for (rows->row_count = self->edge_count < MOST_ROWS ? self->edge_count : MOST_ROWS;; rows->row_count /= 2) {
        size_t spans = 0, low, high;
        rows->rows_a_unit = (double)rows->row_count / ((double)top - rows->bottom + 1.0);
        for (size_t i = 0; i < self->edge_count; i++) {
            get_rows(self, i, &low, &high);
            spans += high - low + 1;
        }
        if (rows->row_count == 1 || spans <= MOST_SPANS * self->edge_count)
            return spans;
    }
}

static bool index_rows(arranger *self) {
    row_index *rows = &self->rows;
    const size_t spans = choose_rows(self);
    size_t low, high;
    if (!(rows->first = camber_alloc_zero(self->context, rows->row_count + 2, sizeof *rows->first)) ||
        !(rows->items = camber_alloc(self->context, spans, sizeof *rows->items)))
        return false;
    size_t *next = rows->first + 1; /* by row: the position of its next edge */
    for (size_t i = 0; i < self->edge_count; i++) {
        get_rows(self, i, &low, &high);
        for (size_t row = low; row <= high; row++)
            next[row + 1]++;
    }
    for (size_t row = 0; row < rows->row_count; row++)
        next[row + 1] += next[row];
    for (size_t i = 0; i < self->edge_count; i++) {
        get_rows(self, i, &low, &high);
        for (size_t row = low; row <= high; row++)
            rows->items[next[row]++] = (uint32_t)i;
    }
    return true;
}

/* Returns on which side of the edge a place is. The result is exact for edges shorter than about 9 degrees, because a
 * double represents their products exactly. */
static double side_of(const edge *line, uint64_t place) {
    const double x = x_of(place), y = y_of(place), x0 = x_of(line->ends[0]) - x, y0 = y_of(line->ends[0]) - y,
                 x1 = x_of(line->ends[1]) - x, y1 = y_of(line->ends[1]) - y;
    return x0 * y1 - x1 * y0;
}

/* Whether a ray from a place to the east meets an edge of another owner. */
static bool meets(const edge *line, uint32_t owner, uint64_t place, int32_t y) {
    const int32_t y0 = y_of(line->ends[0]), y1 = y_of(line->ends[1]);
    return (y0 > y) != (y1 > y) && line->owner != owner && (side_of(line, place) > 0.0) == (y1 > y0);
}

/* Whether a ray from an owner's place to the east meets an odd number of other owners' edges. */
static bool is_odd(arranger *self, uint32_t owner) {
    const row_index *rows = &self->rows;
    const uint64_t place = self->tops[owner];
    const int32_t y = y_of(place);
    bool odd = false;
    if (rows->row_count == 0) {
        for (size_t i = 0; i < self->edge_count; i++)
            odd ^= meets(&self->edges[i], owner, place, y);
        self->to->steps += self->edge_count;
        return odd;
    }
    const size_t row = row_of(rows, y);
    for (size_t i = rows->first[row]; i < rows->first[row + 1]; i++)
        odd ^= meets(&self->edges[rows->items[i]], owner, place, y);
    self->to->steps += rows->first[row + 1] - rows->first[row];
    return odd;
}

/* *known: the limit was not exceeded. Returns false if there is no memory. */
static bool find_odd(arranger *self, bool *known) {
    *known = true;
    if (self->edge_count == 0)
        return true;
    if (!(self->odd = camber_alloc_zero(self->context, self->owner_count, 1)) ||
        (self->owner_count > FEW_OWNERS && !index_rows(self)))
        return false;
    for (uint32_t i = 0; i < self->owner_count && self->to->steps < MOST_STEPS; i++)
        self->odd[i] = is_odd(self, i);
    *known = self->to->steps < MOST_STEPS;
    return true;
}

/* ---- Simple rings ---- */

static bool do_cross(const edge *a, const edge *b) {
    const double a0 = side_of(b, a->ends[0]), a1 = side_of(b, a->ends[1]), b0 = side_of(a, b->ends[0]),
                 b1 = side_of(a, b->ends[1]);
    return ((a0 < 0.0 && a1 > 0.0) || (a0 > 0.0 && a1 < 0.0)) && ((b0 < 0.0 && b1 > 0.0) || (b0 > 0.0 && b1 < 0.0));
}

/* Whether a ring crosses another. If it does, its geometry is no more reliable than its role. */
static bool crosses_others(arranger *self, size_t first_edge, size_t end_edge) {
    for (size_t i = first_edge; i < end_edge; i++) {
        size_t low, high;
        get_rows(self, i, &low, &high);
        const size_t first = self->rows.first[low], end = self->rows.first[high + 1];
        self->to->steps += end - first;
        if (self->to->steps >= MOST_STEPS)
            return true;
        for (size_t k = first; k < end; k++) {
            const edge *other = &self->edges[self->rows.items[k]];
            if (other->owner != self->edges[i].owner && do_cross(&self->edges[i], other))
                return true;
        }
    }
    return false;
}

/* Lists the edges of all rings, each owned by its ring. */
static bool list_edges(arranger *self) {
    const camber_osm_assembly *to = self->to;
    if (!(self->edges = camber_alloc(self->context, to->place_count, sizeof *self->edges)))
        return false;
    for (size_t r = 0; r < to->ring_count; r++)
        for (size_t i = to->rings[r].first; i + 1 < to->rings[r].first + to->rings[r].count; i++) {
            const uint64_t a = key_of(to->places[i]), b = key_of(to->places[i + 1]);
            if (a != b)
                self->edges[self->edge_count++] = (edge){{a < b ? a : b, a < b ? b : a}, (uint32_t)r};
        }
    return true;
}

static bool find_roles(arranger *self) {
    camber_osm_assembly *to = self->to;
    bool known = to->ring_count == 1;
    self->owner_count = (uint32_t)to->ring_count;
    if (to->ring_count > 1) {
        if (!(self->tops = camber_alloc(self->context, to->ring_count, sizeof *self->tops)))
            return false;
        for (size_t r = 0; r < to->ring_count; r++)
            self->tops[r] = key_of(to->places[to->rings[r].first]);
        if (!find_odd(self, &known))
            return false;
    }
    for (size_t r = 0, at = 0; r < to->ring_count; r++) {
        camber_osm_ring *ring = &to->rings[r];
        const camber_osm_role role = self->odd && self->odd[r] ? CAMBER_OSM_ROLE_INNER : CAMBER_OSM_ROLE_OUTER;
        const size_t first = at;
        bool differs = known && ring->role != role && ring->role != CAMBER_OSM_ROLE_UNKNOWN;
        while (at < self->edge_count && self->edges[at].owner == r)
            at++;
        if (differs && at > first && self->rows.row_count == 0 && !index_rows(self))
            return false;
        differs = differs && !crosses_others(self, first, at);
        ring->role = differs || ring->role == CAMBER_OSM_ROLE_UNKNOWN ? role : ring->role;
    }
    return true;
}

/* Whether a place occurs twice among a few places. Most relations are houses with a yard, for which it is not worth
 * making a table. */
static bool repeats_few(const camber_osm_assembly *to) {
    uint64_t keys[FEW_PLACES];
    size_t count = 0;
    for (size_t r = 0; r < to->ring_count; r++)
        for (size_t i = to->rings[r].first; i + 1 < to->rings[r].first + to->rings[r].count; i++) {
            bool found = false;
            for (size_t k = 0; k < count; k++)
                found |= keys[k] == to->places[i];
            if (found)
                return true;
            keys[count++] = to->places[i];
        }
    return false;
}

/* Whether a place occurs twice, in one ring or in two. Returns false if there is no memory. */
static bool find_repeated(const arranger *self, bool *repeats) {
    const camber_osm_assembly *to = self->to;
    size_t slots = 2 * FEW_PLACES;
    if (to->place_count <= FEW_PLACES) {
        *repeats = repeats_few(to);
        return true;
    }
    while (slots < 2 * to->place_count)
        slots *= 2;
    uint64_t *table = camber_alloc_zero(self->context, slots, sizeof *table); /* no place has the key 0 */
    if (!table)
        return false;
    *repeats = false;
    for (size_t r = 0; r < to->ring_count && !*repeats; r++)
        for (size_t i = to->rings[r].first; i + 1 < to->rings[r].first + to->rings[r].count && !*repeats; i++) {
            const uint64_t key = key_of(to->places[i]);
            size_t slot = (size_t)camber_mix(0, key) & (slots - 1);
            while (table[slot] && table[slot] != key)
                slot = (slot + 1) & (slots - 1);
            *repeats = table[slot] != 0;
            table[slot] = key;
        }
    camber_free(self->context, table);
    return true;
}

/* ---- The drawing ---- */

static int compare_edges(const void *left, const void *right) {
    const edge *a = left, *b = right;
    for (int k = 0; k < 2; k++)
        if (a->ends[k] != b->ends[k])
            return a->ends[k] < b->ends[k] ? -1 : 1;
    return 0;
}

/* Drops pairs of equal edges, which bound nothing. */
static void drop_pairs(arranger *self) {
    size_t kept = 0;
    qsort(self->edges, self->edge_count, sizeof *self->edges, compare_edges);
    for (size_t i = 0, end; i < self->edge_count; i = end) {
        for (end = i + 1; end < self->edge_count && compare_edges(&self->edges[i], &self->edges[end]) == 0;)
            end++;
        if ((end - i) % 2)
            self->edges[kept++] = self->edges[i];
    }
    self->edge_count = kept;
}

/* Whether a half-edge goes east or straight north. At the westernmost place of a part, all half-edges do, and the first
 * one is next to the outside of the part. */
static bool goes_east(const half_edge *half) {
    return half->to > half->from;
}

static int compare_halves(const void *left, const void *right) {
    const half_edge *a = left, *b = right;
    if (a->from != b->from)
        return a->from < b->from ? -1 : 1;
    if (goes_east(a) != goes_east(b))
        return goes_east(a) ? -1 : 1;
    const double x = x_of(a->from), y = y_of(a->from);
    const double turn = (x_of(a->to) - x) * ((double)y_of(b->to) - y) - (x_of(b->to) - x) * ((double)y_of(a->to) - y);
    return turn > 0.0 ? -1 : turn < 0.0 ? 1 : a->to < b->to ? -1 : a->to > b->to;
}

static bool make_halves(arranger *self) {
    camber_context *context = self->context;
    self->half_count = 2 * self->edge_count;
    const size_t count = self->half_count;
    uint32_t *at = camber_alloc(context, count, sizeof *at); /* by edge: the indices of its two half-edges */
    if (!at)
        return false;
    if (!(self->halves = camber_alloc(context, count, sizeof *self->halves)) ||
        !(self->twins = camber_alloc(context, count, sizeof *self->twins)) ||
        !(self->nodes = camber_alloc(context, count, sizeof *self->nodes)) ||
        !(self->first = camber_alloc(context, count + 1, sizeof *self->first)) ||
        !(self->parts = camber_alloc(context, count, sizeof *self->parts)) ||
        !(self->leaves = camber_alloc(context, count, 1)) ||
        !(self->stack = camber_alloc(context, count, sizeof *self->stack)) ||
        !(self->walked = camber_alloc(context, count, sizeof *self->walked)) ||
        !(self->tops = camber_alloc(context, count, sizeof *self->tops))) {
        camber_free(context, at);
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        const edge *line = &self->edges[i / 2];
        self->halves[i] = (half_edge){line->ends[i % 2], line->ends[1 - i % 2], (uint32_t)(i / 2)};
    }
    qsort(self->halves, count, sizeof *self->halves, compare_halves);
    for (size_t i = 0; i < count; i++) {
        if (i == 0 || self->halves[i].from != self->halves[i - 1].from)
            self->first[self->node_count++] = (uint32_t)i;
        self->nodes[i] = self->node_count - 1;
        at[2 * self->halves[i].edge + !goes_east(&self->halves[i])] = (uint32_t)i;
    }
    self->first[self->node_count] = (uint32_t)count;
    for (size_t i = 0; i < count; i++)
        self->twins[i] = at[2 * self->halves[i].edge + goes_east(&self->halves[i])];
    memset(self->parts, 0xff, count * sizeof *self->parts);
    memset(self->walked, 0xff, count * sizeof *self->walked);
    memset(self->leaves, 2, count);
    camber_free(context, at);
    return true;
}

/* Numbers the connected parts of the drawing from west to east. */
static void find_parts(arranger *self) {
    for (uint32_t n = 0; n < self->node_count; n++) {
        if (self->parts[n] != NONE)
            continue;
        size_t depth = 0;
        self->tops[self->owner_count] = self->halves[self->first[n]].from;
        self->parts[n] = self->owner_count;
        self->stack[depth++] = n;
        while (depth) {
            const uint32_t at = self->stack[--depth];
            for (uint32_t i = self->first[at]; i < self->first[at + 1]; i++) {
                const uint32_t next = self->nodes[self->twins[i]];
                self->edges[self->halves[i].edge].owner = self->owner_count;
                if (self->parts[next] != NONE)
                    continue;
                self->parts[next] = self->owner_count;
                self->stack[depth++] = next;
            }
        }
        self->owner_count++;
    }
}

/* Directs the half-edges around a node, of which one is directed already. Sectors inside and outside alternate, and so
 * do the directions. */
static void direct_node(arranger *self, uint32_t half) {
    const uint32_t node = self->nodes[half];
    for (uint32_t i = self->first[node]; i < self->first[node + 1]; i++)
        self->leaves[i] = self->leaves[half] ^ ((i ^ half) & 1);
}

/* Directs all edges so that the inside is on their right. Returns false if edges cross, or if an edge ends without a
 * continuation. */
static bool direct_edges(arranger *self) {
    for (uint32_t n = 0; n < self->node_count; n++) {
        uint32_t half = self->first[n];
        size_t depth = 0;
        if ((self->first[n + 1] - half) % 2)
            return false;
        if (self->leaves[half] != 2)
            continue;
        /* This is the westernmost node of its part. The surroundings of the part are to the right of its first
         * half-edge. */
        self->leaves[half] = self->odd[self->parts[n]];
        direct_node(self, half);
        self->stack[depth++] = n;
        while (depth) {
            const uint32_t at = self->stack[--depth];
            for (half = self->first[at]; half < self->first[at + 1]; half++) {
                const uint32_t twin = self->twins[half];
                if (self->leaves[twin] == self->leaves[half])
                    return false;
                if (self->leaves[twin] != 2)
                    continue;
                self->leaves[twin] = !self->leaves[half];
                direct_node(self, twin);
                self->stack[depth++] = self->nodes[twin];
            }
        }
    }
    return true;
}

/* Makes a ring from the half-edges of the walk from index `from` to before `end`. */
static bool take_ring(arranger *self, size_t from, size_t end) {
    camber_osm_assembly *to = self->to;
    camber_osm_ring ring = {.first = to->place_count, .count = end - from + 1};
    double area = 0.0;
    if (!camber_grow(to->context, &to->places, &to->place_capacity, to->place_count + ring.count, sizeof *to->places) ||
        !camber_grow(to->context, &to->rings, &to->ring_capacity, to->ring_count + 1, sizeof *to->rings))
        return false;
    const uint64_t start = self->halves[self->stack[from]].from;
    for (size_t i = from; i < end; i++) {
        const half_edge *half = &self->halves[self->stack[i]];
        area += (x_of(half->from) - x_of(start)) * ((double)y_of(half->to) - y_of(start)) -
                (x_of(half->to) - x_of(start)) * ((double)y_of(half->from) - y_of(start));
        self->walked[self->nodes[self->stack[i]]] = NONE;
        to->places[to->place_count++] = key_of(half->from);
    }
    to->places[to->place_count++] = key_of(start);
    ring.role = area < 0.0 ? CAMBER_OSM_ROLE_OUTER : CAMBER_OSM_ROLE_INNER;
    to->rings[to->ring_count++] = ring;
    return true;
}

/* Follows all half-edges along which rings leave their places, and takes the rings out of the walk. */
static bool walk(arranger *self) {
    for (size_t start = 0; start < self->half_count; start++) {
        size_t depth = 0;
        for (uint32_t half = (uint32_t)start; self->leaves[half] == 1;) {
            const uint32_t node = self->nodes[half], before = self->walked[node], twin = self->twins[half];
            if (before != NONE) {
                if (!take_ring(self, before, depth))
                    return false;
                depth = before;
            }
            self->walked[node] = (uint32_t)depth;
            self->stack[depth++] = half;
            self->leaves[half] = 3; /* already followed */
            const uint32_t arrived = self->nodes[twin];
            half = twin + 1 < self->first[arrived + 1] ? twin + 1 : self->first[arrived];
        }
        if (depth && !take_ring(self, 0, depth))
            return false;
    }
    return true;
}

/* Splits the rings into edges and makes new rings from them. If edges cross, the rings stay as they are. */
static bool redraw(arranger *self) {
    bool known = false;
    drop_pairs(self);
    if (self->edge_count) {
        if (!make_halves(self))
            return false;
        find_parts(self);
        if (!find_odd(self, &known))
            return false;
        if (!known || !direct_edges(self))
            return true;
    }
    self->to->place_count = self->to->ring_count = 0;
    return walk(self);
}

static void free_all(arranger *self) {
    camber_context *context = self->context;
    camber_free(context, self->walked);
    camber_free(context, self->stack);
    camber_free(context, self->leaves);
    camber_free(context, self->parts);
    camber_free(context, self->first);
    camber_free(context, self->nodes);
    camber_free(context, self->twins);
    camber_free(context, self->halves);
    camber_free(context, self->rows.items);
    camber_free(context, self->rows.first);
    camber_free(context, self->odd);
    camber_free(context, self->tops);
    camber_free(context, self->edges);
}

camber_status camber_osm_arrange(camber_osm_assembly *assembly) {
    arranger self = {.to = assembly, .context = assembly->context};
    bool repeats = false;
    if (assembly->ring_count == 0 || assembly->place_count >= UINT32_MAX / 2)
        return CAMBER_OK;
    bool done = find_repeated(&self, &repeats);
    if (done && (repeats || assembly->ring_count > 1))
        done = list_edges(&self);
    if (done)
        done = repeats ? redraw(&self) : find_roles(&self);
    free_all(&self);
    return done ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}
