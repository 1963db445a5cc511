// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
// Meshes of all sorts, and points of their solids, for the tests of what contains them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/rng.hpp"
#include "made_robots.hpp"
#include "robot/load_robot.hpp"
#include "robot/mesh.hpp"

namespace opponens::robot {

/// How often the surface winds around a point (sum of solid angles, Van Oosterom and Strackee 1983): the oracle of what
/// is inside, independent of signed distances. Above 0.5: inside. Components count up, cavities down.
inline double winding_number(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  double sum = 0.0;
  for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
    const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, f)) - p;
    const Eigen::Vector3d b = mesh.vertices.col(mesh.triangles(1, f)) - p;
    const Eigen::Vector3d c = mesh.vertices.col(mesh.triangles(2, f)) - p;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    sum += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4.0 * std::numbers::pi);
}

inline Eigen::Vector3d surface_point(const TriangleMesh& mesh, Rng& rng) {
  const auto f = static_cast<Eigen::Index>(rng.index(static_cast<std::uint64_t>(mesh.triangles.cols())));
  double u = rng.uniform();
  double v = rng.uniform();
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  const Eigen::Vector3d a = mesh.vertices.col(mesh.triangles(0, f));
  return a + u * (mesh.vertices.col(mesh.triangles(1, f)) - a) + v * (mesh.vertices.col(mesh.triangles(2, f)) - a);
}

inline std::vector<Eigen::Vector3d> surface_points(const TriangleMesh& mesh, int count, Rng& rng) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(surface_point(mesh, rng));
  for (Eigen::Index i = 0; i < mesh.vertices.cols() && i < count; ++i) points.emplace_back(mesh.vertices.col(i));
  return points;
}

/// Points of a mesh's box that its surface winds around.
inline std::vector<Eigen::Vector3d> inner_points(const TriangleMesh& mesh, int tries, Rng& rng) {
  const Eigen::Vector3d lower = mesh.vertices.rowwise().minCoeff();
  const Eigen::Vector3d size = mesh.vertices.rowwise().maxCoeff() - lower;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < tries; ++i) {
    const Eigen::Vector3d p = lower + size.cwiseProduct(Eigen::Vector3d(rng.uniform(), rng.uniform(), rng.uniform()));
    if (winding_number(mesh, p) > 0.5) points.push_back(p);
  }
  return points;
}

/// A mesh, and whether it encloses anything.
struct Case {
  std::string name;
  TriangleMesh mesh;
  bool solid = true;
};

inline TriangleMesh flipped(TriangleMesh mesh) {
  mesh.triangles.row(0).swap(mesh.triangles.row(1));
  return mesh;
}

inline TriangleMesh open_box() {
  TriangleMesh mesh = triangulate(Box{{0.1, 0.2, 0.05}});
  mesh.triangles.conservativeResize(3, 10);
  return mesh;
}

inline TriangleMesh sheet(double length, double width) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 4);
  mesh.vertices << 0, length, length, 0, 0, 0, width, width, 0.1, 0.1, 0.1, 0.1;
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 0, 1, 2, 2, 3;
  return mesh;
}

inline TriangleMesh with_cavity() {
  const Geometry outside{mesh_of(triangulate(Box{{0.2, 0.2, 0.2}}))};
  const Geometry hollow{mesh_of(flipped(triangulate(Box{{0.12, 0.1, 0.14}})))};
  return merge({outside, hollow});
}

inline TriangleMesh two_parts() {
  Geometry left{mesh_of(triangulate(Cylinder{0.03, 0.2}, 24))};
  Geometry right{mesh_of(triangulate(Sphere{0.05}, 24))};
  right.X_BG.translation() << 0.02, 0.3, 0.0;
  Geometry overlapping{mesh_of(triangulate(Box{{0.08, 0.02, 0.03}}))};
  return merge({left, right, overlapping});
}

inline std::vector<Case> cases() {
  return {{"box", triangulate(Box{{0.3, 0.1, 0.02}})},
          {"ball", triangulate(Sphere{0.08}, 40)},
          {"rod", triangulate(Cylinder{0.01, 0.5}, 20)},
          {"torus", torus(0.1, 0.03)},
          {"mug", mug()},
          {"cavity", with_cavity()},
          {"parts", two_parts()},
          {"open", open_box(), false},
          {"flat", sheet(0.3, 0.2), false},
          {"sliver", sheet(0.3, 1e-7), false}};
}

/// Meshes of the laboratory's robot and of scanned objects.
inline std::vector<std::shared_ptr<const TriangleMesh>> real_meshes() {
  setenv("OPPONENS_SHARED_DATA", OPPONENS_SHARED_DATA, 1);
  std::vector<std::shared_ptr<const TriangleMesh>> meshes;  // each once, in the order of the files
  for (const char* file : {"paper_lab_ur5_allegro_right_visual.yaml", "example_ur5_allegro_right.yaml"}) {
    for (const Link& link : load_robot(std::filesystem::path(OPPONENS_SOURCE_DIR "/tests/data/robots") / file).links) {
      for (const Geometry& geometry : link.collision) {
        const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&geometry.shape);
        if (mesh != nullptr && std::find(meshes.begin(), meshes.end(), *mesh) == meshes.end()) meshes.push_back(*mesh);
      }
    }
  }
  const std::filesystem::path objects = OPPONENS_SHARED_DATA "/data/objects";
  for (const char* name : {"ycb/065-g_cups/065-g_cups.obj", "ycb/011_banana/011_banana.obj",
                           "ycb/035_power_drill/035_power_drill.obj", "graspit/mug.obj", "mbm_pregrasp/mug.stl"}) {
    if (std::filesystem::exists(objects / name)) meshes.push_back(load_mesh(objects / name));
  }
  return meshes;
}

}  // namespace opponens::robot
