/* Golden pictures: small scenes, each drawn and held against a PNG of tests/golden. */
#ifndef CAMBER_TESTS_GOLDEN_H
#define CAMBER_TESTS_GOLDEN_H

#include "picture.h"

enum { GOLDEN_ROWS = 96, GOLDEN_PASSES = 3, GOLDEN_BYTES_MAX = 64 * 1024 };

typedef struct golden {
    const char *name; /* what it shows; of the file, without .png */
    uint32_t width, height;
    camber_color background; /* opaque */
    camber_method method;
    camber_coverage coverage;
    scene lines;
    camber_stroke strokes[GOLDEN_ROWS];
    size_t stroke_count;
    camber_paint paints[GOLDEN_PASSES][GOLDEN_ROWS]; /* stroke_count each */
    camber_overlap overlap[GOLDEN_PASSES];
    /* Polylines of a pass, as in camber_pass. */
    size_t first_polyline[GOLDEN_PASSES], polyline_count[GOLDEN_PASSES];
    size_t pass_count;
    /* Black on white: the most that the picture may be off the oracle on average, of 255. 0: it has colours. */
    double oracle_mean;
} golden;

/* A row as wide as its stroke in pass 0, black. Gives its index. */
size_t golden_row(golden *g, camber_stroke stroke);

/* Draws the scene with every back end and judges each picture; frees its lines. false: one of them is not as it should
 * be, and what is wrong is printed. */
bool golden_draw(const studio *s, golden *g);

/* Holds a picture against name.png and leaves name.actual.png and name.difference.png in the build tree where it
 * differs. With CAMBER_GOLDEN=renew in the environment it becomes name.png. */
bool golden_judge(const char *name, const picture *drawn);

#endif
