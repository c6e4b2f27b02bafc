/* Pages without a device: what is refused, and allocations that fail while a page is written. */
#include "core.h"

#include "camber_print.h"

#include <math.h>

/* An area with a hole, dashed and translucent lines, a gradient, and names at a point and along a line. */
static const char STYLE[] =
    "{\"version\": 8, \"sources\": {\"s\": {\"type\": \"geojson\", \"lineMetrics\": true, \"data\": {\"type\": "
    "\"FeatureCollection\", \"features\": ["
    "{\"type\": \"Feature\", \"properties\": {\"name\": \"Park\"}, \"geometry\": {\"type\": \"Polygon\", "
    "\"coordinates\": [[[0, 0], [8, 0], [8, 8], [0, 8], [0, 0]], [[2, 2], [2, 4], [4, 4], [4, 2], [2, 2]]]}},"
    "{\"type\": \"Feature\", \"properties\": {\"name\": \"Straße\"}, \"geometry\": {\"type\": \"LineString\", "
    "\"coordinates\": [[-9, 1], [-3, 6], [3, 7], [9, 2]]}}]}}}, \"layers\": ["
    "{\"id\": \"back\", \"type\": \"background\", \"paint\": {\"background-color\": \"#eee\"}},"
    "{\"id\": \"area\", \"type\": \"fill\", \"source\": \"s\", \"paint\": {\"fill-color\": \"#9c9\"}},"
    "{\"id\": \"dash\", \"type\": \"line\", \"source\": \"s\", \"paint\": {\"line-width\": 3, \"line-dasharray\": [2, "
    "1]}},"
    "{\"id\": \"faint\", \"type\": \"line\", \"source\": \"s\", \"paint\": {\"line-width\": 6, \"line-opacity\": 0.5, "
    "\"line-offset\": 4}},"
    "{\"id\": \"ramp\", \"type\": \"line\", \"source\": \"s\", \"paint\": {\"line-width\": 2, \"line-gradient\": "
    "[\"interpolate\", [\"linear\"], [\"line-progress\"], 0, \"red\", 1, \"blue\"]}},"
    "{\"id\": \"names\", \"type\": \"symbol\", \"source\": \"s\", \"layout\": {\"text-field\": [\"get\", \"name\"], "
    "\"symbol-placement\": \"line\"}, \"paint\": {\"text-halo-width\": 1, \"text-halo-color\": \"#fff\"}}]}";

static const camber_page_desc SHEET = {.width_mm = 60,
                                       .height_mm = 70,
                                       .margin_mm = 3,
                                       .dpi = 100,
                                       .title = "Page",
                                       .subtitle = "of a test",
                                       .scale_bar = true,
                                       .north_arrow = true,
                                       .grid = true};

static bool count_bytes(void *user, const void *bytes, size_t size_bytes) {
    (void)bytes;
    *(size_t *)user += size_bytes;
    return true;
}

static bool refuse_bytes(void *user, const void *bytes, size_t size_bytes) {
    (void)user;
    (void)bytes;
    (void)size_bytes;
    return false;
}

typedef struct printed {
    host h;
    camber_context *context;
    camber_style *style;
    camber_features *features;
    camber_scene *scene;
    camber_page_format format;
    size_t bytes;
} printed;

static camber_status write_page(camber_context *context, void *user) {
    printed *p = user;
    camber_page *page = NULL;
    camber_status status = camber_page_create(context, &SHEET, &page);
    if (status == CAMBER_OK)
        status = camber_page_set_credit(page, "(c) nobody");
    if (status == CAMBER_OK)
        status = camber_page_write(page, p->scene, NULL, NULL, p->format, (camber_sink){count_bytes, &p->bytes});
    camber_page_destroy(page);
    return status;
}

