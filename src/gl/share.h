/* How OpenCL's output reaches GL: one file per sharing path (share_gl.c, share_zero_copy.c, share_copy.c). */
#ifndef CAMBER_GL_SHARE_H
#define CAMBER_GL_SHARE_H

#include "gl/surface.h"

/* A device and a surface that share buffers: the user of camber_shared_buffer_ops. */
typedef struct camber_share {
    camber_device *device;
    camber_surface *surface;
    uint64_t frames_begun, frames_done; /* the numbers of the last frame that has begun, and of the last that is done */
} camber_share;

typedef struct camber_share_path {
    camber_sharing sharing;
    bool (*is_possible)(const camber_share *share);
    camber_shared_buffer_ops ops;
} camber_share_path;

extern const camber_share_path camber_share_gl;
extern const camber_share_path camber_share_zero_copy;
extern const camber_share_path camber_share_copy;

/* Frees an output buffer, for GL and for the device. */
void camber_share_release(void *user, camber_shared_buffer *output);

/* Waits for GL if a frame in flight reads one of the buffers. */
void camber_share_await(camber_share *share, const camber_shared_buffer *outputs, size_t count);

/* Returns as a status whether GL has reported an error for a buffer of this size. */
camber_status camber_share_check(const camber_share *share, size_t size_bytes);

/* Chooses a path, the first that works for AUTO, by writing a buffer through it. */
camber_status camber_share_choose(camber_share *share, camber_sharing wanted, const camber_share_path **path);

#endif
