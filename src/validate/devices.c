#include "validate/devices.h"

#include <stdlib.h>
#include <string.h>

/* What draws; the last are kernels, which need no surface. */
static const struct {
    camber_draw draw;
    camber_backend backend;
    const char *name;
} drawers[CAMBER_RIG_EASELS] = {{CAMBER_DRAW_GL, CAMBER_BACKEND_EGL, "EGL"},
                                {CAMBER_DRAW_GL, CAMBER_BACKEND_OSMESA, "OSMesa"},
                                {CAMBER_DRAW_CL, CAMBER_BACKEND_AUTO, "OpenCL"}};

static const camber_sharing paths[CAMBER_RIG_PATHS] = {CAMBER_SHARING_GL, CAMBER_SHARING_ZERO_COPY,
                                                       CAMBER_SHARING_COPY};

static const uint32_t group_sizes[CAMBER_RIG_GROUPS] = {64, 128};

/* A failed call's story becomes the reason of a skip. */
static void skip(camber_results *verdicts, camber_check check, camber_status status) {
    camber_report *report = verdicts->report;
    camber_results_skip(verdicts, check, report->error[0] ? report->error : camber_status_name(status));
    report->error[0] = 0;
}

static camber_status open_device(const camber_checked_device *rig, camber_session *session,
                                 const camber_device_desc *more, camber_surface *surface, camber_device **device) {
    camber_device_desc desc = *more;
    desc.match = session->options->device;
    desc.number = rig->number;
    desc.memory_bytes = session->options->memory_bytes;
    return camber_device_create(session->context, &desc, surface, device);
}

camber_status camber_checked_device_open_small(const camber_checked_device *rig, camber_session *session,
                                               uint64_t largest_buffer_bytes, camber_device **device,
                                               camber_mesh **mesh) {
    const camber_device_desc desc = {.largest_buffer_bytes = largest_buffer_bytes};
    camber_device *made = NULL;
    camber_status status = open_device(rig, session, &desc, NULL, &made);
    if (status == CAMBER_OK)
        status = camber_mesh_create(made, NULL, mesh);
    if (status == CAMBER_OK)
        *device = made;
    else
        camber_device_destroy(made);
    return status;
}

/* ---- What draws ---- */

static void open_path(const camber_checked_device *rig, camber_checked_drawer *easel, camber_sharing sharing,
                      camber_results *verdicts) {
    const bool in_gl = easel->draw == CAMBER_DRAW_GL;
    const camber_renderer_desc desc = {.sharing = sharing, .draw = easel->draw};
    camber_drawing_path path = {.name = in_gl ? camber_sharing_name(sharing) : "no sharing"};
    camber_status status = camber_renderer_create(easel->device, easel->surface, &desc, &path.renderer);
    if (status == CAMBER_OK)
        status = camber_mesh_create(easel->device, path.renderer, &path.mesh);
    if (status == CAMBER_OK) {
        easel->paths[easel->path_count++] = path;
        return;
    }
    camber_renderer_destroy(path.renderer);
    skip(verdicts,
         camber_check_start(rig->name, easel->name, "sharing by %s, on %s, %s", path.name, rig->name, easel->name),
         status);
}

static void close_easel(camber_checked_drawer *easel) {
    for (size_t i = 0; i < easel->path_count; i++) {
        camber_mesh_destroy(easel->paths[i].mesh);
        camber_renderer_destroy(easel->paths[i].renderer);
    }
    camber_device_destroy(easel->device);
    camber_surface_destroy(easel->surface);
    *easel = (camber_checked_drawer){0};
}

/* Whether it was named: what is not there is an error then. */
static bool is_asked_for(size_t which, const camber_options *options) {
    return drawers[which].draw == CAMBER_DRAW_CL ? (camber_draw)options->draw == CAMBER_DRAW_CL
                                                 : options->backend == (int)drawers[which].backend;
}

/* --draw leaves one kind, and --backend a back end of GL's. */
static bool is_wanted(size_t which, const camber_options *options) {
    const camber_draw draw = (camber_draw)options->draw;
    if (is_asked_for(which, options))
        return draw == CAMBER_DRAW_AUTO || draw == drawers[which].draw;
    return options->backend == CAMBER_BACKEND_AUTO && (draw == CAMBER_DRAW_AUTO || draw == drawers[which].draw);
}

/* The row number which of the table; one that is not there is skipped, or an error where it was asked for. */
static int open_easel(camber_checked_device *rig, size_t which, camber_session *session, camber_results *verdicts) {
    const camber_surface_desc desc = {.backend = drawers[which].backend};
    camber_checked_drawer easel = {.name = drawers[which].name, .draw = drawers[which].draw};
    const bool in_gl = easel.draw == CAMBER_DRAW_GL;
    camber_status status = in_gl ? camber_surface_create(session->context, &desc, &easel.surface) : CAMBER_OK;
    if (status == CAMBER_OK)
        status = open_device(rig, session, &(camber_device_desc){0}, easel.surface, &easel.device);
    for (size_t i = 0; i < (in_gl ? CAMBER_RIG_PATHS : 1) && status == CAMBER_OK; i++)
        open_path(rig, &easel, in_gl ? paths[i] : CAMBER_SHARING_AUTO, verdicts);
    if (easel.path_count) {
        rig->easels[rig->easel_count++] = easel;
        return CAMBER_EXIT_DONE;
    }
    close_easel(&easel);
    if (is_asked_for(which, session->options))
        return camber_report_status(session->report, status == CAMBER_OK ? CAMBER_ERROR_DEVICE : status);
    const char *name = drawers[which].name;
    skip(verdicts, camber_check_start(rig->name, name, "pictures, on %s, %s", rig->name, name), status);
    return CAMBER_EXIT_DONE;
}

