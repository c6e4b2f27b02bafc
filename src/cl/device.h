/* An open OpenCL device: its queue, the programs that were built for it, and counts of the memory that it holds. */
#ifndef CAMBER_CL_DEVICE_H
#define CAMBER_CL_DEVICE_H

#include "base/base.h"

#include <CL/cl.h>

struct camber_device {
    camber_context *context;
    cl_platform_id platform;
    cl_device_id id;
    cl_context cl;
    cl_command_queue queue;
    camber_device_info info;
    bool rounds_correctly; /* divides and takes roots as the twin does */
    bool host_memory;      /* the device works in the host's memory */
    bool gl_context;       /* cl was made for a GL context: GL buffers can be shared */
    size_t block;          /* points a work-group: CAMBER_BLOCK as its kernels see it */
    size_t item;           /* points a work-item: CAMBER_ITEM */
    unsigned lanes;        /* pixels a work-item of what draws: CAMBER_LANES */
    /* Built when first used; the second of two for what is measured. */
    struct camber_program *programs[2][2][3];      /* without and with round limits, by camber_method */
    struct camber_program *network_programs[2][2]; /* the second ones of a camera with a pitch */
    struct camber_program *measures;
    struct camber_program *offset_programs[2];
    struct camber_program *cover[4]; /* what draws, by its variant */
    /* What its meshes may hold (0: what they want), hold, and held at most. */
    uint64_t memory_bytes, held_bytes, most_held_bytes;
    uint64_t drawing_allowed_bytes, drawing_bytes; /* the same of its renderers' buffers */
    camber_mesh *meshes;                           /* each knows the next */
};

/* What a surface tells OpenCL about its GL context, for cl_khr_gl_sharing. Zero: it cannot be told. */
typedef struct camber_gl_handles {
    cl_context_properties context, display, display_kind; /* kind: CL_EGL_DISPLAY_KHR */
} camber_gl_handles;
camber_gl_handles camber_surface_handles(const camber_surface *surface); /* src/gl/surface.c */
/* As much as its shaders can read. */
uint64_t camber_surface_largest_buffer_bytes(const camber_surface *surface);

/* Logs "CALL: OpenCL error NAME (code); cure" and gives the status it stands for. */
camber_status camber_fail_cl(camber_context *context, const char *call, cl_int code);

#endif
