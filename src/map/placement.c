/* Decides which labels are shown.
 *
 * Input: candidates by layer. Output: what each shows. Main idea (MapLibre's): later layers come first, and in a layer
 * the order is by sort key, by rank, by turn on a line, then by a hash of place and words, so that the order of the
 * input does not matter. Each label in turn takes up its shapes in the picture, unless earlier labels are in the way.
 *
 * In a domain, labels outside it are not known, and may be in the way of those near its edges. So a label is unsettled
 * if a label outside might meet it, or if it meets what an earlier unsettled label may show. All others are settled: a
 * larger domain would give the same result. */
#include "base/maths.h"
#include "map/collision.h"
#include "map/label_layout.h"

#include <math.h>
#include <stdlib.h>

/* Side of a cell of the grid, CSS px. */
static const double CELL_PX = 32.0;
/* The least height of a text along a line when labels collide, em. */
static const double LEAST_HEIGHT_EM = 10.0 / 24.0;

/* A label along a line. It is recorded so that its words are not repeated too near to it. */
typedef struct said {
    uint64_t key;
    double x, y;
    uint32_t next; /* number + 1; 0: none */
} said;

typedef struct said_list {
    said *items;
    size_t count, capacity;
    uint32_t *slots; /* slot_count, a power of two */
    size_t slot_count;
} said_list;

typedef struct placer {
    camber_label_layout *layout;
    const camber_label_domain *domain; /* NULL: a view */
    camber_collision grid;
    camber_label_track track;
    camber_obstacle *shapes; /* of the current text, then of its icon */
    size_t shape_count, shape_capacity;
    said_list said;
    /* In a domain: what unsettled labels may take up and say, and whether the current label is doubtful. */
    camber_collision doubts;
    said_list doubtful;
    bool in_doubt;
    bool too_far; /* a shape of the current label reaches too far */
} placer;

/* A part of a label, as it would be placed. */
typedef struct tried {
    bool placed, vertical;
    uint8_t anchor;
    size_t first_shape, shape_count;
} tried;

/* ---- The order ---- */

typedef struct ordered {
    const camber_label_candidate *candidate;
    double keys[3]; /* the sort key, the order in the layer, the weight */
    uint64_t look;  /* a hash that decides between labels of the same words at the same place */
} ordered;

static int compare(const void *a, const void *b) {
    const ordered *p = a, *q = b;
    for (int i = 0; i < 3; i++)
        if (p->keys[i] < q->keys[i] || p->keys[i] > q->keys[i])
            return p->keys[i] < q->keys[i] ? -1 : 1;
    const camber_label_candidate *c = p->candidate, *d = q->candidate;
    if (c->rank != d->rank)
        return c->rank < d->rank ? -1 : 1;
    if (c->x < d->x || c->x > d->x)
        return c->x < d->x ? -1 : 1;
    if (c->y < d->y || c->y > d->y)
        return c->y < d->y ? -1 : 1;
    if (p->look != q->look)
        return p->look < q->look ? -1 : 1;
    return c < d ? -1 : c > d;
}

static double seen_y(const camber_label_layout *layout, const camber_label_candidate *c) {
    const double plane[2] = {c->x, c->y};
    double seen[2];
    return camber_lens_see(&layout->lens, plane, seen) > 0.0 ? seen[1] : 0.0;
}

static ordered *sort_layer(const camber_label_layout *layout, const camber_layout_layer *layer) {
    ordered *list = camber_alloc(layout->context, layer->candidate_count, sizeof *list);
    for (size_t i = 0; list && i < layer->candidate_count; i++) {
        const camber_label_candidate *c = layout->candidates + layer->first_candidate + i;
        const camber_symbol *s = &camber_label_rule_of(layout, c)->symbol;
        double order = 0.0;
        if (s->order == CAMBER_SYMBOL_ORDER_VIEWPORT_Y)
            order = -seen_y(layout, c);
        else if (s->order == CAMBER_SYMBOL_ORDER_SOURCE)
            order = c->feature;
        const bool by_key = s->has_sort_key && s->order != CAMBER_SYMBOL_ORDER_VIEWPORT_Y;
        const camber_label_form *form = layout->forms + c->form;
        list[i] = (ordered){c, {by_key ? form->sort_key : 0.0, order, form->weight}, form->look_hash};
    }
    if (list)
        qsort(list, layer->candidate_count, sizeof *list, compare);
    return list;
}

