/* Drawing for the tests: surfaces, renderers, pictures and their differences. */
#ifndef CAMBER_TESTS_PICTURE_H
#define CAMBER_TESTS_PICTURE_H

#include "scene.h"

enum { BACKENDS = 2 };
static const camber_backend BACKEND[BACKENDS] = {CAMBER_BACKEND_EGL, CAMBER_BACKEND_OSMESA};
static const char *const BACKEND_NAME[BACKENDS] = {"EGL", "OSMesa"};

/* All back ends that are there, each with a renderer; where OpenCL draws, its renderer stands for the first. */
typedef struct studio {
    host h;
    camber_context *context;
    camber_device *device;
    camber_surface *surface[BACKENDS];
    camber_renderer *renderer[BACKENDS]; /* NULL: not on this machine */
} studio;

static inline bool studio_open(studio *s) {
    *s = (studio){0};
    s->context = host_context(&s->h);
    bool any = false;
    if (camber_device_create(s->context, NULL, NULL, &s->device) != CAMBER_OK)
        return false;
    if (draws_in_cl()) {
        s->h.errors = 0;
        return camber_renderer_create(s->device, NULL, NULL, &s->renderer[0]) == CAMBER_OK;
    }
    for (int i = 0; i < BACKENDS; i++) {
        const camber_surface_desc desc = {BACKEND[i]};
        if (camber_surface_create(s->context, &desc, &s->surface[i]) == CAMBER_OK &&
            camber_renderer_create(s->device, s->surface[i], &(camber_renderer_desc){.draw = CAMBER_DRAW_GL},
                                   &s->renderer[i]) == CAMBER_OK)
            any = true;
        else
            printf("%s is not there: %s\n", BACKEND_NAME[i], s->h.last);
    }
    s->h.errors = 0;
    return any;
}

static inline void studio_close(studio *s) {
    for (int i = 0; i < BACKENDS; i++) {
        camber_renderer_destroy(s->renderer[i]);
        camber_surface_destroy(s->surface[i]);
    }
    camber_device_destroy(s->device);
    camber_context_destroy(s->context);
}

/* A mesh of a scene's lines that the renderer draws. */
static inline camber_mesh *studio_mesh(const studio *s, camber_renderer *renderer, const scene *lines,
                                       const camber_tessellation_desc *desc) {
    camber_mesh *mesh = NULL;
    camber_polylines *polylines = scene_polylines(s->context, lines);
    assert_int_equal(camber_mesh_create(s->device, renderer, &mesh), CAMBER_OK);
    assert_int_equal(camber_tessellate(mesh, polylines, desc), CAMBER_OK);
    camber_polylines_destroy(polylines);
    return mesh;
}

/* Whether a test program has something to draw with. false: what is missing is said, and the program returns 77. */
static inline bool studio_begin(void) {
    studio probe;
    bool possible = device_is_there();
    if (possible) {
        possible = studio_open(&probe);
        studio_close(&probe);
    }
    if (possible)
        return true;
    puts("skipped: no OpenCL device, or neither EGL nor OSMesa");
    return false;
}

/* A group's state: a studio. */
static inline int studio_set_up(void **state) {
    studio *s = malloc(sizeof *s);
    *state = s;
    return s && studio_open(s) ? 0 : -1;
}

static inline int studio_tear_down(void **state) {
    studio *s = *state;
    studio_close(s);
    assert_int_equal(s->h.live_blocks, 0);
    free(s);
    return 0;
}

/* What main of a test of pictures returns. */
static inline int studio_run(const char *name, const struct CMUnitTest *tests, size_t count) {
    if (!studio_begin())
        return 77;
    const int failed = _cmocka_run_group_tests(name, tests, count, studio_set_up, studio_tear_down);
    return failed;
}

#define STUDIO_RUN(tests) studio_run(#tests, tests, sizeof(tests) / sizeof *(tests))

