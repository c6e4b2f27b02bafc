#include "core.h"

#include "sheet.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_PX = 2048, POINTS_MAX = 1 << 17, FIGURES_MAX = 1 << 14 };

/* A figure on the picture; its twin's window lies to the right of its own. */
typedef struct placed {
    camber_oracle_style style;
    tally *tally, *twin_tally;
    int x, y, width, height; /* px, of its window */
    size_t first_point, point_count;
    char label[64];
} placed;

struct sheet {
    camber_context *context;
    camber_surface *surface;
    camber_device *device;
    camber_renderer *renderer;
    camber_mesh *mesh;
    camber_method method;
    float *points;
    size_t point_count;
    placed *figures;
    size_t figure_count;
    size_t polyline_count; /* more than figures where these have twins */
    uint32_t *offsets, *rows;
    camber_stroke *strokes;
    camber_paint *paints;
    uint8_t *picture;
    int shelf_x, shelf_y, shelf_height;
    bool white_on_black;
};

static void print_log(void *user, camber_log_level level, const char *message) {
    (void)user;
    if (level == CAMBER_LOG_ERROR)
        printf("# %s\n", message);
}

static void *must(void *block) {
    if (!block)
        abort();
    return block;
}

bool sheet_open(camber_method method, sheet **opened) {
    sheet *s = must(calloc(1, sizeof *s));
    const camber_context_desc desc = {.log = print_log};
    s->method = method;
    s->points = must(malloc(POINTS_MAX * 2 * sizeof *s->points));
    s->figures = must(malloc(FIGURES_MAX * sizeof *s->figures));
    s->offsets = must(calloc(2 * FIGURES_MAX + 1, sizeof *s->offsets));
    s->rows = must(malloc(2 * FIGURES_MAX * sizeof *s->rows));
    s->strokes = must(malloc(FIGURES_MAX * sizeof *s->strokes));
    s->paints = must(malloc(FIGURES_MAX * sizeof *s->paints));
    s->picture = must(malloc((size_t)SIDE_PX * SIDE_PX * 4));
    *opened = s;
    return camber_context_create(&desc, &s->context) == CAMBER_OK &&
           (draws_in_cl() || camber_surface_create(s->context, NULL, &s->surface) == CAMBER_OK) &&
           camber_device_create(s->context, NULL, s->surface, &s->device) == CAMBER_OK &&
           camber_renderer_create(s->device, s->surface,
                                  &(camber_renderer_desc){.draw = draws_in_cl() ? CAMBER_DRAW_CL : CAMBER_DRAW_GL},
                                  &s->renderer) == CAMBER_OK &&
           camber_mesh_create(s->device, s->renderer, &s->mesh) == CAMBER_OK;
}

void sheet_close(sheet *s) {
    camber_mesh_destroy(s->mesh);
    camber_renderer_destroy(s->renderer);
    camber_device_destroy(s->device);
    camber_surface_destroy(s->surface);
    camber_context_destroy(s->context);
    free(s->points);
    free(s->figures);
    free(s->offsets);
    free(s->rows);
    free(s->strokes);
    free(s->paints);
    free(s->picture);
    free(s);
}

/* Adds points of a polyline in a window whose corner left, top is to lie at x, y. */
static void add_polyline(sheet *s, const float *points, size_t count, double x, double y) {
    for (size_t i = 0; i < count; i++) {
        s->points[2 * s->point_count] = (float)(points[2 * i] + x);
        s->points[2 * s->point_count++ + 1] = (float)(points[2 * i + 1] + y);
    }
    s->rows[s->polyline_count] = (uint32_t)s->figure_count;
    s->offsets[++s->polyline_count] = (uint32_t)s->point_count;
}

void sheet_add(sheet *s, const figure *f) {
    const camber_oracle_style *style = &f->style;
    /* A square cap reaches sqrt(2) half widths, a miter its limit; two pixels more show what is drawn beside. */
    const double reach = style->width_px / 2 * fmax(1.5, style->join == CAMBER_JOIN_MITER ? style->miter_limit : 0) + 2;
    double left = INFINITY, top = INFINITY, right = -INFINITY, bottom = -INFINITY;
    for (size_t i = 0; i < f->point_count; i++) {
        left = fmin(left, f->points[2 * i]), right = fmax(right, f->points[2 * i]);
        top = fmin(top, f->points[2 * i + 1]), bottom = fmax(bottom, f->points[2 * i + 1]);
    }
    left = floor(left - reach), top = floor(top - reach);
    const int width = (int)ceil(right + reach - left), height = (int)ceil(bottom + reach - top);
    const int needed = f->twin_points ? 2 * width : width;
    if (needed > SIDE_PX || height > SIDE_PX || f->point_count + f->twin_count > POINTS_MAX)
        abort();
    if (s->shelf_x + needed > SIDE_PX) {
        s->shelf_y += s->shelf_height;
        s->shelf_x = s->shelf_height = 0;
    }
    if (s->shelf_y + height > SIDE_PX || s->point_count + f->point_count + f->twin_count > POINTS_MAX ||
        s->figure_count == FIGURES_MAX)
        sheet_flush(s);
    placed *p = s->figures + s->figure_count;
    *p = (placed){*style,     f->tally,       f->twin_points ? f->twin_tally : NULL,
                  s->shelf_x, s->shelf_y,     width,
                  height,     s->point_count, f->point_count,
                  {0}};
    snprintf(p->label, sizeof p->label, "%s", f->label);
    add_polyline(s, f->points, f->point_count, p->x - left, p->y - top);
    if (f->twin_points)
        add_polyline(s, f->twin_points, f->twin_count, p->x + width - left, p->y - top);
    s->strokes[s->figure_count] = (camber_stroke){(float)style->width_px, style->join, style->cap,
                                                  (float)style->miter_limit, .round_limit = (float)style->round_limit};
    s->figure_count++;
    s->shelf_x += needed;
    s->shelf_height = height > s->shelf_height ? height : s->shelf_height;
}

