/* Expressions as the library uses them: values worked out by hand from the specification, errors with their places. */
#include "style/expression.h"

#include "style/compiler.h"

#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct fixture {
    camber_context *context;
    camber_compiler compiler;
    camber_style style;
    camber_expression *expression;
    char message[4096]; /* the last that was logged */
} fixture;

static void keep_message(void *user, camber_log_level level, const char *message) {
    (void)level;
    fixture *f = user;
    snprintf(f->message, sizeof f->message, "%s", message);
}

static void setup(fixture *f) {
    memset(f, 0, sizeof *f);
    const camber_context_desc desc = {.log = keep_message, .log_user = f, .cache_dir = ""};
    assert_int_equal(camber_context_create(&desc, &f->context), CAMBER_OK);
    f->style.context = f->context;
    f->compiler = (camber_compiler){.context = f->context, .style = &f->style, .name = "test"};
}

static void teardown(fixture *f) {
    camber_expression_destroy(f->context, f->expression);
    for (size_t i = 0; i < f->style.schema.property_count; i++)
        camber_free(f->context, f->style.schema.properties[i]);
    camber_free(f->context, f->style.schema.properties);
    camber_compiler_end(&f->compiler);
    camber_context_destroy(f->context);
}

static json_t *load(const char *text) {
    json_error_t error;
    json_t *json = json_loads(text, JSON_DECODE_ANY, &error);
    if (!json)
        fail_msg("%s: %s", text, error.text);
    return json;
}

static camber_value to_value(const json_t *json) {
    if (json_is_boolean(json))
        return (camber_value){.type = CAMBER_VALUE_BOOL, .boolean = json_is_true(json)};
    if (json_is_number(json))
        return (camber_value){.type = CAMBER_VALUE_NUMBER, .number = json_number_value(json)};
    if (json_is_string(json))
        return (camber_value){.type = CAMBER_VALUE_STRING, .string = json_string_value(json)};
    return (camber_value){.type = CAMBER_VALUE_NULL};
}

static bool evaluate(fixture *f, double zoom, const json_t *properties, camber_evaluation *evaluation,
                     camber_value *value) {
    camber_value values[16];
    assert_true(f->style.schema.property_count <= 16);
    for (size_t i = 0; i < f->style.schema.property_count; i++)
        values[i] = to_value(json_object_get(properties, f->style.schema.properties[i]));
    const camber_feature_view feature = {.values = values, .geometry_type = "LineString"};
    camber_evaluation_begin(evaluation, zoom, &feature);
    return camber_expression_evaluate(f->expression, evaluation, value);
}

static bool equal(const camber_value *value, const json_t *expected) {
    const camber_value other = to_value(expected);
    if (value->type == CAMBER_VALUE_COLOR) {
        /* The specification's tests state colours premultiplied. */
        const double parts[4] = {value->color.r * value->color.a, value->color.g * value->color.a,
                                 value->color.b * value->color.a, (double)value->color.a};
        for (size_t i = 0; i < 4; i++)
            if (fabs(parts[i] - json_number_value(json_array_get(expected, i))) > 1e-5)
                return false;
        return json_array_size(expected) == 4;
    }
    if (value->type != other.type || json_is_array(expected) || json_is_object(expected))
        return false;
    switch (value->type) {
    case CAMBER_VALUE_BOOL: return value->boolean == other.boolean;
    case CAMBER_VALUE_NUMBER: return fabs(value->number - other.number) <= 1e-5 * fabs(other.number);
    case CAMBER_VALUE_STRING: return strcmp(value->string, other.string) == 0;
    default: return true;
    }
}

/* ---- Values ---- */

typedef struct sample {
    const char *expression;
    camber_type type;
    double zoom;
    const char *properties;
    const char *result; /* NULL: evaluation fails */
} sample;

static bool compile(fixture *f, json_t *json, camber_type type) {
    const camber_property property = {.name = "p", .type = type, .interpolated = true, .data_driven = true};
    if (type == CAMBER_TYPE_BOOL)
        return camber_compile_filter(&f->compiler, json, &f->expression);
    return camber_compile_property(&f->compiler, json, &property, &f->expression);
}

static void check(const sample *samples, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const sample *s = &samples[i];
        fixture f;
        camber_evaluation evaluation;
        camber_value value;
        setup(&f);
        json_t *json = load(s->expression), *properties = load(s->properties);
        json_t *expected = s->result ? load(s->result) : NULL;
        if (!compile(&f, json, s->type))
            fail_msg("%s: %s", s->expression, f.message);
        const bool done = evaluate(&f, s->zoom, properties, &evaluation, &value);
        if (done != (expected != NULL))
            fail_msg("%s of %s %s", s->expression, s->properties, done ? "evaluates" : "fails");
        if (done && !equal(&value, expected))
            fail_msg("%s of %s at %g is not %s but %g", s->expression, s->properties, s->zoom, s->result, value.number);
        json_decref(expected);
        json_decref(properties);
        json_decref(json);
        teardown(&f);
    }
}

