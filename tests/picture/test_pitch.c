/* A plane that is seen at an angle: against rays from the camera through 16 x 16 places of each pixel. The rays share
 * nothing with the shaders and kernels but where the camera stands. */
#include "pictures.h"

#include "validate/along_truth.h"
#include "validate/random.h"

enum { WIDE = 160, HIGH = 120, SAMPLES = 16, POINTS_MAX = 40 };
static const double PITCHES[] = {30, 60, 80, 85};
enum { PITCH_COUNT = 4 };

typedef struct figure {
    const char *name;
    float points[2 * POINTS_MAX]; /* px of the plane */
    size_t count;
    camber_stroke stroke;
    float width_px;
} figure;

/* ---- Truth ---- */

/* hypot is right for numbers that are far from here, too, and takes several times as long. */
static double length_of(double x, double y) {
    return sqrt(x * x + y * y);
}

static bool meet(double pitch_deg, double x, double y, double met[2], double *depth) {
    return camber_ray_meets_plane(pitch_deg, (const double[]){WIDE, HIGH}, x, y, met, depth);
}

static bool in_triangle(const double p[2], const double a[2], const double b[2], const double c[2]) {
    const double ab = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    const double bc = (c[0] - b[0]) * (p[1] - b[1]) - (c[1] - b[1]) * (p[0] - b[0]);
    const double ca = (a[0] - c[0]) * (p[1] - c[1]) - (a[1] - c[1]) * (p[0] - c[0]);
    return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

/* The corners and the tip of a join, on its outer side; the miter limit is far. */
static bool in_join(const figure *f, size_t i, double half, const double p[2]) {
    const float *at = f->points + 2 * i;
    const double joint[2] = {(double)at[0], (double)at[1]};
    double in[2] = {(double)(at[0] - at[-2]), (double)(at[1] - at[-1])};
    double out[2] = {(double)(at[2] - at[0]), (double)(at[3] - at[1])};
    const double in_length = length_of(in[0], in[1]), out_length = length_of(out[0], out[1]);
    for (int k = 0; k < 2; k++) {
        in[k] /= in_length;
        out[k] /= out_length;
    }
    const double x = p[0] - joint[0], y = p[1] - joint[1];
    if (f->stroke.join == CAMBER_JOIN_ROUND) /* past the one segment, and before the other */
        return length_of(x, y) <= half && x * in[0] + y * in[1] >= 0 && x * out[0] + y * out[1] <= 0;
    const double side = in[0] * out[1] - in[1] * out[0] > 0 ? -half : half;
    const double a[2] = {joint[0] - in[1] * side, joint[1] + in[0] * side};
    const double b[2] = {joint[0] - out[1] * side, joint[1] + out[0] * side};
    if (in_triangle(p, joint, a, b))
        return true;
    const double reach = half * fabs((in[0] * out[1] - in[1] * out[0]) / (1 + in[0] * out[0] + in[1] * out[1]));
    const double tip[2] = {a[0] + in[0] * reach, a[1] + in[1] * reach};
    return f->stroke.join == CAMBER_JOIN_MITER && in_triangle(p, a, b, tip);
}

static bool in_stroke(const figure *f, const double p[2]) {
    const double half = 0.5 * (double)f->width_px;
    for (size_t i = 0; i + 1 < f->count; i++) {
        const double ax = (double)f->points[2 * i], ay = (double)f->points[2 * i + 1];
        const double dx = (double)f->points[2 * i + 2] - ax, dy = (double)f->points[2 * i + 3] - ay;
        const double length = length_of(dx, dy), cap = f->stroke.cap == CAMBER_CAP_SQUARE ? half : 0;
        const double x = ((p[0] - ax) * dx + (p[1] - ay) * dy) / length;
        const double y = ((p[1] - ay) * dx - (p[0] - ax) * dy) / length;
        if (fabs(y) <= half && x >= (i == 0 ? -cap : 0) && x <= length + (i + 2 == f->count ? cap : 0))
            return true;
        if (i > 0 && in_join(f, i, half, p))
            return true;
        const bool round = f->stroke.cap == CAMBER_CAP_ROUND;
        if (round && i == 0 && length_of(x, y) <= half)
            return true;
        if (round && i + 2 == f->count && length_of(x - length, y) <= half)
            return true;
    }
    return false;
}

/* The row that the far plane is in: MapLibre's, 1 % behind what lies at 85 % of the way to the horizon or at the top.
 */
static uint32_t far_row(double pitch_deg) {
    double met[2], top_depth = INFINITY, depth = 0;
    if (!meet(pitch_deg, 0, 0, met, &top_depth))
        top_depth = INFINITY;
    const double farthest = 1.01 * fmin(top_depth, 1 / 0.15);
    uint32_t row = 0;
    while (row < HIGH && (!meet(pitch_deg, 0, row + 0.5, met, &depth) || depth > farthest))
        row++;
    return row;
}

static double edge_distance(const float a[2], const float b[2], const double p[2]) {
    const double ax = (double)a[0], ay = (double)a[1], dx = (double)b[0] - ax, dy = (double)b[1] - ay;
    const double t = ((p[0] - ax) * dx + (p[1] - ay) * dy) / (dx * dx + dy * dy), near = fmin(fmax(t, 0), 1);
    return length_of(p[0] - ax - near * dx, p[1] - ay - near * dy);
}

/* Whether a pixel is far from the line: it shows a quadrangle of the plane that lies around its middle. */
static bool is_apart(const figure *f, double pitch_deg, double x, double y) {
    double middle[2], corner[2], depth, reach = 4 * (double)f->width_px;
    if (!meet(pitch_deg, x + 0.5, y + 0.5, middle, &depth))
        return false;
    for (int k = 0; k < 4; k++) {
        if (!meet(pitch_deg, x + k % 2, y + k / 2, corner, &depth))
            return false;
        reach = fmax(reach, 4 * (double)f->width_px + length_of(corner[0] - middle[0], corner[1] - middle[1]));
    }
    for (size_t i = 0; i + 1 < f->count; i++)
        if (edge_distance(f->points + 2 * i, f->points + 2 * i + 2, middle) < reach)
            return false;
    return true;
}

static void make_truth(const figure *f, double pitch_deg, double truth[WIDE * HIGH]) {
    const uint32_t first = far_row(pitch_deg);
    for (uint32_t i = 0; i < WIDE * HIGH; i++) {
        int inside = 0;
        truth[i] = 0;
        if (is_apart(f, pitch_deg, i % WIDE, i / WIDE))
            continue;
        for (int k = 0; k < SAMPLES * SAMPLES && i / WIDE >= first; k++) {
            double met[2], depth;
            const double x = i % WIDE + (k % SAMPLES + 0.5) / SAMPLES, y = i / WIDE + (k / SAMPLES + 0.5) / SAMPLES;
            inside += meet(pitch_deg, x, y, met, &depth) && in_stroke(f, met);
        }
        truth[i] = inside / (double)(SAMPLES * SAMPLES);
    }
}

/* ---- Drawing ---- */

typedef struct look {
    double pitch_deg;
    camber_method method;
    camber_overlap overlap;
    camber_dash dash;
    uint32_t largest_area_px;
    float alpha; /* 0: 1 */
    bool upright;
} look;

static picture draw(const fixture *s, camber_renderer *renderer, const figure *f, const look *l) {
    camber_made_scene lines = {0};
    for (size_t i = 0; i < f->count; i++)
        camber_made_scene_point(&lines, (double)f->points[2 * i], (double)f->points[2 * i + 1]);
    camber_made_scene_end(&lines, 0);
    camber_stroke stroke = f->stroke;
    stroke.width_px = f->width_px;
    const camber_tessellation_desc desc = {
        .strokes = &stroke, .stroke_count = 1, .method = l->method, .has_arc_length = l->dash.count > 0};
    camber_mesh *mesh = fixture_mesh(s, renderer, &lines, &desc);
    const camber_paint paint = {.width_px = f->width_px,
                                .color = {1, 1, 1, l->alpha > 0 ? l->alpha : 1},
                                .dash = l->dash.count > 0 ? &l->dash : NULL};
    const camber_pass pass = {
        .mesh = mesh, .paints = &paint, .paint_count = 1, .overlap = l->overlap, .upright = l->upright};
    const camber_frame frame = {.width = WIDE,
                                .height = HIGH,
                                .passes = &pass,
                                .pass_count = 1,
                                .largest_area_px = l->largest_area_px,
                                .pitch_deg = l->pitch_deg};
    picture p = picture_draw(renderer, &frame);
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&lines);
    return p;
}

