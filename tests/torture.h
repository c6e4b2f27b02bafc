/* The torture set: polylines whose strokes run over themselves in every way that joins can go wrong by. Each figure is
 * one polyline in a cell of its own on one picture. */
#ifndef CAMBER_TESTS_TORTURE_H
#define CAMBER_TESTS_TORTURE_H

#include "scene.h"

#include "proof/truth.h"

typedef struct torture_figure {
    char name[48];
    double width_px;
    camber_window cell; /* the stroke's part of the picture, with every join and cap */
} torture_figure;

typedef struct torture_set {
    scene lines; /* polyline i is figure i, and i its row */
    torture_figure *figures;
    size_t count;
    int width, height; /* of the picture, px */
} torture_set;

torture_set torture_make(void);
void torture_free(torture_set *set);

/* An empty set, and one more figure for it: the points of lines since the last figure. Cells fill the picture in rows.
 */
torture_set torture_begin(int width);
void torture_end_figure(torture_set *set, const char *name, double width_px);

/* How a figure's inside looks: the pixels that the stroke covers wholly, and their eight neighbours too. */
typedef struct torture_verdict {
    size_t inside, differing; /* pixels; differing: from the level that most have */
    int level, worst;         /* of 255: that level, and the one farthest from it */
    int x, y;                 /* of the first that is the worst, in the picture */
} torture_verdict;

/* truth: the coverage of the whole picture; alpha: drawn, one byte a pixel. */
torture_verdict torture_judge(const torture_set *set, size_t figure, const float *truth, const uint8_t *alpha);

#endif
