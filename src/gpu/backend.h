/* A back end provides a table of functions, and handles that only it can interpret. opencl/ and
 * cpu/ are back ends. To add another, make another folder and add a line to the list in find.c. Only files in gpu/
 * include this header. */
#ifndef CAMBER_GPU_BACKEND_H
#define CAMBER_GPU_BACKEND_H

#include "gpu/buffer.h"
#include "gpu/launch.h"
#include "gpu/program.h"

/* A device that a back end has found, with the handles that it needs to open it. */
typedef struct camber_found_device {
    const struct camber_gpu_backend *backend;
    void *platform, *id;
    camber_device_info info;
} camber_found_device;

/* A call that failed during the search for devices: the reason to give if none is found. */
typedef struct camber_failed_call {
    const struct camber_gpu_backend *backend;
    const char *name; /* NULL: none failed */
    int code;
    const char *cure; /* what a back end lacks to find devices, and what to install; NULL: nothing */
} camber_failed_call;

struct camber_buffer {
    void *native;
    size_t counted_bytes; /* bytes that are counted in the run's budget */
};

/* Functions that return a status log why they failed. */
typedef struct camber_gpu_backend {
    bool has_drivers;   /* its drivers have to be loaded and set up before they find a device */
    bool counts_memory; /* buffers are made by the context's allocator, which counts them in the run's budget */
    /* Fails if the drivers would end the process when they are first called. NULL if there are none. */
    camber_status (*check_process)(camber_context *context);
    /* Finds devices, up to capacity, and returns how many. Sets *failed to the last call that failed, if any did. Warns
     * if the environment asks for a device that is not here. */
    size_t (*find)(camber_context *context, camber_found_device *found, size_t capacity, camber_failed_call *failed);
    /* Logs a call that failed during the search, and returns the status for its error code. */
    camber_status (*fail)(camber_context *context, const camber_failed_call *failed);
    /* Sets device->native and the fields that only the back end knows: rounds_correctly, host_memory, gl_context, and
     * lanes if they are 0; also info.compute_units, if the desc's threads decide it. close is called even if this
     * failed. */
    camber_status (*open)(camber_device *device, const camber_found_device *found, const camber_device_desc *desc);
    void (*close)(camber_device *device);
    /* These two fail without a message unless is_told. */
    camber_status (*finish)(const camber_device *device, bool is_told);
    camber_status (*unmap)(const camber_device *device, void *native, void *bytes, bool is_told);

    camber_status (*make_buffer)(const camber_device *device, camber_buffer_kind kind, size_t size_bytes,
                                 const void *bytes, void **native);
    /* NULL if no device of the back end shares buffers with GL (device->gl_context). */
    camber_status (*make_gl_buffer)(const camber_device *device, unsigned gl_name, void **native);
    void (*release_buffer)(void *native);
    camber_status (*write)(const camber_device *device, void *native, const camber_byte_range *range, const void *bytes,
                           bool waits);
    camber_status (*read)(const camber_device *device, void *native, size_t size_bytes, void *bytes);
    camber_status (*map)(const camber_device *device, void *native, camber_map_access access, size_t size_bytes,
                         void **bytes);
    /* NULL as make_gl_buffer. */
    camber_status (*acquire_gl)(const camber_device *device, void *const *natives, size_t count);
    camber_status (*release_gl)(const camber_device *device, void *const *natives, size_t count);

    /* Sets program->native, built and kept. release_program is called even if this failed. */
    camber_status (*make_program)(camber_device *device, const camber_program_source *from, camber_program *program);
    void (*release_program)(void *native);
    camber_status (*make_kernel)(const camber_device *device, void *program, const char *name, camber_kernel **kernel);
    void (*release_kernel)(camber_kernel *kernel);
    camber_status (*launch)(const camber_device *device, const camber_launch *launch, camber_event **event);
    camber_status (*wait)(const camber_device *device, camber_event *event, const char *name);
    double (*end_event)(camber_event *event); /* returns how long its command ran, in ms, and releases the event */
} camber_gpu_backend;

extern const camber_gpu_backend camber_opencl, camber_cpu;

enum { CAMBER_DEVICES_MAX = 64 };
typedef struct camber_found_devices {
    camber_found_device list[CAMBER_DEVICES_MAX];
    size_t count;
    camber_failed_call failed; /* the last call that failed, if any did */
} camber_found_devices;

/* find.c: finds the devices for a desc; NULL: all. Drivers are not asked if the processor itself is what the desc
 * wants. Fails in a forked child. Also if drivers, when first called, would end the process or not fit into its memory,
 * unless the desc can have the processor. */
camber_status camber_find_devices(camber_context *context, const camber_device_desc *desc, camber_found_devices *found);
/* Returns whether match, as in camber_device_desc, names the device. */
bool camber_device_matches(const camber_device_info *info, const char *match);

#endif
