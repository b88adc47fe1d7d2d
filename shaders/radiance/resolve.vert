#version 450 core
// Rectangles in pixels; rows go down and so does NDC here (src/gl/handles.h).
layout(location = 0) in vec2 corner_px;
uniform vec2 u_size_px;

void main() {
    gl_Position = vec4(2.0 * corner_px / u_size_px - 1.0, 0.0, 1.0);
}
