/* The processor itself as a device: kernels that were compiled with the library (compile.cmake), run by a pool of
 * threads.
 *
 * A launch has ended when it returns, so there is nothing to wait for. A buffer is memory of the context, and mapping
 * it costs nothing. The same text as for OpenCL, compiled without contraction and with IEEE division and roots, gives
 * the same bytes as the twin. */
#include "gpu/backend.h"

#include "base/threads.h"
#include "gpu/cpu/args.h"
#include "gpu/cpu/pool.h"
#include "kernels/layout.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* As AVX-512's vectors and cache lines need, and as callers' pictures have. */
enum { ALIGNMENT = CAMBER_PIXELS_ALIGNMENT };

typedef struct cpu_device {
    const camber_cpu_level *level;
    camber_cpu_pool *pool;
} cpu_device;

static const cpu_device *cpu_of(const camber_device *device) {
    return device->native;
}

/* ---- Devices ---- */

/* The level that CAMBER_CPU names, or the best. "none" leaves this device out, and so does a level that is not here. */
static const camber_cpu_level *wanted_level(camber_context *context) {
    const char *name = getenv("CAMBER_CPU");
    const camber_cpu_level *level = camber_cpu_level_find(name && *name ? name : NULL);
    char names[128];
    if (!level && name && *name && strcmp(name, "none") != 0) {
        camber_cpu_level_names(names, sizeof names);
        camber_log(context, CAMBER_LOG_WARNING,
                   "CAMBER_CPU: this processor has no level '%s', so it is left out; choose one of: %snone", name,
                   names);
    }
    return level;
}

static uint64_t machine_bytes(void) {
    const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    return pages > 0 && page_bytes > 0 ? (uint64_t)pages * (uint64_t)page_bytes : 0;
}

static size_t find(camber_context *context, camber_found_device *found, size_t capacity, camber_failed_call *failed) {
    const camber_cpu_level *level = wanted_level(context);
    (void)failed;
    if (!level || capacity == 0)
        return 0;
    *found = (camber_found_device){.backend = &camber_cpu, .id = (void *)(uintptr_t)level};
    camber_device_info *info = &found->info;
    snprintf(info->name, sizeof info->name, "camber %s", level->name);
    snprintf(info->platform, sizeof info->platform, "kernels compiled ahead of time");
    snprintf(info->version, sizeof info->version, "%s", CAMBER_CPU_COMPILER);
    snprintf(info->driver, sizeof info->driver, "%s", camber_version());
    info->fixed_kernels = true;
    info->type = CAMBER_DEVICE_TYPE_CPU;
    info->compute_units = (uint32_t)camber_threads_count(0);
    info->memory_bytes = info->largest_buffer_bytes = machine_bytes();
    return 1;
}

static camber_status fail(camber_context *context, const camber_failed_call *failed) {
    return camber_fail(context, CAMBER_ERROR_DEVICE, "%s fails; try another device", failed->name);
}

