/* A queue of pictures that are cut into tiles and encoded by threads, while the next picture is drawn. */
#ifndef CAMBER_TILES_ENCODING_H
#define CAMBER_TILES_ENCODING_H

#include "camber_tiles.h"
#include "tiles/mesh_tile.h"
#include "tiles/workers.h"

typedef struct camber_encoded_tile {
    uint8_t *bytes;
    size_t size_bytes, capacity; /* 0 bytes: it shows the background alone, and is left out */
} camber_encoded_tile;

/* A picture and what became of its tiles. */
typedef struct camber_encode_job {
    camber_tiles_picture picture;
    uint8_t *rgba; /* the picture's, in the block */
    uint8_t *block;
    camber_mesh_picture lines; /* of tiles that are meshes, in place of pixels; freed with the job's release */
    double ratio;              /* of those */
    uint64_t wanted;           /* tiles to encode */
    bool drops_background;     /* tiles of this colour alone are left out: */
    uint8_t background[4];
    uint64_t unit;
    double weight; /* of a dry run: each of its bytes stands for so many. Else 1 */
    camber_encoded_tile tiles[64];
    uint64_t waiting; /* tiles that no thread has taken yet */
    size_t left;      /* that are not encoded yet */
    camber_status status;
    size_t failed; /* which worker */
} camber_encode_job;

typedef struct camber_encode_times {
    double wall_ms, cpu_ms; /* of all threads */
    uint64_t tiles, bytes;
} camber_encode_times;

typedef struct camber_encode_queue camber_encode_queue;

/* picture_bytes: of the largest picture. desc NULL: tiles are meshes. workers must outlive the queue; one of them works
 * on the caller's thread. Returns CAMBER_ERROR_ARGUMENT, CAMBER_ERROR_MEMORY. */
camber_status camber_encode_queue_create(camber_workers *workers, const camber_encoder_desc *desc, size_t picture_bytes,
                                         camber_encode_queue **queue);
/* Waits for the threads, and drops what they have done. */
void camber_encode_queue_destroy(camber_encode_queue *queue);
/* A job to draw into. NULL: all are in use; take one first. */
camber_encode_job *camber_encode_queue_get_free(camber_encode_queue *queue);
/* Hands over the job that was got. */
void camber_encode_queue_put(camber_encode_queue *queue, camber_encode_job *job);
/* The job that was put first, once it is encoded. NULL: there is none, or, without waits, it is not ready. Its failure
 * has been told. */
camber_encode_job *camber_encode_queue_take(camber_encode_queue *queue, bool waits);
/* Gives back the job that was taken. */
void camber_encode_queue_release(camber_encode_queue *queue, camber_encode_job *job);
/* Whether a job was put and not released. */
bool camber_encode_queue_is_busy(const camber_encode_queue *queue);
camber_encode_times camber_encode_queue_get_times(camber_encode_queue *queue);

#endif
