/* Lines and fills of images: against the image sampled where each pixel lies along and across its line. */
#include "pictures.h"

#include "base/perspective.h"
#include "draw/renderer.h"

#include <stdio.h>

enum { SIDE = 96, IMAGE_MAX = 64 };

static const float slanted[] = {10.3f, 15.6f, 84.1f, 70.2f};
static const float level[] = {8, 48, 88, 48};
static const float back[] = {88, 48, 8, 48};
static const float bent[] = {10.3f, 80.6f, 52.1f, 20.2f, 88.8f, 78.4f};

/* An image of the test's own, and the same as a renderer takes it. */
typedef struct sheet {
    uint8_t rgba[4 * IMAGE_MAX * IMAGE_MAX];
    camber_image image;
} sheet;

typedef enum sheet_kind {
    SMOOTH, /* opaque colours that differ from px to px */
    CLEAR,  /* of any alpha */
    CHECKED,
    HALVES, /* red above, green below */
} sheet_kind;

static void make_sheet(sheet *s, uint32_t width, uint32_t height, sheet_kind kind) {
    uint64_t seed = 7 + width * 1000 + height;
    for (uint32_t i = 0; i < width * height; i++) {
        const uint32_t x = i % width, y = i / width;
        uint8_t *px = s->rgba + 4 * (size_t)i;
        const uint8_t alpha = kind == CLEAR ? (uint8_t)camber_random_below(&seed, 256) : 255;
        px[3] = alpha;
        for (int c = 0; c < 3; c++)
            px[c] = (uint8_t)camber_random_below(&seed, (size_t)alpha + 1);
        if (kind == CHECKED)
            px[0] = px[1] = px[2] = (x + y) % 2 ? 255 : 0;
        if (kind == HALVES) {
            px[0] = y < height / 2 ? 255 : 0;
            px[1] = y < height / 2 ? 0 : 255;
            px[2] = 0;
        }
    }
    s->image = (camber_image){s->rgba, width, height, 0};
}

/* The image at a share of its width, which repeats itself, and of its height, bilinear. */
static void sample(const camber_image *image, double u, double v, bool tiled, double out[4]) {
    const double x = u * image->width - 0.5, y = v * image->height - 0.5;
    const int w = (int)image->width, h = (int)image->height, x0 = (int)floor(x), y0 = (int)floor(y);
    for (int c = 0; c < 4; c++)
        out[c] = 0;
    for (int k = 0; k < 4; k++) {
        const int xi = ((x0 + k % 2) % w + w) % w;
        int yi = y0 + k / 2;
        yi = tiled ? (yi % h + h) % h : yi < 0 ? 0 : yi >= h ? h - 1 : yi;
        const double share = (k % 2 ? x - x0 : 1 - x + x0) * (k / 2 ? y - y0 : 1 - y + y0);
        for (int c = 0; c < 4; c++)
            out[c] += share * image->rgba[4 * (yi * w + xi) + c];
    }
}

typedef struct drawing {
    const float *points;
    size_t count;
    camber_stroke stroke;
    camber_method method;
    camber_paint paint;
    uint32_t largest_area_px;
} drawing;

static camber_mesh *make_mesh(fixture *s, const drawing *d, bool has_arc_length) {
    const camber_tessellation_desc tessellation = {
        .strokes = &d->stroke, .stroke_count = 1, .method = d->method, .has_arc_length = has_arc_length};
    return fixture_line(s, d->points, d->count, &tessellation);
}

static picture draw(fixture *s, const drawing *d) {
    camber_mesh *mesh = make_mesh(s, d, true);
    const camber_pass pass = {.mesh = mesh, .paints = &d->paint, .paint_count = 1};
    picture p = picture_draw(
        fixture_any(s),
        &(camber_frame){
            .width = SIDE, .height = SIDE, .passes = &pass, .pass_count = 1, .largest_area_px = d->largest_area_px});
    camber_mesh_destroy(mesh);
    return p;
}

/* Where a pixel lies along the line and across the segment it is nearest to, how far that segment's joints are, and
 * what is left of the line. */
