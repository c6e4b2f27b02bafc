/* The kernels of each level, and which levels this processor has.
 *
 * Input: the functions that the build has made of the programs (compile.cmake), and what the processor says of itself.
 * Output: a level with a table of kernels for each program. Main idea: levels stand in a list, best first. */
#include "gpu/cpu/levels.h"

#include "gpu/programs.h"

#include <stdio.h>
#include <string.h>

#ifdef __x86_64__
#include <cpuid.h>
#endif

/* ---- Kernels ---- */

/* The kernels of a level: camber_cpu_LEVEL_PROGRAM_KERNEL, as the build names them. */
#define DECLARE_KERNEL(of, kernel) camber_cpu_function of##_##kernel;
#define DECLARE_PROGRAM(level, name, source, options)                                                                  \
    CAMBER_KERNELS_OF_##source(DECLARE_KERNEL, camber_cpu_##level##_##name)
#define KERNEL_ENTRY(of, kernel) {#kernel, of##_##kernel},
#define PROGRAM_ENTRY(level, name, source, options)                                                                    \
    [CAMBER_PROGRAM_##name] = (const camber_cpu_kernel[]){                                                             \
        CAMBER_KERNELS_OF_##source(KERNEL_ENTRY, camber_cpu_##level##_##name){NULL, NULL}},
#define LEVEL(level)                                                                                                   \
    CAMBER_PROGRAMS(DECLARE_PROGRAM, level)                                                                            \
    static const camber_cpu_kernel *const programs_of_##level[CAMBER_PROGRAM_COUNT] = {                                \
        CAMBER_PROGRAMS(PROGRAM_ENTRY, level)}

#ifdef CAMBER_CPU_x86_64_v4
LEVEL(x86_64_v4);
#endif
#ifdef CAMBER_CPU_x86_64_v3
LEVEL(x86_64_v3);
#endif
#ifdef CAMBER_CPU_x86_64_v2
LEVEL(x86_64_v2);
#endif
#ifdef CAMBER_CPU_aarch64
LEVEL(aarch64);
#endif

/* ---- Processors ---- */

#ifdef __x86_64__
/* __builtin_cpu_supports also asks whether the system saves the registers. It does not know three instructions of v3.
 */
static bool has_v2(void) {
    return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
}

static bool has_v3(void) {
    unsigned a, b, c, d, more_a, more_b, more_c, more_d;
    const unsigned movbe = 1u << 22, f16c = 1u << 29, lzcnt = 1u << 5;
    return has_v2() && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma") && __get_cpuid(1, &a, &b, &c, &d) &&
           (c & (movbe | f16c)) == (movbe | f16c) && __get_cpuid(0x80000001u, &more_a, &more_b, &more_c, &more_d) &&
           (more_c & lzcnt);
}

static bool has_v4(void) {
    return has_v3() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
}
#else
static bool has_all(void) {
    return true;
}
#endif

/* A level, and whether this processor has it. */
typedef struct known_level {
    camber_cpu_level level;
    bool (*is_here)(void);
} known_level;

static const known_level levels[] = {
#ifdef CAMBER_CPU_x86_64_v4
    {{"x86-64-v4", 16, programs_of_x86_64_v4}, has_v4},
#endif
#ifdef CAMBER_CPU_x86_64_v3
    {{"x86-64-v3", 8, programs_of_x86_64_v3}, has_v3},
#endif
#ifdef CAMBER_CPU_x86_64_v2
    {{"x86-64-v2", 8, programs_of_x86_64_v2}, has_v2},
#endif
#ifdef CAMBER_CPU_aarch64
    {{"aarch64", 8, programs_of_aarch64}, has_all},
#endif
};

const camber_cpu_level *camber_cpu_level_find(const char *name) {
    for (size_t i = 0; i < sizeof levels / sizeof *levels; i++)
        if ((!name || strcmp(name, levels[i].level.name) == 0) && levels[i].is_here())
            return &levels[i].level;
    return NULL;
}

void camber_cpu_level_names(char *names, size_t size) {
    *names = 0;
    for (size_t i = 0, used = 0; i < sizeof levels / sizeof *levels; i++, used = strlen(names))
        if (levels[i].is_here())
            snprintf(names + used, size - used, "%s, ", levels[i].level.name);
}
