/* Finds where the labels of a view may be placed.
 *
 * Input: features, a view. Output: candidates by layer. Main idea: the features that the view may see are found once,
 * and sorted by class. Each layer is then evaluated once per class, because all features of a class give the same
 * result. */
#include "map/label_layout.h"

#include "features/rings.h"

#include <math.h>

/* How far outside the picture an anchor may be if its label reaches into the picture, CSS px. */
static const double REACH_PX = 320.0;

/* The tolerance to which lines are simplified, as for drawing, device px. */
static const double SIMPLIFY_PX = 0.25;

/* Polylines that the view may see: all rings of an area, one line, or one polyline of points. */
typedef struct thing {
    uint32_t class, feature;
    size_t first_polyline, end_polyline;
    uint8_t worlds; /* bit i: the copy of the world that is moved by i - 1 */
} thing;

typedef struct layout_maker {
    camber_label_layout *layout;
    camber_box corners; /* box around what is seen, world coordinates */
    camber_box seen;    /* the same, widened by the reach of the current labels */
    double least_importance;
    thing *things; /* sorted by class */
    size_t thing_count, thing_capacity;
    size_t *class_things; /* class_count + 1 */
    const camber_layer_look *look;
    uint32_t form;
    camber_label_path path; /* of the current line, px from origin */
    size_t path_capacity[2];
    double origin[2]; /* world coordinates of its first point */
    camber_path_anchors anchors;
    size_t *ring_offsets;
    size_t ring_capacity;
} layout_maker;

/* ---- Things ---- */

static bool is_label(camber_geometry_kind kind) {
    return kind == CAMBER_GEOMETRY_LABEL_LINE || kind == CAMBER_GEOMETRY_LABEL_AREA ||
           kind == CAMBER_GEOMETRY_LABEL_POINT;
}

double camber_label_whole_zoom_px(const camber_view *view) {
    const double zoom = camber_view_style_zoom(view);
    return view->ratio * exp2(zoom - floor(zoom));
}

/* Returns the box around the quadrangle that is seen. */
static camber_box find_corners(const camber_label_layout *layout) {
    double corners[8];
    camber_view_corners(layout->view, corners);
    camber_box box = CAMBER_BOX_EMPTY;
    for (int i = 0; i < 4; i++)
        camber_box_add(&box, corners[2 * i], corners[2 * i + 1]);
    return box;
}

/* Widens what is seen by a reach in device px. */
static void set_reach(layout_maker *m, double reach_px) {
    const double reach = reach_px / m->layout->view->scale_px;
    m->seen = (camber_box){m->corners.x0 - reach, m->corners.y0 - reach, m->corners.x1 + reach, m->corners.y1 + reach};
}

static uint8_t find_worlds(const layout_maker *m, const camber_box *box) {
    uint8_t worlds = 0;
    for (int i = 0; i < 3; i++)
        if (box->x0 + (i - 1) <= m->seen.x1 && box->x1 + (i - 1) >= m->seen.x0 && box->y0 <= m->seen.y1 &&
            box->y1 >= m->seen.y0)
            worlds |= (uint8_t)(1 << i);
    return worlds;
}

static bool is_finite(const double *point) {
    return isfinite(point[0]) && isfinite(point[1]);
}

static camber_box box_of(const camber_features *f, size_t first_polyline, size_t end_polyline) {
    camber_box box = CAMBER_BOX_EMPTY;
    for (size_t i = f->offsets[first_polyline]; i < f->offsets[end_polyline]; i++)
        if (is_finite(f->points + 2 * i))
            camber_box_add(&box, f->points[2 * i], f->points[2 * i + 1]);
    return box;
}

