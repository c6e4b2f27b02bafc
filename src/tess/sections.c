/* The sections of a network: spans of its points that are loaded to a device together.
 *
 * Input: a network, and the limits of the device. Output: the sections that a mesh holds, with buffers while they are
 * needed, and parts that begin as one a section. Main idea: a section is as many whole entries as fit the device's
 * largest buffer and an eighth of the bound on memory. It is uploaded when a part needs it and may be evicted
 * afterwards (memory.c). A device that works in host memory reads the network's own arrays, without a copy.
 *
 *     entries     | 0 | 1 | 2 | 3 | 4 | 5 | 6 |
 *     sections    |-- 0 ------|-- 1 ----------|
 *     parts       |-- 0 --|-1-|-- 2 --|-- 3 --|      cut where their output is too large */
#include "tess/network.h"

#include <string.h>

/* ---- Upload ---- */

void camber_section_release(const camber_mesh *mesh, camber_section *section) {
    camber_buffer **buffers[] = {
        &section->x,       &section->y,     &section->importance, &section->stretches, &section->chunk_stretches,
        &section->lengths, &section->totals};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        camber_buffer_release(mesh->device, buffers[i]);
    camber_section_count_bytes(mesh, section);
}

void camber_mesh_release_source(camber_mesh *mesh) {
    struct camber_held_network *held = mesh->held;
    camber_mesh_return_points(mesh);
    camber_mesh_release_polylines(mesh);
    if (!held)
        return;
    for (size_t i = 0; i < held->section_count; i++)
        camber_section_release(mesh, held->sections + i);
    camber_buffer_release(mesh->device, &held->counts);
    camber_buffer_release(mesh->device, &held->bases);
    camber_free(mesh->device->context, held->sections);
    camber_network_destroy(held->network);
    camber_free(mesh->device->context, held);
    mesh->held = NULL;
    mesh->serial = 0;
    camber_mesh_count_bytes(mesh);
}

/* Makes a buffer that the kernels read. is_kept: the bytes stay as they are for as long as the buffer lives, so that a
 * device that works in host memory can read them in place. */
static camber_status upload_array(const camber_device *device, const void *bytes, size_t size_bytes, bool is_kept,
                                  camber_buffer **buffer) {
    const camber_buffer_kind kind = device->host_memory && is_kept ? CAMBER_BUFFER_BORROWED : CAMBER_BUFFER_COPY;
    return camber_buffer_create(device, kind, size_bytes, bytes, buffer);
}

/* Uploads the stretch of each chunk's first point, counted from the section's first stretch. */
static camber_status upload_chunk_stretches(const camber_device *device, const camber_network *network,
                                            camber_section *section) {
    const size_t count = camber_network_chunk_count(section->end_point - section->first_point);
    uint32_t *chunk_stretches = camber_alloc(device->context, count, sizeof *chunk_stretches);
    if (!chunk_stretches)
        return CAMBER_ERROR_MEMORY;
    const camber_stretch *first = network->stretches + network->entry_stretches[section->first_entry], *run = first;
    for (size_t i = 0; i < count; i++) {
        while (run[1].first <= section->first_point + i * CAMBER_CULL_CHUNK)
            run++;
        chunk_stretches[i] = (uint32_t)(run - first);
    }
    const camber_status status = upload_array(device, chunk_stretches, 4 * count, false, &section->chunk_stretches);
    camber_free(device->context, chunk_stretches);
    return status;
}

