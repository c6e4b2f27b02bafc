/* Makes triangles of areas: of closed rings, by the nonzero rule.
 *
 * Points are whole units, so that what is decided is exact. No two triangles of a fill overlap, but by the unit that
 * crossings are rounded by. */
#ifndef CAMBER_MAP_TRIANGULATOR_H
#define CAMBER_MAP_TRIANGULATOR_H

#include "base/base.h"

typedef struct camber_corner {
    int32_t x, y;
} camber_corner;

/* A rectangle that rings are clipped to, and the units that points lie on then, from its centre. */
typedef struct camber_ring_window {
    double centre_x, centre_y;
    float half_width, half_height;
    double units; /* a px. A window is up to 2^24 units wide */
} camber_ring_window;

typedef struct camber_ring_box {
    float x0, y0, x1, y1;
} camber_ring_box;

/* Triangles that the triangulator made and owns, until its next call. */
typedef struct camber_triangles {
    const camber_corner *corners; /* corner_count: each is one of a triangle */
    size_t corner_count;
    const uint32_t *indices; /* index_count: three a triangle, counter-clockwise where y goes down */
    size_t index_count;
} camber_triangles;

typedef struct camber_triangulator camber_triangulator;

/* Whether GLU is here, which makes triangles of rings that meet. */
bool camber_triangulator_is_here(void);
/* Says that it is not; returns CAMBER_ERROR_DEVICE. */
camber_status camber_triangulator_tell_missing(camber_context *context);
/* Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_DEVICE (GLU is not here). */
camber_status camber_triangulator_create(camber_context *context, camber_triangulator **triangulator);
void camber_triangulator_destroy(camber_triangulator *triangulator);

static inline bool camber_ring_touches(const camber_ring_box *box, const camber_ring_window *window) {
    return (double)box->x0 - window->centre_x <= (double)window->half_width &&
           (double)box->x1 - window->centre_x >= -(double)window->half_width &&
           (double)box->y0 - window->centre_y <= (double)window->half_height &&
           (double)box->y1 - window->centre_y >= -(double)window->half_height;
}
/* Clips a ring to the window and adds it to the next fill. points: count pairs of px, the last equal to the first. */
camber_status camber_triangulator_add(camber_triangulator *triangulator, const float *points, size_t count,
                                      const camber_ring_window *window);
/* Makes triangles of the rings that were added, and forgets these. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_triangulator_fill(camber_triangulator *triangulator, camber_triangles *triangles);

#endif
