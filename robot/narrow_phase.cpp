// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/narrow_phase.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "core/require.hpp"
#include "robot/convex_distance.hpp"
#include "robot/fcl_mesh.hpp"
#include "robot/leaf_triangles.hpp"
#include "robot/mesh_cover.hpp"
#include "robot/solid_region.hpp"

namespace opponens::robot {

namespace {

constexpr double kLeastSeparation = 1e-9;  ///< m

constexpr double kBoundTolerance = 1e-3;  ///< m

}  // namespace

struct CollisionShape::Data {
  Shape shape;
  Bounds bounds;
  std::shared_ptr<const TriangleMesh> mesh;            ///< null for a primitive
  std::shared_ptr<fcl::CollisionGeometryd> primitive;  ///< null for a mesh
  std::unique_ptr<const FclMeshes> fcl;                ///< null for a primitive
  std::unique_ptr<const LeafTriangles> leaves;         ///< null for a primitive

  /// Of a mesh. Both take as long as reading it from its file, and many meshes are never near enough to another body to
  /// be asked: they are made when they are needed first.
  const SolidRegion& region() const {
    std::call_once(region_once, [this] { region_made = std::make_unique<const SolidRegion>(*mesh); });
    return *region_made;
  }
  const fcl::CollisionGeometryd* geometry() const { return mesh == nullptr ? primitive.get() : fcl->whole(); }

  /// Of a primitive a tree alone.
  const MeshCover& cover() const {
    if (mesh != nullptr && mesh->cover.get() != nullptr) return *mesh->cover.get();
    std::call_once(cover_once, [this] {
      cover_made = mesh != nullptr ? mesh_cover(*mesh, region()) : MeshCover{sphere_tree(shape), {}, {}};
    });
    return cover_made;
  }

  bool contains(const Eigen::Vector3d& p) const {
    if (const auto* box = std::get_if<Box>(&shape)) return (2.0 * p.cwiseAbs() - box->size).maxCoeff() <= 0.0;
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return p.norm() <= sphere->radius;
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      return p.head<2>().norm() <= cylinder->radius && 2.0 * std::abs(p.z()) <= cylinder->length;
    }
    return region().contains(p);
  }

 private:
  mutable std::once_flag region_once;
  mutable std::once_flag cover_once;
  mutable MeshCover cover_made;
  mutable std::unique_ptr<const SolidRegion> region_made;
};

namespace {

/// FCL's form of a primitive; throws std::invalid_argument for sizes that no solid has. Null for a mesh.
struct FclPrimitive {
  std::shared_ptr<fcl::CollisionGeometryd> operator()(const Box& box) const {
    require(box.size.allFinite() && box.size.minCoeff() > 0.0, "collision: a box needs positive edge lengths");
    return std::make_shared<fcl::Boxd>(box.size);
  }
  std::shared_ptr<fcl::CollisionGeometryd> operator()(const Sphere& sphere) const {
    require(std::isfinite(sphere.radius) && sphere.radius > 0.0, "collision: a sphere needs a positive radius");
    return std::make_shared<fcl::Sphered>(sphere.radius);
  }
  std::shared_ptr<fcl::CollisionGeometryd> operator()(const Cylinder& c) const {
    require(std::isfinite(c.radius) && c.radius > 0.0 && std::isfinite(c.length) && c.length > 0.0,
            "collision: a cylinder needs a positive radius and length");
    return std::make_shared<fcl::Cylinderd>(c.radius, c.length);
  }
  std::shared_ptr<fcl::CollisionGeometryd> operator()(const std::shared_ptr<const TriangleMesh>& mesh) const {
    require(mesh != nullptr && mesh->triangles.cols() > 0, "collision: a mesh without triangles");
    return nullptr;
  }
};

struct BoundsOf {
  CollisionShape::Bounds operator()(const Box& box) const {
    return {Eigen::Vector3d::Zero(), 0.5 * box.size, 0.5 * box.size.norm()};
  }
  CollisionShape::Bounds operator()(const Sphere& sphere) const {
    return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(sphere.radius), sphere.radius};
  }
  CollisionShape::Bounds operator()(const Cylinder& c) const {
    return {Eigen::Vector3d::Zero(), {c.radius, c.radius, 0.5 * c.length}, std::hypot(c.radius, 0.5 * c.length)};
  }
  CollisionShape::Bounds operator()(const std::shared_ptr<const TriangleMesh>& mesh) const {
    const Eigen::Vector3d lower = mesh->vertices.rowwise().minCoeff();
    const Eigen::Vector3d upper = mesh->vertices.rowwise().maxCoeff();
    const Eigen::Vector3d center = 0.5 * (lower + upper);
    return {center, 0.5 * (upper - lower), (mesh->vertices.colwise() - center).colwise().norm().maxCoeff()};
  }
};

