/* Collisions of labels: a grid of the boxes and circles that labels take up in a picture. */
#ifndef CAMBER_MAP_COLLISION_H
#define CAMBER_MAP_COLLISION_H

#include "map/view.h"
#include "style/symbol.h"

/* A box, or a circle about its middle. */
typedef struct camber_obstacle {
    double x0, y0, x1, y1;
    double radius; /* 0: a box */
} camber_obstacle;

typedef struct camber_grid_entry {
    uint32_t shape;
    uint32_t next; /* the next entry of the list: its number + 1; 0: none */
} camber_grid_entry;

typedef struct camber_collision {
    camber_context *context;
    camber_box bounds; /* shapes outside it are ignored */
    double cell;
    size_t across, down;  /* cells */
    size_t columns, rows; /* of lists, at most as many: the cell (x, y) has the list (x % columns, y % rows) */
    /* By list: the number of its first entry + 1; 0: none. First the lists of shapes of labels that must not overlap,
     * then the lists of all others. */
    uint32_t *cells;
    camber_grid_entry *entries;
    size_t entry_count, entry_capacity;
    camber_obstacle *shapes;
    size_t shape_count, shape_capacity;
} camber_collision;

/* Returns CAMBER_ERROR_MEMORY. Call camber_collision_free even after a failure. */
camber_status camber_collision_make(camber_context *context, camber_box bounds, double cell,
                                    camber_collision *collision);
void camber_collision_free(camber_collision *collision);
/* Whether the shape is at least partly within the bounds. */
bool camber_collision_holds(const camber_collision *collision, const camber_obstacle *shape);
/* Whether a new shape meets a shape in the grid that it may not overlap. */
bool camber_collision_hits(const camber_collision *collision, const camber_obstacle *shape,
                           camber_symbol_overlap overlap);
/* Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_LIMIT (2^32 entries). */
camber_status camber_collision_add(camber_collision *collision, const camber_obstacle *shape,
                                   camber_symbol_overlap overlap);
/* Whether two shapes meet. Boxes that only touch meet, too. */
bool camber_obstacles_meet(const camber_obstacle *a, const camber_obstacle *b);

#endif
