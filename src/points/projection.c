/* Aims a camera at a network.
 *
 * Input: the camera (where it looks, scale, bearing, pitch) and the strokes, whose widths and offsets decide how far
 * from the picture a line still matters. Output: camber_projection, in the network's steps and in px. Main idea:
 * doubles are used only here, once per frame. An origin near the camera is subtracted in integers, so that floats are
 * exact enough for the rest.
 *
 *     seen     the box of steps that can reach the picture; stretches whose boxes do not touch it are skipped
 *     window   the picture and a margin, in px; segments that miss it are left out, or cut there if there is a pitch
 *
 *          +----------- window --------------+        without pitch, a rectangle
 *          |  margin                         |        with pitch, a trapezoid: far_y is its upper side
 *          |     +------ picture ------+     |
 *          |     |                     |     |             \----- far_y -----/
 *          |     +---------------------+     |              \      .       /     .: where the camera looks
 *          +---------------------------------+               \-- near_y --/ */
#include "base/maths.h"
#include "base/perspective.h"
#include "points/network.h"

#include "kernels/offset.h"

#include <math.h>

/* An absurd miter limit must not widen the window so far that nothing is cut. */
static const double LARGEST_REACH_PX = 65536.0;
/* How far from a point of an offset line the source line can still affect it, in multiples of the offset. The end of an
 * offset segment may be this far from the points that it hides, and the neighbours are searched again from there:
 * kernels/offset.h. */
static const double LOOKS = 2.0 * (double)CAMBER_OFFSET_REACH + 1.0;

/* Limits that keep projected coordinates finite. */
static const double LARGEST_STEP_PX = 1e9, FARTHEST_PX = 1e30;

static camber_status check_camera(const camber_network *network, const camber_camera *camera) {
    camber_context *context = network->context;
    const double sides = (double)camera->width * camera->height;
    if (!(isfinite(camera->x) && isfinite(camera->y) && isfinite(camera->bearing_deg)))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "camera: at %g, %g with a bearing of %g; give numbers",
                           camera->x, camera->y, camera->bearing_deg);
    if (!(camera->scale_px > 0.0 && isfinite(camera->scale_px)))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "camera: %g px a world unit; choose a number above 0",
                           camera->scale_px);
    if (!(camera->translate_px >= 0.0 && isfinite(camera->translate_px)))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "camera: a translation of %g px; choose 0 or a distance",
                           camera->translate_px);
    if (!(network->step * camera->scale_px <= LARGEST_STEP_PX))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "camera: %g px a world unit make %g px of a step of the network; choose a smaller scale",
                           camera->scale_px, network->step * camera->scale_px);
    if (!(camera->simplify_px >= 0.0 && isfinite(camera->simplify_px)))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "camera: a simplification of %g px; choose 0 or a distance in pixels", camera->simplify_px);
    if (camera->simplify_px > 0.0 && !network->has_importance)
        return camber_fail(
            context, CAMBER_ERROR_ARGUMENT,
            "camera: the network has no importance, so it cannot be simplified to %g px; compute it with "
            "camber_importance_weigh, or choose 0",
            camera->simplify_px);
    if (!camber_pitch_is_valid(camera->pitch_deg))
        return camber_fail(context, CAMBER_ERROR_ARGUMENT, "camera: a pitch of %g degrees; choose 0 to %g",
                           camera->pitch_deg, CAMBER_PITCH_MAX_DEG);
    if (sides < 1.0 || camera->width > 65535u || camera->height > 65535u)
        return camber_fail(context, CAMBER_ERROR_ARGUMENT,
                           "camera: a picture of %u x %u px; choose sides of 1 to 65535", camera->width,
                           camera->height);
    return CAMBER_OK;
}

/* Returns how far from its line a stroke touches pixels, in px. */
static double reach_of(const camber_stroke *stroke) {
    const double half = 0.5 * (double)stroke->width_px;
    double factor = stroke->cap == CAMBER_CAP_SQUARE ? 1.5 : 1.0; /* a corner is sqrt(2) away */
    if (stroke->join == CAMBER_JOIN_MITER)
        factor = fmax(factor, stroke->miter_limit > 0.0f ? (double)stroke->miter_limit : 2.0);
    if (stroke->join == CAMBER_JOIN_ROUND)
        factor =
            fmax(factor, (double)fminf(stroke->round_limit, stroke->miter_limit > 0.0f ? stroke->miter_limit : 2.0f));
    return fmin(half * factor, fmax(half, LARGEST_REACH_PX));
}

