/* Frees meshes and stages that were read back, or made by the twin. */
#include "vertices/vertices.h"

void camber_mesh_data_destroy(camber_mesh_data *data) {
    camber_context *context = data->context;
    if (!context)
        return;
    camber_free(context, data->indices);
    camber_free(context, data->vertices);
    camber_free(context, data->corners);
    camber_free(context, data->arc_lengths);
    camber_free(context, data->records);
    *data = (camber_mesh_data){0};
}

void camber_stages_destroy(camber_stages *stages) {
    if (!stages->context)
        return;
    camber_free(stages->context, stages->arc_lengths);
    camber_free(stages->context, stages->points);
    *stages = (camber_stages){0};
}
