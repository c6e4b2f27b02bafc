/* Labels of a view: which are shown, and where their glyphs and icons are. */
#include "town.h"

#include "map/collision.h"

/* ---- The grid ---- */

static camber_obstacle random_shape(uint32_t *state) {
    const double x = next_share(state) * 500.0 - 50.0, y = next_share(state) * 300.0 - 50.0;
    const double w = next_share(state) * 60.0, h = next_share(state) * 20.0;
    if (next_share(state) < 0.5)
        return (camber_obstacle){x, y, x + w, y + h, 0.0};
    return (camber_obstacle){x, y, x + w, y + w, 0.5 * w};
}

/* Returns how many shapes the longest list of a grid has. */
static size_t longest_list(const camber_collision *grid) {
    size_t most = 0;
    for (size_t i = 0; i < 2 * grid->columns * grid->rows; i++) {
        size_t count = 0;
        for (uint32_t e = grid->cells[i]; e; e = grid->entries[e - 1].next)
            count++;
        most = count > most ? count : most;
    }
    return most;
}

/* Compares a grid with a list of all shapes. Every second shape is moved far away. */
static void compare_grid(camber_context *context, const camber_box *bounds, double far) {
    enum { SHAPES = 400 };
    camber_collision grid;
    camber_obstacle shapes[SHAPES];
    camber_symbol_overlap overlaps[SHAPES];
    uint32_t seed = 1;
    assert_int_equal(camber_collision_make(context, *bounds, 32.0, &grid), CAMBER_OK);
    size_t there = 0, hits = 0;
    for (int i = 0; i < SHAPES; i++) {
        camber_obstacle shape = random_shape(&seed);
        const camber_symbol_overlap overlap = (camber_symbol_overlap)(next_share(&seed) * 3.0);
        bool hit = false;
        if (i % 2) {
            shape.x0 += far;
            shape.x1 += far;
            shape.y0 += far;
            shape.y1 += far;
        }
        for (size_t k = 0; k < there && overlap != CAMBER_OVERLAP_ALWAYS; k++)
            hit |= camber_obstacles_meet(&shape, shapes + k) &&
                   (overlap == CAMBER_OVERLAP_NEVER || overlaps[k] == CAMBER_OVERLAP_NEVER);
        const bool held = camber_collision_holds(&grid, &shape);
        if (held)
            assert_int_equal(camber_collision_hits(&grid, &shape, overlap), hit);
        hits += hit;
        if (hit || !held)
            continue;
        assert_int_equal(camber_collision_add(&grid, &shape, overlap), CAMBER_OK);
        shapes[there] = shape;
        overlaps[there++] = overlap;
    }
    assert_true(there > 50 && hits > 50);
    assert_true(longest_list(&grid) < there / 4);
    camber_collision_free(&grid);
}

static void test_collision(void **state) {
    (void)state;
    town *t = open_town(NAMES("names", "\"text-size\":12"));
    compare_grid(t->context, &(camber_box){0.0, 0.0, 400.0, 200.0}, 0.0);
    close_town(t);
}

/* Two towns on opposite sides of the world: each of them has many cells all the same. */
static void test_far_apart(void **state) {
    (void)state;
    town *t = open_town(NAMES("names", "\"text-size\":12"));
    const double far = 1e7;
    camber_collision grid;
    compare_grid(t->context, &(camber_box){-50.0, -50.0, far + 600.0, far + 400.0}, far);
    /* A shape that is wider than all lists is in each of them once. */
    assert_int_equal(camber_collision_make(t->context, (camber_box){0.0, 0.0, far, 64.0}, 32.0, &grid), CAMBER_OK);
    const camber_obstacle wide = {10.0, 10.0, far - 10.0, 20.0, 0.0}, late = {far - 90.0, 5.0, far - 80.0, 15.0, 0.0};
    assert_false(camber_collision_hits(&grid, &late, CAMBER_OVERLAP_NEVER));
    assert_int_equal(camber_collision_add(&grid, &wide, CAMBER_OVERLAP_NEVER), CAMBER_OK);
    assert_true(camber_collision_hits(&grid, &late, CAMBER_OVERLAP_NEVER));
    assert_int_equal(longest_list(&grid), 1);
    camber_collision_free(&grid);
    close_town(t);
}

/* ---- Points ---- */

static void test_point(void **state) {
    (void)state;
    town *t = open_town(NAMES("names", "\"text-size\":20"));
    add_point(t, "HOH", 300.0, 200.0);
    camber_labels labels = place(t);
    assert_int_equal(labels.label_count, 1);
    assert_int_equal(labels.layer_count, 1);
    assert_int_equal(labels.layers[0].glyph_count, 3);
    const camber_label_item *items = labels.items;
    /* The middle one is in the middle, upright, and 20 px an em. */
    assert_near((double)items[0].xx, 20.0, 1e-4);
    assert_near((double)items[0].yy, 20.0, 1e-4);
    assert_near((double)items[0].xy, 0.0, 1e-9);
    assert_true((double)items[1].x < 300.0 && (double)items[2].x > 300.0);
    assert_near((double)items[0].y, (double)items[2].y, 1e-4);
    const camber_box box = labels.labels[0].box;
    assert_near(0.5 * (box.x0 + box.x1), 300.0, 1e-3);
    assert_near(0.5 * (box.y0 + box.y1), 200.0, 1e-3);
    assert_near(box.y1 - box.y0, 1.2 * 20.0 + 4.0, 1e-3);
    camber_labels_free(&labels);
    close_town(t);
}

