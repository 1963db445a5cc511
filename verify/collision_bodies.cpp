// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "verify/collision_bodies.hpp"

#include <algorithm>
#include <map>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "robot/mesh.hpp"
#include "verify/solid.hpp"

namespace opponens::verify {
namespace {

using CollisionGeometry = std::shared_ptr<fcl::CollisionGeometryd>;

CollisionGeometry mesh_of(const robot::TriangleMesh& mesh) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel(static_cast<int>(mesh.triangles.cols()), static_cast<int>(mesh.vertices.cols()));
  for (const auto& t : mesh.triangles.colwise()) {
    model->addTriangle(mesh.vertices.col(t[0]), mesh.vertices.col(t[1]), mesh.vertices.col(t[2]));
  }
  model->endModel();
  return model;
}

CollisionGeometry geometry_of(const robot::Shape& shape) {
  if (const auto* box = std::get_if<robot::Box>(&shape)) return std::make_shared<fcl::Boxd>(box->size);
  if (const auto* sphere = std::get_if<robot::Sphere>(&shape)) return std::make_shared<fcl::Sphered>(sphere->radius);
  if (const auto* cylinder = std::get_if<robot::Cylinder>(&shape)) {
    return std::make_shared<fcl::Cylinderd>(cylinder->radius, cylinder->length);
  }
  return mesh_of(*std::get<std::shared_ptr<const robot::TriangleMesh>>(shape));
}

bool is_mesh(const robot::Shape& shape) {
  return std::holds_alternative<std::shared_ptr<const robot::TriangleMesh>>(shape);
}

}  // namespace

struct CollisionBodies::Part {
  std::string name;
  int link;                  ///< -1: a scene body
  robot::Geometry geometry;  ///< X_BG: in the link, or in the scene body
  std::shared_ptr<const Solid> solid;
  fcl::CollisionObjectd object;   ///< primitives as such
  fcl::CollisionObjectd surface;  ///< triangles
  Eigen::Matrix3Xd samples;       ///< [3 x S] m, surface points in G; links only, made when first asked for

  Eigen::Isometry3d X_WG() const { return object.getTransform(); }

  /// A point inside the shape and on none of its surfaces: enough to find a shape that lies wholly within another.
  bool reaches_into(const Part& other) const {
    const Eigen::Isometry3d X = other.X_WG().inverse() * X_WG();
    if (!is_mesh(geometry.shape)) return other.solid->inside(X.translation());
    for (const auto& point : solid->component_points().colwise()) {
      if (other.solid->inside(X * point)) return true;
    }
    return false;
  }
};

struct CollisionBodies::Data {
  const robot::RobotModel& robot;
  Eigen::Isometry3d X_WR;
  std::vector<Part> parts;                 ///< links first
  std::vector<std::pair<int, int>> pairs;  ///< indices into parts that must not touch

  static bool collide(const Part& a, const Part& b) {
    fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    fcl::collide(&a.object, &b.object, request, result);
    // FCL's primitives are solid against everything; a mesh is a surface only.
    return result.isCollision() || (is_mesh(b.geometry.shape) && a.reaches_into(b)) ||
           (is_mesh(a.geometry.shape) && b.reaches_into(a));
  }

  static double depth(Part& link, const Part& body) {
    if (!link.object.getAABB().overlap(body.object.getAABB()) || !collide(link, body)) return 0.0;
    if (link.samples.cols() == 0) {
      const auto points = robot::surface_samples({link.geometry.shape, Eigen::Isometry3d::Identity()}, 0.002);
      link.samples.resize(3, static_cast<Eigen::Index>(points.size()));
      for (std::size_t i = 0; i < points.size(); ++i) link.samples.col(static_cast<Eigen::Index>(i)) = points[i];
    }
    double depth = 0.0;
    const Eigen::Isometry3d X_BL = body.X_WG().inverse() * link.X_WG();
    for (const auto& point : link.samples.colwise()) depth = std::max(depth, body.solid->depth(X_BL * point));
    const Eigen::Isometry3d X_LB = X_BL.inverse();
    for (const auto& point : body.solid->mesh().vertices.colwise()) {
      depth = std::max(depth, link.solid->depth(X_LB * point));
    }
    return depth;
  }

  void add_pairs() {
    const int count = static_cast<int>(parts.size());
    for (int i = 0; i < count; ++i) {
      for (int j = i + 1; j < count; ++j) {
        const int a = parts[static_cast<std::size_t>(i)].link;
        const int b = parts[static_cast<std::size_t>(j)].link;
        if (a < 0 || a == b) continue;
        if (b >= 0 && robot.description().allowed_collisions.count(std::minmax(a, b)) == 1) continue;
        pairs.emplace_back(i, j);
      }
    }
  }
};

