// The coverage of a pixel by its segment's part of a stroke.
//
// A software rasterizer runs every branch, so each of these is 0 or 1 at build time, and a frame pays for what it has:
//
//     LINEAR       coverage is a ramp one pixel wide, in place of the exact area
//     SHARP_JOINS  some joins are miters or bevels          FLAT_CAPS  some caps are butt or square
//     TIPS         some round caps are of thin strokes      THIN       some strokes have both edges in a pixel
//     GAP          some strokes are two rails               BLUR       some strokes fade at their edges
//     DASH         some strokes are dashed                  TRIM       some strokes are drawn in part
//     RAMP         some change their colour along them      PATTERN    some are drawn with images
//     COUNT        adds 1 of 255 in place of the colour; fragments without coverage write nothing, no stencil either
//     UNION        writes sums for flatten.frag's union: the edge's normal times a (1 - a) and the area a add up over
//                  the fragments of a pixel; a once more is gathered one over the other
//     MASK         colours that are translucent by themselves replace what lies below as far as they cover the pixel;
//                  their alpha goes to a second target
//     PITCHED      the plane of the lines is seen at an angle: lengths lie in the plane, and each edge by itself
//                  becomes one of the picture
//
// For the same reason stroke.vert computes what is constant over a segment.
precision highp float;

flat in vec4 v_segment; // A in the area, of PITCHED from where the camera looks at; direction
flat in vec4 v_shape;   // length, half width; at A and B: where a flat cap lies, px past the end
flat in vec4 v_turns;   // cosine and sine of half the turn at A, at B; the sine > 0 where it turns towards +y
flat in vec4 v_rest;    // slope and curve of the edge; at A and B: foreign from here on, px past the end
#if TIPS
flat in vec2 v_tips; // at A and B: where the round cap of a thin line ends, px past the end
#endif
#if SHARP_JOINS
// Camber_end at A and << 3 at B; bits of floats: round from here on at A, at B, px past the end
flat in highp uvec3 v_ends;
#endif
flat in mediump vec4 v_color;
#if GAP || BLUR
flat in vec2 v_band; // half the gap between the rails, below 0 where there is none; blur; px
#endif

#if MEASURED
// At A: how far along the line, px, and how fast that grows; length of the line; period of dashes, px
flat in vec4 v_measure;
#endif
#if DASH
flat in highp ivec2 v_dashes; // the first one's texel; twice how many there are, and 1 where they are round
#endif
#if TRIM
flat in vec2 v_trim; // from where to where the line is not drawn, px along it
#endif
#if RAMP
flat in highp ivec2 v_ramp; // the texel of the first stop that the segment sees; how many it does. 0: no ramp
#endif
#if DASH || RAMP
uniform highp sampler2D u_rows;
#endif
#if PATTERN
flat in vec4 v_image;   // where the image lies in the texture, how far it reaches
// At A: how far in the image, and how fast that grows, in images; tangents of half the turns at A, at B
flat in vec4 v_pattern;
layout(binding = 3) uniform mediump sampler2D u_atlas;
#endif
#if PITCHED
flat in vec2 v_end; // B, as A
// Joins narrower than a pixel: what lies past them in the picture, and 0; to 1 where they are wide
flat in vec4 v_cut_a, v_cut_b;
uniform vec2 u_origin;
uniform vec4 u_eye; // as stroke.vert has them
#endif

layout(location = 0) out mediump vec4 o_color;
#if MASK
layout(location = 1) out mediump vec4 o_alpha;
#endif

// The area of a pixel whose centre lies s px inside an edge.
float covered(float s, vec4 edge) {
#if LINEAR
    return clamp(s + 0.5, 0.0, 1.0);
#else
    float rest = max(edge.x - abs(s), 0.0);
    float corner = min(rest, edge.y);
    float area = corner * corner * edge.w + (rest - corner) * edge.z;
    return s < 0.0 ? area : 1.0 - area;
#endif
}

