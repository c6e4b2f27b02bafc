/* The truth about strokes: coverage by 256 samples a pixel, from the definition of a stroke alone. Shares no formula
 * with kernels and shaders: a stroke is the union of the rectangle of each segment the join of each inner point round:
 * the wedge between the two outer normals, within half a width miter: the kite of point, corners and tip; past the
 * limit the bevel bevel: the triangle of point and corners the caps                       round: half a disc; square:
 * half a width more of the rectangle */
#ifndef CAMBER_TESTS_ORACLE_H
#define CAMBER_TESTS_ORACLE_H

#include "camber.h"

typedef struct oracle_sample_set {
    uint64_t bits[4]; /* of 16 x 16 samples */
} oracle_sample_set;

/* A window of the plane, x0, y0 to x0 + width, y0 + height px. */
typedef struct oracle_window {
    int x0, y0, width, height;
    oracle_sample_set *pixels; /* width * height, rows from the top down */
} oracle_window;

typedef struct oracle_style {
    double width_px;
    camber_join join;
    camber_cap cap;
    double miter_limit; /* 1 / cos(turn / 2) */
    bool closed;        /* the last point, equal to the first, is a join */
} oracle_style;

/* Nothing is covered yet. false: out of memory. */
bool oracle_open(oracle_window *window, int x0, int y0, int width, int height);
void oracle_clear(oracle_window *window);
void oracle_close(oracle_window *window);

/* Adds a stroke to what is covered. points: count pairs of x, y px; repeated points are skipped. false: out of memory.
 */
bool oracle_stroke(oracle_window *window, const float *points, size_t count, const oracle_style *style);

/* 0 to 1, of the pixel whose corner is x0 + column, y0 + row. */
double oracle_coverage(const oracle_window *window, int column, int row);

#endif
