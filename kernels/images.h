/* Images that kernels built with CAMBER_RASTER_RICH draw with: along lines, or side by side over the picture.
 *
 * Input: the side table, which holds each image's layout and texels, and the positions of pixels. Output: the colour
 * that a pixel sees, as the mean of the texels that it shows. image_at of shaders/stroke.frag and images_over of
 * shaders/flatten.frag hold the same formulas. */
#ifndef CAMBER_KERNELS_IMAGES_H
#define CAMBER_KERNELS_IMAGES_H

#include "features.h"

#if CAMBER_LANES == 16 /* as rich frames are drawn */

/* An image's layout in the side table, four float4s:
 *     0-3    the first word of its texels, texels a row, rows (all three are bits of unsigned integers); px along a
 * line 4-7    of a fill: where a corner of an image lies, px; images a px to the right, along their x and their y 8-11
 * of a fill: images a px down, along their x and their y; 0, 0 12-15  the mean colour, 0 to 255 Texels are
 * premultiplied RGBA8, a word each, from the top down, with a border of one texel around them. */
#define CAMBER_IMAGE_WORDS 16u
#define CAMBER_SAMPLES_MAX 8.0f /* the most along each side of a pixel that shows many texels */

#ifdef CAMBER_DEVICE
#define CAMBER_BITS(x) as_uint(x)
#define CAMBER_WORDS(x) convert_uint16(x)
#define CAMBER_NUMBERS(words) convert_float16(words)
#define CAMBER_MOST(x) camber_most_of(x)
CAMBER_FN float camber_most_of(camber_real x) {
    const float8 a = x.lo > x.hi ? x.lo : x.hi;
    const float4 b = a.lo > a.hi ? a.lo : a.hi;
    const float2 c = b.lo > b.hi ? b.lo : b.hi;
    return c.x > c.y ? c.x : c.y;
}
#else
#define CAMBER_BITS(x) camber_bits_of(x)
#define CAMBER_WORDS(x) ((uint32_t)(x))
#define CAMBER_NUMBERS(words) ((float)(words))
#define CAMBER_MOST(x) (x)
CAMBER_FN camber_u32 camber_bits_of(float value) {
    union {
        float value;
        camber_u32 bits;
    } word = {value};
    return word.bits;
}
#endif

/* How an image is looked up: all that is the same for each pixel of a segment or a fill. */
typedef struct camber_image_sampler {
    camber_u32 first, stride; /* words */
    float width, height;      /* texels */
    float phase, rate, aside; /* in images: the position at A, what a px along the line is, what a px across it is */
    float length, near;       /* the segment's length; how far from a joint the image bends; px */
    float tangent_a, tangent_b;
    float left, top, across_x, across_y, down_x, down_y; /* of a fill */
    float mean[4];
} camber_image_sampler;

/* The fraction of a number, from 0 to 1; 0 from 2^23 on. */
CAMBER_FN float camber_fraction(float x) {
    const float held = CAMBER_FABS(x) < 8388608.0f ? x : 0.0f, rest = held - (float)(camber_i32)held;
    return rest < 0.0f ? rest + 1.0f : rest;
}

CAMBER_FN camber_real camber_fractions(camber_real x) {
    const camber_real held = CAMBER_FABS(x) < 8388608.0f ? x : CAMBER_REAL(0.0f), rest = held - CAMBER_TRUNCATE(held);
    return rest < 0.0f ? rest + 1.0f : rest;
}

/* The sampler of a fill. at: where the image's layout begins in the side table, words. */
CAMBER_FN void camber_image_sampler_of(CAMBER_GLOBAL const float *side_table, camber_u32 at, camber_image_sampler *m) {
    m->first = CAMBER_BITS(side_table[at]);
    m->stride = CAMBER_BITS(side_table[at + 1u]) + 2u;
    m->width = (float)CAMBER_BITS(side_table[at + 1u]);
    m->height = (float)CAMBER_BITS(side_table[at + 2u]);
    m->phase = m->rate = m->aside = m->length = m->near = m->tangent_a = m->tangent_b = 0.0f;
    m->left = side_table[at + 4u];
    m->top = side_table[at + 5u];
    m->across_x = side_table[at + 6u];
    m->across_y = side_table[at + 7u];
    m->down_x = side_table[at + 8u];
    m->down_y = side_table[at + 9u];
    for (camber_u32 k = 0; k < 4u; k++)
        m->mean[k] = side_table[at + 12u + k];
}

