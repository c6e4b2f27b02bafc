/* Computes the truth about networks without the kernels' methods: projects each point in double precision, keeps the
 * points whose importance requires it, and says which points must be in the projected polylines, and where. */
#define _XOPEN_SOURCE 700 /* M_PI */

#include "validate/network_truth.h"

#include <math.h>
#include <stdlib.h>

static const double LONGEST_PX = 128; /* longest piece of a segment, a bit longer than half a picture's window */

/* A point that the camera keeps. */
typedef struct seen_point {
    double x, y; /* px */
    uint32_t point;
} seen_point;

typedef struct projector {
    const camber_network_desc *network;
    const camber_camera *camera;
    double x0, y0, step; /* in world coordinates */
    double cosine, sine;
    double least, most_x, most_y; /* px: bounds at which lines are cut */
    seen_point *points;           /* as many as the longest polyline has */
    size_t run_count;
    camber_projected *made;
    bool failed; /* memory is exhausted */
} projector;

/* ---- Coordinates ---- */

static bool is_number(const camber_network_desc *from, const camber_network_entry *entry, size_t i) {
    return isfinite(from->points[2 * i] + entry->shift_x) && isfinite(from->points[2 * i + 1]);
}

/* Finds the bounding box of all points and the longest polyline. */
static size_t measure(projector *p) {
    const camber_network_desc *from = p->network;
    double x1 = -INFINITY, y1 = -INFINITY;
    size_t longest = 0;
    p->x0 = p->y0 = INFINITY;
    for (size_t e = 0; e < from->entry_count; e++) {
        const camber_network_entry *entry = from->entries + e;
        const size_t first = from->offsets[entry->polyline], end = from->offsets[entry->polyline + 1];
        longest = end - first > longest ? end - first : longest;
        for (size_t i = first; i < end; i++) {
            if (!is_number(from, entry, i))
                continue;
            const double x = from->points[2 * i] + entry->shift_x, y = from->points[2 * i + 1];
            p->x0 = fmin(p->x0, x), x1 = fmax(x1, x);
            p->y0 = fmin(p->y0, y), y1 = fmax(y1, y);
        }
    }
    const double extent = fmax(x1 - p->x0, y1 - p->y0);
    p->step = fmax(extent, 1e-30) / 2147483646.0;
    return longest;
}

static seen_point project(const projector *p, double x, double y, uint32_t point) {
    const camber_camera *c = p->camera;
    const double dx = (p->x0 + floor((x - p->x0) / p->step + 0.5) * p->step - c->x) * c->scale_px;
    const double dy = (p->y0 + floor((y - p->y0) / p->step + 0.5) * p->step - c->y) * c->scale_px;
    return (seen_point){dx * p->cosine + dy * p->sine + 0.5 * c->width, dy * p->cosine - dx * p->sine + 0.5 * c->height,
                        point};
}

/* ---- Output ---- */

static void put(projector *p, double x, double y, uint32_t point) {
    camber_projected *made = p->made;
    if (made->lines.point_count == made->capacity && !p->failed) {
        const size_t capacity = 2 * made->capacity + 256;
        float *points = realloc(made->lines.points, 2 * capacity * sizeof *points);
        made->lines.points = points ? points : made->lines.points;
        uint32_t *places = realloc(made->places, capacity * sizeof *places);
        made->places = places ? places : made->places;
        p->failed = !points || !places;
        made->capacity = p->failed ? made->capacity : capacity;
    }
    if (p->failed)
        return;
    made->lines.points[2 * made->lines.point_count] = (float)x;
    made->lines.points[2 * made->lines.point_count + 1] = (float)y;
    made->places[made->lines.point_count++] = point;
}

/* Restricts the part of a segment, which goes from start to start + delta, to the range between the bounds. */
static void clip(double start, double delta, double least, double most, double part[2]) {
    if (delta == 0) {
        if (start < least || start > most)
            part[1] = -1;
        return;
    }
    const double to_least = (least - start) / delta, to_most = (most - start) / delta;
    part[0] = fmax(part[0], fmin(to_least, to_most));
    part[1] = fmin(part[1], fmax(to_least, to_most));
}

static bool is_outside(const projector *p, const seen_point *at) {
    return at->x < p->least || at->x > p->most_x || at->y < p->least || at->y > p->most_y;
}

/* Adds the part of a segment that is near the picture. open: the line before continues here. Returns whether the next
 * segment continues at its end. */
