/* The ink of a stroke is its area, as GEOS makes it: buffers with the same joins and caps are a second truth, which
 * shares nothing with the oracle. */
#include "property_picture.h"

#ifdef CAMBER_GEOS
#include <geos_c.h>

typedef struct area_test {
    property_canvas *property_canvas;
    GEOSContextHandle_t geos;
    double relative, absolute_px; /* how far ink and area may be apart */
} area_test;

enum { QUADRANT_SEGMENTS = 64 };

static GEOSGeometry *line_of(GEOSContextHandle_t geos, const property_case *c) {
    GEOSCoordSequence *points = GEOSCoordSeq_create_r(geos, (unsigned)c->count, 2);
    for (unsigned i = 0; i < c->count; i++)
        GEOSCoordSeq_setXY_r(geos, points, i, (double)c->points[2 * i], (double)c->points[2 * i + 1]);
    return GEOSGeom_createLineString_r(geos, points);
}

static bool is_in_picture(GEOSContextHandle_t geos, const GEOSGeometry *buffer) {
    double left = 0, top = 0, right = 0, bottom = 0;
    return GEOSGeom_getXMin_r(geos, buffer, &left) && GEOSGeom_getYMin_r(geos, buffer, &top) &&
           GEOSGeom_getXMax_r(geos, buffer, &right) && GEOSGeom_getYMax_r(geos, buffer, &bottom) && left >= 0 &&
           top >= 0 && right <= PROPERTY_SIDE_PX && bottom <= PROPERTY_SIDE_PX;
}

/* Below 0: GEOS could not tell, or the tip of a miter leaves the picture. */
static double area_of(GEOSContextHandle_t geos, const property_case *c) {
    static const int joins[] = {GEOSBUF_JOIN_ROUND, GEOSBUF_JOIN_MITRE, GEOSBUF_JOIN_BEVEL};
    static const int caps[] = {GEOSBUF_CAP_FLAT, GEOSBUF_CAP_ROUND, GEOSBUF_CAP_SQUARE};
    double area = -1;
    GEOSBufferParams *params = GEOSBufferParams_create_r(geos);
    GEOSBufferParams_setJoinStyle_r(geos, params, joins[c->stroke.join]);
    GEOSBufferParams_setEndCapStyle_r(geos, params, caps[c->stroke.cap]);
    GEOSBufferParams_setMitreLimit_r(geos, params, c->stroke.miter_limit > 0 ? (double)c->stroke.miter_limit : 2);
    GEOSBufferParams_setQuadrantSegments_r(geos, params, QUADRANT_SEGMENTS);
    GEOSGeometry *line = line_of(geos, c);
    GEOSGeometry *buffer = line ? GEOSBufferWithParams_r(geos, line, params, (double)c->stroke.width_px / 2) : NULL;
    if (!buffer || !is_in_picture(geos, buffer) || !GEOSArea_r(geos, buffer, &area))
        area = -1;
    GEOSGeom_destroy_r(geos, buffer);
    GEOSGeom_destroy_r(geos, line);
    GEOSBufferParams_destroy_r(geos, params);
    return area;
}

/* Past the miter limit GEOS cuts the tip at the limit, camber and SVG at the corners: whether that comes up. */
static bool passes_miter_limit(const property_case *c) {
    const double limit = c->stroke.miter_limit > 0 ? (double)c->stroke.miter_limit : 2;
    const bool ring = property_is_ring(c);
    if (c->stroke.join != CAMBER_JOIN_MITER)
        return false;
    for (size_t i = ring ? 0 : 1; i + 1 < c->count; i++) {
        const float *p = c->points + 2 * i, *before = i ? p - 2 : c->points + 2 * (c->count - 2), *after = p + 2;
        const double ux = (double)(p[0] - before[0]), uy = (double)(p[1] - before[1]);
        const double vx = (double)(after[0] - p[0]), vy = (double)(after[1] - p[1]);
        const double cosine = (ux * vx + uy * vy) / (hypot(ux, uy) * hypot(vx, vy));
        if (1 > limit * sqrt(fmax(0, (1 + cosine) / 2)) * 0.98)
            return true;
    }
    return false;
}

static double shortest_px(const property_case *c) {
    double shortest = c->count < 2 ? 0 : INFINITY;
    for (size_t i = 1; i < c->count; i++) {
        const float *p = c->points + 2 * i;
        shortest = fmin(shortest, hypot((double)(p[0] - p[-2]), (double)(p[1] - p[-1])));
    }
    return shortest;
}

/* Speaks of lines whose segments are as long as the line is wide: of shorter ones GEOS leaves some out. */
static property_outcome check_area(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    const area_test *b = user;
    static property_picture drawn;
    double ink = 0;
    if (shortest_px(c) < (double)c->stroke.width_px || passes_miter_limit(c))
        return PROPERTY_SILENT;
    const double area = area_of(b->geos, c);
    if (area < 0)
        return PROPERTY_SILENT;
    property_draw(b->property_canvas, c, &drawn);
    for (size_t i = 0; i < PROPERTY_PIXELS; i++)
        ink += drawn.level[i] / 255.0;
    snprintf(story, PROPERTY_STORY, "%.2f px of ink, %.2f of area", ink, area);
    return fabs(ink - area) <= b->relative * area + b->absolute_px ? PROPERTY_HOLDS : PROPERTY_BROKEN;
}

/* Where two arms of a line as thin as this lie in one pixel, no edge tells how much of it they have in common. */
static property_outcome check_crossing(void *user, const property_case *c, char story[PROPERTY_STORY]) {
    return c->stroke.width_px < 2 ? PROPERTY_SILENT : check_area(user, c, story);
}

static void ignore_message(const char *message, void *user) {
    (void)message;
    (void)user;
}

static void test_plain(void **state) {
    area_test *b = *state;
    b->property_canvas->overlap = CAMBER_OVERLAP_FLATTEN;
    b->relative = 0.004, b->absolute_px = 1.5;
    property_check(&(property){"area, plain joins", property_make_plain, check_area, 600, 0}, b);
}

/* Lines over themselves: united, their area counts once. */
static void test_crossing(void **state) {
    area_test *b = *state;
    b->property_canvas->overlap = CAMBER_OVERLAP_UNITE;
    b->relative = 0.01, b->absolute_px = 1;
    property_check(&(property){"area, lines over themselves", property_make_crossing, check_crossing, 600, 0}, b);
}

static int set_up(void **state) {
    static area_test b;
    b.geos = GEOS_init_r();
    GEOSContext_setNoticeMessageHandler_r(b.geos, ignore_message, NULL);
    GEOSContext_setErrorMessageHandler_r(b.geos, ignore_message, NULL);
    void *opened = NULL;
    if (property_open(&opened) != 0)
        return -1;
    b.property_canvas = opened;
    *state = &b;
    return 0;
}

static int tear_down(void **state) {
    area_test *b = *state;
    void *opened = b->property_canvas;
    GEOS_finish_r(b->geos);
    return property_close(&opened);
}

int main(void) {
    if (!fixture_begin())
        return 77;
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_plain), cmocka_unit_test(test_crossing)};
    const int failed = cmocka_run_group_tests(tests, set_up, tear_down);
    return failed;
}

#else

int main(void) {
    printf("built without GEOS (libgeos-dev): the area of strokes is not held against it\n");
    return 77;
}

#endif
