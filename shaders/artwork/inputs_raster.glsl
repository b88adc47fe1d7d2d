// What an artwork covers of a sample of the preview, worked out here: the view moves. Comes after
// radiance/inputs_raster.glsl.
uniform int u_shape;  // as ArtworkShape; 4: a picture
uniform vec3 u_size;  // mm; share; softness in mm
uniform ArtworkPlace u_place;
uniform sampler2DArray u_artwork;
uniform int u_artwork_layer;

vec4 artwork_here() {
    float facing = facing_cover_of(u_place, s_normal);
    if (facing <= 0.0) return vec4(0.0);
    FlatFootprint on = flat_footprint(u_place);
    if (u_shape == 4) return facing * picture_mean(u_artwork, u_artwork_layer, u_place, on);
    return vec4(facing * shape_cover(u_shape, on.at, on.a, on.b, u_size.x, u_size.y, u_size.z));
}
