/* The sprite of the styles that ship: a few signs, drawn when the sprite is loaded. */
#ifndef CAMBER_STYLE_SIGNS_H
#define CAMBER_STYLE_SIGNS_H

#include "style/sprite.h"

/* The URL by which a style names this sprite. */
#define CAMBER_SIGNS_URL "camber:signs"

/* The index of the sheet, in the form of all sprites. */
extern const char camber_signs_index[];

/* Draws the sheet: the alpha of each px is its signed distance from the sign's edge. */
camber_status camber_signs_draw(camber_context *context, camber_sprite_sheet *sheet);

#endif
