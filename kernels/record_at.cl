/* A record of a mesh, for setup.cl and setup_gpu.cl. */
#ifndef CAMBER_RECORD_AT_CL
#define CAMBER_RECORD_AT_CL

#include "raster_args.h"

/* Flags of records that begin a polyline or a strip: no segment ends with them. */
#define STARTS (CAMBER_POINT_FIRST | CAMBER_RECORD_BREAK | CAMBER_RECORD_START)

/* Reads record i. A number outside the part stands for its nearest record. */
static inline uint4 record_at(global const camber_u32 *records, int i, camber_setup_args r) {
    const int last = (int)r.record_count - 1, at = i < 0 ? 0 : i > last ? last : i;
    return vload4((size_t)at * r.stride, records);
}

#endif
