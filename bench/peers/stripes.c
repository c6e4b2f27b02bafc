/* Threads that draw a picture by stripes, and are kept from frame to frame as camber's are. Neither these nor camber's
 * are bound to cores. */
#define _GNU_SOURCE /* sched_getaffinity */

#include "peers/peer.h"

#include "base/base.h"

#include <pthread.h>
#include <sched.h>

enum { THREADS_MAX = 64 };

static struct crew {
    pthread_mutex_t lock;
    pthread_cond_t begins, ends;
    pthread_t threads[THREADS_MAX];
    size_t started;        /* threads beside the caller */
    uint64_t frames;       /* that have begun */
    size_t drawing;        /* threads that have not ended the last one */
    bool done;             /* none has failed in it */
    bench_stripe_fn *draw; /* of the last one */
    void *user;
} crew = {.lock = PTHREAD_MUTEX_INITIALIZER, .begins = PTHREAD_COND_INITIALIZER, .ends = PTHREAD_COND_INITIALIZER};

size_t bench_stripe_count(void) {
    cpu_set_t allowed;
    const int count = sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : 1;
    return (size_t)(count > THREADS_MAX ? THREADS_MAX : count);
}

int bench_stripe_first_row(size_t part) {
    return (int)(BENCH_SIDE_PX * part / bench_stripe_count());
}

static void *serve(void *user) {
    const size_t part = *(const size_t *)user;
    for (uint64_t seen = 0;;) {
        pthread_mutex_lock(&crew.lock);
        while (crew.frames == seen)
            pthread_cond_wait(&crew.begins, &crew.lock);
        seen = crew.frames;
        pthread_mutex_unlock(&crew.lock);
        const bool done = crew.draw(crew.user, part);
        pthread_mutex_lock(&crew.lock);
        crew.done = crew.done && done;
        if (--crew.drawing == 0)
            pthread_cond_signal(&crew.ends);
        pthread_mutex_unlock(&crew.lock);
    }
    return NULL;
}

/* They end with the process. */
static bool start_threads(void) {
    static size_t parts[THREADS_MAX];
    while (crew.started + 1 < bench_stripe_count()) {
        parts[crew.started] = crew.started + 1;
        if (pthread_create(&crew.threads[crew.started], NULL, serve, &parts[crew.started]) != 0)
            return false;
        crew.started++;
    }
    return true;
}

double bench_stripes_draw(bench_stripe_fn *draw, void *user) {
    if (crew.frames == 0 && !start_threads())
        return -1;
    const double begin = camber_now_ms();
    pthread_mutex_lock(&crew.lock);
    crew.draw = draw;
    crew.user = user;
    crew.done = true;
    crew.drawing = crew.started;
    crew.frames++;
    pthread_cond_broadcast(&crew.begins);
    pthread_mutex_unlock(&crew.lock);
    const bool done = draw(user, 0);
    pthread_mutex_lock(&crew.lock);
    while (crew.drawing > 0)
        pthread_cond_wait(&crew.ends, &crew.lock);
    const bool all = done && crew.done;
    pthread_mutex_unlock(&crew.lock);
    return all ? camber_now_ms() - begin : -1;
}