camber_status camber_part_upload_section(camber_mesh *mesh, const camber_mesh_part *part) {
    const camber_device *device = mesh->device;
    const camber_network *network = mesh->held->network;
    camber_section *section = mesh->held->sections + part->section;
    if (section->x)
        return CAMBER_OK;
    const uint64_t size_bytes = camber_section_bytes(network, section, !device->host_memory);
    camber_status status = camber_mesh_make_room(mesh, part, size_bytes);
    if (status != CAMBER_OK)
        return status;
    const size_t first = section->first_point, points = section->end_point - first;
    const size_t first_run = network->entry_stretches[section->first_entry];
    const size_t stretches = network->entry_stretches[section->end_entry] - first_run + 1;
    status = upload_array(device, network->x + first, 4 * points, true, &section->x);
    if (status == CAMBER_OK)
        status = upload_array(device, network->y + first, 4 * points, true, &section->y);
    if (status == CAMBER_OK)
        status = upload_array(device, network->importance + first, 4 * points, true, &section->importance);
    if (status == CAMBER_OK)
        status = upload_array(device, network->stretches + first_run, stretches * sizeof *network->stretches, true,
                              &section->stretches);
    if (status == CAMBER_OK && network->lengths)
        status = upload_array(device, network->lengths + first, 4 * points, true, &section->lengths);
    if (status == CAMBER_OK && network->lengths)
        status = upload_array(device, network->totals + first_run, 4 * (stretches - 1), true, &section->totals);
    if (status == CAMBER_OK)
        status = upload_chunk_stretches(device, network, section);
    if (status == CAMBER_OK)
        camber_section_count_bytes(mesh, section);
    else
        camber_section_release(mesh, section);
    return status;
}

/* ---- Layout ---- */

static camber_section make_section(const camber_network *network, size_t first, size_t end) {
    return (camber_section){.first_entry = first,
                            .end_entry = end,
                            .first_point = camber_network_first_point(network, first),
                            .end_point = camber_network_first_point(network, end)};
}

/* Counts one stretch more than the section has: each ends where the next begins. */
static uint64_t bytes_of_stretches(const camber_network *network, const camber_section *section) {
    return ((uint64_t)network->entry_stretches[section->end_entry] - network->entry_stretches[section->first_entry] +
            1) *
           (sizeof(camber_stretch) + (network->lengths ? sizeof *network->totals : 0));
}

/* The size of the section's largest buffer. */
static uint64_t larger_bytes(const camber_network *network, const camber_section *section) {
    const uint64_t points = 4 * ((uint64_t)section->end_point - section->first_point);
    const uint64_t stretches = bytes_of_stretches(network, section);
    return points > stretches ? points : stretches;
}

uint64_t camber_section_bytes(const camber_network *network, const camber_section *section, bool copied) {
    const uint64_t points = (uint64_t)section->end_point - section->first_point;
    const uint64_t arrays = network->lengths ? 16 : 12;
    return (copied ? arrays * points + bytes_of_stretches(network, section) : 0) +
           4 * (uint64_t)camber_network_chunk_count((size_t)points);
}

/* Whether a section fits the device's buffers and its share of memory. */
static bool section_fits(const camber_mesh *mesh, const camber_section *section) {
    const camber_network *network = mesh->held->network;
    return larger_bytes(network, section) <= mesh->device->info.largest_buffer_bytes &&
           camber_section_bytes(network, section, true) <= camber_device_share(mesh->device, 1);
}

/* Returns the entry behind the last that fits into a section beginning with first; first itself where none does. */
static size_t find_section_end(const camber_mesh *mesh, size_t first) {
    const camber_network *network = mesh->held->network;
    size_t low = first, high = network->entry_count + 1;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        const camber_section section = make_section(network, first, middle);
        if (section_fits(mesh, &section))
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Fails because an entry alone is too large, and says for which limit. */
static camber_status fail_entry(const camber_mesh *mesh, size_t entry) {
    const camber_network *network = mesh->held->network;
    const camber_section section = make_section(network, entry, entry + 1);
    const uint64_t larger = larger_bytes(network, &section), all = camber_section_bytes(network, &section, true);
    return larger > mesh->device->info.largest_buffer_bytes ? camber_fail_polyline(mesh, entry, larger)
                                                            : camber_fail_memory(mesh, entry, 4 * all);
}

/* Divides the entries into sections, and adds a part for each that has points. */
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
        *section = make_section(network, first, end);
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
