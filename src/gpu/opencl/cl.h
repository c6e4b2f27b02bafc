/* OpenCL as camber calls it: the types, values and functions of OpenCL 1.2 that it uses, and a table of the functions,
 * which load.c fills from the library that is here. So a build needs nothing of OpenCL. The values and signatures are
 * OpenCL's own (tests/lint/declarations.py compares them with Khronos' headers). */
#ifndef CAMBER_GPU_OPENCL_CL_H
#define CAMBER_GPU_OPENCL_CL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef int32_t cl_int;
typedef uint32_t cl_uint;
typedef uint64_t cl_ulong;
typedef cl_uint cl_bool;
typedef cl_ulong cl_bitfield;
typedef cl_bitfield cl_device_type;
typedef cl_bitfield cl_device_fp_config;
typedef cl_bitfield cl_command_queue_properties;
typedef cl_bitfield cl_mem_flags;
typedef cl_bitfield cl_map_flags;
typedef cl_uint cl_platform_info;
typedef cl_uint cl_device_info;
typedef cl_uint cl_program_info;
typedef cl_uint cl_program_build_info;
typedef cl_uint cl_profiling_info;
typedef intptr_t cl_context_properties;

/* Handles. */
typedef struct _cl_platform_id *cl_platform_id;
typedef struct _cl_device_id *cl_device_id;
typedef struct _cl_context *cl_context;
typedef struct _cl_command_queue *cl_command_queue;
typedef struct _cl_mem *cl_mem;
typedef struct _cl_program *cl_program;
typedef struct _cl_kernel *cl_kernel;
typedef struct _cl_event *cl_event;

/* Functions that the driver calls. */
typedef void (*camber_cl_told)(const char *, const void *, size_t, void *);
typedef void (*camber_cl_built)(cl_program, void *);

#define CL_BUILD_PROGRAM_FAILURE (-11)
#define CL_COMPILER_NOT_AVAILABLE (-3)
#define CL_CONTEXT_PLATFORM 0x1084
#define CL_DEVICE_EXTENSIONS 0x1030
#define CL_DEVICE_GLOBAL_MEM_SIZE 0x101F
#define CL_DEVICE_HOST_UNIFIED_MEMORY 0x1035
#define CL_DEVICE_MAX_COMPUTE_UNITS 0x1002
#define CL_DEVICE_MAX_MEM_ALLOC_SIZE 0x1010
#define CL_DEVICE_NAME 0x102B
#define CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT 0x103A
#define CL_DEVICE_NOT_AVAILABLE (-2)
#define CL_DEVICE_NOT_FOUND (-1)
#define CL_DEVICE_SINGLE_FP_CONFIG 0x101B
#define CL_DEVICE_TYPE 0x1000
#define CL_DEVICE_TYPE_ALL 0xFFFFFFFF
#define CL_DEVICE_TYPE_CPU (1 << 1)
#define CL_DEVICE_TYPE_GPU (1 << 2)
#define CL_DEVICE_VERSION 0x102F
#define CL_DRIVER_VERSION 0x102D
#define CL_EGL_DISPLAY_KHR 0x2009
#define CL_FALSE 0
#define CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT (1 << 7)
#define CL_GLX_DISPLAY_KHR 0x200A
#define CL_GL_CONTEXT_KHR 0x2008
#define CL_INVALID_BINARY (-42)
#define CL_INVALID_BUFFER_SIZE (-61)
#define CL_INVALID_VALUE (-30)
#define CL_INVALID_WORK_GROUP_SIZE (-54)
#define CL_MAP_READ (1 << 0)
#define CL_MAP_WRITE (1 << 1)
#define CL_MEM_ALLOC_HOST_PTR (1 << 4)
#define CL_MEM_COPY_HOST_PTR (1 << 5)
#define CL_MEM_OBJECT_ALLOCATION_FAILURE (-4)
#define CL_MEM_READ_ONLY (1 << 2)
#define CL_MEM_READ_WRITE (1 << 0)
#define CL_MEM_USE_HOST_PTR (1 << 3)
#define CL_OUT_OF_HOST_MEMORY (-6)
#define CL_OUT_OF_RESOURCES (-5)
#define CL_PLATFORM_NAME 0x0902
#define CL_PROFILING_COMMAND_END 0x1283
#define CL_PROFILING_COMMAND_START 0x1282
#define CL_PROGRAM_BINARIES 0x1166
#define CL_PROGRAM_BINARY_SIZES 0x1165
#define CL_PROGRAM_BUILD_LOG 0x1183
#define CL_QUEUE_PROFILING_ENABLE (1 << 1)
#define CL_SUCCESS 0
#define CL_TRUE 1

