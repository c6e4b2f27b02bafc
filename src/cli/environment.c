/* Prepares the process for drivers and libraries: environment variables, standard streams and file descriptors. It runs
 * before any thread starts, since setenv is safe only then. */
#define _GNU_SOURCE /* CPU_SETSIZE */

#include "cli/environment.h"

#include "base/threads.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* PoCL 3.1 aborts if it compiles with fewer than 13 file descriptors. */
enum { LEAST_DESCRIPTORS = 16 };

/* PoCL reads the number of threads from the first variable since version 4.0, and from the second before. */
static const char *const POCL_THREADS[] = {"POCL_CPU_MAX_CU_COUNT", "POCL_MAX_PTHREAD_COUNT"};

/* Sets the number of threads for PoCL, for llvmpipe, which reads its variable when it starts, and for GDAL. */
static bool set_threads(uint32_t threads) {
    char text[16];
    snprintf(text, sizeof text, "%u", threads);
    bool set = setenv("LP_NUM_THREADS", text, 1) == 0 && setenv("GDAL_NUM_THREADS", text, 1) == 0;
    for (size_t i = 0; i < sizeof POCL_THREADS / sizeof *POCL_THREADS; i++)
        set = setenv(POCL_THREADS[i], text, 1) == 0 && set;
    return set;
}

/* PoCL pins thread i to core i. It aborts if the process may not run on that core or the core does not exist: in a
 * container with some of the cores, or with more threads than cores. */
static bool may_pin(void) {
#ifdef __linux__
    const long count = sysconf(_SC_NPROCESSORS_CONF);
    if (count < 1 || count > CPU_SETSIZE || camber_cores_count() != (size_t)count)
        return false;
    for (size_t i = 0; i < sizeof POCL_THREADS / sizeof *POCL_THREADS; i++) {
        const char *text = getenv(POCL_THREADS[i]);
        if (text && strtol(text, NULL, 10) > count)
            return false;
    }
    return true;
#else
    return false;
#endif
}

/* A relative folder is ignored, as the XDG rules say. PoCL and Mesa would create it in the working folder. */
static bool forget_relative(const char *name) {
    const char *folder = getenv(name);
    return !folder || folder[0] == '/' || unsetenv(name) == 0;
}

const char *camber_environment_temporary(void) {
    const char *folder = getenv("TMPDIR");
    return folder && *folder ? folder : "/tmp";
}

bool camber_environment_set(const camber_options *options) {
    bool set = !options->threads || set_threads(options->threads);
    set = forget_relative("XDG_CACHE_HOME") && forget_relative("HOME") && set;
    /* Without this variable, GDAL puts temporary files into the working folder. */
    set = setenv("CPL_TMPDIR", camber_environment_temporary(), 0) == 0 && set;
    /* Otherwise Mesa prints warnings about missing GPUs among the errors. */
    set = setenv("EGL_LOG_LEVEL", "fatal", 0) == 0 && set;
    /* Gives each of PoCL's threads a core of its own; otherwise two of them often share one. */
    set = (!may_pin() || setenv("POCL_AFFINITY", "1", 0) == 0) && set;
    /* For a PoCL whose binaries the library does not know (src/gpu/opencl/pocl.c): each kernel is built once for all
     * sizes of work-groups, so that the cache can keep it. */
    set = setenv("POCL_WORK_GROUP_SPECIALIZATION", "0", 0) == 0 && set;
    /* PoCL sets this variable while it looks for devices. Adding a variable can move the environment while GDAL's
     * thread is in a getenv; changing one that exists does not. */
    return setenv("HWLOC_PLUGINS_PATH", "/dev/null", 0) == 0 && set;
}

/* Called before a driver starts, because a driver that cannot open its files says that there is no device, or says
 * nothing. */
bool camber_environment_has_descriptors(void) {
    int copies[LEAST_DESCRIPTORS], count = 0;
    while (count < LEAST_DESCRIPTORS && (copies[count] = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0)) >= 0)
        count++;
    const bool enough = count == LEAST_DESCRIPTORS || errno != EMFILE;
    while (count > 0)
        close(copies[--count]);
    return enough;
}

void camber_environment_fill_streams(void) {
    const int streams[] = {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO};
    for (int i = 0; i < 3; i++)
        if (fcntl(streams[i], F_GETFD) < 0 && errno == EBADF)
            (void)!open("/dev/null", streams[i] == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}
