#version 450 core
// Wanted colours as sRGB, for a projector that nothing corrects: src/jobs/comparison.cpp's
// srgb_from_working() in floats.
layout(binding = 0) uniform sampler2D wanted_working;
uniform mat3 rec709_from_working;
layout(location = 0) out vec4 drive;

#include "srgb.glsl"

void main() {
    vec4 wanted = texelFetch(wanted_working, ivec2(gl_FragCoord.xy), 0);
    drive = vec4(srgb(rec709_from_working * wanted.rgb), 1.0);
}