typedef struct error {
    double mean, most; /* of 255 */
    uint32_t x, y;
} error;

/* Over the pixels where either is not 0. */
static error compare(const picture *p, const double truth[WIDE * HIGH]) {
    error e = {0};
    double sum = 0;
    size_t touched = 0;
    for (uint32_t i = 0; i < WIDE * HIGH; i++) {
        const double drawn = picture_value(p, i % WIDE, i / WIDE, 3), apart = 255 * fabs(drawn - truth[i]);
        touched += drawn > 0 || truth[i] > 0;
        sum += apart;
        if (apart > e.most)
            e = (error){0, apart, i % WIDE, i / WIDE};
    }
    e.mean = touched ? sum / (double)touched : 0;
    return e;
}

/* ---- Lines ---- */

#define ROUND                                                                                                          \
    { 0, CAMBER_JOIN_ROUND, CAMBER_CAP_ROUND, 0 }
#define BUTT                                                                                                           \
    { 0, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0 }
#define MITER                                                                                                          \
    { 0, CAMBER_JOIN_MITER, CAMBER_CAP_SQUARE, 20 }
#define MITER_BUTT                                                                                                     \
    { 0, CAMBER_JOIN_MITER, CAMBER_CAP_BUTT, 20 }
#define BEVEL                                                                                                          \
    { 0, CAMBER_JOIN_BEVEL, CAMBER_CAP_BUTT, 0 }

