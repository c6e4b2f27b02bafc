/* Arc lengths: how far along its polyline each point lies, for dashes and other things drawn along lines.
 *
 * On a device, arc_length_sum adds up each chunk of points, the host carries the sums from chunk to chunk, and
 * arc_length_scan writes every point's length. The CPU twin goes along each polyline from its first point to its last.
 * Both add up integers (kernels/measure.h), so that the order does not matter and they agree bit for bit. */
#include "tess/measures.h"

#include "kernels/measure.h"

#include <string.h>

/* ---- Device ---- */

/* Replaces each chunk's two sums by the lengths that its first line has before the chunk, and its last line behind it.
 * A closed sum means that a line begins, or seen from behind ends, in the chunk: past it is another line. */
static void carry(camber_u64 *sums, size_t chunk_count) {
    camber_u64 before = 0, behind = 0;
    for (size_t i = 0; i < chunk_count; i++) {
        const camber_u64 sum = sums[2 * i];
        sums[2 * i] = before;
        before = (sum & CAMBER_SUM_CLOSED ? 0 : before) + (sum >> CAMBER_SUM_SHIFT);
    }
    for (size_t i = chunk_count; i-- > 0;) {
        const camber_u64 sum = sums[2 * i + 1];
        sums[2 * i + 1] = behind;
        behind = (sum & CAMBER_SUM_CLOSED ? 0 : behind) + (sum >> CAMBER_SUM_SHIFT);
    }
}

static camber_status carry_sums(const camber_device *device, cl_mem sums, size_t chunk_count) {
    cl_int code;
    camber_u64 *mapped = clEnqueueMapBuffer(device->queue, sums, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0,
                                            16 * chunk_count, 0, NULL, NULL, &code);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clEnqueueMapBuffer", code);
    carry(mapped, chunk_count);
    code = clEnqueueUnmapMemObject(device->queue, sums, mapped, 0, NULL, NULL);
    return code == CL_SUCCESS ? CAMBER_OK : camber_fail_cl(device->context, "clEnqueueUnmapMemObject", code);
}

camber_status camber_part_measure(camber_mesh *mesh, camber_mesh_part *part) {
    const camber_device *device = mesh->device;
    camber_program *program = NULL;
    camber_status status = camber_device_measures(mesh->device, &program);
    if (status != CAMBER_OK)
        return status;
    const camber_part_course *c = &part->course;
    const cl_mem mems[] = {mesh->has_offsets ? c->x : part->x, mesh->has_offsets ? c->y : part->y,
                           mesh->has_offsets ? c->info : part->info, mesh->has_offsets ? c->lengths : part->lengths,
                           mesh->has_offsets ? c->measures : part->measures};
    const camber_stage stages[] = {{"tally", program->tally, mems, 4, CAMBER_MEASURE_CHUNK, part->given_count},
                                   {"measure", program->measure, mems, 5, CAMBER_MEASURE_CHUNK, part->given_count}};
    status = camber_stage_run(device, stages[0], NULL);
    if (status == CAMBER_OK)
        status = carry_sums(device, mems[3], part->given_count / CAMBER_MEASURE_CHUNK);
    if (status == CAMBER_OK)
        status = camber_stage_run(device, stages[1], NULL);
    return status;
}

/* ---- Twin ---- */

/* Measures the slots [first, end), from the first point of a stretch to its last. The first pass finds the total. */
static void measure_piece(const camber_polylines *p, size_t first, size_t end, camber_measure *measures) {
    camber_u64 sum = 0;
    for (size_t pass = 0; pass < 2; pass++) {
        const camber_u64 total = sum;
        sum = 0;
        for (size_t i = first; i < end; i++) {
            if (i > first)
                sum += camber_length_of(p->x[i] - p->x[i - 1], p->y[i] - p->y[i - 1], CAMBER_LENGTH_UNITS);
            if (pass == 1)
                measures[i - 1] = (camber_measure){camber_length_px(sum), camber_length_px(total)};
        }
    }
}

camber_status camber_polylines_measure(const camber_polylines *polylines, camber_measure **measures) {
    camber_measure *made = camber_alloc_zero(polylines->context, polylines->slot_count + 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    if (polylines->measures)
        memcpy(made, polylines->measures, polylines->slot_count * sizeof *made);
    for (size_t i = 1; i <= polylines->slot_count && !polylines->measures; i++) {
        if (!(polylines->info[i] & CAMBER_POINT_FIRST))
            continue;
        const size_t first = i;
        while (!(polylines->info[i] & CAMBER_POINT_LAST))
            i++;
        measure_piece(polylines, first, i + 1, made);
    }
    *measures = made;
    return CAMBER_OK;
}
