/* Makes PoCL run the kernels of a saved binary without compiling them again.
 *
 * Input: a binary that clGetProgramInfo gave. Output: the same without the LLVM code. Main idea: a binary of PoCL holds
 * the kernels, ready for work-groups of any size, and LLVM's code of the program. If PoCL has the code, it compiles a
 * kernel again for the size, offset and count of a launch, which takes a second and gains nothing here. Only the
 * environment variable POCL_WORK_GROUP_SPECIALIZATION=0 stops that, and the environment is the caller's. If PoCL does
 * not have the code, it runs the kernels that it has.
 *
 * A binary begins with this (PoCL's lib/CL/pocl_binary.c, versions 9 to 12); numbers are little-endian:
 *
 *     8 bytes     "poclbin"
 *     8 + 4 + 4   the device, the version, the number of kernels
 *     8           flags
 *     4           the number of files of the program
 *     41          a hash written in capital letters from A on: the folder in PoCL's cache into which the binary is
 * unpacked 8           the size of global variables, if the flags have GLOBALS 8           the bytes of the first file,
 * with its name and the sizes of both, which follow 4 + 11      "/program.bc" 4 + n       LLVM's code
 *     ...         other files, and the kernels
 *
 * The stripped binary has an empty file by another name, since PoCL wants one, and a folder of its own, because PoCL
 * would find the code in the folder of a program that was compiled from source. */
#define _GNU_SOURCE /* ST_NOEXEC */

#include "gpu/opencl/pocl.h"

#include <limits.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

static const char MAGIC[] = "poclbin", CODE[] = "/program.bc", NO_CODE[] = "/no-code.bc";

enum {
    VERSION_AT = 16,
    FLAGS_AT = 24,
    FOLDER_AT = 36,
    FOLDER_BYTES = 41,
    OLDEST = 9,
    NEWEST = 12,
    GLOBALS = 2,
    NAME_BYTES = sizeof CODE - 1,
    LEAST_BYTES = FOLDER_AT + FOLDER_BYTES + 8 + 8 + 4 + NAME_BYTES + 4,
};

bool camber_is_pocl(const camber_device_info *info) {
    return info->type == CAMBER_DEVICE_TYPE_CPU && strcmp(info->platform, "Portable Computing Language") == 0;
}

static uint64_t get(const unsigned char *at, size_t bytes) {
    uint64_t value = 0;
    for (size_t i = 0; i < bytes; i++)
        value |= (uint64_t)at[i] << 8 * i;
    return value;
}

static void put(unsigned char *at, size_t bytes, uint64_t value) {
    for (size_t i = 0; i < bytes; i++)
        at[i] = (unsigned char)(value >> 8 * i);
}

bool camber_pocl_strip(unsigned char *binary, size_t *size_bytes) {
    if (*size_bytes < LEAST_BYTES || memcmp(binary, MAGIC, sizeof MAGIC) != 0)
        return false;
    const uint64_t version = get(binary + VERSION_AT, 4);
    const bool has_globals = get(binary + FLAGS_AT, 8) & GLOBALS;
    unsigned char *const file = binary + FOLDER_AT + FOLDER_BYTES + (has_globals ? 8 : 0);
    unsigned char *const name = file + 8 + 4, *const code = name + NAME_BYTES + 4;
    const size_t left = (size_t)(binary + *size_bytes - code);
    const uint64_t code_bytes = get(code - 4, 4);
    if (version < OLDEST || version > NEWEST || get(name - 4, 4) != NAME_BYTES || memcmp(name, CODE, NAME_BYTES) != 0 ||
        code_bytes > left || get(file, 8) != 4 + NAME_BYTES + 4 + code_bytes)
        return false;
    put(file, 8, 4 + NAME_BYTES + 4);
    memcpy(name, NO_CODE, NAME_BYTES);
    put(code - 4, 4, 0);
    memmove(code, code + code_bytes, left - (size_t)code_bytes);
    binary[FOLDER_AT] = 'c'; /* not a capital letter, so that no program from source has this folder */
    *size_bytes -= (size_t)code_bytes;
    return true;
}

/* ---- Needs of PoCL ---- */

static void *wait_for_end(void *end) {
    while (sem_wait(end) != 0)
        continue;
    return NULL;
}

