/* What compare measures: figures of a network, and measures of a method on it. */
#ifndef CAMBER_CLI_COMPARISON_H
#define CAMBER_CLI_COMPARISON_H

#include "cli/compared_networks.h"

/* Of a network, whatever the method. */
enum {
    CAMBER_FIGURE_POLYLINES,
    CAMBER_FIGURE_SEGMENTS,
    CAMBER_FIGURE_JOINS,
    CAMBER_FIGURE_TURNS, /* and five more: joins by turn angle, in classes of 30 degrees */
    CAMBER_FIGURE_TIGHT_JOINS = CAMBER_FIGURE_TURNS + 6,
    CAMBER_FIGURE_SPLIT_JOINS,
    CAMBER_FIGURE_COUNT,
};

/* Of a method on a network: the mesh and its picture, then what the GPU does for it. */
enum {
    CAMBER_MEASURE_VERTICES,
    CAMBER_MEASURE_TRIANGLES,
    CAMBER_MEASURE_BYTES, /* of vertices and 32-bit indices */
    CAMBER_MEASURE_DRAW_CALLS_16_BIT,
    CAMBER_MEASURE_DRAW_CALLS,
    CAMBER_MEASURE_TESSELLATE_MS, /* kernels; medians */
    CAMBER_MEASURE_DRAW_MS,
    CAMBER_MEASURE_MEAN_ERROR, /* in 255ths, over the pixels that either the picture or the truth covers */
    CAMBER_MEASURE_MAX_ERROR,
    CAMBER_MEASURE_FRAGMENTS,
    CAMBER_MEASURE_DRAWN_PIXELS,
    CAMBER_MEASURE_REPEATED_PIXELS,   /* within a polyline; the following tell where */
    CAMBER_MEASURE_REPEATED_AT_PLAIN, /* between the two segments of a join, once a join */
    CAMBER_MEASURE_REPEATED_AT_TIGHT,
    CAMBER_MEASURE_REPEATED_AT_SPLIT,
    CAMBER_MEASURE_REPEATED_ELSEWHERE, /* where a line comes back to itself: by no join, once a polyline */
    CAMBER_MEASURE_COUNT,
    CAMBER_MEASURE_OF_PIXELS = CAMBER_MEASURE_FRAGMENTS, /* the first of these */
};

typedef struct camber_measure_info {
    const char *key;  /* in JSON */
    const char *head; /* of a column */
    int width;        /* of it */
    int decimals;     /* 0: a count */
} camber_measure_info;

extern const camber_measure_info camber_figures[CAMBER_FIGURE_COUNT];
extern const camber_measure_info camber_measures[CAMBER_MEASURE_COUNT];

/* The order in which compare shows the methods. */
enum { CAMBER_METHODS = 3 };
extern const camber_method camber_methods_shown[CAMBER_METHODS];

typedef struct camber_comparison_row {
    const char *name; /* of the network */
    double figures[CAMBER_FIGURE_COUNT];
    /* As camber_methods_shown; NAN: of GL alone, and kernels draw. */
    double measures[CAMBER_METHODS][CAMBER_MEASURE_COUNT];
    size_t max_at[CAMBER_METHODS]; /* the pixel of the maximum error */
} camber_comparison_row;

typedef struct camber_comparison {
    camber_session *session;
    camber_compared_networks networks;
    camber_mesh *mesh;
    bool shown[CAMBER_METHODS];      /* which the options ask for */
    camber_comparison_row *rows;     /* of each network */
    camber_comparison_row average;   /* of the networks; maxima: the largest */
    uint8_t *levels[CAMBER_METHODS]; /* of each pixel, as drawn */
    uint8_t *repeated, *at_joins;    /* how often a pixel is repeated: by polylines, by joins */
} camber_comparison;

/* Opens the renderer, reads and measures. Returns an exit status, its line printed; the comparison can be closed in any
 * case. */
int camber_comparison_run(camber_comparison *comparison, camber_session *session);
void camber_comparison_close(camber_comparison *comparison);

/* What a method has to one of the kite's, the paper's method; NAN where that has none. */
double camber_comparison_ratio(const camber_comparison *comparison, int method, int measure);

#endif
