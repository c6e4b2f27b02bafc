/* Sections of a network, and their upload to a device. */
#include "points/section.h"

void camber_section_release(const camber_device *device, camber_section *section) {
    camber_buffer **buffers[] = {
        &section->x,       &section->y,     &section->importance, &section->stretches, &section->chunk_stretches,
        &section->lengths, &section->totals};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        camber_buffer_release(device, buffers[i]);
}

/* Makes a buffer that the kernels read. is_kept: the bytes stay valid and unchanged as long as the buffer lives, so
 * that a device that uses host memory can borrow them (zero copy). */
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

camber_status camber_section_upload(const camber_device *device, const camber_network *network,
                                    camber_section *section) {
    const size_t first = section->first_point, points = section->end_point - first;
    const size_t first_run = network->entry_stretches[section->first_entry];
    const size_t stretches = network->entry_stretches[section->end_entry] - first_run + 1;
    camber_status status = upload_array(device, network->x + first, 4 * points, true, &section->x);
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
    if (status != CAMBER_OK)
        camber_section_release(device, section);
    return status;
}

camber_section camber_section_of(const camber_network *network, size_t first, size_t end) {
    return (camber_section){.first_entry = first,
                            .end_entry = end,
                            .first_point = camber_network_first_point(network, first),
                            .end_point = camber_network_first_point(network, end)};
}

/* Counts one stretch more than the section has, because each ends where the next begins. */
static uint64_t bytes_of_stretches(const camber_network *network, const camber_section *section) {
    return ((uint64_t)network->entry_stretches[section->end_entry] - network->entry_stretches[section->first_entry] +
            1) *
           (sizeof(camber_stretch) + (network->lengths ? sizeof *network->totals : 0));
}

uint64_t camber_section_largest_bytes(const camber_network *network, const camber_section *section) {
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
