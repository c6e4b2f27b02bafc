/* OpenCL buffers. Those in the host's memory count against the run's memory budget. GL may read output buffers. */
#ifndef CAMBER_CL_BUFFER_H
#define CAMBER_CL_BUFFER_H

#include "cl/device.h"

/* OpenCL calls that log why they failed. camber_make_buffer leaves *mem alone on failure. */
camber_status camber_make_buffer(const camber_device *device, cl_mem_flags flags, size_t size_bytes,
                                 const void *host_bytes, cl_mem *mem);
/* Releases *mem, which may be NULL, and sets it to NULL. */
void camber_release_buffer(const camber_device *device, cl_mem *mem);
camber_status camber_write_buffer(const camber_device *device, cl_mem mem, size_t offset_bytes, size_t size_bytes,
                                  const void *bytes);
/* The same without a wait, which takes longer than a short write: the bytes must stay until the queue has been waited
 * for. */
camber_status camber_write_buffer_later(const camber_device *device, cl_mem mem, size_t offset_bytes, size_t size_bytes,
                                        const void *bytes);

/* An output buffer: kernels write it, and GL may read it. src/gl/share_*.c has the ways to share it. */
typedef struct camber_buffer {
    cl_mem mem;
    size_t capacity_bytes;
    unsigned gl_name; /* 0: no GL buffer, the memory is OpenCL's alone */
    void *map;        /* where GL and OpenCL share memory without a copy: GL's persistent map */
    size_t used_bytes;
    uint64_t drawn_frame; /* number of the last frame that reads it */
} camber_buffer;

/* How output buffers are made and shared, one table a way of sharing. user is whatever the table's owner passes. */
typedef struct camber_buffer_ops {
    /* Makes the buffer hold at least size_bytes. Its contents are lost. */
    camber_status (*reserve)(void *user, camber_buffer *buffer, size_t size_bytes);
    /* begin and finish enclose OpenCL commands on the buffers. The queue has been finished when finish is called;
     * written tells that the commands have changed what the buffers hold. */
    camber_status (*begin)(void *user, camber_buffer *buffers, size_t count);
    camber_status (*finish)(void *user, camber_buffer *buffers, size_t count, bool written);
    void (*release)(void *user, camber_buffer *buffer);
} camber_buffer_ops;

/* Buffers in OpenCL's memory alone, for meshes that GL does not draw. Their user is the device. */
extern const camber_buffer_ops camber_buffer_plain;

#endif
