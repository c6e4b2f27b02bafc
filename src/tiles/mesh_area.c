/* Triangulates the areas of mesh tiles.
 *
 * Input: the rings that a style fills in a picture of tiles. Output: for each tile, corners and triangles, grouped by
 * set. Main idea: consecutive rings with the same row are filled together, because kernels also fill them as one path.
 * They are clipped to the tile's square, extended by the row's reach. */
#include "tiles/mesh_area.h"

#include <math.h>

/* ---- The rings of a picture ---- */

static camber_status add_ring(camber_mesh_picture *picture, size_t *point_capacity, size_t *ring_capacity,
                              const camber_plan_entry *entry, double shift, const camber_view *window) {
    const camber_zoom_plan *zoom = picture->plan->zoom;
    const camber_features *f = zoom->features;
    const size_t first = f->offsets[entry->polyline], end = f->offsets[entry->polyline + 1];
    camber_mesh_line ring = {.first = picture->ring_point_count, .pair = entry->pair, .x0 = INFINITY, .y0 = INFINITY};
    ring.x1 = ring.y1 = -INFINITY;
    if (!camber_grow(zoom->context, &picture->ring_points, point_capacity, picture->ring_point_count + end - first,
                     2 * sizeof *picture->ring_points) ||
        !camber_grow(zoom->context, &picture->rings, ring_capacity, picture->ring_count + 1, sizeof *picture->rings))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = first; i < end; i++) {
        const float x =
            (float)((f->points[2 * i] + shift - window->x) * zoom->view.scale_px + 0.5 * (double)window->width);
        const float y =
            (float)((f->points[2 * i + 1] - window->y) * zoom->view.scale_px + 0.5 * (double)window->height);
        if ((i > first && i + 1 < end && f->importance && f->importance[i] < zoom->least_importance) || !isfinite(x) ||
            !isfinite(y))
            continue;
        float *to = picture->ring_points + 2 * (ring.first + ring.count++);
        to[0] = x;
        to[1] = y;
        ring.x0 = fminf(ring.x0, x);
        ring.y0 = fminf(ring.y0, y);
        ring.x1 = fmaxf(ring.x1, x);
        ring.y1 = fmaxf(ring.y1, y);
    }
    const bool seen = ring.count > 3 && ring.x1 > -1e3f && ring.y1 > -1e3f && ring.x0 < (float)window->width + 1e3f &&
                      ring.y0 < (float)window->height + 1e3f;
    if (seen) {
        picture->rings[picture->ring_count++] = ring;
        picture->ring_point_count += ring.count;
    }
    return CAMBER_OK;
}

camber_status camber_mesh_picture_take_rings(camber_mesh_picture *picture, const uint32_t *polylines,
                                             size_t polyline_count, const camber_view *window) {
    const camber_mesh_plan *meshes = picture->plan;
    const camber_zoom_plan *zoom = picture->plan->zoom;
    const camber_plan *plan = &zoom->plan;
    camber_plan_entries listed = {0};
    size_t point_capacity = 0, ring_capacity = 0;
    camber_status status = camber_plan_list(zoom->features, plan, polylines, polyline_count, &listed);
    for (size_t s = 0; s < plan->set_count && status == CAMBER_OK; s++)
        for (size_t i = listed.first_entries[s];
             i < listed.first_entries[s + 1] && camber_plan_is_area(plan, plan->sets + s) && status == CAMBER_OK; i++)
            for (double shift = -1.0; shift <= 1.0 && status == CAMBER_OK &&
                                      meshes->reach_px[meshes->pair_rows[listed.entries[i].pair]] >= 0.0f;
                 shift += 1.0)
                status = add_ring(picture, &point_capacity, &ring_capacity, listed.entries + i, shift, window);
    camber_plan_entries_free(&listed);
    return status;
}

/* ---- Triangles ---- */

static bool touches(const camber_mesh_line *ring, const camber_ring_window *window) {
    const camber_ring_box box = {ring->x0, ring->y0, ring->x1, ring->y1};
    return camber_ring_touches(&box, window);
}

