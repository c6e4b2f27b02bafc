/* Counts joins, segments and records. */
#include "vertices/vertices.h"

#include "kernels/join.h"

size_t camber_records_max(camber_method method) {
    return method == CAMBER_METHOD_STRIP ? (size_t)1 << 30 : (size_t)1 << (32 - CAMBER_CORNER_BITS);
}

camber_status camber_fail_records(camber_context *context, camber_method method) {
    return camber_fail(context, CAMBER_ERROR_LIMIT,
                       "more than the %zu records that 32 bits number for method %s; tessellate in parts",
                       camber_records_max(method), camber_method_get_name(method));
}

void camber_mesh_info_add_join(camber_mesh_info *info, uint32_t join, uint32_t point) {
    const uint32_t kind = camber_join_kind(join);
    info->undrawn_dots +=
        kind == CAMBER_KIND_SENTINEL && (point & (CAMBER_POINT_REAL | CAMBER_POINT_AREA)) == CAMBER_POINT_REAL;
    /* A ring's seam is one join, although two points have its word: it is counted at the last point. */
    if (kind < CAMBER_KIND_CUT || kind > CAMBER_KIND_SPLIT || point & CAMBER_POINT_FIRST)
        return;
    info->joins++;
    info->tight_joins += kind == CAMBER_KIND_TIGHT;
    info->split_joins += kind == CAMBER_KIND_SPLIT;
}

/* Adds up the joins of slots, from their join and info words, and returns how many segments they have. */
static size_t count_words(const uint32_t *joins, const uint32_t *info, size_t slot_count, camber_mesh_info *counts) {
    size_t segments = 0;
    for (size_t i = 1; i <= slot_count; i++) {
        camber_mesh_info_add_join(counts, joins[i], info[i]);
        segments += (info[i] & (CAMBER_POINT_REAL | CAMBER_POINT_FIRST | CAMBER_POINT_AREA)) == CAMBER_POINT_REAL;
        segments += camber_join_kind(joins[i]) == CAMBER_KIND_DOT;
    }
    return segments;
}

camber_status camber_part_count_joins(const camber_mesh *mesh, const camber_mesh_part *part, camber_mesh_info *counts) {
    const camber_device *device = mesh->device;
    const size_t size_bytes = 4 * (part->slot_count + 2);
    const uint32_t *joins = NULL, *info = NULL;
    size_t segments = 0;
    if (part->slot_count == 0)
        return CAMBER_OK;
    camber_status status = camber_buffer_map(device, part->joins, CAMBER_MAP_READ, size_bytes, &joins);
    if (status == CAMBER_OK)
        status = camber_buffer_map(device, part->info, CAMBER_MAP_READ, size_bytes, &info);
    if (status == CAMBER_OK)
        segments = count_words(joins, info, part->slot_count, counts);
    counts->triangle_count += counts->strips ? 2 * segments : part->index_count / 3;
    camber_buffer_unmap(device, part->info, info);
    camber_buffer_unmap(device, part->joins, joins);
    return status;
}
