// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/distance_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>

#include "core/require.hpp"

namespace opponens::grasp {

DistanceGrid::DistanceGrid(const robot::MeshDistance& mesh, const Layout& layout, int threads)
    : DistanceGrid(
          [&mesh](const Eigen::Vector3d& p) { return mesh.signed_distance(p); },
          Eigen::AlignedBox3d(mesh.mesh().vertices.rowwise().minCoeff(), mesh.mesh().vertices.rowwise().maxCoeff()),
          layout, threads) {}

DistanceGrid::DistanceGrid(const std::function<double(const Eigen::Vector3d&)>& distance,
                           const Eigen::AlignedBox3d& box, const Layout& layout, int threads)
    : spacing_(layout.spacing), margin_(layout.margin) {
  require(layout.spacing > 0.0 && layout.margin > 0.0 && layout.max_nodes >= 8 && threads > 0,
          "DistanceGrid: spacing, margin and threads must be positive, max_nodes at least 8");
  lower_ = box.min().array() - layout.margin;
  const Eigen::Vector3d extent = (box.max().array() + layout.margin).matrix() - lower_;
  const auto nodes = [&] { return (extent / spacing_).array().ceil().cast<double>() + 1.0; };
  while (nodes().prod() > static_cast<double>(layout.max_nodes)) spacing_ *= 1.1;
  cells_per_meter_ = 1.0 / spacing_;
  count_ = nodes().cast<int>().max(2);
  upper_ = lower_ + spacing_ * (count_.array() - 1).cast<double>().matrix();
  nodes_.resize(static_cast<std::size_t>(count_.cast<std::int64_t>().prod()));
  const auto fill = [&](int first) {
    for (int z = first; z < count_.z(); z += threads) {
      std::size_t index = static_cast<std::size_t>(z) * count_.y() * count_.x();
      for (int y = 0; y < count_.y(); ++y) {
        for (int x = 0; x < count_.x(); ++x) {
          nodes_[index++] = static_cast<float>(distance(lower_ + spacing_ * Eigen::Vector3d(x, y, z)));
        }
      }
    }
  };
  std::vector<std::jthread> workers;
  for (int t = 1; t < threads; ++t) workers.emplace_back(fill, t);
  fill(0);
}

double DistanceGrid::value_outside(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d inside = nearest(p);
  return interpolate(locate(inside)) + (p - inside).norm();
}

double DistanceGrid::bound_outside(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d inside = nearest(p);
  const double outside = (p - inside).norm();
  return std::max(interpolate(locate(inside)) - outside, margin_ + outside);
}

SignedDistance DistanceGrid::query(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d inside = nearest(p);
  const Cell cell = locate(inside);
  const Eigen::Vector3d& f = cell.fraction;
  const float* n = cell.node;
  const std::ptrdiff_t row = count_.x();
  const std::ptrdiff_t layer = row * count_.y();
  // Along x on the four edges, then y, then z.
  const auto edge = [&](std::ptrdiff_t offset) { return n[offset] + f.x() * (n[offset + 1] - n[offset]); };
  const auto slope = [&](std::ptrdiff_t offset) { return static_cast<double>(n[offset + 1] - n[offset]); };
  const double e00 = edge(0), e10 = edge(row), e01 = edge(layer), e11 = edge(layer + row);
  const double low = e00 + f.y() * (e10 - e00);
  const double high = e01 + f.y() * (e11 - e01);
  const double s0 = slope(0) + f.y() * (slope(row) - slope(0));
  const double s1 = slope(layer) + f.y() * (slope(layer + row) - slope(layer));
  SignedDistance result{
      low + f.z() * (high - low),
      Eigen::Vector3d(s0 + f.z() * (s1 - s0), (1.0 - f.z()) * (e10 - e00) + f.z() * (e11 - e01), high - low) /
          spacing_};
  const Eigen::Vector3d beyond = p - inside;
  const double outside = beyond.norm();
  if (outside > 0.0) {
    for (int i = 0; i < 3; ++i) result.gradient[i] = beyond[i] == 0.0 ? result.gradient[i] : 0.0;
    result.value += outside;
    result.gradient += beyond / outside;
  }
  return result;
}

}  // namespace opponens::grasp
