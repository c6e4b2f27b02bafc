/* Chooses a sharing path by trying it. */
#include "gl/share.h"

#include <stdio.h>

const char *camber_sharing_get_name(camber_sharing sharing) {
    switch (sharing) {
    case CAMBER_SHARING_AUTO: return "auto";
    case CAMBER_SHARING_GL: return "cl_khr_gl_sharing";
    case CAMBER_SHARING_ZERO_COPY: return "zero copy";
    case CAMBER_SHARING_COPY: return "copy";
    }
    return "unknown";
}

void camber_share_release(void *user, camber_shared_buffer *output) {
    const camber_share *share = user;
    camber_buffer_release(share->device, &output->buffer);
    if (output->gl_name)
        share->surface->gl.DeleteBuffers(1, &output->gl_name);
    *output = (camber_shared_buffer){0};
}

void camber_share_await(camber_share *share, const camber_shared_buffer *outputs, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (outputs[i].drawn_frame > share->frames_done) {
            share->surface->gl.Finish();
            share->frames_done = share->frames_begun;
        }
}

enum { PROBE_BYTES = 4096 };

/* Whether GL reads this word from a buffer. GL copies the buffer first, because a mapping of the buffer itself may be
 * the same memory that OpenCL wrote. */
static bool gl_sees(const camber_gl *gl, GLuint buffer, uint32_t word) {
    GLuint copy = 0;
    gl->GenBuffers(1, &copy);
    gl->BindBuffer(GL_COPY_READ_BUFFER, buffer);
    gl->BindBuffer(GL_COPY_WRITE_BUFFER, copy);
    gl->BufferData(GL_COPY_WRITE_BUFFER, PROBE_BYTES, NULL, GL_STREAM_READ);
    gl->CopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, PROBE_BYTES);
    const uint32_t *seen = gl->MapBufferRange(GL_COPY_WRITE_BUFFER, 0, PROBE_BYTES, GL_MAP_READ_BIT);
    const bool same = seen && seen[0] == word && seen[PROBE_BYTES / 4 - 1] == word;
    if (seen)
        gl->UnmapBuffer(GL_COPY_WRITE_BUFFER);
    gl->BindBuffer(GL_COPY_WRITE_BUFFER, 0);
    gl->BindBuffer(GL_COPY_READ_BUFFER, 0);
    gl->DeleteBuffers(1, &copy);
    return same;
}

/* Writes words from the device, and reads them with GL. */
static camber_status try_path(camber_share *share, const camber_share_path *path) {
    const camber_device *device = share->device;
    const uint32_t word = 0x63616d62u;
    uint32_t words[PROBE_BYTES / 4];
    camber_shared_buffer output = {0};
    if (!path->is_possible(share))
        return CAMBER_ERROR_DEVICE;
    camber_status status = path->ops.reserve(share, &output, PROBE_BYTES);
    output.used_bytes = PROBE_BYTES;
    if (status == CAMBER_OK)
        status = path->ops.begin(share, &output, 1);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        words[i] = word;
    if (status == CAMBER_OK) {
        camber_status written = camber_buffer_write(device, output.buffer, 0, PROBE_BYTES, words);
        if (written == CAMBER_OK)
            written = camber_device_finish(device);
        status = path->ops.finish(share, &output, 1, true);
        const bool same =
            written == CAMBER_OK && status == CAMBER_OK && gl_sees(&share->surface->gl, output.gl_name, word);
        if (status == CAMBER_OK)
            status = camber_share_check(share, PROBE_BYTES);
        if (status == CAMBER_OK && !same)
            status = CAMBER_ERROR_DEVICE;
    }
    path->ops.release(share, &output);
    camber_surface_forget_errors(share->surface);
    return status;
}

camber_status camber_share_check(const camber_share *share, size_t size_bytes) {
    char what[64];
    snprintf(what, sizeof what, "a GL buffer of %zu bytes", size_bytes);
    return camber_surface_check(share->surface, what);
}

camber_status camber_share_choose(camber_share *share, camber_sharing wanted, const camber_share_path **path) {
    static const camber_share_path *const paths[] = {&camber_share_gl, &camber_share_zero_copy, &camber_share_copy};
    camber_context *context = share->device->context;
    camber_status status = CAMBER_ERROR_DEVICE;
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        if (wanted != CAMBER_SHARING_AUTO && wanted != paths[i]->sharing)
            continue;
        camber_saved_log kept;
        camber_log_demote_errors(context, &kept); /* one log line per path that does not work is enough */
        status = try_path(share, paths[i]);
        camber_log_restore(context, &kept);
        if (status == CAMBER_OK) {
            *path = paths[i];
            return CAMBER_OK;
        }
    }
    if (share->surface->lost)
        return camber_surface_make_current(share->surface);
    return camber_fail(context, status, "sharing '%s' does not work between %s and %s%s; use %s",
                       camber_sharing_get_name(wanted), share->device->info.name, share->surface->info.renderer,
                       status == CAMBER_ERROR_MEMORY ? ": out of memory" : "",
                       wanted == CAMBER_SHARING_AUTO ? "another device or back end" : "auto");
}
