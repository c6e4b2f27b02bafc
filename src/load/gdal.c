/* Finds GDAL for the shared library, which keeps the files that need it in a module. The static library has them in
 * itself: there src/gdal/ says where they are. */
#define _GNU_SOURCE /* dladdr */

#include "features/gdal_calls.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

static const int MODE = RTLD_LAZY | RTLD_LOCAL;

/* Opens the module by its path: beside this library where it is built, in a folder beside it where it is installed. */
static void *open_beside(void) {
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

/* Opens the module by the library's RUNPATH, which a sanitizer's dlopen does not know. It stays loaded: GDAL's own
 * threads and caches live as long as the process. */
const camber_gdal_calls *camber_gdal_find(const char **why) {
    void *module = dlopen(CAMBER_GDAL_MODULE, MODE);
    if (!module)
        module = open_beside();
    const camber_gdal_calls *calls = module ? dlsym(module, "camber_gdal") : NULL;
    *why = calls ? NULL : dlerror();
    return calls;
}