#if DASH || RAMP
vec4 row_texel(int i) {
    return texelFetch(u_rows, ivec2(i & 2047, i >> 11), 0);
}
#endif

#if PITCHED
vec2 ground; // of the plane that the pixel's centre shows
vec2 seen;   // its place in the picture, from the middle
float depth;

void look() {
    seen = gl_FragCoord.xy + u_origin - u_eye.xy;
    depth = u_eye.z / (u_eye.z + u_eye.w * seen.y);
    ground = vec2(seen.x, seen.y / u_eye.z) * depth;
}

// The normal that an edge of the plane has in the picture, as long as a px of the plane across it measures there, times
// depth. normal: its unit normal in the plane, s px along which it lies from here. It is the same all along an edge.
vec2 seen_normal(vec2 normal, float s) {
    return vec2(normal.x, (normal.y - u_eye.w * (dot(normal, ground) + s)) / u_eye.z);
}

// The area of a pixel whose centre shows a place s px of the plane inside an edge, with the normal out of it.
float covered_plane(float s, vec2 normal) {
    vec2 seen = seen_normal(normal, s);
    float scale = inversesqrt(max(dot(seen, seen), 1e-30));
    return covered(s * scale / depth, edge_of(seen * scale));
}

// Px of the picture that a px of the plane takes, across an edge with this normal here.
float scale_of(vec2 normal) {
    vec2 seen = seen_normal(normal, 0.0);
    return inversesqrt(max(dot(seen, seen), 1e-30)) / depth;
}

// How much of a pixel belongs to a segment at an end. Where the line is wide, all where its centre lies before the
// join. Where it is not, many segments may meet in one pixel, and each takes the share that lies between its ends.
float own_share(vec4 cut, bool foreign) {
    float share = cut.w < 1.0 ? covered(cut.z - dot(cut.xy, seen), edge_of(cut.xy)) : 1.0;
    return mix(share, foreign ? 0.0 : 1.0, cut.w);
}

#define SIDE vec2 // the normal out of the stroke
float covered_side(float s, vec2 side) {
    return covered_plane(s, side);
}
float covered_band(float t, float d, vec2 side) {
    return max(covered_plane(t - d, side) + covered_plane(t + d, -side) - 1.0, 0.0);
}
#else
#define SIDE vec4 // edge_of
float covered_side(float s, vec4 side) {
    return covered(s, side);
}
float covered_band(float t, float d, vec4 side) {
    return max(covered(t - d, side) + covered(t + d, side) - 1.0, 0.0);
}
#endif

#if DASH
// The dash, from where to where, px; a period's last one stands before it once more, and its first one behind it.
vec2 dash_at(int i) {
    return row_texel(v_dashes.x + i).xy;
}

// The area of a pixel that dashes leave, from its place in their period; scale: px of the picture a px along.
float dashes_cover(float t, vec4 edge, float scale) {
    float area = 0.0, drawn = 0.0;
    for (int i = 0; i < v_dashes.y >> 1; i++) {
        vec2 dash = dash_at(i);
        area += covered((t - dash.x) * scale, edge) - covered((t - dash.y) * scale, edge);
        drawn += max(min(dash.y, v_measure.w) - max(dash.x, 0.0), 0.0);
    }
    // Where a pixel holds more than a period, its share that is drawn is all there is to see.
    return mix(drawn / v_measure.w, area, clamp(v_measure.w * scale - 1.0, 0.0, 1.0));
}

// How far it is to the nearest dash.
float dash_distance(float t) {
    float nearest = 1e6;
    for (int i = 0; i < v_dashes.y >> 1; i++) {
        vec2 dash = dash_at(i);
        nearest = min(nearest, max(dash.x - t, t - dash.y));
    }
    return max(nearest, 0.0);
}