CollisionBodies::CollisionBodies(const robot::RobotModel& robot, const robot::Scene& scene)
    : data_(std::make_unique<Data>(Data{robot, scene.X_WR, {}, {}})) {
  struct Made {
    CollisionGeometry geometry;
    CollisionGeometry surface;
    std::shared_ptr<const Solid> solid;
  };
  std::map<const robot::TriangleMesh*, Made> meshes;  // the links of a hand share theirs
  const auto add = [&](const std::string& name, int link, const robot::Geometry& geometry, const Eigen::Isometry3d& X) {
    const auto* mesh = std::get_if<std::shared_ptr<const robot::TriangleMesh>>(&geometry.shape);
    Made made = mesh != nullptr ? meshes[mesh->get()] : Made{};
    if (!made.geometry) {
      made.geometry = geometry_of(geometry.shape);
      made.solid = std::make_shared<const Solid>(geometry.shape);
      made.surface = mesh != nullptr ? made.geometry : mesh_of(made.solid->mesh());
      if (mesh != nullptr) meshes[mesh->get()] = made;
    }
    data_->parts.push_back({name,
                            link,
                            geometry,
                            made.solid,
                            fcl::CollisionObjectd(made.geometry, X),
                            fcl::CollisionObjectd(made.surface, X),
                            {}});
  };
  for (std::size_t l = 0; l < robot.links().size(); ++l) {
    for (const robot::Geometry& g : robot.links()[l].collision) {
      add(robot.links()[l].name, static_cast<int>(l), g, Eigen::Isometry3d::Identity());
    }
  }
  for (const robot::SceneBody& body : scene.bodies) {
    for (const robot::Geometry& g : body.geometry) add(body.name, -1, g, body.X_WB * g.X_BG);
  }
  data_->add_pairs();
}

CollisionBodies::~CollisionBodies() = default;

void CollisionBodies::set(const Eigen::VectorXd& q) {
  const std::vector<Eigen::Isometry3d> X_RL = data_->robot.link_poses(q);
  for (Part& part : data_->parts) {
    if (part.link >= 0) {
      const Eigen::Isometry3d X_WG = data_->X_WR * X_RL[static_cast<std::size_t>(part.link)] * part.geometry.X_BG;
      part.object.setTransform(X_WG);
      part.surface.setTransform(X_WG);
    }
    part.object.computeAABB();
    part.surface.computeAABB();
  }
}

std::set<CollisionBodies::Pair> CollisionBodies::colliding() const {
  std::set<Pair> found;
  for (const auto& [i, j] : data_->pairs) {
    const Part& a = data_->parts[static_cast<std::size_t>(i)];
    const Part& b = data_->parts[static_cast<std::size_t>(j)];
    if (!a.object.getAABB().overlap(b.object.getAABB())) continue;
    if (found.count({a.name, b.name}) == 0 && Data::collide(a, b)) found.emplace(a.name, b.name);
  }
  return found;
}

CollisionBodies::Clearance CollisionBodies::clearance(const std::set<Pair>& except, double horizon) const {
  Clearance least{horizon, {}};
  for (const auto& [i, j] : data_->pairs) {
    const Part& a = data_->parts[static_cast<std::size_t>(i)];
    const Part& b = data_->parts[static_cast<std::size_t>(j)];
    if (except.count({a.name, b.name}) == 1 || a.object.getAABB().distance(b.object.getAABB()) >= least.distance)
      continue;
    fcl::DistanceRequestd request;
    fcl::DistanceResultd result(least.distance);  // only nearer pairs of triangles are descended to
    // Between triangles: FCL's distance between primitives (GJK) is off by millimetres for some poses of cylinders.
    fcl::distance(&a.surface, &b.surface, request, result);
    const double distance = std::max(0.0, result.min_distance);
    if (distance < least.distance) least = {distance, {a.name, b.name}};
  }
  return least;
}

double CollisionBodies::penetration(const std::string& link, const std::string& body) const {
  double depth = 0.0;
  for (Part& a : data_->parts) {
    if (a.name != link || a.link < 0) continue;
    for (const Part& b : data_->parts) {
      if (b.name == body && b.link < 0) depth = std::max(depth, Data::depth(a, b));
    }
  }
  return depth;
}

}  // namespace opponens::verify
