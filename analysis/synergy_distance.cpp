// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/synergy_distance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/QR>
#include <Eigen/SVD>

#include "analysis/likeness.hpp"
#include "core/require.hpp"

namespace opponens::analysis {
namespace {

void check_orthonormal(const Eigen::Ref<const Eigen::MatrixXd>& axes) {
  require(axes.cols() >= 1 && axes.cols() <= axes.rows(), "principal_angles: needs 1 to n columns");
  const double error = (axes.transpose() * axes - Eigen::MatrixXd::Identity(axes.cols(), axes.cols())).norm();
  require(error < 1e-8,
          [&] { return "principal_angles: columns are not orthonormal, off by " + std::to_string(error); });
}

/// Orthonormal columns of the same span as the kept synergies, in unscaled joint coordinates.
Eigen::MatrixXd span_in_joints(const SynergyBox& box) {
  const Eigen::MatrixXd axes = box.scale.asDiagonal() * box.axes;
  return Eigen::HouseholderQR<Eigen::MatrixXd>(axes).householderQ() *
         Eigen::MatrixXd::Identity(axes.rows(), axes.cols());
}

SampleStatistics statistics_in_joints(const SynergyGroup& group) {
  const SynergyBasis& basis = group.basis;
  const Eigen::MatrixXd axes = group.box.scale.asDiagonal() * basis.axes;
  return {basis.count, basis.mean.cwiseProduct(group.box.scale), axes * basis.variance.asDiagonal() * axes.transpose()};
}

double share_inside(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& span) {
  const double total = covariance.trace();
  return total > 0.0 ? std::clamp((span.transpose() * covariance * span).trace() / total, 0.0, 1.0) : 0.0;
}

const SynergyGroup* find(const SynergySet& set, const std::string& name) {
  const auto found =
      std::find_if(set.grasp.begin(), set.grasp.end(), [&](const auto& one) { return one.name == name; });
  return found == set.grasp.end() ? nullptr : &*found;
}

}  // namespace

Eigen::VectorXd principal_angles(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                 const Eigen::Ref<const Eigen::MatrixXd>& b) {
  require(a.rows() == b.rows(), "principal_angles: the subspaces are of different spaces");
  check_orthonormal(a);
  check_orthonormal(b);
  if (a.cols() < b.cols()) return principal_angles(b, a);  // then every angle is one of b's directions to a's span
  const Eigen::VectorXd cosine = Eigen::JacobiSVD<Eigen::MatrixXd>(a.transpose() * b).singularValues();
  const Eigen::MatrixXd rest = b - a * (a.transpose() * b);
  const Eigen::VectorXd sine = Eigen::JacobiSVD<Eigen::MatrixXd>(rest).singularValues().reverse();
  Eigen::VectorXd angles(b.cols());
  for (Eigen::Index i = 0; i < angles.size(); ++i) {
    const bool small = cosine[i] > std::numbers::sqrt2 / 2.0;
    angles[i] = small ? std::asin(std::min(sine[i], 1.0)) : std::acos(std::clamp(cosine[i], 0.0, 1.0));
  }
  return angles;
}

double subspace_distance(const Eigen::VectorXd& angles, int k_a, int k_b) {
  require(angles.size() == std::min(k_a, k_b), "subspace_distance: one angle per common dimension");
  return std::sqrt(angles.squaredNorm() + std::abs(k_a - k_b) * std::numbers::pi * std::numbers::pi / 4.0);
}

Result<SynergyComparison> compare(const SynergyGroup& a, const SynergyGroup& b, std::optional<double> resolution) {
  if (a.box.scale.size() != b.box.scale.size()) {
    return failure(FailureCode::invalid_input, "group " + a.name + ": of " + std::to_string(a.box.scale.size()) +
                                                   " joints in one set and " + std::to_string(b.box.scale.size()) +
                                                   " in the other");
  }
  const Eigen::MatrixXd span_a = span_in_joints(a.box);
  const Eigen::MatrixXd span_b = span_in_joints(b.box);
  const SampleStatistics moments_a = statistics_in_joints(a);
  const SampleStatistics moments_b = statistics_in_joints(b);
  SynergyComparison result;
  result.group = a.name;
  result.k_a = static_cast<int>(span_a.cols());
  result.k_b = static_cast<int>(span_b.cols());
  result.angles = principal_angles(span_a, span_b);
  result.distance = subspace_distance(result.angles, result.k_a, result.k_b);
  result.shared_a = share_inside(moments_a.covariance, span_b);
  result.shared_b = share_inside(moments_b.covariance, span_a);
  if (!resolution) return result;
  const double ridge = *resolution * *resolution;
  const Result<double> bhattacharyya = bhattacharyya_distance(moments_a, moments_b, ridge);
  if (!bhattacharyya) return tl::make_unexpected(bhattacharyya.error());
  const Result<double> likeness = log_likeness(moments_a, moments_b, ridge);
  if (!likeness) return tl::make_unexpected(likeness.error());
  result.bhattacharyya = *bhattacharyya;
  result.log_likeness = *likeness;
  return result;
}

Result<std::vector<SynergyComparison>> compare(const SynergySet& a, const SynergySet& b, double resolution) {
  if (a.joint_names != b.joint_names) {
    return failure(FailureCode::invalid_input, "the synergy sets are of different joints");
  }
  if (a.order != b.order) {
    return failure(FailureCode::invalid_input, "one synergy set is of joint positions, the other of joint velocities");
  }
  const auto ridge = a.order == 0 ? std::optional(resolution) : std::nullopt;
  std::vector<SynergyComparison> result;
  if (a.pre_grasp.phase == b.pre_grasp.phase) {
    const Result<SynergyComparison> common = compare(a.pre_grasp, b.pre_grasp, ridge);
    if (!common) return tl::make_unexpected(common.error());
    result.push_back(*common);
  }
  for (const SynergyGroup& group : a.grasp) {
    const SynergyGroup* other = find(b, group.name);
    if (other == nullptr || other->phase != group.phase) continue;
    const Result<SynergyComparison> one = compare(group, *other, ridge);
    if (!one) return tl::make_unexpected(one.error());
    result.push_back(*one);
  }
  if (result.empty()) return failure(FailureCode::not_found, "the synergy sets have no group in common");
  return result;
}

}  // namespace opponens::analysis
