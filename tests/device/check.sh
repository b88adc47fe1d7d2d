#!/bin/bash
# Tests and times Livery on the graphics card of this machine: the tests that draw, the speed of every
# stage, and what OpenGL's numbers and levels are worth, as one table. For a folder that pack.sh has made;
# it needs a driver with EGL, no display, no package of ours, and at most eight minutes.
#
#   check.sh [--out DIR] [--minutes N] [--allow-software]
#
#   --out DIR          what it writes: table.md, table.csv and all answers (default: check-DATE-TIME here)
#   --minutes N        when it ends, whatever is done by then (default 8)
#   --allow-software   go on where there is no graphics card
#
# Exit status 0: all done and passed; 1: a test failed, or something did not end in time; 2: it could not run.
set -uo pipefail
export LC_ALL=C

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
fail() { echo "check: $*" >&2; exit 2; }
out='' minutes=8 gl=hardware
while [ $# -gt 0 ]; do
    case $1 in
        --out) out=${2:-}; [ -n "$out" ] || fail "--out: found nothing, expected a folder"; shift 2 ;;
        --minutes)
            minutes=${2:-}
            [[ $minutes =~ ^[1-9][0-9]{0,3}$ ]] || fail "--minutes: found \"$minutes\", expected a whole number from 1"
            shift 2
            ;;
        --allow-software) gl=auto; shift ;;
        *) fail "found \"$1\", expected --out DIR, --minutes N or --allow-software" ;;
    esac
done
out=${out:-check-$(date +%Y-%m-%d-%H%M%S)}
[ -f "$here/livery.tar.xz" ] || fail "$here/livery.tar.xz: no such file, expected a folder that pack.sh has made"
mkdir -p "$out/home" "$out/lib" "$out/egl_vendor.d" "$out/unpacked" || fail "$out: cannot be made"
out=$(cd "$out" && pwd)
deadline=$((SECONDS + 60 * minutes))

# The machine's own glibc, which its driver fits, unless it is too old for what was built elsewhere.
at_least() { [ "$(printf '%s\n' "$1" "$2" | sort -V | head -1)" = "$2" ]; }
loader=()
glibc=$(getconf GNU_LIBC_VERSION 2>/dev/null | cut -d' ' -f2)
if [ -z "$glibc" ] || ! at_least "$glibc" "$(cat "$here/glibc/version")"; then
    loader=("$here/glibc/ld-linux-x86-64.so.2" --library-path)
    glibc="${glibc:-none}, too old: $(cat "$here/glibc/version") of this folder"
