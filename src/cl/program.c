/* Loads and builds OpenCL programs, and keeps what was built.
 *
 * Input: sources embedded in the library and the options of a device. Output: a camber_program with its kernels. Main
 * idea: a program is compiled once per machine and loaded from then on.
 *
 *     in the device?  -- yes --------------------------------------> use it
 *          | no
 *     in the cache?   -- yes -- load the binary -------------------> use it
 *          | no
 *     take the lock of this program: of several processes that need it, one compiles and the others wait
 *          |
 *     in the cache by now?  -- no -- compile, save the binary -----> use it
 *
 * A binary's file name is a hash of everything that it depends on, and its first 8 bytes are a hash of its contents.
 * With PoCL the run that compiles a program also loads what it saved (pocl.c). */
#include "cl/program.h"

#include "base/embedded.h"
#include "cl/pocl.h"
#include "kernels/layout.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const OPTIONS =
    "-cl-std=CL1.2 -w -DCAMBER_DEVICE=1 -DCAMBER_METHOD=%d%s%s -DCAMBER_POINT_CHUNK=%zu%s";

/* Which kernels a program has. */
typedef enum program_kind {
    PROGRAM_METHOD,
    PROGRAM_NETWORK,
    PROGRAM_ARC_LENGTHS,
    PROGRAM_OFFSETS,
    PROGRAM_RASTER,
} program_kind;

/* Everything that a program is made from. */
typedef struct recipe {
    program_kind kind;
    const char *name;
    const char *source;
    size_t source_size;
    char options[256];
} recipe;

/* Changes if the same program is saved in another form. */
static const char FORM[] = "without LLVM's code";

/* A hash of everything that a binary depends on. */
static uint64_t cache_key(const camber_device_info *info, const recipe *from) {
    uint64_t key = camber_hash(CAMBER_HASH_START, from->source, from->source_size);
    const char *options = from->options;
    const char *parts[] = {info->platform, info->name, info->version, info->driver, options, FORM};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        key = camber_hash(key, parts[i], strlen(parts[i]) + 1);
    return key;
}

static void cache_name(uint64_t key, char name[64]) {
    snprintf(name, 64, "kernels-%016llx.bin", (unsigned long long)key);
}

/* A hash of a binary and its key. It tells a whole file from one that a crash or a full disk cut short, and from one
 * that has another program's name. */
static uint64_t hash_binary(uint64_t key, const unsigned char *binary, size_t size_bytes) {
    return camber_hash(camber_hash(CAMBER_HASH_START, &key, sizeof key), binary, size_bytes);
}

/* Makes a program of a cache file: 8 bytes of hash, then the binary. Returns false where that does not work. */
static bool load_binary(camber_device *device, camber_program *program, const char *options, const char *bytes,
                        size_t size) {
    uint64_t hash;
    cl_int code = CL_INVALID_BINARY, binary_code = CL_INVALID_BINARY;
    if (size <= sizeof hash)
        return false;
    memcpy(&hash, bytes, sizeof hash);
    const unsigned char *binary = (const unsigned char *)bytes + sizeof hash;
    const size_t binary_size = size - sizeof hash;
    if (hash != hash_binary(program->key, binary, binary_size))
        return false;
    if (camber_is_pocl(&device->info) && camber_pocl_check_program(device, binary, binary_size) != CAMBER_OK)
        return false; /* as building it will, and say why */
    program->cl = clCreateProgramWithBinary(device->cl, 1, &device->id, &binary_size, &binary, &binary_code, &code);
    if (code == CL_SUCCESS && binary_code == CL_SUCCESS &&
        clBuildProgram(program->cl, 1, &device->id, options, NULL, NULL) == CL_SUCCESS)
        return true;
    if (program->cl)
        clReleaseProgram(program->cl);
    program->cl = NULL;
    return false;
}

/* Looks in the cache that all users of the machine share, then in this user's own. A run that fills the shared cache
 * looks only there. */
