/* The images that a plan draws with, and the backgrounds that stand above lines or are of images. */
#ifndef CAMBER_MAP_PLAN_PATTERNS_H
#define CAMBER_MAP_PLAN_PATTERNS_H

#include "map/view.h"
#include "source/sprite.h"

/* Drawn before a layer of the plan. */
typedef struct camber_plan_fill {
    size_t before; /* layer_count: behind the last */
    camber_fill fill;
    const camber_sprite_image *image; /* NULL: the fill is of one colour */
} camber_plan_fill;

typedef struct camber_plan_patterns {
    camber_context *context;
    camber_sprites *sprites; /* NULL: not read */
    bool failed;             /* no memory */
    bool unread;             /* a pattern was asked for, and no sprites are read */
    camber_plan_fill *fills;
    size_t fill_count, fill_capacity;
} camber_plan_patterns;

void camber_plan_patterns_free(camber_plan_patterns *patterns);

/* Finds the image of a layer for a feature; NULL: it is not drawn. Returns false where the layer has no pattern. Sets
 * failed where memory runs out. */
bool camber_plan_patterns_find(camber_plan_patterns *patterns, const camber_style_layer *layer, double zoom,
                               const camber_feature_view *feature, const camber_sprite_image **image);

/* Adds a background: to the colour below everything where nothing else is drawn so far, else as a fill before the
 * layer that comes next. */
void camber_plan_patterns_add_background(camber_plan_patterns *patterns, const camber_style_layer *layer,
                                         const camber_view *view, size_t layers_so_far, camber_color *below);

/* Places the images of all backgrounds for another view of the same zoom and ratio. */
void camber_plan_patterns_move(camber_plan_patterns *patterns, const camber_view *view);

#endif
