/* Makes the items of labels that are shown.
 *
 * Input: candidates after placement. Output: for each glyph and icon, how it is drawn in the picture. */
#include "base/maths.h"
#include "map/label_layout.h"
#include "text/clusters.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct item_maker {
    camber_label_layout *layout;
    camber_labels *labels;
    uint32_t *run_bytes; /* where the runs of the current label's text begin in the labels' words */
    size_t run_capacity, word_capacity;
    size_t item_capacity, label_capacity;
    camber_label_track track;
    camber_text_glyph *glyphs; /* of a text whose lines are justified for its anchor */
    size_t glyph_capacity;
} item_maker;

/* ---- The order in which labels are drawn ---- */

typedef struct drawn {
    const camber_label_candidate *candidate;
    double order;
} drawn;

static int compare(const void *a, const void *b) {
    const drawn *p = a, *q = b;
    if (p->order < q->order || p->order > q->order)
        return p->order < q->order ? -1 : 1;
    const camber_label_candidate *c = p->candidate, *d = q->candidate;
    if (c->rank != d->rank)
        return c->rank < d->rank ? -1 : 1;
    if (c->x < d->x || c->x > d->x)
        return c->x < d->x ? -1 : 1;
    if (c->y < d->y || c->y > d->y)
        return c->y < d->y ? -1 : 1;
    return c < d ? -1 : c > d;
}

static bool may_overlap(const camber_symbol *s) {
    return s->text.overlap != CAMBER_OVERLAP_NEVER || s->icon.overlap != CAMBER_OVERLAP_NEVER ||
           s->text.ignore_placement || s->icon.ignore_placement;
}

/* Labels that may overlap are drawn from the top of the picture down, unless the style orders them. */
static double order_of(const camber_label_layout *layout, const camber_label_candidate *c) {
    const camber_symbol *s = &camber_label_rule_of(layout, c)->symbol;
    if (s->order == CAMBER_SYMBOL_ORDER_SOURCE && !s->has_sort_key)
        return c->feature;
    if (s->has_sort_key && s->order != CAMBER_SYMBOL_ORDER_VIEWPORT_Y)
        return layout->forms[c->form].sort_key;
    const double plane[2] = {c->x, c->y};
    double seen[2];
    return may_overlap(s) && camber_lens_see(&layout->lens, plane, seen) > 0.0 ? seen[1] : 0.0;
}

