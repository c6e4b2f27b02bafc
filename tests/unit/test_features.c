/* The set of features: strings and classes are kept once, polylines where they were put; and memory that runs out. */
#include "features/features.h"
#include "style/style.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static char *properties[] = {"highway", "bridge"};

typedef struct fixture {
    camber_context *context;
    struct camber_style style;
    camber_features *features;
} fixture;

static int set_up(void **state) {
    fixture *it = calloc(1, sizeof *it);
    assert_non_null(it);
    assert_int_equal(camber_context_create(NULL, &it->context), CAMBER_OK);
    it->style =
        (struct camber_style){.context = it->context, .schema = {.properties = properties, .property_count = 2}};
    assert_int_equal(camber_features_create(it->context, &it->style, &it->features), CAMBER_OK);
    *state = it;
    return 0;
}

static int tear_down(void **state) {
    fixture *it = *state;
    camber_features_destroy(it->features);
    camber_context_destroy(it->context);
    free(it);
    return 0;
}

static void test_strings(void **state) {
    fixture *it = *state;
    enum { COUNT = 5000 };
    const char **first = malloc(COUNT * sizeof *first);
    assert_non_null(first);
    char text[32];
    for (int i = 0; i < COUNT; i++) {
        snprintf(text, sizeof text, "street %d", i);
        assert_int_equal(camber_features_intern(it->features, text, &first[i]), CAMBER_OK);
    }
    for (int i = 0; i < COUNT; i++) {
        const char *again;
        snprintf(text, sizeof text, "street %d", i);
        assert_int_equal(camber_features_intern(it->features, text, &again), CAMBER_OK);
        assert_ptr_equal(again, first[i]);
        assert_string_equal(again, text);
    }
    free(first);
}

static void test_classes(void **state) {
    fixture *it = *state;
    const char *primary;
    assert_int_equal(camber_features_intern(it->features, "primary", &primary), CAMBER_OK);
    uint32_t layer, other, one, two;
    assert_int_equal(camber_features_find_layer(it->features, "roads", &layer), CAMBER_OK);
    assert_int_equal(camber_features_find_layer(it->features, "rail", &other), CAMBER_OK);
    assert_int_not_equal(layer, other);
    assert_int_equal(camber_features_find_layer(it->features, "roads", &other), CAMBER_OK);
    assert_int_equal(layer, other);

    const camber_value variants[][2] = {
        {{.type = CAMBER_VALUE_NULL}, {.type = CAMBER_VALUE_NULL}},
        {{.type = CAMBER_VALUE_STRING, .string = primary}, {.type = CAMBER_VALUE_NULL}},
        {{.type = CAMBER_VALUE_NULL}, {.type = CAMBER_VALUE_STRING, .string = primary}},
        {{.type = CAMBER_VALUE_STRING, .string = primary}, {.type = CAMBER_VALUE_BOOL, .boolean = true}},
        {{.type = CAMBER_VALUE_STRING, .string = primary}, {.type = CAMBER_VALUE_BOOL, .boolean = false}},
        {{.type = CAMBER_VALUE_STRING, .string = primary}, {.type = CAMBER_VALUE_NUMBER, .number = 1}},
        {{.type = CAMBER_VALUE_STRING, .string = primary}, {.type = CAMBER_VALUE_NUMBER, .number = 1.5}},
        {{.type = CAMBER_VALUE_NUMBER, .number = NAN}, {.type = CAMBER_VALUE_NULL}},
    };
    const size_t count = sizeof variants / sizeof *variants;
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(camber_features_find_class(it->features, layer, CAMBER_GEOMETRY_LINE, variants[i], &one),
                         CAMBER_OK);
        assert_int_equal(one, i);
    }
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(camber_features_find_class(it->features, layer, CAMBER_GEOMETRY_LINE, variants[i], &two),
                         CAMBER_OK);
        assert_int_equal(two, i);
    }
    assert_int_equal(camber_features_find_class(it->features, layer, CAMBER_GEOMETRY_POLYGON, variants[0], &two),
                     CAMBER_OK);
    assert_int_equal(two, count);
    it->features->source = 0;
    assert_int_equal(camber_features_find_class(it->features, layer, CAMBER_GEOMETRY_LINE, variants[0], &two),
                     CAMBER_OK);
    assert_int_equal(two, count + 1);
    assert_int_equal(it->features->classes[0].source, CAMBER_NO_SOURCE);
    assert_int_equal(it->features->classes[two].source, 0);
    it->features->source = CAMBER_NO_SOURCE;
    /* Thousands, so that the table grows. */
    for (int round = 0; round < 2; round++) {
        for (uint32_t i = 0; i < 3000; i++) {
            const camber_value values[2] = {{.type = CAMBER_VALUE_NUMBER, .number = 100.0 + i}};
            assert_int_equal(camber_features_find_class(it->features, layer, CAMBER_GEOMETRY_LINE, values, &one),
                             CAMBER_OK);
            assert_int_equal(one, count + 2 + i);
            const camber_feature_class *made = &it->features->classes[one];
            assert_true(it->features->values[made->first_value].number == 100.0 + i);
        }
    }
}

