/* Chooses windows of SIDE_PX that are spread over the lines, and computes their truth once. Each picture of the subject
 * is then compared with it, window by window. */
#include "validate/samples.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_PX = 48 };

/* ---- Choosing ---- */

/* Returns the i-th index in an order whose first indices, however few, are spread over all of them: multiples of the
 * golden ratio. */
static size_t spread(size_t i, size_t count) {
    const double turns = (double)i * 0.6180339887498949;
    const size_t at = (size_t)((turns - (double)(size_t)turns) * (double)count);
    return at < count ? at : count - 1;
}

/* Finds the cell of a grid of SIDE_PX that contains a point, shifted into the picture. Returns false if the point is
 * outside the picture. */
static bool window_about(const float *point, const camber_subject *s, camber_window *window) {
    if (!(point[0] >= 0 && point[1] >= 0 && point[0] < (float)s->width && point[1] < (float)s->height))
        return false;
    const int width = s->width < SIDE_PX ? (int)s->width : SIDE_PX;
    const int height = s->height < SIDE_PX ? (int)s->height : SIDE_PX;
    const int x = (int)point[0] / SIDE_PX * SIDE_PX, y = (int)point[1] / SIDE_PX * SIDE_PX;
    const int right = (int)s->width - width, bottom = (int)s->height - height;
    *window = (camber_window){x < right ? x : right, y < bottom ? y : bottom, width, height};
    return true;
}

size_t camber_polyline_of(const camber_lines *lines, size_t point) {
    size_t low = 0, high = lines->polyline_count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (lines->offsets[middle] <= point)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static void choose(const camber_subject *s, size_t count, camber_samples *samples) {
    const camber_lines *lines = &s->lines;
    const size_t tries = lines->point_count ? 32 * count : 0;
    for (size_t i = 0; i < tries && samples->count < count; i++) {
        const size_t at = spread(i, lines->point_count);
        const float *point = lines->points + 2 * at;
        camber_sample *sample = &samples->list[samples->count];
        if (!window_about(point, s, &sample->window))
            continue;
        bool taken = false;
        for (size_t k = 0; k < samples->count && !taken; k++)
            taken = memcmp(&samples->list[k].window, &sample->window, sizeof sample->window) == 0;
        if (taken)
            continue;
        sample->polyline = camber_polyline_of(lines, at);
        sample->point = at - lines->offsets[sample->polyline];
        sample->x = (double)point[0];
        sample->y = (double)point[1];
        samples->count++;
    }
}

static size_t area_of(const camber_window *window) {
    return (size_t)window->width * (size_t)window->height;
}

camber_status camber_samples_make(const camber_subject *subject, const camber_stroke *strokes, size_t count,
                                  camber_samples *samples) {
    camber_truth_desc desc = {.lines = &subject->lines,
                              .rows = subject->rows,
                              .strokes = strokes,
                              .keep_open = subject->keep_open,
                              .fills = subject->fills};
    *samples = (camber_samples){.list = calloc(count + 1, sizeof *samples->list), .fills = subject->fills};
    if (!samples->list)
        return CAMBER_ERROR_MEMORY;
    choose(subject, count, samples);
    for (size_t i = 0; i < 2 * samples->count; i++) {
        camber_sample *sample = &samples->list[i / 2];
        desc.kind = i % 2 ? CAMBER_TRUTH_OVER : CAMBER_TRUTH_UNION;
        float *truth = sample->truths[desc.kind] = calloc(area_of(&sample->window), sizeof *truth);
        if (!truth || !camber_truth_make(&desc, sample->window, truth)) {
            camber_samples_free(samples);
            return CAMBER_ERROR_MEMORY;
        }
    }
    return CAMBER_OK;
}

void camber_samples_free(camber_samples *samples) {
    for (size_t i = 0; i < 2 * samples->count; i++)
        free(samples->list[i / 2].truths[i % 2]);
    free(samples->list);
    *samples = (camber_samples){0};
}

/* ---- Comparing ---- */

/* Leaves out pixels that are fully covered in both, so that the inside of a wide stroke does not count as agreement. */
static camber_difference compare_edges(float *truth, uint8_t *drawn, size_t count) {
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        if (drawn[i] == 255 && truth[i] >= 1)
            continue;
        truth[kept] = truth[i];
        drawn[kept++] = drawn[i];
    }
    return camber_difference_of(truth, drawn, kept);
}

static camber_pixel_error error_of(const camber_difference *sum, size_t windows) {
    const double pixels = sum->touched ? (double)sum->touched : 1;
    const camber_pixel_bounds of = {camber_difference_mean(sum), (double)sum->past_16 / pixels,
                                    (double)sum->past_64 / pixels};
    return (camber_pixel_error){of, windows, sum->touched, sum->max};
}

void camber_sample_cut(const camber_sample *sample, const uint8_t *picture, size_t width, uint8_t *levels) {
    const camber_window *w = &sample->window;
    for (int y = 0; y < w->height; y++)
        memcpy(levels + y * w->width, picture + (size_t)(w->y0 + y) * width + (size_t)w->x0, (size_t)w->width);
}

void camber_samples_compare(const camber_samples *samples, camber_truth_kind kind, const uint8_t *levels, size_t width,
                            camber_pixel_error *error, size_t *worst) {
    camber_difference sum = {0};
    double worst_sum = -1;
    float truth[SIDE_PX * SIDE_PX];
    uint8_t drawn[SIDE_PX * SIDE_PX] = {0};
    for (size_t i = 0; i < samples->count; i++) {
        const camber_sample *sample = &samples->list[i];
        const size_t area = area_of(&sample->window);
        memcpy(truth, sample->truths[kind], area * sizeof *truth);
        camber_sample_cut(sample, levels, width, drawn);
        for (size_t k = 0; k < area && samples->fills; k++) {
            const float *one = sample->truths[CAMBER_TRUTH_UNION] + k, *other = sample->truths[CAMBER_TRUTH_OVER] + k;
            truth[k] = fminf(fmaxf((float)drawn[k] / 255.0f, fminf(*one, *other)), fmaxf(*one, *other));
        }
        const camber_difference difference = compare_edges(truth, drawn, area);
        camber_difference_add(&sum, &difference);
        if (difference.sum > worst_sum) {
            worst_sum = difference.sum;
            *worst = i;
        }
    }
    *error = error_of(&sum, samples->count);
}

camber_status camber_pictures_compare(const uint8_t *first, const uint8_t *second, size_t width, size_t height,
                                      camber_pixel_error *error) {
    camber_difference sum = {0};
    float *truth = calloc(width, sizeof *truth);
    uint8_t *drawn = calloc(width, 1);
    for (size_t y = 0; y < height && truth && drawn; y++) {
        for (size_t x = 0; x < width; x++)
            truth[x] = (float)first[y * width + x] / 255.0f;
        memcpy(drawn, second + y * width, width);
        const camber_difference difference = compare_edges(truth, drawn, width);
        camber_difference_add(&sum, &difference);
    }
    const bool made = truth && drawn;
    free(drawn);
    free(truth);
    if (!made)
        return CAMBER_ERROR_MEMORY;
    *error = error_of(&sum, 0);
    return CAMBER_OK;
}