#define CAMBER_CL_FUNCTIONS(X)                                                                                         \
    X(cl_int, GetPlatformIDs, (cl_uint, cl_platform_id *, cl_uint *))                                                  \
    X(cl_int, GetPlatformInfo, (cl_platform_id, cl_platform_info, size_t, void *, size_t *))                           \
    X(cl_int, GetDeviceIDs, (cl_platform_id, cl_device_type, cl_uint, cl_device_id *, cl_uint *))                      \
    X(cl_int, GetDeviceInfo, (cl_device_id, cl_device_info, size_t, void *, size_t *))                                 \
    X(cl_context, CreateContext,                                                                                       \
      (const cl_context_properties *, cl_uint, const cl_device_id *, camber_cl_told, void *, cl_int *))                \
    X(cl_int, ReleaseContext, (cl_context))                                                                            \
    X(cl_command_queue, CreateCommandQueue, (cl_context, cl_device_id, cl_command_queue_properties, cl_int *))         \
    X(cl_int, ReleaseCommandQueue, (cl_command_queue))                                                                 \
    X(cl_int, Finish, (cl_command_queue))                                                                              \
    X(cl_program, CreateProgramWithSource, (cl_context, cl_uint, const char **, const size_t *, cl_int *))             \
    X(cl_program, CreateProgramWithBinary,                                                                             \
      (cl_context, cl_uint, const cl_device_id *, const size_t *, const unsigned char **, cl_int *, cl_int *))         \
    X(cl_int, BuildProgram, (cl_program, cl_uint, const cl_device_id *, const char *, camber_cl_built, void *))        \
    X(cl_int, GetProgramInfo, (cl_program, cl_program_info, size_t, void *, size_t *))                                 \
    X(cl_int, GetProgramBuildInfo, (cl_program, cl_device_id, cl_program_build_info, size_t, void *, size_t *))        \
    X(cl_int, ReleaseProgram, (cl_program))                                                                            \
    X(cl_kernel, CreateKernel, (cl_program, const char *, cl_int *))                                                   \
    X(cl_int, SetKernelArg, (cl_kernel, cl_uint, size_t, const void *))                                                \
    X(cl_int, ReleaseKernel, (cl_kernel))                                                                              \
    X(cl_mem, CreateBuffer, (cl_context, cl_mem_flags, size_t, void *, cl_int *))                                      \
    X(cl_int, ReleaseMemObject, (cl_mem))                                                                              \
    X(cl_int, EnqueueReadBuffer,                                                                                       \
      (cl_command_queue, cl_mem, cl_bool, size_t, size_t, void *, cl_uint, const cl_event *, cl_event *))              \
    X(cl_int, EnqueueWriteBuffer,                                                                                      \
      (cl_command_queue, cl_mem, cl_bool, size_t, size_t, const void *, cl_uint, const cl_event *, cl_event *))        \
    X(cl_int, EnqueueCopyBuffer,                                                                                       \
      (cl_command_queue, cl_mem, cl_mem, size_t, size_t, size_t, cl_uint, const cl_event *, cl_event *))               \
    X(void *, EnqueueMapBuffer,                                                                                        \
      (cl_command_queue, cl_mem, cl_bool, cl_map_flags, size_t, size_t, cl_uint, const cl_event *, cl_event *,         \
       cl_int *))                                                                                                      \
    X(cl_int, EnqueueUnmapMemObject, (cl_command_queue, cl_mem, void *, cl_uint, const cl_event *, cl_event *))        \
    X(cl_int, EnqueueNDRangeKernel,                                                                                    \
      (cl_command_queue, cl_kernel, cl_uint, const size_t *, const size_t *, const size_t *, cl_uint,                  \
       const cl_event *, cl_event *))                                                                                  \
    X(cl_int, WaitForEvents, (cl_uint, const cl_event *))                                                              \
    X(cl_int, GetEventProfilingInfo, (cl_event, cl_profiling_info, size_t, void *, size_t *))                          \
    X(cl_int, ReleaseEvent, (cl_event))

/* For buffers that OpenCL and GL share; a library may lack them. */
#define CAMBER_CL_GL_FUNCTIONS(X)                                                                                      \
    X(cl_mem, CreateFromGLBuffer, (cl_context, cl_mem_flags, cl_uint, cl_int *))                                       \
    X(cl_int, EnqueueAcquireGLObjects,                                                                                 \
      (cl_command_queue, cl_uint, const cl_mem *, cl_uint, const cl_event *, cl_event *))                              \
    X(cl_int, EnqueueReleaseGLObjects,                                                                                 \
      (cl_command_queue, cl_uint, const cl_mem *, cl_uint, const cl_event *, cl_event *))

/* OpenCL's functions, without their prefix. */
typedef struct camber_cl_table {
#define CAMBER_CL_MEMBER(result, name, parameters) result(*name) parameters;
    CAMBER_CL_FUNCTIONS(CAMBER_CL_MEMBER)
    CAMBER_CL_GL_FUNCTIONS(CAMBER_CL_MEMBER)
#undef CAMBER_CL_MEMBER
    bool shares_gl; /* the library has the functions of CAMBER_CL_GL_FUNCTIONS */
} camber_cl_table;

/* One for the process, because its OpenCL is; camber_cl_load fills it. */
extern camber_cl_table camber_cl;

/* Loads the library, if that has not been done. Returns NULL, or what is missing and what to install. find.c calls it,
 * under its lock, before any other use of OpenCL. */
const char *camber_cl_load(void);

#endif
