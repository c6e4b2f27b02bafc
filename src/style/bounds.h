/* How large a number a style's layer can ask for, whatever the features. */
#ifndef CAMBER_STYLE_BOUNDS_H
#define CAMBER_STYLE_BOUNDS_H

#include "style/style.h"

/* The largest absolute value of a property that is a number, over all features at the zoom. INFINITY: none is known. */
double camber_style_layer_bound(const camber_style_layer *layer, camber_property_id property, double zoom);

#endif