static void test_overlap(void **state) {
    (void)state;
    static const struct {
        const char *layout;
        size_t count;
    } cases[] = {{"\"text-size\":16", 1},
                 {"\"text-allow-overlap\":true", 2},
                 {"\"text-ignore-placement\":true", 2},
                 {"\"text-overlap\":\"cooperative\"", 2},
                 {"\"text-overlap\":\"never\"", 1},
                 {"\"text-variable-anchor\":[\"left\",\"right\"]", 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char layer[512];
        snprintf(layer, sizeof layer, NAMES("names", "%s"), cases[i].layout);
        town *t = open_town(layer);
        add_point(t, "One", 300.0, 200.0);
        add_point(t, "Two", 305.0, 202.0);
        expect_count(t, cases[i].count);
        close_town(t);
    }
}

/* Later layers come first, and a lower sort key. */
static void test_order(void **state) {
    (void)state;
    town *t = open_town(NAMES("below", "\"text-size\":16") "," NAMES("above", "\"text-size\":12"));
    add_point(t, "One", 300.0, 200.0);
    camber_labels labels = place(t);
    assert_int_equal(labels.label_count, 1);
    assert_int_equal(labels.layers[0].layer, 1);
    camber_labels_free(&labels);
    close_town(t);
    for (int i = 0; i < 2; i++) {
        t = open_town(i ? NAMES("names", "\"symbol-sort-key\":[\"match\",[\"get\",\"name\"],\"One\",1,2]")
                        : NAMES("names", "\"symbol-sort-key\":[\"match\",[\"get\",\"name\"],\"One\",2,1]"));
        add_point(t, "One", 300.0, 200.0);
        add_point(t, "Two", 305.0, 202.0);
        labels = place(t);
        assert_int_equal(labels.label_count, 1);
        assert_int_equal(labels.labels[0].feature, i ? 0 : 1);
        camber_labels_free(&labels);
        close_town(t);
    }
}

/* The feature of the lower rank comes first, if the style reads ranks. */
static void test_rank(void **state) {
    (void)state;
    for (int i = 0; i < 2; i++) {
        town *t = open_town(NAMES("names", "\"text-size\":[\"case\",[\"has\",\"rank\"],12,14]"));
        add_point(t, "One", 300.0, 200.0);
        add_point(t, "Two", 305.0, 202.0);
        for (size_t c = 0; c < 2; c++)
            for (size_t p = 0; p < t->style->schema.property_count; p++)
                if (strcmp(t->style->schema.properties[p], "rank") == 0)
                    t->values[t->classes[c].first_value + p] =
                        (camber_value){.type = CAMBER_VALUE_NUMBER, .number = c == (size_t)i ? 1.0 : 2.0};
        camber_labels labels = place(t);
        assert_int_equal(labels.label_count, 1);
        assert_int_equal(labels.labels[0].feature, i);
        camber_labels_free(&labels);
        close_town(t);
    }
}

/* A view across the antimeridian shows the labels of both sides. */
static void test_antimeridian(void **state) {
    (void)state;
    town *t = open_town(NAMES("names", "\"text-size\":12"));
    add_point(t, "West", 1000.0, 512.0);
    add_point(t, "East", 24.0, 512.0);
    see(t,
        (camber_view_desc){.kind = CAMBER_VIEW_CENTER, .zoom = 1.0, .longitude = 180.0, .width = 200, .height = 100});
    camber_labels labels = place(t);
    assert_int_equal(labels.label_count, 2);
    for (size_t i = 0; i < 2; i++) {
        const camber_label *label = labels.labels + i;
        assert_near(0.5 * (label->box.x0 + label->box.x1), label->feature == 0 ? 100.0 - 24.0 : 100.0 + 24.0, 0.01);
    }
    camber_labels_free(&labels);
    close_town(t);
}

static void test_variable_anchors(void **state) {
    (void)state;
    town *t = open_town(NAMES("names", "\"text-variable-anchor\":[\"left\",\"right\",\"top\"],\"text-radial-offset\":1,"
                                       "\"text-size\":20,\"text-justify\":\"auto\""));
    add_point(t, "HOH", 300.0, 200.0);
    camber_labels labels = place(t);
    /* The text is to the right of its anchor, by an em and the padding. */
    assert_near(labels.labels[0].box.x0, 300.0 + 20.0, 0.01);
    assert_near((double)labels.items[0].x, 300.0 + 20.0 + 2.0, 4.0);
    camber_labels_free(&labels);
    /* A label in its way sends it to the left. */
    close_town(t);
    t = open_town(NAMES("names", "\"text-variable-anchor\":[\"left\",\"right\"],\"text-radial-offset\":1,"
                                 "\"text-size\":20,\"symbol-sort-key\":[\"match\",[\"get\",\"name\"],\"Wall\",0,1]"));
    add_point(t, "Wall", 310.0, 200.0);
    add_point(t, "HOH", 300.0, 200.0);
    labels = place(t);
    assert_int_equal(labels.label_count, 2);
    assert_near(labels.labels[1].box.x1, 300.0 - 20.0, 0.01);
    camber_labels_free(&labels);
    close_town(t);
}

static void test_turns(void **state) {
    (void)state;
    for (int map = 0; map < 2; map++) {
        town *t = open_town(map ? NAMES("names", "\"text-size\":20,\"text-rotation-alignment\":\"map\"")
                                : NAMES("names", "\"text-size\":20,\"text-rotate\":90"));
        add_point(t, "HOH", 512.0, 512.0);
        see(t, (camber_view_desc){.kind = CAMBER_VIEW_CENTER, .zoom = 1.0, .bearing_deg = map ? 30.0 : 0.0});
        camber_labels labels = place(t);
        const double turn = map ? -30.0 : 90.0;
        assert_int_equal(labels.label_count, 1);
        for (size_t i = 0; i < labels.item_count; i++) {
            const camber_label_item *item = labels.items + i;
            assert_near(atan2((double)item->yx, (double)item->xx) * 180.0 / acos(-1.0), turn, 1e-3);
            assert_near(hypot((double)item->xy, (double)item->yy), 20.0, 1e-3);
        }
        camber_labels_free(&labels);
        close_town(t);
    }
}

/* ---- Areas ---- */

static void test_area(void **state) {
    (void)state;
    town *t = open_town(NAMES("names", "\"text-size\":10"));
    /* A square of 200 px with a thin arm; and a hole in its middle. Outer rings go clockwise as seen. */
    const double outer[] = {100, 100, 300, 100, 300, 190, 600, 190, 600, 210, 300, 210, 300, 300, 100, 300, 100, 100};
    const double hole[] = {110, 110, 110, 190, 290, 190, 290, 110, 110, 110};
    const uint32_t class = add_class(t, CAMBER_GEOMETRY_LABEL_AREA, "Lake");
    add_polyline(t, class, true, outer, 9);
    add_polyline(t, class, false, hole, 5);
    camber_labels labels = place(t);
    assert_int_equal(labels.label_count, 1);
    const camber_box box = labels.labels[0].box;
    const double x = 0.5 * (box.x0 + box.x1), y = 0.5 * (box.y0 + box.y1);
    assert_true(x > 150.0 && x < 250.0);
    assert_near(y, 245.0, 2.0);
    camber_labels_free(&labels);
    close_town(t);
}

/* ---- Lines ---- */

enum { ARC_POINTS = 181 };

/* An arc about the picture's middle. */
static void make_arc(double radius, double from_deg, double to_deg, double *px) {
    for (int i = 0; i < ARC_POINTS; i++) {
        const double angle = (from_deg + (to_deg - from_deg) * i / (ARC_POINTS - 1)) * acos(-1.0) / 180.0;
        px[2 * i] = 512.0 + radius * cos(angle);
        px[2 * i + 1] = 512.0 + radius * sin(angle);
    }
}

#define ALONG "\"symbol-placement\":\"line\",\"text-size\":20"

static void test_line(void **state) {
    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        town *t = open_town(NAMES("names", ALONG));
        double px[2 * ARC_POINTS];
        /* Over the top, from left to right, and back: words are upright on both. */
        make_arc(200.0, turned ? 360.0 : 180.0, turned ? 180.0 : 360.0, px);
        add_feature(t, CAMBER_GEOMETRY_LABEL_LINE, "Circular Street", px, ARC_POINTS);
        camber_labels labels = place(t);
        assert_true(labels.label_count >= 2);
        for (size_t i = 0; i < labels.item_count; i++) {
            const camber_label_item *item = labels.items + i;
            const double x = (double)item->x - 512.0, y = (double)item->y - 512.0;
            /* The baseline is a little inside of the arc; the tangent goes to the right. */
            assert_near(hypot(x, y), 200.0 - 6.0, 4.0);
            const double way[2] = {-y / hypot(x, y), x / hypot(x, y)};
            assert_true((double)item->xx * way[0] + (double)item->yx * way[1] > 20.0 * cos(0.1));
            if (i && item->label == item[-1].label)
                assert_true(item->x > item[-1].x);
        }
        camber_labels_free(&labels);
        close_town(t);
    }
}

