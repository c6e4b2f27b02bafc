/* Opens what the options select for drawing: --draw, --backend, --sharing and --device decide, otherwise whether GL
 * runs on hardware. A renderer can be opened on a second thread while files are read, with a context and a report of
 * its own. */
#include "cli/session.h"

#ifdef CAMBER_MAP
#include "camber_map.h"
#endif

#include <pthread.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* Meshes of tiles are small, except at zooms that show much of the data. At those zooms, parts of a mesh are swapped in
 * and out, which is just as fast. */
static const uint64_t TILES_BYTES = 256 << 20;
/* Any input can be read within this limit. */
static const uint64_t LEAST_BUDGET_BYTES = 128 << 20;

static camber_access access_of(const camber_options *options) {
    const bool reads = options->resume || options->renewed; /* these read the existing output */
    const char *const outputs[] = {reads ? NULL : options->output, options->dump, options->plot, options->junit};
    camber_access access = {.remote = options->allow_remote, .vrt = options->allow_vrt, .root = options->root};
    for (size_t i = 0; i < sizeof outputs / sizeof *outputs; i++)
        access.outputs[i] = outputs[i] && strcmp(outputs[i], "-") != 0 ? outputs[i] : NULL;
    return access;
}

static void show_progress(void *user, const camber_progress_info *progress) {
    camber_session *session = user;
    camber_watch_beat(&session->watch);
    camber_report_progress(session->report, progress);
}

/* 0: the budget determines it */
static uint64_t find_most_bytes(const camber_session *session) {
    const uint64_t asked = session->options->memory_bytes;
    if (!session->whole)
        return asked && asked < LEAST_BUDGET_BYTES ? LEAST_BUDGET_BYTES : asked;
    const uint64_t most = camber_budget_get_most_bytes(session->whole),
                   taken = camber_budget_get_held_bytes(session->whole) + session->beside_bytes;
    return most > taken ? most - taken : 1;
}

static camber_status prepare(camber_session *session) {
    const camber_options *options = session->options;
    if (session->context)
        return CAMBER_OK;
    const camber_budget_desc budget = {.memory_bytes = find_most_bytes(session)};
    const camber_status status = camber_budget_create(&budget, &session->budget);
    if (status != CAMBER_OK)
        return status;
    camber_watch_start(&session->watch, session->guard, session->report,
                       session->whole ? session->whole : session->budget);
    const camber_context_desc desc = {.log = camber_report_log,
                                      .log_user = session->report,
                                      .progress = show_progress,
                                      .progress_user = session,
                                      .budget = session->budget,
                                      .access = access_of(options)};
    return camber_context_create(&desc, &session->context);
}

/* ---- Drawing ---- */

static void say_draw(camber_session *session, camber_report *report, camber_rasterizer draw, const char *format, ...) {
    char text[512];
    va_list list;
    va_start(list, format);
    vsnprintf(session->draw_reason, sizeof session->draw_reason, format, list);
    va_end(list);
    session->draw = draw;
    snprintf(text, sizeof text, "draw: %s: %s", camber_rasterizer_get_name(draw), session->draw_reason);
    camber_report_log(report, CAMBER_LOG_INFO, text);
}

/* If the options do not decide, kernels draw unless GL runs on hardware. compare, whose figures mostly come from GL,
 * uses kernels only if GL is not available. A surface stays open if GL draws. */
