#!/bin/bash
# Draws docs/images/artwork.jpg anew: the car in two tones with stripes and a number, and a
# refrigerator with a printed pattern beside one with a woven relief. Needs ImageMagick,
# openimageio-tools and a build of the targets livery and livery_assets.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
livery=${LIVERY:-$root/build/release/bin/livery}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

lights='"lights": [
  {"type": "directional", "direction": [-0.45, 0.75, 0.55], "radiance": [1, 1, 1], "angle_rad": 0.05236},
  {"type": "directional", "direction": [0.75, 0.35, 0.6], "radiance": [0.25, 0.25, 0.25], "angle_rad": 0.05236}],
 "environment": {"file": "assets/environments/studio.hdr", "rotation_rad": 0, "scale": 1}'

cat > "$work/car.json" << EOF
{"format_version": 1, "name": "two tones and a number",
 "parts": {"body": "sea green metallic", "glass": "dark glass", "rims": "rim alloy",
  "tyres": "tyre rubber", "lights": "lamp glass", "trim": "black trim"},
 "artwork": [
  {"name": "upper half", "part": "body", "paint": "solid ivory", "shape": "half",
   "place": {"centre_mm": [0, 31, 0], "up": [0.06, 1, 0]}},
  {"name": "stripes", "part": "body", "paint": "matte dark red", "shape": "stripes", "size_mm": 200, "share": 0.045,
   "place": {"centre_mm": [0, 0, 7], "direction": [0, -1, 0], "up": [1, 0, 0]}},
  {"name": "stripes", "part": "body", "paint": "matte dark red", "shape": "stripes", "size_mm": 200, "share": 0.045,
   "place": {"centre_mm": [0, 0, -7], "direction": [0, -1, 0], "up": [1, 0, 0]}},
  {"name": "number", "part": "body", "paint": "solid white", "shape": "picture",
   "picture": "assets/patterns/roundel.png", "use": "cover", "size_mm": 21,
   "place": {"centre_mm": [-4, 27, 0], "direction": [0, 0, -1], "through": false}}],
 $lights, "exposure_ev": -0.1}
EOF

# Boxes with chamfered fronts: x and y of a corner, width, height, back, front, chamfer.
awk 'function box(name, x, y, w, h, z0, z1, c,   k) {
    print "o " name
    v(x, y, z0); v(x + w, y, z0); v(x + w, y + h, z0); v(x, y + h, z0)
    v(x, y, z1 - c); v(x + w, y, z1 - c); v(x + w, y + h, z1 - c); v(x, y + h, z1 - c)
    v(x + c, y + c, z1); v(x + w - c, y + c, z1); v(x + w - c, y + h - c, z1); v(x + c, y + h - c, z1)
    f(4, 3, 2, 1); f(9, 10, 11, 12)
    for (k = 0; k < 2; ++k) {
        f(1 + 4 * k, 2 + 4 * k, 6 + 4 * k, 5 + 4 * k); f(2 + 4 * k, 3 + 4 * k, 7 + 4 * k, 6 + 4 * k)
        f(3 + 4 * k, 4 + 4 * k, 8 + 4 * k, 7 + 4 * k); f(4 + 4 * k, 1 + 4 * k, 5 + 4 * k, 8 + 4 * k)
    }
    n += 12
}
function v(a, b, c) { print "v " a, b, c }
function f(a, b, c, d) { print "f " a + n, b + n, c + n, d + n }
BEGIN {
    box("case", -31, 4, 62, 174, -30, 24, 1)
    box("doors", -31, 122, 62, 56, 25, 31, 1.6)
    box("doors", -31, 4, 62, 116, 25, 31, 1.6)
    box("handles", 22, 128, 2.4, 30, 31, 35, 0.8)
    box("handles", 22, 76, 2.4, 38, 31, 35, 0.8)
    box("feet", -28, 0, 56, 4, -26, 20, 0.5)
}' > "$work/refrigerator.obj"

