#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs what opponens needs on Debian 12: the packages of scripts/packages.txt. Does nothing when all are there.
# Sourced by the other scripts for say(), or run alone.
set -euo pipefail
ROOT="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

say() { printf '\n== %s\n' "$*"; }

missing_packages() {
  local package
  grep -vE '^\s*(#|$)' "$ROOT/scripts/packages.txt" | while read -r package; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' || echo "$package"
  done
}

install_packages() {
  local missing as_root=()
  missing="$(missing_packages)"
  if [ -z "$missing" ]; then
    say "Debian packages: all there"
    return
  fi
  if ! command -v apt-get >/dev/null; then
    echo "opponens is set up with apt-get on Debian 12; this system has none. Needed:" $missing >&2
    exit 2
  fi
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "Not root, and no sudo: install as root:" $missing >&2; exit 2; }
    as_root=(sudo)
  fi
  say "Debian packages: installing" $missing
  "${as_root[@]}" apt-get update -q
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing
}

# configure_and_build PRESET TARGET [cmake options...]
configure_and_build() {
  local preset="$1" target="$2"
  shift 2
  say "Building ($preset, $(nproc) cores, compiler cache $(ccache --get-config cache_dir))"
  (cd "$ROOT" && cmake --preset "$preset" "$@" --log-level=WARNING &&
    cmake --build --preset "$preset" --target "$target" -j "$(nproc)")
}

if [ "${BASH_SOURCE[0]}" = "$0" ]; then
  install_packages
fi
