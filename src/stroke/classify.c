/* Runs kernels over the points of a part, among them classify, which computes the join word of each point. */
#include "stroke/stroke.h"

camber_status camber_mesh_program(camber_mesh *mesh, camber_method method, camber_program **program) {
    const camber_program_desc desc = {method, mesh->mesh_info.has_arc_length, mesh->round_limits};
    return camber_device_program(mesh->device, desc, program);
}

camber_status camber_part_run(camber_mesh *mesh, const camber_mesh_part *part, camber_launch launch,
                              camber_stage_id stage) {
    const camber_device *device = mesh->device;
    camber_event *event = NULL;
    launch.work_items = part->slot_count / device->point_chunk;
    launch.group_size = device->block / device->point_chunk;
    camber_status status = camber_launch_kernel(device, &launch, &event);
    if (status == CAMBER_OK)
        status = camber_event_wait(device, event, launch.name);
    camber_mesh_add_time(mesh, stage, event);
    return status;
}

camber_status camber_part_classify(camber_mesh *mesh, camber_mesh_part *part, camber_method method) {
    camber_program *program = NULL;
    camber_status status = camber_mesh_program(mesh, method, &program);
    if (status != CAMBER_OK)
        return status;
    const camber_kernel_arg args[] = {
        CAMBER_ARG_BUFFER(part->x),    CAMBER_ARG_BUFFER(part->y),    CAMBER_ARG_BUFFER(part->x),
        CAMBER_ARG_BUFFER(part->y),    CAMBER_ARG_BUFFER(part->x),    CAMBER_ARG_BUFFER(part->y),
        CAMBER_ARG_BUFFER(part->info), CAMBER_ARG_BUFFER(part->info), CAMBER_ARG_BUFFER(part->info),
        CAMBER_ARG_BUFFER(mesh->rows), CAMBER_ARG_BUFFER(part->joins)};
    status = camber_part_run(
        mesh, part, (camber_launch){.name = "classify", .kernel = program->classify, .args = args, .arg_count = 11},
        CAMBER_STAGE_CLASSIFY);
    part->has_joins = status == CAMBER_OK;
    part->classified = method;
    part->made = part->made && status == CAMBER_OK;
    return status;
}
