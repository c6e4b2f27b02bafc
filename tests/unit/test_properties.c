/* Properties of meshes: what must hold for the vertices and indices of any polyline. */
#include "property.h"

#include "kernels/join.h"
#include "vertices/vertices.h"

/* ---- Meshes of cases ---- */

static camber_stages stages_of(camber_context *context, const property_case *c) {
    const camber_tessellation_desc desc = {&c->stroke, 1, c->method, 0, false};
    camber_polylines *polylines = property_polylines(context, c);
    camber_stages stages;
    assert_int_equal(camber_stages_tessellate(context, polylines, &desc, &stages), CAMBER_OK);
    camber_polylines_destroy(polylines);
    return stages;
}

static uint32_t kind_of(const camber_point_stages *point) {
    return camber_join_kind(point->join);
}

/* ---- Well-formed: indices, restarts, ranges ---- */

static bool is_bad(char story[PROPERTY_STORY], const char *what, size_t at, double value) {
    snprintf(story, PROPERTY_STORY, "%s at %zu: %.9g", what, at, value);
    return true;
}

static bool has_bad_indices(const camber_mesh_data *data, char story[PROPERTY_STORY]) {
    const camber_mesh_info *info = &data->info;
    bool *used = calloc(info->vertex_count + 1, sizeof *used);
    assert_non_null(used);
    bool bad = false;
    size_t run = 0;
    if (!info->strips && info->index_count % 3 != 0)
        bad = is_bad(story, "indices that are no triangles", info->index_count, 0);
    for (size_t i = 0; i < info->index_count && !bad; i++) {
        const uint32_t index = data->indices[i];
        const bool restart = info->strips && index == CAMBER_RESTART_INDEX;
        if (!restart && index >= info->vertex_count)
            bad = is_bad(story, "an index past the vertices", i, index);
        else if (info->strips && i == 0 && !restart)
            bad = is_bad(story, "no restart before the first strip", i, index);
        else if (restart && i > 1 && run > 0 && run < 4)
            bad = is_bad(story, "a strip of less than four vertices before", i, (double)run);
        else if (!restart)
            used[index] = true;
        run = restart ? 0 : run + 1;
    }
    if (info->strips && info->index_count > 0 && run < 4)
        bad = bad || is_bad(story, "a last strip of less than four vertices", info->index_count, (double)run);
    for (size_t i = 0; i < info->vertex_count && !bad; i++)
        bad = !used[i] && is_bad(story, "a vertex of no triangle", i, 0);
    free(used);
    return bad;
}

/* The ends that a stroke's segments may have, as a set of bits. */
static unsigned ends_at_joins(const property_case *c) {
    const bool strip = c->method == CAMBER_METHOD_STRIP;
    switch (c->stroke.join) {
    case CAMBER_JOIN_ROUND: return 1u << CAMBER_END_ROUND | (strip ? 1u << CAMBER_END_SPLIT_ROUND : 0);
    case CAMBER_JOIN_MITER:
        return 1u << CAMBER_END_MITER | 1u << CAMBER_END_BEVEL |
               (strip ? 1u << CAMBER_END_SPLIT_MITER | 1u << CAMBER_END_SPLIT_BEVEL : 0);
    case CAMBER_JOIN_BEVEL: return 1u << CAMBER_END_BEVEL | (strip ? 1u << CAMBER_END_SPLIT_BEVEL : 0);
    }
    return 0;
}

static bool has_bad_end(const property_case *c, unsigned end, int turn) {
    static const camber_end caps[] = {CAMBER_END_BUTT, CAMBER_END_ROUND, CAMBER_END_SQUARE};
    return turn == 0 ? end != (unsigned)caps[c->stroke.cap] : !(ends_at_joins(c) >> end & 1u);
}

