/* Makes triangles from areas, which are closed rings filled by the nonzero rule.
 *
 * Coordinates are whole units, so all decisions are exact. The triangles of a fill do not overlap, except by the one
 * unit to which crossings are rounded. */
#ifndef CAMBER_MAP_TRIANGULATOR_H
#define CAMBER_MAP_TRIANGULATOR_H

#include "base/base.h"

typedef struct camber_corner {
    int32_t x, y;
} camber_corner;

/* A rectangle that rings are clipped to, and the resolution of the resulting coordinates, which are relative to its
 * centre. */
typedef struct camber_ring_window {
    double centre_x, centre_y;
    float half_width, half_height;
    double units; /* units per px. A window is at most 2^24 units wide */
} camber_ring_window;

typedef struct camber_ring_box {
    float x0, y0, x1, y1;
} camber_ring_box;

/* Triangles that the triangulator owns. They are valid until its next call. */
typedef struct camber_triangles {
    const camber_corner *corners; /* corner_count; each is used by a triangle */
    size_t corner_count;
    const uint32_t *indices; /* index_count: three per triangle, counter-clockwise with y pointing down */
    size_t index_count;
} camber_triangles;

typedef struct camber_triangulator camber_triangulator;

/* Whether GLU is installed, which makes triangles from rings that meet. */
bool camber_triangulator_is_available(void);
/* Logs that GLU is not installed, and returns CAMBER_ERROR_DEVICE. */
camber_status camber_triangulator_fail_missing(camber_context *context);
/* Returns CAMBER_ERROR_MEMORY, CAMBER_ERROR_DEVICE (GLU is not installed). */
camber_status camber_triangulator_create(camber_context *context, camber_triangulator **triangulator);
void camber_triangulator_destroy(camber_triangulator *triangulator);

static inline bool camber_ring_touches(const camber_ring_box *box, const camber_ring_window *window) {
    return (double)box->x0 - window->centre_x <= (double)window->half_width &&
           (double)box->x1 - window->centre_x >= -(double)window->half_width &&
           (double)box->y0 - window->centre_y <= (double)window->half_height &&
           (double)box->y1 - window->centre_y >= -(double)window->half_height;
}
/* Clips a ring to the window and adds it to the next fill. points: count pairs of px; the last equals the first. */
camber_status camber_triangulator_add(camber_triangulator *triangulator, const float *points, size_t count,
                                      const camber_ring_window *window);
/* Makes triangles from the rings that were added, and forgets the rings. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_triangulator_fill(camber_triangulator *triangulator, camber_triangles *triangles);

#endif
