/* What OpenCL draws, for the tests: beside GL, and stage by stage beside the twin. */
#ifndef CAMBER_TESTS_COVERING_H
#define CAMBER_TESTS_COVERING_H

#include "picture.h"

#include "base/perspective.h"
#include "cover/cover.h"

typedef struct covering {
    studio s; /* GL, where that is there */
    camber_renderer *cl;
} covering;

static inline void covering_compare(const camber_cover_stages *device, const camber_cover_stages *twin) {
    assert_int_equal(device->shape_count, twin->shape_count);
    assert_int_equal(device->tile_count, twin->tile_count);
    assert_memory_equal(device->boxes, twin->boxes, 4 * twin->shape_count);
    for (size_t i = 0; i < twin->shape_count; i++) {
        if ((twin->boxes[i] & 255u) > (twin->boxes[i] >> 16 & 255u))
            continue;
        assert_memory_equal(device->shapes + CAMBER_SHAPE_WORDS * i, twin->shapes + CAMBER_SHAPE_WORDS * i,
                            4 * CAMBER_SHAPE_WORDS);
        if (twin->planes)
            assert_memory_equal(device->planes + CAMBER_PLANE_WORDS * i, twin->planes + CAMBER_PLANE_WORDS * i,
                                4 * CAMBER_PLANE_WORDS);
        if (twin->measures)
            assert_memory_equal(device->measures + CAMBER_SHAPE_MEASURES * i,
                                twin->measures + CAMBER_SHAPE_MEASURES * i, 4 * CAMBER_SHAPE_MEASURES);
    }
    assert_memory_equal(device->starts, twin->starts, 4 * (twin->tile_count + 1));
    assert_memory_equal(device->lists, twin->lists, 4 * (size_t)twin->starts[twin->tile_count]);
}

/* As camber_render does of a frame. */
static inline void covering_tilt(camber_cover_scene *drawn, double pitch_deg, uint32_t width, uint32_t height) {
    const camber_perspective p = camber_perspective_of(pitch_deg, height);
    drawn->pitched = true;
    drawn->eye = (camber_eye){0.5f * (float)width, 0.5f * (float)height, (float)p.cosine, (float)p.fall};
    drawn->horizon = camber_perspective_horizon(&p, height);
}

/* Draws on the device and on the host, which must do the same; gives the picture, which is freed with camber_free. */
static inline uint8_t *covering_draw_twice(const covering *e, const camber_cover_scene *drawn, camber_cover_area area) {
    camber_cover *cover = NULL;
    camber_cover_stages device, twin;
    assert_int_equal(camber_cover_create(e->s.device, &cover), CAMBER_OK);
    assert_int_equal(camber_cover_draw(cover, drawn, &area), CAMBER_OK);
    assert_int_equal(camber_cover_read_stages(cover, &device), CAMBER_OK);
    assert_int_equal(camber_cover_on_host(e->s.context, drawn, &area, &twin), CAMBER_OK);
    covering_compare(&device, &twin);
    assert_memory_equal(device.rgba, twin.rgba, 4 * (size_t)area.width * area.height);
    uint8_t *rgba = device.rgba;
    device.rgba = NULL;
    camber_cover_stages_free(e->s.context, &device);
    camber_cover_stages_free(e->s.context, &twin);
    camber_cover_destroy(cover);
    return rgba;
}

static inline int covering_set_up(void **state) {
    static covering e;
    *state = &e;
    studio_open(&e.s); /* without GL there is still something to draw with */
    return e.s.device && camber_renderer_create(e.s.device, NULL, NULL, &e.cl) == CAMBER_OK ? 0 : -1;
}

static inline int covering_tear_down(void **state) {
    covering *e = *state;
    camber_renderer_destroy(e->cl);
    studio_close(&e->s);
    assert_int_equal(e->s.h.live_blocks, 0);
    return 0;
}

/* What main of a test of these returns. */
static inline int covering_run(const char *name, const struct CMUnitTest *tests, size_t count) {
    if (!device_is_there()) {
        puts("skipped: no OpenCL device");
        return 77;
    }
    const int failed = _cmocka_run_group_tests(name, tests, count, covering_set_up, covering_tear_down);
    return failed;
}

#define COVERING_RUN(tests) covering_run(#tests, tests, sizeof(tests) / sizeof *(tests))

#endif
