// The coverage of a pixel by its segment's part of a stroke.
// Built with LINEAR (a ramp in place of the exact area), SHARP_JOINS (miter, bevel) and FLAT_CAPS (butt, square), each
// 0 or 1, so that a mesh pays for what it has: a software rasteriser runs every branch. With COUNT it adds 1 of 255 in
// place of the colour, and fragments without coverage leave nothing, in the stencil neither. With UNION it leaves, to be
// summed over all fragments of a pixel, the edge's normal times a (1 - a) and the area a, and a once more, to be gathered
// one over the other: flatten.frag makes the union of them.
precision highp float;

flat in highp vec4 v_segment;
flat in highp vec4 v_shape;
flat in mediump vec4 v_color;
flat in highp uint v_ends;

uniform vec2 u_origin; // of this piece in the picture, px

layout(location = 0) out mediump vec4 o_color;

const uint ROUND = 0u, BUTT = 1u, SQUARE = 2u, MITER = 3u, BEVEL = 4u, SPLIT_ROUND = 5u, SPLIT_BEVEL = 6u, SPLIT_MITER = 7u;

// An edge by its unit normal, larger component p, smaller q: half the pixel's extent along the normal, the part of it
// where the covered area grows linearly, 1 / p and 1 / (2 p q).
struct Edge {
    float extent, straight, slope, curve;
};

Edge edge_of(vec2 normal) {
    vec2 n = abs(normal);
    float p = max(n.x, n.y), q = min(n.x, n.y);
    return Edge(0.5 * (p + q), 0.5 * (p - q), 1.0 / p, q > 1e-4 ? 0.5 / (p * q) : 0.0);
}

// The area of a pixel whose centre lies s px inside an edge.
float covered(float s, Edge e) {
#if LINEAR
    return clamp(s + 0.5, 0.0, 1.0);
#else
    float a = abs(s);
    float rest = max(e.extent - a, 0.0);
    float corner = rest * rest * e.curve;
    float area = s < 0.0 ? corner : 1.0 - corner;
    return a <= e.straight ? 0.5 + s * e.slope : area;
#endif
}

// The area inside two edges that each leave a and b of the pixel, from the cosine of the angle between their normals:
// the smaller where they are parallel, the product at a right angle, what both leave where they face each other.
float inside_both(float a, float b, float cosine) {
    float smaller = min(a, b), product = a * b, least = max(a + b - 1.0, 0.0);
    return mix(product, cosine > 0.0 ? smaller : least, abs(cosine));
}

struct End {
    uint kind;
    float past; // px past the end, along the segment
    float c, s; // cosine and sine of half the turn; s > 0 where it turns towards +y
    bool ends_soon; // the neighbour is its line's first or last segment
};

End end_at(uint flags, float past, float q) {
    float scale = 1.0 / (1.0 + q * q);
    return End(flags & 7u, past, (1.0 - q * q) * scale, 2.0 * q * scale, (flags & 128u) != 0u);
}

bool is_round(uint kind) {
    return kind == ROUND || kind == SPLIT_ROUND;
}

// Past a split end a segment has its own side of the bisector only. What its body has past the bisector on the inner
// side it gives up where that is narrow: bends that gentle follow each other on curves, and their edges would be drawn
// twice. More it keeps, and half of that where the line ends soon, as then nothing may cover it. The two sides know the
// turn to 16 bits only: between them lies a strip of tie px, which both draw, so that neither leaves a hole.
bool is_foreign(End e, float y, float half_width) {
    float tie = 4e-5 * (half_width + 1.0); // the turn is off by at most 4 / 65534
    bool kept = e.past <= 0.0 && half_width * abs(e.s) > (e.ends_soon ? 0.35 : 0.6) * e.c;
    return e.kind >= SPLIT_ROUND && e.c * e.past + e.s * y > tie && !kept;
}

#if FLAT_CAPS
// How far inside a flat cap.
float inside_cap(End e, float half_width) {
    return e.kind == BUTT ? -e.past : e.kind == SQUARE ? half_width - e.past : 1e6;
}
#endif

