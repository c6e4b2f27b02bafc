/* Makes programs: for each row of the list in programs.h, the source and the options that it is made from, and the
 * kernels that it has.
 *
 * Input: sources embedded in the library. Output: camber_programs, which a device's back end makes when they are first
 * needed, and which the device keeps. */
#include "gpu/backend.h"

#include "base/embedded.h"
#include "kernels/layout.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

/* The options of all programs of a device. Those of the program follow. */
static const char *const OPTIONS = "-cl-std=CL1.2 -w -DCAMBER_DEVICE=1%s%s -DCAMBER_POINT_CHUNK=%zu%s%s";

/* A kernel's name in the source, and its member of camber_program. */
typedef struct kernel_member {
    const char *name;
    size_t offset;
} kernel_member;

#define KERNEL_MEMBER(of, name) {#name, offsetof(camber_program, name)},
#define KERNELS_OF(source)                                                                                             \
    static const kernel_member source##_kernels[] = {                                                                  \
        CAMBER_KERNELS_OF_##source(KERNEL_MEMBER, source){NULL, 0},                                                    \
    }
KERNELS_OF(raster);
KERNELS_OF(offset);
KERNELS_OF(cull);
KERNELS_OF(tessellate);
KERNELS_OF(arc_length);

typedef struct program_row {
    const char *name, *file, *text;
    const unsigned long *text_bytes;
    const char *options;
    const kernel_member *kernels;
} program_row;

