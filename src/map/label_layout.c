/* Finds where the labels of a view or of a domain may be placed.
 *
 * Input: the things that may be seen. Output: candidates by layer. Main idea: things are sorted by class. Each layer is
 * evaluated once per class, because all features of a class give the same result. A layout that is kept for views which
 * differ only in their place keeps these results, too. */
#include "map/label_layout.h"

#include "base/maths.h"

#include <math.h>

/* How far outside the picture an anchor may be if its label reaches into the picture, CSS px. */
static const double REACH_PX = 320.0;

/* Whether any layer shows a class. It is known after all layers were evaluated. */
enum { CLASS_UNKNOWN = 0, CLASS_IS_SILENT, CLASS_SPEAKS };

typedef struct layout_maker {
    camber_label_layout *layout;
    camber_box corners; /* box around what is seen, world coordinates */
    camber_box seen;    /* the same, widened by the reach of the current labels */
    const camber_layer_look *look;
    uint32_t *classes; /* class_count that have things and may have labels */
    size_t class_count, class_capacity;
    uint32_t class, form;
    camber_label_path path; /* of the current line, px from origin */
    size_t path_capacity[2];
    double origin[2]; /* world coordinates of its first point */
    camber_path_anchors anchors;
    size_t *ring_offsets;
    size_t ring_capacity;
} layout_maker;

/* ---- The seen part of the world ---- */

double camber_label_whole_zoom_px(const camber_view *view) {
    const double zoom = camber_view_style_zoom(view);
    return view->ratio * camber_exp2(zoom - floor(zoom));
}

/* Returns the box around the quadrangle that is seen. */
static camber_box find_corners(const camber_view *view) {
    double corners[8];
    camber_view_corners(view, corners);
    camber_box box = CAMBER_BOX_EMPTY;
    for (int i = 0; i < 4; i++)
        camber_box_add(&box, corners[2 * i], corners[2 * i + 1]);
    return box;
}

/* Widens what is seen by a reach in device px. In a domain all anchors are wanted that are inside it; a px more does no
 * harm. */
static void set_reach(layout_maker *m, double reach_px) {
    const camber_label_domain *domain = m->layout->domain;
    if (domain) {
        const camber_box *b = &domain->known;
        const double all = domain->whole ? INFINITY : 1.0;
        m->seen = (camber_box){(b->x0 - all) / domain->world_px, (b->y0 - 1.0) / domain->world_px,
                               (b->x1 + all) / domain->world_px, (b->y1 + 1.0) / domain->world_px};
        return;
    }
    const double reach = reach_px / m->layout->view->scale_px;
    m->seen = (camber_box){m->corners.x0 - reach, m->corners.y0 - reach, m->corners.x1 + reach, m->corners.y1 + reach};
}

/* Finds the copies of the world in which a box is seen. In the whole world there is only one. */
static uint8_t find_worlds(const layout_maker *m, const camber_box *box) {
    const camber_label_domain *domain = m->layout->domain;
    return domain && domain->whole ? 2 : camber_label_find_worlds(&m->seen, box);
}

static bool is_finite(const double *point) {
    return isfinite(point[0]) && isfinite(point[1]);
}

/* ---- Candidates ---- */

static bool is_in(const camber_box *box, double x, double y) {
    return x >= box->x0 && x <= box->x1 && y >= box->y0 && y <= box->y1;
}

/* Returns the turn in which an anchor of a line is tried, in the upper 6 bits: the first anchor before all others, then
 * every other one of those that are left. If anchors are too close for all of their labels, those that are shown are
 * evenly spaced, wherever the view begins. */
static uint64_t turn_of(double number) {
    uint64_t turn = 0;
    if (number >= 1.0 && number < 4294967296.0)
        for (turn = 32; fmod(number, 2.0) == 0.0; turn--)
            number /= 2.0;
    return turn << 58;
}

/* Returns the px of a point of the world in a domain: multiples of its step, whatever the copy of the world. */
static void snap_to_domain(const camber_label_domain *domain, const double world[2], double px[2]) {
    const double turns = floor(world[0]);
    px[0] = camber_label_snap((world[0] - turns) * domain->world_px) + turns * domain->world_px;
    px[1] = camber_label_snap(world[1] * domain->world_px);
}

