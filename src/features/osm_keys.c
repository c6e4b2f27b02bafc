#include "features/osm_keys.h"

#include <ctype.h>
#include <strings.h>

/* "area" itself, and OGR's own list (closed_ways_are_polygons in its osmconf.ini). */
const char *const camber_osm_area_keys[] = {"area",       "aeroway",  "amenity", "boundary", "building", "craft",
                                            "geological", "historic", "landuse", "leisure",  "military", "natural",
                                            "office",     "place",    "shop",    "sport",    "tourism",  NULL};

bool camber_osm_is_no(const char *value) {
    return strcasecmp(value, "no") == 0;
}

bool camber_osm_is_key_character(char c) {
    return isalnum((unsigned char)c) || c == '_' || c == ':' || c == '@' || c == '-' || c == '.';
}

bool camber_osm_is_key(const char *text, size_t length) {
    for (size_t i = 0; i < length; i++)
        if (!camber_osm_is_key_character(text[i]))
            return false;
    return length > 0;
}