/* ---- Words that were shown nearby ---- */

static uint64_t said_key(uint64_t words, double x, double y, double distance) {
    const int64_t cell[2] = {(int64_t)floor(x / distance), (int64_t)floor(y / distance)};
    return camber_mix(camber_mix(camber_mix(0, words), (uint64_t)cell[0]), (uint64_t)cell[1]);
}

static bool is_said_near(const said_list *list, uint64_t words, double x, double y, double distance) {
    for (int i = 0; i < 9 && list->slot_count; i++) {
        const uint64_t key = said_key(words, x + (i % 3 - 1) * distance, y + (i / 3 - 1) * distance, distance);
        for (uint32_t s = list->slots[key & (list->slot_count - 1)]; s; s = list->items[s - 1].next) {
            const said *other = list->items + s - 1;
            if (other->key == key && camber_length(other->x - x, other->y - y) < distance)
                return true;
        }
    }
    return false;
}

static camber_status add_said(camber_context *context, said_list *list, said made) {
    if (!camber_grow(context, &list->items, &list->capacity, list->count + 1, sizeof *list->items))
        return CAMBER_ERROR_MEMORY;
    list->items[list->count++] = made;
    const bool wider = list->count > list->slot_count;
    if (wider) {
        uint32_t *slots = camber_alloc_zero(context, 2 * list->count, 2 * sizeof *slots);
        if (!slots)
            return CAMBER_ERROR_MEMORY;
        camber_free(context, list->slots);
        list->slots = slots;
        for (list->slot_count = 1; list->slot_count < 2 * list->count;)
            list->slot_count *= 2;
    }
    for (size_t i = wider ? 0 : list->count - 1; i < list->count; i++) {
        uint32_t *slot = list->slots + (list->items[i].key & (list->slot_count - 1));
        list->items[i].next = *slot;
        *slot = (uint32_t)i + 1;
    }
    return CAMBER_OK;
}

/* Returns how far the words of a candidate are from the next copy of the world in which they may matter, if the domain
 * is the whole world: 0 for the candidate itself, then the world's width to either side. */
static int count_copies(const placer *p) {
    return p->domain && p->domain->whole ? 3 : 1;
}

static double copy_shift(const placer *p, int copy) {
    return copy == 0 ? 0.0 : copy == 1 ? p->domain->world_px : -p->domain->world_px;
}

static camber_status say(placer *p, said_list *list, uint64_t words, const camber_label_candidate *c, double distance) {
    camber_status status = CAMBER_OK;
    for (int i = 0; i < count_copies(p) && status == CAMBER_OK; i++) {
        const double x = c->x + copy_shift(p, i);
        if (i == 0 || (x > -distance && x < p->domain->world_px + distance))
            status = add_said(p->layout->context, list, (said){said_key(words, x, c->y, distance), x, c->y, 0});
    }
    return status;
}

/* Whether labels outside the domain may be within a distance of a box. */
static bool is_exposed(const placer *p, double x0, double y0, double x1, double y1, double distance) {
    const camber_label_domain *domain = p->domain;
    return domain && !domain->whole &&
           (x0 - distance <= domain->known.x0 || y0 - distance <= domain->known.y0 ||
            x1 + distance >= domain->known.x1 || y1 + distance >= domain->known.y1);
}

/* Whether the words of a candidate are shown so near that they must not be repeated. */
static bool is_repeated(placer *p, const camber_label_candidate *c, double distance) {
    const uint64_t words = p->layout->forms[c->form].hash;
    if (is_said_near(&p->said, words, c->x, c->y, distance))
        return true;
    p->in_doubt |=
        is_exposed(p, c->x, c->y, c->x, c->y, distance) || is_said_near(&p->doubtful, words, c->x, c->y, distance);
    return false;
}

