#!/bin/bash
# Whether what was built has what stops a program that an input has led astray:
#   hardened.sh PROGRAM ON|OFF MODULE...     ON: built with LIVERY_HARDENED
set -euo pipefail
export LC_ALL=C

program=$1 checks=$2
shift 2
failed=0
need() {
    echo "hardened: $1: no $2" >&2
    failed=1
}
[[ $(readelf -hW "$program") =~ Type:\ +DYN ]] || need "$program" "position-independent program"
for file in "$program" "$@"; do
    segments=$(readelf -lW "$file") dynamic=$(readelf -dW "$file")
    [[ $segments =~ GNU_RELRO ]] || need "$file" "read-only relocations"
    [[ $dynamic =~ BIND_NOW || $dynamic =~ FLAGS_1.*NOW ]] || need "$file" "binding at the start"
    grep -q "GNU_STACK.*RWE" <<<"$segments" && need "$file" "stack without code"
    [ "$checks" = ON ] || continue
    symbols=$(readelf -W --dyn-syms "$file")
    [[ $symbols =~ __stack_chk_fail ]] || need "$file" "stack protector"
    # A small module may make no call whose size the compiler knows.
    [[ $file != "$program" || $symbols =~ _chk@ ]] || need "$file" "fortified library call"
    [[ $symbols =~ glibcxx_assert_fail ]] || need "$file" "checked container"
done
exit $failed
