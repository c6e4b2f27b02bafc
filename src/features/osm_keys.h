/* Keys of OpenStreetMap, for both readers of its files. */
#ifndef CAMBER_FEATURES_OSM_KEYS_H
#define CAMBER_FEATURES_OSM_KEYS_H

#include <stdbool.h>
#include <stddef.h>

/* Keys that make a closed way an area, unless their value is "no": the first, "area", also a highway. NULL at the
 * end. */
extern const char *const camber_osm_area_keys[];
bool camber_osm_is_no(const char *value);

/* The characters of keys that can be read. */
bool camber_osm_is_key_character(char c);
bool camber_osm_is_key(const char *text, size_t length);

/* Whom to name beside a picture of OpenStreetMap's data. */
#define CAMBER_OSM_ATTRIBUTION "(c) OpenStreetMap contributors"

#endif
