/* Places the labels of a whole zoom, block by block, and keeps those that are shown.
 *
 * Input: the things of a set of features, and a zoom. Output: the items of the labels in any picture of the zoom. Main
 * idea: which labels are shown is decided in one order, so a label depends only on those before it that it meets, on
 * those that these meet, and so on. A block is placed with a margin; if a label in it is not settled, with a wider one.
 *
 *     +----------------+
 *     |     margin     |    labels in the margin are placed only to settle those in the block
 *     |   +--------+   |
 *     |   | block  |   |
 *     |   +--------+   |
 *     +----------------+ */
#include "map/zoom_labels.h"

#include "base/maths.h"
#include "map/label_layout.h"

#include <math.h>

/* The width of the world at zoom 0, CSS px. */
static const double WORLD_PX = 512.0;
/* The margin that is tried first, and how much wider each next one is. */
static const double FIRST_MARGIN_PX = 1.75 * CAMBER_LABEL_REACH_PX, WIDER = 2.0;
/* The width of blocks where several small ones are wanted: with the first margin, 2.1 times its area is placed, but of
 * a tile of 256 px 64 times. */
static const double GROWN_PX = 4096.0;
/* About the memory that a label takes which is kept. */
enum { LABEL_BYTES = 1024 };

typedef struct camber_label_block label_block;
struct camber_label_block {
    label_block *next; /* less recently used */
    const camber_zoom_labels *owner;
    camber_label_square square;
    camber_box box; /* of the square, or of a picture, px of the world */
    camber_label_domain domain;
    camber_label_layout layout; /* with the labels that touch the box; their boxes are around their pixels */
    size_t bytes;
};

struct camber_zoom_labels {
    camber_context *context;
    camber_zoom_labels_desc desc;
    camber_view view; /* its px are those of the world */
};