static bool load_cached(camber_device *device, camber_program *program, const char *options) {
    bool (*const loads[])(camber_context *, const char *, char **, size_t *) = {camber_cache_load_shared,
                                                                                camber_cache_load};
    char name[64];
    bool loaded = false;
    cache_name(program->key, name);
    const size_t count = device->context->saves_shared ? 1 : sizeof loads / sizeof *loads;
    for (size_t i = 0; i < count && !loaded; i++) {
        char *bytes = NULL;
        size_t size = 0;
        if (!loads[i](device->context, name, &bytes, &size))
            continue;
        loaded = load_binary(device, program, options, bytes, size);
        camber_free(device->context, bytes);
    }
    return loaded;
}

/* Fails with the compiler's log. */
static camber_status fail_build(camber_device *device, cl_program program) {
    static const size_t LOG_MAX = 3000;
    size_t size = 0;
    clGetProgramBuildInfo(program, device->id, CL_PROGRAM_BUILD_LOG, 0, NULL, &size);
    char *log = camber_alloc_zero(device->context, size + 1, 1);
    if (!log)
        return CAMBER_ERROR_MEMORY;
    clGetProgramBuildInfo(program, device->id, CL_PROGRAM_BUILD_LOG, size, log, NULL);
    camber_fail(device->context, CAMBER_ERROR_DEVICE,
                "clBuildProgram: the kernels do not build on %s; update its driver or try another device: %.*s",
                device->info.name, (int)LOG_MAX, log);
    camber_free(device->context, log);
    return CAMBER_ERROR_DEVICE;
}

static camber_status build_from_source(camber_device *device, camber_program *program, const recipe *from) {
    cl_int code;
    if (camber_is_pocl(&device->info)) {
        const camber_status status = camber_pocl_check_program(device, NULL, 0);
        if (status != CAMBER_OK)
            return status;
    }
    program->cl = clCreateProgramWithSource(device->cl, 1, (const char *[]){from->source}, &from->source_size, &code);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clCreateProgramWithSource", code);
    code = clBuildProgram(program->cl, 1, &device->id, from->options, NULL, NULL);
    if (code == CL_BUILD_PROGRAM_FAILURE)
        return fail_build(device, program->cl);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clBuildProgram", code);
    program->built = true;
    return CAMBER_OK;
}

/* Saves the binary in the cache. Returns false where it could not be saved, which is no failure. PoCL compiles all
 * kernels of a program when it is asked for the binary. */
static bool save_binary(camber_device *device, const camber_program *program) {
    size_t size = 0;
    bool saved = false;
    if (!camber_cache_can_save(device->context))
        return false;
    if (clGetProgramInfo(program->cl, CL_PROGRAM_BINARY_SIZES, sizeof size, &size, NULL) != CL_SUCCESS || size == 0)
        return false;
    uint64_t hash;
    unsigned char *bytes = camber_resize_quietly(device->context, NULL, size + sizeof hash);
    if (!bytes)
        return false;
    unsigned char *binary = bytes + sizeof hash;
    if (clGetProgramInfo(program->cl, CL_PROGRAM_BINARIES, sizeof binary, &binary, NULL) == CL_SUCCESS) {
        char name[64];
        /* The binary of a PoCL that camber does not know is saved whole: its kernels run as they are if
         * POCL_WORK_GROUP_SPECIALIZATION is 0, as the tool sets it, and are compiled once more if not. */
        if (camber_is_pocl(&device->info))
            camber_pocl_strip(binary, &size);
        hash = hash_binary(program->key, binary, size);
        memcpy(bytes, &hash, sizeof hash);
        cache_name(program->key, name);
        saved = camber_cache_save(device->context, name, bytes, size + sizeof hash);
    }
    camber_free(device->context, bytes);
    return saved;
}

