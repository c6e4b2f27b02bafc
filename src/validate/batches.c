#include "validate/batches.h"

typedef struct batches {
    size_t count;
    uint32_t least, most; /* vertices of the current batch */
    uint32_t vertices_max;
} batches;

static void put_triangle(batches *b, const uint32_t *corners) {
    uint32_t least = corners[0], most = corners[0];
    for (int i = 1; i < 3; i++) {
        least = corners[i] < least ? corners[i] : least;
        most = corners[i] > most ? corners[i] : most;
    }
    const uint32_t both_least = least < b->least ? least : b->least, both_most = most > b->most ? most : b->most;
    if (b->count > 0 && both_most - both_least < b->vertices_max) {
        b->least = both_least;
        b->most = both_most;
        return;
    }
    b->count++;
    b->least = least;
    b->most = most;
}

size_t camber_batches_count(const camber_mesh_data *mesh, uint32_t vertices_max) {
    batches b = {.vertices_max = vertices_max};
    const uint32_t *indices = mesh->indices;
    for (size_t i = 0; i + 3 <= mesh->info.index_count; i++)
        if (camber_mesh_data_draws(mesh, i))
            put_triangle(&b, indices + i);
    return b.count;
}
