/* Compares pictures with the truth over their whole area: in bands of 32 rows, because the samples of a whole picture
 * would take 32 bytes per pixel, on as many threads as there are cores. */
#ifndef CAMBER_VALIDATE_PICTURE_ERROR_H
#define CAMBER_VALIDATE_PICTURE_ERROR_H

#include "validate/coverage_truth.h"

#define CAMBER_PICTURES_MAX 3

typedef struct camber_picture_error_desc {
    camber_truth_desc truth;
    int width, height;                            /* px */
    const uint8_t *pictures[CAMBER_PICTURES_MAX]; /* picture_count of them: coverage as levels 0 to 255 */
    size_t picture_count;
    unsigned threads; /* 0: one per core */
    /* Called from the calling thread, with a fraction from 0 to 1. May be NULL. */
    void (*progress)(void *user, double fraction);
    void *user;
} camber_picture_error_desc;

/* Computes one difference per picture, equal to the result of camber_difference_of for the whole picture. Returns false
 * if memory is exhausted. */
bool camber_picture_errors_measure(const camber_picture_error_desc *desc, camber_difference *differences);

#endif