typedef struct spot {
    double along, across, room, left;
} spot;

static spot find_spot(const drawing *d, double x, double y) {
    spot found = {0};
    double nearest = 1e9, before = 0;
    for (size_t i = 0; i + 1 < d->count; i++) {
        const float *a = d->points + 2 * i, *b = a + 2;
        const double dx = (double)b[0] - a[0], dy = (double)b[1] - a[1], length = hypot(dx, dy);
        const double px = x - (double)a[0], py = y - (double)a[1];
        const double t = (px * dx + py * dy) / length, side = (py * dx - px * dy) / length;
        const double past = t < 0 ? -t : t > length ? t - length : 0, distance = hypot(past, side);
        if (distance < nearest) {
            nearest = distance;
            const double first = i == 0 ? 1e9 : t, last = i + 2 == d->count ? 1e9 : length - t;
            found = (spot){before + t, side, fmin(first, last), i + 2 == d->count ? length - t : 1e9};
        }
        before += length;
    }
    return found;
}

/* Compares the pixels that lie in the line, two widths from its joints. */
static void check(fixture *s, const drawing *d, double mean_bound, double most_bound) {
    picture p = draw(s, d);
    const camber_image *image = d->paint.image;
    const double whole = 2.0 * (double)camber_paint_half_width(&d->paint);
    const double one = d->paint.image_px > 0 ? (double)d->paint.image_px : whole * image->width / image->height;
    double sum = 0, most = 0;
    size_t count = 0;
    for (uint32_t k = 0; k < SIDE * SIDE; k++) {
        const spot at = find_spot(d, k % SIDE + 0.5, k / SIDE + 0.5);
        if (fabs(at.across) > 0.5 * whole - 1 || at.room < 2 * whole || at.along < 1 || at.left < 1 ||
            picture_at(&p, k % SIDE, k / SIDE)[3] == 0)
            continue;
        double wanted[4];
        sample(image, at.along / one, 0.5 - at.across / whole, false, wanted);
        for (int c = 0; c < 4; c++) {
            const double error =
                fabs(255 * picture_value(&p, k % SIDE, k / SIDE, c) - wanted[c] * (double)d->paint.color.a);
            sum += error;
            most = fmax(most, error);
            count++;
        }
    }
    assert_true(count > 4 * 200);
    if (sum / (double)count > mean_bound || most > most_bound)
        fail_msg("width %g, image %u x %u, %g px, method %d: %.2f of 255 on average, %.0f at most",
                 (double)d->paint.width_px, image->width, image->height, one, (int)d->method, sum / (double)count,
                 most);
    picture_free(&p);
}

static drawing drawing_of(const float *points, size_t count, float width_px, const sheet *s) {
    return (drawing){.points = points,
                     .count = count,
                     .stroke = {width_px, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0},
                     .paint = {.width_px = width_px, .color = {1, 1, 1, 1}, .image = &s->image}};
}

static void test_straight(void **state) {
    static const uint32_t sizes[][2] = {{8, 8}, {5, 3}, {1, 4}, {4, 1}, {1, 1}};
    sheet s;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int method = 0; method < 3; method++)
            for (int kind = 0; kind < 2; kind++) {
                make_sheet(&s, sizes[i][0], sizes[i][1], kind ? CLEAR : SMOOTH);
                drawing d = drawing_of(kind ? slanted : level, 2, 20, &s);
                d.method = (camber_method)method;
                check(*state, &d, 1, 6);
                d.paint.image_px = 33.3f;
                check(*state, &d, 1, 6);
            }
}

/* The phase goes on behind a corner. */
static void test_bent(void **state) {
    sheet s;
    make_sheet(&s, 8, 4, SMOOTH);
    for (int method = 0; method < 3; method++)
        for (int join = 0; join < 3; join++) {
            drawing d = drawing_of(bent, 3, 10, &s);
            d.method = (camber_method)method;
            d.stroke.join = (camber_join)join;
            check(*state, &d, 1, 8);
        }
}

