/* Areas: the device beside the twin to the last bit; pictures beside 16 x 16 samples of each pixel, which share no
 * formula with what they judge; no seam between neighbours; the same bytes in areas and slices of any size; a camera
 * that cuts rings beside rings that are not cut; many fills, in their order and by few kernels. */
#include "raster_twin.h"

#include "camber_network.h"
#include "draw/renderer.h"
#include "gpu/launch.h"

#include <math.h>

enum { SIDE_PX = 500, SAMPLES = 16 };

/* ---- Rings ---- */

typedef struct rings {
    float *points;
    uint32_t *offsets, *rows;
    size_t point_count, ring_count, point_capacity;
} rings;

static rings rings_begin(size_t most_points) {
    rings r = {.points = malloc(2 * most_points * sizeof *r.points),
               .offsets = calloc(most_points + 1, sizeof *r.offsets),
               .rows = calloc(most_points, sizeof *r.rows),
               .point_capacity = most_points};
    assert_true(r.points && r.offsets && r.rows);
    return r;
}

static void rings_free(rings *r) {
    free(r->points);
    free(r->offsets);
    free(r->rows);
}

static void add_point(rings *r, double x, double y) {
    assert_true(r->point_count < r->point_capacity);
    r->points[2 * r->point_count] = (float)x;
    r->points[2 * r->point_count++ + 1] = (float)y;
}

static void end_ring(rings *r, uint32_t row) {
    r->rows[r->ring_count++] = row;
    r->offsets[r->ring_count] = (uint32_t)r->point_count;
}

/* A star of some corners: pointed where they are odd, with a step of 2 that crosses itself. */
static void add_star(rings *r, double x, double y, double radius, int corners, int step, double angle, uint32_t row) {
    for (int i = 0; i < corners; i++) {
        const double a = angle + 6.283185307179586 * i * step / corners;
        add_point(r, x + radius * cos(a), y + radius * sin(a));
    }
    end_ring(r, row);
}

static double next_number(uint64_t *seed) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 33) / (double)(1u << 31);
}

/* Rings of all sizes, some of them crossing themselves, some far larger than the picture. */
static rings made_rings(uint64_t seed, size_t count, double largest, uint32_t row_count) {
    rings r = rings_begin(40 * count);
    for (size_t i = 0; i < count; i++) {
        const double size = largest * pow(next_number(&seed), 4.0) + 0.3;
        const double x = 1.4 * SIDE_PX * next_number(&seed) - 0.2 * SIDE_PX;
        const double y = 1.4 * SIDE_PX * next_number(&seed) - 0.2 * SIDE_PX;
        const int corners = 3 + (int)(i % 9);
        add_star(&r, x, y, size, corners, i % 7 == 3 ? 2 : 1, 3.0 * next_number(&seed), (uint32_t)(i % row_count));
    }
    return r;
}

/* Corners on borders of cells and between them. */
static void round_points(rings *r) {
    for (size_t i = 0; i < 2 * r->point_count; i++)
        r->points[i] = floorf(r->points[i]);
}

static camber_mesh *stroked_mesh_of(const fixture *f, camber_renderer *renderer, const rings *r,
                                    const camber_tessellation_desc *how) {
    const camber_areas_desc desc = {.points = r->points,
                                    .point_count = r->point_count,
                                    .offsets = r->offsets,
                                    .ring_count = r->ring_count,
                                    .rows = r->rows};
    camber_polylines *areas = NULL;
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_areas_create(f->context, &desc, &areas), CAMBER_OK);
    assert_int_equal(camber_mesh_create(f->on.device, renderer, &mesh), CAMBER_OK);
    assert_int_equal(camber_mesh_tessellate(mesh, areas, how), CAMBER_OK);
    camber_polylines_destroy(areas);
    return mesh;
}

static camber_mesh *mesh_of(const fixture *f, camber_renderer *renderer, const rings *r, uint32_t row_count) {
    const camber_stroke strokes[4] = {{.width_px = 0}, {.width_px = 3}, {.width_px = 0}, {.width_px = 9}};
    const camber_tessellation_desc how = {strokes, row_count, CAMBER_METHOD_STRIP, 0, false};
    return stroked_mesh_of(f, renderer, r, &how);
}

static camber_renderer *drawer(const fixture *f) {
    return f->on.renderer[CAMBER_FIXTURE_OPENCL];
}

/* Opens a device and what draws with it. */
static fixture open_other(const fixture *f, const camber_device_desc *desc) {
    fixture other = {.context = f->context};
    assert_int_equal(camber_device_create(f->context, desc, &other.on.device), CAMBER_OK);
    assert_int_equal(camber_renderer_create(other.on.device, NULL, NULL, &other.on.renderer[CAMBER_FIXTURE_OPENCL]),
                     CAMBER_OK);
    return other;
}

static void close_other(fixture *other) {
    camber_renderer_destroy(drawer(other));
    camber_device_destroy(other->on.device);
}

/* ---- Device and twin ---- */

/* Areas by both rules, lines over some of them, a fill of the picture, and areas again; all rows of a mesh, in a group
 * and straight. */
