/* A torture sheet of polygons for a person to look at (tests/golden/polygons.png): a row of a kind each, black or grey
 * on white. Rows that are black are held against 16 x 16 samples of each pixel as well.
 *
 *     slivers | spikes | rings that cross themselves, by the non-zero rule | the same, by the even-odd rule |
 *     holes that touch, cross and leave their ring | shores of 10^4 points | polygons below a pixel |
 *     neighbours that share borders at all angles | one translucent colour over itself | outlines */
#include "golden.h"

#include "validate/oracle.h"

#include <math.h>

enum { CELL_PX = 60, COLUMNS = 11, RINGS_MAX = 4096, POINTS_MAX = 1 << 18 };

typedef enum row {
    SLIVERS = 0,
    SPIKES,
    CROSSINGS,
    CROSSINGS_EVENODD,
    HOLES,
    SHORES,
    TINY,
    BORDERS,
    TRANSLUCENT,
    OUTLINES,
    ROWS
} row;

typedef struct board {
    float *points;
    uint32_t *offsets, *rings, *rows; /* rows: by area */
    size_t point_count, ring_count, area_count;
    size_t first_ring[ROWS + 1];
    double x, y, cosine, sine; /* where the cell's middle lies, and how its figure is turned */
    row at;
} board;

static void point(board *b, double x, double y) {
    assert_true(b->point_count < POINTS_MAX);
    b->points[2 * b->point_count] = (float)(b->x + x * b->cosine - y * b->sine);
    b->points[2 * b->point_count++ + 1] = (float)(b->y + x * b->sine + y * b->cosine);
}

/* Ends a ring where it begins, and turns it: outer rings clockwise as seen, holes the other way. */
static void end_ring(board *b, bool hole) {
    const size_t first = b->offsets[b->ring_count];
    float *points = b->points + 2 * first;
    double area = 0;
    assert_true(b->point_count < POINTS_MAX && b->ring_count < RINGS_MAX);
    memcpy(b->points + 2 * b->point_count++, points, 2 * sizeof *points);
    const size_t count = b->point_count - first;
    for (size_t i = 0; i + 1 < count; i++)
        area +=
            (double)points[2 * i] * (double)points[2 * i + 3] - (double)points[2 * i + 2] * (double)points[2 * i + 1];
    for (size_t i = 0, k = count - 1; (area < 0) != hole && i < k; i++, k--)
        for (size_t axis = 0; axis < 2; axis++) {
            const float kept = points[2 * i + axis];
            points[2 * i + axis] = points[2 * k + axis];
            points[2 * k + axis] = kept;
        }
    if (!hole) {
        b->rings[b->area_count] = (uint32_t)b->ring_count;
        b->rows[b->area_count++] = (uint32_t)b->at;
    }
    b->offsets[++b->ring_count] = (uint32_t)b->point_count;
    b->rings[b->area_count] = (uint32_t)b->ring_count;
}

static void box(board *b, double left, double top, double right, double bottom, bool hole) {
    point(b, left, top);
    point(b, right, top);
    point(b, right, bottom);
    point(b, left, bottom);
    end_ring(b, hole);
}

static void star(board *b, double radius, int corners, int step, bool hole) {
    for (int i = 0; i < corners; i++) {
        const double turn = 2 * SCENE_PI * i * step / corners;
        point(b, radius * cos(turn), radius * sin(turn));
    }
    end_ring(b, hole);
}

/* ---- Rows ---- */

static void add_sliver(board *b, int i) {
    static const double widths_px[] = {0.05, 0.1, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 2, 3, 4, 6};
    point(b, -26, -widths_px[i] / 2);
    point(b, 26, 0);
    point(b, -26, widths_px[i] / 2);
    end_ring(b, false);
}

/* Out to the tip of a needle and back, the wider the farther to the right; the first has no width at all. */
static void add_spike(board *b, int i) {
    point(b, -12, -12);
    point(b, 12, -12);
    point(b, 12, -0.1 * i);
    point(b, 27, 0);
    point(b, 12, 0.1 * i);
    point(b, 12, 12);
    point(b, -0.05 * i, 12);
    point(b, 0, -27);
    point(b, 0.05 * i, 12);
    point(b, -12, 12);
    end_ring(b, false);
}

static void add_crossing(board *b, int i) {
    static const int corners[] = {5, 7, 7, 9, 11, 13}, steps[] = {2, 2, 3, 4, 3, 6};
    if (i < 6) {
        star(b, 26, corners[i], steps[i], false);
        return;
    }
    /* Loops: a curve that winds i - 5 times around the middle, and a small way round or not at all in between. */
    for (int k = 0; k < 240; k++) {
        const double turn = 2 * SCENE_PI * k / 240, radius = 15 + 11 * sin((i - 4.5) * turn * 2 + i);
        point(b, radius * cos((i - 5) * turn), radius * sin((i - 5) * turn));
    }
    end_ring(b, false);
}

