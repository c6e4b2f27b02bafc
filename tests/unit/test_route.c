/* Routes: each path that exists, each bound of its numbers, and that nothing else is a path. */
#include "core.h"

#include "serve/route.h"

#include <string.h>

static const camber_route_limits LIMITS = {4, 2048};

static int parse(const char *path, camber_route_request *request) {
    memset(request, 0xa5, sizeof *request);
    return camber_route_parse(&LIMITS, "GET", path, request);
}

static void finds_each_route(void **state) {
    static const struct {
        const char *path;
        camber_route route;
    } rows[] = {{"/", CAMBER_ROUTE_PAGE},
                {"/?x=1#y", CAMBER_ROUTE_PAGE},
                {"/page/page.js", CAMBER_ROUTE_PAGE},
                {"/tiles.json", CAMBER_ROUTE_TILEJSON},
                {"/dark/tiles.json", CAMBER_ROUTE_TILEJSON},
                {"/0/0/0.png", CAMBER_ROUTE_TILE},
                {"/dark/24/16777215/16777215@4x.webp", CAMBER_ROUTE_TILE},
                {"/static/0,0,0/1x1.png", CAMBER_ROUTE_STATIC},
                {"/dark/static/0,0,0/1x1.png", CAMBER_ROUTE_STATIC},
                {"/tileset.json", CAMBER_ROUTE_TILESET},
                {"/subtrees/0.0.0.subtree", CAMBER_ROUTE_SUBTREE},
                {"/subtrees/24.16777215.0.subtree?x", CAMBER_ROUTE_SUBTREE},
                {"//subtrees/0.0.0.subtree", CAMBER_ROUTE_SUBTREE},
                {"//0/0/0.glb", CAMBER_ROUTE_TILE},
                {"/health", CAMBER_ROUTE_HEALTH},
                {"/events", CAMBER_ROUTE_EVENTS},
                {"/metrics", CAMBER_ROUTE_METRICS}};
    camber_route_request request;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(parse(rows[i].path, &request), 200);
        assert_int_equal(request.route, rows[i].route);
        assert_int_equal(request.dark, strncmp(rows[i].path, "/dark", 5) == 0);
        assert_int_equal(camber_route_parse(&LIMITS, "HEAD", rows[i].path, &request), 200);
    }
}

static void reads_a_tile(void **state) {
    camber_route_request request;
    (void)state;
    assert_int_equal(parse("/dark/14/7800/6133@2x.webp?v=3", &request), 200);
    assert_true(request.dark);
    assert_int_equal(request.zoom, 14);
    assert_int_equal(request.column, 7800);
    assert_int_equal(request.row, 6133);
    assert_int_equal(request.ratio, 2);
    assert_int_equal(request.type, CAMBER_ROUTE_WEBP);
    assert_int_equal(parse("/subtrees/8.131.97.subtree", &request), 200);
    assert_int_equal(request.zoom, 8);
    assert_int_equal(request.column, 131);
    assert_int_equal(request.row, 97);
    assert_int_equal(parse("/14/7800/6133.mvt", &request), 200);
    assert_int_equal(request.type, CAMBER_ROUTE_MVT);
    assert_int_equal(request.ratio, 1);
}

static void reads_a_picture(void **state) {
    camber_route_request request;
    (void)state;
    assert_int_equal(parse("/static/-8.625,41.25,13.5@-30.5,60/512x256@4x.png", &request), 200);
    assert_true(request.longitude == -8.625 && request.latitude == 41.25 && request.map_zoom == 13.5);
    assert_true(request.bearing_deg == -30.5 && request.pitch_deg == 60);
    assert_int_equal(request.width, 512);
    assert_int_equal(request.height, 256);
    assert_int_equal(request.ratio, 4);
    assert_int_equal(parse("/static/180,-85,24@360/2048x2048.webp", &request), 200);
    assert_true(request.bearing_deg == 360 && request.pitch_deg == 0);
    assert_int_equal(parse("/static/0,85.051129,2/9x9.png", &request), 200);
    assert_int_equal(parse("/static/0,85.06,2/9x9.png", &request), 400); /* Web Mercator ends before */
    assert_int_equal(parse("/static/raw/-960130.5,5045000,13@20/9x9.png", &request), 200);
    assert_true(request.is_raw && request.view == CAMBER_ROUTE_CENTER && request.bearing_deg == 20.0);
    assert_float_equal(request.longitude, -8.625, 1e-5);
    assert_float_equal(request.latitude, 41.221041, 1e-5);
    assert_int_equal(parse("/static/raw/-20037508.342789,-20037508,20037508,20037508/9x9.png", &request), 200);
    assert_true(request.view == CAMBER_ROUTE_BOUNDS && request.bounds[0] == -180.0 && request.bounds[3] < 85.052);
    assert_int_equal(parse("/static/raw/auto/9x9.png", &request), 200);
    assert_int_equal(parse("/static/raw/0,20037509,2/9x9.png", &request), 400);
    assert_non_null(strstr(request.reason, "metres of Web Mercator"));
    assert_int_equal(parse("/static/raw/0,1,2,0/9x9.png", &request), 400);
    assert_int_equal(parse("/static/raw/raw/0,0,2/9x9.png", &request), 400);
}

