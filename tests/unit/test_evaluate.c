/* The language of expressions through camber_style_evaluate: own cases with values worked out by hand, hostile ones,
 * and the specification's tests where $CAMBER_DATA has them. */
#include "camber_map.h"

#include <dirent.h>
#include <jansson.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

typedef struct bytes {
    char *text;
    size_t size;
} bytes;

static bool keep_bytes(void *user, const void *block, size_t size_bytes) {
    bytes *kept = user;
    char *grown = realloc(kept->text, kept->size + size_bytes + 1);
    assert_non_null(grown);
    memcpy(grown + kept->size, block, size_bytes);
    kept->text = grown;
    kept->size += size_bytes;
    grown[kept->size] = 0;
    return true;
}

/* The library's answer, parsed; NULL where it returns another status than CAMBER_OK. */
static json_t *ask(const char *text, camber_status *status) {
    const camber_context_desc desc = {.cache_dir = ""};
    camber_context *context;
    bytes kept = {0};
    assert_int_equal(camber_context_create(&desc, &context), CAMBER_OK);
    *status =
        camber_style_evaluate(context, text, strlen(text), "test", (camber_sink){.write = keep_bytes, .user = &kept});
    json_t *answer = kept.text ? json_loads(kept.text, 0, NULL) : NULL;
    free(kept.text);
    camber_context_destroy(context);
    return answer;
}

static bool is_close(double a, double b) {
    return fabs(a - b) <= 1e-5 * fmax(fabs(a), fabs(b)) || fabs(a - b) < 1e-9;
}

static bool equal(const json_t *a, const json_t *b) {
    if (json_is_number(a) && json_is_number(b))
        return is_close(json_number_value(a), json_number_value(b));
    if (json_object_get(b, "error"))
        return json_object_get(a, "error") != NULL;
    if (json_is_array(a) && json_array_size(a) == json_array_size(b)) {
        for (size_t i = 0; i < json_array_size(a); i++)
            if (!equal(json_array_get(a, i), json_array_get(b, i)))
                return false;
        return json_is_array(b);
    }
    if (json_is_object(a) && json_object_size(a) == json_object_size(b)) {
        const char *key;
        json_t *value;
        json_object_foreach((json_t *)(uintptr_t)a, key, value) {
            if (!json_object_get(b, key) || !equal(value, json_object_get(b, key)))
                return false;
        }
        return json_is_object(b);
    }
    return json_equal(a, b);
}

/* ---- Own cases ---- */

/* Member after member of the document; feature and output are JSON. output: NULL where it does not compile. */
typedef struct sample {
    const char *expression, *specification, *globals, *feature;
    const char *type, *output;
} sample;

#define ERROR "{\"error\": \"\"}"
#define NUMBER_SPEC "{\"type\": \"number\"}"
#define COLOR_SPEC "{\"type\": \"color\"}"
#define STRING_SPEC "{\"type\": \"string\", \"expression\": {\"interpolated\": false, \"parameters\": [\"zoom\"]}}"
#define PAIR_SPEC "{\"type\": \"array\", \"value\": \"number\", \"length\": 2}"

static void check_sample(const sample *s) {
    char text[2048];
    camber_status status;
    snprintf(text, sizeof text, "{\"expression\": %s, \"propertySpec\": %s, \"inputs\": [[%s, %s]]}", s->expression,
             s->specification ? s->specification : "{}", s->globals ? s->globals : "{}",
             s->feature ? s->feature : "{}");
    json_t *answer = ask(text, &status);
    if (!answer)
        fail_msg("%s: %s", text, camber_status_get_name(status));
    const json_t *compiled = json_object_get(answer, "compiled");
    const char *result = json_string_value(json_object_get(compiled, "result"));
    if (strcmp(result, s->output ? "success" : "error") != 0) {
        const json_t *error = json_array_get(json_object_get(compiled, "errors"), 0);
        fail_msg("%s: %s: %s", text, result,
                 error ? json_string_value(json_object_get(error, "error")) : "should not compile");
    }
    if (s->output) {
        json_t *expected = json_loads(s->output, JSON_DECODE_ANY, NULL);
        char *output = json_dumps(json_array_get(json_object_get(answer, "outputs"), 0), JSON_ENCODE_ANY);
        assert_non_null(expected);
        if (!equal(json_array_get(json_object_get(answer, "outputs"), 0), expected))
            fail_msg("%s: is %s, not %s", text, output, s->output);
        if (s->type && strcmp(s->type, json_string_value(json_object_get(compiled, "type"))) != 0)
            fail_msg("%s: its type is %s, not %s", text, json_string_value(json_object_get(compiled, "type")), s->type);
        json_decref(expected);
        free(output);
    }
    json_decref(answer);
}

static void check(const sample *samples, size_t count) {
    for (size_t i = 0; i < count; i++)
        check_sample(&samples[i]);
}

#define CHECK(samples) check(samples, sizeof samples / sizeof *samples)

