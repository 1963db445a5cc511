// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "core/require.hpp"
#include "robot/hand_file.hpp"
#include "robot/mesh.hpp"
#include "robot/planning_scene_file.hpp"
#include "robot/scene.hpp"
#include "robot/scene_text_file.hpp"
#include "robot/scene_values.hpp"

namespace opponens::robot {

namespace {

constexpr int kMaxSegments = 4096;

int segments_of(const YamlValue& value) {
  const double number = value.number();
  if (number < 3.0 || number > kMaxSegments || number != std::floor(number)) {
    value.fail("expected a whole number from 3 to " + std::to_string(kMaxSegments) + ", found '" + value.text() + "'");
  }
  return static_cast<int>(number);
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
  if (scale.minCoeff() <= 0.0) value.at("scale").fail("leaves nothing of the mesh");
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

bool has_body(const Scene& scene, const std::string& name) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), [&](const SceneBody& b) { return b.name == name; });
}

/// The file that the key `import` names, or an empty scene.
Scene imported_by(const YamlValue& root) {
  const auto import = root.find("import");
  if (!import) {
    if (const auto packages = root.find("packages"))
      packages->fail("is for the meshes of an imported scene (key import)");
    return {};
  }
  const std::filesystem::path file = import->path();
  if (is_scene_text(file)) return load_scene_text(file);
  const YamlValue content = YamlValue::load(file);
  if (is_planning_scene(content)) return read_planning_scene(content, read_packages(root));
  import->fail("'" + import->text() + "' is neither a planning scene (key world) nor a .scene file");
}

/// The bodies that a scene of ours adds to those it may have imported.
void read_bodies(const YamlValue& root, Scene& scene) {
  const auto bodies = root.has("import") ? root.find("bodies") : std::optional(root.at("bodies"));
  if (!bodies) return;
  Meshes known;
  for (const YamlValue& item : bodies->items()) {
    SceneBody body = body_of(item, known);
    if (has_body(scene, body.name)) item.at("name").fail("there are two bodies '" + body.name + "'");
    append_mesh_files(body.geometry, scene.files);
    scene.bodies.push_back(std::move(body));
  }
}

/// Joint positions by name; they replace those of an imported scene.
void read_start(const YamlValue& value, Scene& scene) {
  std::vector<double> positions;
  scene.start_joints.clear();
  for (const auto& [joint, position] : value.entries()) {
    scene.start_joints.push_back(joint);
    positions.push_back(position.number());
  }
  scene.start = Eigen::Map<const Eigen::VectorXd>(positions.data(), static_cast<Eigen::Index>(positions.size()));
}

}  // namespace

Scene load_scene(const std::filesystem::path& scene_yaml) {
  if (is_scene_text(scene_yaml)) return load_scene_text(scene_yaml);
  const YamlValue root = YamlValue::load(scene_yaml);
  if (is_planning_scene(root)) return read_planning_scene(root, {});
  root.allow_keys({"name", "import", "packages", "robot_base", "bodies", "object", "support", "start"});
  Scene scene = imported_by(root);
  scene.name = name_of(root.at("name"));
  if (const auto base = root.find("robot_base")) scene.X_WR = pose_of(*base);
  read_bodies(root, scene);
  for (auto [key, field] : {std::pair{"object", &scene.object}, std::pair{"support", &scene.support}}) {
    const auto value = root.find(key);
    if (!value) continue;
    *field = name_of(*value);
    if (!has_body(scene, *field)) value->fail("'" + *field + "' is not a body of the scene");
  }
  if (const auto start = root.find("start")) read_start(*start, scene);
  scene.files.insert(scene.files.begin(), scene_yaml);
  return scene;
}

}  // namespace opponens::robot
