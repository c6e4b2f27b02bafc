/* The vectors that the rasterizer computes with: types and conversions that depend on the number of lanes.
 *
 * CAMBER_LANES is 1 in C, in shaders and on GPUs, which take one segment or pixel at a time. On a CPU device it is 8 or
 * 16, which the build sets. A formula over camber_real, camber_words and camber_mask gives the same bits in each lane,
 * whatever the number of lanes. A formula that combines lanes, such as the largest of them, has to say which lanes
 * count. */
#ifndef CAMBER_KERNELS_LANES_H
#define CAMBER_KERNELS_LANES_H

#include "layout.h"

#if defined(CAMBER_DEVICE) && !defined(CAMBER_LANES)
#define CAMBER_LANES 16
#endif
#if defined(CAMBER_DEVICE) && CAMBER_LANES > 1
#define CAMBER_HAS_VECTORS 1
#else
#define CAMBER_HAS_VECTORS 0
#endif

#if CAMBER_HAS_VECTORS

/* The name of a vector type or of its conversion: CAMBER_OF_LANES(float) is float16 if there are 16 lanes. */
#define CAMBER_PASTE_LANES(name, lanes) name##lanes
#define CAMBER_PASTED_LANES(name, lanes) CAMBER_PASTE_LANES(name, lanes)
#define CAMBER_OF_LANES(name) CAMBER_PASTED_LANES(name, CAMBER_LANES)

typedef CAMBER_OF_LANES(float) camber_real;
typedef CAMBER_OF_LANES(uint) camber_words;
typedef CAMBER_OF_LANES(int) camber_mask; /* all bits of a lane, or none */
typedef CAMBER_OF_LANES(ulong) camber_long_words;

#define CAMBER_TO_REAL(x) CAMBER_OF_LANES(convert_float)(x) /* of words or of integers */
/* Truncates reals from 0 on, below 2^31, to integers: AVX2 converts only to integers with a sign. */
#define CAMBER_TO_WORDS(x) CAMBER_AS_WORDS(CAMBER_TO_INTEGERS(x))
#define CAMBER_TO_INTEGERS(x) CAMBER_OF_LANES(convert_int)(x)
#define CAMBER_TO_LONG_WORDS(x) CAMBER_OF_LANES(convert_ulong)(x)
#define CAMBER_AS_REAL(x) CAMBER_OF_LANES(as_float)(x)
#define CAMBER_AS_WORDS(x) CAMBER_OF_LANES(as_uint)(x)
#define CAMBER_AS_INTEGERS(x) CAMBER_OF_LANES(as_int)(x)
#define CAMBER_LOAD(at, from) CAMBER_OF_LANES(vload)(at, from)
#define CAMBER_STORE(vector, at, to) CAMBER_OF_LANES(vstore)(vector, at, to)
#define CAMBER_ANY(mask) camber_any(mask)
#define CAMBER_ALL(mask) camber_all(mask)
#define CAMBER_BITS(x) as_uint(x) /* the bits of one float */
#define CAMBER_ALL_LANES(flag) ((camber_mask)((flag) ? -1 : 0))

#elif defined(CAMBER_GLSL)

#define CAMBER_LANES 1
#define camber_real float
#define camber_words uint
#define camber_mask bool
#define CAMBER_REAL(x) float(x)
#define CAMBER_WORD(x) uint(x)
#define CAMBER_TO_REAL(x) float(x)
#define CAMBER_TO_INTEGERS(x) int(x)
#define CAMBER_AS_INTEGERS(x) int(x)
#define CAMBER_ALL_LANES(flag) (flag)
#define CAMBER_MORE(a, b) max(a, b)
#define CAMBER_LESS(a, b) min(a, b)
#define CAMBER_COLOR(color) inout float color[4]

#else

#ifndef CAMBER_DEVICE
#undef CAMBER_LANES
#define CAMBER_LANES 1
#endif

typedef float camber_real;
typedef camber_u32 camber_words;
typedef int camber_mask; /* 1 or 0 */

#ifdef CAMBER_DEVICE
#define camber_bits_of(value) as_uint(value)
#define camber_float_of(bits) as_float(bits)
#else
CAMBER_FN camber_u32 camber_bits_of(float value) {
    union {
        float value;
        camber_u32 bits;
    } word = {value};
    return word.bits;
}

CAMBER_FN float camber_float_of(camber_u32 bits) {
    union {
        camber_u32 bits;
        float value;
    } word = {bits};
    return word.value;
}
#endif

#define CAMBER_TO_REAL(x) ((float)(x))
#define CAMBER_TO_WORDS(x) ((camber_u32)(x))
#define CAMBER_TO_INTEGERS(x) ((camber_i32)(x))
#define CAMBER_AS_REAL(x) camber_float_of(x)
#define CAMBER_AS_WORDS(x) camber_bits_of(x)
#define CAMBER_AS_INTEGERS(x) ((camber_i32)(x))
#define CAMBER_LOAD(at, from) ((from)[at])
#define CAMBER_STORE(vector, at, to) ((void)((to)[at] = (vector)))
#define CAMBER_ANY(mask) ((mask) != 0)
#define CAMBER_ALL(mask) ((mask) != 0)
#define CAMBER_BITS(x) camber_bits_of(x)
#define CAMBER_ALL_LANES(flag) ((flag) != 0)

#endif

