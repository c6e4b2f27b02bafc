/* Threads that share the work-items of a launch.
 *
 * Input: a kernel's function, its arguments, and a number of work-items. Main idea: runs of work-items are taken from
 * one counter, by the thread that launches and by those that wait for launches. A launch is open while its thread still
 * finds work; a thread that wakes too late for it waits for the next. So a launch waits only for threads that take
 * part. */
#include "gpu/cpu/pool.h"

#include "base/threads.h"

#include <fenv.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

/* rasterize has the state of a tile on the stack. The usual 8 MB would count against a limit of address space. */
enum { STACK_BYTES = 1 << 20 };

/* While this many runs are left for each thread, runs get smaller: the last ones are single work-items. */
enum { RUNS_LEFT = 4 };

struct camber_cpu_pool {
    camber_context *context;
    size_t wanted;             /* threads besides the one that launches */
    size_t shared, next_start; /* launches so far that had work for others; at which one threads are started */
    pid_t process;             /* which has started them. 0: nobody yet */
    size_t count;              /* threads that run */
    pthread_mutex_t lock;
    pthread_cond_t begins, ends;
    /* These belong to the lock. */
    uint64_t launches; /* how many there were; a thread sleeps while it has seen them all */
    bool is_open;      /* the last launch still has work */
    bool is_over;
    size_t working; /* threads that are taking work-items of the last launch */
    camber_cpu_work work;
    /* This does not. */
    _Atomic size_t next; /* first work-item that nobody has taken */
    pthread_t threads[CAMBER_MOST_THREADS];
};

/* Takes a run of work-items. Returns false if none are left. */
static bool take_run(camber_cpu_pool *pool, size_t count, size_t *first, size_t *end) {
    size_t next = atomic_load_explicit(&pool->next, memory_order_relaxed), size;
    do {
        if (next >= count)
            return false;
        size = (count - next) / (RUNS_LEFT * (pool->wanted + 1));
        size = size ? size : 1;
    } while (!atomic_compare_exchange_weak_explicit(&pool->next, &next, next + size, memory_order_relaxed,
                                                    memory_order_relaxed));
    *first = next;
    *end = next + size;
    return true;
}

static void run_all(camber_cpu_pool *pool, const camber_cpu_work *work) {
    size_t first, end;
    while (take_run(pool, work->count, &first, &end))
        work->run(work->args, first, end, work->count);
}

/* Each thread: waits for a launch, takes part in it, and waits for the next. */
static void *serve(void *user) {
    camber_cpu_pool *pool = user;
    uint64_t seen = 0;
    fesetenv(FE_DFL_ENV); /* threads inherit the rounding of the thread that starts them */
    pthread_mutex_lock(&pool->lock);
    for (;;) {
        while (!pool->is_over && (seen == pool->launches || !pool->is_open))
            pthread_cond_wait(&pool->begins, &pool->lock);
        if (pool->is_over)
            break;
        seen = pool->launches;
        pool->working++;
        const camber_cpu_work work = pool->work;
        pthread_mutex_unlock(&pool->lock);
        run_all(pool, &work);
        pthread_mutex_lock(&pool->lock);
        if (--pool->working == 0)
            pthread_cond_signal(&pool->ends);
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

/* The signals that threads of the pool leave to the caller's own. A fault has to reach the thread that made it: if it
 * is blocked there, the process ends without calling its handler. */
static void choose_signals(sigset_t *signals) {
    static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS};
    sigfillset(signals);
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++)
        sigdelset(signals, faults[i]);
}

/* Starts the threads that are missing. If the system refuses some, launches 2, 4, 8 and so on try again: a limit may
 * have been reached for a moment only, and refusals cost little. */
static void start(camber_cpu_pool *pool) {
    pthread_attr_t attributes;
    sigset_t blocked, before;
    if (pool->count == pool->wanted || ++pool->shared < pool->next_start)
        return;
    pool->next_start = 2 * pool->shared;
    pool->process = getpid();
    if (pthread_attr_init(&attributes) != 0)
        return;
    pthread_attr_setstacksize(&attributes, STACK_BYTES);
    choose_signals(&blocked);
    pthread_sigmask(SIG_SETMASK, &blocked, &before);
    while (pool->count < pool->wanted && pthread_create(&pool->threads[pool->count], &attributes, serve, pool) == 0)
        pool->count++;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    pthread_attr_destroy(&attributes);
}

camber_status camber_cpu_pool_create(camber_context *context, size_t threads, camber_cpu_pool **pool) {
    camber_cpu_pool *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->context = context;
    made->wanted = threads - 1;
    pthread_mutex_init(&made->lock, NULL);
    pthread_cond_init(&made->begins, NULL);
    pthread_cond_init(&made->ends, NULL);
    *pool = made;
    return CAMBER_OK;
}

static void end_threads(camber_cpu_pool *pool) {
    pthread_mutex_lock(&pool->lock);
    pool->is_over = true;
    pthread_cond_broadcast(&pool->begins);
    pthread_mutex_unlock(&pool->lock);
    for (size_t i = 0; i < pool->count; i++)
        pthread_join(pool->threads[i], NULL);
}

/* A forked process has no threads of the pool, and its lock and conditions would wait for them. */
void camber_cpu_pool_destroy(camber_cpu_pool *pool) {
    if (!pool)
        return;
    if (pool->process && pool->process != getpid()) {
        camber_free(pool->context, pool);
        return;
    }
    end_threads(pool);
    pthread_cond_destroy(&pool->ends);
    pthread_cond_destroy(&pool->begins);
    pthread_mutex_destroy(&pool->lock);
    camber_free(pool->context, pool);
}

/* Lets the other threads take part in a launch. */
static void open_launch(camber_cpu_pool *pool, const camber_cpu_work *work) {
    pthread_mutex_lock(&pool->lock);
    atomic_store_explicit(&pool->next, 0, memory_order_relaxed);
    pool->work = *work;
    pool->launches++;
    pool->is_open = true;
    pthread_cond_broadcast(&pool->begins);
    pthread_mutex_unlock(&pool->lock);
}

/* Waits for those that take part. Nobody begins to any more. */
static void close_launch(camber_cpu_pool *pool) {
    pthread_mutex_lock(&pool->lock);
    pool->is_open = false;
    while (pool->working > 0)
        pthread_cond_wait(&pool->ends, &pool->lock);
    pthread_mutex_unlock(&pool->lock);
}

void camber_cpu_pool_run(camber_cpu_pool *pool, const camber_cpu_work *work) {
    fenv_t rounding;
    const bool shares = work->count > 1 && pool->wanted > 0;
    fegetenv(&rounding);
    fesetenv(FE_DFL_ENV); /* whatever the caller's rounding is, the bytes are the same */
    if (shares)
        start(pool);
    if (shares && pool->count > 0) {
        open_launch(pool, work);
        run_all(pool, work);
        close_launch(pool);
    } else {
        work->run(work->args, 0, work->count, work->count);
    }
    fesetenv(&rounding);
}
