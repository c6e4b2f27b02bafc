#include "validate/picture_error.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

enum { SHARE_ROWS = 32, THREADS_MAX = 64 };

typedef struct crew {
    const camber_picture_error_desc *desc;
    int shares;
    atomic_int next, done;
    atomic_bool failed;
} crew;

/* Shares are taken one after the other, whoever comes first: what is in them differs a lot. */
typedef struct worker {
    crew *crew;
    pthread_t thread;
    bool leads; /* the calling thread, which tells the progress */
    camber_difference differences[CAMBER_PICTURES_MAX];
} worker;

/* The first pixel of the picture that differs most, whichever thread has met it. */
static void add(camber_difference *sum, const camber_difference *more) {
    const bool first = more->max > sum->max || (more->max == sum->max && more->max_at < sum->max_at);
    sum->max_at = first ? more->max_at : sum->max_at;
    camber_difference_add(sum, more);
}

static bool measure_share(worker *w, int share, float *coverage) {
    const camber_picture_error_desc *desc = w->crew->desc;
    const int y0 = share * SHARE_ROWS, height = desc->height - y0 < SHARE_ROWS ? desc->height - y0 : SHARE_ROWS;
    const camber_window window = {0, y0, desc->width, height};
    const size_t first = (size_t)y0 * (size_t)desc->width, count = (size_t)height * (size_t)desc->width;
    if (!camber_truth_make(&desc->truth, window, coverage))
        return false;
    for (size_t i = 0; i < desc->picture_count; i++) {
        camber_difference d = camber_difference_of(coverage, desc->pictures[i] + first, count);
        d.max_at += first;
        add(&w->differences[i], &d);
    }
    return true;
}

static void *work(void *user) {
    worker *w = user;
    crew *c = w->crew;
    float *coverage = malloc((size_t)c->desc->width * SHARE_ROWS * sizeof *coverage);
    if (!coverage)
        atomic_store(&c->failed, true);
    for (int share; !atomic_load(&c->failed) && (share = atomic_fetch_add(&c->next, 1)) < c->shares;) {
        if (!measure_share(w, share, coverage))
            atomic_store(&c->failed, true);
        const int done = atomic_fetch_add(&c->done, 1) + 1;
        if (w->leads && c->desc->progress)
            c->desc->progress(c->desc->user, (double)done / c->shares);
    }
    free(coverage);
    return NULL;
}

static int threads_of(const camber_picture_error_desc *desc, int shares) {
    const long cores = desc->threads ? (long)desc->threads : sysconf(_SC_NPROCESSORS_ONLN);
    const long least = cores < shares ? cores : shares;
    return least < 1 ? 1 : least > THREADS_MAX ? THREADS_MAX : (int)least;
}

bool camber_picture_errors_measure(const camber_picture_error_desc *desc, camber_difference *differences) {
    crew c = {.desc = desc, .shares = (desc->height + SHARE_ROWS - 1) / SHARE_ROWS};
    worker workers[THREADS_MAX] = {{.crew = &c, .leads = true}};
    const int wanted = threads_of(desc, c.shares);
    int made = 1;
    for (; made < wanted; made++) {
        workers[made].crew = &c;
        if (pthread_create(&workers[made].thread, NULL, work, &workers[made]) != 0)
            break; /* fewer do as well */
    }
    work(&workers[0]);
    for (int i = 1; i < made; i++)
        pthread_join(workers[i].thread, NULL);
    for (size_t i = 0; i < desc->picture_count; i++) {
        differences[i] = (camber_difference){0};
        for (int k = 0; k < made; k++)
            add(&differences[i], &workers[k].differences[i]);
    }
    return !atomic_load(&c.failed);
}