static void test_max_angle(void **state) {
    (void)state;
    static const struct {
        const char *layer;
        bool shown;
    } cases[] = {{NAMES("names", ALONG ",\"text-max-angle\":180"), true},
                 {NAMES("names", ALONG ",\"text-max-angle\":20"), false}};
    for (int i = 0; i < 2; i++) {
        town *t = open_town(cases[i].layer);
        double px[2 * 60];
        for (int k = 0; k < 60; k++) {
            px[2 * k] = 100.0 + 12.0 * k;
            px[2 * k + 1] = 300.0 + (k % 2 ? 4.0 : 0.0);
        }
        add_feature(t, CAMBER_GEOMETRY_LABEL_LINE, "Zigzag Road", px, 60);
        camber_labels labels = place(t);
        assert_int_equal(labels.label_count > 0, cases[i].shown);
        camber_labels_free(&labels);
        close_town(t);
    }
}

/* Where a line turns at one point, the glyphs turn step by step: if two neighbours took the whole turn, they would
 * overlap. */
static void test_kink(void **state) {
    (void)state;
    const double turn = 36.0 * acos(-1.0) / 180.0;
    town *t = open_town(NAMES("names", "\"symbol-placement\":\"line-center\",\"text-size\":20"));
    const double px[] = {512.0 - 300.0 * cos(turn), 512.0 - 300.0 * sin(turn), 512.0, 512.0, 812.0, 512.0};
    add_feature(t, CAMBER_GEOMETRY_LABEL_LINE, "Corner Avenue", px, 3);
    camber_labels labels = place(t);
    assert_int_equal(labels.label_count, 1);
    double least = turn, last = 0.0;
    for (size_t i = 0; i < labels.item_count; i++) {
        const double angle = atan2((double)labels.items[i].yx, (double)labels.items[i].xx);
        assert_true(angle > -0.001 && angle < turn + 0.001);
        if (i)
            assert_true(last - angle < 0.7 * turn && last - angle > -0.001);
        least = fmin(least, angle);
        last = angle;
    }
    assert_near(atan2((double)labels.items[0].yx, (double)labels.items[0].xx), turn, 0.001);
    assert_near(least, 0.0, 0.001);
    camber_labels_free(&labels);
    close_town(t);
}