camber_status camber_zoom_labels_create(const camber_zoom_labels_desc *desc, camber_zoom_labels **labels) {
    if (desc->shelf && camber_label_things_make_tree(desc->things) != CAMBER_OK)
        return CAMBER_ERROR_MEMORY;
    camber_zoom_labels *made = camber_alloc_zero(desc->features->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = desc->features->context;
    made->desc = *desc;
    made->view =
        (camber_view){.zoom = desc->zoom, .scale_px = WORLD_PX * camber_exp2(desc->zoom), .cosine = 1.0, .ratio = 1.0};
    *labels = made;
    return CAMBER_OK;
}

static void free_block(label_block *block) {
    camber_label_layout_free(&block->layout);
    camber_free(block->layout.context, block);
}

void camber_zoom_labels_destroy(camber_zoom_labels *labels) {
    if (!labels)
        return;
    for (label_block **at = labels->desc.shelf ? &labels->desc.shelf->blocks : NULL; at && *at;) {
        label_block *block = *at;
        if (block->owner == labels) {
            *at = block->next;
            labels->desc.shelf->held_bytes -= block->bytes;
            free_block(block);
        } else {
            at = &block->next;
        }
    }
    camber_free(labels->context, labels);
}

/* ---- Boxes ---- */

/* Returns the box of a square, in px of the world. */
static camber_box box_of(const camber_zoom_labels *z, const camber_label_square *square, double margin_px) {
    const double size = z->view.scale_px / exp2(square->level);
    return (camber_box){square->column * size - margin_px, square->row * size - margin_px,
                        (square->column + 1.0) * size + margin_px, (square->row + 1.0) * size + margin_px};
}

static camber_box scale(const camber_box *box, double by) {
    return (camber_box){box->x0 * by, box->y0 * by, box->x1 * by, box->y1 * by};
}

static bool meet(const camber_box *a, const camber_box *b) {
    return a->x0 < b->x1 && a->x1 > b->x0 && a->y0 < b->y1 && a->y1 > b->y0;
}

static camber_box widen(const camber_box *box, double by) {
    return (camber_box){box->x0 - by, box->y0 - by, box->x1 + by, box->y1 + by};
}

/* Returns in which copies of the world a label touches a box, as bits: bit i for the copy that is moved by i - 1. If
 * the domain is not the whole world, each copy is a label by itself. */
static unsigned find_copies(const label_block *block, const camber_box *label, const camber_box *box) {
    unsigned copies = 0;
    for (int i = 0; i < 3; i++) {
        const double shift = (i - 1) * block->domain.world_px;
        const camber_box moved = {label->x0 + shift, label->y0, label->x1 + shift, label->y1};
        if ((i == 1 || block->domain.whole) && meet(&moved, box))
            copies |= 1u << i;
    }
    return copies;
}

/* ---- Pixels of labels ---- */

/* Returns a box around the pixels that a label draws, none of which is out of reach. */
static camber_box find_pixels(camber_label_layout *layout, const camber_label_candidate *c) {
    const double reach = CAMBER_LABEL_REACH_PX;
    double margin = 0.0;
    if (c->shows_icon)
        margin = fmax(margin, camber_label_margin(layout, c->form, false));
    if (c->shows_text)
        margin = fmax(margin, camber_label_margin(layout, c->form, true));
    const camber_box wide = widen(&c->box, margin);
    return (camber_box){fmax(wide.x0, c->x - reach), fmax(wide.y0, c->y - reach), fmin(wide.x1, c->x + reach),
                        fmin(wide.y1, c->y + reach)};
}

/* ---- Placing a block ---- */

/* Whether all labels that may touch a box in the block's surroundings are settled. */
static bool is_settled(label_block *block, const camber_box *box) {
    camber_label_layout *l = &block->layout;
    for (size_t i = 0; i < l->candidate_count; i++) {
        const camber_label_candidate *c = l->candidates + i;
        if (!c->unsettled || c->box.x0 > c->box.x1)
            continue;
        camber_label_candidate all = *c;
        all.shows_text = l->forms[c->form].text != NULL;
        all.shows_icon = l->forms[c->form].icon != NULL;
        const camber_box pixels = find_pixels(l, &all);
        if (find_copies(block, &pixels, box))
            return false;
    }
    return true;
}

/* Warns once of labels that are left out because they reach too far, which does not surprise where the world is small.
 */
static void tell_too_far(const camber_zoom_labels *z, const camber_label_layout *l) {
    if (l->too_far == CAMBER_NO_FORM || z->desc.things->told_too_far || z->view.scale_px < 2.0 * CAMBER_LABEL_REACH_PX)
        return;
    const char *words = l->forms[l->too_far].words;
    camber_log(
        z->context, CAMBER_LOG_WARNING,
        "labels: %s of layer %s reaches more than %g px from its anchor and is left out, as all such labels are; "
        "make it smaller or its halo thinner, or break it into lines",
        words ? words : "an icon", l->features->style->layers[l->too_far_layer].id, CAMBER_LABEL_REACH_PX);
    z->desc.things->told_too_far = true;
}

/* Selects the things that may have labels in a block's surroundings, unless these are all things, or go around the
 * world. Then the domain is the whole world. */
static camber_status find_domain(const camber_zoom_labels *z, const camber_box *known, camber_label_domain *domain,
                                 camber_label_things *near) {
    const double world = z->view.scale_px;
    *domain = (camber_label_domain){.known = *known, .world_px = world};
    *near = (camber_label_things){0};
    if (known->x1 - known->x0 + 2.0 * CAMBER_LABEL_REACH_PX <= world) {
        const camber_box seen = scale(known, 1.0 / world);
        const camber_status status = camber_label_things_select(z->desc.things, &seen, near);
        if (status != CAMBER_OK || near->count < z->desc.things->count)
            return status;
    }
    *domain = (camber_label_domain){.known = {0.0, -INFINITY, world, INFINITY}, .whole = true, .world_px = world};
    return CAMBER_OK;
}

static camber_status place_with_margin(camber_zoom_labels *z, label_block *block, double margin_px, bool *settled) {
    const camber_box known = widen(&block->box, margin_px);
    camber_label_things near;
    camber_status status = find_domain(z, &known, &block->domain, &near);
    camber_label_layout_free(&block->layout);
    block->layout = (camber_label_layout){
        .context = z->context,
        .features = z->desc.features,
        .view = &z->view,
        .things = block->domain.whole ? z->desc.things : &near,
        .domain = &block->domain,
        .least_importance = (double)(float)fmax(CAMBER_LABEL_SIMPLIFY_PX / z->view.scale_px, z->desc.least_importance),
        .fonts = z->desc.features->fonts,
        .sprites = z->desc.features->sprites};
    if (status == CAMBER_OK)
        status = camber_label_layout_make(&block->layout);
    if (status == CAMBER_OK)
        status = camber_label_place_all(&block->layout);
    block->layout.things = NULL;
    camber_label_things_free(&near);
    if (status == CAMBER_OK)
        tell_too_far(z, &block->layout);
    *settled = status == CAMBER_OK && is_settled(block, &block->box);
    return status;
}

/* ---- Keeping what is shown ---- */

/* Whether a shelf has room for the shown labels that touch a box, together with as many others. */
static bool has_room(const camber_label_shelf *shelf, label_block *block, const camber_box *box) {
    const camber_label_layout *l = &block->layout;
    size_t bytes = 0;
    for (size_t i = 0; i < l->candidate_count; i++) {
        const camber_label_candidate *c = l->candidates + i;
        if ((c->shows_text || c->shows_icon) && find_copies(block, &c->box, box))
            bytes += LABEL_BYTES;
    }
    return bytes <= shelf->limit_bytes / 2;
}

/* Gives the block the largest square around its own whose labels are settled, too. So labels that depend on each other
 * far across the map, which need a wide margin, are not placed again for each of the blocks there. */
static void widen_block(const camber_zoom_labels *z, label_block *block, const camber_label_square *square) {
    camber_label_square wider = block->square = *square;
    const camber_box *known = &block->domain.known;
    while (wider.level > 0) {
        wider = (camber_label_square){wider.level - 1, wider.column / 2, wider.row / 2};
        const camber_box box = box_of(z, &wider, 0.0), reached = box_of(z, &wider, CAMBER_LABEL_REACH_PX);
        const bool inside = block->domain.whole || (reached.x0 >= known->x0 && reached.y0 >= known->y0 &&
                                                    reached.x1 <= known->x1 && reached.y1 <= known->y1);
        if (!inside || !is_settled(block, &box) || !has_room(z->desc.shelf, block, &box))
            break;
        block->square = wider;
        block->box = box;
    }
}

/* Moves the forms and lines that are used to the front of their arrays. numbers: those of forms, then of lines. */
static void close_up(camber_label_layout *l, uint32_t *numbers) {
    uint32_t *lines = numbers + l->form_count, forms_kept = 0, lines_kept = 0;
    size_t points = 0;
    for (size_t i = 0; i < l->form_count; i++)
        if (numbers[i]) {
            l->forms[forms_kept] = l->forms[i];
            numbers[i] = forms_kept++;
        }
    for (size_t i = 0; i < l->line_count; i++)
        if (lines[i]) {
            camber_label_line line = l->lines[i];
            memmove(l->line_points + 2 * points, l->line_points + 2 * line.first,
                    2 * line.count * sizeof *l->line_points);
            line.first = points;
            points += line.count;
            l->lines[lines_kept] = line;
            lines[i] = lines_kept++;
        }
    l->form_count = forms_kept;
    l->line_count = lines_kept;
    l->line_point_count = points;
    for (size_t i = 0; i < l->candidate_count; i++) {
        camber_label_candidate *c = l->candidates + i;
        c->form = numbers[c->form];
        c->line = c->line == CAMBER_NO_PATH ? CAMBER_NO_PATH : lines[c->line];
    }
}

static bool shrink(camber_context *context, void *array, size_t *capacity, size_t count, size_t item_bytes) {
    void *held, *made;
    memcpy(&held, array, sizeof held);
    if (!held || *capacity == count)
        return true;
    if (!(made = camber_alloc(context, count ? count : 1, item_bytes)))
        return false;
    if (count)
        memcpy(made, held, count * item_bytes);
    camber_free(context, held);
    memcpy(array, &made, sizeof made);
    *capacity = count ? count : 1;
    return true;
}

static size_t count_bytes(const camber_label_layout *l) {
    size_t bytes = sizeof(label_block) + l->candidate_count * sizeof *l->candidates + l->form_count * sizeof *l->forms +
                   l->line_count * sizeof *l->lines + 2 * l->line_point_count * sizeof *l->line_points +
                   l->rule_count * sizeof *l->rules + l->run_count * sizeof *l->runs + l->look_count * sizeof *l->looks;
    for (size_t i = 0; i < l->form_count; i++)
        bytes += l->forms[i].text ? sizeof(camber_text) + l->forms[i].text->glyph_count * sizeof(camber_text_glyph) : 0;
    return bytes;
}

/* Drops all labels but those that are shown and touch the block. */
static camber_status keep_shown(label_block *block) {
    camber_label_layout *l = &block->layout;
    uint32_t *numbers = camber_alloc_zero(l->context, l->form_count + l->line_count, sizeof *numbers);
    size_t kept = 0;
    if (!numbers)
        return CAMBER_ERROR_MEMORY;
    for (size_t k = 0; k < l->layer_count; k++) {
        camber_layout_layer *layer = l->layers + k;
        const size_t first = layer->first_candidate, end = first + layer->candidate_count;
        layer->first_candidate = kept;
        for (size_t i = first; i < end; i++) {
            camber_label_candidate c = l->candidates[i];
            if (!c.shows_text && !c.shows_icon)
                continue;
            c.box = find_pixels(l, &c);
            if (!find_copies(block, &c.box, &block->box))
                continue;
            numbers[c.form] = 1;
            if (c.line != CAMBER_NO_PATH)
                numbers[l->form_count + c.line] = 1;
            l->candidates[kept++] = c;
        }
        layer->candidate_count = kept - layer->first_candidate;
    }
    l->candidate_count = kept;
    close_up(l, numbers);
    camber_free(l->context, numbers);
    camber_status status = camber_label_words_keep(l);
    if (status == CAMBER_OK &&
        !(shrink(l->context, &l->candidates, &l->candidate_capacity, l->candidate_count, sizeof *l->candidates) &&
          shrink(l->context, &l->forms, &l->form_capacity, l->form_count, sizeof *l->forms) &&
          shrink(l->context, &l->lines, &l->line_capacity, l->line_count, sizeof *l->lines) &&
          shrink(l->context, &l->line_points, &l->line_point_capacity, l->line_point_count,
                 2 * sizeof *l->line_points)))
        status = CAMBER_ERROR_MEMORY;
    block->bytes = count_bytes(l);
    return status;
}

/* Makes the block that has the labels in a box. */
static camber_status make_block(camber_zoom_labels *z, const camber_box *box, const camber_label_square *square,
                                label_block **made) {
    camber_status status = CAMBER_OK;
    bool settled = false;
    label_block *block = camber_alloc_zero(z->context, 1, sizeof *block);
    if (!block)
        return CAMBER_ERROR_MEMORY;
    block->owner = z;
    block->box = *box;
    block->layout.context = z->context;
    for (double margin = FIRST_MARGIN_PX; !settled && status == CAMBER_OK; margin *= WIDER)
        status = place_with_margin(z, block, margin, &settled);
    if (status == CAMBER_OK && square)
        widen_block(z, block, square);
    if (status == CAMBER_OK)
        status = keep_shown(block);
    if (status == CAMBER_OK)
        *made = block;
    else
        free_block(block);
    return status;
}

/* ---- Finding blocks ---- */

static bool is_divided(const camber_zoom_labels *z, const camber_label_square *square) {
    return square->level < z->desc.finest_level && z->desc.things->count > z->desc.block_things &&
           (z->desc.block_things == 0 || camber_label_things_count(z->desc.things, square) > z->desc.block_things);
}

static bool is_inside(const camber_label_square *square, const camber_label_square *outer) {
    const int shift = square->level - outer->level;
    return shift >= 0 && outer->column == square->column >> shift && outer->row == square->row >> shift;
}

/* Drops the least recently used blocks but the first one, until all take little memory. */
static void drop_old(camber_label_shelf *shelf) {
    while (shelf->held_bytes > shelf->limit_bytes && shelf->blocks->next) {
        label_block **last = &shelf->blocks->next;
        while ((*last)->next)
            last = &(*last)->next;
        shelf->held_bytes -= (*last)->bytes;
        free_block(*last);
        *last = NULL;
    }
}

/* Returns the square for which labels are placed if those of a square are wanted. It is the square itself at first, so
 * that the first picture is soon there, and a large one if labels near it were wanted before. */
static camber_label_square grow(const camber_zoom_labels *z, const camber_label_square *square) {
    camber_label_square wide = *square;
    while (z->desc.block_things == 0 && wide.level > 0 && z->view.scale_px / exp2(wide.level) < GROWN_PX)
        wide = (camber_label_square){wide.level - 1, wide.column / 2, wide.row / 2};
    for (const label_block *block = z->desc.shelf->blocks; block; block = block->next)
        if (block->owner == z && is_inside(&block->square, &wide))
            return wide;
    return *square;
}

/* Finds a block that has the labels of a square, or places it. It is valid until the next call. */
static camber_status get_block(camber_zoom_labels *z, const camber_label_square *square, label_block **found) {
    camber_label_shelf *shelf = z->desc.shelf;
    label_block **at = &shelf->blocks, *block = NULL;
    while (*at && !((*at)->owner == z && is_inside(square, &(*at)->square)))
        at = &(*at)->next;
    if (*at) {
        block = *at;
        *at = block->next;
    } else {
        const camber_label_square placed = grow(z, square);
        const camber_box box = box_of(z, &placed, 0.0);
        const camber_status status = make_block(z, &box, &placed, &block);
        if (status != CAMBER_OK)
            return status;
        shelf->held_bytes += block->bytes;
        shelf->placed++;
    }
    block->next = shelf->blocks;
    shelf->blocks = *found = block;
    drop_old(shelf);
    return CAMBER_OK;
}

/* Finds a block that contains a square of the finest level. */
static camber_status find_block(camber_zoom_labels *z, const camber_label_square *square, label_block **found) {
    camber_label_square at = {0};
    while (is_divided(z, &at)) {
        const int level = at.level + 1, shift = square->level - level;
        at = (camber_label_square){level, square->column >> shift, square->row >> shift};
    }
    return get_block(z, &at, found);
}

/* ---- Drawing ---- */

/* Copies the labels that touch a box into a layout for a picture. */
static camber_status select_labels(const label_block *block, const camber_box *box, camber_label_layout *made) {
    const camber_label_layout *l = &block->layout;
    made->candidates = NULL;
    made->candidate_count = made->candidate_capacity = 0;
    if (!(made->layers = camber_alloc(l->context, l->layer_count, sizeof *made->layers)))
        return CAMBER_ERROR_MEMORY;
    for (size_t k = 0; k < l->layer_count; k++) {
        const camber_layout_layer *layer = l->layers + k;
        made->layers[k] = (camber_layout_layer){layer->layer, made->candidate_count, 0};
        for (size_t i = layer->first_candidate; i < layer->first_candidate + layer->candidate_count; i++) {
            const unsigned copies = find_copies(block, &l->candidates[i].box, box);
            for (int n = 0; n < 3; n++) {
                if (!(copies >> n & 1))
                    continue;
                if (!camber_grow(l->context, &made->candidates, &made->candidate_capacity, made->candidate_count + 1,
                                 sizeof *made->candidates))
                    return CAMBER_ERROR_MEMORY;
                camber_label_candidate *c = made->candidates + made->candidate_count++;
                *c = l->candidates[i];
                c->x += (n - 1) * block->domain.world_px;
                c->box.x0 += (n - 1) * block->domain.world_px;
                c->box.x1 += (n - 1) * block->domain.world_px;
            }
        }
        made->layers[k].candidate_count = made->candidate_count - made->layers[k].first_candidate;
    }
    return CAMBER_OK;
}

static camber_label_window window_of(const camber_zoom_labels *z, const camber_view *picture) {
    return (camber_label_window){.scale = picture->scale_px / z->view.scale_px,
                                 .origin_px = {picture->x * picture->scale_px - 0.5 * picture->width,
                                               picture->y * picture->scale_px - 0.5 * picture->height}};
}

/* Returns the box of a picture, px of the world. */
static camber_box picture_box(const camber_label_window *window, const camber_view *picture) {
    const double left = window->origin_px[0], top = window->origin_px[1];
    const camber_box box = {left, top, left + picture->width, top + picture->height};
    return scale(&box, 1.0 / window->scale);
}

/* Makes the items of a block's labels in a picture. */
static camber_status draw_block(const label_block *block, const camber_label_window *window, const camber_view *picture,
                                camber_labels *drawn) {
    const camber_box box = picture_box(window, picture);
    camber_label_layout layout = block->layout;
    layout.domain = &block->domain;
    layout.window = window;
    camber_status status = select_labels(block, &box, &layout);
    if (status == CAMBER_OK)
        status = camber_label_items_make(&layout, drawn);
    camber_free(layout.context, layout.layers);
    camber_free(layout.context, layout.candidates);
    return status;
}

camber_status camber_zoom_labels_draw(camber_zoom_labels *z, const camber_label_square *square,
                                      const camber_view *picture, camber_labels *drawn) {
    const camber_label_window window = window_of(z, picture);
    label_block *block;
    *drawn = (camber_labels){.context = z->context};
    const camber_status status = find_block(z, square, &block);
    return status == CAMBER_OK ? draw_block(block, &window, picture, drawn) : status;
}

/* ---- Single pictures ---- */

static bool avoids_edges(const camber_style *style) {
    for (size_t i = 0; i < style->layer_count; i++)
        if (style->layers[i].kind == CAMBER_LAYER_SYMBOL && style->layers[i].properties[CAMBER_SYMBOL_AVOID_EDGES])
            return true;
    return false;
}

bool camber_view_has_zoom_labels(const camber_style *style, const camber_view *view) {
    const double ratio = view->scale_px / (WORLD_PX * exp2(view->zoom));
    return view->zoom >= 0.0 && fabs(view->zoom - floor(view->zoom + 0.5)) < 1e-9 && fabs(view->bearing_deg) <= 0.0 &&
           !(view->pitch_deg > 0.0) && fabs(ratio - view->ratio) < 1e-9 * ratio && view->width <= view->scale_px &&
           !view->whole_labels && !avoids_edges(style);
}

camber_status camber_zoom_labels_place_view(const camber_features *features, const camber_view *view,
                                            double simplify_px, camber_labels *drawn) {
    camber_label_things things;
    camber_zoom_labels *z = NULL;
    label_block *block = NULL;
    *drawn = (camber_labels){.context = features->context};
    camber_status status = camber_label_things_find(features, NULL, &things);
    const camber_zoom_labels_desc desc = {.features = features,
                                          .things = &things,
                                          .zoom = floor(view->zoom + 0.5),
                                          .least_importance = (double)(float)(simplify_px / view->scale_px)};
    if (status == CAMBER_OK)
        status = camber_zoom_labels_create(&desc, &z);
    if (status == CAMBER_OK) {
        const camber_label_window window = window_of(z, view);
        const camber_box box = picture_box(&window, view);
        status = make_block(z, &box, NULL, &block);
        if (status == CAMBER_OK)
            status = draw_block(block, &window, view, drawn);
    }
    if (block)
        free_block(block);
    camber_zoom_labels_destroy(z);
    camber_label_things_free(&things);
    return status;
}

/* ---- Listing ---- */

/* Hashes everything that a label's pixels depend on. Of its line only the points near it matter. */
static uint64_t hash_label(const camber_label_layout *l, const camber_label_candidate *c) {
    const camber_label_form *form = l->forms + c->form;
    const uint64_t shows =
        (uint64_t)c->shows_text | (uint64_t)c->shows_icon << 1 | (uint64_t)c->vertical << 2 | (uint64_t)c->anchor << 8;
    uint64_t hash = camber_mix(camber_mix(c->rank, form->look_hash), shows);
    if (c->line == CAMBER_NO_PATH)
        return hash;
    const camber_label_line *line = l->lines + c->line;
    for (size_t i = line->first; i < line->first + line->count; i++) {
        const double at[2] = {c->line_x + (double)l->line_points[2 * i], c->line_y + (double)l->line_points[2 * i + 1]};
        if (fabs(at[0]) < CAMBER_LABEL_REACH_PX && fabs(at[1]) < CAMBER_LABEL_REACH_PX)
            hash = camber_mix_point(hash, at);
    }
    return hash;
}

typedef struct listing {
    camber_zoom_labels *labels;
    const camber_box *area;
    camber_shown_label_fn *take;
    void *user;
} listing;

static camber_status list_block(const listing *of, const camber_label_square *square) {
    camber_zoom_labels *z = of->labels;
    label_block *block;
    camber_status status = get_block(z, square, &block);
    const camber_box box = box_of(z, square, 0.0);
    for (size_t i = 0; status == CAMBER_OK && i < block->layout.candidate_count; i++) {
        const camber_label_candidate *c = block->layout.candidates + i;
        const unsigned copies = find_copies(block, &c->box, &box);
        for (int n = 0; n < 3 && status == CAMBER_OK; n++) {
            if (!(copies >> n & 1))
                continue;
            const double shift = (n - 1) * block->domain.world_px;
            const camber_box moved = {c->box.x0 + shift, c->box.y0, c->box.x1 + shift, c->box.y1};
            const camber_shown_label shown = {scale(&moved, 1.0 / z->view.scale_px), hash_label(&block->layout, c)};
            status = of->take(of->user, square, &shown);
        }
    }
    return status;
}

/* Lists the blocks in a square. */
static camber_status list_square(const listing *of, const camber_label_square *square) {
    camber_zoom_labels *z = of->labels;
    const camber_box px = box_of(z, square, 0.0), reached = box_of(z, square, CAMBER_LABEL_REACH_PX);
    const camber_box box = scale(&px, 1.0 / z->view.scale_px), wide = scale(&reached, 1.0 / z->view.scale_px);
    camber_status status = CAMBER_OK;
    if (!camber_label_find_worlds(of->area, &box) || !camber_label_things_touch(z->desc.things, &wide))
        return CAMBER_OK;
    if (!is_divided(z, square))
        return list_block(of, square);
    for (uint32_t i = 0; i < 4 && status == CAMBER_OK; i++) {
        const camber_label_square quarter = {square->level + 1, 2 * square->column + i % 2, 2 * square->row + i / 2};
        status = list_square(of, &quarter);
    }
    return status;
}

camber_status camber_zoom_labels_list(camber_zoom_labels *labels, const camber_box *area, camber_shown_label_fn *take,
                                      void *user) {
    const listing of = {labels, area, take, user};
    return list_square(&of, &(camber_label_square){0});
}
