/* Reads OpenStreetMap's PBF files without GDAL: the lines that its layer "lines" would give, in the same order. */
#ifndef CAMBER_OSM_OSM_H
#define CAMBER_OSM_OSM_H

#include "features/features.h"

/* Whether this reader is to try a file: a PBF of OpenStreetMap, of which the lines are wanted, all of them or those
 * that pass a filter as osm/where.h has it. */
bool camber_osm_reads(const camber_source_desc *desc);
/* Reads the file, as camber_features_read does. *declined: the file has what this reader leaves to GDAL (negative ids,
 * features that it does not know, a filter that nothing passes), the set is as before, and nothing is logged. */
camber_status camber_osm_read(camber_features *features, const camber_source_desc *desc, bool *declined);
/* Whether GDAL would read a file rightly that this reader does not read; other files than PBF pass. Returns
 * CAMBER_ERROR_INPUT for one of which it would pass over something without a word. */
camber_status camber_osm_check_for_gdal(camber_context *context, const camber_source_desc *desc);

#endif
