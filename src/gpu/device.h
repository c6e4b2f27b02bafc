/* An open compute device, with the programs made for it so far and counts of the memory that is held on it. Layers
 * above this one know devices, buffers, programs and launches; only a back end's folder knows OpenCL. */
#ifndef CAMBER_GPU_DEVICE_H
#define CAMBER_GPU_DEVICE_H

#include "base/base.h"
#include "gpu/programs.h"

/* Returns CAMBER_ERROR_DEVICE in a child that was forked after drivers were set up: their threads exist only in the
 * parent, and a call would wait for them for ever. */
camber_status camber_check_process(camber_context *context);

struct camber_device {
    camber_context *context;
    const struct camber_gpu_backend *backend;
    void *native; /* the back end's handle */
    camber_device_info info;
    /* the device divides and takes square roots exactly as the host does, so that kernels equal the twin bit for bit */
    bool rounds_correctly;
    bool host_memory;   /* the device uses the host's memory, so that it can borrow the host's arrays (zero copy) */
    bool gl_context;    /* the device was opened for a GL context, so that GL buffers can be shared */
    size_t block;       /* points per work-group: the CAMBER_BLOCK that its kernels are built with */
    size_t point_chunk; /* points per work-item: CAMBER_POINT_CHUNK */
    unsigned lanes;     /* lanes of the rasterizer's vectors: CAMBER_LANES */
    struct camber_program *programs[CAMBER_PROGRAM_COUNT]; /* each NULL until it is first used */
    /* The memory limit for its meshes (0: none), the bytes that they hold now, and the most bytes that they and
     * renderers have held. */
    uint64_t memory_bytes, held_bytes, most_held_bytes;
    uint64_t drawing_allowed_bytes, drawing_bytes; /* memory limit and held bytes of its renderers' buffers */
    camber_mesh *meshes;                           /* a list: each mesh points to the next */
};

/* Waits for all queued commands. */
camber_status camber_device_finish(const camber_device *device);
/* The same after a failure that has been logged. Afterwards the device no longer reads the host's arrays. */
void camber_device_settle(const camber_device *device);

#endif
