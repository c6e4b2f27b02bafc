// Puts a flattened layer onto the picture, or fills it.
//
//     COVERAGE  the layer has one channel, coverage, and takes a colour
//     UNION     the layer has the four sums that stroke.frag writes, and takes a colour
//     MASKED    the layer has colours that may be translucent by themselves, and a second texture has their alphas, so
//               that a line that lies on itself shows once
//     FILL      there is no layer but one colour; with IMAGES copies of an image side by side
//     FLIPPED   the layer's last row comes first
//
// With none of them the layer has colours of its own, and takes an opacity.
precision highp float;

#if !FILL
uniform mediump sampler2D u_layer;
#endif
#if MASKED
layout(binding = 2) uniform mediump sampler2D u_alphas;
#endif
#if IMAGES
layout(binding = 3) uniform mediump sampler2D u_atlas;
uniform vec4 u_image_rect;       // in the atlas: the corner of the image, and its size
uniform vec2 u_mean;             // where it is one texel
uniform vec2 u_origin;           // of the area in the picture, px
uniform vec2 u_first;            // where a corner of an image lies, px
uniform vec2 u_axis_x, u_axis_y; // images a px, along the image's x and y
uniform vec4 u_eye;              // as stroke.vert has it. 0: the picture is seen from above
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

#if IMAGES
vec4 image_at(vec2 at) {
    return textureLod(u_atlas, u_image_rect.xy + fract(at) * u_image_rect.zw, 0.0);
}

// The mean colour of the images over a pixel. reach: images a px. Of many texels the mean of all stands in.
vec4 images_over(vec2 at, vec2 reach) {
    vec2 texels = reach * u_image_rect.zw * vec2(textureSize(u_atlas, 0));
    ivec2 count = ivec2(clamp(texels + 0.5, 1.0, 8.0));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < count.x * count.y; i++)
        sum += image_at(at + ((vec2(i % count.x, i / count.x) + 0.5) / vec2(count) - 0.5) * reach);
    vec4 mean = textureLod(u_atlas, u_mean, 0.0);
    return mix(sum / float(count.x * count.y), mean, clamp(max(texels.x, texels.y) / 8.0 - 1.0, 0.0, 1.0));
}
#endif

#if FILL
void main() {
    o_color = u_color;
#if IMAGES
    vec2 p = gl_FragCoord.xy + u_origin - u_eye.xy, px = vec2(0.0);
    if (u_eye.w > 0.0) {
        float depth = u_eye.z / (u_eye.z + u_eye.w * p.y);
        p = vec2(p.x, p.y / u_eye.z) * depth;
        px = vec2(depth, depth * depth / u_eye.z);
    }
    p += u_eye.xy - u_first;
    vec2 at = vec2(dot(u_axis_x, p), dot(u_axis_y, p));
    o_color *= u_eye.w > 0.0 ? images_over(at, vec2(dot(abs(u_axis_x), px), dot(abs(u_axis_y), px))) : image_at(at);
#endif
}
#else
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
#ifdef FLIPPED
    at.y = textureSize(u_layer, 0).y - 1 - at.y;
#endif
    vec4 layer = texelFetch(u_layer, at, 0);
#if UNION
    o_color = u_color * united(layer);
#elif COVERAGE
    o_color = u_color * layer.r;
#elif MASKED
    o_color = u_color * vec4(layer.rgb, texelFetch(u_alphas, at, 0).r);
#else
    o_color = u_color * layer;
#endif
}
#endif