static bool has_bad_vertex(const property_case *c, const camber_vertex *v, size_t i, char story[PROPERTY_STORY]) {
    const float floats[] = {v->x, v->y, v->dx, v->dy, v->along, v->limit_px};
    /* The vertices of a fan lie where chords touch the arc: farther out, by 1 / cos(45 degrees) at most. */
    const int across_most = c->method == CAMBER_METHOD_FAN ? 23171 : 16384;
    for (size_t k = 0; k < sizeof floats / sizeof *floats; k++)
        if (!isfinite(floats[k]))
            return is_bad(story, "a float that is no number", i, (double)k);
    if (!(v->limit_px >= 0))
        return is_bad(story, "a limit below nothing", i, (double)v->limit_px);
    if (abs(v->across) > across_most)
        return is_bad(story, "across out of range", i, v->across);
    if (v->flags >> 9)
        return is_bad(story, "unknown flags", i, v->flags);
    if (v->turn_a < -32767 || v->turn_b < -32767)
        return is_bad(story, "a turn out of range", i, v->turn_a);
    if (v->row != 0)
        return is_bad(story, "a row that was not given", i, v->row);
    return false;
}

/* Whether a vertex that a triangle ends with carries a segment of the polyline, with ends that its stroke has. */
static bool is_segment(const property_case *c, const camber_vertex *v) {
    const bool at_end = (v->flags >> 6 & 1u) != 0;
    /* Known: where a ring closes, the join of kite and fan draws the first segment without knowing its other end. */
    const bool at_seam = property_is_ring(c) && c->method != CAMBER_METHOD_STRIP && !at_end && v->turn_b == 0 &&
                         v->x == c->points[0] && v->y == c->points[1];
    if (has_bad_end(c, v->flags & 7u, v->turn_a) || (!at_seam && has_bad_end(c, v->flags >> 3 & 7u, v->turn_b)))
        return false;
    for (size_t i = 0; i + 1 < c->count; i++) {
        const float *p = c->points + 2 * i, *end = at_end ? p + 2 : p;
        const bool open = !property_is_ring(c);
        const unsigned line_ends = (open && i == 1 ? 1u : 0u) | (open && i + 3 == c->count ? 2u : 0u);
        if (v->x == end[0] && v->y == end[1] && v->dx == p[2] - p[0] && v->dy == p[3] - p[1] &&
            v->flags >> 7 == line_ends)
            return true;
    }
    return v->dx == 0 && v->dy == 0; /* a dot */
}

/* As camber_polylines_create keeps them. */
static property_case without_repeats(const property_case *c) {
    property_case kept = *c;
    kept.count = 0;
    for (size_t i = 0; i < c->count; i++)
        if (i == 0 || memcmp(c->points + 2 * i, c->points + 2 * (i - 1), 2 * sizeof *c->points) != 0)
            memcpy(kept.points + 2 * kept.count++, c->points + 2 * i, 2 * sizeof *c->points);
    return kept;
}

static property_outcome check_well_formed(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    const property_bench *b = user;
    camber_mesh_data data = property_mesh(b->context, c);
    bool bad = has_bad_indices(&data, story);
    for (size_t i = 0; i < data.info.vertex_count && !bad; i++)
        bad = has_bad_vertex(c, &data.vertices[i], i, story);
    uint32_t(*triangles)[3];
    const size_t count = property_triangles(&data, &triangles);
    const property_case kept = without_repeats(c);
    if (!bad && count != data.info.triangle_count)
        bad = is_bad(story, "another number of triangles", count, (double)data.info.triangle_count);
    for (size_t i = 0; i < count && !bad; i++)
        if (!is_segment(&kept, &data.vertices[triangles[i][2]]))
            bad = is_bad(story, "a triangle whose last vertex carries no segment of the line", i, triangles[i][2]);
    free(triangles);
    camber_mesh_data_destroy(&data);
    return bad ? PROPERTY_BROKEN : PROPERTY_HOLDS;
}

/* ---- Winding ---- */

/* All triangles of all meshes wind the same way or have no area, at the widest and at smaller widths, tight joins
 * included. Less than the rounding of a vertex' floats makes is no area. */