#define ROW(with, name, source, options)                                                                               \
    {#name, #source ".cl", camber_##source##_kernels, &camber_##source##_kernels_size, options, source##_kernels},
static const program_row rows[CAMBER_PROGRAM_COUNT] = {CAMBER_PROGRAMS(ROW, 0)};

static camber_kernel **member_of(camber_program *program, const kernel_member *kernel) {
    return (camber_kernel **)(void *)((char *)program + kernel->offset);
}

static camber_status make_kernels(const camber_device *device, camber_program *program) {
    camber_status status = CAMBER_OK;
    for (const kernel_member *kernel = rows[program->number].kernels; kernel->name && status == CAMBER_OK; kernel++)
        status = device->backend->make_kernel(device, program->native, kernel->name, member_of(program, kernel));
    return status;
}

static camber_status make_program(camber_device *device, camber_program_source *from, camber_program **program) {
    camber_program *made = camber_alloc_zero(device->context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->number = from->number;
    const double begin = camber_now_ms();
    camber_status status = device->backend->make_program(device, from, made);
    if (status == CAMBER_OK)
        status = make_kernels(device, made);
    if (status != CAMBER_OK) {
        camber_program_destroy(device, made);
        return status;
    }
    const char *how = device->info.fixed_kernels ? "part of the library,"
                      : made->built              ? "built in"
                                                 : "from the cache in";
    camber_log(device->context, CAMBER_LOG_INFO, "kernels of %s: %s %.0f ms", rows[from->number].name, how,
               camber_now_ms() - begin);
    *program = made;
    return CAMBER_OK;
}

/* Writes the compiler's options. Only the rasterizer's vectors depend on the number of lanes. */
static void set_options(const camber_device *device, const program_row *row, camber_program_source *from) {
    char block[32] = "", lanes[32] = "";
    if (device->block != CAMBER_BLOCK)
        snprintf(block, sizeof block, " -DCAMBER_BLOCK=%zu", device->block);
    if (row->kernels == raster_kernels)
        snprintf(lanes, sizeof lanes, " -DCAMBER_LANES=%u", device->lanes);
    snprintf(from->options, sizeof from->options, OPTIONS,
             device->rounds_correctly ? " -cl-fp32-correctly-rounded-divide-sqrt" : "", block, device->point_chunk,
             lanes, row->options);
}

#ifdef CAMBER_KERNEL_FOLDER
/* For people who change kernels: sources are read at run time from the build tree, so that a change needs no compile of
 * the library. */
static camber_status make_current(camber_device *device, camber_program_source *from, camber_program **program) {
    char path[CAMBER_FOLDER_SIZE], *text = NULL;
    snprintf(path, sizeof path, "%s/%s", CAMBER_KERNEL_FOLDER, rows[from->number].file);
    camber_status status = camber_read_file(device->context, path, CAMBER_NAMED_BY_CALLER, &text, &from->text_bytes);
    from->text = text;
    if (status == CAMBER_OK)
        status = make_program(device, from, program);
    camber_free(device->context, text);
    return status;
}
#else
#define make_current make_program
#endif

/* Returns a program that the device keeps, after making it if it is missing. */
static camber_status ensure_program(camber_device *device, unsigned number, camber_program **program) {
    const program_row *row = rows + number;
    camber_program **kept = device->programs + number;
    camber_status status = camber_check_process(device->context);
    if (status == CAMBER_OK && !*kept) {
        camber_program_source from = {
            .number = (camber_program_number)number, .text = row->text, .text_bytes = *row->text_bytes};
        set_options(device, row, &from);
        status = make_current(device, &from, kept);
    }
    if (status == CAMBER_OK)
        *program = *kept;
    return status;
}

/* ---- Programs by what they are for ---- */

_Static_assert(CAMBER_PROGRAM_offset_measured == CAMBER_PROGRAM_offset + 1 &&
                   CAMBER_PROGRAM_cull_measured == CAMBER_PROGRAM_cull + 1 &&
                   CAMBER_PROGRAM_cull_pitched == CAMBER_PROGRAM_cull + 2 &&
                   CAMBER_PROGRAM_strip_measured == CAMBER_PROGRAM_strip + 1 &&
                   CAMBER_PROGRAM_strip_round == CAMBER_PROGRAM_strip + 2 &&
                   CAMBER_PROGRAM_kite == CAMBER_PROGRAM_strip + 4 && CAMBER_PROGRAM_fan == CAMBER_PROGRAM_strip + 8,
               "numbers of programs are computed from these");

camber_status camber_device_program(camber_device *device, camber_program_desc desc, camber_program **program) {
    const unsigned of_method = CAMBER_PROGRAM_strip + 4u * (unsigned)desc.method;
    return ensure_program(device, of_method + 2u * desc.round_limits + desc.has_arc_length, program);
}

camber_status camber_device_arc_length_program(camber_device *device, camber_program **program) {
    return ensure_program(device, CAMBER_PROGRAM_arc_length, program);
}

camber_status camber_device_offset_program(camber_device *device, bool has_arc_length, camber_program **program) {
    return ensure_program(device, CAMBER_PROGRAM_offset + has_arc_length, program);
}

camber_status camber_device_raster_program(camber_device *device, unsigned variant, camber_program **program) {
    const camber_program_number number = variant & CAMBER_RASTER_PITCHED ? CAMBER_PROGRAM_draw_pitched
                                         : variant & CAMBER_RASTER_RICH  ? CAMBER_PROGRAM_draw_rich
                                                                         : CAMBER_PROGRAM_draw;
    return ensure_program(device, number, program);
}

camber_status camber_device_network_program(camber_device *device, bool has_arc_length, bool pitched,
                                            camber_program **program) {
    return ensure_program(device, CAMBER_PROGRAM_cull + 2u * pitched + has_arc_length, program);
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
    if (device->info.fixed_kernels || !camber_cache_folder(device->context, all.folder))
        all.folder[0] = 0;
    for (unsigned n = share; n < CAMBER_PROGRAM_COUNT && status == CAMBER_OK; n += shares) {
        camber_program *program = NULL;
        status = ensure_program(device, n, &program);
        if (status != CAMBER_OK)
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
    if (!program)
        return;
    for (const kernel_member *kernel = rows[program->number].kernels; kernel->name; kernel++)
        if (*member_of(program, kernel))
            device->backend->release_kernel(*member_of(program, kernel));
    if (program->native)
        device->backend->release_program(program->native);
    camber_free(device->context, program);
}
