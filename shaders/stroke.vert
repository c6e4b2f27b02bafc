// Makes the vertices of strokes. A vertex reads a record of the mesh and its neighbours (camber_record in
// camber_proof.h; src/vertices/expand.c does the same in C), and passes everything that is constant over its segment to
// the fragments.
//
// METHOD is camber_method. In strips, gl_VertexID is 2 * record, and 1 more for the right edge; with kite and fan it is
// record << 7 | corner. With PITCHED it is 6 * record + the corner of two triangles, whatever the method.
precision highp float;
precision highp int;

#define CAMBER_STROKE_PITCHED PITCHED
#define MEASURED (DASH || TRIM || RAMP || PATTERN)
#include "join.h"
#include "pitch.h"

layout(binding = 1) uniform highp usamplerBuffer u_records; // all other samplers are at unit 0
// Tables of rows, TEXELS_A_ROW texels per row, then the side table of dashes and ramps. The texels of a row:
//     0  half the width, px, or -1 if the row is not drawn; the step of a fan; translation x, y, px
//     1  premultiplied colour
//     2  half the gap, px, or below 0 if there is none; blur, px, or below 0 for a smooth step; 0; 0
//     3  dashes: first texel in the side table; twice their count, and 1 more if they are round; period, px; 0
//     4  two fractions of the line, between which it is not drawn; its ramp's first texel in the side table; stop count
//     5  its image in the atlas: corner x, y and size x, y, in texture coordinates; 0: no image
//     6  length of the line that one image takes, px; 0; 0; 0
uniform highp sampler2D u_rows;
uniform vec2 u_origin;          // position of the area in the picture, px
uniform vec2 u_corner;          // position of the viewport in the picture, px; the viewport reaches past the area
uniform int u_table;            // kite, fan: the table's number. Others: how many bits of gl_VertexID are below it
uniform int u_table_rows;
uniform vec2 u_scale;           // 2 / size of the viewport
uniform int u_side_table;       // first texel of the side table
#if PITCHED
uniform vec4 u_eye;             // half the picture's size, px; cosine of the pitch; depth lost per px to the viewer
#endif
uniform int u_stride;           // texels per record: 2 if it has an arc length, else 1

// stroke.frag describes these.
flat out vec4 v_segment;
flat out vec4 v_shape;
flat out vec4 v_turns;
flat out vec4 v_rest;
#if TIPS
flat out vec2 v_tips;
#endif
#if SHARP_JOINS
flat out highp uvec3 v_ends;
#endif
flat out mediump vec4 v_color;
#if GAP || BLUR
flat out vec2 v_band;
#endif
#if MEASURED
flat out vec4 v_measure;
#endif
#if DASH
flat out highp ivec2 v_dashes;
#endif
#if TRIM
flat out vec2 v_trim;
#endif
#if RAMP
flat out highp ivec2 v_ramp;
#endif
#if PATTERN
flat out vec4 v_image;
flat out vec4 v_pattern;
#endif
#if PITCHED
flat out vec2 v_end;
flat out vec4 v_cut_a, v_cut_b;
#endif

struct Record {
    vec2 p;
    uint join, last;
};

Record record_at(int i) {
    uvec4 words = texelFetch(u_records, u_stride * i);
    return Record(uintBitsToFloat(words.xy), words.z, words.w);
}

#if MEASURED
// Returns how far along its line a record is, and how long the line is.
vec2 measure_at(int i) {
    return uintBitsToFloat(texelFetch(u_records, u_stride * i + 1).xy);
}
#endif

vec4 row_texel(int i) {
    return texelFetch(u_rows, ivec2(i & 2047, i >> 11), 0);
}

#if RAMP
// Returns how many stops of a ramp are at or before a position on a line of length len, in px. ramp: its first texel,
// and how many stops it has.
int stops_up_to(float place, ivec2 ramp, float len) {
    int low = 0, high = ramp.y;
    while (low < high) {
        int middle = (low + high) >> 1;
        bool behind = row_texel(ramp.x + 2 * middle).x * len > place;
        high = behind ? middle : high;
        low = behind ? low : middle + 1;
    }
    return low;
}
#endif

// Returns how a segment ends. With kite and fan the triangles decide what belongs to a segment; with PITCHED they do
// not.
uint end_of(uint join) {
#if PITCHED
    return CAMBER_END_KIND(camber_segment_end(join));
#else
    return camber_join_end(join);
#endif
}

