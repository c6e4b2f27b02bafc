/* Finds GDAL for the shared library, which keeps the files that need GDAL in a separate module. The static library
 * contains them, so there src/gdal/ provides the table. A build for systems that differ in their GDAL has a module for
 * each version (CAMBER_GDAL_SONAMES in CMakeLists.txt); the first one whose GDAL is installed is used. */
#define _GNU_SOURCE /* dladdr, RTLD_DEEPBIND */

#include "base/base.h"
#include "features/gdal_calls.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* The address space that GDAL and its libraries need, generously. With less, their start may end the process. */
static const uint64_t GDAL_BYTES = 256u << 20;

/* The module, and the GDAL that it needs if it may be missing. */
static const struct { const char *name, *gdal; } modules[] = {CAMBER_GDAL_MODULES};

/* A GDAL that camber was not built with brings libraries of its own, such as SQLite, of other versions than camber's.
 * RTLD_DEEPBIND makes it use those. */
static bool has_gdal(const char *name, int mode) {
    return !name || dlopen(name, mode | RTLD_DEEPBIND);
}

/* Opens a module by its path: next to this library in the build folder, in a folder next to it after installation. */
static void *open_next_to_library(const char *name, int mode) {
    static const char *const folders[] = {"", "camber/"};
    Dl_info here;
    void *module = NULL;
    if (!dladdr(folders, &here) || !here.dli_fname)
        return NULL;
    const char *slash = strrchr(here.dli_fname, '/');
    const int length = slash ? (int)(slash + 1 - here.dli_fname) : 0;
    for (size_t i = 0; i < sizeof folders / sizeof *folders && !module; i++) {
        char path[PATH_MAX];
        const int size = snprintf(path, sizeof path, "%.*s%s%s", length, here.dli_fname, folders[i], name);
        if (size > 0 && (size_t)size < sizeof path)
            module = dlopen(path, mode);
    }
    return module;
}

/* Opens a module through the library's RUNPATH, which a sanitizer's dlopen ignores. The module stays loaded, because
 * GDAL's own threads and caches live as long as the process. */
const camber_gdal_calls *camber_gdal_find(const char **why) {
    const bool has_room = camber_address_space_left() >= GDAL_BYTES;
    const int mode = RTLD_LAZY | RTLD_LOCAL | (has_room ? 0 : RTLD_NOLOAD); /* or what is already there */
    void *module = NULL;
    for (size_t i = 0; i < sizeof modules / sizeof *modules && !module; i++) {
        if (!has_gdal(modules[i].gdal, mode))
            continue;
        module = dlopen(modules[i].name, mode);
        if (!module)
            module = open_next_to_library(modules[i].name, mode);
    }
    const camber_gdal_calls *calls = module ? dlsym(module, "camber_gdal") : NULL;
    *why = calls ? NULL : dlerror();
#ifdef CAMBER_GDAL_WANTED
    if (!calls) /* the reason is about the oldest version alone */
        *why = "none of " CAMBER_GDAL_WANTED " can be loaded";
#endif
    if (!calls && !has_room)
        *why = "the limit of the address space (ulimit -v) leaves too little memory for it";
    return calls;
}
