/* Makes the forms of icons.
 *
 * Input: an item's icon, and the size at which the item shows it. Output: its image with a border, or the rings of its
 * edge. Main idea: an icon that is fitted to a text is stretched in the parts that its sprite lists, and its other
 * parts keep their size. A curve for each axis says where each px of the icon is drawn:
 *
 *     icon    |---|====|---|          - keeps its size
 *     form    |---|==========|---|    = is stretched */
#include "map/label_icons.h"

#include "text/contours.h"
#include "text/distances.h"

#include <math.h>
#include <string.h>

enum { KNOTS_MAX = 64, SIDE_MAX_PX = 4096 };

/* A piecewise linear curve from px of the icon to px of the form. Both ascend. */
typedef struct curve {
    float from[KNOTS_MAX + 2], to[KNOTS_MAX + 2];
    size_t count;
} curve;

static void add_knot(curve *c, float from, float to) {
    if (c->count && from <= c->from[c->count - 1])
        return;
    c->from[c->count] = from;
    c->to[c->count++] = to;
}

/* Makes the curve of an axis: all zones are stretched by the same factor, so that the icon's size becomes the form's.
 */
static curve make_curve(float (*zones)[2], size_t zone_count, float size, float wanted) {
    curve c = {{0.0f}, {0.0f}, 0};
    float stretched = 0.0f, at = 0.0f, to = 0.0f;
    const size_t used = zone_count < KNOTS_MAX / 2 ? zone_count : KNOTS_MAX / 2;
    for (size_t i = 0; i < used; i++)
        stretched += zones[i][1] - zones[i][0];
    const float rate = stretched > 0.0f ? fmaxf(wanted - (size - stretched), 0.0f) / stretched : wanted / size;
    add_knot(&c, 0.0f, 0.0f);
    for (size_t i = 0; i < used && stretched > 0.0f; i++) {
        to += zones[i][0] - at;
        add_knot(&c, zones[i][0], to);
        to += rate * (zones[i][1] - zones[i][0]);
        add_knot(&c, zones[i][1], to);
        at = zones[i][1];
    }
    add_knot(&c, size, stretched > 0.0f ? to + size - at : wanted);
    return c;
}

static float along(const float *from, const float *to, size_t count, float x) {
    size_t i = 1;
    while (i + 1 < count && x > from[i])
        i++;
    const float length = from[i] - from[i - 1];
    return length > 0.0f ? to[i - 1] + (x - from[i - 1]) * (to[i] - to[i - 1]) / length : to[i];
}

static float forward(const curve *c, float x) {
    return along(c->from, c->to, c->count, x);
}
static float backward(const curve *c, float x) {
    return along(c->to, c->from, c->count, x);
}

/* ---- Images ---- */

static size_t stride_of(const camber_sprite_image *icon) {
    return icon->image.stride_bytes ? icon->image.stride_bytes : (size_t)4 * icon->width;
}

static const uint8_t *texel(const camber_sprite_image *icon, int x, int y) {
    const int last_x = (int)icon->width - 1, last_y = (int)icon->height - 1;
    const size_t column = (size_t)(x < 0 ? 0 : x > last_x ? last_x : x);
    const size_t row = (size_t)(y < 0 ? 0 : y > last_y ? last_y : y);
    return icon->image.rgba + row * stride_of(icon) + 4 * column;
}

/* Samples the icon between the middles of its px. */
static void sample(const camber_sprite_image *icon, float x, float y, uint8_t rgba[4]) {
    const float left = floorf(x - 0.5f), top = floorf(y - 0.5f), u = x - 0.5f - left, v = y - 0.5f - top;
    const uint8_t *a = texel(icon, (int)left, (int)top), *b = texel(icon, (int)left + 1, (int)top);
    const uint8_t *c = texel(icon, (int)left, (int)top + 1), *d = texel(icon, (int)left + 1, (int)top + 1);
    for (int i = 0; i < 4; i++)
        rgba[i] = (uint8_t)((1.0f - v) * ((1.0f - u) * (float)a[i] + u * (float)b[i]) +
                            v * ((1.0f - u) * (float)c[i] + u * (float)d[i]) + 0.5f);
}

static camber_status make_image(camber_context *context, const curve *x_curve, const curve *y_curve,
                                camber_icon_form *form) {
    const camber_sprite_image *icon = form->icon;
    const uint32_t width = form->width + 2, height = form->height + 2;
    uint8_t *rgba = camber_alloc_zero(context, (size_t)width * height, 4);
    if (!rgba)
        return CAMBER_ERROR_MEMORY;
    const bool whole = form->width == icon->width && form->height == icon->height;
    for (size_t y = 0; y < form->height; y++) {
        uint8_t *row = rgba + 4 * ((y + 1) * width + 1);
        if (whole) {
            memcpy(row, icon->image.rgba + y * stride_of(icon), (size_t)4 * icon->width);
            continue;
        }
        const float from_y = backward(y_curve, (float)y + 0.5f);
        for (size_t x = 0; x < form->width; x++)
            sample(icon, backward(x_curve, (float)x + 0.5f), from_y, row + 4 * x);
    }
    form->image = (camber_image){.rgba = rgba, .width = width, .height = height};
    return CAMBER_OK;
}

/* ---- Distances ---- */