#if PITCHED
// The same, below 0 where the dash lies ahead.
float dash_offset(float t) {
    float nearest = 1e6;
    for (int i = 0; i < v_dashes.y >> 1; i++) {
        vec2 dash = dash_at(i);
        float off = t - clamp(t, dash.x, dash.y);
        nearest = abs(off) < abs(nearest) ? off : nearest;
    }
    return nearest;
}

// The area of a line with round dashes that hold less than a pixel each, of that of the whole line.
float dashes_share(float half_width) {
    float drawn = 0.0;
    for (int i = 0; i < v_dashes.y >> 1; i++) {
        vec2 dash = dash_at(i);
        drawn += dash.x >= 0.0 && dash.y <= v_measure.w ? dash.y - dash.x + 1.570796 * half_width : 0.0;
    }
    return min(drawn / v_measure.w, 1.0);
}
#endif
#endif

#if RAMP
// Where a stop lies, px along the line, and its colour.
float stop_at(int i) {
    return row_texel(v_ramp.x + 2 * i).x * v_measure.z;
}

vec4 stop_color(int i) {
    return row_texel(v_ramp.x + 2 * i + 1);
}

// The first stop behind a place.
int stop_behind(float place, int low) {
    int high = v_ramp.y;
    while (low < high) {
        int middle = (low + high) >> 1;
        bool behind = stop_at(middle) > place;
        high = behind ? middle : high;
        low = behind ? low : middle + 1;
    }
    return low;
}

// The mean colour of the ramp over a pixel. The share of the pixel between two stops has the colour in the middle of
// what it sees of them. Where it sees very many stops, several are taken for one.
vec4 ramp_over(float along, vec4 edge, float scale) {
    const int MOST = 16;
    float from = along - edge.x / scale, to = along + edge.x / scale;
    float first = stop_at(0), second = stop_at(min(1, v_ramp.y - 1));
    // Mostly there are only two, far apart.
    if (v_ramp.y < 3 && second - first > 8.0 / scale)
        return mix(stop_color(0), stop_color(1), clamp((along - first) / (second - first), 0.0, 1.0));
    int last = v_ramp.y - 1, i = max(stop_behind(from, 0) - 1, 0), beyond = min(i + MOST, last);
    int stride = stop_at(beyond) > to ? 1 : (min(stop_behind(to, beyond), last) - i + MOST) / MOST;
    float here = stop_at(i), past = covered((along - here) * scale, edge);
    vec4 color = stop_color(i), sum = color * (1.0 - past);
    while (i < last && past > 0.0) {
        i = min(i + stride, last);
        float next = stop_at(i), past_next = covered((along - next) * scale, edge);
        vec4 next_color = stop_color(i);
        float middle = 0.5 * (max(here, from) + min(next, to));
        float part = clamp((middle - here) / max(next - here, 1e-6), 0.0, 1.0);
        sum += mix(color, next_color, part) * (past - past_next);
        here = next;
        past = past_next;
        color = next_color;
    }
    return sum + color * past;
}
#endif

#if SHARP_JOINS || (PITCHED && FLAT_CAPS)
// The area inside two edges that each leave a and b of the pixel, from the cosine of the angle between their normals:
// the smaller where they are parallel, the product at a right angle, what both leave where they face each other.
float inside_both(float a, float b, float cosine) {
    float smaller = min(a, b), product = a * b, least = max(a + b - 1.0, 0.0);
    return mix(product, cosine > 0.0 ? smaller : least, abs(cosine));
}

#endif

#if SHARP_JOINS
const uint MITER = 3u, BEVEL = 4u, SPLIT_BEVEL = 6u, SPLIT_MITER = 7u;

// The second line across a join, by its normal in the segment's frame (along, across). A bevel's normal looks along the
// bisector; a miter's line is the neighbour's edge, a whole turn away. inside: px from it, on the stroke's side.
struct Second {
    vec2 normal;
    float inside, outer;
    bool applies;
};

