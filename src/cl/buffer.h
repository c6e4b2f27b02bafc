/* OpenCL buffers: counted against the run's budget, and those whose contents GL may read. */
#ifndef CAMBER_CL_BUFFER_H
#define CAMBER_CL_BUFFER_H

#include "cl/device.h"

/* OpenCL calls that log. camber_make_buffer leaves *mem alone on failure. */
camber_status camber_make_buffer(const camber_device *device, cl_mem_flags flags, size_t size_bytes,
                                 const void *host_bytes, cl_mem *mem);
/* Leaves NULL. */
void camber_release_buffer(const camber_device *device, cl_mem *mem);
camber_status camber_write_buffer(const camber_device *device, cl_mem mem, size_t offset_bytes, size_t size_bytes,
                                  const void *bytes);

/* A buffer that kernels write and GL may read; src/gl/share_*.c has the ways for that. */
typedef struct camber_buffer {
    cl_mem mem;
    size_t capacity_bytes;
    unsigned gl_name; /* 0: OpenCL memory only */
    void *map;        /* zero copy: the persistent map */
    size_t used_bytes;
    uint64_t drawn_frame; /* the last frame that reads it, by its number */
} camber_buffer;

typedef struct camber_buffer_ops {
    /* Makes room for at least size_bytes; what the buffer held is lost. */
    camber_status (*reserve)(void *user, camber_buffer *buffer, size_t size_bytes);
    /* Around OpenCL commands on the buffers. At finish the queue has been finished; written: what the buffers hold
     * has changed. */
    camber_status (*begin)(void *user, camber_buffer *buffers, size_t count);
    camber_status (*finish)(void *user, camber_buffer *buffers, size_t count, bool written);
    void (*release)(void *user, camber_buffer *buffer);
} camber_buffer_ops;

/* Buffers in OpenCL's memory alone, for what GL does not draw. Their user is the device. */
extern const camber_buffer_ops camber_buffer_plain;

#endif
