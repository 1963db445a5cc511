// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/urdf_geometry.hpp"

#include <cmath>

#include <urdf_model/link.h>

#include "core/require.hpp"
#include "robot/mesh.hpp"
#include "robot/resource_place.hpp"

namespace opponens::robot {

void fail_urdf(const std::filesystem::path& file, const std::string& message) {
  throw InputError(file.string() + ": " + message);
}

Eigen::Vector3d vector_of(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Eigen::Isometry3d urdf_pose(const urdf::Pose& pose, const std::filesystem::path& file, const std::string& element) {
  const urdf::Rotation& r = pose.rotation;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  X.translation() = vector_of(pose.position);
  if (!X.matrix().allFinite()) fail_urdf(file, element + ": origin is not finite");
  return X;
}

namespace {

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

}  // namespace

std::optional<Shape> ShapeReader::mesh(const urdf::Mesh& mesh, const std::string& link) {
  const std::string element = "link '" + link + "': mesh '" + mesh.filename + "'";
  const Eigen::Vector3d scale = vector_of(mesh.scale);
  if (!scale.allFinite() || (scale.array() == 0.0).any()) {
    fail_urdf(file_, element + ": scale must be finite and not 0 (negative mirrors)");
  }
  const ResourcePlace place = find_resource(mesh.filename, file_, settings_.packages);
  if (!place.problem.empty()) {
    if (settings_.missing_meshes == MissingMeshes::refuse || place.leaves_its_package) {
      fail_urdf(file_, element + " " + place.problem);
    }
    missing_.push_back({link, mesh.filename, place.problem});
    return std::nullopt;
  }
  auto& entry = cache_[{place.path.string(), scale.x(), scale.y(), scale.z()}];
  if (entry) return entry;
  try {
    entry = load_mesh(place.path, scale);
  } catch (const InputError& error) {
    fail_urdf(file_, "link '" + link + "': " + error.what());
  }
  return entry;
}

std::optional<Shape> ShapeReader::shape(const urdf::Geometry& geometry, const std::string& link) {
  const std::string element = "link '" + link + "'";
  if (geometry.type == urdf::Geometry::SPHERE) {
    const double radius = static_cast<const urdf::Sphere&>(geometry).radius;
    if (!positive(radius)) fail_urdf(file_, element + ": sphere radius must be positive");
    return Sphere{radius};
  }
  if (geometry.type == urdf::Geometry::BOX) {
    const Eigen::Vector3d size = vector_of(static_cast<const urdf::Box&>(geometry).dim);
    if (!size.allFinite() || size.minCoeff() <= 0.0) fail_urdf(file_, element + ": box size must be positive");
    return Box{size};
  }
  if (geometry.type == urdf::Geometry::CYLINDER) {
    const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
    if (!positive(cylinder.radius) || !positive(cylinder.length)) {
      fail_urdf(file_, element + ": cylinder radius and length must be positive");
    }
    return Cylinder{cylinder.radius, cylinder.length};
  }
  return mesh(static_cast<const urdf::Mesh&>(geometry), link);
}

template <typename Elements>
std::vector<Geometry> ShapeReader::shapes(const Elements& elements, const std::string& link) {
  std::vector<Geometry> result;
  for (const auto& element : elements) {
    if (!element || !element->geometry) continue;  // drop_unknown_shapes has noted it
    const Eigen::Isometry3d X_BG = urdf_pose(element->origin, file_, "link '" + link + "'");
    if (const std::optional<Shape> found = shape(*element->geometry, link)) result.push_back({*found, X_BG});
  }
  return result;
}

std::vector<Geometry> ShapeReader::shapes_of(const urdf::Link& link) {
  return settings_.geometry == LinkGeometry::visual ? shapes(link.visual_array, link.name)
                                                    : shapes(link.collision_array, link.name);
}

}  // namespace opponens::robot