static camber_status list_shown(const camber_label_layout *layout, const camber_layout_layer *layer, drawn **list,
                                size_t *count) {
    *count = 0;
    if (!(*list = camber_alloc(layout->context, layer->candidate_count, sizeof **list)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < layer->candidate_count; i++) {
        const camber_label_candidate *c = layout->candidates + layer->first_candidate + i;
        if (c->shows_text || c->shows_icon)
            (*list)[(*count)++] = (drawn){c, order_of(layout, c)};
    }
    qsort(*list, *count, sizeof **list, compare);
    return CAMBER_OK;
}

/* ---- Items ---- */

/* Adds an item, unless it is transparent. */
static camber_status add_item(item_maker *m, const camber_label_item *item) {
    camber_labels *l = m->labels;
    const camber_label_look *look = m->layout->looks + item->look;
    if (!(look->color.a > 0.0f) && !(look->halo_color.a > 0.0f && look->halo_width_px > 0.0f))
        return CAMBER_OK;
    if (!camber_grow(l->context, &l->items, &m->item_capacity, l->item_count + 1, sizeof *l->items))
        return CAMBER_ERROR_MEMORY;
    l->items[l->item_count++] = *item;
    return CAMBER_OK;
}

/* Returns where a point of a candidate's label is in the picture. In a domain the result is the same in all pictures,
 * but for the whole px between them. */
static double place_in_picture(const camber_label_layout *l, double anchor, double away, size_t axis) {
    const camber_label_window *window = l->window;
    if (!window)
        return away;
    return camber_label_snap((anchor + camber_label_snap(away)) * window->scale) - window->origin_px[axis];
}

/* Sets an item's matrix so that it draws a box, or an em, whose top left corner, or origin, is at this point of the
 * frame. turned: it is turned clockwise by 90 degrees. */
static void set_matrix(const item_maker *m, const camber_label_candidate *c, camber_label_item *item,
                       const camber_label_frame *f, const double at[2], const double size[2], bool turned) {
    const double scale = m->layout->window ? m->layout->window->scale : 1.0;
    item->x = (float)place_in_picture(m->layout, c->x, f->x + f->xx * at[0] + f->xy * at[1], 0);
    item->y = (float)place_in_picture(m->layout, c->y, f->y + f->yx * at[0] + f->yy * at[1], 1);
    item->xx = (float)((turned ? f->xy : f->xx) * size[0] * scale);
    item->yx = (float)((turned ? f->yy : f->yx) * size[0] * scale);
    item->xy = (float)((turned ? -f->xx : f->xy) * size[1] * scale);
    item->yy = (float)((turned ? -f->yx : f->yy) * size[1] * scale);
}

/* Puts an image whose px are as large as the picture's onto whole px, so that it is as sharp as it was made. Browsers
 * draw such images from the nearest px, with the same result. */
static void snap_image(const camber_label_layout *layout, camber_label_item *item) {
    const camber_sprite_image *icon = item->icon;
    const float across = item->xx - (float)icon->width, down = item->yy - (float)icon->height;
    if (icon->sdf || layout->lens.pitched || !(fmaxf(fabsf(across), fabsf(down)) < 1.0f / 64.0f) ||
        !(fmaxf(fabsf(item->xy), fabsf(item->yx)) < 1.0f / 64.0f))
        return;
    item->x = floorf(item->x + 0.5f);
    item->y = floorf(item->y + 0.5f);
}

static camber_status add_icon(item_maker *m, const camber_label_candidate *c, uint32_t label) {
    const camber_label_layout *l = m->layout;
    const camber_label_form *form = l->forms + c->form;
    const camber_label_rule *rule = l->rules + form->rule;
    const camber_label_frame frame = camber_label_icon_frame(l, c);
    const camber_box box = camber_label_icon_box(l, c, c->vertical, c->anchor);
    const double at[2] = {box.x0, box.y0}, size[2] = {box.x1 - box.x0, box.y1 - box.y0};
    camber_label_item item = {.glyph = CAMBER_NO_GLYPH, .icon = form->icon, .look = rule->icon_look, .label = label};
    set_matrix(m, c, &item, &frame, at, size, false);
    snap_image(l, &item);
    if (rule->symbol.text_fit != CAMBER_FIT_NONE && form->text)
        item.unstretched_px = (float)(l->view->ratio * (l->window ? l->window->scale : 1.0) / form->icon->pixel_ratio *
                                      camber_length(frame.xx, frame.yx));
    return add_item(m, &item);
}

/* Adds a glyph or an image of a text. at: its origin in the frame, px. */
static camber_status add_glyph(item_maker *m, const camber_label_candidate *c, const camber_text_glyph *g,
                               const camber_label_frame *frame, const double at[2], uint32_t label) {
    const camber_label_form *form = m->layout->forms + c->form;
    const camber_label_run *run = m->layout->runs + form->first_run + g->run;
    const double em = m->layout->rules[form->rule].text_px * (double)g->scale;
    double size[2] = {em, em};
    camber_label_item item = {
        .glyph = g->glyph, .look = run->look, .label = label, .byte = m->run_bytes[g->run] + g->byte};
    if (g->glyph == CAMBER_NO_GLYPH) {
        if (!run->image)
            return CAMBER_OK;
        const double scale = m->layout->view->ratio * (double)run->image_scale / run->image->pixel_ratio;
        item.icon = run->image;
        size[0] = run->image->width * scale;
        size[1] = run->image->height * scale;
    }
    set_matrix(m, c, &item, frame, at, size, g->turned);
    return add_item(m, &item);
}

/* ---- Texts about points ---- */

static camber_text_justify justify_for(camber_text_anchor anchor) {
    switch (anchor) {
    case CAMBER_ANCHOR_LEFT:
    case CAMBER_ANCHOR_TOP_LEFT:
    case CAMBER_ANCHOR_BOTTOM_LEFT: return CAMBER_JUSTIFY_LEFT;
    case CAMBER_ANCHOR_RIGHT:
    case CAMBER_ANCHOR_TOP_RIGHT:
    case CAMBER_ANCHOR_BOTTOM_RIGHT: return CAMBER_JUSTIFY_RIGHT;
    default: return CAMBER_JUSTIFY_CENTER;
    }
}

static camber_status add_text(item_maker *m, const camber_label_candidate *c, uint32_t label) {
    const camber_label_form *form = m->layout->forms + c->form;
    const camber_label_rule *rule = m->layout->rules + form->rule;
    const camber_label_frame frame = camber_label_text_frame(m->layout, c);
    camber_text text = *(c->vertical ? form->vertical : form->text);
    double shift[2];
    camber_label_text_shift(m->layout, c, c->vertical, c->anchor, shift);
    if (rule->variable && !c->vertical && text.line_count > 1) {
        /* A copy, because other labels show the same text. */
        if (!camber_grow(m->layout->context, &m->glyphs, &m->glyph_capacity, text.glyph_count, sizeof *m->glyphs))
            return CAMBER_ERROR_MEMORY;
        memcpy(m->glyphs, text.glyphs, text.glyph_count * sizeof *m->glyphs);
        text.glyphs = m->glyphs;
        camber_text_place(&text, CAMBER_ANCHOR_CENTER,
                          rule->symbol.justify == CAMBER_JUSTIFY_AUTO ? justify_for(rule->anchors[c->anchor])
                                                                      : rule->symbol.justify);
    }
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < text.glyph_count && status == CAMBER_OK; i++) {
        const camber_text_glyph *g = text.glyphs + i;
        const double at[2] = {(double)g->x * rule->text_px + shift[0], (double)g->y * rule->text_px + shift[1]};
        status = add_glyph(m, c, g, &frame, at, label);
    }
    return status;
}

