/* Assembles the rings of a multipolygon from its ways.
 *
 * Input: ways, closed or not, in any order and direction, with or without roles. Output: rings, outer ones first. The
 * main idea is to walk from way to way through the places at which they end. If a walk returns to a place where it was
 * before, it has found a ring, which is removed from the walk; so rings that touch each other stay separate. The first
 * walks use only ways with the same role, and the last ones use all ways that are left. If no way is missing and all of
 * them form rings, their geometry decides which rings are holes (planar.h). Otherwise the roles of the ways decide, and
 * a ring without a role is a hole if an odd number of other rings contain it. Time is linear in the number of places,
 * apart from sorting the ends and testing the rings without a role. */
#include "osm/assemble.h"

#include "osm/node_set.h"
#include "osm/planar.h"

#include <stdlib.h>
#include <string.h>

#define NONE UINT32_MAX

/* An end of a piece: end 2 * piece is the first place of the piece, and end 2 * piece + 1 is its last place. */
typedef struct piece_end {
    uint64_t place;
    uint32_t end;
} piece_end;

typedef struct walker {
    camber_osm_assembly *to;
    const camber_osm_piece *pieces;
    size_t count;
    piece_end *ends;      /* 2 * count, sorted by place */
    uint32_t *nodes;      /* by end: its node, which is the index of its place among the distinct places of all ends */
    uint32_t *first_ends; /* by node: index into ends, and one more entry at the end */
    uint32_t *next_ends;  /* by node: the first of its ends that a walk of the current role may still use */
    uint32_t *walked;     /* by node: its position on the walk; NONE: it is not on the walk */
    uint32_t *walk;       /* the ends at which the walk enters pieces */
    uint32_t walk_count;
    uint8_t *states; /* by piece */
} walker;

enum { FREE = 0, WALKED, IN_RING };

/* Limits for finding out which rings contain others: the compared pairs of rings per relation, and the examined places
 * per file. If one is exceeded, rings without a role become outer rings. Only malicious files exceed them. */
static const size_t MOST_COMPARED = (size_t)1 << 20, MOST_PLACES = (size_t)1 << 28;

static int compare_ends(const void *left, const void *right) {
    const piece_end *a = left, *b = right;
    if (a->place != b->place)
        return a->place < b->place ? -1 : 1;
    return a->end < b->end ? -1 : a->end > b->end;
}

static void number_nodes(walker *self) {
    uint32_t nodes = 0;
    for (size_t i = 0; i < self->count; i++)
        for (uint32_t k = 0; k < 2; k++) {
            const camber_osm_piece *piece = &self->pieces[i];
            self->ends[2 * i + k] = (piece_end){piece->places[k ? piece->count - 1 : 0], (uint32_t)(2 * i) + k};
        }
    qsort(self->ends, 2 * self->count, sizeof *self->ends, compare_ends);
    for (size_t i = 0; i < 2 * self->count; i++) {
        if (i == 0 || self->ends[i].place != self->ends[i - 1].place)
            self->first_ends[nodes++] = (uint32_t)i;
        self->nodes[self->ends[i].end] = nodes - 1;
    }
    self->first_ends[nodes] = (uint32_t)(2 * self->count);
}

/* ---- Rings ---- */

static bool add_places(camber_osm_assembly *to, const camber_osm_piece *piece, bool backwards) {
    /* A place that two pieces share is kept once. The first place closes the ring at the end. */
    if (!camber_grow(to->context, &to->places, &to->place_capacity, to->place_count + piece->count, sizeof *to->places))
        return false;
    for (uint32_t i = 0; i + 1 < piece->count; i++)
        to->places[to->place_count++] = piece->places[backwards ? piece->count - 1 - i : i];
    return true;
}