/* The tangent of half a turn; 0 where the line goes straight on. */
CAMBER_FN float camber_image_tangent(float cosine, float sine) {
    const float tangent = sine / (cosine > 1e-3f ? cosine : 1e-3f);
    return CAMBER_FABS(tangent) < 1e-6f ? 0.0f : tangent;
}

/* The segment as a line's sampler needs it: cosine and sine are of half the turn at A and at B. */
typedef struct camber_image_line {
    float length, half_width, ca, sa, cb, sb;
} camber_image_line;

/* The sampler of a line. arc_length: the segment's CAMBER_SEGMENT_ARC_LENGTHS words. */
CAMBER_FN void camber_image_line_of(CAMBER_GLOBAL const float *side_table, camber_u32 at,
                                    CAMBER_GLOBAL const float *arc_length, const camber_image_line *p,
                                    camber_image_sampler *m) {
    const float one_px = side_table[at + 3u], middle = 0.5f * p->length, widths = 4.0f * p->half_width;
    camber_image_sampler_of(side_table, at, m);
    m->phase = camber_fraction(arc_length[0] / one_px);
    m->rate = arc_length[1] / one_px;
    m->aside = 0.5f / (p->half_width > 1e-9f ? p->half_width : 1e-9f);
    m->length = p->length;
    m->near = middle < widths ? middle : widths;
    m->tangent_a = camber_image_tangent(p->ca, p->sa);
    m->tangent_b = camber_image_tangent(p->cb, p->sb);
}

