/* The truth about a picture of lines, pixel by pixel, and how far a picture is from it. */
#ifndef CAMBER_VALIDATE_COVERAGE_TRUTH_H
#define CAMBER_VALIDATE_COVERAGE_TRUTH_H

#include "validate/oracle.h"

typedef enum camber_truth_kind {
    /* All lines together, one area: the truth about ink, however it is drawn. */
    CAMBER_TRUTH_UNION,
    /* Each line exact, then one over the other (a + b - ab): the best that drawing line by line can do. */
    CAMBER_TRUTH_OVER,
} camber_truth_kind;

typedef struct camber_truth_desc {
    const camber_lines *lines;    /* px; points that are not numbers split a line, as in camber_polylines_create */
    const uint32_t *rows;         /* of each line, an index into strokes. NULL: all 0 */
    const camber_stroke *strokes; /* drawn at their full width */
    bool keep_open;               /* as in camber_polylines_desc */
    camber_truth_kind kind;
    /* The lines are rings, and the truth is what they wind around together. OVER: what they wind around twice counts
     * twice, and what the other way around, less; at most a whole pixel. Strokes are not read. */
    bool fills;
} camber_truth_desc;

/* A window of the picture, px. */
typedef struct camber_window {
    int x0, y0, width, height;
} camber_window;

/* Writes the coverage, 0 to 1, of each pixel of the window: width * height, rows from the top down. false: out of
 * memory. Cost: the lines' area in the window, some 100 ns a pixel that an edge crosses. */
bool camber_truth_make(const camber_truth_desc *desc, camber_window window, float *coverage);

/* In 255ths, over the pixels where either is above 0. */
typedef struct camber_difference {
    double sum;     /* mean = sum / touched */
    size_t touched; /* pixels */
    size_t past_16; /* that differ by more */
    size_t past_64;
    int max;
    size_t max_at; /* the first pixel that differs by max */
} camber_difference;

/* drawn: coverage as levels 0 to 255, of count pixels. */
camber_difference camber_difference_of(const float *truth, const uint8_t *drawn, size_t count);
/* Adds what another window gave; max_at stays that of the first. */
void camber_difference_add(camber_difference *sum, const camber_difference *more);
double camber_difference_mean(const camber_difference *difference);

/* Writes a PNG for people: truth, drawn, and their difference (red: too much, blue: too little) side by side, each
 * pixel as a square of scale px. Returns CAMBER_ERROR_IO when the sink refuses, CAMBER_ERROR_MEMORY. */
camber_status camber_difference_write(camber_context *context, camber_window window, const float *truth,
                                      const uint8_t *drawn, unsigned scale, camber_sink sink);

#endif
