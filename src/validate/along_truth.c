/* For each of a pixel's 256 samples, finds the nearest point of the line, called its foot, and takes the colour that
 * the paint has there: the gap between the line's two sides, its blur, dashes, trim, ramp and image. With a pitch, rays
 * give the positions of samples in the plane. Shares no formula with kernels and shaders, nor with
 * src/base/perspective.h. */
#include "validate/along_truth.h"

#include <math.h>

enum { SAMPLES = 16 }; /* in each direction */

/* The nearest point of the line to a sample. */
typedef struct foot {
    double along, distance; /* px */
    bool is_right;          /* the sample is on the right, seen in the line's direction */
    bool is_past;           /* the sample is beyond an end of the line */
} foot;

/* Faster than hypot, which also works for huge numbers and takes several times as long. */
static double length_of(double x, double y) {
    return sqrt(x * x + y * y);
}

double camber_along_length(const float *points, size_t count) {
    double total = 0;
    for (size_t i = 1; i < count; i++)
        total += length_of((double)points[2 * i] - (double)points[2 * i - 2],
                           (double)points[2 * i + 1] - (double)points[2 * i - 1]);
    return total;
}

static foot foot_of(const camber_along_desc *d, double x, double y) {
    foot nearest = {.distance = INFINITY};
    double before = 0;
    for (size_t i = 0; i + 1 < d->count; i++) {
        const double ax = (double)d->points[2 * i], ay = (double)d->points[2 * i + 1];
        const double dx = (double)d->points[2 * i + 2] - ax, dy = (double)d->points[2 * i + 3] - ay;
        const double length = length_of(dx, dy), at = ((x - ax) * dx + (y - ay) * dy) / length;
        const double within = fmin(fmax(at, 0), length);
        const double distance = length_of(x - ax - within * dx / length, y - ay - within * dy / length);
        if (distance < nearest.distance)
            nearest = (foot){before + within, distance, (y - ay) * dx > (x - ax) * dy,
                             (i == 0 && at < 0) || (i + 2 == d->count && at > length)};
        before += length;
    }
    return nearest;
}

/* Returns the distance along the line to the nearest dash. */
static double dash_distance(const camber_along_desc *d, double along) {
    const double unit = d->paint->dash_unit_px > 0.0f ? (double)d->paint->dash_unit_px : 1;
    const size_t count = d->paint->dash->count * (d->paint->dash->count % 2 ? 2 : 1);
    double period = 0, nearest = INFINITY;
    for (size_t i = 0; i < count; i++)
        period += (double)d->paint->dash->lengths[i % d->paint->dash->count] * unit;
    for (double at = period * (floor(along / period) - 1); at < along + 2 * period; at += period) {
        double from = at;
        for (size_t i = 0; i < count; i++) {
            const double to = from + (double)d->paint->dash->lengths[i % d->paint->dash->count] * unit;
            if (i % 2 == 0)
                nearest = fmin(nearest, fmax(fmax(from - along, along - to), 0));
            from = to;
        }
    }
    return nearest;
}

/* Returns the opacity of the paint at a foot, 0 to 1. */
static double share_at(const camber_along_desc *d, foot p, double progress) {
    const camber_paint *paint = d->paint;
    const double width = (double)paint->width_px, gap = (double)paint->gap_px, blur = (double)paint->blur_px;
    const double outer = gap > 0 ? 0.5 * gap + width : 0.5 * width;
    if (p.is_past && d->cap == CAMBER_CAP_BUTT)
        return 0;
    if (paint->trim_end > paint->trim_start && progress >= (double)paint->trim_start &&
        progress <= (double)paint->trim_end)
        return 0;
    if (paint->dash) {
        const double dash = dash_distance(d, p.along);
        if (d->cap == CAMBER_CAP_BUTT && dash > 0)
            return 0;
        p.distance = length_of(p.distance, dash);
    }
    if (blur > 0) {
        const double rim = outer - p.distance, inner = gap > 0 ? p.distance - 0.5 * gap + blur : rim;
        const double fade = fmin(fmax((fmin(rim, inner) + 0.5) / (blur + 1), 0), 1);
        return paint->smooth_blur ? fade * fade * (3 - 2 * fade) : fade;
    }
    return p.distance <= outer && (gap <= 0 || p.distance >= 0.5 * gap) ? 1 : 0;
}

/* Computes the ramp's premultiplied colour. */
static void color_at(const camber_ramp *ramp, double progress, double color[4]) {
    const camber_ramp_stop *stops = ramp->stops;
    size_t i = 0;
    while (i + 1 < ramp->count && (double)stops[i + 1].place <= progress)
        i++;
    const camber_ramp_stop ends[2] = {stops[i], stops[i + 1 < ramp->count ? i + 1 : i]};
    const double span = (double)ends[1].place - (double)ends[0].place;
    const double t = span > 0 ? fmin(fmax((progress - (double)ends[0].place) / span, 0), 1) : 0;
    for (int c = 0; c < 4; c++)
        color[c] = 0;
    for (int e = 0; e < 2; e++) {
        const double a = (double)ends[e].color.a * (e ? t : 1 - t);
        color[0] += (double)ends[e].color.r * a;
        color[1] += (double)ends[e].color.g * a;
        color[2] += (double)ends[e].color.b * a;
        color[3] += a;
    }
}

