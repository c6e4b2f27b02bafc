/* Layouts that host, device and shaders share. Sizes are asserted on both sides. */
#ifndef CAMBER_KERNELS_LAYOUT_H
#define CAMBER_KERNELS_LAYOUT_H

#include "dialect.h"

#if defined(CAMBER_DEVICE) || defined(CAMBER_GLSL)
#define CAMBER_PAD_PX 0.75f
#else
#include "camber_proof.h"
#endif

/* Points per work-group, and the block of the scan. Point arrays are padded with sentinels to a multiple of it, so that
 * no kernel needs a guard. A device may use smaller blocks, which divide this: its build sets them. */
#ifndef CAMBER_BLOCK
#define CAMBER_BLOCK 256
#endif
/* Points per work-item of classify, scan and emit. On a CPU a work-item takes a whole block, which the build sets. */
#ifndef CAMBER_POINT_CHUNK
#define CAMBER_POINT_CHUNK 8
#endif

/* Defines a kernel with work-groups of `size` work-items; its body has the number of its work-item in CAMBER_WORK_ITEM,
 * and how many there are in CAMBER_WORK_ITEMS. On a CPU the body is a function that the kernel calls: PoCL puts a
 * kernel's body into three entries of each build and compiles its loop over work-items around each, which takes twice
 * as long and runs no faster. min_vector_width: LLVM halves AVX-512's vectors unless a function asks for whole ones;
 * processors without AVX-512 ignore it. */
#if defined(CAMBER_DEVICE) && !defined(CAMBER_AHEAD_OF_TIME)
#if CAMBER_POINT_CHUNK == CAMBER_BLOCK
#define CAMBER_LIST(...) __VA_ARGS__ /* only for CPUs: NVIDIA's compiler does not know such a macro */
#define CAMBER_WORK_ITEM item_id
#define CAMBER_WORK_ITEMS item_count
#define CAMBER_KERNEL(size, name, parameters, arguments)                                                               \
    static void name##_item(const size_t item_id, const size_t item_count, CAMBER_LIST parameters)                     \
        __attribute__((noinline, min_vector_width(512)));                                                              \
    kernel __attribute__((reqd_work_group_size(size, 1, 1))) void name parameters {                                    \
        name##_item(get_global_id(0), get_global_size(0), CAMBER_LIST arguments);                                      \
    }                                                                                                                  \
    static void name##_item(const size_t item_id, const size_t item_count, CAMBER_LIST parameters)
#else
#define CAMBER_WORK_ITEM get_global_id(0)
#define CAMBER_WORK_ITEMS get_global_size(0)
#define CAMBER_KERNEL(size, name, parameters, arguments)                                                               \
    kernel __attribute__((reqd_work_group_size(size, 1, 1))) void name parameters
#endif
#endif

/* A point's info word: row << CAMBER_POINT_ROW_SHIFT | flags. 0 is a sentinel: a neighbour to look at, or padding,
 * that emits nothing. A ring is stored as a sentinel of its last but one point, its points with the first repeated at
 * the end, and a sentinel of its second point, so that neighbours are always i - 1 and i + 1. A first or last point
 * that is CUT is not an end: the line continues outside the window. A point of an AREA's ring has no join: only edges
 * are made from it. */
#define CAMBER_POINT_REAL 1u
#define CAMBER_POINT_FIRST 2u
#define CAMBER_POINT_LAST 4u
#define CAMBER_POINT_RING 8u
#define CAMBER_POINT_CUT 64u
#define CAMBER_POINT_AREA 128u
#define CAMBER_POINT_ROW_SHIFT 8
#define CAMBER_ROW_BITS 0xffffff00u

/* A row of the style table as the kernels read it. */
CAMBER_STRUCT(camber_row) {
    float reach_px;    /* half the largest width + CAMBER_PAD_PX: the unit of extrusion */
    float miter_limit; /* 1 / cos(turn / 2) */
    float fan_cos;     /* cosine of the fan's step angle */
    float fan_sin;
    float round_cos; /* cosine of half the turn: above it round joins are miters; 2 for other joins */
    camber_u32 join; /* camber_join */
    camber_u32 cap;  /* camber_cap */
    float fan_step;  /* the angle */
};

/* Words of a record: see camber_record in camber_proof.h. A mesh with arc lengths has as many again after them, of
 * which the first two are a camber_arc_length. */
#define CAMBER_RECORD_WORDS 4
#ifndef CAMBER_HAS_ARC_LENGTH
#define CAMBER_HAS_ARC_LENGTH 0
#endif

/* A record's last word is its point's info, with one of these. The outgoing segment places the vertices of a start,
 * except those that it shares with the end before: the incoming segment places these, to the last bit. The incoming
 * segment begins at the break before the start, or at a tight join at the record before the end. */
#define CAMBER_RECORD_BREAK 16u /* between two strips: its vertices repeat those of its neighbours */
#define CAMBER_RECORD_START 32u /* start of a strip inside a polyline, where the previous strip has ended */

/* Kite and fan: an index is record << CAMBER_CORNER_BITS | corner. IN and OUT refer to the segments into and out of the
 * point. The corners from CAMBER_CORNER_FAN on are a fan's own vertices, in the order of their steps from the edge of
 * the incoming segment. */
#define CAMBER_CORNER_BITS 7
#define CAMBER_CORNER_CENTRE 0u
#define CAMBER_CORNER_IN_LEFT 1u
#define CAMBER_CORNER_IN_RIGHT 2u
#define CAMBER_CORNER_OUT_LEFT 3u
#define CAMBER_CORNER_OUT_RIGHT 4u
#define CAMBER_CORNER_TIP 5u      /* tip of a kite, where the outer edges meet */
#define CAMBER_CORNER_IN_TIP 6u   /* tip of the first of two kites */
#define CAMBER_CORNER_BISECTOR 7u /* between two kites */
#define CAMBER_CORNER_OUT_TIP 8u  /* tip of the second of two kites */
#define CAMBER_CORNER_FAN 63u

