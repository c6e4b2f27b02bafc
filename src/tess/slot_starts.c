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

void camber_slot_starts_unmap(camber_slot_starts *o) {
    unmap(o->mesh, o->part->offsets, o->offsets);
    unmap(o->mesh, o->part->info, o->info);
    unmap(o->mesh, o->part->joins, o->joins);
    o->joins = o->info = o->offsets = NULL;
}

uint32_t camber_slot_starts_before(camber_slot_starts *o, size_t slot) {
    const size_t chunk_slots = o->mesh->device->point_chunk, chunk = slot / chunk_slots;
    if (slot < o->at || chunk * chunk_slots > o->at) {
        o->at = chunk * chunk_slots;
        o->sum = o->offsets[chunk - o->first_chunk];
    }
    for (; o->at < slot; o->at++) {
        const size_t word = o->at - o->first + 1;
        o->sum += camber_join_counts(o->joins[word], o->joins[word - 1], o->info[word],
                                     (camber_u32)o->mesh->mesh_info.method);
    }
    return o->sum;
}
