/* The torture set: polylines whose strokes overlap themselves in every way in which joins can fail. Each figure is one
 * polyline in its own cell of a picture. */
#ifndef CAMBER_VALIDATE_TORTURE_H
#define CAMBER_VALIDATE_TORTURE_H

#include "validate/coverage_truth.h"
#include "validate/scenes.h"

typedef struct camber_torture_figure {
    char name[48];
    double width_px;
    camber_window cell; /* the part of the picture that contains the stroke with every join and cap */
} camber_torture_figure;

typedef struct camber_torture_set {
    camber_made_scene lines; /* polyline i is figure i with row i; failed: memory is exhausted */
    camber_torture_figure *figures;
    size_t count;
    int width, height; /* size of the picture, px */
    float *truths[9];  /* [join and cap]: the coverage of the whole picture, computed when first requested */
} camber_torture_set;

camber_torture_set camber_torture_make(void);
void camber_torture_free(camber_torture_set *set);

/* The first function creates an empty set. The second ends a figure, which consists of the points added to lines since
 * the previous figure. Cells fill the picture in rows. */
camber_torture_set camber_torture_begin(int width);
void camber_torture_end_figure(camber_torture_set *set, const char *name, double width_px);

#endif