#define NUMBER CAMBER_TYPE_NUMBER
#define BOOL CAMBER_TYPE_BOOL
#define COLOR CAMBER_TYPE_COLOR
#define STRING CAMBER_TYPE_STRING

static void test_numbers(void **state) {
    (void)state;
    static const sample samples[] = {
        {"3", NUMBER, 0, "{}", "3"},
        {"[\"+\", 1, 2, 3.5]", NUMBER, 0, "{}", "6.5"},
        {"[\"-\", [\"*\", 3, 4], [\"/\", 9, 3]]", NUMBER, 0, "{}", "9"},
        {"[\"get\", \"lanes\"]", NUMBER, 0, "{\"lanes\": 4}", "4"},
        {"[\"get\", \"lanes\"]", NUMBER, 0, "{\"lanes\": \"4\"}", NULL},
        {"[\"to-number\", [\"get\", \"lanes\"]]", NUMBER, 0, "{\"lanes\": \" -4.5e1 \"}", "-45"},
        {"[\"to-number\", [\"get\", \"lanes\"]]", NUMBER, 0, "{\"lanes\": \"4;5\"}", NULL},
        {"[\"to-number\", [\"get\", \"lanes\"], 7]", NUMBER, 0, "{\"lanes\": \"4;5\"}", "7"},
        {"[\"coalesce\", [\"get\", \"a\"], [\"get\", \"b\"], 9]", NUMBER, 0, "{\"b\": 5}", "5"},
        {"[\"coalesce\", [\"get\", \"a\"], [\"get\", \"b\"], 9]", NUMBER, 0, "{}", "9"},
        {"[\"case\", [\"has\", \"a\"], 1, [\"==\", [\"get\", \"b\"], \"x\"], 2, 3]", NUMBER, 0, "{\"b\": \"x\"}", "2"},
        {"[\"match\", [\"get\", \"h\"], [\"b\", \"a\"], 1, \"c\", 2, 3]", NUMBER, 0, "{\"h\": \"a\"}", "1"},
        {"[\"match\", [\"get\", \"h\"], [\"b\", \"a\"], 1, \"c\", 2, 3]", NUMBER, 0, "{\"h\": \"c\"}", "2"},
        {"[\"match\", [\"get\", \"h\"], [\"b\", \"a\"], 1, \"c\", 2, 3]", NUMBER, 0, "{\"h\": 3}", "3"},
        {"[\"match\", [\"get\", \"h\"], [-1, 5], 1, 2, [\"match\", [\"get\", \"i\"], 1, 4, 5], 3]", NUMBER, 0,
         "{\"h\": 2, \"i\": 1}", "4"},
    };
    check(samples, sizeof samples / sizeof *samples);
}