static camber_status add_thing(layout_maker *m, size_t first_polyline, size_t end_polyline) {
    const camber_features *f = m->layout->features;
    const camber_box box = box_of(f, first_polyline, end_polyline);
    const uint8_t worlds = box.x0 <= box.x1 ? find_worlds(m, &box) : 0;
    if (!worlds)
        return CAMBER_OK;
    if (!camber_grow(f->context, &m->things, &m->thing_capacity, m->thing_count + 1, sizeof *m->things))
        return CAMBER_ERROR_MEMORY;
    const uint32_t feature = f->polyline_feature[first_polyline];
    m->things[m->thing_count++] = (thing){.class = f->feature_class[feature],
                                          .feature = feature,
                                          .first_polyline = first_polyline,
                                          .end_polyline = end_polyline,
                                          .worlds = worlds};
    return CAMBER_OK;
}

static camber_status find_things(layout_maker *m) {
    const camber_features *f = m->layout->features;
    camber_status status = CAMBER_OK;
    for (size_t p = 0, next; p < f->polyline_count && status == CAMBER_OK; p = next) {
        const camber_geometry_kind kind = camber_features_kind(f, p);
        next = p + 1;
        if (kind == CAMBER_GEOMETRY_LABEL_AREA)
            while (next < f->polyline_count && f->polyline_feature[next] == f->polyline_feature[p])
                next++;
        if (is_label(kind))
            status = add_thing(m, p, next);
    }
    return status;
}

/* Sorts the things by class. The sort is stable. */
static camber_status sort_things(layout_maker *m) {
    camber_context *context = m->layout->context;
    const size_t classes = m->layout->features->class_count;
    m->class_things = camber_alloc_zero(context, classes + 2, sizeof *m->class_things);
    thing *sorted = camber_alloc(context, m->thing_count, sizeof *sorted);
    if (!m->class_things || !sorted) {
        camber_free(context, sorted);
        return CAMBER_ERROR_MEMORY;
    }
    for (size_t i = 0; i < m->thing_count; i++)
        m->class_things[m->things[i].class + 2]++;
    for (size_t c = 0; c < classes; c++)
        m->class_things[c + 2] += m->class_things[c + 1];
    for (size_t i = 0; i < m->thing_count; i++)
        sorted[m->class_things[m->things[i].class + 1]++] = m->things[i];
    camber_free(context, m->things);
    m->things = sorted;
    return CAMBER_OK;
}

/* ---- Candidates ---- */

static bool is_in(const camber_box *box, double x, double y) {
    return x >= box->x0 && x <= box->x1 && y >= box->y0 && y <= box->y1;
}

/* Adds a candidate with the current class's form at a point of the world, if the point is near enough to what is seen.
 * on_line: has the line and the segment that the candidate is on. NULL: it is on no line. */
static camber_status add_candidate(layout_maker *m, const thing *t, const double world[2], double shift,
                                   const camber_label_candidate *on_line) {
    camber_label_layout *l = m->layout;
    camber_label_candidate made = {.form = m->form, .feature = t->feature, .line = CAMBER_NO_PATH};
    if (on_line) {
        made.line = on_line->line;
        made.segment = on_line->segment;
    }
    double px[2];
    camber_view_project(l->view, world[0] + shift, world[1], px);
    if (!isfinite(px[0]) || !isfinite(px[1]) || !is_in(&m->seen, world[0] + shift, world[1]))
        return CAMBER_OK;
    made.x = px[0];
    made.y = px[1];
    made.rank = camber_mix(camber_mix_point(0, world), l->forms[m->form].hash);
    if (!camber_grow(l->context, &l->candidates, &l->candidate_capacity, l->candidate_count + 1, sizeof *l->candidates))
        return CAMBER_ERROR_MEMORY;
    l->candidates[l->candidate_count++] = made;
    return CAMBER_OK;
}

static bool is_kept(const layout_maker *m, size_t i, size_t first, size_t end) {
    const camber_features *f = m->layout->features;
    return (i == first || i + 1 == end || !f->importance || !((double)f->importance[i] < m->least_importance)) &&
           is_finite(f->points + 2 * i);
}

static int compare_points(const double *a, const double *b) {
    return a[0] != b[0] ? (a[0] < b[0] ? -1 : 1) : a[1] != b[1] ? (a[1] < b[1] ? -1 : 1) : 0;
}

/* Where a polyline's path begins, and in which direction it runs. The direction of a merged line, and where a merged
 * ring begins, depend on the order in the file. Therefore the path of a merged line begins at the end that is first in
 * the order of coordinates, and the path of a merged ring at the point that is. */