static camber_status make_outline(camber_context *context, const curve *x_curve, const curve *y_curve,
                                  camber_icon_form *form) {
    const camber_sprite_image *icon = form->icon;
    uint8_t *alphas = camber_alloc(context, (size_t)icon->width * icon->height, 1);
    if (!alphas)
        return CAMBER_ERROR_MEMORY;
    for (size_t y = 0; y < icon->height; y++)
        for (size_t x = 0; x < icon->width; x++)
            alphas[y * icon->width + x] = texel(icon, (int)x, (int)y)[3];
    float *distances = camber_distances_refine(context, alphas, icon->width, icon->height);
    camber_free(context, alphas);
    if (!distances)
        return CAMBER_ERROR_MEMORY;
    const camber_contour_source source = {.values = distances,
                                          .width = CAMBER_DISTANCE_STEPS * (icon->width - 1) + 1,
                                          .height = CAMBER_DISTANCE_STEPS * (icon->height - 1) + 1,
                                          .left = 0.5f,
                                          .top = 0.5f,
                                          .scale = 1.0f / CAMBER_DISTANCE_STEPS};
    camber_outline_maker maker = {.context = context, .scale = 1.0f, .tolerance_em = 1.0f / 256.0f};
    camber_contours_trace(&source, &maker);
    for (size_t i = 0; i < maker.point_count; i++) {
        maker.points[2 * i] = forward(x_curve, maker.points[2 * i]) / (float)form->width;
        maker.points[2 * i + 1] = forward(y_curve, maker.points[2 * i + 1]) / (float)form->height;
    }
    camber_free(context, distances);
    return camber_outline_finish(&maker, &form->outline, &form->outline_block);
}

/* ---- Forms ---- */

static uint32_t side_of(float length_px, float px, uint32_t size) {
    if (!(px > 0.0f))
        return size;
    const float side = roundf(length_px / px);
    return side < 1.0f ? 1u : side > (float)SIDE_MAX_PX + 1.0f ? SIDE_MAX_PX + 1u : (uint32_t)side;
}

static camber_status make_form(camber_context *context, camber_icon_form *form) {
    const camber_sprite_image *icon = form->icon;
    if (form->width > SIDE_MAX_PX || form->height > SIDE_MAX_PX)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "style: the image \"%.64s\" would be stretched to more than %d px; use a shorter text",
                           icon->name, SIDE_MAX_PX);
    const curve x = make_curve(icon->stretch_x, icon->stretch_x_count, (float)icon->width, (float)form->width);
    const curve y = make_curve(icon->stretch_y, icon->stretch_y_count, (float)icon->height, (float)form->height);
    return icon->sdf ? make_outline(context, &x, &y, form) : make_image(context, &x, &y, form);
}

static uint64_t hash_of(const camber_icon_form *form) {
    return camber_mix(camber_mix(camber_mix(0, (uintptr_t)form->icon), form->width), form->height);
}

/* Finds the slot of an equal form, or the free slot where it would be. */
static uint32_t *find_slot(const camber_icon_forms *f, const camber_icon_form *form) {
    size_t at = (size_t)hash_of(form) & (f->slot_count - 1);
    for (; f->slots[at]; at = (at + 1) & (f->slot_count - 1)) {
        const camber_icon_form *other = f->forms + f->slots[at] - 1;
        if (other->icon == form->icon && other->width == form->width && other->height == form->height)
            break;
    }
    return f->slots + at;
}

/* Makes room for one more form. */
static bool reserve(camber_icon_forms *f) {
    if (!camber_grow(f->context, &f->forms, &f->capacity, f->count + 1, sizeof *f->forms))
        return false;
    if (2 * (f->count + 1) <= f->slot_count)
        return true;
    const size_t count = f->slot_count ? 2 * f->slot_count : 64;
    uint32_t *slots = camber_alloc_zero(f->context, count, sizeof *slots);
    if (!slots)
        return false;
    camber_free(f->context, f->slots);
    f->slots = slots;
    f->slot_count = count;
    for (size_t i = 0; i < f->count; i++)
        *find_slot(f, f->forms + i) = (uint32_t)i + 1;
    return true;
}

camber_status camber_icon_forms_find(camber_icon_forms *f, const camber_label_item *item, size_t *index) {
    const uint32_t width = side_of(hypotf(item->xx, item->yx), item->unstretched_px, item->icon->width);
    const uint32_t height = side_of(hypotf(item->xy, item->yy), item->unstretched_px, item->icon->height);
    camber_icon_form form = {.icon = item->icon, .width = width, .height = height};
    if (!reserve(f))
        return CAMBER_ERROR_MEMORY;
    uint32_t *slot = find_slot(f, &form);
    if (!*slot) {
        const camber_status status = make_form(f->context, &form);
        if (status != CAMBER_OK)
            return status;
        f->forms[f->count] = form;
        *slot = (uint32_t)++f->count;
    }
    *index = *slot - 1;
    return CAMBER_OK;
}

void camber_icon_forms_free(camber_icon_forms *f) {
    for (size_t i = 0; i < f->count; i++) {
        camber_free(f->context, (void *)f->forms[i].image.rgba);
        camber_free(f->context, f->forms[i].outline_block);
    }
    if (f->context) {
        camber_free(f->context, f->forms);
        camber_free(f->context, f->slots);
    }
    *f = (camber_icon_forms){0};
}