/* Makes the kernels that belong to a kind of program. */
static camber_status make_kernels(camber_device *device, camber_program *program, program_kind kind) {
    const struct {
        const char *name;
        cl_kernel *kernel;
        program_kind kind;
    } stages[] = {{"cull_count", &program->cull_count, PROGRAM_NETWORK},
                  {"cull_emit", &program->cull_emit, PROGRAM_NETWORK},
                  {"classify", &program->classify, PROGRAM_METHOD},
                  {"scan", &program->scan, PROGRAM_METHOD},
                  {"emit", &program->emit, PROGRAM_METHOD},
                  {"arc_length_sum", &program->arc_length_sum, PROGRAM_ARC_LENGTHS},
                  {"arc_length_scan", &program->arc_length_scan, PROGRAM_ARC_LENGTHS},
                  {"offset_clip", &program->offset_clip, PROGRAM_OFFSETS},
                  {"offset_count", &program->offset_count, PROGRAM_OFFSETS},
                  {"offset_emit", &program->offset_emit, PROGRAM_OFFSETS},
                  {"setup", &program->setup, PROGRAM_RASTER},
                  {"bin_count", &program->bin_count, PROGRAM_RASTER},
                  {"bin_scan", &program->bin_scan, PROGRAM_RASTER},
                  {"bin_scatter", &program->bin_scatter, PROGRAM_RASTER},
                  {"wind", &program->wind, PROGRAM_RASTER},
                  {"rasterize", &program->rasterize, PROGRAM_RASTER}};
    for (size_t i = 0; i < sizeof stages / sizeof *stages; i++) {
        cl_int code;
        if (stages[i].kind != kind)
            continue;
        *stages[i].kernel = clCreateKernel(program->cl, stages[i].name, &code);
        if (code != CL_SUCCESS)
            return camber_fail_cl(device->context, "clCreateKernel", code);
    }
    return CAMBER_OK;
}

/* Loads under the program's lock. PoCL unpacks a binary file by file, and a process that unpacks the same one might
 * look for a file before it is there. */
static bool load_alone(camber_device *device, camber_program *program, const char *options) {
    static const double LONGEST_MS = 30e3; /* it takes 2 ms, on a busy machine much longer */
    const int lock = camber_cache_lock(device->context, program->key, LONGEST_MS);
    const bool loaded = load_cached(device, program, options);
    camber_cache_unlock(lock);
    return loaded;
}

/* Puts what was saved in the place of what was compiled: of the latter PoCL would compile each kernel once more when it
 * is launched. */
static bool use_saved(camber_device *device, camber_program *program, const char *options) {
    camber_program saved = {.key = program->key};
    if (!load_cached(device, &saved, options))
        return false;
    clReleaseProgram(program->cl);
    program->cl = saved.cl;
    return true;
}

/* Builds under the program's lock, unless another process has done so while this one waited. */
static camber_status build_alone(camber_device *device, camber_program *program, const recipe *from) {
    static const double LONGEST_MS = 600e3; /* a lock ends with its process; without it this one would compile, too */
    const int lock = camber_cache_lock(device->context, program->key, LONGEST_MS);
    camber_status status = CAMBER_OK;
    program->kept = load_cached(device, program, from->options);
    if (!program->kept) {
        camber_progress(device->context, "compiling kernels", -1);
        status = build_from_source(device, program, from);
        program->kept = status == CAMBER_OK && save_binary(device, program);
        if (program->kept && lock >= 0 && camber_is_pocl(&device->info))
            program->kept = use_saved(device, program, from->options);
    }
    camber_cache_unlock(lock);
    return status;
}

