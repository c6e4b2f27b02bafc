/* An open compute device: the programs made for it so far, and counts of the memory that is held on it. Layers above
 * this one know devices, buffers, programs and launches; only a back end's folder knows OpenCL. */
#ifndef CAMBER_GPU_DEVICE_H
#define CAMBER_GPU_DEVICE_H

#include "base/base.h"

/* Returns CAMBER_ERROR_DEVICE in a child that was forked after drivers were set up: their threads are the parent's, and
 * a call would wait for them for ever. */
camber_status camber_check_process(camber_context *context);

struct camber_device {
    camber_context *context;
    const struct camber_gpu_backend *backend;
    void *native; /* the back end's own */
    camber_device_info info;
    bool rounds_correctly; /* divides and takes roots exactly as the host: kernels equal the twin bit for bit */
    bool host_memory;      /* the device works in the host's memory: it can read the host's arrays in place */
    bool gl_context;       /* it was opened for a GL context, so that GL buffers can be shared */
    size_t block;          /* points a work-group: CAMBER_BLOCK as its kernels are built */
    size_t point_chunk;    /* points a work-item: CAMBER_POINT_CHUNK */
    unsigned lanes;        /* of the rasterizer's vectors: CAMBER_LANES */
    /* Programs, each NULL until it is first used. */
    struct camber_program *programs[2][2][3];      /* [has arc lengths][has round limits][camber_method] */
    struct camber_program *network_programs[2][2]; /* [has arc lengths][the camera has a pitch] */
    struct camber_program *arc_length_program;
    struct camber_program *offset_programs[2]; /* [has arc lengths] */
    struct camber_program *raster_programs[4]; /* the rasterizer: [bits of its variant] */
    /* The bound on its meshes (0: none), what they hold now, and the most that was ever held, renderers included. */
    uint64_t memory_bytes, held_bytes, most_held_bytes;
    uint64_t drawing_allowed_bytes, drawing_bytes; /* bound and held bytes of its renderers' buffers */
    camber_mesh *meshes;                           /* a list: each mesh points to the next */
};

/* Waits for all that was queued. */
camber_status camber_device_finish(const camber_device *device);
/* The same after a failure that has been logged: nothing reads the host's arrays afterwards. */
void camber_device_settle(const camber_device *device);

#endif
