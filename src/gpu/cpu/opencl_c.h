/* Lets clang compile the kernels' text as functions of the library. The build includes this file before the kernels
 * (-include), and compiles them as OpenCL C for a processor.
 *
 * Main idea: clang knows OpenCL C's types and vectors, and leaves its functions to the runtime. These are the few that
 * the kernels call, each as what LLVM has for it. All address spaces are the same memory. A kernel becomes a loop over
 * work-items:
 *
 *     void NAME(arguments, first work-item, end of them, number of all work-items of the launch) */
#ifndef CAMBER_GPU_CPU_OPENCL_C_H
#define CAMBER_GPU_CPU_OPENCL_C_H

#define CAMBER_AHEAD_OF_TIME 1

#define global
#define constant static __constant

/* ---- Functions ---- */

#define CAMBER_BUILTIN static inline __attribute__((overloadable, always_inline))

/* LLVM's own functions of a float and of vectors. */
#define CAMBER_FLOAT_FUNCTIONS(type)                                                                                   \
    CAMBER_BUILTIN type fabs(type x) {                                                                                 \
        return __builtin_elementwise_abs(x);                                                                           \
    }                                                                                                                  \
    CAMBER_BUILTIN type floor(type x) {                                                                                \
        return __builtin_elementwise_floor(x);                                                                         \
    }
CAMBER_FLOAT_FUNCTIONS(float)
CAMBER_FLOAT_FUNCTIONS(float8)
CAMBER_FLOAT_FUNCTIONS(float16)

CAMBER_BUILTIN float sqrt(float x) {
    return __builtin_sqrtf(x);
}

CAMBER_BUILTIN float8 sqrt(float8 x) {
    return (float8)(sqrt(x.s0), sqrt(x.s1), sqrt(x.s2), sqrt(x.s3), sqrt(x.s4), sqrt(x.s5), sqrt(x.s6), sqrt(x.s7));
}

CAMBER_BUILTIN float16 sqrt(float16 x) {
    return (float16)(sqrt(x.s0), sqrt(x.s1), sqrt(x.s2), sqrt(x.s3), sqrt(x.s4), sqrt(x.s5), sqrt(x.s6), sqrt(x.s7),
                     sqrt(x.s8), sqrt(x.s9), sqrt(x.sa), sqrt(x.sb), sqrt(x.sc), sqrt(x.sd), sqrt(x.se), sqrt(x.sf));
}

CAMBER_BUILTIN uint min(uint a, uint b) {
    return a < b ? a : b;
}

CAMBER_BUILTIN ulong popcount(ulong x) {
    return (ulong)__builtin_popcountl(x);
}

/* Vectors in memory are aligned as their elements. */
#define CAMBER_LOADS(type, lanes, space)                                                                               \
    CAMBER_BUILTIN type##lanes vload##lanes(size_t at, space const type *from) {                                       \
        typedef type##lanes unaligned __attribute__((aligned(sizeof(type))));                                          \
        return *(space const unaligned *)(from + lanes * at);                                                          \
    }
#define CAMBER_STORES(type, lanes)                                                                                     \
    CAMBER_BUILTIN void vstore##lanes(type##lanes vector, size_t at, type *to) {                                       \
        typedef type##lanes unaligned __attribute__((aligned(sizeof(type))));                                          \
        *(unaligned *)(to + lanes * at) = vector;                                                                      \
    }
#define CAMBER_VECTORS_OF(type, lanes)                                                                                 \
    CAMBER_LOADS(type, lanes, __private)                                                                               \
    CAMBER_LOADS(type, lanes, __constant)                                                                              \
    CAMBER_STORES(type, lanes)
#define CAMBER_VECTORS_OF_EACH(type)                                                                                   \
    CAMBER_VECTORS_OF(type, 2)                                                                                         \
    CAMBER_VECTORS_OF(type, 4)                                                                                         \
    CAMBER_VECTORS_OF(type, 8)                                                                                         \
    CAMBER_VECTORS_OF(type, 16)
CAMBER_VECTORS_OF_EACH(float)
CAMBER_VECTORS_OF_EACH(int)
CAMBER_VECTORS_OF_EACH(uint)
CAMBER_VECTORS_OF_EACH(ulong)

