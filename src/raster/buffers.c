/* The buffers of what draws on a device: how much they hold, what is written to them and read back. */
#include "raster/rasterizer.h"

#include <assert.h>
#include <string.h>

/* What shapes, lists, and what is kept of tiles may take each where memory has no bound. Shapes that take more are
 * drawn in slices, from the last one to the first. Where lists or what is kept would take more, rows of tiles are drawn
 * by halves, and where the lists of one row do, half the slice. */
static const uint64_t MOST_BYTES = 256 * 1024 * 1024;

camber_status camber_cover_create(camber_device *device, camber_cover **cover) {
    camber_cover *made = camber_alloc_zero(device->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->device = device;
    camber_drawing_open(device, &made->memory);
    *cover = made;
    return CAMBER_OK;
}

void camber_cover_destroy(camber_cover *cover) {
    if (!cover)
        return;
    for (int i = 0; i < BUFFERS; i++)
        camber_release_buffer(cover->device, &cover->buffers[i]);
    camber_drawing_close(cover->device, &cover->memory);
    camber_free(cover->device->context, cover->items);
    camber_free(cover->device->context, cover->starts);
    camber_free(cover->device->context, cover);
}

camber_cover_times camber_cover_get_times(const camber_cover *cover) {
    return (camber_cover_times){cover->ms[STAGE_SHAPE], cover->ms[STAGE_COUNT], cover->ms[STAGE_TOTAL],
                                cover->ms[STAGE_FILL], cover->ms[STAGE_COVER]};
}

uint32_t camber_cover_slices(const camber_cover *cover) {
    return cover->slice_count;
}

/* ---- Buffers ---- */

/* Pictures are not counted. */
static void count_buffers(camber_cover *cover) {
    uint64_t bytes = 0;
    for (int i = 0; i < BUFFERS; i++)
        bytes += i == BUFFER_PIXELS ? 0 : cover->capacities[i];
    camber_drawing_count_bytes(cover->device, &cover->memory, bytes);
}

uint64_t camber_cover_most_bytes(const camber_cover *cover) {
    const uint64_t largest = cover->device->info.largest_buffer_bytes, quarter = cover->memory.allowed_bytes / 4;
    const uint64_t most = largest < MOST_BYTES ? largest : MOST_BYTES;
    return quarter && quarter < most ? quarter : most;
}

uint32_t camber_cover_widest(const camber_cover *cover) {
    const uint64_t tiles = camber_cover_most_bytes(cover) / CAMBER_KEPT_BYTES,
                   widest = tiles < CAMBER_TILES_MAX ? tiles : CAMBER_TILES_MAX;
    return CAMBER_TILE_PX * (widest ? (uint32_t)widest : 1);
}

camber_status camber_cover_reserve(camber_cover *cover, int which, size_t size_bytes) {
    const camber_device *device = cover->device;
    if (size_bytes <= cover->capacities[which])
        return CAMBER_OK;
    if (size_bytes > device->info.largest_buffer_bytes)
        return camber_fail(device->context, CAMBER_ERROR_LIMIT,
                           "drawing takes a buffer of %zu bytes, and %s makes none above %llu; draw less at once",
                           size_bytes, device->info.name, (unsigned long long)device->info.largest_buffer_bytes);
    camber_release_buffer(device, &cover->buffers[which]);
    cover->capacities[which] = 0;
    count_buffers(cover);
    const size_t more = size_bytes + size_bytes / 4;
    const bool is_roomy = !cover->memory.allowed_bytes && more < device->info.largest_buffer_bytes;
    const size_t room = is_roomy ? more : size_bytes;
    const cl_mem_flags flags = CL_MEM_READ_WRITE | (which == BUFFER_PIXELS ? CL_MEM_ALLOC_HOST_PTR : 0);
    const camber_status status = camber_make_buffer(device, flags, room, NULL, &cover->buffers[which]);
    if (status != CAMBER_OK)
        return status;
    cover->capacities[which] = room;
    count_buffers(cover);
    return CAMBER_OK;
}

camber_status camber_cover_put(camber_cover *cover, int which, const void *bytes, size_t size_bytes) {
    const camber_device *device = cover->device;
    const camber_status status = camber_cover_reserve(cover, which, size_bytes);
    if (status != CAMBER_OK)
        return status;
    const cl_int code =
        clEnqueueWriteBuffer(device->queue, cover->buffers[which], CL_FALSE, 0, size_bytes, bytes, 0, NULL, NULL);
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(device->context, "clEnqueueWriteBuffer", code);
}

/* ---- Pixels ---- */

camber_status camber_cover_map(camber_cover *cover, camber_cover_pixels *pixels) {
    const camber_device *device = cover->device;
    const size_t row_bytes = 4 * camber_cover_stride_px(&cover->area);
    cl_int code;
    assert(!cover->given);
    const void *rgba = clEnqueueMapBuffer(device->queue, cover->buffers[BUFFER_PIXELS], CL_TRUE, CL_MAP_READ, 0,
                                          row_bytes * cover->area.height, 0, NULL, NULL, &code);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clEnqueueMapBuffer", code);
    *pixels = (camber_cover_pixels){rgba, row_bytes};
    return CAMBER_OK;
}

void camber_cover_unmap(camber_cover *cover, camber_cover_pixels pixels) {
    clEnqueueUnmapMemObject(cover->device->queue, cover->buffers[BUFFER_PIXELS], (void *)(uintptr_t)pixels.rgba, 0,
                            NULL, NULL);
}

/* ---- Stages, read back ---- */

static camber_status get(camber_cover *cover, int which, size_t size_bytes, void *copy) {
    const camber_device *device = cover->device;
    void **bytes = copy;
    *bytes = camber_alloc(device->context, size_bytes, 1);
    if (!*bytes)
        return CAMBER_ERROR_MEMORY;
    const cl_int code = size_bytes ? clEnqueueReadBuffer(device->queue, cover->buffers[which], CL_TRUE, 0, size_bytes,
                                                         *bytes, 0, NULL, NULL)
                                   : CL_SUCCESS;
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(device->context, "clEnqueueReadBuffer", code);
}

static camber_status copy_pixels(camber_cover *cover, uint8_t **rgba) {
    const camber_cover_area *area = &cover->area;
    camber_cover_pixels pixels = {0};
    *rgba = camber_alloc(cover->device->context, 4 * (size_t)area->width, area->height);
    camber_status status = *rgba ? camber_cover_map(cover, &pixels) : CAMBER_ERROR_MEMORY;
    if (status != CAMBER_OK)
        return status;
    for (size_t y = 0; y < area->height; y++)
        memcpy(*rgba + 4 * y * area->width, pixels.rgba + y * pixels.row_bytes, 4 * (size_t)area->width);
    camber_cover_unmap(cover, pixels);
    return CAMBER_OK;
}

camber_status camber_cover_read_stages(camber_cover *cover, camber_cover_stages *stages) {
    camber_cover_stages made = {.shape_count = cover->shape_count, .tile_count = cover->tile_count};
    camber_status status = get(cover, BUFFER_SHAPES, 4 * CAMBER_SHAPE_WORDS * made.shape_count, &made.shapes);
    if (status == CAMBER_OK)
        status = get(cover, BUFFER_BOXES, 4 * made.shape_count, &made.boxes);
    if (status == CAMBER_OK && cover->variant)
        status = get(cover, BUFFER_MEASURES, 4 * CAMBER_SHAPE_MEASURES * made.shape_count, &made.measures);
    if (status == CAMBER_OK && cover->variant & CAMBER_COVER_PITCHED)
        status = get(cover, BUFFER_PLANES, 4 * CAMBER_PLANE_WORDS * made.shape_count, &made.planes);
    if (status == CAMBER_OK)
        status = get(cover, BUFFER_STARTS, 4 * (made.tile_count + 1), &made.starts);
    if (status == CAMBER_OK)
        status = get(cover, BUFFER_LISTS, 4 * (size_t)made.starts[made.tile_count], &made.lists);
    if (status == CAMBER_OK)
        status = copy_pixels(cover, &made.rgba);
    if (status != CAMBER_OK) {
        camber_cover_stages_free(cover->device->context, &made);
        return status;
    }
    *stages = made;
    return CAMBER_OK;
}
