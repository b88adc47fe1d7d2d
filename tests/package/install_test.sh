#!/bin/bash
# Installs into a folder with spaces and umlauts, and uses the program from elsewhere: with a comma
# locale, as somebody who may write next to nothing, with a full disk, and without the build.
#
#   install_test.sh CMAKE BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail

. "$(dirname "$0")/installed.sh"

# --- what lies there ---------------------------------------------------------------------------
for file in bin/livery bin/livery-ballots bin/livery-camera lib/livery/livery_image_io.so lib/livery/livery_pdf.so \
    share/livery/assets/sample-round/ballots.sqlite share/livery/materials/solid-red.json \
    share/livery/assets/car.glb share/livery/assets/looks/solid-red.json \
    share/livery/shaders/compensation/correct.comp share/livery/calibration/default.json \
    share/man/man1/livery.1 share/applications/livery.desktop share/mime/packages/livery.xml \
    share/metainfo/invalid.livery.livery.metainfo.xml \
    share/icons/hicolor/scalable/apps/livery.svg share/icons/hicolor/48x48/apps/livery.png \
    share/doc/livery/README.md share/doc/livery/CHANGELOG.md share/doc/livery/LICENSE \
    share/doc/livery/docs/commands.md; do
    [ -s "$prefix/$file" ] || fail "not installed: $file"
done
links=$(find "$prefix" -type l)
[ -z "$links" ] || fail "links that lead out of the installation: $links"
for file in bin/livery bin/livery-ballots bin/livery-camera lib/livery/livery_image_io.so; do
    for folder in "$source" "$build"; do
        ! grep -qaF "$folder/" "$prefix/$file" || fail "$file names $folder"
    done
    if command -v readelf >/dev/null; then
        ! readelf -d "$prefix/$file" | grep -E 'RPATH|RUNPATH' || fail "$file has a run path"
    fi
done
if command -v desktop-file-validate >/dev/null; then
    desktop-file-validate "$prefix/share/applications/livery.desktop" || fail "the desktop entry"
else
    skip "desktop-file-validate is not there"
fi
if command -v appstreamcli >/dev/null; then
    # The whole tree: whether the names of the metadata, the desktop entry and the icon fit, too.
    # AppStream 1.0 warns where there is no home page, as the project has none; 0.16 does not.
    appstreamcli validate-tree --no-net "$prefix" >"$work/out" 2>&1 || true
    if ! grep -q '^invalid\.livery\.livery\.metainfo\.xml' "$work/out" ||
        grep -E '^ *[EW]:' "$work/out" | grep -v url-homepage-missing >"$work/err"; then
        fail "what software centres show"
        cat "$work/out" >&2
    fi
else
    skip "appstreamcli is not there"
fi
# What a file manager makes of the files that the program opens: their kind, and who opens that.
if command -v update-mime-database >/dev/null && command -v update-desktop-database >/dev/null &&
    command -v gio >/dev/null && [ -d /usr/share/mime/packages ]; then
    mkdir -p "$work/desktop/mime/packages" "$work/desktop/applications" "$work/meshes"
    cp "$prefix/share/mime/packages/livery.xml" "$work/desktop/mime/packages"
    # Only what can be started is offered.
    sed "s|^Exec=livery|Exec=/bin/true|" "$prefix/share/applications/livery.desktop" \
        >"$work/desktop/applications/livery.desktop"
    update-mime-database "$work/desktop/mime" 2>"$work/err" || fail "the kinds of files"
    update-desktop-database "$work/desktop/applications" || fail "the kinds that are opened"
    printf 'glTF\2\0\0\0' >"$work/meshes/a.glb"
    printf '{"asset": {"version": "2.0"}}' >"$work/meshes/a.gltf"
    printf 'ply\nformat ascii 1.0\n' >"$work/meshes/a.ply"
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$work/meshes/a.obj"
    printf 'SQLite format 3\0' >"$work/meshes/a.livery"
    desktop() { env XDG_DATA_HOME="$work/desktop" XDG_DATA_DIRS=/usr/share HOME="$work" gio "$@"; }
    for file in "$work"/meshes/*; do
        kind=$(desktop info -a standard::content-type "$file" | sed -n 's/.*content-type: //p')
        desktop mime "$kind" >"$work/out" 2>&1 || true
        grep -q 'livery\.desktop' "$work/out" || {
            fail "nobody offers Livery for ${file##*/}, which is \"$kind\""
            cat "$work/out" >&2
        }
    done