camber_status camber_mesh_plan_find_glu(const camber_mesh_plan *plan) {
    const camber_plan *whole = &plan->zoom->plan;
    bool fills = false;
    for (size_t s = 0; s < whole->set_count; s++)
        for (size_t k = 0; k < whole->sets[s].pair_count && camber_plan_is_area(whole, whole->sets + s); k++)
            fills = fills || plan->reach_px[plan->pair_rows[whole->sets[s].first_pair + k]] >= 0.0f;
    return !fills || camber_triangulator_is_available() ? CAMBER_OK : camber_triangulator_fail_missing(plan->context);
}

/* Appends the new triangles to the tile's triangles. */
static camber_status take_triangles(camber_mesh_tile *tile, const camber_triangles *made, uint16_t row) {
    const uint32_t first = (uint32_t)tile->corner_count;
    if (!camber_grow(tile->context, &tile->corners, &tile->corner_capacity, tile->corner_count + made->corner_count,
                     sizeof *tile->corners) ||
        !camber_grow(tile->context, &tile->triangles, &tile->triangle_capacity, tile->index_count + made->index_count,
                     sizeof *tile->triangles))
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < made->corner_count; i++)
        tile->corners[tile->corner_count++] =
            (camber_mesh_corner){(int16_t)made->corners[i].x, (int16_t)made->corners[i].y, row};
    for (size_t i = 0; i < made->index_count; i++)
        tile->triangles[tile->index_count++] = first + made->indices[i];
    return CAMBER_OK;
}

/* Fills the rings [first, end), which all have the same row. */
static camber_status fill_row(const camber_mesh_picture *picture, size_t first, size_t end,
                              const camber_ring_window *window, camber_mesh_tile *tile) {
    const camber_mesh_plan *plan = picture->plan;
    const size_t before = tile->index_count;
    camber_triangles made = {0};
    uint16_t row = 0;
    camber_status status = CAMBER_OK;
    if (!tile->triangulator)
        status = camber_triangulator_create(tile->context, &tile->triangulator);
    if (status == CAMBER_OK)
        status = camber_mesh_tile_number(tile, plan->pair_rows[picture->rings[first].pair], &row);
    for (size_t i = first; i < end && status == CAMBER_OK; i++)
        if (touches(picture->rings + i, window))
            status = camber_triangulator_add(tile->triangulator, picture->ring_points + 2 * picture->rings[i].first,
                                             picture->rings[i].count, window);
    if (status == CAMBER_OK)
        status = camber_triangulator_fill(tile->triangulator, &made);
    if (status == CAMBER_OK)
        status = take_triangles(tile, &made, row);
    if (status == CAMBER_OK && made.index_count &&
        !camber_mesh_tile_end_fill(tile, camber_mesh_set_of(&plan->zoom->plan, picture->rings[first].pair), before))
        status = CAMBER_ERROR_MEMORY;
    return status;
}

camber_status camber_mesh_tile_fill(const camber_mesh_picture *picture, uint32_t x, uint32_t y,
                                    camber_mesh_tile *tile) {
    const double px = tile->tile_px;
    const uint32_t *rows = picture->plan->pair_rows;
    camber_ring_window window = {
        .centre_x = ((double)x + 0.5) * px, .centre_y = ((double)y + 0.5) * px, .units = tile->units / px};
    camber_status status = CAMBER_OK;
    for (size_t i = 0, end; i < picture->ring_count && status == CAMBER_OK; i = end) {
        const uint32_t row = rows[picture->rings[i].pair];
        bool near = false;
        window.half_width = window.half_height =
            (float)(0.5 * px + (double)picture->plan->reach_px[row]); /* includes 1 px and the translation */
        for (end = i; end < picture->ring_count && rows[picture->rings[end].pair] == row; end++)
            near = near || touches(picture->rings + end, &window);
        status = near ? fill_row(picture, i, end, &window, tile) : CAMBER_OK;
    }
    return status;
}