static void compare_with_twin(const fixture *f) {
    static const camber_brush_ext nothing[5];
    static const double pitches[] = {0, 1, 30, 60, 85};
    for (uint64_t seed = 1; seed <= 5; seed++) {
        rings r = made_rings(seed, seed >= 4 ? 3000 : 300, seed >= 4 ? 60 : 900, 2);
        if (seed == 5)
            round_points(&r);
        camber_mesh *mesh = mesh_of(f, drawer(f), &r, 2);
        float rows[6][CAMBER_RASTER_ROW_WORDS] = {{0, 0, 0, 0}, {-1, 0, 0, 0}, {-1, 0, 0, 0},
                                                  {1, 2, 3, 0}, {0, 4, 5, 0},  {0, 0.5f, 0, 0}};
        const uint32_t of_rows[6] = {1, 0, 0, 2, 4, 4};
        const camber_brush brushes[5] = {
            {.fill = 3},
            {.r = 1, .a = 0.5f, .mode = CAMBER_BRUSH_AREA_EVENODD},
            {.g = 1, .a = 1, .mode = CAMBER_BRUSH_OVER},
            {.g = 0.5f, .a = 0.2f, .mode = CAMBER_BRUSH_AREA},
            {.b = 1, .r = 0.5f, .a = 0.8f, .mode = CAMBER_BRUSH_AREA, .group = 1, .fill = 3, .group_opacity = 0.7f}};
        for (int i = 0; i < 6; i++)
            memcpy(rows[i] + 3, of_rows + i, sizeof *of_rows);
        const size_t end = mesh->polyline_count;
        const camber_raster_input inputs[] = {
            {mesh, 0, end, 0, true}, {mesh, 0, end / 2, 2, false}, {mesh, end / 3, end, 4, true}};
        camber_raster_scene drawn = {rows[0], 6, brushes, 5, inputs, 3, {0.2f, 0.3f, 0.4f, 1}, false};
        const camber_raster_area area = {32 * (uint32_t)seed, 64, 300, 333};
        uint8_t *plain = raster_draw_twice(f, &drawn, area);
        drawn.brush_ext = nothing;
        uint8_t *rich = raster_draw_twice(f, &drawn, area);
        assert_memory_equal(plain, rich, 4 * (size_t)area.width * area.height);
        camber_free(f->context, plain);
        camber_free(f->context, rich);
        for (size_t i = 0; i < sizeof pitches / sizeof *pitches; i++) {
            raster_tilt(&drawn, pitches[i], SIDE_PX, SIDE_PX);
            camber_free(f->context, raster_draw_twice(f, &drawn, area));
        }
        camber_mesh_destroy(mesh);
        rings_free(&r);
    }
}

static void test_twin(void **state) {
    compare_with_twin(*state);
}

/* Kernels as a GPU runs them: work-items share a tile. */
static void test_cells(void **state) {
    const camber_device_desc desc = {.lanes = 1};
    fixture other = open_other(*state, &desc);
    compare_with_twin(&other);
    close_other(&other);
}

/* ---- Pictures ---- */

static picture draw_mesh(camber_renderer *renderer, camber_mesh *mesh, const camber_fill *fill, uint32_t side) {
    const camber_paint paints[4] = {{.fill = fill}, {.fill = fill}, {.fill = fill}, {.fill = fill}};
    const camber_pass pass = {.mesh = mesh, .paints = paints, .paint_count = 4};
    const camber_frame frame = {.width = SIDE_PX,
                                .height = SIDE_PX,
                                .background = {1, 1, 1, 1},
                                .passes = &pass,
                                .pass_count = 1,
                                .largest_area_px = side};
    return picture_draw(renderer, &frame);
}

static picture draw_rings(const fixture *f, const rings *r, const camber_fill *fill, uint32_t side) {
    camber_mesh *mesh = mesh_of(f, drawer(f), r, 4);
    picture p = draw_mesh(drawer(f), mesh, fill, side);
    camber_mesh_destroy(mesh);
    return p;
}

/* The rows that a ring crosses, and which way it goes around. */
typedef struct ring_extent {
    double top, bottom;
    int sign;
} ring_extent;

static ring_extent extent_of(const rings *r, size_t ring) {
    const size_t first = r->offsets[ring], count = r->offsets[ring + 1] - first;
    ring_extent extent = {INFINITY, -INFINITY, 1};
    double area = 0;
    for (size_t i = 0; i < count; i++) {
        const float *a = r->points + 2 * (first + i), *b = r->points + 2 * (first + (i + 1) % count);
        area += (double)a[0] * (double)b[1] - (double)b[0] * (double)a[1];
        extent.top = fmin(extent.top, (double)a[1]);
        extent.bottom = fmax(extent.bottom, (double)a[1]);
    }
    extent.sign = area < 0 ? -1 : 1;
    return extent;
}

/* Adds how often each ring, clockwise as seen, winds around the samples of a row, by where its edges cross that. */
static void wind_samples(const rings *r, const ring_extent *extents, double y, int *windings) {
    for (size_t k = 0; k < r->ring_count; k++) {
        const size_t first = r->offsets[k], count = r->offsets[k + 1] - first;
        if (y < extents[k].top || y > extents[k].bottom)
            continue;
        for (size_t i = 0; i < count; i++) {
            const float *a = r->points + 2 * (first + i), *b = r->points + 2 * (first + (i + 1 < count ? i + 1 : 0));
            if (((double)a[1] <= y) == ((double)b[1] <= y))
                continue;
            const double t = (y - (double)a[1]) / ((double)b[1] - (double)a[1]);
            const double x = (double)a[0] + t * ((double)b[0] - (double)a[0]);
            const double sample = ceil(x * SAMPLES - 0.5);
            const int at = sample < 0 ? 0 : sample > SIDE_PX * SAMPLES ? SIDE_PX * SAMPLES : (int)sample;
            windings[at] += (b[1] > a[1] ? 1 : -1) * extents[k].sign;
        }
    }
}

