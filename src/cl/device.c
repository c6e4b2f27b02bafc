/* Finds, describes and opens OpenCL devices.
 *
 * Input: a desc with a word that the device must match and bounds on its memory. Output: a camber_device with a
 * context, a queue, and the sizes that its kernels are built for. Every platform is asked for every device; of those
 * that match a GPU wins over a CPU, and a CPU over anything else. Programs are built later, when they are first used
 * (program.c). */
#include "cl/pocl.h"
#include "cl/program.h"

#include "kernels/layout.h"

#include <CL/cl_gl.h>
#include <ctype.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

enum { PLATFORMS_MAX = 16, DEVICES_MAX = 64 };

/* The loader answers this where it finds no driver. It belongs to an extension, so that cl.h lacks it. */
#define PLATFORM_NOT_FOUND_KHR (-1001)

static const char *cl_error_name(cl_int code) {
    switch (code) {
    case CL_DEVICE_NOT_FOUND: return "CL_DEVICE_NOT_FOUND";
    case CL_DEVICE_NOT_AVAILABLE: return "CL_DEVICE_NOT_AVAILABLE";
    case CL_COMPILER_NOT_AVAILABLE: return "CL_COMPILER_NOT_AVAILABLE";
    case CL_MEM_OBJECT_ALLOCATION_FAILURE: return "CL_MEM_OBJECT_ALLOCATION_FAILURE";
    case CL_OUT_OF_RESOURCES: return "CL_OUT_OF_RESOURCES";
    case CL_OUT_OF_HOST_MEMORY: return "CL_OUT_OF_HOST_MEMORY";
    case CL_BUILD_PROGRAM_FAILURE: return "CL_BUILD_PROGRAM_FAILURE";
    case CL_INVALID_VALUE: return "CL_INVALID_VALUE";
    case CL_INVALID_BUFFER_SIZE: return "CL_INVALID_BUFFER_SIZE";
    case CL_INVALID_BINARY: return "CL_INVALID_BINARY";
    case CL_INVALID_WORK_GROUP_SIZE: return "CL_INVALID_WORK_GROUP_SIZE";
    case PLATFORM_NOT_FOUND_KHR: return "CL_PLATFORM_NOT_FOUND_KHR";
    default: return "error";
    }
}

camber_status camber_fail_cl(camber_context *context, const char *call, cl_int code) {
    const bool memory = code == CL_MEM_OBJECT_ALLOCATION_FAILURE || code == CL_OUT_OF_HOST_MEMORY ||
                        code == CL_OUT_OF_RESOURCES || code == CL_INVALID_BUFFER_SIZE;
    const char *cure = memory ? "draw less at once or use a device with more memory" : "try another device";
    if (code == CL_INVALID_WORK_GROUP_SIZE)
        cure = "ask for smaller work-groups";
    return camber_fail(context, memory ? CAMBER_ERROR_MEMORY : CAMBER_ERROR_DEVICE, "%s: OpenCL %s (%d); %s", call,
                       cl_error_name(code), code, cure);
}

typedef struct found_device {
    cl_platform_id platform;
    cl_device_id id;
    camber_device_info info;
} found_device;

/* A call that failed while devices were looked for: the reason to give where none is found. */
typedef struct failed_call {
    const char *name; /* NULL: none failed */
    cl_int code;
} failed_call;

static bool has_word(const char *text, const char *word) {
    const size_t length = strlen(word);
    for (const char *at = strstr(text, word); at; at = strstr(at + 1, word))
        if ((at == text || at[-1] == ' ') && (at[length] == ' ' || at[length] == 0))
            return true;
    return false;
}

static cl_int get_text(cl_device_id id, cl_device_info what, char *text, size_t size) {
    char whole[1024] = "";
    const cl_int code = clGetDeviceInfo(id, what, sizeof whole - 1, whole, NULL);
    snprintf(text, size, "%s", whole);
    return code;
}

