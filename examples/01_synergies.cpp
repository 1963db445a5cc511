// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Synergies from recordings: makes a few two-phase movements of a 3-joint hand, finds the phases, the synergies and the
// boxes, and projects a posture onto the box of a group. Usage: example_01_synergies
#include <algorithm>
#include <cstdio>

#include "analysis/analyze.hpp"
#include "analysis/synergy_box.hpp"
#include "core/rng.hpp"

namespace {

using namespace opponens;

/// Opens along one direction of hand space, then closes along another that depends on the group.
Demonstration movement(const std::string& id, const std::string& family, const Eigen::Vector3d& closing, Rng& rng) {
  constexpr int samples = 80;
  Demonstration demonstration;
  demonstration.id = id;
  demonstration.labels = {{"subject", "someone"}, {"family", family}};
  demonstration.joint_names = {"index", "middle", "thumb"};
  demonstration.time = Eigen::VectorXd::LinSpaced(samples, 0.0, 1.6);
  demonstration.q_h.resize(samples, 3);
  for (int i = 0; i < samples; ++i) {
    const double open = std::min(i / 40.0, 1.0);
    const double close = std::max(i / 40.0 - 1.0, 0.0);
    const Eigen::Vector3d noise(rng.normal(), rng.normal(), rng.normal());
    demonstration.q_h.row(i) = 0.5 * open * Eigen::Vector3d(-1.0, -1.0, 0.3) + close * closing + 0.02 * noise;
  }
  return demonstration;
}

}  // namespace

int main() {
  Rng rng(1);
  std::vector<Demonstration> demonstrations;
  for (int i = 0; i < 10; ++i) {
    demonstrations.push_back(movement("pinch_" + std::to_string(i), "pinch", {1.2, 0.2, 0.8}, rng));
    demonstrations.push_back(movement("wrap_" + std::to_string(i), "wrap", {1.0, 1.1, 0.5}, rng));
  }

  const auto analysis = analysis::analyze(demonstrations, {});
  if (!analysis) return std::printf("no synergies: %s\n", analysis.error().detail.c_str()), 1;
  for (const auto& group : analysis->groups) {
    std::printf("%-10s k = %d, first synergy explains %.1f %% of the variance\n", group.name.c_str(), group.k,
                100.0 * group.cumulative_variance(0));
  }

  const SynergyBox& wrap = analysis->synergies.grasp.back().box;
  const Eigen::VectorXd strange = Eigen::Vector3d(0.4, -0.8, 1.5);
  std::printf("(0.4, -0.8, 1.5) projected onto the box of 'wrap':");
  for (const double q : analysis::project(wrap, strange)) std::printf(" %.3f", q);
  std::printf("\n");
  return 0;
}