/* The share of each pixel that is inside. */
static double *sample_rings(const rings *r, bool evenodd) {
    double *truth = calloc(SIDE_PX * SIDE_PX, sizeof *truth);
    int *windings = malloc((SIDE_PX * SAMPLES + 1) * sizeof *windings);
    ring_extent *extents = malloc(r->ring_count * sizeof *extents);
    assert_true(truth && windings && extents);
    for (size_t k = 0; k < r->ring_count; k++)
        extents[k] = extent_of(r, k);
    for (int row = 0; row < SIDE_PX * SAMPLES; row++) {
        int winding = 0;
        memset(windings, 0, (SIDE_PX * SAMPLES + 1) * sizeof *windings);
        wind_samples(r, extents, (row + 0.5) / SAMPLES, windings);
        for (int x = 0; x < SIDE_PX; x++) {
            int inside = 0;
            for (int i = SAMPLES * x; i < SAMPLES * (x + 1); i++) {
                winding += windings[i];
                inside += evenodd ? winding % 2 != 0 : winding != 0;
            }
            truth[row / SAMPLES * SIDE_PX + x] += (double)inside / (SAMPLES * SAMPLES);
        }
    }
    free(extents);
    free(windings);
    return truth;
}

/* Mean and worst error, of 255, over pixels that are not all white. */
static void judge(const char *what, const picture *p, const double *truth, double most_mean) {
    double sum = 0, worst = 0;
    size_t count = 0;
    for (uint32_t y = 0; y < SIDE_PX; y++)
        for (uint32_t x = 0; x < SIDE_PX; x++) {
            const double share = truth[y * SIDE_PX + x];
            const double off = fabs(255.0 * (1.0 - share) - 255.0 * picture_value(p, x, y, 0));
            if (share <= 0 && off <= 0)
                continue;
            sum += off;
            worst = off > worst ? off : worst;
            count++;
        }
    printf("# %-36s %.4f of 255 on average, %.1f at most, %zu pixels\n", what, sum / (double)count, worst, count);
    assert_true(count > 1000 && sum / (double)count <= most_mean);
}

static const camber_fill BLACK = {.color = {0, 0, 0, 1}};

/* Stars apart from each other, each drawn some times, the later ones moved by a step, px. */
static rings made_stars(int times, double step) {
    rings r = rings_begin(20000);
    for (int i = 0; i < 400 * times; i++) {
        const int k = i % 400;
        add_star(&r, 12.3 + 25 * (k % 20) + step * (i / 400), 12.7 + 25 * (k / 20), 11, 3 + k % 8, 1, 0.1 * k, 0);
    }
    return r;
}

/* Upright rectangles that overlap, three in each square of 32 px, their sides on sixteenths of pixels. */
static rings made_rectangles(double off) {
    rings r = rings_begin(4000);
    uint64_t seed = 11;
    for (int i = 0; i < 3 * 225; i++) {
        const double left = 32 * (i / 3 % 15) + 2 + floor(13 * next_number(&seed)) + off;
        const double top = 32 * (i / 45) + 2 + floor(13 * next_number(&seed)) + off;
        const double right = left + 3 + floor(12 * next_number(&seed));
        const double bottom = top + 3 + floor(12 * next_number(&seed));
        add_point(&r, left, top);
        add_point(&r, right, top);
        add_point(&r, right, bottom);
        add_point(&r, left, bottom);
        end_ring(&r, 0);
    }
    return r;
}

/* A shore with waves of several lengths, whose edges are a twentieth of a pixel long. */
static rings made_shore(void) {
    enum { POINTS = 20000 };
    rings r = rings_begin(POINTS);
    for (int i = 0; i < POINTS; i++) {
        const double turn = 6.283185307179586 * i / POINTS;
        const double radius = 150 + 20 * sin(7 * turn) + 5 * sin(61 * turn) + 0.3 * sin(1501 * turn);
        add_point(&r, 250 + radius * cos(turn), 250 + radius * sin(turn));
    }
    end_ring(&r, 0);
    return r;
}

/* Apart from each other, twice over each other, three times with borders less than a pixel apart, overlapping each
 * other and themselves, tiny ones, some whose edges lie level, on borders of pixels and between them, and one of many
 * edges inside each pixel. */
static void test_truth(void **state) {
    const fixture *f = *state;
    camber_fill evenodd = BLACK;
    evenodd.rule = CAMBER_FILL_EVENODD;
    rings all[] = {made_stars(1, 0),          made_stars(2, 0),   made_stars(3, 0.3),        made_rings(5, 60, 200, 1),
                   made_rings(6, 600, 60, 1), made_rectangles(0), made_rectangles(5.0 / 16), made_shore()};
    static const char *const names[] = {"apart", "twice", "moved",          "overlapping",
                                        "many",  "level", "level, between", "a shore"};
    static const double bounds[] = {0.15, 0.25, 0.4, 0.04, 0.15, 0, 0.2, 0.04};
    for (int i = 0; i < 8; i++) {
        for (int rule = 0; rule < (i == 1 ? 1 : 2); rule++) { /* by even-odd nothing is twice inside */
            picture p = draw_rings(f, all + i, rule ? &evenodd : &BLACK, 0);
            double *truth = sample_rings(all + i, rule);
            char what[64];
            snprintf(what, sizeof what, "%s, by %s", names[i], rule ? "even-odd" : "non-zero");
            judge(what, &p, truth, bounds[i]);
            free(truth);
            picture_free(&p);
        }
        rings_free(all + i);
    }
}