#if SHARP_JOINS
float cut_join(float area, End e, float y, vec2 u, float half_width) {
    float outer = e.s > 0.0 ? -1.0 : 1.0, sine = abs(e.s);
    // The second line across the join, by its normal in the segment's frame (along, across): a bevel's looks along the
    // bisector, a miter's is the neighbour's edge, a whole turn away.
    bool bevel = e.kind == BEVEL || e.kind == SPLIT_BEVEL;
    vec2 normal = bevel ? vec2(sine, outer * e.c) : vec2(2.0 * sine * e.c, outer * (e.c * e.c - sine * sine));
    float inside = (bevel ? half_width * e.c : half_width) - dot(vec2(e.past, y), normal);
    bool miter = e.kind == MITER || e.kind == SPLIT_MITER;
    bool applies = bevel || (miter && e.past > -1.0 && y * outer > 0.0);
    // The frame of an end looks out of it; the pixel's own axes are a rotation away, mirrored at A.
    float second = covered(inside, edge_of(vec2(normal.x * u.x - normal.y * u.y, normal.x * u.y + normal.y * u.x)));
    return applies ? inside_both(area, second, outer * normal.y) : area;
}
#endif

// How far the next segment takes the line to the side, averaged over the pixel: a share of f lies past the bisector, half
// of f px past it on average, where the line has turned by about 2 s: f * f / 2 * 2 s. Nothing in the inner overlap.
float bend(End e, float y) {
    float b = e.c * e.past + e.s * y, f = max(0.5 + b, 0.0);
    return b > 0.0 ? 0.0 : e.s * f * f;
}

// How much of the pixel a round cap leaves along the line: the arc alone takes a line thinner than the pixel for one
// that crosses it. A cap as thin as that ends like a flat one of the same area, pi / 4 of half the width further on.
float inside_tip(End e, float half_width) {
    float reach = 0.785398 * half_width + 1.2 * max(half_width - 0.5, 0.0);
    return e.kind == ROUND && e.s == 0.0 ? clamp(0.5 + reach - e.past, 0.0, 1.0) : 1.0;
}

#if UNION
// Into the stroke, across the edge that is nearest, in the picture.
vec2 normal_of(End a, End b, float y, vec2 u, float half_width) {
    vec2 off = vec2(is_round(b.kind) ? max(b.past, 0.0) : 0.0, y) - vec2(is_round(a.kind) ? max(a.past, 0.0) : 0.0, 0.0);
    vec2 inward = -off / max(length(off), 1e-3);
#if FLAT_CAPS
    float cap_a = inside_cap(a, half_width), cap_b = inside_cap(b, half_width);
    inward = min(cap_a, cap_b) < half_width - abs(y) ? vec2(cap_a < cap_b ? 1.0 : -1.0, 0.0) : inward;
#endif
    return inward.x * u + inward.y * vec2(-u.y, u.x);
}
#endif

void main() {
    vec2 a = v_segment.xy, u = v_segment.zw;
    float len = v_shape.x, half_width = v_shape.y;
    vec2 q = gl_FragCoord.xy + u_origin - a;
    float x = dot(q, u), y = q.y * u.x - q.x * u.y;
    Edge edge = edge_of(u); // of the sides and, turned by a right angle, of flat caps

    End end_a = end_at(v_ends, -x, v_shape.z);
    End end_b = end_at((v_ends >> 3 & 7u) | (v_ends >> 1 & 128u), x - len, v_shape.w);
    float past = max(max(is_round(end_a.kind) ? end_a.past : 0.0, is_round(end_b.kind) ? end_b.past : 0.0), 0.0);
    // On an arc farther than a pixel from the segment, the distance is all.
    float bent = y - (bend(end_a, y) + bend(end_b, y)) * max(1.0 - past, 0.0);
    float d = sqrt(past * past + bent * bent);
    float area = max(covered(half_width - d, edge) + covered(half_width + d, edge) - 1.0, 0.0);
    area *= max(inside_tip(end_a, half_width) + inside_tip(end_b, half_width) - 1.0, 0.0);
#if SHARP_JOINS
    area = cut_join(area, end_a, y, vec2(-u.x, u.y), half_width);
    area = cut_join(area, end_b, y, u, half_width);
#endif
#if FLAT_CAPS
    area *= max(covered(inside_cap(end_a, half_width), edge) + covered(inside_cap(end_b, half_width), edge) - 1.0, 0.0);
#endif
    bool foreign = is_foreign(end_a, y, half_width) || is_foreign(end_b, y, half_width);
#if COUNT
    if (foreign || area <= 0.0)
        discard;
    o_color = vec4(1.0 / 255.0, 0.0, 0.0, 0.0);
#elif UNION
    // Lines thinner than this have both edges in a pixel, and no one normal.
    bool thick = half_width > 0.4;
    area = foreign ? 0.0 : area;
    o_color = vec4(normal_of(end_a, end_b, y, u, half_width) * (area * (1.0 - area)), area, area);
    o_color.rgb = thick ? o_color.rgb : vec3(0.0);
#else
    o_color = v_color * (foreign ? 0.0 : area);
#endif
}
