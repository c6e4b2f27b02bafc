/* Lists the programs, the sources and options that each is made from, and the kernels that it has.
 *
 * Input: sources embedded in the library. Output: camber_programs, which a device's back end makes when they are first
 * needed, and which the device keeps. */
#include "gpu/backend.h"

#include "base/embedded.h"
#include "kernels/layout.h"

#include <stdio.h>
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

typedef struct recipe {
    program_kind kind;
    camber_program_source source;
} recipe;

enum { KERNELS = 16 };

/* A program's kernel, and its name in the source. */
typedef struct named_kernel {
    const char *name;
    camber_kernel **kernel;
    program_kind kind;
} named_kernel;

static void list_kernels(camber_program *program, named_kernel kernels[KERNELS]) {
    const named_kernel list[KERNELS] = {{"cull_count", &program->cull_count, PROGRAM_NETWORK},
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
    memcpy(kernels, list, sizeof list);
}

/* Makes the kernels that belong to a kind of program. */
static camber_status make_kernels(const camber_device *device, camber_program *program, program_kind kind) {
    named_kernel kernels[KERNELS];
    camber_status status = CAMBER_OK;
    list_kernels(program, kernels);
    for (size_t i = 0; i < KERNELS && status == CAMBER_OK; i++)
        if (kernels[i].kind == kind)
            status = device->backend->make_kernel(device, program->native, kernels[i].name, kernels[i].kernel);
    return status;
}

static camber_status make_program(camber_device *device, const recipe *from, camber_program **program) {
    camber_program *made = camber_alloc_zero(device->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    const double begin = camber_now_ms();
    camber_status status = device->backend->make_program(device, &from->source, made);
    if (status == CAMBER_OK)
        status = make_kernels(device, made, from->kind);
    if (status != CAMBER_OK) {
        camber_program_destroy(device, made);
        return status;
    }
    camber_log(device->context, CAMBER_LOG_INFO, "kernels of %s: %s in %.0f ms", from->source.name,
               made->built ? "built" : "from the cache", camber_now_ms() - begin);
    *program = made;
    return CAMBER_OK;
}

/* Writes the compiler's options. method: a camber_method, or -1 for programs that have none. */
static void set_options(const camber_device *device, int method, bool has_arc_length, recipe *from) {
    char block[32] = "";
    if (device->block != CAMBER_BLOCK)
        snprintf(block, sizeof block, " -DCAMBER_BLOCK=%zu", device->block);
    snprintf(from->source.options, sizeof from->source.options, OPTIONS, method,
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
    camber_status status =
        camber_read_file(device->context, path, CAMBER_NAMED_BY_CALLER, &text, &from->source.text_bytes);
    from->source.text = text;
    if (status == CAMBER_OK)
        status = make_program(device, from, program);
    camber_free(device->context, text);
    return status;
}
#else
#define make_current make_program
#endif

/* Returns a program that the device keeps, after making it if it is missing. */
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
    recipe from = {
        PROGRAM_METHOD,
        {camber_method_get_name(desc.method), camber_tessellate_kernels, camber_tessellate_kernels_size, ""}};
    set_options(device, (int)desc.method, desc.has_arc_length, &from);
    const size_t used = strlen(from.source.options);
    if (!desc.round_limits)
        snprintf(from.source.options + used, sizeof from.source.options - used, " -DCAMBER_ROUND_LIMITS=0");
    return ensure_program(device, &from, &device->programs[desc.has_arc_length][desc.round_limits][desc.method],
                          program);
}

camber_status camber_device_arc_length_program(camber_device *device, camber_program **program) {
    recipe from = {PROGRAM_ARC_LENGTHS, {"measures", camber_arc_length_kernels, camber_arc_length_kernels_size, ""}};
    set_options(device, -1, false, &from);
    return ensure_program(device, &from, &device->arc_length_program, program);
}

camber_status camber_device_offset_program(camber_device *device, bool has_arc_length, camber_program **program) {
    recipe from = {PROGRAM_OFFSETS, {"offsets", camber_offset_kernels, camber_offset_kernels_size, ""}};
    set_options(device, -1, has_arc_length, &from);
    return ensure_program(device, &from, &device->offset_programs[has_arc_length], program);
}

camber_status camber_device_raster_program(camber_device *device, unsigned variant, camber_program **program) {
    recipe from = {PROGRAM_RASTER, {"drawing", camber_raster_kernels, camber_raster_kernels_size, ""}};
    set_options(device, -1, false, &from);
    const size_t used = strlen(from.source.options);
    snprintf(from.source.options + used, sizeof from.source.options - used, " -DCAMBER_LANES=%u%s%s", device->lanes,
             variant & CAMBER_RASTER_RICH ? " -DCAMBER_RASTER_RICH=1" : "",
             variant & CAMBER_RASTER_PITCHED ? " -DCAMBER_RASTER_PITCHED=1" : "");
    return ensure_program(device, &from, &device->raster_programs[variant], program);
}

camber_status camber_device_network_program(camber_device *device, bool has_arc_length, bool pitched,
                                            camber_program **program) {
    recipe from = {PROGRAM_NETWORK, {"networks", camber_cull_kernels, camber_cull_kernels_size, ""}};
    set_options(device, -1, has_arc_length, &from);
    const size_t used = strlen(from.source.options);
    if (pitched)
        snprintf(from.source.options + used, sizeof from.source.options - used, " -DCAMBER_PITCHED=1");
    return ensure_program(device, &from, &device->network_programs[has_arc_length][pitched], program);
}

/* Makes the n-th of all programs that a device can be asked for, or leaves *program NULL past the last. The programs
 * that take longest to compile are first. */
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

/* Builds programs share, share + shares, share + 2 * shares and so on, so that several processes can compile at the
 * same time. */
camber_status camber_device_warm(camber_device *device, unsigned share, unsigned shares, camber_warm_result *result) {
    camber_warm_result all = {0};
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
        *result = all;
    return status;
}

void camber_program_destroy(const camber_device *device, camber_program *program) {
    named_kernel kernels[KERNELS];
    if (!program)
        return;
    list_kernels(program, kernels);
    for (size_t i = 0; i < KERNELS; i++)
        if (*kernels[i].kernel)
            device->backend->release_kernel(*kernels[i].kernel);
    if (program->native)
        device->backend->release_program(program->native);
    camber_free(device->context, program);
}
