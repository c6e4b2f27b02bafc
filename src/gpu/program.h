/* Programs and their kernels. A program is loaded from the cache or built when a device first needs it. */
#ifndef CAMBER_GPU_PROGRAM_H
#define CAMBER_GPU_PROGRAM_H

#include "gpu/launch.h"

/* One program. Only the kernels of its kind are set; the others are NULL. */
typedef struct camber_program {
    camber_program_number number;
    void *native;                          /* the back end's handle */
    camber_kernel *classify, *scan, *emit; /* kernels of a tessellation method */
    camber_kernel *cull_count, *cull_emit; /* kernels of networks: which points a camera sees */
    camber_kernel *arc_length_sum, *arc_length_scan;
    camber_kernel *offset_clip, *offset_count, *offset_emit; /* kernels of lines with an offset */
    camber_kernel *setup, *bin_count, *bin_scan, *bin_scatter, *wind, *rasterize;
    bool built; /* compiled from source, because no cache had it */
    bool kept;  /* a cache has it by now */
} camber_program;

/* The source of a program, from which a back end makes it. */
typedef struct camber_program_source {
    camber_program_number number; /* by which a back end finds what was compiled ahead of time */
    const char *text;
    size_t text_bytes;
    char options[256];
} camber_program_source;

/* The properties of a mesh that its kernels are built for. */
typedef struct camber_program_desc {
    camber_method method;
    bool has_arc_length;
    bool round_limits; /* a stroke has a round limit. Without round limits classify is a fifth faster on PoCL */
} camber_program_desc;

/* Variants of the rasterizer, as bits: each bit that is set becomes a macro with the value 1. */
#define CAMBER_RASTER_RICH 1
#define CAMBER_RASTER_PITCHED 2 /* only together with RICH */

/* Each returns a program that the device owns, and loads or builds it at first use. */
camber_status camber_device_program(camber_device *device, camber_program_desc desc, camber_program **program);
camber_status camber_device_network_program(camber_device *device, bool has_arc_length, bool pitched,
                                            camber_program **program);
camber_status camber_device_arc_length_program(camber_device *device, camber_program **program);
camber_status camber_device_offset_program(camber_device *device, bool has_arc_length, camber_program **program);
camber_status camber_device_raster_program(camber_device *device, unsigned variant, camber_program **program);
void camber_program_destroy(const camber_device *device, camber_program *program);

#endif