else
    skip "the kinds of files: update-mime-database, update-desktop-database or gio is not there"
fi
if command -v mandoc >/dev/null; then
    mandoc -Tlint "$prefix/share/man/man1/livery.1" || fail "the manual page"
else
    skip "mandoc is not there"
fi

# --- using it -------------------------------------------------------------------------------------
# livery HOME ARGUMENTS: from a foreign folder, with an environment of our own; sets $code, and
# leaves what it said in $work/out and $work/err.
run() {
    local home=$1
    shift
    code=0
    (cd / && "${user[@]}" env -i "${surroundings[@]}" HOME="$home" "$prefix/bin/livery" "$@") >"$work/out" 2>"$work/err" </dev/null || code=$?
}
# expect CODE WHAT: of the last run.
expect() {
    [ "$code" -eq "$1" ] || {
        fail "$2: exit status $code, expected $1"
        cat "$work/out" "$work/err" >&2
    }
}
says() {
    grep -qF -- "$1" "$work/out" "$work/err" || {
        fail "nobody said \"$1\""
        cat "$work/out" "$work/err" >&2
    }
}

# --- what a user does ----------------------------------------------------------------------------
run "$read_only" --version
expect 0 "--version"
says "livery "
run "$read_only" help
expect 0 "help"
run "$read_only" plan --look solid-red
expect 0 "plan"
run "$read_only" render --look blue-metallic --quality draft --out "$outputs/Überall blau.png"
expect 0 "render, home read-only"
[ "$(head -c 4 "$outputs/Überall blau.png" | tail -c 3)" = PNG ] || fail "render wrote no PNG"
run "$home" render --look solid-red --quality draft --out "$outputs/rot.exr"
expect 0 "render to EXR"
run "$home" check "$outputs/rot.exr" "$prefix/share/livery/materials/solid-red.json"
expect 0 "check"
# A number in a file reads and writes the same under a decimal comma.
run "$home" patterns --projector 64x48 --out "$outputs/Muster"
expect 0 "patterns"
grep -qE '[0-9]' "$outputs/Muster/manifest.json" || fail "patterns wrote no manifest"
! grep -qE '[0-9],[0-9]' "$outputs/Muster/manifest.json" || fail "a decimal comma in the manifest"
run "$home" demo --size 160x100 --product sphere --out "$outputs/Vorführung mit Ümläuten"
expect 0 "demo"
[ -s "$outputs/Vorführung mit Ümläuten/report.html" ] || fail "demo wrote no report"

# --- places that cannot be written ---------------------------------------------------------------
run "$read_only" render --look solid-red --quality draft --out "$read_only/rot.png"
expect 2 "render into a read-only folder"
says "cannot be written"
run "$read_only" demo --size 64x40 --product sphere --out "$read_only/demo"
expect 2 "demo into a read-only folder"
says "$read_only/demo"
ln -s /dev/full "$outputs/voll.png"
run "$home" render --look solid-red --quality draft --out "$outputs/voll.png"
expect 2 "render onto a full disk"
says "cannot write: No space left on device"
mkdir "$small"
if [ "$(id -u)" -eq 0 ] && mount -t tmpfs -o size=64k,mode=777 tmpfs "$small" 2>/dev/null; then
    run "$home" render --look solid-red --quality draft --out "$small/rot.exr"
    left=$(ls -A "$small")
    umount "$small"
    expect 2 "render onto a small disk"
    says "cannot write: No space left on device"
    [ -z "$left" ] || fail "left on a full disk: $left"
else
    skip "no small disk: it takes root and mount"
fi
run "$home" --data "$work" plan
expect 2 "an option before the command"
run "$home" plan --data "$work/Heimat"
expect 2 "shipped data that are not there"
says "nothing in $work/Heimat"
mv "$prefix/lib/livery" "$prefix/lib/gone"
run "$home" render --look solid-red --quality draft --out "$outputs/ohne.exr"
expect 2 "without the picture reader"
says "livery_image_io.so"
mv "$prefix/lib/gone" "$prefix/lib/livery"

finish
