// Fills the picture with copies of an image side by side.
precision highp float;
precision highp int;

layout(binding = 3) uniform mediump sampler2D u_atlas;
uniform vec4 u_image_rect;       // the corner of the image in the atlas, and its size
uniform vec2 u_mean;             // where the atlas has the image as a single texel, its mean colour
uniform vec2 u_origin;           // position of the area in the picture, px
uniform vec2 u_first;            // position of a corner of an image, px
uniform vec2 u_axis_x, u_axis_y; // images per px, along the image's x and y
uniform vec4 u_eye;              // as in stroke.vert. 0: the camera has no pitch
uniform vec4 u_color; // premultiplied

layout(location = 0) out mediump vec4 o_color;

vec4 image_texel(vec2 at) {
    return textureLod(u_atlas, u_image_rect.xy + at * u_image_rect.zw, 0.0);
}
#define CAMBER_STROKE_PITCHED 0
#include "images.h"

void main() {
    vec4 mean = 255.0 * textureLod(u_atlas, u_mean, 0.0);
    vec2 size = u_image_rect.zw * vec2(textureSize(u_atlas, 0)), p = gl_FragCoord.xy + u_origin;
    camber_image_sampler m;
    camber_image_spot spot;
    float color[4];
    m.width = size.x;
    m.height = size.y;
    m.left = u_first.x;
    m.top = u_first.y;
    m.across_x = u_axis_x.x;
    m.across_y = u_axis_y.x;
    m.down_x = u_axis_x.y;
    m.down_y = u_axis_y.y;
    m.upright = 0.0;
    for (int k = 0; k < 4; k++)
        m.mean[k] = mean[k];
    if (u_eye.w > 0.0)
        camber_plane_spot(camber_eye(u_eye.x, u_eye.y, u_eye.z, u_eye.w), p.x - u_eye.x, p.y - u_eye.y, spot);
    else
        spot = camber_image_spot(p.x, p.y, 0.0, 0.0, 0.0);
    camber_fill_image(m, spot, color);
    o_color = u_color * vec4(color[0], color[1], color[2], color[3]);
}