/* Ten thousand squares that meet, turned by any angle: a field of one colour, translucent too. */
static void test_seams(void **state) {
    const fixture *f = *state;
    for (int i = 0; i < 12; i++) {
        const double angle = 0.13 * i, cosine = cos(angle), sine = sin(angle), step = 7.3;
        const float alpha = i % 2 ? 0.4f : 1.0f;
        const camber_fill fill = {.color = {0.2f, 0.5f, 0.3f, alpha}};
        rings r = rings_begin(40000);
        for (int k = 0; k < 10000; k++) {
            for (int corner = 0; corner < 4; corner++) {
                const double u = step * (k % 100 + (corner == 1 || corner == 2) - 50);
                const double v = step * (k / 100 + (corner >= 2) - 50);
                add_point(&r, 250 + u * cosine - v * sine, 250 + u * sine + v * cosine);
            }
            end_ring(&r, 0);
        }
        picture p = draw_rings(f, &r, &fill, 0);
        const uint8_t *middle = picture_at(&p, 250, 250);
        for (uint32_t y = 20; y < SIDE_PX - 20; y++)
            for (uint32_t x = 20; x < SIDE_PX - 20; x++)
                if (hypot((double)x - 250, (double)y - 250) < 230)
                    assert_memory_equal(picture_at(&p, x, y), middle, 4);
        picture_free(&p);
        rings_free(&r);
    }
}

/* ---- The same bytes ---- */

static picture draw_black(const fixture *f, const rings *r, uint32_t side) {
    return draw_rings(f, r, &BLACK, side);
}

/* Areas, lines, and areas again, with translucent fills of the picture between and above them. */
static picture draw_veiled(const fixture *f, const rings *r, uint32_t side) {
    const camber_fill red = {.color = {1, 0, 0, 0.6f}}, blue = {.color = {0, 0, 1, 0.4f}};
    const camber_paint below[4] = {{.fill = &red}, {.fill = &red}, {.fill = &red}, {.fill = &red}};
    const camber_paint above[4] = {{.fill = &blue}, {.fill = NULL}, {.fill = &blue}, {.fill = NULL}};
    const camber_paint lines[4] = {{.width_px = 0}, {.width_px = 2, .color = {0, 0, 0, 1}}};
    camber_mesh *mesh = mesh_of(f, drawer(f), r, 4);
    const camber_pass passes[] = {{.mesh = mesh, .paints = below, .paint_count = 4},
                                  {.kind = CAMBER_PASS_FILL, .fill = {.color = {0, 1, 0, 0.2f}}},
                                  {.kind = CAMBER_PASS_FILL, .fill = {.color = {1, 1, 0, 0.3f}}},
                                  {.mesh = mesh, .paints = lines, .paint_count = 4},
                                  {.kind = CAMBER_PASS_FILL, .fill = {.color = {0, 1, 1, 0.25f}}},
                                  {.mesh = mesh, .paints = above, .paint_count = 4},
                                  {.kind = CAMBER_PASS_FILL, .fill = {.color = {1, 0, 1, 0.15f}}}};
    const camber_frame frame = {.width = SIDE_PX,
                                .height = SIDE_PX,
                                .background = {1, 1, 1, 1},
                                .passes = passes,
                                .pass_count = sizeof passes / sizeof *passes,
                                .largest_area_px = side};
    picture p = picture_draw(drawer(f), &frame);
    camber_mesh_destroy(mesh);
    return p;
}

static void cut_pictures(const fixture *f, picture (*draw)(const fixture *, const rings *, uint32_t)) {
    static const uint32_t sides[] = {33, 64, 320, 499};
    rings r = made_rings(9, 2000, 40, 2);
    picture whole = draw(f, &r, 0);
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
        picture p = draw(f, &r, sides[i]);
        picture_assert_same(&whole, &p);
        picture_free(&p);
    }
    static const camber_device_desc small_ones[] = {{.largest_buffer_bytes = 1024 * 1024},
                                                    {.largest_buffer_bytes = 300 * 1024},
                                                    {.largest_buffer_bytes = 140 * 1024},
                                                    {.largest_buffer_bytes = 300 * 1024, .lanes = 1},
                                                    {.largest_buffer_bytes = 200 * 1024, .lanes = 1}};
    uint32_t most = 0;
    for (size_t i = 0; i < sizeof small_ones / sizeof *small_ones; i++) {
        fixture small = open_other(f, small_ones + i);
        picture p = draw(&small, &r, 0);
        const uint32_t slices = camber_raster_slice_count(drawer(&small)->raster);
        most = slices > most ? slices : most;
        picture_assert_same(&whole, &p);
        picture_free(&p);
        close_other(&small);
    }
    printf("# %u slices at most\n", most);
    assert_true(most > 3);
    picture_free(&whole);
    rings_free(&r);
}

static void test_cut_pictures(void **state) {
    cut_pictures(*state, draw_black);
    cut_pictures(*state, draw_veiled);
}

/* ---- Many fills ---- */

enum { FILLS = 1200 };

/* Squares whose sides lie between pixels, of `count` fills: no two that follow each other have the same. */
static rings made_squares(size_t count, int largest, uint32_t fill_count) {
    rings r = rings_begin(4 * count);
    uint64_t seed = 77;
    for (size_t i = 0; i < count; i++) {
        const int side = 1 + (int)(largest * pow(next_number(&seed), 3.0));
        const int x = (int)(1.2 * SIDE_PX * next_number(&seed)) - 50,
                  y = (int)(1.2 * SIDE_PX * next_number(&seed)) - 50;
        for (int corner = 0; corner < 4; corner++)
            add_point(&r, x + side * (corner == 1 || corner == 2), y + side * (corner >= 2));
        end_ring(&r, (uint32_t)(7 * i % fill_count));
    }
    return r;
}