/* Makes a ring from the pieces that the walk entered at position `from` and later. */
static bool add_ring(walker *self, uint32_t from) {
    camber_osm_assembly *to = self->to;
    camber_osm_ring ring = {.first = to->place_count, .role = self->pieces[self->walk[from] / 2].role};
    for (uint32_t i = from; i < self->walk_count; i++) {
        const camber_osm_piece *piece = &self->pieces[self->walk[i] / 2];
        self->walked[self->nodes[self->walk[i]]] = NONE;
        self->states[self->walk[i] / 2] = IN_RING;
        ring.role = piece->role == ring.role ? ring.role : CAMBER_OSM_ROLE_UNKNOWN;
        if (!add_places(to, piece, self->walk[i] & 1))
            return false;
    }
    self->walk_count = from;
    if (!camber_grow(to->context, &to->places, &to->place_capacity, to->place_count + 1, sizeof *to->places) ||
        !camber_grow(to->context, &to->rings, &to->ring_capacity, to->ring_count + 1, sizeof *to->rings))
        return false;
    to->places[to->place_count] = to->places[ring.first];
    ring.count = ++to->place_count - ring.first;
    to->rings[to->ring_count++] = ring;
    return true;
}

/* ---- Walking ---- */

/* Finds a piece that continues from a node, and returns the end at which the walk enters it. If role is NONE, the piece
 * may have any role. */
static uint32_t find_next(walker *self, uint32_t node, uint32_t role) {
    for (uint32_t i = self->next_ends[node]; i < self->first_ends[node + 1]; i++) {
        const uint32_t piece = self->ends[i].end / 2;
        self->next_ends[node] = i;
        if (self->states[piece] == FREE && (role == NONE || self->pieces[piece].role == (camber_osm_role)role))
            return self->ends[i].end;
    }
    return NONE;
}

/* Walks on from a piece, and backs out of dead ends. */
static bool walk_from(walker *self, uint32_t piece, uint32_t role) {
    uint32_t at = self->nodes[2 * piece], next = 2 * piece;
    for (self->walk_count = 0;; next = find_next(self, at, role)) {
        if (next == NONE) {
            if (self->walk_count == 0)
                return true;
            at = self->nodes[self->walk[--self->walk_count]];
            self->walked[at] = NONE;
            continue;
        }
        self->states[next / 2] = WALKED;
        self->walked[at] = self->walk_count;
        self->walk[self->walk_count++] = next;
        at = self->nodes[next ^ 1];
        if (self->walked[at] != NONE && !add_ring(self, self->walked[at]))
            return false;
    }
}

/* Makes rings from the pieces with a role, or from all pieces if it is NONE. Afterwards, pieces that are in no ring may
 * be used again. */
static bool walk_role(walker *self, uint32_t role) {
    memcpy(self->next_ends, self->first_ends, 2 * self->count * sizeof *self->next_ends);
    for (uint32_t i = 0; i < self->count; i++)
        if (self->states[i] == FREE && (role == NONE || self->pieces[i].role == (camber_osm_role)role) &&
            !walk_from(self, i, role))
            return false;
    self->to->open = false;
    for (size_t i = 0; i < self->count; i++) {
        self->states[i] = self->states[i] == IN_RING ? IN_RING : FREE;
        self->to->open = self->to->open || self->states[i] == FREE;
    }
    return true;
}

/* ---- Roles ---- */

/* Returns 1 if a place is inside a ring, 0 if it is outside, and a negative number if it is on the ring. The result is
 * exact for rings smaller than about 9 degrees, because a double represents their products exactly. */
static int lies_in(const camber_osm_assembly *a, const camber_osm_ring *ring, uint64_t place) {
    const double x = camber_osm_longitude(place), y = camber_osm_latitude(place);
    bool inside = false;
    for (size_t i = ring->first; i + 1 < ring->first + ring->count; i++) {
        const double x0 = camber_osm_longitude(a->places[i]) - x, y0 = camber_osm_latitude(a->places[i]) - y,
                     x1 = camber_osm_longitude(a->places[i + 1]) - x, y1 = camber_osm_latitude(a->places[i + 1]) - y;
        const double side = x0 * y1 - x1 * y0;
        if (side == 0.0 && x0 * x1 + y0 * y1 <= 0.0)
            return -1;
        if ((y0 > 0.0) != (y1 > 0.0) && (side > 0.0) == (y1 > y0))
            inside = !inside;
    }
    return inside;
}

