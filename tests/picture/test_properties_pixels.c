/* Properties of pictures: the same stroke by other points, or elsewhere, is the same picture. */
#include "property_picture.h"

#include "kernels/join.h"
#include "validate/oracle.h"

enum { SIDE = PROPERTY_SIDE_PX };

/* Pixels that differ by more than so many levels. */
typedef struct apart {
    size_t pixels;
    int most, x, y;
} apart;

/* The place of a pixel of the first picture in the second. */
typedef struct mapping {
    int dx, dy;
    bool turned; /* by a right angle: x, y -> SIDE - 1 - y, x */
} mapping;

/* GL rounds vertices to 1/256 px, and fills what lies on an edge on one side of it only. */
static const double NEAR_PX = 1.0 / 64;

static double distance_px(const double a[2], const double b[2], double x, double y) {
    const double dx = b[0] - a[0], dy = b[1] - a[1], square = dx * dx + dy * dy;
    const double t = square > 0 ? fmax(0, fmin(1, ((x - a[0]) * dx + (y - a[1]) * dy) / square)) : 0;
    return hypot(x - a[0] - t * dx, y - a[1] - t * dy);
}

static bool is_on_edge(const camber_mesh_data *mesh, double width_px, double x, double y) {
    uint32_t(*triangles)[3];
    const size_t count = property_triangles(mesh, &triangles);
    bool near = false;
    for (size_t i = 0; i < 3 * count && !near; i++) {
        double a[2], b[2];
        property_place(mesh->vertices + triangles[i / 3][i % 3], width_px, a);
        property_place(mesh->vertices + triangles[i / 3][(i + 1) % 3], width_px, b);
        near = distance_px(a, b, x, y) < NEAR_PX;
    }
    free(triangles);
    return near;
}

/* Whether a pixel may be drawn by either of two segments: its centre lies on an edge of the mesh, or square to the end
 * of a segment, where the shader begins to look for the join. */
static bool is_tied(property_canvas *e, const property_case *c, int column, int row) {
    const double x = column + 0.5, y = row + 0.5;
    for (size_t i = 0; i + 1 < c->count; i++) {
        const float *p = c->points + 2 * i;
        const double dx = (double)(p[2] - p[0]), dy = (double)(p[3] - p[1]), length = hypot(dx, dy);
        const double along = ((x - (double)p[0]) * dx + (y - (double)p[1]) * dy) / length;
        if (fabs(along) < NEAR_PX || fabs(along - length) < NEAR_PX)
            return true;
    }
    camber_mesh_data mesh = property_mesh(e->fixture.context, c);
    const bool tied = is_on_edge(&mesh, (double)c->stroke.width_px, x, y);
    camber_mesh_data_destroy(&mesh);
    return tied;
}

typedef struct pair {
    const property_case *first, *second;
    mapping mapping;
    property_picture a, b;
} pair;

static apart compare(property_canvas *e, const pair *p, int levels) {
    const mapping m = p->mapping;
    apart d = {0};
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const int u = (m.turned ? SIDE - 1 - y : x) + m.dx, v = (m.turned ? x : y) + m.dy;
            const bool in = u >= 0 && v >= 0 && u < SIDE && v < SIDE;
            const int off = in ? abs(p->a.level[y * SIDE + x] - p->b.level[v * SIDE + u]) : 0;
            if (off > levels && levels > 0 && (is_tied(e, p->first, x, y) || is_tied(e, p->second, u, v)))
                continue;
            d.pixels += off > levels;
            if (off > d.most)
                d.most = off, d.x = x, d.y = y;
        }
    return d;
}

static property_outcome judge(property_canvas *e, const property_case *c, const property_case *other, mapping m,
                              int levels, char story[PROPERTY_STORY]) {
    static pair p;
    p.first = c, p.second = other, p.mapping = m;
    property_draw(e, c, &p.a);
    property_draw(e, other, &p.b);
    const apart d = compare(e, &p, levels);
    if (d.pixels == 0)
        return PROPERTY_HOLDS;
    snprintf(story, PROPERTY_STORY, "%zu pixels differ by more than %d, by up to %d at %d, %d", d.pixels, levels,
             d.most, d.x, d.y);
    return PROPERTY_BROKEN;
}

/* ---- The same stroke by other points ---- */

/* The chords of a fan belong to the segment that comes in, but for the last: its round joins look elsewhere for their
 * edge where the line is reversed. Strip and kite cut along the bisector. */
