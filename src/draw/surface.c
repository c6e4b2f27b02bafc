/* Choosing a back end, and what all back ends share. */
#include "draw/surface.h"

#include <string.h>

static bool has_extension(const camber_gl *gl, const char *name) {
    GLint count = 0;
    gl->GetIntegerv(GL_NUM_EXTENSIONS, &count);
    for (GLint i = 0; i < count; i++)
        if (strcmp((const char *)gl->GetStringi(GL_EXTENSIONS, (GLuint)i), name) == 0)
            return true;
    return false;
}

static bool is_software(const char *renderer) {
    return strstr(renderer, "llvmpipe") || strstr(renderer, "softpipe") || strstr(renderer, "SWR") ||
           strstr(renderer, "SwiftShader") || strstr(renderer, "Software");
}

static camber_status load_gl(camber_surface *surface) {
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
    const char *storage = has_extension(gl, "GL_EXT_buffer_storage")   ? "glBufferStorageEXT"
                          : has_extension(gl, "GL_ARB_buffer_storage") ? "glBufferStorage"
                                                                       : NULL;
    function = storage ? surface->ops->load(surface, storage) : NULL;
    memcpy(&gl->BufferStorage, &function, sizeof function);
    return CAMBER_OK;
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
}

static camber_status open_backend(camber_context *context, const camber_surface_ops *ops, camber_surface **surface) {
    camber_surface *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->ops = ops;
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

/* A log that tells errors as information: a back end that is not there is none while another may be. */
typedef struct softened_log {
    camber_log_fn *log;
    void *user;
} softened_log;

static void log_softened(void *user, camber_log_level level, const char *message) {
    const softened_log *softened = user;
    if (softened->log)
        softened->log(softened->user, level == CAMBER_LOG_ERROR ? CAMBER_LOG_INFO : level, message);
}

static camber_status try_backend(camber_context *context, const camber_surface_ops *ops, bool is_last,
                                 camber_surface **surface) {
    if (is_last)
        return open_backend(context, ops, surface);
    softened_log softened = {context->desc.log, context->desc.log_user};
    context->desc.log = log_softened;
    context->desc.log_user = &softened;
    const camber_status status = open_backend(context, ops, surface);
    context->desc.log = softened.log;
    context->desc.log_user = softened.user;
    return status;
}

camber_status camber_surface_create(camber_context *context, const camber_surface_desc *desc,
                                    camber_surface **surface) {
    static const camber_surface_ops *const backends[] = {&camber_surface_egl, &camber_surface_osmesa};
    const size_t count = sizeof backends / sizeof *backends;
    const camber_backend wanted = desc ? desc->backend : CAMBER_BACKEND_AUTO;
    camber_status status = CAMBER_ERROR_ARGUMENT;
    for (size_t i = 0; i < count; i++) {
        if (wanted != CAMBER_BACKEND_AUTO && wanted != backends[i]->backend)
            continue;
        status = try_backend(context, backends[i], wanted != CAMBER_BACKEND_AUTO || i + 1 == count, surface);
        if (status == CAMBER_OK || status == CAMBER_ERROR_MEMORY)
            return status;
    }
    return status == CAMBER_ERROR_ARGUMENT
               ? camber_fail(context, status, "no GL back end %d; see camber_backend", (int)wanted)
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

camber_status camber_surface_make_current(camber_surface *surface) {
    if (surface->ops->make_current(surface))
        return CAMBER_OK;
    return camber_fail(surface->context, CAMBER_ERROR_DEVICE,
                       "%s: the GL context cannot be made current; open it again", surface->name);
}

void camber_surface_release(camber_surface *surface) {
    surface->ops->release(surface);
}

camber_gl_handles camber_surface_handles(const camber_surface *surface) {
    return surface->ops->handles ? surface->ops->handles(surface) : (camber_gl_handles){0};
}