/* ---- Texts along lines ---- */

/* Returns the frame of a cluster of glyphs: its middle is on the line, and it is turned with the line, unless glyphs
 * stay upright. */
static camber_label_frame frame_on(const item_maker *m, const camber_label_rule *rule, double distance) {
    const camber_track_point point = camber_label_track_point(&m->track, distance);
    double cosine = 1.0, sine = 0.0;
    if (rule->symbol.text.rotation_alignment == CAMBER_ALIGN_MAP) {
        /* Vertical text runs downwards along the line. */
        cosine = m->track.vertical ? point.sine : point.cosine;
        sine = m->track.vertical ? -point.cosine : point.sine;
    }
    if (rule->text_turn != 0.0)
        camber_rotate(rule->text_turn, &sine, &cosine);
    const double scale = m->track.size / rule->text_px;
    return (camber_label_frame){.x = point.x,
                                .y = point.y,
                                .xx = scale * cosine,
                                .xy = -scale * sine,
                                .yx = scale * sine,
                                .yy = scale * cosine,
                                .flat = m->track.flat};
}

static camber_status add_along(item_maker *m, const camber_label_candidate *c, uint32_t label) {
    const camber_label_form *form = m->layout->forms + c->form;
    const camber_label_rule *rule = m->layout->rules + form->rule;
    bool fits;
    camber_status status = camber_label_track_find(m->layout, c, &m->track, &fits);
    if (status != CAMBER_OK || !fits)
        return status;
    const bool down = m->track.vertical;
    const camber_text *text = down ? form->vertical : form->text;
    for (size_t i = 0, end; i < text->glyph_count && status == CAMBER_OK; i = end) {
        const double middle = camber_text_cluster_middle(text, i, &end);
        const camber_label_frame frame = frame_on(m, rule, middle * m->track.size + m->track.shift);
        for (size_t k = i; k < end && status == CAMBER_OK; k++) {
            const camber_text_glyph *g = text->glyphs + k;
            const double at[2] = {((double)g->x - (down ? 0.0 : middle)) * rule->text_px,
                                  ((double)g->y - (down ? middle : 0.0)) * rule->text_px};
            status = add_glyph(m, c, g, &frame, at, label);
        }
    }
    return status;
}

/* ---- Layers ---- */

static camber_status add_label(item_maker *m, const camber_label_candidate *c) {
    camber_labels *l = m->labels;
    if (!camber_grow(l->context, &l->labels, &m->label_capacity, l->label_count + 1, sizeof *l->labels))
        return CAMBER_ERROR_MEMORY;
    camber_box box = c->box;
    const camber_label_window *window = m->layout->window;
    if (window)
        box =
            (camber_box){box.x0 * window->scale - window->origin_px[0], box.y0 * window->scale - window->origin_px[1],
                         box.x1 * window->scale - window->origin_px[0], box.y1 * window->scale - window->origin_px[1]};
    l->labels[l->label_count++] = (camber_label){.feature = c->feature, .box = box};
    return CAMBER_OK;
}

