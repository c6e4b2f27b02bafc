/* Tessellates a mesh on a device, a part at a time.
 *
 * Input: polylines, or a network and a camera; and strokes. Output: each part's points, and for GL its records and
 * indices, in its buffers, and the mesh's counts. Main idea: first the sizes, then the output. So buffers are exact, no
 * kernel needs an atomic, and the same input gives the same bytes.
 *
 *     slots of the part   uploaded, or the polylines' own; or projected from a network; or made beside source lines
 *        v  classify      a slot: its join word, from its neighbours and its row
 *     points              the rasterizer draws them
 *        |  scan          a chunk: vertices and indices before it in its block; a block: its sum
 *        |  the host adds the blocks' sums up, and checks that the part fits: else it is cut, and made again
 *        v  emit          a slot: its records and indices, where the sums say
 *     output buffers      GL draws them
 *
 * Meshes that OpenCL draws are scanned and emitted when somebody asks for their counts or reads them. If memory is
 * bounded and full, the parts that come last are not kept; camber_part_ensure_made makes them when they are needed.
 */
#include "gpu/launch.h"
#include "kernels/stroke_ends.h"
#include "tess/arc_length.h"
#include "tess/network.h"
#include "tess/offset.h"

#include <stdio.h>
#include <string.h>

/* ---- Stages ---- */

size_t camber_records_max(camber_method method) {
    return method == CAMBER_METHOD_STRIP ? (size_t)1 << 30 : (size_t)1 << (32 - CAMBER_CORNER_BITS);
}

camber_status camber_fail_records(camber_context *context, camber_method method) {
    return camber_fail(context, CAMBER_ERROR_LIMIT,
                       "more than the %zu records that 32 bits number for method %s; tessellate in parts",
                       camber_records_max(method), camber_method_get_name(method));
}

void camber_scan_blocks(const uint32_t *sums, size_t block_count, uint64_t *bases) {
    uint64_t vertices = 0, indices = 0;
    for (size_t i = 0; i <= block_count; i++) {
        bases[2 * i] = vertices;
        bases[2 * i + 1] = indices;
        if (i < block_count) {
            vertices += sums[i] & 0xffffu;
            indices += sums[i] >> 16;
        }
    }
}

/* Adds up the blocks' sums, and sets how much output the part has. */
static camber_status scan_blocks(const camber_mesh *mesh, camber_mesh_part *part) {
    const camber_device *device = mesh->device;
    const size_t blocks = part->slot_count / device->block;
    const uint32_t *sums;
    const camber_status status = camber_buffer_map(device, part->sums, CAMBER_MAP_READ, 4 * blocks, &sums);
    if (status != CAMBER_OK)
        return status;
    camber_scan_blocks(sums, blocks, part->host_bases);
    camber_buffer_unmap(device, part->sums, sums);
    part->vertex_count = (size_t)part->host_bases[2 * blocks];
    part->index_count = (size_t)part->host_bases[2 * blocks + 1];
    part->record_count = camber_part_count_records(mesh, part);
    return CAMBER_OK;
}

void camber_mesh_add_time(camber_mesh *mesh, camber_stage_id stage, camber_event *event) {
    double ms = 0.0;
    camber_event_end(mesh->device, event, &ms);
    if (event)
        camber_stage_times_add(&mesh->mesh_info.times, stage, ms);
}

static camber_program_desc program_of(const camber_mesh *mesh, camber_method method) {
    return (camber_program_desc){method, mesh->mesh_info.has_arc_length, mesh->round_limits};
}

/* Runs a kernel of a method's program over a part's points, and waits for it: from then on nothing reads arrays of the
 * host that were written to the device later. */
static camber_status run_over_points(camber_mesh *mesh, const camber_mesh_part *part, camber_launch launch,
                                     camber_stage_id stage) {
    const camber_device *device = mesh->device;
    camber_event *event = NULL;
    launch.work_items = part->slot_count / device->point_chunk;
    launch.group_size = device->block / device->point_chunk;
    camber_status status = camber_launch_kernel(device, &launch, &event);
    if (status == CAMBER_OK)
        status = camber_event_wait(device, event, launch.name);
    camber_mesh_add_time(mesh, stage, event);
    return status;
}