/* f(x) = (base^x - 1) / (base^span - 1): at the middle of 10 to 14 with base 2 that is 3 / 15. */
static void test_curves(void **state) {
    (void)state;
    static const sample samples[] = {
        {"[\"interpolate\", [\"linear\"], [\"zoom\"], 10, 1, 14, 9]", NUMBER, 12, "{}", "5"},
        {"[\"interpolate\", [\"linear\"], [\"zoom\"], 10, 1, 14, 9]", NUMBER, 3, "{}", "1"},
        {"[\"interpolate\", [\"linear\"], [\"zoom\"], 10, 1, 14, 9]", NUMBER, 30, "{}", "9"},
        {"[\"interpolate\", [\"exponential\", 2], [\"zoom\"], 10, 0, 14, 15]", NUMBER, 12, "{}", "3"},
        {"[\"interpolate\", [\"exponential\", 2], [\"zoom\"], 10, 0, 14, [\"get\", \"w\"]]", NUMBER, 12, "{\"w\": 30}",
         "6"},
        {"[\"step\", [\"zoom\"], 1, 10, 2, 12, 3]", NUMBER, 9.99, "{}", "1"},
        {"[\"step\", [\"zoom\"], 1, 10, 2, 12, 3]", NUMBER, 10, "{}", "2"},
        {"[\"step\", [\"zoom\"], 1, 10, 2, 12, 3]", NUMBER, 24, "{}", "3"},
        {"{\"stops\": [[10, 0], [14, 15]], \"base\": 2}", NUMBER, 12, "{}", "3"},
        {"{\"stops\": [[10, 0], [14, 15]], \"base\": 2}", NUMBER, 2, "{}", "0"},
        {"{\"stops\": [[10, 0], [14, 15]], \"type\": \"interval\"}", NUMBER, 13.9, "{}", "0"},
        {"{\"stops\": [[10, 0], [14, 15]], \"type\": \"interval\"}", NUMBER, 14, "{}", "15"},
        /* The last of several stops at one input counts from there on, as in browsers; below it the first. */
        {"{\"stops\": [[0, 10], [1, 20], [1, 25], [2, 30]]}", NUMBER, 1.5, "{}", "27.5"},
        {"{\"stops\": [[0, 10], [1, 20], [1, 25], [2, 30]]}", NUMBER, 0.5, "{}", "15"},
        {"{\"stops\": [[0, 10], [1, 20], [1, 22], [1, 25]]}", NUMBER, 1, "{}", "25"},
        {"{\"stops\": [[1, 20], [1, 22], [1, 25]]}", NUMBER, 1, "{}", "20"},
        {"{\"stops\": [[1, 20], [1, 22], [1, 25]]}", NUMBER, 1.01, "{}", "25"},
        {"{\"stops\": [[0, 2], [12, 2], [12, 12]], \"type\": \"interval\"}", NUMBER, 12, "{}", "12"},
        {"{\"stops\": [[12, 2], [12, 12]], \"type\": \"interval\"}", NUMBER, 12, "{}", "2"},
        {"{\"stops\": [[12, 2], [12, 12]], \"type\": \"interval\"}", NUMBER, 12.01, "{}", "12"},
        {"{\"stops\": [[0, 2], [5, 2], [5, 12]], \"property\": \"a\"}", NUMBER, 0, "{\"a\": 7}", "12"},
        {"{\"stops\": [[\"x\", 2], [\"x\", 3], [\"y\", 4]], \"property\": \"a\", \"type\": \"categorical\"}", NUMBER, 0,
         "{\"a\": \"x\"}", "3"},
        {"{\"stops\": [[true, 2], [true, 3]], \"property\": \"a\", \"type\": \"categorical\"}", NUMBER, 0,
         "{\"a\": true}", "3"},
        {"{\"stops\": [[{\"zoom\": 5, \"value\": 1}, 2], [{\"zoom\": 5, \"value\": 1}, 4], [{\"zoom\": 5, \"value\": "
         "3}, 6]], "
         "\"property\": \"a\"}",
         NUMBER, 5, "{\"a\": 2}", "5"},
        {"{\"stops\": [[10, \"#000\"], [14, \"#fff\"]]}", COLOR, 11, "{}", "[0.25, 0.25, 0.25, 1]"},
        {"[\"interpolate\", [\"exponential\", 1e300], [\"zoom\"], 0, 0, 20, 1]", NUMBER, 10, "{}", "0.5"},
        /* Farther apart than a double reaches, and a denormal apart. */
        {"[\"interpolate\", [\"linear\"], [\"zoom\"], -1.6e308, 0, 1.6e308, 1]", NUMBER, 10, "{}", "0.5"},
        {"[\"interpolate\", [\"linear\"], [\"get\", \"n\"], -1.6e308, \"#000\", 1.6e308, \"#fff\"]", COLOR, 0,
         "{\"n\": 0.8e308}", "[0.75, 0.75, 0.75, 1]"},
        {"[\"interpolate\", [\"linear\"], [\"get\", \"n\"], 0, 0, 1e-323, 1]", NUMBER, 0, "{\"n\": 5e-324}", "0.5"},
    };
    check(samples, sizeof samples / sizeof *samples);
}

static void test_colors(void **state) {
    (void)state;
    static const sample samples[] = {
        {"\"#ff000080\"", COLOR, 0, "{}", "[0.501961, 0, 0, 0.501961]"},
        {"[\"get\", \"c\"]", COLOR, 0, "{\"c\": \"lime\"}", "[0, 1, 0, 1]"},
        {"[\"get\", \"c\"]", COLOR, 0, "{\"c\": \"sour\"}", NULL},
        {"[\"match\", [\"get\", \"c\"], \"a\", \"red\", \"blue\"]", COLOR, 0, "{\"c\": \"a\"}", "[1, 0, 0, 1]"},
        {"[\"coalesce\", [\"get\", \"c\"], \"blue\"]", COLOR, 0, "{}", "[0, 0, 1, 1]"},
    };
    check(samples, sizeof samples / sizeof *samples);
}

