/* The camera, which maps world coordinates to device pixels. It computes in double until the view's origin is
 * subtracted. */
#ifndef CAMBER_MAP_VIEW_H
#define CAMBER_MAP_VIEW_H

#include "base/base.h"
#include "base/perspective.h"
#include "camber_map.h"

/* An axis-aligned box. It is empty if x0 > x1. */
typedef struct camber_box {
    double x0, y0, x1, y1;
} camber_box;

/* Width of the world at zoom 0. */
#define CAMBER_WORLD_CSS_PX 512.0

#define CAMBER_BOX_EMPTY ((camber_box){1.0, 1.0, 0.0, 0.0})

typedef struct camber_view {
    double x, y;     /* the centre in world coordinates, 0 to 1 from the north-west, y down */
    double zoom;     /* as in MapLibre; below 0 if a fitted world is smaller than 512 CSS px */
    double scale_px; /* width of the world in device px */
    double bearing_deg;
    double cosine, sine; /* of the bearing */
    double pitch_deg;
    double ratio;           /* device px per CSS px */
    uint32_t width, height; /* device px */
    bool cover;             /* camber_view_frame fills the picture with the bounds */
    bool whole_labels;      /* labels do not cross the picture's edge */
} camber_view;

/* Checks the desc, and completes a BBOX or CENTER view. A FIT view starts as the whole world, and then needs
 * camber_view_frame. Returns CAMBER_ERROR_ARGUMENT. */
camber_status camber_view_create(camber_context *context, const camber_view_desc *desc, camber_view *view);

/* Moves and zooms the view so that bounds take the fraction fill (0 to 1) of the tighter side, without exceeding
 * max_zoom. A view that covers is filled by the bounds instead. The bounds are in the view's rotated axes: u = x cos +
 * y sin, v = y cos - x sin of world coordinates. */
void camber_view_frame(camber_view *view, camber_box bounds, double fill, double max_zoom);

/* Writes the quadrangle of the world that is visible, as pairs of x, y. With a pitch it ends at the far plane. */
void camber_view_corners(const camber_view *view, double corners[8]);

/* Returns how far from the visible part of the world a line may be and still reach it, in world coordinates, for any
 * features (read_for.c). */
double camber_view_margin(const camber_style *style, const camber_view *view, double simplify_px);
/* Returns how far a circle of the style reaches from its point at most, in px (read_for.c). 0: the style draws none
 * here. */
double camber_view_circle_reach(const camber_style *style, const camber_view *view);
/* Returns how far labels are taken to reach from their anchors, in px (read_for.c). 0: no labels are read. */
double camber_view_label_reach(const camber_features *features, const camber_view *view);

/* Returns a hash of everything but the place and the size: views with equal keys show the same map by the same style.
 */
uint64_t camber_view_key(const camber_view *view);

/* Returns the zoom for evaluating styles: 0 to 24. */
double camber_view_style_zoom(const camber_view *view);

/* Returns the centre in degrees. The longitude is -180 to 180. */
void camber_view_center(const camber_view *view, double *longitude, double *latitude);

/* Projects world coordinates to device px from the view's top left. */
static inline void camber_view_project(const camber_view *view, double world_x, double world_y, double *px) {
    const double dx = (world_x - view->x) * view->scale_px, dy = (world_y - view->y) * view->scale_px;
    px[0] = dx * view->cosine + dy * view->sine + 0.5 * view->width;
    px[1] = dy * view->cosine - dx * view->sine + 0.5 * view->height;
}

/* How a picture shows the plane of the map: unchanged without a pitch, otherwise in perspective. */
typedef struct camber_view_lens {
    bool pitched;
    camber_perspective perspective;
    double half_width, half_height;
} camber_view_lens;

camber_view_lens camber_view_lens_of(const camber_view *view);
/* Converts px of the plane to px of the picture as it is seen. Returns the depth: 1 at the centre, more above it. 0:
 * the point is not in front of the camera, and is not seen. */
static inline double camber_lens_see(const camber_view_lens *lens, const double *plane, double *seen) {
    const double x = plane[0] - lens->half_width, y = plane[1] - lens->half_height;
    const double depth = 1.0 - lens->perspective.fall * y;
    seen[0] = plane[0];
    seen[1] = plane[1];
    if (!lens->pitched)
        return 1.0;
    if (!(depth > 1e-6))
        return 0.0;
    seen[0] = lens->half_width + x / depth;
    seen[1] = lens->half_height + lens->perspective.cosine * y / depth;
    return depth;
}

/* Returns the bounds of a box in world coordinates, in device px. */
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
