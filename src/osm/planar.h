/* Arranges rings by geometry: finds out which of them are holes, and separates rings that touch or share segments. */
#ifndef CAMBER_OSM_PLANAR_H
#define CAMBER_OSM_PLANAR_H

#include "osm/assemble.h"

/* Replaces closed rings by simple ones that bound the same area under the even-odd rule, and sets their roles. Rings
 * that cross keep their roles, or become outer rings if they have none. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_osm_arrange(camber_osm_assembly *assembly);

#endif
