/* Opens a device three times without a renderer, with three work-group sizes, and once more for each drawer, because a
 * renderer decides how a device shares its buffers. If something cannot be opened, a skipped check gives the reason. */
#include "validate/devices.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const camber_sharing sharings[CAMBER_CHECKED_PATHS] = {CAMBER_SHARING_GL, CAMBER_SHARING_ZERO_COPY,
                                                              CAMBER_SHARING_COPY};

static const uint32_t group_sizes[CAMBER_CHECKED_GROUPS] = {64, 128, 256}, lanes[CAMBER_CHECKED_GROUPS] = {8, 16, 1};

/* Skips a check. The reason is the message of the failed call. */
static void skip(camber_validation *v, camber_check check, camber_status status) {
    char message[sizeof check.reason];
    v->desc->host.take_message(v->desc->host.user, message, sizeof message);
    camber_results_skip(&v->results, check, message[0] ? message : camber_status_get_name(status));
}

static camber_device_desc device_desc(const camber_validation *v, const camber_checked_device *checked) {
    return (camber_device_desc){
        .match = v->desc->match, .number = checked->number, .memory_bytes = v->desc->memory_bytes};
}

static camber_status open_alone(const camber_validation *v, const camber_device_desc *desc, camber_device **device,
                                camber_mesh **mesh) {
    camber_device *made = NULL;
    camber_status status = camber_device_create(v->desc->context, desc, &made);
    if (status == CAMBER_OK && mesh)
        status = camber_mesh_create(made, NULL, mesh);
    if (status == CAMBER_OK)
        *device = made;
    else
        camber_device_destroy(made);
    return status;
}

camber_status camber_checked_device_open_small(const camber_checked_device *checked,
                                               const camber_validation *validation, uint64_t largest_buffer_bytes,
                                               camber_device **device, camber_mesh **mesh) {
    camber_device_desc desc = device_desc(validation, checked);
    desc.largest_buffer_bytes = largest_buffer_bytes;
    return open_alone(validation, &desc, device, mesh);
}

/* ---- Drawers ---- */

static void open_path(camber_validation *v, const camber_checked_device *checked, camber_checked_drawer *drawer,
                      camber_fixture_drawer kind, camber_sharing sharing) {
    camber_drawing_path path = {.name = drawer->in_gl ? camber_sharing_get_name(sharing) : "no sharing"};
    camber_status status = camber_fixture_open_renderer(&drawer->fixture, kind, sharing, &path.renderer);
    if (status == CAMBER_OK)
        status = camber_mesh_create(drawer->fixture.device, path.renderer, &path.mesh);
    if (status == CAMBER_OK) {
        drawer->paths[drawer->path_count++] = path;
        return;
    }
    camber_renderer_destroy(path.renderer);
    skip(v,
         camber_check_start(checked->name, drawer->name, "sharing by %s, on %s, %s", path.name, checked->name,
                            drawer->name),
         status);
}

static void close_drawer(camber_checked_drawer *drawer) {
    for (size_t i = 0; i < drawer->path_count; i++) {
        camber_mesh_destroy(drawer->paths[i].mesh);
        camber_renderer_destroy(drawer->paths[i].renderer);
    }
    camber_fixture_close(&drawer->fixture);
    *drawer = (camber_checked_drawer){0};
}

/* Whether the options name it, so that it is an error if it is missing. */
static bool is_asked_for(camber_fixture_drawer kind, const camber_validation_desc *desc) {
    return kind == CAMBER_FIXTURE_OPENCL ? desc->rasterizer == CAMBER_RASTERIZER_OPENCL
                                         : desc->backend == camber_fixture_backend(kind);
}

/* Whether the options allow it: a kind of drawing allows its own drawers, and a back end allows itself. */
static bool is_wanted(camber_fixture_drawer kind, const camber_validation_desc *desc) {
    const camber_rasterizer rasterizer =
        kind == CAMBER_FIXTURE_OPENCL ? CAMBER_RASTERIZER_OPENCL : CAMBER_RASTERIZER_GL;
    const bool allowed = desc->rasterizer == CAMBER_RASTERIZER_AUTO || desc->rasterizer == rasterizer;
    return allowed && (is_asked_for(kind, desc) || desc->backend == CAMBER_BACKEND_AUTO);
}

/* Opens a drawer. A missing one is skipped, or is an error if the options name it. */
static camber_status open_drawer(camber_validation *v, camber_checked_device *checked, camber_fixture_drawer kind) {
    const camber_fixture_desc desc = {
        .device = device_desc(v, checked), .drawers = 1u << kind, .on_surface = true, .surfaces_alone = true};
    camber_checked_drawer drawer = {.name = camber_fixture_drawer_name(kind), .in_gl = kind != CAMBER_FIXTURE_OPENCL};
    const camber_status status = camber_fixture_open(v->desc->context, &desc, &drawer.fixture);
    for (size_t i = 0; i < (drawer.in_gl ? CAMBER_CHECKED_PATHS : 1) && status == CAMBER_OK; i++)
        open_path(v, checked, &drawer, kind, drawer.in_gl ? sharings[i] : CAMBER_SHARING_AUTO);
    if (drawer.path_count) {
        checked->drawers[checked->drawer_count++] = drawer;
        return CAMBER_OK;
    }
    const char *name = drawer.name;
    close_drawer(&drawer);
    if (is_asked_for(kind, v->desc))
        return status == CAMBER_OK ? CAMBER_ERROR_DEVICE : status;
    skip(v, camber_check_start(checked->name, name, "pictures, on %s, %s", checked->name, name), status);
    return CAMBER_OK;
}

