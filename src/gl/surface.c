/* Surfaces: chooses a back end, loads GL's functions, and reads the errors that GL reports. */
#include "gl/surface.h"

#include "camber_proof.h"

#include <string.h>

static bool has_extension(const camber_gl *gl, const char *name) {
    GLint count = 0;
    gl->GetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; i++) {
        const char *extension = (const char *)gl->GetStringi(GL_EXTENSIONS, (GLuint)i);
        if (extension && strcmp(extension, name) == 0)
            return true;
    }
    return false;
}

static bool is_software(const char *renderer) {
    return strstr(renderer, "llvmpipe") || strstr(renderer, "softpipe") || strstr(renderer, "SWR") ||
           strstr(renderer, "SwiftShader") || strstr(renderer, "Software");
}

/* A function, loaded under the first of its names whose extension exists; NULL if there is none. */
typedef struct optional_name {
    const char *extension, *function;
} optional_name;

static camber_function *load_optional(camber_surface *surface, const optional_name *names, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (has_extension(&surface->gl, names[i].extension))
            return surface->ops->load(surface, names[i].function);
    return NULL;
}

/* GLES has texture buffers since 3.2, and desktop GL, which OSMesa provides, since 3.1. */
static camber_function *load_texture_buffers(camber_surface *surface) {
    static const optional_name extensions[] = {{"GL_EXT_texture_buffer", "glTexBufferEXT"},
                                               {"GL_OES_texture_buffer", "glTexBufferOES"}};
    GLint major = 0, minor = 0;
    surface->gl.GetIntegerv(GL_MAJOR_VERSION, &major);
    surface->gl.GetIntegerv(GL_MINOR_VERSION, &minor);
    surface->es_3_2 = 10 * major + minor >= 32;
    if (surface->es_3_2)
        return surface->ops->load(surface, "glTexBuffer");
    return load_optional(surface, extensions, sizeof extensions / sizeof *extensions);
}

static camber_status load_gl(camber_surface *surface) {
    static const optional_name storage[] = {{"GL_EXT_buffer_storage", "glBufferStorageEXT"},
                                            {"GL_ARB_buffer_storage", "glBufferStorage"}};
    static const optional_name multi[] = {{"GL_EXT_multi_draw_arrays", "glMultiDrawArraysEXT"}};
    static const optional_name reset[] = {{"GL_EXT_robustness", "glGetGraphicsResetStatusEXT"},
                                          {"GL_ARB_robustness", "glGetGraphicsResetStatusARB"}};
    camber_gl *gl = &surface->gl;
    camber_function *function;
#define LOAD(result, call, parameters)                                                                                 \
    function = surface->ops->load(surface, "gl" #call);                                                                \
    if (!function)                                                                                                     \
        return camber_fail(surface->context, CAMBER_ERROR_DEVICE, "%s: gl" #call " is missing; update the GL driver",  \
                           surface->name);                                                                             \
    memcpy(&gl->call, &function, sizeof function);
    CAMBER_GL_FUNCTIONS(LOAD)
#undef LOAD
    function = load_optional(surface, storage, sizeof storage / sizeof *storage);
    memcpy(&gl->BufferStorage, &function, sizeof function);
    function = load_optional(surface, multi, sizeof multi / sizeof *multi);
    memcpy(&gl->MultiDrawArrays, &function, sizeof function);
    function = load_optional(surface, reset, sizeof reset / sizeof *reset);
    memcpy(&gl->GetGraphicsResetStatus, &function, sizeof function);
    function = load_texture_buffers(surface);
    memcpy(&gl->TexBuffer, &function, sizeof function);
    if (function)
        return CAMBER_OK;
    const char *version = (const char *)gl->GetString(GL_VERSION);
    return camber_fail(surface->context, CAMBER_ERROR_DEVICE,
                       "%s: %s has no texture buffers; update the GL driver to GLES 3.2 or one with "
                       "GL_EXT_texture_buffer",
                       surface->name, version ? version : "its GL");
}

/* GLES has half-float targets since 3.2, and desktop GL, which OSMesa provides, since 3.0. */
static bool has_half_float_targets(const camber_gl *gl) {
    const char *version = (const char *)gl->GetString(GL_VERSION);
    return has_extension(gl, "GL_EXT_color_buffer_half_float") || has_extension(gl, "GL_EXT_color_buffer_float") ||
           (version && strncmp(version, "OpenGL ES", 9) != 0);
}

static void describe(camber_surface *surface) {
    const camber_gl *gl = &surface->gl;
    GLint texture = 0, viewport[2] = {0, 0};
    gl->GetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
    gl->GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    GLint largest = texture < viewport[0] ? texture : viewport[0];
    largest = largest < viewport[1] ? largest : viewport[1];
    const char *renderer = (const char *)gl->GetString(GL_RENDERER), *version = (const char *)gl->GetString(GL_VERSION);
    surface->info = (camber_surface_info){
        .backend = surface->name,
        .renderer = renderer ? renderer : "unknown",
        .version = version ? version : "unknown",
        .largest_target_px = largest > 0 ? (uint32_t)largest : 1,
        .software = renderer && is_software(renderer),
        .buffer_storage = gl->BufferStorage != NULL,
    };
    surface->largest_viewport[0] = viewport[0];
    surface->largest_viewport[1] = viewport[1];
    surface->half_float_targets = has_half_float_targets(gl);
    GLint texels = 0;
    gl->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
    surface->records_max = texels > 0 ? (uint32_t)texels : 65536; /* the minimum that the specification guarantees */
}

static camber_status open_backend(camber_context *context, const camber_surface_ops *ops,
                                  const camber_surface_desc *desc, camber_surface **surface) {
    camber_surface *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->ops = ops;
    made->egl_context = desc->egl_context;
    made->egl_display = desc->egl_display;
    camber_status status = ops->create(made);
    if (status == CAMBER_OK)
        status = load_gl(made);
    if (status != CAMBER_OK) {
        camber_surface_destroy(made);
        return status;
    }
    describe(made);
    *surface = made;
    return CAMBER_OK;
}

/* Tries a back end. A missing back end is not an error as long as another may work. */
static camber_status try_backend(camber_context *context, const camber_surface_ops *ops,
                                 const camber_surface_desc *desc, camber_surface **surface) {
    camber_saved_log kept;
    camber_log_demote_errors(context, &kept);
    const camber_status status = open_backend(context, ops, desc, surface);
    camber_log_restore(context, &kept);
    if (status == CAMBER_ERROR_MEMORY) /* then no other is tried */
        return camber_fail(context, status, "out of memory for a GL surface; give it more memory");
    return status;
}

camber_status camber_surface_create(camber_context *context, const camber_surface_desc *desc,
                                    camber_surface **surface) {
    static const camber_surface_ops *const backends[] = {&camber_surface_egl, &camber_surface_osmesa};
    const size_t count = sizeof backends / sizeof *backends;
    const camber_surface_desc full = desc ? *desc : (camber_surface_desc){0};
    const camber_backend wanted =
        full.egl_context && full.backend == CAMBER_BACKEND_AUTO ? CAMBER_BACKEND_EGL : full.backend;
    camber_status status = CAMBER_ERROR_DEVICE;
    if (full.egl_context && wanted == CAMBER_BACKEND_OSMESA)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "OSMesa shares nothing with a context of EGL's; use the back end EGL");
    for (size_t i = 0; i < count; i++)
        if (wanted == backends[i]->backend)
            return open_backend(context, backends[i], &full, surface);
    if (wanted != CAMBER_BACKEND_AUTO)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "no GL back end %d; see camber_backend", (int)wanted);
    for (size_t i = 0; i < count && status != CAMBER_OK && status != CAMBER_ERROR_MEMORY; i++)
        status = try_backend(context, backends[i], &full, surface);
    return status == CAMBER_ERROR_DEVICE
               ? camber_fail(context, status,
                             "no GL: neither EGL nor OSMesa gives a context; install libegl1, libegl-mesa0 and "
                             "libgl1-mesa-dri, or draw in OpenCL (--draw cl)")
               : status;
}

