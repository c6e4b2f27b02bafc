/* Pixels of labels: glyphs of the shipped font, turned and of several sizes from 20 px on, with halos and without,
 * beside samples of their outlines. The truth flattens curves far more finely, and moves and turns points by itself. */
#include "pictures.h"

#include "map/label_shapes.h"

#include <math.h>

enum { SIDE = 96, COLUMNS = 4, ITEMS = COLUMNS * COLUMNS, SAMPLES = 16, LOOKS = 3 };

static const camber_label_look looks[LOOKS] = {
    {.color = {0, 0, 0, 1}, .halo_color = {1, 1, 1, 1}, .halo_width_px = 1},
    {.color = {0, 0, 0, 1}},
    {.color = {0, 0, 0, 1}, .halo_color = {1, 1, 1, 1}, .halo_width_px = 1.6f}};

typedef struct sheet {
    camber_fonts *fonts;
    camber_text *text;
    camber_label_item items[ITEMS];
    camber_labels labels;
    camber_label_layer layer;
} sheet;

/* with_halos: else all items have the look without one. */
static sheet *make_sheet(fixture *f, bool with_halos) {
    static const char *const fonts[] = {"Noto Sans Regular"};
    static const char letters[] = "aR&i8gkWeQ%tS@xB";
    const camber_text_run run = {.text = letters, .size_bytes = ITEMS, .fonts = fonts, .font_count = 1};
    sheet *s = calloc(1, sizeof *s);
    assert_non_null(s);
    assert_int_equal(camber_fonts_create(f->context, &(camber_fonts_desc){.no_system = true}, &s->fonts), CAMBER_OK);
    assert_int_equal(camber_text_shape(s->fonts, &(camber_text_desc){.runs = &run, .run_count = 1}, &s->text),
                     CAMBER_OK);
    assert_int_equal(s->text->glyph_count, ITEMS);
    for (size_t i = 0; i < ITEMS; i++) {
        const float size = 20.0f + (float)(i % 5) * 1.5f, angle = 0.37f * (float)i;
        const float c = size * cosf(angle), n = size * sinf(angle);
        /* The middle of a letter is near the middle of its cell. */
        const float x = (float)SIDE / COLUMNS * ((float)(i % COLUMNS) + 0.5f) + 0.13f * (float)i;
        const float y = (float)SIDE / COLUMNS * ((float)(i / COLUMNS) + 0.5f) - 0.09f * (float)i;
        s->items[i] = (camber_label_item){.glyph = s->text->glyphs[i].glyph,
                                          .look = with_halos ? (uint32_t)i % LOOKS : 1,
                                          .x = x - 0.28f * c - 0.35f * n,
                                          .y = y - 0.28f * n + 0.35f * c,
                                          .xx = c,
                                          .xy = -n,
                                          .yx = n,
                                          .yy = c};
    }
    s->layer = (camber_label_layer){.glyph_count = ITEMS};
    s->labels = (camber_labels){.context = f->context,
                                .layers = &s->layer,
                                .layer_count = 1,
                                .items = s->items,
                                .item_count = ITEMS,
                                .looks = (camber_label_look *)(uintptr_t)looks,
                                .look_count = LOOKS};
    return s;
}

static void free_sheet(sheet *s) {
    camber_text_destroy(s->text);
    camber_fonts_destroy(s->fonts);
    free(s);
}

static picture draw(const fixture *f, sheet *s, double pitch_deg) {
    camber_label_shapes shapes;
    camber_mesh *mesh = NULL, *texts = NULL;
    camber_pass passes[CAMBER_LABEL_PASSES];
    camber_label_mesh meshes[CAMBER_LABEL_PASSES];
    assert_int_equal(camber_label_shapes_make(&s->labels, s->fonts, &shapes), CAMBER_OK);
    assert_int_equal(camber_mesh_create(f->on.device, fixture_any(f), &mesh), CAMBER_OK);
    assert_int_equal(camber_label_shapes_tessellate(&shapes, mesh, CAMBER_METHOD_STRIP), CAMBER_OK);
    assert_int_equal(camber_mesh_get_companion(mesh, &texts), CAMBER_OK);
    const size_t count = camber_label_shapes_passes(&shapes, shapes.ranges, passes, meshes);
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(meshes[i], CAMBER_MESH_TEXTS);
        passes[i].mesh = texts;
    }
    const camber_frame frame = {
        .width = SIDE, .height = SIDE, .passes = passes, .pass_count = count, .pitch_deg = pitch_deg};
    picture p = picture_draw(fixture_any(f), &frame);
    camber_label_shapes_free(&shapes);
    camber_mesh_destroy(mesh);
    return p;
}

/* ---- The truth ---- */

/* An item's rings in px: pairs of x, y. */
typedef struct drawn_glyph {
    double *points;
    camber_outline outline;
    double halo_px;                  /* 0: none */
    double left, top, right, bottom; /* of the glyph and its halo */
} drawn_glyph;