static void test_types(void **state) {
    (void)state;
    static const sample samples[] = {
        {"[\"literal\", [1, \"a\", null]]", .type = "array<value, 3>", .output = "[1, \"a\", null]"},
        {"[\"literal\", [[1, 2]]]", .type = "array<array<number, 2>, 1>", .output = "[[1, 2]]"},
        {"[\"literal\", {\"b\": {\"a\": [1]}}]", .type = "object", .output = "{\"b\": {\"a\": [1]}}"},
        {"[\"literal\", null]", .type = "null", .output = "null"},
        {"[\"array\", \"number\", 2, [\"get\", \"a\"]]", NULL, NULL, "{\"properties\": {\"a\": [1, 2]}}",
         "array<number, 2>", "[1, 2]"},
        {"[\"array\", \"number\", 2, [\"get\", \"a\"]]", NULL, NULL, "{\"properties\": {\"a\": [1, 2, 3]}}", NULL,
         ERROR},
        {"[\"array\", \"number\", [\"get\", \"a\"], [\"literal\", [7]]]", .output = NULL},
        {"[\"array\", \"number\", null, [\"get\", \"a\"], [\"literal\", [7]]]", .output = "[7]"},
        {"[\"number\", [\"get\", \"a\"], [\"get\", \"b\"]]", NULL, NULL, "{\"properties\": {\"a\": \"x\", \"b\": 2}}",
         "number", "2"},
        {"[\"string\", [\"get\", \"a\"], [\"get\", \"b\"]]", NULL, NULL, "{\"properties\": {\"a\": true, \"b\": 2}}",
         "string", ERROR},
        {"[\"object\", [\"get\", \"a\"], [\"literal\", {\"z\": 1}]]", .type = "object", .output = "{\"z\": 1}"},
        {"[\"typeof\", [\"get\", \"a\"]]", NULL, NULL, "{\"properties\": {\"a\": [[1], [2]]}}", "string",
         "\"array<value, 2>\""},
        {"[\"typeof\", [\"literal\", {}]]", .output = "\"object\""},
        {"[\"typeof\", [\"to-color\", \"red\"]]", .output = "\"color\""},
        {"[\"to-string\", [\"get\", \"a\"]]", NULL, NULL,
         "{\"properties\": {\"a\": {\"z\": [1, \"q\\\"\\n\"], \"b\": null}}}", "string",
         "\"{\\\"z\\\":[1,\\\"q\\\\\\\"\\\\n\\\"],\\\"b\\\":null}\""},
        {"[\"to-string\", null]", .output = "\"\""},
        {"[\"to-number\", \" 0x1F \"]", .output = "31"},
        {"[\"to-number\", \"12px\", true]", .output = "1"},
        {"[\"to-number\", null, 5]", .output = "0"},
        {"[\"to-boolean\", [\"literal\", []]]", .output = "true"},
        {"[\"to-boolean\", \"\"]", .output = "false"},
        {"[\"to-rgba\", [\"to-color\", \"hsla(120, 100%, 50%, 0.25)\"]]", .type = "array<number, 4>",
         .output = "[0, 255, 0, 0.25]"},
        {"[\"rgba\", 255, 0, 51, 0.5]", .type = "color", .output = "[0.5, 0, 0.1, 0.5]"},
        {"[\"rgb\", 256, 0, 0]", .output = NULL},
        {"[\"rgb\", [\"get\", \"r\"], 0, 0]", NULL, NULL, "{\"properties\": {\"r\": 256}}", "color", ERROR},
        {"[\"to-color\", [\"literal\", [0, 255, 0]]]", .output = "[0, 1, 0, 1]"},
        {"[\"to-color\", [\"get\", \"a\"], \"blue\"]", NULL, NULL, "{\"properties\": {\"a\": \"sour\"}}", "color",
         "[0, 0, 1, 1]"},
    };
    CHECK(samples);
}

static void test_features(void **state) {
    (void)state;
    static const sample samples[] = {
        {"[\"get\", [\"concat\", \"na\", \"me\"]]", NULL, NULL, "{\"properties\": {\"name\": \"x\"}}", "value",
         "\"x\""},
        {"[\"get\", [\"get\", \"key\"]]", NULL, NULL, "{\"properties\": {\"key\": \"w\", \"w\": 3}}", "value", "3"},
        {"[\"has\", [\"get\", \"key\"]]", NULL, NULL, "{\"properties\": {\"key\": \"w\"}}", "boolean", "false"},
        {"[\"has\", \"n\"]", NULL, NULL, "{\"properties\": {\"n\": null}}", "boolean", "true"},
        {"[\"has\", \"n\"]", NULL, NULL, "{\"properties\": {}}", "boolean", "false"},
        {"[\"get\", \"b\", [\"get\", \"a\"]]", NULL, NULL, "{\"properties\": {\"a\": {\"b\": [1]}}}", "value", "[1]"},
        {"[\"get\", \"b\", [\"get\", \"a\"]]", NULL, NULL, "{\"properties\": {\"a\": 3}}", "value", ERROR},
        {"[\"has\", \"c\", [\"properties\"]]", NULL, NULL, "{\"properties\": {\"c\": 0}}", "boolean", "true"},
        {"[\"concat\", [\"id\"], \"-\", [\"geometry-type\"]]", NULL, NULL,
         "{\"id\": 7, \"geometry\": {\"type\": \"LineString\", \"coordinates\": []}}", "string", "\"7-LineString\""},
        {"[\"line-progress\"]", NULL, "{\"lineProgress\": 0.25}", NULL, "number", "0.25"},
        {"[\"at\", 1, [\"array\", \"string\", [\"get\", \"a\"]]]", NULL, NULL,
         "{\"properties\": {\"a\": [\"x\", \"y\"]}}", "string", "\"y\""},
        {"[\"at\", 2, [\"literal\", [1, 2]]]", .output = NULL},
    };
    CHECK(samples);
}

