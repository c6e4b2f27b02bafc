/* The words in which C, OpenCL C and GLSL ES differ, for code that all three compile.
 *
 * The build declares the dialect: CAMBER_DEVICE is defined for OpenCL C, CAMBER_GLSL for shaders, neither for C. GLSL
 * has no pointers, so structs are passed to functions as CAMBER_IN, results are returned by CAMBER_OUT, and
 * src/embed.cmake replaces `->` by `.` there. Its masks are bools, which have no & and |, so CAMBER_BOTH and
 * CAMBER_EITHER stand in for them. Shared code avoids GLSL's reserved words (flat, half, class, input, output, sample,
 * common). */
#ifndef CAMBER_KERNELS_DIALECT_H
#define CAMBER_KERNELS_DIALECT_H

#ifdef CAMBER_GLSL
#define const /* in GLSL a const must be computable by the compiler */
#define camber_u32 uint
#define camber_i32 int
#define camber_flag bool
#define CAMBER_FN
#define CAMBER_INLINE
#define CAMBER_GLOBAL
#define CAMBER_STRUCT(name) struct name
#define CAMBER_IN(type) type
#define CAMBER_OUT(type) out type
#define CAMBER_INOUT(type) inout type
#define CAMBER_REF(variable) variable
#define CAMBER_AT(place) place
#define CAMBER_SQRT(x) sqrt(x)
#define CAMBER_FABS(x) abs(x)
#define CAMBER_SIN(x) sin(x)
#define CAMBER_COS(x) cos(x)
#define CAMBER_BOTH(a, b) ((a) && (b))
#define CAMBER_EITHER(a, b) ((a) || (b))
#define CAMBER_CAST(type, x) type(x)
#define CAMBER_YES true
#define CAMBER_NO false
#define CAMBER_UNUSED(parameter)
#define CAMBER_SAME_NAME

#else

#ifdef CAMBER_DEVICE
#pragma OPENCL FP_CONTRACT OFF
typedef uint camber_u32;
typedef int camber_i32;
typedef ulong camber_u64;
#define CAMBER_GLOBAL global
#define CAMBER_SQRT(x) sqrt(x)
#define CAMBER_FABS(x) fabs(x)
#define CAMBER_SAME_NAME __attribute__((overloadable)) /* a function for one float has an overload for a vector */
#else
#include <math.h>
#include <stdint.h>
typedef uint32_t camber_u32;
typedef int32_t camber_i32;
typedef uint64_t camber_u64;
#define CAMBER_GLOBAL
#define CAMBER_SQRT(x) sqrtf(x)
#define CAMBER_FABS(x) fabsf(x)
#define CAMBER_SIN(x) sinf(x)
#define CAMBER_COS(x) cosf(x)
#define CAMBER_SAME_NAME
#endif
typedef int camber_flag; /* 0: no */
#define CAMBER_FN static inline
#define CAMBER_INLINE __attribute__((always_inline))
#define CAMBER_STRUCT(name)                                                                                            \
    typedef struct name name;                                                                                          \
    struct name
#define CAMBER_IN(type) const type *
#define CAMBER_OUT(type) type *
#define CAMBER_INOUT(type) type *
#define CAMBER_REF(variable) &(variable)
#define CAMBER_AT(place) (*(place))
#define CAMBER_BOTH(a, b) ((a) & (b))
#define CAMBER_EITHER(a, b) ((a) | (b))
#define CAMBER_CAST(type, x) ((type)(x))
#define CAMBER_YES 1
#define CAMBER_NO 0
#define CAMBER_UNUSED(parameter) (void)(parameter);
#endif

/* Whether at least one of some bits is set. */
#define CAMBER_HAS(bits, some) (((bits) & (some)) != 0u)

#endif
