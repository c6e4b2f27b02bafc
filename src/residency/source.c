/* The source of a mesh: polylines, or a network with its sections.
 *
 * Input: a source, and the limits of the device. Output: the parts of the mesh, which holds the source as long as parts
 * may have to be made again. Main idea: a section is as many whole entries of a network as fit into the device's
 * largest buffer and an eighth of the memory limit. At first there is one part per section.
 *
 *     entries     | 0 | 1 | 2 | 3 | 4 | 5 | 6 |
 *     sections    |-- 0 ------|-- 1 ----------|
 *     parts       |-- 0 --|-1-|-- 2 --|-- 3 --|      halved if too large */
#include "residency/memory.h"
#include "residency/parts.h"

#include <string.h>

/* ---- Polylines ---- */

/* Holds the polylines, unless the mesh does so already. Only the count of holders changes, not the polylines. */
static void hold_polylines(camber_mesh *mesh, const camber_polylines *polylines) {
    if (!mesh->holds_polylines)
        camber_polylines_hold((camber_polylines *)(uintptr_t)polylines);
    mesh->holds_polylines = true;
    mesh->polylines = polylines;
}

static void release_polylines(camber_mesh *mesh) {
    if (mesh->holds_polylines)
        camber_polylines_destroy((camber_polylines *)(uintptr_t)mesh->polylines);
    mesh->holds_polylines = false;
    mesh->polylines = NULL;
}

void camber_mesh_let_go(camber_mesh *mesh) {
    const bool borrowed = mesh->part_count > 0 && mesh->parts[0].borrowed;
    if (mesh->device->memory_bytes == 0 && !borrowed)
        release_polylines(mesh);
}

void camber_mesh_release_source(camber_mesh *mesh) {
    struct camber_held_network *held = mesh->held;
    camber_mesh_return_points(mesh);
    release_polylines(mesh);
    if (!held)
        return;
    for (size_t i = 0; i < held->section_count; i++) {
        camber_section_release(mesh->device, held->sections + i);
        camber_section_count_bytes(mesh, held->sections + i);
    }
    camber_buffer_release(mesh->device, &held->counts);
    camber_buffer_release(mesh->device, &held->bases);
    camber_free(mesh->device->context, held->sections);
    camber_network_destroy(held->network);
    camber_free(mesh->device->context, held);
    mesh->held = NULL;
    mesh->serial = 0;
    camber_mesh_count_bytes(mesh);
}

camber_status camber_mesh_plan(camber_mesh *mesh, const camber_polylines *polylines) {
    camber_context *context = mesh->device->context;
    const size_t count = polylines->polyline_count;
    if (mesh->serial == polylines->serial) {
        hold_polylines(mesh, polylines);
        return CAMBER_OK;
    }
    camber_mesh_release_source(mesh);
    mesh->serial = mesh->part_count = mesh->polyline_count = 0;
    hold_polylines(mesh, polylines);
    if (!camber_grow(context, &mesh->first_slots, &mesh->polyline_capacity, count + 1, sizeof *mesh->first_slots) ||
        !camber_grow(context, &mesh->polyline_rows, &mesh->row_list_capacity, count, sizeof *mesh->polyline_rows))
        return CAMBER_ERROR_MEMORY;
    memcpy(mesh->first_slots, polylines->first_slots, (count + 1) * sizeof *mesh->first_slots);
    if (count)
        memcpy(mesh->polyline_rows, polylines->polyline_rows, count * sizeof *mesh->polyline_rows);
    mesh->polyline_count = count;
    mesh->row_count = polylines->row_count;
    const camber_status status = camber_mesh_lay_out_parts(mesh);
    if (status == CAMBER_OK)
        mesh->serial = polylines->serial;
    return status;
}

/* ---- Networks ---- */

/* Whether a section fits into the device's buffers and its share of memory. */
static bool section_fits(const camber_mesh *mesh, const camber_section *section) {
    const camber_network *network = mesh->held->network;
    return camber_section_largest_bytes(network, section) <= mesh->device->info.largest_buffer_bytes &&
           camber_section_bytes(network, section, true) <= camber_device_share(mesh->device, 1);
}