std::shared_ptr<const CollisionShape::Data> make_data(const Shape& shape) {
  auto data = std::make_shared<CollisionShape::Data>();
  data->shape = shape;
  data->primitive = std::visit(FclPrimitive{}, shape);
  data->bounds = std::visit(BoundsOf{}, shape);
  // FCL fills this cache lazily elsewhere; filled here, the geometry is read-only afterwards.
  if (data->primitive != nullptr) data->primitive->computeLocalAABB();
  if (const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape)) {
    data->mesh = *mesh;
    data->fcl = std::make_unique<const FclMeshes>(**mesh);
    data->leaves = std::make_unique<const LeafTriangles>(**mesh);
  }
  return data;
}

/// The data of a mesh that some CollisionShape holds already, else new.
std::shared_ptr<const CollisionShape::Data> shared_data(const std::shared_ptr<const TriangleMesh>& mesh) {
  using Known = std::map<std::weak_ptr<const TriangleMesh>, std::weak_ptr<const CollisionShape::Data>,
                         std::owner_less<std::weak_ptr<const TriangleMesh>>>;
  static std::mutex mutex;
  static Known known;
  const std::lock_guard lock(mutex);
  std::erase_if(known, [](const auto& entry) { return entry.second.expired(); });
  if (const auto found = known.find(mesh); found != known.end()) {
    if (auto data = found->second.lock()) return data;
  }
  auto data = make_data(mesh);
  known[mesh] = data;
  return data;
}

/// Whether a seed of b (a vertex of each component; the centre of a primitive) lies in a. Only after the surfaces were
/// found apart.
bool holds_a_seed(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                  const Eigen::Isometry3d& X_WB) {
  const Eigen::Isometry3d X_AB = X_WA.inverse(Eigen::Isometry) * X_WB;
  if (b.data().mesh == nullptr) return a.data().contains(X_AB.translation());
  const std::vector<Eigen::Vector3d>& seeds = b.data().region().seeds();
  return std::any_of(seeds.begin(), seeds.end(),
                     [&](const Eigen::Vector3d& seed) { return a.data().contains(X_AB * seed); });
}

/// Distance of a sphere's surface to a mesh's; negative where it cuts it. Exact, and far faster than FCL's.
double sphere_mesh_gap(const Sphere& sphere, const Eigen::Isometry3d& X_WS, const CollisionShape& mesh,
                       const Eigen::Isometry3d& X_WM) {
  const Eigen::Vector3d p_MS = X_WM.inverse(Eigen::Isometry) * X_WS.translation();
  return std::sqrt(mesh.data().region().triangles().nearest(p_MS).squared_distance) - sphere.radius;
}

/// The gap when one of the two is a sphere and the other a mesh.
std::optional<double> sphere_mesh_gap(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                                      const Eigen::Isometry3d& X_WB) {
  if (const auto* sphere = std::get_if<Sphere>(&a.data().shape); sphere != nullptr && b.data().mesh != nullptr) {
    return sphere_mesh_gap(*sphere, X_WA, b, X_WB);
  }
  if (const auto* sphere = std::get_if<Sphere>(&b.data().shape); sphere != nullptr && a.data().mesh != nullptr) {
    return sphere_mesh_gap(*sphere, X_WB, a, X_WA);
  }
  return std::nullopt;
}

