#!/bin/bash
# Makes a folder that tests and times Livery on the graphics card of another machine, with nothing but
# what it brings along and that machine's own driver (check.sh in it; docs/performance.md).
#
#   pack.sh DIR [BUILD]      DIR is made; BUILD is build/release, built with its tests, unless it is named
#
# It stays below 64 MiB: a packed part, and xz and glibc beside it to unpack that anywhere.
set -euo pipefail
export LC_ALL=C

source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
out=${1:-} build=${2:-$source/build/release}
fail() { echo "pack: $*" >&2; exit 2; }
[ -n "$out" ] || fail "found no folder to make, expected pack.sh DIR [BUILD]"
[ ! -e "$out" ] || fail "found $out, expected a folder that is not there yet"
programs=(livery test_gl test_compensation test_appearance test_radiance test_jobs test_ledger test_frame)
for program in "${programs[@]}"; do
    [ -x "$build/bin/$program" ] || fail "$build/bin/$program: no such program, expected a build with tests"
done
for tool in gcc readelf nm strip xz; do
    command -v "$tool" >/dev/null || fail "$tool is missing here"
done

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
packed=$work/packed
mkdir -p "$packed/bin" "$packed/lib/livery" "$packed/lib/ours" "$packed/lib/drivers" "$packed/lib/glvnd" \
    "$packed/share/livery/assets" "$out/glibc" "$out/xz"
for program in "${programs[@]}"; do
    strip -o "$packed/bin/$program" "$build/bin/$program"
done
strip -o "$packed/lib/livery/livery_image_io.so" "$build/lib/livery_image_io.so"
for folder in calibration materials shaders; do
    cp -rL "$build/share/livery/$folder" "$packed/share/livery/"
done
for part in "$build/share/livery/assets"/*; do
    case ${part##*/} in
        icon | sample-round) ;;
        *) cp -rL "$part" "$packed/share/livery/assets/" ;;
    esac
done
cp -r "$source/tests/data/truths" "$packed/share/"

needed() { readelf -d "$1" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p'; }
declare -A path
while read -r name _ file _; do
    case $name in /*) path[${name##*/}]=$name ;; *.so*) [[ $file != /* ]] || path[$name]=$file ;; esac
done < <(ldd "$build/lib/livery_image_io.so" "${programs[@]/#/$build/bin/}")
find_library() {
    [ -n "${path[$1]:-}" ] || path[$1]=$(ldconfig -p | sed -n "s|^\t$1 (.*x86-64.*=> ||p" | head -1)
    [ -n "${path[$1]}" ] || fail "$1 is missing here"
}

# Of what OpenImageIO links, films, scans, volumes and medical pictures are some 300 MB that nothing here
# reads. Libraries whose functions answer with the address of zeros (an empty text, where somebody asks for
# their versions) stand in for those.
is_kept_picture_library() {
    case $1 in
        libOpenImageIO_Util.* | libOpenEXR* | libImath* | libIex* | libIlmThread* | libpng* | libjpeg* | libtiff* | \
            libraw* | libwebp* | libOpenColorIO* | libfreetype* | libboost* | libtbb* | libfmt* | libz.* | libm.* | \
            libc.* | libstdc++.* | libgcc_s.* | ld-linux*) true ;;
        *) false ;;
    esac
}
stand_in() {
    local name=$1 reader=$2 code=$work/$1.s versions=$work/$1.map linked=(-shared -nostdlib)
    cat >"$code" <<'ASSEMBLY'
.bss
.balign 64
nothing: .zero 65536
.text
answer: leaq nothing(%rip), %rax
ret
.section .note.GNU-stack,"",@progbits
ASSEMBLY
    # What the reader wants of it, with kind and version.
    join <(nm -D --undefined-only "$reader" | awk '$1 == "U" { print $2 }' | sort) \
        <(nm -D --defined-only "${path[$name]}" | sed 's/@@/@/' | awk '{ print $3, $2 }' | sort) |
        awk -v code="$code" -v versions="$versions" '{
            split($1, parts, "@")
            printf ".globl %s\n.set %s, %s\n.type %s, @%s\n", parts[1], parts[1], $2 ~ /[TWi]/ ? "answer" : "nothing",
                parts[1], $2 ~ /[TWi]/ ? "function" : "object" >>code
            if (parts[2] != "") of[parts[2]] = of[parts[2]] parts[1] "; "
        } END { for (version in of) print version " { global: " of[version] "};" >versions }'
    [ ! -s "$versions" ] || linked+=("-Wl,--version-script=$versions")
    gcc "${linked[@]}" -Wl,-soname,"$name" -o "$packed/lib/ours/$name" "$code"
}

# Libraries by whose they are to be on the machine: its own glibc unless that is too old, its own of what
# a driver also links, so that the driver finds what it was built with, and ours of all others.
bring() {
    local file=$1 name to
    for name in $(needed "$file"); do
        case $name in
            ld-linux* | libc.so* | libm.so* | libpthread.so* | libdl.so* | librt.so* | libresolv.so* | libutil.so*) to=$out/glibc ;;
            libEGL.so* | libGL.so* | libOpenGL.so* | libGLX.so* | libGLdispatch.so*) to=$packed/lib/glvnd ;;
            libstdc++.so* | libgcc_s.so* | libX*.so* | libxcb*.so* | libz.so* | libzstd.so* | liblzma.so* | libexpat.so* | \
                libdrm*.so* | libffi.so* | libbsd.so* | libmd.so* | libwayland*.so*) to=$packed/lib/drivers ;;
            *) to=$packed/lib/ours ;;
        esac
        [ ! -e "$to/$name" ] || continue
        find_library "$name"
        if [[ ${file##*/} == libOpenImageIO.so* ]] && ! is_kept_picture_library "$name"; then
            stand_in "$name" "${path[${file##*/}]}"
            continue
        fi
        cp -L "${path[$name]}" "$to/$name"
        bring "$to/$name"
    done
}
for file in "$packed"/bin/* "$packed/lib/livery/livery_image_io.so"; do
    bring "$file"
done
# They are looked for by name while a program runs.
for name in libEGL.so.1 libOpenGL.so.0 libGLdispatch.so.0; do
    find_library "$name"
    cp -L "${path[$name]}" "$packed/lib/glvnd/$name"
    bring "$packed/lib/glvnd/$name"
done
for name in libdl.so.2 libpthread.so.0 librt.so.1 libresolv.so.2 libutil.so.1; do
    find_library "$name"
    cp -L "${path[$name]}" "$out/glibc/$name"
done
strip --strip-unneeded "$packed"/lib/ours/* 2>/dev/null || true

find_library liblzma.so.5
cp -L "$(command -v xz)" "${path[liblzma.so.5]}" "$out/xz/"
tar -C "$packed" -c bin lib share | xz -4 -T0 >"$out/livery.tar.xz"
getconf GNU_LIBC_VERSION | cut -d' ' -f2 >"$out/glibc/version"
"$build/bin/livery" --version | head -1 >"$out/version"
cp "$source/tests/device/check.sh" "$out/"
bytes=$(du -sb "$out" | cut -f1)
echo "$out: $((bytes / 1048576)) MiB, $(cat "$out/version")"
[ "$bytes" -lt $((64 * 1048576)) ] || fail "found $bytes bytes in $out, expected less than 64 MiB"