static camber_status open_device(camber_device *device, const camber_found_device *found,
                                 const camber_device_desc *desc) {
    cpu_device *made = camber_alloc_zero(device->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    device->native = made;
    made->level = found->id;
    device->lanes = made->level->lanes;
    device->rounds_correctly = true;
    device->host_memory = true;
    device->info.compute_units = (uint32_t)camber_threads_count(desc->threads);
    return camber_cpu_pool_create(device->context, device->info.compute_units, &made->pool);
}

static void close_device(camber_device *device) {
    cpu_device *cpu = device->native;
    if (cpu)
        camber_cpu_pool_destroy(cpu->pool);
    camber_free(device->context, cpu);
    device->native = NULL;
}

static camber_status finish(const camber_device *device, bool is_told) {
    (void)device;
    (void)is_told;
    return CAMBER_OK;
}

/* ---- Buffers ---- */

typedef struct cpu_buffer {
    camber_context *context;
    char *bytes;
    void *block; /* NULL: the bytes are borrowed */
} cpu_buffer;

static char *bytes_of(void *native) {
    return native ? ((cpu_buffer *)native)->bytes : NULL;
}

static camber_status make_buffer(const camber_device *device, camber_buffer_kind kind, size_t size_bytes,
                                 const void *bytes, void **native) {
    camber_context *context = device->context;
    const bool is_borrowed = kind >= CAMBER_BUFFER_BORROWED;
    cpu_buffer *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->bytes = (char *)(uintptr_t)bytes; /* kernels only read bytes that callers pass as const */
    if (!is_borrowed) {
        made->block = camber_alloc(context, 1, size_bytes <= SIZE_MAX - ALIGNMENT ? size_bytes + ALIGNMENT : SIZE_MAX);
        if (!made->block) {
            camber_free(context, made);
            return CAMBER_ERROR_MEMORY;
        }
        made->bytes = (char *)made->block + (ALIGNMENT - (uintptr_t)made->block % ALIGNMENT) % ALIGNMENT;
    }
    if (kind == CAMBER_BUFFER_COPY)
        memcpy(made->bytes, bytes, size_bytes);
    *native = made;
    return CAMBER_OK;
}

static void release_buffer(void *native) {
    cpu_buffer *buffer = native;
    camber_free(buffer->context, buffer->block);
    camber_free(buffer->context, buffer);
}

static camber_status write_buffer(const camber_device *device, void *native, const camber_byte_range *range,
                                  const void *bytes, bool waits) {
    (void)device;
    (void)waits;
    memcpy(bytes_of(native) + range->offset_bytes, bytes, range->size_bytes);
    return CAMBER_OK;
}

static camber_status read_buffer(const camber_device *device, void *native, size_t size_bytes, void *bytes) {
    (void)device;
    memcpy(bytes, bytes_of(native), size_bytes);
    return CAMBER_OK;
}

static camber_status map_buffer(const camber_device *device, void *native, camber_map_access access, size_t size_bytes,
                                void **bytes) {
    (void)device;
    (void)access;
    (void)size_bytes;
    *bytes = bytes_of(native);
    return CAMBER_OK;
}

static camber_status unmap_buffer(const camber_device *device, void *native, void *bytes, bool is_told) {
    (void)device;
    (void)native;
    (void)bytes;
    (void)is_told;
    return CAMBER_OK;
}

/* ---- Programs ---- */

static camber_status make_program(camber_device *device, const camber_program_source *from, camber_program *program) {
    program->native = (void *)(uintptr_t)cpu_of(device)->level->programs[from->number];
    program->kept = true;
    return CAMBER_OK;
}

static void release_program(void *native) {
    (void)native;
}

static camber_status make_kernel(const camber_device *device, void *program, const char *name, camber_kernel **kernel) {
    const camber_cpu_kernel *found = program;
    while (found->name && strcmp(found->name, name) != 0)
        found++;
    if (!found->name)
        return camber_fail(device->context, CAMBER_ERROR_DEVICE, "there is no kernel %s", name);
    *kernel = (camber_kernel *)(uintptr_t)found;
    return CAMBER_OK;
}

static void release_kernel(camber_kernel *kernel) {
    (void)kernel;
}

/* ---- Launches ---- */

typedef struct cpu_event {
    camber_context *context;
    double ms;
} cpu_event;

enum { ARG_BYTES_MAX = 512 };

/* Lays the arguments out as the kernels' structs of arguments are. */
static void put_args(const camber_launch *launch, char *args) {
    size_t at = 0;
    for (size_t i = 0; i < launch->arg_count; i++) {
        const camber_kernel_arg *arg = launch->args + i;
        const char *bytes = arg->buffer ? bytes_of(arg->buffer->native) : NULL;
        const size_t size_bytes = arg->value ? arg->value_bytes : sizeof bytes;
        assert(at + size_bytes <= ARG_BYTES_MAX);
        memcpy(args + at, arg->value ? arg->value : &bytes, size_bytes);
        at += (size_bytes + CAMBER_CPU_ARG_BYTES - 1) / CAMBER_CPU_ARG_BYTES * CAMBER_CPU_ARG_BYTES;
    }
}

static camber_status launch_kernel(const camber_device *device, const camber_launch *launch, camber_event **event) {
    _Alignas(CAMBER_CPU_ARG_BYTES) char args[ARG_BYTES_MAX];
    const camber_cpu_kernel *kernel = (const camber_cpu_kernel *)launch->kernel;
    const size_t groups = (launch->work_items + launch->group_size - 1) / launch->group_size;
    cpu_event *made = NULL;
    if (event) {
        made = camber_alloc(device->context, 1, sizeof *made);
        if (!made)
            return CAMBER_ERROR_MEMORY;
    }
    put_args(launch, args);
    const double begin = camber_now_ms();
    camber_cpu_pool_run(cpu_of(device)->pool, &(camber_cpu_work){kernel->run, args, groups * launch->group_size});
    if (event) {
        *made = (cpu_event){device->context, camber_now_ms() - begin};
        *event = (camber_event *)made;
    }
    return CAMBER_OK;
}

static camber_status wait_for(const camber_device *device, camber_event *event, const char *name) {
    (void)device;
    (void)event;
    (void)name;
    return CAMBER_OK;
}

static double end_event(camber_event *event) {
    cpu_event *ended = (cpu_event *)event;
    const double ms = ended->ms;
    camber_free(ended->context, ended);
    return ms;
}

const camber_gpu_backend camber_cpu = {
    .counts_memory = true,
    .find = find,
    .fail = fail,
    .open = open_device,
    .close = close_device,
    .finish = finish,
    .make_buffer = make_buffer,
    .release_buffer = release_buffer,
    .write = write_buffer,
    .read = read_buffer,
    .map = map_buffer,
    .unmap = unmap_buffer,
    .make_program = make_program,
    .release_program = release_program,
    .make_kernel = make_kernel,
    .release_kernel = release_kernel,
    .launch = launch_kernel,
    .wait = wait_for,
    .end_event = end_event,
};