#define REPEATED(id, layout, px)                                                                                       \
    "{\"id\":\"" id "\",\"type\":\"symbol\",\"metadata\":{\"camber:repeat\":" #px "},\"layout\":{\"text-field\":["     \
    "\"get\",\"name\"]," layout "}}"

/* The distance between labels of the same words, along lines and of points, when the metadata gives it. A name whose
 * first places are taken moves on by the spacing. */
static void test_repeat(void **state) {
    (void)state;
    const double px[] = {50.0, 500.0, 1000.0, 500.0}, point[] = {300.0, 200.0}, other[] = {480.0, 200.0};
    town *t = open_town(REPEATED("names", ALONG ",\"symbol-spacing\":100", 400));
    add_feature(t, CAMBER_GEOMETRY_LABEL_LINE, "Road", px, 2);
    camber_labels labels = place(t);
    assert_int_equal(labels.label_count, 2); /* of nine places */
    for (size_t i = 0; i < labels.label_count; i++)
        for (size_t k = 0; k < i; k++)
            assert_true(fabs(labels.labels[i].box.x0 - labels.labels[k].box.x0) > 399.0);
    camber_labels_free(&labels);
    close_town(t);
    static const struct {
        const char *layer;
        size_t count;
    } cases[] = {{NAMES("names", "\"text-size\":20"), 2},
                 {REPEATED("names", "\"text-size\":20", 170), 2},
                 {REPEATED("names", "\"text-size\":20", 190), 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        t = open_town(cases[i].layer);
        add_feature(t, CAMBER_GEOMETRY_LABEL_POINT, "Stop", point, 1);
        add_feature(t, CAMBER_GEOMETRY_LABEL_POINT, "Stop", other, 1);
        expect_count(t, cases[i].count);
        close_town(t);
    }
}

static void test_line_spacing(void **state) {
    (void)state;
    const double px[] = {50.0, 500.0, 1000.0, 500.0}, near[] = {50.0, 540.0, 1000.0, 540.0};
    const double far[] = {50.0, 700.0, 1000.0, 700.0}, small[] = {50.0, 100.0, 70.0, 100.0};
    town *t = open_town(NAMES("names", ALONG ",\"symbol-spacing\":200"));
    add_feature(t, CAMBER_GEOMETRY_LABEL_LINE, "Road", px, 2);
    camber_labels labels = place(t);
    const size_t count = labels.label_count;
    assert_int_equal(count, 5); /* every 200 px from half a label and 2 em on */
    double middles[5];
    for (size_t i = 0; i < count; i++)
        middles[i] = 0.5 * (labels.labels[i].box.x0 + labels.labels[i].box.x1);
    for (size_t i = 0; i < count; i++)
        assert_near(remainder(middles[i] - middles[0], 200.0), 0.0, 0.01);
    camber_labels_free(&labels);
    /* The same words are not said again on a line beside it, but on one farther away. */
    add_feature(t, CAMBER_GEOMETRY_LABEL_LINE, "Road", near, 2);
    expect_count(t, count);
    add_feature(t, CAMBER_GEOMETRY_LABEL_LINE, "Road", far, 2);
    expect_count(t, 2 * count);
    add_feature(t, CAMBER_GEOMETRY_LABEL_LINE, "Too long a name", small, 2);
    expect_count(t, 2 * count);
    close_town(t);
    t = open_town(NAMES("names", "\"symbol-placement\":\"line-center\""));
    add_feature(t, CAMBER_GEOMETRY_LABEL_LINE, "Road", px, 2);
    labels = place(t);
    assert_int_equal(labels.label_count, 1);
    assert_near(0.5 * (labels.labels[0].box.x0 + labels.labels[0].box.x1), 525.0, 1.0);
    camber_labels_free(&labels);
    close_town(t);
}

/* Lines that other cuts of the map begin elsewhere give the same places: a view of half of the line. */
static void test_line_does_not_depend_on_view(void **state) {
    (void)state;
    const double px[] = {-3000.0, 500.0, 300.0, 480.0, 4000.0, 520.0};
    town *t = open_town(NAMES("names", ALONG));
    add_feature(t, CAMBER_GEOMETRY_LABEL_LINE, "Road", px, 3);
    camber_labels all = place(t);
    see(t, (camber_view_desc){.kind = CAMBER_VIEW_CENTER, .zoom = 1.0, .width = 512, .height = 512});
    camber_labels part = place(t);
    assert_true(part.label_count > 0 && all.label_count > part.label_count);
    for (size_t i = 0; i < part.label_count; i++) {
        bool found = false;
        for (size_t k = 0; k < all.label_count; k++)
            found |= fabs(part.labels[i].box.x0 + 256.0 - all.labels[k].box.x0) < 0.01;
        assert_true(found);
    }
    camber_labels_free(&all);
    camber_labels_free(&part);
    close_town(t);
}

/* Between two whole zooms the labels of a line stay where they are on the map, whatever the size of the text. */
static void test_line_does_not_depend_on_zoom(void **state) {
    (void)state;
    const double px[] = {50.0, 500.0, 1000.0, 500.0};
    town *t =
        open_town(NAMES("names", ALONG ",\"symbol-spacing\":200,\"text-size\":[\"interpolate\",[\"linear\"],[\"zoom\"],"
                                       "1,10,2,16]"));
    add_feature(t, CAMBER_GEOMETRY_LABEL_LINE, "Road", px, 2);
    camber_labels whole = place(t);
    assert_int_equal(whole.label_count, 5);
    see(t, (camber_view_desc){.kind = CAMBER_VIEW_CENTER, .zoom = 1.5, .width = 1440, .height = 1440});
    camber_labels between = place(t);
    assert_int_equal(between.label_count, 5);
    for (size_t i = 0; i < 5; i++) {
        const camber_box *a = &whole.labels[i].box;
        double nearest = INFINITY;
        for (size_t k = 0; k < 5; k++) {
            const camber_box *b = &between.labels[k].box;
            nearest = fmin(nearest, fabs((0.5 * (b->x0 + b->x1) - 720.0) / sqrt(2.0) - 0.5 * (a->x0 + a->x1) + 512.0));
        }
        assert_near(nearest, 0.0, 0.1);
    }
    camber_labels_free(&whole);
    camber_labels_free(&between);
    close_town(t);
}

/* ---- Icons ---- */

static void test_icon(void **state) {
    (void)state;
    town *t = open_town(ICONS("icons", "\"icon-size\":2,\"icon-anchor\":\"bottom\",\"icon-offset\":[1,-3]"));
    add_point(t, "", 300.0, 200.0);
    camber_labels labels = place(t);
    assert_int_equal(labels.layers[0].icon_count, 1);
    const camber_label_item *item = labels.items;
    assert_int_equal(item->glyph, CAMBER_NO_GLYPH);
    assert_ptr_equal(item->icon, t->images);
    assert_near((double)item->xx, 20.0, 1e-6);
    assert_near((double)item->yy, 40.0, 1e-6);
    assert_near((double)item->x, 300.0 + 2.0 - 10.0, 1e-4);
    assert_near((double)item->y, 200.0 - 6.0 - 40.0, 1e-4);
    camber_labels_free(&labels);
    close_town(t);
}

/* An image that keeps its size is drawn on whole px; others are drawn where they are. */
static void test_icon_on_whole_px(void **state) {
    (void)state;
    static const struct {
        const char *layout;
        double x, y;
    } samples[] = {
        {"\"icon-size\":1", 295.0, 191.0}, {"\"icon-size\":1.5", 292.8, 185.6}, {"\"icon-rotate\":90", 310.3, 195.6}};
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        char layer[256];
        snprintf(layer, sizeof layer, ICONS("icons", "%s"), samples[i].layout);
        town *t = open_town(layer);
        add_point(t, "", 300.3, 200.6);
        camber_labels labels = place(t);
        assert_int_equal(labels.layers[0].icon_count, 1);
        assert_near((double)labels.items[0].x, samples[i].x, 1e-3);
        assert_near((double)labels.items[0].y, samples[i].y, 1e-3);
        camber_labels_free(&labels);
        close_town(t);
    }
}