/* If the limit on threads is low, tests it by starting as many threads as there are processors at once. */
camber_status camber_pocl_check_threads(camber_context *context) {
    enum { MOST_THREADS = 256, LOW_LIMIT = 4096 };
    struct rlimit limit;
    pthread_t threads[MOST_THREADS];
    sem_t end;
    const long processors = sysconf(_SC_NPROCESSORS_ONLN);
    const unsigned wanted = processors < 1 ? 1 : processors > MOST_THREADS ? MOST_THREADS : (unsigned)processors;
    unsigned made = 0;
    if (getrlimit(RLIMIT_NPROC, &limit) != 0 || limit.rlim_cur >= LOW_LIMIT || sem_init(&end, 0, 0) != 0)
        return CAMBER_OK;
    while (made < wanted && pthread_create(&threads[made], NULL, wait_for_end, &end) == 0)
        made++;
    for (unsigned i = 0; i < made; i++)
        sem_post(&end);
    for (unsigned i = 0; i < made; i++)
        pthread_join(threads[i], NULL);
    sem_destroy(&end);
    if (made == wanted)
        return CAMBER_OK;
    return camber_fail(
        context, CAMBER_ERROR_DEVICE,
        "device: OpenCL's drivers need %u threads, and the limit of processes (%llu) allows fewer; raise "
        "it (ulimit -u)",
        wanted, (unsigned long long)limit.rlim_cur);
}

/* Finds the folder where PoCL keeps kernels. Returns false if there is none, or if its name is too long. */
static bool find_folder(char folder[PATH_MAX]) {
    const char *own = getenv("POCL_CACHE_DIR"), *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    const int length = own && *own       ? snprintf(folder, PATH_MAX, "%s", own)
                       : cache && *cache ? snprintf(folder, PATH_MAX, "%s/pocl/kcache", cache)
                       : home && *home   ? snprintf(folder, PATH_MAX, "%s/.cache/pocl/kcache", home)
                                         : snprintf(folder, PATH_MAX, "/tmp/pocl/kcache");
    return length < PATH_MAX;
}

/* Describes the file system of the folder, or of the closest one above it that exists. */
static bool find_file_system(const char *folder, struct statvfs *about) {
    char above[PATH_MAX];
    snprintf(above, sizeof above, "%s", folder);
    while (statvfs(above, about) != 0) {
        char *slash = strrchr(above, '/');
        if (!slash || slash == above)
            return false;
        *slash = 0;
    }
    return true;
}

static bool has_linker(void) {
    const char *path = getenv("PATH");
    for (const char *at = path ? path : "/usr/bin:/bin"; *at;) {
        char name[PATH_MAX];
        const size_t length = strcspn(at, ":");
        if (length + 4 < sizeof name) {
            snprintf(name, sizeof name, "%.*s/ld", (int)length, at);
            if (access(name, X_OK) == 0)
                return true;
        }
        at += length + (at[length] == ':');
    }
    return false;
}

/* Whether the kernels of a binary are already in the folder. */
static bool is_unpacked(const char *folder, const unsigned char *binary, size_t size_bytes) {
    char name[PATH_MAX];
    if (!binary || size_bytes < LEAST_BYTES || memcmp(binary, MAGIC, sizeof MAGIC) != 0)
        return false;
    const char *own = (const char *)binary + FOLDER_AT;
    return snprintf(name, sizeof name, "%s/%.2s/%.*s", folder, own, FOLDER_BYTES - 3, own + 2) < (int)sizeof name &&
           access(name, F_OK) == 0;
}

camber_status camber_pocl_check_program(const camber_device *device, const unsigned char *binary, size_t size_bytes) {
    enum { KERNELS_BYTES = 1 << 20, FIRST_WITH_LINKER = 5 }; /* later versions may have a linker built in */
    char folder[PATH_MAX];
    struct statvfs about;
    camber_context *context = device->context;
    if (!binary && strtol(device->info.driver, NULL, 10) < FIRST_WITH_LINKER && !has_linker())
        return camber_fail(
            context, CAMBER_ERROR_DEVICE,
            "device: OpenCL (PoCL) compiles kernels, and finds no linker: no folder of PATH has ld; install "
            "binutils, or let PATH name its folder");
    if (!find_folder(folder) || !find_file_system(folder, &about))
        return CAMBER_OK;
    if (about.f_flag & ST_NOEXEC)
        return camber_fail(context, CAMBER_ERROR_DEVICE,
                           "device: OpenCL (PoCL) runs kernels from %s, whose file system is mounted noexec; let "
                           "POCL_CACHE_DIR name a folder from which programs may run",
                           folder);
    if ((uint64_t)about.f_bavail * about.f_frsize < KERNELS_BYTES && !is_unpacked(folder, binary, size_bytes))
        return camber_fail(
            context, CAMBER_ERROR_DEVICE,
            "device: OpenCL (PoCL) keeps kernels in %s, whose file system is full; free some space, or let "
            "POCL_CACHE_DIR name another folder",
            folder);
    return CAMBER_OK;
}
