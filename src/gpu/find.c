/* Finds the devices of all back ends, and selects the ones that a word names.
 *
 * Main idea: drivers set themselves up when they are first called. This must happen once, under a lock, and not in a
 * child that was forked afterwards. */
#include "gpu/backend.h"
#include "gpu/hardware.h"

#include <ctype.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <strings.h>
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

/* The process that has looked for devices. 0: none yet. */
static _Atomic(pid_t) process_of_devices;

camber_status camber_check_process(camber_context *context) {
    const pid_t process = atomic_load(&process_of_devices);
    if (process == 0 || process == getpid())
        return CAMBER_OK;
    return camber_fail(
        context, CAMBER_ERROR_DEVICE,
        "device: this process was forked after camber had looked for devices; their threads do not survive that; fork "
        "before camber's first call, or start a new process (exec)");
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

/* Whether the devices found without drivers have one that the desc can have. */
static bool is_usable(const camber_device_desc *desc, const camber_found_devices *found) {
    return desc && found->count > 0 && desc->number <= 1 && !desc->work_group_size && !desc->lanes &&
           camber_device_matches(&found->list[0].info, desc->match);
}

/* Whether the word can mean no device of a driver: "cpu", of which the processor itself is the first, or its name. */
static bool is_its_word(const camber_device_info *info, const char *word) {
    const size_t length = word ? strlen(word) : 0;
    return length &&
           (strcasecmp(word, "cpu") == 0 || (length >= strlen("camber") && strncasecmp(info->name, word, length) == 0));
}

/* Whether that one is also what the desc wants, so that no driver has to be asked: a GPU that matches is preferred,
 * if there may be one. */
static bool is_enough(const camber_device_desc *desc, const camber_found_devices *found) {
    return is_usable(desc, found) && desc->number == 0 &&
           (is_its_word(&found->list[0].info, desc->match) || !camber_hardware_is_here());
}

/* Checks whether drivers can be asked for the first time. If they cannot, but another device can be had, the log calls
 * it no error. */
static camber_status check_drivers(camber_context *context, const camber_gpu_backend *backend, bool has_other) {
    static atomic_bool were_asked; /* by the lock */
    camber_saved_log kept;
    if (atomic_exchange(&were_asked, true))
        return CAMBER_OK;
    if (has_other)
        camber_log_demote_errors(context, &kept);
    camber_status status = camber_budget_check_drivers(context);
    if (status == CAMBER_OK)
        status = backend->check_process(context);
    if (status != CAMBER_OK)
        atomic_store(&were_asked, false);
    if (has_other)
        camber_log_restore(context, &kept);
    return status;
}

camber_status camber_find_devices(camber_context *context, const camber_device_desc *desc,
                                  camber_found_devices *found) {
    camber_status status = camber_check_process(context);
    found->count = 0;
    found->failed = (camber_failed_call){0};
    if (status != CAMBER_OK)
        return status;
    pthread_mutex_lock(&asking);
    for (size_t i = 0; i < BACKENDS; i++) {
        if (backends[i]->has_drivers && is_enough(desc, found))
            break;
        if (backends[i]->has_drivers)
            status = check_drivers(context, backends[i], is_usable(desc, found));
        if (status != CAMBER_OK)
            break;
        atomic_store(&process_of_devices, getpid());
        found->count +=
            backends[i]->find(context, found->list + found->count, CAMBER_DEVICES_MAX - found->count, &found->failed);
    }
    pthread_mutex_unlock(&asking);
    return is_usable(desc, found) ? CAMBER_OK : status;
}

static camber_status list_devices(camber_context *context) {
    camber_found_devices found;
    const camber_status status = camber_find_devices(context, NULL, &found);
    if (status != CAMBER_OK)
        return status;
    context->devices = camber_alloc(context, found.count, sizeof *context->devices);
    if (!context->devices)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < found.count; i++)
        context->devices[i] = found.list[i].info;
    context->device_count = found.count;
    return CAMBER_OK;
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