/* Icons that are too close to each other are left out evenly, wherever the view begins. */
static void test_icons_along(void **state) {
    (void)state;
    const double px[] = {10.0, 500.0, 1014.0, 500.0};
    town *t = open_town(ICONS("icons", "\"symbol-placement\":\"line\",\"symbol-spacing\":9"));
    double origin = NAN;
    add_feature(t, CAMBER_GEOMETRY_LABEL_LINE, "", px, 2);
    for (uint32_t width = 500; width <= 900; width += 90) {
        see(t, (camber_view_desc){.kind = CAMBER_VIEW_CENTER, .zoom = 1.0, .width = width, .height = 512});
        camber_labels labels = place(t);
        assert_near((double)labels.item_count, width / 18.0, 1.5);
        if (isnan(origin))
            origin = (double)labels.items[0].x - 0.5 * width;
        for (size_t i = 0; i < labels.item_count; i++)
            assert_near(remainder((double)labels.items[i].x - 0.5 * width - origin, 18.0), 0.0, 0.01);
        camber_labels_free(&labels);
    }
    close_town(t);
}

static void test_text_fit(void **state) {
    (void)state;
    town *t = open_town(NAMES("shields", "\"icon-image\":\"frame\",\"icon-text-fit\":\"both\",\"text-size\":20,"
                                         "\"icon-text-fit-padding\":[1,2,3,4]"));
    add_point(t, "HOH", 300.0, 200.0);
    camber_labels labels = place(t);
    assert_int_equal(labels.layers[0].icon_count, 1);
    const camber_label_item *item = labels.items;
    assert_near((double)item->unstretched_px, 1.0, 1e-6);
    assert_near((double)item->yy, 24.0 + 1.0 + 3.0, 1e-3);
    assert_near((double)item->y, 200.0 - 12.0 - 1.0, 1e-3);
    assert_near((double)item->x + 0.5 * ((double)item->xx + 4.0 - 2.0), 300.0, 1e-3);
    camber_labels_free(&labels);
    close_town(t);
}

