#include "map/clip.h"

#include <math.h>

/* The part [t[0], t[1]] of the segment inside the box; false where there is none. Liang and Barsky 1984. */
static bool part_inside(const double *a, const double *b, camber_box box, double *t) {
    const double delta[4] = {a[0] - b[0], b[0] - a[0], a[1] - b[1], b[1] - a[1]};
    const double room[4] = {a[0] - box.x0, box.x1 - a[0], a[1] - box.y0, box.y1 - a[1]};
    t[0] = 0.0;
    t[1] = 1.0;
    for (int i = 0; i < 4; i++) {
        if (!isfinite(delta[i]) || !isfinite(room[i]))
            return false;
        if (delta[i] == 0.0) {
            if (room[i] < 0.0)
                return false;
            continue;
        }
        const double crossing = room[i] / delta[i];
        if (delta[i] < 0.0)
            t[0] = crossing > t[0] ? crossing : t[0];
        else
            t[1] = crossing < t[1] ? crossing : t[1];
        if (t[0] > t[1])
            return false;
    }
    return true;
}

/* The segment as drawn: false where it is dropped; else t is the part to keep. */
static bool keep_segment(const camber_clip *clip, const double *a, const double *b, double *t) {
    return part_inside(a, b, clip->seen, t) && part_inside(a, b, clip->far, t);
}

/* The segment that a cut ring begins with; 0 where nothing is cut. */
static size_t first_of_ring(const camber_clip *clip, const double *points, size_t segments) {
    for (size_t i = 0; i < segments; i++) {
        double t[2];
        const bool kept = keep_segment(clip, points + 2 * i, points + 2 * i + 2, t);
        if (kept && t[0] > 0.0)
            return i;
        if (!kept || t[1] < 1.0)
            return (i + 1) % segments;
    }
    return 0;
}

static bool put_between(const camber_clip *clip, const double *a, const double *b, double t, bool first) {
    const double point[2] = {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t};
    return clip->put(clip->user, t == 0.0 ? a : t == 1.0 ? b : point, first);
}

bool camber_clip_polyline(const camber_clip *clip, const double *points, size_t count) {
    if (count == 1) {
        double t[2];
        return !keep_segment(clip, points, points, t) || clip->put(clip->user, points, true);
    }
    const size_t segments = count ? count - 1 : 0;
    const double *last = points + 2 * segments;
    const bool ring = segments > 2 && points[0] == last[0] && points[1] == last[1];
    const size_t start = ring ? first_of_ring(clip, points, segments) : 0;
    bool open = false;
    for (size_t i = 0; i < segments; i++) {
        const size_t k = start + i < segments ? start + i : start + i - segments;
        const double *a = points + 2 * k, *b = a + 2;
        double t[2];
        if (!keep_segment(clip, a, b, t)) {
            open = false;
            continue;
        }
        if ((!open || t[0] > 0.0) && !put_between(clip, a, b, t[0], true))
            return false;
        if (!put_between(clip, a, b, t[1], false))
            return false;
        open = t[1] == 1.0;
    }
    return true;
}
