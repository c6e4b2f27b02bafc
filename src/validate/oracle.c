/* A stroke is a list of shapes, each an intersection of half-planes and a disc. Each pixel has 16 x 16 samples, one bit
 * each. A shape sets the bits of the samples inside it. */
#include "validate/oracle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 16, SAMPLES = SIDE * SIDE, PLANES_MAX = 4 };

/* An intersection of half-planes a x + b y <= c, and of a disc if radius > 0. Every part of a stroke is one. */
typedef struct shape {
    double planes[PLANES_MAX][3];
    int plane_count;
    double x, y, radius;             /* of the disc */
    double left, top, right, bottom; /* bounds */
} shape;

typedef struct vec {
    double x, y;
} vec;

bool camber_oracle_open(camber_oracle_window *window, int x0, int y0, int width, int height) {
    *window = (camber_oracle_window){x0, y0, width, height, NULL};
    window->pixels = calloc((size_t)width * (size_t)height, sizeof *window->pixels);
    return window->pixels != NULL;
}

void camber_oracle_clear(camber_oracle_window *window) {
    memset(window->pixels, 0, (size_t)window->width * (size_t)window->height * sizeof *window->pixels);
}

void camber_oracle_close(camber_oracle_window *window) {
    free(window->pixels);
    window->pixels = NULL;
}

static int count_bits(uint64_t bits) {
    bits -= bits >> 1 & 0x5555555555555555u;
    bits = (bits & 0x3333333333333333u) + (bits >> 2 & 0x3333333333333333u);
    return (int)(((bits + (bits >> 4)) & 0x0f0f0f0f0f0f0f0fu) * 0x0101010101010101u >> 56);
}

double camber_oracle_coverage(const camber_oracle_window *window, int column, int row) {
    const camber_oracle_sample_set *set = window->pixels + (size_t)row * (size_t)window->width + (size_t)column;
    int count = 0;
    for (int i = 0; i < 4; i++)
        count += count_bits(set->bits[i]);
    return count / (double)SAMPLES;
}

/* Sample (i, j) of a pixel is in cell (i, j) of 16 x 16. Its position within the cell, in 16ths, is j with its bits
 * reversed. It differs from cell to cell, so that edges parallel to an axis give 256 different levels instead of 16. */
