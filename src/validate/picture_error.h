/* Pictures held against the truth over their whole area: 32 rows at a time, since the samples of a whole picture would
 * take 32 bytes a pixel, on as many threads as there are cores. */
#ifndef CAMBER_VALIDATE_PICTURE_ERROR_H
#define CAMBER_VALIDATE_PICTURE_ERROR_H

#include "validate/coverage_truth.h"

#define CAMBER_PICTURES_MAX 3

typedef struct camber_picture_error_desc {
    camber_truth_desc truth;
    int width, height;                            /* px */
    const uint8_t *pictures[CAMBER_PICTURES_MAX]; /* picture_count, coverage as levels 0 to 255 */
    size_t picture_count;
    unsigned threads; /* 0: one a core */
    /* Called from the calling thread; fraction in 0 to 1. NULL: not wanted. */
    void (*progress)(void *user, double fraction);
    void *user;
} camber_picture_error_desc;

/* One difference a picture, as camber_difference_of gives it of the whole. false: out of memory. */
bool camber_picture_errors_measure(const camber_picture_error_desc *desc, camber_difference *differences);

#endif