/* Finds the px of a point in a copy of the world. false: it is too far from what is seen. */
static bool find_px(const layout_maker *m, const double world[2], double shift, double px[2]) {
    const camber_label_domain *domain = m->layout->domain;
    if (!domain) {
        camber_view_project(m->layout->view, world[0] + shift, world[1], px);
        return is_finite(px) && is_in(&m->seen, world[0] + shift, world[1]);
    }
    snap_to_domain(domain, world, px);
    if (domain->whole)
        px[0] -= floor(px[0] / domain->world_px) * domain->world_px;
    else
        px[0] += shift * domain->world_px;
    return is_finite(px) && (domain->whole || is_in(&domain->known, px[0], px[1]));
}

/* Adds a candidate with the current class's form at a point of the world, if the point is near enough to what is seen.
 * shift: of the copy of the world. on_line: has the line and the segment that the candidate is on, and its turn.
 * NULL: it is on no line. */
static camber_status add_candidate(layout_maker *m, const camber_label_thing *t, const double world[2], double shift,
                                   const camber_label_candidate *on_line) {
    camber_label_layout *l = m->layout;
    camber_label_candidate made = {.line = CAMBER_NO_PATH};
    double px[2];
    if (!find_px(m, world, shift, px))
        return CAMBER_OK;
    if (on_line)
        made = *on_line;
    made.form = m->form;
    made.feature = t->feature;
    made.x = px[0];
    made.y = px[1];
    made.rank = camber_mix(camber_mix_point(0, world), l->forms[m->form].hash);
    if (on_line)
        made.rank = on_line->rank | made.rank >> 6;
    if (!camber_grow(l->context, &l->candidates, &l->candidate_capacity, l->candidate_count + 1, sizeof *l->candidates))
        return CAMBER_ERROR_MEMORY;
    l->candidates[l->candidate_count++] = made;
    return CAMBER_OK;
}

static bool is_kept(const layout_maker *m, size_t i, size_t first, size_t end) {
    const camber_features *f = m->layout->features;
    return (i == first || i + 1 == end || !f->importance ||
            !((double)f->importance[i] < m->layout->least_importance)) &&
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
            const double step = camber_length(to[0] - to[-2], to[1] - to[-1]);
            if (!(along[-1] + step > along[-1]))
                continue;
            *along = along[-1] + step;
        }
        m->path.count++;
    }
    return CAMBER_OK;
}

/* Turns a vector of the world as the picture is turned. */
static void turn(const camber_view *view, double x, double y, double turned[2]) {
    turned[0] = x * view->cosine + y * view->sine;
    turned[1] = y * view->cosine - x * view->sine;
}

/* Keeps the path's points for the labels on it. */
static camber_status keep_line(layout_maker *m, bool reversed, uint32_t *line) {
    camber_label_layout *l = m->layout;
    const size_t first = l->line_point_count, count = m->path.count;
    if (!camber_grow(l->context, &l->line_points, &l->line_point_capacity, first + count, 2 * sizeof *l->line_points) ||
        !camber_grow(l->context, &l->lines, &l->line_capacity, l->line_count + 1, sizeof *l->lines))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++) {
        double px[2];
        turn(l->view, m->path.points[2 * i], m->path.points[2 * i + 1], px);
        l->line_points[2 * (first + i)] = (float)px[0];
        l->line_points[2 * (first + i) + 1] = (float)px[1];
    }
    l->line_point_count += count;
    *line = (uint32_t)l->line_count;
    l->lines[l->line_count++] = (camber_label_line){first, count, reversed};
    return CAMBER_OK;
}

/* Finds where the line's first point is, relative to an anchor on it. */
static void find_line_start(const layout_maker *m, const double place[2], camber_label_candidate *on_line) {
    const camber_label_domain *domain = m->layout->domain;
    const camber_view *view = m->layout->view;
    double start[2], anchor[2];
    if (domain) {
        snap_to_domain(domain, m->origin, start);
        snap_to_domain(domain, place, anchor);
    } else {
        camber_view_project(view, m->origin[0], m->origin[1], start);
        camber_view_project(view, place[0], place[1], anchor);
    }
    on_line->line_x = start[0] - anchor[0];
    on_line->line_y = start[1] - anchor[1];
}

/* Adds a candidate at each anchor of the current path. */
static camber_status add_on_line(layout_maker *m, const camber_label_thing *t, double shift, uint32_t line) {
    const double scale = m->layout->view->scale_px;
    camber_status status = CAMBER_OK;
    for (size_t i = 0; i < m->anchors.count && status == CAMBER_OK; i++) {
        const camber_path_anchor *anchor = m->anchors.items + i;
        camber_label_candidate on_line = {
            .line = line, .segment = (uint32_t)anchor->segment, .rank = turn_of(anchor->number)};
        double point[2];
        camber_path_point(&m->path, anchor, point);
        const double place[2] = {m->origin[0] + point[0] / scale, m->origin[1] + point[1] / scale};
        find_line_start(m, place, &on_line);
        status = add_candidate(m, t, place, shift, &on_line);
    }
    return status;
}

