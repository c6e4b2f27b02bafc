/* scan: exclusive prefix sums of the counts within each block of CAMBER_BLOCK points, and each block's sum.
 * Reads joins[n + 1], info[n + 2]; writes offsets[n] and sums[n / CAMBER_BLOCK], both vertices | indices << 16.
 * The sums of blocks are few; the host adds them up in 64 bits and learns the sizes by it. */
kernel __attribute__((reqd_work_group_size(CAMBER_BLOCK, 1, 1))) void scan(global const camber_u32 *restrict joins,
                                                                           global const camber_u32 *restrict info,
                                                                           global camber_u32 *restrict offsets,
                                                                           global camber_u32 *restrict sums) {
    local camber_u32 total[2][CAMBER_BLOCK];
    const size_t i = get_global_id(0) + 1;
    const size_t lane = get_local_id(0);
    const camber_u32 own = camber_join_counts(joins[i], joins[i - 1], info[i], CAMBER_METHOD);
    total[0][lane] = own;
    camber_u32 from = 0;
    for (camber_u32 step = 1; step < CAMBER_BLOCK; step *= 2) {
        barrier(CLK_LOCAL_MEM_FENCE);
        total[1 - from][lane] = total[from][lane] + (lane >= step ? total[from][lane >= step ? lane - step : 0] : 0u);
        from = 1 - from;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    offsets[i - 1] = total[from][lane] - own;
    if (lane == CAMBER_BLOCK - 1)
        sums[get_group_id(0)] = total[from][lane];
}
