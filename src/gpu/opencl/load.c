/* Loads OpenCL when a device of its is first asked for. What the process has already is used first: the OpenCL of a
 * program that links it, or of a tool that comes before it, such as oclgrind. */
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

bool camber_cl_load(void) {
    static bool loaded; /* by the lock of the caller */
    if (loaded)
        return true;
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
    return loaded;
}
