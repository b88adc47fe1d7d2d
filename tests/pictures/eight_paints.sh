#!/bin/bash
# Draws docs/images/eight-paints.jpg anew: one car in eight paints of the library, left without and
# right with flakes. Needs ImageMagick, openimageio-tools and a build of the targets livery and
# livery_assets.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
livery=${LIVERY:-$root/build/release/bin/livery}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

paints=("solid red" "silver metallic" "solid grey" "blue metallic" "matte black" "soft gold"
    "solid yellow" "teal metallic")

# From the front at the right, 38 degrees from the nose and 12 above the ground, drawn at twice the
# size of a tile.
width=880 height=424
camera=$work/camera.json
awk -v w=$width -v h=$height 'BEGIN {
    rad = atan2(0, -1) / 180; az = 38 * rad; el = 12 * rad; far = 900; focal = 3900
    # Toward the camera; then its axes: right, down, forward.
    d[0] = cos(el) * cos(az); d[1] = sin(el); d[2] = cos(el) * sin(az)
    r[0] = d[2] / cos(el); r[1] = 0; r[2] = -d[0] / cos(el)
    n[0] = -d[1] * r[2]; n[1] = -(d[2] * r[0] - d[0] * r[2]); n[2] = d[1] * r[0]
    t[0] = 0; t[1] = 25; t[2] = 0
    for (k = 0; k < 3; ++k) { p[k] = t[k] + far * d[k]; f[k] = -d[k] }
    printf "{\"width\": %d, \"height\": %d,\n", w, h
    printf "\"matrix\": [%g, 0, %g, 0, %g, %g, 0, 0, 1],\n", focal, w / 2, focal, h / 2 - 10
    printf "\"distortion\": [0, 0, 0, 0, 0],\n\"rotation\": [%.9f, %.9f, %.9f, ", r[0], r[1], r[2]
    printf "%.9f, %.9f, %.9f, %.9f, %.9f, %.9f],\n", n[0], n[1], n[2], f[0], f[1], f[2]
    printf "\"translation_mm\": [%.6f, %.6f, %.6f]}\n", -(r[0] * p[0] + r[2] * p[2]),
        -(n[0] * p[0] + n[1] * p[1] + n[2] * p[2]), -(f[0] * p[0] + f[1] * p[1] + f[2] * p[2])
    printf "%.3f,%.3f,%.3f\n", p[0], p[1], p[2] > "/dev/stderr"
}' > "$camera" 2> "$work/eye"
eye=$(cat "$work/eye")

# A floor that the light falls off on, and the car's shadow.
shown="440x212"
floor=$work/floor.png
convert -size ${width}x${height} gradient:'#3f4043-#85868a' \
    \( -size ${width}x${height} xc:none -fill 'rgba(0,0,0,0.8)' \
       -draw "translate 454,318 rotate 9 ellipse 0,0 323,48 0,360" -blur 0x14 \) \
    -composite "$floor"

tiles=()
for paint in "${paints[@]}"; do
    file=$work/${paint// /-}
    sed -e "s/\"body\": \"[^\"]*\"/\"body\": \"$paint\"/" -e 's/"exposure_ev": .*/"exposure_ev": 0.25/' \
        "$root/assets/looks/solid-red.json" > "$file.json"
    "$livery" render --look "$file.json" --camera "$camera" --eye "$eye" --quality high \
        --out "$file.exr" > /dev/null
    oiiotool "$file.exr" --unpremult --colorconvert linear sRGB --clamp:min=0:max=1 -d uint8 \
        -o "$file.png"
    convert "$floor" "$file.png" -composite -filter Lanczos -resize "$shown!" \
        -font DejaVu-Sans -pointsize 12 -fill '#e4e4e4' -gravity SouthWest -annotate +12+8 "$paint" \
        "$file-tile.png"
    tiles+=("$file-tile.png")
done
montage "${tiles[@]}" -tile 2x -geometry +2+2 -background '#1c1c1e' -depth 8 \
    -sampling-factor 1x1 -quality 90 "$root/docs/images/eight-paints.jpg"