static void add_holes(board *b, int i) {
    box(b, -20, -20, 20, 20, false);
    switch (i) {
    case 0: box(b, -10, -10, 10, 10, true); break;
    case 1: box(b, -20, -10, 0, 10, true); break;  /* a border on the ring's */
    case 2: box(b, -20, -20, 0, 0, true); break;   /* a corner and two borders */
    case 3: box(b, 5, -8, 28, 8, true); break;     /* leaves the ring */
    case 4: box(b, 22, -10, 28, 10, true); break;  /* lies outside */
    case 5: box(b, -20, -20, 20, 20, true); break; /* leaves nothing */
    case 6: star(b, 20, 4, 1, true); break;        /* touches each border in a point */
    case 7: star(b, 16, 5, 2, true); break;        /* crosses itself */
    case 8:                                        /* touch in a point, or share a border */
    case 9:
        box(b, -15, -15, 0, i == 8 ? 0 : 15, true);
        box(b, 0, i == 8 ? 0 : -15, 15, 15, true);
        break;
    default: /* overlap */
        for (int k = 0; k < 9; k++)
            box(b, -18 + 12 * (k % 3), -18 + 12 * (k / 3), -5.5 + 12 * (k % 3), -5.5 + 12 * (k / 3), true);
    }
}

static void add_shore(board *b, int i) {
    enum { POINTS = 10000 };
    for (int k = 0; k < POINTS; k++) {
        const double turn = 2 * SCENE_PI * k / POINTS;
        const double radius = 18 + 5 * sin((3 + i * i) * turn) + 3 * sin((2 + 7 * i) * turn);
        point(b, radius * cos(turn), radius * sin(turn));
    }
    end_ring(b, false);
}

static void add_tiny(board *b, int i) {
    for (int k = 0; k < 100; k++) {
        const double side = 0.1 + 0.1 * i, x = -24 + 5.13 * (k % 10), y = -24 + 5.07 * (k / 10);
        box(b, x, y, x + side, y + side * (k % 3 == 0 ? 2 : 1), false);
    }
}

static void add_borders(board *b, int i) {
    enum { WEDGES = 24 };
    for (int k = 0; k < WEDGES && i % 2; k++) {
        point(b, 0, 0);
        for (int end = 0; end < 2; end++)
            point(b, 26 * cos(2 * SCENE_PI * (k + end) / WEDGES), 26 * sin(2 * SCENE_PI * (k + end) / WEDGES));
        end_ring(b, false);
    }
    for (int k = 0; k < 49 && i % 2 == 0; k++)
        box(b, -18.2 + 5.2 * (k % 7), -18.2 + 5.2 * (k / 7), -13 + 5.2 * (k % 7), -13 + 5.2 * (k / 7), false);
}

static void add_translucent(board *b, int i) {
    for (int k = 0; k < 3; k++)
        box(b, -22 + 9 * k, -22 + (4 + i) * k, 4 + 9 * k, (4 + i) * k, false);
}

static void add_outlined(board *b, int i) {
    star(b, 24, 3 + i / 2, i % 2 && i > 3 ? 2 : 1, false);
    if (i % 3 == 2)
        box(b, -5, -5, 5, 5, true);
}

static void make_board(board *b) {
    static void (*const add[ROWS])(board * b, int i) = {add_sliver,      add_spike,   add_crossing, add_crossing,
                                                        add_holes,       add_shore,   add_tiny,     add_borders,
                                                        add_translucent, add_outlined};
    *b = (board){.points = calloc(2 * POINTS_MAX, sizeof(float)),
                 .offsets = calloc(RINGS_MAX + 1, sizeof(uint32_t)),
                 .rings = calloc(RINGS_MAX + 1, sizeof(uint32_t)),
                 .rows = calloc(RINGS_MAX, sizeof(uint32_t))};
    assert_true(b->points && b->offsets && b->rings && b->rows);
    for (b->at = SLIVERS; b->at < ROWS; b->at++) {
        b->first_ring[b->at] = b->ring_count;
        for (int i = 0; i < COLUMNS; i++) {
            const double turn = 0.13 + 0.55 * i;
            b->x = CELL_PX * (i + 0.5) + 0.37, b->y = CELL_PX * ((int)b->at + 0.5) + 0.61;
            b->cosine = cos(turn), b->sine = sin(turn);
            add[b->at](b, i);
        }
    }
    b->first_ring[ROWS] = b->ring_count;
}

static void free_board(board *b) {
    free(b->points);
    free(b->offsets);
    free(b->rings);
    free(b->rows);
}

/* ---- Pictures ---- */

