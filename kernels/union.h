/* The union of strokes in a pixel. */
#ifndef CAMBER_KERNELS_UNION_H
#define CAMBER_KERNELS_UNION_H

#include "lanes.h"

CAMBER_FN camber_real camber_clamp_to_one(camber_real x) {
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f), least = CAMBER_MORE(x, none);
    return CAMBER_LESS(least, one);
}

/* Returns the area of a pixel that all strokes of a layer cover together. Two areas a and b cut off by edges cover
 * together
 *     the larger      if the edges face in the same direction
 *     a + b - ab      if they cross at a right angle
 *     a + b           if they face each other
 * over: a + b - ab, the area if each were drawn over the others; sum: the sum of their areas a; the normal: the sum of
 * their normals times a (1 - a), which gives the angle between them. More than two are treated as two. */
CAMBER_FN camber_real camber_united(camber_real over, camber_real sum, camber_real nx, camber_real ny) {
    const camber_real none = CAMBER_REAL(0.0f), one = CAMBER_REAL(1.0f), tiny = CAMBER_REAL(1e-6f);
    const camber_real excess = sum - over, inner = sum * sum - 4.0f * (excess > 0.0f ? excess : none);
    const camber_real root = CAMBER_SQRT(inner > 0.0f ? inner : none);
    const camber_real large = 0.5f * (sum + root), small = 0.5f * (sum - root);
    const camber_real more = large < 1.0f ? large : one, less = camber_clamp_to_one(small);
    const camber_real a = more * (1.0f - more), b = less * (1.0f - less), below = 2.0f * a * b;
    const camber_real slant = (nx * nx + ny * ny - a * a - b * b) / CAMBER_MORE(below, tiny);
    const camber_real bounded = slant < 1.0f ? slant : one, cosine = bounded > -1.0f ? bounded : -one;
    const camber_real apart = sum < 1.0f ? sum : one, target = cosine < 0.0f ? apart : more;
    const camber_real weight = CAMBER_FABS(cosine), area = over * (1.0f - weight) + target * weight;
    /* half floats lose that much precision, so the inside counts as whole */
    return sum <= over ? over : (area > 0.99f ? one : area);
}

#endif
