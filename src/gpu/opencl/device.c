/* Finds and opens OpenCL devices, and defines the table of this back end.
 *
 * Every platform is asked for every device. Any query may fail: that device is then left out, and the reason is logged
 * if no device is left. */
#include "gpu/opencl/opencl.h"
#include "gpu/opencl/pocl.h"

#include <stdio.h>
#include <string.h>

enum { PLATFORMS_MAX = 16, DEVICES_MAX = 64 };

/* The loader returns this if it finds no driver. It belongs to an extension, so that cl.h lacks it. */
#define PLATFORM_NOT_FOUND_KHR (-1001)

static void note(camber_failed_call *failed, const char *call, cl_int code) {
    failed->backend = &camber_opencl;
    failed->name = call;
    failed->code = code;
}

static bool has_word(const char *text, const char *word) {
    const size_t length = strlen(word);
    for (const char *at = strstr(text, word); at; at = strstr(at + 1, word))
        if ((at == text || at[-1] == ' ') && (at[length] == ' ' || at[length] == 0))
            return true;
    return false;
}

static cl_int get_text(cl_device_id id, cl_device_info what, char *text, size_t size) {
    char whole[1024] = "";
    const cl_int code = camber_cl.GetDeviceInfo(id, what, sizeof whole - 1, whole, NULL);
    snprintf(text, size, "%s", whole);
    return code;
}

/* Fills found->info. Returns the error of the first query that fails; the device then cannot be used. */
static cl_int query_info(camber_found_device *found) {
    camber_device_info *info = &found->info;
    cl_device_type type = 0;
    cl_ulong memory = 0, largest = 0;
    char extensions[16384] = ""; /* a longer list does not fit; buffers are then copied */
    const cl_int codes[] = {
        get_text(found->id, CL_DEVICE_NAME, info->name, sizeof info->name),
        get_text(found->id, CL_DEVICE_VERSION, info->version, sizeof info->version),
        get_text(found->id, CL_DRIVER_VERSION, info->driver, sizeof info->driver),
        camber_cl.GetDeviceInfo(found->id, CL_DEVICE_TYPE, sizeof type, &type, NULL),
        camber_cl.GetDeviceInfo(found->id, CL_DEVICE_MAX_COMPUTE_UNITS, sizeof info->compute_units,
                                &info->compute_units, NULL),
        camber_cl.GetDeviceInfo(found->id, CL_DEVICE_GLOBAL_MEM_SIZE, sizeof memory, &memory, NULL),
        camber_cl.GetDeviceInfo(found->id, CL_DEVICE_MAX_MEM_ALLOC_SIZE, sizeof largest, &largest, NULL),
    };
    (void)camber_cl.GetDeviceInfo(found->id, CL_DEVICE_EXTENSIONS, sizeof extensions - 1, extensions, NULL);
    info->memory_bytes = memory;
    info->largest_buffer_bytes = largest;
    info->type = type & CL_DEVICE_TYPE_GPU   ? CAMBER_DEVICE_TYPE_GPU
                 : type & CL_DEVICE_TYPE_CPU ? CAMBER_DEVICE_TYPE_CPU
                                             : CAMBER_DEVICE_TYPE_OTHER;
    info->gl_sharing = camber_cl.shares_gl && has_word(extensions, "cl_khr_gl_sharing");
    for (size_t i = 0; i < sizeof codes / sizeof *codes; i++)
        if (codes[i] != CL_SUCCESS)
            return codes[i];
    return CL_SUCCESS;
}

static size_t find_on_platform(cl_platform_id platform, camber_found_device *found, size_t capacity,
                               camber_failed_call *failed) {
    cl_device_id ids[DEVICES_MAX];
    cl_uint id_count = 0;
    size_t count = 0;
    char name[1024] = "";
    cl_int code = camber_cl.GetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof name - 1, name, NULL);
    if (code != CL_SUCCESS) {
        note(failed, "clGetPlatformInfo", code);
        return 0;
    }
    code = camber_cl.GetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, DEVICES_MAX, ids, &id_count);
    if (code != CL_SUCCESS) {
        if (code != CL_DEVICE_NOT_FOUND)
            note(failed, "clGetDeviceIDs", code);
        return 0;
    }
    for (cl_uint i = 0; i < id_count && i < DEVICES_MAX && count < capacity; i++) {
        found[count] = (camber_found_device){.backend = &camber_opencl, .platform = platform, .id = ids[i]};
        snprintf(found[count].info.platform, sizeof found->info.platform, "%.127s", name);
        code = query_info(found + count);
        if (code == CL_SUCCESS)
            count++;
        else
            note(failed, "clGetDeviceInfo", code);
    }
    return count;
}

static size_t find(camber_context *context, camber_found_device *found, size_t capacity, camber_failed_call *failed) {
    cl_platform_id platforms[PLATFORMS_MAX];
    cl_uint platform_count = 0;
    size_t count = 0;
    (void)context;
    failed->cure = camber_cl_load();
    if (failed->cure)
        return 0;
    failed->cure = "no OpenCL platform answers; install a driver (Debian, for CPUs: pocl-opencl-icd), and let "
                   "POCL_CACHE_DIR name a folder that PoCL can write to";
    const cl_int code = camber_cl.GetPlatformIDs(PLATFORMS_MAX, platforms, &platform_count);
    if (code != CL_SUCCESS) {
        if (code != PLATFORM_NOT_FOUND_KHR)
            note(failed, "clGetPlatformIDs", code);
        return 0;
    }
    if (platform_count > 0)
        failed->cure = NULL;
    for (cl_uint i = 0; i < platform_count && i < PLATFORMS_MAX; i++)
        count += find_on_platform(platforms[i], found + count, capacity - count, failed);
    return count;
}