static const figure FIGURES[] = {
    {"across", {-2000, 52, 2000, 71}, 2, BUTT, 7},
    {"from behind the camera to the far plane", {71, 900, 96, -4000}, 2, ROUND, 6},
    {"aslant to the far plane", {-200, 260, 1600, -1140}, 2, BUTT, 5},
    {"a hair aslant", {-200, 260, 1600, -1140}, 2, BUTT, 0.6f},
    {"round corners", {30, 90, 60, 30, 100, 75, 125, 20}, 4, ROUND, 9},
    {"miters", {30, 90, 60, 30, 100, 75, 125, 20}, 4, MITER, 8},
    {"bevels", {30, 90, 60, 30, 100, 75, 125, 20}, 4, BEVEL, 8},
    {"a short thick line", {70, 55, 92, 62}, 2, ROUND, 14},
    {"a square", {70, 55, 92, 62}, 2, {0, CAMBER_JOIN_MITER, CAMBER_CAP_SQUARE, 20}, 14},
    {"far corners",
     {-300, -420, -180, -300, -60, -430, 60, -300, 180, -430, 300, -300, 420, -410, 540, -250},
     8,
     BUTT,
     12},
    {"far steps",
     {-300, -400, -200, -400, -200, -380, -100, -380, -100, -400, 0, -400, 0, -370, 100, -370, 100, -420, 200, -420},
     10,
     BUTT,
     4},
    {"a short piece before a butt cap", {20, 90, 90, 60, 91, 63}, 3, BUTT, 12},
    {"a short piece before a butt cap, miters", {20, 90, 90, 60, 91, 63}, 3, MITER_BUTT, 12},
    {"a short piece behind a butt cap", {66, 42, 68, 44, 130, 30}, 3, BUTT, 16},
    {"a short piece between others", {20, 90, 70, 60, 72, 63, 130, 70}, 4, BUTT, 16},
    {"short pieces of a wide line", {20, 60, 40, 50, 43, 50, 46, 52, 49, 51, 52, 53, 54, 53}, 7, BUTT, 16},
    {"a short piece back", {20, 90, 90, 60, 88, 63}, 3, BUTT, 24},
    {"a stub to the right before a butt cap", {20, 90, 90, 60, 90.6f, 60.9f}, 3, BUTT, 6},
    {"a stub to the left before a butt cap", {20, 90, 90, 60, 89.9f, 58.8f}, 3, BUTT, 12},
    {"a stub to the right behind a butt cap", {70, 41.4f, 70.4f, 40.5f, 130, 60}, 3, BUTT, 12},
    {"a stub to the left behind a butt cap", {70, 39.3f, 70.4f, 40.5f, 130, 60}, 3, MITER_BUTT, 7},
    {"a stub between round joins", {20, 90, 70, 60, 70.9f, 60.8f, 130, 75}, 4, ROUND, 12},
    {"a thin line that turns right back after a stub",
     {99, 50.5036736f, 98.97867f, 50.5002747f, 128.0379f, 55.127f},
     3,
     BUTT,
     0.6f},
    {"as wide as the picture", {80, 300, 60, 60, 80, -2000}, 3, ROUND, 150},
};

/* By pitch: the mean and the most that any figure may be off, of 255. The most is at corners that a pixel holds whole.
 */
static const double MEAN_BOUNDS[PITCH_COUNT] = {1.5, 2.5, 6, 11}, MOST_BOUNDS[PITCH_COUNT] = {40, 60, 100, 140};

static void test_oracle(void **state) {
    const fixture *s = *state;
    static double truth[WIDE * HIGH];
    size_t failed = 0;
    for (size_t f = 0; f < sizeof FIGURES / sizeof *FIGURES; f++)
        for (int i = 0; i < PITCH_COUNT; i++) {
            make_truth(FIGURES + f, PITCHES[i], truth);
            for (int method = 0; method < 3; method++) {
                const look l = {.pitch_deg = PITCHES[i], .method = (camber_method)method};
                picture p = draw(s, fixture_any(s), FIGURES + f, &l);
                const error e = compare(&p, truth);
                const bool off = e.mean > MEAN_BOUNDS[i] || e.most > MOST_BOUNDS[i];
                failed += off;
                if (off || method == 0)
                    printf("%s%s at %g degrees, method %d: %.2f of 255 on average, %.0f at %u, %u\n",
                           off ? "OFF: " : "", FIGURES[f].name, PITCHES[i], method, e.mean, e.most, e.x, e.y);
                picture_free(&p);
            }
        }
    assert_int_equal(failed, 0);
}

/* Nearly no pitch shows what none does: the other shader, which decides by fragments what triangles decide without. The
 * triangles of fans leave flat joins out, so strips are the ones to be like. */