/* A mesh with a row for each fill. offset: of one more row, which no ring has; the rings then come from source lines.
 */
static camber_mesh *many_rows(const fixture *f, camber_renderer *renderer, const rings *r, camber_method method,
                              float offset) {
    camber_stroke strokes[FILLS + 1] = {{0}};
    strokes[FILLS].width_px = 2;
    strokes[FILLS].offset_px = offset;
    const camber_tessellation_desc how = {strokes, FILLS + 1, method, 0, false};
    return stroked_mesh_of(f, renderer, r, &how);
}

/* The fills, and paints of them. Every third is translucent. */
static void make_paints(camber_fill *fills, camber_paint *paints) {
    uint64_t seed = 5;
    for (int i = 0; i < FILLS; i++) {
        const float r = (float)next_number(&seed), g = (float)next_number(&seed), b = (float)next_number(&seed);
        fills[i] = (camber_fill){.color = {r, g, b, i % 3 ? 1.0f : 0.4f}};
        paints[i] = (camber_paint){.fill = fills + i};
    }
}

/* Draws the mesh by passes of so many polylines. 0: all in one. */
static picture draw_passes(camber_renderer *renderer, camber_mesh *mesh, const camber_paint *paints, size_t at_once,
                           uint32_t side) {
    const size_t count = at_once ? (mesh->polyline_count + at_once - 1) / at_once : 1;
    camber_pass *passes = calloc(count, sizeof *passes);
    assert_non_null(passes);
    for (size_t i = 0; i < count; i++)
        passes[i] = (camber_pass){.mesh = mesh,
                                  .paints = paints,
                                  .paint_count = mesh->row_count,
                                  .first_polyline = i * at_once,
                                  .polyline_count = at_once};
    const camber_frame frame = {.width = SIDE_PX,
                                .height = SIDE_PX,
                                .background = {1, 1, 1, 1},
                                .passes = passes,
                                .pass_count = count,
                                .largest_area_px = side};
    picture p = picture_draw(renderer, &frame);
    free(passes);
    return p;
}

/* Paints squares one after the other. */
static void assert_painted(const picture *p, const rings *r, const camber_fill *fills) {
    double *truth = malloc(SIDE_PX * SIDE_PX * 3 * sizeof *truth);
    assert_non_null(truth);
    for (size_t i = 0; i < SIDE_PX * SIDE_PX * 3; i++)
        truth[i] = 1;
    for (size_t k = 0; k < r->ring_count; k++) {
        const float *corner = r->points + 8 * k;
        const camber_color c = fills[r->rows[k]].color;
        const double color[3] = {(double)c.r, (double)c.g, (double)c.b}, alpha = (double)c.a;
        for (int y = (int)fmaxf(corner[1], 0); y < SIDE_PX && y < (int)corner[5]; y++)
            for (int x = (int)fmaxf(corner[0], 0); x < SIDE_PX && x < (int)corner[4]; x++)
                for (int i = 0; i < 3; i++) {
                    double *at = truth + 3 * (SIDE_PX * y + x) + i;
                    *at += alpha * (color[i] - *at);
                }
    }
    for (uint32_t y = 0; y < SIDE_PX; y++)
        for (uint32_t x = 0; x < SIDE_PX; x++)
            for (int i = 0; i < 3; i++)
                assert_true(fabs(255 * (picture_value(p, x, y, i) - truth[3 * (SIDE_PX * y + x) + (uint32_t)i])) < 1.1);
    free(truth);
}

/* Whatever changes its fill with each area is drawn in order: beside a painter's work, and beside passes that have few
 * fills each, to the byte, by every method, of offset lines, in areas and in slices. */
static void test_order(void **state) {
    const fixture *f = *state;
    static const camber_method methods[] = {CAMBER_METHOD_STRIP, CAMBER_METHOD_KITE, CAMBER_METHOD_FAN};
    camber_fill fills[FILLS];
    camber_paint paints[FILLS];
    rings r = made_squares(5000, 150, FILLS);
    make_paints(fills, paints);
    camber_mesh *mesh = many_rows(f, drawer(f), &r, CAMBER_METHOD_STRIP, 0);
    picture all = draw_passes(drawer(f), mesh, paints, 0, 0), few = draw_passes(drawer(f), mesh, paints, 40, 0);
    picture areas = draw_passes(drawer(f), mesh, paints, 0, 97);
    assert_painted(&all, &r, fills);
    picture_assert_same(&few, &all);
    picture_assert_same(&areas, &all);
    picture_free(&few);
    picture_free(&areas);
    camber_mesh_destroy(mesh);
    for (int i = 0; i < 6; i++) {
        mesh = many_rows(f, drawer(f), &r, methods[i % 3], i < 3 ? 0.0f : 3.0f);
        picture p = draw_passes(drawer(f), mesh, paints, 0, 0);
        picture_assert_same(&all, &p);
        picture_free(&p);
        camber_mesh_destroy(mesh);
    }
    const camber_device_desc desc = {.largest_buffer_bytes = 300 * 1024, .memory_bytes = 8 << 20};
    fixture small = open_other(f, &desc);
    mesh = many_rows(&small, drawer(&small), &r, CAMBER_METHOD_STRIP, 0);
    picture p = draw_passes(drawer(&small), mesh, paints, 0, 0);
    assert_true(mesh->part_count > 1 && camber_raster_slice_count(drawer(&small)->raster) > 1);
    picture_assert_same(&all, &p);
    picture_free(&p);
    camber_mesh_destroy(mesh);
    close_other(&small);
    picture_free(&all);
    rings_free(&r);
}

