// Where an artwork lies and means of its picture, for the preview's samples. Comes after cover.glsl.
struct ArtworkPlace {
    vec3 centre_mm, s, t, toward;  // the plane
    bool through, by_uv, repeat;
    vec4 picture;  // from the plane to the picture: scale, offset
};

// A footprint in the plane or along the mesh's texture coordinates.
struct FlatFootprint {
    vec2 at, a, b;
};

vec2 in_plane(ArtworkPlace place, vec3 v) {
    return vec2(dot(v, place.s), dot(v, place.t));
}

float facing_cover_of(ArtworkPlace place, vec3 normal) {
    return place.through || place.by_uv ? 1.0 : facing_cover(dot(normal, place.toward));
}

// How much of a box of that width around x lies between 0 and 1.
float inside_unit(float x, float width) {
    float w = max(width, 1e-6);
    return clamp((min(x + 0.5 * w, 1.0) - max(x - 0.5 * w, 0.0)) / w, 0.0, 1.0);
}

// Along its longer side in steps as long as the shorter one.
vec4 picture_mean(sampler2DArray picture, int layer, ArtworkPlace place, FlatFootprint flat_print) {
    vec2 at = flat_print.at * place.picture.xy + place.picture.zw;
    vec2 a = flat_print.a * place.picture.xy;
    vec2 b = flat_print.b * place.picture.xy;
    vec2 size = vec2(textureSize(picture, 0).xy);
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
            place.repeat ? 1.0 : inside_unit(uv.x, width.x) * inside_unit(uv.y, width.y);
        if (inside > 0.0) {
            sum += inside * textureGrad(picture, vec3(uv, float(layer)), step_side, shorter);
        }
    }
    return sum / float(steps);
}
