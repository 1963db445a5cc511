#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Sets up, builds and tests everything, as CI does: the release build with warnings as errors and all tests, the
# installed package, the sanitizer build, and each fuzz target for some seconds. `scripts/test.sh release`, `sanitize` or
# `fuzz` runs one part; `scripts/test.sh fuzz 600` each target for ten minutes.
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

# One target on its seeds and on what they grow to; what makes it fail is left in build/sanitize/fuzz.
fuzz_one() {  # SECONDS TARGET
  local name build="$ROOT/build/sanitize/fuzz"
  name="$(basename "$2" _fuzz)"
  "$2" -max_total_time="$1" -timeout=20 -rss_limit_mb=2048 -max_len=4096 -print_final_stats=1 \
    -artifact_prefix="$build/$name-" "$build/corpus/$name" >"$build/$name.log" 2>&1 ||
    { echo "$name:"; tail -n 60 "$build/$name.log"; return 1; }
  echo "$name: $(grep number_of_executed_units "$build/$name.log")"
}

run_fuzzers() {  # SECONDS
  say "Fuzzing ($1 s each)"
  /usr/bin/python3 "$ROOT/tests/fuzz/make_corpus.py" "$ROOT/build/sanitize/fuzz/corpus"
  export ROOT
  export -f fuzz_one
  printf '%s\n' "$ROOT"/build/sanitize/tests/fuzz/*_fuzz | xargs -n 1 -P "$(nproc)" bash -c 'fuzz_one "$@"' fuzz "$1"
}

part="${1:-all}"
case "$part" in
  all|release|sanitize|fuzz) ;;
  *) echo "usage: scripts/test.sh [all|release|sanitize|fuzz [SECONDS]]" >&2; exit 2 ;;
esac

# Under the sanitizers without the install test, the long flows, whole grasp searches and simulations of statistics, which
# belong to the release build. Compiled by Clang, which is quicker at it than GCC, and libFuzzer is Clang's: one
# build serves both. Without -Werror: the release build holds to GCC's warnings.
# UBSan without null and object-size, which ASan sees, and alignment; the readers of outside bytes have them too.
sanitize_build() {  # TARGET
  configure_and_build sanitize "$1" -DOPPONENS_WERROR=OFF -DOPPONENS_TESTS=ON -DOPPONENS_EXAMPLES=OFF \
    -DOPPONENS_TEST_CASES=OFF
}

# Of damaged files fewer than the tests' own number, which takes minutes.
export OPPONENS_MUTATIONS="${OPPONENS_MUTATIONS:-120}"

install_packages
if [ "$part" = all ] || [ "$part" = release ]; then
  configure_and_build release all -DOPPONENS_WERROR=ON -DOPPONENS_TESTS=ON -DOPPONENS_EXAMPLES=ON \
    -DOPPONENS_TEST_CASES=OFF
  run_tests release
fi
if [ "$part" = all ] || [ "$part" = sanitize ]; then
  sanitize_build all
  export LSAN_OPTIONS="suppressions=$ROOT/tests/support/lsan.supp:print_suppressions=0"
  run_tests sanitize -LE release_only
fi
if [ "$part" = all ] || [ "$part" = fuzz ]; then
  sanitize_build fuzzers
  run_fuzzers "${2:-5}"
fi
say "All tests passed"
