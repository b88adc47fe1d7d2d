#!/bin/bash
# Builds the fuzzers and gives each parser so many damaged inputs, from a fixed seed.
#
#   tests/fuzz/run.sh [RUNS [TARGET...]]    default: 20000 runs of every target
#
# SEED (default 1) chooses the inputs. What is kept in corpus/ comes first. Any crash, leak, input
# that takes over ten seconds or asks for more than 2 GB fails; the input is left in
# build/sanitize/found/, to become a file of the corpus once it is mended.
set -euo pipefail
export LC_ALL=C

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
runs=${1:-20000}
shift || true
seed=${SEED:-1}
build=$root/build/sanitize

if [ ! -f "$build/build.ninja" ]; then
    (cd "$root" && cmake --preset sanitize >&2)
fi
if [ $# -eq 0 ]; then
    set -- "$here"/*_fuzz.cpp
    set -- "${@##*/}"
    set -- "${@%_fuzz.cpp}"
fi
ninja -C "$build" "${@/#/fuzz_}" >&2

dictionary_of() {
    case $1 in
        gltf | ply | obj) echo "$here/dictionaries/$1.dict" ;;
        obj_materials) echo "$here/dictionaries/obj.dict" ;;
        *) echo "$here/dictionaries/json.dict" ;;
    esac
}

# Nesting that breaks a recursive reader, and tables that fill more than one buffer, need room; what
# people type does not.
longest_of() {
    case $1 in
        gltf | ply | obj | png | measured_*) echo 65536 ;;
        ballot_request | command_line | directions | names | photograph_names | picked_points | radial_profile | scales | window_place) echo 4096 ;;
        *) echo 16384 ;;
    esac
}

mkdir -p "$build/found"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LIVERY_HOME=$work/home

# One target's runs, and a row of the table.
fuzz() {
    local target=$1 log=$work/$1.log begin=$EPOCHREALTIME failed=0
    mkdir -p "$work/$target"
    cat "$here/dictionaries/hard.dict" "$(dictionary_of "$target")" >"$work/$target.dict"
    "$build/bin/fuzz_$target" -runs="$runs" -seed="$seed" -max_len="$(longest_of "$target")" -timeout=10 \
        -rss_limit_mb=2048 -malloc_limit_mb=1024 -print_final_stats=1 \
        -artifact_prefix="$build/found/$target-" -dict="$work/$target.dict" \
        "$work/$target" "$here/corpus/$target" >"$log" 2>&1 || failed=1
    if [ $failed -ne 0 ]; then
        echo "fuzz: $target failed; its input is in $build/found:" >&2
        tail -n 60 "$log" >&2
    fi
    awk -v name="$target" -v begin="$begin" -v end="$EPOCHREALTIME" '
        /^stat::number_of_executed_units/ { n = $2 }
        END { s = end - begin; printf "%-16s %9d %9.0f %8.1f\n", name, n, n / s, s }' "$log"
    return $failed
}

printf '%-16s %9s %9s %8s   seed %s\n' target runs 'runs/s' seconds "$seed"
export -f fuzz dictionary_of longest_of
export here build runs seed work
printf '%s\n' "$@" | xargs -P "$(nproc)" -I{} bash -c 'fuzz {}'