/* Finds the join words of the part's points, as a method has them. */
static camber_status classify(camber_mesh *mesh, camber_mesh_part *part, camber_method method) {
    camber_program *program = NULL;
    camber_status status = camber_device_program(mesh->device, program_of(mesh, method), &program);
    if (status != CAMBER_OK)
        return status;
    const camber_kernel_arg args[] = {
        CAMBER_ARG_BUFFER(part->x),    CAMBER_ARG_BUFFER(part->y),    CAMBER_ARG_BUFFER(part->x),
        CAMBER_ARG_BUFFER(part->y),    CAMBER_ARG_BUFFER(part->x),    CAMBER_ARG_BUFFER(part->y),
        CAMBER_ARG_BUFFER(part->info), CAMBER_ARG_BUFFER(part->info), CAMBER_ARG_BUFFER(part->info),
        CAMBER_ARG_BUFFER(mesh->rows), CAMBER_ARG_BUFFER(part->joins)};
    status = run_over_points(
        mesh, part, (camber_launch){.name = "classify", .kernel = program->classify, .args = args, .arg_count = 11},
        CAMBER_STAGE_CLASSIFY);
    if (status == CAMBER_OK)
        part->classified = method;
    else
        part->made = false;
    return status;
}

/* Finds how much output the part has; one without points has none. */
static camber_status count_output(camber_mesh *mesh, camber_mesh_part *part) {
    camber_program *program = NULL;
    if (part->slot_count == 0)
        return CAMBER_OK;
    camber_status status = camber_device_program(mesh->device, program_of(mesh, mesh->mesh_info.method), &program);
    if (status != CAMBER_OK)
        return status;
    const camber_kernel_arg args[] = {CAMBER_ARG_BUFFER(part->joins), CAMBER_ARG_BUFFER(part->joins),
                                      CAMBER_ARG_BUFFER(part->info), CAMBER_ARG_BUFFER(part->offsets),
                                      CAMBER_ARG_BUFFER(part->sums)};
    status = run_over_points(mesh, part,
                             (camber_launch){.name = "scan", .kernel = program->scan, .args = args, .arg_count = 5},
                             CAMBER_STAGE_SCAN);
    if (status == CAMBER_OK)
        status = scan_blocks(mesh, part);
    part->scanned = status == CAMBER_OK;
    return status;
}

/* Makes room in an output buffer. For a network a quarter more, where the device has plenty: the next frame may need
 * it. */
static camber_status reserve_buffer(camber_mesh *mesh, camber_mesh_part *part, size_t which, size_t size_bytes) {
    camber_shared_buffer *buffer = part->buffers + which;
    const size_t room = size_bytes + (mesh->held ? size_bytes / 4 : 0);
    const bool enough = size_bytes <= buffer->capacity_bytes || room > mesh->device->info.largest_buffer_bytes ||
                        !camber_device_is_roomy(mesh->device, mesh->buffer_copies * room);
    const camber_status status = camber_part_reserve_output(mesh, part, which, enough ? size_bytes : room);
    if (status == CAMBER_OK)
        buffer->used_bytes = size_bytes;
    return status;
}

static camber_status reserve_output(camber_mesh *mesh, camber_mesh_part *part) {
    const bool strips = mesh->mesh_info.strips;
    const size_t records = strips ? part->record_count : part->slot_count;
    const size_t indices = part->index_count ? part->index_count : 1; /* no buffer is empty */
    camber_status status =
        reserve_buffer(mesh, part, CAMBER_BUFFER_RECORDS, records * camber_record_bytes(&mesh->mesh_info));
    if (status == CAMBER_OK && !strips)
        status = reserve_buffer(mesh, part, CAMBER_BUFFER_INDICES, 4 * indices);
    return status == CAMBER_OK ? mesh->ops->begin(mesh->ops_user, part->buffers, camber_buffer_count(mesh)) : status;
}

