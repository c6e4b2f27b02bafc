/* The things that a PBF may have and GDAL passes over without a word. */
#ifndef CAMBER_OSM_BEYOND_H
#define CAMBER_OSM_BEYOND_H

#include "osm/blobs.h"

typedef struct camber_osm_beyond {
    camber_osm_codec codec; /* that it does not unpack; CAMBER_OSM_CODEC_NONE: it does */
    bool no_size;           /* blobs do not say how large they are unpacked */
    bool on_ways;           /* ways have places of nodes, which need not be there */
    bool unordered;         /* nodes come behind ways, or these behind relations */
} camber_osm_beyond;

/* Looks through the whole file. */
camber_status camber_osm_find_beyond(const camber_osm_file *file, unsigned threads, camber_osm_beyond *beyond);
bool camber_osm_is_beyond(const camber_osm_beyond *beyond);

#endif
