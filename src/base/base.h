/* The services that every layer uses: memory, log, clock, budget, files, hashes and the cache. All of them belong to a
 * context, so there is no global state. */
#ifndef CAMBER_BASE_BASE_H
#define CAMBER_BASE_BASE_H

#include "base/clock.h"

#include "camber_files.h"

#include <stdarg.h>
#include <stdatomic.h>
#include <string.h>

#if defined(__GNUC__)
#define CAMBER_PRINTF(format_index, first) __attribute__((format(printf, format_index, first)))
#else
#define CAMBER_PRINTF(format_index, first)
#endif

struct camber_budget {
    camber_budget_desc desc; /* defaults are filled in, except for memory_bytes */
    _Atomic uint64_t held_bytes, most_bytes;
};

/* Changes what a budget allows, which any thread may do. With 0, calls that are running fail as soon as they need
 * memory. It is inline because the tool uses it to stop reading, and libcamber hides its internal symbols. */
static inline void camber_budget_allow(camber_budget *budget, uint64_t most_bytes) {
    atomic_store(&budget->most_bytes, most_bytes);
}

/* The part of a budget that the current set of features has used. */
typedef struct camber_spent {
    uint64_t tiles, steps, file_bytes, unfolded_bytes;
} camber_spent;

struct camber_context {
    camber_context_desc desc;
    camber_budget *budget;
    camber_budget own_budget;
    camber_spent spent;
    uint64_t next_serial;        /* for the next polylines; meshes recognize polylines that they have uploaded by it */
    const void *gdal;            /* GDAL's reading functions, which formats/gdal.c loads. NULL: not loaded yet */
    camber_device_info *devices; /* found by camber_device_list, which looks only once */
    size_t device_count;
    bool saves_shared; /* cache.c: files are saved to the folder that all users share */
    void *spare;       /* a freed block for camber_alloc_spare; NULL: none */
};

/* camber_alloc leaves the memory uncleared, camber_alloc_zero clears it. Both return NULL and log an error if there is
 * no memory or if count * size overflows. With count 0 they return a block that can be freed. */
void *camber_alloc(camber_context *context, size_t count, size_t size_bytes);
void *camber_alloc_zero(camber_context *context, size_t count, size_t size_bytes);
/* Grows the array to at least needed elements, and by at least half. The block may move. items is the address of a
 * pointer to elements, and capacity counts elements. On failure returns false and keeps the old block. */
bool camber_grow(camber_context *context, void *items, size_t *capacity, size_t needed, size_t size_bytes);
void camber_free(camber_context *context, void *block);
/* Allocates a block that is needed again in each frame: a freed block is kept for the next frame, if it is large and
 * there is no memory limit, because fresh pages cost more than filling them. The contents are undefined. */
void *camber_alloc_spare(camber_context *context, size_t count, size_t size_bytes);
void camber_free_spare(camber_context *context, void *block);
/* Resizes a block without logging. block may be NULL. Returns NULL if there is no memory, and keeps the block as it
 * was. */
void *camber_resize_quietly(camber_context *context, void *block, size_t size_bytes);
char *camber_copy_string(camber_context *context, const char *text);

void camber_log(camber_context *context, camber_log_level level, const char *format, ...) CAMBER_PRINTF(3, 4);
/* Logs an error and returns status, so that a failure is one line: return camber_fail(...). */
camber_status camber_fail(camber_context *context, camber_status status, const char *format, ...) CAMBER_PRINTF(3, 4);
/* Logs errors as information until the log is restored. For attempts that have a fallback. */
typedef struct camber_saved_log {
    camber_log_fn *log;
    void *user;
} camber_saved_log;
void camber_log_demote_errors(camber_context *context, camber_saved_log *kept);
void camber_log_restore(camber_context *context, const camber_saved_log *kept);
void camber_progress(camber_context *context, const char *stage, double fraction);
/* The same with a count of units; if total is not 0, the fraction is done / total. */
void camber_progress_count(camber_context *context, const char *stage, const char *unit, uint64_t done, uint64_t total);
void camber_progress_tell(camber_context *context, const camber_progress_info *progress);

/* Says who named a file: the caller, or a style, whose files must be inside the context's root. */
typedef enum camber_file_naming {
    CAMBER_NAMED_BY_CALLER = 0,
    CAMBER_NAMED_BY_STYLE,
} camber_file_naming;

/* ---- Budget ---- */

void camber_budget_init(camber_budget *budget, const camber_budget_desc *desc);
/* Counts memory as used, including memory that the allocator does not manage. false: it exceeds the budget; report that
 * with camber_budget_fail. */
bool camber_budget_take(camber_context *context, uint64_t size_bytes);
void camber_budget_give(camber_context *context, uint64_t size_bytes);
bool camber_budget_has(const camber_context *context, uint64_t size_bytes);
/* Returns how many bytes the limit of the address space (ulimit -v) leaves; UINT64_MAX: there is no limit. */
uint64_t camber_address_space_left(void);
/* Returns how many bytes the memory limits of the process's control group and of the groups above it leave; UINT64_MAX:
 * there is no limit. root is "" for the system's own files, or a folder that stands for /. */
