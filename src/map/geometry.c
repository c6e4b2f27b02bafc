#include "map/geometry.h"

#include "lines/simplify.h"
#include "map/clip.h"

#include <math.h>
#include <string.h>

/* Within this of the picture points keep their places; floats are exact to 1/128 px there. */
static const double FAR_PX = 4096.0;
/* A miter limit without reason must not undo the culling. */
static const double LARGEST_REACH_PX = 65536.0;
static const size_t MOST_POINTS = UINT32_MAX - 1024u;

typedef struct projector {
    const camber_features *features;
    const camber_view *view;
    camber_geometry *geometry;
    double simplify_px;
    camber_clip clip;
    camber_box reached; /* nothing outside it touches a pixel */
    double *points;     /* scratch: a polyline in device px */
    unsigned char *keep;
    size_t point_capacity, keep_capacity;
    uint32_t row; /* of the polyline in work */
} projector;

/* ---- Output; room is reserved a polyline at a time ---- */

static camber_status reserve(projector *p, size_t count) {
    camber_geometry *g = p->geometry;
    /* Clipping makes two points and a piece of each segment at most. */
    if (count > MOST_POINTS / 2 || g->lines.point_count > MOST_POINTS - 2 * count)
        return camber_fail(g->context, CAMBER_ERROR_LIMIT,
                           "scene: more than %zu points; draw a smaller part or simplify more", MOST_POINTS);
    const bool fits =
        camber_grow(g->context, &g->lines.points, &g->point_capacity, g->lines.point_count + 2 * count,
                    2 * sizeof *g->lines.points) &&
        camber_grow(g->context, &g->lines.offsets, &g->offset_capacity, g->lines.polyline_count + count + 1,
                    sizeof *g->lines.offsets) &&
        camber_grow(g->context, &g->rows, &g->row_capacity, g->lines.polyline_count + count, sizeof *g->rows) &&
        camber_grow(g->context, &p->points, &p->point_capacity, count, 2 * sizeof *p->points) &&
        camber_grow(g->context, &p->keep, &p->keep_capacity, count, sizeof *p->keep);
    return fits ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

static bool put_point(void *user, const double *point, bool first) {
    const projector *p = user;
    camber_lines *lines = &p->geometry->lines;
    if (first) {
        p->geometry->rows[lines->polyline_count] = p->row;
        lines->offsets[lines->polyline_count++] = (uint32_t)lines->point_count;
    }
    lines->points[2 * lines->point_count] = (float)point[0];
    lines->points[2 * lines->point_count + 1] = (float)point[1];
    lines->point_count++;
    return true;
}

/* ---- Polylines ---- */

static camber_box world_box(const double *points, size_t count) {
    camber_box box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++) {
        const double x = points[2 * i], y = points[2 * i + 1];
        box.x0 = x < box.x0 ? x : box.x0;
        box.x1 = x > box.x1 ? x : box.x1;
        box.y0 = y < box.y0 ? y : box.y0;
        box.y1 = y > box.y1 ? y : box.y1;
    }
    return box;
}

static camber_status draw_copy(projector *p, const double *world, size_t count, double shift, bool inside) {
    const camber_status status = reserve(p, count);
    if (status != CAMBER_OK)
        return status;
    for (size_t i = 0; i < count; i++)
        camber_view_project(p->view, world[2 * i] + shift, world[2 * i + 1], p->points + 2 * i);
    const size_t left = camber_simplify(p->points, count, p->simplify_px, p->keep);
    if (!inside) {
        camber_clip_polyline(&p->clip, p->points, left);
        return CAMBER_OK;
    }
    for (size_t i = 0; i < left; i++)
        put_point(p, p->points + 2 * i, i == 0);
    return CAMBER_OK;
}

/* Draws the polyline in each copy of the world in which it comes within half a world of the centre: one copy, or
 * two where it crosses that line. */