static bool has_chords(const property_case *c) {
    return c->method == CAMBER_METHOD_FAN && c->stroke.join == CAMBER_JOIN_ROUND;
}

static property_outcome check_reversed(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    property_case other = *c;
    property_reverse(&other);
    return has_chords(c) ? PROPERTY_SILENT : judge(user, c, &other, (mapping){0}, 1, story);
}

static camber_stages stages_of(const property_canvas *e, const property_case *c) {
    const camber_tessellation_desc desc = {&c->stroke, 1, c->method, 0, false};
    camber_polylines *polylines = property_polylines(e->fixture.context, c);
    camber_stages stages;
    assert_int_equal(camber_stages_tessellate(e->fixture.context, polylines, &desc, &stages), CAMBER_OK);
    camber_polylines_destroy(polylines);
    return stages;
}

/* A point in the middle of a segment: exact, since coordinates are multiples of 1/256. Its index, or 0: there is no
 * segment, or its halves would be shorter than a pixel; only the last of such pieces knows of the cap. */
static size_t add_point(const property_case *c, property_case *other) {
    *other = *c;
    if (c->count < 2 || c->count == PROPERTY_POINTS)
        return 0;
    const size_t at = c->dice % (c->count - 1);
    float *p = other->points + 2 * at;
    if (hypot((double)(p[2] - p[0]), (double)(p[3] - p[1])) < 2)
        return 0;
    memmove(p + 4, p + 2, 2 * (c->count - at - 1) * sizeof *p);
    p[2] = (p[0] + p[4]) / 2;
    p[3] = (p[1] + p[5]) / 2;
    other->count++;
    return at + 1;
}

/* Whether a line has joins with room only. */
static bool is_plain(const property_canvas *e, const property_case *c) {
    camber_stages stages = stages_of(e, c);
    bool plain = true;
    for (size_t i = 0; i < stages.point_count; i++)
        plain = plain && camber_join_kind(stages.points[i].join) <= CAMBER_KIND_CUT;
    camber_stages_destroy(&stages);
    return plain;
}

/* Speaks of lines that have room at every join, with the point too, which makes segments shorter. */
static property_outcome check_point_added(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    property_case other;
    if (!add_point(c, &other) || !is_plain(user, c) || !is_plain(user, &other))
        return PROPERTY_SILENT;
    return judge(user, c, &other, (mapping){0}, 1, story);
}

/* Speaks of the others. */
static property_outcome check_point_added_tight(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    property_case other;
    if (!add_point(c, &other) || (is_plain(user, c) && is_plain(user, &other)))
        return PROPERTY_SILENT;
    return judge(user, c, &other, (mapping){0}, 1, story);
}

static property_outcome check_ring_begun_elsewhere(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    property_case other = *c;
    if (!property_is_ring(c))
        return PROPERTY_SILENT;
    const size_t sides = c->count - 1, first = 1 + c->dice % (sides - 1);
    for (size_t i = 0; i < c->count; i++)
        memcpy(other.points + 2 * i, c->points + 2 * ((first + i) % sides), 2 * sizeof *c->points);
    return judge(user, c, &other, (mapping){0}, 1, story);
}

/* ---- The same stroke elsewhere ---- */

static property_outcome judge_moved(property_canvas *e, const property_case *c, int step_px, int levels,
                                    char story[PROPERTY_STORY]) {
    property_case other = *c;
    const mapping m = {.dx = step_px * ((int)(c->dice % 17) - 8), .dy = step_px * ((int)(c->dice / 17 % 17) - 8)};
    for (size_t i = 0; i < c->count; i++) {
        other.points[2 * i] += (float)m.dx;
        other.points[2 * i + 1] += (float)m.dy;
    }
    return judge(e, c, &other, m, levels, story);
}

/* Kernels place a cell's first pixel beside the segment and the other fifteen beside that one: another pixel of the
 * cell is rounded in another way, to a level. What an edge of two segments goes through may change hands. A place of
 * its own for each pixel would be two products more for all of them. */
static property_outcome check_moved(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    return judge_moved(user, c, 1, draws_in_cl() ? 1 : 0, story);
}

/* To the same place of other cells of 4 x 4 px. */
static property_outcome check_moved_by_cells(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    return judge_moved(user, c, 4, 0, story);
}