/* Returns how far from its source line a stroke with an offset can be, in px, including at corners. */
static double offset_of(const camber_stroke *stroke) {
    const double limit = stroke->miter_limit > 0.0f ? (double)stroke->miter_limit : 2.0;
    const double far = fabs((double)stroke->offset_px);
    if (!(far > 0.0))
        return 0.0;
    return fmin(far * (stroke->join == CAMBER_JOIN_MITER ? fmax(limit, 1.1) : 1.1), fmax(far, LARGEST_REACH_PX));
}

/* Returns a coordinate in steps, moved outwards by `by` steps and clamped to 32 bits; by is negative for the lower side
 * of a box. If a double is too coarse to decide, returns the farthest step, so that nothing is skipped. */
static int32_t outwards(double offset, double step, double by) {
    const double steps = floor(offset / step) + by;
    if (isnan(steps))
        return by < 0.0 ? INT32_MIN : INT32_MAX;
    return steps <= (double)INT32_MIN ? INT32_MIN : steps >= (double)INT32_MAX ? INT32_MAX : (int32_t)steps;
}

/* Returns the step nearest to a coordinate, within the network's box. */
static double origin_of(double offset, double step) {
    const double steps = floor(offset / step + 0.5);
    return !(steps > 0.0) ? 0.0 : steps >= CAMBER_NETWORK_STEPS ? CAMBER_NETWORK_STEPS : steps;
}

static double bound_px(double px) {
    return fmin(fmax(px, -FARTHEST_PX), FARTHEST_PX);
}

/* The trapezoid of the plane that a camera with a pitch sees, in px from the point that it looks at: y from far_y to
 * near_y, and |x| up to side - slope * y. */
typedef struct trapezoid {
    double side, slope, far_y, near_y;
} trapezoid;

/* Returns the trapezoid of a camera, grown by `reach` for strokes that reach into the picture from outside, and by a
 * pixel on each side. Since a pixel may reach the horizon, the trapezoid ends at twice the depth of the far plane. */
static trapezoid trapezoid_of(const camber_camera *camera, const camber_perspective *p, double reach) {
    const double half_x = 0.5 * camera->width + 1.0, half_y = 0.5 * camera->height + 1.0, slope = p->fall * half_x;
    const double seen_y = p->far_y - 1.5, near = half_y * camber_perspective_depth(p, half_y) / p->cosine;
    const bool is_below = p->cosine + p->fall * seen_y > 0.5 * p->cosine / p->farthest;
    const double far_depth = is_below ? camber_perspective_depth(p, seen_y) : 2.0 * p->farthest;
    return (trapezoid){.side = half_x + (reach + 4.0) * camber_length(1.0, slope),
                       .slope = slope,
                       .far_y = (1.0 - far_depth) / p->fall - reach - 4.0,
                       .near_y = near + reach + 4.0};
}

/* Sets the window and the box of a projection for a camera with a pitch. */
static void aim_pitched(const camber_network *network, const camber_camera *camera, double reach,
                        camber_projection *p) {
    const camber_perspective perspective = camber_perspective_of(camera->pitch_deg, camera->height);
    const trapezoid seen = trapezoid_of(camera, &perspective, reach);
    const double half_x = 0.5 * camera->width, half_y = 0.5 * camera->height, step = network->step;
    const double widest = seen.side - seen.slope * seen.far_y, narrowest = seen.side - seen.slope * seen.near_y;
    const double cosine = (double)p->across_x / (step * camera->scale_px),
                 sine = (double)p->down_x / (step * camera->scale_px);
    double x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY;
    for (int i = 0; i < 4; i++) {
        const double v = i < 2 ? seen.far_y : seen.near_y,
                     u = (i % 2 ? 1.0 : -1.0) * (i < 2 ? widest : fmax(narrowest, 0.0));
        const double x = (u * cosine - v * sine) / camera->scale_px, y = (u * sine + v * cosine) / camera->scale_px;
        x0 = fmin(x0, x);
        x1 = fmax(x1, x);
        y0 = fmin(y0, y);
        y1 = fmax(y1, y);
    }
    p->window_x0 = (float)(half_x - narrowest);
    p->window_x1 = (float)(half_x + narrowest);
    p->window_y0 = (float)(half_y + seen.far_y);
    p->window_y1 = (float)(half_y + seen.near_y);
    p->slope = (float)seen.slope;
    p->middle_y = (float)half_y;
    p->fall = (float)perspective.fall;
    p->nearest = (float)perspective.nearest;
    p->inverse_cosine = (float)(1.0 / perspective.cosine);
    p->seen_x0 = outwards(camera->x + x0 - network->x0, step, -2.0);
    p->seen_y0 = outwards(camera->y + y0 - network->y0, step, -2.0);
    p->seen_x1 = outwards(camera->x + x1 - network->x0, step, 3.0);
    p->seen_y1 = outwards(camera->y + y1 - network->y0, step, 3.0);
}

