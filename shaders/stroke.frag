// Computes how much of a pixel its segment's part of a stroke covers.
//
// A software rasterizer runs every branch, so each of these is 0 or 1 at build time, and a frame pays only for what it
// uses:
//
//     LINEAR       coverage is a ramp one pixel wide, instead of the exact area
//     SHARP_JOINS  some joins are miters or bevels          FLAT_ENDS  some caps or joins are flat
//     TIPS         some thin strokes have round caps        THIN       some strokes have both edges in a pixel
//     GAP          some strokes are two rails               BLUR       some strokes fade at their edges
//     DASH         some strokes are dashed                  TRIM       some strokes are drawn only in part
//     RAMP         some strokes change colour along them    PATTERN    some strokes are drawn with images
//     COUNT        adds 1/255 instead of the colour; fragments without coverage write nothing, not even the stencil
//     UNION        writes sums for flatten.frag's union: the edge's normal times a (1 - a), and the area a, add up over
//                  the fragments of a pixel; the last channel gets a again, blended over what is there
//     MASK         colours that are themselves translucent replace what is below as far as they cover the pixel;
//                  their alpha is written to a second target
//     PITCHED      the plane of the lines is seen at an angle: lengths are px of the plane, and each edge separately
//                  becomes an edge of the picture
//
// For the same reason stroke.vert computes everything that is constant over a segment. The formulas are those of the
// kernels, in kernels/features.h and the files that it includes; this file only supplies their inputs.
precision highp float;
precision highp int;

#define CAMBER_STROKE_PITCHED PITCHED
#define MEASURED (DASH || TRIM || RAMP || PATTERN)

flat in vec4 v_segment; // A in the area, or with PITCHED from the point that the camera looks at; direction
flat in vec4 v_shape;   // length, half width; at A and B: where a flat end is, px past the end
flat in vec4 v_turns;   // cosine and sine of half the turn at A, at B; the sine is > 0 if the line turns towards +y
flat in vec4 v_rest;    // slope and curve of the edge; at A and B: how far past the end the segment draws, px
#if TIPS
flat in vec2 v_tips; // at A and B: where the round cap of a thin line ends, px past the end
#endif
#if SHARP_JOINS
// camber_end at A, and << 3 that at B; as the bits of floats, how far past A and B the ends begin to be round, px
flat in highp uvec3 v_ends;
#endif
flat in mediump vec4 v_color;
#if GAP || BLUR
flat in vec2 v_band; // half the gap between the rails, below 0 if there is none; blur; px
#endif

#if MEASURED
// How far along the line A is, px, and the arc length per px; the line's length; the period of dashes, px
flat in vec4 v_measure;
#endif
#if DASH
flat in highp ivec2 v_dashes; // the first dash's texel; twice the number of dashes, and 1 more if they are round
#endif
#if TRIM
flat in vec2 v_trim; // the line is not drawn between these, px along it
#endif
#if RAMP
flat in highp ivec2 v_ramp; // the texel of the first stop that the segment sees; how many it sees. 0: no ramp
#endif
#if DASH || RAMP
uniform highp sampler2D u_rows;
#endif
#if PATTERN
flat in vec4 v_image;   // position of the image in the texture, and its size there
// How far into the image A is, and the images per px; the tangents of half the turns at A and at B
flat in vec4 v_pattern;
layout(binding = 3) uniform mediump sampler2D u_atlas;
#endif
#if PITCHED
flat in vec2 v_end; // B, as A in v_segment
// The cuts of the joins in the picture; the last component is 0 if a join is narrower than a pixel, up to 1 if it is
// wide
flat in vec4 v_cut_a, v_cut_b;
uniform vec2 u_origin;
uniform vec4 u_eye; // as in stroke.vert
#endif

layout(location = 0) out mediump vec4 o_color;
#if MASK
layout(location = 1) out mediump vec4 o_alpha;
#endif

// The formulas call these: the beginning and end of a dash, in px; the position of a stop, as a fraction of the line,
// and its colour; the image's colour at fractions of its width and height.
#if DASH || RAMP
vec4 row_texel(int i) {
    return texelFetch(u_rows, ivec2(i & 2047, i >> 11), 0);
}
#endif

vec2 dash_at(uint i) {
#if DASH
    return row_texel(v_dashes.x + int(i)).xy;
#else
    return vec2(0.0);
#endif
}

float stop_at(uint i) {
#if RAMP
    return row_texel(v_ramp.x + 2 * int(i)).x;
#else
    return 0.0;
#endif
}

