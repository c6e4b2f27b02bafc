/* Reads OpenStreetMap's PBF files without GDAL: the same lines that GDAL's layer "lines" has, in the same order. */
#ifndef CAMBER_OSM_OSM_H
#define CAMBER_OSM_OSM_H

#include "features/reader.h"

/* Reads lines of a PBF: all of them, or those that pass a filter of the kind in osm/where.h. It declines files with
 * negative ids or unknown features, and filters that nothing passes. It leaves no file to GDAL of which GDAL would
 * silently ignore a part. */
extern const camber_reader camber_osm_reader;

#endif
