// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/finger_body.hpp"

#include "robot/mesh.hpp"
#include "robot/ray_cast.hpp"

namespace opponens::robot {

HandBody hand_body(const RobotModel& robot, const std::vector<int>& links, const std::vector<Eigen::Isometry3d>& X_PL) {
  HandBody body;
  body.links = links;
  for (const int link : links) {
    for (const Geometry& geometry : robot.links()[static_cast<std::size_t>(link)].collision) {
      body.geometry.push_back({geometry.shape, X_PL[static_cast<std::size_t>(link)] * geometry.X_BG});
      body.owner.push_back(link);
    }
  }
  if (!body.geometry.empty()) body.vertices = merge(body.geometry).vertices;
  return body;
}

std::optional<SurfaceHit> outermost(const HandBody& body, const Eigen::Vector3d& p, const Eigen::Vector3d& outward) {
  if (body.geometry.empty()) return std::nullopt;
  constexpr double kClear = 0.01;  // m, a start outside of everything
  const double start = extent_along(body.vertices, outward)[1] - outward.dot(p) + kClear;
  const Eigen::Vector3d origin = p + start * outward;
  std::optional<SurfaceHit> best;
  for (std::size_t i = 0; i < body.geometry.size(); ++i) {
    const std::optional<RayHit> hit = first_hit(body.geometry[i], origin, -outward);
    if (!hit || (best && hit->distance >= best->distance)) continue;
    best = SurfaceHit{body.owner[i], hit->distance, origin - hit->distance * outward, hit->normal};
  }
  return best;
}

Eigen::Vector2d extent_along(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& direction) {
  const Eigen::RowVectorXd along = direction.transpose() * points;
  return {along.minCoeff(), along.maxCoeff()};
}

Eigen::Matrix3Xd slab(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& direction, double from, double to) {
  Eigen::Matrix3Xd inside(3, points.cols());
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double along = direction.dot(points.col(i));
    if (along >= from && along <= to) inside.col(count++) = points.col(i);
  }
  return count == 0 ? points : Eigen::Matrix3Xd(inside.leftCols(count));
}

}  // namespace opponens::robot