vec4 stop_color(uint i) {
#if RAMP
    return row_texel(v_ramp.x + 2 * int(i) + 1);
#else
    return vec4(0.0);
#endif
}

#include "features.h"

#if PATTERN
vec4 image_texel(vec2 at) {
    return textureLod(u_atlas, v_image.xy + at * v_image.zw, 0.0);
}
#include "images.h"
#endif

// Returns the coefficients of the fragment's segment.
camber_edge edge_here() {
    camber_edge p;
    p.ux = v_segment.z;
    p.uy = v_segment.w;
    p.length = v_shape.x;
    p.half_width = v_shape.y;
    p.flat_a = v_shape.z;
    p.flat_b = v_shape.w;
    p.ca = v_turns.x;
    p.sa = v_turns.y;
    p.cb = v_turns.z;
    p.sb = v_turns.w;
    p.owner_a = v_rest.z;
    p.owner_b = v_rest.w;
    p.linear = LINEAR != 0;
    p.thin = THIN != 0;
    p.tips = TIPS != 0;
    p.capped = FLAT_ENDS != 0;
    p.sharp = SHARP_JOINS != 0;
#if SHARP_JOINS
    p.end_a = v_ends.x & 7u;
    p.end_b = v_ends.x >> 3;
    p.round_a = uintBitsToFloat(v_ends.y);
    p.round_b = uintBitsToFloat(v_ends.z);
#else
    p.end_a = p.end_b = CAMBER_ENDS_ROUND;
    p.round_a = FLAT_ENDS != 0 && v_shape.z < CAMBER_NEVER_PX && v_turns.y == 0.0 ? CAMBER_NEVER_PX : 0.0;
    p.round_b = FLAT_ENDS != 0 && v_shape.w < CAMBER_NEVER_PX && v_turns.w == 0.0 ? CAMBER_NEVER_PX : 0.0;
#endif
#if TIPS
    p.tip_a = v_tips.x;
    p.tip_b = v_tips.y;
#else
    p.tip_a = p.tip_b = CAMBER_NEVER_PX;
#endif
#if PITCHED
    vec2 a = v_segment.xy;
    p.by_cosine = 1.0 / u_eye.z;
    p.fall = u_eye.w;
    p.along_a = dot(a, v_segment.zw);
    p.across_a = a.y * p.ux - a.x * p.uy;
    p.bends = camber_line_bends(p.sa, p.sb);
    p.wide_a = v_cut_a.w;
    p.wide_b = v_cut_b.w;
    p.cut_a.x = v_cut_a.x;
    p.cut_a.y = v_cut_a.y;
    p.cut_a.at = v_cut_a.z;
    p.cut_b.x = v_cut_b.x;
    p.cut_b.y = v_cut_b.y;
    p.cut_b.at = v_cut_b.z;
    camber_profile_of(v_cut_a.x, v_cut_a.y, p.linear, p.cut_a.cuts);
    camber_profile_of(v_cut_b.x, v_cut_b.y, p.linear, p.cut_b.cuts);
#else
    camber_profile_begin(p.ux, p.uy, p.linear, p.side);
    p.side.slope = v_rest.x;
    p.side.curve = v_rest.y;
#endif
    return p;
}

// Returns the position of the fragment. The two sides of a split end know the turn only to 16 bits, at most 4 / 65534
// off. So both draw a strip between them, as wide as the tie, and there is no hole.
camber_pixel pixel_here(camber_edge p) {
    camber_pixel at;
    vec2 u = v_segment.zw;
#if PITCHED
    vec2 seen = gl_FragCoord.xy + u_origin - u_eye.xy;
    float depth = u_eye.z / (u_eye.z + u_eye.w * seen.y);
    vec2 ground = vec2(seen.x, seen.y * p.by_cosine) * depth, q = ground - v_segment.xy;
    at.seen_x = seen.x;
    at.seen_y = seen.y;
    at.by_depth = 1.0 / depth;
    at.ground_x = ground.x;
    at.ground_y = ground.y;
    at.past_b = dot(ground - v_end, u);
#else
    vec2 q = gl_FragCoord.xy - v_segment.xy;
    at.past_b = dot(q, u) - p.length;
#endif
    at.x = dot(q, u);
    at.y = q.y * u.x - q.x * u.y;
    at.past_a = -at.x;
#if PITCHED
    at.tie = 6e-5 * (abs(at.y) + depth);
#else
    // The vertices of triangles that are cut along the bisector are rounded to multiples of 1/256 px.
    at.tie = 4e-5 * p.half_width + (METHOD == 0 ? 4e-5 : 1.0 / 128.0);
#endif
    at.fa = -(p.ca * at.past_a + p.sa * at.y);
    at.fb = p.cb * at.past_b + p.sb * at.y;
    at.along = 0.0;
    return at;
}

