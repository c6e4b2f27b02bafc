/* The server's router: a method, a zero byte or line end, and a path. */
#include "fuzz.h"

#include "serve/route.h"

#include <stdlib.h>
#include <string.h>

static const char *const NAMES[] = {"a", "ab", "a/dark"};
static const camber_route_limits LIMITS = {4, 2048, NULL, 0}, NAMED = {4, 2048, NAMES, 3};

static bool is_within(double number, double least, double most) {
    return number >= least && number <= most;
}

static void check_tile(const camber_route_request *r) {
    REQUIRE(r->zoom >= 0 && r->zoom <= 24 && !(r->column >> r->zoom) && !(r->row >> r->zoom));
}

static void check_picture(const camber_route_request *r) {
    REQUIRE(is_within(r->longitude, -180, 180) && is_within(r->latitude, -90, 90) && is_within(r->map_zoom, 0, 24));
    REQUIRE(is_within(r->bearing_deg, -360, 360) && is_within(r->pitch_deg, 0, 85));
    if (r->view == CAMBER_ROUTE_BOUNDS)
        REQUIRE(is_within(r->bounds[0], -180, 180) && is_within(r->bounds[2], -180, 180) &&
                is_within(r->bounds[1], -90, r->bounds[3]) && r->bounds[3] <= 90);
    REQUIRE(r->width >= 1 && r->height >= 1 && r->type <= CAMBER_ROUTE_WEBP);
    REQUIRE((uint64_t)r->width * r->ratio <= LIMITS.most_px && (uint64_t)r->height * r->ratio <= LIMITS.most_px);
}

/* A file of the page: no way out of the table. */
static void check_name(const camber_route_request *r, const char *path) {
    REQUIRE(r->name >= path && r->name + r->name_length <= path + strlen(path) && r->name_length <= 64);
    REQUIRE(!memchr(r->name, '/', r->name_length) && !memchr(r->name, '%', r->name_length));
    REQUIRE(r->name_length == 0 || r->name[0] != '.');
}

static void check(const camber_route_request *r, const char *path) {
    REQUIRE(r->route > CAMBER_ROUTE_NONE && r->route < CAMBER_ROUTES);
    const bool picture = r->route == CAMBER_ROUTE_TILE || r->route == CAMBER_ROUTE_STATIC;
    if (picture)
        REQUIRE(r->ratio >= 1 && r->ratio <= LIMITS.most_ratio && r->type < CAMBER_ROUTE_TYPES);
    if (r->route == CAMBER_ROUTE_TILE)
        check_tile(r);
    if (r->route == CAMBER_ROUTE_STATIC)
        check_picture(r);
    if (r->route == CAMBER_ROUTE_PAGE || r->route == CAMBER_ROUTE_FOLDER)
        check_name(r, path);
    REQUIRE(!r->dark || picture || r->route == CAMBER_ROUTE_TILEJSON);
}

static void check_status(const camber_route_limits *limits, const char *method, const char *path) {
    camber_route_request request, again;
    memset(&request, 0xa5, sizeof request);
    memset(&again, 0x5a, sizeof again);
    const int status = camber_route_parse(limits, method, path, &request);
    REQUIRE(status == 200 || status == 400 || status == 404 || status == 405);
    const bool posts = strcmp(method, "POST") == 0, reads = strcmp(method, "GET") == 0 || strcmp(method, "HEAD") == 0;
    REQUIRE((status == 405) == (!reads && !(posts && request.route == CAMBER_ROUTE_STATIC)));
    REQUIRE(camber_route_parse(limits, method, path, &again) == status && again.route == request.route);
    if (status == 200)
        check(&request, path);
    else
        REQUIRE(request.route == (status == 400 ? CAMBER_ROUTE_STATIC : CAMBER_ROUTE_NONE));
    if (status == 200)
        REQUIRE(request.map == CAMBER_ROUTE_NO_MAP || request.map < (limits->map_count ? limits->map_count : 1));
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    char *text = malloc(size + 1), *path = text;
    REQUIRE(text);
    memcpy(text, bytes, size);
    text[size] = 0;
    while (*path && *path != '\n')
        path++;
    if (*path)
        *path++ = 0;
    check_status(&LIMITS, text, path);
    check_status(&NAMED, text, path);
    free(text);
    return 0;
}