static void reads_a_name(void **state) {
    camber_route_request request;
    (void)state;
    assert_int_equal(parse("/page/leaflet-LICENSE.txt?1", &request), 200);
    assert_int_equal(request.name_length, strlen("leaflet-LICENSE.txt"));
    assert_memory_equal(request.name, "leaflet-LICENSE.txt", request.name_length);
    assert_int_equal(parse("/", &request), 200);
    assert_int_equal(request.name_length, 0);
}

/* Each differs from a path that exists by one thing. */
static void knows_no_other_path(void **state) {
    static const char *const paths[] = {"",
                                        "?",
                                        "//",
                                        "x",
                                        "0/0/0.png",
                                        "/0/0/0",
                                        "/0/0/0.",
                                        "/0/0/0.gif",
                                        "/0/0/0.PNG",
                                        "/0/0/0.png/",
                                        "/0/0/0.pngx",
                                        "/0/0/0.png%00",
                                        "/0/0/0.webpwebp",
                                        "/0/0/1.png",
                                        "/0/1/0.png",
                                        "/1/2/0.png",
                                        "/24/16777216/0.png",
                                        "/25/0/0.png",
                                        "/99999999/0/0.png",
                                        "/4294967296/0/0.png",
                                        "/18446744073709551616/0/0.png",
                                        "/1/00/0.png",
                                        "/01/0/0.png",
                                        "/1/0/0@0x.png",
                                        "/1/0/0@5x.png",
                                        "/1/0/0@x.png",
                                        "/1/0/0@1.5x.png",
                                        "/1/0/0@2.png",
                                        "/1/0/-0.png",
                                        "/1/0/+0.png",
                                        "/1/0/ 0.png",
                                        "/1/0/0x1.png",
                                        "/1/0/0 .png",
                                        "/../1/0/0.png",
                                        "/1/0/../0/0.png",
                                        "/%31/0/0.png",
                                        "/%2e%2e/etc/passwd",
                                        "/../../etc/passwd",
                                        "//0/0/0.png",
                                        "//tileset.json",
                                        "///0/0/0.glb",
                                        "/dark/tileset.json",
                                        "/tileset.jsonx",
                                        "/subtrees/",
                                        "/subtrees/1/0/0.subtree",
                                        "/subtrees/1.2.0.subtree",
                                        "/subtrees/01.0.0.subtree",
                                        "/subtrees/25.0.0.subtree",
                                        "/subtrees/1.0.0",
                                        "/subtrees/1.0.0.subtreex",
                                        "/subtrees/../1.0.0.subtree",
                                        "/dark/subtrees/1.0.0.subtree",
                                        "/page/",
                                        "/page/../route.c",
                                        "/page/..",
                                        "/page/.hidden",
                                        "/page/a/b",
                                        "/page/a%2fb",
                                        "/page/a\\b",
                                        "/page/a\n",
                                        "/dark",
                                        "/dark/",
                                        "/dark/dark/0/0/0.png",
                                        "/dark/health",
                                        "/dark/metrics",
                                        "/light/0/0/0.png",
                                        "/tiles.json/",
                                        "/tiles.jsonp",
                                        "/healthz"};
    camber_route_request request;
    (void)state;
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        if (parse(paths[i], &request) != 404 || request.route != CAMBER_ROUTE_NONE)
            fail_msg("\"%s\" is a path", paths[i]);
    }
    assert_int_equal(parse("/static/0.123456789012345,0,0/1x1.png", &request), 200);
}

