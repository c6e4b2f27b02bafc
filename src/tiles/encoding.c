/* A bounded queue of pictures, which threads encode while the next picture is drawn. Pictures leave it in the order in
 * which they came. Threads take tiles, not whole pictures, so that all of them help with the last picture. */
#define _XOPEN_SOURCE 700

#include "tiles/encoding.h"

#include "tiles/mesh_area.h"

#include <sched.h>
#include <sys/resource.h>

enum { MOST_JOBS = 8 };

struct camber_encode_queue {
    camber_workers *workers;
    camber_encoder **encoders; /* one per worker; all NULL if tiles are meshes */
    camber_mesh_tile *meshes;  /* one per worker */
    camber_threads threads;    /* none if there is only one worker: then the caller encodes */
    camber_encode_job jobs[MOST_JOBS];
    size_t job_count;
    uint64_t put, taken; /* how many jobs were put and taken; job n is jobs[n % job_count] */
    bool stops;
    camber_encode_times times;
    pthread_mutex_t mutex;
    pthread_cond_t work, done;
};

/* ---- One tile ---- */

static bool is_background(const camber_pixels *pixels, const uint8_t background[4]) {
    uint32_t color;
    memcpy(&color, background, sizeof color);
    for (size_t y = 0; y < pixels->height; y++) {
        const uint8_t *row = pixels->rgba + pixels->stride_bytes * y;
        uint32_t differs = 0;
        for (size_t x = 0; x < pixels->width; x++) {
            uint32_t pixel;
            memcpy(&pixel, row + 4 * x, sizeof pixel);
            differs |= pixel ^ color;
        }
        if (differs)
            return false;
    }
    return true;
}

/* Encodes the lines of a tile. The tile gets no bytes if no line comes near it. */
static camber_status encode_mesh(camber_encode_queue *queue, size_t number, camber_encode_job *job, unsigned tile) {
    const camber_tiles_picture *picture = &job->picture;
    camber_encoded_tile *made = job->tiles + tile;
    camber_mesh_tile *mesh = queue->meshes + number;
    camber_context *context = queue->workers->contexts[number];
    const uint32_t x = tile % picture->side, y = tile / picture->side;
    const camber_mesh_place place = {picture->zoom, picture->column + x, picture->row + y, job->ratio};
    camber_status status = camber_mesh_tile_cut(context, &job->lines, picture->tile_px, x, y, mesh);
    if (status == CAMBER_OK)
        status = camber_mesh_tile_fill(&job->lines, x, y, mesh);
    made->size_bytes = 0;
    if (status != CAMBER_OK || (!mesh->segments && !mesh->index_count))
        return status;
    camber_free(context, made->bytes);
    made->bytes = NULL;
    made->capacity = 0;
    status = camber_mesh_tile_encode(mesh, job->lines.plan, &place, &made->bytes, &made->size_bytes);
    made->capacity = made->size_bytes;
    return status;
}

static camber_status encode_tile(camber_encode_queue *queue, size_t number, camber_encode_job *job, unsigned tile) {
    camber_encoded_tile *made = job->tiles + tile;
    const uint8_t *bytes = NULL;
    size_t size_bytes = 0;
    camber_pixels pixels;
    if (job->lines.plan)
        return encode_mesh(queue, number, job, tile);
    camber_tiles_picture_get_tile(&job->picture, tile % job->picture.side, tile / job->picture.side, &pixels);
    made->size_bytes = 0;
    if (job->drops_background && is_background(&pixels, job->background))
        return CAMBER_OK;
    const camber_status status = camber_encoder_encode(queue->encoders[number], &pixels, &bytes, &size_bytes);
    if (status != CAMBER_OK)
        return status;
    if (!camber_grow(queue->workers->contexts[number], &made->bytes, &made->capacity, size_bytes, 1))
        return CAMBER_ERROR_MEMORY;
    memcpy(made->bytes, bytes, size_bytes);
    made->size_bytes = size_bytes;
    return CAMBER_OK;
}

/* ---- Threads ---- */

/* Returns the oldest job with tiles that no thread has taken; NULL if there is none. */
static camber_encode_job *find_waiting(camber_encode_queue *queue) {
    for (uint64_t n = queue->taken; n < queue->put; n++)
        if (queue->jobs[n % queue->job_count].waiting)
            return &queue->jobs[n % queue->job_count];
    return NULL;
}