static void test_polylines(void **state) {
    fixture *it = *state;
    const camber_value none[2] = {{0}};
    uint32_t layer, class_index;
    assert_int_equal(camber_features_find_layer(it->features, "roads", &layer), CAMBER_OK);
    assert_int_equal(camber_features_find_class(it->features, layer, CAMBER_GEOMETRY_LINE, none, &class_index),
                     CAMBER_OK);
    double points[2 * 7];
    for (size_t i = 0; i < 14; i++)
        points[i] = (double)i / 16;
    size_t total = 0, polylines = 0;
    for (uint32_t feature = 0; feature < 500; feature++) {
        assert_int_equal(camber_features_add_feature(it->features, class_index), CAMBER_OK);
        for (size_t part = 0; part <= feature % 3; part++) {
            assert_int_equal(camber_features_add_polyline(it->features, points, feature % 7 + 1), CAMBER_OK);
            assert_int_equal(it->features->polyline_feature[polylines], feature);
            assert_int_equal(it->features->offsets[polylines], total);
            total += feature % 7 + 1;
            polylines++;
            assert_int_equal(it->features->offsets[polylines], total);
        }
    }
    assert_int_equal(it->features->polyline_count, polylines);
    assert_int_equal(it->features->point_count, total);
    assert_memory_equal(it->features->points + 2 * it->features->offsets[polylines - 1], points,
                        sizeof(double) * 2 * (499 % 7 + 1));
}

/* Thinning leaves the points that matter, the ends of lines, and the neighbours of what is no place. */
static void test_thin(void **state) {
    fixture *it = *state;
    camber_features *f = it->features;
    const camber_value none[2] = {{0}};
    const double zigzag[] = {0.1, 0.1, 0.2, 0.101, 0.3, 0.1, 0.4, 0.2, 0.5, 0.1},
                 gap[] = {0.1, 0.5, 0.2, 0.5, NAN, 0.5, 0.4, 0.5, 0.5, 0.5, 0.6, 0.5};
    uint32_t layer, class_index;
    assert_int_equal(camber_features_find_layer(f, "roads", &layer), CAMBER_OK);
    assert_int_equal(camber_features_find_class(f, layer, CAMBER_GEOMETRY_LINE, none, &class_index), CAMBER_OK);
    for (int i = 0; i < 100; i++) {
        assert_int_equal(camber_features_add_feature(f, class_index), CAMBER_OK);
        assert_int_equal(camber_features_add_polyline(f, zigzag, 5), CAMBER_OK);
        assert_int_equal(camber_features_add_polyline(f, gap, 6), CAMBER_OK);
    }
    assert_int_equal(camber_features_set_importance(f, 0), CAMBER_OK);
    for (size_t i = 0; i < f->point_count; i++) /* so that only places decide in the second line */
        f->importance[i] = i % 11 < 5 ? f->importance[i] : 0.0f;
    assert_int_equal(camber_features_thin(f, 0.0f), CAMBER_OK);
    assert_int_equal(f->point_count, 1100);
    assert_int_equal(camber_features_thin(f, 0.01f), CAMBER_OK);
    assert_int_equal(f->point_count, 100 * (4 + 5));
    assert_int_equal(f->point_capacity, f->point_count);
    for (size_t p = 0; p < f->polyline_count; p++) {
        const double *points = f->points + 2 * f->offsets[p];
        assert_int_equal(f->offsets[p + 1] - f->offsets[p], p % 2 ? 5 : 4);
        assert_int_equal(camber_features_whole_count(f, p), p % 2 ? 6 : 5);
        assert_memory_equal(points, p % 2 ? gap : zigzag, 2 * sizeof *points);
        if (p % 2)
            assert_memory_equal(points + 2, gap + 2, 6 * sizeof *points);
        else
            assert_memory_equal(points + 2, zigzag + 4, 6 * sizeof *points);
    }
    assert_int_equal(camber_features_thin(f, 1.0f), CAMBER_OK);
    assert_int_equal(f->point_count, 100 * (2 + 5));
    assert_int_equal(camber_features_whole_count(f, 0), 5);
    assert_int_equal(camber_features_add_polyline(f, zigzag, 5), CAMBER_OK);
    assert_int_equal(f->offsets[f->polyline_count], 100 * (2 + 5) + 5);
}