CAMBER_FN void camber_flat_image_of(CAMBER_GLOBAL const float *side_table, camber_u32 at,
                                    CAMBER_GLOBAL const float *arc_length, const camber_edge *p,
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

/* ---- Pixels ---- */

/* Where pixels lie: along and across a segment and how far from it, or in the plane. reach: how much of the plane a
 * pixel spans, px; 0 without a pitch. */
typedef struct camber_image_spot {
    camber_real x, y, distance;
    camber_real reach_x, reach_y;
} camber_image_spot;

/* How far before a joint a position lies in the image, if it lies t px before the joint. The image is stretched or
 * squeezed near the joint, up to `near` px from it, so that its end lies on the bisector. A cap leaves it as it is. */
CAMBER_FN camber_real camber_before_joint(camber_real t, float tangent, camber_real y, float near) {
    const camber_real bisector = tangent * y, room = near - bisector, least = CAMBER_REAL(1e-3f);
    const camber_real share = camber_clamp_to_one((t - bisector) / CAMBER_MORE(room, least));
    return tangent == 0.0f ? t : t > near ? t : near * share;
}

/* For each pixel, the texel at a word of the side table and the one to its right. */
CAMBER_FN void camber_texels_at(CAMBER_GLOBAL const float *side_table, camber_words at, camber_words *left,
                                camber_words *right) {
#ifdef CAMBER_DEVICE
    camber_u32 places[16], from[16], to[16];
    vstore16(at, 0, places);
    for (int k = 0; k < 16; k++) {
        const uint2 two = vload2(0, (global const camber_u32 *)side_table + places[k]);
        from[k] = two.x;
        to[k] = two.y;
    }
    *left = vload16(0, from);
    *right = vload16(0, to);
#else
    *left = CAMBER_BITS(side_table[at]);
    *right = CAMBER_BITS(side_table[at + 1u]);
#endif
}

/* Adds the image's colour, 0 to 255, bilinear, at shares u and v of its width and height, where it is wanted. */
CAMBER_FN void camber_add_texels(CAMBER_GLOBAL const float *side_table, const camber_image_sampler *m, camber_real u,
                                 camber_real v, camber_mask wanted, camber_real rgba[4]) {
    const camber_real x = u * m->width + 0.5f, y = v * m->height + 0.5f;
    const camber_words column = CAMBER_WORDS(x), row = CAMBER_WORDS(y), at = m->first + row * m->stride + column;
    const camber_real right = x - CAMBER_NUMBERS(column), down = y - CAMBER_NUMBERS(row);
    camber_words a, b, c, d;
    camber_texels_at(side_table, at, &a, &b);
    camber_texels_at(side_table, at + m->stride, &c, &d);
    for (camber_u32 k = 0; k < 4u; k++) {
        const camber_real from = CAMBER_NUMBERS(a >> 8u * k & 255u), to = CAMBER_NUMBERS(b >> 8u * k & 255u);
        const camber_real below = CAMBER_NUMBERS(c >> 8u * k & 255u), behind = CAMBER_NUMBERS(d >> 8u * k & 255u);
        const camber_real upper = from + (to - from) * right, lower = below + (behind - below) * right;
        const camber_real sum = rgba[k] + (upper + (lower - upper) * down);
        rgba[k] = wanted ? sum : rgba[k];
    }
}

/* How many samples a pixel takes along a side on which it shows so many texels. */
CAMBER_FN camber_real camber_samples(camber_real texels) {
    const camber_real least = CAMBER_REAL(1.0f), most = CAMBER_REAL(CAMBER_SAMPLES_MAX), wanted = texels + 0.5f;
    const camber_real bounded = wanted > least ? wanted : least;
    return CAMBER_TRUNCATE(bounded < most ? bounded : most);
}

/* The image's mean colour, premultiplied, 0 to 1, around u and v, over over_u and over_v images. It repeats along u;
 * tiled: along v, too. */
CAMBER_FN void camber_image_over(CAMBER_GLOBAL const float *side_table, const camber_image_sampler *m, camber_real u,
                                 camber_real v, camber_real over_u, camber_real over_v, camber_u32 tiled,
                                 camber_real rgba[4]) {
    const camber_real columns = camber_samples(over_u * m->width), rows = camber_samples(over_v * m->height);
    const camber_real scale = 1.0f / (255.0f * columns * rows);
    const float most_columns = CAMBER_MOST(columns), most_rows = CAMBER_MOST(rows);
    rgba[0] = rgba[1] = rgba[2] = rgba[3] = CAMBER_REAL(0.0f);
    for (float j = 0.5f; j < most_rows; j += 1.0f)
        for (float i = 0.5f; i < most_columns; i += 1.0f) {
            const camber_real at_u = u + (i / columns - 0.5f) * over_u, at_v = v + (j / rows - 0.5f) * over_v;
            const camber_real down = tiled ? camber_fractions(at_v) : camber_clamp_to_one(at_v);
            camber_add_texels(side_table, m, camber_fractions(at_u), down, (i < columns) & (j < rows), rgba);
        }
    for (int k = 0; k < 4; k++)
        rgba[k] *= scale;
}

/* The colour of a line's image. Around a round join or cap it is swept. */
CAMBER_FN void camber_line_image(CAMBER_GLOBAL const float *side_table, const camber_image_sampler *m,
                                 const camber_image_spot *at, camber_real rgba[4]) {
    const camber_real t = m->length - at->x, none = CAMBER_REAL(0.0f), edge = CAMBER_REAL(0.5f);
    const camber_real from_a = camber_before_joint(at->x, m->tangent_a, at->y, m->near);
    const camber_real from_b = m->length - camber_before_joint(t, m->tangent_b, at->y, m->near);
    const camber_real x = at->x < t ? from_a : from_b;
    const camber_mask past = (x < 0.0f) | (x > m->length);
    const camber_real across = (past ? CAMBER_FABS(at->y) : at->distance) * m->aside;
    const camber_real off = across < edge ? across : edge, side = at->y < 0.0f ? -off : none;
    camber_image_over(side_table, m, m->phase + x * m->rate, 0.5f - (at->y > 0.0f ? off : side),
                      CAMBER_FABS(m->rate) * at->reach_x, m->aside * at->reach_y, 0u, rgba);
}

/* The colour of a fill's images. Where a pixel shows very many texels, it tends to the mean. */
CAMBER_FN void camber_fill_image(CAMBER_GLOBAL const float *side_table, const camber_image_sampler *m,
                                 const camber_image_spot *at, camber_real rgba[4]) {
    const camber_real x = at->x - m->left, y = at->y - m->top;
    const camber_real over_u = CAMBER_FABS(m->across_x) * at->reach_x + CAMBER_FABS(m->down_x) * at->reach_y;
    const camber_real over_v = CAMBER_FABS(m->across_y) * at->reach_x + CAMBER_FABS(m->down_y) * at->reach_y;
    const camber_real wide = over_u * m->width, high = over_v * m->height;
    const camber_real share = camber_clamp_to_one(CAMBER_MORE(wide, high) * (1.0f / CAMBER_SAMPLES_MAX) - 1.0f);
    camber_image_over(side_table, m, m->across_x * x + m->down_x * y, m->across_y * x + m->down_y * y, over_u, over_v,
                      1u, rgba);
    for (int k = 0; k < 4; k++)
        rgba[k] += (m->mean[k] * (1.0f / 255.0f) - rgba[k]) * share;
}

#endif

#endif
