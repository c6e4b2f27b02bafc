#include "formats/tile_cover.h"

#include "base/maths.h"

#include <math.h>

static const double MOST_TILES = 65536;

/* A view that ends at a tile's border, within this fraction of a tile, does not see the tile beyond the border. */
static const double SLACK = 1e-6;

typedef struct grid {
    const camber_tile_cover *cover;
    double side;                       /* the width of the world in tiles */
    double west, north, columns, rows; /* the tiles that may be visible; west may be negative */
    double wanted[4];                  /* bounds in tiles */
} grid;

/* Whether a tile is wholly on the outer side of one of the quadrangle's sides. The quadrangle's bounding box was tested
 * before. */
static bool is_outside(const grid *g, double column, double row) {
    const double *c = g->cover->corners;
    double area = 0;
    for (int i = 0; i < 4; i++) {
        const double *p = c + 2 * i, *q = c + 2 * ((i + 1) % 4);
        area += p[0] * q[1] - q[0] * p[1];
    }
    for (int i = 0; i < 4; i++) {
        const double *p = c + 2 * i, *q = c + 2 * ((i + 1) % 4);
        const double dx = (q[0] - p[0]) * g->side, dy = (q[1] - p[1]) * g->side;
        double most = -INFINITY;
        for (int k = 0; k < 4; k++) {
            const double x = column + (k & 1) - p[0] * g->side, y = row + (k >> 1) - p[1] * g->side;
            most = fmax(most, (dx * y - dy * x) * (area < 0 ? -1 : 1));
        }
        if (most <= SLACK * camber_length(dx, dy))
            return true;
    }
    return false;
}

/* Whether the view sees the tile. Bounds are in the first copy of the world, so a tile in another copy is compared by
 * its position in the first. */
static bool is_seen(const grid *g, double column, double row) {
    const double at = column - floor(column / g->side) * g->side;
    return column >= g->west && column < g->west + g->columns && row >= g->north && row < g->north + g->rows &&
           at < g->wanted[2] && at + 1 > g->wanted[0] && row < g->wanted[3] && row + 1 > g->wanted[1] &&
           !is_outside(g, column, row);
}

static unsigned open_sides(const grid *g, double column, double row) {
    return (is_seen(g, column - 1, row) ? 0 : CAMBER_SIDE_WEST) | (is_seen(g, column + 1, row) ? 0 : CAMBER_SIDE_EAST) |
           (row > 0 && !is_seen(g, column, row - 1) ? CAMBER_SIDE_NORTH : 0) |
           (row + 1 < g->side && !is_seen(g, column, row + 1) ? CAMBER_SIDE_SOUTH : 0);
}

static void find_grid(grid *g) {
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < 8; i++) {
        low[i & 1] = fmin(low[i & 1], g->cover->corners[i] * g->side);
        high[i & 1] = fmax(high[i & 1], g->cover->corners[i] * g->side);
    }
    g->west = floor(low[0] + SLACK);
    g->columns = ceil(high[0] - SLACK) - g->west;
    /* The view is at least as wide as the world, so each tile is listed once, in the copy of the world around the
     * view's middle. */
    if (high[0] - low[0] >= g->side) {
        g->west = floor((low[0] + high[0]) / 2 / g->side) * g->side;
        g->columns = g->side;
    }
    g->north = fmax(floor(low[1] + SLACK), 0);
    g->rows = fmax(fmin(ceil(high[1] - SLACK), g->side) - g->north, 0);
}

camber_status camber_tile_cover_list(camber_context *context, const camber_tile_cover *cover, int zoom,
                                     const double *bounds, camber_tile_address **addresses, size_t *count) {
    grid g = {.cover = cover, .side = ldexp(1.0, zoom), .wanted = {-INFINITY, -INFINITY, INFINITY, INFINITY}};
    for (int i = 0; bounds && i < 4; i++)
        g.wanted[i] = bounds[i] * g.side;
    find_grid(&g);
    if (g.columns * g.rows > MOST_TILES)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "the view sees more than %.0f tiles of zoom %d; choose a smaller picture", MOST_TILES, zoom);
    camber_tile_address *made = camber_alloc(context, (size_t)(g.columns * g.rows) + 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    /* Columns west of the first world get the numbers of a copy further east. */
    const double worlds = fmax(ceil(-g.west / g.side), 0) * g.side;
    *count = 0;
    for (double row = g.north; row < g.north + g.rows; row++)
        for (double column = g.west; column < g.west + g.columns; column++)
            if (is_seen(&g, column, row))
                made[(*count)++] = (camber_tile_address){.zoom = zoom,
                                                         .column = (uint32_t)(column + worlds),
                                                         .row = (uint32_t)row,
                                                         .open_sides = open_sides(&g, column, row)};
    *addresses = made;
    return CAMBER_OK;
}