/* A text and an icon are shown together, unless one of them is optional. */
static void test_optional(void **state) {
    (void)state;
    static const struct {
        const char *layout;
        size_t icons, glyphs;
    } cases[] = {{"\"icon-image\":\"box\"", 1, 3},
                 {"\"icon-image\":\"box\",\"icon-optional\":true", 1, 6},
                 {"\"icon-image\":\"box\",\"text-optional\":true", 1, 3},
                 {"\"icon-image\":\"none\"", 0, 6}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char layer[512];
        snprintf(layer, sizeof layer,
                 NAMES("names", "\"text-anchor\":[\"match\",[\"get\",\"name\"],\"One\",\"top\",\"bottom\"],"
                                "\"text-offset\":[\"match\",[\"get\",\"name\"],\"One\",[\"literal\",[0,1]],"
                                "[\"literal\",[0,-1]]],%s"),
                 cases[i].layout);
        town *t = open_town(layer);
        add_point(t, "One", 300.0, 200.0);
        add_point(t, "Two", 300.0, 201.0);
        camber_labels labels = place(t);
        assert_int_equal(labels.layers[0].icon_count, cases[i].icons);
        assert_int_equal(labels.layers[0].glyph_count, cases[i].glyphs);
        camber_labels_free(&labels);
        close_town(t);
    }
}

/* ---- Pitch ---- */

static void test_pitch(void **state) {
    (void)state;
    for (int flat = 0; flat < 2; flat++) {
        town *t = open_town(flat ? NAMES("names", "\"text-size\":20,\"text-pitch-alignment\":\"map\"")
                                 : NAMES("names", "\"text-size\":20"));
        add_point(t, "Far", 512.0, 200.0);
        add_point(t, "Near", 512.0, 700.0);
        see(t, (camber_view_desc){.kind = CAMBER_VIEW_CENTER, .zoom = 1.0, .pitch_deg = 50.0});
        const camber_view_lens lens = camber_view_lens_of(&t->view);
        camber_labels labels = place(t);
        assert_int_equal(labels.label_count, 2);
        for (size_t i = 0; i < labels.item_count; i++) {
            const camber_label_item *item = labels.items + i;
            const double plane[2] = {512.0, labels.labels[item->label].feature == 0 ? 200.0 : 700.0};
            double seen[2] = {0.0, 0.0};
            const double depth = camber_lens_see(&lens, plane, seen);
            assert_int_equal(labels.looks[item->look].flat, flat);
            assert_near((double)item->xx, 20.0 * (0.5 + 0.5 * (flat ? depth : 1.0 / depth)), 1e-3);
            assert_near((double)item->y, flat ? plane[1] : seen[1], 20.0);
        }
        camber_labels_free(&labels);
        close_town(t);
    }
}

/* ---- Many labels ---- */

#define MANY                                                                                                           \
    NAMES("streets", "\"symbol-placement\":\"line\",\"text-size\":12,\"symbol-spacing\":120")                          \
    "," NAMES("places", "\"text-size\":14")

static void add_many(town *t, uint32_t seed, bool backwards) {
    enum { POINTS = 400, LINES = 120 };
    typedef struct made {
        char name[16];
        double px[8];
        size_t count;
    } made;
    static made list[POINTS + LINES];
    for (size_t i = 0; i < POINTS + LINES; i++) {
        made *m = list + i;
        snprintf(m->name, sizeof m->name, "Name %u", (unsigned)(next_share(&seed) * 300.0));
        m->count = i < POINTS ? 1 : 4;
        m->px[0] = next_share(&seed) * 1300.0 - 140.0;
        m->px[1] = next_share(&seed) * 1300.0 - 140.0;
        for (size_t k = 1; k < m->count; k++) {
            m->px[2 * k] = m->px[2 * k - 2] + 100.0 + 40.0 * next_share(&seed);
            m->px[2 * k + 1] = m->px[2 * k - 1] + 40.0 * next_share(&seed);
        }
    }
    for (size_t i = 0; i < POINTS + LINES; i++) {
        const made *m = list + (backwards ? POINTS + LINES - 1 - i : i);
        add_feature(t, m->count == 1 ? CAMBER_GEOMETRY_LABEL_POINT : CAMBER_GEOMETRY_LABEL_LINE, m->name, m->px,
                    m->count);
    }
}

