/* Draws single polylines small and white on nothing, for the properties of pictures. */
#ifndef CAMBER_TESTS_EASEL_H
#define CAMBER_TESTS_EASEL_H

#include "picture.h"
#include "property.h"

enum { EASEL_PIXELS = PROPERTY_SIDE_PX * PROPERTY_SIDE_PX };

typedef struct easel {
    studio studio;
    camber_mesh *mesh;
    camber_overlap overlap;
} easel;

typedef struct easel_picture {
    uint8_t level[EASEL_PIXELS]; /* of 255, how much of each pixel is covered */
} easel_picture;

static inline bool easel_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    easel_picture *p = user;
    const size_t first = (size_t)first_row * PROPERTY_SIDE_PX;
    for (size_t i = 0; i < (size_t)row_count * PROPERTY_SIDE_PX; i++)
        p->level[first + i] = rgba[4 * i + 3];
    return true;
}

static inline void easel_draw(easel *e, const property_case *c, easel_picture *drawn) {
    const uint32_t offsets[] = {0, (uint32_t)c->count};
    const camber_polylines_desc desc = {c->points, c->count, offsets, 1, NULL, false};
    const camber_tessellation_desc tessellation = {&c->stroke, 1, c->method, 0, false};
    const camber_paint paint = {.width_px = c->stroke.width_px, .color = {1, 1, 1, 1}};
    const camber_pass pass = {.mesh = e->mesh, .paints = &paint, .paint_count = 1, .overlap = e->overlap};
    const camber_frame frame = {
        .width = PROPERTY_SIDE_PX, .height = PROPERTY_SIDE_PX, .passes = &pass, .pass_count = 1};
    camber_polylines *polylines = NULL;
    assert_int_equal(camber_polylines_create(e->studio.context, &desc, &polylines), CAMBER_OK);
    assert_int_equal(camber_tessellate(e->mesh, polylines, &tessellation), CAMBER_OK);
    camber_polylines_destroy(polylines);
    assert_int_equal(camber_render(studio_any(&e->studio), &frame, easel_rows, drawn, NULL), CAMBER_OK);
}

/* For cmocka's groups. */
static inline int easel_open(void **state) {
    static easel e;
    *state = &e;
    return studio_open(&e.studio) && camber_mesh_create(e.studio.device, studio_any(&e.studio), &e.mesh) == CAMBER_OK
               ? 0
               : -1;
}

static inline int easel_close(void **state) {
    easel *e = *state;
    camber_mesh_destroy(e->mesh);
    studio_close(&e->studio);
    return 0;
}

#endif
