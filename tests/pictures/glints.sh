#!/bin/bash
# Draws docs/images/glints.jpg anew: teal metallic on the shipped car in the default projector's own
# pixels, with flakes as on the real car, and 10 and 30 times as large. Needs ImageMagick,
# openimageio-tools and a build of the targets livery and livery_assets.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
livery=${LIVERY:-$root/build/release/bin/livery}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

tiles=()
for scale in 1 10 30; do
    sed -e "s/\"glint_density_per_mm2\"/\"glint_scale\": $scale,\n    &/" \
        "$root/materials/teal-metallic.json" > "$work/teal-$scale.json"
    sed -e "s/\"body\": \"[^\"]*\"/\"body\": \"teal-$scale.json\"/" \
        "$root/assets/looks/solid-red.json" > "$work/look-$scale.json"
    "$livery" render --look "$work/look-$scale.json" --quality high --out "$work/$scale.exr" \
        > /dev/null
    oiiotool "$work/$scale.exr" --unpremult --colorconvert linear sRGB --clamp:min=0:max=1 \
        -d uint8 -o "$work/$scale.png"
    label="exaggerated $scale times"
    [ "$scale" = 1 ] && label="physical"
    convert -size "$(identify -format %wx%h "$work/$scale.png")" xc:'#38393c' "$work/$scale.png" \
        -composite -crop "${CROP:-400x260+560+290}" +repage -font DejaVu-Sans -pointsize 13 \
        -fill '#e4e4e4' -gravity SouthWest -annotate +10+8 "$label" "$work/tile-$scale.png"
    tiles+=("$work/tile-$scale.png")
done
montage "${tiles[@]}" -tile 3x1 -geometry +2+2 -background '#1c1c1e' -depth 8 \
    -sampling-factor 1x1 -quality 88 "${1:-$root/docs/images/glints.jpg}"