static void test_filters(void **state) {
    (void)state;
    static const sample samples[] = {
        {"[\"==\", \"h\", \"a\"]", BOOL, 0, "{\"h\": \"a\"}", "true"},
        {"[\"==\", [\"get\", \"h\"], \"a\"]", BOOL, 0, "{\"h\": \"b\"}", "false"},
        {"[\"!=\", \"h\", \"a\"]", BOOL, 0, "{}", "true"},
        {"[\"<\", \"n\", 5]", BOOL, 0, "{\"n\": 4}", "true"},
        {"[\"<\", \"n\", 5]", BOOL, 0, "{\"n\": \"4\"}", "false"},
        {"[\">=\", \"n\", 5]", BOOL, 0, "{}", "false"},
        {"[\"in\", \"h\", \"a\", \"b\", 3]", BOOL, 0, "{\"h\": 3}", "true"},
        {"[\"in\", \"h\", \"a\", \"b\", 3]", BOOL, 0, "{\"h\": \"3\"}", "false"},
        {"[\"in\", \"h\"]", BOOL, 0, "{\"h\": \"3\"}", "false"},
        {"[\"!in\", \"h\", \"a\", \"b\"]", BOOL, 0, "{\"h\": \"c\"}", "true"},
        {"[\"in\", [\"get\", \"h\"], [\"literal\", [\"a\", \"b\"]]]", BOOL, 0, "{\"h\": \"b\"}", "true"},
        {"[\"!in\", [\"get\", \"h\"], [\"literal\", [\"a\", \"b\"]]]", BOOL, 0, "{\"h\": \"b\"}", "false"},
        {"[\"in\", \"ell\", [\"get\", \"h\"]]", BOOL, 0, "{\"h\": \"hello\"}", "true"},
        {"[\"has\", \"h\"]", BOOL, 0, "{\"h\": false}", "true"},
        {"[\"!has\", \"h\"]", BOOL, 0, "{}", "true"},
        {"[\"==\", \"$type\", \"LineString\"]", BOOL, 0, "{}", "true"},
        {"[\"in\", \"$type\", \"Point\", \"Polygon\"]", BOOL, 0, "{}", "false"},
        {"[\"==\", [\"geometry-type\"], \"LineString\"]", BOOL, 0, "{}", "true"},
        {"[\"all\", [\"==\", \"h\", \"a\"], [\"!=\", \"t\", 1]]", BOOL, 0, "{\"h\": \"a\"}", "true"},
        {"[\"any\", [\"==\", \"h\", \"a\"], [\"has\", \"t\"]]", BOOL, 0, "{\"h\": \"b\"}", "false"},
        {"[\"none\", [\"==\", \"h\", \"a\"], [\"has\", \"t\"]]", BOOL, 0, "{\"h\": \"b\"}", "true"},
        {"[\"all\", [\"==\", \"h\", \"a\"], [\">\", [\"zoom\"], 5]]", BOOL, 6, "{\"h\": \"a\"}", "true"},
        {"[\"all\", [\"==\", \"h\", \"a\"], [\">\", [\"zoom\"], 5]]", BOOL, 4, "{\"h\": \"a\"}", "false"},
        {"[\">\", [\"get\", \"n\"], 5]", BOOL, 0, "{\"n\": \"6\"}", NULL},
        {"[\"!\", [\"has\", \"h\"]]", BOOL, 0, "{\"h\": 1}", "false"},
        {"[]", BOOL, 0, "{}", "true"},
        {"[\"all\"]", BOOL, 0, "{}", "true"},
        {"[\"any\"]", BOOL, 0, "{}", "false"},
        {"[\"none\"]", BOOL, 0, "{}", "true"},
        {"false", BOOL, 0, "{}", "false"},
        {"[\"match\", [\"to-string\", [\"get\", \"bridge\"]], [\"\", \"0\", \"no\"], false, true]", BOOL, 0,
         "{\"bridge\": 0}", "false"},
        {"[\"match\", [\"to-string\", [\"get\", \"bridge\"]], [\"\", \"0\", \"no\"], false, true]", BOOL, 0, "{}",
         "false"},
        {"[\"match\", [\"to-string\", [\"get\", \"bridge\"]], [\"\", \"0\", \"no\"], false, true]", BOOL, 0,
         "{\"bridge\": \"viaduct\"}", "true"},
    };
    check(samples, sizeof samples / sizeof *samples);
}

