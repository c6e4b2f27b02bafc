/* A bounded queue of pictures, which threads cut into tiles and encode while the next picture is drawn. */
#ifndef CAMBER_TILES_ENCODING_H
#define CAMBER_TILES_ENCODING_H

#include "camber_tiles.h"
#include "tiles/mesh_tile.h"
#include "tiles/workers.h"

typedef struct camber_encoded_tile {
    uint8_t *bytes;
    size_t size_bytes, capacity; /* 0 bytes: the tile shows only the background and is left out */
} camber_encoded_tile;

/* A picture, and its encoded tiles. */
typedef struct camber_encode_job {
    camber_tiles_picture picture;
    uint8_t *rgba; /* the picture's pixels, inside the block */
    uint8_t *block;
    /* if tiles are meshes: the lines, instead of pixels. They are freed when the job is released */
    camber_mesh_picture lines;
    double ratio;          /* device px per CSS px, if tiles are meshes */
    uint64_t wanted;       /* tiles to encode */
    bool drops_background; /* tiles that show only this colour are left out: */
    uint8_t background[4];
    uint64_t unit;
    double weight; /* in a dry run: how many bytes of the whole run each byte of this picture stands for; otherwise 1 */
    camber_encoded_tile tiles[64];
    uint64_t waiting; /* tiles that no thread has taken yet */
    size_t left;      /* tiles that are not encoded yet */
    camber_status status;
    size_t failed; /* the number of the worker that failed */
} camber_encode_job;

typedef struct camber_encode_times {
    double wall_ms, cpu_ms; /* sum over all threads */
    uint64_t tiles, bytes;
} camber_encode_times;

typedef struct camber_encode_queue camber_encode_queue;

/* picture_bytes: size of the largest picture. desc NULL: tiles are meshes. workers must outlive the queue; one of them
 * belongs to the caller's thread. Returns CAMBER_ERROR_ARGUMENT, CAMBER_ERROR_MEMORY. */
camber_status camber_encode_queue_create(camber_workers *workers, const camber_encoder_desc *desc, size_t picture_bytes,
                                         camber_encode_queue **queue);
/* Waits for the threads, and discards their results. */
void camber_encode_queue_destroy(camber_encode_queue *queue);
/* Returns a job to draw into; NULL if all are in use: then take one first. */
camber_encode_job *camber_encode_queue_get_free(camber_encode_queue *queue);
/* Queues the job that camber_encode_queue_get_free returned. */
void camber_encode_queue_put(camber_encode_queue *queue, camber_encode_job *job);
/* Returns the oldest job once it is encoded. Returns NULL if the queue is empty, or if waits is false and the job is
 * not ready. If the job failed, the failure has been logged. */
camber_encode_job *camber_encode_queue_take(camber_encode_queue *queue, bool waits);
/* Returns a taken job to the queue, to be used again. */
void camber_encode_queue_release(camber_encode_queue *queue, camber_encode_job *job);
/* Whether any job has been put and not yet released. */
bool camber_encode_queue_is_busy(const camber_encode_queue *queue);
camber_encode_times camber_encode_queue_get_times(camber_encode_queue *queue);

#endif
