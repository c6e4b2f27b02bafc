/* Tells whether a label would cover others.
 *
 * Input: shapes, one after the other. Output: whether a shape is free. Main idea: a grid of cells, each with two lists
 * of the shapes that touch it: those of labels that must not overlap, and all others. Of labels that may overlap each
 * other, many can be at one place, and these are not compared. A grid that is very wide or high wraps: cells that are
 * far apart share their lists. So a town is not in one cell if a label on the other side of the world is placed, too.
 */
#include "map/collision.h"

#include <math.h>

/* The most cells along a side of a grid that have lists of their own. */
enum { MOST_CELLS_A_SIDE = 1024 };

camber_status camber_collision_make(camber_context *context, camber_box bounds, double cell,
                                    camber_collision *collision) {
    camber_collision made = {.context = context, .bounds = bounds, .cell = cell};
    made.across = (size_t)((bounds.x1 - bounds.x0) / cell) + 1;
    made.down = (size_t)((bounds.y1 - bounds.y0) / cell) + 1;
    made.columns = made.across < MOST_CELLS_A_SIDE ? made.across : MOST_CELLS_A_SIDE;
    made.rows = made.down < MOST_CELLS_A_SIDE ? made.down : MOST_CELLS_A_SIDE;
    made.cells = camber_alloc_zero(context, 2 * made.columns * made.rows, sizeof *made.cells);
    *collision = made;
    return made.cells ? CAMBER_OK : CAMBER_ERROR_MEMORY;
}

void camber_collision_free(camber_collision *collision) {
    camber_free(collision->context, collision->cells);
    camber_free(collision->context, collision->entries);
    camber_free(collision->context, collision->shapes);
}

/* ---- Shapes ---- */

static bool circles_meet(const camber_obstacle *a, const camber_obstacle *b) {
    const double dx = 0.5 * (a->x0 + a->x1 - b->x0 - b->x1);
    const double dy = 0.5 * (a->y0 + a->y1 - b->y0 - b->y1);
    const double reach = a->radius + b->radius;
    return dx * dx + dy * dy < reach * reach;
}

static bool circle_meets_box(const camber_obstacle *circle, const camber_obstacle *box) {
    const double x = 0.5 * (circle->x0 + circle->x1), y = 0.5 * (circle->y0 + circle->y1);
    const double dx = x - fmin(fmax(x, box->x0), box->x1);
    const double dy = y - fmin(fmax(y, box->y0), box->y1);
    return dx * dx + dy * dy <= circle->radius * circle->radius;
}

bool camber_obstacles_meet(const camber_obstacle *a, const camber_obstacle *b) {
    if (!(a->x0 <= b->x1 && a->x1 >= b->x0 && a->y0 <= b->y1 && a->y1 >= b->y0))
        return false;
    if (a->radius > 0.0)
        return b->radius > 0.0 ? circles_meet(a, b) : circle_meets_box(a, b);
    return b->radius > 0.0 ? circle_meets_box(b, a) : true;
}

/* ---- The grid ---- */

typedef struct cell_range {
    size_t x0, y0, x1, y1; /* x1 and y1 are included */
} cell_range;

static size_t cell_of(double offset, double cell, size_t count) {
    const double at = floor(offset / cell);
    return at <= 0.0 ? 0 : at >= (double)(count - 1) ? count - 1 : (size_t)at;
}

/* Returns the last cell of a range, if ranges of more than count cells would have a list twice. */
static size_t last_cell(size_t first, size_t last, size_t count) {
    return last - first < count ? last : first + count - 1;
}

static cell_range cells_of(const camber_collision *c, const camber_obstacle *shape) {
    const size_t x0 = cell_of(shape->x0 - c->bounds.x0, c->cell, c->across);
    const size_t y0 = cell_of(shape->y0 - c->bounds.y0, c->cell, c->down);
    return (cell_range){x0, y0, last_cell(x0, cell_of(shape->x1 - c->bounds.x0, c->cell, c->across), c->columns),
                        last_cell(y0, cell_of(shape->y1 - c->bounds.y0, c->cell, c->down), c->rows)};
}

static size_t list_of(const camber_collision *c, size_t x, size_t y) {
    return y % c->rows * c->columns + x % c->columns;
}

/* Returns the lists of the shapes of labels that must not overlap, or of all others. */
static uint32_t *lists_of(const camber_collision *c, bool never) {
    return c->cells + (never ? 0 : c->columns * c->rows);
}

static bool hits_list(const camber_collision *c, const camber_obstacle *shape, uint32_t first) {
    for (uint32_t e = first; e; e = c->entries[e - 1].next)
        if (camber_obstacles_meet(shape, c->shapes + c->entries[e - 1].shape))
            return true;
    return false;
}

bool camber_collision_holds(const camber_collision *collision, const camber_obstacle *shape) {
    const camber_box *b = &collision->bounds;
    return shape->x1 >= b->x0 && shape->x0 < b->x1 && shape->y1 >= b->y0 && shape->y0 < b->y1;
}

bool camber_collision_hits(const camber_collision *collision, const camber_obstacle *shape,
                           camber_symbol_overlap overlap) {
    const camber_collision *c = collision;
    if (overlap == CAMBER_OVERLAP_ALWAYS || !camber_collision_holds(c, shape))
        return false;
    const cell_range range = cells_of(c, shape);
    const uint32_t *never = lists_of(c, true), *others = lists_of(c, false);
    for (size_t y = range.y0; y <= range.y1; y++)
        for (size_t x = range.x0; x <= range.x1; x++) {
            const size_t list = list_of(c, x, y);
            if (hits_list(c, shape, never[list]) ||
                (overlap == CAMBER_OVERLAP_NEVER && hits_list(c, shape, others[list])))
                return true;
        }
    return false;
}

camber_status camber_collision_add(camber_collision *collision, const camber_obstacle *shape,
                                   camber_symbol_overlap overlap) {
    camber_collision *c = collision;
    if (!camber_collision_holds(c, shape))
        return CAMBER_OK;
    const cell_range range = cells_of(c, shape);
    uint32_t *lists = lists_of(c, overlap == CAMBER_OVERLAP_NEVER);
    const size_t added = (range.x1 - range.x0 + 1) * (range.y1 - range.y0 + 1);
    if (c->entry_count + added >= UINT32_MAX)
        return camber_fail(c->context, CAMBER_ERROR_LIMIT, "labels: more than 2^32 places in the grid");
    if (!camber_grow(c->context, &c->shapes, &c->shape_capacity, c->shape_count + 1, sizeof *c->shapes) ||
        !camber_grow(c->context, &c->entries, &c->entry_capacity, c->entry_count + added, sizeof *c->entries))
        return CAMBER_ERROR_MEMORY;
    for (size_t y = range.y0; y <= range.y1; y++)
        for (size_t x = range.x0; x <= range.x1; x++) {
            uint32_t *cell = lists + list_of(c, x, y);
            c->entries[c->entry_count++] = (camber_grid_entry){(uint32_t)c->shape_count, *cell};
            *cell = (uint32_t)c->entry_count;
        }
    c->shapes[c->shape_count++] = *shape;
    return CAMBER_OK;
}
