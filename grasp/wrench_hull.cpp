// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/wrench_hull.hpp"

#include "robot/quickhull.hpp"

namespace opponens::grasp {

std::optional<WrenchHull> wrench_hull(const Matrix6Xd& points) {
  auto hull = robot::Quickhull::build(points, "Qt Q12");
  if (!hull) return std::nullopt;
  return WrenchHull{hull->volume(), hull->least_offset()};
}

}  // namespace opponens::grasp