/* Around a corner nothing jumps by more than the image does in the distance, but on the inside. */
static void test_corner(void **state) {
    sheet s;
    make_sheet(&s, 2, 1, SMOOTH);
    memcpy(s.rgba, "\x00\x00\x00\xff\xff\xff\xff\xff", 8);
    for (int join = 0; join < 3; join++) {
        drawing d = drawing_of(bent, 3, 24, &s);
        d.stroke.join = (camber_join)join;
        d.paint.image_px = 150;
        picture p = draw(*state, &d);
        for (uint32_t y = 1; y < SIDE; y++)
            for (uint32_t x = 1; x < SIDE; x++) {
                const uint8_t *here = picture_at(&p, x, y), *left = picture_at(&p, x - 1, y),
                              *up = picture_at(&p, x, y - 1);
                if (here[3] == 255 && left[3] == 255)
                    assert_in_range(abs(here[0] - left[0]), 0, 24);
                if (here[3] == 255 && up[3] == 255)
                    assert_in_range(abs(here[0] - up[0]), 0, 24);
            }
        picture_free(&p);
    }
}

/* The top is on the right of the direction. */
static void test_sides(void **state) {
    sheet s;
    make_sheet(&s, 4, 4, HALVES);
    drawing there = drawing_of(level, 2, 16, &s), and_back = drawing_of(back, 2, 16, &s);
    picture p = draw(*state, &there), q = draw(*state, &and_back);
    assert_int_equal(picture_at(&p, 48, 53)[0], 255); /* y goes down: the right of what goes right */
    assert_int_equal(picture_at(&p, 48, 42)[1], 255);
    assert_int_equal(picture_at(&q, 48, 53)[1], 255);
    assert_int_equal(picture_at(&q, 48, 42)[0], 255);
    picture_free(&q);
    picture_free(&p);
}

/* A pattern that is much finer than pixels is its average, wherever it is. */
static void test_fine(void **state) {
    sheet s;
    make_sheet(&s, 64, 64, CHECKED);
    for (int width = 3; width < 24; width += 4) {
        drawing d = drawing_of(slanted, 2, (float)width, &s);
        picture p = draw(*state, &d);
        for (uint32_t k = 0; k < SIDE * SIDE; k++) {
            const uint8_t *px = p.rgba + 4 * (size_t)k;
            if (px[3] == 255)
                assert_in_range(px[0], 110, 145);
        }
        picture_free(&p);
    }
}

/* Images beside each other in the texture leave nothing in each other's lines. */
static void test_neighbours(void **state) {
    static sheet sheets[9];
    camber_image images[9];
    for (uint32_t i = 0; i < 9; i++) {
        make_sheet(sheets + i, 3 + i, 7 - i % 3, SMOOTH);
        for (size_t k = 0; k < sheets[i].image.width * sheets[i].image.height; k++)
            memcpy(sheets[i].rgba + 4 * k, i == 4 ? "\xff\x00\x00\xff" : "\x00\xff\x00\xff", 4);
        images[i] = sheets[i].image;
    }
    for (uint32_t i = 0; i < 9; i++) { /* all of them come into the texture */
        drawing d = drawing_of(slanted, 2, 9 + (float)(i % 2) * 14, sheets);
        d.paint.image = images + i;
        picture p = draw(*state, &d);
        for (size_t k = 0; k < SIDE * SIDE; k++) {
            assert_int_equal(p.rgba[4 * k + (i == 4 ? 0 : 1)], p.rgba[4 * k + 3]);
            assert_int_equal(p.rgba[4 * k + (i == 4 ? 1 : 0)], 0);
        }
        picture_free(&p);
    }
}