refrigerator() { # name, artwork, paint
    cat > "$work/$1.json" << EOF
{"format_version": 1, "name": "$1",
 "parts": {"case": "$3", "doors": "$3", "handles": "chrome trim", "feet": "soft black plastic"},
 "artwork": [$2], $lights, "exposure_ev": -0.1}
EOF
}
refrigerator printed '{"part": "doors", "paint": "solid white", "shape": "picture", "use": "colours",
  "picture": "assets/patterns/blossoms.png", "repeat": true, "size_mm": 62,
  "place": {"centre_mm": [0, 100, 0]}}' "solid white"
refrigerator woven '{"part": "doors", "shape": "picture", "use": "relief", "picture":
  "assets/patterns/weave.png", "repeat": true, "size_mm": 24, "depth": 0.6,
  "place": {"centre_mm": [0, 100, 0]}}' "graphite metallic"

# camera WIDTH HEIGHT AZIMUTH ELEVATION DISTANCE FOCAL TARGET_Y: a file, and where it stands.
camera() {
    awk -v w="$1" -v h="$2" -v a="$3" -v e="$4" -v far="$5" -v focal="$6" -v up="$7" 'BEGIN {
        rad = atan2(0, -1) / 180; az = a * rad; el = e * rad
        d[0] = cos(el) * cos(az); d[1] = sin(el); d[2] = cos(el) * sin(az)
        r[0] = d[2] / cos(el); r[1] = 0; r[2] = -d[0] / cos(el)
        n[0] = -d[1] * r[2]; n[1] = -(d[2] * r[0] - d[0] * r[2]); n[2] = d[1] * r[0]
        t[0] = 0; t[1] = up; t[2] = 0
        for (k = 0; k < 3; ++k) { p[k] = t[k] + far * d[k]; f[k] = -d[k] }
        printf "{\"width\": %d, \"height\": %d,\n", w, h
        printf "\"matrix\": [%g, 0, %g, 0, %g, %g, 0, 0, 1],\n", focal, w / 2, focal, h / 2
        printf "\"distortion\": [0, 0, 0, 0, 0],\n\"rotation\": [%.9f, %.9f, %.9f, ", r[0], r[1], r[2]
        printf "%.9f, %.9f, %.9f, %.9f, %.9f, %.9f],\n", n[0], n[1], n[2], f[0], f[1], f[2]
        printf "\"translation_mm\": [%.6f, %.6f, %.6f]}\n", -(r[0] * p[0] + r[2] * p[2]),
            -(n[0] * p[0] + n[1] * p[1] + n[2] * p[2]), -(f[0] * p[0] + f[1] * p[1] + f[2] * p[2])
        printf "%.3f,%.3f,%.3f\n", p[0], p[1], p[2] > "/dev/stderr"
    }' > "$work/camera.json" 2> "$work/eye"
}

draw() { # look, width, height, more options
    local name=$1 width=$2 height=$3
    shift 3
    "$livery" render --look "$work/$name.json" --camera "$work/camera.json" --eye "$(cat "$work/eye")" \
        --quality high --out "$work/$name.exr" "$@" > /dev/null
    oiiotool "$work/$name.exr" --unpremult --colorconvert linear sRGB --clamp:min=0:max=1 -d uint8 \
        -o "$work/$name.png"
    convert -size "${width}x$height" gradient:'#3f4043-#85868a' "$work/$name.png" -composite \
        -filter Lanczos -resize 50% "$work/$name-shown.png"
}

camera 1200 760 52 16 900 5700 24
draw car 1200 760
camera 480 760 62 8 1400 5000 88
draw printed 480 760 --product "$work/refrigerator.obj" --unit mm
draw woven 480 760 --product "$work/refrigerator.obj" --unit mm
convert "$work/car-shown.png" "$work/printed-shown.png" "$work/woven-shown.png" \
    -background '#1c1c1e' -splice 4x0 +append -chop 4x0 -depth 8 -sampling-factor 1x1 -quality 90 \
    "${1:-$root/docs/images/artwork.jpg}"
