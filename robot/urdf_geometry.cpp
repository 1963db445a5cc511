// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/urdf_geometry.hpp"

#include <cmath>

#include <urdf_model/link.h>

#include "core/require.hpp"
#include "robot/mesh.hpp"

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

std::filesystem::path mesh_path(const std::string& name, const std::filesystem::path& urdf_file,
                                const PackagePaths& packages, const std::string& element) {
  static const std::string kPackage = "package://";
  static const std::string kFile = "file://";
  if (name.starts_with(kFile)) return name.substr(kFile.size());
  if (!name.starts_with(kPackage)) {
    const std::filesystem::path path = name;
    return path.is_absolute() ? path : urdf_file.parent_path() / path;
  }
  const std::size_t slash = name.find('/', kPackage.size());
  const std::string package = name.substr(kPackage.size(), slash - kPackage.size());
  const std::string rest = slash == std::string::npos ? "" : name.substr(slash + 1);
  if (const auto found = packages.directories.find(package); found != packages.directories.end()) {
    return found->second / rest;
  }
  for (const std::filesystem::path& root : packages.roots) {
    if (std::filesystem::is_directory(root / package)) return root / package / rest;
  }
  fail_urdf(urdf_file, element + ": mesh '" + name + "': package '" + package + "' has no path (key packages)");
}

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

Shape shape_of(const urdf::Geometry& geometry, const std::filesystem::path& file, const UrdfSettings& settings,
               const std::string& element, MeshCache& cache) {
  if (geometry.type == urdf::Geometry::SPHERE) {
    const double radius = static_cast<const urdf::Sphere&>(geometry).radius;
    if (!positive(radius)) fail_urdf(file, element + ": sphere radius must be positive");
    return Sphere{radius};
  }
  if (geometry.type == urdf::Geometry::BOX) {
    const Eigen::Vector3d size = vector_of(static_cast<const urdf::Box&>(geometry).dim);
    if (!size.allFinite() || size.minCoeff() <= 0.0) fail_urdf(file, element + ": box size must be positive");
    return Box{size};
  }
  if (geometry.type == urdf::Geometry::CYLINDER) {
    const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
    if (!positive(cylinder.radius) || !positive(cylinder.length)) {
      fail_urdf(file, element + ": cylinder radius and length must be positive");
    }
    return Cylinder{cylinder.radius, cylinder.length};
  }
  const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
  const std::filesystem::path path = mesh_path(mesh.filename, file, settings.packages, element);
  const Eigen::Vector3d scale = vector_of(mesh.scale);
  if (!std::filesystem::is_regular_file(path)) {
    fail_urdf(file, element + ": mesh '" + mesh.filename + "' does not exist: " + path.string());
  }
  if (!scale.allFinite() || (scale.array() == 0.0).any())
    fail_urdf(file, element + ": mesh scale must be finite, not 0");
  auto& entry = cache[{path.string(), scale.x(), scale.y(), scale.z()}];
  if (!entry) entry = load_mesh(path, scale);
  return entry;
}

template <typename Elements>
std::vector<Geometry> shapes_of(const Elements& elements, const std::filesystem::path& file,
                                const UrdfSettings& settings, const std::string& element, MeshCache& cache) {
  std::vector<Geometry> result;
  for (const auto& shape : elements) {
    if (!shape || !shape->geometry) continue;
    result.push_back(
        {shape_of(*shape->geometry, file, settings, element, cache), urdf_pose(shape->origin, file, element)});
  }
  return result;
}

}  // namespace

std::vector<Geometry> geometry_of(const urdf::Link& link, const std::filesystem::path& file,
                                  const UrdfSettings& settings, MeshCache& cache) {
  const std::string element = "link '" + link.name + "'";
  return settings.geometry == LinkGeometry::visual ? shapes_of(link.visual_array, file, settings, element, cache)
                                                   : shapes_of(link.collision_array, file, settings, element, cache);
}

}  // namespace opponens::robot
