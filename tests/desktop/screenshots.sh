#!/bin/bash
# Photographs the operator's window anew for the documentation: docs/images/desktop-*.png. Small
# files: 256 colours, and the 3840x2160 ones at half their size. Needs ImageMagick and a build of
# the target desktop_screenshots. All that was taken stays in DIR when one is given.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
taken=${1:-$(mktemp -d)}
[ $# -gt 0 ] || trap 'rm -rf "$taken"' EXIT
"$root/build/release/bin/desktop_screenshots" "$taken"
small=(+dither -colors 256 -define png:compression-level=9)
for name in window hover search wipe view-eye view-projector view-photograph save-picture import-look new-session keys nudge capture \
    accuracy report ballot ballot-result seats seats-map vote-presenting vote-voting calibrating monitor-numbers unplugged; do
    convert "$taken/$name-1280.png" "${small[@]}" "$root/docs/images/desktop-$name.png"
done
# The column at the right, tab by tab.
for pair in window:paints tab-paint:paint tab-light:light tab-calibrate:calibrate tab-frame:frame; do
    convert "$taken/${pair%%:*}-1280.png" -crop 398x694+882+24 +repage "${small[@]}" \
        "$root/docs/images/desktop-${pair##*:}.png"
done
for name in window tab-light ballot; do
    convert "$taken/$name-3840.png" -filter Lanczos -resize 50% "${small[@]}" \
        "$root/docs/images/desktop-$name-3840.png"
done
