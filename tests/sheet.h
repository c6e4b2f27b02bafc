/* Many small figures on one picture, drawn by the core and held against the oracle. */
#ifndef CAMBER_TESTS_SHEET_H
#define CAMBER_TESTS_SHEET_H

#include "proof/oracle.h"

/* The difference between picture and truth over the pixels that either touches, in 255ths. */
typedef struct tally {
    const char *name;
    double sum;
    size_t pixels;
    int max;
    double ink, true_ink; /* px of area */
    char worst[128];      /* the label of the figure with the largest difference, and where */
} tally;

/* A polyline about the origin, px. */
typedef struct figure {
    const float *points;
    size_t point_count;
    camber_oracle_style style;
    tally *tally; /* takes the difference from the truth */
    const char *label;
    /* Drawn beside at a distance of whole pixels: the same stroke by other points. NULL: nothing is. */
    const float *twin_points;
    size_t twin_count;
    tally *twin_tally; /* takes the difference between the two */
} figure;

typedef struct sheet sheet;

/* false: neither EGL nor OSMesa, or no OpenCL device; the log has said why. */
bool sheet_open(camber_method method, sheet **opened);
/* Adds a figure; draws and compares what is there when the picture is full. */
void sheet_add(sheet *s, const figure *f);
/* Draws and compares what is there. The picture is black on white, then white on black, in turn. */
void sheet_flush(sheet *s);
void sheet_close(sheet *s);

/* Prints mean and maximum; false where the mean or the maximum is above its bound. */
bool tally_check(const tally *t, double mean_bound, int max_bound);

#endif