typedef struct path_order {
    const double *points;
    size_t count;
    size_t start; /* index of a ring's first point */
    bool ring, reversed;
} path_order;

static path_order find_order(const camber_features *f, size_t polyline) {
    path_order order = {.points = f->points + 2 * f->offsets[polyline],
                        .count = f->offsets[polyline + 1] - f->offsets[polyline]};
    if (order.count < 2 || !f->feature_counts || f->feature_counts[polyline] < 2)
        return order;
    const size_t last = order.count - 1;
    order.ring = order.count > 3 && compare_points(order.points, order.points + 2 * last) == 0;
    for (size_t i = 1; i < last && order.ring; i++)
        if (compare_points(order.points + 2 * i, order.points + 2 * order.start) < 0)
            order.start = i;
    const size_t before = order.ring ? (order.start + last - 1) % last : last;
    const size_t after = order.ring ? (order.start + 1) % last : 0;
    order.reversed = compare_points(order.points + 2 * before, order.points + 2 * after) < 0;
    return order;
}

/* Returns the index of the polyline's point that is the k-th of its path. */
static size_t point_in_order(const path_order *order, size_t k) {
    const size_t last = order->count - 1;
    if (!order->ring)
        return order->reversed ? last - k : k;
    return (order->start + (order->reversed ? last - k : k)) % last;
}

static bool make_room(layout_maker *m, size_t count) {
    camber_context *context = m->layout->context;
    return camber_grow(context, &m->path.points, &m->path_capacity[0], count, 2 * sizeof *m->path.points) &&
           camber_grow(context, &m->path.along, &m->path_capacity[1], count, sizeof *m->path.along);
}

/* Reads a polyline into the path, in px from its first point. *reversed: the path runs in the opposite direction to the
 * polyline. */
static camber_status read_path(layout_maker *m, size_t polyline, bool *reversed) {
    const camber_features *f = m->layout->features;
    const size_t first = f->offsets[polyline], end = f->offsets[polyline + 1];
    const double scale = m->layout->view->scale_px;
    const path_order order = find_order(f, polyline);
    m->path.count = 0;
    *reversed = order.reversed;
    if (order.count < 2)
        return CAMBER_OK;
    if (!make_room(m, order.count))
        return CAMBER_ERROR_MEMORY;
    for (size_t k = 0; k < order.count; k++) {
        const size_t i = first + point_in_order(&order, k);
        const bool is_end = k == 0 || k + 1 == order.count;
        if (is_end ? !is_finite(f->points + 2 * i) : !is_kept(m, i, first, end))
            continue;
        const double *at = f->points + 2 * i;
        if (m->path.count == 0)
            memcpy(m->origin, at, sizeof m->origin);
        double *to = m->path.points + 2 * m->path.count, *along = m->path.along + m->path.count;
        to[0] = (at[0] - m->origin[0]) * scale;
        to[1] = (at[1] - m->origin[1]) * scale;
        *along = 0.0;
        if (m->path.count) {
            const double step = hypot(to[0] - to[-2], to[1] - to[-1]);
            if (!(along[-1] + step > along[-1]))
                continue;
            *along = along[-1] + step;
        }
        m->path.count++;
    }
    return CAMBER_OK;
}

static camber_status keep_line(layout_maker *m, double shift, bool reversed, uint32_t *line) {
    camber_label_layout *l = m->layout;
    const double scale = l->view->scale_px;
    const size_t first = l->line_point_count, count = m->path.count;
    if (!camber_grow(l->context, &l->line_points, &l->line_point_capacity, first + count, 2 * sizeof *l->line_points) ||
        !camber_grow(l->context, &l->lines, &l->line_capacity, l->line_count + 1, sizeof *l->lines))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++) {
        double px[2];
        camber_view_project(l->view, m->origin[0] + shift + m->path.points[2 * i] / scale,
                            m->origin[1] + m->path.points[2 * i + 1] / scale, px);
        l->line_points[2 * (first + i)] = (float)px[0];
        l->line_points[2 * (first + i) + 1] = (float)px[1];
    }
    l->line_point_count += count;
    *line = (uint32_t)l->line_count;
    l->lines[l->line_count++] = (camber_label_line){first, count, reversed};
    return CAMBER_OK;
}

