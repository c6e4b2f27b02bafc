/* How fast the memory is: memcpy on as many threads as the kernels run on, each on a core of its own. Devices with
 * memory of their own copy from buffer to buffer instead. */
#define _GNU_SOURCE /* pthread_setaffinity_np */

#include "bench.h"

#include "base/base.h"
#include "gpu/opencl/opencl.h"
#include "residency/mesh.h"

#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>

/* Each thread copies its part of the block REPEATS times, which outweighs its start. */
enum { THREADS_MAX = 64, BLOCK_BYTES = 16 << 20, DEVICE_BLOCK_BYTES = 256 << 20, REPEATS = 20, RUNS = 5 };
/* Where the two blocks lie within a page, so that loads do not wait for stores of the same low address bits. */
enum { PAGE_BYTES = 4096, APART_BYTES = 2048 };

typedef struct share {
    uint8_t *to;
    const uint8_t *from;
    size_t size_bytes;
    size_t core;
} share;

static void *copy(void *argument) {
    const share *s = argument;
    cpu_set_t core;
    CPU_ZERO(&core);
    CPU_SET(s->core, &core);
    pthread_setaffinity_np(pthread_self(), sizeof core, &core);
    for (int i = 0; i < REPEATS; i++)
        memcpy(s->to, s->from, s->size_bytes);
    return NULL;
}

static double run(share *shares, int count) {
    pthread_t threads[THREADS_MAX];
    int started = 0;
    const double begin = camber_now_ms();
    while (started < count && pthread_create(threads + started, NULL, copy, shares + started) == 0)
        started++;
    for (int i = 0; i < started; i++)
        pthread_join(threads[i], NULL);
    return started == count ? (camber_now_ms() - begin) / REPEATS : 0;
}

/* Up to the device's units, the cores that this process may run on. */
static int find_cores(const bench *b, size_t cores[THREADS_MAX]) {
    const int wanted = (int)camber_device_get_info(b->device).compute_units;
    cpu_set_t allowed;
    int count = 0;
    if (sched_getaffinity(0, sizeof allowed, &allowed) != 0)
        return 0;
    for (size_t i = 0; i < CPU_SETSIZE && count < wanted && count < THREADS_MAX; i++)
        if (CPU_ISSET(i, &allowed))
            cores[count++] = i;
    return count;
}

static double copy_on_host(const bench *b) {
    size_t cores[THREADS_MAX];
    const int count = find_cores(b, cores);
    const size_t each = count > 0 ? (BLOCK_BYTES / (size_t)count / PAGE_BYTES + 1) * PAGE_BYTES : 0;
    const size_t all = each * (size_t)count;
    uint8_t *from = aligned_alloc(PAGE_BYTES, all + PAGE_BYTES), *to = aligned_alloc(PAGE_BYTES, all + PAGE_BYTES);
    double best = 0;
    if (from && to && all > 0) {
        share shares[THREADS_MAX];
        memset(from, 1, all); /* pages that nothing wrote to are all one */
        memset(to, 2, all + PAGE_BYTES);
        for (int i = 0; i < count; i++)
            shares[i] = (share){to + APART_BYTES + (size_t)i * each, from + (size_t)i * each, each, cores[i]};
        for (int i = 0; i < RUNS; i++) {
            const double ms = run(shares, count);
            best = ms > 0 ? fmax(best, 2 * (double)all / ms / 1e6) : best;
        }
    }
    free(to);
    free(from);
    return best;
}

/* Wall time: a copy's event may begin before it does. */
static double copy_on_device(const bench *b) {
    cl_command_queue queue = opencl_of(b->device)->queue;
    const size_t size_bytes = DEVICE_BLOCK_BYTES;
    cl_int code = CL_SUCCESS;
    cl_mem from = camber_cl.CreateBuffer(opencl_of(b->device)->cl, CL_MEM_READ_WRITE, size_bytes, NULL, &code);
    cl_mem to = code == CL_SUCCESS
                    ? camber_cl.CreateBuffer(opencl_of(b->device)->cl, CL_MEM_READ_WRITE, size_bytes, NULL, &code)
                    : NULL;
    double best = 0;
    for (int i = 0; i < RUNS && code == CL_SUCCESS; i++) {
        code = camber_cl.Finish(queue);
        const double begin = camber_now_ms();
        for (int k = 0; k < REPEATS && code == CL_SUCCESS; k++)
            code = camber_cl.EnqueueCopyBuffer(queue, from, to, 0, 0, size_bytes, 0, NULL, NULL);
        if (code == CL_SUCCESS)
            code = camber_cl.Finish(queue);
        const double ms = camber_now_ms() - begin;
        if (code == CL_SUCCESS && i > 0) /* the first makes the buffers */
            best = fmax(best, 2.0 * REPEATS * (double)size_bytes / ms / 1e6);
    }
    if (to)
        camber_cl.ReleaseMemObject(to);
    if (from)
        camber_cl.ReleaseMemObject(from);
    return best;
}

double bench_copy_gb_s(const bench *b) {
    return b->device->host_memory ? copy_on_host(b) : copy_on_device(b);
}