static double sample_at(int i, int j) {
    static const double reversed[SIDE] = {0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
    return (i + (reversed[j] + 0.5) / SIDE) / SIDE;
}

/* Returns the distance of a half-plane's edge from the middle of a pixel, in units of `reach`: below -1 the pixel is
 * inside, above 1 outside. */
static double plane_at(const double *plane, double x, double y) {
    const double reach = 0.5 * (fabs(plane[0]) + fabs(plane[1]));
    return (plane[0] * x + plane[1] * y - plane[2]) / reach;
}

/* Returns the same for the edge of a disc. */
static double disc_at(const shape *s, double x, double y) {
    return s->radius > 0 ? (hypot(x - s->x, y - s->y) - s->radius) / 0.7072 : -INFINITY;
}

static double larger(double a, double b) {
    return a > b ? a : b;
}

/* Returns -1 if the pixel around x, y is outside, +1 if it is inside, and 0 if it may be partly inside. So the samples
 * of most pixels need not be tested. */
static int pixel_side(const shape *s, double x, double y) {
    double most = disc_at(s, x, y);
    for (int i = 0; i < s->plane_count; i++)
        most = larger(plane_at(s->planes[i], x, y), most); /* not a number: an edge without length */
    return most > 1 ? -1 : most <= -1 ? 1 : 0;
}

/* The positions of a pixel's samples. */
typedef struct sample_places {
    double x[SAMPLES], y[SAMPLES];
} sample_places;

/* Adds the samples of the pixel at x, y that are inside a shape. It runs one test for all samples before the next test,
 * which compilers can vectorise, and skips tests that the whole pixel passes. */
static void cover_pixel(camber_oracle_sample_set *set, const sample_places *at, const shape *s, double x, double y) {
    double outside[SAMPLES]; /* above 0: outside */
    for (int k = 0; k < SAMPLES; k++)
        outside[k] = -1;
    for (int i = 0; i < s->plane_count; i++) {
        const double *p = s->planes[i];
        if (plane_at(p, x + 0.5, y + 0.5) > -1)
            for (int k = 0; k < SAMPLES; k++)
                outside[k] = larger(p[0] * (x + at->x[k]) + p[1] * (y + at->y[k]) - p[2], outside[k]);
    }
    if (disc_at(s, x + 0.5, y + 0.5) > -1)
        for (int k = 0; k < SAMPLES; k++) {
            const double dx = x + at->x[k] - s->x, dy = y + at->y[k] - s->y;
            outside[k] = larger(dx * dx + dy * dy - s->radius * s->radius, outside[k]);
        }
    for (int k = 0; k < SAMPLES; k += SIDE) {
        uint32_t inside = 0; /* a bit a sample: shifts by constants are vectorised, too */
        for (int i = 0; i < SIDE; i++)
            inside |= (uint32_t)(outside[k + i] <= 0) << i;
        set->bits[k / 64] |= (uint64_t)inside << k % 64;
    }
}

/* In a dense network, most pixels are full long before the last line. */
static bool is_full(const camber_oracle_sample_set *set) {
    return (set->bits[0] & set->bits[1] & set->bits[2] & set->bits[3]) == UINT64_MAX;
}

static void cover(camber_oracle_window *w, const shape *s) {
    sample_places at;
    for (int k = 0; k < SAMPLES; k++) {
        at.x[k] = sample_at(k % SIDE, k / SIDE);
        at.y[k] = sample_at(k / SIDE, k % SIDE);
    }
    const double left = fmax(s->left - w->x0, 0), right = fmin(s->right - w->x0, w->width);
    const double top = fmax(s->top - w->y0, 0), bottom = fmin(s->bottom - w->y0, w->height);
    for (int row = (int)floor(top); row < bottom; row++)
        for (int column = (int)floor(left); column < right; column++) {
            camber_oracle_sample_set *set = w->pixels + (size_t)row * (size_t)w->width + (size_t)column;
            const double x = w->x0 + column, y = w->y0 + row;
            if (is_full(set))
                continue;
            const int side = pixel_side(s, x + 0.5, y + 0.5);
            if (side > 0)
                memset(set, 0xff, sizeof *set);
            else if (side == 0)
                cover_pixel(set, &at, s, x, y);
        }
}

/* Covers a convex polygon, with its corners in either direction. */
static void cover_polygon(camber_oracle_window *w, const vec *corners, int count) {
    shape s = {.plane_count = count, .left = INFINITY, .top = INFINITY, .right = -INFINITY, .bottom = -INFINITY};
    double area = 0;
    for (int i = 0; i < count; i++) {
        const vec p = corners[i], q = corners[(i + 1) % count];
        area += p.x * q.y - q.x * p.y;
        s.left = fmin(s.left, p.x), s.right = fmax(s.right, p.x);
        s.top = fmin(s.top, p.y), s.bottom = fmax(s.bottom, p.y);
    }
    for (int i = 0; i < count; i++) {
        const vec p = corners[i], q = corners[(i + 1) % count];
        const double sign = area < 0 ? -1 : 1;
        s.planes[i][0] = sign * (q.y - p.y);
        s.planes[i][1] = sign * (p.x - q.x);
        s.planes[i][2] = s.planes[i][0] * p.x + s.planes[i][1] * p.y;
    }
    if (area != 0)
        cover(w, &s);
}

/* Covers the part of a disc for which (p - centre) . a <= 0 and (p - centre) . b <= 0. */
static void cover_sector(camber_oracle_window *w, vec centre, double radius, vec a, vec b) {
    const shape s = {
        .planes = {{a.x, a.y, a.x * centre.x + a.y * centre.y}, {b.x, b.y, b.x * centre.x + b.y * centre.y}},
        .plane_count = 2,
        .x = centre.x,
        .y = centre.y,
        .radius = radius,
        .left = centre.x - radius,
        .top = centre.y - radius,
        .right = centre.x + radius,
        .bottom = centre.y + radius};
    cover(w, &s);
}

static vec step(vec p, vec direction, double length) {
    return (vec){p.x + direction.x * length, p.y + direction.y * length};
}

static vec direction_of(vec p, vec q) {
    const double length = hypot(q.x - p.x, q.y - p.y);
    return (vec){(q.x - p.x) / length, (q.y - p.y) / length};
}

/* Covers the cap beyond the end of a segment with direction u. */
static void cover_cap(camber_oracle_window *w, vec end, vec u, const camber_oracle_style *style) {
    const double h = style->width_px / 2;
    const vec normal = {-u.y, u.x}, back = {-u.x, -u.y};
    if (style->cap == CAMBER_CAP_ROUND) {
        cover_sector(w, end, h, back, back);
    } else if (style->cap == CAMBER_CAP_SQUARE) {
        const vec l = step(end, normal, h), r = step(end, normal, -h);
        cover_polygon(w, (vec[]){l, step(l, u, h), step(r, u, h), r}, 4);
    }
}

static void cover_join(camber_oracle_window *w, vec point, vec u, vec v, const camber_oracle_style *style) {
    const double h = style->width_px / 2, turn = atan2(u.x * v.y - u.y * v.x, u.x * v.x + u.y * v.y);
    /* y points down, so a positive turn is to the right, and its outer side is the left, -normal */
    const double outer = turn > 0 ? -h : h;
    const vec in = step(point, (vec){-u.y, u.x}, outer), out = step(point, (vec){-v.y, v.x}, outer);
    if (turn == 0)
        return;
    const bool is_round = style->join == CAMBER_JOIN_ROUND && style->round_limit * cos(turn / 2) <= 1;
    if (is_round)
        cover_sector(w, point, h, (vec){-u.x, -u.y}, v);
    else if (style->join != CAMBER_JOIN_BEVEL && 1 <= style->miter_limit * cos(turn / 2))
        cover_polygon(w, (vec[]){point, in, step(in, u, h * tan(fabs(turn) / 2)), out}, 4);
    else
        cover_polygon(w, (vec[]){point, in, out}, 3);
}

static void cover_segment(camber_oracle_window *w, vec a, vec b, double h) {
    const vec u = direction_of(a, b), normal = {-u.y, u.x};
    cover_polygon(w, (vec[]){step(a, normal, h), step(b, normal, h), step(b, normal, -h), step(a, normal, -h)}, 4);
}

bool camber_oracle_stroke(camber_oracle_window *window, const float *points, size_t count,
                          const camber_oracle_style *style) {
    vec *p = malloc((count + 1) * sizeof *p);
    size_t n = 0;
    if (!p)
        return false;
    for (size_t i = 0; i < count; i++) {
        const vec q = {points[2 * i], points[2 * i + 1]};
        if (n == 0 || q.x != p[n - 1].x || q.y != p[n - 1].y)
            p[n++] = q;
    }
    const bool closed = style->closed && n > 2 && p[0].x == p[n - 1].x && p[0].y == p[n - 1].y;
    for (size_t i = 0; i + 1 < n; i++)
        cover_segment(window, p[i], p[i + 1], style->width_px / 2);
    for (size_t i = 1; i + 1 < n; i++)
        cover_join(window, p[i], direction_of(p[i - 1], p[i]), direction_of(p[i], p[i + 1]), style);
    if (n == 1) {
        cover_cap(window, p[0], (vec){1, 0}, style);
        cover_cap(window, p[0], (vec){-1, 0}, style);
    } else if (closed) {
        cover_join(window, p[0], direction_of(p[n - 2], p[n - 1]), direction_of(p[0], p[1]), style);
    } else if (n > 1) {
        cover_cap(window, p[0], direction_of(p[1], p[0]), style);
        cover_cap(window, p[n - 1], direction_of(p[n - 2], p[n - 1]), style);
    }
    free(p);
    return true;
}

/* ---- Areas ---- */

typedef struct crossing {
    int sample; /* of the row: the first sample to the right of the crossing */
    int winding;
} crossing;

/* Edges, sorted by the row of pixels in which they begin, as indices of their first points. */
typedef struct edge_rows {
    size_t *first; /* height + 1 of them */
    size_t *edges;
    size_t *active; /* edges that reach into the current row */
    size_t active_count;
    crossing *crossings;
} edge_rows;

/* Returns the first row of pixels that an edge touches; height if there is none. */
static int first_row_of(const float *p, int height) {
    const double top = fmin((double)p[1], (double)p[3]), bottom = fmax((double)p[1], (double)p[3]);
    return bottom <= 0 || top >= height || top == bottom ? height : top < 0 ? 0 : (int)top;
}

/* Counts edges by row, or puts them at the positions that the counts determine. */
static void sort_edges(const camber_lines *rings, int height, edge_rows *rows, bool put) {
    for (size_t k = 0; k < rings->polyline_count; k++)
        for (size_t i = rings->offsets[k]; i + 1 < rings->offsets[k + 1]; i++) {
            const int row = first_row_of(rings->points + 2 * i, height);
            if (row < height && put)
                rows->edges[rows->first[row]++] = i;
            else if (row < height)
                rows->first[row + 1]++;
        }
}

static bool open_edges(const camber_lines *rings, int height, edge_rows *rows) {
    rows->first = calloc((size_t)height + 2, sizeof *rows->first);
    rows->edges = malloc((rings->point_count + 1) * sizeof *rows->edges);
    rows->active = malloc((rings->point_count + 1) * sizeof *rows->active);
    rows->crossings = malloc((rings->point_count + 1) * sizeof *rows->crossings);
    if (!rows->first || !rows->edges || !rows->active || !rows->crossings)
        return false;
    sort_edges(rings, height, rows, false);
    for (int row = 0; row < height; row++)
        rows->first[row + 1] += rows->first[row];
    sort_edges(rings, height, rows, true);
    for (int row = height; row > 0; row--)
        rows->first[row] = rows->first[row - 1];
    rows->first[0] = 0;
    return true;
}

static void close_edges(edge_rows *rows) {
    free(rows->first);
    free(rows->edges);
    free(rows->active);
    free(rows->crossings);
}

static int compare_crossings(const void *a, const void *b) {
    return ((const crossing *)a)->sample - ((const crossing *)b)->sample;
}

/* Finds where the current edges cross a row of samples, whose first sample is at x = start, from left to right. */
static size_t cross_row(const camber_lines *rings, edge_rows *rows, double y, double start, int samples) {
    size_t count = 0;
    for (size_t i = 0; i < rows->active_count; i++) {
        const float *p = rings->points + 2 * rows->active[i];
        const double x0 = (double)p[0], y0 = (double)p[1], x1 = (double)p[2], y1 = (double)p[3];
        if ((y0 <= y) == (y1 <= y))
            continue;
        const double x = x0 + (y - y0) / (y1 - y0) * (x1 - x0), sample = ceil((x - start) * SIDE);
        const int at = sample < 0 ? 0 : sample > samples ? samples : (int)sample;
        rows->crossings[count++] = (crossing){at, y1 > y0 ? 1 : -1};
    }
    qsort(rows->crossings, count, sizeof *rows->crossings, compare_crossings);
    return count;
}

/* Adds samples [first, end) of a row to the shares of their pixels, `times` times. */
static void add_samples(float *shares, int first, int end, int times) {
    const float one = (float)times / SAMPLES;
    while (first < end) {
        const int pixel = first / SIDE, next = (pixel + 1) * SIDE < end ? (pixel + 1) * SIDE : end;
        shares[pixel] += one * (float)(next - first);
        first = next;
    }
}

static void fill_row(const camber_lines *rings, edge_rows *rows, camber_oracle_rule rule, int width, int row,
                     float *shares) {
    size_t kept = 0;
    for (size_t i = 0; i < rows->active_count; i++) {
        const float *p = rings->points + 2 * rows->active[i];
        if (fmaxf(p[1], p[3]) > (float)row)
            rows->active[kept++] = rows->active[i];
    }
    for (size_t i = rows->first[row]; i < rows->first[row + 1]; i++)
        rows->active[kept++] = rows->edges[i];
    rows->active_count = kept;
    for (int k = 0; k < SIDE; k++) {
        /* in each row, the samples have another position in their columns, so that vertical edges give 256 levels */
        const size_t count = cross_row(rings, rows, row + (k + 0.5) / SIDE, sample_at(0, k), width * SIDE);
        int winding = 0;
        for (size_t i = 0; i < count; i++) {
            winding += rows->crossings[i].winding;
            const int times = rule == CAMBER_ORACLE_SUM       ? winding
                              : rule == CAMBER_ORACLE_EVENODD ? winding % 2 != 0
                                                              : winding != 0;
            if (times)
                add_samples(shares, rows->crossings[i].sample,
                            i + 1 < count ? rows->crossings[i + 1].sample : width * SIDE, times);
        }
    }
}

bool camber_oracle_fill(const camber_lines *rings, camber_oracle_rule rule, int width, int height, float *shares) {
    edge_rows rows = {.active_count = 0};
    const bool done = open_edges(rings, height, &rows);
    memset(shares, 0, (size_t)width * (size_t)height * sizeof *shares);
    for (int row = 0; row < height && done; row++)
        fill_row(rings, &rows, rule, width, row, shares + (size_t)row * (size_t)width);
    close_edges(&rows);
    return done;
}