camber_status camber_network_aim(const camber_network *network, const camber_camera *camera,
                                 const camber_tessellation_desc *desc, camber_projection *projection) {
    const camber_status status = check_camera(network, camera);
    if (status != CAMBER_OK)
        return status;
    if (desc->has_arc_length && !network->lengths && network->point_count)
        return camber_fail(network->context, CAMBER_ERROR_ARGUMENT,
                           "a mesh with arc lengths of a network without them; create the network with has_arc_length");
    const double angle = fmod(camera->bearing_deg, 360.0) * (3.14159265358979323846 / 180.0);
    /* exact, so that axis-parallel lines stay axis-parallel */
    const bool quarters = remainder(camera->bearing_deg, 90.0) == 0.0;
    double sine, cosine;
    camber_sine_cosine(angle, &sine, &cosine);
    if (quarters)
        sine = round(sine), cosine = round(cosine);
    const double step = network->step, scale = step * camera->scale_px;
    const double origin_x = origin_of(camera->x - network->x0, step),
                 origin_y = origin_of(camera->y - network->y0, step);
    const double dx = bound_px((network->x0 + origin_x * step - camera->x) * camera->scale_px);
    const double dy = bound_px((network->y0 + origin_y * step - camera->y) * camera->scale_px);
    const double half_x = 0.5 * camera->width, half_y = 0.5 * camera->height;
    double reach = 0.0, looks = 0.0;
    for (size_t i = 0; i < desc->stroke_count; i++) {
        reach = fmax(reach, reach_of(desc->strokes + i) + offset_of(desc->strokes + i));
        looks = fmax(looks, LOOKS * fabs((double)desc->strokes[i].offset_px));
    }
    reach += camera->translate_px;
    const double margin = fmax(reach + looks + 16.0, 64.0);
    /* Half the box of the turned picture, with the reach of strokes around it, in world units. */
    const double across = half_x + reach + 1.0, down = half_y + reach + 1.0;
    const double seen_x = (across * fabs(cosine) + down * fabs(sine)) / camera->scale_px;
    const double seen_y = (across * fabs(sine) + down * fabs(cosine)) / camera->scale_px;
    *projection = (camber_projection){
        .origin_x = (int32_t)origin_x,
        .origin_y = (int32_t)origin_y,
        .across_x = (float)(scale * cosine),
        .down_x = (float)(scale * sine),
        .at_x = (float)(dx * cosine + dy * sine + half_x),
        .across_y = (float)(-scale * sine),
        .down_y = (float)(scale * cosine),
        .at_y = (float)(dy * cosine - dx * sine + half_y),
        .tolerance = (float)(camera->simplify_px / camera->scale_px),
        .window_x0 = (float)-margin,
        .window_y0 = (float)-margin,
        .window_x1 = (float)(camera->width + margin),
        .window_y1 = (float)(camera->height + margin),
        .seen_x0 = outwards(camera->x - seen_x - network->x0, step, -2.0),
        .seen_y0 = outwards(camera->y - seen_y - network->y0, step, -2.0),
        .seen_x1 = outwards(camera->x + seen_x - network->x0, step, 3.0),
        .seen_y1 = outwards(camera->y + seen_y - network->y0, step, 3.0),
        .end = (uint32_t)network->point_count,
        .step_px = (float)scale,
    };
    if (camera->pitch_deg > 0.0)
        aim_pitched(network, camera, reach + looks, projection);
    return CAMBER_OK;
}