static void test_nearly_flat(void **state) {
    const fixture *s = *state;
    for (size_t f = 0; f < sizeof FIGURES / sizeof *FIGURES; f++) {
        picture flat = draw(s, fixture_any(s), FIGURES + f, &(look){.method = CAMBER_METHOD_STRIP});
        for (int method = 0; method < 3; method++) {
            picture tilted =
                draw(s, fixture_any(s), FIGURES + f, &(look){.pitch_deg = 1e-4, .method = (camber_method)method});
            const difference d = picture_compare(&flat, &tilted);
            if (d.mean > 1.5 || d.most > 90)
                fail_msg("%s, method %d: %.2f of 255 on average, %d at most", FIGURES[f].name, method, d.mean, d.most);
            picture_free(&tilted);
        }
        picture_free(&flat);
    }
}

static void test_pieces(void **state) {
    const fixture *s = *state;
    for (size_t f = 0; f < sizeof FIGURES / sizeof *FIGURES; f++)
        for (int i = 0; i < PITCH_COUNT; i++)
            for (int flattened = 0; flattened < 2; flattened++) {
                look l = {.pitch_deg = PITCHES[i], .alpha = flattened ? 0.5f : 1};
                picture whole = draw(s, fixture_any(s), FIGURES + f, &l);
                l.largest_area_px = 37;
                picture pieces = draw(s, fixture_any(s), FIGURES + f, &l);
                picture_assert_same(&whole, &pieces);
                picture_free(&pieces);
                picture_free(&whole);
            }
}

static void test_backends(void **state) {
    const fixture *s = *state;
    if (!s->on.renderer[0] || !s->on.renderer[1])
        skip();
    for (size_t f = 0; f < sizeof FIGURES / sizeof *FIGURES; f++)
        for (int i = 0; i < PITCH_COUNT; i++) {
            const look l = {.pitch_deg = PITCHES[i]};
            picture a = draw(s, s->on.renderer[0], FIGURES + f, &l), b = draw(s, s->on.renderer[1], FIGURES + f, &l);
            picture_assert_same(&a, &b);
            picture_free(&b);
            picture_free(&a);
        }
}

/* All that lies past the far plane, and all of the sky, is background. */
static void test_horizon(void **state) {
    const fixture *s = *state;
    const figure wide = {"over all", {-20000, -3000, 20000, -3000, 20000, 400, -20000, 400}, 4, ROUND, 5000};
    for (int i = 0; i < PITCH_COUNT; i++) {
        picture p = draw(s, fixture_any(s), &wide, &(look){.pitch_deg = PITCHES[i]});
        const uint32_t row = far_row(PITCHES[i]);
        assert_true(PITCHES[i] > 70 ? row > 10 : row == 0);
        for (uint32_t k = 0; k < WIDE * HIGH; k++)
            assert_int_equal(picture_at(&p, k % WIDE, k / WIDE)[3], k / WIDE < row ? 0 : 255);
        picture_free(&p);
    }
}

/* ---- Areas ---- */

enum { RINGS = 40, CORNERS = 9 };

/* Stars all over the plane, some of them far larger than the picture, which cross themselves and each other. */
static camber_mesh *make_stars(const fixture *s, camber_renderer *renderer, uint64_t seed,
                               float points[2 * RINGS * CORNERS]) {
    uint32_t offsets[RINGS + 1] = {0};
    const camber_stroke stroke = {.width_px = 0};
    const camber_tessellation_desc how = {.strokes = &stroke, .stroke_count = 1};
    camber_polylines *areas = NULL;
    camber_mesh *mesh = NULL;
    for (uint32_t i = 0; i < RINGS; i++) {
        const double x = camber_random_between(&seed, -400, 560), y = camber_random_between(&seed, -500, 160);
        const double radius = camber_random_between(&seed, 3, i % 10 ? 60 : 300), turn = (double)i;
        for (uint32_t k = 0; k < CORNERS; k++) {
            const double angle = turn + 2 * SCENE_PI * k * (i % 3 + 1) / CORNERS;
            points[2 * (CORNERS * i + k)] = (float)(x + radius * cos(angle));
            points[2 * (CORNERS * i + k) + 1] = (float)(y + radius * sin(angle));
        }
        offsets[i + 1] = CORNERS * (i + 1);
    }
    const camber_areas_desc desc = {
        .points = points, .point_count = RINGS * CORNERS, .offsets = offsets, .ring_count = RINGS};
    assert_int_equal(camber_areas_create(s->context, &desc, &areas), CAMBER_OK);
    assert_int_equal(camber_mesh_create(s->on.device, renderer, &mesh), CAMBER_OK);
    assert_int_equal(camber_mesh_tessellate(mesh, areas, &how), CAMBER_OK);
    camber_polylines_destroy(areas);
    return mesh;
}

/* How often the stars, which all run one way, wind around a place of the plane. */
static int wind(const float points[2 * RINGS * CORNERS], const double place[2]) {
    int winding = 0;
    for (uint32_t i = 0; i < RINGS * CORNERS; i++) {
        const float *a = points + 2 * i, *b = points + 2 * (i % CORNERS == CORNERS - 1 ? i + 1 - CORNERS : i + 1);
        if (((double)a[1] <= place[1]) == ((double)b[1] <= place[1]))
            continue;
        const double t = (place[1] - (double)a[1]) / ((double)b[1] - (double)a[1]);
        if ((double)a[0] + t * ((double)b[0] - (double)a[0]) > place[0])
            winding += b[1] > a[1] ? 1 : -1;
    }
    return winding;
}

