/* The images that a plan draws with, the backgrounds that stand above lines or are of images, and the fills of areas.
 */
#ifndef CAMBER_MAP_PLAN_PATTERNS_H
#define CAMBER_MAP_PLAN_PATTERNS_H

#include "map/view.h"
#include "style/sprite.h"

/* A fill of the whole picture, drawn before a layer of the plan; or of areas. */
typedef struct camber_plan_fill {
    size_t before; /* layer_count: behind the last; of areas 0 */
    camber_fill fill;
    const camber_sprite_image *image; /* NULL: the fill is of one colour */
    float translate_px[2];            /* of areas: the image moves with them */
} camber_plan_fill;

typedef struct camber_plan_patterns {
    camber_context *context;
    camber_sprites *sprites; /* NULL: not read */
    bool failed;             /* no memory */
    bool unread;             /* a pattern was asked for, and no sprites are read */
    camber_plan_fill *fills; /* of the whole picture */
    size_t fill_count, fill_capacity;
    camber_plan_fill *areas; /* of areas: paints point at them */
    size_t area_count, area_capacity;
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

/* Lays the images of a fill onto the map, as a view sees it; a fill of one colour stays as it is. */
void camber_plan_fill_place(camber_plan_fill *placed, const camber_view *view);
/* Places the images of all fills for another view of the same zoom and ratio. */
void camber_plan_patterns_move(camber_plan_patterns *patterns, const camber_view *view);

#endif
