#!/bin/bash
# The installed desktop program where little can be written: it opens, says what is not saved, and
# goes on. On an X server of its own; 77 (skipped) where there is none.
#
#   desktop_test.sh CMAKE BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail

server=/usr/lib/xorg/Xorg
[ -x "$server" ] || server=$(command -v Xorg) || { echo "no Xorg"; exit 77; }
command -v xdotool >/dev/null || { echo "no xdotool"; exit 77; }
. "$(dirname "$0")/installed.sh"

# --- a screen -----------------------------------------------------------------------------------
cat >"$work/xorg.conf" <<'CONF'
Section "ServerFlags"
    Option "AutoAddDevices" "false"
    Option "AutoAddGPU" "false"
    Option "DontVTSwitch" "true"
EndSection
Section "Device"
    Identifier "device"
    Driver "dummy"
    VideoRam 64000
EndSection
Section "Screen"
    Identifier "screen"
    Device "device"
    DefaultDepth 24
    SubSection "Display"
        Depth 24
        Virtual 1280 800
    EndSubSection
EndSection
CONF
mkfifo "$work/display"
exec 8<>"$work/display"
"$server" -displayfd 8 -config "$work/xorg.conf" -logfile "$work/xorg.log" -ac -noreset \
    -novtswitch -sharevts -nolisten tcp >"$work/xorg.out" 2>&1 &
server_id=$!
program_id=
stop_all() {
    local id
    for id in $program_id $server_id; do kill "$id" 2>/dev/null || true; done
    wait 2>/dev/null || true
    clean_up
}
trap stop_all EXIT
read -r -t 60 number <&8 || { cat "$work/xorg.out" "$work/xorg.log"; exit 1; }

# --- the program --------------------------------------------------------------------------------
map=$outputs/map.json

# open HOME ARGUMENTS: in the background; waits for its window and its first report.
open() {
    local home=$1
    shift
    rm -f "$map"
    (cd / && exec "${user[@]}" env -i "${surroundings[@]}" HOME="$home" DISPLAY=":$number" \
        "$prefix/bin/livery" desktop --size 1000x700 --ui-map "$map" "$@") \
        >"$work/out" 2>"$work/err" </dev/null &
    program_id=$!
    wait_for "the window's map" test -s "$map"
    wait_for "a window" env DISPLAY=":$number" xdotool search --onlyvisible --class livery
}
wait_for() {
    local what=$1 try
    shift
    for ((try = 0; try < 600; ++try)); do
        if "$@" >"$work/waited" 2>&1; then return; fi
        kill -0 "$program_id" 2>/dev/null || break
        sleep 0.2
    done
    fail "waited in vain for $what"
    cat "$work/out" "$work/err" "$map" >&2 || true
}
reports() { grep -qF -- "$1" "$map"; }
press() { DISPLAY=":$number" xdotool key "$1"; }
# Takes a change, and is still there.
takes_a_change() {
    local looks
    looks=$(grep -oE '"looks": ?[0-9]+' "$map")
    press n
    wait_for "one look more than $looks" eval '! reports "$looks"'
    kill -0 "$program_id" 2>/dev/null || fail "it has ended"
}
close() {
    press ctrl+q
    local code=0
    wait "$program_id" || code=$?
    program_id=
    [ "$code" -eq 0 ] || { fail "closing: exit status $code"; cat "$work/err" >&2; }
}

session="$outputs/Größe für Müller.livery"
open "$home" --session "$session"
wait_for "word of the calibration" reports "Calibrating the simulated bench."
wait_for "a session that is saved" reports '"saved": true'
takes_a_change
close
[ -s "$session" ] || fail "no session was saved"
[ -s "$home/.local/share/livery/log/livery.log" ] || fail "no log was written"
[ ! -s "$work/err" ] || { fail "it complained:"; cat "$work/err" >&2; }
open "$home" --session "$session"
wait_for "the session of before" reports '"looks": 5'
close

open "$read_only"
wait_for "word of what is not saved" reports "Nothing that you do is being saved."
wait_for "word of the ballots" reports "Ballots cannot be kept."
wait_for "word of the calibration" reports "The simulated bench could not be calibrated"
reports '"saved": false' || fail "it says that it saves"
takes_a_change
close
[ "$(grep -c 'cannot be written' "$work/err")" -eq 1 ] || { fail "the log"; cat "$work/err" >&2; }

open "$home" --session "$read_only/x.livery"
wait_for "word of what is not saved" reports "Nothing that you do is being saved."
takes_a_change
close

mkdir "$small"
if [ "$(id -u)" -eq 0 ] && mount -t tmpfs -o size=1m,mode=777 tmpfs "$small" 2>/dev/null; then
    open "$small" --session "$small/voll.livery"
    wait_for "a session that is saved" reports '"saved": true'
    dd if=/dev/zero of="$small/filling" bs=4k 2>/dev/null || true
    press n
    wait_for "word of what is not saved" reports '"saved": false'
    takes_a_change
    rm "$small/filling"
    press n
    wait_for "a session that is saved again" reports '"saved": true'
    dd if=/dev/zero of="$small/filling" bs=4k 2>/dev/null || true
    close
    open "$small" --session "$small/neu.livery"
    wait_for "word of what is not saved" reports "Nothing that you do is being saved."
    takes_a_change
    close
    umount "$small"
else
    skip "no small disk: it takes root and mount"
fi
finish