static camber_status anchor_line(layout_maker *m, const camber_label_thing *t, size_t polyline,
                                 const camber_anchor_rule *rule) {
    const double scale = m->layout->view->scale_px;
    const bool middle = camber_label_rule_of(m->layout, &(camber_label_candidate){.form = m->form})->symbol.placement ==
                        CAMBER_SYMBOL_LINE_CENTER;
    const uint8_t worlds = find_worlds(m, &t->box);
    uint32_t line = CAMBER_NO_PATH;
    bool reversed;
    camber_status status = worlds ? read_path(m, polyline, &reversed) : CAMBER_OK;
    for (int world = 0; world < 3 && worlds && status == CAMBER_OK && m->path.count > 1; world++) {
        const double shift = world - 1;
        if (!(worlds >> world & 1))
            continue;
        camber_anchor_rule moved = *rule;
        moved.seen = (camber_box){(m->seen.x0 - shift - m->origin[0]) * scale, (m->seen.y0 - m->origin[1]) * scale,
                                  (m->seen.x1 - shift - m->origin[0]) * scale, (m->seen.y1 - m->origin[1]) * scale};
        m->anchors.count = 0;
        status = middle ? camber_path_middle(&m->path, &moved, &m->anchors)
                        : camber_path_repeat(&m->path, &moved, &m->anchors);
        if (status == CAMBER_OK && m->anchors.count && line == CAMBER_NO_PATH)
            status = keep_line(m, reversed, &line);
        if (status == CAMBER_OK)
            status = add_on_line(m, t, shift, line);
    }
    return status;
}

/* As in MapLibre, labels are where they were at the last whole zoom, so that they do not move along their lines while a
 * map zooms. */