/* Whether a pixel that no edge comes near is inside, 1, or not, 0; -1: an edge may cross it. */
static int inside_of(const float *points, double pitch_deg, bool odd, uint32_t x, uint32_t y) {
    double middle[2], corner[2], depth, reach = 0.1;
    if (!meet(pitch_deg, x + 0.5, y + 0.5, middle, &depth))
        return -1;
    for (int k = 0; k < 4; k++) {
        if (!meet(pitch_deg, x - 0.1 + 1.2 * (k % 2), y - 0.1 + 1.2 * (k / 2), corner, &depth))
            return -1;
        reach = fmax(reach, length_of(corner[0] - middle[0], corner[1] - middle[1]));
    }
    for (uint32_t i = 0; i < RINGS * CORNERS; i++) {
        const uint32_t next = i % CORNERS == CORNERS - 1 ? i + 1 - CORNERS : i + 1;
        if (edge_distance(points + 2 * i, points + 2 * next, middle) < reach)
            return -1;
    }
    const int winding = wind(points, middle);
    return odd ? winding % 2 != 0 : winding != 0;
}

/* No pixel is full that has nothing of an area, nor empty that is inside: an edge that two stages saw otherwise would
 * leave a streak to the right of it. */
static void test_area_streaks(void **state) {
    const fixture *s = *state;
    camber_renderer *renderer = fixture_any(s);
    static float points[2 * RINGS * CORNERS];
    size_t total[2] = {0, 0};
    for (int i = 0; i < 3 * PITCH_COUNT; i++) {
        const double pitch_deg = PITCHES[i % PITCH_COUNT];
        const camber_fill fill = {.color = {1, 1, 1, 1}, .rule = i % 2 ? CAMBER_FILL_EVENODD : CAMBER_FILL_NONZERO};
        const camber_paint paint = {.fill = &fill};
        camber_mesh *mesh = make_stars(s, renderer, (uint64_t)i + 1, points);
        const camber_pass pass = {.mesh = mesh, .paints = &paint, .paint_count = 1};
        const camber_frame frame = {
            .width = WIDE, .height = HIGH, .passes = &pass, .pass_count = 1, .pitch_deg = pitch_deg};
        picture p = picture_draw(renderer, &frame);
        size_t counts[2] = {0, 0};
        for (uint32_t k = far_row(pitch_deg) * WIDE; k < WIDE * HIGH; k++) {
            const int inside = inside_of(points, pitch_deg, fill.rule == CAMBER_FILL_EVENODD, k % WIDE, k / WIDE);
            const int alpha = picture_at(&p, k % WIDE, k / WIDE)[3];
            if (inside < 0)
                continue;
            counts[inside]++;
            if (alpha != 255 * inside)
                fail_msg("pitch %g: pixel %u, %u has an alpha of %d", pitch_deg, k % WIDE, k / WIDE, alpha);
        }
        printf("# areas at %g degrees: %zu pixels outside, %zu inside\n", pitch_deg, counts[0], counts[1]);
        assert_true(counts[0] + counts[1] > 300);
        total[0] += counts[0], total[1] += counts[1];
        picture_free(&p);
        camber_mesh_destroy(mesh);
    }
    assert_true(total[0] > 10000 && total[1] > 10000);
}

/* ---- Upright passes ---- */

/* Upright lines look as they do without a pitch, at any pitch that shows no sky. */
static void test_upright_lines(void **state) {
    const fixture *s = *state;
    for (size_t f = 0; f < sizeof FIGURES / sizeof *FIGURES; f++)
        for (int b = 0; b < CAMBER_FIXTURE_DRAWERS; b++) {
            if (!s->on.renderer[b])
                continue;
            picture flat = draw(s, s->on.renderer[b], FIGURES + f, &(look){.method = CAMBER_METHOD_STRIP});
            for (int i = 0; i < 4; i++) {
                const look l = {
                    .pitch_deg = PITCHES[i % 2], .alpha = 1, .upright = true, .overlap = (camber_overlap)(i / 2)};
                picture upright = draw(s, s->on.renderer[b], FIGURES + f, &l);
                const difference d = picture_compare(&flat, &upright);
                if (d.mean > 1.5 || d.most > 90)
                    fail_msg("%s at %g degrees with %s: %.2f of 255 on average, %d at most", FIGURES[f].name,
                             l.pitch_deg, fixture_name(b), d.mean, d.most);
                picture_free(&upright);
            }
            picture_free(&flat);
        }
}

/* Upright areas of a colour or an image, above the same areas in the plane: where they have no ink the plane is seen,
 * and where they cover pixels, they look as without a pitch. */
