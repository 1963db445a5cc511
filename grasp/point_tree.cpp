// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/point_tree.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace opponens::grasp {

PointTree::PointTree(std::vector<Eigen::Vector3d> points) : points_(std::move(points)) {
  if (points_.empty()) return;
  balls_.reserve(points_.size() / 2 + 1);
  enclose(0, points_.size());
}

void PointTree::enclose(std::size_t begin, std::size_t end) {
  const std::size_t index = balls_.size();
  Eigen::AlignedBox3d box;
  for (std::size_t i = begin; i < end; ++i) box.extend(points_[i]);
  const Eigen::Vector3d center = box.center();
  double reach = 0.0;
  for (std::size_t i = begin; i < end; ++i) reach = std::max(reach, (points_[i] - center).squaredNorm());
  balls_.push_back({center, std::sqrt(reach), static_cast<int>(begin), static_cast<int>(end), 0});
  if (end - begin <= kLeaf) return;
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [this](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [axis](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a[axis] < b[axis]; });
  enclose(begin, middle);
  balls_[index].second = static_cast<int>(balls_.size());
  enclose(middle, end);
}

}  // namespace opponens::grasp
