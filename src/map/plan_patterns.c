/* Chooses the images that a plan draws with, and lays backgrounds that are images onto the map.
 *
 * Input: the style's pattern properties and the sprites. Output: the list of images in use, each once, and fills that
 * are drawn between layers.
 */
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
    if (patterns->sprites && !camber_sprites_miss(patterns->sprites, name))
        patterns->failed = true;
}

void camber_plan_patterns_free(camber_plan_patterns *patterns) {
    camber_free(patterns->context, patterns->fills);
    camber_free(patterns->context, patterns->numbers);
    camber_free(patterns->context, patterns->images);
}

static camber_image image_of(const camber_sprites *sprites, size_t number) {
    const camber_sprite_image *image = sprites->images + number;
    const camber_sprite_sheet *sheet = sprites->sheets + image->sheet;
    return (camber_image){sheet->rgba + 4 * ((size_t)sheet->width * image->y + image->x), image->width, image->height,
                          4 * (size_t)sheet->width};
}

/* Finds the number of a sprite's image among those that are drawn, from 1; 0 where memory ran out. Styles draw few
 * images, so the search is linear. */
static uint32_t intern(camber_plan_patterns *patterns, size_t number) {
    for (size_t i = 0; i < patterns->count; i++)
        if (patterns->numbers[i] == number)
            return (uint32_t)i + 1;
    if (!camber_grow(patterns->context, &patterns->images, &patterns->image_capacity, patterns->count + 1,
                     sizeof *patterns->images) ||
        !camber_grow(patterns->context, &patterns->numbers, &patterns->number_capacity, patterns->count + 1,
                     sizeof *patterns->numbers)) {
        patterns->failed = true;
        return 0;
    }
    patterns->images[patterns->count] = image_of(patterns->sprites, number);
    patterns->numbers[patterns->count++] = number;
    return (uint32_t)patterns->count;
}

bool camber_plan_patterns_find(camber_plan_patterns *patterns, const camber_style_layer *layer, double zoom,
                               const camber_feature_view *feature, uint32_t *image, float *aspect) {
    const camber_style_images names = {find_image, note_missing_image, patterns};
    uint32_t found;
    *image = 0;
    *aspect = 1.0f;
    if (patterns->failed || !camber_style_layer_pattern(layer, zoom, feature, &names, &found))
        return false;
    if (found && (*image = intern(patterns, found - 1)))
        *aspect = (float)patterns->images[*image - 1].width / (float)patterns->images[*image - 1].height;
    return true;
}

/* ---- Backgrounds ---- */

static camber_color blend_over(camber_color top, camber_color below) {
    const float rest = below.a * (1.0f - top.a), a = top.a + rest;
    if (a <= 0.0f)
        return (camber_color){0};
    return (camber_color){(top.r * top.a + below.r * rest) / a, (top.g * top.a + below.g * rest) / a,
                          (top.b * top.a + below.b * rest) / a, a};
}

/* Lays images onto the map, from the world's north-western corner, in their own size at the whole zoom below; up to
 * the next whole zoom they grow with the map. */
static void place_images(const camber_plan_patterns *patterns, const camber_view *view, uint32_t image,
                         camber_fill *fill) {
    const camber_sprite_image *from = patterns->sprites->images + patterns->numbers[image - 1];
    const double css_px = view->scale_px / (512.0 * exp2(floor(camber_view_style_zoom(view)))) / from->pixel_ratio;
    const double width = fmax(from->width * css_px, 1e-3), height = fmax(from->height * css_px, 1e-3);
    const double x = view->x * view->scale_px, y = view->y * view->scale_px;
    const double dx = floor(x / width) * width - x, dy = floor(y / height) * height - y;
    fill->pattern = image;
    fill->width_px = (float)width;
    fill->height_px = (float)height;
    fill->x_px = (float)(dx * view->cosine + dy * view->sine + 0.5 * view->width);
    fill->y_px = (float)(dy * view->cosine - dx * view->sine + 0.5 * view->height);
    fill->bearing_deg = view->bearing_deg;
}

void camber_plan_patterns_add_background(camber_plan_patterns *patterns, const camber_style_layer *layer,
                                         const camber_view *view, size_t layers_so_far, camber_color *below) {
    const camber_layer_paint paint = camber_style_layer_paint(layer, camber_view_style_zoom(view), NULL);
    camber_fill fill = {.color = paint.color};
    uint32_t image;
    float aspect;
    const bool patterned =
        camber_plan_patterns_find(patterns, layer, floor(camber_view_style_zoom(view)), NULL, &image, &aspect);
    if (patterned) {
        fill.color.a = image ? (float)paint.opacity : 0.0f;
        if (image)
            place_images(patterns, view, image, &fill);
    }
    if (!(fill.color.a > 0.0f))
        return;
    if (!patterned && layers_so_far == 0 && patterns->fill_count == 0) {
        *below = blend_over(fill.color, *below);
        return;
    }
    if (!camber_grow(patterns->context, &patterns->fills, &patterns->fill_capacity, patterns->fill_count + 1,
                     sizeof *patterns->fills)) {
        patterns->failed = true;
        return;
    }
    patterns->fills[patterns->fill_count++] = (camber_plan_fill){layers_so_far, fill};
}