bool is_round_cap(uint join) {
    return camber_join_kind(join) < CAMBER_KIND_CUT && end_of(join) == CAMBER_ENDS_ROUND;
}

#if PITCHED
camber_eye eye() {
    return camber_eye(u_eye.x, u_eye.y, u_eye.z, u_eye.w);
}

vec2 seen_of(vec2 p) {
    vec2 seen;
    camber_pitch_see(eye(), p.x, p.y, seen.x, seen.y);
    return seen;
}

// Computes the cut of an end. soon: the bit of the join that says that the line ends with the segment. Returns where
// the end is flat.
float cut_of(vec2 p, vec2 u, float len, float half_width, uint join, uint soon, vec2 turn, float turns,
             out camber_pitch_cut cut) {
    bool own;
    uint end = camber_end_of(join, (join & soon) != 0u, len, turn.x, turn.y, half_width, own);
    camber_pitch_cut_of(eye(), camber_pitch_end(p.x, p.y, u.x, u.y, half_width, turn.x, turn.y, end, own, turns), cut);
    return camber_pitch_flat_from(end, half_width, cut.wide);
}

float end_reach(uint join, float half_width) {
    float c, s;
    camber_half_turn(camber_turn_unpack(join), c, s);
    return camber_pitch_reach(camber_segment_end(join), c, s, half_width);
}

// Finds a corner of a trapezoid in the picture, along the segment as it is seen, that contains the segment's part of
// the stroke and half a pixel around it. place: in px from the picture's middle. Returns false if nothing is seen.
bool surround(vec2 a, vec2 u, float len, float half_width, uint join_a, uint join_b, int corner, out vec2 place) {
    float from = -end_reach(join_a, half_width), to = len + end_reach(join_b, half_width);
    bool right = (corner & 1) != 0, far = corner > 1, all_over;
    bool is_seen = camber_pitch_clip(eye(), a.y, u.x, u.y, half_width, from, to, all_over);
    place = u_eye.xy * vec2(right ? 1.0 : -1.0, far ? 1.0 : -1.0);
    if (all_over || !is_seen)
        return is_seen;
    vec2 side = vec2(-u.y, u.x) * half_width, start = seen_of(a + u * from), run = seen_of(a + u * to) - start;
    float seen_length = length(run);
    vec2 axis = seen_length > 1e-3 ? run / seen_length : vec2(1.0, 0.0);
    mat2 turned = mat2(axis.x, -axis.y, axis.y, axis.x); // along, across
    vec2 left_a = turned * (seen_of(a + u * from + side) - start),
         left_b = turned * (seen_of(a + u * to + side) - start);
    vec2 right_a = turned * (seen_of(a + u * from - side) - start),
         right_b = turned * (seen_of(a + u * to - side) - start);
    float begin = min(min(left_a.x, left_b.x), min(right_a.x, right_b.x)) - CAMBER_PAD_PX;
    float end = max(max(left_a.x, left_b.x), max(right_a.x, right_b.x)) + CAMBER_PAD_PX;
    vec2 near_side = right ? right_a : left_a, far_side = right ? right_b : left_b;
    // the sign of the side across the axis: the sides are in the same order in the picture as in the plane
    float low = right ? -1.0 : 1.0;
    float slope = (far_side.y - near_side.y) / max(abs(far_side.x - near_side.x), 1e-3) *
                  sign(far_side.x - near_side.x);
    float at = far ? end : begin;
    vec2 own = far ? vec2(left_b.y, right_b.y) : vec2(left_a.y, right_a.y);
    float widest = max(low * own.x, low * own.y);
    bool tapers = abs(far_side.x - near_side.x) > 4.0 && abs(slope) < 1.0;
    float other = max(low * (far ? left_a.y : left_b.y), low * (far ? right_a.y : right_b.y));
    float across = tapers ? max(widest, low * (near_side.y + slope * (at - near_side.x))) : max(widest, other);
    vec2 found = vec2(at, low * (across + (tapers ? CAMBER_DIAGONAL : 1.0) * CAMBER_PAD_PX));
    place = start + axis * found.x + vec2(-axis.y, axis.x) * found.y;
    return true;
}
#endif

#if !PITCHED
// Returns camber_flat_end_from and camber_owner_from for an end. Triangles that are cut along the bisector bound it.
vec2 flat_and_owner(uint join, uint soon, vec2 turn, float len, float half_width) {
#if METHOD == 2
    return vec2(camber_flat_from(end_of(join), half_width), CAMBER_NEVER_PX);
#else
    bool is_bounded = camber_join_kind(join) <= CAMBER_KIND_CUT, own;
    uint end = camber_end_of(join, (join & soon) != 0u, len, turn.x, turn.y, half_width, own);
    return vec2(camber_flat_end_from(end, half_width),
                camber_owner_from(is_bounded, own, CAMBER_END_FLAT(end) != 0u));
#endif
}
#endif

