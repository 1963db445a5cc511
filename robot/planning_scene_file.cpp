// SPDX-FileCopyrightText: 2026 The opponens authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot/planning_scene_file.hpp"

#include <map>
#include <set>

#include "robot/joint_state_file.hpp"
#include "robot/mesh.hpp"
#include "robot/scene_values.hpp"

namespace opponens::robot {

namespace {

/// Frames of the file, and the one that it does not explain and that is taken for the world.
class Frames {
 public:
  explicit Frames(const YamlValue& root) {
    const auto list = root.find("fixed_frame_transforms");
    if (!list) return;
    for (const YamlValue& item : list->items()) {
      item.allow_keys({"header", "child_frame_id", "transform"});
      const YamlValue transform = item.at("transform");
      transform.allow_keys({"translation", "rotation"});
      Eigen::Isometry3d X_WF = Eigen::Isometry3d::Identity();
      X_WF.linear() = ros_quaternion(transform.at("rotation")).toRotationMatrix();
      X_WF.translation() = ros_vector(transform.at("translation"));
      known_[item.at("child_frame_id").text()] = X_WF;
    }
  }

  /// Pose of the frame that an object's header names.
  Eigen::Isometry3d pose(const YamlValue& object) {
    const auto header = object.find("header");
    if (header) header->allow_keys({"frame_id", "seq", "stamp"});
    const auto written = header ? header->find("frame_id") : std::nullopt;
    const std::string frame = written ? written->text() : "";
    const auto found = known_.find(frame);
    if (found != known_.end()) return use(object, found->first, found->second);
    return use(object, frame, Eigen::Isometry3d::Identity());
  }

  /// The frame that all objects are in when nothing tells where it is; empty: none, or the world itself.
  const std::string& assumed() const { return assumed_; }

 private:
  /// A frame that the file does not place can be the world's only when everything is in it.
  Eigen::Isometry3d use(const YamlValue& object, const std::string& frame, const Eigen::Isometry3d& X_WF) {
    const bool placed = frame.empty() || frame == "world" || known_.count(frame) == 1;
    if (!placed) assumed_ = frame;
    used_.insert(placed ? "" : frame);
    if (used_.size() > 1) {
      object.fail("frame '" + assumed_ + "' has no place in the file (fixed_frame_transforms), and other objects are " +
                  "in another frame");
    }
    return X_WF;
  }

  std::map<std::string, Eigen::Isometry3d> known_;
  std::set<std::string> used_;
  std::string assumed_;
};

/// Notes what the file says and this program does not use: a list or map that is there and not empty.
void note_unused(const YamlValue& parent, const std::string& key, const std::string& note, Scene& scene) {
  const auto value = parent.find(key);
  if (!value) return;
  const bool empty = value->is_sequence() ? value->items().empty() : value->is_map() && value->entries().empty();
  if (!empty) scene.notes.push_back(note);
}

/// Pairs that the matrix allows, above its diagonal.
void note_matrix(const YamlValue& root, Scene& scene) {
  const auto matrix = root.find("allowed_collision_matrix");
  if (!matrix) return;
  matrix->allow_keys({"entry_names", "entry_values", "default_entry_names", "default_entry_values"});
  const std::size_t names = matrix->at("entry_names").items().size();
  const std::vector<YamlValue> rows = matrix->at("entry_values").items();
  if (rows.size() != names) matrix->fail("expected " + std::to_string(names) + " rows of entry_values");
  int allowed = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const YamlValue row = rows[i].is_map() ? rows[i].at("enabled") : rows[i];
    const std::vector<std::string> entries = row.texts();
    if (entries.size() != names) row.fail("expected " + std::to_string(names) + " entries");
    for (std::size_t j = i + 1; j < names; ++j) allowed += entries[j] == "true" || entries[j] == "1" ? 1 : 0;
  }
  if (allowed > 0) {
    scene.notes.push_back("allowed_collision_matrix: ignored (" + std::to_string(allowed) +
                          " pairs); the robot's own allowed pairs count");
  }
}

SceneBody body_of(const YamlValue& object, const PackagePaths& packages, Frames& frames, Scene& scene) {
  object.allow_keys({"header", "pose", "id", "type", "primitives", "primitive_poses", "meshes", "mesh_poses", "planes",
                     "plane_poses", "subframe_names", "subframe_poses", "operation"});
  SceneBody body;
  body.name = name_of(object.at("id"));
  if (const auto operation = object.find("operation")) {
    const std::string text = operation->text();
    // 0 is moveit_msgs/CollisionObject ADD; YAML written by hand has the word.
    if (text != "add" && text != "0")
      operation->fail("expected add (0), found '" + text + "': a scene holds what is there");
  }
  body.X_WB = frames.pose(object);
  if (const auto pose = object.find("pose")) body.X_WB = body.X_WB * ros_pose(*pose);
  body.geometry = planning_scene_shapes(object, packages);
  if (body.geometry.empty()) object.fail("object '" + body.name + "' needs at least one shape");
  note_unused(object, "subframe_names", "object '" + body.name + "': its subframes are ignored", scene);
  return body;
}

}  // namespace

bool is_planning_scene(const YamlValue& root) { return root.is_map() && root.has("world"); }

Scene read_planning_scene(const YamlValue& root, const PackagePaths& packages) {
  root.allow_keys({"name", "robot_state", "robot_model_name", "fixed_frame_transforms", "allowed_collision_matrix",
                   "link_padding", "link_scale", "object_colors", "world", "is_diff"});
  Scene scene;
  const auto name = root.find("name");
  scene.name = name && !name->text().empty() ? name->text() : root.file().stem().string();
  const YamlValue world = root.at("world");
  world.allow_keys({"collision_objects", "octomap"});
  note_unused(world, "octomap", "octomap: ignored", scene);
  Frames frames(root);
  std::set<std::string> names;
  for (const YamlValue& object : world.at("collision_objects").items()) {
    scene.bodies.push_back(body_of(object, packages, frames, scene));
    const std::string& id = scene.bodies.back().name;
    if (!names.insert(id).second) object.at("id").fail("there are two objects '" + id + "'");
  }
  if (!frames.assumed().empty()) scene.notes.push_back("frame '" + frames.assumed() + "' is taken for the world");
  note_matrix(root, scene);
  for (const char* key : {"link_padding", "link_scale"}) {
    note_unused(root, key, std::string(key) + ": ignored; links have the shapes of the robot's description", scene);
  }
  if (const auto state = root.find("robot_state")) {
    JointState joints = read_robot_state(*state, scene.notes);
    scene.start_joints = std::move(joints.names);
    scene.start = std::move(joints.positions);
  }
  scene.files.push_back(root.file());
  for (const SceneBody& body : scene.bodies) append_mesh_files(body.geometry, scene.files);
  return scene;
}

}  // namespace opponens::robot