static void test_strings(void **state) {
    (void)state;
    static const sample samples[] = {
        {"[\"concat\", 1, \" \", true, null, [\"literal\", [1, 2]]]", .output = "\"1 true[1,2]\""},
        {"[\"split\", \"a--b\", \"-\"]", .type = "array<string>", .output = "[\"a\", \"\", \"b\"]"},
        {"[\"split\", \"\", \"\"]", .output = "[]"},
        {"[\"split\", \"\", \",\"]", .output = "[\"\"]"},
        {"[\"split\", \"h\xc3\xa9\xe2\x82\xac\", \"\"]", .output = "[\"h\", \"\xc3\xa9\", \"\xe2\x82\xac\"]"},
        {"[\"join\", [\"split\", \"a b c\", \" \"], \"\"]", .output = "\"abc\""},
        {"[\"join\", [\"literal\", [1]], \"\"]", .output = NULL},
        {"[\"upcase\", \"stra\xc3\x9f\x65 \xd0\xb6 \xce\xac\"]", .output = "\"STRASSE \xd0\x96 \xce\x86\""},
        {"[\"downcase\", \"\xc3\x80\xc5\x81\xce\xa9\xd0\x81\"]", .output = "\"\xc3\xa0\xc5\x82\xcf\x89\xd1\x91\""},
        {"[\"length\", \"a\xf0\x9f\x9b\xa3\xc3\xa9\"]", .output = "3"},
        {"[\"length\", [\"literal\", {}]]", .output = NULL},
        {"[\"slice\", \"a\xf0\x9f\x9b\xa3\xc3\xa9z\", -3, -1]", .output = "\"\xf0\x9f\x9b\xa3\xc3\xa9\""},
        {"[\"slice\", [\"literal\", [1, 2, 3]], 5]", .output = "[]"},
        {"[\"slice\", [\"literal\", [1, 2, 3]], 0, -2]", .output = "[1]"},
        {"[\"slice\", true, 1]", .output = NULL},
        {"[\"index-of\", \"b\", \"\xf0\x9f\x9b\xa3\x62\xf0\x9f\x9b\xa3\x62\", 3]", .output = "3"},
        {"[\"index-of\", 2, [\"literal\", [2, 1, 2]], -1]", .output = "2"},
        {"[\"index-of\", \"x\", \"abc\"]", .output = "-1"},
        {"[\"in\", 12, \"a12b\"]", .output = "true"},
        {"[\"in\", null, [\"literal\", [1, null]]]", .output = "true"},
        {"[\"in\", [\"get\", \"a\"], [\"literal\", [1, 2, 3, 4, 5, 6, 7, 8, 9]]]", NULL, NULL,
         "{\"properties\": {\"a\": 8}}", "boolean", "true"},
        {"[\"in\", [\"get\", \"a\"], [\"literal\", [1, 2, 3, 4, 5, 6, 7, 8, 9]]]", NULL, NULL,
         "{\"properties\": {\"a\": \"8\"}}", "boolean", "false"},
        {"[\"in\", [\"get\", \"a\"], [\"get\", \"none\"]]", .output = "false"},
        {"[\"<\", \"Z\", \"a\", [\"collator\", {\"case-sensitive\": false}]]", .output = "false"},
        {"[\"==\", \"\xc3\xa9t\xc3\xa9\", \"ETE\", [\"collator\", {}]]", .output = "true"},
        {"[\"==\", \"\xc3\xa9t\xc3\xa9\", \"ETE\", [\"collator\", {\"diacritic-sensitive\": true}]]",
         .output = "false"},
    };
    CHECK(samples);
}

static void test_maths(void **state) {
    (void)state;
    static const sample samples[] = {
        {"[\"%\", -7, 3]", .output = "-1"},
        {"[\"^\", 2, 0.5]", .output = "1.41421356"},
        {"[\"min\", 3, -2, 8]", .output = "-2"},
        {"[\"max\", 3, -2, 8]", .output = "8"},
        {"[\"round\", -2.5]", .output = "-3"},
        {"[\"ceil\", -2.5]", .output = "-2"},
        {"[\"floor\", -2.5]", .output = "-3"},
        {"[\"abs\", -2.5]", .output = "2.5"},
        {"[\"log2\", 8]", .output = "3"},
        {"[\"log10\", 0.01]", .output = "-2"},
        {"[\"ln\", [\"e\"]]", .output = "1"},
        {"[\"sin\", [\"/\", [\"pi\"], 6]]", .output = "0.5"},
        {"[\"acos\", -1]", .output = "3.14159265"},
        {"[\"asin\", 1]", .output = "1.57079633"},
        {"[\"+\"]", .output = "0"},
        {"[\"*\"]", .output = "1"},
        {"[\"/\", 1, 0]", .output = "null"},
        {"[\"-\"]", .output = NULL},
        {"[\"sqrt\", \"4\"]", .output = NULL},
        {"[\"sqrt\", [\"-\", 4]]", .output = "null"},
    };
    CHECK(samples);
}

static void test_decisions(void **state) {
    (void)state;
    static const sample samples[] = {
        {"[\"let\", \"a\", 1, \"b\", [\"get\", \"x\"], [\"let\", \"a\", [\"+\", [\"var\", \"a\"], 1], [\"*\", "
         "[\"var\", "
         "\"a\"], [\"number\", [\"var\", \"b\"]]]]]",
         NULL, NULL, "{\"properties\": {\"x\": 5}}", "number", "10"},
        {"[\"let\", \"a\", 1, \"b\", [\"var\", \"a\"], [\"var\", \"b\"]]", .output = NULL},
        {"[\"let\", \"a\", [\"var\", \"a\"], [\"var\", \"a\"]]", .output = NULL},
        {"[\"let\", \"a-b\", 1, [\"var\", \"a-b\"]]", .output = NULL},
        {"[\"let\", \"a\", 1]", .output = NULL},
        {"[\"match\", [\"get\", \"x\"], [\"a\", \"b\"], [\"literal\", [1, 2]], [\"literal\", [3]]]", PAIR_SPEC,
         .output = NULL},
        {"[\"match\", [\"get\", \"x\"], \"a\", \"p\", [\"b\", \"c\"], \"q\", \"r\"]", NULL, NULL,
         "{\"properties\": {\"x\": \"c\"}}", "string", "\"q\""},
        {"[\"case\", [\"boolean\", [\"get\", \"x\"], false], 1, 2]", .output = "2"},
        {"[\"coalesce\", [\"get\", \"x\"], [\"error\", \"no x\"]]", NULL, NULL, "{\"properties\": {\"x\": 0}}", "value",
         "0"},
        {"[\"coalesce\", [\"get\", \"x\"], [\"error\", \"no x\"]]", .output = ERROR},
        {"[\"any\", true, [\"error\", \"never\"]]", .output = "true"},
        {"[\"==\", [\"get\", \"a\"], [\"get\", \"b\"]]", NULL, NULL, "{\"properties\": {\"a\": 1, \"b\": \"1\"}}",
         "boolean", "false"},
        {"[\"<\", [\"get\", \"a\"], [\"get\", \"b\"]]", NULL, NULL, "{\"properties\": {\"a\": 1, \"b\": \"1\"}}",
         "boolean", ERROR},
        {"[\"!=\", [\"literal\", [1]], 1]", .output = NULL},
        {"[\"within\", {}]", .output = NULL},
    };
    CHECK(samples);
}

