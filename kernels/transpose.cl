/* Transposes sixteen vectors: from the sixteen words of each segment to each word of sixteen segments. */
#ifndef CAMBER_TRANSPOSE_CL
#define CAMBER_TRANSPOSE_CL

#include "segment.h"

#if CAMBER_LANES == 16
static inline float16 put_together(float16 high, float16 low, int upper) {
    return upper ? (float16)(high.s8, low.s8, high.s9, low.s9, high.sa, low.sa, high.sb, low.sb, high.sc, low.sc,
                             high.sd, low.sd, high.se, low.se, high.sf, low.sf)
                 : (float16)(high.s0, low.s0, high.s1, low.s1, high.s2, low.s2, high.s3, low.s3, high.s4, low.s4,
                             high.s5, low.s5, high.s6, low.s6, high.s7, low.s7);
}

/* Four perfect shuffles of 256 words transpose them. */
static inline void turn_over(private float16 *words) {
#pragma unroll
    for (int turn = 0; turn < 4; turn++) {
        float16 next[16];
#pragma unroll
        for (int i = 0; i < 8; i++) {
            next[2 * i] = put_together(words[i], words[i + 8], 0);
            next[2 * i + 1] = put_together(words[i], words[i + 8], 1);
        }
#pragma unroll
        for (int i = 0; i < 16; i++)
            words[i] = next[i];
    }
}
#endif

#endif