Second second_line(uint kind, float past, vec2 turn, float y, float half_width) {
    float outer = turn.y > 0.0 ? -1.0 : 1.0, sine = abs(turn.y);
    bool bevel = kind == BEVEL || kind == SPLIT_BEVEL;
    vec2 normal = bevel ? vec2(sine, outer * turn.x)
                        : vec2(2.0 * sine * turn.x, outer * (turn.x * turn.x - sine * sine));
    float inside = (bevel ? half_width * turn.x : half_width) - dot(vec2(past, y), normal);
    bool miter = kind == MITER || kind == SPLIT_MITER;
    return Second(normal, inside, outer, bevel || (miter && past > -1.0 && y * outer > 0.0));
}

#if PITCHED
// u: of the segment; end: 1 at B, -1 at A.
float cut_join_plane(float area, uint kind, float past, vec2 turn, float y, vec2 u, float end, vec2 side,
                     float half_width) {
    Second line = second_line(kind, past, turn, y, half_width);
    vec2 normal = line.normal.x * end * u + line.normal.y * vec2(-u.y, u.x);
    float second = covered_plane(line.inside, normal);
    float cosine = dot(normalize(seen_normal(normal, line.inside)), normalize(seen_normal(side, 0.0)));
    return line.applies ? inside_both(area, second, cosine) : area;
}
#endif

float cut_join(float area, uint kind, float past, vec2 turn, float y, vec2 u, float half_width) {
    Second line = second_line(kind, past, turn, y, half_width);
    // The frame of an end looks out of it; the pixel's own axes are a rotation away, mirrored at A.
    vec2 seen = vec2(line.normal.x * u.x - line.normal.y * u.y, line.normal.x * u.y + line.normal.y * u.x);
    float second = covered(line.inside, edge_of(seen));
    return line.applies ? inside_both(area, second, line.outer * line.normal.y) : area;
}
#endif

#if SHARP_JOINS
// The joins at both ends.
float cut_joins(float area, vec2 past, float y, vec2 u, SIDE side, float half_width) {
#if PITCHED
    area = cut_join_plane(area, v_ends.x & 7u, past.x, v_turns.xy, y, u, -1.0, side, half_width);
    return cut_join_plane(area, v_ends.x >> 3, past.y, v_turns.zw, y, u, 1.0, side, half_width);
#else
    area = cut_join(area, v_ends.x & 7u, past.x, v_turns.xy, y, vec2(-u.x, u.y), half_width);
    return cut_join(area, v_ends.x >> 3, past.y, v_turns.zw, y, u, half_width);
#endif
}
#endif

#if FLAT_CAPS
// px inside both caps. Of a line that is seen aslant they meet the sides at any angle; cosine: of that at B.
float cut_caps(float area, vec2 inside, vec4 edge, float cosine) {
#if PITCHED
    return inside_both(inside_both(area, covered(inside.x, edge), -cosine), covered(inside.y, edge), cosine);
#else
    return area * max(covered(inside.x, edge) + covered(inside.y, edge) - 1.0, 0.0);
#endif
}
#endif

// How far the next segment takes the line to the side, averaged over the pixel, from how far the pixel lies past the
// bisector: a share of f lies past it, half of f px past it on average, where the line has turned by about 2 s: f * f /
// 2 * 2 s. Nothing in the inner overlap.
float bend(float beyond, float s) {
    float f = max(0.5 + beyond, 0.0);
    return beyond > 0.0 ? 0.0 : s * f * f;
}

// How far past the ends, where they are round.
vec2 arcs(vec2 past) {
#if SHARP_JOINS
    past -= uintBitsToFloat(v_ends.yz);
#elif FLAT_CAPS
    past = vec2(v_shape.z < NEVER_PX ? 0.0 : past.x, v_shape.w < NEVER_PX ? 0.0 : past.y);
#endif
    return max(past, 0.0);
}