uint64_t camber_control_groups_left(const char *root);
camber_status camber_budget_fail(camber_context *context, uint64_t size_bytes);
/* Checks that the process has enough address space for OpenCL's drivers. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_budget_check_drivers(camber_context *context);
/* Starts counting for a new set of features. */
void camber_budget_begin(camber_context *context);
/* Counts tiles. name is used in messages. */
camber_status camber_budget_take_tiles(camber_context *context, const char *name, uint64_t count);
/* Counts steps of a database. false: it has used up its limit. */
bool camber_budget_take_steps(camber_context *context, uint64_t count);
/* Adds the size of a file of tiles that is about to be read; the limit for unpacked bytes grows with it. */
void camber_budget_open(camber_context *context, uint64_t file_bytes);
/* These count bytes that were unpacked from a tile, and say how many more may be unpacked. */
camber_status camber_budget_unfold(camber_context *context, const char *name, uint64_t size_bytes);
uint64_t camber_budget_unfolds(const camber_context *context);
/* Lets the same tiles be read again without counting them twice. */
void camber_budget_read_again(camber_context *context);

/* ---- Files ---- */

/* Whether a style may name this file: it must be inside the context's root. For a file outside, the message is the same
 * whether the file exists or not. */
bool camber_file_is_reached(const camber_context *context, const char *path);
/* Opens a regular file for reading and returns its descriptor and size. Returns CAMBER_ERROR_NOT_FOUND,
 * CAMBER_ERROR_INPUT (a folder, a device or a pipe; a file outside the root), CAMBER_ERROR_ARGUMENT (it is the output),
 * CAMBER_ERROR_IO. */
camber_status camber_file_open(camber_context *context, const char *path, camber_file_naming naming, int *file,
                               uint64_t *size_bytes);
/* Makes the same checks for a file that another library will open by its path. */
camber_status camber_file_check(camber_context *context, const char *path, camber_file_naming naming,
                                uint64_t *size_bytes);
/* Logs why a file cannot be read (cause is an errno), and returns the status for that cause. */
camber_status camber_file_fail(camber_context *context, const char *path, int cause);
/* Reads a whole file and appends a 0. Free *bytes with camber_free. Returns the errors of camber_file_open, and
 * CAMBER_ERROR_MEMORY. */
camber_status camber_read_file(camber_context *context, const char *path, camber_file_naming naming, char **bytes,
                               size_t *size_bytes);
/* Reads a file in a folder by its relative name, and follows no link on the way from the folder to it. Returns
 * CAMBER_ERROR_NOT_FOUND without a message. */
camber_status camber_read_file_below(camber_context *context, const char *folder, const char *name, char **bytes,
                                     size_t *size_bytes);

/* ---- Hashes ---- */

/* A 64-bit FNV-1a hash. Start with CAMBER_HASH_START, and pass the result on to hash further bytes. */
#define CAMBER_HASH_START 14695981039346656037ull
uint64_t camber_hash(uint64_t hash, const void *bytes, size_t size_bytes);

/* A fast hash of 64-bit words for tables in memory. Start with 0, and pass the result on. */
static inline uint64_t camber_mix(uint64_t hash, uint64_t word) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ull;
    return hash ^ hash >> 29;
}

/* Hashes a point by its bits, so that 0 and -0 are two different coordinates. */
static inline uint64_t camber_mix_point(uint64_t hash, const double *point) {
    uint64_t words[2];
    memcpy(words, point, sizeof words);
    return camber_mix(camber_mix(hash, words[0]), words[1]);
}

/* ---- Cache: small files in the user's cache folder, or in the folder that all users of the machine share. A failure
 * to read counts as a miss. ---- */

enum { CAMBER_FOLDER_SIZE = 1024 };

/* Whether this user has a cache folder. */
bool camber_cache_is_on(const camber_context *context);
/* Reads a file of the user's cache. Free *bytes with camber_free. false: a miss. */
bool camber_cache_load(camber_context *context, const char *name, char **bytes, size_t *size_bytes);
/* Reads a file of the shared folder in the same way. */
bool camber_cache_load_shared(camber_context *context, const char *name, char **bytes, size_t *size_bytes);
/* Whether there is a folder that files can be saved to. */
bool camber_cache_can_save(const camber_context *context);
/* Writes a temporary file and renames it, so that readers see the whole file or none. */
bool camber_cache_save(camber_context *context, const char *name, const void *bytes, size_t size_bytes);

/* Switches saving to the shared folder, if this user may write there, or back to the user's own. */
void camber_cache_share(camber_context *context, bool wanted);
/* Writes the folder that files are saved to, and makes it if it is missing. false: there is none. */
bool camber_cache_folder(const camber_context *context, char folder[CAMBER_FOLDER_SIZE]);

/* Locks a key among all processes that save to the same folder. A negative result means that the lock was not free in
 * time, and the process works without it. */
int camber_cache_lock(camber_context *context, uint64_t key, double longest_ms);
void camber_cache_unlock(int lock);

#endif
