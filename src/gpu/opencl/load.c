/* Loads OpenCL when it is first asked for devices. Functions that the process already has are used first: those of a
 * program that links OpenCL, or of a tool that is loaded before it, such as oclgrind. */
#include "gpu/opencl/cl.h"

#include <dlfcn.h>
#include <string.h>

camber_cl_table camber_cl;

/* Sets *function to the function of that name, and returns whether there is one. */
static bool find(void *process, void *library, const char *name, void *function) {
    void *symbol = process ? dlsym(process, name) : NULL;
    if (!symbol && library)
        symbol = dlsym(library, name);
    memcpy(function, &symbol, sizeof symbol);
    return symbol != NULL;
}

const char *camber_cl_load(void) {
    static bool loaded; /* guarded by the lock of the caller */
    if (loaded)
        return NULL;
    camber_cl_table found = {.shares_gl = true};
    void *process = dlopen(NULL, RTLD_NOW | RTLD_LOCAL);
    /* It stays loaded, because drivers' threads may still be running in it. */
    void *library = dlopen("libOpenCL.so.1", RTLD_NOW | RTLD_LOCAL);
    loaded = true;
#define FIND(result, name, parameters) loaded = find(process, library, "cl" #name, &found.name) && loaded;
    CAMBER_CL_FUNCTIONS(FIND)
#undef FIND
#define FIND(result, name, parameters)                                                                                 \
    found.shares_gl = find(process, library, "cl" #name, &found.name) && found.shares_gl;
    CAMBER_CL_GL_FUNCTIONS(FIND)
#undef FIND
    if (loaded)
        camber_cl = found;
    return loaded    ? NULL
           : library ? "OpenCL (libOpenCL.so.1) lacks functions of version 1.2; install ocl-icd-libopencl1"
                     : "OpenCL is not installed (libOpenCL.so.1); install ocl-icd-libopencl1 and a driver (Debian, for "
                       "CPUs: pocl-opencl-icd)";
}
