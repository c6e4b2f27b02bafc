/* Rings of areas, of any bits: made polylines of, read as formats have them, simplified, and cut into triangles. A
 * device, where replay.c's main has one, fills them as the twin does.
 *
 *     u8 coordinates' form | grouped << 2 | wild offsets << 3 | any winding << 4 | holes first << 5
 *     u8 rings, u8 areas, window: i16 x, y in px, u16 half its width and height, u8 units
 *     rings: u16 points (wild: the offset); areas: u8 rings (wild: the offset)
 *     points: two coordinates (f32; i8; i16 / 16; f64)
 */
#include "fuzz_drawing.h"

#include "camber_network.h"
#include "features/rings.h"
#include "lines/lines.h"
#include "lines/simplify.h"
#include "map/triangulator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* GLU's time grows with the crossings of edges, and these with the square of the edges. */
enum { RINGS_MOST = 255, TRIANGULATED_MOST = 150, PLACES = 16 };
/* Twice the area of a ring that squares in double tell from a line. */
static const double SMALLEST_AREA = 1e-30;

typedef struct input {
    uint32_t offsets[RINGS_MOST + 1], rings[RINGS_MOST + 1], rows[RINGS_MOST];
    double *world; /* the points as they were read */
    float *points;
    camber_areas_desc areas;
    camber_ring_window window;
    bool any_winding, holes_first;
} input;

/* ---- Reading ---- */

static double take_coordinate(fuzz_reader *from, unsigned form) {
    switch (form) {
    case 0: return (double)fuzz_take_float(from);
    case 1: return (int8_t)fuzz_take(from, 1);
    case 2: return (int16_t)fuzz_take(from, 2) / 16.0;
    default: return fuzz_take_double(from);
    }
}

/* Offsets are the caller's promise, unless they are wild. */
static void take_offsets(fuzz_reader *from, uint32_t *offsets, size_t count, int bytes, bool wild) {
    for (size_t i = 0; i < count; i++) {
        const uint32_t number = (uint32_t)fuzz_take(from, (size_t)bytes);
        offsets[i + 1] = wild ? number : offsets[i] + number % 256;
    }
}

static void bound_offsets(uint32_t *offsets, size_t count, size_t most) {
    for (size_t i = 0; i <= count; i++)
        offsets[i] = offsets[i] > most ? (uint32_t)most : offsets[i];
    if (count)
        offsets[count] = (uint32_t)most;
}

static void read_points(fuzz_reader *from, unsigned form, size_t wanted, input *made) {
    static const size_t bytes[] = {4, 1, 2, 8};
    const size_t there = from->size / (2 * bytes[form]), count = wanted < there ? wanted : there;
    made->world = calloc(2 * count + 1, sizeof *made->world);
    made->points = calloc(2 * count + 1, sizeof *made->points);
    REQUIRE(made->world && made->points);
    for (size_t i = 0; i < 2 * count; i++) {
        const double number = take_coordinate(from, form);
        made->world[i] = number;
        made->points[i] = fabs(number) > 3e38 ? INFINITY : (float)number;
    }
    made->areas.points = made->points;
    made->areas.point_count = count;
}

static void read_input(fuzz_reader *from, input *made) {
    const unsigned head = (unsigned)fuzz_take(from, 1);
    const bool wild = head & 8, grouped = head & 4;
    *made = (input){.any_winding = head & 16, .holes_first = head & 32};
    const size_t ring_count = fuzz_take(from, 1), area_count = fuzz_take(from, 1);
    made->window.centre_x = (int16_t)fuzz_take(from, 2);
    made->window.centre_y = (int16_t)fuzz_take(from, 2);
    const uint32_t half = (uint32_t)fuzz_take(from, 2);
    made->window.half_width = (float)(1u + half % 8192);
    made->window.half_height = (float)(1u + half / 8 % 8192);
    made->window.units = (double)(1u << fuzz_take(from, 1) % 11);
    take_offsets(from, made->offsets, ring_count, 2, wild);
    if (grouped)
        take_offsets(from, made->rings, area_count, 1, wild);
    size_t wanted = 0;
    for (size_t i = 0; i <= ring_count; i++)
        wanted = made->offsets[i] > wanted ? made->offsets[i] : wanted;
    read_points(from, head & 3, wanted, made);
    if (!wild) {
        bound_offsets(made->offsets, ring_count, made->areas.point_count);
        bound_offsets(made->rings, area_count, ring_count);
    }
    for (size_t i = 0; i < RINGS_MOST; i++)
        made->rows[i] = i % 2;
    made->areas.offsets = made->offsets;
    made->areas.ring_count = ring_count;
    made->areas.rings = grouped ? made->rings : NULL;
    made->areas.area_count = area_count;
    made->areas.rows = made->rows;
    if (ring_count == 0)
        made->areas.point_count = 0;
}

