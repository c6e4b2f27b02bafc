/* Reads OpenStreetMap's PBF files without GDAL. The lines are those of GDAL's layer "lines", in the same order. */
#ifndef CAMBER_OSM_OSM_H
#define CAMBER_OSM_OSM_H

#include "features/reader.h"

/* Reads the lines of a PBF: all of them, or those that pass a filter that osm/where.h supports. The reader declines
 * files with negative ids or unknown features, and filters that nothing passes. It does not leave a file to GDAL if
 * GDAL would silently ignore a part of it. */
extern const camber_reader camber_osm_reader;

#endif
