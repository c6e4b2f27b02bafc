/* Makes shapes of placed labels.
 *
 * Input: items, which say where glyphs and icons are. Output: rings and passes. Main idea: a glyph's outline is an
 * area, and its halo is a stroke of the same rings with round joins, so that labels are drawn as lines and areas are. A
 * layer's icons come first, then the halos of all its texts, then the texts. Items that are flat on the map and items
 * that stand upright in the picture are in passes of their own, of which only the former have the picture's pitch. */
#include "map/label_shapes.h"

#include <math.h>
#include <string.h>

/* A halo's edge fades over its blur times this, as in MapLibre, whose glyphs are distances. */
static const float BLUR_SCALE = 1.19f;
/* The largest width of a stroke. */
static const float WIDEST_PX = 16384.0f;

/* Rings that are being collected. */
typedef struct rings {
    camber_context *context;
    float *points;
    uint32_t *offsets, *rows;
    size_t point_count, point_capacity, ring_count, offset_capacity, row_capacity;
} rings;

static bool begin_ring(rings *r, uint32_t row, size_t points) {
    if (!camber_grow(r->context, &r->points, &r->point_capacity, 2 * (r->point_count + points), sizeof *r->points) ||
        !camber_grow(r->context, &r->offsets, &r->offset_capacity, r->ring_count + 2, sizeof *r->offsets) ||
        !camber_grow(r->context, &r->rows, &r->row_capacity, r->ring_count + 1, sizeof *r->rows))
        return false;
    r->offsets[r->ring_count] = (uint32_t)r->point_count;
    r->rows[r->ring_count] = row;
    r->offsets[++r->ring_count] = (uint32_t)(r->point_count + points);
    return true;
}

/* Distances from an item's origin are multiples of 1 / STEPS px, so that its points are the same in all pictures that
 * are whole px apart: floats hold such positions exactly, up to 4096 px. */
static const float STEPS = 4096.0f;

static float snap(float px) {
    return fabsf(px) < 2048.0f ? floorf(px * STEPS + 0.5f) / STEPS : px;
}

/* Finds the point at which the point u, v of an item is drawn. */
static void find_point(const camber_label_item *item, float u, float v, float p[2]) {
    p[0] = item->x + snap(item->xx * u + item->xy * v);
    p[1] = item->y + snap(item->yx * u + item->yy * v);
}

static void add_point(rings *r, const camber_label_item *item, float u, float v) {
    find_point(item, u, v, r->points + 2 * r->point_count++);
}

/* Adds the rings of an outline. Rings of one row form one area. */
static camber_status add_outline(rings *r, const camber_outline *outline, const camber_label_item *item) {
    for (size_t i = 0; i < outline->ring_count; i++) {
        const uint32_t first = outline->offsets[i], end = outline->offsets[i + 1];
        if (end - first < 3)
            continue;
        if (!begin_ring(r, item->look, (size_t)(end - first) + 1))
            return CAMBER_ERROR_MEMORY;
        for (uint32_t k = first; k <= end; k++) {
            const float *point = outline->points + (size_t)2 * (k < end ? k : first);
            add_point(r, item, point[0], point[1]);
        }
    }
    return CAMBER_OK;
}

static camber_status add_glyph(rings *r, camber_fonts *fonts, const camber_label_item *item) {
    const float size_px = fmaxf(hypotf(item->xx, item->yx), hypotf(item->xy, item->yy));
    camber_outline outline;
    if (!(size_px > 0.0f))
        return CAMBER_OK;
    const camber_status status = camber_fonts_get_sized_outline(fonts, item->glyph, size_px, &outline);
    return status == CAMBER_OK ? add_outline(r, &outline, item) : status;
}

/* ---- Icons ---- */

/* Adds the quadrangle of an icon's image, which has a border around the item's frame. */
static camber_status add_frame(rings *r, const camber_icon_form *form, const camber_label_item *item, uint32_t row) {
    static const float corners[][2] = {{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}, {0.0f, 0.0f}};
    const float edge_x = 1.0f / (float)form->width, edge_y = 1.0f / (float)form->height;
    if (!begin_ring(r, row, 5))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < 5; i++) {
        const float u = corners[i][0], v = corners[i][1];
        add_point(r, item, u + (u > 0.5f ? edge_x : -edge_x), v + (v > 0.5f ? edge_y : -edge_y));
    }
    return CAMBER_OK;
}

/* Places the image in the frame; the fill's pointer to it is set later. */
static void place_image(const camber_icon_form *form, const camber_label_item *item, const camber_label_look *look,
                        camber_fill *fill) {
    const float half_x = 0.5f + 1.0f / (float)form->width, half_y = 0.5f + 1.0f / (float)form->height;
    float left[2], right[2], top[2], bottom[2];
    find_point(item, 0.5f - half_x, 0.5f, left);
    find_point(item, 0.5f + half_x, 0.5f, right);
    find_point(item, 0.5f, 0.5f - half_y, top);
    find_point(item, 0.5f, 0.5f + half_y, bottom);
    fill->color = look->color;
    fill->width_px = hypotf(right[0] - left[0], right[1] - left[1]);
    fill->height_px = hypotf(bottom[0] - top[0], bottom[1] - top[1]);
    fill->x_px = left[0] - 0.5f * (bottom[0] - top[0]);
    fill->y_px = left[1] - 0.5f * (bottom[1] - top[1]);
    fill->bearing_deg =
        -atan2((double)(right[1] - left[1]), (double)(right[0] - left[0])) * 180.0 / 3.14159265358979323846;
}