static camber_status make_program(camber_device *device, const recipe *from, camber_program **program) {
    camber_program *made = camber_alloc_zero(device->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->key = cache_key(&device->info, from);
    camber_status status = CAMBER_OK;
    const double begin = camber_now_ms();
    made->kept = load_alone(device, made, from->options);
    if (!made->kept)
        status = build_alone(device, made, from);
    if (status == CAMBER_OK)
        status = make_kernels(device, made, from->kind);
    if (status != CAMBER_OK) {
        camber_program_destroy(device->context, made);
        return status;
    }
    camber_log(device->context, CAMBER_LOG_INFO, "kernels of %s: %s in %.0f ms", from->name,
               made->built ? "built" : "from the cache", camber_now_ms() - begin);
    *program = made;
    return CAMBER_OK;
}

/* Writes the compiler's options. method: a camber_method, or -1 for programs that have none. */
static void set_options(const camber_device *device, int method, bool has_arc_length, recipe *from) {
    char block[32] = "";
    if (device->block != CAMBER_BLOCK)
        snprintf(block, sizeof block, " -DCAMBER_BLOCK=%zu", device->block);
    snprintf(from->options, sizeof from->options, OPTIONS, method,
             device->rounds_correctly ? " -cl-fp32-correctly-rounded-divide-sqrt" : "", block, device->point_chunk,
             has_arc_length ? " -DCAMBER_HAS_ARC_LENGTH=1" : "");
}

#ifdef CAMBER_KERNEL_FOLDER
/* For people who change kernels: sources are read at run time from the build tree, so that a change needs no compile of
 * the library. */
static camber_status make_current(camber_device *device, recipe *from, camber_program **program) {
    static const char *const files[] = {"tessellate.cl", "cull.cl", "arc_length.cl", "offset.cl", "raster.cl"};
    char path[CAMBER_FOLDER_SIZE], *text = NULL;
    snprintf(path, sizeof path, "%s/%s", CAMBER_KERNEL_FOLDER, files[from->kind]);
    camber_status status = camber_read_file(device->context, path, CAMBER_NAMED_BY_CALLER, &text, &from->source_size);
    from->source = text;
    if (status == CAMBER_OK)
        status = make_program(device, from, program);
    camber_free(device->context, text);
    return status;
}
#else
#define make_current make_program
#endif

/* Gives a program that the device keeps, and makes it first where it is missing. */
static camber_status ensure_program(camber_device *device, recipe *from, camber_program **kept,
                                    camber_program **program) {
    camber_status status = camber_check_process(device->context);
    if (status == CAMBER_OK && !*kept)
        status = make_current(device, from, kept);
    if (status == CAMBER_OK)
        *program = *kept;
    return status;
}

camber_status camber_device_program(camber_device *device, camber_program_desc desc, camber_program **program) {
    recipe from = {PROGRAM_METHOD, camber_method_get_name(desc.method), camber_tessellate_kernels,
                   camber_tessellate_kernels_size, ""};
    set_options(device, (int)desc.method, desc.has_arc_length, &from);
    const size_t used = strlen(from.options);
    if (!desc.round_limits)
        snprintf(from.options + used, sizeof from.options - used, " -DCAMBER_ROUND_LIMITS=0");
    return ensure_program(device, &from, &device->programs[desc.has_arc_length][desc.round_limits][desc.method],
                          program);
}

camber_status camber_device_arc_length_program(camber_device *device, camber_program **program) {
    recipe from = {PROGRAM_ARC_LENGTHS, "measures", camber_arc_length_kernels, camber_arc_length_kernels_size, ""};
    set_options(device, -1, false, &from);
    return ensure_program(device, &from, &device->arc_length_program, program);
}

camber_status camber_device_offset_program(camber_device *device, bool has_arc_length, camber_program **program) {
    recipe from = {PROGRAM_OFFSETS, "offsets", camber_offset_kernels, camber_offset_kernels_size, ""};
    set_options(device, -1, has_arc_length, &from);
    return ensure_program(device, &from, &device->offset_programs[has_arc_length], program);
}

camber_status camber_device_raster_program(camber_device *device, unsigned variant, camber_program **program) {
    recipe from = {PROGRAM_RASTER, "drawing", camber_raster_kernels, camber_raster_kernels_size, ""};
    set_options(device, -1, false, &from);
    const size_t used = strlen(from.options);
    snprintf(from.options + used, sizeof from.options - used, " -DCAMBER_LANES=%u%s%s", device->lanes,
             variant & CAMBER_RASTER_RICH ? " -DCAMBER_RASTER_RICH=1" : "",
             variant & CAMBER_RASTER_PITCHED ? " -DCAMBER_RASTER_PITCHED=1" : "");
    return ensure_program(device, &from, &device->raster_programs[variant], program);
}

camber_status camber_device_network_program(camber_device *device, bool has_arc_length, bool pitched,
                                            camber_program **program) {
    recipe from = {PROGRAM_NETWORK, "networks", camber_cull_kernels, camber_cull_kernels_size, ""};
    set_options(device, -1, has_arc_length, &from);
    const size_t used = strlen(from.options);
    if (pitched)
        snprintf(from.options + used, sizeof from.options - used, " -DCAMBER_PITCHED=1");
    return ensure_program(device, &from, &device->network_programs[has_arc_length][pitched], program);
}

/* Makes the n-th of all programs that a device can be asked for; past the last it leaves *program NULL. Those that take
 * longest to compile come first. */
static camber_status ensure_nth(camber_device *device, unsigned n, camber_program **program) {
    static const unsigned variants[] = {CAMBER_RASTER_RICH | CAMBER_RASTER_PITCHED, CAMBER_RASTER_RICH, 0};
    enum { VARIANTS = sizeof variants / sizeof *variants, OFFSETS = 2, NETWORKS = 4, METHODS = 12 };
    if (n < VARIANTS)
        return camber_device_raster_program(device, variants[n], program);
    n -= VARIANTS;
    if (n < OFFSETS)
        return camber_device_offset_program(device, n, program);
    n -= OFFSETS;
    if (n < NETWORKS)
        return camber_device_network_program(device, n & 1, n >> 1 & 1, program);
    n -= NETWORKS;
    if (n < METHODS)
        return camber_device_program(device, (camber_program_desc){(camber_method)(n / 4), n & 1, n >> 1 & 1}, program);
    return n == METHODS ? camber_device_arc_length_program(device, program) : CAMBER_OK;
}

/* Programs share, share + shares, share + 2 * shares and so on: several processes can compile at once. */
camber_status camber_device_warm(camber_device *device, unsigned share, unsigned shares, camber_warmed *warmed) {
    camber_warmed all = {0};
    camber_status status = CAMBER_OK;
    if (shares == 0 || share >= shares)
        return camber_fail(device->context, CAMBER_ERROR_ARGUMENT, "share %u of %u; it must be below their number",
                           share, shares);
    camber_cache_share(device->context, true);
    if (!camber_cache_folder(device->context, all.folder))
        all.folder[0] = 0;
    for (unsigned n = share; status == CAMBER_OK; n += shares) {
        camber_program *program = NULL;
        status = ensure_nth(device, n, &program);
        if (!program)
            break;
        all.programs++;
        all.built += program->built;
        all.kept += program->kept;
    }
    camber_cache_share(device->context, false);
    if (status == CAMBER_OK)
        *warmed = all;
    return status;
}

void camber_program_destroy(camber_context *context, camber_program *program) {
    if (!program)
        return;
    cl_kernel kernels[] = {program->cull_count,
                           program->cull_emit,
                           program->classify,
                           program->scan,
                           program->emit,
                           program->arc_length_sum,
                           program->arc_length_scan,
                           program->offset_clip,
                           program->offset_count,
                           program->offset_emit,
                           program->setup,
                           program->bin_count,
                           program->bin_scan,
                           program->bin_scatter,
                           program->wind,
                           program->rasterize};
    for (size_t i = 0; i < sizeof kernels / sizeof *kernels; i++)
        if (kernels[i])
            clReleaseKernel(kernels[i]);
    if (program->cl)
        clReleaseProgram(program->cl);
    camber_free(context, program);
}
