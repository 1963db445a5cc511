// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "robot/geometry.hpp"
#include "robot/mesh.hpp"

namespace opponens::robot {

/// A closed profile (radius > 0, height) m, counter-clockwise in the (radius, height) plane, turned about z: a torus, a
/// pipe. Closed, seen counter-clockwise from outside.
inline TriangleMesh revolved_ring(const std::vector<std::pair<double, double>>& profile, int segments) {
  const int n = static_cast<int>(profile.size());
  TriangleMesh mesh;
  mesh.source = "ring";
  mesh.vertices.resize(3, n * segments);
  mesh.triangles.resize(3, 2 * n * segments);
  for (int s = 0; s < segments; ++s) {
    const double angle = 2.0 * std::numbers::pi * s / segments;
    for (int i = 0; i < n; ++i) {
      const auto& [radius, height] = profile[static_cast<std::size_t>(i)];
      mesh.vertices.col(s * n + i) << radius * std::cos(angle), radius * std::sin(angle), height;
      const int a = s * n + i;
      const int b = s * n + (i + 1) % n;
      const int c = (s + 1) % segments * n + i;
      const int d = (s + 1) % segments * n + (i + 1) % n;
      mesh.triangles.col(2 * a) << a, c, d;
      mesh.triangles.col(2 * a + 1) << a, d, b;
    }
  }
  return mesh;
}

inline TriangleMesh torus(double radius, double thickness, int segments = 48) {
  std::vector<std::pair<double, double>> circle;
  for (int i = 0; i < segments / 2; ++i) {
    const double angle = 4.0 * std::numbers::pi * i / segments;
    circle.emplace_back(radius + thickness * std::cos(angle), thickness * std::sin(angle));
  }
  return revolved_ring(circle, segments);
}

/// A mug of outer radius 40 mm, 95 mm high, open above, standing on z = 0: wall, bottom and handle are components that
/// overlap.
inline TriangleMesh mug() {
  const auto shared = [](const TriangleMesh& mesh) { return std::make_shared<const TriangleMesh>(mesh); };
  Geometry wall{shared(revolved_ring({{0.036, 0.0}, {0.04, 0.0}, {0.04, 0.095}, {0.036, 0.095}}, 40))};
  Geometry bottom{shared(triangulate(Cylinder{0.038, 0.004}, 40))};
  bottom.X_BG.translation().z() = 0.002;
  Geometry handle{shared(torus(0.026, 0.005, 24))};
  handle.X_BG.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  handle.X_BG.translation() << 0.052, 0, 0.05;
  return merge({wall, bottom, handle});
}

}  // namespace opponens::robot
