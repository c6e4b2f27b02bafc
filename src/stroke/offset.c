/* Makes offset lines, which run beside their source lines: offset_clip -> offset_count -> offset_emit on a device, and
 * the CPU twin.
 *
 * Input: slots of the source lines and each row's offset. Output: slots of the offset lines, which classify reads as if
 * they were the input. Main idea: it is not known in advance how many slots a source slot yields, so they are made in
 * three steps (kernels/offset.h has the geometry):
 *
 *     offset_clip   per slot: how much is left of the offset segment that begins there, and of the arc at its corner
 *     offset_count  per chunk of slots: how many slots it yields; the host adds these counts up
 *     offset_emit   per chunk: writes its slots where the sum says, and `places`: where each source slot's slots begin
 *
 * The twin walks the source lines slot by slot and appends. */
#include "stroke/offset.h"
#include "residency/memory.h"
#include "residency/parts.h"

#include "kernels/arc_length.h"

#include <math.h>

/* ---- Rows ---- */

/* A smaller offset changes no pixel, and would make segments so short that a float cannot hold their square. */
static bool has_visible_offset(const camber_stroke *stroke) {
    return fabsf(stroke->offset_px) >= 1e-3f;
}

bool camber_desc_has_offsets(const camber_tessellation_desc *desc) {
    bool has = false;
    for (size_t i = 0; i < desc->stroke_count; i++)
        has |= has_visible_offset(desc->strokes + i);
    return has;
}

/* Makes the values of rows that the offset kernels read: one more than there are strokes, since a buffer may not be
 * empty. */
static camber_status make_offset_rows(camber_context *context, const camber_tessellation_desc *desc,
                                      camber_offset_row **offset_rows) {
    camber_offset_row *made = camber_alloc_zero(context, desc->stroke_count + 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < desc->stroke_count; i++) {
        const camber_stroke *stroke = desc->strokes + i;
        made[i] = (camber_offset_row){.offset_px = has_visible_offset(stroke) ? stroke->offset_px : 0.0f,
                                      .miter_limit = stroke->miter_limit > 0.0f ? stroke->miter_limit : 2.0f,
                                      .join = (camber_u32)stroke->join};
    }
    *offset_rows = made;
    return CAMBER_OK;
}

static void release_offset_rows(camber_mesh *mesh) {
    camber_buffer_release(mesh->device, &mesh->offset_rows);
    mesh->offset_row_capacity = 0;
}

static camber_status upload_offset_rows(camber_mesh *mesh, const camber_tessellation_desc *desc) {
    const size_t count = desc->stroke_count + 1, size_bytes = count * sizeof(camber_offset_row);
    camber_offset_row *offset_rows = NULL;
    camber_status status = CAMBER_OK;
    if (count > mesh->offset_row_capacity) {
        release_offset_rows(mesh);
        status = camber_mesh_make_room(mesh, NULL, size_bytes);
        if (status == CAMBER_OK)
            status = camber_buffer_create(mesh->device, CAMBER_BUFFER_OWN, size_bytes, NULL, &mesh->offset_rows);
        mesh->offset_row_capacity = status == CAMBER_OK ? count : 0;
        camber_mesh_count_bytes(mesh);
    }
    if (status == CAMBER_OK)
        status = make_offset_rows(mesh->device->context, desc, &offset_rows);
    if (status == CAMBER_OK)
        status = camber_buffer_write(mesh->device, mesh->offset_rows, 0, size_bytes, offset_rows);
    camber_free(mesh->device->context, offset_rows);
    return status;
}

camber_status camber_mesh_set_offsets(camber_mesh *mesh, const camber_tessellation_desc *desc) {
    const bool offsets = camber_desc_has_offsets(desc);
    if (offsets != mesh->has_offsets) {
        for (size_t i = 0; i < mesh->part_capacity; i++)
            camber_part_release_buffers(mesh, mesh->parts + i);
        release_offset_rows(mesh);
        camber_mesh_count_bytes(mesh);
    }
    mesh->has_offsets = offsets;
    return offsets ? upload_offset_rows(mesh, desc) : CAMBER_OK;
}

/* ---- Stages ---- */

/* Replaces each chunk's count by the sum of the counts before it, and puts the total after the last. */
static camber_status scan_counts(const camber_device *device, camber_buffer *counts, size_t chunk_count,
                                 uint64_t *slots) {
    uint64_t sum = 0;
    uint32_t *mapped;
    const camber_status status =
        camber_buffer_map(device, counts, CAMBER_MAP_READ_WRITE, 4 * (chunk_count + 1), &mapped);
    if (status != CAMBER_OK)
        return status;
    for (size_t i = 0; i <= chunk_count; i++) {
        const uint64_t count = i < chunk_count ? mapped[i] : 0;
        mapped[i] = (uint32_t)sum;
        sum += count;
    }
    *slots = sum;
    return camber_buffer_unmap_written(device, counts, mapped);
}