/* Expressions that do not compile, and where the log says it is. */
static const struct {
    const char *expression;
    camber_type type;
    const char *pointer; /* the message's beginning after the document's name */
} errors[] = {
    {"\"2\"", NUMBER, "expected a number or an expression, found a string"},
    {"null", COLOR, "expected a colour or an expression, found null"},
    {"\"sour\"", COLOR, "cannot be evaluated"},
    {"[\"interpolate\", [\"linear\"], [\"zoom\"], 0, 1, 5, \"x\"]", NUMBER, "/6: expected a number, found a string"},
    {"[\"interpolate\", [\"linear\"], [\"zoom\"], 0, 1, 0, 2]", NUMBER, "/5: the stop 0 is not above"},
    {"[\"interpolate\", [\"linear\"], [\"zoom\"], 0, 1, 5]", NUMBER, "a stop or an output is missing"},
    {"[\"interpolate\", [\"cubic-spline\", 0, 0, 1, 1], [\"zoom\"], 0, 1]", NUMBER, "/1: the interpolation"},
    {"[\"interpolate\", [\"cubic-bezier\", 0, 0, 1, 1.5], [\"zoom\"], 0, 1]", NUMBER, "/1: expected four numbers"},
    {"[\"interpolate\", [\"exponential\", \"2\"], [\"zoom\"], 0, 1]", NUMBER, "/1/1: expected a base"},
    {"[\"step\", [\"zoom\"], 7]", NUMBER, "\"step\" has 2 operands"},
    {"[\"+\", 1, [\"zoom\"]]", NUMBER, "\"zoom\" may only be the input"},
    {"[\"zoom\"]", NUMBER, "\"zoom\" may only be the input"},
    {"[\"interpolate\", [\"linear\"], [\"zoom\"], 0, [\"step\", [\"zoom\"], 1, 2, 3], 9, 1]", NUMBER,
     "\"zoom\" is the input of more than one"},
    {"[\"frobnicate\", 1]", NUMBER, "/0: unknown operator \"frobnicate\""},
    {"[\"-\", 1, [\"*\", 2, [\"nope\"]]]", NUMBER, "/2/2/0: unknown operator \"nope\""},
    {"[[1]]", NUMBER, "/0: expected an expression"},
    {"[]", NUMBER, "expected an expression"},
    {"[\"match\", [\"get\", \"x\"], [\"a\", \"b\", \"a\"], 1, 2]", NUMBER, "/2: the label \"a\" occurs twice"},
    {"[\"match\", [\"get\", \"x\"], [\"a\", 1], 1, 2]", NUMBER, "/2/1: expected a string"},
    {"[\"match\", [\"get\", \"x\"], 1.5, 1, 2]", NUMBER, "/2: a label that is a number"},
    {"[\"match\", [\"get\", \"x\"], 1, 2]", NUMBER, "\"match\" has 3 operands"},
    {"[\"case\", [\"get\", \"x\"], 1]", NUMBER, "\"case\" has 2 operands"},
    {"[\"case\", 3, 1, 2]", NUMBER, "/1: expected a boolean, found a number"},
    {"[\"get\", 3]", NUMBER, "/1: expected a string, found a number"},
    {"[\"to-number\", \"x\"]", NUMBER, "cannot be evaluated"},
    {"[\"literal\", [1]]", NUMBER, "expected a number, found an array<number, 1>"},
    {"[\"+\", 1, {}]", NUMBER, "/2: an object is not an expression"},
    {"{\"stops\": []}", NUMBER, "expected a constant, an expression, or a function"},
    {"{\"stops\": [[1, 2], [0, 3]]}", NUMBER, "/stops/1: the stop 0 is below"},
    {"{\"stops\": [[1, 2], [2, \"x\"]]}", NUMBER, "/stops/1/1: expected a number, found a string"},
    {"{\"stops\": [[1, 2, 3]]}", NUMBER, "/stops/0: expected a stop"},
    {"{\"stops\": [[1, 2]], \"property\": 3}", NUMBER, "property: expected a property's name"},
    {"{\"stops\": [[1, 2]], \"type\": \"categorical\"}", NUMBER, "/type: the function's type is wrong"},
    {"{\"stops\": [[\"x\", 1], [\"y\", 2], [\"x\", 3]], \"property\": \"a\", \"type\": \"categorical\"}", NUMBER,
     "/stops/2: the label \"x\" occurs twice"},
    {"{\"stops\": [[1, 2]], \"base\": \"a\"}", NUMBER, "base: expected a number"},
    {"[\"==\", 3, \"x\"]", BOOL, "/1: expected a property's name"},
    {"[\"==\", \"a\", {}]", BOOL, "/2: expected a string, number, boolean or null"},
    {"[\"==\", [\"get\", \"a\"], [\"zoom\"], 3, 4]", BOOL, "\"==\" has 4 operands"},
    {"[\"==\", [\"get\", \"a\"], \"b\", 3]", BOOL, "/3: expected a collator, found a number"},
    {"[\"==\", [\"zoom\"], \"x\"]", BOOL, "\"==\" compares a number with a string"},
    {"[\"all\", [\"has\", \"x\"], 3]", BOOL, "/2: expected a filter, found a number"},
    {"[\"all\", [\"has\", \"x\"], [\"any\", [\"has\"]]]", BOOL, "/2/1: \"has\" without a property's name"},
    {"{}", BOOL, "expected a filter, found an object"},
    {"\"highway\"", BOOL, "expected a filter, found a string"},
};

