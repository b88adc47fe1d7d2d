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
failed=0
printf '%-16s %9s %9s %8s   seed %s\n' target runs 'runs/s' seconds "$seed"
for target in "$@"; do
    log=$work/$target.log
    mkdir -p "$work/$target"
    cat "$here/dictionaries/hard.dict" "$(dictionary_of "$target")" >"$work/dictionary"
    begin=$(date +%s.%N)
    if ! "$build/bin/fuzz_$target" -runs="$runs" -seed="$seed" -max_len="$(longest_of "$target")" -timeout=10 \
        -rss_limit_mb=2048 -malloc_limit_mb=1024 -print_final_stats=1 \
        -artifact_prefix="$build/found/$target-" -dict="$work/dictionary" \
        "$work/$target" "$here/corpus/$target" >"$log" 2>&1; then
        failed=1
        echo "fuzz: $target failed; its input is in $build/found:" >&2
        tail -n 60 "$log" >&2
    fi
    end=$(date +%s.%N)
    awk -v name="$target" -v seconds="$(echo "$end $begin" | awk '{print $1 - $2}')" '
        /^stat::number_of_executed_units/ { n = $2 }
        END { printf "%-16s %9d %9.0f %8.1f\n", name, n, n / seconds, seconds }' "$log"
done
exit $failed
