/* Images along lines, or repeated over the picture.
 *
 * Input: an image's position and direction along its line (camber_image_sampler), and the positions of pixels. Output:
 * the colour of a pixel, as the mean of the texels that it shows. C, OpenCL C and GLSL compile it. The kernels and the
 * twin read texels from the side table, shaders read them from a texture: camber_add_texels. */
#ifndef CAMBER_KERNELS_IMAGES_H
#define CAMBER_KERNELS_IMAGES_H

#include "pitch.h"

/* An image's layout in the side table, four float4s:
 *     0-3    the first word of its texels, texels per row, rows (the bits of unsigned integers); px along a line
 *     4-7    for a fill: the position of a corner of an image, px; images per px to the right, along their x and y
 *     8-11   for a fill: images per px down, along their x and y; 1 if it is upright (camber_pass); 0
 *     12-15  the mean colour, 0 to 255
 * Texels are premultiplied RGBA8, one word each, from the top down, with a border of one texel around them. */
#define CAMBER_IMAGE_WORDS 16u
#define CAMBER_SAMPLES_MAX 8.0f /* the most along each side of a pixel that shows many texels */

/* How an image is sampled: everything that is the same for each pixel of a segment or a fill. */
CAMBER_STRUCT(camber_image_sampler) {
    float width, height;      /* texels */
    float phase, rate, aside; /* in units of the image's size: the position at A, a px along the line, a px across it */
    float length, near;       /* the segment's length; how far from a join the image bends; in px */
    float tangent_a, tangent_b;
    float left, top, across_x, across_y, down_x, down_y; /* only for a fill: the image's layout, words 4 to 9 */
    float upright;                                       /* its word 10 */
    float mean[4];
#ifndef CAMBER_GLSL
    CAMBER_GLOBAL const float *side_table;
    camber_u32 first, stride; /* words */
#endif
};

CAMBER_FN camber_real camber_fractions(camber_real x) {
#ifdef CAMBER_GLSL
    return fract(x);
#else
    const camber_real held = CAMBER_FABS(x) < 8388608.0f ? x : CAMBER_REAL(0.0f), rest = held - CAMBER_TRUNCATE(held);
    return rest < 0.0f ? rest + 1.0f : rest;
#endif
}

/* Fills in the part of a line's sampler that follows from the segment. */
CAMBER_FN void camber_image_along(CAMBER_IN(camber_edge) p, CAMBER_INOUT(camber_image_sampler) m) {
    const float middle = 0.5f * p->length, widths = 4.0f * p->half_width;
    m->aside = 0.5f / (p->half_width > 1e-9f ? p->half_width : 1e-9f);
    m->length = p->length;
    m->near = middle < widths ? middle : widths;
}

#ifndef CAMBER_GLSL
/* Returns the fractional part of a number, from 0 to 1; 0 from 2^23 on. */
CAMBER_FN float camber_fraction(float x) {
    const float held = CAMBER_FABS(x) < 8388608.0f ? x : 0.0f, rest = held - (float)(camber_i32)held;
    return rest < 0.0f ? rest + 1.0f : rest;
}

/* Returns the sampler of a fill. at: the word in the side table at which the image's layout begins. */
CAMBER_FN void camber_image_sampler_of(CAMBER_GLOBAL const float *side_table, camber_u32 at, camber_image_sampler *m) {
    m->side_table = side_table;
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
    m->upright = side_table[at + 10u];
    for (camber_u32 k = 0; k < 4u; k++)
        m->mean[k] = side_table[at + 12u + k];
}

/* Returns the sampler of a line. arc_length: the segment's CAMBER_SEGMENT_ARC_LENGTHS words. */
CAMBER_FN void camber_image_line_of(CAMBER_GLOBAL const float *side_table, camber_u32 at,
                                    CAMBER_GLOBAL const float *arc_length, const camber_edge *p,
                                    camber_image_sampler *m) {
    const float one_px = side_table[at + 3u];
    camber_image_sampler_of(side_table, at, m);
    m->phase = camber_fraction(arc_length[0] / one_px);
    m->rate = arc_length[1] / one_px;
    camber_image_along(p, m);
    m->tangent_a = camber_image_tangent(p->ca, p->sa);
    m->tangent_b = camber_image_tangent(p->cb, p->sb);
}

/* Reads for each pixel the texel at a word of the side table and the one to its right. */
CAMBER_FN void camber_texels_at(CAMBER_GLOBAL const float *side_table, camber_words at, camber_words *left,
                                camber_words *right) {
#if CAMBER_HAS_VECTORS
    camber_u32 places[CAMBER_LANES], from[CAMBER_LANES], to[CAMBER_LANES];
    CAMBER_STORE(at, 0, places);
    for (int k = 0; k < CAMBER_LANES; k++) {
        const uint2 two = vload2(0, (global const camber_u32 *)side_table + places[k]);
        from[k] = two.x;
        to[k] = two.y;
    }
    *left = CAMBER_LOAD(0, from);
    *right = CAMBER_LOAD(0, to);
#else
    *left = CAMBER_BITS(side_table[at]);
    *right = CAMBER_BITS(side_table[at + 1u]);
#endif
}

