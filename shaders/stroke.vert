// Makes the vertices of strokes. A vertex reads a record of the mesh and its neighbours (camber_record in
// camber_proof.h; src/tess/expand.c does the same in C), and hands all that is constant over its segment to the
// fragments.
//
// METHOD is camber_method. gl_VertexID is, in strips, 2 * record, and 1 more for the right edge; of kite and fan it is
// record << 7 | corner. With PITCHED it is 6 * record + corner of two triangles, whatever the method.
precision highp float;
precision highp int;

layout(binding = 1) uniform highp usamplerBuffer u_records; // all other samplers are at unit 0
// Tables of rows, TEXELS_A_ROW texels a row, then the side table of dashes and ramps. The texels of a row:
//     0  half the width px, -1: not drawn; the step of a fan; translation x, y px
//     1  premultiplied colour
//     2  half the gap px, below 0: none; blur px; 0; 0
//     3  dashes: first texel in the side table; twice their count, and 1 more where they are round; period px; 0
//     4  two shares of the line, between which it is not drawn; its ramp's first texel in the side table; stops of that
//     5  its image in the atlas: corner x, y and size x, y, in texture coordinates; 0: no image
//     6  px of the line that one image takes; 0; 0; 0
uniform highp sampler2D u_rows;
uniform vec2 u_origin;          // of the area in the picture, px
uniform vec2 u_corner;          // of the viewport in the picture, px: it reaches past the area
uniform int u_table;            // kite, fan: number of the table. Others: bits of gl_VertexID below that number
uniform int u_table_rows;
uniform vec2 u_scale;           // 2 / size of the viewport
uniform int u_side_table;       // first texel of the side table
#if PITCHED
uniform vec4 u_eye;             // half the picture's size, px; cosine of the pitch; depth lost a px towards the viewer
#endif
uniform int u_stride;           // texels a record: 2 where it has its arc length, else 1

// stroke.frag says what each is.
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

const float PAD_PX = 0.75, NO_LIMIT_PX = 3.0e38;
const uint FIRST = 2u, RING = 8u, BREAK = 16u, START = 32u; // of a record
const uint AFTER_FIRST = 1u << 26u, BEFORE_LAST = 1u << 27u; // of a join
const uint SENTINEL = 0u, DOT = 1u, CUT = 3u, TIGHT = 4u, SPLIT = 5u; // kinds of joins
const uint ROUND = 0u, BUTT = 1u, SQUARE = 2u, MITER = 3u, SPLIT_ROUND = 5u, SPLIT_BEVEL = 6u,
           SPLIT_MITER = 7u; // camber_end
const float ALWAYS_PX = -1e30;

struct Record {
    vec2 p;
    uint join, last;
};

Record record_at(int i) {
    uvec4 words = texelFetch(u_records, u_stride * i);
    return Record(uintBitsToFloat(words.xy), words.z, words.w);
}

#if MEASURED
// How far along its line a record lies, and how long that is.
vec2 measure_at(int i) {
    return uintBitsToFloat(texelFetch(u_records, u_stride * i + 1).xy);
}
#endif

vec4 row_texel(int i) {
    return texelFetch(u_rows, ivec2(i & 2047, i >> 11), 0);
}

#if RAMP
// How many stops of a ramp lie up to a place px along a line of a length. ramp: its first texel, and its stops.
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

float turn_of(uint join) {
    return float(int(join << 16u) >> 16) * (1.0 / 32767.0);
}

uint kind_of(uint join) {
    return join >> 28u;
}

uint end_of(uint join) {
    uint end = join >> 16u & 7u;
#if PITCHED && METHOD != 0
    // With kite and fan the triangles say what belongs to a segment; here they do not.
    uint split_end = end == ROUND ? SPLIT_ROUND : end == MITER ? SPLIT_MITER : SPLIT_BEVEL;
    end = kind_of(join) > CUT ? split_end : end;
#endif
    return end;
}

float tan_half(float q) {
    return 2.0 * q / max(1.0 - q * q, 1e-6);
}