static int compare_items(const void *a, const void *b) {
    const camber_label_item *p = a, *q = b;
    return p->x != q->x ? (p->x < q->x ? -1 : 1) : p->y != q->y ? (p->y < q->y ? -1 : 1) : 0;
}

/* Glyphs are numbered as they come, so only their places are compared. */
static void test_shuffled(void **state) {
    (void)state;
    camber_labels labels[2];
    town *towns[2];
    for (int i = 0; i < 2; i++) {
        towns[i] = open_town(MANY);
        add_many(towns[i], 7, i == 1);
        labels[i] = place(towns[i]);
        qsort(labels[i].items, labels[i].item_count, sizeof *labels[i].items, compare_items);
    }
    assert_true(labels[0].label_count > 150);
    assert_int_equal(labels[0].label_count, labels[1].label_count);
    assert_int_equal(labels[0].item_count, labels[1].item_count);
    for (size_t i = 0; i < labels[0].item_count; i++)
        assert_memory_equal(&labels[0].items[i].x, &labels[1].items[i].x, 6 * sizeof(float));
    for (int i = 0; i < 2; i++) {
        camber_labels_free(labels + i);
        close_town(towns[i]);
    }
}

/* Labels of points have boxes of their own, and all of them touch the picture. */
static void test_apart(void **state) {
    (void)state;
    town *t = open_town(NAMES("places", "\"text-size\":14"));
    add_many(t, 11, false);
    camber_labels labels = place(t);
    assert_true(labels.label_count > 100);
    for (size_t i = 0; i < labels.label_count; i++) {
        const camber_box *a = &labels.labels[i].box;
        assert_true(a->x1 > 0.0 && a->y1 > 0.0 && a->x0 < t->view.width && a->y0 < t->view.height);
        for (size_t k = 0; k < i; k++) {
            const camber_box *b = &labels.labels[k].box;
            assert_false(a->x0 < b->x1 && a->x1 > b->x0 && a->y0 < b->y1 && a->y1 > b->y0);
        }
    }
    camber_labels_free(&labels);
    close_town(t);
}

static void test_avoid_edges(void **state) {
    (void)state;
    town *t = open_town(NAMES("places", "\"symbol-avoid-edges\":true"));
    add_many(t, 13, false);
    camber_labels labels = place(t);
    assert_true(labels.label_count > 100);
    for (size_t i = 0; i < labels.label_count; i++) {
        const camber_box *a = &labels.labels[i].box;
        assert_true(a->x0 >= 0.0 && a->y0 >= 0.0 && a->x1 <= t->view.width && a->y1 <= t->view.height);
    }
    camber_labels_free(&labels);
    close_town(t);
}

/* ---- Books ---- */

static void expect_same(const camber_labels *got, const camber_labels *expected) {
    assert_int_equal(got->label_count, expected->label_count);
    assert_int_equal(got->layer_count, expected->layer_count);
    assert_int_equal(got->item_count, expected->item_count);
    assert_int_equal(got->look_count, expected->look_count);
    for (size_t i = 0; i < got->label_count; i++) {
        assert_int_equal(got->labels[i].feature, expected->labels[i].feature);
        assert_memory_equal(&got->labels[i].box, &expected->labels[i].box, sizeof(camber_box));
    }
    for (size_t i = 0; i < got->layer_count; i++)
        assert_memory_equal(got->layers + i, expected->layers + i, sizeof *got->layers);
    for (size_t i = 0; i < got->item_count; i++) {
        const camber_label_item *a = got->items + i, *b = expected->items + i;
        assert_int_equal(a->glyph, b->glyph);
        assert_ptr_equal(a->icon, b->icon);
        assert_int_equal(a->label, b->label);
        assert_memory_equal(&a->x, &b->x, 7 * sizeof(float));
        const camber_label_look *p = got->looks + a->look, *q = expected->looks + b->look;
        assert_memory_equal(p, q, offsetof(camber_label_look, flat)); /* what follows has padding */
        assert_true(p->flat == q->flat);
    }
}

static void expect_book(town *t, camber_label_book *book, const camber_view_desc *desc) {
    camber_view view;
    camber_labels got;
    assert_int_equal(camber_view_create(t->context, desc, &view), CAMBER_OK);
    t->view = view;
    camber_labels expected = place(t);
    assert_true(expected.label_count > 10);
    assert_int_equal(camber_label_book_place(book, &view, &got), CAMBER_OK);
    expect_same(&got, &expected);
    camber_labels_free(&got);
    camber_labels_free(&expected);
}

/* A book gives the labels that each view has for itself, in whatever order views come, and also after features were
 * added. */
