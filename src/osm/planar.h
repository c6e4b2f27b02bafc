/* Rings by geometry: which of them are holes, and where rings end that touch or have parts in common. */
#ifndef CAMBER_OSM_PLANAR_H
#define CAMBER_OSM_PLANAR_H

#include "osm/assemble.h"

/* Replaces rings, of which none is open, by simple ones that bound the same area by the even-odd rule, and gives each
 * its role. Rings that cross keep the roles that they have, and those without become outer ones. Returns
 * CAMBER_ERROR_MEMORY. */
camber_status camber_osm_arrange(camber_osm_assembly *assembly);

#endif
