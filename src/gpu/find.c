/* Finds the devices of all back ends, and selects the ones that a word names.
 *
 * Main idea: drivers set themselves up when they are first called. This must happen once, under a lock, and not in a
 * child that was forked afterwards. */
#include "gpu/backend.h"

#include <ctype.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

/* If two devices are of the same kind, the first is preferred. */
static const camber_gpu_backend *const backends[] = {
#ifdef CAMBER_CPU
    &camber_cpu,
#endif
    &camber_opencl,
};
enum { BACKENDS = sizeof backends / sizeof *backends };

/* The only lock for the whole process. It guards global state: the OpenCL loader and the drivers set themselves up when
 * they are first called. PoCL (3.1 and 6.0) reports too early to a second thread that this is done, and gives it
 * devices without a name. Every use of OpenCL begins with camber_find_devices, so locking here is enough. */
static pthread_mutex_t asking = PTHREAD_MUTEX_INITIALIZER;

/* The process that has set drivers up. 0: none yet. */
static _Atomic(pid_t) process_of_drivers;

camber_status camber_check_process(camber_context *context) {
    const pid_t process = atomic_load(&process_of_drivers);
    if (process == 0 || process == getpid())
        return CAMBER_OK;
    return camber_fail(
        context, CAMBER_ERROR_DEVICE,
        "device: this process was forked after camber had set up OpenCL, which does not survive that; fork "
        "before camber's first call, or start a new process (exec)");
}

size_t camber_find_devices(camber_found_device found[CAMBER_DEVICES_MAX], camber_failed_call *failed) {
    size_t count = 0;
    *failed = (camber_failed_call){0};
    pthread_mutex_lock(&asking);
    atomic_store(&process_of_drivers, getpid());
    for (size_t i = 0; i < BACKENDS; i++)
        count += backends[i]->find(found + count, CAMBER_DEVICES_MAX - count, failed);
    pthread_mutex_unlock(&asking);
    return count;
}

camber_status camber_check_drivers(camber_context *context) {
    camber_status status = camber_check_process(context);
    if (status == CAMBER_OK)
        status = camber_budget_check_drivers(context);
    for (size_t i = 0; i < BACKENDS && status == CAMBER_OK && atomic_load(&process_of_drivers) == 0; i++)
        status = backends[i]->check_process(context);
    return status;
}

static camber_status list_devices(camber_context *context) {
    camber_found_device found[CAMBER_DEVICES_MAX];
    camber_failed_call failed;
    const camber_status status = camber_check_drivers(context);
    if (status != CAMBER_OK)
        return status;
    const size_t count = camber_find_devices(found, &failed);
    context->devices = camber_alloc(context, count, sizeof *context->devices);
    if (!context->devices)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++)
        context->devices[i] = found[i].info;
    context->device_count = count;
    return CAMBER_OK;
}

static bool contains_ignoring_case(const char *text, const char *part) {
    for (; *text; text++) {
        size_t i = 0;
        while (part[i] && tolower((unsigned char)text[i]) == tolower((unsigned char)part[i]))
            i++;
        if (!part[i])
            return true;
    }
    return *part == 0;
}

bool camber_device_matches(const camber_device_info *info, const char *match) {
    if (!match)
        return true;
    if (contains_ignoring_case("cpu", match) && strlen(match) == 3)
        return info->type == CAMBER_DEVICE_TYPE_CPU;
    if (contains_ignoring_case("gpu", match) && strlen(match) == 3)
        return info->type == CAMBER_DEVICE_TYPE_GPU;
    return contains_ignoring_case(info->name, match) || contains_ignoring_case(info->platform, match) ||
           contains_ignoring_case(info->version, match);
}

camber_status camber_device_list(camber_context *context, const char *match, size_t n,
                                 const camber_device_info **info) {
    const camber_status status = context->devices ? CAMBER_OK : list_devices(context);
    if (status != CAMBER_OK)
        return status;
    *info = NULL;
    for (size_t i = 0; i < context->device_count && !*info; i++)
        if (camber_device_matches(context->devices + i, match) && n-- == 0)
            *info = context->devices + i;
    return CAMBER_OK;
}
