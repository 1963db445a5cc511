#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Sets up, builds and tests everything, as CI does: the release build with warnings as errors and all tests, the
# installed package, and the sanitizer build. `scripts/test.sh release` or `sanitize` runs one part.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

# Off a terminal the log is for what failed: a few lines per passed test would bury it.
without_passed() {
  if [ -t 1 ]; then cat; else grep --line-buffered -vE '^ *Start +[0-9]+:|   Passed +[0-9.]+ sec$'; fi
}

run_tests() {  # PRESET ctest-options...
  local preset="$1"
  shift
  say "Testing ($preset)"
  (cd "$ROOT/build/$preset" && ctest --output-on-failure --no-tests=error -j "$(nproc)" "$@") | without_passed
}

part="${1:-all}"
case "$part" in
  all|release|sanitize) ;;
  *) echo "usage: scripts/test.sh [all|release|sanitize]" >&2; exit 2 ;;
esac

install_packages
if [ "$part" != sanitize ]; then
  configure_and_build release -DOPPONENS_WERROR=ON -DOPPONENS_TESTS=ON -DOPPONENS_EXAMPLES=ON
  run_tests release
fi
if [ "$part" != release ]; then
  # The install test, the long flows, whole grasp searches and simulations of statistics belong to the release build.
  # UBSan without null and object-size, which ASan sees, and alignment: they double the time to compile Eigen.
  # No -Werror here: GCC 12's sanitizers raise false alarms of uninitialised use in the standard library.
  configure_and_build sanitize -DOPPONENS_WERROR=OFF -DOPPONENS_TESTS=ON -DOPPONENS_EXAMPLES=OFF
  export LSAN_OPTIONS="suppressions=$ROOT/tests/support/lsan.supp:print_suppressions=0"
  run_tests sanitize -LE release_only -E 'GraspSearch\.(Sphere|BoxOnATable|AnObjectTooLarge)'
fi
say "All tests passed"
