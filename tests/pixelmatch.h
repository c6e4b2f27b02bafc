/* The measure of npm's pixelmatch: pixels that differ in YIQ by more than a threshold, those apart that are
 * anti-aliased in either picture. Pictures are straight RGBA over white. */
#ifndef CAMBER_TESTS_PIXELMATCH_H
#define CAMBER_TESTS_PIXELMATCH_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

typedef struct pixelmatch_pair {
    const uint8_t *a, *b; /* width * height * 4 */
    int width, height;
    uint8_t *difference; /* the same size: red counts, yellow is anti-aliased. NULL: not wanted */
} pixelmatch_pair;

static inline double pixelmatch_over_white(const uint8_t *pixel, int channel) {
    return 255.0 + (pixel[channel] - 255.0) * pixel[3] / 255.0;
}

static inline void pixelmatch_yiq(const uint8_t *pixel, double yiq[3]) {
    const double r = pixelmatch_over_white(pixel, 0), g = pixelmatch_over_white(pixel, 1),
                 b = pixelmatch_over_white(pixel, 2);
    yiq[0] = r * 0.29889531 + g * 0.58662247 + b * 0.11448223;
    yiq[1] = r * 0.59597799 - g * 0.27417610 - b * 0.32180189;
    yiq[2] = r * 0.21147017 - g * 0.52261711 + b * 0.31114694;
}

static inline double pixelmatch_delta(const uint8_t *p, const uint8_t *q) {
    double a[3], b[3];
    pixelmatch_yiq(p, a);
    pixelmatch_yiq(q, b);
    const double y = a[0] - b[0], i = a[1] - b[1], o = a[2] - b[2];
    return 0.5053 * y * y + 0.299 * i * i + 0.1957 * o * o;
}

static inline double pixelmatch_brightness(const uint8_t *p, const uint8_t *q) {
    double a[3], b[3];
    pixelmatch_yiq(p, a);
    pixelmatch_yiq(q, b);
    return a[0] - b[0];
}

/* The neighbours of a pixel inside the picture. */
typedef struct pixelmatch_square {
    int x0, y0, x1, y1;
    int equal; /* 1 at the picture's border */
} pixelmatch_square;

static inline pixelmatch_square pixelmatch_around(const pixelmatch_pair *pair, int x, int y) {
    pixelmatch_square s = {x > 0 ? x - 1 : 0, y > 0 ? y - 1 : 0, x + 1 < pair->width ? x + 1 : x,
                           y + 1 < pair->height ? y + 1 : y, 0};
    s.equal = x == s.x0 || x == s.x1 || y == s.y0 || y == s.y1;
    return s;
}

/* Whether more than two of a pixel's neighbours are equal to it. */
static inline bool pixelmatch_is_flat(const pixelmatch_pair *pair, const uint8_t *rgba, int x, int y) {
    const pixelmatch_square s = pixelmatch_around(pair, x, y);
    const uint8_t *centre = rgba + 4 * ((ptrdiff_t)y * pair->width + x);
    int equal = s.equal;
    for (int i = s.x0; i <= s.x1; i++)
        for (int j = s.y0; j <= s.y1; j++)
            if ((i != x || j != y) && memcmp(centre, rgba + 4 * ((ptrdiff_t)j * pair->width + i), 4) == 0)
                equal++;
    return equal > 2;
}

/* A pixel between a darker and a brighter neighbour, one of which lies in a flat part of both pictures. */
static inline bool pixelmatch_is_smooth(const pixelmatch_pair *pair, const uint8_t *rgba, int x, int y) {
    const pixelmatch_square s = pixelmatch_around(pair, x, y);
    const uint8_t *centre = rgba + 4 * ((ptrdiff_t)y * pair->width + x);
    double least = 0, most = 0;
    int dark[2] = {0, 0}, bright[2] = {0, 0}, equal = s.equal;
    for (int i = s.x0; i <= s.x1; i++)
        for (int j = s.y0; j <= s.y1; j++) {
            if (i == x && j == y)
                continue;
            const double d = pixelmatch_brightness(centre, rgba + 4 * ((ptrdiff_t)j * pair->width + i));
            if (!(d < 0) && !(d > 0) && ++equal > 2)
                return false;
            if (d < least) {
                least = d;
                dark[0] = i, dark[1] = j;
            } else if (d > most) {
                most = d;
                bright[0] = i, bright[1] = j;
            }
        }
    if (!(least < 0) || !(most > 0))
        return false;
    return (pixelmatch_is_flat(pair, pair->a, dark[0], dark[1]) &&
            pixelmatch_is_flat(pair, pair->b, dark[0], dark[1])) ||
           (pixelmatch_is_flat(pair, pair->a, bright[0], bright[1]) &&
            pixelmatch_is_flat(pair, pair->b, bright[0], bright[1]));
}

static inline size_t pixelmatch_count(const pixelmatch_pair *pair, double threshold) {
    const double most = 35215.0 * threshold * threshold;
    size_t count = 0;
    for (int y = 0; y < pair->height; y++)
        for (int x = 0; x < pair->width; x++) {
            const ptrdiff_t at = 4 * ((ptrdiff_t)y * pair->width + x);
            uint8_t shown[4] = {0, 0, 0, 255};
            memset(shown, (int)(230 + pixelmatch_over_white(pair->a + at, 1) / 10.2), 3);
            if (pixelmatch_delta(pair->a + at, pair->b + at) > most) {
                const bool smooth =
                    pixelmatch_is_smooth(pair, pair->a, x, y) || pixelmatch_is_smooth(pair, pair->b, x, y);
                memcpy(shown, smooth ? (uint8_t[]){255, 220, 0, 255} : (uint8_t[]){255, 0, 0, 255}, 4);
                count += !smooth;
            }
            if (pair->difference)
                memcpy(pair->difference + at, shown, 4);
        }
    return count;
}

#endif
