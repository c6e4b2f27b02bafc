/* Keys of OpenStreetMap, for both readers of its files: ours and GDAL's. */
#ifndef CAMBER_FEATURES_OSM_KEYS_H
#define CAMBER_FEATURES_OSM_KEYS_H

#include <stdbool.h>
#include <stddef.h>

/* Keys that make a closed way an area unless their value is "no". For a highway, only the first key, "area", does so.
 * NULL ends the list. */
extern const char *const camber_osm_area_keys[];
bool camber_osm_is_no(const char *value);

/* Whether a key may contain this character. */
bool camber_osm_is_key_character(char c);
bool camber_osm_is_key(const char *text, size_t length);

/* The credit for pictures of OpenStreetMap's data. */
#define CAMBER_OSM_ATTRIBUTION "(c) OpenStreetMap contributors"

#endif
