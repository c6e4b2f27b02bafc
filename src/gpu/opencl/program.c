/* Loads and builds OpenCL programs, and caches what was built.
 *
 * Input: a source with its options. Output: a cl_program. Main idea: a program is compiled once per machine and loaded
 * from then on.
 *
 *     in the cache?   -- yes -- load the binary -------------------> use it
 *          | no
 *     take the lock of this program: of several processes that need it, one compiles and the others wait
 *          |
 *     in the cache by now?  -- no -- compile, save the binary -----> use it
 *
 * A binary's file name is a hash of everything that it depends on, and its first 8 bytes are a hash of its contents.
 * With PoCL the run that compiles a program also loads what it saved (pocl.c). */
#include "gpu/opencl/opencl.h"
#include "gpu/opencl/pocl.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct built_program {
    cl_program cl;
    uint64_t key; /* the name of its file in the cache */
    bool built, kept;
} built_program;

/* Change this to save the same program in another form. */
static const char FORM[] = "without LLVM's code";

/* Returns a hash of everything that a binary depends on. */
static uint64_t cache_key(const camber_device_info *info, const camber_program_source *from) {
    uint64_t key = camber_hash(CAMBER_HASH_START, from->text, from->text_bytes);
    const char *options = from->options;
    const char *parts[] = {info->platform, info->name, info->version, info->driver, options, FORM};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        key = camber_hash(key, parts[i], strlen(parts[i]) + 1);
    return key;
}

static void cache_name(uint64_t key, char name[64]) {
    snprintf(name, 64, "kernels-%016llx.bin", (unsigned long long)key);
}

/* Returns a hash of a binary and its key, which detects a file that a crash or a full disk cut short, and a file that
 * belongs to another program. */
static uint64_t hash_binary(uint64_t key, const unsigned char *binary, size_t size_bytes) {
    return camber_hash(camber_hash(CAMBER_HASH_START, &key, sizeof key), binary, size_bytes);
}

/* Makes a program from a cache file: 8 bytes of hash, then the binary. Returns false if that fails. */
static bool load_binary(camber_device *device, built_program *program, const char *options, const char *bytes,
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
        return false; /* building it will fail too, and say why */
    program->cl = camber_cl.CreateProgramWithBinary(opencl_of(device)->cl, 1, &opencl_of(device)->id, &binary_size,
                                                    &binary, &binary_code, &code);
    if (code == CL_SUCCESS && binary_code == CL_SUCCESS &&
        camber_cl.BuildProgram(program->cl, 1, &opencl_of(device)->id, options, NULL, NULL) == CL_SUCCESS)
        return true;
    if (program->cl)
        camber_cl.ReleaseProgram(program->cl);
    program->cl = NULL;
    return false;
}

/* Looks in the cache that all users of the machine share, then in this user's own. A run that fills the shared cache
 * looks only there. */
static bool load_cached(camber_device *device, built_program *program, const char *options) {
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
    camber_cl.GetProgramBuildInfo(program, opencl_of(device)->id, CL_PROGRAM_BUILD_LOG, 0, NULL, &size);
    char *log = camber_alloc_zero(device->context, size + 1, 1);
    if (!log)
        return CAMBER_ERROR_MEMORY;
    camber_cl.GetProgramBuildInfo(program, opencl_of(device)->id, CL_PROGRAM_BUILD_LOG, size, log, NULL);
    camber_fail(device->context, CAMBER_ERROR_DEVICE,
                "clBuildProgram: the kernels do not build on %s; update its driver or try another device: %.*s",
                device->info.name, (int)LOG_MAX, log);
    camber_free(device->context, log);
    return CAMBER_ERROR_DEVICE;
}