/* A translucent pass is the opaque one at its alpha, pieces are the whole, and bands are what a gap leaves of it. */
static void test_composed(void **state) {
    sheet s;
    make_sheet(&s, 8, 4, SMOOTH);
    drawing whole = drawing_of(bent, 3, 18, &s), part = whole;
    picture p = draw(*state, &whole);
    part.largest_area_px = 37;
    picture q = draw(*state, &part);
    const difference pieces = picture_compare(&p, &q);
    assert_in_range(pieces.most, 0, 2);
    picture_free(&q);
    part = whole;
    part.paint.color.a = 0.5f;
    q = draw(*state, &part);
    for (size_t k = 0; k < 4 * SIDE * SIDE; k++)
        assert_in_range(abs(p.rgba[k] - 2 * q.rgba[k]), 0, 3);
    picture_free(&q);
    part = whole;
    part.paint.gap_px = 6;
    part.paint.width_px = 6;
    q = draw(*state, &part);
    size_t same = 0, gone = 0;
    for (size_t k = 0; k < SIDE * SIDE; k++) {
        same += q.rgba[4 * k + 3] == 255 && memcmp(p.rgba + 4 * k, q.rgba + 4 * k, 4) == 0;
        gone += p.rgba[4 * k + 3] == 255 && q.rgba[4 * k + 3] == 0;
    }
    assert_true(same > 500 && gone > 300);
    picture_free(&q);
    picture_free(&p);
}

/* More than the texture holds at once is drawn all the same, unless one pass wants it all. */
static void test_many(void **state) {
    enum { COUNT = 120, PX = 300, BYTES = 4 * PX * PX };
    static uint8_t rgba[BYTES + 4 * COUNT];
    static camber_paint paints[COUNT][COUNT], all[COUNT];
    camber_image images[COUNT];
    camber_stroke strokes[COUNT];
    camber_pass passes[COUNT];
    fixture *s = *state;
    uint64_t seed = 3;
    for (size_t i = 0; i < sizeof rgba; i++)
        rgba[i] = i % 4 == 3 ? 255 : (uint8_t)camber_random_below(&seed, 256);
    camber_made_scene lines = {0};
    for (size_t i = 0; i < COUNT; i++) {
        images[i] = (camber_image){rgba + 4 * i, PX, PX, 0};
        strokes[i] = (camber_stroke){600, CAMBER_JOIN_ROUND, CAMBER_CAP_BUTT, 0};
        all[i] = (camber_paint){.width_px = 600, .color = {1, 1, 1, 1}, .image = images + i};
        paints[i][i] = all[i];
        camber_made_scene_point(&lines, 0, 48);
        camber_made_scene_point(&lines, SIDE, 48);
        camber_made_scene_end(&lines, i);
    }
    camber_mesh *mesh =
        fixture_mesh(s, fixture_any(s), &lines, &(camber_tessellation_desc){strokes, COUNT, 0, 0, true});
    for (size_t i = 0; i < COUNT; i++)
        passes[i] = (camber_pass){
            .mesh = mesh, .first_polyline = i, .polyline_count = 1, .paints = paints[i], .paint_count = COUNT};
    camber_frame frame = {.width = SIDE, .height = SIDE, .passes = passes, .pass_count = COUNT};
    for (int round = 0; round < 2; round++) {
        picture p = picture_draw(fixture_any(s), &frame);
        frame.passes = passes + COUNT - 1;
        frame.pass_count = 1;
        picture q = picture_draw(fixture_any(s), &frame);
        picture_assert_same(&p, &q);
        frame.passes = passes;
        frame.pass_count = COUNT - 1;
        picture_free(&q);
        q = picture_draw(fixture_any(s), &frame);
        assert_true(picture_compare(&p, &q).mean > 20);
        picture_free(&q);
        picture_free(&p);
        frame.pass_count = COUNT;
    }
    passes[0].paints = all;
    if (draws_in_cl()) { /* which holds more, and all of a frame at once */
        assert_int_equal(camber_renderer_render(fixture_any(s), &frame, NULL, NULL, NULL), CAMBER_OK);
    } else {
        assert_int_equal(camber_renderer_render(fixture_any(s), &frame, NULL, NULL, NULL), CAMBER_ERROR_LIMIT);
        assert_story(&s->h, "fewer images");
    }
    camber_mesh_destroy(mesh);
    camber_made_scene_free(&lines);
}

/* ---- Fills ---- */

