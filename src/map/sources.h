/* The sources that a style's line and fill layers name: GeoJSON is read when it is opened, tiles as a view sees
 * them. */
#ifndef CAMBER_MAP_SOURCES_H
#define CAMBER_MAP_SOURCES_H

#include "formats/tile_cover.h"

typedef struct camber_sources camber_sources;

typedef struct camber_sources_desc {
    const char *base_path; /* the style document, from whose folder relative paths start. NULL: the working folder */
    double ratio;          /* above 1: {ratio} in URLs is @2x */
} camber_sources_desc;

/* Where it fails, the set is to be reset by the caller. */
camber_status camber_sources_open(camber_features *features, const camber_sources_desc *desc, camber_sources **sources);
/* The bounds of all that is known: x0, y0, x1, y1 in world coordinates. false: nothing is. */
bool camber_sources_bounds(const camber_sources *sources, double bounds[4]);
/* Reads the tiles that the cover sees. */
camber_status camber_sources_read(camber_sources *sources, const camber_tile_cover *cover);
void camber_sources_close(camber_sources *sources);

#endif