static void test_curves(void **state) {
    (void)state;
    static const sample samples[] = {
        /* A cubic Bézier curve that is symmetric passes its middle. */
        {"[\"interpolate\", [\"cubic-bezier\", 0.42, 0, 0.58, 1], [\"zoom\"], 0, 0, 10, 8]", NULL, "{\"zoom\": 5}",
         NULL, "number", "4"},
        /* x = 3 s - 6 s^2 + 4 s^3 and y = s^3 at s = 0.25 for the controls (1, 0), (0, 0): x = 0.4375. */
        {"[\"interpolate\", [\"cubic-bezier\", 1, 0, 0, 0], [\"zoom\"], 0, 0, 1, 64]", NULL, "{\"zoom\": 0.4375}", NULL,
         "number", "1"},
        {"[\"interpolate\", [\"linear\"], [\"zoom\"], 0, [\"literal\", [0, 4]], 10, [\"literal\", [10, 8]]]", PAIR_SPEC,
         "{\"zoom\": 2.5}", NULL, "array<number, 2>", "[2.5, 5]"},
        {"[\"interpolate\", [\"linear\"], [\"zoom\"], 0, \"red\", 10, \"blue\"]", COLOR_SPEC, "{\"zoom\": 5}", NULL,
         "color", "[0.5, 0, 0.5, 1]"},
        /* CIELAB at D50: the middle of black and white is L* = 50, which is 0.46633 in sRGB. */
        {"[\"interpolate-lab\", [\"linear\"], [\"zoom\"], 0, \"black\", 10, \"white\"]", NULL, "{\"zoom\": 5}", NULL,
         "color", "[0.46633, 0.46633, 0.46633, 1]"},
        {"[\"interpolate-hcl\", [\"linear\"], [\"zoom\"], 0, \"grey\", 10, \"grey\"]", NULL, "{\"zoom\": 5}", NULL,
         "color", "[0.501961, 0.501961, 0.501961, 1]"},
        {"[\"interpolate\", [\"linear\"], [\"zoom\"], 0, \"a\", 10, \"b\"]", .output = NULL},
        {"[\"interpolate\", [\"linear\"], [\"zoom\"], 0, 1, 10, 2]", STRING_SPEC, .output = NULL},
        {"[\"step\", [\"get\", \"x\"], \"a\", 2, \"b\"]", NULL, NULL, "{\"properties\": {\"x\": 2}}", "string",
         "\"b\""},
        {"[\"step\", [\"get\", \"x\"], \"a\", 2, \"b\"]", .output = ERROR},
        {"[\"let\", \"z\", 3, [\"interpolate\", [\"linear\"], [\"zoom\"], 0, 0, 10, [\"var\", \"z\"]]]", NUMBER_SPEC,
         "{\"zoom\": 5}", NULL, "number", "1.5"},
        {"[\"let\", \"z\", [\"zoom\"], [\"step\", [\"var\", \"z\"], 0, 10, 1]]", .output = NULL},
        {"[\"coalesce\", [\"step\", [\"zoom\"], 0, 10, 1], [\"step\", [\"zoom\"], 0, 5, 1]]", .output = NULL},
        {"[\"zoom\"]", "{\"type\": \"number\", \"expression\": {\"interpolated\": true, \"parameters\": []}}",
         .output = NULL},
    };
    CHECK(samples);
}

