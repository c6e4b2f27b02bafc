/* Schedules kept in files: what a run draws, of which input. */
#ifndef CAMBER_TILES_SCHEDULE_FILE_H
#define CAMBER_TILES_SCHEDULE_FILE_H

#include "features/region.h"
#include "tiles/fingerprint.h"
#include "tiles/schedule.h"

enum { CAMBER_SCHEDULE_BOXES = 4 };

struct camber_tiles_schedule {
    camber_context *context;
    char fingerprint[CAMBER_FINGERPRINT_SIZE]; /* of the run */
    uint64_t input;                            /* the hash of all features, which the fingerprint has */
    uint64_t files;                            /* the hash of the files that they were read of */
    camber_box data;                           /* of all points */
    camber_schedule schedule;
    char features[4096]; /* the file that has the features, beside the schedule's */
    /* These have the tiles of the part that a set was told to be for: a stretch of the curve may have far ends. */
    camber_region boxes[CAMBER_SCHEDULE_BOXES];
    size_t box_count;
};

/* Names the file of the features of a schedule. false: the name is too long. */
bool camber_schedule_name_features(const char *path, char *name, size_t size);

/* Hashes what files are: their sizes, and their bytes or, of large ones, many pieces of them. */
camber_status camber_files_hash(camber_context *context, const char *const *paths, size_t count, uint64_t *hash);
/* Writes the file whole or not at all. force: it replaces another. Returns CAMBER_ERROR_IO, CAMBER_ERROR_MEMORY. */
camber_status camber_schedule_write(const struct camber_tiles_schedule *schedule, const char *path, bool force);

#endif