/* Fills that are alike are one, whatever their rows: a translucent one covers each pixel once. */
static void test_like_fills(void **state) {
    const fixture *f = *state;
    const camber_fill fill = {.color = {0.1f, 0.2f, 0.3f, 0.5f}}, same = fill;
    const camber_paint paints[2][4] = {{{.fill = &fill}, {.fill = &fill}}, {{.fill = &fill}, {.fill = &same}}};
    rings r = made_rings(11, 300, 200, 2);
    camber_mesh *mesh = mesh_of(f, drawer(f), &r, 2);
    picture p[2];
    for (int i = 0; i < 2; i++)
        p[i] = draw_passes(drawer(f), mesh, paints[i], 0, 0);
    picture_assert_same(p, p + 1);
    picture_free(p);
    picture_free(p + 1);
    camber_mesh_destroy(mesh);
    rings_free(&r);
}

/* Where areas and lines alternate too often, areas come first. */
static void test_lines_between(void **state) {
    const fixture *f = *state;
    const camber_fill fill = {.color = {0.1f, 0.2f, 0.9f, 0.5f}};
    const camber_paint line = {.width_px = 3, .color = {1, 0, 0, 1}}, none = {.width_px = 0}, area = {.fill = &fill};
    const camber_paint both[2] = {area, line}, areas[2] = {area, none}, lines[2] = {none, line};
    for (int i = 0; i < 2; i++) {
        rings r = made_rings(51, i ? 200 : 80, 200, 2);
        camber_mesh *mesh = mesh_of(f, drawer(f), &r, 2);
        const camber_pass apart[2] = {{.mesh = mesh, .paints = areas, .paint_count = 2},
                                      {.mesh = mesh, .paints = lines, .paint_count = 2}};
        const camber_frame frame = {
            .width = SIDE_PX, .height = SIDE_PX, .background = {1, 1, 1, 1}, .passes = apart, .pass_count = 2};
        picture together = draw_passes(drawer(f), mesh, both, 0, 0), p = picture_draw(drawer(f), &frame),
                few = draw_passes(drawer(f), mesh, both, 10, 0);
        picture_assert_same(i ? &p : &few, &together);
        assert_true(picture_compare(i ? &few : &p, &together).most > 100);
        picture_free(&together);
        picture_free(&p);
        picture_free(&few);
        camber_mesh_destroy(mesh);
        rings_free(&r);
    }
}

/* The twin takes the same brushes, also where lines of the same rows lie above. */
static void test_changes(void **state) {
    const fixture *f = *state;
    static const camber_method methods[] = {CAMBER_METHOD_STRIP, CAMBER_METHOD_KITE};
    for (int i = 0; i < 2; i++) {
        enum { COUNT = 900 };
        rings r = made_rings(31, COUNT, 300, 2);
        const camber_stroke strokes[2] = {{.width_px = 0}, {.width_px = 3}};
        const camber_tessellation_desc how = {strokes, 2, methods[i], 0, false};
        camber_mesh *mesh = stroked_mesh_of(f, drawer(f), &r, &how);
        float rows[4][CAMBER_RASTER_ROW_WORDS] = {{0, 1, 2, 0}, {0, 3, 4, 0}, {1, 5, 6, 0}, {-1, 0, 0, 0}};
        const uint32_t of_rows[4] = {1, 2, COUNT + 5, 0};
        camber_brush brushes[COUNT + 6] = {{0}};
        size_t changes[COUNT];
        for (int k = 0; k < 4; k++)
            memcpy(rows[k] + 3, of_rows + k, sizeof *of_rows);
        for (int k = 1; k < COUNT + 6; k++)
            brushes[k] = (camber_brush){.r = (float)(k % 7) / 7,
                                        .g = (float)(k % 11) / 11,
                                        .b = (float)(k % 13) / 13,
                                        .a = k % 2 ? 1.0f : 0.6f,
                                        .mode = k == COUNT + 5 ? CAMBER_BRUSH_OVER
                                                : k % 5        ? CAMBER_BRUSH_AREA
                                                               : CAMBER_BRUSH_AREA_EVENODD};
        for (size_t k = 0; k + 20 < COUNT; k++)
            changes[k] = 10 + k + (k > 400);
        const camber_raster_input inputs[] = {
            {.mesh = mesh, .first = 5, .end = COUNT, .is_area = true, .change_count = COUNT - 20},
            {.mesh = mesh, .end = COUNT, .first_row = 2}};
        const camber_raster_scene drawn = {.rows = rows[0],
                                           .row_count = 4,
                                           .brushes = brushes,
                                           .brush_count = COUNT + 6,
                                           .inputs = inputs,
                                           .input_count = 2,
                                           .changes = changes};
        camber_free(f->context, raster_draw_twice(f, &drawn, (camber_raster_area){32, 64, 300, 333}));
        camber_mesh_destroy(mesh);
        rings_free(&r);
    }
}

static size_t launches; /* of kernels */

/* Each launch on its way to the back end. */
camber_status __real_camber_launch_kernel(const camber_device *device, const camber_launch *launch,
                                          camber_event **event);
camber_status __wrap_camber_launch_kernel(const camber_device *device, const camber_launch *launch,
                                          camber_event **event);
camber_status __wrap_camber_launch_kernel(const camber_device *device, const camber_launch *launch,
                                          camber_event **event) {
    launches++;
    return __real_camber_launch_kernel(device, launch, event);
}

/* A hundred thousand squares of a thousand colours, or of two in turn, are drawn by as many kernels as those of one.
 * By fill, each colour would take as many as one alone. */
