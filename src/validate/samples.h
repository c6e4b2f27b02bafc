/* Windows of a picture, and their truth. */
#ifndef CAMBER_VALIDATE_SAMPLES_H
#define CAMBER_VALIDATE_SAMPLES_H

#include "validate/checks.h"

typedef struct camber_sample {
    camber_window window;
    float *truths[2];       /* [camber_truth_kind]: width * height values */
    size_t polyline, point; /* as in the subject: a point in the window */
    double x, y;
} camber_sample;

typedef struct camber_samples {
    camber_sample *list; /* count of them */
    size_t count;
    bool fills; /* of areas: a pixel is right if it equals either truth or is between them */
} camber_samples;

/* Chooses up to count different windows around points of the lines, spread over all of them, and computes their truth
 * for the strokes. The same lines give the same windows on every machine. */
camber_status camber_samples_make(const camber_subject *subject, const camber_stroke *strokes, size_t count,
                                  camber_samples *samples);
void camber_samples_free(camber_samples *samples);

/* Returns the polyline that contains a point; if several begin with it, the last one. */
size_t camber_polyline_of(const camber_lines *lines, size_t point);

/* Compares a picture of the subject's size with the samples' truth of this kind. worst: the sample with the largest sum
 * of differences. */
void camber_samples_compare(const camber_samples *samples, camber_truth_kind kind, const uint8_t *levels, size_t width,
                            camber_pixel_error *error, size_t *worst);
/* Copies a sample's window out of the picture; levels receives width * height bytes. */
void camber_sample_cut(const camber_sample *sample, const uint8_t *picture, size_t width, uint8_t *levels);
/* Compares two pictures of the same size. */
camber_status camber_pictures_compare(const uint8_t *first, const uint8_t *second, size_t width, size_t height,
                                      camber_pixel_error *error);

#endif
