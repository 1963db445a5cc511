// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/palm_patch.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

namespace opponens::robot {

namespace {

using Eigen::Vector3d;

constexpr double kFinest = 0.002;    // m, least step of the grid
constexpr int kAcross = 48;          // steps at most along the longer side
constexpr double kFacing = 0.95;     // cosine of a patch's normals with the side
constexpr double kFlat = 0.0015;     // m, heights of a patch may differ by this
constexpr double kOneLevel = 0.005;  // m, points of one palm lie at most so far from its middle height
constexpr double kWide = 0.005;      // m, height of a triangle that is one
constexpr double kApart = 0.01;      // m, points nearer than this to each other are one

/// What rays against the side meet, on a grid.
struct Relief {
  double step = 0.0;
  int columns = 0;
  int rows = 0;
  std::vector<std::optional<SurfaceHit>> cells;

  const std::optional<SurfaceHit>* at(int row, int column) const {
    if (row < 0 || column < 0 || row >= rows || column >= columns) return nullptr;
    return &cells[static_cast<std::size_t>(row * columns + column)];
  }
};

Relief relief_of(const HandBody& body, const Vector3d& outward) {
  const Vector3d right = outward.unitOrthogonal();
  const Vector3d up = outward.cross(right);
  const Eigen::Vector2d u = extent_along(body.vertices, right);
  const Eigen::Vector2d v = extent_along(body.vertices, up);
  Relief relief;
  relief.step = std::max(kFinest, std::max(u[1] - u[0], v[1] - v[0]) / kAcross);
  relief.columns = 1 + static_cast<int>((u[1] - u[0]) / relief.step);
  relief.rows = 1 + static_cast<int>((v[1] - v[0]) / relief.step);
  for (int row = 0; row < relief.rows; ++row) {
    for (int column = 0; column < relief.columns; ++column) {
      const Vector3d p = (u[0] + (column + 0.5) * relief.step) * right + (v[0] + (row + 0.5) * relief.step) * up;
      relief.cells.push_back(outermost(body, p, outward));
    }
  }
  return relief;
}

/// Whether the surface is flat and faces the side everywhere within so many steps.
bool flat_around(const Relief& relief, int row, int column, int steps, const Vector3d& outward) {
  const auto& middle = *relief.at(row, column);
  if (!middle) return false;
  for (int i = row - steps; i <= row + steps; ++i) {
    for (int j = column - steps; j <= column + steps; ++j) {
      const auto* cell = relief.at(i, j);
      if (cell == nullptr || !*cell || (*cell)->normal.dot(outward) < kFacing) return false;
      if (std::abs((*cell)->distance - middle->distance) > kFlat) return false;
    }
  }
  return true;
}

/// The cells that keep `margin` (m) from the rim of a flat patch, those off the middle height left out.
std::vector<SurfaceHit> inner_cells(const Relief& relief, double margin, const Vector3d& outward) {
  const int steps = std::max(1, static_cast<int>(std::ceil(margin / relief.step)));
  std::vector<SurfaceHit> inner;
  for (int row = 0; row < relief.rows; ++row) {
    for (int column = 0; column < relief.columns; ++column) {
      if (flat_around(relief, row, column, steps, outward)) inner.push_back(**relief.at(row, column));
    }
  }
  if (inner.empty()) return inner;
  std::vector<double> heights;
  for (const SurfaceHit& hit : inner) heights.push_back(hit.distance);
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  std::erase_if(inner, [&](const SurfaceHit& hit) { return std::abs(hit.distance - *middle) > kOneLevel; });
  return inner;
}

/// The two cells furthest from each other; one where none is apart from the other.
std::vector<SurfaceHit> furthest_pair(const std::vector<SurfaceHit>& cells) {
  std::vector<SurfaceHit> pair = {cells.front()};
  double widest = kApart;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (std::size_t j = i + 1; j < cells.size(); ++j) {
      const double distance = (cells[i].p - cells[j].p).norm();
      if (distance <= widest + 1e-9) continue;  // rounding must not decide between equals
      widest = distance;
      pair = {cells[i], cells[j]};
    }
  }
  return pair;
}

/// The furthest pair and the cell that spans the largest triangle with it, or on a narrow patch the one furthest from
/// both.
std::vector<SurfaceHit> spread(const std::vector<SurfaceHit>& cells) {
  if (cells.empty()) return {};
  std::vector<SurfaceHit> chosen = furthest_pair(cells);
  if (chosen.size() < 2) return chosen;
  const Vector3d a = chosen[0].p;
  const Vector3d b = chosen[1].p;
  const SurfaceHit* third = nullptr;
  double best = 0.0;
  for (const SurfaceHit& cell : cells) {
    const double nearest = std::min((cell.p - a).norm(), (cell.p - b).norm());
    const double aside = (cell.p - a).cross(cell.p - b).norm() / (a - b).norm();
    const double merit = aside >= kWide ? 1.0 + aside : nearest;  // m; any triangle before any line
    if (nearest < kApart || merit <= best + 1e-9) continue;
    best = merit;
    third = &cell;
  }
  if (third != nullptr) chosen.push_back(*third);
  return chosen;
}

}  // namespace

std::vector<SurfaceHit> patch_points(const HandBody& body, const Vector3d& outward) {
  if (body.geometry.empty()) return {};
  const Relief relief = relief_of(body, outward);
  std::vector<SurfaceHit> most;
  for (const double margin : {0.010, 0.006, 0.003, 0.0}) {
    std::vector<SurfaceHit> points = spread(inner_cells(relief, margin, outward));
    if (points.size() > most.size()) most = std::move(points);
    if (most.size() == 3) break;
  }
  return most;
}

}  // namespace opponens::robot
