/* The numbers of a comparison: figures of a network, and metrics of a method on it. */
#ifndef CAMBER_CLI_COMPARISON_H
#define CAMBER_CLI_COMPARISON_H

#include "cli/compared_networks.h"

/* Figures: they belong to a network, whatever the method. */
enum {
    CAMBER_FIGURE_POLYLINES,
    CAMBER_FIGURE_SEGMENTS,
    CAMBER_FIGURE_JOINS,
    CAMBER_FIGURE_TURNS, /* and five more: joins by turn angle, in classes of 30 degrees */
    CAMBER_FIGURE_TIGHT_JOINS = CAMBER_FIGURE_TURNS + 6,
    CAMBER_FIGURE_SPLIT_JOINS,
    CAMBER_FIGURE_COUNT,
};

/* Metrics: they belong to a method on a network. First the mesh and its picture, then the work of the GPU. */
enum {
    CAMBER_METRIC_VERTICES,
    CAMBER_METRIC_TRIANGLES,
    CAMBER_METRIC_BYTES, /* of vertices and 32-bit indices */
    CAMBER_METRIC_DRAW_CALLS_16_BIT,
    CAMBER_METRIC_DRAW_CALLS,
    CAMBER_METRIC_TESSELLATE_MS, /* kernels; medians */
    CAMBER_METRIC_DRAW_MS,
    CAMBER_METRIC_MEAN_ERROR, /* in 255ths, over the pixels that either the picture or the truth covers */
    CAMBER_METRIC_MAX_ERROR,
    CAMBER_METRIC_FRAGMENTS,
    CAMBER_METRIC_DRAWN_PIXELS,
    CAMBER_METRIC_REPEATED_PIXELS,   /* within a polyline; the following tell where */
    CAMBER_METRIC_REPEATED_AT_PLAIN, /* between the two segments of a join, once a join */
    CAMBER_METRIC_REPEATED_AT_TIGHT,
    CAMBER_METRIC_REPEATED_AT_SPLIT,
    CAMBER_METRIC_REPEATED_ELSEWHERE, /* where a line comes back to itself: by no join, once a polyline */
    CAMBER_METRIC_COUNT,
    CAMBER_METRIC_OF_PIXELS = CAMBER_METRIC_FRAGMENTS, /* the first of these */
};

typedef struct camber_metric_info {
    const char *key;  /* in JSON */
    const char *head; /* of a column */
    int width;        /* of it */
    int decimals;     /* 0: a count */
} camber_metric_info;

extern const camber_metric_info camber_figures[CAMBER_FIGURE_COUNT];
extern const camber_metric_info camber_metrics[CAMBER_METRIC_COUNT];

/* The order in which compare shows the methods. */
enum { CAMBER_METHODS = 3 };
extern const camber_method camber_methods_shown[CAMBER_METHODS];

typedef struct camber_comparison_row {
    const char *name; /* of the network */
    double figures[CAMBER_FIGURE_COUNT];
    /* As camber_methods_shown; NAN: of GL alone, and kernels draw. */
    double metrics[CAMBER_METHODS][CAMBER_METRIC_COUNT];
    size_t max_at[CAMBER_METHODS]; /* the pixel of the maximum error */
} camber_comparison_row;

typedef struct camber_comparison {
    camber_session *session;
    camber_compared_networks networks;
    camber_mesh *mesh;
    bool shown[CAMBER_METHODS];      /* the methods that the options ask for */
    camber_comparison_row *rows;     /* of each network */
    camber_comparison_row average;   /* of the networks; maxima: the largest */
    uint8_t *levels[CAMBER_METHODS]; /* of each pixel, as drawn */
    uint8_t *repeated, *at_joins;    /* how often a pixel is repeated: by polylines, by joins */
} camber_comparison;

/* Opens the renderer, reads the networks and metrics them. Returns an exit status, its line printed; the comparison
 * can be closed in any case. */
int camber_comparison_run(camber_comparison *comparison, camber_session *session);
void camber_comparison_close(camber_comparison *comparison);

/* A method's metric divided by the kite's, the paper's method. NAN: the kite has none. */
double camber_comparison_ratio(const camber_comparison *comparison, int method, int metric);

#endif
