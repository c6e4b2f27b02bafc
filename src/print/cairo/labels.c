/* Draws the labels of a scene by Cairo.
 *
 * Input: the items of the labels that are shown. Output: texts with their characters, outlines of halos, images. Main
 * idea: glyphs of a label that are turned alike become one run of text, so that a straight street has its name in one
 * piece. */
#include "print/page.h"

#include <math.h>
#include <stdlib.h>

/* The labels of one layer, as a pass draws them. */
typedef struct layer {
    const camber_label_layer *of;
    bool halos;
} layer;

static bool find_layer(const camber_page_map *map, size_t number, layer *found) {
    const camber_pass *pass = map->parts.passes->passes + number;
    const camber_label_shapes *shapes = map->parts.shapes;
    const bool icons = map->parts.passes->meshes[number] == CAMBER_MESH_ICONS;
    for (size_t i = 0; i < shapes->range_count; i++) {
        const camber_label_range *range = shapes->ranges + i;
        if (icons ? range->icon_count && range->first_icon == pass->first_polyline
                  : range->ring_count && range->first_ring == pass->first_polyline) {
            *found = (layer){.halos = pass->paints == shapes->halos};
            for (size_t k = 0; k < map->parts.labels->layer_count; k++)
                if (map->parts.labels->layers[k].layer == range->layer)
                    found->of = map->parts.labels->layers + k;
            return found->of != NULL;
        }
    }
    return false;
}

static void set_color(cairo_t *cr, camber_color c) {
    cairo_set_source_rgba(cr, (double)c.r, (double)c.g, (double)c.b, (double)c.a);
}

/* ---- Icons ---- */

static camber_status find_form(const camber_page_map *map, const camber_label_item *item,
                               const camber_icon_form **form) {
    size_t index = 0;
    const camber_status status = camber_icon_forms_find(&map->parts.shapes->forms, item, &index);
    *form = status == CAMBER_OK ? map->parts.shapes->forms.forms + index : NULL;
    return status;
}

/* Draws an icon's image, which has a border of one px around the item's frame. */
static camber_status draw_icon(camber_page_map *map, const camber_label_item *item) {
    const camber_icon_form *form;
    cairo_matrix_t matrix;
    cairo_t *cr = map->cr;
    const camber_status status = find_form(map, item, &form);
    if (status != CAMBER_OK)
        return status;
    cairo_surface_t *surface = camber_page_image(map, &form->image);
    if (!surface)
        return camber_fail(map->context, CAMBER_ERROR_MEMORY, "page: no memory for an icon");
    cairo_matrix_init(&matrix, (double)item->xx, (double)item->yx, (double)item->xy, (double)item->yy, (double)item->x,
                      (double)item->y);
    cairo_matrix_scale(&matrix, 1.0 / form->width, 1.0 / form->height);
    cairo_matrix_translate(&matrix, -1.0, -1.0);
    const double area = matrix.xx * matrix.yy - matrix.xy * matrix.yx;
    if (!isfinite(area) || fabs(area) < 1e-9)
        return CAMBER_OK;
    cairo_save(cr);
    cairo_transform(cr, &matrix);
    cairo_set_source_surface(cr, surface, 0.0, 0.0);
    cairo_paint_with_alpha(cr, (double)map->parts.labels->looks[item->look].color.a);
    cairo_restore(cr);
    return CAMBER_OK;
}

/* Adds the rings of an icon that is a field of distances. */
static camber_status add_shape(camber_page_map *map, const camber_label_item *item) {
    const camber_icon_form *form;
    const camber_status status = find_form(map, item, &form);
    for (size_t r = 0; status == CAMBER_OK && r < form->outline.ring_count; r++) {
        cairo_new_sub_path(map->cr); /* else Cairo draws on from the start of the last ring */
        for (uint32_t i = form->outline.offsets[r]; i < form->outline.offsets[r + 1]; i++) {
            const float u = form->outline.points[2 * i], v = form->outline.points[2 * i + 1];
            cairo_line_to(map->cr, (double)(item->x + item->xx * u + item->xy * v),
                          (double)(item->y + item->yx * u + item->yy * v));
        }
        cairo_close_path(map->cr);
    }
    return status;
}

