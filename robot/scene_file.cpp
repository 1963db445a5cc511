// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "core/require.hpp"
#include "robot/mesh.hpp"
#include "robot/scene.hpp"
#include "robot/yaml_file.hpp"

namespace opponens::robot {

namespace {

constexpr int kMaxSegments = 4096;

double positive(const YamlValue& value) {
  const double number = value.number();
  if (number <= 0.0) value.fail("expected a positive number, found '" + value.text() + "'");
  return number;
}

std::string name_of(const YamlValue& value) {
  std::string name = value.text();
  if (name.empty()) value.fail("expected a name, found an empty text");
  return name;
}

int segments_of(const YamlValue& value) {
  const double number = value.number();
  if (number < 3.0 || number > kMaxSegments || number != std::floor(number)) {
    value.fail("expected a whole number from 3 to " + std::to_string(kMaxSegments) + ", found '" + value.text() + "'");
  }
  return static_cast<int>(number);
}

/// xyz (m) with rpy (rad, fixed axes) or quaternion (w, x, y, z), each optional.
Eigen::Isometry3d pose_of(const YamlValue& value) {
  value.allow_keys({"xyz", "rpy", "quaternion"});
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  const std::optional<YamlValue> quaternion = value.find("quaternion");
  if (const auto rpy = value.find("rpy")) {
    if (quaternion) value.fail("has both rpy and quaternion, expected one of them");
    X = pose_from_xyz_rpy(Eigen::Vector3d::Zero(), rpy->numbers(3));
  }
  if (quaternion) {
    const Eigen::Vector4d wxyz = quaternion->numbers(4);
    if (std::abs(wxyz.norm() - 1.0) > 1e-3) {
      quaternion->fail("expected a unit quaternion (w, x, y, z), its norm is " + std::to_string(wxyz.norm()));
    }
    X.linear() = Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized().toRotationMatrix();
  }
  if (const auto xyz = value.find("xyz")) X.translation() = xyz->numbers(3);
  return X;
}

Shape box_of(const YamlValue& value) {
  value.allow_keys({"size"});
  const YamlValue size = value.at("size");
  const Eigen::Vector3d edges = size.numbers(3);
  if (edges.minCoeff() <= 0.0) size.fail("expected three positive edge lengths");
  return Box{edges};
}

Shape sphere_of(const YamlValue& value) {
  value.allow_keys({"radius"});
  return Sphere{positive(value.at("radius"))};
}

Shape cylinder_of(const YamlValue& value) {
  value.allow_keys({"radius", "length"});
  return Cylinder{positive(value.at("radius")), positive(value.at("length"))};
}

double unit_of(const YamlValue& value) {
  static const std::map<std::string, double> kUnits{{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}};
  const auto found = kUnits.find(value.text());
  if (found == kUnits.end()) value.fail("expected m, cm, mm or in, found '" + value.text() + "'");
  return found->second;
}

/// Shapes that the bodies of one file share.
using Meshes = std::map<std::pair<std::string, std::array<double, 3>>, std::shared_ptr<const TriangleMesh>>;

Shape mesh_of(const YamlValue& value, Meshes& known) {
  value.allow_keys({"file", "unit", "scale"});
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  if (const auto written = value.find("scale")) {
    scale = written->is_sequence() ? Eigen::Vector3d(written->numbers(3))
                                   : Eigen::Vector3d(Eigen::Vector3d::Constant(written->number()));
    if (scale.minCoeff() <= 0.0) written->fail("expected a positive factor, or three");
  }
  if (const auto unit = value.find("unit")) scale *= unit_of(*unit);
  const YamlValue file = value.at("file");
  const std::filesystem::path path = file.path();
  std::shared_ptr<const TriangleMesh>& mesh = known[{path.string(), {scale[0], scale[1], scale[2]}}];
  if (mesh == nullptr) {
    try {
      mesh = load_mesh(path, scale);
    } catch (const InputError& error) {
      file.fail(error.what());
    }
  }
  return mesh;
}

Shape revolution_of(const YamlValue& value) {
  value.allow_keys({"profile", "segments"});
  const YamlValue written = value.at("profile");
  std::vector<std::pair<double, double>> profile;
  for (const YamlValue& point : written.items()) {
    const Eigen::Vector2d rz = point.numbers(2);
    profile.emplace_back(rz[0], rz[1]);
  }
  const auto segments = value.find("segments");
  try {
    return std::make_shared<const TriangleMesh>(revolve(profile, segments ? segments_of(*segments) : 48));
  } catch (const std::invalid_argument& error) {
    written.fail(error.what());
  }
}

Geometry geometry_of(const YamlValue& value, Meshes& known) {
  value.allow_keys({"box", "sphere", "cylinder", "mesh", "revolution", "pose"});
  std::vector<Shape> shapes;
  if (const auto v = value.find("box")) shapes.push_back(box_of(*v));
  if (const auto v = value.find("sphere")) shapes.push_back(sphere_of(*v));
  if (const auto v = value.find("cylinder")) shapes.push_back(cylinder_of(*v));
  if (const auto v = value.find("mesh")) shapes.push_back(mesh_of(*v, known));
  if (const auto v = value.find("revolution")) shapes.push_back(revolution_of(*v));
  if (shapes.size() != 1) {
    value.fail("expected exactly one of box, sphere, cylinder, mesh, revolution; found " +
               std::to_string(shapes.size()));
  }
  Geometry geometry{std::move(shapes.front())};
  if (const auto pose = value.find("pose")) geometry.X_BG = pose_of(*pose);
  return geometry;
}

SceneBody body_of(const YamlValue& value, Meshes& known) {
  value.allow_keys({"name", "pose", "geometry"});
  SceneBody body;
  body.name = name_of(value.at("name"));
  if (const auto pose = value.find("pose")) body.X_WB = pose_of(*pose);
  const YamlValue geometry = value.at("geometry");
  for (const YamlValue& item : geometry.items()) body.geometry.push_back(geometry_of(item, known));
  if (body.geometry.empty()) geometry.fail("body '" + body.name + "' needs at least one shape");
  return body;
}

void read_start(const YamlValue& value, Scene& scene) {
  std::vector<double> positions;
  for (const auto& [joint, position] : value.entries()) {
    scene.start_joints.push_back(joint);
    positions.push_back(position.number());
  }
  scene.start = Eigen::Map<const Eigen::VectorXd>(positions.data(), static_cast<Eigen::Index>(positions.size()));
}

}  // namespace

Scene load_scene(const std::filesystem::path& scene_yaml) {
  const YamlValue root = YamlValue::load(scene_yaml);
  root.allow_keys({"name", "robot_base", "bodies", "object", "support", "start"});
  Scene scene;
  scene.name = name_of(root.at("name"));
  if (const auto base = root.find("robot_base")) scene.X_WR = pose_of(*base);
  Meshes known;
  std::set<std::string> names;
  for (const YamlValue& item : root.at("bodies").items()) {
    SceneBody body = body_of(item, known);
    if (!names.insert(body.name).second) item.at("name").fail("there are two bodies '" + body.name + "'");
    scene.bodies.push_back(std::move(body));
  }
  for (auto [key, field] : {std::pair{"object", &scene.object}, std::pair{"support", &scene.support}}) {
    const auto value = root.find(key);
    if (!value) continue;
    *field = name_of(*value);
    if (names.count(*field) == 0) value->fail("'" + *field + "' is not a body of the scene");
  }
  if (const auto start = root.find("start")) read_start(*start, scene);
  scene.files.push_back(scene_yaml);
  for (const SceneBody& body : scene.bodies) append_mesh_files(body.geometry, scene.files);
  return scene;
}

}  // namespace opponens::robot
