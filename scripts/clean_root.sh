#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Proves that demo.sh or test.sh works on a fresh Debian 12: clones the committed state into a minimal root made with
# debootstrap and runs the script there. Needs root. The root is kept, so that a second run is quick; remove it to
# start afresh. See docs/fresh_machine.md.
#
#   scripts/clean_root.sh demo|test|"any command" [ROOT_FOLDER]
set -euo pipefail
[ $# -ge 1 ] || { sed -n '5,10p' "$0"; exit 2; }
[ "$(id -u)" -eq 0 ] || { echo "clean_root.sh needs root (debootstrap, chroot)" >&2; exit 2; }
command -v debootstrap >/dev/null || { echo "clean_root.sh needs debootstrap: apt-get install debootstrap" >&2; exit 2; }

SOURCE="$(cd "$(dirname "$0")/.." && pwd)"
FRESH="${2:-/var/tmp/opponens-fresh}"
MIRROR="${DEBIAN_MIRROR:-http://deb.debian.org/debian}"
case "$1" in
  demo) COMMAND="scripts/demo.sh" ;;
  test) COMMAND="scripts/test.sh" ;;
  *) COMMAND="$1" ;;
esac

[ -x "$FRESH/usr/bin/apt-get" ] || debootstrap --variant=minbase bookworm "$FRESH" "$MIRROR"
cp /etc/resolv.conf "$FRESH/etc/resolv.conf"
rm -rf "$FRESH/opponens"
git clone -q "$SOURCE" "$FRESH/opponens"

for folder in proc dev; do mountpoint -q "$FRESH/$folder" || mount --bind "/$folder" "$FRESH/$folder"; done
trap 'umount "$FRESH/proc" "$FRESH/dev"' EXIT
chroot "$FRESH" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
  bash -c "cd /opponens && $COMMAND"