static void open_scene(printed *p) {
    camber_page *page = NULL;
    camber_scene_desc desc = {.view = {.kind = CAMBER_VIEW_BBOX, .west = -10, .south = -1, .east = 10, .north = 9}};
    *p = (printed){0};
    p->context = host_context(&p->h);
    assert_int_equal(camber_page_create(p->context, &SHEET, &page), CAMBER_OK);
    camber_page_set_view(page, &desc.view);
    camber_page_destroy(page);
    if (camber_style_parse(p->context, STYLE, sizeof STYLE - 1, "test", &p->style) != CAMBER_OK)
        fail_msg("%s", p->h.last);
    assert_int_equal(camber_features_create(p->context, p->style, &p->features), CAMBER_OK);
    assert_int_equal(camber_features_read_fonts(p->features, NULL, NULL), CAMBER_OK);
    assert_int_equal(camber_features_read_sources(p->features, &desc.view, NULL), CAMBER_OK);
    assert_int_equal(camber_scene_create(p->features, &desc, &p->scene), CAMBER_OK);
    for (int i = 0; i < 2; i++) { /* what the scene and its fonts keep from the first page is theirs */
        p->format = i ? CAMBER_PAGE_SVG : CAMBER_PAGE_PDF;
        if (write_page(p->context, p) != CAMBER_OK)
            fail_msg("%s", p->h.last);
    }
}

static void close_scene(printed *p) {
    camber_scene_destroy(p->scene);
    camber_features_destroy(p->features);
    camber_style_destroy(p->style);
    host_done(&p->h, p->context);
}

static void test_allocations_fail(void **state) {
    (void)state;
    static printed p;
    open_scene(&p);
    p.format = CAMBER_PAGE_PDF;
    each_allocation_fails(&p.h, write_page, p.context, &p);
    p.format = CAMBER_PAGE_SVG;
    each_allocation_fails(&p.h, write_page, p.context, &p);
    p.bytes = 0;
    assert_int_equal(write_page(p.context, &p), CAMBER_OK);
    assert_true(p.bytes > 1000);
    close_scene(&p);
}

static void test_refused(void **state) {
    (void)state;
    static printed p;
    open_scene(&p);
    camber_page *page = NULL;
    static const camber_page_desc wrong[] = {{.width_mm = 5, .height_mm = 70},
                                             {.width_mm = 60, .height_mm = NAN},
                                             {.width_mm = 60, .height_mm = 70, .margin_mm = 40},
                                             {.width_mm = 60, .height_mm = 70, .margin_mm = -1},
                                             {.width_mm = 60, .height_mm = 70, .dpi = 5},
                                             {.width_mm = 60, .height_mm = 70, .title = "\xff"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(camber_page_create(p.context, wrong + i, &page), CAMBER_ERROR_ARGUMENT);
        assert_story(&p.h, "page: ");
        assert_null(page);
    }
    const camber_page_desc other = {.width_mm = 90, .height_mm = 70};
    assert_int_equal(camber_page_create(p.context, &other, &page), CAMBER_OK);
    const camber_sink counts = {count_bytes, &p.bytes}, refuses = {refuse_bytes, NULL};
    assert_int_equal(camber_page_write(page, p.scene, NULL, NULL, CAMBER_PAGE_PDF, counts), CAMBER_ERROR_ARGUMENT);
    camber_page_destroy(page);
    assert_int_equal(camber_page_create(p.context, &SHEET, &page), CAMBER_OK);
    assert_int_equal(camber_page_write(page, p.scene, NULL, NULL, CAMBER_PAGE_PDF, refuses), CAMBER_ERROR_IO);
    camber_page_destroy(page);
    double width = 1, height = 2;
    assert_false(camber_paper_find("A9", &width, &height));
    assert_true(camber_paper_find("letter", &width, &height) && height > width);
    close_scene(&p);
}

int main(void) {
    if (!camber_page_is_built()) {
        fprintf(stderr, "this build has no Cairo\n");
        return 77;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_refused), cmocka_unit_test(test_allocations_fail)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