static camber_status choose_draw(camber_session *session, camber_context *context, camber_report *report) {
    const camber_options *options = session->options;
    const camber_surface_desc desc = {.backend = (camber_backend)options->backend};
    const bool counts = options->verb == CAMBER_VERB_COMPARE;
    if (!counts && !camber_surface_may_be_hardware(&desc)) {
        say_draw(session, report, CAMBER_RASTERIZER_OPENCL, "no GPU is here that GL could draw on");
        return CAMBER_OK;
    }
    const camber_status status = camber_surface_create(context, &desc, &session->surface);
    if (status == CAMBER_ERROR_MEMORY)
        return status;
    if (status != CAMBER_OK) {
        say_draw(session, report, CAMBER_RASTERIZER_OPENCL, "no GL is here");
        report->error[0] = 0; /* this is not a failure */
        return CAMBER_OK;
    }
    const camber_surface_info info = camber_surface_get_info(session->surface);
    if (info.software && !counts) {
        say_draw(session, report, CAMBER_RASTERIZER_OPENCL, "GL is a software rasteriser: %s", info.renderer);
        camber_surface_destroy(session->surface);
        session->surface = NULL;
        return CAMBER_OK;
    }
    if (counts)
        say_draw(session, report, CAMBER_RASTERIZER_GL, "fragments and repeated pixels are counted in GL");
    else
        say_draw(session, report, CAMBER_RASTERIZER_GL, "GL is hardware: %s", info.renderer);
    return CAMBER_OK;
}

static camber_status open_gl(camber_session *session, camber_context *context, camber_report *report) {
    const camber_options *options = session->options;
    const camber_rasterizer wish = (camber_rasterizer)options->draw;
    const camber_surface_desc desc = {.backend = (camber_backend)options->backend};
    const bool named = options->backend != CAMBER_BACKEND_AUTO, shares = options->sharing != CAMBER_SHARING_AUTO;
    if (wish == CAMBER_RASTERIZER_AUTO && !named && !shares)
        return choose_draw(session, context, report);
    if (wish == CAMBER_RASTERIZER_AUTO)
        say_draw(session, report, CAMBER_RASTERIZER_GL, "--%s asks for GL", named ? "backend" : "sharing");
    else
        say_draw(session, report, wish, "asked for");
    return session->draw == CAMBER_RASTERIZER_GL ? camber_surface_create(context, &desc, &session->surface) : CAMBER_OK;
}

static camber_status open_drawing(camber_session *session, camber_context *context, camber_report *report,
                                  camber_needs needs) {
    const camber_options *options = session->options;
    const bool small = options->verb == CAMBER_VERB_TILES || options->verb == CAMBER_VERB_SERVE;
    camber_status status = CAMBER_OK;
    if (needs >= CAMBER_NEEDS_RENDERER && !session->renderer && !session->surface)
        status = open_gl(session, context, report);
    if (status == CAMBER_OK && needs >= CAMBER_NEEDS_DEVICE && !session->device) {
        const camber_device_desc desc = {.match = options->device,
                                         .memory_bytes =
                                             options->memory_bytes || !small ? options->memory_bytes : TILES_BYTES,
                                         .threads = options->threads,
                                         .gl = camber_surface_get_handles(session->surface)};
        status = camber_device_create(context, &desc, &session->device);
    }
    if (status == CAMBER_OK && needs >= CAMBER_NEEDS_RENDERER && !session->renderer) {
        const camber_renderer_desc desc = {.sharing = (camber_sharing)options->sharing, .rasterizer = session->draw};
        status = camber_renderer_create(session->device, session->surface, &desc, &session->renderer);
    }
    return status;
}

/* ---- Opening on a second thread ---- */

struct camber_opener {
    camber_session *session;
    camber_context *context;
    camber_report report;
    camber_report *told; /* `report` while the thread runs, and the session's report afterwards */
    camber_status status;
    camber_outlook outlook;
    double pitch_deg;
    pthread_t thread;
    bool running;
};

/* Draws one line with the kernels and shaders that maps use, so that drivers compile them now, and not in the first
 * frame. */