/* ---- Looks ---- */

static void make_look(const camber_label_look *look, camber_label_shapes *s, size_t i) {
    const float blur = BLUR_SCALE * look->halo_blur_px;
    const bool has_halo = look->halo_width_px > 0.0f && look->halo_color.a > 0.0f;
    const float width = has_halo ? fminf(2.0f * (look->halo_width_px + blur), WIDEST_PX) : 0.0f;
    s->strokes[i] = (camber_stroke){.width_px = width, .join = CAMBER_JOIN_ROUND, .cap = CAMBER_CAP_ROUND};
    s->halos[i] = (camber_paint){
        .width_px = width, .color = look->halo_color, .blur_px = 2.0f * blur, .smooth_blur = blur > 0.0f};
    s->fills[i] = (camber_fill){.color = look->color};
    s->paints[i] = (camber_paint){.fill = s->fills + i};
}

static bool allocate(const camber_labels *labels, camber_label_shapes *s) {
    camber_context *context = s->context = s->forms.context = labels->context;
    size_t icons = 0;
    for (size_t i = 0; i < labels->item_count; i++)
        icons += labels->items[i].glyph == CAMBER_NO_GLYPH;
    s->look_count = labels->look_count;
    const size_t all = s->look_count + icons;
    return (s->strokes = camber_alloc_zero(context, s->look_count + 1, sizeof *s->strokes)) &&
           (s->halos = camber_alloc_zero(context, s->look_count + 1, sizeof *s->halos)) &&
           (s->fills = camber_alloc_zero(context, all + 1, sizeof *s->fills)) &&
           (s->paints = camber_alloc_zero(context, all + 1, sizeof *s->paints));
}

/* ---- Layers ---- */

typedef struct shape_maker {
    const camber_labels *labels;
    camber_fonts *fonts;
    camber_label_shapes *shapes;
    rings texts, icons;
    size_t range_capacity;
    size_t *form_of; /* by icon */
} shape_maker;

static camber_status add_icon(shape_maker *m, const camber_label_item *item, camber_label_range *range) {
    camber_label_shapes *s = m->shapes;
    size_t *form = m->form_of + s->icon_count;
    camber_status status = camber_icon_forms_find(&s->forms, item, form);
    if (status != CAMBER_OK)
        return status;
    if (item->icon->sdf) {
        range->has_halo |= s->halos[item->look].width_px > 0.0f;
        return add_outline(&m->texts, &s->forms.forms[*form].outline, item);
    }
    camber_fill *fill = s->fills + s->look_count + s->icon_count;
    place_image(s->forms.forms + *form, item, m->labels->looks + item->look, fill);
    s->paints[s->look_count + s->icon_count].fill = fill;
    return add_frame(&m->icons, s->forms.forms + *form, item, (uint32_t)s->icon_count++);
}

/* Returns the range for an item of a layer: the last one, unless it is of another layer, or lies flat where the item
 * stands upright. NULL: there is no memory. */
static camber_label_range *find_range(shape_maker *m, size_t layer, const camber_label_item *item) {
    camber_label_shapes *s = m->shapes;
    const bool upright = !m->labels->looks[item->look].flat;
    camber_label_range *last = s->range_count ? s->ranges + s->range_count - 1 : NULL;
    if (last && last->layer == layer && last->upright == upright)
        return last;
    if (!camber_grow(s->context, &s->ranges, &m->range_capacity, s->range_count + 1, sizeof *s->ranges))
        return NULL;
    last = s->ranges + s->range_count++;
    *last = (camber_label_range){
        .layer = layer, .upright = upright, .first_icon = m->icons.ring_count, .first_ring = m->texts.ring_count};
    return last;
}

static camber_status add_item(shape_maker *m, size_t layer, const camber_label_item *item) {
    camber_label_range *range = find_range(m, layer, item);
    camber_status status = CAMBER_OK;
    if (!range)
        return CAMBER_ERROR_MEMORY;
    if (item->glyph == CAMBER_NO_GLYPH) { /* an icon, or an image in a text */
        status = add_icon(m, item, range);
    } else {
        range->has_halo |= m->shapes->halos[item->look].width_px > 0.0f;
        status = add_glyph(&m->texts, m->fonts, item);
    }
    range->icon_count = m->icons.ring_count - range->first_icon;
    range->ring_count = m->texts.ring_count - range->first_ring;
    return status;
}

static camber_status add_layer(shape_maker *m, const camber_label_layer *layer) {
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < layer->icon_count && status == CAMBER_OK; i++)
        status = add_item(m, layer->layer, m->labels->items + layer->first_icon + i);
    for (size_t i = 0; i < layer->glyph_count && status == CAMBER_OK; i++)
        status = add_item(m, layer->layer, m->labels->items + layer->first_glyph + i);
    return status;
}