bool camber_ray_meets_plane(double pitch_deg, const double size[2], double x, double y, double met[2], double *depth) {
    const double pi = 3.14159265358979323846, angle = pitch_deg * pi / 180;
    const double view = 0.6435011087932844; /* rad, the camera's vertical angle of view */
    const double away = 0.5 * size[1] / tan(0.5 * view);
    const double eye[] = {0, away * sin(angle), away * cos(angle)}, down[] = {0, cos(angle), -sin(angle)};
    const double right = x - 0.5 * size[0], below = y - 0.5 * size[1];
    const double ray[] = {right, below * down[1] - eye[1], below * down[2] - eye[2]};
    if (ray[2] >= 0)
        return false;
    *depth = -eye[2] / ray[2];
    met[0] = eye[0] + *depth * ray[0] + 0.5 * size[0];
    met[1] = eye[1] + *depth * ray[1] + 0.5 * size[1];
    return true;
}

double camber_image_red(const camber_image *image, double u, double v) {
    const double x = (u - floor(u)) * image->width - 0.5, y = (v - floor(v)) * image->height - 0.5;
    double red = 0;
    for (int k = 0; k < 4; k++) {
        const double column = floor(x) + k % 2, row = floor(y) + k / 2;
        const size_t at = (size_t)(column + image->width) % image->width +
                          (size_t)(row + image->height) % image->height * image->width;
        red += (1 - fabs(x - column)) * (1 - fabs(y - row)) * image->rgba[4 * at] / 255;
    }
    return red;
}

/* A copy of the image is as high as the line is wide. The image's top is on the line's right side. */
static double image_at(const camber_paint *paint, foot p) {
    const double across = p.distance / (double)paint->width_px;
    return camber_image_red(paint->image, p.along / (double)paint->image_px, 0.5 + (p.is_right ? -across : across));
}

static void add_sample(const camber_along_desc *d, double total, double x, double y, double sum[4]) {
    double color[4] = {1, 1, 1, 1};
    const foot p = foot_of(d, x, y);
    const double progress = p.along / total, share = share_at(d, p, progress);
    if (share <= 0)
        return;
    if (d->paint->ramp)
        color_at(d->paint->ramp, progress, color);
    if (d->paint->image)
        color[0] = image_at(d->paint, p);
    const camber_color c = d->paint->color;
    const double by[] = {(double)c.r, (double)c.g, (double)c.b, 1};
    for (int i = 0; i < 4; i++)
        sum[i] += share * color[i] * by[i] * (double)c.a;
}

/* Computes which position of the line's plane is seen at a position in the window. Returns false if none is. */
static bool place_of(const camber_along_desc *d, camber_window window, double x, double y, double at[2]) {
    const double size[] = {window.width, window.height};
    double depth;
    at[0] = window.x0 + x;
    at[1] = window.y0 + y;
    return d->pitch_deg <= 0 || camber_ray_meets_plane(d->pitch_deg, size, x, y, at, &depth);
}

/* Whether a pixel may contain part of the line. reach: the largest distance from the line's middle at which it is
 * drawn, px. */
static bool may_have(const camber_along_desc *d, camber_window window, int x, int y, double reach) {
    double middle[2], corner[2], span = 0;
    if (!place_of(d, window, x + 0.5, y + 0.5, middle))
        return true; /* the horizon passes through the pixel */
    for (int k = 0; k < 4; k++) {
        if (!place_of(d, window, x + k % 2, y + k / 2, corner))
            return true;
        span = fmax(span, length_of(corner[0] - middle[0], corner[1] - middle[1]));
    }
    return foot_of(d, middle[0], middle[1]).distance <= reach + span;
}

void camber_along_add(const camber_along_desc *d, camber_window window, float *rgba) {
    const double total = camber_along_length(d->points, d->count);
    const double reach =
        (double)d->paint->width_px + 0.5 * (double)d->paint->gap_px + 0.5; /* plus half a pixel for a blur */
    for (int y = 0; y < window.height; y++)
        for (int x = 0; x < window.width; x++) {
            float *pixel = rgba + 4 * ((size_t)y * (size_t)window.width + (size_t)x);
            double sum[4] = {0}, at[2];
            if (!may_have(d, window, x, y, reach))
                continue;
            for (int s = 0; s < SAMPLES * SAMPLES; s++)
                if (place_of(d, window, x + (s % SAMPLES + 0.5) / SAMPLES, y + (s / SAMPLES + 0.5) / SAMPLES, at))
                    add_sample(d, total, at[0], at[1], sum);
            for (int c = 0; c < 4; c++)
                pixel[c] += (float)(sum[c] / (SAMPLES * SAMPLES));
        }
}
