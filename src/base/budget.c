/* Limits what a file can make a run use: memory, tiles, steps of databases, and bytes unpacked from archives. All
 * limits are here, so that a hostile file ends in an error and not in a dead machine. The allocator counts memory; the
 * caller sets the limit, or else it is three quarters of the memory that the machine, the control group and ulimit
 * leave free. The other counts start again with each set of features. */
#define _GNU_SOURCE /* RLIMIT_AS */

#include "base/base.h"
#include "base/control_group.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

static const uint64_t TILES = UINT64_C(1) << 18, STEPS = UINT64_C(1) << 26, STEPS_A_TILE = 4096;
/* An archive stores a repeated tile only once, and a tile of open water takes about 100 bytes. */
static const uint32_t UNFOLD = 32;
static const uint64_t UNFOLD_BYTES = 4 << 20, UNFOLD_BYTES_A_TILE = 128;
/* While no more than this is in use, the machine is not asked for its free memory; few runs ever need more. */
static const uint64_t UNASKED_BYTES = 64 << 20;

void camber_budget_init(camber_budget *budget, const camber_budget_desc *desc) {
    const camber_budget_desc zero = {0};
    budget->desc = desc ? *desc : zero;
    if (!budget->desc.tiles)
        budget->desc.tiles = TILES;
    if (!budget->desc.steps)
        budget->desc.steps = STEPS;
    if (!budget->desc.unfold)
        budget->desc.unfold = UNFOLD;
    atomic_init(&budget->held_bytes, 0);
    atomic_init(&budget->most_bytes, budget->desc.memory_bytes ? budget->desc.memory_bytes : UINT64_MAX);
}

camber_status camber_budget_create(const camber_budget_desc *desc, camber_budget **budget) {
    camber_budget *made = malloc(sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    camber_budget_init(made, desc);
    *budget = made;
    return CAMBER_OK;
}

void camber_budget_destroy(camber_budget *budget) {
    free(budget);
}

uint64_t camber_budget_get_held_bytes(const camber_budget *budget) {
    return atomic_load(&budget->held_bytes);
}

/* ---- Free memory ---- */

/* Reads the first number in a file, or the first one after a word at the start of a line. */
static bool read_number(const char *path, const char *word, uint64_t *number) {
    char line[256];
    FILE *file = fopen(path, "re");
    bool found = false;
    while (file && !found && fgets(line, sizeof line, file)) {
        const size_t length = strlen(word);
        found = strncmp(line, word, length) == 0 && sscanf(line + length, " %" SCNu64, number) == 1;
    }
    if (file)
        fclose(file);
    return found;
}

static uint64_t smaller(uint64_t left, uint64_t right) {
    return left < right ? left : right;
}

/* Lowers *least to what a control group leaves free. Without a limit, version 2 says "max", and version 1 names more
 * than any machine has. */
static void look_at_group(void *least, const char *folder) {
    static const struct {
        const char *most, *held, *kept;
    } versions[] = {{"memory.max", "memory.current", "inactive_file"},
                    {"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"}};
    char path[4200];
    for (size_t i = 0; i < sizeof versions / sizeof *versions; i++) {
        uint64_t most, held = 0, kept = 0;
        snprintf(path, sizeof path, "%s/%s", folder, versions[i].most);
        if (!read_number(path, "", &most))
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, versions[i].held);
        (void)read_number(path, "", &held);
        /* The kernel gives up cached files when memory is needed, so they count as free. */
        snprintf(path, sizeof path, "%s/memory.stat", folder);
        (void)read_number(path, versions[i].kept, &kept);
        held = held > kept ? held - kept : 0;
        *(uint64_t *)least = smaller(*(uint64_t *)least, most > held ? most - held : 0);
    }
}

uint64_t camber_control_groups_left(const char *root) {
    uint64_t least = UINT64_MAX;
    camber_control_group_visit(root, "memory", look_at_group, &least);
    return least;
}