#if UNION
// Into the stroke, across the edge that is nearest, in the picture.
vec2 normal_of(vec2 past, float y, vec2 u, SIDE side, float half_width) {
#if PITCHED
    vec2 outward = side;
#if FLAT_CAPS
    vec2 cap = v_shape.zw - past;
    outward = min(cap.x, cap.y) * scale_of(u) < (half_width - abs(y)) * scale_of(side) ? (cap.x < cap.y ? -u : u)
                                                                                       : side;
#endif
    return -normalize(seen_normal(outward, 0.0));
#else
    vec2 arc = arcs(past);
    vec2 off = vec2(arc.y - arc.x, y);
    vec2 inward = -off / max(length(off), 1e-3);
#if FLAT_CAPS
    vec2 cap = v_shape.zw - past;
    inward = min(cap.x, cap.y) < half_width - abs(y) ? vec2(cap.x < cap.y ? 1.0 : -1.0, 0.0) : inward;
#endif
    return inward.x * u + inward.y * vec2(-u.y, u.x);
#endif
}
#endif

#if PATTERN
// How far from a joint a place t px before it lies on a line that bends there: the bisector is the joint, and up to two
// widths from it, or half the segment, what lies between is drawn out or pushed together. Past a cap the line goes on.
float before_joint(float t, float tangent, float y) {
    float near = min(0.5 * v_shape.x, 4.0 * v_shape.y), bisector = tangent * y;
    return tangent == 0.0 || t > near ? t : near * clamp((t - bisector) / max(near - bisector, 1e-3), 0.0, 1.0);
}

// The image at x along and y across the segment, d from the line; past a round join it is swept around. scales: px of
// the picture a px along and across.
vec4 image_at(float x, float y, float d, vec2 scales) {
    float t = v_shape.x - x;
    x = x < t ? before_joint(x, v_pattern.z, y) : v_shape.x - before_joint(t, v_pattern.w, y);
    float across = x < 0.0 || x > v_shape.x ? abs(y) : d;
    vec2 place = vec2(v_pattern.x + x * v_pattern.y, 0.5 - sign(y) * min(0.5 * across / v_shape.y, 0.5));
#if PITCHED
    // Far away a pixel holds many texels.
    vec2 reach = vec2(v_pattern.y, 0.5 / v_shape.y) / max(scales, 1e-4);
    ivec2 count = ivec2(clamp(reach * v_image.zw * vec2(textureSize(u_atlas, 0)) + 0.5, 1.0, 8.0));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < count.x * count.y; i++) {
        vec2 part = (vec2(i % count.x, i / count.x) + 0.5) / vec2(count) - 0.5, at = place + part * reach;
        sum += textureLod(u_atlas, v_image.xy + vec2(fract(at.x), clamp(at.y, 0.0, 1.0)) * v_image.zw, 0.0);
    }
    return sum / float(count.x * count.y);
#else
    return textureLod(u_atlas, v_image.xy + vec2(fract(place.x), place.y) * v_image.zw, 0.0);
#endif
}
#endif

