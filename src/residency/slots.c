/* Finds the slots of polylines in a part. */
#include "residency/parts.h"

camber_projection camber_part_projection(const camber_mesh *mesh, const camber_mesh_part *part) {
    const size_t first = mesh->held->sections[part->section].first_point;
    camber_projection p = mesh->held->projection;
    p.first_point = (uint32_t)first;
    p.begin = (uint32_t)(part->first_point - first);
    p.end = (uint32_t)(part->end_point - first);
    return p;
}

/* Returns how many chunks the points of the projection have. The first and the last may be incomplete. */
size_t camber_projection_chunks(const camber_projection *p) {
    return camber_network_chunk_count(p->end) - p->begin / CAMBER_CULL_CHUNK;
}

/* Does camber_part_given_slot for a network. The host walks the polyline's chunk to count the slots before it. */
static size_t network_slot(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline) {
    const camber_projection p = camber_part_projection(mesh, part);
    const size_t point = camber_network_first_point(mesh->held->network, polyline);
    if (part->given_count == 0 || point >= part->end_point)
        return part->given_count ? part->chunk_bases[camber_projection_chunks(&p)] : 0;
    const size_t chunk = (point - p.first_point) / CAMBER_CULL_CHUNK, start = p.first_point + chunk * CAMBER_CULL_CHUNK;
    const size_t begin = start > part->first_point ? start : part->first_point;
    return part->chunk_bases[chunk - p.begin / CAMBER_CULL_CHUNK] +
           (size_t)camber_network_count_slots(mesh->held->network, &p, begin, point);
}

size_t camber_part_given_slot(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline) {
    return mesh->held ? network_slot(mesh, part, polyline) : mesh->first_slots[polyline] - part->first_slot;
}

size_t camber_part_slot(const camber_mesh *mesh, const camber_mesh_part *part, const uint32_t *places,
                        size_t polyline) {
    const size_t given = camber_part_given_slot(mesh, part, polyline);
    if (!mesh->has_offsets)
        return given;
    const bool is_behind = given >= part->given_count || polyline >= part->first_polyline + part->polyline_count;
    return is_behind ? part->used_slots : places[given];
}

camber_status camber_slot_finder_map(camber_slot_finder *finder) {
    const camber_mesh *mesh = finder->mesh;
    camber_status status = CAMBER_OK;
    if (mesh->has_offsets && !finder->places)
        status = camber_buffer_map(mesh->device, finder->part->source_line.places, CAMBER_MAP_READ,
                                   4 * finder->part->given_count, &finder->places);
    return status;
}

/* Whether a polyline begins where its part does. */
static bool is_first(const camber_slot_finder *finder, size_t polyline) {
    return polyline <= finder->part->first_polyline || finder->part->slot_count == 0;
}

/* Whether a polyline is the one after the part's last. */
static bool is_end(const camber_slot_finder *finder, size_t polyline) {
    return polyline >= finder->part->first_polyline + finder->part->polyline_count;
}

camber_status camber_slot_finder_find(camber_slot_finder *finder, size_t polyline, size_t *slot) {
    if (is_first(finder, polyline) || is_end(finder, polyline)) {
        *slot = is_first(finder, polyline) ? 0 : finder->part->used_slots;
        return CAMBER_OK;
    }
    const camber_status status = camber_slot_finder_map(finder);
    if (status == CAMBER_OK)
        *slot = camber_part_slot(finder->mesh, finder->part, finder->places, polyline);
    return status;
}

void camber_slot_finder_close(camber_slot_finder *finder) {
    if (finder->part)
        camber_buffer_unmap(finder->mesh->device, finder->part->source_line.places, finder->places);
    *finder = (camber_slot_finder){0};
}
