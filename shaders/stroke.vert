// Makes a vertex from the mesh's records (camber_record in camber.h; expand.c says the same in C) and hands its segment
// to the fragments. METHOD is camber_method. Of strips gl_VertexID is 2 * record, + 1 for the right edge; of kite and fan
// record << 7 | corner.
precision highp float;
precision highp int;

layout(binding = 1) uniform highp usamplerBuffer u_records; // all other samplers are at unit 0
uniform highp sampler2D u_rows; // TEXELS_A_ROW texels a row: half width px, -1 where not drawn, fan's step, translation px;
                                // premultiplied colour; half the gap, below 0 where there is none, blur, px; dashes: the
                                // first one's texel, how many, twice that and 1 where they are round, period px;
                                // from where to where its line is not drawn, shares of its length; its ramp's first
                                // texel and how many stops that has; where its image lies in the texture of patterns, and
                                // how far it reaches, 0 where there is none; px of the line that one takes
uniform vec2 u_origin;          // of this piece in the picture, px
uniform vec2 u_corner;          // of the viewport in the picture, px: it reaches past the piece
uniform int u_table;            // of the rows; of strips the bits of gl_VertexID below the table's number
uniform int u_table_rows;
uniform vec2 u_scale;           // 2 / size of the viewport
uniform int u_tail;             // the texel of dashes and ramps that is their first, in the texture of rows
uniform int u_stride;           // texels a record: measured ones have another, with how far along their line they lie

// What stroke.frag says of them.
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

const float PAD_PX = 0.75, NO_LIMIT_PX = 3.0e38;
const uint FIRST = 2u, RING = 8u, BREAK = 16u, START = 32u; // of a record
const uint AFTER_FIRST = 1u << 26u, BEFORE_LAST = 1u << 27u; // of a join
const uint DOT = 1u, CUT = 3u, TIGHT = 4u; // kinds of joins
const uint ROUND = 0u, BUTT = 1u, SQUARE = 2u, SPLIT_ROUND = 5u; // camber_end
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

float turn_of(uint join) {
    return float(int(join << 16u) >> 16) * (1.0 / 32767.0);
}

uint kind_of(uint join) {
    return join >> 28u;
}

uint end_of(uint join) {
    return join >> 16u & 7u;
}

float tan_half(float q) {
    return 2.0 * q / max(1.0 - q * q, 1e-6);
}

// Where a vertex lies: along its segment from its point, bounded by limit px, and across, both in units of the reach.
struct Extrusion {
    float along, limit, across;
};

// Of an edge; end: 1 at the segment's end, -1 at its start; side: 1 left, -1 right.
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

// The arc alone takes a line thinner than the pixel for one that crosses it. A cap as thin as that ends like a flat one of
// the same area, pi / 4 of half the width further on.
float tip(uint join, float half_width) {
    float reach = 0.785398 * half_width + 1.2 * max(half_width - 0.5, 0.0);
    return kind_of(join) < CUT && end_of(join) == ROUND ? 0.5 + reach : NEVER_PX;
}

// All that is constant over a segment.
void hand_over(vec2 a, vec2 u, float len, float half_width, uint join_a, uint join_b) {
    uint end_a = end_of(join_a), end_b = end_of(join_b);
    vec2 turn_a = half_turn(turn_of(join_a)), turn_b = half_turn(turn_of(join_b));
    v_segment = vec4(a - u_origin, u);
    v_shape = vec4(len, half_width, flat_cap(end_a, half_width), flat_cap(end_b, half_width));
    v_turns = vec4(turn_a, turn_b);
    v_rest = vec4(edge_of(u).zw, foreign_from(end_a, turn_a, (join_a & AFTER_FIRST) != 0u, half_width),
                  foreign_from(end_b, turn_b, (join_b & BEFORE_LAST) != 0u, half_width));
#if TIPS
    v_tips = vec2(tip(join_a, half_width), tip(join_b, half_width));
#endif
#if SHARP_JOINS
    v_ends = uvec3(end_a | end_b << 3, floatBitsToUint(round_from(end_a)), floatBitsToUint(round_from(end_b)));
#endif
}

void main() {
#if METHOD == 0
    int table = gl_VertexID >> u_table, id = gl_VertexID - (table << u_table), i = id >> 1;
    bool right = (id & 1) != 0;
    Record here = record_at(i);
    if ((here.last & BREAK) != 0u) { // the last vertex of the strip before, the first of that behind: no area between
        i += right || i == 0 ? 1 : -1;
        right = !right;
        here = record_at(i);
    }
    uint kind = kind_of(here.join);
    bool is_seam = (here.last & RING) != 0u && kind == CUT, is_outer = kind == TIGHT && right == (turn_of(here.join) > 0.0);
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

#if METHOD == 0
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
    float reach = half_width + PAD_PX;
    vec2 place = here.p + row.zw + u * clamp(e.along * reach, -e.limit, e.limit) + vec2(-u.y, u.x) * (e.across * reach);

    hand_over(a + row.zw, u, len, half_width, join_a, join_b);
#if MEASURED
    vec2 measure_a = measure_at(goes_out ? i : o), measure_b = measure_at(goes_out ? o : i);
    v_measure = vec4(measure_a.x, len > 0.0 ? (measure_b.x - measure_a.x) / len : 0.0, measure_a.y, 0.0);
#endif
#if DASH
    vec4 dashes = row_texel(texel + 3);
    v_measure.w = dashes.z;
    v_dashes = ivec2(dashes.xy) + ivec2(u_tail, 0);
#endif
#if TRIM || RAMP
    vec4 progress = row_texel(texel + 4);
#endif
#if TRIM
    v_trim = progress.xy * max(measure_a.y, 1e-6);
#endif
#if RAMP
    v_ramp = ivec2(progress.zw) + ivec2(u_tail, 0);
#endif
#if PATTERN
    v_image = row_texel(texel + 5);
    float one_px = max(row_texel(texel + 6).x, 1e-3);
    float first = measure_a.x - one_px * floor(measure_a.x / one_px);
    vec4 turns = vec4(half_turn(turn_of(join_a)), half_turn(turn_of(join_b)));
    v_pattern = vec4(first / one_px, v_measure.y / one_px, turns.yw / max(turns.xz, 1e-3));
#endif
    // A row that is not drawn leaves no area; what lies outside the viewport would be clipped at some cost.
    gl_Position = vec4(half_width < 0.0 ? vec2(0.0) : (place - u_corner) * u_scale - 1.0, 0.0, 1.0);
}