/* Returns the end (exclusive) of the entries that fit into a section that begins with first; first itself if none does.
 */
static size_t find_section_end(const camber_mesh *mesh, size_t first) {
    const camber_network *network = mesh->held->network;
    size_t low = first, high = network->entry_count + 1;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        const camber_section section = camber_section_of(network, first, middle);
        if (section_fits(mesh, &section))
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Fails because a single entry is too large, and says for which limit. */
static camber_status fail_entry(const camber_mesh *mesh, size_t entry) {
    const camber_network *network = mesh->held->network;
    const camber_section section = camber_section_of(network, entry, entry + 1);
    const uint64_t larger = camber_section_largest_bytes(network, &section),
                   all = camber_section_bytes(network, &section, true);
    return larger > mesh->device->info.largest_buffer_bytes ? camber_fail_polyline(mesh, entry, larger)
                                                            : camber_fail_memory(mesh, entry, 4 * all);
}

/* Divides the entries into sections, and adds a part for each section that has points. */
static camber_status lay_out_sections(camber_mesh *mesh) {
    struct camber_held_network *held = mesh->held;
    const camber_network *network = held->network;
    const size_t count = network->point_count ? network->entry_count : 0;
    for (size_t first = 0; first < count;) {
        const size_t end = find_section_end(mesh, first);
        if (end == first)
            return fail_entry(mesh, first);
        if (!camber_grow(mesh->device->context, &held->sections, &held->section_capacity, held->section_count + 1,
                         sizeof *held->sections))
            return CAMBER_ERROR_MEMORY;
        camber_section *section = held->sections + held->section_count++;
        *section = camber_section_of(network, first, end);
        first = end;
        if (section->first_point == section->end_point)
            continue;
        const camber_status status = camber_mesh_add_part(mesh, section->first_entry, section->end_entry);
        if (status != CAMBER_OK)
            return status;
    }
    return CAMBER_OK;
}

/* Holds the network, copies its rows, and lays out sections and parts. */
static camber_status hold_network(camber_mesh *mesh, camber_network *network) {
    camber_context *context = mesh->device->context;
    const size_t count = network->entry_count;
    if (!camber_grow(context, &mesh->polyline_rows, &mesh->row_list_capacity, count, sizeof *mesh->polyline_rows) ||
        !(mesh->held = camber_alloc_zero(context, 1, sizeof *mesh->held)))
        return CAMBER_ERROR_MEMORY;
    mesh->held->network = network;
    camber_network_hold(network);
    if (count)
        memcpy(mesh->polyline_rows, network->entry_rows, count * sizeof *mesh->polyline_rows);
    mesh->polyline_count = count;
    mesh->row_count = network->row_count;
    return lay_out_sections(mesh);
}

camber_status camber_mesh_plan_network(camber_mesh *mesh, camber_network *network) {
    if (mesh->serial == network->serial) {
        camber_mesh_compact_parts(mesh);
        return CAMBER_OK;
    }
    camber_mesh_release_source(mesh);
    mesh->serial = mesh->part_count = mesh->polyline_count = 0;
    const camber_status status = hold_network(mesh, network);
    if (status != CAMBER_OK) {
        camber_mesh_release_source(mesh);
        mesh->part_count = 0;
        return status;
    }
    camber_mesh_trim_parts(mesh);
    mesh->serial = network->serial;
    return CAMBER_OK;
}

camber_status camber_mesh_aim(camber_mesh *mesh, const camber_camera *camera, const camber_tessellation_desc *desc) {
    const camber_status status = camber_network_aim(mesh->held->network, camera, desc, &mesh->held->projection);
    return status == CAMBER_OK ? camber_device_network_program(mesh->device, desc->has_arc_length,
                                                               camera->pitch_deg > 0.0, &mesh->held->program)
                               : status;
}

bool camber_mesh_holds_network(const camber_mesh *mesh, const camber_network *network) {
    return mesh->done && mesh->serial == network->serial;
}