/* A style without properties makes one class a layer and geometry. */
static void test_no_properties(void **state) {
    fixture *it = *state;
    const struct camber_style style = {.context = it->context};
    camber_features *features;
    assert_int_equal(camber_features_create(it->context, &style, &features), CAMBER_OK);
    uint32_t one, two;
    assert_int_equal(camber_features_find_class(features, 0, CAMBER_GEOMETRY_LINE, NULL, &one), CAMBER_OK);
    assert_int_equal(camber_features_find_class(features, 0, CAMBER_GEOMETRY_LINE, NULL, &two), CAMBER_OK);
    assert_int_equal(one, two);
    assert_int_equal(camber_features_find_class(features, 1, CAMBER_GEOMETRY_LINE, NULL, &two), CAMBER_OK);
    assert_int_not_equal(one, two);
    camber_features_destroy(features);
}

/* Each once, as plain text; what failed takes its own out again. */
/* The box of all lines, in degrees. */
static void test_bounds(void **state) {
    fixture *it = *state;
    const double lines[] = {0.5, 0.5, 0.75, 0.25}, more[] = {0.25, 0.5, 0.5, 0.375};
    double bounds[4] = {1, 2, 3, 4};
    uint32_t layer, class_index;
    const camber_value values[2] = {{0}};
    assert_false(camber_features_get_bounds(it->features, bounds));
    assert_true(bounds[0] == 1 && bounds[3] == 4);
    assert_int_equal(camber_features_find_layer(it->features, "roads", &layer), CAMBER_OK);
    assert_int_equal(camber_features_find_class(it->features, layer, CAMBER_GEOMETRY_LINE, values, &class_index),
                     CAMBER_OK);
    assert_int_equal(camber_features_add_feature(it->features, class_index), CAMBER_OK);
    assert_int_equal(camber_features_add_polyline(it->features, lines, 2), CAMBER_OK);
    assert_int_equal(camber_features_add_polyline(it->features, more, 2), CAMBER_OK);
    assert_true(camber_features_get_bounds(it->features, bounds));
    assert_true(bounds[0] == -90 && bounds[2] == 90 && fabs(bounds[1]) < 1e-9);
    assert_true(fabs(bounds[3] - 66.51326) < 1e-5);
}

