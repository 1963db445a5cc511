// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/human_likeness.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

#include "analysis/statistics.hpp"
#include "core/require.hpp"

namespace opponens::analysis {

bool is_free_motion(const Demonstration& recording) {
  const auto kind = recording.labels.find("kind");
  return kind != recording.labels.end() && kind->second == "free";
}

FreeMotion free_motion(const Demonstration& recording) {
  return {recording.id, recording.origin == Origin::simulated, moments(recording.q_h, recording.weight)};
}

std::optional<LikenessReference> free_motion_reference(std::vector<FreeMotion> motions) {
  if (motions.empty()) return std::nullopt;
  std::stable_sort(motions.begin(), motions.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  PairwiseMerge all;
  bool simulated = false;
  for (FreeMotion& motion : motions) {
    all.add(std::move(motion.statistics));
    simulated = simulated || motion.simulated;
  }
  return LikenessReference{simulated ? "free finger motions (simulated)" : "free finger motions",
                           all.result().covariance};
}

std::optional<LikenessReference> free_motion_reference(const std::vector<const Demonstration*>& recordings) {
  std::vector<FreeMotion> motions;
  for (const Demonstration* recording : recordings) {
    if (is_free_motion(*recording)) motions.push_back(free_motion(*recording));
  }
  return free_motion_reference(std::move(motions));
}

std::optional<double> human_likeness(const Eigen::Ref<const Eigen::MatrixXd>& q_h, const LikenessReference& reference) {
  const Eigen::MatrixXd& sigma = reference.covariance;
  require(sigma.rows() == q_h.cols() && sigma.cols() == q_h.cols(),
          "human_likeness: path and reference '" + reference.name + "' differ in joints");
  require(q_h.allFinite() && sigma.allFinite(), "human_likeness: path or reference is not finite");
  if (q_h.rows() < 2) return std::nullopt;
  const double largest =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(sigma, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
  if (!(largest > 0.0)) return std::nullopt;
  double length = 0.0;
  double alike = 0.0;  // sum of |x| c(x) s1
  for (Eigen::Index i = 0; i + 1 < q_h.rows(); ++i) {
    const Eigen::VectorXd x = (q_h.row(i + 1) - q_h.row(i)).transpose();
    length += x.norm();
    alike += std::sqrt(std::max(0.0, x.dot(sigma * x)));
  }
  if (length == 0.0) return std::nullopt;
  return std::min(100.0, 100.0 * alike / (length * std::sqrt(largest)));
}

}  // namespace opponens::analysis
