/* Tessellates a mesh on a device, one part at a time.
 *
 * Input: polylines, or a network and a camera; and strokes. Output: each part's points in its buffers, for GL also its
 * records and indices, and the mesh's counts. Main idea: sizes are computed first, and then the output. So buffers have
 * the exact size, no kernel needs an atomic, and the same input gives the same bytes.
 *
 *     slots of the part   uploaded, or the polylines' own; or projected from a network; or made beside source lines
 *        v  classify      per slot: its join word, from its neighbours and its row
 *     points              the rasterizer draws them
 *        |  mesh->output  counts and emits what GL draws (src/vertices/)
 *
 * If memory is limited and full, the last parts are not kept; camber_part_ensure_made makes them when they are needed.
 */
#include "kernels/stroke_ends.h"
#include "points/rows.h"
#include "residency/memory.h"
#include "residency/parts.h"
#include "stroke/arc_length.h"
#include "stroke/offset.h"
#include "stroke/stroke.h"

#include <string.h>

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
    /* Rows are on the host and on the device, and camber_grow may make the host's array half as large again. */
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

/* Makes a part's points. If they are too many, *fits is false and there are none. The steps, each only if the mesh
 * needs it:
 *
 *     1  slots: project them from the network, or upload them
 *     2  arc lengths of polylines; a network's slots already have theirs
 *     3  offset lines in place of their source lines
 *     4  classify: their join words. A mesh without output gets them when something needs them, which areas do not */
static camber_status make_points(camber_mesh *mesh, camber_mesh_part *part, bool *fits) {
    part->has_joins = part->scanned = part->emitted = false;
    camber_status status = mesh->held ? camber_part_project(mesh, part, fits)
                                      : camber_part_check_source_lines(mesh, part, part->given_count, fits);
    if (status == CAMBER_OK && *fits && !mesh->held)
        status = camber_part_upload(mesh, part);
    if (status == CAMBER_OK && *fits && mesh->mesh_info.has_arc_length && !mesh->held && part->given_count > 0)
        status = camber_part_sum_arc_lengths(mesh, part);
    if (status == CAMBER_OK && *fits && mesh->has_offsets && part->given_count > 0)
        status = camber_part_offset(mesh, part, fits);
    if (status == CAMBER_OK && *fits && part->slot_count > 0)
        status = mesh->output ? camber_part_classify(mesh, part, mesh->mesh_info.method)
                              : camber_device_finish(mesh->device); /* the caller may free what is uploaded */
    if (mesh->held) {
        camber_mesh_add_time(mesh, CAMBER_STAGE_CULL_EMIT, mesh->held->projected);
        mesh->held->projected = NULL;
    }
    return status;
}

/* Keeps a part's points, unless memory is full, and emits the part if the mesh is drawn from its output. */
static camber_status keep_part(camber_mesh *mesh, camber_mesh_part *part) {
    const uint64_t missing = mesh->output ? camber_part_missing_output_bytes(mesh, part) : 0;
    if (!mesh->is_full && !camber_mesh_evict_for(mesh, part, missing, true))
        mesh->is_full = true;
    if (mesh->is_full)
        return CAMBER_OK;
    const camber_status status = mesh->output ? mesh->output->emit(mesh, part) : CAMBER_OK;
    part->made = status == CAMBER_OK;
    return status;
}

/* Goes through the parts. If a part is cut, i stays, so that the first of the new parts is next.
 *
 *     points or output do not fit -> cut the part in two at the middle of its polylines
 *     else                        -> keep it, and its output, unless memory is full
 *
 * Once memory is full, parts are only made and counted. The first ones are kept, because they are drawn first. */
static camber_status tessellate_parts(camber_mesh *mesh) {
    camber_status status = CAMBER_OK;
    mesh->is_full = false;
    for (size_t i = 0; i < mesh->part_count && status == CAMBER_OK;) {
        bool fits = true;
        camber_part_recycle_buffers(mesh, mesh->parts + i, camber_device_share(mesh->device, 1));
        status = make_points(mesh, mesh->parts + i, &fits);
        if (status == CAMBER_OK && fits && mesh->output)
            status = mesh->output->count(mesh, mesh->parts + i, &fits);
        if (status == CAMBER_OK)
            status = fits ? keep_part(mesh, mesh->parts + i) : camber_mesh_halve(mesh, i);
        i += fits;
    }
    mesh->joins_counted |= camber_mesh_counts_early(mesh);
    return status;
}

camber_status camber_part_fail_remade(const camber_mesh *mesh, const camber_mesh_part *part, size_t slots,
                                      size_t records) {
    return camber_fail(mesh->device->context, CAMBER_ERROR_DEVICE,
                       "%s: a part of a mesh has %zu points and %zu records, and now %zu and %zu; update the driver or "
                       "try another device",
                       mesh->device->info.name, slots, records, part->slot_count, part->record_count);
}

camber_status camber_part_ensure_made(camber_mesh *mesh, camber_mesh_part *part) {
    const camber_mesh_info told = mesh->mesh_info;
    const size_t slots = part->slot_count, used = part->used_slots;
    bool fits = true;
    if (part->made || part->slot_count == 0)
        return CAMBER_OK;
    const camber_mesh_part before = *part;
    camber_part_recycle_buffers(mesh, part, camber_part_needed_bytes(mesh, part));
    camber_status status = make_points(mesh, part, &fits);
    if (status == CAMBER_OK && (!fits || part->slot_count != slots))
        status = camber_part_fail_remade(mesh, part, slots, before.record_count);
    part->record_count = before.record_count;
    part->vertex_count = before.vertex_count;
    part->index_count = before.index_count;
    if (status == CAMBER_OK && mesh->output)
        status = mesh->output->remake(mesh, part);
    part->made = status == CAMBER_OK;
    if (status != CAMBER_OK)
        camber_device_settle(mesh->device); /* a queued write may still read the host's arrays */
    part->slot_count = slots;
    part->used_slots = used;
    mesh->mesh_info = told;
    mesh->remade_parts++;
    return status;
}

camber_status camber_part_ensure_classified(camber_mesh *mesh, camber_mesh_part *part, camber_method method) {
    const camber_status status = camber_part_ensure_made(mesh, part);
    return status == CAMBER_OK && part->slot_count > 0 && (!part->has_joins || part->classified != method)
               ? camber_part_classify(mesh, part, method)
               : status;
}

camber_status camber_part_ensure_points(camber_mesh *mesh, camber_mesh_part *part) {
    return camber_part_ensure_classified(mesh, part, CAMBER_METHOD_STRIP);
}

/* The source of a tessellation: polylines, or else a network as a camera sees it. */
typedef struct source {
    const camber_polylines *polylines;
    camber_network *network;
    const camber_camera *camera;
    uint32_t row_count;
} source;

/* Adds up the bytes that the mesh is drawn from: of its points, or of its output. The mesh is empty if it has no
 * points. */
static void set_bytes(camber_mesh *mesh) {
    camber_mesh_info *info = &mesh->mesh_info;
    size_t slots = 0;
    for (size_t i = 0; i < mesh->part_count; i++)
        slots += mesh->parts[i].slot_count;
    info->bytes = mesh->output
                      ? info->record_count * camber_record_bytes(info) + (info->strips ? 0 : 4 * info->index_count)
                      : slots * camber_slot_bytes(info);
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
    for (camber_mesh *companion = mesh->companion; companion; companion = companion->companion)
        companion->empty = true;
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
        camber_device_settle(mesh->device); /* a queued write may still read the source's arrays */
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
