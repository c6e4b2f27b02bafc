/* The styles that ship with camber, as documents that the build makes and embeds (city.cmake, roads.cmake,
 * openmaptiles.cmake, transit.cmake). The first one is the built-in style. */
#include "base/embedded.h"
#include "camber_map.h"

#include <string.h>

typedef struct shipped_style {
    const char *name;
    const char *text[2]; /* by theme */
    const unsigned long *size_bytes[2];
} shipped_style;

static const shipped_style styles[] = {
    {"city",
     {camber_style_city_light, camber_style_city_dark},
     {&camber_style_city_light_size, &camber_style_city_dark_size}},
    {"roads",
     {camber_style_roads_light, camber_style_roads_dark},
     {&camber_style_roads_light_size, &camber_style_roads_dark_size}},
    {"openmaptiles",
     {camber_style_openmaptiles_light, camber_style_openmaptiles_dark},
     {&camber_style_openmaptiles_light_size, &camber_style_openmaptiles_dark_size}},
    {"transit",
     {camber_style_transit_light, camber_style_transit_dark},
     {&camber_style_transit_light_size, &camber_style_transit_dark_size}},
    /* Not listed, because it draws nothing that "city" does not draw. */
    {"city-osm",
     {camber_style_city_osm_light, camber_style_city_osm_dark},
     {&camber_style_city_osm_light_size, &camber_style_city_osm_dark_size}},
};

enum { STYLES = sizeof styles / sizeof *styles, LISTED_STYLES = STYLES - 1 };

const char *camber_style_list(size_t n) {
    return n < LISTED_STYLES ? styles[n].name : NULL;
}

const char *camber_style_get_text(const char *name, camber_theme theme, size_t *size_bytes) {
    const int which = theme == CAMBER_THEME_DARK;
    for (size_t i = 0; i < STYLES; i++) {
        if (strcmp(styles[i].name, name) != 0)
            continue;
        *size_bytes = *styles[i].size_bytes[which];
        return styles[i].text[which];
    }
    return NULL;
}
