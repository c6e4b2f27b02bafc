/* span, tell, shift: lines that lie beside those of the slots, in slots of their own.
 * span takes a work-item a slot: reads x, y, info[n + 2] and the rows' shifts; writes spans[n + 2] but for the first
 * and the last, which nobody reads. The others take a work-item a chunk of CAMBER_OFFSET_CHUNK slots: tell reads the
 * spans as well and writes counts[chunks], the slots that are made of each; shift reads bases[chunks + 1], the slots
 * before each chunk and all of them, and writes x, y, info[s + 2] with s these rounded up to CAMBER_BLOCK, a sentinel
 * before them and sentinels behind, the joins of the first sentinel and the last, which classify leaves, and places[n],
 * the slots that are made of those before each. Measured, it reads measures[2 * n] and writes out_measures[2 * s]. */
#define SOURCE_LINE                                                                                                    \
    global const float *restrict x, global const float *restrict y, global const camber_u32 *restrict info,            \
        global const camber_offset_row *restrict offset_rows, global camber_offset_clip *restrict clips
#define CHUNKS (CAMBER_BLOCK / CAMBER_OFFSET_CHUNK)
#if CAMBER_HAS_ARC_LENGTH
#define MEASURES , global const float *restrict measures, global float *restrict out_measures
#else
#define MEASURES
#endif

kernel __attribute__((reqd_work_group_size(CAMBER_BLOCK, 1, 1))) void offset_clip(SOURCE_LINE) {
    const camber_source_line source_line = {x, y, info, offset_rows, clips, 0, (camber_u32)get_global_size(0)};
    const camber_u32 slot = (camber_u32)get_global_id(0) + 1u;
    clips[slot] = camber_offset_clip_of(&source_line, slot);
}

kernel __attribute__((reqd_work_group_size(CHUNKS, 1, 1))) void offset_count(SOURCE_LINE,
                                                                             global camber_u32 *restrict counts) {
    const camber_u32 chunk = (camber_u32)get_global_id(0);
    const camber_source_line source_line = {
        x, y, info, offset_rows, clips, 0, (camber_u32)get_global_size(0) * CAMBER_OFFSET_CHUNK};
    camber_offset_writer writer = camber_offset_writer_counting();
    for (camber_u32 i = 1; i <= CAMBER_OFFSET_CHUNK; i++)
        camber_offset_emit_beside(&source_line, chunk * CAMBER_OFFSET_CHUNK + i, &writer);
    counts[chunk] = writer.at;
}

kernel __attribute__((reqd_work_group_size(CHUNKS, 1, 1))) void offset_emit(
    SOURCE_LINE, global const camber_u32 *restrict bases, global float *restrict out_x, global float *restrict out_y,
    global camber_u32 *restrict out_info, global camber_u32 *restrict joins,
    global camber_u32 *restrict places MEASURES) {
    const camber_u32 chunk = (camber_u32)get_global_id(0), chunks = (camber_u32)get_global_size(0);
    camber_source_line source_line = {x, y, info, offset_rows, clips, 0, chunks * CAMBER_OFFSET_CHUNK};
    camber_offset_writer writer = camber_offset_writer_counting();
    writer.x = out_x;
    writer.y = out_y;
    writer.info = out_info;
#if CAMBER_HAS_ARC_LENGTH
    source_line.measures = measures;
    writer.measures = out_measures;
#endif
    writer.emits = 1u;
    writer.at = bases[chunk] + 1u;
    for (camber_u32 i = 1; i <= CAMBER_OFFSET_CHUNK; i++) {
        const camber_u32 slot = chunk * CAMBER_OFFSET_CHUNK + i;
        places[slot - 1u] = writer.at - 1u;
        camber_offset_emit_beside(&source_line, slot, &writer);
    }
    if (chunk == 0u) {
        out_x[0] = out_y[0] = 0.0f;
        out_info[0] = joins[0] = 0u;
    }
    if (chunk + 1u == chunks) {
        const camber_u32 count = bases[chunks];
        const camber_u32 padded = (count + CAMBER_BLOCK - 1u) / CAMBER_BLOCK * CAMBER_BLOCK;
        for (camber_u32 i = count + 1u; i < padded + 2u; i++) {
            out_x[i] = out_y[i] = 0.0f;
            out_info[i] = 0u;
#if CAMBER_HAS_ARC_LENGTH
            if (i <= padded)
                out_measures[2u * (i - 1u)] = out_measures[2u * (i - 1u) + 1u] = 0.0f;
#endif
        }
        joins[padded + 1u] = 0u;
    }
}