#define convert_float8(x) __builtin_convertvector(x, float8)
#define convert_float16(x) __builtin_convertvector(x, float16)
#define convert_int8(x) __builtin_convertvector(x, int8)
#define convert_int16(x) __builtin_convertvector(x, int16)
#define convert_uint8(x) __builtin_convertvector(x, uint8)
#define convert_uint16(x) __builtin_convertvector(x, uint16)
#define convert_ulong8(x) __builtin_convertvector(x, ulong8)
#define convert_ulong16(x) __builtin_convertvector(x, ulong16)

/* ---- Kernels ---- */

/* Applies a macro to each of up to sixteen arguments. */
#define CAMBER_EACH_1(f, a) f(a)
#define CAMBER_EACH_2(f, a, ...) f(a) CAMBER_EACH_1(f, __VA_ARGS__)
#define CAMBER_EACH_3(f, a, ...) f(a) CAMBER_EACH_2(f, __VA_ARGS__)
#define CAMBER_EACH_4(f, a, ...) f(a) CAMBER_EACH_3(f, __VA_ARGS__)
#define CAMBER_EACH_5(f, a, ...) f(a) CAMBER_EACH_4(f, __VA_ARGS__)
#define CAMBER_EACH_6(f, a, ...) f(a) CAMBER_EACH_5(f, __VA_ARGS__)
#define CAMBER_EACH_7(f, a, ...) f(a) CAMBER_EACH_6(f, __VA_ARGS__)
#define CAMBER_EACH_8(f, a, ...) f(a) CAMBER_EACH_7(f, __VA_ARGS__)
#define CAMBER_EACH_9(f, a, ...) f(a) CAMBER_EACH_8(f, __VA_ARGS__)
#define CAMBER_EACH_10(f, a, ...) f(a) CAMBER_EACH_9(f, __VA_ARGS__)
#define CAMBER_EACH_11(f, a, ...) f(a) CAMBER_EACH_10(f, __VA_ARGS__)
#define CAMBER_EACH_12(f, a, ...) f(a) CAMBER_EACH_11(f, __VA_ARGS__)
#define CAMBER_EACH_13(f, a, ...) f(a) CAMBER_EACH_12(f, __VA_ARGS__)
#define CAMBER_EACH_14(f, a, ...) f(a) CAMBER_EACH_13(f, __VA_ARGS__)
#define CAMBER_EACH_15(f, a, ...) f(a) CAMBER_EACH_14(f, __VA_ARGS__)
#define CAMBER_EACH_16(f, a, ...) f(a) CAMBER_EACH_15(f, __VA_ARGS__)
#define CAMBER_COUNTED(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, count, ...) CAMBER_EACH_##count
#define CAMBER_EACH(f, ...)                                                                                            \
    CAMBER_COUNTED(__VA_ARGS__, 16, 15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0)(f, __VA_ARGS__)

#define CAMBER_LIST(...) __VA_ARGS__
#define CAMBER_EXPAND(macro, ...) macro(__VA_ARGS__)
#define CAMBER_MEMBER(parameter) __attribute__((aligned(CAMBER_CPU_ARG_BYTES))) parameter;
#define CAMBER_PASSED(argument) , from->argument

#include "gpu/cpu/args.h"

/* The name of a kernel in the library: the build says which program it belongs to, and for which processor. */
#define CAMBER_JOINED_NAME(program, name) program##_##name
#define CAMBER_PROGRAM_NAME(program, name) CAMBER_JOINED_NAME(program, name)
#define CAMBER_NAMED(name) CAMBER_PROGRAM_NAME(CAMBER_CPU_PROGRAM, name)

#define CAMBER_WORK_ITEM item_id
#define CAMBER_WORK_ITEMS item_count
#define CAMBER_KERNEL(size, name, parameters, arguments)                                                               \
    typedef struct name##_args {                                                                                       \
        CAMBER_EXPAND(CAMBER_EACH, CAMBER_MEMBER, CAMBER_LIST parameters)                                              \
    } name##_args;                                                                                                     \
    static void name##_item(const size_t item_id, const size_t item_count, CAMBER_LIST parameters)                     \
        __attribute__((noinline, min_vector_width(512)));                                                              \
    __attribute__((visibility("hidden"))) void CAMBER_NAMED(name)(const name##_args *from, size_t first, size_t end,   \
                                                                  size_t count) {                                      \
        for (size_t i = first; i < end; i++)                                                                           \
            name##_item(i, count CAMBER_EXPAND(CAMBER_EACH, CAMBER_PASSED, CAMBER_LIST arguments));                    \
    }                                                                                                                  \
    static void name##_item(const size_t item_id, const size_t item_count, CAMBER_LIST parameters)

#endif
