// A flattened layer onto the picture: COVERAGE takes one channel and a colour, else the layer has its own colours.
precision highp float;

uniform mediump sampler2D u_layer;
uniform vec4 u_color; // premultiplied; with colours of its own, opacity in all four

layout(location = 0) out mediump vec4 o_color;

void main() {
    vec4 layer = texelFetch(u_layer, ivec2(gl_FragCoord.xy), 0);
#if COVERAGE
    o_color = u_color * layer.r;
#else
    o_color = u_color * layer;
#endif
}
