#!/bin/bash
# Two builds of livery_benchmarks beside each other: run in turns, so that a busy machine is busy for both.
#   tests/benchmarks/compare.sh BEFORE AFTER [RUNS [FILTER]]     processor time, each benchmark's medians and ratio
set -euo pipefail
export LC_ALL=C

before=$1 after=$2 runs=${3:-20} filter=${4:-'^(ShadingAndMixing|Correction)/width:1280/threads:1/'}
for ((run = 0; run < runs; ++run)); do
    for which in before after; do
        program=$before
        [ $which = before ] || program=$after
        "$program" --benchmark_filter="$filter" --benchmark_min_time=0.25 --benchmark_format=csv 2>/dev/null |
            awk -F, -v run=$run -v which=$which 'f { gsub(/"/, "", $1); print $1, run, which, $4 } $1 == "name" { f = 1 }'
    done
done | sort | awk '
    function median(list, count,   i, j, t) {
        for (i = 2; i <= count; ++i)
            for (j = i; j > 1 && list[j - 1] > list[j]; --j) { t = list[j]; list[j] = list[j - 1]; list[j - 1] = t }
        return count % 2 ? list[(count + 1) / 2] : (list[count / 2] + list[count / 2 + 1]) / 2
    }
    function report() {
        if (count == 0) return
        for (i = 1; i <= count; ++i) ratio[i] = after[i] / before[i]
        printf "%-44s %9.4g %9.4g   ratio %.3f, of %d runs\n", name, median(before, count), median(after, count),
            median(ratio, count), count
    }
    # Lines come as name, run, "after" and then the same with "before".
    $1 != name { report(); name = $1; count = 0 }
    $3 == "after" { after[++count] = $4 }
    $3 == "before" { before[count] = $4 }
    END { report() }'
