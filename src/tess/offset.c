/* Makes lines that lie beside others: offset_clip -> offset_count -> offset_emit on a device, and the CPU twin.
 *
 * Input: slots of the source lines and each row's offset. Output: slots of the offset lines, which classify reads as if
 * they had been given. Main idea: how many slots come of a source slot is not known before, so that they are made in
 * three steps (kernels/offset.h has the geometry):
 *
 *     offset_clip   a slot: how much is left of the offset segment that begins there, and of the arc at its corner
 *     offset_count  a chunk of slots: how many slots come of it; the host adds these counts up
 *     offset_emit   a chunk: writes its slots where the sum says, and for each source slot where its own begin (places)
 *
 * The twin walks the source lines slot by slot and appends. */
#include "tess/offset.h"

#include "kernels/measure.h"

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

/* Makes the rows' values for the offset kernels: one more than there are strokes, as a buffer may not be empty. */
static camber_status make_shifts(camber_context *context, const camber_tessellation_desc *desc, camber_shift **shifts) {
    camber_shift *made = camber_alloc_zero(context, desc->stroke_count + 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    for (size_t i = 0; i < desc->stroke_count; i++) {
        const camber_stroke *stroke = desc->strokes + i;
        made[i] = (camber_shift){.offset_px = has_visible_offset(stroke) ? stroke->offset_px : 0.0f,
                                 .miter_limit = stroke->miter_limit > 0.0f ? stroke->miter_limit : 2.0f,
                                 .join = (camber_u32)stroke->join};
    }
    *shifts = made;
    return CAMBER_OK;
}

static void release_shifts(camber_mesh *mesh) {
    camber_release_buffer(mesh->device, &mesh->shifts);
    mesh->shift_capacity = 0;
}

static camber_status upload_shifts(camber_mesh *mesh, const camber_tessellation_desc *desc) {
    const size_t count = desc->stroke_count + 1, size_bytes = count * sizeof(camber_shift);
    camber_shift *shifts = NULL;
    camber_status status = CAMBER_OK;
    if (count > mesh->shift_capacity) {
        release_shifts(mesh);
        status = camber_mesh_make_room(mesh, NULL, size_bytes);
        if (status == CAMBER_OK)
            status = camber_make_buffer(mesh->device, CL_MEM_READ_WRITE, size_bytes, NULL, &mesh->shifts);
        mesh->shift_capacity = status == CAMBER_OK ? count : 0;
        camber_mesh_count_bytes(mesh);
    }
    if (status == CAMBER_OK)
        status = make_shifts(mesh->device->context, desc, &shifts);
    if (status == CAMBER_OK)
        status = camber_write_buffer(mesh->device, mesh->shifts, 0, size_bytes, shifts);
    camber_free(mesh->device->context, shifts);
    return status;
}

camber_status camber_mesh_set_offsets(camber_mesh *mesh, const camber_tessellation_desc *desc) {
    const bool offsets = camber_desc_has_offsets(desc);
    if (offsets != mesh->has_offsets) {
        for (size_t i = 0; i < mesh->part_capacity; i++)
            camber_part_release_buffers(mesh, mesh->parts + i);
        release_shifts(mesh);
        camber_mesh_count_bytes(mesh);
    }
    mesh->has_offsets = offsets;
    return offsets ? upload_shifts(mesh, desc) : CAMBER_OK;
}

/* ---- Buffers ---- */

enum { COURSE_BUFFERS = 8 };

void camber_course_release(const camber_device *device, camber_part_course *course) {
    cl_mem *mems[COURSE_BUFFERS] = {&course->x,      &course->y,      &course->info,    &course->spans,
                                    &course->counts, &course->places, &course->lengths, &course->measures};
    for (size_t i = 0; i < COURSE_BUFFERS; i++)
        camber_release_buffer(device, mems[i]);
    course->slot_capacity = 0;
}

camber_status camber_part_check_course(const camber_mesh *mesh, const camber_mesh_part *part, uint64_t slots,
                                       bool *fits) {
    const uint64_t size_bytes = sizeof(camber_span) * (slots + 2);
    if (!mesh->has_offsets || size_bytes <= mesh->device->info.largest_buffer_bytes)
        return CAMBER_OK;
    *fits = false;
    return part->polyline_count > 1 ? CAMBER_OK : camber_fail_polyline(mesh, part->first_polyline, size_bytes);
}

/* Makes the buffers of source lines; the last two only with arc lengths. */
static camber_status make_course(const camber_device *device, bool measured, camber_part_course *course, size_t slots) {
    const size_t words = slots + 2;
    const struct {
        cl_mem *mem;
        size_t size_bytes;
    } wanted[COURSE_BUFFERS] = {
        {&course->x, 4 * words},
        {&course->y, 4 * words},
        {&course->info, 4 * words},
        {&course->spans, sizeof(camber_span) * words},
        {&course->counts, 4 * (slots / CAMBER_OFFSET_CHUNK + 1)},
        {&course->places, 4 * slots},
        {&course->lengths, 16 * slots / CAMBER_MEASURE_CHUNK},
        {&course->measures, sizeof(camber_measure) * slots},
    };
    const size_t count = measured ? COURSE_BUFFERS : COURSE_BUFFERS - 2;
    camber_status status = CAMBER_OK;
    camber_course_release(device, course);
    for (size_t i = 0; i < count && status == CAMBER_OK; i++)
        status = camber_make_buffer(device, CL_MEM_READ_WRITE, wanted[i].size_bytes, NULL, wanted[i].mem);
    if (status == CAMBER_OK)
        course->slot_capacity = slots;
    else
        camber_course_release(device, course);
    return status;
}

camber_status camber_part_reserve_course(camber_mesh *mesh, camber_mesh_part *part, size_t slots) {
    const bool measured = mesh->mesh_info.measured;
    const camber_device *device = mesh->device;
    const uint64_t wanted = camber_course_bytes(measured, slots);
    if (slots <= part->course.slot_capacity && (!measured || part->course.measures))
        return CAMBER_OK;
    if (wanted > camber_device_share(device, 4))
        return camber_fail_memory(mesh, part->first_polyline, wanted);
    const uint64_t held = camber_course_bytes(part->course.measures != NULL, part->course.slot_capacity);
    camber_status status = camber_mesh_make_room(mesh, part, wanted > held ? wanted - held : 0);
    if (status == CAMBER_OK)
        status = make_course(device, measured, &part->course, slots);
    part->uploaded = false;
    camber_part_count_bytes(mesh, part);
    return status;
}

/* ---- Stages ---- */

/* Replaces each chunk's count by the sum of the counts before it, and puts the sum of all behind the last. */
static camber_status scan_counts(const camber_device *device, cl_mem counts, size_t chunk_count, uint64_t *slots) {
    cl_int code;
    uint64_t sum = 0;
    cl_uint *mapped = clEnqueueMapBuffer(device->queue, counts, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0,
                                         4 * (chunk_count + 1), 0, NULL, NULL, &code);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clEnqueueMapBuffer", code);
    for (size_t i = 0; i <= chunk_count; i++) {
        const uint64_t count = i < chunk_count ? mapped[i] : 0;
        mapped[i] = (cl_uint)sum;
        sum += count;
    }
    *slots = sum;
    code = clEnqueueUnmapMemObject(device->queue, counts, mapped, 0, NULL, NULL);
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(device->context, "clEnqueueUnmapMemObject", code);
}

static camber_status run_shift(camber_mesh *mesh, camber_mesh_part *part, const camber_program *program,
                               cl_event *event) {
    const camber_part_course *c = &part->course;
    const cl_mem mems[] = {c->x,    c->y,       c->info,     mesh->shifts, c->spans,    c->counts,     part->x,
                           part->y, part->info, part->joins, c->places,    c->measures, part->measures};
    const cl_uint mem_count = mesh->mesh_info.measured ? 13 : 11;
    return camber_stage_run(
        mesh->device, (camber_stage){"shift", program->shift, mems, mem_count, CAMBER_OFFSET_CHUNK, part->given_count},
        event);
}

/* Runs the three stages, with the sum of the counts between the second and the third. It stops where nothing is left of
 * the lines, or where the slots do not fit. An offset line has the arc lengths of its source line, so that a pattern
 * beside a road keeps step with the road. */
camber_status camber_part_offset(camber_mesh *mesh, camber_mesh_part *part, bool *fits) {
    const camber_device *device = mesh->device;
    const camber_part_course *c = &part->course;
    const size_t block = device->block, given = part->given_count;
    const cl_mem mems[] = {c->x, c->y, c->info, mesh->shifts, c->spans, c->counts};
    cl_event events[3] = {NULL, NULL, NULL};
    camber_program *program = NULL;
    uint64_t slots = 0;
    /* The part's last output is invalid from here on, also where no slot comes out now. */
    part->slot_count = part->record_count = part->vertex_count = part->index_count = 0;
    part->course.made_count = 0;
    camber_status status = camber_device_offsets(mesh->device, mesh->mesh_info.measured, &program);
    if (status == CAMBER_OK)
        status = camber_stage_run(device, (camber_stage){"span", program->span, mems, 5, 1, given}, events);
    if (status == CAMBER_OK)
        status = camber_stage_run(device, (camber_stage){"tell", program->tell, mems, 6, CAMBER_OFFSET_CHUNK, given},
                                  events + 1);
    if (status == CAMBER_OK)
        status = scan_counts(device, c->counts, given / CAMBER_OFFSET_CHUNK, &slots);
    const uint64_t padded = (slots + block - 1) / block * block;
    if (status == CAMBER_OK)
        status = camber_part_check_slots(mesh, part, padded, fits);
    if (status == CAMBER_OK && *fits && slots > 0) {
        part->course.made_count = (size_t)slots;
        status = camber_part_reserve_with_spare(mesh, part, (size_t)padded);
        if (status == CAMBER_OK)
            status = run_shift(mesh, part, program, events + 2);
    }
    for (size_t i = 0; i < 3; i++) {
        if (events[i] && status == CAMBER_OK)
            clWaitForEvents(1, events + i);
        camber_add_ms(events[i], &mesh->mesh_info.offset_ms);
    }
    return status;
}

/* ---- Twin ---- */

static camber_course course_of(const camber_polylines *polylines, const camber_shift *shifts, const camber_span *spans,
                               const camber_measure *measures) {
    return (camber_course){.x = polylines->x,
                           .y = polylines->y,
                           .info = polylines->info,
                           .shifts = shifts,
                           .spans = spans,
                           .measures = (const float *)measures,
                           .slots = (camber_u32)polylines->slot_count};
}

/* Walks all source slots in order and emits the slots of the offset lines; first_slots takes where each line begins. */
static void emit_polylines(const camber_course *course, const camber_polylines *from, camber_pen *pen,
                           uint32_t *first_slots) {
    size_t slot = 1;
    for (size_t i = 0; i < from->polyline_count; i++) {
        if (first_slots)
            first_slots[i] = pen->at - 1;
        for (; slot <= from->first_slots[i + 1]; slot++)
            camber_put_beside(course, (camber_u32)slot, pen);
    }
    if (first_slots)
        first_slots[from->polyline_count] = pen->at - 1;
}

/* Counts the slots of the offset lines in 64 bits, as there may be more than 32 bits number. */
static uint64_t count_slots(const camber_course *course, const camber_polylines *from) {
    uint64_t count = 0;
    for (size_t slot = 1; slot <= from->first_slots[from->polyline_count]; slot++) {
        camber_pen pen = camber_pen_counting();
        camber_put_beside(course, (camber_u32)slot, &pen);
        count += pen.at;
    }
    return count;
}

/* Makes arrays for count slots, padded to whole blocks, and fills them. */
static camber_status emit_slots(const camber_course *course, const camber_polylines *from, size_t count,
                                camber_polylines *made) {
    camber_context *context = from->context;
    const size_t slots = (count + CAMBER_BLOCK - 1) / CAMBER_BLOCK * CAMBER_BLOCK;
    if (!(made->x = camber_alloc_zero(context, slots + 2, sizeof *made->x)) ||
        !(made->y = camber_alloc_zero(context, slots + 2, sizeof *made->y)) ||
        !(made->info = camber_alloc_zero(context, slots + 2, sizeof *made->info)) ||
        (course->measures && !(made->measures = camber_alloc_zero(context, slots + 1, sizeof *made->measures))) ||
        !(made->first_slots = camber_alloc(context, from->polyline_count + 1, sizeof *made->first_slots)))
        return CAMBER_ERROR_MEMORY;
    camber_pen pen = camber_pen_counting();
    pen.x = made->x;
    pen.y = made->y;
    pen.info = made->info;
    pen.measures = (float *)made->measures;
    pen.puts = 1;
    pen.at = 1;
    emit_polylines(course, from, &pen, made->first_slots);
    made->slot_count = slots;
    return CAMBER_OK;
}

static camber_status make_offset_polylines(const camber_course *course, const camber_polylines *from,
                                           camber_polylines **beside) {
    camber_context *context = from->context;
    const uint64_t count = count_slots(course, from);
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
    const camber_status status = emit_slots(course, from, (size_t)count, made);
    if (status == CAMBER_OK)
        *beside = made;
    else
        camber_polylines_destroy(made);
    return status;
}

camber_status camber_polylines_offset(const camber_polylines *polylines, const camber_tessellation_desc *desc,
                                      const camber_measure *measures, camber_polylines **beside) {
    camber_context *context = polylines->context;
    camber_shift *shifts = NULL;
    camber_span *spans = camber_alloc_zero(context, polylines->slot_count + 2, sizeof *spans);
    camber_status status = spans ? make_shifts(context, desc, &shifts) : CAMBER_ERROR_MEMORY;
    const camber_course course = course_of(polylines, shifts, spans, measures);
    for (size_t i = 1; i <= polylines->slot_count && status == CAMBER_OK; i++)
        spans[i] = camber_span_of(&course, (camber_u32)i);
    if (status == CAMBER_OK)
        status = make_offset_polylines(&course, polylines, beside);
    camber_free(context, shifts);
    camber_free(context, spans);
    return status;
}