static camber_mesh *mesh_of(const fixture *s, camber_renderer *renderer, const board *b) {
    const camber_areas_desc desc = {.points = b->points,
                                    .point_count = b->point_count,
                                    .offsets = b->offsets,
                                    .ring_count = b->ring_count,
                                    .rings = b->rings,
                                    .area_count = b->area_count,
                                    .rows = b->rows};
    camber_stroke strokes[ROWS] = {{0}};
    const camber_tessellation_desc how = {.strokes = strokes, .stroke_count = ROWS};
    camber_polylines *areas = NULL;
    camber_mesh *mesh = NULL;
    strokes[OUTLINES].width_px = 1.5f;
    assert_int_equal(camber_areas_create(s->context, &desc, &areas), CAMBER_OK);
    assert_int_equal(camber_mesh_create(s->on.device, renderer, &mesh), CAMBER_OK);
    assert_int_equal(camber_mesh_tessellate(mesh, areas, &how), CAMBER_OK);
    camber_polylines_destroy(areas);
    return mesh;
}

static picture draw_board(camber_renderer *renderer, camber_mesh *mesh, const board *b) {
    const camber_fill black = {.color = {0, 0, 0, 1}}, grey = {.color = {0.7f, 0.7f, 0.7f, 1}};
    const camber_fill odd = {.color = {0, 0, 0, 1}, .rule = CAMBER_FILL_EVENODD};
    const camber_fill half = {.color = {0, 0, 0, 0.5f}};
    camber_paint fills[ROWS], lines[ROWS] = {{0}};
    for (int i = 0; i < ROWS; i++)
        fills[i] = (camber_paint){.fill = i == CROSSINGS_EVENODD ? &odd
                                          : i == TRANSLUCENT     ? &half
                                          : i == OUTLINES        ? &grey
                                                                 : &black};
    lines[OUTLINES] = (camber_paint){.width_px = 1.5f, .color = {0.2f, 0.2f, 0.2f, 1}};
    const camber_pass passes[] = {
        {.mesh = mesh, .paints = fills, .paint_count = ROWS},
        {.mesh = mesh, .paints = lines, .paint_count = ROWS, .first_polyline = b->first_ring[OUTLINES]}};
    const camber_frame frame = {.width = COLUMNS * CELL_PX,
                                .height = ROWS * CELL_PX,
                                .background = {1, 1, 1, 1},
                                .passes = passes,
                                .pass_count = 2};
    return picture_draw(renderer, &frame);
}

/* The mean error of a row's pixels that are not white in both, of 255. */
static double error_of(const board *b, row at, const picture *drawn) {
    camber_lines rings = {.points = b->points, .offsets = b->offsets + b->first_ring[at]};
    float *truth = malloc(sizeof *truth * COLUMNS * CELL_PX * ROWS * CELL_PX);
    double sum = 0;
    size_t count = 0;
    assert_non_null(truth);
    rings.point_count = b->point_count;
    rings.polyline_count = b->first_ring[at + 1] - b->first_ring[at];
    assert_true(camber_oracle_fill(&rings, at == CROSSINGS_EVENODD ? CAMBER_ORACLE_EVENODD : CAMBER_ORACLE_NONZERO,
                                   COLUMNS * CELL_PX, ROWS * CELL_PX, truth));
    for (uint32_t y = CELL_PX * at; y < CELL_PX * (at + 1u); y++)
        for (uint32_t x = 0; x < drawn->width; x++) {
            const double share = (double)truth[y * drawn->width + x];
            const double off = fabs(255 * (1 - share) - 255 * picture_value(drawn, x, y, 0));
            count += share > 0 || off > 0;
            sum += off;
        }
    free(truth);
    assert_true(count > 500);
    return sum / (double)count;
}

/* Samples themselves are off by some 0.15, and 8 bits by 0.25. */
static void test_sheet(void **state) {
    static const char *const names[] = {"slivers", "spikes", "crossings", "crossings, even-odd",
                                        "holes",   "shores", "tiny",      "borders"};
    static const double bounds[] = {0.9, 0.23, 0.23, 0.5, 0.28, 0.9, 1, 0.3};
    const fixture *s = *state;
    board b;
    make_board(&b);
    for (int k = 0; k < CAMBER_FIXTURE_DRAWERS; k++) {
        if (!s->on.renderer[k])
            continue;
        camber_mesh *mesh = mesh_of(s, s->on.renderer[k], &b);
        picture drawn = draw_board(s->on.renderer[k], mesh, &b);
        bool good = true;
        for (int i = SLIVERS; i <= BORDERS; i++) {
            const double error = error_of(&b, (row)i, &drawn);
            printf("# %-20s with %s: %.3f of 255 on average\n", names[i], fixture_name(k), error);
            good = good && error <= bounds[i];
        }
        assert_true(golden_judge(s, "polygons", &drawn) && good);
        picture_free(&drawn);
        camber_mesh_destroy(mesh);
    }
    free_board(&b);
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_sheet)};
    return cmocka_run_group_tests(tests, fixture_set_up, fixture_tear_down);
}
