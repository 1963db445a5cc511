// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/grown_polytope.hpp"

#include <algorithm>

#include <Eigen/Geometry>

namespace opponens::robot {

namespace {

using Eigen::Vector3d;

constexpr double kFlat = 1e-12;  ///< of a face's twice its area to the square of its longest edge

}  // namespace

GrownPolytope::GrownPolytope(const std::array<Vector3d, 4>& corners) {
  std::copy(corners.begin(), corners.end(), corners_.begin());
  corner_count_ = 4;
  const bool right_handed = (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(corners[3] - corners[0]) > 0.0;
  const int b = right_handed ? 2 : 1;
  const int c = right_handed ? 1 : 2;
  sound_ = add_face(0, b, c) && add_face(0, 3, b) && add_face(0, c, 3) && add_face(c, b, 3);
}

const GrownPolytope::Face& GrownPolytope::nearest() const {
  return *std::min_element(faces_.begin(), faces_.begin() + face_count_,
                           [](const Face& a, const Face& b) { return a.distance < b.distance; });
}

bool GrownPolytope::add_face(int a, int b, int c) {
  if (face_count_ == kFaces) return false;
  const Vector3d& p = corners_[static_cast<std::size_t>(a)];
  const Vector3d first = corners_[static_cast<std::size_t>(b)] - p;
  const Vector3d second = corners_[static_cast<std::size_t>(c)] - p;
  const Vector3d n = first.cross(second);
  const double area = n.norm();
  if (!(area > kFlat * std::max(first.squaredNorm(), second.squaredNorm()))) return false;
  Face& face = faces_[static_cast<std::size_t>(face_count_++)];
  face.corners = {a, b, c};
  face.normal = n / area;
  face.distance = face.normal.dot(p);
  return true;
}

bool GrownPolytope::add(const Vector3d& corner) {
  if (!sound_ || corner_count_ == kCorners) return false;
  // Edges of the faces that the corner sees, in their direction; those seen from both sides drop out.
  std::array<std::array<int, 2>, 3 * kFaces> edges;  // NOLINT: filled before it is read
  int edge_count = 0;
  const auto toggle = [&](int from, int to) {
    const auto end = edges.begin() + edge_count;
    const auto other = std::find(edges.begin(), end, std::array<int, 2>{to, from});
    if (other == end) {
      edges[static_cast<std::size_t>(edge_count++)] = {from, to};
    } else {
      *other = edges[static_cast<std::size_t>(--edge_count)];
    }
  };
  const auto seen = std::partition(faces_.begin(), faces_.begin() + face_count_,
                                   [&](const Face& face) { return face.normal.dot(corner) <= face.distance; });
  for (auto face = seen; face != faces_.begin() + face_count_; ++face) {
    for (std::size_t k = 0; k < 3; ++k) toggle(face->corners[k], face->corners[(k + 1) % 3]);
  }
  face_count_ = static_cast<int>(seen - faces_.begin());
  if (edge_count < 3) return false;
  const int apex = corner_count_++;
  corners_[static_cast<std::size_t>(apex)] = corner;
  for (int i = 0; i < edge_count; ++i) {
    const auto& [from, to] = edges[static_cast<std::size_t>(i)];
    if (!add_face(from, to, apex)) return false;
  }
  return true;
}

}  // namespace opponens::robot
