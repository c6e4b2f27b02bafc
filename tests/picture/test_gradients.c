/* line-gradient and line-trim-offset of styles: the stops that a gradient becomes, and what is drawn by them. */
#include "map_picture.h"

#include "style/expression.h"

static const char HEAD[] =
    "{\"version\": 8, \"sources\": {\"s\": {\"type\": \"geojson\", \"lineMetrics\": true, \"data\": %s}}, \"layers\": "
    "[{\"id\": \"l\", \"type\": \"line\", \"source\": \"s\", \"paint\": {\"line-width\": 20%s}}]}";
static const char LINE[] = "{\"type\": \"LineString\", \"coordinates\": [[-36, 0], [36, 0]]}";

static camber_style *parse(camber_context *context, const char *data, const char *paint) {
    const size_t size = strlen(paint) + 2048;
    char *text = malloc(size);
    camber_style *style = NULL;
    assert_non_null(text);
    snprintf(text, size, HEAD, data, paint);
    assert_int_equal(camber_style_parse(context, text, strlen(text), "style.json", &style), CAMBER_OK);
    free(text);
    return style;
}

/* ---- Stops ---- */

typedef struct stop {
    double place, r, g, b, a;
} stop;

static void check_stops(camber_context *context, const char *gradient, const stop *stops, size_t count) {
    char paint[1024];
    snprintf(paint, sizeof paint, ", \"line-gradient\": %s", gradient);
    camber_style *style = parse(context, LINE, paint);
    const camber_layer_ramp *ramp = &style->layers[0].ramp;
    if (ramp->count != count)
        fail_msg("%s: %zu stops", gradient, ramp->count);
    for (size_t i = 0; i < count; i++) {
        const camber_ramp_stop *made = ramp->stops + i;
        const double off = fabs((double)made->color.r - stops[i].r) + fabs((double)made->color.g - stops[i].g) +
                           fabs((double)made->color.b - stops[i].b) + fabs((double)made->color.a - stops[i].a);
        if (fabs((double)made->place - stops[i].place) > 1e-6 || off > 1e-4)
            fail_msg("%s: stop %zu at %.7f is off by %g", gradient, i, (double)made->place, off);
    }
    camber_style_destroy(style);
}

/* A linear gradient has its own stops and no more; steps lie where they are. */
static void test_stops(void **state) {
    camber_context *context = ((fixture *)*state)->context;
    const stop linear[] = {{0, 1, 0, 0, 1}, {0.25, 1, 0, 0, 1}, {0.7, 0, 0, 1, 1}, {1, 0, 0, 1, 1}};
    check_stops(context, "[\"interpolate\", [\"linear\"], [\"line-progress\"], 0.25, \"red\", 0.7, \"blue\"]", linear,
                4);
    const stop step[] = {{0, 1, 0, 0, 1},      {0.123, 1, 0, 0, 1},  {0.123, 0, 1, 0, 1},
                         {0.9871, 0, 1, 0, 1}, {0.9871, 0, 0, 1, 1}, {1, 0, 0, 1, 1}};
    check_stops(context, "[\"step\", [\"line-progress\"], \"red\", 0.123, \"lime\", 0.9871, \"blue\"]", step, 6);
    const stop outside[] = {{0, 0, 1, 0, 1}, {1, 0, 1, 0, 1}};
    check_stops(context, "[\"step\", [\"line-progress\"], \"red\", -2, \"lime\", 1.5, \"blue\"]", outside, 2);
}

/* Curves, and steps that are found: within half a level of the expression at a thousand places. */
static void test_curves(void **state) {
    camber_context *context = ((fixture *)*state)->context;
    static const struct {
        const char *gradient;
        size_t most;
    } rows[] = {
        {"[\"interpolate\", [\"exponential\", 4], [\"line-progress\"], 0, \"red\", 1, \"blue\"]", 60},
        {"[\"interpolate\", [\"exponential\", 1e6], [\"line-progress\"], 0, \"black\", 1, \"white\"]", 120},
        {"[\"interpolate\", [\"cubic-bezier\", 0.9, 0, 0.1, 1], [\"line-progress\"], 0, \"red\", 1, \"lime\"]", 100},
        {"[\"interpolate-hcl\", [\"linear\"], [\"line-progress\"], 0, \"red\", 1, \"blue\"]", 100},
        {"[\"interpolate-lab\", [\"linear\"], [\"line-progress\"], 0, \"yellow\", 1, \"purple\"]", 100},
        {"[\"interpolate\", [\"linear\"], [\"sin\", [\"*\", 60, [\"line-progress\"]]], -1, \"red\", 1, \"blue\"]",
         1500},
        {"[\"case\", [\"<\", [\"abs\", [\"-\", [\"line-progress\"], 0.3037]], 0.004], \"red\", \"blue\"]", 300},
        {"[\"step\", [\"*\", [\"line-progress\"], [\"line-progress\"]], \"red\", 0.5, \"blue\"]", 300},
        {"[\"rgb\", [\"*\", 255, [\"line-progress\"]], 0, [\"-\", 255, [\"*\", 255, [\"line-progress\"]]]]", 300}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char paint[1024];
        snprintf(paint, sizeof paint, ", \"line-gradient\": %s", rows[i].gradient);
        camber_style *style = parse(context, LINE, paint);
        const camber_style_layer *layer = style->layers;
        if (layer->ramp.count < 2 || layer->ramp.count > rows[i].most)
            fail_msg("%s: %zu stops", rows[i].gradient, layer->ramp.count);
        for (size_t k = 0, at = 0; k <= 1000; k++) {
            const double place = ((double)k + 0.37) / 1001;
            camber_evaluation evaluation;
            camber_value value;
            camber_evaluation_begin(&evaluation, 0, NULL);
            evaluation.line_progress = place;
            assert_true(camber_expression_evaluate(layer->properties[CAMBER_LINE_GRADIENT], &evaluation, &value));
            camber_evaluation_end(&evaluation);
            while (at + 2 < layer->ramp.count && (double)layer->ramp.stops[at + 1].place <= place)
                at++;
            const camber_ramp_stop *a = layer->ramp.stops + at, *b = a + 1;
            const double t = (place - (double)a->place) / ((double)b->place - (double)a->place);
            const double off = fabs((double)a->color.r * (1 - t) + (double)b->color.r * t - (double)value.color.r) +
                               fabs((double)a->color.b * (1 - t) + (double)b->color.b * t - (double)value.color.b);
            if (off > 2.0 / 255)
                fail_msg("%s: off by %g at %g", rows[i].gradient, off, place);
        }
        camber_style_destroy(style);
    }
}