// Where a vertex lies: along its segment from its point, bounded by limit px, and across, both in units of the reach.
struct Extrusion {
    float along, limit, across;
};

// Places a vertex of an edge. end: 1 at the segment's end, -1 at its start. side: 1 left, -1 right.
Extrusion edge_at(uint join, float end, float side) {
    uint kind = kind_of(join);
    float q = turn_of(join), cut = -end * side * tan_half(q);
    bool is_cut = kind == CUT || kind == TIGHT, inner = side * q > 0.0;
#if METHOD == 0
    float along = is_cut ? cut : end;
#else
    float along = METHOD == 1 && is_cut && inner ? cut : kind < CUT ? end : 0.0;
#endif
    float limit = kind == TIGHT && inner ? float(join >> 19u & 127u) * (PAD_PX / 127.0) : NO_LIMIT_PX;
    return Extrusion(along, kind < CUT && end_of(join) == BUTT ? PAD_PX : limit, side);
}

#if METHOD != 0
const uint CENTRE = 0u, IN_LEFT_CORNER = 1u, OUT_LEFT_CORNER = 3u, OUT_RIGHT_CORNER = 4u, TIP = 5u, IN_TIP = 6u,
           BISECTOR = 7u, OUT_TIP = 8u, FAN = 63u;

Extrusion corner_at(uint corner, float q, float step) {
    float outer = q > 0.0 ? -1.0 : 1.0, a = abs(q), scale = 1.0 / (1.0 + a * a);
    float angle = step * float(int(corner) - int(FAN)), reach = 1.0 / cos(0.5 * step);
    vec2 place = corner == CENTRE     ? vec2(0.0)
                 : corner == TIP      ? vec2(tan_half(a), outer)
                 : corner == IN_TIP   ? vec2(a, outer)
                 : corner == BISECTOR ? vec2(2.0 * a, outer * (1.0 - a * a)) * scale
                 : corner == OUT_TIP  ? vec2(-a, outer)
                                      : vec2(sin(angle), outer * cos(angle)) * reach;
    return Extrusion(place.x, NO_LIMIT_PX, place.y);
}
#endif

// Cosine and sine of half a turn from tan(turn / 4).
vec2 half_turn(float q) {
    float scale = 1.0 / (1.0 + q * q);
    return vec2((1.0 - q * q) * scale, 2.0 * q * scale);
}

// Past a split end a segment has its own side of the bisector only. What its body has past the bisector on the inner
// side it gives up where that is narrow: bends that gentle follow each other on curves, and their edges would be drawn
// twice. More it keeps, and half of that where the line ends soon, as then nothing may cover it.
float foreign_from(uint end, vec2 turn, bool ends_soon, float half_width) {
    bool kept = half_width * abs(turn.y) > (ends_soon ? 0.35 : 0.6) * turn.x;
    return end < SPLIT_ROUND ? NEVER_PX : kept ? 0.0 : ALWAYS_PX;
}

#if SHARP_JOINS
float round_from(uint end) {
    return end == ROUND || end == SPLIT_ROUND ? 0.0 : NEVER_PX;
}
#endif

float flat_cap(uint end, float half_width) {
    return end == BUTT ? 0.0 : end == SQUARE ? half_width : NEVER_PX;
}

// The arc alone takes a line thinner than the pixel for one that crosses it. A cap as thin as that ends like a flat one
// of the same area, pi / 4 of half the width further on.
float tip(uint join, float half_width) {
#if PITCHED
    const float until = 0.0; // how wide it is seen differs from place to place
#else
    float until = 0.5 + 0.785398 * half_width + 1.2 * max(half_width - 0.5, 0.0);
#endif
    return kind_of(join) < CUT && end_of(join) == ROUND ? until : NEVER_PX;
}

#if PITCHED
float depth_at(vec2 p) {
    return 1.0 - u_eye.w * p.y;
}

// No triangle is cut along a bisector: all joins say what belongs to a segment as split ones do.
// narrowest: px of the picture that the line is wide there.
float own_until(uint join, vec2 turn, bool ends_soon, float narrowest) {
    return kind_of(join) == CUT ? ALWAYS_PX : foreign_from(end_of(join), turn, ends_soon, 0.5 * narrowest);
}