static unsigned first_tile(uint64_t tiles) {
    unsigned tile = 0;
    while (!(tiles >> tile & 1))
        tile++;
    return tile;
}

/* Encodes one tile of the job. The mutex is held at the start and at the end, and released while the tile is
 * encoded. */
static void work_on(camber_encode_queue *queue, size_t number, camber_encode_job *job) {
    const unsigned tile = first_tile(job->waiting);
    job->waiting &= job->waiting - 1;
    pthread_mutex_unlock(&queue->mutex);
    const double start_ms = camber_now_ms();
    const camber_status status = encode_tile(queue, number, job, tile);
    const double wall_ms = camber_now_ms() - start_ms;
    pthread_mutex_lock(&queue->mutex);
    queue->times.wall_ms += wall_ms;
    queue->times.tiles += job->tiles[tile].size_bytes > 0;
    queue->times.bytes += job->tiles[tile].size_bytes;
    if (status != CAMBER_OK && job->status == CAMBER_OK) {
        job->status = status;
        job->failed = number;
    }
    if (--job->left == 0)
        pthread_cond_broadcast(&queue->done);
}

/* Lowers the thread's priority below that of the threads that draw, so that encoders wait for pictures only if nothing
 * is left to encode. */
static void give_way(void) {
    struct sched_param param;
    int policy;
    if (pthread_getschedparam(pthread_self(), &policy, &param) != 0)
        return;
    if (policy == SCHED_OTHER) {
#ifdef __linux__
        /* on Linux this applies only to the calling thread */
        (void)setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + 5);
#endif
    } else if (param.sched_priority > sched_get_priority_min(policy)) {
        param.sched_priority--;
        (void)pthread_setschedparam(pthread_self(), policy, &param);
    }
}

static void run_thread(void *user, size_t number) {
    camber_encode_queue *queue = user;
    give_way();
    pthread_mutex_lock(&queue->mutex);
    while (!queue->stops) {
        camber_encode_job *job = find_waiting(queue);
        if (job)
            work_on(queue, number, job);
        else
            pthread_cond_wait(&queue->work, &queue->mutex);
    }
    pthread_mutex_unlock(&queue->mutex);
}

/* ---- The queue ---- */

static camber_status make_encoders(camber_encode_queue *queue, const camber_encoder_desc *desc) {
    for (size_t i = 0; i < queue->workers->count && desc; i++) {
        const camber_status status = camber_encoder_create(queue->workers->contexts[i], desc, &queue->encoders[i]);
        if (status != CAMBER_OK)
            return camber_workers_tell(queue->workers, i, status);
    }
    return CAMBER_OK;
}

/* Allocates memory for a picture, aligned so that kernels can write to it directly. */
static bool make_place(camber_context *context, size_t picture_bytes, camber_encode_job *job) {
    const size_t step = CAMBER_PIXELS_ALIGNMENT;
    job->block = camber_alloc(context, picture_bytes + step - 1, 1);
    if (job->block)
        job->rgba = job->block + (step - (uintptr_t)job->block % step) % step;
    return job->block != NULL;
}

camber_status camber_encode_queue_create(camber_workers *workers, const camber_encoder_desc *desc, size_t picture_bytes,
                                         camber_encode_queue **queue) {
    camber_context *context = workers->context;
    camber_encode_queue *made = camber_alloc_zero(context, 1, sizeof *made);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    made->workers = workers;
    pthread_mutex_init(&made->mutex, NULL);
    pthread_cond_init(&made->work, NULL);
    pthread_cond_init(&made->done, NULL);
    camber_status status = CAMBER_ERROR_MEMORY;
    const size_t jobs = workers->count == 1 ? 1 : 2 + (workers->count + 7) / 8;
    if (!(made->encoders = camber_alloc_zero(context, workers->count, sizeof(camber_encoder *))) ||
        !(made->meshes = camber_alloc_zero(context, workers->count, sizeof *made->meshes)))
        goto done;
    for (made->job_count = 0; made->job_count < jobs && made->job_count < MOST_JOBS; made->job_count++)
        if (!make_place(context, picture_bytes, &made->jobs[made->job_count]))
            goto done;
    status = make_encoders(made, desc);
done:
    if (status != CAMBER_OK) {
        camber_encode_queue_destroy(made);
        return status;
    }
    if (workers->count > 1)
        camber_threads_start(&made->threads, workers->count, run_thread, made);
    *queue = made;
    return CAMBER_OK;
}