static camber_status anchor_line(layout_maker *m, const thing *t, size_t polyline, const camber_anchor_rule *rule) {
    const double scale = m->layout->view->scale_px;
    const bool middle = camber_label_rule_of(m->layout, &(camber_label_candidate){.form = m->form})->symbol.placement ==
                        CAMBER_SYMBOL_LINE_CENTER;
    bool reversed;
    camber_status status = read_path(m, polyline, &reversed);
    for (int world = 0; world < 3 && status == CAMBER_OK && m->path.count > 1; world++) {
        const double shift = world - 1;
        if (!(t->worlds >> world & 1))
            continue;
        camber_anchor_rule moved = *rule;
        moved.seen = (camber_box){(m->seen.x0 - shift - m->origin[0]) * scale, (m->seen.y0 - m->origin[1]) * scale,
                                  (m->seen.x1 - shift - m->origin[0]) * scale, (m->seen.y1 - m->origin[1]) * scale};
        m->anchors.count = 0;
        status = middle ? camber_path_middle(&m->path, &moved, &m->anchors)
                        : camber_path_repeat(&m->path, &moved, &m->anchors);
        camber_label_candidate on_line = {0};
        if (status == CAMBER_OK && m->anchors.count)
            status = keep_line(m, shift, reversed, &on_line.line);
        for (size_t i = 0; i < m->anchors.count && status == CAMBER_OK; i++) {
            double point[2];
            camber_path_point(&m->path, m->anchors.items + i, point);
            const double place[2] = {m->origin[0] + point[0] / scale, m->origin[1] + point[1] / scale};
            on_line.segment = (uint32_t)m->anchors.items[i].segment;
            status = add_candidate(m, t, place, shift, &on_line);
        }
    }
    return status;
}

/* As in MapLibre, labels are where they were at the last whole zoom, so that they do not move along their lines while a
 * map zooms. */
static camber_status anchor_lines(layout_maker *m, const thing *t) {
    const camber_label_layout *l = m->layout;
    const camber_label_form *form = l->forms + m->form;
    const camber_label_rule *rule = l->rules + form->rule;
    const camber_text *text = form->vertical ? form->vertical : form->text;
    const double px = camber_label_whole_zoom_px(l->view), em = rule->symbol.anchor_text_px * px;
    double length = 0.0;
    if (text)
        length = (double)(text->vertical ? text->bottom - text->top : text->right - text->left) * em;
    /* In MapLibre the px of an icon count as if they were units of text, of which an em has 24. */
    if (form->icon)
        length = fmax(length, form->icon->width / form->icon->pixel_ratio * em / 24.0);
    const camber_anchor_rule anchors = {.spacing = fmax(rule->symbol.spacing_px * px, 1.0),
                                        .label_length = length,
                                        .em = em,
                                        .window = text ? 0.6 * em : 0.0,
                                        .max_angle = rule->symbol.max_angle_deg * (3.14159265358979323846 / 180.0)};
    camber_status status = CAMBER_OK;
    for (size_t p = t->first_polyline; p < t->end_polyline && status == CAMBER_OK; p++)
        status = anchor_line(m, t, p, &anchors);
    return status;
}

static camber_status anchor_point(layout_maker *m, const thing *t, const double world[2]) {
    camber_status status = CAMBER_OK;
    for (int i = 0; i < 3 && status == CAMBER_OK; i++)
        if (t->worlds >> i & 1)
            status = add_candidate(m, t, world, i - 1, NULL);
    return status;
}