/* Attributes that no layer reads of lines make no classes of lines, nor do those of source layers that are named. */
static void test_read_values(void **state) {
    fixture *it = *state;
    char *names[] = {"highway", "landuse", "ramp"};
    const unsigned lined = camber_style_layer_kinds(CAMBER_LAYER_LINE),
                   filled = camber_style_layer_kinds(CAMBER_LAYER_FILL);
    camber_property_readers readers[] = {{.kinds = lined}, {.kinds = filled}, {.named_kinds = lined}};
    const char *named = "transport";
    camber_style style = {.schema = {.properties = names,
                                     .property_count = 3,
                                     .property_readers = readers,
                                     .source_layers = &named,
                                     .source_layer_count = 1}};
    camber_features *features = NULL;
    assert_int_equal(camber_features_create(it->context, &style, &features), CAMBER_OK);
    uint32_t layers[2], classes[4];
    assert_int_equal(camber_features_find_layer(features, "lines", &layers[0]), CAMBER_OK);
    assert_int_equal(camber_features_find_layer(features, "transport", &layers[1]), CAMBER_OK);
    static const struct {
        size_t layer;
        camber_geometry_kind geometry;
        size_t count; /* of classes, where the three differ in one value */
    } cases[][3] = {
        {{0, CAMBER_GEOMETRY_LINE, 2}, {0, CAMBER_GEOMETRY_LINE, 1}, {0, CAMBER_GEOMETRY_LINE, 1}},
        {{0, CAMBER_GEOMETRY_AREA, 1}, {0, CAMBER_GEOMETRY_AREA, 2}, {0, CAMBER_GEOMETRY_AREA, 1}},
        {{0, CAMBER_GEOMETRY_POLYGON, 2}, {0, CAMBER_GEOMETRY_POLYGON, 2}, {0, CAMBER_GEOMETRY_POLYGON, 1}},
        {{1, CAMBER_GEOMETRY_LINE, 2}, {1, CAMBER_GEOMETRY_LINE, 1}, {1, CAMBER_GEOMETRY_LINE, 2}},
        {{1, CAMBER_GEOMETRY_AREA, 1}, {1, CAMBER_GEOMETRY_AREA, 2}, {1, CAMBER_GEOMETRY_AREA, 1}},
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++)
        for (size_t p = 0; p < 3; p++) {
            camber_value values[3] = {{0}};
            for (int round = 0; round < 2; round++) {
                values[p] = (camber_value){.type = CAMBER_VALUE_NUMBER, .number = round};
                assert_int_equal(camber_features_find_class(features, layers[cases[c][p].layer], cases[c][p].geometry,
                                                            values, &classes[round]),
                                 CAMBER_OK);
            }
            if ((classes[0] != classes[1]) != (cases[c][p].count == 2))
                fail_msg("%s, case %zu", names[p], c);
        }
    /* Another style that names other source layers would have read other values. */
    const char *other_layer = "roads";
    camber_style other = style;
    other.schema.source_layers = &other_layer;
    assert_int_equal(camber_features_restyle(features, &other), CAMBER_ERROR_ARGUMENT);
    camber_property_readers other_readers[] = {readers[0], readers[1], readers[0]};
    other = style;
    other.schema.property_readers = other_readers;
    assert_int_equal(camber_features_restyle(features, &other), CAMBER_ERROR_ARGUMENT);
    camber_features_destroy(features);
}

/* Another style that reads the same is taken; one that reads other properties is not. */
static void test_restyle(void **state) {
    static char *turned[] = {"bridge", "highway"};
    fixture *it = *state;
    struct camber_style same = it->style, order = it->style, fewer = it->style, directed = it->style,
                        pictured = it->style;
    order.schema.properties = turned;
    fewer.schema.property_count = 1;
    directed.schema.directed = true;
    pictured.sprite_count = 1;
    const struct camber_style *const others[] = {&order, &fewer, &directed, &pictured};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        assert_int_equal(camber_features_restyle(it->features, others[i]), CAMBER_ERROR_ARGUMENT);
        assert_ptr_equal(it->features->style, &it->style);
    }
    assert_int_equal(camber_features_restyle(it->features, &same), CAMBER_OK);
    assert_ptr_equal(it->features->style, &same);
    assert_int_equal(camber_features_restyle(it->features, &it->style), CAMBER_OK);
}

/* The key changes with each change of the set, even if the set is as large as before, so that whatever is kept for it
 * is made again. */
static void test_key(void **state) {
    fixture *it = *state;
    const camber_features_mark mark = camber_features_get_mark(it->features);
    uint64_t keys[5] = {camber_features_key(it->features)};
    assert_true(camber_features_key(it->features) == keys[0]);
    assert_int_equal(camber_features_restyle(it->features, &it->style), CAMBER_OK);
    keys[1] = camber_features_key(it->features);
    camber_features_reset(it->features, &mark);
    keys[2] = camber_features_key(it->features);
    assert_int_equal(
        camber_features_merge_and_weigh(it->features, it->features->polyline_count, true, CAMBER_MERGE_ANY), CAMBER_OK);
    keys[3] = camber_features_key(it->features);
    camber_features_release_points(it->features);
    keys[4] = camber_features_key(it->features);
    for (size_t i = 0; i < 5; i++)
        for (size_t k = 0; k < i; k++)
            assert_true(keys[i] != keys[k]);
}

