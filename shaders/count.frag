// Adds 1 of 255 for each fragment, with coverage or without.
precision mediump float;

layout(location = 0) out vec4 o_color;

void main() {
    o_color = vec4(0.0, 1.0 / 255.0, 0.0, 0.0);
}