static bool keep_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    sheet *s = user;
    memcpy(s->picture + (size_t)first_row * SIDE_PX * 4, rgba, (size_t)row_count * SIDE_PX * 4);
    return true;
}

/* Rings are drawn as such where the figure says so; the others never repeat their first point. */
static camber_status draw(sheet *s) {
    const float ink = s->white_on_black ? 1.0f : 0.0f, paper = 1.0f - ink;
    const camber_polylines_desc desc = {s->points, s->point_count, s->offsets, s->polyline_count, s->rows, false};
    const camber_tessellation_desc tessellation = {s->strokes, s->figure_count, s->method, 0, false};
    camber_polylines *polylines = NULL;
    for (size_t i = 0; i < s->figure_count; i++)
        s->paints[i] = (camber_paint){.width_px = s->strokes[i].width_px, .color = {ink, ink, ink, 1}};
    camber_status status = camber_polylines_create(s->context, &desc, &polylines);
    if (status == CAMBER_OK)
        status = camber_tessellate(s->mesh, polylines, &tessellation);
    if (status == CAMBER_OK) {
        const camber_pass pass = {.mesh = s->mesh, .paints = s->paints, .paint_count = s->figure_count};
        const camber_frame frame = {.width = SIDE_PX,
                                    .height = SIDE_PX,
                                    .background = {paper, paper, paper, 1},
                                    .passes = &pass,
                                    .pass_count = 1};
        status = camber_render(s->renderer, &frame, keep_rows, s, NULL);
    }
    camber_polylines_destroy(polylines);
    return status;
}

/* In 255ths. */
static int coverage_drawn(const sheet *s, int x, int y) {
    const int level = s->picture[4 * ((size_t)y * SIDE_PX + (size_t)x)];
    return s->white_on_black ? level : 255 - level;
}

static void tally_pixel(tally *t, const placed *p, int drawn, int truth, int at) {
    if (!drawn && !truth)
        return;
    const int difference = abs(drawn - truth);
    t->sum += difference;
    t->pixels++;
    t->ink += drawn / 255.0;
    t->true_ink += truth / 255.0;
    if (difference > t->max) {
        t->max = difference;
        snprintf(t->worst, sizeof t->worst, "%s: %d for %d at %d, %d", p->label, drawn, truth, at % p->width,
                 at / p->width);
    }
}

static void compare(const sheet *s, const placed *p) {
    camber_oracle_window window;
    if (!camber_oracle_open(&window, p->x, p->y, p->width, p->height) ||
        !camber_oracle_stroke(&window, s->points + 2 * p->first_point, p->point_count, &p->style))
        abort();
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            const int drawn = coverage_drawn(s, p->x + x, p->y + y);
            const int truth = (int)lrint(camber_oracle_coverage(&window, x, y) * 255), at = y * p->width + x;
            tally_pixel(p->tally, p, drawn, truth, at);
            if (p->twin_tally)
                tally_pixel(p->twin_tally, p, drawn, coverage_drawn(s, p->x + p->width + x, p->y + y), at);
        }
    camber_oracle_close(&window);
}

void sheet_flush(sheet *s) {
    if (s->figure_count && draw(s) != CAMBER_OK)
        abort();
    for (size_t i = 0; i < s->figure_count; i++)
        compare(s, s->figures + i);
    s->figure_count = s->polyline_count = s->point_count = 0;
    s->shelf_x = s->shelf_y = s->shelf_height = 0;
    s->white_on_black = !s->white_on_black;
}

bool tally_check(const tally *t, double mean_bound, int max_bound) {
    const double mean = t->pixels ? t->sum / (double)t->pixels : 0;
    printf("# %-34s %9zu px  mean %6.3f (bound %6.3f)  max %3d (bound %3d)  %s\n", t->name, t->pixels, mean, mean_bound,
           t->max, max_bound, t->worst);
    return t->pixels > 0 && mean <= mean_bound && t->max <= max_bound;
}
