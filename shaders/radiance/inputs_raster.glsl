// Inputs of a sample from the triangle that was rasterised there: its vertices interpolated, light
// directions as they are, openness and shadows solved at the vertices. Comes after lens.glsl; the
// program calls prepare_sample() first.
uniform sampler2D u_triangles;
uniform float u_samples_a_pixel;  // along a side
uniform vec3 u_eye_mm;
uniform vec3 u_view_centre_mm;

uniform sampler2D u_vertices;  // three texels a vertex: position in mm and u, normal and v, tangent
uniform usampler2D u_corners;  // one a triangle: its vertices, its part
uniform int u_first_back;      // from a vertex's light to that of its back; 0: none has one
uniform sampler2D u_sky;       // one a side of a vertex: radiance of a white diffuser; openness
#if LIGHTS > 0
uniform sampler2D u_visibility;  // texels of four lights, (LIGHTS + 3) / 4 a side
uniform vec3 u_light_direction[LIGHTS];
uniform vec3 u_light_radiance[LIGHTS];  // irradiance, facing the light
uniform float u_light_radius2[LIGHTS];  // half of the disc's angle, squared
#endif

// The sample, from prepare_sample()
uvec4 s_corner, s_lit;  // vertices; where their light is
vec3 s_weight;  // of the corners
vec3 s_position_mm, s_normal;
#ifndef LAMBERT
vec3 s_tangent, s_bitangent, s_eye;
float s_slope_variance;
#endif
#if defined(OVER) || defined(RELIEF)
#define WITH_ARTWORK
// From this sample to the next
vec3 s_across_mm, s_down_mm;
vec2 s_uv, s_uv_across, s_uv_down;

FlatFootprint flat_footprint(ArtworkPlace place) {
    if (place.by_uv) return FlatFootprint(s_uv, s_uv_across, s_uv_down);
    return FlatFootprint(in_plane(place, s_position_mm - place.centre_mm),
                         in_plane(place, s_across_mm),
                         in_plane(place, s_down_mm));
}
#endif
#ifdef RELIEF
uniform ArtworkPlace u_relief_place;
uniform sampler2DArray u_relief;
uniform float u_relief_depth;

// Tilts s_normal, and tells the variance of the slopes (src/scene/artwork_cover.cpp).
float tilt_normal(vec4 tangent) {
    float facing = facing_cover_of(u_relief_place, s_normal);
    if (facing <= 0.0) return 0.0;
    vec4 mean = facing * picture_mean(u_relief, 0, u_relief_place, flat_footprint(u_relief_place));
    vec3 right = u_relief_place.by_uv ? tangent.xyz : u_relief_place.s;
    right -= dot(right, s_normal) * s_normal;
    if (dot(right, right) < 1e-12) right = cross(u_relief_place.t, s_normal);
    right = normalize(right);
    vec3 up = cross(s_normal, right);
    if (u_relief_place.by_uv ? tangent.w < 0.0 : dot(up, u_relief_place.t) < 0.0) up = -up;
    vec2 slope = u_relief_depth * mean.xy;
    s_normal = normalize(s_normal + slope.x * right + slope.y * up);
    return u_relief_depth * u_relief_depth * max(mean.z - dot(mean.xy, mean.xy), 0.0);
}
#endif

vec4 of_vertex(uint k, uint texel) {
    return texelFetch(u_vertices, place_of(3u * k + texel), 0);
}
float cross_2d(vec2 a, vec2 b) {
    return a.x * b.y - a.y * b.x;
}
// Weights on the picture -> weights on the triangle in space.
vec3 in_perspective(vec3 on_picture, vec3 depth) {
    vec3 weight = on_picture / depth;
    return weight / (weight.x + weight.y + weight.z);
}

