/* The parts of a mesh: which polylines each has, its buffers, and their upload.
 *
 * Input: polylines in slots, and the limits of the device: its largest buffer, and shares of the bound on memory.
 * Output: mesh->parts, each with buffers of its own; a device that works in the host's memory reads the points of a
 * single part where they are. Main idea: polylines are divided twice.
 *
 *     before  camber_mesh_plan   by slots, which are known, so that a part's input fits
 *     after   camber_mesh_split  by the output that classify and scan have counted, where that does not fit
 *
 * A part is cut between polylines only. A single polyline that does not fit is an error that names it. */
#include "kernels/arc_length.h"
#include "tess/network.h"
#include "tess/offset.h"

#include <string.h>

enum { INPUTS = 9, POINT_INPUTS = 3 };

/* Lists a part's input buffers. The first three may be lent by polylines, the last two are there only with arc
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
    part->lent = false;
}

/* Releases the input buffers that classify reads or writes, and leaves those of source lines. */
static void release_slots(const camber_device *device, camber_mesh_part *part) {
    release_inputs(device, part, INPUTS);
    part->slot_capacity = 0;
    part->uploaded = part->made = false;
}

static void release_input(const camber_device *device, camber_mesh_part *part) {
    release_slots(device, part);
    camber_source_line_release(device, &part->source_line);
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
    part->lent = from->lent;
    from->lent = false;
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

/* Whether the input buffers are large enough, and those of arc lengths are there where they are wanted. lent: points
 * need no buffers of the part's own. */
static bool has_input(const camber_mesh_part *part, bool has_arc_length, size_t slots, bool lent) {
    return slots <= part->slot_capacity && (!has_arc_length || part->arc_lengths) && (lent || (part->x && !part->lent));
}

/* lent: points need no buffers. */
static camber_status reserve_input(const camber_device *device, bool has_arc_length, camber_mesh_part *part,
                                   size_t slots, bool lent) {
    if (has_input(part, has_arc_length, slots, lent))
        return CAMBER_OK;
    const bool uploaded =
        part->uploaded && part->source_line.x; /* slots were uploaded to the source lines' buffers, which stay */
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
    for (size_t i = lent ? POINT_INPUTS : 0; i < count && status == CAMBER_OK; i++)
        status = camber_buffer_create(device, CAMBER_BUFFER_OWN, wanted[i].size_bytes, NULL, wanted[i].buffer);
    if (status != CAMBER_OK) {
        release_slots(device, part);
        return status;
    }
    part->slot_capacity = slots;
    return CAMBER_OK;
}

/* The bytes of a part's input, and of the arrays that the host keeps for it. The arrays count double and a little more:
 * camber_grow makes them larger than asked, and never tiny. */
static uint64_t bytes_of_slots(const camber_mesh *mesh, const camber_mesh_part *part, size_t slots) {
    const uint64_t chunks = mesh->held ? (part->end_point - part->first_point) / CAMBER_CULL_CHUNK + 3 : 0;
    const uint64_t blocks = slots / mesh->device->block;
    return camber_input_bytes(mesh->device, mesh->mesh_info.has_arc_length, slots) +
           2 * (16 * (blocks + 1) + 4 * chunks) + 256;
}

static camber_status reserve(camber_mesh *mesh, camber_mesh_part *part, size_t slots, bool lent) {
    const camber_device *device = mesh->device;
    const bool has_arc_length = mesh->mesh_info.has_arc_length;
    const uint64_t wanted = bytes_of_slots(mesh, part, slots);
    if (wanted > camber_device_share(device, 4))
        return camber_fail_memory(mesh, part->first_polyline, wanted);
    const uint64_t needed = wanted - (lent ? camber_point_bytes(slots) : 0);
    const uint64_t there = slots > part->slot_capacity ? camber_part_input_bytes(mesh, part) : 0;
    camber_status status = CAMBER_OK;
    if (!has_input(part, has_arc_length, slots, lent))
        status = camber_mesh_make_room(mesh, part, needed > there ? needed - there : 0);
    if (status == CAMBER_OK)
        status = reserve_input(device, has_arc_length, part, slots, lent);
    if (status == CAMBER_OK && !camber_grow(device->context, &part->host_bases, &part->base_capacity,
                                            2 * (part->slot_capacity / device->block + 1), sizeof *part->host_bases))
        status = CAMBER_ERROR_MEMORY;
    camber_part_count_bytes(mesh, part);
    return status;
}

camber_status camber_part_reserve(camber_mesh *mesh, camber_mesh_part *part, size_t slots) {
    return reserve(mesh, part, slots, false);
}

camber_status camber_part_reserve_with_spare(camber_mesh *mesh, camber_mesh_part *part, size_t slots) {
    const size_t block = mesh->device->block, more = slots + slots / 4 / block * block;
    const bool enough =
        slots <= part->slot_capacity || !mesh->held ||
        4 * ((uint64_t)more + 2) > mesh->device->info.largest_buffer_bytes ||
        !camber_device_is_roomy(mesh->device, camber_input_bytes(mesh->device, mesh->mesh_info.has_arc_length, more));
    part->slot_count = slots;
    return camber_part_reserve(mesh, part, enough ? slots : more);
}

camber_status camber_part_reserve_output(camber_mesh *mesh, camber_mesh_part *part, size_t which, size_t size_bytes) {
    camber_shared_buffer *buffer = part->buffers + which;
    camber_status status = CAMBER_OK;
    if (size_bytes > buffer->capacity_bytes)
        status = camber_mesh_make_room(mesh, part, mesh->buffer_copies * (size_bytes - buffer->capacity_bytes));
    if (status == CAMBER_OK)
        status = mesh->ops->reserve(mesh->ops_user, buffer, size_bytes);
    camber_part_count_bytes(mesh, part);
    return status;
}

void camber_part_release_buffers(camber_mesh *mesh, camber_mesh_part *part) {
    for (int i = 0; i < 2; i++)
        mesh->ops->release(mesh->ops_user, part->buffers + i);
    release_input(mesh->device, part);
    camber_free(mesh->device->context, part->host_bases);
    camber_free(mesh->device->context, part->chunk_bases);
    part->host_bases = NULL;
    part->chunk_bases = NULL;
    part->base_capacity = part->chunk_capacity = 0;
    camber_part_count_bytes(mesh, part);
}

static void release_part(camber_mesh *mesh, camber_mesh_part *part) {
    camber_part_release_buffers(mesh, part);
    *part = (camber_mesh_part){0};
}

void camber_mesh_release_parts(camber_mesh *mesh) {
    for (size_t i = 0; i < mesh->part_capacity; i++)
        release_part(mesh, mesh->parts + i);
    camber_free(mesh->device->context, mesh->parts);
    mesh->parts = NULL;
    mesh->part_count = mesh->part_capacity = 0;
}

/* ---- Layout ---- */

/* Makes room for so many parts. Parts past part_count are zero, but for the very first, which keeps its buffers for the
 * next polylines. */
static bool reserve_parts(camber_mesh *mesh, size_t count) {
    const size_t before = mesh->part_capacity;
    if (!camber_grow(mesh->device->context, &mesh->parts, &mesh->part_capacity, count, sizeof *mesh->parts))
        return false;
    memset(mesh->parts + before, 0, (mesh->part_capacity - before) * sizeof *mesh->parts);
    return true;
}

/* Gives a part the polylines [first, end). Whatever its buffers hold is invalid from then on. */
static void set_polylines(const camber_mesh *mesh, camber_mesh_part *part, size_t first, size_t end) {
    const size_t block = mesh->device->block;
    const size_t slots = mesh->held ? 0 : mesh->first_slots[end] - mesh->first_slots[first];
    part->first_polyline = first;
    part->polyline_count = end - first;
    part->first_slot = mesh->held ? 0 : mesh->first_slots[first];
    part->given_count = part->slot_count = (slots + block - 1) / block * block;
    part->used_slots = slots;
    part->record_count = part->vertex_count = part->index_count = 0;
    part->uploaded = part->made = false;
    if (mesh->held)
        camber_part_set_points(mesh, part);
}

size_t camber_part_given_slot(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline) {
    return mesh->held ? camber_part_network_slot(mesh, part, polyline) : mesh->first_slots[polyline] - part->first_slot;
}

size_t camber_part_slot(const camber_mesh *mesh, const camber_mesh_part *part, const uint32_t *places,
                        size_t polyline) {
    const size_t given = camber_part_given_slot(mesh, part, polyline);
    if (!mesh->has_offsets)
        return given;
    const bool is_behind = given >= part->given_count || polyline >= part->first_polyline + part->polyline_count;
    return is_behind ? part->used_slots : places[given];
}

camber_status camber_fail_polyline(const camber_mesh *mesh, size_t polyline, uint64_t size_bytes) {
    const camber_device *device = mesh->device;
    return camber_fail(device->context, CAMBER_ERROR_LIMIT,
                       "polyline %zu takes a buffer of %llu bytes, and %s makes none above %llu; cut it in two, or "
                       "simplify it",
                       polyline, (unsigned long long)size_bytes, device->info.name,
                       (unsigned long long)device->info.largest_buffer_bytes);
}

camber_status camber_fail_memory(const camber_mesh *mesh, size_t polyline, uint64_t size_bytes) {
    const camber_device *device = mesh->device;
    return camber_fail(device->context, CAMBER_ERROR_LIMIT,
                       "polyline %zu takes %llu bytes, more than half of the %llu that meshes may hold; allow more "
                       "memory, cut the polyline in two, or simplify it",
                       polyline, (unsigned long long)size_bytes, (unsigned long long)device->memory_bytes);
}

/* Returns the polyline behind the last that fits into a part of so many slots that begins with first. */
static size_t find_part_end(const camber_mesh *mesh, size_t first, size_t slots_max) {
    const uint32_t *slots = mesh->first_slots;
    size_t low = first, high = mesh->polyline_count;
    if (slots[high] - slots[first] <= slots_max)
        return high;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (slots[middle] - slots[first] <= slots_max)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void camber_mesh_trim_parts(camber_mesh *mesh) {
    for (size_t i = mesh->part_count ? mesh->part_count : 1; i < mesh->part_capacity; i++)
        release_part(mesh, mesh->parts + i);
}

/* How many slots fit into a part's share of memory, if each makes a record or a little more; at least a block. */
static uint64_t shared_slots(const camber_mesh *mesh) {
    const size_t block = mesh->device->block;
    const uint64_t block_bytes =
        camber_input_bytes(mesh->device, mesh->mesh_info.has_arc_length, block) + 20 * mesh->buffer_copies * block +
        (mesh->has_offsets ? camber_source_line_bytes(mesh->mesh_info.has_arc_length, block) : 0);
    const uint64_t blocks = camber_device_share(mesh->device, 1) / block_bytes;
    return (blocks ? blocks : 1) * block;
}

static camber_status lay_out_parts(camber_mesh *mesh) {
    const size_t block = mesh->device->block, sentinels = 2;
    const uint64_t words = mesh->device->info.largest_buffer_bytes / 4, shared = shared_slots(mesh);
    const uint64_t room = words > sentinels ? (words - sentinels) / block * block : 0;
    const size_t slots_max = room < UINT32_MAX ? (size_t)room : UINT32_MAX;
    const size_t slots = shared < slots_max ? (size_t)shared : slots_max;
    const size_t polyline_count = mesh->first_slots[mesh->polyline_count] ? mesh->polyline_count : 0;
    for (size_t first = 0; first < polyline_count; mesh->part_count++) {
        size_t end = find_part_end(mesh, first, slots);
        if (end == first && mesh->first_slots[first + 1] - mesh->first_slots[first] <= slots_max)
            end = first + 1;
        if (end == first)
            return camber_fail_polyline(
                mesh, first, 4 * ((uint64_t)mesh->first_slots[first + 1] - mesh->first_slots[first] + sentinels));
        if (!reserve_parts(mesh, mesh->part_count + 1))
            return CAMBER_ERROR_MEMORY;
        set_polylines(mesh, mesh->parts + mesh->part_count, first, end);
        first = end;
    }
    camber_mesh_trim_parts(mesh);
    return CAMBER_OK;
}

/* Holds the polylines, unless they are held. Only the count of holders changes, not the polylines. */
static void hold_polylines(camber_mesh *mesh, const camber_polylines *polylines) {
    if (!mesh->holds_polylines)
        camber_polylines_hold((camber_polylines *)(uintptr_t)polylines);
    mesh->holds_polylines = true;
    mesh->polylines = polylines;
}

void camber_mesh_release_polylines(camber_mesh *mesh) {
    if (mesh->holds_polylines)
        camber_polylines_destroy((camber_polylines *)(uintptr_t)mesh->polylines);
    mesh->holds_polylines = false;
    mesh->polylines = NULL;
}

void camber_mesh_let_go(camber_mesh *mesh) {
    const bool lent = mesh->part_count > 0 && mesh->parts[0].lent;
    if (mesh->device->memory_bytes == 0 && !lent)
        camber_mesh_release_polylines(mesh);
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
    const camber_status status = lay_out_parts(mesh);
    if (status == CAMBER_OK)
        mesh->serial = polylines->serial;
    return status;
}

/* Whether the buffers for the upload are complete: with those of arc lengths where these are wanted now. */
static bool has_upload_buffers(const camber_mesh *mesh, const camber_mesh_part *part) {
    return !mesh->mesh_info.has_arc_length || (mesh->has_offsets ? part->source_line.arc_lengths : part->arc_lengths);
}

void camber_mesh_return_points(camber_mesh *mesh) {
    for (size_t i = 0; i < mesh->part_capacity; i++) {
        camber_mesh_part *part = mesh->parts + i;
        if (!part->lent)
            continue;
        camber_device_settle(mesh->device); /* nothing maps them any more */
        release_inputs(mesh->device, part, POINT_INPUTS);
        part->uploaded = false;
        camber_part_count_bytes(mesh, part);
    }
}

/* Lets kernels read the polylines' arrays in place, which begin with the part's sentinel. */
static camber_status borrow_points(const camber_mesh *mesh, camber_mesh_part *part, size_t words) {
    const camber_polylines *polylines = mesh->polylines;
    const struct {
        camber_buffer **buffer;
        const void *words;
    } arrays[POINT_INPUTS] = {{&part->x, polylines->x}, {&part->y, polylines->y}, {&part->info, polylines->info}};
    camber_status status = CAMBER_OK;
    release_inputs(mesh->device, part, POINT_INPUTS);
    for (size_t i = 0; i < POINT_INPUTS && status == CAMBER_OK; i++)
        status =
            camber_buffer_create(mesh->device, CAMBER_BUFFER_BORROWED, 4 * words, arrays[i].words, arrays[i].buffer);
    part->lent = true;
    return status;
}

camber_status camber_part_upload(camber_mesh *mesh, camber_mesh_part *part) {
    static const uint32_t zeros[CAMBER_BLOCK + 2];
    const camber_device *device = mesh->device;
    const camber_polylines *polylines = mesh->polylines;
    part->slot_count = part->given_count;
    part->used_slots = mesh->first_slots[part->first_polyline + part->polyline_count] - part->first_slot;
    if (part->given_count == 0 || (part->uploaded && has_upload_buffers(mesh, part)))
        return CAMBER_OK;
    const camber_source_line_buffers *source_line = &part->source_line;
    const size_t words = part->given_count + 2, first = part->first_slot;
    const bool lent =
        device->host_memory && !mesh->has_offsets && mesh->part_count == 1 && words <= polylines->slot_count + 2;
    camber_status status = mesh->has_offsets ? camber_part_reserve_source_lines(mesh, part, part->given_count)
                                             : reserve(mesh, part, part->given_count, lent);
    if (status == CAMBER_OK && lent)
        status = borrow_points(mesh, part, words);
    const size_t end = part->first_polyline + part->polyline_count;
    /* The words of a part are the one before its first slot, its slots, and sentinels. The last part takes sentinels
     * from the polylines' own padding; other parts, and what is still missing, get zeros. */
    size_t given = end < mesh->polyline_count ? mesh->first_slots[end] - first + 1 : polylines->slot_count + 2 - first;
    given = given < words ? given : words;
    const struct {
        camber_buffer *buffer;
        const void *bytes;
    } arrays[] = {{mesh->has_offsets ? source_line->x : part->x, polylines->x + first},
                  {mesh->has_offsets ? source_line->y : part->y, polylines->y + first},
                  {mesh->has_offsets ? source_line->info : part->info, polylines->info + first}};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays && !lent; i++) {
        if (status == CAMBER_OK)
            status = camber_buffer_write_later(device, arrays[i].buffer, 0, 4 * given, arrays[i].bytes);
        if (status == CAMBER_OK && given < words)
            status = camber_buffer_write_later(device, arrays[i].buffer, 4 * given, 4 * (words - given), zeros);
    }
    /* classify writes a join word for each slot. Those of the sentinels around them are read by neighbours, too. */
    if (status == CAMBER_OK && !mesh->has_offsets)
        status = camber_buffer_write_later(device, part->joins, 0, 4, zeros);
    if (status == CAMBER_OK && !mesh->has_offsets)
        status = camber_buffer_write_later(device, part->joins, 4 * (words - 1), 4, zeros);
    part->uploaded = status == CAMBER_OK;
    return status;
}

/* ---- Splitting ---- */

/* How much a part, or a range of its polylines, has. */
typedef struct part_size {
    uint64_t slots, records, indices;
    uint64_t given; /* source slots, where lines have an offset */
} part_size;

/* Rounds up to whole blocks. */
static uint64_t whole_blocks(const camber_mesh *mesh, uint64_t slots) {
    const uint64_t block = mesh->device->block;
    return (slots + block - 1) / block * block;
}

/* kite and fan have a record for each slot, and their kernel writes whole blocks. */
static uint64_t record_bytes(const camber_mesh *mesh, part_size size) {
    return (mesh->mesh_info.strips ? size.records : whole_blocks(mesh, size.records)) *
           camber_record_bytes(&mesh->mesh_info);
}

static uint64_t index_bytes(const camber_mesh *mesh, part_size size) {
    return mesh->mesh_info.strips ? 0 : 4 * (size.indices ? size.indices : 1); /* no buffer is empty */
}

/* The bytes that a part of this size needs, input and output. */
static uint64_t needed_bytes(const camber_mesh *mesh, const camber_mesh_part *part, part_size size) {
    const size_t given = (size_t)whole_blocks(mesh, size.given);
    return (mesh->has_offsets ? camber_source_line_bytes(mesh->mesh_info.has_arc_length, given) : 0) +
           bytes_of_slots(mesh, part, (size_t)whole_blocks(mesh, size.slots)) +
           mesh->buffer_copies * (record_bytes(mesh, size) + index_bytes(mesh, size));
}

uint64_t camber_part_needed_bytes(const camber_mesh *mesh, const camber_mesh_part *part) {
    return needed_bytes(mesh, part,
                        (part_size){part->slot_count, part->record_count, part->index_count, part->given_count});
}

uint64_t camber_part_missing_output_bytes(const camber_mesh *mesh, const camber_mesh_part *part) {
    const part_size size = {part->slot_count, part->record_count, part->index_count, part->given_count};
    const uint64_t sizes[2] = {record_bytes(mesh, size), index_bytes(mesh, size)};
    uint64_t lacks = 0;
    for (size_t i = 0; i < camber_buffer_count(mesh); i++)
        if (sizes[i] > part->buffers[i].capacity_bytes)
            lacks += sizes[i] - part->buffers[i].capacity_bytes;
    return mesh->buffer_copies * lacks;
}

/* Whether a part of this size is too large for the device's buffers, or for so many eighths of the bound on meshes. */
static bool is_too_large(const camber_mesh *mesh, const camber_mesh_part *part, part_size size, unsigned eighths) {
    const uint64_t records = record_bytes(mesh, size), indices = index_bytes(mesh, size);
    return (records > indices ? records : indices) > mesh->device->info.largest_buffer_bytes ||
           needed_bytes(mesh, part, size) > camber_device_share(mesh->device, eighths);
}

/* Eighths of the bound for a part of a single polyline, and of several: gpu/memory.h. */
enum { ALONE = 4, TOGETHER = 1 };

bool camber_part_may_hold(const camber_mesh *mesh, const camber_mesh_part *part, uint64_t slots) {
    return part->polyline_count == 1 || needed_bytes(mesh, part, (part_size){slots, slots, 0, part->given_count}) <=
                                            camber_device_share(mesh->device, TOGETHER);
}

camber_status camber_part_check_slots(const camber_mesh *mesh, const camber_mesh_part *part, uint64_t slots,
                                      bool *fits) {
    const uint64_t size_bytes = 4 * (slots + 2);
    *fits = size_bytes <= mesh->device->info.largest_buffer_bytes && slots <= UINT32_MAX - 1024u;
    if (!*fits && part->polyline_count == 1)
        return camber_fail_polyline(mesh, part->first_polyline, size_bytes);
    *fits = *fits && camber_part_may_hold(mesh, part, slots);
    return CAMBER_OK;
}

/* Fails because a polyline alone is too large, and says for which limit. */
static camber_status fail_alone(const camber_mesh *mesh, const camber_mesh_part *part, size_t polyline,
                                part_size size) {
    const uint64_t records = record_bytes(mesh, size), indices = index_bytes(mesh, size);
    const uint64_t larger = records > indices ? records : indices;
    return larger > mesh->device->info.largest_buffer_bytes
               ? camber_fail_polyline(mesh, polyline, larger)
               : camber_fail_memory(mesh, polyline, needed_bytes(mesh, part, size));
}

size_t camber_part_count_records(const camber_mesh *mesh, const camber_mesh_part *part) {
    return mesh->mesh_info.strips ? part->index_count / 2
                                  : camber_part_slot(mesh, part, NULL, part->first_polyline + part->polyline_count);
}

bool camber_part_fits(const camber_mesh *mesh, const camber_mesh_part *part) {
    const part_size size = {part->slot_count, part->record_count, part->index_count, part->given_count};
    return !is_too_large(mesh, part, size, part->polyline_count > 1 ? TOGETHER : ALONE);
}

/* Finds how much a part has before a polyline, from what the scan left. */
static camber_status size_before(camber_slot_starts *starts, size_t polyline, part_size *size) {
    const camber_mesh *mesh = starts->finder.mesh;
    uint64_t indices = 0;
    const camber_status status = camber_slot_starts_index(starts, polyline, &indices);
    if (status != CAMBER_OK)
        return status;
    const size_t slot = camber_slot_starts_slot(starts, polyline);
    const size_t given = mesh->has_offsets ? camber_part_given_slot(mesh, starts->finder.part, polyline) : 0;
    *size = (part_size){slot, mesh->mesh_info.strips ? indices / 2 : slot, indices, given};
    return CAMBER_OK;
}

static part_size subtract(part_size a, part_size b) {
    return (part_size){a.slots - b.slots, a.records - b.records, a.indices - b.indices, a.given - b.given};
}

/* Finds the end of a new part, which takes polylines as long as its output is not too large, and one at least. start:
 * what lies before the part; it becomes what lies before its end. What lies before a polyline is counted from the start
 * of a chunk, which is long for lines of few points. So the end is found by halving. */
static camber_status find_cut(const camber_mesh *mesh, const camber_mesh_part *part, camber_slot_starts *starts,
                              size_t first, part_size *start, size_t *cut) {
    const size_t end = part->first_polyline + part->polyline_count;
    part_size before_cut = *start;
    size_t fits = first;
    for (size_t behind = end + 1, tried = end; behind - fits > 1; tried = fits + (behind - fits) / 2) {
        part_size before;
        const camber_status status = size_before(starts, tried, &before);
        if (status != CAMBER_OK)
            return status;
        const part_size taken = subtract(before, *start);
        const bool is_alone = tried == first + 1;
        if (is_alone && is_too_large(mesh, part, taken, ALONE))
            return fail_alone(mesh, part, first, taken);
        if (!is_alone && is_too_large(mesh, part, taken, TOGETHER)) {
            behind = tried;
            continue;
        }
        fits = tried;
        before_cut = before;
    }
    *start = before_cut;
    *cut = fits;
    return CAMBER_OK;
}

/* Finds where to cut: the polylines with which the new parts begin, but for the first. */
static camber_status find_cuts(const camber_mesh *mesh, const camber_mesh_part *part, camber_slot_starts *starts,
                               size_t **cuts, size_t *cut_count) {
    const size_t end = part->first_polyline + part->polyline_count;
    size_t capacity = 0, cut = part->first_polyline;
    part_size start = {0, 0, 0, 0};
    for (;;) {
        const camber_status status = find_cut(mesh, part, starts, cut, &start, &cut);
        if (status != CAMBER_OK || cut == end)
            return status;
        if (!camber_grow(mesh->device->context, cuts, &capacity, *cut_count + 1, sizeof **cuts))
            return CAMBER_ERROR_MEMORY;
        (*cuts)[(*cut_count)++] = cut;
    }
}

/* Cuts a part before each of the polylines in cuts. Buffers stay with the first of the new parts. */
static camber_status insert_parts(camber_mesh *mesh, size_t which, const size_t *cuts, size_t cut_count) {
    if (!reserve_parts(mesh, mesh->part_count + cut_count))
        return CAMBER_ERROR_MEMORY;
    camber_mesh_part *part = mesh->parts + which;
    const size_t first = part->first_polyline, end = first + part->polyline_count;
    memmove(part + 1 + cut_count, part + 1, (mesh->part_count - which - 1) * sizeof *part);
    memset(part + 1, 0, cut_count * sizeof *part);
    mesh->part_count += cut_count;
    for (size_t i = 0; i <= cut_count; i++)
        set_polylines(mesh, part + i, i ? cuts[i - 1] : first, i < cut_count ? cuts[i] : end);
    return CAMBER_OK;
}

camber_status camber_mesh_add_part(camber_mesh *mesh, size_t first_polyline, size_t end_polyline) {
    if (!reserve_parts(mesh, mesh->part_count + 1))
        return CAMBER_ERROR_MEMORY;
    set_polylines(mesh, mesh->parts + mesh->part_count++, first_polyline, end_polyline);
    return CAMBER_OK;
}

/* Merges a part with the one behind it, which loses its buffers. The slots of both are made anew. */
static void merge_with_next(camber_mesh *mesh, size_t which) {
    camber_mesh_part *part = mesh->parts + which;
    const size_t end = part[1].first_polyline + part[1].polyline_count;
    camber_part_release_buffers(mesh, part + 1);
    memmove(part + 1, part + 2, (mesh->part_count - which - 2) * sizeof *part);
    mesh->part_count--;
    memset(mesh->parts + mesh->part_count, 0, sizeof *part);
    set_polylines(mesh, part, part->first_polyline, end);
}

void camber_mesh_compact_parts(camber_mesh *mesh) {
    const uint64_t most = camber_device_share(mesh->device, 1) / 2;
    if (!mesh->device->memory_bytes)
        return;
    for (size_t i = 0; i < mesh->part_count && mesh->is_full; i++)
        if (mesh->parts[i].held_bytes / 2 > camber_part_needed_bytes(mesh, mesh->parts + i))
            camber_part_release_buffers(mesh, mesh->parts + i);
    for (size_t i = 0; i + 1 < mesh->part_count; i++) {
        const camber_mesh_part *part = mesh->parts + i;
        const part_size both = {part[0].slot_count + part[1].slot_count, part[0].record_count + part[1].record_count,
                                part[0].index_count + part[1].index_count, part[0].given_count + part[1].given_count};
        const camber_mesh_part joint = {.first_point = part[0].first_point, .end_point = part[1].end_point};
        /* How much the merged part will have is known after the next frame. Only then may it merge again. */
        if (part[0].section == part[1].section && needed_bytes(mesh, &joint, both) <= most)
            merge_with_next(mesh, i);
    }
}

camber_status camber_mesh_halve(camber_mesh *mesh, size_t which) {
    const camber_mesh_part *part = mesh->parts + which;
    const size_t middle = part->first_polyline + part->polyline_count / 2;
    return insert_parts(mesh, which, &middle, 1);
}

camber_status camber_mesh_split(camber_mesh *mesh, size_t which) {
    const camber_device *device = mesh->device;
    const camber_mesh_part *part = mesh->parts + which;
    size_t *cuts = NULL, cut_count = 0;
    camber_slot_starts starts = camber_slot_starts_of(mesh, part);
    camber_status status = camber_slot_starts_map(&starts);
    if (status != CAMBER_OK)
        return status;
    status = find_cuts(mesh, part, &starts, &cuts, &cut_count);
    camber_slot_starts_unmap(&starts);
    if (status == CAMBER_OK && cut_count == 0)
        status = camber_fail(device->context, CAMBER_ERROR_DEVICE,
                             "%s: the scan's offsets contradict its sums; update the driver or try another device",
                             device->info.name);
    if (status == CAMBER_OK)
        status = insert_parts(mesh, which, cuts, cut_count);
    camber_free(device->context, cuts);
    return status;
}
