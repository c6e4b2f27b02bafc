/* OpenCL's calls on their way to the driver: refused from the n-th on, counted, and what they make counted too.
 * CMakeLists.txt links them with --wrap. */
#ifndef CAMBER_TESTS_CL_FAULT_H
#define CAMBER_TESTS_CL_FAULT_H

#include <CL/cl.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* What is alive. */
typedef struct cl_objects {
    long contexts, queues, programs, kernels, mems, events, maps;
} cl_objects;

static struct cl_fault {
    size_t calls;                     /* that could be refused */
    size_t refuse_first, refuse_last; /* of them, counted from 1; 0: none */
    cl_int code;                      /* that refused calls answer */
    size_t refusals;
    const char *refused; /* the first */
    cl_objects live;
    const char *build_log;  /* not NULL: programs from source do not build, and say this */
    cl_ulong largest_bytes; /* not 0: what a device says that its largest buffer is, and holds to */
} cl_fault;

static inline void cl_fault_arm(size_t first, size_t last, cl_int code) {
    cl_fault.calls = cl_fault.refusals = 0;
    cl_fault.refused = NULL;
    cl_fault.refuse_first = first;
    cl_fault.refuse_last = last;
    cl_fault.code = code;
}

static inline void cl_fault_disarm(void) {
    cl_fault.refuse_first = 0;
}

static inline cl_int cl_fault_answer(const char *call) {
    cl_fault.calls++;
    if (cl_fault.refuse_first == 0 || cl_fault.calls < cl_fault.refuse_first || cl_fault.calls > cl_fault.refuse_last)
        return CL_SUCCESS;
    if (cl_fault.refusals++ == 0)
        cl_fault.refused = call;
    return cl_fault.code;
}

#define DECLARE(type, call, parameters)                                                                                \
    type __real_##call parameters;                                                                                     \
    type __wrap_##call parameters;

/* A call that gives its code. */
#define WRAP(call, parameters, arguments)                                                                              \
    DECLARE(cl_int, call, parameters)                                                                                  \
    cl_int __wrap_##call parameters {                                                                                  \
        const cl_int refusal = cl_fault_answer(#call);                                                                 \
        return refusal ? refusal : __real_##call arguments;                                                            \
    }

/* A call that makes something of which to keep count, and writes its code. */
#define WRAP_MAKE(type, kind, call, parameters, arguments)                                                             \
    DECLARE(type, call, parameters)                                                                                    \
    type __wrap_##call parameters {                                                                                    \
        const cl_int refusal = cl_fault_answer(#call);                                                                 \
        if (refusal) {                                                                                                 \
            *code = refusal;                                                                                           \
            return NULL;                                                                                               \
        }                                                                                                              \
        const type made = __real_##call arguments;                                                                     \
        cl_fault.live.kind += made != NULL;                                                                            \
        return made;                                                                                                   \
    }

#define WRAP_RELEASE(type, kind, call)                                                                                 \
    DECLARE(cl_int, call, (type object))                                                                               \
    cl_int __wrap_##call(type object) {                                                                                \
        cl_fault.live.kind--;                                                                                          \
        return __real_##call(object);                                                                                  \
    }

typedef void *cl_memory;
typedef void (*cl_told)(const char *, const void *, size_t, void *);
typedef void (*cl_built)(cl_program, void *);

WRAP(clGetPlatformIDs, (cl_uint room, cl_platform_id *ids, cl_uint *count), (room, ids, count))
WRAP(clGetPlatformInfo, (cl_platform_id id, cl_platform_info what, size_t room, void *value, size_t *size),
     (id, what, room, value, size))
WRAP(clGetDeviceIDs, (cl_platform_id id, cl_device_type type, cl_uint room, cl_device_id *ids, cl_uint *count),
     (id, type, room, ids, count))
WRAP(clSetKernelArg, (cl_kernel kernel, cl_uint index, size_t size, const void *value), (kernel, index, size, value))
WRAP(clGetProgramInfo, (cl_program program, cl_program_info what, size_t room, void *value, size_t *size),
     (program, what, room, value, size))
