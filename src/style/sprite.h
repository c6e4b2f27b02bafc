/* Sprites of a style: sheets of pictures (PNG), and the position of each picture on its sheet (JSON). */
#ifndef CAMBER_STYLE_SPRITE_H
#define CAMBER_STYLE_SPRITE_H

#include "style/style.h"

typedef struct camber_sprite_sheet {
    uint32_t width, height;
    uint8_t *rgba; /* premultiplied */
} camber_sprite_sheet;

typedef struct camber_sprite_image {
    char *name; /* the name in patterns: after the sprite's id and a colon, except for the default sprite */
    size_t sheet;
    uint32_t x, y, width, height; /* px of the sheet; the image is inside it */
    double pixel_ratio;           /* px of the sheet per CSS px */
    camber_image image;           /* these px, as a paint needs them */
    bool sdf;                     /* the alpha is a distance; patterns draw it unchanged */
    /* Parts that may be stretched, as pairs of first and end px of the image, in ascending order. 0: the whole side. */
    float (*stretch_x)[2], (*stretch_y)[2];
    size_t stretch_x_count, stretch_y_count;
    bool has_content;
    float content[4]; /* px: left, top, right, bottom of the space for text; without has_content, all of it */
} camber_sprite_image;

typedef struct camber_sprites {
    camber_context *context;
    camber_sprite_sheet *sheets; /* one for each sprite that was loaded */
    size_t sheet_count;
    camber_sprite_image *images; /* sorted by name */
    size_t image_count, image_capacity;
    char **missing; /* names that caused a warning because no image has them */
    size_t missing_count, missing_capacity;
} camber_sprites;

/* Loads the style's sprites. If the ratio is above 1, the high-resolution sheets (@2x) are used, if they exist. URLs
 * are resolved like the URLs of sources. A sprite on the network causes a warning, and has no images. Returns
 * CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_INPUT (not a PNG or not an index, an image outside its sheet, or an unknown
 * scheme), CAMBER_ERROR_IO, CAMBER_ERROR_LIMIT (a sheet with a side above 16384 px, or with more than 2^24 px),
 * CAMBER_ERROR_MEMORY. */
camber_status camber_sprites_load(camber_context *context, const camber_style *style, const char *base_path,
                                  double ratio, camber_sprites **sprites);
void camber_sprites_destroy(camber_sprites *sprites);
/* Finds an image by name. NULL: there is none. If several have the same name, the first sprite's is used. */
const camber_sprite_image *camber_sprites_find(const camber_sprites *sprites, const char *name);
/* Warns of a missing image, once for each name and only for the first few names. false: out of memory. */
bool camber_sprites_warn_missing(camber_sprites *sprites, const char *name);

#endif
