/* Parsing CSS colours. */
#ifndef CAMBER_STYLE_COLOR_H
#define CAMBER_STYLE_COLOR_H

#include "camber.h"

/* Parses a CSS colour: #rgb, #rgba, #rrggbb, #rrggbbaa, rgb(), rgba(), hsl(), hsla() with commas or spaces, the named
 * colours, transparent. Components out of range are clamped, as in CSS. false: not a colour. */
bool camber_color_parse(const char *text, camber_color *color);

#endif