// Computes everything that is constant over a segment.
void hand_over(vec2 a, vec2 b, vec2 u, float len, float half_width, uint join_a, uint join_b) {
    uint end_a = end_of(join_a), end_b = end_of(join_b);
    camber_half_turn(camber_turn_unpack(join_a), v_turns.x, v_turns.y);
    camber_half_turn(camber_turn_unpack(join_b), v_turns.z, v_turns.w);
#if PITCHED
    camber_pitch_cut cut_a, cut_b;
    float flat_a = cut_of(a, u, len, half_width, join_a, CAMBER_JOIN_AFTER_FIRST, v_turns.xy, -1.0, cut_a);
    float flat_b = cut_of(b, u, len, half_width, join_b, CAMBER_JOIN_BEFORE_LAST, v_turns.zw, 1.0, cut_b);
    v_shape = vec4(len, half_width, flat_a, flat_b);
    v_segment = vec4(a, u);
    v_end = b;
    v_cut_a = vec4(cut_a.x, cut_a.y, cut_a.at, cut_a.wide);
    v_cut_b = vec4(cut_b.x, cut_b.y, cut_b.at, cut_b.wide);
    v_rest = vec4(0.0, 0.0, cut_a.owner, cut_b.owner);
#else
    camber_profile side;
    camber_profile_of(u.x, u.y, LINEAR != 0, side);
    v_segment = vec4(a - u_origin, u);
    vec2 from_a = flat_and_owner(join_a, CAMBER_JOIN_AFTER_FIRST, v_turns.xy, len, half_width);
    vec2 from_b = flat_and_owner(join_b, CAMBER_JOIN_BEFORE_LAST, v_turns.zw, len, half_width);
    v_shape = vec4(len, half_width, from_a.x, from_b.x);
    v_rest = vec4(side.slope, side.curve, from_a.y, from_b.y);
#endif
#if TIPS
    v_tips = vec2(camber_tip_from(is_round_cap(join_a), half_width), camber_tip_from(is_round_cap(join_b), half_width));
#endif
#if SHARP_JOINS
    v_ends = uvec3(end_a | end_b << 3, floatBitsToUint(camber_round_from(end_a)),
                   floatBitsToUint(camber_round_from(end_b)));
#endif
}

#if PITCHED
// Whether a segment from the record before ends at a record; with kite and fan, a dot ends its own segment.
bool ends_segment(Record r) {
    uint kind = camber_join_kind(r.join);
    bool first = (r.last & CAMBER_POINT_FIRST) != 0u && (METHOD == 0 || kind != CAMBER_KIND_DOT);
    return kind != CAMBER_KIND_SENTINEL && (r.last & (CAMBER_RECORD_BREAK | CAMBER_RECORD_START)) == 0u && !first;
}
#endif