static camber_status run_emit(camber_mesh *mesh, camber_mesh_part *part, const camber_program *program,
                              camber_event **event) {
    const camber_source_line_buffers *c = &part->source_line;
    const camber_kernel_arg args[] = {CAMBER_ARG_BUFFER(c->x),
                                      CAMBER_ARG_BUFFER(c->y),
                                      CAMBER_ARG_BUFFER(c->info),
                                      CAMBER_ARG_BUFFER(mesh->offset_rows),
                                      CAMBER_ARG_BUFFER(c->clips),
                                      CAMBER_ARG_BUFFER(c->counts),
                                      CAMBER_ARG_BUFFER(part->x),
                                      CAMBER_ARG_BUFFER(part->y),
                                      CAMBER_ARG_BUFFER(part->info),
                                      CAMBER_ARG_BUFFER(part->joins),
                                      CAMBER_ARG_BUFFER(c->places),
                                      CAMBER_ARG_BUFFER(mesh->mesh_info.has_arc_length ? c->arc_lengths : NULL),
                                      CAMBER_ARG_BUFFER(mesh->mesh_info.has_arc_length ? part->arc_lengths : NULL)};
    const camber_launch launch = {"offset_emit",
                                  program->offset_emit,
                                  args,
                                  13,
                                  part->given_count / CAMBER_OFFSET_CHUNK,
                                  mesh->device->block / CAMBER_OFFSET_CHUNK};
    return camber_launch_kernel(mesh->device, &launch, event);
}

/* Runs the three stages, with the sum of the counts between the second and the third. It stops if nothing is left of
 * the lines, or if the slots do not fit. An offset line has the arc lengths of its source line, so that a pattern
 * beside a road keeps step with the road. */
camber_status camber_part_offset(camber_mesh *mesh, camber_mesh_part *part, bool *fits) {
    const camber_device *device = mesh->device;
    const camber_source_line_buffers *c = &part->source_line;
    const size_t block = device->block, given = part->given_count;
    const camber_kernel_arg args[] = {CAMBER_ARG_BUFFER(c->x),     CAMBER_ARG_BUFFER(c->y),
                                      CAMBER_ARG_BUFFER(c->info),  CAMBER_ARG_BUFFER(mesh->offset_rows),
                                      CAMBER_ARG_BUFFER(c->clips), CAMBER_ARG_BUFFER(c->counts)};
    camber_event *events[3] = {NULL, NULL, NULL};
    camber_program *program = NULL;
    uint64_t slots = 0;
    /* The part's last output is invalid from here on, even if there are no slots now. */
    part->slot_count = part->used_slots = part->record_count = part->vertex_count = part->index_count = 0;
    camber_status status = camber_device_offset_program(mesh->device, mesh->mesh_info.has_arc_length, &program);
    if (status == CAMBER_OK)
        status = camber_launch_kernel(
            device, &(camber_launch){"offset_clip", program->offset_clip, args, 5, given, block}, events);
    if (status == CAMBER_OK)
        status = camber_launch_kernel(device,
                                      &(camber_launch){"offset_count", program->offset_count, args, 6,
                                                       given / CAMBER_OFFSET_CHUNK, block / CAMBER_OFFSET_CHUNK},
                                      events + 1);
    if (status == CAMBER_OK)
        status = scan_counts(device, c->counts, given / CAMBER_OFFSET_CHUNK, &slots);
    const uint64_t padded = (slots + block - 1) / block * block;
    if (status == CAMBER_OK)
        status = camber_part_check_slots(mesh, part, padded, fits);
    if (status == CAMBER_OK && *fits && slots > 0) {
        part->used_slots = (size_t)slots;
        status = camber_part_reserve_with_spare(mesh, part, (size_t)padded);
        if (status == CAMBER_OK)
            status = run_emit(mesh, part, program, events + 2);
    }
    for (size_t i = 0; i < 3; i++) {
        const camber_stage_id stage = (camber_stage_id)(CAMBER_STAGE_OFFSET_CLIP + i);
        if (status == CAMBER_OK)
            status = camber_event_wait(device, events[i], camber_stage_name(stage));
        camber_mesh_add_time(mesh, stage, events[i]);
    }
    return status;
}

/* ---- Twin ---- */