/* ---- Shapes ---- */

static camber_status add_shape(placer *p, camber_obstacle shape) {
    if (!camber_grow(p->layout->context, &p->shapes, &p->shape_capacity, p->shape_count + 1, sizeof *p->shapes))
        return CAMBER_ERROR_MEMORY;
    p->shapes[p->shape_count++] = shape;
    return CAMBER_OK;
}

/* Labels that avoid edges do not cross the edges of the picture; on paper no label does. */
static bool crosses_edge(const placer *p, const camber_obstacle *shape) {
    const camber_view *view = p->layout->view;
    return !p->domain &&
           (shape->x0 < 0.0 || shape->y0 < 0.0 || shape->x1 > (double)view->width || shape->y1 > (double)view->height);
}

/* Whether a shape that is relative to its label's anchor reaches too far from it, or around the world. Pixels may be
 * outside the shape by the margin. */
static bool reaches_too_far(const placer *p, const camber_obstacle *shape, double margin) {
    const double reach = fmin(CAMBER_LABEL_REACH_PX, 0.5 * p->domain->world_px) - margin;
    return !(shape->x0 > -reach && shape->y0 > -reach && shape->x1 < reach && shape->y1 < reach);
}

/* Whether the shapes from first on are free, and one of them is in the grid. */
static bool is_free(placer *p, size_t first, camber_symbol_overlap overlap, bool avoid_edges) {
    bool held = false, doubtful = false;
    for (size_t i = first; i < p->shape_count; i++) {
        const camber_obstacle *shape = p->shapes + i;
        if ((avoid_edges || p->layout->view->whole_labels) && crosses_edge(p, shape))
            return false;
        held |= camber_collision_holds(&p->grid, shape);
        if (camber_collision_hits(&p->grid, shape, overlap))
            return false;
        if (p->domain && overlap != CAMBER_OVERLAP_ALWAYS)
            doubtful |= is_exposed(p, shape->x0, shape->y0, shape->x1, shape->y1, CAMBER_LABEL_REACH_PX) ||
                        camber_collision_hits(&p->doubts, shape, overlap);
    }
    p->in_doubt |= doubtful;
    return held;
}

/* Adds a shape of a candidate's text or icon. In a domain it is relative to the anchor. *added is false if it is not
 * allowed. */
static camber_status put_shape(placer *p, const camber_label_candidate *c, bool of_text, camber_obstacle shape,
                               bool *added) {
    if (p->domain) {
        shape = (camber_obstacle){camber_label_snap(shape.x0), camber_label_snap(shape.y0), camber_label_snap(shape.x1),
                                  camber_label_snap(shape.y1), camber_label_snap(shape.radius)};
        *added = !reaches_too_far(p, &shape, camber_label_margin(p->layout, c->form, of_text));
        p->too_far |= !*added;
        if (!*added)
            return CAMBER_OK;
        shape.x0 += c->x;
        shape.y0 += c->y;
        shape.x1 += c->x;
        shape.y1 += c->y;
    }
    *added = true;
    return add_shape(p, shape);
}

static camber_status add_box(placer *p, const camber_label_candidate *c, const camber_label_frame *frame, bool of_text,
                             camber_box box, bool *added) {
    const camber_symbol *s = &camber_label_rule_of(p->layout, c)->symbol;
    const double *padding = of_text ? s->text.padding_px : s->icon.padding_px, ratio = p->layout->view->ratio;
    const camber_box padded = {box.x0 - padding[3] * ratio, box.y0 - padding[0] * ratio, box.x1 + padding[1] * ratio,
                               box.y1 + padding[2] * ratio};
    camber_box b;
    *added = camber_label_bounds(p->layout, frame, &padded, &b);
    if (!*added)
        return CAMBER_OK;
    return put_shape(p, c, of_text, (camber_obstacle){b.x0, b.y0, b.x1, b.y1, 0.0}, added);
}