/* Runs emit and waits for it. */
static camber_status emit(camber_mesh *mesh, camber_mesh_part *part, const camber_program *program) {
    const camber_device *device = mesh->device;
    camber_status status =
        camber_buffer_write_later(device, part->bases, 0, 16 * (part->slot_count / device->block), part->host_bases);
    if (status == CAMBER_OK)
        status = reserve_output(mesh, part);
    if (status != CAMBER_OK)
        return status;
    camber_event *event = NULL;
    const size_t second = mesh->mesh_info.strips ? CAMBER_BUFFER_RECORDS : CAMBER_BUFFER_INDICES; /* no indices */
    const camber_kernel_arg args[] = {CAMBER_ARG_BUFFER(part->x),
                                      CAMBER_ARG_BUFFER(part->y),
                                      CAMBER_ARG_BUFFER(part->info),
                                      CAMBER_ARG_BUFFER(mesh->rows),
                                      CAMBER_ARG_BUFFER(part->joins),
                                      CAMBER_ARG_BUFFER(part->offsets),
                                      CAMBER_ARG_BUFFER(part->bases),
                                      CAMBER_ARG_BUFFER(part->buffers[CAMBER_BUFFER_RECORDS].buffer),
                                      CAMBER_ARG_BUFFER(part->buffers[second].buffer),
                                      CAMBER_ARG_BUFFER(mesh->mesh_info.has_arc_length ? part->arc_lengths : NULL)};
    const camber_launch launch = {
        "emit", program->emit, args, 10, part->slot_count / device->point_chunk, device->block / device->point_chunk};
    status = camber_launch_kernel(device, &launch, &event);
    if (status == CAMBER_OK)
        status = camber_device_finish(device);
    else
        camber_device_settle(device);
    status = camber_part_finish(mesh, part, true, status);
    camber_mesh_add_time(mesh, CAMBER_STAGE_EMIT, event);
    return status;
}

/* ---- Parts ---- */

static camber_status reserve_rows(camber_mesh *mesh, size_t count) {
    const size_t row_bytes = sizeof *mesh->host_rows;
    if (!camber_grow(mesh->device->context, &mesh->host_rows, &mesh->host_row_capacity, count, row_bytes))
        return CAMBER_ERROR_MEMORY;
    if (count <= mesh->row_capacity)
        return CAMBER_OK;
    camber_buffer_release(mesh->device, &mesh->rows);
    mesh->row_capacity = 0;
    const camber_status status =
        camber_buffer_create(mesh->device, CAMBER_BUFFER_OWN, count * row_bytes, NULL, &mesh->rows);
    if (status == CAMBER_OK)
        mesh->row_capacity = count;
    return status;
}

static camber_status upload_rows(camber_mesh *mesh, const camber_row *rows, size_t row_count) {
    const camber_device *device = mesh->device;
    const size_t count = row_count + 1; /* never empty */
    if (count * sizeof *rows > device->info.largest_buffer_bytes)
        return camber_fail(device->context, CAMBER_ERROR_LIMIT,
                           "%zu strokes take a buffer of %zu bytes, and %s makes none above %llu; merge equal ones",
                           row_count, count * sizeof *rows, device->info.name,
                           (unsigned long long)device->info.largest_buffer_bytes);
    /* Rows lie on the host and on the device, and camber_grow may make the host's array half as large again. */
    const uint64_t size_bytes = count * sizeof *rows * 5 / 2;
    if (size_bytes > camber_device_share(device, 1))
        return camber_fail(device->context, CAMBER_ERROR_LIMIT,
                           "%zu strokes take %llu bytes, more than an eighth of the %llu that meshes may hold; allow "
                           "more memory, or merge equal ones",
                           row_count, (unsigned long long)size_bytes, (unsigned long long)device->memory_bytes);
    camber_status status = camber_mesh_make_room(mesh, NULL, count > mesh->row_capacity ? size_bytes : 0);
    if (status == CAMBER_OK)
        status = reserve_rows(mesh, count);
    camber_mesh_count_bytes(mesh);
    if (status != CAMBER_OK)
        return status;
    memcpy(mesh->host_rows, rows, count * sizeof *rows);
    return camber_buffer_write_later(device, mesh->rows, 0, count * sizeof *rows, mesh->host_rows);
}

/* Makes a part's points. *fits is false, and there are none, if they are too many. The steps, each only if the mesh has
 * such a thing:
 *
 *     1  slots: project them from the network, or upload them
 *     2  arc lengths of polylines; a network's slots come with theirs
 *     3  offset lines in place of their source lines
 *     4  classify: their join words */
