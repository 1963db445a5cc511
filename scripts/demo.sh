#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The opponens authors
# SPDX-License-Identifier: BSD-3-Clause
#
# From a fresh clone on Debian 12 to a report: sets up, builds and runs `opponens demo`. Arguments go to the demo.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_packages
configure_and_build release all -DOPPONENS_TESTS=OFF -DOPPONENS_EXAMPLES=OFF
say "Running the demonstration"
cd "$ROOT"
exec build/release/cli/opponens demo "$@"