static camber_status finish(const rings *r, camber_polylines **polylines) {
    const camber_polylines_desc desc = {.points = r->points,
                                        .point_count = r->point_count,
                                        .offsets = r->offsets,
                                        .polyline_count = r->ring_count,
                                        .rows = r->rows};
    return r->ring_count ? camber_polylines_create(r->context, &desc, polylines) : CAMBER_OK;
}

static void free_rings(rings *r) {
    camber_free(r->context, r->points);
    camber_free(r->context, r->offsets);
    camber_free(r->context, r->rows);
}

static camber_status make_layers(shape_maker *m) {
    camber_label_shapes *s = m->shapes;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < m->labels->layer_count && status == CAMBER_OK; i++)
        status = add_layer(m, m->labels->layers + i);
    for (size_t i = 0; i < s->icon_count && status == CAMBER_OK; i++)
        s->fills[s->look_count + i].image = &s->forms.forms[m->form_of[i]].image;
    if (status == CAMBER_OK)
        status = finish(&m->texts, &s->texts);
    if (status == CAMBER_OK)
        status = finish(&m->icons, &s->icons);
    return status;
}

camber_status camber_label_shapes_make(const camber_labels *labels, camber_fonts *fonts, camber_label_shapes *shapes) {
    shape_maker m = {.labels = labels,
                     .fonts = fonts,
                     .shapes = shapes,
                     .texts = {.context = labels->context},
                     .icons = {.context = labels->context}};
    *shapes = (camber_label_shapes){0};
    if (!labels->item_count)
        return CAMBER_OK;
    camber_status status = CAMBER_ERROR_MEMORY;
    if (allocate(labels, shapes) &&
        (m.form_of = camber_alloc_zero(labels->context, labels->item_count + 1, sizeof *m.form_of))) {
        for (size_t i = 0; i < labels->look_count; i++)
            make_look(labels->looks + i, shapes, i);
        status = make_layers(&m);
    }
    camber_free(labels->context, m.form_of);
    free_rings(&m.texts);
    free_rings(&m.icons);
    return status;
}

void camber_label_shapes_free(camber_label_shapes *s) {
    camber_polylines_destroy(s->texts);
    camber_polylines_destroy(s->icons);
    camber_icon_forms_free(&s->forms);
    if (s->context) {
        camber_free(s->context, s->strokes);
        camber_free(s->context, s->halos);
        camber_free(s->context, s->fills);
        camber_free(s->context, s->paints);
        camber_free(s->context, s->ranges);
    }
    *s = (camber_label_shapes){0};
}

/* ---- Drawing ---- */

camber_status camber_label_shapes_tessellate(const camber_label_shapes *s, camber_mesh *mesh, camber_method method) {
    static const camber_stroke thin = {.width_px = 0.0f};
    camber_mesh *texts, *icons;
    camber_status status = CAMBER_OK;
    if (!s->texts && !s->icons)
        return CAMBER_OK;
    status = camber_mesh_get_companion(mesh, &texts);
    if (status == CAMBER_OK && s->texts) {
        const camber_tessellation_desc desc = {.strokes = s->strokes, .stroke_count = s->look_count, .method = method};
        status = camber_mesh_tessellate(texts, s->texts, &desc);
    }
    if (status != CAMBER_OK || !s->icons)
        return status;
    camber_stroke *strokes = camber_alloc_zero(s->context, s->icon_count, sizeof *strokes);
    if (!strokes)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < s->icon_count; i++)
        strokes[i] = thin;
    const camber_tessellation_desc desc = {.strokes = strokes, .stroke_count = s->icon_count, .method = method};
    status = camber_mesh_get_companion(texts, &icons);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate(icons, s->icons, &desc);
    camber_free(s->context, strokes);
    return status;
}

size_t camber_label_shapes_passes(const camber_label_shapes *s, const camber_label_range *range,
                                  camber_pass passes[CAMBER_LABEL_PASSES],
                                  camber_label_mesh meshes[CAMBER_LABEL_PASSES]) {
    size_t count = 0;
    if (range->icon_count) {
        meshes[count] = CAMBER_MESH_ICONS;
        passes[count++] = (camber_pass){.first_polyline = range->first_icon,
                                        .polyline_count = range->icon_count,
                                        .paints = s->paints + s->look_count,
                                        .paint_count = s->icon_count,
                                        .upright = range->upright};
    }
    const camber_pass text = {.first_polyline = range->first_ring,
                              .polyline_count = range->ring_count,
                              .paints = s->halos,
                              .paint_count = s->look_count,
                              .upright = range->upright};
    if (range->ring_count && range->has_halo) {
        meshes[count] = CAMBER_MESH_TEXTS;
        passes[count++] = text;
    }
    if (range->ring_count) {
        meshes[count] = CAMBER_MESH_TEXTS;
        passes[count] = text;
        passes[count++].paints = s->paints;
    }
    return count;
}