/* ---- Polylines ---- */

static bool is_hole(const camber_areas_desc *areas, size_t ring, uint32_t *area) {
    *area = (uint32_t)ring;
    if (!areas->rings)
        return false;
    for (*area = 0; areas->rings[*area + 1] <= ring;)
        ++*area;
    return areas->rings[*area] != ring;
}

typedef struct clean_ring {
    float *points; /* that can be drawn, without equal ones; the first stands at the end again */
    size_t count;
    long double area, slack; /* twice the area that it goes around clockwise as seen; how far off rounding may be */
    bool dense;              /* neighbours may count as one point */
} clean_ring;

static void clean(const camber_areas_desc *areas, size_t ring, clean_ring *to) {
    float *kept = to->points;
    size_t count = 0;
    for (size_t i = areas->offsets[ring]; i < areas->offsets[ring + 1]; i++) {
        const float *point = areas->points + 2 * i;
        if (!(fabsf(point[0]) <= 1e9f && fabsf(point[1]) <= 1e9f) ||
            (count && kept[2 * count - 2] == point[0] && kept[2 * count - 1] == point[1]))
            continue;
        kept[2 * count] = point[0];
        kept[2 * count++ + 1] = point[1];
    }
    while (count > 1 && kept[0] == kept[2 * count - 2] && kept[1] == kept[2 * count - 1])
        count--;
    kept[2 * count] = kept[0];
    kept[2 * count + 1] = kept[1];
    *to = (clean_ring){.points = kept, .count = count};
    for (size_t i = 0; i < count; i++) {
        const float *a = kept + 2 * i;
        const long double one = (long double)a[0] * a[3], other = (long double)a[2] * a[1];
        to->area += one - other;
        to->slack += (fabsl(one) + fabsl(other)) * (long double)(count + 4) * 0x1p-52L;
        to->dense |= hypot((double)a[2] - (double)a[0], (double)a[3] - (double)a[1]) < 1e-8;
    }
}

/* Whether the slots have the kept points from one of them on, in their order or back, and that one again. */
static bool are_slots(const camber_polylines *made, size_t slot, const float *kept, size_t count, size_t start,
                      bool back) {
    for (size_t i = 0; i <= count; i++) {
        const float *point = kept + 2 * ((start + (back ? 2 * count - i : i)) % count);
        if (made->x[slot + i] != point[0] || made->y[slot + i] != point[1])
            return false;
    }
    return true;
}

/* A ring goes clockwise as seen, and a hole the other way; no point is lost, and none is added but the closing one. */
static void check_ring(const camber_polylines *made, const camber_areas_desc *areas, size_t ring, clean_ring *as) {
    uint32_t area;
    const bool hole = is_hole(areas, ring, &area);
    size_t first = made->first_slots[ring] + 1, end = made->first_slots[ring + 1] + 1;
    clean(areas, ring, as);
    REQUIRE(made->polyline_rows[ring] == areas->rows[area]);
    while (first < end && !(made->info[first] & CAMBER_POINT_REAL))
        first++;
    while (end > first && !(made->info[end - 1] & CAMBER_POINT_REAL))
        end--;
    REQUIRE(end - first <= as->count + 1);
    if (as->count < 2 || as->dense)
        return;
    REQUIRE(end - first == as->count + 1);
    const bool forward = are_slots(made, first, as->points, as->count, 0, false),
               turned = are_slots(made, first, as->points, as->count, 0, true) ||
                        are_slots(made, first, as->points, as->count, as->count - 1, true);
    REQUIRE(forward || turned);
    if (forward != turned && fabsl(as->area) > as->slack)
        REQUIRE(turned == (hole ? as->area > 0 : as->area < 0));
}

static void check_areas(const camber_polylines *made, const camber_areas_desc *areas) {
    const camber_polylines_stats stats = camber_polylines_get_stats(made);
    clean_ring room = {.points = calloc(areas->point_count + 1, 2 * sizeof *room.points)};
    REQUIRE(room.points && made->polyline_count == areas->ring_count);
    REQUIRE(stats.kept_points + stats.repeated_points + stats.invalid_points == stats.points);
    for (size_t i = 0; i < areas->ring_count; i++)
        check_ring(made, areas, i, &room);
    free(room.points);
}

/* ---- Rings as they are read ---- */

typedef struct taken {
    double *points;
    size_t *offsets; /* ring_count + 1 */
    size_t ring_count;
} taken;

