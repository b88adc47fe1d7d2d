// Linear Rec.709 as sRGB, clipped.

// What is no number is black; what clamp makes of it is each driver's own.
bool is_number(vec3 v) {
    return all(lessThanEqual(floatBitsToUint(v) & 0x7fffffffu, uvec3(0x7f800000u)));
}

vec3 srgb(vec3 linear) {
    vec3 v = is_number(linear) ? clamp(linear, 0.0, 1.0) : vec3(0.0);
    return mix(12.92 * v, 1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, greaterThan(v, vec3(0.0031308)));
}
