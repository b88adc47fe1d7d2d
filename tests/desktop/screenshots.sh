#!/bin/bash
# Photographs the operator's window anew for the documentation: docs/images/desktop-*.png. Small
# files: 128 colours, and the 3840x2160 ones at half their size. Needs ImageMagick and a build of
# the target desktop_screenshots. All that was taken stays in DIR when one is given.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
taken=${1:-$(mktemp -d)}
[ $# -gt 0 ] || trap 'rm -rf "$taken"' EXIT
"$root/build/release/bin/desktop_screenshots" "$taken"
for name in window hover search wipe tab-paint tab-light tab-calibrate tab-frame view-eye \
    view-projector view-photograph save-picture keys ballot ballot-result calibrating; do
    convert "$taken/$name-1280.png" +dither -colors 128 -define png:compression-level=9 \
        "$root/docs/images/desktop-$name.png"
done
for name in window tab-light; do
    convert "$taken/$name-3840.png" -filter Lanczos -resize 50% +dither -colors 128 \
        -define png:compression-level=9 "$root/docs/images/desktop-$name-3840.png"
done
