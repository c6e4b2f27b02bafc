/* The list of all programs and of their kernels: everything that a device can be asked for. program.c makes programs
 * from it, and the build reads its rows and compiles them for the back end cpu, which finds them by their numbers. */
#ifndef CAMBER_GPU_PROGRAMS_H
#define CAMBER_GPU_PROGRAMS_H

/* The kernels of each source, kernels/SOURCE.cl. */
#define CAMBER_KERNELS_OF_raster(KERNEL, of)                                                                           \
    KERNEL(of, setup)                                                                                                  \
    KERNEL(of, bin_count) KERNEL(of, bin_scan) KERNEL(of, bin_scatter) KERNEL(of, wind) KERNEL(of, rasterize)
#define CAMBER_KERNELS_OF_offset(KERNEL, of)                                                                           \
    KERNEL(of, offset_clip)                                                                                            \
    KERNEL(of, offset_count) KERNEL(of, offset_emit)
#define CAMBER_KERNELS_OF_cull(KERNEL, of)                                                                             \
    KERNEL(of, cull_count)                                                                                             \
    KERNEL(of, cull_emit)
#define CAMBER_KERNELS_OF_tessellate(KERNEL, of)                                                                       \
    KERNEL(of, classify)                                                                                               \
    KERNEL(of, scan) KERNEL(of, emit)
#define CAMBER_KERNELS_OF_arc_length(KERNEL, of)                                                                       \
    KERNEL(of, arc_length_sum)                                                                                         \
    KERNEL(of, arc_length_scan)

/* Name, source, and the options in which the program differs from others of its source. The programs that take longest
 * to compile are first. The functions camber_device_*_program count on the order of rows. */
/* clang-format off */
#define CAMBER_PROGRAMS(PROGRAM, with) \
    PROGRAM(with, draw_pitched, raster, " -DCAMBER_RASTER_RICH=1 -DCAMBER_RASTER_PITCHED=1") \
    PROGRAM(with, draw_rich, raster, " -DCAMBER_RASTER_RICH=1") \
    PROGRAM(with, draw, raster, "") \
    PROGRAM(with, offset, offset, "") \
    PROGRAM(with, offset_measured, offset, " -DCAMBER_HAS_ARC_LENGTH=1") \
    PROGRAM(with, cull, cull, "") \
    PROGRAM(with, cull_measured, cull, " -DCAMBER_HAS_ARC_LENGTH=1") \
    PROGRAM(with, cull_pitched, cull, " -DCAMBER_PITCHED=1") \
    PROGRAM(with, cull_pitched_measured, cull, " -DCAMBER_PITCHED=1 -DCAMBER_HAS_ARC_LENGTH=1") \
    PROGRAM(with, strip, tessellate, " -DCAMBER_METHOD=0 -DCAMBER_ROUND_LIMITS=0") \
    PROGRAM(with, strip_measured, tessellate, " -DCAMBER_METHOD=0 -DCAMBER_ROUND_LIMITS=0 -DCAMBER_HAS_ARC_LENGTH=1") \
    PROGRAM(with, strip_round, tessellate, " -DCAMBER_METHOD=0") \
    PROGRAM(with, strip_round_measured, tessellate, " -DCAMBER_METHOD=0 -DCAMBER_HAS_ARC_LENGTH=1") \
    PROGRAM(with, kite, tessellate, " -DCAMBER_METHOD=1 -DCAMBER_ROUND_LIMITS=0") \
    PROGRAM(with, kite_measured, tessellate, " -DCAMBER_METHOD=1 -DCAMBER_ROUND_LIMITS=0 -DCAMBER_HAS_ARC_LENGTH=1") \
    PROGRAM(with, kite_round, tessellate, " -DCAMBER_METHOD=1") \
    PROGRAM(with, kite_round_measured, tessellate, " -DCAMBER_METHOD=1 -DCAMBER_HAS_ARC_LENGTH=1") \
    PROGRAM(with, fan, tessellate, " -DCAMBER_METHOD=2 -DCAMBER_ROUND_LIMITS=0") \
    PROGRAM(with, fan_measured, tessellate, " -DCAMBER_METHOD=2 -DCAMBER_ROUND_LIMITS=0 -DCAMBER_HAS_ARC_LENGTH=1") \
    PROGRAM(with, fan_round, tessellate, " -DCAMBER_METHOD=2") \
    PROGRAM(with, fan_round_measured, tessellate, " -DCAMBER_METHOD=2 -DCAMBER_HAS_ARC_LENGTH=1") \
    PROGRAM(with, arc_length, arc_length, "")
/* clang-format on */

/* The programs' numbers: CAMBER_PROGRAM_strip and the like. */
typedef enum camber_program_number {
#define CAMBER_PROGRAM_NUMBER(with, name, source, options) CAMBER_PROGRAM_##name,
    CAMBER_PROGRAMS(CAMBER_PROGRAM_NUMBER, 0)
#undef CAMBER_PROGRAM_NUMBER
        CAMBER_PROGRAM_COUNT
} camber_program_number;

#endif