static camber_status draw_icons(camber_page_map *map, const camber_label_layer *of) {
    const camber_label_item *items = map->parts.labels->items;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < of->icon_count + of->glyph_count && status == CAMBER_OK; i++) {
        const size_t at = i < of->icon_count ? of->first_icon + i : of->first_glyph + i - of->icon_count;
        if (items[at].glyph == CAMBER_NO_GLYPH && !items[at].icon->sdf)
            status = draw_icon(map, items + at);
    }
    return status;
}

/* ---- Runs of glyphs ---- */

static int compare(const void *a, const void *b) {
    const uint32_t p = *(const uint32_t *)a, q = *(const uint32_t *)b;
    return p < q ? -1 : p > q;
}

/* Finds the characters of each of a label's glyphs: up to where those of another glyph begin. Blanks at the end of a
 * line have no glyph, and are left out. */
static camber_status find_characters(camber_page_map *map, size_t first, size_t end) {
    const camber_labels *labels = map->parts.labels;
    const camber_label *label = labels->labels + labels->items[first].label;
    const size_t count = end - first;
    if (!camber_grow(map->context, &map->glyphs, &map->glyph_capacity, count, sizeof *map->glyphs) ||
        !camber_grow(map->context, &map->bytes, &map->byte_capacity, count + 1, sizeof *map->bytes))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++)
        map->bytes[i] = labels->items[first + i].byte;
    qsort(map->bytes, count, sizeof *map->bytes, compare);
    for (size_t i = 0; i < count; i++) {
        const camber_label_item *item = labels->items + first + i;
        size_t low = 0, high = count; /* the first that is greater */
        while (low < high) {
            const size_t middle = (low + high) / 2;
            if (map->bytes[middle] <= item->byte)
                low = middle + 1;
            else
                high = middle;
        }
        uint32_t stop = low < count ? map->bytes[low] : label->first_byte + label->byte_count;
        while (stop > item->byte + 1 && (labels->words[stop - 1] == ' ' || labels->words[stop - 1] == '\n'))
            stop--;
        map->glyphs[i] = (camber_page_glyph){.glyph = item->glyph,
                                             .first_byte = item->byte,
                                             .end_byte = stop,
                                             .x = (double)item->x,
                                             .y = (double)item->y};
    }
    return CAMBER_OK;
}

static bool is_alike(const camber_label_item *a, const camber_label_item *b) {
    return a->xx == b->xx && a->xy == b->xy && a->yx == b->yx && a->yy == b->yy && a->look == b->look;
}

/* Gives all characters of a label to its first glyph: readers take slanted letters for words of their own. */
static void join_characters(camber_page_map *map, size_t first, size_t end) {
    const camber_labels *labels = map->parts.labels;
    const camber_label *label = labels->labels + labels->items[first].label;
    const uint32_t stop = label->first_byte + label->byte_count;
    for (size_t i = 0; i < end - first; i++)
        map->glyphs[i].first_byte = map->glyphs[i].end_byte = stop;
    map->glyphs[0].first_byte = label->first_byte;
}

/* Draws the glyphs of a label, or adds their outlines to the path. */
static camber_status draw_glyphs(camber_page_map *map, size_t first, size_t end, bool outlines) {
    const camber_label_item *items = map->parts.labels->items;
    camber_status status = find_characters(map, first, end);
    bool level = items[first].yx == 0.0f;
    for (size_t i = first + 1; i < end; i++)
        level = level && is_alike(items + first, items + i);
    if (status == CAMBER_OK && !level)
        join_characters(map, first, end);
    for (size_t i = first, next; i < end && status == CAMBER_OK; i = next) {
        for (next = i + 1; next < end && is_alike(items + i, items + next);)
            next++;
        const camber_page_run run = {.glyphs = map->glyphs + (i - first),
                                     .count = next - i,
                                     .xx = (double)items[i].xx,
                                     .yx = (double)items[i].yx,
                                     .xy = (double)items[i].xy,
                                     .yy = (double)items[i].yy,
                                     .text = map->parts.labels->words};
        if (outlines) {
            status = camber_page_add_outlines(&map->fonts, map->cr, &run);
        } else {
            set_color(map->cr, map->parts.labels->looks[items[i].look].color);
            status = camber_page_show(&map->fonts, map->cr, &run);
        }
    }
    return status;
}