static void test_functions(void **state) {
    (void)state;
    static const sample samples[] = {
        {"{\"property\": \"w\", \"stops\": [[0, 0], [10, 15]], \"base\": 2}", NUMBER_SPEC, NULL,
         "{\"properties\": {\"w\": 5}}", "number", "0.4545454"},
        {"{\"property\": \"w\", \"stops\": [[0, 0], [10, 15]], \"default\": 7}", NUMBER_SPEC, NULL,
         "{\"properties\": {\"w\": \"5\"}}", "number", "7"},
        {"{\"property\": \"w\", \"stops\": [[0, 0], [10, 15]]}", NUMBER_SPEC, .output = ERROR},
        {"{\"property\": \"w\", \"type\": \"interval\", \"stops\": [[0, \"a\"], [10, \"b\"]]}", STRING_SPEC, NULL,
         "{\"properties\": {\"w\": 10}}", "string", "\"b\""},
        {"{\"property\": \"w\", \"type\": \"categorical\", \"stops\": [[\"x\", 1], [\"y\", 2]], \"default\": 3}",
         NUMBER_SPEC, NULL, "{\"properties\": {\"w\": \"y\"}}", "number", "2"},
        {"{\"property\": \"w\", \"type\": \"categorical\", \"stops\": [[\"x\", 1], [2, 2]], \"default\": 3}",
         NUMBER_SPEC, .output = NULL},
        {"{\"property\": \"w\", \"type\": \"categorical\", \"stops\": [[true, 1], [false, 2]], \"default\": 3}",
         NUMBER_SPEC, .output = "3"},
        {"{\"property\": \"w\", \"type\": \"categorical\", \"stops\": [[\"x\", 1]]}",
         "{\"type\": \"number\", \"default\": 9}", .output = "9"},
        {"{\"property\": \"w\", \"type\": \"identity\", \"default\": \"red\"}", COLOR_SPEC, NULL,
         "{\"properties\": {\"w\": \"#00f\"}}", "color", "[0, 0, 1, 1]"},
        {"{\"property\": \"w\", \"type\": \"identity\"}", NUMBER_SPEC, NULL, "{\"properties\": {\"w\": \"1\"}}",
         "number", ERROR},
        {"{\"property\": \"w\", \"stops\": [[{\"zoom\": 10, \"value\": 0}, 0], [{\"zoom\": 10, \"value\": 4}, 8], "
         "[{\"zoom\": 20, \"value\": 0}, 100]]}",
         NUMBER_SPEC, "{\"zoom\": 15}", "{\"properties\": {\"w\": 2}}", "number", "52"},
        /* The specification's tests keep the first of two stops at one input, which browsers do not. */
        {"{\"stops\": [[0, 10], [1, 20], [1, 25], [2, 30]]}", NUMBER_SPEC, "{\"zoom\": 1}", NULL, "number", "20"},
        {"{\"stops\": [[0, \"a {x} b {y}\"], [10, \"{x}\"]]}",
         "{\"type\": \"string\", \"tokens\": true, \"expression\": {\"interpolated\": false, \"parameters\": "
         "[\"zoom\"]}}",
         "{\"zoom\": 5}", "{\"properties\": {\"x\": 1, \"y\": \"q\"}}", "string", "\"a 1 b q\""},
        {"{\"stops\": [[0, [0, 0]], [10, [4, 8]]]}", PAIR_SPEC, "{\"zoom\": 5}", NULL, "array<number, 2>", "[2, 4]"},
        {"{\"stops\": [[0, [0, 0]], [10, [4, 8, 1]]]}", PAIR_SPEC, .output = NULL},
        {"{\"stops\": [[0, \"black\"], [10, \"white\"]], \"colorSpace\": \"hcl\"}", COLOR_SPEC, "{\"zoom\": 5}", NULL,
         "color", "[0.46633, 0.46633, 0.46633, 1]"},
        {"{\"stops\": [[0, \"black\"], [10, \"white\"]], \"colorSpace\": \"cmyk\"}", COLOR_SPEC, .output = NULL},
    };
    CHECK(samples);
}

#define FORMATTED_SPEC "{\"type\": \"formatted\"}"
#define IMAGE_SPEC "{\"type\": \"resolvedImage\"}"
#define SECTION(text, image, scale, fonts, color, align)                                                               \
    "{\"text\": " text ", \"image\": " image ", \"scale\": " scale ", \"fontStack\": " fonts ", \"textColor\": " color \
    ", \"verticalAlign\": " align "}"
#define TEXT(text) SECTION(text, "null", "null", "null", "null", "null")
#define SECTIONS(list) "{\"sections\": [" list "]}"
#define THERE "{\"name\": \"a\", \"available\": true}"
#define NOT_THERE "{\"name\": \"b\", \"available\": false}"

static void test_formats(void **state) {
    (void)state;
    static const char *const images = "{\"availableImages\": [\"a\"]}";
    const sample samples[] = {
        {"[\"format\", \"a\", {}, \"b\", {\"font-scale\": 2, \"vertical-align\": \"top\"}, \"c\", {\"text-font\": "
         "[\"literal\", [\"x\", \"y\"]], \"text-color\": \"#0f0\"}]",
         .type = "formatted",
         .output = SECTIONS(TEXT("\"a\"") ", " SECTION("\"b\"", "null", "2", "null", "null", "\"top\"") ", " SECTION(
             "\"c\"", "null", "null", "\"x,y\"", "{\"r\": 0, \"g\": 1, \"b\": 0, \"a\": 1}", "null"))},
        {"[\"format\", [\"get\", \"x\"], \"\\n\", [\"get\", \"y\"]]", NULL, NULL, "{\"properties\": {\"y\": [1]}}",
         "formatted", SECTIONS(TEXT("\"\"") ", " TEXT("\"\\n\"") ", " TEXT("\"[1]\""))},
        {"[\"format\", [\"image\", \"a\"], [\"image\", \"b\"], {\"vertical-align\": \"center\"}]", NULL, images, NULL,
         NULL,
         SECTIONS(SECTION("\"\"", THERE, "null", "null", "null", "null") ", " SECTION("\"\"", NOT_THERE, "null", "null",
                                                                                      "null", "\"center\""))},
        {"[\"format\", [\"coalesce\", [\"image\", \"b\"], [\"get\", \"x\"]]]", NULL, images,
         "{\"properties\": {\"x\": \"t\"}}", NULL, SECTIONS(TEXT("\"t\""))},
        {"[\"to-string\", [\"format\", \"a\", {}, [\"image\", \"b\"], \"c\"]]", .type = "string", .output = "\"ac\""},
        {"[\"concat\", [\"format\", \"a\"], 1]", .type = "string", .output = "\"a1\""},
        {"[\"to-boolean\", [\"format\", \"\"]]", .output = "true"},
        {"[\"typeof\", [\"format\", \"\"]]", .output = "\"formatted\""},
        {"[\"typeof\", [\"image\", \"a\"]]", .output = "\"resolvedImage\""},
        {"[\"to-string\", [\"image\", \"a\"]]", .output = "\"a\""},
        {"[\"get\", \"x\"]", FORMATTED_SPEC, NULL, "{\"properties\": {\"x\": 7}}", "formatted",
         SECTIONS(TEXT("\"7\""))},
        {"[\"case\", [\"has\", \"x\"], [\"format\", \"a\"], \"b\"]", FORMATTED_SPEC, .type = "formatted",
         .output = SECTIONS(TEXT("\"b\""))},
        {"[\"coalesce\", [\"image\", \"b\"], [\"image\", \"a\"]]", IMAGE_SPEC, images, NULL, "resolvedImage", THERE},
        {"[\"image\", [\"get\", \"x\"]]", NULL, images, "{\"properties\": {\"x\": \"b\"}}", "resolvedImage", NOT_THERE},
        {"[\"is-supported-script\", [\"get\", \"x\"]]", NULL, NULL, "{\"properties\": {\"x\": \"a\"}}", "boolean",
         "true"},
        {"[\"is-supported-script\", [\"get\", \"x\"]]", NULL, NULL, "{\"properties\": {\"x\": 1}}", NULL, ERROR},
        {"[\"format\", \"a\", {\"vertical-align\": \"left\"}]", .output = NULL},
        {"[\"format\", \"a\", {\"text-font\": [\"x\", \"y\"]}]", .output = NULL},
        {"[\"format\", \"a\", {\"font-scale\": \"2\"}]", .output = NULL},
        {"[\"format\", {}, \"a\"]", .output = NULL},
        {"[\"format\", \"a\", {}, {}]", .output = NULL},
        {"[\"format\", 7]", .output = NULL},
        {"[\"image\", 7]", .output = NULL},
        {"[\"number\", [\"get\", \"x\"]]", FORMATTED_SPEC, .output = NULL},
        {"[\"number\", [\"get\", \"x\"]]", IMAGE_SPEC, .output = NULL},
        {"[\"==\", [\"format\", \"a\"], \"a\"]", .output = NULL},
    };
    CHECK(samples);
}

