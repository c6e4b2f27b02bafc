/* Makes a view, the camera that draws a map, from a user's description: a centre and a zoom, a bounding box, or
 * everything.
 *
 * Input: camber_view_desc in degrees and CSS pixels. Output: camber_view in world coordinates and device pixels. */
#include "map/view.h"

#include "base/maths.h"
#include "base/perspective.h"
#include "features/mercator.h"
#include "style/style.h"

#include <math.h>

/* The square of Web Mercator ends at CAMBER_MERCATOR_LATITUDE; this is how the limit is usually written. */
static const double LARGEST_LATITUDE_DEG = 85.051129;
static const double LARGEST_ZOOM = 24.0;

/* Projects to world coordinates. The latitude limit with six digits is slightly outside the world, so y is clamped. */
static void to_world(double longitude, double latitude, double *x, double *y) {
    camber_mercator_project(longitude, latitude, x, y);
    *y = *y < 0.0 ? 0.0 : *y > 1.0 ? 1.0 : *y;
}

static camber_status check_range(camber_context *context, const char *what, double value, double low, double high) {
    if (value >= low && value <= high) /* false for NaN */
        return CAMBER_OK;
    return camber_fail(context, CAMBER_ERROR_ARGUMENT, "view: %s is %g; choose %g to %g", what, value, low, high);
}

static camber_status check_size(camber_context *context, const camber_view_desc *desc, camber_view *view) {
    const double ratio = desc->ratio != 0.0 ? desc->ratio : 1.0;
    if (!(ratio > 0.0 && isfinite(ratio)))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "view: the ratio is %g; choose a number above 0", ratio);
    const double width = floor((desc->width ? desc->width : 1024) * ratio + 0.5);
    const double height = floor((desc->height ? desc->height : 1024) * ratio + 0.5);
    if (!(width >= 1.0 && width <= 65535.0 && height >= 1.0 && height <= 65535.0))
        return camber_fail(
            context, CAMBER_ERROR_ARGUMENT,
            "view: the size is %.0f x %.0f device px; choose sides that are 1 to 65535 px after the ratio", width,
            height);
    if (width * height > 2147483648.0)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "view: the size is %.0f x %.0f device px; choose at most 2^31 pixels in total", width,
                           height);
    view->width = (uint32_t)width;
    view->height = (uint32_t)height;
    view->ratio = ratio;
    return CAMBER_OK;
}

static void set_zoom(camber_view *view, double zoom) {
    view->zoom = zoom;
    view->scale_px = CAMBER_WORLD_CSS_PX * view->ratio * camber_exp2(zoom);
}

static void set_bearing(camber_view *view, double bearing_deg) {
    view->bearing_deg = bearing_deg;
    const double angle = fmod(bearing_deg, 360.0) * (3.14159265358979323846 / 180.0);
    camber_sine_cosine(angle, &view->sine, &view->cosine);
    if (remainder(bearing_deg, 90.0) == 0.0) {
        /* pi is not exact, but quarter turns must keep axis-parallel lines axis-parallel. */
        view->cosine = round(view->cosine);
        view->sine = round(view->sine);
    }
}

static camber_status set_bbox(camber_context *context, const camber_view_desc *desc, camber_view *view) {
    camber_status status = check_range(context, "the bbox's west", desc->west, -360.0, 360.0);
    if (status == CAMBER_OK)
        status = check_range(context, "the bbox's east", desc->east, -360.0, 360.0);
    if (status == CAMBER_OK)
        status = check_range(context, "the bbox's south", desc->south, -LARGEST_LATITUDE_DEG, LARGEST_LATITUDE_DEG);
    if (status == CAMBER_OK)
        status = check_range(context, "the bbox's north", desc->north, -LARGEST_LATITUDE_DEG, LARGEST_LATITUDE_DEG);
    if (status != CAMBER_OK)
        return status;
    if (desc->south > desc->north)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "view: the bbox's south %g is north of its north %g; give west, south, east, north",
                           desc->south, desc->north);
    const double east = desc->west > desc->east ? desc->east + 360.0 : desc->east;
    if (east < desc->west || east - desc->west > 360.0)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "view: the bbox from %g to %g is wider than the world; choose longitudes from -180 to 180",
                           desc->west, desc->east);
    double x[2], y[2];
    to_world(desc->west, desc->north, x, y);
    to_world(east, desc->south, x + 1, y + 1);
    camber_box bounds = CAMBER_BOX_EMPTY;
    for (int i = 0; i < 4; i++) {
        const double corner_x = x[i & 1], corner_y = y[i >> 1];
        camber_box_add(&bounds, corner_x * view->cosine + corner_y * view->sine,
                       corner_y * view->cosine - corner_x * view->sine);
    }
    camber_view_frame(view, bounds, 1.0, LARGEST_ZOOM);
    return CAMBER_OK;
}

static camber_status set_center(camber_context *context, const camber_view_desc *desc, camber_view *view) {
    camber_status status = check_range(context, "the centre's longitude", desc->longitude, -360.0, 360.0);
    if (status == CAMBER_OK)
        status =
            check_range(context, "the centre's latitude", desc->latitude, -LARGEST_LATITUDE_DEG, LARGEST_LATITUDE_DEG);
    if (status == CAMBER_OK)
        status = check_range(context, "the zoom", desc->zoom, 0.0, LARGEST_ZOOM);
    if (status != CAMBER_OK)
        return status;
    to_world(desc->longitude, desc->latitude, &view->x, &view->y);
    set_zoom(view, desc->zoom);
    return CAMBER_OK;
}