void main() {
#if PITCHED
    // Each record has two triangles, for the segment that ends at it.
    int table = gl_VertexID >> u_table, id = gl_VertexID - (table << u_table), i = id / 6, place_in = id - 6 * i;
    int seen_corner = place_in < 3 ? place_in : 6 - place_in;
    Record here = record_at(i);
    const bool goes_out = false;
    int o = (METHOD != 0 && camber_join_kind(here.join) == CAMBER_KIND_DOT) || i == 0 ? i : i - 1;
#elif METHOD == 0
    int table = gl_VertexID >> u_table, id = gl_VertexID - (table << u_table), i = id >> 1;
    bool right = (id & 1) != 0;
    Record here = record_at(i);
    // a break repeats the last vertex of the strip before it, then the first vertex of the strip after it
    if ((here.last & CAMBER_RECORD_BREAK) != 0u) {
        i += right || i == 0 ? 1 : -1;
        right = !right;
        here = record_at(i);
    }
    float side = right ? -1.0 : 1.0;
    bool goes_out = camber_record_starts(here.last) && !camber_edge_is_shared(here.join, here.last, side);
    bool is_again = (here.last & CAMBER_RECORD_START) != 0u; // the end is between them
    int o = goes_out ? i + 1 : is_again ? i - 2 : i - 1;
#else
    int table = u_table, i = gl_VertexID >> 7;
    uint corner = uint(gl_VertexID) & 127u;
    Record here = record_at(i);
    float side = (corner & 1u) != 0u ? 1.0 : -1.0;
    bool goes_out = camber_corner_goes_out(corner);
    int o = camber_join_kind(here.join) == CAMBER_KIND_DOT ? i : goes_out ? i + 1 : i - 1;
#endif
    Record other = record_at(o);

    int texel = TEXELS_A_ROW * (table * u_table_rows + int(here.last >> 8u));
    vec4 row = row_texel(texel);
    float half_width = row.x;
    v_color = row_texel(texel + 1);
#if GAP || BLUR
    v_band = row_texel(texel + 2).xy;
#endif

#if PITCHED
    bool is_drawn = ends_segment(here);
#else
    // How far from its point the vertex is along the segment, limited to `limit` px, and across it, in units of the
    // reach.
    float along = camber_edge_along(here.join, goes_out ? -1.0 : 1.0, side, uint(METHOD));
    float across = side, limit = camber_edge_limit(here.join, side);
#if METHOD != 0
    float own_along, own_across;
    camber_join_corner_at(corner, camber_turn_unpack(here.join), row.y, own_along, own_across);
    bool is_edge = corner >= CAMBER_CORNER_IN_LEFT && corner <= CAMBER_CORNER_OUT_RIGHT;
    along = is_edge ? along : own_along;
    across = is_edge ? across : own_across;
    limit = is_edge ? limit : CAMBER_NO_LIMIT_PX;
#endif
#endif

    vec2 a = goes_out ? here.p : other.p, segment = goes_out ? other.p - here.p : here.p - other.p;
    uint join_a = goes_out ? here.join : other.join, join_b = goes_out ? other.join : here.join;
    float len = length(segment);
    vec2 u = len > 0.0 ? segment / len : vec2(1.0, 0.0);
#if PITCHED
    vec2 middle = row.zw - u_eye.xy, place;
    is_drawn = is_drawn && surround(a + middle, u, len, max(half_width, 0.0), join_a, join_b, seen_corner, place);
    hand_over(a + middle, here.p + middle, u, len, half_width, join_a, join_b);
#else
    float reach = half_width + CAMBER_PAD_PX;
    vec2 place = here.p + row.zw + u * clamp(along * reach, -limit, limit) + vec2(-u.y, u.x) * (across * reach);

    hand_over(a + row.zw, here.p, u, len, half_width, join_a, join_b);
#endif
#if MEASURED
    vec2 measure_a = measure_at(goes_out ? i : o), measure_b = measure_at(goes_out ? o : i);
    v_measure = vec4(measure_a.x, len > 0.0 ? (measure_b.x - measure_a.x) / len : 0.0, measure_a.y, 0.0);
#endif
#if DASH
    vec4 dashes = row_texel(texel + 3);
    v_measure.w = dashes.z;
    v_dashes = ivec2(dashes.xy) + ivec2(u_side_table, 0);
#endif
#if TRIM || RAMP
    vec4 progress = row_texel(texel + 4);
#endif
#if TRIM
    v_trim = progress.xy * max(measure_a.y, 1e-6);
#endif
#if RAMP
    v_ramp = ivec2(progress.zw) + ivec2(u_side_table, 0);
#if !PITCHED
    // Only the stops that a pixel of the segment may see are kept.
    int from = max(stops_up_to(min(measure_a.x, measure_b.x) - 1.0, v_ramp, measure_a.y) - 1, 0);
    int to = min(stops_up_to(max(measure_a.x, measure_b.x) + 1.0, v_ramp, measure_a.y) + 1, v_ramp.y);
    v_ramp = ivec2(v_ramp.x + 2 * from, to - from);
#endif
#endif
#if PATTERN
    v_image = row_texel(texel + 5);
    float one_px = max(row_texel(texel + 6).x, 1e-3);
    float first = measure_a.x - one_px * floor(measure_a.x / one_px);
    v_pattern = vec4(first / one_px, v_measure.y / one_px, camber_image_tangent(v_turns.x, v_turns.y),
                     camber_image_tangent(v_turns.z, v_turns.w));
#endif
    // The triangles of a row that is not drawn have no area; outside the viewport they would have to be clipped, which
    // costs time.
#if PITCHED
    place += u_eye.xy;
    half_width = is_drawn ? half_width : -1.0;
#endif
    gl_Position = vec4(half_width < 0.0 ? vec2(0.0) : (place - u_corner) * u_scale - 1.0, 0.0, 1.0);
}