/* A dot has a direction, to the right: its arcs are a little rounder above than beside. */
static property_outcome check_turned(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    property_case other = *c;
    bool dot = true;
    for (size_t i = 0; i < c->count; i++) {
        other.points[2 * i] = SIDE - c->points[2 * i + 1];
        other.points[2 * i + 1] = c->points[2 * i];
        dot = dot && memcmp(c->points, c->points + 2 * i, 2 * sizeof *c->points) == 0;
    }
    return judge(user, c, &other, (mapping){.turned = true}, dot ? 48 : 1, story);
}

/* ---- Device and twin, and method and method ---- */

static property_outcome check_device(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    property_canvas *e = user;
    const uint32_t offsets[] = {0, (uint32_t)c->count};
    const camber_polylines_desc desc = {c->points, c->count, offsets, 1, NULL, false};
    const camber_tessellation_desc tessellation = {&c->stroke, 1, c->method, 0, false};
    camber_polylines *polylines = NULL;
    camber_mesh_data device, twin;
    assert_int_equal(camber_polylines_create(e->fixture.context, &desc, &polylines), CAMBER_OK);
    assert_int_equal(camber_mesh_tessellate(e->mesh, polylines, &tessellation), CAMBER_OK);
    assert_int_equal(camber_mesh_read(e->mesh, &device), CAMBER_OK);
    assert_int_equal(camber_mesh_data_tessellate(e->fixture.context, polylines, &tessellation, &twin), CAMBER_OK);
    const bool same = device.info.vertex_count == twin.info.vertex_count &&
                      device.info.index_count == twin.info.index_count &&
                      (twin.info.vertex_count == 0 || /* a dot with butt caps: nothing */
                       memcmp(device.vertices, twin.vertices, twin.info.vertex_count * sizeof *twin.vertices) == 0) &&
                      (twin.info.index_count == 0 ||
                       memcmp(device.indices, twin.indices, twin.info.index_count * sizeof *twin.indices) == 0);
    if (!same)
        snprintf(story, PROPERTY_STORY, "device and twin differ");
    camber_mesh_data_destroy(&device);
    camber_mesh_data_destroy(&twin);
    camber_polylines_destroy(polylines);
    return same ? PROPERTY_HOLDS : PROPERTY_BROKEN;
}

/* The joins of kite and fan against those of strip. A fan does not cut bodies on the inner side of a join, and its
 * round joins have chords: within what that costs. */
static property_outcome check_methods(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    property_case other = *c;
    other.method = CAMBER_METHOD_STRIP;
    if (c->method == CAMBER_METHOD_STRIP)
        return PROPERTY_SILENT;
    return judge(user, c, &other, (mapping){0}, c->method == CAMBER_METHOD_FAN ? 80 : 1, story);
}

/* ---- The truth ---- */

/* No pixel is farther from the oracle than so many levels. */
static property_outcome judge_truth(property_canvas *e, const property_case *c, int levels,
                                    char story[PROPERTY_STORY]) {
    static property_picture drawn;
    const double limit = c->stroke.miter_limit > 0 ? (double)c->stroke.miter_limit : 2;
    const camber_oracle_style style = {(double)c->stroke.width_px, c->stroke.join, c->stroke.cap, limit, true};
    camber_oracle_window truth;
    int most = 0, x = 0, y = 0;
    assert_true(camber_oracle_open(&truth, 0, 0, SIDE, SIDE));
    assert_true(camber_oracle_stroke(&truth, c->points, c->count, &style));
    property_draw(e, c, &drawn);
    for (int i = 0; i < PROPERTY_PIXELS; i++) {
        const int off = drawn.level[i] - (int)lrint(255 * camber_oracle_coverage(&truth, i % SIDE, i / SIDE));
        if (abs(off) > abs(most))
            most = off, x = i % SIDE, y = i / SIDE;
    }
    camber_oracle_close(&truth);
    snprintf(story, PROPERTY_STORY, "%d levels off the truth at %d, %d", most, x, y);
    return abs(most) > levels ? PROPERTY_BROKEN : PROPERTY_HOLDS;
}

static property_outcome check_truth(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    return judge_truth(user, c, 64, story);
}

static property_outcome check_truth_roughly(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    return judge_truth(user, c, 96, story);
}

/* ---- The list ---- */

/* Known: single pixels at tight joins, and where two arms of a sharp turn part. */
static void test_truth(void **state) {
    property_canvas *e = *state;
    e->overlap = CAMBER_OVERLAP_UNITE;
    property_check(&(property){"near the truth, plain joins", property_make_plain, check_truth, 300, 0}, e);
    property_check(&(property){"near the truth, any joins", property_make_any, check_truth_roughly, 300, 15}, e);
    e->overlap = CAMBER_OVERLAP_FLATTEN;
}

