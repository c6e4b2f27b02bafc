/* Computes arc lengths: how far along its polyline each point is, for dashes and other things drawn along lines.
 *
 * On a device, arc_length_sum adds up each chunk of points, the host carries the sums from chunk to chunk, and
 * arc_length_scan writes every point's length. The CPU twin follows each polyline from its first point to its last.
 * Both add up integers (kernels/arc_length.h), so that the order does not matter and the two agree bit for bit. */
#include "stroke/arc_length.h"

#include "kernels/arc_length.h"

#include <string.h>

/* ---- Device ---- */

/* Replaces each chunk's two sums by the length of its first line before the chunk, and the length of its last line
 * after it. A closed sum means that a line begins in the chunk (or, counting backwards, ends in it), so that the sum
 * does not carry past it. */
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

static camber_status carry_sums(const camber_device *device, camber_buffer *sums, size_t chunk_count) {
    camber_u64 *mapped;
    const camber_status status = camber_buffer_map(device, sums, CAMBER_MAP_READ_WRITE, 16 * chunk_count, &mapped);
    if (status != CAMBER_OK)
        return status;
    carry(mapped, chunk_count);
    return camber_buffer_unmap_written(device, sums, mapped);
}

camber_status camber_part_sum_arc_lengths(camber_mesh *mesh, camber_mesh_part *part) {
    const camber_device *device = mesh->device;
    camber_program *program = NULL;
    camber_status status = camber_device_arc_length_program(mesh->device, &program);
    if (status != CAMBER_OK)
        return status;
    const camber_source_line_buffers *c = &part->source_line;
    const bool beside = mesh->has_offsets;
    camber_buffer *sums = beside ? c->lengths : part->lengths;
    const camber_kernel_arg args[] = {CAMBER_ARG_BUFFER(beside ? c->x : part->x),
                                      CAMBER_ARG_BUFFER(beside ? c->y : part->y),
                                      CAMBER_ARG_BUFFER(beside ? c->info : part->info), CAMBER_ARG_BUFFER(sums),
                                      CAMBER_ARG_BUFFER(beside ? c->arc_lengths : part->arc_lengths)};
    const size_t chunks = part->given_count / CAMBER_ARC_LENGTH_CHUNK, group = device->block / CAMBER_ARC_LENGTH_CHUNK;
    const camber_launch launches[] = {{"arc_length_sum", program->arc_length_sum, args, 4, chunks, group},
                                      {"arc_length_scan", program->arc_length_scan, args, 5, chunks, group}};
    status = camber_launch_kernel(device, launches, NULL);
    if (status == CAMBER_OK)
        status = carry_sums(device, sums, chunks);
    if (status == CAMBER_OK)
        status = camber_launch_kernel(device, launches + 1, NULL);
    return status;
}

/* ---- Twin ---- */

/* Measures the slots [first, end), from the first point of a stretch to its last. The first of two passes finds the
 * total. */
static void measure_piece(const camber_polylines *p, size_t first, size_t end, camber_arc_length *arc_lengths) {
    camber_u64 sum = 0;
    for (size_t pass = 0; pass < 2; pass++) {
        const camber_u64 total = sum;
        sum = 0;
        for (size_t i = first; i < end; i++) {
            if (i > first)
                sum += camber_length_of(p->x[i] - p->x[i - 1], p->y[i] - p->y[i - 1], CAMBER_LENGTH_UNITS);
            if (pass == 1)
                arc_lengths[i - 1] = (camber_arc_length){camber_length_px(sum), camber_length_px(total)};
        }
    }
}

camber_status camber_polylines_sum_arc_lengths(const camber_polylines *polylines, camber_arc_length **arc_lengths) {
    camber_arc_length *made = camber_alloc_zero(polylines->context, polylines->slot_count + 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    if (polylines->arc_lengths)
        memcpy(made, polylines->arc_lengths, polylines->slot_count * sizeof *made);
    for (size_t i = 1; i <= polylines->slot_count && !polylines->arc_lengths; i++) {
        if (!(polylines->info[i] & CAMBER_POINT_FIRST))
            continue;
        const size_t first = i;
        while (!(polylines->info[i] & CAMBER_POINT_LAST))
            i++;
        measure_piece(polylines, first, i + 1, made);
    }
    *arc_lengths = made;
    return CAMBER_OK;
}
