#include "cli/session.h"

#include <stdlib.h>

/* Both names of PoCL, of before and after 4.0, and llvmpipe's, which read them when they start; GDAL's too. */
static bool set_threads(uint32_t threads) {
    char text[16];
    snprintf(text, sizeof text, "%u", threads);
    return setenv("POCL_MAX_PTHREAD_COUNT", text, 1) == 0 && setenv("POCL_CPU_MAX_CU_COUNT", text, 1) == 0 &&
           setenv("LP_NUM_THREADS", text, 1) == 0 && setenv("GDAL_NUM_THREADS", text, 1) == 0;
}

static camber_status open_context(camber_session *session) {
    const uint32_t threads = session->options->threads;
    if (threads && !set_threads(threads))
        return CAMBER_ERROR_MEMORY;
    /* Mesa's own warnings about missing GPUs would stand among the errors. */
    setenv("EGL_LOG_LEVEL", "fatal", 0);
    const camber_context_desc desc = {.log = camber_report_log,
                                      .log_user = session->report,
                                      .progress = camber_report_progress,
                                      .progress_user = session->report};
    return camber_context_create(&desc, &session->context);
}

int camber_session_need(camber_session *session, camber_needs needs) {
    const camber_options *options = session->options;
    camber_status status = CAMBER_OK;
    if (!session->context)
        status = open_context(session);
    if (status == CAMBER_OK && needs >= CAMBER_NEEDS_RENDERER && !session->surface) {
        const camber_surface_desc desc = {.backend = (camber_backend)options->backend};
        status = camber_surface_create(session->context, &desc, &session->surface);
    }
    if (status == CAMBER_OK && needs >= CAMBER_NEEDS_DEVICE && !session->device) {
        const camber_device_desc desc = {.match = options->device};
        status = camber_device_create(session->context, &desc, session->surface, &session->device);
    }
    if (status == CAMBER_OK && needs >= CAMBER_NEEDS_RENDERER && !session->renderer) {
        const camber_renderer_desc desc = {.sharing = (camber_sharing)options->sharing};
        status = camber_renderer_create(session->device, session->surface, &desc, &session->renderer);
    }
    return camber_report_status(session->report, status);
}

void camber_session_close(camber_session *session) {
    camber_renderer_destroy(session->renderer);
    camber_device_destroy(session->device);
    camber_surface_destroy(session->surface);
    camber_context_destroy(session->context);
    session->renderer = NULL;
    session->device = NULL;
    session->surface = NULL;
    session->context = NULL;
}

camber_method camber_session_method(const camber_session *session) {
    return session->options->method < 0 ? CAMBER_METHOD_STRIP : (camber_method)session->options->method;
}

void camber_session_describe(const camber_session *session, json_t *object) {
    if (session->device) {
        const camber_device_info info = camber_device_get_info(session->device);
        json_object_set_new(object, "device", camber_json_text(info.name));
    }
    if (session->surface) {
        const camber_surface_info info = camber_surface_get_info(session->surface);
        json_object_set_new(object, "gl_backend", camber_json_text(info.backend));
        json_object_set_new(object, "gl_renderer", camber_json_text(info.renderer));
    }
    if (session->renderer) {
        const camber_sharing sharing = camber_renderer_get_sharing(session->renderer);
        json_object_set_new(object, "sharing", camber_json_text(camber_sharing_name(sharing)));
    }
}