static void test_device(void **state) {
    property_check(&(property){"device and twin", property_make_any, check_device, 300, 0}, *state);
}

/* Known: at tight bevels, and where a line ends soon, one segment gives up what the other does not take. Kernels ask
 * the bisector itself which of two segments has a pixel, and no triangle, also where joins are tight. */
static void test_reversed(void **state) {
    const size_t known = draws_in_cl() ? 8 : 7;
    property_check(&(property){"reversed, plain joins", property_make_plain, check_reversed, 300, 0}, *state);
    property_check(&(property){"reversed, any joins", property_make_any, check_reversed, 300, known}, *state);
}

/* Known: a bevel's second line is looked for along the whole segment, so that a straight one on the way takes the
 * bend's correction back; and neighbours that the point makes shorter turn joins tight. */
static void test_point_added(void **state) {
    const size_t known = draws_in_cl() ? 24 : 20, known_tight = draws_in_cl() ? 30 : 26;
    property_check(&(property){"point added, plain joins", property_make_plain, check_point_added, 300, known}, *state);
    property_check(&(property){"point added, tight", property_make_any, check_point_added_tight, 300, known_tight},
                   *state);
}

static void test_ring(void **state) {
    property_check(&(property){"ring begun elsewhere", property_make_ring, check_ring_begun_elsewhere, 300, 0}, *state);
}

static void test_moved(void **state) {
    property_check(&(property){"moved by whole pixels", property_make_any, check_moved, 300, 0}, *state);
    property_check(&(property){"moved by whole cells", property_make_any, check_moved_by_cells, 300, 0}, *state);
}

/* Known: a GPU that has an edge of 45 degrees pass exactly through centres of pixels, on one side alone. */
static void test_turned(void **state) {
    const size_t known = fixture_has_gpu(*state) ? 2 : 0;
    property_check(&(property){"turned by a right angle", property_make_any, check_turned, 300, known}, *state);
}

/* Known: tight joins, which strip and kite cut in other ways. */
static void test_methods(void **state) {
    property_check(&(property){"methods, plain joins", property_make_plain, check_methods, 300, 0}, *state);
    property_check(&(property){"methods, any joins", property_make_any, check_methods, 300, 18}, *state);
}

/* A line through the picture whose ends lie so far from its middle, or 200 px. Returns the levels between the two. */
static int measure_far(property_canvas *e, double far_px, double angle) {
    static property_picture far_drawn, near_drawn;
    property_case far = {.count = 2, .stroke = {.width_px = 9, .cap = CAMBER_CAP_BUTT}}, near = far;
    int most = 0;
    for (int i = 0; i < 4; i++)
        far.points[i] = (float)(64.3 + (i < 2 ? -far_px : far_px) * (i % 2 ? sin(angle) : cos(angle)));
    for (int i = 0; i < 4; i++) {
        const double from = (double)far.points[i % 2], to = (double)far.points[2 + i % 2];
        near.points[i] = (float)(0.5 * (from + to) + (i < 2 ? -100 : 100) * (to - from) / far_px);
    }
    property_draw(e, &far, &far_drawn);
    property_draw(e, &near, &near_drawn);
    for (size_t i = 0; i < PROPERTY_PIXELS; i++)
        most = (int)fmax(most, abs(far_drawn.level[i] - near_drawn.level[i]));
    return most;
}

/* The numbers of camber_polylines_desc. */
static void test_far_ends(void **state) {
    static const struct {
        double far_px;
        int levels;
    } all[] = {{3e4, 1}, {1e5, 4}, {1e6, 30}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        int most = 0;
        for (int k = 0; k < 64; k++)
            most = (int)fmax(most, measure_far(*state, all[i].far_px, 0.01 + 0.049 * k));
        print_message("%g px: %d levels\n", all[i].far_px, most);
        assert_in_range(most, 0, all[i].levels);
    }
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_device),  cmocka_unit_test(test_reversed), cmocka_unit_test(test_point_added),
        cmocka_unit_test(test_ring),    cmocka_unit_test(test_moved),    cmocka_unit_test(test_turned),
        cmocka_unit_test(test_methods), cmocka_unit_test(test_truth),    cmocka_unit_test(test_far_ends),
    };
    const int failed = cmocka_run_group_tests(tests, property_open, property_close);
    return failed;
}