void camber_surface_destroy(camber_surface *surface) {
    if (!surface)
        return;
    surface->ops->destroy(surface);
    camber_free(surface->context, surface);
}

camber_surface_info camber_surface_get_info(const camber_surface *surface) {
    return surface->info;
}

bool camber_surface_is_lost(const camber_surface *surface) {
    return surface->lost;
}

static camber_status fail_lost(const camber_surface *surface) {
    return camber_fail(surface->context, CAMBER_ERROR_DEVICE,
                       "%s: the GL context is lost, as when the GPU is reset; start again with a new surface",
                       surface->name);
}

bool camber_surface_try_current(camber_surface *surface) {
    return !surface->lost && surface->ops->make_current(surface);
}

camber_status camber_surface_make_current(camber_surface *surface) {
    if (camber_surface_try_current(surface))
        return CAMBER_OK;
    if (surface->lost)
        return fail_lost(surface);
    return camber_fail(surface->context, CAMBER_ERROR_DEVICE,
                       "%s: the GL context cannot be made current; start again with a new surface", surface->name);
}

/* ---- Errors that GL reports ---- */

/* Returns the first error since the last check. Each part of the driver may have a flag of its own, and a lost context
 * may report its loss for ever. */
static GLenum take_errors(camber_surface *surface) {
    enum { FLAGS_MAX = 16 };
    const camber_gl *gl = &surface->gl;
    const GLenum first = gl->GetError();
    GLenum error = first;
    for (int i = 0; i < FLAGS_MAX && error != GL_NO_ERROR; i++) {
        surface->lost = surface->lost || error == GL_CONTEXT_LOST_KHR;
        error = gl->GetError();
    }
    if (gl->GetGraphicsResetStatus && gl->GetGraphicsResetStatus() != GL_NO_ERROR)
        surface->lost = true;
    return first;
}

void camber_surface_forget_errors(camber_surface *surface) {
    (void)take_errors(surface);
}

camber_status camber_surface_check(camber_surface *surface, const char *what) {
    const GLenum error = take_errors(surface);
    if (surface->lost)
        return fail_lost(surface);
    if (error == GL_OUT_OF_MEMORY)
        return camber_fail(surface->context, CAMBER_ERROR_MEMORY, "%s: %s is out of memory; draw less at once", what,
                           surface->info.renderer);
    if (error != GL_NO_ERROR)
        return camber_fail(surface->context, CAMBER_ERROR_DEVICE,
                           "%s: GL error 0x%x on %s; update its driver, or use another back end", what, error,
                           surface->info.renderer);
    return CAMBER_OK;
}

void camber_surface_release(camber_surface *surface) {
    surface->ops->release(surface);
}

camber_gl_handles camber_surface_get_handles(const camber_surface *surface) {
    camber_gl_handles handles = {0};
    if (!surface)
        return handles;
    if (surface->ops->handles)
        handles = surface->ops->handles(surface);
    handles.largest_buffer_bytes = (uint64_t)surface->records_max * sizeof(camber_record);
    return handles;
}