static void test_errors(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof errors / sizeof *errors; i++) {
        fixture f;
        char start[256];
        setup(&f);
        json_t *json = load(errors[i].expression);
        if (compile(&f, json, errors[i].type))
            fail_msg("%s compiles", errors[i].expression);
        assert_int_equal(f.compiler.status, CAMBER_ERROR_INPUT);
        snprintf(start, sizeof start, "test: %s", errors[i].pointer);
        if (strncmp(f.message, start, strlen(start)) != 0 || !strchr(f.message, ';'))
            fail_msg("%s: '%s' does not begin with '%s', or names no cure", errors[i].expression, f.message, start);
        json_decref(json);
        teardown(&f);
    }
}

/* Constants are folded to one node, and a property is collected once. */
static void test_folding(void **state) {
    (void)state;
    fixture f;
    setup(&f);
    json_t *json =
        load("[\"*\", 2, [\"case\", [\"in\", 2, [\"literal\", [1, 2]]], [\"to-number\", [\"to-string\", 21]], 0]]");
    assert_true(compile(&f, json, NUMBER));
    assert_int_equal(f.expression->node_count, 1);
    assert_true(fabs(f.expression->nodes[f.expression->root].value.number - 42.0) < 1e-12);
    json_decref(json);
    camber_expression_destroy(f.context, f.expression);
    json = load("[\"any\", [\"has\", \"b\"], [\"==\", \"a\", 1], [\"==\", [\"get\", \"b\"], 1], [\"in\", \"a\", 2]]");
    assert_true(compile(&f, json, BOOL));
    assert_int_equal(f.style.schema.property_count, 2);
    assert_string_equal(f.style.schema.properties[0], "b");
    assert_string_equal(f.style.schema.properties[1], "a");
    json_decref(json);
    teardown(&f);
}

/* Whatever an expression depends on, and what it makes a style ask for. */
static void test_reads(void **state) {
    (void)state;
    static const struct {
        const char *expression;
        bool zoom, feature, line_progress, id, all;
    } samples[] = {
        {"[\"+\", 1, 2]", false, false, false, false, false},
        {"[\"step\", [\"zoom\"], 1, 5, 2]", true, false, false, false, false},
        {"[\"step\", [\"zoom\"], 1, 5, [\"get\", \"w\"]]", true, true, false, false, false},
        {"[\"let\", \"a\", [\"get\", \"w\"], [\"number\", [\"var\", \"a\"]]]", false, true, false, false, false},
        {"[\"line-progress\"]", false, false, true, false, false},
        {"[\"to-number\", [\"id\"]]", false, true, false, true, false},
        {"[\"get\", [\"concat\", \"a\", [\"get\", \"k\"]]]", false, true, false, false, true},
        {"[\"get\", \"x\", [\"properties\"]]", false, true, false, false, true},
        {"[\"get\", [\"concat\", \"a\", \"b\"]]", false, true, false, false, false},
        {"[\"get\", \"x\", [\"literal\", {\"x\": 1}]]", false, false, false, false, false},
    };
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        fixture f;
        setup(&f);
        json_t *json = load(samples[i].expression);
        const camber_property property = {
            .name = "p", .type = NUMBER, .interpolated = true, .data_driven = true, .line_progress = true};
        if (!camber_compile_property(&f.compiler, json, &property, &f.expression))
            fail_msg("%s: %s", samples[i].expression, f.message);
        if (f.expression->reads_zoom != samples[i].zoom || f.expression->reads_feature != samples[i].feature ||
            f.expression->reads_line_progress != samples[i].line_progress || f.style.schema.wants_id != samples[i].id ||
            f.style.schema.wants_all_properties != samples[i].all)
            fail_msg("%s depends on something else", samples[i].expression);
        json_decref(json);
        teardown(&f);
    }
}