/* ---- Text ---- */

/* Adds circles along the line, at such distances that collisions are found well. *fits is set to false if the text
 * reaches too far. */
static camber_status add_circles(placer *p, const camber_label_candidate *c, const camber_text *text, bool *fits) {
    const camber_label_rule *rule = camber_label_rule_of(p->layout, c);
    const camber_label_track *track = &p->track;
    const double nearness = camber_label_nearness(p->layout, c);
    const double height =
        fmax((double)(text->vertical ? text->right - text->left : text->bottom - text->top), LEAST_HEIGHT_EM);
    const double radius = 0.5 * height * rule->text_px * (p->layout->lens.pitched ? nearness : 1.0) +
                          rule->symbol.text.padding_px[0] * p->layout->view->ratio;
    const double first = fmax(track->first - 0.25 * radius, track->points[2]);
    const double last = fmin(track->last + 0.25 * radius, track->points[3 * track->count - 1]);
    const double length = last - first;
    const double count = length <= 0.5 * radius ? 1.0 : ceil(fmin(length / (2.5 * radius), 65536.0)) + 1.0;
    for (double i = 0.0; i < count; i += 1.0) {
        const camber_track_point point =
            camber_label_track_point(track, count > 1.0 ? first + length * i / (count - 1.0) : 0.5 * (first + last));
        double at[2] = {point.x, point.y};
        if (track->flat && !(camber_lens_see(&p->layout->lens, at, at) > 0.0))
            continue;
        bool added;
        if (put_shape(p, c, true,
                      (camber_obstacle){at[0] - radius, at[1] - radius, at[0] + radius, at[1] + radius, radius},
                      &added) != CAMBER_OK)
            return CAMBER_ERROR_MEMORY;
        *fits &= added;
    }
    return CAMBER_OK;
}

static camber_status try_along(placer *p, const camber_label_candidate *c, tried *text) {
    const camber_label_form *form = p->layout->forms + c->form;
    const camber_symbol *s = &p->layout->rules[form->rule].symbol;
    bool fits;
    camber_status status = camber_label_track_find(p->layout, c, &p->track, &fits);
    if (status != CAMBER_OK || !fits)
        return status;
    text->vertical = p->track.vertical;
    status = add_circles(p, c, text->vertical ? form->vertical : form->text, &fits);
    text->placed = status == CAMBER_OK && fits && is_free(p, text->first_shape, s->text.overlap, s->avoid_edges);
    return status;
}

/* Tries one anchor. An icon that is fitted to the text must be free, too. */
static camber_status try_anchor(placer *p, const camber_label_candidate *c, camber_symbol_overlap overlap,
                                tried *text) {
    const camber_label_form *form = p->layout->forms + c->form;
    const camber_label_rule *rule = p->layout->rules + form->rule;
    const camber_symbol *s = &rule->symbol;
    const camber_label_frame frame = camber_label_text_frame(p->layout, c);
    const size_t first = p->shape_count = text->first_shape;
    bool added;
    camber_status status =
        add_box(p, c, &frame, true, camber_label_text_box(p->layout, c, text->vertical, text->anchor), &added);
    if (status != CAMBER_OK || !added)
        return status;
    text->placed = is_free(p, first, overlap, s->avoid_edges);
    if (!text->placed || !rule->variable || !form->icon || s->text_fit == CAMBER_FIT_NONE ||
        s->icon.overlap != CAMBER_OVERLAP_NEVER)
        return CAMBER_OK;
    const camber_label_frame about = camber_label_icon_frame(p->layout, c);
    const camber_box icon = camber_label_icon_box(p->layout, c, text->vertical, text->anchor);
    status = add_box(p, c, &about, false, icon, &added);
    text->placed = status == CAMBER_OK && added && is_free(p, first + 1, overlap, s->avoid_edges);
    p->shape_count = first + 1;
    return status;
}

