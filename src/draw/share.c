/* Choosing a sharing path by trying it. */
#include "draw/share.h"

const char *camber_sharing_name(camber_sharing sharing) {
    switch (sharing) {
    case CAMBER_SHARING_AUTO: return "auto";
    case CAMBER_SHARING_GL: return "cl_khr_gl_sharing";
    case CAMBER_SHARING_ZERO_COPY: return "zero copy";
    case CAMBER_SHARING_COPY: return "copy";
    }
    return "unknown";
}

void camber_share_release(void *user, camber_buffer *buffer) {
    const camber_share *share = user;
    if (buffer->mem)
        clReleaseMemObject(buffer->mem);
    if (buffer->gl_name)
        share->surface->gl.DeleteBuffers(1, &buffer->gl_name);
    *buffer = (camber_buffer){0};
}

enum { PROBE_BYTES = 4096 };

/* What GL reads from a buffer: a copy of it that GL makes, since a map may be the very memory that OpenCL wrote. */
static bool gl_sees(const camber_gl *gl, GLuint buffer, cl_uint word) {
    GLuint copy = 0;
    gl->GenBuffers(1, &copy);
    gl->BindBuffer(GL_COPY_READ_BUFFER, buffer);
    gl->BindBuffer(GL_COPY_WRITE_BUFFER, copy);
    gl->BufferData(GL_COPY_WRITE_BUFFER, PROBE_BYTES, NULL, GL_STREAM_READ);
    gl->CopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, PROBE_BYTES);
    const cl_uint *seen = gl->MapBufferRange(GL_COPY_WRITE_BUFFER, 0, PROBE_BYTES, GL_MAP_READ_BIT);
    const bool same = seen && seen[0] == word && seen[PROBE_BYTES / 4 - 1] == word;
    if (seen)
        gl->UnmapBuffer(GL_COPY_WRITE_BUFFER);
    gl->BindBuffer(GL_COPY_WRITE_BUFFER, 0);
    gl->BindBuffer(GL_COPY_READ_BUFFER, 0);
    gl->DeleteBuffers(1, &copy);
    return same;
}

/* Writes a word with OpenCL and reads it with GL. */
static bool works(camber_share *share, const camber_share_path *path) {
    const cl_uint word = 0x63616d62u;
    const camber_gl *gl = &share->surface->gl;
    camber_buffer buffer = {0};
    bool same = false;
    if (!path->is_possible(share))
        return false;
    if (path->ops.reserve(share, &buffer, PROBE_BYTES) == CAMBER_OK) {
        buffer.used_bytes = PROBE_BYTES;
        if (path->ops.begin(share, &buffer, 1) == CAMBER_OK) {
            const cl_int code = clEnqueueFillBuffer(share->device->queue, buffer.mem, &word, sizeof word, 0,
                                                    PROBE_BYTES, 0, NULL, NULL);
            clFinish(share->device->queue);
            same = path->ops.finish(share, &buffer, 1, true) == CAMBER_OK && code == CL_SUCCESS;
        }
        same = same && gl_sees(gl, buffer.gl_name, word);
    }
    path->ops.release(share, &buffer);
    while (gl->GetError() != GL_NO_ERROR) {
    }
    return same;
}

camber_status camber_share_choose(camber_share *share, camber_sharing wanted, const camber_share_path **path) {
    static const camber_share_path *const paths[] = {&camber_share_gl, &camber_share_zero_copy, &camber_share_copy};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        if (wanted != CAMBER_SHARING_AUTO && wanted != paths[i]->sharing)
            continue;
        if (works(share, paths[i])) {
            *path = paths[i];
            return CAMBER_OK;
        }
    }
    return camber_fail(share->device->context, CAMBER_ERROR_DEVICE,
                       "sharing '%s' does not work between %s and %s; use auto", camber_sharing_name(wanted),
                       share->device->info.name, share->surface->info.renderer);
}