/* A path that begins as a picture is answered with what is wrong with it. */
static void tells_what_is_wrong_with_pictures(void **state) {
    static const char *const paths[] = {"/static/0,0,0/0x1.png",
                                        "/static/0,0,0/1x0.png",
                                        "/static/0,0,0/1x1.pbf",
                                        "/static/0,0,0/1X1.png",
                                        "/static/0,0/1x1.png",
                                        "/static/180.1,0,0/1x1.png",
                                        "/static/0,90.1,0/1x1.png",
                                        "/static/0,0,24.5/1x1.png",
                                        "/static/0,0,-1/1x1.png",
                                        "/static/0,0,1e1/1x1.png",
                                        "/static/nan,0,0/1x1.png",
                                        "/static/inf,0,0/1x1.png",
                                        "/static/0x1,0,0/1x1.png",
                                        "/static/0.,0,0/1x1.png",
                                        "/static/.5,0,0/1x1.png",
                                        "/static/--1,0,0/1x1.png",
                                        "/static/0.1234567890123456,0,0/1x1.png",
                                        "/static/0,0,0@361/1x1.png",
                                        "/static/0,0,0@0,86/1x1.png",
                                        "/static/0,0,0@0,-1/1x1.png",
                                        "/static/0,0,0@/1x1.png",
                                        "/static/0,0,0@0,/1x1.png",
                                        "/static/0,0,0@0,0,0/1x1.png",
                                        "/static/",
                                        "/static/auto",
                                        "/static/auto/",
                                        "/static/auto@30/1x1.png",
                                        "/static/autos/1x1.png",
                                        "/static/1,2,3,4,5/1x1.png",
                                        "/static/0,1,2,0/1x1.png",
                                        "/static/0,0,1,86/1x1.png",
                                        "/static/0,0,1,1@30/1x1.png",
                                        "/static/0,0,0/1x1.jpg",
                                        "/static/auto/2049x1.pbf"};
    camber_route_request request;
    (void)state;
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
        if (parse(paths[i], &request) != 400 || request.route != CAMBER_ROUTE_STATIC || !request.reason)
            fail_msg("\"%s\" is a picture", paths[i]);
    assert_int_equal(parse("/static", &request), 404);
}

static void reads_bounds(void **state) {
    camber_route_request request;
    (void)state;
    assert_int_equal(parse("/static/170,-1.5,-170,2/3x4@2x.png?padding=0", &request), 200);
    assert_int_equal(request.view, CAMBER_ROUTE_BOUNDS);
    assert_true(request.bounds[0] == 170 && request.bounds[1] == -1.5 && request.bounds[2] == -170 &&
                request.bounds[3] == 2);
    assert_int_equal(parse("/static/auto/3x4.webp", &request), 200);
    assert_int_equal(request.view, CAMBER_ROUTE_AUTO);
    assert_int_equal(parse("/static/0,0,0/3x4.webp", &request), 200);
    assert_int_equal(request.view, CAMBER_ROUTE_CENTER);
    assert_int_equal(camber_route_parse(&LIMITS, "POST", "/static/auto/3x4.webp", &request), 200);
    assert_int_equal(camber_route_parse(&LIMITS, "POST", "/static/auto/0x4.webp", &request), 400);
    assert_int_equal(camber_route_parse(&LIMITS, "PUT", "/static/auto/3x4.webp", &request), 405);
}

