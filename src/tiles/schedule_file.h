/* Schedules in files: what a run draws, and from which input. */
#ifndef CAMBER_TILES_SCHEDULE_FILE_H
#define CAMBER_TILES_SCHEDULE_FILE_H

#include "features/region.h"
#include "tiles/fingerprint.h"
#include "tiles/schedule.h"

enum { CAMBER_SCHEDULE_BOXES = 4 };

struct camber_tiles_schedule {
    camber_context *context;
    char fingerprint[CAMBER_FINGERPRINT_SIZE]; /* the run's */
    uint64_t input;                            /* the hash of all features, which is part of the fingerprint */
    uint64_t files;                            /* the hash of the input files */
    camber_box data;                           /* bounding box of all points */
    camber_schedule schedule;
    char features[4096]; /* the file of the features, in the same folder as the schedule */
    /* Boxes around the tiles of the part that the features are read for. There are several, because a stretch of the
     * curve may have distant ends. */
    camber_region boxes[CAMBER_SCHEDULE_BOXES];
    size_t box_count;
};

/* Makes the name of the file with a schedule's features. Returns false if the name is too long. */
bool camber_schedule_name_features(const char *path, char *name, size_t size);

/* Hashes the sizes of files and their bytes. Of a large file it hashes only some pieces. */
camber_status camber_files_hash(camber_context *context, const char *const *paths, size_t count, uint64_t *hash);
/* Writes the whole file, or none. force: an existing file may be replaced. Returns CAMBER_ERROR_IO,
 * CAMBER_ERROR_MEMORY. */
camber_status camber_schedule_write(const struct camber_tiles_schedule *schedule, const char *path, bool force);

#endif
