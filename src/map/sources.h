/* The sources that a style's layers name. GeoJSON is read when it is opened, tiles for a view. */
#ifndef CAMBER_MAP_SOURCES_H
#define CAMBER_MAP_SOURCES_H

#include "formats/tile_cover.h"

typedef struct camber_sources camber_sources;

typedef struct camber_sources_desc {
    const char *base_path; /* the style document; relative paths start from its folder. NULL: the working folder */
    double ratio;          /* above 1: {ratio} in URLs becomes @2x */
} camber_sources_desc;

/* If it fails, the caller has to reset the features. */
camber_status camber_sources_open(camber_features *features, const camber_sources_desc *desc, camber_sources **sources);
/* Returns the bounds of all sources whose bounds are known: x0, y0, x1, y1 in world coordinates. false: none are. */
bool camber_sources_bounds(const camber_sources *sources, double bounds[4]);
/* Reads the tiles of the cover. */
camber_status camber_sources_read(camber_sources *sources, const camber_tile_cover *cover);
void camber_sources_close(camber_sources *sources);

#endif
