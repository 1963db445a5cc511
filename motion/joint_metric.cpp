// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/joint_metric.hpp"

#include <cmath>

namespace opponens::motion {

double distance(const Eigen::Ref<const Eigen::VectorXd>& weights, const Eigen::Ref<const Eigen::VectorXd>& a,
                const Eigen::Ref<const Eigen::VectorXd>& b) {
  double sum = 0.0;
  for (Eigen::Index j = 0; j < weights.size(); ++j) sum += weights[j] * (b[j] - a[j]) * (b[j] - a[j]);
  return std::sqrt(sum);
}

double path_length(const Eigen::VectorXd& weights, const Eigen::MatrixXd& waypoints) {
  double length = 0.0;
  for (Eigen::Index i = 1; i < waypoints.rows(); ++i) {
    length += distance(weights, waypoints.row(i - 1).transpose(), waypoints.row(i).transpose());
  }
  return length;
}

double path_length_l1(const Eigen::VectorXd& weights, const Eigen::MatrixXd& waypoints) {
  double length = 0.0;
  for (Eigen::Index i = 1; i < waypoints.rows(); ++i) {
    for (Eigen::Index j = 0; j < weights.size(); ++j) {
      length += weights[j] * std::abs(waypoints(i, j) - waypoints(i - 1, j));
    }
  }
  return length;
}

}  // namespace opponens::motion
