/* Runs a pass: threads process parts in order, and the caller's thread commits the results in the same order.
 *
 * Input: the number of parts, and the functions that process a part and commit it. Output: committed results. A ring of
 * slots limits how far the threads may run ahead of the commits, and so limits memory. The caller's thread works, too,
 * while it has nothing to commit. A context may be used by only one thread at a time, so a lock protects it: commits
 * hold the lock, and so does code that grows a worker's block. */
#include "osm/pass.h"

#include "base/threads.h"

#include <stdarg.h>
#include <stdio.h>

/* Slots per thread: enough that a large part does not delay other threads. */
enum { SLOTS_A_THREAD = 4, MOST_THREADS = 64 };

static const double PROGRESS_MS = 50;

typedef struct slot_state {
    bool ready;
    bool failed;
    camber_osm_failure failure;
} slot_state;

struct camber_osm_pass {
    const camber_osm_pass_desc *desc;
    pthread_mutex_t context_lock;
    pthread_mutex_t lock; /* protects the following fields */
    pthread_cond_t moved;
    size_t taken, committed;
    bool stopped;
    camber_status status;
    bool *declined;
    size_t slot_count;
    slot_state *states;
    char *slots;
};

bool camber_osm_fail(camber_osm_failure *failure, const char *text) {
    failure->status = CAMBER_ERROR_INPUT;
    snprintf(failure->text, sizeof failure->text, "%s", text);
    return false;
}

bool camber_osm_refuse(camber_osm_failure *failure, const char *format, ...) {
    va_list list;
    failure->status = CAMBER_ERROR_INPUT;
    failure->told = true;
    va_start(list, format);
    vsnprintf(failure->text, sizeof failure->text, format, list);
    va_end(list);
    return false;
}

bool camber_osm_decline(camber_osm_failure *failure) {
    failure->declined = true;
    failure->status = CAMBER_ERROR_INPUT;
    return false;
}

bool camber_osm_reserve(camber_osm_pass *pass, camber_osm_block *block, size_t size_bytes,
                        camber_osm_failure *failure) {
    if (size_bytes <= block->capacity)
        return true;
    const size_t wanted = size_bytes + size_bytes / 4;
    pthread_mutex_lock(&pass->context_lock);
    uint8_t *made = camber_resize_quietly(pass->desc->context, block->bytes, wanted);
    pthread_mutex_unlock(&pass->context_lock);
    if (!made) {
        failure->status = CAMBER_ERROR_MEMORY;
        return false;
    }
    block->bytes = made;
    block->capacity = wanted;
    return true;
}

void *camber_osm_allocate(camber_osm_pass *pass, size_t size_bytes) {
    pthread_mutex_lock(&pass->context_lock);
    void *made = camber_resize_quietly(pass->desc->context, NULL, size_bytes);
    pthread_mutex_unlock(&pass->context_lock);
    return made;
}

void camber_osm_release(camber_osm_pass *pass, void *block) {
    pthread_mutex_lock(&pass->context_lock);
    camber_free(pass->desc->context, block);
    pthread_mutex_unlock(&pass->context_lock);
}

/* ---- Taking parts ---- */

/* Takes the next part if the ring has room. Called with the lock held. */
static bool take(camber_osm_pass *pass, size_t *part) {
    if (pass->stopped || pass->taken == pass->desc->part_count || pass->taken - pass->committed >= pass->slot_count)
        return false;
    *part = pass->taken++;
    return true;
}

/* The caller holds the lock, which is released during the work on the part. */
static void work(camber_osm_pass *pass, size_t part) {
    slot_state *state = &pass->states[part % pass->slot_count];
    void *slot = pass->slots + part % pass->slot_count * pass->desc->slot_bytes;
    pthread_mutex_unlock(&pass->lock);
    state->failure = (camber_osm_failure){.status = CAMBER_ERROR_INPUT};
    state->failed = !pass->desc->work(pass->desc->user, pass, part, slot, &state->failure);
    pthread_mutex_lock(&pass->lock);
    state->ready = true;
    pthread_cond_broadcast(&pass->moved);
}

static void run_worker(camber_osm_pass *pass) {
    pthread_mutex_lock(&pass->lock);
    while (!pass->stopped && pass->taken < pass->desc->part_count) {
        size_t part;
        if (take(pass, &part))
            work(pass, part);
        else
            pthread_cond_wait(&pass->moved, &pass->lock);
    }
    pthread_mutex_unlock(&pass->lock);
}

/* ---- The caller's thread ---- */

