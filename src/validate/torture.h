/* The torture set: polylines whose strokes run over themselves in every way that joins can go wrong by. Each figure is
 * one polyline in a cell of its own on one picture. */
#ifndef CAMBER_VALIDATE_TORTURE_H
#define CAMBER_VALIDATE_TORTURE_H

#include "validate/coverage_truth.h"
#include "validate/scenes.h"

typedef struct camber_torture_figure {
    char name[48];
    double width_px;
    camber_window cell; /* the stroke's part of the picture, with every join and cap */
} camber_torture_figure;

typedef struct camber_torture_set {
    camber_made_scene lines; /* polyline i is figure i, and i its row; failed: memory ran out */
    camber_torture_figure *figures;
    size_t count;
    int width, height; /* of the picture, px */
    float *truths[9];  /* the coverage of the whole picture by join and cap, made when first asked for */
} camber_torture_set;

camber_torture_set camber_torture_make(void);
void camber_torture_free(camber_torture_set *set);

/* An empty set, and one more figure for it: the points of lines since the last figure. Cells fill the picture in rows.
 */
camber_torture_set camber_torture_begin(int width);
void camber_torture_end_figure(camber_torture_set *set, const char *name, double width_px);

#endif
