/* The exact picture of lines, pixel by pixel (called the truth), and how far a picture is from it. */
#ifndef CAMBER_VALIDATE_COVERAGE_TRUTH_H
#define CAMBER_VALIDATE_COVERAGE_TRUTH_H

#include "validate/oracle.h"

typedef enum camber_truth_kind {
    /* All lines together are one area: the exact coverage, however the lines are drawn. */
    CAMBER_TRUTH_UNION,
    /* Each line is exact, and lines are laid over each other (a + b - ab): the best result of drawing line by line. */
    CAMBER_TRUTH_OVER,
} camber_truth_kind;

typedef struct camber_truth_desc {
    const camber_lines *lines;    /* px; invalid points split a line, as in camber_polylines_create */
    const uint32_t *rows;         /* for each line an index into strokes; NULL: all 0 */
    const camber_stroke *strokes; /* drawn with their full widths */
    bool keep_open;               /* as in camber_polylines_desc */
    camber_truth_kind kind;
    /* The lines are rings, and the truth is the area that they wind around together. OVER: areas that they wind around
     * twice count twice, and those that they wind around in the other direction are subtracted; at most a whole pixel.
     * Strokes are not used. */
    bool fills;
} camber_truth_desc;

/* A window of the picture, px. */
typedef struct camber_window {
    int x0, y0, width, height;
} camber_window;

/* Writes the coverage, 0 to 1, of each pixel of the window: width * height values, rows from the top down. Returns
 * false if memory is exhausted. Cost: proportional to the lines' area in the window, about 100 ns for each pixel that
 * an edge crosses. */
bool camber_truth_make(const camber_truth_desc *desc, camber_window window, float *coverage);

/* In 255ths, over the pixels that are covered in either picture. */
typedef struct camber_difference {
    double sum;     /* the mean is sum / touched */
    size_t touched; /* number of those pixels */
    size_t past_16; /* pixels that differ by more than 16 */
    size_t past_64;
    int max;
    size_t max_at; /* index of the first pixel that differs by max */
} camber_difference;

/* drawn: coverage of count pixels, as levels 0 to 255. */
camber_difference camber_difference_of(const float *truth, const uint8_t *drawn, size_t count);
/* Adds the result of another window. max_at keeps its value. */
void camber_difference_add(camber_difference *sum, const camber_difference *more);
double camber_difference_mean(const camber_difference *difference);

/* Writes a PNG for people: truth, drawn, and their difference (red: too much, blue: too little) next to each other.
 * Each pixel becomes a square of scale px. Returns CAMBER_ERROR_IO if the sink fails, CAMBER_ERROR_MEMORY. */
camber_status camber_difference_write(camber_context *context, camber_window window, const float *truth,
                                      const uint8_t *drawn, unsigned scale, camber_sink sink);

#endif