static bool is_same(const double *p, const double *q) {
    return p[0] == q[0] && p[1] == q[1];
}

/* The ring with each point moved by whole worlds, and what goes around a pole behind it. */
static size_t unroll(double *points, size_t count) {
    double *before = malloc((2 * count + 1) * sizeof *before);
    bool crosses = true;
    REQUIRE(before);
    memcpy(before, points, 2 * count * sizeof *points);
    const size_t now = camber_ring_unroll(points, count, &crosses);
    REQUIRE(now == count || (crosses && now == count + 3));
    REQUIRE(crosses || memcmp(points, before, 2 * count * sizeof *points) == 0);
    for (size_t i = 0; i < count; i++) {
        const double moved = points[2 * i] - before[2 * i];
        REQUIRE(points[2 * i + 1] == before[2 * i + 1] && fabs(moved - rint(moved)) < 1e-12 && fabs(moved) < 1.5);
    }
    free(before);
    return now;
}

static size_t drop_invalid(double *points, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(points[2 * i]) && isfinite(points[2 * i + 1])) {
            points[2 * kept] = points[2 * i];
            points[2 * kept++ + 1] = points[2 * i + 1];
        }
    return kept;
}

/* A reader gives what lies in the world or somewhat beside it, and what is no number. */
static size_t copy_ring(const input *from, size_t ring, double *points) {
    const size_t first = from->offsets[ring], count = from->offsets[ring + 1] - first;
    for (size_t i = 0; i < 2 * count; i++) {
        const double number = from->world[2 * first + i];
        points[i] = isfinite(number) ? fmod(number, 4.0) : number;
    }
    return count;
}

static void take_rings(const input *from, bool unrolls, taken *to) {
    camber_features_stats stats = {0};
    camber_rings rings = {.stats = &stats, .any_winding = from->any_winding};
    const size_t ring_count = from->areas.ring_count;
    to->points = calloc(from->areas.point_count + 4 * ring_count + 4, 2 * sizeof *to->points);
    to->offsets = calloc(ring_count + 1, sizeof *to->offsets);
    REQUIRE(to->points && to->offsets);
    size_t counted = 0;
    for (size_t i = 0; i < ring_count; i++) {
        double *points = to->points + 2 * to->offsets[to->ring_count];
        const bool hole = from->holes_first ? i % 3 != 2 : i % 3 != 0;
        size_t count = copy_ring(from, i, points);
        if (unrolls)
            count = unroll(points, drop_invalid(points, count));
        count = camber_rings_take(&rings, points, count, hole);
        REQUIRE(stats.closed_rings + stats.empty_rings - counted <= 1);
        counted = stats.closed_rings + stats.empty_rings;
        if (count == 0)
            continue;
        REQUIRE(count >= 4 && is_same(points, points + 2 * (count - 1)));
        REQUIRE(drop_invalid(points, count) == count && !camber_ring_is_flat(points, count));
        const double area = camber_ring_area(points, count);
        REQUIRE(hole ? area < 1e-12 : area > -1e-12);
        to->offsets[to->ring_count + 1] = to->offsets[to->ring_count] + count;
        to->ring_count++;
    }
    REQUIRE(to->ring_count + stats.empty_rings == ring_count);
}

/* An area stays one at any tolerance, and keeps its seam. */
static void check_simplified(const taken *rings, double tolerance) {
    for (size_t i = 0; i < rings->ring_count; i++) {
        const size_t first = rings->offsets[i], count = rings->offsets[i + 1] - first;
        double *points = malloc(count * 2 * sizeof *points);
        unsigned char *keep = malloc(count);
        REQUIRE(points && keep);
        memcpy(points, rings->points + 2 * first, count * 2 * sizeof *points);
        const double area = fabs(camber_ring_area(points, count));
        const size_t kept = camber_simplify(points, count, tolerance, keep);
        REQUIRE(kept <= count && kept >= (area > SMALLEST_AREA ? 4 : 2));
        REQUIRE(memcmp(points, rings->points + 2 * first, 2 * sizeof *points) == 0);
        REQUIRE(is_same(points, points + 2 * (kept - 1)));
        free(keep);
        free(points);
    }
}