vec2 seen_of(vec2 p) {
    return vec2(p.x, p.y * u_eye.z) / depth_at(p);
}

// The direction that u has in the picture, at a place of the plane.
vec2 seen_direction(vec2 p, vec2 u) {
    vec2 seen = vec2(u.x * depth_at(p) + u_eye.w * p.x * u.y, u_eye.z * u.y);
    return seen / max(length(seen), 1e-20);
}

// Px of the picture that a line through a place of the plane is wide.
float seen_width(vec2 p, vec2 u, float half_width) {
    vec2 normal = vec2(-u.y, u.x);
    return 2.0 * half_width / (depth_at(p) * length(vec2(normal.x, (normal.y - u_eye.w * dot(normal, p)) / u_eye.z)));
}

// The direction on the other side of a join; turns: 1 behind it, -1 before.
vec2 other_direction(vec2 u, float turns, uint join) {
    vec2 half_turned = half_turn(turn_of(join));
    float c = half_turned.x * half_turned.x - half_turned.y * half_turned.y,
          s = 2.0 * turns * half_turned.x * half_turned.y;
    return vec2(u.x * c - u.y * s, u.x * s + u.y * c);
}

float narrowest_at(vec2 p, vec2 u, vec2 other, float half_width) {
    return min(seen_width(p, u, half_width), seen_width(p, other, half_width));
}

// A join that is narrower than a pixel as it is seen: the line between the two segments in the picture, by its normal
// and where it lies, and 1 where it is wide and the bisector in the plane parts them, down to 0.
vec4 seen_cut(vec2 p, vec2 u, vec2 other, float turns, uint join, float narrowest) {
    if (kind_of(join) < CUT || depth_at(p) < 1e-3)
        return vec4(0.0, 0.0, 0.0, 1.0);
    vec2 along = seen_direction(p, u), sum = along + seen_direction(p, other);
    vec2 normal = length(sum) > 1e-5 ? normalize(sum) : along;
    return vec4(turns * normal, turns * dot(normal, seen_of(p)), clamp(1.5 * narrowest - 0.75, 0.0, 1.0));
}

// How far the stroke reaches past an end of its segment.
float end_reach(uint join, float half_width) {
    uint kind = kind_of(join), end = end_of(join);
    vec2 turn = half_turn(turn_of(join));
    float sine = abs(turn.y), tip = end == MITER || end == SPLIT_MITER ? sine / max(turn.x, 1e-5) : sine;
    return half_width * (kind < CUT ? (end == BUTT ? 0.0 : 1.0) : kind == SPLIT ? max(tip, 1.0) : tip);
}

