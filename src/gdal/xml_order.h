/* OpenStreetMap's XML, which GDAL reads: whether nodes, ways and relations come in the order that it needs. */
#ifndef CAMBER_GDAL_XML_ORDER_H
#define CAMBER_GDAL_XML_ORDER_H

#include "base/base.h"

/* Whether a file is OpenStreetMap's XML with nodes behind ways, or ways behind relations: GDAL has not seen what these
 * name when it meets them. */
bool camber_osm_xml_is_unordered(const char *path);

#endif
