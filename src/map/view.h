/* The camera: world coordinates to device pixels, in double until the view's origin is subtracted. */
#ifndef CAMBER_MAP_VIEW_H
#define CAMBER_MAP_VIEW_H

#include "base/base.h"
#include "base/perspective.h"
#include "camber_map.h"

/* Axis-aligned; empty where x0 > x1. */
typedef struct camber_box {
    double x0, y0, x1, y1;
} camber_box;

#define CAMBER_BOX_EMPTY ((camber_box){1.0, 1.0, 0.0, 0.0})

typedef struct camber_view {
    double x, y;     /* of the centre: world coordinates, 0 to 1 from the north-west, y down */
    double zoom;     /* MapLibre's; below 0 where a fitted world is smaller than 512 CSS px */
    double scale_px; /* device px that the world is wide */
    double bearing_deg;
    double cosine, sine; /* cosine and sine of the bearing */
    double pitch_deg;
    double ratio;           /* device px a CSS px */
    uint32_t width, height; /* device px */
} camber_view;

/* Checks the desc and completes a BBOX or CENTER view; a FIT view starts as the whole world and wants
 * camber_view_frame. Returns CAMBER_ERROR_ARGUMENT. */
camber_status camber_view_create(camber_context *context, const camber_view_desc *desc, camber_view *view);

/* Moves and zooms the view so that bounds take fill (0 to 1) of the tighter side, at most at max_zoom. The bounds
 * are in the view's turned axes: u = x cos + y sin, v = y cos - x sin of world coordinates. */
void camber_view_frame(camber_view *view, camber_box bounds, double fill, double max_zoom);

/* The quadrangle of the world that is seen, as pairs of x, y: of a view with a pitch up to the far plane. */
void camber_view_corners(const camber_view *view, double corners[8]);

/* How far from what is seen a line may lie that reaches it, in world coordinates, whatever features say (read_for.c).
 */
double camber_view_margin(const camber_style *style, const camber_view *view, double simplify_px);
/* How far from its point a circle of the style reaches at most, px (read_for.c). 0: the style draws none here. */
double camber_view_circle_reach(const camber_style *style, const camber_view *view);

/* The zoom to evaluate styles at: 0 to 24, the range of theirs. */
double camber_view_style_zoom(const camber_view *view);

/* Degrees; the longitude is -180 to 180. */
void camber_view_center(const camber_view *view, double *longitude, double *latitude);

/* World coordinates to device px from the view's top left. */
static inline void camber_view_project(const camber_view *view, double world_x, double world_y, double *px) {
    const double dx = (world_x - view->x) * view->scale_px, dy = (world_y - view->y) * view->scale_px;
    px[0] = dx * view->cosine + dy * view->sine + 0.5 * view->width;
    px[1] = dy * view->cosine - dx * view->sine + 0.5 * view->height;
}

/* How a picture shows the plane of the map: as it is without a pitch, else in perspective. */
typedef struct camber_view_lens {
    bool pitched;
    camber_perspective perspective;
    double half_width, half_height;
} camber_view_lens;

camber_view_lens camber_view_lens_of(const camber_view *view);
/* Px of the plane to px of the picture as it is seen. Returns the depth: 1 at the centre, more above it. At 0 and
 * below, the point is not in front of the camera, and seen is untouched. */
static inline double camber_lens_see(const camber_view_lens *lens, const double *plane, double *seen) {
    if (!lens->pitched) {
        seen[0] = plane[0];
        seen[1] = plane[1];
        return 1.0;
    }
    const double x = plane[0] - lens->half_width, y = plane[1] - lens->half_height;
    const double depth = 1.0 - lens->perspective.fall * y;
    if (!(depth > 1e-6))
        return 0.0;
    seen[0] = lens->half_width + x / depth;
    seen[1] = lens->half_height + lens->perspective.cosine * y / depth;
    return depth;
}

/* Bounds in device px of a box in world coordinates. */
camber_box camber_view_project_box(const camber_view *view, camber_box world);

static inline void camber_box_add(camber_box *box, double x, double y) {
    if (box->x0 > box->x1) {
        *box = (camber_box){x, y, x, y};
        return;
    }
    box->x0 = x < box->x0 ? x : box->x0;
    box->x1 = x > box->x1 ? x : box->x1;
    box->y0 = y < box->y0 ? y : box->y0;
    box->y1 = y > box->y1 ? y : box->y1;
}

#endif