static camber_status warm_up(const camber_opener *opener) {
    static const float lengths[] = {1, 1};
    const camber_session *session = opener->session;
    camber_context *context = opener->context;
    const bool rich = opener->outlook == CAMBER_OUTLOOK_RICH && session->draw == CAMBER_RASTERIZER_OPENCL;
    /* Kernels that may not be needed are left out: compiling them takes seconds, while loading them later from the
     * cache takes milliseconds. */
    const bool draws = session->draw == CAMBER_RASTERIZER_GL || opener->outlook != CAMBER_OUTLOOK_OPEN;
    const camber_dash dash = {lengths, 2};
    const double points[] = {2, 2, 14, 2, 14, 14};
    const size_t offsets[] = {0, 3};
    const camber_network_desc lines = {
        .points = points, .offsets = offsets, .polyline_count = 1, .has_arc_length = rich};
    const camber_camera camera = {
        .x = 8, .y = 8, .scale_px = 1, .width = 16, .height = 16, .pitch_deg = opener->pitch_deg};
    const camber_stroke stroke = {.width_px = 3};
    const camber_paint paint = {.width_px = 3, .color = {0, 0, 0, 1}, .dash = rich ? &dash : NULL};
    const camber_tessellation_desc tessellation = {
        .strokes = &stroke, .stroke_count = 1, .method = camber_session_method(session), .has_arc_length = rich};
    camber_network *network = NULL;
    camber_mesh *mesh = NULL;
    camber_status status = camber_network_create(context, &lines, &network);
    if (status == CAMBER_OK)
        status = camber_mesh_create(session->device, session->renderer, &mesh);
    if (status == CAMBER_OK)
        status = camber_mesh_tessellate_network(mesh, network, &camera, &tessellation);
    if (status == CAMBER_OK && draws) {
        const camber_pass pass = {.mesh = mesh, .paints = &paint, .paint_count = 1};
        const camber_frame frame = {.width = 16,
                                    .height = 16,
                                    .passes = &pass,
                                    .pass_count = 1,
                                    .coverage = (camber_coverage)session->options->coverage,
                                    .pitch_deg = opener->pitch_deg};
        status = camber_renderer_render(session->renderer, &frame, NULL, NULL, NULL);
    }
    camber_mesh_destroy(mesh);
    camber_network_destroy(network);
    return status;
}

static void log_beside(void *user, camber_log_level level, const char *message) {
    const camber_opener *opener = user;
    camber_report_log(opener->told, level, message);
}

static void *open_beside(void *user) {
    camber_opener *opener = user;
    const camber_context_desc desc = {.log = log_beside,
                                      .log_user = opener,
                                      .progress = camber_report_progress,
                                      .progress_user = &opener->report,
                                      .budget = opener->session->budget};
    opener->status = camber_context_create(&desc, &opener->context);
    if (opener->status == CAMBER_OK)
        opener->status = open_drawing(opener->session, opener->context, &opener->report, CAMBER_NEEDS_RENDERER);
    const camber_status warm = opener->status == CAMBER_OK ? warm_up(opener) : CAMBER_OK;
    /* The first frame fails in the same way, and reports it. A server must report it before it says that it is
     * ready. */
    if (opener->session->options->verb == CAMBER_VERB_SERVE && warm != CAMBER_OK)
        opener->status = warm;
    if (opener->session->surface)
        camber_surface_release(opener->session->surface);
    return NULL;
}

#ifdef CAMBER_MAP
static bool needs_gdal(const camber_options *options) {
    for (size_t i = 0; i < options->input_count; i++) {
        const camber_source_desc desc = {.path = options->inputs[i], .layer = options->layer, .where = options->where};
        if (camber_source_needs_gdal(&desc))
            return true;
    }
    return false;
}
#endif

void camber_session_start(camber_session *session, camber_outlook outlook, double pitch_deg) {
    if (prepare(session) != CAMBER_OK)
        return;
#ifdef CAMBER_MAP
    /* Loads GDAL before other threads start, because the loader would wait for them. Reading the file says why if it
     * cannot be loaded. */
    if (needs_gdal(session->options))
        (void)camber_gdal_get_version();
#endif
    camber_opener *opener = calloc(1, sizeof *opener);
    if (!opener)
        return;
    opener->session = session;
    opener->outlook = outlook;
    opener->pitch_deg = pitch_deg;
    opener->report = *session->report;
    opener->report.bars = false;
    opener->told = &opener->report;
    opener->running = pthread_create(&opener->thread, NULL, open_beside, opener) == 0;
    if (opener->running)
        session->opener = opener;
    else
        free(opener);
}

