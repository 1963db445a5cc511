#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Table 2 on the easy and the hard cylinder shelf: makes the store of simulated movements in OUT, then both tables.
# usage: run.sh BUILD_DIRECTORY OUT [more options of table2_planning]
set -euo pipefail
[ $# -ge 2 ] || { echo "usage: $0 BUILD_DIRECTORY OUT [OPTIONS]" >&2; exit 2; }
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
build="$(realpath "$1")"
out="$(realpath -m "$2")"
shift 2
here=experiments/table2_planning
cd "$root"

if [ ! -d "$out/store" ]; then
  for command in simulate retarget analyze; do "$build/cli/opponens" $command --store "$out/store" --quiet; done
fi
for scene in cylinder_shelf cylinder_shelf_hard; do
  "$build/$here/table2_planning" --store "$out/store" --scene "models/scenes/$scene.yaml" \
    --grasps "$here/grasps/cylinder.json" --out "$out/$scene" "$@"
done