/* The longest name that begins the path names the map. */
static void finds_maps(void **state) {
    static const char *const names[] = {"a", "ab", "a/dark"}, *const rooted[] = {"", "dark"};
    static const struct {
        const char *path;
        int status;
        camber_route route;
        uint32_t map, rooted_map;
    } rows[] = {{"/", 200, CAMBER_ROUTE_INDEX, CAMBER_ROUTE_NO_MAP, 0},
                {"/a/", 200, CAMBER_ROUTE_PAGE, 0, 9},
                {"/a/0/0/0.png", 200, CAMBER_ROUTE_TILE, 0, 9},
                {"/ab/0/0/0.png?x", 200, CAMBER_ROUTE_TILE, 1, 9},
                {"/a/dark/0/0/0.png", 200, CAMBER_ROUTE_TILE, 2, 9},
                {"/a/dark/dark/0/0/0.png", 200, CAMBER_ROUTE_TILE, 2, 9},
                {"/ab/dark/0/0/0.png", 200, CAMBER_ROUTE_TILE, 1, 9},
                {"/a", 200, CAMBER_ROUTE_FOLDER, 0, 9},
                {"/a/dark?x", 200, CAMBER_ROUTE_FOLDER, 2, 9},
                {"/a/health", 200, CAMBER_ROUTE_HEALTH, 0, 9},
                {"/health", 200, CAMBER_ROUTE_HEALTH, CAMBER_ROUTE_NO_MAP, 0},
                {"/page/page.css", 200, CAMBER_ROUTE_PAGE, CAMBER_ROUTE_NO_MAP, 0},
                {"/a/page/page.css", 200, CAMBER_ROUTE_PAGE, 0, 9},
                {"/a/static/auto/1x1.png", 200, CAMBER_ROUTE_STATIC, 0, 9},
                {"/styles/a/static/auto/1x1@2x.png?path=1", 200, CAMBER_ROUTE_STATIC, 0, 9},
                {"/styles/ab/static/1,2,3@4,5/1x1.jpg", 400, CAMBER_ROUTE_STATIC, 1, 9},
                {"/styles/ab/static/1x1.png", 400, CAMBER_ROUTE_STATIC, 1, 9},
                {"/styles/a/dark/1/0/1@2x.webp", 200, CAMBER_ROUTE_TILE, 2, 9},
                {"/styles/ab/256/1/0/1.png", 200, CAMBER_ROUTE_TILE, 1, 9},
                {"/styles/ab/512/1/0/1.png", 404, CAMBER_ROUTE_NONE, 1, 9},
                {"/styles/a/health", 404, CAMBER_ROUTE_NONE, 0, 9},
                {"/styles/abc/static/auto/1x1.png", 404, CAMBER_ROUTE_NONE, 0, 9},
                {"/styles/", 404, CAMBER_ROUTE_NONE, 0, 9},
                {"/styles/a", 404, CAMBER_ROUTE_NONE, 0, 9},
                {"/abc/0/0/0.png", 404, CAMBER_ROUTE_NONE, 0, 9},
                {"/a0/0/0.png", 404, CAMBER_ROUTE_NONE, 0, 9},
                {"/A/0/0/0.png", 404, CAMBER_ROUTE_NONE, 0, 9},
                {"//a/0/0/0.png", 404, CAMBER_ROUTE_NONE, 0, 9}};
    const camber_route_limits several = {4, 2048, names, 3}, two = {4, 2048, rooted, 2};
    camber_route_request request;
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(camber_route_parse(&several, "GET", rows[i].path, &request), rows[i].status);
        assert_int_equal(request.route, rows[i].route);
        if (rows[i].status == 200)
            assert_int_equal(request.map, rows[i].map);
        if (rows[i].rooted_map != 9) {
            assert_int_equal(camber_route_parse(&two, "GET", rows[i].path, &request), 200);
            assert_int_equal(request.map, rows[i].rooted_map);
        }
    }
    assert_int_equal(camber_route_parse(&two, "GET", "/styles/dark/0/0/0.png", &request), 200);
    assert_int_equal(request.map, 1);
    static const char *const styles[] = {"styles"}; /* this map's own paths have precedence */
    assert_int_equal(
        camber_route_parse(&(camber_route_limits){4, 2048, styles, 1}, "GET", "/styles/0/0/0.png", &request), 200);
    assert_int_equal(camber_route_parse(&LIMITS, "GET", "/styles/a/0/0/0.png", &request), 404);
    assert_int_equal(parse("/static/auto/1x1.jpeg", &request), 400);
    assert_non_null(strstr(request.reason, "JPEG"));
    assert_int_equal(camber_route_parse(&two, "GET", "/dark/0/0/0.png", &request), 200);
    assert_true(request.map == 1 && !request.dark);
    assert_int_equal(camber_route_parse(&two, "GET", "/0/0/0.png", &request), 200);
    assert_int_equal(request.map, 0);
    assert_int_equal(camber_route_parse(&several, "GET", "/a/dark", &request), 200);
    assert_int_equal(request.name_length, 4);
    assert_memory_equal(request.name, "dark", 4);
}

/* They are pictures, and it is the server's limits that they do not keep. */
static void tells_pictures_that_are_too_large(void **state) {
    static const char *const paths[] = {"/static/0,0,0/2049x1.png", "/static/0,0,0/1x2049.png",
                                        "/static/0,0,0/1025x1@2x.png", "/static/0,0,0/99999999x1@4x.webp",
                                        "/dark/static/0,0,0/1x1@5x.png"};
    camber_route_request request;
    (void)state;
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
        if (parse(paths[i], &request) != 400 || request.route != CAMBER_ROUTE_STATIC)
            fail_msg("\"%s\" is not too large", paths[i]);
    assert_null(request.reason);
}

static void takes_two_methods(void **state) {
    static const char *const methods[] = {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT", "get", "GETS", ""};
    camber_route_request request;
    (void)state;
    for (size_t i = 0; i < sizeof methods / sizeof *methods; i++)
        assert_int_equal(camber_route_parse(&LIMITS, methods[i], "/0/0/0.png", &request), 405);
}

static void names_types(void **state) {
    camber_route_type type;
    (void)state;
    for (int i = 0; i < CAMBER_ROUTE_TYPES; i++) {
        assert_true(camber_route_find_type(camber_route_get_ending((camber_route_type)i), &type));
        assert_int_equal(type, i);
        assert_non_null(strchr(camber_route_get_media_type(type), '/'));
    }
    assert_true(camber_route_find_type("jpeg", &type));
    assert_int_equal(type, CAMBER_ROUTE_JPEG);
    assert_false(camber_route_find_type("bin", &type));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_each_route),
        cmocka_unit_test(reads_a_tile),
        cmocka_unit_test(reads_a_picture),
        cmocka_unit_test(reads_a_name),
        cmocka_unit_test(knows_no_other_path),
        cmocka_unit_test(takes_two_methods),
        cmocka_unit_test(names_types),
        cmocka_unit_test(tells_pictures_that_are_too_large),
        cmocka_unit_test(tells_what_is_wrong_with_pictures),
        cmocka_unit_test(reads_bounds),
        cmocka_unit_test(finds_maps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