void camber_encode_queue_destroy(camber_encode_queue *queue) {
    if (!queue)
        return;
    camber_context *context = queue->workers->context;
    pthread_mutex_lock(&queue->mutex);
    queue->stops = true;
    pthread_cond_broadcast(&queue->work);
    pthread_mutex_unlock(&queue->mutex);
    camber_threads_join(&queue->threads);
    for (size_t i = 0; queue->encoders && i < queue->workers->count; i++)
        camber_encoder_destroy(queue->encoders[i]);
    for (size_t i = 0; queue->meshes && i < queue->workers->count; i++)
        camber_mesh_tile_free(queue->meshes + i);
    for (size_t i = 0; i < MOST_JOBS; i++) {
        for (size_t k = 0; k < 64; k++)
            camber_free(queue->workers->contexts[0], queue->jobs[i].tiles[k].bytes); /* any context may free them */
        camber_mesh_picture_free(&queue->jobs[i].lines);
        camber_free(context, queue->jobs[i].block);
    }
    pthread_cond_destroy(&queue->done);
    pthread_cond_destroy(&queue->work);
    pthread_mutex_destroy(&queue->mutex);
    camber_free(context, queue->encoders);
    camber_free(context, queue->meshes);
    camber_free(context, queue);
}

camber_encode_job *camber_encode_queue_get_free(camber_encode_queue *queue) {
    return queue->put - queue->taken < queue->job_count ? &queue->jobs[queue->put % queue->job_count] : NULL;
}

void camber_encode_queue_put(camber_encode_queue *queue, camber_encode_job *job) {
    pthread_mutex_lock(&queue->mutex);
    job->status = CAMBER_OK;
    job->waiting = job->wanted;
    job->left = 0;
    for (uint64_t rest = job->wanted; rest; rest &= rest - 1)
        job->left++;
    queue->put++;
    pthread_cond_broadcast(&queue->work);
    const double start_ms = camber_clock_ms(CLOCK_THREAD_CPUTIME_ID);
    while (queue->threads.count == 0 && job->waiting)
        work_on(queue, 0, job);
    queue->times.cpu_ms += queue->threads.count == 0 ? camber_clock_ms(CLOCK_THREAD_CPUTIME_ID) - start_ms : 0.0;
    pthread_mutex_unlock(&queue->mutex);
}

camber_encode_job *camber_encode_queue_take(camber_encode_queue *queue, bool waits) {
    if (queue->taken == queue->put)
        return NULL;
    camber_encode_job *job = &queue->jobs[queue->taken % queue->job_count];
    pthread_mutex_lock(&queue->mutex);
    while (waits && job->left)
        pthread_cond_wait(&queue->done, &queue->mutex);
    const bool ready = job->left == 0;
    pthread_mutex_unlock(&queue->mutex);
    if (ready && job->status != CAMBER_OK)
        (void)camber_workers_tell(queue->workers, job->failed, job->status);
    return ready ? job : NULL;
}

void camber_encode_queue_release(camber_encode_queue *queue, camber_encode_job *job) {
    camber_mesh_picture_free(&job->lines);
    pthread_mutex_lock(&queue->mutex);
    queue->taken++;
    pthread_mutex_unlock(&queue->mutex);
}

bool camber_encode_queue_is_busy(const camber_encode_queue *queue) {
    return queue->taken < queue->put;
}

camber_encode_times camber_encode_queue_get_times(camber_encode_queue *queue) {
    pthread_mutex_lock(&queue->mutex);
    camber_encode_times times = queue->times;
    pthread_mutex_unlock(&queue->mutex);
    for (size_t i = 0; i < queue->threads.count; i++) {
        clockid_t clock;
        if (pthread_getcpuclockid(queue->threads.threads[i].id, &clock) == 0)
            times.cpu_ms += camber_clock_ms(clock);
    }
    return times;
}