static drawn_glyph transform(sheet *s, const camber_label_item *item) {
    const camber_label_look *look = looks + item->look;
    drawn_glyph g = {.halo_px = (double)look->halo_width_px, .left = SIDE, .top = SIDE};
    assert_int_equal(camber_fonts_get_outline(s->fonts, item->glyph, 1.0f / 1024.0f, &g.outline), CAMBER_OK);
    assert_true(g.outline.ring_count > 0);
    const size_t count = g.outline.offsets[g.outline.ring_count];
    g.points = malloc(2 * count * sizeof *g.points);
    assert_non_null(g.points);
    for (size_t i = 0; i < count; i++) {
        const double u = (double)g.outline.points[2 * i], v = (double)g.outline.points[2 * i + 1];
        g.points[2 * i] = (double)item->x + (double)item->xx * u + (double)item->xy * v;
        g.points[2 * i + 1] = (double)item->y + (double)item->yx * u + (double)item->yy * v;
        g.left = fmin(g.left, g.points[2 * i] - g.halo_px);
        g.right = fmax(g.right, g.points[2 * i] + g.halo_px);
        g.top = fmin(g.top, g.points[2 * i + 1] - g.halo_px);
        g.bottom = fmax(g.bottom, g.points[2 * i + 1] + g.halo_px);
    }
    return g;
}

static double distance_from(const double *a, const double *b, double x, double y) {
    const double dx = b[0] - a[0], dy = b[1] - a[1], length = dx * dx + dy * dy;
    const double t = length > 0 ? fmin(fmax(((x - a[0]) * dx + (y - a[1]) * dy) / length, 0), 1) : 0;
    return hypot(x - a[0] - t * dx, y - a[1] - t * dy);
}

static void look_at(const drawn_glyph *g, double x, double y, bool *inside, bool *in_halo) {
    int winding = 0;
    double nearest = INFINITY;
    for (size_t r = 0; r < g->outline.ring_count; r++) {
        const size_t first = g->outline.offsets[r], end = g->outline.offsets[r + 1];
        for (size_t i = first; i < end; i++) {
            const double *a = g->points + 2 * i, *b = g->points + 2 * (i + 1 < end ? i + 1 : first);
            if (g->halo_px > 0)
                nearest = fmin(nearest, distance_from(a, b, x, y));
            if ((a[1] <= y) != (b[1] <= y) && a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) < x)
                winding += b[1] > a[1] ? 1 : -1;
        }
    }
    *inside = *inside || winding != 0;
    *in_halo = *in_halo || (g->halo_px > 0 && (winding != 0 || nearest <= g->halo_px));
}

/* Red (halos that are seen) and alpha (glyphs and halos) of a pixel, 0 to 1. */
static void sample(const drawn_glyph *glyphs, uint32_t x, uint32_t y, double *red, double *alpha) {
    *red = *alpha = 0;
    for (int i = 0; i < SAMPLES * SAMPLES; i++) {
        const double px = x + (i % SAMPLES + 0.5) / SAMPLES, py = y + ((double)(i / SAMPLES) + 0.5) / SAMPLES;
        bool inside = false, in_halo = false;
        for (size_t g = 0; g < ITEMS; g++)
            if (px >= glyphs[g].left && px <= glyphs[g].right && py >= glyphs[g].top && py <= glyphs[g].bottom)
                look_at(glyphs + g, px, py, &inside, &in_halo);
        *red += (in_halo && !inside) / (double)(SAMPLES * SAMPLES);
        *alpha += (in_halo || inside) / (double)(SAMPLES * SAMPLES);
    }
}

static void compare(fixture *f, bool with_halos, double pitch_deg, double most, double mean) {
    sheet *s = make_sheet(f, with_halos);
    picture p = draw(f, s, pitch_deg);
    drawn_glyph glyphs[ITEMS];
    double sum = 0, worst = 0;
    size_t touched = 0;
    for (size_t i = 0; i < ITEMS; i++)
        glyphs[i] = transform(s, s->items + i);
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++) {
            double red, alpha;
            sample(glyphs, x, y, &red, &alpha);
            const uint8_t *got = picture_at(&p, x, y);
            const double error = fmax(fabs(255 * red - got[0]), fabs(255 * alpha - got[3]));
            touched += alpha > 0 || got[3] > 0;
            sum += error;
            worst = fmax(worst, error);
        }
    print_message("%s, pitch %g: %zu pixels are touched; the worst is %.1f off, the mean %.3f of 255\n",
                  with_halos ? "halos" : "no halos", pitch_deg, touched, worst, sum / (double)touched);
    assert_true(touched > 1000);
    assert_true(worst <= most && sum / (double)touched <= mean);
    for (size_t i = 0; i < ITEMS; i++)
        free(glyphs[i].points);
    picture_free(&p);
    free_sheet(s);
}

static void test_glyphs(void **state) {
    compare(*state, false, 0, 10, 0.9);
}

static void test_halos(void **state) {
    compare(*state, true, 0, 72, 1.7);
}

/* Upright labels are where their items say in the picture, whatever the pitch. */
static void test_pitch(void **state) {
    compare(*state, false, 40, 10, 0.9);
    compare(*state, true, 40, 72, 1.7);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_glyphs), cmocka_unit_test(test_halos),
                                       cmocka_unit_test(test_pitch)};
    return FIXTURE_RUN(tests);
}