camber_view_desc camber_style_get_view(const camber_style *style) {
    return (camber_view_desc){.kind = CAMBER_VIEW_CENTER,
                              .longitude = style->camera.longitude,
                              .latitude =
                                  fmin(fmax(style->camera.latitude, -LARGEST_LATITUDE_DEG), LARGEST_LATITUDE_DEG),
                              .zoom = style->camera.zoom,
                              .bearing_deg = style->camera.bearing_deg,
                              .pitch_deg = fmin(style->camera.pitch_deg, CAMBER_PITCH_MAX_DEG)};
}

camber_status camber_view_create(camber_context *context, const camber_view_desc *desc, camber_view *view) {
    camber_view made = {.x = 0.5, .y = 0.5};
    camber_status status = check_size(context, desc, &made);
    if (status != CAMBER_OK)
        return status;
    if (!isfinite(desc->bearing_deg))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "view: the bearing is %g; choose an angle in degrees",
                           desc->bearing_deg);
    status = check_range(context, "the pitch", desc->pitch_deg, 0.0, CAMBER_PITCH_MAX_DEG);
    if (status != CAMBER_OK)
        return status;
    made.pitch_deg = desc->pitch_deg;
    made.cover = desc->cover;
    made.whole_labels = desc->whole_labels;
    set_bearing(&made, desc->bearing_deg);
    set_zoom(&made, 0.0);
    switch (desc->kind) {
    case CAMBER_VIEW_FIT: break;
    case CAMBER_VIEW_BBOX: status = set_bbox(context, desc, &made); break;
    case CAMBER_VIEW_CENTER: status = set_center(context, desc, &made); break;
    default: status = check_range(context, "the kind", (double)desc->kind, CAMBER_VIEW_FIT, CAMBER_VIEW_CENTER); break;
    }
    if (status == CAMBER_OK)
        *view = made;
    return status;
}

void camber_view_frame(camber_view *view, camber_box bounds, double fill, double max_zoom) {
    const double u = 0.5 * (bounds.x0 + bounds.x1), v = 0.5 * (bounds.y0 + bounds.y1);
    view->x = u * view->cosine - v * view->sine;
    view->y = u * view->sine + v * view->cosine;
    const double across = fill * view->width / (bounds.x1 - bounds.x0);
    const double down = fill * view->height / (bounds.y1 - bounds.y0);
    const bool covers = view->cover && isfinite(across) && isfinite(down);
    const double at_once = covers ? fmax(across, down) / fill : fmin(across, down);
    /* A single point divides by 0, and the infinite zoom is cut to the largest one. */
    const double zoom = log2(at_once / (CAMBER_WORLD_CSS_PX * view->ratio));
    set_zoom(view, zoom < max_zoom ? zoom : max_zoom);
}

void camber_view_corners(const camber_view *view, double corners[8]) {
    const double half_x = 0.5 * view->width, half_y = 0.5 * view->height;
    double down[2] = {-half_y, half_y}, wide[2] = {half_x, half_x};
    if (view->pitch_deg > 0.0) {
        const camber_perspective p = camber_perspective_of(view->pitch_deg, view->height);
        const double seen[2] = {fmax(p.far_y, -half_y), half_y};
        for (int i = 0; i < 2; i++) {
            const double depth = camber_perspective_depth(&p, seen[i]);
            down[i] = seen[i] * depth / p.cosine;
            wide[i] = half_x * depth;
        }
    }
    for (int i = 0; i < 4; i++) {
        const int row = i / 2;
        const double right = (i == 1 || i == 2 ? 1.0 : -1.0) * wide[row] / view->scale_px;
        const double below = down[row] / view->scale_px;
        corners[2 * i] = view->x + right * view->cosine - below * view->sine;
        corners[2 * i + 1] = view->y + right * view->sine + below * view->cosine;
    }
}

camber_view_lens camber_view_lens_of(const camber_view *view) {
    camber_view_lens lens = {
        .pitched = view->pitch_deg > 0.0, .half_width = 0.5 * view->width, .half_height = 0.5 * view->height};
    if (lens.pitched)
        lens.perspective = camber_perspective_of(view->pitch_deg, view->height);
    return lens;
}

uint64_t camber_view_key(const camber_view *view) {
    const double values[] = {view->zoom, view->scale_px, view->bearing_deg, view->pitch_deg, view->ratio};
    return camber_hash(CAMBER_HASH_START, values, sizeof values);
}

double camber_view_style_zoom(const camber_view *view) {
    return view->zoom < 0.0 ? 0.0 : view->zoom;
}

void camber_view_center(const camber_view *view, double *longitude, double *latitude) {
    camber_mercator_unproject(camber_mercator_wrap(view->x), view->y, longitude, latitude);
}

camber_box camber_view_project_box(const camber_view *view, camber_box world) {
    double centre[2];
    camber_view_project(view, 0.5 * (world.x0 + world.x1), 0.5 * (world.y0 + world.y1), centre);
    const double half_x = 0.5 * (world.x1 - world.x0) * view->scale_px;
    const double half_y = 0.5 * (world.y1 - world.y0) * view->scale_px;
    const double x = half_x * fabs(view->cosine) + half_y * fabs(view->sine);
    const double y = half_x * fabs(view->sine) + half_y * fabs(view->cosine);
    return (camber_box){centre[0] - x, centre[1] - y, centre[0] + x, centre[1] + y};
}
