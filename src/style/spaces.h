/* Mixing two colours, also in colour spaces in which steps look even. */
#ifndef CAMBER_STYLE_SPACES_H
#define CAMBER_STYLE_SPACES_H

#include "style/expression.h"

/* Returns the colour at t, from a (0) to b (1). */
camber_color camber_color_mix(camber_color a, camber_color b, double t, camber_color_space space);

#endif