static void test_upright_areas(void **state) {
    const fixture *s = *state;
    static float points[2 * RINGS * CORNERS];
    uint8_t texels[4 * 16];
    for (uint32_t i = 0; i < 16; i++)
        memcpy(texels + 4 * i, (const uint8_t[]){(uint8_t)(16 * i), (uint8_t)(255 - 9 * i), 80, 255}, 4);
    const camber_image image = {.rgba = texels, .width = 4, .height = 4};
    const camber_fill fills[] = {
        {.color = {0, 1, 0, 1}},
        {.color = {1, 1, 1, 1}, .image = &image, .width_px = 30, .height_px = 20, .x_px = 3, .bearing_deg = 25}};
    const camber_fill red = {.color = {1, 0, 0, 1}};
    const camber_paint below = {.fill = &red};
    for (int b = 0; b < CAMBER_FIXTURE_DRAWERS; b++)
        for (int k = 0; k < 2 && s->on.renderer[b]; k++) {
            camber_mesh *mesh = make_stars(s, s->on.renderer[b], 7, points);
            const camber_paint above = {.fill = fills + k};
            const camber_pass passes[] = {{.mesh = mesh, .paints = &below, .paint_count = 1},
                                          {.mesh = mesh,
                                           .paints = &above,
                                           .paint_count = 1,
                                           .first_polyline = 5,
                                           .polyline_count = 9,
                                           .upright = true}};
            camber_frame frame = {.width = WIDE, .height = HIGH, .passes = passes, .pass_count = 2, .pitch_deg = 60};
            picture both = picture_draw(s->on.renderer[b], &frame);
            frame.pass_count = 1;
            picture plane = picture_draw(s->on.renderer[b], &frame);
            frame.passes = passes + 1;
            frame.pitch_deg = 0;
            picture top = picture_draw(s->on.renderer[b], &frame);
            size_t covered = 0, clear = 0, off = 0;
            for (uint32_t i = 0; i < WIDE * HIGH; i++) {
                const uint8_t *seen = both.rgba + 4 * i, *over = top.rgba + 4 * i, *under = plane.rgba + 4 * i;
                covered += over[3] == 255;
                clear += over[3] == 0;
                for (int c = 0; c < 4; c++)
                    off += (over[3] == 255 && abs(seen[c] - over[c]) > 2) || (over[3] == 0 && seen[c] != under[c]);
            }
            printf("# upright areas, %s, fill %d: %zu pixels covered, %zu clear, %zu channels off\n", fixture_name(b),
                   k, covered, clear, off);
            assert_true(covered > 200 && clear > 200 && off <= 8); /* an edge may pass a corner of a pixel */
            picture_free(&top);
            picture_free(&plane);
            picture_free(&both);
            camber_mesh_destroy(mesh);
        }
}

/* ---- Along the line ---- */

/* Each dash by itself. */
static void test_dashes(void **state) {
    const fixture *s = *state;
    static double truth[WIDE * HIGH], part[WIDE * HIGH];
    static const float lengths[] = {14, 10};
    const figure lines[] = {{"dashes across", {20, 75, 140, 50}, 2, BUTT, 8},
                            {"dashes to the horizon", {80, 110, 84, -300}, 2, BUTT, 8},
                            {"round dashes", {80, 110, 84, -300}, 2, ROUND, 5}};
    for (size_t n = 0; n < 3; n++)
        for (int i = 0; i < PITCH_COUNT; i++) {
            const float *p = lines[n].points;
            const double dx = (double)(p[2] - p[0]), dy = (double)(p[3] - p[1]), total = length_of(dx, dy);
            memset(truth, 0, sizeof truth);
            for (double at = 0; at < total; at += 24) {
                figure dash = lines[n];
                const double from = at / total, to = fmin(at + 14, total) / total;
                dash.points[0] = p[0] + (float)(from * dx);
                dash.points[1] = p[1] + (float)(from * dy);
                dash.points[2] = p[0] + (float)(to * dx);
                dash.points[3] = p[1] + (float)(to * dy);
                make_truth(&dash, PITCHES[i], part);
                for (size_t k = 0; k < WIDE * HIGH; k++)
                    truth[k] += part[k];
            }
            const look l = {.pitch_deg = PITCHES[i], .dash = {lengths, 2}};
            picture drawn = draw(s, fixture_any(s), lines + n, &l);
            const error e = compare(&drawn, truth);
            printf("%s at %g degrees: %.2f of 255 on average, %.0f at %u, %u\n", lines[n].name, PITCHES[i], e.mean,
                   e.most, e.x, e.y);
            assert_true(e.mean <= (i == 0 ? 2 : i == 1 ? 6 : 16) && e.most <= 80);
            picture_free(&drawn);
        }
}