/* ---- Hostile gradients ---- */

/* The ramp is bounded and in order, whatever it is made of. Where its evaluation is not bounded, ctest ends the test.
 */
static camber_style *parse_bounded(fixture *s, const char *paint) {
    camber_style *style = parse(s->context, LINE, paint);
    const camber_layer_ramp *ramp = &style->layers[0].ramp;
    const camber_ramp checked = {ramp->stops, ramp->count};
    float before = -1;
    assert_true(checked.count >= 1 && checked.count <= CAMBER_RAMP_STOPS_MAX);
    for (size_t i = 0; i < checked.count; i++) {
        const camber_color c = checked.stops[i].color;
        assert_true(checked.stops[i].place >= before && isfinite(c.r + c.g + c.b + c.a));
        before = checked.stops[i].place;
    }
    return style;
}

/* It says where it cannot be evaluated, and draws nothing there. */
static void test_fails_somewhere(void **state) {
    fixture *s = *state;
    s->h.warnings = 0;
    camber_style *style = parse_bounded(
        s, ", \"line-gradient\": [\"case\", [\"<\", [\"line-progress\"], 0.25], \"red\", [\"to-color\", [\"concat\", "
           "\"not\", [\"to-string\", [\"line-progress\"]]]]]");
    assert_int_equal(s->h.warnings, 1);
    const camber_layer_ramp *ramp = &style->layers[0].ramp;
    assert_true(ramp->stops[0].color.a == 1 && ramp->stops[ramp->count - 1].color.a == 0);
    camber_style_destroy(style);
}

static void test_hostile(void **state) {
    fixture *s = *state;
    static char paint[8 << 20];
    for (int kind = 0; kind < 3; kind++) {
        size_t used = (size_t)snprintf(paint, sizeof paint, ", \"line-gradient\": [%s, [\"line-progress\"], %s",
                                       kind == 1 ? "\"step\"" : "\"interpolate\", [\"exponential\", 1.0001]",
                                       kind == 1 ? "\"red\", " : "");
        for (int i = 0; i < 100000; i++)
            used += (size_t)snprintf(paint + used, sizeof paint - used, "%s%.9g, \"#%02x%02x%02x\"", i ? ", " : "",
                                     (kind == 2 ? 1e-9 : 1e-5) * i, i % 256, i * 7 % 256, i * 31 % 256);
        snprintf(paint + used, sizeof paint - used, "]");
        camber_style_destroy(parse_bounded(s, paint));
    }
    camber_style_destroy(parse_bounded(s, ", \"line-gradient\": [\"interpolate\", [\"linear\"], [\"sqrt\", [\"-\", "
                                          "[\"line-progress\"], 0.5]], 0, \"red\", 1, \"blue\"]"));
    camber_style_destroy(parse_bounded(s, ", \"line-gradient\": [\"step\", [\"%\", [\"*\", 1e9, [\"line-progress\"]], "
                                          "2], \"red\", 1, \"blue\"]"));
    /* Texts that take long, each time. */
    size_t used = (size_t)snprintf(paint, sizeof paint, ", \"line-gradient\": [\"to-color\", [\"slice\", [\"concat\"");
    for (int i = 0; i < 3000; i++)
        used += (size_t)snprintf(paint + used, sizeof paint - used, ", [\"to-string\", [\"line-progress\"]]");
    snprintf(paint + used, sizeof paint - used, "], 0, 4]]");
    camber_style_destroy(parse_bounded(s, paint));
}

