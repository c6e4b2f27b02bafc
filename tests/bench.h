/* A device and a mesh to tessellate on: the state of the tests of the tessellation. */
#ifndef CAMBER_TESTS_BENCH_H
#define CAMBER_TESTS_BENCH_H

#include "scene.h"

#include "tess/tess.h"

typedef struct bench {
    host h;
    camber_context *context;
    camber_device *device;
    camber_mesh *mesh;
    bool rounds; /* the device divides and takes roots as the host does */
} bench;

static inline int bench_set_up(void **state) {
    bench *b = calloc(1, sizeof *b);
    if (!b)
        return -1;
    b->context = host_context(&b->h);
    if (camber_device_create(b->context, NULL, NULL, &b->device) != CAMBER_OK ||
        camber_mesh_create(b->device, NULL, &b->mesh) != CAMBER_OK)
        return -1;
    cl_device_fp_config rounding = 0;
    clGetDeviceInfo(b->device->id, CL_DEVICE_SINGLE_FP_CONFIG, sizeof rounding, &rounding, NULL);
    b->rounds = rounding & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT;
    print_message("on %s, which %s\n", b->device->info.name,
                  b->rounds ? "rounds correctly" : "does not round correctly: no comparison of bytes");
    *state = b;
    return 0;
}

static inline int bench_tear_down(void **state) {
    bench *b = *state;
    camber_mesh_destroy(b->mesh);
    camber_device_destroy(b->device);
    host_done(&b->h, b->context);
    free(b);
    return 0;
}

#endif
