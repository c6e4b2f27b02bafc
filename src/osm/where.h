/* Attribute filters that are simple enough for this reader: comparisons of tags with strings for equality, IN, IS NULL,
 * AND, OR and parentheses, with GDAL's semantics. */
#ifndef CAMBER_OSM_WHERE_H
#define CAMBER_OSM_WHERE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { CAMBER_OSM_WHERE_KEYS = 16, CAMBER_OSM_WHERE_STEPS = 128 };

/* A part of the filter's text. */
typedef struct camber_osm_text {
    const char *at;
    size_t length;
} camber_osm_text;

typedef enum camber_osm_step_kind {
    CAMBER_OSM_STEP_EQUAL = 0, /* the key's value is this text */
    CAMBER_OSM_STEP_DIFFERENT, /* the key has another value */
    CAMBER_OSM_STEP_MISSING,
    CAMBER_OSM_STEP_PRESENT,
    CAMBER_OSM_STEP_AND, /* combines the last two results */
    CAMBER_OSM_STEP_OR,
} camber_osm_step_kind;

typedef struct camber_osm_step {
    camber_osm_step_kind kind;
    uint32_t key;
    camber_osm_text text;
} camber_osm_step;

/* A filter as steps that leave one result. It points into the text of the filter. */
typedef struct camber_osm_where {
    camber_osm_text keys[CAMBER_OSM_WHERE_KEYS];
    uint32_t key_count;
    camber_osm_step steps[CAMBER_OSM_WHERE_STEPS];
    size_t step_count;
} camber_osm_where;

/* Returns false if the filter is invalid, or uses something that this reader does not support. */
bool camber_osm_where_parse(const char *text, camber_osm_where *where);
/* values: key_count entries. If `at` of an entry is NULL, the way does not have the key. */
bool camber_osm_where_passes(const camber_osm_where *where, const camber_osm_text *values);

#endif
