/* The results of a comparison: figures of a network, and metrics of a method on it. */
#ifndef CAMBER_CLI_COMPARISON_H
#define CAMBER_CLI_COMPARISON_H

#include "cli/compared_networks.h"

/* Figures belong to a network, and do not depend on the method. */
enum {
    CAMBER_FIGURE_POLYLINES,
    CAMBER_FIGURE_SEGMENTS,
    CAMBER_FIGURE_JOINS,
    CAMBER_FIGURE_TURNS, /* and five more: the number of joins by turn angle, in classes of 30 degrees */
    CAMBER_FIGURE_TIGHT_JOINS = CAMBER_FIGURE_TURNS + 6,
    CAMBER_FIGURE_SPLIT_JOINS,
    CAMBER_FIGURE_COUNT,
};

/* Metrics belong to a method on a network: first the mesh and its picture, then the work of the GPU. */
enum {
    CAMBER_METRIC_VERTICES,
    CAMBER_METRIC_TRIANGLES,
    CAMBER_METRIC_BYTES, /* vertices and 32-bit indices */
    CAMBER_METRIC_DRAW_CALLS_16_BIT,
    CAMBER_METRIC_DRAW_CALLS,
    CAMBER_METRIC_TESSELLATE_MS, /* time of the kernels; all times are medians */
    CAMBER_METRIC_DRAW_MS,
    CAMBER_METRIC_MEAN_ERROR, /* in 255ths, over the pixels that the picture or the exact lines cover */
    CAMBER_METRIC_MAX_ERROR,
    CAMBER_METRIC_FRAGMENTS,
    CAMBER_METRIC_DRAWN_PIXELS,
    CAMBER_METRIC_REPEATED_PIXELS,   /* within a polyline; the next four say where */
    CAMBER_METRIC_REPEATED_AT_PLAIN, /* between the two segments of a join; counted once per join */
    CAMBER_METRIC_REPEATED_AT_TIGHT,
    CAMBER_METRIC_REPEATED_AT_SPLIT,
    CAMBER_METRIC_REPEATED_ELSEWHERE, /* where a line crosses itself, not at a join; counted once per polyline */
    CAMBER_METRIC_COUNT,
    CAMBER_METRIC_OF_PIXELS = CAMBER_METRIC_FRAGMENTS, /* the first metric of pixels */
};

typedef struct camber_metric_info {
    const char *key;  /* in JSON */
    const char *head; /* head of its column */
    int width;        /* width of its column */
    int decimals;     /* 0: a count */
} camber_metric_info;

extern const camber_metric_info camber_figures[CAMBER_FIGURE_COUNT];
extern const camber_metric_info camber_metrics[CAMBER_METRIC_COUNT];

/* The methods, in the order in which compare shows them. */
enum { CAMBER_METHODS = 3 };
extern const camber_method camber_methods_shown[CAMBER_METHODS];

typedef struct camber_comparison_row {
    const char *name; /* of the network */
    double figures[CAMBER_FIGURE_COUNT];
    /* [index in camber_methods_shown]; NAN if kernels draw and the metric exists only in GL */
    double metrics[CAMBER_METHODS][CAMBER_METRIC_COUNT];
    size_t max_at[CAMBER_METHODS]; /* the pixel of the maximum error */
} camber_comparison_row;

typedef struct camber_comparison {
    camber_session *session;
    camber_compared_networks networks;
    camber_mesh *mesh;
    bool shown[CAMBER_METHODS];      /* methods that the options select */
    camber_comparison_row *rows;     /* one for each network */
    camber_comparison_row average;   /* over the networks; for maxima it is the largest */
    uint8_t *levels[CAMBER_METHODS]; /* of each pixel, as drawn */
    uint8_t *repeated, *at_joins;    /* how often a pixel is drawn again: by polylines, and at joins */
} camber_comparison;

/* Opens the renderer, reads the networks and measures them. Returns an exit status; on failure a line has been printed.
 * The comparison must be closed in any case. */
int camber_comparison_run(camber_comparison *comparison, camber_session *session);
void camber_comparison_close(camber_comparison *comparison);

/* A method's metric divided by the same metric of kite, the paper's method. NAN if kite has none. */
double camber_comparison_ratio(const camber_comparison *comparison, int method, int metric);

#endif
