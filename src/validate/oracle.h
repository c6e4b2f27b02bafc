/* The truth about strokes: coverage with 256 samples per pixel, computed only from the definition of a stroke. Shares
 * no formula with kernels and shaders. A stroke is the union of
 *
 *   the rectangle of each segment
 *   the join of each inner point   round: the wedge between the two outer normals, within half a width
 *                                  miter: the kite of point, corners and tip; past the limit the bevel
 *                                  bevel: the triangle of point and corners
 *   the caps                       round: half a disc; square: half a width more of the rectangle
 *
 * The truth about areas: whether a sample is inside depends on how often the rings wind around it. */
#ifndef CAMBER_VALIDATE_ORACLE_H
#define CAMBER_VALIDATE_ORACLE_H

#include "camber_files.h"

typedef struct camber_oracle_sample_set {
    uint64_t bits[4]; /* one for each of 16 x 16 samples */
} camber_oracle_sample_set;

/* A window of the plane: x0, y0 to x0 + width, y0 + height, px. */
typedef struct camber_oracle_window {
    int x0, y0, width, height;
    camber_oracle_sample_set *pixels; /* width * height, rows from the top down */
} camber_oracle_window;

typedef struct camber_oracle_style {
    double width_px;
    camber_join join;
    camber_cap cap;
    double miter_limit; /* 1 / cos(turn / 2) */
    bool closed;        /* the last point, which equals the first, is a join */
    double round_limit; /* like the miter limit; below it, round joins are not round */
} camber_oracle_style;

/* Opens an empty window. Returns false if memory is exhausted. */
bool camber_oracle_open(camber_oracle_window *window, int x0, int y0, int width, int height);
void camber_oracle_clear(camber_oracle_window *window);
void camber_oracle_close(camber_oracle_window *window);

/* Adds a stroke. points: count pairs of x and y, px; repeated points are skipped. Returns false if memory is
 * exhausted. */
bool camber_oracle_stroke(camber_oracle_window *window, const float *points, size_t count,
                          const camber_oracle_style *style);

/* The result for a sample, given how often the rings wind around it in total: whether it is not 0, whether it is
 * odd, or the number itself. */
typedef enum camber_oracle_rule { CAMBER_ORACLE_NONZERO, CAMBER_ORACLE_EVENODD, CAMBER_ORACLE_SUM } camber_oracle_rule;

/* Computes the share of each pixel, 0 to 1, that rings wind around; SUM: the mean of the numbers. Each ring's last
 * point equals its first. Each pixel has 16 rows of 16 samples; the crossings of the rings' edges with these rows
 * decide. shares: width * height values, rows from the top down. Returns false if memory is exhausted. */
bool camber_oracle_fill(const camber_lines *rings, camber_oracle_rule rule, int width, int height, float *shares);

/* Returns the coverage, 0 to 1, of the pixel whose corner is x0 + column, y0 + row. */
double camber_oracle_coverage(const camber_oracle_window *window, int column, int row);

#endif
