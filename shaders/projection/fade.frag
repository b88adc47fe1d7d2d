#version 450 core
// Between two pictures for the projector, in its own input: from one end to the other no pixel
// goes beyond either.
layout(binding = 0) uniform sampler2D from;
layout(binding = 1) uniform sampler2D to;
uniform float share;
layout(location = 0) out vec4 drive;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    drive = mix(texelFetch(from, at, 0), texelFetch(to, at, 0), share);
}