// A corner of what the segment's part of the stroke takes of the picture and half a pixel around it, px from its
// middle: a trapezoid along the segment as it is seen. false: nothing is seen.
bool surround(vec2 a, vec2 u, float len, float half_width, uint join_a, uint join_b, int corner, out vec2 place) {
    float from = -end_reach(join_a, half_width), to = len + end_reach(join_b, half_width);
    // Points less deep than the picture's bottom are not seen, and those less than half as deep cannot be projected well.
    float nearest = u_eye.z / (u_eye.z + u_eye.w * u_eye.y), hidden = 0.5 * nearest;
    float spread = u_eye.w * abs(u.x) * half_width, rate = u_eye.w * u.y, room = depth_at(a) - spread - hidden;
    bool right = (corner & 1) != 0, far = corner > 1;
    place = vec2(0.0);
    if (2.0 * spread > nearest - hidden) { // wider than that: a line whose one side is behind the camera may be seen
        place = u_eye.xy * vec2(right ? 1.0 : -1.0, far ? 1.0 : -1.0);
        if (min(room - rate * from, room - rate * to) < 0.0)
            return true;
    }
    to = rate > 0.0 ? min(to, room / rate) : to;
    from = rate < 0.0 ? max(from, room / rate) : from;
    if (from > to || (rate == 0.0 && room < 0.0))
        return false;
    vec2 side = vec2(-u.y, u.x) * half_width, start = seen_of(a + u * from), run = seen_of(a + u * to) - start;
    float seen_length = length(run);
    vec2 axis = seen_length > 1e-3 ? run / seen_length : vec2(1.0, 0.0);
    mat2 turned = mat2(axis.x, -axis.y, axis.y, axis.x); // along, across
    vec2 left_a = turned * (seen_of(a + u * from + side) - start),
         left_b = turned * (seen_of(a + u * to + side) - start);
    vec2 right_a = turned * (seen_of(a + u * from - side) - start),
         right_b = turned * (seen_of(a + u * to - side) - start);
    float begin = min(min(left_a.x, left_b.x), min(right_a.x, right_b.x)) - PAD_PX;
    float end = max(max(left_a.x, left_b.x), max(right_a.x, right_b.x)) + PAD_PX;
    vec2 near_side = right ? right_a : left_a, far_side = right ? right_b : left_b;
    float low = right ? -1.0 : 1.0; // of the two sides in the picture, as in the plane
    float slope = (far_side.y - near_side.y) / max(abs(far_side.x - near_side.x), 1e-3) *
                  sign(far_side.x - near_side.x);
    float at = far ? end : begin;
    vec2 own = far ? vec2(left_b.y, right_b.y) : vec2(left_a.y, right_a.y);
    float widest = max(low * own.x, low * own.y);
    bool tapers = abs(far_side.x - near_side.x) > 4.0 && abs(slope) < 1.0;
    float other = max(low * (far ? left_a.y : left_b.y), low * (far ? right_a.y : right_b.y));
    float across = tapers ? max(widest, low * (near_side.y + slope * (at - near_side.x))) : max(widest, other);
    vec2 found = vec2(at, low * (across + (tapers ? 1.4143 : 1.0) * PAD_PX));
    place = start + axis * found.x + vec2(-axis.y, axis.x) * found.y;
    return true;
}
#endif

// Computes all that is constant over a segment.
void hand_over(vec2 a, vec2 b, vec2 u, float len, float half_width, uint join_a, uint join_b) {
    uint end_a = end_of(join_a), end_b = end_of(join_b);
    vec2 turn_a = half_turn(turn_of(join_a)), turn_b = half_turn(turn_of(join_b));
#if PITCHED
    v_segment = vec4(a, u);
    v_end = b;
    vec2 before = other_direction(u, -1.0, join_a), behind = other_direction(u, 1.0, join_b);
    float narrowest_a = narrowest_at(a, u, before, half_width), narrowest_b = narrowest_at(b, u, behind, half_width);
    v_cut_a = seen_cut(a, u, before, -1.0, join_a, narrowest_a);
    v_cut_b = seen_cut(b, u, behind, 1.0, join_b, narrowest_b);
#else
    v_segment = vec4(a - u_origin, u);
#endif
    v_shape = vec4(len, half_width, flat_cap(end_a, half_width), flat_cap(end_b, half_width));
    v_turns = vec4(turn_a, turn_b);
#if PITCHED
    v_rest = vec4(0.0, 0.0, own_until(join_a, turn_a, (join_a & AFTER_FIRST) != 0u, narrowest_a),
                  own_until(join_b, turn_b, (join_b & BEFORE_LAST) != 0u, narrowest_b));
#else
    v_rest = vec4(edge_of(u).zw, foreign_from(end_a, turn_a, (join_a & AFTER_FIRST) != 0u, half_width),
                  foreign_from(end_b, turn_b, (join_b & BEFORE_LAST) != 0u, half_width));
#endif
#if TIPS
    v_tips = vec2(tip(join_a, half_width), tip(join_b, half_width));
#endif
#if SHARP_JOINS
    v_ends = uvec3(end_a | end_b << 3, floatBitsToUint(round_from(end_a)), floatBitsToUint(round_from(end_b)));
#endif
}

#if PITCHED
// Whether a segment ends at a record, from the record before it; of a dot of kite and fan, at itself.
bool ends_segment(Record r) {
    bool first = (r.last & FIRST) != 0u && (METHOD == 0 || kind_of(r.join) != DOT);
    return kind_of(r.join) != SENTINEL && (r.last & (BREAK | START)) == 0u && !first;
}
#endif

