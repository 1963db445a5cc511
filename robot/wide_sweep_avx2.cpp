// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Compiled for processors with AVX2 and FMA; called only where there is one.
#include "robot/wide_sweep.hpp"

#include "robot/wide_single.hpp"

namespace opponens::robot::wide {

int sweep_avx2(const Model& model, const Query& query, float* workspace, Unknown* found) {
  return run_sweep(model, query, workspace, found);
}

int sweep_avx2(const Model& model, const SingleQuery& query, float* workspace, Unknown* found) {
  return run_single(model, query, workspace, found);
}

int farthest_avx2(const float* xyz, int count, const float* n) { return farthest_point(xyz, count, n); }

}  // namespace opponens::robot::wide