WRAP(clGetEventProfilingInfo, (cl_event event, cl_profiling_info what, size_t room, void *value, size_t *size),
     (event, what, room, value, size))
WRAP(clEnqueueReadBuffer,
     (cl_command_queue queue, cl_mem mem, cl_bool wait, size_t at, size_t size, void *bytes, cl_uint n,
      const cl_event *events, cl_event *event),
     (queue, mem, wait, at, size, bytes, n, events, event))
WRAP(clEnqueueWriteBuffer,
     (cl_command_queue queue, cl_mem mem, cl_bool wait, size_t at, size_t size, const void *bytes, cl_uint n,
      const cl_event *events, cl_event *event),
     (queue, mem, wait, at, size, bytes, n, events, event))
WRAP(clEnqueueFillBuffer,
     (cl_command_queue queue, cl_mem mem, const void *pattern, size_t width, size_t at, size_t size, cl_uint n,
      const cl_event *events, cl_event *event),
     (queue, mem, pattern, width, at, size, n, events, event))

WRAP_MAKE(cl_context, contexts, clCreateContext,
          (const cl_context_properties *properties, cl_uint count, const cl_device_id *ids, cl_told told, void *user,
           cl_int *code),
          (properties, count, ids, told, user, code))
WRAP_MAKE(cl_command_queue, queues, clCreateCommandQueue,
          (cl_context context, cl_device_id id, cl_command_queue_properties properties, cl_int *code),
          (context, id, properties, code))
WRAP_MAKE(cl_program, programs, clCreateProgramWithSource,
          (cl_context context, cl_uint count, const char **texts, const size_t *sizes, cl_int *code),
          (context, count, texts, sizes, code))
WRAP_MAKE(cl_program, programs, clCreateProgramWithBinary,
          (cl_context context, cl_uint count, const cl_device_id *ids, const size_t *sizes,
           const unsigned char **binaries, cl_int *codes, cl_int *code),
          (context, count, ids, sizes, binaries, codes, code))
WRAP_MAKE(cl_kernel, kernels, clCreateKernel, (cl_program program, const char *name, cl_int *code),
          (program, name, code))
WRAP_MAKE(cl_memory, maps, clEnqueueMapBuffer,
          (cl_command_queue queue, cl_mem mem, cl_bool wait, cl_map_flags flags, size_t at, size_t size, cl_uint n,
           const cl_event *events, cl_event *event, cl_int *code),
          (queue, mem, wait, flags, at, size, n, events, event, code))
WRAP_RELEASE(cl_context, contexts, clReleaseContext)
WRAP_RELEASE(cl_command_queue, queues, clReleaseCommandQueue)
WRAP_RELEASE(cl_program, programs, clReleaseProgram)
WRAP_RELEASE(cl_kernel, kernels, clReleaseKernel)
WRAP_RELEASE(cl_mem, mems, clReleaseMemObject)
WRAP_RELEASE(cl_event, events, clReleaseEvent)

/* ---- Those with a mind of their own ---- */

/* A queue that is refused still comes to its end: as that of a lost device, it leaves the host's memory alone. */
DECLARE(cl_int, clFinish, (cl_command_queue queue))
cl_int __wrap_clFinish(cl_command_queue queue) {
    const cl_int refusal = cl_fault_answer("clFinish"), code = __real_clFinish(queue);
    return refusal ? refusal : code;
}

DECLARE(cl_mem, clCreateBuffer, (cl_context context, cl_mem_flags flags, size_t size, void *memory, cl_int *code))
cl_mem __wrap_clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void *memory, cl_int *code) {
    *code = cl_fault_answer("clCreateBuffer");
    if (*code == CL_SUCCESS && cl_fault.largest_bytes && size > cl_fault.largest_bytes)
        *code = CL_INVALID_BUFFER_SIZE;
    if (*code != CL_SUCCESS)
        return NULL;
    const cl_mem made = __real_clCreateBuffer(context, flags, size, memory, code);
    cl_fault.live.mems += made != NULL;
    return made;
}