void prepare_sample() {
    float triangle = texelFetch(u_triangles, ivec2(gl_FragCoord.xy), 0).r;
    s_corner = texelFetch(u_corners, place_of(uint(triangle) - 1u), 0);
    vec3 xa = of_vertex(s_corner.x, 0u).xyz;
    vec3 xb = of_vertex(s_corner.y, 0u).xyz;
    vec3 xc = of_vertex(s_corner.z, 0u).xyz;
    vec3 a = project(xa), b = project(xb), c = project(xc);
    vec3 depth = vec3(a.z, b.z, c.z);
    vec2 at = gl_FragCoord.xy / u_samples_a_pixel;
    float area = cross_2d(b.xy - a.xy, c.xy - a.xy);
    float scale = abs(area) > 1e-8 ? 1.0 / area : 0.0;
    vec3 on_picture;
    on_picture.y = cross_2d(at - a.xy, c.xy - a.xy) * scale;
    on_picture.z = cross_2d(b.xy - a.xy, at - a.xy) * scale;
    on_picture.x = 1.0 - on_picture.y - on_picture.z;
    // Rounding on a sliver must not leave it
    s_weight = clamp(in_perspective(on_picture, depth), 0.0, 1.0);
    s_weight /= s_weight.x + s_weight.y + s_weight.z;

    s_position_mm = s_weight.x * xa + s_weight.y * xb + s_weight.z * xc;
    mat3 normals = mat3(of_vertex(s_corner.x, 1u).xyz,
                        of_vertex(s_corner.y, 1u).xyz,
                        of_vertex(s_corner.z, 1u).xyz);
    vec3 outside = normalize(normals * s_weight);
    // The seen side is the shaded side.
    vec3 flat_normal = cross(xb - xa, xc - xa);
    bool from_inside =
        dot(flat_normal, u_view_centre_mm - s_position_mm) * dot(flat_normal, outside) < 0.0;
    s_normal = from_inside ? -outside : outside;
    s_lit = s_corner + (from_inside ? uint(u_first_back) : 0u);

#if !defined(LAMBERT) || defined(WITH_ARTWORK)
    vec2 step_x = vec2(-(c.y - a.y), b.y - a.y) * -scale / u_samples_a_pixel;
    vec2 step_y = vec2(-(c.x - a.x), b.x - a.x) * scale / u_samples_a_pixel;
    vec3 across = in_perspective(on_picture + vec3(-step_x.x - step_x.y, step_x), depth);
    vec3 down = in_perspective(on_picture + vec3(-step_y.x - step_y.y, step_y), depth);
#endif

#ifdef WITH_ARTWORK
    mat3 positions = mat3(xa, xb, xc);
    s_across_mm = positions * (across - s_weight);
    s_down_mm = positions * (down - s_weight);
    mat3x2 uvs = mat3x2(vec2(of_vertex(s_corner.x, 0u).w, of_vertex(s_corner.x, 1u).w),
                        vec2(of_vertex(s_corner.y, 0u).w, of_vertex(s_corner.y, 1u).w),
                        vec2(of_vertex(s_corner.z, 0u).w, of_vertex(s_corner.z, 1u).w));
    s_uv = uvs * s_weight;
    s_uv_across = uvs * (across - s_weight);
    s_uv_down = uvs * (down - s_weight);
#endif

#if !defined(LAMBERT) || defined(RELIEF)
    vec4 tangent = s_weight.x * of_vertex(s_corner.x, 2u) +
                   s_weight.y * of_vertex(s_corner.y, 2u) +
                   s_weight.z * of_vertex(s_corner.z, 2u);
#endif
#ifdef RELIEF
    float relief_variance = tilt_normal(tangent);
#endif
#ifndef LAMBERT
    s_tangent = normalize(tangent.xyz - dot(tangent.xyz, s_normal) * s_normal);
    s_bitangent = sign(tangent.w) * cross(s_normal, s_tangent);

    s_eye = seen_from(normalize(u_eye_mm - s_position_mm), s_normal);

    // Mean squared slope from one sample to the next, as a square footprint has it.
    vec3 dx = normalize(normals * across) - outside;
    vec3 dy = normalize(normals * down) - outside;
    s_slope_variance = (dot(dx, dx) + dot(dy, dy)) * (1.0 / 12.0);
#ifdef RELIEF
    s_slope_variance += relief_variance;
#endif
#endif
}

