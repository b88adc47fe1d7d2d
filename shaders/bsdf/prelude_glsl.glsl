// GLSL's side of the shared reflectance source. The C++ side is src/appearance/bsdf_source.h.
//
// The subset that both languages read: literals R(1.0); FN before every function; IN(T) for a
// struct that is only read, OUT(T) for results by reference; no swizzle longer than one component, no implicit conversion, no bare
// literal beside a vector.
#define REAL float
#define VEC2 vec2
#define VEC3 vec3
#define R(x) x
#define FN
#define IN(T) T
#define OUT(T) out T
// Of a number that is the same for all that is computed at once
#define PRESENT(x) ((x) > 0.0)
// A formula that tests put off by 2% (src/core/mutation.h)
#define MUTATED(name, x) (x)
// Of shaders/radiance/shade.glsl. By its bits: x != x may be taken for false.
#define IS_NAN(x) ((floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u)
// Of shaders/radiance/glints.glsl
#define INOUT(T) inout T
#define WORD uint
#define word_of(x) uint(int(x))
#define unit_of(w) ((float((w) >> 9u) + 0.5) * 1.1920928955078125e-7)
#define octave_of(x) uintBitsToFloat(floatBitsToUint(x) & 0x7f800000u)