static camber_status report(const camber_osm_pass *pass, const camber_osm_failure *failure) {
    *pass->declined = failure->declined;
    if (failure->declined)
        return CAMBER_OK;
    if (failure->status == CAMBER_ERROR_MEMORY)
        return camber_fail(pass->desc->context, CAMBER_ERROR_MEMORY,
                           "%s: a part of it needs more memory than is allowed; allow more", pass->desc->name);
    if (failure->told)
        return camber_fail(pass->desc->context, failure->status, "%s: %s", pass->desc->name, failure->text);
    return camber_fail(pass->desc->context, failure->status, "%s: cut off or damaged: %s; get the file again",
                       pass->desc->name, failure->text);
}

/* Called with the lock held. */
static void commit(camber_osm_pass *pass) {
    const size_t part = pass->committed;
    slot_state *state = &pass->states[part % pass->slot_count];
    void *slot = pass->slots + part % pass->slot_count * pass->desc->slot_bytes;
    pthread_mutex_unlock(&pass->lock);
    pthread_mutex_lock(&pass->context_lock);
    if (state->failed)
        pass->status = report(pass, &state->failure);
    else if (pass->desc->commit)
        pass->status = pass->desc->commit(pass->desc->user, part, slot);
    pthread_mutex_unlock(&pass->context_lock);
    pthread_mutex_lock(&pass->lock);
    state->ready = false;
    pass->committed++;
    pass->stopped = pass->status != CAMBER_OK || *pass->declined;
    pthread_cond_broadcast(&pass->moved);
}

/* Tells how much of all passes is done. The count is that share of the blocks, so that it does not begin again with
 * each pass. */
static void show_progress(camber_osm_pass *pass, double *shown_ms) {
    const camber_osm_pass_desc *desc = pass->desc;
    const double now = camber_now_ms(), done = (double)pass->committed / (double)desc->part_count,
                 fraction = desc->from + done * (desc->to - desc->from);
    if (now - *shown_ms < PROGRESS_MS)
        return;
    *shown_ms = now;
    pthread_mutex_lock(&pass->context_lock);
    camber_progress_tell(desc->context, &(camber_progress_info){.stage = "reading",
                                                                .fraction = fraction,
                                                                .unit = "blocks",
                                                                .done = (uint64_t)(fraction * (double)desc->part_count),
                                                                .total = desc->part_count});
    pthread_mutex_unlock(&pass->context_lock);
}

static void run(camber_osm_pass *pass) {
    double shown_ms = 0.0;
    pthread_mutex_lock(&pass->lock);
    while (!pass->stopped && pass->committed < pass->desc->part_count) {
        size_t part;
        if (pass->states[pass->committed % pass->slot_count].ready)
            commit(pass);
        else if (take(pass, &part))
            work(pass, part);
        else
            pthread_cond_wait(&pass->moved, &pass->lock);
        pthread_mutex_unlock(&pass->lock);
        show_progress(pass, &shown_ms);
        pthread_mutex_lock(&pass->lock);
    }
    pass->stopped = true;
    pthread_cond_broadcast(&pass->moved);
    pthread_mutex_unlock(&pass->lock);
}

static void run_thread(void *user, size_t number) {
    if (number == 0)
        run(user);
    else
        run_worker(user);
}

camber_status camber_osm_pass_run(const camber_osm_pass_desc *desc, bool *declined) {
    camber_osm_pass pass = {.desc = desc, .declined = declined};
    unsigned wanted = desc->threads < MOST_THREADS ? desc->threads : MOST_THREADS;
    *declined = false;
    if (desc->part_count == 0)
        return CAMBER_OK;
    wanted = wanted < desc->part_count ? wanted : (unsigned)desc->part_count;
    pass.slot_count = (size_t)SLOTS_A_THREAD * wanted;
    if (!(pass.states = camber_alloc_zero(desc->context, pass.slot_count, sizeof *pass.states)))
        return CAMBER_ERROR_MEMORY;
    if (!(pass.slots = camber_alloc_zero(desc->context, pass.slot_count, desc->slot_bytes))) {
        camber_free(desc->context, pass.states);
        return CAMBER_ERROR_MEMORY;
    }
    pthread_mutex_init(&pass.context_lock, NULL);
    pthread_mutex_init(&pass.lock, NULL);
    pthread_cond_init(&pass.moved, NULL);
    camber_threads_run(wanted, run_thread, &pass);
    pthread_cond_destroy(&pass.moved);
    pthread_mutex_destroy(&pass.lock);
    pthread_mutex_destroy(&pass.context_lock);
    for (size_t i = 0; i < pass.slot_count; i++)
        desc->free_slot(desc->context, pass.slots + i * desc->slot_bytes);
    camber_free(desc->context, pass.slots);
    camber_free(desc->context, pass.states);
    return pass.status;
}
