/* Buffers on a device. Buffers in the host's memory count against the run's memory budget. */
#ifndef CAMBER_GPU_BUFFER_H
#define CAMBER_GPU_BUFFER_H

#include "gpu/device.h"

typedef struct camber_buffer camber_buffer;

/* Where a buffer's memory and its first bytes come from. */
typedef enum camber_buffer_kind {
    CAMBER_BUFFER_OWN,       /* memory of its own; its contents are undefined */
    CAMBER_BUFFER_READ_BACK, /* the same, but the host will read it often */
    CAMBER_BUFFER_COPY,      /* a copy of the host's bytes, which kernels only read */
    /* The host's memory itself (zero copy), which must live as long as the buffer. Kernels only read it, or write it.
     */
    CAMBER_BUFFER_BORROWED,
    CAMBER_BUFFER_BORROWED_TO_WRITE,
} camber_buffer_kind;

/* A range of bytes in a buffer. */
typedef struct camber_byte_range {
    size_t offset_bytes, size_bytes;
} camber_byte_range;

/* Each function that returns a status logs why it failed. bytes: NULL for kinds of buffers that are not made from the
 * host's bytes. *buffer is unchanged on failure. */
camber_status camber_buffer_create(const camber_device *device, camber_buffer_kind kind, size_t size_bytes,
                                   const void *bytes, camber_buffer **buffer);
/* Makes a device buffer from a GL buffer. The device must have been opened for the GL context. Kernels may use it
 * between camber_buffers_acquire and camber_buffers_give_back. */
camber_status camber_buffer_create_of_gl(const camber_device *device, unsigned gl_name, camber_buffer **buffer);
/* Releases *buffer, which may be NULL, and sets it to NULL. */
void camber_buffer_release(const camber_device *device, camber_buffer **buffer);

camber_status camber_buffer_write(const camber_device *device, camber_buffer *buffer, size_t offset_bytes,
                                  size_t size_bytes, const void *bytes);
/* The same without waiting for the device, because waiting takes longer than a short write: the bytes must stay valid
 * until the caller has waited for the device. */
camber_status camber_buffer_write_later(const camber_device *device, camber_buffer *buffer, size_t offset_bytes,
                                        size_t size_bytes, const void *bytes);
/* Waits for the device, and reads the buffer's first bytes; reads none if size_bytes is 0. */
camber_status camber_buffer_read(const camber_device *device, camber_buffer *buffer, size_t size_bytes, void *bytes);

typedef enum camber_map_access { CAMBER_MAP_READ, CAMBER_MAP_READ_WRITE } camber_map_access;

/* Waits for the device, and maps the buffer's first bytes into host memory until they are unmapped. bytes is the
 * address of a pointer of any type. */
camber_status camber_buffer_map(const camber_device *device, camber_buffer *buffer, camber_map_access access,
                                size_t size_bytes, void *bytes);
/* Unmaps memory that was only read; bytes may be NULL. */
void camber_buffer_unmap(const camber_device *device, camber_buffer *buffer, const void *bytes);
/* Unmaps memory that was written: kernels then see what the host wrote. */
camber_status camber_buffer_unmap_written(const camber_device *device, camber_buffer *buffer, void *bytes);

enum { CAMBER_GL_BUFFERS_MAX = 2 };

/* Takes buffers from GL, at most CAMBER_GL_BUFFERS_MAX and all at once, or gives them back. */
camber_status camber_buffers_acquire(const camber_device *device, camber_buffer *const *buffers, size_t count);
camber_status camber_buffers_give_back(const camber_device *device, camber_buffer *const *buffers, size_t count);

#endif