DECLARE(cl_int, clGetDeviceInfo, (cl_device_id id, cl_device_info what, size_t room, void *value, size_t *size))
cl_int __wrap_clGetDeviceInfo(cl_device_id id, cl_device_info what, size_t room, void *value, size_t *size) {
    const bool optional = what == CL_DEVICE_EXTENSIONS || what == CL_DEVICE_HOST_UNIFIED_MEMORY;
    const cl_int refusal = cl_fault_answer(optional ? "clGetDeviceInfo, optional" : "clGetDeviceInfo");
    if (refusal)
        return refusal;
    const cl_int code = __real_clGetDeviceInfo(id, what, room, value, size);
    if (what == CL_DEVICE_MAX_MEM_ALLOC_SIZE && cl_fault.largest_bytes && value)
        memcpy(value, &cl_fault.largest_bytes, sizeof cl_fault.largest_bytes);
    return code;
}

DECLARE(cl_int, clBuildProgram,
        (cl_program program, cl_uint count, const cl_device_id *ids, const char *options, cl_built built, void *user))
cl_int __wrap_clBuildProgram(cl_program program, cl_uint count, const cl_device_id *ids, const char *options,
                             cl_built built, void *user) {
    const cl_int refusal = cl_fault_answer("clBuildProgram");
    if (refusal || cl_fault.build_log)
        return refusal ? refusal : CL_BUILD_PROGRAM_FAILURE;
    return __real_clBuildProgram(program, count, ids, options, built, user);
}

DECLARE(cl_int, clGetProgramBuildInfo,
        (cl_program program, cl_device_id id, cl_program_build_info what, size_t room, void *value, size_t *size))
cl_int __wrap_clGetProgramBuildInfo(cl_program program, cl_device_id id, cl_program_build_info what, size_t room,
                                    void *value, size_t *size) {
    const cl_int refusal = cl_fault_answer("clGetProgramBuildInfo");
    if (refusal || !cl_fault.build_log || what != CL_PROGRAM_BUILD_LOG)
        return refusal ? refusal : __real_clGetProgramBuildInfo(program, id, what, room, value, size);
    const size_t length = strlen(cl_fault.build_log) + 1;
    if (size)
        *size = length;
    if (value)
        memcpy(value, cl_fault.build_log, room < length ? room : length);
    return CL_SUCCESS;
}

DECLARE(cl_int, clEnqueueNDRangeKernel,
        (cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t *offset, const size_t *global,
         const size_t *local, cl_uint n, const cl_event *events, cl_event *event))
cl_int __wrap_clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t *offset,
                                     const size_t *global, const size_t *local, cl_uint n, const cl_event *events,
                                     cl_event *event) {
    const cl_int refusal = cl_fault_answer("clEnqueueNDRangeKernel");
    if (refusal)
        return refusal;
    const cl_int code =
        __real_clEnqueueNDRangeKernel(queue, kernel, dimensions, offset, global, local, n, events, event);
    cl_fault.live.events += code == CL_SUCCESS && event;
    return code;
}

/* Never refused: it ends what a map began. */
DECLARE(cl_int, clEnqueueUnmapMemObject,
        (cl_command_queue queue, cl_mem mem, void *bytes, cl_uint n, const cl_event *events, cl_event *event))
cl_int __wrap_clEnqueueUnmapMemObject(cl_command_queue queue, cl_mem mem, void *bytes, cl_uint n,
                                      const cl_event *events, cl_event *event) {
    cl_fault.live.maps--;
    return __real_clEnqueueUnmapMemObject(queue, mem, bytes, n, events, event);
}

#undef DECLARE
#undef WRAP
#undef WRAP_MAKE
#undef WRAP_RELEASE

#endif