static void test_book(void **state) {
    (void)state;
    static const double square[] = {300, 300, 700, 300, 700, 520, 300, 520, 300, 300};
    static const camber_view_desc views[] = {
        {.kind = CAMBER_VIEW_CENTER, .zoom = 1},
        {.kind = CAMBER_VIEW_CENTER, .zoom = 1, .longitude = 30, .latitude = -20},
        {.kind = CAMBER_VIEW_CENTER, .zoom = 1, .longitude = 170, .width = 500, .height = 300},
        {.kind = CAMBER_VIEW_CENTER, .zoom = 1.7, .longitude = 30},
        {.kind = CAMBER_VIEW_CENTER, .zoom = 1.7, .longitude = -30},
        {.kind = CAMBER_VIEW_CENTER, .zoom = 1, .bearing_deg = 33},
        {.kind = CAMBER_VIEW_CENTER, .zoom = 1, .bearing_deg = 33, .longitude = 9},
        {.kind = CAMBER_VIEW_CENTER, .zoom = 1, .pitch_deg = 50},
        {.kind = CAMBER_VIEW_CENTER, .zoom = 1, .pitch_deg = 50, .latitude = 10},
        {.kind = CAMBER_VIEW_CENTER, .zoom = 1, .ratio = 2},
        {.kind = CAMBER_VIEW_CENTER, .zoom = 1}};
    town *t = open_town(MANY);
    camber_label_book *book;
    add_many(t, 23, false);
    add_feature(t, CAMBER_GEOMETRY_LABEL_AREA, "Park", square, 5);
    t->features.fonts = t->fonts;
    t->features.sprites = &t->sprites;
    assert_int_equal(camber_label_book_create(&t->features, &book), CAMBER_OK);
    for (size_t i = 0; i < sizeof views / sizeof *views; i++)
        expect_book(t, book, views + i);
    add_point(t, "New", 480, 480);
    add_point(t, "Newer", 40, 80);
    expect_book(t, book, views);
    t->features.sprites = NULL; /* it is no block that the features may free */
    camber_label_book_destroy(book);
    close_town(t);
}

/* A book that runs out of memory gives the same labels as soon as there is some. */
static void test_book_memory(void **state) {
    (void)state;
    town *t = open_town(MANY);
    camber_label_book *book;
    camber_labels labels;
    camber_status status = CAMBER_ERROR_MEMORY;
    size_t failures = 0;
    add_many(t, 29, false);
    t->features.fonts = t->fonts;
    assert_int_equal(camber_label_book_create(&t->features, &book), CAMBER_OK);
    camber_labels expected = place(t);
    const uint64_t held = t->context->budget->held_bytes;
    for (uint64_t more = 0; status != CAMBER_OK; more += 4096 + more / 16) {
        camber_budget_allow(t->context->budget, held + more);
        status = camber_label_book_place(book, &t->view, &labels);
        assert_true(status == CAMBER_OK || status == CAMBER_ERROR_MEMORY);
        failures += status != CAMBER_OK;
        if (status != CAMBER_OK)
            camber_labels_free(&labels);
    }
    assert_true(failures > 10);
    expect_same(&labels, &expected);
    camber_labels_free(&labels);
    camber_labels_free(&expected);
    camber_label_book_destroy(book);
    close_town(t);
}

/* Without memory placing fails, and leaves nothing behind. */
static void test_memory(void **state) {
    (void)state;
    town *t = open_town(MANY);
    add_many(t, 17, false);
    camber_labels labels = place(t);
    const size_t count = labels.label_count;
    camber_labels_free(&labels);
    const uint64_t held = t->context->budget->held_bytes;
    camber_status status = CAMBER_ERROR_MEMORY;
    size_t failures = 0;
    for (uint64_t more = 0; status != CAMBER_OK; more += 4096 + more / 16) {
        camber_budget_allow(t->context->budget, held + more);
        status = camber_labels_place(&t->features, &t->view, t->fonts, &t->sprites, &labels);
        assert_true(status == CAMBER_OK || status == CAMBER_ERROR_MEMORY);
        failures += status != CAMBER_OK;
        if (status != CAMBER_OK)
            camber_labels_free(&labels);
    }
    assert_true(failures > 10);
    assert_int_equal(labels.label_count, count);
    camber_labels_free(&labels);
    close_town(t);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_collision),
        cmocka_unit_test(test_far_apart),
        cmocka_unit_test(test_point),
        cmocka_unit_test(test_overlap),
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_rank),
        cmocka_unit_test(test_antimeridian),
        cmocka_unit_test(test_variable_anchors),
        cmocka_unit_test(test_turns),
        cmocka_unit_test(test_area),
        cmocka_unit_test(test_line),
        cmocka_unit_test(test_max_angle),
        cmocka_unit_test(test_kink),
        cmocka_unit_test(test_line_spacing),
        cmocka_unit_test(test_repeat),
        cmocka_unit_test(test_line_does_not_depend_on_view),
        cmocka_unit_test(test_line_does_not_depend_on_zoom),
        cmocka_unit_test(test_icon),
        cmocka_unit_test(test_icon_on_whole_px),
        cmocka_unit_test(test_icons_along),
        cmocka_unit_test(test_text_fit),
        cmocka_unit_test(test_optional),
        cmocka_unit_test(test_pitch),
        cmocka_unit_test(test_shuffled),
        cmocka_unit_test(test_apart),
        cmocka_unit_test(test_avoid_edges),
        cmocka_unit_test(test_book),
        cmocka_unit_test(test_book_memory),
        cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