/* Fills found->info. Returns the error of the first question that the device does not answer: it cannot be used. */
static cl_int query_info(found_device *found) {
    camber_device_info *info = &found->info;
    cl_device_type type = 0;
    cl_ulong memory = 0, largest = 0;
    char extensions[16384] = ""; /* a longer list does not fit: buffers are copied then */
    const cl_int codes[] = {
        get_text(found->id, CL_DEVICE_NAME, info->name, sizeof info->name),
        get_text(found->id, CL_DEVICE_VERSION, info->version, sizeof info->version),
        get_text(found->id, CL_DRIVER_VERSION, info->driver, sizeof info->driver),
        clGetDeviceInfo(found->id, CL_DEVICE_TYPE, sizeof type, &type, NULL),
        clGetDeviceInfo(found->id, CL_DEVICE_MAX_COMPUTE_UNITS, sizeof info->compute_units, &info->compute_units, NULL),
        clGetDeviceInfo(found->id, CL_DEVICE_GLOBAL_MEM_SIZE, sizeof memory, &memory, NULL),
        clGetDeviceInfo(found->id, CL_DEVICE_MAX_MEM_ALLOC_SIZE, sizeof largest, &largest, NULL),
    };
    (void)clGetDeviceInfo(found->id, CL_DEVICE_EXTENSIONS, sizeof extensions - 1, extensions, NULL);
    info->memory_bytes = memory;
    info->largest_buffer_bytes = largest;
    info->type = type & CL_DEVICE_TYPE_GPU   ? CAMBER_DEVICE_TYPE_GPU
                 : type & CL_DEVICE_TYPE_CPU ? CAMBER_DEVICE_TYPE_CPU
                                             : CAMBER_DEVICE_TYPE_OTHER;
    info->gl_sharing = has_word(extensions, "cl_khr_gl_sharing");
    for (size_t i = 0; i < sizeof codes / sizeof *codes; i++)
        if (codes[i] != CL_SUCCESS)
            return codes[i];
    return CL_SUCCESS;
}

static size_t find_on_platform(cl_platform_id platform, found_device *found, size_t capacity, failed_call *failed) {
    cl_device_id ids[DEVICES_MAX];
    cl_uint id_count = 0;
    size_t count = 0;
    char name[1024] = "";
    cl_int code = clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof name - 1, name, NULL);
    if (code != CL_SUCCESS) {
        *failed = (failed_call){"clGetPlatformInfo", code};
        return 0;
    }
    code = clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, DEVICES_MAX, ids, &id_count);
    if (code != CL_SUCCESS) {
        if (code != CL_DEVICE_NOT_FOUND)
            *failed = (failed_call){"clGetDeviceIDs", code};
        return 0;
    }
    for (cl_uint i = 0; i < id_count && i < DEVICES_MAX && count < capacity; i++) {
        found[count] = (found_device){.platform = platform, .id = ids[i]};
        snprintf(found[count].info.platform, sizeof found->info.platform, "%.127s", name);
        code = query_info(found + count);
        if (code == CL_SUCCESS)
            count++;
        else
            *failed = (failed_call){"clGetDeviceInfo", code};
    }
    return count;
}

static size_t ask_platforms(found_device found[DEVICES_MAX], failed_call *failed) {
    cl_platform_id platforms[PLATFORMS_MAX];
    cl_uint platform_count = 0;
    size_t count = 0;
    *failed = (failed_call){0};
    const cl_int code = clGetPlatformIDs(PLATFORMS_MAX, platforms, &platform_count);
    if (code != CL_SUCCESS) {
        if (code != PLATFORM_NOT_FOUND_KHR)
            *failed = (failed_call){"clGetPlatformIDs", code};
        return 0;
    }
    for (cl_uint i = 0; i < platform_count && i < PLATFORMS_MAX; i++)
        count += find_on_platform(platforms[i], found + count, DEVICES_MAX - count, failed);
    return count;
}

/* The only lock of the whole process. It guards state of the process: the OpenCL loader and the drivers set themselves
 * up when they are first asked. PoCL (3.1 and 6.0) tells a second thread too early that this is done, and gives it
 * devices without a name. Every use of OpenCL begins with find_devices, so locking here is enough. */
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

/* Returns how many devices were found. *failed takes the last call that failed, if any did. */
static size_t find_devices(found_device found[DEVICES_MAX], failed_call *failed) {
    pthread_mutex_lock(&asking);
    atomic_store(&process_of_drivers, getpid());
    const size_t count = ask_platforms(found, failed);
    pthread_mutex_unlock(&asking);
    return count;
}

