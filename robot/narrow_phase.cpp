// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/narrow_phase.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "core/require.hpp"
#include "robot/bounding_volume_tree.hpp"
#include "robot/convex_distance.hpp"
#include "robot/mesh.hpp"
#include "robot/mesh_distance.hpp"

namespace opponens::robot {

namespace {

constexpr double kLeastSeparation = 1e-9;  ///< m

constexpr double kBoundTolerance = 1e-3;  ///< m

/// A closed component that fills less of its box than this is a sheet counted there and back, not a solid.
constexpr double kLeastFilling = 1e-9;

/// The region that one closed component of a mesh encloses.
struct Enclosure {
  Eigen::AlignedBox3d box;
  MeshDistance distance;
  bool outward;         ///< triangles seen counter-clockwise from outside
  bool cavity = false;  ///< it is the wall of a hollow inside another component

  bool encloses(const Eigen::Vector3d& p) const {
    return box.contains(p) && (distance.signed_distance(p) < 0.0) == outward;
  }
};

struct MeshParts {
  std::vector<Enclosure> enclosures;
  std::vector<Eigen::Vector3d> seeds;  ///< a vertex of each component
  bool open = false;
};

MeshParts split(const TriangleMesh& mesh) {
  MeshParts parts;
  std::vector<Eigen::Vector3d> seed_of;
  for (TriangleMesh& component : components(mesh)) {
    const Eigen::Vector3d seed = component.vertices.col(component.triangles(0, 0));
    parts.seeds.push_back(seed);
    const double volume = mass_properties(component).volume;
    const Eigen::AlignedBox3d box(component.vertices.rowwise().minCoeff(), component.vertices.rowwise().maxCoeff());
    if (!is_closed(component) || std::abs(volume) <= kLeastFilling * box.volume()) {
      parts.open = true;
      continue;
    }
    parts.enclosures.push_back({box, MeshDistance(std::make_shared<TriangleMesh>(std::move(component))), volume > 0.0});
    seed_of.push_back(seed);
  }
  // Inside out and within an outward component: a hollow. Inside out on its own: a solid written with flipped faces.
  for (std::size_t i = 0; i < parts.enclosures.size(); ++i) {
    if (parts.enclosures[i].outward) continue;
    parts.enclosures[i].cavity = std::any_of(parts.enclosures.begin(), parts.enclosures.end(),
                                             [&](const Enclosure& e) { return e.outward && e.encloses(seed_of[i]); });
  }
  return parts;
}

std::shared_ptr<fcl::CollisionGeometryd> fcl_mesh(const TriangleMesh& mesh) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Vector3d> vertices;
  std::vector<fcl::Triangle> triangles;
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i) vertices.emplace_back(mesh.vertices.col(i));
  for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
    const auto corner = [&](int k) { return static_cast<std::size_t>(mesh.triangles(k, i)); };
    triangles.emplace_back(corner(0), corner(1), corner(2));
  }
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  const bool added = model->addSubModel(vertices, triangles) == fcl::BVH_OK && model->endModel() == fcl::BVH_OK;
  require(added, [&] { return "collision: FCL refuses the mesh " + mesh.source; });
  return model;
}

}  // namespace

struct CollisionShape::Data {
  Shape shape;
  std::shared_ptr<fcl::CollisionGeometryd> geometry;
  MeshParts parts;                                      ///< of a mesh; a primitive has its centre as seed
  std::unique_ptr<const BoundingVolumeTree> triangles;  ///< of a mesh

  bool contains(const Eigen::Vector3d& p) const {
    if (const auto* box = std::get_if<Box>(&shape)) return (2.0 * p.cwiseAbs() - box->size).maxCoeff() <= 0.0;
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return p.norm() <= sphere->radius;
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      return p.head<2>().norm() <= cylinder->radius && 2.0 * std::abs(p.z()) <= cylinder->length;
    }
    int layers = 0;
    for (const Enclosure& e : parts.enclosures) {
      if (e.encloses(p)) layers += e.cavity ? -1 : 1;
    }
    return layers > 0;
  }
};

namespace {

struct ShapeBuilder {
  CollisionShape::Data& data;
  Eigen::Vector3d& center;
  Eigen::Vector3d& half_extents;
  double& radius;

