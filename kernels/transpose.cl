/* Transposes as many vectors as a vector has lanes: from vectors that hold the words of one segment to vectors that
 * hold one word of all segments. */
#ifndef CAMBER_TRANSPOSE_CL
#define CAMBER_TRANSPOSE_CL

#include "segment.h"

/* Interleaves the lanes of two vectors: those in their lower halves, or those in their upper halves. */
static inline camber_real put_together(camber_real a, camber_real b, int upper) {
#if CAMBER_LANES == 1
    return upper ? b : a;
#elif CAMBER_LANES == 16
    return upper ? (float16)(a.s8, b.s8, a.s9, b.s9, a.sa, b.sa, a.sb, b.sb, a.sc, b.sc, a.sd, b.sd, a.se, b.se, a.sf,
                             b.sf)
                 : (float16)(a.s0, b.s0, a.s1, b.s1, a.s2, b.s2, a.s3, b.s3, a.s4, b.s4, a.s5, b.s5, a.s6, b.s6, a.s7,
                             b.s7);
#else
    return upper ? (float8)(a.s4, b.s4, a.s5, b.s5, a.s6, b.s6, a.s7, b.s7)
                 : (float8)(a.s0, b.s0, a.s1, b.s1, a.s2, b.s2, a.s3, b.s3);
#endif
}

/* Transposes the words, by as many perfect shuffles as a lane's number has bits. */
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

/* Turns four vectors, which have four words of each lane in turn, into four vectors of one word each. */
static inline void turn_fours_over(const camber_words *v, camber_words *words) {
#if CAMBER_LANES == 1
    for (int k = 0; k < 4; k++)
        words[k] = v[k];
#elif CAMBER_LANES == 16
    words[0] = (uint16)(v[0].s048c, v[1].s048c, v[2].s048c, v[3].s048c);
    words[1] = (uint16)(v[0].s159d, v[1].s159d, v[2].s159d, v[3].s159d);
    words[2] = (uint16)(v[0].s26ae, v[1].s26ae, v[2].s26ae, v[3].s26ae);
    words[3] = (uint16)(v[0].s37bf, v[1].s37bf, v[2].s37bf, v[3].s37bf);
#else
    words[0] = (uint8)(v[0].s04, v[1].s04, v[2].s04, v[3].s04);
    words[1] = (uint8)(v[0].s15, v[1].s15, v[2].s15, v[3].s15);
    words[2] = (uint8)(v[0].s26, v[1].s26, v[2].s26, v[3].s26);
    words[3] = (uint8)(v[0].s37, v[1].s37, v[2].s37, v[3].s37);
#endif
}

#endif