void main() {
    float half_width = v_shape.y;
#if PITCHED
    look();
    vec2 u = v_segment.zw, q = ground - v_segment.xy;
    float x = dot(q, u), y = q.y * u.x - q.x * u.y;
    vec2 past = vec2(-x, dot(ground - v_end, u)); // the ends, along the segment
    // Along the line.
    vec2 seen_u = seen_normal(u, 0.0);
    float seen_scale = inversesqrt(max(dot(seen_u, seen_u), 1e-30)), scale = seen_scale / depth;
    seen_u *= seen_scale;
    vec4 edge = edge_of(seen_u);
#else
    vec2 u = v_segment.zw, q = gl_FragCoord.xy - v_segment.xy;
    // Extents of the sides and, turned by a right angle, of flat caps.
    vec4 edge = vec4(edge_extent(u), v_rest.xy);
    float x = dot(q, u), y = q.y * u.x - q.x * u.y;
    vec2 past = vec2(-x, x - v_shape.x); // the ends, along the segment
    const float scale = 1.0;
#endif
    vec2 beyond = v_turns.xz * past + v_turns.yw * y;         // the bisectors

    vec2 ends = arcs(past);
    float arc = max(ends.x, ends.y);
    // On an arc farther than a pixel from the segment, the distance is all.
#if PITCHED
    // A segment that is shorter than a pixel does not know how the line goes on.
    vec2 bends = vec2(bend(beyond.x * scale, v_turns.y), bend(beyond.y * scale, v_turns.w));
    float bent = y - (bends.x + bends.y) / scale * max(1.0 - arc * scale, 0.0) *
                         clamp(v_shape.x * scale - 1.0, 0.0, 1.0);
#else
    float bent = y - (bend(beyond.x, v_turns.y) + bend(beyond.y, v_turns.w)) * max(1.0 - arc, 0.0);
#endif
#if MEASURED
    float along = v_measure.x + clamp(x, 0.0, v_shape.x) * v_measure.y;
#endif
#if DASH
    bool dashed = v_dashes.y != 0, round_dashes = (v_dashes.y & 1) != 0;
    // The ends of the line are its caps' to cut: up to where they do, dashes go on as they are a little inside.
    float inside = min(0.75, 0.5 * v_measure.z), period = v_measure.w;
    float dash_along = round_dashes ? along : clamp(along, inside, v_measure.z - inside);
    float place = dashed ? dash_along - period * floor(dash_along / period) : 0.0;
#if PITCHED
    float dash_off = round_dashes ? dash_offset(place) : 0.0;
#else
    arc += round_dashes ? dash_distance(place) : 0.0;
#endif
#endif
#if PITCHED
    // From the nearest place of the line to here.
    vec2 off = vec2(ends.y * v_cut_b.w - ends.x * v_cut_a.w, bent);
#if TIPS
    // Round caps that are no pixel long, and not seen aslant, end like flat ones of the same area.
    float cap_length = half_width * scale;
    float cosine = dot(seen_u, normalize(seen_normal(vec2(-u.y, u.x), 0.0)));
    float flat_cap = (1.0 - clamp(2.0 * cap_length - 1.0, 0.0, 1.0)) * max(1.0 - 2.0 * abs(cosine), 0.0);
    off.x *= min(v_tips.x - past.x, v_tips.y - past.y) < 0.0 ? 1.0 - flat_cap : 1.0;
#endif
#if DASH
    off.x += dash_off;
#endif
    float d = length(off);
    vec2 side = d > 1e-4 ? (off.x * u + off.y * vec2(-u.y, u.x)) / d : vec2(-u.y, u.x);
    float across = scale_of(side);
#else
    float d = sqrt(arc * arc + bent * bent);
    const float across = 1.0;
    vec4 side = edge;
#endif
#if THIN
    float area = covered_band(half_width, d, side);
#else
    float area = covered_side(half_width - d, side);
#endif
#if DASH && PITCHED
    if (round_dashes && period * scale < 2.0) {
        vec2 lateral = vec2(-u.y, u.x) * (y < 0.0 ? -1.0 : 1.0);
        float whole = covered_band(half_width, abs(y), lateral) * dashes_share(half_width);
        area = mix(whole, area, clamp(period * scale - 1.0, 0.0, 1.0));
    }
#endif
#if TIPS
    // How much of the pixel round caps leave along the line.
#if PITCHED
    vec2 tip = clamp(v_tips - past * scale + 0.5 + 0.785398 * cap_length + 1.2 * max(cap_length - 0.5, 0.0), 0.0, 1.0);
    tip = mix(vec2(1.0), tip, max(1.0 - 2.0 * abs(cosine), 0.0));
#else
    vec2 tip = clamp(v_tips - past, 0.0, 1.0);
#endif
    area *= max(tip.x + tip.y - 1.0, 0.0);
#endif
#if SHARP_JOINS
    area = cut_joins(area, past, y, u, side, half_width);
#endif
#if GAP
    float gap = covered_band(v_band.x, d, side);
#if SHARP_JOINS
    gap = cut_joins(gap, past, y, u, side, v_band.x);
#endif
    area = v_band.x > 0.0 ? max(area - gap, 0.0) : area;
#endif
#if BLUR
    // A ramp from half a pixel outside inwards, and into the gap.
    float rim = half_width - d;
#if SHARP_JOINS
    Second at_a = second_line(v_ends.x & 7u, past.x, v_turns.xy, y, half_width);
    Second at_b = second_line(v_ends.x >> 3, past.y, v_turns.zw, y, half_width);
    rim = min(rim, min(at_a.applies ? at_a.inside : rim, at_b.applies ? at_b.inside : rim));
#endif
    rim *= across;
    float fade = v_band.y + 1.0, inner = v_band.x > 0.0 ? (d - v_band.x) * across + v_band.y : rim;
    area = v_band.y > 0.0 ? clamp((min(rim, inner) + 0.5) / fade, 0.0, 1.0) : area;
#endif
#if FLAT_CAPS
#if PITCHED
    // A line with both sides in the pixel has no angle.
    float meets = half_width * across > 0.5 ? dot(seen_u, normalize(seen_normal(side, 0.0))) : 0.0;
#else
    const float meets = 0.0;
#endif
    area = cut_caps(area, (v_shape.zw - past) * scale, edge, meets);
#endif
#if DASH
    area *= dashed && !round_dashes ? dashes_cover(place, edge, scale) : 1.0;
#endif
#if TRIM
    area *= 1.0 - covered((along - v_trim.x) * scale, edge) + covered((along - v_trim.y) * scale, edge);
#endif
    // The two sides of a split end know the turn to 16 bits only, 4 / 65534 off at most: between them lies a strip that
    // both draw, so that neither leaves a hole.
#if PITCHED
    float tie = 6e-5 * (abs(y) + depth);
#else
    float tie = 4e-5 * half_width + 4e-5;
#endif
    bool foreign = (beyond.x > tie && past.x > v_rest.z) || (beyond.y > tie && past.y > v_rest.w);
#if PITCHED
    float share = own_share(v_cut_a, beyond.x > tie && past.x > v_rest.z) +
                  own_share(v_cut_b, beyond.y > tie && past.y > v_rest.w) - 1.0;
    area *= max(share, 0.0);
    foreign = share <= 0.0;
#endif
#if (GAP || BLUR || MEASURED) && METHOD == 2 && !PITCHED
    // Bodies of fans overlap on the inner side of a join: what one leaves open the other must not fill.
    foreign = foreign || (beyond.x > tie && y * v_turns.y > 0.0) || (beyond.y > tie && y * v_turns.w > 0.0);
#endif
#if COUNT
    if (foreign || area <= 0.0)
        discard;
    o_color = vec4(1.0 / 255.0, 0.0, 0.0, 0.0);
#elif UNION
    // Lines thinner than this have both edges in a pixel, and no one normal.
    bool thick = half_width * across > 0.4;
    area = foreign ? 0.0 : area;
    o_color = vec4(normal_of(past, y, u, side, half_width) * (area * (1.0 - area)), area, area);
    o_color.rgb = thick ? o_color.rgb : vec3(0.0);
#else
    area = foreign ? 0.0 : area;
    o_color = v_color * area;
#if RAMP
    if (area > 0.0 && v_ramp.y > 0)
        o_color *= ramp_over(v_measure.z > 0.0 ? along : -1.0, edge, scale); // a dot has its first
#endif
#if PATTERN
    o_color *= v_image.z > 0.0 ? image_at(x, y, sqrt(dot(ends, ends) + y * y), vec2(scale, across)) : vec4(1.0);
#endif
#if MASK
    o_alpha = vec4(o_color.a, 0.0, 0.0, area);
    o_color.a = area;
#endif
#endif
}