/* Adds the image's colour, 0 to 255, bilinearly sampled at fractions u and v of its width and height, for wanted lanes.
 */
CAMBER_FN void camber_add_texels(const camber_image_sampler *m, camber_real u, camber_real v, camber_mask wanted,
                                 camber_real rgba[4]) {
    const camber_real x = u * m->width + 0.5f, y = v * m->height + 0.5f;
    const camber_words column = CAMBER_TO_WORDS(x), row = CAMBER_TO_WORDS(y), at = m->first + row * m->stride + column;
    const camber_real right = x - CAMBER_TO_REAL(column), down = y - CAMBER_TO_REAL(row);
    camber_words a, b, c, d;
    camber_texels_at(m->side_table, at, &a, &b);
    camber_texels_at(m->side_table, at + m->stride, &c, &d);
    for (camber_u32 k = 0; k < 4u; k++) {
        const camber_real from = CAMBER_TO_REAL(a >> 8u * k & 255u), to = CAMBER_TO_REAL(b >> 8u * k & 255u);
        const camber_real below = CAMBER_TO_REAL(c >> 8u * k & 255u), behind = CAMBER_TO_REAL(d >> 8u * k & 255u);
        const camber_real upper = from + (to - from) * right, lower = below + (behind - below) * right;
        const camber_real sum = rgba[k] + (upper + (lower - upper) * down);
        rgba[k] = wanted ? sum : rgba[k];
    }
}

#else
/* The same; the shader has the texture. */
CAMBER_FN void camber_add_texels(camber_image_sampler m, float u, float v, bool wanted, inout float rgba[4]) {
    vec4 texel = wanted ? 255.0 * image_texel(vec2(u, v)) : vec4(0.0);
    for (int k = 0; k < 4; k++)
        rgba[k] += texel[k];
}
#endif

/* ---- Pixels ---- */

/* The positions of pixels: along and across a segment and their distance from it, or in the plane. reach: how much of
 * the plane a pixel spans, in px; 0 without a pitch. */
CAMBER_STRUCT(camber_image_spot) {
    camber_real x, y, distance;
    camber_real reach_x, reach_y;
};

/* Returns the spot of a line's pixel, which camber_stroke_area has filled in. */
CAMBER_FN void camber_line_spot(CAMBER_IN(camber_edge) p, CAMBER_IN(camber_pixel) at,
                                CAMBER_OUT(camber_image_spot) spot) {
    const camber_real arc_a = camber_arc(at->past_a, p->round_a), arc_b = camber_arc(at->past_b, p->round_b);
    spot->x = at->x;
    spot->y = at->y;
    spot->distance = CAMBER_SQRT(arc_a * arc_a + arc_b * arc_b + at->y * at->y);
#if CAMBER_STROKE_PITCHED
    const camber_real least = CAMBER_REAL(1e-4f), away = camber_seen_away(p, at, CAMBER_REAL(1.0f));
    spot->reach_x = 1.0f / CAMBER_MORE(at->scale, least);
    spot->reach_y = 1.0f / CAMBER_MORE(away, least);
#else
    spot->reach_x = CAMBER_REAL(0.0f);
    spot->reach_y = CAMBER_REAL(0.0f);
#endif
}

/* Returns the camera that sees a fill's images. */
CAMBER_FN camber_eye camber_fill_eye(CAMBER_IN(camber_image_sampler) m, camber_eye e) {
    if (m->upright > 0.0f)
        return camber_eye_upright(e);
    return e;
}

/* Returns the spot of a fill's pixel. x and y: its position relative to the picture's middle, in px. */
CAMBER_FN void camber_plane_spot(camber_eye e, camber_real x, camber_real y, CAMBER_OUT(camber_image_spot) spot) {
    const camber_real by_depth = 1.0f + y * (e.fall / e.cosine), least = CAMBER_REAL(CAMBER_PITCH_LEAST);
    const camber_real depth = 1.0f / CAMBER_MORE(by_depth, least);
    spot->x = x * depth + e.x;
    spot->y = y * depth / e.cosine + e.y;
    spot->distance = CAMBER_REAL(0.0f);
    spot->reach_x = depth;
    spot->reach_y = depth * depth / e.cosine;
}

/* Returns how far before a join a position is in the image, given that it is t px before the join on the line. The
 * image is stretched or squeezed near the join, up to `near` px from it, so that its end is on the bisector. A cap
 * leaves it as it is. */