static void test_paddings(void **state) {
    (void)state;
    static const sample samples[] = {
        {"[\"get\", \"x\"]", "{\"type\": \"padding\"}", NULL, "{\"properties\": {\"x\": [1, 2, 3]}}", "padding",
         "{\"values\": [1, 2, 3, 2]}"},
        {"[\"get\", \"x\"]", "{\"type\": \"padding\"}", NULL, "{\"properties\": {\"x\": []}}", NULL, ERROR},
        {"[\"interpolate\", [\"linear\"], [\"zoom\"], 0, 2, 10, [\"literal\", [4, 8]]]", "{\"type\": \"padding\"}",
         "{\"zoom\": 5}", NULL, "padding", "{\"values\": [3, 5, 3, 5]}"},
        {"[\"get\", \"x\"]", "{\"type\": \"variableAnchorOffsetCollection\"}", NULL,
         "{\"properties\": {\"x\": [\"top\", [1, 2]]}}", NULL, "{\"values\": [\"top\", [1, 2]]}"},
        {"[\"get\", \"x\"]", "{\"type\": \"variableAnchorOffsetCollection\"}", NULL,
         "{\"properties\": {\"x\": [\"up\", [1, 2]]}}", NULL, ERROR},
        {"[\"interpolate\", [\"linear\"], [\"zoom\"], 0, [\"literal\", [\"top\", [0, 0]]], 10, [\"literal\", "
         "[\"left\", "
         "[2, 0]]]]",
         "{\"type\": \"variableAnchorOffsetCollection\"}", "{\"zoom\": 5}", NULL, NULL, ERROR},
    };
    CHECK(samples);
}

static void test_number_formats(void **state) {
    (void)state;
#define FORMAT(number, options) "[\"number-format\", " number ", " options "]"
    static const sample samples[] = {
        {FORMAT("123456.789", "{}"), .type = "string", .output = "\"123,456.789\""},
        {FORMAT("1234567", "{}"), .output = "\"1,234,567\""},
        {FORMAT("999", "{}"), .output = "\"999\""},
        {FORMAT("-1000", "{}"), .output = "\"-1,000\""},
        {FORMAT("0", "{}"), .output = "\"0\""},
        {FORMAT("0.0004", "{}"), .output = "\"0\""},
        {FORMAT("0.0005", "{}"), .output = "\"0.001\""},
        {FORMAT("1e21", "{}"), .output = "\"1,000,000,000,000,000,000,000\""},
        {FORMAT("[\"/\", 1, 0]", "{}"), .output = "\"\xe2\x88\x9e\""},
        {FORMAT("[\"/\", 0, 0]", "{}"), .output = "\"NaN\""},
        {FORMAT("0.5", "{\"max-fraction-digits\": 0}"), .output = "\"1\""},
        {FORMAT("2.5", "{\"max-fraction-digits\": 0}"), .output = "\"3\""},
        {FORMAT("1.005", "{\"max-fraction-digits\": 2}"), .output = "\"1.01\""},
        {FORMAT("999.96", "{\"max-fraction-digits\": 1}"), .output = "\"1,000\""},
        {FORMAT("7", "{\"min-fraction-digits\": 2}"), .output = "\"7.00\""},
        {FORMAT("7.123456", "{\"min-fraction-digits\": 5}"), .output = "\"7.12346\""},
        {FORMAT("987654321.234567", "{\"min-fraction-digits\": 15, \"max-fraction-digits\": 20}"),
         .output = "\"987,654,321.234567000000000\""},
        {FORMAT("1e-7", "{\"max-fraction-digits\": 8}"), .output = "\"0.0000001\""},
        {FORMAT("123456.789", "{\"currency\": \"JPY\"}"), .output = "\"\xc2\xa5"
                                                                    "123,457\""},
        {FORMAT("-5", "{\"currency\": \"EUR\"}"), .output = "\"-\xe2\x82\xac"
                                                            "5.00\""},
        {FORMAT("5", "{\"currency\": \"CHF\"}"), .output = "\"CHF\xc2\xa0"
                                                           "5.00\""},
        {FORMAT("5", "{\"currency\": \"USD\", \"max-fraction-digits\": 0}"), .output = "\"$5\""},
        {FORMAT("1234.567", "{\"unit\": \"celsius\"}"), .output = "\"1,234.567\xc2\xb0"
                                                                  "C\""},
        {FORMAT("1", "{\"unit\": \"day\"}"), .output = "\"1 day\""},
        {FORMAT("2", "{\"unit\": \"day\"}"), .output = "\"2 days\""},
        {FORMAT("90", "{\"unit\": \"kilometer-per-hour\"}"), .output = "\"90 km/h\""},
        {FORMAT("90", "{\"unit\": \"parsec\"}"), .output = NULL},
        {FORMAT("90", "{\"currency\": \"euro\"}"), .output = NULL},
        {FORMAT("90", "{\"currency\": \"EUR\", \"unit\": \"meter\"}"), .output = NULL},
        {FORMAT("90", "{\"min-fraction-digits\": 101}"), .output = NULL},
        {FORMAT("90", "{\"min-fraction-digits\": 3, \"max-fraction-digits\": 2}"), .output = NULL},
        {FORMAT("90", "2"), .output = NULL},
        {FORMAT("\"90\"", "{}"), .output = NULL},
    };
#undef FORMAT
    CHECK(samples);
}