/* Rings that have a point in common keep or lose it together; an area keeps three points for ever. */
static void check_importance(fuzz_run *run, const taken *rings) {
    const size_t count = rings->offsets[rings->ring_count];
    float *importance = calloc(count + 1, sizeof *importance);
    REQUIRE(importance);
    if (fuzz_done(
            run, camber_importance_weigh(run->context, rings->points, rings->offsets, rings->ring_count, importance))) {
        for (size_t i = 1; i < count; i++) {
            const size_t other = (size_t)(run->hash >> 16) * i % i;
            REQUIRE(importance[i] >= 0.0f);
            const bool same = memcmp(rings->points + 2 * i, rings->points + 2 * other, 2 * sizeof(double)) == 0;
            REQUIRE(!same || importance[i] == importance[other]);
        }
        for (size_t i = 0; i < rings->ring_count; i++) {
            const size_t first = rings->offsets[i], points = rings->offsets[i + 1] - first;
            size_t kept = 0;
            for (size_t k = 0; k < points; k++)
                kept += importance[first + k] == INFINITY;
            REQUIRE(kept >= (fabs(camber_ring_area(rings->points + 2 * first, points)) > SMALLEST_AREA ? 4 : 2));
        }
    }
    free(importance);
}

static void use_source(fuzz_run *run, const input *from) {
    static const double tolerances[] = {1e-9, 1e-3, 0.5, 1e12};
    taken rings = {0};
    take_rings(from, run->hash & 16, &rings);
    check_simplified(&rings, tolerances[run->hash % 4]);
    check_importance(run, &rings);
    free(rings.points);
    free(rings.offsets);
}

/* ---- Triangles ---- */

/* A ring of the polylines as the triangulator takes it. */
static size_t ring_of(const camber_polylines *made, size_t ring, float *points) {
    size_t count = 0;
    for (size_t slot = made->first_slots[ring] + 1; slot <= made->first_slots[ring + 1]; slot++)
        if (made->info[slot] & CAMBER_POINT_REAL) {
            points[2 * count] = made->x[slot];
            points[2 * count++ + 1] = made->y[slot];
        }
    return count;
}

static double cross(double ax, double ay, double bx, double by, double x, double y) {
    return (bx - ax) * (y - ay) - (by - ay) * (x - ax);
}

/* Where triangles are looked for: px from the window's centre. */
typedef struct place {
    double x, y;
    int turns; /* of the rings about it */
    bool near; /* to an edge: by what is rounded it may be inside or not */
} place;

static void wind(place *at, const float *points, size_t count, const camber_ring_window *window) {
    for (size_t i = 0; i + 1 < count; i++) {
        const float *p = points + 2 * i;
        const double ax = (double)p[0] - window->centre_x, ay = (double)p[1] - window->centre_y,
                     bx = (double)p[2] - window->centre_x, by = (double)p[3] - window->centre_y;
        const double side = cross(ax, ay, bx, by, at->x, at->y), dx = bx - ax, dy = by - ay, length = dx * dx + dy * dy;
        const double along =
            length > 0.0 ? fmin(fmax(((at->x - ax) * dx + (at->y - ay) * dy) / length, 0.0), 1.0) : 0.0;
        const double far = fmax(fmax(fabs(ax), fabs(ay)), fmax(fabs(bx), fabs(by)));
        at->near |= hypot(at->x - ax - along * dx, at->y - ay - along * dy) < 6.0 / window->units + 4e-6 * far;
        if ((ay <= at->y) != (by <= at->y) && (side > 0.0) == (by > ay))
            at->turns += by > ay ? 1 : -1;
    }
}

static int count_triangles(const camber_triangles *made, double x, double y) {
    int count = 0;
    for (size_t i = 0; i < made->index_count; i += 3) {
        const camber_corner a = made->corners[made->indices[i]], b = made->corners[made->indices[i + 1]],
                            c = made->corners[made->indices[i + 2]];
        count += cross(a.x, a.y, b.x, b.y, x, y) < 0.0 && cross(b.x, b.y, c.x, c.y, x, y) < 0.0 &&
                 cross(c.x, c.y, a.x, a.y, x, y) < 0.0;
    }
    return count;
}

/* Triangles have corners of the window. Returns whether each place is in one, or in none. */
static bool check_triangles(const camber_triangles *made, const camber_ring_window *window, const place *places) {
    const double wide = (double)window->half_width * window->units + 1.0,
                 high = (double)window->half_height * window->units + 1.0;
    bool holds = true;
    REQUIRE(made->index_count % 3 == 0);
    for (size_t i = 0; i < made->index_count; i++)
        REQUIRE(made->indices[i] < made->corner_count);
    for (size_t i = 0; i < made->corner_count; i++)
        REQUIRE(fabs((double)made->corners[i].x) <= wide && fabs((double)made->corners[i].y) <= high);
    for (size_t i = 0; i < PLACES; i++) {
        const double x = places[i].x * window->units, y = places[i].y * window->units;
        const int wanted = places[i].turns != 0;
        /* Where crossings were rounded, triangles may overlap by a unit. */
        holds &= places[i].near || count_triangles(made, x, y) == wanted ||
                 count_triangles(made, x + 2.0, y + 1.0) == wanted;
    }
    return holds;
}

