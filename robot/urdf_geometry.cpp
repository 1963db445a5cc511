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

/// A folder called `package` above the URDF, or beside one that is above it.
std::optional<std::filesystem::path> package_above(const std::filesystem::path& urdf_file, const std::string& package) {
  std::error_code error;
  std::filesystem::path folder = std::filesystem::absolute(urdf_file, error).parent_path();
  for (; !folder.empty() && folder != folder.root_path(); folder = folder.parent_path()) {
    if (folder.filename() == package) return folder;
    if (std::filesystem::is_directory(folder / package, error)) return folder / package;
  }
  return std::nullopt;
}

std::optional<std::filesystem::path> package_folder(const std::string& package, const std::filesystem::path& urdf_file,
                                                    const PackagePaths& packages) {
  if (const auto found = packages.directories.find(package); found != packages.directories.end()) return found->second;
  std::error_code error;
  for (const std::filesystem::path& root : packages.roots) {
    if (std::filesystem::is_directory(root / package, error)) return root / package;
  }
  return package_above(urdf_file, package);
}

/// Whether `inner` lies in `folder` once links are followed; what does not exist is judged by its names, and what
/// cannot be followed (links in a circle) is left to the check that it is a file.
bool lies_in(const std::filesystem::path& inner, const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::path full = std::filesystem::weakly_canonical(inner, error);
  if (error) return true;
  const std::filesystem::path root = std::filesystem::weakly_canonical(folder, error);
  if (error) return true;
  const std::filesystem::path relative = full.lexically_relative(root);
  return !relative.empty() && *relative.begin() != "..";
}

/// Where a mesh lies, or why that cannot be told.
struct MeshPlace {
  std::filesystem::path path;
  std::string problem;              ///< empty: it is a file
  bool leaves_its_package = false;  ///< never passed over: no honest file does
};

MeshPlace checked_file(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) return {path, ""};
  if (std::filesystem::is_directory(path, error)) return {path, "is a directory: " + path.string()};
  const bool exists = std::filesystem::exists(path, error);
  return {path, (exists ? "is not a regular file: " : "does not exist: ") + path.string()};
}

MeshPlace mesh_place(const std::string& name, const std::filesystem::path& urdf_file, const PackagePaths& packages) {
  static const std::string kPackage = "package://";
  static const std::string kFile = "file://";
  if (name.starts_with(kFile)) return checked_file(name.substr(kFile.size()));
  if (!name.starts_with(kPackage)) {
    const std::filesystem::path path = name;
    return checked_file(path.is_absolute() ? path : urdf_file.parent_path() / path);
  }
  const std::size_t slash = name.find('/', kPackage.size());
  const std::string package = name.substr(kPackage.size(), slash - kPackage.size());
  const std::filesystem::path rest = slash == std::string::npos ? "" : name.substr(slash + 1);
  const std::filesystem::path plain = rest.lexically_normal();
  if (package.empty() || package == "." || package == ".." || rest.is_absolute() ||
      (!plain.empty() && *plain.begin() == "..")) {
    return {{}, "leaves its package", true};
  }
  const std::optional<std::filesystem::path> folder = package_folder(package, urdf_file, packages);
  if (!folder) return {{}, "package '" + package + "' has no path (key packages)"};
  if (!lies_in(*folder / rest, *folder)) return {{}, "leaves its package, " + folder->string(), true};
  return checked_file(*folder / rest);
}

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

}  // namespace

std::optional<Shape> ShapeReader::mesh(const urdf::Mesh& mesh, const std::string& link) {
  const std::string element = "link '" + link + "': mesh '" + mesh.filename + "'";
  const Eigen::Vector3d scale = vector_of(mesh.scale);
  if (!scale.allFinite() || (scale.array() == 0.0).any()) {
    fail_urdf(file_, element + ": scale must be finite and not 0 (negative mirrors)");
  }
  const MeshPlace place = mesh_place(mesh.filename, file_, settings_.packages);
  if (!place.problem.empty()) {
    if (settings_.missing_meshes == MissingMeshes::refuse || place.leaves_its_package) {
      fail_urdf(file_, element + " " + place.problem);
    }
    missing_.push_back({link, mesh.filename, place.problem});
    return std::nullopt;
  }
  auto& entry = cache_[{place.path.string(), scale.x(), scale.y(), scale.z()}];
  if (!entry) entry = load_mesh(place.path, scale);
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