static property_outcome check_winding(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    const property_bench *b = user;
    camber_mesh_data data = property_mesh(b->context, c);
    uint32_t(*triangles)[3];
    const size_t count = property_triangles(&data, &triangles);
    const double widths_px[] = {(double)c->stroke.width_px, 0.3 * (double)c->stroke.width_px, 0};
    bool bad = false;
    for (size_t i = 0; i < 3 * count && !bad; i++) {
        double p[3][2], longest = 0;
        for (int k = 0; k < 3; k++)
            property_place(&data.vertices[triangles[i / 3][k]], widths_px[i % 3], p[k]);
        for (int k = 0; k < 3; k++)
            longest = fmax(longest, hypot(p[k][0] - p[(k + 1) % 3][0], p[k][1] - p[(k + 1) % 3][1]));
        /* Floats, and a turn that is stored to 6e-5 radians. */
        const double rounding = 1e-3 * longest + 1.5e-4 * longest * longest;
        const double area = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
        if (area < -rounding) {
            snprintf(story, PROPERTY_STORY, "triangle %zu winds the other way at %.2f px: area %.4f", i / 3,
                     widths_px[i % 3], area / 2);
            bad = true;
        }
    }
    free(triangles);
    camber_mesh_data_destroy(&data);
    return count == 0 ? PROPERTY_SILENT : bad ? PROPERTY_BROKEN : PROPERTY_HOLDS;
}

/* ---- Reversed ---- */

typedef struct place {
    double x, y;
} place;

/* The vertices that triangles use, and no others. */
static size_t places_of(camber_context *context, const property_case *c, place **places) {
    camber_mesh_data data = property_mesh(context, c);
    const size_t count = data.info.vertex_count;
    bool *used = calloc(count + 1, sizeof *used);
    *places = malloc((count + 1) * sizeof **places);
    assert_true(used && *places);
    for (size_t i = 0; i < data.info.index_count; i++)
        if (data.indices[i] != CAMBER_RESTART_INDEX)
            used[data.indices[i]] = true;
    size_t written = 0;
    for (size_t i = 0; i < count; i++) {
        double at[2];
        property_place(&data.vertices[i], (double)c->stroke.width_px, at);
        if (used[i])
            (*places)[written++] = (place){at[0], at[1]};
    }
    free(used);
    camber_mesh_data_destroy(&data);
    return written;
}

/* A line that turns by less than a bit says nothing of the side it turns to. */
static bool has_straight_join(camber_context *context, const property_case *c) {
    camber_stages stages = stages_of(context, c);
    bool straight = false;
    for (size_t i = 0; i < stages.point_count && !straight; i++)
        straight = abs((int16_t)(stages.points[i].join & 0xffffu)) == 1;
    camber_stages_destroy(&stages);
    return straight;
}

/* How far rounding may move a vertex. Half turns are stored to 3e-5 radians; their tangent moves by that over the
 * square of their cosine, which is 1 over the miter limit or the root of 5 at the least. */
static double rounding_px(const property_case *c) {
    const double limit = c->stroke.join == CAMBER_JOIN_MITER ? (double)c->stroke.miter_limit : 0;
    const double reach = (double)c->stroke.width_px / 2 + (double)CAMBER_PAD_PX;
    return 3.1e-5 * reach * fmax(5, limit * limit) + 5e-4;
}

/* Each place takes the nearest of the others that is left. */
static size_t unmatched(const place *a, place *b, size_t count, double near_px) {
    size_t missing = 0;
    for (size_t i = 0; i < count; i++) {
        size_t nearest = i;
        for (size_t k = i; k < count; k++)
            if (hypot(a[i].x - b[k].x, a[i].y - b[k].y) < hypot(a[i].x - b[nearest].x, a[i].y - b[nearest].y))
                nearest = k;
        missing += hypot(a[i].x - b[nearest].x, a[i].y - b[nearest].y) > near_px;
        const place taken = b[nearest];
        b[nearest] = b[i];
        b[i] = taken;
    }
    return missing;
}

/* The same places, as often, whichever end the line begins at. Not the chords of a fan, which are counted from the
 * segment that comes in; nor rings of kite and fan, which have an edge vertex of the segment that begins them twice. */
