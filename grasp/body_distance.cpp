// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "grasp/body_distance.hpp"

#include <cmath>
#include <limits>
#include <memory>

namespace opponens::grasp {
namespace {

using Eigen::Vector3d;

SignedDistance distance_to(const robot::Sphere& sphere, const Vector3d& p) {
  const double length = p.norm();
  return {length - sphere.radius, length > 0.0 ? Vector3d(p / length) : Vector3d::UnitX()};
}

SignedDistance distance_to(const robot::Box& box, const Vector3d& p) {
  const Vector3d excess = p.cwiseAbs() - 0.5 * box.size;
  const Vector3d sign = p.unaryExpr([](double x) { return x < 0.0 ? -1.0 : 1.0; });
  if ((excess.array() <= 0.0).all()) {
    Eigen::Index axis = 0;
    const double depth = excess.maxCoeff(&axis);
    return {depth, sign[axis] * Vector3d::Unit(axis)};
  }
  const Vector3d outside = excess.cwiseMax(0.0);
  const double distance = outside.norm();
  return {distance, outside.cwiseProduct(sign) / distance};
}

SignedDistance distance_to(const robot::Cylinder& cylinder, const Vector3d& p) {
  const double r = p.head<2>().norm();
  const double side = r - cylinder.radius;
  const double cap = std::abs(p.z()) - 0.5 * cylinder.length;
  const Vector3d radial = r > 0.0 ? Vector3d(p.x() / r, p.y() / r, 0.0) : Vector3d::UnitX();
  const Vector3d axial(0.0, 0.0, p.z() < 0.0 ? -1.0 : 1.0);
  if (side <= 0.0 && cap <= 0.0) return side > cap ? SignedDistance{side, radial} : SignedDistance{cap, axial};
  const double distance = std::hypot(std::max(side, 0.0), std::max(cap, 0.0));
  return {distance, (std::max(side, 0.0) * radial + std::max(cap, 0.0) * axial) / distance};
}

SignedDistance distance_to(const std::shared_ptr<const robot::MeshDistance>& mesh, const Vector3d& p) {
  const robot::MeshDistance::Query query = mesh->query(p);
  return {query.distance, query.gradient};
}

/// Centre and radius of a sphere around the shape, in its own frame.
std::pair<Vector3d, double> bound(const robot::Shape& shape) {
  if (const auto* sphere = std::get_if<robot::Sphere>(&shape)) return {Vector3d::Zero(), sphere->radius};
  if (const auto* box = std::get_if<robot::Box>(&shape)) return {Vector3d::Zero(), 0.5 * box->size.norm()};
  if (const auto* cylinder = std::get_if<robot::Cylinder>(&shape)) {
    return {Vector3d::Zero(), std::hypot(cylinder->radius, 0.5 * cylinder->length)};
  }
  const Eigen::Matrix3Xd& vertices = std::get<std::shared_ptr<const robot::TriangleMesh>>(shape)->vertices;
  const Vector3d center = 0.5 * (vertices.rowwise().minCoeff() + vertices.rowwise().maxCoeff());
  return {center, (vertices.colwise() - center).colwise().norm().maxCoeff()};
}

}  // namespace

BodyDistance::BodyDistance(const std::vector<robot::Geometry>& geometry) {
  for (const robot::Geometry& g : geometry) {
    const auto [center, radius] = bound(g.shape);
    Part part{{}, g.X_BG.inverse(), g.X_BG * center, radius};
    if (const auto* mesh = std::get_if<std::shared_ptr<const robot::TriangleMesh>>(&g.shape)) {
      part.shape = std::make_shared<const robot::MeshDistance>(*mesh);
    } else if (const auto* box = std::get_if<robot::Box>(&g.shape)) {
      part.shape = *box;
    } else if (const auto* sphere = std::get_if<robot::Sphere>(&g.shape)) {
      part.shape = *sphere;
    } else {
      part.shape = std::get<robot::Cylinder>(g.shape);
    }
    parts_.push_back(std::move(part));
  }
}

SignedDistance BodyDistance::query(const Vector3d& p_B, double horizon) const {
  SignedDistance nearest{std::numeric_limits<double>::infinity(), Vector3d::UnitZ()};
  for (const Part& part : parts_) {
    const Vector3d away = p_B - part.center_B;
    const double bound = away.norm() - part.radius;
    if (bound >= nearest.value) continue;
    if (bound > horizon) {
      nearest = {bound, away.normalized()};
      continue;
    }
    const Vector3d p_G = part.X_GB * p_B;
    const SignedDistance d = std::visit([&](const auto& shape) { return distance_to(shape, p_G); }, part.shape);
    if (d.value < nearest.value) nearest = {d.value, part.X_GB.linear().transpose() * d.gradient};
  }
  return nearest;
}

}  // namespace opponens::grasp
