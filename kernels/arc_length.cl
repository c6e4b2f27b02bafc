/* tally, measure: how far along its polyline each slot lies, px, and how long that polyline is.
 * A work-item a chunk of CAMBER_ARC_LENGTH_CHUNK slots. tally reads x, y, info[n + 2]; writes sums[2 * chunks]: of the
 * segments into the chunk's points behind the last first point in it, and of those before the first last one. measure
 * reads what tally reads and carries[2 * chunks], what lies before the chunk of the line that it begins in, and behind
 * it of that it ends in; writes measures[2 * n]: along and in all. */

kernel __attribute__((reqd_work_group_size(CAMBER_BLOCK / CAMBER_ARC_LENGTH_CHUNK, 1, 1))) void arc_length_sum(
    global const float *restrict x, global const float *restrict y, global const camber_u32 *restrict info,
    global camber_u64 *restrict sums) {
    const size_t chunk = get_global_id(0), first = chunk * CAMBER_ARC_LENGTH_CHUNK + 1;
    camber_u64 ahead = 0, behind = 0;
    camber_u32 begins = 0, ends = 0;
    for (size_t i = first; i < first + CAMBER_ARC_LENGTH_CHUNK; i++) {
        const camber_u64 length = camber_length_into(x[i] - x[i - 1], y[i] - y[i - 1], info[i]);
        ahead = info[i] & CAMBER_POINT_FIRST ? 0 : ahead + length;
        behind += ends ? 0 : length;
        begins |= info[i] & CAMBER_POINT_FIRST ? CAMBER_SUM_CLOSED : 0u;
        ends |= info[i] & CAMBER_POINT_LAST ? CAMBER_SUM_CLOSED : 0u;
    }
    sums[2 * chunk] = ahead << CAMBER_SUM_SHIFT | begins;
    sums[2 * chunk + 1] = behind << CAMBER_SUM_SHIFT | ends;
}

kernel __attribute__((reqd_work_group_size(CAMBER_BLOCK / CAMBER_ARC_LENGTH_CHUNK, 1, 1))) void arc_length_scan(
    global const float *restrict x, global const float *restrict y, global const camber_u32 *restrict info,
    global const camber_u64 *restrict carries, global float *restrict measures) {
    const size_t chunk = get_global_id(0), first = chunk * CAMBER_ARC_LENGTH_CHUNK + 1;
    camber_u64 along[CAMBER_ARC_LENGTH_CHUNK];
    camber_u64 sum = carries[2 * chunk];
    for (size_t k = 0; k < CAMBER_ARC_LENGTH_CHUNK; k++) {
        const size_t i = first + k;
        sum = info[i] & CAMBER_POINT_FIRST ? 0 : sum + camber_length_into(x[i] - x[i - 1], y[i] - y[i - 1], info[i]);
        along[k] = sum;
    }
    sum = carries[2 * chunk + 1];
    for (size_t k = CAMBER_ARC_LENGTH_CHUNK; k-- > 0;) {
        const size_t i = first + k;
        sum = info[i] & CAMBER_POINT_LAST ? 0 : sum;
        const camber_u32 real = info[i] & CAMBER_POINT_REAL;
        measures[2 * (i - 1)] = real ? camber_length_px(along[k]) : 0.0f;
        measures[2 * (i - 1) + 1] = real ? camber_length_px(along[k] + sum) : 0.0f;
        sum += camber_length_into(x[i] - x[i - 1], y[i] - y[i - 1], info[i]);
    }
}