/* Properties with ranges, names, lengths, and without zoom or features. */
static void test_properties(void **state) {
    (void)state;
    static const char *const names[] = {"map", "viewport", NULL};
    static const struct {
        camber_property property;
        const char *value, *message; /* NULL: it compiles */
    } samples[] = {
        {{.name = "p", .type = STRING, .values = names}, "\"map\"", NULL},
        {{.name = "p", .type = STRING, .values = names}, "\"top\"", "\"top\" is not a p; use \"map\" or \"viewport\""},
        {{.name = "p", .type = CAMBER_TYPE_ARRAY, .item = NUMBER, .length = 2}, "[1, 2]", NULL},
        {{.name = "p", .type = CAMBER_TYPE_ARRAY, .item = NUMBER, .length = 2},
         "[1, 2, 3]",
         "expected an array<number, 2>, found an array<number, 3>"},
        {{.name = "p", .type = CAMBER_TYPE_ARRAY, .item = NUMBER, .high = 9.0}, "[1, -2]", "-2 is out of range"},
        {{.name = "p", .type = CAMBER_TYPE_ARRAY, .item = NUMBER}, "[\"literal\", []]", NULL},
        {{.name = "p", .type = CAMBER_TYPE_IMAGE}, "[\"image\", \"a\"]", NULL},
        {{.name = "p", .type = CAMBER_TYPE_IMAGE, .data_driven = true}, "[\"concat\", \"a\", [\"get\", \"b\"]]", NULL},
        {{.name = "p", .type = NUMBER}, "[\"get\", \"x\"]", "p cannot depend on features"},
        {{.name = "p", .type = NUMBER, .without_zoom = true},
         "[\"step\", [\"zoom\"], 1, 2, 3]",
         "p cannot depend on zoom"},
        {{.name = "p", .type = NUMBER},
         "[\"interpolate\", [\"linear\"], [\"zoom\"], 1, 2, 3, 4]",
         "p is not interpolated"},
        {{.name = "p", .type = NUMBER}, "[\"line-progress\"]", "p cannot depend on \"line-progress\""},
    };
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        fixture f;
        setup(&f);
        json_t *json = load(samples[i].value);
        const bool done = camber_compile_property(&f.compiler, json, &samples[i].property, &f.expression);
        if (done != !samples[i].message || (!done && !strstr(f.message, samples[i].message)))
            fail_msg("%s: '%s'", samples[i].value, f.message);
        json_decref(json);
        teardown(&f);
    }
}

static void test_polygons(void **state) {
    (void)state;
    static const struct {
        const char *filter;
        bool takes;
    } samples[] = {
        {"[\"==\", \"$type\", \"Polygon\"]", true},
        {"[\"==\", [\"geometry-type\"], \"Polygon\"]", true},
        {"[\"all\", [\"has\", \"a\"], [\"in\", \"$type\", \"LineString\", \"Polygon\"]]", true},
        {"[\"match\", [\"geometry-type\"], [\"Polygon\", \"MultiPolygon\"], true, false]", true},
        {"[\"!=\", \"$type\", \"Polygon\"]", false},
        {"[\"!=\", [\"geometry-type\"], \"LineString\"]", true},
        {"[\"!in\", \"$type\", \"Point\", \"Polygon\"]", false},
        {"[\"in\", [\"geometry-type\"], [\"literal\", [\"LineString\", \"MultiPolygon\"]]]", true},
        {"[\"match\", [\"geometry-type\"], [\"LineString\"], [\"has\", \"a\"], false]", false},
        {"[\"match\", [\"geometry-type\"], \"Polygon\", [\"has\", \"a\"], false]", true},
        {"[\"any\", [\"==\", \"$type\", \"LineString\"], [\"has\", \"a\"]]", true},
        {"[\"all\", [\"any\", [\"==\", \"$type\", \"Point\"], false], [\"has\", \"a\"]]", false},
        {"[\"none\", [\"has\", \"a\"]]", true},
        {"[\"!\", [\"has\", \"a\"]]", true},
        {"false", false},
        {"[\"!\", [\"==\", [\"geometry-type\"], \"Polygon\"]]", false},
        {"[\"none\", [\"==\", \"$type\", \"Polygon\"]]", false},
        {"[\"==\", \"$type\", \"LineString\"]", false},
        {"[\"==\", \"kind\", \"Polygon\"]", true},
        {"true", true},
    };
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        json_t *json = load(samples[i].filter);
        if (camber_filter_may_take(json, "Polygon") != samples[i].takes)
            fail_msg("%s", samples[i].filter);
        json_decref(json);
    }
}

/* Deeper than the limit is an error, not a stack overflow. */
static void test_depth(void **state) {
    (void)state;
    static const char *const forms[][3] = {
        {"[\"-\",", "1", "]"}, {"[\"all\",", "true", "]"}, {"[\"!\",", "true", "]"}, {"[\"coalesce\",", "1", "]"}};
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++) {
        for (int depth = 100; depth <= 1600; depth *= 4) {
            fixture f;
            setup(&f);
            char *text = calloc((size_t)depth, 16);
            assert_non_null(text);
            for (int level = 0; level < depth; level++)
                strcat(text, forms[i][0]);
            strcat(text, forms[i][1]);
            for (int level = 0; level < depth; level++)
                strcat(text, forms[i][2]);
            json_t *json = load(text);
            assert_int_equal(compile(&f, json, i == 1 || i == 2 ? BOOL : NUMBER), depth < CAMBER_EXPRESSION_DEPTH);
            if (depth > CAMBER_EXPRESSION_DEPTH)
                assert_non_null(strstr(f.message, "nested deeper than"));
            json_decref(json);
            free(text);
            teardown(&f);
        }
    }
}