static bool put_segment(projector *p, const seen_point *a, const seen_point *b, bool open) {
    const double dx = b->x - a->x, dy = b->y - a->y;
    double part[2] = {0, 1};
    clip(a->x, dx, p->least, p->most_x, part);
    clip(a->y, dy, p->least, p->most_y, part);
    if (!(part[0] <= part[1]))
        return false;
    const camber_lines *lines = &p->made->lines;
    if (!open) {
        if (lines->point_count > lines->offsets[lines->polyline_count])
            put(p, NAN, NAN, a->point);
        put(p, a->x + dx * part[0], a->y + dy * part[0], a->point);
    }
    const double count = ceil(hypot(dx, dy) * (part[1] - part[0]) / LONGEST_PX);
    for (double i = 1; i < count; i++) {
        const double t = part[0] + (part[1] - part[0]) * i / count;
        put(p, a->x + dx * t, a->y + dy * t, a->point);
    }
    if (part[1] < 1)
        put(p, a->x + dx * part[1], a->y + dy * part[1], a->point);
    else
        put(p, b->x, b->y, b->point);
    return part[1] >= 1;
}

/* Adds a polyline between invalid points. A ring that is cut still begins at its start, because its seam is a join. */
static void put_line(projector *p, bool ring) {
    const size_t count = p->run_count, segments = count ? count - 1 : 0;
    const camber_lines *lines = &p->made->lines;
    size_t start = 0;
    while (ring && start < segments && !is_outside(p, p->points + start))
        start++;
    start = start == segments ? 0 : start;
    bool open = false;
    for (size_t i = 0; i < segments; i++) {
        const seen_point *a = p->points + (start + i) % segments;
        open = put_segment(p, a, a + 1, open);
    }
    if (count != 1 || is_outside(p, p->points))
        return;
    if (lines->point_count > lines->offsets[lines->polyline_count])
        put(p, NAN, NAN, p->points->point);
    put(p, p->points->x, p->points->y, p->points->point);
}

static void put_entry(projector *p, const camber_network_entry *entry) {
    const camber_network_desc *from = p->network;
    const size_t begin = from->offsets[entry->polyline], end = from->offsets[entry->polyline + 1];
    const double tolerance = (double)(float)(p->camera->simplify_px / p->camera->scale_px);
    const double *first = from->points + 2 * begin, *last = first + 2 * (end - begin) - 2;
    bool ring = !from->keep_open && end - begin > 2 && first[0] == last[0] && first[1] == last[1];
    for (size_t i = begin; i < end && ring; i++)
        ring = is_number(from, entry, i);
    p->run_count = 0;
    for (size_t i = begin; i < end; i++) {
        if (!is_number(from, entry, i)) {
            put_line(p, ring);
            p->run_count = 0;
            continue;
        }
        const bool ends =
            i == begin || i + 1 == end || !is_number(from, entry, i - 1) || !is_number(from, entry, i + 1);
        if (ends || (double)from->importance[i] >= tolerance)
            p->points[p->run_count++] =
                project(p, from->points[2 * i] + entry->shift_x, from->points[2 * i + 1], (uint32_t)(i - begin));
    }
    put_line(p, ring);
}

bool camber_projected_make(const camber_network_desc *network, const camber_camera *camera, double margin_px,
                           camber_projected *made) {
    const double angle = camera->bearing_deg * M_PI / 180;
    projector p = {.network = network,
                   .camera = camera,
                   .cosine = cos(angle),
                   .sine = sin(angle),
                   .least = -margin_px,
                   .most_x = camera->width + margin_px,
                   .most_y = camera->height + margin_px,
                   .made = made};
    *made = (camber_projected){0};
    p.points = calloc(measure(&p) + 1, sizeof *p.points);
    made->lines.offsets = calloc(network->entry_count + 1, sizeof *made->lines.offsets);
    made->rows = calloc(network->entry_count + 1, sizeof *made->rows);
    p.failed = !p.points || !made->lines.offsets || !made->rows;
    for (size_t e = 0; e < network->entry_count && !p.failed; e++) {
        made->rows[e] = network->entries[e].row;
        put_entry(&p, network->entries + e);
        made->lines.offsets[++made->lines.polyline_count] = (uint32_t)made->lines.point_count;
    }
    free(p.points);
    if (p.failed)
        camber_projected_free(made);
    return !p.failed;
}

void camber_projected_free(camber_projected *made) {
    free(made->lines.points);
    free(made->lines.offsets);
    free(made->rows);
    free(made->places);
    *made = (camber_projected){0};
}