uint64_t camber_address_space_left(void) {
    struct rlimit limit;
    uint64_t pages = 0;
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return UINT64_MAX;
    (void)read_number("/proc/self/statm", "", &pages);
    const uint64_t used = pages * (uint64_t)sysconf(_SC_PAGESIZE);
    return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

/* If the system does not say how much memory is free, assume half of it. */
static uint64_t machine_free_bytes(void) {
    uint64_t kilobytes;
    if (read_number("/proc/meminfo", "MemAvailable:", &kilobytes))
        return 1024 * kilobytes;
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? (uint64_t)pages * (uint64_t)size / 2 : UINT64_MAX / 2;
}

static void look_up(camber_budget *budget, uint64_t held_bytes) {
    const uint64_t free_bytes =
        smaller(machine_free_bytes(), smaller(camber_control_groups_left(""), camber_address_space_left()));
    uint64_t unknown = UINT64_MAX;
    atomic_compare_exchange_strong(&budget->most_bytes, &unknown, held_bytes + free_bytes / 4 * 3);
}

uint64_t camber_budget_get_most_bytes(camber_budget *budget) {
    if (atomic_load(&budget->most_bytes) == UINT64_MAX)
        look_up(budget, camber_budget_get_held_bytes(budget));
    return atomic_load(&budget->most_bytes);
}

/* ---- Memory ---- */

bool camber_budget_take(camber_context *context, uint64_t size_bytes) {
    camber_budget *budget = context->budget;
    const uint64_t held = atomic_fetch_add(&budget->held_bytes, size_bytes);
    const uint64_t most =
        held + size_bytes > UNASKED_BYTES ? camber_budget_get_most_bytes(budget) : atomic_load(&budget->most_bytes);
    if (size_bytes <= most && held <= most - size_bytes)
        return true;
    atomic_fetch_sub(&budget->held_bytes, size_bytes);
    return false;
}

camber_status camber_budget_fail(camber_context *context, uint64_t size_bytes) {
    camber_budget *budget = context->budget;
    return camber_fail(context, CAMBER_ERROR_MEMORY,
                       "memory: %.1f MB are in use, %.1f MB more are needed, and %.1f MB are allowed; give it less "
                       "data, or allow more memory",
                       (double)camber_budget_get_held_bytes(budget) / 1e6, (double)size_bytes / 1e6,
                       (double)camber_budget_get_most_bytes(budget) / 1e6);
}

void camber_budget_give(camber_context *context, uint64_t size_bytes) {
    atomic_fetch_sub(&context->budget->held_bytes, size_bytes);
}

bool camber_budget_has(const camber_context *context, uint64_t size_bytes) {
    const uint64_t held = camber_budget_get_held_bytes(context->budget),
                   most = camber_budget_get_most_bytes(context->budget);
    return size_bytes <= most && held <= most - size_bytes;
}

/* PoCL and its compiler end the process when they run out of address space. They needed 0.8 GB on two cores with a cold
 * cache when this was measured. Each thread takes a stack of 8 MB and a heap of 64 MB. */
camber_status camber_budget_check_drivers(camber_context *context) {
    const char *asked = getenv("POCL_MAX_PTHREAD_COUNT");
    const long threads = asked ? strtol(asked, NULL, 10) : sysconf(_SC_NPROCESSORS_ONLN);
    const uint64_t wanted =
        (UINT64_C(640) << 20) + (uint64_t)(threads > 0 && threads < 4096 ? threads : 1) * (72 << 20);
    const uint64_t left = camber_address_space_left();
    if (left >= wanted)
        return CAMBER_OK;
    return camber_fail(context, CAMBER_ERROR_MEMORY,
                       "memory: %.0f MB of address space are left, and OpenCL's drivers may need %.0f; raise the limit "
                       "(ulimit -v)",
                       (double)left / 1e6, (double)wanted / 1e6);
}

/* ---- Counts of a set of features ---- */

void camber_budget_begin(camber_context *context) {
    context->spent = (camber_spent){0};
}

camber_status camber_budget_take_tiles(camber_context *context, const char *name, uint64_t count) {
    const uint64_t most = context->budget->desc.tiles;
    if (count > most || context->spent.tiles > most - count)
        return camber_fail(context, CAMBER_ERROR_LIMIT,
                           "%s: more than %" PRIu64
                           " tiles; draw less of it: a style that names it as a source reads only what the view sees",
                           name, most);
    context->spent.tiles += count;
    return CAMBER_OK;
}

bool camber_budget_take_steps(camber_context *context, uint64_t count) {
    context->spent.steps += count;
    return context->spent.steps <= context->budget->desc.steps + STEPS_A_TILE * context->spent.tiles;
}

void camber_budget_open(camber_context *context, uint64_t file_bytes) {
    context->spent.file_bytes += file_bytes;
}

static uint64_t most_unfolded(const camber_context *context) {
    const camber_spent *spent = &context->spent;
    return UNFOLD_BYTES + UNFOLD_BYTES_A_TILE * spent->tiles + context->budget->desc.unfold * spent->file_bytes;
}

camber_status camber_budget_unfold(camber_context *context, const char *name, uint64_t size_bytes) {
    camber_spent *spent = &context->spent;
    spent->unfolded_bytes += size_bytes;
    if (spent->unfolded_bytes <= most_unfolded(context))
        return CAMBER_OK;
    return camber_fail(context, CAMBER_ERROR_LIMIT,
                       "%s: its tiles hold more than %.1f MB, %" PRIu32
                       " times what the file has; get it from a source "
                       "that you trust",
                       name, (double)spent->unfolded_bytes / 1e6, context->budget->desc.unfold);
}

uint64_t camber_budget_unfolds(const camber_context *context) {
    const uint64_t most = most_unfolded(context), done = context->spent.unfolded_bytes;
    return most > done ? most - done : 0;
}

void camber_budget_read_again(camber_context *context) {
    context->spent.unfolded_bytes = 0;
}
