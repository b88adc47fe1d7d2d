# Sourced: Livery installed below a folder with spaces and umlauts, and surroundings to use it in.
#
#   . installed.sh CMAKE BUILD_FOLDER SOURCE_FOLDER
#
# Sets $build, $source, $prefix; $home and $outputs, which may be written, $read_only, $small for
# a small disk; $locale; $user, before a command that must not be root; $surroundings, what the
# program's environment holds.

cmake=$1 build=$(realpath "$2") source=$(realpath "$3")
work=$(mktemp -d "${TMPDIR:-/tmp}/livery Prüfung.XXXXXX")
small="$work/kleine Platte"
clean_up() {
    ! mountpoint -q "$small" || umount "$small"
    rm -rf "$work"
}
trap clean_up EXIT
failures=0

fail() {
    echo "FAILED: $*" >&2
    failures=$((failures + 1))
}
skip() { echo "[  SKIPPED ] package: $*"; }

prefix="$work/Über All/usr"
"$cmake" --install "$build" --prefix "$prefix" --strip >"$work/install.log"
chmod 755 "$work"

# A locale with a decimal comma, made here, so that none need be installed.
locale=C.UTF-8
if command -v localedef >/dev/null && mkdir "$work/locales" &&
    localedef -i de_DE -f UTF-8 "$work/locales/de_DE.UTF-8" 2>/dev/null; then
    locale=de_DE.UTF-8
    chmod -R a+rX "$work/locales"
else
    skip "no decimal comma: localedef or its sources are not there"
fi
home="$work/Heimat" read_only="$work/nur lesen" outputs="$work/Ausgaben für heute"
mkdir "$home" "$read_only" "$outputs"
chmod 777 "$home" "$outputs"
chmod 555 "$read_only"
# Root may write everywhere, so it becomes nobody.
user=()
if [ "$(id -u)" -eq 0 ]; then user=(setpriv --reuid=65534 --regid=65534 --clear-groups); fi
surroundings=(PATH="$PATH" LC_ALL="$locale" LOCPATH="$work/locales"
    MESA_SHADER_CACHE_DIR="$outputs/cache")

finish() {
    [ "$failures" -eq 0 ] || { echo "$failures failures" >&2; exit 1; }
    echo "installed and used in $prefix"
}
