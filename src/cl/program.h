/* OpenCL programs and their kernels. A program is loaded from the cache or built when a device first needs it. */
#ifndef CAMBER_CL_PROGRAM_H
#define CAMBER_CL_PROGRAM_H

#include "cl/device.h"

/* One program. Only the kernels of its kind are set; the others are NULL. */
typedef struct camber_program {
    cl_program cl;
    cl_kernel classify, scan, emit;  /* of a tessellation method */
    cl_kernel cull_count, cull_emit; /* of networks: which points a camera sees */
    cl_kernel arc_length_sum, arc_length_scan;
    cl_kernel offset_clip, offset_count, offset_emit; /* of lines beside others */
    cl_kernel setup, bin_count, bin_scan, bin_scatter, wind, rasterize;
    uint64_t key; /* names its file in the cache */
    bool built;   /* compiled from source: no cache had it */
    bool kept;    /* a cache has it by now */
} camber_program;

/* The properties of a mesh that its kernels are built for. */
typedef struct camber_program_desc {
    camber_method method;
    bool has_arc_length;
    bool round_limits; /* a stroke has one. Without them classify is a fifth faster on PoCL */
} camber_program_desc;

/* Variants of the rasterizer, as bits: the compiler is given each bit that is set as a macro with the value 1. */
#define CAMBER_RASTER_RICH 1
#define CAMBER_RASTER_PITCHED 2 /* only together with RICH */

/* Each gives a program that the device owns, and loads or builds it at first use. */
camber_status camber_device_program(camber_device *device, camber_program_desc desc, camber_program **program);
camber_status camber_device_network_program(camber_device *device, bool has_arc_length, bool pitched,
                                            camber_program **program);
camber_status camber_device_arc_length_program(camber_device *device, camber_program **program);
camber_status camber_device_offset_program(camber_device *device, bool has_arc_length, camber_program **program);
camber_status camber_device_raster_program(camber_device *device, unsigned variant, camber_program **program);
void camber_program_destroy(camber_context *context, camber_program *program);

#endif
