// Adds 1/255 for each fragment, whether it has coverage or not.
precision mediump float;

layout(location = 0) out vec4 o_color;

void main() {
    o_color = vec4(0.0, 1.0 / 255.0, 0.0, 0.0);
}
