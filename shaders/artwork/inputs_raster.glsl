// What an artwork covers of a sample of the preview, worked out here: the view moves. Comes after
// radiance/inputs_raster.glsl and cover.glsl.
uniform int u_shape;       // as ArtworkShape; 4: a picture
uniform vec3 u_size;       // mm; share; softness in mm
uniform vec3 u_plane_centre_mm, u_plane_s, u_plane_t, u_plane_toward;
uniform bool u_through, u_by_uv;
uniform sampler2DArray u_artwork;
uniform int u_artwork_layer;
uniform vec4 u_picture_frame;  // scale, offset
uniform bool u_repeat;

// How much of a box of that width around x lies between 0 and 1.
float inside_unit(float x, float width) {
    float w = max(width, 1e-6);
    return clamp((min(x + 0.5 * w, 1.0) - max(x - 0.5 * w, 0.0)) / w, 0.0, 1.0);
}

// Along its longer side in steps as long as the shorter one.
vec4 picture_mean(vec2 at, vec2 a, vec2 b) {
    vec2 size = vec2(textureSize(u_artwork, 0).xy);
    bool turned = dot(a * size, a * size) < dot(b * size, b * size);
    vec2 longer = turned ? b : a;
    vec2 shorter = turned ? a : b;
    float ratio = length(longer * size) / max(length(shorter * size), 1.0);
    int steps = int(clamp(ceil(ratio), 1.0, 8.0));
    vec2 step_side = longer / float(steps);
    vec2 width = abs(step_side) + abs(shorter);
    vec4 sum = vec4(0.0);
    for (int k = 0; k < steps; ++k) {
        vec2 uv = at + longer * ((float(k) + 0.5) / float(steps) - 0.5);
        float inside =
            u_repeat ? 1.0 : inside_unit(uv.x, width.x) * inside_unit(uv.y, width.y);
        if (inside > 0.0) {
            sum += inside *
                   textureGrad(u_artwork, vec3(uv, float(u_artwork_layer)), step_side, shorter);
        }
    }
    return sum / float(steps);
}

vec2 in_plane(vec3 v) {
    return vec2(dot(v, u_plane_s), dot(v, u_plane_t));
}

vec4 artwork_here() {
    float facing = u_through ? 1.0 : facing_cover(dot(s_normal, u_plane_toward));
    if (facing <= 0.0) return vec4(0.0);
    vec2 at = u_by_uv ? s_uv : in_plane(s_position_mm - u_plane_centre_mm);
    vec2 a = u_by_uv ? s_uv_across : in_plane(s_across_mm);
    vec2 b = u_by_uv ? s_uv_down : in_plane(s_down_mm);
    if (u_shape < 4) return vec4(facing * shape_cover(u_shape, at, a, b, u_size.x, u_size.y, u_size.z));
    return facing * picture_mean(at * u_picture_frame.xy + u_picture_frame.zw,
                                 a * u_picture_frame.xy,
                                 b * u_picture_frame.xy);
}
