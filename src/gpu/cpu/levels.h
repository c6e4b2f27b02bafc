/* The levels of processors that kernels were compiled for, best first: x86-64-v4 has AVX-512, v3 AVX2, v2 SSE4.2. The
 * build compiles all programs of gpu/programs.h for each of them (compile.cmake). */
#ifndef CAMBER_GPU_CPU_LEVELS_H
#define CAMBER_GPU_CPU_LEVELS_H

#include <stdbool.h>
#include <stddef.h>

/* Runs work-items [first, end) of a launch of `count`. args: as CAMBER_CPU_ARG_BYTES says. */
typedef void camber_cpu_function(const void *args, size_t first, size_t end, size_t count);

typedef struct camber_cpu_kernel {
    const char *name; /* NULL: the end of a program's kernels */
    camber_cpu_function *run;
} camber_cpu_kernel;

typedef struct camber_cpu_level {
    const char *name;
    unsigned lanes;                           /* CAMBER_LANES of its kernels */
    const camber_cpu_kernel *const *programs; /* [camber_program_number] */
} camber_cpu_level;

/* Returns the best level that this processor has, or the level of that name if it has it; NULL: none. */
const camber_cpu_level *camber_cpu_level_find(const char *name);
/* Writes the names of the levels that this processor has, each followed by ", ". */
void camber_cpu_level_names(char *names, size_t size);

#endif