static void choose_places(uint64_t random, const camber_ring_window *window, place *places) {
    for (size_t i = 0; i < PLACES; i++) {
        random = random * 6364136223846793005u + 1442695040888963407u;
        const double reach = i % 2 ? 1.0 : 64.0 / (double)window->half_width; /* most rings lie near the centre */
        places[i] = (place){
            .x = ((double)(random >> 40) * 0x1p-23 - 1.0) * fmin(reach, 1.0) * (double)window->half_width,
            .y = ((double)(random >> 16 & 0xffffff) * 0x1p-23 - 1.0) * fmin(reach, 1.0) * (double)window->half_height};
    }
}

/* Fills the rings, with x and y exchanged if they are turned over. Returns whether all places hold, or memory ran out.
 */
static bool fill_rings(fuzz_run *run, camber_triangulator *triangulator, const camber_polylines *made,
                       const camber_ring_window *wanted, bool turned_over) {
    const camber_ring_window over = {wanted->centre_y, wanted->centre_x, wanted->half_height, wanted->half_width,
                                     wanted->units};
    const camber_ring_window *window = turned_over ? &over : wanted;
    place places[PLACES];
    camber_triangles triangles = {0};
    float *points = malloc((made->slot_count + 2) * 2 * sizeof *points);
    bool added = true;
    REQUIRE(points);
    choose_places(run->hash | 1, wanted, places);
    for (size_t i = 0; i < PLACES && turned_over; i++)
        places[i] = (place){.x = places[i].y, .y = places[i].x};
    for (size_t i = 0; i < made->polyline_count && added; i++) {
        const size_t count = ring_of(made, i, points);
        for (size_t k = 0; k < 2 * count && turned_over; k += 2) {
            const float x = points[k];
            points[k] = points[k + 1];
            points[k + 1] = x;
        }
        for (size_t k = 0; k < PLACES; k++)
            wind(places + k, points, count, window);
        added = fuzz_done(run, camber_triangulator_add(triangulator, points, count, window));
    }
    free(points);
    return !added || !fuzz_done(run, camber_triangulator_fill(triangulator, &triangles)) ||
           check_triangles(&triangles, window, places);
}

/* GLU computes in floating point, and now and then a tangle has a triangle twice, or a hole: of some 30,000 that a
 * fuzzer made, one. Another way of sweeping is right about the same rings; camber's own part would be wrong in both. */
static void use_triangles(fuzz_run *run, const camber_polylines *made, const camber_ring_window *window) {
    camber_triangulator *triangulator = NULL;
    if (made->stats.kept_segments > TRIANGULATED_MOST || !camber_triangulator_is_available() ||
        !fuzz_done(run, camber_triangulator_create(run->context, &triangulator)))
        return;
    if (!fill_rings(run, triangulator, made, window, false))
        REQUIRE(fill_rings(run, triangulator, made, window, true));
    camber_triangulator_destroy(triangulator);
}

/* ---- On a device ---- */

static fuzz_drawer drawer;
static const camber_stroke strokes[] = {{.width_px = 0}, {.width_px = 3}};

static void check_device(const input *from) {
    const camber_tessellation_desc desc = {strokes, 2, CAMBER_METHOD_STRIP, 0, false};
    camber_polylines *areas = NULL;
    REQUIRE(camber_areas_create(drawer.context, &from->areas, &areas) == CAMBER_OK);
    REQUIRE(camber_mesh_tessellate(drawer.mesh, areas, &desc) == CAMBER_OK);
    fuzz_drawer_draw(&drawer, strokes, 2, false);
    camber_polylines_destroy(areas);
}

/* ---- The target ---- */

static void use(fuzz_run *run, const uint8_t *bytes, size_t size) {
    fuzz_reader reader = {bytes, size};
    input from;
    camber_polylines *areas = NULL;
    read_input(&reader, &from);
    if (fuzz_done(run, camber_areas_create(run->context, &from.areas, &areas))) {
        check_areas(areas, &from.areas);
        use_source(run, &from);
        use_triangles(run, areas, &from.window);
        if (drawer.mesh && !run->refuse_at)
            check_device(&from);
    }
    camber_polylines_destroy(areas);
    free(from.world);
    free(from.points);
}

int LLVMFuzzerInitialize(int *argument_count, char ***arguments) {
    (void)argument_count;
    (void)arguments;
    fuzz_drawer_open(&drawer);
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    fuzz_each(bytes, size, use);
    return 0;
}
