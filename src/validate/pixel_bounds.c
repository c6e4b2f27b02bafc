/* The bounds for the pixels of plain strokes, in 255ths and in shares of the pixels that an edge crosses. Bounds for
 * features along lines are in the rows of check_along.c. The bounds in this file are values measured with Mesa's
 * llvmpipe, plus a quarter. The bounds of a scene include its known faults: ends of lines whose last segments are
 * shorter than a pixel, and lines that overlap themselves, whose parts are anti-aliased separately. */
#include "validate/checks.h"

#include <math.h>
#include <string.h>

static const struct {
    const char *name; /* NULL: the user's input */
    camber_pixel_bounds bounds;
    camber_pixel_bounds tight; /* added, multiplied by the share of joins that are tight or split */
} table[] = {
    {"random walks", {3.5, 0.050, 0.0040}, {0, 0, 0}},  {"roads", {3.1, 0.040, 0.0010}, {0, 0, 0}},
    {"short segments", {35, 0.57, 0.22}, {0, 0, 0}},    {"turns", {2.7, 0.030, 0.0025}, {0, 0, 0}},
    {"reversals", {50, 0.70, 0.30}, {0, 0, 0}},         {"rings", {3.2, 0.045, 0.0015}, {0, 0, 0}},
    {"repeated points", {12, 0.28, 0.0080}, {0, 0, 0}}, {"invalid points", {2.2, 0.020, 0.0010}, {0, 0, 0}},
    {"grid", {4.6, 0.070, 0.0040}, {0, 0, 0}},          {"side by side", {2.0, 0.005, 0.0010}, {0, 0, 0}},
    {"smooth rings", {3.0, 0.040, 0.0010}, {0, 0, 0}},  {"a segment", {3.0, 0.002, 0.0005}, {0, 0, 0}},
    {"areas", {1.2, 0.0010, 0.0002}, {0, 0, 0}},        {NULL, {2.0, 0.030, 0.0020}, {14, 0.40, 0.060}},
};

/* With a ramp instead of the exact area, every edge has a larger error. */
static const camber_pixel_bounds linear = {3.5, 0.020, 0.0010};

/* Back ends may round differently, and may draw the few pixels on a seam as part of the other segment. Mesa's two back
 * ends draw the same bytes. */
static const camber_pixel_bounds backends = {0.25, 0.0020, 0.0005};

/* Kernels round once, while GL rounds for every line, which matters for pixels that hundreds of lines cross. At right
 * angles whose bisector runs through the pixels' centres, kernels are closer to the truth. */
static const camber_pixel_bounds kernels = {0.85, 0.0150, 0.0005};

/* How much larger the error of the union of all lines may be: it includes their crossings, and a city in 256 px
 * consists mostly of crossings. */
static const double UNITED_MORE = 0.25, UNITED_MORE_OF_INPUT = 1.0;

/* How much larger the error may be for lines that lost points, because their corners are sharper. */
static const double SIMPLIFIED_MORE = 0.5;

/* The oracle's own error for a pixel that an edge crosses, in 255ths: 16 of its 256 samples may be on a line next to
 * the edge, and half of them wrong. tests/unit/test_pixel_bounds.c measures at most 7.7 over all directions, on
 * diagonals. At a join or an end, three edges may cross one pixel. With many lines the errors cancel. But on a few
 * pixels, or on a few lines in one direction, however long, all errors are the same, and a bound on the mean cannot
 * distinguish them from a fault. So one pixel must also have a larger error. */
static const double ORACLE_MOST = 8.0, ORACLE_EDGES = 3.0;

static void add(camber_pixel_bounds *sum, const camber_pixel_bounds *more, double times) {
    sum->mean += times * more->mean;
    sum->past_16 += times * more->past_16;
    sum->past_64 += times * more->past_64;
}

bool camber_bounds_of_pixels(const char *scene, double tight_share, camber_coverage coverage,
                             camber_pixel_bounds *bounds) {
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        const char *name = table[i].name;
        if (name != scene && (!name || !scene || strcmp(name, scene) != 0))
            continue;
        *bounds = table[i].bounds;
        add(bounds, &table[i].tight, tight_share);
        add(bounds, &linear, coverage == CAMBER_COVERAGE_LINEAR);
        return true;
    }
    return false;
}

camber_pixel_bounds camber_bounds_of_united(const char *scene, camber_pixel_bounds over) {
    const camber_pixel_bounds once = over;
    add(&over, &once, scene ? UNITED_MORE : UNITED_MORE_OF_INPUT);
    return over;
}

camber_pixel_bounds camber_bounds_of_simplified(camber_pixel_bounds whole) {
    const camber_pixel_bounds once = whole;
    add(&whole, &once, SIMPLIFIED_MORE);
    return whole;
}

camber_pixel_bounds camber_bounds_of_few(camber_pixel_bounds most, const camber_pixel_error *error) {
    if (error->max <= ORACLE_EDGES * ORACLE_MOST) {
        most.mean = fmax(most.mean, ORACLE_MOST);
        most.past_16 = 1.0;
    }
    return most;
}

camber_pixel_bounds camber_bounds_of_drawers(bool alike) {
    return alike ? backends : kernels;
}

bool camber_bounds_are_passed(const camber_pixel_bounds *is, const camber_pixel_bounds *most, camber_finding *finding) {
    const struct {
        const char *name;
        double got, most;
    } values[] = {{"mean", is->mean, most->mean},
                  {"past_16", is->past_16, most->past_16},
                  {"past_64", is->past_64, most->past_64}};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        if (!(values[i].got <= values[i].most)) {
            finding->field = values[i].name;
            finding->got = values[i].got;
            finding->expected = values[i].most;
            return true;
        }
    return false;
}
