// One paint of an artwork over what lies below: premultiplied, for blending with ONE and ONE MINUS
// SOURCE ALPHA. Comes after shade.glsl and artwork_packed.glsl or artwork_raster.glsl.
uniform vec3 u_of;  // of colour, of alpha, of what is hidden (ArtworkCoat)

vec4 over_what_lies_below() {
    vec4 mean = artwork_here();
    if (mean.a <= 0.0) return vec4(0.0);
    return vec4(shaded() * (u_of.x * mean.rgb + u_of.y * mean.a), u_of.z * mean.a);
}