/* Copies the words of a label that shows its text. */
static camber_status add_words(item_maker *m, const camber_label_candidate *c, uint32_t label) {
    camber_labels *l = m->labels;
    const camber_label_form *form = m->layout->forms + c->form;
    if (!camber_grow(l->context, &m->run_bytes, &m->run_capacity, (size_t)form->run_count + 1, sizeof *m->run_bytes))
        return CAMBER_ERROR_MEMORY;
    l->labels[label].first_byte = (uint32_t)l->word_size;
    const char *said = form->words;
    for (uint32_t i = 0; i < form->run_count; i++) {
        const size_t size = strlen(said);
        m->run_bytes[i] = (uint32_t)l->word_size;
        if (size > UINT32_MAX - l->word_size)
            return camber_fail(l->context, CAMBER_ERROR_LIMIT,
                               "labels: more than 4 GB of text; draw a smaller picture");
        if (!camber_grow(l->context, &l->words, &m->word_capacity, l->word_size + size + 1, 1))
            return CAMBER_ERROR_MEMORY;
        memcpy(l->words + l->word_size, said, size);
        l->word_size += size;
        said += size + 1;
    }
    l->labels[label].byte_count = (uint32_t)l->word_size - l->labels[label].first_byte;
    return CAMBER_OK;
}

static camber_status make_layer(item_maker *m, const camber_layout_layer *layer, const drawn *list, size_t count) {
    camber_labels *l = m->labels;
    const size_t first_label = l->label_count;
    camber_label_layer made = {.layer = layer->layer, .first_icon = l->item_count};
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < count && status == CAMBER_OK; i++)
        status = add_label(m, list[i].candidate);
    for (size_t i = 0; i < count && status == CAMBER_OK; i++)
        if (list[i].candidate->shows_icon)
            status = add_icon(m, list[i].candidate, (uint32_t)(first_label + i));
    made.first_glyph = l->item_count;
    made.icon_count = made.first_glyph - made.first_icon;
    for (size_t i = 0; i < count && status == CAMBER_OK; i++) {
        const camber_label_candidate *c = list[i].candidate;
        const bool along = camber_label_rule_of(m->layout, c)->text_along && c->line != CAMBER_NO_PATH;
        const uint32_t label = (uint32_t)(first_label + i);
        if (c->shows_text)
            status = add_words(m, c, label);
        if (c->shows_text && status == CAMBER_OK)
            status = along ? add_along(m, c, label) : add_text(m, c, label);
    }
    made.glyph_count = l->item_count - made.first_glyph;
    if (status == CAMBER_OK && count)
        l->layers[l->layer_count++] = made;
    return status;
}

/* Copies the looks that items have; the layout may have more, of other views. Their lengths are those of the layout's
 * view. */
static camber_status take_looks(const camber_label_layout *layout, camber_labels *labels) {
    const float scale = layout->window ? (float)layout->window->scale : 1.0f;
    uint32_t *numbers = camber_alloc_zero(labels->context, layout->look_count, sizeof *numbers); /* + 1; 0: none yet */
    labels->looks = camber_alloc(labels->context, layout->look_count, sizeof *labels->looks);
    if (numbers && labels->looks)
        for (size_t i = 0; i < labels->item_count; i++) {
            uint32_t *look = &labels->items[i].look;
            if (!numbers[*look]) {
                camber_label_look *made = labels->looks + labels->look_count++;
                *made = layout->looks[*look];
                made->halo_width_px *= scale;
                made->halo_blur_px *= scale;
                numbers[*look] = (uint32_t)labels->look_count;
            }
            *look = numbers[*look] - 1;
        }
    const camber_status status = numbers && labels->looks ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    camber_free(labels->context, numbers);
    return status;
}

camber_status camber_label_items_make(camber_label_layout *layout, camber_labels *labels) {
    item_maker m = {.layout = layout, .labels = labels, .track.context = layout->context};
    labels->layers = camber_alloc(labels->context, layout->layer_count, sizeof *labels->layers);
    camber_status status = labels->layers ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < layout->layer_count && status == CAMBER_OK; i++) {
        drawn *list = NULL;
        size_t count;
        status = list_shown(layout, layout->layers + i, &list, &count);
        if (status == CAMBER_OK)
            status = make_layer(&m, layout->layers + i, list, count);
        camber_free(layout->context, list);
    }
    camber_free(layout->context, m.track.points);
    camber_free(layout->context, m.glyphs);
    camber_free(layout->context, m.run_bytes);
    return status == CAMBER_OK ? take_looks(layout, labels) : status;
}
