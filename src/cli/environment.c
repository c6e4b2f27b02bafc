/* sched_getaffinity. */
#define _GNU_SOURCE

#include "cli/environment.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* PoCL 3.1 aborts where it compiles with fewer than 13. */
enum { LEAST_DESCRIPTORS = 16 };

/* The names of PoCL, of 4.0 and later and of before. */
static const char *const POCL_THREADS[] = {"POCL_CPU_MAX_CU_COUNT", "POCL_MAX_PTHREAD_COUNT"};

/* llvmpipe's too, which it reads when it starts, and GDAL's. */
static bool set_threads(uint32_t threads) {
    char text[16];
    snprintf(text, sizeof text, "%u", threads);
    bool set = setenv("LP_NUM_THREADS", text, 1) == 0 && setenv("GDAL_NUM_THREADS", text, 1) == 0;
    for (size_t i = 0; i < sizeof POCL_THREADS / sizeof *POCL_THREADS; i++)
        set = setenv(POCL_THREADS[i], text, 1) == 0 && set;
    return set;
}

/* PoCL pins thread i to core i, and aborts where the process may not run there or there is no such core: in a container
 * that has some of the cores, or with more threads than cores. */
static bool may_pin(void) {
#ifdef __linux__
    cpu_set_t cores;
    const long count = sysconf(_SC_NPROCESSORS_CONF);
    if (count < 1 || count > CPU_SETSIZE || sched_getaffinity(0, sizeof cores, &cores) != 0 ||
        CPU_COUNT(&cores) != (int)count)
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

/* A relative folder counts as none, as the XDG rules say: PoCL and Mesa would make it wherever the tool is run. */
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
    /* GDAL would fill the working folder. */
    set = setenv("CPL_TMPDIR", camber_environment_temporary(), 0) == 0 && set;
    /* Mesa's own warnings about missing GPUs would stand among the errors. */
    set = setenv("EGL_LOG_LEVEL", "fatal", 0) == 0 && set;
    /* A core for each of PoCL's threads: left to themselves two of them often share one. */
    set = (!may_pin() || setenv("POCL_AFFINITY", "1", 0) == 0) && set;
    /* One build of each kernel for all sizes of work-groups, which the cache can keep: a build for each size, offset
     * and count is no faster for these kernels, and the first run would compile twice as much. */
    set = setenv("POCL_WORK_GROUP_SPECIALIZATION", "0", 0) == 0 && set;
    /* PoCL sets it while it looks for devices. A variable that is new then moves the environment, under a getenv of
     * GDAL's on another thread; one that is there stays where it is. */
    return setenv("HWLOC_PLUGINS_PATH", "/dev/null", 0) == 0 && set;
}

/* A driver that cannot open its files says that it is not here, if anything: so it is asked beforehand. */
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
