/* Images in a picture with a pitch: where in the plane a pixel lies, and how much of the plane it shows. */
#ifndef CAMBER_KERNELS_PITCH_IMAGES_H
#define CAMBER_KERNELS_PITCH_IMAGES_H

#include "images.h"
#include "pitch_coverage.h"

#if CAMBER_LANES == 16 /* as rich frames are drawn */

/* The spot of a fill's pixel. x and y: its position from the picture's middle, px. */
CAMBER_FN void camber_plane_spot(camber_eye e, camber_real x, camber_real y, camber_image_spot *spot) {
    const camber_real by_depth = 1.0f + y * (e.fall / e.cosine), least = CAMBER_REAL(CAMBER_PITCH_LEAST);
    const camber_real depth = 1.0f / CAMBER_MORE(by_depth, least);
    spot->x = x * depth + e.x;
    spot->y = y * depth / e.cosine + e.y;
    spot->distance = CAMBER_REAL(0.0f);
    spot->reach_x = depth;
    spot->reach_y = depth * depth / e.cosine;
}

/* The spot of a line's pixel. at: as camber_pitch_area has filled it in. */
CAMBER_FN void camber_pitch_spot(const camber_pitch_edge *p, const camber_pitch_pixel *at, camber_image_spot *spot) {
    const camber_real lies = at->side_x * at->ground_x + at->side_y * at->ground_y, least = CAMBER_REAL(1e-4f);
    camber_real seen[2];
    const camber_real across = camber_pitch_normal(p, at->side_x, at->side_y, lies, seen) * at->by_depth;
    spot->x = at->x;
    spot->y = at->y;
    spot->distance = CAMBER_SQRT(at->arc_a * at->arc_a + at->arc_b * at->arc_b + at->y * at->y);
    spot->reach_x = 1.0f / CAMBER_MORE(at->scale, least);
    spot->reach_y = 1.0f / CAMBER_MORE(across, least);
}

CAMBER_FN void camber_pitch_image_of(CAMBER_GLOBAL const float *side_table, camber_u32 at,
                                     CAMBER_GLOBAL const float *arc_length, const camber_pitch_edge *p,
                                     camber_image_sampler *m) {
    camber_image_line line;
    line.length = p->length;
    line.half_width = p->half_width;
    line.ca = p->ca;
    line.sa = p->sa;
    line.cb = p->cb;
    line.sb = p->sb;
    camber_image_line_of(side_table, at, arc_length, &line, m);
}

#endif

#endif