/* ---- Numbers and text ---- */

static void test_number_text(void **state) {
    (void)state;
    /* ECMA-262 Number::toString. */
    static const struct {
        double number;
        const char *text;
    } samples[] = {
        {0.0, "0"},
        {-0.0, "0"},
        {1.0, "1"},
        {-12.5, "-12.5"},
        {0.1, "0.1"},
        {123456789.0, "123456789"},
        {1e21, "1e+21"},
        {1e20, "100000000000000000000"},
        {1.5e-7, "1.5e-7"},
        {0.000001, "0.000001"},
        {1.0 / 3.0, "0.3333333333333333"},
        {5e-324, "5e-324"},
        {1.7976931348623157e308, "1.7976931348623157e+308"},
        {-0.1 - 0.2, "-0.30000000000000004"},
    };
    char text[CAMBER_NUMBER_TEXT_SIZE];
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        camber_number_format(samples[i].number, text);
        assert_string_equal(text, samples[i].text);
    }
    camber_number_format(NAN, text);
    assert_string_equal(text, "NaN");
    camber_number_format(-INFINITY, text);
    assert_string_equal(text, "-Infinity");
    static const char *const wrong[] = {"", "-", ".", "e5", "+.e1", "x", "nan", "inf"};
    double number;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_null(camber_number_parse(wrong[i], &number));
    assert_string_equal(camber_number_parse("-1.25e2px", &number), "px");
    assert_true(fabs(number + 125.0) < 1e-12);
    assert_string_equal(camber_number_parse("5.", &number), "");
    assert_string_equal(camber_number_parse("1em", &number), "em");
    assert_string_equal(camber_number_parse("1e999", &number), "");
    assert_true(isinf(number));
}

/* The digits from the first to the last that is no zero. */
static int count_digits(const char *text) {
    int count = 0, zeros = 0;
    for (const char *c = text; *c && *c != 'e'; c++) {
        if (*c == '0')
            zeros += count > 0;
        if (*c >= '1' && *c <= '9') {
            count += zeros + 1;
            zeros = 0;
        }
    }
    return count;
}

/* Random doubles of every exponent read back as they were, and from one digit less as another. */
static void test_number_text_shortest(void **state) {
    (void)state;
    uint64_t bits = 1;
    for (int i = 0; i < 20000; i++) {
        double number, back, shorter;
        char text[CAMBER_NUMBER_TEXT_SIZE], less[64];
        bits = bits * 6364136223846793005u + 1442695040888963407u;
        memcpy(&number, &bits, sizeof number);
        if (i % 4 == 0)
            number = (double)(int64_t)(bits >> 44) / (i % 8 ? 1000 : 64);
        if (i % 4 == 1)
            number *= 0x1p-1022; /* half of them lose precision or vanish */
        if (!isfinite(number))
            continue;
        camber_number_format(number, text);
        assert_non_null(camber_number_parse(text, &back));
        if (memcmp(&back, &number, sizeof number) != 0 && (number < 0 || number > 0))
            fail_msg("%a is written as %s", number, text);
        const int digits = count_digits(text);
        if (digits < 2)
            continue;
        snprintf(less, sizeof less, "%.*e", digits - 2, number);
        assert_non_null(camber_number_parse(less, &shorter));
        if (memcmp(&shorter, &number, sizeof number) == 0)
            fail_msg("%a is written as %s, where %s would do", number, text, less);
    }
}

static void test_locale(void **state) {
    (void)state;
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE"};
    size_t i = 0;
    while (i < 4 && !setlocale(LC_NUMERIC, names[i]))
        i++;
    if (i == 4) {
        print_message("no locale with a decimal comma is installed\n");
        skip();
    }
    double number;
    char text[CAMBER_NUMBER_TEXT_SIZE];
    assert_non_null(camber_number_parse("2.5", &number));
    camber_number_format(2.5, text);
    setlocale(LC_NUMERIC, "C");
    assert_true(fabs(number - 2.5) < 1e-12);
    assert_string_equal(text, "2.5");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers), cmocka_unit_test(test_curves),      cmocka_unit_test(test_colors),
        cmocka_unit_test(test_filters), cmocka_unit_test(test_errors),      cmocka_unit_test(test_folding),
        cmocka_unit_test(test_reads),   cmocka_unit_test(test_properties),  cmocka_unit_test(test_polygons),
        cmocka_unit_test(test_depth),   cmocka_unit_test(test_number_text), cmocka_unit_test(test_number_text_shortest),
        cmocka_unit_test(test_locale),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