static void test_state(void **state) {
    (void)state;
    camber_status status;
    json_t *answer = ask("{\"expression\": [\"to-string\", [\"global-state\", \"x\"]], \"globalState\": {\"x\": [1]}, "
                         "\"inputs\": [[{}, {}]]}",
                         &status);
    assert_string_equal(json_string_value(json_array_get(json_object_get(answer, "outputs"), 0)), "[1]");
    json_decref(answer);
    assert_null(ask("{\"expression\": [", &status));
    assert_int_equal(status, CAMBER_ERROR_INPUT);
    assert_null(ask("{\"inputs\": []}", &status));
    assert_int_equal(status, CAMBER_ERROR_INPUT);
    answer = ask("{\"expression\": [\"at\", 0, [\"literal\", [\"\\ud83d\\udea3\"]]], \"inputs\": [[{}, {}]]}", &status);
    assert_string_equal(json_string_value(json_array_get(json_object_get(answer, "outputs"), 0)), "\xf0\x9f\x9a\xa3");
    json_decref(answer);
    assert_null(ask("{\"expression\": [\"literal\", \"\\ud83d\"]}", &status));
    assert_int_equal(status, CAMBER_ERROR_INPUT);
}

/* ---- Hostile documents ---- */

/* head, then each of count times in turn with its number in place of %zu, then tail. */
typedef struct shape {
    const char *head, *each, *tail;
    size_t count;
    const char *result; /* NULL: the document is refused */
    const char *output; /* where it compiles */
} shape;

static char *build(const shape *s) {
    const size_t room = strlen(s->each) + 24;
    char *text = malloc(strlen(s->head) + strlen(s->tail) + s->count * room + 1), *at = text;
    assert_non_null(text);
    at += sprintf(at, "%s", s->head);
    for (size_t i = 0; i < s->count; i++)
        for (const char *c = s->each; *c; c++) {
            if (*c == '#')
                at += sprintf(at, "%zu", i);
            else
                *at++ = *c;
        }
    strcpy(at, s->tail);
    return text;
}

static void test_hostile(void **state) {
    (void)state;
    static const shape shapes[] = {
        {"{\"expression\": ", "[\"!\", ", "true", 100000, NULL, NULL},
        {"{\"expression\": [\"step\", [\"number\", [\"get\", \"x\"]], 0", ", #, #",
         "], \"inputs\": [[{}, {\"properties\": "
         "{\"x\": 777777.5}}]]}",
         1000000, "success", "777777"},
        {"{\"expression\": [\"step\", [\"number\", [\"get\", \"x\"]], 0", ", 1#, #",
         "], \"inputs\": [[{}, {\"properties\": {\"x\": 12.5}}]]}", 9, "success", "2"},
        {"{\"expression\": [\"interpolate\", [\"linear\"], [\"number\", [\"get\", \"x\"]]", ", #, #",
         "], \"inputs\": [[{}, {\"properties\": {\"x\": 777777.5}}]]}", 1000000, "success", "777777.5"},
        {"{\"expression\": [\"match\", [\"get\", \"x\"]", ", \"k#\", #",
         ", -1], \"inputs\": [[{}, {\"properties\": {\"x\": \"k4711\"}}]]}", 1000000, "success", "4711"},
        {"{\"expression\": [\"in\", [\"get\", \"x\"], [\"literal\", [\"\"", ", \"k#\"",
         "]]], \"inputs\": [[{}, {\"properties\": {\"x\": \"k4711\"}}]]}", 1000000, "success", "true"},
        {"{\"expression\": [\"+\", [\"number\", [\"get\", \"x\"]]", ", 1",
         "], \"inputs\": [[{}, {\"properties\": {\"x\": "
         "1}}]]}",
         1000000, "success", "1000001"},
        {"{\"expression\": [\"let\"", ", \"v#\", [\"get\", \"x\"]", ", 1], \"inputs\": [[{}, {}]]}", 100000, "error",
         NULL},
        {"{\"expression\": [\"any\"", ", [\"has\", \"p#\"]", "]}", 100000, "error", NULL},
        {"{\"expression\": {\"property\": \"x\", \"stops\": [[0, 0]", ", [1#, #]",
         "]}, \"propertySpec\": {\"type\": "
         "\"number\"}}",
         1000000, "success", NULL},
    };
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        char *text = build(&shapes[i]);
        camber_status status;
        json_t *answer = ask(text, &status);
        if (!shapes[i].result) {
            assert_null(answer);
            assert_int_equal(status, CAMBER_ERROR_INPUT);
        } else {
            const json_t *compiled = json_object_get(answer, "compiled");
            if (strcmp(json_string_value(json_object_get(compiled, "result")), shapes[i].result) != 0)
                fail_msg("shape %zu: %s", i, json_dumps(compiled, 0));
            json_t *output = shapes[i].output ? json_loads(shapes[i].output, JSON_DECODE_ANY, NULL) : NULL;
            if (output && !equal(json_array_get(json_object_get(answer, "outputs"), 0), output))
                fail_msg("shape %zu: another output", i);
            json_decref(output);
        }
        json_decref(answer);
        free(text);
    }
}