static camber_status make_points(camber_mesh *mesh, camber_mesh_part *part, bool *fits) {
    const camber_method method = mesh->draws_points ? CAMBER_METHOD_STRIP : mesh->mesh_info.method;
    part->scanned = part->emitted = false;
    camber_status status = mesh->held ? camber_part_project(mesh, part, fits)
                                      : camber_part_check_source_lines(mesh, part, part->given_count, fits);
    if (status == CAMBER_OK && *fits && !mesh->held)
        status = camber_part_upload(mesh, part);
    if (status == CAMBER_OK && *fits && mesh->mesh_info.has_arc_length && !mesh->held && part->given_count > 0)
        status = camber_part_sum_arc_lengths(mesh, part);
    if (status == CAMBER_OK && *fits && mesh->has_offsets && part->given_count > 0)
        status = camber_part_offset(mesh, part, fits);
    if (status == CAMBER_OK && *fits && part->slot_count > 0)
        status = classify(mesh, part, method);
    if (mesh->held) {
        camber_mesh_add_time(mesh, CAMBER_STAGE_CULL_EMIT, mesh->held->projected);
        mesh->held->projected = NULL;
    }
    return status;
}

/* Emits a part that has been counted. */
static camber_status emit_unless_empty(camber_mesh *mesh, camber_mesh_part *part) {
    camber_program *program = NULL;
    camber_status status = CAMBER_OK;
    if (part->record_count > 0) {
        status = camber_device_program(mesh->device, program_of(mesh, mesh->mesh_info.method), &program);
        if (status == CAMBER_OK)
            status = emit(mesh, part, program);
    }
    part->emitted = status == CAMBER_OK;
    return status;
}

camber_status camber_part_number(const camber_mesh *mesh, camber_mesh_part *part, camber_mesh_info *counts) {
    part->first_record = counts->record_count;
    part->first_vertex = counts->vertex_count;
    part->first_index = counts->index_count;
    counts->record_count += part->record_count;
    counts->vertex_count += part->vertex_count;
    counts->index_count += part->index_count;
    return counts->record_count > camber_records_max(counts->method)
               ? camber_fail_records(mesh->device->context, counts->method)
               : CAMBER_OK;
}

/* Counts a part's output, and numbers it. *fits is false if it is too large: then the part is cut where the scan says
 * that the output fits. Joins are counted while the part is there, if parts may be evicted later. */
static camber_status count_part(camber_mesh *mesh, size_t which, size_t *segments, bool *fits) {
    camber_mesh_part *part = mesh->parts + which;
    camber_status status = count_output(mesh, part);
    *fits = status != CAMBER_OK || camber_part_fits(mesh, part);
    if (!*fits)
        return camber_mesh_split(mesh, which);
    if (status == CAMBER_OK)
        status = camber_part_number(mesh, part, &mesh->mesh_info);
    if (status == CAMBER_OK && mesh->part_count > 1 && mesh->device->memory_bytes)
        status = camber_part_count_joins(mesh, part, &mesh->mesh_info, segments);
    return status;
}

/* Keeps what was made of a part, and emits it if the mesh is drawn from its output; unless memory is full. */
static camber_status keep_part(camber_mesh *mesh, camber_mesh_part *part) {
    const uint64_t missing = mesh->draws_points ? 0 : camber_part_missing_output_bytes(mesh, part);
    if (!mesh->is_full && !camber_mesh_evict_for(mesh, part, missing, true))
        mesh->is_full = true;
    if (mesh->is_full)
        return CAMBER_OK;
    const camber_status status = mesh->draws_points ? CAMBER_OK : emit_unless_empty(mesh, part);
    part->made = status == CAMBER_OK;
    return status;
}

/* Goes through the parts. i stays where a part is cut, so that the first of the new parts is next.
 *
 *     points do not fit   -> cut the part in two at the middle of its polylines
 *     output does not fit -> cut it again
 *     else                -> number it; keep it, and its output, unless memory is full
 *
 * Once memory is full, parts are only made and counted. The first ones stay, as they are drawn first. */
