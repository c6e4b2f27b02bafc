/* Makes PoCL run the kernels of a saved binary without compiling them again. */
#ifndef CAMBER_GPU_OPENCL_POCL_H
#define CAMBER_GPU_OPENCL_POCL_H

#include "gpu/device.h"

/* Whether the device is a CPU driven by PoCL. */
bool camber_is_pocl(const camber_device_info *info);
/* Removes the LLVM code from a PoCL binary, which reduces *size_bytes. Returns false, and changes nothing, if the
 * binary is not laid out as it is in PoCL 3 to 7. */
bool camber_pocl_strip(unsigned char *binary, size_t *size_bytes);

/* PoCL ends the process if it cannot continue. These two return CAMBER_ERROR_DEVICE before that happens. */
/* Checks whether PoCL can start its threads. Call it before a driver is first used. */
camber_status camber_pocl_check_threads(camber_context *context);
/* Checks whether PoCL can store and run the kernels of a binary, or, if that is NULL, of source code, which PoCL also
 * has to link. */
camber_status camber_pocl_check_program(const camber_device *device, const unsigned char *binary, size_t size_bytes);

#endif
