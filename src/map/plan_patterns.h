/* The images that a plan draws with, backgrounds that are above lines or made of images, and the fills of areas. */
#ifndef CAMBER_MAP_PLAN_PATTERNS_H
#define CAMBER_MAP_PLAN_PATTERNS_H

#include "map/view.h"
#include "style/sprite.h"

/* A fill of areas, or of the whole picture, drawn before a layer of the plan. */
typedef struct camber_plan_fill {
    size_t before; /* layer_count: after the last layer; 0 for areas */
    camber_fill fill;
    const camber_sprite_image *image; /* NULL: the fill has one colour */
    float translate_px[2];            /* of areas: the translation of the image */
} camber_plan_fill;

typedef struct camber_plan_patterns {
    camber_context *context;
    camber_sprites *sprites; /* NULL: the sprites have not been read */
    bool failed;             /* out of memory */
    bool unread;             /* a pattern was needed, but the sprites have not been read */
    camber_plan_fill *fills; /* of the whole picture */
    size_t fill_count, fill_capacity;
    camber_plan_fill *areas; /* of areas; paints point to them */
    size_t area_count, area_capacity;
} camber_plan_patterns;

void camber_plan_patterns_free(camber_plan_patterns *patterns);

/* Finds the image of a layer for a feature. NULL in *image: it is not drawn. Returns false if the layer has no pattern.
 * Sets failed if memory runs out. */
bool camber_plan_patterns_find(camber_plan_patterns *patterns, const camber_style_layer *layer, double zoom,
                               const camber_feature_view *feature, const camber_sprite_image **image);

/* Adds a background. If nothing else is drawn so far, it is blended into the colour below everything; otherwise it
 * becomes a fill before the next layer. */
void camber_plan_patterns_add_background(camber_plan_patterns *patterns, const camber_style_layer *layer,
                                         const camber_view *view, size_t layers_so_far, camber_color *below);

/* Places the image of a fill on the map as a view sees it. A fill of one colour does not change. */
void camber_plan_fill_place(camber_plan_fill *placed, const camber_view *view);
/* Places the images of all fills for another view of the same zoom and ratio. */
void camber_plan_patterns_move(camber_plan_patterns *patterns, const camber_view *view);

#endif