/* The first back end that is there. */
static inline camber_renderer *studio_any(const studio *s) {
    return s->renderer[0] ? s->renderer[0] : s->renderer[1];
}

/* A mesh of one polyline: count pairs of x, y. */
static inline camber_mesh *studio_line(const studio *s, const float *points, size_t count,
                                       const camber_tessellation_desc *desc) {
    const uint32_t offsets[] = {0, (uint32_t)count};
    const camber_polylines_desc line = {
        .points = points, .point_count = count, .offsets = offsets, .polyline_count = 1};
    camber_polylines *polylines = NULL;
    camber_mesh *mesh = NULL;
    assert_int_equal(camber_polylines_create(s->context, &line, &polylines), CAMBER_OK);
    assert_int_equal(camber_mesh_create(s->device, studio_any(s), &mesh), CAMBER_OK);
    assert_int_equal(camber_tessellate(mesh, polylines, desc), CAMBER_OK);
    camber_polylines_destroy(polylines);
    return mesh;
}

/* ---- Pictures ---- */

typedef struct picture {
    uint8_t *rgba;
    uint32_t width, height;
    uint32_t rows; /* that have come */
    uint32_t calls;
} picture;

static inline bool picture_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    picture *p = user;
    assert_int_equal(first_row, p->rows); /* from the top down, none twice */
    assert_true(row_count >= 1 && row_count <= p->height - p->rows);
    memcpy(p->rgba + 4 * (size_t)p->width * first_row, rgba, 4 * (size_t)p->width * row_count);
    p->rows += row_count;
    p->calls++;
    return true;
}

static inline picture picture_draw(camber_renderer *renderer, const camber_frame *frame) {
    picture p = {.width = frame->width, .height = frame->height};
    p.rgba = malloc(4 * (size_t)p.width * p.height);
    assert_non_null(p.rgba);
    assert_int_equal(camber_render(renderer, frame, picture_rows, &p, NULL), CAMBER_OK);
    assert_int_equal(p.rows, p.height);
    return p;
}

static inline void picture_free(picture *p) {
    free(p->rgba);
    *p = (picture){0};
}

static inline const uint8_t *picture_at(const picture *p, uint32_t x, uint32_t y) {
    return p->rgba + 4 * ((size_t)p->width * y + x);
}

/* A channel of a pixel, 0 to 1. */
static inline double picture_value(const picture *p, uint32_t x, uint32_t y, int channel) {
    return picture_at(p, x, y)[channel] / 255.0;
}

typedef struct difference {
    int most;      /* of a channel, of 255 */
    double mean;   /* over the channels of all pixels where either is not 0, of 255 */
    size_t past_8; /* pixels that differ by more than 8 */
    size_t drawn;  /* pixels where either is not 0 */
} difference;

static inline difference picture_compare(const picture *a, const picture *b) {
    difference d = {0};
    assert_true(a->width == b->width && a->height == b->height);
    double sum = 0;
    for (size_t i = 0; i < (size_t)a->width * a->height; i++) {
        const uint8_t *p = a->rgba + 4 * i, *q = b->rgba + 4 * i;
        int most = 0;
        for (int c = 0; c < 4; c++) {
            const int apart = abs(p[c] - q[c]);
            most = apart > most ? apart : most;
            sum += apart;
        }
        d.drawn += (p[0] | p[1] | p[2] | p[3] | q[0] | q[1] | q[2] | q[3]) != 0;
        d.past_8 += most > 8;
        d.most = most > d.most ? most : d.most;
    }
    d.mean = d.drawn ? sum / (4.0 * (double)d.drawn) : 0;
    return d;
}

static inline void picture_assert_same(const picture *a, const picture *b) {
    const difference d = picture_compare(a, b);
    if (d.most > 0)
        fail_msg("%zu of %zu pixels differ by more than 8, by %d at most", d.past_8, d.drawn, d.most);
}

#endif
