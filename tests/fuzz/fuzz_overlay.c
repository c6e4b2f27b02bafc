/* Overlays of pictures: a line for each parameter of the query, NAME=VALUE; after an empty line, the body. */
#include "fuzz.h"

#include "serve/overlay.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_PARAMS = 64 };

/* Splits the text into parameters. Returns the body; NULL: none. */
static const char *split(char *text, camber_overlay_param *params, size_t *count) {
    for (char *line = text, *next; line && *count < MOST_PARAMS; line = next) {
        if ((next = strchr(line, '\n')) != NULL)
            *next++ = 0;
        char *value = strchr(line, '=');
        if (!*line)
            return next;
        if (value)
            *value++ = 0;
        params[(*count)++] = (camber_overlay_param){line, value ? value : ""};
    }
    return NULL;
}

/* The reason has no text of the request, so that none of its marks are in it. */
static void check_refusal(const char *reason) {
    REQUIRE(strlen(reason) > 5 && strlen(reason) < CAMBER_OVERLAY_REASON_SIZE);
    for (; *reason; reason++)
        REQUIRE(*reason >= ' ' && *reason < 127 && *reason != '<' && *reason != '\\');
}

static void check(const camber_overlay_desc *desc, camber_route_view view) {
    camber_route_request request = {.route = CAMBER_ROUTE_STATIC,
                                    .view = view,
                                    .width = 300,
                                    .height = 200,
                                    .ratio = 1,
                                    .bounds = {170, -1, -170, 80},
                                    .pitch_deg = 60,
                                    .bearing_deg = 30,
                                    .map_zoom = 12};
    char reason[CAMBER_OVERLAY_REASON_SIZE] = "";
    camber_overlay *overlay = NULL;
    const int status = camber_overlay_create(desc, &request, &overlay, reason);
    REQUIRE(status == 200 || status == 400);
    REQUIRE(status == 200 || !overlay);
    if (status == 400)
        check_refusal(reason);
    REQUIRE(status == 400 || request.view == CAMBER_ROUTE_CENTER);
    REQUIRE(request.longitude >= -180 && request.longitude <= 180 && request.latitude >= -86 && request.latitude <= 86);
    REQUIRE(request.map_zoom >= 0 && request.map_zoom <= 24);
    if (overlay) {
        double bounds[4];
        (void)camber_features_get_bounds(camber_overlay_get_features(overlay), bounds);
    }
    camber_overlay_destroy(overlay);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
    camber_overlay_param params[MOST_PARAMS];
    char *text = malloc(size + 1);
    REQUIRE(text);
    memcpy(text, bytes, size);
    text[size] = 0;
    camber_overlay_desc desc = {.params = params};
    desc.body = split(text, params, &desc.param_count);
    desc.body_size = desc.body ? size - (size_t)(desc.body - text) : 0;
    check(&desc, (camber_route_view)(size % 3));
    free(text);
    return 0;
}