/* ---- Texts and halos ---- */

static bool has_halo(const camber_label_look *look) {
    return look->halo_width_px > 0.0f && look->halo_color.a > 0.0f;
}

/* Draws the outlines in the path: as a halo, or filled. A halo's edge is where its blur would be half transparent. */
static void draw_path(camber_page_map *map, const camber_label_look *look, bool halos) {
    cairo_t *cr = map->cr;
    set_color(cr, halos ? look->halo_color : look->color);
    if (halos) {
        cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
        cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
        cairo_set_line_width(cr, 2.0 * (double)look->halo_width_px);
        cairo_stroke(cr);
    } else {
        cairo_set_fill_rule(cr, CAIRO_FILL_RULE_WINDING);
        cairo_fill(cr);
    }
}

/* Finds the end of items that are drawn together: glyphs of a label with one look, or one icon. */
static size_t end_of_items(const camber_label_item *items, size_t first, size_t end) {
    size_t i = first + 1;
    if (items[first].glyph == CAMBER_NO_GLYPH)
        return i;
    while (i < end && items[i].glyph != CAMBER_NO_GLYPH && items[i].label == items[first].label)
        i++;
    return i;
}

/* Draws halos of some items. Opaque halos are a path for each label; translucent ones cover each place once. */
static camber_status draw_halos(camber_page_map *map, size_t first, size_t end) {
    const camber_labels *labels = map->parts.labels;
    const camber_label_item *items = labels->items;
    const camber_label_look *before = NULL;
    camber_status status = CAMBER_OK;
    cairo_new_path(map->cr);
    for (size_t i = first, next; i < end && status == CAMBER_OK; i = next) {
        next = end_of_items(items, i, end);
        const camber_label_look *look = labels->looks + items[i].look;
        if (!has_halo(look) || (items[i].glyph == CAMBER_NO_GLYPH && !items[i].icon->sdf))
            continue;
        if (before && (before != look || before->halo_color.a >= 1.0f))
            draw_path(map, before, true);
        before = look;
        status = items[i].glyph == CAMBER_NO_GLYPH ? add_shape(map, items + i) : draw_glyphs(map, i, next, true);
        if (look->halo_blur_px > 0.0f && !map->told_halos)
            camber_log(map->context, CAMBER_LOG_INFO, "page: halos are drawn with a sharp edge, not blurred");
        map->told_halos |= look->halo_blur_px > 0.0f;
    }
    if (before && status == CAMBER_OK)
        draw_path(map, before, true);
    return status;
}

static camber_status draw_texts(camber_page_map *map, size_t first, size_t end) {
    const camber_label_item *items = map->parts.labels->items;
    camber_status status = CAMBER_OK;
    for (size_t i = first, next; i < end && status == CAMBER_OK; i = next) {
        next = end_of_items(items, i, end);
        if (items[i].glyph != CAMBER_NO_GLYPH) {
            status = draw_glyphs(map, i, next, false);
        } else if (items[i].icon->sdf) {
            cairo_new_path(map->cr);
            status = add_shape(map, items + i);
            draw_path(map, map->parts.labels->looks + items[i].look, false);
        }
    }
    return status;
}

camber_status camber_page_draw_labels(camber_page_map *map, size_t pass) {
    layer found;
    if (!find_layer(map, pass, &found))
        return CAMBER_OK;
    const camber_label_layer *of = found.of;
    if (map->parts.passes->meshes[pass] == CAMBER_MESH_ICONS)
        return draw_icons(map, of);
    camber_status (*draw)(camber_page_map *, size_t, size_t) = found.halos ? draw_halos : draw_texts;
    camber_status status = draw(map, of->first_icon, of->first_icon + of->icon_count);
    if (status == CAMBER_OK)
        status = draw(map, of->first_glyph, of->first_glyph + of->glyph_count);
    return status;
}
