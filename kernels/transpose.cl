/* Transposes as many vectors as a vector has lanes: from words of a segment each to segments of a word each. */
#ifndef CAMBER_TRANSPOSE_CL
#define CAMBER_TRANSPOSE_CL

#include "segment.h"

/* The lanes of two vectors in turn: of their lower or of their upper halves. */
static inline camber_real put_together(camber_real a, camber_real b, int upper) {
#if CAMBER_LANES == 16
    return upper ? (float16)(a.s8, b.s8, a.s9, b.s9, a.sa, b.sa, a.sb, b.sb, a.sc, b.sc, a.sd, b.sd, a.se, b.se, a.sf,
                             b.sf)
                 : (float16)(a.s0, b.s0, a.s1, b.s1, a.s2, b.s2, a.s3, b.s3, a.s4, b.s4, a.s5, b.s5, a.s6, b.s6, a.s7,
                             b.s7);
#else
    return upper ? (float8)(a.s4, b.s4, a.s5, b.s5, a.s6, b.s6, a.s7, b.s7)
                 : (float8)(a.s0, b.s0, a.s1, b.s1, a.s2, b.s2, a.s3, b.s3);
#endif
}

/* As many perfect shuffles as a lane's number has bits transpose the words. */
static inline void turn_over(camber_real *words) {
#pragma unroll
    for (int lanes = CAMBER_LANES; lanes > 1; lanes /= 2) {
        camber_real next[CAMBER_LANES];
#pragma unroll
        for (int i = 0; i < CAMBER_LANES / 2; i++) {
            next[2 * i] = put_together(words[i], words[i + CAMBER_LANES / 2], 0);
            next[2 * i + 1] = put_together(words[i], words[i + CAMBER_LANES / 2], 1);
        }
#pragma unroll
        for (int i = 0; i < CAMBER_LANES; i++)
            words[i] = next[i];
    }
}

#endif