/* Far away, where a pixel holds many of them, dashes are their share of the line. */
static void test_far_dashes(void **state) {
    const fixture *s = *state;
    static const float fine[] = {1, 3};
    const figure line = {"far", {-300, -400, 500, -400}, 2, BUTT, 40};
    picture whole = draw(s, fixture_any(s), &line, &(look){.pitch_deg = 80});
    picture dashed = draw(s, fixture_any(s), &line, &(look){.pitch_deg = 80, .dash = {fine, 2}});
    size_t seen = 0;
    for (uint32_t k = 0; k < WIDE * HIGH; k++) {
        const double a = picture_value(&whole, k % WIDE, k / WIDE, 3),
                     b = picture_value(&dashed, k % WIDE, k / WIDE, 3);
        seen += a > 0.2;
        assert_true(fabs(b - 0.25 * a) < 0.02);
    }
    assert_true(seen > 100);
    picture_free(&dashed);
    picture_free(&whole);
}

/* Round dashes too fine to be seen fill their line and nothing past its ends. */
static void test_fine_round_dashes(void **state) {
    const fixture *s = *state;
    static const float fine[] = {0.4f, 0.6f};
    const figure line = {"fine", {64, 40, 100, 71}, 2, ROUND, 30};
    for (int i = 0; i < PITCH_COUNT; i++) {
        picture whole = draw(s, fixture_any(s), &line, &(look){.pitch_deg = PITCHES[i]});
        picture dashed = draw(s, fixture_any(s), &line, &(look){.pitch_deg = PITCHES[i], .dash = {fine, 2}});
        for (uint32_t k = 0; k < WIDE * HIGH; k++)
            assert_true(picture_value(&dashed, k % WIDE, k / WIDE, 3) <=
                        picture_value(&whole, k % WIDE, k / WIDE, 3) + 0.01);
        picture_free(&dashed);
        picture_free(&whole);
    }
}

/* ---- Networks ---- */

static void walk_world(camber_made_scene *s, uint64_t *seed) {
    for (size_t i = 0; i < 60; i++) {
        double x = camber_random_between(seed, -900, 1000), y = camber_random_between(seed, -1300, 400);
        double direction = camber_random_between(seed, -SCENE_PI, SCENE_PI);
        for (size_t k = 0; k < 12; k++) {
            const double length = camber_random_between(seed, 20, 400);
            camber_made_scene_point(s, x, y);
            direction += camber_random_between(seed, -0.8, 0.8);
            x += length * cos(direction);
            y += length * sin(direction);
        }
        camber_made_scene_end(s, i % 2);
    }
}

/* The same lines as a network, which is cut at what is seen, on the device and by the twin, and as they are. */
static void test_network(void **state) {
    const fixture *s = *state;
    camber_renderer *renderer = fixture_any(s);
    uint64_t seed = 20;
    camber_made_scene lines = {0};
    walk_world(&lines, &seed);
    double *points = malloc(2 * lines.point_count * sizeof *points);
    size_t offsets[64];
    camber_network_entry entries[64];
    assert_non_null(points);
    for (size_t i = 0; i < 2 * lines.point_count; i++)
        points[i] = (double)lines.points[i];
    for (size_t i = 0; i <= lines.polyline_count; i++)
        offsets[i] = lines.offsets[i];
    for (size_t i = 0; i < lines.polyline_count; i++)
        entries[i] = (camber_network_entry){(uint32_t)i, lines.rows[i], 0};
    const camber_network_desc network_desc = {.points = points,
                                              .offsets = offsets,
                                              .polyline_count = lines.polyline_count,
                                              .entries = entries,
                                              .entry_count = lines.polyline_count};
    const camber_stroke strokes[] = {BUTT, MITER};
    camber_stroke wide[2] = {strokes[0], strokes[1]};
    wide[0].width_px = 6;
    wide[1].width_px = 3;
    const camber_tessellation_desc desc = {.strokes = wide, .stroke_count = 2};
    const camber_paint paints[] = {{.width_px = 6, .color = {1, 1, 1, 1}}, {.width_px = 3, .color = {1, 1, 1, 1}}};
    camber_network *network = NULL;
    camber_mesh *mesh = NULL, *whole = fixture_mesh(s, renderer, &lines, &desc);
    assert_int_equal(camber_network_create(s->context, &network_desc, &network), CAMBER_OK);
    assert_int_equal(camber_mesh_create(s->on.device, renderer, &mesh), CAMBER_OK);
    for (int i = 0; i < PITCH_COUNT; i++) {
        const camber_camera camera = {
            .x = 0.5 * WIDE, .y = 0.5 * HIGH, .scale_px = 1, .width = WIDE, .height = HIGH, .pitch_deg = PITCHES[i]};
        camber_polylines *twin = NULL;
        camber_mesh_data of_device, of_twin;
        assert_int_equal(camber_mesh_tessellate_network(mesh, network, &camera, &desc), CAMBER_OK);
        assert_int_equal(camber_network_project(network, &camera, &desc, &twin), CAMBER_OK);
        assert_int_equal(camber_mesh_read(mesh, &of_device), CAMBER_OK);
        assert_int_equal(camber_mesh_data_tessellate(s->context, twin, &desc, &of_twin), CAMBER_OK);
        assert_true(of_twin.info.record_count > 0);
        assert_int_equal(of_device.info.record_count, of_twin.info.record_count);
        assert_memory_equal(of_device.records, of_twin.records, of_twin.info.record_count * sizeof *of_twin.records);
        camber_pass pass = {.mesh = mesh, .paints = paints, .paint_count = 2};
        const camber_frame frame = {
            .width = WIDE, .height = HIGH, .passes = &pass, .pass_count = 1, .pitch_deg = PITCHES[i]};
        picture cut = picture_draw(renderer, &frame);
        pass.mesh = whole;
        picture uncut = picture_draw(renderer, &frame);
        const difference d = picture_compare(&cut, &uncut);
        if (d.most > 8)
            fail_msg("%g degrees: %zu of %zu pixels differ by more than 8, by %d at most", PITCHES[i], d.past_8,
                     d.drawn, d.most);
        assert_true(d.drawn > 1000);
        picture_free(&uncut);
        picture_free(&cut);
        camber_mesh_data_destroy(&of_twin);
        camber_mesh_data_destroy(&of_device);
        camber_polylines_destroy(twin);
    }
    camber_mesh_destroy(whole);
    camber_mesh_destroy(mesh);
    camber_network_destroy(network);
    free(points);
    camber_made_scene_free(&lines);
}