/* ---- Devices ---- */

static void close_device(camber_checked_device *checked) {
    for (size_t i = 0; i < checked->drawer_count; i++)
        close_drawer(&checked->drawers[i]);
    for (size_t i = 0; i < checked->group_count; i++) {
        camber_mesh_destroy(checked->groups[i].mesh);
        camber_device_destroy(checked->groups[i].device);
    }
    camber_mesh_destroy(checked->mesh);
    camber_device_destroy(checked->device);
    *checked = (camber_checked_device){0};
}

/* Opens the device with its work-group sizes, without a renderer. */
static camber_status open_plain(camber_validation *v, camber_checked_device *checked) {
    camber_device_desc desc = device_desc(v, checked);
    camber_status status = open_alone(v, &desc, &checked->device, &checked->mesh);
    /* a GPU has one lane, and its compiler takes minutes for vectors */
    const bool has_vectors =
        status == CAMBER_OK && camber_device_get_info(checked->device).type == CAMBER_DEVICE_TYPE_CPU;
    if (status == CAMBER_OK && !camber_device_get_info(checked->device).fixed_kernels)
        checked->group_count = CAMBER_CHECKED_GROUPS;
    for (size_t i = 0; i < checked->group_count && status == CAMBER_OK; i++) {
        desc.work_group_size = checked->groups[i].size = group_sizes[i];
        desc.lanes = checked->groups[i].lanes = has_vectors ? lanes[i] : 1;
        status = open_alone(v, &desc, &checked->groups[i].device, &checked->groups[i].mesh);
    }
    return status;
}

static camber_status open_device(camber_validation *v, camber_checked_device *checked) {
    const camber_status status = open_plain(v, checked);
    if (status != CAMBER_OK) {
        /* the name must not be stored in the check, because the next device replaces it */
        skip(v, camber_check_start(NULL, NULL, "kernels, on %s", checked->name), status);
        close_device(checked);
        return CAMBER_OK;
    }
    v->devices.count++;
    camber_status opened = CAMBER_OK;
    for (int i = 0; i < CAMBER_FIXTURE_DRAWERS && opened == CAMBER_OK; i++)
        if (is_wanted((camber_fixture_drawer)i, v->desc))
            opened = open_drawer(v, checked, (camber_fixture_drawer)i);
    return opened;
}

/* Writes "NAME", or "NAME (2)" for the second device with this name. */
static void name_device(camber_checked_device *checked, const camber_validation_desc *desc, size_t at,
                        const char *name) {
    const camber_device_info *earlier = NULL;
    size_t before = 0;
    for (size_t i = 0; i < at && camber_device_list(desc->context, desc->match, i, &earlier) == CAMBER_OK; i++)
        before += strcmp(earlier->name, name) == 0;
    if (before)
        snprintf(checked->name, sizeof checked->name, "%s (%zu)", name, before + 1);
    else
        snprintf(checked->name, sizeof checked->name, "%s", name);
}

static camber_status open_all(camber_validation *v) {
    const camber_validation_desc *desc = v->desc;
    const camber_device_info *info = NULL;
    camber_status status = CAMBER_OK;
    for (uint32_t i = 0; status == CAMBER_OK; i++) {
        status = camber_device_list(desc->context, desc->match, i, &info);
        if (status != CAMBER_OK || !info)
            break;
        camber_checked_device *checked = &v->devices.list[v->devices.count];
        name_device(checked, desc, i, info->name);
        checked->number = i + 1;
        status = open_device(v, checked);
    }
    if (status != CAMBER_OK || v->devices.count)
        return status;
    /* there is no device; opening one logs the reason */
    camber_device *none = NULL;
    status = camber_device_create(desc->context, &(camber_device_desc){.match = desc->match}, &none);
    camber_device_destroy(none);
    return status == CAMBER_OK ? CAMBER_ERROR_DEVICE : status;
}

camber_status camber_checked_devices_open(camber_validation *v) {
    const camber_device_info *info = NULL;
    size_t count = 0;
    camber_status status = camber_device_list(v->desc->context, v->desc->match, 0, &info);
    while (status == CAMBER_OK && info)
        status = camber_device_list(v->desc->context, v->desc->match, ++count, &info);
    v->devices = (camber_checked_devices){.list = calloc(count + 1, sizeof *v->devices.list)};
    if (status == CAMBER_OK && !v->devices.list)
        status = CAMBER_ERROR_MEMORY;
    return status == CAMBER_OK ? open_all(v) : status;
}

void camber_checked_devices_close(camber_checked_devices *devices) {
    for (size_t i = 0; i < devices->count; i++)
        close_device(&devices->list[i]);
    free(devices->list);
    *devices = (camber_checked_devices){0};
}
