#version 450 core
// Mean over the fragments of a pixel, weighted by the samples that each one covers. Words of the
// index: more (1 bit), samples, address (ADDRESS_BITS); see src/radiance/packed_fragments.h.
const int WIDTH_SHIFT = 10;
const int WIDTH_MASK = (1 << WIDTH_SHIFT) - 1;
const uint ADDRESS_MASK = (1u << ADDRESS_BITS) - 1u;

uniform sampler2D u_fragments;
uniform usampler2D u_first;
uniform usampler2D u_lists;
layout(location = 0) out vec4 radiance;

ivec2 place(uint address) {
    return ivec2(int(address) & WIDTH_MASK, int(address) >> WIDTH_SHIFT);
}

float samples_of(uint word) {
    return float((word & 0x7fffffffu) >> ADDRESS_BITS);
}

void main() {
    uint word = texelFetch(u_first, ivec2(gl_FragCoord.xy), 0).x;
    vec3 colour = texelFetch(u_fragments, place(word & ADDRESS_MASK), 0).rgb;
    float covered = samples_of(word);
    if (word == 0u) colour = vec3(0.0);
    if ((word & 0x80000000u) != 0u) {
        uint at = word & ADDRESS_MASK;
        vec3 sum = vec3(0.0);
        covered = 0.0;
        do {
            word = texelFetch(u_lists, place(at), 0).x;
            float samples = samples_of(word);
            sum += samples * texelFetch(u_fragments, place(word & ADDRESS_MASK), 0).rgb;
            covered += samples;
            ++at;
        } while ((word & 0x80000000u) != 0u);
        // Fragments of less than half a sample cover nothing.
        colour = covered > 0.0 ? sum / covered : vec3(0.0);
    }
    radiance = vec4(colour, covered * (1.0 / float(SAMPLES)));
}
