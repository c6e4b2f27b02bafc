/* Reads OpenStreetMap's PBF files without GDAL: the lines that its layer "lines" would give, in the same order. */
#ifndef CAMBER_OSM_OSM_H
#define CAMBER_OSM_OSM_H

#include "features/reader.h"

/* It reads a PBF of which the lines are wanted, all of them or those that pass a filter as osm/where.h has it. It
 * declines a file that has negative ids, or features that it does not know, and a filter that nothing passes; it leaves
 * none to GDAL of which GDAL would pass over something. */
extern const camber_reader camber_osm_reader;

#endif