static property_outcome check_reversed(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    const property_bench *b = user;
    property_case turned = *c;
    place *there, *back;
    if ((c->method == CAMBER_METHOD_FAN && c->stroke.join == CAMBER_JOIN_ROUND) ||
        (c->method != CAMBER_METHOD_STRIP && property_is_ring(c)) || has_straight_join(b->context, c))
        return PROPERTY_SILENT;
    property_reverse(&turned);
    const size_t count = places_of(b->context, c, &there), other = places_of(b->context, &turned, &back);
    const size_t missing = count == other ? unmatched(there, back, count, rounding_px(c)) : count;
    if (missing > 0)
        snprintf(story, PROPERTY_STORY, "%zu of %zu vertices lie elsewhere (%zu reversed)", missing, count, other);
    free(there);
    free(back);
    return missing > 0 ? PROPERTY_BROKEN : PROPERTY_HOLDS;
}

/* ---- Rotated, scaled ---- */

/* Whether a point's kind hangs by a hair: half the shorter neighbour, 127 degrees, the miter limit. */
static bool is_near_threshold(const property_case *c, const camber_point_stages *p) {
    const double cosine = ((double)p[0].x - (double)p[-1].x) * ((double)p[1].x - (double)p[0].x) +
                          ((double)p[0].y - (double)p[-1].y) * ((double)p[1].y - (double)p[0].y);
    const double in = hypot((double)p[0].x - (double)p[-1].x, (double)p[0].y - (double)p[-1].y);
    const double out = hypot((double)p[1].x - (double)p[0].x, (double)p[1].y - (double)p[0].y);
    const double half = acos(fmax(-1, fmin(1, cosine / (in * out)))) / 2, slack = 0.002;
    const double reach = (double)c->stroke.width_px / 2 + (double)CAMBER_PAD_PX;
    const double limit = c->stroke.miter_limit > 0 ? (double)c->stroke.miter_limit : 2;
    const double room = fmin(in, out) / 2, needed = reach * tan(half);
    return fabs(needed - room) <= slack * (needed + room) || fabs(tan(half) - 2) < slack * 8 ||
           fabs(tan(half) - sqrt(3)) < slack * 8 || half < slack || fabs(limit * cos(half) - 1) < slack * 4;
}

/* Compares what classify says of two polylines of as many points; kinds only away from where they change. */
static bool differ(const property_case *c, const camber_stages *a, const camber_stages *b, int bits,
                   char story[PROPERTY_STORY]) {
    const bool ring = property_is_ring(c);
    if (a->point_count != b->point_count)
        return is_bad(story, "other points", a->point_count, (double)b->point_count);
    for (size_t i = 0; i < a->point_count; i++) {
        const camber_point_stages *p = a->points + i, *q = b->points + i;
        const int apart = (int)(int16_t)(p->join & 0xffffu) - (int)(int16_t)(q->join & 0xffffu);
        const bool inner = i > 0 && i + 1 < a->point_count;
        if (abs(apart) > bits && abs(apart) < 65530) /* a reversal turns to either side */
            return is_bad(story, "another turn, by bits,", i, apart);
        /* How many chords a fan has hangs by a hair at every step, as the stub of a strip does. */
        const uint32_t mask = c->method == CAMBER_METHOD_KITE ? ~0u : ~(127u << CAMBER_JOIN_TRIANGLES_SHIFT);
        if (((p->join ^ q->join) & mask) >> 16 && (inner ? !is_near_threshold(c, p) : !ring))
            return is_bad(story, "another join", i, (double)(p->join >> 16));
    }
    return false;
}

/* A turn of the plane leaves kinds and ends of joins as they are, and moves the turns by a bit: coordinates are rounded
 * to floats again, 2^-18 px, which at a neighbour of 2 px is a third of a bit. */
static property_outcome check_rotated(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    const property_bench *b = user;
    uint64_t dice = c->dice | 1;
    const double angle = camber_random_between(&dice, -SCENE_PI, SCENE_PI);
    property_case turned = *c;
    for (size_t i = 0; i < c->count; i++) {
        const double x = (double)c->points[2 * i] - 64, y = (double)c->points[2 * i + 1] - 64;
        turned.points[2 * i] = (float)(64 + x * cos(angle) - y * sin(angle));
        turned.points[2 * i + 1] = (float)(64 + x * sin(angle) + y * cos(angle));
        if (i > 0 && hypot((double)(c->points[2 * i] - c->points[2 * i - 2]),
                           (double)(c->points[2 * i + 1] - c->points[2 * i - 1])) < 2)
            return PROPERTY_SILENT;
    }
    camber_stages before = stages_of(b->context, c), after = stages_of(b->context, &turned);
    const bool bad = differ(c, &before, &after, 1, story);
    camber_stages_destroy(&before);
    camber_stages_destroy(&after);
    return bad ? PROPERTY_BROKEN : PROPERTY_HOLDS;
}

