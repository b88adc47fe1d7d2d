#!/bin/bash
# Puts formulas off by 2%, one at a time, and sees whether the tests that tests/README.md names for
# each fail. Ends with 1 where one is not noticed, where a test fails although nothing is off, or
# where the table does not name the mutations that the sources have.
#   tests/mutations.sh [MUTATION...]    all, or these
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=build/mutations

# | `mutation` | formula | `test program` | `filter` |
rows=$(sed -nE 's/^\| `([a-z0-9_]+)` \|.*\| `(test_[a-z]+)` \| `([^`]+)` \|$/\1 \2 \3/p' tests/README.md)
in_table=$(cut -d' ' -f1 <<<"$rows" | sort)
in_source=$(grep -rhoPz 'MUTATED\(\s*\K[a-z0-9_]+(?=,)' src shaders | tr '\0' '\n' | grep -vx name | sort -u)
if ! difference=$(diff <(echo "$in_table") <(echo "$in_source")); then
    echo "tests/README.md (<) and the sources (>) differ in their mutations:" >&2
    echo "$difference" >&2
    exit 1
fi

if [ $# -gt 0 ]; then
    chosen=$(printf '%s\n' "$@")
    unknown=$(grep -vxFf <(echo "$in_table") <<<"$chosen" || true)
    if [ -n "$unknown" ]; then
        echo "no such mutation: $unknown" >&2
        exit 1
    fi
    rows=$(awk 'NR == FNR { chosen[$1]; next } $1 in chosen' <(echo "$chosen") <(echo "$rows"))
fi
mapfile -t programs < <(cut -d' ' -f2 <<<"$rows" | sort -u)

cmake --preset mutations >/dev/null
cmake --build $build --target "${programs[@]}"

homes=$(mktemp -d)
trap 'rm -rf "$homes"' EXIT
unset LIVERY_REFERENCE_DATA LIVERY_MUTATION
export MESA_SHADER_CACHE_DIR=$PWD/$build/mesa-cache

# run NAME PROGRAM FILTER: what the tests say with that formula off, in a home of its own.
run() {
    LIVERY_HOME=$homes/$1 LIVERY_MUTATION=$1 timeout 600 $build/bin/"$2" --gtest_filter="$3" 2>&1
}

failed=0
for program in "${programs[@]}"; do
    filters=$(awk -v p="$program" '$2 == p { print $3 }' <<<"$rows" | sort -u | paste -sd:)
    if ! output=$(run none "$program" "$filters") || ! grep -q 'PASSED.* [1-9]' <<<"$output"; then
        echo "$output" | tail -n 30
        echo "$program $filters fails with nothing off" >&2
        failed=1
    fi
done
while read -r name program filter; do
    begin=$SECONDS
    if output=$(run "$name" "$program" "$filter"); then
        echo "NOT NOTICED $name: $program $filter"
        failed=1
    elif ! grep -q '  FAILED  ' <<<"$output"; then
        echo "$output" | tail -n 30
        echo "NO ANSWER $name: $program $filter" # it crashed or took too long
        failed=1
    else
        echo "noticed $name ($((SECONDS - begin)) s)"
    fi
done <<<"$rows"
exit $failed
