// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/contact_depth.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>

#include "core/require.hpp"
#include "robot/mesh.hpp"

namespace opponens::motion {

ContactDepth::ContactDepth(const robot::RobotModel& robot, const robot::Scene& scene, const std::string& object,
                           const std::vector<std::string>& links, double spacing)
    : robot_(&robot) {
  require(spacing > 0.0, "ContactDepth: spacing must be positive");
  const robot::SceneBody& body = scene.body(object);
  for (const robot::Geometry& geometry : body.geometry) {
    const auto* shared = std::get_if<std::shared_ptr<const robot::TriangleMesh>>(&geometry.shape);
    auto mesh = shared ? *shared : std::make_shared<const robot::TriangleMesh>(robot::triangulate(geometry.shape, 64));
    const Eigen::Isometry3d X_GR = (body.X_WB * geometry.X_BG).inverse() * scene.X_WR;
    solids_.push_back({robot::MeshDistance(std::move(mesh)), X_GR});
  }
  for (const std::string& name : links) {
    const int link = robot.link_index(name);
    std::vector<Eigen::Vector3d> points;
    for (const robot::Geometry& geometry : robot.links()[static_cast<std::size_t>(link)].collision) {
      // Points of a link's geometry come in the body frame.
      const auto samples = robot::surface_samples(geometry, spacing);
      points.insert(points.end(), samples.begin(), samples.end());
    }
    if (points.empty()) continue;
    LinkSurface surface{link, Eigen::Matrix3Xd(3, static_cast<Eigen::Index>(points.size())), {}, 0.0};
    for (std::size_t i = 0; i < points.size(); ++i) surface.points.col(static_cast<Eigen::Index>(i)) = points[i];
    surface.center = 0.5 * (surface.points.rowwise().minCoeff() + surface.points.rowwise().maxCoeff());
    surface.radius = (surface.points.colwise() - surface.center).colwise().norm().maxCoeff();
    links_.push_back(std::move(surface));
  }
}

double ContactDepth::operator()(const Eigen::VectorXd& q) const {
  const std::vector<Eigen::Isometry3d> X_RL = robot_->link_poses(q);
  double depth = 0.0;
  for (const LinkSurface& link : links_) {
    for (const Solid& solid : solids_) {
      const Eigen::Isometry3d X_GL = solid.X_GR * X_RL[static_cast<std::size_t>(link.link)];
      if (solid.distance.signed_distance(X_GL * link.center) > link.radius) continue;
      for (Eigen::Index i = 0; i < link.points.cols(); ++i) {
        depth = std::max(depth, -solid.distance.signed_distance(X_GL * link.points.col(i)));
      }
    }
  }
  return depth;
}

}  // namespace opponens::motion