#ifndef CAMBER_GLSL
#define CAMBER_REAL(x) ((camber_real)(x))
#define CAMBER_WORD(x) ((camber_words)(x))
#define CAMBER_MORE(a, b) ((a) > (b) ? (a) : (b))
#define CAMBER_LESS(a, b) ((a) < (b) ? (a) : (b))
#define CAMBER_COLOR(color) camber_real color[4]
#endif
#define CAMBER_TRUNCATE(x) CAMBER_TO_REAL(CAMBER_TO_INTEGERS(x))
/* The nearest integers to reals below 2^22, as words: the added constant leaves no bits for fractions. */
#define CAMBER_ROUNDED_WORDS(x) (CAMBER_AS_WORDS((x) + 12582912.0f) - 0x4b400000u)
/* The low 16 bits of join words, as signed numbers. */
#define CAMBER_TURNS(joins) CAMBER_TO_REAL(CAMBER_AS_INTEGERS((joins) << 16) >> 16)

#ifndef CAMBER_GLSL
/* Returns lane k of a vector in memory: of reals, and of integers. */
CAMBER_FN float camber_lane_of(const camber_real *vector, int k) {
    return ((const float *)vector)[k];
}

CAMBER_FN int camber_integer_of(const camber_mask *vector, int k) {
    return ((const int *)vector)[k];
}
#endif

#if CAMBER_HAS_VECTORS
/* Returns which lanes of a mask are set, one bit each, the first lane the lowest. Processors know that in an
 * instruction, for which OpenCL C has no words. */
#if defined(CAMBER_AHEAD_OF_TIME) && defined(__AVX512DQ__) && CAMBER_LANES == 16
CAMBER_FN camber_u32 camber_lanes_set(camber_mask mask) {
    return (ushort)__builtin_ia32_cvtd2mask512(mask);
}
#elif defined(CAMBER_AHEAD_OF_TIME) && defined(__AVX__) && CAMBER_LANES == 8
CAMBER_FN camber_u32 camber_lanes_set(camber_mask mask) {
    return (camber_u32)__builtin_ia32_movmskps256(as_float8(mask));
}
#else
constant uint LANE_BITS[16] = {0x1,   0x2,   0x4,   0x8,   0x10,   0x20,   0x40,   0x80,
                               0x100, 0x200, 0x400, 0x800, 0x1000, 0x2000, 0x4000, 0x8000};

CAMBER_FN camber_u32 camber_lanes_set(camber_mask mask) {
    const camber_words bits = CAMBER_AS_WORDS(mask) & CAMBER_LOAD(0, LANE_BITS);
#if CAMBER_LANES == 16
    const uint8 eight = bits.lo | bits.hi;
#else
    const uint8 eight = bits;
#endif
    const uint4 four = eight.lo | eight.hi;
    const uint2 two = four.lo | four.hi;
    return two.x | two.y;
}
#endif

/* Whether any lane of a mask is set, and whether all are. PoCL's own any and all look at one lane after another. */
CAMBER_FN int camber_any(camber_mask mask) {
    return camber_lanes_set(mask) != 0u;
}

CAMBER_FN int camber_all(camber_mask mask) {
    return camber_lanes_set(mask) == (1u << CAMBER_LANES) - 1u;
}
#elif !defined(CAMBER_GLSL)
CAMBER_FN camber_u32 camber_lanes_set(camber_mask mask) {
    return mask ? 1u : 0u;
}
#endif

/* Returns the largest of a vector's lanes: of reals, and of integers. */
#if CAMBER_LANES == 1
CAMBER_FN float camber_most_of(camber_real x) {
    return x;
}

#ifndef CAMBER_GLSL
CAMBER_FN int camber_largest_of(camber_mask x) {
    return x;
}
#endif
#else
#if CAMBER_LANES == 16
#define CAMBER_FOLD_LANES(x) CAMBER_MORE((x).lo, (x).hi)
#else
#define CAMBER_FOLD_LANES(x) (x)
#endif

CAMBER_FN float camber_most_of(camber_real x) {
    const float8 eight = CAMBER_FOLD_LANES(x);
    const float4 four = CAMBER_MORE(eight.lo, eight.hi);
    const float2 two = CAMBER_MORE(four.lo, four.hi);
    return CAMBER_MORE(two.x, two.y);
}

CAMBER_FN int camber_largest_of(camber_mask x) {
    const int8 eight = CAMBER_FOLD_LANES(x);
    const int4 four = CAMBER_MORE(eight.lo, eight.hi);
    const int2 two = CAMBER_MORE(four.lo, four.hi);
    return CAMBER_MORE(two.x, two.y);
}
#endif

#ifndef CAMBER_GLSL
/* Returns the sum of sixteen numbers, in the same order whatever the number of lanes. */
CAMBER_FN float camber_sum_of_sixteen(const camber_real *vectors) {
#if CAMBER_LANES == 1
    float sums[8];
    for (int i = 0; i < 8; i++)
        sums[i] = vectors[i] + vectors[i + 8];
    for (int left = 4; left > 0; left /= 2)
        for (int i = 0; i < left; i++)
            sums[i] += sums[i + left];
    return sums[0];
#else
#if CAMBER_LANES == 16
    const float8 eight = vectors[0].lo + vectors[0].hi;
    const float4 four = eight.lo + eight.hi;
#elif CAMBER_LANES == 8
    const float8 eight = vectors[0] + vectors[1];
    const float4 four = eight.lo + eight.hi;
#else
    const float4 four = (vectors[0] + vectors[2]) + (vectors[1] + vectors[3]);
#endif
    const float2 two = four.lo + four.hi;
    return two.x + two.y;
#endif
}
#endif

#endif
