#include "validate/picture_error.h"

#include "base/threads.h"

#include <stdatomic.h>
#include <stdlib.h>

enum { SHARE_ROWS = 32 };

/* Threads take the next share when they are free, because shares differ a lot in cost. */
typedef struct crew {
    const camber_picture_error_desc *desc;
    int shares;
    atomic_int next, done;
    atomic_bool failed;
    camber_difference differences[CAMBER_MOST_THREADS][CAMBER_PICTURES_MAX]; /* one row per thread */
} crew;

/* Adds a difference, and keeps the first pixel of the picture with the largest error, whichever thread has found it. */
static void add(camber_difference *sum, const camber_difference *more) {
    const bool first = more->max > sum->max || (more->max == sum->max && more->max_at < sum->max_at);
    sum->max_at = first ? more->max_at : sum->max_at;
    camber_difference_add(sum, more);
}

static bool measure_share(const camber_picture_error_desc *desc, int share, float *coverage,
                          camber_difference *differences) {
    const int y0 = share * SHARE_ROWS, height = desc->height - y0 < SHARE_ROWS ? desc->height - y0 : SHARE_ROWS;
    const camber_window window = {0, y0, desc->width, height};
    const size_t first = (size_t)y0 * (size_t)desc->width, count = (size_t)height * (size_t)desc->width;
    if (!camber_truth_make(&desc->truth, window, coverage))
        return false;
    for (size_t i = 0; i < desc->picture_count; i++) {
        camber_difference d = camber_difference_of(coverage, desc->pictures[i] + first, count);
        d.max_at += first;
        add(&differences[i], &d);
    }
    return true;
}

static void work(void *user, size_t number) {
    crew *c = user;
    float *coverage = malloc((size_t)c->desc->width * SHARE_ROWS * sizeof *coverage);
    if (!coverage)
        atomic_store(&c->failed, true);
    for (int share; !atomic_load(&c->failed) && (share = atomic_fetch_add(&c->next, 1)) < c->shares;) {
        if (!measure_share(c->desc, share, coverage, c->differences[number]))
            atomic_store(&c->failed, true);
        const int done = atomic_fetch_add(&c->done, 1) + 1;
        if (number == 0 && c->desc->progress) /* only the calling thread reports progress */
            c->desc->progress(c->desc->user, (double)done / c->shares);
    }
    free(coverage);
}

bool camber_picture_errors_measure(const camber_picture_error_desc *desc, camber_difference *differences) {
    crew c = {.desc = desc, .shares = (desc->height + SHARE_ROWS - 1) / SHARE_ROWS};
    const size_t most = camber_threads_count(desc->threads),
                 threads = most < (size_t)c.shares ? most : (size_t)c.shares;
    camber_threads_run(threads, work, &c);
    for (size_t i = 0; i < desc->picture_count; i++) {
        differences[i] = (camber_difference){0};
        for (size_t k = 0; k < threads; k++)
            add(&differences[i], &c.differences[k][i]);
    }
    return !atomic_load(&c.failed);
}