static void test_many_fills(void **state) {
    const fixture *f = *state;
    enum { SQUARES = 100000 };
    static const uint32_t counts[] = {1, 2, 1000, FILLS};
    camber_fill fills[FILLS];
    camber_paint paints[FILLS];
    size_t of_one = 0;
    make_paints(fills, paints);
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        rings r = made_squares(SQUARES, 20, counts[i]);
        camber_mesh *mesh = many_rows(f, drawer(f), &r, CAMBER_METHOD_STRIP, 0);
        launches = 0;
        picture p = draw_passes(drawer(f), mesh, paints, 0, 0);
        printf("# %d squares of %u fills: %zu kernels\n", SQUARES, counts[i], launches);
        assert_true(launches > 0);
        of_one = i == 0 ? launches : of_one;
        assert_int_equal(launches, of_one);
        if (counts[i] > 1)
            assert_painted(&p, &r, fills);
        picture_free(&p);
        camber_mesh_destroy(mesh);
        rings_free(&r);
    }
}

/* ---- GL ---- */

/* Kernels fill areas there, too: what differs is the rounding of their layer, and of a group. */
static void test_gl(void **state) {
    const fixture *f = *state;
    static const uint8_t texels[16] = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 100, 100, 0, 128};
    const camber_image image = {texels, 2, 2, 0};
    const camber_fill fills[] = {{.color = {0.1f, 0.6f, 0.4f, 0.5f}}, {.color = {0, 0, 0, 1}, .image = &image}};
    if (!fixture_gl(f))
        skip();
    for (int i = 0; i < 4; i++) {
        rings r = made_rings(40 + (uint64_t)i, 100, 200, 1);
        picture p[2];
        for (int gl = 0; gl < 2; gl++) {
            camber_renderer *renderer = gl ? fixture_gl(f) : drawer(f);
            camber_mesh *mesh = mesh_of(f, renderer, &r, 1);
            const camber_paint paint = {.fill = fills + i % 2};
            const camber_pass passes[] = {
                {.mesh = mesh, .paints = &paint, .paint_count = 1, .opacity = i < 2 ? 0.0f : 0.6f},
                {.mesh = mesh, .paints = &paint, .paint_count = 1, .first_polyline = 50}};
            const camber_frame frame = {.width = SIDE_PX,
                                        .height = SIDE_PX,
                                        .background = {1, 1, 1, 1},
                                        .passes = passes,
                                        .pass_count = 2,
                                        .largest_area_px = i == 3 ? 211 : 0};
            p[gl] = picture_draw(renderer, &frame);
            camber_mesh_destroy(mesh);
        }
        const difference apart = picture_compare(p, p + 1);
        printf("# GL: %.4f of 255 on average, %d at most\n", apart.mean, apart.most);
        assert_true(apart.drawn > 1000 && apart.most <= 2);
        picture_free(p);
        picture_free(p + 1);
        rings_free(&r);
    }
}

/* Many fills are one layer there. */
static void test_gl_fills(void **state) {
    const fixture *f = *state;
    camber_fill fills[FILLS];
    camber_paint paints[FILLS];
    if (!fixture_gl(f))
        skip();
    make_paints(fills, paints);
    for (uint32_t i = 0; i < 2; i++) {
        rings r = made_squares(5000, 150, FILLS);
        picture p[2];
        for (int gl = 0; gl < 2; gl++) {
            camber_renderer *renderer = gl ? fixture_gl(f) : drawer(f);
            camber_mesh *mesh = many_rows(f, renderer, &r, CAMBER_METHOD_STRIP, 0);
            p[gl] = draw_passes(renderer, mesh, paints, 0, 211 * i);
            camber_mesh_destroy(mesh);
        }
        assert_painted(p + 1, &r, fills);
        const difference apart = picture_compare(p, p + 1);
        assert_true(apart.drawn > 1000 && apart.most <= 2);
        picture_free(p);
        picture_free(p + 1);
        rings_free(&r);
    }
}

/* ---- Cameras ---- */

/* A mesh of a network of the rings, seen from where a px is a unit and the picture's corner lies at 0, 0. */
static camber_mesh *network_mesh(const fixture *f, const rings *r, double pitch_deg, uint32_t row_count) {
    double *points = malloc(2 * (r->point_count + r->ring_count) * sizeof *points);
    size_t *offsets = malloc((r->ring_count + 1) * sizeof *offsets), count = 0;
    camber_network_entry *entries = calloc(r->ring_count, sizeof *entries);
    assert_true(points && offsets && entries);
    for (size_t k = 0; k < r->ring_count; k++) {
        double area = 0;
        const size_t first = r->offsets[k], size = r->offsets[k + 1] - first;
        for (size_t i = 0; i < size; i++) {
            const float *a = r->points + 2 * (first + i), *b = r->points + 2 * (first + (i + 1) % size);
            area += (double)a[0] * (double)b[1] - (double)b[0] * (double)a[1];
        }
        offsets[k] = count;
        entries[k] = (camber_network_entry){.polyline = (uint32_t)k, .row = r->rows[k], .is_area = true};
        for (size_t i = 0; i <= size; i++) {
            const float *p = r->points + 2 * (first + (area < 0 ? size - i : i) % size);
            points[2 * count] = (double)p[0];
            points[2 * count++ + 1] = (double)p[1];
        }
    }
    offsets[r->ring_count] = count;
    const camber_network_desc desc = {.points = points,
                                      .offsets = offsets,
                                      .polyline_count = r->ring_count,
                                      .entries = entries,
                                      .entry_count = r->ring_count};
    const camber_camera camera = {.x = 0.5 * SIDE_PX,
                                  .y = 0.5 * SIDE_PX,
                                  .scale_px = 1,
                                  .width = SIDE_PX,
                                  .height = SIDE_PX,
                                  .pitch_deg = pitch_deg};
    const camber_stroke strokes[FILLS] = {{.width_px = 0}};
    const camber_tessellation_desc how = {strokes, row_count, CAMBER_METHOD_STRIP, 0, false};
    camber_network *network = NULL;
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_network_create(f->context, &desc, &network), CAMBER_OK);
    assert_int_equal(camber_mesh_create(f->on.device, drawer(f), &mesh), CAMBER_OK);
    assert_int_equal(camber_mesh_tessellate_network(mesh, network, &camera, &how), CAMBER_OK);
    camber_network_destroy(network);
    free(entries);
    free(offsets);
    free(points);
    return mesh;
}

