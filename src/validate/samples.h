/* Windows of a picture and the truth in them. */
#ifndef CAMBER_VALIDATE_SAMPLES_H
#define CAMBER_VALIDATE_SAMPLES_H

#include "validate/checks.h"

typedef struct camber_sample {
    camber_window window;
    float *truths[2];       /* by camber_truth_kind, width * height of the window */
    size_t polyline, point; /* as given: one that lies in it */
    double x, y;
} camber_sample;

typedef struct camber_samples {
    camber_sample *list; /* count */
    size_t count;
    bool fills; /* of areas: a pixel is right by either truth, and between them */
} camber_samples;

/* Chooses up to count windows about points of the lines, none twice, spread over all of them, and makes their truth
 * for the strokes. The same windows for the same lines on every machine. */
camber_status camber_samples_make(const camber_subject *subject, const camber_stroke *strokes, size_t count,
                                  camber_samples *samples);
void camber_samples_free(camber_samples *samples);

/* The polyline that has a point; the last of those that begin with it. */
size_t camber_polyline_of(const camber_lines *lines, size_t point);

/* Holds a picture of the subject's size against a kind of the samples' truth. worst: the sample with the largest sum of
 * differences. */
void camber_samples_compare(const camber_samples *samples, camber_truth_kind kind, const uint8_t *levels, size_t width,
                            camber_pixel_error *error, size_t *worst);
/* A sample's part of the picture; levels takes width * height of its window. */
void camber_sample_cut(const camber_sample *sample, const uint8_t *picture, size_t width, uint8_t *levels);
/* Two pictures of one size against each other. */
camber_status camber_pictures_compare(const uint8_t *first, const uint8_t *second, size_t width, size_t height,
                                      camber_pixel_error *error);

#endif
