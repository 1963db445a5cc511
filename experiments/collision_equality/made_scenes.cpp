// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "made_scenes.hpp"

#include <memory>
#include <string>

#include "core/rng.hpp"
#include "made_meshes.hpp"
#include "robot/mesh.hpp"

namespace opponens::experiments {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d pose(double x, double y, double z, double turn = 0.0) {
  Isometry3d X = Isometry3d::Identity();
  X.translation() << x, y, z;
  X.rotate(Eigen::AngleAxisd(turn, Vector3d(1, 2, 3).normalized()));
  return X;
}

robot::Shape shared_mesh(robot::TriangleMesh mesh) {
  return std::make_shared<const robot::TriangleMesh>(std::move(mesh));
}

void add(robot::Scene& scene, const robot::Shape& shape, const Isometry3d& X_WB) {
  scene.bodies.push_back({"body_" + std::to_string(scene.bodies.size()), X_WB, {{shape}}});
}

robot::Scene balloon() {
  robot::Scene scene;
  scene.name = "balloon";
  add(scene, shared_mesh(robot::triangulate(robot::Sphere{0.35}, 64)), pose(0.6, 0.1, 0.5));
  return scene;
}

robot::Scene plates() {
  robot::Scene scene;
  scene.name = "plates";
  add(scene, robot::Box{{0.6, 0.001, 0.6}}, pose(0.45, 0.1, 0.4, 0.2));
  robot::TriangleMesh sheet;
  sheet.source = "sheet";
  sheet.vertices.resize(3, 4);
  sheet.vertices << 0, 0.5, 0.5, 0, 0, 0, 0.5, 0.5, 0, 0, 0, 0;
  sheet.triangles.resize(3, 2);
  sheet.triangles << 0, 0, 1, 2, 2, 3;
  add(scene, shared_mesh(sheet), pose(-0.7, -0.2, 0.4, 0.4));
  return scene;
}

robot::Scene mugs() {
  robot::Scene scene;
  scene.name = "mugs";
  add(scene, robot::Box{{0.6, 0.8, 0.04}}, pose(0.55, 0, 0.1));
  const robot::Shape mug = shared_mesh(robot::mug());
  add(scene, mug, pose(0.45, -0.2, 0.121));
  add(scene, mug, pose(0.5, 0.05, 0.121));
  add(scene, mug, pose(0.6, 0.3, 0.4, 1.1));
  add(scene, shared_mesh(robot::torus(0.12, 0.02)), pose(0.35, 0.15, 0.6, 0.7));
  return scene;
}

robot::Scene pebbles() {
  robot::Scene scene;
  scene.name = "pebbles";
  Rng rng = stream(1, "pebbles");
  const robot::Shape ring = shared_mesh(robot::torus(0.008, 0.002, 16));
  for (int i = 0; i < 200; ++i) {
    const double size = rng.uniform(0.004, 0.02);
    const robot::Shape shapes[] = {robot::Box{{size, 0.5 * size, 0.3 * size}}, robot::Sphere{0.5 * size},
                                   robot::Cylinder{0.3 * size, size}, ring};
    add(scene, shapes[i % 4],
        pose(rng.uniform(-0.8, 0.8), rng.uniform(-0.8, 0.8), rng.uniform(0.1, 0.9), rng.uniform(-3, 3)));
  }
  return scene;
}

/// Another scene and the robot in it, elsewhere and turned.
robot::Scene moved(robot::Scene scene, const Isometry3d& X) {
  scene.name = "far_" + scene.name;
  scene.X_WR = X * scene.X_WR;
  for (robot::SceneBody& body : scene.bodies) body.X_WB = X * body.X_WB;
  return scene;
}

}  // namespace

std::vector<robot::Scene> made_scenes() {
  return {balloon(), plates(), mugs(), pebbles(), moved(mugs(), pose(1000, -1000, 500, 1.0))};
}

}  // namespace opponens::experiments