static picture fill(fixture *s, const camber_pass *passes, size_t count, uint32_t piece_px) {
    return picture_draw(fixture_any(s), &(camber_frame){.width = SIDE,
                                                        .height = SIDE,
                                                        .passes = passes,
                                                        .pass_count = count,
                                                        .background = {0, 0, 1, 1},
                                                        .largest_area_px = piece_px});
}

static void assert_color(const picture *p, uint32_t at, const char *wanted) {
    for (int c = 0; c < 3; c++)
        assert_in_range(abs(picture_at(p, at, at)[c] - (uint8_t)wanted[c]), 0, 1);
}

static void test_fill_color(void **state) {
    sheet s;
    make_sheet(&s, 2, 2, SMOOTH);
    drawing d = drawing_of(level, 2, 10, &s);
    d.paint.color = (camber_color){1, 0, 0, 1};
    d.paint.image = NULL;
    camber_mesh *mesh = make_mesh(*state, &d, true);
    const camber_pass line = {.mesh = mesh, .paints = &d.paint, .paint_count = 1};
    const camber_pass overlay = {.kind = CAMBER_PASS_FILL, .fill = {.color = {0, 1, 0, 0.5f}}},
                      nothing = {.kind = CAMBER_PASS_FILL};
    const camber_pass passes[] = {line, overlay, nothing};
    picture p = fill(*state, passes, 3, 0), q = fill(*state, (const camber_pass[]){overlay, line}, 2, 50);
    assert_color(&p, 1, "\x00\x80\x80");  /* over the background */
    assert_color(&p, 48, "\x80\x80\x00"); /* and over the line */
    assert_color(&q, 1, "\x00\x80\x80");
    assert_color(&q, 48, "\xff\x00\x00");
    picture_free(&q);
    picture_free(&p);
    camber_mesh_destroy(mesh);
}

static void check_fill(fixture *s, camber_fill fill_as, uint32_t piece_px) {
    const camber_image *image = fill_as.image;
    const camber_pass pass = {.kind = CAMBER_PASS_FILL, .fill = fill_as};
    picture p = fill(s, &pass, 1, piece_px);
    const double w = fill_as.width_px > 0 ? (double)fill_as.width_px : image->width;
    const double h = fill_as.height_px > 0 ? (double)fill_as.height_px : image->height;
    const double cosine = cos(fill_as.bearing_deg * 0.017453292519943295),
                 sine = sin(fill_as.bearing_deg * 0.017453292519943295);
    for (uint32_t k = 0; k < SIDE * SIDE; k++) {
        const double x = k % SIDE + 0.5 - (double)fill_as.x_px, y = k / SIDE + 0.5 - (double)fill_as.y_px;
        double wanted[4];
        sample(image, (x * cosine - y * sine) / w, (x * sine + y * cosine) / h, true, wanted);
        const double rest = 255 - wanted[3] * (double)fill_as.color.a;
        for (int c = 0; c < 4; c++) {
            const double below = c == 2 || c == 3 ? rest : 0;
            const double error =
                255 * picture_value(&p, k % SIDE, k / SIDE, c) - wanted[c] * (double)fill_as.color.a - below;
            if (fabs(error) > 6)
                fail_msg("image %u x %u as %g x %g, turned by %g: %.1f off at %u, %u", image->width, image->height, w,
                         h, fill_as.bearing_deg, error, k % SIDE, k / SIDE);
        }
    }
    picture_free(&p);
}

static void test_fill_images(void **state) {
    static const uint32_t sizes[][2] = {{8, 8}, {5, 3}, {1, 1}, {32, 7}};
    sheet s;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        make_sheet(&s, sizes[i][0], sizes[i][1], i % 2 ? CLEAR : SMOOTH);
        check_fill(*state, (camber_fill){.color = {0, 0, 0, 1}, .image = &s.image}, 0);
        check_fill(*state, (camber_fill){.color = {0, 0, 0, 0.4f}, .image = &s.image, .x_px = 3.3f, .y_px = -1.7f}, 41);
        check_fill(*state,
                   (camber_fill){.color = {0, 0, 0, 1},
                                 .image = &s.image,
                                 .width_px = 2.5f * (float)sizes[i][0],
                                 .height_px = 1.75f * (float)sizes[i][1],
                                 .x_px = 30,
                                 .y_px = 20,
                                 .bearing_deg = 33},
                   0);
    }
    make_sheet(&s, 64, 64, CHECKED);
    const camber_pass fine = {.kind = CAMBER_PASS_FILL,
                              .fill = {.color = {0, 0, 0, 1}, .image = &s.image, .width_px = 13, .height_px = 9}};
    picture p = fill(*state, &fine, 1, 0);
    for (size_t k = 0; k < SIDE * SIDE; k++)
        assert_in_range(p.rgba[4 * k], 110, 145);
    picture_free(&p);
}

