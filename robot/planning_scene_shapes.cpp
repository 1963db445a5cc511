// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "core/require.hpp"
#include "robot/mesh.hpp"
#include "robot/planning_scene_file.hpp"
#include "robot/resource_place.hpp"
#include "robot/scene_values.hpp"

namespace opponens::robot {

namespace {

constexpr int kConeSegments = 64;

/// Of the dimensions of a primitive, as many as its type has, all positive.
Eigen::VectorXd dimensions_of(const YamlValue& primitive, int count) {
  const YamlValue written = primitive.at("dimensions");
  Eigen::VectorXd dimensions = written.numbers(count);
  for (const YamlValue& value : written.items()) positive(value);
  return dimensions;
}

Shape primitive_of(const YamlValue& value) {
  value.allow_keys({"type", "dimensions"});
  const YamlValue written = value.at("type");
  const std::string type = written.text();
  // The numbers are those of shape_msgs/SolidPrimitive, which rostopic prints.
  if (type == "box" || type == "1") return Box{dimensions_of(value, 3)};
  if (type == "sphere" || type == "2") return Sphere{dimensions_of(value, 1)[0]};
  if (type == "cylinder" || type == "3") {
    const Eigen::VectorXd d = dimensions_of(value, 2);
    return Cylinder{d[1], d[0]};
  }
  if (type == "cone" || type == "4") {
    const Eigen::VectorXd d = dimensions_of(value, 2);
    return cone(d[1], d[0]);
  }
  if (type == "plane") written.fail("a plane has no thickness and no end; write a box instead");
  written.fail("expected box, sphere, cylinder or cone, found '" + type + "'");
}

/// Where the file of a mesh lies; ${NAME} is expanded in a path, not in a URI.
std::filesystem::path resource_path(const YamlValue& resource, const PackagePaths& packages) {
  const std::string name = resource.text();
  if (name.find("://") == std::string::npos) return resource.path();
  const ResourcePlace place = find_resource(name, resource.file(), packages);
  if (!place.problem.empty()) resource.fail("'" + name + "' " + place.problem);
  return place.path;
}

Shape mesh_of_resource(const YamlValue& value, const PackagePaths& packages) {
  value.allow_keys({"resource", "dimensions"});
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  if (value.has("dimensions")) scale = dimensions_of(value, 3);
  const YamlValue resource = value.at("resource");
  const std::filesystem::path path = resource_path(resource, packages);
  try {
    return load_mesh(path, scale);
  } catch (const InputError& error) {
    resource.fail(error.what());
  }
}

Eigen::Vector3i triangle_of(const YamlValue& value, Eigen::Index vertices) {
  const YamlValue corners = value.is_map() ? value.at("vertex_indices") : value;
  const Eigen::Vector3d written = corners.numbers(3);
  for (int k = 0; k < 3; ++k) {
    if (written[k] < 0.0 || written[k] >= static_cast<double>(vertices) || written[k] != std::floor(written[k])) {
      corners.fail("expected the indices of three of the " + std::to_string(vertices) + " vertices");
    }
  }
  return written.cast<int>();
}

/// A mesh whose vertices and triangles stand in the file itself.
Shape inline_mesh(const YamlValue& value) {
  value.allow_keys({"vertices", "triangles"});
  const std::vector<YamlValue> vertices = value.at("vertices").items();
  const std::vector<YamlValue> triangles = value.at("triangles").items();
  TriangleMesh mesh;
  mesh.source = value.file().string();
  mesh.vertices.resize(3, static_cast<Eigen::Index>(vertices.size()));
  mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    mesh.vertices.col(static_cast<Eigen::Index>(i)) = ros_vector(vertices[i]);
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    mesh.triangles.col(static_cast<Eigen::Index>(i)) = triangle_of(triangles[i], mesh.vertices.cols());
  }
  mesh = merge_equal_vertices(mesh);
  if (mesh.triangles.cols() == 0) value.at("triangles").fail("a mesh without triangles");
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

/// Appends the shapes of one list with the poses of another. A single pose that is left out is the object's own.
template <typename MakeShape>
void append_shapes(const YamlValue& object, const char* shapes_key, const char* poses_key, const MakeShape& make,
                   std::vector<Geometry>& result) {
  const auto shapes = object.find(shapes_key);
  const auto poses = object.find(poses_key);
  const std::vector<YamlValue> shape_items = shapes ? shapes->items() : std::vector<YamlValue>();
  const std::vector<YamlValue> pose_items = poses ? poses->items() : std::vector<YamlValue>();
  const bool of_object = !poses && object.has("pose");
  if (shape_items.size() != pose_items.size() && !of_object) {
    (shapes ? *shapes : *poses)
        .fail("expected as many " + std::string(poses_key) + " as " + shapes_key + " (" +
              std::to_string(shape_items.size()) + "), found " + std::to_string(pose_items.size()));
  }
  for (std::size_t i = 0; i < shape_items.size(); ++i) {
    const Eigen::Isometry3d X_OG = of_object ? Eigen::Isometry3d::Identity() : ros_pose(pose_items[i]);
    result.push_back({make(shape_items[i]), X_OG});
  }
}

}  // namespace

Shape cone(double radius, double height) {
  const double outer = radius / std::cos(std::numbers::pi / kConeSegments);
  return std::make_shared<const TriangleMesh>(revolve({{outer, -0.5 * height}, {0.0, 0.5 * height}}, kConeSegments));
}

Eigen::Isometry3d ros_pose(const YamlValue& value) {
  value.allow_keys({"position", "orientation"});
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = ros_quaternion(value.at("orientation")).toRotationMatrix();
  X.translation() = ros_vector(value.at("position"));
  return X;
}

std::vector<Geometry> planning_scene_shapes(const YamlValue& object, const PackagePaths& packages) {
  std::vector<Geometry> shapes;
  append_shapes(object, "primitives", "primitive_poses", primitive_of, shapes);
  append_shapes(
      object, "meshes", "mesh_poses",
      [&packages](const YamlValue& mesh) {
        return mesh.has("resource") ? mesh_of_resource(mesh, packages) : inline_mesh(mesh);
      },
      shapes);
  if (const auto planes = object.find("planes"); planes && !planes->items().empty()) {
    planes->fail("a plane has no thickness and no end; write a box instead");
  }
  return shapes;
}

}  // namespace opponens::robot