/* Only the part of a long line that is seen is cut out: nothing lies behind the camera. */
static void test_window(void **state) {
    fixture *s = *state;
    const double points[] = {80, 1e7, 90, -1e7, -1e7, -200, 1e7, -210};
    const size_t offsets[] = {0, 2, 4};
    const camber_network_desc network_desc = {.points = points, .offsets = offsets, .polyline_count = 2};
    const camber_stroke stroke = {.width_px = 4};
    const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1};
    camber_network *network = NULL;
    assert_int_equal(camber_network_create(s->context, &network_desc, &network), CAMBER_OK);
    for (int i = 0; i < PITCH_COUNT; i++) {
        const camber_camera camera = {
            .x = 0.5 * WIDE, .y = 0.5 * HIGH, .scale_px = 1, .width = WIDE, .height = HIGH, .pitch_deg = PITCHES[i]};
        camber_lines lines;
        assert_int_equal(camber_network_project_lines(network, &camera, &desc, &lines), CAMBER_OK);
        assert_int_equal(lines.polyline_count, PITCHES[i] > 50 ? 2 : 1); /* the second one lies farther */
        for (size_t k = 0; k < lines.point_count; k++) {
            const double x = (double)lines.points[2 * k], y = (double)lines.points[2 * k + 1];
            const double angle = PITCHES[i] * SCENE_PI / 180, distance = 1.5 * HIGH;
            const double depth = 1 - (y - 0.5 * HIGH) * sin(angle) / distance;
            assert_true(depth > 0 && depth < 15 && fabs(x) < 15 * WIDE);
        }
        camber_lines_destroy(&lines);
    }
    camber_network_destroy(network);
}

static void test_bad_pitch(void **state) {
    fixture *s = *state;
    static const double bad[] = {-1, 85.001, 90, NAN, INFINITY};
    const double points[] = {0, 0, 10, 10};
    const size_t offsets[] = {0, 2};
    const camber_network_desc network_desc = {.points = points, .offsets = offsets, .polyline_count = 1};
    const camber_stroke stroke = {.width_px = 4};
    const camber_tessellation_desc desc = {.strokes = &stroke, .stroke_count = 1};
    camber_network *network = NULL;
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_network_create(s->context, &network_desc, &network), CAMBER_OK);
    assert_int_equal(camber_mesh_create(s->on.device, fixture_any(s), &mesh), CAMBER_OK);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const camber_camera camera = {.scale_px = 1, .width = WIDE, .height = HIGH, .pitch_deg = bad[i]};
        const camber_frame frame = {.width = WIDE, .height = HIGH, .pitch_deg = bad[i]};
        assert_int_equal(camber_mesh_tessellate_network(mesh, network, &camera, &desc), CAMBER_ERROR_ARGUMENT);
        assert_story(&s->h, "pitch");
        assert_int_equal(camber_renderer_render(fixture_any(s), &frame, NULL, NULL, NULL), CAMBER_ERROR_ARGUMENT);
        assert_story(&s->h, "pitch");
    }
    camber_mesh_destroy(mesh);
    camber_network_destroy(network);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_oracle),
        cmocka_unit_test(test_nearly_flat),
        cmocka_unit_test(test_pieces),
        cmocka_unit_test(test_backends),
        cmocka_unit_test(test_horizon),
        cmocka_unit_test(test_area_streaks),
        cmocka_unit_test(test_upright_lines),
        cmocka_unit_test(test_upright_areas),
        cmocka_unit_test(test_dashes),
        cmocka_unit_test(test_far_dashes),
        cmocka_unit_test(test_fine_round_dashes),
        cmocka_unit_test(test_network),
        cmocka_unit_test(test_window),
        cmocka_unit_test(test_bad_pitch),
    };
    return FIXTURE_RUN(tests);
}