/* Each variable reads the one before twice: 2^60 times the work without values that are kept, 2^60 bytes of text. */
static void test_doubling(void **state) {
    (void)state;
    static const struct {
        const char *first, *each, *last, *output;
    } forms[] = {
        {"[\"number\", [\"get\", \"x\"]]", "[\"+\", [\"var\", \"v\"], [\"var\", \"v\"]]", "[\"var\", \"v\"]",
         "1152921504606846976"},
        {"[\"string\", [\"get\", \"s\"]]", "[\"concat\", [\"var\", \"v\"], [\"var\", \"v\"]]",
         "[\"length\", [\"var\", \"v\"]]", ERROR},
        {"\"constant\"", "[\"concat\", [\"var\", \"v\"], [\"var\", \"v\"]]", "[\"length\", [\"var\", \"v\"]]", NULL},
    };
    for (size_t f = 0; f < sizeof forms / sizeof *forms; f++) {
        char text[8192], tail[128] = "";
        size_t used = (size_t)snprintf(text, sizeof text, "[\"let\", \"v\", %s, ", forms[f].first);
        for (int i = 0; i < 60; i++) {
            used += (size_t)snprintf(text + used, sizeof text - used, "[\"let\", \"v\", %s, ", forms[f].each);
            strcat(tail, "]");
        }
        snprintf(text + used, sizeof text - used, "%s]%s", forms[f].last, tail);
        char *document = malloc(sizeof text + 256);
        camber_status status;
        assert_non_null(document);
        sprintf(document, "{\"expression\": %s, \"inputs\": [[{}, {\"properties\": {\"x\": 1, \"s\": \"ab\"}}]]}",
                text);
        json_t *answer = ask(document, &status);
        assert_non_null(answer);
        json_t *output = forms[f].output ? json_loads(forms[f].output, JSON_DECODE_ANY, NULL) : NULL;
        if (output)
            assert_true(equal(json_array_get(json_object_get(answer, "outputs"), 0), output));
        else
            assert_string_equal(json_string_value(json_object_get(json_object_get(answer, "compiled"), "result")),
                                "error");
        json_decref(output);
        json_decref(answer);
        free(document);
    }
}

/* ---- The specification's tests ---- */

/* Tests that camber answers otherwise, with the reason. */
static const struct { const char *name, *reason; } exceptions[] = {{"", ""}};

static bool is_exception(const char *name) {
    for (size_t i = 0; i < sizeof exceptions / sizeof *exceptions; i++)
        if (strcmp(name, exceptions[i].name) == 0) {
            print_message("%s: %s\n", name, exceptions[i].reason);
            return true;
        }
    return false;
}

static void run_specification_test(const char *path, const char *name) {
    json_t *test = json_load_file(path, JSON_DECODE_ANY, NULL);
    const json_t *expected = json_object_get(test, "expected");
    char *text = json_dumps(test, 0);
    camber_status status;
    assert_non_null(text);
    json_t *answer = ask(text, &status);
    if (!answer)
        fail_msg("%s: %s", name, camber_status_get_name(status));
    const json_t *compiled = json_object_get(answer, "compiled"), *wanted = json_object_get(expected, "compiled");
    static const char *const members[] = {"result", "type", "isFeatureConstant", "isZoomConstant"};
    for (size_t i = 0; i < sizeof members / sizeof *members; i++)
        if (json_object_get(wanted, members[i]) &&
            !json_equal(json_object_get(compiled, members[i]), json_object_get(wanted, members[i])))
            fail_msg("%s: %s is another: %s", name, members[i], json_dumps(compiled, 0));
    if (json_object_get(expected, "outputs") &&
        !equal(json_object_get(answer, "outputs"), json_object_get(expected, "outputs")))
        fail_msg("%s: the outputs are others: %s", name, json_dumps(json_object_get(answer, "outputs"), 0));
    json_decref(answer);
    json_decref(test);
    free(text);
}

static void test_specification(void **state) {
    (void)state;
    const char *data = getenv("CAMBER_DATA");
    char folder[512], path[1024];
    snprintf(folder, sizeof folder, "%s/expression-tests", data ? data : "");
    DIR *files = data ? opendir(folder) : NULL;
    if (!files) {
        print_message("CAMBER_DATA has no expression-tests: the specification's tests are not run\n");
        skip();
    }
    size_t run = 0;
    for (const struct dirent *entry = readdir(files); entry; entry = readdir(files)) {
        const char *end = strrchr(entry->d_name, '.');
        if (!end || strcmp(end, ".json") != 0 || is_exception(entry->d_name))
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        run_specification_test(path, entry->d_name);
        run++;
    }
    closedir(files);
    print_message("%zu of the specification's tests pass\n", run);
    assert_true(run > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_types),          cmocka_unit_test(test_features),      cmocka_unit_test(test_strings),
        cmocka_unit_test(test_maths),          cmocka_unit_test(test_decisions),     cmocka_unit_test(test_curves),
        cmocka_unit_test(test_functions),      cmocka_unit_test(test_formats),       cmocka_unit_test(test_paddings),
        cmocka_unit_test(test_number_formats), cmocka_unit_test(test_state),         cmocka_unit_test(test_hostile),
        cmocka_unit_test(test_doubling),       cmocka_unit_test(test_specification),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
