// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/half_planes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace opponens::motion {
namespace {

constexpr double kKept = 1e-9;  ///< of a row of unit size, that it may be passed by

struct Point {
  double x;
  double u;
};

HalfPlane unit(const HalfPlane& plane) {
  const double size = std::hypot(plane.a, plane.b);
  return size > 0.0 ? HalfPlane{plane.a / size, plane.b / size, plane.c / size} : plane;
}

/// The point of largest x on the border of `line` that keeps the first `count` planes and the bounds.
std::optional<Point> largest_on(const HalfPlane& line, const std::vector<HalfPlane>& planes, std::size_t count,
                                double bound) {
  const Point foot{line.a * line.c, line.b * line.c};
  const Point along{line.b, -line.a};
  Interval t{-INFINITY, INFINITY};
  const auto cut = [&](const HalfPlane& plane) {
    const double slope = plane.a * along.x + plane.b * along.u;
    const double room = plane.c - plane.a * foot.x - plane.b * foot.u;
    if (std::abs(slope) < 1e-14) {
      if (room < -kKept) t = {1.0, 0.0};
    } else if (slope > 0.0) {
      t.upper = std::min(t.upper, room / slope);
    } else {
      t.lower = std::max(t.lower, room / slope);
    }
  };
  for (std::size_t i = 0; i < count; ++i) cut(planes[i]);
  for (const HalfPlane& side : {HalfPlane{1, 0, bound}, {-1, 0, bound}, {0, 1, bound}, {0, -1, bound}}) cut(side);
  if (t.lower > t.upper + kKept) return std::nullopt;
  const double best = along.x > 0.0 ? t.upper : t.lower;
  return Point{foot.x + best * along.x, foot.u + best * along.u};
}

}  // namespace

std::optional<double> largest_x(const std::vector<HalfPlane>& planes, double bound) {
  std::vector<HalfPlane> rows;
  rows.reserve(planes.size());
  for (const HalfPlane& plane : planes) rows.push_back(unit(plane));
  Point best{bound, 0.0};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const HalfPlane& row = rows[i];
    if (row.a * best.x + row.b * best.u <= row.c + kKept) continue;
    if (row.a == 0.0 && row.b == 0.0) return std::nullopt;
    const auto moved = largest_on(row, rows, i, bound);
    if (!moved) return std::nullopt;
    best = *moved;
  }
  return best.x;
}

Interval range_of_u(const std::vector<HalfPlane>& planes, double x, double bound) {
  Interval u{-bound, bound};
  for (const HalfPlane& plane : planes) {
    const double room = plane.c - plane.a * x;
    if (plane.b == 0.0 && room < -kKept) return {1.0, 0.0};
    if (plane.b > 0.0) u.upper = std::min(u.upper, room / plane.b);
    if (plane.b < 0.0) u.lower = std::max(u.lower, room / plane.b);
  }
  return u;
}

}  // namespace opponens::motion
