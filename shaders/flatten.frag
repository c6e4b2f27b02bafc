// A flattened layer onto the picture. COVERAGE: it has one channel and takes a colour; UNION: it has the four that
// stroke.frag leaves, and takes a colour; neither: it has its own colours. MASKED: these
// may be translucent by themselves, and their alphas lie beside, so that a line that lies on itself shows once. FILL: there
// is no layer, but a colour, and with IMAGES images side by side.
precision highp float;

#if !FILL
uniform mediump sampler2D u_layer;
#endif
#if MASKED
layout(binding = 2) uniform mediump sampler2D u_alphas;
#endif
#if IMAGES
layout(binding = 3) uniform mediump sampler2D u_patterns;
uniform vec4 u_place;            // of the image in the texture, and how far it reaches
uniform vec2 u_origin;           // of this piece from a corner of an image, px
uniform vec2 u_axis_x, u_axis_y; // images a px, along the image's x and y
#endif
uniform vec4 u_color; // premultiplied; with colours of its own, opacity in all four

layout(location = 0) out mediump vec4 o_color;

#if UNION
// The area under all strokes of a pixel. Two areas a and b that edges cut off together cover
//     the larger      where the edges face alike
//     a + b - ab      where they cross at a right angle
//     a + b           where they face each other
// Their sum and a + b - ab give a and b; the sum of the edges' normals, each by a (1 - a), then gives the angle between
// them. More than two are taken for two. Thin lines leave no sum.
float united(vec4 layer) {
    float sum = layer.b, over = layer.a;
    float root = sqrt(max(sum * sum - 4.0 * max(sum - over, 0.0), 0.0));
    float more = min(0.5 * (sum + root), 1.0), less = clamp(0.5 * (sum - root), 0.0, 1.0);
    float a = more * (1.0 - more), b = less * (1.0 - less);
    float cosine = clamp((dot(layer.rg, layer.rg) - a * a - b * b) / max(2.0 * a * b, 1e-6), -1.0, 1.0);
    float area = mix(over, cosine < 0.0 ? min(sum, 1.0) : more, abs(cosine));
    // Half floats lose as much: the inside is whole.
    return sum <= over ? over : area > 0.99 ? 1.0 : area;
}
#endif

#if FILL
void main() {
    o_color = u_color;
#if IMAGES
    vec2 p = gl_FragCoord.xy + u_origin;
    o_color *= textureLod(u_patterns, u_place.xy + fract(vec2(dot(u_axis_x, p), dot(u_axis_y, p))) * u_place.zw, 0.0);
#endif
}
#else
void main() {
    vec4 layer = texelFetch(u_layer, ivec2(gl_FragCoord.xy), 0);
#if UNION
    o_color = u_color * united(layer);
#elif COVERAGE
    o_color = u_color * layer.r;
#elif MASKED
    o_color = u_color * vec4(layer.rgb, texelFetch(u_alphas, ivec2(gl_FragCoord.xy), 0).r);
#else
    o_color = u_color * layer;
#endif
}
#endif
