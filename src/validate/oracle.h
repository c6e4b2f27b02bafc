/* The truth about strokes: coverage by 256 samples a pixel, from the definition of a stroke alone. Shares no formula
 * with kernels and shaders: a stroke is the union of
 *
 *   the rectangle of each segment
 *   the join of each inner point   round: the wedge between the two outer normals, within half a width
 *                                  miter: the kite of point, corners and tip; past the limit the bevel
 *                                  bevel: the triangle of point and corners
 *   the caps                       round: half a disc; square: half a width more of the rectangle
 *
 * And about areas: a sample is inside by how often the rings wind around it.
 */
#ifndef CAMBER_VALIDATE_ORACLE_H
#define CAMBER_VALIDATE_ORACLE_H

#include "camber_files.h"

typedef struct camber_oracle_sample_set {
    uint64_t bits[4]; /* of 16 x 16 samples */
} camber_oracle_sample_set;

/* A window of the plane, x0, y0 to x0 + width, y0 + height px. */
typedef struct camber_oracle_window {
    int x0, y0, width, height;
    camber_oracle_sample_set *pixels; /* width * height, rows from the top down */
} camber_oracle_window;

typedef struct camber_oracle_style {
    double width_px;
    camber_join join;
    camber_cap cap;
    double miter_limit; /* 1 / cos(turn / 2) */
    bool closed;        /* the last point, equal to the first, is a join */
    double round_limit; /* as the miter limit; below it round joins are not round */
} camber_oracle_style;

/* Nothing is covered yet. false: out of memory. */
bool camber_oracle_open(camber_oracle_window *window, int x0, int y0, int width, int height);
void camber_oracle_clear(camber_oracle_window *window);
void camber_oracle_close(camber_oracle_window *window);

/* Adds a stroke to what is covered. points: count pairs of x, y px; repeated points are skipped. false: out of memory.
 */
bool camber_oracle_stroke(camber_oracle_window *window, const float *points, size_t count,
                          const camber_oracle_style *style);

/* Rings wind around a sample so many times in sum. It counts whether they do, whether the number is odd, or the number
 * itself. */
typedef enum camber_oracle_rule { CAMBER_ORACLE_NONZERO, CAMBER_ORACLE_EVENODD, CAMBER_ORACLE_SUM } camber_oracle_rule;

/* The share of each pixel, 0 to 1, that rings wind around; SUM: the mean of the numbers. Rings end where they begin. By
 * 16 rows of 16 samples a pixel, and by where the rings' edges cross these rows. shares: width * height, rows from the
 * top down. false: out of memory. */
bool camber_oracle_fill(const camber_lines *rings, camber_oracle_rule rule, int width, int height, float *shares);

/* 0 to 1, of the pixel whose corner is x0 + column, y0 + row. */
double camber_oracle_coverage(const camber_oracle_window *window, int column, int row);

#endif
