/* Overlays: a request draws them over its picture. Paths, markers and texts are in its query, in tileserver-gl's
 * grammar, and GeoJSON is its body.
 *
 *     path=[fill:C|stroke:C|width:PX|border:C|borderwidth:PX|]LON,LAT|LON,LAT...     or enc:POLYLINE in place of points
 *     marker=LON,LAT[|ICON|scale:N|offset:X,Y|color:C|label:TEXT]                    ICON: pin, dot or a name
 *     text=LON,LAT|WORDS[|size:PX|color:C|halo:C|halowidth:PX|anchor:SIDE|offset:X,Y]
 *     latlng, fill, stroke, width, linecap, linejoin, border, borderwidth            for all paths
 *     padding, maxzoom                                                               for views that are fitted
 *
 * Other parameters are ignored. GeoJSON is drawn by its properties of the simplestyle specification, and of a point's
 * property `text`. No text of a request is repeated in a reason, and no files are opened except fonts and the
 * icons of the server's operator. */
#ifndef CAMBER_SERVE_OVERLAY_H
#define CAMBER_SERVE_OVERLAY_H

#include "serve/icons.h"
#include "serve/route.h"

#include "camber_map.h"

enum { CAMBER_OVERLAY_REASON_SIZE = 256, CAMBER_OVERLAY_MOST_BODY_BYTES = 1 << 20 };

typedef struct camber_overlay_param {
    const char *name, *value; /* decoded */
} camber_overlay_param;

typedef struct camber_overlay_desc {
    const camber_overlay_param *params; /* param_count of them, in the order of the query */
    size_t param_count;
    const char *body; /* body_size bytes of GeoJSON. NULL: none */
    size_t body_size;
    const char *const *fonts; /* font_count folders that are searched before the system's fonts */
    size_t font_count;
    camber_overlay_icons *icons; /* NULL: none but those that are built in */
} camber_overlay_desc;

/* Makes the overlay of a picture, and fits the picture's view: request->view becomes CAMBER_ROUTE_CENTER. *overlay is
 * NULL if nothing is drawn. Returns 200; 400, with a reason; 500 (no memory, or the icons cannot be read); or 503 (too
 * many overlays with icons wait). Any thread may call it, and any one thread at a time may use the result. */
int camber_overlay_create(const camber_overlay_desc *desc, camber_route_request *request, camber_overlay **overlay,
                          char reason[CAMBER_OVERLAY_REASON_SIZE]);
void camber_overlay_destroy(camber_overlay *overlay);
/* Returns what is drawn. Its scene must have the view of the request. */
const camber_features *camber_overlay_get_features(const camber_overlay *overlay);

#endif