/* Whether a ring is inside another, judged by the first of its places that is not on the other ring. *left: how many
 * more places may be examined. */
static bool has_inside(const camber_osm_assembly *a, const camber_osm_ring *outer, const camber_osm_ring *ring,
                       size_t *left) {
    for (size_t i = ring->first; i<ring->first + ring->count && * left> outer->count; i++) {
        *left -= outer->count;
        const int inside = lies_in(a, outer, a->places[i]);
        if (inside >= 0)
            return inside > 0;
    }
    return false;
}

static int compare_rings(const void *left, const void *right) {
    const camber_osm_ring *a = left, *b = right;
    if (a->role != b->role)
        return a->role < b->role ? -1 : 1;
    return a->first < b->first ? -1 : a->first > b->first;
}

static void find_roles(camber_osm_assembly *a) {
    size_t unknown = 0, left = a->steps < MOST_PLACES ? MOST_PLACES - a->steps : 0;
    for (size_t i = 0; i < a->ring_count; i++)
        unknown += a->rings[i].role == CAMBER_OSM_ROLE_UNKNOWN;
    const bool compares = unknown <= MOST_COMPARED / (a->ring_count + 1);
    for (size_t i = 0; i < a->ring_count; i++) {
        size_t around = 0;
        if (a->rings[i].role != CAMBER_OSM_ROLE_UNKNOWN)
            continue;
        for (size_t k = 0; k < a->ring_count && compares && left > 0; k++, left--)
            around += k != i && has_inside(a, &a->rings[k], &a->rings[i], &left);
        a->rings[i].role = around % 2 ? CAMBER_OSM_ROLE_INNER : CAMBER_OSM_ROLE_OUTER;
    }
    a->steps = MOST_PLACES - left;
    if (a->ring_count)
        qsort(a->rings, a->ring_count, sizeof *a->rings, compare_rings);
}

camber_status camber_osm_assemble(camber_osm_assembly *assembly, const camber_osm_piece *pieces, size_t count,
                                  bool whole) {
    camber_context *context = assembly->context;
    walker self = {.to = assembly, .pieces = pieces, .count = count};
    camber_status status = CAMBER_ERROR_MEMORY;
    assembly->place_count = assembly->ring_count = 0;
    assembly->open = false;
    if (!(self.ends = camber_alloc(context, 2 * count, sizeof *self.ends)) ||
        !(self.nodes = camber_alloc(context, 2 * count, sizeof *self.nodes)) ||
        !(self.first_ends = camber_alloc(context, 2 * count + 1, sizeof *self.first_ends)) ||
        !(self.next_ends = camber_alloc(context, 2 * count, sizeof *self.next_ends)) ||
        !(self.walked = camber_alloc(context, 2 * count, sizeof *self.walked)) ||
        !(self.walk = camber_alloc(context, count, sizeof *self.walk)) ||
        !(self.states = camber_alloc_zero(context, count, sizeof *self.states)))
        goto done;
    memset(self.walked, 0xff, 2 * count * sizeof *self.walked);
    number_nodes(&self);
    if (!walk_role(&self, CAMBER_OSM_ROLE_OUTER) || !walk_role(&self, CAMBER_OSM_ROLE_INNER) || !walk_role(&self, NONE))
        goto done;
    status = whole && !assembly->open ? camber_osm_arrange(assembly) : CAMBER_OK;
    if (status == CAMBER_OK)
        find_roles(assembly);
done:
    camber_free(context, self.states);
    camber_free(context, self.walk);
    camber_free(context, self.walked);
    camber_free(context, self.next_ends);
    camber_free(context, self.first_ends);
    camber_free(context, self.nodes);
    camber_free(context, self.ends);
    return status;
}

void camber_osm_assembly_free(camber_osm_assembly *assembly) {
    camber_free(assembly->context, assembly->rings);
    camber_free(assembly->context, assembly->places);
    *assembly = (camber_osm_assembly){.context = assembly->context};
}
