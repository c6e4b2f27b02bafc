// Places a vertex of the mesh (camber_vertex in camber.h) and hands its segment to the fragments.
layout(location = 0) in vec2 a_point;
layout(location = 1) in vec2 a_segment;
layout(location = 2) in vec2 a_extrude; // along in units of the reach, its bound in px
layout(location = 3) in float a_across; // in units of the reach / 16384
layout(location = 4) in uint a_flags;
layout(location = 5) in vec2 a_turns; // tan(turn / 4) at A and at B
layout(location = 6) in uint a_row;

uniform highp sampler2D u_rows; // two texels a row: half width px, -1 where not drawn; premultiplied colour
uniform vec2 u_corner;          // of the viewport in the picture, px
uniform vec2 u_scale;           // 2 / size of the viewport

flat out highp vec4 v_segment; // A, direction
flat out highp vec4 v_shape;   // length px, half width px, turns
flat out mediump vec4 v_color;
flat out highp uint v_ends; // the vertex's flags

const float PAD_PX = 0.75;
const uint AT_END = 64u;

void main() {
    int texel = 2 * int(a_row);
    int across = textureSize(u_rows, 0).x;
    ivec2 at = ivec2(texel % across, texel / across);
    float half_width = texelFetch(u_rows, at, 0).x;
    v_color = texelFetch(u_rows, at + ivec2(1, 0), 0);

    float len = length(a_segment);
    vec2 u = len > 0.0 ? a_segment / len : vec2(1.0, 0.0);
    float reach = half_width + PAD_PX;
    float along = clamp(a_extrude.x * reach, -a_extrude.y, a_extrude.y);
    vec2 place = a_point + u * along + vec2(-u.y, u.x) * (a_across * (1.0 / 16384.0) * reach);

    v_segment = vec4((a_flags & AT_END) != 0u ? a_point - a_segment : a_point, u);
    v_shape = vec4(len, half_width, a_turns);
    v_ends = a_flags;
    // A row that is not drawn leaves no area.
    gl_Position = half_width < 0.0 ? vec4(2.0, 2.0, 0.0, 1.0) : vec4((place - u_corner) * u_scale - 1.0, 0.0, 1.0);
}
