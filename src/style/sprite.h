/* Sprites of a style: sheets of pictures (PNG) and where each lies on its sheet (JSON). */
#ifndef CAMBER_STYLE_SPRITE_H
#define CAMBER_STYLE_SPRITE_H

#include "style/style.h"

typedef struct camber_sprite_sheet {
    uint32_t width, height;
    uint8_t *rgba; /* premultiplied */
} camber_sprite_sheet;

typedef struct camber_sprite_image {
    char *name; /* as patterns name it: behind the sprite's id and a colon, but for the default one */
    size_t sheet;
    uint32_t x, y, width, height; /* px of the sheet, all on it */
    double pixel_ratio;           /* px of the sheet a CSS px */
    camber_image image;           /* these px, as a paint takes them */
    bool sdf;                     /* the alpha is a distance; as a pattern it is drawn as it stands */
    /* Parts that may be stretched, as pairs of first and end px of the image, in ascending order. 0: all of it. */
    float (*stretch_x)[2], (*stretch_y)[2];
    size_t stretch_x_count, stretch_y_count;
    bool has_content;
    float content[4]; /* left, top, right, bottom, px of the image: where a text goes. All of it without has_content */
} camber_sprite_image;

typedef struct camber_sprites {
    camber_context *context;
    camber_sprite_sheet *sheets; /* by the style's sprites */
    size_t sheet_count;
    camber_sprite_image *images; /* sorted by name */
    size_t image_count, image_capacity;
    char **missed; /* names that were asked for and warned of */
    size_t missed_count, missed_capacity;
} camber_sprites;

/* Loads the style's sprites, those for high resolutions (@2x) where the ratio is above 1 and they are there. URLs are
 * as those of sources. One on the network is warned of, and has no images. Returns CAMBER_ERROR_NOT_FOUND,
 * CAMBER_ERROR_INPUT (what is no PNG, no index, or an image that does not lie on its sheet; an unknown scheme),
 * CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT (a sheet above 16384 px a side or 2^24 px), CAMBER_ERROR_MEMORY. */
camber_status camber_sprites_load(camber_context *context, const camber_style *style, const char *base_path,
                                  double ratio, camber_sprites **sprites);
void camber_sprites_destroy(camber_sprites *sprites);
/* NULL: there is none. Of equal names the first sprite's counts. */
const camber_sprite_image *camber_sprites_find(const camber_sprites *sprites, const char *name);
/* Warns of a name that is not there, once, and of some names only. false: no memory. */
bool camber_sprites_miss(camber_sprites *sprites, const char *name);

#endif
