/* Properties over random polylines: what must hold for each of them. A case that breaks one is made as small as it
 * still breaks it, and printed with its seed. */
#ifndef CAMBER_TESTS_PROPERTY_H
#define CAMBER_TESTS_PROPERTY_H

#include "scene.h"

enum { PROPERTY_POINTS = 64, PROPERTY_SIDE_PX = 128, PROPERTY_STORY = 160 };

/* A polyline and how it is drawn. Coordinates are multiples of 1/256 px, from about 16 to 112. */
typedef struct property_case {
    float points[2 * PROPERTY_POINTS];
    size_t count;
    camber_stroke stroke;
    camber_method method;
    uint64_t dice; /* for what the property itself chooses: the same for each smaller case */
} property_case;

typedef enum property_outcome {
    PROPERTY_HOLDS,
    PROPERTY_SILENT, /* it does not speak of this case */
    PROPERTY_BROKEN,
} property_outcome;

typedef struct property {
    const char *name;
    void (*make)(property_case *c, uint64_t *seed);
    /* Says in story how it is broken. */
    property_outcome (*check)(void *user, const property_case *c, char story[PROPERTY_STORY]);
    size_t cases;
    size_t known; /* cases that are known to break it */
} property;

/* Tries all cases, shrinks and prints the first three that break the property, and fails where more do than are known
 * or where the property speaks of less than a quarter of the cases. CAMBER_SEED in the environment begins elsewhere,
 * CAMBER_CASES tries as many. */
void property_check(const property *p, void *user);

/* ---- A context to make meshes with: the state of a group ---- */

typedef struct property_bench {
    host h;
    camber_context *context;
} property_bench;

static inline int property_set_up(void **state) {
    static property_bench b;
    b.context = host_context(&b.h);
    *state = &b;
    return 0;
}

static inline int property_tear_down(void **state) {
    property_bench *b = *state;
    host_done(&b->h, b->context);
    return 0;
}

/* ---- Makers ---- */

/* Any polyline: gentle, wild, of tiny steps, of mixed ones, on a coarse grid with repeated points and reversals, a
 * ring, a dot. Any width, join, cap and method. */
void property_make_any(property_case *c, uint64_t *seed);
/* Gentle: steps of at least twice the width, turns of at most 100 degrees: no join is tight. */
void property_make_plain(property_case *c, uint64_t *seed);
/* Steps of at least the width, any turns: lines that cross themselves and turn back on themselves. */
void property_make_crossing(property_case *c, uint64_t *seed);
/* A ring that does not repeat points, at least as plain. */
void property_make_ring(property_case *c, uint64_t *seed);

bool property_is_ring(const property_case *c);
void property_reverse(property_case *c);

/* ---- Meshes of cases ---- */

camber_polylines *property_polylines(camber_context *context, const property_case *c);
/* The twin's. */
camber_mesh_data property_mesh(camber_context *context, const property_case *c);
/* Writes the triangles as triples of indices, in the order and winding that GL draws them with; gives how many. The
 * caller frees them. */
size_t property_triangles(const camber_mesh_data *data, uint32_t (**triangles)[3]);
/* Where a vertex lies when drawn with this width: the formula of camber_vertex. */
void property_place(const camber_vertex *v, double width_px, double place[2]);

#endif