// Returns the coefficients of the line's features.
camber_extras extras_here() {
    camber_extras e;
    e.features = 0u;
    e.round_dashes = false;
    e.dash_count = e.stop_count = 0u;
    e.half_gap = e.blur = e.along = e.rate = e.total = e.trim_from = e.trim_to = 0.0;
    e.period = e.drawn = 1.0;
#if GAP || BLUR
    e.half_gap = v_band.x;
    e.blur = v_band.y;
    e.features |= GAP != 0 && e.half_gap > 0.0 ? CAMBER_FEATURE_GAP : 0u;
    e.features |= BLUR != 0 && e.blur != 0.0 ? CAMBER_FEATURE_BLUR : 0u;
#endif
#if MEASURED
    e.along = v_measure.x;
    e.rate = v_measure.y;
    e.total = v_measure.z;
#endif
#if DASH
    e.features |= v_dashes.y != 0 ? CAMBER_FEATURE_DASH : 0u;
    e.period = v_measure.w;
    e.dash_count = uint(v_dashes.y >> 1);
    e.round_dashes = (v_dashes.y & 1) != 0;
    if (e.period < CAMBER_SMALL_PERIOD_PX)
        e.drawn = camber_dashes_drawn(e);
#endif
#if TRIM
    e.features |= CAMBER_FEATURE_TRIM;
    e.trim_from = v_trim.x;
    e.trim_to = v_trim.y;
#endif
#if RAMP
    e.features |= v_ramp.y > 0 ? CAMBER_FEATURE_RAMP : 0u;
    e.stop_count = uint(v_ramp.y);
#endif
    return e;
}

#if RAMP
vec4 ramp_here(camber_edge p, camber_extras e, camber_pixel at) {
    float color[4], extent = camber_extent_along(p, at), last = stop_at(e.stop_count - 1u), first = stop_at(0u);
    // Usually there are only two stops, far apart.
    if (e.stop_count < 3u && (last - first) * e.total > 8.0 * extent)
        camber_ramp_between(e, 1u, at.along, color);
    else
        camber_ramp_over(p, e, at, at.along - extent, at.along + extent, color);
    return vec4(color[0], color[1], color[2], color[3]);
}
#endif

#if PATTERN
vec4 image_here(camber_edge p, camber_pixel at) {
    camber_image_sampler m;
    camber_image_spot spot;
    float color[4];
    vec2 size = v_image.zw * vec2(textureSize(u_atlas, 0));
    m.width = size.x;
    m.height = size.y;
    m.phase = v_pattern.x;
    m.rate = v_pattern.y;
    m.tangent_a = v_pattern.z;
    m.tangent_b = v_pattern.w;
    camber_image_along(p, m);
    camber_line_spot(p, at, spot);
    camber_line_image(m, spot, color);
    return vec4(color[0], color[1], color[2], color[3]);
}
#endif

void main() {
    camber_edge p = edge_here();
    camber_pixel at = pixel_here(p);
    camber_extras e = extras_here();
    float area = camber_stroke_area(p, e, e.features, at, false);
#if (GAP || BLUR || MEASURED) && METHOD == 2 && !PITCHED
    // Bodies of fans overlap on the inner side of a join: what one segment leaves open, the other must not fill.
    area = (at.fa < -at.tie && at.y * p.sa > 0.0) || (at.fb > at.tie && at.y * p.sb > 0.0) ? 0.0 : area;
#endif
#if COUNT
    if (area < 1e-5) // GPUs differ in the last bits if an edge passes through the pixel's centre
        discard;
    o_color = vec4(1.0 / 255.0, 0.0, 0.0, 0.0);
#elif UNION
    vec2 normal;
    bool thick = camber_edge_normal(p, at, normal.x, normal.y);
    o_color = vec4(normal * (area * (1.0 - area)), area, area);
    o_color.rgb = thick ? o_color.rgb : vec3(0.0);
#else
    o_color = v_color * area;
#if RAMP
    if (area > 0.0 && v_ramp.y > 0)
        o_color *= ramp_here(p, e, at);
#endif
#if PATTERN
    o_color *= v_image.z > 0.0 ? image_here(p, at) : vec4(1.0);
#endif
#if MASK
    o_alpha = vec4(o_color.a, 0.0, 0.0, area);
    o_color.a = area;
#endif
#endif
}
