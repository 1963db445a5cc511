// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/wide_sweep.hpp"

#include <algorithm>

#include "robot/wide_single.hpp"

namespace opponens::robot::wide {

int workspace_size(const Model& model) { return std::max(layout_of(model).size, single_layout_of(model).size); }

int sweep(const Model& model, const Query& query, float* workspace, Unknown* found) {
  return run_sweep(model, query, workspace, found);
}

int sweep(const Model& model, const SingleQuery& query, float* workspace, Unknown* found) {
  return run_single(model, query, workspace, found);
}

int farthest_portable(const float* xyz, int count, const float* n) { return farthest_point(xyz, count, n); }

}  // namespace opponens::robot::wide
