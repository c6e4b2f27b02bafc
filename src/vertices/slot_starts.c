/* Finds where the output of polylines begins in a part. For the first slot of each work-item's chunk, the scan stores
 * where its vertices and indices begin within the block. From there the host goes on counting, from the join words. */
#include "vertices/vertices.h"

#include "kernels/join.h"

/* Maps words of a buffer. Does nothing after an earlier failure, so that calls can follow each other. */
static const uint32_t *map(const camber_mesh *mesh, camber_buffer *buffer, size_t count, camber_status *status) {
    const uint32_t *words = NULL;
    if (*status == CAMBER_OK)
        *status = camber_buffer_map(mesh->device, buffer, CAMBER_MAP_READ, 4 * count, &words);
    return words;
}

camber_status camber_slot_starts_map(camber_slot_starts *starts) {
    const camber_mesh *mesh = starts->finder.mesh;
    const camber_mesh_part *part = starts->finder.part;
    const size_t slots = part->slot_count, chunk_slots = mesh->device->point_chunk;
    camber_status status = CAMBER_OK;
    if (slots == 0 || starts->joins)
        return CAMBER_OK;
    starts->at = SIZE_MAX;
    starts->joins = map(mesh, part->joins, slots + 1, &status);
    starts->info = map(mesh, part->info, slots + 1, &status);
    starts->offsets = map(mesh, part->offsets, (slots - 1) / chunk_slots + 1, &status);
    if (status == CAMBER_OK)
        status = camber_slot_finder_map(&starts->finder);
    if (status != CAMBER_OK)
        camber_slot_starts_unmap(starts);
    return status;
}

void camber_slot_starts_unmap(camber_slot_starts *starts) {
    const camber_mesh_part *part = starts->finder.part;
    if (!part)
        return;
    camber_buffer_unmap(starts->finder.mesh->device, part->offsets, starts->offsets);
    camber_buffer_unmap(starts->finder.mesh->device, part->info, starts->info);
    camber_buffer_unmap(starts->finder.mesh->device, part->joins, starts->joins);
    camber_slot_finder_close(&starts->finder);
    *starts = (camber_slot_starts){0};
}

uint32_t camber_slot_starts_before(camber_slot_starts *starts, size_t slot) {
    const size_t chunk_slots = starts->finder.mesh->device->point_chunk, chunk = slot / chunk_slots;
    if (slot < starts->at || chunk * chunk_slots > starts->at) {
        starts->at = chunk * chunk_slots;
        starts->sum = starts->offsets[chunk];
    }
    for (; starts->at < slot; starts->at++) {
        const size_t word = starts->at + 1;
        starts->sum += camber_join_counts(starts->joins[word], starts->joins[word - 1], starts->info[word],
                                          (camber_u32)starts->finder.mesh->mesh_info.method);
    }
    return starts->sum;
}

size_t camber_slot_starts_slot(const camber_slot_starts *starts, size_t polyline) {
    return camber_part_slot(starts->finder.mesh, starts->finder.part, starts->finder.places, polyline);
}

/* Whether a polyline begins where its part does, and whether it is the one after the part's last. */
static bool is_first(const camber_slot_starts *starts, size_t polyline) {
    return polyline <= starts->finder.part->first_polyline || starts->finder.part->slot_count == 0;
}

static bool is_end(const camber_slot_starts *starts, size_t polyline) {
    return polyline >= starts->finder.part->first_polyline + starts->finder.part->polyline_count;
}

camber_status camber_slot_starts_index(camber_slot_starts *starts, size_t polyline, uint64_t *index) {
    const camber_mesh_part *part = starts->finder.part;
    if (is_first(starts, polyline) || is_end(starts, polyline)) {
        *index = is_first(starts, polyline) ? 0 : part->index_count;
        return CAMBER_OK;
    }
    const camber_status status = camber_slot_starts_map(starts);
    if (status != CAMBER_OK)
        return status;
    const size_t slot = camber_slot_starts_slot(starts, polyline);
    const uint32_t packed = slot < part->slot_count ? camber_slot_starts_before(starts, slot) : 0;
    *index = part->host_bases[2 * (slot / starts->finder.mesh->device->block) + 1] + (packed >> 16);
    return CAMBER_OK;
}

camber_status camber_slot_starts_record(camber_slot_starts *starts, size_t polyline, size_t *record) {
    const camber_mesh *mesh = starts->finder.mesh;
    uint64_t index = 0;
    if (is_first(starts, polyline) || is_end(starts, polyline)) {
        *record = is_first(starts, polyline) ? 0 : starts->finder.part->record_count;
        return CAMBER_OK;
    }
    camber_status status = camber_slot_starts_index(starts, polyline, &index);
    if (status == CAMBER_OK)
        *record = mesh->mesh_info.strips ? (size_t)index / 2 : camber_slot_starts_slot(starts, polyline);
    return status;
}