/* ---- Pictures ---- */

static picture draw(fixture *s, const char *data, const char *paint) {
    const camber_scene_desc desc = {.view = {.kind = CAMBER_VIEW_CENTER, .zoom = 0, .width = 128, .height = 64}};
    map m = map_open(s, parse(s->context, data, paint), &desc);
    picture p = map_draw(s, &m);
    map_close(&m);
    return p;
}

static void expect(const picture *p, uint32_t x, uint32_t y, const double rgba[4]) {
    for (int c = 0; c < 4; c++)
        if (fabs(picture_value(p, x, y, c) - rgba[c]) > 1.5 / 255)
            fail_msg("channel %d at %u, %u: %g and not %g", c, x, y, picture_value(p, x, y, c), rgba[c]);
}

/* The line goes from 12.8 to 115.2 px; a degree is 1.4222 px. */
static void test_drawn(void **state) {
    fixture *s = *state;
    picture p = draw(s, LINE,
                     ", \"line-gradient\": [\"interpolate\", [\"linear\"], [\"line-progress\"], 0, \"red\", 1, "
                     "\"blue\"], \"line-color\": \"transparent\"");
    for (uint32_t x = 14; x < 114; x += 9) {
        const double t = (x + 0.5 - 12.8) / 102.4;
        expect(&p, x, 32, (const double[]){1 - t, 0, t, 1});
    }
    picture_free(&p);
    p = draw(s, LINE,
             ", \"line-gradient\": [\"step\", [\"line-progress\"], \"red\", 0.5, \"blue\"], "
             "\"line-trim-offset\": [0.75, 1], \"line-opacity\": 0.5");
    expect(&p, 63, 32, (const double[]){0.5, 0, 0, 0.5});
    expect(&p, 64, 32, (const double[]){0, 0, 0.5, 0.5});
    expect(&p, 88, 32, (const double[]){0, 0, 0.5, 0.5});
    expect(&p, 89, 32, (const double[]){0, 0, 0.3, 0.3}); /* 89.6 */
    expect(&p, 90, 32, (const double[]){0, 0, 0, 0});
    expect(&p, 114, 32, (const double[]){0, 0, 0, 0});
    picture_free(&p);
}

/* A line of several has each its own progress. */
static void test_several(void **state) {
    picture p =
        draw(*state, "{\"type\": \"MultiLineString\", \"coordinates\": [[[-36, 10], [36, 10]], [[0, -10], [36, -10]]]}",
             ", \"line-width\": 8, \"line-gradient\": [\"step\", [\"line-progress\"], \"red\", 0.5, \"lime\"]");
    expect(&p, 60, 17, (const double[]){1, 0, 0, 1});
    expect(&p, 68, 17, (const double[]){0, 1, 0, 1});
    expect(&p, 86, 46, (const double[]){1, 0, 0, 1});
    expect(&p, 94, 46, (const double[]){0, 1, 0, 1});
    picture_free(&p);
}

/* A border that has a colour is that all along, one that has none takes the gradient's; both are trimmed. */
static void test_border(void **state) {
    fixture *s = *state;
    picture p = draw(s, LINE,
                     ", \"line-gradient\": [\"step\", [\"line-progress\"], \"red\", 0.5, \"white\"], "
                     "\"line-border-width\": 4, \"line-border-color\": \"blue\", \"line-trim-offset\": [0, 0.25]");
    expect(&p, 50, 24, (const double[]){0, 0, 1, 1});
    expect(&p, 80, 40, (const double[]){0, 0, 1, 1});
    expect(&p, 50, 32, (const double[]){1, 0, 0, 1});
    expect(&p, 30, 24, (const double[]){0, 0, 0, 0});
    picture_free(&p);
    p = draw(s, LINE,
             ", \"line-gradient\": [\"step\", [\"line-progress\"], \"yellow\", 0.5, \"white\"], "
             "\"line-border-width\": 4");
    expect(&p, 50, 24, (const double[]){0.6, 0.6, 0, 1});
    expect(&p, 80, 24, (const double[]){0.6, 0.6, 0.6, 1});
    expect(&p, 80, 32, (const double[]){1, 1, 1, 1});
    picture_free(&p);
    /* Seen through: beside the line, not below it. */
    p = draw(s, LINE,
             ", \"line-gradient\": [\"step\", [\"line-progress\"], \"rgba(255, 0, 0, 0.5)\", 0.5, \"white\"], "
             "\"line-border-width\": 4, \"line-border-color\": \"blue\"");
    expect(&p, 50, 32, (const double[]){0.5, 0, 0, 0.5});
    expect(&p, 50, 24, (const double[]){0, 0, 1, 1});
    expect(&p, 80, 32, (const double[]){1, 1, 1, 1});
    picture_free(&p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stops),   cmocka_unit_test(test_curves), cmocka_unit_test(test_fails_somewhere),
        cmocka_unit_test(test_hostile), cmocka_unit_test(test_drawn),  cmocka_unit_test(test_several),
        cmocka_unit_test(test_border),
    };
    return FIXTURE_RUN(tests);
}
