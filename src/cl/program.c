/* Building the kernels, and keeping what was built: what has been compiled once on a machine is loaded from then on. Of
 * several processes that need a program which nobody has built yet, one compiles it and the others load it. */
#include "cl/program.h"

#include "base/embedded.h"
#include "kernels/layout.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const OPTIONS = "-cl-std=CL1.2 -w -DCAMBER_METHOD=%d%s%s -DCAMBER_ITEM=%zu%s";

/* Which kernels a program has. */
typedef enum program_kind {
    PROGRAM_METHOD,
    PROGRAM_NETWORK,
    PROGRAM_MEASURES,
    PROGRAM_OFFSETS,
    PROGRAM_COVER,
} program_kind;

/* What a program is made of. */
typedef struct recipe {
    program_kind kind;
    const char *name;
    const char *source;
    size_t source_size;
    char options[192];
} recipe;

/* Everything that a binary depends on. */
static uint64_t cache_key(const camber_device_info *info, const recipe *from) {
    uint64_t key = camber_hash(CAMBER_HASH_START, from->source, from->source_size);
    const char *options = from->options;
    const char *parts[] = {info->platform, info->name, info->version, info->driver, options};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        key = camber_hash(key, parts[i], strlen(parts[i]) + 1);
    return key;
}

static void cache_name(uint64_t key, char name[64]) {
    snprintf(name, 64, "kernels-%016llx.bin", (unsigned long long)key);
}

/* Of a binary and its key: what a crash or a full disk left is told from a whole one, and so is a file under another's
 * name. */
static uint64_t hash_binary(uint64_t key, const unsigned char *binary, size_t size_bytes) {
    return camber_hash(camber_hash(CAMBER_HASH_START, &key, sizeof key), binary, size_bytes);
}

/* A program of a binary behind its hash. */
static bool take_binary(camber_device *device, camber_program *program, const char *options, const char *bytes,
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
    program->cl = clCreateProgramWithBinary(device->cl, 1, &device->id, &binary_size, &binary, &binary_code, &code);
    if (code == CL_SUCCESS && binary_code == CL_SUCCESS &&
        clBuildProgram(program->cl, 1, &device->id, options, NULL, NULL) == CL_SUCCESS)
        return true;
    if (program->cl)
        clReleaseProgram(program->cl);
    program->cl = NULL;
    return false;
}

/* What the machine's users share, or what this one has; where it is made for all of them, what they share. */
static bool load(camber_device *device, camber_program *program, const char *options) {
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
        loaded = take_binary(device, program, options, bytes, size);
        camber_free(device->context, bytes);
    }
    return loaded;
}

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

/* A binary of PoCL's has work-groups of any size. Where PoCL makes kernels for the size, offset and count of each
 * launch instead, as it does unless it is told not to, that is compiled in vain, and PoCL's own cache has to do. */
static bool is_worth_saving(const camber_device *device) {
    const char *specialized = getenv("POCL_WORK_GROUP_SPECIALIZATION");
    return strcmp(device->info.platform, "Portable Computing Language") != 0 || (specialized && specialized[0] == '0');
}

static camber_status build(camber_device *device, camber_program *program, const recipe *from) {
    cl_int code;
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

/* false, and nothing fails by it: the file is not saved. */
static bool save(camber_device *device, const camber_program *program) {
    size_t size = 0;
    bool saved = false;
    if (!is_worth_saving(device))
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
        hash = hash_binary(program->key, binary, size);
        memcpy(bytes, &hash, sizeof hash);
        cache_name(program->key, name);
        saved = camber_cache_save(device->context, name, bytes, size + sizeof hash);
    }
    camber_free(device->context, bytes);
    return saved;
}

