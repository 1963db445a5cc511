// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/tip_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/require.hpp"

namespace opponens::grasp {
namespace {

/// The four uniform cubic B-spline weights at fraction t, and their first and second derivatives.
struct SplineWeights {
  explicit SplineWeights(double t) {
    const double s = 1.0 - t;
    value = {s * s * s / 6.0, (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0, (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0,
             t * t * t / 6.0};
    slope = {-0.5 * s * s, -2.0 * t + 1.5 * t * t, 2.0 * s - 1.5 * s * s, 0.5 * t * t};
    bend = {s, 3.0 * t - 2.0, 3.0 * s - 2.0, t};
  }
  std::array<double, 4> value;
  std::array<double, 4> slope;
  std::array<double, 4> bend;
};

/// Value, first and second derivative in one variable.
struct Jet {
  double value = 0.0, slope = 0.0, bend = 0.0;
};

/// The sample at the lattice's nearest point becomes the one at `beyond` from it.
void continue_beyond(const Eigen::Vector3d& beyond, FieldSample& s) {
  const double distance = beyond.norm();
  if (distance == 0.0) return;
  const Eigen::Vector3d out = beyond / distance;
  s.value += distance;
  for (int i = 0; i < 3; ++i) {
    if (beyond[i] == 0.0) continue;
    s.gradient[i] = out[i];
    s.hessian.row(i).setZero();
    s.hessian.col(i).setZero();
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (beyond[i] != 0.0 && beyond[j] != 0.0) s.hessian(i, j) = ((i == j ? 1.0 : 0.0) - out[i] * out[j]) / distance;
    }
  }
}

}  // namespace

TipField::TipField(const DistanceGrid& grid, const Eigen::Vector3d& lower, const Eigen::Vector3d& upper, double spacing,
                   std::size_t max_nodes)
    : spacing_(spacing), lower_(lower), upper_(upper) {
  require(spacing > 0.0 && (upper - lower).minCoeff() > 0.0, "TipField: spacing and box must be positive");
  const auto nodes = [&] { return ((upper_ - lower_) / spacing_).array().ceil() + 4.0; };
  while (nodes().prod() > static_cast<double>(max_nodes)) spacing_ *= 1.1;
  count_ = nodes().cast<int>();
  first_ = lower_.array() - spacing_;
  nodes_.reserve(static_cast<std::size_t>(count_.cast<std::int64_t>().prod()));
  for (int z = 0; z < count_.z(); ++z) {
    for (int y = 0; y < count_.y(); ++y) {
      for (int x = 0; x < count_.x(); ++x) {
        nodes_.push_back(static_cast<float>(grid.value(first_ + spacing_ * Eigen::Vector3d(x, y, z))));
      }
    }
  }
}

FieldSample TipField::query(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d inside = p.cwiseMax(lower_).cwiseMin(upper_);
  const Eigen::Vector3d scaled = (inside - first_) / spacing_;
  Eigen::Vector3i corner;
  for (int i = 0; i < 3; ++i) corner[i] = std::clamp(static_cast<int>(scaled[i]), 1, count_[i] - 3);
  const Eigen::Vector3d t = scaled - corner.cast<double>();
  const SplineWeights wx(t.x()), wy(t.y()), wz(t.z());
  const std::size_t row = static_cast<std::size_t>(count_.x());
  const std::size_t layer = row * static_cast<std::size_t>(count_.y());
  const float* const first = nodes_.data() + static_cast<std::size_t>(corner.z() - 1) * layer +
                             static_cast<std::size_t>(corner.y() - 1) * row + static_cast<std::size_t>(corner.x() - 1);
  FieldSample s{0.0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()};
  for (std::size_t k = 0; k < 4; ++k) {
    Jet x, xy, xyy;  // sums over x, weighted along y by value, slope and bend
    for (std::size_t j = 0; j < 4; ++j) {
      const float* const n = first + k * layer + j * row;
      Jet line;
      for (std::size_t i = 0; i < 4; ++i) {
        line.value += wx.value[i] * n[i];
        line.slope += wx.slope[i] * n[i];
        line.bend += wx.bend[i] * n[i];
      }
      x.value += wy.value[j] * line.value;
      x.slope += wy.value[j] * line.slope;
      x.bend += wy.value[j] * line.bend;
      xy.value += wy.slope[j] * line.value;
      xy.slope += wy.slope[j] * line.slope;
      xyy.value += wy.bend[j] * line.value;
    }
    s.value += wz.value[k] * x.value;
    s.gradient += Eigen::Vector3d(wz.value[k] * x.slope, wz.value[k] * xy.value, wz.slope[k] * x.value);
    s.hessian(0, 0) += wz.value[k] * x.bend;
    s.hessian(1, 1) += wz.value[k] * xyy.value;
    s.hessian(2, 2) += wz.bend[k] * x.value;
    s.hessian(0, 1) += wz.value[k] * xy.slope;
    s.hessian(0, 2) += wz.slope[k] * x.slope;
    s.hessian(1, 2) += wz.slope[k] * xy.value;
  }
  s.hessian(1, 0) = s.hessian(0, 1);
  s.hessian(2, 0) = s.hessian(0, 2);
  s.hessian(2, 1) = s.hessian(1, 2);
  s.gradient /= spacing_;
  s.hessian /= spacing_ * spacing_;
  continue_beyond(p - inside, s);
  return s;
}

}  // namespace opponens::grasp