CAMBER_FN camber_real camber_before_joint(camber_real t, float tangent, camber_real y, float near) {
    const camber_real bisector = tangent * y, room = near - bisector, least = CAMBER_REAL(1e-3f);
    const camber_real share = camber_clamp_to_one((t - bisector) / CAMBER_MORE(room, least));
    return tangent == 0.0f ? t : t > near ? t : near * share;
}

/* Returns how many samples are taken along a side of a pixel that spans this many texels. */
CAMBER_FN camber_real camber_samples(camber_real texels) {
    const camber_real least = CAMBER_REAL(1.0f), most = CAMBER_REAL(CAMBER_SAMPLES_MAX), wanted = texels + 0.5f;
    const camber_real bounded = wanted > least ? wanted : least;
    return CAMBER_TRUNCATE(bounded < most ? bounded : most);
}

/* Returns the image's mean colour, premultiplied, 0 to 1, around u and v, over over_u and over_v of its size. It
 * repeats along u; if tiled, also along v. */
CAMBER_FN void camber_image_over(CAMBER_IN(camber_image_sampler) m, camber_real u, camber_real v, camber_real over_u,
                                 camber_real over_v, camber_flag tiled, CAMBER_COLOR(rgba)) {
    const camber_real columns = camber_samples(over_u * m->width), rows = camber_samples(over_v * m->height);
    const camber_real scale = 1.0f / (255.0f * columns * rows);
    const float most_columns = camber_most_of(columns), most_rows = camber_most_of(rows);
    for (camber_u32 k = 0u; k < 4u; k++)
        rgba[k] = CAMBER_REAL(0.0f);
    for (float j = 0.5f; j < most_rows; j += 1.0f)
        for (float i = 0.5f; i < most_columns; i += 1.0f) {
            const camber_real at_u = u + (i / columns - 0.5f) * over_u, at_v = v + (j / rows - 0.5f) * over_v;
            const camber_real down = tiled ? camber_fractions(at_v) : camber_clamp_to_one(at_v);
            camber_add_texels(m, camber_fractions(at_u), down, CAMBER_BOTH(i < columns, j < rows), rgba);
        }
    for (camber_u32 k = 0u; k < 4u; k++)
        rgba[k] *= scale;
}

/* Returns the colour of a line's image. Around a round join or cap the image is swept. */
CAMBER_FN void camber_line_image(CAMBER_IN(camber_image_sampler) m, CAMBER_IN(camber_image_spot) at,
                                 CAMBER_COLOR(rgba)) {
    const camber_real t = m->length - at->x, none = CAMBER_REAL(0.0f), edge = CAMBER_REAL(0.5f);
    const camber_real from_a = camber_before_joint(at->x, m->tangent_a, at->y, m->near);
    const camber_real from_b = m->length - camber_before_joint(t, m->tangent_b, at->y, m->near);
    const camber_real x = at->x < t ? from_a : from_b;
    const camber_mask past = CAMBER_EITHER(x<0.0f, x> m->length);
    const camber_real across = (past ? CAMBER_FABS(at->y) : at->distance) * m->aside;
    const camber_real off = across < edge ? across : edge, side = at->y < 0.0f ? -off : none;
    camber_image_over(m, m->phase + x * m->rate, 0.5f - (at->y > 0.0f ? off : side), CAMBER_FABS(m->rate) * at->reach_x,
                      m->aside * at->reach_y, CAMBER_NO, rgba);
}

/* Returns the colour of a fill's images. If a pixel shows very many texels, it tends to the mean. */
CAMBER_FN void camber_fill_image(CAMBER_IN(camber_image_sampler) m, CAMBER_IN(camber_image_spot) at,
                                 CAMBER_COLOR(rgba)) {
    const camber_real x = at->x - m->left, y = at->y - m->top;
    const camber_real over_u = CAMBER_FABS(m->across_x) * at->reach_x + CAMBER_FABS(m->down_x) * at->reach_y;
    const camber_real over_v = CAMBER_FABS(m->across_y) * at->reach_x + CAMBER_FABS(m->down_y) * at->reach_y;
    const camber_real wide = over_u * m->width, high = over_v * m->height;
    const camber_real share = camber_clamp_to_one(CAMBER_MORE(wide, high) * (1.0f / CAMBER_SAMPLES_MAX) - 1.0f);
    camber_image_over(m, m->across_x * x + m->down_x * y, m->across_y * x + m->down_y * y, over_u, over_v, CAMBER_YES,
                      rgba);
    for (camber_u32 k = 0u; k < 4u; k++)
        rgba[k] += (m->mean[k] * (1.0f / 255.0f) - rgba[k]) * share;
}

#endif
