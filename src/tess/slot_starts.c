/* Where a slot's vertices and indices begin within its block. The scan stores this only for the first slot of each
 * chunk that a work-item took. From there on the host counts again, from the join words. */
#include "tess/mesh.h"

#include "kernels/join.h"

static cl_uint *map(const camber_mesh *mesh, cl_mem mem, size_t first, size_t count, camber_status *status) {
    cl_int code = CL_SUCCESS;
    void *bytes = *status != CAMBER_OK ? NULL
                                       : clEnqueueMapBuffer(mesh->device->queue, mem, CL_TRUE, CL_MAP_READ, 4 * first,
                                                            4 * count, 0, NULL, NULL, &code);
    if (code != CL_SUCCESS)
        *status = camber_fail_cl(mesh->device->context, "clEnqueueMapBuffer", code);
    return code == CL_SUCCESS ? bytes : NULL;
}

static void unmap(const camber_mesh *mesh, cl_mem mem, cl_uint *words) {
    if (words)
        clEnqueueUnmapMemObject(mesh->device->queue, mem, words, 0, NULL, NULL);
}

camber_status camber_slot_starts_map(const camber_mesh *mesh, const camber_mesh_part *part, size_t first, size_t end,
                                     camber_slot_starts *starts) {
    const size_t chunk_slots = mesh->device->point_chunk, chunk = first / chunk_slots, slot = chunk * chunk_slots,
                 words = end - slot + 1;
    camber_status status = CAMBER_OK;
    camber_slot_starts o = {.mesh = mesh, .part = part, .first = slot, .first_chunk = chunk, .at = SIZE_MAX};
    o.joins = map(mesh, part->joins, slot, words, &status);
    o.info = map(mesh, part->info, slot, words, &status);
    o.offsets = map(mesh, part->offsets, chunk, (end - 1) / chunk_slots - chunk + 1, &status);
    if (status == CAMBER_OK)
        *starts = o;
    else
        camber_slot_starts_unmap(&o);
    return status;
}

void camber_slot_starts_unmap(camber_slot_starts *starts) {
    unmap(starts->mesh, starts->part->offsets, starts->offsets);
    unmap(starts->mesh, starts->part->info, starts->info);
    unmap(starts->mesh, starts->part->joins, starts->joins);
    starts->joins = starts->info = starts->offsets = NULL;
}

uint32_t camber_slot_starts_before(camber_slot_starts *starts, size_t slot) {
    const size_t chunk_slots = starts->mesh->device->point_chunk, chunk = slot / chunk_slots;
    if (slot < starts->at || chunk * chunk_slots > starts->at) {
        starts->at = chunk * chunk_slots;
        starts->sum = starts->offsets[chunk - starts->first_chunk];
    }
    for (; starts->at < slot; starts->at++) {
        const size_t word = starts->at - starts->first + 1;
        starts->sum += camber_join_counts(starts->joins[word], starts->joins[word - 1], starts->info[word],
                                          (camber_u32)starts->mesh->mesh_info.method);
    }
    return starts->sum;
}
