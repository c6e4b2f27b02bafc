/* Buffers that kernels write and that GL may read. src/gl/share_*.c implements the sharing paths. */
#ifndef CAMBER_GPU_SHARED_BUFFER_H
#define CAMBER_GPU_SHARED_BUFFER_H

#include "gpu/buffer.h"

typedef struct camber_shared_buffer {
    camber_buffer *buffer;
    size_t capacity_bytes;
    unsigned gl_name; /* 0: not a GL buffer; only the device has the memory */
    void *map;        /* if GL and the device share memory without a copy: GL's persistent mapping */
    size_t used_bytes;
    uint64_t drawn_frame; /* number of the last frame that reads it */
} camber_shared_buffer;

/* How output buffers are made and shared: one table per sharing path. user is whatever the owner of the table passes.
 */
typedef struct camber_shared_buffer_ops {
    /* Makes the buffer hold at least size_bytes. Its contents are lost. */
    camber_status (*reserve)(void *user, camber_shared_buffer *output, size_t size_bytes);
    /* begin and finish enclose the device's commands on the buffers. The caller waits for the device before it calls
     * finish; written says whether the commands have changed the buffers' content. */
    camber_status (*begin)(void *user, camber_shared_buffer *outputs, size_t count);
    camber_status (*finish)(void *user, camber_shared_buffer *outputs, size_t count, bool written);
    void (*release)(void *user, camber_shared_buffer *output);
} camber_shared_buffer_ops;

/* Buffers only in the device's memory, for meshes that GL does not draw. user is the device. */
extern const camber_shared_buffer_ops camber_shared_buffer_plain;

#endif
