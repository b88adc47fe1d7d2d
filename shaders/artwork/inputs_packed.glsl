// What an artwork covers of a fragment: solved beforehand (src/radiance/artwork_inputs.cpp).
uniform sampler2DArray u_artwork;
uniform int u_artwork_layer;

vec4 artwork_here() {
    return texelFetch(u_artwork, ivec3(gl_FragCoord.xy, u_artwork_layer), 0);
}
