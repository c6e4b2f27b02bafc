// Composites a flattened layer onto the picture, or fills the picture with a colour.
//
//     COVERAGE  the layer has one channel, its coverage, and is drawn in a colour
//     UNION     the layer has the four sums that stroke.frag writes, and is drawn in a colour
//     MASKED    the layer has colours that may themselves be translucent, and a second texture has their alphas, so
//               that a line that overlaps itself is seen once
//     FILL      there is no layer, only one colour; images.frag fills with images
//     FLIPPED   the layer's last row comes first
//
// With none of these, the layer has colours of its own and is drawn with an opacity.
precision highp float;
precision highp int;

#include "union.h"

#if !FILL
uniform mediump sampler2D u_layer;
#endif
#if MASKED
layout(binding = 2) uniform mediump sampler2D u_alphas;
#endif
uniform vec4 u_color; // premultiplied; if the layer has colours of its own, the opacity in all four

layout(location = 0) out mediump vec4 o_color;

#if FILL
void main() {
    o_color = u_color;
}
#else
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
#ifdef FLIPPED
    at.y = textureSize(u_layer, 0).y - 1 - at.y;
#endif
    vec4 layer = texelFetch(u_layer, at, 0);
#if UNION
    o_color = u_color * camber_united(layer.a, layer.b, layer.r, layer.g);
#elif COVERAGE
    o_color = u_color * layer.r;
#elif MASKED
    o_color = u_color * vec4(layer.rgb, texelFetch(u_alphas, at, 0).r);
#else
    o_color = u_color * layer;
#endif
}
#endif