void main() {
#if PITCHED
    // Two triangles a record, of the segment that ends there.
    int table = gl_VertexID >> u_table, id = gl_VertexID - (table << u_table), i = id / 6, place_in = id - 6 * i;
    int seen_corner = place_in < 3 ? place_in : 6 - place_in;
    Record here = record_at(i);
    const bool goes_out = false;
    int o = (METHOD != 0 && kind_of(here.join) == DOT) || i == 0 ? i : i - 1;
#elif METHOD == 0
    int table = gl_VertexID >> u_table, id = gl_VertexID - (table << u_table), i = id >> 1;
    bool right = (id & 1) != 0;
    Record here = record_at(i);
    if ((here.last & BREAK) != 0u) { // the last vertex of the strip before, the first of that behind: no area between
        i += right || i == 0 ? 1 : -1;
        right = !right;
        here = record_at(i);
    }
    uint kind = kind_of(here.join);
    bool is_seam = (here.last & RING) != 0u && kind == CUT,
         is_outer = kind == TIGHT && right == (turn_of(here.join) > 0.0);
    bool is_shared = (here.last & FIRST) != 0u ? is_seam : is_outer;
    bool goes_out = (here.last & (FIRST | START)) != 0u && !is_shared;
    bool is_again = (here.last & START) != 0u; // the end lies between
    int o = goes_out ? i + 1 : is_again ? i - 2 : i - 1;
#else
    int table = u_table, i = gl_VertexID >> 7;
    uint corner = uint(gl_VertexID) & 127u;
    Record here = record_at(i);
    bool goes_out = corner == CENTRE || corner == OUT_LEFT_CORNER || corner == OUT_RIGHT_CORNER || corner == OUT_TIP;
    int o = kind_of(here.join) == DOT ? i : goes_out ? i + 1 : i - 1;
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
#elif METHOD == 0
    Extrusion e = edge_at(here.join, goes_out ? -1.0 : 1.0, right ? -1.0 : 1.0);
#else
    bool is_edge = corner >= IN_LEFT_CORNER && corner <= OUT_RIGHT_CORNER;
    Extrusion edge = edge_at(here.join, goes_out ? -1.0 : 1.0, (corner & 1u) != 0u ? 1.0 : -1.0);
    Extrusion own = corner_at(corner, turn_of(here.join), row.y);
    Extrusion e = Extrusion(is_edge ? edge.along : own.along, is_edge ? edge.limit : own.limit,
                            is_edge ? edge.across : own.across);
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
    float reach = half_width + PAD_PX;
    vec2 place = here.p + row.zw + u * clamp(e.along * reach, -e.limit, e.limit) + vec2(-u.y, u.x) * (e.across * reach);

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
    // Only the stops that a pixel of the segment may see.
    int from = max(stops_up_to(min(measure_a.x, measure_b.x) - 1.0, v_ramp, measure_a.y) - 1, 0);
    int to = min(stops_up_to(max(measure_a.x, measure_b.x) + 1.0, v_ramp, measure_a.y) + 1, v_ramp.y);
    v_ramp = ivec2(v_ramp.x + 2 * from, to - from);
#endif
#endif
#if PATTERN
    v_image = row_texel(texel + 5);
    float one_px = max(row_texel(texel + 6).x, 1e-3);
    float first = measure_a.x - one_px * floor(measure_a.x / one_px);
    vec4 turns = vec4(half_turn(turn_of(join_a)), half_turn(turn_of(join_b)));
    v_pattern = vec4(first / one_px, v_measure.y / one_px, turns.yw / max(turns.xz, 1e-3));
#endif
    // A row that is not drawn leaves no area; what lies outside the viewport would be clipped at some cost.
#if PITCHED
    place += u_eye.xy;
    half_width = is_drawn ? half_width : -1.0;
#endif
    gl_Position = vec4(half_width < 0.0 ? vec2(0.0) : (place - u_corner) * u_scale - 1.0, 0.0, 1.0);
}