/* Anchors the polygon whose rings are from first up to end. */
static camber_status anchor_polygon(layout_maker *m, const thing *t, size_t first, size_t end) {
    const camber_features *f = m->layout->features;
    const camber_box box = box_of(f, first, first + 1);
    if (box.x0 > box.x1 || !find_worlds(m, &box))
        return CAMBER_OK;
    const double scale = m->layout->view->scale_px, *origin = f->points + 2 * f->offsets[first];
    if (!make_room(m, f->offsets[end] - f->offsets[first]) ||
        !camber_grow(f->context, &m->ring_offsets, &m->ring_capacity, end - first + 1, sizeof *m->ring_offsets))
        return CAMBER_ERROR_MEMORY;
    size_t count = 0;
    for (size_t p = first; p < end; p++) {
        m->ring_offsets[p - first] = count;
        for (size_t i = f->offsets[p]; i < f->offsets[p + 1]; i++) {
            if (!is_kept(m, i, f->offsets[p], f->offsets[p + 1]))
                continue;
            m->path.points[2 * count] = (f->points[2 * i] - origin[0]) * scale;
            m->path.points[2 * count++ + 1] = (f->points[2 * i + 1] - origin[1]) * scale;
        }
    }
    m->ring_offsets[end - first] = count;
    if (count == 0)
        return CAMBER_OK;
    double pole[2];
    const camber_status status =
        camber_pole_find(f->context, m->path.points, m->ring_offsets, end - first, m->layout->view->ratio, pole);
    const double place[2] = {origin[0] + pole[0] / scale, origin[1] + pole[1] / scale};
    return status == CAMBER_OK ? anchor_point(m, t, place) : status;
}

/* An outer ring is stored before its holes. */
static camber_status anchor_areas(layout_maker *m, const thing *t) {
    const camber_features *f = m->layout->features;
    camber_status status = CAMBER_OK;
    for (size_t p = t->first_polyline, next; p < t->end_polyline && status == CAMBER_OK; p = next) {
        next = p + 1;
        while (next < t->end_polyline &&
               camber_ring_area(f->points + 2 * f->offsets[next], f->offsets[next + 1] - f->offsets[next]) <= 0.0)
            next++;
        status = anchor_polygon(m, t, p, next);
    }
    return status;
}

/* Anchors each point, or the first point of each line. */
static camber_status anchor_points(layout_maker *m, const thing *t, bool each) {
    const camber_features *f = m->layout->features;
    camber_status status = CAMBER_OK;
    for (size_t p = t->first_polyline; p < t->end_polyline; p++)
        for (size_t i = f->offsets[p]; i < f->offsets[p + 1] && status == CAMBER_OK; i++)
            if (each || i == f->offsets[p])
                status = anchor_point(m, t, f->points + 2 * i);
    return status;
}

static camber_status anchor_thing(layout_maker *m, const thing *t) {
    const camber_geometry_kind kind = m->layout->features->classes[t->class].geometry;
    const camber_label_rule *rule = m->layout->rules + m->layout->forms[m->form].rule;
    if (rule->symbol.placement != CAMBER_SYMBOL_POINT)
        return kind == CAMBER_GEOMETRY_LABEL_POINT ? CAMBER_OK : anchor_lines(m, t);
    if (kind == CAMBER_GEOMETRY_LABEL_AREA)
        return anchor_areas(m, t);
    return anchor_points(m, t, kind == CAMBER_GEOMETRY_LABEL_POINT);
}

/* ---- Layers ---- */

static double farthest(const camber_box *box) {
    return fmax(fmax(fabs(box->x0), fabs(box->x1)), fmax(fabs(box->y0), fabs(box->y1)));
}

/* Returns how far from its anchor a label of the form can collide with others, px. */
static double reach_of(const camber_label_layout *l, uint32_t form_index) {
    const camber_label_form *form = l->forms + form_index;
    const camber_label_rule *rule = l->rules + form->rule;
    const camber_label_candidate c = {.form = form_index};
    double reach = 0.0;
    for (size_t i = 0; i < rule->anchor_count && form->text; i++) {
        const camber_box box = camber_label_text_box(l, &c, false, i);
        reach = fmax(reach, farthest(&box) + fabs(rule->text_translate_px[0]) + fabs(rule->text_translate_px[1]));
    }
    if (form->icon) {
        const camber_box box = camber_label_icon_box(l, &c, false, 0);
        reach = fmax(reach, farthest(&box) + fabs(rule->icon_translate_px[0]) + fabs(rule->icon_translate_px[1]));
    }
    /* A turned box reaches farther, and labels near the camera are larger. */
    return (l->lens.pitched ? 3.0 : 1.5) * reach + CAMBER_LABEL_MARGIN_PX * l->view->ratio;
}

