/* The buffers of a part: lists, makes, moves and releases them. */
#include "residency/memory.h"

#include "kernels/arc_length.h"
#include "kernels/offset_emit.h"

#include <string.h>

enum { INPUTS = 9, POINT_INPUTS = 3 };

/* Lists a part's input buffers. The first three may be borrowed from polylines; the last two exist only with arc
 * lengths. */
static void list_input(camber_mesh_part *part, camber_buffer **buffers[INPUTS]) {
    camber_buffer **const list[INPUTS] = {&part->x,    &part->y,     &part->info,    &part->joins,      &part->offsets,
                                          &part->sums, &part->bases, &part->lengths, &part->arc_lengths};
    memcpy(buffers, list, sizeof list);
}

/* Releases the first `count` of the input buffers. */
static void release_inputs(const camber_device *device, camber_mesh_part *part, size_t count) {
    camber_buffer **buffers[INPUTS];
    list_input(part, buffers);
    for (size_t i = 0; i < count; i++)
        camber_buffer_release(device, buffers[i]);
    part->borrowed = false;
}

/* Releases the input buffers that classify reads or writes, and keeps the buffers of source lines. */
static void release_slots(const camber_device *device, camber_mesh_part *part) {
    release_inputs(device, part, INPUTS);
    part->slot_capacity = 0;
    part->uploaded = part->made = false;
}

enum { SOURCE_LINE_BUFFERS = 8 };

static void release_source_line(const camber_device *device, camber_source_line_buffers *source_line) {
    camber_buffer **buffers[SOURCE_LINE_BUFFERS] = {
        &source_line->x,      &source_line->y,      &source_line->info,    &source_line->clips,
        &source_line->counts, &source_line->places, &source_line->lengths, &source_line->arc_lengths};
    for (size_t i = 0; i < SOURCE_LINE_BUFFERS; i++)
        camber_buffer_release(device, buffers[i]);
    source_line->slot_capacity = 0;
}

void camber_part_release_points(camber_mesh *mesh, camber_mesh_part *part) {
    release_inputs(mesh->device, part, POINT_INPUTS);
    camber_part_count_bytes(mesh, part);
}

void camber_part_release_buffers(camber_mesh *mesh, camber_mesh_part *part) {
    for (int i = 0; i < 2; i++)
        mesh->ops->release(mesh->ops_user, part->buffers + i);
    release_slots(mesh->device, part);
    release_source_line(mesh->device, &part->source_line);
    camber_free(mesh->device->context, part->host_bases);
    camber_free(mesh->device->context, part->chunk_bases);
    part->host_bases = NULL;
    part->chunk_bases = NULL;
    part->base_capacity = part->chunk_capacity = 0;
    camber_part_count_bytes(mesh, part);
}

void camber_part_move_buffers(camber_mesh_part *part, camber_mesh_part *from) {
    camber_buffer **to[INPUTS], **buffers[INPUTS];
    list_input(part, to);
    list_input(from, buffers);
    for (size_t i = 0; i < INPUTS; i++) {
        *to[i] = *buffers[i];
        *buffers[i] = NULL;
    }
    for (int i = 0; i < 2; i++) {
        part->buffers[i] = from->buffers[i];
        from->buffers[i] = (camber_shared_buffer){0};
    }
    part->slot_capacity = from->slot_capacity;
    part->borrowed = from->borrowed;
    from->borrowed = false;
    part->source_line = from->source_line;
    from->source_line = (camber_source_line_buffers){0};
    part->host_bases = from->host_bases;
    part->base_capacity = from->base_capacity;
    part->chunk_bases = from->chunk_bases;
    part->chunk_capacity = from->chunk_capacity;
    from->host_bases = NULL;
    from->chunk_bases = NULL;
    from->slot_capacity = from->base_capacity = from->chunk_capacity = 0;
    from->uploaded = from->made = false;
}

bool camber_part_has_input(const camber_mesh *mesh, const camber_mesh_part *part, size_t slots, bool borrowed) {
    return slots <= part->slot_capacity && (!mesh->mesh_info.has_arc_length || part->arc_lengths) &&
           (borrowed || (part->x && !part->borrowed));
}

camber_status camber_part_make_input(const camber_mesh *mesh, camber_mesh_part *part, size_t slots, bool borrowed) {
    const camber_device *device = mesh->device;
    const bool has_arc_length = mesh->mesh_info.has_arc_length;
    if (camber_part_has_input(mesh, part, slots, borrowed))
        return CAMBER_OK;
    const bool uploaded =
        part->uploaded && part->source_line.x; /* slots were uploaded to the source lines' buffers, which are kept */
    release_slots(device, part);
    part->uploaded = uploaded;
    const size_t blocks = slots / device->block, words = slots + 2;
    camber_status status = CAMBER_OK;
    const struct {
        camber_buffer **buffer;
        size_t size_bytes;
    } wanted[] = {
        {&part->x, 4 * words},
        {&part->y, 4 * words},
        {&part->info, 4 * words},
        {&part->joins, 4 * words},
        {&part->offsets, 4 * (slots / device->point_chunk)},
        {&part->sums, 4 * blocks},
        {&part->bases, 16 * blocks},
        {&part->lengths, 16 * slots / CAMBER_ARC_LENGTH_CHUNK},
        {&part->arc_lengths, sizeof(camber_arc_length) * slots},
    };
    const size_t count = has_arc_length ? INPUTS : INPUTS - 2;
    for (size_t i = borrowed ? POINT_INPUTS : 0; i < count && status == CAMBER_OK; i++)
        status = camber_buffer_create(device, CAMBER_BUFFER_OWN, wanted[i].size_bytes, NULL, wanted[i].buffer);
    if (status != CAMBER_OK) {
        release_slots(device, part);
        return status;
    }
    part->slot_capacity = slots;
    return CAMBER_OK;
}

camber_status camber_part_make_source_lines(const camber_mesh *mesh, camber_mesh_part *part, size_t slots) {
    const camber_device *device = mesh->device;
    camber_source_line_buffers *source_line = &part->source_line;
    const size_t words = slots + 2;
    const struct {
        camber_buffer **buffer;
        size_t size_bytes;
    } wanted[SOURCE_LINE_BUFFERS] = {
        {&source_line->x, 4 * words},
        {&source_line->y, 4 * words},
        {&source_line->info, 4 * words},
        {&source_line->clips, sizeof(camber_offset_clip) * words},
        {&source_line->counts, 4 * (slots / CAMBER_OFFSET_CHUNK + 1)},
        {&source_line->places, 4 * slots},
        {&source_line->lengths, 16 * slots / CAMBER_ARC_LENGTH_CHUNK},
        {&source_line->arc_lengths, sizeof(camber_arc_length) * slots},
    };
    const size_t count = mesh->mesh_info.has_arc_length ? SOURCE_LINE_BUFFERS : SOURCE_LINE_BUFFERS - 2;
    camber_status status = CAMBER_OK;
    release_source_line(device, source_line);
    for (size_t i = 0; i < count && status == CAMBER_OK; i++)
        status = camber_buffer_create(device, CAMBER_BUFFER_OWN, wanted[i].size_bytes, NULL, wanted[i].buffer);
    if (status == CAMBER_OK)
        source_line->slot_capacity = slots;
    else
        release_source_line(device, source_line);
    return status;
}