static camber_status anchor_lines(layout_maker *m, const camber_label_thing *t) {
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

static camber_status anchor_point(layout_maker *m, const camber_label_thing *t, const double world[2]) {
    const uint8_t worlds = find_worlds(m, &t->box);
    camber_status status = CAMBER_OK;
    for (int i = 0; i < 3 && status == CAMBER_OK; i++)
        if (worlds >> i & 1)
            status = add_candidate(m, t, world, i - 1, NULL);
    return status;
}

/* Finds the pole of the polygon whose rings are from first up to end, px from its first point. *found is false if the
 * polygon has no points. */
static camber_status find_pole(layout_maker *m, size_t first, size_t end, double pole[2], bool *found) {
    const camber_features *f = m->layout->features;
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
    *found = count > 0;
    return count ? camber_pole_find(f->context, m->path.points, m->ring_offsets, end - first, m->layout->view->ratio,
                                    pole)
                 : CAMBER_OK;
}

/* As find_pole. Poles are kept with forms, because they are the same wherever the view is. */
static camber_status recall_pole(layout_maker *m, size_t first, size_t end, double pole[2], bool *found) {
    camber_label_layout *l = m->layout;
    const uint32_t known = camber_number_map_get(&l->pole_numbers, (uint32_t)first);
    if (known) {
        memcpy(pole, l->poles + 2 * (known - 1), 2 * sizeof *pole);
        *found = true;
        return CAMBER_OK;
    }
    const camber_status status = find_pole(m, first, end, pole, found);
    if (status != CAMBER_OK || !*found || !l->keeps_forms)
        return status;
    if (!camber_grow(l->context, &l->poles, &l->pole_capacity, 2 * (l->pole_count + 1), sizeof *l->poles) ||
        !camber_number_map_set(l->context, &l->pole_numbers, (uint32_t)first, (uint32_t)l->pole_count + 1))
        return CAMBER_ERROR_MEMORY;
    memcpy(l->poles + 2 * l->pole_count++, pole, 2 * sizeof *pole);
    return CAMBER_OK;
}

/* Anchors the polygon whose rings are from first up to end. */
static camber_status anchor_polygon(layout_maker *m, const camber_label_thing *t, size_t first, size_t end) {
    const camber_features *f = m->layout->features;
    const camber_box box = camber_label_box_of(f, first, first + 1);
    const double scale = m->layout->view->scale_px, *origin = f->points + 2 * f->offsets[first];
    double pole[2];
    bool found;
    if (box.x0 > box.x1 || !find_worlds(m, &box))
        return CAMBER_OK;
    const camber_status status = recall_pole(m, first, end, pole, &found);
    if (status != CAMBER_OK || !found)
        return status;
    const double place[2] = {origin[0] + pole[0] / scale, origin[1] + pole[1] / scale};
    return anchor_point(m, t, place);
}

/* Whether a ring is an outer one. Points that are left out do not count, since they may have been dropped. */
static bool is_outer(const layout_maker *m, size_t ring) {
    const camber_features *f = m->layout->features;
    const size_t first = f->offsets[ring], end = f->offsets[ring + 1];
    double area = 0.0;
    for (size_t i = first, before = first; i < end; i++) {
        if (!is_kept(m, i, first, end))
            continue;
        const double *a = f->points + 2 * before, *b = f->points + 2 * i, *origin = f->points + 2 * first;
        area += (a[0] - origin[0]) * (b[1] - origin[1]) - (b[0] - origin[0]) * (a[1] - origin[1]);
        before = i;
    }
    return area > 0.0;
}

/* An outer ring is stored before its holes. */
static camber_status anchor_areas(layout_maker *m, const camber_label_thing *t) {
    camber_status status = CAMBER_OK;
    for (size_t p = t->first_polyline, next; p < t->end_polyline && status == CAMBER_OK; p = next) {
        next = p + 1;
        while (next < t->end_polyline && !is_outer(m, next))
            next++;
        status = anchor_polygon(m, t, p, next);
    }
    return status;
}

/* Anchors each point, or the first point of each line. */
static camber_status anchor_points(layout_maker *m, const camber_label_thing *t, bool each) {
    const camber_features *f = m->layout->features;
    camber_status status = CAMBER_OK;
    for (size_t p = t->first_polyline; p < t->end_polyline; p++)
        for (size_t i = f->offsets[p]; i < f->offsets[p + 1] && status == CAMBER_OK; i++)
            if (each || i == f->offsets[p])
                status = anchor_point(m, t, f->points + 2 * i);
    return status;
}

static camber_status anchor_thing(layout_maker *m, const camber_label_thing *t) {
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

/* Finds what the layer's labels of the class show: the number of a form, or CAMBER_NO_FORM. */
static camber_status make_form(layout_maker *m, uint32_t *form) {
    const camber_features *f = m->layout->features;
    const camber_feature_class *class = f->classes + m->class;
    *form = CAMBER_NO_FORM;
    if (!camber_plan_comes_to(f, m->look->layer, class))
        return CAMBER_OK;
    const camber_feature_view feature = camber_plan_view_of(f, class);
    if (!camber_style_layer_matches(m->look->layer, m->look->zoom, &feature))
        return CAMBER_OK;
    return camber_label_form_make(m->layout, m->look, class, form);
}

/* known: the forms of the layer's classes; 0: not found yet, otherwise the form's number + 2, or 1 for none. NULL: they
 * are not kept. */
static camber_status lay_out_class(layout_maker *m, uint32_t *known) {
    camber_status status = CAMBER_OK;
    if (known && known[m->class] == 1)
        return CAMBER_OK;
    if (known && known[m->class]) {
        m->form = known[m->class] - 2;
    } else {
        status = make_form(m, &m->form);
        if (status == CAMBER_OK && known)
            known[m->class] = m->form == CAMBER_NO_FORM ? 1 : m->form + 2;
        if (status == CAMBER_OK && known && m->form != CAMBER_NO_FORM)
            m->layout->class_states[m->class] = CLASS_SPEAKS;
    }
    if (status != CAMBER_OK || m->form == CAMBER_NO_FORM)
        return status;
    set_reach(m, fmin(reach_of(m->layout, m->form), REACH_PX * m->layout->view->ratio));
    const camber_label_things *things = m->layout->things;
    for (size_t i = things->class_first[m->class]; i < things->class_first[m->class + 1] && status == CAMBER_OK; i++)
        status = anchor_thing(m, things->items + i);
    return status;
}

/* Lists the classes of the things, without those that no layer shows. */
static camber_status list_classes(layout_maker *m) {
    camber_label_layout *l = m->layout;
    const camber_label_things *things = l->things;
    if (l->keeps_forms && !l->class_states &&
        !(l->class_states = camber_alloc_zero(l->context, l->features->class_count, sizeof *l->class_states)))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < things->count; i = things->class_first[things->items[i].class + 1]) {
        const uint32_t class = things->items[i].class;
        if (l->keeps_forms && l->class_states[class] == CLASS_IS_SILENT)
            continue;
        if (!camber_grow(l->context, &m->classes, &m->class_capacity, m->class_count + 1, sizeof *m->classes))
            return CAMBER_ERROR_MEMORY;
        m->classes[m->class_count++] = class;
    }
    return CAMBER_OK;
}

/* Notes which classes no layer shows, after all layers were evaluated. */
static void note_silent_classes(const layout_maker *m) {
    for (size_t i = 0; i < m->class_count; i++)
        if (m->layout->class_states[m->classes[i]] == CLASS_UNKNOWN)
            m->layout->class_states[m->classes[i]] = CLASS_IS_SILENT;
}

/* Returns the table of a layer's forms. NULL: there is no memory. */
static uint32_t *known_forms(camber_label_layout *l, size_t index) {
    const size_t layers = l->features->style->layer_count;
    if (!l->known_forms) {
        if (!(l->known_forms = camber_alloc_zero(l->context, layers, sizeof *l->known_forms)))
            return NULL;
        l->known_count = layers;
    }
    if (!l->known_forms[index])
        l->known_forms[index] = camber_alloc_zero(l->context, l->features->class_count, sizeof **l->known_forms);
    return l->known_forms[index];
}

static camber_status lay_out_layer(layout_maker *m, size_t index, double zoom) {
    camber_label_layout *l = m->layout;
    const camber_style_layer *layer = l->features->style->layers + index;
    if (layer->kind != CAMBER_LAYER_SYMBOL || zoom < layer->min_zoom ||
        (zoom >= layer->max_zoom && layer->max_zoom < 24.0))
        return CAMBER_OK;
    const camber_layer_look look = camber_style_layer_look(layer, zoom);
    const size_t first = l->candidate_count;
    uint32_t *known = l->keeps_forms ? known_forms(l, index) : NULL;
    camber_status status = known || !l->keeps_forms ? CAMBER_OK : CAMBER_ERROR_MEMORY;
    m->look = &look;
    for (size_t i = 0; i < m->class_count && status == CAMBER_OK; i++) {
        m->class = m->classes[i];
        status = lay_out_class(m, known);
    }
    m->look = NULL;
    if (status != CAMBER_OK || l->candidate_count == first)
        return status;
    if (!camber_grow(l->context, &l->layers, &l->layer_capacity, l->layer_count + 1, sizeof *l->layers))
        return CAMBER_ERROR_MEMORY;
    l->layers[l->layer_count++] = (camber_layout_layer){index, first, l->candidate_count - first};
    return CAMBER_OK;
}

camber_box camber_label_seen(const camber_view *view) {
    const double reach = REACH_PX * view->ratio / view->scale_px;
    const camber_box box = find_corners(view);
    return (camber_box){box.x0 - reach, box.y0 - reach, box.x1 + reach, box.y1 + reach};
}

camber_status camber_label_layout_make(camber_label_layout *layout) {
    const double zoom = camber_view_style_zoom(layout->view);
    layout_maker m = {.layout = layout, .corners = find_corners(layout->view), .anchors.context = layout->context};
    camber_status status = list_classes(&m);
    layout->lens = camber_view_lens_of(layout->view);
    layout->layer_count = layout->candidate_count = layout->line_count = layout->line_point_count = 0;
    set_reach(&m, REACH_PX * layout->view->ratio);
    for (size_t i = 0; i < layout->features->style->layer_count && m.class_count && status == CAMBER_OK; i++)
        status = lay_out_layer(&m, i, zoom);
    if (status == CAMBER_OK && layout->keeps_forms)
        note_silent_classes(&m);
    camber_free(layout->context, m.classes);
    camber_free(layout->context, m.path.points);
    camber_free(layout->context, m.path.along);
    camber_free(layout->context, m.anchors.items);
    camber_free(layout->context, m.ring_offsets);
    return status;
}

void camber_label_layout_free(camber_label_layout *layout) {
    camber_context *context = layout->context;
    camber_label_words_free(layout);
    for (size_t i = 0; i < layout->known_count; i++)
        camber_free(context, layout->known_forms[i]);
    camber_free(context, layout->known_forms);
    camber_free(context, layout->class_states);
    camber_free(context, layout->poles);
    camber_number_map_free(context, &layout->pole_numbers);
    camber_free(context, layout->layers);
    camber_free(context, layout->rules);
    camber_free(context, layout->forms);
    camber_free(context, layout->runs);
    camber_free(context, layout->looks);
    camber_free(context, layout->candidates);
    camber_free(context, layout->lines);
    camber_free(context, layout->line_points);
}