bool fcl_meet(const fcl::CollisionGeometryd* a, const Eigen::Isometry3d& X_WA, const fcl::CollisionGeometryd* b,
              const Eigen::Isometry3d& X_WB) {
  const fcl::CollisionRequestd request(1, false);
  fcl::CollisionResultd result;
  fcl::collide(a, X_WA, b, X_WB, request, result);
  return result.isCollision();
}

bool surfaces_meet(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                   const Eigen::Isometry3d& X_WB) {
  if (const std::optional<double> gap = sphere_mesh_gap(a, X_WA, b, X_WB)) return *gap <= 0.0;
  return fcl_meet(a.data().geometry(), X_WA, b.data().geometry(), X_WB);
}

/// Distance of a primitive's surface to a mesh's, within 1e-7 below.
double mesh_primitive_gap(const CollisionShape& mesh, const Eigen::Isometry3d& X_WM, const Shape& shape,
                          const Eigen::Isometry3d& X_WS) {
  const Eigen::Isometry3d X_MS = X_WM.inverse(Eigen::Isometry) * X_WS;
  return mesh.data().region().triangles().least(
      [&](const Eigen::Vector3d& center, const Eigen::Vector3d& half_extents) {
        const Eigen::Isometry3d X_MB(Eigen::Translation3d{center});
        // The bound is valid at any tolerance; a coarse one is found in a few steps.
        return convex_distance(Box{2.0 * half_extents}, X_MB, shape, X_MS, kBoundTolerance).lower;
      },
      [&](const Eigen::Vector3d& a, const Eigen::Vector3d& ab, const Eigen::Vector3d& ac) {
        return triangle_distance(a, ab, ac, shape, X_MS).lower;
      });
}

double fcl_distance(const fcl::CollisionGeometryd* a, const Eigen::Isometry3d& X_WA, const fcl::CollisionGeometryd* b,
                    const Eigen::Isometry3d& X_WB, double limit) {
  fcl::DistanceResultd result(limit);  // only nearer pairs of triangles are descended to
  fcl::distance(a, X_WA, b, X_WB, fcl::DistanceRequestd(false, false), result);
  return std::clamp(result.min_distance, 0.0, limit);
}

}  // namespace

CollisionShape::CollisionShape(const Shape& shape) {
  const auto* mesh = std::get_if<std::shared_ptr<const TriangleMesh>>(&shape);
  data_ = mesh != nullptr && *mesh != nullptr ? shared_data(*mesh) : make_data(shape);
  bounds_ = data_->bounds;
}

const SphereTree& CollisionShape::cover() const { return data_->cover().tree; }

const std::vector<HullVertices>& CollisionShape::pieces() const { return data_->cover().pieces; }

const HullVertices& CollisionShape::hull() const {
  require(data_->mesh != nullptr, "CollisionShape: only a mesh has hull vertices");
  return data_->cover().hull;
}

const Shape& CollisionShape::shape() const { return data_->shape; }

const BoundingVolumeTree& CollisionShape::triangles() const {
  require(data_->mesh != nullptr, "CollisionShape: only a mesh has triangles");
  return data_->region().triangles();
}

bool CollisionShape::open_surface() const { return data_->mesh != nullptr && data_->region().open(); }

bool intersect(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
               const Eigen::Isometry3d& X_WB) {
  return surfaces_meet(a, X_WA, b, X_WB) || contained(a, X_WA, b, X_WB);
}

bool contained(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
               const Eigen::Isometry3d& X_WB) {
  return holds_a_seed(a, X_WA, b, X_WB) || holds_a_seed(b, X_WB, a, X_WA);
}

