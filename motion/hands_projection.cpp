// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/hands_projection.hpp"

#include <algorithm>
#include <utility>

#include "core/require.hpp"

namespace opponens::motion {

Projection hands_projection(const std::vector<HandBox>& hands, const Eigen::VectorXd& lower,
                            const Eigen::VectorXd& upper) {
  std::vector<std::pair<int, int>> ranges;
  std::vector<Projection> each;
  for (const HandBox& one : hands) {
    ranges.emplace_back(one.hand.first, one.hand.first + one.hand.count);
    each.push_back(box_projection(one.box, one.hand, lower, upper));
  }
  std::sort(ranges.begin(), ranges.end());
  for (std::size_t i = 1; i < ranges.size(); ++i) {
    require(ranges[i].first >= ranges[i - 1].second, "hands_projection: two hands have joints in common");
  }
  return [each = std::move(each)](const Eigen::VectorXd& q_target) {
    Eigen::VectorXd q = q_target;
    for (const Projection& project : each) q = project(q);
    return q;
  };
}

BoxDistance hands_distance(const std::vector<HandBox>& hands) {
  std::vector<BoxDistance> each;
  for (const HandBox& one : hands) each.push_back(box_distance(one.box, one.hand));
  return farthest(std::move(each));
}

}  // namespace opponens::motion
