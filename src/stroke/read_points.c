/* Reads the points of a part back to the host. */
#include "stroke/stroke.h"

/* Reads words of a buffer into a new array. Does nothing after an earlier failure. */
static void read_words(const camber_mesh *mesh, camber_buffer *buffer, size_t words, void *array,
                       camber_status *status) {
    void **made = array;
    if (*status == CAMBER_OK && !(*made = camber_alloc(mesh->device->context, words, 4)))
        *status = CAMBER_ERROR_MEMORY;
    if (*status == CAMBER_OK)
        *status = camber_buffer_read(mesh->device, buffer, 4 * words, *made);
}

camber_status camber_part_read_points(camber_mesh *mesh, camber_mesh_part *part, camber_part_points *points) {
    camber_part_points made = {0};
    camber_status status = camber_part_ensure_points(mesh, part);
    const size_t words = part->slot_count + 2;
    read_words(mesh, part->x, words, &made.x, &status);
    read_words(mesh, part->y, words, &made.y, &status);
    read_words(mesh, part->info, words, &made.info, &status);
    read_words(mesh, part->joins, words, &made.joins, &status);
    if (mesh->mesh_info.has_arc_length)
        read_words(mesh, part->arc_lengths, 2 * part->slot_count, &made.arc_lengths, &status);
    if (status == CAMBER_OK)
        *points = made;
    else
        camber_part_points_free(mesh->device->context, &made);
    return status;
}

void camber_part_points_free(camber_context *context, camber_part_points *points) {
    camber_free(context, points->x);
    camber_free(context, points->y);
    camber_free(context, points->info);
    camber_free(context, points->joins);
    camber_free(context, points->arc_lengths);
    *points = (camber_part_points){0};
}
