/* Makes triangles from the areas that a plan draws, for meshes of one view.
 *
 * Input: features, a plan and a view. Output: triangles in px of the picture, layer by layer. Main idea: consecutive
 * rings of a layer with the same fill are filled together, as the kernels fill them as one path. */
#include "map/plan_areas.h"

#include "map/triangulator.h"

#include <math.h>

/* Units per px. Floats hold them exactly, even in the largest picture. */
enum { UNITS = 256 };

typedef struct area_maker {
    const camber_features *features;
    const camber_plan *plan;
    const camber_view *view;
    float least_importance;
    camber_ring_window window;
    camber_triangulator *triangulator; /* NULL: not needed yet */
    float *points;                     /* one ring, as pairs of px */
    size_t point_capacity;
    camber_area_data *areas;
    size_t room[3]; /* capacities of points, indices and fills */
} area_maker;

/* Adds a ring in one copy of the world, if it reaches into the window. */
static camber_status add_ring(area_maker *m, size_t polyline, double shift, const camber_paint *paint) {
    const camber_features *f = m->features;
    const size_t first = f->offsets[polyline], end = f->offsets[polyline + 1];
    camber_ring_box box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    size_t count = 0;
    if (!camber_grow(m->areas->context, &m->points, &m->point_capacity, end - first, 2 * sizeof *m->points))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = first; i < end; i++) {
        double px[2];
        if (i > first && i + 1 < end && f->importance && f->importance[i] < m->least_importance)
            continue;
        camber_view_project(m->view, f->points[2 * i] + shift, f->points[2 * i + 1], px);
        const float x = (float)px[0] + paint->translate_x_px, y = (float)px[1] + paint->translate_y_px;
        if (!isfinite(x) || !isfinite(y))
            continue;
        box = (camber_ring_box){fminf(box.x0, x), fminf(box.y0, y), fmaxf(box.x1, x), fmaxf(box.y1, y)};
        m->points[2 * count] = x;
        m->points[2 * count++ + 1] = y;
    }
    if (count < 4 || !camber_ring_touches(&box, &m->window))
        return CAMBER_OK;
    camber_status status = CAMBER_OK;
    if (!m->triangulator)
        status = camber_triangulator_create(m->areas->context, &m->triangulator);
    return status == CAMBER_OK ? camber_triangulator_add(m->triangulator, m->points, count, &m->window) : status;
}

/* Appends the triangles of the rings that were added. */
static camber_status end_fill(area_maker *m, const char *layer, uint32_t level, camber_color color) {
    camber_area_data *a = m->areas;
    camber_triangles made = {0};
    if (!m->triangulator)
        return CAMBER_OK;
    const camber_status status = camber_triangulator_fill(m->triangulator, &made);
    if (status != CAMBER_OK || made.index_count == 0)
        return status;
    if (!camber_grow(a->context, &a->points, &m->room[0], a->point_count + made.corner_count, 2 * sizeof *a->points) ||
        !camber_grow(a->context, &a->indices, &m->room[1], a->index_count + made.index_count, sizeof *a->indices) ||
        !camber_grow(a->context, &a->fills, &m->room[2], a->fill_count + 1, sizeof *a->fills))
        return CAMBER_ERROR_MEMORY;
    a->fills[a->fill_count++] = (camber_area_fill){.layer = layer,
                                                   .level = level,
                                                   .color = color,
                                                   .first_point = a->point_count,
                                                   .point_count = made.corner_count,
                                                   .first_index = a->index_count,
                                                   .index_count = made.index_count};
    for (size_t i = 0; i < made.index_count; i++)
        a->indices[a->index_count++] = (uint32_t)a->point_count + made.indices[i];
    for (size_t i = 0; i < made.corner_count; i++, a->point_count++) {
        a->points[2 * a->point_count] = (float)(m->window.centre_x + (double)made.corners[i].x / UNITS);
        a->points[2 * a->point_count + 1] = (float)(m->window.centre_y + (double)made.corners[i].y / UNITS);
    }
    return CAMBER_OK;
}

static camber_paint paint_of(const area_maker *m, const camber_plan_layer *layer, uint32_t pair) {
    return camber_plan_paint(m->plan, m->plan->sets + layer->set, m->plan->pair_rows[pair], layer->slot);
}

/* Comparing the bits is enough: colours are made from bytes or from the style's numbers, so equal colours have equal
 * bits. */
static bool is_same_fill(const camber_paint *a, const camber_paint *b) {
    return memcmp(&a->fill->color, &b->fill->color, sizeof a->fill->color) == 0 && a->fill->rule == b->fill->rule &&
           memcmp(&a->translate_x_px, &b->translate_x_px, sizeof(float)) == 0 &&
           memcmp(&a->translate_y_px, &b->translate_y_px, sizeof(float)) == 0;
}

static bool fills(const camber_paint *paint) {
    return paint->fill && !paint->fill->image && paint->fill->color.a > 0.0f;
}

static camber_status fill_layer(area_maker *m, const camber_plan_layer *layer, const camber_plan_entries *listed) {
    const size_t first = listed->first_entries[layer->set], end = listed->first_entries[layer->set + 1];
    const float opacity = (float)layer->look.paint.layer_opacity;
    const uint32_t level =
        m->areas->fill_count ? m->areas->fills[m->areas->fill_count - 1].level + 1 : 0; /* number of layers below it */
    camber_status status = CAMBER_OK;
    for (size_t i = first, next; i < end && status == CAMBER_OK; i = next) {
        const camber_paint paint = paint_of(m, layer, listed->entries[i].pair);
        for (next = i; next < end && status == CAMBER_OK; next++) {
            const camber_paint own = paint_of(m, layer, listed->entries[next].pair);
            if (next > i && (!fills(&own) || !fills(&paint) || !is_same_fill(&own, &paint)))
                break;
            for (double shift = -1.0; shift <= 1.0 && status == CAMBER_OK && fills(&own); shift += 1.0)
                status = add_ring(m, listed->entries[next].polyline, shift, &own);
        }
        if (status == CAMBER_OK && fills(&paint)) {
            camber_color color = paint.fill->color;
            color.a *= opacity;
            status = end_fill(m, layer->look.layer->id, level, color);
        }
    }
    return status;
}

camber_status camber_plan_triangulate(const camber_features *features, const camber_plan *plan, const camber_view *view,
                                      double simplify_px, camber_area_data *areas) {
    area_maker m = {.features = features,
                    .plan = plan,
                    .view = view,
                    .least_importance = (float)(simplify_px / view->scale_px),
                    .window = {.centre_x = 0.5 * view->width,
                               .centre_y = 0.5 * view->height,
                               .half_width = 0.5f * (float)view->width + 1.0f,
                               .half_height = 0.5f * (float)view->height + 1.0f,
                               .units = UNITS},
                    .areas = areas};
    camber_plan_entries listed = {0};
    *areas = (camber_area_data){.context = features->context};
    camber_status status = camber_plan_list(features, plan, NULL, features->polyline_count, &listed);
    for (size_t i = 0; i < plan->layer_count && status == CAMBER_OK; i++)
        if (plan->layers[i].part == CAMBER_PLAN_AREA)
            status = fill_layer(&m, plan->layers + i, &listed);
    camber_plan_entries_free(&listed);
    camber_triangulator_destroy(m.triangulator);
    camber_free(areas->context, m.points);
    return status;
}

void camber_area_data_destroy(camber_area_data *areas) {
    if (!areas->context)
        return;
    camber_free(areas->context, areas->points);
    camber_free(areas->context, areas->indices);
    camber_free(areas->context, areas->fills);
    *areas = (camber_area_data){0};
}
