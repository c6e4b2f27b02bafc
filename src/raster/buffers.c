/* The rasterizer's buffers on the device: counts their bytes, writes to them and reads them back. */
#include "raster/rasterizer.h"

#include <string.h>

/* The bytes that buffers of each kind may take if there is no memory limit. */
static const uint64_t MOST_BYTES = 256 * 1024 * 1024;

camber_status camber_raster_create(camber_device *device, camber_raster **raster) {
    camber_raster *made = camber_alloc_zero(device->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->device = device;
    camber_drawing_open(device, &made->memory);
    *raster = made;
    return CAMBER_OK;
}

void camber_raster_destroy(camber_raster *raster) {
    if (!raster)
        return;
    for (int i = 0; i < BUFFERS; i++)
        camber_buffer_release(raster->device, &raster->buffers[i]);
    camber_drawing_close(raster->device, &raster->memory);
    camber_free(raster->device->context, raster->setups);
    camber_free(raster->device->context, raster->jobs);
    camber_free(raster->device->context, raster->spills);
    camber_free(raster->device->context, raster->starts);
    camber_free(raster->device->context, raster);
}

camber_raster_times camber_raster_get_times(const camber_raster *raster) {
    return (camber_raster_times){raster->ms[STAGE_SETUP],    raster->ms[STAGE_BIN_COUNT],
                                 raster->ms[STAGE_BIN_SCAN], raster->ms[STAGE_BIN_SCATTER],
                                 raster->ms[STAGE_WIND],     raster->ms[STAGE_RASTERIZE]};
}

uint32_t camber_raster_slice_count(const camber_raster *raster) {
    return raster->slice_count;
}

/* ---- Buffers ---- */

/* Adds up the bytes of all buffers except the picture's. */
static void count_buffers(camber_raster *raster) {
    uint64_t bytes = 0;
    for (int i = 0; i < BUFFERS; i++)
        bytes += i == BUFFER_PIXELS ? 0 : raster->capacities[i];
    camber_drawing_count_bytes(raster->device, &raster->memory, bytes);
}

uint64_t camber_raster_most_bytes(const camber_raster *raster, camber_raster_eighths eighths) {
    const uint64_t largest = raster->device->info.largest_buffer_bytes;
    const uint64_t most = largest < MOST_BYTES ? largest : MOST_BYTES;
    const uint64_t share = raster->memory.allowed_bytes / 8 * eighths;
    return share && share < most ? share : most;
}

uint32_t camber_raster_widest(const camber_raster *raster) {
    const uint64_t planes = CAMBER_SPILL_PLANES * CAMBER_TILE_PX * CAMBER_TILE_PX,
                   states = camber_raster_state_words(raster);
    const uint64_t a_tile = 4 * (states + planes + camber_raster_area_words(raster));
    const uint64_t tiles = camber_raster_most_bytes(raster, CAMBER_RASTER_SPILLS) / a_tile,
                   widest = tiles < CAMBER_TILES_MAX ? tiles : CAMBER_TILES_MAX;
    return CAMBER_TILE_PX * (widest ? (uint32_t)widest : 1);
}

void camber_raster_drop(camber_raster *raster, int which) {
    camber_buffer_release(raster->device, &raster->buffers[which]);
    raster->capacities[which] = 0;
    count_buffers(raster);
}

void camber_raster_trim(camber_raster *raster) {
    for (int i = 0; i < BUFFERS; i++)
        camber_raster_drop(raster, i);
}

camber_status camber_raster_reserve(camber_raster *raster, int which, size_t size_bytes) {
    const camber_device *device = raster->device;
    if (size_bytes <= raster->capacities[which])
        return CAMBER_OK;
    if (size_bytes > device->info.largest_buffer_bytes)
        return camber_fail(device->context, CAMBER_ERROR_LIMIT,
                           "drawing takes a buffer of %zu bytes, and %s makes none above %llu; draw less at once",
                           size_bytes, device->info.name, (unsigned long long)device->info.largest_buffer_bytes);
    camber_raster_drop(raster, which);
    const size_t more = size_bytes + size_bytes / 4;
    const bool is_roomy = !raster->memory.allowed_bytes && more < device->info.largest_buffer_bytes;
    const size_t room = is_roomy ? more : size_bytes;
    const camber_buffer_kind kind = which == BUFFER_PIXELS ? CAMBER_BUFFER_READ_BACK : CAMBER_BUFFER_OWN;
    const camber_status status = camber_buffer_create(device, kind, room, NULL, &raster->buffers[which]);
    if (status != CAMBER_OK)
        return status;
    raster->capacities[which] = room;
    count_buffers(raster);
    return CAMBER_OK;
}

camber_status camber_raster_put(camber_raster *raster, int which, const void *bytes, size_t size_bytes) {
    const camber_status status = camber_raster_reserve(raster, which, size_bytes);
    return status == CAMBER_OK ? camber_buffer_write_later(raster->device, raster->buffers[which], 0, size_bytes, bytes)
                               : status;
}

/* ---- Pixels ---- */

/* Returns the buffer that the last area was drawn into. */
static camber_buffer *pixels_of(const camber_raster *raster) {
    return raster->given ? raster->given : raster->buffers[BUFFER_PIXELS];
}

camber_status camber_raster_map(camber_raster *raster, camber_raster_pixels *pixels) {
    const size_t row_bytes = 4 * camber_raster_stride_px(&raster->area);
    const uint8_t *rgba;
    const camber_status status =
        camber_buffer_map(raster->device, pixels_of(raster), CAMBER_MAP_READ, row_bytes * raster->area.height, &rgba);
    if (status == CAMBER_OK)
        *pixels = (camber_raster_pixels){rgba, row_bytes};
    return status;
}

void camber_raster_unmap(camber_raster *raster, camber_raster_pixels pixels) {
    camber_buffer_unmap(raster->device, pixels_of(raster), pixels.rgba);
    raster->given = NULL; /* the caller may now free it */
}

/* ---- Stages, read back ---- */

static camber_status get(camber_raster *raster, int which, size_t size_bytes, void *copy) {
    const camber_device *device = raster->device;
    void **bytes = copy;
    *bytes = camber_alloc(device->context, size_bytes, 1);
    if (!*bytes)
        return CAMBER_ERROR_MEMORY;
    return camber_buffer_read(device, raster->buffers[which], size_bytes, *bytes);
}

static camber_status copy_pixels(camber_raster *raster, uint8_t **rgba) {
    const camber_raster_area *area = &raster->area;
    camber_raster_pixels pixels = {0};
    *rgba = camber_alloc(raster->device->context, 4 * (size_t)area->width, area->height);
    camber_status status = *rgba ? camber_raster_map(raster, &pixels) : CAMBER_ERROR_MEMORY;
    if (status != CAMBER_OK)
        return status;
    for (size_t y = 0; y < area->height; y++)
        memcpy(*rgba + 4 * y * area->width, pixels.rgba + y * pixels.row_bytes, 4 * (size_t)area->width);
    camber_raster_unmap(raster, pixels);
    return CAMBER_OK;
}

camber_status camber_raster_read_stages(camber_raster *raster, camber_raster_stages *stages) {
    camber_raster_stages made = {
        .segment_count = raster->segment_count, .tile_count = raster->tile_count, .list_count = raster->list_count};
    camber_status status = get(raster, BUFFER_SEGMENTS, 4 * CAMBER_SEGMENT_WORDS * made.segment_count, &made.segments);
    if (status == CAMBER_OK && raster->end_edge)
        status = get(raster, BUFFER_EDGES, 4 * CAMBER_SIXTEEN_EDGES_WORDS * (made.segment_count / 16), &made.edges);
    if (status == CAMBER_OK)
        status = get(raster, BUFFER_BOXES, 4 * made.segment_count, &made.boxes);
    if (status == CAMBER_OK && raster->variant)
        status =
            get(raster, BUFFER_ARC_LENGTHS, 4 * CAMBER_SEGMENT_ARC_LENGTHS * made.segment_count, &made.arc_lengths);
    if (status == CAMBER_OK && raster->variant & CAMBER_RASTER_PITCHED)
        status = get(raster, BUFFER_PLANES, 4 * CAMBER_PLANE_WORDS * made.segment_count, &made.planes);
    if (status == CAMBER_OK)
        status = get(raster, BUFFER_STARTS, 4 * (made.list_count + 1), &made.starts);
    if (status == CAMBER_OK)
        status = get(raster, BUFFER_LISTS, 4 * (size_t)made.starts[made.list_count], &made.lists);
    if (status == CAMBER_OK)
        status = copy_pixels(raster, &made.rgba);
    if (status != CAMBER_OK) {
        camber_raster_stages_free(raster->device->context, &made);
        return status;
    }
    const size_t slice = raster->first_segment, first = raster->first_edge, end = raster->end_edge;
    camber_raster_stages_show_edges(raster->device->context, &made, first > slice ? first - slice : 0,
                                    end > slice ? end - slice : 0);
    *stages = made;
    return CAMBER_OK;
}