static camber_status tessellate_parts(camber_mesh *mesh) {
    camber_status status = CAMBER_OK;
    size_t segments = 0;
    mesh->is_full = false;
    for (size_t i = 0; i < mesh->part_count && status == CAMBER_OK;) {
        bool fits = true;
        camber_part_recycle_buffers(mesh, mesh->parts + i, camber_device_share(mesh->device, 1));
        status = make_points(mesh, mesh->parts + i, &fits);
        if (status == CAMBER_OK && !fits) {
            status = camber_mesh_halve(mesh, i);
            continue;
        }
        if (status == CAMBER_OK && !mesh->draws_points)
            status = count_part(mesh, i, &segments, &fits);
        if (status == CAMBER_OK && fits)
            status = keep_part(mesh, mesh->parts + i);
        i += fits;
    }
    if (status == CAMBER_OK && !mesh->draws_points && mesh->part_count > 1 && mesh->device->memory_bytes)
        camber_mesh_set_counts(mesh, mesh->mesh_info, segments);
    return status;
}

/* Makes a part again, and as much of it as the mesh is drawn from. *fits as make_points has it. */
static camber_status make_again(camber_mesh *mesh, camber_mesh_part *part, bool *fits) {
    camber_part_recycle_buffers(mesh, part, camber_part_needed_bytes(mesh, part));
    const camber_status status = make_points(mesh, part, fits);
    return status == CAMBER_OK && *fits && !mesh->draws_points ? count_output(mesh, part) : status;
}

static camber_status fail_remade(const camber_mesh *mesh, const camber_mesh_part *part, size_t slots, size_t records) {
    return camber_fail(mesh->device->context, CAMBER_ERROR_DEVICE,
                       "%s: a part of a mesh has %zu points and %zu records, and now %zu and %zu; update the driver or "
                       "try another device",
                       mesh->device->info.name, slots, records, part->slot_count, part->record_count);
}

camber_status camber_part_ensure_made(camber_mesh *mesh, camber_mesh_part *part) {
    const camber_device *device = mesh->device;
    const camber_mesh_info told = mesh->mesh_info;
    const size_t slots = part->slot_count, used = part->used_slots, records = part->record_count,
                 vertices = part->vertex_count, indices = part->index_count;
    bool fits = true;
    if (part->made || part->slot_count == 0)
        return CAMBER_OK;
    camber_status status = make_again(mesh, part, &fits);
    const bool is_same =
        mesh->draws_points ? part->slot_count == slots : part->record_count == records && part->index_count == indices;
    if (status == CAMBER_OK && (!fits || !is_same))
        status = fail_remade(mesh, part, slots, records);
    if (status == CAMBER_OK && !mesh->draws_points)
        status = emit_unless_empty(mesh, part);
    part->made = status == CAMBER_OK;
    if (status != CAMBER_OK)
        camber_device_settle(device); /* what is written later is read from the host's arrays */
    part->slot_count = slots;
    part->used_slots = used;
    part->record_count = records;
    part->vertex_count = vertices;
    part->index_count = indices;
    mesh->mesh_info = told;
    mesh->remade_parts++;
    return status;
}

/* Makes the part, with the join words of a method. */
static camber_status ensure_classified(camber_mesh *mesh, camber_mesh_part *part, camber_method method) {
    const camber_status status = camber_part_ensure_made(mesh, part);
    return status == CAMBER_OK && part->slot_count > 0 && part->classified != method ? classify(mesh, part, method)
                                                                                     : status;
}

camber_status camber_part_ensure_points(camber_mesh *mesh, camber_mesh_part *part) {
    return ensure_classified(mesh, part, CAMBER_METHOD_STRIP);
}

camber_status camber_part_ensure_counted(camber_mesh *mesh, camber_mesh_part *part) {
    const size_t records = part->record_count, indices = part->index_count;
    camber_status status = ensure_classified(mesh, part, mesh->mesh_info.method);
    if (status != CAMBER_OK || part->scanned)
        return status;
    status = count_output(mesh, part);
    /* Whoever reads the mesh has made room for what was counted before. */
    if (status == CAMBER_OK && mesh->joins_counted && (part->record_count != records || part->index_count != indices))
        status = fail_remade(mesh, part, part->slot_count, records);
    if (status != CAMBER_OK)
        part->scanned = false;
    return status;
}

camber_status camber_part_ensure_output(camber_mesh *mesh, camber_mesh_part *part) {
    const camber_status status = camber_part_ensure_counted(mesh, part);
    return status == CAMBER_OK && !part->emitted ? emit_unless_empty(mesh, part) : status;
}

/* The source of a tessellation: polylines, or else a network as a camera sees it. */
typedef struct source {
    const camber_polylines *polylines;
    camber_network *network;
    const camber_camera *camera;
    uint32_t row_count;
} source;