static camber_source_line source_line_of(const camber_polylines *polylines, const camber_offset_row *offset_rows,
                                         const camber_offset_clip *clips, const camber_arc_length *arc_lengths) {
    return (camber_source_line){.x = polylines->x,
                                .y = polylines->y,
                                .info = polylines->info,
                                .offset_rows = offset_rows,
                                .clips = clips,
                                .arc_lengths = (const float *)arc_lengths,
                                .slots = (camber_u32)polylines->slot_count};
}

/* Walks all source slots in order and emits the slots of the offset lines; first_slots receives where each line begins.
 */
static void emit_polylines(const camber_source_line *source_line, const camber_polylines *from,
                           camber_offset_writer *writer, uint32_t *first_slots) {
    size_t slot = 1;
    for (size_t i = 0; i < from->polyline_count; i++) {
        if (first_slots)
            first_slots[i] = writer->at - 1;
        for (; slot <= from->first_slots[i + 1]; slot++)
            camber_offset_emit_beside(source_line, (camber_u32)slot, writer);
    }
    if (first_slots)
        first_slots[from->polyline_count] = writer->at - 1;
}

/* Counts the slots of the offset lines in 64 bits, since 32 bits may not be enough. */
static uint64_t count_slots(const camber_source_line *source_line, const camber_polylines *from) {
    uint64_t count = 0;
    for (size_t slot = 1; slot <= from->first_slots[from->polyline_count]; slot++) {
        camber_offset_writer writer = camber_offset_writer_counting();
        camber_offset_emit_beside(source_line, (camber_u32)slot, &writer);
        count += writer.at;
    }
    return count;
}

/* Makes arrays for `count` slots, padded to whole blocks, and fills them. */
static camber_status emit_slots(const camber_source_line *source_line, const camber_polylines *from, size_t count,
                                camber_polylines *made) {
    camber_context *context = from->context;
    const size_t slots = (count + CAMBER_BLOCK - 1) / CAMBER_BLOCK * CAMBER_BLOCK;
    if (!(made->x = camber_alloc_zero(context, slots + 2, sizeof *made->x)) ||
        !(made->y = camber_alloc_zero(context, slots + 2, sizeof *made->y)) ||
        !(made->info = camber_alloc_zero(context, slots + 2, sizeof *made->info)) ||
        (source_line->arc_lengths &&
         !(made->arc_lengths = camber_alloc_zero(context, slots + 1, sizeof *made->arc_lengths))) ||
        !(made->first_slots = camber_alloc(context, from->polyline_count + 1, sizeof *made->first_slots)))
        return CAMBER_ERROR_MEMORY;
    camber_offset_writer writer = camber_offset_writer_counting();
    writer.x = made->x;
    writer.y = made->y;
    writer.info = made->info;
    writer.arc_lengths = (float *)made->arc_lengths;
    writer.emits = 1;
    writer.at = 1;
    emit_polylines(source_line, from, &writer, made->first_slots);
    made->slot_count = slots;
    return CAMBER_OK;
}

static camber_status make_offset_polylines(const camber_source_line *source_line, const camber_polylines *from,
                                           camber_polylines **beside) {
    camber_context *context = from->context;
    const uint64_t count = count_slots(source_line, from);
    if (count > UINT32_MAX - 1024u)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "%llu points beside lines are more than 32-bit slots hold; draw them in parts",
                           (unsigned long long)count);
    camber_polylines *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->polyline_count = from->polyline_count;
    made->row_count = from->row_count;
    const camber_status status = emit_slots(source_line, from, (size_t)count, made);
    if (status == CAMBER_OK)
        *beside = made;
    else
        camber_polylines_destroy(made);
    return status;
}

camber_status camber_polylines_offset(const camber_polylines *polylines, const camber_tessellation_desc *desc,
                                      const camber_arc_length *arc_lengths, camber_polylines **beside) {
    camber_context *context = polylines->context;
    camber_offset_row *offset_rows = NULL;
    camber_offset_clip *clips = camber_alloc_zero(context, polylines->slot_count + 2, sizeof *clips);
    camber_status status = clips ? make_offset_rows(context, desc, &offset_rows) : CAMBER_ERROR_MEMORY;
    const camber_source_line source_line = source_line_of(polylines, offset_rows, clips, arc_lengths);
    for (size_t i = 1; i <= polylines->slot_count && status == CAMBER_OK; i++)
        clips[i] = camber_offset_clip_of(&source_line, (camber_u32)i);
    if (status == CAMBER_OK)
        status = make_offset_polylines(&source_line, polylines, beside);
    camber_free(context, offset_rows);
    camber_free(context, clips);
    return status;
}