static picture draw_network(const fixture *f, const rings *r, double pitch_deg) {
    camber_mesh *mesh = network_mesh(f, r, pitch_deg, 1);
    picture p = draw_mesh(drawer(f), mesh, &BLACK, 0);
    camber_mesh_destroy(mesh);
    return p;
}

/* A network's areas keep their fills, whatever the camera cuts off between them. */
static void test_network_fills(void **state) {
    const fixture *f = *state;
    camber_fill fills[FILLS];
    camber_paint paints[FILLS];
    rings r = made_rings(61, 3000, 200, FILLS);
    make_paints(fills, paints);
    for (int i = 0; i < 2; i++) {
        camber_mesh *mesh = network_mesh(f, &r, 40.0 * i, FILLS);
        picture all = draw_passes(drawer(f), mesh, paints, 0, 0), few = draw_passes(drawer(f), mesh, paints, 40, 0);
        picture_assert_same(&few, &all);
        picture_free(&all);
        picture_free(&few);
        camber_mesh_destroy(mesh);
    }
    rings_free(&r);
}

/* The camera cuts off what must not show: the picture is that of the whole rings, to what rounding to steps does. */
static void test_cameras(void **state) {
    const fixture *f = *state;
    for (uint64_t seed = 20; seed < 26; seed++) {
        rings r = made_rings(seed, seed % 2 ? 4 : 40, seed % 2 ? 3000 : 200, 1);
        picture cut = draw_network(f, &r, 0), whole = draw_rings(f, &r, &BLACK, 0);
        const difference apart = picture_compare(&cut, &whole);
        printf("# cut by a camera: %.4f of 255 on average, %d at most\n", apart.mean, apart.most);
        assert_true(apart.mean < 0.02 && apart.most <= 2);
        picture_free(&cut);
        picture_free(&whole);
        rings_free(&r);
    }
}

/* With a pitch, far and near: a field that is larger than all that is seen has one colour up to the far plane. */
static void test_pitched_field(void **state) {
    const fixture *f = *state;
    for (int i = 0; i < 4; i++) {
        rings r = rings_begin(100);
        add_star(&r, 250, 250, 400000, 40, 1, 0.1 * i, 0);
        picture p = draw_network(f, &r, 20.0 * (i + 1));
        const uint8_t black[4] = {0, 0, 0, 255};
        for (uint32_t y = SIDE_PX / 2; y < SIDE_PX; y++)
            for (uint32_t x = 0; x < SIDE_PX; x++)
                assert_memory_equal(picture_at(&p, x, y), black, 4);
        picture_free(&p);
        rings_free(&r);
    }
}

/* ---- Input ---- */

static void test_input(void **state) {
    const fixture *f = *state;
    const float points[] = {10, 10, 90, 10, 90, 90, 10, 90, NAN, 3, 30, 30, 60, 30, 60, 60, 30, 60, 30, 30};
    const uint32_t offsets[] = {0, 5, 10}, rings_of[] = {0, 2}, wrong[] = {0, 3}, back[] = {0, 5, 4};
    camber_areas_desc desc = {
        .points = points, .point_count = 10, .offsets = offsets, .ring_count = 2, .rings = rings_of, .area_count = 1};
    camber_polylines *areas = NULL;
    assert_int_equal(camber_areas_create(f->context, &desc, &areas), CAMBER_OK);
    const camber_polylines_stats stats = camber_polylines_get_stats(areas);
    assert_int_equal(stats.rings, 2);
    camber_polylines_destroy(areas);
    areas = NULL;
    desc.rings = wrong;
    assert_int_equal(camber_areas_create(f->context, &desc, &areas), CAMBER_ERROR_INPUT);
    desc.rings = rings_of;
    desc.offsets = back;
    assert_int_equal(camber_areas_create(f->context, &desc, &areas), CAMBER_ERROR_INPUT);
    assert_null(areas);
    assert_int_equal(camber_areas_create(f->context, &(camber_areas_desc){0}, &areas), CAMBER_OK);
    camber_polylines_destroy(areas);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_twin),          cmocka_unit_test(test_cells),         cmocka_unit_test(test_truth),
        cmocka_unit_test(test_seams),         cmocka_unit_test(test_cut_pictures),  cmocka_unit_test(test_cameras),
        cmocka_unit_test(test_pitched_field), cmocka_unit_test(test_input),         cmocka_unit_test(test_gl),
        cmocka_unit_test(test_order),         cmocka_unit_test(test_like_fills),    cmocka_unit_test(test_changes),
        cmocka_unit_test(test_many_fills),    cmocka_unit_test(test_lines_between), cmocka_unit_test(test_gl_fills),
        cmocka_unit_test(test_network_fills),
    };
    return FIXTURE_CL_RUN(tests);
}
