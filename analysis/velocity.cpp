// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "analysis/velocity.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/require.hpp"

namespace opponens::analysis {
namespace {

void check_time(const Eigen::VectorXd& time) {
  require(time.size() >= 2, "joint_velocities: needs at least 2 samples");
  const Eigen::VectorXd steps = time.tail(time.size() - 1) - time.head(time.size() - 1);
  require(steps.allFinite() && (steps.array() > 0.0).all(), "joint_velocities: time does not increase");
}

/// Derivative at `at` of the parabola through the samples first, first + 1, first + 2 (Lagrange's form).
Eigen::RowVectorXd parabola_slope(const Eigen::VectorXd& time, const Eigen::Ref<const Eigen::MatrixXd>& q,
                                  Eigen::Index first, double at) {
  const double a = time[first];
  const double b = time[first + 1];
  const double c = time[first + 2];
  return (2.0 * at - b - c) / ((a - b) * (a - c)) * q.row(first) +
         (2.0 * at - a - c) / ((b - a) * (b - c)) * q.row(first + 1) +
         (2.0 * at - a - b) / ((c - a) * (c - b)) * q.row(first + 2);
}

}  // namespace

Eigen::MatrixXd joint_velocities(const Eigen::VectorXd& time, const Eigen::Ref<const Eigen::MatrixXd>& q_h) {
  check_time(time);
  const Eigen::Index samples = time.size();
  require(q_h.rows() == samples, "joint_velocities: time and q_h differ in length");
  Eigen::MatrixXd velocity(samples, q_h.cols());
  if (samples == 2) {
    velocity.rowwise() = Eigen::RowVectorXd((q_h.row(1) - q_h.row(0)) / (time[1] - time[0]));
    return velocity;
  }
  for (Eigen::Index i = 0; i < samples; ++i) {
    velocity.row(i) = parabola_slope(time, q_h, std::clamp<Eigen::Index>(i - 1, 0, samples - 3), time[i]);
  }
  return velocity;
}

double velocity_noise_gain(const Eigen::VectorXd& time) {
  check_time(time);
  std::vector<double> steps;
  for (Eigen::Index i = 1; i < time.size(); ++i) steps.push_back(time[i] - time[i - 1]);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return 1.0 / (std::sqrt(2.0) * *middle);
}

}  // namespace opponens::analysis
