/* Computes the truth of a window, pixel by pixel: the oracle's coverage of each line, united with the others or laid
 * over them; or the areas that all lines wind around. */
#include "validate/coverage_truth.h"

#include <math.h>
#include <stdlib.h>

/* A line, or a part of it between invalid points. */
typedef struct open_line {
    const float *points;
    size_t count;
    camber_oracle_style style;
} open_line;

/* Each line is drawn by itself, before it is laid over the pixels so far. */
typedef struct canvas {
    const camber_truth_desc *desc;
    camber_window window;
    camber_oracle_window ink; /* UNION: all lines; OVER: the part of the current line inside the window */
    float *coverage;
} canvas;

static bool is_number(const float *point) {
    return fabsf(point[0]) <= 1e9f && fabsf(point[1]) <= 1e9f;
}

/* Finds the part of the window that a line may touch. Returns false if it touches none. */
static bool reach_of(const open_line *p, camber_window window, camber_window *part) {
    double left = INFINITY, top = INFINITY, right = -INFINITY, bottom = -INFINITY;
    for (size_t i = 0; i < p->count; i++) { /* no fmin or fmax: gcc 12 for aarch64 crashes */
        const double x = (double)p->points[2 * i], y = (double)p->points[2 * i + 1];
        left = x < left ? x : left, right = x > right ? x : right;
        top = y < top ? y : top, bottom = y > bottom ? y : bottom;
    }
    /* Corners of square caps are sqrt(2) half widths away, and miter tips as far as their limit. */
    const double tip = p->style.join != CAMBER_JOIN_BEVEL ? fmax(p->style.miter_limit, 1.5) : 1.5;
    const double reach = p->style.width_px / 2 * tip + 1;
    left = fmax(floor(left - reach), window.x0), right = fmin(ceil(right + reach), window.x0 + window.width);
    top = fmax(floor(top - reach), window.y0), bottom = fmin(ceil(bottom + reach), window.y0 + window.height);
    if (!(left < right && top < bottom))
        return false;
    *part = (camber_window){(int)left, (int)top, (int)(right - left), (int)(bottom - top)};
    return true;
}

static void lay_over(const canvas *c, camber_window part) {
    for (int y = 0; y < part.height; y++)
        for (int x = 0; x < part.width; x++) {
            const size_t row = (size_t)(part.y0 - c->window.y0 + y), column = (size_t)(part.x0 - c->window.x0 + x);
            float *below = c->coverage + row * (size_t)c->window.width + column;
            *below += (1 - *below) * (float)camber_oracle_coverage(&c->ink, x, y);
        }
}

static bool draw_open_line(canvas *c, const open_line *p) {
    camber_window part;
    if (!reach_of(p, c->window, &part))
        return true;
    if (c->desc->kind == CAMBER_TRUTH_UNION)
        return camber_oracle_stroke(&c->ink, p->points, p->count, &p->style);
    bool made = camber_oracle_open(&c->ink, part.x0, part.y0, part.width, part.height) &&
                camber_oracle_stroke(&c->ink, p->points, p->count, &p->style);
    if (made)
        lay_over(c, part);
    camber_oracle_close(&c->ink);
    return made;
}

static bool draw_line(canvas *c, size_t line) {
    const camber_lines *lines = c->desc->lines;
    const camber_stroke *stroke = c->desc->strokes + (c->desc->rows ? c->desc->rows[line] : 0);
    const size_t end = lines->offsets[line + 1];
    open_line p = {.style = {.width_px = (double)stroke->width_px,
                             .join = stroke->join,
                             .cap = stroke->cap,
                             .miter_limit = stroke->miter_limit > 0 ? (double)stroke->miter_limit : 2,
                             .round_limit = (double)stroke->round_limit}};
    bool drawn = true;
    for (size_t first = lines->offsets[line]; first < end && drawn; first += p.count + 1) {
        p.points = lines->points + 2 * first;
        for (p.count = 0; first + p.count < end && is_number(p.points + 2 * p.count);)
            p.count++;
        p.style.closed = !c->desc->keep_open && first == lines->offsets[line] && first + p.count == end;
        drawn = p.count == 0 || draw_open_line(c, &p);
    }
    return drawn;
}

/* Fills the inside of the lines, in the window's own coordinates: near it the shifted points are exact. */
static bool fill_window(const camber_truth_desc *desc, camber_window window, float *coverage) {
    const camber_lines *lines = desc->lines;
    const bool sums = desc->kind == CAMBER_TRUTH_OVER;
    camber_lines moved = *lines;
    moved.points = malloc((lines->point_count + 1) * 2 * sizeof *moved.points);
    if (!moved.points)
        return false;
    for (size_t i = 0; i < lines->point_count; i++) {
        moved.points[2 * i] = lines->points[2 * i] - (float)window.x0;
        moved.points[2 * i + 1] = lines->points[2 * i + 1] - (float)window.y0;
    }
    const bool made = camber_oracle_fill(&moved, sums ? CAMBER_ORACLE_SUM : CAMBER_ORACLE_NONZERO, window.width,
                                         window.height, coverage);
    for (int i = 0; i < window.width * window.height; i++)
        coverage[i] = fminf(fabsf(coverage[i]), 1.0f);
    free(moved.points);
    return made;
}

bool camber_truth_make(const camber_truth_desc *desc, camber_window window, float *coverage) {
    canvas c = {.desc = desc, .window = window, .coverage = coverage};
    const size_t count = (size_t)window.width * (size_t)window.height;
    const bool united = desc->kind == CAMBER_TRUTH_UNION && !desc->fills;
    bool made = !united || camber_oracle_open(&c.ink, window.x0, window.y0, window.width, window.height);
    for (size_t i = 0; i < count; i++)
        coverage[i] = 0;
    if (desc->fills)
        return fill_window(desc, window, coverage);
    for (size_t i = 0; i < desc->lines->polyline_count && made; i++)
        made = draw_line(&c, i);
    for (size_t i = 0; i < count && made && united; i++)
        coverage[i] =
            (float)camber_oracle_coverage(&c.ink, (int)(i % (size_t)window.width), (int)(i / (size_t)window.width));
    camber_oracle_close(&c.ink);
    return made;
}