/* ---- At an angle ---- */

/* The place of the plane that a pixel shows, and the depth there; false past the far plane. */
static bool ground_of(double pitch_deg, uint32_t k, double ground[2], double *depth) {
    const camber_perspective p = camber_perspective_of(pitch_deg, SIDE);
    const double x = k % SIDE + 0.5 - SIDE / 2, y = k / SIDE + 0.5 - SIDE / 2;
    *depth = camber_perspective_depth(&p, y);
    ground[0] = x * *depth + SIDE / 2;
    ground[1] = y * *depth / p.cosine + SIDE / 2;
    return y > p.far_y + 1;
}

static void test_pitched_line(void **state) {
    fixture *s = *state;
    sheet made;
    make_sheet(&made, 4, 4, SMOOTH);
    const drawing d = drawing_of(slanted, 2, 40, &made);
    camber_mesh *mesh = make_mesh(s, &d, true);
    const camber_pass pass = {.mesh = mesh, .paints = &d.paint, .paint_count = 1};
    picture p =
        picture_draw(fixture_any(s),
                     &(camber_frame){.width = SIDE, .height = SIDE, .passes = &pass, .pass_count = 1, .pitch_deg = 60});
    size_t count = 0;
    for (uint32_t k = 0; k < SIDE * SIDE; k++) {
        double ground[2], depth, wanted[4];
        if (!ground_of(60, k, ground, &depth) || p.rgba[4 * k + 3] < 255)
            continue;
        const spot at = find_spot(&d, ground[0], ground[1]);
        if (fabs(at.across) > 16 || at.along < 4 || at.left < 4 || depth > 1.3)
            continue;
        sample(&made.image, at.along / 40, 0.5 - at.across / 40, false, wanted);
        for (size_t c = 0; c < 3; c++)
            assert_in_range(fabs(p.rgba[4 * k + c] - wanted[c]), 0, 16);
        count++;
    }
    assert_true(count > 300);
    picture_free(&p);
    camber_mesh_destroy(mesh);
}

/* Near the middle the images are where they lie, and far away they are their average. */
static void test_pitched_fill(void **state) {
    fixture *s = *state;
    sheet made;
    for (int fine = 0; fine < 2; fine++) {
        const double pitch_deg = fine ? 75 : 60;
        make_sheet(&made, fine ? 64 : 4, fine ? 64 : 4, fine ? CHECKED : SMOOTH);
        const camber_pass pass = {
            .kind = CAMBER_PASS_FILL,
            .fill = {
                .color = {0, 0, 0, 1}, .image = &made.image, .width_px = 32, .height_px = 32, .x_px = 5, .y_px = 9}};
        picture p = picture_draw(fixture_any(s), &(camber_frame){.width = SIDE,
                                                                 .height = SIDE,
                                                                 .passes = &pass,
                                                                 .pass_count = 1,
                                                                 .pitch_deg = pitch_deg,
                                                                 .largest_area_px = 60});
        for (uint32_t k = 0; k < SIDE * SIDE; k++) {
            double ground[2], depth, wanted[4];
            if (!ground_of(pitch_deg, k, ground, &depth))
                continue;
            sample(&made.image, (ground[0] - 5) / 32, (ground[1] - 9) / 32, true, wanted);
            for (size_t c = 0; c < 3; c++)
                if (fine)
                    assert_in_range(p.rgba[4 * k + c], 90, 165);
                else if (depth < 1.2)
                    assert_in_range(fabs(p.rgba[4 * k + c] - wanted[c]), 0, 16);
            assert_int_equal(p.rgba[4 * k + 3], 255);
        }
        assert_int_equal(p.rgba[3], fine ? 0 : 255); /* past the far plane */
        picture_free(&p);
    }
}

