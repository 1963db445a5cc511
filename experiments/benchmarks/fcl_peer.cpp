// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "fcl_peer.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>

namespace opponens::benchmarks {
namespace {

using FclGeometry = std::shared_ptr<fcl::CollisionGeometryd>;

FclGeometry fcl_mesh(const robot::TriangleMesh& mesh) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Vector3d> vertices;
  std::vector<fcl::Triangle> triangles;
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) vertices.emplace_back(mesh.vertices.col(i));
  for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
    const auto corner = [&](int k) { return static_cast<std::size_t>(mesh.triangles(k, i)); };
    triangles.emplace_back(corner(0), corner(1), corner(2));
  }
  model->beginModel();
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

class Geometries {
 public:
  FclGeometry get(const robot::Shape& shape) {
    if (const auto* box = std::get_if<robot::Box>(&shape)) return std::make_shared<fcl::Boxd>(box->size);
    if (const auto* sphere = std::get_if<robot::Sphere>(&shape)) return std::make_shared<fcl::Sphered>(sphere->radius);
    if (const auto* cylinder = std::get_if<robot::Cylinder>(&shape)) {
      return std::make_shared<fcl::Cylinderd>(cylinder->radius, cylinder->length);
    }
    const auto& mesh = std::get<std::shared_ptr<const robot::TriangleMesh>>(shape);
    FclGeometry& made = meshes_[mesh.get()];
    if (made == nullptr) made = fcl_mesh(*mesh);
    return made;
  }

 private:
  std::map<const robot::TriangleMesh*, FclGeometry> meshes_;
};

struct Body {
  int link;  ///< -1: scene
  Eigen::Isometry3d X_BG;
};

}  // namespace

struct FclPeer::World {
  robot::RobotModel robot;
  Eigen::Isometry3d X_WR;
  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> links;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> scene;
  fcl::DynamicAABBTreeCollisionManagerd robot_tree;
  fcl::DynamicAABBTreeCollisionManagerd scene_tree;
  std::vector<Eigen::Isometry3d> X_RL;

  explicit World(const robot::RobotModel& model) : robot(model) {}
};

namespace {

struct Query {
  const robot::RobotModel* robot;
  bool collides;
};

bool visit(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
  auto& query = *static_cast<Query*>(data);
  const int i = static_cast<const Body*>(a->getUserData())->link;
  const int j = static_cast<const Body*>(b->getUserData())->link;
  if (i >= 0 && j >= 0) {
    const std::pair<int, int> links = std::minmax(i, j);
    if (i == j || query.robot->description().allowed_collisions.contains(links)) return false;
  }
  fcl::CollisionRequestd request(1, false);
  fcl::CollisionResultd result;
  fcl::collide(a, b, request, result);
  query.collides = result.isCollision();
  return query.collides;
}

}  // namespace

FclPeer::FclPeer(const robot::RobotModel& robot, const robot::Scene& scene) : world_(std::make_unique<World>(robot)) {
  World& w = *world_;
  w.X_WR = scene.X_WR;
  Geometries geometries;
  for (std::size_t l = 0; l < robot.links().size(); ++l) {
    for (const robot::Geometry& g : robot.links()[l].collision) {
      w.bodies.push_back(std::make_unique<Body>(Body{static_cast<int>(l), g.X_BG}));
      w.links.push_back(std::make_unique<fcl::CollisionObjectd>(geometries.get(g.shape), Eigen::Isometry3d::Identity()));
      w.links.back()->setUserData(w.bodies.back().get());
      w.robot_tree.registerObject(w.links.back().get());
    }
  }
  for (const robot::SceneBody& body : scene.bodies) {
    for (const robot::Geometry& g : body.geometry) {
      w.bodies.push_back(std::make_unique<Body>(Body{-1, body.X_WB * g.X_BG}));
      w.scene.push_back(std::make_unique<fcl::CollisionObjectd>(geometries.get(g.shape), body.X_WB * g.X_BG));
      w.scene.back()->setUserData(w.bodies.back().get());
      w.scene_tree.registerObject(w.scene.back().get());
    }
  }
  w.robot_tree.setup();
  w.scene_tree.setup();
}
FclPeer::~FclPeer() = default;

bool FclPeer::free(const Eigen::Ref<const Eigen::VectorXd>& q) {
  World& w = *world_;
  w.robot.link_poses(q, w.X_RL);
  for (const auto& object : w.links) {
    const Body& body = *static_cast<const Body*>(object->getUserData());
    object->setTransform(w.X_WR * w.X_RL[static_cast<std::size_t>(body.link)] * body.X_BG);
    object->computeAABB();
  }
  w.robot_tree.update();
  Query query{&w.robot, false};
  w.robot_tree.collide(&w.scene_tree, &query, visit);
  if (!query.collides) w.robot_tree.collide(&query, visit);
  return !query.collides;
}

}  // namespace opponens::benchmarks