static camber_status list_devices(camber_context *context) {
    found_device found[DEVICES_MAX];
    failed_call failed;
    camber_status status = camber_check_process(context);
    if (status == CAMBER_OK)
        status = camber_budget_check_drivers(context);
    if (status == CAMBER_OK && atomic_load(&process_of_drivers) == 0)
        status = camber_pocl_check_threads(context);
    if (status != CAMBER_OK)
        return status;
    const size_t count = find_devices(found, &failed);
    context->devices = camber_alloc(context, count, sizeof *context->devices);
    if (!context->devices)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++)
        context->devices[i] = found[i].info;
    context->device_count = count;
    return CAMBER_OK;
}

camber_status camber_device_list(camber_context *context, size_t n, const camber_device_info **info) {
    const camber_status status = context->devices ? CAMBER_OK : list_devices(context);
    if (status == CAMBER_OK)
        *info = n < context->device_count ? context->devices + n : NULL;
    return status;
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

bool camber_device_info_matches(const camber_device_info *info, const char *match) {
    if (!match)
        return true;
    if (contains_ignoring_case("cpu", match) && strlen(match) == 3)
        return info->type == CAMBER_DEVICE_TYPE_CPU;
    if (contains_ignoring_case("gpu", match) && strlen(match) == 3)
        return info->type == CAMBER_DEVICE_TYPE_GPU;
    return contains_ignoring_case(info->name, match) || contains_ignoring_case(info->platform, match);
}

static int rank(const camber_device_info *info) {
    return info->type == CAMBER_DEVICE_TYPE_GPU ? 2 : info->type == CAMBER_DEVICE_TYPE_CPU ? 1 : 0;
}

/* Picks the best device that matches: a GPU, else a CPU, else another; or the number-th of those that match, where
 * number is not 0. */
static camber_status choose_device(camber_device *device, const char *match, uint32_t number) {
    found_device found[DEVICES_MAX];
    failed_call failed;
    const size_t count = find_devices(found, &failed);
    if (count == 0 && failed.name)
        return camber_fail_cl(device->context, failed.name, failed.code);
    if (count == 0)
        return camber_fail(device->context, CAMBER_ERROR_DEVICE,
                           "no OpenCL device: no platform answers; install a driver (Debian: pocl-opencl-icd), "
                           "and let POCL_CACHE_DIR name a folder that PoCL can write to");
    char names[1024] = "";
    uint32_t seen = 0;
    int best = -1;
    for (size_t i = 0; i < count; i++) {
        const camber_device_info info = found[i].info;
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "", info.name);
        if (!camber_device_info_matches(&info, match) || (number ? ++seen != number : rank(&info) <= best))
            continue;
        best = rank(&info);
        device->platform = found[i].platform;
        device->id = found[i].id;
        device->info = info;
    }
    if (best < 0 && number)
        return camber_fail(device->context, CAMBER_ERROR_DEVICE,
                           "no OpenCL device number %u matches '%s'; there are: %s", number, match ? match : "", names);
    if (best < 0)
        return camber_fail(device->context, CAMBER_ERROR_DEVICE, "no OpenCL device matches '%s'; there are: %s", match,
                           names);
    return CAMBER_OK;
}

/* Below these, a part of a single block and the strokes of a style would not fit. */
enum { LEAST_BUFFER_BYTES = 4096, LEAST_MEMORY_BYTES = 65536 };
/* llvmpipe addresses vertices with a signed 32-bit offset and crashes beyond it. */
static const uint64_t LARGEST_BUFFER_BYTES = INT32_MAX;

/* Lanes that are as wide as the device's vectors. GPUs have none: each work-item takes a pixel at a time. */
static camber_status native_lanes(const camber_device *device, unsigned *lanes) {
    cl_uint floats = 0;
    const cl_int code = clGetDeviceInfo(device->id, CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT, sizeof floats, &floats, NULL);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clGetDeviceInfo", code);
    *lanes = device->info.type != CAMBER_DEVICE_TYPE_CPU ? 1 : floats >= 16 ? 16 : 8;
    return CAMBER_OK;
}