  void operator()(const Box& box) const {
    require(box.size.allFinite() && box.size.minCoeff() > 0.0, "collision: a box needs positive edge lengths");
    data.geometry = std::make_shared<fcl::Boxd>(box.size);
    set_primitive(0.5 * box.size, 0.5 * box.size.norm());
  }
  void operator()(const Sphere& sphere) const {
    require(std::isfinite(sphere.radius) && sphere.radius > 0.0, "collision: a sphere needs a positive radius");
    data.geometry = std::make_shared<fcl::Sphered>(sphere.radius);
    set_primitive(Eigen::Vector3d::Constant(sphere.radius), sphere.radius);
  }
  void operator()(const Cylinder& c) const {
    require(std::isfinite(c.radius) && c.radius > 0.0 && std::isfinite(c.length) && c.length > 0.0,
            "collision: a cylinder needs a positive radius and length");
    data.geometry = std::make_shared<fcl::Cylinderd>(c.radius, c.length);
    set_primitive({c.radius, c.radius, 0.5 * c.length}, std::hypot(c.radius, 0.5 * c.length));
  }
  void operator()(const std::shared_ptr<const TriangleMesh>& mesh) const {
    require(mesh != nullptr && mesh->triangles.cols() > 0, "collision: a mesh without triangles");
    data.geometry = fcl_mesh(*mesh);
    data.parts = split(*mesh);
    data.triangles = std::make_unique<const BoundingVolumeTree>(*mesh);
    const Eigen::Vector3d lower = mesh->vertices.rowwise().minCoeff();
    const Eigen::Vector3d upper = mesh->vertices.rowwise().maxCoeff();
    center = 0.5 * (lower + upper);
    half_extents = 0.5 * (upper - lower);
    radius = (mesh->vertices.colwise() - center).colwise().norm().maxCoeff();
  }
  void set_primitive(const Eigen::Vector3d& half, double bounding_radius) const {
    data.parts.seeds = {Eigen::Vector3d::Zero()};
    center = Eigen::Vector3d::Zero();
    half_extents = half;
    radius = bounding_radius;
  }
};

/// Whether a seed of b lies in a. Only after the surfaces were found apart.
bool holds_a_seed(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                  const Eigen::Isometry3d& X_WB) {
  const Eigen::Isometry3d X_AB = X_WA.inverse(Eigen::Isometry) * X_WB;
  const std::vector<Eigen::Vector3d>& seeds = b.data().parts.seeds;
  return std::any_of(seeds.begin(), seeds.end(),
                     [&](const Eigen::Vector3d& seed) { return a.data().contains(X_AB * seed); });
}

/// Distance of a sphere's surface to a mesh's; negative where it cuts it. Exact, and far faster than FCL's.
double sphere_mesh_gap(const Sphere& sphere, const Eigen::Isometry3d& X_WS, const CollisionShape& mesh,
                       const Eigen::Isometry3d& X_WM) {
  const Eigen::Vector3d p_MS = X_WM.inverse(Eigen::Isometry) * X_WS.translation();
  return std::sqrt(mesh.data().triangles->nearest(p_MS).squared_distance) - sphere.radius;
}

/// The gap when one of the two is a sphere and the other a mesh.
std::optional<double> sphere_mesh_gap(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                                      const Eigen::Isometry3d& X_WB) {
  if (const auto* sphere = std::get_if<Sphere>(&a.data().shape); sphere != nullptr && b.data().triangles != nullptr) {
    return sphere_mesh_gap(*sphere, X_WA, b, X_WB);
  }
  if (const auto* sphere = std::get_if<Sphere>(&b.data().shape); sphere != nullptr && a.data().triangles != nullptr) {
    return sphere_mesh_gap(*sphere, X_WB, a, X_WA);
  }
  return std::nullopt;
}

bool surfaces_meet(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                   const Eigen::Isometry3d& X_WB) {
  if (const std::optional<double> gap = sphere_mesh_gap(a, X_WA, b, X_WB)) return *gap <= 0.0;
  const fcl::CollisionRequestd request(1, false);
  fcl::CollisionResultd result;
  fcl::collide(a.data().geometry.get(), X_WA, b.data().geometry.get(), X_WB, request, result);
  return result.isCollision();
}

/// Distance of a primitive's surface to a mesh's, within 1e-7 below.
double mesh_primitive_gap(const CollisionShape& mesh, const Eigen::Isometry3d& X_WM, const Shape& shape,
                          const Eigen::Isometry3d& X_WS) {
  const Eigen::Isometry3d X_MS = X_WM.inverse(Eigen::Isometry) * X_WS;
  return mesh.data().triangles->least(
      [&](const Eigen::Vector3d& center, const Eigen::Vector3d& half_extents) {
        const Eigen::Isometry3d X_MB(Eigen::Translation3d{center});
        // The bound is valid at any tolerance; a coarse one is found in a few steps.
        return convex_distance(Box{2.0 * half_extents}, X_MB, shape, X_MS, kBoundTolerance).lower;
      },
      [&](const Eigen::Vector3d& a, const Eigen::Vector3d& ab, const Eigen::Vector3d& ac) {
        return triangle_distance(a, ab, ac, shape, X_MS).lower;
      });
}

}  // namespace

CollisionShape::CollisionShape(const Shape& shape) {
  auto data = std::make_shared<Data>();
  data->shape = shape;
  std::visit(ShapeBuilder{*data, center_, half_extents_, radius_}, shape);
  // FCL fills this cache lazily elsewhere; filled here, the geometry is read-only afterwards.
  data->geometry->computeLocalAABB();
  data_ = std::move(data);
}

bool CollisionShape::open_surface() const { return data_->parts.open; }

bool intersect(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
               const Eigen::Isometry3d& X_WB) {
  if (surfaces_meet(a, X_WA, b, X_WB)) return true;
  return holds_a_seed(a, X_WA, b, X_WB) || holds_a_seed(b, X_WB, a, X_WA);
}

double separation(const CollisionShape& a, const Eigen::Isometry3d& X_WA, const CollisionShape& b,
                  const Eigen::Isometry3d& X_WB) {
  if (intersect(a, X_WA, b, X_WB)) return 0.0;
  const bool mesh_a = a.data().triangles != nullptr;
  const bool mesh_b = b.data().triangles != nullptr;
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
    distance = fcl::distance(a.data().geometry.get(), X_WA, b.data().geometry.get(), X_WB,
                             fcl::DistanceRequestd(false, false), result);
  }
  return std::max(distance, kLeastSeparation);
}

double point_box_distance(const Eigen::Vector3d& p, const OrientedBox& box) {
  const Eigen::Vector3d local = box.axes.transpose() * (p - box.center);
  return (local.cwiseAbs() - box.half_extents).cwiseMax(0.0).norm();
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
