/* Whether there may be a GPU, in GL or in OpenCL. */
#ifndef CAMBER_GPU_HARDWARE_H
#define CAMBER_GPU_HARDWARE_H

#include <stdbool.h>

/* Whether the process can open one of the files of GPUs in the folder. */
bool camber_hardware_in(const char *folder);
/* The same for /dev; true where nobody knows such files. */
bool camber_hardware_is_here(void);

#endif