fi
unxz() {
    if [ ${#loader[@]} -gt 0 ]; then
        "${loader[@]}" "$here/glibc:$here/xz" "$here/xz/xz" -dc "$1"
    else
        LD_LIBRARY_PATH="$here/xz" "$here/xz/xz" -dc "$1"
    fi
}
root=$out/unpacked
unxz "$here/livery.tar.xz" | tar -C "$root" -x || fail "$here/livery.tar.xz: cannot be unpacked to $root"
trap 'rm -rf "$root"' EXIT

# Programs of here with libraries of the machine where it has them (pack.sh says which, and why).
known() { "$ldconfig" -p 2>/dev/null | sed -n "s|^\t$1 (.*x86-64.*=> ||p" | head -1; }
ldconfig=$(PATH=$PATH:/sbin:/usr/sbin command -v ldconfig) || ldconfig=true
for library in "$root"/lib/drivers/*; do
    name=${library##*/}
    theirs=$(known "$name")
    if [ "$name" = libstdc++.so.6 ] && [ -n "$theirs" ]; then
        # The newer of the two has all that the older one has.
        newest() { grep -aoE 'GLIBCXX_3\.4\.[0-9]+' "$1" | sort -V | tail -1; }
        at_least "$(newest "$theirs")" "$(newest "$library")" || theirs=
    fi
    [ -n "$theirs" ] || ln -sf "$library" "$out/lib/$name"
done
# These fit only one another.
for library in "$root"/lib/glvnd/*; do
    [ -n "$(known "${library##*/}")" ] || { ln -sf "$root"/lib/glvnd/* "$out/lib/"; break; }
done
libraries=$root/lib/ours:$out/lib
if [ ${#loader[@]} -gt 0 ]; then
    # Programs find their data beside what runs them.
    cp "$here/glibc/ld-linux-x86-64.so.2" "$root/bin/"
    loader=("$root/bin/ld-linux-x86-64.so.2" --library-path "$here/glibc:$libraries")
    libraries=
fi
# Containers get NVIDIA's libraries from outside, but not the file by which they are found.
vendors=/etc/glvnd/egl_vendor.d:/usr/share/glvnd/egl_vendor.d
if [ -n "$(known libEGL_nvidia.so.0)" ] && ! grep -qs nvidia /etc/glvnd/egl_vendor.d/* /usr/share/glvnd/egl_vendor.d/*; then
    echo '{"file_format_version": "1.0.0", "ICD": {"library_path": "libEGL_nvidia.so.0"}}' >"$out/egl_vendor.d/10_nvidia.json"
    vendors=$out/egl_vendor.d:$vendors
fi

# run SECONDS PROGRAM ARGUMENTS...: for so long, and never past the end of all; 124: it took longer.
run() {
    local limit=$1 program=$2 rest=$((deadline - SECONDS))
    shift 2
    [ "$limit" -lt "$rest" ] || limit=$rest
    [ "$limit" -gt 0 ] || return 124
    timeout -k 5 "$limit" env LD_LIBRARY_PATH="$libraries" __EGL_VENDOR_LIBRARY_DIRS="$vendors" \
        LIVERY_DATA="$root/share/livery" LIVERY_HOME="$out/home" HOME="$out/home" XDG_CACHE_HOME="$out/home" \
        LIVERY_EQUAL_PRIORITIES=1 LIVERY_TEST_GL="$tests_draw_with" LIVERY_TRUTHS_FOLDER="$root/share/truths" \
        "${loader[@]}" "$root/bin/$program" "$@" </dev/null
}

# What draws.
tests_draw_with=hardware
run 60 livery report-problem --show opengl --gl "$gl" >"$out/opengl.txt" 2>"$out/opengl.log"
status=$?
if [ $status -ne 0 ]; then
    cat "$out/opengl.txt" "$out/opengl.log" >&2
    nvidia=$(command -v nvidia-smi >/dev/null && timeout 20 nvidia-smi -L 2>/dev/null)
    [ -z "$nvidia" ] || echo "$nvidia" >&2
    if [ -n "$nvidia" ] && [ -z "$(known libEGL_nvidia.so.0)" ]; then
        fail "the card is there, but its driver's libEGL_nvidia.so.0 is not: install the driver's OpenGL part, in a container set NVIDIA_DRIVER_CAPABILITIES=all"
    fi
    [ "$gl" = auto ] || fail "no graphics card draws here (exit status $status); --allow-software goes on with the processor"
    fail "nothing draws here (exit status $status)"
fi
renderer=$(sed -n 's/^Renderer: //p' "$out/opengl.txt")
case $renderer in *llvmpipe* | *softpipe* | *swrast* | *SWR*) tests_draw_with=software ;; esac
version=$(cat "$here/version")
processor=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)
echo "check: $version; $renderer; $(nproc) threads of $processor; glibc $glibc" >&2

# CSV: step,what,level,ms,fastest_ms,p95_ms,longest_ms,error,unit,result
csv=$out/table.csv
echo "step,what,level,ms,fastest_ms,p95_ms,longest_ms,error,unit,result" >"$csv"
failed=0

# Tests; each program`s limit is what it may take if it hangs. Left out: what needs a software renderer beside the card, or a machine that is slow.
tests() {
    local limit=$1 program=$2 filter=$3 log=$out/$2.log status
    echo "check: $program" >&2
    run "$limit" "$program" --gtest_color=no --gtest_filter="$filter" >"$log" 2>&1
    status=$?
    awk -v step="$program" -v status=$status -v late=$((status == 124 || status == 137)) '
        function row(name, ms, result) {
            gsub(/"/, "\"\"", name)
            printf "%s,\"%s\",,%s,,,,,,%s\n", step, name, ms, result
        }
        function ms_of(line) { return match(line, /\([0-9]+ ms\)/) ? substr(line, RSTART + 1, RLENGTH - 5) : "" }
        /^\[ RUN      \] / { running = $4 }
        /^\[       OK \] / && running != "" { row(running, ms_of($0), "passed"); running = ""; ++count }
        /^\[  FAILED  \] / && running != "" { row(running, ms_of($0), "failed"); running = ""; ++count }
        /^\[  SKIPPED \] / && running != "" { row(running, ms_of($0), "skipped"); running = ""; ++count }
        END {
            if (running != "") row(running, "", late ? "not done in time" : "ended the program (" status ")")
            else if (count == 0 || status > 1) row("all", "", late ? "not done in time" : "did not run (" status ")")
        }' "$log" >>"$csv"
    [ $status -eq 0 ] || failed=1
}

# One suite of the bench; `only` is what a level`s name must begin with.
bench() {
    local limit=$1 suite=$2 only=$3 status
    echo "check: livery bench --suite $suite" >&2
    run "$limit" livery bench --suite "$suite" --quick --gl "$gl" --out "$out/$suite" --json \
        >"$out/$suite.json" 2>"$out/$suite.log"
    status=$?
    awk -v step="$suite" -v only="$only" -v status=$status -v late=$((status == 124 || status == 137)) '
        function value(line) {
            sub(/^ *"[a-z0-9_]+": /, "", line)
            sub(/,$/, "", line)
            if (line == "null") return ""
            return line
        }
        function quoted(text) {
            gsub(/^"|"$/, "", text)
            gsub(/\\"/, "\"\"", text)
            return "\"" text "\""
        }
        function flush() {
            if (level != "" && (only == "" || index(level, "\"" only) == 1)) {
                printf "%s,%s,%s,%s,%s,%s,%s,%s,%s,%s\n", step, effect, level, f["ms"], f["fastest_ms"], f["p95_ms"],
                    f["longest_ms"], f["error"], f["unit"] == "" ? "" : quoted(f["unit"]),
                    f["missing"] == "" ? "measured" : quoted(f["missing"])
            }
            level = ""
            for (key in f) delete f[key]
        }
        /^      "name": / { effect = quoted(value($0)) }
        /^      "threads": / { sub(/"$/, ", threads " value($0) "\"", effect) }
        /^          "name": / { flush(); level = quoted(value($0)) }
        /^          "(ms|fastest_ms|p95_ms|longest_ms|error|unit|missing)": / {
            key = $1; gsub(/[":]/, "", key); f[key] = value($0)
        }
        /^        }/ { flush() }
        END { if (status != 0) printf "%s,\"all\",,,,,,,,%s\n", step, late ? "not done in time" : "failed (" status ")" }
        ' "$out/$suite.json" >>"$csv"
    [ $status -eq 0 ] || { failed=1; tail -3 "$out/$suite.log" >&2; }
}

all=$((60 * minutes))
tests $((all / 12)) test_gl '*-WindowSystem.*:HeadlessContext.WorksWithoutADisplay*:FenceTest.IsReachedWhen*:FenceTest.MovesWith*'
tests $((all / 12)) test_appearance 'Models/OnTheGpu.*'
tests $((all / 12)) test_compensation 'GpuPass.*-GpuPass.RefusesMorePixels*'
tests $((all / 6)) test_radiance \
    '*Devices/*/OpenGl:*BothDevices*:*Preview.*:HardCoverage.*'
tests $((all / 12)) test_jobs 'GlAgainst*-*Nightly*'
tests $((all / 12)) test_ledger 'Models/Drawn.*:NoNumber.*'
tests $((all / 8)) test_frame '*Devices/*/OpenGl'
bench $((all / 2)) speed ""
bench $((all / 5)) stability OpenGL
bench "$all" accuracy ""

# The same for people: tests by their programs, then the rows of the bench.
{
    echo "# Livery on $renderer"
    echo
    echo "$version; $(nproc) threads of $processor; $(sed -n 's/^Version: //p' "$out/opengl.txt"); $(date -u +%Y-%m-%d)."
    [ "$tests_draw_with" = hardware ] || echo "**No graphics card: OpenGL is software.**"
    echo "The bench in its quick form: fewer sizes, inputs and scenes."
    echo
    awk '
        # Fields of a line of CSV into c[1..10].
        function split_csv(line,    i, k, inside, ch) {
            k = 1; inside = 0
            for (i = 1; i <= 10; ++i) c[i] = ""
            for (i = 1; i <= length(line); ++i) {
                ch = substr(line, i, 1)
                if (ch == "\"") {
                    if (inside && substr(line, i + 1, 1) == "\"") { c[k] = c[k] ch; ++i }
                    else inside = !inside
                } else if (ch == "," && !inside) ++k
                else c[k] = c[k] ch
            }
        }
        function ms(text) { return text == "" ? "" : sprintf(text < 10 ? "%.2f" : "%.1f", text) }
        function number(text) { return text == "" ? "" : sprintf("%.3g", text) }
        NR == 1 { next }
        {
            split_csv($0)
            if (c[1] ~ /^test_/) {
                if (!(c[1] in count)) order[++programs] = c[1]
                ++count[c[1]]
                if (c[10] == "passed") ++passed[c[1]]
                else if (c[10] == "skipped") ++skipped[c[1]]
                else bad[c[1]] = bad[c[1]] "<br>" c[2] ": " c[10]
                if (c[4] != "") time[c[1]] += c[4]
                next
            }
            gsub(/\|/, "\\|", c[2]); gsub(/\|/, "\\|", c[3])
            if (c[1] == "stability" && c[3] != "") {
                # Of its slope parameters the worst; the CSV has all of them.
                if (!(c[2] in worst)) { effects[++stable] = c[2]; worst[c[2]] = -1 }
                ++levels[c[2]]
                if (c[8] + 0 > worst[c[2]] + 0 || c[8] == "") { worst[c[2]] = c[8]; unit[c[2]] = c[9] }
                next
            }
            rows[++benched] = "| " c[1] " | " c[2] " | " c[3] " | " ms(c[4]) " | " ms(c[5]) " | " ms(c[6]) " | " number(c[8]) \
                (c[9] == "" ? "" : " " c[9]) " | " c[10] " |"
        }
        END {
            print "| step | what | level | ms | fastest | 95% | error | result |"
            print "| --- | --- | --- | --- | --- | --- | --- | --- |"
            for (k = 1; k <= programs; ++k) {
                p = order[k]
                printf "| %s | %d tests | | %.1f | | | | %d passed%s%s |\n", p, count[p], time[p], passed[p],
                    skipped[p] ? ", " skipped[p] " skipped" : "", bad[p]
            }
            for (k = 1; k <= benched; ++k) print rows[k]
            for (k = 1; k <= stable; ++k)
                printf "| stability | %s | worst of %d in OpenGL | | | | %s %s | measured |\n", effects[k],
                    levels[effects[k]], worst[effects[k]] == "" ? "infinite" : number(worst[effects[k]]), unit[effects[k]]
        }' "$csv"
} >"$out/table.md"
cat "$out/table.md"
echo "check: $out/table.md and $out/table.csv, after $((SECONDS)) s" >&2
exit $failed