/* Line and width twice as large. The pad stays, and so fewer joins are tight: it speaks of those lines where none
 * changes. Then every vertex has its place's and segment's floats doubled, and turns, ends and shares of the reach the
 * same to the last bit; limits, which are pads or half lengths, grow by no more. */
static property_outcome check_scaled(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    const property_bench *b = user;
    property_case twice = *c;
    for (size_t i = 0; i < 2 * c->count; i++)
        twice.points[i] *= 2;
    twice.stroke.width_px *= 2;
    camber_stages small = stages_of(b->context, c), large = stages_of(b->context, &twice);
    bool same_kinds = small.point_count == large.point_count, bad = false;
    for (size_t i = 0; i < small.point_count && same_kinds && !bad; i++) {
        same_kinds = kind_of(small.points + i) == kind_of(large.points + i);
        if ((small.points[i].join & 0xffffu) != (large.points[i].join & 0xffffu))
            bad = is_bad(story, "another turn", i, (double)(small.points[i].join & 0xffffu));
    }
    camber_stages_destroy(&small);
    camber_stages_destroy(&large);
    if (!same_kinds || c->method == CAMBER_METHOD_FAN) /* whose steps come from a tolerance in px */
        return bad ? PROPERTY_BROKEN : PROPERTY_SILENT;
    camber_mesh_data one = property_mesh(b->context, c), two = property_mesh(b->context, &twice);
    for (size_t i = 0; i < one.info.vertex_count && !bad; i++) {
        const camber_vertex *v = one.vertices + i, *w = two.vertices + i;
        if (w->x != 2 * v->x || w->y != 2 * v->y || w->dx != 2 * v->dx || w->dy != 2 * v->dy)
            bad = is_bad(story, "a vertex not twice as far", i, (double)w->x);
        else if (v->along != w->along || v->across != w->across || v->flags != w->flags || v->turn_a != w->turn_a ||
                 v->turn_b != w->turn_b)
            bad = is_bad(story, "another extrusion, flag or turn", i, (double)w->along);
        else if (w->limit_px < v->limit_px || /* steps of the pad / 127 */
                 (w->limit_px > 2 * v->limit_px + CAMBER_PAD_PX / 126 && w->limit_px != v->limit_px))
            bad = is_bad(story, "a limit that does not grow with the line", i, (double)w->limit_px);
    }
    camber_mesh_data_destroy(&one);
    camber_mesh_data_destroy(&two);
    return bad ? PROPERTY_BROKEN : PROPERTY_HOLDS;
}

/* ---- The list ---- */

static void test_well_formed(void **state) {
    property_check(&(property){"well-formed", property_make_any, check_well_formed, 20000, 0}, *state);
}

static void test_winding(void **state) {
    property_check(&(property){"winding", property_make_any, check_winding, 20000, 0}, *state);
}

static void test_reversed(void **state) {
    property_check(&(property){"reversed, plain joins", property_make_plain, check_reversed, 20000, 0}, *state);
}

static void test_reversed_any(void **state) {
    property_check(&(property){"reversed, any joins", property_make_any, check_reversed, 20000, 0}, *state);
}

static void test_rotated(void **state) {
    property_check(&(property){"rotated", property_make_any, check_rotated, 20000, 0}, *state);
}

static void test_scaled(void **state) {
    property_check(&(property){"scaled", property_make_any, check_scaled, 20000, 0}, *state);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_well_formed),  cmocka_unit_test(test_winding), cmocka_unit_test(test_reversed),
        cmocka_unit_test(test_reversed_any), cmocka_unit_test(test_rotated), cmocka_unit_test(test_scaled),
    };
    return cmocka_run_group_tests(tests, property_set_up, property_tear_down);
}