/* Tries the anchors of a writing mode: first without any overlap, then with the overlap that the style allows. */
static camber_status try_mode(placer *p, const camber_label_candidate *c, tried *text) {
    const camber_label_rule *rule = camber_label_rule_of(p->layout, c);
    const camber_symbol_overlap allowed = rule->symbol.text.overlap;
    const size_t rounds = rule->variable && allowed != CAMBER_OVERLAP_NEVER ? 2 : 1;
    camber_status status = CAMBER_OK;
    for (size_t round = 0; round < rounds && !text->placed; round++)
        for (size_t i = 0; i < rule->anchor_count && !text->placed && status == CAMBER_OK; i++) {
            text->anchor = (uint8_t)i;
            status = try_anchor(p, c, round + 1 < rounds ? CAMBER_OVERLAP_NEVER : allowed, text);
        }
    return status;
}

static camber_status try_text(placer *p, const camber_label_candidate *c, tried *text) {
    const camber_label_form *form = p->layout->forms + c->form;
    const camber_label_rule *rule = p->layout->rules + form->rule;
    const camber_symbol *s = &rule->symbol;
    camber_status status = CAMBER_OK;
    *text = (tried){.first_shape = p->shape_count};
    if (!form->text)
        return CAMBER_OK;
    if (rule->text_along && c->line != CAMBER_NO_PATH) {
        status = try_along(p, c, text);
    } else {
        const bool down_first = form->vertical && s->vertical_first;
        for (int i = 0; i < 2 && status == CAMBER_OK && !text->placed; i++) {
            text->vertical = down_first ? i == 0 : i == 1;
            if (text->vertical ? form->vertical != NULL : s->horizontal || !form->vertical)
                status = try_mode(p, c, text);
        }
    }
    text->shape_count = text->placed ? p->shape_count - text->first_shape : 0;
    p->shape_count = text->first_shape + text->shape_count;
    return status;
}

/* ---- Icons ---- */

static camber_status try_icon(placer *p, const camber_label_candidate *c, const tried *text, tried *icon) {
    const camber_label_form *form = p->layout->forms + c->form;
    const camber_symbol *s = &p->layout->rules[form->rule].symbol;
    *icon = (tried){.first_shape = p->shape_count};
    if (!form->icon)
        return CAMBER_OK;
    const camber_label_frame frame = camber_label_icon_frame(p->layout, c);
    const bool vertical = text->vertical && form->vertical;
    bool added;
    const camber_status status =
        add_box(p, c, &frame, false, camber_label_icon_box(p->layout, c, vertical, text->anchor), &added);
    icon->placed = status == CAMBER_OK && added && is_free(p, icon->first_shape, s->icon.overlap, s->avoid_edges);
    icon->shape_count = icon->placed ? 1 : 0;
    p->shape_count = icon->first_shape + icon->shape_count;
    return status;
}

/* ---- Labels ---- */

/* Adds a shape to a grid. If the domain is the whole world, its copies beyond the edges of the world are added, too. */
static camber_status add_to_grid(const placer *p, camber_collision *grid, const camber_obstacle *shape,
                                 camber_symbol_overlap overlap) {
    camber_status status = CAMBER_OK;
    for (int i = 0; i < count_copies(p) && status == CAMBER_OK; i++) {
        camber_obstacle copy = *shape;
        copy.x0 += copy_shift(p, i);
        copy.x1 += copy_shift(p, i);
        status = camber_collision_add(grid, &copy, overlap);
    }
    return status;
}

static camber_status take(placer *p, const tried *part, const camber_symbol_part *as, camber_label_candidate *c) {
    camber_status status = CAMBER_OK;
    for (size_t i = part->first_shape; i < part->first_shape + part->shape_count && status == CAMBER_OK; i++) {
        const camber_obstacle *shape = p->shapes + i;
        camber_box_add(&c->box, shape->x0, shape->y0);
        camber_box_add(&c->box, shape->x1, shape->y1);
        if (!as->ignore_placement)
            status = add_to_grid(p, c->unsettled ? &p->doubts : &p->grid, shape, as->overlap);
    }
    return status;
}

