// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace opponens::motion {

/// Distance of the joint metric, rad: sqrt(sum_j w_j (b_j - a_j)^2). a, b, weights: [d].
double distance(const Eigen::Ref<const Eigen::VectorXd>& weights, const Eigen::Ref<const Eigen::VectorXd>& a,
                const Eigen::Ref<const Eigen::VectorXd>& b);

/// Length of a path in that metric, rad. waypoints: [N x d], row = configuration; 0 when N < 2.
double path_length(const Eigen::VectorXd& weights, const Eigen::MatrixXd& waypoints);

/// sum over segments and joints of w_j |dq_j|, rad: the paper's "weighted sum of accumulated joint movements"
/// (docs/deviations.md, 15).
double path_length_l1(const Eigen::VectorXd& weights, const Eigen::MatrixXd& waypoints);

}  // namespace opponens::motion
