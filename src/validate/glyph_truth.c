/* Makes glyphs that are turned by many angles: a round one with a hole, one with sharp and with inner corners, and a
 * stem with a dot. For each of a pixel's 256 samples, the winding number of the glyph's rings says whether it is
 * inside, and the distance to its nearest edge whether it is in the halo. */
#include "validate/glyph_truth.h"

#include <math.h>

enum { SAMPLES = 16, COLUMNS = 6, ROUND_POINTS = 24 };

static const double PI = 3.14159265358979323846;
/* The distance between glyphs; how far a glyph and its halo reach from its middle. */
static const double STEP_PX = CAMBER_SHEET_SIDE_PX / (double)COLUMNS, REACH_PX = 10.0;

/* Shapes in ems, y down, clockwise as seen. */
static const double hook[] = {-0.3, -0.4, -0.18, -0.4, -0.18, -0.06, 0.12,  -0.32, 0.3,   -0.32, -0.05, -0.02,
                              0.33, 0.4,  0.17,  0.4,  -0.14, 0.06,  -0.18, 0.1,   -0.18, 0.4,   -0.3,  0.4};
static const double stem[] = {-0.05, -0.16, 0.05, -0.16, 0.05, 0.4, -0.05, 0.4};
static const double dot[] = {-0.06, -0.38, 0.06, -0.38, 0.06, -0.26, -0.06, -0.26};
static const double notch[] = {-0.27, -0.32, -0.27, 0.3, -0.21, 0.3, -0.21, -0.32}; /* a hole, counterclockwise */

/* Computes where the middle of a glyph is, px. */
static void find_middle(size_t glyph, double middle[2]) {
    middle[0] = STEP_PX * ((double)(glyph % COLUMNS) + 0.5) + 0.11 * (double)glyph - 2.0;
    middle[1] = STEP_PX * ((double)(glyph / COLUMNS) + 0.5) + 0.07 * (double)(glyph % 7);
}

float camber_glyph_sheet_halo_px(size_t row) {
    static const float widths[CAMBER_SHEET_ROWS] = {1.0f, 1.7f};
    return widths[row];
}

/* A ring that is being written. */
typedef struct ring_writer {
    camber_glyph_sheet *sheet;
    size_t ring_count;
    double middle[2], cosine, sine; /* of the current glyph; its size is in the last two */
} ring_writer;

static void put_point(ring_writer *w, double u, double v) {
    float *to = w->sheet->points + 2 * (size_t)w->sheet->offsets[w->ring_count + 1]++;
    to[0] = (float)(w->middle[0] + w->cosine * u - w->sine * v);
    to[1] = (float)(w->middle[1] + w->sine * u + w->cosine * v);
}

static void begin_ring(ring_writer *w, uint32_t row) {
    w->sheet->rows[w->ring_count] = row;
    w->sheet->offsets[w->ring_count + 1] = w->sheet->offsets[w->ring_count];
}

static void put_ring(ring_writer *w, uint32_t row, const double *shape, size_t count) {
    begin_ring(w, row);
    for (size_t i = 0; i <= count; i++)
        put_point(w, shape[2 * (i % count)], shape[2 * (i % count) + 1]);
    w->ring_count++;
}

/* way: 1 for clockwise, -1 for a hole. */
static void put_ellipse(ring_writer *w, uint32_t row, double a, double b, double way) {
    begin_ring(w, row);
    for (int i = 0; i <= ROUND_POINTS; i++) {
        const double angle = way * 2.0 * PI * (i % ROUND_POINTS) / ROUND_POINTS;
        put_point(w, a * cos(angle), b * sin(angle));
    }
    w->ring_count++;
}

