/* Where a slot's vertices and indices begin within its block: what scan left for the run of slots that a work-item
 * took, and from there on the counts again. */
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

camber_status camber_offsets_map(const camber_mesh *mesh, const camber_mesh_part *part, size_t first, size_t end,
                                 camber_offsets *offsets) {
    const size_t item = mesh->device->item, run = first / item, slot = run * item, words = end - slot + 1;
    camber_status status = CAMBER_OK;
    camber_offsets o = {.mesh = mesh, .part = part, .first = slot, .first_run = run, .at = SIZE_MAX};
    o.joins = map(mesh, part->joins, slot, words, &status);
    o.info = map(mesh, part->info, slot, words, &status);
    o.offsets = map(mesh, part->offsets, run, (end - 1) / item - run + 1, &status);
    if (status == CAMBER_OK)
        *offsets = o;
    else
        camber_offsets_unmap(&o);
    return status;
}

void camber_offsets_unmap(camber_offsets *o) {
    unmap(o->mesh, o->part->offsets, o->offsets);
    unmap(o->mesh, o->part->info, o->info);
    unmap(o->mesh, o->part->joins, o->joins);
    o->joins = o->info = o->offsets = NULL;
}

uint32_t camber_offset_before(camber_offsets *o, size_t slot) {
    const size_t item = o->mesh->device->item, run = slot / item;
    if (slot < o->at || run * item > o->at) {
        o->at = run * item;
        o->sum = o->offsets[run - o->first_run];
    }
    for (; o->at < slot; o->at++) {
        const size_t word = o->at - o->first + 1;
        o->sum += camber_join_counts(o->joins[word], o->joins[word - 1], o->info[word],
                                     (camber_u32)o->mesh->mesh_info.method);
    }
    return o->sum;
}
