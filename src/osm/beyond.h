/* Finds out whether GDAL would silently skip parts of a PBF. */
#ifndef CAMBER_OSM_BEYOND_H
#define CAMBER_OSM_BEYOND_H

#include "osm/blobs.h"

typedef struct camber_osm_beyond {
    camber_osm_codec codec; /* a codec that GDAL does not support; CAMBER_OSM_CODEC_NONE: there is none */
    bool no_size;           /* some blobs do not state their uncompressed size */
    bool on_ways;           /* some ways contain the places of their nodes, so the nodes may be missing */
    bool unordered;         /* some nodes come after ways, or some ways after relations */
} camber_osm_beyond;

/* Examines the whole file. */
camber_status camber_osm_find_beyond(const camber_osm_file *file, unsigned threads, camber_osm_beyond *beyond);
bool camber_osm_is_beyond(const camber_osm_beyond *beyond);

#endif