/* Chooses as many lanes as the device's vectors have. GPUs have none: each work-item takes one pixel at a time. */
static camber_status find_lanes(camber_device *device) {
    cl_uint floats = 0;
    const cl_int code = camber_cl.GetDeviceInfo(opencl_of(device)->id, CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT,
                                                sizeof floats, &floats, NULL);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clGetDeviceInfo", code);
    device->lanes = device->info.type != CAMBER_DEVICE_TYPE_CPU ? 1 : floats >= 16 ? 16 : 8;
    return CAMBER_OK;
}

/* Returns OpenCL's name for a kind of display. */
static cl_context_properties display_kind(const camber_gl_handles *gl) {
    return gl->display_kind == CAMBER_GL_DISPLAY_GLX ? CL_GLX_DISPLAY_KHR : CL_EGL_DISPLAY_KHR;
}

/* Makes the context, shared with a GL context if that works, and the queue; then queries properties. */
static camber_status open_cl(camber_device *device, const camber_gl_handles *gl) {
    camber_opencl_device *cl = device->native;
    cl_int code;
    const cl_context_properties shared[] = {CL_CONTEXT_PLATFORM,
                                            (cl_context_properties)cl->platform,
                                            CL_GL_CONTEXT_KHR,
                                            gl->context,
                                            display_kind(gl),
                                            gl->display,
                                            0};
    const cl_context_properties alone[] = {CL_CONTEXT_PLATFORM, (cl_context_properties)cl->platform, 0};
    if (gl->context && device->info.gl_sharing) {
        cl->cl = camber_cl.CreateContext(shared, 1, &cl->id, NULL, NULL, &code);
        device->gl_context = code == CL_SUCCESS;
    }
    if (!device->gl_context) {
        cl->cl = camber_cl.CreateContext(alone, 1, &cl->id, NULL, NULL, &code);
        if (code != CL_SUCCESS)
            return camber_fail_cl(device->context, "clCreateContext", code);
    }
    cl->queue = camber_cl.CreateCommandQueue(cl->cl, cl->id, CL_QUEUE_PROFILING_ENABLE, &code);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clCreateCommandQueue", code);
    cl_device_fp_config rounding = 0;
    code = camber_cl.GetDeviceInfo(cl->id, CL_DEVICE_SINGLE_FP_CONFIG, sizeof rounding, &rounding, NULL);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clGetDeviceInfo", code);
    device->rounds_correctly = (rounding & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    cl_bool unified = CL_FALSE; /* if the query fails, buffers are copied */
    (void)camber_cl.GetDeviceInfo(cl->id, CL_DEVICE_HOST_UNIFIED_MEMORY, sizeof unified, &unified, NULL);
    device->host_memory = device->info.type == CAMBER_DEVICE_TYPE_CPU && unified;
    return device->lanes ? CAMBER_OK : find_lanes(device);
}

static camber_status open_device(camber_device *device, const camber_found_device *found,
                                 const camber_device_desc *desc) {
    camber_opencl_device *made = camber_alloc_zero(device->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->platform = found->platform;
    made->id = found->id;
    device->native = made;
    return open_cl(device, &desc->gl);
}

static void close_device(camber_device *device) {
    camber_opencl_device *cl = device->native;
    if (cl && cl->queue)
        camber_cl.ReleaseCommandQueue(cl->queue);
    if (cl && cl->cl)
        camber_cl.ReleaseContext(cl->cl);
    camber_free(device->context, cl);
    device->native = NULL;
}

static camber_status finish(const camber_device *device, bool is_told) {
    const cl_int code = camber_cl.Finish(opencl_of(device)->queue);
    if (code == CL_SUCCESS)
        return CAMBER_OK;
    return is_told ? camber_fail_cl(device->context, "clFinish", code) : CAMBER_ERROR_DEVICE;
}

static camber_status fail_found(camber_context *context, const camber_failed_call *failed) {
    return camber_fail_cl(context, failed->name, failed->code);
}

const camber_gpu_backend camber_opencl = {
    .has_drivers = true,
    .check_process = camber_pocl_check_threads,
    .find = find,
    .fail = fail_found,
    .open = open_device,
    .close = close_device,
    .finish = finish,
    .make_buffer = camber_opencl_make_buffer,
    .make_gl_buffer = camber_opencl_make_gl_buffer,
    .release_buffer = camber_opencl_release_buffer,
    .write = camber_opencl_write,
    .read = camber_opencl_read,
    .map = camber_opencl_map,
    .unmap = camber_opencl_unmap,
    .acquire_gl = camber_opencl_acquire_gl,
    .release_gl = camber_opencl_release_gl,
    .make_program = camber_opencl_make_program,
    .release_program = camber_opencl_release_program,
    .make_kernel = camber_opencl_make_kernel,
    .release_kernel = camber_opencl_release_kernel,
    .launch = camber_opencl_launch,
    .wait = camber_opencl_wait,
    .end_event = camber_opencl_end_event,
};
