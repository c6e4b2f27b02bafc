/* The torture set: polylines whose strokes run over themselves in every way that joins can go wrong by. Each figure is
 * one polyline in a cell of its own on one picture. */
#ifndef CAMBER_TESTS_TORTURE_H
#define CAMBER_TESTS_TORTURE_H

#include "picture.h"

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
    float *truths[9];  /* the coverage of the whole picture by join and cap, made when first asked for */
} torture_set;

torture_set torture_make(void);
void torture_free(torture_set *set);

/* An empty set, and one more figure for it: the points of lines since the last figure. Cells fill the picture in rows.
 */
torture_set torture_begin(int width);
void torture_end_figure(torture_set *set, const char *name, double width_px);

/* How a figure's inside looks: the pixels that the stroke covers wholly, and their eight neighbours too. */
typedef struct torture_verdict {
    size_t inside; /* pixels */
    /* Pixels that are not of the level that most have: where a stretch of line turns within half its width, and where
     * it takes parts of the line that lie farther apart to cover the pixel, each of them in part only. Coverage line
     * over line cannot add up to 1 there. */
    size_t torn, meeting;
    int torn_levels;  /* by how many levels the worst of torn differs */
    int level, worst; /* of 255: that level, and the one farthest from it */
    int x, y;         /* of the first that is the worst, in its cell */
} torture_verdict;

/* What the verdict is about: alpha is drawn with these strokes, one byte a pixel, and truth is their coverage, both of
 * the whole picture. */
typedef struct torture_picture {
    const torture_set *set;
    const camber_stroke *strokes;
    const float *truth;
    const uint8_t *alpha;
} torture_picture;

torture_verdict torture_judge(const torture_picture *drawn, size_t figure);

/* Pixels of one picture of the whole set that are known to differ. */
typedef struct torture_known {
    size_t torn;
    int torn_levels;
    size_t meeting;
} torture_known;

/* Draws the set half transparent and flattened with every join, cap and back end; prints each figure that is not of one
 * alpha inside; fails where a picture has more such pixels than are known. */
void torture_check(const studio *s, torture_set *set, camber_method method, torture_known known);

#endif
