/* Chooses and opens compute devices.
 *
 * Input: a desc that gives a word that the device must match, and memory limits. Output: a camber_device that a back
 * end has opened, with the sizes that its kernels are built for. Among matching devices, a GPU is preferred to a CPU,
 * and a CPU to anything else. Programs are made later, when they are first used (program.c). */
#include "gpu/backend.h"

#include "kernels/layout.h"

#include <stdio.h>
#include <string.h>

static int rank(const camber_device_info *info) {
    return info->type == CAMBER_DEVICE_TYPE_GPU ? 2 : info->type == CAMBER_DEVICE_TYPE_CPU ? 1 : 0;
}

static bool has_kernels(const camber_device_info *info, const camber_device_desc *desc) {
    return !info->fixed_kernels || (desc->work_group_size == 0 && desc->lanes == 0);
}

/* Picks the best matching device: a GPU, else a CPU, else any other. If number is not 0, picks the number-th matching
 * device. A device without kernels for the desc's work-groups and lanes is passed over. */
static camber_status choose_device(camber_device *device, const camber_device_desc *desc, camber_found_device *chosen) {
    const char *match = desc->match;
    const uint32_t number = desc->number;
    camber_found_devices found;
    const camber_status status = camber_find_devices(device->context, desc, &found);
    if (status != CAMBER_OK)
        return status;
    const char *cure = found.failed.cure;
    if (found.count == 0 && found.failed.name)
        return found.failed.backend->fail(device->context, &found.failed);
    if (found.count == 0)
        return camber_fail(device->context, CAMBER_ERROR_DEVICE, "no device: %s",
                           cure ? cure : "no OpenCL platform has one; install a driver");
    char names[1024] = "";
    uint32_t seen = 0;
    int best = -1;
    bool lacks_kernels = false;
    for (size_t i = 0; i < found.count; i++) {
        const camber_device_info info = found.list[i].info;
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "", info.name);
        if (!camber_device_matches(&info, match) || (number ? ++seen != number : rank(&info) <= best))
            continue;
        if (!has_kernels(&info, desc)) {
            lacks_kernels = true;
            continue;
        }
        best = rank(&info);
        *chosen = found.list[i];
    }
    if (best < 0 && lacks_kernels)
        return camber_fail(device->context, CAMBER_ERROR_DEVICE,
                           "no kernels were compiled for work-groups of %u points and %u lanes; ask for 0 of both, or "
                           "for an OpenCL device; there are: %s",
                           desc->work_group_size, desc->lanes, names);
    if (best < 0 && number)
        return camber_fail(device->context, CAMBER_ERROR_DEVICE, "no device number %u matches '%s'; there are: %s%s%s",
                           number, match ? match : "", names, cure ? "; " : "", cure ? cure : "");
    if (best < 0)
        return camber_fail(device->context, CAMBER_ERROR_DEVICE, "no device matches '%s'; there are: %s%s%s", match,
                           names, cure ? "; " : "", cure ? cure : "");
    return CAMBER_OK;
}

/* With less than this, a part of a single block and the strokes of a style would not fit. */
enum { LEAST_BUFFER_BYTES = 4096, LEAST_MEMORY_BYTES = 65536 };
/* llvmpipe addresses vertices with a signed 32-bit offset and crashes beyond it. */
static const uint64_t LARGEST_BUFFER_BYTES = INT32_MAX;

static camber_status check_bounds(const camber_device *device, const camber_device_desc *desc) {
    const uint32_t size = desc->work_group_size;
    if (size != 0 && size != 64 && size != 128 && size != 256)
        return camber_fail(device->context, CAMBER_ERROR_ARGUMENT,
                           "a work-group of %u points; it must be 64, 128, 256, or 0 for 256", size);
    if (desc->lanes != 0 && desc->lanes != 1 && desc->lanes != 8 && desc->lanes != 16)
        return camber_fail(device->context, CAMBER_ERROR_ARGUMENT,
                           "vectors of %u lanes; it must be 1, 8, 16, or 0 for the device's own width", desc->lanes);
    if (desc->largest_buffer_bytes != 0 && desc->largest_buffer_bytes < LEAST_BUFFER_BYTES)
        return camber_fail(device->context, CAMBER_ERROR_ARGUMENT,
                           "a largest buffer of %llu bytes; it must be %d or more, or 0 for the device's own limit",
                           (unsigned long long)desc->largest_buffer_bytes, LEAST_BUFFER_BYTES);
    if (desc->memory_bytes != 0 && desc->memory_bytes < LEAST_MEMORY_BYTES)
        return camber_fail(device->context, CAMBER_ERROR_ARGUMENT,
                           "%llu bytes of memory for meshes; it must be %d or more, or 0 for what the device has",
                           (unsigned long long)desc->memory_bytes, LEAST_MEMORY_BYTES);
    return CAMBER_OK;
}

/* Sets the work-group size, the lanes and the largest buffer from the limits of the desc and of the device. */
static void apply_bounds(camber_device *device, const camber_device_desc *desc) {
    const uint32_t size = desc->work_group_size;
    device->block = size ? size : CAMBER_BLOCK;
    device->point_chunk = size == 0 && device->info.type == CAMBER_DEVICE_TYPE_CPU ? device->block : CAMBER_POINT_CHUNK;
    device->lanes = desc->lanes;
    uint64_t *largest = &device->info.largest_buffer_bytes;
    if (*largest > LARGEST_BUFFER_BYTES)
        *largest = LARGEST_BUFFER_BYTES;
    if (desc->gl.largest_buffer_bytes && desc->gl.largest_buffer_bytes < *largest)
        *largest = desc->gl.largest_buffer_bytes;
    if (desc->largest_buffer_bytes && desc->largest_buffer_bytes < *largest)
        *largest = desc->largest_buffer_bytes;
}

/* Sets the memory limit for meshes. If the desc gives none, a device with memory of its own keeps a quarter of it for
 * pictures. */
static void bound_memory(camber_device *device, const camber_device_desc *desc) {
    device->memory_bytes = desc->memory_bytes;
    if (!desc->memory_bytes && !device->host_memory && device->info.memory_bytes)
        device->memory_bytes = device->info.memory_bytes / 4 * 3;
}

camber_status camber_device_create(camber_context *context, const camber_device_desc *desc, camber_device **device) {
    camber_device *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    camber_found_device found = {0};
    made->context = context;
    const camber_device_desc full = desc ? *desc : (camber_device_desc){0};
    camber_status status = check_bounds(made, &full);
    if (status == CAMBER_OK)
        status = choose_device(made, &full, &found);
    made->backend = found.backend;
    made->info = found.info;
    if (status == CAMBER_OK && found.backend) {
        apply_bounds(made, &full);
        status = found.backend->open(made, &found, &full);
    }
    if (status == CAMBER_OK)
        bound_memory(made, &full);
    if (status != CAMBER_OK) {
        camber_device_destroy(made);
        return status;
    }
    *device = made;
    return CAMBER_OK;
}

void camber_device_destroy(camber_device *device) {
    if (!device)
        return;
    for (size_t i = 0; i < CAMBER_PROGRAM_COUNT; i++)
        camber_program_destroy(device, device->programs[i]);
    if (device->backend)
        device->backend->close(device);
    camber_free(device->context, device);
}

camber_device_info camber_device_get_info(const camber_device *device) {
    return device->info;
}

camber_status camber_device_finish(const camber_device *device) {
    return device->backend->finish(device, true);
}

void camber_device_settle(const camber_device *device) {
    (void)device->backend->finish(device, false);
}