bool camber_session_is_opening(const camber_session *session) {
    return session->opener && session->opener->running;
}

static void join(camber_opener *opener) {
    if (opener && opener->running)
        pthread_join(opener->thread, NULL);
    if (opener)
        opener->running = false;
}

/* ---- Both ---- */

int camber_session_need(camber_session *session, camber_needs needs) {
    camber_status status = prepare(session);
    if (status != CAMBER_OK || needs < CAMBER_NEEDS_DEVICE)
        return camber_report_status(session->report, status);
    if (session->opener) {
        join(session->opener);
        if (session->opener->told != session->report) /* once it is set, the thread that draws reads it */
            session->opener->told = session->report;
        return camber_report_status(&session->opener->report, session->opener->status);
    }
    return camber_report_status(session->report, camber_session_open(session, needs));
}

camber_status camber_session_open(camber_session *session, camber_needs needs) {
    return open_drawing(session, session->context, session->report, needs);
}

void camber_session_close(camber_session *session) {
    join(session->opener);
    camber_renderer_destroy(session->renderer);
    camber_device_destroy(session->device);
    camber_surface_destroy(session->surface);
    camber_context_destroy(session->context);
    if (session->opener)
        camber_context_destroy(session->opener->context);
    camber_watch_stop(&session->watch);
    camber_budget_destroy(session->budget);
    free(session->opener);
    session->renderer = NULL;
    session->device = NULL;
    session->surface = NULL;
    session->context = NULL;
    session->budget = NULL;
    session->opener = NULL;
}

camber_method camber_session_method(const camber_session *session) {
    return session->options->method < 0 ? CAMBER_METHOD_STRIP : (camber_method)session->options->method;
}

void camber_session_say_memory(const camber_session *session) {
    const uint64_t asked = session->options->memory_bytes;
    char meshes[96] = "";
    if (!session->report->verbose || !session->budget)
        return;
    if (session->device)
        snprintf(meshes, sizeof meshes, ", of which meshes may take %s",
                 camber_figure_bytes(camber_device_get_memory(session->device).most_bytes).text);
    camber_report_say(session->report,
                      "memory: the process took at most %s, drivers and libraries included; without them it may take "
                      "%s%s%s",
                      camber_figure_bytes(camber_peak_rss_bytes()).text,
                      camber_figure_limit(camber_budget_get_most_bytes(session->budget)).text,
                      asked && asked < LEAST_BUDGET_BYTES ? " (the least)" : "", meshes);
}

void camber_session_describe(const camber_session *session, json_t *object) {
    if (session->device) {
        const camber_device_info info = camber_device_get_info(session->device);
        const camber_device_memory memory = camber_device_get_memory(session->device);
        json_object_set_new(object, "device", camber_json_text(info.name));
        json_object_set_new(object, "meshes_most_bytes", camber_json_count((size_t)memory.most_bytes));
    }
    if (session->surface) {
        const camber_surface_info info = camber_surface_get_info(session->surface);
        json_object_set_new(object, "gl_backend", camber_json_text(info.backend));
        json_object_set_new(object, "gl_renderer", camber_json_text(info.renderer));
    }
    if (session->renderer) {
        const camber_sharing sharing = camber_renderer_get_sharing(session->renderer);
        const bool in_gl = session->draw == CAMBER_RASTERIZER_GL;
        json_object_set_new(object, "draw", camber_json_text(camber_rasterizer_get_name(session->draw)));
        json_object_set_new(object, "draw_reason", camber_json_text(session->draw_reason));
        json_object_set_new(object, "sharing", camber_json_text(in_gl ? camber_sharing_get_name(sharing) : "none"));
        if (!in_gl)
            json_object_set_new(object, "gl_renderer", json_null());
    }
}