static camber_status build_from_source(camber_device *device, built_program *program,
                                       const camber_program_source *from) {
    cl_int code;
    if (camber_is_pocl(&device->info)) {
        const camber_status status = camber_pocl_check_program(device, NULL, 0);
        if (status != CAMBER_OK)
            return status;
    }
    program->cl = camber_cl.CreateProgramWithSource(opencl_of(device)->cl, 1, (const char *[]){from->text},
                                                    &from->text_bytes, &code);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clCreateProgramWithSource", code);
    code = camber_cl.BuildProgram(program->cl, 1, &opencl_of(device)->id, from->options, NULL, NULL);
    if (code == CL_BUILD_PROGRAM_FAILURE)
        return fail_build(device, program->cl);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clBuildProgram", code);
    program->built = true;
    return CAMBER_OK;
}

/* Saves the binary in the cache. Returns false if it could not be saved, which is not an error. PoCL compiles all
 * kernels of a program when it is asked for the binary. */
static bool save_binary(camber_device *device, const built_program *program) {
    size_t size = 0;
    bool saved = false;
    if (!camber_cache_can_save(device->context))
        return false;
    if (camber_cl.GetProgramInfo(program->cl, CL_PROGRAM_BINARY_SIZES, sizeof size, &size, NULL) != CL_SUCCESS ||
        size == 0)
        return false;
    uint64_t hash;
    unsigned char *bytes = camber_resize_quietly(device->context, NULL, size + sizeof hash);
    if (!bytes)
        return false;
    unsigned char *binary = bytes + sizeof hash;
    if (camber_cl.GetProgramInfo(program->cl, CL_PROGRAM_BINARIES, sizeof binary, &binary, NULL) == CL_SUCCESS) {
        char name[64];
        /* The binary of a PoCL version that camber does not know is saved unstripped: its kernels run as they are if
         * POCL_WORK_GROUP_SPECIALIZATION is 0, as the tool sets it, and are otherwise compiled again. */
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

/* Loads under the program's lock. PoCL unpacks a binary file by file, and another process that unpacks the same one
 * might look for a file too early. */
static bool load_alone(camber_device *device, built_program *program, const char *options) {
    static const double LONGEST_MS = 30e3; /* loading takes 2 ms, and much longer on a busy machine */
    const int lock = camber_cache_lock(device->context, program->key, LONGEST_MS);
    const bool loaded = load_cached(device, program, options);
    camber_cache_unlock(lock);
    return loaded;
}

/* Replaces the compiled program by the saved one, because PoCL would compile each kernel of the former again when it is
 * launched. */
static bool use_saved(camber_device *device, built_program *program, const char *options) {
    built_program saved = {.key = program->key};
    if (!load_cached(device, &saved, options))
        return false;
    camber_cl.ReleaseProgram(program->cl);
    program->cl = saved.cl;
    return true;
}

/* Builds under the program's lock, unless another process has done so while this one waited. */
static camber_status build_alone(camber_device *device, built_program *program, const camber_program_source *from) {
    static const double LONGEST_MS =
        600e3; /* a lock ends with its process; without the lock this process compiles too */
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

camber_status camber_opencl_make_program(camber_device *device, const camber_program_source *from,
                                         camber_program *program) {
    built_program made = {.key = cache_key(&device->info, from)};
    camber_status status = CAMBER_OK;
    made.kept = load_alone(device, &made, from->options);
    if (!made.kept)
        status = build_alone(device, &made, from);
    program->native = made.cl;
    program->built = made.built;
    program->kept = made.kept;
    return status;
}

void camber_opencl_release_program(void *native) {
    camber_cl.ReleaseProgram(native);
}

camber_status camber_opencl_make_kernel(const camber_device *device, void *program, const char *name,
                                        camber_kernel **kernel) {
    cl_int code;
    cl_kernel made = camber_cl.CreateKernel(program, name, &code);
    if (code != CL_SUCCESS)
        return camber_fail_cl(device->context, "clCreateKernel", code);
    *kernel = (camber_kernel *)made;
    return CAMBER_OK;
}

void camber_opencl_release_kernel(camber_kernel *kernel) {
    camber_cl.ReleaseKernel((cl_kernel)kernel);
}