static void test_attribution(void **state) {
    fixture *it = *state;
    camber_features *set = it->features;
    assert_null(camber_features_get_attribution(set));
    static const char *const nothing[] = {NULL, "", " \n", "<br>"};
    for (size_t i = 0; i < sizeof nothing / sizeof *nothing; i++)
        assert_int_equal(camber_features_add_attribution(set, nothing[i]), CAMBER_OK);
    assert_null(camber_features_get_attribution(set));
    assert_int_equal(camber_features_add_attribution(
                         set, " <a href=\"https://a.example/?b>c\" target='_blank'>&copy; A &amp; B</a>\n"),
                     CAMBER_OK);
    assert_string_equal(camber_features_get_attribution(set), "\xc2\xa9 A & B");
    camber_features_cut_attribution(set, 0);
    assert_null(camber_features_get_attribution(set));
    assert_int_equal(camber_features_add_attribution(set, "<a href=\"https://a.example\">&copy;  A</a> <i>1 < 2</i>"),
                     CAMBER_OK);
    assert_string_equal(camber_features_get_attribution(set), "\xc2\xa9 A 1 < 2");
    const size_t size = set->attribution_size;
    assert_int_equal(camber_features_add_attribution(set, "B"), CAMBER_OK);
    assert_int_equal(camber_features_add_attribution(set, "\xc2\xa9 A"), CAMBER_OK);
    assert_string_equal(camber_features_get_attribution(set), "\xc2\xa9 A 1 < 2, B");
    camber_features_cut_attribution(set, size);
    assert_string_equal(camber_features_get_attribution(set), "\xc2\xa9 A 1 < 2");
    /* It goes to terminals and into files. */
    camber_features_cut_attribution(set, 0);
    assert_int_equal(camber_features_add_attribution(set, "\x01 C\x1b[2J\x7f\x08 D\a"), CAMBER_OK);
    assert_string_equal(camber_features_get_attribution(set), "C [2J D");
}

static void *reallocate_some(void *user, void *block, size_t size) {
    int *left = user;
    if (size == 0) {
        free(block);
        return NULL;
    }
    return (*left)-- > 0 ? realloc(block, size) : NULL;
}

/* Allocations of a whole read fail, the first ones each; nothing leaks (the sanitizer looks) and the status is told. */
static void test_out_of_memory(void **state) {
    (void)state;
    int failures = 0;
    for (int allowed = 1; allowed < 1000; allowed += 1 + allowed / 8) {
        int left = 1000000;
        const camber_context_desc desc = {.reallocate = reallocate_some, .allocator_user = &left};
        camber_context *context;
        assert_int_equal(camber_context_create(&desc, &context), CAMBER_OK);
        const struct camber_style style = {.context = context,
                                           .schema = {.properties = properties, .property_count = 2}};
        const camber_source_desc source = {.path = CAMBER_TEST_DATA "/santa_cruz/osm.mbtiles",
                                           .where = "type = 'motorway'"};
        camber_features *features = NULL;
        left = allowed;
        camber_status status = camber_features_create(context, &style, &features);
        if (status == CAMBER_OK)
            status = camber_features_read(features, &source);
        const bool enough = status == CAMBER_OK;
        if (!enough) {
            failures++;
            assert_int_equal(status, CAMBER_ERROR_MEMORY);
            assert_true(!features || features->feature_count == 0);
        }
        camber_features_destroy(features);
        left = 1;
        camber_context_destroy(context);
        if (enough) {
            assert_true(failures > 10);
            return;
        }
    }
    fail_msg("a read of a small layer needs more than 1000 allocations");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_strings, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_classes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_polylines, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_thin, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_no_properties, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_bounds, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_restyle, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_key, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_read_values, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_attribution, set_up, tear_down),
        cmocka_unit_test(test_out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