void camber_glyph_sheet_make(camber_glyph_sheet *sheet) {
    ring_writer w = {.sheet = sheet};
    sheet->offsets[0] = 0;
    for (size_t i = 0; i < CAMBER_SHEET_GLYPHS; i++) {
        const double angle = 0.4 * (double)i, size_px = 9.0 + (double)(i % 5);
        const uint32_t row = (uint32_t)i % CAMBER_SHEET_ROWS;
        find_middle(i, w.middle);
        w.cosine = size_px * cos(angle);
        w.sine = size_px * sin(angle);
        if (i % 3 == 0) {
            put_ellipse(&w, row, 0.3, 0.38, 1.0);
            put_ellipse(&w, row, 0.2, 0.29, -1.0);
        } else if (i % 3 == 1) {
            put_ring(&w, row, hook, sizeof hook / sizeof *hook / 2);
            put_ring(&w, row, notch, sizeof notch / sizeof *notch / 2);
        } else {
            put_ring(&w, row, stem, sizeof stem / sizeof *stem / 2);
            put_ring(&w, row, dot, sizeof dot / sizeof *dot / 2);
        }
    }
}

/* ---- Samples ---- */

static double distance_from(const double a[2], const double b[2], const double at[2]) {
    const double dx = b[0] - a[0], dy = b[1] - a[1], px = at[0] - a[0], py = at[1] - a[1];
    const double t = fmin(fmax((px * dx + py * dy) / (dx * dx + dy * dy), 0.0), 1.0);
    return sqrt((px - t * dx) * (px - t * dx) + (py - t * dy) * (py - t * dy));
}

/* Looks at a sample: whether it is inside a glyph, and whether it is in its halo. */
static void look(const camber_glyph_sheet *s, size_t glyph, const double at[2], bool *inside, bool *near) {
    int winding = 0;
    double nearest = INFINITY;
    for (size_t ring = 2 * glyph; ring < 2 * glyph + 2; ring++)
        for (size_t i = s->offsets[ring]; i + 1 < s->offsets[ring + 1]; i++) {
            const double a[] = {(double)s->points[2 * i], (double)s->points[2 * i + 1]};
            const double b[] = {(double)s->points[2 * i + 2], (double)s->points[2 * i + 3]};
            nearest = fmin(nearest, distance_from(a, b, at));
            if ((a[1] <= at[1]) != (b[1] <= at[1]) && a[0] + (at[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) < at[0])
                winding += b[1] > a[1] ? 1 : -1;
        }
    *inside |= winding != 0;
    *near |= winding != 0 || nearest <= (double)camber_glyph_sheet_halo_px(s->rows[2 * glyph]);
}

static void sample_pixel(const camber_glyph_sheet *s, double x, double y, float *inside_share, float *near_share) {
    size_t glyphs[CAMBER_SHEET_GLYPHS], count = 0;
    for (size_t g = 0; g < CAMBER_SHEET_GLYPHS; g++) {
        double middle[2];
        find_middle(g, middle);
        if (fabs(x + 0.5 - middle[0]) < REACH_PX && fabs(y + 0.5 - middle[1]) < REACH_PX)
            glyphs[count++] = g;
    }
    int insides = 0, nears = 0;
    for (int i = 0; i < SAMPLES * SAMPLES && count; i++) {
        const double at[] = {x + (i % SAMPLES + 0.5) / SAMPLES, y + ((double)(i / SAMPLES) + 0.5) / SAMPLES};
        bool inside = false, near = false;
        for (size_t g = 0; g < count; g++)
            look(s, glyphs[g], at, &inside, &near);
        insides += inside;
        nears += near;
    }
    *inside_share = (float)insides / (SAMPLES * SAMPLES);
    *near_share = (float)nears / (SAMPLES * SAMPLES);
}

void camber_glyph_sheet_sample(const camber_glyph_sheet *sheet,
                               float truth[2 * CAMBER_SHEET_SIDE_PX * CAMBER_SHEET_SIDE_PX]) {
    enum { SIDE = CAMBER_SHEET_SIDE_PX };
    for (int i = 0; i < SIDE * SIDE; i++)
        sample_pixel(sheet, i % SIDE, (double)(i / SIDE), truth + i, truth + SIDE * SIDE + i);
}
