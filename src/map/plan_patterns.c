/* Chooses the images that a plan draws with, and places backgrounds made of images on the map.
 *
 * Input: the style's pattern properties and the sprites. Output: the images of lines, the fills of areas, and fills of
 * the whole picture that are drawn between layers. */
#include "map/plan_patterns.h"

#include <math.h>

/* ---- Images ---- */

static uint32_t find_image(void *user, const char *name) {
    const camber_plan_patterns *patterns = user;
    const camber_sprite_image *image = patterns->sprites ? camber_sprites_find(patterns->sprites, name) : NULL;
    return image ? (uint32_t)(image - patterns->sprites->images) + 1 : 0;
}

static void note_missing_image(void *user, const char *name) {
    camber_plan_patterns *patterns = user;
    patterns->unread |= !patterns->sprites;
    if (patterns->sprites && !camber_sprites_warn_missing(patterns->sprites, name))
        patterns->failed = true;
}

void camber_plan_patterns_free(camber_plan_patterns *patterns) {
    camber_free(patterns->context, patterns->fills);
    camber_free(patterns->context, patterns->areas);
}

bool camber_plan_patterns_find(camber_plan_patterns *patterns, const camber_style_layer *layer, double zoom,
                               const camber_feature_view *feature, const camber_sprite_image **image) {
    const camber_style_images names = {find_image, note_missing_image, patterns};
    uint32_t found;
    *image = NULL;
    if (patterns->failed || !camber_style_layer_pattern(layer, zoom, feature, &names, &found))
        return false;
    if (found)
        *image = patterns->sprites->images + found - 1;
    return true;
}

/* ---- Fills ---- */

static camber_color blend_over(camber_color top, camber_color below) {
    const float rest = below.a * (1.0f - top.a), a = top.a + rest;
    if (a <= 0.0f)
        return (camber_color){0};
    return (camber_color){(top.r * top.a + below.r * rest) / a, (top.g * top.a + below.g * rest) / a,
                          (top.b * top.a + below.b * rest) / a, a};
}

/* Images are repeated over the map from the world's north-western corner, at their natural size at the next lower
 * integer zoom. Up to the next integer zoom they grow with the map. */
void camber_plan_fill_place(camber_plan_fill *placed, const camber_view *view) {
    const camber_sprite_image *image = placed->image;
    camber_fill *fill = &placed->fill;
    if (!image)
        return;
    const double css_px = view->scale_px / (512.0 * exp2(floor(camber_view_style_zoom(view)))) / image->pixel_ratio;
    const double width = fmax(image->width * css_px, 1e-3), height = fmax(image->height * css_px, 1e-3);
    const double x = view->x * view->scale_px, y = view->y * view->scale_px;
    const double dx = floor(x / width) * width - x, dy = floor(y / height) * height - y;
    fill->image = &image->image;
    fill->width_px = (float)width;
    fill->height_px = (float)height;
    fill->x_px = (float)(dx * view->cosine + dy * view->sine + 0.5 * view->width) + placed->translate_px[0];
    fill->y_px = (float)(dy * view->cosine - dx * view->sine + 0.5 * view->height) + placed->translate_px[1];
    fill->bearing_deg = view->bearing_deg;
}

void camber_plan_patterns_add_background(camber_plan_patterns *patterns, const camber_style_layer *layer,
                                         const camber_view *view, size_t layers_so_far, camber_color *below) {
    const camber_layer_paint paint = camber_style_layer_paint(layer, camber_view_style_zoom(view), NULL);
    camber_plan_fill made = {.before = layers_so_far, .fill = {.color = paint.color}};
    const bool patterned =
        camber_plan_patterns_find(patterns, layer, floor(camber_view_style_zoom(view)), NULL, &made.image);
    if (patterned)
        made.fill.color.a = made.image ? (float)paint.opacity : 0.0f;
    camber_plan_fill_place(&made, view);
    if (!(made.fill.color.a > 0.0f))
        return;
    if (!patterned && layers_so_far == 0 && patterns->fill_count == 0) {
        *below = blend_over(made.fill.color, *below);
        return;
    }
    if (!camber_grow(patterns->context, &patterns->fills, &patterns->fill_capacity, patterns->fill_count + 1,
                     sizeof *patterns->fills)) {
        patterns->failed = true;
        return;
    }
    patterns->fills[patterns->fill_count++] = made;
}

void camber_plan_patterns_move(camber_plan_patterns *patterns, const camber_view *view) {
    for (size_t i = 0; i < patterns->fill_count; i++)
        camber_plan_fill_place(patterns->fills + i, view);
    for (size_t i = 0; i < patterns->area_count; i++)
        camber_plan_fill_place(patterns->areas + i, view);
}
