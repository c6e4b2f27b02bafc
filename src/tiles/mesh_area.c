/* Makes triangles of the areas of mesh tiles.
 *
 * Input: the rings that a style fills in a picture of tiles. Output: for each tile corners and triangles, set by set.
 * Main idea: each ring is clipped to the tile's square and what its row reaches around it, side by side, which leaves
 * how often it winds around what is inside; then all rings of a row that follow each other are one polygon of GLU's
 * tessellator, by the nonzero rule, as they are one path for the kernels. GLU is loaded where a tile has areas: no
 * other one needs it. */
#define _GNU_SOURCE /* RTLD_NODELETE: GLU stays, since each tile asks for it */

#include "tiles/mesh_area.h"

#include <dlfcn.h>
#include <math.h>

/* ---- The rings of a picture ---- */

static camber_status add_ring(camber_mesh_picture *picture, size_t *point_capacity, size_t *ring_capacity,
                              const camber_plan_entry *entry, double shift, const camber_excerpt_window *window) {
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
                                             size_t polyline_count, const camber_excerpt_window *window) {
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

/* ---- GLU ---- */

/* Numbers of GLU; the callbacks are those with the polygon's data. */
enum {
    GLU_VERTEX = 100107,
    GLU_ERROR = 100109,
    GLU_EDGE_FLAG = 100110,
    GLU_COMBINE = 100111,
    GLU_RULE = 100140,
    GLU_NONZERO = 100131
};

typedef void callback(void);
typedef struct glu {
    void *handle;
    void *(*create)(void);
    void (*destroy)(void *);
    void (*set_callback)(void *, unsigned, callback *);
    void (*set_property)(void *, unsigned, double);
    void (*set_normal)(void *, double, double, double);
    void (*begin_polygon)(void *, void *);
    void (*begin_contour)(void *);
    void (*put_vertex)(void *, double *, void *);
    void (*end_contour)(void *);
    void (*end_polygon)(void *);
} glu;

static bool find(const glu *g, const char *name, void *function) {
    void *found = dlsym(g->handle, name);
    memcpy(function, &found, sizeof found);
    return found != NULL;
}

static bool load(glu *g) {
    g->handle = dlopen("libGLU.so.1", RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    return g->handle && find(g, "gluNewTess", &g->create) && find(g, "gluDeleteTess", &g->destroy) &&
           find(g, "gluTessCallback", &g->set_callback) && find(g, "gluTessProperty", &g->set_property) &&
           find(g, "gluTessNormal", &g->set_normal) && find(g, "gluTessBeginPolygon", &g->begin_polygon) &&
           find(g, "gluTessBeginContour", &g->begin_contour) && find(g, "gluTessVertex", &g->put_vertex) &&
           find(g, "gluTessEndContour", &g->end_contour) && find(g, "gluTessEndPolygon", &g->end_polygon);
}

static camber_status tell_missing(camber_context *context) {
    return camber_fail(context, CAMBER_ERROR_DEVICE,
                       "tiles: mesh tiles with areas need GLU (Debian: libglu1-mesa); install it, or name a style of "
                       "lines alone with --style");
}

camber_status camber_mesh_plan_find_glu(const camber_mesh_plan *plan) {
    const camber_plan *whole = &plan->zoom->plan;
    bool fills = false;
    for (size_t s = 0; s < whole->set_count; s++)
        for (size_t k = 0; k < whole->sets[s].pair_count && camber_plan_is_area(whole, whole->sets + s); k++)
            fills = fills || plan->reach_px[plan->pair_rows[whole->sets[s].first_pair + k]] >= 0.0f;
    glu g = {0};
    const bool found = !fills || load(&g);
    if (g.handle)
        dlclose(g.handle);
    return found ? CAMBER_OK : tell_missing(plan->context);
}

/* ---- Triangles ---- */

typedef struct filler {
    const camber_mesh_picture *picture;
    camber_mesh_tile *tile;
    glu glu;
    void *tess; /* NULL: none yet */
    double centre_x, centre_y, edge, scale;
    uint16_t row;
    float *clipped[2]; /* pairs of px from the centre */
    size_t clipped_capacity[2];
    bool failed; /* no memory */
} filler;

/* Adds a corner; its number. */
static size_t add_corner(filler *f, double x, double y) {
    camber_mesh_tile *tile = f->tile;
    if (!camber_grow(tile->context, &tile->corners, &tile->corner_capacity, tile->corner_count + 1,
                     sizeof *tile->corners)) {
        f->failed = true;
        return 0;
    }
    tile->corners[tile->corner_count] = (camber_mesh_corner){(int16_t)x, (int16_t)y, f->row};
    return tile->corner_count++;
}

static void take_vertex(void *corner, void *user) {
    filler *f = user;
    camber_mesh_tile *tile = f->tile;
    if (!camber_grow(tile->context, &tile->triangles, &tile->triangle_capacity, tile->index_count + 1,
                     sizeof *tile->triangles)) {
        f->failed = true;
        return;
    }
    tile->triangles[tile->index_count++] = (uint32_t)(uintptr_t)corner;
}

/* With this the triangles come one by one. */
static void take_edge_flag(unsigned char flag, void *user) {
    (void)flag;
    (void)user;
}

/* Where edges cross. */
static void take_crossing(double at[3], void *corners[4], float weights[4], void **made, void *user) {
    (void)corners;
    (void)weights;
    *made = (void *)(uintptr_t)add_corner(user, floor(at[0] + 0.5), floor(at[1] + 0.5));
}

/* No memory: of polygons that begin, turn and end as these do it tells nothing else. */
static void take_error(unsigned error, void *user) {
    (void)error;
    ((filler *)user)->failed = true;
}

static camber_status open_tess(filler *f) {
    if (!load(&f->glu))
        return tell_missing(f->tile->context);
    if (!(f->tess = f->glu.create()))
        return CAMBER_ERROR_MEMORY;
    f->glu.set_callback(f->tess, GLU_VERTEX, (callback *)take_vertex);
    f->glu.set_callback(f->tess, GLU_EDGE_FLAG, (callback *)take_edge_flag);
    f->glu.set_callback(f->tess, GLU_COMBINE, (callback *)take_crossing);
    f->glu.set_callback(f->tess, GLU_ERROR, (callback *)take_error);
    f->glu.set_property(f->tess, GLU_RULE, GLU_NONZERO);
    f->glu.set_normal(f->tess, 0.0, 0.0, -1.0); /* y goes down, and outlines face up */
    return CAMBER_OK;
}

/* ---- Clipping ---- */

/* Cuts a closed ring at one side of the square: what lies beyond goes, and its ends are joined. axis: 0 x, 1 y. */
static size_t clip_side(filler *f, const float *from, size_t count, size_t to, int axis, float sign) {
    const float edge = (float)f->edge;
    size_t kept = 0;
    if (!camber_grow(f->tile->context, &f->clipped[to], &f->clipped_capacity[to], 2 * count + 2,
                     2 * sizeof *f->clipped[to])) {
        f->failed = true;
        return 0;
    }
    for (size_t i = 0; i < count; i++) {
        const float *a = from + 2 * i, *b = from + 2 * ((i + 1) % count);
        const float da = edge - sign * a[axis], db = edge - sign * b[axis];
        float *out = f->clipped[to] + 2 * kept;
        if (da >= 0.0f) {
            out[0] = a[0];
            out[1] = a[1];
            out += 2;
            kept++;
        }
        if ((da < 0.0f) != (db < 0.0f)) {
            /* From the inside out, so that neighbours cut at the same bits. */
            const float *in = da >= 0.0f ? a : b, *beyond = da >= 0.0f ? b : a;
            const float share = fabsf(da >= 0.0f ? da : db) / (fabsf(da) + fabsf(db));
            out[axis] = sign * edge;
            out[1 - axis] = in[1 - axis] + (beyond[1 - axis] - in[1 - axis]) * share;
            kept++;
        }
    }
    return kept;
}

/* Clips a ring to the tile; the points are in clipped[0] then. */
static size_t clip_ring(filler *f, const camber_mesh_line *ring) {
    const float *from = f->picture->ring_points + 2 * ring->first;
    size_t count = ring->count - 1; /* its first point is its last, too */
    if (!camber_grow(f->tile->context, &f->clipped[0], &f->clipped_capacity[0], count + 1, 2 * sizeof **f->clipped)) {
        f->failed = true;
        return 0;
    }
    for (size_t i = 0; i < count; i++) {
        f->clipped[0][2 * i] = from[2 * i] - (float)f->centre_x;
        f->clipped[0][2 * i + 1] = from[2 * i + 1] - (float)f->centre_y;
    }
    for (int side = 0; side < 4 && count > 2; side++)
        count = clip_side(f, f->clipped[side % 2], count, (size_t)(1 - side % 2), side / 2, side % 2 ? -1.0f : 1.0f);
    return count;
}

/* ---- A tile ---- */

static void put_ring(filler *f, const camber_mesh_line *ring) {
    const size_t count = clip_ring(f, ring);
    int last_x = INT16_MIN, last_y = INT16_MIN;
    if (count < 3 || f->failed)
        return;
    f->glu.begin_contour(f->tess);
    for (size_t i = 0; i < count && !f->failed; i++) {
        const int16_t x = camber_mesh_quantise((double)f->clipped[0][2 * i], f->scale),
                      y = camber_mesh_quantise((double)f->clipped[0][2 * i + 1], f->scale);
        double at[3] = {x, y, 0.0};
        if (x == last_x && y == last_y)
            continue;
        const size_t corner = add_corner(f, at[0], at[1]);
        f->glu.put_vertex(f->tess, at, (void *)(uintptr_t)corner);
        last_x = x;
        last_y = y;
    }
    f->glu.end_contour(f->tess);
}

static bool touches(const filler *f, const camber_mesh_line *ring) {
    return (double)ring->x0 - f->centre_x <= f->edge && (double)ring->x1 - f->centre_x >= -f->edge &&
           (double)ring->y0 - f->centre_y <= f->edge && (double)ring->y1 - f->centre_y >= -f->edge;
}

/* Fills the rings [first, end), which have one row. */
static camber_status fill_row(filler *f, size_t first, size_t end) {
    camber_mesh_tile *tile = f->tile;
    const camber_mesh_plan *plan = f->picture->plan;
    const camber_mesh_line *rings = f->picture->rings;
    const size_t before = tile->index_count;
    camber_status status = f->tess ? CAMBER_OK : open_tess(f);
    if (status != CAMBER_OK)
        return status;
    if ((status = camber_mesh_tile_number(tile, plan->pair_rows[rings[first].pair], &f->row)) != CAMBER_OK)
        return status;
    f->glu.begin_polygon(f->tess, f);
    for (size_t i = first; i < end; i++)
        if (touches(f, rings + i))
            put_ring(f, rings + i);
    f->glu.end_polygon(f->tess);
    tile->index_count -= (tile->index_count - before) % 3; /* memory ran out */
    if (f->failed ||
        (tile->index_count > before &&
         !camber_mesh_tile_end_fill(tile, camber_mesh_set_of(&plan->zoom->plan, rings[first].pair), before)))
        return CAMBER_ERROR_MEMORY;
    return CAMBER_OK;
}

/* Leaves out the corners that no triangle has: GLU made others where they met. */
static camber_status drop_unused(camber_mesh_tile *tile) {
    uint32_t *numbers = camber_alloc_zero(tile->context, tile->corner_count, sizeof *numbers);
    uint32_t used = 0;
    if (!numbers)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < tile->index_count; i++)
        numbers[tile->triangles[i]] = 1;
    for (size_t i = 0; i < tile->corner_count; i++)
        if (numbers[i]) {
            numbers[i] = used;
            tile->corners[used++] = tile->corners[i];
        }
    for (size_t i = 0; i < tile->index_count; i++)
        tile->triangles[i] = numbers[tile->triangles[i]];
    tile->corner_count = used;
    camber_free(tile->context, numbers);
    return CAMBER_OK;
}

camber_status camber_mesh_tile_fill(const camber_mesh_picture *picture, uint32_t x, uint32_t y,
                                    camber_mesh_tile *tile) {
    const double px = tile->tile_px;
    filler f = {.picture = picture,
                .tile = tile,
                .centre_x = ((double)x + 0.5) * px,
                .centre_y = ((double)y + 0.5) * px,
                .scale = tile->units / px};
    const uint32_t *rows = picture->plan->pair_rows;
    camber_status status = CAMBER_OK;
    for (size_t i = 0, end; i < picture->ring_count && status == CAMBER_OK; i = end) {
        bool near = false;
        f.edge = 0.5 * px + (double)picture->plan->reach_px[rows[picture->rings[i].pair]]; /* 1 px, and a translation */
        for (end = i; end < picture->ring_count && rows[picture->rings[end].pair] == rows[picture->rings[i].pair];
             end++)
            near = near || touches(&f, picture->rings + end);
        status = near ? fill_row(&f, i, end) : CAMBER_OK;
    }
    if (f.tess)
        f.glu.destroy(f.tess);
    if (f.glu.handle)
        dlclose(f.glu.handle);
    camber_free(tile->context, f.clipped[0]);
    camber_free(tile->context, f.clipped[1]);
    return status == CAMBER_OK && tile->corner_count ? drop_unused(tile) : status;
}
