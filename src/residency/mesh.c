/* Creates and destroys meshes. */
#include "residency/memory.h"
#include "residency/parts.h"

camber_status camber_mesh_create_on(camber_device *device, const camber_shared_buffer_ops *ops, void *ops_user,
                                    const camber_mesh_output *output, camber_mesh **mesh) {
    const camber_status status = camber_check_process(device->context);
    camber_mesh *made = status == CAMBER_OK ? camber_alloc_zero(device->context, 1, sizeof *made) : NULL;
    if (!made)
        return status == CAMBER_OK ? CAMBER_ERROR_MEMORY : status;
    made->device = device;
    made->ops = ops ? ops : &camber_shared_buffer_plain;
    made->ops_user = ops ? ops_user : device;
    made->output = output;
    made->buffer_copies = 1;
    made->empty = true;
    made->next = device->meshes;
    device->meshes = made;
    *mesh = made;
    return CAMBER_OK;
}

camber_status camber_mesh_get_companion(camber_mesh *mesh, camber_mesh **companion) {
    if (!mesh->companion) {
        camber_mesh *made;
        const camber_status status =
            camber_mesh_create_on(mesh->device, mesh->ops, mesh->ops_user, mesh->output, &made);
        if (status != CAMBER_OK)
            return status;
        made->owner = mesh->owner;
        made->buffer_copies = mesh->buffer_copies;
        mesh->companion = made;
    }
    *companion = mesh->companion;
    return CAMBER_OK;
}

void camber_mesh_destroy(camber_mesh *mesh) {
    if (!mesh)
        return;
    camber_context *context = mesh->device->context;
    camber_mesh_destroy(mesh->companion);
    camber_mesh_return_points(mesh);
    camber_mesh_release_parts(mesh);
    camber_mesh_release_source(mesh);
    camber_buffer_release(mesh->device, &mesh->rows);
    camber_buffer_release(mesh->device, &mesh->offset_rows);
    camber_mesh **link = &mesh->device->meshes;
    while (*link != mesh)
        link = &(*link)->next;
    *link = mesh->next;
    camber_free(context, mesh->host_rows);
    mesh->row_capacity = mesh->host_row_capacity = mesh->offset_row_capacity = 0;
    camber_mesh_count_bytes(mesh);
    camber_free(context, mesh->polyline_rows);
    camber_free(context, mesh->first_slots);
    camber_free(context, mesh);
}

camber_mesh_info camber_mesh_get_info(const camber_mesh *mesh) {
    return mesh->mesh_info;
}

void camber_mesh_add_time(camber_mesh *mesh, camber_stage_id stage, camber_event *event) {
    double ms = 0.0;
    camber_event_end(mesh->device, event, &ms);
    if (event)
        camber_stage_times_add(&mesh->mesh_info.times, stage, ms);
}
