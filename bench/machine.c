/* The machine: its processor, which instructions camber's kernels are compiled for, and by what everything was. */
#define _XOPEN_SOURCE 700 /* sysconf */

#include "bench.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The value of a field's first line in /proc/cpuinfo; "": there is none. */
static void read_processor(const char *field, char *value, size_t size) {
    char line[8192];
    FILE *file = fopen("/proc/cpuinfo", "r");
    *value = 0;
    while (file && !*value && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        const size_t length = strlen(field);
        if (!colon || strncmp(line, field, length) != 0 || !strchr(" \t:", line[length]))
            continue;
        snprintf(value, size, "%s", colon + 1 + strspn(colon + 1, " "));
        value[strcspn(value, "\n")] = 0;
    }
    if (file)
        fclose(file);
}

/* Trade marks tell nothing. */
static void drop_marks(char *text) {
    for (char *mark; (mark = strstr(text, "(R)")) || (mark = strstr(text, "(TM)"));)
        memmove(mark, strchr(mark, ')') + 1, strlen(strchr(mark, ')') + 1) + 1);
}

/* The widest vectors that the processor computes with. */
static const char *read_vectors(void) {
    char flags[8192];
    read_processor("flags", flags, sizeof flags);
    return strstr(flags, " avx512f") ? "AVX-512" : strstr(flags, " avx2") ? "AVX2" : "other vectors";
}

/* The processor that kernels are compiled for. The back end cpu has one in its name: "camber x86-64-v4". PoCL's version
 * ends with it: "... HSTR: cpu-x86_64-pc-linux-gnu-haswell". NULL: that is not known. */
static const char *kernels_for(const camber_device_info *device) {
    const char *target = strstr(device->version, "-gnu-");
    if (device->fixed_kernels)
        return strchr(device->name, ' ') ? strchr(device->name, ' ') + 1 : NULL;
    return strstr(device->version, "HSTR: ") && target ? target + strlen("-gnu-") : NULL;
}

static bool is_avx2_processor(const char *name) {
    static const char *const names[] = {"x86-64-v3", "haswell", "broadwell", "skylake", "znver1", "znver2", "znver3"};
    for (size_t i = 0; name && i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i]) == 0)
            return true;
    return false;
}

bool bench_is_avx2_only(const bench *b) {
    const camber_device_info device = camber_device_get_info(b->device);
    const char *target = kernels_for(&device);
    if (is_avx2_processor(target))
        return true;
    fprintf(
        stderr,
        "camber_bench: the kernels are compiled for %s; without CAMBER_CPU=none they are those of the back end cpu for "
        "x86-64-v3, and POCL_KERNELLIB_NAME=avx2 makes PoCL 6 compile them for AVX2 (PoCL 3.1 has no such setting)\n",
        target ? target : device.name);
    return false;
}

static json_t *describe_environment(void) {
    static const char *const names[] = {"CAMBER_CPU",    "POCL_KERNELLIB_NAME", "POCL_LLVM_CPU_NAME",
                                        "POCL_AFFINITY", "GLIBC_TUNABLES",      "LP_NATIVE_VECTOR_WIDTH"};
    json_t *environment = json_object();
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (getenv(names[i]))
            json_object_set_new(environment, names[i], json_string(getenv(names[i])));
    return environment;
}

json_t *bench_machine_describe(const bench *b) {
    char processor[256];
    const camber_device_info device = camber_device_get_info(b->device);
    const char *vectors = read_vectors(), *target = kernels_for(&device);
    read_processor("model name", processor, sizeof processor);
    drop_marks(processor);
    return json_pack("{s:s, s:s, s:s, s:s, s:I, s:s, s:o}", "processor", *processor ? processor : "unknown processor",
                     "vectors", vectors, "code", b->avx2_only ? "AVX2" : vectors, "kernels_for", target ? target : "",
                     "cores", (json_int_t)sysconf(_SC_NPROCESSORS_ONLN), "compiler", CAMBER_BENCH_COMPILER,
                     "environment", describe_environment());
}
