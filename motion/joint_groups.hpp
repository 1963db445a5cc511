// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/path.hpp"

namespace opponens::motion {

/// A length of its own for a group of joints: the most that they may move in a step, or between two checked
/// configurations. Measured in the joint metric over the group's joints alone; the metric itself stays as it is.
struct GroupLimit {
  int first = 0;  ///< index range in q
  int count = 0;
  double limit = 0.0;  ///< rad, positive
};

GroupLimit limit_of(const PlanningGroup& group, double limit);

/// Throws std::invalid_argument naming `what`, the group and the violated constraint. dimension: of q.
void validate(const std::vector<GroupLimit>& limits, Eigen::Index dimension, const std::string& what);

/// Largest of the groups' movements from a to b as a share of their limit: 1 when one moves by just its limit, 0
/// without groups. weights, a, b: [d].
double largest_share(const Eigen::Ref<const Eigen::VectorXd>& weights, const Eigen::Ref<const Eigen::VectorXd>& a,
                     const Eigen::Ref<const Eigen::VectorXd>& b, const std::vector<GroupLimit>& limits);

/// Spacing of checked configurations: no more than `all` in the joint metric, and no more than its own for each group.
struct Spacing {
  Spacing(double length) : all(length) {}  // NOLINT(google-explicit-constructor): one number is the usual spacing
  Spacing(double length, std::vector<GroupLimit> own) : all(length), groups(std::move(own)) {}

  double all;  ///< rad
  std::vector<GroupLimit> groups;
  Spacing divided_by(double share) const;
};
/// Throws std::invalid_argument naming `who`.
void validate(const Spacing& spacing, const std::string& who);

/// The motion's length in spacings: at least so many equal segments keep to it.
double spacings(const Spacing& spacing, const Eigen::Ref<const Eigen::VectorXd>& weights,
                const Eigen::Ref<const Eigen::VectorXd>& a, const Eigen::Ref<const Eigen::VectorXd>& b);

}  // namespace opponens::motion
