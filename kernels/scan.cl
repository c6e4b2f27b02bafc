/* scan: exclusive prefix sums of the counts within each block of CAMBER_BLOCK points, and each block's sum. A
 * work-group a block, CAMBER_SCAN_POINTS points a work-item: sums over 32 lanes are a tenth of the work of sums over
 * 256. Reads joins[n + 2], info[n + 2]; writes offsets[n] and sums[n / CAMBER_BLOCK], both vertices | indices << 16.
 * The sums of blocks are few; the host adds them up in 64 bits and learns the sizes by it. */
#define LANES (CAMBER_BLOCK / CAMBER_SCAN_POINTS)

kernel __attribute__((reqd_work_group_size(LANES, 1, 1))) void scan(global const camber_u32 *restrict joins,
                                                                    global const camber_u32 *restrict info,
                                                                    global camber_u32 *restrict offsets,
                                                                    global camber_u32 *restrict sums) {
    local camber_u32 total[2][LANES];
    const size_t lane = get_local_id(0);
    const size_t first = get_global_id(0) * CAMBER_SCAN_POINTS + 1;
    camber_u32 before[CAMBER_SCAN_POINTS + 1];
    before[0] = 0;
    for (size_t i = 0; i < CAMBER_SCAN_POINTS; i++)
        before[i + 1] =
            before[i] + camber_join_counts(joins[first + i], joins[first + i - 1], info[first + i], CAMBER_METHOD);
    total[0][lane] = before[CAMBER_SCAN_POINTS];
    camber_u32 from = 0;
    for (camber_u32 step = 1; step < LANES; step *= 2) {
        barrier(CLK_LOCAL_MEM_FENCE);
        total[1 - from][lane] = total[from][lane] + (lane >= step ? total[from][lane >= step ? lane - step : 0] : 0u);
        from = 1 - from;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const camber_u32 base = total[from][lane] - before[CAMBER_SCAN_POINTS];
    for (size_t i = 0; i < CAMBER_SCAN_POINTS; i++)
        offsets[first - 1 + i] = base + before[i];
    if (lane == LANES - 1)
        sums[get_group_id(0)] = total[from][lane];
}