/* Parts that need each other are shown together or not at all. */
static void agree(const camber_label_form *form, const camber_symbol *s, tried *text, tried *icon) {
    const bool icon_needs_text = form->text && !s->text.optional, text_needs_icon = form->icon && !s->icon.optional;
    if (icon_needs_text && text_needs_icon)
        icon->placed = text->placed = icon->placed && text->placed;
    else if (text_needs_icon)
        text->placed = text->placed && icon->placed;
    else if (icon_needs_text)
        icon->placed = icon->placed && text->placed;
}

static bool is_seen(const placer *p, const camber_box *box) {
    const camber_view *view = p->layout->view;
    return box->x0 <= box->x1 &&
           (p->domain || (box->x1 > 0.0 && box->y1 > 0.0 && box->x0 < view->width && box->y0 < view->height));
}

/* Adds all shapes that a text or an icon about a point may take: at each anchor, in each direction of writing. */
static camber_status take_all_boxes(placer *p, camber_label_candidate *c, bool of_text) {
    const camber_label_form *form = p->layout->forms + c->form;
    const camber_label_rule *rule = p->layout->rules + form->rule;
    const camber_symbol_part *part = of_text ? &rule->symbol.text : &rule->symbol.icon;
    const camber_label_frame frame =
        of_text ? camber_label_text_frame(p->layout, c) : camber_label_icon_frame(p->layout, c);
    camber_status status = CAMBER_OK;
    for (int down = 0; down < (form->vertical ? 2 : 1); down++)
        for (size_t i = 0; i < rule->anchor_count && status == CAMBER_OK; i++) {
            bool added;
            p->shape_count = 0;
            const camber_box box = of_text ? camber_label_text_box(p->layout, c, down == 1, i)
                                           : camber_label_icon_box(p->layout, c, down == 1, i);
            status = add_box(p, c, &frame, of_text, box, &added);
            if (status == CAMBER_OK && added)
                status = take(p, &(tried){.shape_count = p->shape_count}, part, c);
        }
    return status;
}

/* Records what an unsettled label may take up and say. */
static camber_status take_doubtful(placer *p, camber_label_candidate *c, double near) {
    const camber_label_form *form = p->layout->forms + c->form;
    const camber_label_rule *rule = p->layout->rules + form->rule;
    camber_status status = CAMBER_OK;
    c->unsettled = true;
    if (form->text && rule->text_along && c->line != CAMBER_NO_PATH) {
        bool fits;
        p->shape_count = 0;
        status = camber_label_track_find(p->layout, c, &p->track, &fits);
        if (status == CAMBER_OK && fits)
            status = add_circles(p, c, p->track.vertical ? form->vertical : form->text, &fits);
        if (status == CAMBER_OK && fits)
            status = take(p, &(tried){.shape_count = p->shape_count}, &rule->symbol.text, c);
    } else if (form->text) {
        status = take_all_boxes(p, c, true);
    }
    if (status == CAMBER_OK && form->icon)
        status = take_all_boxes(p, c, false);
    return status == CAMBER_OK && near > 0.0 ? say(p, &p->doubtful, form->hash, c, near) : status;
}

/* Whether the label shows nothing, whatever the labels are that are not settled: more of them leave less room. An icon
 * may depend on where its text is. */
static bool is_hidden(const camber_label_rule *rule, const tried *text, const tried *icon) {
    return !text->placed && !icon->placed && !(rule->variable && rule->symbol.text_fit != CAMBER_FIT_NONE);
}

