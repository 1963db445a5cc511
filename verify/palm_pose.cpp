// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/palm_pose.hpp"

#include <algorithm>
#include <cmath>

namespace opponens::verify {

void check_palm(const robot::RobotModel& robot, const Eigen::VectorXd& q, int palm, const Eigen::Isometry3d& X_RH,
                const std::string& name, double tolerance, Verdict& verdict) {
  const Eigen::Isometry3d X = robot.link_poses(q)[static_cast<std::size_t>(palm)];
  const double distance = (X.translation() - X_RH.translation()).norm();
  // |R - R'|_F = 2 sqrt(2) sin(angle / 2), exact near zero where the trace is not.
  const double angle = 2.0 * std::asin(std::min(1.0, (X.linear() - X_RH.linear()).norm() / std::sqrt(8.0)));
  if (!(distance <= tolerance) || !(angle <= tolerance)) {
    verdict.fail(name + " puts the palm " + number(1e3 * distance) + " mm and " + number(angle) +
                 " rad off the grasp's pose");
  }
}

}  // namespace opponens::verify
