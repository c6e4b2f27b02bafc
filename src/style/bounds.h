/* How large the numeric properties of a style's layer can be, for any features. */
#ifndef CAMBER_STYLE_BOUNDS_H
#define CAMBER_STYLE_BOUNDS_H

#include "style/style.h"

/* Returns the largest absolute value of a numeric property over all features at the zoom. INFINITY: there is no known
 * bound. */
double camber_style_layer_bound(const camber_style_layer *layer, camber_property_id property, double zoom);

#endif