bool leaves_meet(const CollisionShape& a, const Eigen::Isometry3d& X_WA, int leaf_a, const CollisionShape& b,
                 const Eigen::Isometry3d& X_WB, int leaf_b) {
  const SphereTree& tree_a = a.cover();
  const SphereTree& tree_b = b.cover();
  return leaves_meet(a.data().leaves->of(tree_a, leaf_a), tree_a.nodes[static_cast<std::size_t>(leaf_a)],
                     b.data().leaves->of(tree_b, leaf_b), tree_b.nodes[static_cast<std::size_t>(leaf_b)],
                     X_WA.inverse(Eigen::Isometry) * X_WB);
}

double separation(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                  const Eigen::Isometry3d& X_WB) {
  if (intersect(a, X_WA, b, X_WB)) return 0.0;
  const bool mesh_a = a.data().mesh != nullptr;
  const bool mesh_b = b.data().mesh != nullptr;
  double distance = 0.0;
  if (const std::optional<double> gap = sphere_mesh_gap(a, X_WA, b, X_WB)) {
    distance = *gap;
  } else if (!mesh_a && !mesh_b) {
    distance = convex_distance(a.data().shape, X_WA, b.data().shape, X_WB).lower;
  } else if (!mesh_b) {
    distance = mesh_primitive_gap(a, X_WA, b.data().shape, X_WB);
  } else if (!mesh_a) {
    distance = mesh_primitive_gap(b, X_WB, a.data().shape, X_WA);
  } else {
    fcl::DistanceResultd result;
    distance = fcl::distance(a.data().geometry(), X_WA, b.data().geometry(), X_WB, fcl::DistanceRequestd(false, false),
                             result);
  }
  return std::max(distance, kLeastSeparation);
}

double leaves_distance(const CollisionShape& a, const Eigen::Isometry3d& X_WA, int leaf_a, const CollisionShape& b,
                       const Eigen::Isometry3d& X_WB, int leaf_b, double limit) {
  return fcl_distance(a.data().fcl->leaf(a.cover(), leaf_a), X_WA, b.data().fcl->leaf(b.cover(), leaf_b), X_WB, limit);
}

double point_box_distance(const Eigen::Vector3d& p, const OrientedBox& box) {
  const Eigen::Vector3d local = box.axes.transpose() * (p - box.center);
  return (local.cwiseAbs() - box.half_extents).cwiseMax(0.0).norm();
}

double box_gap(const OrientedBox& a, const OrientedBox& b) {
  const Eigen::Matrix3d R = a.axes.transpose() * b.axes;
  const Eigen::Vector3d t = a.axes.transpose() * (b.center - a.center);
  const Eigen::Matrix3d Q = R.cwiseAbs();
  return std::max({0.0, (t.cwiseAbs() - a.half_extents - Q * b.half_extents).maxCoeff(),
                   ((R.transpose() * t).cwiseAbs() - b.half_extents - Q.transpose() * a.half_extents).maxCoeff()});
}

bool boxes_apart(const OrientedBox& a, const OrientedBox& b, double margin) {
  const Eigen::Matrix3d R = a.axes.transpose() * b.axes;
  const Eigen::Vector3d t = a.axes.transpose() * (b.center - a.center);
  const Eigen::Matrix3d Q = R.cwiseAbs();
  const Eigen::Vector3d& h = a.half_extents;
  const Eigen::Vector3d& g = b.half_extents;
  if (((t.cwiseAbs() - h - Q * g).array() > margin).any()) return true;
  if ((((R.transpose() * t).cwiseAbs() - g - Q.transpose() * h).array() > margin).any()) return true;
  // Cross products of edges. They are not unit: the margin shrinks with their length sqrt(1 - R_ij^2) <= 1, so the full
  // margin is on the safe side. Nearly parallel edges give no axis beyond the faces'.
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3;
      const int j2 = (j + 2) % 3;
      const double reach = h[i1] * Q(i2, j) + h[i2] * Q(i1, j) + g[j1] * Q(i, j2) + g[j2] * Q(i, j1);
      if (std::abs(t[i2] * R(i1, j) - t[i1] * R(i2, j)) > reach + margin) return true;
    }
  }
  return false;
}

}  // namespace opponens::robot