static camber_status lay_out_class(layout_maker *m, uint32_t class_index) {
    const camber_features *f = m->layout->features;
    const camber_feature_class *class = f->classes + class_index;
    if (!camber_plan_comes_to(f, m->look->layer, class))
        return CAMBER_OK;
    const camber_feature_view feature = camber_plan_view_of(f, class);
    if (!camber_style_layer_matches(m->look->layer, m->look->zoom, &feature))
        return CAMBER_OK;
    camber_status status = camber_label_form_make(m->layout, m->look, class, &m->form);
    if (status != CAMBER_OK || m->form == CAMBER_NO_FORM)
        return status;
    set_reach(m, fmin(reach_of(m->layout, m->form), REACH_PX * m->layout->view->ratio));
    for (size_t i = m->class_things[class_index]; i < m->class_things[class_index + 1] && status == CAMBER_OK; i++)
        status = anchor_thing(m, m->things + i);
    return status;
}

static camber_status lay_out_layer(layout_maker *m, size_t index, double zoom) {
    camber_label_layout *l = m->layout;
    const camber_style_layer *layer = l->features->style->layers + index;
    if (layer->kind != CAMBER_LAYER_SYMBOL || !layer->visible || zoom < layer->min_zoom ||
        (zoom >= layer->max_zoom && layer->max_zoom < 24.0))
        return CAMBER_OK;
    const camber_layer_look look = camber_style_layer_look(layer, zoom);
    const size_t first = l->candidate_count;
    camber_status status = CAMBER_OK;
    m->look = &look;
    for (size_t c = 0; c < l->features->class_count && status == CAMBER_OK; c++)
        if (m->class_things[c] < m->class_things[c + 1])
            status = lay_out_class(m, (uint32_t)c);
    m->look = NULL;
    if (status != CAMBER_OK || l->candidate_count == first)
        return status;
    if (!camber_grow(l->context, &l->layers, &l->layer_capacity, l->layer_count + 1, sizeof *l->layers))
        return CAMBER_ERROR_MEMORY;
    l->layers[l->layer_count++] = (camber_layout_layer){index, first, l->candidate_count - first};
    return CAMBER_OK;
}

camber_status camber_label_layout_make(camber_label_layout *layout) {
    const double zoom = camber_view_style_zoom(layout->view);
    layout_maker m = {.layout = layout,
                      .corners = find_corners(layout),
                      .least_importance = SIMPLIFY_PX / layout->view->scale_px,
                      .anchors.context = layout->context};
    layout->lens = camber_view_lens_of(layout->view);
    set_reach(&m, REACH_PX * layout->view->ratio);
    camber_status status = layout->features->points ? find_things(&m) : CAMBER_OK;
    if (status == CAMBER_OK && m.thing_count) {
        status = sort_things(&m);
        for (size_t i = 0; i < layout->features->style->layer_count && status == CAMBER_OK; i++)
            status = lay_out_layer(&m, i, zoom);
    }
    camber_free(layout->context, m.things);
    camber_free(layout->context, m.class_things);
    camber_free(layout->context, m.path.points);
    camber_free(layout->context, m.path.along);
    camber_free(layout->context, m.anchors.items);
    camber_free(layout->context, m.ring_offsets);
    return status;
}

void camber_label_layout_free(camber_label_layout *layout) {
    camber_context *context = layout->context;
    camber_label_words_free(layout);
    camber_free(context, layout->layers);
    camber_free(context, layout->rules);
    camber_free(context, layout->forms);
    camber_free(context, layout->runs);
    camber_free(context, layout->looks);
    camber_free(context, layout->candidates);
    camber_free(context, layout->lines);
    camber_free(context, layout->line_points);
}