/* ---- Devices ---- */

static void close_rig(camber_checked_device *rig) {
    for (size_t i = 0; i < rig->easel_count; i++)
        close_easel(&rig->easels[i]);
    for (size_t i = 0; i < CAMBER_RIG_GROUPS; i++) {
        camber_mesh_destroy(rig->groups[i].mesh);
        camber_device_destroy(rig->groups[i].device);
    }
    camber_mesh_destroy(rig->mesh);
    camber_device_destroy(rig->device);
    *rig = (camber_checked_device){0};
}

/* The device and its work-group sizes, without GL. */
static camber_status open_plain(camber_checked_device *rig, camber_session *session) {
    camber_status status = open_device(rig, session, &(camber_device_desc){0}, NULL, &rig->device);
    if (status == CAMBER_OK)
        status = camber_mesh_create(rig->device, NULL, &rig->mesh);
    for (size_t i = 0; i < CAMBER_RIG_GROUPS && status == CAMBER_OK; i++) {
        const camber_device_desc desc = {.work_group_size = group_sizes[i]};
        rig->groups[i].size = group_sizes[i];
        status = open_device(rig, session, &desc, NULL, &rig->groups[i].device);
        if (status == CAMBER_OK)
            status = camber_mesh_create(rig->groups[i].device, NULL, &rig->groups[i].mesh);
    }
    return status;
}

static int open_rig(camber_checked_devices *rigs, camber_checked_device *rig, camber_session *session,
                    camber_results *verdicts) {
    const camber_status status = open_plain(rig, session);
    if (status != CAMBER_OK) {
        /* The name outlives the rig, which the next device takes. */
        skip(verdicts, camber_check_start(NULL, NULL, "kernels, on %s", rig->name), status);
        close_rig(rig);
        return CAMBER_EXIT_DONE;
    }
    rigs->count++;
    int opened = CAMBER_EXIT_DONE;
    for (size_t i = 0; i < CAMBER_RIG_EASELS && opened == CAMBER_EXIT_DONE; i++)
        if (is_wanted(i, session->options))
            opened = open_easel(rig, i, session, verdicts);
    return opened;
}

/* "NAME", or "NAME (2)" for the second of that name. */
static void name_rig(camber_checked_device *rig, const camber_device_info *infos, size_t at) {
    size_t twins = 0;
    for (size_t i = 0; i < at; i++)
        twins += strcmp(infos[i].name, infos[at].name) == 0;
    if (twins)
        snprintf(rig->name, sizeof rig->name, "%s (%zu)", infos[at].name, twins + 1);
    else
        snprintf(rig->name, sizeof rig->name, "%s", infos[at].name);
}

static int open_all(camber_checked_devices *rigs, camber_session *session, camber_results *verdicts,
                    const camber_device_info *infos, size_t count) {
    const char *match = session->options->device;
    int status = CAMBER_EXIT_DONE;
    uint32_t number = 0;
    for (size_t i = 0; i < count && status == CAMBER_EXIT_DONE; i++) {
        if (!camber_device_matches(&infos[i], match))
            continue;
        camber_checked_device *rig = &rigs->list[rigs->count];
        name_rig(rig, infos, i);
        rig->number = ++number;
        status = open_rig(rigs, rig, session, verdicts);
    }
    if (status != CAMBER_EXIT_DONE || rigs->count)
        return status;
    /* None: opening one says why. */
    camber_device *none = NULL;
    const camber_status made =
        camber_device_create(session->context, &(camber_device_desc){.match = match}, NULL, &none);
    camber_device_destroy(none);
    return camber_report_status(session->report, made == CAMBER_OK ? CAMBER_ERROR_DEVICE : made);
}

int camber_checked_devices_open(camber_checked_devices *rigs, camber_session *session, camber_results *verdicts) {
    *rigs = (camber_checked_devices){0};
    size_t count = 0;
    camber_status listed = camber_device_list(session->context, 0, NULL, &count);
    camber_device_info *infos = calloc(count + 1, sizeof *infos);
    rigs->list = calloc(count + 1, sizeof *rigs->list);
    if (listed == CAMBER_OK && infos && rigs->list) {
        const size_t capacity = count;
        listed = camber_device_list(session->context, capacity, infos, &count);
        count = count < capacity ? count : capacity;
    } else if (listed == CAMBER_OK) {
        listed = CAMBER_ERROR_MEMORY;
    }
    int status = camber_report_status(session->report, listed);
    if (status == CAMBER_EXIT_DONE && infos && rigs->list)
        status = open_all(rigs, session, verdicts, infos, count);
    free(infos);
    return status;
}

void camber_checked_devices_close(camber_checked_devices *rigs) {
    for (size_t i = 0; i < rigs->count; i++)
        close_rig(&rigs->list[i]);
    free(rigs->list);
    *rigs = (camber_checked_devices){0};
}
