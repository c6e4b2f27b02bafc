/* Checks whether nodes, ways and relations in OpenStreetMap's XML come in the order that GDAL needs. */
#ifndef CAMBER_GDAL_XML_ORDER_H
#define CAMBER_GDAL_XML_ORDER_H

#include "base/base.h"

/* Whether a file is OpenStreetMap's XML in which nodes come after ways, or ways after relations. When GDAL reads such a
 * way or relation, it does not know yet what it refers to. */
bool camber_osm_xml_is_unordered(const char *path);

#endif
