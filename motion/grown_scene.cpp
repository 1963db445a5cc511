// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "motion/grown_scene.hpp"

#include <cmath>
#include <memory>

#include "core/require.hpp"

namespace opponens::motion {
namespace {

robot::Shape grown(const robot::Box& box, double margin) {
  return robot::Box{box.size + Eigen::Vector3d::Constant(2.0 * margin)};
}

robot::Shape grown(const robot::Sphere& sphere, double margin) { return robot::Sphere{sphere.radius + margin}; }

robot::Shape grown(const robot::Cylinder& cylinder, double margin) {
  return robot::Cylinder{cylinder.radius + margin, cylinder.length + 2.0 * margin};
}

robot::Shape grown(const std::shared_ptr<const robot::TriangleMesh>& mesh, double margin) {
  auto larger = std::make_shared<robot::TriangleMesh>(*mesh);
  Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, mesh->vertices.cols());
  for (const auto& triangle : mesh->triangles.colwise()) {
    const Eigen::Vector3d a = mesh->vertices.col(triangle[0]);
    const Eigen::Vector3d area =
        (mesh->vertices.col(triangle[1]) - a).cross(Eigen::Vector3d(mesh->vertices.col(triangle[2]) - a));
    for (int i = 0; i < 3; ++i) normals.col(triangle[i]) += area;
  }
  for (Eigen::Index i = 0; i < normals.cols(); ++i) {
    if (normals.col(i).norm() > 0.0) larger->vertices.col(i) += margin * normals.col(i).normalized();
  }
  return std::shared_ptr<const robot::TriangleMesh>(std::move(larger));
}

}  // namespace

robot::Scene grown_scene(const robot::Scene& scene, double margin, const std::set<std::string>& except) {
  require(std::isfinite(margin) && margin >= 0.0, "grown_scene: margin must be finite and not negative");
  robot::Scene result = scene;
  if (margin == 0.0) return result;
  for (robot::SceneBody& body : result.bodies) {
    if (except.contains(body.name)) continue;
    for (robot::Geometry& geometry : body.geometry) {
      geometry.shape = std::visit([margin](const auto& shape) { return grown(shape, margin); }, geometry.shape);
    }
  }
  return result;
}

}  // namespace opponens::motion