/* Sets the work-group's size, the lanes and the largest buffer, from the desc's bounds and the device's. */
static camber_status apply_bounds(camber_device *device, const camber_device_desc *desc) {
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
    return device->lanes ? CAMBER_OK : native_lanes(device, &device->lanes);
}

/* Bounds what meshes may hold. Where the desc gives no bound, a device with memory of its own keeps a quarter of it for
 * pictures. */
static void bound_memory(camber_device *device, const camber_device_desc *desc) {
    device->memory_bytes = desc->memory_bytes;
    if (!desc->memory_bytes && !device->host_memory && device->info.memory_bytes)
        device->memory_bytes = device->info.memory_bytes / 4 * 3;
}

/* Makes the context, shared with a GL context where that works, and the queue; then asks for properties. */
static camber_status open_cl(camber_device *device, const camber_gl_handles *gl) {
    cl_int code;
    const cl_context_properties shared[] = {CL_CONTEXT_PLATFORM,
                                            (cl_context_properties)device->platform,
                                            CL_GL_CONTEXT_KHR,
                                            gl->context,
                                            gl->display_kind,
                                            gl->display,
                                            0};
    const cl_context_properties alone[] = {CL_CONTEXT_PLATFORM, (cl_context_properties)device->platform, 0};
    if (gl->context && device->info.gl_sharing) {
        device->cl = clCreateContext(shared, 1, &device->id, NULL, NULL, &code);
        device->gl_context = code == CL_SUCCESS;
    }
    if (!device->gl_context) {
        device->cl = clCreateContext(alone, 1, &device->id, NULL, NULL, &code);
        if (code != CL_SUCCESS)
            return camber_fail_cl(device->context, "clCreateContext", code);
    }
    device->queue = clCreateCommandQueue(device->cl, device->id, CL_QUEUE_PROFILING_ENABLE, &code);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clCreateCommandQueue", code);
    cl_device_fp_config rounding = 0;
    code = clGetDeviceInfo(device->id, CL_DEVICE_SINGLE_FP_CONFIG, sizeof rounding, &rounding, NULL);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clGetDeviceInfo", code);
    device->rounds_correctly = (rounding & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    cl_bool unified = CL_FALSE; /* a device that does not answer gets copies */
    (void)clGetDeviceInfo(device->id, CL_DEVICE_HOST_UNIFIED_MEMORY, sizeof unified, &unified, NULL);
    device->host_memory = device->info.type == CAMBER_DEVICE_TYPE_CPU && unified;
    return CAMBER_OK;
}

camber_status camber_device_create(camber_context *context, const camber_device_desc *desc, camber_device **device) {
    camber_device *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    const camber_device_desc full = desc ? *desc : (camber_device_desc){0};
    camber_status status = camber_check_process(context);
    if (status == CAMBER_OK)
        status = camber_budget_check_drivers(context);
    if (status == CAMBER_OK && atomic_load(&process_of_drivers) == 0)
        status = camber_pocl_check_threads(context);
    if (status == CAMBER_OK)
        status = choose_device(made, full.match, full.number);
    if (status == CAMBER_OK)
        status = apply_bounds(made, &full);
    if (status == CAMBER_OK)
        status = open_cl(made, &full.gl);
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
    for (int has_arc_length = 0; has_arc_length < 2; has_arc_length++) {
        for (int kind = 0; kind < 6; kind++)
            camber_program_destroy(device->context, device->programs[has_arc_length][kind / 3][kind % 3]);
        for (int pitched = 0; pitched < 2; pitched++)
            camber_program_destroy(device->context, device->network_programs[has_arc_length][pitched]);
    }
    camber_program_destroy(device->context, device->arc_length_program);
    for (size_t i = 0; i < 2; i++)
        camber_program_destroy(device->context, device->offset_programs[i]);
    for (size_t i = 0; i < sizeof device->raster_programs / sizeof *device->raster_programs; i++)
        camber_program_destroy(device->context, device->raster_programs[i]);
    if (device->queue)
        clReleaseCommandQueue(device->queue);
    if (device->cl)
        clReleaseContext(device->cl);
    camber_free(device->context, device);
}

camber_device_info camber_device_get_info(const camber_device *device) {
    return device->info;
}
