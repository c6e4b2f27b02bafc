/* What every layer needs: memory through the context's allocator, the log, text, files, clock. */
#ifndef CAMBER_BASE_H
#define CAMBER_BASE_H

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
    camber_budget_desc desc; /* what is 0 stands as it is meant, but for memory_bytes */
    _Atomic uint64_t held_bytes, most_bytes;
};

/* Of a budget, by the set of features that is read. */
typedef struct camber_spent {
    uint64_t tiles, steps, file_bytes, unfolded_bytes;
} camber_spent;

struct camber_context {
    camber_context_desc desc;
    camber_budget *budget;
    camber_budget own_budget;
    camber_spent spent;
    uint64_t next_serial; /* identifies polylines to meshes that keep them uploaded */
    const void *gdal;     /* load/gdal.c: what it found, NULL before */
    bool saves_shared;    /* cache.c: files are saved for all users of the machine */
};

/* Memory is not cleared by camber_alloc; camber_alloc_zero clears it. NULL and a logged error on failure, also
 * where count * size overflows. count 0 gives a block that can be freed. */
void *camber_alloc(camber_context *context, size_t count, size_t size_bytes);
void *camber_alloc_zero(camber_context *context, size_t count, size_t size_bytes);
/* Grows *capacity (elements) so that at least needed fit, by half or more. The block may move. false on
 * failure, and then the old block stays. items is the address of a pointer to elements. */
bool camber_grow(camber_context *context, void *items, size_t *capacity, size_t needed, size_t size_bytes);
void camber_free(camber_context *context, void *block);
/* Without a word; block may be NULL. NULL: there is no room, and the block is as it was. */
void *camber_resize_quietly(camber_context *context, void *block, size_t size_bytes);
char *camber_copy_string(camber_context *context, const char *text);

void camber_log(camber_context *context, camber_log_level level, const char *format, ...) CAMBER_PRINTF(3, 4);
/* Logs an error and returns status, so that a failure is one line: return camber_fail(...). */
camber_status camber_fail(camber_context *context, camber_status status, const char *format, ...) CAMBER_PRINTF(3, 4);
/* Errors become information until the log is restored: those of an attempt that something else stands in for. */
typedef struct camber_soft_log {
    camber_log_fn *log;
    void *user;
} camber_soft_log;
void camber_log_soften(camber_context *context, camber_soft_log *kept);
void camber_log_restore(camber_context *context, const camber_soft_log *kept);
void camber_progress(camber_context *context, const char *stage, double fraction);

/* Milliseconds of a monotonic clock. */
double camber_now_ms(void);

/* Who names a file that is read: the caller, or a style, which reaches no farther than the context's access has it. */
typedef enum camber_file_naming {
    CAMBER_NAMED_BY_CALLER = 0,
    CAMBER_NAMED_BY_STYLE,
} camber_file_naming;

/* ---- Budget ---- */

void camber_budget_init(camber_budget *budget, const camber_budget_desc *desc);
/* Of memory that is not the allocator's, too. false: it is not allowed, and camber_budget_fail says so. */
bool camber_budget_take(camber_context *context, uint64_t size_bytes);
void camber_budget_give(camber_context *context, uint64_t size_bytes);
bool camber_budget_has(const camber_context *context, uint64_t size_bytes);
camber_status camber_budget_fail(camber_context *context, uint64_t size_bytes);
/* Whether the process may have what drivers need. Returns CAMBER_ERROR_MEMORY. */
camber_status camber_budget_check_drivers(camber_context *context);
/* A set of features begins. */
void camber_budget_begin(camber_context *context);
/* name stands in messages. */
camber_status camber_budget_take_tiles(camber_context *context, const char *name, uint64_t count);
/* false: a database has had as many as it may. */
bool camber_budget_take_steps(camber_context *context, uint64_t count);
/* A file of tiles is read, which has so many bytes. */
void camber_budget_open(camber_context *context, uint64_t file_bytes);
/* So many bytes came out of a tile; and how many may still come. */
camber_status camber_budget_unfold(camber_context *context, const char *name, uint64_t size_bytes);
uint64_t camber_budget_unfolds(const camber_context *context);
/* The same tiles once more. */
void camber_budget_read_again(camber_context *context);

/* ---- Files ---- */

/* Whether a style may name it: it lies within the context's root, or would. What lies beyond, is there or not, is told
 * of in one way only. */
bool camber_file_is_reached(const camber_context *context, const char *path);
/* Opens a file to read, and tells its size. Returns CAMBER_ERROR_NOT_FOUND, CAMBER_ERROR_INPUT (a folder, a device or
 * a pipe; one that lies beyond the root), CAMBER_ERROR_ARGUMENT (the output), CAMBER_ERROR_IO. */
camber_status camber_file_open(camber_context *context, const char *path, camber_file_naming naming, int *file,
                               uint64_t *size_bytes);
/* The same of what another library opens by its path. */
camber_status camber_file_check(camber_context *context, const char *path, camber_file_naming naming,
                                uint64_t *size_bytes);
/* Logs why a file cannot be read, by its errno, and gives the status it stands for. */
camber_status camber_file_fail(camber_context *context, const char *path, int cause);
/* Reads a whole file; *bytes is freed with camber_free and has a 0 behind its end. Returns what camber_file_open does,
 * and CAMBER_ERROR_MEMORY. */
camber_status camber_read_file(camber_context *context, const char *path, camber_file_naming naming, char **bytes,
                               size_t *size_bytes);

/* ---- Hashes ---- */

/* A 64-bit FNV-1a hash, to be chained from CAMBER_HASH_START. */
#define CAMBER_HASH_START 14695981039346656037ull
uint64_t camber_hash(uint64_t hash, const void *bytes, size_t size_bytes);

/* A fast hash of words, for tables in memory: chained from 0. */
static inline uint64_t camber_mix(uint64_t hash, uint64_t word) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ull;
    return hash ^ hash >> 29;
}

/* Of a point's bits: equal coordinates that differ in the sign of a zero are two points. */
static inline uint64_t camber_mix_point(uint64_t hash, const double *point) {
    uint64_t words[2];
    memcpy(words, point, sizeof words);
    return camber_mix(camber_mix(hash, words[0]), words[1]);
}

/* ---- Cache: small files by name in the user's cache folder, or in the one that the machine's users share. Every
 * failure is a miss. ---- */

enum { CAMBER_FOLDER_SIZE = 1024 };

/* Whether the context has a cache folder of its user at all. */
bool camber_cache_is_on(const camber_context *context);
/* *bytes is freed with camber_free. */
bool camber_cache_load(camber_context *context, const char *name, char **bytes, size_t *size_bytes);
/* From the shared folder. */
bool camber_cache_load_shared(camber_context *context, const char *name, char **bytes, size_t *size_bytes);
/* Written beside and renamed: readers see a whole file or none. */
bool camber_cache_save(camber_context *context, const char *name, const void *bytes, size_t size_bytes);

/* Whether what is saved goes to the shared folder from now on, where this user may write there. */
void camber_cache_share(camber_context *context, bool wanted);
/* Where files are saved, made where it is missing; false: nowhere. */
bool camber_cache_folder(const camber_context *context, char folder[CAMBER_FOLDER_SIZE]);

/* Of all processes that save where this one does, one at a time has the lock of a key. Below 0: none is to be had, or
 * not within the time, and each works for itself. */
int camber_cache_lock(camber_context *context, uint64_t key, double longest_ms);
void camber_cache_unlock(int lock);

#endif
