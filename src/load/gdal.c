/* Finds GDAL for the shared library, which keeps the files that need GDAL in a separate module. The static library
 * contains them, so there src/gdal/ provides the table. */
#define _GNU_SOURCE /* dladdr */

#include "features/gdal_calls.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

static const int MODE = RTLD_LAZY | RTLD_LOCAL;

/* Opens the module by its path: next to this library in the build folder, in a folder next to it after installation. */
static void *open_next_to_library(void) {
    static const char *const folders[] = {"", "camber/"};
    Dl_info here;
    void *module = NULL;
    if (!dladdr(folders, &here) || !here.dli_fname)
        return NULL;
    const char *slash = strrchr(here.dli_fname, '/');
    const int length = slash ? (int)(slash + 1 - here.dli_fname) : 0;
    for (size_t i = 0; i < sizeof folders / sizeof *folders && !module; i++) {
        char path[PATH_MAX];
        const int size = snprintf(path, sizeof path, "%.*s%s" CAMBER_GDAL_MODULE, length, here.dli_fname, folders[i]);
        if (size > 0 && (size_t)size < sizeof path)
            module = dlopen(path, MODE);
    }
    return module;
}

/* Opens the module through the library's RUNPATH, which a sanitizer's dlopen ignores. The module stays loaded, because
 * GDAL's own threads and caches live as long as the process. */
const camber_gdal_calls *camber_gdal_find(const char **why) {
    void *module = dlopen(CAMBER_GDAL_MODULE, MODE);
    if (!module)
        module = open_next_to_library();
    const camber_gdal_calls *calls = module ? dlsym(module, "camber_gdal") : NULL;
    *why = calls ? NULL : dlerror();
    return calls;
}
