/* Cuts a projected polyline to what the picture can show. */
#ifndef CAMBER_CLIP_H
#define CAMBER_CLIP_H

#include "map/view.h"

/* Takes the points of a piece, in order; first tells that they begin one. false stops the clipping. */
typedef bool camber_clip_fn(void *user, const double *point, bool first);

typedef struct camber_clip {
    camber_box seen; /* a segment that misses it is dropped, and the polyline is cut there */
    camber_box far;  /* holds seen; segments are cut on its border, so that floats stay precise */
    camber_clip_fn *put;
    void *user;
} camber_clip;

/* points: count pairs. A ring (first point == last point) that is cut begins at a cut, so that its seam stays a
 * join. Segments that are not finite are dropped. Returns false where put did. */
bool camber_clip_polyline(const camber_clip *clip, const double *points, size_t count);

#endif