/* Adds up what the mesh is drawn from: its points, or its output. It is empty if it has no points. */
static void set_bytes(camber_mesh *mesh) {
    camber_mesh_info *info = &mesh->mesh_info;
    size_t slots = 0;
    for (size_t i = 0; i < mesh->part_count; i++)
        slots += mesh->parts[i].slot_count;
    info->bytes = mesh->draws_points
                      ? slots * camber_slot_bytes(info)
                      : info->record_count * camber_record_bytes(info) + (info->strips ? 0 : 4 * info->index_count);
    mesh->empty = slots == 0;
}

/* Divides the source into parts, and aims the camera at a network. */
static camber_status plan_parts(camber_mesh *mesh, const source *from, const camber_tessellation_desc *desc) {
    if (from->polylines)
        return camber_mesh_plan(mesh, from->polylines);
    const camber_status status = camber_mesh_plan_network(mesh, from->network);
    return status == CAMBER_OK ? camber_mesh_aim(mesh, from->camera, desc) : status;
}

/* Resets the mesh, notes which kinds of joins and caps its rows have, plans its parts and tessellates them. On failure
 * the mesh is empty. */
static camber_status tessellate(camber_mesh *mesh, const source *from, const camber_tessellation_desc *desc) {
    const camber_mesh_info nothing = {
        .method = desc->method, .strips = desc->method == CAMBER_METHOD_STRIP, .has_arc_length = desc->has_arc_length};
    camber_context *context = mesh->device->context;
    camber_row *rows = NULL;
    camber_status status = camber_check_process(context);
    if (status != CAMBER_OK)
        return status;
    mesh->empty = mesh->joins_counted = true;
    mesh->done = mesh->round_limits = mesh->sharp_joins = mesh->flat_caps = mesh->round_caps = mesh->wide = false;
    for (size_t i = 0; i < desc->stroke_count; i++) {
        const bool is_round = desc->strokes[i].join == CAMBER_JOIN_ROUND;
        mesh->round_limits |= is_round && desc->strokes[i].round_limit > 1.0f;
        mesh->sharp_joins |= !is_round || desc->strokes[i].round_limit > 1.0f;
        mesh->flat_caps |= desc->strokes[i].cap != CAMBER_CAP_ROUND;
        mesh->wide |= desc->strokes[i].width_px > 2.0f * CAMBER_TIPS_PX;
        mesh->round_caps |= desc->strokes[i].cap == CAMBER_CAP_ROUND;
    }
    mesh->mesh_info = nothing;
    mesh->has_camera = from->camera != NULL;
    mesh->pitch_deg = from->camera ? from->camera->pitch_deg : 0.0;
    mesh->remade_parts = 0;
    for (size_t i = 0; i < mesh->part_capacity; i++)
        mesh->parts[i].made = false;
    status = camber_rows_create(context, from->row_count, desc, &rows);
    if (status == CAMBER_OK)
        status = camber_mesh_set_offsets(mesh, desc);
    if (status == CAMBER_OK)
        status = plan_parts(mesh, from, desc);
    if (status == CAMBER_OK && mesh->part_count > 0) {
        mesh->joins_counted = false;
        status = upload_rows(mesh, rows, desc->stroke_count);
        if (status == CAMBER_OK)
            status = tessellate_parts(mesh);
        set_bytes(mesh);
        mesh->joins_counted |= status != CAMBER_OK;
    }
    if (status != CAMBER_OK) {
        mesh->mesh_info = nothing;
        camber_device_settle(mesh->device); /* what is written later is read from the source's arrays */
    }
    camber_mesh_let_go(mesh);
    mesh->done = status == CAMBER_OK;
    mesh->empty |= status != CAMBER_OK;
    camber_free(context, rows);
    return status;
}

camber_status camber_mesh_tessellate(camber_mesh *mesh, const camber_polylines *polylines,
                                     const camber_tessellation_desc *desc) {
    const source from = {.polylines = polylines, .row_count = polylines->row_count};
    return tessellate(mesh, &from, desc);
}

camber_status camber_mesh_tessellate_network(camber_mesh *mesh, camber_network *network, const camber_camera *camera,
                                             const camber_tessellation_desc *desc) {
    const source from = {.network = network, .camera = camera, .row_count = network->row_count};
    return tessellate(mesh, &from, desc);
}