static camber_status draw_polyline(projector *p, size_t polyline) {
    const double *world = p->features->points + 2 * p->features->offsets[polyline];
    const size_t count = p->features->offsets[polyline + 1] - p->features->offsets[polyline];
    const camber_box box = world_box(world, count);
    if (!(box.x0 <= box.x1 && box.y0 <= box.y1 && box.x1 - box.x0 <= 2.0))
        return CAMBER_OK; /* no points, or not a place on earth */
    const double first = floor(p->view->x - 0.5 - box.x1) + 1.0;
    const double last = fmax(first, ceil(p->view->x + 0.5 - box.x0) - 1.0);
    const size_t before = p->geometry->lines.polyline_count;
    for (double shift = first; shift <= last; shift += 1.0) {
        const camber_box copy = {box.x0 + shift, box.y0, box.x1 + shift, box.y1};
        const camber_box px = camber_view_project_box(p->view, copy);
        if (!camber_box_overlaps(px, p->reached))
            continue;
        const camber_status status = draw_copy(p, world, count, shift, camber_box_holds(p->clip.seen, px));
        if (status != CAMBER_OK)
            return status;
    }
    if (p->geometry->lines.polyline_count > before)
        p->geometry->points_in += count;
    return CAMBER_OK;
}

/* How far from its polyline a stroke touches pixels. */
static double reach_of(const camber_plan_set *set) {
    const double half = 0.5 * (double)set->width_px;
    double factor = set->layer->cap == CAMBER_CAP_SQUARE ? 1.5 : 1.0; /* a corner lies sqrt(2) away */
    if (set->layer->join == CAMBER_JOIN_MITER)
        factor = fmax(factor, (double)set->layer->miter_limit);
    return fmin(half * factor, fmax(half, LARGEST_REACH_PX));
}

static camber_box grown_picture(const camber_view *view, double by) {
    return (camber_box){-by, -by, view->width + by, view->height + by};
}

static camber_status draw_set(projector *p, const camber_plan *plan, camber_plan_set *set) {
    camber_geometry *g = p->geometry;
    const double reach = reach_of(set);
    const double seen = fmax(reach + 16.0, 64.0);
    p->reached = grown_picture(p->view, reach + 1.0);
    p->clip.seen = grown_picture(p->view, seen);
    p->clip.far = grown_picture(p->view, seen + FAR_PX);
    set->first_polyline = g->lines.polyline_count;
    uint32_t counted = UINT32_MAX;
    for (size_t i = 0; i < set->entry_count; i++) {
        const camber_plan_entry entry = plan->entries[set->first_entry + i];
        const size_t before = g->lines.polyline_count;
        p->row = entry.row;
        const camber_status status = draw_polyline(p, entry.polyline);
        if (status != CAMBER_OK)
            return status;
        if (g->lines.polyline_count == before)
            continue;
        /* A later part of a feature counts where the first is not seen. */
        const uint32_t feature = p->features->polyline_feature[entry.polyline];
        const uint32_t features = p->features->feature_counts[entry.polyline];
        g->feature_count += features || feature == counted ? features : 1;
        counted = feature;
    }
    set->polyline_count = g->lines.polyline_count - set->first_polyline;
    return CAMBER_OK;
}

camber_status camber_geometry_create(const camber_features *features, const camber_view *view, double simplify_px,
                                     camber_plan *plan, camber_geometry *geometry) {
    *geometry = (camber_geometry){.context = features->context};
    projector p = {.features = features,
                   .view = view,
                   .geometry = geometry,
                   .simplify_px = simplify_px,
                   .clip = {.put = put_point}};
    p.clip.user = &p;
    camber_status status = reserve(&p, 1);
    for (size_t s = 0; status == CAMBER_OK && s < plan->set_count; s++)
        status = draw_set(&p, plan, plan->sets + s);
    if (status == CAMBER_OK)
        geometry->lines.offsets[geometry->lines.polyline_count] = (uint32_t)geometry->lines.point_count;
    camber_free(features->context, p.keep);
    camber_free(features->context, p.points);
    return status;
}

void camber_geometry_destroy(camber_geometry *geometry) {
    camber_lines_free(geometry->context, &geometry->lines);
    camber_free(geometry->context, geometry->rows);
}
