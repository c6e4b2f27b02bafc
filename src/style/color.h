#ifndef CAMBER_STYLE_COLOR_H
#define CAMBER_STYLE_COLOR_H

#include "camber.h"

/* A CSS colour: #rgb, #rgba, #rrggbb, #rrggbbaa, rgb(), rgba(), hsl(), hsla() with commas or spaces, the named
 * colours, transparent. Components out of range are clamped, as CSS does. false: not a colour. */
bool camber_color_parse(const char *text, camber_color *color);

#endif