static camber_status make_kernels(camber_device *device, camber_program *program, program_kind kind) {
    const struct {
        const char *name;
        cl_kernel *kernel;
        program_kind kind;
    } stages[] = {{"survey", &program->survey, PROGRAM_NETWORK},    {"project", &program->project, PROGRAM_NETWORK},
                  {"classify", &program->classify, PROGRAM_METHOD}, {"scan", &program->scan, PROGRAM_METHOD},
                  {"emit", &program->emit, PROGRAM_METHOD},         {"tally", &program->tally, PROGRAM_MEASURES},
                  {"measure", &program->measure, PROGRAM_MEASURES}, {"span", &program->span, PROGRAM_OFFSETS},
                  {"tell", &program->tell, PROGRAM_OFFSETS},        {"shift", &program->shift, PROGRAM_OFFSETS},
                  {"shape", &program->shape, PROGRAM_COVER},        {"count", &program->count, PROGRAM_COVER},
                  {"total", &program->total, PROGRAM_COVER},        {"fill", &program->fill, PROGRAM_COVER},
                  {"cover", &program->cover, PROGRAM_COVER}};
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

/* PoCL unpacks a binary file by file, and another process that unpacks the same may look for one at the wrong moment.
 */
static bool load_alone(camber_device *device, camber_program *program, const char *options) {
    static const double LONGEST_MS = 500; /* it takes two: longer, and something else is wrong */
    const int lock = camber_cache_lock(device->context, program->key, LONGEST_MS);
    const bool loaded = load(device, program, options);
    camber_cache_unlock(lock);
    return loaded;
}

/* Unless another process does so meanwhile. */
static camber_status build_alone(camber_device *device, camber_program *program, const recipe *from) {
    static const double LONGEST_MS = 60e3;
    const int lock = camber_cache_lock(device->context, program->key, LONGEST_MS);
    camber_status status = CAMBER_OK;
    program->kept = load(device, program, from->options);
    if (!program->kept) {
        camber_progress(device->context, "compiling kernels", -1);
        status = build(device, program, from);
        program->kept = status == CAMBER_OK && save(device, program);
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

/* method: one of camber_method's, or what stands for no method. */
static void set_options(const camber_device *device, int method, bool measured, recipe *from) {
    char block[32] = "";
    if (device->block != CAMBER_BLOCK)
        snprintf(block, sizeof block, " -DCAMBER_BLOCK=%zu", device->block);
    snprintf(from->options, sizeof from->options, OPTIONS, method,
             device->rounds_correctly ? " -cl-fp32-correctly-rounded-divide-sqrt" : "", block, device->item,
             measured ? " -DCAMBER_MEASURED=1" : "");
}

#ifdef CAMBER_KERNEL_FOLDER
/* For who changes kernels: their text is read where the build has written it, and a change is no build. */
static camber_status make_current(camber_device *device, recipe *from, camber_program **program) {
    static const char *const files[] = {"kernels.cl", "network.cl", "measure.cl", "offset.cl", "cover.cl"};
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

/* Makes a program unless it is there, and gives it. */
static camber_status use_program(camber_device *device, recipe *from, camber_program **kept, camber_program **program) {
    const camber_status status = *kept ? CAMBER_OK : make_current(device, from, kept);
    if (status == CAMBER_OK)
        *program = *kept;
    return status;
}

camber_status camber_device_program(camber_device *device, camber_program_desc desc, camber_program **program) {
    recipe from = {PROGRAM_METHOD, camber_method_name(desc.method), camber_kernels_source, camber_kernels_source_size,
                   ""};
    set_options(device, (int)desc.method, desc.measured, &from);
    const size_t used = strlen(from.options);
    if (!desc.round_limits)
        snprintf(from.options + used, sizeof from.options - used, " -DCAMBER_ROUND_LIMITS=0");
    return use_program(device, &from, &device->programs[desc.measured][desc.round_limits][desc.method], program);
}

camber_status camber_device_measures(camber_device *device, camber_program **program) {
    recipe from = {PROGRAM_MEASURES, "measures", camber_measure_kernels_source, camber_measure_kernels_source_size, ""};
    set_options(device, -1, false, &from);
    return use_program(device, &from, &device->measures, program);
}

camber_status camber_device_offsets(camber_device *device, bool measured, camber_program **program) {
    recipe from = {PROGRAM_OFFSETS, "offsets", camber_offset_kernels_source, camber_offset_kernels_source_size, ""};
    set_options(device, -1, measured, &from);
    return use_program(device, &from, &device->offset_programs[measured], program);
}

camber_status camber_device_cover_program(camber_device *device, unsigned variant, camber_program **program) {
    recipe from = {PROGRAM_COVER, "drawing", camber_cover_kernels_source, camber_cover_kernels_source_size, ""};
    set_options(device, -1, false, &from);
    const size_t used = strlen(from.options);
    snprintf(from.options + used, sizeof from.options - used, "%s%s%s",
             variant == 0 && device->lanes == 1 ? " -DCAMBER_LANES=1" : "",
             variant & CAMBER_COVER_RICH ? " -DCAMBER_COVER_RICH=1" : "",
             variant & CAMBER_COVER_PITCHED ? " -DCAMBER_COVER_PITCHED=1" : "");
    return use_program(device, &from, &device->cover[variant], program);
}

camber_status camber_device_network_program(camber_device *device, bool measured, bool pitched,
                                            camber_program **program) {
    recipe from = {PROGRAM_NETWORK, "networks", camber_network_kernels_source, camber_network_kernels_source_size, ""};
    set_options(device, -1, measured, &from);
    const size_t used = strlen(from.options);
    if (pitched)
        snprintf(from.options + used, sizeof from.options - used, " -DCAMBER_PITCHED=1");
    return use_program(device, &from, &device->network_programs[measured][pitched], program);
}

/* The n-th program of all that a device can be asked for, or none; what takes longest comes first. */
static camber_status use_nth(camber_device *device, unsigned n, camber_program **program) {
    static const unsigned variants[] = {CAMBER_COVER_RICH | CAMBER_COVER_PITCHED, CAMBER_COVER_RICH, 0};
    enum { VARIANTS = sizeof variants / sizeof *variants, OFFSETS = 2, NETWORKS = 4, METHODS = 12 };
    if (n < VARIANTS)
        return camber_device_cover_program(device, variants[n], program);
    n -= VARIANTS;
    if (n < OFFSETS)
        return camber_device_offsets(device, n, program);
    n -= OFFSETS;
    if (n < NETWORKS)
        return camber_device_network_program(device, n & 1, n >> 1 & 1, program);
    n -= NETWORKS;
    if (n < METHODS)
        return camber_device_program(device, (camber_program_desc){(camber_method)(n / 4), n & 1, n >> 1 & 1}, program);
    return n == METHODS ? camber_device_measures(device, program) : CAMBER_OK;
}

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
        status = use_nth(device, n, &program);
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
    cl_kernel kernels[] = {program->survey, program->project, program->classify, program->scan, program->emit,
                           program->tally,  program->measure, program->span,     program->tell, program->shift,
                           program->shape,  program->count,   program->total,    program->fill, program->cover};
    for (size_t i = 0; i < sizeof kernels / sizeof *kernels; i++)
        if (kernels[i])
            clReleaseKernel(kernels[i]);
    if (program->cl)
        clReleaseProgram(program->cl);
    camber_free(context, program);
}
