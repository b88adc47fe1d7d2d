#!/bin/bash
# By hand, as root: a fresh Debian 12 (bookworm) or 13 (trixie) in a folder of its own, that release's
# package installed there with apt, and the program used as on a new machine. Takes about ten minutes
# and 2 GB.
#
#   bare_install.sh SUITE livery_VERSION_amd64.deb [FOLDER]    FOLDER is made anew, and removed at the end
#
# Needs debootstrap. The mirror and apt's settings are this machine's.
set -euo pipefail
export LC_ALL=C

suite=${1:-} package=${2:-}
case $suite in
    bookworm) release=deb12 ;;
    trixie) release=deb13 ;;
    *) echo "bare_install: found suite \"$suite\", expected bookworm or trixie" >&2; exit 2 ;;
esac
case $package in
    *~"$release"u*.deb) package=$(realpath -e "$package") ;;
    *) echo "bare_install: found package \"$package\", expected one of $release for $suite" >&2; exit 2 ;;
esac
root=${3:-$(mktemp -d /tmp/livery-bare.XXXXXX)}
[ "$(id -u)" -eq 0 ] || { echo "bare_install: this needs root" >&2; exit 2; }
mirror=$(grep -rhoE 'https?://[^ ]+/debian/?( |$)' /etc/apt/sources.list /etc/apt/sources.list.d 2>/dev/null |
    head -1) || true

clean_up() {
    local place
    for place in proc dev; do
        ! mountpoint -q "$root/$place" || umount --recursive "$root/$place"
    done
    rm -rf --one-file-system "$root"
}
trap clean_up EXIT

echo "bare_install: a bare $suite in $root"
mkdir -p "$root"
debootstrap --variant=minbase "$suite" "$root" ${mirror:+"$mirror"} >/dev/null
mount -t proc proc "$root/proc"
mount --rbind --make-rslave /dev "$root/dev"
cp /etc/resolv.conf "$root/etc/"
cp /etc/apt/apt.conf.d/99* "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
if [ -f /etc/apt/sources.list.d/debian.sources ]; then
    here=$(. /etc/os-release && echo "$VERSION_CODENAME")
    sed "s/\b$here\b/$suite/g" /etc/apt/sources.list.d/debian.sources \
        >"$root/etc/apt/sources.list.d/debian.sources"
    rm -f "$root/etc/apt/sources.list"
fi
cp "$package" "$root/tmp/livery.deb"

inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 "$@"; }
as_user() { inside setpriv --reuid=1000 --regid=1000 --clear-groups env HOME=/home/anna "$@"; }

echo "bare_install: apt install livery"
inside apt-get -q -y update >/dev/null
inside env DEBIAN_FRONTEND=noninteractive \
    apt-get -q -y install --no-install-recommends /tmp/livery.deb >"$root/tmp/apt.log" ||
    { tail -20 "$root/tmp/apt.log"; exit 1; }
mkdir -p "$root/home/anna"
chown 1000:1000 "$root/home/anna"
inside dpkg -s livery | grep '^Status: install ok installed'

demo="/tmp/mit Leerzeichen und Ümläuten"
set -x
as_user livery --version
as_user livery help >/dev/null
as_user livery plan --look solid-red
as_user livery render --look blue-metallic --out /tmp/blau.png
[ -s "$root/tmp/blau.png" ]
as_user livery demo --out "$demo"
[ -s "$root$demo/report.html" ]
inside dpkg --verify livery
inside apt-get -q -y purge livery >/dev/null
set +x
left=$(find "$root/usr" "$root/etc" -name 'livery*')
[ -z "$left" ] || { echo "bare_install: left behind: $left" >&2; exit 1; }
echo "bare_install: done"