vec4 sky_and_openness() {
    return s_weight.x * texelFetch(u_sky, place_of(s_lit.x), 0) +
           s_weight.y * texelFetch(u_sky, place_of(s_lit.y), 0) +
           s_weight.z * texelFetch(u_sky, place_of(s_lit.z), 0);
}

vec3 sky_here() {
    return sky_and_openness().rgb;
}

#if LIGHTS > 0
vec4 visibility_of(uint side, int k) {
    uint texels = uint(LIGHTS + 3) / 4u;
    return texelFetch(u_visibility, place_of(side * texels + uint(k) / 4u), 0);
}
float visibility_here(int k) {
    vec4 visibility = s_weight.x * visibility_of(s_lit.x, k) +
                      s_weight.y * visibility_of(s_lit.y, k) +
                      s_weight.z * visibility_of(s_lit.z, k);
    return visibility[k % 4];
}
#endif

#ifdef LAMBERT

vec3 diffuse_light_here() {
    vec3 sum = sky_here();
#if LIGHTS > 0
    for (int k = 0; k < LIGHTS; ++k) {
        sum += u_light_radiance[k] * (0.3183098861837907 * visibility_here(k) *
                                      max(dot(s_normal, u_light_direction[k]), 0.0));
    }
#endif
    return sum;
}

#else

uniform sampler2DArray u_layers;
uniform float u_layers_unit;
uniform float u_rotation;  // of the environment about +y

vec3 to_local(vec3 direction) {
    return vec3(dot(direction, s_tangent), dot(direction, s_bitangent), dot(direction, s_normal));
}

vec4 eye_here() {
    vec3 wo = to_local(s_eye);
    return vec4(wo.xy, max(wo.z, 0.5e-4), s_slope_variance);
}

vec4 light_here(int k) {
#if LIGHTS > 0
    return vec4(to_local(u_light_direction[k]), visibility_here(k));
#else
    return vec4(0.0);
#endif
}

#ifdef GLINTS
// Of the view whose pixels hold the flakes
uniform vec3 u_pixels_from_mm;
uniform vec3 u_pixels_axis;
uniform float u_pixels_size;  // of one of them, one mm away

// As pixel_side_mm (src/radiance/glints.h).
vec4 place_here() {
    vec3 apart = s_position_mm - u_pixels_from_mm;
    float depth = dot(apart, u_pixels_axis);
    float facing = max(abs(dot(apart, s_normal)), 0.1 * length(apart));
    return vec4(s_position_mm, u_pixels_size * sqrt(max(depth * depth * depth, 0.0) / facing));
}
#endif

// The preview takes all of it for even.
vec3 grazing_here(int unused_layer) {
    return vec3(1.0);
}

vec3 mirrored_here(vec4 unused_layers, float alpha) {
    vec3 d = reflect(-s_eye, s_normal);
    vec2 at = vec2((atan(d.x, -d.z) + u_rotation) * 0.15915494309189535 + 0.5,
                   atan(length(d.xz), d.y) * 0.3183098861837907);
    float wide = sqrt(alpha * alpha + s_slope_variance);
    float layer = min(wide < FIRST_ALPHA ? wide / FIRST_ALPHA
                                         : 1.0 + 2.0 * log2(wide / FIRST_ALPHA),
                      float(LAYERS) - 1.001);
    float below = floor(layer);
    return u_layers_unit * sky_and_openness().a *
           mix(textureLod(u_layers, vec3(at, below), 0.0).rgb,
               textureLod(u_layers, vec3(at, below + 1.0), 0.0).rgb,
               layer - below);
}

#endif
