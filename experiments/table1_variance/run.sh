#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Table 1 on simulated and on recorded movements: makes both stores in OUT and prints the tables.
# usage: run.sh BUILD_DIRECTORY OUT [RECORDINGS]   (RECORDINGS: folder of west_r2g; left out: simulated movements only)
set -euo pipefail
[ $# -ge 2 ] || { echo "usage: $0 BUILD_DIRECTORY OUT [RECORDINGS]" >&2; exit 2; }
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
build="$(realpath "$1")"
out="$(realpath -m "$2")"
opponens="$build/cli/opponens"
cd "$root"

"$opponens" simulate --store "$out/simulated" --quiet
"$opponens" retarget --store "$out/simulated" --quiet
"$opponens" analyze --store "$out/simulated" --quiet
stores=("$out/simulated")
if [ $# -ge 3 ]; then
  "$opponens" ingest "$3" --store "$out/west_r2g" --source models/sources/west_r2g.yaml --quiet
  "$opponens" retarget --store "$out/west_r2g" --quiet
  "$opponens" analyze --store "$out/west_r2g" --group-by object --quiet
  stores+=("$out/west_r2g")
fi
"$build/experiments/table1_variance/table1_variance" "${stores[@]}"