/* A point's join word, which classify writes, and scan and emit read:
 *
 *     bits  0-15  tan(turn / 4) * 32767, two's complement
 *          16-18  camber_end
 *          19-25  join triangles; in the words of strips, and in records: 19-24 the stub, 25 the line has butt caps
 *             26  the previous point is its line's first
 *             27  the next point is its line's last
 *          28-31  kind: in the top bits, so that no mask narrows it to three bits, which oclgrind 21.10 gets wrong
 *
 * The stub: 1 + the length of the shorter of its two segments in whole units of CAMBER_STUB_UNIT_PX, and 63 from
 * CAMBER_STUB_PX on. */
#define CAMBER_JOIN_END_SHIFT 16
#define CAMBER_JOIN_END_MASK 7u
#define CAMBER_JOIN_TRIANGLES_SHIFT 19
#define CAMBER_JOIN_STUB_SHIFT 19
#define CAMBER_JOIN_STUB(join) ((join) >> CAMBER_JOIN_STUB_SHIFT & 63u)
#define CAMBER_JOIN_BUTT (1u << 25)
#define CAMBER_STUB_MOST 63u
#define CAMBER_STUB_PX 1.5f
#define CAMBER_STUB_UNIT_PX (CAMBER_STUB_PX / 62.0f)
#define CAMBER_JOIN_AFTER_FIRST (1u << 26)
#define CAMBER_JOIN_BEFORE_LAST (1u << 27)
#define CAMBER_JOIN_KIND_SHIFT 28
#define CAMBER_JOIN_TRIANGLES_MAX 64u /* so that a block's index count fits into 16 bits */

#define CAMBER_KIND_SENTINEL 0u /* emits nothing: not a point of a polyline, or a dot with butt caps */
#define CAMBER_KIND_DOT 1u      /* a polyline of one point */
#define CAMBER_KIND_CAP 2u      /* an end of an open polyline */
#define CAMBER_KIND_CUT 3u      /* a join cut along its bisector */
#define CAMBER_KIND_TIGHT 4u    /* cut on the outer side; the inner side has no room */
#define CAMBER_KIND_SPLIT 5u    /* too sharp to cut: both segments end here */

/* The values of the public enums, which OpenCL C cannot include: camber_method, camber_join, camber_cap. */
#define CAMBER_STRIP 0u
#define CAMBER_KITE 1u
#define CAMBER_FAN 2u
#define CAMBER_JOINS_ROUND 0u
#define CAMBER_JOINS_MITER 1u
#define CAMBER_JOINS_BEVEL 2u
#define CAMBER_CAPS_BUTT 0u
#define CAMBER_CAPS_ROUND 1u
#define CAMBER_CAPS_SQUARE 2u
/* camber_end: how a segment ends. */
#define CAMBER_ENDS_ROUND 0u
#define CAMBER_ENDS_BUTT 1u
#define CAMBER_ENDS_SQUARE 2u
#define CAMBER_ENDS_MITER 3u
#define CAMBER_ENDS_BEVEL 4u
#define CAMBER_ENDS_SPLIT_ROUND 5u
#define CAMBER_ENDS_SPLIT_BEVEL 6u
#define CAMBER_ENDS_SPLIT_MITER 7u

#define CAMBER_NO_LIMIT_PX 3.0e38f
#define CAMBER_LARGEST_TURN 32767.0f /* the stored value of tan(turn / 4) = 1 */
#define CAMBER_DIAGONAL 1.4143f      /* the diagonal of a square whose side is 1, rounded up */

#if defined(CAMBER_DEVICE)
typedef char camber_row_is_32_bytes[sizeof(camber_row) == 32 ? 1 : -1];
#elif !defined(CAMBER_GLSL)
_Static_assert(sizeof(camber_row) == 32, "the device reads rows of 32 bytes");
_Static_assert(sizeof(camber_record) == 4 * CAMBER_RECORD_WORDS, "the device writes records of 16 bytes");
_Static_assert(CAMBER_METHOD_STRIP == CAMBER_STRIP && CAMBER_METHOD_KITE == CAMBER_KITE &&
                   CAMBER_METHOD_FAN == CAMBER_FAN,
               "the build passes the method to the device as a number");
_Static_assert(CAMBER_JOIN_ROUND == CAMBER_JOINS_ROUND && CAMBER_JOIN_MITER == CAMBER_JOINS_MITER &&
                   CAMBER_JOIN_BEVEL == CAMBER_JOINS_BEVEL && CAMBER_CAP_BUTT == CAMBER_CAPS_BUTT &&
                   CAMBER_CAP_ROUND == CAMBER_CAPS_ROUND && CAMBER_CAP_SQUARE == CAMBER_CAPS_SQUARE,
               "rows have joins and caps as numbers");
_Static_assert(CAMBER_END_ROUND == CAMBER_ENDS_ROUND && CAMBER_END_BUTT == CAMBER_ENDS_BUTT &&
                   CAMBER_END_SQUARE == CAMBER_ENDS_SQUARE && CAMBER_END_MITER == CAMBER_ENDS_MITER &&
                   CAMBER_END_BEVEL == CAMBER_ENDS_BEVEL && CAMBER_END_SPLIT_ROUND == CAMBER_ENDS_SPLIT_ROUND &&
                   CAMBER_END_SPLIT_BEVEL == CAMBER_ENDS_SPLIT_BEVEL &&
                   CAMBER_END_SPLIT_MITER == CAMBER_ENDS_SPLIT_MITER,
               "join words and vertices have ends as numbers");
#endif

#endif