static camber_status place_one(placer *p, camber_label_candidate *c) {
    const camber_label_form *form = p->layout->forms + c->form;
    const camber_label_rule *rule = p->layout->rules + form->rule;
    const camber_symbol *s = &rule->symbol;
    const double near = form->text ? s->repeat_px * camber_label_whole_zoom_px(p->layout->view) : 0.0;
    tried text, icon;
    c->box = CAMBER_BOX_EMPTY;
    p->shape_count = 0;
    p->in_doubt = p->too_far = false;
    if (!(camber_label_nearness(p->layout, c) > 0.0) || (near > 0.0 && is_repeated(p, c, near)))
        return CAMBER_OK;
    camber_status status = try_text(p, c, &text);
    if (status == CAMBER_OK)
        status = try_icon(p, c, &text, &icon);
    if (status != CAMBER_OK)
        return status;
    agree(form, s, &text, &icon);
    if (p->too_far && !text.placed && !icon.placed)
        p->layout->too_far = c->form;
    if (p->in_doubt && !is_hidden(rule, &text, &icon))
        return take_doubtful(p, c, near);
    if (text.placed)
        status = take(p, &text, &s->text, c);
    if (icon.placed && status == CAMBER_OK)
        status = take(p, &icon, &s->icon, c);
    if (status == CAMBER_OK && near > 0.0 && text.placed)
        status = say(p, &p->said, form->hash, c, near);
    const bool seen = is_seen(p, &c->box);
    c->shows_text = text.placed && seen;
    c->shows_icon = icon.placed && seen;
    c->vertical = text.vertical && form->vertical;
    c->anchor = text.placed ? text.anchor : 0;
    return status;
}

static void forget_words(said_list *list) {
    list->count = 0;
    for (size_t i = 0; i < list->slot_count; i++)
        list->slots[i] = 0;
}

static camber_status place_layer(placer *p, const camber_layout_layer *layer) {
    ordered *list = sort_layer(p->layout, layer);
    camber_status status = list ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    const uint32_t before = p->layout->too_far;
    forget_words(&p->said);
    forget_words(&p->doubtful);
    for (size_t i = 0; i < layer->candidate_count && status == CAMBER_OK; i++)
        status = place_one(p, p->layout->candidates + (list[i].candidate - p->layout->candidates));
    if (p->layout->too_far != before)
        p->layout->too_far_layer = layer->layer;
    camber_free(p->layout->context, list);
    return status;
}

/* Returns the part of the plane in which labels collide. */
static camber_box find_bounds(const camber_label_layout *layout) {
    const camber_view *view = layout->view;
    const double margin = CAMBER_LABEL_MARGIN_PX * view->ratio, reach = CAMBER_LABEL_REACH_PX;
    if (!layout->domain)
        return (camber_box){-margin, -margin, view->width + margin, view->height + margin};
    camber_box box = CAMBER_BOX_EMPTY;
    for (size_t i = 0; i < layout->candidate_count; i++)
        camber_box_add(&box, layout->candidates[i].x, layout->candidates[i].y);
    return (camber_box){box.x0 - reach, box.y0 - reach, box.x1 + reach, box.y1 + reach};
}

camber_status camber_label_place_all(camber_label_layout *layout) {
    camber_context *context = layout->context;
    placer p = {.layout = layout, .domain = layout->domain, .track.context = context};
    layout->too_far = CAMBER_NO_FORM;
    if (layout->candidate_count == 0)
        return CAMBER_OK;
    const camber_box bounds = find_bounds(layout);
    camber_status status = camber_collision_make(context, bounds, CELL_PX * layout->view->ratio, &p.grid);
    if (status == CAMBER_OK && p.domain)
        status = camber_collision_make(context, bounds, CELL_PX * layout->view->ratio, &p.doubts);
    for (size_t i = layout->layer_count; i-- > 0 && status == CAMBER_OK;)
        status = place_layer(&p, layout->layers + i);
    camber_collision_free(&p.grid);
    if (p.domain)
        camber_collision_free(&p.doubts);
    camber_free(context, p.track.points);
    camber_free(context, p.shapes);
    camber_free(context, p.said.items);
    camber_free(context, p.said.slots);
    camber_free(context, p.doubtful.items);
    camber_free(context, p.doubtful.slots);
    return status;
}
