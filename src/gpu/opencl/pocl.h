/* Makes PoCL run the kernels of a saved binary as they are. */
#ifndef CAMBER_GPU_OPENCL_POCL_H
#define CAMBER_GPU_OPENCL_POCL_H

#include "gpu/device.h"

/* Whether the device is a CPU under PoCL. */
bool camber_is_pocl(const camber_device_info *info);
/* Takes LLVM's code out of a binary of PoCL: *size_bytes shrinks. Returns false, and changes nothing, if the binary is
 * not laid out as it is in PoCL 3 to 7. */
bool camber_pocl_strip(unsigned char *binary, size_t *size_bytes);

/* PoCL ends the process where it cannot go on. These two return CAMBER_ERROR_DEVICE before it comes to that. */
/* Looks whether it can have its threads; before a driver is first asked. */
camber_status camber_pocl_check_threads(camber_context *context);
/* Looks whether it can keep and run the kernels of a binary; NULL: of source code, which it also links. */
camber_status camber_pocl_check_program(const camber_device *device, const unsigned char *binary, size_t size_bytes);

#endif
