// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/fcl_mesh.hpp"

#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>

#include "core/require.hpp"
#include "robot/leaf_triangles.hpp"

namespace opponens::robot {

namespace {

/// The chosen triangles.
FclGeometry fcl_mesh(const TriangleMesh& mesh, const std::vector<Eigen::Index>& chosen) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Vector3d> vertices;
  std::vector<fcl::Triangle> triangles;
  std::vector<int> index(static_cast<std::size_t>(mesh.vertices.cols()), -1);
  for (const Eigen::Index f : chosen) {
    std::array<std::size_t, 3> corner;  // NOLINT: filled below
    for (int k = 0; k < 3; ++k) {
      int& known = index[static_cast<std::size_t>(mesh.triangles(k, f))];
      if (known < 0) {
        known = static_cast<int>(vertices.size());
        vertices.emplace_back(mesh.vertices.col(mesh.triangles(k, f)));
      }
      corner[static_cast<std::size_t>(k)] = static_cast<std::size_t>(known);
    }
    triangles.emplace_back(corner[0], corner[1], corner[2]);
  }
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  const bool added = model->addSubModel(vertices, triangles) == fcl::BVH_OK && model->endModel() == fcl::BVH_OK;
  require(added, [&] { return "collision: FCL refuses the mesh " + mesh.source; });
  model->computeLocalAABB();
  return model;
}

}  // namespace

const fcl::CollisionGeometryd* FclMeshes::whole() const {
  std::call_once(whole_.once, [this] {
    std::vector<Eigen::Index> all(static_cast<std::size_t>(mesh_.triangles.cols()));
    std::iota(all.begin(), all.end(), 0);
    whole_.made = fcl_mesh(mesh_, all);
  });
  return whole_.made.get();
}

const fcl::CollisionGeometryd* FclMeshes::leaf(const SphereTree& tree, int node) const {
  std::call_once(leaves_once_, [&] { leaves_ = std::make_unique<Lazy[]>(tree.nodes.size()); });
  Lazy& own = leaves_[static_cast<std::size_t>(node)];
  std::call_once(
      own.once, [&] { own.made = fcl_mesh(mesh_, triangles_near(mesh_, tree.nodes[static_cast<std::size_t>(node)])); });
  return own.made.get();
}

}  // namespace opponens::robot
