/* Kernels, built from their sources or loaded from the cache when a device first needs them. */
#ifndef CAMBER_CL_PROGRAM_H
#define CAMBER_CL_PROGRAM_H

#include "cl/device.h"

typedef struct camber_program {
    cl_program cl;
    cl_kernel classify, scan, emit; /* of a method */
    cl_kernel survey, project;      /* of networks */
    cl_kernel tally, measure;
    cl_kernel span, tell, shift; /* of offsets */
    cl_kernel shape, count, total, fill, cover;
    uint64_t key; /* of the cache */
    bool built;   /* from source: no cache had it */
    bool kept;    /* a cache has it now */
} camber_program;

/* What the kernels of a mesh are built for. */
typedef struct camber_program_desc {
    camber_method method;
    bool measured;
    bool round_limits; /* a row has one; without them classify is a fifth faster on PoCL */
} camber_program_desc;

/* What kernels that draw are built for, as bits: the compiler has each that is set as a macro that is 1. All but the
 * plain ones are built for 16 lanes on every device. */
#define CAMBER_COVER_RICH 1
#define CAMBER_COVER_PITCHED 2 /* with RICH */

/* The kernels, built or loaded at first use. */
camber_status camber_device_program(camber_device *device, camber_program_desc desc, camber_program **program);
camber_status camber_device_network_program(camber_device *device, bool measured, bool pitched,
                                            camber_program **program);
camber_status camber_device_measures(camber_device *device, camber_program **program);
camber_status camber_device_offsets(camber_device *device, bool measured, camber_program **program);
camber_status camber_device_cover_program(camber_device *device, unsigned variant, camber_program **program);
void camber_program_destroy(camber_context *context, camber_program *program);

#endif