/* ---- Refusals and limits ---- */

static void test_misuse(void **state) {
    fixture *s = *state;
    sheet made;
    make_sheet(&made, 4, 4, SMOOTH);
    drawing d = drawing_of(level, 2, 8, &made);
    const camber_image bad[] = {{made.rgba, 0, 4, 0}, {made.rgba, 4, 16385, 0}, {NULL, 4, 4, 0}, {made.rgba, 4, 4, 12}};
    camber_mesh *mesh = make_mesh(s, &d, true), *unmeasured = make_mesh(s, &d, false);
    camber_pass pass = {.mesh = unmeasured, .paints = &d.paint, .paint_count = 1};
    const camber_frame frame = {.width = SIDE, .height = SIDE, .passes = &pass, .pass_count = 1};
    assert_int_equal(camber_renderer_render(fixture_any(s), &frame, NULL, NULL, NULL), CAMBER_ERROR_ARGUMENT);
    assert_story(&s->h, "arc lengths");
    pass.mesh = mesh;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        d.paint.image = bad + i;
        assert_int_equal(camber_renderer_render(fixture_any(s), &frame, NULL, NULL, NULL), CAMBER_ERROR_ARGUMENT);
        assert_story(&s->h, "an image of");
    }
    camber_mesh_destroy(unmeasured);
    camber_mesh_destroy(mesh);
}

typedef struct attempt {
    fixture *s;
    const camber_frame *frame;
} attempt;

/* With a renderer of its own, which keeps the texture of images. */
static camber_status try_frame(camber_context *context, void *user) {
    const attempt *a = user;
    camber_surface *surface = a->s->on.surface[a->s->on.renderer[0] ? 0 : 1]; /* none, where OpenCL draws */
    camber_renderer *renderer = NULL;
    (void)context;
    const camber_renderer_desc in_gl = {.sharing = CAMBER_SHARING_COPY, .rasterizer = CAMBER_RASTERIZER_GL},
                               in_cl = {0};
    const camber_renderer_desc desc = surface ? in_gl : in_cl;
    camber_status status = camber_renderer_create(a->s->on.device, surface, &desc, &renderer);
    if (status == CAMBER_OK)
        status = camber_renderer_render(renderer, a->frame, NULL, NULL, NULL);
    camber_renderer_destroy(renderer);
    return status;
}

static void test_memory(void **state) {
    fixture *s = *state;
    static sheet made[20];
    static camber_image images[20];
    camber_pass passes[20] = {{0}};
    for (uint32_t i = 0; i < 20; i++) {
        make_sheet(made + i, 11 + i, 9, CLEAR);
        images[i] = made[i].image;
        passes[i] = (camber_pass){.kind = CAMBER_PASS_FILL, .fill = {.color = {0, 0, 0, 1}, .image = images + i}};
    }
    const camber_frame frame = {.width = SIDE, .height = SIDE, .passes = passes, .pass_count = 20};
    attempt all = {s, &frame};
    assert_int_equal(try_frame(s->context, &all), CAMBER_OK); /* the device keeps its kernels */
    each_allocation_fails(&s->h, try_frame, s->context, &all);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_memory),       cmocka_unit_test(test_straight),    cmocka_unit_test(test_bent),
        cmocka_unit_test(test_corner),       cmocka_unit_test(test_sides),       cmocka_unit_test(test_fine),
        cmocka_unit_test(test_neighbours),   cmocka_unit_test(test_composed),    cmocka_unit_test(test_many),
        cmocka_unit_test(test_fill_color),   cmocka_unit_test(test_fill_images), cmocka_unit_test(test_pitched_line),
        cmocka_unit_test(test_pitched_fill), cmocka_unit_test(test_misuse),
    };
    return FIXTURE_RUN(tests);
}
