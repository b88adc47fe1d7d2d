#version 450 core
// Mean over the covered ones of FACTOR x FACTOR samples; alpha is the share that is covered.
uniform sampler2D u_samples;
layout(location = 0) out vec4 radiance;

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * FACTOR;
    vec4 sum = vec4(0.0);
    for (int j = 0; j < FACTOR; ++j) {
        for (int i = 0; i < FACTOR; ++i) sum += texelFetch(u_samples, first + ivec2(i, j), 0);
    }
    radiance = vec4(sum.rgb / max(sum.a, 1e-6), sum.a * (1.0 / float(FACTOR * FACTOR)));
}
